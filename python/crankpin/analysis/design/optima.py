"""Best values of the angles that may vary, from many starts.

A single angle is narrowed down to every dip of a grid; several from random angles, until another
start can hardly find an optimum that has not been found yet.
"""

from __future__ import annotations

import dataclasses
import heapq
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import lazy, optional
from crankpin.analysis.arrangements.cranks import HALF, TURN, Crank, Exact, simple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from typing import TypeAlias

    from numpy.typing import NDArray

    from crankpin._core import Objectives
    from crankpin.analysis.arrangements.cranks import Symmetries
    from crankpin.analysis.design.families import Family

    Real: TypeAlias = NDArray[np.float64]
    Told: TypeAlias = Callable[[int, int], object]

GRID = 1.0
"""Step of the grid on which dips of a single angle are searched, degrees."""
SMOOTHING = (1e-4, 1e-6, 1e-9)
"""Successive values of μ, relative to the largest value that an objective could have."""
FEWEST_STARTS, STARTS_EACH, MOST_STARTS = 24, 8, 1000
"""Random starts: at least, for each optimum found, and at most.

With w optima found in n starts, the share of starting points that lead to optima not yet found is
about w(w + 1)/(n(n − 1)) (Boender and Rinnooy Kan): below 2 % at eight starts for each.
"""
SAME = 1e-3
"""Degrees within which two angles are one."""
LEVEL = 1e-9
"""Difference of objectives, relative to their largest possible value, below which optima tie."""
NEARLY_LEVEL = 1e-5
"""The same of an optimum that other angles nearby equal: its last objectives are less exact."""
POINTS = 9
"""Angles at which a dip is sampled in each round, which leaves a quarter of it."""
NARROW = 1e-9
"""Degrees to which a dip is narrowed."""
MOST_BETTER = 5
"""Better optima that are followed from one to the next."""
ASIDE = 1.0
"""Degrees by which an optimum is moved to see whether it comes back."""
NEAR = 0.01
"""Degrees within which a rounded angle may be better than the one it stands for."""
FLAT = 1e-12
"""Difference of objectives that rounding explains."""


@dataclasses.dataclass(frozen=True)
class Optimum:
    """A crank at which no small change of its angles helps."""

    crank: Crank
    isolated: bool
    """False if other angles nearby are as good."""
    values: tuple[float, ...]
    """Objectives over the largest that they could be, as the optimiser has them."""


def of_one_angle(
    families: Sequence[Family],
    merit_of: Callable[[Family], Objectives],
    symmetries: Symmetries,
    count: int,
    report: Told,
) -> list[Optimum]:
    """Return the best optima of families with a single angle that varies.

    Dips are refined from the lowest up. Between two values of the grid the merit is not lower than
    its steepest slope allows: dips that cannot be among the best ones are left out.
    """
    brackets: list[tuple[float, float, float, int]] = []
    for k, family in enumerate(families):
        brackets += [(*bracket, k) for bracket in _brackets(family, merit_of(family))]
        report(k + 1, len(families) + len(brackets))
    minima: list[Optimum] = []
    of_family: list[list[Optimum]] = [[] for _ in families]
    at_ends: set[tuple[float, ...]] = set()
    heights: list[float] = []
    for k, (bound, low, high, which) in enumerate(sorted(brackets), start=1):
        merit, of_one_family = merit_of(families[which]), of_family[which]
        # No objective is below zero.
        least = max(bound, FLAT * merit.weights[-1])
        if len(minima) >= count and least > heapq.nsmallest(count, heights)[-1]:
            break
        optimum = _between(families[which], merit, low, high)
        report(len(families) + k, len(families) + len(brackets))
        if not _new(of_one_family, optimum, symmetries) or _of_a_continuum(of_one_family, optimum):
            continue
        if optimum.crank.bank_angle in (0, HALF):
            # Where banks can be exchanged, the crank of another family may be equivalent.
            key = (float(optimum.crank.bank_angle), *symmetries.key(optimum.crank))
            if key in at_ends:
                continue
            at_ends.add(key)
        minima.append(optimum)
        of_one_family.append(optimum)
        heights.append(float(np.array(optimum.values) @ merit.weights))
    return minima


