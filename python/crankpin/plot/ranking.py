"""Rankings: curves over bank angle, the best angles ringed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from crankpin._support import labels
from crankpin.analysis.ranking import Ranking
from crankpin.plot._old import (
    COLOURS,
    DASHES,
    FEW_POINTS,
    degrees,
    dress,
    from_zero,
    given_or_new,
    plain_text,
    viridis,
)
from crankpin.plot.curves import short_names
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray


@draw.register(Ranking)
def _ranking(ranking: Ranking, ax: Axes | None = None) -> Axes:
    """Draw the first objective of each engine over bank angle, a ring where it is best.

    Engines ranked without bank angles: a dot each over their own bank angles, or, where these do
    not distinguish them, below each other.
    """
    ax = given_or_new(ax)
    names, shared = short_names(list(ranking.names))
    title, _, common = shared.rpartition(", ")
    title = ranking.names[0] if len(names) == 1 else title or f"{len(names)} engines"
    heights = np.where(np.isfinite(ranking.values), ranking.values, np.nan)
    angles = ranking.bank_angles_deg
    along: Literal["x", "y"] = "y"
    if angles is not None:
        _angle_curves(ax, angles, names, heights)
        # Between the given angles an engine may be better than at them.
        rings = [(angle, each.value) for each in ranking for angle in each.bank_angles_deg]
    else:
        first = {each.name for each in ranking if each.place == 1}
        places = ranking.own_angles_deg
        if np.unique(places[np.isfinite(places)]).size < 2:
            places, along = np.arange(len(names), dtype=np.float64), "x"
        rings = [
            (float(places[k]), float(heights[k, 0]))
            for k, name in enumerate(ranking.names)
            if name in first
        ]
        angles = places
        _dot(ax, places, heights[:, 0], along, {"color": COLOURS[0], "markersize": 4, "zorder": 3})
    ring = {"color": "black", "markerfacecolor": "none", "markersize": 11, "zorder": 4}
    _dot(ax, [place for place, _ in rings], [value for _, value in rings], along, ring)
    label = f"{ranking.by[0]}, {ranking.unit}".rstrip(", ")
    if along == "x":
        dress(ax, "x")
        ax.set_yticks(range(len(names)), [plain_text(name) for name in names])
        ax.set_ylim(len(names) - 0.5, -0.5)
        ax.set_xlabel(label)
    else:
        dress(ax)
        degrees(ax, angles[np.isfinite(angles)])
        ax.set_xlabel(f"bank angle, {ranking.hold} held" if ranking.hold else "bank angle")
        ax.set_ylabel(label)
    if not (heights < 0.0).any():
        largest = float(np.nanmax(np.append(heights, 0.0)))
        from_zero(ax, largest, along)
    subtitle = labels.cut(ranking.description(1), 80)
    ax.set_title(plain_text(f"{title}\n{subtitle}"), loc="left", fontsize=11)
    if len(ax.get_legend_handles_labels()[1]) > 1:
        ax.legend(loc="best", fontsize=8, title=plain_text(common) or None, title_fontsize=8)
    return ax


def _dot(ax: Axes, places: Any, values: Any, along: str, style: dict[str, Any]) -> None:  # noqa: ANN401
    across, up = (values, places) if along == "x" else (places, values)
    ax.plot(across, up, marker="o", linestyle="", clip_on=False, **style)


def _angle_curves(
    ax: Axes, angles: NDArray[np.float64], names: list[str], heights: NDArray[np.float64]
) -> None:
    few = len(names) <= len(COLOURS)
    colours: Sequence[Any] = COLOURS if few else viridis(len(names))
    in_order = np.argsort(angles, kind="stable")
    for k, (name, row) in enumerate(zip(names, heights, strict=True)):
        style: dict[str, Any] = {"color": colours[k], "zorder": 3, "clip_on": False}
        if few:
            # A curve under another one is seen through its gaps.
            style |= {"label": plain_text(name), "linestyle": "-" if k % 2 == 0 else DASHES[1]}
            style |= {"marker": "o", "markersize": 3.2} if len(angles) <= FEW_POINTS else {}
        else:
            style |= {"linewidth": 0.8}
        ax.plot(angles[in_order], row[in_order], **style)
