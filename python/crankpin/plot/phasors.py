"""Phasors of the cylinders: contributions to a balance, head to tail, and star diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch
from matplotlib.transforms import ScaledTranslation

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.messages import Hint
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis import contributions as adding
from crankpin.analysis.star import StarDiagram
from crankpin.plot import ticks
from crankpin.plot.layout import (
    Drawn,
    add_legend,
    axes_or_new,
    inches_of,
    keep_apart,
    label_x,
    label_y,
    make_panels,
    note_zero,
    points_of,
    set_panel_title,
    set_title,
)
from crankpin.plot.plane import make_plane_panels
from crankpin.plot.shapes import listed, outside
from crankpin.plot.style import colours, foreground, muted, outlined, write
from crankpin.plot.words import drawn_quantity, joined, loads_of, nonzero_in, number, rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.contributions import Contribution

ORDERS = (1, 2)
"""Orders that are drawn of a balance whose orders were not given."""
SUM = 4.0
"""Points of the sum's line, below those of the arms."""
NARROW_GAP = 4.0
"""Points between arrows side by side where there is no room for their names between them."""
MOST_ROOM = 0.4
"""Part of a panel that arrows moved aside may take, on either side."""
MOST_NAMES = 2.0
"""Sides of a panel that all names may take one behind the other."""
SHORTEST_DRAWN = 1e-9
"""Phasors and vectors below this part of the longest are not drawn."""
EQUAL_DECIMALS = 9
"""Decimals to which vectors of one direction agree, and arrows of one length over the longest."""


def phasors(
    result: Balance,
    ax: object = None,
    figure: FigureBase | None = None,
    *,
    quantity: str | None = None,
    orders: Orders | None = None,
    **style: object,
) -> NDArray[Any]:
    """Draw the phasors of cylinders, counterweights and shafts head to tail, with their sum.

    A column for each order; a row for the forward and one for the backward parts of force or
    moment, one row for a torque. Arrows that cover each other are moved apart.
    """
    if ax is not None:
        hint = Hint.of('`kind="phasors"` has several panels; give `figure=…`')
        raise inputs.rejected("ax", ax, hint)
    kind = drawn_quantity(quantity, nonzero_in(result))
    result._request.check(kind)
    chosen = inputs.explicit_half_orders(
        orders if orders is not None else result._request.orders or ORDERS
    )
    whole = result._at_orders(tuple(chosen))
    arms = adding.contributions(whole, kind)
    sums = adding.phasors(whole, kind)
    rows = ("forward", "backward") if kind in PLANE_VECTORS else ("",)
    width, height = mpl.rcParams["figure.figsize"]
    # Square panels, each below its two lines, between the title and the legend.
    inches = len(rows) * (0.8 * width / len(chosen) + 0.4) + 1.1
    row_height = (inches / height - 0.25) / len(rows)
    panels = make_panels(None, figure, len(rows), len(chosen), row_height=row_height)
    axes = panels.axes
    groups = list(dict.fromkeys(arm.group for arm in arms))
    inks = dict(zip(groups, colours(axes[0, 0], len(groups)), strict=True))
    font = FontProperties(size="small")
    widths = {part: points_of(panels.figure, part, font) for part in {arm.part for arm in arms}}
    aside = crowded = False
    for column, order in enumerate(chosen):
        for row, part in enumerate(rows):
            panel, total = axes[row, column], complex(sums[row, column])
            # Corners of the polygon, from the origin on.
            chain = np.cumsum([0.0, *(arm.phasors[row, column] for arm in arms)])
            room, names, fits = _polygon(panel, arms, chain, total, widths, inks, style)
            _frame(panel, chain, room)
            _name(panel, names, widths, fits)
            unit, factor = units.convert(QUANTITIES[kind].unit)
            length = f"{rounded(abs(total) * factor, 4)} {unit}" if total else "0"
            set_panel_title(panel, f"order {order} {part}".strip(), length)
            aside, crowded = aside or room > 0.0, crowded or not fits
    label_x(axes[-1, 0], _axis_label(kind, 0))
    for panel in axes[:, 0]:
        label_y(panel, _axis_label(kind, 1))
    where = f"{QUANTITIES[kind].words}, {number(result.rpm)} rpm, θ = 0"
    panels.set_title(
        labels.name_of(result.engine),
        joined(where, loads_of(result, kind)),
        "arrows that cover each other are drawn side by side" if aside else "",
        "from the dot on they follow by number, not all named" if crowded else "",
    )
    handles = [Line2D([], [], color=inks[name], linewidth=1.5, label=name) for name in groups]
    handles.append(Line2D([], [], color=muted(axes[0, 0], 0.5), linewidth=SUM, label="sum"))
    panels.add_legend(handles)
    return axes


