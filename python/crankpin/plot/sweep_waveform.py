"""Waveforms at every point of a sweep: curves, or, if they are many, their envelope."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import inputs
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.sweeps.waveform import SweepWaveform
from crankpin.plot.axes import (
    check_one_place,
    entitle,
    entitle_figure,
    head,
    label_x,
    label_y,
    many_panels,
    one_panel,
    say_zero,
)
from crankpin.plot.bundle import bundle_of, colour_scale
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import figure_legend, legend_below
from crankpin.plot.rows import words_of
from crankpin.plot.style import MOST_TOLD_APART, SERIES, muted, series
from crankpin.plot.ticks import degrees, numeric, span
from crankpin.plot.words import by_component, summed, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

KINDS = ("curves", "envelope")
BANDS = ((0.0, 1.0, 0.2, "smallest to largest"), (0.25, 0.75, 0.35, "middle half"))
"""Quantiles between which a band lies, its opacity, and its name."""


@draw.register(SweepWaveform)
def _sweep_waveform(
    result: SweepWaveform,
    ax: Any = None,  # noqa: ANN401 - checked
    *,
    figure: Any = None,  # noqa: ANN401 - checked
    kind: str | None = None,
    quantity: str = "moment",
    **style: Any,  # noqa: ANN401 - of lines
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    check_one_place(ax, figure)
    name = inputs.one_of("quantity", quantity, QUANTITIES)
    count = math.prod(len(values) for values in result.sweep.coords.values())
    chosen = "curves" if count <= MOST_TOLD_APART else "envelope"
    if kind is not None:
        chosen = inputs.one_of("kind", kind, KINDS)
    values, columns = np.asarray(getattr(result, name)), list(QUANTITIES[name].components)
    if ax is not None and name in PLANE_VECTORS:
        values, columns = np.linalg.norm(values, axis=-1, keepdims=True), ["length of the vector"]
    else:
        values = by_component(values, name)
    draw_panels = _curves if chosen == "curves" else _envelope
    of_lines = mpl.cbook.normalize_kwargs(style, Line2D)
    words = words_of(result.sweep)
    points = f"{count} points of a sweep" if chosen == "envelope" else ""
    if ax is not None:
        ax = one_panel(ax)
        what = ", ".join(filter(None, [summed(result, name), columns[0], points]))
        entitle(ax, words.title, words.subtitle(name), what)
        draw_panels(np.array([[ax]]), result, values, of_lines)
        _dress(ax, result, values)
        label_y(ax, with_unit(name))
        legend_below(ax, words.common if chosen == "curves" else "")
        return ax
    made = many_panels(figure, 1, len(columns), row_height=0.75, sharey=True)
    for panel, axis in zip(made.axes.flat, columns, strict=True):
        head(panel, axis)
    handles = draw_panels(made.axes, result, values, of_lines)
    for k, panel in enumerate(made.axes.flat):
        _dress(panel, result, values[..., k])
    label_y(made.axes[0, 0], with_unit(name))
    how = ", ".join(filter(None, [summed(result, name), points]))
    entitle_figure(made.figure, words.title, words.subtitle(name), how)
    figure_legend(made.figure, handles, words.common if chosen == "curves" else "")
    return made.axes


def _curves(
    panels: NDArray[Any],
    result: SweepWaveform,
    values: NDArray[np.float64],
    style: dict[str, Any],
) -> list[Any]:
    """Draw a curve for each point of the sweep; return the entries of a legend."""
    sweep = result.sweep
    sizes = np.abs(values).max(axis=(-1, -2)).reshape(-1)
    bundle = bundle_of(panels[0, 0], sweep, list(sweep.coords), words_of(sweep), sizes, style)
    for k, panel in enumerate(panels.flat):
        for curve in bundle.curves:
            heights = values[..., k][curve.place]
            panel.plot(
                result.theta_deg, heights, gid=SERIES, label=curve.name or "_", **curve.style
            )
    if bundle.scale:
        colour_scale(panels, sweep, bundle.scale)
    return list(bundle.handles)


def _envelope(
    panels: NDArray[Any],
    result: SweepWaveform,
    values: NDArray[np.float64],
    style: dict[str, Any],
) -> list[Any]:
    """Draw bands of quantiles over all points, and the median; return the entries of a legend."""
    label = style.get("label")
    handles: list[Any] = []
    for k, panel in enumerate(panels.flat):
        heights = values[..., k].reshape(-1, len(result.theta_deg))
        (look,) = series(panel, 1, style)
        handles = [
            panel.fill_between(
                result.theta_deg,
                *np.quantile(heights, (low, high), axis=0),
                color=look["color"],
                alpha=opacity,
                linewidth=0.0,
                label=", ".join(filter(None, [label, text])),
            )
            for low, high, opacity, text in BANDS
        ]
        text = ", ".join(filter(None, [label, "median"]))
        median = np.quantile(heights, 0.5, axis=0)
        handles += panel.plot(result.theta_deg, median, gid=SERIES, label=text, **look)
    return handles


def _dress(ax: Axes, result: SweepWaveform, values: NDArray[np.float64]) -> None:
    ax.axhline(0.0, color=muted(ax, 0.35), linewidth=0.8, zorder=1)
    degrees(ax.xaxis)
    span(ax, result.theta_deg)
    numeric(ax.yaxis)
    label_x(ax, "crank angle θ")
    if not values.any():
        ax.set_ylim(-1.0, 1.0)
        ax.set_yticks([0.0])
        say_zero(ax)
