"""Cylinder pressure over crank angle, and over volume."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin.model.computed_cycles import area
from crankpin.model.cycle import Cycle
from crankpin.plot.dispatch import picture
from crankpin.plot.layout import add_legend, axes_or_new, label_x, label_y, set_title
from crankpin.plot.style import SERIES, count_series, series
from crankpin.plot.ticks import degrees, from_zero, numeric, span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from crankpin.model.cylinder import Cylinder


@picture.register(Cycle)
def _cycle(
    result: Cycle,
    ax: Axes | None = None,
    *,
    cylinder: Cylinder | None = None,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    ax = axes_or_new(ax)
    first = not count_series(ax)
    name = label or labels.printable(result.name) or "pressure"
    set_title(ax, "Cylinder pressure", *([labels.printable(result.name)] if first else []))
    # The curve is closed, a period later.
    end = result.theta_deg[0] + result.period_deg
    theta = np.append(result.theta_deg[result.theta_deg < end], end)
    pressure = np.append(result.pressure[: len(theta) - 1], result.pressure[0]) / 1e5
    where = theta if cylinder is None else _swept(cylinder, theta)
    (look,) = series(ax, 1, style)
    ax.plot(where, pressure, gid=SERIES, label=name, **look)
    if cylinder is None:
        degrees(ax.xaxis)
        span(ax, theta)
        label_x(ax, "crank angle after the firing top dead centre")
    else:
        numeric(ax.xaxis)
        label_x(ax, "volume swept, cm³")
    numeric(ax.yaxis)
    highest = max(float(np.max(line.get_ydata())) for line in ax.lines if line.get_gid() == SERIES)
    from_zero(ax, highest)
    label_y(ax, "absolute pressure, bar")
    if not first:
        add_legend(ax)
    return ax


def _swept(cylinder: Cylinder, theta_deg: Any) -> Any:  # noqa: ANN401 - arrays
    """Return the volume between the piston and its highest point, cm³."""
    rod, offset = cylinder.rod_length + cylinder.crank_radius, cylinder.pin_offset
    highest = np.sqrt((rod - offset) * (rod + offset))
    return 1e6 * area(cylinder) * (highest - cylinder.position(theta_deg))
