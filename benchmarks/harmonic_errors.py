"""How many digits are right? Worst relative error of the harmonics to 50 digits.

``python benchmarks/harmonic_errors.py`` prints a row for each rod ratio, without and with pin
offset, from the reference tables that the tests use: orders 1-40 over rod ratios and offsets of all
kinds, orders up to 200 where methods fail.
"""

from __future__ import annotations

import methods
import numpy as np
from _references import harmonics_mp, relative_errors
from _timing import machine, print_table


def worst(row: harmonics_mp.ReferenceRow) -> tuple[float, int]:
    """Return the worst relative error of a row and its order."""
    offsets = [row.offset_over_radius]
    (found,) = methods.crankpin(np.array([row.rod_ratio]), row.orders, None, np.array(offsets))
    errors = relative_errors(found, row.coefficients())
    return float(errors.max()), row.orders[int(errors.argmax())]


def main() -> None:
    """Print the tables."""
    print(machine())
    header = ["1 - rod ratio", "offset / rod length", "worst relative error", "at order"]
    for title, path in (
        ("Harmonics 1-40 against 50 digits", harmonics_mp.TABLE),
        ("Harmonics up to order 200, where methods fail", harmonics_mp.HARD_TABLE),
    ):
        rows = []
        for row in harmonics_mp.reference_table(path):
            error, order = worst(row)
            offset = row.offset_over_radius * row.rod_ratio
            ratio = f"{1 - row.rod_ratio:.6g}"
            rows.append([ratio, f"{offset:.3g}", f"{error:.1e}", str(order)])
        print_table(title, header, rows)


if __name__ == "__main__":
    main()
