"""Balances: bars, one for each order and axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import labels
from crankpin.analysis.balance import Balance
from crankpin.analysis.source import PLANE_VECTORS, shown_orders
from crankpin.plot._old import (
    COLOURS,
    FEW_BARS,
    GREY,
    by_component,
    checked,
    dress,
    entitle,
    from_zero,
    given_or_new,
    name_of,
    number,
)
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@draw.register(Balance)
def _balance(result: Balance, ax: Axes | None = None, *, quantity: str = "moment") -> Axes:
    kind = checked(quantity)
    drawn = getattr(result, kind)
    ax = given_or_new(ax)
    shown, omitted = shown_orders(result.source, kind)
    peaks = by_component(drawn.peak_xy if kind in PLANE_VECTORS else drawn.peak, kind)[list(shown)]
    places = np.arange(len(shown))
    count = len(labels.COMPONENTS[kind])
    width = 0.76 / count
    for k, (name, colour) in enumerate(zip(labels.COMPONENTS[kind], COLOURS, strict=False)):
        offset = (k - (count - 1) / 2) * width
        bars = ax.bar(places + offset, peaks[:, k], 0.94 * width, color=colour, label=name)
        if peaks.size <= FEW_BARS:
            # Exact zeros are labelled: a missing bar could be a small one.
            texts = [number(float(f"{peak:.4g}")) for peak in peaks[:, k]]
            ax.bar_label(bars, texts, padding=2, fontsize=8, color=GREY)
    dress(ax)
    ax.grid(visible=False, axis="x")
    ax.tick_params(axis="x", length=0)
    ax.set_xticks(places, [str(result.orders[place]) for place in shown])
    note = labels.not_shown(omitted)
    ax.set_xlabel("order (multiples of crank speed)" + (f"\n{note}" if note else ""))
    ax.set_ylabel(f"peak {labels.NAMES[kind]}, {labels.UNITS[kind]}")
    from_zero(ax, float(peaks.max(initial=0.0)))
    how = ", orders given" if result.request.orders is not None else ""
    how += "" if result.spectrum is None else ", spectrum given"
    entitle(ax, name_of(result.engine), f"{number(result.rpm)} rpm{how}")
    return ax
