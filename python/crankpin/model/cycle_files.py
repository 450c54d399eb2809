"""Tables of cylinder pressure over crank angle in files, of one cycle or many."""

from __future__ import annotations

import contextlib
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, TypedDict

import numpy as np

from crankpin import _core
from crankpin._support import files, inputs
from crankpin._support.messages import Hint, warn
from crankpin._support.parameters import documented
from crankpin.model import table_files

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.cycle import Cycle
    from crankpin.model.table_files import Column, Columns

TEXT_FILE_HINT = "name a text file, .csv, .tsv, .txt, .dat or .asc"

PRESSURE_UNITS = {
    "Pa": 1.0,
    "hPa": 1e2,
    "kPa": 1e3,
    "MPa": 1e6,
    "mbar": 1e2,
    "bar": 1e5,
    "psi": 6894.757293168361,
}
"""Unit → Pa."""
TIME_UNITS = {"s": 1.0, "ms": 1e-3}
"""Unit → seconds."""
ANGLE_UNITS = {"deg": 1.0, "rad": 180.0 / np.pi} | TIME_UNITS
"""Unit → degrees, or seconds of records over time."""

_PRESSURE = re.compile(r"(?<![a-z])([hkm]?pa|m?bar|psi)(?=[agd]?(?![a-z]))", re.IGNORECASE)
_GAUGE = re.compile(
    r"gauge|gage|relati[vo]|[üu]e?berdruck|bar_?g\b|psi_?g\b|pa_?g\b|\(g\)", re.IGNORECASE
)
_ABSOLUTE = re.compile(r"abs|bar_?a\b|psi_?a\b|pa_?a\b|\(a\)", re.IGNORECASE)
_RADIANS = re.compile(r"(?<![a-z])rad(ians?)?(?![a-z])", re.IGNORECASE)
_TIME = re.compile(r"\btime\b|\bt\b|\bZeit\b", re.IGNORECASE)
_SECONDS = re.compile(r"(?<![a-z])(ms|s)(?![a-z])", re.IGNORECASE)

SIMILAR = 0.9
"""Correlation of two columns from which both are pressure: cycles of one cylinder have 0.99."""

DIFFERENT = 1e-3
"""Part of a step by which angles of two cycles may differ and still be one grid."""
INCOMPLETE = 0.9
"""Part of a period below which a block is no whole cycle."""
MISSING_STEP = 1.9
"""Step over the usual one beside it from which lines are missing: a missing tooth makes it 2."""
STEPS_BESIDE = 5
"""Steps at either side of which the median is the usual one."""
RARE = 0.05
"""Part of the steps of a file up to which gaps, or angles that stand twice, are faults of it."""
RISE = (0.1, 0.25)
"""Parts of the range of pressure below and above which a compression begins and has passed; half
of the compression pressure, before any combustion."""
SPEEDS = 0.05
"""Relative difference of a speed from that of the record's cycles up to which it may be theirs."""
UNEVEN = 0.02
"""Relative difference of a cycle's speed from the median from which it is named: idling engines
have 0.01."""
RECORDED_SPEEDS = (15.0, 40_000.0)
"""Speeds, rpm, of ship's engines at their slowest and of models: others are of times in other
units."""
MOST_PLACES_NAMED = 3
"""Number of places that a warning names; of more it gives the count."""


class Recorded(NamedTuple):
    """Cycles of a file: the fields of :class:`Traces`, and of a cycle that was saved."""

    theta_deg: NDArray[np.float64]
    pressure: NDArray[np.float64]
    """Pressure by cycle, Pa: (n_cycles, n)."""
    strokes: int
    name: str
    origin: str
    """Description of what was read."""
    degree: int | None


class FileOptions(TypedDict, total=False):
    """Options of files of cycles: see :meth:`Traces.load`."""

    pressure_unit: str | None
    angle_unit: Literal["deg", "rad", "s", "ms"] | None
    gauge: bool | None
    atmosphere: float
    tdc_deg: float
    columns: Sequence[Column] | None
    sheet: str | None
    recorded_rpm: float | None
    strokes: int | None
    name: str | None