def _brackets(family: Family, merit: Objectives) -> Iterator[tuple[float, float, float]]:
    """Yield lower bounds on the merit in steps of a grid with a dip, and the ends of the steps.

    The merit falls into such a step from both of its ends, or out of the range at its end. Steps
    that are neighbours, where it is level or a dip is at an angle of the grid, count as one.
    """
    low, high = (float(each[0]) for each in _limits(family))
    grid = np.linspace(low, high, max(2, int(np.ceil((high - low) / GRID))) + 1)
    values, slopes = merit.evaluated(np.radians(grid)[:, np.newaxis])
    heights, slopes = values @ merit.weights, slopes[:, :, 0] @ merit.weights
    # It falls before the range and rises behind it: there is a step before the first angle, and one
    # behind the last.
    falls, rises = np.append(True, slopes <= FLAT), np.append(slopes >= -FLAT, True)
    steps = np.flatnonzero(falls & rises)
    for run in np.split(steps, np.flatnonzero(np.diff(steps) > 1) + 1):
        first, last = max(run[0] - 1, 0), min(run[-1], grid.size - 1)
        lowest = float(heights[first : last + 1].min())
        reach = merit.steepest * np.radians(grid[1] - grid[0])
        yield lowest - reach, float(grid[first]), float(grid[last])


def _between(family: Family, merit: Objectives, low: float, high: float) -> Optimum:
    """Return the optimum between two values of a single angle, degrees."""
    first, last = (float(each[0]) for each in _limits(family))
    weights = np.array(merit.weights)
    angle = _lowest(merit, weights, low, high)
    merits = _values(merit, np.radians([angle]))
    beside = np.clip([angle - ASIDE, angle + ASIDE], first, last)
    around = merit.evaluated(np.radians(beside[beside != angle])[:, np.newaxis])[0] - merits
    isolated = bool((np.abs(around).max(axis=1) > LEVEL).all())
    if len(weights) > 1 and merits[0] > LEVEL and (np.abs(around[:, 0]) > LEVEL).all():
        # The later objectives draw it aside a little, unless the first vanishes.
        angle, isolated = _lowest(merit, weights * (weights == 1.0), *beside), True
    return _optimum_at(family, merit, np.radians([angle]), isolated=isolated)


def _lowest(merit: Objectives, weights: Real, low: float, high: float) -> float:
    """Return the angle between two, degrees, with the lowest weighted sum of objectives."""
    while high - low > NARROW:
        angles = np.linspace(low, high, POINTS)
        heights = merit.evaluated(np.radians(angles)[:, np.newaxis])[0] @ weights
        level = np.flatnonzero(heights <= heights.min() + FLAT)
        if level.size > 2:
            # So close to a smooth dip, rounding decides.
            return float(0.5 * (angles[level[0]] + angles[level[-1]]))
        low = float(angles[max(level[0] - 1, 0)])
        high = float(angles[min(level[-1] + 1, POINTS - 1)])
    return 0.5 * (low + high)


def of_several_angles(
    families: Sequence[Family],
    merit_of: Callable[[Family], Objectives],
    symmetries: Symmetries,
    seed: int,
    report: Told,
) -> list[Optimum]:
    """Return the optima of families with several angles that vary."""
    everything: list[Optimum] = []
    steps = 0
    for k, family in enumerate(families):
        merit, (low, high) = merit_of(family), _limits(family)
        random = lazy.imported("numpy.random").default_rng([seed, k])
        minima: list[Optimum] = []
        starts, needed = 0, FEWEST_STARTS
        while starts < needed:
            optimum = _optimum(family, merit, random.uniform(low, high))
            if _new(minima, optimum, symmetries) and not _of_a_continuum(minima, optimum):
                minima.append(optimum)
            starts, steps = starts + 1, steps + 1
            needed = min(MOST_STARTS, max(FEWEST_STARTS, STARTS_EACH * len(minima)))
            rest = needed - starts + FEWEST_STARTS * (len(families) - k - 1)
            report(steps, steps + rest)
        everything += [each for each in minima if _new(everything, each, symmetries)]
    return everything


def _optimum(family: Family, merit: Objectives, start: Real) -> Optimum:
    """Return the optimum that a start, degrees, leads to."""
    number = len(merit.scales)
    values, isolated = _settled(family, merit, np.radians(start), number)
    if number > 1 and _values(merit, values)[0] > LEVEL:
        # The later objectives draw it aside a little, unless the first vanishes.
        alone, determined = _settled(family, merit, values, 1)
        if determined:
            values, isolated = alone, True
    return _optimum_at(family, merit, values, isolated=isolated)


def _optimum_at(family: Family, merit: Objectives, values: Real, *, isolated: bool) -> Optimum:
    rounded = _rounded(family, merit, values)
    merits = _values(merit, np.radians([float(each) for each in rounded]))
    return Optimum(family.crank(rounded), isolated, tuple(merits.tolist()))


def _values(merit: Objectives, values: Real) -> Real:
    """Return the objectives, over their scales, at some values of the variables, radians."""
    return np.asarray(merit.evaluated(values[np.newaxis])[0][0])


