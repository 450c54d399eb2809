"""What do pins, walls and main bearings carry, and do they add up to the shaking force?"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Literal

import crankpin as cp
import numpy as np
import pytest
from rederivation import bearings, rigid_rod
from rederivation.rigid_rod import SliderCrank
from support import in_turn
from support.engines import CYLINDER, I4

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

RPM = 4500.0
OMEGA = 2.0 * np.pi * RPM / 60.0
THETA = np.arange(0.0, 720.0, 7.3)
RODS = (
    cp.Rod(mass=0.62, inertia=0.0031, length=0.15, to_crankpin=0.045),
    cp.Rod(mass=0.55, inertia=0.0021, length=0.14, to_crankpin=0.05),
    cp.Rod(mass=0.8, inertia=0.0052, length=0.15, to_crankpin=-0.02),  # with a counterweight
)
EACH = [
    cp.Cylinder.from_rod(RODS[k % 2], crank_radius, piston_mass=mass, pin_offset=offset)
    for k, (crank_radius, mass, offset) in enumerate(
        [(0.045, 0.45, 0.0), (0.04, 0.5, 0.002), (0.045, 0.47, -0.003), (0.042, 0.4, 0.0)]
    )
]
"""Pistons, rods and offsets of their own."""
MIXED = cp.Engine.from_lists(
    EACH,
    tdc_deg=[0.0, 90.0, 211.0, 333.3],
    bank_deg=[60.0, 130.0, 60.0, 130.0],
    z=[0.0, 0.024, 0.13, 0.16],
    rotating_mass=[0.9, 0.7, 0.2, 0.8],
    mains=[-0.05, 0.07, 0.22],
)
WEIGHTED = MIXED.with_counterweights(
    [
        cp.Unbalance(0.02, angle_deg=200, z=-0.08),
        cp.Unbalance(0.015, angle_deg=170, z=0.05, pin=2),
        cp.Unbalance(0.01, angle_deg=20, z=0.07),
    ]
).with_shafts(
    [
        cp.Shaft(-1, x=0.1, y=-0.04, unbalances=[cp.Unbalance(0.004, angle_deg=70, z=0.02)]),
        cp.Shaft(2, x=-0.08, y=0.2, unbalances=[cp.Unbalance(0.002, angle_deg=33, z=0.3)]),
    ]
)


CYCLE = cp.Cycle(
    np.arange(0.0, 720.0, 2.0), 1.1e5 + 4e6 * np.exp(8.0 * np.cos(np.deg2rad(np.arange(360.0))) - 8)
)
FIRED = WEIGHTED.replace(
    cylinder=[cylinder.replace(bore=0.08) for cylinder in EACH], firing_order="1-3-2-4"
).with_cycle([CYCLE, CYCLE, None, CYCLE], crankcase=1.2e5)
"""The third cylinder has its valves open."""
FIRING = [0.0, 450.0, 211.0, 693.3]
"""Crank angles of the firing: tops of 1-3-2-4, a turn later where the order is not met else."""


def throws(engine: cp.Engine) -> list[bearings.Throw]:
    """The bodies of an engine whose cylinders have rods."""
    found = []
    for k, cylinder in enumerate(engine.cylinders):
        rod = cylinder.rod
        assert rod is not None
        assert cylinder.piston_mass is not None
        parts = SliderCrank(
            cylinder.crank_radius,
            rod.length,
            cylinder.pin_offset,
            cylinder.piston_mass,
            rod.mass,
            rod.inertia,
            rod.to_crankpin,
        )
        crank_mass = engine.rotating_mass[k] - rod.mass * (1.0 - rod.to_crankpin / rod.length)
        tdc, bank = np.deg2rad(engine.tdc_deg[k]), np.deg2rad(engine.bank_deg[k])
        found.append(bearings.Throw(parts, float(crank_mass), tdc, bank, float(engine.z[k])))
    return found


def as_complex(vectors: ArrayLike) -> np.ndarray:
    x, y = np.moveaxis(np.asarray(vectors), -1, 0)
    return np.asarray(x + 1j * y)


def assert_close(found: ArrayLike, expected: ArrayLike, rtol: float = 1e-12) -> None:
    """Relative to the largest: numpy.linalg.solve and the core round some ten operations each."""
    atol = rtol * np.abs(expected).max()
    assert atol > 0.0
    np.testing.assert_allclose(np.asarray(found), np.asarray(expected), rtol=0.0, atol=atol)


@pytest.mark.parametrize("engine", [MIXED, FIRED], ids=["inertia", "gas"])
@pytest.mark.parametrize("k", range(4))
def test_pins_and_walls_carry_what_newton_and_euler_say(k: int, engine: cp.Engine) -> None:
    loads = cp.bearing_loads(engine, RPM, THETA)
    throw = throws(engine)[k]
    gas = np.zeros(len(THETA))
    if engine is FIRED and k != 2:
        after = THETA - FIRING[k]
        gas = np.pi / 4.0 * 0.08**2 * (CYCLE.pressure_at(after) - 1.2e5)
        assert_close(loads.gas_force[k], gas)
    assert loads.gas_force[k].any() == gas.any()
    expected = bearings.cylinder_forces(throw, OMEGA, np.deg2rad(THETA), gas)
    assert_close(as_complex(loads.crankpin[k]), expected.on_crankpin)
    assert_close(as_complex(loads.wrist_pin[k]), expected.on_wrist_pin)
    assert_close(loads.rod_force[k], expected.along_rod)
    across = -1j * np.exp(1j * throw.bank)
    assert_close(loads.side_thrust[k] * across, expected.on_wall)
    turned = as_complex(loads.turned("crankpin", "rod")[k])
    assert_close(turned, expected.on_crankpin * expected.rod.conj())
    turned = as_complex(loads.turned("wrist_pin", "rod")[k])
    assert_close(turned, expected.on_wrist_pin * expected.rod.conj())
    pin = np.exp(1j * (throw.bank - throw.tdc + np.deg2rad(THETA)))
    assert_close(as_complex(loads.turned("crankpin")[k]), expected.on_crankpin * pin.conj())


def crank_loads(engine: cp.Engine) -> list[tuple[float, np.ndarray]]:
    """Loads (z, force) of the crank, bearings not counted."""
    theta, bodies = np.deg2rad(THETA), throws(engine)
    found = [(t.z, bearings.cylinder_forces(t, OMEGA, theta).on_crankpin) for t in bodies]
    found += [(t.z, t.on_crank(OMEGA, theta)) for t in bodies]
    for weight in engine.counterweights:
        start = np.deg2rad(float(weight.angle_deg))
        if weight.pin is not None:
            start += np.deg2rad(engine.pin_deg[weight.pin - 1])
        found.append((weight.z, weight.amount * OMEGA**2 * np.exp(1j * (theta + start))))
    return found


@pytest.mark.parametrize("engine", [MIXED, WEIGHTED], ids=["plain", "weighted"])
def test_main_bearings_support_each_span_of_the_crank(engine: cp.Engine) -> None:
    loads = cp.bearing_loads(engine, RPM, THETA)
    expected = bearings.main_loads(crank_loads(engine), engine.mains.tolist(), len(THETA))
    assert_close(as_complex(loads.main), expected)
    start = np.exp(-1j * np.deg2rad(engine.pin_deg[0] + THETA))
    assert_close(as_complex(loads.turned("main")), expected * start)


def test_shear_and_bending_are_sums_of_the_loads_in_front() -> None:
    loads = cp.bearing_loads(WEIGHTED, RPM, THETA)
    on_crank = crank_loads(WEIGHTED)
    mains = bearings.main_loads(on_crank, WEIGHTED.mains.tolist(), len(THETA))
    supports = list(zip(WEIGHTED.mains.tolist(), mains, strict=True))
    on_crank += [(z, -force) for z, force in supports]
    theta = np.deg2rad(THETA)
    walls = [(t.z, bearings.cylinder_forces(t, OMEGA, theta).on_wall) for t in throws(WEIGHTED)]
    on_shafts = [
        (u.z, u.amount * (shaft.ratio * OMEGA) ** 2
         * np.exp(1j * (shaft.ratio * theta + np.deg2rad(float(u.angle_deg)))))
        for shaft in WEIGHTED.shafts for u in shaft.unbalances
    ]  # fmt: skip
    for part, forces in (("crank", on_crank), ("crankcase", supports + walls + on_shafts)):
        places = sorted({z for z, _ in on_crank + on_shafts})
        assert loads.z.tolist() == places
        shear = np.array(
            [sum((f for z, f in forces if z <= place), 0.0 * theta) for place in places]
        )
        bending = np.array(
            [bearings.internal_couple(forces, place, len(THETA)) for place in places]
        )
        assert_close(as_complex(loads.shear(part)), shear)
        assert_close(as_complex(loads.bending(part)), bending)


ENGINES = {
    "mixed": MIXED,
    "weighted": WEIGHTED,
    "fired": FIRED,
    "v8": cp.Engine.preset("v8-crossplane"),
    "v6": cp.Engine.preset("v6-60"),
    "boxer": cp.Engine.preset("boxer-4"),
    "w16": cp.Engine.preset("w16"),
}


def wrench(engine: cp.Engine, loads: cp.results.BearingLoads) -> tuple[np.ndarray, ...]:
    """Force, moment about z = 0, and roll torque of all that pushes the engine block."""
    mains, z_mains = as_complex(loads.main), np.array(engine.mains)
    bore = np.exp(1j * np.deg2rad(engine.bank_deg))[:, np.newaxis]
    walls = -1j * bore * loads.side_thrust
    heads = bore * loads.gas_force
    force = mains.sum(axis=0) + (walls + heads).sum(axis=0)
    moment = 1j * (z_mains @ mains + engine.z @ (walls + heads))
    height = np.array([
        cylinder.position(THETA - tdc)
        for cylinder, tdc in zip(engine.cylinders, engine.tdc_deg, strict=True)
    ])  # fmt: skip
    offset = np.array([cylinder.pin_offset for cylinder in engine.cylinders])[:, np.newaxis]
    at = bore * (height + 1j * offset)
    roll = (at.conj() * (walls + heads)).imag.sum(axis=0)
    for shaft in engine.shafts:
        for u in shaft.unbalances:
            angle = np.deg2rad(shaft.ratio * THETA + float(u.angle_deg))
            pushed = u.amount * (shaft.ratio * OMEGA) ** 2 * np.exp(1j * angle)
            force, moment = force + pushed, moment + 1j * u.z * pushed
            roll = roll + (complex(shaft.x, -shaft.y) * pushed).imag
    return force, moment, roll


@pytest.mark.parametrize("name", ENGINES)
def test_all_forces_together_are_those_of_the_waveform(name: str) -> None:
    engine = ENGINES[name].replace(reference_z=0.0)
    loads = cp.bearing_loads(engine, RPM, THETA)
    force, moment, roll = wrench(engine, loads)
    shaken = engine.waveform(RPM, theta_deg=THETA)
    # Rounding of what is added up: the forces of all crankpins, at the length of the engine.
    size = np.abs(loads.crankpin).max() * len(engine)
    length = float(np.ptp(engine.mains))
    np.testing.assert_allclose(force, as_complex(shaken.force), rtol=0, atol=1e-14 * size)
    np.testing.assert_allclose(
        moment, as_complex(shaken.moment), rtol=0, atol=1e-14 * size * length
    )
    np.testing.assert_allclose(roll, shaken.torque, rtol=0, atol=1e-14 * size * 0.2)


def test_gas_loads_every_bearing_and_shakes_nothing() -> None:
    still = FIRED.with_cycle(None).replace(reference_z=0.0)
    fired, unfired = (cp.bearing_loads(engine, RPM, THETA) for engine in (FIRED, still))
    assert (abs(fired.main - unfired.main).max(axis=(1, 2)) > 1e3).all()
    size = np.abs(fired.crankpin).max() * 4.0
    for found, expected in zip(wrench(FIRED, fired)[:2], wrench(still, unfired)[:2], strict=True):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * size)


@pytest.mark.parametrize("name", ["mixed", "fired", "v6"])
def test_crankpins_turn_the_crank_with_its_torque(name: str) -> None:
    engine = ENGINES[name]
    loads = cp.bearing_loads(engine, RPM, THETA)
    radii = np.array([cylinder.crank_radius for cylinder in engine.cylinders])
    torque = radii @ loads.turned("crankpin", "crank")[..., 1]
    assert_close(torque, engine.waveform(RPM, theta_deg=THETA).crank_torque, rtol=1e-13)


def test_the_pressure_of_the_crankcase_loads_nothing() -> None:
    even = FIRED.with_cycle(cp.Cycle(np.arange(0.0, 720.0, 60.0), np.full(12, 9e4)), crankcase=9e4)
    still = cp.bearing_loads(FIRED.with_cycle(None), RPM, THETA)
    loads = cp.bearing_loads(even, RPM, THETA)
    np.testing.assert_allclose(loads.crankpin, still.crankpin, rtol=1e-12)
    # 0.1 Pa of rounding of 9e4 on 50 cm².
    assert np.abs(loads.gas_force).max() < 1e-9


@pytest.mark.parametrize("fuel", ["petrol", "diesel"])
@pytest.mark.parametrize("rpm", [1500.0, 6000.0])
def test_steps_of_a_degree_miss_less_than_a_thousandth_of_a_peak(
    fuel: Literal["petrol", "diesel"], rpm: float
) -> None:
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    fired = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example(fuel))
    coarse, fine = (
        cp.bearing_loads(fired, rpm, np.arange(0.0, 720.0, step)) for step in (1.0, 0.02)
    )
    for load in ("main", "crankpin", "wrist_pin", "side_thrust"):
        missed = 1.0 - coarse.read(load, "peak") / fine.read(load, "peak")
        assert np.all((missed >= 0.0) & (missed < 1e-3))


def test_gas_bends_the_crankcase_between_heads_and_main_bearings() -> None:
    """Gas pushes heads up and, through the crank, bearings down: past all nothing is left."""
    still = FIRED.with_cycle(None)
    fired, unfired = (cp.bearing_loads(engine, RPM, THETA) for engine in (FIRED, still))
    size = np.abs(fired.main).max() * len(FIRED.mains)
    by_gas = fired.shear() - unfired.shear()
    np.testing.assert_allclose(by_gas[-1], 0.0, rtol=0, atol=1e-14 * size)
    # At each place the sum of what pushes in front of it: head, wall, and main bearings.
    z_mains, z_bores = np.array(FIRED.mains), np.array(FIRED.z)
    bore = np.exp(1j * np.deg2rad(FIRED.bank_deg))[:, None]
    on_bores = bore * (fired.gas_force - 1j * (fired.side_thrust - unfired.side_thrust))
    on_mains = as_complex(fired.main) - as_complex(unfired.main)
    for place, found in zip(fired.z, as_complex(by_gas), strict=True):
        expected = on_mains[z_mains <= place].sum(axis=0) + on_bores[z_bores <= place].sum(axis=0)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * size)
    assert np.abs(by_gas).max() > 1e3


def test_khurmi_15_7() -> None:
    """Khurmi, Theory of Machines, example 15.7: slide-bar force 10.97 kN, turning moment 14.491.

    The book's acceleration has two terms, cos θ + λ cos 2θ; the exact one gives 10.96414 kN and
    14.48952 kN·m.
    """
    cylinder = cp.Cylinder(0.3, 1.2, 250.0, bore=0.5)
    theta = np.arange(0.0, 720.0, 60.0)
    single = cp.Engine.inline(cylinder, throws_deg=[0], spacing=1.0, firing_order="1")
    fired = single.with_cycle(cp.Cycle(theta, np.full(12, 0.45e6)), crankcase=0.1e6)
    loads = cp.bearing_loads(fired, 250.0, [60.0])
    sin, cos, ratio = np.sqrt(0.75), 0.5, 0.25
    height = np.sqrt(1.0 / ratio**2 - sin**2)
    square = 0.3 * (250.0 * np.pi / 30.0) ** 2
    exact = cos + (cos**2 - sin**2) / height + (sin * cos) ** 2 / height**3
    printed = {exact: 10.96414e3, cos + ratio * (2.0 * cos**2 - 1.0): 10.96541e3}
    for acceleration, force in printed.items():
        along = 0.35e6 * np.pi / 4.0 * 0.5**2 - 250.0 * square * acceleration
        assert along * sin / height == pytest.approx(force, abs=0.005)  # its last digit
    np.testing.assert_allclose(loads.side_thrust, printed[exact], rtol=5e-7)
    moment = 0.3 * loads.turned("crankpin")[0, 0, 1]
    np.testing.assert_allclose(moment, 14.48952e3, rtol=5e-7)


def test_the_crank_is_in_equilibrium() -> None:
    loads = cp.bearing_loads(WEIGHTED, RPM, THETA)
    size = np.abs(loads.main).max()
    assert np.abs(loads.shear("crank")[-1]).max() < 1e-14 * size
    # Hinges at the main bearings; a counterweight overhangs the front one.
    front, *others = (loads.bending("crank")[loads.z.tolist().index(z)] for z in WEIGHTED.mains)
    assert np.abs(others).max() < 1e-14 * size
    np.testing.assert_allclose(np.hypot(*front.T), 0.03 * 0.02 * OMEGA**2, rtol=1e-13)


# Internal couples at the middle of cranks without rocking moments, of m·r·ω² times the spacing.
MIDDLES = {
    "I4": ([0, 180, 180, 0], 1.0),
    "I6": ([0, 120, 240, 240, 120, 0], np.sqrt(3.0)),
    "cross-plane": ([0, 90, 270, 180], np.sqrt(2.5)),
    "straight-8, 2-4-2": ([0, 180, 90, 270, 270, 90, 180, 0], np.sqrt(2.0)),
}


@pytest.mark.parametrize("name", MIDDLES)
def test_the_middle_carries_the_couple_of_either_half(name: str) -> None:
    throws_deg, expected = MIDDLES[name]
    # Unbalances of the pins only, of 1 N at a spacing of 1 m.
    cylinder = cp.Cylinder(1.0, 4.0, 0.0)
    engine = cp.Engine.inline(cylinder, throws_deg=throws_deg, spacing=1.0, rotating_mass=1.0)
    loads = cp.bearing_loads(engine, 60.0 / (2.0 * np.pi), np.arange(0.0, 360.0, 30.0))
    middle = loads.z.tolist().index(engine.reference_z)
    couple = np.abs(as_complex(loads.bending("crankcase")[middle]))
    np.testing.assert_allclose(couple, expected, rtol=1e-14)


def test_rods_on_one_pin_load_it_together() -> None:
    v_twin = cp.Engine.vee(CYLINDER, bank_angle_deg=90, throws_deg=[0], spacing=0.1)
    loads = cp.bearing_loads(v_twin, RPM, THETA)
    assert v_twin.mains.tolist() == [-0.045, 0.045]
    np.testing.assert_array_equal(loads.shares, [[0.5, 0.5], [0.5, 0.5]])
    halves = loads.crankpin.sum(axis=0) / 2.0
    np.testing.assert_allclose(loads.main[0], halves, rtol=0, atol=1e-15 * np.abs(halves).max())
    np.testing.assert_array_equal(loads.main[0], loads.main[1])


def test_a_load_at_a_bearing_is_its_own_and_one_outside_pulls_the_next() -> None:
    weight = cp.Unbalance(0.02, angle_deg=0, z=I4.reference_z)
    still = I4.replace(cylinder=CYLINDER.replace(reciprocating_mass=0.0))
    force = 0.02 * OMEGA**2
    alone = cp.bearing_loads(still.with_counterweights([weight]), RPM, [0.0]).main[:, 0, 0]
    np.testing.assert_allclose(alone, [0, 0, force, 0, 0], rtol=1e-15)
    nose = cp.Unbalance(0.02, angle_deg=0, z=-0.1)
    outside = cp.bearing_loads(still.with_counterweights([nose]), RPM, [0.0]).main[:, 0, 0]
    np.testing.assert_allclose(outside, [1.5 * force, -0.5 * force, 0, 0, 0], atol=1e-13 * force)


def test_without_a_rod_the_crankpin_has_the_reciprocating_part() -> None:
    single = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1, rotating_mass=0.7)
    loads = cp.bearing_loads(single, RPM, THETA)
    np.testing.assert_allclose(loads.crankpin[0], -loads.wrist_pin[0], rtol=1e-15)
    turning = 0.7 * 0.045 * OMEGA**2 * np.exp(1j * np.deg2rad(single.pin_deg[0] + THETA))
    carried = as_complex(loads.main.sum(axis=0))
    assert_close(carried, as_complex(loads.crankpin[0]) + turning, rtol=1e-15)


@pytest.mark.parametrize("engine", [MIXED, FIRED], ids=["inertia", "gas"])
def test_rods_are_in_tension_where_their_force_says(engine: cp.Engine) -> None:
    loads = cp.bearing_loads(engine, RPM, np.arange(-720.0, 720.0, 0.5))
    for force, ranges in zip(loads.rod_force, loads.tension_deg, strict=True):
        inside = [(low < loads.theta_deg) & (loads.theta_deg < high) for low, high in ranges]
        cycle = (loads.theta_deg >= ranges[0][0]) & (loads.theta_deg < ranges[0][0] + 720.0)
        np.testing.assert_array_equal(np.any(inside, axis=0)[cycle], (force < 0.0)[cycle])


def test_a_yoke_pulls_for_half_a_turn() -> None:
    # A scotch yoke pulls for half a turn about top dead centre, to the last place of its rod ratio.
    yoke = cp.Engine.inline(cp.Cylinder(0.05, 1e12, 0.5), throws_deg=[0], spacing=0.1)
    (ranges,) = cp.bearing_loads(yoke, RPM).tension_deg
    np.testing.assert_allclose(ranges, [(-90.0, 90.0), (270.0, 450.0)], atol=1e-9)


def test_peaks_and_means_are_over_the_crank_angles() -> None:
    # A balanced yoke: the pin's load is m·r·ω² |cos θ|, of mean 2/π.
    cylinder = cp.Cylinder(0.05, 1e9, 0.5)
    yoke = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.1)
    loads = cp.bearing_loads(yoke, RPM)
    force = 0.5 * 0.05 * OMEGA**2
    np.testing.assert_allclose(loads.crankpin.peak, force, rtol=1e-9)
    # Trapezoids of one degree leave (π/180)²/12 of it, and the rod 1e-10.
    np.testing.assert_allclose(loads.crankpin.mean_magnitude, 2.0 / np.pi * force, rtol=3e-5)
    one = cp.bearing_loads(yoke, RPM, [60.0])
    np.testing.assert_allclose(one.main.mean_magnitude, force / 4.0, rtol=1e-9)
    assert cp.bearing_loads(yoke, RPM, []).main.mean_magnitude.tolist() == [0.0, 0.0]
    assert str(cp.bearing_loads(yoke, RPM, []).table)


def test_counterweights_relieve_bearings_and_leave_pins() -> None:
    i4 = cp.Engine.inline(CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, rotating_mass=0.8)
    fitted = cp.counterweights(i4, planes="webs", target="internal", factor=0.5).fitted
    before, after = (cp.bearing_loads(engine, RPM) for engine in (i4, fitted))
    np.testing.assert_array_equal(before.crankpin, after.crankpin)
    # Half the reciprocating and all of the rotating mass is gone from where two throws add up;
    # a bearing between opposite throws has their difference, which is the second order's alone.
    relief = after.main.peak / before.main.peak
    assert (relief[::2] < 0.3).all()
    np.testing.assert_allclose(relief[1::2], 1.0, rtol=1e-12)
    middle = i4.reference_z
    bent = [loads.bending()[loads.z.tolist().index(middle)] for loads in (before, after)]
    assert np.abs(bent[1]).max() < 0.6 * np.abs(bent[0]).max()


def far_counterweight() -> object:
    """A counterweight too far out for any bearing."""
    mains = [-1e-4, 1e-4]
    single = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1).replace(mains=mains)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of z in other units
        weighted = single.with_counterweights([cp.Unbalance(0.01, angle_deg=0, z=300.0)])
    return cp.bearing_loads(weighted, RPM)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (far_counterweight, "mains = [-0.0001, 0.0001]: "),
        (lambda: cp.bearing_loads("I4", RPM), "engine = 'I4': give a crankpin.Engine"),  # type: ignore[arg-type]
        (lambda: cp.bearing_loads(I4, -1.0), "rpm = -1.0: "),
        (lambda: cp.bearing_loads(I4, RPM, [np.nan]), "theta_deg = NaN: "),
        (lambda: cp.bearing_loads(I4, RPM).read("moment"), "quantity = 'moment': "),
        (lambda: cp.bearing_loads(I4, RPM).turned("side_thrust"), "load = 'side_thrust': "),
        (lambda: cp.bearing_loads(I4, RPM).turned(axes="bore"), "axes = 'bore': "),
        (lambda: cp.bearing_loads(I4, RPM).turned("main", "rod"), "axes = 'rod': "),
        (lambda: cp.bearing_loads(I4, RPM).bending("block"), "part = 'block': "),
    ],
)
def test_errors_name_the_argument(call: object, message: str) -> None:
    with pytest.raises(cp.InputError) as error:
        call()  # type: ignore[operator]
    assert str(error.value).startswith(message)


def test_results_are_records_over_named_dimensions() -> None:
    loads = cp.bearing_loads(MIXED, RPM, THETA)
    assert loads == cp.bearing_loads(MIXED, RPM, THETA)
    data = loads.to_xarray()
    assert data.main.sel(main_bearing=2, axis="x").dims == ("theta_deg",)
    np.testing.assert_array_equal(data.side_thrust.sel(cylinder=3), loads.side_thrust[2])
    assert not loads.main.flags.writeable
    assert loads.table["crankpin"].values == tuple(loads.crankpin.peak)
    assert loads.frames["mains"]["mean"].values == tuple(loads.main.mean_magnitude)


@pytest.mark.parametrize("engine", [WEIGHTED, FIRED], ids=["inertia", "gas"])
@in_turn("seed", range(10))
def test_means_do_not_depend_on_the_order_of_angles(seed: int, engine: cp.Engine) -> None:
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-720.0, 1440.0, rng.integers(1, 12))
    angles = rng.permutation(np.append(angles, rng.choice(angles)))  # one of them twice
    rpm = rng.uniform(500.0, 8000.0)
    loads = cp.bearing_loads(engine, rpm, angles)
    ascending = cp.bearing_loads(engine, rpm, np.sort(angles))
    for load in ("crankpin", "wrist_pin", "main", "side_thrust", "rod_force", "gas_force"):
        mean, peak = loads.read(load, "mean_magnitude"), loads.read(load, "peak")
        # A dozen additions of rounding.
        assert np.all((mean >= 0.0) & (mean <= peak * (1.0 + 1e-14)))
        np.testing.assert_allclose(mean, ascending.read(load, "mean_magnitude"), rtol=1e-14)


def test_a_mean_over_angles_out_of_order_is_that_of_the_ascending() -> None:
    mixed, ascending = (
        cp.bearing_loads(FIRED, 3000, angles).main.mean_magnitude
        for angles in ([0, 720, 360, 90], [0, 90, 360, 720])
    )
    np.testing.assert_array_equal(mixed, ascending)


def test_the_independent_rod_has_the_core_s_motion() -> None:
    """The re-derivation's bodies are the engine's."""
    throw = throws(MIXED)[1]
    moving = rigid_rod.motion(throw.parts, np.deg2rad(THETA) - throw.tdc)
    np.testing.assert_allclose(
        moving.piston[0][0], EACH[1].position(THETA - MIXED.tdc_deg[1]), rtol=1e-14
    )


def test_a_main_bearing_whose_loads_cancel_carries_none() -> None:
    # Opposed pistons on shared pins, half a turn apart, on both sides of the middle bearing.
    flat = cp.Engine.preset("flat-4")
    assert not cp.bearing_loads(flat, 5000).main[1].any()
    heavier = [
        each.replace(reciprocating_mass=each.reciprocating_mass * (1 + 1e-12 * (k == 0)))
        for k, each in enumerate(flat.cylinders)
    ]
    assert cp.bearing_loads(flat.replace(cylinder=heavier), 5000).main[1].any()


@in_turn("seed", range(12))
def test_a_mean_does_not_depend_on_the_order_of_angles(seed: int) -> None:
    """And lies between zero and the largest value."""
    random = np.random.default_rng(seed)
    engine = cp.Engine.preset(str(random.choice(["i4", "v6-60", "v8-crossplane"])))
    theta = random.uniform(-720, 1440, int(random.integers(1, 30)))
    theta = np.append(theta, theta[: int(random.integers(0, 2))])
    loads = [cp.bearing_loads(engine, 3000, each) for each in (theta, random.permutation(theta))]
    for name in ("main", "crankpin"):
        mean, other = (each.read(name, "mean_magnitude") for each in loads)
        # Sums of some thirty terms; the sequence of equal angles may differ.
        np.testing.assert_allclose(mean, other, rtol=1e-13)
        largest = loads[0].read(name, "magnitude").max(axis=1)
        assert (mean >= 0.0).all()
        assert (mean <= largest * (1.0 + 1e-13)).all()


# --- extremes over a cycle, at any crank angle ----------------------------------------------------


def spiked(rng: np.random.Generator) -> cp.Cycle:
    """Uneven angles, some of them jumps, and peaks of a fraction of a degree between them."""
    theta = np.sort(rng.uniform(0.0, 719.0, 60))
    theta = np.append(theta, theta[0] + 720.0)
    pressure = 1e5 + 2e6 * rng.uniform(0.0, 1.0, 61) ** 4
    for at in rng.uniform(5.0, 710.0, 4):
        where = int(np.searchsorted(theta, at))
        if theta[where] - theta[where - 1] > 0.3:
            middle = 0.5 * (theta[where] + theta[where - 1])
            base, top = pressure[where - 1], rng.uniform(3e6, 9e6)
            theta = np.insert(theta, where, middle + np.array([-0.08, 0.0, 0.08]))
            pressure = np.insert(pressure, where, [base, top, base])
    for where in rng.integers(5, 50, 2):
        theta = np.insert(theta, where, theta[where])
        pressure = np.insert(pressure, where, rng.uniform(1e5, 3e6))
        theta, pressure = _without_thirds(theta, pressure)
    pressure[-1] = pressure[0]
    return cp.Cycle(theta, pressure)


def _without_thirds(theta: np.ndarray, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    thrice = np.append([False, False], theta[2:] == theta[:-2])
    return theta[~thrice], pressure[~thrice]


def fired_at_random(rng: np.random.Generator) -> tuple[cp.Engine, np.ndarray]:
    """An engine of four different cylinders, and the angles at which pressure bends or jumps."""
    cycles = [spiked(rng), cp.Cycle.example(), None, spiked(rng)]
    rng.shuffle(cycles)  # a list of any items
    engine = FIRED.replace(
        cylinder=[
            each.replace(bore=rng.uniform(0.05, 0.09), crank_radius=rng.uniform(0.02, 0.05))
            for each in EACH
        ],
        tdc_deg=(np.array([0.0, 90.0, 211.0, 333.3]) + rng.uniform(-20.0, 20.0, 4)).tolist(),
        firing_order="1-3-2-4",
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of pressures that no engine has
        engine = engine.with_cycle(cycles, crankcase=1.2e5)
    knots = [
        start + cycle.theta_deg
        for start, cycle in zip(engine.firing_deg, cycles, strict=True)
        if cycle is not None
    ]
    return engine, np.concatenate(knots)


def with_sides(theta: np.ndarray, knots: np.ndarray) -> np.ndarray:
    """Angles of a cycle, and both sides of all knots."""
    knots = knots % 720.0
    return np.unique(np.concatenate([theta, knots - 1e-9, knots, knots + 1e-9]))


@pytest.mark.filterwarnings("ignore:theta_deg. pressure peaks")
@in_turn("seed", range(8))
def test_peaks_of_a_cycle_are_those_of_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    engine, knots = fired_at_random(rng)
    rpm = float(rng.uniform(500.0, 9000.0))
    loads = cp.bearing_loads(engine, rpm)
    grid = with_sides(np.arange(0.0, 720.0, 0.05), knots)
    coarse = cp.bearing_loads(engine, rpm, grid)
    for name in ("crankpin", "wrist_pin", "main", "side_thrust", "rod_force", "gas_force"):
        for row, of_grid in enumerate(coarse.read(name, "magnitude")):
            theta, values, step = grid, of_grid, 0.05
            for _ in range(4):
                near = theta[np.argsort(-values)[:20]]
                closer = (near[:, None] + np.linspace(-step, step, 41)).ravel()
                theta, step = with_sides(closer, knots), step / 20.0
                values = cp.bearing_loads(engine, rpm, theta).read(name, "magnitude")[row]
            # Steps of 3e-7 degrees beside tops 0.16° wide leave 3 (2e-7/0.08)²; sides of jumps are
            # 1e-9 degrees off where slopes are up to 30 times the load per degree.
            assert loads.read(name, "peak")[row] == pytest.approx(values.max(), rel=3e-8, abs=1e-6)
            assert loads.read(name, "peak")[row] >= values.max() * (1.0 - 1e-12) - 1e-6
    least, most = coarse.rod_force.min(axis=1), coarse.rod_force.max(axis=1)
    assert (loads.table["pulled"].values >= np.maximum(-least, 0.0) * (1.0 - 1e-12)).all()
    assert (loads.table["rod compressed"].values >= np.maximum(most, 0.0) * (1.0 - 1e-12)).all()


def test_the_peak_of_a_yoke_is_its_own_at_any_top_dead_centre() -> None:
    force = 0.5 * 0.05 * OMEGA**2
    for tdc in (0.0, 0.5, 33.3):
        yoke = cp.Engine.from_lists(
            [cp.Cylinder(0.05, 1e12, 0.5)], tdc_deg=[tdc], bank_deg=[90.0], z=[0.0], mains=[-1, 1]
        )
        loads = cp.bearing_loads(yoke, RPM)
        # Rounding of some ten operations.
        np.testing.assert_allclose(loads.wrist_pin.peak, force, rtol=1e-13)
        np.testing.assert_allclose(loads.main.peak, force / 2.0, rtol=1e-13)
        assert str(loads.table).splitlines()[0].endswith("largest loads of a cycle")
    given = cp.bearing_loads(yoke, RPM, np.arange(721.0))
    assert given != loads
    np.testing.assert_allclose(given.main.peak, given.main.magnitude.max(axis=1), rtol=0)
    assert str(given.table).splitlines()[0].endswith("largest loads at 721 crank angles")


@pytest.mark.filterwarnings("ignore:theta_deg. pressure peaks")
@in_turn("seed", range(12))
def test_rods_are_in_tension_between_narrow_peaks(seed: int) -> None:
    """Peaks of pressure 0.16° wide push rods that are in tension beside them."""
    rng = np.random.default_rng([7, seed])
    engine, knots = fired_at_random(rng)
    rpm = float(rng.uniform(2000.0, 9000.0))
    loads = cp.bearing_loads(engine, rpm)
    grid = with_sides(np.arange(0.0, 720.0, 0.01), knots)
    forces = cp.bearing_loads(engine, rpm, grid).rod_force
    for force, ranges in zip(forces, loads.tension_deg, strict=True):
        inside = np.zeros(len(grid), bool)
        beside = np.zeros(len(grid), bool)
        for low, high in ranges:
            for turn in (0.0, 720.0):
                inside |= (low + turn < grid) & (grid < high + turn)
                for end in (low + turn, high + turn):
                    beside |= abs(grid - end) < 2e-9  # sides of knots; rounding of the ends
        np.testing.assert_array_equal(inside[~beside], (force < 0.0)[~beside])


@pytest.mark.parametrize("name", ["v8-crossplane", "v6-60", "boxer-4", "radial-9", "i4"])
def test_a_shared_crankpin_carries_all_of_its_rods(name: str) -> None:
    """And a pin of one rod what that carries."""
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    engine = cp.Engine.preset(name, cylinder=cylinder).with_cycle(cp.Cycle.example())
    loads = cp.bearing_loads(engine, 4000)
    numbers = sorted(each for pin in loads.crankpins for each in pin)
    assert numbers == [*range(1, len(engine) + 1)]
    np.testing.assert_allclose(
        loads.whole_crankpin.sum(axis=0), loads.crankpin.sum(axis=0), rtol=1e-12, atol=1e-8
    )
    peaks = loads.whole_crankpin.peak
    fine = cp.bearing_loads(engine, 4000, np.arange(0.0, 720.0, 0.01))
    # Steps of 0.01° beside the peak of a curve, twice.
    np.testing.assert_allclose(peaks, fine.whole_crankpin.peak, rtol=1e-6)
    alone = [k for k, pin in enumerate(loads.crankpins) if len(pin) == 1]
    of_rods = loads.crankpin.peak[[loads.crankpins[k][0] - 1 for k in alone]]
    np.testing.assert_allclose(peaks[alone], of_rods, rtol=1e-6)
    assert ("crankpins" in loads.frames) == (len(alone) < len(loads.crankpins))


@pytest.mark.filterwarnings("ignore:theta_deg. pressure peaks")
@in_turn("seed", range(6))
def test_the_peak_of_a_shared_crankpin_is_that_of_a_fine_grid(seed: int) -> None:
    """Also where narrow peaks of pressure are far from the largest load at whole degrees."""
    rng = np.random.default_rng([11, seed])
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, 0.004, bore=0.086)
    engine = cp.Engine.vee(
        cylinder, bank_angle_deg=90.0, throws_deg=[0.0, 120.0, 240.0], spacing=0.1
    )
    engine = engine.replace(firing_order=engine.firing_orders()[0].order)
    cycles = [spiked(rng), cp.Cycle.example(), None, spiked(rng), spiked(rng), None]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of pressures that no engine has
        engine = engine.with_cycle(cycles)
    rpm = float(rng.uniform(500.0, 4000.0))
    loads = cp.bearing_loads(engine, rpm)
    assert {len(pin) for pin in loads.crankpins} == {2}
    knots = np.concatenate(
        [
            start + cycle.theta_deg
            for start, cycle in zip(engine.firing_deg, cycles, strict=True)
            if cycle is not None
        ]
    )
    theta, step = with_sides(np.arange(0.0, 720.0, 0.02), knots), 0.02
    largest = cp.bearing_loads(engine, rpm, theta).whole_crankpin.peak
    for pin, peak in enumerate(loads.whole_crankpin.peak):
        near, width = theta, step
        for _ in range(4):
            vectors = cp.bearing_loads(engine, rpm, near).whole_crankpin[pin]
            best = near[np.argsort(-np.hypot(*vectors.T))[:20]]
            near = with_sides((best[:, None] + np.linspace(-width, width, 41)).ravel(), knots)
            width /= 20.0
        found = cp.bearing_loads(engine, rpm, near).whole_crankpin.peak[pin]
        # As in the test of each rod's peaks.
        assert peak == pytest.approx(found, rel=3e-8)
        assert peak >= max(found, largest[pin]) * (1.0 - 1e-12)


def test_specific_loads_are_over_width_and_diameter() -> None:
    loads = cp.bearing_loads(I4, 6000)
    expected = loads.main.peak / (0.02 * 0.05)
    np.testing.assert_allclose(loads.specific("main", width=0.02, diameter=0.05), expected)
    widths = [0.02, 0.02, 0.04, 0.02, 0.02]
    of_each = loads.specific("main", width=widths, diameter=0.05)
    np.testing.assert_allclose(of_each[2], expected[2] / 2)
    with pytest.raises(cp.InputError, match="load = 'side_thrust': give"):
        loads.specific("side_thrust", width=0.02, diameter=0.05)
    with pytest.raises(cp.InputError, match=r"width = \[0\.02, 0\.02\]: give metres above"):
        loads.specific("main", width=[0.02, 0.02], diameter=0.05)
    with pytest.raises(cp.InputError, match=r"diameter = 0: give metres above zero"):
        loads.specific("main", width=0.02, diameter=0)
    with pytest.warns(UserWarning, match="diameter = 50 m: was it given in millimetres"):
        loads.specific("main", width=0.02, diameter=50)


@in_turn("seed", range(5))
def test_bearings_of_balance_shafts_carry_their_unbalances(seed: int) -> None:
    """Forces and moments of both bearings are those of the unbalances, which turn together."""
    rng = np.random.default_rng(seed)
    weights = [
        cp.Unbalance(amount, z=place, angle_deg=angle)
        for amount, place, angle in zip(
            rng.uniform(0, 0.01, 3), rng.uniform(-0.1, 0.4, 3), rng.uniform(0, 360, 3), strict=True
        )
    ]
    ratio = int(rng.choice([-2, -1, 1, 2]))
    engine = I4.with_shafts([cp.Shaft(ratio, weights, x=0.1), cp.Shaft(1, [], x=-0.1)])
    front, rear = 0.02, 0.33
    found = cp.bearing_loads(engine, 3000).shaft_bearings([front, rear])
    force = sum(w.amount * np.exp(1j * np.radians(float(w.angle_deg))) for w in weights)
    moment = sum(
        (w.z - front) * w.amount * np.exp(1j * np.radians(float(w.angle_deg))) for w in weights
    )
    behind = moment / (rear - front)
    speed = (ratio * 100 * np.pi) ** 2
    np.testing.assert_allclose(found[0], [abs(force - behind) * speed, abs(behind) * speed])
    assert not found[1].any()
    loads = cp.bearing_loads(engine, 3000)
    ends = loads.main_z.min(), loads.main_z.max()
    table = loads.frames["shafts"]
    np.testing.assert_array_equal(loads.shaft_bearings(), loads.shaft_bearings(ends))
    np.testing.assert_array_equal(
        np.transpose([table["front"].values, table["rear"].values]), loads.shaft_bearings(ends)
    )
    assert table["speed ratio"].values == (ratio, 1)
    assert "shafts" not in cp.bearing_loads(I4, 3000).frames
    assert "Bearings of balance shafts beside" in repr(loads)
    with pytest.raises(cp.InputError, match=r"z = \[0\.1, 0\.1\]: give the places of two"):
        cp.bearing_loads(engine, 3000).shaft_bearings([0.1, 0.1])
