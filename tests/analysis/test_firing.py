"""Does an engine fire when it should, and does a firing order get the crank that it needs?

Against the re-derivation, which tries every choice of turns in fractions of a degree; against what
is known of built engines, the cross-plane page and the IJESC paper's engine; and against laws that
hold for any engine. Angles that are parts of a turn are compared with ``==``.
"""

from __future__ import annotations

import copy
import csv
import io
import itertools
import math
import pickle
import re
import warnings
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from matplotlib import pyplot as plt
from rederivation import firing, ijesc
from support import in_turn
from support.built_engines import EVEN, UNEVEN
from support.engines import CYLINDER

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

V8 = cp.Engine.preset("v8-crossplane")
PAGE = V8.firing(firing.CROSSPLANE)
BOXER = cp.Engine.preset("boxer-4")
OFFSET = CYLINDER.replace(pin_offset=0.01)

# Angles below 720 degrees, rounded a few times to half a unit in the last place, 5.7e-14.
ROUNDING = 1e-12


def inline(tdc: Sequence[Any], **options: Any) -> cp.Engine:  # noqa: ANN401 - of from_lists
    """An engine with these top dead centres."""
    n = len(tdc)
    banks = options.pop("bank_deg", [90] * n)
    return cp.Engine.from_lists(
        CYLINDER, tdc_deg=tdc, bank_deg=banks, z=np.arange(n) * 0.1, **options
    )


def intervals(ways: Sequence[cp.results.Firing]) -> list[tuple[float, ...]]:
    """Intervals of each, in a fixed order."""
    return sorted(tuple(way.intervals_deg.tolist()) for way in ways)


def floats(ways: Sequence[Sequence[Fraction]]) -> list[tuple[float, ...]]:
    """The same of the re-derivation."""
    return sorted(tuple(map(float, way)) for way in ways)


# --- the cross-plane page -------------------------------------------------------------------------


def test_the_cross_plane_v8_fires_evenly_in_the_page_s_order() -> None:
    v8 = cp.Engine.vee(
        CYLINDER, bank_angle_deg=90, throws_deg=[0, 90, 270, 180], spacing=0.1, odd_bank="left"
    )
    fires = v8.firing(firing.CROSSPLANE)
    assert fires.even
    assert fires.unevenness_deg == 0.0
    assert fires.intervals_deg.tolist() == [90.0] * 8
    assert fires.order == (1, 8, 4, 3, 6, 5, 7, 2)
    assert fires.firing_order == firing.CROSSPLANE
    assert fires.angles_deg.tolist() == [0.0, 630.0, 270.0, 180.0, 450.0, 360.0, 540.0, 90.0]
    assert fires.revolutions == (0, 1, 0, 0, 1, 1, 1, 0)
    assert v8.firing_schedules(firing.CROSSPLANE) == (fires,)
    # An order has no beginning.
    assert v8.firing("6-5-7-2-1-8-4-3") == fires
    assert v8.firing([4, 3, 6, 5, 7, 2, 1, 8]) == fires


def test_gaps_within_the_page_s_banks() -> None:
    assert PAGE.banks == ((1, 3, 5, 7), (2, 4, 6, 8))
    left, right = PAGE.gaps()
    assert left == firing.CROSSPLANE_GAPS
    (way,) = (each for each in firing.ways(V8.tdc_deg.tolist()) if each.order == PAGE.order)
    assert right == firing.gaps(way, (2, 4, 6, 8))


@pytest.mark.parametrize(("opens", "closes"), [(50, 10), (80, 60), (0, 0), (90, 90), (40, -20)])
def test_exhaust_overlaps_of_the_page_s_banks(opens: int, closes: int) -> None:
    timing = cp.ValveTiming(exhaust_opens_deg=opens, exhaust_closes_deg=closes)
    (way,) = (each for each in firing.ways(V8.tdc_deg.tolist()) if each.order == PAGE.order)
    for bank, overlaps in zip(PAGE.banks, PAGE.exhaust_overlaps(timing=timing), strict=True):
        both = dict.fromkeys(itertools.combinations(bank, 2), 0.0)
        for pair, overlap in overlaps.items():
            both[min(pair), max(pair)] += overlap
        assert both == {pair: firing.both_open(way, pair, opens, closes) for pair in both}


def test_the_page_s_cylinders_5_and_7_disturb_each_other_most() -> None:
    left, _ = PAGE.exhaust_overlaps()
    # Open for 50 + 180 + 10 degrees; 1 and 3 are 270 apart.
    assert left == {(3, 5): 60, (5, 7): 150, (7, 1): 60}


def test_manifolds_across_the_banks_even_the_exhaust() -> None:
    # As in the V8s whose exhausts are inside the V: every second cylinder of the order.
    for group in PAGE.gaps([PAGE.order[::2], PAGE.order[1::2]]):
        assert list(group.values()) == [180.0] * 4
    assert PAGE.exhaust_overlaps([[1, 6], [8, 5]], timing=cp.ValveTiming()) == ({}, {})
    flat = cp.Engine.preset("v8-flatplane").firing(EVEN["v8-flatplane"])
    for bank in flat.gaps():
        assert list(bank.values()) == [180.0] * 4


def test_a_boxer_s_banks_fire_unevenly_and_its_crossed_manifolds_evenly() -> None:
    fires = BOXER.firing("1-3-2-4")
    assert [list(bank.values()) for bank in fires.gaps()] == [[180.0, 540.0]] * 2
    crossed = fires.gaps([[1, 2], [3, 4]])
    assert [list(group.values()) for group in crossed] == [[360.0, 360.0]] * 2


def test_a_cylinder_alone_follows_itself() -> None:
    assert PAGE.gaps([[3]]) == ({(3, 3): 720.0},)
    assert BOXER.firing("1+2-3+4", strokes=2).gaps([[4]]) == ({(4, 4): 360.0},)


def test_cylinders_that_fire_together_overlap_once() -> None:
    fires = BOXER.firing("1+2-3+4")
    (overlaps,) = fires.exhaust_overlaps([[1, 2]])
    assert overlaps == {(1, 2): 240.0}
    assert fires.gaps([[1, 2]]) == ({(1, 2): 0.0, (2, 1): 720.0},)


# --- the IJESC paper's engine ---------------------------------------------------------------------

LISTED = ["-".join(map(str, order)) for order in ijesc.FIRING_ORDERS]


