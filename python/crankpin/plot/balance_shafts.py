"""Balance shafts: the parts of force, moment or torque with and without them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import inputs, labels
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.balancing.fitted_shafts import SHAKEN, BalanceShafts
from crankpin.plot.axes import entitle, label_x, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.named_rows import rows_for, wide_enough
from crankpin.plot.style import SERIES, background, count_series, muted, series
from crankpin.plot.ticks import numeric

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CHANGE = "crankpin change"
"""Marks the lines from without to with shafts by their gid."""


@draw.register(BalanceShafts)
def _balance_shafts(
    result: BalanceShafts,
    ax: Axes | None = None,
    *,
    quantity: str = "moment",
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of markers
) -> Axes:
    name = inputs.one_of("quantity", quantity, SHAKEN)
    ax = one_panel(ax)
    parts = [each for each in result.parts() if each.quantity == name]
    before, after = (
        np.array([getattr(each, when) for each in parts]) for when in ("before", "after")
    )
    entitle(ax, labels.name_of(result.before), "with and without balance shafts")
    if label is None and count_series(ax):
        label = labels.name_of(result.before)
    wide_enough(ax, float(np.append(before, after).max()))
    rows = rows_for(ax, [f"order {each.order} {each.part}".rstrip() for each in parts])
    ax.hlines(rows, after, before, color=muted(ax, 0.4), linewidth=1.2, zorder=2, gid=CHANGE)
    given = mpl.cbook.normalize_kwargs(style, Line2D)
    # What does not change is a dot in a ring.
    for values, text, size in ((before, "without shafts", 9.0), (after, "with shafts", 4.5)):
        (look,) = series(ax, 1, given)
        marks: dict[str, Any] = {"marker": "o", "markersize": size} | look | {"linestyle": ""}
        if values is before:
            marks |= {"markerfacecolor": background(ax), "markeredgewidth": 1.5}
        named = f"{label}, {text}" if label else text
        ax.plot(values, rows, gid=SERIES, label=named, clip_on=False, zorder=3, **marks)
    numeric(ax.xaxis)
    label_x(ax, f"{QUANTITIES[name].words} over ω², {QUANTITIES[name].unit_over_square}")
    legend_below(ax)
    return ax
