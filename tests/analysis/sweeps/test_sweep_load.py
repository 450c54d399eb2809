"""Do sweeps over speed and load interpolate pressure, as an independent derivation does?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from rederivation import torque as again

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

CRANKCASE = 95_000.0
BORE, CRANK = 0.086, (0.043, 0.145, 0.001)
CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, pin_offset=0.001, bore=BORE)
SPEEDS, LOADS = [1000.0, 2500.0, 6000.0], [0.0, 0.4, 1.0]
THETA = np.arange(0.0, 720.0, 0.5)
HALVES = [0.5, 1, 1.5, 2, 3, 4.5, 6]


def pressure(theta_deg: NDArray[np.float64], rpm: float, load: float) -> NDArray[np.float64]:
    """Return a smooth pressure whose height and place depend on speed and load, Pa."""
    at = 8.0 + rpm / 500.0 + 6.0 * load**2
    peak = 1e6 + 3e6 * load - 40.0 * rpm
    return 1e5 + peak * np.exp(40.0 * (np.cos(np.radians((theta_deg - at) / 2.0)) - 1.0))


def cycle(rpm: float, load: float) -> cp.Cycle:
    """Return a table so fine that its cubics are within 1e-9 of the pressure."""
    theta = np.arange(-360.0, 360.0, 0.5)
    return cp.Cycle(theta, pressure(theta, rpm, load))


MAP = cp.CycleMap(SPEEDS, LOADS, [[cycle(n, load) for load in LOADS] for n in SPEEDS])


def between(rpm: float, load: float) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Return the pressure between those of the map: linear in speed and in load."""

    def of_load(theta: NDArray[np.float64], n: float) -> NDArray[np.float64]:
        k = 0 if load < 0.4 else 1
        share = (load - LOADS[k]) / (LOADS[k + 1] - LOADS[k])
        return (1 - share) * pressure(theta, n, LOADS[k]) + share * pressure(theta, n, LOADS[k + 1])

    def found(theta: NDArray[np.float64]) -> NDArray[np.float64]:
        k = 0 if rpm < 2500.0 else 1
        share = (rpm - SPEEDS[k]) / (SPEEDS[k + 1] - SPEEDS[k])
        return (1 - share) * of_load(theta, SPEEDS[k]) + share * of_load(theta, SPEEDS[k + 1])

    return found


def engine(name: str) -> cp.Engine:
    return cp.Engine.preset(name, cylinder=CYLINDER)


@pytest.mark.parametrize(("name", "missing"), [("i4", None), ("v6-90-odd-fire", 1)])
def test_torque_is_that_of_the_pressure_between_the_cycles(name: str, missing: int | None) -> None:
    plain = engine(name)
    maps = [None if k == missing else MAP for k in range(len(plain))]
    rpm, load = [1000.0, 1700.0, 2500.0, 5200.0], [0.0, 0.3, 0.4, 0.85, 1.0]
    s = cp.sweep(
        plain, rpm=rpm, load=load, cycle=MAP if missing is None else maps, crankcase=CRANKCASE,
        orders=HALVES,
    )  # fmt: skip
    exact = s.waveform(THETA, exact=True)
    order = [int(each) for each in plain.firing_order.split("-")]
    fires = again.firing_deg(plain.tdc_deg.tolist(), order)
    for k, n in enumerate(rpm):
        inertia = plain.waveform(rpm=n, theta_deg=THETA)
        for j, each in enumerate(load):
            shape = between(n, each)
            parts = [(f, shape, BORE, CRANK) for i, f in enumerate(fires) if i != missing]
            on_crank, on_block = again.engine_torque(THETA, parts, CRANKCASE)
            # Cubics through points half a degree apart are within 1e-8 of the peak.
            close = {"rtol": 0.0, "atol": 1e-7 * abs(on_crank).max()}
            crank, block = again.phasors(on_crank, HALVES), again.phasors(on_block, HALVES)
            assert np.allclose(s.crank_torque.gas.phasor[k, j], crank, **close)
            assert np.allclose(s.torque.gas.phasor[k, j], block, **close)
            assert np.allclose(s.crank_torque.cycle_mean[k, j], on_crank.mean(), **close)
            whole = crank + again.phasors(np.asarray(inertia.crank_torque), HALVES)
            assert np.allclose(s.crank_torque.peak[k, j], abs(whole), **close)
            assert np.allclose(exact.read("crank_torque.gas")[k, j], on_crank, **close)
            assert np.allclose(exact.torque[k, j], on_block + inertia.torque, **close)


