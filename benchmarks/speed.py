"""How fast are the V-angle sweep and the harmonics, beside what one would write in NumPy?

``python benchmarks/speed.py`` prints both tables: time, ratio and error of each method, on the
same inputs and for the same results, in one run.
"""

from __future__ import annotations

from collections.abc import Callable

import crankpin as cp
import methods
import mpmath
import numpy as np
from _timing import interleaved, least, machine, milliseconds, print_table
from numpy.typing import NDArray

Array = NDArray[np.float64]

# --- the V-angle sweep of the IJESC paper (2017): four firing orders, orders 1 and 2 --------------

MASS, RADIUS, ROD, SPACING, RPM = 1.487, 0.045, 0.158, 0.13, 5000
FIRING_ORDERS = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
V_ANGLES = np.linspace(0, 180, 1801)
THETA = np.radians(np.arange(361.0))
LEVERS = SPACING * (np.arange(3.0) - 1.0)
CYLINDER = cp.Cylinder(RADIUS, ROD, MASS)
ENGINES = [
    cp.Engine.from_firing_order(
        CYLINDER, order, bank_angle_deg=60, rule="ijesc", spacing=SPACING, name=order
    )
    for order in FIRING_ORDERS
]


def lags(firing_order: str) -> tuple[Array, Array]:
    """Return the paper's lags of the right (odd) and the left bank, front to flywheel."""
    order = [int(number) for number in firing_order.split("-")]
    banks = []
    for cylinders in ((1, 3, 5), (2, 4, 6)):
        fired = [number for number in order if number in cylinders]
        banks.append(np.radians([120.0 * fired.index(number) for number in cylinders]))
    return banks[0], banks[1]


LAGS = [lags(order) for order in FIRING_ORDERS]
SCALES = [
    MASS * RADIUS * (2 * np.pi * RPM / 60) ** 2 * float(a)
    for a in cp.slider_crank_harmonics(CYLINDER.rod_ratio, [1, 2])
]


def sweep_as_the_paper() -> Array:
    """Sample the crank angle and take the largest magnitude: (4, 1801, 2, 2)."""
    result = np.empty((4, len(V_ANGLES), 2, 2))
    for f, (right_lags, left_lags) in enumerate(LAGS):
        for k, gamma in enumerate(np.radians(V_ANGLES) / 2):
            right = THETA - right_lags[:, None] + gamma
            left = THETA - left_lags[:, None] - gamma
            for n, scale in ((1, SCALES[0]), (2, SCALES[1])):
                on_right, on_left = LEVERS @ np.cos(n * right), LEVERS @ np.cos(n * left)
                along = scale * np.cos(gamma) * (on_left + on_right)
                across = scale * np.sin(gamma) * (on_left - on_right)
                result[f, k, n - 1] = np.abs(along).max(), np.abs(across).max()
    return result


def sweep_closed_form() -> Array:
    """Sum phasors: |cos γ (e^{inγ} R + e^{−inγ} L)|, |sin γ (…)|."""
    result = np.empty((4, len(V_ANGLES), 2, 2))
    gamma = np.radians(V_ANGLES) / 2
    for f, (right_lags, left_lags) in enumerate(LAGS):
        for n in (1, 2):
            right = np.exp(1j * n * gamma) * (LEVERS * np.exp(-1j * n * right_lags)).sum()
            left = np.exp(-1j * n * gamma) * (LEVERS * np.exp(-1j * n * left_lags)).sum()
            result[f, :, n - 1, 0] = SCALES[n - 1] * np.abs(np.cos(gamma) * (left + right))
            result[f, :, n - 1, 1] = SCALES[n - 1] * np.abs(np.sin(gamma) * (left - right))
    return result


def sweep_best_numpy() -> Array:
    """Hoist the exponentials out of the firing orders, stay in reals, all orders of firing at once.

    R e^{inγ} ± L e^{−inγ} = (R ± L) cos nγ + i (R ∓ L) sin nγ.
    """
    result = np.empty((4, len(V_ANGLES), 2, 2))
    gamma = np.radians(V_ANGLES) / 2
    cos, sin = np.cos(gamma), np.sin(gamma)
    for n in (1, 2):
        c, s = (cos, sin) if n == 1 else (cos * cos - sin * sin, 2 * cos * sin)
        bank = [
            np.array([(LEVERS * np.exp(-1j * n * lag[side])).sum() for lag in LAGS]) * SCALES[n - 1]
            for side in (0, 1)
        ]
        total, difference = (bank[0] + bank[1])[:, None], (bank[0] - bank[1])[:, None]
        for axis, (a, b, factor) in enumerate(((total, difference, cos), (difference, total, sin))):
            re = a.real * c - b.imag * s
            im = a.imag * c + b.real * s
            np.multiply(re, re, out=re)
            np.multiply(im, im, out=im)
            np.add(re, im, out=re)
            np.sqrt(re, out=re)
            np.multiply(re, factor, out=result[:, :, n - 1, axis])
    return result


def sweep_crankpin() -> Array:
    """Ask crankpin, from the engines to the peaks."""
    sweep = cp.sweep(ENGINES, rpm=RPM, bank_angle_deg=V_ANGLES, hold="pins", orders=(1, 2))
    return sweep.moment_peak_xy


