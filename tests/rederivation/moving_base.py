"""A rigid body on springs whose other ends move, again: Newton's and Euler's laws, by springs.

No stiffness matrix is assembled: the forces of the springs, of unit motions of the body and of the
base, are summed by cross products, and the motion that balances them is solved for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Spring(NamedTuple):
    """Complex stiffness along and about three axes, a row each, at a place."""

    at: NDArray[np.float64]
    axes: NDArray[np.float64]
    along: NDArray[np.complex128]
    about: NDArray[np.complex128]


class Body(NamedTuple):
    """Mass, centre of gravity, tensor of inertia about it."""

    mass: float
    cg: NDArray[np.float64]
    inertia: NDArray[np.float64]


def displacement(
    motion: NDArray[np.complex128], of: NDArray[np.float64], at: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Return the displacement at a place of what moves so at another point."""
    return np.asarray(motion[:3] + np.cross(motion[3:], at - of))


def wrench_on_ends(
    spring: Spring, stretch: NDArray[np.complex128], twist: NDArray[np.complex128]
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return force and moment of a spring, at its place, on what moves by its first end less."""
    force = spring.axes.T @ (spring.along * (spring.axes @ stretch))
    return force, spring.axes.T @ (spring.about * (spring.axes @ twist))


def of_springs(
    springs: list[Spring],
    body: Body,
    motion: NDArray[np.complex128],
    base: NDArray[np.complex128],
    of: NDArray[np.float64],
) -> NDArray[np.complex128]:
    """Return the springs' wrench about the CG on a body, of its motion and that of a base."""
    whole = np.zeros(6, dtype=complex)
    for spring in springs:
        stretch = displacement(base, of, spring.at) - displacement(motion, body.cg, spring.at)
        force, moment = wrench_on_ends(spring, stretch, base[3:] - motion[3:])
        whole[:3] += force
        whole[3:] += moment + np.cross(spring.at - body.cg, force)
    return whole


def inertia_of(body: Body, omega: float, motion: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return mass times acceleration, and the rate of angular momentum."""
    accelerated = -(omega**2) * motion
    return np.concatenate([body.mass * accelerated[:3], body.inertia @ accelerated[3:]])


def motion_on_base(
    springs: list[Spring],
    body: Body,
    omega: float,
    base: NDArray[np.complex128],
    of: NDArray[np.float64],
    load: NDArray[np.complex128],
) -> NDArray[np.complex128]:
    """Return the motion of a body under a load about its CG on a base that moves so at a point."""
    rest = np.zeros(6, dtype=complex)
    columns = [
        inertia_of(body, omega, unit) - of_springs(springs, body, unit, rest, of)
        for unit in np.eye(6, dtype=complex)
    ]
    driving = load + of_springs(springs, body, rest, base, of)
    return np.asarray(np.linalg.solve(np.array(columns).T, driving), dtype=np.complex128)


def motions_on_base(
    above: tuple[list[Spring], Body],
    below: tuple[list[Spring], Body],
    omega: float,
    base: NDArray[np.complex128],
    of: NDArray[np.float64],
    load: NDArray[np.complex128],
) -> NDArray[np.complex128]:
    """Return the motions, twelve, of a body on another on a base that moves so at a point."""
    (springs, body), (lower, carrier) = above, below
    rest = np.zeros(6, dtype=complex)

    def left(both: NDArray[np.complex128], moved: NDArray[np.complex128]) -> NDArray[np.complex128]:
        on_upper = of_springs(springs, body, both[:6], both[6:], carrier.cg)
        # Action and reaction: the same force at the same place, about the other CG.
        on_lower = of_springs(lower, carrier, both[6:], moved, of)
        on_lower[:3] -= on_upper[:3]
        on_lower[3:] -= on_upper[3:] + np.cross(body.cg - carrier.cg, on_upper[:3])
        upper = inertia_of(body, omega, both[:6]) - on_upper
        return np.concatenate([upper, inertia_of(carrier, omega, both[6:]) - on_lower])

    matrix = np.array([left(unit, rest) for unit in np.eye(12, dtype=complex)]).T
    driving = -left(np.zeros(12, dtype=complex), base)
    driving[:6] += load
    return np.asarray(np.linalg.solve(matrix, driving), dtype=np.complex128)