def _settled(family: Family, merit: Objectives, start: Real, objectives: int) -> tuple[Real, bool]:
    """Return a local optimum, radians, and whether nothing nearby is as good.

    From angles beside an optimum the way leads back to it, to a better one, or, if it is not the
    only one of its kind, to another that is as good.
    """
    values = _local(family, merit, start, objectives)
    low, high = (np.radians(each) for each in _limits(family))
    bounded = np.array([not each.periodic for each in family.variables])
    move = np.radians(ASIDE) * np.resize([1.0, -0.6, 0.3, -0.8], len(values))
    for _ in range(MOST_BETTER):
        outside = bounded & ((values + move < low) | (values + move > high))
        aside = values + np.where(outside, -move, move)
        aside = np.where(bounded, np.clip(aside, low, high), aside)
        again = _local(family, merit, aside, objectives)
        if np.degrees(np.abs(again - values)).max() < SAME:
            return values, True
        levels = (_values(merit, again) - _values(merit, values))[:objectives]
        if np.abs(levels).max() < NEARLY_LEVEL:
            return values, False
        if levels @ merit.weights[:objectives] > 0.0:
            return values, True
        values = again
    return values, True


def _local(family: Family, merit: Objectives, start: Real, objectives: int) -> Real:
    """Return the values of the variables, radians, at a local optimum of the first objectives."""
    optimize = optional.library("scipy.optimize")
    limits = zip(family.variables, *(np.radians(each) for each in _limits(family)), strict=True)
    bounds = [(None, None) if each.periodic else (low, high) for each, low, high in limits]

    def smoothed(values: Real, mu: float) -> tuple[float, Real]:
        value, slopes = merit.smoothed(values.tolist(), mu, objectives)
        return value, np.array(slopes)

    values = start
    for mu in SMOOTHING:
        solved = optimize.minimize(
            smoothed,
            values,
            args=(mu,),
            jac=True,
            method="SLSQP",
            bounds=bounds,
            options={"ftol": 1e-15, "maxiter": 200},
        )
        if solved.fun <= smoothed(values, mu)[0]:
            values = np.asarray(solved.x)
    return values


def _limits(family: Family) -> tuple[Real, Real]:
    """Return the lowest and the highest value of each variable, degrees."""
    low = np.array([float(each.low) for each in family.variables])
    return low, np.array([float(each.high) for each in family.variables])


def _rounded(family: Family, merit: Objectives, values: Real) -> list[Exact]:
    """Return the degrees with the fewest digits that are as good: 90 for 90.00000000001."""
    degrees = np.degrees(values)
    level = _values(merit, values) @ merit.weights
    for parts in (*range(8), None):
        angles = [_near(each, family, parts) for each in degrees.tolist()]
        if parts is None:
            break
        limits = zip(angles, family.variables, strict=True)
        if not all(each.periodic or each.low <= value <= each.high for value, each in limits):
            continue
        rounded = np.array([float(each) for each in angles])
        change = float(_values(merit, np.radians(rounded)) @ merit.weights - level)
        # What is lower further away is another dip.
        if change <= FLAT and (change >= -FLAT or np.abs(rounded - degrees).max() <= NEAR):
            break
    return angles


def _near(degrees: float, family: Family, digits: int | None) -> Exact:
    if digits is None:
        return simple(Fraction(repr(degrees)))
    if digits == 0:
        # Fractions of a turn by the number of throws: those of seven have no decimals.
        steps = 4 * len(family.base.throws)
        return simple(Fraction(round(degrees * steps / TURN) * TURN, steps))
    return simple(Fraction(repr(round(degrees, digits - 1))))


def _new(known: Sequence[Optimum], optimum: Optimum, symmetries: Symmetries) -> bool:
    """Return whether none of those found is equivalent at the same angles."""
    images = [optimum.crank, *(image for _, image in symmetries.images(optimum.crank))]
    return not any(_alike(image, each.crank) for each in known for image in images)


def _of_a_continuum(known: Sequence[Optimum], optimum: Optimum) -> bool:
    """Return whether one of a family's optima stands for this one, which others nearby equal."""
    if optimum.isolated:
        return False
    levels = (np.subtract(each.values, optimum.values) for each in known if not each.isolated)
    return any(np.abs(each).max() < NEARLY_LEVEL for each in levels)


def _alike(one: Crank, other: Crank) -> bool:
    pins = zip((*one.throws, *one.splits), (*other.throws, *other.splits), strict=True)
    if any(abs((float(a - b) + HALF) % TURN - HALF) > SAME for a, b in pins):
        return False
    if one.bank_angle is None or other.bank_angle is None:
        return True
    return abs(float(one.bank_angle - other.bank_angle)) < SAME
