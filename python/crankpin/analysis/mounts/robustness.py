"""Ranges of natural frequencies and purity of modes within tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, units
from crankpin._support.quantities import ROBUSTNESS
from crankpin._support.record import computed
from crankpin._support.tables import Column, Table
from crankpin.analysis.labelled import Labelled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from crankpin._support.frames import Frames
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity


class MountRobustness(Labelled):
    """Bounds of natural frequencies and of purity within tolerances of a powertrain.

    Every frequency grows with each stiffness, and falls with mass and inertia (Courant and
    Fischer), so that its bounds are exactly those at the two ends, without corners between; of one
    tolerance x of all stiffnesses they are f·√(1 ± x). Purity has no such law, and is least where
    two frequencies approach each other and their modes mix, often inside: it is searched, and what
    is reported is the least found, no bound. Tolerances are those of the body and its own mounts; a
    subframe is as it is. Made by :meth:`Powertrain.robustness`.
    """

    _registry = ROBUSTNESS

    powertrain: Powertrain
    """The powertrain."""
    stiffness: tuple[float, ...]
    """Tolerance of the stiffness of each mount, over it."""
    mass: float
    """Tolerance of the mass, over it."""
    inertia: float
    """Tolerance of the tensor of inertia, over it."""
    cg: float
    """Tolerance of the centre of gravity along x, y and z, m."""
    by_axis: bool
    """True if the axes of a mount are at either end each by itself in corners."""
    at_frequency: float | None
    """Frequency at which dynamic stiffness is taken, Hz; None where it does not depend on it."""
    _factors: Any = computed()

    def __post_init__(self) -> None:
        tolerances = (list(self.stiffness), self.mass, self.inertia, self.cg, self.by_axis)
        nominal, ends, slope, factors = self.powertrain._core.robustness(
            tolerances, self.at_frequency
        )
        names = ("frequency", "purity", "least_purity")
        arrays = dict(zip(names, map(np.asarray, nominal), strict=True)) | {"cg_slope": slope}
        ranges = ("frequency_bounds", "mass_bounds", "cg_range")
        arrays |= dict(zip(ranges, ends, strict=True))
        self.__dict__.update(_arrays=arrays, _factors=factors)
        super().__post_init__()

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        modes = np.arange(1, self._arrays["frequency"].size + 1)
        return {"mode": modes, "coordinate": ("x", "y", "z"), "bound": ("least", "largest")}

    @property
    def frequency(self) -> Quantity[np.float64]:
        """Natural frequencies without tolerances, Hz, ascending: (n_modes,)."""
        return self._quantity("frequency")

    @property
    def purity(self) -> Quantity[np.float64]:
        """Purity of each mode without tolerances, %: (n_modes,)."""
        return self._quantity("purity")

    @property
    def cg_slope(self) -> Quantity[np.float64]:
        """Derivatives of the frequencies by the place of the CG, Hz/m: (n_axes, n_modes).

        Of modes of one frequency the mean.
        """
        return self._quantity("cg_slope")

    @property
    def least_purity(self) -> Quantity[np.float64]:
        """Least purity of each mode found within the tolerance of stiffness, %: (n_modes,).

        By a search: at all corners, at 4096 random points, and from the worst of them along lines.
        """
        return self._quantity("least_purity")

    @property
    def frequency_bounds(self) -> Quantity[np.float64]:
        """Least and largest frequencies within the tolerance of stiffness, Hz: (2, n_modes)."""
        return self._quantity("frequency_bounds")

    @property
    def mass_bounds(self) -> Quantity[np.float64]:
        """Least and largest frequencies within those of mass and inertia, Hz: (2, n_modes)."""
        return self._quantity("mass_bounds")

    @property
    def cg_range(self) -> Quantity[np.float64]:
        """Least and largest frequencies with the CG at eight corners, Hz: (2, n_modes).

        The corners of the cube ± ``cg`` about its place, and that; frequencies are not monotone in
        it, so that these are no bounds.
        """
        return self._quantity("cg_range")

    def least_pure(self, mode: int) -> Mapping[str, tuple[float, ...]]:
        """Return the stiffnesses at which a mode was found least pure.

        Parameters
        ----------
        mode : int
            Number of the mode, from 1.

        Returns
        -------
        mapping of str to tuple of float
            Name of a mount to the factors of the stiffness along its axes.

        Raises
        ------
        InputError
            If there is no such mode.
        """
        number, count = inputs.whole("mode", mode), len(self.frequency)
        if not 1 <= number <= count:
            raise inputs.rejected("mode", mode, f"give a number from 1 to {count}")
        factors = self._factors[number - 1]
        return dict(zip(self.powertrain.names, map(tuple, factors), strict=False))

    @property
    def table(self) -> Table:
        """Frequencies and their bounds, purity and the least that was found."""
        columns = self._modes()
        bounds = [("f", self.read("frequency"))]
        if any(self.stiffness):
            bounds += zip(("f least", "f largest"), self.frequency_bounds, strict=True)
        if self.mass or self.inertia:
            heads = ("f least by mass", "f largest by mass")
            bounds += zip(heads, self.mass_bounds, strict=True)
        if self.cg:
            bounds += zip(("f least by CG", "f largest by CG"), self.cg_range, strict=True)
        columns += [Column(head, values, "Hz") for head, values in bounds]
        for head, values in (
            ("purity", self.read("purity")),
            ("least found", self.read("least_purity")),
        ):
            columns.append(Column(head, values, "%", decimals=1))
        shares = sorted({100.0 * share for share in self.stiffness})
        parts: list[str] = [f"stiffness ± {' or '.join(f'{share:g}' for share in shares)} %"]
        parts += [f"mass ± {100 * self.mass:g} %"] if self.mass else []
        parts += [f"inertia ± {100 * self.inertia:g} %"] if self.inertia else []
        parts += [units.Text("CG ± ", units.figure(1e3 * self.cg, "mm", 6))] if self.cg else []
        title = units.Text(f"{self.powertrain._title}: ", units.joined(", ", parts))
        note = "Purity: the least that a search within the tolerance of stiffness found."
        return Table(title, tuple(columns), note if any(self.stiffness) else "")

    def _modes(self) -> list[Column]:
        return [Column("mode", tuple(range(1, len(self.read("frequency")) + 1)))]

    @property
    def frames(self) -> Frames:
        """``table``; ``cg``: derivatives of the frequencies by the place of the CG."""
        return self._frames(cg=self._of_cg)

    def _of_cg(self) -> Table:
        columns = self._modes()
        columns.append(Column("f", tuple(self.frequency.tolist()), "Hz"))
        for axis, values in zip("xyz", self.cg_slope, strict=True):
            columns.append(Column(f"df/d{axis}", tuple((1e-3 * values).tolist()), "Hz/mm"))
        title = f"{self.powertrain._title}: frequencies by the place of the CG"
        return Table(title, tuple(columns))