@in_turn("order", LISTED)
@in_turn("v_angle", range(10, 180, 10))
def test_every_choice_of_turns_of_the_ijesc_engine(order: str, v_angle: int) -> None:
    engine = cp.Engine.preset(f"ijesc-v6-{order}").with_bank_angle(v_angle, hold="pins")
    ways = engine.firing_schedules(order)
    lags = ijesc.lags_deg(firing.numbers(order)).tolist()
    expected = firing.ways_of(order, firing.ijesc_tdc(lags, v_angle))
    assert intervals(ways) == floats(expected)
    assert not any(way.even for way in ways)  # the paper calls it even-firing
    if order in ("1-3-5-2-4-6", "1-5-3-6-2-4") and v_angle < 120:
        (way,) = ways
        assert way.intervals_deg.tolist() == [120, 120, 120 + v_angle, 120, 120, 120 - v_angle]
    elif v_angle < 120:
        assert len(ways) == 6
        assert {way.revolutions.count(1) for way in ways} == set(range(6))
    else:
        assert ways == ()


@pytest.mark.parametrize("order", LISTED)
def test_at_120_degrees_the_ijesc_order_cannot_be_had(order: str) -> None:
    engine = cp.Engine.preset(f"ijesc-v6-{order}").with_bank_angle(120, hold="pins")
    with pytest.raises(cp.InputError) as refusal:
        engine.firing(order)
    message = str(refusal.value)
    assert message.startswith(f"firing_order = {order}: this crank cannot fire in this order: ")
    # It says what is possible: two cylinders come to the top together.
    assert message.count("+") == 3
    named = message.rpartition("most even first: ")[2].split(", ")
    assert [*(each.firing_order for each in engine.firing_orders()[:3]), "…"] == named


def test_at_60_degrees_two_ijesc_orders_fire_in_one_turn_and_rest_for_420() -> None:
    for order in LISTED[1:3]:
        ways = cp.Engine.preset(f"ijesc-v6-{order}").firing_schedules(order)
        one_turn = [60.0] * 5 + [420.0]
        assert sorted(map(sorted, intervals(ways))) == [one_turn] * 6
        assert one_turn in [way.intervals_deg.tolist() for way in ways]


# --- built engines --------------------------------------------------------------------------------


@in_turn(("name", "order"), EVEN.items())
def test_presets_fire_evenly(name: str, order: str) -> None:
    fires = cp.Engine.preset(name).firing(order)
    assert fires.even
    assert fires.firing_order == order
    # VR and W engines too, whose offset pins put the tops beside the top dead centres.
    assert set(fires.intervals_deg.tolist()) == {720.0 / len(fires.order)}


@pytest.mark.parametrize(("name", "order", "gaps"), [(n, *f) for n, f in UNEVEN.items()])
def test_presets_fire_unevenly(name: str, order: str, gaps: tuple[int, ...]) -> None:
    engine = cp.Engine.preset(name)
    assert gaps in [tuple(way.intervals_deg.tolist()) for way in engine.firing_schedules(order)]
    assert not any(way.even for way in engine.firing_orders())


def test_odd_fire_is_150_and_90() -> None:
    fires = cp.Engine.preset("v6-90-odd-fire").firing("1-6-5-4-3-2")
    assert fires.intervals_deg.tolist() == [150.0, 90.0] * 3
    assert fires.unevenness_deg == 30.0
    assert repr(fires) == "<Firing 4-stroke 1-6-5-4-3-2, 150-90-150-90-150-90°>"


def test_a_hair_beside_even_is_not_even() -> None:
    # 1e-7 of a degree is told apart; what rounding leaves of odd angles is not.
    pins = cp.Engine.preset("v8-crossplane")
    assert not pins.with_bank_angle(90.0000001, hold="pins").firing(firing.CROSSPLANE).even
    odd = [k * 720 / 11 + 1.0001 for k in range(11)]
    assert inline(odd).firing("1-2-3-4-5-6-7-8-9-10-11").even
    assert not inline([0, 180.0000001]).firing("1-2").even


def test_a_v14_fires_at_parts_of_a_turn() -> None:
    best = cp.Engine.preset("v14-49.54").firing_orders()[0]
    assert best.even
    assert best.intervals_deg.tolist() == [360 / 7] * 14


def test_two_strokes() -> None:
    i3 = cp.Engine.from_firing_order(CYLINDER, "1-3-2", strokes=2, spacing=0.1)
    (only,) = i3.firing_orders(strokes=2)
    assert only == i3.firing("1-3-2", strokes=2)
    assert only.strokes == 2
    assert only.even
    assert only.intervals_deg.tolist() == [120.0] * 3
    assert only.angles_deg.tolist() == [0.0, 240.0, 120.0]
    assert i3.firing_schedules("1-2-3", strokes=2) == ()
    with pytest.raises(cp.InputError, match=r"1-2-3: .* TDC sequence is 1, 3, 2\. .*: 1-3-2$"):
        i3.firing("1-2-3", strokes=2)
    # A four-stroke with the same crank needs the other turn for an even 240.
    assert i3.firing("1-2-3", strokes=4).intervals_deg.tolist() == [240.0] * 3
    power, compression = only.strokes_deg().values()
    assert power.tolist() == [[0.0, 180.0], [240.0, 420.0], [120.0, 300.0]]
    assert compression.tolist() == [[180.0, 360.0], [60.0, 240.0], [300.0, 480.0]]
    with pytest.raises(cp.InputError, match=r"strokes = 2: valves are .* ports: Firing\.ports"):
        only.valves()
    with pytest.raises(cp.InputError, match=r"strokes = 4: ports are .* valves: Firing\.valves"):
        i3.firing("1-2-3", strokes=4).ports()
    for call in (only.ports, only.exhaust_overlaps, only.plot):
        with pytest.raises(cp.InputError, match=r"timing = ValveTiming.*: give a .*PortTiming"):
            call(timing=cp.ValveTiming())  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"timing = PortTiming.*: give a .*ValveTiming"):
        i3.firing("1-2-3", strokes=4).exhaust_overlaps(timing=cp.PortTiming())


