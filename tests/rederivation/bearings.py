"""What do the bearings of an engine carry? Free bodies of piston, rod and crank, solved one by one.

The rod is a rigid body with a mass, a centre of mass and a moment of inertia; no masses at its ends
stand in for it. Each cylinder gives five unknowns at each crank angle (two forces of two
components, the wall's push) and five equations (Newton for piston and rod, Euler for the rod),
solved by ``numpy.linalg.solve``. Each span of the crank between two main bearings then gives two
unknown vectors and two equations: the sum of forces, and the sum of moments about its front
bearing.

Forces are complex, x + iy, seen from the flywheel; angles are radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rederivation import kinematics, rigid_rod

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Throw:
    """One cylinder: its bodies, its share of the crank, and where it is."""

    parts: rigid_rod.SliderCrank
    crank_mass: float
    """of the crank itself, at the crankpin"""
    tdc: float
    bank: float
    z: float

    def on_crank(self, omega: float, theta: Array) -> ComplexArray:
        """Centrifugal force of the crank's own mass."""
        force = self.crank_mass * self.parts.crank_radius * omega**2
        return np.asarray(force * np.exp(1j * (self.bank - self.tdc + theta)))


class Forces(NamedTuple):
    """Forces at each crank angle, (n_theta,), newtons."""

    on_crankpin: ComplexArray
    """of the rod"""
    on_wrist_pin: ComplexArray
    """of the rod"""
    on_wall: ComplexArray
    """of the piston"""
    wrist_pin: ComplexArray
    """where it is, m from the crank's axis"""
    along_rod: Array
    """compression of the rod at the wrist pin"""
    rod: ComplexArray
    """unit vector from crankpin to wrist pin"""


def cylinder_forces(throw: Throw, omega: float, theta: Array, gas: Array | float = 0.0) -> Forces:
    """Forces of one cylinder, with a gas force on its piston towards the crank."""
    parts, alpha = throw.parts, theta - throw.tdc
    moving = rigid_rod.motion(parts, alpha)
    centre, piston = (
        omega**2 * (part[2][0] + 1j * part[2][1]) for part in (moving.centre, moving.piston)
    )
    crankpin = parts.crank_radius * np.exp(1j * alpha)
    wrist_pin = moving.piston[0][0] + 1j * moving.piston[0][1]
    middle = moving.centre[0][0] + 1j * moving.centre[0][1]
    to_pin, to_wrist = crankpin - middle, wrist_pin - middle
    gases = np.broadcast_to(gas, theta.shape)
    # Unknown: force of the crankpin and of the piston on the rod, of the wall on the piston.
    found = np.empty((len(theta), 5))
    for k in range(len(theta)):
        equations = np.array(
            [
                [1.0, 0.0, 1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0, 1.0, 0.0],
                [-to_pin[k].imag, to_pin[k].real, -to_wrist[k].imag, to_wrist[k].real, 0.0],
                [0.0, 0.0, -1.0, 0.0, 0.0],
                [0.0, 0.0, 0.0, -1.0, 1.0],
            ]
        )
        right = [
            parts.rod_mass * centre[k].real,
            parts.rod_mass * centre[k].imag,
            parts.rod_inertia * omega**2 * moving.spin_change[k],
            parts.piston_mass * piston[k].real + gases[k],
            0.0,
        ]
        found[k] = np.linalg.solve(equations, right)
    from_crankpin = found[:, 0] + 1j * found[:, 1]
    from_piston = found[:, 2] + 1j * found[:, 3]
    rod = (wrist_pin - crankpin) / parts.rod_length
    bore = np.exp(1j * throw.bank)
    return Forces(
        on_crankpin=-from_crankpin * bore,
        on_wrist_pin=-from_piston * bore,
        on_wall=-1j * found[:, 4] * bore,
        wrist_pin=wrist_pin * bore,
        along_rod=-(from_piston * rod.conj()).real,
        rod=rod * bore,
    )


def gas_crank_torque(throw: Throw, theta: Array, gas: Array) -> Array:
    """Torque of a gas force on the crank: the power that it does over the crank's speed."""
    parts = throw.parts
    rate = kinematics.velocity(
        theta - throw.tdc, parts.crank_radius, parts.rod_length, parts.pin_offset
    )
    return np.asarray(-gas * rate)


def main_loads(
    forces: list[tuple[float, ComplexArray]], mains: list[float], n_theta: int
) -> ComplexArray:
    """Force of the crank on each main bearing, (n_mains, n_theta), from loads (z, force) on it.

    Every span is a beam on two supports of its own. Loads outside the end bearings belong to the
    end spans.
    """
    reactions = np.zeros((len(mains), n_theta), dtype=np.complex128)
    ends = [-np.inf, *mains[1:-1], np.inf]
    for k in range(len(mains) - 1):
        front, rear = mains[k], mains[k + 1]
        inside = [(z, force) for z, force in forces if ends[k] <= z < ends[k + 1]]
        whole = sum((force for _, force in inside), np.zeros(n_theta, dtype=np.complex128))
        levered = sum(
            ((z - front) * force for z, force in inside), np.zeros(n_theta, dtype=np.complex128)
        )
        found = np.linalg.solve([[1.0, 1.0], [0.0, rear - front]], np.stack([whole, levered]))
        reactions[k] += found[0]
        reactions[k + 1] += found[1]
    return reactions


def internal_couple(
    forces: list[tuple[float, ComplexArray]], z: float, n_theta: int
) -> ComplexArray:
    """Moment about a place of the loads in front of it, M_x + i M_y, (n_theta,)."""
    couple = np.zeros(n_theta, dtype=np.complex128)
    for place, force in forces:
        if place < z:
            # r x F with r = (place - z) along z.
            couple += -(place - z) * force.imag + 1j * (place - z) * force.real
    return couple
