"""Tables as bars or curves of their numbers: the picture of results that have no other."""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin._support import inputs, units
from crankpin._support.drawing import picture
from crankpin._support.frames import FIRST, Framed
from crankpin._support.labels import SWEPT, UNIT_RPM
from crankpin.analysis.arrangements.search import Arrangement
from crankpin.analysis.balance import Balance
from crankpin.analysis.balancing.balancers import BalancerOption
from crankpin.analysis.closed_form import ClosedForm
from crankpin.analysis.design.designs import Design
from crankpin.analysis.exercises import Exercise
from crankpin.analysis.explain import Explanation
from crankpin.analysis.mounts.response import WorstForce
from crankpin.analysis.ranking.ranking import Choice
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine
from crankpin.plot.layout import Drawn, add_legend, label_x, label_y, make_panels, note_zero
from crankpin.plot.painter import draw_curves, name_rows, x_axis
from crankpin.plot.style import SERIES, colours, foreground, muted, series, tint
from crankpin.plot.ticks import degrees, numeric
from crankpin.plot.words import joined, plain_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.tables import Table

MOST_PANELS = 4
"""Panels of a table, one for each unit."""
MOST_BARRED = 24
"""Rows of a table that are drawn as bars."""
LEAST_HEIGHT, OF_BAR = 0.22, 0.03
"""Height of a panel of bars, and what each adds, in heights of a figure."""
SHADE = 0.3
"""Strength of the colours behind words."""


class Panel(NamedTuple):
    """Numbers of one unit."""

    unit: str
    rows: list[int]
    """Rows of the table that have this unit."""
    columns: dict[str, NDArray[np.float64]]
    """Name of a column → its numbers in these rows; NaN where there is none."""


@picture.register(Framed)
def table(
    result: Framed,
    ax: Axes | None = None,
    *,
    figure: object = None,
    frame: str = FIRST,
    **style: object,
) -> Drawn:
    """Draw the numbers of a frame: bars of its rows, or curves; a panel for each unit.

    Rows over speed, angle or what else was swept are curves. Of a frame of words its cells are
    drawn.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for the first panel alone; by default new ones.
    frame : str, default "table"
        Name of one of ``frames``.
    """
    table = result.frames[frame]
    table._check_text()
    panels = _panels(table)
    title, *others = table._in(units.current()).title.split("\n")
    if not panels:
        return _words(table, ax, figure, title, style)
    count = 1 if ax is not None else min(len(panels), MOST_PANELS)
    more = len(panels) - count
    along = table.columns[0]
    swept = (along.name in SWEPT or along.name == "theta_deg" or bool(along.unit)) and len(
        table
    ) > 2
    x = along._array() if swept and not along.is_text else np.zeros(0)
    is_curve = x.size > 2 and bool((np.diff(x) > 0.0).all()) and not table.row_units
    bars = max(len(panel.rows[:MOST_BARRED]) * len(panel.columns) for panel in panels[:count])
    height = 0.6 if is_curve else min(0.9, LEAST_HEIGHT + OF_BAR * bars)
    grid = make_panels(ax, figure, count, 1, row_height=height, sharex=is_curve)
    for place, panel in zip(grid.axes.flat, panels, strict=False):
        if is_curve:
            _curves(place, x, panel, style)
        else:
            _bars(place, _names(table), panel, style)
        add_legend(place)
    if is_curve:
        label_x(grid.axes[-1, 0], units.headed(along.name, along.unit))
    notes = [f"{len(table)} rows, {MOST_BARRED} drawn"] * (
        not is_curve and len(table) > MOST_BARRED
    )
    notes += [f"{more} more units"] * bool(more and not grid.single)
    grid.set_title(title, joined(*others[:1], *notes))
    return grid.drawn


def _panels(table: Table) -> list[Panel]:
    """Return the numbers of a table by unit."""
    by_unit: dict[str, Panel] = {}
    for name, column in table._numbers().items():
        cells = column._listed()
        values = np.array(
            [
                float(cell) if isinstance(cell, (int, float)) and cell is not True else np.nan
                for cell in cells
            ]
        )
        for unit in dict.fromkeys(table.row_units or [column.unit]):
            rows = [k for k, one in enumerate(table.row_units) if one == unit]
            rows = rows if table.row_units else [*range(len(table))]
            if np.isfinite(values[rows]).any():
                panel = by_unit.setdefault(
                    column.unit or unit, Panel(column.unit or unit, rows, {})
                )
                panel.columns[name] = values[panel.rows]
    return [*by_unit.values()]


def _names(table: Table) -> list[str]:
    """Return the names of the rows of a table."""
    numbers = table._numbers()
    beside = [
        column.cells()
        for head, column in table._distinct(units=False)
        if head not in numbers and head != "unit"
    ]
    beside = beside or [[str(k + 1) for k in range(len(table))]]
    return [", ".join(filter(None, cells)) for cells in zip(*beside, strict=True)]


def _curves(ax: Axes, x: NDArray[np.float64], panel: Panel, style: dict[str, Any]) -> None:
    draw_curves(ax, x, {plain_text(name): values for name, values in panel.columns.items()}, style)
    x_axis(ax, "", x)
    numeric(ax.yaxis)
    _label(ax, panel, label_y)


