"""Sets of counterweights and balance shafts that an engine may be fitted with."""

from __future__ import annotations

import dataclasses
import itertools
import math
from typing import TYPE_CHECKING, NamedTuple

from crankpin import _core
from crankpin._core import InputError
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.planes import Turning, turning, weights_in

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from crankpin.analysis.balancing.shaft_requests import Remove
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Shaft, Unbalance

MOST_SETS = 10_000
"""Largest number of sets."""

FREE = (None, None)
"""Place of a shaft that is placed where it cancels roll torque."""


class Part(NamedTuple):
    """A shaft that may be in a set, on the crank axis."""

    shaft: Shaft
    force: complex
    """Its force over ω², kg·m."""
    remove: Remove


class BalancerSet(NamedTuple):
    """Hardware that is fitted to an engine."""

    counterweights: tuple[Unbalance, ...]
    """Counterweights added to the engine's."""
    shafts: tuple[Shaft, ...]
    """Shafts added to the engine's."""
    name: str
    """The set in words."""

    @property
    def unbalance(self) -> float:
        """Sum of the amounts of all unbalances, kg·m."""
        on_shafts = (weight for each in self.shafts for weight in each.unbalances)
        return sum(each.amount for each in (*self.counterweights, *on_shafts))

    def fitted_to(self, engine: Engine) -> Engine:
        """Return the engine with this hardware added."""
        with_weights = engine.with_counterweights([*engine.counterweights, *self.counterweights])
        return with_weights.with_shafts([*engine.shafts, *self.shafts])


def counterweights_at(engine: Engine, z: Sequence[float]) -> tuple[Unbalance, ...]:
    """Return counterweights at places z that remove the forward part of order 1."""
    force, moment = turning(engine, 1)
    return weights_in(engine, Turning(-force, -moment), z)


def balancer_sets(
    engine: Engine,
    counterweights: tuple[Unbalance, ...],
    ratios: Sequence[int],
    places: Mapping[int, tuple[float | None, float | None]],
    most_shafts: int,
) -> list[BalancerSet]:
    """Return all sets with or without the counterweights and with a shaft of each ratio or none.

    Ratios that have nothing to remove are left out.
    """
    removals = {ratio: _removals(turning(engine, ratio)) for ratio in ratios}
    count = math.prod(1 + len(each) for each in removals.values())
    if count > MOST_SETS:
        remedy = f"give fewer orders, for {MOST_SETS} at most"
        raise InputError(f"shaft_orders make {count} sets of shafts: {remedy}")
    choices: list[list[Part | None]] = [[None] for _ in ratios]
    for parts, ratio in zip(choices, ratios, strict=True):
        for what in removals[ratio]:
            fit = balance_shafts(engine, ratio, x=0, y=0, remove=what)
            parts.append(Part(fit[0], fit.exerts[0].force, what))
    orders = dict.fromkeys(map(abs, ratios))
    torques = [(order, _core.roll_torque(engine.core, order)) for order in orders]
    found = []
    for choice in itertools.product(*choices):
        chosen = [each for each in choice if each is not None]
        if len(chosen) > most_shafts:
            continue
        where = [places.get(each.shaft.ratio, FREE) for each in chosen]
        forces = [(each.shaft.ratio, each.force) for each in chosen]
        axes = _core.place_shafts(engine.core, torques, forces, where)
        shafts = tuple(
            dataclasses.replace(each.shaft, x=x, y=y)
            for each, (x, y) in zip(chosen, axes, strict=True)
        )
        found += [
            BalancerSet(weights, shafts, _name(chosen, weighted=bool(weights)))
            for weights in dict.fromkeys([(), counterweights])
        ]
    return sorted(found, key=lambda each: (len(each.shafts), each.unbalance))


def _removals(there: Turning) -> tuple[Remove, ...]:
    """Return what a shaft can remove, each another way."""
    if there.force and there.moment:
        return ("both", "force", "moment")
    return ("both",) if there.force or there.moment else ()


def _name(parts: Sequence[Part], *, weighted: bool) -> str:
    words = [
        f"{each.shaft.ratio:+d}".replace("-", "−")
        + ("" if each.remove == "both" else f" ({each.remove} alone)")
        for each in parts
    ]
    shafts = f"shaft{'s' * (len(words) > 1)} {', '.join(words)}" if words else ""
    return " + ".join(filter(None, ["counterweights" * weighted, shafts])) or "nothing"
