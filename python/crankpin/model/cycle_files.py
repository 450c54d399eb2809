"""Tables of cylinder pressure over crank angle in text files."""

from __future__ import annotations

import contextlib
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import files, inputs
from crankpin._support.warnings import warn

if TYPE_CHECKING:
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
ANGLE_UNITS = {"deg": 1.0, "rad": 180.0 / np.pi}
"""Unit → degrees."""

_PRESSURE = re.compile(r"(?<![a-z])([hkm]?pa|m?bar|psi)(?=[agd]?(?![a-z]))", re.IGNORECASE)
_GAUGE = re.compile(r"gauge|gage|relative|bar_?g\b|psi_?g\b|pa_?g\b|\(g\)", re.IGNORECASE)
_ABSOLUTE = re.compile(r"abs|bar_?a\b|psi_?a\b|pa_?a\b|\(a\)", re.IGNORECASE)
_RADIANS = re.compile(r"(?<![a-z])rad(ians?)?(?![a-z])", re.IGNORECASE)
_FACT = re.compile(r"# (name|strokes|degree): ?(.*)")
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?"
_COMMA_NUMBER = re.compile(_NUMBER.replace(r"\.", "[.,]"))

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
"""Byte order marks, and what they stand for."""
SIMILAR = 0.9
"""Correlation of two columns from which both are pressure: cycles of one cylinder have 0.99."""

Column: TypeAlias = int | str


class _Text(NamedTuple):
    """Parts of a file: facts of our own ones, cells of the header and of the lines of numbers."""

    facts: dict[str, str]
    header: list[str]
    names: list[str]
    """Cells of the line above the header, where it has as many; else empty."""
    rows: list[list[str]]


def load(
    path: str | Path,
    *,
    pressure_unit: str | None,
    angle_unit: str | None,
    gauge: bool | None,
    atmosphere: float,
    tdc_deg: float,
    columns: tuple[Column, Column] | None,
    strokes: int | None,
    name: str | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], int, str, int | None]:
    """Return the fields of the cycle in a file: see :meth:`Cycle.load`."""
    file = inputs.file_path(path, ENDINGS, HINT)
    with file.open("rb") as opened:
        found = opened.read(_core.LONGEST_FILE + 1)
    if len(found) > _core.LONGEST_FILE:
        raise inputs.rejected("path", str(path), f"more than {_core.LONGEST_FILE} bytes")
    split = _split(_decoded(found))
    listed = inputs.items("columns", (0, 1) if columns is None else columns, "give two")
    place = [_place(split, column) for column in listed]
    if len(place) != 2:
        raise inputs.rejected("columns", columns, "give two, of angle and pressure")
    angles, pressures = (_numbers(split.rows, k) for k in place)
    if columns is None:
        _warn_of_others(split.rows, pressures)
    # Names with blanks of columns separated by blanks cannot be distinguished.
    apart = len(split.header) == len(split.rows[0])
    heads = [split.header[k] if apart else " ".join(split.header) for k in place]
    if split.names:
        heads = [f"{split.names[k]} {head}" for k, head in zip(place, heads, strict=True)]
    radians = bool(_RADIANS.search(heads[0]))
    unit = angle_unit or ("rad" if radians else "deg")
    angles *= ANGLE_UNITS[inputs.one_of("angle_unit", unit, ANGLE_UNITS)]
    angles -= inputs.finite("tdc_deg", tdc_deg)
    pressures *= PRESSURE_UNITS[_pressure_unit(pressure_unit, heads[1])]
    if _is_gauge(gauge, heads[1]):
        pressures += inputs.finite("atmosphere", atmosphere)
    return (
        angles,
        pressures,
        _strokes(split.facts) if strokes is None else strokes,
        _name(split.facts.get("name", file.stem)) if name is None else name,
        _fact(split.facts, "degree"),
    )


def _strokes(facts: dict[str, str]) -> int:
    known = _fact(facts, "strokes")
    return 4 if known is None else known