def test_ports_open_and_close_with_the_piston_at_one_height() -> None:
    i3 = cp.Engine.from_firing_order(CYLINDER, "1-3-2", strokes=2, spacing=0.1)
    timing = cp.PortTiming(transfer_opens_deg=62, exhaust_opens_deg="94.5")
    fires = i3.firing("1-3-2", strokes=2)
    for periods, half in zip(fires.ports(timing).values(), (62.0, 94.5), strict=True):
        assert (periods[:, 1] - periods[:, 0]).tolist() == [2 * half] * 3
        assert ((periods[:, 0] >= 0) & (periods[:, 0] < 360)).all()
        for tdc, (opens, closes) in zip(fires.angles_deg, periods, strict=True):
            lowest = opens + half - tdc
            assert lowest % 360 == 180
            up, down = CYLINDER.position([opens - tdc, closes - tdc])
            assert up == pytest.approx(down, rel=1e-14)  # a few roundings of a cosine
    # With a pin offset they are timed from where the piston is lowest.
    single = inline([0]).replace(cylinder=OFFSET).firing("1", strokes=2)
    (opens, closes) = single.ports(cp.PortTiming(40, 90))["exhaust"][0]
    assert 0.5 * (opens + closes) == pytest.approx(single.strokes_deg()["power"][0, 1], abs=1e-12)


@pytest.mark.parametrize("opens", [60, 85, 90, 100, 179])
def test_exhaust_overlaps_of_a_two_stroke(opens: int) -> None:
    timing = cp.PortTiming(exhaust_opens_deg=opens)
    for order, tdc in (("1-3-2", [0, 240, 120]), ("1-2-3-4", [0, 90, 180, 270])):
        engine = cp.Engine.from_lists(
            CYLINDER, tdc_deg=tdc, bank_deg=[90] * len(tdc), z=[0.1 * k for k in range(len(tdc))]
        )
        fires = engine.firing(order, strokes=2)
        (way,) = firing.ways(tdc, strokes=2)
        everyone = [list(range(1, len(tdc) + 1))]
        both = dict.fromkeys(itertools.combinations(everyone[0], 2), 0.0)
        (overlaps,) = fires.exhaust_overlaps(everyone, timing=timing)
        for pair, overlap in overlaps.items():
            both[min(pair), max(pair)] += overlap
        assert both == {pair: firing.both_ports_open(way, pair, opens) for pair in both}


def test_ports_that_fire_together_overlap_once() -> None:
    fires = BOXER.firing("1+2-3+4", strokes=2)
    assert fires.exhaust_overlaps([[1, 2]]) == ({(1, 2): 170.0},)
    assert fires.exhaust_overlaps([[1, 3]]) == ({},)  # 85 + 85 degrees, half a turn apart


def test_a_mirrored_boxer_fires_in_pairs_as_a_two_stroke() -> None:
    (only,) = BOXER.firing_orders(strokes=2)
    assert only.firing_order == "1+2-3+4"
    assert only.order == (1, 2, 3, 4)
    assert only.intervals_deg.tolist() == [0.0, 180.0, 0.0, 180.0]
    assert BOXER.firing("4+3-2+1", strokes=2) == only
    assert BOXER.firing_schedules("1-2-3-4", strokes=2) == ()
    assert BOXER.firing_schedules("1+3-2+4", strokes=2) == ()


# --- strokes and valves ---------------------------------------------------------------------------


def test_strokes_follow_each_other() -> None:
    strokes = PAGE.strokes_deg()
    assert list(strokes) == ["power", "exhaust", "intake", "compression"]
    for k, periods in enumerate(strokes.values()):
        assert (periods[:, 0] == (PAGE.angles_deg + 180 * k) % 720).all()
        assert (periods[:, 1] == periods[:, 0] + 180).all()
    with pytest.raises(TypeError):
        strokes["power"] = strokes["intake"]  # type: ignore[index]


def test_strokes_end_where_the_piston_turns() -> None:
    engine = inline([0, 180, 300]).replace(cylinder=OFFSET)
    fires = engine.firing_orders()[0]
    names = list(fires.strokes_deg())
    for k, name in enumerate(names):
        periods = fires.strokes_deg()[name]
        after = fires.strokes_deg()[names[(k + 1) % 4]]
        np.testing.assert_allclose(periods[:, 1] % 720, after[:, 0] % 720, rtol=0, atol=ROUNDING)
        for cylinder, period in enumerate(periods):
            # Rounding of the angle, 1e-14 rad, times the largest speed over ω, about r.
            speed = OFFSET.velocity(period - engine.tdc_deg[cylinder], rpm=60 / (2 * math.pi))
            assert abs(speed).max() < 1e-14
    down = OFFSET.position(fires.strokes_deg()["power"][0] - engine.tdc_deg[0])
    assert down[0] > down[1]


def test_valves_open_and_close_about_the_dead_centres() -> None:
    timing = cp.ValveTiming(
        intake_opens_deg=12, intake_closes_deg=48, exhaust_opens_deg="55", exhaust_closes_deg=7
    )
    intake, exhaust = PAGE.valves(timing).values()
    strokes = PAGE.strokes_deg()
    assert (intake[:, 0] == (strokes["intake"][:, 0] - 12) % 720).all()
    assert (intake[:, 1] - intake[:, 0] == 12 + 180 + 48).all()
    assert (exhaust[:, 0] == (strokes["exhaust"][:, 0] - 55) % 720).all()
    assert (exhaust[:, 1] - exhaust[:, 0] == 55 + 180 + 7).all()
    late = PAGE.valves(cp.ValveTiming(intake_opens_deg=-10))["intake"]
    assert (late[:, 0] == (strokes["intake"][:, 0] + 10) % 720).all()
    # Valves of an engine with offset pins are timed from where its pistons turn.
    single = inline([0]).replace(cylinder=OFFSET).firing("1")
    opens, closes = single.valves(cp.ValveTiming(0, 0, 0, 0))["intake"][0]
    assert [opens, closes] == single.strokes_deg()["intake"][0].tolist()


@pytest.mark.parametrize("name", ["intake_opens_deg", "exhaust_closes_deg"])
@pytest.mark.parametrize("value", [-90, 181, math.nan, math.inf, "early", None])
def test_timing_that_is_none(name: str, value: Any) -> None:  # noqa: ANN401 - bad on purpose
    with pytest.raises(cp.InputError, match=name):
        cp.ValveTiming(**{name: value})


