"""Sets of balancing hardware for an engine, with the residual of each."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint, suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import changed
from crankpin.analysis.balancing import planes as correction_planes
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.balancers import BalancerOption, BalancerOptions
from crankpin.analysis.balancing.fitting import Fit, fitted
from crankpin.analysis.balancing.planes import turning
from crankpin.analysis.ranking.objectives import listed as listed_objectives
from crankpin.analysis.request import engine_core
from crankpin.analysis.sweeps.sweep import sweep

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin.analysis.balancing.balance_shafts import Remove
    from crankpin.analysis.balancing.planes import Place, Planes, Turning
    from crankpin.analysis.ranking.objectives import Measure, Objective
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Shaft, Unbalance

Axis: TypeAlias = tuple[float | None, float | None]
"""x and y of a shaft, m, None where it is placed so that it cancels roll torque."""

MOST_SETS = 10_000
"""Largest number of sets."""

TIED = 1e-9
"""Difference, relative to the largest value of an objective, up to which values are equal."""

DEFAULT = ("total.force.peak", "total.moment.peak")
"""Objectives if none are given."""


@documented()
def balancer_options(
    engine: Engine,
    rpm: float,
    *,
    by: str | Measure | Sequence[str | Measure] = DEFAULT,
    target: float | Mapping[str, float] | None = None,
    relative: bool = False,
    shaft_orders: Order | Sequence[Order] = (1, 2),
    most_shafts: int = 4,
    counterweights: bool = True,
    planes: Planes = "ends",
    places: Mapping[Any, Axis] | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
) -> BalancerOptions:
    """Compare the sets of hardware that an engine can be balanced with, and their residuals.

    Compared are all sets of

    * counterweights that remove the forward part of order 1, or none;
    * for each n of ``shaft_orders``, a shaft of ratio −n and one of ratio n, which remove the
      backward and forward part of order n; of ratio 1 only without ``counterweights``, which do the
      same. Where a part has a force and a moment, a shaft may also remove the force alone (by an
      unbalance in the reference plane) or the moment alone (by a couple).

    Hardware with nothing to remove is omitted. A counterweight or shaft that removes a share of its
    part, and several shafts of one ratio, are not compared.

    Parameters
    ----------
    engine : Engine
        The engine, with the counterweights and shafts that it keeps.
    rpm : float
        Crank speed, rpm.
    by : str, callable or sequence of these, optional
        Residuals to minimise: objectives as in :func:`crankpin.rank`, one or several; by default
        the peaks of total force and total moment.
    target : float or mapping of str to float, optional
        Largest admissible residual, in N or N·m: objective → value, or one for all of ``by``.
        Objectives missing in ``by`` are added to it.
    relative : bool, default False
        True if the target is relative to the value of the unchanged engine.
    shaft_orders : number or sequence of numbers, optional
        Orders for which shafts are compared, multiples of 1/2; by default 1 and 2.
    most_shafts : int, default 4
        Largest number of shafts in a set.
    counterweights : bool, default True
        Whether counterweights are compared.
    planes : {"webs", "ends"}, sequence of float or mapping of str to float, default "ends"
        Places of the counterweights along the crank, as in :func:`crankpin.counterweights`; by
        default the first and last cylinder.
    places : mapping of number or str to pair of float or None, optional
        Ratio → x and y of a shaft's axis, m, None where free. Without them places are free: see
        :func:`crankpin.balance_shafts`.

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
    >>> options.smallest.name
    'counterweights + shaft −1'

    One of 60° takes counterweights alone:

    >>> v6 = cp.Engine.preset("v6-60")
    >>> options = cp.balancer_options(v6, rpm=6000, target={"[1].moment.peak": 0.0})
    >>> options.smallest.name
    'counterweights'
    """
    engine_core(engine)
    is_relative = inputs.flag("relative", relative)
    objectives, limits = _objectives(by, target, one_unit=not is_relative)
    with_weights = inputs.flag("counterweights", counterweights)
    if is_relative and target is None:
        raise inputs.rejected("relative", relative, Hint.of("needs `target`; give `target=…`"))
    if not (with_weights or (isinstance(planes, str) and planes == "ends")):
        raise inputs.rejected("planes", planes, Hint.of("needs `counterweights=True`"))
    speed, most = inputs.number("rpm", rpm), inputs.whole("most_shafts", most_shafts)
    if most < 0:
        raise inputs.rejected("most_shafts", most, "give 0 or more")
    places_of_weights = correction_planes.named(engine, planes)
    ratios = _ratios(
        inputs.explicit_half_orders(shaft_orders, "shaft_orders"), with_weights=with_weights
    )
    weights = _counterweights(engine, places_of_weights) if with_weights else ()
    sets = balancer_sets(engine, weights, ratios, _axes(places, ratios), most, speed)
    swept = sweep([candidate.fitted for candidate in sets], rpm=speed, orders=orders, rtol=rtol)
    values = np.column_stack([objective.values(swept)[:, 0] for objective in objectives])
    slack = TIED * np.abs(values).max(axis=0)
    start = {
        objective.label: value
        for objective, value in zip(objectives, values[0].tolist(), strict=True)
    }
    targets = {
        name: limit * start[name] if is_relative else limit for name, limit in limits.items()
    }
    allowed = np.array([targets.get(objective.label, math.inf) for objective in objectives])
    reaches = (values <= allowed + slack).all(axis=1) & bool(targets)
    hardware = np.array([(len(candidate.shafts), candidate.unbalance) for candidate in sets])
    front = _front(
        np.hstack([hardware, values]), np.append([0.0, TIED * hardware[:, 1].max()], slack)
    )
    results = zip(sets, values.tolist(), front.tolist(), reaches.tolist(), strict=True)
    options = tuple(
        changed(candidate, values=tuple(row), on_pareto_front=best, reaches=enough)
        for candidate, row, best, enough in results
    )
    bare = tuple(objective.bare() for objective in objectives)
    return BalancerOptions(engine, speed, bare, tuple(targets.items()), options)


def _ratios(orders: Sequence[Order], *, with_weights: bool) -> list[Order]:
    """Return the ratios of the shafts compared; counterweights do what a shaft of ratio 1 does."""
    every = [ratio for order in dict.fromkeys(orders) for ratio in (-order, order)]
    return [ratio for ratio in every if not (with_weights and ratio == 1)]


def _front(criteria: NDArray[np.float64], slack: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which rows no other row is as good as in all columns, and better in one."""
    # Nothing is better than what a row is better than that is nowhere above it, slack or not.
    least = _least(criteria)
    undominated = np.ones(len(criteria), dtype=bool)
    for k, row in enumerate(criteria):
        as_good = (least <= row + slack).all(axis=1)
        undominated[k] = not (as_good & (least < row - slack).any(axis=1)).any()
    return undominated


