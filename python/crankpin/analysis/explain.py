"""How an engine shakes, as findings: the residual, what cancels and why, and what would help."""

from __future__ import annotations

import html
import itertools
import sys
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.quantities import QUANTITIES
from crankpin._support.tables import Table
from crankpin.analysis.balance import Balance, mean_piston_speed
from crankpin.analysis.findings import MATTERS, Finding, Sums
from crankpin.analysis.request import Request, engine_core
from crankpin.analysis.sentences import abbreviated, sentence, unit_force

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from crankpin.model.engine import Engine

HIGHEST = 12
"""Highest order whose cancelling is explained."""


def explain(engine: Engine, rpm: float | None = None) -> Explanation:
    """Return the explanation; :meth:`Engine.explain` documents the arguments."""
    speed = inputs.optional_number("rpm", rpm)
    explanation = Explanation(engine, speed)
    if speed is not None:
        inputs.warn_of_units(mean_piston_speed(engine, speed))
    return explanation


def _of_planes(finding: Finding) -> bool:
    """Return whether a finding is about force or moment."""
    return bool(finding.quantity)


class Explanation(Tabled):
    """How an engine shakes: a plain sentence for each finding.

    What matters most stands first: what counterweights and shafts do, what shakes and what would
    remove it, what cancels and why, what all other orders add up to, torque and firing. "Exactly
    zero" is said where it is proved. Forces are mentioned from a hundredth of one piston's
    first-order force on, rocking moments from a hundredth of that at the longest lever. ``str()``
    joins the sentences, one a line; Jupyter shows a list.

    Made by :meth:`Engine.explain`.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.Engine.preset("v8-crossplane").explain(rpm=6000).sentences[0]
    'Order 1 leaves a rocking moment of 2.42 kN·m, constant in size, turning with the crank.'
    """

    engine: Engine
    """The engine."""
    rpm: float | None
    """Crank speed, rpm; None for figures relative to one piston's first-order force."""

    def __post_init__(self) -> None:
        engine_core(self.engine)
        if self.rpm is not None:
            inputs.angular_speed(self.rpm)

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences, what matters most first."""
        return tuple(self._said(self.findings))

    @property
    def table(self) -> Table:
        """Sentences, and what each is about."""
        rows = [
            (each.kind, QUANTITIES[each.quantity].words if each.quantity else "–", text)
            for each, text in zip(self.findings, self.sentences, strict=True)
        ]
        return Table.from_rows(self._title, ["finding", "quantity", "sentence"], rows)

    @property
    def _title(self) -> str:
        speed = "" if self.rpm is None else f" at {self.rpm:g} rpm"
        return f"{labels.name_of(self.engine)}{speed}"

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    def __repr__(self) -> str:
        """Return the sentences: they are no table of numbers."""
        return f"{self._title}\n{self}"

    def _repr_html_(self) -> str:
        return self.html()

    def html(self, count: int | None = None) -> str:
        """Return all sentences, or the first that are about force and moment, as a list in HTML.

        Parameters
        ----------
        count : int, optional
            Number of sentences, the first that are about force and moment; by default all.

        Returns
        -------
        str
            HTML.
        """
        count = None if count is None else min(inputs.whole("count", count, 0), sys.maxsize)
        findings = self._found() if count is None else filter(_of_planes, self._found())
        items = (html.escape(each) for each in self._said(itertools.islice(findings, count)))
        return f"<ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>"

    def _said(self, findings: Iterable[Finding]) -> list[str]:
        """Return the sentences of findings; the force that they are relative to is named once."""
        return abbreviated((sentence(each, self) for each in findings), unit_force(self), "F")

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What the sentences say, as data."""
        return tuple(self._found())

    def _found(self) -> Iterator[Finding]:
        """Yield the findings, what matters most first."""
        chosen = self._balance(torque=False)
        orders = tuple(sorted({*chosen.orders, *range(1, HIGHEST + 1)}))
        balance, verdicts = chosen._at_orders(orders), self.engine.vanishing_orders(orders)
        force = Sums(balance, "force", self.unit, verdicts.force)
        moment = Sums(balance, "moment", self.unit * self.lever, verdicts.moment)
        both = (force, moment)
        for sums in both:
            yield from sums.of_hardware()
        shaking = [(sums, int(k)) for sums in both for k in np.flatnonzero(sums.shakes)]
        shaking.sort(key=lambda each: -round(each[0].share(each[1]), 6))  # of equals, forces first
        weights = self._bob_weights()
        for sums, k in shaking:
            for finding in sums.shaking(k):
                yield finding
                if finding.kind == "remedy" and finding.reason:
                    yield from weights  # once
        noticed = np.abs(force.cylinders).sum(axis=(0, 1)) > MATTERS * self.unit
        for sums in both:
            yield from sums.cancelling(noticed)
        rest = tuple(
            float(each.peaks[~each.shakes].sum() + chosen.error_bound[each.name]) for each in both
        )
        yield Finding("rest", "", tuple(orders[k] for _, k in shaking), rest)
        yield from self._torques()
        yield from self._firing()
        yield from self._shared_pins()

    # --- what figures are relative to -----------------------------------------------------------

    def _balance(self, *, torque: bool) -> Balance:
        """Return the balance that findings are read from; over ω² without a speed."""
        request = Request.checked(orders="auto", rtol=None, spectrum=None, torque=torque)
        return Balance(self.engine, labels.UNIT_RPM if self.rpm is None else self.rpm, request)

    @property
    def unit(self) -> float:
        """First-order force of the strongest piston, or of a throw; 0 without both."""
        return self.strongest[0]

    @cached_property
    def strongest(self) -> tuple[float, str]:
        """First-order force that others are relative to, and the part that makes it.

        A piston's; a throw's where pistons are not worth mention beside it.
        """
        parts = list(zip(self.engine.cylinders, self.engine.rotating_mass.tolist(), strict=True))
        pistons = max(
            each.reciprocating_mass * each.crank_radius * abs(each.harmonics(1)[0])
            for each, _ in parts
        )
        throws = max(mass * each.crank_radius for each, mass in parts)
        omega = inputs.angular_speed(labels.UNIT_RPM if self.rpm is None else self.rpm)
        if pistons > MATTERS * throws:
            return omega**2 * float(pistons), "piston"
        return omega**2 * float(throws), "throw"

    @cached_property
    def lever(self) -> float:
        """Longest lever of a cylinder or an unbalance about the reference plane, m."""
        on_shafts = [each for shaft in self.engine.shafts for each in shaft.unbalances]
        places = [*self.engine.z, *(each.z for each in (*self.engine.counterweights, *on_shafts))]
        return float(np.abs(np.array(places) - self.engine.reference_z).max())

    # --- other findings -------------------------------------------------------------------------

    def _bob_weights(self) -> Iterator[Finding]:
        """Yield the bob weight that removes what turns with a crank: half of the pistons'."""
        offset = any(each.pin_offset for each in self.engine.cylinders)
        ratios = {ratio for _, _, ratio in self.engine._core.cranks[0]}
        if offset or any(shaft.ratio in ratios for shaft in self.engine.shafts):
            return
        if all(abs(ratio) == 1 for ratio in ratios):  # others have their first order elsewhere
            sense = "one sense" if ratios == {1} else "own sense"
            yield Finding("bob weights", "", (1,), (0.5,), sense)

    def _torques(self) -> Iterator[Finding]:
        """Yield the largest orders of roll torque: of inertia, and of gas if it counts."""
        balance = self._balance(torque=True)
        orders, gas = balance.orders, balance.crank_torque.gas
        if (peaks := balance.torque.inertia.peak).any():
            k = int(np.argmax(peaks))
            yield Finding("inertia torque", "", (orders[k],), (float(peaks[k]),))
        if self.engine.fired and (peaks := gas.peak).any():
            largest = [int(k) for k in np.argsort(-peaks)[:2] if peaks[k]]
            values = (gas.mean, *(float(peaks[k]) for k in largest))
            yield Finding("gas torque", "", tuple(orders[k] for k in largest), values)

    def _firing(self) -> Iterator[Finding]:
        """Yield how the engine fires, and the orders of gas torque that this leaves."""
        if not self.engine.firing_order:
            return
        fires = self.engine.firing()
        reason = "evenly" if fires.even else "unevenly"
        yield Finding("firing", "", (), tuple(fires.intervals_deg.tolist()), reason, (fires.order,))
        if any(ratio < 0 for _, _, ratio in self.engine._core.cranks[0]):
            return  # what cancels on the block is not what cancels on the crank
        in_two_turns = 4 * len(fires.order) // self.engine.strokes
        orders = [half / 2 for half in range(1, in_two_turns + 1)]
        gas = self.engine.vanishing_orders(orders).gas_torque
        if not gas.undecided and gas.remaining:
            yield Finding("gas orders", "", gas.remaining, (), reason, (fires.order,), proved=True)

    def _shared_pins(self) -> Iterator[Finding]:
        """Yield the rows of a radial, whose articulated rods are not modelled."""
        pins: dict[tuple[float, float, int], list[int]] = {}
        cranks = self.engine._core.cranks[1]
        where = zip(
            self.engine.z.tolist(), self.engine.pin_deg.round(6).tolist(), cranks, strict=True
        )
        for number, pin in enumerate(where, start=1):
            pins.setdefault(pin, []).append(number)
        rows = tuple(tuple(row) for row in pins.values() if len(row) > 2)
        if rows:
            yield Finding("articulated", "", (), (), "", rows)
