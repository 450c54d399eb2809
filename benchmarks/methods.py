"""How else would one compute it? The methods that others use, each with the knob it is turned by.

Harmonics: :data:`HARMONICS` lists methods that all answer one question, the coefficients aₙ of a
slider-crank's inertia force over m·r·ω², for many rod ratios λ at once. A method is called as
``method(rod_ratios, orders, knob)``, or with the pin offsets over r behind that, and returns an
array (n_rod_ratios, n_orders): float64, or complex128 where offsets are given. What a method cannot
give is NaN: an offset it knows nothing of, an order beyond its samples. ``method.knobs`` are the
settings worth trying, from cheap to dear; ``method.knob`` says what they are.

Sums, peaks, waveforms and searches: functions of plain arrays, further down.

Nothing here is careful beyond what its source is: these are the methods to compare with.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import crankpin as cp
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Method(NamedTuple):
    """One way to the harmonics of a slider-crank."""

    name: str
    knob: str
    """what the knob is; empty where there is none"""
    knobs: tuple[Any, ...]
    """settings from cheap to dear, (None,) where there is no knob"""
    function: Callable[..., Any]
    takes_offsets: bool = False

    def __call__(
        self,
        rod_ratios: ArrayLike,
        orders: Sequence[int],
        knob: Any = None,  # noqa: ANN401 - each method has its own
        offsets: ArrayLike | None = None,
    ) -> NDArray[Any]:
        """Return aₙ, (n_rod_ratios, n_orders); NaN where the method has no answer."""
        ratios = np.atleast_1d(np.asarray(rod_ratios, dtype=float))
        with np.errstate(all="ignore"):
            if offsets is None:
                return np.asarray(self.function(ratios, orders, knob))
            if not self.takes_offsets:
                return np.full((len(ratios), len(orders)), np.nan + 0j)
            pins = np.broadcast_to(np.asarray(offsets, dtype=float), ratios.shape)
            return np.asarray(self.function(ratios, orders, knob, pins))


def _columns(ratios: Array, orders: Sequence[int], even: Callable[[int], Array]) -> Array:
    """Give odd orders their values without offset, even ones those of a function."""
    table = np.zeros((len(ratios), len(orders)))
    for column, n in enumerate(orders):
        table[:, column] = even(n) if n % 2 == 0 else float(n == 1)
    return table


# --- harmonics ------------------------------------------------------------------------------------


@lru_cache
def series_coefficients(order: int, terms: int) -> tuple[float, ...]:
    """Coefficients of λⁿ⁻¹, λⁿ⁺¹, … of an even order, so many.

    a₂ = λ + λ³/4 + 15λ⁵/128 + …, a₄ = −λ³/4 − 3λ⁵/16 − …; one term of each is what most texts use
    (Taylor, *The Internal Combustion Engine*, vol. 2; Biezeno and Grammel, *Technische Dynamik*).
    """
    m = order // 2
    found = []
    for k in range(m, m + terms):
        # sin²ᵏθ holds cos 2mθ 2(−1)ᵐ binom(2k, k − m)/4ᵏ times
        weight = 2.0 * (-1) ** (k + m) * float(special.binom(0.5, k))
        weight *= math.exp(math.log(math.comb(2 * k, k - m)) - k * math.log(4.0))
        found.append(order**2 * weight)
    return tuple(found)


def series(ratios: Array, orders: Sequence[int], terms: int) -> Array:
    """Textbook series in λ: √(1 − λ² sin²θ) by the binomial theorem, so many terms to an order."""
    square = ratios * ratios

    def even(n: int) -> Array:
        total = np.zeros_like(ratios)
        for coefficient in reversed(series_coefficients(n, terms)):
            total *= square
            total += coefficient
        return np.asarray(total * ratios ** (n - 1))

    return _columns(ratios, orders, even)


def series_in_python(ratios: Array, orders: Sequence[int], terms: int) -> list[list[float]]:
    """Sum the same series in plain Python, one rod ratio after the other."""
    rows = []
    for ratio in ratios.tolist():
        row = []
        for n in orders:
            if n % 2:
                row.append(float(n == 1))
                continue
            total = 0.0
            for coefficient in reversed(series_coefficients(n, terms)):
                total = total * ratio * ratio + coefficient
            row.append(total * ratio ** (n - 1))
        rows.append(row)
    return rows


def _turn(samples: int, ratios: Array, offsets: Array | None) -> tuple[Array, Array, Array]:
    """Crank angles, (r sin θ − e)/r, and height of the rod over r: (n_rod_ratios, samples)."""
    theta = 2 * np.pi * np.arange(samples) / samples
    rods = 1 / ratios[:, None]
    if offsets is None:
        return theta, np.sin(theta)[None], np.sqrt(rods**2 - np.sin(theta) ** 2)
    lateral = np.sin(theta) - offsets[:, None]
    return theta, lateral, np.sqrt(rods**2 - lateral**2)


def _transformed(
    samples: Array, orders: Sequence[int], offsets: Array | None, power: int
) -> NDArray[Any]:
    """Order n of a transform, nᵖ times, plus the crank's own first order."""
    count = samples.shape[1]
    seen = [column for column, n in enumerate(orders) if 2 * n < count]
    table = np.full((len(samples), len(orders)), np.nan + 0j)
    n = np.array([orders[column] for column in seen], dtype=int)
    table[:, seen] = np.fft.rfft(samples)[:, n] * (n.astype(float) ** power * 2 / count)
    table[:, n_is_one(orders)] += 1
    return table.real.copy() if offsets is None else table


