"""Tables: columns with units, as text, HTML, CSV, LaTeX, DataFrame or Dataset."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.messages import without_controls
from crankpin._support.record import AbsentItemError, Record, changed, read_only

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

Label: TypeAlias = "str | Sequence[object]"
"""Text before a row's numbers, or several texts and numbers, a column each."""

COUNTED = (
    "order", "cylinder", "n_shafts", "n_cylinders", "rpm", "bank_angle_deg", "rod_ratio",
    "pin_offset", "load", "theta_deg", "phase_deg", "after/before", "at most",
)  # fmt: skip
"""Columns without unit in tables whose rows have units."""
OF_ROWS = (*COUNTED, "set", "piston", "plane", "design", "speed", "z")
"""Columns whose numbers are names of rows."""
BYTES = 64
"""Memory of a number or a short text as an object of Python."""
IN_PARTS = "read the arrays, select some of the rows, or write CSV to a file"
"""Hint for tables too long for text."""
TINY = "~0"
"""Text of a number that is not zero, but negligible."""


class Column(Record):
    """Column of a table: its name, its values, their unit."""

    name: str
    """Head of the column."""
    data: tuple[Any, ...] | NDArray[Any]
    """Numbers, texts, or both; of a long column an array, of any shape, read row by row."""
    unit: str = ""
    """Unit, as read by people; empty for texts, counts and ratios."""
    digits: int = 5
    """Significant digits of numbers in text; integers are shown whole."""
    decimals: int | None = None
    """Digits after the decimal point instead, so that the points of a column are aligned."""
    least: float = 0.0
    """Magnitude below which numbers that are not zero are shown as :data:`TINY`."""

    def __post_init__(self) -> None:
        whole = isinstance(self.data, np.ndarray)
        data = read_only(np.ravel(self.data)) if whole else tuple(self.data)
        object.__setattr__(self, "data", data)

    @property
    def values(self) -> tuple[Any, ...]:
        """Numbers, texts, or both, as objects of Python."""
        inputs.fitting("table", BYTES * len(self), IN_PARTS)
        return tuple(self._listed())

    def _listed(self, rows: slice = slice(None)) -> Sequence[Any]:
        """Return the values of some rows as objects."""
        part = self.data[rows]
        return part.tolist() if isinstance(part, np.ndarray) else part

    def __len__(self) -> int:
        return len(self.data)

    @property
    def header(self) -> str:
        """Name and unit."""
        return f"{self.name} {self.unit}".strip()

    def cells(self, rows: int | None = None) -> list[str]:
        """Return the first values, or all, as text, numbers rounded and exact zeros as 0."""
        values = self._listed(slice(rows))
        return [
            _cell(value) if isinstance(value, str) else self._rounded(value) for value in values
        ]

    def _rounded(self, value: float | None) -> str:
        if value is None or value != value:  # noqa: PLR0124 - NaN, of any size of number
            return "–"
        if isinstance(value, bool):
            return str(value)
        if not value or isinstance(value, (int, np.integer)):
            return str(value) if value else "0"
        if abs(value) < self.least:
            return TINY
        if self.decimals is None:
            return f"{value:.{self.digits}g}"
        return f"{round(value, self.decimals) + 0.0:.{self.decimals}f}"  # no minus before zero

    def _in(self, setting: units.Setting) -> Column:
        """Return the column in the units of a setting."""
        converted = units.convert(self.unit, setting)
        if not isinstance(self.data, np.ndarray) and units.Text in {*map(type, self.data)}:
            texts = ((isinstance(cell, str), cell) for cell in self.data)
            cells = (units.shown(cell, setting) if is_text else cell for is_text, cell in texts)
            return changed(self, data=tuple(cells))
        if converted.unit == self.unit:
            return self
        values = _times(self.data, converted.factor)
        decimals = self.decimals
        if decimals is not None:
            decimals = max(0, decimals - round(math.log10(converted.factor)))
        return changed(
            self,
            data=values,
            unit=converted.unit,
            decimals=decimals,
            least=self.least * converted.factor,
        )

    def _array(self) -> NDArray[Any]:
        """Return the values as an array, NaN where a number is missing."""
        if isinstance(self.data, np.ndarray) and self.data.dtype.kind != "O":
            return self.data
        return np.array([math.nan if cell is None else cell for cell in self.data])

    @property
    def is_text(self) -> bool:
        """True if all values are texts: they are aligned at their left."""
        if isinstance(self.data, np.ndarray):
            return self.data.dtype.kind == "O"
        return all(isinstance(cell, str) for cell in self.data)


