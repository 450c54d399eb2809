"""Bob weights: what stays of order 1 over the balance factor."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balancing.bob_weight import BobWeight
from crankpin.plot.axes import entitle, label_x, label_y, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.marks import ring, write
from crankpin.plot.style import SERIES, count_series, foreground, muted, series
from crankpin.plot.ticks import from_zero, numeric
from crankpin.plot.words import in_degrees

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS = 201


@draw.register(BobWeight)
def _bob_weight(
    result: BobWeight,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    name = _chosen(result, quantity)
    ax = one_panel(ax)
    if label is None and count_series(ax):
        label = labels.name_of(result.before)
    lines = result.straight(name)
    end = max(1.0, result.factor, *(line.factor for line in lines))
    # Both half axes have corners at these factors.
    corners = [line.factor for line in lines] + [result.least(name) or 0.0, result.factor]
    factors = np.unique([*np.linspace(0.0, end, POINTS), *corners])
    stays = result.stays(name, factors)
    own = result.stays(name)
    entitle(ax, labels.name_of(result.before), f"{QUANTITIES[name].words} of order 1 over ω²")
    curves = {"longest": stays.major, "shortest": np.abs(stays.minor)}
    for (text, values), look in zip(curves.items(), series(ax, 2, style), strict=True):
        full = f"{label}: {text}" if label else text
        ax.plot(factors, values, gid=SERIES, label=full, **look)
    ax.axvline(result.factor, color=muted(ax, 0.5), linewidth=0.8, zorder=1, gid="crankpin own")
    numeric(ax.xaxis)
    numeric(ax.yaxis)
    ax.set_xlim(0.0, end)
    drawn = [line.get_ydata() for line in ax.lines if line.get_gid() == SERIES]
    from_zero(ax, max(float(np.max(values)) for values in drawn))
    x = np.array([result.factor, result.factor])
    ring(ax, x, np.array([own.major, abs(own.minor)]), foreground(ax), "o", "this factor")
    if lines:
        x = np.array([line.factor for line in lines])
        ring(ax, x, np.zeros_like(x), foreground(ax), "D", "straight line, with its direction")
        for line in lines:
            write(ax, line.factor, 0.0, in_degrees(round(line.direction_deg, 1)))
    label_x(ax, "balance factor")
    label_y(ax, f"half axes, {QUANTITIES[name].unit_over_square}")
    legend_below(ax)
    return ax


def _chosen(result: BobWeight, quantity: object) -> str:
    """Return the quantity given, or the force, or the moment if there is no force."""
    if quantity is not None:
        return inputs.one_of("quantity", quantity, PLANE_VECTORS)
    return "force" if result.stays("force", 0.0).major > 0.0 else "moment"
