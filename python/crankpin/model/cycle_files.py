"""Tables of cylinder pressure over crank angle in text files, of one cycle or many."""

from __future__ import annotations

import codecs
import contextlib
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias, TypedDict

import numpy as np

from crankpin import _core
from crankpin._support import files, inputs
from crankpin._support.warnings import warn

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from crankpin.model.cycle import Cycle

ENDINGS = (".csv", ".tsv", ".txt", ".dat", ".asc")
HINT = "name a text file, .csv, .tsv, .txt, .dat or .asc"

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
_GAUGE = re.compile(r"gauge|gage|relative|bar_?g\b|psi_?g\b|pa_?g\b|\(g\)", re.IGNORECASE)
_ABSOLUTE = re.compile(r"abs|bar_?a\b|psi_?a\b|pa_?a\b|\(a\)", re.IGNORECASE)
_RADIANS = re.compile(r"(?<![a-z])rad(ians?)?(?![a-z])", re.IGNORECASE)
_TIME = re.compile(r"\btime\b|\bt\b|\bZeit\b", re.IGNORECASE)
_SECONDS = re.compile(r"(?<![a-z])(ms|s)(?![a-z])", re.IGNORECASE)
_LINE = re.compile(r"\r\n|\r|\n")
_FACT = re.compile(r"# (name|strokes|degree): ?(.*)")
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?"
_COMMA_NUMBER = re.compile(_NUMBER.replace(r"\.", "[.,]"))

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
"""Byte order marks, and what they stand for."""
SIMILAR = 0.9
"""Correlation of two columns from which both are pressure: cycles of one cylinder have 0.99."""

PIECE = 2**20
"""Bytes that are read and converted at once: Ctrl-C is answered in between."""
DIFFERENT = 1e-3
"""Part of a step by which angles of two cycles may differ and still be one grid."""
INCOMPLETE = 0.9
"""Part of the points of most blocks below which a block is no whole cycle."""
RISE = (0.1, 0.25)
"""Parts of the range of pressure below and above which a compression begins and has passed; half
of the compression pressure, before any combustion."""
SPEEDS = 0.05
"""Relative difference of a speed from that of the record's cycles up to which it may be theirs."""

Column: TypeAlias = int | str


class Recorded(NamedTuple):
    """Cycles of a file: the fields of :class:`Traces`, and of a cycle that was saved."""

    theta_deg: NDArray[np.float64]
    pressure: NDArray[np.float64]
    """Pressure by cycle, Pa: (n_cycles, n)."""
    strokes: int
    name: str
    origin: str
    """What was read, in words."""
    degree: int | None


class _Text(NamedTuple):
    """Parts of a file: facts of our own ones, cells of the header, numbers of the columns read."""

    facts: dict[str, str]
    header: list[str]
    names: list[str]
    """Cells of the line above the header, where it has as many; else empty."""
    width: int
    """Number of columns."""
    places: list[int]
    numbers: NDArray[np.float64]
    """Numbers of the columns at these places: (n_rows, n_places)."""

    def heads(self) -> list[str]:
        """Return the head of each column read, with its name where that stands above."""
        # Names with blanks of columns separated by blanks cannot be distinguished.
        apart = len(self.header) == self.width
        heads = [self.header[k] if apart else " ".join(self.header) for k in self.places]
        if not self.names:
            return heads
        return [f"{self.names[k]} {head}" for k, head in zip(self.places, heads, strict=True)]


class FileOptions(TypedDict, total=False):
    """Options of files of cycles: see :meth:`Traces.load`."""

    pressure_unit: str | None
    angle_unit: Literal["deg", "rad", "s", "ms"] | None
    gauge: bool | None
    atmosphere: float
    tdc_deg: float
    columns: Sequence[Column] | None
    recorded_rpm: float | None
    strokes: int | None
    name: str | None


