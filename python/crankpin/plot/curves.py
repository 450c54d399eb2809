"""Curves of a sweep over one swept dimension, with zeros and minima marked."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D

from crankpin._support import inputs, units
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.layout import Drawn, keep_apart, label_x, label_y, make_panels, note_zero
from crankpin.plot.painter import name_rows, x_axis
from crankpin.plot.rows import Rows, Words, along_x, at, dimension, rows_of, values_of, words_of
from crankpin.plot.style import (
    DASHES,
    DISTINCT,
    MARKERS,
    SERIES,
    cycle,
    entries_of,
    foreground,
    muted,
    ring,
    scale,
    series,
    write_at_mark,
)
from crankpin.plot.ticks import RoundLocator, magnitude_scale
from crankpin.plot.words import drawn_quantity, in_degrees, joined, nonzero_in, number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.sweeps.sweep import Sweep


MOST_DASHES = 4
"""Number of dashes that are used beside colours of another meaning."""
MOST_ENGINES_NAMED = 5
"""Engines with a name in the legend where there are too many for all."""
THIN: dict[str, Any] = {"linewidth": 0.8, "linestyle": "-"}


class Curve(NamedTuple):
    """Style of the curve of one combination of swept values."""

    place: tuple[Any, ...]
    """Picks it from an array without the dimension along x."""
    style: dict[str, Any]
    name: str
    """Its entry in a legend; empty for none."""


class Bundle(NamedTuple):
    """All curves of a panel, and what their looks mean."""

    curves: list[Curve]
    handles: list[Line2D]
    """Entries of a legend for several panels."""
    scale: str | None
    """Dimension that a scale of colours stands for."""


def bundle_of(
    ax: Axes,
    sweep: Sweep,
    others: Sequence[str],
    words: Words,
    sizes: NDArray[np.float64],
    style: Mapping[str, Any],
) -> Bundle:
    """Give every combination of the other dimensions its look.

    One dimension: successive colours and dashes; if it is long, a scale of colours for numbers,
    and the ``NAMED`` engines with the smallest ``sizes`` named among thin lines of the others.
    More dimensions: colours by the first, dashes by the rest, or thin lines if they are many.
    """
    lengths = [len(sweep.coords[dim]) for dim in others]
    places = list(np.ndindex(*lengths))
    options = mpl.cbook.normalize_kwargs(dict(style), Line2D)
    label = str(options.pop("label", None) or "")
    if not others:
        (look,) = series(ax, 1, options)
        return Bundle([Curve((), look, label)], [], None)
    texts = [values_of(sweep, dim, words) for dim in others]
    names = [joined(label, *parts) for parts in itertools.product(*texts)]
    if len(others) == 1 and (others[0] == "engine" or len(places) <= DISTINCT):
        return Bundle(*engine_looks(ax, names, sizes, options), None)
    n_rest = len(places) // lengths[0]
    few = lengths[0] <= DISTINCT
    colours = [entry["color"] for entry in cycle(ax)] if few else scale(ax, lengths[0])
    looks = []
    for k in range(len(places)):
        colour, dash = divmod(k, n_rest)
        thin = THIN if n_rest > MOST_DASHES else {"linestyle": DASHES[dash]}
        looks.append({"color": colours[colour % len(colours)]} | thin | options)
    handles = [
        Line2D([], [], color=colour, label=text)
        for colour, text in zip(colours, texts[0], strict=False)
        if few
    ]
    if 1 < n_rest <= MOST_DASHES:
        rest = [", ".join(parts) for parts in itertools.product(*texts[1:])]
        grey = muted(ax)
        handles += [
            Line2D([], [], color=grey, linestyle=DASHES[k], label=text)
            for k, text in enumerate(rest)
        ]
    elif n_rest > 1:
        what = " × ".join(f"{len(sweep.coords[dim])} of {dimension(dim)}" for dim in others[1:])
        handles.append(Line2D([], [], color=muted(ax), **THIN, label=f"each: {what}"))
    distinct = few and n_rest <= MOST_DASHES
    drawn = names if distinct else [""] * len(names)
    curves = [Curve(*row) for row in zip(places, looks, drawn, strict=True)]
    return Bundle(curves, handles, None if few else others[0])


def engine_looks(
    ax: Axes, names: Sequence[str], sizes: NDArray[np.float64], style: Mapping[str, Any]
) -> tuple[list[Curve], list[Line2D]]:
    """Give each engine successive colours and dashes; of many, the ones with the least sizes.

    The others are thin lines below them, with one entry in the legend.
    """
    count = len(names) if len(names) <= DISTINCT else MOST_ENGINES_NAMED
    largest = sorted(np.argsort(sizes, kind="stable")[:count].tolist())
    looks = series(ax, count, style)
    curves = [Curve((k,), look, names[k]) for k, look in zip(largest, looks, strict=True)]
    handles = [Line2D([], [], **curve.style, label=curve.name) for curve in curves]
    rest = [k for k in range(len(names)) if k not in largest]
    if rest:
        grey: dict[str, Any] = {"color": muted(ax, 0.35), "zorder": 1.9, **THIN}
        text = f"{len(rest)} others"
        handles.append(Line2D([], [], **grey, label=text))
        thin = [Curve((k,), grey, text if k == rest[0] else "") for k in rest]
        curves += thin
    return curves, handles


def colour_scale(panels: NDArray[Any], sweep: Sweep, dim: str) -> None:
    """Put a scale of the colours of a swept dimension beside panels.

    Colours go by place in the list, so that the scale is right for uneven steps too.
    """
    values = np.asarray(sweep.coords[dim], dtype=np.float64)
    order, count = np.argsort(values, kind="stable"), len(values)
    first = panels.flat[0]
    colours = ListedColormap(np.array(scale(first, count))[order])
    mappable = ScalarMappable(BoundaryNorm(np.arange(count + 1) - 0.5, count), colours)
    figure = first.get_figure(root=False)
    bar = figure.colorbar(mappable, ax=panels.ravel().tolist(), aspect=35, pad=0.02)
    ticks = np.array(RoundLocator(6).tick_values(values.min(), values.max()))
    ticks = ticks[(ticks >= values.min()) & (ticks <= values.max())]
    written = in_degrees if dim.endswith("_deg") else number
    where = np.interp(ticks, values[order], np.arange(count))
    bar.set_ticks(where.tolist(), labels=[written(float(f"{tick:.10g}")) for tick in ticks])
    bar.ax.minorticks_off()
    bar.set_label(dimension(dim), color=foreground(first))


# --- curves --------------------------------------------------------------------------------------

FEW_POINTS = 40
"""Maximum number of points of a curve that are marked."""
MOST_MARKS = 6
"""Maximum number of zeros of a curve, and of texts of a panel, that are marked."""
ZERO, LEAST = "exactly zero", "least of all"


def curves(
    sweep: Sweep,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str | None = None,
    x: str | None = None,
    orders: object = None,
    log: bool = False,
    **style: object,
) -> Drawn:
    """Draw peaks over a swept dimension, rows for orders and columns for axes."""
    logarithmic = inputs.flag("log", log)
    name = drawn_quantity(quantity, nonzero_in(sweep.total))
    rows = rows_of(sweep, name, orders, single=ax is not None)
    along, words = along_x(sweep, x), words_of(sweep)
    shared: dict[str, Any] = {"sharex": "col", "sharey": "row"}
    if along == "engine":
        shared = {"sharex": "row", "sharey": "all"}
    panels = make_panels(ax, figure, len(rows.rows), len(rows.columns), **shared)
    panels.name_columns(rows.columns)
    bundle = _draw(panels.axes, sweep, name, along, rows, style, logarithmic=logarithmic)
    what = rows.columns[0] if panels.single else rows.note
    panels.set_title(words.title, words.subtitle(name), what)
    panels.add_legend(
        [*bundle.handles, *entries_of(panels.axes, ZERO, LEAST)],
        words.common if bundle.handles or panels.single else "",
    )
    return panels.drawn


def _draw(
    panels: NDArray[Any],
    sweep: Sweep,
    quantity: str,
    along: str,
    rows: Rows,
    style: Mapping[str, Any],
    *,
    logarithmic: bool,
) -> Bundle:
    dims, words = list(sweep.coords), words_of(sweep)
    others = [dim for dim in dims if dim != along]
    peaks = [np.moveaxis(row.peaks, dims.index(along), 0) for row in rows.rows]
    sizes = peaks[0].max(axis=-1).min(axis=0, initial=np.inf).reshape(-1)
    bundle = bundle_of(panels[0, 0], sweep, others, words, sizes, style)
    for row, column in np.ndindex(*panels.shape):
        panel: Any = panels[row, column]
        heights = peaks[row][..., column]
        if along == "engine":
            _dots(panel, words.names, heights, bundle.curves)
            continue
        values = np.asarray(sweep.coords[along], dtype=np.float64)
        label = dimension(along) if row == len(panels) - 1 else ""
        x_axis(panel, label, values, by_angle=along.endswith("_deg"))
        lines(panel, values, heights, bundle.curves)
        # Every peak grows with the square of speed: the least is at the lowest.
        least = row == 0 and "rpm" not in sweep.coords
        mark(panel, along, values, heights, bundle.curves, least=least)
    for of_row, heights, row_of_picture in zip(panels, peaks, rows.rows, strict=True):
        _scale(of_row, heights, quantity, along, row_of_picture.name, logarithmic=logarithmic)
    if bundle.scale:
        colour_scale(panels, sweep, bundle.scale)
    return bundle


def lines(
    ax: Axes, x: NDArray[np.float64], peaks: NDArray[np.float64], drawn: Sequence[Curve]
) -> None:
    """Draw curves of an array (along x, …), with markers if they have few points."""
    in_order = np.argsort(x, kind="stable")
    few = len(drawn) <= DISTINCT and len(x) <= FEW_POINTS
    for curve in drawn:
        heights = peaks[:, *curve.place][in_order]
        look: dict[str, Any] = {"marker": "o" if few or len(x) == 1 else "", "markersize": 3.0}
        look |= curve.style
        # On a logarithmic scale a curve through zero goes down for ever.
        look |= {"clip_on": bool((heights == 0.0).any())}
        ax.plot(x[in_order], heights, gid=SERIES, label=curve.name or "_", **look)
    if not peaks.any():
        note_zero(ax)


def _dots(
    ax: Axes, names: Sequence[str], peaks: NDArray[np.float64], drawn: Sequence[Curve]
) -> None:
    """Draw engines below each other: names need room, and between two engines there is nothing."""
    rows = np.arange(len(names))
    for k, curve in enumerate(drawn):
        look: dict[str, Any] = {"marker": MARKERS[k % len(MARKERS)], "markersize": 6.0}
        look |= curve.style | {"linestyle": ""}
        heights = peaks[:, *curve.place]
        ax.plot(heights, rows, gid=SERIES, label=curve.name or "_", clip_on=False, **look)
    name_rows(ax, names)


def _scale(
    panels: Sequence[Axes],
    peaks: NDArray[np.float64],
    quantity: str,
    along: str,
    name: str,
    *,
    logarithmic: bool,
) -> None:
    """Let the axis of the peaks begin at zero, or be logarithmic; label it with the row's name."""
    unit = units.headed("peak", QUANTITIES[quantity].unit)
    for panel in panels:
        axis: Literal["x", "y"] = "x" if along == "engine" else "y"
        magnitude_scale(panel, peaks, logarithmic=logarithmic, name=axis)
        if axis == "x":
            label_x(panel, unit)
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
    marked: dict[float, str] = {}
    for curve in drawn if len(drawn) <= DISTINCT else []:
        heights = peaks[:, *curve.place]
        zeros = x[heights == 0.0]
        if 0 < zeros.size <= MOST_MARKS and heights.any():
            # On the axis, also of a logarithmic scale, which has no zero.
            on_axis = ax.get_xaxis_transform()
            colour = curve.style["color"]
            ring(ax, zeros, np.zeros_like(zeros), colour, "o", ZERO, transform=on_axis)
            marked |= dict.fromkeys(zeros.tolist(), "")
    places = sorted(marked)[:MOST_MARKS]
    keep_apart(ax, [write_at_mark(ax, place, 0.0, at(along, place)) for place in places])
    if not least or not peaks.size or peaks.min() == 0.0:
        return
    best = np.argwhere(peaks == peaks.min())
    if len(best) == 1:  # a smallest value that is shared singles out nothing
        place = float(x[best[0][0]])
        value = float(peaks.min())
        ring(ax, np.array([place]), np.array([value]), foreground(ax), "D", LEAST)
        write_at_mark(ax, place, value, at(along, place))
