"""Columns of numbers in text files, spreadsheets and files of arrays, with their line numbers."""

from __future__ import annotations

import codecs
import contextlib
import csv
import re
import zipfile
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, lazy
from crankpin._support.optional import library

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

TEXTS = (".csv", ".tsv", ".txt", ".dat", ".asc")
"""Endings of text files."""
SHEETS = (".xlsx", ".xlsm")
"""Endings of spreadsheets."""
MATLAB = (".mat",)
HDF5 = (".h5", ".hdf5", ".hdf", ".he5")
ARRAYS = (*MATLAB, *HDF5)
"""Endings of files of arrays."""
TABLE_ENDINGS = (*TEXTS, *SHEETS, *ARRAYS)
FILE_HINT = (
    "name a text file, .csv, .tsv, .txt, .dat or .asc, a spreadsheet, .xlsx, or a file of arrays, "
    ".mat or .h5"
)

# At the end of a piece a carriage return may be the first half of a line's end.
_LINE = re.compile(r"\r\n|\r(?!\Z)|\n")
_FACT = re.compile(r"# (name|strokes|degree): ?(.*)")
_NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eEdD][+-]?\d+)?", re.ASCII)
_ABSENT = re.compile(
    r"([+-]?(nan|inf(inity)?)|na|n/a|n\.a\.|null|none|-+|#\S*|\?+|\*+)?", re.IGNORECASE
)
"""Spellings of a missing number."""
_UNIT = re.compile(
    r"\s*[\[(/|,].*|\s+(deg(rees?)?|°|rad|s|ms|[hkm]?pa\w?|m?bar\w?|psi\w?|abs\w*|gauge)(\s.*)?$",
    re.IGNORECASE,
)
"""A unit in brackets, behind a stroke or at the end, and what follows."""

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
"""Byte order marks, and what they stand for."""
PIECE_BYTES = 2**20
"""Bytes that are read and converted at once: Ctrl-C is answered in between."""
SHEET_ROWS = 2000
"""Rows of a spreadsheet that are converted at once."""
FIRST_WORDS = 10
"""Heads that an error lists."""

Column: TypeAlias = int | str


class Columns(NamedTuple):
    """Parts of a file: facts of our own ones, cells of the header, numbers of the columns read."""

    facts: dict[str, str]
    header: list[str]
    names: list[str]
    """Cells of the line above the header, where it has as many; else empty."""
    width: int
    """Number of columns."""
    places: list[int]
    """Places of the columns read, from 0."""
    numbers: NDArray[np.float64]
    """Numbers of the columns at these places: (n_rows, n_places)."""
    lines: NDArray[np.int64]
    """Line of the file that each row is, from 1: (n_rows,)."""

    @property
    def headed(self) -> bool:
        """True if each column has a head of its own."""
        # Names with blanks of columns separated by blanks cannot be distinguished.
        return len(self.header) == self.width

    def heads(self) -> list[str]:
        """Return the head of each column read, with its name where that stands above."""
        heads = [self.header[k] if self.headed else " ".join(self.header) for k in self.places]
        if not self.names:
            return heads
        return [f"{self.names[k]} {head}" for k, head in zip(self.places, heads, strict=True)]

    def where(self, row: int, column: int) -> str:
        """Return the column and line of a number, in words."""
        head = f" ({inputs.shorten(self.heads()[column])})" if self.headed else ""
        return f"column {self.places[column]}{head} of line {self.lines[row]}"

    def of(self, chosen: list[int]) -> Columns:
        """Return some of the columns read, by their index among these."""
        places = [self.places[k] for k in chosen]
        return self._replace(places=places, numbers=self.numbers[:, chosen])


def read(
    file: Path, columns: list[Column] | None, sheet: str | None = None, *, tables: bool = False
) -> Columns:
    """Read a file piece by piece; of what it has only the numbers of the columns are kept.

    With ``tables`` the name of a table in a file of arrays is that of all its columns.
    """
    if file.suffix.lower() not in ARRAYS:
        return _of_lines(file, columns, sheet)
    if sheet is not None:
        raise inputs.rejected("sheet", sheet, "files of arrays have none; leave it out")
    return _of_arrays(file, columns, tables=tables)


