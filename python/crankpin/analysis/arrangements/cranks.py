"""A crank and its banks as exact angles, equivalent cranks, and orders of throws."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from crankpin._support import inputs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from crankpin._core import InputError

Exact: TypeAlias = Fraction | int
"""Degrees; whole ones as int, which is some ten times as fast."""

TURN, HALF = 360, 180


def exact(text: str) -> Exact:
    """Return an angle that is given as exact text, such as ``"360/7"``."""
    return simple(Fraction(text))


def simple(angle: Fraction) -> Exact:
    """Return whole degrees as int."""
    return angle.numerator if angle.denominator == 1 else angle


@dataclasses.dataclass(frozen=True)
class Crank:
    """Crankpins and bank angle of a candidate; angles are exact degrees."""

    throws: tuple[Exact, ...]
    """Pins of the only or the right bank from the front one, in [0, 360)."""
    splits: tuple[Exact, ...]
    """Left pin minus right pin of each throw, in (−180, 180]; empty without banks."""
    bank_angle: Exact | None
    """Angle between the banks; None without."""

    @classmethod
    def of(
        cls, throws: Sequence[Exact], splits: Sequence[Exact] = (), bank_angle: Exact | None = None
    ) -> Crank:
        """Return the crank of these angles, reduced, and turned until its front throw is at 0."""
        return cls(
            tuple((throw - throws[0]) % TURN for throw in throws),
            tuple(HALF - (HALF - split) % TURN for split in splits),
            bank_angle,
        )

    @property
    def left(self) -> tuple[Exact, ...]:
        """Pins of the left bank, from the front pin of the right one; empty without banks."""
        if not self.splits:
            return ()
        return tuple(a + b for a, b in zip(self.throws, self.splits, strict=True))

    @property
    def throws_deg(self) -> tuple[float, ...]:
        """Throws as numbers."""
        return tuple(map(float, self.throws))

    @property
    def pin_split_deg(self) -> tuple[float, ...]:
        """Splits as numbers."""
        return tuple(map(float, self.splits))

    @property
    def tdc(self) -> tuple[Exact, ...]:
        """Top dead centres of the cylinders, numbered along the crank, less that of the first."""
        if self.bank_angle is None:
            return tuple(-throw % TURN for throw in self.throws)
        pairs = zip(self.throws, self.left, strict=True)
        return tuple(angle for a, b in pairs for angle in (-a % TURN, (self.bank_angle - b) % TURN))

    def mirrored(self) -> Crank:
        """Return the engine seen in a mirror that exchanges left and right.

        It turns the other way; accelerations are the same with time reversed, so that it shakes
        the same turning as before. A pin at p comes to 180° − p, in the other bank.
        """
        return Crank.of([-pin for pin in self.left or self.throws], self.splits, self.bank_angle)

    def reversed(self) -> Crank:
        """Return the engine with front and rear exchanged."""
        return Crank.of(self.throws[::-1], self.splits[::-1], self.bank_angle)

    def exchanged(self) -> Crank:
        """Return the engine with the banks exchanged: turned over, at 180°."""
        return Crank.of(self.left, [-split for split in self.splits], self.bank_angle)

    @property
    def text(self) -> str:
        """Throws as text, such as ``0-144-216-288-72``."""
        return "-".join(f"{float(throw):.6g}" for throw in self.throws)

    @property
    def splits_text(self) -> str:
        """Pin splits as text: one if all are equal; empty for shared pins."""
        if not any(self.splits):
            return ""
        texts = [f"{float(split):.6g}" for split in self.splits]
        return texts[0] if len(set(texts)) == 1 else ", ".join(texts)


@dataclasses.dataclass(frozen=True)
class Symmetries:
    """Changes of a crank that leave the size of every force, moment and torque as it is.

    A mirror moves an offset piston pin to the other side, and every single change the left bank
    from behind the right one to before it: what these break is left out.
    """

    offset: bool = False
    """True if piston pins are offset."""
    staggered: bool = False
    """True if one bank is behind the other."""

    def images(self, crank: Crank, *, exchange: bool = True) -> Iterator[tuple[str, Crank]]:
        """Yield the names of the changes, and the crank that each makes of this one.

        Banks are exchanged only at bank angles of 0 and 180; ``exchange=False`` leaves that out,
        for cranks whose bank angle is still to be found.
        """
        at_ends = exchange and crank.bank_angle in (0, HALF)
        for mirror, reverse, swap in itertools.product((False, True), repeat=3):
            done = {"mirrored": mirror, "reversed": reverse, "banks exchanged": swap}
            changes = [word for word, is_done in done.items() if is_done]
            if not changes or (mirror and self.offset) or (swap and not at_ends):
                continue
            if self.staggered and len(changes) % 2:
                continue
            image = crank.mirrored() if mirror else crank
            image = image.reversed() if reverse else image
            yield ", ".join(changes), image.exchanged() if swap else image

    def first(self, crank: Crank, *, exchange: bool = True) -> Crank:
        """Return the representative of all equivalent cranks: the first in order of size."""
        images = (image for _, image in self.images(crank, exchange=exchange))
        return min((crank, *images), key=_size)

    def key(self, crank: Crank) -> tuple[float, ...]:
        """Return the rounded angles that equivalent cranks at one bank angle have in common."""
        return _size(self.first(crank))


def _size(crank: Crank) -> tuple[float, ...]:
    """Return the sort key of a crank, rounded to the accuracy of an optimiser's angles."""
    splits = [part for split in crank.splits for part in (abs(split), split)]
    return tuple(round(float(angle), 4) % TURN for angle in (*crank.throws, *splits))


# --- the orders in which given throws can follow each other ---------------------------------------

MOST_CRANKS = 50_000
"""Cranks that are tried one by one: all orders of nine different throws are 40 320."""


def throw_orders(angles: Sequence[Exact]) -> Iterator[tuple[Exact, ...]]:
    """Yield all orders of some angles, of those that differ by a rotation at least one."""
    counts = Counter(angles)
    turns = [
        turn
        for turn in ((angle - angles[0]) % TURN for angle in counts)
        if Counter((angle + turn) % TURN for angle in angles) == counts
    ]
    number = math.factorial(len(angles)) // math.prod(map(math.factorial, counts.values()))
    if number > MOST_CRANKS * len(turns):
        raise too_many(len(angles))
    firsts = [angle for angle in counts if angle == min((angle + turn) % TURN for turn in turns)]
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
    fault = f"makes more than {MOST_CRANKS} cranks of {throws} throws"
    return inputs.faulty("throws_deg", fault, "give fewer different angles for them")
