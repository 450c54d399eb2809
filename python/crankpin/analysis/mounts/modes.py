"""Modes of a powertrain on its mounts, where their energy is, and its axes of rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
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


class MountModes(Tabled):
    """Six natural modes of a powertrain on its mounts.

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
        """Displacement of the CG and rotation, of unit mass, a column each: (n_axes, n_modes)."""
        return self.__dict__["_shapes"]  # type: ignore[no-any-return]

    @property
    def energy(self) -> NDArray[np.float64]:
        """Kinetic energy of each mode along x, y, z and about x, y, z, %: (n_axes, n_modes).

        100 φₖ (Mφ)ₖ: columns sum to 100, and entries can be below zero where the tensor of inertia
        has products. Another definition, by diagonal entries of M alone, differs by several
        points.
        """
        return self.__dict__["_energy"]  # type: ignore[no-any-return]

    @property
    def strain(self) -> NDArray[np.float64]:
        """Share of each mount in the elastic energy of each mode, %: (n_mounts, n_modes)."""
        return self.__dict__["_strain"]  # type: ignore[no-any-return]

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
            tuple(k + 1 for k in range(6) if group[k] == first) for first in sorted({*group})
        )

    @property
    def free(self) -> tuple[str, ...]:
        """Motions that no mount resists, in words; empty where all are resisted."""
        return self.__dict__["_free"]  # type: ignore[no-any-return]

    @property
    def dominant(self) -> tuple[str, ...]:
        """Coordinate with the largest share in the kinetic energy of each mode."""
        return tuple(COORDINATES[k] for k in self.energy[list(PLACES)].argmax(axis=0))

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
        return (
            f"{labels.name_of(self.powertrain.engine)} on its mounts: {of}; dynamic stiffness{at}"
        )

    def _by_mode(self) -> list[Column]:
        return [Column("mode", tuple(range(1, 7))), Column("f", self.frequency, "Hz")]

    @property
    def table(self) -> Table:
        """Frequencies, kinetic energy by coordinate, purity, loss factors."""
        columns = self._by_mode()
        for name, place in zip(COORDINATES, PLACES, strict=True):
            columns.append(Column(name, self.energy[place], "%", decimals=1))
        columns.append(Column("purity", self.purity, "%", decimals=1))
        columns.append(Column("loss factor", self.loss_factor))
        title = self._title("kinetic energy φₖ(Mφ)ₖ of each mode")
        return Table(title, tuple(columns), self._notes())

    @property
    def frames(self) -> Frames:
        """``table``; ``strain``: shares of the mounts in the elastic energy of each mode."""
        return self._frames(strain=self._of_mounts)

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
            The axes: a row for each mode, its frequency beside it; entries below zero are hatched.

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
        for name, shares in zip(self.powertrain.names, self.strain.tolist(), strict=True):
            columns.append(Column(name, tuple(shares), "%", decimals=1))
        return Table(self._title("elastic energy by mount"), tuple(columns), self._notes())


class RollAxes(Tabled):
    """Axes about which a powertrain rolls: free, and on its mounts at rest.

    Made by :meth:`Powertrain.axes`.
    """

    powertrain: Powertrain
    """The powertrain."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""

    def __post_init__(self) -> None:
        directions, distances, figures = self.powertrain._core.axes(self.at_frequency)
        torque_roll, elastic, foot = (read_only(np.array(each)) for each in directions)
        values = {"_torque_roll": torque_roll, "_elastic": elastic, "_foot": foot}
        self.__dict__.update(values, _distances=distances, _figures=figures)
        super().__post_init__()

    @property
    def torque_roll(self) -> NDArray[np.float64]:
        """Direction of the torque roll axis, through the CG, towards the flywheel: (n_axes,).

        About it the free powertrain turns under an oscillating torque of the crank.
        """
        return self.__dict__["_torque_roll"]  # type: ignore[no-any-return]

    @property
    def torque_roll_deg(self) -> float:
        """Angle of the torque roll axis to the crank's axis, degrees."""
        return self.__dict__["_figures"][0]  # type: ignore[no-any-return]

    @property
    def mount_distances(self) -> NDArray[np.float64]:
        """Distance of each mount from the torque roll axis, m: (n_mounts,)."""
        return self.__dict__["_distances"]  # type: ignore[no-any-return]

    @property
    def elastic(self) -> NDArray[np.float64]:
        """Direction of the elastic roll axis, towards the flywheel: (n_axes,).

        The axis of the screw that the powertrain makes under a torque about z at rest.
        """
        return self.__dict__["_elastic"]  # type: ignore[no-any-return]

    @property
    def elastic_deg(self) -> float:
        """Angle of the elastic roll axis to the crank's axis, degrees."""
        return self.__dict__["_figures"][1]  # type: ignore[no-any-return]

    @property
    def elastic_foot(self) -> NDArray[np.float64]:
        """Point of the elastic roll axis next to the CG, m: (n_axes,)."""
        return self.__dict__["_foot"]  # type: ignore[no-any-return]

    @property
    def pitch(self) -> float:
        """Shift along the elastic roll axis over the rotation about it, m/rad."""
        return self.__dict__["_figures"][4]  # type: ignore[no-any-return]

    @property
    def angle_deg(self) -> float:
        """Angle between torque roll axis and elastic roll axis, degrees."""
        return self.__dict__["_figures"][2]  # type: ignore[no-any-return]

    @property
    def distance(self) -> float:
        """Shortest distance between both axes, m."""
        return self.__dict__["_figures"][3]  # type: ignore[no-any-return]

    @property
    def roll_stiffness(self) -> float:
        """Torque about z over the rotation about z that it makes at rest, N·m/rad."""
        return 1.0 / self.__dict__["_figures"][5]  # type: ignore[no-any-return]

    @property
    def table(self) -> Table:
        """Directions, angles to the crank, and places of both axes."""
        cg = np.array(self.powertrain.body.cg)
        rows = [
            [*self.torque_roll, self.torque_roll_deg, *cg, 0.0],
            [*self.elastic, self.elastic_deg, *self.elastic_foot, self.pitch],
        ]
        heads: list[str | tuple[str, str]] = [f"direction {axis}" for axis in "xyz"]
        heads.append(("to the crank", "°"))
        heads += [*((f"through {axis}", "m") for axis in "xyz"), ("pitch", "m/rad")]
        note = f"{self.angle_deg:.4g}° and {1e3 * self.distance:.4g} mm between both axes."
        title = f"{labels.name_of(self.powertrain.engine)} on its mounts: axes of roll"
        kinds = ["torque roll axis (free)", "elastic roll axis (screw)"]
        return Table.from_rows(title, ["axis", *heads], kinds, np.array(rows), note=note)

    def plot(
        self, ax: Axes | None = None, *, figure: FigureBase | None = None, **style: object
    ) -> Any:  # noqa: ANN401 - axes, or an array of them
        """Draw both axes with mounts, their polygon and the CG, from three sides.

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
