"""Modes of a powertrain on its mounts, their shares of energy, and its axes of rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support.drawing import draw
from crankpin._support.frames import Frames, Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import NDArray

    from crankpin.analysis.mounts.powertrain import Powertrain

COORDINATES = ("fore-aft", "lateral", "bounce", "roll", "pitch", "yaw")
"""Names of the motions along z, x and y, and about z, x and y."""
PLACES = (2, 0, 1, 5, 3, 4)
"""Their places in (displacement along x, y, z, rotation about x, y, z)."""
OF_SUBFRAME = "subframe"
"""Flexible support, as a column."""


class MountModes(Tabled):
    """Natural modes of a powertrain on its mounts: six, or twelve with the subframe under them.

    Modes whose frequencies agree within rounding form a group, of which only the sum of energies
    is defined: each has the mean of its group. Motions that no mount resists have a frequency of
    exactly zero, and are named in ``free``. Made by :meth:`Powertrain.modes`.
    """

    powertrain: Powertrain
    """The powertrain."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""

    def __post_init__(self) -> None:
        frequency, arrays, figures, group, free = self.powertrain._core.modes(self.at_frequency)
        shapes, energy, strain = arrays
        purity, loss, damped = figures
        names = ("frequency", "shapes", "energy", "strain", "purity", "loss_factor")
        values: dict[str, Any] = dict(
            zip(names, (frequency, shapes, energy, strain, purity, loss), strict=True)
        )
        values |= {"damped_frequency": damped, "group": tuple(group), "free": tuple(free)}
        self.__dict__.update({f"_{name}": value for name, value in values.items()})
        super().__post_init__()

    @property
    def frequency(self) -> NDArray[np.float64]:
        """Natural frequencies without damping, Hz, ascending: (n_modes,)."""
        return self.__dict__["_frequency"]  # type: ignore[no-any-return]

    @property
    def shapes(self) -> NDArray[np.float64]:
        """Displacement of the CG and rotation, of unit mass, a column each: (n_axes, n_modes).

        On a subframe those of its own CG follow: twelve rows.
        """
        return self.__dict__["_shapes"]  # type: ignore[no-any-return]

    @property
    def energy(self) -> NDArray[np.float64]:
        """Kinetic energy of each mode along x, y, z and about x, y, z, %: (n_axes, n_modes).

        Of a subframe, as in ``shapes``, six more.

        100 φₖ (Mφ)ₖ: columns sum to 100, and entries can be below zero where the tensor of inertia
        has products. Another definition, by diagonal entries of M alone, differs by several
        points.
        """
        return self.__dict__["_energy"]  # type: ignore[no-any-return]

    @property
    def strain(self) -> NDArray[np.float64]:
        """Share of each mount in the elastic energy of each mode, %: (n_mounts, n_modes).

        Mounts of a subframe follow those of the powertrain.
        """
        return self.__dict__["_strain"]  # type: ignore[no-any-return]

    @property
    def subframe_share(self) -> NDArray[np.float64]:
        """Share of a subframe in the kinetic energy of each mode, %: (n_modes,).

        The rest is that of the powertrain; zero without a subframe.
        """
        return read_only(self.energy[6:].sum(axis=0))

    @property
    def purity(self) -> NDArray[np.float64]:
        """Largest share of one coordinate in the kinetic energy, %: (n_modes,).

        Of a group the mean of as many largest shares as it has modes.
        """
        return self.__dict__["_purity"]  # type: ignore[no-any-return]

    @property
    def loss_factor(self) -> NDArray[np.float64]:
        """Im λ/Re λ of the complex eigenvalues λ: (n_modes,)."""
        return self.__dict__["_loss_factor"]  # type: ignore[no-any-return]

    @property
    def damped_frequency(self) -> NDArray[np.float64]:
        """Square root of Re λ over 2π, Hz: (n_modes,)."""
        return self.__dict__["_damped_frequency"]  # type: ignore[no-any-return]

    @property
    def groups(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the modes of equal frequency, from 1, as tuples of one or more."""
        group: tuple[int, ...] = self.__dict__["_group"]
        return tuple(
            tuple(k + 1 for k, own in enumerate(group) if own == first)
            for first in sorted({*group})
        )

    @property
    def free(self) -> tuple[str, ...]:
        """Motions that no mount resists, in words; empty where all are resisted."""
        return self.__dict__["_free"]  # type: ignore[no-any-return]

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
                listed = ", ".join(map(str, group))
                notes.append(
                    f"Modes {listed} have one frequency: shares are the means of the group."
                )
        return " ".join(notes)

    def _title(self, of: str) -> str:
        at = "" if self.at_frequency is None else f" at {self.at_frequency:g} Hz"
        return f"{self.powertrain._title}: {of}; dynamic stiffness{at}"

    def _by_mode(self) -> list[Column]:
        return [
            Column("mode", tuple(range(1, len(self.frequency) + 1))),
            Column("f", self.frequency, "Hz"),
        ]

    @property
    def table(self) -> Table:
        """Frequencies, kinetic energy by coordinate, purity, loss factors."""
        columns = self._by_mode()
        columns += self._shares(0)
        if len(self.energy) > 6:
            columns.append(Column(OF_SUBFRAME, self.subframe_share, "%", decimals=1))
        columns.append(Column("purity", self.purity, "%", decimals=1))
        columns.append(Column("loss factor", self.loss_factor))
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

    def plot(self, ax: Axes | None = None, **options: object) -> Axes:
        """Draw the kinetic energy of each mode by coordinate; return the axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; by default new ones.
        **options : dict, optional
            ``cmap`` and other properties of matplotlib images.

        Returns
        -------
        matplotlib.axes.Axes
            The axes: a row for each mode, its frequency beside it, and a column for a subframe;
            entries below zero are hatched.

        Raises
        ------
        InputError
            If an option is unknown.
        ImportError
            If matplotlib is not installed.
        """
        return draw(self, ax, **options)  # type: ignore[no-any-return]

    def _of_mounts(self) -> Table:
        columns = self._by_mode()
        names = self.powertrain._core.all_names
        for name, shares in zip(names, self.strain.tolist(), strict=True):
            columns.append(Column(name, tuple(shares), "%", decimals=1))
        return Table(self._title("elastic energy by mount"), tuple(columns), self._notes())


class RollAxes(Tabled):
    """Axes about which a powertrain rolls: free, and on its mounts under a slow or steady torque.

    Under a steady torque mounts have their static stiffness, as in :meth:`Powertrain.static`; under
    one that oscillates, however slowly, the dynamic one: figures of both are apart wherever these
    stiffnesses are. Made by :meth:`Powertrain.axes`.
    """

    powertrain: Powertrain
    """The powertrain."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""

    def __post_init__(self) -> None:
        free, free_deg, distances, elastic = self.powertrain._core.axes(self.at_frequency)
        values: dict[str, Any] = {"_free": read_only(np.array(free)), "_free_deg": free_deg}
        for name, ((direction, foot), figures) in zip(("", "dynamic_"), elastic, strict=True):
            values[f"_{name}elastic"] = read_only(np.array(direction))
            values[f"_{name}foot"] = read_only(np.array(foot))
            values[f"_{name}figures"] = figures
        self.__dict__.update(values, _distances=distances)
        super().__post_init__()

    @property
    def torque_roll(self) -> NDArray[np.float64]:
        """Direction of the torque roll axis, through the CG, towards the flywheel: (n_axes,).

        About it the free powertrain turns under an oscillating torque of the crank.
        """
        return self.__dict__["_free"]  # type: ignore[no-any-return]

    @property
    def torque_roll_deg(self) -> float:
        """Angle of the torque roll axis to the crank's axis, degrees."""
        return self.__dict__["_free_deg"]  # type: ignore[no-any-return]

    @property
    def mount_distances(self) -> NDArray[np.float64]:
        """Distance of each mount from the torque roll axis, m: (n_mounts,)."""
        return self.__dict__["_distances"]  # type: ignore[no-any-return]

    @property
    def elastic(self) -> NDArray[np.float64]:
        """Direction of the elastic roll axis at rest, towards the flywheel: (n_axes,).

        The axis of the screw that the powertrain makes under a steady torque about z.
        """
        return self.__dict__["_elastic"]  # type: ignore[no-any-return]

    @property
    def elastic_deg(self) -> float:
        """Angle of the elastic roll axis at rest to the crank's axis, degrees."""
        return self.__dict__["_figures"][0]  # type: ignore[no-any-return]

    @property
    def elastic_foot(self) -> NDArray[np.float64]:
        """Point of the elastic roll axis at rest next to the CG, m: (n_axes,)."""
        return self.__dict__["_foot"]  # type: ignore[no-any-return]

    @property
    def angle_deg(self) -> float:
        """Angle between torque roll axis and elastic roll axis at rest, degrees."""
        return self.__dict__["_figures"][1]  # type: ignore[no-any-return]

    @property
    def distance(self) -> float:
        """Shortest distance between torque roll axis and elastic roll axis at rest, m."""
        return self.__dict__["_figures"][2]  # type: ignore[no-any-return]

    @property
    def pitch(self) -> float:
        """Shift along the elastic roll axis at rest over the rotation about it, m/rad."""
        return self.__dict__["_figures"][3]  # type: ignore[no-any-return]

    @property
    def roll_stiffness(self) -> float:
        """Steady torque about z over the rotation about z that it makes, N·m/rad."""
        return 1.0 / self.__dict__["_figures"][4]  # type: ignore[no-any-return]

    @property
    def dynamic_elastic(self) -> NDArray[np.float64]:
        """As ``elastic``, under a torque that oscillates slowly: (n_axes,)."""
        return self.__dict__["_dynamic_elastic"]  # type: ignore[no-any-return]

    @property
    def dynamic_elastic_deg(self) -> float:
        """As ``elastic_deg``, with the dynamic stiffness, degrees."""
        return self.__dict__["_dynamic_figures"][0]  # type: ignore[no-any-return]

    @property
    def dynamic_elastic_foot(self) -> NDArray[np.float64]:
        """As ``elastic_foot``, with the dynamic stiffness, m: (n_axes,)."""
        return self.__dict__["_dynamic_foot"]  # type: ignore[no-any-return]

    @property
    def dynamic_angle_deg(self) -> float:
        """As ``angle_deg``, with the dynamic stiffness, degrees; 0 where roll is decoupled."""
        return self.__dict__["_dynamic_figures"][1]  # type: ignore[no-any-return]

    @property
    def dynamic_distance(self) -> float:
        """As ``distance``, with the dynamic stiffness, m."""
        return self.__dict__["_dynamic_figures"][2]  # type: ignore[no-any-return]

    @property
    def dynamic_pitch(self) -> float:
        """As ``pitch``, with the dynamic stiffness, m/rad."""
        return self.__dict__["_dynamic_figures"][3]  # type: ignore[no-any-return]

    @property
    def dynamic_roll_stiffness(self) -> float:
        """Slowly oscillating torque about z over the rotation about z that it makes, N·m/rad."""
        return 1.0 / self.__dict__["_dynamic_figures"][4]  # type: ignore[no-any-return]

    @property
    def table(self) -> Table:
        """Directions, angles to the crank, and places of the axes."""
        cg = np.array(self.powertrain.body.cg)
        rows = [[*self.torque_roll, self.torque_roll_deg, *cg, 0.0, None, None, None]]
        for name in ("", "dynamic_"):
            figures = self.__dict__[f"_{name}figures"]
            place = [*self.__dict__[f"_{name}elastic"], figures[0], *self.__dict__[f"_{name}foot"]]
            stiffness = 1.0 / figures[4]
            rows.append([*place, figures[3], stiffness, figures[1], 1e3 * figures[2]])
        heads: list[str | tuple[str, str]] = [f"direction {axis}" for axis in "xyz"]
        heads.append(("to the crank", "°"))
        heads += [*((f"through {axis}", "m") for axis in "xyz"), ("pitch", "m/rad")]
        heads += [("roll stiffness", "N·m/rad"), ("to the first", "°"), ("off the first", "mm")]
        at = "" if self.at_frequency is None else f", {self.at_frequency:g} Hz"
        kinds = ["torque roll axis (free)", "elastic roll axis (static stiffness)"]
        kinds.append(f"elastic roll axis (dynamic stiffness{at})")
        listed = [[kind, *row] for kind, row in zip(kinds, rows, strict=True)]
        return Table.from_rows(f"{self.powertrain._title}: axes of roll", ["axis", *heads], listed)

    def plot(
        self, ax: Axes | None = None, *, figure: FigureBase | None = None, **style: object
    ) -> Any:  # noqa: ANN401 - axes, or an array of them
        """Draw the axes with mounts, their polygon and the CG, from three sides.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw the view from the side on.
        figure : matplotlib.figure.Figure or SubFigure, optional
            Figure to draw the views in; by default a new one.
        **style : dict, optional
            Properties of the lines of both axes.

        Returns
        -------
        matplotlib.axes.Axes or ndarray of Axes
            The axes given, or the panels.

        Raises
        ------
        InputError
            If axes and a figure are given, or an option is unknown.
        ImportError
            If matplotlib is not installed.
        """
        return draw(self, ax, figure=figure, **style)
