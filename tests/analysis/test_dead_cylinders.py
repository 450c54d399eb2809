"""Does everything that reads a firing order read who fires, too?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
from support import in_turn

RPM = 3000.0
ORDERS = tuple(half / 2 for half in range(1, 17))
ROUNDING = 1e-12
"""Of sums of at most twelve phasors, relative to the largest of them."""


def fired(engine: cp.Engine, seed: int) -> cp.Engine:
    """An engine of which some cylinders, but not all, have one cycle."""
    random = np.random.default_rng(seed)
    cylinders = [each.replace(bore=0.08) for each in engine.cylinders]
    cycles: list[cp.Cycle | None] = [cp.Cycle.example(strokes=engine.strokes)] * len(engine)
    for dead in random.choice(len(engine), random.integers(1, len(engine)), replace=False):
        cycles[dead] = None
    return engine.replace(cylinder=cylinders).with_cycle(cycles)


NAMES = [
    "i2-360",
    "i3",
    "i4",
    "i5",
    "i6",
    "v6-60",
    "v8-crossplane",
    "v8-flatplane",
    "boxer4",
    "v12-60",
]
ENGINES = [(name, seed) for name in NAMES if name in cp.presets() for seed in range(4)]


def test_one_dead_cylinder_of_four() -> None:
    engine = fired(cp.Engine.preset("i4"), 0)
    cycle = next(each for each in engine.cycles or () if each is not None)
    engine = engine.with_cycle([cycle, cycle, None, cycle])
    assert not engine.fires_evenly
    assert engine.firing().order == (1, 4, 2)
    assert engine.firing().intervals_deg.tolist() == [360.0, 180.0, 180.0]
    assert "cylinder 3 does not fire" in engine.firing().summary
    gas = engine.vanishing_orders([0.5, 1, 1.5, 2]).gas_torque
    assert gas.vanishing == ()
    said = " ".join(engine.explain(RPM).sentences)
    assert "fires unevenly, at intervals of 360-180-180°: 1-3-4-2, of which cylinder 3" in said
    assert "Uneven firing leaves gas torque of orders 0.5, 1 and 1.5" in said
    assert engine.replace(firing_order="1-3-4-2").firing().firing_order == "1-3-4-2"


@in_turn(("name", "seed"), ENGINES)
def test_what_is_said_of_half_orders_is_what_a_balance_has(name: str, seed: int) -> None:
    engine = fired(cp.Engine.preset(name), seed)
    verdicts = engine.vanishing_orders(ORDERS).gas_torque
    gas = np.abs(engine.balance(RPM, orders=ORDERS).torque.gas)
    one = engine.with_cycle(
        [
            each if k == engine.firing().order[0] - 1 else None
            for k, each in enumerate(engine.cycles or ())
        ]
    )
    alone = np.abs(one.balance(RPM, orders=ORDERS).torque.gas)
    for order, total, single in zip(ORDERS, gas, alone, strict=True):
        assert (order in verdicts.vanishing) == (total <= ROUNDING * single), order
        assert order not in verdicts.undecided


@in_turn(("name", "seed"), ENGINES)
def test_the_star_of_an_engine_has_those_that_fire(name: str, seed: int) -> None:
    engine = fired(cp.Engine.preset(name), seed)
    star = cp.star_diagram(engine, orders=ORDERS)
    gas = engine.balance(RPM, orders=ORDERS).crank_torque.gas
    first = engine.firing().order[0] - 1
    one = engine.with_cycle(
        [each if k == first else None for k, each in enumerate(engine.cycles or ())]
    )
    alone = one.balance(RPM, orders=ORDERS).crank_torque.gas
    turned = np.exp(-1j * np.array(ORDERS) * np.radians(float(engine.firing_deg[first])))
    sums = np.array([star[order] for order in ORDERS])
    np.testing.assert_allclose(
        sums * alone / turned, gas, rtol=0, atol=ROUNDING * 12 * np.abs(alone).max()
    )
    dead = [each is None for each in engine.cycles or ()]
    assert not np.any(star.vectors[:, dead])


@in_turn(("name", "seed"), ENGINES)
def test_intervals_are_those_between_firings(name: str, seed: int) -> None:
    engine = fired(cp.Engine.preset(name), seed)
    firing = engine.firing()
    angles = np.sort(engine.firing_deg[[each is not None for each in engine.cycles or ()]])
    cycle = 180.0 * engine.strokes
    expected = np.diff([*angles, angles[0] + cycle])
    # Degrees of floats below 1440.
    np.testing.assert_allclose(np.sort(firing.intervals_deg), np.sort(expected), rtol=0, atol=1e-9)
    assert engine.fires_evenly == bool(np.ptp(expected) < 1e-9)
