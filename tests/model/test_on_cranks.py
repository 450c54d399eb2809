"""Are engines of several cranks those of their builders, and do facing pistons share a chamber?

Forces of opposed pistons, of cranks against each other and of pistons on one shaft are in closed
form; the work of a chamber is the integral of its pressure over its volume, which NumPy computes.
"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

RADIUS, ROD, MASS, RPM = 0.05, 0.05 / 0.26, 1.3, 2400.0
UNIT = MASS * RADIUS * (2.0 * np.pi * RPM / 60.0) ** 2
CYLINDER = cp.Cylinder(RADIUS, ROD, MASS, bore=0.08)


def opposed(**layout: Any) -> cp.Engine:  # noqa: ANN401
    """Return an engine of opposed pistons, by default of one bore."""
    usual: dict[str, Any] = {"throws_deg": [0], "spacing": 0.15, "distance": 0.9}
    return cp.Engine.opposed_pistons(CYLINDER, **(usual | layout))


def test_force_of_a_lead_is_that_of_the_literature() -> None:
    peaks = opposed(lead_deg=15).balance(RPM, orders=[1, 2]).force
    # 2·aₙ·|sin(n·lead/2)|, a₁ = 1 and a₂ of λ = 0.26 exact.
    assert peaks[1].peak / UNIT == pytest.approx(0.26105238, rel=1e-7)
    assert peaks[2].peak / UNIT == pytest.approx(0.13693545, rel=1e-7)


@pytest.mark.parametrize("ratio", [1, -1])
@in_turn("lead", [0, 1e-9, 7.5, 20, 90, 180])
def test_force_of_any_lead_is_in_closed_form(lead: float, ratio: int) -> None:
    engine = opposed(lead_deg=lead, ratio=ratio)
    amplitudes = cp.slider_crank_harmonics(0.26, (1, 2, 4, 6))
    peaks = engine.balance(RPM, orders=[1, 2, 4, 6]).force.peak / UNIT
    halves = np.radians(np.array([1, 2, 4, 6]) * lead) / 2.0
    # Sines of near-multiples of π are good to an ulp of the angle.
    assert peaks == pytest.approx(2.0 * np.abs(amplitudes * np.sin(halves)), abs=4e-15)
    vanishing = engine.vanishing_orders((1, 2)).force
    assert vanishing.vanishing == ((1, 2) if lead == 0 else (2,) if lead == 180 else ())


def test_cranks_against_each_other_leave_an_upright_force() -> None:
    twin = cp.Engine.u(CYLINDER, throws_deg=[0], spacing=0.1, distance=0.2)
    halved = cp.bob_weight(twin, 0.5).fitted
    peak = halved.balance(RPM, orders=[1]).force.peak_xy[0] / UNIT
    # Two pistons, half of each balanced: 2·(1 − ½) upright, nothing across.
    assert peak == pytest.approx([0.0, 1.0], abs=1e-15)


@pytest.mark.parametrize("ratio", [1, -1])
def test_builders_are_lists(ratio: int) -> None:
    layout: dict[str, Any] = {"throws_deg": [0, 90, 270, 180], "spacing": 0.1}
    one = cp.Engine.inline(CYLINDER, **layout)
    listed = {"u": (90.0, (0.3, 0.0)), "opposed_pistons": (270.0, (0.0, 0.3))}
    for name, (bore, (x, y)) in listed.items():
        lead = {"lead_deg": 30} if name == "opposed_pistons" else {"phase_deg": -30}
        built = getattr(cp.Engine, name)(
            CYLINDER, distance=0.3, ratio=ratio, strokes=4, **layout, **lead
        )
        expected = cp.Engine.from_lists(
            CYLINDER,
            tdc_deg=[*one.tdc_deg, *(one.tdc_deg - 30.0)],
            bank_deg=[90.0] * 4 + [bore] * 4,
            z=[*one.z, *one.z],
            cranks=[(x, y, ratio)],
            crank=[0] * 4 + [1] * 4,
        )
        assert np.array_equal(built.tdc_deg, expected.tdc_deg)
        found, known = (each.balance(RPM, orders=[1, 2, 4]) for each in (built, expected))
        for quantity in ("force", "moment", "torque"):
            assert np.array_equal(getattr(found, quantity), getattr(known, quantity)), quantity


def test_an_engine_on_cranks_keeps_its_hardware() -> None:
    single = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1)
    balanced = cp.bob_weight(single, 0.5).fitted
    twin = cp.Engine.on_cranks(
        [balanced, balanced], cranks=[(0.2, 0, -1)], phase_deg=["45/2"], z=[0.1]
    )
    assert len(twin.counterweights) == 2 * len(balanced.counterweights)
    force = twin.waveform(RPM, theta_deg=[10.0, 77.0]).force
    first = balanced.waveform(RPM, theta_deg=[10.0, 77.0]).force
    # The second one runs backwards, 22.5° later.
    second = balanced.waveform(RPM, theta_deg=[22.5 - 10.0, 22.5 - 77.0]).force
    assert np.asarray(force) == pytest.approx(
        np.asarray(first) + second, rel=1e-12, abs=1e-9 * UNIT
    )


# --- chambers -------------------------------------------------------------------------------------


def gas(**layout: Any) -> cp.Engine:  # noqa: ANN401
    """Return three bores with pressure, two pistons in each."""
    usual: dict[str, Any] = {"throws_deg": [0, 120, 240], "firing_order": "1-3-2"}
    engine = opposed(**usual | layout)
    cycle = cp.Cycle.wiebe(
        CYLINDER, compression_ratio=14, heat=900, start_deg=-8, strokes=engine.strokes
    )
    return engine.with_cycle(cycle)


def test_a_chamber_fires_once_midway_between_its_dead_centres() -> None:
    engine = opposed(throws_deg=[0, 120, 240], lead_deg=20)
    assert engine.chambers == ((1, 4), (2, 5), (3, 6))
    (order,) = engine.firing_orders(strokes=2)
    assert order.firing_order == "1-3-2"
    firing = engine.firing("1-3-2")
    assert firing.intervals_deg == pytest.approx([120.0] * 3)
    assert firing.angles_deg[:3] == pytest.approx([350.0, 230.0, 110.0])
    assert gas(lead_deg=20).firing_deg == pytest.approx([350.0, 230.0, 110.0] * 2)


@in_turn("radius", [RADIUS, 0.035])
@in_turn("lead", [0.0, 16.0, -25.0])
def test_pistons_of_a_chamber_fire_together_where_its_volume_is_least(
    lead: float, radius: float
) -> None:
    engine = gas(lead_deg=lead, upper=CYLINDER.replace(crank_radius=radius))
    angles = engine.firing().angles_deg
    assert np.array_equal(angles[:3], angles[3:])
    assert len(engine.firing().intervals_deg) == 3
    lower, upper = engine.cylinders[0], engine.cylinders[3]

    def room(theta: Any) -> Any:  # noqa: ANN401
        reached = lower.position(theta - engine.tdc_deg[0])
        return -reached - upper.position(theta - engine.tdc_deg[3])

    least = room(angles[0])
    # Next to it the volume grows by 1e-8 of the radius, and nowhere in the turn is it less.
    assert least < room(angles[0] + 0.02)
    assert least < room(angles[0] - 0.02)
    assert least <= room(np.arange(0.0, 360.0, 0.5)).min()
    assert radius == RADIUS or lead == 0.0 or abs(abs(angles[0] - 360.0) - abs(lead) / 2) > 0.5


@in_turn("strokes", [2, 4])
@in_turn("lead", [0.0, 12.0, 40.0, -25.0])
def test_work_of_a_chamber_is_that_of_its_pressure_over_its_volume(
    lead: float, strokes: int
) -> None:
    order = {2: "1-3-2", 4: "1-2-3"}[strokes]
    engine = gas(lead_deg=lead, strokes=strokes, firing_order=order)
    mean = engine.balance(RPM).crank_torque.gas.cycle_mean
    angle = np.linspace(0.0, 180.0 * strokes, 18000 * strokes + 1)
    tdc = engine.tdc_deg[[0, 3]][:, None]
    turned = np.radians(angle - tdc)
    height = RADIUS * np.cos(turned) + np.sqrt(ROD**2 - (RADIUS * np.sin(turned)) ** 2)
    volume = -0.25 * np.pi * 0.08**2 * height.sum(axis=0)
    fires = engine.firing().angles_deg[0]
    assert engine.cycles
    assert engine.cycles[0]
    pressure = engine.cycles[0].pressure_at(angle - fires)
    work = float(((pressure[1:] + pressure[:-1]) / 2.0 * np.diff(volume)).sum())
    # Trapezia of a hundredth of a degree.
    assert mean == pytest.approx(3.0 * work / (np.pi * strokes), rel=1e-6)


def test_gas_of_a_small_lead_tends_to_that_of_none() -> None:
    theta = np.arange(0.0, 360.0, 5.0)
    none = gas(lead_deg=0).waveform(RPM, theta_deg=theta).read("crank_torque.gas")
    for lead in (1e-3, -1e-6, 1e-9, 1e-12):
        torque = gas(lead_deg=lead).waveform(RPM, theta_deg=theta).read("crank_torque.gas")
        # Pressure rises by a fiftieth of its peak in a degree.
        change = np.abs(torque - none).max() / np.abs(none).max()
        assert change < 0.1 * abs(lead) + 1e-12
        assert gas(lead_deg=lead).firing_deg[0] % 360.0 == pytest.approx(
            -lead / 2 % 360.0, abs=1e-13
        )


def test_torques_of_both_cranks_are_those_of_the_whole_engine() -> None:
    engine = gas(lead_deg=16)
    theta = np.arange(0.0, 360.0, 7.0)
    torque = engine.waveform(RPM, theta_deg=theta).crank_torque
    loads = cp.bearing_loads(engine, RPM, theta)
    pins = RADIUS * np.exp(1j * np.radians(engine.pin_deg[:, None] + theta))
    force = np.asarray(loads.crankpin)
    turning = (np.conj(pins) * (force[..., 0] + 1j * force[..., 1])).imag.sum(axis=0)
    assert np.asarray(torque) == pytest.approx(turning, rel=1e-9, abs=1e-6)


def test_rods_are_swept_where_they_leave_chambers_as_they_are() -> None:
    engine = gas(lead_deg=16)
    orders = [1, 2, 3, 6]
    swept = cp.sweep(engine, rpm=RPM, rod_ratio=[0.2, 0.4], orders=orders).crank_torque
    for k, ratio in enumerate((0.2, 0.4)):
        there = engine.replace(cylinder=CYLINDER.replace(rod_length=RADIUS / ratio))
        expected = there.balance(RPM, orders=orders).crank_torque
        # The rod's length is good to an ulp, and the ratio that is made of it.
        assert np.asarray(swept)[k] == pytest.approx(np.asarray(expected), rel=1e-12, abs=1e-9)
    unlike = gas(lead_deg=16, upper=CYLINDER.replace(crank_radius=0.04))
    hint = "the chamber that cylinders 1 and 4 share is smallest elsewhere at each"
    with pytest.raises(cp.InputError, match=rf"^rod_ratio = swept: {hint}"):
        cp.sweep(unlike, rpm=RPM, rod_ratio=[0.2, 0.4])
    with pytest.raises(cp.InputError, match=rf"^pin_offset = swept: {hint}"):
        cp.sweep(engine, rpm=RPM, pin_offset=[0.0, 0.001])
    # Yokes on one crankshaft have the chamber smallest midway, rods elsewhere.
    yokes = doxford(20.0, crank_radius=1.0, rod_length=np.inf)
    yokes = yokes.replace(cylinder=[one.replace(rod_length=np.inf) for one in yokes.cylinders])
    cycle = cp.Cycle.example("diesel", strokes=2)
    assert yokes.with_cycle(cycle).firing_deg == pytest.approx([350.0, 350.0])
    with pytest.raises(cp.InputError, match=r"^rod_ratio = swept: the chamber"):
        cp.sweep(yokes.with_cycle(cycle), rpm=RPM, rod_ratio=[0.1, 0.2])
    level = doxford().with_cycle(cycle)
    cp.sweep(level, rpm=UNIT_RPM, rod_ratio=[0.1, 0.2])
    # Without pressure nothing fires.
    cp.sweep(unlike.with_cycle(None), rpm=RPM, rod_ratio=[0.2, 0.4], pin_offset=[0.0, 0.001])


def test_what_has_no_meaning_is_rejected_by_name() -> None:
    engine = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1)
    changes: list[tuple[dict[str, Any], str]] = [
        ({"cranks": []}, "cranks"),
        ({"cranks": [(0.2, 0, 0)]}, r"cranks\[1\].ratio"),
        ({"phase_deg": [1, 2]}, "phase_deg"),
        ({"z": [0.1, 0.2]}, "z"),
        ({"hold": "nothing"}, "hold"),
        ({"engines": [engine, 3]}, "engines"),
        ({"engines": []}, "engines"),
    ]
    for change, argument in changes:
        arguments: dict[str, Any] = {"engines": [engine, engine], "cranks": [(0.2, 0, -1)]}
        with pytest.raises(cp.InputError, match=rf"^{argument}"):
            cp.Engine.on_cranks(**(arguments | change))
    with pytest.raises(cp.InputError, match=r"^ratio = 2: give 1, or -1"):
        opposed(ratio=2)
    with pytest.raises(cp.InputError, match=r"^distance = 0"):
        opposed(distance=0.0)
    for lead in (120, -120):
        with pytest.raises(cp.InputError, match="at most 90° apart; these are 120°"):
            gas(lead_deg=lead)


# --- one crankshaft, and throws opposite each other ---


def doxford(lead_deg: Any = 0, **upper: float) -> cp.Engine:  # noqa: ANN401
    """Return one bore on one crankshaft, whose pistons have equal mass times radius."""
    lower = cp.Cylinder(1.0, 1 / 0.12, 1.0, bore=0.5)
    usual: dict[str, Any] = {"crank_radius": 1.0, "rod_length": 1 / 0.28, "reciprocating_mass": 1.0}
    return cp.Engine.opposed_pistons(
        lower, upper=cp.Cylinder(**usual | {"bore": 0.5} | upper), throws_deg=[0], spacing=0.1,
        lead_deg=lead_deg, one_crankshaft=True,
    )  # fmt: skip


UNIT_RPM = 60.0 / (2.0 * np.pi)


def largest(engine: cp.Engine, order: int, rpm: float = UNIT_RPM) -> float:
    """Return the longest force of an order, N."""
    return float(engine.balance(rpm, orders=[order])[order].force.peak)


def test_pistons_on_one_crankshaft_cancel_in_order_1_and_add_in_order_2() -> None:
    balance = doxford().balance(UNIT_RPM, orders=[1, 2])
    assert balance[1].force.status == "zero, proved"
    assert balance[2].force.peak == pytest.approx(0.40613435, abs=5e-9)  # P78
    # Where mass times radius is equal, not the masses.
    heavier = doxford(crank_radius=0.5, rod_length=0.5 / 0.28, reciprocating_mass=2.0)
    assert largest(heavier, 1) < 1e-15
    assert largest(doxford(crank_radius=0.5, rod_length=0.5 / 0.28), 1) == pytest.approx(0.5)


def test_a_lead_breaks_order_1_and_the_chamber_fires_once() -> None:
    engine = doxford("360/31")
    assert largest(engine, 1) == pytest.approx(2 * np.sin(np.pi / 31))
    assert engine.chambers == ((1, 2),)
    assert engine._core.exact_angles[0] == ["0", "5220/31"]
    assert cp.Engine.from_toml(engine.to_toml()) == engine
    usual: dict[str, Any] = {"upper": CYLINDER, "throws_deg": [0], "spacing": 0.1}
    for options, words in (
        ({"distance": 1.0}, "neither distance"),
        ({"upper": None}, "side rods"),
        ({"one_crankshaft": False}, "^distance"),
    ):
        with pytest.raises(cp.InputError, match=words):
            cp.Engine.opposed_pistons(CYLINDER, **{"one_crankshaft": True} | usual | options)


def test_both_pistons_of_a_chamber_do_its_work_on_one_crank() -> None:
    bare = doxford(20.0)
    cycle = cp.Cycle.example("diesel", strokes=2)
    fired = bare.with_cycle(cycle)
    torque = fired.balance(100, orders=[1]).crank_torque.cycle_mean
    # ∮ p dV by the trapezoidal rule, from where the chamber is smallest.
    theta = np.linspace(0.0, 360.0, 7201)
    lower, upper = bare.cylinders
    crank = theta + fired.firing_deg[0]
    volume = np.pi / 4 * 0.5**2 * (upper.position(crank - bare.tdc_deg[1]) - lower.position(crank))
    assert volume.argmin() in (0, 7200)
    # Chords of pressure and volume over 0.05° are good to a few parts in 10⁵.
    work = np.trapezoid(cycle.pressure_at(theta), volume)
    assert torque == pytest.approx(work / (2 * np.pi), rel=1e-4)


@in_turn(
    ("one_crankshaft", "change"),
    [(False, {"bore": 0.06}), (True, {}), (True, {"bore": 0.06}), (True, {"crank_radius": 0.04})],
)
def test_the_least_volume_is_that_of_areas_faces_and_rods(
    one_crankshaft: bool, change: dict[str, float]
) -> None:
    upper = CYLINDER.replace(**change)
    layout: dict[str, Any] = {"upper": upper, "lead_deg": 30, "strokes": 2}
    layout |= {"one_crankshaft": True, "distance": None} if one_crankshaft else {}
    engine = opposed(**layout).with_cycle(cp.Cycle.example("diesel", strokes=2))

    def room(theta: Any) -> Any:  # noqa: ANN401
        lower = CYLINDER.position(theta - engine.tdc_deg[0]) * 0.08**2
        above = upper.position(theta - engine.tdc_deg[1]) * (change.get("bore", 0.08) ** 2)
        return -lower + (above if one_crankshaft else -above)

    fires = engine.firing_deg[0]
    # Next to it the volume grows by 1e-8 of the stroke's.
    assert room(fires) < min(room(fires + 0.02), room(fires - 0.02))
    assert room(fires) <= room(np.arange(0.0, 360.0, 0.5)).min()


def test_an_offset_moves_the_chamber_of_a_piston_on_side_rods() -> None:
    part = CYLINDER.replace(side_rods=True)
    alone = cp.Engine.inline(part, throws_deg=[0], spacing=0.1, strokes=2)
    fired = alone.with_cycle(cp.Cycle.example("diesel", strokes=2))
    with pytest.raises(cp.InputError, match=r"^pin_offset = swept: the chamber at the crank end"):
        cp.sweep(fired, rpm=RPM, pin_offset=[0.0, 0.001])
    cp.sweep(fired, rpm=RPM, rod_ratio=[0.2, 0.3])


def test_unlike_masses_on_opposed_throws_make_a_force() -> None:
    cylinders = [cp.Cylinder(0.125, 0.625, mass) for mass in (200.0, 180.0)]
    pair = cp.Engine.opposed_throws(cylinders, throws_deg=[0, 180], spacing=0.32)
    first = pair.balance(600)[1]
    assert first.force.peak == pytest.approx(9869.6044, abs=5e-5)  # P96
    assert first.moment.peak == pytest.approx(30003.597, abs=5e-4)  # P97
    assert first.force.peak_xy[1] == 0.0  # along the throws alone
    crossheads = cp.Engine.opposed_throws(
        [one.replace(reciprocating_mass=100.0) for one in cylinders],
        throws_deg=[0, 180], spacing=0.32, crosshead_mass=[100.0, 80.0],
    )  # fmt: skip
    assert crossheads == pair
    for mass in ([1.0], -1.0):
        with pytest.raises(cp.InputError, match=r"^crosshead_mass"):
            cp.Engine.opposed_throws(
                cylinders, throws_deg=[0, 180], spacing=0.32, crosshead_mass=mass
            )


def test_masses_apart_by_a_rounding_leave_their_difference() -> None:
    apart = 180.0 * (1.0 + 1e-12)
    cylinders = [cp.Cylinder(0.125, 0.625, mass) for mass in (180.0, apart)]
    pair = cp.Engine.opposed_throws(cylinders, throws_deg=[0, 180], spacing=0.32)
    expected = (apart - 180.0) * 0.125 * (20 * np.pi) ** 2
    # Opposite throws have phasors 1 and −1: masses are subtracted without rounding.
    assert largest(pair, 1, 600.0) == pytest.approx(expected, rel=1e-14)
    assert largest(pair, 1, 600.0) > 0.0
    equal = cp.Engine.opposed_throws(cylinders[:1] * 2, throws_deg=[0, 180], spacing=0.32)
    assert equal.balance(600.0, orders=[1])[1].force.status == "zero, proved"
