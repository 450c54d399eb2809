"""Dispatch of ``plot`` to the pictures that :mod:`crankpin.plot` registers for each class."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from crankpin._support import inputs, lazy, optional

_UNKNOWN = re.compile(r"(?:unexpected keyword|multiple values for) argument '(\w+)'")

PICTURES_PACKAGE = "crankpin.plot"
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
    lazy.imported(PICTURES_PACKAGE)
    figure = options.get("figure")
    takes_figure = "figure" in inspect.signature(picture.dispatch(type(result))).parameters
    if "figure" in options and not takes_figure:  # a property of lines too, which is not to be set
        raise inputs.rejected("figure", figure, "this picture has one panel; give ax")
    if ax is not None and figure is not None:
        raise inputs.faulty("ax and figure", "cannot be combined", "give one of them")
    if options.get("label") is not None:
        options["label"] = inputs.text("label", options["label"])
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


class Plot:
    """Method ``plot`` of a class: it draws, with the options that its picture documents."""

    __name__ = "plot"

    def __init__(self, kind: type = object, result: object = None) -> None:
        self._kind, self._result = kind, result
        self.__qualname__ = f"{kind.__name__}.plot"

    def __get__(self, result: object, kind: type) -> Plot:
        return Plot(kind, result)

    def __call__(self, *places: Any, **options: Any) -> Any:  # noqa: ANN401 - as `draw`
        return draw(*([] if self._result is None else [self._result]), *places, **options)

    @property
    def __signature__(self) -> inspect.Signature:
        """Signature: the axes, the figure of several panels, and the options of the picture."""
        drawing = _drawing(self._kind)
        keywords = [*inspect.signature(drawing).parameters.values()][1:]
        of_all = [
            name for name in FIRST_OPTIONS if any(name == keyword.name for keyword in keywords)
        ]
        places = [inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)]
        places = places if self._result is None else []
        parameters = [
            *places,
            inspect.Parameter("ax", inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None),
            *(
                keyword.replace(kind=inspect.Parameter.KEYWORD_ONLY)
                for keyword in sorted(keywords, key=lambda keyword: keyword.name not in of_all)
                if keyword.name != "ax" and keyword.kind is not keyword.VAR_KEYWORD
            ),
            inspect.Parameter("style", inspect.Parameter.VAR_KEYWORD),
        ]
        drawn = f"Axes{' | NDArray[Any]' * ('figure' in of_all)}"
        return inspect.Signature(parameters, return_annotation=drawn)

    @property
    def __doc__(self) -> str:  # type: ignore[override] # composed when it is read
        """Docstring of the drawing function, with the entries that all pictures share."""
        written = inspect.getdoc(_drawing(self._kind)) or ""
        head, *parts = SECTION.split(written)
        sections = dict(zip(parts[::2], parts[1::2], strict=True))
        parameters = self.__signature__.parameters
        several = "figure" in parameters
        entries = {"**style" if name == "style" else name: "" for name in parameters}
        entries.pop("self", None)
        entries |= {name: text for name, text in SHARED_OPTIONS.items() if name in entries}
        for entry in re.split(r"\n(?=\S)", sections.pop("Parameters", "").strip()):
            entries |= {entry.partition(" : ")[0]: entry} if entry else {}
        texts = {
            "Parameters": "\n".join(filter(None, entries.values())),
            "Returns": RETURNED[several],
            "Raises": RAISED[several],
        }
        texts |= {title: text.strip("\n") for title, text in sections.items()}
        body = (f"{title}\n{'-' * len(title)}\n{text}" for title, text in texts.items())
        return "\n\n".join([head.strip(), *body])


SECTION = re.compile(r"^([A-Z]\w+)\n-{3,}\n", re.MULTILINE)
"""Title of a section of a docstring."""
FIRST_OPTIONS = ("figure", "kind")
"""Options that stand before all others in signatures."""
SHARED_OPTIONS = {
    "ax": "ax : matplotlib.axes.Axes, optional\n    Axes to draw on; by default new ones.",
    "figure": "figure : Figure or SubFigure, optional\n"
    "    Figure or SubFigure for several panels; by default a new one.",
    "label": "label : str, optional\n    Entry of a legend, for several results on the same axes.",
    "**style": "**style : dict, optional\n"
    "    Colour, line width and other properties of what is drawn, as matplotlib takes them.",
}
"""Parameter → its entry in the docstring of a picture that documents it in no other way."""
RETURNED = (
    "matplotlib.axes.Axes\n    The axes.",
    "matplotlib.axes.Axes or ndarray of Axes\n    The axes; of several panels an array.",
)
"""What pictures of one panel, and those of several, return."""
RAISED = tuple(
    f"InputError\n    If an option is out of range{combined}.\n"
    "ImportError\n    If matplotlib is not installed."
    for combined in ("", ", or ``ax`` and ``figure`` are combined")
)


def _drawing(kind: type) -> Callable[..., Any]:
    """Return the function that draws a class; without matplotlib a description of any."""
    try:
        lazy.imported(PICTURES_PACKAGE)
    except ImportError:
        return picture.dispatch(object)
    return picture.dispatch(kind)


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
    lazy.imported(PICTURES_PACKAGE)
    return svg(result)


@functools.singledispatch
def svg(result: object) -> str:
    """Return a small picture as an SVG element; the functions that do are registered likewise."""
    raise inputs.rejected("result", result, "there is no small picture of this kind")
