"""Oscillograms: crank angle, speed and cylinder pressure of channels recorded over time."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import Hint, warn
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.model import cycle_files, table_files
from crankpin.model.traces import Traces, spread_table

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.table_files import Column as FileColumn
    from crankpin.model.traces import OverCycles

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9}
"""Unit → seconds."""
VOLTS = {"V": 1.0, "mV": 1e-3}
"""Unit of a channel → volts."""
STEPS = (0.1, 0.2, 0.25, 0.5, 1.0, 2.0)
"""Steps of crank angle, degrees, of cycles: the first that is no finer than the samples."""
SPEED_STEP = 1.0
"""Step of the curve of speed, degrees."""
POSSIBLE_SPEEDS = (0.1, 1e6)
"""Speeds, rpm, beyond which times are in other units."""
SHOWN_ORDERS: tuple[Order, ...] = (0.5, 1, 2, 3, 4, 6)
"""Orders of speed that are reported, as far as the pulses resolve them."""
LONGEST_NUMBER = 10
"""Digits of what is no number of a column but a name."""
PLACE_HINT = "give the number of a column from 0, or its name"
GAIN_HINT = "give gain and offset, such as CH1:20bar/V,-1bar"
MARK_HINT = "give rising or falling, or a threshold such as 2.5V"

_TIME_UNIT = re.compile(r"(?<![a-zµμ])(ms|us|µs|μs|ns|s)(?![a-z])|(second)", re.IGNORECASE)
_VOLT_UNIT = re.compile(r"(?<![a-z])(m?V)(olts?)?(?![a-z])", re.IGNORECASE)
_GAIN = re.compile(r"(.+)/\s*(m?V)")
_LEVEL = re.compile(r"([^a-zA-Z]+?)\s*(m?V)?")


def oscillogram(
    source: str | Path | Mapping[str, ArrayLike],
    *,
    pressure: FileColumn | Sequence[FileColumn],
    encoder: FileColumn,
    pulses: str | int,
    index: FileColumn | None = None,
    tdc_deg: ArrayLike = 0.0,
    time: FileColumn | None = None,
    sampling_rate: float | None = None,
    sheet: str | None = None,
    pressure_unit: str | None = None,
    gauge: bool | None = None,
    atmosphere: float = _core.ATMOSPHERE,
    strokes: int = 4,
    name: str | None = None,
) -> Oscillogram:
    """Return the cycles and the speed of an engine from channels recorded over time.

    The pulses of an encoder on the crankshaft are the clock: a cubic through the times of four of
    them is the crank angle of the samples between. Which of two dead centres is the firing one
    follows from an index that marks once a cycle, or from the peaks of pressure.

    Parameters
    ----------
    source : str or pathlib.Path, or mapping of str to array_like
        File of columns, as of :meth:`Traces.load`; or samples by name of the channel, all as long.
    pressure : str or int, or sequence of these
        Channel of each cylinder's pressure. Behind a colon gain and offset, by which volts
        become absolute pressure: ``"CH1:20bar/V,-1bar"``. Without them the head of the column has
        its unit.
    encoder : str or int
        Channel of the pulses, name or number from 0. Behind a colon ``falling`` for the edges that
        fall, and the threshold if it is not midway between the extremes: ``"CH2:falling,2.5V"``.
    pulses : str or int
        Pulses of a turn, at equal angles: 360, or ``"60-2"`` for a wheel of 60 less 2 teeth.
    index : str or int, optional
        Channel of marks, once a turn or once a cycle, as of ``encoder``; by default the first tooth
        behind the gap of a wheel that has one.
    tdc_deg : array_like, default 0.0
        Crank angle from the index to the firing top dead centre of each cylinder, degrees.
    time : str or int, optional
        Column of times, ``"0:ms"`` with a unit that its head lacks; by default the first.
    sampling_rate : float, optional
        Samples of a second, Hz, in place of times.
    sheet : str, optional
        Sheet of a spreadsheet; by default the first.
    pressure_unit : str, optional
        Unit of pressure: Pa, hPa, kPa, MPa, mbar, bar or psi; by default what the header names.
    gauge : bool, optional
        True for pressure above that of the atmosphere; by default what the header says, and with a
        gain False.
    atmosphere : float, default 101325.0
        Pressure added to gauge pressure, Pa.
    strokes : {4, 2}, default 4
        Strokes of a cycle, 4 or 2.
    name : str, optional
        Name; by default that of the file.

    Returns
    -------
    Oscillogram
        Cycles of each cylinder as ``traces``, and the speed within the cycle.

    Raises
    ------
    InputError
        If a channel is missing, constant or not finite; if times do not ascend; if pulses, gaps and
        marks contradict each other, or many pulses are missing; if pressure falls where it should
        rise, or either dead centre may be the firing one; if there is no whole cycle.
    OSError
        If the file cannot be read.
    ImportError
        If openpyxl, SciPy or h5py, which spreadsheets, MATLAB or HDF5 need, is not installed.

    Warns
    -----
    UserWarning
        If a few pulses are missing or extra, which are named; if the speed is none of an engine; if
        there are spikes or odd cycles.

    Examples
    --------
    >>> import crankpin as cp
    >>> import numpy as np
    >>> seconds = np.arange(0.0, 0.6, 2e-5)
    >>> theta = 12000.0 * seconds - 400.0  # 2000 rpm
    >>> samples = {
    ...     "p": cp.Cycle.example().pressure_at(theta) / 20e5 + 0.05,
    ...     "wheel": (theta % 6 < 3) & (theta % 360 < 348),
    ...     "mark": (theta - 30) % 360 < 2,
    ... }
    >>> scope = cp.oscillogram(
    ...     samples,
    ...     pressure="p:20bar/V,-1bar",
    ...     encoder="wheel",
    ...     pulses="60-2",
    ...     index="mark",
    ...     tdc_deg=-30,
    ...     sampling_rate=50e3,
    ... )
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> imep = scope.traces[0].imep(cylinder).mean()
    >>> len(scope.traces[0]), bool(abs(imep / cp.Cycle.example().imep(cylinder) - 1) < 2e-3)
    (9, True)
    >>> round(scope.table["mean"].values[0], 1)
    2000.0
    """
    period = 180.0 * inputs.strokes(strokes)
    of_pressure = _listed(pressure)
    count = len(of_pressure)
    centres = inputs.per_item("tdc_deg", tdc_deg, count)
    if len(centres) != count:
        fault = f"has {len(centres)} angles for {count} cylinders"
        raise inputs.faulty("tdc_deg", fault, "give one for each channel of pressure")
    within = [inputs.finite("tdc_deg", centre) % period for centre in centres]
    typed = pulses if isinstance(pulses, str) else str(inputs.whole("pulses", pulses))
    wheel = inputs.text("pulses", typed)
    roles = [_Role.read("pressure", one) for one in of_pressure]
    roles += [_Role.read("encoder", encoder)]
    roles += [] if index is None else [_Role.read("index", index)]
    timed = _clock_role(source, time, sampling_rate)
    title, channels = _channels(source, roles + timed, sheet)
    title = title if name is None else inputs.text("name", name)
    if timed:
        seconds = channels.pop().seconds()
    else:
        rate = inputs.positive("sampling_rate", sampling_rate, "give samples of a second, Hz")
        seconds = np.arange(len(channels[0].values)) / rate
    teeth, *marks = (channel.marks() for channel in channels[count:])
    at, angles, turns, faults = _core.crank_clock(
        seconds, teeth, wheel, marks[0] if marks else None
    )
    _warn_of_faults(faults)
    inside = (seconds >= at[0]) & (seconds <= at[-1])
    theta = _core.cubics(at, angles, seconds[inside])
    if (np.diff(theta) <= 0.0).any():  # of teeth that are far from their places
        theta = np.interp(seconds[inside], at, angles)
    read = [channel.pressure(pressure_unit, gauge, atmosphere) for channel in channels[:count]]
    step, theta, rows = _averaged(theta, np.array([values[inside] for values, _ in read]))
    _check_direction(rows)
    mark = "the gap" if index is None else "the index"
    from_pressure = period > 360.0 and turns == 1
    later = 360.0 * _core.fires_a_turn_later(theta, rows, within) if from_pressure else 0.0
    how = "pressure" if from_pressure else mark
    traces, starts = list[Traces](), list[float]()
    for k, (channel, row, (_, unit)) in enumerate(zip(channels, rows, read, strict=False)):
        grid, cycles, start = _cycles(theta - within[k] - later, row, period, step)
        if not traces:
            starts = (start + within[k] + later + period * np.arange(len(cycles))).tolist()
        own = f"{title}, {channel.head}".removeprefix(", ") if count > 1 else title
        origin = f"{len(cycles)} cycle{'s' * (len(cycles) > 1)} over time, {unit}, angles of "
        origin += f"{wheel} pulses, top dead centre {centres[k]:g}° behind {mark}, firing by {how}"
        traces.append(Traces(grid, cycles, strokes, own, origin))
    points = round(period / SPEED_STEP)
    speed, harmonics = _core.speed_within_cycles(at, angles, wheel, starts, period, points)
    _check_speed(float(speed.mean()), timed)
    along = read_only(_steps(-period / 2.0, SPEED_STEP, points))
    named = tuple((second, float(np.interp(second, at, angles)), n) for second, n in faults)
    return Oscillogram(tuple(traces), along, speed, harmonics * 360.0 / period, named, title)


def _listed(pressure: object) -> list[object]:
    """Return the channels of pressure, one or several."""
    hint = "give the channel of each cylinder's pressure"
    several = isinstance(pressure, (list, tuple))
    if several and not pressure:
        raise inputs.rejected("pressure", pressure, hint)
    return inputs.items("pressure", pressure, hint) if several else [pressure]


def _clock_role(source: object, time: object, sampling_rate: float | None) -> list[_Role]:
    """Return the role of times, if no sampling rate is in their place."""
    if sampling_rate is not None:
        if time is not None:
            hint = Hint.of("`sampling_rate` gives it; leave one of them out")
            raise inputs.rejected("time", time, hint)
        return []
    if time is None and isinstance(source, Mapping):
        raise inputs.rejected("time", None, Hint.of("give it, or `sampling_rate=…`"))
    return [_Role.read("time", 0 if time is None else time)]


def _averaged(
    theta: NDArray[np.float64], rows: NDArray[np.float64]
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Return the step of cycles, and samples averaged as far as they are finer than half of it."""
    sample = float(np.median(np.diff(theta)))
    step = next((step for step in STEPS if step >= 0.999 * sample), None)
    if step is None:
        fault = f"has {sample:.3g}° from one sample to the next"
        raise inputs.faulty("source", fault, f"{STEPS[-1]:g}° at most are needed; sample faster")
    block = int(step / sample / 2.0)
    if block < 2:
        return step, theta, rows
    whole = len(theta) // block * block
    blocks = rows[:, :whole].reshape(len(rows), -1, block).mean(axis=2)
    return step, theta[:whole].reshape(-1, block).mean(axis=1), blocks


