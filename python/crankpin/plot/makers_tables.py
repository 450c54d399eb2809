"""Makers' tables as spectra and curves over speed; hammer blow over the turn of the wheels."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.drawing import picture
from crankpin._support.quantities import FOUNDATION, GUIDES, OF_WHEELS
from crankpin.analysis.foundation_table import WAYS, FoundationTable
from crankpin.analysis.guide_moments import GuideMoments
from crankpin.analysis.locomotive import Locomotive
from crankpin.analysis.locomotive_forces import LocomotiveForces
from crankpin.model.engine import Engine
from crankpin.plot.layout import Drawn, add_legend, axes_or_new, make_panels, note_zero, set_title
from crankpin.plot.painter import draw_curves, highest, x_axis, y_axis, zero_line
from crankpin.plot.style import muted
from crankpin.plot.table import drawn_as
from crankpin.plot.torsional_excitation import over_order, over_speed
from crankpin.plot.words import joined, loads_of, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORDS = ("force", "couple")
"""Panels of a foundation table."""
PARTS = {"inertia": "masses", "gas": "gas"}
"""Part of a guide-force moment → its name in a legend."""


@picture.register(FoundationTable)
def _foundation(
    result: FoundationTable,
    ax: Axes | None = None,
    *,
    figure: object = None,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw horizontal and vertical amplitudes: over order, or at several speeds over speed.

    Of an engine with balance shafts those without them stand beside.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for one of the panels; by default new ones.
    quantity : {"force", "couple"}, optional
        The panel that is drawn; by default both, on given axes the force.

    Examples
    --------
    >>> import crankpin as cp
    >>> panels = cp.foundation_table(cp.Engine.preset("i4"), rpm=3000).plot()
    >>> panels.shape
    (2, 1)
    """
    chosen = None if quantity is None else inputs.one_of("quantity", quantity, WORDS)
    words = [chosen] if chosen else list(WORDS if ax is None else WORDS[:1])
    panels = make_panels(ax, figure, len(words), 1, row_height=0.62)
    speeds = np.ravel(result.rpm)
    for panel, word in zip(panels.axes.flat, words, strict=True):
        unit = FOUNDATION[f"vertical_{word}"].unit
        curves = {}
        for (k, state), way in itertools.product(enumerate(result.states), WAYS):
            amplitudes = np.abs(np.asarray(result.read(f"{way}_{word}")))
            behind = ", without shafts" if state == "without" and k else ""
            curves[f"{way}{behind}"] = amplitudes.reshape(
                -1, len(result.states), len(result.orders)
            )[:, k]
        if len(speeds) > 1:
            by_order = {
                f"order {order}, {name}": values[:, place]
                for place, order in enumerate(result.orders)
                for name, values in curves.items()
                if values[:, place].any()
            }
            draw_curves(panel, speeds, by_order, style, label)
            x_axis(panel, "speed, rpm", speeds)
            y_axis(panel, units.headed(word, unit), largest=highest(panel))
            add_legend(panel)
        else:
            at_speed = {name: values[0] for name, values in curves.items()}
            head = units.headed(word, unit)
            over_order(panel, result.orders, at_speed, label, False, style, head)
    where = [f"{number(float(speeds[0]))} rpm"] * (len(speeds) == 1)
    panels.set_title(labels.name_of(result.engine), joined("free forces and couples", *where))
    return panels.drawn


