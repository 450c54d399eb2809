"""Largest loads and irregularity over speed and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import LOADS
from crankpin.analysis.operating_map import OF_WHEEL, OperatingMap
from crankpin.plot.layout import add_legend, axes_or_new, set_title
from crankpin.plot.maps import DOTTED, heat, scale_from_zero
from crankpin.plot.painter import draw_curves, highest, x_axis, y_axis
from crankpin.plot.style import SERIES, count_series
from crankpin.plot.words import joined, loads_of, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

SPEED, LOAD = "speed, rpm", "load"


@picture.register(OperatingMap)
def _operating_map(
    result: OperatingMap,
    ax: Axes | None = None,
    *,
    quantity: str = "main",
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw a quantity over speed and load.

    A map, or a curve where there is one load or one speed.

    Parameters
    ----------
    quantity : str, default "main"
        A load of :meth:`peak`, the largest of all bearings or cylinders, or
        ``"irregularity"`` or ``"swing_deg"``.
    **style : dict, optional
        Properties of ``pcolormesh``, such as ``cmap``; of a curve ``label`` and properties of
        matplotlib lines.

    Examples
    --------
    >>> import crankpin as cp
    >>> ax = cp.operating_map(cp.Engine.preset("i4"), range(1000, 7000, 500)).plot()
    """
    what, unit, values = _quantity(result, quantity)
    ax = axes_or_new(ax)
    load = np.zeros(1) if result.load is None else result.load
    if min(values.shape) > 1:
        coords, label_of_bar = [result.rpm, load], units.headed(what, unit)
        cells = values.T[..., np.newaxis]
        dotted = heat([ax], coords, cells, label_of_bar, scale_from_zero(values), style)
        x_axis(ax, SPEED)
        y_axis(ax, LOAD)
        where = DOTTED if dotted else ""
    else:
        over_speed = len(load) == 1
        along = result.rpm if over_speed else load
        in_order = np.argsort(along, kind="stable")
        look: dict[str, Any] = {"marker": "o"} if len(along) == 1 else {}
        column = {label or f"_{count_series(ax)}": values.ravel()[in_order]}
        draw_curves(ax, along[in_order], column, style, **look)
        reached = [line.get_xdata() for line in ax.lines if line.get_gid() == SERIES]
        x_axis(ax, SPEED if over_speed else LOAD, np.concatenate(reached))
        y_axis(ax, units.headed(what, unit), largest=highest(ax))
        if label is not None:
            add_legend(ax)
        where = "" if over_speed else f"{number(float(result.rpm[0]))} rpm"
        if over_speed and result.load is not None:
            where = f"load {number(float(load[0]))}"
    set_title(ax, labels.name_of(result.engine), joined(what, where, loads_of(result)))
    return ax


def _quantity(result: OperatingMap, quantity: str) -> tuple[str, str, NDArray[np.float64]]:
    """Return the words, the unit and the values of a quantity by speed and load."""
    name = inputs.one_of("quantity", quantity, (*LOADS, *OF_WHEEL))
    count = 1 if result.load is None else len(result.load)
    if name in LOADS:
        words = f"{LOADS[name].words} load" if LOADS[name].planar else LOADS[name].words
        values = result.read(name).max(axis=-1)
        return f"largest {words}", "N", values.reshape(-1, count)
    if name not in result.quantities:
        raise inputs.rejected("quantity", quantity, "needs the inertia of the operating map")
    values = result.read(name).reshape(-1, count)
    factor, unit = OF_WHEEL[name]
    return name.removesuffix("_deg"), unit, factor * values
