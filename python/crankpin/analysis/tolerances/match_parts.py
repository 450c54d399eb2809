"""Measured pistons and rods matched to the cylinders of an engine, or of several."""

from __future__ import annotations

import math
from functools import cached_property, reduce
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, lazy
from crankpin._support import progress as progress_bar
from crankpin._support.frames import Tabled
from crankpin._support.quantities import PLANE_VECTORS
from crankpin._support.record import Record
from crankpin._support.tables import Column, Table
from crankpin._support.warnings import suppressed
from crankpin.analysis.balance import over_square
from crankpin.analysis.contributions import contributions, phasors
from crankpin.analysis.request import engine_core
from crankpin.analysis.tolerances.spreads import deviating
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders
    from crankpin._support.progress import Progress
    from crankpin.model.engine import Engine

Objective: TypeAlias = Literal["balance", "spread"]
WORDS = {
    "balance": "force, and moment over half the engine's length, over ω², root of sum of squares",
    "spread": "largest less smallest sum of piston and small end",
}
"""Objective → its description."""
UNITS = {"balance": "kg·m", "spread": "kg"}
"""Objective → unit."""
MOST_PARTS = 1000
STARTS = 24
"""Random starts of the search by exchanges."""
SPREAD_STARTS = 4000
"""Starts of the search for the least spread, over the number of pistons."""
MOST_EXCHANGED = 64
"""Cylinders of an engine up to which parts are exchanged for the least spread."""


class Kind(NamedTuple):
    """Parts of one kind, such as pistons or rods."""

    parts: NDArray[np.float64]
    """Deviations of each part: (n_parts, n_figures)."""
    influences: NDArray[np.float64]
    """Effect of a unit of each figure in each place: (n_places, n_figures, n_dimensions)."""


class Assignment(NamedTuple):
    """Parts of one engine."""

    pistons: tuple[int, ...]
    """Number, from 1, of the piston in each cylinder."""
    rods: tuple[int, ...] | None
    """Number, from 1, of the rod in each cylinder; None where no rods were given."""


class MeasuredParts(Record):
    """Measured pistons and rods, and the engine that they are for."""

    engine: Engine
    """The engine with its own masses."""
    pistons: NDArray[np.float64]
    """Masses of the pistons, kg: (n_pistons,)."""
    rods: NDArray[np.float64] | None
    """Masses of the rods' small and big ends, kg: (n_rods, 2)."""
    orders: tuple[int, ...]
    """Orders of what remains."""

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """Residual of the engine with its own masses, over ω², as real numbers."""
        balance = over_square(self.engine, self.orders)
        return self._vector(*(phasors(balance, name) for name in PLANE_VECTORS))

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """Deviations of the parts from their means, and what a unit of each does."""
        reciprocating = self._influences(rotating=False)
        kinds = [Kind((self.pistons - self.pistons.mean())[:, None], reciprocating[:, None])]
        if self.rods is not None:
            both = np.stack([reciprocating, self._influences(rotating=True)], axis=1)
            kinds.append(Kind(self.rods - self.rods.mean(axis=0), both))
        return tuple(kinds)

    def _influences(self, *, rotating: bool) -> NDArray[np.float64]:
        """Return what a kilogram in each cylinder adds: (n_cylinders, n_dimensions)."""
        mass = float(not rotating)
        cylinders = [each.replace(reciprocating_mass=mass) for each in self.engine.cylinders]
        with suppressed():  # of a kilogram
            laden = self.engine.replace(
                cylinder=cylinders,
                rotating_mass=float(rotating),
                counterweights=(),
                shafts=(),
                loads=(),
            )
        balance = over_square(laden, self.orders)
        pairs = zip(*(contributions(balance, name) for name in PLANE_VECTORS), strict=True)
        return np.stack([self._vector(force.phasors, moment.phasors) for force, moment in pairs])

    def _vector(
        self, force: NDArray[np.complex128], moment: NDArray[np.complex128]
    ) -> NDArray[np.float64]:
        """Return forward and backward parts as real numbers, moments over half the length."""
        half = 0.5 * (self.engine.z.max() - self.engine.z.min())
        has_length = half > np.finfo(float).tiny  # by less no complex number can be divided
        together = np.concatenate([*force, *(moment / half if has_length else ())])
        return np.concatenate([together.real, together.imag])

    def chosen(self, assignment: Assignment) -> tuple[NDArray[np.intp], ...]:
        """Return the places of the parts in the lists of this bin."""
        lists = [each for each in assignment if each is not None]
        return tuple(np.array(each, dtype=np.intp) - 1 for each in lists)

    def value(self, objective: str, assignment: Assignment) -> float:
        """Return the objective of one engine."""
        chosen = self.chosen(assignment)
        if objective == "balance":
            added = [
                np.einsum("jf,jfd->d", kind.parts[each], kind.influences)
                for kind, each in zip(self.kinds, chosen, strict=True)
            ]
            return float(np.linalg.norm(self.start + sum(added)))
        sums = self.pistons[chosen[0]]
        if self.rods is not None:
            sums = sums + self.rods[chosen[1], 0]
        return float(np.ptp(sums))

    def engine_of(self, assignment: Assignment, name: str) -> Engine:
        """Return the engine with these parts."""
        chosen, engine = self.chosen(assignment), self.engine
        more = (self.pistons - self.pistons.mean())[chosen[0]]
        rotating = engine.rotating_mass
        if self.rods is not None:
            ends = (self.rods - self.rods.mean(axis=0))[chosen[1]]
            more, rotating = more + ends[:, 0], rotating + ends[:, 1]
        cylinders = [
            cylinder.replace(reciprocating_mass=cylinder.reciprocating_mass + float(mass))
            for cylinder, mass in zip(engine.cylinders, more, strict=True)
        ]
        return deviating(engine, cylinders, rotating, name=name)