class CylinderFileOptions(TypedDict, total=False):
    """Options of files of several cylinders: see :meth:`Traces.load_cylinders`."""

    pressure_unit: str | None
    angle_unit: Literal["deg", "rad", "s", "ms"] | None
    gauge: bool | None
    atmosphere: float
    sheet: str | None
    recorded_rpm: float | None
    strokes: int | None


def load(
    path: str | Path,
    *,
    columns: Sequence[Column] | None = None,
    sheet: str | None = None,
    tdc_deg: float = 0.0,
    pressure_unit: str | None = None,
    angle_unit: str | None = None,
    gauge: bool | None = None,
    atmosphere: float = _core.ATMOSPHERE,
    recorded_rpm: float | None = None,
    strokes: int | None = None,
    name: str | None = None,
) -> Recorded:
    """Return the cycles in a file: see :meth:`Traces.load`.

    Parameters
    ----------
    path : str or pathlib.Path
        ``.csv``, ``.tsv``, ``.txt``, ``.dat`` or ``.asc``; ``.xlsx``, which needs
        ``pip install "crankpin[excel]"``; or variables of a file of MATLAB, ``.mat``, which needs
        ``crankpin[optimize]``, or of HDF5, ``.h5``, ``crankpin[hdf5]``.
    columns : sequence of int or str, optional
        Columns of angle and pressure, those of further cycles after them, by number from 0 or name;
        by default the first two, and all that are like the second. Names are with or without unit;
        that of a variable of two dimensions is that of all its columns.
    sheet : str, optional
        Sheet of a spreadsheet; by default the first.
    tdc_deg : float, default 0.0
        Angle of the firing top dead centre as the file counts, degrees, from whatever event.
    pressure_unit : str, optional
        Unit of pressure: Pa, hPa, kPa, MPa, mbar, bar or psi; by default what the header names.
    angle_unit : {"deg", "rad", "s", "ms"}, optional
        Unit of angles, or of times; by default what the header names, else degrees. Times become
        angles at a constant speed, that at which three or more compressions follow each other.
    gauge : bool, optional
        True for pressure above that of the atmosphere; by default what the header says. False for
        absolute pressure.
    atmosphere : float, default 101325.0
        Pressure added to gauge pressure, Pa.
    recorded_rpm : float, optional
        Crank speed of a record over time, rpm, of less than three cycles.
    strokes : {4, 2}, optional
        Strokes of a cycle, 4 or 2; by default 4, or what :meth:`Cycle.save` has written.
    name : str, optional
        Name; by default that of the file, or what :meth:`Cycle.save` has written.

    Raises
    ------
    InputError
        If the file states no unit, or not whether pressure is absolute, and the arguments do
        neither; if it has no such columns; if angles are not ascending or do not cover one period.
    OSError
        If the file cannot be read.
    ImportError
        If openpyxl, SciPy or h5py, which spreadsheets, MATLAB or HDF5 need, is not installed.

    Warns
    -----
    UserWarning
        If compressions follow each other at another speed than is given, lines are missing or
        repeated; or there are spikes or odd cycles.
    """
    file = inputs.file_path(path, table_files.TABLE_ENDINGS, table_files.FILE_HINT)
    hint = "give two, of angle and pressure, or more of pressure"
    chosen = None if columns is None else inputs.items("columns", columns, hint)
    if chosen is not None and len(chosen) < 2:
        raise inputs.rejected("columns", columns, hint)
    text = table_files.read(file, chosen, sheet, tables=True)
    title = _name(text.facts.get("name", file.stem)) if name is None else name
    options = (pressure_unit, angle_unit, gauge, atmosphere, recorded_rpm, strokes)
    return _recorded(text, chosen is None, tdc_deg, title, *options)


