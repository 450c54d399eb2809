"""Tables: columns with units, as text, HTML, CSV, DataFrame or Dataset."""

from __future__ import annotations

import csv
import html
import io
import math
import re
from typing import TYPE_CHECKING, Any, TypeAlias, overload

import numpy as np

from crankpin._support import files, inputs, labels, optional
from crankpin._support.record import AbsentItemError, Record, changed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    import pandas as pd
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

Label: TypeAlias = "str | Sequence[str | float]"
"""Text before a row's numbers, or several texts and numbers, a column each."""

SHOWN = 30
"""Rows of a long table in text: a screen."""
SHOWN_IN_NOTEBOOKS = 60
"""Rows of a long table in a notebook."""
FORMULA = re.compile(r"\s*[=+\-@＝＋－＠]|[\t\n]")
"""Beginning of a text that a spreadsheet takes for a formula."""
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.ASCII | re.IGNORECASE)
TINY = "~0"
"""What stands for a number that is not zero, but too small to matter."""


class Column(Record):
    """Column of a table: its name, its values, their unit."""

    name: str
    """Head of the column."""
    values: tuple[Any, ...]
    """Numbers, texts, or both."""
    unit: str = ""
    """Unit, as read by people; empty for texts, counts and ratios."""
    digits: int = 5
    """Significant digits of numbers in text; integers are shown whole."""
    decimals: int | None = None
    """Digits after the decimal point instead, so that the points of a column are aligned."""
    least: float = 0.0
    """Magnitude below which numbers that are not zero are shown as :data:`TINY`."""

    @property
    def header(self) -> str:
        """Name and unit."""
        return f"{self.name} {self.unit}".strip()

    def cells(self) -> list[str]:
        """Return the values as text, numbers rounded and exact zeros as 0."""
        return [
            _cell(each) if isinstance(each, str) else self._rounded(each) for each in self.values
        ]

    def _rounded(self, value: float | None) -> str:
        if value is None:
            return "–"
        if not value or isinstance(value, (int, np.integer)):
            return str(value) if value else "0"
        if abs(value) < self.least:
            return TINY
        return f"{value:.{self.digits}g}" if self.decimals is None else f"{value:.{self.decimals}f}"

    @property
    def is_text(self) -> bool:
        """True if all values are texts: they are aligned at their left."""
        return all(isinstance(each, str) for each in self.values)


