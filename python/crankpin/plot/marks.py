"""Marks on curves: rings and short texts that stay readable before lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from crankpin.plot.style import background, foreground

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

MARK = "crankpin mark"
"""Marks rings by their gid."""


def ring(
    ax: Axes,
    x: NDArray[Any],
    y: NDArray[Any],
    colour: Any,  # noqa: ANN401 - a colour
    marker: str,
    label: str,
) -> None:
    """Draw hollow marks; the first with a label on the axes is its entry in the legend."""
    known = label in ax.get_legend_handles_labels()[1]
    ax.plot(
        x,
        y,
        linestyle="",
        marker=marker,
        markersize=8.0,
        markeredgecolor=colour,
        markeredgewidth=1.2,
        markerfacecolor="none",
        clip_on=False,
        zorder=4,
        gid=MARK,
        label="_" if known else label,
    )


def write(ax: Axes, x: float, y: float, text: str, *, beside: bool = False) -> None:
    """Write above a mark, or beside it on the right."""
    low, high = ax.get_xlim()
    part = (x - low) / (high - low)
    within = "left" if part < 0.06 else "right" if part > 0.94 else "center"
    written = ax.annotate(
        text,
        (x, y),
        (8.0, 0.0) if beside else (0.0, 7.0),
        textcoords="offset points",
        ha="left" if beside else within,
        va="center" if beside else "bottom",
        fontsize="small",
        color=foreground(ax),
        zorder=5,
    )
    written.set_path_effects([withStroke(linewidth=2.5, foreground=background(ax))])


def entry(ax: Axes, label: str) -> Line2D | None:
    """Return an entry of a legend for marks on axes, if there are any."""
    for line in ax.lines:
        if line.get_label() == label:
            handle = Line2D([], [], linestyle="", marker=line.get_marker(), label=label)
            handle.set(markeredgecolor=foreground(ax), markerfacecolor="none")
            return handle
    return None