@documented(load)
def load_cylinders(
    path: str | Path,
    columns: Sequence[Column | Sequence[Column]],
    tdc_deg: ArrayLike,
    *,
    sheet: str | None = None,
    pressure_unit: str | None = None,
    angle_unit: str | None = None,
    gauge: bool | None = None,
    atmosphere: float = _core.ATMOSPHERE,
    recorded_rpm: float | None = None,
    strokes: int | None = None,
) -> list[Recorded]:
    """Return the cycles of several cylinders in a file: see :meth:`Traces.load_cylinders`."""
    file = inputs.file_path(path, table_files.TABLE_ENDINGS, table_files.FILE_HINT)
    hint = "give that of angle, and one or a list for each cylinder"
    angle, *cylinders = inputs.items("columns", columns, hint) or [None]
    lists = [
        inputs.items("columns", cylinder, hint)
        if isinstance(cylinder, (list, tuple))
        else [cylinder]
        for cylinder in cylinders
    ]
    if not lists or not all(lists):
        raise inputs.rejected("columns", columns, hint)
    centres = inputs.per_item("tdc_deg", tdc_deg, len(lists))
    if len(centres) != len(lists):
        fault = f"has {len(centres)} angles for {len(lists)} cylinders"
        raise inputs.faulty("tdc_deg", fault, "give one for each column of pressure")
    text = table_files.read(file, [angle, *(place for one in lists for place in one)], sheet)
    options = (pressure_unit, angle_unit, gauge, atmosphere, recorded_rpm, strokes)
    records, first = list[Recorded](), 1
    for number, (one, centre) in enumerate(zip(lists, centres, strict=True), 1):
        chosen = text.of([0, *range(first, first + len(one))])
        first += len(one)
        head = chosen.heads()[1] if text.headed else f"cylinder {number}"
        records.append(_recorded(chosen, False, centre, f"{file.stem}, {head}", *options))
    return records


def _recorded(
    text: Columns,
    every: bool,
    tdc_deg: float,
    name: str,
    pressure_unit: str | None,
    angle_unit: str | None,
    gauge: bool | None,
    atmosphere: float,
    recorded_rpm: float | None,
    strokes: int | None,
) -> Recorded:
    """Return the cycles in columns that were read, of angle or time and of pressure."""
    _check_heads(text)
    heads, read = text.heads(), text.numbers.shape[1]
    text = _of_cycles(text) if every else text
    count = text.numbers.shape[1] - 1
    by_file = _fact(text.facts, "strokes")
    strokes = inputs.strokes((4 if by_file is None else by_file) if strokes is None else strokes)
    unit, by_unit = _angle_unit(angle_unit, heads[0])
    of_pressure, by_pressure = _pressure_unit(pressure_unit, heads[1])
    above, by_gauge = _is_gauge(gauge, heads[1])
    period = 180.0 * strokes
    half = np.inf if unit in TIME_UNITS else period / 2.0 / ANGLE_UNITS[unit]
    text = _ascending(text, half, ours=by_file is not None)
    where = text.numbers[:, 0] * ANGLE_UNITS[unit]
    pressures = np.ascontiguousarray(text.numbers[:, 1:].T)
    added = inputs.finite("atmosphere", atmosphere)
    for k, head in enumerate(text.heads()[1:]):
        stated = of_pressure if pressure_unit is not None or not text.headed else None
        pressures[k] *= PRESSURE_UNITS[stated or _unit_of(head) or of_pressure]
        if above if gauge is not None else _says_gauge(head, above):
            pressures[k] += added
    remarks = [f"{of_pressure} ({by_pressure})"]
    remarks.append(f"gauge ({by_gauge}), {added:g} Pa added" if above else f"absolute ({by_gauge})")
    if unit in TIME_UNITS:
        rpm = _speed(where, pressures[0], recorded_rpm, period)
        where = 6.0 * rpm * where
        remarks.append(f"over time ({by_unit}) at {rpm:.6g} rpm")
        _check_jumps(text, where, period / 2.0)
    else:
        inputs.only_with("a record over time", recorded_rpm=recorded_rpm)
        remarks.append(f"angles in {unit} ({by_unit})")
    tdc = inputs.finite("tdc_deg", tdc_deg)
    remarks.append(f"firing top dead centre at {tdc:g}° of the file")
    if by_file is None:
        _warn_of_gaps(text, half)
    theta, cycles, how = _cycles(text, where - tdc, pressures, period)
    many = len(cycles) > 1
    remarks.insert(0, f"{len(cycles)} cycles {how}" if many else f"1 cycle{how[len('in a row') :]}")
    if every and count < read - 1:
        remarks.insert(1, f"{count} of {read - 1} columns beside the first")
    degree = None if many else _fact(text.facts, "degree")
    return Recorded(theta, cycles, strokes, name, ", ".join(remarks), degree)


# --- lines and columns ----------------------------------------------------------------------------


