"""From values to what is printed or written."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes

    from crankpin._support.tables import Table
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.sweeps.sweep import Sweep


def printed(tables: list[Table], *, csv: bool) -> str:
    """Return tables as text below each other, or as CSV."""
    if csv:
        return "".join(table.csv() for table in tables)
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


def write(axes: Axes, path: Path) -> None:
    """Write the figure that these axes are in, and close it."""
    from matplotlib import pyplot as plt  # noqa: PLC0415 - matplotlib is imported when used

    figure = axes.get_figure(root=True)
    assert figure is not None  # noqa: S101 - new axes are in a figure
    try:
        figure.savefig(path, dpi=200)
    finally:
        plt.close(figure)
