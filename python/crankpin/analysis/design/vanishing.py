"""Masses, places and throws of unlike cylinders at which forces and moments vanish.

All cylinders have one crank radius and one rod, so that the force of order n vanishes with
Σ m·e^{inφ} and its moment with Σ m·z·e^{inφ}: radius, rod and speed drop out. These sums are solved
by damped least squares from many starts; where they are linear in the unknowns one start is enough.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support import inputs, optional
from crankpin._support import progress as progress_bar
from crankpin._support.messages import Hint, suppressed
from crankpin.analysis.arrangements.cranks import HALF, TURN, Crank, simple
from crankpin.analysis.design.families import engines_of
from crankpin.analysis.design.optima import FEWEST_STARTS, MOST_STARTS, STARTS_EACH
from crankpin.analysis.ranking.ranking import groups
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress
    from crankpin.analysis.design.question import Question
    from crankpin.analysis.design.unlike import Unlike
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Engine

    Real = NDArray[np.float64]

BALANCED = 1e-12
"""Largest sum of a balanced quantity, over that of the largest mass given at the length given."""
STEP = 1e-6
"""Step of central differences; sums are of order one, so that slopes are good to 1e-10."""
MOST_ROUNDS = 100
"""Rounds of the damped least squares from one start."""
SAME = 1e-6
"""Differences of masses and places, relative, and of angles, radians, that are none; the smallest
mass and distance of a cylinder that counts."""
ASIDE = 1e-3
"""Step by which an engine is moved to see whether others are as good."""
LATER = 1e-3
"""Weight of a quantity that cannot vanish beside those that do, while these guide the search."""
RANK = 1e-7
"""Singular value, relative, below which a direction does not change what is to vanish."""
NEAR = 1e-5
"""Degrees within which a throw is a round number, if that balances as well."""


class Cylinders(NamedTuple):
    """Cylinders that were chosen."""

    masses: tuple[float, ...]
    positions: tuple[float, ...]
    crank: Crank


class Problem:
    """Sums that are to vanish, as functions of the unknowns."""

    def __init__(self, unlike: Unlike, wanted: Sequence[tuple[str, int]]) -> None:
        self._unlike, self.wanted = unlike, wanted
        self.mass = max(each for each in unlike.masses if each is not None)
        known = [each for each in unlike.positions if each is not None]
        self.origin, self.length = known[0], known[-1] - known[0]
        free = {
            name: [k for k, each in enumerate(getattr(unlike, name)) if each is None]
            for name in ("masses", "positions", "throws")
        }
        self._vectors = [k for k in free["masses"] if k in free["throws"]]
        self._masses = [k for k in free["masses"] if k not in self._vectors]
        self._throws = [k for k in free["throws"] if k not in self._vectors]
        self._places = free["positions"]
        self._base = (
            np.array([np.nan if each is None else each / self.mass for each in unlike.masses]),
            np.array([np.nan if each is None else float(each) for each in unlike.throws]),
            np.array(
                [
                    np.nan if each is None else (each - self.origin) / self.length
                    for each in unlike.positions
                ]
            ),
        )

    @property
    def linear(self) -> bool:
        """True if all sums are linear in the unknowns: one solution at most, or a continuum."""
        turns = self._throws or (self._vectors and any(order != 1 for _, order in self.wanted))
        return not self._places and not turns

    def cylinders(self, x: Real) -> tuple[Real, Real, Real]:
        """Return masses and places, scaled, and throws, radians: each (…, n_cylinders)."""
        masses, throws, places = (
            np.broadcast_to(each, (*x.shape[:-1], each.size)).copy() for each in self._base
        )
        throws = np.radians(throws)
        parts = np.cumsum([2 * len(self._vectors), len(self._masses), len(self._throws)])
        pairs, alone, turned, along = np.split(x, parts, axis=-1)
        one, other = pairs[..., ::2], pairs[..., 1::2]
        masses[..., self._vectors] = np.hypot(one, other)
        throws[..., self._vectors] = np.arctan2(other, one)
        masses[..., self._masses] = alone
        throws[..., self._throws] = turned
        places[..., self._places] = along
        return masses, throws, places

    def sums(self, x: Real, wanted: Sequence[tuple[str, int]] | None = None) -> Real:
        """Return the sums, real and imaginary parts: (…, 2·n_wanted)."""
        return self._sums_of(*self.cylinders(x), self.wanted if wanted is None else wanted)

    @staticmethod
    def _sums_of(
        masses: Real, throws: Real, places: Real, wanted: Sequence[tuple[str, int]]
    ) -> Real:
        middle = 0.5 * (places.min(axis=-1, keepdims=True) + places.max(axis=-1, keepdims=True))
        lists = []
        for quantity, order in wanted:
            levers = places - middle if quantity == "moment" else 1.0
            lists.append((masses * levers * np.exp(1j * order * throws)).sum(axis=-1))
        whole = np.stack(lists, axis=-1)
        return np.concatenate([whole.real, whole.imag], axis=-1)

    def starts(self, seed: int) -> Iterator[Real]:
        """Yield values of the unknowns to begin with."""
        random = np.random.default_rng(seed)
        count = len(self._unlike.masses)
        while True:
            sizes, turns = (
                np.exp(random.uniform(-1.5, 1.5, count)),
                random.uniform(0, 2 * np.pi, count),
            )
            places = np.array(self._base[2])
            known = np.flatnonzero(~np.isnan(places))
            gaps = random.uniform(0.1, 1.0, count)
            for first, last in itertools.pairwise(known):
                inside = np.cumsum(gaps[first:last])
                places[first:last] = places[first] + np.append(0.0, inside[:-1]) / inside[-1] * (
                    places[last] - places[first]
                )
            places[known[-1] + 1 :] = places[known[-1]] + np.cumsum(gaps[known[-1] + 1 :])
            places[: known[0]] = places[known[0]] - np.cumsum(gaps[: known[0]])[::-1]
            pairs = sizes * np.exp(1j * turns)
            yield np.concatenate(
                [
                    np.stack([pairs.real, pairs.imag], axis=-1)[self._vectors].ravel(),
                    sizes[self._masses],
                    turns[self._throws],
                    places[self._places],
                ]
            )

    def slopes(self, x: Real, wanted: Sequence[tuple[str, int]] | None = None) -> Real:
        """Return the derivatives of the sums: (2·n_wanted, n_unknowns)."""
        steps = STEP * np.eye(x.size)
        return ((self.sums(x + steps, wanted) - self.sums(x - steps, wanted)) / (2 * STEP)).T

    def solved(self, x: Real, weights: Real) -> Real:
        """Return values at which the weighted sums are least, by damped least squares."""
        damping, now = 1e-2, weights * self.sums(x)
        for _ in range(MOST_ROUNDS):
            matrix = np.vstack([weights[:, np.newaxis] * self.slopes(x), damping * np.eye(x.size)])
            step = np.linalg.lstsq(matrix, np.append(-now, np.zeros(x.size)))[0]
            then = weights * self.sums(x + step)
            if np.linalg.norm(then) < np.linalg.norm(now):
                x, now, damping = x + step, then, damping / 10.0
            else:
                damping *= 10.0
            if np.abs(step).max(initial=0.0) < 1e-12 or damping > 1e6:
                break
        return x

    def least(self, x: Real, vanishing: Sequence[tuple[str, int]]) -> Real:
        """Return values nearby at which the last sum is least while the others vanish."""
        last = self.wanted[-1:]

        def square(x: Real) -> tuple[float, Real]:
            now = self.sums(x, last)
            return float(now @ now), 2.0 * now @ self.slopes(x, last)

        balanced = {
            "type": "eq",
            "fun": lambda x: self.sums(x, vanishing),
            "jac": lambda x: self.slopes(x, vanishing),
        }
        solved = optional.library("scipy.optimize").minimize(
            square,
            x,
            jac=True,
            method="SLSQP",
            constraints=[balanced] if vanishing else [],
            options={"ftol": 1e-16, "maxiter": 200},
        )
        return np.asarray(solved.x) if np.isfinite(solved.x).all() else x

    def polished(self, x: Real, wanted: Sequence[tuple[str, int]]) -> Real:
        """Return the nearest values at which these sums vanish to rounding."""
        for _ in range(4):
            step = np.linalg.lstsq(self.slopes(x, wanted), -self.sums(x, wanted), rcond=RANK)[0]
            nearer = np.linalg.norm(self.sums(x + step, wanted)) < np.linalg.norm(
                self.sums(x, wanted)
            )
            x = x + step if nearer else x
        return x

    def determined(self, x: Real, vanishing: Sequence[tuple[str, int]]) -> bool:
        """Return whether these sums, or those that are linear, determine the unknowns."""
        wanted = vanishing or self.wanted
        if not vanishing and not self.linear:
            return False
        return int(np.linalg.matrix_rank(self.slopes(x, wanted), rtol=RANK)) == x.size

    def isolated(self, x: Real, vanishing: Sequence[tuple[str, int]]) -> bool:
        """Return whether values nearby at which the others vanish leave more of the last sum."""
        if self.determined(x, vanishing):
            return True
        if len(vanishing) == len(self.wanted):
            return False
        slopes = self.slopes(x, vanishing or self.wanted)
        free = np.eye(x.size)
        if vanishing:
            _, sizes, free = np.linalg.svd(slopes)
            free = free[int((sizes > RANK * sizes[0]).sum()) :]
        last = self.wanted[-1:]
        level = np.linalg.norm(self.sums(x, last)) + BALANCED
        sides = (x + side * ASIDE * each for each in free for side in (-1.0, 1.0))
        beside = (self.polished(each, vanishing) if vanishing else each for each in sides)
        return all(np.linalg.norm(self.sums(each, last)) > level for each in beside)

    def chosen(self, x: Real) -> Cylinders | None:
        """Return the cylinders; None if a mass is not positive or places do not ascend."""
        masses, throws, places = self.cylinders(x)
        if masses.min() < SAME or np.diff(places).min() < SAME:
            return None
        unlike, level = self._unlike, np.abs(self.sums(x)).max()
        near: Real = np.round(np.degrees(throws), 3).astype(np.float64)
        near = np.where(np.abs(np.degrees(throws) - near) < NEAR, np.radians(near), throws)
        if np.abs(self._sums_of(masses, near, places, self.wanted)).max() <= level + BALANCED:
            throws = near
        degrees = [
            each if each is not None else simple(Fraction(repr(round(angle, 13))))
            for each, angle in zip(unlike.throws, np.degrees(throws).tolist(), strict=True)
        ]
        sizes = [
            each if each is not None else float(mass * self.mass)
            for each, mass in zip(unlike.masses, masses, strict=True)
        ]
        along = [
            each if each is not None else float(self.origin + place * self.length)
            for each, place in zip(unlike.positions, places, strict=True)
        ]
        return Cylinders(tuple(sizes), tuple(along), Crank.of(degrees))

    def same(self, one: Cylinders, other: Cylinders, *, mirrored: bool) -> bool:
        """Return whether two engines are one, or mirror images of each other."""
        sizes = [np.subtract(one.masses, other.masses) / self.mass]
        sizes += [np.subtract(one.positions, other.positions) / self.length]
        if max(np.abs(each).max() for each in sizes) > SAME:
            return False
        images = [other.crank, *([other.crank.mirrored()] if mirrored else [])]
        return any(
            all(
                abs((float(a - b) + HALF) % TURN - HALF) < np.degrees(SAME)
                for a, b in zip(one.crank.throws, image.throws, strict=True)
            )
            for image in images
        )


def solutions(
    question: Question,
    unlike: Unlike,
    wanted: Sequence[tuple[str, int]],
    seed: int,
    watched: Progress,
) -> list[tuple[Cylinders, bool]]:
    """Return cylinders at which as many as can of the first sums vanish, and the next is least.

    With each, whether no others nearby are as good.
    """
    with progress_bar.shown(watched, "designs") as bar:
        for vanishing in range(len(wanted), -1, -1):
            problem = Problem(unlike, wanted[: vanishing + 1])
            search = Search(problem, vanishing, mirrored=not question.cylinder.pin_offset)
            for k, start in enumerate(problem.starts(seed)):
                if k >= search.needed:
                    break
                search.follow(start)
                if bar is not None:
                    bar(min(k + 1, search.needed), search.needed)
            if search.engines:
                return search.engines
    fault = "cannot be reached with positive masses in this sequence of places"
    hint = Hint.of("leave more of `masses`, `positions` and `throws_deg` unknown")
    raise inputs.faulty("by", fault, hint)


class Search:
    """Different engines of which the first sums vanish and the next, if any, is least."""

    def __init__(self, problem: Problem, vanishing: int, *, mirrored: bool) -> None:
        self._problem, self._mirrored = problem, mirrored
        self._vanishing, count = problem.wanted[:vanishing], len(problem.wanted)
        first = np.arange(count) < vanishing
        weights = [np.where(first, 1.0, LATER), np.where(first, 1.0, 0.0)]
        # What cannot vanish may drive masses to zero: then those that do vanish alone guide.
        self._weights = weights[: 1 if vanishing in (0, count) else 2]
        if not vanishing:
            self._weights = [np.ones(count)]
        self.engines = list[tuple[Cylinders, bool]]()
        self._least: float | None = None
        """The later sums of the first engine, if it is the best of many."""

    @property
    def needed(self) -> int:
        """Number of starts, by the number of engines so far."""
        if self._problem.linear:
            return 1
        return min(max(FEWEST_STARTS, STARTS_EACH * len(self.engines)), MOST_STARTS)

    def follow(self, start: Real) -> None:
        """Add the engine to which a start leads, if it is another one."""
        problem, vanishing = self._problem, self._vanishing
        for weights in self._weights:
            x = problem.solved(start, np.tile(weights, 2))
            x = problem.polished(x, vanishing) if vanishing else x
            if len(vanishing) < len(problem.wanted) and not problem.determined(x, vanishing):
                x = problem.least(x, vanishing)
                x = problem.polished(x, vanishing) if vanishing else x
            if vanishing and np.abs(problem.sums(x, vanishing)).max() > BALANCED:
                continue
            engine = problem.chosen(x)
            if engine is not None:
                self._add(engine, x)
                return

    def _add(self, engine: Cylinders, x: Real) -> None:
        """Add an engine of which nothing nearby is as good; of others keep the best one."""
        problem, later = self._problem, float(np.abs(self._problem.sums(x)).max())
        isolated = problem.isolated(x, self._vanishing)
        alone = isolated and bool(self._vanishing)
        others = self.engines if self._least is None else self.engines[1:]
        if alone and not any(
            problem.same(engine, each, mirrored=self._mirrored) for each, _ in others
        ):
            self.engines.append((engine, isolated))
        elif not alone and (self._least is None or later < self._least * (1.0 - SAME)):
            self.engines, self._least = [(engine, isolated), *others], later


def wanted_of(objectives: Sequence[Objective], cylinder: Cylinder) -> list[tuple[str, int]]:
    """Return quantity and order of each objective, once, or raise an InputError.

    Orders that the cylinder does not have need nothing.
    """
    for each in objectives:
        if each.quantity not in ("force", "moment") or each.order is None or each.order % 1:
            hint = "unlike cylinders are designed by forces and moments of whole orders, such as "
            raise inputs.rejected("by", each.label, f"{hint}[1].force.peak,[1].moment.peak")
    pairs = dict.fromkeys((each.quantity, int(each.order or 0)) for each in objectives)
    wanted = [pair for pair in pairs if cylinder.harmonics([pair[1]])[0]]
    if not wanted:
        raise inputs.rejected("by", objectives[0].label, "this cylinder has no force of this order")
    return wanted


def engine_of(question: Question, cylinders: Cylinders) -> Engine:
    """Return the engine of the cylinders that were chosen."""
    (engine,) = engines_of(question, [cylinders.crank])
    with suppressed():
        parts = [question.cylinder.replace(reciprocating_mass=each) for each in cylinders.masses]
        return engine.replace(cylinder=parts, z=list(cylinders.positions))


def sorted_engines(
    question: Question,
    unlike: Unlike,
    objectives: Sequence[Objective],
    rpm: float,
    orders: Sequence[Order] | None,
    seed: int,
    rtol: float,
    watched: Progress,
) -> tuple[list[tuple[int, Engine, tuple[float, ...], bool, Crank]], Sweep]:
    """Return place, engine, objectives, whether isolated, and crank of each, the best first."""
    wanted = wanted_of(objectives, question.cylinder)
    engines = solutions(question, unlike, wanted, seed, watched)
    whole = [engine_of(question, cylinders) for cylinders, _ in engines]
    swept = sweep(whole, rpm=rpm, orders="auto" if orders is None else orders)
    rows = np.stack([objective.values(swept)[:, 0] for objective in objectives], axis=1)
    smooth = [(each.quantity, each.what, int(each.order or 0)) for each in objectives]
    merit = _core.Objectives(whole[0]._core, [], smooth, [1], ())
    tolerances = rtol * _core.angular_speed(rpm) ** 2 * np.array(merit.scales)
    ordered: list[tuple[int, Engine, tuple[float, ...], bool, Crank]] = []
    for group in groups(rows, np.arange(len(engines)), tolerances):
        place = len(ordered) + 1
        for k in group:
            cylinders, isolated = engines[k]
            values = tuple(rows[k].tolist())
            ordered.append((place, swept.engines[k], values, isolated, cylinders.crank))
    return ordered, swept
