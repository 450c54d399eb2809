"""How fast are sweeps, harmonics and small calls, beside what one would write in NumPy?

``python benchmarks/speed.py`` prints the tables, or those that are named: time, ratio and error of
each method, on the same inputs and for the same results, in one run.
"""

from __future__ import annotations

import argparse
import itertools
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import crankpin as cp
import methods
import mpmath
import numpy as np
from _timing import interleaved, least, machine, milliseconds, print_table
from crankpin._core import ATMOSPHERE
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
    return sweep.moment.peak_xy


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
        "crankpin.sweep(…).moment.peak_xy": sweep_crankpin,
    }
    paper, *others = methods
    times = {paper: least(methods[paper], runs=3)}
    times |= interleaved({name: methods[name] for name in others}, rounds=20, seconds=4)
    ours = times["crankpin.sweep(…).moment.peak_xy"]
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


# --- a million points: bank angle × rod ratio × speed ---------------------------------------------

MANY_ANGLES, MANY_RATIOS = np.linspace(0, 180, 100), np.linspace(0.15, 0.45, 100)
MANY_RPM = np.linspace(500, 9000, 100)
MANY_ORDERS = (1, 2, 4, 6)
V6 = cp.Engine.vee(CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=SPACING)
THROWS = np.radians([0.0, 120.0, 240.0])
SQUARES = (2 * np.pi * MANY_RPM / 60) ** 2


def layout() -> NDArray[np.complex128]:
    """Return moment phasors over m·r·ω²·aₙ of a V6 whose banks share its pins: (100, 4, 2)."""
    n = np.array(MANY_ORDERS)
    gamma = np.radians(MANY_ANGLES)[:, None] / 2
    # pins at throw + 90° − γ₀ where cylinder 1 of the right bank is at TDC at θ = 0
    pins = THROWS + np.radians(60.0)
    z = LEVERS[:, None]
    right, left = (
        np.exp(-1j * n * (np.pi / 2 + side * gamma)) * (z * np.exp(1j * n * pins[:, None])).sum(0)
        for side in (-1, 1)
    )
    along_x, along_y = np.sin(gamma) * (right - left), np.cos(gamma) * (right + left)
    return np.stack([-along_y, along_x], axis=-1)


def before_speed(sums: NDArray[Any]) -> NDArray[Any]:
    """Multiply by harmonics: (10 000, 8). They are given, to NumPy's advantage."""
    harmonics = MASS * RADIUS * cp.slider_crank_harmonics(MANY_RATIOS, MANY_ORDERS)
    if sums.dtype == np.float64:
        np.abs(harmonics, out=harmonics)
    return (sums[:, None] * harmonics[:, :, None]).reshape(10_000, 8)


def million_einsum(sums: NDArray[Any]) -> NDArray[Any]:
    """Write the outer product with ω² by einsum."""
    product: NDArray[Any] = np.einsum("pk,s->psk", before_speed(sums), SQUARES)
    return product


def million_broadcast(sums: NDArray[Any]) -> NDArray[Any]:
    """Write the outer product with ω² by broadcasting, long rows innermost."""
    rows = np.tile(before_speed(sums), (1, 100))
    np.multiply(rows, np.repeat(SQUARES, 8), out=rows)
    return rows.reshape(10_000, 100, 8)


def million_sweep() -> cp.results.Sweep:
    """Return the sweep, nothing of it computed."""
    return cp.sweep(
        V6,
        rpm=MANY_RPM,
        bank_angle_deg=MANY_ANGLES,
        hold="pins",
        rod_ratio=MANY_RATIOS,
        orders=MANY_ORDERS,
    )


def fresh(dtype: type) -> NDArray[Any]:
    """Write a constant to as much new memory as the result takes."""
    out = np.empty((10_000, 100, 8), dtype)
    out.fill(1.0)
    return out


def million() -> None:
    """Print the table of a million points."""
    rows = []
    for what, dtype, sums, ours in (
        ("peaks", float, lambda: np.abs(layout()), lambda: million_sweep().moment.peak_xy),
        ("phasors", complex, layout, lambda: million_sweep().moment.xy),
    ):
        methods: dict[str, Callable[[], Array]] = {
            "NumPy, broadcast": lambda sums=sums: million_broadcast(sums()),
            "NumPy, einsum": lambda sums=sums: million_einsum(sums()),
            "NumPy, the result's memory written once": lambda dtype=dtype: fresh(dtype),
            "crankpin.sweep(…)": ours,
        }
        expected = ours().reshape(10_000, 100, 8)
        for name, run in list(methods.items())[:2]:
            error = np.abs(run() - expected).max() / np.abs(expected).max()
            assert error < 1e-14, (name, error)  # noqa: S101 - both are at rounding
        times = interleaved(methods, rounds=8, seconds=3)
        least_of_ours = times["crankpin.sweep(…)"]
        rows += [
            [f"{what}: {name}", milliseconds(time), f"{time / least_of_ours:.3g} ×"]
            for name, time in times.items()
        ]
    title = "A million points: 100 bank angles × 100 rod ratios × 100 speeds, 4 orders, x and y"
    print_table(title, ["method", "time", "of ours"], rows)


