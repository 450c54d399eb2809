"""Balances: spectra, ellipses of each order, and the choice of the kind of picture."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.transforms import ScaledTranslation

from crankpin._support import inputs, labels
from crankpin._support.drawing import picture
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balance import Balance
from crankpin.plot.layout import (
    Drawn,
    Kinds,
    add_legend,
    axes_or_new,
    draw_kind,
    label_x,
    label_y,
    note_zero,
    reject_figure,
    set_panel_title,
    set_title,
)
from crankpin.plot.phasors import phasors
from crankpin.plot.plane import (
    arrow_at,
    label_panels,
    label_plane,
    make_plane_panels,
    plane_vector,
    scale_plane,
)
from crankpin.plot.rows import largest
from crankpin.plot.style import MARKERS, SERIES, count_series, hollow, series
from crankpin.plot.ticks import from_zero, log_scale, numeric
from crankpin.plot.words import (
    drawn_quantity,
    joined,
    loads_of,
    nonzero_in,
    number,
    series_names,
    series_of,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.by_order import OrderBalance


STEM_DISTANCE = 6.0
"""Points between stems of the same order."""
ZEROS = "crankpin zeros"
"""Marks the hollow circles of a series by their gid."""
ZERO = "exactly zero"
OVER_ORDER = "order (multiples of crank speed)"


def spectrum(
    result: Balance,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str | None = None,
    log: bool = False,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw peaks over order; exact zeros as hollow circles on the axis."""
    name = drawn_quantity(quantity, nonzero_in(result))
    logarithmic = inputs.flag("log", log)
    drawn = series_of(result, name)
    reject_figure(figure, "spectrum")
    ax = axes_or_new(ax)
    peaks = (
        result.read(name, "peak_xy")
        if name in PLANE_VECTORS
        else np.stack([result.read(quantity, "peak") for quantity in drawn], axis=-1)
    )
    orders, note = np.array(result.orders, dtype=np.float64), ""
    orders_given = result._request.orders is not None
    if not orders_given:
        # Gas torque declines slowly: the few orders that can be seen would have no room.
        least = labels.MATTERS if len(drawn) > 1 and not logarithmic else labels.NEGLIGIBLE
        seen = np.flatnonzero(peaks.max(axis=1) > least * peaks.max(initial=0.0))
        if seen.size and seen[-1] + 1 < len(orders):
            orders, peaks = orders[: seen[-1] + 1], peaks[: seen[-1] + 1]
            note = f"above order {orders[-1]:g}: below {least:g} of the largest"
    how = "orders given" if orders_given else ""
    where = joined(f"{number(result.rpm)} rpm", how, loads_of(result, name))
    set_title(ax, labels.name_of(result.engine), where, note)
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    styles = series(ax, peaks.shape[1], style)
    for k, text in enumerate(series_names(drawn, label)):
        stems(ax, orders, peaks[:, k], text, styles[k])
    beside_each_other(ax)
    scale_spectrum(ax, logarithmic=logarithmic, orders_given=orders_given)
    label_x(ax, OVER_ORDER)
    label_y(ax, with_unit(name, peak=True))
    add_legend(ax, last=ZERO)
    return ax


def stems(
    ax: Axes, orders: NDArray[Any], peaks: NDArray[Any], text: str, style: dict[str, Any]
) -> None:
    """Draw one series: a line up to each peak, a marker there, a hollow circle for zero."""
    along = np.repeat(orders, 3)
    up = np.stack([np.zeros_like(peaks), peaks, np.full_like(peaks, np.nan)], axis=1).ravel()
    look: dict[str, Any] = {"marker": MARKERS[count_series(ax) % len(MARKERS)], "markersize": 5.0}
    look |= style | {"markevery": slice(1, None, 3)}
    (line,) = ax.plot(along, up, gid=SERIES, label=text, zorder=2.5, **look)
    zeros = orders[peaks == 0.0]
    has_zero = ZERO in ax.get_legend_handles_labels()[1]
    look = {"markersize": 5.0, "transform": ax.get_xaxis_transform(), "gid": ZEROS}
    name = ZERO if zeros.size and not has_zero else ""
    hollow(ax, zeros, np.zeros_like(zeros), line.get_color(), label=name, **look)


def beside_each_other(ax: Axes) -> None:
    """Shift the stems of all series on the axes, so that those of an order stand about it."""
    # A picture of another kind on the same axes has series without circles of zeros.
    pairs = [pair for pair in pairwise(ax.lines) if pair[1].get_gid() == ZEROS]
    figure: Any = ax.get_figure(root=False)
    to_inches = figure.dpi_scale_trans
    # Half orders stand closer than whole ones: the stems of one must not reach those of the next.
    orders = np.unique(np.concatenate([line.get_xdata() for line, _ in pairs]))
    if not orders.size:
        return
    gap = np.diff(orders, prepend=0.0).min() / orders[-1]
    width = 72.0 * ax.get_window_extent().width / figure.dpi
    beside = min(STEM_DISTANCE, 0.9 * gap * width / len(pairs))
    for k, (line, zeros) in enumerate(pairs):
        points = beside * (k - 0.5 * (len(pairs) - 1))
        shift = ScaledTranslation(points / 72.0, 0.0, to_inches)
        line.set_transform(ax.transData + shift)
        zeros.set_transform(ax.get_xaxis_transform() + shift)


