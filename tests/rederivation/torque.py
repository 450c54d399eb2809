"""Gas torque of engines again: forces on crankpin, wall, head and bearing, and firing by walking.

Plain NumPy; imports nothing of crankpin. In the frame of a bore x points from the crank to the head
and y to the side to which the crankpin swings after top dead centre. Angles are degrees.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Array = NDArray[np.float64]
Crank = tuple[float, float, float]
"""Radius, rod length, and offset of the wrist pin's path, m."""


def forces(theta_deg: Array, gauge: Array, bore: float, crank: Crank) -> Array:
    """Return torque on the crank, torque on the block, and the net force on it: (4, n).

    Of gas alone, without masses: the rod carries what balances the gas force along the bore, the
    wall what balances the rod across it.
    """
    r, length, e = crank
    theta = np.radians(theta_deg)
    pin = np.stack([r * np.cos(theta), r * np.sin(theta)])
    wrist = np.stack([pin[0] + np.sqrt(length**2 - (pin[1] - e) ** 2), np.full_like(theta, e)])
    direction = (pin - wrist) / length
    gas = gauge * np.pi / 4.0 * bore**2
    on_pin = -gas / direction[0] * direction
    on_crank = pin[0] * on_pin[1] - pin[1] * on_pin[0]
    # The piston pushes the wall with what the rod has across the bore, reversed; the bearing takes
    # the crankpin's force on the axis, and the head the gas force at y = e.
    on_wall = -on_pin[1]
    on_block = wrist[0] * on_wall - e * gas
    return np.stack([on_crank, on_block, gas + on_pin[0], on_wall + on_pin[1]])


def firing_deg(tdc_deg: Sequence[float], order: Sequence[int]) -> list[float]:
    """Return when each cylinder fires: at its next top dead centre after the one before it."""
    angles = [0.0] * len(order)
    now = tdc_deg[order[0] - 1]
    for number in order:
        now += (tdc_deg[number - 1] - now) % 360.0
        angles[number - 1] = now
    return [angle % 720.0 for angle in angles]


def phasors(torque: Array, orders: Sequence[float]) -> NDArray[np.complex128]:
    """Return peak phasors of samples at equal steps over 720°, without the end."""
    theta = np.radians(np.arange(len(torque)) * 720.0 / len(torque))
    return np.array([2.0 * np.mean(torque * np.exp(-1j * n * theta)) for n in orders])


def engine_torque(
    theta_deg: Array,
    cylinders: Sequence[tuple[float, Callable[[Array], Array], float, Crank]],
    crankcase: float,
) -> tuple[Array, Array]:
    """Return the torque of all cylinders on crank and block: each fires at its angle.

    ``cylinders`` are firing angle, pressure over degrees after firing, bore and crank.
    """
    sums = np.zeros((4, len(theta_deg)))
    for fires, pressure, bore, crank in cylinders:
        after = theta_deg - fires
        sums += forces(after, pressure(after) - crankcase, bore, crank)
    return sums[0], sums[1]
