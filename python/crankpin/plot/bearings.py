"""Loads inside an engine: polar load diagrams, curves over crank angle, bending along z."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import LOADS
from crankpin.analysis.bearings import CUT_PARTS, BearingLoads
from crankpin.plot.layout import (
    Drawn,
    Kinds,
    add_legend,
    axes_or_new,
    draw_kind,
    label_x,
    label_y,
    note_zero,
    reject_figure,
    set_panel_title,
    set_title,
)
from crankpin.plot.painter import draw_curves, highest, x_axis, y_axis, zero_line
from crankpin.plot.plane import label_panels, make_plane_panels, share_scale, trace, trace_by_angle
from crankpin.plot.style import count_series, muted
from crankpin.plot.ticks import degrees
from crankpin.plot.words import joined, loads_of, number

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes

ALONG = {
    "engine": ("along x", "along y"),
    "crank": ("along the throw, outwards", "ahead of it"),
    "rod": ("along the rod, to the wrist pin", "across it, ahead"),
}
"""Axes of a load → their names."""


def polar(
    result: BearingLoads,
    ax: Axes | None = None,
    figure: object = None,
    *,
    load: str = "main",
    numbers: Iterable[int] | None = None,
    axes: str = "engine",
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw the tips of loads: a panel for each bearing, or all of them on given axes."""
    vectors = result.turned(load, axes)
    places = _places(numbers, len(vectors))
    names = _names(load, places, label)
    period = 180.0 * result.engine.strokes if result.gas_force.any() else 360.0
    what = f"{LOADS[load].words} loads"
    if ax is not None or (figure is None and len(places) == 1):
        ax = axes_or_new(ax)
        set_title(ax, *_titles(result, what))
        drawn = [vectors[k] for k in places]
        trace(ax, result.theta_deg, drawn, names, style, period, centred=False)
        label_x(ax, units.headed(ALONG[axes][0], "N"))
        label_y(ax, units.headed(ALONG[axes][1], "N"))
        add_legend(ax)
        return ax
    wide, high = np.ptp([*vectors[places].reshape(-1, 2), (0.0, 0.0)], axis=0).tolist()
    panels = make_plane_panels(figure, len(places), high / wide if wide else 1.0)
    by_angle = None
    for panel, place, name in zip(panels.axes.flat, places, names, strict=False):
        if style:
            trace(panel, result.theta_deg, [vectors[place]], [name], style, period, centred=False)
        else:
            by_angle = trace_by_angle(panel, result.theta_deg, vectors[place], name, period)
        set_panel_title(panel, name)
    share_scale(panels)
    if by_angle is not None:
        bar = panels.figure.colorbar(by_angle, ax=panels.axes.ravel().tolist(), aspect=35, pad=0.02)
        degrees(bar.ax.yaxis)
        bar.set_label("crank angle θ")
    label_panels(panels, *ALONG[axes], "N")
    panels.set_title(*_titles(result, what))
    return panels.axes


