"""Hardware against what stays: the sets of the Pareto front below each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import labels
from crankpin.analysis.balancing.balancers import BalancerOptions
from crankpin.plot.axes import entitle, label_x, one_panel, say_zero
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.marks import ring
from crankpin.plot.named_rows import names_there, rows_for, wide_enough
from crankpin.plot.style import SERIES, count_series, font_of, foreground, muted, series
from crankpin.plot.ticks import numeric
from crankpin.plot.words import number, rounded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.balancing.balancers import BalancerOption

MOST_SETS = 24
"""Largest number of sets shown below each other, those with the fewest shafts."""
MARKERS = "os^Dv"
TARGET = "crankpin target"
"""Marks the lines at the targets by their gid."""
REACHED = "target reached"
SMALLEST = 5.0
"""Points of the smallest type of the rows."""


@draw.register(BalancerOptions)
def _balancers(
    result: BalancerOptions,
    ax: Axes | None = None,
    *,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of markers
) -> Axes:
    ax = one_panel(ax)
    alone = not count_series(ax)
    room = _room(ax)
    most = max(1, min(MOST_SETS, int(room / SMALLEST)) - len(names_there(ax)))
    shown = result.front[:most]
    left_out = len(result.front) - len(shown)
    entitle(
        ax,
        labels.name_of(result.before),
        f"hardware, {number(result.rpm)} rpm" + f"; {left_out} more" * bool(left_out),
    )
    if label is None and not alone:
        label = labels.name_of(result.before)
    start = np.array(result[0].values)
    parts = np.array([each.values for each in shown]) / np.where(start > 0.0, start, 1.0) * 100.0
    drawn = [k for k, value in enumerate(start) if value > 0.0]
    wide_enough(ax, max(100.0, float(parts[:, drawn].max(initial=0.0))))
    rows = rows_for(ax, [_short(each.name) for each in shown])
    usual = font_of("ytick.labelsize", "medium").get_size_in_points()
    size = max(SMALLEST, min(usual, room / len(ax.get_yticks())))
    ax.tick_params(axis="y", labelsize=size)
    given = mpl.cbook.normalize_kwargs(style, Line2D)
    limits = dict(result.targets)
    reached = np.array([each.reaches for each in shown])
    for k in drawn:
        name = result.by[k]
        (look,) = series(ax, 1, given)
        marker = MARKERS[count_series(ax) % len(MARKERS)]
        marks: dict[str, Any] = {"marker": marker, "markersize": min(6.0, size)} | look
        marks |= {"linestyle": ""}
        named = f"{label}, {name}" if label else name
        ax.plot(parts[:, k], rows, gid=SERIES, label=named, clip_on=False, zorder=3, **marks)
        if name in limits:
            limit = limits[name] / start[k] * 100.0
            ax.axvline(limit, color=marks["color"], linewidth=1.0, linestyle=":", gid=TARGET)
        if reached.any():
            ring(ax, parts[reached, k], rows[reached], foreground(ax), "o", REACHED)
    if alone:
        _write_amounts(ax, rows, shown, size)
    else:  # amounts of several engines would share a row
        for child in ax.child_axes:
            child.set_visible(False)
    if alone and not drawn:
        say_zero(ax)
    numeric(ax.xaxis)
    label_x(ax, "what stays, % (nothing fitted: 100)")
    legend_below(ax, last=REACHED)
    return ax


def _room(ax: Axes) -> float:
    """Return the points of type that fit below each other: about half of the height of axes."""
    figure: Any = ax.get_figure(root=True)
    inches = float(ax.get_window_extent().height / figure.dpi)
    return max(SMALLEST, 0.5 * 72.0 * inches / 1.1)


def _write_amounts(
    ax: Axes, rows: NDArray[np.intp], shown: Sequence[BalancerOption], size: float
) -> None:
    """Write the unbalance of each set on the right."""
    amounts = ax.secondary_yaxis("right")
    amounts.set_yticks(rows, [rounded(1000.0 * each.unbalance) for each in shown], fontsize=size)
    amounts.tick_params(axis="y", length=0, pad=6, labelcolor=muted(ax))
    amounts.set_ylabel("unbalance, g·m", color=muted(ax))
    amounts.spines["right"].set_visible(False)


def _short(name: str) -> str:
    """Return the name of a set as short as columns of papers need it."""
    for long, short in (
        ("counterweights", "weights"),
        (" + ", ", "),
        ("shafts ", ""),
        ("shaft ", ""),
        (" alone", ""),
    ):
        name = name.replace(long, short)
    return name