def _of_lines(file: Path, columns: list[Column] | None, sheet: str | None) -> Columns:
    """Return the columns of a text file or a spreadsheet."""
    facts: dict[str, str] = {}
    header = above = digits = ""
    rows: _Rows | None = None
    heads, names = list[str](), list[str]()
    parts: list[NDArray[np.float64]] = []
    places: list[NDArray[np.int64]] = []
    line = count = length = 0
    for texts in _pieces(file, sheet):
        raw, at = list[str](), list[int]()
        for text in texts:
            line += 1
            stripped = text.strip()
            if not stripped:
                continue
            if rows is None:
                if rule := _FACT.fullmatch(stripped):
                    facts[rule[1]] = rule[2]
                    continue
                separator = _separator(stripped)
                if separator == "":
                    header, above = stripped.lstrip("#%!/ "), header
                    digits = digits or (stripped if re.search(r"\d", stripped) else "")
                    continue
                indented = text.lstrip(" ").startswith("\t")
                cells = _cells(stripped, separator)
                heads, names = (_cells(line, separator) for line in (header, above))
                _check_commas(stripped, line, separator, cells, heads)
                names = names if len(names) == len(heads) == len(cells) else []
                wanted = range(len(cells)) if columns is None else columns
                chosen = [_place(heads, names, column, len(cells)) for column in wanted]
                rows = _Rows(separator, len(cells), chosen, columns is None, indented)
            if stripped[0] not in "#%!":
                # The first cell of a line may be empty, where tabs separate them.
                raw.append(stripped if rows.indented else text.strip(" \r\n\v\f\ufeff"))
                at.append(line)
        if rows is None:
            length += sum(map(len, texts))
            if length > _core.LONGEST_FILE:
                break
        elif raw:
            part, parsed = rows.numbers(raw, at)
            parts.append(part)
            places.append(np.array(parsed, dtype=np.int64))
            count += len(part)
            if count * len(rows.places) > inputs.MOST_NUMBERS:
                fault = f"has more than {inputs.MOST_NUMBERS} numbers"
                raise inputs.faulty("path", fault, "choose columns, or split it")
    if rows is None:
        hint = "separate them by commas, semicolons, tabs or blanks"
        hint += f"; the first with digits is {inputs.shorten(digits)}" if digits else ""
        raise inputs.faulty("path", "has no line of two numbers alone", hint)
    numbers, lines = np.concatenate(parts), np.concatenate(places)
    return Columns(facts, heads, names, rows.width, rows.places, numbers, lines)


def _of_arrays(file: Path, columns: list[Column] | None, *, tables: bool) -> Columns:
    """Return variables of a file of arrays as columns, each sample as a line."""
    array_files = lazy.imported("crankpin.model.array_files")
    variables, heads, arrays = array_files.read(file)
    places = list[int]()
    for column in range(len(heads)) if columns is None else columns:
        whole = [k for k, variable in enumerate(variables) if variable == column]
        places += whole if tables and whole else [_place(heads, [], column, len(heads))]
    array_files.same_length([heads[k] for k in places], [arrays[k] for k in places])
    if len(places) * len(arrays[places[0]]) > inputs.MOST_NUMBERS:
        fault = f"has more than {inputs.MOST_NUMBERS} numbers"
        raise inputs.faulty("path", fault, "choose columns, or split it")
    numbers = np.stack([arrays[k] for k in places], axis=1)
    lines = np.arange(1, len(numbers) + 1)
    read = Columns({}, heads, [], len(heads), places, numbers, lines)
    needed = numbers[:, :2] if columns is None else numbers
    if (wrong := ~np.isfinite(needed)).any():
        row, column = (int(k) for k in np.argwhere(wrong)[0])
        fault = f"has {needed[row, column]} in {read.where(row, column)}"
        raise inputs.faulty("path", fault, "give finite numbers, or leave the samples out")
    return read


# --- lines ----------------------------------------------------------------------------------------


