"""Dispatch of ``plot`` to the pictures that :mod:`crankpin.plot` registers for each class."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from crankpin._support import inputs, lazy, optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

_UNKNOWN = re.compile(r"(?:unexpected keyword|multiple values for) argument '(\w+)'")

PICTURES = "crankpin.plot"
"""Package of the pictures, which register themselves; it imports matplotlib."""
finishers: list[Callable[[Any], object]] = []
"""Change the figure of a picture that has been drawn."""


def draw(result: object, ax: object = None, **options: object) -> Any:  # noqa: ANN401 - axes
    """Draw a result on matplotlib axes, by default new ones; return the axes.

    The options are those of the result's ``plot`` method. Nothing is shown: notebooks show the
    figure, scripts call ``matplotlib.pyplot.show()``. An error leaves no figure.
    """
    optional.library("matplotlib")
    plt = optional.library("matplotlib.pyplot")
    lazy.imported(PICTURES)
    figure = options.get("figure")
    takes_figure = "figure" in inspect.signature(picture.dispatch(type(result))).parameters
    if "figure" in options and not takes_figure:  # a property of lines too, which is not to be set
        raise inputs.rejected("figure", figure, "this picture has one panel; give ax")
    if ax is not None and figure is not None:
        raise inputs.faulty("ax and figure", "cannot be combined", "give one of them")
    before = plt.get_fignums()
    try:
        drawn = picture(result, ax, **options)
    except Exception as error:
        for number in set(plt.get_fignums()).difference(before):
            plt.close(number)
        unknown = _UNKNOWN.search(str(error))
        if unknown is None or not isinstance(error, (AttributeError, TypeError)):
            raise
        name = unknown[1]
        hint = "this picture has no such option, and what it draws no such property"
        raise inputs.rejected(name, options.get(name), hint) from None
    for finisher in finishers:
        finisher(np.ravel(drawn)[0].get_figure(root=True))
    return drawn


class TwoPanels:
    """Base class of results whose picture has two panels, one above the other."""

    @overload
    def plot(self, ax: Axes, *, figure: None = None, **style: object) -> Axes: ...

    @overload
    def plot(
        self, ax: None = None, *, figure: Figure | SubFigure | None = None, **style: object
    ) -> NDArray[Any]: ...

    def plot(
        self, ax: Axes | None = None, *, figure: Figure | SubFigure | None = None, **style: object
    ) -> Axes | NDArray[Any]:
        """Draw the two panels of the picture, or with ``ax`` one of them alone; return the axes.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes for one panel alone; by default both are drawn in a new figure.
        figure : Figure or SubFigure, optional
            Figure or SubFigure for the panels.
        **style : dict, optional
            ``label`` and properties of matplotlib lines.

        Returns
        -------
        matplotlib.axes.Axes or ndarray of Axes
            The axes; of both panels an array.

        Raises
        ------
        InputError
            If ``ax`` and ``figure`` are both given.
        ImportError
            If matplotlib is not installed.
        """
        return draw(self, ax, figure=figure, **style)  # type: ignore[no-any-return]


@functools.singledispatch
def picture(result: object, ax: object = None, **options: object) -> Any:  # noqa: ANN401 - axes
    """Draw a result; the functions that do are registered by its class."""
    raise inputs.rejected("result", result, "there is no picture of this kind")


def inline_svg(result: object) -> str | None:
    """Return a small picture as an SVG element; None without matplotlib."""
    try:
        optional.library("matplotlib")
    except ImportError:
        return None
    lazy.imported(PICTURES)
    return svg(result)


@functools.singledispatch
def svg(result: object) -> str:
    """Return a small picture as an SVG element; the functions that do are registered likewise."""
    raise inputs.rejected("result", result, "there is no small picture of this kind")
