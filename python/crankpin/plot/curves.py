"""Curves of a sweep over one swept dimension, with what vanishes and what is best marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import inputs
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.axes import (
    BESIDE_A_SCALE,
    entitle,
    entitle_figure,
    head,
    label_x,
    label_y,
    many_panels,
    one_panel,
    say_zero,
)
from crankpin.plot.bundle import Bundle, Curve, bundle_of, colour_scale
from crankpin.plot.legend import figure_legend, legend_below
from crankpin.plot.marks import entry, ring, write
from crankpin.plot.rows import Rows, along_x, at, dimension, rows_of, words_of
from crankpin.plot.style import MOST_TOLD_APART, SERIES, foreground
from crankpin.plot.ticks import degrees, from_zero, numeric, span
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.sweeps.sweep import Sweep

FEW_POINTS = 40
"""Up to so many points of a curve are marked."""
MOST_MARKS = 6
"""Up to so many zeros of a curve, and texts of a panel, are marked."""
ZERO, LEAST = "exactly zero", "least of all"


def curves(
    sweep: Sweep,
    ax: Axes | None = None,
    figure: Any = None,  # noqa: ANN401 - checked
    *,
    quantity: str = "moment",
    x: str | None = None,
    orders: object = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    """Draw peaks over a swept dimension, rows for orders and columns for axes."""
    name = inputs.one_of("quantity", quantity, QUANTITIES)
    rows = rows_of(sweep, name, orders, single=ax is not None)
    along, words = along_x(sweep, x), words_of(sweep)
    if ax is not None:
        ax = one_panel(ax)
        entitle(ax, words.title, words.subtitle(name), rows.columns[0])
        _draw(np.array([[ax]]), sweep, name, along, rows, style)
        legend_below(ax, words.common)
        return ax
    shared: dict[str, Any] = {"sharex": "col", "sharey": "row"}
    if along == "engine":
        shared = {"sharex": "row", "sharey": "all"}
    made = many_panels(figure, len(rows.rows), len(rows.columns), **shared)
    for panel, axis in zip(made.axes[0], rows.columns, strict=True):
        head(panel, axis)
    bundle = _draw(made.axes, sweep, name, along, rows, style)
    if bundle.scale:
        for panel, axis in zip(made.axes[0], rows.columns, strict=True):
            head(panel, axis, part=BESIDE_A_SCALE)
    entitle_figure(made.figure, words.title, words.subtitle(name), rows.note)
    marks = [entry_of(made.axes, text) for text in (ZERO, LEAST)]
    handles = [*bundle.handles, *filter(None, marks)]
    figure_legend(made.figure, handles, words.common if bundle.handles else "")
    return made.axes


def _draw(
    panels: NDArray[Any],
    sweep: Sweep,
    quantity: str,
    along: str,
    rows: Rows,
    style: Mapping[str, Any],
) -> Bundle:
    dims, words = list(sweep.coords), words_of(sweep)
    others = [dim for dim in dims if dim != along]
    peaks = [np.moveaxis(row.peaks, dims.index(along), 0) for row in rows.rows]
    sizes = peaks[0].max(axis=-1).min(axis=0, initial=np.inf).reshape(-1)
    of_lines = mpl.cbook.normalize_kwargs(dict(style), Line2D)
    bundle = bundle_of(panels[0, 0], sweep, others, words, sizes, of_lines)
    for row, column in np.ndindex(*panels.shape):
        panel: Any = panels[row, column]
        heights = peaks[row][..., column]
        if along == "engine":
            _dots(panel, words.names, heights, bundle.curves)
            continue
        values = np.asarray(sweep.coords[along], dtype=np.float64)
        span(panel, values)
        lines(panel, values, heights, bundle.curves)
        # Every peak grows with the square of speed: the least is at the lowest.
        least = row == 0 and "rpm" not in sweep.coords
        mark(panel, along, values, heights, bundle.curves, least=least)
    for of_row, heights, row_of_picture in zip(panels, peaks, rows.rows, strict=True):
        _scale(of_row, float(heights.max(initial=0.0)), quantity, along, row_of_picture.name)
    if along != "engine":
        for panel in panels[-1]:
            label_x(panel, dimension(along))
            (degrees if along.endswith("_deg") else numeric)(panel.xaxis)
    if bundle.scale:
        colour_scale(panels, sweep, bundle.scale)
    return bundle


def lines(
    ax: Axes, x: NDArray[np.float64], peaks: NDArray[np.float64], drawn: Sequence[Curve]
) -> None:
    """Draw curves of an array (along x, …), with markers if they have few points."""
    in_order = np.argsort(x, kind="stable")
    few = len(drawn) <= MOST_TOLD_APART and len(x) <= FEW_POINTS
    for curve in drawn:
        heights = peaks[:, *curve.place][in_order]
        look: dict[str, Any] = {"marker": "o" if few or len(x) == 1 else "", "markersize": 3.0}
        look |= curve.style
        ax.plot(x[in_order], heights, gid=SERIES, label=curve.name or "_", clip_on=False, **look)
    if not peaks.any():
        say_zero(ax)


def _dots(
    ax: Axes, names: Sequence[str], peaks: NDArray[np.float64], drawn: Sequence[Curve]
) -> None:
    """Draw engines below each other: names need room, and between two engines there is nothing."""
    rows = np.arange(len(names))
    for k, curve in enumerate(drawn):
        look: dict[str, Any] = {"marker": "os^Dv"[k % 5], "markersize": 6.0}
        look |= curve.style | {"linestyle": ""}
        heights = peaks[:, *curve.place]
        ax.plot(heights, rows, gid=SERIES, label=curve.name or "_", clip_on=False, **look)
    ax.set_yticks(rows, [plain_text(name) for name in names])
    ax.set_ylim(len(names) - 0.5, -0.5)


def _scale(panels: Sequence[Axes], largest: float, quantity: str, along: str, name: str) -> None:
    """Let the axis of the peaks begin at zero; label it with the row's name."""
    unit = f"peak, {QUANTITIES[quantity].unit}"
    for panel in panels:
        if along == "engine":
            numeric(panel.xaxis)
            panel.set_xlim(0.0, 1.08 * largest or 1.0)
            label_x(panel, unit)
        else:
            numeric(panel.yaxis)
            from_zero(panel, largest)
    label_y(panels[0], name, *([] if along == "engine" else [unit]))


