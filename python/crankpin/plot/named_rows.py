"""Rows with names below each other, which several results on the same axes share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin.plot.style import count_series
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def names_there(ax: Axes) -> list[str]:
    """Return the names of the rows of results drawn on axes before."""
    return [text.get_text() for text in ax.get_yticklabels()] if count_series(ax) else []


def rows_for(
    ax: Axes,
    names: Sequence[str],
    **style: Any,  # noqa: ANN401 - of text
) -> NDArray[np.intp]:
    """Return the rows of these names, new ones below those there; name them on the left."""
    wanted = [plain_text(name) for name in names]
    every = list(dict.fromkeys([*names_there(ax), *wanted]))
    ax.set_yticks(np.arange(len(every)), every, **style)
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_ylim(len(every) - 0.5, -0.5)
    return np.array([every.index(name) for name in wanted], dtype=np.intp)


def wide_enough(ax: Axes, largest: float) -> None:
    """Let the horizontal axis begin at zero and have room for this value and those there."""
    there = ax.get_xlim()[1] if count_series(ax) else 0.0
    ax.set_xlim(0.0, max(there, 1.08 * largest) or 1.0)
