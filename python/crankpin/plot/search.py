"""Searches: the second-order moment that remains, over bank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin.analysis.arrangements.search import ArrangementSearch
from crankpin.plot.axes import entitle, label_x, label_y, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.style import SERIES, series
from crankpin.plot.ticks import degrees, from_zero, numeric, span

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@draw.register(ArrangementSearch)
def _search(
    result: ArrangementSearch,
    ax: Axes | None = None,
    *,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    ax = one_panel(ax)
    found = list(result)
    angles = np.array([each.bank_angle_deg for each in found])
    heights = np.array([max(each.second_order) for each in found])
    without = f"{len(found)} bank angles without backward moment, {result.hold} held"
    entitle(ax, f"V{result.cylinders}", without)
    (look,) = series(ax, 1, style)
    dots: dict[str, Any] = {"marker": "o", "markersize": 3.2} | look | {"linestyle": ""}
    ax.plot(
        angles, heights, gid=SERIES, clip_on=False, label=label or f"V{result.cylinders}", **dots
    )
    degrees(ax.xaxis)
    span(ax, result.window_deg)
    numeric(ax.yaxis)
    from_zero(ax, float(ax.dataLim.y1) if found else 0.0)
    label_x(ax, "bank angle")
    label_y(ax, "larger second-order moment, over m·r·ω²·aₙ·spacing")
    legend_below(ax)
    return ax