def _check_heads(text: Columns) -> None:
    """Reject a column of pressure in the place of angles."""
    if not text.headed:
        return
    heads = text.heads()
    if _PRESSURE.search(heads[0]) and not _PRESSURE.search(heads[1]):
        first, second = text.places[:2]
        fault = f"{first} and {second} are headed {inputs.shorten(heads[0])} and "
        fault += inputs.shorten(heads[1])
        hint = Hint.of(f"angle or time comes first; give `columns=({second}, {first})`")
        raise inputs.faulty("columns", fault, hint)


def _of_cycles(text: Columns) -> Columns:
    """Return the columns of angle and first pressure, and of further cycles of that pressure."""
    numbers, heads = text.numbers, text.heads()
    chosen, others = [0, 1], list[int]()
    for k in range(2, numbers.shape[1]):
        rows = np.isfinite(numbers[:, k])
        first, values = numbers[rows, 1], numbers[rows, k]
        if len(values) > 1 and _correlation(first, values) > SIMILAR:
            if not rows.all():
                at = text.where(int(np.flatnonzero(~rows)[0]), k)
                columns = "name the columns of the other cycles, `columns=…`"
                hint = Hint.of(f"give one in each line, or {columns}")
                raise inputs.faulty("path", f"has no number in {at}", hint)
            chosen.append(k)
        elif text.headed and _PRESSURE.search(heads[k]):
            others.append(text.places[k])
    if others:
        columns_text = _listed([str(k) for k in others])
        unlike = f"but unlike column {text.places[1]}, and left out"
        hint = Hint.of(
            "`columns=…` names those of one cylinder, and Traces.load_cylinders reads several"
        )
        warn(f"columns {columns_text}", f"are headed as pressure, {unlike}", hint)
    return text.of(chosen)


