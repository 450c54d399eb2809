"""Rankings, designs and searches: an objective over bank angle or row by row, the best marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.drawing import picture
from crankpin.analysis.arrangements.search import ArrangementSearch
from crankpin.analysis.design.designs import Designs, bank_angle_range
from crankpin.analysis.design.families import turned
from crankpin.analysis.ranking.ranking import Ranking
from crankpin.plot.curves import FEW_POINTS, engine_looks
from crankpin.plot.layout import add_legend, axes_or_new, set_title
from crankpin.plot.painter import draw_curves, name_rows, x_axis, y_axis
from crankpin.plot.style import DISTINCT, SERIES, foreground, once, ring, series, write_at_mark
from crankpin.plot.sweep import MOST_ENGINES
from crankpin.plot.ticks import from_zero
from crankpin.plot.words import (
    in_degrees,
    joined,
    loads_of,
    numbers,
    objective_words,
    rounded,
    short_names,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.design.designs import Design
    from crankpin.analysis.ranking.ranking import Choice

CURVE_POINTS = 181
"""Bank angles of a design's curve, besides those of the designs."""
BEST, DESIGN = "best bank angle", "design"
MANY = 300
"""Number of dots beyond which they are smaller."""
FORBIDDEN = "needs a pin split that is not allowed"


