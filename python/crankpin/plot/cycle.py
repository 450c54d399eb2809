"""Pictures over a cycle: cylinder pressure, and the speed with a flywheel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels, units
from crankpin._support.drawing import picture
from crankpin._support.inputs import optional_text
from crankpin.analysis.flywheel import Flywheel
from crankpin.analysis.oscillogram import Oscillogram
from crankpin.analysis.prepared_trace import PreparedTrace
from crankpin.analysis.turning_moment import TurningMomentAreas
from crankpin.model.computed_cycles import area
from crankpin.model.cycle import Cycle
from crankpin.model.traces import Traces
from crankpin.plot.layout import Drawn, add_legend, axes_or_new, make_panels, set_title
from crankpin.plot.painter import draw_curves, highest, x_axis, y_axis
from crankpin.plot.style import count_series, muted
from crankpin.plot.words import joined, loads_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.model.cylinder import Cylinder

SIDES = ("C0", "C3")
"""Colours of areas above the mean and below it."""
FROM_FIRING = "crank angle after the firing top dead centre"
PRESSURE = units.headed("absolute pressure", "bar")


@picture.register(Cycle)
def _cycle(
    result: Cycle,
    ax: Axes | None = None,
    *,
    cylinder: Cylinder | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw pressure over crank angle, or over volume.

    Parameters
    ----------
    cylinder : Cylinder, optional
        Cylinder with a bore, to draw pressure over the volume swept.
    **style : dict, optional
        Properties of the line, as matplotlib takes them.
    """
    ax = axes_or_new(ax)
    first = not count_series(ax)
    name = optional_text("label", label) or labels.one_line(result.name) or "pressure"
    set_title(ax, "Cylinder pressure", *([labels.one_line(result.name)] if first else []))
    # The curve is closed, a period later.
    end = result.theta_deg[0] + result.period_deg
    theta = np.append(result.theta_deg[result.theta_deg < end], end)
    pressure = np.append(result.pressure[: len(theta) - 1], result.pressure[0]) / 1e5
    where = theta if cylinder is None else _swept(cylinder, theta)
    draw_curves(ax, where, {name: pressure}, style)
    if cylinder is None:
        x_axis(ax, FROM_FIRING, theta, by_angle=True)
    else:
        x_axis(ax, units.headed("volume swept", "cm³"))
    y_axis(ax, PRESSURE, largest=highest(ax))
    if not first:
        add_legend(ax)
    return ax