def _correlation(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    first, second = first - first.mean(), second - second.mean()
    with np.errstate(all="ignore"):  # of another quantity they may be constant, or huge
        return float(first @ second / np.sqrt((first @ first) * (second @ second)))


def _ascending(text: Columns, half: float, *, ours: bool) -> Columns:
    """Return lines whose angles or times ascend, or begin again, without those that are repeated.

    In our own files, and those of others at few places, an angle that stands twice is one at which
    pressure jumps.
    """
    where, lines = text.numbers[:, 0], text.lines
    steps = np.diff(where)
    falls = (steps < 0.0) & (steps >= -half)
    if falls.any():
        k = int(falls.argmax())
        fault = f"has {where[k + 1]:.10g} after {where[k]:.10g} in {text.where(k + 1, 0)}"
        down = 2 * int(falls.sum()) > len(steps)
        hint = "sort the lines" if down else "is it a wrong figure, or the wrong column?"
        raise inputs.faulty("path", fault, f"angles or times must ascend; {hint}")
    _check_jumps(text, where, half)
    same = np.append(False, steps == 0.0)
    if ours or not same.any():
        return text
    again = same.copy()
    again[1:] &= (text.numbers[1:] == text.numbers[:-1]).all(axis=1)
    jumps = np.flatnonzero(same & ~again)
    if len(jumps) > max(2, RARE * len(where)):
        at = text.where(int(jumps[0]), 0)
        hint = "write angles with more decimals"
        raise inputs.faulty("path", f"has each angle more than once, first in {at}", hint)
    if len(jumps):
        jumps_text = _listed(
            [f"{where[k]:.10g} in lines {lines[k - 1]} and {lines[k]}" for k in jumps]
        )
        about = f"column {text.places[0]}"
        warn(about, f"has twice {jumps_text}", "pressure is taken to jump there")
    if again.any():
        jumps_text = _listed([str(k) for k in lines[again]])
        fault = f"has lines twice, {jumps_text} as the one before"
        warn("the file", fault, "they are left out")
    return text._replace(numbers=text.numbers[~again], lines=lines[~again])


def _check_jumps(text: Columns, where: NDArray[np.float64], half: float) -> None:
    """Reject angles that jump by more than half a cycle."""
    far = np.diff(where) > half
    if far.any():
        k = int(far.argmax())
        before, after = text.numbers[k : k + 2, 0]
        fault = f"has {after:.10g} after {before:.10g} in {text.where(k + 1, 0)}"
        raise inputs.faulty("path", fault, "half a cycle and more is missing there")


def _warn_of_gaps(text: Columns, half: float) -> None:
    """Warn of lines that are missing, which few steps that are far wider than others show."""
    where = text.numbers[:, 0]
    steps = np.abs(np.diff(where))
    inside = steps < half  # not where angles begin again
    if len(steps) <= 2 * STEPS_BESIDE:
        return
    wide = inside & (steps > MISSING_STEP * np.median(steps[inside]))
    gaps = list[int]()
    for k in np.flatnonzero(wide) if int(wide.sum()) <= RARE * len(steps) else ():
        beside = steps[max(0, k - STEPS_BESIDE) : k + STEPS_BESIDE + 1]
        if steps[k] > MISSING_STEP * np.median(beside):
            gaps.append(int(k))
    if gaps:
        lines = text.lines
        angles_text = _listed(
            [
                f"{where[k]:.10g} and {where[k + 1]:.10g} (lines {lines[k]} and {lines[k + 1]})"
                for k in gaps
            ]
        )
        hint = "lines, or teeth of the encoder, are missing, and pressure is interpolated there"
        warn(f"column {text.places[0]}", f"has nothing between {angles_text}", hint)


def _listed(places: Sequence[str]) -> str:
    """Return some places in words, and how many there are besides."""
    more = f" and {len(places) - MOST_PLACES_NAMED} more" if len(places) > MOST_PLACES_NAMED else ""
    return ", ".join(places[:MOST_PLACES_NAMED]) + more


# --- cycles ---------------------------------------------------------------------------------------


def _cycles(
    text: Columns, theta: NDArray[np.float64], pressures: NDArray[np.float64], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], str]:
    """Return the grid of a cycle, the cycles in columns and blocks, and how they stood."""
    columns = "in columns" if len(pressures) > 1 else ""
    steps = np.diff(theta)
    if not len(steps):
        return theta, pressures, columns
    resets = np.flatnonzero(steps < -period / 2.0) + 1
    if len(resets):
        grid, rows, left = _blocks(text, theta, pressures, resets, period)
        how = f"in blocks{columns and ' and columns'}"
    else:
        step = float(np.median(steps))
        count = int((theta[-1] - theta[0] + step) / period + DIFFERENT)
        if count < 2 or step <= 0.0:
            return theta, pressures, columns
        if round(period / step) < 1:
            fault = f"has {step:.3g}° from one point to the next"
            hint = Hint.of("are units and `recorded_rpm` right?")
            raise inputs.faulty("path", fault, hint)
        grid, rows = _resampled(theta, pressures, period, count)
        left = bool(theta[-1] - theta[0] > count * period + step / 2.0)
        how = f"in a row{columns and ' and columns'}"
        rises = len(_rises(theta, pressures[0]))
        if rises and abs(rises - count) > max(1.0, RARE * count):
            fault = f"rises {rises} times in the file, which has {count} cycles of {period:g}°"
            hint = Hint.of("are `angle_unit` and `strokes` right?")
            warn("pressure", fault, hint)
    return grid, rows, how + (", an incomplete one left out" if left else "")


