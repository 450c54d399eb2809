"""Phasors of actuators that leave the least at receivers, each within a bound.

min ‖d + S c‖² + ρ‖c‖², |cⱼ| ≤ bⱼ, point by point: a convex question. Without bounds it is least
squares. Points whose bounds are met follow the central path of −μ Σ log(bⱼ² − |cⱼ|²), whose steps
by Newton's method cannot fail (Nesterov and Nemirovskii): no further than 2μ an actuator above the
least.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Complex = NDArray[np.complex128]
    Real = NDArray[np.float64]

RANK = 1e-12
"""Singular value over the largest below which actuators do the same as others."""
FLOOR = 1e-14
"""What is added to the normal equations, over their largest: they may be singular."""
LEAST = 1e-12
"""μ at the end, over the largest that one actuator can do."""
NARROWER = 0.1
"""Factor of μ from one centre to the next."""
CENTRED = 0.25
"""Newton decrement at which a centre is near."""
MOST_STEPS = 400
"""Steps of Newton's method: tests need up to some hundred."""


def optimal(target: Complex, effect: Complex, bounds: Real, effort: float) -> Complex:
    """Return the phasors: (n_points, n_actuators).

    ``target`` is (n_points, n_receivers), ``effect`` (n_points, n_receivers, n_actuators),
    ``bounds`` (n_points, n_actuators); ``effort`` is ρ over the largest singular value squared.
    """
    points, _, actuators = effect.shape
    largest = np.linalg.norm(effect, 2, axis=(1, 2))
    phasors = np.zeros((points, actuators), dtype=complex)
    alive = np.flatnonzero((largest > 0.0) & (np.abs(target).max(axis=1) > 0.0))
    if not alive.size:
        return phasors
    rows = np.concatenate(
        [effect[alive], np.sqrt(effort) * largest[alive, None, None] * np.eye(actuators)], axis=1
    )
    right = np.concatenate([target[alive], np.zeros((alive.size, actuators))], axis=1)
    phasors[alive] = -(np.linalg.pinv(rows, rcond=RANK) @ right[..., None])[..., 0]
    met = alive[(np.abs(phasors[alive]) > bounds[alive]).any(axis=1)]
    if met.size:
        weight = effort * largest[met] ** 2
        phasors[met] = _bounded(target[met], effect[met], bounds[met], weight)
    return phasors


def _bounded(target: Complex, effect: Complex, bounds: Real, effort: Real) -> Complex:
    """Return the phasors of points whose bounds are met."""
    size = np.linalg.norm(target, axis=1)[:, None]
    columns = np.linalg.norm(effect, axis=1)
    limited = np.isfinite(bounds)
    # In units of the bounds, or of what an actuator alone needs: targets are 1.
    needed = size / np.where(columns > 0.0, columns, np.inf)
    unit = np.where(limited, bounds, needed)
    scaled = effect * (unit / size)[:, None, :]
    normal = np.swapaxes(scaled.conj(), 1, 2) @ scaled
    own = effort[:, None] * (unit / size) ** 2
    floor = FLOOR * np.maximum(np.abs(np.einsum("pjj->pj", normal)).max(axis=1), 1e-300)
    normal += (own + floor[:, None])[:, None, :] * np.eye(bounds.shape[1])
    drive = -(np.swapaxes(scaled.conj(), 1, 2) @ (target / size)[..., None])[..., 0]
    found = _on_central_path(normal, drive, limited) * unit
    sizes = np.abs(found)
    over = sizes > bounds
    found[over] *= bounds[over] / sizes[over]
    return found


def _on_central_path(normal: Complex, drive: Complex, limited: NDArray[np.bool_]) -> Complex:
    """Return u that minimise ½uᴴNu − Re(hᴴu), |u| ≤ 1 where limited."""
    points, count = drive.shape
    matrix = np.block([[normal.real, -normal.imag], [normal.imag, normal.real]])
    linear = np.concatenate([drive.real, drive.imag], axis=1)
    at = np.zeros_like(linear)
    mu = np.abs(drive).max(axis=1)
    last = LEAST * mu
    places = np.arange(count)
    going = np.arange(points)
    for _ in range(MOST_STEPS):
        x, weight = at[going], mu[going, None]
        pairs = x.reshape(-1, 2, count)
        room = np.where(limited[going], 1.0 - (pairs**2).sum(axis=1), np.inf)
        gradient = (matrix[going] @ x[..., None])[..., 0] - linear[going]
        gradient += weight * (2.0 * pairs / room[:, None, :]).reshape(x.shape)
        curvature = matrix[going].copy()
        for i in (0, 1):
            for k in (0, 1):
                part = 4.0 * pairs[:, i] * pairs[:, k] / room**2 + (i == k) * 2.0 / room
                curvature[:, i * count + places, k * count + places] += weight * part
        step = -np.linalg.solve(curvature, gradient[..., None])[..., 0]
        decrement = np.sqrt(np.maximum(-(gradient * step).sum(axis=1), 0.0) / mu[going])
        damped = np.where(decrement > CENTRED, 1.0 / (1.0 + decrement), 1.0)
        at[going] = x + damped[:, None] * step
        centred = decrement <= CENTRED
        done = centred & (mu[going] <= last[going])
        mu[going[centred & ~done]] *= NARROWER
        going = going[~done]
        if not going.size:
            break
    return at[:, :count] + 1j * at[:, count:]
