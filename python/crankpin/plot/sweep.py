"""Sweeps: bars over engines, and the kind of picture chosen by the swept dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.messages import Hint
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.sweeps.sweep import Sweep
from crankpin.plot.curves import curves
from crankpin.plot.layout import Drawn, Kinds, draw_kind, make_panels
from crankpin.plot.maps import heat_map, order_map
from crankpin.plot.painter import name_rows, x_axis
from crankpin.plot.parts import parts
from crankpin.plot.rows import given_orders, largest, words_of
from crankpin.plot.style import DISTINCT, background, colours, foreground, hollow, muted, write
from crankpin.plot.words import drawn_quantity, joined, loads_of, nonzero_in

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order

SUMMARY = 4
"""The highest order by which engines are classed, and drawn by default."""
MOST_ENGINES = 24
"""Engines shown below each other."""
HATCHES = ("", "////", "....", "xxxx")
CLASSES = {
    (False, False): "balanced",
    (True, False): "shakes",
    (False, True): "rocks",
    (True, True): "shakes, rocks",
}
"""Whether there is force, and moment → the class of an engine."""


def bars(
    sweep: Sweep,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str | None = None,
    orders: object = None,
    **style: object,
) -> Drawn:
    """Draw the longest vectors of each engine, a panel for force and one for moment."""
    if list(sweep.coords) != ["engine"]:
        swept = ", ".join(sweep.coords)
        hint = f"needs a sweep over engines alone, not over {swept}"
        raise inputs.rejected("kind", "bars", hint)
    both = quantity is None and ax is None
    names = ["force", "moment"] if both else [drawn_quantity(quantity, nonzero_in(sweep.total))]
    chosen = _orders(sweep, names, orders)
    peaks = [np.stack([getattr(sweep[n], name).peak for n in chosen], axis=-1) for name in names]
    classes, words = _classes(sweep, chosen), words_of(sweep)
    where = joined(*words.parts, "longest vector", loads_of(sweep, "".join(names)))
    note = _note(sweep, chosen)
    engines = min(len(words.names), MOST_ENGINES)
    height = max(0.45, engines * (0.04 + 0.03 * len(chosen)))
    panels = make_panels(ax, figure, 1, len(names), row_height=height, sharey=True)
    panels.name_columns([QUANTITIES[name].words for name in names])
    for panel, name, values in zip(panels.axes.flat, names, peaks, strict=True):
        _panel(panel, words.names[:engines], values[:engines], chosen, name, style)
    _class(panels.axes[0, -1], classes[:engines])
    panels.set_title(words.title, where, note)
    panels.add_legend(panels.axes[0, 0].get_legend_handles_labels()[0], words.common)
    return panels.drawn


def _orders(sweep: Sweep, names: Sequence[str], orders: object) -> list[Order]:
    """Return the requested orders, by default those of the summary, or the largest."""
    if orders is not None:
        return given_orders(orders)
    low = [order for order in sweep.orders if order <= SUMMARY]
    if low:
        return low
    places, _ = largest(sweep, names[0])
    return [sweep.orders[place] for place in places] or [*sweep.orders[:1], 1][:1]


def _classes(sweep: Sweep, orders: Sequence[Order]) -> list[str]:
    """Return whether each engine shakes or rocks in these orders."""
    force = np.stack([sweep[order].force.peak for order in orders], axis=-1)
    moment = np.stack([sweep[order].moment.peak for order in orders], axis=-1)
    pairs = zip(force.max(axis=-1) > 0.0, moment.max(axis=-1) > 0.0, strict=True)
    return [CLASSES[bool(shakes), bool(rocks)] for shakes, rocks in pairs]


def _note(sweep: Sweep, orders: Sequence[Order]) -> str:
    engines = len(sweep.coords["engine"])
    rest = f"; {engines - MOST_ENGINES} more engines not shown" if engines > MOST_ENGINES else ""
    return f"balanced: no force and no moment in {labels.orders_text(tuple(orders))}{rest}"


def _panel(
    ax: Axes,
    names: Sequence[str],
    peaks: NDArray[np.float64],
    orders: Sequence[Order],
    quantity: str,
    style: dict[str, Any],
) -> None:
    """Draw engines below each other, a bar for each order; hollow circles for exact zeros."""
    rows, height = np.arange(len(names)), 0.8 / len(orders)
    for k, (order, colour) in enumerate(zip(orders, colours(ax, len(orders)), strict=True)):
        up, values = rows + (k - 0.5 * (len(orders) - 1)) * height, peaks[:, k]
        zeros = up[values == 0.0]
        look = {"color": colour, "hatch": HATCHES[k % len(HATCHES)], "edgecolor": background(ax)}
        look |= {"linewidth": 0.0, "label": f"order {order}"} | style
        ax.barh(up, values, 0.92 * height, **look)
        hollow(ax, np.zeros_like(zeros), zeros, colour, markersize=3.5)
    x_axis(ax, units.headed("peak", QUANTITIES[quantity].unit))
    ax.set_xlim(0.0, 1.08 * float(peaks.max(initial=0.0)) or 1.0)
    name_rows(ax, names)


def _class(ax: Axes, classes: Sequence[str]) -> None:
    """Write the class of each engine beside its row."""
    for row, text in enumerate(classes):
        colour = foreground(ax) if text == CLASSES[False, False] else muted(ax)
        at: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "annotation_clip": False}
        write(ax, text, complex(1.0, row), 5.0 + 0j, ha="left", color=colour, **at)


# --- sweep ---------------------------------------------------------------------------------------

SWEEP_PICTURES: Kinds = {
    "curves": curves,
    "parts": parts,
    "map": heat_map,
    "orders": order_map,
    "bars": bars,
}


@picture.register(Sweep)
def _sweep(
    result: Sweep,
    ax: object = None,
    *,
    figure: object = None,
    kind: str | None = None,
    quantity: str | None = None,
    x: str | None = None,
    orders: object = None,
    log: bool | None = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw peaks over what was swept.

    A row of panels for all orders together and for each of the three largest orders, a column
    for each axis.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on: a single panel with the longest vector of all orders together, or of
        the one in ``orders``; with ``"bars"`` of one quantity.
    kind : {"curves", "parts", "map", "orders", "bars"}, optional
        ``"curves"``: over one dimension, a curve for each combination of the others, with the
        points where an order is exactly zero, and the minimum, marked; ``"parts"``: of
        force or moment what turns with the crank and what turns against it, over one numeric
        dimension, a panel for each order and what else was swept; ``"map"``: over two
        numeric dimensions, in colours; ``"orders"``: over one numeric dimension, such as speed,
        and order, in colours; ``"bars"``: over engines, force beside moment in the orders up to
        4, with the class of each engine. By default bars for engines alone, a map for two long
        numeric dimensions, otherwise curves.
    quantity : str, optional
        ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``; by default the moment,
        or else the first that is not zero, of bars force and moment.
    x : str, optional
        The dimension along the horizontal axis; by default the longest.
    orders : number, sequence of numbers or "auto", optional
        Orders to draw, a row for each; by default as above.
    log : bool, optional
        Whether the scale is logarithmic; by default that of ``"orders"`` alone.
    label : str, optional
        Put before the names in the legend.
    **style : dict, optional
        Colour, line width and other properties of matplotlib lines, of maps those of
        ``pcolormesh``.

    Returns
    -------
    matplotlib.axes.Axes or ndarray of Axes
        The panels, (n_rows, 2), of torque (n_rows, 1), of parts (n_orders, n_others); with
        ``ax`` the axes given.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=range(10, 180, 10), hold="pins")
    >>> s.plot(orders=[1, 2]).shape
    (2, 2)
    """
    if not result.coords:
        hint = Hint.of("give an array, such as `bank_angle_deg=[60, 75, 90]`")
        raise inputs.faulty("sweep", "is of one point", hint)
    if x is not None:
        x = inputs.one_of("x", x, result.coords)
    chosen = _chosen(result, x) if kind is None else kind
    if chosen == "bars":
        for name, value in (("x", x), ("log", log)):
            if value is not None:
                hint = Hint.of('has no meaning for `kind="bars"`; leave it out')
                raise inputs.rejected(name, value, hint)
    options = {"quantity": quantity, "x": x, "orders": orders, "log": log, "label": label}
    return draw_kind(SWEEP_PICTURES, chosen, result, ax, figure, **options, **style)


def _chosen(sweep: Sweep, x: str | None) -> str:
    """Return the kind of picture that shows a sweep best."""
    lengths = [len(values) for dim, values in sweep.coords.items() if dim != "engine"]
    if not lengths and x is None:
        return "bars"
    if x is None and len(lengths) == 2 and "engine" not in sweep.coords:
        return "map" if min(lengths) > DISTINCT else "curves"
    return "curves"