@picture.register(Ranking)
def _ranking(
    ranking: Ranking, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the first objective over bank angle, the best angles ringed.

    Engines ranked without bank angles are listed, the best first. Of many engines the best
    are named, the others thin lines.

    Parameters
    ----------
    **style : dict, optional
        ``label``, put before the names in the legend; colour, line width and other properties
        of matplotlib lines.
    """
    ax = axes_or_new(ax)
    names, shared = short_names(list(ranking.names))
    title, _, common = shared.rpartition(", ")
    title = ranking.names[0] if len(names) == 1 else title or f"{len(names)} engines"
    if label:
        names = [f"{label}, {name}" if len(names) > 1 else label for name in names]
    quantity = objective_words(ranking.objectives[0])
    if ranking.bank_angles_deg is None:
        best = ranking.choices[:MOST_ENGINES]
        short = dict(zip(ranking.names, names, strict=True))
        _listed(ax, best, [short[choice.name] for choice in best], quantity, style)
        rest = len(ranking) - len(best)
        note = f"{rest} more engines not shown" if rest else ""
        set_title(ax, title, joined(ranking._description(1), loads_of(ranking)), note)
        return ax
    what = joined(ranking._description(1), loads_of(ranking))
    set_title(ax, title, what, labels.HELD.get(ranking.hold or "", ""))
    heights = np.where(np.isfinite(ranking.values), ranking.values, np.nan)
    _dress(ax, ranking.bank_angles_deg, heights, quantity)
    _curves(ax, ranking, ranking.bank_angles_deg, heights, names, style)
    add_legend(ax, common, last=BEST)
    return ax


def _curves(
    ax: Axes,
    ranking: Ranking,
    angles: NDArray[np.float64],
    heights: NDArray[np.float64],
    names: list[str],
    style: dict[str, Any],
) -> None:
    """Draw a curve for each engine, rings at its best angles, and the angle at the best of all."""
    choices = {choice.name: choice for choice in ranking}
    by_engine = [choices[name] for name in ranking.names]
    sizes = np.array([choice.value for choice in by_engine])
    looks, _ = engine_looks(ax, names, sizes, style)
    marked = len(angles) <= FEW_POINTS and len(names) <= DISTINCT
    for place, look, text in looks:
        (k,) = place
        choice = by_engine[k]
        x, y = _with_best(angles, heights[k], choice)
        points: dict[str, Any] = {"marker": "o" if marked else "", "markersize": 3.0} | look
        ax.plot(x, y, gid=SERIES, label=text or "_", clip_on=False, **points)
    named = [k for (k,), _, text in looks if text and k < len(names)]
    for (k,), look, _ in looks:
        choice = by_engine[k]
        if k not in named or not np.isfinite(choice.value):
            continue
        best = np.array(choice.bank_angles_deg)
        ring(ax, best, np.full(best.shape, choice.value), look["color"], "o", BEST)
        if choice.place == 1:
            for angle in best[:3]:
                write_at_mark(ax, float(angle), choice.value, _angle(angle))


def _angle(value: float) -> str:
    return in_degrees(float(numbers([value])[0]))


def _with_best(
    angles: NDArray[np.float64], heights: NDArray[np.float64], choice: Choice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return a curve in ascending order, with the best angles found between the given ones."""
    between = np.setdiff1d(choice.bank_angles_deg, angles)
    x = np.append(angles, between)
    y = np.append(heights, np.full(between.shape, choice.value))
    in_order = np.argsort(x, kind="stable")
    return x[in_order], y[in_order]


# --- designs ------------------------------------------------------------------------------------


@picture.register(Designs)
def _designs(
    designs: Designs,
    ax: Axes | None = None,
    *,
    count: int = 4,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the first objective of the best designs over bank angle.

    A ring marks each design. Designs without banks, or by a function, are drawn as a dot each,
    below each other.

    Parameters
    ----------
    count : int, default 4
        Number of designs.
    **style : dict, optional
        Properties of the curves, or of the dots.
    """
    number = inputs.whole("count", count, 1)
    ax = axes_or_new(ax)
    best = designs.designs[:number]
    names = [joined(label or "", _crank_text(design)) for design in best]
    quantity = objective_words(designs.objectives[0])
    what = joined(designs._description(1), loads_of(designs))
    set_title(ax, _title(designs, len(best)), what)
    if designs.question.banks == 2 and designs.objectives[0].quantity:
        _over_bank_angle(ax, designs, best, names, quantity, style)
        add_legend(ax, last=DESIGN)
    else:
        _listed(ax, best, names, quantity, style)
    return ax


def _title(designs: Designs, count: int) -> str:
    question = designs.question
    counted = f"{count} of {designs.optima}" if count < designs.optima else f"{count}"
    noun = "design" if designs.optima == 1 else "designs"
    return f"{'IV'[question.banks - 1]}{question.cylinders}, {counted} {noun}"


def _crank_text(design: Design) -> str:
    split = design.crank.splits_text
    return f"{design.crank.text}°" + (f" split {split.replace('-', '−')}°" if split else "")


def _over_bank_angle(
    ax: Axes,
    designs: Designs,
    best: tuple[Design, ...],
    names: list[str],
    quantity: str,
    style: dict[str, Any],
) -> None:
    """Draw a curve for each crank, and rings at its designs, the best of all with its angle.

    A curve is dotted where the firing would need pins split further than allowed.
    """
    question = designs.question
    low, high = bank_angle_range(designs)
    bank_angles = [float(design.bank_angle_deg or 0.0) for design in best]
    angles = np.union1d(np.linspace(low, high, CURVE_POINTS), bank_angles)
    heights = designs.over_bank_angle(angles, len(best))
    # Several designs may be dips of one curve.
    cranks = [turned(question, design.crank, low) for design in best]
    firsts = [cranks.index(crank) for crank in cranks]
    curves = sorted(set(firsts))
    looks = dict(zip(curves, series(ax, len(curves), style), strict=True))
    _dress(ax, angles, heights, quantity)
    least, most = question.pin_split
    for k, look in looks.items():
        splits = [turned(question, best[k].crank, angle).splits for angle in angles.tolist()]
        allowed = np.array([all(least <= split <= most for split in at) for at in splits])
        allowed |= question.hold == "pins"
        ax.plot(
            angles,
            np.where(allowed, heights[k], np.nan),
            gid=SERIES,
            label=names[k],
            clip_on=False,
            **look,
        )
        if not allowed.all():
            thin = look | {"linestyle": ":", "linewidth": 0.8}
            ax.plot(angles, heights[k], gid="", label=once(ax, FORBIDDEN), **thin)
    for k, design in enumerate(best):
        place = np.array([bank_angles[k]]), np.array([design.value])
        ring(ax, *place, looks[firsts[k]]["color"], "o", DESIGN)
    write_at_mark(ax, bank_angles[0], best[0].value, _angle(bank_angles[0]))


# --- searches -----------------------------------------------------------------------------------


@picture.register(ArrangementSearch)
def _search(
    result: ArrangementSearch, ax: Axes | None = None, *, label: str | None = None, **style: object
) -> Axes:
    """Draw the second-order moment that remains over the bank angles.

    Parameters
    ----------
    **style : dict, optional
        ``label``, for a legend of several searches on the same axes; colour, marker and other
        properties of matplotlib lines.
    """
    ax = axes_or_new(ax)
    arrangements = list(result)
    angles = np.array([arrangement.bank_angle_deg for arrangement in arrangements])
    heights = np.array([max(arrangement.second_order) for arrangement in arrangements])
    without = f"{len(arrangements)} bank angles without backward moment, {result.hold} held"
    name = f"V{result.cylinders}"
    set_title(ax, name, without)
    # Hundreds of them would cover each other.
    size = 3.2 if len(arrangements) <= MANY else 1.2
    dots: dict[str, Any] = {"marker": "o", "markersize": size, "markeredgewidth": 0.0}
    of_dots = style | {"linestyle": ""}
    draw_curves(ax, angles, {label or name: heights}, of_dots, clip_on=False, **dots)
    _dress(
        ax,
        np.array(result.window_deg),
        heights,
        "larger second-order moment, over m·r·ω²·aₙ·spacing",
    )
    add_legend(ax)
    return ax


# --- both ---------------------------------------------------------------------------------------


def _dress(
    ax: Axes, angles: NDArray[np.float64], heights: NDArray[np.float64], quantity: str
) -> None:
    """Let axes show bank angles, and a quantity from zero on."""
    x_axis(ax, "bank angle", angles, by_angle=True)
    if not (heights < 0.0).any():
        before = ax.get_ylim()[1] / 1.08 if len(ax.lines) else 0.0
        from_zero(ax, max(_largest(heights), before))
    y_axis(ax, quantity)


def _largest(values: NDArray[np.float64]) -> float:
    return float(np.nanmax(values, initial=0.0))


def _listed(
    ax: Axes,
    best: Sequence[Choice | Design],
    names: Sequence[str],
    quantity: str,
    style: dict[str, Any],
) -> None:
    """Draw values below each other, the best first; those of the first place ringed."""
    rows = np.arange(len(best))
    values = np.array([design.value for design in best])
    values[~np.isfinite(values)] = np.nan
    dots: dict[str, Any] = {"marker": "o", "markersize": 5.0, "clip_on": False}
    draw_curves(ax, values, {"": rows}, style | {"linestyle": ""}, **dots)
    first = np.array([design.place == 1 for design in best])
    ring(ax, values[first], rows[first], foreground(ax), "o", "_")
    for row, value in zip(rows, values, strict=True):
        if np.isfinite(value):
            write_at_mark(ax, float(value), float(row), rounded(value, 4), beside=True)
    name_rows(ax, names)
    ax.tick_params(axis="y", pad=8)  # of the rings at zero
    x_axis(ax, quantity)
    if not (values < 0.0).any():
        ax.set_xlim(0.0, 1.3 * _largest(values) or 1.0)