def _polygon(
    ax: Axes,
    arms: Sequence[Contribution],
    chain: NDArray[np.complex128],
    total: complex,
    widths: Mapping[str, float],
    inks: dict[str, Any],
    style: dict[str, Any],
) -> tuple[float, list[tuple[str, complex, complex]], bool]:
    """Draw arms and sum; return the room that arrows moved aside need, points, and names.

    ``widths`` are those of the names, points. Names come with their place in data, and how far
    aside of it they stand, points; the last value is False where there is no room for all of them,
    and those of long arrows come first.
    """
    lengths = abs(np.diff(chain))
    longest = lengths.max(initial=0.0)
    if not longest:
        note_zero(ax)
        return 0.0, [], True
    drawn = [k for k in range(len(arms)) if lengths[k] > SHORTEST_DRAWN * longest]
    arrows = [(complex(chain[k]), complex(chain[k + 1])) for k in drawn]
    lanes = _lanes(arrows)
    beside = lane = 5.0 + max(widths[arms[k].part] for k in drawn)
    whole = lane * max(lanes) <= MOST_ROOM * _points(ax) and lane * len(
        drawn
    ) <= MOST_NAMES * _points(ax)
    if not whole:
        lane = min(NARROW_GAP, MOST_ROOM * _points(ax) / max(1, *lanes))
    middle = complex(chain[:-1].mean())
    names: list[tuple[str, complex, complex]] = []
    for k, (start, end), aside in zip(drawn, arrows, lanes, strict=True):
        across = _across(end - start)
        # Outside of the polygon, or on the side of the arrow that has no other.
        outwards = ((0.5 * (start + end) - middle) * across.conjugate()).real
        out = across if aside or outwards >= -1e-9 * longest else -across
        looks = {"color": inks[arms[k].group], "linewidth": 1.5 if whole else 1.0} | style
        arrow(ax, start, end, aside * lane * across, 9.0 if whole else 6.0, **looks)
        place = aside * lane * across + 0.5 * beside * out
        names.append((arms[k].part, 0.5 * (start + end), place))
    if abs(total) > SHORTEST_DRAWN * longest:
        arrow(ax, 0j, total, 0j, color=muted(ax, 0.5), linewidth=SUM, zorder=0.9)
    ax.plot([0.0], [0.0], marker="o", markersize=4.0, color=foreground(ax), zorder=4)
    if not whole:
        # Of arrows of one length the first; rounding does not choose.
        sizes = np.round(lengths[drawn] / longest, EQUAL_DECIMALS)
        names = [names[n] for n in np.argsort(-sizes, kind="stable")]
    return lane * max(lanes), names, whole


def _name(
    ax: Axes,
    names: Sequence[tuple[str, complex, complex]],
    widths: Mapping[str, float],
    whole: bool,
) -> None:
    """Write names beside their arrows; those that would overlap one before are added to it.

    Where there is no room for the ``whole`` of them they are left out.
    """
    font = FontProperties(size="small")
    # The layout will make the axes smaller than they are.
    scale = 0.8 * 72.0 * inches_of(ax) / float(np.ptp(ax.get_xlim()))
    between = points_of(ax, ", ", font)
    written: list[tuple[list[str], float, complex, complex]] = []
    for text, place, aside in names:
        length = widths[text]
        for k, (texts, before, other, apart) in enumerate(written):
            width = before + between + length
            gap = scale * (place - other) + aside - apart
            if abs(gap.real) < 0.6 * width and abs(gap.imag) < font.get_size_in_points():
                if whole:
                    written[k] = ([*texts, text], width, other, apart)
                break
        else:
            written.append(([text], length, place, aside))
    look = {"path_effects": outlined(ax), "zorder": 5}
    keep_apart(
        ax, [write(ax, ", ".join(t), place, aside, **look) for t, _, place, aside in written]
    )


