"""Which sums over an engine are zero, to sixty digits?

Each cylinder is taken at the exact decimals or fractions that were typed. Harmonics follow from the
geometry of one crank in its own sense by the trapezoid rule; a crank that turns the other way
mirrors them. The engine is the sum of cylinders, masses that turn and pressures. A sum of sixty
digits is zero below 1e-50 of its terms and not above 1e-35; none may lie between these.

Any pressure acts: a trigonometric polynomial of half orders with sines for coefficients.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import mpmath as mp

if TYPE_CHECKING:
    from collections.abc import Sequence

DIGITS = 60
SAMPLES = 128
"""Of a turn: at rod ratios up to 1/3, offsets r/5, order 6 is missed by e^{-1.69 (128 - 6)}."""
ZERO, NOT_ZERO = mp.mpf(10) ** -50, mp.mpf(10) ** -35
PRESSURES = 13
"""Orders of half crank speed that the pressure of a cycle has, from 0."""

Real = Any  # mpmath carries no types
Complex = Any


class Piston(NamedTuple):
    """Moving parts of a cylinder, m, kg, kg·m²."""

    radius: Fraction
    rod: Fraction
    mass: Fraction
    offset: Fraction = Fraction(0)
    rod_inertia: Fraction = Fraction(0)


class Place(NamedTuple):
    """A cylinder in its place; angles are parts of a turn."""

    piston: Piston
    tdc: Fraction
    bank: Fraction
    z: Fraction
    ratio: int = 1
    axis: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    turning: Fraction = Fraction(0)
    """Mass at the crankpin, kg."""
    cycle: int | None = None
    """Which pressure acts on the piston."""
    area: Fraction = Fraction(1)
    later: bool = False
    """Whether it fires at its top dead centre in the second turn of its crank."""


class Weight(NamedTuple):
    """An unbalance that turns with a shaft, kg·m; its direction at θ = 0 is a part of a turn."""

    amount: Fraction
    direction: Fraction
    z: Fraction
    ratio: int = 1
    axis: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))


def real(value: Fraction) -> Real:
    """Return a fraction to sixty digits and guard digits."""
    return mp.mpf(value.numerator) / value.denominator


@lru_cache(maxsize=4096)
def turned(turns: Fraction) -> Complex:
    """Return e^{2πi·turns}."""
    return mp.expjpi(2 * real(turns))


@lru_cache(maxsize=256)
def motion(rod: Fraction, offset: Fraction) -> list[tuple[Real, ...]]:
    """Return x′, x″, φ′ and φ″ over a turn from top dead centre, lengths over the crank radius.

    x = cos u + l cos φ, l sin φ = sin u − e.
    """
    length, shift = real(rod), real(offset)
    found = []
    for k in range(SAMPLES):
        cosine, sine = mp.cospi(mp.mpf(2 * k) / SAMPLES), mp.sinpi(mp.mpf(2 * k) / SAMPLES)
        lean = (sine - shift) / length
        upright = mp.sqrt(1 - lean**2)
        turning = cosine / (length * upright)
        slowing = (-sine / length + lean * turning**2) / upright
        velocity = -sine - length * lean * turning
        acceleration = -cosine - length * (upright * turning**2 + lean * slowing)
        found.append((velocity, acceleration, turning, slowing))
    return found


def _harmonic(values: Sequence[Real], order: int, periods: int) -> Complex:
    """Return the phasor of an order of half crank speed from samples over so many turns.

    Harmonics below 1e-50 are zero by symmetry: the others fall to 1e-7 at most.
    """
    count = len(values)
    step = order * periods
    waves = (turned(Fraction(-step * k % (2 * count), 2 * count)) for k in range(count))
    found = mp.fsum(value * wave for value, wave in zip(values, waves, strict=True)) * 2 / count
    return found if abs(found) > ZERO else mp.mpc(0)


@lru_cache(maxsize=4096)
def inertia(rod: Fraction, offset: Fraction, own: int) -> tuple[Complex, Complex, Complex]:
    """Return phasors of the force, of the roll of the piston and of that of the rod, at an order.

    Over m·r, m·r² and J. Roll is dE/du − dL/du: E = x′²/2, L = −e·x′ of the piston, φ′²/2 and −φ′
    of the rod, which leans back as the crank turns on.
    """
    shift, samples = real(offset), motion(rod, offset)
    force = [-acceleration for _, acceleration, _, _ in samples]
    piston = [(velocity + shift) * acceleration for velocity, acceleration, _, _ in samples]
    leaning = [(turning + 1) * slowing for _, _, turning, slowing in samples]
    return tuple(_harmonic(values, 2 * own, 1) for values in (force, piston, leaning))


@lru_cache(maxsize=16)
def pressure(cycle: int, strokes: int) -> list[Real]:
    """Return a pressure over two turns of its crank from the top dead centre at which it fires."""
    orders = range(0, PRESSURES, 1 if strokes == 4 else 2)
    parts = [(j, mp.sin(2 * j + 1 + 50 * cycle), mp.sin(2 * j + 2 + 50 * cycle)) for j in orders]
    found = []
    for k in range(2 * SAMPLES):
        waves = [turned(Fraction(j * k % (2 * SAMPLES), 2 * SAMPLES)) for j, _, _ in parts]
        both = zip(parts, waves, strict=True)
        found.append(mp.fsum(c * wave.real + s * wave.imag for (_, c, s), wave in both))
    return found


@lru_cache(maxsize=4096)
def gas(rod: Fraction, offset: Fraction, cycle: int, halves: int, strokes: int) -> Complex:
    """Return the phasor of the roll of a pressure, over area and radius, at an order in halves."""
    velocities = [velocity for velocity, _, _, _ in motion(rod, offset)] * 2
    pairs = zip(pressure(cycle, strokes), velocities, strict=True)
    return _harmonic([acting * velocity for acting, velocity in pairs], halves, 2)


class Sums:
    """Sums of an order in halves of crank speed, by quantity and component as in the proofs."""

    def __init__(
        self,
        places: Sequence[Place],
        weights: Sequence[Weight],
        halves: int,
        plane: Fraction,
        strokes: int = 4,
    ) -> None:
        """Add up an engine's loads about a plane."""
        with mp.workdps(DIGITS + 10):
            self._terms: dict[tuple[str, str], list[Complex]] = {}
            for place in places:
                self._piston(place, halves, plane)
                if place.cycle is not None:
                    self._pressure(place, place.cycle, halves, strokes)
            masses = [
                Weight(
                    place.turning * place.piston.radius,
                    place.bank - place.ratio * place.tdc,
                    place.z,
                    place.ratio,
                    place.axis,
                )
                for place in places
            ]
            for weight in [*masses, *weights]:
                if weight.amount and halves == 2 * abs(weight.ratio):
                    unit = turned(weight.direction * (1 if weight.ratio > 0 else -1) % 1)
                    unit *= real(weight.amount) * weight.ratio**2
                    sense = 1 if weight.ratio > 0 else -1
                    self._force(unit, -1j * sense * unit, weight.z - plane, weight.axis)

    def _add(self, quantity: str, component: str, *terms: Complex) -> None:
        self._terms.setdefault((quantity, component), []).extend(terms)

    def _force(
        self, x: Complex, y: Complex, lever: Fraction, axis: tuple[Fraction, Fraction]
    ) -> None:
        z = real(lever)
        for quantity, (a, b) in {"force": (x, y), "moment": (-z * y, z * x)}.items():
            self._add(quantity, "x", a)
            self._add(quantity, "y", b)
            self._add(quantity, "forward", a, 1j * b)
            self._add(quantity, "backward", a, -1j * b)
        if axis[0]:
            self._add("torque", "z", real(axis[0]) * y)
        if axis[1]:
            self._add("torque", "z", -real(axis[1]) * x)

    def _piston(self, place: Place, halves: int, plane: Fraction) -> None:
        own, beside = divmod(halves, 2 * abs(place.ratio))
        if beside:
            return
        radius, rod, mass, offset, rod_inertia = place.piston
        force, piston, leaning = inertia(rod / radius, offset / radius, own)
        phase = place.ratio**2 * turned(-place.tdc * halves / 2 % 1)
        along = real(mass * radius) * force * phase
        bore = turned(place.bank % 1)
        self._force(bore.real * along, bore.imag * along, place.z - plane, place.axis)
        sense = 1 if place.ratio > 0 else -1
        roll = (real(mass * radius**2) * piston, real(rod_inertia) * leaning)
        self._add("torque", "z", *(sense * phase * part for part in roll))

    def _pressure(self, place: Place, cycle: int, halves: int, strokes: int) -> None:
        own, beside = divmod(halves, abs(place.ratio))
        if beside:
            return
        radius, rod, _, offset, _ = place.piston
        harmonic = gas(rod / radius, offset / radius, cycle, own, strokes)
        fire = place.tdc + Fraction(place.later, abs(place.ratio))
        factor = real(place.area * radius) * (1 if place.ratio > 0 else -1)
        self._add("gas_torque", "z", factor * harmonic * turned(-fire * halves / 2 % 1))

    def value(self, quantity: str, component: str) -> Complex:
        """Return the phasor of a sum (twice a forward or backward part)."""
        with mp.workdps(DIGITS + 10):
            return mp.fsum(self._terms.get((quantity, component), []))

    def is_zero(self, quantity: str, component: str) -> bool:
        """Return whether a sum is zero."""
        terms = self._terms.get((quantity, component), [])
        with mp.workdps(DIGITS + 10):
            size = mp.fsum(abs(term.real) + abs(term.imag) for term in terms)
            left = abs(mp.fsum(terms))
            if left <= ZERO * size:
                return True
            if left < NOT_ZERO * size:
                raise ArithmeticError(
                    f"{quantity} {component}: {mp.nstr(left / size)} of its terms"
                )
            return False