@pytest.mark.parametrize("name", ["transfer_opens_deg", "exhaust_opens_deg"])
@pytest.mark.parametrize("value", [0, 180, -5, math.nan, math.inf, "early", None])
def test_port_timing_that_is_none(name: str, value: Any) -> None:  # noqa: ANN401 - bad on purpose
    with pytest.raises(cp.InputError, match=name):
        cp.PortTiming(**{name: value})


# --- the crank of a firing order ------------------------------------------------------------------


def test_throws_of_the_cross_plane_order() -> None:
    throws, splits = cp.throws(firing.CROSSPLANE, bank_angle_deg=90, odd_bank="left")
    assert throws.tolist() == [0.0, 90.0, 270.0, 180.0]
    assert splits.tolist() == [0.0] * 4
    with pytest.warns(UserWarning, match="odd_bank"):
        _, splits = cp.throws(firing.CROSSPLANE, bank_angle_deg=90, odd_bank="right")
    assert splits.tolist() == [180.0] * 4


@pytest.mark.parametrize(("bank_angle", "split"), [(60, -60), (90, -30), (120, 0), (150, 30)])
def test_pins_of_an_even_v6_are_split_by_bank_angle_less_120(bank_angle: int, split: int) -> None:
    throws, splits = cp.throws("1-2-3-4-5-6", bank_angle_deg=bank_angle)
    assert splits.tolist() == [split] * 3
    assert throws.tolist() == [0.0, 120.0, 240.0]
    engine = cp.Engine.vee(
        CYLINDER, bank_angle_deg=bank_angle, throws_deg=throws, pin_split_deg=splits[0], spacing=0.1
    )
    assert engine.firing("1-2-3-4-5-6").even


def random_sequence(seed: int) -> tuple[str, list[int], int]:
    """A firing order, intervals of few values, some of them 0, and strokes."""
    chance = np.random.default_rng(seed)
    count, strokes = int(chance.integers(2, 9)), int(chance.choice([2, 4, 4, 4]))
    numbers = chance.permutation(np.arange(1, count + 1)).tolist()
    intervals = [int(chance.choice([0, 10, 30, 90, 180, 360])) for _ in numbers[1:]]
    while sum(intervals) >= 180 * strokes:
        intervals[int(np.argmax(intervals))] = int(chance.choice([0, 10]))
    joins = ["+" if interval == 0 else "-" for interval in intervals]
    order = str(numbers[0]) + "".join(f"{j}{n}" for j, n in zip(joins, numbers[1:], strict=True))
    return order, [*intervals, 180 * strokes - sum(intervals)], strokes


def typed_angles(order: str, intervals: list[int]) -> dict[int, int]:
    """Crank angle of each cylinder's firing after that of the first in the order."""
    numbers = [int(number) for number in re.findall(r"\d+", order)]
    return dict(zip(numbers, np.cumsum([0, *intervals[:-1]]).tolist(), strict=True))


@in_turn("seed", range(300))
def test_engines_fire_at_the_intervals_that_were_typed(seed: int) -> None:
    order, intervals, strokes = random_sequence(seed)
    engine = cp.Engine.from_firing_order(
        CYLINDER, order, intervals_deg=intervals, spacing=0.1, strokes=strokes
    )
    typed = typed_angles(order, intervals)
    kept = [
        engine, cp.Engine.from_toml(engine.to_toml()), cp.Engine.from_json(engine.to_json()),
        engine.replace(name="renamed"), engine.with_first_tdc(200),
        pickle.loads(pickle.dumps(engine)),  # noqa: S301
    ]  # fmt: skip
    assert kept[1] == kept[2] == engine
    for each in kept:
        angles = each.firing().angles_deg
        after = {number: (angles[number - 1] - angles[0]) % (180 * strokes) for number in typed}
        expected = {n: (angle - typed[1]) % (180 * strokes) for n, angle in typed.items()}
        assert after == pytest.approx(expected, abs=1e-9)
    if engine.firing() == engine.firing(order):  # the most even
        assert "second_turn" not in engine.to_toml()


@pytest.mark.parametrize(
    ("order", "intervals"),
    [("1-2", [30, 690]), ("1-2", [540, 180]), ("1-2-3-4", [10, 10, 10, 690])],
)
def test_half_orders_are_those_of_the_typed_firings(order: str, intervals: list[int]) -> None:
    """Phasors of single cylinders, each turned by its own firing angle."""
    cylinder, cycle = CYLINDER.replace(bore=0.086), cp.Cycle.example()
    example = cp.Engine.preset("single", cylinder=cylinder)
    single = example.with_cycle(cycle).balance(3000, orders=[0.5, 1, 1.5]).crank_torque
    engine = cp.Engine.from_firing_order(cylinder, order, intervals_deg=intervals, spacing=0.1)
    fired = engine.with_cycle(cycle).balance(3000, orders=[0.5, 1, 1.5]).crank_torque
    for n in (0.5, 1.5):
        angles = np.deg2rad([*typed_angles(order, intervals).values()])
        expected = single[n].phasor * np.exp(-1j * n * angles).sum()
        # Either turn may be called the first: half orders change their sign with it.
        off = min(abs(fired[n].phasor - sign * expected) for sign in (1, -1))
        assert off <= 1e-9 * abs(single[n].phasor)


def test_odd_fire_needs_no_split() -> None:
    _, splits = cp.throws(
        "1-6-5-4-3-2", bank_angle_deg=90, odd_bank="left", intervals_deg=[150, 90] * 3
    )
    assert splits.tolist() == [0.0] * 3
    engine = cp.Engine.from_firing_order(
        CYLINDER,
        "1-6-5-4-3-2",
        bank_angle_deg=90,
        odd_bank="left",
        intervals_deg=[150, 90] * 3,
        spacing=0.1,
    )
    assert engine.firing("1-6-5-4-3-2").intervals_deg.tolist() == [150.0, 90.0] * 3
    preset = cp.Engine.preset("v6-90-odd-fire")
    assert engine.tdc_deg.tolist() == preset.tdc_deg.tolist()
    assert engine.pin_deg.tolist() == preset.pin_deg.tolist()


def test_throws_of_inline_engines() -> None:
    throws, splits = cp.throws("1-3-4-2")
    assert throws.tolist() == [0.0, 180.0, 180.0, 0.0]
    assert splits.size == 0
    cross, _ = cp.throws("1-3-2-4", intervals_deg=[270, 180, 90, 180])  # Yamaha's R1
    assert cross.tolist() == [0.0, 270.0, 90.0, 180.0]
    assert cp.throws([1, 2, 3], strokes=2)[0].tolist() == [0.0, 240.0, 120.0]