def assignment_of(*chosen: NDArray[np.intp]) -> Assignment:
    """Return the numbers of parts whose places in their lists are given."""
    numbers = [tuple((each + 1).tolist()) for each in chosen]
    return Assignment(numbers[0], numbers[1] if len(numbers) > 1 else None)


def match_parts(
    engine: Engine,
    pistons: ArrayLike,
    rods: ArrayLike | None = None,
    *,
    by: Objective = "balance",
    sets: int | None = None,
    orders: Orders | None = None,
    seed: int = 0,
    progress: Progress = False,
) -> Match:
    """Return the best assignment of measured pistons and rods to cylinders.

    The engine's own masses stand for the mean of the measured ones: a piston of mass p adds
    p − mean(pistons) to the reciprocating mass of its cylinder, a rod adds what its small end has
    beyond the mean to that, and what its big end has to the rotating mass.

    Parameters
    ----------
    engine : Engine
        The engine, with its counterweights, balance shafts and the loads that scale with the square
        of the speed: without hardware the parts that it removes dominate (see
        :func:`crankpin.counterweights`). Gas pressure makes no force; other loads are not counted.
    pistons : array_like, shape (n_pistons,)
        Measured masses of pistons with pins and rings, kg, at least one for each cylinder of
        each engine.
    rods : array_like, shape (n_rods, 2), optional
        Measured masses of the rods' small and big ends, kg.
    by : {"balance", "spread"}, default "balance"
        ``"balance"`` minimises the residual of the engine, ``"spread"`` the difference between the
        heaviest and the lightest piston with small end. The residual is the root of the sum of
        squares of forward and backward parts of force and moment of ``orders``, in kg·m (over ω²),
        moments over half the distance from the first to the last cylinder (none where that is
        zero).
    sets : int, optional
        Number of engines to be filled; by default as many as the parts suffice for. Of several
        engines the sum of the objective is minimised.
    orders : int or sequence of int, optional
        With ``by="balance"``: whole multiples of crank speed; by default 1 and 2.
    seed : int, default 0
        Seed of the random starts of the search where there are too many arrangements for all.
    progress : bool or callable, default False
        True for a tqdm bar, or a function that is called with the steps done and the steps in all.

    Returns
    -------
    Match
        The assignment, its objective, and the engines with their parts.

    Raises
    ------
    InputError
        If there are too few parts, a mass is not above zero, or an argument is out of range.

    Notes
    -----
    ``"balance"``: all arrangements are compared where there are few enough, as of 12 pistons, or 8
    pistons and rods, of one engine, or of 20 pistons for five engines with 4 cylinders. Of more,
    two parts are exchanged, within an engine, between engines or with a spare one, as long as that
    helps, from many starts; ``bound`` is a value below which no assignment comes then, 0 where the
    parts might make up for everything. ``"spread"`` is exact for pistons alone, and for pistons and
    rods of one engine without spare ones; other pistons and rods are exchanged in the same way.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4 = cp.Engine.preset("i4")
    >>> match = cp.match_parts(i4, [0.402, 0.398, 0.405, 0.401], orders=[1])
    >>> match.exact, match.assignment[0].pistons
    (True, (1, 3, 2, 4))
    >>> bool(match.value <= match.initial_value)
    True
    >>> float(match.engines[0].balance(rpm=6000)[1].force.peak)  # 402 + 401 - 405 - 398 g
    0.0
    """
    core = engine_core(engine)
    count = len(engine)
    inputs.one_of("by", by, WORDS)
    masses = _masses("pistons", pistons, 1)
    ends = None if rods is None else _masses("rods", rods, 2)
    for name, parts in (("pistons", masses), ("rods", ends)):
        if parts is not None and len(parts) < count:
            raise inputs.faulty(
                name,
                f"has {len(parts)} entries",
                f"the engine has {count} cylinders; give one for each, or more",
            )
    several = min(len(each) for each in (masses, ends) if each is not None) // count
    wanted = several if sets is None else inputs.whole("sets", sets)
    if not 1 <= wanted <= several:
        parts_text = f"{len(masses)} pistons" + ("" if ends is None else f" and {len(ends)} rods")
        raise inputs.rejected(
            "sets",
            wanted,
            f"{parts_text} suffice for {several} of {count} cylinders; give 1 to {several}",
        )
    if by == "spread" and orders is not None:
        raise inputs.rejected("orders", orders, 'needs by="balance"; leave it out')
    listed = inputs.explicit_orders((1, 2) if orders is None else orders)
    start = inputs.whole("seed", seed, 0)
    shown = progress_bar.checked(progress)
    checks.masses(core, pistons=masses.max(), rods=0.0 if ends is None else ends.max())
    measured = MeasuredParts(engine, masses[:, 0], ends, tuple(listed))
    if by == "spread":
        chosen, exact = _by_spread(measured, wanted, start, shown)
        # Rods might make up for any difference of pistons.
        bound = sum(measured.value(by, each) for each in chosen) if exact else 0.0
    else:
        chosen, exact, bound = _by_balance(measured, wanted, start, shown)
    return Match(measured, by, tuple(chosen), bound, exact)


