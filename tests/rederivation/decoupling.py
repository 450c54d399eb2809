"""Torque-roll-axis decoupling again: the motion in time of a body hit by a torque of its crank."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eigh, expm

if TYPE_CHECKING:
    from numpy.typing import NDArray


def off_axis(mass: NDArray[np.float64], stiffness: NDArray[np.float64]) -> float:
    """Return how far a body leaves the line of its first motion after an impulse about z.

    Largest part of the velocity across the torque roll axis over the velocity at first, in the
    metric of the mass: zero if the torque excites one mode alone.
    """
    impulse = np.zeros(6)
    impulse[5] = 1.0
    first = np.linalg.solve(mass, impulse)
    size = np.sqrt(first @ mass @ first)
    state = np.zeros((12, 12))
    state[:6, 6:] = np.eye(6)
    state[6:, :6] = -np.linalg.solve(mass, stiffness)
    period = 2.0 * np.pi / np.sqrt(eigh(stiffness, mass, eigvals_only=True)[0])
    step = expm(state * period / 200.0)
    now, worst = np.concatenate([np.zeros(6), first]), 0.0
    for _ in range(400):
        now = step @ now
        velocity = now[6:]
        across = velocity - first * (first @ mass @ velocity) / size**2
        worst = max(worst, float(np.sqrt(across @ mass @ across)) / float(size))
    return worst


def roll_frequency(mass: NDArray[np.float64], stiffness: NDArray[np.float64]) -> float:
    """Return the frequency, Hz, of the motion about the torque roll axis alone."""
    impulse = np.zeros(6)
    impulse[5] = 1.0
    first = np.linalg.solve(mass, impulse)
    square = (first @ stiffness @ first) / (first @ mass @ first)
    return float(np.sqrt(square) / (2.0 * np.pi))


def torque_in_one_mode(mass: NDArray[np.float64], stiffness: NDArray[np.float64]) -> float:
    """Return the largest share of one mode in the work of an impulse about z, %."""
    turns = eigh(stiffness, mass)[1][5]
    return float(100.0 * np.max(turns**2) / np.sum(turns**2))
