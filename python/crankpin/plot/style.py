"""Colours, dashes and marks of series, and of text before its background."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib import colors
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.patheffects import AbstractPathEffect
    from matplotlib.text import Text
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray


# Okabe and Ito's colours, which colour-blind readers distinguish. The foreground colour follows
# them in place of their black; yellow is too pale for a line.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DASHES: tuple[Any, ...] = (
    "-",
    (0, (5, 2)),
    (0, (1.5, 1.5)),
    (0, (6, 1.5, 1.5, 1.5)),
    (0, (9, 2)),
    (0, (4, 1.5, 1.5, 1.5, 1.5, 1.5)),
    (0, (2.5, 2.5)),
)
MARKERS = "os^Dv"
"""Marks of successive series."""
DISTINCT = len(DASHES)
"""Number of series that colours and dashes distinguish."""


# --- foreground and background ------------------------------------------------------------------


def foreground(ax: Axes) -> Any:  # noqa: ANN401 - a colour
    """Return the colour of text on axes, as it was when they were made."""
    return ax.title.get_color()


def background(ax: Axes) -> tuple[float, float, float]:
    """Return the colour behind the data, the figure's where the axes are transparent."""
    layers = [ax.get_facecolor()]
    figure: Any = ax.get_figure(root=False)
    while figure is not None:
        layers.append(figure.get_facecolor())
        parent = figure.get_figure(root=False)
        figure = None if parent is figure else parent
    red_green_blue = np.ones(3)
    for layer in reversed(layers):
        *rgb, alpha = colors.to_rgba(layer)
        red_green_blue = alpha * np.array(rgb) + (1.0 - alpha) * red_green_blue
    red, green, blue = red_green_blue.tolist()
    return red, green, blue


def is_dark(ax: Axes) -> bool:
    """Return whether the background is dark."""
    return float(np.mean(background(ax))) < 0.5


def muted(ax: Axes, strength: float = 0.65) -> tuple[float, float, float]:
    """Return a colour between background (0) and foreground (1), for what is secondary."""
    return tint(ax, foreground(ax), strength)


def tint(ax: Axes, colour: ColorType, strength: float) -> tuple[float, float, float]:
    """Return a colour between background (0) and another one (1)."""
    return blend(colour, background(ax), strength)


def blend(colour: ColorType, other: ColorType, strength: float) -> tuple[float, float, float]:
    """Return a colour between another one (0) and a first one (1)."""
    mixed = strength * np.array(colors.to_rgb(colour))
    mixed += (1.0 - strength) * np.array(colors.to_rgb(other))
    red, green, blue = mixed.tolist()
    return red, green, blue


# --- type ----------------------------------------------------------------------------------------


def font_of(parameter: str, relative: str) -> FontProperties:
    """Return the font of an rcParam, of a ``relative`` size where that is matplotlib's own."""
    now: Any = mpl.rcParams
    defaults: Any = mpl.rcParamsDefault
    size = now[parameter]
    return FontProperties(size=relative if size == defaults[parameter] else size)


# --- series -------------------------------------------------------------------------------------


def cycle(ax: Axes) -> list[dict[str, Any]]:
    """Return the colours and line styles of successive series.

    The property cycle of the style sheet in use, or, where that is matplotlib's own, Okabe and
    Ito's colours. Dashes are added unless the style sheet has its own.
    """
    entries = [dict(entry) for entry in mpl.rcParams["axes.prop_cycle"]]
    if mpl.rcParams["axes.prop_cycle"] == mpl.rcParamsDefault["axes.prop_cycle"]:
        entries = [{"color": colour} for colour in (*COLOURS, foreground(ax))]
    styles = []
    for k, entry in enumerate(entries):
        entry.setdefault("color", foreground(ax))
        styles.append({"linestyle": DASHES[k % len(DASHES)]} | entry)
    return styles


def colours(ax: Axes, count: int) -> list[Any]:
    """Return distinct colours: those of the cycle, or a scale if it is too short."""
    of_cycle = list(dict.fromkeys(colors.to_hex(entry["color"]) for entry in cycle(ax)))
    return list(of_cycle[:count]) if count <= len(of_cycle) else scale(ax, count)


def scale(ax: Axes, count: int) -> list[Any]:
    """Return colours of :func:`colour_map`, as far apart as they can be."""
    return list(colour_map(ax)(np.linspace(0.0, 1.0, count)))


def colour_map(ax: Axes) -> colors.Colormap:
    """Return viridis, without its end that is close to the background."""
    low, high = (0.2, 1.0) if is_dark(ax) else (0.0, 0.92)
    return colors.ListedColormap(mpl.colormaps["viridis"](np.linspace(low, high, 256)))


