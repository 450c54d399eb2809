"""Largest loads and irregularity over speed and load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import LOADS
from crankpin.analysis.operating_map import OF_WHEEL, OperatingMap
from crankpin.plot.layout import add_legend, axes_or_new, label_x, label_y, note_zero, set_title
from crankpin.plot.maps import DOTTED, heat, scale_from_zero
from crankpin.plot.style import SERIES, count_series, series
from crankpin.plot.ticks import from_zero, numeric, span
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
        numeric(ax.xaxis)
        numeric(ax.yaxis)
        label_x(ax, SPEED)
        label_y(ax, LOAD)
        where = DOTTED if dotted else ""
    else:
        over_speed = len(load) == 1
        along = result.rpm if over_speed else load
        _curve(ax, along, values.ravel(), label, style)
        label_x(ax, SPEED if over_speed else LOAD)
        label_y(ax, units.headed(what, unit))
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


def _curve(
    ax: Axes,
    along: NDArray[np.float64],
    values: NDArray[np.float64],
    label: str | None,
    style: dict[str, Any],
) -> None:
    in_order = np.argsort(along, kind="stable")
    (look,) = series(ax, 1, style)
    drawn: dict[str, Any] = {"gid": SERIES, "label": label or f"_{count_series(ax)}"}
    drawn |= {"marker": "o"} if len(along) == 1 else {}
    ax.plot(along[in_order], values[in_order], **(drawn | look))
    numeric(ax.xaxis)
    numeric(ax.yaxis)
    lines = [line for line in ax.lines if line.get_gid() == SERIES]
    span(ax, np.concatenate([line.get_xdata() for line in lines]))
    from_zero(ax, max(float(np.max(line.get_ydata())) for line in lines))
    if not values.any():
        note_zero(ax)
    if label is not None:
        add_legend(ax)
