"""Designs sorted by objectives: result of :func:`crankpin.design`."""

from __future__ import annotations

import dataclasses
import itertools
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.record import Listed
from crankpin._support.tables import Item, Table
from crankpin.analysis.arrangements.cranks import HALF, Crank
from crankpin.analysis.design.families import engines_of, turned
from crankpin.analysis.design.unlike import fewest_cylinders
from crankpin.analysis.ranking.objectives import ByObjectives, named
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.design.question import Question
    from crankpin.analysis.design.unlike import Unlike
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.model.engine import Engine

NEARBY = "*"
"""Mark of a design that other angles nearby equal."""


class Design(Item):
    """An engine of :class:`Designs`."""

    place: int
    """1 for the best; designs whose values are equal within the tolerance share a place."""
    engine: Engine = dataclasses.field(repr=False)
    """The engine, with the counterweights and balance shafts it is allowed."""
    values: tuple[float, ...]
    """Value of each objective, in the objective's unit."""
    isolated: bool
    """True if no other angles nearby are as good; False for one of a continuum of designs."""
    crank: Crank
    """Its angles as exact degrees."""
    images: Mapping[str, Crank] = dataclasses.field(repr=False)
    """Change → equivalent crank, which shakes the same; also where it is equal to the crank itself.

    ``"mirrored"`` (left and right exchanged), ``"reversed"`` (front and rear), ``"banks
    exchanged"``, or several of these."""

    @property
    def value(self) -> float:
        """Value of the first objective, in its unit."""
        return self.values[0]

    @property
    def bank_angle_deg(self) -> float | None:
        """Angle between the banks, degrees; None without banks."""
        return None if self.crank.bank_angle is None else float(self.crank.bank_angle)

    @property
    def throws_deg(self) -> tuple[float, ...]:
        """Crankpins of the only or the right bank from the front one, degrees in [0, 360)."""
        return self.crank.throws_deg

    @property
    def pin_split_deg(self) -> tuple[float, ...]:
        """Left pin minus right pin of each throw, degrees; empty without banks."""
        return self.crank.pin_split_deg

    def _figures(self) -> Mapping[str, object]:
        names = ("place", "throws_deg", "pin_split_deg", "bank_angle_deg", "equivalents")
        return {name: getattr(self, name) for name in (*names, "isolated", "values")}

    @property
    def equivalents(self) -> int:
        """Number of different equivalent cranks, this one included."""
        return len({self.crank, *self.images.values()})


