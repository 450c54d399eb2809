"""Measured pistons and rods matched to the cylinders of an engine, or of several."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, lazy, units
from crankpin._support import progress as progress_bar
from crankpin._support.frames import Tabled
from crankpin._support.messages import Hint
from crankpin._support.record import Record
from crankpin._support.tables import Column, Table
from crankpin.analysis.request import engine_core
from crankpin.analysis.tolerances.spreads import deviating
from crankpin.model import checks

if TYPE_CHECKING:
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
UNIT_BY_OBJECTIVE = {"balance": "kg·m", "spread": "kg"}
"""Objective → unit."""
MOST_PARTS = 1000
STARTS = 24
"""Random starts of the search by exchanges."""
SPREAD_STARTS = 4000
"""Starts of the search for the least spread, over the number of pistons."""


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
    def balance(self) -> _core.MeasuredParts:
        """The parts as they leave a residual of force and moment."""
        return self._matched_by("balance")

    @cached_property
    def spread(self) -> _core.MeasuredParts:
        """The parts as they differ in reciprocating mass."""
        return self._matched_by("spread")

    def _matched_by(self, objective: Objective) -> _core.MeasuredParts:
        core, ends = engine_core(self.engine), None if self.rods is None else [*self.rods.T]
        return _core.MeasuredParts(core, objective, self.orders, self.pistons, ends)

    def chosen(self, assignment: Assignment) -> tuple[NDArray[np.intp], ...]:
        """Return the places of the parts in the lists of this bin."""
        lists = [numbers for numbers in assignment if numbers is not None]
        return tuple(np.array(numbers, dtype=np.intp) - 1 for numbers in lists)

    def value(self, objective: Objective, assignment: Assignment) -> float:
        """Return the objective of one engine."""
        chosen = [places.tolist() for places in self.chosen(assignment)]
        parts = self.balance if objective == "balance" else self.spread
        return parts.value(chosen)

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
    numbers = [tuple((places + 1).tolist()) for places in chosen]
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
    several = min(len(parts) for parts in (masses, ends) if parts is not None) // count
    wanted = several if sets is None else inputs.whole("sets", sets)
    if not 1 <= wanted <= several:
        parts_text = f"{len(masses)} pistons" + ("" if ends is None else f" and {len(ends)} rods")
        raise inputs.rejected(
            "sets",
            wanted,
            f"{parts_text} suffice for {several} of {count} cylinders; give 1 to {several}",
        )
    if by == "spread" and orders is not None:
        raise inputs.rejected("orders", orders, Hint.of('needs `by="balance"`; leave it out'))
    chosen_orders = inputs.explicit_orders((1, 2) if orders is None else orders)
    start = inputs.whole("seed", seed, 0)
    bar = progress_bar.checked(progress)
    checks.masses(core, pistons=masses.max(), rods=0.0 if ends is None else ends.max())
    measured = MeasuredParts(engine, masses[:, 0], ends, tuple(chosen_orders))
    chosen, bound, exact = _matched(measured, by, wanted, start, bar)
    return Match(measured, by, chosen, bound, exact)


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


def _matched(
    measured: MeasuredParts, by: Objective, sets: int, seed: int, progress: Progress
) -> tuple[tuple[Assignment, ...], float, bool]:
    """Return the best assignments, a bound of their objective, and whether none is better."""
    lists = [measured.pistons] if measured.rods is None else [measured.pistons, measured.rods]
    if by == "balance":
        parts, count = measured.balance, STARTS
    else:
        # Of pistons alone the best are known.
        parts = measured.spread
        count = max(STARTS, SPREAD_STARTS // len(lists[0])) if len(lists) > 1 else 0
    random = lazy.imported("numpy.random").default_rng(seed)
    starts = [[random.permutation(len(of)).tolist() for of in lists] for _ in range(count)]
    with progress_bar.shown(progress, "assignments") as report:
        chosen, bound, exact = parts.matched(sets, starts, report)
    by_set = np.array(chosen).reshape(len(lists), sets, -1)
    return tuple(assignment_of(*by_set[:, k]) for k in range(sets)), bound, exact


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
        return UNIT_BY_OBJECTIVE[self.by]

    @cached_property
    def values(self) -> tuple[float, ...]:
        """Objective of each engine."""
        return tuple(self.parts.value(self.by, engine_parts) for engine_parts in self.assignment)

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
                self.by, assignment_of(*([engine] * (1 if self.parts.rods is None else 2)))
            )
            for engine in engines
        )

    @cached_property
    def engines(self) -> tuple[Engine, ...]:
        """The engines with their parts: masses are the engine's own and the parts' deviations."""
        pistons = self.parts.pistons
        below = float(pistons.mean() - pistons.min())  # at least 0
        lightest = min(cylinder.reciprocating_mass for cylinder in self.engine.cylinders)
        if below > lightest:
            hint = (
                f"the lightest is {below:.4g} kg below their mean, which stands for the engine's "
                f"own reciprocating mass, {lightest:.4g} kg: give masses in kg, such as 0.48"
            )
            raise inputs.rejected("pistons", float(pistons.min()), hint)
        several = len(self.assignment) > 1
        return tuple(
            self.parts.engine_of(
                engine_parts, f"{self.engine.name}, set {k}" if several else self.engine.name
            )
            for k, engine_parts in enumerate(self.assignment, start=1)
        )

    @property
    def unused(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Numbers of the pistons and of the rods that are left."""
        rods = () if self.parts.rods is None else self.parts.rods
        pistons_used = {k for engine_parts in self.assignment for k in engine_parts.pistons}
        rods_used = {k for engine_parts in self.assignment for k in engine_parts.rods or ()}
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
        proof = "no assignment is better" if self.exact else none
        before, after = (
            units.figure(value, self.unit, 4) for value in (self.initial_value, self.value)
        )
        title = units.Text(f"{WORDS[self.by]}: ", after, f", {proof}; as given ", before)
        return Table(title, tuple(columns))
