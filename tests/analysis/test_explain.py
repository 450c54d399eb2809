"""Is every sentence about an engine true? Each finding is held against the numbers.

Engines are random: layouts with throws on a grid (where orders cancel) and off it, with and without
offsets, unequal pistons, rotating masses, counterweights, balance shafts, gas. What each cylinder
adds comes from the re-derivation over time, which knows nothing of orders.
"""

# ruff: noqa: ANN401 - quantities of a balance are of several types

from __future__ import annotations

import itertools
import math
import re
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import link_rods, time_domain
from support import html_of, in_turn
from support.several_cranks import random_engine

if TYPE_CHECKING:
    from collections.abc import Callable

    from crankpin.analysis.explain import Finding

RPM = 3000.0
OMEGA_SQUARED = (2 * np.pi * RPM / 60) ** 2
ORDERS = range(1, 25)
CLOSE = 1e-8
"""Of the unit: FFTs of forces round to 1e-12, fitted hardware to 1e-10; ROUNDING is 1e-9."""
PETROL = cp.Cycle.example()


# --- engines --------------------------------------------------------------------------------------


@st.composite
def cylinders(draw: st.DrawFn) -> cp.Cylinder:
    offset = draw(st.sampled_from([0.0, 0.0, 0.0, 0.004]))
    rod = draw(st.sampled_from([0.1, 0.14, 0.2]))
    return cp.Cylinder(0.045, rod, draw(st.sampled_from([0.3, 0.5])), offset, bore=0.086)


@st.composite
def engines(draw: st.DrawFn) -> cp.Engine:
    cylinder, count = draw(cylinders()), draw(st.integers(1, 6))
    step: Any = draw(st.sampled_from([90, 120, 60, 72, 45, "360/7", 37.3]))
    throws = [
        f"{k * 360}/7" if step == "360/7" else k * step
        for k in draw(st.lists(st.integers(0, 7), min_size=count, max_size=count))
    ]
    layout = draw(st.sampled_from(["inline", "vee", "boxer", "radial"]))
    if layout == "inline":
        engine = cp.Engine.inline(cylinder, throws_deg=throws, spacing=0.1)
    elif layout == "boxer":
        engine = cp.Engine.boxer(cylinder, throws_deg=throws[:3], spacing=0.1)
    elif layout == "radial":
        each = [f"{360 * k}/{count}" for k in range(count)]
        engine = cp.Engine.from_lists(
            [cylinder] * count, tdc_deg=each, bank_deg=each, z=[0.0] * count
        )
    else:
        engine = cp.Engine.vee(
            cylinder,
            bank_angle_deg=draw(st.sampled_from([45, 60, 90, 120])),
            throws_deg=throws[:4],
            pin_split_deg=draw(st.sampled_from([0, -30, -60])),
            spacing=0.1,
        )
    if draw(st.booleans()):
        engine = engine.replace(rotating_mass=draw(st.sampled_from([0.2, 0.5])))
    if draw(st.integers(0, 3)) == 0:
        lighter = cylinder.replace(reciprocating_mass=0.2)
        engine = engine.replace(cylinder=[lighter, *[cylinder] * (len(engine) - 1)])
    return engine


@st.composite
def fitted(draw: st.DrawFn) -> cp.Engine:
    """Engines with or without hardware, firing order and gas."""
    engine = draw(engines())
    kind = draw(st.sampled_from(["", "", "bob", "ends", "plain", "shafts", "both"]))
    if kind == "bob":
        engine = cp.bob_weight(engine, draw(st.sampled_from([0.3, 0.5, 1.0]))).fitted
    elif kind in ("ends", "both"):
        engine = cp.counterweights(engine, planes=[-0.2, 0.5]).fitted
    elif kind == "plain":
        weight = cp.Unbalance(draw(st.sampled_from([0.01, 0.03])), 0.1, 200)
        engine = engine.with_counterweights([weight])
    if kind in ("shafts", "both"):
        ratios = draw(st.sampled_from([[-1], [2, -2], [2], [1]]))
        engine = cp.balance_shafts(engine, ratios, x=0.1, y=0.0, planes=[-0.2, 0.5]).fitted
    if draw(st.booleans()):
        ways = engine.firing_orders(strokes=draw(st.sampled_from([4, 4, 2])))
        way = draw(st.sampled_from(ways[:6]))
        engine = engine.replace(firing_order=way.firing_order, strokes=way.strokes)
        if way.strokes == 4 and draw(st.booleans()):
            engine = engine.with_cycle(PETROL)
    return engine


