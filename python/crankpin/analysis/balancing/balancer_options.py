"""Hardware that an engine can be balanced with, against what each set of it leaves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.analysis.balancing import correction_planes
from crankpin.analysis.balancing.balancer_sets import balancer_sets, counterweights_at
from crankpin.analysis.balancing.balancers import BalancerOption, BalancerOptions
from crankpin.analysis.ranking.objectives import listed as listed_objectives
from crankpin.analysis.request import engine_core
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders
    from crankpin.analysis.balancing.correction_planes import Planes
    from crankpin.analysis.ranking.objectives import Measure, Objective
    from crankpin.model.engine import Engine

TIED = 1e-9
"""Difference, relative to the largest value of an objective, up to which values are equal."""

DEFAULT = ("total.force.peak", "total.moment.peak")
"""Objectives if none are given."""


def balancer_options(
    engine: Engine,
    *,
    rpm: float,
    by: str | Measure | Sequence[str | Measure] = DEFAULT,
    target: float | Mapping[str, float] | None = None,
    relative: bool = False,
    shaft_orders: int | Sequence[int] = (1, 2),
    most_shafts: int = 4,
    counterweights: bool = True,
    planes: Planes = "ends",
    places: Mapping[int, tuple[float | None, float | None]] | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
) -> BalancerOptions:
    """Compare the hardware that an engine can be balanced with, and what each set leaves.

    Compared are all sets of

    * counterweights that remove the forward part of order 1, or none;
    * for each n of ``shaft_orders``, a shaft of ratio −n and one of ratio n, which remove the
      backward and forward part of order n; of ratio 1 only without ``counterweights``, which do the
      same. Where a part has a force and a moment, a shaft may also remove the force alone (by an
      unbalance in the reference plane) or the moment alone (by a couple).

    What finds nothing to remove is left out. A counterweight or shaft that removes a share of its
    part, and several shafts of one ratio, are not compared.

    Parameters
    ----------
    engine
        The engine, with the counterweights and shafts that it keeps.
    rpm
        Crank speed.
    by
        What is left, to be small: objectives as in :func:`crankpin.rank`, one or several.
    target
        Value that what is left must not exceed, in N or N·m: objective → value, or one for all
        of ``by``. Objectives that ``by`` does not have are added to it.
    relative
        True if the target is a part of what the engine has as it is.
    shaft_orders
        Orders for which shafts are compared.
    most_shafts
        Largest number of shafts in a set.
    counterweights
        Whether counterweights are compared.
    planes
        Places of the counterweights along the crank, as in :func:`crankpin.counterweights`; by
        default the first and last cylinder.
    places
        Ratio → x and y of a shaft's axis, m, None where free. Without them places are free: see
        :func:`crankpin.balance_shafts`.
    orders, rtol
        As in :meth:`Engine.balance`.

    Returns
    -------
    BalancerOptions
        All sets, fewest shafts and least unbalance first: those that no other set is better than,
        and the least that reaches the target.

    Raises
    ------
    InputError
        If an argument is out of range, or there are more than 10 000 sets.

    Examples
    --------
    An even-firing 90° V6 takes counterweights and one shaft at −1 to be free of first-order
    moment:

    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-90")
    >>> options = cp.balancer_options(v6, rpm=6000, target={"[1].moment.peak": 0.0})
    >>> options.least.name
    'counterweights + shaft −1'

    One of 60° takes counterweights alone:

    >>> v6 = cp.Engine.preset("v6-60")
    >>> options = cp.balancer_options(v6, rpm=6000, target={"[1].moment.peak": 0.0})
    >>> options.least.name
    'counterweights'
    """
    engine_core(engine)
    is_relative = inputs.flag("relative", relative)
    objectives, limits = _objectives(by, target, one_unit=not is_relative)
    with_weights = inputs.flag("counterweights", counterweights)
    z = list(correction_planes.named(engine, planes).values())
    most = inputs.whole("most_shafts", most_shafts)
    if most < 0:
        raise InputError(f"most_shafts = {most}: give 0 or more")
    listed = inputs.explicit_orders(shaft_orders, "shaft_orders")
    ratios = _ratios(listed, with_weights=with_weights)
    weights = counterweights_at(engine, z) if with_weights else ()
    sets = balancer_sets(engine, weights, ratios, _checked(places, ratios), most)
    engines = [each.fitted_to(engine) for each in sets]
    speed = inputs.number("rpm", rpm)
    swept = sweep(engines, rpm=speed, orders=orders, rtol=rtol)
    values = np.column_stack([each.values(swept)[:, 0] for each in objectives])
    slack = TIED * np.abs(values).max(axis=0)
    start = {each.label: value for each, value in zip(objectives, values[0].tolist(), strict=True)}
    targets = {
        name: limit * start[name] if is_relative else limit for name, limit in limits.items()
    }
    allowed = np.array([targets.get(each.label, math.inf) for each in objectives])
    reaches = (values <= allowed + slack).all(axis=1) & bool(targets)
    hardware = np.array([(len(each.shafts), each.unbalance) for each in sets])
    front = _front(
        np.hstack([hardware, values]), np.append([0.0, TIED * hardware[:, 1].max()], slack)
    )
    options = tuple(
        BalancerOption(
            each.name, each.counterweights, each.shafts, fitted, each.unbalance, tuple(row), *flags
        )
        for each, fitted, row, *flags in zip(
            sets, engines, values.tolist(), front.tolist(), reaches.tolist(), strict=True
        )
    )
    bare = tuple(each.bare() for each in objectives)
    return BalancerOptions(engine, speed, bare, tuple(targets.items()), options)


def _ratios(orders: Sequence[int], *, with_weights: bool) -> list[int]:
    """Return the ratios of the shafts compared; counterweights do what a shaft of ratio 1 does."""
    every = [ratio for order in dict.fromkeys(orders) for ratio in (-order, order)]
    return [ratio for ratio in every if not (with_weights and ratio == 1)]


def _front(criteria: NDArray[np.float64], slack: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which rows no other row is as good as in all columns, and better in one."""
    found = np.ones(len(criteria), dtype=bool)
    for k, row in enumerate(criteria):
        as_good = (criteria <= row + slack).all(axis=1)
        found[k] = not (as_good & (criteria < row - slack).any(axis=1)).any()
    return found


