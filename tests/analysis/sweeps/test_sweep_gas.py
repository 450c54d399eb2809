"""Do sweeps count gas pressure as balances do, and as the integral of p dV does?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

CRANKCASE = 95_000.0
CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, pin_offset=0.001, rod_inertia_excess=-4e-4, bore=0.086)
THETA = np.arange(-360.0, 360.0, 1.0)
# Combustion, and a lower pressure while gas is exchanged: half orders do not cancel.
PRESSURE = 1.1e5 + 4.2e6 * np.exp(-(((THETA - 14.0) / 27.0) ** 2)) - 2e4 * (np.abs(THETA) > 180.0)
CYCLE = cp.Cycle(THETA, PRESSURE)
PARTS = ["torque", "crank_torque"]
PARTS += [f"{name}.{part}" for name in PARTS for part in ("gas", "inertia")]


def engine(name: str) -> cp.Engine:
    return cp.Engine.preset(name, cylinder=CYLINDER).with_cycle(CYCLE, crankcase=CRANKCASE)


def misfiring(name: str) -> cp.Engine:
    whole = cp.Engine.preset(name, cylinder=CYLINDER)
    cycles = [None if k == 1 else CYCLE for k in range(len(whole))]
    return whole.with_cycle(cycles, crankcase=CRANKCASE)


SWEPT: dict[str, dict[str, Any]] = {
    "speeds": {"rpm": [800.0, 2500.0, 6000.0]},
    "one speed": {"rpm": 2500.0, "rod_ratio": [0.25, 0.33]},
    "rods": {"rpm": [800.0, 6000.0], "rod_ratio": [0.25, 0.33], "pin_offset": [0.0, 0.002]},
    "pins": {"rpm": [800.0, 6000.0], "bank_angle_deg": [0.0, 47.0, 60.0, 111.0], "hold": "pins"},
    "firing": {"rpm": [6000.0, 800.0], "bank_angle_deg": [0.0, 47.0, 171.0], "hold": "firing"},
    "many": {"rpm": np.linspace(500, 8000, 41), "bank_angle_deg": [50.0, 90.0], "hold": "pins"},
}


def close(found: NDArray[Any], expected: NDArray[Any], scale: float) -> None:
    # Phases of order 12 of angles up to 720°: 12 · 8e-14° is 2e-14 rad; twelve terms, ten allowed.
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=2e-13 * scale)


@pytest.mark.parametrize("swept", SWEPT)
@pytest.mark.parametrize("name", ["v6-90-odd-fire", "v8-crossplane"])
def test_each_point_is_the_balance_of_its_engine(name: str, swept: str) -> None:
    for fired in (engine(name), misfiring(name)):
        s = cp.sweep(fired, orders=[0.5, 1, 1.5, 2, 4.5, 12], **SWEPT[swept])
        for place in np.ndindex(*(len(s.coords[name]) for name in s.dims)):
            at = {name: s.coords[name][k] for name, k in zip(s.dims, place, strict=True)}
            rpm = at["rpm"] if "rpm" in at else s.fixed["rpm"]
            alone = s.engine_at(**at).balance(rpm, orders=s.orders)
            # Cylinders add up in the mean where orders cancel.
            scale = alone.read("crank_torque.gas", "peak").max() + abs(
                alone.crank_torque.cycle_mean
            )
            scale += alone.read("torque", "peak").max()
            for part in PARTS:
                close(s.read(part, "values")[place], alone.read(part, "values"), scale)
                close(s.read(part, "total_peak")[place], alone.read(part, "total_peak"), 6 * scale)
                close(s.read(part, "cycle_mean")[place], alone.read(part, "cycle_mean"), scale)
                # A balance takes the larger of the two torques' bounds for both.
                found, most = s.read(part, "zero_bound")[place], alone.read(part, "zero_bound")
                assert (found <= most * (1.0 + 1e-9)).all()
                assert ((found > 0.2 * most) | (most == 0.0)).all()
        assert s.torque.gas[0.5].peak.shape == s[0.5].torque.peak.shape


def gas_torque(theta_deg: NDArray[np.float64], fired: cp.Engine, rod_ratio: float) -> NDArray[Any]:
    """(p − p₀)·A·ds/dθ summed over cylinders: s is what the piston has gone from its crank."""
    total = np.zeros(len(theta_deg))
    r, e = CYLINDER.crank_radius, CYLINDER.pin_offset
    assert CYLINDER.bore is not None
    # A cycle begins where the crankpin is aligned with the bore, a third of a degree before the
    # top.
    turns = np.round((fired.firing().angles_deg - fired.tdc_deg) / 360.0)
    for phase in fired.tdc_deg + 360.0 * turns:
        at = np.deg2rad(theta_deg - phase)
        rod = np.sqrt((r / rod_ratio) ** 2 - (r * np.sin(at) - e) ** 2)
        slope = r * np.sin(at) + (r * np.sin(at) - e) * r * np.cos(at) / rod
        gauge = CYCLE.pressure_at(theta_deg - phase) - CRANKCASE
        total += gauge * 0.25 * np.pi * CYLINDER.bore**2 * slope
    return total


def test_orders_and_waveforms_are_those_of_the_pressure_times_the_piston_speed() -> None:
    """Gas torque does not depend on speed; on the block it is the opposite of that on the crank."""
    fired, theta = engine("v6-90-odd-fire"), np.arange(0.0, 720.0, 3.0)
    s = cp.sweep(fired, rpm=[600.0, 5000.0], rod_ratio=[0.28, 0.33], rtol=1e-3)
    axes: dict[str, Any] = {**s.axes}
    plain = cp.sweep(cp.Engine.preset("v6-90-odd-fire", cylinder=CYLINDER), **axes, rtol=1e-9)
    exact, summed = s.waveform(theta, exact=True), s.waveform(theta)
    without = plain.waveform(theta, exact=True)
    for k, rod_ratio in enumerate((0.28, 0.33)):
        expected = gas_torque(theta, fired, rod_ratio)
        for found, sense in ((exact.torque, -1.0), (exact.crank_torque, 1.0)):
            inertia = without.torque if sense < 0.0 else without.crank_torque
            gas = found[k] - inertia[k]
            # Both add terms of the size of the largest inertia torque.
            assert np.abs(gas - sense * expected).max() <= 1e-12 * np.abs(inertia[k]).max()
    assert (exact.read("torque.gas")[:, 0] == exact.read("torque.gas")[:, 1]).all()
    parts = exact.read("torque.gas") + exact.read("torque.inertia")
    assert np.abs(parts - exact.torque).max() <= 1e-12 * np.abs(exact.torque).max()
    for name in ("torque", "crank_torque"):
        left = np.abs(summed.read(name) - exact.read(name)).max()
        # The bound is the sum of the orders left out: they peak together within a factor of 50.
        assert 0.02 * s.error_bound["torque"] < left <= s.error_bound["torque"]
    assert (s.force.peak == plain._at_orders(s.orders).force.peak).all()


def test_mean_torque_counts_in_totals_and_waveforms_of_orders_that_vanish() -> None:
    s = cp.sweep(engine("i4"), rpm=[600.0, 5000.0], orders=[7.5])
    mean = np.mean(gas_torque(np.arange(0.0, 720.0, 0.25), engine("i4"), CYLINDER.rod_ratio))
    # Trapezia of a smooth period of a quarter of a degree; the table itself is linear or cubic.
    np.testing.assert_allclose(s.crank_torque.cycle_mean, [mean] * 2, rtol=1e-6)
    np.testing.assert_allclose(s.total.torque.peak, [abs(mean)] * 2, rtol=1e-6)
    np.testing.assert_allclose(s.waveform([0.0, 30.0]).torque, -mean, rtol=1e-6)


def test_orders_of_unfired_engines_beside_fired_ones() -> None:
    plain = cp.Engine.preset("i4", cylinder=CYLINDER)
    s = cp.sweep({"plain": plain, "fired": engine("i4")}, rpm=[600.0, 5000.0], orders=[0.5, 2])
    alone = plain.balance(5000.0, orders=[0.5, 2])
    close(s.torque.phasor[0, 1], alone.torque.phasor, alone.torque.peak.max())
    assert not s.torque.gas.peak[0].any()
    assert s.torque.gas[2].peak[1].all()
    assert (s.torque.cycle_mean[0] == 0.0).all()


def test_the_speed_of_least_torque_of_an_order_is_that_of_its_phasors() -> None:
    fired = cp.Engine.preset("i4").with_cycle(cp.Cycle.example())
    speeds = np.arange(500.0, 6500.0, 10.0)
    swept = cp.sweep(fired, rpm=speeds, orders=[2, 4])
    at = fired.balance(1000.0, orders=[2])[2].crank_torque
    gas, inertia = at.gas.phasor, at.inertia.phasor
    # |G + I·(n/1000)²| is least where the derivative by n² vanishes.
    expected = 1000.0 * np.sqrt(-(inertia * np.conj(gas)).real) / abs(inertia)
    found = swept.at_minimum(swept[2].crank_torque.peak)
    assert abs(found.rpm - expected) <= 5.0  # half a step of the sweep
    assert found[2].crank_torque.peak == swept[2].crank_torque.peak.min()
    with pytest.raises(cp.InputError, match=r"values have shape \(2,\)"):
        swept.at_minimum([1.0, 2.0])


FLAT = cp.CycleMap([1000, 3000], [0.0, 1.0], [[CYCLE, CYCLE], [CYCLE, CYCLE]])


@pytest.mark.parametrize("own", [5e4, 101_325.0, 1.2e5])
def test_a_map_leaves_the_engine_s_crankcase(own: float) -> None:
    """Of several engines each has its own; one that is given counts for all."""
    bare = cp.Engine.preset("i2-270", cylinder=CYLINDER)
    engines = [bare.with_cycle(CYCLE, crankcase=own), bare]
    swept: dict[str, Any] = {"rpm": 2000.0, "cycle": FLAT, "load": 0.5, "orders": [0.5, 1]}
    for given, expected in ((None, [own, 101_325.0]), (9e4, [9e4, 9e4])):
        s = cp.sweep(engines, crankcase=given, **swept)
        for k, below in enumerate(expected):
            alone = bare.with_cycle(CYCLE, crankcase=below).balance(2000.0, orders=[0.5, 1])
            close(s.torque.gas.peak[k], alone.torque.gas.peak, alone.torque.gas.peak.max())
            assert s.engine_at(engine=s.coords["engine"][k]).crankcase == below


def test_a_crankcase_that_nothing_reads_is_refused() -> None:
    fired, bare = engine("i2-270"), cp.Engine.preset("i2-270", cylinder=CYLINDER)
    with pytest.raises(cp.InputError, match=r"crankcase = 90000.*applies to a cycle map"):
        cp.sweep(fired, rpm=2000, crankcase=9e4)
    calls: list[Callable[[], cp.Engine]] = [
        lambda: fired.with_cycle(None, crankcase=9e4),
        lambda: bare.replace(crankcase=9e4),
        lambda: fired.replace(cycle=None, crankcase=9e4),
    ]
    for call in calls:
        with pytest.raises(cp.InputError, match=r"crankcase = 90000.*needs cycle"):
            call()
    assert fired.with_cycle(CYCLE).crankcase == CRANKCASE
    assert fired.replace(crankcase=9e4).crankcase == 9e4