def curves(
    result: BearingLoads,
    ax: Axes | None = None,
    figure: object = None,
    *,
    load: str = "main",
    numbers: Iterable[int] | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the magnitudes of bearing loads over crank angle; of other loads, their values."""
    kind = LOADS[inputs.one_of("load", load, LOADS)]
    values = result.read(load, "magnitude" if kind.planar else "values")
    places = _places(numbers, len(values))
    reject_figure(figure, "curves")
    ax = axes_or_new(ax)
    where = kind.components[0] if not kind.planar else "magnitude"
    set_title(ax, *_titles(result, f"{kind.words}, {where}"))
    columns = dict(zip(_names(load, places, label), values[places], strict=True))
    draw_curves(ax, result.theta_deg, columns, style)
    zero_line(ax)
    x_axis(ax, "crank angle θ", result.theta_deg, by_angle=True)
    y_axis(ax, units.headed(kind.words, "N"))
    if not values.any():
        note_zero(ax)
    add_legend(ax)
    return ax


def bending(
    result: BearingLoads,
    ax: Axes | None = None,
    figure: object = None,
    *,
    part: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the largest bending moments along z, of each crank, with the main bearings."""
    parts = CUT_PARTS if part is None else (inputs.one_of("part", part, CUT_PARTS),)
    cranks = sorted(set(result.main_crank.tolist()))
    cuts = [(kind, k) for kind in parts for k in (cranks if kind == "crank" else cranks[:1])]
    reject_figure(figure, "bending")
    ax = axes_or_new(ax)
    first = not count_series(ax)
    what = f"largest bending moment at {len(result.theta_deg)} crank angles"
    set_title(ax, *_titles(result, what))
    columns = {}
    for kind, k in cuts:
        moments = result.bending(kind, crank=k)
        cut = f"crank {k}" if kind == "crank" and len(cranks) > 1 else kind
        name = cut if label is None or len(cuts) > 1 else ""
        columns[name] = np.hypot(moments[..., 0], moments[..., 1]).max(axis=1, initial=0.0)
    draw_curves(ax, result.z, columns, style, label)
    if first:
        look: dict[str, Any] = {"color": muted(ax, 0.5), "linewidth": 0.8, "zorder": 1}
        look |= {"gid": "crankpin mains"}
        ax.vlines(result.main_z, 0.0, 1.0, transform=ax.get_xaxis_transform(), **look)
    x_axis(ax, units.Text(units.headed("z", "m"), " (lines: main bearings)"), result.z)
    y_axis(ax, units.headed("bending moment", "N·m"), largest=highest(ax))
    add_legend(ax)
    return ax


def _titles(result: BearingLoads, what: str) -> tuple[str, str]:
    return labels.name_of(result.engine), joined(
        what, f"{number(result.rpm)} rpm", loads_of(result)
    )


def _places(numbers: Iterable[int] | None, count: int) -> list[int]:
    """Return the places in a list of bearings or cylinders that are numbered from 1."""
    if numbers is None:
        return list(range(count))
    hint = f"give whole numbers from 1 to {count}"
    chosen = [inputs.whole("numbers", number) for number in inputs.items("numbers", numbers, hint)]
    if not chosen or not all(1 <= number <= count for number in chosen):
        raise inputs.rejected("numbers", chosen, hint)
    return [number - 1 for number in chosen]


def _names(load: str, places: list[int], label: str | None) -> list[str]:
    """Return the entries of a legend."""
    if label is not None and len(places) == 1:
        return [label]
    before = f"{label}, " if label else ""
    return [f"{before}{LOADS[load].words} {place + 1}" for place in places]


LOAD_PICTURES: Kinds = {"polar": polar, "curves": curves, "bending": bending}


@picture.register(BearingLoads)
def _bearings(
    result: BearingLoads,
    ax: object = None,
    *,
    figure: object = None,
    kind: str = "polar",
    load: str | None = None,
    numbers: object = None,
    axes: str | None = None,
    part: str | None = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw loads.

    Parameters
    ----------
    kind : {"polar", "curves", "bending"}, default "polar"
        ``"polar"``: the tip of a load, a panel for each bearing in colours of the crank angle,
        or with ``ax`` or a colour of yours with crank angles beside it. ``"curves"``:
        magnitudes over crank angle. ``"bending"``: largest bending moment along z.
    load : str, optional
        Load of ``"polar"`` and ``"curves"``, as in :meth:`read`; by default the main bearings.
    numbers : sequence of int, optional
        Bearings or cylinders of these kinds, from 1; by default all.
    axes : {"engine", "crank", "rod"}, optional
        Axes of ``"polar"``, as in :meth:`turned`; by default those of the engine.
    part : {"crank", "crankcase"}, optional
        Part of ``"bending"``; by default both.

    Returns
    -------
    matplotlib.axes.Axes or ndarray of Axes
        The axes; of several bearings the panels, (n_rows, n_columns).

    Examples
    --------
    >>> import crankpin as cp
    >>> loads = cp.bearing_loads(cp.Engine.preset("i4"), rpm=6000)
    >>> loads.plot().shape
    (2, 3)
    >>> ax = loads.plot(load="crankpin", numbers=[1], axes="crank")
    >>> ax = loads.plot(kind="bending", part="crankcase")
    """
    options = {"load": load, "numbers": numbers, "axes": axes, "part": part, "label": label}
    return draw_kind(LOAD_PICTURES, kind, result, ax, figure, **options, **style)