def test_pins_that_even_firing_splits_are_warned_of() -> None:
    order = range(1, 17)
    with pytest.warns(UserWarning, match="split by 15°; shared ones, .* fire at 60-30°"):
        split = cp.Engine.from_firing_order(CYLINDER, order, bank_angle_deg=60, spacing=0.1)
    options: dict[str, Any] = {"bank_angle_deg": 60, "spacing": 0.1}
    assert split == cp.Engine.from_firing_order(CYLINDER, order, shared_pins=False, **options)
    shared = cp.Engine.from_firing_order(CYLINDER, order, shared_pins=True, **options)
    assert not shared.pin_split_deg.any()
    assert shared.firing().intervals_deg.tolist() == [60.0, 30.0] * 8
    for wrong in ({"intervals_deg": [45] * 16}, {"rule": "ijesc"}, {"bank_angle_deg": None}):
        with pytest.raises(cp.InputError, match="shared_pins = True: "):
            cp.Engine.from_firing_order(CYLINDER, order, shared_pins=True, **options | wrong)


@pytest.mark.filterwarnings("ignore:odd_bank = ")
@given(
    throws=st.integers(1, 6),
    angle=st.integers(1, 179),
    strokes=st.sampled_from([2, 4]),
    odd_bank=st.sampled_from(["right", "left"]),
    numbering=st.sampled_from(["alternating", "by-bank"]),
    data=st.data(),
)
def test_shared_pins_are_shared_and_fire_in_the_order_or_say_so(
    throws: int, angle: int, strokes: int, odd_bank: str, numbering: str, data: st.DataObject
) -> None:
    order = data.draw(st.permutations(range(1, 2 * throws + 1)))
    options: dict[str, Any] = {
        "bank_angle_deg": angle, "spacing": 0.1, "strokes": strokes, "odd_bank": odd_bank,
        "numbering": numbering, "first_tdc_deg": 7,
    }  # fmt: skip
    split = cp.Engine.from_firing_order(CYLINDER, order, shared_pins=False, **options)
    assert split.fires_evenly
    try:
        shared = cp.Engine.from_firing_order(CYLINDER, order, shared_pins=True, **options)
    except cp.InputError as error:
        assert "firing_order = " in str(error)  # noqa: PT017 - either is right
        return
    assert not shared.pin_split_deg.any()
    assert shared.firing_order == split.firing_order
    assert shared.tdc_deg[0] == split.tdc_deg[0] == 7.0
    first = shared.bank_deg == shared.bank_deg[0]
    np.testing.assert_allclose(shared.tdc_deg[first], split.tdc_deg[first], atol=1e-9)


def test_intervals_ask_for_the_other_bank_too() -> None:
    options: dict[str, Any] = {"bank_angle_deg": 90, "spacing": 0.1}
    for text in ("1-8-4-3-6-5-7-2", "1,8,4,3,6,5,7,2", "1–8–4–3–6–5–7–2"):
        for intervals in (None, [90] * 8):
            with pytest.warns(UserWarning, match='odd_bank="left" pins are shared'):
                cp.Engine.from_firing_order(CYLINDER, text, intervals_deg=intervals, **options)
    with pytest.warns(UserWarning, match="odd_bank"):
        cp.Engine.from_firing_order(
            CYLINDER, "1-2-3-4", intervals_deg=[90, 270, 90, 270], odd_bank="left", **options
        )


ORDERS = st.integers(1, 4).flatmap(lambda n: st.permutations(range(1, 2 * n + 1)))


@st.composite
def interval_lists(draw: st.DrawFn, count: int, cycle: int = 720) -> list[int]:
    """Whole degrees above 0 that add up to a cycle."""
    cuts = draw(st.sets(st.integers(1, cycle - 1), min_size=count - 1, max_size=count - 1))
    stops = [0, *sorted(cuts), cycle]
    return [after - before for before, after in itertools.pairwise(stops)]


def made_for(order: list[int], wanted: list[int], **options: Any) -> cp.Engine:  # noqa: ANN401
    """Return the engine of an order that can fire at these intervals, and warns if it does not."""
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        warnings.filterwarnings("ignore", "odd_bank = ")  # of splits, not of intervals
        engine = cp.Engine.from_firing_order(
            CYLINDER, order, spacing=0.1, intervals_deg=wanted, **options
        )
    # Rotated to cylinder 1, as the result has it.
    first = order.index(1)
    rotated = wanted[first:] + wanted[:first]
    assert rotated in [way.intervals_deg.tolist() for way in engine.firing_schedules()]
    assert bool(warned) == (engine.firing().intervals_deg.tolist() != rotated)
    return engine


@settings(deadline=None)
@given(
    st.data(),
    ORDERS,
    st.integers(0, 180),
    st.sampled_from(["right", "left"]),
    st.sampled_from(["alternating", "by-bank"]),
)
def test_a_crank_made_for_an_order_fires_in_it(
    data: st.DataObject,
    order: list[int],
    bank_angle: int,
    odd_bank: Literal["right", "left"],
    numbering: Literal["alternating", "by-bank"],
) -> None:
    wanted = data.draw(interval_lists(len(order)))
    options: dict[str, Any] = {
        "bank_angle_deg": bank_angle,
        "odd_bank": odd_bank,
        "numbering": numbering,
    }
    engine = made_for(order, wanted, **options)
    throws, splits = cp.throws(order, intervals_deg=wanted, **options)
    text = "-".join(map(str, order))
    expected = firing.pins(text, wanted, bank_angle, odd_bank, numbering)
    assert [throws.tolist(), splits.tolist()] == [list(map(float, each)) for each in expected]
    pins = {
        (side, z): pin
        for side, z, pin in zip(engine.bank_deg, engine.z, engine.pin_deg, strict=True)
    }
    if 0 < bank_angle < 180:
        for k, split in enumerate(splits):
            left, right = (pins[90 + sign * bank_angle / 2, k / 10] for sign in (1, -1))
            assert (left - right - split) % 360 == 0


