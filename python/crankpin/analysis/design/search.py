"""The search behind a design: candidates, their optima, and the best of them."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import progress as progress_bar
from crankpin.analysis.balance import balance
from crankpin.analysis.design import built, optima
from crankpin.analysis.design.designs import Design
from crankpin.analysis.design.families import families
from crankpin.analysis.ranking.choices import groups
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin._support.progress import Progress
    from crankpin.analysis.arrangements.cranks import Crank
    from crankpin.analysis.design.families import Family
    from crankpin.analysis.design.optima import Optimum
    from crankpin.analysis.design.question import Question
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.sweep import Sweep


GUIDING = 1e-6
"""Tolerance, as ``rtol`` of a balance, of the totals by which angles are optimised."""


class Search:
    """Candidates of a question, and the objectives by which they are compared."""

    def __init__(
        self,
        question: Question,
        objectives: Sequence[Objective],
        rpm: float,
        orders: list[int] | None,
    ) -> None:
        self._question, self._objectives = question, objectives
        self._rpm, self._orders = rpm, orders
        self._families, self.cranks = families(question)
        if orders is None:
            # Totals guide the optimiser; those of the result have all orders.
            orders = list(balance(built.one_cylinder(question), rpm, rtol=GUIDING).orders)
        self._totals = orders
        self._smooth = [
            (each.quantity, each.what, each.order) for each in objectives if each.quantity
        ]
        unnamed = [each.label for each in objectives if not each.quantity]
        if unnamed and any(family.variables for family in self._families):
            raise InputError(
                f'by = "{unnamed[0]}": angles that vary are optimised by forces, moments and '
                "torques; fix the angles, or design by others and rank the engines with "
                "crankpin.rank"
            )
        # What an objective cannot read is an error before the search.
        self._values([self._families[0].base])

    def optima(self, count: int, seed: int, progress: Progress) -> list[Optimum]:
        """Return the designs at which no small change of angles helps."""
        fixed = [each for each in self._families if not each.variables]
        single = [each for each in self._families if len(each.variables) == 1]
        several = [each for each in self._families if len(each.variables) > 1]
        symmetries = self._question.symmetries
        found = [optima.Optimum(each.base, isolated=True, values=()) for each in fixed]
        with progress_bar.shown(progress, "designs") as shown:

            def told(done: int, total: int) -> None:
                if shown is not None:
                    shown(done, total)

            if single:
                found += optima.of_one_angle(single, self._merit, symmetries, count, told)
            if several:
                found += optima.of_several_angles(several, self._merit, symmetries, seed, told)
        return found

    def best(
        self, found: Sequence[Optimum], count: int, rtol: float
    ) -> tuple[tuple[Design, ...], Sweep]:
        """Return the best designs, and the sweep of all that were found."""
        symmetries = self._question.symmetries
        cranks = [self._firing(symmetries.first(each.crank)) for each in found]
        swept, rows = self._values(cranks)
        tolerances = rtol * self._scales(rows)
        designs: list[Design] = []
        for group in groups(rows, np.arange(len(found)), tolerances):
            place = len(designs) + 1
            for k in group[: count - len(designs)]:
                images = dict(symmetries.images(cranks[k]))
                values, isolated = tuple(rows[k].tolist()), found[k].isolated
                engine = swept.engines[k]
                if order := self._question.firing_order(cranks[k]):
                    engine = engine.replace(firing_order=order, strokes=self._question.strokes)
                designs.append(Design(place, engine, values, isolated, cranks[k], images))
            if len(designs) >= count:
                break
        return tuple(designs), swept

    def _firing(self, crank: Crank) -> Crank:
        """Return the first of the cranks that shake alike which fires at the intervals asked for.

        A mirror reverses the sequence of the intervals.
        """
        if self._question.intervals is None:
            return crank
        alike = (crank, *(image for _, image in self._question.symmetries.images(crank)))
        return next(filter(self._question.firing_order, alike), crank)

    def _values(self, cranks: Sequence[Crank]) -> tuple[Sweep, NDArray[np.float64]]:
        """Return the sweep of the engines, and their objectives: (n_cranks, n_objectives)."""
        swept = sweep(
            built.engines(self._question, cranks),
            rpm=self._rpm,
            orders="auto" if self._orders is None else self._orders,
        )
        return swept, np.stack([each.values(swept)[:, 0] for each in self._objectives], axis=1)

    def _merit(self, family: Family) -> _core.Merit:
        question = dataclasses.replace(self._question, shafts=())
        (engine,) = built.engines(question, [family.base])
        turns = [each.turns(question.banks, question.count) for each in family.variables]
        removed = self._question.shafts
        return _core.Merit(engine.core, turns, self._smooth, self._totals, removed)

    def _scales(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the largest value that each objective could have; of a function that it has."""
        over_square = self._merit(self._families[0]).scales if self._smooth else ()
        named = iter([_core.angular_speed(self._rpm) ** 2 * scale for scale in over_square])
        largest = np.abs(np.where(np.isfinite(rows), rows, 0.0)).max(axis=0)
        pairs = zip(self._objectives, largest, strict=True)
        return np.array([next(named) if each.quantity else most for each, most in pairs])