def of_maps() -> str:
    """Return the scale of colours of maps: that of the style sheet in use, or cividis.

    In place of matplotlib's own viridis: colour-blind readers see the same in it as others.
    """
    now: Any = mpl.rcParams
    defaults: Any = mpl.rcParamsDefault
    name = str(now["image.cmap"])
    return "cividis" if name == defaults["image.cmap"] else name


def series(ax: Axes, count: int, style: Mapping[str, Any] | None = None) -> list[dict[str, Any]]:
    """Return colours and line styles for the next series on axes, as keywords of a line.

    Keywords in ``style`` apply to all of them; with a colour given, dashes distinguish them.
    """
    options = mpl.cbook.normalize_kwargs(dict(style or {}), Line2D)
    options.pop("label", None)
    entries = cycle(ax)
    drawn = count_series(ax)
    return [entries[(drawn + k) % len(entries)] | options for k in range(count)]


SERIES = "crankpin series"
"""Marks the artist that stands for a series, by its gid."""


def count_series(ax: Axes) -> int:
    """Return the number of series on axes: of pictures, and labelled lines of the user."""
    ours = sum(artist.get_gid() == SERIES for artist in ax.get_children())
    theirs = sum(
        line.get_gid() is None and not str(line.get_label()).startswith("_") for line in ax.lines
    )
    return ours + theirs


# --- marks ---------------------------------------------------------------------------------------

MARK = "crankpin mark"
"""Marks rings by their gid."""


def once(ax: Axes, label: str) -> str:
    """Return a label, or ``_``, which makes no entry, where the legend of axes has it already."""
    return "_" if label in ax.get_legend_handles_labels()[1] else label


def ring(
    ax: Axes,
    x: NDArray[Any],
    y: NDArray[Any],
    colour: ColorType,
    marker: str,
    label: str,
    **style: object,
) -> None:
    """Draw hollow marks; the first with a label on the axes is its entry in the legend."""
    look = {"marker": marker, "markersize": 8.0, "markeredgewidth": 1.2, "zorder": 4, "gid": MARK}
    hollow(ax, x, y, colour, **look, markerfacecolor="none", label=once(ax, label), **style)


def hollow(
    ax: Axes, x: NDArray[Any], y: NDArray[Any], colour: ColorType, **style: object
) -> Line2D:
    """Draw circles with the colour of the background in them, such as those of zeros."""
    look: dict[str, Any] = {"linestyle": "", "marker": "o", "clip_on": False, "zorder": 3}
    look |= {"markeredgecolor": colour, "markerfacecolor": background(ax)}
    (line,) = ax.plot(x, y, **(look | style))
    # The layout would make room for a line without points at the figure's corner.
    line.set_in_layout(bool(len(x)))
    return line


def write(ax: Axes, text: str, place: complex, aside: complex, **style: Any) -> Text:  # noqa: ANN401
    """Write aside of a point x + iy by a distance in points, centred there but for the style."""
    look = {"ha": "center", "va": "center", "fontsize": "small", "textcoords": "offset points"}
    return ax.annotate(text, (place.real, place.imag), (aside.real, aside.imag), **(look | style))


def outlined(ax: Axes) -> list[AbstractPathEffect]:
    """Return the look of a text that is read over lines: a rim of the colour of the background."""
    return [withStroke(linewidth=2.5, foreground=background(ax))]


def write_at_mark(ax: Axes, x: float, y: float, text: str, *, beside: bool = False) -> Text:
    """Write above a mark, or beside it on the right."""
    low, high = ax.get_xlim()
    part = (x - low) / (high - low)
    within = "left" if part < 0.06 else "right" if part > 0.94 else "center"
    look: dict[str, Any] = {"ha": "left"} if beside else {"ha": within, "va": "bottom"}
    look["path_effects"] = outlined(ax)
    aside = 8.0 + 0j if beside else 7.0j
    return write(ax, text, complex(x, y), aside, color=foreground(ax), zorder=5, **look)


def entries_of(panels: NDArray[Any], *labels: str) -> list[Line2D]:
    """Return entries of a legend for the marks that some panel has."""
    drawn = {line.get_label(): line for panel in panels.flat for line in panel.lines}
    look = {"markeredgecolor": foreground(panels.flat[0]), "markerfacecolor": "none"}
    return [
        Line2D([], [], linestyle="", marker=drawn[label].get_marker(), label=label, **look)
        for label in labels
        if label in drawn
    ]