# --- gas torque over speed and load ---------------------------------------------------------------

BORED = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
V8 = cp.Engine.preset("v8-crossplane", cylinder=BORED)
MAP_RPM, MAP_LOADS = np.linspace(1000, 6000, 5), np.linspace(0, 1, 4)
HALVES = 0.5 * np.arange(1, 25)
GAS_RPM, GAS_LOADS = np.linspace(1000, 6000, 40), np.linspace(0, 1, 25)
SAMPLED = np.arange(1440) / 2.0


def wiebe(rpm: float, load: float) -> cp.Cycle:
    """Return a cycle that depends on speed and load."""
    start, heat = -12.0 - rpm / 500.0, 200.0 + 900.0 * load
    return cp.Cycle.wiebe(BORED, compression_ratio=10, heat=heat, start_deg=start)


CYCLES = cp.CycleMap(MAP_RPM, MAP_LOADS, [[wiebe(n, x) for x in MAP_LOADS] for n in MAP_RPM])
PRESSURES = np.array([[c.pressure_at(SAMPLED) for c in row] for row in CYCLES.cycles])
"""Given to NumPy: (5, 4, n)."""
SLOPE = -BORED.velocity(SAMPLED, 30.0 / np.pi) * 0.25 * np.pi * BORED.bore**2
"""Torque over pressure, m³: given to NumPy, (n,)."""


def shares(axis: Array, at: Array) -> Array:
    """Return the weights of linear interpolation: (n_at, n_axis)."""
    return np.array([np.interp(at, axis, row) for row in np.eye(len(axis))]).T


def star() -> NDArray[np.complex128]:
    """Return the sum of the cylinders' phases by order."""
    phases = np.radians(V8.with_cycle(CYCLES.cycles[0][0]).firing_deg)
    total: NDArray[np.complex128] = np.exp(-1j * HALVES[:, None] * phases).sum(axis=1)
    return total


STAR = star()
INERTIA = V8.balance(60.0, orders=HALVES).crank_torque.phasor / 60.0**2
"""Of inertia torque over rpm²: given to NumPy."""


def of_samples(torque: Array) -> NDArray[np.complex128]:
    """Return phasors of orders ½ to 12 of one cylinder's torque over two turns."""
    found: NDArray[np.complex128] = np.fft.rfft(torque)[..., 1:25] * (2.0 / torque.shape[-1])
    return found


def gas_peaks(one: NDArray[np.complex128]) -> Array:
    """Return magnitudes of the engine's torque, with inertia: (n_rpm, n_load, 24)."""
    return np.abs(one * STAR + (GAS_RPM**2)[:, None, None] * INERTIA)


def gas_waveforms() -> Array:
    """Interpolate pressure at every point, and take its torque's FFT."""
    over_speed = np.tensordot(shares(MAP_RPM, GAS_RPM), PRESSURES, 1)
    pressure = np.einsum("xj,sjt->sxt", shares(MAP_LOADS, GAS_LOADS), over_speed, optimize=True)
    return gas_peaks(of_samples((pressure - ATMOSPHERE) * SLOPE))


def gas_phasors(of_nodes: NDArray[np.complex128] | None = None) -> Array:
    """Take the FFT of the map's own cycles, and interpolate phasors."""
    if of_nodes is None:
        of_nodes = of_samples((PRESSURES - ATMOSPHERE) * SLOPE)
    over_speed = np.tensordot(shares(MAP_RPM, GAS_RPM), of_nodes, 1)
    one = np.einsum("xj,sjn->sxn", shares(MAP_LOADS, GAS_LOADS), over_speed, optimize=True)
    return gas_peaks(one)


def gas_crankpin(cycles: cp.CycleMap = CYCLES) -> Array:
    """Ask crankpin, from the engine and the map to the peaks."""
    swept = cp.sweep(V8, rpm=GAS_RPM, load=GAS_LOADS, cycle=cycles, orders=HALVES)
    peaks: Array = swept.crank_torque.peak
    return peaks


def first_time(rounds: int = 40) -> float:
    """Return the least time, seconds, with cycles of which no harmonics are kept yet."""
    best = float("inf")
    for _ in range(rounds):
        cycles = pickle.loads(pickle.dumps(CYCLES))  # noqa: S301 - its own
        start = time.perf_counter()
        gas_crankpin(cycles)
        best = min(best, time.perf_counter() - start)
    return best


