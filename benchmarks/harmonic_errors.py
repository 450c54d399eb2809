"""How many digits are right? Worst relative error of the harmonics, orders 1-40, to 50 digits.

``python benchmarks/harmonic_errors.py`` prints a row for each rod ratio, without and with pin
offset, from the reference table that the tests use.
"""

from __future__ import annotations

import sys
from pathlib import Path

import crankpin as cp
import numpy as np
from _timing import machine, print_table

TESTS = Path(__file__).parent.parent / "tests"
sys.path.insert(0, str(TESTS))

from rederivation import harmonics_mp  # noqa: E402 - from the tests beside us

ORDERS = list(range(1, 41))


def worst(row: harmonics_mp.ReferenceRow) -> tuple[float, int]:
    """Return the worst relative error of a row and its order."""
    exact = np.array(row.coefficients())
    found = cp.slider_crank_harmonics(row.rod_ratio, ORDERS, row.offset_over_radius)
    errors = np.zeros(len(ORDERS))
    for mine, theirs in ((found.real, exact.real), (found.imag, exact.imag)):
        counted = np.abs(theirs) > 1e-300
        each = np.abs(mine[counted] / theirs[counted] - 1)
        errors[counted] = np.maximum(errors[counted], each)
    return float(errors.max()), int(errors.argmax()) + 1


def main() -> None:
    """Print the table."""
    rows = []
    for row in harmonics_mp.reference_table(TESTS / "data" / "harmonics_50_digits.csv"):
        error, order = worst(row)
        offset = row.offset_over_radius * row.rod_ratio
        rows.append([f"{row.rod_ratio:g}", f"{offset:.3g}", f"{error:.1e}", str(order)])
    print(machine())
    header = ["rod ratio", "offset / rod length", "worst relative error", "at order"]
    print_table("Harmonics 1-40 against 50 digits", header, rows)


if __name__ == "__main__":
    main()