SWEPT: dict[str, dict[str, Any]] = {
    "one point": {"rpm": 1700.0, "load": 0.3},
    "loads": {"rpm": 2500.0, "load": [1.0, 0.2, 0.0]},
    "rods": {"rpm": [1200.0, 6000.0], "load": [0.0, 0.7], "rod_ratio": [0.25, 0.33]},
    "pins": {
        "rpm": [1000.0, 1700.0], "load": [0.1, 0.9], "rod_ratio": [0.25, 0.31],
        "bank_angle_deg": [60.0, 111.0], "hold": "pins",
    },
    "firing": {"rpm": 3000.0, "load": [0.1, 0.9], "bank_angle_deg": [47.0, 90.0], "hold": "firing"},
}  # fmt: skip


@pytest.mark.parametrize("swept", SWEPT)
def test_each_point_is_the_balance_of_its_engine(swept: str) -> None:
    engines = {"v6": engine("v6-90-odd-fire"), "v8": engine("v8-crossplane")}
    s = cp.sweep(engines, cycle=MAP, crankcase=CRANKCASE, orders=HALVES, **SWEPT[swept])
    for place in np.ndindex(*(len(s.coords[name]) for name in s.dims)):
        at = {name: s.coords[name][k] for name, k in zip(s.dims, place, strict=True)}
        fired = s.engine_at(**at)
        assert fired.crankcase == CRANKCASE
        alone = fired.balance({**s.fixed, **at}["rpm"], orders=HALVES)
        assert s.sel(**at).engine == fired
        scale = alone.read("crank_torque.gas", "peak").max() + abs(alone.crank_torque.cycle_mean)
        for part in ("torque", "torque.gas", "torque.inertia", "crank_torque", "crank_torque.gas"):
            for what in ("values", "peak", "total_peak", "cycle_mean"):
                found, expected = s.read(part, what)[place], alone.read(part, what)
                # A cycle between four is a polynomial through sums of theirs: roundings of the sum
                # of twelve orders of six or eight cylinders.
                np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * scale)
        np.testing.assert_array_equal(s.moment.peak[place], s.sel(**at).moment.peak)


@pytest.mark.parametrize("options", [{"orders": HALVES}, {"rtol": 1e-2}])
def test_maps_that_agree_at_one_point_differ_at_others(options: dict[str, Any]) -> None:
    idle = cp.CycleMap(SPEEDS, LOADS, [[cycle(n, 0.0)] * 3 for n in SPEEDS])
    copy = cp.CycleMap(SPEEDS, LOADS, MAP.cycles)
    plain = engine("v6-90-odd-fire")
    s = cp.sweep(
        plain, rpm=[1000.0, 1700.0], load=[0.0, 0.7], cycle=[MAP, idle, copy, None, idle, MAP],
        **options,
    )  # fmt: skip
    for k, j in np.ndindex(2, 2):
        fired = s.engine_at(rpm=s.coords["rpm"][k], load=s.coords["load"][j])
        alone = fired.balance(float(s.coords["rpm"][k]), orders=s.orders)
        scale = alone.read("crank_torque.gas", "peak").max() + abs(alone.crank_torque.cycle_mean)
        for what in ("values", "cycle_mean"):
            found, expected = s.read("crank_torque", what)[k, j], alone.read("crank_torque", what)
            # As above.
            np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * scale)


