"""What force, moment and torque does a whole engine exert at each crank angle, and at each order?

An engine is plain lists, one entry per cylinder. Seen from the flywheel end x is to the right,
y up, z from the front to the flywheel, and the crank turns counter-clockwise. Cylinder i is at top
dead centre (crankpin aligned with the bore) at theta = tdc_i; its bore points along bank_i, its
crankpin along bank_i - tdc_i + theta. Forces are added up at every sampled angle; nothing is known
of harmonics here until the sums are Fourier-transformed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rederivation import kinematics

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
PerCylinder = float | Sequence[float] | Array


@dataclass(frozen=True)
class EngineLists:
    """One engine, SI units, angles in degrees; a single number stands for all cylinders."""

    crank_radius: PerCylinder
    rod_length: PerCylinder
    reciprocating_mass: PerCylinder
    tdc_deg: PerCylinder
    bank_deg: PerCylinder
    z: PerCylinder
    pin_offset: PerCylinder = 0.0
    rotating_mass: PerCylinder = 0.0

    def column(self, name: str) -> Array:
        """The named list as (n_cylinders, 1), to broadcast against angles along axis 1."""
        n = max(np.size(self.tdc_deg), np.size(self.bank_deg), np.size(self.z))
        values = np.asarray(getattr(self, name), dtype=np.float64)
        return np.array(np.broadcast_to(values, (n,)))[:, np.newaxis]


class Phasors(NamedTuple):
    """Peak phasors P of each order n, quantity = Re(P e^{i n theta}); order 0 holds the mean."""

    force: ComplexArray
    """along x and y, (n_orders, 2), newtons"""
    moment: ComplexArray
    """about x and y, (n_orders, 2), newton metres"""
    roll_torque: ComplexArray
    """on the block about z, (n_orders,), newton metres"""
    crank_torque: ComplexArray
    """on the crankshaft about z, (n_orders,), newton metres"""


def angular_speed(rpm: float) -> float:
    """Angular speed, 2 pi rpm / 60 (rad/s)."""
    return 2.0 * np.pi * rpm / 60.0


def crank_angles(n_samples: int = 4096) -> Array:
    """n_samples equal steps through one turn, the end left out, (n_samples,), radians."""
    return np.asarray(2.0 * np.pi * np.arange(n_samples) / n_samples)


def _bore_angles(engine: EngineLists, theta: ArrayLike) -> Array:
    """Crank angle of each cylinder from its own top dead centre, (n_cylinders, n_theta)."""
    return np.asarray(theta, dtype=np.float64) - np.deg2rad(engine.column("tdc_deg"))


def _geometry(engine: EngineLists) -> tuple[Array, Array, Array]:
    return (engine.column("crank_radius"), engine.column("rod_length"), engine.column("pin_offset"))


def cylinder_forces(engine: EngineLists, rpm: float, theta: ArrayLike) -> Array:
    """Force of each cylinder on the engine, (n_cylinders, n_theta, 2), newtons.

    Reciprocating: -m omega^2 x'' along the bore. Rotating: m r omega^2 along the crankpin.
    """
    omega = angular_speed(rpm)
    bank, local = np.deg2rad(engine.column("bank_deg")), _bore_angles(engine, theta)
    mass = engine.column("reciprocating_mass")
    along = kinematics.inertia_force(local, mass, omega, *_geometry(engine))
    spin = engine.column("rotating_mass") * engine.column("crank_radius") * omega**2
    pin = bank + local
    return np.stack(
        [along * np.cos(bank) + spin * np.cos(pin), along * np.sin(bank) + spin * np.sin(pin)],
        axis=-1,
    )


def force(engine: EngineLists, rpm: float, theta: ArrayLike) -> Array:
    """Shaking force F_x, F_y, (n_theta, 2), newtons."""
    return np.asarray(cylinder_forces(engine, rpm, theta).sum(axis=0))


def middle_plane(engine: EngineLists) -> float:
    """The plane moments are taken about unless told otherwise, (min z + max z)/2."""
    z = engine.column("z")
    return float(z.min() + z.max()) / 2.0


def moment(
    engine: EngineLists, rpm: float, theta: ArrayLike, reference_z: float | None = None
) -> Array:
    """Rocking moment M_x, M_y about z = z0, (n_theta, 2), newton metres: r x F.

    M_x = -sum (z - z0) F_y (pitch), M_y = sum (z - z0) F_x (yaw).
    """
    z0 = middle_plane(engine) if reference_z is None else reference_z
    lever = engine.column("z") - z0
    forces = cylinder_forces(engine, rpm, theta)
    pitch = -(lever * forces[..., 1]).sum(axis=0)
    yaw = (lever * forces[..., 0]).sum(axis=0)
    return np.stack([pitch, yaw], axis=-1)


def roll_torque(engine: EngineLists, rpm: float, theta: ArrayLike) -> Array:
    """Roll moment of the inertia forces on the block about +z, (n_theta,), newton metres.

    Wall force times its height above the crank axis; the rotating masses pull through the axis.
    """
    local, mass = _bore_angles(engine, theta), engine.column("reciprocating_mass")
    each = kinematics.roll_torque(local, mass, angular_speed(rpm), *_geometry(engine))
    return np.asarray(each.sum(axis=0))


def crank_torque(engine: EngineLists, rpm: float, theta: ArrayLike) -> Array:
    """Torque of the inertia forces on the crankshaft about +z, (n_theta,), newton metres."""
    local, mass = _bore_angles(engine, theta), engine.column("reciprocating_mass")
    each = kinematics.crank_torque(local, mass, angular_speed(rpm), *_geometry(engine))
    return np.asarray(each.sum(axis=0))


def peak_phasors(samples: Array, orders: Sequence[int]) -> ComplexArray:
    """Peak phasors of a waveform sampled at ``crank_angles(n)``, (n_orders, ...) from (n, ...).

    P_n = (2/N) sum q(theta_k) e^{-i n theta_k}, and the plain mean for n = 0.
    """
    n = samples.shape[0]
    if max(orders) >= n / 2:
        raise ValueError(f"orders up to {max(orders)} need more than {2 * max(orders)} samples")
    spectrum = np.fft.fft(samples, axis=0) / n
    doubled = np.array([1.0 if order == 0 else 2.0 for order in orders])
    return np.asarray(spectrum[list(orders)] * doubled.reshape(-1, *[1] * (samples.ndim - 1)))


def phasors(
    engine: EngineLists,
    rpm: float,
    orders: Sequence[int],
    reference_z: float | None = None,
    n_samples: int = 4096,
) -> Phasors:
    """Peak phasors of force, moment and both torques, by Fourier transform of the waveforms."""
    theta = crank_angles(n_samples)
    return Phasors(
        force=peak_phasors(force(engine, rpm, theta), orders),
        moment=peak_phasors(moment(engine, rpm, theta, reference_z), orders),
        roll_torque=peak_phasors(roll_torque(engine, rpm, theta), orders),
        crank_torque=peak_phasors(crank_torque(engine, rpm, theta), orders),
    )


def forward_backward(samples: Array, orders: Sequence[int]) -> tuple[ComplexArray, ComplexArray]:
    """Parts turning with and against the crank of a plane vector (n, 2), each (n_orders,).

    x + iy = sum of forward e^{i n theta} + backward e^{-i n theta}: two bins of one transform.
    """
    spectrum = np.fft.fft(samples[:, 0] + 1j * samples[:, 1]) / samples.shape[0]
    index = np.asarray(orders, dtype=np.intp)
    return np.asarray(spectrum[index]), np.asarray(spectrum[-index])
