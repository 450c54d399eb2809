"""Balance shafts that were fitted to an engine, and what stays."""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, optional
from crankpin._support.frozen import Listed
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.tables import Shown, Table, stacked
from crankpin.analysis.balance import UNIT_RPM, Balance, balance, over_square
from crankpin.analysis.balancing.fitted_shaft import FittedShaft
from crankpin.analysis.drawing import draw
from crankpin.model.shafts import degrees

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders
    from crankpin._support.tables import Label
    from crankpin.model.engine import Engine

SHAKEN = (*PLANE_VECTORS, "torque")
"""Quantities that shafts change."""


PARTS = {
    "force": (("forward", "forward"), ("backward", "backward")),
    "moment": (("forward", "forward"), ("backward", "backward")),
    "torque": (("", "phasor"),),
}
"""Quantity → name of each part and the attribute that reads it."""


class PairHeights(NamedTuple):
    """Places of a Lanchester pair that cancel the roll torque of its order.

    Two shafts at +n and −n with equal forces push together along one line. With *up* along that
    line and *right* to its right, their roll torque depends on how much higher the shaft that turns
    with the crank stands, and on the sum of the two distances to the right, and on nothing else.
    """

    order: int
    """Order of the pair."""
    difference: float
    """Height of the shaft that turns with the crank over the other, m."""
    right_sum: float
    """Sum of the distances of both to the right of the crank axis, m."""
    up_deg: float
    """Direction of *up*, degrees from +x in [0, 180): 90 for an upright inline engine."""


EQUAL = 1e-9
"""Relative difference up to which the forces of a pair are equal."""


def _is_a_pair(forces: Sequence[tuple[int, complex]]) -> bool:
    """Return whether shafts, as ratio and force, are one pair of opposite ratio and equal force."""
    if len(forces) != 2 or forces[0][0] != -forces[1][0]:
        return False
    sizes = [abs(force) for _, force in forces]
    return min(sizes) > 0.0 and max(sizes) - min(sizes) <= EQUAL * max(sizes)


class PartLeft(NamedTuple):
    """A part of a quantity of one order before shafts are fitted and after, over ω²."""

    order: int
    """Order."""
    quantity: str
    """``"force"``, ``"moment"`` or ``"torque"``."""
    part: str
    """``"forward"`` or ``"backward"``; empty for torque."""
    before: float
    """Size without the shafts, kg·m or kg·m²."""
    after: float
    """Size with them, kg·m or kg·m²."""