@settings(deadline=None)
@given(st.data(), st.permutations(range(1, 6)), st.sampled_from([2, 4]))
def test_an_inline_crank_made_for_an_order_fires_in_it(
    data: st.DataObject, order: list[int], strokes: int
) -> None:
    wanted = data.draw(interval_lists(5, 180 * strokes))
    engine = made_for(order, wanted, strokes=strokes)
    throws, _ = cp.throws(order, intervals_deg=wanted, strokes=strokes)
    # Which turns it was made for, a crank by its throws does not know.
    assert engine.replace(firing_order=engine.firing_order) == cp.Engine.inline(
        CYLINDER, throws_deg=throws, spacing=0.1, firing_order=engine.firing_order, strokes=strokes
    )


@pytest.mark.parametrize(
    ("given_", "words"),
    [
        ({"intervals_deg": [180, 180, 180]}, "intervals_deg has 3 entries"),
        ({"intervals_deg": [180, 180, 180, 90]}, r"sum of intervals_deg = 630: .* up to 720"),
        ({"intervals_deg": [180] * 4, "strokes": 2}, r"= 720: make them add up to 360"),
        ({"intervals_deg": [0, 180, 180, 360]}, r"intervals_deg\[0\] = 0: give degrees above 0"),
        ({"intervals_deg": [-180, 540, 180, 180]}, r"intervals_deg\[0\] = -180"),
        ({"intervals_deg": [math.nan] * 4}, r"intervals_deg\[0\] = NaN"),
        ({"intervals_deg": 180}, "intervals_deg = 180: give a list"),
        ({"strokes": 3}, "strokes = 3: give 4 for a four-stroke or 2"),
        ({"strokes": "four"}, "strokes = 'four': give 4"),
    ],
)
def test_intervals_that_make_no_crank(given_: dict[str, Any], words: str) -> None:
    for call in (
        lambda: cp.Engine.from_firing_order(CYLINDER, "1-3-4-2", spacing=0.1, **given_),
        lambda: cp.throws("1-3-4-2", **given_),
    ):
        with pytest.raises(cp.InputError, match=words):
            call()


def test_the_ijesc_rule_has_its_own_intervals() -> None:
    def build(**given_: Any) -> cp.Engine:  # noqa: ANN401 - of from_firing_order
        return cp.Engine.from_firing_order(
            CYLINDER, "1-2-3-4-5-6", bank_angle_deg=60, spacing=0.1, rule="ijesc", **given_
        )

    with pytest.raises(cp.InputError, match='intervals_deg = 6 given: the rule "ijesc"'):
        build(intervals_deg=[120] * 6)
    with pytest.raises(cp.InputError, match='strokes = 2: the rule "ijesc"'):
        build(strokes=2)


# --- laws that hold for any engine ----------------------------------------------------------------

TURNS = st.integers(1, 9).flatmap(
    lambda n: st.lists(st.integers(0, 3 * n).map(lambda k: Fraction(360 * k, n)), min_size=1)
)
DECIMALS = st.lists(st.floats(0, 360, allow_subnormal=False), min_size=1)
TDCS = st.one_of(TURNS, DECIMALS).map(lambda tdc: tdc[:6])
STROKES = st.sampled_from([2, 4])


@settings(deadline=None)
@given(TDCS, STROKES)
def test_intervals_fill_the_cycle(tdc: list[Any], strokes: int) -> None:
    for way in inline(tdc).firing_orders(strokes=strokes):
        assert way.intervals_deg.sum() == pytest.approx(180 * strokes, rel=0, abs=ROUNDING)
        assert way.intervals_deg.min() >= 0
        assert sorted(way.order) == list(range(1, len(tdc) + 1))
        assert way.order[0] == 1
        places = np.array(way.order) - 1
        assert way.angles_deg[0] < 360
        steps = np.diff(way.angles_deg[np.append(places, 0)])
        apart = (steps - way.intervals_deg) % (180 * strokes)
        assert np.minimum(apart, 180 * strokes - apart).max() < 1e-9


@settings(deadline=None)
@given(TURNS.map(lambda tdc: tdc[:6]), STROKES)
def test_every_choice_of_turns_is_listed_once(tdc: list[Fraction], strokes: int) -> None:
    found = inline(tdc).firing_orders(strokes=strokes)
    expected = firing.ways(tdc, strokes)
    pairs = sorted((way.order, tuple(way.intervals_deg.tolist())) for way in found)
    assert pairs == sorted((way.order, tuple(map(float, way.intervals))) for way in expected)
    assert len(set(found)) == len(found)
    uneven = [way.unevenness_deg for way in found]
    assert uneven == pytest.approx(sorted(uneven), abs=1e-6)
    for way in found:
        assert way.even == (len(set(way.intervals_deg.tolist())) == 1)


@settings(deadline=None)
@given(TDCS, STROKES)
def test_every_listed_order_can_be_named(tdc: list[Any], strokes: int) -> None:
    engine = inline(tdc)
    for way in engine.firing_orders(strokes=strokes):
        ways = engine.firing_schedules(way.firing_order, strokes=strokes)
        assert way in ways
        best = engine.firing(way.firing_order, strokes=strokes)
        assert best == ways[0]
        assert best.firing_order == way.firing_order
        assert best.unevenness_deg <= way.unevenness_deg + 1e-6


@settings(deadline=None)
@given(st.data(), TURNS.map(lambda tdc: tdc[:6]), STROKES)
def test_what_is_not_listed_cannot_be_named(
    data: st.DataObject, tdc: list[Fraction], strokes: int
) -> None:
    engine = inline(tdc)
    order = data.draw(st.permutations(range(1, len(tdc) + 1)))
    text = "-".join(map(str, order[order.index(1) :] + order[: order.index(1)]))
    expected = firing.ways_of(text, tdc, strokes)
    assert intervals(engine.firing_schedules(order, strokes=strokes)) == floats(expected)
    if not expected:
        with pytest.raises(cp.InputError, match="firing_order = "):
            engine.firing(order, strokes=strokes)


def differences(engine: cp.Engine, strokes: int, places: Sequence[int]) -> set[tuple[float, ...]]:
    """Crank angles from each firing to each other, of every way to fire."""
    found = set()
    for way in engine.firing_orders(strokes=strokes):
        angles = way.angles_deg[list(places)]
        apart = (angles[:, None] - angles) % (180 * strokes)
        found.add(tuple((apart.round(6) % (180 * strokes)).ravel().tolist()))
    return found


@settings(deadline=None)
@given(st.data(), TDCS, STROKES)
def test_numbering_does_not_matter(data: st.DataObject, tdc: list[Any], strokes: int) -> None:
    places = data.draw(st.permutations(range(len(tdc))))
    renumbered = inline([tdc[k] for k in places])
    same = differences(renumbered, strokes, range(len(tdc)))
    assert differences(inline(tdc), strokes, places) == same


