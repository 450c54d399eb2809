"""Measured cylinder pressure of many cycles: their mean and their spread."""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import TYPE_CHECKING, TypeAlias, overload

import numpy as np

from crankpin import _core
from crankpin._core import ATMOSPHERE
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.messages import is_suppressed, suppressed, warn
from crankpin._support.parameters import documented
from crankpin._support.record import AbsentError, Input, changed, item_key, read_only
from crankpin._support.tables import Column, Table
from crankpin.model import checks, cycle_files, odd_cycles
from crankpin.model.computed_cycles import area
from crankpin.model.cycle import Cycle

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path
    from typing import Self, SupportsIndex, Unpack

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.cycle_files import CylinderFileOptions, FileOptions
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.odd_cycles import Oddities
    from crankpin.model.table_files import Column as FileColumn

OverCycles: TypeAlias = "tuple[str, str, NDArray[np.float64] | NDArray[np.complex128]]"
"""Name and unit of a figure, and its numbers or phasors by cycle."""
SHOWN_ORDERS: tuple[Order, ...] = (0.5, 1, 6, 12)
"""Orders whose torque is reported of measured traces: two low ones, and two that phases shift."""
HEAT_STEP = 0.5
"""Step of crank angle, degrees, over which the work of heat release is summed: trapezes leave 1e-5
of it."""
OF_WHITE_NOISE = 70.0
"""Variance of fourth differences of white noise, over its own: 1 + 16 + 36 + 16 + 1."""
OFFSET = (
    "no absolute pressure is below zero. If the sensor's offset is in it, crankpin.prepare_trace "
    "removes it"
)


