"""Flywheels: torque over the cycle, and the speed that follows."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
from matplotlib.lines import Line2D

from crankpin.analysis.flywheel import Flywheel
from crankpin.plot.dispatch import picture
from crankpin.plot.layout import add_legend, check_one_place, label_x, label_y, make_panels
from crankpin.plot.style import SERIES, muted, series
from crankpin.plot.ticks import degrees, numeric, span


@picture.register(Flywheel)
def _flywheel(
    result: Flywheel,
    ax: Any = None,  # noqa: ANN401 - checked
    *,
    figure: Any = None,  # noqa: ANN401 - checked
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    check_one_place(ax, figure)
    panels = make_panels(ax, figure, 2, 1, row_height=0.55, sharex=True)
    given = mpl.cbook.normalize_kwargs(style, Line2D)
    theta = result.theta_deg
    gas = "torque" if result.engine is None else "gas"
    curves = {gas: result.torque}
    if result.engine is not None:
        curves |= {"inertia": result.inertia_torque, "sum": result.torque + result.inertia_torque}
    drawn = [(curves, result.load, "load", "torque on the crank, N·m")]
    drawn.append(({"speed": result.speed_rpm}, result.rpm + 0.0 * theta, "mean", "speed, rpm"))
    # On axes that were given, the speed alone.
    for panel, (lines, level, name, quantity) in zip(
        panels.axes[:, 0], drawn[-len(panels.axes) :], strict=True
    ):
        looks = series(panel, len(lines), given)
        for (text, values), look in zip(lines.items(), looks, strict=True):
            named = ", ".join(filter(None, [label, text]))
            panel.plot(theta, values, gid=SERIES, label=named, **look)
        thin: dict[str, Any] = {"color": muted(panel), "linewidth": 0.8, "linestyle": "--"}
        panel.plot(theta, level, gid="", label=name, **thin)
        numeric(panel.yaxis)
        label_y(panel, quantity)
        add_legend(panel)
    span(panels.axes[-1, 0], theta)
    degrees(panels.axes[-1, 0].xaxis)
    label_x(panels.axes[-1, 0], "crank angle")
    panels.set_title(result.title, f"irregularity {100.0 * result.irregularity:.3g} %")
    return panels.drawn
