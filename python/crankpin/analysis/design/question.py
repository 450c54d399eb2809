"""Request of an inverse design: fixed values, free choices and their limits."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin.analysis.arrangements.cranks import (
    HALF,
    TURN,
    Crank,
    Exact,
    Symmetries,
    exact,
    simple,
)
from crankpin.analysis.design.unlike import Unlike, unknowns
from crankpin.model import checks
from crankpin.model.data import big_end

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin._support.inputs import Angle, Angles, Order
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Hold

Kind: TypeAlias = Literal["inline", "vee", "flat", "boxer"]
Range: TypeAlias = "Angle | tuple[Angle, Angle]"
"""One angle, or the lowest and the highest to choose from, degrees."""

MOST_CYLINDERS = 48


@dataclasses.dataclass(frozen=True)
class Question:
    """Arguments of :func:`crankpin.design`, checked; angles are exact degrees."""

    cylinders: int
    banks: int
    """1 or 2."""
    cylinder: Cylinder
    spacing: float
    bank_angle: tuple[Exact, Exact]
    """Lowest and highest; both 0 without banks."""
    pin_split: tuple[Exact, Exact]
    """Lowest and highest."""
    same_split: bool
    """True if all throws have one split."""
    throws: tuple[tuple[Exact, ...], ...]
    """Sets of throws to be put in order; empty where the firing determines them."""
    free_throws: bool
    """True if throws may have any angles."""
    strokes: int
    """4 or 2: strokes of a cycle."""
    intervals: tuple[Exact, ...] | None
    """Firing intervals that the engine must allow; None for any firing."""
    bank_stagger: float
    rotating_mass: float
    counterweights: bool
    """True if the forward part of the first order is removed by counterweights."""
    shafts: tuple[Order, ...]
    """Speed ratios of the balance shafts."""
    unlike: Unlike | None = None
    """Masses, places and throws of which some are to be chosen; None for equal cylinders."""

    @property
    def count(self) -> int:
        """Number of throws."""
        return self.cylinders // self.banks

    @property
    def tdcs(self) -> tuple[Exact, ...] | None:
        """Top dead centres that the firing needs, one for each cylinder; None for any firing."""
        if self.intervals is None:
            return None
        return tuple(time % TURN for time in itertools.accumulate(self.intervals[:-1], initial=0))

    def firing_order(self, crank: Crank) -> str:
        """Return a sequence in which a crank fires at the intervals; empty if it has none."""
        tdcs, intervals = crank.tdc, self.intervals or ()
        for k in range(len(intervals)):
            waiting: dict[Exact, list[int]] = {}
            for number, tdc in enumerate(tdcs, start=1):
                waiting.setdefault(tdc, []).append(number)
            text, time = "", tdcs[0]
            for interval in (*intervals[k:], *intervals[:k]):
                if not waiting.get(time % TURN):
                    break
                text += f"{waiting[time % TURN].pop(0)}{'-' if interval else '+'}"
                time += interval
            else:
                return text[:-1]
        return ""

    @property
    def hold(self) -> Hold:
        """Quantity held as the bank angle changes."""
        return "firing" if self.intervals is not None and not self.fixed_split else "pins"

    @property
    def fixed_split(self) -> bool:
        """True if there is one pin split."""
        return self.pin_split[0] == self.pin_split[1]

    @property
    def symmetries(self) -> Symmetries:
        """Changes of a crank that do not change how it shakes."""
        return Symmetries(offset=bool(self.cylinder.pin_offset), staggered=bool(self.bank_stagger))


def checked(
    cylinders: object,
    layout: object,
    *,
    cylinder: Cylinder,
    spacing: object,
    bank_angle_deg: Range | None,
    shared_pins: bool | None,
    pin_split_deg: Range | None,
    same_split: object,
    throws_deg: Angles | Sequence[Angle | None] | Literal["free"] | None,
    even_firing: object,
    intervals_deg: Angles | None,
    strokes: object,
    bank_stagger: object,
    rotating_mass: object,
    counterweights: object,
    shafts: Iterable[float | str | Fraction],
    masses: object = None,
    positions: object = None,
) -> Question:
    """Return the question that these arguments ask, or raise an InputError."""
    kind = inputs.one_of("layout", layout, ("inline", "vee", "flat", "boxer"))
    banks = 1 if kind == "inline" else 2
    number = _cylinders(cylinders, banks)
    cycle = inputs.strokes(strokes)
    intervals = _intervals(number, even_firing, intervals_deg, HALF * cycle)
    angles = _bank_angles(kind, bank_angle_deg)
    split = _splits(kind, shared_pins, pin_split_deg)
    stagger, same = (
        inputs.number("bank_stagger", bank_stagger),
        inputs.flag("same_split", same_split),
    )
    if banks == 1 and stagger:
        raise inputs.rejected(
            "bank_stagger", bank_stagger, Hint.of('`layout="inline"` has no banks')
        )
    if not same and split[0] == split[1]:
        raise inputs.rejected("same_split", same_split, "acts only where pin splits may vary")
    free = isinstance(throws_deg, str) and throws_deg == "free"
    if intervals is not None and throws_deg is not None:
        why = "the firing intervals determine the throws; leave out "
        hint = Hint.of(f"{why}`throws_deg`, or `even_firing` and `intervals_deg`")
        raise inputs.rejected("throws_deg", throws_deg, hint)
    count = number // banks
    balancers = inputs.flag("counterweights", counterweights) or any(_shafts(shafts))
    unlike = None
    if masses is not None or positions is not None:
        if kind != "inline" or intervals is not None or balancers:
            why = "unlike cylinders stand in line, with free firing and without balancers"
            name, value = ("positions", positions) if masses is None else ("masses", masses)
            raise inputs.rejected(name, value, why)
        if rotating_mass:
            why = "unlike cylinders are designed by their reciprocating masses; leave it out"
            raise inputs.rejected("rotating_mass", rotating_mass, why)
        step = inputs.optional_number("spacing", spacing)
        mass = cylinder.reciprocating_mass
        unlike = unknowns(count, masses, positions, step, mass, throws_deg)
        free, rotating_mass, spacing = True, 0.0, 1.0
    return Question(
        cylinders=number,
        banks=banks,
        cylinder=cylinder,
        spacing=inputs.number("spacing", spacing),
        bank_angle=angles,
        pin_split=split,
        same_split=same or split[0] == split[1],
        throws=() if intervals is not None or free else _throws(count, throws_deg),
        free_throws=free,
        strokes=cycle,
        intervals=intervals,
        bank_stagger=stagger,
        rotating_mass=(
            big_end(cylinder)
            if rotating_mass is None
            else inputs.number("rotating_mass", rotating_mass)
        ),
        counterweights=inputs.flag("counterweights", counterweights),
        shafts=_shafts(shafts),
        unlike=unlike,
    )


def _cylinders(cylinders: object, banks: int) -> int:
    number = inputs.whole("cylinders", cylinders)
    if not banks <= number <= MOST_CYLINDERS or number % banks:
        even = "an even number, 2" if banks == 2 else "a whole number, 1"
        raise inputs.rejected("cylinders", number, f"give {even} to {MOST_CYLINDERS}")
    return number


def _intervals(
    number: int, even_firing: object, intervals_deg: Angles | None, cycle: int
) -> tuple[Exact, ...] | None:
    even = inputs.flag("even_firing", even_firing)
    if intervals_deg is None:
        return (simple(Fraction(cycle, number)),) * number if even else None
    if even:
        raise inputs.rejected(
            "intervals_deg", intervals_deg, Hint.of("leave it out, or `even_firing`")
        )
    intervals = [exact(angle) for angle in inputs.angles("intervals_deg", intervals_deg)]
    if len(intervals) != number or sum(intervals) != cycle or min(intervals) < 0:
        hint = f"give {number} intervals, none negative, that add up to {cycle}"
        raise inputs.rejected("intervals_deg", intervals_deg, hint)
    return tuple(intervals)


def _spread(number: int, over: int) -> tuple[Exact, ...]:
    """Return equally spaced angles."""
    return tuple(simple(Fraction(over * k, number) % TURN) for k in range(number))


def _bank_angles(kind: str, bank_angle_deg: Range | None) -> tuple[Exact, Exact]:
    if kind != "vee":
        if bank_angle_deg is not None:
            what = "has no banks" if kind == "inline" else "has its banks at 180"
            raise inputs.rejected(
                "bank_angle_deg", bank_angle_deg, Hint.of(f'`layout="{kind}"` {what}; leave it out')
            )
        return (0, 0) if kind == "inline" else (HALF, HALF)
    if bank_angle_deg is None:
        hint = "give an angle, or two to choose between: (60, 90)"
        raise inputs.rejected("bank_angle_deg", bank_angle_deg, hint)
    return _range("bank_angle_deg", bank_angle_deg, 0, HALF)


def _splits(
    kind: str, shared_pins: bool | None, pin_split_deg: Range | None
) -> tuple[Exact, Exact]:
    shared = (
        pin_split_deg is None if shared_pins is None else inputs.flag("shared_pins", shared_pins)
    )
    if kind != "vee" and (pin_split_deg is not None or shared_pins is not None):
        what = "one cylinder on each pin" if kind == "inline" else "pins split by 180"
        hint = Hint.of(f"has {what}; leave out `shared_pins` and `pin_split_deg`")
        raise inputs.rejected("layout", kind, hint)
    if kind == "boxer":
        return (HALF, HALF)
    if shared and pin_split_deg is not None:
        raise inputs.rejected(
            "pin_split_deg", pin_split_deg, "shared pins have none; leave one out"
        )
    if shared:
        return (0, 0)
    if pin_split_deg is None:
        return -HALF, HALF
    return _range("pin_split_deg", pin_split_deg, -HALF, HALF)


def _range(name: str, limits: Range, low: Exact, high: Exact) -> tuple[Exact, Exact]:
    hint = f"give an angle, or the lowest and the highest, {low} to {high}"
    is_one = isinstance(limits, str) or not isinstance(limits, Iterable)
    ends: Sequence[Any] = (limits, limits)
    if not is_one and getattr(limits, "ndim", None) != 0:
        ends = inputs.items(name, limits, hint)
    if len(ends) != 2:
        raise inputs.rejected(name, limits, hint)
    first, last = (exact(inputs.angle(name, end)) for end in ends)
    if not low <= first <= last <= high:
        raise inputs.rejected(name, limits, hint)
    checks.radians(name, limits, ends)
    return first, last


def _throws(count: int, throws: object) -> tuple[tuple[Exact, ...], ...]:
    if throws is None:
        # Over two turns an even number of throws comes to half as many directions, each twice.
        return tuple(_spread(count, turns * TURN) for turns in ((1,) if count % 2 else (1, 2)))
    hint = f'give {count} angles to be put in order, or "free"'
    if isinstance(throws, str):
        raise inputs.rejected("throws_deg", throws, hint)
    angles = [exact(angle) % TURN for angle in inputs.angles("throws_deg", throws)]
    if len(angles) != count:
        raise inputs.rejected("throws_deg", throws, hint)
    return (tuple(angles),)


def _shafts(shaft_ratios: Iterable[float | str | Fraction]) -> tuple[Order, ...]:
    different = "give different speed ratios, multiples of 1/2 such as [-1] or [2, -2]"
    hint = Hint.of(f"{different}; for 1 give `counterweights=True`")
    entries = inputs.items("shafts", shaft_ratios, hint)
    ratios = [inputs.speed_ratio("shafts", ratio) for ratio in entries]
    if max(map(abs, ratios), default=0) > _core.HIGHEST_ORDER:
        raise inputs.rejected("shafts", entries, f"give ratios up to {_core.HIGHEST_ORDER}")
    if 1 in ratios or len(set(ratios)) < len(ratios):
        raise inputs.rejected("shafts", entries, hint)
    return tuple(ratios)
