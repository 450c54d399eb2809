"""Star diagrams: phase vectors of the cylinders of a firing order, and their sums."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.quantities import STARS
from crankpin._support.tables import Column, Table
from crankpin.analysis import firing as fires
from crankpin.analysis.export import VALUES
from crankpin.analysis.firing import Firing  # noqa: TC001 - a field
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.quantity import Keyed
from crankpin.analysis.request import engine_core
from crankpin.analysis.vanishing import Verdicts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine

HIGHEST_DRAWN = 12
"""Highest order of a diagram whose orders are not given."""


class StarDiagram(Keyed, Labelled):
    """Phase vectors of the cylinders of an engine, and their sums, order by order.

    At order k the gas torque of a cylinder whose firing top dead centre, its crankpin in line with
    the bore, is at the crank angle φ has the phase exp(−ikφ). Of alike cylinders with one cycle the
    sum of these vectors, times the torque's harmonic of one cylinder, is the engine's; with the
    amplitudes of a torsional mode shape as their lengths it is what excites the mode. A cylinder
    that does not fire, of an engine with cycles in others, has no vector. ``d[1.5]`` is a sum.

    Made by :func:`crankpin.star_diagram`.

    Examples
    --------
    >>> import crankpin as cp
    >>> d = cp.star_diagram(cp.Engine.preset("v6-90-odd-fire"), orders=[0.5, 1, 1.5, 3])
    >>> d.sums.peak.round(6)
    array([0.      , 0.      , 2.296101, 4.242641])
    >>> d.verdicts[1.5], d.verdicts.vanishing
    ('remains', (0.5, 1))
    >>> d.major
    ()
    """

    _along = ("order",)
    _registry = STARS

    firing: Firing
    """Order and angles of firing."""
    orders: tuple[Order, ...]
    """Multiples of crank speed, whole or half."""
    mode_shape: tuple[float, ...]
    """Length of each cylinder's vector, by number."""

    @cached_property
    def _core(self) -> _core._Star:
        return _core.star(
            self.firing._core, [round(2 * order) for order in self.orders], list(self.mode_shape)
        )

    @property
    def engine(self) -> Engine:
        """The engine."""
        return self.firing.engine

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"cylinder": np.arange(1, len(self.engine) + 1)}

    def _dims(self, quantity: str, what: str = VALUES) -> tuple[str, ...]:
        return tuple(sorted(super()._dims(quantity, what), key=("cylinder",).count))

    def _values(self, quantity: str) -> NDArray[np.complex128]:
        return self._core["vectors"] if quantity == "vectors" else self._core["sums"]

    @property
    def vectors(self) -> Quantity[np.complex128]:
        """Vectors by cylinder number: (n_orders, n_cylinders)."""
        return self._quantity("vectors")

    @property
    def sums(self) -> Quantity[np.complex128]:
        """Sums of the vectors, (n_orders,): zero where proved to vanish, or within rounding.

        ``sums.peak`` are their lengths.
        """
        return self._quantity("sums")

    @cached_property
    def verdicts(self) -> Verdicts:
        """Verdicts on the sums by order: "vanishes", "remains" or "undecided", in integers."""
        pairs = zip(self._core["vanishes"], self._core["remains"], strict=True)
        words = ("vanishes" if zero else "remains" if not_zero else "undecided"
                 for zero, not_zero in pairs)  # fmt: skip
        return Verdicts(self.orders, tuple(words), tuple(map(bool, self.read("sums") == 0.0)))

    @property
    def major(self) -> tuple[Order, ...]:
        """Major orders: those at which all cylinders that fire have one phase."""
        is_major = self._core["is_major"]
        return tuple(n for n, major in zip(self.orders, is_major, strict=True) if major)

    def __getitem__(self, order: Order) -> complex:
        """Return the sum of an order.

        Raises
        ------
        InputError
            If the order is not among ``orders``.
        """
        return complex(self.read("sums")[self._place(order)])

    @property
    def table(self) -> Table:
        """Length and direction of each sum, and what is proved of it."""
        major, sums, peak = self.major, self.read("sums"), self.sums.peak
        words = [
            "major" if order in major else word
            for order, word in zip(self.orders, self.verdicts.words, strict=True)
        ]
        longest = float(np.abs(self.read("vectors")[0]).sum())
        share = 100.0 * peak / longest if longest else np.zeros(len(sums))
        columns = (
            Column("order", self.orders, digits=10),
            Column("sum", peak),
            Column("share", share, "%", decimals=1),
            Column("direction", np.angle(sums, deg=True), "°", decimals=1),
            Column("", tuple(words)),
        )
        return Table(
            f"{labels.name_of(self.engine)}: phase vectors, {self.firing.summary}",
            columns,
            loads=self.loads_counted,
        )

    @property
    def loads_counted(self) -> str:
        """Gas pressure of a fired engine, in words; empty where no cycle is known."""
        return self.engine._core.gas_counted if self.engine.fired else ""