@picture.register(GuideMoments)
def _guide_moments(
    result: GuideMoments,
    ax: Axes | None = None,
    *,
    figure: object = None,
    quantity: str | None = None,
    label: str | None = None,
    **style: object,
) -> Drawn:
    """Draw H-type moment and X-type bimoment: over order, or maps over speed and order.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for one of the panels; by default new ones.
    quantity : {"h_moment", "x_bimoment"}, optional
        The panel that is drawn; by default both, on given axes the H-type.
    **style : dict, optional
        ``label`` and properties of matplotlib lines; of a map properties of ``pcolormesh``.

    Examples
    --------
    >>> import crankpin as cp
    >>> panels = cp.guide_moments(cp.Engine.preset("marine-6"), rpm=210).plot()
    >>> panels.shape
    (2, 1)
    """
    names = ("h_moment", "x_bimoment")
    chosen = None if quantity is None else inputs.one_of("quantity", quantity, names)
    drawn = [chosen] if chosen else list(names if ax is None else names[:1])
    panels = make_panels(ax, figure, len(drawn), 1, row_height=0.62)
    speeds = np.ravel(result.rpm)
    for panel, name in zip(panels.axes.flat, drawn, strict=True):
        head = units.headed(name[0].upper() + "-type", GUIDES[name].unit)
        whole = np.abs(result.read(name))
        if len(speeds) > 1:
            over_speed(panel, speeds, result.orders, whole, False, style, head)
            continue
        curves = {
            words: np.ravel(np.abs(result.read(f"{name}.{part}"))) for part, words in PARTS.items()
        }
        curves = (
            {"sum": np.ravel(whole), **curves} if result.engine.fired else {"": np.ravel(whole)}
        )
        over_order(panel, result.orders, curves, label, False, style, head)
    where = [f"{number(float(speeds[0]))} rpm"] * (len(speeds) == 1)
    panels.set_title(
        labels.name_of(result.engine), joined("guide-force moments", *where, loads_of(result))
    )
    return panels.drawn


@picture.register(LocomotiveForces)
def _locomotive(
    result: LocomotiveForces,
    ax: Axes | None = None,
    *,
    quantity: str = "hammer_blow",
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw a force over the turn of the wheels; hammer blows with the static load.

    Where a hammer blow reaches the line of minus the static load, the wheel lifts.

    Parameters
    ----------
    quantity : {"hammer_blow", "tractive_variation", "swaying_couple"}, default "hammer_blow"
        Force, or couple, that is drawn.

    Examples
    --------
    >>> import math
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.3, rod_length=math.inf, reciprocating_mass=300)
    >>> two = cp.Locomotive(cylinder, z=[-0.35, 0.35], throws_deg=[0, 90], wheel_z=[-0.8, 0.8],
    ...                     share=0.6, wheel_load=70e3)
    >>> ax = two.forces(rpm=280).plot()
    """
    name = inputs.one_of("quantity", quantity, OF_WHEELS)
    ax = axes_or_new(ax)
    by_wheel = name == "hammer_blow"
    locomotive = result.locomotive
    values = np.atleast_2d(np.asarray(result.read(name)))
    names = locomotive.wheels if by_wheel else ("",)
    columns = dict(zip(names, values, strict=True))
    draw_curves(ax, result.theta_deg, columns, style, label)
    zero_line(ax)
    if by_wheel:
        look: dict[str, Any] = {
            "color": muted(ax, 0.8),
            "linewidth": 1.2,
            "linestyle": ":",
            "zorder": 1,
        }
        for k, load in enumerate(dict.fromkeys(locomotive._loads)):
            text = "" if k else "− static load: the wheel lifts"
            ax.axhline(-load, label=text or "_", gid="crankpin load", **look)
    if not values.any():
        note_zero(ax)
    x_axis(ax, "angle of the wheels", result.theta_deg, by_angle=True)
    y_axis(ax, units.headed(OF_WHEELS[name].words, OF_WHEELS[name].unit))
    speed = f"{number(result.rpm)} rpm"
    if locomotive.wheel_diameter is not None:
        speed = f"{number(result.speed_kmh)} km/h"
    title = labels.one_line(locomotive.name) or "Locomotive"
    set_title(ax, title, joined(OF_WHEELS[name].words, speed))
    add_legend(ax)
    return ax


drawn_as(
    Locomotive,
    Engine,
    lambda locomotive: locomotive.engine,
    "Draw its engine, as :meth:`Engine.plot`.",
)
