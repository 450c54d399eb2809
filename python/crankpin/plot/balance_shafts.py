"""Balance shafts: what turns with each before and after, below each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import inputs, labels
from crankpin.analysis.fitted_shafts import OVER_SPEED, BalanceShafts
from crankpin.plot.axes import entitle, label_x, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.style import SERIES, background, muted, series
from crankpin.plot.ticks import numeric
from crankpin.plot.words import name_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STAYS = "crankpin stays"
"""Marks the lines from before to after by their gid."""


@draw.register(BalanceShafts)
def _balance_shafts(
    result: BalanceShafts,
    ax: Axes | None = None,
    *,
    quantity: str = "moment",
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of markers
) -> Axes:
    name = inputs.one_of("quantity", quantity, OVER_SPEED)
    ax = one_panel(ax)
    entries = [each for each in result.parts() if each.quantity == name]
    rows = np.arange(len(entries))
    before, after = (
        np.array([getattr(each, when) for each in entries]) for when in ("before", "after")
    )
    entitle(ax, name_of(result.before), "with and without balance shafts")
    given = mpl.cbook.normalize_kwargs(style, Line2D)
    ax.hlines(rows, after, before, color=muted(ax, 0.4), linewidth=1.2, zorder=2, gid=STAYS)
    # What does not change is a dot in a ring.
    for values, text, size in ((before, "without shafts", 9.0), (after, "with shafts", 4.5)):
        (look,) = series(ax, 1, given)
        marks: dict[str, Any] = {"marker": "o", "markersize": size} | look | {"linestyle": ""}
        if values is before:
            marks |= {"markerfacecolor": background(ax), "markeredgewidth": 1.5}
        named = f"{label}, {text}" if label else text
        ax.plot(values, rows, gid=SERIES, label=named, clip_on=False, zorder=3, **marks)
    ax.set_yticks(rows, [f"order {each.order} {each.part}".rstrip() for each in entries])
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    numeric(ax.xaxis)
    ax.set_xlim(0.0, 1.08 * float(before.max(initial=0.0)) or 1.0)
    label_x(ax, f"{labels.NAMES[name]} over ω², {OVER_SPEED[name]}")
    legend_below(ax)
    return ax
