"""Designs of mounts, one or many, their tolerances, and axes of roll."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin.analysis.mounts.design_mounts import MountDesign
from crankpin.analysis.mounts.design_responses import DesignResponses
from crankpin.analysis.mounts.modes import RollAxes
from crankpin.analysis.mounts.mount_sweep import MountSweep
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.analysis.mounts.robustness import MountRobustness
from crankpin.plot.layout import (
    add_legend,
    axes_or_new,
    equal_scales,
    label_y,
    make_panels,
    set_panel_title,
    set_title,
)
from crankpin.plot.mounts import AT
from crankpin.plot.painter import draw_changes, draw_curves, name_rows, x_axis, y_axis
from crankpin.plot.style import SERIES, foreground, muted, series
from crankpin.plot.words import joined, rounded

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.plot.layout import Panels

THIN_STRENGTH = 0.45
"""Strength of the lines of many designs."""


@picture.register(MountDesign)
def _design(result: MountDesign, ax: Axes | None = None, **style: object) -> Axes:
    """Draw the natural frequencies before and after.

    Parameters
    ----------
    **style : dict, optional
        Properties of matplotlib lines.
    """
    ax = axes_or_new(ax)
    at = AT if result.powertrain._varies else None
    pair = [powertrain.modes(at).frequency for powertrain in (result.powertrain, result.fitted)]
    rows = np.arange(6)
    draw_changes(ax, rows, dict(zip(("before", "designed"), pair, strict=True)), style)
    largest = float(np.max(pair))
    if result.modes_between is not None:
        low, high = result.modes_between
        band: dict[str, Any] = {"color": muted(ax, 0.12), "linewidth": 0.0, "zorder": 0}
        ax.axvspan(low, high, label="modes between", **band)
        largest = max(largest, high)
    name_rows(ax, [f"mode {k + 1}" for k in rows])
    x_axis(ax, "natural frequency, Hz", largest=largest)
    merits = zip(result.names, result.before, result.after, result.limits, strict=True)
    changes = [f"{n} {rounded(a)} → {rounded(b)}" for n, a, b, limit in merits if limit is None]
    missed = "" if result.reached else "requirements not reached"
    set_title(ax, labels.name_of(result.powertrain), joined("mounts designed", missed), *changes)
    add_legend(ax, last="modes between")
    return ax


@picture.register(DesignResponses)
def _designs(
    result: DesignResponses,
    ax: Axes | None = None,
    *,
    design: int | None = None,
    order: Order | None = None,
    mount: str | None = None,
    count: int = 60,
    **style: object,
) -> Axes:
    """Draw a force over speed of many designs, and of one of them bold.

    Parameters
    ----------
    design : int, optional
        Index of the design that is drawn bold; by default that of the least rms force on the
        body.
    order : float, optional
        Order of which peaks are drawn; by default all orders together.
    mount : str, optional
        Name of a mount; by default the sum of all.
    count : int, default 60
        Most designs that are drawn, evenly spread over all.
    **style : dict, optional
        Properties of the bold line.
    """
    name = mount if mount is None else inputs.one_of("mount", mount, result.powertrain.names)
    hint = f"is not among its orders: {labels.orders_text(result.orders)}"
    try:
        wanted = None if order is None else inputs.order(order)
    except (TypeError, ValueError, OverflowError):
        raise inputs.rejected("order", order, hint) from None
    if wanted is not None and wanted not in result.orders:
        raise inputs.rejected("order", order, hint)
    most = inputs.whole("count", count, 1)
    least = int(np.linalg.norm(result.body_force_rms, axis=1).argmin())
    chosen = least if design is None else inputs.whole("design", design)
    bold = result.powertrain_of(chosen)
    ax = axes_or_new(ax)
    speeds = np.sort(np.unique(result.rpm))
    picked = np.unique(np.linspace(0, len(result) - 1, min(most, len(result))).round().astype(int))

    def peaks(k: int) -> NDArray[np.float64]:
        powertrain = bold if k == chosen else result.powertrain_of(k)
        response = powertrain.response(speeds, orders=result.orders)
        force = response.body_force if name is None else response.mount_force[name]
        return np.asarray(force.total.peak if wanted is None else force[wanted].peak)

    thin: dict[str, Any] = {"color": muted(ax, THIN_STRENGTH), "linewidth": 0.6, "zorder": 1.5}
    largest = 0.0
    for place, k in enumerate(picked):
        values = peaks(int(k))
        largest = max(largest, float(values.max()))
        of_all = f"{len(picked)} of {len(result)} designs" if len(picked) < len(result) else ""
        label = of_all or f"{len(result)} designs"
        ax.plot(speeds, values, label="" if place else label, **thin)
    nominal = peaks(chosen)
    bold_line = {"linewidth": 2.2, "linestyle": "-"} | style
    draw_curves(ax, speeds, {f"design {chosen}": nominal}, bold_line)
    x_axis(ax, "crank speed, rpm", speeds)
    y_axis(ax, units.headed("peak", "N"), largest=max(largest, float(nominal.max())))
    words = "force on the body" if name is None else f"force of mount {name}"
    which = "all orders" if wanted is None else f"order {wanted}"
    set_title(
        ax,
        labels.name_of(result.powertrain),
        joined(words, which, result.loads_counted),
        "" if design is not None else f"design {chosen} has the least rms force on the body",
    )
    add_legend(ax)
    return ax


@picture.register(MountSweep)
def _sweep_on_mounts(
    result: MountSweep, ax: Axes | None = None, *, receiver: str | None = None, **style: object
) -> Axes:
    """Draw the largest rms over speed by balance factor, or the rms of each engine over speed.

    Parameters
    ----------
    receiver : str, optional
        Name of a receiver; by default all by factor, the first of engines.
    **style : dict, optional
        Properties of matplotlib lines.
    """
    names = result.names
    if receiver is not None:
        names = (inputs.one_of("receiver", receiver, names),)
    unit, scale = result._shown_in
    (quantity,) = result.quantities.values()
    values = scale * np.asarray(quantity)
    ax = axes_or_new(ax)
    if result.factor is None:
        x, words = result.rpm, names[0]
        rows = values[..., result.names.index(names[0])]
        curves = dict(zip(result.engines, rows, strict=True))
    else:
        x, words = result.factor, "largest over speed"
        curves = {name: values[..., result.names.index(name)].max(axis=1) for name in names}
    sequence = np.argsort(x, kind="stable")
    draw_curves(ax, x[sequence], {name: row[sequence] for name, row in curves.items()}, style)
    if result.factor is None:
        x_axis(ax, "crank speed, rpm", x)
    else:
        marks = {"best on mounts": (result.best(receiver), "-"),
                 "least of the engine alone": (result._classical_factor, ":")}  # fmt: skip
        for label, (factor, dashes) in marks.items():
            if factor is not None and float(x.min()) <= factor <= float(x.max()):
                look: dict[str, Any] = {"color": muted(ax, 0.6), "linewidth": 1.0, "zorder": 1}
                ax.axvline(factor, label=f"{label}, {factor:.3g}", linestyle=dashes, **look)
        x_axis(ax, "balance factor")
    y_axis(ax, units.headed("rms", unit), largest=max(float(row.max()) for row in curves.values()))
    title = joined(quantity.words, words, result.loads_counted)
    set_title(ax, labels.name_of(result.engine), title)
    add_legend(ax)
    return ax


@picture.register(MountRobustness)
def _robustness(result: MountRobustness, ax: Axes | None = None, **style: object) -> Axes:
    """Draw the range of each natural frequency, by cause.

    Parameters
    ----------
    **style : dict, optional
        Properties of matplotlib bars.
    """
    ax = axes_or_new(ax)
    causes = [("stiffness", result.frequency_bounds)] if any(result.stiffness) else []
    if result.mass or result.inertia:
        causes.append(("mass and inertia", result.mass_bounds))
    if result.cg:
        causes.append(("centre of gravity", result.cg_range))
    rows = np.arange(len(result.frequency))
    height = 0.8 / max(len(causes), 1)
    for k, ((name, (low, high)), look) in enumerate(
        zip(causes, series(ax, len(causes), style), strict=True)
    ):
        places = rows + (k - (len(causes) - 1) / 2.0) * height
        bars: dict[str, Any] = {"color": look["color"], "linewidth": 0.0, "gid": SERIES}
        ax.barh(places, high - low, 0.85 * height, low, label=name, **bars)
    mark: dict[str, Any] = {"color": foreground(ax), "linewidth": 1.0, "zorder": 3}
    ax.vlines(result.frequency, rows - 0.45, rows + 0.45, label="nominal", **mark)
    pure = zip(result.purity, result.least_purity, strict=True)
    name_rows(ax, [f"{k + 1}:  {a:.0f} → {b:.0f} %" for k, (a, b) in enumerate(pure)])
    ends = [high for _, (_, high) in causes] or [result.frequency]
    x_axis(ax, "natural frequency, Hz", largest=float(np.max(ends)))
    label_y(ax, "purity → least found")
    name = labels.name_of(result.powertrain)
    on, _, title = units.shown(result.table.title).removeprefix(name).strip().partition(": ")
    set_title(ax, name, joined(on, title))
    add_legend(ax, last="nominal")
    return ax


SAME_AXIS = 1e-9
"""Relative difference of roll stiffnesses, by rounding, within which one axis is drawn."""
VIEWS = (("from the side", 2, 1), ("from the flywheel", 0, 1), ("from above", 2, 0))
"""Name of a view, and the axes to the right and up."""


@picture.register(RollAxes)
def _axes(
    result: RollAxes, ax: Axes | None = None, *, figure: object = None, **style: object
) -> Any:  # noqa: ANN401 - axes, or an array of them
    """Draw the axes with mounts, their polygon and the CG, from three sides.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw the view from the side on.
    **style : dict, optional
        Properties of the lines of both axes.
    """
    panels = make_panels(ax, figure, 3, 1, row_height=0.6)
    powertrain = result.powertrain.in_axes(None)  # as the views are
    result = result if powertrain is result.powertrain else powertrain.axes(result.at_frequency)
    cg = np.array(powertrain.body.cg)
    places = {mount.name: np.array(mount.at) for mount in powertrain.mounts}
    corners = [places[name] for name in powertrain.static().support_polygon]
    static, dynamic = result.roll_stiffness, result.dynamic_roll_stiffness
    is_dynamic = abs(dynamic - static) > SAME_AXIS * static
    dynamic_foot, dynamic_elastic = map(result.read, ("dynamic_elastic_foot", "dynamic_elastic"))
    lines = [
        ("torque roll axis", cg, result.read("torque_roll")),
        ("elastic roll axis", result.read("elastic_foot"), result.read("elastic")),
        *([("with dynamic stiffness", dynamic_foot, dynamic_elastic)] * is_dynamic),
    ]
    distance = units.shown(units.figure(1e3 * result.distance, "mm", 3))
    words = f"{rounded(result.angle_deg)}° and {distance} between the axes"
    words += " at rest" if is_dynamic else ""
    panels.set_title(labels.name_of(powertrain), joined("axes of roll", words))
    _views(panels, powertrain, lines, corners, style)
    return panels.drawn


@picture.register(Powertrain)
def _powertrain(
    result: Powertrain, ax: Axes | None = None, *, figure: object = None, **style: object
) -> Any:  # noqa: ANN401 - axes, or an array of them
    """Draw the mounts, the CG and the axis of the crank, from three sides.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw the view from the side on.
    **style : dict, optional
        Properties of the marks of the mounts.
    """
    panels = make_panels(ax, figure, 3, 1, row_height=0.6)
    _views(panels, result, [], [], {}, style)
    panels.set_title(labels.name_of(result), "engine on its mounts")
    return panels.drawn


Line: TypeAlias = "tuple[str, NDArray[np.float64], NDArray[np.float64]]"
"""Name of a line, a point on it, and its direction."""


def _views(
    panels: Panels,
    powertrain: Powertrain,
    lines: list[Line],
    corners: list[NDArray[np.float64]],
    style: Mapping[str, object],
    of_mounts: Mapping[str, object] = MappingProxyType({}),
) -> None:
    """Draw lines and the crank, mounts, their polygon and the CG, on panels or from the side."""
    views = VIEWS[:1] if panels.single else VIEWS
    places = {mount.name: np.array(mount.at) for mount in powertrain.mounts}
    cg = np.array(powertrain.body.cg)
    everything = np.array([*places.values(), cg, *(foot for _, foot, _ in lines[1:2])])
    reach = 0.5 * float(np.ptp(everything, axis=0).max()) or 0.1
    lines = [*lines, ("crank", np.zeros(3), np.array([0.0, 0.0, 1.0]))]
    for place, (name, right, up) in zip(panels.axes.flat, views, strict=True):
        looks = series(place, len(lines) - 1, style)
        looks.append({"color": muted(place, 0.6), "linestyle": ":", "linewidth": 1.2})
        if corners:
            outline: dict[str, Any] = {"color": muted(place, 0.15), "zorder": 0, "linewidth": 1.0}
            closed = np.array([*corners, corners[0]])[:, [right, up]].T
            place.fill(*closed, label="polygon of the mounts", **outline)
            place.plot(*closed, color=muted(place, 0.4), linewidth=0.8)
        for (label, through, along), look in zip(lines, looks, strict=True):
            middle = through + along * float((everything.mean(axis=0) - through) @ along)
            ends = np.array([middle - 1.5 * reach * along, middle + 1.5 * reach * along])
            if np.hypot(along[right], along[up]) > 0.05:
                place.plot(ends[:, right], ends[:, up], label=label, gid=SERIES, **look)
            else:
                point: dict[str, Any] = {"marker": "x", "linestyle": "", "gid": SERIES}
                place.plot(through[right], through[up], label=label, **(look | point))
        mounts = np.array([*places.values()])
        mark: dict[str, Any] = {"color": foreground(place), "linestyle": "", "zorder": 3}
        squares = mark | {"marker": "s", "label": "mounts"} | dict(of_mounts)
        place.plot(mounts[:, right], mounts[:, up], **squares)
        place.plot(cg[right], cg[up], marker="o", label="centre of gravity", **mark)
        equal_scales(place)
        x_axis(place, units.headed("xyz"[right], "m"))
        y_axis(place, units.headed("xyz"[up], "m"))
        if not panels.single:
            set_panel_title(place, name)
    panels.add_legend(panels.axes.flat[0].get_legend_handles_labels()[0])