class Designs(ByObjectives, Listed[Design], Tabled):
    """Designs sorted by objectives.

    A sequence of :class:`Design`, the best first. Made by :func:`crankpin.design`.
    """

    _items, _item, _maker = "designs", Design, "crankpin.design"

    question: Question
    """The request."""
    objectives: tuple[Objective, ...]
    """The objectives."""
    rpm: float
    """Crank speed."""
    orders: tuple[int, ...] | None
    """The orders that were given, or None for all that matter."""
    designs: tuple[Design, ...]
    """The designs, the best first."""
    optima: int
    """Number of designs found; ``designs`` are the best of them."""
    cranks: int
    """Number of cranks that were compared, equivalent ones included; free angles apart."""

    @cached_property
    def engines(self) -> tuple[Engine, ...]:
        """The engines, the best first."""
        return tuple(design.engine for design in self.designs)

    def over_bank_angle(self, bank_angle_deg: ArrayLike, count: int = 1) -> NDArray[np.float64]:
        """Return the first objective of the best designs at other bank angles.

        Crankpins are held, or, where a given firing has pins split for it, the top dead centres.
        Counterweights and balance shafts are fitted anew at each angle.

        Parameters
        ----------
        bank_angle_deg : array_like, shape (n_angles,)
            Bank angles, degrees, 0 to 180.
        count : int, default 1
            Number of designs.

        Returns
        -------
        ndarray of float, shape (count, n_angles)
            Values, in the objective's unit.

        Raises
        ------
        InputError
            If an angle is out of range, designs have one bank, or the first objective is a
            function.
        """
        if self.question.banks == 1:
            fault = "is undefined for these designs"
            raise inputs.faulty("bank_angle_deg", fault, "they have one bank")
        if not self.objectives[0].quantity:
            raise inputs.rejected("by", self.by[0], "give the name of a force, moment or torque")
        angles = inputs.vector("bank_angle_deg", bank_angle_deg)
        designs = self.designs[: inputs.whole("count", count, 1)]
        chosen: dict[str, Any] = {
            "rpm": self.rpm,
            "orders": "auto" if self.orders is None else self.orders,
        }
        if self.question.shafts:
            pairs = itertools.product(designs, angles.tolist())
            cranks = [turned(self.question, design.crank, angle) for design, angle in pairs]
            swept = sweep(engines_of(self.question, cranks), **chosen)
        else:
            engines = [design.engine for design in designs]
            swept = sweep(engines, bank_angle_deg=angles, hold=self.question.hold, **chosen)
        return named(self.by[0]).values(swept).reshape(len(designs), -1)

    # --- tables and pictures --------------------------------------------------------------------

    def _description(self, objectives: int | None = None) -> str:
        """Return the objectives, all or the first few, the speed and the balancers in words."""
        least = self._minimised(objectives, with_orders=self.orders is not None)
        return ", ".join([least, labels.value_text("rpm", self.rpm), *self._balancers()])

    def _balancers(self) -> list[str]:
        ratios = ", ".join(f"{ratio:+g}" for ratio in self.question.shafts)
        return [
            *(["with counterweights"] if self.question.counterweights else []),
            *([f"with balance shafts at {ratios}"] if ratios else []),
        ]

    @property
    def table(self) -> Table:
        """Table that is shown: the designs, best first."""
        if self.question.unlike is not None:
            return self._of_unlike_cylinders(self.question.unlike)
        designs = self.designs
        vee = self.question.banks == 2
        split = vee and any(any(design.pin_split_deg) for design in self)
        heads: list[str | tuple[str, str]] = ["place", ("throws", "°")]
        heads += [("pin split", "°")] if split else []
        heads += [("bank angle", "°")] if vee else []
        heads += [
            "equivalent",
            *((objective.head, objective.unit) for objective in self.objectives),
        ]
        rows = []
        for design in designs:
            mark = "" if design.isolated else NEARBY
            row: list[str | float] = [design.place, f"{design.crank.text}{mark}"]
            row += [design.crank.splits_text or "0"] if split else []
            row += [f"{design.bank_angle_deg:.8g}"] if design.bank_angle_deg is not None else []
            rows.append((*row, design.equivalents))
        values = np.array([design.values for design in designs]).reshape(-1, len(self.objectives))
        title = f"Designs by {self._description()}"
        if len(designs) < self.optima:
            title += f"; {len(designs)} of {self.optima}"
        note = f"{NEARBY} other angles nearby are as good"
        starred = any(not design.isolated for design in designs)
        return Table.from_rows(
            title, heads, rows, values, note=note if starred else "", loads=self.loads_counted
        )

    def _of_unlike_cylinders(self, unlike: Unlike) -> Table:
        """Return the table of designs with the masses and places that were unknown."""
        free = [
            (name, unit, [k for k, each in enumerate(values) if each is None])
            for name, unit, values in (("m", "kg", unlike.masses), ("z", "m", unlike.positions))
        ]
        heads: list[str | tuple[str, str]] = ["place", ("throws", "°")]
        heads += [(f"{name}{k + 1}", unit) for name, unit, which in free for k in which]
        heads += [(objective.head, objective.unit) for objective in self.objectives]
        rows = [
            (design.place, f"{design.crank.text}{'' if design.isolated else NEARBY}")
            for design in self.designs
        ]
        figures = [
            [
                *(design.engine.cylinders[k].reciprocating_mass for k in free[0][2]),
                *design.engine.z[free[1][2]],
                *design.values,
            ]
            for design in self.designs
        ]
        title = f"Designs of unlike cylinders by {self._description()}"
        notes = (
            []
            if all(each.isolated for each in self.designs)
            else [f"{NEARBY} other masses, places or throws nearby are as good"]
        )
        if len(unlike.masses) < (fewest := fewest_cylinders(self.objectives)):
            notes.append(f"All of these vanish of no fewer than {fewest} cylinders with one rod")
        return Table.from_rows(
            title, heads, rows, np.array(figures), note="; ".join(notes), loads=self.loads_counted
        )

    @property
    def loads_counted(self) -> str:
        """``"without gas pressure"``, as designs are; empty for objectives without torque."""
        return labels.gas_text([]) if self._of_torque else ""


def bank_angle_range(designs: Designs) -> tuple[float, float]:
    """Return the allowed bank angles."""
    low, high = map(float, designs.question.bank_angle)
    return (low, high) if low < high else (0.0, float(HALF))