# Of compression alone the work is nothing; with its angles reversed a cycle takes what it gave.
MOTORED = cp.Cycle.motored(cp.Engine.preset("i4").cylinders[0], compression_ratio=9)
BRAKING = cp.Cycle(-PETROL.theta_deg[::-1], 0.3 * PETROL.pressure[::-1])

PRESETS = [cp.Engine.preset(name) for name in cp.presets()]
V8, I4, SINGLE = (cp.Engine.preset(name) for name in ("v8-crossplane", "i4", "single"))
CYLINDER = I4.cylinders[0].replace(bore=0.086)
SEVENTHS = [f"{360 * k}/7" for k in range(7)]
RADIAL = cp.Engine.from_lists(
    [CYLINDER] * 7, tdc_deg=SEVENTHS, bank_deg=SEVENTHS, z=[0.0] * 7, firing_order="1-3-5-7-2-4-6"
)
WITH_HARDWARE = [
    cp.counterweights(V8, planes="ends").fitted,
    cp.bob_weight(cp.Engine.preset("v6-60")).fitted,
    cp.balance_shafts(I4, [2, -2], x=[0.08, -0.08]).fitted,
    *(cp.bob_weight(SINGLE, factor).fitted for factor in (0.3, 0.5, 1.0)),
    cp.balance_shafts(cp.bob_weight(SINGLE, 0.5).fitted, -1, x=0.1, y=0.0).fitted,
    I4.with_counterweights([cp.Unbalance(0.01, 0.1)]),
    I4.replace(cylinder=CYLINDER).with_cycle(PETROL),
    RADIAL,
    # Two stars of three, 30° apart; and one of three within one of twice three.
    *(
        cp.Engine.inline(CYLINDER, throws_deg=throws, spacing=0.1)
        for throws in ([0, 120, 240, 30, 150, 270], [0, 0, 120, 120, 240, 240, 60, 180, 300])
    ),
    # Two cranks that turn against each other, and two throws that are opposite on cranks apart.
    cp.Engine.from_lists(
        CYLINDER, tdc_deg=[0, 0], bank_deg=[90, 90], z=[0, 0], cranks=[(0.2, 0, -1)], crank=[0, 1]
    ),
    cp.Engine.from_lists(
        CYLINDER.replace(reciprocating_mass=0.0),
        tdc_deg=[0, 180],
        bank_deg=[90, 90],
        z=[0, 0],
        cranks=[(0.6, 0, 1)],
        crank=[0, 1],
        rotating_mass=1.0,
    ),
    # Nothing but rotating mass, and nothing at all but a shaft.
    cp.Engine.inline(
        CYLINDER.replace(reciprocating_mass=0.0), throws_deg=[0, 90], spacing=0.1, rotating_mass=0.3
    ),
    cp.Engine.inline(
        CYLINDER.replace(reciprocating_mass=0.0), throws_deg=[0], spacing=0.1
    ).with_shafts([cp.Shaft(2, [cp.Unbalance(0.01, 0.0)])]),
]


# --- the numbers ----------------------------------------------------------------------------------


def linked_forces(engine: cp.Engine, theta: np.ndarray) -> np.ndarray:
    """What each cylinder of an engine with link rods adds over a turn, N."""
    hung = []
    for bore, cylinder, link in zip(
        engine.bank_deg, engine.cylinders, engine.link_rods, strict=True
    ):
        rod = link_rods.Hung(float(bore), cylinder.rod_length, cylinder.reciprocating_mass)
        if link is not None:
            rod = rod._replace(
                master=link.master - 1, radius=link.radius, angle=link.angle_deg,
                big_end=link.big_end_mass,
            )  # fmt: skip
        hung.append(rod)
    crankpins = [
        cylinder.crank_radius * np.exp(1j * (np.radians(pin) + theta))
        for cylinder, pin in zip(engine.cylinders, engine.pin_deg, strict=True)
    ]
    return link_rods.cylinder_forces(hung, crankpins, len(theta)) * OMEGA_SQUARED


