"""Maps of a sweep: peaks over two swept dimensions, and over speed and order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import LogNorm, Normalize

from crankpin._support import inputs, units
from crankpin._support.messages import Hint
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.layout import Drawn, Panels, label_bar, label_x, label_y, make_panels, note_zero
from crankpin.plot.rows import Row, Rows, along_x, dimension, rows_of, words_of
from crankpin.plot.style import foreground, of_maps
from crankpin.plot.ticks import degrees, numeric
from crankpin.plot.words import drawn_quantity, joined, nonzero_in

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import QuadMesh
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.sweeps.sweep import Sweep

MOST_ENGINE_ROWS = 4
"""Engines with a row of their own."""
DOTTED = "white dots: exactly zero"
"""Note on a map with dots."""
MOST_ZEROS = 60
"""Maximum number of points at which a quantity vanishes that are marked."""
RANGE = 1e-4
"""Part of the largest peak at which the colours of orders begin."""
BELOW = (0.5, 0.5, 0.5, 0.2)
"""Colour of smaller ones, on light and dark backgrounds."""


def heat_map(
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
    """Draw peaks over two numeric dimensions, rows for orders or engines and columns for axes.

    Orders have a scale of colours each, engines one that they share.
    """
    name = drawn_quantity(quantity, nonzero_in(sweep.total))
    scale = logarithmic_scale if inputs.flag("log", log) else scale_from_zero
    along, up = _axes_of(sweep, x)
    rows, note = _rows(sweep, name, orders, single=ax is not None)
    words = words_of(sweep)
    dims = [dim for dim in sweep.coords if dim != "engine"]
    grids = [np.moveaxis(row.peaks, dims.index(up), 0) for row in rows.rows]
    coords = [np.asarray(sweep.coords[dim], dtype=np.float64) for dim in (along, up)]
    panels = make_panels(ax, figure, len(grids), len(rows.columns), sharex=True, sharey=True)
    scales = [scale(grid) for grid in grids]
    if "engine" in sweep.coords:
        scales = [scale(np.stack(grids))] * len(grids)
    vanishes = [
        heat(row_panels, coords, grid, _of_bar(name), norm, style)
        for grid, row_panels, norm in zip(grids, panels.axes, scales, strict=True)
    ]
    _label_all(panels, along, up, rows)
    notes = [note, DOTTED if any(vanishes) else ""]
    what = [f"{rows.rows[0].name}, {rows.columns[0]}"] if panels.single else []
    panels.set_title(words.title, words.subtitle(name), *what, *notes)
    return panels.drawn


def order_map(
    sweep: Sweep,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str | None = None,
    x: str | None = None,
    log: bool = True,
    **style: object,
) -> Drawn:
    """Draw peaks over speed, or another swept number, and order, in one scale, logarithmic."""
    logarithmic = inputs.flag("log", log)
    name = drawn_quantity(quantity, nonzero_in(sweep.total))
    dims = [dim for dim in sweep.coords if dim != "engine"]
    if len(dims) != 1 or x not in (None, *dims):
        swept = ", ".join(f"`{name}`" for name in sweep.coords)
        hint = Hint.of(f'needs one swept number, not {swept}; give `kind="curves"`')
        raise inputs.rejected("kind", "orders", hint)
    (along,) = dims
    orders = sweep.orders or (1,)  # zero, where nothing shakes
    rows, note = _rows(sweep, name, orders, single=ax is not None, by_order=True)
    peaks = np.stack([row.peaks for row in rows.rows])
    if sweep._request.orders is None:  # those of a torque may be many more
        seen = np.flatnonzero(np.moveaxis(peaks, -2, 0).reshape(len(orders), -1).any(axis=1))
        count = int(seen.max(initial=0)) + 1
        if count < len(orders):
            note = joined(note, f"above order {orders[count - 1]:g}: zero")
        orders, peaks = orders[:count], peaks[..., :count, :]
    words = words_of(sweep)
    values = np.asarray(sweep.coords[along], dtype=np.float64)
    height = 0.7 if len(rows.rows) == 1 else 0.45
    shared: dict[str, Any] = {"sharex": True, "sharey": True, "row_height": height}
    grid = make_panels(ax, figure, len(rows.rows), len(rows.columns), **shared)
    norm = logarithmic_scale(peaks) if logarithmic else scale_from_zero(peaks)
    for of_row, panels in zip(peaks, grid.axes, strict=True):
        mesh = cells(panels, values, orders, of_row, {"norm": norm} | style)
    if peaks.any():
        colour_bar(grid.axes.ravel(), mesh, _of_bar(name), peaks)
    _label_all(grid, along, "order", rows)
    grid.set_title(words.title, words.subtitle(name), rows.columns[0] if grid.single else "", note)
    return grid.drawn


def _axes_of(sweep: Sweep, x: str | None) -> tuple[str, str]:
    """Return the two numeric dimensions, the one along x first."""
    dims = [dim for dim in sweep.coords if dim != "engine"]
    if len(dims) != 2:
        swept = ", ".join(f"`{name}`" for name in sweep.coords)
        hint = Hint.of(f'needs two swept numbers, not {swept}; give `kind="curves"`')
        raise inputs.rejected("kind", "map", hint)
    along = along_x(sweep, x, dims)
    if along == "engine":
        raise inputs.rejected("x", along, f"is not a number; choose from: {', '.join(dims)}")
    return along, next(dim for dim in dims if dim != along)


def _rows(
    sweep: Sweep, name: str, orders: object, *, single: bool, by_order: bool = False
) -> tuple[Rows, str]:
    """Return the rows of a map, of several engines a row for each, and a note.

    With ``by_order`` a row has all orders, in its last dimension but one.
    """
    if by_order:
        of_orders = rows_of(sweep, name, orders, single=False)
        peaks = np.stack([row.peaks for row in of_orders.rows], axis=-2)
        if single:
            peaks = getattr(sweep, name).peak[..., np.newaxis]
        columns = ("longest vector",) if single and peaks.shape[-1] == 1 else of_orders.columns
        rows = Rows([Row("", peaks)], columns, "")
    else:
        rows = rows_of(sweep, name, orders, single=single)
    if "engine" not in sweep.coords:
        return rows, rows.note
    names = words_of(sweep).names
    if single and len(names) > 1:
        fault = "cannot hold a map of several engines"
        raise inputs.faulty("ax", fault, "there is a panel for each; give figure")
    first = rows.rows[0]
    what = f", {first.name}" if first.name else ""
    drawn = [Row(f"{n}{what}", first.peaks[k]) for k, n in enumerate(names[:MOST_ENGINE_ROWS])]
    rest = len(names) - len(drawn)
    return rows._replace(rows=drawn), f"{rest} more engines not shown" if rest else ""


def heat(
    panels: Sequence[Axes] | NDArray[Any],
    coords: Sequence[NDArray[np.float64]],
    peaks: NDArray[np.float64],
    label: str,
    norm: Normalize,
    style: dict[str, Any],
) -> bool:
    """Draw a row of panels, peaks (along y, along x, panel) in colours of a scale, dots at zeros.

    Return True if there are such dots.
    """
    dotted = False
    x, y = coords
    columns, lines = np.argsort(x, kind="stable"), np.argsort(y, kind="stable")
    options = {"shading": "nearest", "norm": norm, "rasterized": True, "cmap": of_maps()}
    for k, panel in enumerate(panels):
        of_panel = peaks[..., k]
        # A logarithmic scale has no zero.
        cells = np.maximum(of_panel[np.ix_(lines, columns)], norm.vmin or 0.0)
        mesh = panel.pcolormesh(x[columns], y[lines], cells, **(options | style))
        up, across = np.nonzero(of_panel == 0.0)
        if 0 < up.size <= MOST_ZEROS:
            dotted = True
            # The scale of colours is dark at zero, whatever the background.
            panel.plot(x[across], y[up], "o", markersize=1.5, color="white", gid="crankpin zeros")
        if not peaks.any():
            note_zero(panel, color="white")
    if peaks.any():  # a scale of nothing would mislead
        colour_bar(panels, mesh, label, peaks)
    return dotted


def scale_from_zero(peaks: NDArray[np.float64]) -> Normalize:
    """Return a scale of colours from zero to the largest peak."""
    return Normalize(0.0, float(peaks.max(initial=0.0)) or 1.0)


def logarithmic_scale(peaks: NDArray[np.float64]) -> LogNorm:
    """Return a scale of colours from the smallest peak that is not negligible to the largest."""
    nonzero = peaks[peaks > 0.0]
    largest = float(nonzero.max(initial=0.0)) or 1.0
    smallest = max(RANGE * largest, float(nonzero.min(initial=largest)))
    return LogNorm(min(smallest, 0.1 * largest), largest)


def cells(
    panels: Sequence[Axes] | NDArray[Any],
    x: NDArray[np.float64],
    orders: Sequence[Order],
    peaks: NDArray[np.float64],
    options: dict[str, Any],
) -> QuadMesh:
    """Draw a row of cells for each order; those of an order that is zero stay empty."""
    in_order = np.argsort(x, kind="stable")
    step = 1.0 if all(isinstance(order, int) for order in orders) else 0.5
    rows = np.arange(step, max(orders) + step, step)
    for k, panel in enumerate(panels):
        cells = np.full((len(rows), len(x)), np.nan)
        for place, order in enumerate(orders):
            row = round(order / step) - 1
            cells[row] = peaks[in_order, place, k]
            if peaks.any() and not cells[row].any():
                look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": "x-small"}
                middle = float(np.mean([x.min(), x.max()]))
                panel.text(middle, order, "zero", color=foreground(panel), **look)
        cells[cells == 0.0] = np.nan
        drawn = {"shading": "nearest", "rasterized": True, "cmap": of_maps()} | options
        places = rows
        if len(rows) == 1:  # it would have no height: one beyond it, which is not seen
            places, cells = np.append(rows, 2.0 * rows), np.vstack([cells, np.full(len(x), np.nan)])
        mesh: QuadMesh = panel.pcolormesh(x[in_order], places, cells, **drawn)
        mesh.set_cmap(mesh.get_cmap().with_extremes(under=BELOW))
        panel.set_ylim(0.5 * step, rows[-1] + 0.5 * step)
        if not peaks.any():
            note_zero(panel)
    return mesh


def _of_bar(quantity: str) -> str:
    return units.headed("peak", QUANTITIES[quantity].unit)


def colour_bar(
    panels: Sequence[Axes] | NDArray[Any],
    mesh: ScalarMappable,
    label: str,
    peaks: NDArray[np.float64],
) -> None:
    """Draw the scale of colours of peaks, pointed where some are below it."""
    below = ((peaks > 0.0) & (peaks < (mesh.norm.vmin or 0.0))).any()
    extend = "min" if below else "neither"
    figure = panels[0].get_figure(root=False)
    bar = figure.colorbar(mesh, ax=list(panels), aspect=25, pad=0.02, extend=extend)  # type: ignore[union-attr]
    label_bar(bar, label)
    bar.outline.set_visible(False)
    if not isinstance(mesh.norm, LogNorm):
        numeric(bar.ax.yaxis)


def _label_all(panels: Panels, along: str, up: str, rows: Rows) -> None:
    """Name the columns above them, the rows and axes on the left and below."""
    for (row, column), panel in np.ndenumerate(panels.axes):
        for axis, dim in ((panel.xaxis, along), (panel.yaxis, up)):
            degrees(axis) if dim.endswith("_deg") else numeric(axis, whole=dim == "order")
        if row == len(panels.axes) - 1:
            label_x(panel, dimension(along))
        if not column:
            name = "" if panels.single else rows.rows[row].name
            label_y(panel, *filter(None, [name, dimension(up)]))
    panels.name_columns(rows.columns)