@settings(deadline=None)
@given(TDCS, st.one_of(st.integers(-400, 400), st.floats(-400, 400)), STROKES)
def test_turning_the_crank_changes_nothing_but_angles(
    tdc: list[Any], turn: float, strokes: int
) -> None:
    engine = inline(tdc)
    turned = engine.with_first_tdc(turn)
    before, after = (each.firing_orders(strokes=strokes) for each in (engine, turned))
    # Angles a millionth of a degree apart may be told apart before and not after, or change places.
    tops = np.sort(engine.tdc_deg)
    apart = np.diff(np.append(tops, tops[0] + 360))
    assume(not ((apart > 0) & (apart < 1e-6)).any())
    by_turns = {way.revolutions: way for way in after}
    assert set(by_turns) == {way.revolutions for way in before}
    for way in before:
        same = by_turns[way.revolutions]
        assert same.order == way.order
        np.testing.assert_allclose(same.intervals_deg, way.intervals_deg, rtol=0, atol=1e-9)
        moved = (same.angles_deg - way.angles_deg - (same.angles_deg[0] - way.angles_deg[0])) % (
            180 * strokes
        )
        assert np.minimum(moved, 180 * strokes - moved).max() < 1e-9


# --- refusals -------------------------------------------------------------------------------------


def test_refusals() -> None:
    i4 = cp.Engine.preset("i4")
    with pytest.raises(cp.InputError) as refusal:
        i4.firing("1-2-3-4")
    assert str(refusal.value) == (
        "firing_order = 1-2-3-4: this crank cannot fire in this order: its TDC sequence is 1+4, "
        "2+3. Possible orders, most even first: 1-2-4-3, 1-3-4-2, 1-2+3-4, …"
    )
    for ask in (i4.firing, i4.firing_schedules):
        with pytest.raises(
            cp.InputError, match="1-3-2: 4 is missing; name each of the engine's 4 cylinders"
        ):
            ask("1-3-2")
        with pytest.raises(cp.InputError, match="1-3-3-2: 3 is there twice; name every"):
            ask("1-3-3-2")
        with pytest.raises(cp.InputError, match="1;3: give cylinder numbers joined by '-'"):
            ask("1;3")
        with pytest.raises(cp.InputError, match="firing_order = 1342: give cylinder numbers"):
            ask(1342)  # type: ignore[arg-type]
        with pytest.raises(cp.InputError, match="strokes = 6: give 4"):
            ask("1-3-4-2", strokes=6)
    groups: list[tuple[Any, str]] = [
        ([[1, 1]], r"groups\[0\] = 1: name cylinders from 1 to 8, each once"),
        ([[1], [9]], r"groups\[1\] = 9: name cylinders"),
        ([[0]], r"groups\[0\] = 0: give lists of cylinder numbers"),
        ([[]], r"groups\[0\] = \[\]: name at least one"),
        ([["a"]], r"groups\[0\] = 'a': give a whole number"),
        ([1], r"groups\[0\] = 1: give lists"),
        (3, "groups = 3: give lists"),
    ]
    for given_, words in groups:
        for ask_groups in (PAGE.gaps, PAGE.exhaust_overlaps):
            with pytest.raises(cp.InputError, match=words):
                ask_groups(given_)
    with pytest.raises(cp.InputError, match="timing = 50: give a crankpin"):
        PAGE.valves(50)  # type: ignore[arg-type]


def test_too_many_cylinders_to_list_can_still_be_named() -> None:
    engine = inline([0] * 17)
    with pytest.raises(
        cp.InputError, match=r"cylinders = 17: .* up to 16 cylinders.*name an order"
    ):
        engine.firing_orders()
    assert len(engine.firing_orders(strokes=2)) == 1
    assert engine.firing("+".join(map(str, range(1, 18)))).intervals_deg[-1] == 720.0
    with pytest.raises(cp.InputError, match="this crank cannot fire in this order"):
        engine.firing(range(1, 18))
    even = "-".join(map(str, range(1, 1001)))
    thousand = cp.Engine.from_firing_order(CYLINDER, even, spacing=0.1)
    assert thousand.firing(even).even


# --- objects --------------------------------------------------------------------------------------


def test_firings_are_frozen_and_copied() -> None:
    timing, ports = cp.ValveTiming(intake_opens_deg="360/7"), cp.PortTiming(50, "360/7")
    two = BOXER.firing("1+2-3+4", strokes=2)
    for each in (PAGE, two, timing, ports):
        for again in (pickle.loads(pickle.dumps(each)), copy.copy(each), copy.deepcopy(each)):  # noqa: S301 - our own
            assert again == each
            assert hash(again) == hash(each)
            assert repr(again) == repr(each)
        with pytest.raises(AttributeError):
            each.strokes = 2  # type: ignore[union-attr,misc]
    arrays = (
        PAGE.angles_deg,
        PAGE.intervals_deg,
        *PAGE.valves().values(),
        *two.ports().values(),
        *PAGE.strokes_deg().values(),
    )
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
    assert V8.firing_orders()[0] != PAGE
    assert V8.with_first_tdc(10).firing(firing.CROSSPLANE) != PAGE
    assert PAGE != "1"


def test_tables() -> None:
    table = PAGE.to_pandas()
    assert table["cylinder"].tolist() == list(PAGE.order)
    assert table["to the next °"].tolist() == [90.0] * 8
    assert table["fires at °"].tolist() == [90.0 * k for k in range(8)]
    assert table["to the next of its bank °"].tolist() == [270, 90, 180, 180, 270, 90, 180, 180]
    assert "<td>270</td>" in str(PAGE._repr_html_())
    assert PAGE.to_xarray()["to the next"].values.tolist() == [90.0] * 8


# --- the command line -----------------------------------------------------------------------------

CAPTURE = pytest.CaptureFixture[str]


