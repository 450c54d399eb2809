"""Monte Carlo of tolerances: crankpin against vectorised NumPy, in one run.

Both draw the deviations, evaluate the exact harmonics of every slider-crank and the sums of each
order, and find the peaks of all orders together. That in NumPy (tests/rederivation/tolerances.py)
polishes the three highest points of a grid; crankpin's peaks are proved to be the highest.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import crankpin as cp
import numpy as np
from _timing import interleaved, machine, milliseconds, print_table, write_csv

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from rederivation import tolerances as rederived

RPM = 6000
ORDERS = [1, 2, 4, 6]
SPREADS = {
    "reciprocating_mass": 0.005,
    "rotating_mass": 0.005,
    "crank_radius": 2e-5,
    "pin_deg": 0.2,
    "z": 1e-4,
    "rod_length": 5e-5,
}
ENGINES = ("i4", "v6-60", "v12-60")


def nominal(engine: cp.Engine) -> rederived.Nominal:
    """Return the lists of an engine."""
    cylinders = engine.cylinders
    return rederived.Nominal(
        np.array([c.crank_radius for c in cylinders]),
        np.array([c.rod_length for c in cylinders]),
        np.array([c.reciprocating_mass for c in cylinders]),
        engine.rotating_mass,
        engine.tdc_deg,
        engine.bank_deg,
        engine.z,
    )


def in_numpy(engine: cp.Engine, samples: int) -> rederived.Remains:
    """Draw and evaluate all samples."""
    lists = nominal(engine)
    draws = rederived.normal_draws(lists, SPREADS, samples, seed=0)
    return rederived.remains(lists, draws, RPM, ORDERS, engine.reference_z)


def by_crankpin(engine: cp.Engine, samples: int) -> cp.results.Tolerances:
    """Draw and evaluate all samples."""
    spreads: dict[str, Any] = {**SPREADS}
    return cp.tolerances(engine, rpm=RPM, orders=ORDERS, samples=samples, **spreads)


def main() -> None:
    """Time both, print a table, write the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="folder for the raw figures")
    parser.add_argument("--quick", action="store_true", help="fewer samples and rounds")
    given = parser.parse_args()
    samples, rounds = (2_000, 2) if given.quick else (10_000, 7)
    rows, raw = [], []
    for name in ENGINES:
        engine = cp.Engine.preset(name)
        methods = {
            "NumPy": lambda engine=engine: in_numpy(engine, samples),
            "crankpin": lambda engine=engine: by_crankpin(engine, samples),
        }
        times = interleaved(methods, rounds=rounds)
        ratio = times["NumPy"] / times["crankpin"]
        rows.append([name, *map(milliseconds, times.values()), f"{ratio:.1f}"])
        raw.append([name, samples, *times.values()])
    header = ["engine", *methods, "NumPy / crankpin"]
    print(machine())
    print_table(f"{samples} samples, orders {ORDERS}, all six figures spread", header, rows)
    if given.out is not None:
        header = ["engine", "samples", "NumPy s", "crankpin s"]
        write_csv(given.out / "tolerances.csv", machine(), header, raw)


if __name__ == "__main__":
    main()
