"""Which crank shakes least? By trying all of them on a grid of bank angles, in plain NumPy.

Time domain: at each crank angle every piston's inertia force of an order acts along its bore, and
half of its mass, as a bob weight, turns opposite its crankpin where counterweights are allowed.
Unit m·r·ω² and unit spacing; a2 is the second harmonic.
"""

from __future__ import annotations

from itertools import permutations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
THETA = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)


def couple(
    throws_deg: Array,
    bank_angle_deg: float | None,
    order: int,
    *,
    split_deg: float = 0.0,
    counterweights: bool = False,
    lever: bool = True,
) -> float:
    """Longest couple of an order over crank angle; with lever=False the longest force."""
    throws = np.radians(throws_deg)
    z = np.arange(len(throws)) - (len(throws) - 1) / 2 if lever else np.ones(len(throws))
    if bank_angle_deg is None:
        banks = [(np.pi / 2, 0.0)]
    else:
        half = np.radians(bank_angle_deg) / 2
        banks = [(np.pi / 2 - half, 0.0), (np.pi / 2 + half, np.radians(split_deg))]
    total = np.zeros(len(THETA), dtype=complex)
    for bore, behind in banks:
        for throw, arm in zip(throws, z, strict=True):
            pin = throw + behind
            from_top = THETA - (bore - pin)
            total += arm * np.cos(order * from_top) * np.exp(1j * bore)
            if counterweights and order == 1:
                total -= arm * 0.5 * np.exp(1j * (pin + THETA))
    return float(np.abs(total).max())


class Best(NamedTuple):
    """What is least, and where."""

    value: float
    throws_deg: tuple[float, ...]
    bank_angle_deg: float


def least(
    throws_deg: list[float],
    bank_angles_deg: list[float],
    orders: list[int],
    *,
    counterweights: bool,
) -> Best:
    """Least couples of some orders, the first first, over all orders of the throws."""
    first, *rest = throws_deg
    found = []
    for order_of_throws in permutations(rest):
        throws = np.array([first, *order_of_throws])
        for angle in bank_angles_deg:
            values = tuple(
                round(couple(throws, angle, n, counterweights=counterweights), 9) for n in orders
            )
            found.append((values, tuple(throws.tolist()), angle))
    values, best, angle = min(found)
    return Best(values[0], best, angle)
