"""The one import of pictures: results draw themselves by the dispatch of :mod:`crankpin.plot`."""

from __future__ import annotations

from typing import Any


def draw(result: object, ax: Any, **options: Any) -> Any:  # noqa: ANN401 - matplotlib's axes
    """Draw a result; matplotlib is imported here."""
    from crankpin import plot  # noqa: PLC0415 - matplotlib is imported when used

    return plot.draw(result, ax, **options)
