"""Residual with actuators: rms values with and without them, at places or over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin._support.drawing import picture
from crankpin.analysis.mounts.active import Cancellation
from crankpin.plot.layout import add_legend, axes_or_new, label_x, label_y, set_title
from crankpin.plot.style import SERIES, muted, series
from crankpin.plot.ticks import numeric, span
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UNCHANGED = "as without"


@picture.register(Cancellation)
def _cancellation(result: Cancellation, ax: Axes | None = None, **style: object) -> Axes:
    """Draw what is left of the rms values: at places, or over speed.

    Parameters
    ----------
    **style : dict, optional
        Properties of matplotlib bars or lines.
    """
    ax = axes_or_new(ax)
    places = [*result.receivers, *result._elsewhere()]
    ratios = []
    for place in places:
        before, after = result._rms(place, None)
        ratio = np.full(np.shape(before), np.nan)
        np.divide(after, before, out=ratio, where=before > 0.0)
        ratios.append(ratio)
    names = [plain_text(name) for name, *_ in places]
    orders = labels.orders_text(result.orders)
    at = "" if result.before.dims else f" {labels.at_speed(float(result.before.rpm))}"
    set_title(ax, labels.name_of(result.before.powertrain.engine), f"{orders} cancelled{at}")
    line: dict[str, Any] = {"color": muted(ax), "linewidth": 1.0, "linestyle": "--", "gid": ""}
    if result.before.dims:
        speeds = np.asarray(result.before.rpm)
        for name, ratio, look in zip(names, ratios, series(ax, len(places), style), strict=True):
            ax.plot(speeds, ratio, gid=SERIES, label=name, **look)
        ax.axhline(1.0, label=UNCHANGED, **line)
        numeric(ax.xaxis)
        numeric(ax.yaxis)
        span(ax, speeds)
        ax.set_ylim(bottom=0.0)
        label_x(ax, "speed, rpm")
        label_y(ax, "rms, with over without actuators")
        add_legend(ax, last=UNCHANGED)
        return ax
    rows = np.arange(len(places))
    for k, look in zip(range(2), series(ax, 2, style), strict=True):
        is_target = np.array([(k == 0) == (row < len(result.receivers)) for row in rows])
        bars = {"color": look["color"], "label": ("minimised", "elsewhere")[k]}
        ax.barh(rows[is_target], np.array(ratios)[is_target], 0.7, gid=SERIES, **bars)
    ax.axvline(1.0, label=UNCHANGED, **line)
    numeric(ax.xaxis)
    largest = float(np.nanmax([1.0, *ratios]))
    ax.set_xlim(0.0, 1.08 * largest)
    ax.set_yticks(rows, names)
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(len(places) - 0.5, -0.5)
    label_x(ax, "rms, with over without actuators")
    add_legend(ax, last=UNCHANGED)
    return ax
