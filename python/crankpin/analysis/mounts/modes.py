"""Modes of a powertrain on its mounts, their shares of energy, and its axes of rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import units
from crankpin._support.quantities import MODES, ROLL_AXES
from crankpin._support.record import computed
from crankpin._support.tables import Column, Table
from crankpin.analysis.labelled import Labelled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from crankpin._support.frames import Frames
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.vehicle_axes import VehicleAxes

COORDINATES = ("fore-aft", "lateral", "bounce", "roll", "pitch", "yaw")
"""Names of the motions along z, x and y, and about z, x and y."""
AXES = ("x", "y", "z", "about x", "about y", "about z")
"""Names of displacements and rotations."""
PLACES = (2, 0, 1, 5, 3, 4)
"""Their places in (displacement along x, y, z, rotation about x, y, z)."""
OF_SUBFRAME = "subframe"
"""Flexible support, as a column."""


class MountModes(Labelled):
    """Natural modes of a powertrain on its mounts: six, or twelve with the subframe under them.

    Modes whose frequencies agree within rounding form a group, of which only the sum of energies
    is defined: each has the mean of its group. Motions that no mount resists have a frequency of
    exactly zero, and are named in ``free``. Made by :meth:`Powertrain.modes`.
    """

    _registry = MODES

    powertrain: Powertrain
    """The powertrain."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""
    groups: tuple[tuple[int, ...], ...] = computed()
    """Numbers of the modes of equal frequency, from 1, as tuples of one or more."""
    free: tuple[str, ...] = computed()
    """Motions that no mount resists, in words; empty where all are resisted."""

    def __post_init__(self) -> None:
        frequency, matrices, figures, group, free = self.powertrain._core.modes(self.at_frequency)
        shapes, energy, strain = matrices
        purity, loss, damped = figures
        groups = tuple(
            tuple(k + 1 for k, first in enumerate(group) if first == number)
            for number in sorted({*group})
        )
        arrays = {
            "frequency": frequency, "shapes": shapes, "energy": energy, "strain": strain,
            "purity": purity, "loss_factor": loss, "damped_frequency": damped,
            "subframe_share": energy[6:].sum(axis=0),
        }  # fmt: skip
        self.__dict__.update(_arrays=arrays, groups=groups, free=self.powertrain._free(free))
        super().__post_init__()

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        count, moves = self._arrays["energy"].shape[::-1]
        of_subframe = (f"{OF_SUBFRAME} {name}" for name in AXES)
        coordinates = (*AXES, *of_subframe)[:moves]
        mounts = tuple(self.powertrain._core.all_names)
        return {"mode": np.arange(1, count + 1), "coordinate": coordinates, "mount": mounts}

    @property
    def frequency(self) -> Quantity[np.float64]:
        """Natural frequencies without damping, Hz, ascending: (n_modes,)."""
        return self._quantity("frequency")

    @property
    def shapes(self) -> Quantity[np.float64]:
        """Displacement of the CG and rotation, of unit mass, a column each: (n_axes, n_modes).

        On a subframe those of its own CG follow: twelve rows.
        """
        return self._quantity("shapes")

    @property
    def energy(self) -> Quantity[np.float64]:
        """Kinetic energy of each mode along x, y, z and about x, y, z, %: (n_axes, n_modes).

        Of a subframe, as in ``shapes``, six more.

        100 φₖ (Mφ)ₖ: columns sum to 100, and entries can be below zero where the tensor of inertia
        has products. Another definition, by diagonal entries of M alone, differs by several
        points.
        """
        return self._quantity("energy")

    @property
    def strain(self) -> Quantity[np.float64]:
        """Share of each mount in the elastic energy of each mode, %: (n_mounts, n_modes).

        Mounts of a subframe follow those of the powertrain.
        """
        return self._quantity("strain")

    @property
    def purity(self) -> Quantity[np.float64]:
        """Largest share of one coordinate in the kinetic energy, %: (n_modes,).

        Of a group the mean of as many largest shares as it has modes.
        """
        return self._quantity("purity")

    @property
    def loss_factor(self) -> Quantity[np.float64]:
        """Im λ/Re λ of the complex eigenvalues λ: (n_modes,)."""
        return self._quantity("loss_factor")

    @property
    def damped_frequency(self) -> Quantity[np.float64]:
        """Square root of Re λ over 2π, Hz: (n_modes,)."""
        return self._quantity("damped_frequency")

    @property
    def subframe_share(self) -> Quantity[np.float64]:
        """Share of a subframe in the kinetic energy of each mode, %: (n_modes,).

        The rest is that of the powertrain; zero without a subframe.
        """
        return self._quantity("subframe_share")

    @property
    def dominant(self) -> tuple[str, ...]:
        """Coordinate with the largest share in the kinetic energy of each mode."""
        names = (*COORDINATES, *(f"{OF_SUBFRAME} {name}" for name in COORDINATES))
        places = [first + place for first in range(0, len(self.energy), 6) for place in PLACES]
        return tuple(names[k] for k in self.energy[places].argmax(axis=0))

    def _notes(self) -> str:
        notes = [f"No mount resists: {'; '.join(self.free)}."] if self.free else []
        for group in self.groups:
            if len(group) > 1:
                numbers = ", ".join(map(str, group))
                notes.append(
                    f"Modes {numbers} have one frequency: shares are the means of the group."
                )
        return " ".join(notes)

    def _title(self, of: str) -> str:
        at = "" if self.at_frequency is None else f" at {self.at_frequency:g} Hz"
        along = "" if self.powertrain.vehicle is None else " along and about the engine's axes"
        return f"{self.powertrain._title}: {of}{along}; dynamic stiffness{at}"

    def _by_mode(self) -> list[Column]:
        return [
            Column("mode", tuple(range(1, len(self.read("frequency")) + 1))),
            Column("f", self.read("frequency"), "Hz"),
        ]

    @property
    def table(self) -> Table:
        """Frequencies, kinetic energy by coordinate, purity, loss factors."""
        columns = self._by_mode()
        columns += self._shares(0)
        if len(self.energy) > 6:
            columns.append(Column(OF_SUBFRAME, self.read("subframe_share"), "%", decimals=1))
        columns.append(Column("purity", self.read("purity"), "%", decimals=1))
        columns.append(Column("loss factor", self.read("loss_factor")))
        title = self._title("kinetic energy φₖ(Mφ)ₖ of each mode")
        return Table(title, tuple(columns), self._notes())

    @property
    def frames(self) -> Frames:
        """``table``; ``strain``: shares of the mounts in the elastic energy of each mode.

        With a subframe ``subframe``: its kinetic energy by coordinate.
        """
        further = {OF_SUBFRAME: self._of_subframe} if len(self.energy) > 6 else {}
        return self._frames(strain=self._of_mounts, **further)

    def _shares(self, first: int) -> list[Column]:
        """Return columns of the kinetic energy of the body whose coordinates begin there."""
        places = zip(COORDINATES, PLACES, strict=True)
        return [Column(name, self.energy[first + place], "%", decimals=1) for name, place in places]

    def _of_subframe(self) -> Table:
        title = self._title("kinetic energy of the subframe in each mode")
        return Table(title, (*self._by_mode(), *self._shares(6)), self._notes())

    def _of_mounts(self) -> Table:
        columns = self._by_mode()
        names = self.powertrain._core.all_names
        for name, shares in zip(names, self.strain.tolist(), strict=True):
            columns.append(Column(name, tuple(shares), "%", decimals=1))
        return Table(self._title("elastic energy by mount"), tuple(columns), self._notes())


