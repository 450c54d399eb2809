"""Balance shafts fitted to an engine, and the residual."""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import Hint
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import Listed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import Balance, balance
from crankpin.analysis.bearings import on_shaft_bearings
from crankpin.analysis.request import engine_core
from crankpin.model.loads import of_speed_squared
from crankpin.model.shafts import Shaft

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.balancing.planes import Turning
    from crankpin.model.engine import Engine

SHAKEN = ("force", "moment", "torque")
"""Quantities that shafts change."""
EQUAL_FORCES = 1e-9
"""Relative difference up to which the forces of a pair are equal."""


class Part(NamedTuple):
    """A part of a quantity of one order before shafts are fitted and after, over ω²."""

    order: Order
    quantity: str
    part: str
    """``"forward"`` or ``"backward"``; empty for torque."""
    before: float
    after: float


class BalanceShafts(Listed[Shaft], Tabled):
    """Balance shafts fitted to an engine.

    A sequence of :class:`~crankpin.Shaft`, in the order of the ratios given. Made by
    :func:`crankpin.balance_shafts`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> fit = cp.balance_shafts(v6, -2, x=0.1, y=0.05)
    >>> fit[0].ratio, float(abs(fit.exerted_moment[0]).round(6))
    (-2, 0.00088)
    >>> float(fit.residual[2].moment.peak)
    0.0
    >>> fit.fitted.with_shafts(v6.shafts) == v6
    True
    """

    _items, _item, _maker = "hardware", Shaft, "crankpin.balance_shafts"

    engine: Engine
    """The engine to be balanced."""
    hardware: tuple[Shaft, ...]
    """The shafts, in the order of the ratios given."""
    exerts: tuple[Turning, ...]
    """Force and moment of each shaft, over ω²."""
    bearings: tuple[tuple[float, float] | None, ...]
    """Places of the two bearings of each, front first, m; None if they are not known."""
    rpm: float | None
    """Crank speed that was given; a fired engine's shafts cancel its roll torque at it."""

    @cached_property
    def fitted(self) -> Engine:
        """The engine with the shafts, added to those that it has."""
        return self.engine.with_shafts([*self.engine.shafts, *self.hardware])

    @property
    def orders(self) -> tuple[Order, ...]:
        """Orders that the shafts act on, ascending."""
        return tuple(sorted({abs(shaft.ratio) for shaft in self.hardware}))

    @property
    def unbalance(self) -> float:
        """Sum of the amounts of all unbalances of the shafts, kg·m."""
        return math.fsum(weight.amount for shaft in self.hardware for weight in shaft.unbalances)

    @property
    def exerted_force(self) -> NDArray[np.complex128]:
        """Force that each shaft exerts, over ω²: x + iy at θ = 0, kg·m, (n_shafts,)."""
        return read_only(np.array([force.force for force in self.exerts]))

    @property
    def exerted_moment(self) -> NDArray[np.complex128]:
        """Moment that each shaft exerts, over ω²: x + iy at θ = 0, kg·m², (n_shafts,)."""
        return read_only(np.array([force.moment for force in self.exerts]))

    @cached_property
    def residual(self) -> Balance:
        """Residual of the shafts' orders at ``rpm``; without it over ω²: at 1 rad/s, N are kg·m.

        It includes the roll torque that the shafts' places make, and that of gas pressure.
        """
        return self._of(self.fitted)

    def _of(self, engine: Engine) -> Balance:
        if self.rpm is None:  # The fit rejects other loads of these orders.
            return balance(of_speed_squared(engine), labels.UNIT_RPM, orders=self.orders)
        return balance(engine, self.rpm, orders=self.orders)

    @cached_property
    def heights(self) -> Mapping[Order, Mapping[str, float]]:
        """Order → places of its one pair, ±n with equal forces, that cancel its roll torque.

        A pair pushes along one line. With *up* along that line, its roll torque depends on the
        ``"difference"``, how much higher the shaft that turns with the crank stands than the other,
        and on ``"right_sum"``, the sum of the distances of both to the right of the crank axis, m;
        ``"up_deg"`` is the direction of *up* from +x in [0°, 180°). Gas pressure is counted, at
        ``rpm``. They do not depend on where the shafts of the fit are; at free places they are
        there.

        Examples
        --------
        >>> import crankpin as cp
        >>> pair = cp.balance_shafts(cp.Engine.preset("i4"), [2, -2], x=0, y=0).heights[2]
        >>> round(pair["difference"], 4), pair["right_sum"], pair["up_deg"]
        (0.1418, 0.0, 90.0)
        """
        heights = {}
        for order in self.orders:
            pair = [
                (shaft.ratio, force.force)
                for shaft, force in zip(self.hardware, self.exerts, strict=True)
                if abs(shaft.ratio) == order
            ]
            if _is_a_pair(pair):
                forces = dict(pair)
                torque = _core.roll_torque(self.engine._core, order, self.rpm)
                difference, right, up = _core.pair_heights(forces[order], forces[-order], torque)
                up_deg = round(math.degrees(up), 13)
                heights[order] = {"difference": difference, "right_sum": right, "up_deg": up_deg}
        return read_only(heights)

    def bearing_loads(self, rpm: float) -> NDArray[np.complex128]:
        """Return the loads on the two bearings of each shaft at θ = 0, front first.

        Forces of the unbalances on the bearings, shared by the lever rule, without weight and
        drive: each keeps its size and turns with the shaft.

        Parameters
        ----------
        rpm : float
            Crank speed, rpm.

        Returns
        -------
        ndarray of complex, shape (n_shafts, 2)
            x + iy, N.

        Raises
        ------
        InputError
            If bearings are not known, or the speed is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> fit = cp.balance_shafts(cp.Engine.preset("i3"), -1, bearings=(0.0, 0.3))
        >>> abs(fit.bearing_loads(rpm=6000)).round(1)
        array([[2205.2, 2205.2]])
        """
        loads = []
        for shaft, bearings in zip(self.hardware, self.bearings, strict=True):
            if bearings is None:
                hint = Hint.of("give `bearings=(z_front, z_rear)` to balance_shafts")
                raise inputs.rejected("bearings", None, hint)
            loads.append(on_shaft_bearings(shaft, *bearings, rpm))
        return read_only(np.array(loads))

    # --- tables and pictures --------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Unbalances of the shafts."""
        heads = ("shaft", "ratio", ("x", "m"), ("y", "m"), ("z", "m"), ("unbalance", "kg·m"))
        rows = [
            (
                f"{k}", f"{shaft.ratio:+g}", shaft.x, shaft.y, weight.z, weight.amount,
                inputs.degrees(weight.angle_deg),
            )
            for k, shaft in enumerate(self.hardware, 1)
            for weight in shaft.unbalances
        ]  # fmt: skip
        note = ""
        if self.engine.fired and self.rpm is not None:
            note = (
                f"Places count the torque of gas pressure at {self.rpm:g} rpm: it does not scale "
                "with the square of the speed as the shafts' torques do."
            )
        if inside := self._inside():
            numbers = ", ".join(map(str, inside))
            note = f"{note} Inside the crank: shaft {numbers}; x= and y= place it beside.".strip()
        title = f"{labels.cut(labels.name_of(self.engine))}: balance shafts"
        return Table.from_rows(title, (*heads, ("phase", "°")), rows, note=note)

    def _inside(self) -> list[int]:
        """Return the numbers of the shafts whose axes are within the throws of a crank."""
        core = engine_core(self.engine)
        radius = core.largest_crank_radius
        return [
            number
            for number, shaft in enumerate(self.hardware, 1)
            if any(math.hypot(shaft.x - x, shaft.y - y) < radius for x, y, _ in core.cranks[0])
        ]

    @property
    def frames(self) -> Frames:
        """``table``; ``shafts``: what each removes, and its bearing loads; ``residual``."""
        return self._frames(shafts=self._loads, residual=self._stays)

    def _loads(self) -> Table:
        columns = [
            Column("shaft", tuple(str(k) for k in range(1, len(self) + 1))),
            Column("order", tuple(str(abs(shaft.ratio)) for shaft in self.hardware)),
            Column(
                "part",
                tuple("forward" if shaft.ratio > 0 else "backward" for shaft in self.hardware),
            ),
            Column("force", abs(self.exerted_force), "kg·m"),
            Column("moment", abs(self.exerted_moment), "kg·m²"),
        ]
        supported = [pair for pair in self.bearings if pair is not None]
        if len(supported) == len(self):
            front, rear = abs(self.bearing_loads(labels.UNIT_RPM)).T.tolist()
            columns += [
                Column("bearings apart", tuple(b - a for a, b in supported), "m"),
                Column("front load", tuple(front), "kg·m"),
                Column("rear load", tuple(rear), "kg·m"),
            ]
        title = "What each shaft removes, and its bearing loads, over ω²"
        return Table(title, tuple(columns))

    def _stays(self) -> Table:
        rows = []
        for part in self.parts():
            kind = QUANTITIES[part.quantity]
            quantity = units.headed(kind.words, kind.unit_over_square)
            rows.append((str(part.order), quantity, part.part, part.before, part.after))
        heads = ["order", "quantity", "part", "before", "after"]
        row_units = [QUANTITIES[part.quantity].unit_over_square for part in self.parts()]
        return Table.from_rows("Residual, over ω²", heads, rows, row_units=row_units)

    def parts(self) -> tuple[Part, ...]:
        """Return the parts of force, moment and torque of the shafts' orders, before and after.

        Returns
        -------
        tuple of Part
            Order, quantity and part, and its size before and after, over ω².
        """
        states = (self._of(self.engine), self.residual)
        square = inputs.angular_speed(states[0].rpm) ** 2
        parts = []
        for order, quantity in itertools.product(self.orders, SHAKEN):
            pair = [getattr(state[order], quantity) for state in states]
            planar = QUANTITIES[quantity].planar
            for part in ("forward", "backward") if planar else ("",):
                sizes = [
                    float(abs(getattr(reading, part or "phasor"))) / square for reading in pair
                ]
                parts.append(Part(order, quantity, part, *sizes))
        return tuple(parts)


def _is_a_pair(forces: list[tuple[Order, complex]]) -> bool:
    """Return whether shafts, as ratio and force, are one pair of opposite ratio and equal force."""
    if len(forces) != 2 or forces[0][0] != -forces[1][0]:
        return False
    sizes = [abs(force) for _, force in forces]
    return min(sizes) > 0.0 and max(sizes) - min(sizes) <= EQUAL_FORCES * max(sizes)
