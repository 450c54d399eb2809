"""A powertrain at rest: sag and preload under its weight, wind-up under a mean torque, thrust."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.quantities import RESTING
from crankpin._support.record import computed
from crankpin._support.tables import Column, Table
from crankpin.analysis.labelled import Labelled
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.mounts import Vector
    from crankpin.model.vehicle_axes import VehicleAxes

GRAVITY = (0.0, -9.80665, 0.0)
"""Standard gravity of an upright engine, m/s²."""
STILL = (0.0, 0.0, 0.0)
"""No acceleration, no thrust, no place other than the origin."""


class AtRest(Labelled):
    """What a powertrain at rest has, under one case or several."""

    _registry = RESTING

    if TYPE_CHECKING:
        powertrain: Powertrain

    @property
    def _vehicle(self) -> VehicleAxes | None:
        return self.powertrain.vehicle

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        names, count = tuple(self.powertrain._core.all_names), len(self.powertrain.mounts)
        return {
            "mount": names[:count],
            "subframe_mount": names[count:],
            "all_mounts": names,
            "mount_axis": (1, 2, 3),
        }

    @property
    def sag(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity under the weight, m: (…, n_axes)."""
        return self._quantity("sag")

    @property
    def sag_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z under the weight, degrees: (…, n_axes)."""
        return self._quantity("sag_deg")

    @property
    def wind_up(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity that the torque adds, m: (…, n_axes)."""
        return self._quantity("wind_up")

    @property
    def wind_up_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z that the torque adds, degrees: (…, n_axes)."""
        return self._quantity("wind_up_deg")

    @property
    def thrust_shift(self) -> Quantity[np.float64]:
        """Displacement of the centre of gravity that the thrust adds, m: (…, n_axes)."""
        return self._quantity("thrust_shift")

    @property
    def thrust_deg(self) -> Quantity[np.float64]:
        """Rotation about x, y and z that the thrust adds, degrees: (…, n_axes)."""
        return self._quantity("thrust_deg")

    @property
    def ground_preload(self) -> Quantity[np.float64]:
        """Force of each mount of a subframe on what carries it, of all causes, N.

        Of shape (…, n_mounts, n_axes); empty without a subframe.
        """
        return self._quantity("ground_preload")

    @property
    def weight_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the weight, N: (…, n_mounts, n_axes)."""
        return self._quantity("weight_force")

    @property
    def torque_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the torque, N: (…, n_mounts, n_axes)."""
        return self._quantity("torque_force")

    @property
    def thrust_force(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it due to the thrust, N: (…, n_mounts, n_axes)."""
        return self._quantity("thrust_force")

    @property
    def preload(self) -> Quantity[np.float64]:
        """Force of each mount on what carries it, of all causes, N: (…, n_mounts, n_axes)."""
        return self._quantity("preload")

    @property
    def travel(self) -> Quantity[np.float64]:
        """Deflection of each mount from no load, of all causes, m: (…, n_all_mounts, n_axes).

        Of its end on the powertrain less that on what carries it, along x, y and z; mounts of a
        subframe follow the others.
        """
        return self._quantity("travel")

    @property
    def deflection(self) -> Quantity[np.float64]:
        """The same along the mount's own axes, m: (…, n_all_mounts, 3)."""
        return self._quantity("deflection")

    @property
    def snubber_force(self) -> Quantity[np.float64]:
        """Force of the snubbers of each mount on what carries it, N: (…, n_all_mounts, 3).

        Along the mount's own axes, above zero of the one along the axis; 0 of those that do not
        touch.
        """
        return self._quantity("snubber_force")


