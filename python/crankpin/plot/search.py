"""Searches: the second-order moment that remains, over bank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin.analysis.search import ArrangementSearch
from crankpin.plot._old import COLOURS, degrees, dress, entitle, from_zero, given_or_new
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@draw.register(ArrangementSearch)
def _search(result: ArrangementSearch, ax: Axes | None = None) -> Axes:
    ax = given_or_new(ax)
    found = list(result)
    angles = np.array([each.bank_angle_deg for each in found])
    heights = np.array([max(each.second_order) for each in found])
    ax.plot(angles, heights, linestyle="", marker="o", markersize=3.2, color=COLOURS[0])
    dress(ax)
    degrees(ax, np.array(result.window_deg))
    from_zero(ax, float(heights.max(initial=0.0)))
    ax.set_xlabel(f"bank angle, {result.hold} held")
    ax.set_ylabel("larger second-order moment, over m·r·ω²·aₙ·spacing")
    entitle(ax, f"V{result.cylinders}", f"{len(found)} bank angles without backward moment")
    return ax
