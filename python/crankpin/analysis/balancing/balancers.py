"""Sets of balancing hardware compared: hardware against residual."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.frames import SHOWN, Tabled
from crankpin._support.record import AbsentError, Listed
from crankpin._support.tables import Item, Table
from crankpin.analysis.balance import balance
from crankpin.analysis.ranking.objectives import ByObjectives

if TYPE_CHECKING:
    from collections.abc import Mapping

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Shaft, Unbalance


class BalancerOption(Item):
    """A set of balancing hardware, and its residual."""

    name: str
    """The set in words, such as ``"counterweights + shaft −1"``."""
    counterweights: tuple[Unbalance, ...]
    """Counterweights that were added."""
    shafts: tuple[Shaft, ...]
    """Shafts that were added."""
    fitted: Engine = field(repr=False)
    """The engine with them."""
    values: tuple[float, ...] = ()
    """Residual: the value of each objective, in its unit."""
    on_pareto_front: bool = False
    """True if no other set has as few shafts, as little unbalance and as little left."""
    reaches: bool = False
    """True if the target is reached; False without one."""

    @cached_property
    def unbalance(self) -> float:
        """Sum of the amounts of all unbalances that were added, kg·m."""
        on_shafts = (weight for shaft in self.shafts for weight in shaft.unbalances)
        return sum(counterweight.amount for counterweight in (*self.counterweights, *on_shafts))

    @property
    def hardware(self) -> tuple[Unbalance | Shaft, ...]:
        """Counterweights and shafts that were added."""
        return (*self.counterweights, *self.shafts)

    def _figures(self) -> Mapping[str, object]:
        counts = {name: len(getattr(self, name)) for name in ("counterweights", "shafts")}
        names = ("unbalance", "values", "on_pareto_front", "reaches")
        return {"name": self.name} | counts | {name: getattr(self, name) for name in names}


class BalancerOptions(ByObjectives, Listed[BalancerOption], Tabled):
    """Sets of balancing hardware, fewest shafts and least unbalance first.

    A sequence of :class:`~crankpin.results.BalancerOption`. Made by
    :func:`crankpin.balancer_options`, which says what is compared.

    Examples
    --------
    >>> import crankpin as cp
    >>> options = cp.balancer_options(cp.Engine.preset("i4"), rpm=6000)
    >>> [(option.name, len(option.shafts)) for option in options.pareto_front]
    [('nothing', 0), ('shaft +2', 1), ('shaft −2', 1), ('shafts −2, +2', 2)]
    >>> float(options[-1].fitted.balance(rpm=6000, orders=[2])[2].force.peak)
    0.0
    """

    _items, _item, _maker = "options", BalancerOption, "crankpin.balancer_options"

    engine: Engine
    """The engine to be balanced."""
    rpm: float
    """Crank speed, rpm."""
    objectives: tuple[Objective, ...]
    """The objectives, to be small."""
    targets: tuple[tuple[str, float], ...]
    """Objective and the value that it must not exceed, in its unit."""
    options: tuple[BalancerOption, ...]
    """All sets."""

    @property
    def pareto_front(self) -> tuple[BalancerOption, ...]:
        """The Pareto front: sets to which no other is equal or better in every respect.

        Respects are the number of shafts, the sum of unbalances and the value of each objective.
        """
        return tuple(option for option in self.options if option.on_pareto_front)

    @property
    def smallest(self) -> BalancerOption | None:
        """The set with the fewest shafts, then the least unbalance, that reaches the target.

        None if no set does, or no target was given.
        """
        return next((option for option in self.options if option.reaches), None)

    @property
    def fitted(self) -> Engine:
        """The engine with the least hardware that reaches the target; undefined without one."""
        return self._least.fitted

    @property
    def hardware(self) -> tuple[Unbalance | Shaft, ...]:
        """The least hardware that reaches the target; undefined without one."""
        return self._least.hardware

    @property
    def residual(self) -> Balance:
        """Balance with the least hardware that reaches the target, at the crank speed."""
        return balance(self.fitted, self.rpm)

    @property
    def _least(self) -> BalancerOption:
        if self.smallest is None:
            what = "no set reaches the target" if self.targets else "no target was given"
            hint = f"{what}; choose one of options, such as options[0]"
            raise inputs.faulty("fitted", "is undefined", hint, AbsentError)
        return self.smallest

    # --- tables and pictures --------------------------------------------------------------------

    def tidy(self, *objectives: str) -> Table:
        """Return all sets in long form, a row for each set and objective.

        Columns are name, n_shafts, unbalance, on_pareto_front, reaches, objective, value and unit.

        Parameters
        ----------
        *objectives : str, optional
            Names of objectives, those of ``by``; by default all.

        Returns
        -------
        Table
            The rows; its ``to_pandas`` and ``to_csv`` write them.

        Raises
        ------
        InputError
            If there is no such objective.
        """
        names = {objective.label: objective for objective in self.objectives}
        chosen = [inputs.one_of("objectives", name, names) for name in objectives] or names
        rows = [
            (
                option.name, len(option.shafts), option.unbalance, option.on_pareto_front,
                option.reaches, objective.label, value, objective.unit,
            )
            for option in self.options
            for objective, value in zip(self.objectives, option.values, strict=True)
            if objective.label in chosen
        ]  # fmt: skip
        heads = (
            "name", "n_shafts", ("unbalance", "kg·m"), "on_pareto_front", "reaches", "objective",
            "value", "unit",
        )  # fmt: skip
        title = f"{labels.name_of(self.engine)} at {self.rpm:g} rpm: sets of hardware"
        return Table.from_rows(
            title, heads, rows, loads=self.loads_counted, row_units=[str(row[-1]) for row in rows]
        )

    @property
    def table(self) -> Table:
        """Table that is shown: the Pareto front."""
        engine = labels.name_of(self.engine)
        front = self.pareto_front[:SHOWN]
        columns = {
            "set": [option.name for option in front],
            "shafts": [str(len(option.shafts)) for option in front],
        }
        if self.targets:
            columns["target"] = ["reached" if option.reaches else "missed" for option in front]
        heads = [(objective.head, objective.unit) for objective in self.objectives]
        return Table.from_rows(
            f"{labels.cut(engine)} at {self.rpm:g} rpm: hardware against residual, "
            f"{len(self.pareto_front)} of {len(self)} sets on the Pareto front",
            [*columns, ("unbalance", "kg·m"), *heads],
            list(zip(*columns.values(), strict=True)),
            np.array([(option.unbalance, *option.values) for option in front]),
            note=self._note(),
            loads=self.loads_counted,
        )

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; of torque gas pressure does too."""
        loads = self.engine.loads_counted
        return loads if self._of_torque else labels.without_gas(loads)

    def _note(self) -> str:
        if not self.targets:
            return ""
        by_label = {objective.label: objective for objective in self.objectives}
        wanted = ", ".join(
            f"{by_label[label].head} ≤ {value:.5g} {by_label[label].unit}".strip()
            for label, value in self.targets
        )
        outcome = "no set reaches it" if self.smallest is None else f"least {self.smallest.name}"
        return f"Target: {wanted}; {outcome}."
