"""What do makers' tables of forces, couples and guide-force moments print?

Pistons are free bodies: rod, wall and gas hold one in its motion, whose acceleration comes from
sampled positions by differentiating their Fourier series. Forces, couples and moments of the block
are sums over cylinders at each crank angle; an order is a term of their Fourier series. Of a
locomotive all masses are points, the weights in its wheels solve two equations of forces and
moments. No harmonic of a slider-crank and no formula of a textbook is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rederivation.time_domain import angular_speed, crank_angles

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Array = NDArray[np.float64]
Phasors = NDArray[np.complex128]
SAMPLES = 256


@dataclass(frozen=True)
class Piston:
    """A piston on its rod; SI units, angles in degrees. An infinite rod is a Scotch yoke."""

    mass: float
    radius: float
    rod: float
    bore_deg: float
    tdc_deg: float
    z: float
    rotating: float = 0.0

    def crankpin(self, theta: Array) -> Phasors:
        """Place of the crankpin, x + iy, m."""
        return np.asarray(
            self.radius * np.exp(1j * (theta + np.deg2rad(self.bore_deg - self.tdc_deg)))
        )

    def height(self, theta: Array) -> Array:
        """Distance of the wrist pin from the crank axis along the bore, m."""
        pin = self.crankpin(theta) * np.exp(-1j * np.deg2rad(self.bore_deg))
        if np.isinf(self.rod):
            return np.asarray(pin.real)
        return np.asarray(pin.real + np.sqrt(self.rod**2 - pin.imag**2))

    def acceleration(self, theta: Array, omega: float) -> Array:
        """Acceleration along the bore, m/s²; theta is a whole turn."""
        order = np.fft.rfftfreq(len(theta), 1.0 / len(theta))
        terms = np.fft.rfft(self.height(theta)) * -(order**2)
        return np.asarray(omega**2 * np.fft.irfft(terms, len(theta)))

    def force(self, theta: Array, omega: float) -> Phasors:
        """Force of inertia on the engine, of the piston and of what rotates, x + iy, N."""
        along = np.exp(1j * np.deg2rad(self.bore_deg))
        turning = self.rotating * omega**2 * self.crankpin(theta)
        return np.asarray(turning - self.mass * self.acceleration(theta, omega) * along)

    def wall_moment(
        self, theta: Array, omega: float, gas_force: Callable[[Array], Array] | None = None
    ) -> Array:
        """Moment about the crank axis of the piston's thrust on its wall, N·m.

        The rod is massless: its force on the piston is along it.
        """
        along = np.exp(1j * np.deg2rad(self.bore_deg))
        height = self.height(theta)
        rod = (height * along - self.crankpin(theta)) / along
        pressed = 0.0 if gas_force is None else gas_force(theta)
        in_rod = (self.mass * self.acceleration(theta, omega) + pressed) / rod.real
        return np.asarray(height * in_rod * rod.imag)


def orders_of(values: Array, orders: Sequence[int]) -> Phasors:
    """Peak phasors of some orders of a curve over a turn."""
    terms = np.fft.rfft(values) / len(values)
    return np.asarray(2.0 * terms[list(orders)])


def foundation(
    pistons: Sequence[Piston],
    rpm: float,
    orders: Sequence[int],
    vertical_deg: float,
    reference_z: float,
) -> dict[str, Phasors]:
    """Phasors of forces and couples, horizontal and vertical."""
    theta, omega = crank_angles(SAMPLES), angular_speed(rpm)
    up = np.exp(1j * np.deg2rad(vertical_deg))
    table = {}
    for name, levers in (
        ("force", [1.0] * len(pistons)),
        ("couple", [piston.z - reference_z for piston in pistons]),
    ):
        total = sum(
            lever * piston.force(theta, omega) / up
            for lever, piston in zip(levers, pistons, strict=True)
        )
        table[f"vertical_{name}"] = orders_of(np.real(total), orders)
        table[f"horizontal_{name}"] = orders_of(-np.imag(total), orders)
    return table


def guide_moments(
    pistons: Sequence[Piston], rpm: float, orders: Sequence[int], reference_z: float
) -> tuple[Phasors, Phasors, Phasors]:
    """Phasors of the H-type moment, the X-type bimoment, and of each cylinder."""
    theta, omega = crank_angles(SAMPLES), angular_speed(rpm)
    single = np.array([orders_of(piston.wall_moment(theta, omega), orders) for piston in pistons])
    levers = np.array([piston.z - reference_z for piston in pistons])
    return single.sum(axis=0), levers @ single, single


# --- locomotives ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Weight:
    """A point mass that turns with an axle: mass times radius, kg·m, and its place."""

    amount: float
    angle_deg: float
    z: float

    @property
    def vector(self) -> complex:
        """Direction at theta = 0, x + iy, kg·m."""
        return complex(self.amount * np.exp(1j * np.deg2rad(self.angle_deg)))


def in_wheels(weights: Sequence[Weight], wheel_z: Sequence[float]) -> Phasors:
    """Vectors in two planes that pull as these weights do: (2,), kg·m."""
    pull = sum(weight.vector for weight in weights)
    turn = sum(weight.z * weight.vector for weight in weights)
    return np.linalg.solve(np.array([[1.0, 1.0], [*wheel_z]]), np.array([pull, turn]))


def on_frame(
    pistons: Sequence[Piston],
    weights: Sequence[Weight],
    omega: float,
    middle: float,
    samples: int = 3600,
) -> tuple[Array, Array]:
    """Force along x, N, and couple about the vertical, N·m, over a turn."""
    theta = crank_angles(samples)
    force, couple = np.zeros(samples), np.zeros(samples)
    pulls = [(piston.z, piston.force(theta, omega)) for piston in pistons]
    pulls += [(weight.z, omega**2 * weight.vector * np.exp(1j * theta)) for weight in weights]
    for z, pull in pulls:
        force += pull.real
        couple += (z - middle) * pull.real
    return force, couple