def _pieces(file: Path, sheet: str | None) -> Iterator[list[str]]:
    """Yield the lines of a file, some at a time."""
    if file.suffix.lower() in SHEETS:
        yield from _sheet(file, sheet)
        return
    if sheet is not None:
        raise inputs.rejected("sheet", sheet, "text files have none; leave it out")
    with file.open("rb") as opened:
        piece = opened.read(PIECE_BYTES)
        decoder, rest = codecs.getincrementaldecoder(_encoding(piece))("replace"), ""
        while piece:
            *lines, rest = _LINE.split(rest + decoder.decode(piece))
            if len(rest) > PIECE_BYTES:
                raise inputs.faulty(
                    "path", f"has a line of more than {PIECE_BYTES} characters", FILE_HINT
                )
            yield lines
            piece = opened.read(PIECE_BYTES)
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


def _sheet(file: Path, name: str | None) -> Iterator[list[str]]:
    """Yield the rows of a spreadsheet as lines of cells with tabs between them."""
    openpyxl = library("openpyxl")
    broken = (
        zipfile.BadZipFile,
        KeyError,
        ValueError,
        openpyxl.utils.exceptions.InvalidFileException,
    )
    with file.open("rb") as opened:
        try:
            book = openpyxl.load_workbook(opened, read_only=True, data_only=True)
        except (*broken, TypeError, AttributeError, SyntaxError) as error:
            fault = f"cannot be read as a spreadsheet ({inputs.reason(error)})"
            raise inputs.faulty("path", fault, "save it as .xlsx again, or as .csv") from None
        titles = [sheet.title for sheet in book.worksheets]
        if not titles:
            raise inputs.faulty("path", "has no sheet of cells", "save it as .csv")
        chosen = titles[0] if name is None else inputs.one_of("sheet", name, titles)
        lines = list[str]()
        try:
            for row in book[chosen].iter_rows(values_only=True):
                lines.append("\t".join(map(_written, row)).rstrip("\t"))
                if len(lines) == SHEET_ROWS:
                    yield lines
                    lines = []
        except (*broken, zipfile.error, EOFError, SyntaxError) as error:
            if isinstance(error, _core.InputError):
                raise
            fault = f"is broken behind row {len(lines)} of a piece ({inputs.reason(error)})"
            raise inputs.faulty("path", fault, "save it as .xlsx again, or as .csv") from None
        yield lines


def _written(cell: Any) -> str:  # noqa: ANN401 - whatever a cell has
    """Return a cell as text in one line."""
    if cell is None:
        return ""
    return repr(float(cell)) if type(cell) in (int, float) else " ".join(str(cell).split())


# --- cells ----------------------------------------------------------------------------------------


