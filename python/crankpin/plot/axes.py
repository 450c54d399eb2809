"""Axes and figures: given ones or new ones, their titles and notes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import matplotlib as mpl
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.font_manager import FontProperties

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.plot.style import font_of, muted
from crankpin.plot.words import plain_text, shortened, wrapped

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


SHORT = 1.9
"""Inches of height below which axes get a short title."""
IN_A_ROW = 0.75
"""Part of their width that the layout leaves to axes beside others."""
BESIDE_A_SCALE = 0.55
"""The same where a scale of colours stands beside them too."""
TICK_LABELS = 0.12
"""Part of a figure's width that is beside axes; longer labels of ticks take width from them."""


class Panels(NamedTuple):
    """Panels of a picture, and the figure that they fill."""

    figure: FigureBase
    axes: NDArray[Any]
    """The panels: (rows, columns)."""


def one_panel(ax: Axes | None) -> Axes:
    """Return the axes given, or those of a new pyplot figure."""
    if ax is not None:
        if not isinstance(ax, Axes):
            raise InputError(f"ax = {inputs.shorten(ax)}: give matplotlib axes")
        return ax
    return plt.subplots(layout="constrained")[1]


def many_panels(
    figure: Any,  # noqa: ANN401 - checked
    rows: int,
    columns: int,
    *,
    row_height: float = 0.45,
    **options: Any,  # noqa: ANN401 - of Figure.subplots
) -> Panels:
    """Make panels in the figure given, or in a new pyplot figure.

    A new figure is as wide as ``rcParams["figure.figsize"]`` says; a row takes ``row_height`` of
    its height, and title and legend stand beside them. An
    empty figure without a layout engine gets a constrained layout.
    """
    if figure is None:
        width, height = mpl.rcParams["figure.figsize"]
        for_texts = 0.11 * mpl.rcParams["font.size"]
        extent = (width, height * row_height * rows + for_texts)
        figure = plt.figure(figsize=extent, layout="constrained")
    elif not isinstance(figure, FigureBase):
        shown = inputs.shorten(figure)
        raise InputError(f"figure = {shown}: give a matplotlib Figure or SubFigure")
    elif isinstance(figure, Figure) and not figure.axes and figure.get_layout_engine() is None:
        figure.set_layout_engine("constrained")
    return Panels(figure, figure.subplots(rows, columns, squeeze=False, **options))


def check_one_place(ax: object, figure: object) -> None:
    """Raise an InputError if both axes and a figure are given."""
    if ax is not None and figure is not None:
        raise InputError("ax and figure cannot be combined; give one of them")


def refuse_figure(figure: object, kind: str) -> None:
    """Raise an InputError if a figure is given to a kind of picture with one panel."""
    if figure is not None:
        shown = inputs.shorten(figure)
        raise InputError(f"figure = {shown}: kind={kind!r} has one panel; give ax")


def inches_of(place: Axes | FigureBase, extent: Literal["width", "height"] = "width") -> float:
    """Return the width or height of axes, or of a figure, in inches.

    Axes get their final extent when the figure is drawn: this is an estimate from their labels.
    """
    figure: Any = place.get_figure(root=True)
    framed: Any = place if isinstance(place, Axes) else place.patch  # type: ignore[attr-defined]
    inches = float(getattr(framed.get_window_extent(), extent) / figure.dpi)
    if extent == "width" and isinstance(place, Axes):
        names = place.yaxis.get_tightbbox()
        beside = TICK_LABELS * figure.get_figwidth()
        inches -= 0.0 if names is None else max(0.0, names.width / figure.dpi - beside)
    return max(inches, 0.5)


# --- titles and notes ---------------------------------------------------------------------------


def entitle(ax: Axes, *lines: str, pad: float | None = None) -> None:
    """Put lines above axes on the left; of several results, the lines that all have.

    Above short axes two lines, cut to their width. Call it after names are put on the vertical
    axis, which make axes narrower. ``pad`` is the distance in points, where the drawing has labels
    above the axes.
    """
    before = " ".join(ax.get_title(loc="left").split())
    if before:
        lines = tuple(line for line in lines if plain_text(line) in before)
    font, inches = font_of("axes.titlesize", "medium"), inches_of(ax)
    text = _block(lines, inches, font)
    if inches_of(ax, "height") < SHORT:
        kept = (shortened(line, 72.0 * inches, font) for line in lines[:2])
        text = plain_text("\n".join(kept))
    ax.set_title(text, loc="left", fontsize=font.get_size(), pad=pad)


def entitle_figure(figure: FigureBase, *lines: str) -> None:
    """Put lines above all panels of a figure on the left."""
    font = font_of("figure.titlesize", "medium")
    text = _block(lines, inches_of(figure) - 0.2, font)
    figure.suptitle(text, x=0.012, ha="left", fontsize=font.get_size())


def head(ax: Axes, text: str, pad: float | None = None, *, part: float = IN_A_ROW) -> None:
    """Put the name of a panel above it on the left; ``pad`` as of :func:`entitle`.

    ``part`` of the width of the axes will be left by the layout.
    """
    font = FontProperties(size="medium")
    block = _block([text], part * inches_of(ax), font)
    ax.set_title(block, loc="left", fontsize="medium", color=muted(ax), pad=pad)


def label_x(ax: Axes, text: str) -> None:
    """Label the horizontal axis, on several lines where it is short."""
    font = FontProperties(size=mpl.rcParams["axes.labelsize"])
    ax.set_xlabel(_block([text], 0.85 * inches_of(ax), font))


def label_y(ax: Axes, *lines: str) -> None:
    """Label the vertical axis, on more lines where it is short."""
    font = FontProperties(size=mpl.rcParams["axes.labelsize"])
    # Titles and a legend will leave no more than about half of the height.
    ax.set_ylabel(_block(lines, 0.5 * inches_of(ax, "height"), font))


def say_zero(ax: Axes) -> None:
    """Write that all values are zero."""
    text = ax.text(0.5, 0.56, "zero throughout", transform=ax.transAxes, color=muted(ax))
    text.set_horizontalalignment("center")


def _block(lines: Sequence[str], inches: float, font: FontProperties) -> str:
    return plain_text(wrapped("\n".join(line for line in lines if line), 72.0 * inches, font))
