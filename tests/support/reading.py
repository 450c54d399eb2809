"""Reads what a picture shows: series, marks, legends and ticks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from numpy.typing import NDArray


def series(ax: Axes) -> list[Line2D]:
    """Lines that stand for results, in the sequence in which they were drawn."""
    return [line for line in ax.lines if line.get_gid() == "crankpin series"]


def heights(ax: Axes) -> NDArray[np.float64]:
    """Values of all series: (n_series, n_points)."""
    return np.array([line.get_ydata() for line in series(ax)])


def marks(ax: Axes) -> dict[str, list[tuple[float, float]]]:
    """Shape of a mark → the points that carry it."""
    found: dict[str, list[tuple[float, float]]] = {}
    for line in ax.lines:
        if line.get_gid() == "crankpin mark":
            points = zip(
                np.asarray(line.get_xdata()).tolist(),
                np.asarray(line.get_ydata()).tolist(),
                strict=True,
            )
            found.setdefault(str(line.get_marker()), []).extend(points)
    return found


def legend_texts(place: Any) -> list[str]:  # noqa: ANN401 - axes, or a figure with one legend
    legend = place.get_legend() if hasattr(place, "get_legend") else place.legends[0]
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def title_of(ax: Axes) -> str:
    """The title on the left."""
    return ax.get_title(loc="left")


def xtick_texts(ax: Axes) -> list[str]:
    ax.figure.canvas.draw()
    low, high = ax.get_xlim()
    inside = [low <= place <= high for place in ax.get_xticks()]
    return [t.get_text() for t, seen in zip(ax.get_xticklabels(), inside, strict=True) if seen]


def figure_of(axes: Any) -> Any:  # noqa: ANN401 - axes and a figure
    """The figure of an array of axes."""
    return np.ravel(axes)[0].get_figure(root=True)
