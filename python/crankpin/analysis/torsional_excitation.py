"""Torque of each cylinder on the crank per order: what programs for torsional vibration take."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.contributions import contributions
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.engine import Engine

HIGHEST = 12
"""Highest order by default, as in the tables of classification societies."""


class TorsionalExcitation(Tabled):
    """Torque of each cylinder's gas and masses on the crank, per order.

    Made by :func:`crankpin.torsional_excitation`.
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed."""
    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    torque: NDArray[np.complex128]
    """Peak phasors of ``Re(P exp(ikθ))``, θ the engine's crank angle, N·m: (n_cylinders, n_orders).
    Positive torque drives the crank."""
    mean: NDArray[np.float64]
    """Mean torque of each cylinder, N·m: (n_cylinders,)."""

    @functools.cached_property
    def angular_frequency(self) -> NDArray[np.float64]:
        """Angular frequencies of the orders, rad/s: (n_orders,)."""
        omega = inputs.angular_speed(self.rpm)
        return read_only(np.array(self.orders, dtype=np.float64) * omega)

    @property
    def table(self) -> Table:
        """Amplitude and phase by cylinder and order."""
        frequency = self.angular_frequency.tolist()
        rows = [
            (number + 1, order, frequency[k], abs(phasor), math.atan2(phasor.imag, phasor.real))
            for number, phasors in enumerate(self.torque.tolist())
            for k, (order, phasor) in enumerate(zip(self.orders, phasors, strict=True))
        ]
        heads = ("cylinder", "order", ("frequency", "rad/s"), ("amplitude", "N·m"))
        name = labels.name_of(self.engine)
        title = f"TorsionalExcitation of {name}: torque on the crank, {self.rpm:.10g} rpm"
        return Table.from_rows(title, (*heads, ("phase", "rad")), rows, loads=self.loads_counted)

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.engine.loads_counted

    def to_dict(self) -> dict[str, Any]:
        """Return the excitation as plain lists.

        ``rpm``, ``loads`` in words, ``orders``, ``angular_frequency`` in rad/s; by cylinder
        ``mean`` in N·m and, with a list over orders in each, ``amplitude`` in N·m and ``phase`` in
        rad. openTorsion's ``PeriodicExcitation.add_sines`` takes them with the node of a cylinder.

        Returns
        -------
        dict
            Lists by name, as above.
        """
        return {
            "rpm": self.rpm,
            "loads": self.loads_counted,
            "orders": list(self.orders),
            "angular_frequency": self.angular_frequency.tolist(),
            "mean": self.mean.tolist(),
            "amplitude": np.abs(self.torque).tolist(),
            "phase": np.angle(self.torque).tolist(),
        }


def torsional_excitation(
    engine: Engine, rpm: float, *, orders: Order | Iterable[Order] | None = None
) -> TorsionalExcitation:
    """Return the torque of each cylinder on the crank per order, of gas and masses.

    Parameters
    ----------
    engine : Engine
        The engine, with or without cycles.
    rpm : float
        Crank speed, rpm.
    orders : number or sequence of numbers, optional
        Multiples of crank speed; by default up to 12, halves among them for a fired four-stroke.

    Returns
    -------
    TorsionalExcitation
        Phasors about the engine's crank angle, firing order included: their sums over cylinders
        are ``engine.balance(rpm).crank_torque``.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> i4 = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    >>> excitation = cp.torsional_excitation(i4, rpm=3000, orders=[0.5, 2])
    >>> abs(excitation.torque[:, 0]).round(1)
    array([99.2, 99.2, 99.2, 99.2])
    """
    engine_core(engine)
    cycles = engine.cycles
    listed = orders
    if listed is None:
        step = 1 if cycles is None or engine.strokes == 2 else 0.5
        listed = [step * k for k in range(1, round(HIGHEST / step) + 1)]
    balance = engine.balance(rpm, orders=inputs.explicit_half_orders(listed))
    parts = contributions(balance, "crank_torque")[: len(engine)]
    of_cylinders = zip(cycles or (), engine.cylinders, strict=False)
    means = [cycle.mean_torque(cylinder) if cycle else 0.0 for cycle, cylinder in of_cylinders]
    return TorsionalExcitation(
        engine,
        balance.rpm,
        balance.orders,
        np.concatenate([part.phasors for part in parts]),
        np.array(means or [0.0] * len(parts)),
    )
