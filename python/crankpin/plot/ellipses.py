"""Ellipses that force or moment traces in each order, with the direction of precession."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.axes import entitle, entitle_figure, head, many_panels, one_panel
from crankpin.plot.legend import legend_below
from crankpin.plot.orders import largest
from crankpin.plot.plane import arrow_at, dress_plane, plane_vector
from crankpin.plot.style import SERIES, series
from crankpin.plot.words import number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.by_order import OrderBalance

COLUMNS = 2
PHASES = np.linspace(0.0, 2.0 * np.pi, 181)


def ellipses(
    result: Balance,
    ax: Axes | None = None,
    figure: Any = None,  # noqa: ANN401 - checked
    *,
    quantity: str = "moment",
    **style: Any,  # noqa: ANN401 - of lines
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    """Draw a panel for each of the largest orders, or all of them on given axes."""
    name = plane_vector(quantity)
    places, note = largest(result, name)
    shown = [result.orders[place] for place in places]
    where = f"{QUANTITIES[name].words}, {number(result.rpm)} rpm"
    if ax is not None:
        ax = one_panel(ax)
        entitle(ax, labels.name_of(result.engine), where, note)
        _on_one(ax, [result[order] for order in shown], name, style)
        return ax
    rows = max(1, -(-len(shown) // COLUMNS))
    made = many_panels(figure, rows, min(COLUMNS, max(1, len(shown))), row_height=0.6)
    panels = made.axes.ravel()
    for panel, order in zip(panels, shown, strict=False):
        curve = result[order]
        ellipse(panel, curve, name, "", series(panel, 1, style)[0])
        head(panel, f"order {order}\n{direction(curve, name)}")
        dress_plane(panel, name)
        panel.set(xlabel="", ylabel="")
    if not shown:
        dress_plane(panels[0], name)
        panels[0].set(xlabel="", ylabel="")
    for panel in panels[max(1, len(shown)) :]:
        panel.set_visible(False)
    along_x, along_y = QUANTITIES[name].components
    made.figure.supxlabel(f"{along_x}, {QUANTITIES[name].unit}", fontsize="medium")
    made.figure.supylabel(f"{along_y}, {QUANTITIES[name].unit}", fontsize="medium")
    scales = "each panel to its own scale; dot: θ = 0"
    entitle_figure(made.figure, labels.name_of(result.engine), where, scales, note)
    return made.axes


def ellipse(
    ax: Axes, order: OrderBalance, name: str, text: str, style: dict[str, Any]
) -> NDArray[np.complex128]:
    """Draw one ellipse, a dot where it is at θ = 0, and an arrow from there; return the curve."""
    vector = getattr(order, name)
    curve: NDArray[np.complex128] = vector.forward * np.exp(1j * PHASES)
    curve = curve + vector.backward * np.exp(-1j * PHASES)
    (line,) = ax.plot(curve.real, curve.imag, gid=SERIES, label=text or "_", **style)
    ax.plot(curve.real[:1], curve.imag[:1], "o", color=line.get_color(), gid="crankpin start")
    if vector.ellipse.minor != 0.0:
        arrow_at(ax, curve, len(PHASES) // 8, line.get_color())
    return curve


def direction(order: OrderBalance, name: str) -> str:
    """Return the direction in which an ellipse is passed."""
    minor = getattr(order, name).ellipse.minor
    if minor == 0.0:
        return "straight line"
    return labels.TURNING["forward" if minor > 0.0 else "backward"]


def _on_one(ax: Axes, orders: Sequence[OrderBalance], name: str, style: dict[str, Any]) -> None:
    for order, look in zip(orders, series(ax, len(orders), style), strict=True):
        ellipse(ax, order, name, f"order {order.order}: {direction(order, name)}", look)
    dress_plane(ax, name)
    legend_below(ax)