@picture.register(Traces)
def _traces(
    result: Traces, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the mean pressure over crank angle, in the band of all cycles.

    Parameters
    ----------
    **style : dict, optional
        Properties of the line, as matplotlib takes them.
    """
    ax = axes_or_new(ax)
    first = not count_series(ax)
    named = labels.one_line(result.name)
    set_title(ax, "Cylinder pressure", *([named] if first and named else []))
    _band(result, ax, optional_text("label", label) or f"mean of {len(result)} cycles", style)
    add_legend(ax)
    return ax


def _band(
    result: Traces, ax: Axes, name: str, style: dict[str, object], *, is_lowest: bool = True
) -> None:
    """Draw the mean of cycles in the band of all."""
    end = result.theta_deg[0] + result.period_deg
    inside = result.theta_deg < end
    theta = np.append(result.theta_deg[inside], end)
    rows = np.column_stack([result.pressure[:, inside], result.pressure[:, :1]]) / 1e5
    _mean_in_band(ax, theta, name, rows, style)
    if is_lowest:
        x_axis(ax, FROM_FIRING, theta, by_angle=True)
    y_axis(ax, PRESSURE, largest=max(float(rows.max()), float(ax.dataLim.y1)))


def _mean_in_band(
    ax: Axes,
    theta: NDArray[np.float64],
    name: str,
    rows: NDArray[np.float64],
    style: dict[str, object],
) -> None:
    """Draw the mean of the rows of cycles, in the band of all where there are several."""
    (line,) = draw_curves(ax, theta, {name: rows.mean(axis=0)}, style)
    if len(rows) > 1:
        least, most = rows.min(axis=0), rows.max(axis=0)
        band: dict[str, Any] = {"color": line.get_color(), "alpha": 0.25, "linewidth": 0.0}
        ax.fill_between(theta, least, most, label="least to largest", **band)


@picture.register(Oscillogram)
def _oscillogram(
    result: Oscillogram, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the mean speed over crank angle, in the band of all cycles.

    Parameters
    ----------
    **style : dict, optional
        Properties of the line, as matplotlib takes them.
    """
    ax = axes_or_new(ax)
    first = not count_series(ax)
    set_title(ax, "Speed over the crank angle", *([labels.one_line(result.name)] if first else []))
    count = len(result.speed)
    name = optional_text("label", label) or f"mean of {count} cycle{'s' * (count > 1)}"
    theta = np.append(result.theta_deg, -result.theta_deg[0])
    speed = np.column_stack([result.speed, result.speed[:, :1]])
    _mean_in_band(ax, theta, name, speed, style)
    x_axis(ax, FROM_FIRING, theta, by_angle=True)
    y_axis(ax, units.headed("crank speed", "rpm"))
    add_legend(ax)
    return ax


@picture.register(PreparedTrace)
def _prepared(
    result: PreparedTrace,
    ax: object = None,
    *,
    figure: object = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw the mean as measured and prepared, in the band of all cycles, and below it the change.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for the upper panel alone; by default both are drawn in a new figure.
    """
    panels = make_panels(ax, figure, 2, 1, row_height=0.55, sharex=True)
    before, after = result.stages[0], result.traces
    pressures = panels.axes[0, 0]
    name = joined(optional_text("label", label) or "", "prepared")
    _band(after, pressures, name, style, is_lowest=panels.single)
    thin: dict[str, Any] = {"color": muted(pressures), "linewidth": 0.9, "linestyle": "--"}
    measured = before.pressure.mean(axis=0)
    pressures.plot(before.theta_deg, measured / 1e5, gid="", label="as measured", **thin)
    least = min(0.0, float(measured.min()), float(after.pressure.min())) / 1e5
    pressures.set_ylim(bottom=1.05 * least)
    add_legend(pressures)
    if len(panels.axes) > 1:
        changes = panels.axes[1, 0]
        theta = after.theta_deg
        at_these = np.interp(theta, before.theta_deg, measured, period=after.period_deg)
        change = (after.pressure.mean(axis=0) - at_these) / 1e5
        draw_curves(changes, theta, {"change": change}, style)
        changes.axhline(0.0, **thin)
        x_axis(changes, FROM_FIRING, theta, by_angle=True)
        y_axis(changes, units.headed("change", "bar"))
    names = map(units.shown, result.names[1:])
    steps = [name.partition(" (")[0].partition(": ")[0] for name in names]
    panels.set_title(f"Cylinder pressure: {result.title}", joined(*steps))
    return panels.drawn


def _swept(cylinder: Cylinder, theta_deg: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the volume between the piston and its highest point, cm³."""
    bore_area = area(cylinder)
    highest, _ = cylinder._ends
    return np.asarray(1e6 * bore_area * (highest - cylinder.position(theta_deg)))


@picture.register(Flywheel)
def _flywheel(
    result: Flywheel,
    ax: object = None,
    *,
    figure: object = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw the torque, and below it the speed, over crank angle.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for the speed alone; by default both are drawn in a new figure.
    """
    panels = make_panels(ax, figure, 2, 1, row_height=0.55, sharex=True)
    theta = result.theta_deg
    gas = "torque" if result.engine is None else "gas"
    curves = {gas: result.torque}
    if result.engine is not None:
        curves |= {"inertia": result.inertia_torque, "sum": result.torque + result.inertia_torque}
    drawn = [(curves, result.load_torque, "load", units.headed("torque on the crank", "N·m"))]
    drawn.append(
        ({"speed": result.speed_rpm}, result.rpm + 0.0 * theta, "mean", units.Text("speed, rpm"))
    )
    # On axes that were given, the speed alone.
    for panel, (lines, level, name, quantity) in zip(
        panels.axes[:, 0], drawn[-len(panels.axes) :], strict=True
    ):
        draw_curves(panel, theta, lines, style, label)
        thin: dict[str, Any] = {"color": muted(panel), "linewidth": 0.8, "linestyle": "--"}
        panel.plot(theta, level, gid="", label=name, **thin)
        if name == "load":
            _shade(panel, theta, [*lines.values()][-1] - level, level)
        else:
            _mark_extremes(panel, theta, result.speed_rpm)
        y_axis(panel, quantity)
        add_legend(panel)
    x_axis(panels.axes[-1, 0], "crank angle", theta, by_angle=True)
    irregularity = f"irregularity {100.0 * result.irregularity:.3g} %"
    panels.set_title(result.title, joined(irregularity, loads_of(result)))
    return panels.drawn


@picture.register(TurningMomentAreas)
def _areas(
    result: TurningMomentAreas, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the areas in their order, shaded, and the energy at the crossings between them.

    Parameters
    ----------
    **style : dict, optional
        Properties of the line of energy, as matplotlib takes them.
    """
    ax = axes_or_new(ax)
    crossings = np.arange(len(result.levels))
    colors = np.where(result.areas > 0.0, *SIDES)
    ax.bar(crossings[1:] - 0.5, result.areas, 1.0, color=colors, alpha=0.2, gid="")
    name = optional_text("label", label) or "energy"
    draw_curves(ax, crossings, {name: result.levels}, style, marker=".")
    _mark_extremes(ax, crossings, result.levels)
    set_title(ax, result.table.title, f"fluctuation of energy {result.energy:.4g} J")
    x_axis(ax, "crossing of torque and its mean")
    y_axis(ax, units.headed("work", "J"))
    add_legend(ax)
    return ax


def _shade(ax: Axes, x: NDArray[Any], above: NDArray[Any], level: NDArray[Any]) -> None:
    """Shade what is above a level, and what is below it."""
    for part, color in zip((above > 0.0, above < 0.0), SIDES, strict=True):
        look: dict[str, Any] = {"alpha": 0.2, "color": color, "linewidth": 0}
        ax.fill_between(x, level, level + above, where=part, interpolate=True, **look)


def _mark_extremes(ax: Axes, x: NDArray[Any], values: NDArray[Any]) -> None:
    """Mark the highest and the lowest point of a curve."""
    for k, marker, name in ((values.argmax(), "^", "fastest"), (values.argmin(), "v", "slowest")):
        ax.plot(x[k], values[k], marker, color=muted(ax), gid="", label=name)
