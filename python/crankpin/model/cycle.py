"""Cylinder pressure over a cycle, and its torque."""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from crankpin import _core
from crankpin._core import ATMOSPHERE
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.messages import suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import Input, read_only
from crankpin._support.tables import Column, Table
from crankpin.model import checks, cycle_files, odd_cycles
from crankpin.model.computed_cycles import ENDS, ComputedCycles, area

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path
    from typing import Unpack

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.cycle_files import FileOptions
    from crankpin.model.cylinder import Cylinder

EVEN = 1e-6
"""Difference between steps of a grid, over the largest, up to which they are equal."""

PARTS_OF_STEP = 8
"""Parts of a step between two points over which the piston's way is summed."""


class Cycle(Tabled, Input, ComputedCycles):
    """Absolute pressure in a cylinder over one cycle.

    Between the points of a table pressure is interpolated by cubics whose slopes are of fourth
    order and limited so that monotone data are not overshot; an angle that is given twice is one
    at which pressure jumps. A grid that ends with the point of its beginning, 720° later, is
    recognised as closed.

    Parameters
    ----------
    theta_deg : array_like, shape (n,)
        Crank angles after the firing top dead centre, ascending over one period from any start,
        degrees: (n,). Steps may differ.
    pressure : array_like, shape (n,)
        Absolute pressure there, Pa: (n,).
    strokes : {4, 2}, default 4
        4 for a period of 720°, 2 for one of 360°.
    name : str, optional
        Name or origin; may be empty.
    degree : int, optional
        None for a table. Otherwise the points are Chebyshev points of adjoining panels,
        ``degree + 1`` of each, and pressure is the polynomial through them.
    origin : str, optional
        How it was measured, read or computed, in words: a line under the table.

    Raises
    ------
    InputError
        If angles are not ascending or do not cover one period, or a pressure is below that of a
        vacuum by more than an atmosphere.

    Warns
    -----
    UserWarning
        If pressure seems to be in another unit or gauge pressure, or its peak is far from the
        firing top dead centre.

    Examples
    --------
    >>> import crankpin as cp
    >>> import numpy as np
    >>> theta = np.linspace(-360, 360, 721)
    >>> cycle = cp.Cycle(theta, 1e5 + 3e6 * np.exp(-(((theta - 15) / 30) ** 2)))
    >>> cycle.grid
    'closed, every 1°'
    >>> float(cycle.pressure_at(15).round())
    3100000.0
    """

    theta_deg: NDArray[np.float64]
    """Crank angles of the points, degrees: (n,)."""
    pressure: NDArray[np.float64]
    """Absolute pressure there, Pa: (n,)."""
    strokes: int
    """4 or 2."""
    name: str
    """Name or origin; may be empty."""
    degree: int | None
    """Degree of the polynomials through the points; None for a table."""
    origin: str = dataclasses.field(default="", compare=False)
    """How it was measured, read or computed, in words; may be empty. It does not count in equality
    and is not in files."""

    def __init__(
        self,
        theta_deg: ArrayLike,
        pressure: ArrayLike,
        strokes: int = 4,
        name: str = "",
        degree: int | None = None,
        origin: str = "",
    ) -> None:
        for field, values in (("theta_deg", theta_deg), ("pressure", pressure)):
            object.__setattr__(self, field, read_only(inputs.vector(field, values).copy()))
        object.__setattr__(self, "strokes", inputs.strokes(strokes))
        object.__setattr__(self, "name", inputs.text("name", name))
        if degree is not None:
            degree = inputs.whole("degree", degree)
            if not 0 <= degree < len(self.theta_deg):
                raise inputs.rejected(
                    "degree",
                    degree,
                    f"give one below the number of points, {len(self.theta_deg)}, or leave it out",
                )
        object.__setattr__(self, "degree", degree)
        object.__setattr__(self, "origin", inputs.text("origin", origin))
        if len(self._core):
            checks.cycle(self._core)

    @classmethod
    def _of(cls, core: _core.Cycle, origin: str = "") -> Self:
        """Return the cycle of what the core has."""
        return cls(**core.points, origin=origin)

    @functools.cached_property
    def _core(self) -> _core.Cycle:
        """Points as the core takes them, checked."""
        return _core.Cycle(self.theta_deg, self.pressure, self.strokes, self.name, self.degree)

    @classmethod
    @documented(cycle_files.load)
    def load(cls, path: str | Path, **options: Unpack[FileOptions]) -> Cycle:
        """Return the cycle in a file of crank angle and pressure; of several their mean.

        Returns
        -------
        Cycle
            The cycle, its angles counted from the firing top dead centre; ``origin`` says what was
            read.
        """
        theta, pressure, strokes, name, origin, degree = cycle_files.load(path, **options)
        if degree is None:
            odd_cycles.report(odd_cycles.find(theta, pressure, 180.0 * strokes))
        return cls(theta, pressure.mean(axis=0), strokes, name, degree, origin)

    def save(self, path: str | Path) -> None:
        """Write the points to a text file, ``.csv`` or the like, that reads back as an equal cycle.

        Blanks and line breaks in the name become single blanks.

        Parameters
        ----------
        path : str or pathlib.Path
            ``.csv``, ``.tsv``, ``.txt``, ``.dat`` or ``.asc``.

        Raises
        ------
        InputError
            If the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        cycle_files.save(self, path)

    @property
    def period_deg(self) -> float:
        """720° or 360°."""
        return 180.0 * self.strokes

    @property
    def grid(self) -> str:
        """Description of the points: closed or open, and their steps."""
        if self.degree is not None:
            panels = len(self.theta_deg) // (self.degree + 1)
            return f"{panels} polynomials of degree {self.degree}"
        steps = np.diff(self.theta_deg)
        steps = steps[steps > 0.0]
        if not (closed := self._core.is_closed):
            steps = np.append(steps, self.period_deg - float(np.ptp(self.theta_deg)))
        least, most = float(steps.min()), float(steps.max())
        even = most - least <= EVEN * most
        every = f"every {most:.6g}°" if even else f"steps of {least:.4g}° to {most:.4g}°"
        return f"{'closed' if closed else 'open'}, {every}"

    def pressure_at(self, theta_deg: ArrayLike) -> NDArray[np.float64]:
        """Return the absolute pressure at crank angles, Pa.

        Parameters
        ----------
        theta_deg : array_like
            Crank angles after the firing top dead centre, degrees; any value and shape. Where
            pressure jumps, the value after the jump counts.

        Returns
        -------
        ndarray of float, shape of theta_deg
            Absolute pressure, Pa.

        Raises
        ------
        InputError
            If an angle is no finite number.
        """
        theta = inputs.array("theta_deg", theta_deg)
        return self._core.pressure(theta.ravel()).reshape(theta.shape)

    def work(self, cylinder: Cylinder) -> float:
        """Return the indicated work of a cycle, ∮p dV, J.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.

        Returns
        -------
        float
            Indicated work, J.

        Raises
        ------
        InputError
            If the cylinder has no bore.
        """
        return self.mean_torque(cylinder) * math.radians(self.period_deg)

    def imep(self, cylinder: Cylinder, *, end: Literal["head", "crank"] = "head") -> float:
        """Return the indicated mean effective pressure, work over displacement, Pa.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore; its displacement follows from the travel of the piston, which a
            pin offset lengthens.
        end : {"head", "crank"}, default "head"
            End of the cylinder at which the pressure is.

        Returns
        -------
        float
            Indicated mean effective pressure, Pa.

        Raises
        ------
        InputError
            If the cylinder has no bore.
        """
        area(cylinder)  # an error without a bore, on which it does not depend
        chosen = inputs.one_of("end", end, ENDS)
        mean_pressure = self._core.imep(cylinder._parts, chosen)
        checks.work(self._core, mean_pressure)
        return mean_pressure

    def mean_torque(self, cylinder: Cylinder) -> float:
        """Return the mean torque of the pressure on the crank, N·m.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.

        Returns
        -------
        float
            Mean torque, N·m.

        Raises
        ------
        InputError
            If the cylinder has no bore.
        """
        scale = area(cylinder) * cylinder.crank_radius
        return self._core.torque(cylinder._parts, ATMOSPHERE, [])[0] * scale

    def torque_harmonics(
        self, cylinder: Cylinder, orders: Order | Iterable[Order], *, crankcase: float = ATMOSPHERE
    ) -> NDArray[np.complex128]:
        """Return the peak phasors of the torque of the pressure on the crank, N·m: (n_orders,).

        The torque of one cylinder on its crank is its mean and ``Re Σ Tₖ exp(ikθ)``, θ from the
        firing top dead centre. It is computed from the pressure difference between cylinder and
        crankcase, over the exact motion of the piston.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.
        orders : number or sequence of numbers
            Multiples of crank speed, whole or half; those of a two-stroke are whole, its half
            orders zero.
        crankcase : float, default 101325.0
            Absolute pressure below the piston, Pa.

        Returns
        -------
        ndarray of complex, shape (n_orders,)
            Peak phasors, N·m.

        Raises
        ------
        InputError
            If the cylinder has no bore, or an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> import numpy as np
        >>> theta = np.arange(-360, 360)
        >>> cycle = cp.Cycle(theta, 1e5 + 3e6 * np.exp(-(((theta - 15) / 30) ** 2)))
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> abs(cycle.torque_harmonics(cylinder, [0.5, 1, 1.5])).round(1)
        array([33.6, 34.8, 36.4])
        """
        halves = [round(2 * order) for order in inputs.explicit_half_orders(orders)]
        scale = area(cylinder) * cylinder.crank_radius
        below = inputs.number("crankcase", crankcase)
        checks.absolute("crankcase", below)
        return self._core.torque(cylinder._parts, below, halves)[1] * scale

    @documented(torque_harmonics)
    def resolution_error(
        self, cylinder: Cylinder, orders: Order | Iterable[Order], *, crankcase: float = ATMOSPHERE
    ) -> NDArray[np.float64]:
        """Return an estimate of the harmonics' error from the table's resolution, N·m: (n_orders,).

        It is the largest change of each phasor when every other point is left out. Cubics through
        twice as many points have an error some 16 times smaller where pressure is smooth, and half
        as large beside a jump between points: the change exceeds the error of the whole table if
        that is at most half of the thinned table's. Of peaks 4° to 40° wide at steps of 0.5° to 4°,
        two harmonics in a thousand have errors above it, up to six times, where the two errors are
        alike by chance; the largest over orders ½ to 12 never is. It is no bound, which
        :meth:`resolution_bound` is. Of a measured trace it is what interpolation adds: noise,
        coarse digits and the sensor's own error are in the points, which both tables share, and can
        be hundreds of times larger; :meth:`Traces.resolution_error` has them from the spread over
        cycles. Zero for polynomials, of which it is a bound.

        Returns
        -------
        ndarray of float, shape (n_orders,)
            Estimated errors, N·m; zero for polynomials.

        Raises
        ------
        InputError
            If half of the points are fewer than a table has.
        """
        whole = self.torque_harmonics(cylinder, orders, crankcase=crankcase)
        error = np.zeros(whole.shape)
        if self.degree is not None:
            return error
        for from_second in (False, True):
            half = self._core.thinned(from_second)
            if half is None:
                count = len(self.theta_deg)
                raise inputs.faulty(
                    "theta_deg",
                    f"has {count} points",
                    "give 16 or more for an estimate of the error",
                )
            with suppressed():  # Warned of where the whole was given.
                thinned = Cycle._of(half)
                coarse = thinned.torque_harmonics(cylinder, orders, crankcase=crankcase)
            np.maximum(error, abs(coarse - whole), out=error)
        return error

    @documented(torque_harmonics)
    def resolution_bound(
        self, cylinder: Cylinder, orders: Order | Iterable[Order], *, crankcase: float = ATMOSPHERE
    ) -> NDArray[np.float64]:
        """Return a bound of the harmonics' error from the table's resolution, N·m: (n_orders,).

        It is proved for any pressure that between two neighbouring points stays between their two
        values, as it does where all its extremes are points: then it differs from the cubic there
        by their range and the cubic's at most. It falls with the step, where the error of smooth
        pressure falls with its fourth power: far above :meth:`resolution_error`, and certain. It is
        one for all orders, and half of it one of the mean torque.

        Parameters
        ----------
        crankcase : float, default 101325.0
            …; it makes no error.

        Returns
        -------
        ndarray of float, shape (n_orders,)
            Bound of the magnitude of the error of each phasor, N·m; zero for polynomials.

        Examples
        --------
        >>> import crankpin as cp
        >>> import numpy as np
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> theta = np.arange(-360, 360)
        >>> cycle = cp.Cycle(theta, 1e5 + 3e6 * np.exp(-(((theta - 15) / 30) ** 2)))
        >>> cycle.resolution_bound(cylinder, [12]).round(2)
        array([2.23])
        >>> cycle.resolution_error(cylinder, [12]).round(5)  # an estimate
        array([8.e-05])
        """
        chosen = inputs.explicit_half_orders(orders)
        checks.absolute("crankcase", inputs.finite("crankcase", crankcase))
        scale = 2.0 * area(cylinder) / math.radians(self.period_deg)
        if self.degree is not None:
            return np.zeros(len(chosen))
        start = float(self.theta_deg[0])
        edges = np.append(self.theta_deg, start + self.period_deg)
        steps = np.diff(edges)
        before, steps = edges[:-1][steps > 0.0], steps[steps > 0.0]
        shares = np.arange(PARTS_OF_STEP + 1) / PARTS_OF_STEP
        angles = before[:, None] + steps[:, None] * shares
        inside = before[:, None] + steps[:, None] * np.array([1e-9, 1.0 / 3.0, 2.0 / 3.0, 1 - 1e-9])
        first, second, third, fourth = self.pressure_at(inside).T
        # A cubic is between the least and largest of its control points (Bernstein).
        controls = np.stack(
            [
                first,
                (-5.0 * first + 18.0 * second - 9.0 * third + 2.0 * fourth) / 6.0,
                (2.0 * first - 9.0 * second + 18.0 * third - 5.0 * fourth) / 6.0,
                fourth,
            ]
        )
        # The piston's way within each step, and what it may go beyond its places and back.
        moves = np.diff(cylinder.position(angles), axis=1)
        way = np.abs(moves).sum(axis=1)
        turns = (moves.min(axis=1) < 0.0) & (moves.max(axis=1) > 0.0)
        way += 2.0 * turns * np.abs(moves).max(axis=1)
        return np.full(len(chosen), scale * (np.ptp(controls, axis=0) @ way))

    @property
    def table(self) -> Table:
        """Pressure over crank angle."""
        peak = int(self.pressure.argmax())
        at = float(checks.about_tdc(self.theta_deg[peak : peak + 1], self.period_deg)[0])
        facts = (
            labels.one_line(self.name) or "Cycle",
            f"{'four' if self.strokes == 4 else 'two'}-stroke",
            f"{len(self.theta_deg)} points ({self.grid})",
            units.Text(units.figure(self.pressure[peak] / 1e5, "bar", 4), f" at {at:.4g}°"),
        )
        return Table(
            units.joined(", ", facts),
            (
                Column("crank angle", self.theta_deg, "°", digits=10),
                Column("pressure", self.pressure, "Pa", digits=7),
            ),
            note=self.origin,
        )
