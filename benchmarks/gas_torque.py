"""Make the bundled table of gas-torque harmonics.

``python benchmarks/gas_torque.py`` computes the stated cycles of ``crankpin.model.gas_torque`` and
writes ``gas_torque.csv`` into the package, or into the folder ``--out``.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from crankpin.model import gas_torque

LICENCE = """\
# Harmonics of gas torque over imep, piston area and crank radius, of stated Wiebe cycles.
# Copyright the crankpin developers. License: MIT OR Apache-2.0.
# T/(imep A r) = mean + sum of cosine cos(k theta) + sine sin(k theta), theta from the firing TDC.
# Made by: python benchmarks/gas_torque.py
"""


def main() -> None:
    """Compute and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=gas_torque.TABLE_FILE.parent)
    path = parser.parse_args().out / gas_torque.TABLE_FILE.name
    table = gas_torque.compute()
    path.write_text(LICENCE + table.to_csv(), encoding="utf-8")
    print(f"{len(table)} rows written to {path}")


if __name__ == "__main__":
    main()
