"""Unlike cylinders in line: vector polygons of the textbooks, in plain NumPy.

Order 1: Σ m·e^{iφ} = 0 (force polygon) and Σ m·z·e^{iφ} = 0 (couple polygon); order 2 with 2φ.
"""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

Array = NDArray[np.float64]


def sums(masses: Array, z: Array, throws_deg: Array, order: int) -> tuple[float, float]:
    """Force and couple of an order about the middle, over the largest mass and the length."""
    turned = masses / masses.max() * np.exp(1j * order * np.radians(throws_deg))
    lever = (z - (z[0] + z[-1]) / 2) / (z[-1] - z[0])
    return abs(turned.sum()), abs((lever * turned).sum())


def inner(
    masses: tuple[float, float], z: Array, throws_deg: tuple[float, float]
) -> tuple[Array, Array]:
    """Masses and throws of the inner two of four cylinders, from those of the outer two."""
    outer = np.array(masses) * np.exp(1j * np.radians(throws_deg))
    lever = np.array([[1.0, 1.0], [z[1], z[2]]])
    found = np.linalg.solve(lever, -np.array([outer.sum(), z[0] * outer[0] + z[3] * outer[1]]))
    return np.abs(found), np.degrees(np.angle(found)) % 360


def unknown_mass(masses: Array, z: Array, which: int) -> tuple[float, Array]:
    """The unknown mass of one of four cylinders, and all throws from it, by the couple triangle."""
    lever = np.delete(z, which) - z[which]
    a, b, c = np.abs(lever * np.delete(masses, which))
    # Exterior angles of the triangle with sides a, b, c, closed one after another.
    at_b = np.arccos((a * a + b * b - c * c) / (2 * a * b))
    at_c = np.arccos((b * b + c * c - a * a) / (2 * b * c))
    directions = np.array([0.0, np.pi - at_b, 2 * np.pi - at_b - at_c])
    vectors = np.delete(masses, which) * np.sign(lever) * np.exp(1j * directions)
    last = -vectors.sum()
    throws = np.insert(np.angle(vectors), which, np.angle(last))
    return abs(last), np.degrees(throws - throws[0]) % 360


def symmetric(outer: float, inner_: float) -> tuple[float, float, float]:
    """Half angles of outer and inner cranks, degrees, and inner over outer mass.

    Of four symmetrical cylinders at ±outer and ±inner: p cos α = q cos β, p·outer·sin α =
    q·inner·sin β and p cos 2α + q cos 2β = 0, of which the first and the last give
    cos α·cos β = 1/2.
    """
    ratio = (outer / inner_) ** 2
    # (1 + x)(1 + ratio·x) = 4, x = tan² α.
    x = (-(1 + ratio) + np.sqrt((1 + ratio) ** 2 + 12 * ratio)) / (2 * ratio)
    alpha = np.arctan(np.sqrt(x))
    beta = np.arctan(outer / inner_ * np.tan(alpha))
    return np.degrees(alpha), np.degrees(beta), np.cos(alpha) / np.cos(beta)


def can_vanish(count: int, forces: set[int], moments: set[int], step_deg: int = 30) -> bool:
    """Whether masses and different places exist for throws that are multiples of an angle."""
    steps = list(range(0, 360, step_deg))
    random = np.random.default_rng(0)
    for rest in combinations_with_replacement(steps, count - 1):
        at = np.radians(np.array([0, *rest], dtype=float))
        waves = {n: np.array([np.cos(n * at), np.sin(n * at)]) for n in forces | moments}
        of_forces = np.concatenate([waves[n] for n in sorted(forces)])
        masses = linprog(
            np.ones(count),
            A_eq=of_forces,
            b_eq=np.zeros(len(of_forces)),
            bounds=[(1, None)] * count,
        )
        if not masses.success:
            continue
        if not moments:
            return True
        matrix = np.concatenate([waves[n] for n in sorted(moments)])
        _, values, rows = np.linalg.svd(matrix)
        kernel = rows[int((values > 1e-9).sum()) :]
        levers = random.standard_normal(len(kernel)) @ kernel / masses.x
        if np.diff(np.sort(levers)).min(initial=1.0) > 1e-6:
            return True
    return False