def scale_spectrum(ax: Axes, *, logarithmic: bool, orders_given: bool) -> None:
    """Let the axes of a spectrum begin at zero, or the vertical one be logarithmic."""
    drawn = [line for line in ax.lines if line.get_gid() == SERIES]
    along = np.concatenate([line.get_xdata() for line in drawn])
    heights = np.concatenate([line.get_ydata() for line in drawn])
    peaks = heights[heights > 0.0]
    ax.set_xlim(0.0, float(along.max(initial=0.0)) + 1.0)
    numeric(ax.xaxis, whole=True)
    if not peaks.size:
        note_zero(ax)
    if logarithmic and peaks.size:
        least = 0.0 if orders_given else labels.NEGLIGIBLE * float(peaks.max())
        log_scale(ax, max(least, float(peaks.min())), float(peaks.max()))
    else:
        numeric(ax.yaxis)
        from_zero(ax, float(peaks.max(initial=0.0)))


# --- ellipses ------------------------------------------------------------------------------------

PHASES_OF_ELLIPSE = np.linspace(0.0, 2.0 * np.pi, 181)


def ellipses(
    result: Balance,
    ax: Axes | None = None,
    figure: object = None,
    *,
    quantity: str | None = None,
    **style: object,
) -> Drawn:
    """Draw a panel for each of the largest orders, or all of them on given axes."""
    name = plane_vector(quantity, result)
    places, note = largest(result, name)
    orders = [result.orders[place] for place in places]
    where = joined(QUANTITIES[name].words, f"{number(result.rpm)} rpm", loads_of(result, name))
    if ax is not None:
        ax = axes_or_new(ax)
        set_title(ax, labels.name_of(result.engine), where, note)
        for order, look in zip(orders, series(ax, len(orders), style), strict=True):
            curve = result[order]
            ellipse(ax, curve, name, f"order {order}: {direction(curve, name)}", look)
        scale_plane(ax)
        label_plane(ax, name)
        add_legend(ax)
        return ax
    grid = make_plane_panels(figure, len(orders))
    panels = grid.axes.ravel()
    for panel, order in zip(panels, orders, strict=False):
        curve = result[order]
        ellipse(panel, curve, name, "", series(panel, 1, style)[0])
        set_panel_title(panel, f"order {order}", direction(curve, name))
        scale_plane(panel)
    if not orders:
        scale_plane(panels[0])
    along_x, along_y = QUANTITIES[name].components
    label_panels(grid, along_x, along_y, QUANTITIES[name].unit)
    scales = "each panel to its own scale; dot: θ = 0"
    grid.set_title(labels.name_of(result.engine), where, scales, note)
    return grid.axes


def ellipse(
    ax: Axes, order: OrderBalance, name: str, text: str, style: dict[str, Any]
) -> NDArray[np.complex128]:
    """Draw one ellipse, a dot where it is at θ = 0, and an arrow from there; return the curve."""
    vector = getattr(order, name)
    curve: NDArray[np.complex128] = vector.forward * np.exp(1j * PHASES_OF_ELLIPSE)
    curve = curve + vector.backward * np.exp(-1j * PHASES_OF_ELLIPSE)
    (line,) = ax.plot(curve.real, curve.imag, gid=SERIES, label=text or "_", **style)
    ax.plot(curve.real[:1], curve.imag[:1], "o", color=line.get_color(), gid="crankpin start")
    if vector.minor != 0.0:
        arrow_at(ax, curve, len(PHASES_OF_ELLIPSE) // 8, line.get_color())
    return curve


def direction(order: OrderBalance, name: str) -> str:
    """Return the direction in which an ellipse is passed."""
    minor = getattr(order, name).minor
    if minor == 0.0:
        return "straight line"
    return labels.TURNING_WORDS["forward" if minor > 0.0 else "backward"]


# --- balance -------------------------------------------------------------------------------------


DRAWN_BY_KIND: Kinds = {"spectrum": spectrum, "ellipses": ellipses, "phasors": phasors}


@picture.register(Balance)
def _balance(
    result: Balance,
    ax: object = None,
    *,
    figure: object = None,
    kind: str = "spectrum",
    quantity: str | None = None,
    orders: object = None,
    log: bool | None = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw the orders.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; by default new ones. ``"ellipses"`` draws all orders on them.
    kind : {"spectrum", "ellipses", "phasors"}, default "spectrum"
        ``"spectrum"``: peaks along (about) x and y over order, exact zeros as hollow circles,
        up to the last order that matters, or of all orders given; ``"ellipses"``: the ellipse
        that force or moment traces in each of the four largest orders, with its direction and,
        as a dot, the place at θ = 0; ``"phasors"``: what cylinders, counterweights and shafts
        add to each order, head to tail, and their sum.
    quantity : str, optional
        ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``; by default the moment, or
        else the first that is not zero.
    orders : sequence of float, optional
        Orders of ``"phasors"``; by default those given to the balance, or else 1 and 2.
    log : bool, optional
        True for a logarithmic ``"spectrum"``.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("v6-60").balance(rpm=6000)
    >>> ax = b.plot(quantity="torque", log=True, color="black")
    >>> b.plot(kind="ellipses").shape
    (2, 2)
    """
    options = {"quantity": quantity, "orders": orders, "log": log, "label": label}
    return draw_kind(DRAWN_BY_KIND, kind, result, ax, figure, **options, **style)