# --- marks --------------------------------------------------------------------------------------


def mark(
    ax: Axes,
    along: str,
    x: NDArray[np.float64],
    peaks: NDArray[np.float64],
    drawn: Sequence[Curve],
    *,
    least: bool,
) -> None:
    """Mark where curves vanish, and with ``least`` the smallest value of all if none does."""
    found: dict[float, str] = {}
    for curve in drawn if len(drawn) <= MOST_TOLD_APART else []:
        heights = peaks[:, *curve.place]
        zeros = x[heights == 0.0]
        if 0 < zeros.size <= MOST_MARKS and heights.any():
            ring(ax, zeros, np.zeros_like(zeros), curve.style["color"], "o", ZERO)
            found |= dict.fromkeys(zeros.tolist(), "")
    for place in sorted(found)[:MOST_MARKS]:
        write(ax, place, 0.0, at(along, place))
    if not least or not peaks.size or peaks.min() == 0.0:
        return
    best = np.argwhere(peaks == peaks.min())
    if len(best) == 1:  # a smallest value that is shared singles out nothing
        place = float(x[best[0][0]])
        value = float(peaks.min())
        ring(ax, np.array([place]), np.array([value]), foreground(ax), "D", LEAST)
        write(ax, place, value, at(along, place))


def entry_of(panels: NDArray[Any], text: str) -> Line2D | None:
    """Return the legend's entry for marks that some panel has."""
    return next(filter(None, (entry(panel, text) for panel in panels.flat)), None)