def _least(criteria: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rows that no other row is at most in all columns, each once."""
    rows, least = np.unique(criteria, axis=0), []
    while len(rows):
        least.append(rows[0])
        rows = rows[(rows < rows[0]).any(axis=1)]
    return np.array(least)


# --- sets of hardware ---------------------------------------------------------------------------


class Part(NamedTuple):
    """A shaft that may be in a set, on the crank axis."""

    shaft: Shaft
    remove: Remove


def _counterweights(engine: Engine, planes: Mapping[str, Place]) -> tuple[Unbalance, ...]:
    """Return counterweights in planes that remove what turns with their cranks at order 1."""
    # As of shafts, a moment counts as much as a force over half the distance of the cylinders.
    length = float(np.ptp(engine.z)) / 2.0 or None
    fit = Fit("external", (("force", None), ("moment", None)), "squares", length)
    fit_of_planes = fitted(engine, planes, dict.fromkeys(planes, math.inf), None, fit)
    return tuple(weight for _, weight in fit_of_planes.unbalances)


def balancer_sets(
    engine: Engine,
    counterweights: tuple[Unbalance, ...],
    ratios: Sequence[Order],
    places: Mapping[float, Axis],
    most_shafts: int,
    rpm: float,
) -> list[BalancerOption]:
    """Return all sets with or without the counterweights and with a shaft of each ratio or none.

    Ratios that have nothing to remove are left out.
    """
    removals = {ratio: _removals(turning(engine, ratio)) for ratio in ratios}
    by_shafts = [1]
    for alternatives in removals.values():
        one_more = [0, *(len(alternatives) * number for number in by_shafts)]
        by_shafts = list(map(sum, itertools.zip_longest(by_shafts, one_more, fillvalue=0)))
    count = sum(by_shafts[: most_shafts + 1])
    if count > MOST_SETS:
        hint = Hint.of(f"give fewer `orders` or `most_shafts`, for {MOST_SETS} at most")
        raise inputs.faulty("shaft_orders", f"make {count} sets of shafts", hint)
    choices: list[list[Part | None]] = [[None] for _ in removals]
    for parts, (ratio, alternatives) in zip(choices, removals.items(), strict=True):
        for what in alternatives:
            with suppressed():  # of sets that are compared
                fit = balance_shafts(engine, ratio, x=0, y=0, remove=what, rpm=rpm)
            parts.append(Part(fit[0], what))
    weighted = {
        weights: engine.with_counterweights([*engine.counterweights, *weights])
        for weights in dict.fromkeys([(), counterweights])
    }
    sets = []
    for chosen in _choices(choices, most_shafts):
        wanted = [
            (choice.shaft.ratio, places.get(choice.shaft.ratio, (None, None)), None, choice.remove)
            for choice in chosen
        ]
        placed, _ = _core.fit_shafts(engine._core, wanted, rpm)
        shafts = tuple(
            dataclasses.replace(choice.shaft, x=x, y=y)
            for choice, ((x, y), *_) in zip(chosen, placed, strict=True)
        )
        for weights, other in weighted.items():
            with_shafts = other.with_shafts([*engine.shafts, *shafts])
            sets.append(BalancerOption(_name(chosen, weights), weights, shafts, with_shafts))
    return sorted(sets, key=lambda hardware: (len(hardware.shafts), hardware.unbalance))


def _choices(choices: Sequence[Sequence[Part | None]], most: int) -> Iterator[list[Part]]:
    """Yield one choice from each list, of at most ``most`` parts."""
    if not choices:
        yield []
        return
    for choice in choices[0]:
        parts = [] if choice is None else [choice]
        if len(parts) <= most:
            for others in _choices(choices[1:], most - len(parts)):
                yield parts + others


def _removals(turning_parts: Turning) -> tuple[Remove, ...]:
    """Return what a shaft can remove, each another way."""
    if turning_parts.force and turning_parts.moment:
        return ("both", "force", "moment")
    return ("both",) if turning_parts.force or turning_parts.moment else ()


def _name(parts: Sequence[Part], weights: tuple[Unbalance, ...]) -> str:
    words = [
        f"{part.shaft.ratio:+g}".replace("-", "−")
        + ("" if part.remove == "both" else f" ({part.remove} alone)")
        for part in parts
    ]
    shafts = f"shaft{'s' * (len(words) > 1)} {', '.join(words)}" if words else ""
    return " + ".join(filter(None, ["counterweights" if weights else "", shafts])) or "nothing"


# --- arguments ----------------------------------------------------------------------------------


def _objectives(
    by: object, target: object, *, one_unit: bool
) -> tuple[list[Objective], dict[str, float]]:
    """Return the objectives, and the targets as they were given."""
    objectives = listed_objectives(by)
    names = [objective.label for objective in objectives]
    if target is None:
        return objectives, {}
    if not isinstance(target, Mapping):
        if one_unit and len({objective.unit for objective in objectives}) > 1:
            hint = Hint.of(
                "`by` has objectives of several units; give objective → value, or `relative=True`"
            )
            raise inputs.rejected("target", target, hint)
        return objectives, dict.fromkeys(names, _limit("target", target))
    limits = {name: _limit(f"target[{name!r}]", value) for name, value in target.items()}
    more = [name for name in limits if name not in names]
    return objectives + (listed_objectives(more, "target") if more else []), limits


def _limit(name: str, value: object) -> float:
    number = inputs.number(name, value)
    if not 0.0 <= number < math.inf:
        raise inputs.rejected(name, number, "give 0 or more")
    return number


def _axes(places: object, ratios: Sequence[Order]) -> Mapping[float, Axis]:
    """Return ratio → x and y."""
    hint = "give a mapping ratio → (x, y), such as {-1: (0.1, 0.05)}"
    if places is None:
        return {}
    if not isinstance(places, Mapping):
        raise inputs.rejected("places", places, hint)
    axes = {}
    for ratio, place in places.items():
        name = f"places[{inputs.shorten(ratio)}]"
        x_and_y = inputs.items(name, place, hint)
        if len(x_and_y) != 2:
            raise inputs.rejected(name, place, hint)
        x, y = (inputs.optional_number(name, value) for value in x_and_y)
        speed = inputs.speed_ratio(name, ratio)
        if speed not in ratios:
            hint = f"ratios of the shafts compared are {', '.join(map(str, ratios))}"
            raise inputs.rejected(name, place, hint)
        axes[speed] = (x, y)
    return axes