def test_orders_left_out_are_within_their_bound_at_every_point() -> None:
    rpm, load = [1000.0, 1700.0, 6000.0], [0.0, 0.2, 0.7, 1.0]
    s = cp.sweep(engine("v8-crossplane"), rpm=rpm, load=load, cycle=MAP, rtol=1e-2)
    given = [order / 2 for order in range(1, 8)]
    assert set(s.orders) & {0.5, 2.5} == set()  # cancelled by even firing
    assert s.orders != tuple(given)
    exact, summed = s.waveform(THETA, exact=True), s.waveform(THETA)
    left = abs(exact.crank_torque - summed.crank_torque).max(axis=-1)
    assert left.max() <= s.error_bound["torque"]
    # A bound of sums that peak together, not one that is met by chance.
    assert left.max() > 0.02 * s.error_bound["torque"]
    # What is left out is a small part of one cylinder's largest torque at the largest load.
    one = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1).with_cycle(cycle(6000.0, 1.0))
    largest = abs(one.waveform(rpm=0, theta_deg=THETA).crank_torque).max()
    assert s.error_bound["torque"] < 3e-2 * largest


def test_loads_are_a_dimension_of_everything_that_is_read() -> None:
    s = cp.sweep(engine("i4"), rpm=[1000, 2000], load=[0, 0.5, 1], cycle=MAP, orders=[1, 2, 4])
    assert s.dims == ("rpm", "load")
    assert s.fired
    assert s.force.peak.shape == (2, 3, 3)
    # Force and moment do not depend on load.
    assert (s.force.peak == s.force.peak[:, :1]).all()
    assert s.sel(load=0.5).dims == ("rpm",)
    assert (s.sel(load=0.5).torque.phasor == s.torque.phasor[:, 1]).all()
    least = s.at_minimum(s.total.crank_torque.peak)
    assert least.total.crank_torque.peak == s.total.crank_torque.peak.min()
    assert s.about(0.5).moment.peak.shape == (2, 3, 3)
    again = cp.sweep(engine("i4"), rpm=[1000, 2000], load=[0, 0.5, 1], cycle=MAP, orders=[1, 2, 4])
    assert again == s
    assert hash(again) == hash(s)
    assert s != cp.sweep(engine("i4"), rpm=[1000, 2000], load=[0, 0.5, 1], cycle=MAP, orders=[1])
    assert "load" in repr(s)
    dataset = pytest.importorskip("xarray") and s.to_xarray()
    assert dataset.torque_gas.dims == ("rpm", "load", "order")


def test_a_map_of_one_cycle_is_that_cycle() -> None:
    one = cp.CycleMap([2000], [1], [[cycle(2000.0, 1.0)]])
    s = cp.sweep(engine("i4"), rpm=2000, load=1, cycle=one, orders=[2, 4], crankcase=CRANKCASE)
    fired = engine("i4").with_cycle(cycle(2000.0, 1.0), crankcase=CRANKCASE)
    same = cp.sweep(fired, rpm=2000, orders=[2, 4])
    assert (s.torque.phasor == same.torque.phasor).all()
    assert s.torque.cycle_mean == same.torque.cycle_mean


ENDS: dict[Literal["head", "crank"], tuple[float, float]] = {
    "head": (3e5, 5e5),
    "crank": (0.0, 5e5),
}
"""End of a cylinder → discharge pressures at two loads, none where it is unloaded."""


def double_acting() -> tuple[cp.Engine, list[list[cp.Cycle]], list[list[cp.Cycle]]]:
    """Return a compressor, and cycles of its ends; the crank end is unloaded at load 0."""
    cylinder = cp.Cylinder(0.1, 0.4, 60.0, pin_offset=0.01, bore=0.3)
    bare = cp.Engine.opposed_throws(cylinder, throws_deg=[0, 180, 90], spacing=0.3)
    head, crank = (
        [
            [
                cp.Cycle.compressor(
                    cylinder, discharge=high + 100.0 * rpm if high else None, end=end
                )
                for high in pressures
            ]
            for rpm in (300.0, 600.0)
        ]
        for end, pressures in ENDS.items()
    )
    return bare, head, crank


