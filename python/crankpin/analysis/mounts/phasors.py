"""Phasors of actuators that minimise the motion at receivers, each within a bound.

min ‖d + S c‖² + ρ‖c‖², |cⱼ| ≤ bⱼ, point by point: a convex question. Without bounds it is least
squares. Points whose bounds are met follow the central path of −μ Σ log(bⱼ² − |cⱼ|²), whose steps
by Newton's method cannot fail (Nesterov and Nemirovskii): no further than 2μ an actuator above the
least.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Complex = NDArray[np.complex128]
    Real = NDArray[np.float64]

RANK = 1e-12
"""Singular value over the largest below which actuators do the same as others."""
FLOOR = 1e-14
"""Regularisation of the normal equations, over their largest entry: they may be singular."""
LEAST = 1e-12
"""μ at the end, over the largest that one actuator can do."""
NARROWER = 0.1
"""Factor of μ from one centre to the next."""
CENTRED = 0.25
"""Newton decrement at which a centre is near."""
GAP = 1e-9
"""Distance from the least largest receiver, over it, at the end."""
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


def least_largest(
    target: Complex, effect: Complex, bounds: Real, widths: Sequence[int], start: Complex
) -> Complex:
    """Return the phasors that leave the least largest receiver: (n_points, n_actuators).

    ``widths`` are the numbers of rows of each receiver, whose length counts; ``start`` phasors
    within the bounds, to which the scale of those without bounds is taken. In real numbers x and t,
    min t, |d + Sx| < t for each receiver, follows the central path of its barriers.
    """
    found = start.copy()
    ends = np.cumsum(widths)
    for point in range(len(target)):
        size = float(np.abs(target[point]).max(initial=0.0))
        columns = np.linalg.norm(effect[point], axis=0)
        if size == 0.0 or not columns.any():
            continue
        needed = size / np.where(columns > 0.0, columns, np.inf)
        unit = np.where(np.isfinite(bounds[point]), bounds[point], needed)
        rows = effect[point] * unit / size
        matrix = np.block([[rows.real, -rows.imag], [rows.imag, rows.real]])
        right = np.concatenate([target[point].real, target[point].imag]) / size
        groups = [np.arange(end - width, end) for end, width in zip(ends, widths, strict=True)]
        pairs = [np.concatenate([each, each + len(rows)]) for each in groups]
        limited = np.flatnonzero(np.isfinite(bounds[point]))
        first = start[point] / np.where(unit > 0.0, unit, 1.0)
        x = 0.9 * np.concatenate([first.real, first.imag])
        moved = _minimax(matrix, right, pairs, limited, x)
        moved_by = (moved[: len(unit)] + 1j * moved[len(unit) :]) * unit

        both = np.stack([moved_by, found[point]], axis=1)
        left = np.abs(target[point][:, None] + effect[point] @ both) ** 2
        sizes = np.array([left[each].sum(axis=0) for each in groups]).max(axis=0)
        if sizes[0] < sizes[1]:
            found[point] = moved_by
    return found


def _minimax(
    matrix: Real, right: Real, pairs: list[NDArray[np.intp]], limited: NDArray[np.intp], x: Real
) -> Real:
    """Return x of the least t with |(Ax + b) of each pair| ≤ t and |x of each limited| ≤ 1."""
    count = len(x) // 2
    t = 2.0 * max(float(np.linalg.norm((matrix @ x + right)[each])) for each in pairs) + 1e-300
    mu = t
    for _ in range(MOST_STEPS):
        left = matrix @ x + right
        gradient, curvature = np.zeros(len(x) + 1), np.zeros((len(x) + 1, len(x) + 1))
        gradient[-1] = 1.0 / mu
        curvature[: len(x), : len(x)] += FLOOR * np.eye(len(x))
        barriers = []
        for each in pairs:  # −log(t² − |e|²)
            jacobian = np.zeros((len(each) + 1, len(x) + 1))
            jacobian[:-1, :-1], jacobian[-1, -1] = matrix[each], 1.0
            barriers.append((jacobian, np.append(left[each], t), 0.0))
        for k in limited:  # −log(1 − |x|²)
            jacobian = np.zeros((2, len(x) + 1))
            jacobian[0, k] = jacobian[1, count + k] = 1.0
            barriers.append((jacobian, x[[k, count + k]], 1.0))
        for jacobian, value, limit in barriers:
            sign = np.ones(len(value))
            sign[-1] = 1.0 if limit else -1.0
            room = limit - float((sign * value**2).sum())
            slope = 2.0 * sign * value / room
            gradient += jacobian.T @ slope
            own = np.diag(2.0 * sign / room) + np.outer(slope, slope)
            curvature += jacobian.T @ own @ jacobian
        scale = 1.0 / np.sqrt(np.diag(curvature))
        inner = np.linalg.lstsq(scale[:, None] * curvature * scale, -scale * gradient, rcond=None)
        step = scale * inner[0]
        decrement = float(np.sqrt(max(-float(gradient @ step), 0.0)))
        if decrement <= CENTRED:
            # No further than two of each barrier above the least.
            if 2.0 * len(barriers) * mu <= GAP * t:
                break
            mu *= NARROWER
        step *= 1.0 / (1.0 + decrement) if decrement > CENTRED else 1.0
        x, t = x + step[:-1], t + float(step[-1])
    return x


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
