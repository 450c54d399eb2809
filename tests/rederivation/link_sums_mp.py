"""Sums of engines with link rods in 50 digits, from loops of rods and free masses.

Cylinders are on one crank that turns counter-clockwise with θ. Momentum, moment of momentum about
the crank and kinetic energy of all masses are sampled over a turn, with velocities from derivatives
of the loops' equations; derivatives of their transforms are the sums.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import mpmath

SAMPLES = 128
"""Of a turn: what they fold back is below 1e-30 where orders fall by a factor of two."""


class Hung(NamedTuple):
    """A cylinder: angles as parts of a degree, lengths in m and masses in kg as typed."""

    crank_radius: Fraction
    rod: Fraction
    mass: Fraction
    bore: Fraction
    throw: Fraction
    """Direction of its crankpin at θ = 0."""
    z: Fraction
    offset: Fraction = Fraction(0)
    master: int | None = None
    """Index of the master's cylinder, of a link rod."""
    radius: Fraction = Fraction(0)
    angle: Fraction = Fraction(0)
    big_end: Fraction = Fraction(0)


def mp(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator


def turned(degrees: Fraction) -> mpmath.mpc:
    return mpmath.expjpi(mp(degrees / 180))


def on_bore(end: tuple[mpmath.mpc, mpmath.mpc], own: Hung) -> tuple[mpmath.mpc, mpmath.mpc]:
    """Return place and velocity of the wrist pin of a rod whose other end has these."""
    along = turned(own.bore)
    place, velocity = end[0] / along, end[1] / along
    side = place.imag - mp(own.offset)
    height = mpmath.sqrt(mp(own.rod) ** 2 - side**2)
    slope = velocity.real - side * velocity.imag / height
    return along * mpmath.mpc(place.real + height, mp(own.offset)), along * slope


def sums(cylinders: list[Hung], orders: range) -> dict[tuple[str, str], list[mpmath.mpc]]:
    """Return phasors over ω² by quantity and component, about the middle of the engine."""
    with mpmath.workdps(50):
        return _sums(cylinders, orders)


def _sums(cylinders: list[Hung], orders: range) -> dict[tuple[str, str], list[mpmath.mpc]]:
    places = [own.z for own in cylinders]
    middle = (min(places) + max(places)) / 2
    count = len(cylinders)
    momenta = [[mpmath.mpc(0)] * SAMPLES for _ in range(count)]
    about, energy = [mpmath.mpf(0)] * SAMPLES, [mpmath.mpf(0)] * SAMPLES
    for k in range(SAMPLES):
        crank = mpmath.expjpi(mpmath.mpf(2 * k) / SAMPLES)
        for i, own in enumerate(cylinders):
            pin = mp(own.crank_radius) * turned(own.throw) * crank
            lower = (pin, 1j * pin)
            bodies = []
            if own.master is not None:
                master = cylinders[own.master]
                wrist = on_bore(lower, master)
                share = mp(own.radius / master.rod) * turned(own.angle)
                lower = tuple(
                    foot + share * (top - foot) for foot, top in zip(lower, wrist, strict=True)
                )
                bodies.append((own.big_end, lower))
            bodies.append((own.mass, on_bore(lower, own)))
            for mass, (place, velocity) in bodies:
                momenta[i][k] += mp(mass) * velocity
                about[k] += mp(mass) * (mpmath.conj(place) * velocity).imag
                energy[k] += mp(mass) * abs(velocity) ** 2 / 2
    found: dict[tuple[str, str], list[mpmath.mpc]] = {}
    for n in orders:
        units = [mpmath.expjpi(mpmath.mpf(-2 * k * n) / SAMPLES) for k in range(SAMPLES)]

        def mean(values: list[mpmath.mpc], units: list[mpmath.mpc] = units) -> mpmath.mpc:
            return mpmath.fdot(values, units) / SAMPLES

        force = [mpmath.mpc(0)] * 2
        moment = [mpmath.mpc(0)] * 2
        for own, momentum in zip(cylinders, momenta, strict=True):
            # Of the derivative's negative what turns forward, and the conjugate of the other.
            mirrored = [mpmath.conj(one) for one in momentum]
            turning = [-1j * n * mean(one) for one in (momentum, mirrored)]
            lever = mp(own.z - middle)
            force = [a + b for a, b in zip(force, turning, strict=True)]
            moment = [a + i * lever * b for a, b, i in zip(moment, turning, (1j, -1j), strict=True)]
        for name, (forward, backward_conj) in {"force": force, "moment": moment}.items():
            parts = {
                "x": forward + backward_conj,
                "y": -1j * (forward - backward_conj),
                "forward": forward,
                "backward": backward_conj,
            }
            for component, value in parts.items():
                found.setdefault((name, component), []).append(value)
        torque = 2j * n * (mean(energy) - mean(about))
        found.setdefault(("torque", "z"), []).append(torque)
    return found