def star_diagram(
    engine: Engine,
    orders: Orders | None = None,
    *,
    mode_shape: ArrayLike | None = None,
    firing_order: str | Iterable[int] | None = None,
    strokes: int | None = None,
) -> StarDiagram:
    """Return the phase vectors of an engine's cylinders and their sums, order by order.

    Parameters
    ----------
    engine : Engine
        The engine; its firing order is taken from it or given.
    orders : number or sequence of numbers, optional
        Multiples of crank speed, halves among them in a four-stroke. By default all up to 12.
    mode_shape : array_like, shape (n_cylinders,), optional
        Amplitude of a torsional mode at each cylinder, by number; by default 1.
    firing_order : str or sequence of int, optional
        Firing order, such as ``"1-3-4-2"``; by default the engine's own. A list, or text with ``+``
        between cylinders that fire together.
    strokes : {4, 2}, optional
        Strokes of a cycle, 4 or 2; by default the engine's own.

    Returns
    -------
    StarDiagram
        The vectors, without unit, and their sums.

    Raises
    ------
    InputError
        If the firing order is neither given nor known, the crank does not allow it, or a half order
        of a two-stroke is requested.

    Examples
    --------
    An inline-6 on its first torsional mode: order 3 is major, order 1½ is left by the mode.

    >>> import crankpin as cp
    >>> shape = [1, 0.95, 0.86, 0.73, 0.57, 0.39]
    >>> d = cp.star_diagram(cp.Engine.preset("i6"), [0.5, 1.5, 3], mode_shape=shape)
    >>> d
    Inline-6: phase vectors, 4-stroke 1-5-3-6-2-4, even, 120°
    order      sum  share %  direction °
      0.5  0.41581      9.2         31.4  remains
      1.5     1.12     24.9            0  remains
        3      4.5    100.0            0  major
    >>> cp.star_diagram(cp.Engine.preset("i6")).major
    (3, 6, 9, 12)
    """
    engine_core(engine)
    firing = fires.firing(engine, firing_order, strokes)
    step = 2 if firing.strokes == 2 else 1
    if orders is None:
        whole_cycle = [
            inputs.order(0.5 * halves) for halves in range(step, 2 * HIGHEST_DRAWN + 1, step)
        ]
    else:
        whole_cycle = inputs.explicit_half_orders(orders)
    for order in whole_cycle:
        if 2 * order % step:
            hint = "the cycle of a two-stroke repeats in every turn; give whole orders"
            raise inputs.rejected("orders", order, hint)
    if len(set(whole_cycle)) < len(whole_cycle) or not whole_cycle:
        raise inputs.rejected("orders", whole_cycle, "give each order once, one at least")
    shape = np.ones(len(engine)) if mode_shape is None else inputs.vector("mode_shape", mode_shape)
    if shape.size != len(engine) or not np.isfinite(shape).all():
        hint = f"give a finite amplitude for each of the {len(engine)} cylinders"
        raise inputs.rejected("mode_shape", mode_shape, hint)
    return StarDiagram(firing, tuple(whole_cycle), tuple(shape.tolist()))
