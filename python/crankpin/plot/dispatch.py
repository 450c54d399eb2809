"""The dispatch of pictures: one function for every kind of result."""

from __future__ import annotations

import functools
import inspect
import re
from typing import Any

import numpy as np
from matplotlib import pyplot as plt

from crankpin._support import inputs, units
from crankpin.plot.ticks import in_units

_UNKNOWN = re.compile(r"(?:unexpected keyword|multiple values for) argument '(\w+)'")


def draw(result: object, ax: object = None, **options: object) -> Any:  # noqa: ANN401 - axes
    """Draw a result on matplotlib axes, by default new ones; return the axes.

    The options are those of the result's ``plot`` method. Nothing is shown: notebooks show the
    figure, scripts call ``matplotlib.pyplot.show()``. An error leaves no figure.
    """
    takes_figure = "figure" in inspect.signature(picture.dispatch(type(result))).parameters
    if "figure" in options and not takes_figure:  # a property of lines too, which is not to be set
        raise inputs.rejected("figure", options["figure"], "this picture has one panel; give ax")
    before = plt.get_fignums()
    try:
        drawn = picture(result, ax, **options)
    except Exception as error:
        for made in set(plt.get_fignums()).difference(before):
            plt.close(made)
        unknown = _UNKNOWN.search(str(error))
        if unknown is None or not isinstance(error, (AttributeError, TypeError)):
            raise
        name = unknown[1]
        hint = "this picture has no such option, and what it draws no such property"
        raise inputs.rejected(name, options.get(name), hint) from None
    if units.current():
        in_units(np.ravel(drawn)[0].get_figure(root=True))
    return drawn


@functools.singledispatch
def picture(result: object, ax: object = None, **options: object) -> Any:  # noqa: ANN401 - axes
    """Draw a result; the functions that do are registered by its class."""
    raise inputs.rejected("result", result, "there is no picture of this kind")
