"""Rankings: the first objective over bank angle, or engine by engine, with the best marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D

from crankpin._support import labels
from crankpin.analysis.ranking.ranking import Ranking
from crankpin.plot.axes import entitle, label_x, label_y, one_panel
from crankpin.plot.bundle import engine_looks
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import legend_below
from crankpin.plot.marks import ring, write
from crankpin.plot.style import MOST_TOLD_APART, SERIES, foreground, series
from crankpin.plot.ticks import degrees, from_zero, numeric, span
from crankpin.plot.words import in_degrees, numbers, plain_text, rounded, short_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.ranking.choices import Choice

MOST_ENGINES = 24
"""Engines shown below each other, the best ones."""
FEW_POINTS = 40
"""Up to so many points of a curve are marked."""
BEST = "best bank angle"


@draw.register(Ranking)
def _ranking(
    ranking: Ranking,
    ax: Axes | None = None,
    *,
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    ax = one_panel(ax)
    of_lines = mpl.cbook.normalize_kwargs(style, Line2D)
    names, shared = short_names(list(ranking.names))
    title, _, common = shared.rpartition(", ")
    title = ranking.names[0] if len(names) == 1 else title or f"{len(names)} engines"
    if label:
        names = [f"{label}, {name}" if len(names) > 1 else label for name in names]
    quantity = f"{ranking.by[0]}, {ranking.unit}".rstrip(", ")
    if ranking.bank_angles_deg is None:
        note = _listed(ax, ranking, dict(zip(ranking.names, names, strict=True)), of_lines)
        label_x(ax, quantity)
        entitle(ax, title, ranking.description(1), note)
        return ax
    entitle(ax, title, ranking.description(1), labels.HELD.get(ranking.hold or "", ""))
    heights = np.where(np.isfinite(ranking.values), ranking.values, np.nan)
    span(ax, ranking.bank_angles_deg)
    _curves(ax, ranking, ranking.bank_angles_deg, heights, names, of_lines)
    degrees(ax.xaxis)
    numeric(ax.yaxis)
    if not (heights < 0.0).any():
        from_zero(ax, max(_largest(heights), ax.get_ylim()[1] / 1.08 if ax.lines else 0.0))
    label_x(ax, "bank angle")
    label_y(ax, quantity)
    legend_below(ax, plain_text(common) if common else "", last=BEST)
    return ax


def _largest(heights: NDArray[np.float64]) -> float:
    return float(np.nanmax(np.append(heights, 0.0)))


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
    marked = len(angles) <= FEW_POINTS and len(names) <= MOST_TOLD_APART
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
                write(ax, float(angle), choice.value, in_degrees(float(numbers([angle])[0])))


def _with_best(
    angles: NDArray[np.float64], heights: NDArray[np.float64], choice: Choice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return a curve in ascending order, with the best angles found between the given ones."""
    between = np.setdiff1d(choice.bank_angles_deg, angles)
    x = np.append(angles, between)
    y = np.append(heights, np.full(between.shape, choice.value))
    in_order = np.argsort(x, kind="stable")
    return x[in_order], y[in_order]


def _listed(ax: Axes, ranking: Ranking, names: dict[str, str], style: dict[str, Any]) -> str:
    """Draw engines below each other, the best first; those of the first place ringed.

    Return a note of the engines left out.
    """
    best = ranking.best(min(len(ranking), MOST_ENGINES))
    rows = np.arange(len(best))
    values = np.array([choice.value for choice in best])
    values[~np.isfinite(values)] = np.nan
    (look,) = series(ax, 1, style)
    dots: dict[str, Any] = {"marker": "o", "markersize": 5.0} | look | {"linestyle": ""}
    ax.plot(values, rows, gid=SERIES, clip_on=False, label="_", **dots)
    first = np.array([choice.place == 1 for choice in best])
    ring(ax, values[first], rows[first], foreground(ax), "o", "_")
    for row, value in zip(rows, values, strict=True):
        if np.isfinite(value):
            write(ax, float(value), float(row), rounded(value, 4), beside=True)
    ax.set_yticks(rows, [plain_text(names[choice.name]) for choice in best])
    ax.set_ylim(len(best) - 0.5, -0.5)
    numeric(ax.xaxis)
    if not (values < 0.0).any():
        ax.set_xlim(0.0, 1.3 * _largest(values) or 1.0)
    rest = len(ranking) - len(best)
    return f"{rest} more engines not shown" if rest else ""
