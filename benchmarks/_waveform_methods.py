"""Waveforms of many V8s as one would write them in NumPy and numba, and in 50 digits."""

# ruff: noqa: ANN001, ANN202 - numba takes no annotations

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mpmath
import numba
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import crankpin as cp

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scene:
    """One layout with many rods, at one speed."""

    engine: cp.Engine
    ratios: Array
    theta_deg: Array
    rpm: float

    @property
    def radius(self) -> float:
        """Crank radius, m."""
        return self.engine.cylinders[0].crank_radius

    @property
    def force(self) -> float:
        """m·r·ω² of a cylinder."""
        omega = 2 * np.pi * self.rpm / 60
        return self.engine.cylinders[0].reciprocating_mass * self.radius * omega**2

    @property
    def levers(self) -> Array:
        """Levers about the middle, m."""
        z = self.engine.z
        return np.asarray(z - 0.5 * (z.min() + z.max()))


def numpy_exact(scene: Scene) -> tuple[Array, Array]:
    """Exact kinematics: sines once for each cylinder, the rest for all engines at once."""
    inverse = 1.0 / scene.ratios[:, None]
    shape = (len(scene.ratios), len(scene.theta_deg), 2)
    force, moment = np.zeros(shape), np.zeros(shape)
    for tdc, bank, lever in zip(
        np.radians(scene.engine.tdc_deg),
        np.radians(scene.engine.bank_deg),
        scene.levers,
        strict=True,
    ):
        local = np.radians(scene.theta_deg) - tdc
        sin, cos = np.sin(local), np.cos(local)
        height = np.sqrt(inverse**2 - sin**2)
        along = scene.force * (cos + (cos**2 - sin**2) / height + (sin * cos) ** 2 / height**3)
        x, y = along * np.cos(bank), along * np.sin(bank)
        force[..., 0] += x
        force[..., 1] += y
        moment[..., 0] -= lever * y
        moment[..., 1] += lever * x
    return force, moment


def numpy_orders(scene: Scene, count: int, samples: int = 64) -> tuple[Array, Array]:
    """Sum the first so many orders 1, 2, 4, 6 …: harmonics by FFT, then a matrix product."""
    orders = np.array([1, *range(2, 2 * count, 2)])[:count]
    crank = 2 * np.pi * np.arange(samples) / samples
    sin, cos = np.sin(crank), np.cos(crank)
    height = np.sqrt(scene.ratios[:, None] ** -2 - sin**2)
    acceleration = cos + (cos**2 - sin**2) / height + (sin * cos) ** 2 / height**3
    harmonics = 2 / samples * np.fft.rfft(acceleration).real[:, orders]
    phases = np.exp(-1j * np.outer(orders, np.radians(scene.engine.tdc_deg)))
    turns = np.outer(np.radians(scene.theta_deg), orders)
    table = np.concatenate([np.cos(turns), -np.sin(turns)], axis=1).T
    bank = np.radians(scene.engine.bank_deg)
    results = []
    for x, y in (
        (np.cos(bank), np.sin(bank)),
        (-scene.levers * np.sin(bank), scene.levers * np.cos(bank)),
    ):
        result = np.empty((len(scene.ratios), len(scene.theta_deg), 2))
        for axis, weights in enumerate((x, y)):
            phasors = scene.force * harmonics * (phases @ weights)
            result[..., axis] = np.concatenate([phasors.real, phasors.imag], axis=1) @ table
        results.append(result)
    return results[0], results[1]


