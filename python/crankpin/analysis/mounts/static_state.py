"""A powertrain at rest: sag and preload under its weight, wind-up under a mean torque, thrust."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.quantities import RESTING
from crankpin._support.record import computed
from crankpin._support.tables import Column, Table
from crankpin.analysis.labelled import Labelled
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity

GRAVITY = (0.0, -9.80665, 0.0)
"""Standard gravity of an upright engine, m/s²."""


class StaticState(Labelled):
    """A powertrain at rest on the static stiffness of its mounts, and of a subframe's.

    What is above a subframe follows it as a rigid body: displacements are larger than on firm
    ground, forces of the powertrain's mounts are the same.

    Made by :meth:`Powertrain.static`.
    """

    _registry = RESTING

    powertrain: Powertrain
    """The powertrain."""
    torque: float
    """Mean torque that leaves the unit, N·m, about +z: −torque acts on the body."""
    gravity: tuple[float, float, float]
    """Acceleration of gravity in the engine's axes, m/s²."""
    thrust: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Force of a propeller's shaft on the unit, N."""
    thrust_at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Place where it acts, m."""
    support_margin: float = computed()
    """Distance of the centre of gravity from the edge of the polygon of the mounts, m.

    Seen along gravity; above zero inside. Outside, some mount is pulled.
    """
    support_polygon: tuple[str, ...] = computed()
    """Names of the mounts at the corners of their polygon, seen along gravity, in order."""

    def __post_init__(self) -> None:
        core = self.powertrain._core
        push = [list(self.thrust), list(self.thrust_at)]
        displacement, forces, margin, corners = core.static(list(self.gravity), -self.torque, push)
        of_mounts, count = np.array(forces), len(self.powertrain.mounts)
        moved = np.array(displacement)
        arrays = {"ground_preload": of_mounts[:, count:].sum(axis=0)}
        arrays["preload"] = of_mounts[:, :count].sum(axis=0)
        names = (("sag", "weight"), ("wind_up", "torque"), ("thrust_shift", "thrust"))
        for (name, cause), motion, pushed in zip(names, moved, of_mounts, strict=True):
            arrays[name] = motion[:3]
            arrays[f"{name.removesuffix('_shift')}_deg"] = np.degrees(motion[3:])
            arrays[f"{cause}_force"] = pushed[:count]
        self.__dict__.update(
            support_margin=margin,
            support_polygon=tuple(self.powertrain.names[k] for k in corners),
            _arrays=arrays,
            _forces=of_mounts,
        )
        super().__post_init__()

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        names, count = tuple(self.powertrain._core.all_names), len(self.powertrain.mounts)
        return {"mount": names[:count], "subframe_mount": names[count:]}

    @property
    def sag(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity under the weight, m: (n_axes,)."""
        return self._quantity("sag")

    @property
    def sag_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z under the weight, degrees: (n_axes,)."""
        return self._quantity("sag_deg")

    @property
    def wind_up(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity under the torque, m: (n_axes,)."""
        return self._quantity("wind_up")

    @property
    def wind_up_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z under the torque, degrees: (n_axes,)."""
        return self._quantity("wind_up_deg")

    @property
    def thrust_shift(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity under the thrust, m: (n_axes,)."""
        return self._quantity("thrust_shift")

    @property
    def thrust_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z under the thrust, degrees: (n_axes,)."""
        return self._quantity("thrust_deg")

    @property
    def ground_preload(self) -> Quantity[np.float64]:
        """Force of each mount of a subframe on what carries it, of all causes, N.

        Of shape (n_mounts, n_axes); empty without a subframe.
        """
        return self._quantity("ground_preload")

    @property
    def weight_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the weight, N: (n_mounts, n_axes)."""
        return self._quantity("weight_force")

    @property
    def torque_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the torque, N: (n_mounts, n_axes)."""
        return self._quantity("torque_force")

    @property
    def thrust_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the thrust, N: (n_mounts, n_axes)."""
        return self._quantity("thrust_force")

    @property
    def preload(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it, of all causes, N: (n_mounts, n_axes)."""
        return self._quantity("preload")

    @property
    def table(self) -> Table:
        """Forces of the mounts on what carries them, by cause; also of those of a subframe."""
        columns = [Column("mount", tuple(self.powertrain._core.all_names))]
        causes = ["weight", "torque", *(["thrust"] if any(self.thrust) else [])]
        for cause, forces in zip(causes, self.__dict__["_forces"], strict=False):
            for axis, values in zip("xyz", forces.T.tolist(), strict=True):
                columns.append(Column(f"{cause} F_{axis}", tuple(values), "N"))
        side = "inside" if self.support_margin > 0.0 else "outside"
        sag = tuple(1e3 * self.read("sag"))
        note = units.Text(
            "Sag of the CG ", units.Figure(sag, "mm", ".4g", "({}, {}, {})"),
            f"; wind-up {self.wind_up_deg[2]:.4g}° about z under ",
            units.figure(self.torque, "N·m", 6),
            f" that leave the unit. The CG is {side} the mounts' polygon by ",
            units.figure(1e3 * abs(self.support_margin), "mm", 4), ". Static stiffness.",
        )  # fmt: skip
        name, carried = labels.name_of(self.powertrain), self.powertrain._carried
        on = f" on its mounts{carried}" if carried else ""
        title = f"{name}{on} at rest: forces on what carries the mounts"
        return Table(title, tuple(columns), note)


def static(
    powertrain: Powertrain,
    torque: float | Literal["engine"],
    gear_ratio: float,
    gravity: ArrayLike,
    rpm: float,
    thrust: ArrayLike,
    thrust_at: ArrayLike,
) -> StaticState:
    """Return the state at rest; :meth:`Powertrain.static` documents the arguments."""
    leaving: Any = torque
    inputs.angular_speed(rpm)
    if isinstance(torque, str):
        inputs.one_of("torque", torque, ("engine",))
        engine = powertrain._require_engine("torque")
        if not engine.fired:
            hint = (
                "the engine has no cycle and so no mean torque: give N·m, or engine.with_cycle(…)"
            )
            raise inputs.rejected("torque", "engine", hint)
        leaving = engine.balance(rpm, orders=[1]).crank_torque.cycle_mean
    ratio = inputs.finite("gear_ratio", gear_ratio)
    if ratio == 0.0:
        raise inputs.rejected(
            "gear_ratio", 0.0, "give crank speed over output speed, such as 1 or 12.5"
        )
    leaving = inputs.finite("torque", leaving) * ratio
    places = (_vector("thrust", thrust), _vector("thrust_at", thrust_at))
    return StaticState(powertrain, leaving, _vector("gravity", gravity), *places)
