"""The dispatch of pictures: one function for every kind of result."""

from __future__ import annotations

import functools
from typing import Any

from crankpin._core import InputError
from crankpin._support import inputs


@functools.singledispatch
def draw(result: object, ax: Any = None, **options: Any) -> Any:  # noqa: ANN401 - axes
    """Draw a result on matplotlib axes, by default new ones; return the axes.

    The options are those of the result's ``plot`` method. Nothing is shown: notebooks show the
    figure, scripts call ``matplotlib.pyplot.show()``.
    """
    raise InputError(f"result = {inputs.shorten(result)}: there is no picture of this kind")
