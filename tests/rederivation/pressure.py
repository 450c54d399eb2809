"""Gas torque again: pressure × area × dV/dθ by dense quadrature of an explicit slider-crank.

Plain NumPy and SciPy; imports nothing of crankpin. Angles are radians here, from the firing top
dead centre; x is the piston pin's distance from the crank's axis.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def height(theta: Array, r: float, l: float, e: float = 0.0) -> Array:  # noqa: E741 - as in papers
    """Return r cos θ + √(l² − (r sin θ − e)²)."""
    return r * np.cos(theta) + np.sqrt(l**2 - (r * np.sin(theta) - e) ** 2)


def slope(theta: Array, r: float, l: float, e: float = 0.0) -> Array:  # noqa: E741 - as in papers
    """Return dx/dθ."""
    u = r * np.sin(theta) - e
    return -r * np.sin(theta) - u * r * np.cos(theta) / np.sqrt(l**2 - u**2)


def torque_phasors(
    pressure: Callable[[Array], Array],
    edges: Array,
    orders: Array,
    bore: float,
    crank: tuple[float, float, float],
    crankcase: float,
) -> tuple[float, NDArray[np.complex128]]:
    """Mean and peak phasors of −(p − p_c)·A·dx/dθ, by 40-point Gauss rules of parts of 2°.

    Pressure is smooth between the edges, which cover one period.
    """
    x, w = np.polynomial.legendre.leggauss(40)
    mean, sums = 0.0, np.zeros(len(orders), dtype=complex)
    for a, b in itertools.pairwise(edges):
        parts = np.linspace(a, b, max(2, int(np.ceil((b - a) / np.radians(2.0)))) + 1)
        for low, high in itertools.pairwise(parts):
            theta = 0.5 * (low + high) + 0.5 * (high - low) * x
            torque = -(pressure(theta) - crankcase) * np.pi / 4 * bore**2 * slope(theta, *crank)
            weighted = 0.5 * (high - low) * w * torque
            mean += weighted.sum()
            sums += (weighted * np.exp(-1j * np.outer(orders, theta))).sum(axis=1)
    period = edges[-1] - edges[0]
    return mean / period, sums * 2.0 / period