class Numbers:
    """Figures of an engine, from its balance and from the re-derivation over time."""

    def __init__(self, engine: cp.Engine) -> None:
        self.engine = engine
        self.balance = engine.balance(RPM, orders=ORDERS)
        parts = engine.cylinders
        sizes = [
            c.reciprocating_mass * c.crank_radius * abs(c.harmonics(1)[0]) * OMEGA_SQUARED
            for c in parts
        ]
        throws = engine.rotating_mass * [c.crank_radius for c in parts] * OMEGA_SQUARED
        self.force = max(sizes) or max(throws)
        unbalances = [*engine.counterweights, *(u for s in engine.shafts for u in s.unbalances)]
        places = [*engine.z, *(each.z for each in unbalances)]
        self.moment = self.force * max(abs(z - engine.reference_z) for z in places)
        lists = time_domain.EngineLists(
            [c.crank_radius for c in parts],
            [c.rod_length for c in parts],
            [c.reciprocating_mass for c in parts],
            engine.tdc_deg,
            engine.bank_deg,
            engine.z,
            [c.pin_offset for c in parts],
            engine.rotating_mass,
        )
        theta = time_domain.crank_angles(256)
        forces = time_domain.cylinder_forces(lists, RPM, theta)
        if any(engine.link_rods):
            forces = linked_forces(engine, theta)
        self.cylinders = 2 * np.fft.fft(forces, axis=1) / 256  # (cylinder, order, axis)

    def of(self, quantity: str, order: float) -> Any:
        return getattr(self.balance[order], quantity)

    def unit(self, quantity: str) -> float:
        return float(getattr(self, quantity))

    def added(self, quantity: str, order: float) -> np.ndarray:
        """What each cylinder adds, along (about) x and y: (n_cylinders, 2)."""
        force = self.cylinders[:, int(order)]
        if quantity == "force":
            return np.asarray(force)
        lever = (self.engine.z - self.engine.reference_z)[:, np.newaxis]
        return lever * np.stack([-force[:, 1], force[:, 0]], axis=1)


def shakes(each: Finding, numbers: Numbers) -> None:
    (order,), unit = each.orders, numbers.unit(each.quantity)
    found = numbers.of(each.quantity, order)
    forward, backward, tilt = each.values
    assert forward == pytest.approx(abs(found.forward), abs=CLOSE * unit)
    assert backward == pytest.approx(abs(found.backward), abs=CLOSE * unit)
    assert found.peak > 0.01 * unit * (1 - 1e-9)
    if min(forward, backward) > 1e-6 * unit:
        along = np.exp(1j * np.radians(tilt))
        waves = found.xy @ [along.real, along.imag]
        assert abs(waves) == pytest.approx(found.peak, rel=1e-9)
    engine = numbers.engine
    phases = np.exp(1j * np.radians(float(order) * engine.tdc_deg))
    moving = [c.reciprocating_mass > 0 for c in engine.cylinders]
    if len({c.pin_offset for c in engine.cylinders}) == 1 and all(moving):
        together = bool(np.abs(phases - phases[0]).max() < CLOSE) and len(engine) > 1
        assert (each.reason == "together") == (together and each.quantity == "force")


def remedy(each: Finding, numbers: Numbers) -> None:
    (order,), unit = each.orders, numbers.unit(each.quantity)
    kept, *ratios = each.values
    engine = numbers.engine
    here = numbers.of(each.quantity, order)
    cranks, crank_of = engine._core.cranks
    carrying = {cranks[crank][2] for crank in crank_of} if order == 1 else set()
    for sense, part in ((1, here.forward), (-1, here.backward)):
        worth = abs(part) > 0.01 * unit
        assert (sense * order in ratios) == (worth and sense not in carrying)
    parts = ((1, here.forward), (-1, here.backward))
    assert bool(each.reason) == any(abs(p) > 0.01 * unit and s in carrying for s, p in parts)
    if each.reason:
        weights = cp.counterweights(engine).hardware
        engine = engine.with_counterweights([*engine.counterweights, *weights])
        left = getattr(engine.balance(RPM)[order], each.quantity)
        assert left.peak == pytest.approx(kept, abs=CLOSE * unit)
    if ratios:
        shafts = cp.balance_shafts(
            engine, [int(ratio) for ratio in ratios], x=0.1, y=0.0, planes=[-1.0, 1.0], rpm=RPM
        )
        left = getattr(shafts.fitted.balance(RPM)[order], each.quantity)
        assert left.peak <= 0.02 * unit  # of two parts that are not worth a shaft
        if not each.reason:
            assert left.peak == pytest.approx(kept, abs=CLOSE * unit)


