"""From values to what is printed or written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from crankpin._support.tables import Table
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.sweeps.sweep import Sweep


def printed(tables: Sequence[Table], *, csv: bool) -> str:
    """Return tables as text below each other, or the first as CSV."""
    if csv:
        return tables[0].csv()
    return "\n\n".join(table.text() for table in tables) + "\n"


def left_out(result: Balance | Sweep) -> str:
    """Return what omitted orders can add, in words."""
    force, moment, torque = result.error_bound
    listed = ", ".join(map(str, result.omitted))
    seen = f"; omitted: {listed}" if listed else ""
    roll = "" if torque is None else f" and {torque:.2g} N·m to the roll torque"
    return (
        f"Omitted orders add at most {force:.2g} N to the force, {moment:.2g} N·m to the "
        f"rocking moment{roll}{seen}.\n"
    )


def draw(result: Any, path: Path | None, **options: str) -> None:  # noqa: ANN401 - what has plot
    """Write the picture of a result, if a file is given."""
    if path is None:
        return
    figure = np.ravel(result.plot(**options))[0].get_figure(root=True)
    from matplotlib import pyplot as plt  # noqa: PLC0415 - plot() says if it is missing

    try:
        figure.savefig(path, dpi=200)
    finally:
        plt.close(figure)