class Table(Tabled):
    """Columns under a title: text, HTML, CSV, LaTeX, DataFrame and Dataset follow from them."""

    title: str
    """Line above the table, or several."""
    columns: tuple[Column, ...]
    """Columns, all of one length."""
    note: str = ""
    """Line under the table in text and HTML."""
    loads: str = ""
    """Loads that its numbers count, where more could: the last line under the table."""
    row_units: tuple[str, ...] = ()
    """Unit of the numbers of each row in columns without unit; empty for none."""
    whole: int = 0
    """Number of the rows of which these are the first; 0 for all."""

    @classmethod
    def _of_figures(
        cls, title: str, figures: Iterable[tuple[str, float | None, str]], loads: str = ""
    ) -> Table:
        """Return a table of figures, (name, value, unit), without those that are None."""
        numbered = [figure for figure in figures if figure[1] is not None]
        names, values, row_units = zip(*numbered, strict=True)
        columns = (
            Column("figure", names),
            Column("value", values, digits=6),
            Column("unit", row_units),
        )
        return cls(title, columns, loads=loads, row_units=row_units)

    @classmethod
    def from_rows(
        cls,
        title: str,
        header: Sequence[str | tuple[str, str]],
        labels: Sequence[Label],
        rows: NDArray[np.float64] | None = None,
        decimals: int | None = None,
        note: str = "",
        loads: str = "",
        row_units: Sequence[str] = (),
    ) -> Table:
        """Return a table of rows: labels before numbers; heads are names or (name, unit).

        Parameters
        ----------
        title : str
            Title of the table.
        header : sequence of str or pair of str
            Heads of the columns: names, or pairs (name, unit).
        labels : sequence of str or sequence of str
            Label of each row, or several, before its numbers.
        rows : ndarray of float, shape (n_rows, n_columns), optional
            Numbers; by default the labels are the whole rows, numbers among them.
        decimals : int, optional
            Digits after the decimal point; by default five significant digits.
        note : str, optional
            Text below the table.
        loads : str, optional
            Loads that count, in words.
        row_units : sequence of str, optional
            Unit of the numbers of each row, in columns without unit.

        Returns
        -------
        Table
            The table.
        """
        rows_of_labels = [[label] if isinstance(label, str) else list(label) for label in labels]
        heads = [(head, "") if isinstance(head, str) else head for head in header]
        numbers = [] if rows is None else list(rows.T)
        before, digits = len(heads) - len(numbers), 5 if rows is None else 10
        texts = zip(*rows_of_labels, strict=True) if rows_of_labels else [()] * before
        columns = [
            Column(name, tuple(values), unit, digits)
            for (name, unit), values in zip(heads, texts, strict=False)
        ]
        columns += [
            Column(name, values, unit, decimals=decimals)
            for (name, unit), values in zip(heads[before:], numbers, strict=True)
        ]
        return cls(title, tuple(columns), note, loads, tuple(row_units))

    def to(self, units_shown: str) -> Table:
        """Return the table in other units, which ``cp.units`` lists.

        Parameters
        ----------
        units_shown : str
            Units separated by commas, such as ``"g, mm, lbf"`` or ``"oz·in"``.

        Returns
        -------
        Table
            The table, its numbers in these units; kinds that are not named stay as they are.

        Raises
        ------
        InputError
            If there is no such unit.

        Examples
        --------
        >>> import crankpin as cp
        >>> weights = cp.counterweights(cp.Engine.preset("single"), planes=[0])
        >>> weights.table.to("oz*in, in")["amount"].cells()
        ['13.436']
        """
        return self._in(units.read(units_shown, "units_shown"))

    def _in(self, setting: units.Setting) -> Table:
        """Return the table in the units of a setting."""
        if not setting:
            return self
        columns = tuple(column._in(setting) for column in self.columns)
        distinct = {unit: units.convert(unit, setting) for unit in {*self.row_units}}
        converted = [distinct[unit] for unit in self.row_units]
        if converted:
            columns = tuple(self._by_row(column, converted) for column in columns)
        return changed(
            self, title=units.shown(self.title, setting), columns=columns,
            note=units.shown(self.note, setting), row_units=tuple(unit.unit for unit in converted),
        )  # fmt: skip

    def _by_row(self, column: Column, converted: Sequence[units.Converted]) -> Column:
        """Return a column without unit, its numbers and units those of each row."""
        if column.unit or column.name in COUNTED:
            return column
        if isinstance(column.data, np.ndarray) and not column.is_text:
            factors = np.fromiter((new.factor for new in converted), float, len(converted))
            return changed(column, data=_times(column.data, factors))
        values = []
        for value, unit, new in zip(column.data, self.row_units, converted, strict=True):
            cell = value
            if not isinstance(value, str):
                cell = _times(value, new.factor)
            elif column.name == "unit" and value == unit:
                cell = new.unit
            values.append(cell)
        return changed(column, data=tuple(values))

    @property
    def table(self) -> Table:
        """The table: it is its own only frame."""
        return self

    @property
    def header(self) -> list[str]:
        """Names and units of the columns."""
        return [column.header for column in self.columns]

    def __len__(self) -> int:
        return len(self.columns[0]) if self.columns else 0

    def __getitem__(self, name: str) -> Column:
        """Return the column of a name, or raise an InputError."""
        for column in self.columns:
            if isinstance(name, str) and column.name == name:
                return column
        names = [column.name for column in self.columns]
        hint = f"the columns are {', '.join(map(repr, names))}{inputs.nearest(name, names)}"
        raise inputs.rejected("column", name, hint, AbsentItemError)

    def __iter__(self) -> Iterator[str]:
        """Return an iterator over the names of the columns."""
        return (column.name for column in self.columns)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and any(column.name == name for column in self.columns)

    def cells(self, rows: int | None = None) -> list[list[str]]:
        """Return the first rows, or all, as text, numbers rounded and exact zeros as 0.

        Parameters
        ----------
        rows : int, optional
            Number of rows; by default all.

        Returns
        -------
        list of list of str
            A list for each row.

        Raises
        ------
        InputError
            If the text would take more memory than any result may.
        """
        self._check_text(rows)
        return [
            list(row) for row in zip(*(column.cells(rows) for column in self.columns), strict=True)
        ]

    def _check_text(self, rows: int | None = None) -> None:
        """Raise an InputError if the first rows, or all, take too much memory as text."""
        if rows is not None:
            inputs.whole("rows", rows, 0)
        count = len(self) if rows is None else min(rows, len(self))
        inputs.fitting("table", BYTES * count * len(self.columns), IN_PARTS)

    def text(self, rows: int | None = None) -> str:
        """Return the first rows, or all, as aligned text, columns of words to the left.

        Parameters
        ----------
        rows : int, optional
            Number of rows; by default all.

        Returns
        -------
        str
            The lines, joined.
        """
        self = self._cut(rows)._in(units.current())  # noqa: PLW0642
        lines = [[*map(_cell, self.header)], *self.cells()]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        leftwards = [column.is_text and len(self) > 0 for column in self.columns]
        body = (
            "  ".join(
                cell.ljust(width) if left else cell.rjust(width)
                for cell, width, left in zip(line, widths, leftwards, strict=True)
            ).rstrip()
            for line in lines
        )
        title, notes = without_controls(self.title), self._notes()
        return "\n".join(filter(None, [title, *body, *notes]))

    def html(self, rows: int | None = None) -> str:
        """Return the first rows, or all, as HTML for notebooks.

        Parameters
        ----------
        rows : int, optional
            Number of rows; by default all.

        Returns
        -------
        str
            HTML.
        """
        self = self._cut(rows)._in(units.current())  # noqa: PLW0642
        head = "".join(f"<th>{html.escape(_cell(name))}</th>" for name in self.header)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self.cells()
        )
        title = "; ".join(without_controls(self.title).split("\n"))
        caption = f"<caption>{html.escape(title)}</caption>"
        notes = "".join(f"<p>{html.escape(note)}</p>" for note in self._notes())
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{notes}"

    def _cut(self, rows: int | None) -> Table:
        """Return the first rows."""
        if rows is None or inputs.whole("rows", rows, 0) >= len(self):
            return self
        columns = tuple(changed(column, data=column.data[:rows]) for column in self.columns)
        whole = self.whole or len(self)
        return changed(self, columns=columns, row_units=self.row_units[:rows], whole=whole)

    def _notes(self) -> Iterable[str]:
        """Yield the lines under the table."""
        if self.whole > len(self):
            yield f"{len(self)} of {self.whole} rows"
        if self.note:
            yield without_controls(self.note)
        if any(column.least and TINY in column.cells() for column in self.columns):
            yield f"{TINY}: not zero, but too small to matter."
        if self.loads:
            yield labels.in_words(self.loads)

    def _long(self, names: Sequence[str]) -> Table:
        """Return the numbers of some columns, or all, below each other, with the other columns."""
        numbers = self._numbers()
        for name in names:
            inputs.one_of("columns", name, numbers, AbsentItemError)
        chosen = {name: numbers[name] for name in names} or numbers
        beside = [column for head, column in self._distinct(units=False) if head not in numbers]
        count = len(self)

        def repeated(column: Column) -> Column:
            return changed(column, data=tuple(column._listed()) * len(chosen))

        units_of = [column.unit for column in chosen.values() for _ in range(count)]
        if self.row_units:
            units_of = [
                unit or of_row
                for unit, of_row in zip(units_of, self.row_units * len(chosen), strict=True)
            ]
        values = tuple(value for column in chosen.values() for value in column._listed())
        quantities = tuple(name for name in chosen for _ in range(count))
        columns = (
            *map(repeated, beside),
            Column("component" if "quantity" in self else "quantity", quantities),
            Column("value", values, digits=10),
            Column("unit", tuple(units_of)),
        )
        return Table("Long form", columns, loads=self.loads, row_units=tuple(units_of))

    def _numbers(self) -> dict[str, Column]:
        """Return the columns of numbers by name, without those that name rows."""
        return {
            head: column
            for head, column in self._distinct(units=False)
            if not column.is_text and column.name not in OF_ROWS
        }

    def _distinct(self, *, units: bool = True) -> Iterable[tuple[str, Column]]:
        """Yield the columns with heads that are distinct."""
        seen: set[str] = set()
        for place, column in enumerate(self.columns):
            head = column.header if units else column.name
            head = f"{head} {place}".strip() if head in seen else head
            seen.add(head)
            yield head, column