class BalanceShafts(Listed[FittedShaft], Shown):
    """Balance shafts fitted to an engine, and the engine with them.

    A sequence of :class:`~crankpin.types.FittedShaft`, in the order of the ratios given. Made by
    :func:`crankpin.balance_shafts`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> fit = cp.balance_shafts(v6, -2, x=0.1, y=0.05)
    >>> fit[0].order, fit[0].part, round(fit[0].removed_moment, 6)
    (2, 'backward', 0.00088)
    >>> float(fit.balance(rpm=6000, orders=[2])[2].moment.peak)
    0.0
    >>> fit.engine.with_shafts(v6.shafts) == v6
    True
    """

    _fields: ClassVar[tuple[str, ...]] = ("before", "shafts", "plane", "extra_torque")
    _items = "shafts"

    before: Engine
    """The engine as it was given."""
    shafts: tuple[FittedShaft, ...]
    """The shafts, in the order of the ratios given."""
    plane: float | None
    """The reference plane that was given, m, or None."""
    extra_torque: tuple[tuple[int, complex], ...]
    """Order and peak phasor over ω², kg·m², of torques besides those of inertia."""

    def __init__(
        self,
        before: Engine,
        shafts: tuple[FittedShaft, ...],
        plane: float | None,
        extra_torque: tuple[tuple[int, complex], ...],
    ) -> None:
        if not shafts or not all(isinstance(each, FittedShaft) for each in shafts):
            raise InputError(f"shafts = {inputs.shorten(shafts)}: use crankpin.balance_shafts")
        self._set(before=before, shafts=shafts, plane=plane, extra_torque=extra_torque)

    @cached_property
    def engine(self) -> Engine:
        """The engine with the shafts, added to those that it had."""
        return self.before.with_shafts([*self.before.shafts, *(each.shaft for each in self.shafts)])

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        return self.before.reference_z if self.plane is None else self.plane

    @property
    def orders(self) -> tuple[int, ...]:
        """Orders that the shafts act on, ascending."""
        return tuple(sorted({each.order for each in self.shafts}))

    @property
    def unbalance(self) -> float:
        """Sum of the amounts of all unbalances of the shafts, kg·m."""
        return sum(each.unbalance for each in self.shafts)

    @cached_property
    def heights(self) -> tuple[PairHeights, ...]:
        """Heights that cancel the roll torque of each order that has one pair: ±n, equal forces.

        ``extra_torque`` is counted. They do not depend on where the shafts of the fit are; at free
        places they are there.

        Examples
        --------
        >>> import crankpin as cp
        >>> (pair,) = cp.balance_shafts(cp.Engine.preset("i4"), [2, -2], x=0, y=0).heights
        >>> pair.order, round(pair.difference, 4), pair.right_sum, pair.up_deg
        (2, 0.1418, 0.0, 90.0)
        """
        found = []
        for order in self.orders:
            pair = [(each.shaft.ratio, each.makes.force) for each in self._of(order)]
            if _is_a_pair(pair):
                forces = dict(pair)
                torque = _core.roll_torque(self.before.core, order)
                torque += dict(self.extra_torque).get(order, 0j)
                *places, up = _core.pair_heights(forces[order], forces[-order], torque)
                found.append(PairHeights(order, *places, round(math.degrees(up), 13)))
        return tuple(found)

    def _of(self, order: int) -> list[FittedShaft]:
        return [each for each in self.shafts if each.order == order]

    def balance(self, rpm: float, *, orders: Orders = "auto", rtol: float | None = None) -> Balance:
        """Return what stays: the balance of the engine with the shafts.

        It includes the roll torque that the shafts' places make, not ``extra_torque``.

        Parameters
        ----------
        rpm
            Crank speed.
        orders, rtol
            As in :meth:`Engine.balance`.
        """
        found = balance(self.engine, rpm, orders=orders, rtol=rtol)
        return found if self.plane is None else found.about(self.plane)

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self) -> pd.DataFrame:
        """Return a tidy table, one row an unbalance (needs pandas).

        Columns are shaft (from 1), ratio, order, part, x, y, z (m), amount (kg·m) and angle_deg.
        """
        rows = [
            (
                number, each.shaft.ratio, each.order, each.part, each.shaft.x, each.shaft.y,
                weight.z, weight.amount, degrees(weight.angle_deg),
            )
            for number, each in enumerate(self.shafts, start=1)
            for weight in each.shaft.unbalances
        ]  # fmt: skip
        columns = ["shaft", "ratio", "order", "part", "x", "y", "z", "amount", "angle_deg"]
        return optional.data_frame(rows, columns=columns)

    def plot(self, ax: Axes | None = None, *, quantity: str | None = None, **style: object) -> Axes:
        """Draw a quantity with and without the shafts, part by part; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``, all over ω²; by default the moment, or else
            the first that is not zero.
        **style
            Passed on to the markers; ``label`` names the result in a legend.
        """
        return draw(self, ax, quantity=quantity, **style)  # type: ignore[no-any-return]

    @property
    def table(self) -> Table:
        """Tables that are shown: unbalances; below, shafts, and what stays of their orders."""
        return stacked(self._unbalances(), self._shafts(), self._stays())

    def _unbalances(self) -> Table:
        engine = labels.name_of(self.before)
        names: list[Label] = [
            [str(number), f"{each.shaft.ratio:+d}"]
            for number, each in enumerate(self.shafts, start=1)
            for _ in each.shaft.unbalances
        ]
        rows = [
            [each.shaft.x, each.shaft.y, weight.z, weight.amount, degrees(weight.angle_deg)]
            for each in self.shafts
            for weight in each.shaft.unbalances
        ]
        head = ["shaft", "ratio", "x m", "y m", "z m", "unbalance kg·m", "phase °"]
        return Table.from_rows(
            f"{labels.cut(engine)}: balance shafts", head, names, _array(rows, 5)
        )

    def _shafts(self) -> Table:
        names: list[Label] = [
            [str(number), str(each.order), each.part] for number, each in enumerate(self.shafts, 1)
        ]
        head = ["shaft", "order", "part", "force kg·m", "moment kg·m²"]
        rows = [[each.removed_force, each.removed_moment] for each in self.shafts]
        if all(each.bearings is not None for each in self.shafts):
            head += ["bearings m apart", "front load kg·m", "rear load kg·m"]
            for row, each in zip(rows, self.shafts, strict=True):
                assert each.length is not None  # noqa: S101 - its bearings are known
                row += [each.length, *np.abs(each.bearing_loads(UNIT_RPM)).tolist()]
        title = "What each shaft removes, and its bearing loads, over ω²"
        return Table.from_rows(title, head, names, _array(rows, len(head) - 3))

    def _stays(self) -> Table:
        parts = self.parts()
        names: list[Label] = [
            [
                str(each.order),
                f"{QUANTITIES[each.quantity].words}, {QUANTITIES[each.quantity].unit_over_square}",
                each.part,
            ]
            for each in parts
        ]
        rows = [[each.before, each.after] for each in parts]
        head = ["order", "quantity", "part", "before", "after"]
        return Table.from_rows("What stays, over ω²", head, names, _array(rows, 2))

    def parts(self) -> tuple[PartLeft, ...]:
        """Return the parts of force, moment and torque of the shafts' orders, before and after."""
        before, after = (
            over_square(each, self.orders, self.plane, torque=True)
            for each in (self.before, self.engine)
        )
        found = []
        for order, quantity in itertools.product(self.orders, SHAKEN):
            pair = [getattr(each[order], quantity) for each in (before, after)]
            for part, name in PARTS[quantity]:
                sizes = [float(abs(getattr(each, name))) for each in pair]
                found.append(PartLeft(order, quantity, part, *sizes))
        return tuple(found)


def _array(rows: list[list[float]], width: int) -> NDArray[np.float64]:
    return np.array(rows, dtype=np.float64).reshape(-1, width)