def n_is_one(orders: Sequence[int]) -> list[bool]:
    """Mark order 1, which the crank has by itself."""
    return [n == 1 for n in orders]


def _in_blocks(
    transform: Callable[[Array, Array | None], NDArray[Any]],
    ratios: Array,
    samples: int,
    offsets: Array | None,
) -> NDArray[Any]:
    """Transform as many rod ratios at a time as stay in the cache: 128 kB of samples."""
    rows = max(1, 16384 // samples)
    parts = range(0, len(ratios), rows)
    return np.concatenate(
        [
            transform(ratios[k : k + rows], None if offsets is None else offsets[k : k + rows])
            for k in parts
        ]
    )


def fft_positions(
    ratios: Array, orders: Sequence[int], samples: int, offsets: Array | None = None
) -> NDArray[Any]:
    """Transform so many samples of the rod's height, n² times.

    Rounding of the position, 1/λ, goes into every order alike: order n loses it n²/aₙ times.
    """

    def transform(ratios: Array, offsets: Array | None) -> NDArray[Any]:
        _, _, height = _turn(samples, ratios, offsets)
        return _transformed(height, orders, offsets, 2)

    return _in_blocks(transform, ratios, samples, offsets)


def fft_accelerations(
    ratios: Array, orders: Sequence[int], samples: int, offsets: Array | None = None
) -> NDArray[Any]:
    """Transform so many samples of the rod's part of the acceleration, −h''."""

    def transform(ratios: Array, offsets: Array | None) -> NDArray[Any]:
        theta, lateral, height = _turn(samples, ratios, offsets)
        # h h' = −u u', h h'' = −u'² − u u'' − h'² with u = sin θ − e/r
        slope = -lateral * np.cos(theta) / height
        bend = (np.cos(theta) ** 2 - lateral * np.sin(theta) + slope**2) / height
        return _transformed(bend, orders, offsets, 0)

    return _in_blocks(transform, ratios, samples, offsets)


def _first_two(ratios: Array) -> tuple[Array, Array]:
    """Fourier coefficients c₀, c₁ of √(1 − λ² sin²θ) = c₀ + 2 Σ c_m cos 2mθ.

    (2/π)E and (2/π)((2 − λ²)E − 2(1 − λ²)K)/(3λ²), by Gradshteyn and Ryzhik 2.583.
    """
    m = ratios**2
    e, k = special.ellipe(m), special.ellipk(m)
    return 2 / np.pi * e, 2 / np.pi * ((2 - m) * e - 2 * (1 - m) * k) / (3 * m)


def recurrence_upwards(ratios: Array, orders: Sequence[int], _knob: None = None) -> Array:
    """Take E and K from SciPy for orders 0 and 2, the others by the three-term recurrence.

    β(2m + 3)c_{m+1} + 4αm c_m + β(2m − 3)c_{m−1} = 0 with α = 1 − λ²/2, β = λ²/2, from
    2 D d' = D' d for d = √D. Upwards it amplifies rounding by p⁻²ⁿ.
    """
    m2 = ratios**2
    alpha, beta = 1 - m2 / 2, m2 / 2
    c = list(_first_two(ratios))
    for m in range(1, max(orders) // 2):
        c.append(-(4 * alpha * m * c[m] + beta * (2 * m - 3) * c[m - 1]) / (beta * (2 * m + 3)))
    return _columns(ratios, orders, lambda n: 2 * n * n * c[n // 2] / ratios)


def recurrence_downwards(ratios: Array, orders: Sequence[int], ahead: int) -> Array:
    """Run the same recurrence downwards from so many terms above the highest order.

    J. C. P. Miller's way, scaled by c₀ = (2/π)E. Stable, but it must begin where the coefficients
    have decayed: 13 000 000 terms above at λ = 1 − 1e-12.
    """
    m2 = ratios**2
    alpha, beta = 1 - m2 / 2, m2 / 2
    top = max(orders) // 2
    above, here = np.zeros_like(ratios), np.full_like(ratios, 1e-300)
    kept: dict[int, Array] = {}
    for m in range(top + ahead, 0, -1):
        below = -(4 * alpha * m * here + beta * (2 * m + 3) * above) / (beta * (2 * m - 3))
        above, here = here, below
        if m <= top + 1:
            kept[m - 1] = here
        size = np.abs(here)
        scale = np.where(size > 1e200, 1 / size, 1.0)
        if np.any(scale != 1.0):
            above, here = above * scale, here * scale
            kept = {k: v * scale for k, v in kept.items()}
    start = 2 / np.pi * special.ellipe(m2) / kept[0]
    return _columns(ratios, orders, lambda n: 2 * n * n * kept[n // 2] * start / ratios)


def hypergeometric(ratios: Array, orders: Sequence[int], _knob: None = None) -> Array:
    """Sum Gauss's hypergeometric function of λ² by SciPy, one call an order.

    aₙ = ±2n²|binom(½, m)| 4⁻ᵐ λⁿ⁻¹ ₂F₁(m − ½, m + ½; n + 1; λ²), n = 2m.
    """

    def even(n: int) -> Array:
        m = n // 2
        leading = (-1) ** (m + 1) * n**2 * abs(special.binom(0.5, m)) * 2 / 4.0**m
        gauss = special.hyp2f1(m - 0.5, m + 0.5, n + 1, ratios**2)
        return np.asarray(leading * ratios ** (n - 1) * gauss)

    return _columns(ratios, orders, even)


def crankpin(
    ratios: Array, orders: Sequence[int], rtol: float | None = None, offsets: Array | None = None
) -> NDArray[Any]:
    """Ask crankpin, for all digits or within a tolerance."""
    if offsets is None:
        return cp.slider_crank_harmonics(ratios, orders, rtol=rtol)
    return cp.slider_crank_harmonics(ratios, orders, offsets)


SAMPLES = (8, 16, 32, 64, 128, 256, 512, 1024)
HARMONICS = (
    Method("series in λ", "terms", tuple(range(1, 13)), series),
    Method("FFT of positions", "samples", SAMPLES, fft_positions, takes_offsets=True),
    Method("FFT of accelerations", "samples", SAMPLES, fft_accelerations, takes_offsets=True),
    Method("elliptic integrals, recurrence up", "", (None,), recurrence_upwards),
    Method("recurrence down", "terms ahead", (2, 4, 8, 16, 32, 64, 128, 256), recurrence_downwards),
    Method("hyp2f1", "", (None,), hypergeometric),
    Method("crankpin", "", (None,), crankpin, takes_offsets=True),
)
"""Every method for harmonics, ours last."""


# --- sums over the cylinders ----------------------------------------------------------------------


def phasor_sum(
    weights: ArrayLike, banks_deg: ArrayLike, tdcs_deg: ArrayLike, order: int
) -> Complex:
    """Σ w e^{−in·tdc} (cos bank, sin bank) in plain doubles: (2,)."""
    w, bank, tdc = (np.asarray(v, dtype=float) for v in (weights, banks_deg, tdcs_deg))
    terms = w * np.exp(-1j * order * np.radians(tdc))
    bores = np.radians(bank)
    return np.array([(terms * np.cos(bores)).sum(), (terms * np.sin(bores)).sum()])


def thresholded(values: Complex, tolerance: float) -> Complex:
    """Take what is below a tolerance for zero, as ``np.isclose`` would."""
    return np.where(np.abs(values) <= tolerance, 0.0, values)


def order_of_samples(values: ArrayLike, order: int) -> complex:
    """Peak phasor of an order in samples of a turn; higher orders fold back into it."""
    samples = np.asarray(values, dtype=float)
    turn = np.exp(-2j * np.pi * order * np.arange(len(samples)) / len(samples))
    return complex((samples * turn).sum() * 2 / len(samples))


# --- peaks ----------------------------------------------------------------------------------------


def sampled_peak(orders: Sequence[int], phasors: ArrayLike, samples: int) -> float:
    """Largest magnitude of Re Σ P e^{inθ} among so many crank angles, from θ = 0."""
    theta = 2 * np.pi * np.arange(samples) / samples
    waves = np.exp(1j * np.outer(theta, np.asarray(orders)))
    return float(np.abs((waves @ np.asarray(phasors)).real).max())


# --- equality of magnitudes in the search ---------------------------------------------------------


def equal_magnitude_pairs(moments: Complex, tolerance: float) -> int:
    """Count the pairs of arrangements whose |Z|² differ by at most the tolerance, in doubles.

    A tolerance of 0 is comparing with ==. ``moments`` are Z, one for each arrangement.
    """
    squares = np.sort((moments * moments.conj()).real)
    above = np.searchsorted(squares, squares + tolerance, side="right")
    below = np.searchsorted(squares, squares - tolerance, side="left")
    return int((above - below).sum())


def polished_peak(orders: Sequence[int], phasors: ArrayLike, samples: int) -> float:
    """Find the same, the highest sample polished by Newton's method on the slope."""
    p, n = np.asarray(phasors), np.asarray(orders)

    def jet(theta: float) -> list[float]:
        terms = p * np.exp(1j * n * theta)
        return [float((terms * (1j * n) ** k).sum().real) for k in range(3)]

    grid = 2 * np.pi * np.arange(samples) / samples
    here = float(grid[np.argmax([abs(jet(theta)[0]) for theta in grid])])
    for _ in range(50):
        _, slope, bend = jet(here)
        if bend == 0:
            break
        here -= slope / bend
    return abs(jet(here)[0])