def sweep_reference() -> Array:
    """Return the closed form at 30 digits for every hundredth V-angle."""
    mpmath.mp.dps = 30
    degree = mpmath.pi / 180
    levers = [-mpmath.mpf("0.13"), mpmath.mpf(0), mpmath.mpf("0.13")]
    omega = mpmath.mpf(RPM) * 2 * mpmath.pi / 60
    ratio = mpmath.mpf(RADIUS) / mpmath.mpf(ROD)
    root = ratio / (1 + mpmath.sqrt(1 - ratio**2))
    # a₂ = 2p·₂F₁(−½, ½; 2; p⁴), from the factored form of √(1 − λ² sin²θ)
    second = 2 * root * mpmath.hyp2f1(-0.5, 0.5, 2, root**4)
    scales = [mpmath.mpf(MASS) * mpmath.mpf(RADIUS) * omega**2 * a for a in (1, second)]
    result = np.empty((4, len(V_ANGLES[::100]), 2, 2))
    for f, order in enumerate(FIRING_ORDERS):
        fired = [int(number) for number in order.split("-")]
        banks = [[n for n in fired if n % 2 == odd] for odd in (1, 0)]
        phases = [[-120 * bank.index(n) * degree for n in sorted(bank)] for bank in banks]
        for k, angle in enumerate(V_ANGLES[::100]):
            gamma = mpmath.mpf(float(angle)) * degree / 2
            for n in (1, 2):
                sums = [
                    sum(z * mpmath.expj(n * p) for z, p in zip(levers, bank, strict=True))
                    for bank in phases
                ]
                right, left = sums[0] * mpmath.expj(n * gamma), sums[1] * mpmath.expj(-n * gamma)
                result[f, k, n - 1, 0] = scales[n - 1] * abs(mpmath.cos(gamma) * (left + right))
                result[f, k, n - 1, 1] = scales[n - 1] * abs(mpmath.sin(gamma) * (left - right))
    return result


def sweeps() -> None:
    """Print the table of sweeps."""
    reference = sweep_reference()
    size = reference.max()
    methods: dict[str, Callable[[], Array]] = {
        "as the paper: 361 crank angles, max |·|": sweep_as_the_paper,
        "NumPy, closed form": sweep_closed_form,
        "NumPy, best: exponentials hoisted, real arithmetic": sweep_best_numpy,
        "crankpin.sweep(…).moment_peak_xy": sweep_crankpin,
    }
    paper, *others = methods
    times = {paper: least(methods[paper], runs=3)}
    times |= interleaved({name: methods[name] for name in others}, rounds=20, seconds=4)
    ours = times["crankpin.sweep(…).moment_peak_xy"]
    rows = []
    for name, run in methods.items():
        error = np.abs(run()[:, ::100] - reference).max() / size
        rows.append(
            [name, milliseconds(times[name]), f"{times[name] / ours:.3g} ×", f"{error:.1e}"]
        )
    title = "V-angle sweep: 4 firing orders × 1801 angles × orders 1, 2, moments along x and y"
    print_table(title, ["method", "time", "of ours", "worst error / largest"], rows)


# --- harmonics 2, 4, 6, 8 of 100 000 rod ratios ---------------------------------------------------

ORDERS = (2, 4, 6, 8)
RATIOS = np.random.default_rng(2017).uniform(0.15, 0.45, 100_000)


def harmonics_reference(count: int) -> Array:
    """Return the harmonics of the first rod ratios at 40 digits."""
    mpmath.mp.dps = 40
    rows = []
    for ratio in RATIOS[:count].tolist():
        exact = mpmath.mpf(ratio)
        row = []
        for n in ORDERS:
            m = n // 2
            leading = (
                (-1) ** (m + 1)
                * n**2
                * abs(mpmath.binomial(mpmath.mpf("0.5"), m))
                * mpmath.mpf(2)
                / 4**m
            )
            half = mpmath.mpf("0.5")
            row.append(
                float(
                    leading * exact ** (n - 1) * mpmath.hyp2f1(m - half, m + half, n + 1, exact**2)
                )
            )
        rows.append(row)
    return np.array(rows)


def harmonics() -> None:
    """Print the table of harmonics."""
    reference = harmonics_reference(300)
    compared: dict[str, Callable[[], Array]] = {
        "NumPy, FFT of 64 samples": lambda: methods.fft_positions(RATIOS, ORDERS, 64),
        "SciPy, hyp2f1": lambda: methods.hypergeometric(RATIOS, ORDERS),
        "crankpin.slider_crank_harmonics": lambda: methods.crankpin(RATIOS, ORDERS),
    }
    times = interleaved(compared, rounds=5, seconds=2)
    ours = times["crankpin.slider_crank_harmonics"]
    rows = []
    for name, run in compared.items():
        errors = np.abs(run()[:300] / reference - 1).max(axis=0)
        listed = [f"{error:.0e}" for error in errors]
        rows.append([name, milliseconds(times[name]), f"{times[name] / ours:.3g} ×", *listed])
    title = "Harmonics of 100 000 rod ratios from 0.15 to 0.45; worst relative error by order"
    print_table(title, ["method", "time", "of ours", *(f"order {n}" for n in ORDERS)], rows)


def main() -> None:
    """Print both tables."""
    print(machine())
    sweeps()
    harmonics()


if __name__ == "__main__":
    main()
