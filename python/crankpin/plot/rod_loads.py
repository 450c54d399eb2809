"""Load of a piston rod over crank angle: gas, inertia and both, with its reversal shaded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin.analysis.rod_loads import RodLoads
from crankpin.plot.layout import add_legend, axes_or_new, note_zero, set_title
from crankpin.plot.painter import draw_curves, x_axis, y_axis, zero_line
from crankpin.plot.style import muted
from crankpin.plot.words import joined, loads_of, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CURVES = {"rod_load": "both", "gas_load": "gas", "inertia_load": "inertia"}
"""Load → its name in a legend."""
REVERSAL = "crankpin reversal"
"""Marks the shaded angles by their gid."""


@picture.register(RodLoads)
def _rod_loads(
    result: RodLoads,
    ax: Axes | None = None,
    *,
    cylinder: int = 1,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the load of one rod over crank angle, its reversal shaded.

    Parameters
    ----------
    cylinder : int, default 1
        Number of the cylinder.

    Examples
    --------
    >>> import crankpin as cp
    >>> ax = cp.rod_loads(cp.Engine.preset("i4"), rpm=6000).plot()
    """
    chosen = inputs.whole("cylinder", cylinder)
    if not 1 <= chosen <= len(result.engine):
        hint = f"give a number from 1 to {len(result.engine)}"
        raise inputs.rejected("cylinder", chosen, hint)
    ax = axes_or_new(ax)
    place = chosen - 1
    where = f"{labels.name_of(result.engine)}, {number(result.rpm)} rpm"
    turned = f"reversal {result.reversal_deg[place]:.3g}°"
    set_title(ax, f"{where}: load of rod {chosen}", joined(turned, loads_of(result)))
    columns = {name: result.read(load)[place] for load, name in CURVES.items()}
    first = not ax.lines
    draw_curves(ax, result.theta_deg, columns, style, label)
    zero_line(ax)
    x_axis(ax, "crank angle θ", result.theta_deg, by_angle=True)
    y_axis(ax, units.headed("compression", "N"))
    if first:
        _shade(ax, result, place)
    if not columns["both"].any():
        note_zero(ax)
    add_legend(ax)
    return ax


def _shade(ax: Axes, result: RodLoads, place: int) -> None:
    """Shade the angles at which a rod has the sign that it has for less of the cycle."""
    cycle, (first, last) = 180.0 * result.engine.strokes, result.theta_deg[[0, -1]]
    for begin, to in result._reversals[place]:
        turn = -cycle * ((to - first) // cycle)
        while begin + turn < last:
            ends = max(begin + turn, first), min(to + turn, last)
            ax.axvspan(*ends, color=muted(ax, 0.15), linewidth=0, zorder=0, gid=REVERSAL)
            turn += cycle
