"""Gas pressure as a load: torque per half order and over θ, against an independent derivation."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.contributions import contributions
from numpy.typing import NDArray
from rederivation import torque as again

Array = NDArray[np.float64]
CRANKCASE = 1.1e5
BORE = 0.086
PEAK = 4e6
HALVES = [0.5 * k for k in range(1, 25)]


def bump(theta_deg: Array, peak: float = PEAK, at: float = 12.0) -> Array:
    """Return a smooth pressure with a period of 720°, Pa."""
    return 1e5 + peak * np.exp(40.0 * (np.cos(np.radians((theta_deg - at) / 2.0)) - 1.0))


def cycle(peak: float = PEAK, at: float = 12.0) -> cp.Cycle:
    """Return the same as a table so fine that its cubics are within 1e-9 of it."""
    theta = np.arange(-360.0, 360.0, 0.5)
    return cp.Cycle(theta, bump(theta, peak, at), name="bump")


def cylinder(pin_offset: float = 0.0, mass: float = 0.5) -> cp.Cylinder:
    return cp.Cylinder(0.043, 0.145, mass, pin_offset=pin_offset, bore=BORE)


def engines() -> dict[str, cp.Engine]:
    """Return engines that fire evenly and oddly, with offsets, and their firing orders."""
    offset = cylinder(0.004)
    return {
        "i4": cp.Engine.preset("i4", cylinder=cylinder()),
        "odd v6": cp.Engine.preset("v6-90-odd-fire", cylinder=cylinder()),
        "v8": cp.Engine.preset("v8-crossplane", cylinder=cylinder()),
        "offset i3": cp.Engine.from_firing_order(offset, "1-3-2", spacing=0.1),
    }


def numbers(engine: cp.Engine) -> list[int]:
    return [int(each) for each in engine.firing_order.split("-")]


@pytest.mark.parametrize("name", engines())
def test_torque_is_that_of_the_forces_on_pin_wall_head_and_bearing(name: str) -> None:
    engine = engines()[name]
    radius, rod, _, offset, _ = engine._core.cylinders[0]
    crank = (radius, rod, offset)
    theta = np.arange(0.0, 720.0, 0.5)
    fires = again.firing_deg(engine.tdc_deg.tolist(), numbers(engine))
    fired = engine.with_cycle(cycle(), crankcase=CRANKCASE)
    assert np.allclose(fired.firing_deg, fires, atol=1e-9, rtol=0.0)
    parts = [(each, bump, BORE, crank) for each in fires]
    on_crank, on_block = again.engine_torque(theta, parts, CRANKCASE)
    exact = fired.waveform(rpm=3000, theta_deg=theta)
    # Cubics through points half a degree apart are within 1e-8 of the peak.
    close = {"rtol": 0.0, "atol": 1e-7 * abs(on_crank).max()}
    assert np.allclose(exact.read("crank_torque.gas"), on_crank, **close)
    assert np.allclose(exact.read("torque.gas"), on_block, **close)
    b = fired.balance(rpm=3000, orders=HALVES)
    assert np.allclose(b.crank_torque.gas, again.phasors(on_crank, HALVES), **close)
    assert np.allclose(b.torque.gas, again.phasors(on_block, HALVES), **close)
    assert b.crank_torque.cycle_mean == pytest.approx(on_crank.mean(), rel=1e-7)
    # Internal forces: exactly opposite on block and crank.
    assert np.array_equal(b.torque.gas, -np.asarray(b.crank_torque.gas))
    assert b.torque.cycle_mean == -b.crank_torque.cycle_mean


@pytest.mark.parametrize("name", engines())
def test_parts_add_up_and_inertia_is_that_of_the_engine_without_gas(name: str) -> None:
    engine = engines()[name]
    fired = engine.with_cycle(cycle())
    plain, with_gas = (each.balance(rpm=3000, orders=HALVES) for each in (engine, fired))
    for quantity in ("force", "moment"):
        # Gas makes neither: not a bit changes.
        assert np.array_equal(getattr(plain, quantity).xy, getattr(with_gas, quantity).xy)
    for whole, inertia in (
        (with_gas.torque, plain.torque),
        (with_gas.crank_torque, plain.crank_torque),
    ):
        assert np.array_equal(whole.inertia, inertia)
        assert np.array_equal(whole, np.asarray(whole.gas) + np.asarray(whole.inertia))
    exact, bare = fired.waveform(rpm=3000), engine.waveform(rpm=3000)
    assert np.array_equal(exact.force, bare.force)
    assert np.array_equal(exact.moment, bare.moment)
    # A difference of the whole and the gas: roundings of the whole.
    largest = abs(exact.torque).max()
    assert abs(exact.read("torque.inertia") - bare.torque).max() < 1e-15 * largest * 4


@pytest.mark.parametrize("name", engines())
@pytest.mark.parametrize("rtol", [None, 1e-2])
def test_what_automatic_orders_leave_out_is_within_the_bound(name: str, rtol: float | None) -> None:
    fired = engines()[name].with_cycle(cycle())
    theta = np.arange(0.0, 720.0, 0.5)
    exact = fired.waveform(rpm=2000, theta_deg=theta)
    summed = fired.waveform(rpm=2000, theta_deg=theta, orders="auto", rtol=rtol)
    one = cp.Engine.inline(fired.cylinders[0], throws_deg=[0], spacing=0.1).with_cycle(cycle())
    largest = abs(one.waveform(rpm=0, theta_deg=theta).crank_torque).max()
    most = max(1e-3, rtol or 0.0) * largest
    for quantity in ("torque", "crank_torque"):
        left_out = abs(getattr(exact, quantity) - getattr(summed, quantity)).max()
        assert left_out <= summed.error_bound["torque"] + 1e-9 * largest
        # Inertia is left out to a part of its own, far smaller.
        assert summed.error_bound["torque"] < 2.0 * most
    assert summed.error_bound["torque"] > 0.0
    peak = fired.balance(rpm=2000, rtol=rtol).total.crank_torque.peak
    assert abs(peak - abs(exact.crank_torque).max()) <= summed.error_bound["torque"] + 1e-4 * peak


def test_even_firing_leaves_multiples_of_half_the_cylinders() -> None:
    for name, count in (("i4", 4), ("v8", 8), ("offset i3", 3)):
        b = engines()[name].with_cycle(cycle()).balance(rpm=3000, orders=HALVES)
        peaks = b.crank_torque.gas.peak
        left = [n for n, peak in zip(HALVES, peaks, strict=True) if peak > 0.0]
        assert left == [n for n in HALVES if 2.0 * n % count == 0.0], name
    one = cycle().torque_harmonics(cylinder(), HALVES)
    v8 = engines()["v8"].with_cycle(cycle()).balance(rpm=3000, orders=HALVES)
    assert v8[4].crank_torque.gas.peak == pytest.approx(8.0 * abs(one[HALVES.index(4.0)]))


def test_odd_firing_sums_are_those_printed() -> None:
    """Sums of unit vectors; see the star diagrams of odd-fire vees."""
    one = dict(zip(HALVES, abs(cycle().torque_harmonics(cylinder(), HALVES)), strict=True))
    v6 = engines()["odd v6"].with_cycle(cycle()).balance(rpm=3000, orders=HALVES)
    twin = cp.Engine.vee(
        cylinder(), bank_angle_deg=90, throws_deg=[0], spacing=0.1, firing_order="1-2"
    )
    assert sorted(twin.firing_intervals_deg) == [270.0, 450.0]
    twin_b = twin.with_cycle(cycle()).balance(rpm=3000, orders=HALVES)
    for b, printed in (
        (v6, {1.5: 2.296101, 3: 4.242641}),
        (twin_b, {0.5: 0.765367, 1: 1.414214, 1.5: 1.847759}),
    ):
        for order, times in printed.items():
            # Printed to six decimals.
            assert b[order].crank_torque.gas.peak / one[order] == pytest.approx(times, abs=6e-7)


def test_a_firing_order_and_its_mirror_have_equal_magnitudes_and_any_order_the_same_mean() -> None:
    v6 = engines()["odd v6"]
    mirrored = v6.replace(
        tdc_deg=(-v6.tdc_deg % 360.0).tolist(), firing_order=numbers(v6)[:1] + numbers(v6)[:0:-1]
    )
    one, other = (e.with_cycle(cycle()).balance(rpm=3000, orders=HALVES) for e in (v6, mirrored))
    phasors = np.asarray(one.crank_torque.gas)
    assert not np.allclose(phasors, np.asarray(other.crank_torque.gas), rtol=1e-3)
    assert np.allclose(one.crank_torque.gas.peak, other.crank_torque.gas.peak, rtol=1e-12)
    i4 = engines()["i4"].with_cycle([cycle(), cycle(), cycle(3e6), cycle(2e6)])
    turned = i4.replace(firing_order="1-2-4-3")
    first, second = (e.balance(rpm=3000, orders=HALVES) for e in (i4, turned))
    assert first.crank_torque.cycle_mean == second.crank_torque.cycle_mean
    assert np.allclose(first.crank_torque.gas.peak, second.crank_torque.gas.peak, rtol=1e-12)
    assert not np.allclose(first.crank_torque.gas, np.asarray(second.crank_torque.gas), rtol=1e-3)


def test_the_pressure_of_the_crankcase_leaves_inertia_alone() -> None:
    theta = np.arange(0.0, 720.0, 5.0)
    flat = cp.Cycle(theta, np.full_like(theta, CRANKCASE))
    engine = engines()["v8"]
    b = engine.with_cycle(flat, crankcase=CRANKCASE).balance(rpm=3000)
    plain = engine.balance(rpm=3000)
    assert b.orders == plain.orders
    assert np.array_equal(b.torque, plain.torque)
    assert b.torque.cycle_mean == 0.0
    assert b.fired
    # Absolute pressure in place of that above the crankcase is another torque of order 1.
    one = cp.Engine.inline(cylinder(), throws_deg=[0], spacing=0.1)
    absolute, gauge = (
        one.with_cycle(cycle(), crankcase=below).balance(3000, orders=[1])[1].crank_torque.gas.peak
        for below in (0.0, CRANKCASE)
    )
    assert abs(absolute / gauge - 1.0) > 0.03


def test_a_cycle_knows_nothing_of_what_was_asked_before() -> None:
    """Engines that share one and differ in a rod, an offset, a crankcase or the orders."""
    first, shared = (0.14, 0.0, 1e5, (1, 2, 3)), cycle()
    cases: list[Any] = [first]
    for place, other in enumerate((0.17, 0.002, 0.0, (2, 3, 4))):
        cases += [(*first[:place], other, *first[place + 1 :]), first]

    def fired(of: cp.Cycle, rod: float, offset: float, crankcase: float) -> cp.Engine:
        cylinder = cp.Cylinder(0.043, rod, 0.5, offset, bore=BORE)
        return cp.Engine.preset("single", cylinder=cylinder).with_cycle(of, crankcase=crankcase)

    # All before any is asked.
    engines = [(fired(shared, *rest), fired(cycle(), *rest)) for *rest, _ in cases]
    for (known, fresh), (*_, orders) in zip(engines, cases, strict=True):
        found, expected = (each.balance(3000, orders=orders) for each in (known, fresh))
        assert (found.crank_torque.phasor == expected.crank_torque.phasor).all()
        assert found.crank_torque.cycle_mean == expected.crank_torque.cycle_mean


def test_turning_the_engine_turns_nothing_of_torque() -> None:
    v6 = engines()["odd v6"].with_cycle(cycle())
    tilted = v6.replace(bank_deg=(v6.bank_deg + 30.0).tolist())
    one, other = (e.balance(rpm=3000, orders=HALVES) for e in (v6, tilted))
    assert np.array_equal(one.torque.gas, other.torque.gas)
    assert np.allclose(one.torque, other.torque, rtol=1e-12, atol=1e-9)


def test_pins_held_take_the_firing_along_as_banks_move_apart() -> None:
    v6 = engines()["odd v6"].with_cycle(cycle())
    wider = v6.with_bank_angle(100.0, hold="pins")
    right = [k - 1 for k in v6.banks["right"]]
    moved = np.where(np.isin(np.arange(6), right), -5.0, 5.0)
    assert np.allclose((wider.firing_deg - v6.firing_deg - moved + 360.0) % 720.0, 360.0)
    held = v6.with_bank_angle(100.0, hold="firing")
    assert np.array_equal(held.firing_deg, v6.firing_deg)
    again_90 = wider.with_bank_angle(90.0, hold="pins")
    assert np.allclose(again_90.firing_deg, v6.firing_deg)


def test_a_copy_fires_in_the_same_turns_as_its_engine() -> None:
    twin = cp.Engine.preset("v-twin-52")
    twin = twin.replace(cylinder=twin.cylinders[0].replace(bore=BORE)).with_cycle(cycle())
    for angle in (0.0, 60.0, 128.0, 180.0):
        turned = twin.with_bank_angle(angle, hold="pins")
        assert turned.replace(name=turned.name) == turned
        apart = np.diff(turned.firing_deg) - np.diff(turned.firing().angles_deg)
        assert np.allclose(apart % 720.0, 0.0)
        assert np.array_equal(turned.replace(rotating_mass=0.1).firing_deg, turned.firing_deg)


def test_a_copy_fires_as_the_engine_whose_order_was_dropped() -> None:
    v6 = engines()["odd v6"].with_cycle(cycle())
    turned = v6.with_bank_angle(0.0, hold="pins").with_bank_angle(180.0, hold="pins")
    assert turned.fired
    assert turned.firing_order == ""
    assert turned.replace(name=turned.name) == turned
    heavier = turned.replace(rotating_mass=0.3)
    assert np.array_equal(heavier.firing_deg, turned.firing_deg)
    assert heavier.cycles == turned.cycles
    with pytest.raises(cp.InputError, match="firing_order = None"):
        turned.replace(pin_deg=turned.pin_deg)  # of another crank nothing is known


def test_a_cylinder_without_gas_and_one_that_is_weak() -> None:
    i4 = engines()["i4"]
    theta = np.arange(0.0, 720.0, 1.0)
    fires = again.firing_deg(i4.tdc_deg.tolist(), numbers(i4))
    crank = (0.043, 0.145, 0.0)
    missing = i4.with_cycle([cycle(), None, cycle(1e6), cycle()], crankcase=CRANKCASE)

    def weak(after: Array) -> Array:
        return bump(after, 1e6)

    shapes = [bump, None, weak, bump]
    parts = [
        (at, shape, BORE, crank)
        for at, shape in zip(fires, shapes, strict=True)
        if shape is not None
    ]
    expected, _ = again.engine_torque(theta, parts, CRANKCASE)
    found = missing.waveform(rpm=3000, theta_deg=theta).read("crank_torque.gas")
    assert np.allclose(found, expected, rtol=0.0, atol=1e-7 * abs(expected).max())
    assert missing.balance(rpm=3000, orders=[0.5])[0.5].crank_torque.peak > 5.0
    assert i4.with_cycle([None] * 4) == i4
    assert "gas: 2 cycles, bump; cylinder 2 does not fire; crankcase 110000 Pa" in repr(missing)


def test_khurmi_15_7() -> None:
    """R. S. Khurmi, Theory of Machines, example 15.7: slide bars and turning moment at 60°."""
    engine = cp.Engine.inline(cp.Cylinder(0.3, 1.2, 250.0, bore=0.5), throws_deg=[0], spacing=1.0)
    theta = np.arange(0.0, 720.0, 5.0)
    difference = cp.Cycle(theta, np.full_like(theta, 0.35e6 + 101_325.0))
    waveform = engine.with_cycle(difference).waveform(rpm=250, theta_deg=[60.0])
    # Printed 14.491 kN·m with two terms of the acceleration; exact 14.48952.
    assert waveform.crank_torque[0] == pytest.approx(14_489.52, abs=0.005)


def test_mean_torque_of_the_otto_cycle() -> None:
    """Bore 86, r 43, λ 0.3, compression 10, n 1.3, p₀ 1 bar, p₃/p₂ 3.5: 36.63441 N·m."""
    r, length = 0.043, 0.043 / 0.3
    up = np.arange(-180.0, 0.25, 0.25)
    angle = np.radians(np.abs(up))
    x = r + length - (r * np.cos(angle) + np.sqrt(length**2 - (r * np.sin(angle)) ** 2))
    compressed = 1e5 * (10.0 / (1.0 + 9.0 * x / (2.0 * r))) ** 1.3
    theta = np.concatenate([[-360.0], up, -up[::-1], [180.0]])
    pressure = np.concatenate([[1e5], compressed, 3.5 * compressed[::-1], [1e5]])
    otto = cp.Cycle(theta, pressure)
    one = cp.Engine.inline(cp.Cylinder(r, length, 0.5, bore=0.086), throws_deg=[0], spacing=0.1)
    b = one.with_cycle(otto, crankcase=1e5).balance(rpm=3000, orders=[0.5])
    # Cubics at steps of 0.25°.
    assert b.crank_torque.cycle_mean == pytest.approx(36.63441, rel=1e-6)


def test_printed_inertia_torques_are_parts_of_fired_engines() -> None:
    """Of m·r²·ω² at λ = 0.3: I6 order 3, straight 8 order 4, a 60° V12 order 6."""
    part = cp.Cylinder(0.05, 0.05 / 0.3, 1.0, bore=0.08)
    over = 0.05**2 * (3000 * np.pi / 30.0) ** 2
    for order, harmonic, printed in (
        ("1-5-3-6-2-4", 3, 1.398013),
        ("1-6-2-5-8-3-7-4", 4, 0.188482),
    ):
        engine = cp.Engine.from_firing_order(part, order, spacing=0.1).with_cycle(cycle())
        b = engine.balance(rpm=3000)
        assert b[harmonic].crank_torque.inertia.peak / over == pytest.approx(printed, abs=6e-7)
    b = (
        cp.Engine.preset("v12-60", cylinder=part)
        .with_cycle(cycle())
        .balance(rpm=3000, orders=[3, 6])
    )
    # Rolls-Royce (1932) says there is none: of order 3 banks 60° apart leave none, of 6 they add.
    assert b[3].crank_torque.inertia.peak == 0.0
    assert b[6].crank_torque.inertia.peak / over == pytest.approx(0.00999705, abs=6e-9)


def test_engines_with_cycles_are_kept_compared_and_written() -> None:
    v6 = engines()["odd v6"]
    fired = v6.with_cycle([cycle(), None, *[cycle(3e6)] * 4], crankcase=CRANKCASE)
    assert fired.cycles is not None
    assert fired.cycles[1] is None
    assert fired.cycles[2] == cycle(3e6)
    assert fired.crankcase == CRANKCASE
    for read in (
        cp.Engine.from_toml(fired.to_toml()),
        cp.Engine.from_json(fired.to_json()),
        pickle.loads(pickle.dumps(fired)),  # noqa: S301 - just written
        copy.deepcopy(fired),
        fired.replace(),
    ):
        assert read == fired
        assert hash(read) == hash(fired)
        assert np.array_equal(read.firing_deg, fired.firing_deg)
    assert fired != v6
    assert fired.with_cycle(None) == v6
    assert fired.replace(cycle=None) == v6
    assert fired != fired.with_cycle(fired.cycles, crankcase=1e5)
    assert fired.with_first_tdc(40.0).with_first_tdc(0.0) == fired
    # Some cylinders pass into the next turn of the crank, some into the next cycle.
    turned = fired.with_first_tdc(200.0).firing_deg
    assert np.array_equal(turned, (fired.firing_deg + 200.0) % 720.0)
    # The file keeps the angles of firing, whether or not the crank has its order still.
    wider = fired.with_bank_angle(100.0, hold="pins")
    assert cp.Engine.from_json(wider.to_json()) == wider
    assert fired.with_counterweights([cp.Unbalance(0.01, 0.1, 30)]).cycles == fired.cycles


def test_errors_name_the_argument_and_a_hint() -> None:
    i4 = engines()["i4"]
    cases: list[tuple[cp.Engine, Any, str]] = [
        (i4.replace(firing_order=""), cycle(), r"firing_order = None: .*Possible orders.*1-3-4-2"),
        (
            i4.replace(cylinder=cp.Cylinder(0.043, 0.145, 0.5)),
            cycle(),
            r"cylinder\[0\]\.bore = None: .* give bore=",
        ),
        (i4, [cycle()], r"cycle has 1 entries, the engine has 4"),
        (i4, [cycle(), cycle(), 3.0, cycle()], r"cycle\[2\] = 3\.0: give a crankpin\.Cycle"),
        (i4.replace(strokes=2, firing_order=""), cycle(), r"cycle\[0\]\.strokes = 4: .*strokes=4"),
    ]
    for engine, argument, message in cases:
        with pytest.raises(cp.InputError, match=message):
            engine.with_cycle(argument)
    with pytest.raises(cp.InputError, match="crankcase = -1"):
        i4.with_cycle(cycle(), crankcase=-1.0)
    with pytest.raises(cp.InputError, match="gas pressure"):
        cp.tolerances(i4.with_cycle(cycle()), rpm=3000, reciprocating_mass=0.01, seed=1)


def test_a_two_stroke_fires_in_every_turn() -> None:
    theta = np.arange(0.0, 360.0, 0.5)

    def pressure(after: Array) -> Array:
        return 1e5 + 2e6 * np.exp(10.0 * (np.cos(np.radians(after - 10.0)) - 1.0))

    two = cp.Engine.inline(cylinder(), throws_deg=[0, 180], spacing=0.1, strokes=2)
    fired = two.with_cycle(cp.Cycle(theta, pressure(theta), strokes=2))  # no order needed
    b = fired.balance(rpm=3000, orders=[0.5, 1, 1.5, 2])
    assert b.crank_torque.gas.peak[[0, 1, 2]].tolist() == [0.0, 0.0, 0.0]
    crank = (0.043, 0.145, 0.0)
    whole = np.arange(0.0, 720.0, 0.5)
    expected, _ = again.engine_torque(
        whole, [(0.0, pressure, BORE, crank), (180.0, pressure, BORE, crank)], 101_325.0
    )
    largest = abs(expected).max()
    assert abs(b[2].crank_torque.gas - again.phasors(expected, [2])[0]) < 1e-7 * largest


def test_what_each_cylinder_adds_sums_to_the_torque() -> None:
    b = engines()["odd v6"].with_cycle(cycle()).balance(rpm=3000, orders=[0.5, 1.5, 3])
    parts = contributions(b, "torque")
    total = sum(each.phasors for each in parts)
    assert np.allclose(total, np.asarray(b.torque), rtol=0.0, atol=1e-12 * b.torque.peak.max())
    assert len(parts) == 6
    assert all(abs(each.phasors[0, 0]) > 1.0 for each in parts)


def test_totals_about_another_point_include_the_mean() -> None:
    fired = engines()["i4"].with_cycle(cycle())
    b = fired.balance(rpm=3000).about((0.1, 0.0, 0.0))
    w = fired.waveform(rpm=3000, theta_deg=np.arange(0.0, 720.0, 0.25))
    # Roll about a point beside: less x·F_y.
    expected = abs(w.torque - 0.1 * w.force[:, 1]).max()
    assert b.total.torque.peak == pytest.approx(expected, abs=b.error_bound["torque"] + 1e-3)


def test_zeros_of_gas_say_whether_they_are_proved() -> None:
    fired = engines()["v8"].with_cycle(cycle())
    b = fired.balance(rpm=3000)
    assert b[0.5].crank_torque.status == "zero, proved"
    assert b[0.5].torque.gas.status == "zero, proved"
    assert b[2].torque.status == "zero, proved"
    assert b[1.5].force.status == "zero, proved"
    assert b[4].torque.status == "summed"
    # Proofs are of alike cylinders with one cycle: a slightly weaker one has half orders.
    weaker = fired.with_cycle([cycle(), *[cycle(3.9e6)] * 7]).balance(rpm=3000)
    assert weaker[0.5].crank_torque.status == "summed"
    # Banks moved with pins held fire at other angles than the order they have by name.
    held = fired.with_bank_angle(90.0, hold="pins").balance(rpm=3000)
    assert held[0.5].torque.status == "zero, proved"
    plain = engines()["v8"].balance(rpm=3000)
    assert plain[0.5].torque.status == "zero, proved"
    assert plain[0.5].torque.peak == 0.0


@pytest.mark.parametrize("name", ["vr5", "vr6", "w12", "w16"])
def test_rows_with_pin_offsets_leave_what_the_balance_has(name: str) -> None:
    """Top dead centres are no parts of a turn, and harmonics of the two rows have no ratio."""
    engine = cp.Engine.preset(name)
    bored = [each.replace(bore=0.08) for each in engine.cylinders]
    fired = engine.replace(cylinder=bored, cycle=cycle())
    found = fired.vanishing_orders(HALVES).gas_torque
    peaks = fired.balance(rpm=3000, orders=HALVES).crank_torque.gas.peak
    assert {found[n] for n in HALVES} <= {"vanishes", "remains"}
    for n, peak in zip(HALVES, peaks, strict=True):
        # An order that is left is far above the rounding of torques of some 1000 N·m.
        assert (found[n] == "remains") == (peak > 1e-9), n
    # Of unknown pressure nothing is known of the two rows together.
    assert engine.vanishing_orders([0.5]).gas_torque[0.5] in {"undecided", "vanishes"}


def test_tables_and_datasets_have_the_parts() -> None:
    pytest.importorskip("xarray")
    fired = engines()["i4"].with_cycle(cycle())
    waveform = fired.waveform(rpm=3000, theta_deg=[0.0, 20.0])
    dataset = waveform.to_xarray()
    whole = dataset.torque_gas + dataset.torque_inertia
    assert np.allclose(whole, dataset.torque, rtol=1e-14)
    assert dataset.crank_torque_gas.attrs["units"] == "N m"
    table = waveform.tidy()
    assert set(table["quantity"].values) >= {"torque.gas", "crank_torque.inertia"}
    assert set(engines()["i4"].waveform(rpm=3000, theta_deg=[0.0]).to_xarray()) == {
        "force", "moment", "torque", "crank_torque",
    }  # fmt: skip