class RollAxes(Labelled):
    """Axes about which a powertrain rolls: free, and on its mounts under a slow or steady torque.

    Under a steady torque mounts have their static stiffness, as in :meth:`Powertrain.static`; under
    one that oscillates, however slowly, the dynamic one: figures of both are apart wherever these
    stiffnesses are. Made by :meth:`Powertrain.axes`.
    """

    _registry = ROLL_AXES

    powertrain: Powertrain
    """The powertrain."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""
    torque_roll_deg: float = computed()
    """Angle of the torque roll axis to the crank's axis, degrees."""
    elastic_deg: float = computed()
    """Angle of the elastic roll axis at rest to the crank's axis, degrees."""
    angle_deg: float = computed()
    """Angle between torque roll axis and elastic roll axis at rest, degrees."""
    distance: float = computed()
    """Shortest distance between torque roll axis and elastic roll axis at rest, m."""
    pitch: float = computed()
    """Shift along the elastic roll axis at rest over the rotation about it, m/rad."""
    roll_stiffness: float = computed()
    """Steady torque about z over the rotation about z that it makes, N·m/rad."""
    cg_distance: float = computed()
    """Distance of the elastic roll axis at rest from the centre of gravity, m."""
    elastic_centre: tuple[float, float, float] | None = computed()
    """Elastic centre at rest, m: a force through it causes no rotation; None where none is such."""
    dynamic_elastic_deg: float = computed()
    """As ``elastic_deg``, with the dynamic stiffness, degrees."""
    dynamic_angle_deg: float = computed()
    """As ``angle_deg``, with the dynamic stiffness, degrees; 0 where roll is decoupled."""
    dynamic_distance: float = computed()
    """As ``distance``, with the dynamic stiffness, m."""
    dynamic_pitch: float = computed()
    """As ``pitch``, with the dynamic stiffness, m/rad."""
    dynamic_roll_stiffness: float = computed()
    """Slowly oscillating torque about z over the rotation about z that it makes, N·m/rad."""
    dynamic_cg_distance: float = computed()
    """As ``cg_distance``, with the dynamic stiffness, m."""
    dynamic_elastic_centre: tuple[float, float, float] | None = computed()
    """As ``elastic_centre``, with the dynamic stiffness, m."""

    def __post_init__(self) -> None:
        free, free_deg, distances, elastic = self.powertrain._core.axes(self.at_frequency)
        values = {"torque_roll_deg": free_deg}
        arrays = {"torque_roll": np.array(free), "mount_distances": distances}
        for before, (places, figures, centre) in zip(("", "dynamic_"), elastic, strict=True):
            direction, foot, from_cg = map(np.array, places)
            *angles, pitch, compliance = figures
            named: dict[str, Any] = dict(
                zip(("elastic_deg", "angle_deg", "distance"), angles, strict=True)
            )
            named |= {"pitch": pitch, "roll_stiffness": 1.0 / compliance}
            named |= {"cg_distance": float(np.linalg.norm(from_cg))}
            turned = self._vehicle.from_engine if self._vehicle is not None else tuple
            named |= {"elastic_centre": None if centre is None else turned(centre)}
            values |= {f"{before}{name}": value for name, value in named.items()}
            arrays |= {f"{before}elastic": direction, f"{before}elastic_foot": foot}
            arrays |= {f"{before}elastic_offset": from_cg}
        self.__dict__.update(values, _arrays=arrays)
        super().__post_init__()

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"mount": self.powertrain.names}

    @property
    def _vehicle(self) -> VehicleAxes | None:
        return self.powertrain.vehicle

    def _turned(self, quantity: str, values: NDArray[Any]) -> NDArray[Any]:
        if self._vehicle is not None and quantity.endswith("_foot"):
            return np.array(self._vehicle.from_engine(values))
        return super()._turned(quantity, values)

    @property
    def elastic(self) -> Quantity[np.float64]:
        """Direction of the elastic roll axis at rest, towards the flywheel: (n_axes,).

        The axis of the screw that the powertrain makes under a steady torque about z.
        """
        return self._quantity("elastic")

    @property
    def dynamic_elastic(self) -> Quantity[np.float64]:
        """As ``elastic``, under a torque that oscillates slowly: (n_axes,)."""
        return self._quantity("dynamic_elastic")

    @property
    def torque_roll(self) -> Quantity[np.float64]:
        """Direction of the torque roll axis, through the CG, towards the flywheel: (n_axes,).

        About it the free powertrain turns under an oscillating torque of the crank.
        """
        return self._quantity("torque_roll")

    @property
    def mount_distances(self) -> Quantity[np.float64]:
        """Distance of each mount from the torque roll axis, m: (n_mounts,)."""
        return self._quantity("mount_distances")

    @property
    def elastic_foot(self) -> Quantity[np.float64]:
        """Point of the elastic roll axis at rest next to the CG, m: (n_axes,)."""
        return self._quantity("elastic_foot")

    @property
    def dynamic_elastic_foot(self) -> Quantity[np.float64]:
        """As ``elastic_foot``, with the dynamic stiffness, m: (n_axes,)."""
        return self._quantity("dynamic_elastic_foot")

    @property
    def elastic_offset(self) -> Quantity[np.float64]:
        """From the centre of gravity to the elastic roll axis at rest, across it, m: (n_axes,)."""
        return self._quantity("elastic_offset")

    @property
    def dynamic_elastic_offset(self) -> Quantity[np.float64]:
        """As ``elastic_offset``, with the dynamic stiffness, m: (n_axes,)."""
        return self._quantity("dynamic_elastic_offset")

    @property
    def table(self) -> Table:
        """Directions, angles to the crank, and places of the axes; below it the elastic centres."""
        cg = np.array(self.powertrain.body.cg)
        rows = [[*self.torque_roll, self.torque_roll_deg, *cg, *[0.0] * 5, None, None, None]]
        at = "" if self.at_frequency is None else f", {self.at_frequency:g} Hz"
        kinds, notes = ["torque roll axis (free)"], list[Any]()
        for name, stiffness in (("", "static"), ("dynamic_", "dynamic")):
            of_axis = ("elastic", "elastic_deg", "elastic_foot", "elastic_offset", "cg_distance")
            direction, angle, foot, offset, distance = (
                getattr(self, f"{name}{figure}") for figure in of_axis
            )
            figures = [getattr(self, f"{name}{figure}") for figure in ("pitch", "roll_stiffness")]
            apart = [getattr(self, f"{name}angle_deg"), 1e3 * getattr(self, f"{name}distance")]
            from_cg = [*(1e3 * offset), 1e3 * distance]
            rows.append([*direction, angle, *foot, *from_cg, *figures, *apart])
            which = f"{stiffness} stiffness{at if name else ''}"
            kinds.append(f"elastic roll axis ({which})")
            if (centre := getattr(self, f"{name}elastic_centre")) is None:
                notes.append(
                    f"No elastic centre with {which}: of any point, some force there turns it."
                )
                continue
            place = units.Figure(centre, "m", ".6g", "({}, {}, {})")
            off = units.figure(1e3 * float(np.linalg.norm(np.subtract(centre, cg))), "mm", 5)
            notes.append(
                units.Text(f"Elastic centre with {which}: ", place, ", ", off, " off the CG.")
            )
        heads: list[str | tuple[str, str]] = [f"direction {axis}" for axis in "xyz"]
        heads.append(("to the crank", "°"))
        heads += [(f"through {axis}", "m") for axis in "xyz"]
        heads += [*((f"from the CG {axis}", "mm") for axis in "xyz"), ("off the CG", "mm")]
        heads += [("pitch", "m/rad")]
        heads += [("roll stiffness", "N·m/rad"), ("to the first", "°"), ("off the first", "mm")]
        labelled = [[kind, *row] for kind, row in zip(kinds, rows, strict=True)]
        return Table.from_rows(
            f"{self.powertrain._title}: axes of roll",
            ["axis", *heads],
            labelled,
            note=units.joined(" ", notes),
        )
