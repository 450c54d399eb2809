"""A rigid body on springs and dampers again: elastic energy with exact rotations, motion in time.

Stiffness is not assembled but differentiated: second differences of the energy of the springs, each
of which is stretched by the exact motion of its place. The equations of motion are integrated in
time, from a state that comes back after a period.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh, expm
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


class Spring(NamedTuple):
    """Springs and dampers along three axes at a place."""

    at: NDArray[np.float64]
    axes: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]


def stretched(
    spring: Spring, cg: NDArray[np.float64], q: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the displacement of a spring's place along its axes, by an exact rotation."""
    arm = spring.at - cg
    moved = q[:3] + Rotation.from_rotvec(q[3:]).apply(arm) - arm
    return np.asarray(spring.axes @ moved)


def curvature(
    springs: list[Spring], cg: NDArray[np.float64], figure: str, step: float = 1e-4
) -> NDArray[np.float64]:
    """Return second differences of ½ Σ k s² at rest, of stiffness or damping."""

    def energy(q: NDArray[np.float64]) -> float:
        return sum(
            0.5 * float(getattr(each, figure) @ stretched(each, cg, q) ** 2) for each in springs
        )

    unit = step * np.eye(6)
    matrix = np.empty((6, 6))
    for i in range(6):
        for j in range(6):
            a, b = unit[i], unit[j]
            mixed = energy(a + b) - energy(a - b) - energy(b - a) + energy(-a - b)
            matrix[i, j] = mixed / (4.0 * step**2)
    return matrix


def mass_matrix(mass: float, inertia: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix of (displacement of the CG, rotation)."""
    matrix = mass * np.eye(6)
    matrix[3:, 3:] = inertia
    return matrix


def frequencies(mass: NDArray[np.float64], stiffness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return natural frequencies, Hz, ascending."""
    return np.asarray(np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi))


def slider_crank_loads(
    tdc: float, z: float, radius: float, rod: float, mass: float
) -> Callable[[float, float], NDArray[np.float64]]:
    """Return force and moment about the origin of the inertia of a piston that moves upright.

    As a function of crank angle and angular speed. The height of the piston is differentiated by
    complex steps of its first derivative; the torque on the crank is minus the rate of its kinetic
    energy, and that on the block is its reaction.
    """

    def first(theta: complex) -> complex:
        sin, cos = np.sin(theta), np.cos(theta)
        return complex(-radius * sin * (1.0 + radius * cos / np.sqrt(rod**2 - (radius * sin) ** 2)))

    def loads(theta: float, omega: float) -> NDArray[np.float64]:
        angle = theta - tdc
        second = first(angle + 1e-30j).imag / 1e-30
        force = -mass * second * omega**2
        roll = mass * second * first(angle).real * omega**2
        return np.array([0.0, force, 0.0, -z * force, 0.0, roll])

    return loads


def steady_motion(
    matrices: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    load: Callable[[float], NDArray[np.float64]],
    period: float,
    times: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the motion that comes back after a period: M q̈ + C q̇ + K q = load, (n_times, 6)."""
    mass, damping, stiffness = matrices
    inverse = np.linalg.inv(mass)
    state = np.zeros((12, 12))
    state[:6, 6:] = np.eye(6)
    state[6:, :6], state[6:, 6:] = -inverse @ stiffness, -inverse @ damping

    def rate(t: float, x: NDArray[np.float64]) -> NDArray[np.float64]:
        moved = state @ x
        moved[6:] += inverse @ load(t)
        return moved

    def run(start: NDArray[np.float64]) -> NDArray[np.float64]:
        at = np.append(times, period)
        # Steps short enough that their error is far below the comparison's.
        found = solve_ivp(rate, (0.0, period), start, "DOP853", at, rtol=1e-11, atol=1e-14)
        return np.asarray(found.y.T)

    from_rest = run(np.zeros(12))[-1]
    start = np.linalg.solve(np.eye(12) - expm(state * period), from_rest)
    return run(start)[:-1, :6]
