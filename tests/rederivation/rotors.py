"""What do masses exert that turn with the crankshaft, or on shafts geared to it?

A rotor is a point mass that goes round an axis parallel to the crank. Its force on the engine is
minus mass times acceleration, its roll torque minus the rate of its angular momentum about the
crank axis; both rates come from positions sampled over a turn of the crank, by differentiating
their Fourier series. No formula for a centrifugal force is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rederivation.time_domain import angular_speed, crank_angles

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rotor:
    """A point mass on a shaft; SI units, the angle in degrees at theta = 0."""

    mass: float
    radius: float
    angle_deg: float
    z: float
    ratio: float = 1
    axis: complex = 0.0

    def position(self, theta: Array) -> NDArray[np.complex128]:
        """Place in the cross-section, x + iy, m."""
        turned = np.deg2rad(self.angle_deg) + self.ratio * theta
        return np.asarray(self.axis + self.radius * np.exp(1j * turned))


def _rate(samples: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Derivative by theta of samples over one turn."""
    order = np.fft.fftfreq(len(samples), 1.0 / len(samples))
    return np.asarray(np.fft.ifft(1j * order * np.fft.fft(samples)))


def wrench(
    rotors: Sequence[Rotor], rpm: float, reference_z: float, n_samples: int = 256
) -> tuple[Array, Array, Array]:
    """Force (n, 2), rocking moment (n, 2) and roll torque (n,) at ``crank_angles(n_samples)``."""
    theta, omega = crank_angles(n_samples), angular_speed(rpm)
    force, moment = np.zeros((n_samples, 2)), np.zeros((n_samples, 2))
    torque = np.zeros(n_samples)
    for rotor in rotors:
        place = rotor.position(theta)
        speed = omega * _rate(place)
        push = -rotor.mass * omega * _rate(speed)
        lever = rotor.z - reference_z
        force += np.stack([push.real, push.imag], axis=-1)
        # r x F with r along z: M_x = -z F_y, M_y = z F_x.
        moment += lever * np.stack([-push.imag, push.real], axis=-1)
        spin = rotor.mass * (place.conjugate() * speed).imag
        torque -= omega * _rate(spin.astype(complex)).real
    return force, moment, torque
