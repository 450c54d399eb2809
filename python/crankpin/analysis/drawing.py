"""The one import of pictures: results draw themselves by the dispatch of :mod:`crankpin.plot`."""

from __future__ import annotations

from typing import Any

from crankpin._support import optional


def draw(result: object, ax: Any = None, **options: Any) -> Any:  # noqa: ANN401 - matplotlib's axes
    """Draw a result; matplotlib is imported here."""
    optional.matplotlib()
    from crankpin import plot  # noqa: PLC0415 - matplotlib is imported when used

    return plot.draw(result, ax, **options)
