"""Bars over engines: the force and moment of each, order by order, and what class that makes it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.axes import entitle, entitle_figure, head, many_panels, one_panel
from crankpin.plot.legend import figure_legend, legend_below
from crankpin.plot.orders import largest
from crankpin.plot.rows import words_of
from crankpin.plot.style import background, colours, foreground, muted
from crankpin.plot.ticks import numeric
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.sweeps.sweep import Sweep

SUMMARY = 4
"""The highest order by which engines are classed, and drawn by default."""
MOST_ENGINES = 24
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
    figure: Any = None,  # noqa: ANN401 - checked
    *,
    quantity: str | None = None,
    orders: object = None,
    **style: Any,  # noqa: ANN401 - of bars
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    """Draw the longest vectors of each engine, a panel for force and one for moment."""
    if list(sweep.coords) != ["engine"]:
        swept = ", ".join(sweep.coords)
        raise InputError(f'kind = "bars" needs a sweep over engines alone, not over {swept}')
    names = ["force", "moment"] if quantity is None and ax is None else [quantity or "moment"]
    for name in names:
        inputs.one_of("quantity", name, QUANTITIES)
    chosen = _orders(sweep, names, orders)
    peaks = [np.stack([getattr(sweep[n], name).peak for n in chosen], axis=-1) for name in names]
    classes, words = _classes(sweep, chosen), words_of(sweep)
    where = ", ".join([*words.parts, "longest vector"])
    note = _note(sweep, chosen)
    if ax is not None:
        ax = one_panel(ax)
        _panel(ax, words.names, peaks[0], chosen, names[0], style)
        entitle(ax, words.title, where, note)
        _class(ax, classes)
        legend_below(ax)
        return ax
    engines = min(len(words.names), MOST_ENGINES)
    height = max(0.45, engines * (0.04 + 0.03 * len(chosen)))
    made = many_panels(figure, 1, len(names), row_height=height, sharey=True)
    for panel, name, values in zip(made.axes.flat, names, peaks, strict=True):
        head(panel, name.replace("_", " "))
        _panel(panel, words.names, values, chosen, name, style)
    _class(made.axes[0, -1], classes)
    entitle_figure(made.figure, words.title, where, note)
    figure_legend(made.figure, made.axes[0, 0].get_legend_handles_labels()[0], words.common)
    return made.axes


def _orders(sweep: Sweep, names: Sequence[str], orders: object) -> list[int]:
    """Return the orders asked for, by default those of the summary, or else the largest."""
    if orders is not None:
        return inputs.explicit_orders(orders)
    low = [order for order in sweep.orders if order <= SUMMARY]
    if low:
        return low
    places, _ = largest(sweep, names[0])
    return [sweep.orders[place] for place in places] or [sweep.orders[0]]


def _classes(sweep: Sweep, orders: Sequence[int]) -> list[str]:
    """Return whether each engine shakes or rocks in these orders."""
    force = np.stack([sweep[order].force.peak for order in orders], axis=-1)
    moment = np.stack([sweep[order].moment.peak for order in orders], axis=-1)
    pairs = zip(force.max(axis=-1) > 0.0, moment.max(axis=-1) > 0.0, strict=True)
    return [CLASSES[bool(shakes), bool(rocks)] for shakes, rocks in pairs]


def _note(sweep: Sweep, orders: Sequence[int]) -> str:
    engines = len(sweep.coords["engine"])
    rest = f"; {engines - MOST_ENGINES} more engines not shown" if engines > MOST_ENGINES else ""
    return f"balanced: no force and no moment in {labels.orders_text(tuple(orders))}{rest}"


def _panel(
    ax: Axes,
    names: Sequence[str],
    peaks: NDArray[np.float64],
    orders: Sequence[int],
    quantity: str,
    style: dict[str, Any],
) -> None:
    """Draw engines below each other, a bar for each order; hollow circles for exact zeros."""
    engines = min(len(names), MOST_ENGINES)
    rows, height = np.arange(engines), 0.8 / len(orders)
    for k, (order, colour) in enumerate(zip(orders, colours(ax, len(orders)), strict=True)):
        up, values = rows + (k - 0.5 * (len(orders) - 1)) * height, peaks[:engines, k]
        look = {"color": colour, "hatch": HATCHES[k % len(HATCHES)], "edgecolor": background(ax)}
        look |= {"linewidth": 0.0, "label": f"order {order}"} | style
        ax.barh(up, values, 0.92 * height, **look)
        (hollow,) = ax.plot(
            np.zeros(int((values == 0.0).sum())),
            up[values == 0.0],
            linestyle="",
            marker="o",
            markersize=3.5,
            markeredgecolor=colour,
            markerfacecolor=background(ax),
            clip_on=False,
            zorder=3,
        )
        # The layout would make room for a line without points at the figure's corner.
        hollow.set_in_layout(bool((values == 0.0).any()))
    numeric(ax.xaxis)
    ax.set_xlim(0.0, 1.08 * float(peaks.max(initial=0.0)) or 1.0)
    ax.set_xlabel(f"peak, {QUANTITIES[quantity].unit}")
    ax.set_yticks(rows, [plain_text(name) for name in names[:engines]])
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(engines - 0.5, -0.5)


def _class(ax: Axes, classes: Sequence[str]) -> None:
    """Write the class of each engine beside its row."""
    for row, text in enumerate(classes[:MOST_ENGINES]):
        ax.annotate(
            text,
            (1.0, row),
            (5.0, 0.0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            va="center",
            fontsize="small",
            color=foreground(ax) if text == CLASSES[False, False] else muted(ax),
            annotation_clip=False,
        )