def roll(each: Finding, numbers: Numbers) -> None:
    engine, (peak, kept) = numbers.engine, each.values
    unit = numbers.force * max(1.0, *(abs(x) + abs(y) for x, y, _ in engine._core.cranks[0]))
    assert peak == pytest.approx(numbers.of("torque", 1).inertia.peak, abs=CLOSE * unit)
    left = cp.counterweights(engine).fitted.balance(RPM)[1].torque.inertia.peak
    assert kept == pytest.approx(left, abs=CLOSE * unit)


def bob_weights(each: Finding, numbers: Numbers) -> None:
    if len(numbers.engine._core.cranks[0]) > 1:  # of each crank its own part alone
        return
    left = cp.bob_weight(numbers.engine, each.values[0]).fitted.balance(RPM)[1]
    assert abs(left.force.forward) <= CLOSE * numbers.force
    assert abs(left.moment.forward) <= CLOSE * numbers.moment


def cancels(each: Finding, numbers: Numbers) -> None:
    engine, unit = numbers.engine, numbers.unit(each.quantity) or 1.0
    for order in each.orders:
        found = numbers.of(each.quantity, order)
        assert found.peak == 0.0
        assert each.proved == (found.status == "zero, proved")
        added = numbers.added(each.quantity, order)
        alone = np.abs(numbers.added("force", order)).max(axis=1)
        assert alone.sum() > 0.001 * numbers.force  # the cylinders make it
        zero = [
            bool(np.abs(added[[k - 1 for k in bank]].sum(axis=0)).max() <= CLOSE * unit)
            for bank in engine.banks.values()
        ]
        if each.reason == "plane":
            assert np.all((engine.z == engine.reference_z) | (alone == 0.0))
        elif each.reason in ("pairs", "mirrored"):
            paired = list(itertools.chain(*each.groups))
            assert len(set(paired)) == len(paired)
            for one, other in each.groups:
                assert np.abs(added[[one - 1, other - 1]].sum(axis=0)).max() <= CLOSE * unit
                if each.reason == "mirrored":
                    z = engine.z - engine.reference_z
                    assert z[one - 1] == pytest.approx(-z[other - 1], abs=1e-12)
            rest = [k for k in range(len(engine)) if k + 1 not in paired]
            assert np.abs(added[rest]).max(initial=0.0) <= CLOSE * unit
        elif each.reason in ("evenly", "each"):
            assert all(zero)
            if each.reason == "evenly":
                for bank in engine.banks.values():
                    turns = np.sort(order * engine.tdc_deg[[k - 1 for k in bank]] / 360 % 1)
                    gaps = np.diff([*turns, turns[0] + 1])
                    gaps = gaps[(gaps > 1e-9) & (gaps < 1 - 1e-9)]
                    assert np.ptp(gaps) < 1e-9
                    assert len(bank) % len(gaps) == 0  # as many at a time
        else:
            assert each.reason == "between"
            assert not all(zero)


def hardware(each: Finding, numbers: Numbers) -> None:
    (order,), unit, engine = each.orders, numbers.unit(each.quantity), numbers.engine
    bare = engine.with_counterweights([]) if "counterweights" in each.reason else engine
    bare = bare.with_shafts([]) if "balance shafts" in each.reason else bare
    before = getattr(bare.balance(RPM, orders=[order])[order], each.quantity)
    after = numbers.of(each.quantity, order)
    expected = [abs(part) for b in (before, after) for part in (b.forward, b.backward)]
    assert each.values == pytest.approx(expected, abs=CLOSE * unit)
    if each.proved:
        verdicts = getattr(engine.vanishing_orders([order]), each.quantity)
        parts = zip(
            each.values, each.values[2:], (verdicts.forward, verdicts.backward), strict=False
        )
        gone = [verdict[order] for was, now, verdict in parts if was and not now]
        assert gone
        assert set(gone) == {"vanishes"}


def rest(each: Finding, numbers: Numbers) -> None:
    """Peaks of what is not mentioned lie below the bound, which is no larger than their sum."""
    shaking = {(f.quantity, *f.orders) for f in numbers.engine.explain(RPM).findings
               if f.kind == "shakes"}  # fmt: skip
    for quantity, bound in zip(("force", "moment"), each.values, strict=True):
        unit = numbers.unit(quantity)
        orders = numbers.balance.orders
        sizes = {n: float(numbers.of(quantity, n).peak) for n in orders}
        others = [n for n in orders if (quantity, n) not in shaking]
        assert all(sizes[n] <= 0.01 * unit * (1 + 1e-9) for n in others)
        # "auto" leaves out a billionth, counted in its bound, at either side.
        assert bound == pytest.approx(sum(sizes[n] for n in others), rel=1e-6, abs=4e-8 * unit)
        part = numbers.engine.balance(RPM, orders=others).total
        assert getattr(part, quantity).peak <= bound + 1e-8 * unit


