"""Curves in the cross-section plane: what force and moment trace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.plot.layout import label_x, label_y, note_zero
from crankpin.plot.style import muted
from crankpin.plot.ticks import numeric
from crankpin.plot.words import drawn_quantity

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def plane_vector(quantity: object, exists: Callable[[str], bool]) -> str:
    """Return the quantity to draw, one that traces a curve, or raise an InputError."""
    among = PLANE_VECTORS if quantity is None else QUANTITIES
    name = drawn_quantity(quantity, exists, among)
    if name not in PLANE_VECTORS:
        hint = 'give quantity="force" or "moment"'
        raise InputError(f"quantity = {name!r} traces no curve; {hint}")
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


def label_plane(ax: Axes, quantity: str, unit: str = "") -> None:
    """Label both axes with the components of force or moment."""
    along_x, along_y = QUANTITIES[quantity].components
    unit = unit or QUANTITIES[quantity].unit
    label_x(ax, f"{along_x}, {unit}")
    label_y(ax, f"{along_y}, {unit}")


def scale_plane(ax: Axes, reach: float = 1.15) -> None:
    """Give both axes one scale about zero, ``reach`` times as long as the curves need."""
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
        note_zero(ax)
