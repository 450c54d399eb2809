"""The one import of pictures: engines and results draw themselves by :mod:`crankpin.plot`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from crankpin._support import optional

if TYPE_CHECKING:
    from crankpin.model.engine import Engine


def draw(result: object, ax: object = None, **options: object) -> Any:  # noqa: ANN401 - axes
    """Draw a result; matplotlib is imported here."""
    optional.library("matplotlib")
    from crankpin import plot  # noqa: PLC0415 - matplotlib is imported when used

    return plot.draw(result, ax, **options)


def inline_svg(engine: Engine) -> str | None:
    """Return a small picture of an engine as an SVG element; None without matplotlib."""
    try:
        optional.library("matplotlib")
    except ImportError:
        return None
    from crankpin import plot  # noqa: PLC0415 - as above

    return plot.inline_svg(engine)
