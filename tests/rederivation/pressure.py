"""Gas torque again: pressure × area × dV/dθ by dense quadrature of an explicit slider-crank.

Plain NumPy and SciPy; imports nothing of crankpin. Angles are radians here, from the firing top
dead centre; x is the piston pin's distance from the crank's axis.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

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


def chamber(theta: Array, compression_ratio: float, crank: tuple[float, float, float]) -> Array:
    """Return V/V_c, from the piston's way down and its travel."""
    r, rod, e = crank
    highest = np.sqrt((rod + r) ** 2 - e**2)
    travel = highest - np.sqrt((rod - r) ** 2 - e**2)
    volumes: Array = 1.0 + (compression_ratio - 1.0) * (highest - height(theta, *crank)) / travel
    return volumes


def dual_work(
    displacement: float,
    compression_ratio: float,
    pressure_ratio: float,
    cutoff_ratio: float,
    exponents: tuple[float, float],
    pressures: tuple[float, float],
    strokes: int,
) -> float:
    """Work of the dual cycle from its corners: ∫p dV of p·Vⁿ = constant, and of constant p."""
    n_c, n_e = exponents
    intake, exhaust = pressures
    clearance = displacement / (compression_ratio - 1.0)
    v1 = clearance * compression_ratio
    p3 = intake * compression_ratio**n_c * pressure_ratio
    v3 = cutoff_ratio * clearance
    p4 = p3 * (v3 / v1) ** n_e
    p2 = intake * compression_ratio**n_c
    work = (p3 * v3 - p4 * v1) / (n_e - 1.0) + p3 * (v3 - clearance)
    work -= (p2 * clearance - intake * v1) / (n_c - 1.0)
    return float(work + (intake - exhaust) * displacement if strokes == 4 else work)


def wiebe(
    figures: dict[str, float], crank: tuple[float, float, float], bore: float
) -> tuple[Callable[[Array], Array], float, float]:
    """Single zone by ``solve_ivp``: dp/dθ = (γ−1)/V·(Q_b′ − Q_w′) − γ·p·V′/V.

    Returns pressure between intake closing and exhaust opening, heat released and heat lost, J.
    """
    from scipy.integrate import solve_ivp

    f = figures
    r, rod, e = crank
    travel = np.sqrt((rod + r) ** 2 - e**2) - np.sqrt((rod - r) ** 2 - e**2)
    area = np.pi / 4 * bore**2
    clearance = area * travel / (f["compression_ratio"] - 1.0)
    closes, opens = np.radians([f["intake_closes_deg"], f["exhaust_opens_deg"]])
    start, duration = np.radians([f["start_deg"], f["duration_deg"]])
    gamma, p0, t0 = f["gamma"], f["intake_pressure"], f["charge_temperature"]

    def volume(theta: Any) -> Any:  # noqa: ANN401 - an angle or an array of them
        return clearance * chamber(theta, f["compression_ratio"], crank)

    v0 = volume(closes)

    def slopes(theta: Any, state: Array) -> list[float]:  # noqa: ANN401 - an angle
        p = state[0]
        v, dv = volume(theta), -area * slope(theta, *crank)
        y = (theta - start) / duration
        burning = 0.0 <= y <= 1.0
        rate = (
            f["a"] * (f["m"] + 1) * y ** f["m"] * np.exp(-f["a"] * y ** (f["m"] + 1))
            if burning
            else 0.0
        )
        burnt = f["heat"] * rate / duration
        lost = 0.0
        if "wall_temperature" in f:
            temperature = t0 * p * v / (p0 * v0)
            motored = p0 * (v0 / v) ** gamma
            speed = 2 * travel * f["rpm"] / 60.0
            w = 2.28 * speed
            if theta > start:
                w += 3.24e-3 * area * travel * t0 / (p0 * v0) * max(p - motored, 0.0)
            h = 3.26 * bore**-0.2 * (p / 1e3) ** 0.8 * temperature**-0.55 * w**0.8
            surface = 2 * area + np.pi * bore * v / area
            lost = h * surface * (temperature - f["wall_temperature"]) / (2 * np.pi * f["rpm"] / 60)
        return [(gamma - 1) / v * (burnt - lost) - gamma * p * dv / v, burnt, lost]

    # Pressure bends where the burn begins and ends: a solution for each part.
    edges = [closes, start, start + duration, opens]
    state: Any = [p0, 0.0, 0.0]
    parts: list[Any] = []
    for low, high in itertools.pairwise(edges):
        inside = (low + 1e-13, high - 1e-13)
        options: dict[str, Any] = {
            "method": "DOP853",
            "rtol": 1e-12,
            "atol": 1e-9,
            "dense_output": True,
        }
        found = solve_ivp(slopes, inside, state, **options)
        state = found.y[:, -1]
        parts.append(found.sol)

    def pressure(theta: Array) -> Array:
        place = np.clip(np.searchsorted(edges, theta) - 1, 0, 2)
        return np.array([parts[k](angle)[0] for k, angle in zip(place, theta, strict=True)])

    return pressure, float(state[1]), float(state[2])