class Traces(Tabled, Input):
    """Absolute pressure in a cylinder over many cycles, as measured.

    A piezoelectric sensor's offset may still be in it: :func:`crankpin.prepare_trace` removes it.

    Parameters
    ----------
    theta_deg : array_like, shape (n,)
        Crank angles of all cycles, as of :class:`Cycle`, degrees.
    pressure : array_like, shape (n_cycles, n)
        Absolute pressure there, Pa, a row for each cycle.
    strokes : {4, 2}, default 4
        4 for a period of 720°, 2 for one of 360°.
    name : str, optional
        Name; may be empty.
    origin : str, optional
        How they were measured or read, in words: a line under the table.

    Raises
    ------
    InputError
        If angles are not ascending or do not cover one period, or a pressure is below that of a
        vacuum by more than an atmosphere.

    Warns
    -----
    UserWarning
        If pressure seems to be in another unit or gauge pressure, once for all cycles; if there are
        spikes or odd cycles among them.

    Examples
    --------
    >>> import crankpin as cp
    >>> import numpy as np
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> theta = np.arange(-360.0, 360.0)
    >>> spread = np.random.default_rng(0).normal(1.0, 0.03, (60, 1))
    >>> traces = cp.Traces(theta, cp.Cycle.example().pressure_at(theta) * spread)
    >>> len(traces), round(traces.cov(cylinder), 3)
    (60, 0.027)
    >>> abs(traces.torque_harmonics(cylinder, [0.5, 1]).mean(axis=0)).round(1)
    array([99.5, 99. ])
    """

    theta_deg: NDArray[np.float64]
    """Crank angles after the firing top dead centre, degrees: (n,)."""
    pressure: NDArray[np.float64]
    """Absolute pressure there, Pa: (n_cycles, n)."""
    strokes: int
    """4 or 2."""
    name: str
    """Name; may be empty."""
    origin: str = dataclasses.field(default="", compare=False)
    """Description of the measurement or file; may be empty."""

    def __init__(
        self,
        theta_deg: ArrayLike,
        pressure: ArrayLike,
        strokes: int = 4,
        name: str = "",
        origin: str = "",
    ) -> None:
        theta = inputs.vector("theta_deg", theta_deg).copy()
        rows = inputs.array("pressure", pressure)
        if rows.ndim != 2 or not len(rows) or rows.shape[1] != len(theta):
            hint = f"give a row of {len(theta)} pressures for each cycle, one at every angle"
            raise inputs.faulty("pressure", f"has shape {rows.shape}", hint)
        if not np.isfinite(rows).all():
            cycle, k = np.argwhere(~np.isfinite(rows))[0].tolist()
            fault = f"has numbers that are not finite, first {rows[cycle, k]} in cycle {cycle} at "
            hint = "give finite ones, or leave the cycle out"
            raise inputs.faulty("pressure", f"{fault}{theta[k]:.6g}°", hint)
        values = {
            "theta_deg": read_only(theta),
            "pressure": read_only(rows.copy()),
            "strokes": inputs.strokes(strokes),
            "name": inputs.text("name", name),
            "origin": inputs.text("origin", origin),
        }
        for field, value in values.items():
            object.__setattr__(self, field, value)
        least = float(rows.min())
        raised = -least if least < -ATMOSPHERE else 0.0
        if not is_suppressed(odd_cycles.ABOUT):
            odd_cycles.report(self._oddities)
            rows = self._oddities.repaired(rows)
            least = float(rows.min())
        if least < -ATMOSPHERE:
            warn("pressure", f"is {least:g} Pa at its least", OFFSET)
        else:
            checks.pressure(rows)
        with suppressed("pressure"):
            mean = Cycle(theta, self.pressure.mean(axis=0) + raised, strokes, name, None, origin)
        self.__dict__.update(_raised=raised, _mean=mean)

    @classmethod
    @documented(cycle_files.load)
    def load(cls, path: str | Path, **options: Unpack[FileOptions]) -> Self:
        """Return the cycles in a file with columns of crank angle, or time, and pressure.

        Cycles stand beside each other in columns, below each other in blocks whose angles begin
        again, or follow each other in angles or times that go on; incomplete ones are left out.
        Columns are separated by commas, semicolons, tabs or blanks; decimal commas are recognised
        unless columns are separated by commas too. Lines before the numbers, and lines that begin
        with ``#``, ``%`` or ``!``, are comments; the last before the numbers is the header, with
        the one above it if that has as many cells. Text is UTF-8, UTF-16 or Latin-1; long files
        are read piece by piece. Rows of spreadsheets are read in the same way. A cell that is not a
        number is an error that names line and column; missing lines, repeated lines and repeated
        angles raise a warning. ``origin`` reports what was read, and whether the header or an
        argument states it or it is assumed.

        Returns
        -------
        Traces
            The cycles, their angles counted from the firing top dead centre.
        """
        return cls(*cycle_files.load(path, **options)[:5])

    @classmethod
    @documented(cycle_files.load_cylinders)
    def load_cylinders(
        cls,
        path: str | Path,
        *,
        columns: Sequence[FileColumn | Sequence[FileColumn]],
        tdc_deg: ArrayLike,
        **options: Unpack[CylinderFileOptions],
    ) -> tuple[Self, ...]:
        """Return the cycles of several cylinders from one file.

        Parameters
        ----------
        columns : sequence of int, str or sequence of these
            Column of the angle or time, and that of each cylinder's pressure, or a list of those of
            its cycles; numbers from 0 or names.
        tdc_deg : array_like
            Angle of each cylinder's firing top dead centre as the file counts angles, degrees.

        Returns
        -------
        tuple of Traces
            The cycles of each cylinder, angles counted from its own firing top dead centre.

        Raises
        ------
        InputError
            …, or if there is not one angle for each cylinder.
        OSError
            If the file cannot be read.

        """
        read = cycle_files.load_cylinders(path, columns, tdc_deg, **options)
        return tuple(cls(*fields[:5]) for fields in read)

    def __len__(self) -> int:
        return len(self.pressure)

    @overload
    def __getitem__(self, place: SupportsIndex) -> Cycle: ...

    @overload
    def __getitem__(self, place: slice) -> Self: ...

    def __getitem__(self, place: SupportsIndex | slice) -> Cycle | Self:
        """Return one of the cycles, by its index from 0, or those of a slice."""
        index = item_key(place, len(self))
        if isinstance(index, slice):
            return self._some(np.arange(len(self))[index], "index", place)
        self._check_offset()
        return self._cycle(self.pressure[index])

    def without_cycles(self, cycles: int | Iterable[int]) -> Self:
        """Return the other cycles.

        Parameters
        ----------
        cycles : int or iterable of int
            Indices of the cycles to leave out, from 0; -1 is the last.

        Returns
        -------
        Traces
            The cycles that stay.

        Raises
        ------
        InputError
            If there is no such cycle, or none would stay.

        Examples
        --------
        >>> import crankpin as cp
        >>> import numpy as np
        >>> theta = np.arange(-360.0, 360.0)
        >>> traces = cp.Traces(theta, np.tile(cp.Cycle.example().pressure_at(theta), (5, 1)))
        >>> len(traces.without_cycles([0, 3])), len(traces[:2])
        (3, 2)
        """
        several = not isinstance(cycles, (int, np.integer)) or isinstance(cycles, bool)
        entries = inputs.items("cycles", cycles, "give indices of cycles") if several else [cycles]
        out = [item_key(key, len(self), "cycles") for key in entries]
        return self._some(np.delete(np.arange(len(self)), out), "cycles", cycles)

    def _some(self, places: NDArray[np.intp], argument: str, value: object) -> Self:
        """Return some of the cycles."""
        if not len(places):
            raise inputs.rejected(argument, value, "one cycle must stay")
        with suppressed():  # Warned of where all were given.
            return self.replace(pressure=self.pressure[places])

    @functools.cached_property
    def _oddities(self) -> Oddities:
        return odd_cycles.find(self.theta_deg, self.pressure, 180.0 * self.strokes)

    @property
    def anomalies(self) -> Table:
        """Spikes and odd cycles by index, detected by comparison with the median of the cycles.

        Kinds: ``spike``, of few samples; ``oscillation``, many of them, as knock makes;
        ``misfire``, whose expansion lacks pressure; ``shifted``, whose compression is earlier or
        later than the others'; ``unlike``, without compression, or far from the median. Of fewer
        cycles large spikes alone are found.
        """
        rows = [
            (
                oddity.cycle,
                oddity.kind,
                None if math.isnan(oddity.at_deg) else oddity.at_deg,
                oddity.size,
            )
            for oddity in self._oddities.listed
        ]
        heads: list[str | tuple[str, str]] = ["cycle", "kind", ("crank angle", "°"), "size"]
        row_units = tuple(oddity.unit for oddity in self._oddities.listed)
        table = Table.from_rows(f"{self._title}: spikes and odd cycles", heads, rows)
        unit = Column("unit", row_units or ())
        return changed(table, columns=(*table.columns, unit), row_units=row_units)

    def __iter__(self) -> Iterator[Cycle]:
        """Return an iterator over the cycles."""
        return (self[k] for k in range(len(self)))

    @property
    def _raised(self) -> float:
        """What is added to pressure that an unknown offset makes no absolute one, and 0 else, Pa.

        Torque is that of the difference to the crankcase, which is raised too.
        """
        return self.__dict__["_raised"]  # type: ignore[no-any-return]

    def _cycle(self, row: NDArray[np.float64]) -> Cycle:
        with suppressed():  # Warned of where all were given.
            return Cycle(self.theta_deg, row, self.strokes, self.name, None, self.origin)

    def _raised_cycles(self) -> Iterator[Cycle]:
        return (self._cycle(row + self._raised) for row in self.pressure)

    def _check_offset(self) -> None:
        if self._raised:
            fault = f"is {-self._raised:g} Pa at its least"
            raise inputs.faulty("pressure", fault, OFFSET, AbsentError)

    @property
    def mean_cycle(self) -> Cycle:
        """Mean of the cycles at every crank angle."""
        self._check_offset()
        return self._raised_mean

    @property
    def _raised_mean(self) -> Cycle:
        return self.__dict__["_mean"]  # type: ignore[no-any-return]

    @property
    def period_deg(self) -> float:
        """720° or 360°."""
        return self._raised_mean.period_deg

    @functools.cached_property
    def noise(self) -> float:
        """Standard deviation of what is not smooth over the crank angle, Pa.

        From fourth differences, which pressure at steps of up to 1° does not have: that of white
        noise, of coarse digits and of vibration near half the sampling rate. Their median counts,
        so that a few steep angles do not.
        """
        # By cycle, so that Ctrl-C is answered between them.
        differences = np.array([np.abs(np.diff(trace, 4)) for trace in self.pressure])
        if not differences.size:
            return 0.0
        return float(odd_cycles.OF_A_NORMAL * np.median(differences) / math.sqrt(OF_WHITE_NOISE))

    @functools.cached_property
    def peaks(self) -> NDArray[np.float64]:
        """Largest pressure of each cycle, Pa: (n_cycles,)."""
        return read_only(self.pressure.max(axis=1))

    @functools.cached_property
    def peaks_deg(self) -> NDArray[np.float64]:
        """Crank angle of the largest pressure of each cycle, degrees: (n_cycles,).

        In the cycle about the firing top dead centre, or about the peak of the mean cycle.
        """
        at = self.theta_deg[self.pressure.argmax(axis=1)]
        mean = self._raised_mean
        top = float(checks.about_tdc(mean.theta_deg[[mean.pressure.argmax()]], self.period_deg)[0])
        return read_only(checks.about_tdc(at - top, self.period_deg) + top)

    @documented(Cycle.imep)
    def imep(self, cylinder: Cylinder) -> NDArray[np.float64]:
        """Return the indicated mean effective pressure of each cycle, Pa: (n_cycles,).

        Returns
        -------
        ndarray of float, shape (n_cycles,)
            Indicated mean effective pressures, Pa.

        """
        with suppressed():  # a single cycle may be far from the others
            return np.array([cycle.imep(cylinder) for cycle in self._raised_cycles()])

    @documented(imep)
    def cov(self, cylinder: Cylinder) -> float:
        """Return the coefficient of variation of imep: its standard deviation over its mean.

        Returns
        -------
        float
            Coefficient of variation; NaN for one cycle.

        """
        imep = self.imep(cylinder)
        return _deviation(imep) / abs(float(imep.mean()))

    @documented(Cycle.torque_harmonics)
    def torque_harmonics(
        self, cylinder: Cylinder, orders: Order | Iterable[Order], *, crankcase: float = ATMOSPHERE
    ) -> NDArray[np.complex128]:
        """Return the peak phasors of the torque of each cycle on the crank, N·m.

        Returns
        -------
        ndarray of complex, shape (n_cycles, n_orders)
            Peak phasors, N·m. Their mean is that of the mean cycle.

        """
        chosen = inputs.explicit_half_orders(orders)
        below = inputs.number("crankcase", crankcase)
        checks.absolute("crankcase", below)
        with suppressed("crankcase"):
            phasors = [
                cycle.torque_harmonics(cylinder, chosen, crankcase=below + self._raised)
                for cycle in self._raised_cycles()
            ]
        return np.array(phasors)

    def heat_release(
        self,
        cylinder: Cylinder,
        theta_deg: ArrayLike,
        *,
        compression_ratio: float,
        gamma: float = 1.33,
    ) -> NDArray[np.float64]:
        """Return the apparent net heat release of each cycle, J: (n_cycles, n_theta).

        That of the first law of a single zone with a constant ratio of heat capacities,
        ``dQ = γ/(γ-1)·p·dV + 1/(γ-1)·V·dp`` (Heywood, Internal Combustion Engine Fundamentals,
        1988, section 9.2.2): combustion less the heat that walls and crevices take. It is
        integrated as ``p·dV + d(p·V)/(γ-1)``, which differentiates no pressure. An error of the
        reference is in it: :func:`crankpin.prepare_trace` removes it.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.
        theta_deg : array_like, shape (n_theta,)
            Crank angles after the firing top dead centre, ascending while valves are closed,
            degrees. Heat is counted from the first.
        compression_ratio : float
            Largest over smallest volume.
        gamma : float, default 1.33
            Ratio of heat capacities of the gas.

        Returns
        -------
        ndarray of float, shape (n_cycles, n_theta)
            Heat from the first angle to each, J.

        Raises
        ------
        InputError
            If the cylinder has no bore, angles do not ascend within a cycle, or an argument is out
            of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> import numpy as np
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> cycle = cp.Cycle.wiebe(cylinder, compression_ratio=10, heat=1000, gamma=1.33)
        >>> theta = np.arange(-360.0, 360.0, 0.5)
        >>> traces = cp.Traces(theta, cycle.pressure_at(theta)[None])
        >>> traces.heat_release(cylinder, [-60, 0, 60], compression_ratio=10).round(-1)
        array([[   0.,  170., 1000.]])
        """
        area(cylinder)
        theta = inputs.finite_array("theta_deg", theta_deg)
        if theta.ndim != 1 or not len(theta) or (np.diff(theta) <= 0.0).any():
            hint = "give ascending crank angles while valves are closed"
            raise inputs.rejected("theta_deg", theta_deg, hint)
        if theta[-1] - theta[0] > self.period_deg:
            fault = f"has angles over {theta[-1] - theta[0]:g}°"
            raise inputs.faulty("theta_deg", fault, "give angles within one cycle")
        ratio = inputs.finite("compression_ratio", compression_ratio)
        # On all points between as well, over which work is summed.
        fine = np.unique(np.concatenate([theta, np.arange(theta[0], theta[-1], HEAT_STEP)]))
        rows = np.array([cycle.pressure_at(fine) for cycle in self._raised_cycles()])
        figures = (cylinder._parts, cylinder.bore, ratio, self.strokes)
        kappa = inputs.finite("gamma", gamma)
        heats = _core.heat_release(figures, fine, rows - self._raised, kappa)
        return np.ascontiguousarray(heats[:, np.searchsorted(fine, theta)])

    @documented(heat_release)
    def heat_spread(
        self,
        cylinder: Cylinder,
        *,
        compression_ratio: float,
        gamma: float = 1.33,
        window_deg: tuple[float, float] = (-60.0, 100.0),
    ) -> Table:
        """Return mean and spread over cycles of the heat released, and of when it is.

        Parameters
        ----------
        window_deg : pair of float, default (-60.0, 100.0)
            Crank angles between which valves are closed and all burns, degrees.

        Returns
        -------
        Table
            Largest heat from the beginning of the window, J, and crank angles at which 10, 50 and
            90 % of it are released; mean, deviation, least and largest.

        Raises
        ------
        InputError
            …, or if a cycle releases no heat.
        """
        pair = inputs.vector("window_deg", window_deg)
        if len(pair) != 2 or not 0.0 < pair[1] - pair[0] <= self.period_deg:
            hint = "give two angles, ascending, in one period"
            raise inputs.rejected("window_deg", window_deg, hint)
        theta = np.linspace(pair[0], pair[1], 1 + math.ceil((pair[1] - pair[0]) / HEAT_STEP))
        heats = self.heat_release(cylinder, theta, compression_ratio=compression_ratio, gamma=gamma)
        largest = heats.max(axis=1)
        if (none := largest <= 0.0).any():
            fault = f"release no heat in cycle {int(none.argmax())}"
            hint = "leave motored cycles out; are dead centre, reference and window right?"
            raise inputs.faulty("traces", fault, hint)
        figures: list[OverCycles] = [("heat released", "J", largest)]
        for share in (0.1, 0.5, 0.9):
            at = [
                _reaches(theta, row, share * most) for row, most in zip(heats, largest, strict=True)
            ]
            figures.append((f"angle of {100 * share:g} %", "°", np.array(at)))
        return spread_table(f"{self._title}, heat release", figures)

    @documented(torque_harmonics)
    def spread(self, cylinder: Cylinder, orders: Order | Iterable[Order] = SHOWN_ORDERS) -> Table:
        """Return mean and spread over cycles of peak, imep and the torque's harmonics.

        Parameters
        ----------
        cylinder : Cylinder
            Cylinder with a bore.

        Returns
        -------
        Table
            Mean, standard deviation, that over the mean (COV), least and largest. Of a harmonic
            mean is the magnitude of the mean phasor and deviation that of phasors in the plane,
            phases included; over the root of the number of cycles it is the mean's standard error.

        """
        chosen = inputs.explicit_half_orders(orders)
        phasors = self.torque_harmonics(cylinder, chosen)
        figures: list[OverCycles] = [
            ("peak pressure", "bar", self.peaks / 1e5),
            ("angle of peak", "°", self.peaks_deg),
            ("imep", "bar", self.imep(cylinder) / 1e5),
        ]
        of_orders = [
            (f"torque order {order:g}", "N·m", phasor)
            for order, phasor in zip(chosen, phasors.T, strict=True)
        ]
        return spread_table(f"{self._title}, spread", [*figures, *of_orders])

    @documented(torque_harmonics)
    def resolution_error(
        self, cylinder: Cylinder, orders: Order | Iterable[Order], *, crankcase: float = ATMOSPHERE
    ) -> NDArray[np.float64]:
        """Return an estimate of the error of the mean cycle's harmonics, N·m: (n_orders,).

        That of interpolation (:meth:`Cycle.resolution_error` of the mean cycle) and the standard
        error over cycles, root of the sum of squares. The second contains noise, coarse digits and
        the spread of combustion. It is an estimate, no bound: a wrong top dead centre, reference or
        gain of the sensor is the same in all cycles.

        Returns
        -------
        ndarray of float, shape (n_orders,)
            Estimated errors, N·m; of one cycle NaN, which says nothing of its noise.

        Raises
        ------
        InputError
            If half of the points are fewer than a table has.
        """
        chosen = inputs.explicit_half_orders(orders)
        between = self._raised_mean.resolution_error(cylinder, chosen, crankcase=crankcase)
        phasors = self.torque_harmonics(cylinder, chosen, crankcase=crankcase)
        over_cycles = [_deviation(phasor) / math.sqrt(len(self)) for phasor in phasors.T]
        return np.hypot(between, over_cycles)

    @property
    def _title(self) -> str:
        count = f"{len(self)} cycle{'s' if len(self) > 1 else ''}"
        return f"{labels.one_line(self.name) or 'Traces'}, {count}"

    @property
    def table(self) -> Table:
        """Mean, deviation, least and largest pressure over crank angle."""
        rows = self.pressure
        deviation = rows.std(axis=0, ddof=1) if len(self) > 1 else np.full(rows.shape[1], np.nan)
        curves = {
            "mean": rows.mean(axis=0),
            "deviation": deviation,
            "least": rows.min(axis=0),
            "largest": rows.max(axis=0),
        }
        strokes = "four" if self.strokes == 4 else "two"
        return Table(
            units.Text(
                f"{self._title}, {strokes}-stroke, "
                f"{len(self.theta_deg)} points ({self._raised_mean.grid}), noise ",
                units.figure(self.noise / 1e5, "bar", 2),
            ),
            (
                Column("crank angle", self.theta_deg, "°", digits=10),
                *(Column(k, values, "Pa", digits=7) for k, values in curves.items()),
            ),
            note=self.origin,
        )


