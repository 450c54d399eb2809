"""A powertrain at rest: sag and preload under its weight, wind-up under a mean torque, thrust."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.record import computed, read_only
from crankpin._support.tables import Column, Table
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.mounts.powertrain import Powertrain

GRAVITY = (0.0, -9.80665, 0.0)
"""Standard gravity of an upright engine, m/s²."""


class StaticState(Tabled):
    """A powertrain at rest on the static stiffness of its mounts, and of a subframe's.

    What is above a subframe follows it as a rigid body: displacements are larger than on firm
    ground, forces of the powertrain's mounts are the same.

    Made by :meth:`Powertrain.static`.
    """

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
    sag: NDArray[np.float64] = computed()
    """Displacement of the centre of gravity under the weight, m: (n_axes,)."""
    sag_deg: NDArray[np.float64] = computed()
    """Rotation about x, y and z under the weight, degrees: (n_axes,)."""
    wind_up: NDArray[np.float64] = computed()
    """Displacement of the centre of gravity under the torque, m: (n_axes,)."""
    wind_up_deg: NDArray[np.float64] = computed()
    """Rotation about x, y and z under the torque, degrees: (n_axes,)."""
    thrust_shift: NDArray[np.float64] = computed()
    """Displacement of the centre of gravity under the thrust, m: (n_axes,)."""
    thrust_deg: NDArray[np.float64] = computed()
    """Rotation about x, y and z under the thrust, degrees: (n_axes,)."""
    ground_preload: NDArray[np.float64] = computed()
    """Force of each mount of a subframe on what carries it, of all causes, N.

    Of shape (n_mounts, n_axes); empty without a subframe.
    """
    support_margin: float = computed()
    """Distance of the centre of gravity from the edge of the polygon of the mounts, m.

    Seen along gravity; above zero inside. Outside, some mount is pulled.
    """
    support_polygon: tuple[str, ...] = computed()
    """Names of the mounts at the corners of their polygon, seen along gravity, in order."""
    _forces: NDArray[np.float64] = computed()

    def __post_init__(self) -> None:
        core = self.powertrain._core
        push = [list(self.thrust), list(self.thrust_at)]
        displacement, forces, margin, corners = core.static(list(self.gravity), -self.torque, push)
        moved = np.array(displacement)
        shift = [read_only(row) for row in moved[:, :3]]
        turn_deg = [read_only(row) for row in np.degrees(moved[:, 3:])]
        self.__dict__.update(zip(("sag", "wind_up", "thrust_shift"), shift, strict=True))
        self.__dict__.update(zip(("sag_deg", "wind_up_deg", "thrust_deg"), turn_deg, strict=True))
        self.__dict__.update(
            ground_preload=read_only(sum(np.array(forces)[:, len(self.powertrain.mounts) :])),
            support_margin=margin,
            support_polygon=tuple(self.powertrain.names[k] for k in corners),
            _forces=read_only(np.array(forces)),
        )
        super().__post_init__()

    @property
    def weight_force(self) -> NDArray[np.float64]:
        """Force of each mount on what carries it due to the weight, N: (n_mounts, n_axes)."""
        return self._of_cause(0)

    @property
    def torque_force(self) -> NDArray[np.float64]:
        """Force of each mount on what carries it due to the torque, N: (n_mounts, n_axes)."""
        return self._of_cause(1)

    @property
    def thrust_force(self) -> NDArray[np.float64]:
        """Force of each mount on what carries it due to the thrust, N: (n_mounts, n_axes)."""
        return self._of_cause(2)

    def _of_cause(self, cause: int) -> NDArray[np.float64]:
        """Return forces of the powertrain's own mounts."""
        forces: NDArray[np.float64] = self._forces[cause]
        return forces[: len(self.powertrain.mounts)]

    @property
    def preload(self) -> NDArray[np.float64]:
        """Force of each mount on what carries it, of all causes, N: (n_mounts, n_axes)."""
        return read_only(self.weight_force + self.torque_force + self.thrust_force)

    @property
    def table(self) -> Table:
        """Forces of the mounts on what carries them, by cause; also of those of a subframe."""
        columns = [Column("mount", tuple(self.powertrain._core.all_names))]
        causes = ["weight", "torque", *(["thrust"] if any(self.thrust) else [])]
        for cause, forces in zip(causes, self._forces, strict=False):
            for axis, values in zip("xyz", forces.T.tolist(), strict=True):
                columns.append(Column(f"{cause} F_{axis}", tuple(values), "N"))
        side = "inside" if self.support_margin > 0.0 else "outside"
        note = units.Text(
            "Sag of the CG ", units.Figure((*1e3 * self.sag,), "mm", ".4g", "({}, {}, {})"),
            f"; wind-up {self.wind_up_deg[2]:.4g}° about z under ",
            units.figure(self.torque, "N·m", 6),
            f" that leave the unit. The CG is {side} the mounts' polygon by ",
            units.figure(1e3 * abs(self.support_margin), "mm", 4), ". Static stiffness.",
        )  # fmt: skip
        name, carried = labels.name_of(self.powertrain.engine), self.powertrain._carried
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
        if not powertrain.engine.fired:
            hint = (
                "the engine has no cycle and so no mean torque: give N·m, or engine.with_cycle(…)"
            )
            raise inputs.rejected("torque", "engine", hint)
        leaving = powertrain.engine.balance(rpm, orders=[1]).crank_torque.cycle_mean
    ratio = inputs.finite("gear_ratio", gear_ratio)
    if ratio == 0.0:
        raise inputs.rejected(
            "gear_ratio", 0.0, "give crank speed over output speed, such as 1 or 12.5"
        )
    leaving = inputs.finite("torque", leaving) * ratio
    places = (_vector("thrust", thrust), _vector("thrust_at", thrust_at))
    return StaticState(powertrain, leaving, _vector("gravity", gravity), *places)
