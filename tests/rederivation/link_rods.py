"""Link rods again, in NumPy: loops that rods close, and the free bodies of massless rods.

Crank radius r, master rod l on the bore at angle 0, knuckles at radius a and angles psi from its
shank, link rods L on the bores at angles beta, all counter-clockwise; the crank turns with θ.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Complex = NDArray[np.complex128]


class Star(NamedTuple):
    """A master rod and its links; angles are in degrees."""

    r: float
    l: float  # noqa: E741 - the rod's letter
    a: float
    L: float
    beta: tuple[float, ...]
    """Directions of the bores of the links."""
    psi: tuple[float, ...]
    """Angles of their knuckles."""


def on_bore(end: Complex, rod: float, bore: float) -> Complex:
    """Return where a circle about the end of a rod meets a line through 0, the farther one."""
    along = np.exp(1j * np.radians(bore))
    local = end / along
    return np.asarray(along * (local.real + np.sqrt(rod**2 - local.imag**2)))


def places(star: Star, theta: NDArray[np.float64]) -> tuple[Complex, list[Complex], list[Complex]]:
    """Return crankpin, lower ends of the rods and piston pins, the master's first."""
    crankpin = star.r * np.exp(1j * theta)
    wrist = on_bore(crankpin, star.l, 0.0)
    shank = (wrist - crankpin) / star.l
    lower, pistons = [crankpin], [wrist]
    for beta, psi in zip(star.beta, star.psi, strict=True):
        knuckle = crankpin + star.a * shank * np.exp(1j * np.radians(psi))
        lower.append(knuckle)
        pistons.append(on_bore(knuckle, star.L, beta))
    return crankpin, lower, pistons


def phasors(values: Complex) -> tuple[Complex, Complex]:
    """Return forward and backward phasors by order of vectors over a turn, order 0 first."""
    coefficients = np.fft.fft(values) / len(values)
    count = len(values) // 2
    return coefficients[:count], np.roll(coefficients[::-1], 1)[:count]


def derivative(values: Complex) -> Complex:
    """Return the derivative over the angle of values over a turn."""
    orders = np.fft.fftfreq(len(values), 1.0 / len(values))
    return np.asarray(np.fft.ifft(1j * orders * np.fft.fft(values)))


def force(
    star: Star, masses: tuple[float, ...], big_ends: tuple[float, ...], samples: int = 256
) -> Complex:
    """Return the shaking force over ω² at samples of a turn.

    Parameters
    ----------
    masses
        Of the pistons, the master's first.
    big_ends
        Of the links, at their knuckles.
    """
    theta = 2.0 * np.pi * np.arange(samples) / samples
    _, lower, pistons = places(star, theta)
    momentum = np.zeros(samples, dtype=complex)
    for mass, piston in zip(masses, pistons, strict=True):
        momentum += mass * derivative(piston)
    for mass, knuckle in zip(big_ends, lower[1:], strict=True):
        momentum += mass * derivative(knuckle)
    return -derivative(momentum)


def roll(star: Star, masses: tuple[float, ...], samples: int = 256) -> NDArray[np.float64]:
    """Return the torque of the walls on the block over ω², by equilibrium of massless rods.

    Each link is a two-force body; the master gets the links' forces at its knuckles, and its own
    wall's force follows from moments about the crankpin.
    """
    theta = 2.0 * np.pi * np.arange(samples) / samples
    crankpin, lower, pistons = places(star, theta)
    torque = np.zeros(samples)
    moment = np.zeros(samples)
    for k, (beta, mass) in enumerate(zip(star.beta, masses[1:], strict=True), start=1):
        along = np.exp(1j * np.radians(beta))
        inertia = -mass * derivative(derivative(pistons[k]))
        rod = (pistons[k] - lower[k]) / star.L
        # What the rod gives its piston along the bore is the negative of its inertia.
        size = -(inertia / along).real / (rod / along).real
        wall = size * (rod / along).imag * 1j * along  # of the piston on the wall
        torque += (pistons[k].conj() * wall).imag
        moment += ((lower[k] - crankpin).conj() * -size * rod).imag
    inertia = -masses[0] * derivative(derivative(pistons[0]))
    arm = pistons[0] - crankpin
    # Moments about the crankpin of the master: links, inertia along its bore, wall across it.
    from_wall = -(moment + (arm.conj() * inertia.real).imag) / arm.real
    return torque + (pistons[0].conj() * -1j * from_wall).imag


def torques(
    masses: tuple[float, ...], paths: tuple[Complex, ...]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return torque over ω² on the block, and on a crank that turns evenly, of masses on paths.

    What drives the crank gives the change of kinetic energy; the block gives the rest of the change
    of the moment of momentum.
    """
    energy: Complex = np.zeros(len(paths[0]), dtype=complex)
    momentum = energy.copy()
    for mass, path in zip(masses, paths, strict=True):
        velocity = derivative(path)
        energy += 0.5 * mass * np.abs(velocity) ** 2
        momentum += mass * (path.conj() * velocity).imag
    drive = derivative(energy).real
    return drive - derivative(momentum).real, -drive


class Hung(NamedTuple):
    """A cylinder by its rod: directions in degrees, lengths in m, masses in kg."""

    bore: float
    rod: float
    mass: float
    master: int | None = None
    """Index of the master's cylinder, of a link rod."""
    radius: float = 0.0
    angle: float = 0.0
    big_end: float = 0.0


def cylinder_forces(
    cylinders: list[Hung], crankpins: list[Complex], samples: int
) -> NDArray[np.float64]:
    """Return what each cylinder adds to the force over ω²: (n_cylinders, samples, 2).

    Crankpins are at samples of a turn, from the crank's axis.
    """
    forces = np.zeros((len(cylinders), samples, 2))
    for k, own in enumerate(cylinders):
        lower = crankpins[k]
        if own.master is not None:
            master = cylinders[own.master]
            shank = on_bore(lower, master.rod, master.bore) - lower
            lower = lower + own.radius * shank / master.rod * np.exp(1j * np.radians(own.angle))
        momentum = own.mass * derivative(on_bore(lower, own.rod, own.bore))
        if own.master is not None:
            momentum = momentum + own.big_end * derivative(lower)
        force = -derivative(momentum)
        forces[k] = np.stack([force.real, force.imag], axis=1)
    return forces
