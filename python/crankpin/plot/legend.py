"""Legends beside the data: below axes, or below all panels of a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.transforms import ScaledTranslation

from crankpin.plot.axes import inches_of
from crankpin.plot.style import font_of
from crankpin.plot.words import plain_text, shortened, width_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

MOST_ROWS = 2
"""Rows of a legend that is no wider than its axes."""
GAP = 4.0
"""Points between the labels of an axis and the legend."""
HANDLE, BETWEEN = 2.2, 1.2
"""Length of a line in a legend, and distance of its columns, in sizes of type."""


def legend_below(
    ax: Axes, title: str = "", *, last: str = "", handles: Sequence[Any] | None = None
) -> None:
    """Put a legend below axes and their label, in as many columns as fit.

    Of the handles given, or of all series: axes with a single series have none then. The entry
    named ``last`` comes after the others.
    """
    fewest = 2 if handles is None else 1
    handles = [*(ax.get_legend_handles_labels()[0] if handles is None else handles)]
    handles.sort(key=lambda handle: handle.get_label() == last)
    if len(handles) < fewest:
        return
    names = [str(handle.get_label()) for handle in handles]
    figure: Any = ax.get_figure(root=True)
    frame = ax.get_window_extent()
    below, beside = ax.xaxis.get_tightbbox(), ax.yaxis.get_tightbbox()
    down = 0.0 if below is None else max(0.0, frame.y0 - below.y0) / figure.dpi
    left, layout = 0.0, _layout(names, title, inches_of(ax))
    if beside is not None and len(names) > MOST_ROWS * layout["ncols"]:
        # Under the labels of the vertical axis there is room too.
        room = max(0.0, frame.x0 - beside.x0) / figure.dpi
        wider = _layout(names, title, inches_of(ax) + room)
        if wider["ncols"] > layout["ncols"]:
            left, layout = room, wider
    to_inches = ax.get_figure(root=False).dpi_scale_trans  # type: ignore[union-attr]
    ax.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=ax.transAxes + ScaledTranslation(-left, -down - GAP / 72.0, to_inches),
        borderaxespad=0.0,
        **layout,
    )


def figure_legend(figure: FigureBase, handles: Sequence[Any], title: str = "") -> None:
    """Put a legend below all panels of a figure, in as many columns as fit."""
    if not handles:
        return
    names = [str(handle.get_label()) for handle in handles]
    figure.legend(
        handles=handles,
        loc="outside lower left",
        **_layout(names, title, inches_of(figure)),
    )


def _layout(names: Sequence[str], title: str, inches: float) -> dict[str, Any]:
    """Return labels, title and number of columns of a legend so many inches wide."""
    font = font_of("legend.fontsize", "small")
    em, width = font.get_size_in_points(), 72.0 * inches
    of_handle = (HANDLE + mpl.rcParams["legend.handletextpad"]) * em
    spacing = BETWEEN * em
    pad = 2.0 * mpl.rcParams["legend.borderpad"] * em
    texts = [shortened(name, width - of_handle - pad, font) for name in names]
    widths = [width_of(text, font) + of_handle for text in texts]
    for columns in range(len(texts), 0, -1):
        parts = [float(part.max()) for part in np.array_split(widths, columns)]
        if sum(parts) + spacing * (len(parts) - 1) + pad <= width or columns == 1:
            break
    return {
        "labels": [plain_text(text) for text in texts],
        "ncols": columns,
        "prop": font,
        "title": plain_text(title) or None,
        "title_fontproperties": font,
        "alignment": "left",
        "handlelength": HANDLE,
        "columnspacing": BETWEEN,
        "labelspacing": 0.3,
        "frameon": False,
    }