class Table(Record):
    """Columns under a title: text, HTML, CSV, DataFrame and Dataset follow from them."""

    title: str
    """Line above the table."""
    columns: tuple[Column, ...]
    """Columns, all of one length."""
    note: str = ""
    """Line under the table in text and HTML."""
    below: Table | None = None
    """A further table of the same result, shown below this one."""
    loads: str = ""
    """Loads that its numbers count, where more could: the last line under the table."""

    @classmethod
    def from_rows(
        cls,
        title: str,
        header: Sequence[str | tuple[str, str]],
        labels: Sequence[Label],
        rows: NDArray[np.float64],
        decimals: int | None = None,
        note: str = "",
        below: Table | None = None,
        loads: str = "",
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
        rows : ndarray of float, shape (n_rows, n_columns)
            Numbers.
        decimals : int, optional
            Digits after the decimal point; by default five significant digits.
        note : str, optional
            Text below the table.
        below : Table, optional
            Table shown below this one.
        loads : str, optional
            Loads that count, in words.

        Returns
        -------
        Table
            The table.
        """
        listed = [[label] if isinstance(label, str) else list(label) for label in labels]
        heads = [(head, "") if isinstance(head, str) else head for head in header]
        before = len(heads) - rows.shape[1]
        texts = zip(*listed, strict=True) if listed else [()] * before
        columns = [
            Column(name, tuple(values), unit, digits=10)
            for (name, unit), values in zip(heads, texts, strict=False)
        ]
        columns += [
            Column(name, tuple(values), unit, decimals=decimals)
            for (name, unit), values in zip(heads[before:], rows.T.tolist(), strict=True)
        ]
        return cls(title, tuple(columns), note, below, loads)

    @property
    def header(self) -> list[str]:
        """Names and units of the columns."""
        return [column.header for column in self.columns]

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0

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

    def cells(self) -> list[list[str]]:
        """Return the rows as text, numbers rounded and exact zeros as 0.

        Returns
        -------
        list of list of str
            A list for each row.
        """
        return [list(row) for row in zip(*(each.cells() for each in self.columns), strict=True)]

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
        lines = [[*map(_cell, self.header)], *self.cells()[:rows]]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        leftwards = [column.is_text and len(self) > 0 for column in self.columns]
        body = (
            "  ".join(
                cell.ljust(width) if left else cell.rjust(width)
                for cell, width, left in zip(line, widths, leftwards, strict=True)
            ).rstrip()
            for line in lines
        )
        title, notes = labels.without_controls(self.title), self._notes(rows)
        text = "\n".join(filter(None, [title, *body, *notes]))
        return f"{text}\n\n{self.below.text(rows)}" if self.below is not None else text

    def __repr__(self) -> str:
        return self.text(SHOWN)

    def _repr_html_(self) -> str:
        return self.html(SHOWN_IN_NOTEBOOKS)

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
        head = "".join(f"<th>{html.escape(_cell(name))}</th>" for name in self.header)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self.cells()[:rows]
        )
        caption = f"<caption>{html.escape(labels.without_controls(self.title))}</caption>"
        notes = "".join(f"<p>{html.escape(note)}</p>" for note in self._notes(rows))
        below = self.below.html(rows) if self.below is not None else ""
        return (
            f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
            f"{notes}{below}"
        )

    def _notes(self, rows: int | None) -> Iterable[str]:
        """Yield the lines under the table."""
        if rows is not None and rows < len(self):
            yield f"{rows} of {len(self)} rows"
        if self.note:
            yield labels.without_controls(self.note)
        if any(each.least and TINY in each.cells()[:rows] for each in self.columns):
            yield f"{TINY}: not zero, but too small to matter."
        if self.loads:
            yield labels.in_words(self.loads)

    @overload
    def to_csv(self, path: None = None) -> str: ...

    @overload
    def to_csv(self, path: str | Path) -> None: ...

    def to_csv(self, path: str | Path | None = None) -> str | None:
        """Return the table as CSV, numbers in full: they read back unchanged; or write a file.

        Tables below this one are not in it. A text that a spreadsheet would take for a formula has
        an apostrophe before it.

        Parameters
        ----------
        path : str or pathlib.Path, optional
            A ``.csv`` file to write, in UTF-8; by default the text is returned.

        Returns
        -------
        str or None
            The text; None where a file was written.

        Raises
        ------
        InputError
            If the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(map(_inert, self.header))
        writer.writerows(zip(*(map(_inert, each.values) for each in self.columns), strict=True))
        if path is None:
            return file.getvalue()
        files.write(inputs.file_path(path, (".csv",), "name a .csv file"), file.getvalue())
        return None

    def to_pandas(self) -> pd.DataFrame:
        """Return a DataFrame, names and units as the heads of its columns (needs pandas).

        Returns
        -------
        pandas.DataFrame
            A column for each column of the table.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        data = {head: list(each.values) for head, each in self._distinct()}
        return optional.data_frame(data, attributes=labels.attributes(self.loads))

    def to_xarray(self) -> xr.Dataset:
        """Return a Dataset over the rows, units as attributes (needs xarray).

        Returns
        -------
        xarray.Dataset
            A variable for each column of the table.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        arrays = {
            head: ("row", np.array(each.values), {"units": each.unit} if each.unit else {})
            for head, each in self._distinct(units=False)
        }
        return optional.dataset(arrays, {}, {"title": self.title} | labels.attributes(self.loads))

    def _distinct(self, *, units: bool = True) -> Iterable[tuple[str, Column]]:
        """Yield the columns with heads that are distinct."""
        seen: set[str] = set()
        for place, each in enumerate(self.columns):
            head = each.header if units else each.name
            head = f"{head} {place}".strip() if head in seen else head
            seen.add(head)
            yield head, each


def _cell(text: str) -> str:
    """Return a text as a cell of one line."""
    return labels.without_controls(text).translate({10: " ", 9: " "})


def _inert(value: Any) -> Any:  # noqa: ANN401 - a number or a text
    """Return a text that no terminal obeys and no spreadsheet runs; numbers as they are."""
    if not isinstance(value, str):
        return value
    text = labels.without_controls(value)
    return f"'{text}" if FORMULA.match(text) and not NUMBER.fullmatch(text) else text


def common_decimals(values: ArrayLike) -> int | None:
    """Return how many decimals show the largest number to six digits, None outside 0.01 to 1e9.

    Columns of one quantity read best with their points aligned.
    """
    largest = float(np.abs(values).max(initial=0.0))
    if not 0.01 <= largest < 1e9:
        return None
    return max(0, 5 - math.floor(math.log10(largest)))


def stacked(*tables: Table) -> Table:
    """Return the first of some tables with the others below it."""
    *above, whole = tables
    for table in reversed(above):
        whole = changed(table, below=whole)
    return whole