@numba.njit(parallel=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _numba_plain(ratios, theta, tdc, bank, levers, scale):
    force = np.empty((len(ratios), len(theta), 2))
    moment = np.empty((len(ratios), len(theta), 2))
    cos_bank, sin_bank = np.cos(bank), np.sin(bank)
    for k in numba.prange(len(ratios)):
        square = 1.0 / ratios[k] ** 2
        for j in range(len(theta)):
            fx = fy = mx = my = 0.0
            for i in range(len(tdc)):
                sin, cos = np.sin(theta[j] - tdc[i]), np.cos(theta[j] - tdc[i])
                inverse = 1.0 / np.sqrt(square - sin * sin)
                crossed = sin * cos * inverse
                along = scale * (cos + (cos * cos - sin * sin + crossed * crossed) * inverse)
                x, y = along * cos_bank[i], along * sin_bank[i]
                fx += x
                fy += y
                mx -= levers[i] * y
                my += levers[i] * x
            force[k, j, 0], force[k, j, 1] = fx, fy
            moment[k, j, 0], moment[k, j, 1] = mx, my
    return force, moment


@numba.njit(parallel=True, error_model="numpy", fastmath=True)  # type: ignore[untyped-decorator]
def _numba_hoisted(ratios, theta, tdc, bank, levers, scale):
    force = np.empty((len(ratios), len(theta), 2))
    moment = np.empty((len(ratios), len(theta), 2))
    count, angles = len(tdc), len(theta)
    sin, cos = np.empty((count, angles)), np.empty((count, angles))
    for i in range(count):
        sin[i], cos[i] = np.sin(theta - tdc[i]), np.cos(theta - tdc[i])
    cos_bank, sin_bank = np.cos(bank), np.sin(bank)
    for k in numba.prange(len(ratios)):
        square = 1.0 / ratios[k] ** 2
        sums = np.zeros((4, angles))
        for i in range(count):
            x, y = scale * cos_bank[i], scale * sin_bank[i]
            for j in range(angles):
                s, c = sin[i, j], cos[i, j]
                inverse = 1.0 / np.sqrt(square - s * s)
                crossed = s * c * inverse
                along = c + (c * c - s * s + crossed * crossed) * inverse
                sums[0, j] += x * along
                sums[1, j] += y * along
                sums[2, j] -= levers[i] * y * along
                sums[3, j] += levers[i] * x * along
        for j in range(angles):
            force[k, j, 0], force[k, j, 1] = sums[0, j], sums[1, j]
            moment[k, j, 0], moment[k, j, 1] = sums[2, j], sums[3, j]
    return force, moment


def _lists(scene: Scene) -> tuple[Array, Array, Array, Array, Array, float]:
    return (
        scene.ratios,
        np.radians(scene.theta_deg),
        np.radians(scene.engine.tdc_deg),
        np.radians(scene.engine.bank_deg),
        scene.levers,
        scene.force,
    )


def numba_plain(scene: Scene) -> tuple[Array, Array]:
    """Exact kinematics in three loops, all cores."""
    return _numba_plain(*_lists(scene))  # type: ignore[no-any-return]


def numba_hoisted(scene: Scene) -> tuple[Array, Array]:
    """Exact kinematics, sines taken once for all engines, loops that vectorise, all cores."""
    return _numba_hoisted(*_lists(scene))  # type: ignore[no-any-return]


def reference(scene: Scene, engines: list[int], angles: list[int]) -> tuple[Array, Array]:
    """Force and moment at some engines and angles, in 50 digits: (engines, angles, 2)."""
    shape = (len(engines), len(angles), 2)
    force, moment = np.empty(shape), np.empty(shape)
    with mpmath.workdps(50):
        degree = mpmath.pi / 180
        scale = mpmath.mpf(scene.force)
        for a, k in enumerate(engines):
            square = 1 / mpmath.mpf(scene.ratios[k]) ** 2
            for b, j in enumerate(angles):
                sums = [mpmath.mpf(0)] * 4
                for tdc, bank, lever in zip(
                    scene.engine.tdc_deg, scene.engine.bank_deg, scene.levers, strict=True
                ):
                    local = (mpmath.mpf(scene.theta_deg[j]) - mpmath.mpf(tdc)) * degree
                    sin, cos = mpmath.sin(local), mpmath.cos(local)
                    height = mpmath.sqrt(square - sin**2)
                    along = scale * (
                        cos + (cos**2 - sin**2) / height + (sin * cos) ** 2 / height**3
                    )
                    x = along * mpmath.cos(mpmath.mpf(bank) * degree)
                    y = along * mpmath.sin(mpmath.mpf(bank) * degree)
                    terms = (x, y, -mpmath.mpf(lever) * y, mpmath.mpf(lever) * x)
                    sums = [total + term for total, term in zip(sums, terms, strict=True)]
                force[a, b], moment[a, b] = sums[:2], sums[2:]
    return force, moment
