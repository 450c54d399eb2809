"""Findings on how an engine shakes: the residual, cancellations and their causes, advice."""

from __future__ import annotations

import html
import sys
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.tables import Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from crankpin._support.inputs import Order
    from crankpin.model.engine import Engine

SENTENCE_UNITS = ("m", "mm", *(
    unit
    for name in PLANE_VECTORS
    for unit in (QUANTITIES[name].unit, QUANTITIES[name].unit_over_square)
))  # fmt: skip
"""Units in sentences."""


def explain(engine: Engine, rpm: float | None = None) -> Explanation:
    """Return the explanation; :meth:`Engine.explain` documents the arguments."""
    speed = inputs.optional_number("rpm", rpm)
    explanation = Explanation(engine, speed)
    if speed is not None:
        inputs.warn_of_units(mean_piston_speed(engine, speed))
    return explanation


class Finding(NamedTuple):
    """A fact about an engine, before it is put into words."""

    kind: str
    """``"hardware"``, ``"shakes"``, ``"remedy"``, ``"bob weights"``, ``"cancels"``, ``"rest"``,
    ``"inertia torque"``, ``"gas torque"``, ``"gas orders"``, ``"firing"``, ``"load"`` or
    ``"articulated"``."""
    quantity: str = ""
    """``"force"``, ``"moment"``, or empty."""
    orders: tuple[Order, ...] = ()
    """Orders that it is about."""
    values: tuple[float, ...] = ()
    """Figures: N, N·m and degrees; without a speed forces and moments are over ω²."""
    reason: str = ""
    """Why it is so, or what does it."""
    groups: tuple[tuple[int, ...], ...] = ()
    """Numbers of the cylinders that cancel each other, or share a crankpin."""
    proved: bool = False
    """True if its zeros are proved, as by :meth:`Engine.vanishing_orders`."""


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
        return tuple(self._said(self._explained))

    @property
    def table(self) -> Table:
        """Sentences, and what each is about."""
        rows = [
            (finding.kind, QUANTITIES[finding.quantity].words if finding.quantity else "–", text)
            for finding, text in zip(self.findings, self.sentences, strict=True)
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
        if count is None:
            sentences = self._said(self._explained)
        else:
            first = min(inputs.whole("count", count, 0), sys.maxsize)
            explained = _core.explain(engine_core(self.engine), self.rpm, vectors=True)
            sentences = self._said(explained, first)
        items = "".join(f"<li>{html.escape(sentence)}</li>" for sentence in sentences)
        return f"<ul>{items}</ul>"

    def _said(self, explained: _core.Explanation, count: int | None = None) -> list[str]:
        """Return the sentences in the units that are set."""
        converted = [(unit, *units.convert(unit)) for unit in SENTENCE_UNITS]
        changed = [(unit, to, factor) for unit, to, factor in converted if to != unit]
        return explained.sentences(self.engine.loads_counted, changed, count)

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Facts behind the sentences, as data."""
        return tuple(
            Finding(each["kind"], each["quantity"], tuple(each["orders"]), tuple(each["values"]),
                    each["reason"], tuple(map(tuple, each["groups"])), each["proved"])
            for each in self._explained.findings
        )  # fmt: skip

    @cached_property
    def _explained(self) -> _core.Explanation:
        return _core.explain(engine_core(self.engine), self.rpm, vectors=False)

    # --- what figures are relative to -----------------------------------------------------------

    @property
    def unit(self) -> float:
        """First-order force of the strongest piston, or of a throw; 0 without both."""
        return self._explained.unit

    @property
    def strongest(self) -> tuple[float, str]:
        """First-order force that others are relative to, and the part that makes it.

        A piston's; a throw's where pistons are not worth mention beside it.
        """
        return self._explained.unit, self._explained.part

    @property
    def lever(self) -> float:
        """Longest lever of a cylinder or an unbalance about the reference plane, m."""
        return self._explained.lever