def arrow(
    ax: Axes,
    start: complex,
    end: complex,
    shift: complex,
    head: float = 9.0,
    **style: Any,  # noqa: ANN401
) -> None:
    """Draw an arrow between two points, moved aside by a distance in points."""
    inches = ax.get_figure(root=True).dpi_scale_trans  # type: ignore[union-attr]
    aside = ScaledTranslation(shift.real / 72.0, shift.imag / 72.0, inches)
    drawn = FancyArrowPatch(
        (start.real, start.imag),
        (end.real, end.imag),
        arrowstyle="-|>",
        mutation_scale=head,
        shrinkA=0.0,
        shrinkB=0.0,
        transform=ax.transData + aside,
        **style,
    )
    # The limits of the axes are set, and no arrow ends outside: neither they nor the layout need
    # its extent, which takes longer than the arrow.
    drawn.set_in_layout(False)
    ax.add_artist(drawn)


def _lanes(arrows: Sequence[tuple[complex, complex]]) -> list[int]:
    """Return how far to the side each arrow goes, so that none covers another before it."""
    taken: list[tuple[complex, float, float, float, int]] = []
    lanes = []
    for start, end in arrows:
        across = _across(end - start)
        along = 1j * across.conjugate()  # turns the arrow's line onto the real axis
        offset = (start * across.conjugate()).real
        low, high = sorted(((start * along).real, (end * along).real))
        length = high - low
        used = {
            lane
            for other, place, first, last, lane in taken
            if abs(other - across) < 1e-6
            and abs(place - offset) < 1e-6 * length
            and min(high, last) - max(low, first) > 1e-6 * length
        }
        lane = next(k for k in range(len(used) + 1) if k not in used)
        taken.append((across, offset, low, high, lane))
        lanes.append(lane)
    return lanes


def _across(arrow: complex) -> complex:
    """Return the unit vector across an arrow, the same for the arrow reversed."""
    across = 1j * arrow / abs(arrow)
    upward = across.imag < -1e-9 or (abs(across.imag) <= 1e-9 and across.real < 0.0)
    return -across if upward else across


def _frame(ax: Axes, chain: NDArray[np.complex128], room: float) -> None:
    """Show the whole polygon, with room for labels and arrows moved aside, points."""
    half = 0.625 * float(max(np.ptp(chain.real), np.ptp(chain.imag)))
    half /= 1.0 - 1.5 * min(MOST_ROOM, room / _points(ax))
    ax.set_aspect("equal")
    if not half:
        ax.set_xticks([])
        ax.set_yticks([])
        return
    x, y = 0.5 * (chain.real.min() + chain.real.max()), 0.5 * (chain.imag.min() + chain.imag.max())
    ax.set_xlim(x - half, x + half)
    ax.set_ylim(y - half, y + half)
    ticks.numeric(ax.xaxis)
    ticks.numeric(ax.yaxis)


def _points(ax: Axes) -> float:
    """Return the side of a square panel, points."""
    box = ax.get_window_extent()
    # The layout will make the axes smaller than they are.
    return 0.7 * 72.0 * min(box.width, box.height) / ax.get_figure(root=True).dpi  # type: ignore[union-attr]


def _axis_label(kind: str, axis: int) -> str:
    if kind in PLANE_VECTORS:
        words = QUANTITIES[kind].components[axis].split(" (")[0]
    else:
        words = f"{('real', 'imaginary')[axis]} part"
    return units.headed(words, QUANTITIES[kind].unit)


# --- star diagrams --------------------------------------------------------------------------------

NUMBERED = 1.4
"""Limit of a panel's axes, in radii of its star: numbers of cylinders stand within."""
MOST_STARS = 12
"""Number of panels: the stars of an even-firing four-stroke with as many cylinders."""


