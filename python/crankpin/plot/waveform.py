"""Waveforms: curves over crank angle, orbits, and the waveforms of a sweep."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.drawing import picture
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balance import Balance
from crankpin.analysis.sweeps.waveform import SweepWaveform
from crankpin.analysis.waveform import Waveform
from crankpin.plot.curves import bundle_of, colour_scale
from crankpin.plot.layout import (
    Drawn,
    add_legend,
    axes_or_new,
    label_y,
    make_panels,
    note_zero,
    set_title,
)
from crankpin.plot.painter import draw_curves, x_axis, zero_line
from crankpin.plot.plane import label_plane, plane_vector, trace
from crankpin.plot.rows import words_of
from crankpin.plot.style import DISTINCT, SERIES, count_series, series
from crankpin.plot.ticks import numeric
from crankpin.plot.words import (
    by_component,
    drawn_quantity,
    joined,
    loads_of,
    nonzero_in,
    number,
    series_names,
    series_of,
    summed,
    with_unit,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from numpy.typing import NDArray


MEAN = "crankpin mean"
"""Name of the line at the mean of a torque."""


def orbit(
    result: Waveform,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the tip of a force or moment, with crank angles and the direction marked."""
    name = plane_vector(quantity, result)
    ax = axes_or_new(ax)
    where = f"{QUANTITIES[name].words}, {number(result.rpm)} rpm, {summed(result, name)}"
    where = joined(where, loads_of(result, name))
    set_title(ax, labels.name_of(result.engine), where)
    text = label or labels.name_of(result.engine)
    trace(ax, result.theta_deg, [getattr(result, name)], [text], style)
    label_plane(ax, name)
    add_legend(ax)
    return ax


# --- sweep waveform ------------------------------------------------------------------------------

WAVEFORM_KINDS = ("curves", "envelope")
BANDS = ((0.0, 1.0, 0.2, "smallest to largest"), (0.25, 0.75, 0.35, "middle half"))
"""Quantiles between which a band lies, its opacity, and its name."""


@picture.register(SweepWaveform)
def _sweep_waveform(
    result: SweepWaveform,
    ax: object = None,
    *,
    figure: object = None,
    kind: str | None = None,
    quantity: str | None = None,
    **style: object,
) -> Drawn:
    """Draw a quantity over crank angle, a panel for each axis.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on: of a force or moment the length of the vector.
    kind : {"curves", "envelope"}, optional
        ``"curves"``: a curve for each point of the sweep; ``"envelope"``: the range of all
        points, the range of their middle half, and the median. By default curves if colours and
        dashes distinguish them.
    quantity : str, optional
        ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``; by default the moment, or
        else the first that is not zero.
    **style : dict, optional
        ``label``, put before the names in the legend; colour, line width and other properties
        of matplotlib lines.

    Returns
    -------
    matplotlib.axes.Axes or ndarray of Axes
        The panels, (1, 2), of torque (1, 1); with ``ax`` the axes given.

    Examples
    --------
    >>> import crankpin as cp
    >>> s = cp.sweep(cp.Engine.preset("v6-60"), rpm=5000, rod_ratio=[0.25, 0.3, 0.35])
    >>> s.waveform().plot(quantity="moment").shape
    (1, 2)
    """
    name = drawn_quantity(quantity, nonzero_in(result))
    count = math.prod(len(values) for values in result.sweep.coords.values())
    chosen = "curves" if count <= DISTINCT else "envelope"
    if kind is not None:
        chosen = inputs.one_of("kind", kind, WAVEFORM_KINDS)
    values, columns = np.asarray(getattr(result, name)), list(QUANTITIES[name].components)
    if ax is not None and name in PLANE_VECTORS:
        values, columns = np.linalg.norm(values, axis=-1, keepdims=True), ["length of the vector"]
    else:
        values = by_component(values, name)
    draw_panels = _curves if chosen == "curves" else _envelope
    words = words_of(result.sweep)
    points = f"{count} points of a sweep" if chosen == "envelope" else ""
    panels = make_panels(ax, figure, 1, len(columns), row_height=0.75, sharey=True)
    panels.name_columns(columns)
    handles = draw_panels(panels.axes, result, values, style)
    for k, panel in enumerate(panels.axes.flat):
        dress(panel, result.theta_deg)
        if not values[..., k].any():
            note_zero(panel)
    _limit(panels.axes[0, 0], values)
    label_y(panels.axes[0, 0], with_unit(name))
    column = columns[0] if panels.single else ""
    how = joined(summed(result, name), column, points)
    panels.set_title(words.title, words.subtitle(name), how)
    panels.add_legend(handles, words.common if chosen == "curves" else "")
    return panels.drawn


