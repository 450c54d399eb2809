"""Curves in the cross-section plane: what force and moment trace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.plot.axes import label_x, label_y, say_zero
from crankpin.plot.style import muted
from crankpin.plot.ticks import numeric

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def plane_vector(quantity: object) -> str:
    """Return a quantity that traces a curve, force or moment, or raise an InputError."""
    name = inputs.one_of("quantity", quantity, QUANTITIES)
    if name not in PLANE_VECTORS:
        cure = 'give quantity="force" or "moment"'
        raise InputError(f"quantity = {name!r} traces no curve; {cure}")
    return name


def arrow_at(ax: Axes, curve: NDArray[np.complex128], place: int, colour: Any) -> None:  # noqa: ANN401
    """Draw the head of an arrow on a curve, in the direction in which it is passed."""
    tip, before = curve[place], curve[place - 1]
    if tip == before:
        return
    # The arrow needs a length, but only its head is wanted.
    tail = tip + 1e-3 * (before - tip) / abs(before - tip) * float(abs(curve).max())
    ax.annotate(
        "",
        (tip.real, tip.imag),
        (tail.real, tail.imag),
        arrowprops={"arrowstyle": "-|>", "color": colour, "mutation_scale": 14.0, "shrinkA": 0.0},
        zorder=3,
    )


def dress_plane(ax: Axes, quantity: str, *, reach: float = 1.15, unit: str = "") -> None:
    """Label both axes, with one scale about zero, ``reach`` times as long as the curves need."""
    along_x, along_y = QUANTITIES[quantity].components
    unit = unit or QUANTITIES[quantity].unit
    label_x(ax, f"{along_x}, {unit}")
    label_y(ax, f"{along_y}, {unit}")
    ends = np.concatenate([np.abs(line.get_xydata()).ravel() for line in ax.lines] or [np.zeros(1)])
    largest = float(ends.max(initial=0.0))
    if not any(line.get_gid() == "crankpin axis" for line in ax.lines):
        for along in (ax.axhline, ax.axvline):
            along(0.0, color=muted(ax, 0.35), linewidth=0.8, zorder=1, gid="crankpin axis")
    end = reach * largest or 1.0
    ax.update_datalim([(-end, -end), (end, end)])
    ax.margins(0.0)
    ax.set_aspect("equal", adjustable="datalim")
    numeric(ax.xaxis)
    numeric(ax.yaxis)
    if not largest:
        ax.set(xticks=[0.0], yticks=[0.0])
        say_zero(ax)
