"""When does an engine fire, worked out by trying every choice?

Plain Python, in whole fractions of a degree: each cylinder of a four-stroke fires at its top dead
centre of the first or of the second turn, all choices are written down and sorted. A crankpin
points along the bore when its piston is at the top; overlaps of valve periods are counted degree
by degree.

The cross-plane page's gaps and the IJESC paper's engine are at the end.
"""

from __future__ import annotations

import cmath
import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

CROSSPLANE = "1-8-4-3-6-5-7-2"
CROSSPLANE_GAPS = {(1, 3): 270, (3, 5): 180, (5, 7): 90, (7, 1): 180}  # the page's left bank


class Way(NamedTuple):
    """One way to fire."""

    order: tuple[int, ...]
    """From cylinder 1; cylinders that fire together by number."""
    intervals: tuple[Fraction, ...]
    times: tuple[Fraction, ...]
    """By cylinder, after cylinder 1's firing."""


def numbers(firing_order: str) -> tuple[int, ...]:
    """Cylinder numbers of ``"1-3-4-2"``."""
    return tuple(int(number) for number in firing_order.split("-"))


def ways(tdc: Sequence[Fraction | int], strokes: int = 4) -> list[Way]:
    """Every way to fire for these top dead centres, degrees."""
    cycle = 180 * strokes
    turns = [0] if strokes == 2 else [0, 360]
    found = []
    for choice in itertools.product([0], *[turns] * (len(tdc) - 1)):
        times = tuple(
            (Fraction(top) - Fraction(tdc[0])) % 360 + turn
            for top, turn in zip(tdc, choice, strict=True)
        )
        order = sorted(range(len(tdc)), key=lambda i: (times[i], i))
        stops = [times[i] for i in order] + [Fraction(cycle)]
        intervals = tuple(after - before for before, after in itertools.pairwise(stops))
        found.append(Way(tuple(i + 1 for i in order), intervals, times))
    return found


def ways_of(
    firing_order: str, tdc: Sequence[Fraction | int], strokes: int = 4
) -> list[tuple[Fraction, ...]]:
    """Intervals of every way to fire in this order, one cylinder after the other."""
    order = numbers(firing_order)
    return [way.intervals for way in ways(tdc, strokes) if way.order == order and min_positive(way)]


def min_positive(way: Way) -> bool:
    """Whether no two cylinders fire together."""
    return all(interval > 0 for interval in way.intervals)


def gaps(way: Way, group: Iterable[int], cycle: int = 720) -> dict[tuple[int, int], Fraction]:
    """Crank angle from each cylinder of a group to the next of it to fire."""
    members = [number for number in way.order if number in set(group)]
    following = members[1:] + members[:1]
    return {
        (a, b): (way.times[b - 1] - way.times[a - 1]) % cycle or Fraction(cycle)
        for a, b in zip(members, following, strict=True)
    }


def both_open(way: Way, pair: tuple[int, int], exhaust_opens: int, exhaust_closes: int) -> int:
    """For how many degrees of a cycle both exhaust valves are open, counted one by one."""
    open_ = []
    for number in pair:
        top = way.times[number - 1]
        opens, closes = top + 180 - exhaust_opens, top + 360 + exhaust_closes
        open_.append({(opens + k) % 720 for k in range(int(closes - opens))})
    return len(open_[0] & open_[1])


def both_ports_open(way: Way, pair: tuple[int, int], opens: int) -> int:
    """For how many degrees of a turn both exhaust ports are open, counted one by one.

    A piston uncovers its port some degrees before bottom dead centre and covers it as many after.
    """
    first, second = (
        {int(way.times[number - 1] + 180 + k) % 360 for k in range(-opens, opens)}
        for number in pair
    )
    return len(first & second)


def pins(
    firing_order: str,
    intervals: Sequence[Fraction | int],
    bank_angle: int,
    odd_bank: str,
    numbering: str,
) -> tuple[list[Fraction], list[Fraction]]:
    """Right crankpins from the front one, and left minus right, for a vee that fires so.

    A cylinder that fires at time t has its pin along its bore then: at bank - t.
    """
    order = numbers(firing_order)
    count = len(order)
    time = dict(zip(order, itertools.accumulate([Fraction(0), *intervals[:-1]]), strict=True))
    pin: dict[tuple[str, int], Fraction] = {}
    for number in order:
        if numbering == "alternating":
            throw, with_first = (number - 1) // 2, number % 2 == 1
        else:
            throw, with_first = (number - 1) % (count // 2), number <= count // 2
        other = {"right": "left", "left": "right"}[odd_bank]
        side = odd_bank if with_first else other
        bore = Fraction(bank_angle, 2) * (1 if side == "left" else -1)
        pin[side, throw] = bore - time[number]
    throws = range(count // 2)
    right = [(pin["right", k] - pin["right", 0]) % 360 for k in throws]
    split = [(pin["left", k] - pin["right", k]) % 360 for k in throws]
    return right, [each if each <= 180 else each - 360 for each in split]


# --- the IJESC paper's engine ---------------------------------------------------------------------


def ijesc_tdc(lags: Sequence[float], v_angle: int) -> list[Fraction]:
    """Top dead centres of cylinders 1 to 6: at phi - gamma right (odd), phi + gamma left."""
    gamma = Fraction(v_angle, 2)
    return [Fraction(lag) + (gamma if i % 2 else -gamma) for i, lag in enumerate(lags)]


# --- star diagrams ------------------------------------------------------------------------------


def phase_vectors(
    fire_deg: Sequence[Fraction | float], order: float, lengths: Sequence[float] | None = None
) -> list[complex]:
    """A vector for each cylinder: it lags by the order times the crank angle of its firing."""
    weights = [1.0] * len(fire_deg) if lengths is None else lengths
    return [
        weight * cmath.exp(-1j * math.radians(float(Fraction(order) * Fraction(fire) % 360)))
        for weight, fire in zip(weights, fire_deg, strict=True)
    ]


STAR_OF_BANKS = {
    (30, 2): (1.732051, 1.732),
    (30, 4.5): (1.847759, 1.77),
    (60, 2.5): (1.931852, 1.932),
    (60, 5.5): (0.517638, 0.517),
    (45, 3.5): (1.961571, 1.961),
}
"""Sum of the two banks of a V12 (Rolls-Royce, 1932): bank angle and order → true and printed.

The second bank fires a turn and the bank angle after the first. 1.77 is a slip: 2·cos 22.5° is
1.848; the others are cut off after three decimals or rounded.
"""