def _bars(ax: Axes, names: list[str], panel: Panel, style: dict[str, Any]) -> None:
    rows = panel.rows[:MOST_BARRED]
    places = np.arange(len(rows), dtype=np.float64)
    height = 0.8 / len(panel.columns)
    looks = series(ax, len(panel.columns), style)
    for k, ((name, values), look) in enumerate(zip(panel.columns.items(), looks, strict=True)):
        options = {"color": look["color"], "gid": SERIES, "label": plain_text(name)}
        at = places + (k - (len(panel.columns) - 1) / 2.0) * height
        lengths = np.nan_to_num(values[: len(rows)])
        ax.barh(at, lengths, height=0.9 * height, **(options | style))
    if not any(np.nan_to_num(values).any() for values in panel.columns.values()):
        note_zero(ax)
    name_rows(ax, [names[row] for row in rows])
    ax.axvline(0.0, color=muted(ax, 0.5), linewidth=0.8)
    numeric(ax.xaxis)
    _label(ax, panel, label_x)


def _label(ax: Axes, panel: Panel, label: Callable[[Axes, str], None]) -> None:
    """Label an axis with the names of few columns, and the unit."""
    name = next(iter(panel.columns)) if len(panel.columns) == 1 else ""
    if panel.unit == "°":
        degrees(ax.yaxis if label is label_y else ax.xaxis)
    label(ax, units.headed(name, panel.unit))


def _words(
    table: Table, ax: Axes | None, figure: object, title: str, style: dict[str, Any]
) -> Drawn:
    """Draw the cells of a table of words, each word in its colour."""
    grid = make_panels(ax, figure, 1, 1, row_height=0.9)
    place = grid.axes[0, 0]
    first, *others = table.columns
    rows = [column.cells(MOST_BARRED) for column in others]
    words = dict.fromkeys(word for row in rows for word in row)
    shades = dict(zip(words, colours(place, len(words)), strict=True))
    for column, cells in enumerate(rows):
        for row, word in enumerate(cells):
            face = tint(place, shades[word], SHADE)
            box: dict[str, Any] = {"color": face, "left": column - 0.48, "height": 0.9}
            place.barh(row, 0.96, **(box | style))
            look: dict[str, Any] = {"ha": "center", "va": "center", "color": foreground(place)}
            place.text(column, row, plain_text(word), fontsize="small", **look)
    name_rows(place, first.cells(MOST_BARRED))
    place.set_xticks(range(len(others)), [plain_text(column.header) for column in others])
    place.tick_params(length=0.0, labelsize="x-small")
    place.spines[:].set_visible(False)
    place.set_xlim(-0.5, len(others) - 0.5)
    label_y(place, first.header)
    grid.set_title(*title.split("; "))
    return grid.drawn


# --- results whose picture is that of another -----------------------------------------------------


def drawn_as(
    kind: type, other: type, of: Callable[[Any], Any], text: str, /, **fixed: object
) -> None:
    """Register the picture of another class for what a result has of it.

    Parameters
    ----------
    shown
        Class of the result.
    other
        Class whose picture is drawn.
    of
        Returns the object of that class that a result has.
    text
        First sentence of the docstring.
    **fixed
        Options that are no longer free.
    """
    drawing = picture.dispatch(other)

    @functools.wraps(drawing)
    def draw(result: object, ax: object = None, **options: object) -> Drawn:
        return drawing(of(result), ax, **options, **fixed)  # type: ignore[no-any-return]

    signature = inspect.signature(drawing)
    free = [parameter for parameter in signature.parameters.values() if parameter.name not in fixed]
    draw.__signature__ = signature.replace(parameters=free)  # type: ignore[attr-defined]
    summary, _, rest = (inspect.getdoc(drawing) or "").partition("\n\nParameters\n")
    entries = rest.partition("\n\nReturns\n")[0].partition("\n\nExamples\n")[0]
    for name in fixed:
        entries = _without(entries, name)
    draw.__doc__ = f"{text}\n\nParameters\n{entries}" if summary else text
    picture.register(kind, draw)


def _without(entries: str, name: str) -> str:
    """Return entries of a docstring without one."""
    heads = entries.split("\n")
    passed, skips = [], False
    for line in heads:
        if line and not line.startswith(" "):
            skips = line.startswith(f"{name} : ")
        passed += [] if skips else [line]
    return "\n".join(passed)


UNIT_CYLINDER = Cylinder(1.0, 3.0, 1.0)
"""Cylinder of engines of which angles alone are drawn."""

drawn_as(Design, Engine, lambda design: design.engine, "Draw the engine, as :meth:`Engine.plot`.")
drawn_as(Choice, Engine, lambda choice: choice.engine, "Draw the engine, as :meth:`Engine.plot`.")
drawn_as(Exercise, Engine, lambda sheet: sheet.engine, "Draw its engine, as :meth:`Engine.plot`.")
drawn_as(
    BalancerOption,
    Engine,
    lambda option: option.fitted,
    "Draw the engine with the hardware, as :meth:`Engine.plot`.",
)
drawn_as(
    Arrangement,
    Engine,
    lambda arrangement: arrangement.engine(UNIT_CYLINDER, spacing=1.0),
    "Draw the star of the crankpins, as :meth:`Engine.plot`.",
    kind="star",
    figure=None,
)
drawn_as(
    Explanation,
    Balance,
    lambda result: result.engine.balance(UNIT_RPM if result.rpm is None else result.rpm),
    "Draw how the cylinders add up in each order, as :meth:`Balance.plot`.",
    kind="phasors",
    log=None,
)


# --- results without a picture --------------------------------------------------------------------

WITHOUT_PICTURE = {
    ClosedForm: "a formula: draw engine.balance(…), or print it with to_latex",
    WorstForce: "one number: draw the response, which has all",
}
"""Class that has no picture → the reason, and what to draw instead."""


def _reject(result: object, ax: object = None) -> Drawn:
    """Raise an InputError: of this there is no picture."""
    raise inputs.faulty(
        "plot", f"has no picture of {type(result).__name__}", WITHOUT_PICTURE[type(result)]
    )


for _kind in WITHOUT_PICTURE:
    picture.register(_kind, _reject)
