"""Balance shafts fitted to an engine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import inputs
from crankpin.analysis.balancing.fitted_shaft import FittedShaft
from crankpin.analysis.balancing.fitted_shafts import BalanceShafts
from crankpin.analysis.balancing.lanchester import placed
from crankpin.analysis.balancing.planes import (
    Turning,
    ends,
    fitted,
    length_of,
    roll_torque,
    turning,
    unbalances,
)
from crankpin.analysis.balancing.shaft_wishes import extra_torques, wishes
from crankpin.analysis.request import engine_core
from crankpin.model.shafts import Shaft

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from crankpin.analysis.balancing.shaft_wishes import Remove, Wish
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance

INSIDE = 1e-12
"""Rounding, relative to the engine's length, in the place of a single plane."""


def balance_shafts(
    engine: Engine,
    ratios: int | Sequence[int],
    *,
    x: float | Sequence[float | None] | None = None,
    y: float | Sequence[float | None] | None = None,
    planes: Sequence[float] | Sequence[Sequence[float] | None] | None = None,
    bearings: Sequence[float] | Sequence[Sequence[float] | None] | None = None,
    remove: Remove | Sequence[Remove] = "both",
    reference_z: float | None = None,
    extra_torque: Mapping[int, complex] | None = None,
    rpm: float | None = None,
) -> BalanceShafts:
    """Fit balance shafts to an engine.

    A shaft of ratio n > 0 removes the forward part of order n, of force and of moment, a shaft of
    ratio −n the backward part; neither changes the other part. Shafts of the same ratio share their
    task so that the sum of the squares of their unbalances is least. The shafts are added to those
    that the engine has, and its counterweights stay.

    Parameters
    ----------
    engine
        The engine, with its counterweights.
    ratios
        Speed of each shaft over crank speed: −1 for one that turns against the crank, ``[2, -2]``
        for a Lanchester pair.
    x, y
        Axis of each shaft from the crank axis, seen from the flywheel, m: a number for all, or a
        list with one for each. None is free: such coordinates are placed where the shafts cancel
        the roll torque of their order, or come closest to it, as near the crank axis as that
        allows: far away where the torque is large beside the forces.
    planes
        Places of the unbalances along the crank, m: for all shafts, such as ``[0.0, 0.3]``, or a
        list of these, one for each shaft. None is free: a single plane where that is enough, the
        first and last cylinder elsewhere.
    bearings
        Places of the two bearings along the crank, m, as ``planes``; by default the first and last
        cylinder.
    remove
        ``"both"``, ``"force"`` (by an unbalance that makes no moment about the reference plane) or
        ``"moment"`` (by a couple, without force): for all shafts, or a list with one for each.
        Shafts of the same ratio have the same.
    reference_z
        Plane about which moments are taken, m; by default that of the engine.
    extra_torque
        Order → peak phasor of a torque on the block about +z that is not of inertia, such as gas
        torque, N·m: free places cancel it together with the engine's roll torque.
    rpm
        Crank speed at which ``extra_torque`` acts.

    Returns
    -------
    BalanceShafts
        The shafts, the engine with them, and what stays.

    Raises
    ------
    InputError
        If an argument is out of range, or a couple is asked of a single plane.

    Notes
    -----
    From two planes on, force and moment are both removed. In a single plane the sum of squares of
    what stays is least, moments taken over half the distance between the first and last cylinder;
    ``remove="force"`` removes all of the force there.

    Examples
    --------
    One shaft against the crank removes the backward first-order couple of an inline-3, whose
    forward one takes counterweights:

    >>> import crankpin as cp
    >>> i3 = cp.Engine.preset("i3")
    >>> fit = cp.balance_shafts(i3, -1)
    >>> [round(each.amount, 6) for each in fit[0].shaft.unbalances]
    [0.008379, 0.008379]
    >>> bool(fit.balance(rpm=3000)[1].moment.backward)
    False

    A Lanchester pair, 160 mm apart, at the heights that cancel the second-order roll torque too:

    >>> i4 = cp.Engine.preset("i4")
    >>> pair = cp.balance_shafts(i4, [2, -2], x=[0.08, -0.08])
    >>> [round(each.shaft.y, 4) for each in pair]
    [0.0709, -0.0709]
    >>> second = pair.balance(rpm=6000, orders=[2])[2]
    >>> float(round(second.force.peak, 6)), float(round(second.torque.peak, 6))
    (0.0, 0.0)
    """
    engine_core(engine)
    plane = inputs.optional_number("reference_z", reference_z)
    asked = wishes(ratios, x=x, y=y, planes=planes, bearings=bearings, remove=remove)
    extra = extra_torques(extra_torque, rpm, {each.order for each in asked})
    torques = {
        order: roll_torque(engine, order) + extra.get(order, 0j)
        for order in dict.fromkeys(each.order for each in asked)
    }
    on_the_axis = _on_the_axis(engine, asked, plane)
    shafts = at_places(on_the_axis, [(each.x, each.y) for each in asked], torques)
    return BalanceShafts(engine, shafts, plane, tuple(extra.items()))


