"""Measured cycles again: plain sums over their points. Imports nothing of crankpin.

Angles are degrees from the firing top dead centre, on an even grid of one period; ``crank`` is
crank radius, rod length and pin offset, m.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rederivation.pressure import height, slope

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Crank = tuple[float, float, float]


def travel(crank: Crank) -> float:
    """Return the way of the piston between its ends, whose crank and rod are in line."""
    r, rod, e = crank
    return float(np.sqrt((rod + r) ** 2 - e**2) - np.sqrt((rod - r) ** 2 - e**2))


def heat_rate(
    theta: Array, pressure: Array, crank: Crank, bore: float, ratio: float, g: float
) -> Array:
    """Return apparent net heat release by its differential form, J/°, from slopes of p and V."""
    r, rod, e = crank
    piston = np.pi / 4.0 * bore**2
    low = np.sqrt((rod + r) ** 2 - e**2)
    volume = piston * (low - height(np.radians(theta), r, rod, e) + travel(crank) / (ratio - 1.0))
    dv, dp = (np.gradient(each, theta, edge_order=2) for each in (volume, pressure))
    return np.asarray(g / (g - 1.0) * pressure * dv + volume * dp / (g - 1.0))


def imep(theta: Array, pressure: Array, crank: Crank) -> Array:
    """Return −∮p dx over the travel, by trapezes over the piston's way; a row for each cycle."""
    x = height(np.radians(np.append(theta, theta[0])), *crank)
    closed = np.column_stack([pressure, pressure[:, :1]])
    return np.asarray(-np.trapezoid(closed, x, axis=1) / travel(crank))


def cov(values: Array) -> float:
    """Return the deviation over the mean, of n − 1 differences."""
    mean = values.sum() / len(values)
    return float(np.sqrt(((values - mean) ** 2).sum() / (len(values) - 1)) / mean)


def torque_phasors(
    theta: Array, pressure: Array, orders: Sequence[float], crank: Crank, bore: float
) -> NDArray[np.complex128]:
    """Return peak phasors of −(p − 101325)·A·dx/dθ, sums over the points."""
    angle = np.radians(theta)
    torque = -(pressure - 101325.0) * np.pi / 4 * bore**2 * slope(angle, *crank)
    return np.array(2.0 / len(theta) * torque @ np.exp(-1j * np.outer(angle, orders)))


def noise_of_phasors(noise: float, theta: Array, crank: Crank, bore: float) -> float:
    """Return the deviation in the plane of a torque phasor from white noise of a deviation.

    Its parts are sums of independent numbers: their variances add.
    """
    weights = np.pi / 4 * bore**2 * slope(np.radians(theta), *crank)
    return float(2.0 / len(theta) * noise * np.sqrt((weights**2).sum()))


# --- what an indicating system would have measured ------------------------------------------------


def relative_volume(theta: Array, crank: Crank, compression_ratio: float) -> Array:
    """Return V/V_c from the piston's way down."""
    r, rod, e = crank
    down = np.sqrt((rod + r) ** 2 - e**2) - height(np.radians(theta), *crank)
    return np.asarray(1.0 + (compression_ratio - 1.0) * down / travel(crank))


def burnt(theta: Array, crank: Crank, compression_ratio: float, n: float, rise: float) -> Array:
    """Return pressure, Pa: 1 bar to −140°, compressed by V⁻ⁿ, times a burn, blown down from 130°.

    The burn multiplies p·Vⁿ by up to 1 + ``rise`` from −15° to 45°, as a smooth step.
    """
    wrapped = (theta + 360.0) % 720.0 - 360.0
    volume = relative_volume(wrapped, crank, compression_ratio)
    closes = relative_volume(np.array([-140.0]), crank, compression_ratio)[0]
    y = np.clip((wrapped + 15.0) / 60.0, 0.0, 1.0)
    pressure = 1e5 * (closes / volume) ** n * (1.0 + rise * y**2 * (3.0 - 2.0 * y))
    opened = np.clip((wrapped - 130.0) / 50.0, 0.0, 1.0)
    fading = 0.5 + 0.5 * np.cos(np.pi * opened)
    pressure = 1e5 + (pressure - 1e5) * fading
    return np.where((wrapped < -140.0) | (wrapped > 180.0), 1e5, pressure)


