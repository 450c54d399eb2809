"""Places of balance shafts: the roll torque that they make, and places that cancel the engine's."""

from __future__ import annotations

import cmath
import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np

from crankpin.analysis.balancing.planes import DECIMALS, without_rounding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

EQUAL = 1e-9
"""Relative difference up to which the forces of a pair are equal."""


@dataclasses.dataclass(frozen=True)
class PairHeights:
    """Places of a Lanchester pair that cancel the roll torque of its order.

    Two shafts at +n and −n with equal forces push together along one line. With *up* along that
    line and *right* to its right, their roll torque depends on how much higher the shaft that turns
    with the crank stands, and on the sum of the two distances to the right, and on nothing else.
    """

    order: int
    """Order of the pair."""
    difference: float
    """Height of the shaft that turns with the crank over the other, m."""
    right_sum: float
    """Sum of the distances of both to the right of the crank axis, m."""
    up_deg: float
    """Direction of *up*, degrees from +x in [0, 180): 90 for an upright inline engine."""


def pair_heights(order: int, forward: complex, backward: complex, torque: complex) -> PairHeights:
    """Return the heights at which a pair cancels a roll torque.

    Parameters
    ----------
    order
        Order of the pair.
    forward, backward
        Forces of its two shafts at θ = 0, x + iy, equal in length.
    torque
        Phasor of the roll torque on the block without the shafts, in the force's unit times m.
    """
    up = (cmath.phase(forward) + cmath.phase(backward)) / 2.0 % math.pi
    # With a = e^{i·up}(h − iw) the pair's torque is i·|F|·e^{iγ}·((h_B − h_A) − i(w_A + w_B)).
    gamma = cmath.phase(forward) - up
    needed = -torque / (abs(forward) * cmath.exp(1j * gamma))
    difference, right_sum = without_rounding(np.array([-needed.imag, needed.real])).tolist()
    up_deg = round(math.degrees(up), DECIMALS)
    return PairHeights(order, difference, right_sum, up_deg)


def makes_a_pair(forces: Sequence[tuple[int, complex]]) -> bool:
    """Return whether shafts, as ratio and force, are one pair of opposite ratio and equal force."""
    if len(forces) != 2 or forces[0][0] != -forces[1][0]:
        return False
    sizes = [abs(force) for _, force in forces]
    return min(sizes) > 0.0 and max(sizes) - min(sizes) <= EQUAL * max(sizes)


def roll_influence(ratio: int, force: complex) -> NDArray[np.complex128]:
    """Return the roll torque's phasor that a shaft makes for each metre along x and along y: (2,).

    The torque is x·F_y − y·F_x; ``force`` is the shaft's at θ = 0, x + iy.
    """
    along_x, along_y = (
        (force, -1j * force) if ratio > 0 else (force.conjugate(), 1j * force.conjugate())
    )
    return np.array([along_y, -along_x])


def placed(
    torque: complex,
    forces: Sequence[tuple[int, complex]],
    places: Sequence[tuple[float | None, float | None]],
) -> list[tuple[float, float]]:
    """Return places of shafts of one order that cancel a roll torque, or come closest to it.

    Of several solutions the one with the least sum of squared distances from the crank axis.

    Parameters
    ----------
    torque
        Phasor of the roll torque without the shafts.
    forces
        Ratio of each shaft, and its force at θ = 0, x + iy.
    places
        x and y of each, m; None is free.
    """
    given = np.array([(x, y) for x, y in places], dtype=np.float64).ravel()  # None becomes NaN
    free = np.isnan(given)
    each = np.concatenate([roll_influence(*force) for force in forces])
    left = torque + (each[~free] * given[~free]).sum()
    rows = np.stack([each.real, each.imag])[:, free]
    found = np.linalg.lstsq(rows, -np.array([left.real, left.imag]), rcond=None)[0]
    given[free] = without_rounding(found)
    return [(float(x), float(y)) for x, y in given.reshape(-1, 2)]