def load(
    path: str | Path,
    *,
    pressure_unit: str | None = None,
    angle_unit: str | None = None,
    gauge: bool | None = None,
    atmosphere: float = _core.ATMOSPHERE,
    tdc_deg: float = 0.0,
    columns: Sequence[Column] | None = None,
    recorded_rpm: float | None = None,
    strokes: int | None = None,
    name: str | None = None,
) -> Recorded:
    """Return the cycles in a file: see :meth:`Traces.load`."""
    file = inputs.file_path(path, ENDINGS, HINT)
    hint = "give two, of angle and pressure, or more of pressure"
    chosen = None if columns is None else inputs.items("columns", columns, hint)
    if chosen is not None and len(chosen) < 2:
        raise inputs.rejected("columns", columns, hint)
    text = _read(file, chosen)
    heads = text.heads()
    numbers = text.numbers if chosen is not None else _of_cycles(text.numbers)
    count = numbers.shape[1] - 1
    left = text.numbers.shape[1] - numbers.shape[1]
    strokes = inputs.strokes(_strokes(text.facts) if strokes is None else strokes)
    unit, by_unit = _angle_unit(angle_unit, heads[0])
    where = numbers[:, 0] * ANGLE_UNITS[unit]
    pressures = np.ascontiguousarray(numbers[:, 1:].T)
    of_pressure, by_pressure = _pressure_unit(pressure_unit, heads[1])
    pressures *= PRESSURE_UNITS[of_pressure]
    above, by_gauge = _is_gauge(gauge, heads[1])
    if above:
        pressures += inputs.finite("atmosphere", atmosphere)
    said = [f"{of_pressure} ({by_pressure})"]
    said.append(
        f"gauge ({by_gauge}), {atmosphere:g} Pa added" if above else f"absolute ({by_gauge})"
    )
    period = 180.0 * strokes
    if unit in TIME_UNITS:
        rpm = _speed(where, pressures[0], recorded_rpm, period)
        where = 6.0 * rpm * where
        said.append(f"over time ({by_unit}) at {rpm:.6g} rpm")
    else:
        inputs.only_with("a record over time", recorded_rpm=recorded_rpm)
        said.append(f"angles in {unit} ({by_unit})")
    tdc = inputs.finite("tdc_deg", tdc_deg)
    said.append(f"firing top dead centre at {tdc:g}° of the file")
    theta, found, how = _cycles(where - tdc, pressures, period)
    many = len(found) > 1
    said.insert(0, f"{len(found)} cycles {how}" if many else "1 cycle")
    if chosen is None and left:
        said.insert(1, f"{count} of {count + left} columns beside the first")
    return Recorded(
        theta,
        found,
        strokes,
        _name(text.facts.get("name", file.stem)) if name is None else name,
        ", ".join(said),
        None if many else _fact(text.facts, "degree"),
    )


def _strokes(facts: dict[str, str]) -> int:
    known = _fact(facts, "strokes")
    return 4 if known is None else known


# --- cycles ---------------------------------------------------------------------------------------


