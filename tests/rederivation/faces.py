"""Pressure on both faces of a piston, from its volumes and free bodies.

The piston is at s(θ) = r cos θ + √(l² − (r sin θ − e)²) from the crank. Above it a volume shrinks
as s grows, below it one grows; each has a pressure of its own, that of the atmosphere acts on the
cross-section of the piston rod.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Reals: TypeAlias = NDArray[np.float64]


def place(theta: Reals, r: float, rod: float, e: float = 0.0) -> Reals:
    """Distance of the piston from the crank."""
    return np.asarray(r * np.cos(theta) + np.sqrt(rod**2 - (r * np.sin(theta) - e) ** 2))


def slope(theta: Reals, r: float, rod: float, e: float = 0.0) -> Reals:
    """ds/dθ."""
    across = r * np.sin(theta) - e
    along = np.sqrt(rod**2 - across**2)
    return np.asarray(-r * np.sin(theta) - across * r * np.cos(theta) / along)


def bend(theta: Reals, r: float, rod: float, e: float = 0.0) -> Reals:
    """d²s/dθ², by the quotient rule."""
    across, first = r * np.sin(theta) - e, r * np.cos(theta)
    along = np.sqrt(rod**2 - across**2)
    quotient = (first**2 - across * r * np.sin(theta)) / along + (across * first) ** 2 / along**3
    return np.asarray(-first - quotient)


def swept(
    theta: Reals, end: str, r: float, rod: float, e: float = 0.0
) -> tuple[Reals, NDArray[np.bool_]]:
    """Part of the stroke that a piston leaves at one end, and whether that grows."""
    turning = np.arcsin(e / (rod + r)), np.pi + np.arcsin(e / (rod - r))
    highest, lowest = (place(np.array(at), r, rod, e) for at in turning)
    above = (highest - place(theta, r, rod, e)) / (highest - lowest)
    moves_down = slope(theta, r, rod, e) < 0.0
    return (above, moves_down) if end == "head" else (1.0 - above, ~moves_down)


def compressed(
    part: Reals,
    grows: NDArray[np.bool_],
    suction: float,
    discharge: float,
    clearance: float,
    n: float,
) -> Reals:
    """Pressure of ideal valves: the outgoing stroke begins at discharge, the other at suction."""
    expanding = discharge * (clearance / (clearance + np.maximum(part, 0.0))) ** n
    compressing = suction * ((1.0 + clearance) / (clearance + part)) ** n
    return np.where(grows, np.maximum(expanding, suction), np.minimum(compressing, discharge))


def gas_force(
    head: Reals, crank: Reals, atmosphere: float, bore: float, rod_diameter: float
) -> Reals:
    """Force towards the crank, of absolute pressures."""
    area, through = np.pi / 4.0 * bore**2, np.pi / 4.0 * rod_diameter**2
    return np.asarray(head * area - crank * (area - through) - atmosphere * through)


def on_crankpin(theta: Reals, towards: Reals, r: float, rod: float, e: float = 0.0) -> Reals:
    """Force on the crankpin along the bore and a quarter turn ahead, of one on the piston.

    The massless rod hands on what drives the piston towards the crank, along itself; the wall has
    the rest. The piston is at (s, e), the crankpin at r·(cos θ, sin θ).
    """
    pin = r * np.exp(1j * theta)
    along = pin - (place(theta, r, rod, e) + 1j * e)
    along = along / np.abs(along)
    force = towards / -along.real * along
    return np.stack([force.real, force.imag], axis=-1)


def turning(theta: Reals, force: Reals, r: float) -> Reals:
    """Torque of a force on the crankpin about the crank."""
    return np.asarray(r * (np.cos(theta) * force[..., 1] - np.sin(theta) * force[..., 0]))


def loop(pressure: Reals, volume: Reals) -> float:
    """∮ p dV of a closed curve by the trapezoidal rule."""
    p, v = (np.append(of, of[0]) for of in (pressure, volume))
    return float(np.trapezoid(p, v))