@picture.register(StarDiagram)
def _star(
    result: StarDiagram,
    ax: Axes | None = None,
    *,
    figure: object = None,
    order: Order | None = None,
    **style: object,
) -> Drawn:
    """Draw the vectors of the orders from the centre, with their sums.

    A panel for each star: orders whose vectors are the same share one.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw one order on: the first whose sum remains and which is no major order.
    order : number, optional
        One of ``orders``, to draw it alone.
    **style : dict, optional
        Passed on to the vectors, such as ``color=``.
    """
    if order is not None and figure is not None:
        raise inputs.rejected("figure", figure, "one order has one panel; give ax")
    if ax is not None or order is not None:
        chosen = _shown(result) if order is None else result.orders[result._place(order)]
        ax = axes_or_new(ax)
        handles = _vectors(ax, result, chosen, style)
        what = joined(f"order {chosen}", _finding(result, chosen), loads_of(result))
        set_title(ax, labels.name_of(result.engine), what)
        add_legend(ax, handles=handles)
        return ax
    stars = _distinct(result)
    panels = make_plane_panels(figure, len(stars[:MOST_STARS]))
    handles = []
    for panel, orders in zip(panels.axes.flat, stars, strict=False):
        vectors = _vectors(panel, result, orders[0], style)
        handles = max(handles, vectors, key=len)
        # The numbers of many cylinders must not take the room of the stars.
        panel.set(xlim=(-NUMBERED, NUMBERED), ylim=(-NUMBERED, NUMBERED))
        for text in panel.texts:
            text.set_fontsize("x-small")
        set_panel_title(panel, labels.orders_text(orders), _finding(result, orders[0]))
    rest = sorted(order for orders in stars[MOST_STARS:] for order in orders)
    note = f"not shown: {labels.orders_text(rest)}" if rest else ""
    what = joined(result.firing.summary, loads_of(result))
    panels.set_title(labels.name_of(result.engine), what, note)
    panels.add_legend(handles)
    return panels.drawn


def _distinct(result: StarDiagram) -> list[list[Order]]:
    """Return the orders that have the same vectors, as even firing makes them every few orders."""
    alike: dict[bytes, list[Order]] = {}
    for order, vectors in zip(result.orders, result.read("vectors"), strict=True):
        alike.setdefault((np.round(vectors, EQUAL_DECIMALS) + 0.0).tobytes(), []).append(order)
    return list(alike.values())


def _vectors(ax: Axes, result: StarDiagram, order: Order, style: dict[str, Any]) -> list[Line2D]:
    """Draw the vectors of an order and their sum; return the entries of a legend."""
    vectors = result.read("vectors")[result._place(order)]
    total, longest = result[order], float(np.abs(vectors).max(initial=0.0))
    ax.set_aspect("equal")
    ax.set(xticks=[], yticks=[], xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), frame_on=False)
    ax.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=muted(ax, 0.35), linewidth=0.8))
    if not longest:
        note_zero(ax)
        return []
    looks = {"color": colours(ax, 1)[0], "linewidth": 1.5} | style
    rays: dict[complex, list[int]] = {}
    for cylinder, vector in enumerate(vectors.tolist(), start=1):
        if abs(vector) > SHORTEST_DRAWN * longest:
            rays.setdefault(complex(np.round(vector / abs(vector), EQUAL_DECIMALS)), []).append(
                cylinder
            )
    for numbers in rays.values():
        # Of vectors of one direction the longest covers the others, whose tips are marked.
        tips = [complex(vectors[cylinder - 1]) / longest for cylinder in numbers]
        farthest = max(tips, key=abs)
        arrow(ax, 0j, farthest, 0j, **looks)
        ax.plot(np.real(tips), np.imag(tips), ".", color=looks["color"], gid="tip")
        outside(ax, farthest, listed(numbers))
    size = float(np.abs(vectors).sum())
    handles = [Line2D([], [], color=looks["color"], linewidth=1.5, label="cylinders")]
    if total:
        arrow(ax, 0j, total / size, 0j, color=muted(ax, 0.5), linewidth=SUM, zorder=0.9)
        label = "sum, over that of all lengths"
        handles.append(Line2D([], [], color=muted(ax, 0.5), linewidth=SUM, label=label))
    ax.plot([0.0], [0.0], marker="o", markersize=4.0, color=foreground(ax), zorder=4)
    return handles


def _shown(result: StarDiagram) -> Order:
    """Return the first order that remains without being major, else the first that remains."""
    remaining = result.verdicts.remaining
    minor = [order for order in remaining if order not in result.major]
    return [*minor, *remaining, *result.orders][0]


def _finding(result: StarDiagram, order: Order) -> str:
    if result.verdicts[order] == "vanishes":
        return "sum 0, proved"
    size = float(np.abs(result.mode_shape).sum())
    text = f"sum {rounded(abs(result[order]), 4)} of {rounded(size, 4)}"
    return f"major: {text}" if order in result.major else text