class StaticState(AtRest):
    """A powertrain at rest on the static stiffness of its mounts, and of a subframe's.

    Torque and thrust have what they add to the state under the weight, and to that under both:
    where snubbers touch causes are no longer independent. What is above a subframe follows it as a
    rigid body: displacements are larger than on firm ground, forces of the powertrain's mounts are
    the same.

    Made by :meth:`Powertrain.static`.
    """

    powertrain: Powertrain
    """The powertrain."""
    torque: float
    """Mean torque that leaves the unit, N·m, about +z: −torque acts on the body."""
    gravity: tuple[float, float, float]
    """Acceleration of gravity, m/s²."""
    thrust: tuple[float, float, float] = STILL
    """Force of a propeller's shaft on the unit, N."""
    thrust_at: tuple[float, float, float] = STILL
    """Place where it acts, m."""
    acceleration: tuple[float, float, float] = STILL
    """Acceleration of the vehicle, m/s², which counts with the weight."""
    support_margin: float = computed()
    """Distance of the centre of gravity from the edge of the polygon of the mounts, m.

    Seen along gravity, less the acceleration; above zero inside. Outside, some mount is pulled.
    """
    support_polygon: tuple[str, ...] = computed()
    """Names of the mounts at the corners of their polygon, seen along gravity, in order."""

    def __post_init__(self) -> None:
        case = Case(self.torque, self.gravity, self.thrust, self.thrust_at, self.acceleration)
        displacement, forces, own, margin, corners = self.powertrain._core.static(
            case.figures(self.powertrain.vehicle)
        )
        of_mounts, count = np.array(forces), len(self.powertrain.mounts)
        moved = np.array(displacement)
        arrays = {"ground_preload": of_mounts[:, count:].sum(axis=0)}
        arrays["preload"] = of_mounts[:, :count].sum(axis=0)
        arrays |= dict(zip(("deflection", "snubber_force", "travel"), own, strict=True))
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
    def snubbers(self) -> tuple[str, ...]:
        """Snubbers that act: name of the mount, and the axis with the sense, as ``"rear −2"``."""
        forces = self.read("snubber_force")
        sides = np.stack([forces < 0.0, forces > 0.0], axis=-1)
        return snubbers_in_words(self.powertrain._core.all_names, sides.tolist())

    @property
    def table(self) -> Table:
        """Forces of the mounts on what carries them, by cause; also of those of a subframe."""
        columns = [Column("mount", tuple(self.powertrain._core.all_names))]
        acting = f" Snubbers act: {', '.join(self.snubbers)}." if self.snubbers else ""
        causes = ["weight", "torque", *(["thrust"] if any(self.thrust) else [])]
        vehicle = self.powertrain.vehicle
        of_mounts = self.__dict__["_forces"]
        of_mounts = of_mounts if vehicle is None else vehicle._vectors(of_mounts)
        for cause, forces in zip(causes, of_mounts, strict=False):
            for axis, values in zip("xyz", forces.T.tolist(), strict=True):
                columns.append(Column(f"{cause} F_{axis}", tuple(values), "N"))
        side = "inside" if self.support_margin > 0.0 else "outside"
        sag = tuple(1e3 * self.read("sag"))
        turn = self.__dict__["_arrays"]["wind_up_deg"][2]
        note = units.Text(
            "Sag of the CG ", units.Figure(sag, "mm", ".4g", "({}, {}, {})"),
            f"; wind-up {turn:.4g}° about {'z' if vehicle is None else 'the crank'} under ",
            units.figure(self.torque, "N·m", 6),
            f" that leave the unit. The CG is {side} the mounts' polygon by ",
            units.figure(1e3 * abs(self.support_margin), "mm", 4), f". Static stiffness.{acting}",
        )  # fmt: skip
        name, carried = labels.name_of(self.powertrain), self.powertrain._carried
        on = f" on its mounts{carried}" if carried else ""
        title = f"{name}{on} at rest: forces on what carries the mounts"
        return Table(title, tuple(columns), note)


def snubbers_in_words(
    names: Iterable[str], sides: Iterable[Iterable[Iterable[Any]]]
) -> tuple[str, ...]:
    """Return names of snubbers, of what is true against and along each axis of each mount."""
    return tuple(
        f"{name} {sign}{axis}"
        for name, of_mount in zip(names, sides, strict=True)
        for axis, pair in enumerate(of_mount, 1)
        for sign, acts in zip("−+", pair, strict=True)
        if acts
    )


class Case(NamedTuple):
    """What acts on a powertrain at rest, as :meth:`Powertrain.static` takes it."""

    torque: float
    gravity: Vector
    thrust: Vector
    thrust_at: Vector
    acceleration: Vector

    def figures(self, vehicle: VehicleAxes | None) -> tuple[list[list[float]], float]:
        """Return the case as the core takes it, of the axes of a vehicle or the engine's."""
        vectors, place = (self.gravity, self.acceleration, self.thrust), self.thrust_at
        if vehicle is None:
            return (list(map(list, (*vectors, place))), self.torque)
        turned = vehicle._vectors(vectors, inverse=True).tolist()
        place = vehicle.to_engine(place) if any(self.thrust) else STILL
        return ([*turned, list(place)], self.torque)


def case_of(
    powertrain: Powertrain,
    *,
    torque: float | Literal["engine"] = 0.0,
    gear_ratio: float = 1.0,
    gravity: ArrayLike | None = None,
    acceleration: ArrayLike = STILL,
    rpm: float = 1000.0,
    thrust: ArrayLike = STILL,
    thrust_at: ArrayLike = STILL,
) -> Case:
    """Return what acts, checked; :meth:`Powertrain.static` documents the arguments."""
    if gravity is None:
        rest = powertrain.rest or upright(powertrain.vehicle)._asdict()
        gravity = rest["gravity"]
    return Case(
        _leaving_torque(powertrain, torque, gear_ratio, rpm),
        _vector("gravity", gravity),
        _vector("thrust", thrust),
        _vector("thrust_at", thrust_at),
        _vector("acceleration", acceleration),
    )


def upright(vehicle: VehicleAxes | None) -> Case:
    """Return rest under standard gravity."""
    if vehicle is None:
        return Case(0.0, GRAVITY, STILL, STILL, STILL)
    x, y, z = (-GRAVITY[1] * part + 0.0 for part in vehicle.down)
    return Case(0.0, (x, y, z), STILL, STILL, STILL)


ARGUMENTS = tuple(inspect.signature(case_of).parameters)[1:]
"""Names of what a case may have."""


def named_case(powertrain: Powertrain, name: str, arguments: object) -> Case:
    """Return a case of arguments by name, for an argument that is one, or has some."""
    hint = f"give a mapping of arguments of Powertrain.static: {', '.join(ARGUMENTS)}"
    if not isinstance(arguments, Mapping):
        raise inputs.rejected(name, arguments, hint)
    for key in arguments:
        inputs.one_of(f"argument of {name}", key, ARGUMENTS)
    return case_of(powertrain, **arguments)


def _leaving_torque(
    powertrain: Powertrain, torque: float | Literal["engine"], gear_ratio: float, rpm: float
) -> float:
    """Return the mean torque that leaves the unit, N·m."""
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
    return inputs.finite("torque", leaving) * ratio
