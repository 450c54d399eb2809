"""Inverse design: the cranks, pin splits and bank angles that minimise an objective."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Literal

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support import progress as progress_bar
from crankpin._support.messages import suppressed
from crankpin._support.parameters import documented
from crankpin.analysis.balance import balance
from crankpin.analysis.design import optima
from crankpin.analysis.design.designs import Design, Designs
from crankpin.analysis.design.families import engines_of, families, one_cylinder, warn_of_units
from crankpin.analysis.design.question import checked
from crankpin.analysis.design.vanishing import sorted_engines
from crankpin.analysis.ranking.objectives import listed as listed_objectives
from crankpin.analysis.ranking.objectives import tie_tolerance
from crankpin.analysis.ranking.ranking import groups
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from fractions import Fraction

    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle, Angles, Order, Orders
    from crankpin._support.progress import Progress
    from crankpin.analysis.arrangements.cranks import Crank
    from crankpin.analysis.design.families import Family
    from crankpin.analysis.design.optima import Optimum
    from crankpin.analysis.design.question import Kind, Question, Range
    from crankpin.analysis.design.unlike import Unlike
    from crankpin.analysis.ranking.objectives import Measure, Objective
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.model.cylinder import Cylinder


@documented()
def design(
    cylinders: int,
    *,
    layout: Kind,
    cylinder: Cylinder,
    spacing: float | None = None,
    rpm: float,
    by: str | Measure | Sequence[str | Measure],
    bank_angle_deg: Range | None = None,
    shared_pins: bool | None = None,
    pin_split_deg: Range | None = None,
    same_split: bool = True,
    throws_deg: Angles | Sequence[Angle | None] | Literal["free"] | None = None,
    masses: Sequence[float | None] | None = None,
    positions: Sequence[float | None] | None = None,
    even_firing: bool = False,
    intervals_deg: Angles | None = None,
    strokes: int = 4,
    counterweights: bool = False,
    shafts: Iterable[float | str | Fraction] = (),
    bank_stagger: float = 0.0,
    rotating_mass: float | None = None,
    orders: Orders = "auto",
    count: int = 20,
    seed: int = 0,
    tie_rtol: float = 1e-9,
    progress: Progress = False,
) -> Designs:
    """Choose throws, their order, pin splits and bank angle that minimise an objective.

    Finite choices (orders of throws; the throws that a firing needs) are all compared, those that
    are mirror images of each other once. A single angle that may vary is followed over its range,
    several are optimised from many starts, with closed-form derivatives (needs SciPy); all optima
    found are reported. With ``masses`` or ``positions`` cylinders in line are unlike, and what is
    None of these and of the throws is chosen so that forces and moments of orders vanish.

    Parameters
    ----------
    cylinders : int
        Number of cylinders.
    layout : {"inline", "vee", "flat", "boxer"}
        ``"inline"``, ``"vee"``, ``"flat"`` (a vee of 180° on shared pins) or ``"boxer"`` (pins
        split by 180°).
    cylinder : Cylinder
        Moving parts of every cylinder.
    spacing : float, optional
        Distance between neighbouring throws, m. Needed without ``positions``.
    rpm : float
        Crank speed, rpm.
    by : str, callable or sequence of these
        Quantity to minimise, as in :func:`crankpin.rank`: names of objectives, the later
        ones breaking ties. Functions of a :class:`Balance` only where no angle varies.
    bank_angle_deg : number, str or pair of these, optional
        Bank angle of a vee, degrees, or the lowest and the highest to choose from. A pair such as
        ``(60, 120)``.
    shared_pins : bool, optional
        True, the default, for crankpins that the two cylinders of a throw share; False for pins
        that are split by any angle.
    pin_split_deg : number, str or pair of these, optional
        Left pin minus right pin, degrees, or the lowest and the highest to choose from. From −180
        to 180, in place of ``shared_pins``.
    same_split : bool, default True
        False for a split of each throw's own.
    throws_deg : sequence of number or str, or "free", optional
        Throws to be put in the best order, degrees, or ``"free"`` for any angles; by default
        equally spaced ones. These are, of an even number, also half as many directions, each twice
        (0-180-180-0). With ``masses`` or ``positions`` they are those of the throws in their
        sequence, None for unknown ones, and by default free.
    masses : sequence of float or None, optional
        Reciprocating masses of unlike cylinders in line, kg, from the front one. None for those
        that are to be chosen so that the objectives vanish.
    positions : sequence of float or None, optional
        Places of the cylinders along the crank, m, ascending. None for those to be chosen.
    even_firing : bool, default False
        True for only cranks that fire evenly. That determines the throws, and, on shared
        pins, the bank angles.
    intervals_deg : sequence of number or str, optional
        Firing intervals that the engine must allow, one after another, degrees, in place of
        ``even_firing``; they add up to 720.
    strokes : {4, 2}, default 4
        4 or 2: strokes of a cycle.
    counterweights : bool, default False
        True for counterweights on each crankpin that remove its cylinders' share of the forward
        part of the first order, which does not count then.
    shafts : sequence of number or str, optional
        Speed ratios of balance shafts that are allowed, multiples of 1/2 such as ``[-1]``,
        ``[2, -2]`` or ``["-3/2"]``: each
        removes the part of its order that turns with it, force and moment. They are put on the
        crank axis, where they add no roll torque.
    rotating_mass : float, optional
        Rotating mass of every cylinder, kg, as in :meth:`Engine.vee`; by default the rod's big
        end.
    orders : int, sequence of int or "auto", default "auto"
        Orders that totals are of, as in :meth:`Engine.balance`.
    count : int, default 20
        Number of designs to return.
    seed : int, default 0
        Seed of the random starts, which are only needed where several angles vary.
    tie_rtol : float, default 1e-09
        Values tie when they differ by at most this, relative to the largest that the objective
        could have, all cylinders in phase.
    progress : bool or callable, default False
        True for a tqdm bar (needs tqdm), or a function of (steps done, steps in all).

    Returns
    -------
    Designs
        The best first.

    Raises
    ------
    InputError
        If an argument is out of range, arguments contradict each other, or no crank fires so.
    ImportError
        If several angles vary and SciPy is not installed.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, or a figure seems to be in another unit.

    Examples
    --------
    Which bank angle for a V10 on five shared pins? All 24 cranks in one call:

    >>> import crankpin as cp
    >>> parts = cp.Cylinder(0.045, 0.158, 0.5)
    >>> v10 = {"cylinders": 10, "layout": "vee", "cylinder": parts, "spacing": 0.1, "rpm": 6000}
    >>> v10 |= {"bank_angle_deg": (60, 120)}
    >>> best = cp.design(**v10, even_firing=True, by="total.moment.peak")[0]
    >>> best.bank_angle_deg, best.engine.name
    (72.0, 'V10 72°, 0-144-216-288-72')

    If it need not fire evenly, and has counterweights, 90°:

    >>> by = "[1].moment.backward,[2].moment.peak"
    >>> cp.design(**v10, counterweights=True, by=by)[0].bank_angle_deg
    90.0
    """
    objectives = listed_objectives(by)
    tolerance = tie_tolerance(tie_rtol)
    wanted, start = inputs.whole("count", count, 1), inputs.whole("seed", seed, 0)
    speed = inputs.number("rpm", rpm)
    summed = inputs.orders(orders)
    watched = progress_bar.checked(progress)
    question = checked(
        cylinders,
        layout,
        cylinder=cylinder,
        spacing=spacing,
        bank_angle_deg=bank_angle_deg,
        shared_pins=shared_pins,
        pin_split_deg=pin_split_deg,
        same_split=same_split,
        throws_deg=throws_deg,
        even_firing=even_firing,
        intervals_deg=intervals_deg,
        strokes=strokes,
        bank_stagger=bank_stagger,
        rotating_mass=rotating_mass,
        counterweights=counterweights,
        shafts=shafts,
        masses=masses,
        positions=positions,
    )
    with suppressed("mean piston speed"):
        if question.unlike is not None:
            designs, swept = _of_unlike_cylinders(
                question, question.unlike, objectives, speed, summed, start, tolerance, watched
            )
            number = cranks = len(designs)
        else:
            warn_of_units(question)
            search = Search(question, objectives, speed, summed)
            best = search.optima(wanted, start, watched)
            designs, swept = search.best(best, wanted, tolerance)
            number, cranks = len(best), search.cranks
    inputs.warn_of_units(swept.mean_piston_speed)
    return Designs(
        question,
        tuple(objective.bare() for objective in objectives),
        speed,
        None if summed is None else tuple(summed),
        designs[:wanted],
        number,
        cranks,
    )


def _of_unlike_cylinders(
    question: Question,
    unlike: Unlike,
    objectives: Sequence[Objective],
    rpm: float,
    orders: Sequence[Order] | None,
    seed: int,
    tie_rtol: float,
    progress: Progress,
) -> tuple[tuple[Design, ...], Sweep]:
    """Return the designs of which the first objectives vanish, and the sweep of them."""
    ordered, swept = sorted_engines(
        question, unlike, objectives, rpm, orders, seed, tie_rtol, progress
    )
    mirror = not question.cylinder.pin_offset
    return tuple(
        Design(*each, {"mirrored": each[-1].mirrored()} if mirror else {}) for each in ordered
    ), swept


# --- the search -----------------------------------------------------------------------------------

GUIDING = 1e-6
"""Tolerance, as ``rtol`` of a balance, of the totals by which angles are optimised."""


class Search:
    """Candidates of a question, and the objectives by which they are compared."""

    def __init__(
        self,
        question: Question,
        objectives: Sequence[Objective],
        rpm: float,
        orders: Sequence[Order] | None,
    ) -> None:
        self._question, self._objectives = question, objectives
        self._rpm, self._orders = rpm, orders
        self._families, self.cranks = families(question)
        if orders is None:
            # Totals guide the optimiser; those of the result have all orders.
            orders = balance(one_cylinder(question), rpm, rtol=GUIDING).orders
        self._totals = orders
        for objective in objectives:
            if "." in objective.quantity or (objective.order or 1) % 1:
                hint = "give whole orders of whole quantities, or rank fired engines"
                raise inputs.rejected(
                    "by", objective.label, f"designs have no gas pressure; {hint}"
                )
        self._smooth = [
            (
                objective.quantity,
                objective.what,
                None if objective.order is None else int(objective.order),
            )
            for objective in objectives
            if objective.quantity
        ]
        unnamed = [objective.label for objective in objectives if not objective.quantity]
        if unnamed and any(family.variables for family in self._families):
            hint = "fix the angles, or design by others and rank the engines with crankpin.rank"
            hint = f"angles that vary are optimised by forces, moments and torques; {hint}"
            raise inputs.rejected("by", unnamed[0], hint)
        # What an objective cannot read is an error before the search.
        self._values([self._families[0].base])

    def optima(self, count: int, seed: int, progress: Progress) -> list[Optimum]:
        """Return the designs at which no small change of angles helps."""
        fixed = [family for family in self._families if not family.variables]
        single = [family for family in self._families if len(family.variables) == 1]
        several = [family for family in self._families if len(family.variables) > 1]
        symmetries = self._question.symmetries
        results = [optima.Optimum(family.base, isolated=True, values=()) for family in fixed]
        with progress_bar.shown(progress, "designs") as bar:

            def report(done: int, total: int) -> None:
                if bar is not None:
                    bar(done, total)

            if single:
                results += optima.of_one_angle(single, self._merit, symmetries, count, report)
            if several:
                results += optima.of_several_angles(several, self._merit, symmetries, seed, report)
        return results

    def best(
        self, candidates: Sequence[Optimum], count: int, rtol: float
    ) -> tuple[tuple[Design, ...], Sweep]:
        """Return the best designs, and the sweep of all that were found."""
        symmetries = self._question.symmetries
        cranks = [self._firing(symmetries.first(candidate.crank)) for candidate in candidates]
        swept, rows = self._values(cranks)
        tolerances = rtol * self._scales(rows)
        designs: list[Design] = []
        for group in groups(rows, np.arange(len(candidates)), tolerances):
            place = len(designs) + 1
            for k in group[: count - len(designs)]:
                images = dict(symmetries.images(cranks[k]))
                values, isolated = tuple(rows[k].tolist()), candidates[k].isolated
                engine = swept.engines[k]
                if order := self._question.firing_order(cranks[k]):
                    engine = engine.replace(firing_order=order, strokes=self._question.strokes)
                designs.append(Design(place, engine, values, isolated, cranks[k], images))
            if len(designs) >= count:
                break
        return tuple(designs), swept

    def _firing(self, crank: Crank) -> Crank:
        """Return the first of the equivalent cranks that fires at the intervals given.

        A mirror reverses the sequence of the intervals.
        """
        if self._question.intervals is None:
            return crank
        equivalent = (crank, *(image for _, image in self._question.symmetries.images(crank)))
        return next(filter(self._question.firing_order, equivalent), crank)

    def _values(self, cranks: Sequence[Crank]) -> tuple[Sweep, NDArray[np.float64]]:
        """Return the sweep of the engines, and their objectives: (n_cranks, n_objectives)."""
        swept = sweep(
            engines_of(self._question, cranks),
            rpm=self._rpm,
            orders="auto" if self._orders is None else self._orders,
        )
        return swept, np.stack(
            [objective.values(swept)[:, 0] for objective in self._objectives], axis=1
        )

    def _merit(self, family: Family) -> _core.Objectives:
        question = dataclasses.replace(self._question, shafts=())
        (engine,) = engines_of(question, [family.base])
        turns = [variable.turns(question.banks, question.count) for variable in family.variables]
        removed = self._question.shafts
        return _core.Objectives(engine._core, turns, self._smooth, self._totals, removed)

    def _scales(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the largest value that each objective could have; of a function that it has."""
        over_square = self._merit(self._families[0]).scales if self._smooth else ()
        named = iter([_core.angular_speed(self._rpm) ** 2 * scale for scale in over_square])
        largest = np.abs(np.where(np.isfinite(rows), rows, 0.0)).max(axis=0)
        pairs = zip(self._objectives, largest, strict=True)
        return np.array([next(named) if objective.quantity else most for objective, most in pairs])
