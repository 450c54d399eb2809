"""The orders in which given throws can follow each other along the crank."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

from crankpin._core import InputError
from crankpin.analysis.arrangements.cranks import TURN, Exact

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

MOST_CRANKS = 50_000
"""Cranks that are tried one by one: all orders of nine different throws are 40 320."""


def throw_orders(angles: Sequence[Exact]) -> Iterator[tuple[Exact, ...]]:
    """Yield all orders of some angles, of those that differ by a rotation at least one."""
    counts = Counter(angles)
    turns = [
        turn
        for turn in ((each - angles[0]) % TURN for each in counts)
        if Counter((each + turn) % TURN for each in angles) == counts
    ]
    number = math.factorial(len(angles)) // math.prod(map(math.factorial, counts.values()))
    if number > MOST_CRANKS * len(turns):
        raise too_many(len(angles))
    firsts = [each for each in counts if each == min((each + turn) % TURN for turn in turns)]
    for first in firsts:
        for rest in permutations(counts - Counter([first])):
            yield (first, *rest)


def permutations(counts: Counter[Exact]) -> Iterator[tuple[Exact, ...]]:
    """Yield all different orders of some angles."""
    if not counts:
        yield ()
    for first in counts:
        for rest in permutations(counts - Counter([first])):
            yield (first, *rest)


def too_many(throws: int) -> InputError:
    """Return the error of more cranks than can be tried."""
    return InputError(
        f"{throws} throws have more than {MOST_CRANKS} cranks: give fewer different throws_deg, or "
        "leave pins shared, or split alike"
    )
