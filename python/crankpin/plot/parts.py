"""Sweeps by forward and backward parts, order by order.

Counterweights remove the forward part of order 1; all other parts need balance shafts.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.messages import Hint
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.plot.curves import ZERO, Curve, lines, mark
from crankpin.plot.layout import Drawn, Panels, label_y, make_panels, set_panel_title, width_for
from crankpin.plot.painter import x_axis
from crankpin.plot.rows import (
    MOST_ORDERS_DRAWN,
    along_x,
    dimension,
    given_orders,
    largest,
    values_of,
    words_of,
)
from crankpin.plot.style import DISTINCT, entries_of, series
from crankpin.plot.ticks import magnitude_scale
from crankpin.plot.words import drawn_quantity, joined, nonzero_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.quantity import Quantity
    from crankpin.analysis.sweeps.sweep import Sweep

WIDE = 1.6
"""Inches that a panel needs beside another."""


def parts(
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
    """Draw both parts over a swept number, a panel for each order and what else was swept."""
    name = drawn_quantity(quantity, nonzero_in(sweep.total), PLANE_VECTORS)
    logarithmic = inputs.flag("log", log)
    along, words = along_x(sweep, x), words_of(sweep)
    if along == "engine":
        hint: str = Hint.of("draws over a number, such as `bank_angle_deg`; sweep one")
        raise inputs.rejected("kind", "parts", hint)
    others = [values_of(sweep, dim, words) for dim in sweep.coords if dim != along]
    names = [", ".join(texts) for texts in itertools.product(*others)]
    places, note = largest(sweep, name, MOST_ORDERS_DRAWN - 1)
    # Where all are zero, one panel says so.
    chosen = [sweep.orders[place] for place in places] or [*(sweep.orders or (1,))[:1]]
    if orders is not None:
        chosen, note = given_orders(orders), ""
    vectors = [getattr(sweep[order], name) for order in chosen]
    if len(names) > DISTINCT:
        hint = f"has a panel for each of {len(names)} engines or values; sweep up to {DISTINCT}"
        raise inputs.rejected("kind", "parts", f"{hint} beside {along}")
    if ax is not None and len(chosen) * len(names) > 1:
        raise inputs.rejected("ax", ax, "there is a panel for each order and engine; give figure")
    grid, panels = _panels(ax, figure, len(chosen), len(names))
    for (row, column), panel in np.ndenumerate(panels):
        if not grid.single:
            set_panel_title(panel, joined(f"order {chosen[row]}", names[column]))
        is_lowest = grid.single or panel.get_subplotspec().is_last_row()
        label = dimension(along) if is_lowest else ""
        x_axis(panel, label, sweep.coords[along], by_angle=along.endswith("_deg"))
        _draw(panel, sweep, vectors[row], along, style, column)
        if grid.single or panel.get_subplotspec().is_first_col():
            label_y(panel, QUANTITIES[name].words, units.headed("", QUANTITIES[name].unit))
    for of_order, vector in zip(panels, vectors, strict=True):
        for panel in of_order:
            magnitude_scale(panel, _sizes(vector), logarithmic=logarithmic)
    what = f"order {chosen[0]}" if grid.single else note
    grid.set_title(words.title, words.subtitle(name), what)
    both = panels[0, 0].get_legend_handles_labels()[0][:2]
    grid.add_legend([*both, *entries_of(panels, ZERO)])
    return grid.drawn if grid.single else panels


def _panels(ax: Axes | None, figure: object, orders: int, rest: int) -> tuple[Panels, NDArray[Any]]:
    """Return panels, also as (orders, rest). As many are side by side as fit."""
    width = width_for(figure)
    if rest > 1 and width >= WIDE * rest:
        panels = make_panels(ax, figure, orders, rest, sharex="col", sharey="row")
        return panels, panels.axes
    columns = orders if width >= WIDE * orders else 1
    height = 0.7 if rest == 1 and columns > 1 else 0.45
    panels = make_panels(
        ax, figure, orders * rest // columns, columns, row_height=height, sharex="col"
    )
    return panels, panels.axes.reshape(rest, orders).T


def _sizes(vector: Quantity) -> NDArray[np.float64]:
    """Return the magnitudes of both parts of an order: (…, 2)."""
    phasors = np.stack([getattr(vector, part) for part in labels.TURNING_WORDS], axis=-1)
    return np.asarray(np.abs(phasors), dtype=np.float64)


def _draw(
    ax: Axes, sweep: Sweep, vector: Quantity, along: str, style: dict[str, Any], column: int = 0
) -> None:
    """Draw both parts of an order; the column is a place among what is not drawn along x."""
    values = np.asarray(sweep.coords[along], dtype=np.float64)
    heights = np.moveaxis(_sizes(vector), list(sweep.coords).index(along), 0)
    heights = heights.reshape(len(values), -1, len(labels.TURNING_WORDS))
    looks = series(ax, len(labels.TURNING_WORDS), style)
    drawn = [
        Curve((column, k), look, text)
        for k, (look, text) in enumerate(zip(looks, labels.TURNING_WORDS.values(), strict=True))
    ]
    lines(ax, values, heights, drawn)
    mark(ax, along, values, heights, drawn, least=False)
