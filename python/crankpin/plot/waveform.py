"""Waveforms: curves over crank angle, of one engine or at every point of a sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.layout_engine import ConstrainedLayoutEngine

from crankpin._support import labels
from crankpin.analysis.sweep_waveform import SweepWaveform
from crankpin.analysis.waveform import Waveform
from crankpin.plot._old import (
    COLOURS,
    GREY,
    by_component,
    checked,
    degrees,
    dress,
    entitle,
    given_or_new,
    name_of,
    number,
    panels_of,
    plain_text,
    say_zero,
)
from crankpin.plot.curves import curves_of, explain, words_of
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


@draw.register(Waveform)
def _waveform(result: Waveform, ax: Axes | None = None, *, quantity: str = "moment") -> Axes:
    kind = checked(quantity)
    values = by_component(getattr(result, kind), kind)
    ax = given_or_new(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
    for k, (name, colour) in enumerate(zip(labels.COMPONENTS[kind], COLOURS, strict=False)):
        # A curve under another one stays visible at its sides.
        ax.plot(result.theta_deg, values[:, k], color=colour, label=name, linewidth=2.6 - 0.9 * k)
    dress(ax)
    degrees(ax, result.theta_deg)
    ax.set_xlabel("crank angle θ")
    ax.set_ylabel(f"{labels.NAMES[kind]}, {labels.UNITS[kind]}")
    if not values.any():
        ax.set_ylim(-1.0, 1.0)
        ax.set_yticks([0.0])
        say_zero(ax)
    entitle(ax, name_of(result.engine), f"{number(result.rpm)} rpm, {_summed(result, kind)}")
    return ax


@draw.register(SweepWaveform)
def _sweep_waveform(
    result: SweepWaveform,
    ax: Any = None,  # noqa: ANN401 - an array of axes
    *,
    quantity: str = "moment",
) -> NDArray[Any]:
    kind, sweep, theta = checked(quantity), result.sweep, result.theta_deg
    values = np.moveaxis(by_component(getattr(result, kind), kind), -2, 0)
    words, dims = words_of(sweep), list(sweep.coords)
    curves = curves_of(sweep, dims)
    axes = labels.COMPONENTS[kind]
    if ax is None:
        figure, panels = plt.subplots(
            1,
            len(axes),
            figsize=(4.6 * len(axes) + (2.0 if len(axes) == 1 else 0.0), 4.2),
            sharey=True,
            squeeze=False,
            layout=ConstrainedLayoutEngine(w_pad=0.08),
        )
        title = "\n".join([words.title, words.subtitle(kind), _summed(result, kind)])
        figure.suptitle(plain_text(title), x=0.012, ha="left", fontsize=12)
    else:
        panels = panels_of(ax, (1, len(axes)))
        figure = panels[0, 0].get_figure(root=True)
    for column, axis in enumerate(axes):
        panel = panels[0, column]
        panel.set_title(axis, loc="left", fontsize=10, color=GREY)
        panel.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
        for curve in curves:
            panel.plot(theta, values[(slice(None), *curve.place, column)], zorder=3, **curve.style)
        dress(panel)
        degrees(panel, theta)
        panel.set_xlabel("crank angle θ")
        if not values[..., column].any():
            say_zero(panel)
    panels[0, 0].set_ylabel(f"{labels.NAMES[kind]}, {labels.UNITS[kind]}")
    if not values.any():
        panels[0, 0].set_ylim(-1.0, 1.0)
        panels[0, 0].set_yticks([0.0])
    if ax is None:
        explain(figure, panels, sweep, dims, curves, words, marked=False)
    drawn: NDArray[Any] = panels[0]
    return drawn


def _summed(result: Waveform | SweepWaveform, kind: str) -> str:
    if result.orders is None:
        return "exact kinematics"
    text = labels.orders_text(result.orders)
    bound = getattr(result.error_bound, "torque" if kind == "crank_torque" else kind)
    if not bound:
        return text
    return f"{text} (the rest ≤ {number(float(f'{bound:.2g}'))} {labels.UNITS[kind]})"
