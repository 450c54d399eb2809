"""Is every picture right on dark at a column's width, on plain axes and in a grid?"""

from __future__ import annotations

import functools
import inspect
import itertools
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import drawing
from crankpin.plot.firing import STROKE_COLOURS
from crankpin.plot.style import is_dark
from crankpin.plot.table import WITHOUT_PICTURE
from matplotlib import colors
from matplotlib import pyplot as plt
from matplotlib.text import Text
from support.looks import compared, in_a_grid, on_dark_column, on_plain_axes
from support.pictures import PICTURES
from support.shown_units import IMPERIAL, si_units

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@pytest.mark.parametrize("name", PICTURES)
@compared
def test_picture(name: str) -> Figure:
    return legible(on_dark_column(PICTURES[name]))


@pytest.mark.parametrize("name", PICTURES)
def test_picture_on_plain_axes_and_in_a_grid(name: str) -> None:
    """In units that are set: no text has others."""
    for placed in (on_plain_axes, in_a_grid):
        with cp.units(IMPERIAL):
            figure = placed(PICTURES[name])
            legible(figure)
            for text in figure.findobj(Text):
                assert not si_units(text.get_text()), text
        plt.close(figure)


def test_every_class_with_a_picture_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = set()

    @functools.singledispatch
    def note(result: object, ax: object = None, figure: object = None, **_: object) -> None:
        drawn.add(type(result))
        raise NotDrawnError

    painter = drawing.picture.dispatch
    monkeypatch.setattr(drawing, "picture", note)
    for plot in PICTURES.values():
        with pytest.raises(NotDrawnError):
            plot()
    public = {getattr(module, name) for module in (cp, cp.results) for name in module.__all__}
    painters = {inspect.unwrap(painter(each)) for each in public if hasattr(each, "plot")}
    assert painters - set(map(painter, WITHOUT_PICTURE)) == set(map(painter, drawn))


class NotDrawnError(Exception):
    """Instead of a picture."""


def legible(figure: Figure) -> Figure:
    """Return a figure whose texts are inside it, apart from each other, and seen."""
    figure.draw_without_rendering()
    panels = [ax for ax in figure.axes if ax.get_visible()]
    assert_legends_are_off_the_data(figure, panels)
    for ax in panels:
        assert_apart(list(_shown(ax.get_xticklabels())), "width")
        assert_seen(ax)
        assert_inside(figure, ax)
    return figure


def assert_inside(figure: Figure, ax: Axes) -> None:
    """Title, labels and legend of axes are within their figure, a pixel allowed for hinting."""
    texts = [ax.title, *(ax.get_title(loc="left") and [ax._left_title])]  # type: ignore[attr-defined]
    labels = [ax.xaxis.label, ax.yaxis.label] if ax.axison else []
    for artist in [*texts, *labels, ax.get_legend()]:
        if artist is not None and artist.get_visible():
            box = artist.get_window_extent()
            if box.width > 1.0:
                assert figure.bbox.padded(1.0).containsx(box.x0), artist
                assert figure.bbox.padded(1.0).containsx(box.x1), artist
                assert figure.bbox.padded(1.0).containsy(box.y0), artist
                assert figure.bbox.padded(1.0).containsy(box.y1), artist


def assert_legends_are_off_the_data(figure: Figure, panels: list[Axes]) -> None:
    legends = [ax.get_legend() for ax in panels]
    for part in [figure, *figure.subfigs]:
        legends += part.legends
    for legend, ax in itertools.product(filter(None, legends), panels):
        assert not legend.get_window_extent().shrunk(0.99, 0.99).overlaps(ax.get_window_extent())


def assert_apart(texts: list[Text], extent: str) -> None:
    """No two labels of ticks overlap."""
    boxes = sorted((text.get_window_extent() for text in texts), key=lambda box: box.x0)
    for left, right in itertools.pairwise(boxes):
        assert left.x1 <= right.x0 + 1.0, [text.get_text() for text in texts]


def assert_seen(ax: Axes) -> None:
    """Texts contrast with the background by half of the range of grey levels or so."""
    figure: Any = ax.get_figure(root=True)
    for text in [*ax.texts, ax.title, *ax.get_xticklabels(), *ax.get_yticklabels()]:
        behind = ax.get_facecolor() if text in ax.texts else figure.get_facecolor()
        if (name := text.get_gid()) in STROKE_COLOURS:  # a letter on a stroke
            behind = STROKE_COLOURS[str(name)][is_dark(ax)]
        assert abs(grey(text.get_color()) - grey(behind)) > 0.4


def grey(colour: Any) -> float:  # noqa: ANN401 - a colour
    return float(np.dot(colors.to_rgb(colour), (0.299, 0.587, 0.114)))


def _shown(labels: list[Text]) -> Iterator[Text]:
    """Labels of ticks within the limits of their axis."""
    for label in labels:
        ax = label.axes
        if label.get_visible() and label.get_text() and ax is not None:
            low, high = sorted(ax.get_xlim())
            if low <= label.get_position()[0] <= high:
                yield label
