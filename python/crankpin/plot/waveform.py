"""Waveforms: curves over crank angle, and orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from crankpin._support import inputs, labels
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.waveform import Waveform
from crankpin.plot.axes import entitle, label_x, label_y, one_panel, say_zero
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.orbit import orbit
from crankpin.plot.style import SERIES, count_series, muted, series
from crankpin.plot.ticks import degrees, numeric, span
from crankpin.plot.words import by_component, number, series_names, summed, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@draw.register(Waveform)
def _waveform(
    result: Waveform,
    ax: Axes | None = None,
    *,
    kind: str = "curves",
    **options: Any,  # noqa: ANN401 - of the kind
) -> Axes:
    return _KINDS[inputs.one_of("kind", kind, _KINDS)](result, ax, **options)


def curves(
    result: Waveform,
    ax: Axes | None = None,
    *,
    quantity: str = "moment",
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    """Draw a quantity over crank angle, a curve for each axis."""
    name = inputs.one_of("quantity", quantity, QUANTITIES)
    values = by_component(getattr(result, name), name)
    ax = one_panel(ax)
    where = f"{number(result.rpm)} rpm, {summed(result, name)}"
    entitle(ax, labels.name_of(result.engine), where)
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    first = not count_series(ax)
    if first:
        ax.axhline(0.0, color=muted(ax, 0.35), linewidth=0.8, zorder=1)
    styles = series(ax, values.shape[1], style)
    for k, text in enumerate(series_names(name, label)):
        ax.plot(result.theta_deg, values[:, k], gid=SERIES, label=text, **styles[k])
    degrees(ax.xaxis)
    if first:
        span(ax, result.theta_deg)
    numeric(ax.yaxis)
    label_x(ax, "crank angle θ")
    label_y(ax, with_unit(name))
    if first and not values.any():
        ax.set_ylim(-1.0, 1.0)
        ax.set_yticks([0.0])
        say_zero(ax)
    legend_below(ax)
    return ax


_KINDS = {"curves": curves, "orbit": orbit}