def _blocks(
    text: Columns,
    theta: NDArray[np.float64],
    pressures: NDArray[np.float64],
    resets: NDArray[np.intp],
    period: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Return blocks of rows on the grid of most of them, and whether any was left out."""
    angles, values = np.split(theta, resets), np.split(pressures, resets, 1)
    first = [0, *resets.tolist()]
    whole = [k for k, theta in enumerate(angles) if _span(theta) >= INCOMPLETE * period]
    if not whole:
        at, longest = text.where(0, 0), max(map(_span, angles))
        fault = f"has angles that begin again after {longest:g}°, in blocks from {at}"
        raise inputs.faulty("path", fault, f"a cycle has {period:g}°")
    for k in whole:
        if _span(angles[k]) > period * (1.0 + DIFFERENT):
            fault = f"has {_span(angles[k]):g}° in the block that begins with"
            fault += f" {text.where(first[k], 0)}"
            raise inputs.faulty("path", fault, f"a cycle has {period:g}°")
    between = [k for k in range(1, len(angles) - 1) if k not in whole]
    if between:
        lines_text = _listed([str(text.lines[first[k]]) for k in between])
        warn("blocks of lines", f"begin in line {lines_text}", "no whole cycles, they are left out")
    usual = float(np.median([len(angles[k]) for k in whole]))
    grid = min((angles[k] for k in whole), key=lambda theta: abs(len(theta) - usual))
    step = period / max(len(grid), 1)
    rows = [
        values[k]
        if angles[k].shape == grid.shape and np.abs(angles[k] - grid).max() < DIFFERENT * step
        else np.array([_interpolated(angles[k], one, grid, period) for one in values[k]])
        for k in whole
    ]
    return grid, np.concatenate(rows), len(whole) < len(angles)


def _span(theta: NDArray[np.float64]) -> float:
    """Return what a block covers, degrees, with the step to its repetition."""
    return float(theta[-1] - theta[0]) + float(np.median(np.diff(theta)) if len(theta) > 1 else 0.0)


def _resampled(
    theta: NDArray[np.float64], pressures: NDArray[np.float64], period: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return cycles that follow each other in angles that go on, on one grid."""
    points = round(period / float(np.median(np.diff(theta))))
    step = period / points
    grid = theta[0] + step * np.arange(points)
    every = theta[0] + step * np.arange(count * points)
    first_angles = theta[: len(every)]
    if first_angles.shape == every.shape and np.abs(first_angles - every).max() < DIFFERENT * step:
        first_rows = pressures[:, : len(every)]
    else:
        first_rows = np.array([_core.cubics(theta, one, every) for one in pressures])
    return grid, first_rows.reshape(-1, points)


def _interpolated(
    theta: NDArray[np.float64], values: NDArray[np.float64], at: NDArray[np.float64], period: float
) -> NDArray[np.float64]:
    """Return a cycle's values at angles of another grid, its ends joined."""
    ends = slice(None) if theta[-1] - theta[0] < period - DIFFERENT else slice(None, -1)
    theta, values = theta[ends], values[ends]
    around = np.concatenate([theta[-3:] - period, theta, theta[:3] + period])
    joined = np.concatenate([values[-3:], values, values[:3]])
    return _core.cubics(around, joined, (at - theta[0]) % period + theta[0])


def _speed(
    seconds: NDArray[np.float64], pressure: NDArray[np.float64], stated: float | None, period: float
) -> float:
    """Return the speed of a record over time, rpm: that of its compressions, if it has three."""
    if stated is not None:
        stated = inputs.positive("recorded_rpm", stated, "give the crank speed of the record")
    times = _rises(seconds, pressure)
    if len(times) < 3:
        if stated is None:
            fault = "has fewer than three cycles over time"
            hint = Hint.of("give the crank speed, `recorded_rpm=…`")
            raise inputs.faulty("path", fault, hint)
        return stated
    usual = float(np.median(np.diff(times)))
    counts = np.maximum(1.0, np.round(np.diff(times) / usual))
    of_one = float(np.polyfit(np.append(0.0, np.cumsum(counts)), times, 1)[0])
    rpm = period / 6.0 / of_one
    if not RECORDED_SPEEDS[0] < rpm < RECORDED_SPEEDS[1]:
        fault = f"follow each other at {rpm:.4g} rpm"
        warn("compressions of the record", fault, "is the unit of time right?")
    of_each = usual * counts / np.diff(times) - 1.0
    if (odd := np.flatnonzero(np.abs(of_each) > UNEVEN)).size:
        changes_text = _listed([f"{100.0 * of_each[k]:+.1f} % after {times[k]:.6g} s" for k in odd])
        warn("the speed of the record", f"changes, {changes_text}", "a constant one is assumed")
    if stated is not None and abs(rpm - stated) > SPEEDS * stated:
        measured = f"compressions of the record follow each other at {rpm:.5g} rpm, which is taken"
        hint = Hint.of("are `strokes` and unit of time right?")
        warn("recorded_rpm", f"= {stated:g}: {measured}", hint)
    return rpm


def _rises(seconds: NDArray[np.float64], pressure: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the times at which pressure rises past a quarter of its range, once a compression."""
    # Without spikes of two samples, which rise and fall at once.
    around = np.pad(pressure, 2, mode="edge")
    pressure = np.median(np.stack([around[k : k + len(pressure)] for k in range(5)]), axis=0)
    least, most = np.median(pressure), np.quantile(pressure, 0.999)
    low, high = (least + part * (most - least) for part in RISE)
    outside = np.flatnonzero((pressure < low) | (pressure > high))
    above = pressure[outside] > high
    after = outside[1:][above[1:] & ~above[:-1]]
    before = after - 1
    share = (high - pressure[before]) / (pressure[after] - pressure[before])
    instants: NDArray[np.float64] = seconds[before] + share * (seconds[after] - seconds[before])
    return instants


# --- text -----------------------------------------------------------------------------------------


def save(cycle: Cycle, path: str | Path) -> None:
    """Write a cycle to a file that reads back as an equal one."""
    file = inputs.file_path(path, table_files.TEXTS, TEXT_FILE_HINT)
    separator = "\t" if file.suffix.lower() == ".tsv" else ","
    in_line = cycle.name.isprintable() and cycle.name == " ".join(cycle.name.split())
    name = cycle.name if in_line and not cycle.name.startswith('"') else json.dumps(cycle.name)
    facts = {"name": name, "strokes": cycle.strokes, "degree": cycle.degree}
    lines = [f"# {key}: {value}" for key, value in facts.items() if value is not None]
    lines.append(f"crank angle deg{separator}absolute pressure Pa")
    pairs = zip(cycle.theta_deg.tolist(), cycle.pressure.tolist(), strict=True)
    lines += [f"{angle!r}{separator}{pressure!r}" for angle, pressure in pairs]
    files.write(file, "\n".join([*lines, ""]))


def _name(text: str) -> str:
    """Return a name as it was before :func:`save` put it into one line."""
    with contextlib.suppress(ValueError):
        return json.loads(text) if text.startswith('"') else text
    return text


def _fact(facts: dict[str, str], name: str) -> int | None:
    value = facts.get(name)
    if value is not None and not value.isdecimal():
        fault = f"has {name} = {inputs.shorten(value)}"
        raise inputs.faulty("path", fault, "give a whole number")
    return None if value is None else int(value[:9])


def _angle_unit(stated: str | None, head: str) -> tuple[str, str]:
    """Return the unit of angles or times, and its source."""
    if stated is not None:
        return inputs.one_of("angle_unit", stated, ANGLE_UNITS), "given"
    if _RADIANS.search(head):
        return "rad", "header"
    if _TIME.search(head):
        unit = _SECONDS.search(head)
        return (unit[1].lower(), "header") if unit else ("s", "assumed")
    return "deg", "header" if re.search("deg|°", head, re.IGNORECASE) else "assumed"


def _pressure_unit(stated: str | None, head: str) -> tuple[str, str]:
    """Return the unit of pressures, and its source."""
    if stated is not None:
        return inputs.one_of("pressure_unit", stated, PRESSURE_UNITS), "given"
    unit = _unit_of(head)
    if unit is None:
        choices = ", ".join(PRESSURE_UNITS)
        raise inputs.rejected(
            "pressure_unit",
            None,
            "the file does not name one; head its column p [bar] or the like, or give one of "
            f"{choices}",
        )
    return unit, "header"


def _unit_of(head: str) -> str | None:
    """Return the one unit of pressure in a head."""
    units = {match[1].lower() for match in _PRESSURE.finditer(head)}
    named = [unit for unit in PRESSURE_UNITS if unit.lower() in units]
    return named[0] if len(named) == 1 else None


def _is_gauge(stated: bool | None, head: str) -> tuple[bool, str]:
    """Return whether pressures are above that of the atmosphere, and the source of that."""
    if stated is not None:
        return inputs.flag("gauge", stated), "given"
    if (is_gauge := _says_gauge(head)) is None:
        raise inputs.rejected(
            "gauge",
            None,
            Hint.of(
                "the file does not state whether pressure is gauge or absolute; write one "
                "of these words into its header, or give `gauge=True`, or `gauge=False` "
                "for absolute pressure"
            ),
        )
    return is_gauge, "header"


def _says_gauge(head: str, otherwise: bool | None = None) -> bool | None:
    """Return whether a head says gauge or absolute pressure."""
    above, absolute = bool(_GAUGE.search(head)), bool(_ABSOLUTE.search(head))
    return otherwise if above == absolute else above
