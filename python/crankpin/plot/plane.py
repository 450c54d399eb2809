"""Curves of force and moment in the cross-section plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection

from crankpin._support import inputs, units
from crankpin._support.messages import Hint
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.plot.layout import (
    Panels,
    equal_scales,
    in_units,
    label_x,
    label_y,
    make_panels,
    note_zero,
    width_for,
)
from crankpin.plot.style import (
    SERIES,
    colour_map,
    count_series,
    foreground,
    muted,
    outlined,
    series,
    write,
)
from crankpin.plot.ticks import numeric
from crankpin.plot.words import drawn_quantity, in_degrees, nonzero_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.waveform import Waveform


DOTS = 30.0
"""Degrees between dots."""
LABELS = 4
"""Dots of a period with their angle."""
SAME_LABEL = 0.08
"""Part of the orbit's radius within which dots share one label."""
NARROWEST_PANEL = 0.75
"""The shorter side of panels that share a scale, over the longer one."""
ON_AXIS = 1e-9
"""Part of a point's distance within which it is on an axis: rounding."""
NARROW_CURVE = 0.3
"""Shorter over longer reach below which the angles of a curve stand across its length."""
ARROWS = (15.0, 135.0, 255.0)
"""Crank angles of the arrows, degrees."""


def plane_vector(quantity: object, result: Balance | Waveform) -> str:
    """Return the quantity to draw, one that traces a curve, or raise an InputError."""
    among = PLANE_VECTORS if quantity is None else QUANTITIES
    name = drawn_quantity(quantity, nonzero_in(result), among)
    if name not in PLANE_VECTORS:
        hint = Hint.of('traces no curve; give `quantity="force"` or "moment"')
        raise inputs.rejected("quantity", name, hint)
    return name


def arrow_at(ax: Axes, curve: NDArray[np.complex128], place: int, colour: ColorType) -> None:
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


def trace(
    ax: Axes,
    theta: NDArray[np.float64],
    vectors: Sequence[NDArray[np.float64]],
    names: Sequence[str],
    style: Mapping[str, Any],
    period: float = 360.0,
    *,
    centred: bool = True,
) -> None:
    """Draw the tips of vectors, (n_theta, 2) each, with crank angles and the direction marked.

    What comes after the first period is left out: it would fill the gaps of dashes. ``centred``
    is :func:`scale_plane`'s.
    """
    alone = not count_series(ax) and len(vectors) == 1
    once = theta <= theta.min(initial=np.inf) + period
    theta = theta[once]
    curves = [values[once, 0] + 1j * values[once, 1] for values in vectors]
    for curve, name, look in zip(curves, names, series(ax, len(curves), style), strict=True):
        (line,) = ax.plot(curve.real, curve.imag, gid=SERIES, label=name, **look)
        if not curve.any():
            continue
        for angle in ARROWS:
            place = int(np.searchsorted(theta, angle))
            if 0 < place < len(theta):
                arrow_at(ax, curve, place, line.get_color())
        dots = _places(theta, DOTS, period)
        ax.plot(curve.real[dots], curve.imag[dots], "o", color=line.get_color(), markersize=3.5)
    scale_plane(ax, 1.4, centred=centred)  # room for the angles
    if alone:  # of several curves, numbers would not say whose they are
        for where_to, angles, outward in _beside(_labelled(theta, curves[0], period), curves[0]):
            _annotate(ax, where_to, angles, outward)


def trace_by_angle(
    ax: Axes, theta: NDArray[np.float64], values: NDArray[np.float64], name: str, period: float
) -> LineCollection:
    """Draw the tip of a vector, (n_theta, 2), in colours of the crank angle; return the curve.

    A dot is where the angles begin. There are no others, so that narrow panels can be read.
    """
    once = theta <= theta.min(initial=np.inf) + period
    theta, points = theta[once], values[once]
    ax.plot(*points.T, gid=SERIES, label=name, color=muted(ax, 0.35), linewidth=0.8)
    curve = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)),
        array=0.5 * (theta[:-1] + theta[1:]),
        cmap=colour_map(ax),
        clim=(theta.min(initial=0.0), theta.min(initial=0.0) + period),
        linewidth=1.8,
        capstyle="round",
        zorder=2.5,
    )
    ax.add_collection(curve, autolim=False)
    if points.any():
        ax.plot(*points[0], "o", color=curve.cmap(0.0), markersize=4.5)
    scale_plane(ax, 1.15, centred=False)
    return curve


def _beside(
    labelled: Iterator[tuple[complex, str]], curve: NDArray[np.complex128]
) -> Iterator[tuple[complex, str, complex]]:
    """Yield points with their angles, and to which side these stand.

    Away from the origin; of a long and narrow curve, on which they would stand then, across it.
    """
    high, wide = (abs(part).max(initial=0.0) for part in (curve.imag, curve.real))
    across = 1j if high <= NARROW_CURVE * wide else 1.0 if wide <= NARROW_CURVE * high else 0.0
    for k, (point, angles) in enumerate(labelled):
        side = (point * np.conj(across)).real
        if abs(side) <= ON_AXIS * abs(point):
            side = (-1.0) ** k
        yield point, angles, across * side or point