# --- arguments ----------------------------------------------------------------------------------


def _objectives(
    by: object, target: object, *, one_unit: bool
) -> tuple[list[Objective], dict[str, float]]:
    """Return the objectives, and the targets as they were given."""
    objectives = listed_objectives(by)
    names = [each.label for each in objectives]
    if target is None:
        return objectives, {}
    if not isinstance(target, Mapping):
        if one_unit and len({each.unit for each in objectives}) > 1:
            remedy = "by has objectives of several units; give objective → value, or relative=True"
            raise InputError(f"target = {inputs.shorten(target)}: {remedy}")
        return objectives, dict.fromkeys(names, _limit("target", target))
    limits = {name: _limit(f"target[{name!r}]", value) for name, value in target.items()}
    more = [name for name in limits if name not in names]
    return objectives + (listed_objectives(more) if more else []), limits


def _limit(name: str, value: object) -> float:
    number = inputs.number(name, value)
    if not 0.0 <= number < math.inf:
        raise InputError(f"{name} = {number}: give 0 or more")
    return number


def _checked(
    places: object, ratios: Sequence[int]
) -> Mapping[int, tuple[float | None, float | None]]:
    """Return ratio → x and y."""
    remedy = "give a mapping ratio → (x, y), such as {-1: (0.1, 0.05)}"
    if places is None:
        return {}
    if not isinstance(places, Mapping):
        raise InputError(f"places = {inputs.shorten(places)}: {remedy}")
    found = {}
    for ratio, place in places.items():
        name = f"places[{inputs.shorten(ratio)}]"
        x_and_y = inputs.items(name, place, remedy)
        if len(x_and_y) != 2:
            raise InputError(f"{name} = {inputs.shorten(place)}: {remedy}")
        x, y = (inputs.optional_number(name, each) for each in x_and_y)
        if ratio not in ratios:
            raise InputError(f"{name}: shafts are compared of ratio {', '.join(map(str, ratios))}")
        found[ratio] = (x, y)
    return found
