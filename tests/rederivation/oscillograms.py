"""Oscillograms again: a crank of known motion, its channels, and speed from a whole wheel's pulses.

Imports nothing of crankpin. Crank angles are degrees after a dead centre; the index is at -114°.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

INDEX_DEG = -114.0


class Motion(NamedTuple):
    """A crank whose speed is known over its angle."""

    rpm: float
    waver: Mapping[float, complex]
    """Order → peak phasor of speed over ``rpm``."""

    def speed(self, theta: Array) -> Array:
        """Return the speed at crank angles, rpm."""
        phases = ((n, phasor) for n, phasor in self.waver.items())
        waves = sum((p * np.exp(1j * n * np.radians(theta))).real for n, p in phases)
        return np.asarray(self.rpm * (1.0 + waves + np.zeros(np.shape(theta))))

    def angles(self, times: Array, start: float = -1000.0) -> Array:
        """Return crank angles at times, by a quadrature in steps of 0.02°."""
        theta = start + np.arange(0.0, 7.0 * self.rpm * (times[-1] + 0.1) + 10.0, 0.02)
        slowness = 1.0 / (6.0 * self.speed(theta))
        passed = np.append(0.0, np.cumsum(0.01 * (slowness[1:] + slowness[:-1])))
        return np.asarray(np.interp(times, passed, theta))


def teeth(theta: Array, places: int, missing: int) -> Array:
    """Return an encoder's signal, V: teeth of half a place, the last ones of a turn missing."""
    step = 360.0 / places
    local = (theta - INDEX_DEG) % 360.0
    return np.asarray(5.0 * ((local % step < step / 2.0) & (local // step < places - missing)))


def marks(theta: Array, period: float) -> Array:
    """Return the signal of an index, V: 3° once a period."""
    return np.asarray(5.0 * ((theta - INDEX_DEG) % period < 3.0))


def pressure(theta: Array) -> Array:
    """Return a smooth pressure that peaks once a cycle, Pa, whose slope shows the crank angle."""
    return np.asarray(1e6 * (1.2 + np.cos(np.radians(theta) / 2.0)) ** 2)


def slope(theta: Array) -> Array:
    """Return its slope over the crank angle, Pa/°."""
    half = np.radians(theta) / 2.0
    return np.asarray(-1e6 * (1.2 + np.cos(half)) * np.sin(half) * np.pi / 180.0)


def speed_phasors(times: Array, order: float, cycle_turns: int) -> complex:
    """Return the mean peak phasor of speed, rpm, from times of equal angles, whole cycles of them.

    The times' Fourier series over a cycle is differentiated, and its reciprocal taken; the phase
    is from the first of the angles.
    """
    per_cycle = (len(times) - 1) // round((times[-1] - times[0]) / np.median(np.diff(times)) / 120)
    phasors = []
    for k in range(0, len(times) - per_cycle, per_cycle):
        one = times[k : k + per_cycle]
        length = times[k + per_cycle] - times[k]
        late = one - times[k] - length * np.arange(per_cycle) / per_cycle
        spectrum = np.fft.rfft(late)
        spectrum[48:] = 0.0
        harmonics = np.arange(len(spectrum))
        slowness = length + np.fft.irfft(2j * np.pi * harmonics * spectrum, per_cycle)
        speed = 60.0 * cycle_turns / slowness
        turned = np.exp(-2j * np.pi * order * cycle_turns * np.arange(per_cycle) / per_cycle)
        phasors.append(2.0 * (speed * turned).mean())
    return complex(np.mean(phasors))
