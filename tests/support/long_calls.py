"""Every call that works in parallel, small enough for a test and large enough to be divided.

Run as a program it prints a hash of each result.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

V6, V8 = cp.Engine.preset("v6-60"), cp.Engine.preset("v8-crossplane")
RNG = np.random.default_rng(7)
RATIOS = RNG.uniform(0.1, 0.95, 30_000)
OFFSETS = RNG.uniform(-0.04, 0.04, 30_000)
ON_MOUNTS = cp.Powertrain(
    V8,
    cp.RigidBody(250, (0.01, 0.1, 0.2), (14, 15, 9)),
    [
        cp.Mount(f"{k}", at, 3e5, loss_factor=0.1, damping=100.0 * k)
        for k, at in enumerate([(0.3, 0, 0), (-0.3, 0, 0), (0.1, 0, 0.7), (-0.1, 0.1, 0.7)])
    ],
)
SPEEDS = np.linspace(600, 6000, 1001)


def over_bank_angles() -> cp.results.Sweep:
    """Return a sweep whose bank angles go side by side."""
    angles = np.linspace(0, 180, 3001)
    return cp.sweep(
        [V6, V8],
        rpm=[1000, 5000],
        bank_angle_deg=angles,
        hold="pins",
        rod_ratio=0.3,
        orders=[1, 2, 4, 6],
    )


def over_rod_ratios() -> cp.results.Sweep:
    """Return a sweep whose rod ratios go side by side."""
    angles = np.linspace(0, 180, 3)
    return cp.sweep(
        V6,
        rpm=5000,
        bank_angle_deg=angles,
        hold="firing",
        rod_ratio=RATIOS[:9000],
        pin_offset=1e-3,
        orders=[1, 2, 4, 6],
    )


def over_speeds() -> cp.results.Sweep:
    """Return a sweep of few points at many speeds."""
    return cp.sweep(
        V8, rpm=np.linspace(500, 9000, 20_001), rod_ratio=RATIOS[:3], orders=[1, 2, 4, 6]
    )


def waveforms(*, exact: bool) -> np.ndarray:
    """Return forces of a sweep of more rows and angles than one task has."""
    sweep = cp.sweep([V6, V8], rpm=[1000, 5000], rod_ratio=RATIOS[:150], orders=range(1, 10))
    return sweep.waveform(np.linspace(0, 720, 2101), exact=exact).read("force")


def ranking() -> np.ndarray:
    """Return the bank angles of a ranking between the given ones."""
    found = cp.rank(
        [V6, V8],
        rpm=1000,
        by="total.moment.peak",
        orders=[1, 2, 4, 6],
        bank_angle_deg=np.linspace(0, 180, 2001),
        hold="pins",
        refine=True,
    )
    return np.concatenate([choice.bank_angles_deg for choice in found])


CALLS: dict[str, Callable[[], object]] = {
    "phasors by bank angle": lambda: over_bank_angles().moment.xy,
    "phasors by rod ratio": lambda: over_rod_ratios().force.xy,
    "phasors by speed": lambda: over_speeds().moment.xy,
    "torque": lambda: over_rod_ratios().torque.phasor,
    "peaks by bank angle": lambda: over_bank_angles().moment.peak_xy,
    "peaks by rod ratio": lambda: over_rod_ratios().moment.peak,
    "peaks of sums by bank angle": lambda: over_bank_angles().total.moment.peak_xy,
    "peaks of sums by rod ratio": lambda: over_rod_ratios().total.force.peak,
    "orders of a sweep": lambda: repr(
        [
            (s := cp.sweep(V8, rpm=1000, rod_ratio=RATIOS[:9000], orders="auto")).orders,
            s.error_bound,
        ]
    ),
    "harmonics": lambda: cp.slider_crank_harmonics(RATIOS, range(1, 9)),
    "harmonics with an offset": lambda: cp.slider_crank_harmonics(RATIOS, range(1, 9), OFFSETS),
    "waveform from kinematics": lambda: (
        V8.waveform(5000, theta_deg=np.linspace(0, 720, 50_001)).moment
    ),
    "waveform from orders": lambda: (
        V8.waveform(5000, theta_deg=np.linspace(0, 720, 50_001), orders=range(1, 20)).force
    ),
    "bearing loads": lambda: cp.bearing_loads(V8, 5000, np.linspace(0, 720, 50_001)).main,
    "waveforms of a sweep from orders": lambda: waveforms(exact=False),
    "waveforms of a sweep from kinematics": lambda: waveforms(exact=True),
    "vanishing orders": lambda: repr(V8.vanishing_orders()),
    "ranking": ranking,
    "tolerances": lambda: (
        cp.tolerances(
            V6, rpm=5000, reciprocating_mass=0.005, pin_deg=0.1, rod_length=1e-4, samples=3000
        ).total.moment.peak
    ),
    "peaks of tolerances along axes": lambda: (
        cp.tolerances(V8, rpm=5000, crank_radius=1e-4, z=1e-4, samples=3000).total.force.peak_xy
    ),
    "response on mounts": lambda: ON_MOUNTS.response(SPEEDS, orders=[1, 2, 3]).motion,
    "designs of mounts": lambda: (
        ON_MOUNTS.designs(
            SPEEDS[::50], {"2": {"stiffness": 1e6 * RATIOS[:600]}}, orders=[1, 2, 4]
        ).body_force_rms
    ),
    "corners of mounts": lambda: ON_MOUNTS.robustness(0.1).least_purity,
    "search": lambda: cp.search_arrangements(14).bank_angles_deg,
    "search, angles in a window": lambda: (
        cp.search_arrangements(22).within(60, 60.01).bank_angles_deg
    ),
}


def digest(result: object) -> str:
    """Return a hash of a result's bits."""
    content = result.tobytes() if isinstance(result, np.ndarray) else str(result).encode()
    return hashlib.sha256(content).hexdigest()


def printed(threads: str, *arguments: str) -> str:
    """Return what Python prints, given these arguments, with so many threads."""
    return subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, *arguments],
        env=os.environ | {"RAYON_NUM_THREADS": threads},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


if __name__ == "__main__":
    for name, call in CALLS.items():
        print(f"{name}: {digest(call())}")