def at_places(
    shafts: Sequence[FittedShaft],
    places: Sequence[tuple[float | None, float | None]],
    torques: Mapping[int, complex],
) -> tuple[FittedShaft, ...]:
    """Return the shafts with their axes at places, free coordinates where they cancel roll torque.

    Parameters
    ----------
    shafts
        The shafts, wherever they are.
    places
        x and y of each, m; None is free.
    torques
        Order → phasor of the roll torque without the shafts, over ω², kg·m².
    """
    found = list(shafts)
    for order in dict.fromkeys(each.order for each in shafts):
        which = [k for k, each in enumerate(shafts) if each.order == order]
        forces = [(shafts[k].shaft.ratio, shafts[k].makes.force) for k in which]
        axes = placed(torques[order], forces, [places[k] for k in which])
        for k, axis in zip(which, axes, strict=True):
            found[k] = shafts[k].moved(*axis)
    return tuple(found)


def _on_the_axis(
    engine: Engine, asked: Sequence[Wish], reference_z: float | None
) -> list[FittedShaft]:
    """Return the shafts with their unbalances, all on the crank axis."""
    z0 = engine.reference_z if reference_z is None else reference_z
    places = ends(engine)
    bearings = (places[0], places[-1]) if len(places) > 1 else None
    of_ratio = {
        ratio: iter(_of_ratio(engine, [w for w in asked if w.ratio == ratio], reference_z))
        for ratio in dict.fromkeys(each.ratio for each in asked)
    }
    return [
        FittedShaft(Shaft(each.ratio, next(of_ratio[each.ratio])), z0, each.bearings or bearings)
        for each in asked
    ]


def _of_ratio(
    engine: Engine, asked: Sequence[Wish], reference_z: float | None
) -> list[tuple[Unbalance, ...]]:
    """Return the unbalances of each of the shafts of one ratio, which share their task."""
    ratio, remove = asked[0].ratio, asked[0].remove
    z0 = engine.reference_z if reference_z is None else reference_z
    there = turning(engine, ratio, reference_z)
    wanted = Turning(
        0j if remove == "moment" else -there.force / ratio**2,
        0j if remove == "force" else -there.moment / ratio**2,
    )
    free = _free_planes(engine, wanted, z0)
    planes = [free if each.planes is None else each.planes for each in asked]
    every = [z for each in planes for z in each]
    # From a single plane a force makes the moment that it makes.
    force_alone = remove == "force" and len(every) == 1
    vectors = fitted(wanted, every, z0, math.inf if force_alone else length_of(engine))
    starts = np.cumsum([len(each) for each in planes])[:-1]
    parts = np.split(vectors, starts)
    return [unbalances(part, z) for part, z in zip(parts, planes, strict=True)]


def _free_planes(engine: Engine, wanted: Turning, z0: float) -> tuple[float, ...]:
    """Return the single plane in which an unbalance makes this force and moment, or the ends."""
    places = ends(engine)
    first, last = places[0], places[-1]
    if wanted.force and last > first:
        lever = wanted.moment / (1j * wanted.force)
        at = z0 + lever.real
        if abs(lever.imag) <= INSIDE * (last - first) and first <= at <= last:
            return (at,)
    return places