def _places(theta: NDArray[np.float64], step: float, period: float) -> NDArray[np.intp]:
    """Return the places of multiples of a step in the first period."""
    angles = np.round(theta / step) * step
    within = (abs(theta - angles) < 1e-9) & (theta - theta.min(initial=np.inf) < period - 1e-9)
    return np.flatnonzero(within)


def _labelled(
    theta: NDArray[np.float64], curve: NDArray[np.complex128], period: float
) -> Iterator[tuple[complex, str]]:
    """Yield points and the crank angles at which the curve passes them."""
    near = SAME_LABEL * float(abs(curve).max(initial=0.0))
    rest = list(_places(theta, period / LABELS, period)) if near else []
    while rest:
        here = [place for place in rest if abs(curve[place] - curve[rest[0]]) <= near]
        yield complex(curve[rest[0]]), ", ".join(in_degrees(float(theta[k])) for k in here)
        rest = [place for place in rest if place not in here]


def _annotate(ax: Axes, point: complex, text: str, direction: complex) -> None:
    """Write beside a point, on the side to which a direction leads."""
    outward = direction / abs(direction) if direction else 1.0 + 0.0j
    ha = "center" if abs(outward.real) < 0.5 else "left" if outward.real > 0.0 else "right"
    va = "center" if abs(outward.imag) < 0.5 else "bottom" if outward.imag > 0.0 else "top"
    look: dict[str, Any] = {"ha": ha, "va": va, "color": foreground(ax), "zorder": 5}
    write(ax, text, point, 11.0 * outward, path_effects=outlined(ax), **look)


def make_plane_panels(figure: object, count: int, height: float = 1.0) -> Panels:
    """Make a panel for each of some curves, two beside each other, of many three if there is room.

    ``height`` is that of the curves over their width; panels are low where it is below 1.
    """
    columns, row_height = (3, 0.5) if count > 4 and width_for(figure) > 6.0 else (2, 0.6)
    columns, rows = min(columns, max(1, count)), max(1, -(-count // columns))
    row_height *= min(1.0, max(0.5, height))
    panels = make_panels(None, figure, rows, columns, row_height=row_height)
    for panel in panels.axes.flat[max(1, count) :]:
        panel.set_visible(False)
    return panels


def share_scale(panels: Panels) -> None:
    """Give all panels one scale; its numbers stand beside the outer ones."""
    visible = [panel for panel in panels.axes.flat if panel.get_visible()]
    ends = np.array([panel.dataLim.get_points() for panel in visible])
    limits = np.stack([ends.min(axis=(0, 1)), ends.max(axis=(0, 1))], axis=-1)
    spans = limits[:, 1] - limits[:, 0]
    # Panels of long and narrow curves have room for the angles at them.
    lacking = np.maximum(0.0, NARROWEST_PANEL * spans[::-1] - spans)
    limits += 0.5 * np.stack([-lacking, lacking], axis=-1)
    columns = panels.axes.shape[1]
    for place, panel in enumerate(visible):
        panel.set(xlim=limits[0], ylim=limits[1])
        panel.set_aspect("equal", adjustable="box")
        lowest = place + columns >= len(visible)
        panel.tick_params(labelleft=place % columns == 0, labelbottom=lowest)


def label_panels(panels: Panels, along: str, across: str, unit: str) -> None:
    """Label the axes of all panels together."""
    for panel in panels.axes.flat:
        (below,) = in_units(panel.xaxis, units.headed(along, unit))
        (beside,) = in_units(panel.yaxis, units.headed(across, unit))
    panels.figure.supxlabel(below, fontsize="medium")
    panels.figure.supylabel(beside, fontsize="medium")


def label_plane(ax: Axes, quantity: str, unit: str = "") -> None:
    """Label both axes with the components of force or moment."""
    along_x, along_y = QUANTITIES[quantity].components
    unit = unit or QUANTITIES[quantity].unit
    label_x(ax, units.headed(along_x, unit))
    label_y(ax, units.headed(along_y, unit))


def scale_plane(ax: Axes, reach: float = 1.15, *, centred: bool = True) -> None:
    """Give both axes one scale, ``reach`` times as long as the curves and the origin need.

    The origin is in the middle, or, unless ``centred``, wherever the curves leave it: loads of
    bearings lie on one side of it.
    """
    axes = [line for line in ax.lines if line.get_gid() == "crankpin axis"]
    drawn = [np.asarray(line.get_xydata()) for line in ax.lines if line not in axes]
    ends = np.concatenate([np.zeros((1, 2)), *drawn])
    largest = float(np.abs(ends).max())
    if not axes:
        for along in (ax.axhline, ax.axvline):
            along(0.0, color=muted(ax, 0.35), linewidth=0.8, zorder=1, gid="crankpin axis")
    corners = np.array([[-largest] * 2, [largest] * 2])
    if not centred:
        corners = np.array([ends.min(axis=0), ends.max(axis=0)])
    margin = 0.5 * (reach - 1.0) * float(np.ptp(corners, axis=0).max()) if largest else 1.0
    ax.update_datalim(corners + np.array([[-margin], [margin]]))
    ax.margins(0.0)
    equal_scales(ax)
    numeric(ax.xaxis)
    numeric(ax.yaxis)
    if not largest:
        ax.set(xticks=[0.0], yticks=[0.0])
        note_zero(ax)
