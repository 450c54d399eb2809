"""Designs: the first objective over bank angle, or design by design, with the designs marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.analysis.design.built import turned
from crankpin.analysis.design.designs import Designs, bank_angle_range
from crankpin.plot.axes import entitle, label_x, label_y, one_panel
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.marks import ring, write
from crankpin.plot.style import SERIES, foreground, series
from crankpin.plot.ticks import degrees, from_zero, numeric, span
from crankpin.plot.words import in_degrees, numbers, rounded

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from crankpin.analysis.design.designs import Design

POINTS = 181
"""Bank angles of a curve, besides those of the designs."""
BEST = "design"


@draw.register(Designs)
def _designs(
    designs: Designs,
    ax: Axes | None = None,
    *,
    count: int = 4,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    number = inputs.whole("count", count)
    if number < 1:
        raise InputError(f"count = {number}: give a whole number, 1 or more")
    ax = one_panel(ax)
    of_lines = mpl.cbook.normalize_kwargs(style, Line2D)
    best = designs.designs[:number]
    names = [", ".join(filter(None, [label, _name(each)])) for each in best]
    quantity = f"{designs.by[0]}, {designs.unit}".rstrip(", ")
    if designs.question.banks == 2 and designs.objectives[0].quantity:
        _over_bank_angle(ax, designs, best, names, of_lines)
        label_x(ax, "bank angle")
        label_y(ax, quantity)
    else:
        _below_each_other(ax, best, names, of_lines)
        label_x(ax, quantity)
    entitle(ax, _title(designs, len(best)), designs.description(1))
    if designs.question.banks == 2:
        legend_below(ax, last=BEST)
    return ax


def _title(designs: Designs, shown: int) -> str:
    question = designs.question
    counted = f"{shown} of {designs.optima}" if shown < designs.optima else f"{shown}"
    return f"{'IV'[question.banks - 1]}{question.cylinders}, {counted} designs"


def _name(design: Design) -> str:
    split = design.crank.splits_text
    return f"{design.crank.text}°" + (f" split {split.replace('-', '−')}°" if split else "")


def _over_bank_angle(
    ax: Axes, designs: Designs, best: tuple[Design, ...], names: list[str], style: dict[str, Any]
) -> None:
    """Draw a curve for each crank, and rings at its designs, the best of all with its angle."""
    low, high = bank_angle_range(designs)
    own = [float(each.bank_angle_deg or 0.0) for each in best]
    angles = np.union1d(np.linspace(low, high, POINTS), own)
    heights = designs.over_bank_angle(angles, len(best))
    # Several designs may be dips of one curve.
    cranks = [turned(designs.question, each.crank, low) for each in best]
    firsts = [cranks.index(crank) for crank in cranks]
    curves = sorted(set(firsts))
    looks = dict(zip(curves, series(ax, len(curves), style), strict=True))
    span(ax, angles)
    for k, look in looks.items():
        ax.plot(angles, heights[k], gid=SERIES, label=names[k], clip_on=False, **look)
    from_zero(ax, max(float(heights.max()), ax.get_ylim()[1] / 1.08))
    degrees(ax.xaxis)
    numeric(ax.yaxis)
    for k, design in enumerate(best):
        place = np.array([own[k]]), np.array([design.value])
        ring(ax, *place, looks[firsts[k]]["color"], "o", BEST)
    write(ax, own[0], best[0].value, in_degrees(float(numbers([own[0]])[0])))


def _below_each_other(
    ax: Axes, best: tuple[Design, ...], names: list[str], style: dict[str, Any]
) -> None:
    """Draw designs below each other, the best first; those of the first place ringed."""
    rows, values = np.arange(len(best)), np.array([each.value for each in best])
    (look,) = series(ax, 1, style)
    dots: dict[str, Any] = {"marker": "o", "markersize": 5.0} | look | {"linestyle": ""}
    ax.plot(values, rows, gid=SERIES, clip_on=False, label="_", **dots)
    first = np.array([each.place == 1 for each in best])
    ring(ax, values[first], rows[first], foreground(ax), "o", "_")
    ax.set_yticks(rows, names)
    ax.set_ylim(len(best) - 0.5, -0.5)
    numeric(ax.xaxis)
    finite = values[np.isfinite(values)]
    if not (finite < 0.0).any():
        ax.set_xlim(0.0, 1.3 * float(finite.max(initial=0.0)) or 1.0)
    for row, value in zip(rows.tolist(), values.tolist(), strict=True):
        if np.isfinite(value):
            write(ax, value, row, rounded(value, 4), beside=True)
