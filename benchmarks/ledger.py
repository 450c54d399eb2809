"""How many instructions do some twenty calls take, and is one of them more than the ledger says?

``python benchmarks/ledger.py`` counts them with callgrind (valgrind), in a release build, and fails
where a call takes over 3 % more than ``ledger.txt`` has. ``--update`` writes the file anew, for the
commit that gives the reason. Counts are of one thread, nearly the same on every machine, but not by
every compiler: with other versions than those that the file names nothing is compared.
"""

from __future__ import annotations

import argparse
import gc
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import crankpin as cp
import numpy as np

LEDGER = Path(__file__).with_name("ledger.txt")
TOLERANCE = 0.03
"""Part of its count by which a call may grow."""
TIMES = 3
"""Number of times that a call is counted: where threads wait for each other, counts vary."""
MARK = "getppid"
"""Function of the C library at which callgrind writes what it has counted since the last one."""


def calls() -> dict[str, Callable[[], object]]:
    """Return what is counted, by name."""
    rod = cp.Rod(mass=0.55, inertia=0.0022, length=0.145, to_crankpin=0.045)
    cylinder = cp.Cylinder.from_rod(rod, crank_radius=0.043, piston_mass=0.4, bore=0.086)
    v8 = cp.Engine.preset("v8-crossplane", cylinder=cylinder)
    v6 = cp.Engine.preset("v6-60", cylinder=cylinder)
    cycle = cp.Cycle.wiebe(cylinder, compression_ratio=10, heat=900, start_deg=-20)
    fired = v8.with_cycle(cycle)
    orders = (1, 2, 4, 6)
    halves = np.arange(1, 25) / 2
    angles, ratios = np.linspace(0, 180, 101), np.linspace(0.15, 0.45, 101)
    many = np.linspace(0.1, 0.5, 5000)
    theta = np.arange(720.0)
    ijesc = [
        cp.Engine.from_firing_order(
            cylinder, order, bank_angle_deg=60, rule="ijesc", spacing=0.13, name=order
        )
        for order in ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
    ]
    v_angles = np.linspace(0, 180, 1801)
    speeds, loads = np.linspace(1000, 6000, 5), np.linspace(0, 1, 4)
    cycles = cp.CycleMap(speeds, loads, [[cycle] * 4] * 5)
    map_speeds, map_loads = np.linspace(1000, 6000, 40), np.linspace(0, 1, 25)
    body = cp.RigidBody(150.0, (0, 0.1, 0.2), inertia=(12.0, 9.0, 7.0))
    mounts = [
        cp.Mount(f"{k}", (x, -0.1, z), 2e5, loss_factor=0.1)
        for k, (x, z) in enumerate([(-0.3, -0.1), (0.3, -0.1), (-0.3, 0.5), (0.3, 0.5)])
    ]
    powertrain = cp.Powertrain(v8, body, mounts)
    designs = {m.name: {"stiffness": np.linspace(1e5, 4e5, 150).reshape(50, 3)} for m in mounts}
    gas = {"heat": 900.0}

    def new_cycle() -> object:
        # Another heat each time, so that no harmonics are kept of it.
        gas["heat"] += 1.0
        own = cp.Cycle.wiebe(cylinder, compression_ratio=10, heat=gas["heat"], start_deg=-20)
        return v8.with_cycle(own).balance(3000, orders=halves)

    return {
        "balance, orders given": lambda: v8.balance(3000, orders=orders),
        "balance, orders chosen": lambda: v8.balance(3000),
        "balance, moment read": lambda: v8.balance(3000, orders=orders).moment.xy,
        "balance, one peak": lambda: v8.balance(5000)[2].force.peak,
        "balance, all peaks together": lambda: v8.balance(5000).total.moment.peak,
        "balance, fired": lambda: fired.balance(3000, orders=halves),
        "balance, fired, new cycle": new_cycle,
        "vanishing orders": lambda: v8.vanishing_orders().force,
        "explanation": lambda: v8.explain().sentences,
        "bearing loads, one angle": lambda: cp.bearing_loads(v8, 5000, [0.0]).crankpin,
        "bearing loads, two turns": lambda: cp.bearing_loads(v8, 5000).crankpin,
        "waveform": lambda: v8.waveform(3000, theta, orders=orders).force,
        "waveform, exact": lambda: v8.waveform(3000, theta).force,
        "sweep, two angles": lambda: (
            cp.sweep(
                v6, rpm=5000, bank_angle_deg=(60, 90), hold="pins", orders=(1, 2)
            ).moment.peak_xy
        ),
        "sweep, V-angles of four engines": lambda: (
            cp.sweep(
                ijesc, rpm=5000, bank_angle_deg=v_angles, hold="pins", orders=(1, 2)
            ).moment.peak_xy
        ),
        "sweep, ten thousand points": lambda: (
            cp.sweep(
                v6, rpm=5000, bank_angle_deg=angles, hold="pins", rod_ratio=ratios, orders=orders
            ).moment.peak_xy
        ),
        "sweep, orders chosen": lambda: (
            cp.sweep(v6, rpm=5000, bank_angle_deg=angles, hold="pins").moment.peak
        ),
        "sweep, peaks together": lambda: (
            cp.sweep(v6, rpm=5000, bank_angle_deg=angles, hold="pins").total.moment.peak
        ),
        "sweep, torque over speed and load": lambda: (
            cp.sweep(
                v8, rpm=map_speeds, load=map_loads, cycle=cycles, orders=halves
            ).crank_torque.peak
        ),
        "sweep, exact waveforms": lambda: (
            cp.sweep(v8, rpm=np.linspace(1000, 6000, 2), rod_ratio=ratios[:25])
            .waveform(theta, exact=True)
            .read("force")
        ),
        "harmonics": lambda: cp.slider_crank_harmonics(many, (2, 4, 6, 8)),
        "harmonics, pin offset": lambda: cp.slider_crank_harmonics(many[::20], range(1, 9), 0.01),
        "tolerances": lambda: (
            cp.tolerances(
                v6, rpm=5000, orders=orders, reciprocating_mass=1e-3, samples=500
            ).total.force
        ),
        "arrangements of a V-18": lambda: cp.search_arrangements(18).bank_angles_deg,
        "counterweights": lambda: cp.counterweights(v8, planes=(0.0, 0.4)),
        "mounts, response": lambda: powertrain.response(3000, orders=orders).read("wrench"),
        "mounts, fifty designs": lambda: (
            powertrain.designs(map_speeds, designs, orders=orders).body_force
        ),
    }


