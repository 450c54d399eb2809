"""What does a slider-crank with a rigid rod of its own mass and inertia do to block and crank?

The frame is that of ``kinematics``: u along the bore, v a quarter turn counter-clockwise, crankpin
at r (cos theta, sin theta), piston pin at (x, e). The rod is one body: mass, centre of mass at a
from the crankpin on the line to the piston pin, inertia about it. Nothing here splits it in two.
Vectors have u and v along axis 0. Everything is per omega^2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rederivation import kinematics

Array = NDArray[np.float64]


class SliderCrank(NamedTuple):
    """One cylinder's bodies, SI units."""

    crank_radius: float
    rod_length: float
    pin_offset: float
    piston_mass: float
    rod_mass: float
    rod_inertia: float
    to_crankpin: float


class Motion(NamedTuple):
    """Derivatives are with respect to theta."""

    piston: tuple[Array, Array, Array]
    centre: tuple[Array, Array, Array]
    """position, velocity, acceleration, (2, n_theta) each"""
    spin: Array
    spin_change: Array
    """of the rod's direction, counter-clockwise"""


def cross(a: Array, b: Array) -> Array:
    """The z component of a x b."""
    return np.asarray(a[0] * b[1] - a[1] * b[0])


def motion(parts: SliderCrank, theta: ArrayLike) -> Motion:
    """The rod's line d turns with l^2 beta' = d x d', of which the derivative is d x d''."""
    th = np.asarray(theta, dtype=np.float64)
    r, rod, e = parts.crank_radius, parts.rod_length, parts.pin_offset
    unit, ahead = np.array([np.cos(th), np.sin(th)]), np.array([-np.sin(th), np.cos(th)])
    pin = (r * unit, r * ahead, -r * unit)
    along = (
        kinematics.position(th, r, rod, e),
        kinematics.velocity(th, r, rod, e),
        kinematics.acceleration(th, r, rod, e),
    )
    piston = tuple(
        np.array([x, np.full_like(th, height)])
        for x, height in zip(along, (e, 0.0, 0.0), strict=True)
    )
    share = parts.to_crankpin / rod
    centre = tuple(p + share * (q - p) for p, q in zip(pin, piston, strict=True))
    lines = [q - p for p, q in zip(pin, piston, strict=True)]
    return Motion(
        (piston[0], piston[1], piston[2]),
        (centre[0], centre[1], centre[2]),
        cross(lines[0], lines[1]) / rod**2,
        cross(lines[0], lines[2]) / rod**2,
    )


def inertia_force(parts: SliderCrank, theta: ArrayLike) -> Array:
    """Minus the sum of m a of piston and rod, (2, n_theta)."""
    moving = motion(parts, theta)
    return -parts.piston_mass * moving.piston[2] - parts.rod_mass * moving.centre[2]


def inertia_moment(parts: SliderCrank, theta: ArrayLike) -> Array:
    """Minus the sum of r x m a + I alpha, about the crank axis: on block and crank together."""
    moving = motion(parts, theta)
    of_piston = parts.piston_mass * cross(moving.piston[0], moving.piston[2])
    of_rod = parts.rod_mass * cross(moving.centre[0], moving.centre[2])
    return -(of_piston + of_rod + parts.rod_inertia * moving.spin_change)


def kinetic_energy(parts: SliderCrank, theta: ArrayLike) -> Array:
    """Of piston and rod."""
    moving = motion(parts, theta)
    of_piston = parts.piston_mass * (moving.piston[1] ** 2).sum(axis=0)
    of_rod = parts.rod_mass * (moving.centre[1] ** 2).sum(axis=0)
    return np.asarray(0.5 * (of_piston + of_rod + parts.rod_inertia * moving.spin**2))


def crank_torque(parts: SliderCrank, theta: ArrayLike) -> Array:
    """By virtual work: what the bodies take in power, the crank gives."""
    moving = motion(parts, theta)
    of_piston = parts.piston_mass * (moving.piston[1] * moving.piston[2]).sum(axis=0)
    of_rod = parts.rod_mass * (moving.centre[1] * moving.centre[2]).sum(axis=0)
    return np.asarray(-(of_piston + of_rod + parts.rod_inertia * moving.spin * moving.spin_change))


def roll_torque(parts: SliderCrank, theta: ArrayLike) -> Array:
    """From the free bodies: the wall's push on the piston, times minus its height.

    The rod pulls the piston with m x'' along the bore and passes the wall's push N on. On the rod
    act (-m x'', N) at the piston pin and the rest of m_rod a at the crankpin; their moments about
    its centre of mass make I beta''.
    """
    th = np.asarray(theta, dtype=np.float64)
    moving = motion(parts, th)
    pin = parts.crank_radius * np.array([np.cos(th), np.sin(th)])
    to_pin, to_piston = pin - moving.centre[0], moving.piston[0] - moving.centre[0]
    pull = np.array([-parts.piston_mass * moving.piston[2][0], np.zeros_like(th)])
    known = cross(to_piston, pull) + cross(to_pin, parts.rod_mass * moving.centre[2] - pull)
    push = (parts.rod_inertia * moving.spin_change - known) / (to_piston - to_pin)[0]
    return np.asarray(-moving.piston[0][0] * push)
