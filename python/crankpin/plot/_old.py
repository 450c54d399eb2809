"""Style and helpers that all pictures share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin.analysis.source import PLANE_VECTORS

try:
    import matplotlib as mpl
    from matplotlib import pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.ticker import FuncFormatter, MaxNLocator, MultipleLocator
except ImportError as error:
    raise ImportError('matplotlib is not installed: pip install "crankpin[plot]"') from error

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from crankpin.model.engine import Engine

# Okabe and Ito's colours, which colour-blind readers tell apart; yellow is too pale for a line.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
GREY = "#555555"
RED = "#C0282D"
"""Exhaust, as charts of valve periods have it; intake is the blue above."""
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 1.5, 1.5, 1.5)))

STEPS = [1, 2, 2.5, 5, 10]
"""Distances of ticks, times a power of ten."""
FEW_POINTS = 40
"""Up to so many points of a sweep are marked."""
FEW_BARS = 16
"""Up to so many bars carry their values."""
NARROW = 4.6
"""Inches below which a legend does not fit beside the title."""


def checked(quantity: object) -> str:
    """Return the name of a quantity."""
    return inputs.one_of("quantity", quantity, labels.UNITS)


def plain_text(text: str) -> str:
    """Return text that matplotlib shows unchanged: dollar signs would start a formula."""
    return text.replace("$", r"\$")


def by_component(values: NDArray[Any], quantity: str) -> NDArray[Any]:
    """Return values whose last dimension is the component: x and y, or z alone."""
    return values if quantity in PLANE_VECTORS else values[..., np.newaxis]


def name_of(engine: Engine) -> str:
    """Return the name of an engine, or its number of cylinders."""
    return engine.name or f"{len(engine)} cylinders"


def given_or_new(ax: Axes | None) -> Axes:
    """Return the axes given, or new ones."""
    if ax is not None:
        if not isinstance(ax, Axes):
            raise InputError(f"ax = {inputs.shorten(ax)}: give matplotlib axes")
        return ax
    return plt.subplots(figsize=(7.2, 4.2), layout="constrained")[1]


def dress(ax: Axes, along: Literal["x", "y"] = "y") -> None:
    """Make grid and frame light, and write numbers along the axis of the quantity."""
    ax.grid(visible=True, color="#DDDDDD", linewidth=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color("#999999")
    ax.tick_params(color="#999999")
    axis = ax.yaxis if along == "y" else ax.xaxis
    axis.set_major_locator(MaxNLocator(5, steps=STEPS))
    axis.set_major_formatter(FuncFormatter(plain))


def from_zero(ax: Axes, largest: float, along: Literal["x", "y"] = "y") -> None:
    """Let an axis begin at zero."""
    top = 1.08 * largest or 1.0
    if along == "x":
        ax.set_xlim(0.0, top)
    else:
        ax.set_ylim(0.0, top)
    if not largest:  # a scale of nothing would mislead
        (ax.xaxis if along == "x" else ax.yaxis).set_ticks([0.0])


def say_zero(ax: Axes) -> None:
    """Write that all values are zero."""
    ax.text(0.5, 0.56, "zero throughout", transform=ax.transAxes, ha="center", color=GREY)


def degrees(ax: Axes, values: NDArray[np.float64]) -> None:
    """Write degrees along the horizontal axis."""
    width = span(ax, values)
    for step, widest in ((15, 100), (30, 200), (60, 400), (90, 800), (180, 1600)):
        if 3 * step <= width <= widest:
            ax.xaxis.set_major_locator(MultipleLocator(step))
            break
    ax.xaxis.set_major_formatter(FuncFormatter(in_degrees))


def span(ax: Axes, values: NDArray[np.float64]) -> float:
    """Limit the horizontal axis to the values; return largest less smallest."""
    low, high = float(values.min(initial=np.inf)), float(values.max(initial=-np.inf))
    if high > low:
        ax.set_xlim(low, high)
    return high - low


def entitle(ax: Axes, title: str, subtitle: str) -> None:
    """Put the title above the axes on the left, the legend beside its second line."""
    ax.set_title(plain_text(f"{title}\n{subtitle}"), loc="left", fontsize=11)
    if len(ax.get_legend_handles_labels()[1]) > 1:
        width = ax.get_window_extent().width / ax.get_figure(root=True).dpi  # type: ignore[union-attr]
        if width < NARROW:
            ax.legend(loc="best", fontsize=8)
        else:
            ax.legend(
                loc="lower right",
                bbox_to_anchor=(1.0, 1.0),
                ncols=2,
                frameon=False,
                borderaxespad=0.1,
            )


def plain(value: float, _: object = None) -> str:
    """Format a tick."""
    return number(value)


def in_degrees(value: float, _: object = None) -> str:
    """Format a tick in degrees."""
    return f"{number(value)}°"


def number(value: float) -> str:
    """Write 12000.0 as 12 000, and minus as minus."""
    text = f"{value:,.10g}" if abs(value) >= 1e4 else f"{value:.10g}"
    return text.replace(",", "\N{NO-BREAK SPACE}").replace("-", "−")


def note_below(figure: Figure, text: str) -> None:
    """Write a line under a picture."""
    if text:
        # A label of the whole figure, for which the layout keeps room.
        figure.supxlabel(text, fontsize=8, color=GREY, x=0.012, ha="left")


def panels_of(ax: Any, shape: tuple[int, ...]) -> NDArray[Any]:  # noqa: ANN401 - axes
    """Return given axes as an array of this shape."""
    given = np.array(ax, dtype=object)
    if given.size != int(np.prod(shape)) or not all(isinstance(a, Axes) for a in given.flat):
        raise InputError(f"ax = {inputs.shorten(ax)}: give an array of matplotlib axes, {shape}")
    return given.reshape(shape)


def viridis(count: int) -> list[Any]:
    """Return colours of a scale, without its palest yellow."""
    return list(mpl.colormaps["viridis"](np.linspace(0.0, 0.92, count)))
