"""Star diagrams: the phase vectors of the cylinders at an order, from one centre, and their sum."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from crankpin._support import inputs, labels
from crankpin.analysis.star import StarDiagram
from crankpin.plot.dispatch import picture
from crankpin.plot.layout import add_legend, axes_or_new, note_zero, set_title
from crankpin.plot.phasors import SUM, arrow
from crankpin.plot.shapes import listed, outside
from crankpin.plot.style import colours, foreground, muted
from crankpin.plot.words import rounded

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from crankpin._support.inputs import Order

DIRECTIONS = 9
"""Decimals to which vectors of one direction agree."""
NOTHING = 1e-12
"""Vectors below this part of the longest are not drawn."""


@picture.register(StarDiagram)
def _star(
    result: StarDiagram,
    ax: Axes | None = None,
    *,
    order: Order | None = None,
    **style: Any,  # noqa: ANN401
) -> Axes:
    shown = _shown(result) if order is None else inputs.order(order)
    vectors = result.vectors[result.place(shown)]
    total, longest = result[shown], float(np.abs(vectors).max(initial=0.0))
    ax = axes_or_new(ax)
    ax.set_aspect("equal")
    ax.set(xticks=[], yticks=[], xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), frame_on=False)
    ax.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=muted(ax, 0.35), linewidth=0.8))
    set_title(ax, labels.name_of(result.engine), f"order {shown}, {_finding(result, shown)}")
    if not longest:
        note_zero(ax)
        return ax
    looks = {"color": colours(ax, 1)[0], "linewidth": 1.5} | style
    rays: dict[complex, list[int]] = {}
    for number, vector in enumerate(vectors.tolist(), start=1):
        if abs(vector) > NOTHING * longest:
            rays.setdefault(complex(np.round(vector / abs(vector), DIRECTIONS)), []).append(number)
    for numbers in rays.values():
        # Of vectors of one direction the longest covers the others, whose tips are marked.
        tips = [complex(vectors[number - 1]) / longest for number in numbers]
        farthest = max(tips, key=abs)
        arrow(ax, 0j, farthest, 0j, **looks)
        ax.plot(np.real(tips), np.imag(tips), ".", color=looks["color"], gid="tip")
        outside(ax, farthest, listed(numbers), fontsize="small")
    size = float(np.abs(vectors).sum())
    handles = [Line2D([], [], color=looks["color"], linewidth=1.5, label="cylinders")]
    if total:
        arrow(ax, 0j, total / size, 0j, color=muted(ax, 0.5), linewidth=SUM, zorder=0.9)
        share = f"sum, {rounded(100.0 * abs(total) / size)} % of all lengths"
        handles.append(Line2D([], [], color=muted(ax, 0.5), linewidth=SUM, label=share))
    ax.plot([0.0], [0.0], marker="o", markersize=4.0, color=foreground(ax), zorder=4)
    add_legend(ax, handles=handles)
    return ax


def _shown(result: StarDiagram) -> Order:
    """Return the first order that remains without being major, else the first that remains."""
    remaining = result.verdicts.remaining
    minor = [order for order in remaining if order not in result.major]
    return [*minor, *remaining, *result.orders][0]


def _finding(result: StarDiagram, order: Order) -> str:
    if order in result.major:
        return f"major: sum {rounded(abs(result[order]), 4)}"
    if result.verdicts[order] == "vanishes":
        return "sum 0, proved"
    return f"sum {rounded(abs(result[order]), 4)}"
