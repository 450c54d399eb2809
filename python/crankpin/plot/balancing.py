"""Balance shafts, sets of hardware and bob weights: residuals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balancing.balancers import BalancerOptions
from crankpin.analysis.balancing.bob_weight import BobWeight
from crankpin.analysis.balancing.fitted_shafts import SHAKEN, BalanceShafts
from crankpin.plot.layout import add_legend, axes_or_new, note_zero, set_title
from crankpin.plot.painter import draw_changes, draw_curves, highest, x_axis, y_axis
from crankpin.plot.style import (
    MARKERS,
    SERIES,
    count_series,
    font_of,
    foreground,
    muted,
    ring,
    series,
    write_at_mark,
)
from crankpin.plot.words import drawn_quantity, in_degrees, number, plain_text, rounded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.balancing.balancers import BalancerOption


def names_there(ax: Axes) -> list[str]:
    """Return the names of the rows of results drawn on axes before."""
    return [text.get_text() for text in ax.get_yticklabels()] if count_series(ax) else []


def rows_for(ax: Axes, names: Sequence[str], **style: Any) -> NDArray[np.intp]:  # noqa: ANN401
    """Return the rows of these names, new ones below those there; name them on the left."""
    wanted = [plain_text(name) for name in names]
    every = list(dict.fromkeys([*names_there(ax), *wanted]))
    ax.set_yticks(np.arange(len(every)), every, **style)
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_ylim(len(every) - 0.5, -0.5)
    return np.array([every.index(name) for name in wanted], dtype=np.intp)


def wide_enough(ax: Axes, largest: float) -> None:
    """Let the horizontal axis begin at zero and have room for this value and those there."""
    width = ax.get_xlim()[1] if count_series(ax) else 0.0
    ax.set_xlim(0.0, max(width, 1.08 * largest) or 1.0)


# --- balance shafts ------------------------------------------------------------------------------


@picture.register(BalanceShafts)
def _balance_shafts(
    result: BalanceShafts,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw a quantity with and without the shafts, part by part.

    Parameters
    ----------
    quantity : str, optional
        ``"force"``, ``"moment"`` or ``"torque"``, all over ω²; by default the moment, or else
        the first that there is.
    **style : dict, optional
        Passed on to the markers; ``label`` names the result in a legend.
    """
    every = result.parts()
    shaken = {part.quantity for part in every if max(part.before, part.after) > 0.0}
    name = drawn_quantity(quantity, shaken.__contains__, SHAKEN)
    ax = axes_or_new(ax)
    parts = [part for part in every if part.quantity == name]
    before, after = (
        np.array([getattr(part, when) for part in parts]) for when in ("before", "after")
    )
    set_title(ax, labels.name_of(result.engine), "with and without balance shafts")
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    wide_enough(ax, float(np.append(before, after).max(initial=0.0)))
    rows = rows_for(ax, [f"order {part.order} {part.part}".rstrip() for part in parts])
    of = f"{label}, " if label else ""
    draw_changes(ax, rows, {f"{of}without shafts": before, f"{of}with shafts": after}, style)
    kind = QUANTITIES[name]
    x_axis(ax, units.headed(f"{kind.words} over ω²", kind.unit_over_square))
    add_legend(ax)
    return ax


# --- balancers -----------------------------------------------------------------------------------

MOST_SETS_DRAWN = 24
"""Largest number of sets shown below each other, those with the fewest shafts."""
TARGET = "crankpin target"
"""Marks the lines at the targets by their gid."""
REACHED = "target reached"
SMALLEST = 5.0
"""Points of the smallest type of the rows."""


