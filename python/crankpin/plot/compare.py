"""Comparisons: peaks of two engines over order, and the curves of both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.font_manager import FontProperties

from crankpin._support import labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.comparison import Comparison
from crankpin.analysis.waveform import Waveform
from crankpin.plot.balance import OVER_ORDER
from crankpin.plot.layout import (
    Drawn,
    inches_of,
    label_y,
    make_panels,
    note_zero,
    points_of,
    set_panel_title,
    width_for,
)
from crankpin.plot.painter import draw_curves, x_axis, y_axis
from crankpin.plot.style import background, series, write
from crankpin.plot.ticks import from_zero
from crankpin.plot.waveform import dress
from crankpin.plot.words import drawn_quantity, loads_of, nonzero_in, number, rounded, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAR_WIDTH = 0.36
"""Width of a bar, as a part of the least distance between orders."""
SIDE_BY_SIDE = 5.0
"""Inches that two panels beside each other need."""
UPRIGHT_LINE = 8.0
"""Points that a line of upright text needs."""
ANGLES_OF_TWO_TURNS = np.arange(721.0)


@picture.register(Comparison)
def _comparison(
    result: Comparison,
    ax: Axes | None = None,
    *,
    figure: object = None,
    quantity: str | None = None,
    **style: object,
) -> Drawn:
    """Draw peaks of both engines over order, and the curves that force or moment trace.

    Above each order stands by how much it fell or rose. A torque is drawn over crank angle.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; the peaks alone then.
    quantity : str, optional
        ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``; by default the moment, or
        else the first that is not zero.
    **style : dict, optional
        Passed on to the bars, such as ``linewidth=``.

    Returns
    -------
    matplotlib.axes.Axes or ndarray of Axes
        The axes; without ``ax`` an array: (1, 2), or (2, 1) in a narrow figure.
    """
    name = drawn_quantity(quantity, nonzero_in(result.before, result.after))
    result.before._request.check(name, result.before)
    beside = width_for(figure) >= SIDE_BY_SIDE
    shape: dict[str, Any] = {"width_ratios": [3, 2]} if beside else {"height_ratios": [2, 3]}
    grid = (1, 2) if beside else (2, 1)
    panels = make_panels(ax, figure, *grid, row_height=0.75, **shape)
    bars, *curves = panels.axes.ravel()
    _bars(bars, result, name, style)
    if not panels.single:
        set_panel_title(bars, "peaks by order")
        _curves(curves[0], result, name)
    where = f"{number(result.rpm)} rpm, {_total(result, name)}"
    panels.set_title(result.title, where, loads_of(result, name))
    panels.add_legend(bars.get_legend_handles_labels()[0])
    return panels.drawn


def _total(result: Comparison, name: str) -> str:
    """Return what becomes of all orders together."""
    before, after = (getattr(balance.total, name).peak for balance in (result.before, result.after))
    kind = QUANTITIES[name]
    what = f"{'longest' if kind.planar else 'peak'} {kind.words}"
    converted = units.convert(kind.unit)
    sizes = (rounded(value * converted.factor, 4) for value in (before, after))
    values = f"{' → '.join(sizes)} {converted.unit}"
    return f"{what} {values} ({changed(before, after)})"


def changed(before: float, after: float) -> str:
    """Return by how much a peak fell or rose, in words that fit above a bar."""
    if before == after:
        return "as before"
    if before == 0.0:
        return "new"
    if after == 0.0:
        return "gone"
    change = 100.0 * (after / before - 1.0)
    if abs(change) > 999.0:
        return f"{rounded(after / before, 2)}×"
    text = rounded(change, 2) if abs(change) < 99.0 else f"{change:.3g}"
    return f"{'+' if change > 0.0 else ''}{text}\N{NO-BREAK SPACE}%".replace("-", "−")


def _bars(ax: Axes, result: Comparison, name: str, style: dict[str, Any]) -> None:
    """Draw a pair of bars for each order, and above it how it changes."""
    pairs = np.array([getattr(balance, name).peak for balance in (result.before, result.after)])
    top = float(pairs.max(initial=0.0))
    places = [k for k in range(len(result.orders)) if pairs[:, k].max() > labels.MATTERS * top]
    orders = np.array(result.orders, dtype=np.float64)[places]
    width = BAR_WIDTH * float(np.diff(orders).min(initial=1.0))
    looks = series(ax, 2)
    hatches = ("////", None)  # for print without colour
    for k, (peaks, text) in enumerate(zip(pairs[:, places], result.names, strict=True)):
        fill = {
            "color": looks[k]["color"], "hatch": hatches[k], "edgecolor": background(ax),
            "linewidth": 0.0,
        }  # fmt: skip
        ax.bar(orders + (k - 0.5) * width, peaks, 0.96 * width, label=text, **(fill | style))
    if not places:
        note_zero(ax)
    last = float(orders.max(initial=0.0)) + 1.0
    texts = [changed(*pairs[:, k].tolist()) for k in places]
    widths = [points_of(ax, text, FontProperties(size="x-small")) for text in texts]
    # The layout will take a part of the axes for labels.
    apart = float(np.diff(orders).min(initial=last)) / last
    upright = max(widths, default=0.0) > 0.8 * 72.0 * inches_of(ax) * apart
    if 72.0 * inches_of(ax) * apart < UPRIGHT_LINE:
        texts = [""] * len(texts)
    for order, k, text in zip(orders.tolist(), places, texts, strict=True):
        look = {"va": "bottom", "fontsize": "x-small", "rotation": 90.0 if upright else 0.0}
        write(ax, text, complex(order, pairs[:, k].max()), 3.0j, **look)
    ax.set_xlim(0.0, last)
    from_zero(ax, top, 1.4 if upright else 1.25)
    x_axis(ax, OVER_ORDER, whole=True)
    y_axis(ax, with_unit(name, peak=True))


def _curves(ax: Axes, result: Comparison, name: str) -> None:
    """Draw what both forces or moments trace, or both torques over crank angle."""
    both, planar = (result.before, result.after), name in PLANE_VECTORS
    # Pressure repeats with the cycle; what is left, and all forces, with the turn.
    cycle = not planar and any(b.fired and b.engine.strokes == 4 for b in both)
    theta = ANGLES_OF_TWO_TURNS if cycle else ANGLES_OF_TWO_TURNS[:361]
    for balance, label in zip(both, result.names, strict=True):
        waveform = Waveform(balance.engine, balance.rpm, theta, True, balance._request)
        if planar:
            picture(waveform, ax, kind="orbit", quantity=name, label=label)
        else:
            draw_curves(ax, theta, {label: getattr(waveform, name)}, {})
    if planar:
        _square(ax)
    else:
        dress(ax, theta)
        label_y(ax, with_unit(name))
    if legend := ax.get_legend():  # the figure's names both
        legend.remove()
    set_panel_title(ax, "over two turns" if cycle else "over a turn")


def _square(ax: Axes) -> None:
    """Give orbits a square panel that they fill; crank angles would not distinguish them."""
    for text in [*ax.texts]:
        if text.get_text():
            text.remove()
    reach = max(float(np.abs(line.get_xydata()).max(initial=0.0)) for line in ax.lines) or 1.0
    ax.set_aspect("equal", adjustable="box")
    ax.set_xlim(-1.15 * reach, 1.15 * reach)
    ax.set_ylim(-1.15 * reach, 1.15 * reach)
