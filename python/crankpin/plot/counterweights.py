"""Counterweights: places, directions, and the residual."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.messages import Hint
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balance import over_square
from crankpin.analysis.balancing.counterweights import Counterweights
from crankpin.model.crankpins import crankpins
from crankpin.plot.balance import direction, ellipse
from crankpin.plot.layout import (
    Drawn,
    add_legend,
    axes_or_new,
    inches_of,
    make_panels,
    reject_figure,
    set_panel_title,
    set_title,
    width_for,
)
from crankpin.plot.painter import x_axis, y_axis, zero_line
from crankpin.plot.plane import label_plane, scale_plane
from crankpin.plot.style import SERIES, muted, series
from crankpin.plot.words import drawn_quantity, nonzero_in

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.typing import ColorType
    from numpy.typing import ArrayLike

NEEDLE = 0.2
"""Length of an arrow, inches; in low axes less."""
PINS_HEIGHT = -0.3
"""Height of the row of crankpins, in largest weights."""
NARROWEST_PICTURE = 2.4
"""Inches of width below which panels stand below each other."""
PICTURE_KINDS = ("summary", "weights", "ellipses")


@picture.register(Counterweights)
def _counterweights(
    result: Counterweights,
    ax: object = None,
    *,
    figure: object = None,
    kind: str = "summary",
    quantity: str | None = None,
    **style: object,
) -> Drawn:
    """Draw the weights, and what order 1 does before and after.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; by default new ones. ``"summary"`` draws the weights on them.
    kind : {"summary", "weights", "ellipses"}, default "summary"
        ``"summary"``: panels of weights and of the ellipses of force and moment, those that
        are not zero; ``"weights"``: mass·radius of each plane over its place, with an arrow in
        its direction at θ = 0 seen from the flywheel, and below it arrows of the crankpins;
        ``"ellipses"``: what order 1 traces before and after.
    quantity : str, optional
        ``"force"`` or ``"moment"``, for ``"ellipses"``; by default the moment, or else the
        force.
    **style : dict, optional
        ``label`` and properties of matplotlib lines.
    """
    chosen = inputs.one_of("kind", kind, PICTURE_KINDS)
    exists = nonzero_in(over_square(result.engine, [1])[1], result.residual[1])
    name = drawn_quantity(quantity, exists, PLANE_VECTORS)
    if chosen == "summary" and ax is None:
        return _summary(result, figure, style)
    reject_figure(figure, chosen)
    ax = axes_or_new(ax)
    if chosen == "ellipses":
        set_title(ax, labels.name_of(result.engine), f"{QUANTITIES[name].words} of order 1 over ω²")
        _ellipses(ax, result, name, style)
        add_legend(ax)
        return ax
    set_title(
        ax, labels.name_of(result.engine), "counterweights, arrows at θ = 0 seen from the flywheel"
    )
    _weights(ax, result, style)
    return ax


def _summary(result: Counterweights, figure: object, style: dict[str, Any]) -> Drawn:
    if "label" in style:
        hint = Hint.of('`kind="summary"` shows one result; give `kind="weights"` and `ax`')
        raise inputs.rejected("label", style["label"], hint)
    before = over_square(result.engine, [1])[1]
    vectors = [name for name in PLANE_VECTORS if getattr(before, name).peak > 0.0]
    vectors += ["moment"] if not vectors else []
    count = 1 + len(vectors)
    beside = width_for(figure) >= NARROWEST_PICTURE * count
    grid = make_panels(
        None, figure, *((1, count) if beside else (count, 1)), row_height=0.75 if beside else 0.85
    )
    panels = grid.axes.ravel()
    set_panel_title(panels[0], "weights at θ = 0")
    _weights(panels[0], result, style)
    for panel, name in zip(panels[1:], vectors, strict=True):
        set_panel_title(panel, QUANTITIES[name].words)
        states = _ellipses(panel, result, name, style)
    grid.set_title(labels.name_of(result.engine), "counterweights, and order 1 over ω²")
    grid.add_legend(states)
    return grid.axes


def _weights(ax: Axes, result: Counterweights, style: dict[str, Any]) -> None:
    """Draw stems as high as the weights; those of one plane stand on each other."""
    (look,) = series(ax, 1, {"linestyle": "-"} | style)
    places = np.array([weight.z for weight in result.hardware])
    amounts = np.array([weight.amount for weight in result.hardware])
    names = [name for name, _ in result.by_plane]
    feet = np.array(
        [sum(amounts[k] for k in range(i) if names[k] == names[i]) for i in range(len(names))]
    )
    tops = feet + amounts
    gap = np.full(len(places), np.nan)
    (line,) = ax.plot(
        np.stack([places, places, gap], axis=1).ravel() if len(places) else [],
        np.stack([feet, tops, gap], axis=1).ravel() if len(places) else [],
        gid=SERIES,
        label=style.get("label", "_"),
        **look,
    )
    angles = [inputs.degrees(weight.angle_deg) for weight in result.hardware]
    _needles(ax, places, tops, angles, line.get_color(), "crankpin weights")
    largest = float(tops.max(initial=0.0)) or 1.0
    pins = crankpins(result.engine)
    at = np.array([pin.z for pin in pins])
    height = np.full(len(pins), PINS_HEIGHT * largest)
    _needles(ax, at, height, [pin.pin_deg for pin in pins], muted(ax), "crankpin pins")
    zero_line(ax, gid="crankpin axis")
    along = np.append([z for _, z in result.places], at)
    room = 0.08 * float(np.ptp(along)) or 0.1
    ax.set_xlim(float(along.min()) - room, float(along.max()) + room)
    ax.set_ylim(1.8 * PINS_HEIGHT * largest, 1.25 * largest)
    x_axis(ax, units.headed("z", "m"))
    y_axis(ax, units.headed("mass·radius", "kg·m"))
    ax.set_yticks([tick for tick in ax.get_yticks() if 0.0 <= tick <= 1.25 * largest])
    ax.text(0.01, 0.02, "crankpins", transform=ax.transAxes, fontsize="small", color=muted(ax))


def _needles(
    ax: Axes, x: ArrayLike, y: ArrayLike, angles_deg: list[float], colour: ColorType, gid: str
) -> None:
    """Draw a dot at each point and an arrow from there, in the direction seen on the paper."""
    ax.plot(x, y, "o", color=colour, markersize=4.0, gid=gid, label="_", zorder=3)
    if len(angles_deg):
        turned = np.deg2rad(angles_deg)
        arrows = ax.quiver(
            x,
            y,
            np.cos(turned),
            np.sin(turned),
            color=colour,
            angles="uv",
            units="inches",
            width=0.018,
            scale=1.0 / min(NEEDLE, 0.1 * inches_of(ax, "height")),
            scale_units="inches",
            zorder=3,
            clip_on=False,
            gid=gid,
        )
        # Its extent would count the arrows' lengths as if they were data.
        arrows.set_in_layout(False)


def _ellipses(ax: Axes, result: Counterweights, name: str, style: dict[str, Any]) -> list[Line2D]:
    """Draw what order 1 traces before and after; return entries of a legend for both."""
    entries, states = [], {"before": result.engine, "after": result.fitted}
    for (state, engine), look in zip(states.items(), series(ax, 2, style), strict=True):
        order = over_square(engine, [1])[1]
        vanishes = getattr(order, name).peak == 0.0
        text = f"{state}: {'zero' if vanishes else direction(order, name)}"
        label = style.get("label")
        ellipse(ax, order, name, f"{label}, {text}" if label else text, look)
        entries.append(Line2D([], [], label=state, **look))
    scale_plane(ax)
    label_plane(ax, name, QUANTITIES[name].unit_over_square)
    return entries
