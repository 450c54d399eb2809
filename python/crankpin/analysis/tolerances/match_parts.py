"""Measured pistons and rods matched to the cylinders of an engine, or of several."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, TypeAlias

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, optional
from crankpin._support import progress as progress_bar
from crankpin._support.frozen import Frozen
from crankpin._support.tables import Shown, Table
from crankpin.analysis.request import engine_core
from crankpin.analysis.tolerances import matching
from crankpin.analysis.tolerances.measured_parts import Assignment, MeasuredParts, assignment_of
from crankpin.model import checks

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders
    from crankpin._support.progress import Progress
    from crankpin.analysis.tolerances.matching import Report
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


def match_parts(
    engine: Engine,
    pistons: ArrayLike,
    rods: ArrayLike | None = None,
    *,
    objective: Objective = "balance",
    sets: int | None = None,
    orders: Orders = (1, 2),
    reference_z: float | None = None,
    seed: int = 0,
    progress: Progress = False,
) -> Match:
    """Return which measured piston and rod goes into which cylinder.

    The engine's own masses stand for the mean of the measured ones: a piston of mass p adds
    p − mean(pistons) to the reciprocating mass of its cylinder, a rod adds what its small end has
    beyond the mean to that, and what its big end has to the rotating mass.

    Parameters
    ----------
    engine
        The engine, with its counterweights and balance shafts: what they would remove hides what
        the parts make (see :func:`crankpin.counterweights`).
    pistons
        Measured masses of pistons with pins and rings, kg: (n_pistons,), at least one for each
        cylinder of each engine.
    rods
        Measured masses of the rods' small and big ends, kg: (n_rods, 2).
    objective
        ``"balance"``: what remains of ``orders`` in the engine, forward and backward parts of force
        and moment, in kg·m (over ω²), moments over half the distance from the first to the last
        cylinder; the root of the sum of squares is minimised.
        ``"spread"``: the difference between the heaviest and the lightest piston with small end.
    sets
        Number of engines to be filled; by default as many as the parts suffice for. Of several
        engines the sum of the objective is minimised.
    orders
        With ``objective="balance"``: whole multiples of crank speed.
    reference_z
        Plane about which moments are taken, m; by default midway between the first and the last
        cylinder.
    seed
        Seed of the random starts of the search where there are too many arrangements for all.
    progress
        True for a tqdm bar, or a function that is called with the steps done and the steps in all.

    Returns
    -------
    Match

    Raises
    ------
    InputError
        If there are too few parts, a mass is not above zero, or an argument is out of range.

    Notes
    -----
    Exact are: ``"balance"`` for one engine's worth of up to 12 pistons, or 8 pistons and rods (all
    arrangements are compared); ``"spread"`` of pistons alone for any number of parts and engines,
    and of one engine's worth of pistons and rods. Otherwise the search is a heuristic, and
    ``bound`` is a value below which no assignment comes.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4 = cp.Engine.preset("i4")
    >>> match = cp.match_parts(i4, [0.402, 0.398, 0.405, 0.401], orders=[1])
    >>> match.exact, match.assignment[0].pistons
    (True, (1, 3, 2, 4))
    >>> bool(match.value <= match.as_given)
    True
    >>> float(match.engines[0].balance(rpm=6000)[1].force.peak)  # 402 + 401 - 405 - 398 g
    0.0
    """
    engine_core(engine)
    count = len(engine)
    word = inputs.one_of("objective", objective, WORDS)
    masses = _masses("pistons", pistons, 1)
    ends = None if rods is None else _masses("rods", rods, 2)
    several = min(len(each) for each in (masses, ends) if each is not None) // count
    wanted = several if sets is None else inputs.whole("sets", sets)
    if not 1 <= wanted <= several:
        parts = f"{len(masses)} pistons" + ("" if ends is None else f" and {len(ends)} rods")
        if sets is None:
            raise InputError(f"pistons and rods: {parts} given; give {count} or more of each")
        hint = f"sets × {count} cylinders need as many"
        raise InputError(f"sets = {wanted}: there are {parts}; {hint}")
    listed = inputs.explicit_orders(orders)
    start = inputs.whole("seed", seed)
    if start < 0:
        raise InputError(f"seed = {start}: give zero or more")
    plane = inputs.optional_number("reference_z", reference_z)
    asked = progress_bar.checked(progress)
    checks.masses(engine, pistons=masses.max(), rods=0.0 if ends is None else ends.max())
    measured = MeasuredParts(engine, masses[:, 0], ends, tuple(listed), plane)
    if word == "spread":
        chosen, exact = _by_spread(measured, wanted)
        # Rods might make up for any difference of pistons.
        bound = sum(measured.value(word, each) for each in chosen) if exact else 0.0
    else:
        with progress_bar.shown(asked, "assignments") as report:
            chosen, exact, bound = _by_balance(measured, wanted, start, report)
    return Match(measured, word, tuple(chosen), bound, exact)


def _masses(name: str, values: ArrayLike, columns: int) -> NDArray[np.float64]:
    """Return masses, a row for each part."""
    found = inputs.array(name, values)
    shape = "(n,)" if columns == 1 else "(n, 2): small end and big end of each rod"
    if found.ndim != (1 if columns == 1 else 2) or (columns == 2 and found.shape[1] != 2):
        raise InputError(f"{name} has shape {found.shape}: give masses in kg of shape {shape}")
    if len(found) > MOST_PARTS:
        raise InputError(f"{name} has {len(found)} entries: give {MOST_PARTS} at most")
    if not (np.isfinite(found).all() and (found > 0.0).all()):
        raise InputError(f"{name} = {inputs.shorten(values)}: give masses above zero, kg")
    return found.reshape(-1, columns)


# --- the search -----------------------------------------------------------------------------------


def _by_spread(parts: MeasuredParts, sets: int) -> tuple[list[Assignment], bool]:
    """Return sets of pistons, and of rods, whose sums are most alike, and whether that is proved.

    Sorted against each other, pistons and rods of one engine have the least largest and the largest
    least sum: exchanging any two rods of another order makes the larger sum larger or none smaller.
    """
    count = len(parts.engine)
    pistons = matching.windows(parts.pistons, count, sets)
    if parts.rods is None:
        return [assignment_of(each) for each in pistons], True
    small = parts.rods[:, 0]
    # The lightest pistons with the heaviest rods.
    rods = matching.windows(small, count, sets)[::-1]
    found = [assignment_of(ours, theirs[::-1]) for ours, theirs in zip(pistons, rods, strict=True)]
    everything = len(parts.pistons) == len(small) == count * sets
    if everything:
        rising, falling = (
            np.argsort(parts.pistons, kind="stable"),
            np.argsort(-small, kind="stable"),
        )
        together = matching.windows(parts.pistons[rising] + small[falling], count, sets)
        others = [assignment_of(rising[each], falling[each]) for each in together]
        found = min(
            [found, others], key=lambda those: sum(parts.value("spread", each) for each in those)
        )
    return found, everything and sets == 1


def _by_balance(
    parts: MeasuredParts, sets: int, seed: int, report: Report
) -> tuple[list[Assignment], bool, float]:
    """Return assignments that leave little, whether that is proved the least, and a lower bound."""
    start, kinds = parts.start, parts.kinds
    lowest = sets * matching.lower_bound(start, kinds)
    if sets == 1:
        found = matching.best(start, kinds, seed=seed, report=report)
        assignment = assignment_of(*found.chosen)
        value = parts.value("balance", assignment)
        return [assignment], found.exact, value if found.exact else min(lowest, value)
    # Alike within a set, then each set in its best order.
    groups = [matching.windows(parts.pistons, len(parts.engine), sets)]
    if parts.rods is not None:
        groups.append(matching.windows(parts.rods.sum(axis=1), len(parts.engine), sets))
    chosen = []
    for done, of_set in enumerate(zip(*groups, strict=True), start=1):
        own = tuple(
            kind._replace(parts=kind.parts[each]) for kind, each in zip(kinds, of_set, strict=True)
        )
        found = matching.best(start, own, seed=seed)
        pairs = zip(of_set, found.chosen, strict=True)
        chosen.append(assignment_of(*(each[order] for each, order in pairs)))
        if report:
            report(done, sets)
    return chosen, False, lowest


class Match(Frozen, Shown):
    """Which piston and rod goes into which cylinder.

    Made by :func:`crankpin.match_parts`.
    """

    _fields: ClassVar[tuple[str, ...]] = ("parts", "objective", "assignment", "bound", "exact")

    parts: MeasuredParts
    """The measured parts and the engine."""
    objective: Objective
    """``"balance"`` or ``"spread"``."""
    assignment: tuple[Assignment, ...]
    """For each engine the numbers of its pistons and rods, cylinder by cylinder."""
    bound: float
    """Value below which no assignment comes, in the unit of ``value``; equal to it if exact."""
    exact: bool
    """True if no assignment is better: all were compared, or it is proved."""

    def __init__(
        self,
        parts: MeasuredParts,
        objective: str,
        assignment: tuple[Assignment, ...],
        bound: float,
        exact: bool,
    ) -> None:
        if not isinstance(parts, MeasuredParts):
            raise InputError(f"Match({inputs.shorten(parts)}): use crankpin.match_parts")
        self._set(parts=parts, objective=objective, assignment=assignment, bound=bound, exact=exact)

    @property
    def engine(self) -> Engine:
        """The engine with its own masses."""
        return self.parts.engine

    @property
    def unit(self) -> str:
        """Unit of the objective: kg·m (over ω²) or kg."""
        return UNITS[self.objective]

    @cached_property
    def values(self) -> tuple[float, ...]:
        """Objective of each engine."""
        return tuple(self.parts.value(self.objective, each) for each in self.assignment)

    @property
    def value(self) -> float:
        """Sum of the objective over the engines."""
        return sum(self.values)

    @property
    def as_given(self) -> float:
        """The same of the parts in the order in which they were given."""
        count = len(self.engine)
        given = (np.arange(k * count, (k + 1) * count) for k in range(len(self.assignment)))
        return sum(
            self.parts.value(
                self.objective, assignment_of(*([each] * (1 if self.parts.rods is None else 2)))
            )
            for each in given
        )

    @cached_property
    def engines(self) -> tuple[Engine, ...]:
        """The engines with their parts: masses are the engine's own and the parts' deviations."""
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
        totals = [len(self.parts.pistons), 0 if self.parts.rods is None else len(self.parts.rods)]
        used: list[set[int]] = [set(), set()]
        for each in self.assignment:
            used[0] |= set(each.pistons)
            used[1] |= set(each.rods or ())
        left = [
            tuple(k for k in range(1, total + 1) if k not in taken)
            for total, taken in zip(totals, used, strict=True)
        ]
        return left[0], left[1]

    def to_pandas(self) -> pd.DataFrame:
        """Return a tidy table: set, cylinder, piston and its mass, rod and its ends (pandas)."""
        columns = ["set", "cylinder", "piston", "piston_mass"]
        columns += [] if self.parts.rods is None else ["rod", "small_end", "big_end"]
        rows = [(*names, *numbers) for names, numbers in self._rows()]
        table = optional.data_frame(rows, columns=columns)
        return table.astype({name: int for name in ("piston", "rod") if name in columns})

    def _rows(self) -> list[tuple[tuple[int, int], list[float]]]:
        rows = []
        for k, each in enumerate(self.assignment, start=1):
            for cylinder, piston in enumerate(each.pistons, start=1):
                numbers = [float(piston), float(self.parts.pistons[piston - 1])]
                if each.rods is not None and self.parts.rods is not None:
                    rod = each.rods[cylinder - 1]
                    numbers += [float(rod), *self.parts.rods[rod - 1].tolist()]
                rows.append(((k, cylinder), numbers))
        return rows

    @property
    def table(self) -> Table:
        """Table that is shown: the parts of each cylinder."""
        header = ["set", "cylinder", "piston", "kg"]
        header += [] if self.parts.rods is None else ["rod", "small end kg", "big end kg"]
        known = "no assignment is better" if self.exact else f"none is below {self.bound:.4g}"
        title = f"{WORDS[self.objective]}: {self.value:.4g} {self.unit}, {known}"
        rows = self._rows()
        title += f"; as given {self.as_given:.4g}"
        return Table.from_rows(
            title, header, [names for names, _ in rows], np.array([row for _, row in rows])
        )
