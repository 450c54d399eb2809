"""Axes and figures, given or new; titles, labels and legends fitted to the available space."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.text import Text
from matplotlib.transforms import Bbox, ScaledTranslation

from crankpin._support import inputs, units
from crankpin.plot.style import font_of, muted
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from matplotlib.colorbar import Colorbar
    from matplotlib.font_manager import FontProperties
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

SHORT = 1.9
"""Inches of height of a subplot below which its title has at most two lines."""
LEAST_PART = 0.7
"""Part of their cell in a grid that texts take at least, however small the axes become."""
MOST_PASSES = 4
"""Layouts of a figure after which texts and legends stay as they are; most pictures take two."""
MOST_LEGEND_ROWS = 2
"""Rows of a legend that is no wider than its axes."""
LEGEND_GAP = 4.0
"""Points between the labels of an axis and the legend."""
HANDLE, BETWEEN = 2.2, 1.2
"""Length of a line in a legend, and distance of its columns, in sizes of type."""


Drawn: TypeAlias = "Axes | NDArray[Any]"
"""Return type of a picture: axes, or an array of axes."""
Kinds: TypeAlias = "dict[str, Callable[..., Drawn]]"
"""Kind of a picture → the function that draws it."""


class Panels(NamedTuple):
    """Panels of a picture, and the figure that they fill, or the axes that were given."""

    figure: FigureBase
    axes: NDArray[Any]
    """The panels: (rows, columns)."""
    single: bool = False
    """True for axes that were given: they take title and legend of the picture."""

    @property
    def drawn(self) -> Axes | NDArray[Any]:
        """Return value of a picture."""
        return self.axes[0, 0] if self.single else self.axes

    def set_title(self, *lines: str) -> None:
        """Put lines above all panels on the left."""
        if self.single:
            set_title(self.axes[0, 0], *lines)
        else:
            size = font_of("figure.titlesize", "medium").get_size()
            text = self.figure.suptitle("", x=0.012, ha="left", fontsize=size)
            _write(text, [line for line in lines if line], self.figure)

    def name_columns(self, names: Sequence[str]) -> None:
        """Put a name above each column of several panels."""
        for panel, name in zip(self.axes[0], [] if self.single else names, strict=False):
            set_panel_title(panel, name)

    def add_legend(self, handles: Sequence[Any], title: str = "") -> None:
        """Put a legend below all panels: of the handles, or of all series on given axes."""
        if self.single:
            add_legend(self.axes[0, 0], title)
        elif handles:
            _fit(self.figure, (self.figure, "legend"), _Legend(self.figure, handles, title, {}))


def draw_kind(
    kinds: Kinds, kind: object, result: object, ax: object, figure: object, **options: object
) -> Drawn:
    """Draw the picture of a kind; an option that is None has the default of the kind."""
    chosen = {name: value for name, value in options.items() if value is not None}
    return kinds[inputs.one_of("kind", kind, kinds)](result, ax, figure, **chosen)


def axes_or_new(ax: object) -> Axes:
    """Return the axes given, or those of a new pyplot figure."""
    if ax is not None and not isinstance(ax, Axes):
        raise inputs.rejected("ax", ax, "give matplotlib axes")
    return plt.subplots(layout=Layout())[1] if ax is None else ax


def make_panels(
    ax: object,
    figure: object,
    rows: int,
    columns: int,
    *,
    row_height: float = 0.45,
    **options: Any,  # noqa: ANN401 - of Figure.subplots
) -> Panels:
    """Make panels in the figure given, or in a new pyplot figure; or take the axes given.

    A new figure is as wide as ``rcParams["figure.figsize"]`` says; a row takes ``row_height`` of
    its height, and title and legend stand beside them.
    """
    if ax is not None:
        ax = axes_or_new(ax)
        return Panels(_root(ax), np.array([[ax]]), single=True)
    if figure is None:
        width, height = mpl.rcParams["figure.figsize"]
        for_texts = 0.11 * mpl.rcParams["font.size"]
        extent = (width, height * row_height * rows + for_texts)
        figure = plt.figure(figsize=extent, layout=Layout())
    elif not isinstance(figure, FigureBase):
        raise inputs.rejected("figure", figure, "give a matplotlib Figure or SubFigure")
    return Panels(figure, figure.subplots(rows, columns, squeeze=False, **options))


def reject_figure(figure: object, kind: str) -> None:
    """Raise an InputError if a figure is given to a kind of picture with one panel."""
    if figure is not None:
        raise inputs.rejected("figure", figure, f"kind={kind!r} has one panel; give ax")


def inches_of(place: Axes | FigureBase, extent: Literal["width", "height"] = "width") -> float:
    """Return the width or height of axes, or of a figure, in inches, as they are now."""
    return max(_extent(place, extent) / _root(place).dpi, 0.5)


def width_for(figure: object) -> float:
    """Return the width of a figure given, or of a new one, inches."""
    if isinstance(figure, FigureBase):
        return inches_of(figure)
    return float(mpl.rcParams["figure.figsize"][0])


def points_of(place: Axes | FigureBase, text: str, font: FontProperties) -> float:
    """Return the width of a line of text, points."""
    return 72.0 * _width(place, text, font) / _root(place).dpi if text.strip() else 0.0


# --- what is fitted when a figure is drawn ------------------------------------------------------


class Layout(ConstrainedLayoutEngine):
    """Constrained layout that fits texts and legends to the room it leaves them."""

    def __init__(self, **params: Any) -> None:  # noqa: ANN401 - of the base class
        super().__init__(**params)
        self.fits: dict[object, Callable[[], bool]] = {}
        """Artist → refits it, and returns whether that changed it."""

    def execute(self, fig: Figure) -> None:
        """Place the axes of a figure, and fit texts and legends to them."""
        for _ in range(MOST_PASSES):  # texts on more lines make axes smaller
            super().execute(fig)
            for ax in fig.axes:
                ax.apply_aspect()
            changed = [fit() for fit in self.fits.values()]
            if not any(changed):
                return
        super().execute(fig)


def _extent(place: Any, along: str) -> float:  # noqa: ANN401 - axes or a figure
    return float(getattr(place.bbox, along))


def _cell(ax: Axes, along: str) -> float:
    """Return the extent of the cell of axes in their grid, before any layout, pixels."""
    parent: Any = ax.get_figure(root=False)
    spec = ax.get_subplotspec()
    part = ax.get_position(original=True) if spec is None else spec.get_position(parent)
    return float(getattr(part, along)) * _extent(parent, along)


def _to_the_right(ax: Axes) -> float:
    """Return the pixels from the left of axes to the right end of their place.

    Axes of a given aspect are smaller than their place.
    """
    parent: Any = ax.get_figure(root=False)
    right, left = ax.get_position(original=True).x1, ax.get_position().x0
    return float(right - left) * _extent(parent, "width")


def _root(place: Axes | FigureBase) -> Figure:
    figure = place.get_figure(root=True)
    assert isinstance(figure, Figure)  # noqa: S101 - what is drawn has one
    return figure


def _fit(place: Axes | FigureBase, key: object, fit: Callable[[], bool]) -> None:
    """Fit something now, and again whenever its figure is drawn.

    Figures without a layout engine, or with matplotlib's constrained one, get ours; with another
    engine, or margins that were set by hand, things are fitted to the axes as they are now.
    """
    figure = _root(place)
    engine = figure.get_layout_engine()
    if engine is None and not _is_adjusted(figure):
        engine = Layout()
        figure.set_layout_engine(engine)
    elif type(engine) is ConstrainedLayoutEngine:
        engine = Layout(**engine.get(), compress=getattr(engine, "_compress", False))
        figure.set_layout_engine(engine)
    if isinstance(engine, Layout):
        engine.fits[key] = fit
    fit()


def _is_adjusted(figure: Figure) -> bool:
    margins = ("left", "right", "bottom", "top", "wspace", "hspace")
    usual: Any = mpl.rcParams
    return any(
        getattr(figure.subplotpars, margin) != usual[f"figure.subplot.{margin}"]
        for margin in margins
    )


def _width(place: Axes | FigureBase, text: str, font: FontProperties) -> float:
    """Return the width of a line of text, pixels."""
    sample = Text(0.0, 0.0, plain_text(text), fontproperties=font)
    sample.set_figure(_root(place))
    return float(sample.get_window_extent().width)


@dataclasses.dataclass
class _FittedText:
    """Lines of text, broken or cut to the extent of axes or a figure."""

    text: Text
    lines: Sequence[str]
    place: Axes | FigureBase
    along: Literal["width", "height"] = "width"
    most: int | None = None
    """Number of lines, each cut; None for as many as it takes."""

    def __call__(self) -> bool:
        room = self._room()
        if self.most is None:
            lines = [part for line in self.lines for part in self._broken(line, room)]
        else:
            lines = [_cut(self.place, line, room, self._font) for line in self.lines[: self.most]]
        before, now = self.text.get_text(), plain_text("\n".join(lines))
        self.text.set_text(now)
        return now != before

    def _room(self) -> float:
        """Return the extent in pixels; of axes at least a part of that of their cell.

        Without this limit narrow axes would break texts, which would make them narrower yet.
        """
        if not isinstance(self.place, Axes):
            return _extent(self.place, self.along)
        if self.text.get_horizontalalignment() == "left" and self.place.get_aspect() != "auto":
            return _to_the_right(self.place)
        parent: Any = self.place.get_figure(root=False)
        # Axes of a given aspect are smaller than their place.
        part: float = getattr(self.place.get_position(original=True), self.along)
        return max(part * _extent(parent, self.along), LEAST_PART * _cell(self.place, self.along))

    @property
    def _font(self) -> FontProperties:
        return self.text.get_fontproperties()

    def _broken(self, line: str, room: float) -> list[str]:
        """Break a line between words."""
        broken: list[str] = []
        for word in line.split(" "):
            longer = f"{broken[-1]} {word}" if broken else word
            if broken and _width(self.place, longer, self._font) <= room:
                broken[-1] = longer
            else:
                broken.append(word)
        return broken


def _cut(place: Axes | FigureBase, text: str, room: float, font: FontProperties) -> str:
    """Cut a line of text to some pixels, with an ellipsis."""
    short = text
    while _width(place, short, font) > room:
        shorter = text[: len(short) - 2]
        if not shorter:
            break
        # Words are left out whole where several remain.
        words, _, rest = shorter.rpartition(" ")
        text = words if len(words) > len(rest) else shorter
        short = f"{text.rstrip(' ,;:')}…"
    return short


# --- titles and labels --------------------------------------------------------------------------


def _write(
    text: Text,
    lines: Sequence[str],
    place: Axes | FigureBase,
    along: Literal["width", "height"] = "width",
    most: int | None = None,
) -> None:
    """Write lines, fitted to the extent of axes or a figure."""
    text.set_text(plain_text("\n".join(lines)))
    _fit(place, text, _FittedText(text, lines, place, along, most))


def set_title(ax: Axes, *lines: str, pad: float | None = None) -> None:
    """Put lines above axes on the left; of several results, the lines that all have.

    ``pad`` is the distance in points, where the drawing has labels above the axes.
    """
    before = " ".join(ax.get_title(loc="left").split())
    if before:
        lines = tuple(line for line in lines if plain_text(line) in before)
    size = font_of("axes.titlesize", "medium").get_size()
    remaining = [line for line in lines if line]
    text = ax.set_title("", loc="left", fontsize=size, pad=pad)
    short = _cell(ax, "height") < SHORT * _root(ax).dpi
    _write(text, remaining, ax, most=2 if short else None)


def set_panel_title(ax: Axes, *lines: str, pad: float | None = None) -> None:
    """Put the name of a panel above it on the left; ``pad`` as of :func:`set_title`."""
    look: dict[str, Any] = {"loc": "left", "fontsize": "medium", "color": muted(ax), "pad": pad}
    _write(ax.set_title("", **look), lines, ax)


def label_x(ax: Axes, text: str) -> None:
    """Label the horizontal axis, on several lines where it is short."""
    _write(ax.xaxis.label, in_units(ax.xaxis, text), ax)


def label_y(ax: Axes, *lines: str) -> None:
    """Label the vertical axis, on more lines where it is short."""
    _write(ax.yaxis.label, in_units(ax.yaxis, *lines), ax, "height")


def label_bar(bar: Colorbar, text: str) -> None:
    """Label a scale of colours."""
    label_y(bar.ax, text)


def equal_scales(ax: Axes) -> None:
    """Give x and y one scale, by limits; where axes share both, by the size of their boxes."""
    shared = (ax.get_shared_x_axes(), ax.get_shared_y_axes())
    both = all(len(axes.get_siblings(ax)) > 1 for axes in shared)
    ax.set_aspect("equal", adjustable="box" if both else "datalim")


def in_units(axis: Any, *lines: str) -> list[str]:  # noqa: ANN401 - of matplotlib
    """Return a label in the units of the setting, in which the numbers along an axis are written.

    What is drawn remains in the unit of the result; ticks are where round numbers of the other are.
    """
    axis.crankpin_factor = units.factor_of(lines[-1])
    return [units.shown(line) for line in lines]


def note_zero(ax: Axes, color: ColorType | None = None) -> None:
    """Write that all values are zero."""
    ink = muted(ax) if color is None else color
    text = ax.text(0.5, 0.56, "zero throughout", transform=ax.transAxes, color=ink)
    text.set_horizontalalignment("center")


def keep_apart(ax: Axes, texts: Sequence[Text]) -> None:
    """Hide texts that would overlap one before them, wherever the figure is drawn."""
    if len(texts) > 1:
        _fit(ax, texts[0], _Apart(texts))


@dataclasses.dataclass
class _Apart:
    """Texts of which those are shown that overlap none before them."""

    texts: Sequence[Text]

    def __call__(self) -> bool:
        boxes: list[Bbox] = []
        changed = False
        for text in self.texts:
            before = text.get_visible()
            text.set_visible(True)  # the extent of hidden texts is nothing
            box = text.get_window_extent()
            is_free = not any(box.overlaps(other) for other in boxes)
            boxes += [box] if is_free else []
            text.set_visible(is_free)
            changed |= is_free != before
        return changed


# --- legends ------------------------------------------------------------------------------------


def add_legend(
    ax: Axes,
    title: str = "",
    *,
    last: str = "",
    handles: Sequence[Any] | None = None,
    **style: object,
) -> None:
    """Put a legend below axes and their label, in as many columns as fit.

    Of the handles given, or of all series: axes with a single series have none then. The entry
    named ``last`` comes after the others.
    """
    fewest = 2 if handles is None else 1
    handles = [*(ax.get_legend_handles_labels()[0] if handles is None else handles)]
    handles.sort(key=lambda handle: handle.get_label() == last)
    if len(handles) >= fewest:
        _fit(ax, (ax, "legend"), _Legend(ax, handles, title, style))


@dataclasses.dataclass
class _Legend:
    """Legend below axes or figures, its columns as many as fit beside each other."""

    place: Axes | FigureBase
    handles: Sequence[Any]
    title: str
    style: dict[str, Any]
    legend: Any = None
    """The legend, when it has been made."""
    how: object = None
    """Its arrangement."""

    def __call__(self) -> bool:
        if self.legend is not None and self.legend.get_figure(root=True) is None:
            return False  # removed
        names = [str(handle.get_label()) for handle in self.handles]
        left, down = 0.0, 0.0
        place = self.place
        across = _to_the_right(place) if isinstance(place, Axes) else _extent(place, "width")
        arranged = self._arranged(names, across)
        if isinstance(self.place, Axes):
            dpi, frame = _root(self.place).dpi, self.place.bbox
            below, beside = self.place.xaxis.get_tightbbox(), self.place.yaxis.get_tightbbox()
            down = 0.0 if below is None else max(0.0, frame.y0 - below.y0) / dpi
            room = 0.0 if beside is None else max(0.0, frame.x0 - beside.x0)
            if len(names) > MOST_LEGEND_ROWS * arranged["ncols"]:
                # Under the labels of the vertical axis there is room too.
                wider = self._arranged(names, across + room)
                if wider["ncols"] > arranged["ncols"]:
                    left, arranged = room / dpi, wider
        how = (arranged["ncols"], arranged["labels"], round(left, 2), round(down, 2))
        if how == self.how:
            return False
        self.how = how
        if self.legend is not None:
            self.legend.remove()
        self.legend = self.place.legend(handles=self.handles, **arranged, **self._at(left, down))
        return True

    def _at(self, left: float, down: float) -> dict[str, Any]:
        """Return where the legend is: below the labels of axes, or at the foot of a figure."""
        if not isinstance(self.place, Axes):
            return {"loc": "outside lower left"}
        to_inches = self.place.get_figure(root=False).dpi_scale_trans  # type: ignore[union-attr]
        shift = ScaledTranslation(-left, -down - LEGEND_GAP / 72.0, to_inches)
        return {
            "loc": "upper left",
            "bbox_to_anchor": (0.0, 0.0),
            "bbox_transform": self.place.transAxes + shift,
            "borderaxespad": 0.0,
        }

    def _arranged(self, names: Sequence[str], pixels: float) -> dict[str, Any]:
        """Return labels, title and number of columns of a legend of this width in pixels."""
        font = font_of("legend.fontsize", "small")
        if "fontsize" in self.style:
            font.set_size(self.style["fontsize"])
        em = font.get_size_in_points() * _root(self.place).dpi / 72.0
        handle, between = (self.style.get("handlelength", HANDLE), BETWEEN)
        of_handle = (handle + mpl.rcParams["legend.handletextpad"]) * em
        pad = 2.0 * mpl.rcParams["legend.borderpad"] * em
        texts = [_cut(self.place, name, pixels - of_handle - pad, font) for name in names]
        widths = [_width(self.place, text, font) + of_handle for text in texts]
        for columns in range(len(texts), 0, -1):
            parts = [float(part.max()) for part in np.array_split(widths, columns)]
            if sum(parts) + between * em * (len(parts) - 1) + pad <= pixels or columns == 1:
                break
        return {
            "labels": [plain_text(text) for text in texts],
            "ncols": columns,
            "prop": font,
            "title": plain_text(self.title) or None,
            "title_fontproperties": font,
            "alignment": "left",
            "handlelength": handle,
            "columnspacing": between,
            "labelspacing": 0.3,
            "frameon": False,
        }
