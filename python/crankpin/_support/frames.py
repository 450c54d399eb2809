"""Results as named frames: text, HTML, CSV, LaTeX, DataFrame and Dataset follow from them."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from crankpin._support import files, inputs, labels, optional
from crankpin._support import units as unit_names
from crankpin._support.drawing import Plot
from crankpin._support.messages import without_controls
from crankpin._support.record import AbsentItemError, Record, changed

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    from crankpin._support.tables import Table

FIRST = "table"
"""Name of the first frame of every result."""
PHASES = "phases"
"""Name of the frame of amplitudes and phases, of results by order."""
SHOWN = 30
"""Rows of a long table in text: a screen."""
SHOWN_IN_NOTEBOOKS = 60
"""Rows of a long table in a notebook."""
ROWS = 2**12
"""Rows that are written at once."""
FORMULA = re.compile(r"\s*[=+\-@＝＋－＠]|[\t\n]")
"""Beginning of a text that a spreadsheet takes for a formula."""
PLAIN_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.ASCII | re.IGNORECASE)


class Frames(Mapping[str, "Table"]):
    """Tables of a result by name, in the order in which they are shown.

    A table is computed when it is read; text and HTML are in the units that
    :func:`crankpin.units` has set. They leave out the frames for programs, which are shown by name.
    """

    def __init__(
        self,
        makers: Mapping[str, Callable[[], Table]],
        head: Callable[[int], Table | None] = lambda _: None,
        for_programs: Mapping[str, Callable[[], Table]] = MappingProxyType({}),
    ) -> None:
        self._makers, self._beginning = {**makers, **for_programs}, head
        self.for_programs = tuple(for_programs)

    def __getitem__(self, name: str) -> Table:
        """Return the table of a name, or raise an InputError."""
        return self._makers[inputs.one_of("frame", name, self._makers, AbsentItemError)]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)

    def _first(self, name: str, rows: int | None) -> Table:
        """Return a table, of one that is long its first rows if they can be computed alone."""
        head = self._beginning(rows) if rows is not None and name == FIRST else None
        return self[name] if head is None else head

    def _shown(self, rows: int | None) -> Iterator[Table]:
        """Yield the tables; of successive tables that count the same loads the last states them."""
        tables = [self._first(name, rows) for name in self if name not in self.for_programs]
        for table, below in zip(tables, [*tables[1:], None], strict=True):
            once = below is not None and below.loads == table.loads
            yield changed(table, loads="") if once else table

    def text(self, rows: int | None = None) -> str:
        """Return the tables as text below each other, the first rows of each or all."""
        return "\n\n".join(table.text(rows) for table in self._shown(rows))

    def __repr__(self) -> str:
        return self.text(SHOWN)

    def _repr_html_(self) -> str:
        rows = SHOWN_IN_NOTEBOOKS
        return "".join(table.html(rows) for table in self._shown(rows))


class Framed:
    """Mixin of what is named frames, tables of columns with units, and has a picture."""

    @property
    def table(self) -> Table:
        """First of the frames."""
        raise NotImplementedError

    @property
    def frames(self) -> Frames:
        """Tables by name, in the order shown: ``table``."""
        return self._frames()

    def _frames(self, **further: Callable[[], Table]) -> Frames:
        """Return the table, and further frames by name."""
        return Frames({FIRST: lambda: self.table} | further, self._beginning, self._for_programs)

    @property
    def _for_programs(self) -> Mapping[str, Callable[[], Table]]:
        """Frames that text and HTML leave out: name → table."""
        return MappingProxyType({})

    def _beginning(self, rows: int) -> Table | None:
        """Return the first rows of a long table, computed alone; None where all are computed."""
        return None

    @property
    def _brief(self) -> str:
        """Line in place of frames that would take long to compute; empty to show them."""
        return ""

    def __repr__(self) -> str:
        return self._brief or repr(self.frames)

    def _repr_html_(self) -> str | None:
        return None if self._brief else self.frames._repr_html_()

    if TYPE_CHECKING:

        @overload
        def plot(self, ax: Axes, **options: object) -> Axes: ...

        @overload
        def plot(self, ax: None = None, **options: object) -> Any: ...  # noqa: ANN401

        def plot(self, ax: Axes | None = None, **options: object) -> Any:
            """Draw it; return the axes."""

    else:
        plot = Plot()

    def tidy(self, *columns: str) -> Table:
        """Return the numbers of the table in long form, a row for each number.

        Columns are those of the table that hold texts or name its rows, as order and rpm do; then
        quantity, the name of a column of numbers (component, where the table has a column of the
        name quantity); value and unit.

        Parameters
        ----------
        *columns : str, optional
            Columns of the table whose numbers are listed; by default all that hold numbers.

        Returns
        -------
        Table
            The rows; its ``to_pandas`` and ``to_csv`` write them.

        Raises
        ------
        InputError
            If there is no such column of numbers.
        """
        return self._exported(FIRST, "")._long(columns)

    def _exported(self, frame: str, units: str) -> Table:
        """Return a frame in units that an export asks for."""
        setting = unit_names.read(units)
        with unit_names.Shown(setting):  # sentences among its cells are made in them
            return self.frames[frame]._in(setting)

    def _dataset(self) -> xr.Dataset | None:
        """Return the arrays of a result that has dimensions."""
        return None

    def to_pandas(self, *, frame: str = FIRST, units: str = "") -> pd.DataFrame:
        """Return a frame as a DataFrame (needs pandas).

        Parameters
        ----------
        frame : str, default "table"
            Name of one of ``frames``.
        units : str, default ""
            Units of its numbers, as :func:`crankpin.units` takes them, by default those of results,
            SI.

        Returns
        -------
        pandas.DataFrame
            A row for each row of the frame, names and units as the heads of its columns.

        Raises
        ------
        InputError
            If there is no such frame or unit.
        ImportError
            If pandas is not installed.
        """
        table = self._exported(frame, units)
        data = {
            head: column.data if isinstance(column.data, np.ndarray) else list(column.data)
            for head, column in table._distinct()
        }
        data_frame: pd.DataFrame = optional.library("pandas").DataFrame(data)
        data_frame.attrs.update(labels.attributes(table.loads))
        return data_frame

    def to_xarray(
        self, *, frame: str | None = None, units: str = "", split_complex: bool = False
    ) -> xr.Dataset:
        """Return a Dataset with units and named dimensions (needs xarray).

        Parameters
        ----------
        frame : str, optional
            Name of one of ``frames``; by default the arrays of a result that has dimensions, which
            rows would flatten, or else the table.
        units : str, default ""
            Units of its numbers, as :func:`crankpin.units` takes them, by default those of results,
            SI.
        split_complex : bool, default False
            Store complex arrays as real ones with a dimension ``part`` of "re" and "im", for
            ``to_netcdf(path)``: netCDF has no complex numbers.

        Returns
        -------
        xarray.Dataset
            A variable for each array, or for each column of the frame over its rows.

        Raises
        ------
        InputError
            If there is no such frame or unit.
        ImportError
            If xarray is not installed.
        """
        split = inputs.flag("split_complex", split_complex)
        if frame is None and (whole := self._dataset()) is not None:
            whole = in_units(whole, unit_names.read(units))
            return optional.split_complex(whole) if split else whole
        table = self._exported(FIRST if frame is None else frame, units)
        arrays = {
            head: ("row", column._array(), {"units": column.unit} if column.unit else {})
            for head, column in table._distinct(units=False)
        }
        attributes = {"title": table.title} | labels.attributes(table.loads)
        rows = optional.dataset(arrays, {}, attributes)
        return optional.split_complex(rows) if split else rows

    @overload
    def to_csv(self, path: None = None, *, frame: str = FIRST, units: str = "") -> str: ...

    @overload
    def to_csv(self, path: str | Path, *, frame: str = FIRST, units: str = "") -> None: ...

    def to_csv(
        self, path: str | Path | None = None, *, frame: str = FIRST, units: str = ""
    ) -> str | None:
        """Return a frame as CSV, numbers in full: they read back unchanged; or write a file.

        A text that a spreadsheet would take for a formula has an apostrophe before it.

        Parameters
        ----------
        path : str or pathlib.Path, optional
            A ``.csv`` file to write, in UTF-8; by default the text is returned.
        frame : str, default "table"
            Name of one of ``frames``.
        units : str, default ""
            Units of its numbers, as :func:`crankpin.units` takes them, by default those of results,
            SI.

        Returns
        -------
        str or None
            The text; None where a file was written.

        Raises
        ------
        InputError
            If there is no such frame or unit, the name ends otherwise, or the text would take more
            memory than any result may.
        OSError
            If the file cannot be written.
        """
        table = self._exported(frame, units)
        if path is None:
            table._check_text()
        return _written(_csv(table), path, ".csv")

    @overload
    def to_latex(self, path: None = None, *, frame: str = FIRST) -> str: ...

    @overload
    def to_latex(self, path: str | Path, *, frame: str = FIRST) -> None: ...

    def to_latex(self, path: str | Path | None = None, *, frame: str = FIRST) -> str | None:
        """Return a frame as a table of LaTeX, which needs its package booktabs; or write a file.

        The title is its caption; numbers are rounded, and in the units, as in text.

        Parameters
        ----------
        path : str or pathlib.Path, optional
            A ``.tex`` file to write, in UTF-8; by default the text is returned.
        frame : str, default "table"
            Name of one of ``frames``.

        Returns
        -------
        str or None
            The text; None where a file was written.

        Raises
        ------
        InputError
            If there is no such frame, the name ends otherwise, or the text would take more memory
            than any result may.
        OSError
            If the file cannot be written.
        """
        from crankpin._support import latex  # noqa: PLC0415 - few results become LaTeX

        table = self.frames[frame]._in(unit_names.current())
        cells = table.cells()
        columns = "".join("l" if column.is_text else "r" for column in table.columns)
        text = latex.table(table.title, table.header, cells, table._notes(), columns)
        return _written(text, path, ".tex")


class Tabled(Framed, Record):
    """Base class of results, which are named frames and have a picture."""


def in_units(dataset: xr.Dataset, setting: unit_names.Setting) -> xr.Dataset:
    """Return a Dataset in the units of a setting, coordinates included."""
    for name, array in dataset.variables.items():
        unit = array.attrs.get("units", "")
        converted = unit_names.convert(unit, setting)
        if converted.unit != unit:
            attributes = {**array.attrs, "units": converted.unit}
            dataset = dataset.assign(
                {name: (array.dims, array.values * converted.factor, attributes)}
            )
    return dataset


def _csv(table: Table) -> Iterator[str]:
    """Yield a table as CSV, some rows at a time."""
    yield _lines([map(_inert, table.header)])
    for start in range(0, len(table), ROWS):
        part = slice(start, start + ROWS)
        columns = (map(_inert, column._listed(part)) for column in table.columns)
        yield _lines(zip(*columns, strict=True))


def _lines(rows: Iterable[Iterable[object]]) -> str:
    """Return rows of cells as lines of CSV."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(rows)
    return file.getvalue()


def _inert(value: object) -> object:
    """Return a text that no terminal obeys and no spreadsheet runs; numbers as they are."""
    if not isinstance(value, str):
        return value
    text = without_controls(value)
    return f"'{text}" if FORMULA.match(text) and not PLAIN_NUMBER.fullmatch(text) else text


def _written(text: str | Iterable[str], path: str | Path | None, ending: str) -> str | None:
    """Return a text, or write it to a file, in pieces as they come."""
    if path is None:
        return "".join(text)
    files.write(inputs.file_path(path, (ending,), f"name a {ending} file"), text)
    return None
