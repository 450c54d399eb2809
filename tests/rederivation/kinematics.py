"""How does one slider-crank move, and with what forces and torque does it act on the block?

Everything is written in the frame of the cylinder: u along the bore, away from the crankshaft,
v a quarter turn counter-clockwise from u. The crank turns counter-clockwise; ``theta`` (radians)
is zero when the crankpin is aligned with the bore, so that the crankpin is at r (cos theta,
sin theta) and moves towards +v after top dead centre. A pin offset e > 0 moves the bore's line to
v = e. The rod is two point masses: its big end turns with the crankpin, its small end is part of
the reciprocating mass. Derivatives are with respect to theta: multiply by the angular speed, once
for velocity, twice for acceleration. All arguments broadcast.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def _arrays(*values: ArrayLike) -> tuple[Array, ...]:
    return tuple(np.asarray(value, dtype=np.float64) for value in values)


def rod_height(
    theta: ArrayLike, crank_radius: ArrayLike, rod_length: ArrayLike, pin_offset: ArrayLike = 0.0
) -> Array:
    """Length of the rod seen along the bore, s = sqrt(l^2 - (r sin theta - e)^2)."""
    th, r, rod, e = _arrays(theta, crank_radius, rod_length, pin_offset)
    sideways = r * np.sin(th) - e
    return np.asarray(np.sqrt((rod - sideways) * (rod + sideways)))


def position(
    theta: ArrayLike, crank_radius: ArrayLike, rod_length: ArrayLike, pin_offset: ArrayLike = 0.0
) -> Array:
    """Piston pin's distance from the crank axis along the bore, x = r cos theta + s (metres).

    Pythagoras on the rod: crankpin (r cos theta, r sin theta), piston pin (x, e), l apart.
    """
    th, r = _arrays(theta, crank_radius)
    return r * np.cos(th) + rod_height(theta, crank_radius, rod_length, pin_offset)


def velocity(
    theta: ArrayLike, crank_radius: ArrayLike, rod_length: ArrayLike, pin_offset: ArrayLike = 0.0
) -> Array:
    """Piston velocity per radian of crank angle, dx/dtheta = -r sin theta - w w'/s (m/rad).

    w = r sin theta - e is the crankpin's distance from the bore's line, w' = r cos theta.
    """
    th, r, e = _arrays(theta, crank_radius, pin_offset)
    s = rod_height(theta, crank_radius, rod_length, pin_offset)
    return -r * np.sin(th) - (r * np.sin(th) - e) * r * np.cos(th) / s


def acceleration(
    theta: ArrayLike, crank_radius: ArrayLike, rod_length: ArrayLike, pin_offset: ArrayLike = 0.0
) -> Array:
    """Piston acceleration per radian squared, d2x/dtheta2 (m/rad^2), positive away from the crank.

    Differentiating s^2 + w^2 = l^2 twice: s s'' = -(w'^2 + w w'') - s'^2, with s s' = -w w'.
    """
    th, r, e = _arrays(theta, crank_radius, pin_offset)
    s = rod_height(theta, crank_radius, rod_length, pin_offset)
    w, dw, ddw = r * np.sin(th) - e, r * np.cos(th), -r * np.sin(th)
    ds = -w * dw / s
    return -r * np.cos(th) - (dw**2 + w * ddw + ds**2) / s


def inertia_force(
    theta: ArrayLike,
    mass: ArrayLike,
    omega: float,
    crank_radius: ArrayLike,
    rod_length: ArrayLike,
    pin_offset: ArrayLike = 0.0,
) -> Array:
    """Force of the reciprocating mass on the engine along its bore, -m omega^2 x'' (newtons).

    Newton's third law: the block pulls the piston inwards over the top, the piston pulls it up.
    """
    (m,) = _arrays(mass)
    return -m * omega**2 * acceleration(theta, crank_radius, rod_length, pin_offset)


def wall_force(
    theta: ArrayLike,
    mass: ArrayLike,
    omega: float,
    crank_radius: ArrayLike,
    rod_length: ArrayLike,
    pin_offset: ArrayLike = 0.0,
) -> Array:
    """Force of the piston on the cylinder wall, along +v (newtons), without gas or friction.

    The massless rod pushes the piston with a force S along itself, from crankpin (r cos, r sin)
    to piston pin (x, e). Along the bore S (x - r cos theta)/l = m omega^2 x''. The piston does not
    move sideways, so it hands the sideways part S (e - r sin theta)/l on to the wall.
    """
    th, m, r, rod, e = _arrays(theta, mass, crank_radius, rod_length, pin_offset)
    along = (position(th, r, rod, e) - r * np.cos(th)) / rod
    across = (e - r * np.sin(th)) / rod
    rod_force = m * omega**2 * acceleration(th, r, rod, e) / along
    return np.asarray(rod_force * across)


def roll_torque(
    theta: ArrayLike,
    mass: ArrayLike,
    omega: float,
    crank_radius: ArrayLike,
    rod_length: ArrayLike,
    pin_offset: ArrayLike = 0.0,
) -> Array:
    """Moment of the inertia forces on the block about the crank axis, +z (newton metres).

    The block feels the piston at the wall, at height x above the crank axis, and the crankshaft in
    the main bearings, on the axis itself. So only the wall force has a moment: M_z = x N.
    """
    x = position(theta, crank_radius, rod_length, pin_offset)
    return x * wall_force(theta, mass, omega, crank_radius, rod_length, pin_offset)


def crank_torque(
    theta: ArrayLike,
    mass: ArrayLike,
    omega: float,
    crank_radius: ArrayLike,
    rod_length: ArrayLike,
    pin_offset: ArrayLike = 0.0,
) -> Array:
    """Torque of the reciprocating mass on the crankshaft by virtual work (newton metres).

    In a turn by dtheta the inertia force works -m omega^2 x'' dx, hence T = -m omega^2 x'' x'.
    """
    force = inertia_force(theta, mass, omega, crank_radius, rod_length, pin_offset)
    return force * velocity(theta, crank_radius, rod_length, pin_offset)
