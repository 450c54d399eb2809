"""How does a crank's speed change within a cycle, from its equation of motion in time?

Power balance of a crank with a flywheel J, pistons of mass m and rods of inertia beyond their two
masses: J·w' + (d/dt of the kinetic energy of pistons and rods)/w = T - T_load. Velocities are the
time derivatives of positions, by the rod's geometry alone; nothing is integrated over the angle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, newton

if TYPE_CHECKING:
    from numpy.typing import NDArray

Torque = Callable[[float], float]
RTOL = 1e-10
"""Relative error of a step of the time integration."""
NOISE = 1e-7
"""Relative error of a start: the time of a cycle has noise of 4e-8 where torque is a table."""


class Piston(NamedTuple):
    """A piston with its rod: m, kg; r, l, e, m; inertia beyond two masses, kg m2; TDC, rad."""

    mass: float
    radius: float
    rod: float
    offset: float
    rod_inertia: float
    tdc: float


def moving(piston: Piston, theta: float) -> tuple[float, float]:
    """Inertia of a piston and its rod seen from the crank, and its derivative by the angle.

    x = r cos a + sqrt(l^2 - (r sin a - e)^2) and sin phi = (r sin a - e)/l, differentiated twice.
    """
    a = theta - piston.tdc
    r, rod, e = piston.radius, piston.rod, piston.offset
    u, du, ddu = r * math.sin(a) - e, r * math.cos(a), -r * math.sin(a)
    h = math.sqrt(rod * rod - u * u)
    dh = -u * du / h
    ddh = -(du * du + u * ddu + dh * dh) / h
    dx, ddx = -r * math.sin(a) + dh, -r * math.cos(a) + ddh
    dphi = du / h
    ddphi = (ddu * h - du * dh) / (h * h)
    inertia = piston.mass * dx * dx + piston.rod_inertia * dphi * dphi
    slope = 2.0 * (piston.mass * dx * ddx + piston.rod_inertia * dphi * ddphi)
    return float(inertia), float(slope)


def speeds(
    torque: Torque,
    flywheel: float,
    pistons: Sequence[Piston],
    mean: float,
    theta: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Speeds (rad/s) at crank angles (rad, ascending over one period) at a mean speed.

    ``torque`` is that of the drive less the load, with a mean of zero over the period.
    """
    period = float(theta[-1] - theta[0])

    def motion(_: float, state: NDArray[np.float64]) -> list[float]:
        angle, speed = map(float, state)  # of NumPy they take three times as long
        parts = [moving(each, angle) for each in pistons]
        inertia = flywheel + sum(part[0] for part in parts)
        slope = sum(part[1] for part in parts)
        return [speed, (torque(angle) - 0.5 * slope * speed * speed) / inertia]

    def at_end(_: float, state: NDArray[np.float64]) -> float:
        return float(state[0] - theta[-1])

    at_end.terminal = True  # type: ignore[attr-defined]
    limits: dict[str, Any] = {"rtol": RTOL, "atol": RTOL, "method": "DOP853"}

    def run(start: float, *, dense: bool = False) -> object:
        state = [float(theta[0]), start]
        span = (0.0, 10.0 * period / mean)
        return solve_ivp(motion, span, state, events=at_end, dense_output=dense, **limits)

    def late(start: float) -> float:
        return float(run(start).t[-1] - period / mean)  # type: ignore[attr-defined]

    # By secants, to what the integration knows of a start: closer ones would chase its noise.
    start = newton(late, mean, x1=1.1 * mean, tol=NOISE * mean)
    found = run(start, dense=True)
    times = [
        brentq(lambda t, angle=angle: float(found.sol(t)[0]) - angle, 0.0, found.t[-1], xtol=1e-14)  # type: ignore[attr-defined]
        for angle in theta[1:-1]
    ]
    return np.array([start, *(float(found.sol(t)[1]) for t in times)])  # type: ignore[attr-defined]
