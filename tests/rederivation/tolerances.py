"""What do deviating masses, radii, angles, places and rods leave of an engine's balance?

All samples at once in NumPy: arrays of deviations are (samples, cylinders). Slider-cranks without
offset, rods as two masses. The harmonics follow from |1 + p^2 e^{2i theta}|: where r/l is
2p/(1 + p^2), sqrt(1 - (r/l)^2 sin^2 theta) is that over 1 + p^2, and each of its two factors is a
binomial series.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

NEWTON_STEPS = 5
GRID_PER_WAVE = 16
TOPS = 3
"""Local maxima of a grid that are polished: the highest of the grid may not be the highest."""


@dataclass(frozen=True)
class Nominal:
    """An engine: arrays over its cylinders; SI units, angles in degrees."""

    crank_radius: Array
    rod_length: Array
    reciprocating_mass: Array
    rotating_mass: Array
    tdc_deg: Array
    bank_deg: Array
    z: Array


@dataclass(frozen=True)
class Remains:
    """Peak phasors (samples, orders), and peaks of all orders together (samples,)."""

    force_forward: Complex
    force_backward: Complex
    moment_forward: Complex
    moment_backward: Complex
    roll: Complex
    force_peak: Array
    moment_peak: Array
    roll_peak: Array


def normal_draws(
    nominal: Nominal, spreads: Mapping[str, float], samples: int, seed: int
) -> dict[str, Array]:
    """Independent normal deviations of every figure of every cylinder."""
    random = np.random.default_rng(seed)
    shape = (samples, len(nominal.z))
    return {name: random.normal(0.0, spread, shape) for name, spread in spreads.items()}


def remains(
    nominal: Nominal,
    draws: Mapping[str, Array],
    rpm: float,
    orders: Sequence[int],
    reference_z: float,
) -> Remains:
    """Balance of every sample."""
    figures = {
        name: getattr(nominal, name) + draws.get(name, 0.0)
        for name in ("crank_radius", "rod_length", "reciprocating_mass", "rotating_mass", "z")
    }
    turned = np.exp(1j * np.deg2rad(np.asarray(draws.get("pin_deg", np.zeros((1, 1))))))
    radius, lever = figures["crank_radius"], figures["z"] - reference_z
    square = (2.0 * np.pi * rpm / 60.0) ** 2
    first_order = square * figures["reciprocating_mass"] * radius
    along, roll = harmonics(radius / figures["rod_length"], orders)
    bank, tdc = np.deg2rad(nominal.bank_deg), np.deg2rad(nominal.tdc_deg)
    sums: list[list[Complex]] = [[] for _ in range(5)]
    for k, n in enumerate(orders):
        of_pin = turned**n
        piston = first_order * along[k] * of_pin
        forward = 0.5 * np.exp(1j * (bank - n * tdc)) * piston
        backward = 0.5 * np.exp(1j * (bank + n * tdc)) * piston.conj()
        if n == 1:
            pin = np.exp(1j * (bank - tdc)) * turned
            forward = forward + square * figures["rotating_mass"] * radius * pin
        torque = first_order * radius * of_pin * np.exp(-1j * n * tdc) * 1j * roll[k]
        for total, term in zip(
            sums,
            (forward, backward, 1j * lever * forward, 1j * lever * backward, torque),
            strict=True,
        ):
            total.append(term.sum(axis=-1))
    f, b, m, c, t = (np.stack(total, axis=-1) for total in sums)
    return Remains(
        f, b, m, c, t,
        longest(f, b, orders), longest(m, c, orders), largest(t, orders),
    )  # fmt: skip


def harmonics(rod_ratio: Array, orders: Sequence[int], terms: int = 8) -> tuple[Array, Array]:
    """Force along the bore over m r omega^2, and the sine of the roll torque over m r^2 omega^2.

    The force is sum a_n cos(n theta), the roll torque -sum t_n sin(n theta).
    """
    binomial = np.cumprod([1.0, *((0.5 - j) / (j + 1.0) for j in range(4 * terms))])
    p = rod_ratio / (1.0 + np.sqrt(1.0 - rod_ratio**2))
    square = p * p
    highest = max(orders) + terms
    # The rod's height over r, by order: cos(2m theta).
    heights = {}
    for m in range(1, highest // 2 + 1):
        weights = binomial[:terms] * binomial[m : m + terms]
        series = np.polynomial.polynomial.polyval(square * square, weights)
        heights[2 * m] = 2.0 / (1.0 + square) / rod_ratio * square**m * series
    force = [
        n * n * heights[n] if n in heights else np.full_like(rod_ratio, float(n == 1))
        for n in orders
    ]
    # x' = sum v_n sin(n theta); the torque is half the derivative of its square.
    speeds = {n: -n * height for n, height in heights.items()} | {1: np.full_like(rod_ratio, -1.0)}
    torque = []
    for n in orders:
        products = np.zeros_like(rod_ratio)
        for a, v in speeds.items():
            if a + n in speeds:
                products = products + v * speeds[a + n]
            if n - a in speeds:
                products = products - 0.5 * v * speeds[n - a]
        torque.append(0.5 * n * products)
    return np.stack(force), np.stack(torque)


def largest(phasors: Complex, orders: Sequence[int]) -> Array:
    """Largest magnitude over the turn of each row."""
    n = np.array(orders)
    theta = np.linspace(0.0, 2.0 * np.pi, GRID_PER_WAVE * max(orders), endpoint=False)
    angles = np.outer(n, theta)
    grid = phasors.real @ np.cos(angles) - phasors.imag @ np.sin(angles)
    best = np.abs(grid).max(axis=1)
    for sign in (1.0, -1.0):
        for start in _tops(sign * grid):
            at = theta[start]
            for _ in range(NEWTON_STEPS):
                terms = sign * phasors * np.exp(1j * np.outer(at, n))
                slope, bend = -(n * terms.imag).sum(axis=1), -(n * n * terms.real).sum(axis=1)
                at = at + _step(slope, bend, theta[1])
            value = (sign * phasors * np.exp(1j * np.outer(at, n))).sum(axis=1).real
            best = np.maximum(best, value)
    return np.asarray(best)


def longest(forward: Complex, backward: Complex, orders: Sequence[int]) -> Array:
    """Length of the longest vector over the turn of each row."""
    n = np.concatenate([orders, np.negative(orders)])
    parts = np.concatenate([forward, backward], axis=1)
    theta = np.linspace(0.0, 2.0 * np.pi, 2 * GRID_PER_WAVE * max(orders), endpoint=False)
    vector = parts @ np.exp(1j * np.outer(n, theta))
    grid = vector.real**2 + vector.imag**2
    best = np.sqrt(grid.max(axis=1))
    for start in _tops(grid):
        at = theta[start]
        for _ in range(NEWTON_STEPS):
            terms = parts * np.exp(1j * np.outer(at, n))
            v, dv = terms.sum(axis=1), (1j * n * terms).sum(axis=1)
            ddv = -(n * n * terms).sum(axis=1)
            slope, bend = (v.conj() * dv).real, (dv.conj() * dv + v.conj() * ddv).real
            at = at + _step(slope, bend, theta[1])
        value = np.abs((parts * np.exp(1j * np.outer(at, n))).sum(axis=1))
        best = np.maximum(best, value)
    return np.asarray(best)


def _tops(grid: Array) -> list[NDArray[np.intp]]:
    """Places of the highest local maxima of each row, which one is highest tells the polish."""
    local = (grid >= np.roll(grid, 1, axis=1)) & (grid >= np.roll(grid, -1, axis=1))
    heights = np.where(local, grid, -np.inf)
    return list(np.argpartition(-heights, range(TOPS), axis=1)[:, :TOPS].T)


def _step(slope: Array, bend: Array, longest_step: float) -> Array:
    """Newton's step towards a maximum; none where rounding is all there is."""
    step = np.divide(-slope, bend, out=np.zeros_like(slope), where=bend < 0.0)
    return np.asarray(np.clip(step, -longest_step, longest_step))
