"""Residual with actuators: rms values with and without them, at places or over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin._support.drawing import picture
from crankpin.analysis.mounts.active import Cancellation
from crankpin.plot.layout import add_legend, axes_or_new, set_title
from crankpin.plot.painter import draw_curves, name_rows, x_axis, y_axis
from crankpin.plot.style import SERIES, muted, series

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UNCHANGED = "as without"
RATIO = "rms, with over without actuators"


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
    names = [name for name, *_ in places]
    orders = labels.orders_text(result.orders)
    at = "" if result.before.dims else f" {labels.at_speed(float(result.before.rpm))}"
    set_title(ax, labels.name_of(result.before.powertrain), f"{orders} cancelled{at}")
    line: dict[str, Any] = {"color": muted(ax), "linewidth": 1.0, "linestyle": "--", "gid": ""}
    if result.before.dims:
        speeds = np.asarray(result.before.rpm)
        draw_curves(ax, speeds, dict(zip(names, ratios, strict=True)), style)
        ax.axhline(1.0, label=UNCHANGED, **line)
        x_axis(ax, "speed, rpm", speeds)
        y_axis(ax, RATIO)
        ax.set_ylim(bottom=0.0)
        add_legend(ax, last=UNCHANGED)
        return ax
    rows = np.arange(len(places))
    for k, look in zip(range(2), series(ax, 2, style), strict=True):
        is_target = np.array([(k == 0) == (row < len(result.receivers)) for row in rows])
        bars = {"color": look["color"], "label": ("minimised", "elsewhere")[k]}
        ax.barh(rows[is_target], np.array(ratios)[is_target], 0.7, gid=SERIES, **bars)
    ax.axvline(1.0, label=UNCHANGED, **line)
    x_axis(ax, RATIO)
    ax.set_xlim(0.0, 1.08 * float(np.nanmax([1.0, *ratios])))
    name_rows(ax, names)
    add_legend(ax, last=UNCHANGED)
    return ax
