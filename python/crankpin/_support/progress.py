"""Progress of long calls: reported to a function, or shown by tqdm."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import TypeAlias

from crankpin._support import inputs, optional

Progress: TypeAlias = bool | Callable[[int, int], object]
"""True for a tqdm bar, or a function of (steps done, steps in all) that is called now and then."""


def shown(
    progress: Progress, description: str
) -> AbstractContextManager[Callable[[int, int], object] | None]:
    """Return a context with a function of the steps done and their total, or with None."""
    if checked(progress) is True:
        return _bar(description)
    return nullcontext(None if isinstance(progress, bool) else progress)


@contextmanager
def _bar(description: str) -> Iterator[Callable[[int, int], object]]:
    tqdm = optional.library("tqdm.auto")
    with tqdm.tqdm(desc=description, leave=False) as bar:

        def show(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        yield show


def checked(progress: object) -> Progress:
    """Return the argument if progress can be reported to it."""
    if progress is True:
        optional.library("tqdm.auto")
        return True
    if progress is False or callable(progress):
        return progress
    hint = "give True for a tqdm bar, or a function of (steps done, steps in all)"
    raise inputs.rejected("progress", progress, hint)
