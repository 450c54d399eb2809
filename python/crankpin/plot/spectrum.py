"""Spectra: a stem for each order and axis, over a numeric axis of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.transforms import ScaledTranslation

from crankpin._support import inputs, labels
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.plot.axes import entitle, label_x, label_y, one_panel, refuse_figure
from crankpin.plot.legend import legend_below
from crankpin.plot.style import SERIES, background, count_series, series
from crankpin.plot.ticks import from_zero, numeric
from crankpin.plot.words import by_component, number, series_names, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from crankpin.analysis.balance import Balance

MARKERS = "os^Dv"
BESIDE = 6.0
"""Points between stems of the same order."""
ZEROS = "crankpin zeros"
"""Marks the hollow circles of a series by their gid."""
ZERO = "exactly zero"


def spectrum(
    result: Balance,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str = "moment",
    log: bool = False,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    """Draw peaks over order; exact zeros as hollow circles on the axis."""
    name = inputs.one_of("quantity", quantity, QUANTITIES)
    logarithmic = inputs.flag("log", log)
    drawn = getattr(result, name)
    refuse_figure(figure, "spectrum")
    ax = one_panel(ax)
    orders = np.array(result.orders, dtype=np.float64)
    peaks = by_component(drawn.peak_xy if name in PLANE_VECTORS else drawn.peak, name)
    how = "" if result.request.orders is None else ", orders given"
    how += "" if result.spectrum is None else ", spectrum given"
    entitle(ax, labels.name_of(result.engine), f"{number(result.rpm)} rpm{how}")
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    styles = series(ax, peaks.shape[1], style)
    for k, text in enumerate(series_names(name, label)):
        _stems(ax, orders, peaks[:, k], text, styles[k])
    _beside_each_other(ax)
    _scale(ax, logarithmic=logarithmic)
    label_x(ax, "order (multiples of crank speed)")
    label_y(ax, with_unit(name, peak=True))
    legend_below(ax, last=ZERO)
    return ax


def _stems(ax: Axes, orders: Any, peaks: Any, text: str, style: dict[str, Any]) -> None:  # noqa: ANN401
    """Draw one series: a line up to each peak, a marker there, a hollow circle for zero."""
    along = np.repeat(orders, 3)
    up = np.stack([np.zeros_like(peaks), peaks, np.full_like(peaks, np.nan)], axis=1).ravel()
    of_series: dict[str, Any] = {
        "marker": MARKERS[count_series(ax) % len(MARKERS)],
        "markersize": 5.0,
    }
    of_series |= style
    of_series["markevery"] = slice(1, None, 3)
    (line,) = ax.plot(along, up, gid=SERIES, label=text, zorder=2.5, **of_series)
    zeros = orders[peaks == 0.0]
    known = ZERO in ax.get_legend_handles_labels()[1]
    (hollow,) = ax.plot(
        zeros,
        np.zeros_like(zeros),
        linestyle="",
        marker="o",
        markersize=5.0,
        markeredgecolor=line.get_color(),
        markerfacecolor=background(ax),
        transform=ax.get_xaxis_transform(),
        clip_on=False,
        zorder=3,
        gid=ZEROS,
        label=ZERO if zeros.size and not known else "",
    )
    # The layout would make room for a line without points at the figure's corner.
    hollow.set_in_layout(bool(zeros.size))


def _of(ax: Axes, gid: str) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() == gid]


def _beside_each_other(ax: Axes) -> None:
    """Shift the stems of all series on the axes, so that those of an order stand about it."""
    drawn, hollow = _of(ax, SERIES), _of(ax, ZEROS)
    to_inches = ax.get_figure(root=False).dpi_scale_trans  # type: ignore[union-attr]
    for k, (line, zeros) in enumerate(zip(drawn, hollow, strict=True)):
        points = BESIDE * (k - 0.5 * (len(drawn) - 1))
        shift = ScaledTranslation(points / 72.0, 0.0, to_inches)
        line.set_transform(ax.transData + shift)
        zeros.set_transform(ax.get_xaxis_transform() + shift)


def _scale(ax: Axes, *, logarithmic: bool) -> None:
    along = np.concatenate([line.get_xdata() for line in _of(ax, SERIES)])
    peaks = np.concatenate([np.asarray(line.get_ydata())[1::3] for line in _of(ax, SERIES)])
    ax.set_xlim(0.0, float(along.max(initial=0.0)) + 1.0)
    numeric(ax.xaxis, whole=True)
    above = peaks[peaks > 0.0]
    if logarithmic and above.size:
        ax.set_yscale("log", nonpositive="clip")
        ax.set_ylim(0.3 * float(above.min()), 3.0 * float(above.max()))
    else:
        numeric(ax.yaxis)
        from_zero(ax, float(peaks.max(initial=0.0)))