class _Rows:
    """Lines of cells: what separates them, which are read, and the decimal mark so far."""

    def __init__(
        self, separator: str | None, width: int, places: list[int], every: bool, indented: bool
    ) -> None:
        self.separator, self.width, self.places = separator, width, places
        self.every, self.indented = every, indented
        self.mark = ""

    def numbers(self, rows: list[str], lines: list[int]) -> tuple[NDArray[np.float64], list[int]]:
        """Return the numbers of lines, and the lines that have them; titles have none."""
        if self._are_plain(rows):
            comma = self.mark == ","
            with contextlib.suppress(ValueError):
                parsed = np.loadtxt(
                    [row.replace(",", ".") for row in rows] if comma else rows,
                    delimiter=self.separator, usecols=self.places, ndmin=2, comments=None,
                    quotechar='"',
                )  # fmt: skip
                needed = parsed[:, :2] if self.every else parsed
                if len(parsed) == len(rows) and np.isfinite(needed).all():
                    return parsed, lines
        read = [self._row(row, line) for row, line in zip(rows, lines, strict=True)]
        places = [k for k, row in enumerate(read) if row is not None]
        numbers = np.array([read[k] for k in places], dtype=np.float64)
        return numbers.reshape(-1, len(self.places)), [lines[k] for k in places]

    def _are_plain(self, rows: list[str]) -> bool:
        """Return whether lines have no cell too many and one decimal mark, which is noted."""
        if self.separator is None:
            if any(len(row.split()) > self.width for row in rows):
                return False
        elif any(row.rstrip(self.separator).count(self.separator) >= self.width for row in rows):
            return False
        marks = {mark for mark in ".," if any(mark in row for row in rows)}
        marks -= {self.separator or ""}
        if len(marks | {self.mark} - {""}) > 1:
            return False
        self.mark = self.mark or "".join(marks)
        return True

    def _row(self, row: str, line: int) -> list[float] | None:
        """Return the numbers of a line; none of a title between blocks."""
        cells = _cells(row, self.separator)
        if not any(map(_NUMBER.fullmatch, cells)):
            if len(cells) < 2 or not all(map(_ABSENT.fullmatch, cells)):
                return None
        elif len(cells) > self.width:
            fault = f"has {len(cells)} cells in line {line}, {inputs.shorten(row)}"
            raise inputs.faulty("path", fault, f"the first line of numbers has {self.width}")
        return [self._number(cells, k, line) for k in range(len(self.places))]

    def _number(self, cells: list[str], k: int, line: int) -> float:
        """Return the number in a cell; of all columns those beyond two may have none."""
        place = self.places[k]
        cell = cells[place] if place < len(cells) else ""
        at = f"column {place} of line {line}, {inputs.shorten(' '.join(cells))}"
        if _NUMBER.fullmatch(cell):
            if mark := next((sign for sign in ".," if sign in cell), ""):
                if self.mark not in ("", mark):
                    fault = f"has decimal points and commas: {inputs.shorten(cell)} in {at}"
                    raise inputs.faulty("path", fault, "write one of them in all lines")
                self.mark = mark
            value = float(cell.replace(",", ".").replace("D", "e").replace("d", "e"))
            if np.isfinite(value):
                return value
        if self.every and k > 1:
            return np.nan
        fault = f"has no number in {at}"
        raise inputs.faulty("path", fault, "give a number in each line, or leave the line out")


def _separator(line: str) -> str | None:
    """Return what separates the cells of a line of numbers, None for blanks; ``""`` of others."""
    for separator in ("\t", ";", ",", None):
        cells = [cell for cell in _cells(line, separator) if cell]
        if len(cells) > 1 and all(map(_NUMBER.fullmatch, cells)):
            return separator
    return ""


def _check_commas(
    line: str, number: int, separator: str | None, cells: list[str], heads: list[str]
) -> None:
    """Reject whole numbers between commas that may be numbers with decimal commas."""
    count = len(cells)
    if separator != "," or not all(cell.lstrip("+-").isdigit() for cell in cells):
        return
    if count == 4 or (count > 2 and len(heads) != count):
        hint = "are decimals written with commas? Separate columns by semicolons or tabs"
        fault = f"has a line of {'four' if count == 4 else count} whole numbers, "
        raise inputs.faulty("path", f"{fault}{inputs.shorten(line)}, line {number}", hint)


def _cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, without quotes and empty ones at its end."""
    cells = line.split(separator)
    if '"' in line and separator is not None:
        with contextlib.suppress(csv.Error):
            cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True))
    cells = [cell.strip().strip('"').strip() for cell in cells]
    while len(cells) > 1 and not cells[-1]:
        cells.pop()
    return cells


def _place(header: list[str], names: list[str], column: object, width: int) -> int:
    """Return the place of a column: a number, its head, or its head without the unit."""
    if not isinstance(column, str):
        place = inputs.whole("columns", column)
        if not 0 <= place < width:
            raise inputs.rejected("columns", place, f"give numbers from 0 to {width - 1}, or names")
        return place
    for plain in (str, _bare):
        for heads in (header, names):
            places = [k for k, head in enumerate(heads) if plain(head) == plain(column)]
            if len(places) == 1 or (places and plain is str):
                return places[0]
            if places:
                choices = ", ".join(repr(heads[k]) for k in places[:FIRST_WORDS])
                raise inputs.rejected("columns", column, f"there are {choices}; give one in full")
    choices = ", ".join(map(repr, (names or header)[:FIRST_WORDS])) or "none"
    raise inputs.rejected("columns", column, f"there is none; the file has {choices}")


def _bare(head: str) -> str:
    """Return a head in small letters without its unit."""
    return " ".join(_UNIT.sub("", head.strip()).casefold().split()) or head