def _masses(name: str, values: ArrayLike, columns: int) -> NDArray[np.float64]:
    """Return masses, a row for each part."""
    numbers = inputs.array(name, values)
    shape = "(n,)" if columns == 1 else "(n, 2): small end and big end of each rod"
    if numbers.ndim != (1 if columns == 1 else 2) or (columns == 2 and numbers.shape[1] != 2):
        raise inputs.faulty(
            name, f"has shape {numbers.shape}", f"give masses in kg of shape {shape}"
        )
    if len(numbers) > MOST_PARTS:
        raise inputs.faulty(name, f"has {len(numbers)} entries", f"give {MOST_PARTS} at most")
    if not (np.isfinite(numbers).all() and (numbers > 0.0).all()):
        raise inputs.rejected(name, values, "give masses above zero, kg")
    # Records make their arrays read-only: the caller's stay as they are.
    return numbers.reshape(-1, columns).copy()


# --- the search -----------------------------------------------------------------------------------


def _by_spread(
    parts: MeasuredParts, sets: int, seed: int, progress: Progress
) -> tuple[list[Assignment], bool]:
    """Return sets of pistons, and of rods, whose sums are most alike, and whether that is proved.

    Sorted against each other, pistons and rods of one engine have the least largest and the largest
    least sum: exchanging any two rods of another order makes the larger sum larger or none smaller.
    """
    count, masses = len(parts.engine), parts.pistons
    pistons = windows(masses, count, sets)
    if parts.rods is None:
        return [assignment_of(each) for each in pistons], True
    small = parts.rods[:, 0]
    rising, falling = np.argsort(masses, kind="stable"), np.argsort(-small, kind="stable")
    if len(masses) == len(small) == count:
        return [assignment_of(rising, falling)], True
    # The lightest pistons with the heaviest rods.
    rods = [each[::-1] for each in windows(small, count, sets)[::-1]]
    if count > MOST_EXCHANGED:
        return [assignment_of(*both) for both in zip(pistons, rods, strict=True)], False
    starts = [[_sequence(pistons, len(masses)), _sequence(rods, len(small))]]
    if len(masses) == len(small):
        # Or pairs of these that are alike.
        pairs = windows(masses[rising] + small[falling], count, sets)
        starts.append([_sequence([of[k] for k in pairs], len(of)) for of in (rising, falling)])
    starts += _random_starts(parts.kinds, seed, max(STARTS, SPREAD_STARTS // len(masses)))
    places = [np.eye(count).tolist()]
    listed = [([each.tolist()], places) for each in (masses, small)]
    matched, _, _ = _matched("spread", [0.0] * count, listed, sets, starts, progress)
    return matched, False


def _by_balance(
    parts: MeasuredParts, sets: int, seed: int, progress: Progress
) -> tuple[list[Assignment], bool, float]:
    """Return assignments that leave little, whether that is proved the least, and a lower bound."""
    start, kinds = _reduced(parts.start, parts.kinds)
    # Parts of similar mass in one engine, then any.
    starts = [[np.argsort(kind.parts.sum(axis=1)).tolist() for kind in kinds]]
    starts += _random_starts(kinds, seed, STARTS)
    listed = [
        (kind.parts.T.tolist(), np.swapaxes(kind.influences, 0, 1).tolist()) for kind in kinds
    ]
    assignments, exact, bound = _matched("balance", start.tolist(), listed, sets, starts, progress)
    value = sum(parts.value("balance", each) for each in assignments)
    return assignments, exact, value if exact else min(bound, value)


def _sequence(sets: Sequence[NDArray[np.intp]], parts: int) -> list[int]:
    """Return the parts of all sets, then those that are left."""
    used = np.concatenate(sets)
    return [*used.tolist(), *np.setdiff1d(np.arange(parts), used).tolist()]


def _random_starts(kinds: Sequence[Kind], seed: int, number: int) -> list[list[list[int]]]:
    random = lazy.imported("numpy.random").default_rng(seed)
    sizes = [len(kind.parts) for kind in kinds]
    return [[random.permutation(size).tolist() for size in sizes] for _ in range(number)]


def _matched(
    objective: Objective,
    start: list[float],
    listed: list[tuple[list[list[float]], list[list[list[float]]]]],
    sets: int,
    starts: list[list[list[int]]],
    progress: Progress,
) -> tuple[list[Assignment], bool, float]:
    """Return the assignments that are found, whether they are proved the best, and a bound."""
    spread = objective == "spread"
    with progress_bar.shown(progress, "assignments") as report:
        chosen, _, bound, exact = _core.matched(spread, start, listed, sets, starts, report)
    of_sets = np.array(chosen).reshape(len(listed), sets, -1)
    return [assignment_of(*of_sets[:, k]) for k in range(sets)], exact, bound


def _reduced(
    start: NDArray[np.float64], kinds: tuple[Kind, ...]
) -> tuple[NDArray[np.float64], tuple[Kind, ...]]:
    """Return the same lengths in as few dimensions as the influences span, and one for the rest.

    The first dimension is that of the start where this is longer than what parts add: it sorts the
    sums best.
    """
    stacked = np.concatenate([kind.influences.reshape(-1, len(start)) for kind in kinds])
    axes = _axes(stacked)
    along = _along(start[np.newaxis], axes)
    largest = max(float(np.abs(kind.parts).max()) for kind in kinds)
    if math.hypot(*along[0]) > largest * math.sqrt(float((stacked * stacked).sum())):
        axes = _axes(axes, _axes(_combined(along, axes)))
    axes = _axes(start[np.newaxis], axes)
    if not len(axes):
        axes = np.eye(1, len(start))
    turned = [
        kind._replace(influences=np.stack([_along(each, axes) for each in kind.influences]))
        for kind in kinds
    ]
    return _along(start[np.newaxis], axes)[0], tuple(turned)


# Sums are taken term by term: a library of linear algebra rounds otherwise on another processor,
# and another of several equally good assignments would come first.


def _along(vectors: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return components of row vectors along orthonormal rows: (n_vectors, n_axes)."""
    products = vectors[:, np.newaxis] * axes
    return reduce(np.add, products.transpose(2, 0, 1))


def _combined(parts: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the row vectors of components: (n_vectors, n_dimensions)."""
    nothing = np.zeros((len(parts), axes.shape[1]))
    return reduce(np.add, parts.T[:, :, np.newaxis] * axes[:, np.newaxis], nothing)


def _axes(
    vectors: NDArray[np.float64], before: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Return orthonormal rows, and more until they span some vectors: the longest rest next.

    By Gram and Schmidt; twice, since what rounding leaves of one projection is not orthogonal.
    """
    axes = np.empty((0, vectors.shape[1])) if before is None else before
    longest = 0.0
    while len(axes) < vectors.shape[1]:
        rest = vectors
        for _ in range(2):
            rest = rest - _combined(_along(rest, axes), axes)
        squares = reduce(np.add, (rest * rest).T)
        k = int(squares.argmax())
        longest = longest or max(math.hypot(*each) for each in vectors)
        if math.sqrt(squares[k]) <= 1e-13 * longest:
            break
        axes = np.vstack([axes, rest[k] / math.sqrt(squares[k])])
    return axes


def windows(masses: NDArray[np.float64], size: int, sets: int) -> list[NDArray[np.intp]]:
    """Return sets of equally many parts whose ranges have the least sum; the rest stays unused.

    Exact. Of sorted parts that are all used, a gap between neighbours with m parts below it, m no
    multiple of ``size``, is straddled by at least one set, because no sets consist of m parts;
    sorted sets straddle each of these gaps once and no other. The sum of ranges is the sum of the
    gaps straddled. An unused part within the range of a set may replace one of its ends without
    widening it. So the sets are windows of neighbours, and dynamic programming finds the best.

    Where all parts are used, sorted sets have the least largest range too: the first
    (t − 1)·size + 1 parts lie in at least t sets, which reach the (t·size)-th part; so that one of
    them has at least the range of the t-th sorted set.
    """
    order = np.argsort(masses, kind="stable")
    ranges = masses[order][size - 1 :] - masses[order][: len(masses) - size + 1]
    # least[t][m]: least sum of t sets of the first m parts.
    least = np.full((sets + 1, len(masses) + 1), np.inf)
    least[0] = 0.0
    taken = np.zeros(least.shape, dtype=bool)
    for t in range(1, sets + 1):
        for m in range(t * size, len(masses) + 1):
            with_last = least[t - 1, m - size] + ranges[m - size]
            taken[t, m] = with_last < least[t, m - 1]
            least[t, m] = min(with_last, least[t, m - 1])
    windows, m = [], len(masses)
    for t in range(sets, 0, -1):
        while not taken[t, m]:
            m -= 1
        windows.append(order[m - size : m])
        m -= size
    return windows[::-1]


class Match(Tabled):
    """Assignment of pistons and rods to cylinders.

    Made by :func:`crankpin.match_parts`.
    """

    parts: MeasuredParts
    """The measured parts and the engine."""
    by: Objective
    """``"balance"`` or ``"spread"``."""
    assignment: tuple[Assignment, ...]
    """For each engine the numbers of its pistons and rods, cylinder by cylinder."""
    bound: float
    """Lower bound of all assignments, in the unit of ``value``; equal to it if exact."""
    exact: bool
    """True if no assignment is better: all were compared, or it is proved."""

    @property
    def engine(self) -> Engine:
        """The engine with its own masses."""
        return self.parts.engine

    @property
    def unit(self) -> str:
        """Unit of the objective: kg·m (over ω²) or kg."""
        return UNITS[self.by]

    @cached_property
    def values(self) -> tuple[float, ...]:
        """Objective of each engine."""
        return tuple(self.parts.value(self.by, each) for each in self.assignment)

    @property
    def value(self) -> float:
        """Sum of the objective over the engines."""
        return sum(self.values)

    @property
    def initial_value(self) -> float:
        """The same of the parts in the order in which they were given."""
        count = len(self.engine)
        engines = (np.arange(k * count, (k + 1) * count) for k in range(len(self.assignment)))
        return sum(
            self.parts.value(
                self.by, assignment_of(*([each] * (1 if self.parts.rods is None else 2)))
            )
            for each in engines
        )

    @cached_property
    def engines(self) -> tuple[Engine, ...]:
        """The engines with their parts: masses are the engine's own and the parts' deviations."""
        pistons = self.parts.pistons
        below = float(pistons.mean() - pistons.min())  # at least 0
        lightest = min(each.reciprocating_mass for each in self.engine.cylinders)
        if below > lightest:
            hint = (
                f"the lightest is {below:.4g} kg below their mean, which stands for the engine's "
                f"own reciprocating mass, {lightest:.4g} kg: give masses in kg, such as 0.48"
            )
            raise inputs.rejected("pistons", float(pistons.min()), hint)
        several = len(self.assignment) > 1
        return tuple(
            self.parts.engine_of(
                each, f"{self.engine.name}, set {k}" if several else self.engine.name
            )
            for k, each in enumerate(self.assignment, start=1)
        )

    @property
    def unused(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Numbers of the pistons and of the rods that are left."""
        rods = () if self.parts.rods is None else self.parts.rods
        pistons_used = {k for each in self.assignment for k in each.pistons}
        rods_used = {k for each in self.assignment for k in each.rods or ()}
        return (
            tuple(k for k in range(1, len(self.parts.pistons) + 1) if k not in pistons_used),
            tuple(k for k in range(1, len(rods) + 1) if k not in rods_used),
        )

    @property
    def table(self) -> Table:
        """Table that is shown: the parts of each cylinder."""
        places = [
            (k, cylinder)
            for k in range(len(self.assignment))
            for cylinder in range(len(self.engine))
        ]
        pistons = [self.assignment[k].pistons[cylinder] for k, cylinder in places]
        columns = [
            Column("set", tuple(k + 1 for k, _ in places)),
            Column("cylinder", tuple(cylinder + 1 for _, cylinder in places)),
            Column("piston", tuple(pistons)),
            Column("piston mass", self.parts.pistons[np.array(pistons) - 1], "kg"),
        ]
        if self.parts.rods is not None:
            rods = [(self.assignment[k].rods or ())[cylinder] for k, cylinder in places]
            small, big = self.parts.rods[np.array(rods) - 1].T.tolist()
            columns.append(Column("rod", tuple(rods)))
            columns.append(Column("small end", tuple(small), "kg"))
            columns.append(Column("big end", tuple(big), "kg"))
        none = f"none is below {self.bound:.4g} {self.unit}"
        known = "no assignment is better" if self.exact else none
        title = f"{WORDS[self.by]}: {self.value:.4g} {self.unit}, {known}"
        return Table(f"{title}; as given {self.initial_value:.4g} {self.unit}", tuple(columns))