def count() -> None:
    """Make each call between marks, once it has been made twice; run by callgrind."""
    listed = calls()
    gc.disable()
    for call in listed.values():
        call(), call()
        gc.collect()
        os.getppid()
        for _ in range(TIMES):
            call()
            os.getppid()
    print(*listed, sep="\n")


def counted() -> dict[str, int]:
    """Return the fewest instructions of each call."""
    settings = {"RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "counts")
        callgrind = ["--tool=callgrind", f"--dump-before={MARK}", f"--callgrind-out-file={out}"]
        command = ["valgrind", "-q", *callgrind, sys.executable, __file__, "--count"]
        done = subprocess.run(  # noqa: S603 - this file
            command, env=os.environ | settings, stdout=subprocess.PIPE, text=True, check=True
        )
        # The parts are numbered from 1; the first of each call ends where it begins.
        names = done.stdout.splitlines()
        firsts = range(1, (TIMES + 1) * len(names), TIMES + 1)
        return {
            name: min(total(Path(f"{out}.{first + k}")) for k in range(1, TIMES + 1))
            for name, first in zip(names, firsts, strict=True)
        }


def total(part: Path) -> int:
    """Return the instructions of a part that callgrind has written."""
    with part.open(encoding="utf-8") as lines:
        return int(next(line for line in lines if line.startswith("totals:")).split()[1])


def versions() -> str:
    """Return what counts depend on besides the code."""
    rustc = subprocess.run(["rustc", "--version"], stdout=subprocess.PIPE, text=True, check=True)  # noqa: S607
    words = rustc.stdout.split()[:2]
    info = Path("/proc/cpuinfo")
    flags = info.read_text(encoding="utf-8").split() if info.exists() else []
    vectors = "AVX2" if {"avx2", "fma"} <= {*flags} else platform.machine()
    library = " ".join(platform.libc_ver())
    python = platform.python_version()
    return f"{' '.join(words)}, Python {python}, NumPy {np.__version__}, {library}, {vectors}"


def read() -> tuple[str, dict[str, int]]:
    """Return the versions that the ledger is of, and its counts."""
    first, *lines = LEDGER.read_text(encoding="utf-8").splitlines()
    return first, {name: int(number) for number, name in (line.split(maxsplit=1) for line in lines)}


def write(of: str, counts: Mapping[str, int]) -> None:
    """Write the ledger."""
    lines = [of, *(f"{number:>12} {name}" for name, number in counts.items())]
    LEDGER.write_text("\n".join(lines) + "\n", encoding="utf-8")


def grown(counts: Mapping[str, int], known: Mapping[str, int]) -> list[str]:
    """Return the calls that take more than the ledger says, and those that only one of both has."""
    over = [
        name for name, number in counts.items() if number > (1 + TOLERANCE) * known.get(name, 0)
    ]
    return [*over, *(name for name in known if name not in counts)]


def main() -> None:
    """Compare with the ledger, or write it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--update", action="store_true", help="write the ledger anew")
    parser.add_argument("--count", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.count:
        count()
        return
    if shutil.which("valgrind") is None:
        sys.exit("ledger: valgrind is not installed")
    here = versions()
    of, known = read() if LEDGER.exists() else ("", {})
    if not given.update and of != here:
        print(f"ledger skipped: it is of {of}; these are {here}")
        return
    counts = counted()
    print(f"{'instructions':>12} {'ledger':>12}  growth")
    for name, number in counts.items():
        growth = f"{number / known[name] - 1:+7.2%}" if name in known else "    new"
        print(f"{number:>12} {known.get(name, 0):>12} {growth}  {name}")
    if given.update:
        write(here, counts)
    elif over := grown(counts, known):
        sys.exit(
            f"ledger: over {TOLERANCE:.0%} more than {LEDGER.name} says: {', '.join(over)}. Fix"
            " it, or write the file anew with --update, and give the reason in the same commit"
        )


if __name__ == "__main__":
    main()
