"""Orbits: the curve that the tip of a force or moment traces over a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin._support.quantities import QUANTITIES
from crankpin.plot.axes import entitle, one_panel
from crankpin.plot.legend import legend_below
from crankpin.plot.plane import arrow_at, dress_plane, plane_vector
from crankpin.plot.style import SERIES, count_series, foreground, series
from crankpin.plot.words import in_degrees, number, summed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.waveform import Waveform

DOTS, LABELS = 30.0, 90.0
"""Degrees between dots, and between dots with their angle."""
SAME = 0.08
"""Part of the orbit's radius within which dots share one label."""
ARROWS = (15.0, 135.0, 255.0)
"""Crank angles of the arrows, degrees."""


def orbit(
    result: Waveform,
    ax: Axes | None = None,
    *,
    quantity: str = "moment",
    label: str | None = None,
    **style: Any,  # noqa: ANN401 - of lines
) -> Axes:
    """Draw the tip of a force or moment, with crank angles and the direction marked."""
    name = plane_vector(quantity)
    ax = one_panel(ax)
    where = f"{QUANTITIES[name].words}, {number(result.rpm)} rpm, {summed(result, name)}"
    entitle(ax, labels.name_of(result.engine), where)
    values, theta = getattr(result, name), result.theta_deg
    # A second turn would fill the gaps of dashes.
    first_turn = theta <= theta.min(initial=np.inf) + 360.0
    values, theta = values[first_turn], theta[first_turn]
    curve = values[:, 0] + 1j * values[:, 1]
    alone = not count_series(ax)
    text = label or labels.name_of(result.engine)
    (look,) = series(ax, 1, style)
    (line,) = ax.plot(curve.real, curve.imag, gid=SERIES, label=text, **look)
    colour = line.get_color()
    if curve.any():
        for angle in ARROWS:
            place = int(np.searchsorted(theta, angle))
            if 0 < place < len(theta):
                arrow_at(ax, curve, place, colour)
        dots = _places(theta, DOTS)
        ax.plot(curve.real[dots], curve.imag[dots], "o", color=colour, markersize=3.5)
    dress_plane(ax, name, reach=1.4)  # room for the angles
    if alone:  # of several orbits, numbers would not say whose they are
        for where_to, angles in _labelled(theta, curve):
            _annotate(ax, where_to, angles)
    legend_below(ax)
    return ax


def _places(theta: NDArray[np.float64], step: float) -> NDArray[np.intp]:
    """Return the places of multiples of a step in the first turn."""
    angles = np.round(theta / step) * step
    within = (abs(theta - angles) < 1e-9) & (theta - theta.min(initial=np.inf) < 360.0 - 1e-9)
    return np.flatnonzero(within)


def _labelled(
    theta: NDArray[np.float64], curve: NDArray[np.complex128]
) -> Iterator[tuple[complex, str]]:
    """Yield points and the crank angles at which the curve passes them."""
    near = SAME * float(abs(curve).max(initial=0.0))
    rest = list(_places(theta, LABELS)) if near else []
    while rest:
        here = [place for place in rest if abs(curve[place] - curve[rest[0]]) <= near]
        yield complex(curve[rest[0]]), ", ".join(in_degrees(float(theta[k])) for k in here)
        rest = [place for place in rest if place not in here]


def _annotate(ax: Axes, point: complex, text: str) -> None:
    """Write beside a point, on the side away from the centre."""
    outward = point / abs(point) if point else 1.0 + 0.0j
    ax.annotate(
        text,
        (point.real, point.imag),
        (11.0 * outward.real, 11.0 * outward.imag),
        textcoords="offset points",
        fontsize="small",
        color=foreground(ax),
        ha="center" if abs(outward.real) < 0.5 else "left" if outward.real > 0.0 else "right",
        va="center" if abs(outward.imag) < 0.5 else "bottom" if outward.imag > 0.0 else "top",
    )