def _decoded(found: bytes) -> str:
    for mark, encoding in _MARKS:
        if found.startswith(mark):
            return found.decode(encoding, "replace")
    if b"\0" in found[:1000]:
        raise inputs.faulty("path", "has NUL bytes and is no text", "export it as text, UTF-8")
    try:
        return found.decode()
    except UnicodeDecodeError:
        return found.decode("latin-1")  # a degree sign of an old program


def _warn_of_others(rows: list[list[str]], pressures: NDArray[np.float64]) -> None:
    """Warn of further columns that are pressure too: of several cycles one is read."""
    others = []
    for k in range(2, min(map(len, rows))):
        try:
            values = _numbers(rows, k)
        except InputError:
            continue
        spread = float(np.std(values)) * float(np.std(pressures))
        covariance = float(np.mean((values - values.mean()) * (pressures - pressures.mean())))
        if covariance > SIMILAR * spread > 0.0:
            others.append(k)
    if others:
        warn(
            f"columns = None: column 1 is read, and {len(others)} more look like further cycles: "
            f"choose one, such as columns=(0, {others[0]}), or give their mean"
        )


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


def _split(text: str) -> _Text:
    facts: dict[str, str] = {}
    header = above = ""
    rows: list[list[str]] = []
    pattern: tuple[str | None, bool] | None = None
    for line in re.split(r"\r\n|\r|\n", text):
        stripped = line.strip()
        if rule := _FACT.fullmatch(stripped):
            facts[rule[1]] = rule[2]
            continue
        if pattern is None:
            pattern = _separator(stripped)
            if pattern is None:
                if stripped:
                    header, above = stripped.lstrip("#%!/ "), header
                continue
        if not stripped or stripped[0] in "#%!":
            continue
        rows.append(_cells(stripped, *pattern))
    if pattern is None:
        shown = next((line for line in text.splitlines() if re.search(r"\d", line)), "")
        hint = "separate them by commas, semicolons, tabs or blanks"
        hint += f"; the first with digits is {inputs.shorten(shown)}" if shown else ""
        raise inputs.faulty("path", "has no line of two numbers alone", hint)
    heads, names = (_cells(line, pattern[0], comma=False) for line in (header, above))
    return _Text(facts, heads, names if len(names) == len(heads) == len(rows[0]) else [], rows)


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


def _place(split: _Text, column: object) -> int:
    if isinstance(column, str):
        for heads in (split.header, split.names):
            if column in heads:
                return heads.index(column)
        listed = ", ".join(map(repr, (split.names or split.header)[:10])) or "none"
        raise inputs.rejected("columns", column, f"there is none; the file has {listed}")
    place = inputs.whole("columns", column)
    if not 0 <= place < 1000:
        raise inputs.rejected("columns", place, "give numbers from 0, or names")
    return place


def _numbers(rows: list[list[str]], place: int) -> NDArray[np.float64]:
    values = np.empty(len(rows))
    for k, row in enumerate(rows):
        try:
            values[k] = float(row[place].replace("D", "e").replace("d", "e"))
        except (ValueError, IndexError):
            shown = inputs.shorten(" ".join(row))
            fault = f"has no number in column {place} of line {k + 1} of the numbers, {shown}"
            raise inputs.faulty("path", fault, "give lines of as many numbers") from None
    return values


def _pressure_unit(given: str | None, head: str) -> str:
    if given is not None:
        return inputs.one_of("pressure_unit", given, PRESSURE_UNITS)
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
    return next(each for each in PRESSURE_UNITS if each.lower() == unit)


def _is_gauge(given: bool | None, head: str) -> bool:
    if given is not None:
        return inputs.flag("gauge", given)
    if bool(_GAUGE.search(head)) == bool(_ABSOLUTE.search(head)):
        raise inputs.rejected(
            "gauge",
            None,
            "the file does not state whether pressure is gauge or absolute; write one of these "
            "words into its header, or give gauge=True, or gauge=False for absolute pressure",
        )
    return bool(_GAUGE.search(head))