def test_maps_of_both_ends_are_the_cycles_between_theirs() -> None:
    """Torque is linear in pressure: between points it is that of their mixture."""
    bare, head, crank = double_acting()
    ends = [crank[0][0], None, crank[0][1]]
    rods = [0.06, 0.0, 0.08]
    engine = bare.with_cycle(head[0][0], crank_end=ends, rod_diameter=rods)
    maps = [cp.CycleMap([300, 600], [0, 1], cycles) for cycles in (head, crank)]
    of_each = [maps[1], None, maps[1]]

    def fired(i: int, j: int) -> cp.Engine:
        at_ends = [crank[i][j], None, crank[i][j]]
        return bare.with_cycle(head[i][j], crank_end=at_ends, rod_diameter=rods)

    shares = {300.0: (1.0, 0.0), 450.0: (0.5, 0.5), 600.0: (0.0, 1.0)}
    points: dict[str, Any] = {"rpm": [*shares], "load": [0, 0.25, 1], "orders": [1, 2, 3]}
    for given in (maps[1], of_each):
        s = cp.sweep(engine, cycle=maps[0], crank_end=given, **points)
        for k, of_speed in enumerate(shares.values()):
            for m, load in enumerate((0.0, 0.25, 1.0)):
                mixed = sum(
                    of_speed[i] * (load if j else 1.0 - load)
                    * fired(i, j).balance(100.0, orders=[1, 2, 3]).read("crank_torque.gas")
                    for i in (0, 1) for j in (0, 1)
                )  # fmt: skip
                found = s.read("crank_torque.gas")[k, m]
                np.testing.assert_allclose(found, mixed, atol=1e-10 * np.abs(mixed).max())
    at = s.engine_at(rpm=600, load=1)
    assert at.crank_ends is not None
    assert at.crank_ends[1] is None
    np.testing.assert_array_equal(at.rod_diameter, rods)
    assert s.loads_counted == "gas: cycle map; crank ends: cycle map"
    peaks = cp.operating_map(
        engine, [300, 600], cycle=maps[0], crank_end=maps[1], load=[0, 1], inertia=20.0
    )
    loads = cp.bearing_loads(fired(1, 1), 600.0)
    np.testing.assert_allclose(peaks.main[1, 1], loads.main.peak, rtol=1e-9)
    for wrong, words in (
        ({"cycle": maps[0]}, "cycle replaces those of double-acting pistons: .*crank_end"),
        ({"crank_end": maps[0]}, "crank_end = .*needs cycle"),
        ({"cycle": maps[0], "crank_end": crank[0][0]}, "crank_end = .*give a crankpin.CycleMap"),
        ({"cycle": maps[0], "crank_end": [maps[1]] * 2}, "crank_end has 2 entries"),
        ({"cycle": maps[0], "crank_end": maps[1].replace(load=[0, 2])}, "crank_end has maps that"),
    ):
        options: dict[str, Any] = wrong if "cycle" not in wrong else wrong | {"load": 0.5}
        with pytest.raises(cp.InputError, match=words):
            cp.sweep(engine, rpm=400, **options)
    with pytest.raises(cp.InputError, match="crank_end applies to double-acting pistons"):
        cp.sweep(bare, rpm=400, load=0, cycle=maps[0], crank_end=maps[1])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"load": 0.5}, r"load = 0\.5: .*give cycle="),
        ({"cycle": MAP}, "load = None: give loads from 0 to 1"),
        ({"cycle": MAP, "load": [0.5, 1.5]}, r"load = 1\.5: the map has 0 to 1"),
        ({"cycle": MAP, "load": 0.5, "rpm": [2000, 900]}, r"rpm = 900.*: the map has 1000 to 6000"),
        ({"cycle": MAP, "load": []}, r"load = \[\]: give at least one value"),
        ({"cycle": MAP, "load": "full"}, "load = 'full': give numbers"),
        ({"cycle": MAP.cycles[0][0], "load": 1}, "cycle = .*: give a crankpin.CycleMap"),
        ({"cycle": [MAP, 3, MAP, MAP], "load": 1}, r"cycle\[1\] = 3: give a crankpin.CycleMap"),
        ({"cycle": [MAP], "load": 1}, "cycle has 1 entries, the engine has 4"),
        ({"cycle": [None] * 4, "load": 1}, "cycle = .*: has no map"),
        (
            {"cycle": [MAP, MAP, MAP, MAP.replace(load=[0, 0.5, 1])], "load": 1},
            "maps that differ in load",
        ),
        ({"cycle": MAP, "load": 1, "crankcase": -1}, "crankcase = -1"),
    ],
)
def test_errors_name_the_argument_and_a_hint(given: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.sweep(engine("i4"), **({"rpm": 2000} | given))
