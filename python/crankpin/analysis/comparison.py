"""Two engines beside each other, order by order: before and after a change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.parameters import documented
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import Balance, balance
from crankpin.analysis.quantity import ALL
from crankpin.analysis.request import ENGINE_HINT, engine_core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders, Spectrum
    from crankpin.model.engine import Engine


NO_CHANGE = 1e-12
"""Changes below this part of a peak are those of rounding in sums of all cylinders."""
LUMPED: Final = "lumped"
"""Stands for an engine as textbooks lump it."""


@documented()
def compare(
    before: Engine,
    after: Engine | Literal["lumped"],
    rpm: float,
    *,
    orders: Orders = "auto",
    rtol: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
) -> Comparison:
    """Return the balances of two engines at one speed and at the same orders.

    Parameters
    ----------
    before : Engine
        The engine before a change, or any.
    after : Engine or "lumped"
        The engine after it, or any other. ``"lumped"`` is ``before`` as textbooks lump it, the
        e-book among them: what rotates with a crankpin moves along the bore, with the piston, which
        reproduces their tables.
    rpm : float
        Crank speed, rpm.
    orders : number, sequence of numbers or "auto", default "auto"
        Multiples of crank speed, whole or half; by default all that either engine needs to reach
        ``rtol``.
    spectrum : mapping of int to complex, optional
        … Moments of each engine are about its own reference plane.
    torque : bool, default True
        …; an engine that is lumped has none.

    Returns
    -------
    Comparison
        Both balances, at the same orders.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> c = cp.compare(v6, v6.with_bank_angle(90, hold="pins"), rpm=6000, orders=[1, 2])
    >>> c.change("moment").round(3)
    array([0.577, 0.414])
    """
    options: dict[str, Any] = {"rtol": rtol, "spectrum": spectrum, "torque": torque}
    engine_core(before, "before")
    if isinstance(after, str):
        name: str = after  # as callers without types give it
        if name != LUMPED:
            meant = inputs.nearest(name, (LUMPED,))
            raise inputs.rejected("after", name, f'{ENGINE_HINT}, or "{LUMPED}"{meant}')
        if spectrum is not None:
            raise inputs.rejected("spectrum", spectrum, 'is that of "lumped" itself; leave it out')
        options["torque"] = False  # which a spectrum does not determine
        first = balance(before, rpm, orders=orders, **options)
        after, options["spectrum"] = _lumped(before, int(max((1, *first.orders))))
    else:
        engine_core(after, "after")
        first = balance(before, rpm, orders=orders, **options)
    second = balance(after, rpm, orders=orders, **options)
    both = tuple(sorted({*first.orders, *second.orders}))
    if both:
        first, second = first._at_orders(both), second._at_orders(both)
    return Comparison(first, second)


def _lumped(engine: Engine, highest: int) -> tuple[Engine, Spectrum]:
    """Return an engine without rotating masses, and a cylinder's spectrum with them in order 1.

    Up to the highest order that the engine itself needs: above the first both have the same.
    """
    kinds = set(zip(engine.cylinders, engine.rotating_mass.tolist(), strict=True))
    if len(kinds) > 1:
        raise inputs.faulty("before", "has cylinders that differ", "lump one whose are equal")
    ((cylinder, rotating),) = kinds
    orders = range(1, highest + 1)
    moving = cylinder.reciprocating_mass * np.asarray(cylinder.harmonics(list(orders)))
    moving[0] += rotating
    spectrum = dict(zip(orders, (cylinder.crank_radius * moving).tolist(), strict=True))
    return engine.replace(rotating_mass=0.0, name=f"{engine.name}, lumped"), spectrum


class Comparison(Tabled):
    """Two balances at the same speed and orders.

    Made by :func:`crankpin.compare`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4 = cp.Engine.preset("i4")
    >>> shafts = [
    ...     cp.Shaft(ratio, [cp.Unbalance(0.0029, z=0.15, angle_deg=-90)], x=x)
    ...     for ratio, x in [(2, 0.08), (-2, -0.08)]
    ... ]
    >>> cp.compare(i4, i4.with_shafts(shafts), rpm=6000, orders=[2, 4])
    Inline-4 → Inline-4 with 2 balance shafts at 6000 rpm: peaks
    quantity          order  before   after  change %
    shaking force, N      2  9269.4  110.41   -98.809
    shaking force, N      4  213.27  213.27         0
    shaking force, N    all  9482.7  323.68   -96.587
    roll torque, N·m      2  657.31  657.31         0
    roll torque, N·m      4  30.216  30.216         0
    roll torque, N·m    all  660.06  660.06         0
    Without gas pressure.
    """

    before: Balance
    """Balance of the engine before the change."""
    after: Balance
    """Balance of the engine after the change."""

    def __post_init__(self) -> None:
        for name, state in (("before", self.before), ("after", self.after)):
            if not isinstance(state, Balance):
                raise inputs.rejected(name, state, "use crankpin.compare")
        if self.before.orders != self.after.orders or self.before.rpm != self.after.rpm:
            fault = "is at different orders or speeds than before"
            raise inputs.faulty("after", fault, "use crankpin.compare")

    @property
    def rpm(self) -> float:
        """Crank speed, rpm."""
        return self.before.rpm

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.before.orders

    def change(self, quantity: str = "moment") -> NDArray[np.float64]:
        """Return how the peak of each order changes, relative to that before: (n_orders,).

        −1 where it vanishes, 0 where it stays, inf where it was zero.

        Parameters
        ----------
        quantity : str, default "moment"
            ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``.

        Returns
        -------
        ndarray of float, shape (n_orders,)
            Relative changes, without unit.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        return read_only(change_of(*self._peaks(quantity)))

    def _shown_orders(self, quantity: str) -> list[int]:
        """Return places of the orders that tables and pictures show: those that are not negligible.

        Parameters
        ----------
        quantity
            ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``.
        """
        before, after = self._peaks(quantity)
        peaks = np.maximum(before, after)
        places: list[int] = np.flatnonzero(
            peaks > labels.NEGLIGIBLE * peaks.max(initial=0.0)
        ).tolist()
        return places

    def _peaks(self, quantity: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        name = inputs.one_of("quantity", quantity, QUANTITIES)
        return getattr(self.before, name).peak, getattr(self.after, name).peak

    @property
    def table(self) -> Table:
        """Table that is shown: the peak of each quantity and order before and after, and of all."""
        texts: list[tuple[str, Order | str]] = []
        rows, row_units = [], list[str]()
        for name in self.before._request.quantities:
            if name == "crank_torque":
                continue
            kind = QUANTITIES[name]
            before, after = self._peaks(name)
            change = 100.0 * self.change(name)
            places = self._shown_orders(name)
            head = units.headed(kind.words, kind.unit)
            texts += [(head, self.orders[k]) for k in places]
            rows += [(before[k], after[k], change[k]) for k in places]
            row_units += [kind.unit] * (len(places) + (len(places) > 1))
            if len(places) > 1:
                total = [getattr(balance.total, name).peak for balance in (self.before, self.after)]
                texts.append((head, ALL))
                rows.append((*total, 100.0 * change_of(*map(np.asarray, total))))
        title = f"{self.title} at {self.rpm:g} rpm: peaks"
        header = ["quantity", "order", "before", "after", "change %"]
        numbers = np.array(rows).reshape(-1, 3)
        numbers[~np.isfinite(numbers)] = np.nan  # relative to nothing
        return Table.from_rows(
            title,
            [*header[:-1], ("change", "%")],
            texts,
            numbers,
            loads=self.loads_counted,
            row_units=row_units,
        )

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as :attr:`Balance.loads_counted`."""
        gas = labels.loads_of([self.before.engine, self.after.engine], ["before", "after"])
        return self.before._request.loads_counted(gas)

    @property
    def names(self) -> tuple[str, str]:
        """Names of the engines; ``"before"`` and ``"after"`` if they have one name."""
        first, second = (labels.name_of(balance.engine) for balance in (self.before, self.after))
        return (first, second) if first != second else ("before", "after")

    @property
    def title(self) -> str:
        """Names of the engines, or the one they have."""
        engine = self.before.engine
        if self.names == ("before", "after"):
            return labels.name_of(engine)
        return " → ".join(self.names)


def change_of(before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the change relative to what was before: 0 where they differ by rounding alone."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = (after - before) / before
    return np.where(np.abs(after - before) <= NO_CHANGE * before, 0.0, change)
