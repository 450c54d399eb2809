"""Actuators against vibration again: one channel that adapts in time, convex duals, Routh, roots.

Nothing is shared with what it checks: weights adapt sample by sample on a sine, stability is read
off roots or the coefficients of a polynomial.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

if TYPE_CHECKING:
    from numpy.typing import NDArray


def adapted_weight(target: complex, plant: complex, frequency: float, step: float) -> complex:
    """Return the phasor to which a filtered-x LMS law with two real weights comes, in time.

    One channel: the error is sampled, weights of a cosine and a sine follow its gradient.
    """
    rate = 40.0 * frequency
    weights = np.zeros(2)
    for n in range(40_000):
        angle = 2.0 * np.pi * frequency * n / rate
        wave = np.exp(1j * angle)
        force = weights[0] + 1j * weights[1]
        error = ((target + plant * force) * wave).real
        filtered = plant * wave
        gradient = np.array([filtered.real, -filtered.imag]) * error
        weights -= step / abs(plant) ** 2 * gradient
    return complex(weights[0], weights[1])


def largest_step(delay: int, phase: float) -> float:
    """Return the least step at which z^D(z − 1) + a·e^{iφ} has a root on the unit circle."""

    def excess(step: float) -> float:
        poly = np.zeros(delay + 2, dtype=complex)
        poly[:2] = 1.0, -1.0
        poly[-1] += step * np.exp(1j * phase)
        return float(np.abs(np.roots(poly)).max() - 1.0)

    steps = np.linspace(1e-3, 2.1, 3000)
    first = next(k for k, step in enumerate(steps) if excess(float(step)) > 1e-12)
    return float(brentq(excess, steps[first - 1], steps[first], xtol=1e-14))


def dual_gap(
    target: NDArray[np.complex128],
    effect: NDArray[np.complex128],
    bounds: NDArray[np.float64],
    weight: float,
    phasors: NDArray[np.complex128],
) -> float:
    """Return by how much at most phasors miss the least ‖d + Sc‖² + ρ‖c‖², over ‖d‖².

    Any multipliers bound it from below; those that the gradient shows are near the best.
    """

    def cost(c: NDArray[np.complex128]) -> float:
        left = np.linalg.norm(target + effect @ c) ** 2
        return float(left + weight * np.linalg.norm(c) ** 2)

    slope = effect.conj().T @ (target + effect @ phasors) + weight * phasors
    ratio = -(slope / np.where(phasors == 0.0, 1.0, phasors)).real
    multipliers = np.where(np.isfinite(bounds), np.maximum(ratio, 0.0), 0.0)
    count = len(phasors)
    rows = np.vstack([effect, np.diag(np.sqrt(weight + multipliers))])
    right = np.concatenate([-target, np.zeros(count)])
    free = np.linalg.lstsq(rows, right, rcond=None)[0]
    used = multipliers > 0.0
    lower = cost(free) + (multipliers[used] * (np.abs(free[used]) ** 2 - bounds[used] ** 2)).sum()
    return float((cost(phasors) - lower) / np.linalg.norm(target) ** 2)


def largest_gain(engine: tuple[float, float, float], actuator: tuple[float, float, float]) -> float:
    """Return the largest stable gain of velocity fed back, by Routh's table of the quartic.

    Of a mass on a spring, each of (mass, frequency in Hz, damping ratio).
    """
    (m, f, zeta), (n, g, xi) = engine, actuator
    k, c = m * (2.0 * np.pi * f) ** 2, 2.0 * zeta * m * 2.0 * np.pi * f
    kappa, gamma = n * (2.0 * np.pi * g) ** 2, 2.0 * xi * n * 2.0 * np.pi * g

    def least(gain: float) -> float:
        # (ms² + (c + γ + gain)s + k + κ)(ns² + γs + κ) − (γs + κ)((γ + gain)s + κ)
        body = np.array([m, c + gamma + gain, k + kappa])
        mass = np.array([n, gamma, kappa])
        across = np.polymul([gamma, kappa], [gamma + gain, kappa])
        a4, a3, a2, a1, a0 = np.polysub(np.polymul(body, mass), across)
        second = a2 - a4 * a1 / a3
        third = a1 - a3 * a0 / second
        return float(min(a3, second, third))

    return float(brentq(least, 1e-6, 1e7, xtol=1e-9)) if least(1e7) < 0.0 else float("inf")
