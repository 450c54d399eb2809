"""How fast are harmonics of many link rods, and how accurate where lengths are extreme?

``python benchmarks/link_rods.py`` compares orders 1 to 6 of all links of random stars with NumPy's
FFT of 96 samples each, in one run, and shows both beside 50 digits at the limits.
"""

from __future__ import annotations

import argparse
from functools import partial

import crankpin as cp
import mpmath
import numpy as np
from _timing import interleaved, machine

ORDERS = [1, 2, 3, 4, 5, 6]
SAMPLES = 96
PART = 2000
"""Link rods that NumPy transforms at once: their samples stay in the cache."""

LIMITS: dict[str, tuple[float, ...]] = {
    "knuckle on the crankpin, a/r = 1e-9": (0.33, 0.26, 1e-9, 72.0, 79.0),
    "knuckle at the wrist pin, a = l": (0.1, 0.26, 1 / 0.26, 20.0, 20.0),
    "link rod longer by 5 %": (np.nan, 0.26, 0.87, 72.0, 79.0, 1.05),
    "link rod longer by 1 %": (np.nan, 0.26, 0.87, 72.0, 79.0, 1.01),
    "knuckle 1e-9° from the bore": (0.33, 0.26, 0.87, 72.0, 72.0 + 1e-9),
    "usual": (0.33, 0.26, 0.87, 72.0, 79.0),
}
"""Condition → r/L, r/l, a/r, D and ψ, degrees; or nan and how much longer L is than it must be."""


def stars(count: int) -> tuple[np.ndarray, ...]:
    """Return r/L, r/l, a/r, D and ψ, degrees, of the links of random stars."""
    rng = np.random.default_rng(1)
    cylinders = rng.integers(3, 10, count)
    star = np.repeat(np.arange(count), cylinders - 1)
    place = np.concatenate([np.arange(1, n) for n in cylinders])
    bores = 360.0 * place / cylinders[star]
    figures = [rng.uniform(low, high, count)[star] for low, high in ((0.25, 0.4), (0.2, 0.3))]
    return (
        *figures,
        rng.uniform(0.5, 0.9, count)[star],
        bores,
        bores + rng.uniform(-8, 8, len(star)),
    )


def crankpin(figures: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return the harmonics by the package."""
    rods, masters, knuckles, bores, angles = figures
    return cp.link_rod_harmonics(
        rods, ORDERS, master_ratio=masters, knuckle_ratio=knuckles, bore_deg=bores,
        knuckle_deg=angles,
    )  # fmt: skip


def positions(figures: tuple[np.ndarray, ...], theta: np.ndarray) -> np.ndarray:
    """Return positions over the crank radius at crank angles past each bore."""
    rods, masters, knuckles, bores, angles = (each[:, np.newaxis] for each in figures)
    lean = -np.arcsin(masters * np.sin(theta + np.radians(bores)))
    place = np.exp(1j * theta) + knuckles * np.exp(1j * (np.radians(angles - bores) + lean))
    heights: np.ndarray = place.real + np.sqrt(rods**-2.0 - place.imag**2)
    return heights


def fft(figures: tuple[np.ndarray, ...], samples: int = SAMPLES) -> np.ndarray:
    """Return the harmonics by transforms of sampled positions."""
    theta = 2.0 * np.pi * np.arange(samples) / samples
    found = np.empty((len(figures[0]), len(ORDERS)), complex)
    for start in range(0, len(found), PART):
        part = slice(start, start + PART)
        heights = positions(tuple(each[part] for each in figures), theta)
        found[part] = 2.0 / samples * np.fft.rfft(heights)[:, ORDERS] * np.square(ORDERS)
    return found


def digits(figures: tuple[float, ...], samples: int = 2048) -> list[complex]:
    """Return the harmonics by as many samples in 50 digits."""
    with mpmath.workdps(50):
        rod, master, knuckle = (mpmath.mpf(each) for each in figures[:3])
        bore, angle = (mpmath.mpf(each) * mpmath.pi / 180 for each in figures[3:])
        sums = [mpmath.mpc(0)] * len(ORDERS)
        for k in range(samples):
            theta = 2 * mpmath.pi * k / samples
            lean = -mpmath.asin(master * mpmath.sin(theta + bore))
            place = mpmath.expj(theta) + knuckle * mpmath.expj(angle - bore + lean)
            height = place.real + mpmath.sqrt(rod**-2 - place.imag**2)
            sums = [s + height * mpmath.expj(-n * theta) for s, n in zip(sums, ORDERS, strict=True)]
        return [complex(2 * n * n * s / samples) for s, n in zip(sums, ORDERS, strict=True)]


def main() -> None:
    """Print times and errors."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--stars", type=int, default=100_000)
    count = parser.parse_args().stars
    figures = stars(count)
    methods = {"crankpin": crankpin, "FFT of 96 samples": fft}
    best = interleaved({name: partial(m, figures) for name, m in methods.items()}, rounds=3)
    exact = fft(figures, 2 * SAMPLES)
    print(machine())
    print(f"{len(figures[0])} link rods of {count} stars, orders 1-6: time, relative, error")
    for name, method in methods.items():
        error = np.abs(method(figures) - exact).max()
        print(
            f"{name:20} {1e3 * best[name]:8.1f} ms "
            f"{best[name] / best['crankpin']:6.1f} x {error:.0e}"
        )
    print("\nLargest error of an order beside 50 digits: crankpin, FFT of 96 samples")
    for name, given in LIMITS.items():
        rod, *rest = given[:5]
        if np.isnan(rod):
            theta = np.linspace(0.0, 2.0 * np.pi, 100_001)
            one = tuple(np.array([each]) for each in (1e-9, *rest))
            masters, knuckles, bores, angles = one[1:]
            lean = -np.arcsin(masters * np.sin(theta + np.radians(bores)))
            place = np.exp(1j * theta) + knuckles * np.exp(1j * (np.radians(angles - bores) + lean))
            rod = 1.0 / (given[5] * np.abs(place.imag).max())
        one = tuple(np.array([each]) for each in (rod, *rest))
        known: np.ndarray = np.array(digits((rod, *rest)))
        errors = [np.abs(method(one)[0] - known).max() for method in methods.values()]
        print(f"{name:40} {errors[0]:.0e} {errors[1]:.0e}")


if __name__ == "__main__":
    main()
