"""Largest force on what carries mounts, compiled by numba: an LDLᵀ of each point, and modes."""

from __future__ import annotations

import numpy as np
from numba import njit, prange


@njit(parallel=True, fastmath=True, cache=False)
def factored(stiffness, damping, mass, load, omega):  # noqa: ANN001, ANN202, PLR0912 - compiled
    """Factorise each point of each design without pivots: largest |K q| of forces over speed."""
    count, (speeds, orders) = len(stiffness), omega.shape
    out = np.zeros((count, orders, 3))
    for d in prange(count):
        matrix = np.empty((6, 6), np.complex128)
        q = np.empty(6, np.complex128)
        for r in range(speeds):
            for n in range(orders):
                w = omega[r, n]
                for i in range(6):
                    q[i] = load[r, n, i]
                    for j in range(i + 1):
                        whole = stiffness[d, i, j] + 1j * w * damping[d, i, j]
                        matrix[i, j] = whole - w * w * mass[i, j]
                for k in range(6):
                    inverse = 1.0 / matrix[k, k]
                    for i in range(k + 1, 6):
                        factor = matrix[i, k] * inverse
                        for j in range(k + 1, i + 1):
                            matrix[i, j] -= factor * matrix[j, k]
                        q[i] -= factor * q[k]
                    for i in range(k + 1, 6):
                        matrix[i, k] *= inverse
                    q[k] *= inverse
                for k in range(5, -1, -1):
                    for i in range(k + 1, 6):
                        q[k] -= matrix[i, k] * q[i]
                for a in range(3):
                    force = 0j
                    for i in range(6):
                        force += (stiffness[d, a, i] + 1j * w * damping[d, a, i]) * q[i]
                    out[d, n, a] = max(out[d, n, a], abs(force))
    return out


@njit(parallel=True, fastmath=True, cache=False)
def superposed(values, shapes, rows, load, omega):  # noqa: ANN001, ANN202 - compiled
    """Superpose modes at each point of each design: largest force over speed."""
    count, (speeds, orders) = len(values), omega.shape
    out = np.zeros((count, orders, 3))
    for d in prange(count):
        along = np.empty(6, np.complex128)
        for r in range(speeds):
            for n in range(orders):
                square = omega[r, n] * omega[r, n]
                for m in range(6):
                    total = 0j
                    for i in range(6):
                        total += shapes[d, i, m] * load[r, n, i]
                    along[m] = total / (values[d, m] - square)
                for a in range(3):
                    force = 0j
                    for m in range(6):
                        force += rows[d, a, m] * along[m]
                    out[d, n, a] = max(out[d, n, a], abs(force))
    return out