@picture.register(BalancerOptions)
def _balancers(
    result: BalancerOptions, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the residuals of the front in per cent of the engine's own.

    Parameters
    ----------
    **style : dict, optional
        Passed on to the markers; ``label`` names the result in a legend.
    """
    ax = axes_or_new(ax)
    alone = not count_series(ax)
    room = _room(ax)
    most = max(1, min(MOST_SETS_DRAWN, int(room / SMALLEST)) - len(names_there(ax)))
    options = result.pareto_front[:most]
    left_out = len(result.pareto_front) - len(options)
    set_title(
        ax,
        labels.name_of(result.engine),
        f"hardware, {number(result.rpm)} rpm" + f"; {left_out} more" * bool(left_out),
    )
    if label is None and not alone:
        label = labels.name_of(result.engine)
    start = np.array(result[0].values)
    parts = (
        np.array([option.values for option in options]) / np.where(start > 0.0, start, 1.0) * 100.0
    )
    drawn = [k for k, value in enumerate(start) if value > 0.0]
    wide_enough(ax, max(100.0, float(parts[:, drawn].max(initial=0.0))))
    rows = rows_for(ax, [_short(option.name) for option in options])
    usual = font_of("ytick.labelsize", "medium").get_size_in_points()
    size = max(SMALLEST, min(usual, room / len(ax.get_yticks())))
    ax.tick_params(axis="y", labelsize=size)
    limits = dict(result.targets)
    reached = np.array([option.reaches for option in options])
    for k in drawn:
        name = result.by[k]
        (look,) = series(ax, 1, style)
        marker = MARKERS[count_series(ax) % len(MARKERS)]
        marks: dict[str, Any] = {"marker": marker, "markersize": min(6.0, size)} | look
        marks |= {"linestyle": ""}
        head = result.objectives[k].head
        named = f"{label}, {head}" if label else head
        ax.plot(parts[:, k], rows, gid=SERIES, label=named, clip_on=False, zorder=3, **marks)
        if name in limits:
            limit = limits[name] / start[k] * 100.0
            ax.axvline(limit, color=marks["color"], linewidth=1.0, linestyle=":", gid=TARGET)
        if reached.any():
            ring(ax, parts[reached, k], rows[reached], foreground(ax), "o", REACHED)
    if alone:
        _write_amounts(ax, rows, options, size)
    else:  # amounts of several engines would share a row
        for child in ax.child_axes:
            child.set_visible(False)
    if alone and not drawn:
        note_zero(ax)
    x_axis(ax, "residual, % (nothing fitted: 100)")
    add_legend(ax, last=REACHED)
    return ax


def _room(ax: Axes) -> float:
    """Return the points of type that fit below each other: about half of the height of axes."""
    figure: Any = ax.get_figure(root=True)
    inches = float(ax.get_window_extent().height / figure.dpi)
    return max(SMALLEST, 0.5 * 72.0 * inches / 1.1)


def _write_amounts(
    ax: Axes, rows: NDArray[np.intp], options: Sequence[BalancerOption], size: float
) -> None:
    """Write the unbalance of each set on the right."""
    amounts = ax.secondary_yaxis("right")
    unit, factor = units.convert("kg·m")
    if factor == 1.0:
        unit, factor = "g·m", 1000.0
    texts = [rounded(factor * option.unbalance) for option in options]
    amounts.set_yticks(rows, texts, fontsize=size)
    amounts.tick_params(axis="y", length=0, pad=6, labelcolor=muted(ax))
    amounts.set_ylabel(f"unbalance, {unit}", color=muted(ax))
    amounts.spines["right"].set_visible(False)


def _short(name: str) -> str:
    """Return the name of a set as short as columns of papers need it."""
    for long, short in (
        ("counterweights", "weights"),
        (" + ", ", "),
        ("shafts ", ""),
        ("shaft ", ""),
        (" alone", ""),
    ):
        name = name.replace(long, short)
    return name


# --- bob weight ----------------------------------------------------------------------------------

ELLIPSE_POINTS = 201


@picture.register(BobWeight)
def _bob_weight(
    result: BobWeight,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the residual of order 1 over the factor: longest, shortest vector.

    Parameters
    ----------
    quantity : str, optional
        ``"force"`` or ``"moment"``; by default the force, or the moment if there is no force.
    **style : dict, optional
        Keywords of the lines, such as ``color`` or ``linewidth``; ``label`` names the engine.
    """
    name = _chosen(result, quantity)
    ax = axes_or_new(ax)
    if label is None and count_series(ax):
        label = labels.name_of(result.engine)
    lines = result.straight_line_factors(name)
    end = max(1.0, result.factor, *(factor for factor, _ in lines))
    # Both half axes have corners at these factors.
    corners = [factor for factor, _ in lines] + [result.optimal_factor(name) or 0.0, result.factor]
    factors = np.unique([*np.linspace(0.0, end, ELLIPSE_POINTS), *corners])
    longest, shortest = result.half_axes(name, factors)
    axes_of = result.half_axes(name, result.factor)
    set_title(ax, labels.name_of(result.engine), f"{QUANTITIES[name].words} of order 1 over ω²")
    of = f"{label}: " if label else ""
    half_axes = {f"{of}longest": longest, f"{of}shortest": np.abs(shortest)}
    draw_curves(ax, factors, half_axes, style)
    ax.axvline(result.factor, color=muted(ax, 0.5), linewidth=0.8, zorder=1, gid="crankpin own")
    x_axis(ax, "balance factor")
    ax.set_xlim(0.0, end)
    y_label = units.headed("half axes", QUANTITIES[name].unit_over_square)
    y_axis(ax, y_label, largest=highest(ax))
    x = np.array([result.factor, result.factor])
    ring(ax, x, np.abs(axes_of), foreground(ax), "o", "this factor")
    if lines:
        x = np.array([factor for factor, _ in lines])
        ring(ax, x, np.zeros_like(x), foreground(ax), "D", "straight line, with its direction")
        for factor, direction_deg in lines:
            write_at_mark(ax, factor, 0.0, in_degrees(round(direction_deg, 1)))
    add_legend(ax)
    return ax


def _chosen(result: BobWeight, quantity: object) -> str:
    """Return the quantity given, or the force, or the moment if there is no force."""
    if quantity is not None:
        return inputs.one_of("quantity", quantity, PLANE_VECTORS)
    return "force" if result.half_axes("force", 0.0)[0] > 0.0 else "moment"