def _reaches(theta: NDArray[np.float64], heat: NDArray[np.float64], level: float) -> float:
    """Return the angle at which heat last passes a level on its way to its largest value."""
    top = int(heat.argmax())
    below = np.flatnonzero(heat[: top + 1] <= level)
    k = min(int(below[-1]) if len(below) else 0, len(theta) - 2)
    return float(np.interp(level, heat[k : k + 2], theta[k : k + 2]))


def spread_table(title: str, figures: Sequence[OverCycles]) -> Table:
    """Return mean and spread over cycles of figures: name, unit, and numbers or phasors by cycle.

    Of phasors mean is the magnitude of their mean, deviation that in the plane.
    """
    rows = []
    for name, unit, values in figures:
        plane = np.iscomplexobj(values)
        sizes, mean = (np.abs(v) if plane else v.real for v in (values, values.mean()))
        row = (name, float(mean), _deviation(values), float(sizes.min()), float(sizes.max()), unit)
        rows.append(row)
    names, means, deviations, least, largest, row_units = zip(*rows, strict=True)
    of_mean = [
        100.0 * deviation / abs(mean) if mean and unit != "°" else None
        for mean, deviation, unit in zip(means, deviations, row_units, strict=True)
    ]
    return Table(
        title,
        (
            Column("figure", names),
            Column("mean", means),
            Column("deviation", deviations),
            Column("COV", tuple(of_mean), "%", digits=3),
            Column("least", least),
            Column("largest", largest),
            Column("unit", row_units),
        ),
        row_units=row_units,
    )


def _deviation(values: NDArray[np.float64] | NDArray[np.complex128]) -> float:
    """Return the standard deviation of numbers or phasors; NaN of one."""
    if len(values) < 2:
        return math.nan
    if (values == values[0]).all():  # whose mean may be beside them by its rounding
        return 0.0
    return float(np.std(values, ddof=1))
