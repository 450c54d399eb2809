"""Firings: the periods in which valves or ports are open, a row for each cylinder."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.ticker import FuncFormatter, MultipleLocator

from crankpin._support import labels
from crankpin.analysis.firing import Firing
from crankpin.analysis.gas_exchange import PortTiming, ValveTiming
from crankpin.plot._old import COLOURS, RED, dress, entitle, given_or_new, in_degrees, name_of
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@draw.register(Firing)
def _firing(
    result: Firing, ax: Axes | None = None, *, timing: ValveTiming | PortTiming | None = None
) -> Axes:
    if result.strokes == 2:
        ports = result.ports(PortTiming() if timing is None else timing)  # type: ignore[arg-type]
        inlet, inlets, exhausts = "transfer open", ports.transfer, ports.exhaust
    else:
        valves = result.valves(ValveTiming() if timing is None else timing)  # type: ignore[arg-type]
        inlet, inlets, exhausts = "intake open", valves.intake, valves.exhaust
    ax = given_or_new(ax)
    cycle = 180.0 * result.strokes
    # Bank by bank: who shares a manifold as most engines have it stands together.
    rows = [cylinder - 1 for bank in result.banks for cylinder in bank]
    bars = [(inlet, COLOURS[0], inlets), ("exhaust open", RED, exhausts)]
    height = 0.8 / len(bars)
    for k, (name, colour, periods) in enumerate(bars):
        for row, (start, end) in enumerate(periods[rows].tolist()):
            # What runs past the end of the cycle goes on at its beginning.
            pieces = [(start, min(end, cycle) - start)]
            if end > cycle:
                pieces.append((0.0, end - cycle))
            place = (row - 0.4 + k * height, height)
            label = name if row == 0 else ""
            ax.broken_barh(pieces, place, facecolors=colour, label=label)
    ax.plot(
        result.angles_deg[rows],
        range(len(rows)),
        linestyle="",
        marker="D",
        markersize=4.5,
        color="black",
        clip_on=False,
        zorder=3,
        label="fires",
    )
    dress(ax, "x")
    ax.grid(visible=False, axis="y")
    for end in np.cumsum([len(bank) for bank in result.banks])[:-1].tolist():
        ax.axhline(end - 0.5, color="#999999", linewidth=0.8)
    ax.set_xlim(0.0, cycle)
    ax.xaxis.set_major_locator(MultipleLocator(90))
    ax.xaxis.set_major_formatter(FuncFormatter(in_degrees))
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.set_yticks(range(len(rows)), [str(row + 1) for row in rows])
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_xlabel("crank angle θ")
    ax.set_ylabel("cylinder, bank by bank" if len(result.banks) > 1 else "cylinder")
    entitle(ax, name_of(result.engine), labels.cut(result.summary))
    return ax
