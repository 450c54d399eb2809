"""Panels of curves and of rows: series in successive looks, and what their axes show."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin.plot.layout import label_x, label_y, note_zero
from crankpin.plot.style import SERIES, background, muted, series
from crankpin.plot.ticks import degrees, from_zero, numeric, span
from crankpin.plot.words import joined, plain_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from numpy.typing import ArrayLike

CHANGE = "crankpin change"
"""Marks the lines from before to after by their gid."""


def draw_curves(
    ax: Axes,
    x: ArrayLike,
    columns: Mapping[str, ArrayLike],
    style: Mapping[str, Any],
    label: str | None = None,
    **look: Any,  # noqa: ANN401 - of matplotlib
) -> list[Line2D]:
    """Draw a curve for each column, entered in a legend by its name with a label before it.

    ``look`` is what curves have besides successive colours and dashes; ``style`` is the caller's.
    """
    looks = series(ax, len(columns), style)
    return [
        line
        for (name, values), look_of_series in zip(columns.items(), looks, strict=True)
        for line in ax.plot(
            x, values, gid=SERIES, label=joined(label or "", name) or "_", **(look | look_of_series)
        )
    ]


def draw_changes(
    ax: Axes, rows: ArrayLike, columns: Mapping[str, ArrayLike], style: Mapping[str, Any]
) -> None:
    """Draw rows before and after something: rings, dots, and lines from the ones to the others.

    What does not change is a dot in a ring.
    """
    before, after = columns.values()
    ax.hlines(rows, after, before, color=muted(ax, 0.4), linewidth=1.2, zorder=2, gid=CHANGE)
    for name, size, ring in zip(columns, (9.0, 4.5), (True, False), strict=True):
        (look,) = series(ax, 1, style)
        marks: dict[str, Any] = {"marker": "o", "markersize": size} | look | {"linestyle": ""}
        if ring:
            marks |= {"markerfacecolor": background(ax), "markeredgewidth": 1.5}
        options: dict[str, Any] = {"gid": SERIES, "label": name, "clip_on": False, "zorder": 3}
        ax.plot(columns[name], rows, **(options | marks))


def x_axis(
    ax: Axes,
    label: str,
    values: ArrayLike | None = None,
    *,
    by_angle: bool = False,
    whole: bool = False,
    largest: float | None = None,
) -> None:
    """Label the horizontal axis, unless the label is empty, with numbers or degrees along it.

    It is limited to ``values``, or begins at zero and has room for the ``largest``.
    """
    if by_angle:
        degrees(ax.xaxis)
    else:
        numeric(ax.xaxis, whole=whole)
    if values is not None:
        span(ax, values)
    if largest is not None:
        from_zero(ax, largest, name="x")
    if label:
        label_x(ax, label)


def y_axis(ax: Axes, *label: str, whole: bool = False, largest: float | None = None) -> None:
    """Label the vertical axis, with numbers along it; it begins at zero below the ``largest``."""
    numeric(ax.yaxis, whole=whole)
    if largest is not None:
        from_zero(ax, largest)
        if not largest:
            note_zero(ax)
    label_y(ax, *label)


def highest(ax: Axes) -> float:
    """Return the largest value of all series on axes."""
    lines = [line.get_ydata() for line in ax.lines if line.get_gid() == SERIES]
    return max((float(np.nanmax(values, initial=0.0)) for values in lines), default=0.0)


def zero_line(ax: Axes, **style: Any) -> None:  # noqa: ANN401 - of matplotlib
    """Draw the horizontal axis at zero."""
    ax.axhline(0.0, color=muted(ax, 0.35), linewidth=0.8, zorder=1, **style)


def name_rows(ax: Axes, names: Sequence[str], **style: Any) -> None:  # noqa: ANN401 - of matplotlib
    """Name rows on the left, the first on top."""
    ax.set_yticks(np.arange(len(names)), [plain_text(name) for name in names], **style)
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(max(len(names), 1) - 0.5, -0.5)  # of none, an empty row