def inertia_torque(each: Finding, numbers: Numbers) -> None:
    peaks = numbers.balance.torque.inertia.peak
    assert each.values[0] == pytest.approx(peaks.max(), rel=1e-9)
    assert numbers.of("torque", each.orders[0]).inertia.peak == pytest.approx(peaks.max(), rel=1e-9)


def gas_torque(each: Finding, numbers: Numbers) -> None:
    halves = [k / 2 for k in range(1, 60)]
    gas = numbers.engine.balance(RPM, orders=halves).crank_torque.gas
    mean, *peaks = each.values
    assert mean == pytest.approx(gas.cycle_mean)
    assert (mean < 0) == (numbers.engine.crank_ends is not None)  # of a compressor
    assert peaks == pytest.approx(sorted(gas.peak, reverse=True)[: len(peaks)], rel=1e-9)
    for order, peak in zip(each.orders, peaks, strict=True):
        assert gas[order].peak == pytest.approx(peak, rel=1e-9)


def firing(each: Finding, numbers: Numbers) -> None:
    fires = numbers.engine.firing()
    assert np.sum(each.values) == pytest.approx(180 * fires.strokes)
    # One cylinder at a time, or groups of one size, whose members have intervals of 0.
    apart = np.flatnonzero(np.array(each.values) > 1e-9)
    ends = np.arange(1, apart.size + 1) * (len(each.values) // apart.size)
    equal = np.ptp(np.array(each.values)[apart]) < 1e-9
    assert (each.reason == "evenly") == (equal and (apart + 1).tolist() == ends.tolist())
    at = fires.angles_deg[np.array(fires.order) - 1]
    assert np.diff(at) % (180 * fires.strokes) == pytest.approx(
        np.array(each.values[:-1]) % (180 * fires.strokes), abs=1e-9
    )


def gas_orders(each: Finding, numbers: Numbers) -> None:
    """A sum of as many equal pulses, each at its firing angle."""
    fires = numbers.engine.firing()
    halves = np.arange(1, 4 * len(numbers.engine) // fires.strokes + 1) / 2
    angles = np.radians(fires.angles_deg)
    sums = np.abs(np.exp(-1j * halves[:, np.newaxis] * angles).sum(axis=1))
    if fires.strokes == 2:
        sums = sums * (halves % 1 == 0)
    assert each.proved
    assert list(each.orders) == list(halves[sums > CLOSE])


def articulated(each: Finding, numbers: Numbers) -> None:
    for row in each.groups:
        at = [number - 1 for number in row]
        assert len(row) > 2
        assert np.ptp(numbers.engine.z[at]) == 0.0
        pins = np.exp(1j * np.radians(numbers.engine.pin_deg[at]))
        assert np.abs(pins - pins[0]).max() < 1e-7


CHECKS: dict[str, Callable[[Any, Numbers], None]] = {
    "hardware": hardware,
    "shakes": shakes,
    "remedy": remedy,
    "roll": roll,
    "bob weights": bob_weights,
    "cancels": cancels,
    "rest": rest,
    "inertia torque": inertia_torque,
    "gas torque": gas_torque,
    "firing": firing,
    "gas orders": gas_orders,
    "articulated": articulated,
}

# --- the tests ------------------------------------------------------------------------------------


def check(engine: cp.Engine) -> set[tuple[str, str]]:
    """Hold all findings against the numbers; return their kinds and reasons."""
    explanation, numbers = engine.explain(RPM), Numbers(engine)
    findings = explanation.findings
    for each in findings:
        CHECKS[each.kind](each, numbers)
    # Each order that matters is mentioned once; each that cancels though the cylinders make it.
    for quantity in ("force", "moment"):
        told = [f.orders[0] for f in findings if (f.kind, f.quantity) == ("shakes", quantity)]
        assert len(set(told)) == len(told)
        for order in range(1, 13):
            made = np.abs(numbers.added("force", order)).max(axis=1).sum()
            if made > 0.03 * numbers.force and numbers.of(quantity, order).peak == 0.0:
                why = {"cancels", "hardware"}
                assert [
                    f for f in findings
                    if f.kind in why and f.quantity == quantity and order in f.orders
                ]  # fmt: skip
    for shown in (explanation, engine.explain()):
        assert len(shown.sentences) == len(shown.findings)
        for each, text in zip(shown.findings, shown.sentences, strict=True):
            assert re.fullmatch(r"[A-Z]\S*( \S+)+\.", text), text
            assert not re.search(r"\bnan|\binf|orders? \d+ and \d+ is |\bone \w+s\b(?!')", text), (
                text
            )
            assert ("exactly" not in text) or each.proved
            if each.kind == "cancels" or (each.kind == "hardware" and not sum(each.values[2:])):
                assert "exactly zero" in text if each.proved else "within rounding" in text
    return {(each.kind, each.reason) for each in findings}


@pytest.mark.filterwarnings("ignore")  # of odd pin splits, of heights that cancel no torque
@settings(max_examples=60, deadline=None)
@given(engine=fitted())
def test_every_finding_is_true(engine: cp.Engine) -> None:
    check(engine)


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
@in_turn("engine", [*PRESETS, *WITH_HARDWARE])
@pytest.mark.filterwarnings("ignore:mean piston speed")
def test_every_finding_is_true_of_known_engines(engine: cp.Engine) -> None:
    check(engine)


@pytest.mark.filterwarnings("ignore")
@in_turn("seed", range(40))
def test_counterweights_deliver_what_is_promised_of_several_cranks(seed: int) -> None:
    """Cranks of either sense, as fast as the main one, some of them without cylinders."""
    engine = random_engine(seed, ratios=(1, -1))
    explanation = engine.explain(RPM)
    numbers = Numbers(engine)
    numbers.force = explanation.unit
    numbers.moment = explanation.unit * explanation.lever
    for each in explanation.findings:
        if each.kind in ("remedy", "roll") and each.orders == (1,):
            CHECKS[each.kind](each, numbers)


@in_turn("seed", range(24))
def test_hardware_and_rests_are_true_of_several_cranks(seed: int) -> None:
    """Of the rest with orders so high that those of the fastest crank are among them."""
    engine = random_engine(seed)
    numbers = Numbers(engine)
    numbers.balance = engine.balance(RPM, orders=range(1, 49))
    explanation = engine.explain(RPM)
    numbers.force = explanation.unit
    numbers.moment = explanation.unit * explanation.lever
    found = [each for each in explanation.findings if each.kind in ("hardware", "rest")]
    for each in found:
        CHECKS[each.kind](each, numbers)
    assert found


def test_every_kind_and_every_reason_occurs() -> None:
    known = [*PRESETS, *WITH_HARDWARE]
    found = {(f.kind, f.reason) for engine in known for f in engine.explain().findings}
    assert {kind for kind, _ in found} == set(CHECKS)
    reasons = {"plane", "pairs", "mirrored", "evenly", "each", "between"}
    assert {reason for kind, reason in found if kind == "cancels"} == reasons
    groups = {"counterweights", "balance shafts", "counterweights and balance shafts"}
    assert {reason for kind, reason in found if kind == "hardware"} == groups


SENTENCES: list[tuple[cp.Engine, float | None, str]] = [
    (
        WITH_HARDWARE[0],
        6000,
        ("Counterweights remove the whole rocking moment of order 1, 2.42 kN·m: it is zero to "
        "within rounding.\n"
        "Order 4 leaves a shaking force of 302 N, up and down: all eight pistons pull together."),
    ),
    (
        WITH_HARDWARE[1],
        6000,
        "Counterweights remove the whole rocking moment of order 1, 1.15 kN·m: it is exactly zero.",
    ),
    (
        I4,
        None,
        ("Order 2 leaves a shaking force of 1.21 times one piston's first-order force F, up "
        "and down: all four pistons pull together.\n"
        "Two balance shafts at twice crank speed, one with the crank and one against it, would "
        "remove the shaking force of order 2."),
    ),
    (
        I4,
        None,
        ("The shaking force of order 1 is exactly zero: opposite pistons cancel in pairs "
        "(1 and 2, 3 and 4).\n"
        "The rocking moments of orders 1, 2 and 4 are exactly zero: front and rear mirror each "
        "other (1 and 4, 2 and 3).\n"
        "All other orders together make at most a shaking force of 0.075 % of F."),
    ),
    (
        SINGLE,
        3000,
        ("Order 1 leaves a shaking force of 1.91 kN, up and down.\n"
        "Counterweights could bring the shaking force of order 1 down to 955 N; the rest turns "
        "against the crank, and takes a balance shaft that does so at crank speed.\n"
        "Bob weights of half the reciprocating mass remove what turns with the crank at order 1, "
        "of force and moment."),
    ),
    (SINGLE, 3000, "exactly zero: the cylinder is in the reference plane."),
    (SINGLE, 3000, "The cylinder fires every 720°.\nGas torque begins at order 0.5."),
    # Half of the piston leaves a circle, all of it a line across the bore.
    (
        WITH_HARDWARE[4],
        3000,
        ("The counterweight removes all of the shaking force of order 1 that turns with the crank: "
        "it changes from 1.91 kN to 955 N.\n"
        "Order 1 leaves a shaking force of 955 N, constant in size, turning against the crank.\n"
        "No counterweight reaches the shaking force of order 1: it takes a balance shaft at crank "
        "speed, against the crank."),
    ),
    (
        WITH_HARDWARE[5],
        3000,
        ("The counterweight leaves the shaking force of order 1 at 1.91 kN and turns "
        "its direction.\n"
        "Order 1 leaves a shaking force of 1.91 kN, sideways."),
    ),
    (
        WITH_HARDWARE[5],
        None,
        "Bob weights of half the reciprocating mass in place of the counterweights remove",
    ),
    (
        WITH_HARDWARE[6],
        3000,
        "The counterweight and the balance shaft remove the whole shaking force of order 1, 1.91 k",
    ),
    (
        cp.balance_shafts(SINGLE, -1, x=0.1, y=0.0).fitted,
        3000,
        ("The balance shaft removes all of the shaking force of order 1 that turns against the "
        "crank: it changes from 1.91 kN to 955 N."),
    ),
    (
        cp.Engine.preset("i4").with_shafts([cp.Shaft(-2, [cp.Unbalance(1e-4, 0.0)])]),
        None,
        "Two more balance shafts at twice crank speed, one with the crank and one against it",
    ),
    (
        cp.Engine.preset("i2-180"),
        None,
        "The shaking force of order 1 is exactly zero: the pistons are opposite.",
    ),
    (WITH_HARDWARE[7], 3000, "The counterweight brings a shaking force of order 1: 987 N."),
    (
        cp.Engine.preset("i2-360"),
        3000,
        "Order 1 leaves a shaking force of 3.82 kN, up and down: both pistons pull together.",
    ),
    (cp.Engine.preset("i3"), None, ("Order 1 leaves a rocking moment of one piston's first-order "
     "force F at a lever of 173 mm, in pitch.\nCounterweights could bring the rocking moment of "
     "order 1 down to F at a lever of 86.6 mm; ")),
    (
        cp.Engine.preset("w12"),
        6000,
        "Order 1 leaves a rocking moment of 623 N·m, largest in yaw, turning with the crank.",
    ),
    (
        cp.Engine.preset("v14-49.54"),
        6000,
        "rocking moment of 1.67 kN·m, largest in yaw, turning against the crank.",
    ),
    (cp.Engine.preset("boxer-6"), None, ("No order of force or moment is as large as a millionth "
     "of one piston's first-order force.")),
    (
        cp.Engine.preset("v6-90-odd-fire"),
        None,
        ("It fires unevenly, at intervals of 150-90-150-90-150-90°: 1-6-5-4-3-2.\n"
        "Uneven firing leaves gas torque of orders 1.5 and 3, and of higher ones."),
    ),
    # Its rows are offset to either side: what is left below order 3 is theirs.
    (
        cp.Engine.preset("vr6").with_cycle(PETROL),
        None,
        ("It fires evenly, every 120°: 1-5-3-6-2-4.\nEven firing of unlike cylinders leaves gas "
        "torque of orders 0.5, 1.5, 2.5 and 3, and of higher ones."),
    ),
    (
        I4.replace(cylinder=CYLINDER).with_cycle(MOTORED),
        None,
        ") does no work over a cycle; its torque has peaks of ",
    ),
    (
        I4.replace(cylinder=CYLINDER).with_cycle(BRAKING),
        None,
        "Gas pressure (unnamed cycle) brakes the crank with ",
    ),
    # What turns with the crank is removed by the counterweights alone.
    (
        cp.bob_weight(SINGLE).fitted.with_shafts([cp.Shaft(-1, [cp.Unbalance(0.01, 0.0, 270)])]),
        3000,
        ("The counterweight and the balance shaft reduce the shaking force of order 1 from 1.91 kN "
        "to 32.1 N, none of which turns with the crank."),
    ),
    (
        cp.Engine.inline(cp.Cylinder(0.5, 1.5, 100.0), throws_deg=[0, 100, 250], spacing=1.2),
        None,
        "rocking moment of one piston's first-order force F at a lever of 1.97 m, in pitch",
    ),
    (WITH_HARDWARE[-2], 3000, "as large as a millionth of one throw's first-order force."),
    (V8, None, ("It fires evenly, every 90°: 1-8-4-3-6-5-7-2.\n"
     "Gas torque begins at order 4: all lower orders cancel exactly.")),
    (
        RADIAL,
        None,
        ("Seven rods share a crankpin: each rod is computed on the crankpin itself; link rods "
        "on a master rod, which this engine does not have, move their pistons differently."),
    ),
    (WITH_HARDWARE[-2], None, "one throw's first-order force"),
    (WITH_HARDWARE[-1], None, ("a shaking force of 0.04 kg·m times ω², constant in size, turning "
     "with the crank.")),
]  # fmt: skip


@in_turn(("engine", "rpm", "expected"), SENTENCES)
def test_words(engine: cp.Engine, rpm: float | None, expected: str) -> None:
    assert expected in str(engine.explain(rpm))


def test_hardware_is_advised_for_what_is_worth_it_alone() -> None:
    """A counterweight short of one digit leaves a trace that turns with the crank."""
    flat = cp.Engine.vee(I4.cylinders[0], bank_angle_deg=90, throws_deg=[0], spacing=0.1)
    text = str(flat.explain(RPM))
    assert "ounterweights could remove all of the shaking force of order 1" in text
    for beside in (1e-12, 1e-9, 1e-5):
        vee = cp.Engine.vee(
            I4.cylinders[0], bank_angle_deg=90 + beside, throws_deg=[0], spacing=0.1
        )
        first = [each for each in vee.explain(RPM).sentences if "order 1" in each][:2]
        assert not any("shaft at" in each for each in first), first
    # Within rounding of a circle there is no direction.
    circle = cp.Engine.vee(I4.cylinders[0], bank_angle_deg="90.00000001", throws_deg=[0], spacing=1)
    assert "constant in size, turning with the crank" in str(circle.explain(RPM))
    # Pistons of a milligram beside throws of half a kilogram.
    light = [each.replace(reciprocating_mass=1e-9) for each in I4.cylinders]
    assert "balance shaft" not in str(I4.replace(cylinder=light, rotating_mass=0.5).explain(RPM))


def test_pistons_that_pull_nothing_do_not_pull_together() -> None:
    shaft = cp.Shaft(3, [cp.Unbalance(0.01, 0.15)])
    found = str(I4.with_shafts([shaft]).explain(RPM))
    assert "Order 3 leaves a shaking force of 8.88 kN, constant in size, turning with" in found
    assert re.search("Order 3 .*together", found) is None
    assert "pull together" in found  # at order 2


def test_a_balance_shows_the_sentences_that_matter_most_under_its_table() -> None:
    engine = cp.Engine.preset("v6-60")
    found = html_of(engine.balance(RPM))
    said = engine.explain(RPM).sentences
    assert [text in found for text in said[:4]] == [True, True, False, True]  # no bob weights
    assert found.count("<li>") == 3
    # About another plane the moments are others; of a spectrum nothing is known of pistons.
    elsewhere = html_of(engine.balance(RPM).about(2.0))
    assert engine.replace(reference_z=2.0).explain(RPM).sentences[0] in elsewhere
    assert "<li>" not in html_of(engine.balance(RPM, orders=[1], spectrum={1: 1.0}))


def test_an_explanation_is_text_html_and_a_record() -> None:
    found = V8.explain(6000)
    assert str(found) == "\n".join(found.sentences)
    assert repr(found) == f"V8 90°, cross-plane at 6000 rpm\n{found}"
    assert found._repr_html_().count("<li>") == len(found.sentences)
    assert found.html(count=0) == "<ul></ul>"
    assert "piston&#x27;s" in V8.explain()._repr_html_()
    assert found == V8.explain(6000) != V8.explain(3000)
    for rpm in (-1.0, math.nan, "fast", True):
        with pytest.raises(cp.InputError, match="rpm"):
            V8.explain(rpm)  # type: ignore[arg-type]