def _of_cycles(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the columns of angle and first pressure, and of further cycles of that pressure."""
    first = numbers[:, 1] - numbers[:, 1].mean()
    kept = [0, 1]
    for k in range(2, numbers.shape[1]):
        with np.errstate(all="ignore"):  # a column may have no numbers, or infinite ones
            values = numbers[:, k] - numbers[:, k].mean()
            spread = float(np.sqrt((values @ values) * (first @ first)))
            covariance = float(values @ first)
        if covariance > SIMILAR * spread > 0.0:
            kept.append(k)
    return numbers[:, kept]


def _cycles(
    theta: NDArray[np.float64], pressures: NDArray[np.float64], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], str]:
    """Return the grid of a cycle, the cycles in columns and blocks, and how they stood."""
    columns = "in columns" if len(pressures) > 1 else ""
    steps = np.diff(theta)
    if not len(steps):
        return theta, pressures, columns
    resets = np.flatnonzero(steps < -period / 2.0) + 1
    if len(resets):
        grid, found, left = _blocks(np.split(theta, resets), np.split(pressures, resets, 1), period)
        how = f"in blocks{columns and ' and columns'}"
    else:
        step = float(np.median(steps))
        count = int((theta[-1] - theta[0] + step) / period + DIFFERENT)
        if count < 2 or step <= 0.0:
            return theta, pressures, columns
        grid, found = _resampled(theta, pressures, period, count)
        left = bool(theta[-1] - theta[0] > count * period + step / 2.0)
        how = f"in a row{columns and ' and columns'}"
    return grid, found, how + (", an incomplete one left out" if left else "")


def _blocks(
    angles: list[NDArray[np.float64]], values: list[NDArray[np.float64]], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Return blocks of rows on the grid of the first whole one, and whether any was left out."""
    usual = float(np.median([len(each) for each in angles]))
    whole = [
        (theta, rows)
        for theta, rows in zip(angles, values, strict=True)
        if len(theta) >= INCOMPLETE * usual
    ]
    grid = whole[0][0]
    step = period / max(len(grid), 1)
    rows = [
        each
        if theta.shape == grid.shape and np.abs(theta - grid).max() < DIFFERENT * step
        else np.array([_interpolated(theta, one, grid, period) for one in each])
        for theta, each in whole
    ]
    return grid, np.concatenate(rows), len(whole) < len(angles)


def _resampled(
    theta: NDArray[np.float64], pressures: NDArray[np.float64], period: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return cycles that follow each other in angles that go on, on one grid."""
    points = round(period / float(np.median(np.diff(theta))))
    step = period / points
    grid = theta[0] + step * np.arange(points)
    every = theta[0] + step * np.arange(count * points)
    shown = theta[: len(every)]
    if shown.shape == every.shape and np.abs(shown - every).max() < DIFFERENT * step:
        found = pressures[:, : len(every)]
    else:
        found = np.array([_cubic(theta, one, every) for one in pressures])
    return grid, found.reshape(-1, points)


def _interpolated(
    theta: NDArray[np.float64], values: NDArray[np.float64], at: NDArray[np.float64], period: float
) -> NDArray[np.float64]:
    """Return a cycle's values at angles of another grid, its ends joined."""
    ends = slice(None) if theta[-1] - theta[0] < period - DIFFERENT else slice(None, -1)
    theta, values = theta[ends], values[ends]
    around = np.concatenate([theta[-3:] - period, theta, theta[:3] + period])
    joined = np.concatenate([values[-3:], values, values[:3]])
    return _cubic(around, joined, (at - theta[0]) % period + theta[0])


def _cubic(
    x: NDArray[np.float64], y: NDArray[np.float64], at: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return values at some places of the cubics through four neighbouring points each."""
    if len(x) < 4 or (np.diff(x) <= 0.0).any():
        return np.interp(at, x, y)  # what is wrong with them is said where cycles are checked
    first = np.clip(np.searchsorted(x, at) - 2, 0, len(x) - 4)
    total = np.zeros(at.shape)
    for k in range(4):
        weight = np.ones(at.shape)
        for j in {0, 1, 2, 3} - {k}:
            weight *= (at - x[first + j]) / (x[first + k] - x[first + j])
        total += weight * y[first + k]
    return total


def _speed(
    seconds: NDArray[np.float64], pressure: NDArray[np.float64], stated: float | None, period: float
) -> float:
    """Return the speed of a record over time, rpm: that of its compressions, if it has three."""
    if stated is not None:
        stated = inputs.finite("recorded_rpm", stated)
        if not stated > 0.0:
            raise inputs.rejected("recorded_rpm", stated, "give the crank speed of the record")
    times = _rises(seconds, pressure)
    if len(times) < 3:
        if stated is None:
            fault = "has fewer than three cycles over time"
            raise inputs.faulty("path", fault, "give the crank speed, recorded_rpm=…")
        return stated
    usual = float(np.median(np.diff(times)))
    numbers = np.concatenate([[0.0], np.cumsum(np.round(np.diff(times) / usual))])
    of_one = float(np.polyfit(numbers, times, 1)[0])
    rpm = period / 6.0 / of_one
    if stated is not None and abs(rpm - stated) > SPEEDS * stated:
        warn(
            f"recorded_rpm = {stated:g}: compressions of the record follow each other at {rpm:.5g} "
            "rpm, which is taken; are strokes and unit of time right?"
        )
    return rpm


def _rises(seconds: NDArray[np.float64], pressure: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the times at which pressure rises past a quarter of its range, once a compression."""
    least, most = np.median(pressure), np.quantile(pressure, 0.999)
    low, high = (least + part * (most - least) for part in RISE)
    outside = np.flatnonzero((pressure < low) | (pressure > high))
    above = pressure[outside] > high
    after = outside[1:][above[1:] & ~above[:-1]]
    before = after - 1
    share = (high - pressure[before]) / (pressure[after] - pressure[before])
    found: NDArray[np.float64] = seconds[before] + share * (seconds[after] - seconds[before])
    return found


# --- text -----------------------------------------------------------------------------------------


def _pieces(file: Path) -> Iterator[list[str]]:
    """Yield the lines of a text file, some at a time."""
    with file.open("rb") as opened:
        piece = opened.read(PIECE)
        decoder, rest = codecs.getincrementaldecoder(_encoding(piece))("replace"), ""
        while piece:
            *lines, rest = _LINE.split(rest + decoder.decode(piece))
            if len(rest) > PIECE:
                raise inputs.faulty("path", f"has a line of more than {PIECE} characters", HINT)
            yield lines
            piece = opened.read(PIECE)
        yield _LINE.split(rest + decoder.decode(b"", final=True))


def _encoding(beginning: bytes) -> str:
    for mark, encoding in _MARKS:
        if beginning.startswith(mark):
            return encoding
    # Of UTF-16 text every second byte is zero, but of signs that no number has.
    halves = beginning[::2], beginning[1::2]
    for k, encoding in enumerate(("utf-16-be", "utf-16-le")):
        if 2 * halves[k].count(0) > len(halves[k]) and not halves[1 - k].count(0):
            return encoding
    if b"\0" in beginning[:1000]:
        raise inputs.faulty("path", "has NUL bytes and is no text", "export it as text, UTF-8")
    try:
        codecs.getincrementaldecoder("utf-8")().decode(beginning)
    except UnicodeDecodeError:
        return "latin-1"  # a degree sign of an old program
    return "utf-8"


def _read(file: Path, columns: list[Column] | None) -> _Text:
    """Read a file piece by piece; of what it has only the numbers of the columns are kept."""
    facts: dict[str, str] = {}
    header = above = digits = ""
    form: tuple[str | None, bool] | None = None
    heads, names, places, width = list[str](), list[str](), list[int](), 0
    parts: list[NDArray[np.float64]] = []
    count = length = 0
    for lines in _pieces(file):
        rows = list[str]()
        for line in lines:
            stripped = line.strip()
            if not stripped:
                continue
            if form is None:
                if rule := _FACT.fullmatch(stripped):
                    facts[rule[1]] = rule[2]
                    continue
                form = _separator(stripped)
                if form is None:
                    header, above = stripped.lstrip("#%!/ "), header
                    digits = digits or (stripped if re.search(r"\d", stripped) else "")
                    continue
                heads, names = (_cells(each, form[0], comma=False) for each in (header, above))
                width = len(_cells(stripped, *form))
                names = names if len(names) == len(heads) == width else []
                listed = range(width) if columns is None else columns
                places = [_place(heads, names, column, width) for column in listed]
            if stripped[0] not in "#%!":
                rows.append(stripped)
        if form is None:
            length += sum(map(len, lines))
            if length > _core.LONGEST_FILE:
                break
        elif rows:
            part = _numbers(rows, form, places, columns is None, count)
            parts.append(part)
            count += len(part)
            if count * len(places) > inputs.MOST_NUMBERS:
                fault = f"has more than {inputs.MOST_NUMBERS} numbers"
                raise inputs.faulty("path", fault, "choose columns, or split it")
    if form is None:
        hint = "separate them by commas, semicolons, tabs or blanks"
        hint += f"; the first with digits is {inputs.shorten(digits)}" if digits else ""
        raise inputs.faulty("path", "has no line of two numbers alone", hint)
    return _Text(facts, heads, names, width, places, np.concatenate(parts))


def save(cycle: Cycle, path: str | Path) -> None:
    """Write a cycle to a file that reads back as an equal one."""
    file = inputs.file_path(path, ENDINGS, HINT)
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


def _separator(line: str) -> tuple[str | None, bool] | None:
    """Return what separates the cells of a line of numbers and whether decimals have commas."""
    for separator in ("\t", ";", ",", None):
        cells = [cell for cell in _cells(line, separator, comma=False) if cell]
        if len(cells) < 2 or not all(map(_COMMA_NUMBER.fullmatch, cells)):
            continue
        comma = any("," in cell for cell in cells)
        if (
            separator == ","
            and len(cells) == 4
            and all(cell.lstrip("+-").isdigit() for cell in cells)
        ):
            hint = "are decimals written with commas? Separate columns by semicolons or tabs"
            fault = f"has a line of four whole numbers, {inputs.shorten(line)}"
            raise inputs.faulty("path", fault, hint)
        return separator, comma
    return None


def _cells(line: str, separator: str | None, comma: bool) -> list[str]:
    cells = [cell.strip().strip('"').strip() for cell in line.split(separator)]
    return [cell.replace(",", ".") for cell in cells] if comma else cells


def _place(header: list[str], names: list[str], column: object, width: int) -> int:
    if isinstance(column, str):
        for heads in (header, names):
            if column in heads:
                return heads.index(column)
        listed = ", ".join(map(repr, (names or header)[:10])) or "none"
        raise inputs.rejected("columns", column, f"there is none; the file has {listed}")
    place = inputs.whole("columns", column)
    if not 0 <= place < width:
        raise inputs.rejected("columns", place, f"give numbers from 0 to {width - 1}, or names")
    return place


def _numbers(
    rows: list[str], form: tuple[str | None, bool], places: list[int], every: bool, before: int
) -> NDArray[np.float64]:
    """Return the numbers of lines in some columns; of all columns those beyond two may be none."""
    separator, comma = form
    plain = [row.replace(",", ".") for row in rows] if comma else rows
    with contextlib.suppress(ValueError):
        return np.loadtxt(
            plain, delimiter=separator, usecols=places, ndmin=2, comments=None, quotechar='"'
        )
    found = list[list[float]]()
    for row in rows:
        cells = _cells(row, *form)
        if not any(map(_is_number, cells)) or (len(cells) < 2 and not _is_number(cells[0])):
            continue  # a title between blocks
        values = list[float]()
        for k, place in enumerate(places):
            try:
                values.append(float(cells[place].replace("D", "e").replace("d", "e")))
            except (ValueError, IndexError):
                if every and k > 1:
                    values.append(np.nan)
                    continue
                shown = inputs.shorten(" ".join(cells))
                number = before + len(found) + 1
                fault = f"has no number in column {place} of line {number} of the numbers, {shown}"
                raise inputs.faulty("path", fault, "give lines of as many numbers") from None
        found.append(values)
    return np.array(found).reshape(-1, len(places))


def _is_number(cell: str) -> bool:
    return _COMMA_NUMBER.fullmatch(cell) is not None


def _angle_unit(stated: str | None, head: str) -> tuple[str, str]:
    """Return the unit of angles or times, and who says so."""
    if stated is not None:
        return inputs.one_of("angle_unit", stated, ANGLE_UNITS), "given"
    if _RADIANS.search(head):
        return "rad", "header"
    if _TIME.search(head):
        unit = _SECONDS.search(head)
        return (unit[1].lower(), "header") if unit else ("s", "assumed")
    return "deg", "header" if re.search("deg|°", head, re.IGNORECASE) else "assumed"


def _pressure_unit(stated: str | None, head: str) -> tuple[str, str]:
    """Return the unit of pressures, and who says so."""
    if stated is not None:
        return inputs.one_of("pressure_unit", stated, PRESSURE_UNITS), "given"
    found = {match[1].lower() for match in _PRESSURE.finditer(head)}
    if len(found) != 1:
        listed = ", ".join(PRESSURE_UNITS)
        raise inputs.rejected(
            "pressure_unit",
            None,
            "the file does not name one; head its column p [bar] or the like, or give one of "
            f"{listed}",
        )
    (unit,) = found
    return next(each for each in PRESSURE_UNITS if each.lower() == unit), "header"


def _is_gauge(stated: bool | None, head: str) -> tuple[bool, str]:
    """Return whether pressures are above that of the atmosphere, and who says so."""
    if stated is not None:
        return inputs.flag("gauge", stated), "given"
    if bool(_GAUGE.search(head)) == bool(_ABSOLUTE.search(head)):
        raise inputs.rejected(
            "gauge",
            None,
            "the file does not state whether pressure is gauge or absolute; write one of these "
            "words into its header, or give gauge=True, or gauge=False for absolute pressure",
        )
    return bool(_GAUGE.search(head)), "header"
