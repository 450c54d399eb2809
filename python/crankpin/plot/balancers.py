"""Hardware against what stays: the sets of the Pareto front below each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin.analysis.balancers import BalancerOptions
from crankpin.plot.axes import entitle, label_x, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.marks import ring
from crankpin.plot.style import SERIES, font_of, foreground, muted, series
from crankpin.plot.ticks import numeric
from crankpin.plot.words import name_of, number, plain_text, rounded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from crankpin.analysis.balancers import BalancerOption

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
    room = _room(ax)
    shown = result.front[: min(MOST_SETS, int(room / SMALLEST))]
    size = min(font_of("ytick.labelsize", "medium").get_size_in_points(), room / len(shown))
    left_out = len(result.front) - len(shown)
    rows = np.arange(len(shown))
    start = np.array(result[0].values)
    entitle(
        ax,
        name_of(result.before),
        f"balancing hardware, {number(result.rpm)} rpm" + f"; {left_out} more" * bool(left_out),
    )
    given = mpl.cbook.normalize_kwargs(style, Line2D)
    parts = np.array([each.values for each in shown]) / np.where(start > 0.0, start, 1.0) * 100.0
    drawn = [k for k, value in enumerate(start) if value > 0.0]
    limits = dict(result.targets)
    for k in drawn:
        objective = result.objectives[k]
        (look,) = series(ax, 1, given)
        marker = MARKERS[k % len(MARKERS)]
        marks: dict[str, Any] = (
            {"marker": marker, "markersize": min(6.0, size)} | look | {"linestyle": ""}
        )
        named = f"{label}, {objective.label}" if label else objective.label
        ax.plot(parts[:, k], rows, gid=SERIES, label=named, clip_on=False, zorder=3, **marks)
        if objective.label in limits:
            limit = limits[objective.label] / start[k] * 100.0
            ax.axvline(limit, color=marks["color"], linewidth=1.0, linestyle=":", gid=TARGET)
        reached = np.array([each.reaches for each in shown])
        if reached.any():
            ring(ax, parts[reached, k], rows[reached], foreground(ax), "o", REACHED)
    _name_rows(ax, shown, size)
    numeric(ax.xaxis)
    ax.set_xlim(0.0, 1.05 * max(100.0, float(parts[:, drawn].max(initial=0.0))))
    label_x(ax, "what stays, % (nothing fitted: 100)")
    legend_below(ax, last=REACHED)
    return ax


def _room(ax: Axes) -> float:
    """Return the points of type that fit below each other: about half of the height of axes."""
    figure: Any = ax.get_figure(root=True)
    inches = float(ax.get_window_extent().height / figure.dpi)
    return max(SMALLEST, 0.5 * 72.0 * inches / 1.1)


def _name_rows(ax: Axes, shown: Sequence[BalancerOption], size: float) -> None:
    """Write sets on the left and their unbalances on the right."""
    rows = np.arange(len(shown))
    ax.set_yticks(rows, [plain_text(_short(each.name)) for each in shown], fontsize=size)
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_ylim(len(rows) - 0.5, -0.5)
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