def printed(capsys: CAPTURE, *argv: str) -> str:
    """What a run that succeeds prints."""
    assert main(argv) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_command_of_an_order(capsys: CAPTURE, tmp_path: Path) -> None:
    argv = ("firing", "v8-crossplane", "--firing-order", firing.CROSSPLANE)
    lines = printed(capsys, *argv).splitlines()
    assert lines[0] == "V8 90°, cross-plane: 4-stroke 1-8-4-3-6-5-7-2, even, 90°"
    assert [line.split() for line in lines[2:4]] == [
        ["1", "0", "90", "270"],
        ["8", "90", "90", "90"],
    ]
    assert len(lines) == 10
    head, *rows = csv.reader(io.StringIO(printed(capsys, *argv, "--csv")))
    assert head[0] == "cylinder"
    assert [float(row[1]) for row in rows] == list(PAGE.table["fires at"].values)
    picture, before = tmp_path / "v8.png", plt.get_fignums()
    printed(capsys, *argv, "--plot", str(picture))
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert plt.get_fignums() == before


def test_command_of_an_order_in_several_turns(capsys: CAPTURE) -> None:
    name = "ijesc-v6-1-4-5-2-3-6"
    lines = printed(capsys, "firing", name, "--firing-order", "1-4-5-2-3-6").splitlines()
    ways = cp.Engine.preset(name).firing_schedules("1-4-5-2-3-6")
    told = ["  " + "-".join(f"{each:g}" for each in way.intervals_deg) for way in ways]
    assert lines[-5:] == told[1:]
    assert told[0].strip() in lines[0]


def test_command_lists_orders(capsys: CAPTURE) -> None:
    lines = printed(capsys, "firing", "i4", "--all").splitlines()
    firings = cp.Engine.preset("i4").firing_orders()
    assert [line.split()[0] for line in lines[2:]] == [each.firing_order for each in firings]
    assert lines[2].split() == ["1-2-4-3", "even", "0"]
    assert printed(capsys, "firing", "v8-crossplane", "--all").endswith(
        "and 108 more: --csv prints all\n"
    )
    head, *rows = csv.reader(
        io.StringIO(printed(capsys, "firing", "v8-crossplane", "--all", "--csv"))
    )
    assert head == ["firing order", "intervals °", "rms from even °"]
    assert [row[0] for row in rows] == [each.firing_order for each in V8.firing_orders()]
    lines = printed(capsys, "firing", "boxer-4", "--all", "--strokes", "2").splitlines()
    assert lines[2].split()[:2] == ["1+2-3+4", "0-180-0-180"]


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (
            ["i4", "--firing-order", "1-2-3-4"],
            "--firing-order = 1-2-3-4: this crank cannot fire in",
        ),
        (["i4", "--all", "--plot", "i4.png"], "--plot = i4.png: needs --firing-order"),
        (
            ["i4", "--firing-order", "1-3-4-2", "--plot", "i4.txt"],
            "--plot = i4.txt: a picture's name",
        ),
        (["ijesc-v6"], "NAME = ijesc-v6: firing takes one engine of ijesc-v6-1-3-5-2-4-6"),
        (["i4", "--strokes", "3"], "--strokes"),
    ],
)
def test_command_refuses(capsys: CAPTURE, argv: list[str], words: str) -> None:
    assert main(["firing", *argv]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err


@pytest.mark.parametrize(
    ("order", "numbers", "options"),
    [
        ("A1-B1-A2-B2", "1-2-3-4", {"bank_angle_deg": 90}),
        ("1L-1R-2L-2R", "1-2-3-4", {"bank_angle_deg": 90, "odd_bank": "left"}),
        ("1342", "1-3-4-2", {}),
        ("A1-A2-B1-B2", "1-2-3-4", {"bank_angle_deg": 90, "numbering": "by-bank"}),
    ],
)
def test_throws_reads_the_orders_that_builders_read(
    order: str, numbers: str, options: dict[str, Any]
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for named, plain in zip(
            cp.throws(order, **options), cp.throws(numbers, **options), strict=True
        ):
            assert named.tolist() == plain.tolist()
        built = [
            cp.Engine.from_firing_order(CYLINDER, each, spacing=0.1, **options)
            for each in (order, numbers)
        ]
    assert built[0] == built[1]


def test_intervals_of_cylinders_that_fire_together_are_named() -> None:
    hint = r"^number of intervals_deg = 2: give 3, .*0 between those joined by '\+'"
    for call in (
        lambda: cp.throws("1+2-3", intervals_deg=[180, 540]),
        lambda: cp.Engine.from_firing_order(
            CYLINDER, "1+2-3", intervals_deg=[180, 540], spacing=0.1
        ),
    ):
        with pytest.raises(cp.InputError, match=hint):
            call()


def test_a_vee_of_an_odd_number_of_cylinders_is_shown_how() -> None:
    with pytest.raises(cp.InputError, match=r"Engine\.vee with throws_deg=.*, absent=\[4\]"):
        cp.Engine.from_firing_order(CYLINDER, "1-3-2", bank_angle_deg=60, spacing=0.1)


def test_intervals_in_place_of_a_firing_order_are_answered_with_where_they_go() -> None:
    cylinder, i2 = cp.Cylinder(0.05, 0.15, 0.5), cp.Engine.preset("i2-360")
    intervals = i2.firing().intervals_deg
    said = r"^firing_order = \[360.0, 360.0\]: .*intervals are intervals_deg of Engine\."
    for call in (
        lambda: cp.Engine.from_firing_order(cylinder, intervals, spacing=0.1),
        lambda: i2.firing(intervals),
        lambda: i2.replace(firing_order=intervals.tolist()),
    ):
        with pytest.raises(cp.InputError, match=said):
            call()
    engine = cp.Engine.from_firing_order(cylinder, "1-2", intervals_deg=intervals, spacing=0.1)
    assert engine.firing().intervals_deg.tolist() == intervals.tolist()


def test_a_fast_crank_fires_in_no_order_and_says_so() -> None:
    parts: dict[str, Any] = {"tdc_deg": [0, 90], "bank_deg": [90, 90], "z": [0, 0.1]}
    parts |= {"cranks": [(0.3, 0, 2)], "crank": [0, 1]}
    fast = cp.Engine.from_lists([cp.Cylinder(0.05, 0.15, 0.5)] * 2, **parts)
    assert fast.firing_order == ""
    for call in (
        lambda: fast.firing("1-2"),
        fast.firing_orders,
        lambda: fast.replace(firing_order="1-2"),
        lambda: fast.with_cycle(cp.Cycle.example()),
    ):
        with pytest.raises(cp.InputError, match=r"^cranks\[1\].ratio = 2: .*of ratio 1 or -1"):
            call()