def loads() -> None:
    """Print the table of gas torque over speed and load."""
    given = CYCLES.torque_harmonics(
        BORED, HALVES, rpm=MAP_RPM[:, None], load=MAP_LOADS
    )  # its harmonics at its own cycles
    methods: dict[str, Callable[[], Array]] = {
        "NumPy, waveforms and FFT of every point": gas_waveforms,
        "NumPy, FFT of the map's cycles, phasors interpolated": gas_phasors,
        "NumPy, the same, phasors of the map's cycles given": lambda: gas_phasors(given),
        "crankpin.sweep(…).crank_torque.peak": gas_crankpin,
    }
    exact = gas_phasors(given)
    times = interleaved(methods, rounds=10, seconds=4)
    ours = times["crankpin.sweep(…).crank_torque.peak"]
    rows = []
    for name, run in methods.items():
        error = np.abs(run() - exact).max() / exact.max()
        rows.append(
            [name, milliseconds(times[name]), f"{times[name] / ours:.3g} ×", f"{error:.1e}"]
        )
    first = first_time()
    rows.append(["… the first time", milliseconds(first), f"{first / ours:.3g} ×", ""])
    title = "Torque of a V8: 40 speeds × 25 loads, a map of 20 cycles, orders ½ to 12"
    print_table(title, ["method", "time", "of ours", "difference / largest"], rows)


# --- two threads, small calls ---------------------------------------------------------------------

COMPUTED = {
    "peaks of sums, 10 000 points": "sweep(rpm=5000).total.moment.peak",
    "torque, 1 000 000 points": (
        "cp.sweep(v6, rpm=5000, rod_ratio=many, orders=[1, 2, 4, 6]).torque.peak"
    ),
    "peaks, 1 000 000 points of rod ratio": (
        "cp.sweep(v6, rpm=5000, rod_ratio=many, orders=[1, 2, 4, 6]).force.peak_xy"
    ),
    "harmonics with an offset, 200 000": "cp.slider_crank_harmonics(many[::5], range(1, 9), 0.01)",
}
PROGRAM = """
import sys, time
import numpy as np
import crankpin as cp
v6 = cp.Engine.preset("v6-60")
many = np.linspace(0.1, 0.5, 1_000_000)
def sweep(**how):
    angles, ratios = np.linspace(0, 180, 100), np.linspace(0.15, 0.45, 100)
    return cp.sweep(v6, bank_angle_deg=angles, hold="pins", rod_ratio=ratios, **how)
for line in sys.stdin:
    start = time.perf_counter()
    eval(line)
    print(time.perf_counter() - start, flush=True)
"""


def scaling() -> None:
    """Print the table of one thread and two, taken in turns."""
    started = [
        subprocess.Popen(  # noqa: S603 - this interpreter
            [sys.executable, "-c", PROGRAM],
            env=os.environ | {"RAYON_NUM_THREADS": threads},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for threads in ("1", "2")
    ]
    rows = []
    for name, call in COMPUTED.items():
        best = [float("inf")] * 2
        for _ in range(25):
            for k, process in enumerate(started):
                told, heard = process.stdin, process.stdout
                assert told is not None  # noqa: S101
                assert heard is not None  # noqa: S101
                told.write(call + "\n")
                told.flush()
                best[k] = min(best[k], float(heard.readline()))
        rows.append([name, *map(milliseconds, best), f"{best[0] / best[1]:.2f} ×"])
    for process in started:
        process.kill()
    print_table("One thread and two", ["call", "one", "two", "one / two"], rows)


def small() -> None:
    """Print the time of one balance of a V8, which keeps the orders that were evaluated last."""
    v8 = cp.Engine.preset("v8-crossplane")
    last = itertools.cycle(range(8, 40))
    tolerances = itertools.cycle(np.linspace(1.1e-9, 1.2e-9, 32).tolist())
    calls = {
        "engine.balance(rpm=3000, orders=[1, 2, 4, 6])": lambda: v8.balance(
            rpm=3000, orders=[1, 2, 4, 6]
        ),
        "… and its moment": lambda: v8.balance(rpm=3000, orders=[1, 2, 4, 6]).moment.xy,
        "… other orders each time": lambda: v8.balance(rpm=3000, orders=[1, 2, 4, next(last)]),
        'orders="auto"': lambda: v8.balance(rpm=3000),
        "… another tolerance each time": lambda: v8.balance(rpm=3000, rtol=next(tolerances)),
    }
    times = interleaved(calls, rounds=5, seconds=1, runs=2000)
    rows = [[name, f"{time * 1e6:.1f} µs"] for name, time in times.items()]
    print_table("One balance of a cross-plane V8", ["call", "time"], rows)


TABLES = {
    "sweeps": sweeps,
    "harmonics": harmonics,
    "million": million,
    "loads": loads,
    "scaling": scaling,
    "small": small,
}


def main() -> None:
    """Print the tables that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--only", choices=list(TABLES), help="one table instead of all")
    only = parser.parse_args().only
    print(machine())
    for name in [only] if only else TABLES:
        TABLES[name]()


if __name__ == "__main__":
    main()
