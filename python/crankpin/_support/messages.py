"""Parts of errors and warnings: names of arguments in hints, and warnings at the line of a call."""

from __future__ import annotations

import contextlib
import sys
import warnings
from contextvars import ContextVar
from itertools import zip_longest
from typing import TYPE_CHECKING, NamedTuple, Self
from unicodedata import category

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from crankpin._core import InputError

KEPT_CONTROLS = "\n\t"
"""Control characters that texts of several lines have."""

# --- hints ----------------------------------------------------------------------------------------


class Name(NamedTuple):
    """Name in a hint: of an argument, with a value for it, or of a method, ``Engine.vee``."""

    name: str
    value: str = ""
    """The value as Python writes it; empty where the name stands alone."""

    @property
    def text(self) -> str:
        """The name as Python writes it."""
        return f"{self.name}={self.value}" if self.value else self.name


class Hint(str):
    """What would be right: words, and names of arguments, which a shell calls otherwise."""

    __slots__ = ("parts",)
    parts: tuple[str | Name, ...]

    def __new__(cls, *parts: str | Name) -> Self:
        """Return the hint of words, names and other hints."""
        flat = [
            one for part in parts for one in (part.parts if isinstance(part, Hint) else (part,))
        ]
        hint = super().__new__(cls, "".join(map(_python, flat)))
        hint.parts = tuple(flat)
        return hint

    @classmethod
    def of(cls, text: str) -> Self:
        """Return the hint of a text with names in backticks: ``give `orders=[1, 2]` ``."""
        pieces = text.split("`")
        names = (
            Name(name, value) for name, _, value in (code.partition("=") for code in pieces[1::2])
        )
        return cls(
            *(part for pair in zip_longest(pieces[::2], names, fillvalue="") for part in pair)
        )

    def __reduce__(self) -> tuple[type[Hint], tuple[str | Name, ...]]:
        """Return what copies and pickles are made of."""
        return type(self), self.parts

    def named(self, call: Callable[[Name], str]) -> str:
        """Return the hint with names as another calls them."""
        return "".join(call(part) if isinstance(part, Name) else part for part in self.parts)


def _python(part: str | Name) -> str:
    return part.text if isinstance(part, Name) else part


def of_pieces(pieces: Sequence[tuple[str, str | None]]) -> Hint:
    """Return a hint of the core: words, and names with their values."""
    return Hint(*(text if value is None else Name(text, value) for text, value in pieces))


def hint_of(error: InputError) -> Hint:
    """Return the hint of an error with its names; an empty one of an error without."""
    pieces = getattr(error, "_pieces", None)  # of the core
    return Hint(error.hint or "") if pieces is None else of_pieces(pieces)


# --- warnings -------------------------------------------------------------------------------------

# Not the context manager of ``warnings``: that replaces the filters of all threads.
_suppressed: ContextVar[tuple[str, ...]] = ContextVar("suppressed", default=())


@contextlib.contextmanager
def suppressed(about: str = "") -> Iterator[None]:
    """Suppress this package's warnings, or those about one thing, in this thread alone.

    For calls within a call that has warned already.
    """
    token = _suppressed.set((*_suppressed.get(), about))
    try:
        yield
    finally:
        _suppressed.reset(token)


def is_suppressed(about: str) -> bool:
    """Return whether warnings about this are suppressed: what they need is not computed."""
    return not {"", about}.isdisjoint(_suppressed.get())


class Entry(NamedTuple):
    """A warning in parts: ``stroke``, ``= 86 m``, ``was it given in millimetres?``."""

    about: str
    """What is implausible: an argument, or what the sentence begins with."""
    fault: str
    """What it is or has, with its figures."""
    hint: Hint
    """The likely mistake, the same whatever the figures; may be empty."""

    @property
    def text(self) -> str:
        """The sentence."""
        return f"{self.about} {self.fault}{': ' if self.hint else ''}{self.hint}"


def warn(about: str, fault: str, hint: str = "") -> None:
    """Warn the caller of crankpin, at the line of that call."""
    warn_of([Entry(about, fault, Hint(hint))])


def warn_of_core(entries: Sequence[tuple[str, str, Sequence[tuple[str, str | None]]]]) -> None:
    """Warn of what the core reports, of each by itself."""
    if entries:
        for entry in of_core(entries):
            warn_of([entry])


def of_core(entries: Sequence[tuple[str, str, Sequence[tuple[str, str | None]]]]) -> list[Entry]:
    """Return warnings of the core."""
    return [Entry(about, fault, of_pieces(pieces)) for about, fault, pieces in entries]


def warn_of(entries: Sequence[Entry], closing: str = "") -> None:
    """Warn the caller of crankpin of several things at once, and close with a sentence."""
    heard = [entry for entry in entries if not is_suppressed(entry.about)]
    if not heard:
        return
    level, frame = 1, sys._getframe()
    # By module, since constructors that dataclasses make have no file.
    while frame.f_back is not None and _ours(frame.f_globals.get("__name__", "")):
        level, frame = level + 1, frame.f_back
    warnings.warn(WarningText(heard, closing), UserWarning, stacklevel=level)


class WarningText(str):
    """Text of a warning, which Python shows once for a line of the caller, whatever its figures.

    In the loop of an optimiser every design has its own.
    """

    __slots__ = ("closing", "entries")
    entries: tuple[Entry, ...]
    closing: str

    def __new__(cls, entries: Sequence[Entry], closing: str = "") -> Self:
        """Return the text of entries."""
        sentences = "; ".join(entry.text for entry in entries)
        text = super().__new__(cls, without_controls(f"{sentences} {closing}".rstrip()))
        text.entries, text.closing = tuple(entries), closing
        return text

    def __reduce__(self) -> tuple[type[WarningText], tuple[tuple[Entry, ...], str]]:
        """Return what copies and pickles are made of."""
        return type(self), (self.entries, self.closing)

    @property
    def _kind(self) -> tuple[tuple[str, str], ...]:
        return tuple((entry.about, str(entry.hint)) for entry in self.entries)

    def __eq__(self, other: object) -> bool:
        return self._kind == other._kind if isinstance(other, WarningText) else str(self) == other

    def __hash__(self) -> int:
        return hash(self._kind)


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