def _check_direction(rows: NDArray[np.float64]) -> None:
    """Reject pressure that falls where that of a cylinder rises."""
    for number, row in enumerate(rows, 1):
        low, usual, high = np.quantile(row, [0.002, 0.5, 0.998])
        if usual - low > high - usual:
            fault = f"of cylinder {number} falls by {(usual - low) / 1e5:.3g} bar"
            fault += f" and rises by {(high - usual) / 1e5:.3g} bar from its median"
            hint = "is it upside down? Give the gain the other sign"
            raise inputs.faulty("pressure", fault, hint)


def _cycles(
    theta: NDArray[np.float64], row: NDArray[np.float64], period: float, step: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return the grid of a cycle, whole cycles on it, and the angle at which the first begins."""
    half = period / 2.0
    start = float(np.ceil((theta[0] + half) / period) * period - half)
    count = int((theta[-1] - start + step) / period)
    if count < 1:
        fault = f"has {theta[-1] - theta[0]:.4g}° of crank angle"
        hint = f"no whole cycle of {period:g}° about a firing top dead centre: record for longer"
        raise inputs.faulty("source", fault, hint)
    points = round(period / step)
    at = _steps(start, step, count * points)
    return (_steps(-half, step, points), _core.cubics(theta, row, at).reshape(count, points), start)


def _warn_of_faults(faults: Sequence[tuple[float, int]]) -> None:
    """Warn of pulses that are missing or extra, once for all."""
    if not faults:
        return
    missing = sum(max(count, 0) for _, count in faults)
    extra = sum(count < 0 for _, count in faults)
    said = [
        f"{n} pulse{'s' * (n > 1)} {kind}"
        for n, kind in ((missing, "missing"), (extra, "extra"))
        if n
    ]
    hint = "crank angle is interpolated there; Oscillogram.pulses names them"
    warn("encoder", f"has {' and '.join(said)}, first at {faults[0][0]:.6g} s", hint)


def _steps(first: float, step: float, count: int) -> NDArray[np.float64]:
    """Return crank angles at equal steps, degrees."""
    return np.asarray(first + step * np.arange(count), dtype=np.float64)


def _check_speed(rpm: float, timed: Sequence[_Role]) -> None:
    """Reject a speed that no engine has, and warn of one that hardly any has."""
    least, most = POSSIBLE_SPEEDS
    if not least < rpm < most:
        role, value = ("time", timed[0].column) if timed else ("sampling_rate", None)
        hint = f"the crank turns at {rpm:.4g} rpm by it; is its unit right?"
        raise inputs.rejected(role, value, hint)
    low, high = cycle_files.RECORDED_SPEEDS
    if not low < rpm < high:
        hint = Hint.of("are `pulses` and the unit of time right?")
        warn("the speed of the record", f"is {rpm:.4g} rpm", hint)


# --- channels -------------------------------------------------------------------------------------


class _Role(NamedTuple):
    """Channel of a role, and how its values are read."""

    role: str
    column: FileColumn
    words: tuple[str, ...]

    @classmethod
    def read(cls, role: str, given: object) -> _Role:
        """Read ``CH1:20bar/V,-1bar``: name or number of a column, and words behind a colon."""
        if not isinstance(given, str):
            return cls(role, inputs.whole(role, given, 0), ())
        column, colon, words = given.rpartition(":")
        column = (column if colon else given).strip()
        if not column:
            raise inputs.rejected(role, given, PLACE_HINT)
        listed = tuple(word.strip() for word in words.split(",")) if colon else ()
        return cls(
            role,
            int(column) if column.isdecimal() and len(column) < LONGEST_NUMBER else column,
            listed,
        )


class _Channel(NamedTuple):
    """Samples of a channel."""

    role: _Role
    head: str
    """Head of its column."""
    values: NDArray[np.float64]

    def wrong(self, word: str, hint: str) -> InputError:
        """Return the error of a word behind the colon."""
        return inputs.rejected(self.role.role, f"{self.role.column}:{word}", hint)

    def seconds(self) -> NDArray[np.float64]:
        """Return times, s, which must ascend."""
        unit = _TIME_UNIT.search(self.head)
        named = "s" if unit is None or unit[2] else unit[1].lower()
        for word in self.role.words:
            if word not in TIME_UNITS:
                raise self.wrong(word, f"give a unit of time: {', '.join(TIME_UNITS)}")
            named = word
        seconds = self.values * TIME_UNITS[named]
        if (falls := np.diff(seconds) <= 0.0).any():
            k = int(falls.argmax())
            fault = f"has {self.values[k + 1]:.10g} after {self.values[k]:.10g}, sample {k + 1}"
            hint = Hint.of("times must ascend; sort them, write more digits, or `sampling_rate=…`")
            raise inputs.faulty("time", fault, hint)
        return seconds

    def marks(self) -> tuple[NDArray[np.float64], float | None, bool]:
        """Return values, threshold and whether falling edges count, as the core takes them."""
        threshold, falls = None, False
        for word in self.role.words:
            level = _LEVEL.fullmatch(word)
            if word in ("rising", "falling"):
                falls = word == "falling"
            elif level is None:
                raise self.wrong(word, MARK_HINT)
            else:
                number = _number(self, level[1], "", MARK_HINT)
                threshold = number * VOLTS[level[2]] / self._volt() if level[2] else number
        return self.values, threshold, falls

    def _volt(self) -> float:
        """Return volts of the column's unit; without one it is the volt."""
        unit = _VOLT_UNIT.search(self.head)
        return VOLTS["mV" if unit is not None and unit[1][0] == "m" else "V"]

    def pressure(
        self, unit: str | None, gauge: bool | None, atmosphere: float
    ) -> tuple[NDArray[np.float64], str]:
        """Return absolute pressure, Pa, and how it was read."""
        added = inputs.finite("atmosphere", atmosphere)
        words = self.role.words
        if not words:
            if unit is None and _VOLT_UNIT.search(self.head):
                raise self.wrong("", f"{inputs.shorten(self.head)} is in volts; {GAIN_HINT}")
            named, by = cycle_files._pressure_unit(unit, self.head)
            above, _ = cycle_files._is_gauge(gauge, self.head)
            factor, offset, said = cycle_files.PRESSURE_UNITS[named], 0.0, f"{named} ({by})"
        else:
            if unit is not None:
                raise inputs.rejected("pressure_unit", unit, "a gain has its own; leave it out")
            gain = _GAIN.fullmatch(words[0])
            if gain is None or len(words) > 2:
                raise self.wrong(",".join(words), GAIN_HINT)
            factor = _number(self, gain[1], "Pa", GAIN_HINT) * self._volt() / VOLTS[gain[2]]
            offset = _number(self, words[1], "Pa", GAIN_HINT) if len(words) > 1 else 0.0
            if factor == 0.0:
                raise self.wrong(words[0], "a gain of zero leaves no pressure")
            above, said = False if gauge is None else inputs.flag("gauge", gauge), ",".join(words)
        said += f", gauge, {added:g} Pa added" if above else ", absolute"
        return factor * self.values + offset + (added if above else 0.0), said


def _number(channel: _Channel, text: str, unit: str, hint: str) -> float:
    """Return a number, of pressure with its unit, Pa."""
    try:
        values, word, _, _ = _core.read_numbers(
            channel.role.role, text.strip(), unit, form="number"
        )
    except InputError:
        raise channel.wrong(text, hint) from None
    if unit and not word:
        raise channel.wrong(text, f"it has no unit; {hint}")
    return values[0]


def _channels(
    source: object, roles: Sequence[_Role], sheet: str | None
) -> tuple[str, list[_Channel]]:
    """Return the name of a record and its channels, one for each role."""
    if isinstance(source, Mapping):
        if sheet is not None:
            raise inputs.rejected("sheet", sheet, "samples by name have none; leave it out")
        return "", _of_mapping(source, roles)
    file = inputs.file_path(source, table_files.TABLE_ENDINGS, table_files.FILE_HINT, "source")
    try:
        read = table_files.read(file, [role.column for role in roles], sheet)
    except InputError as error:
        # Of a column the role that names it; the reader speaks of columns and a path.
        wrong = (role for role in roles if error.value in (str(role.column), repr(role.column)))
        error = inputs.renamed(error, "columns", next((one.role for one in wrong), "columns"))
        raise inputs.renamed(error, "path", "source") from None
    heads = read.heads() if read.headed else [""] * len(roles)
    columns = np.ascontiguousarray(read.numbers.T)
    return file.stem, [
        _Channel(role, head, column)
        for role, head, column in zip(roles, heads, columns, strict=True)
    ]


def _of_mapping(source: Mapping[Any, Any], roles: Sequence[_Role]) -> list[_Channel]:
    """Return channels of samples by name."""
    channels = list[_Channel]()
    for role in roles:
        if role.column not in source:
            choices = ", ".join(repr(key) for key in list(source)[: table_files.FIRST_WORDS])
            hint = f"there is none; the source has {choices}"
            raise inputs.rejected(role.role, role.column, hint)
        samples = source[role.column]
        if isinstance(samples, np.ndarray) and samples.dtype == bool:  # of a logic analyser
            samples = samples.astype(float)
        values = inputs.contiguous(inputs.array(role.role, samples).ravel())
        if (wrong := ~np.isfinite(values)).any():
            fault = f"has {values[wrong][0]} as sample {int(wrong.argmax())}"
            raise inputs.faulty(role.role, fault, "give finite numbers")
        if channels and len(values) != len(channels[0].values):
            first = channels[0]
            fault = f"has {len(values)} samples, {first.role.role} {len(first.values)}"
            raise inputs.faulty(role.role, fault, "give channels of one length")
        channels.append(_Channel(role, str(role.column), values))
    return channels


class Oscillogram(Tabled):
    """Cylinder pressure and crank speed of a record over time.

    ``plot`` draws the speed over crank angle. Made by :func:`crankpin.oscillogram`.
    """

    traces: tuple[Traces, ...]
    """Cycles of each cylinder, crank angles counted from its own firing top dead centre."""
    theta_deg: NDArray[np.float64]
    """Crank angles after the first cylinder's firing top dead centre, degrees: (n,)."""
    speed: NDArray[np.float64]
    """Crank speed within each cycle of the first cylinder, rpm: (n_cycles, n).

    Of the orders up to ``highest_order``; a change of the mean from cycle to cycle is taken out.
    """
    highest_order: float
    """Highest order of speed that the pulses resolve."""
    pulse_faults: tuple[tuple[float, float, int], ...]
    """Time, s, and crank angle after the index, degrees, before pulses that are missing, with their
    number, or of a pulse that is extra, with -1."""
    name: str
    """Name; may be empty."""

    def __post_init__(self) -> None:
        hint = "use crankpin.oscillogram"
        of_traces = isinstance(self.traces, tuple) and self.traces
        if not of_traces or not all(isinstance(each, Traces) for each in self.traces):
            raise inputs.rejected("traces", self.traces, hint)
        theta, speed = inputs.vector("theta_deg", self.theta_deg), inputs.array("speed", self.speed)
        if speed.ndim != 2 or not len(speed) or speed.shape[1] != len(theta):
            raise inputs.faulty("speed", f"has shape {speed.shape}", hint)
        inputs.number("highest_order", self.highest_order)
        super().__post_init__()

    @functools.cached_property
    def rpm(self) -> NDArray[np.float64]:
        """Mean speed of each cycle over time, rpm: (n_cycles,)."""
        return read_only(1.0 / (1.0 / self.speed).mean(axis=1))

    @functools.cached_property
    def irregularity(self) -> NDArray[np.float64]:
        """Largest less least speed over the mean speed of each cycle: (n_cycles,)."""
        return read_only((self.speed.max(axis=1) - self.speed.min(axis=1)) / self.rpm)

    def speed_harmonics(self, orders: Order | Iterable[Order]) -> NDArray[np.complex128]:
        """Return the peak phasors of speed in each cycle, rpm.

        Parameters
        ----------
        orders : number or iterable of number
            Orders of crank speed, whole or half, up to ``highest_order``.

        Returns
        -------
        ndarray of complex, shape (n_cycles, n_orders)
            Peak phasors, rpm, over crank angle after the first cylinder's firing top dead centre.

        Raises
        ------
        InputError
            If an order is higher than the pulses resolve.
        """
        chosen = inputs.explicit_half_orders(orders)
        if high := [order for order in chosen if order > self.highest_order]:
            hint = f"the pulses resolve orders up to {self.highest_order:g}"
            raise inputs.rejected("orders", high[0], hint)
        halves = [int(2 * order) for order in chosen]
        period = self.traces[0].period_deg
        phasors = _core.phasors_of_curves(self.speed, period, halves)
        # From the first of the angles to the dead centre.
        turned: NDArray[np.complex128] = phasors * np.exp(
            -1j * np.radians(self.theta_deg[0]) * np.array(chosen, dtype=float)
        )
        return turned

    @property
    def title(self) -> str:
        """Title of table and picture."""
        count = len(self.speed)
        name = labels.cut(labels.one_line(self.name)) or "Oscillogram"
        return f"{name}, {count} cycle{'s' * (count > 1)}"

    @functools.cached_property
    def _shown(self) -> list[Order]:
        least = 0.5 if self.traces[0].strokes == 4 else 1
        return [order for order in SHOWN_ORDERS if least <= order <= self.highest_order]

    @property
    def table(self) -> Table:
        """Mean and spread over cycles of speed, its irregularity and its orders."""
        figures: list[OverCycles] = [
            ("speed", "rpm", self.rpm),
            ("irregularity", "%", 100.0 * self.irregularity),
        ]
        phasors = self.speed_harmonics(self._shown)
        for order, phasor in zip(self._shown, phasors.T, strict=True):
            figures.append((f"speed order {order:g}", "rpm", phasor))
        return spread_table(f"{self.title}, speed", figures)

    @property
    def pulses(self) -> Table:
        """Pulses of the encoder that are missing or extra."""
        rows = [
            (seconds, at, "missing" if count > 0 else "extra", abs(count))
            for seconds, at, count in self.pulse_faults
        ]
        heads: list[str | tuple[str, str]] = [
            ("time", "s"), ("crank angle", "°"), "pulses", "number",
        ]  # fmt: skip
        return Table.from_rows(f"{self.title}: pulses missing and extra", heads, rows)

    @property
    def frames(self) -> Frames:
        """``table``; ``curve``: speed over crank angle."""
        return self._frames(curve=self._curve)

    def _curve(self) -> Table:
        curves = {
            "mean": self.speed.mean(axis=0),
            "least": self.speed.min(axis=0),
            "largest": self.speed.max(axis=0),
        }
        return Table(
            f"{self.title}, speed over crank angle",
            (
                Column("crank angle", self.theta_deg, "°", digits=10),
                *(Column(name, values, "rpm", digits=7) for name, values in curves.items()),
            ),
        )