def motored(theta: Array, crank: Crank, compression_ratio: float, n: float, loss: float) -> Array:
    """Return pressure that loses heat about the top dead centre, Pa: a slope, whose peak is early.

    p·Vⁿ falls by ``loss`` over 60°, linearly through the centre.
    """
    wrapped = (theta + 360.0) % 720.0 - 360.0
    pressure = burnt(wrapped, crank, compression_ratio, n, 0.0)
    return np.asarray(pressure * (1.0 - loss * np.clip(wrapped / 60.0 + 0.5, 0.0, 1.0)))


def motored_peak(crank: Crank, compression_ratio: float, n: float, loss: float) -> float:
    """Return the angle of that peak, by a fine grid: the loss angle, below zero."""
    fine = np.linspace(-5.0, 5.0, 200_001)
    return float(fine[motored(fine, crank, compression_ratio, n, loss).argmax()])


def offset_of_two_points(
    theta: Array, pressure: Array, crank: Crank, compression_ratio: float, n: float
) -> float:
    """Return what is to be added to a pressure that is p·Vⁿ = constant at −100° and −60°.

    p₂ + Δ = (p₁ + Δ)·(V₁/V₂)ⁿ.
    """
    k = [int(np.abs(theta - at).argmin()) for at in (-100.0, -60.0)]
    v1, v2 = relative_volume(theta[k], crank, compression_ratio)
    p1, p2 = pressure[k]
    ratio = (v1 / v2) ** n
    return float((p2 - ratio * p1) / (ratio - 1.0))


# --- what prepares a measured trace ---------------------------------------------------------------


def compression_peak(theta: Array, pressure: Array, period: float) -> float:
    """Return the angle of the peak of a polynomial of degree 6 within 20° of the largest value."""
    half, largest = period / 2.0, float(theta[pressure.argmax()])
    away = (theta - largest + half) % period - half
    near = np.abs(away) <= 20.0
    fit = np.polynomial.Polynomial.fit(away[near], pressure[near], 6)
    roots = fit.deriv().roots()
    inside = roots[(abs(roots.imag) < 1e-9) & (abs(roots.real) < 20.0)].real
    return float(largest + inside[fit(inside).argmax()])


def polytropic_offsets(pressure: Array, volume: Array, n: float) -> Array:
    """Return what is to be added to rows that are ``C·V⁻ⁿ``: least squares of two columns."""
    matrix = np.column_stack([np.ones(len(volume)), volume**-n])
    return np.asarray(-np.linalg.lstsq(matrix, pressure.T, rcond=None)[0][0])


def fitted_exponent(pressure: Array, volume: Array) -> float:
    """Return the exponent from 1.15 to 1.45 that leaves the least squares, by a polynomial."""

    def left(n: float) -> float:
        matrix = np.column_stack([np.ones(len(volume)), volume**-n])
        solved, *_ = np.linalg.lstsq(matrix, pressure, rcond=None)
        return float(((matrix @ solved - pressure) ** 2).sum())

    ends = (1.15, 1.45)
    curve = np.polynomial.Chebyshev.interpolate(
        lambda exponents: np.array([left(n) for n in exponents]), 16, ends
    )
    roots = curve.deriv().roots()
    real = roots.real[abs(roots.imag) < 1e-9]
    return float(min(np.clip([*ends, *real], *ends), key=curve))


def low_passed(rows: Array, period: float, order: float) -> Array:
    """Return rows, one after the other, through Butterworth's filter of order 4, both ways."""
    spectrum = np.fft.rfft(rows.ravel())
    turns = np.fft.rfftfreq(rows.size, 1.0 / rows.shape[1]) * 360.0 / period
    smooth = np.fft.irfft(spectrum / (1.0 + (turns / order) ** 8), rows.size)
    return np.asarray(smooth.reshape(rows.shape))
