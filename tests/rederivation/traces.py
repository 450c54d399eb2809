"""Measured cycles again: plain sums over their points. Imports nothing of crankpin.

Angles are degrees from the firing top dead centre, on an even grid of one period; ``crank`` is
crank radius, rod length and pin offset, m.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rederivation.pressure import height, slope

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Crank = tuple[float, float, float]


def travel(crank: Crank) -> float:
    """Return the way of the piston between its ends, whose crank and rod are in line."""
    r, rod, e = crank
    return float(np.sqrt((rod + r) ** 2 - e**2) - np.sqrt((rod - r) ** 2 - e**2))


def imep(theta: Array, pressure: Array, crank: Crank) -> Array:
    """Return −∮p dx over the travel, by trapezes over the piston's way; a row for each cycle."""
    x = height(np.radians(np.append(theta, theta[0])), *crank)
    closed = np.column_stack([pressure, pressure[:, :1]])
    return np.asarray(-np.trapezoid(closed, x, axis=1) / travel(crank))


def cov(values: Array) -> float:
    """Return the deviation over the mean, of n − 1 differences."""
    mean = values.sum() / len(values)
    return float(np.sqrt(((values - mean) ** 2).sum() / (len(values) - 1)) / mean)


def torque_phasors(
    theta: Array, pressure: Array, orders: Sequence[float], crank: Crank, bore: float
) -> NDArray[np.complex128]:
    """Return peak phasors of −(p − 101325)·A·dx/dθ, sums over the points."""
    angle = np.radians(theta)
    torque = -(pressure - 101325.0) * np.pi / 4 * bore**2 * slope(angle, *crank)
    return np.array(2.0 / len(theta) * torque @ np.exp(-1j * np.outer(angle, orders)))


def noise_of_phasors(noise: float, theta: Array, crank: Crank, bore: float) -> float:
    """Return the deviation in the plane of a torque phasor from white noise of a deviation.

    Its parts are sums of independent numbers: their variances add.
    """
    weights = np.pi / 4 * bore**2 * slope(np.radians(theta), *crank)
    return float(2.0 / len(theta) * noise * np.sqrt((weights**2).sum()))
