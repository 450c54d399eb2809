"""Torque of one cylinder on the crank: over order at one speed, over speed and order at several."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin.analysis.torsional_excitation import TorsionalExcitation
from crankpin.plot.balance import OVER_ORDER, ZERO, beside_each_other, scale_spectrum, stems
from crankpin.plot.layout import add_legend, axes_or_new, label_x, label_y, set_title
from crankpin.plot.maps import cells, colour_bar, logarithmic_scale, scale_from_zero
from crankpin.plot.painter import x_axis, y_axis
from crankpin.plot.style import series
from crankpin.plot.words import joined, loads_of, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

PART_NAMES = {"gas": "gas", "inertia": "masses", "torque": "sum"}
"""Part of the torque → its name in a legend."""
AMPLITUDE = units.headed("amplitude", "N·m")


@picture.register(TorsionalExcitation)
def _torsional_excitation(
    result: TorsionalExcitation,
    ax: Axes | None = None,
    *,
    cylinder: int = 1,
    part: str | None = None,
    log: bool | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the amplitudes of one cylinder's torque.

    At one speed over order, at several a map over speed and order.

    Parameters
    ----------
    cylinder : int, default 1
        Number of the cylinder.
    part : {"gas", "inertia", "torque"}, optional
        Part of the torque; by default all three at one speed, and their sum at several.
    log : bool, optional
        Whether amplitudes are on a logarithmic scale; by default those of a map.
    **style : dict, optional
        ``label`` and properties of matplotlib lines; of a map properties of ``pcolormesh``,
        such as ``cmap``.

    Examples
    --------
    >>> import crankpin as cp
    >>> excitation = cp.torsional_excitation(cp.Engine.preset("i4"), rpm=3000)
    >>> ax = excitation.plot()
    """
    count = len(result.engine)
    place = inputs.whole("cylinder", cylinder, 1) - 1
    if place >= count:
        raise inputs.rejected("cylinder", cylinder, f"give 1 to {count}")
    chosen = None if part is None else inputs.one_of("part", part, PART_NAMES)
    speeds = np.ravel(result.rpm)
    several = len(speeds) > 1
    logarithmic = several if log is None else inputs.flag("log", log)
    ax = axes_or_new(ax)
    if several:
        name = chosen or "torque"
        over_speed(
            ax, speeds, result.orders, _amplitudes(result, name)[:, place], logarithmic, style
        )
        where = ""
    else:
        fired = bool(result.crank_torque.gas[..., place, :].any())
        drawn = [chosen] if chosen else list(PART_NAMES) if fired else ["inertia"]
        curves = {name: _amplitudes(result, name)[0, place] for name in drawn}
        over_order(ax, result.orders, curves, label, logarithmic, style)
        where = f"{number(float(speeds[0]))} rpm"
    of = f" of {PART_NAMES[chosen]}" if chosen in ("gas", "inertia") else ""
    what = joined(f"torque{of} on the crank", f"cylinder {place + 1}", where, loads_of(result))
    set_title(ax, labels.name_of(result.engine), what)
    return ax


def _amplitudes(result: TorsionalExcitation, part: str) -> NDArray[np.float64]:
    """Return amplitudes by speed, cylinder and order."""
    torque = result.crank_torque if part == "torque" else result.crank_torque.part(part)
    shape = (len(np.ravel(result.rpm)), len(result.engine), len(result.orders))
    return np.reshape(np.abs(torque), shape)


def over_order(
    ax: Axes,
    orders: tuple[Any, ...],
    curves: dict[str, NDArray[np.float64]],
    label: str | None,
    logarithmic: bool,
    style: dict[str, Any],
    amplitude: str = AMPLITUDE,
) -> None:
    """Draw amplitudes over order, those of each part beside each other."""
    along = np.array(orders, dtype=np.float64)
    for (part, values), look in zip(curves.items(), series(ax, len(curves), style), strict=True):
        name = joined(label or "", PART_NAMES.get(part, part))
        stems(ax, along, values, label if label and len(curves) == 1 else name, look)
    beside_each_other(ax)
    scale_spectrum(ax, logarithmic=logarithmic, orders_given=False)
    label_x(ax, OVER_ORDER)
    label_y(ax, amplitude)
    add_legend(ax, last=ZERO)


def over_speed(
    ax: Axes,
    speeds: NDArray[np.float64],
    orders: tuple[Any, ...],
    amplitudes: NDArray[np.float64],
    logarithmic: bool,
    style: dict[str, Any],
    amplitude: str = AMPLITUDE,
) -> None:
    """Draw a map of amplitudes over speed and order."""
    norm = (logarithmic_scale if logarithmic else scale_from_zero)(amplitudes)
    mesh = cells([ax], speeds, orders, amplitudes[..., np.newaxis], {"norm": norm} | style)
    if amplitudes.any():
        colour_bar([ax], mesh, amplitude, amplitudes)
    x_axis(ax, "speed, rpm")
    y_axis(ax, "order", whole=True)