class Item(Tabled):
    """Base class of the items of results: their table has a row for each figure of a field."""

    def __repr__(self) -> str:
        """Return a line, as there may be many in a list."""
        return Record.__repr__(self)

    def _figures(self) -> Mapping[str, object]:
        """Return name → value, or several."""
        return {field.name: getattr(self, field.name) for field in self._fields if field.repr}

    @property
    def table(self) -> Table:
        """Fields and their values, a row each; of several values they are numbered from 1."""
        rows = []
        for name, value in self._figures().items():
            several = isinstance(value, tuple)
            values = value if isinstance(value, tuple) else (value,)
            for k, one in enumerate(values, start=1):
                plain = one is None or isinstance(one, (bool, int, float, str))
                rows.append((f"{name} {k}" if several else name, one if plain else str(one)))
        return Table.from_rows(type(self).__name__, ["field", "value"], rows)


def _times(value: Any, factor: float | NDArray[np.float64]) -> Any:  # noqa: ANN401 - a cell, or several
    """Return a number times a factor; other values unchanged."""
    if isinstance(value, tuple):
        return tuple(_times(inner, factor) for inner in value)
    if isinstance(value, np.ndarray):
        return value * factor if value.dtype.kind in "iuf" else value
    if value is None or isinstance(value, (str, bool)):
        return value
    return value * factor


def _cell(text: str) -> str:
    """Return a text as a cell of one line."""
    return without_controls(text).translate({10: " ", 9: " "})


def common_decimals(values: ArrayLike) -> int | None:
    """Return how many decimals show the largest number to six digits, None outside 0.01 to 1e9.

    Columns of one quantity read best with their points aligned.
    """
    largest = float(np.abs(values).max(initial=0.0))
    if not 0.01 <= largest < 1e9:
        return None
    return max(0, 5 - math.floor(math.log10(largest)))
