"""Warnings reported at the line that calls crankpin."""

from __future__ import annotations

import contextlib
import re
import sys
import warnings
from contextvars import ContextVar
from typing import TYPE_CHECKING
from unicodedata import category

if TYPE_CHECKING:
    from collections.abc import Iterator

KEPT_CONTROLS = "\n\t"
"""Control characters that texts of several lines have."""

# Not the context manager of ``warnings``: that replaces the filters of all threads.
_suppressed: ContextVar[tuple[str, ...]] = ContextVar("suppressed", default=())


@contextlib.contextmanager
def suppressed(beginning: str = "") -> Iterator[None]:
    """Suppress this package's warnings that begin with a text, in this thread alone.

    For calls within a call that has warned already.
    """
    token = _suppressed.set((*_suppressed.get(), beginning))
    try:
        yield
    finally:
        _suppressed.reset(token)


def is_suppressed(beginning: str) -> bool:
    """Return whether warnings that begin so are suppressed: what they need is not computed."""
    return beginning.startswith(_suppressed.get())


def warn(message: str) -> None:
    """Warn the caller of crankpin, at the line of that call."""
    if is_suppressed(message):
        return
    level, frame = 1, sys._getframe()
    # By module, since constructors that dataclasses make have no file.
    while frame.f_back is not None and _ours(frame.f_globals.get("__name__", "")):
        level, frame = level + 1, frame.f_back
    warnings.warn(Said(without_controls(message)), UserWarning, stacklevel=level)


class Said(str):
    """Text of a warning, which Python shows once for a line of the caller, whatever its figures.

    In the loop of an optimiser every design has its own.
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Said):
            return _without_figures(self) == _without_figures(other)
        return str.__eq__(self, other) if isinstance(other, str) else NotImplemented

    def __hash__(self) -> int:
        return hash(_without_figures(self))


def _without_figures(text: str) -> str:
    return re.sub(r"(?<![\w.])-?\d[\d.]*(e[-+]?\d+)?", "#", str(text))


def _ours(module: str) -> bool:
    return module.partition(".")[0] == "crankpin"


def without_controls(text: str) -> str:
    """Return a text with spaces for control characters, which a terminal would obey.

    So are other characters that end a line, turn the direction of writing or cannot be seen; lines
    and tabs stay.
    """
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() or c in KEPT_CONTROLS or category(c) == "Zs" else " " for c in text
    )