def _curves(
    panels: NDArray[Any], result: SweepWaveform, values: NDArray[np.float64], style: dict[str, Any]
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
    panels: NDArray[Any], result: SweepWaveform, values: NDArray[np.float64], style: dict[str, Any]
) -> list[Any]:
    """Draw bands of quantiles over all points, and the median; return the entries of a legend."""
    label = style.get("label") or ""
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
                label=joined(label, text),
            )
            for low, high, opacity, text in BANDS
        ]
        text = joined(label, "median")
        median = np.quantile(heights, 0.5, axis=0)
        handles += panel.plot(result.theta_deg, median, gid=SERIES, label=text, **look)
    return handles


def dress(ax: Axes, theta_deg: NDArray[np.float64]) -> None:
    """Let axes show crank angles, and a line at zero."""
    zero_line(ax)
    x_axis(ax, "crank angle θ", theta_deg, by_angle=True)
    numeric(ax.yaxis)


def _limit(ax: Axes, values: NDArray[np.float64]) -> None:
    """Remove the scale of axes with zeros only, which would mislead."""
    if not values.any():
        ax.set_ylim(-1.0, 1.0)
        ax.set_yticks([0.0])


# --- waveform ------------------------------------------------------------------------------------


@picture.register(Waveform)
def _waveform(
    result: Waveform,
    ax: Axes | None = None,
    *,
    kind: str = "curves",
    quantity: str | None = None,
    **style: object,
) -> Axes:
    """Draw a quantity over crank angle, or the curve that its tip traces.

    Parameters
    ----------
    kind : {"curves", "orbit"}, default "curves"
        ``"curves"``: a curve over crank angle for each axis; ``"orbit"``: the tip of force or
        moment in the cross-section plane, arrows in its direction, a dot every 30°.
    quantity : str, optional
        ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``; by default the moment, or
        else the first that is not zero.
    **style : dict, optional
        ``label``, for a legend of several results on the same axes; colour, line width and
        other properties of matplotlib lines.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> ax = v6.waveform(rpm=6000).plot(label="60°")
    >>> ax = v6.with_bank_angle(90, hold="pins").waveform(rpm=6000).plot(ax, label="90°")
    """
    return _KINDS[inputs.one_of("kind", kind, _KINDS)](result, ax, quantity=quantity, **style)


def curves(
    result: Waveform,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw a quantity over crank angle, a curve for each axis."""
    name = drawn_quantity(quantity, nonzero_in(result))
    drawn = series_of(result, name)
    values = np.concatenate(
        [by_component(result.read(quantity), name) for quantity in drawn], axis=-1
    )
    ax = axes_or_new(ax)
    where = joined(f"{number(result.rpm)} rpm", summed(result, name), loads_of(result, name))
    set_title(ax, labels.name_of(result.engine), where)
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    first = not count_series(ax)
    columns = dict(zip(series_names(drawn, label), values.T, strict=True))
    whole, *_ = draw_curves(ax, result.theta_deg, columns, style)
    if len(drawn) > 1:
        balance = Balance(result.engine, result.rpm, result._request.at_orders((1,)))
        look: dict[str, Any] = {"color": whole.get_color(), "linewidth": 0.8, "linestyle": ":"}
        text = joined(label or "", "mean")
        ax.axhline(getattr(balance, name).cycle_mean, label=text, gid=MEAN, **look)
    if first:
        dress(ax, result.theta_deg)
        label_y(ax, with_unit(name))
        _limit(ax, values)
        if not values.any():
            note_zero(ax)
    add_legend(ax)
    return ax


_KINDS: dict[str, Callable[..., Axes]] = {"curves": curves, "orbit": orbit}
