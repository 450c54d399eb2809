"""Do fitted balance shafts remove what they should, and nothing else?

Figures are those of ``balancing-and-torque.md``, recomputed from first principles.
"""

from __future__ import annotations

import copy
import itertools
import pickle
import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import Shaft, Unbalance
from crankpin._support.record import changed
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import balance_shafts as rederived
from rederivation import rotors, time_domain
from support import html_of, in_turn
from support.engines import CYLINDER, I4

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.filterwarnings("ignore:the roll torque is not cancelled")
RPM = 600.0
OMEGA = 2 * np.pi * RPM / 60
MR = CYLINDER.reciprocating_mass * CYLINDER.crank_radius
A2 = float(CYLINDER.harmonics([2])[0].real)
"""Second-order harmonic of the piston's acceleration over r·ω²."""

# Sums of some tens of terms, each rounded a few times to 1.1e-16.
ROUNDING = 1e-13
# Differentiating 256 samples twice lifts rounding by up to 128².
SAMPLED = 1e-11

BORE = 2 * CYLINDER.crank_radius
FIRED = I4.replace(cylinder=CYLINDER.replace(bore=BORE), firing_order="1-3-4-2").with_cycle(
    cp.Cycle.example()
)
I3 = cp.Engine.inline(CYLINDER, throws_deg=[0, 240, 120], spacing=1.0)
SINGLE = cp.Engine.inline(CYLINDER, throws_deg=[0], spacing=0.1)
V6_90 = cp.Engine.vee(
    CYLINDER, bank_angle_deg=90, throws_deg=[0, 120, 240], pin_split_deg=-30, spacing=1.0
)
V6_60 = cp.Engine.vee(
    CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], pin_split_deg=-60, spacing=1.0
)
HEAVIER = I4.replace(
    cylinder=[CYLINDER, CYLINDER.replace(reciprocating_mass=0.53), CYLINDER, CYLINDER]
)
FORK_AND_BLADE = cp.Engine.vee(
    CYLINDER, bank_angle_deg=45, throws_deg=[0, 90, 270, 180], spacing=0.1, bank_stagger=0.02
)
UNLIKE = {
    "vr6": cp.Engine.preset("vr6"),
    "w12": cp.Engine.preset("w12"),
    "fork and blade": FORK_AND_BLADE,
    "staggered twin": cp.Engine.vee(
        CYLINDER, bank_angle_deg=45, throws_deg=[0], spacing=0.1, bank_stagger=0.03
    ),
    "one heavier piston": HEAVIER,
    "pin offset": I4.replace(cylinder=CYLINDER.replace(pin_offset=0.002)),
}


def bob_weights(engine: cp.Engine, part: float = 0.5) -> list[Unbalance]:
    """A part of each reciprocating mass opposite its crankpin."""
    return [
        Unbalance(part * c.reciprocating_mass * c.crank_radius, float(z), 180, pin=number)
        for number, (c, z) in enumerate(zip(engine.cylinders, engine.z, strict=True), start=1)
    ]


def halved(engine: cp.Engine) -> cp.Engine:
    """The engine with half of each reciprocating mass as bob weight."""
    return engine.with_counterweights(bob_weights(engine))


def turned(vector: complex, degrees: float) -> complex:
    return complex(vector * np.exp(1j * np.deg2rad(degrees)))


def vector(weight: Unbalance) -> complex:
    return turned(weight.amount, float(weight.angle_deg))


def rotors_of(shaft: Shaft) -> list[rotors.Rotor]:
    """The unbalances of a shaft, each as a mass at 0.1 m from its axis."""
    axis = complex(shaft.x, shaft.y)
    return [
        rotors.Rotor(w.amount / 0.1, 0.1, float(w.angle_deg), w.z, shaft.ratio, axis)
        for w in shaft.unbalances
    ]


def sampled(
    engine: cp.Engine, plane: float | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Force, moment and roll torque of the pistons at 256 crank angles, in plain NumPy."""
    parts, theta = engine.cylinders, time_domain.crank_angles(256)
    lists = time_domain.EngineLists(
        crank_radius=[c.crank_radius for c in parts],
        rod_length=[c.rod_length for c in parts],
        reciprocating_mass=[c.reciprocating_mass for c in parts],
        pin_offset=[c.pin_offset for c in parts],
        tdc_deg=engine.tdc_deg,
        bank_deg=engine.bank_deg,
        z=engine.z,
        rotating_mass=engine.rotating_mass,
    )
    return (
        time_domain.force(lists, RPM, theta),
        time_domain.moment(lists, RPM, theta, plane),
        time_domain.roll_torque(lists, RPM, theta),
    )


def turning(engine: cp.Engine, ratio: int, quantity: str) -> complex:
    """What turns with a shaft of this ratio: of force or moment, N or N·m."""
    found = getattr(engine.balance(RPM, orders=[abs(ratio)])[abs(ratio)], quantity)
    return complex(found.forward if ratio > 0 else found.backward)


# --- figures --------------------------------------------------------------------------------------


def test_lanchester_pair_at_equal_height_leaves_the_roll_torque() -> None:
    fit = cp.balance_shafts(I4, [2, -2], x=[0.08, -0.08], y=0.05)
    before, after = (e.balance(RPM, orders=[2])[2] for e in (I4, fit.fitted))
    assert after.force.peak == 0.0
    assert after.moment.peak == 0.0
    assert after.torque.peak == pytest.approx(before.torque.peak, rel=ROUNDING)
    # U = m·r·a₂/2 each, at the middle, straight down at top dead centre.
    for each in fit:
        (weight,) = each.unbalances
        assert weight.amount == pytest.approx(MR * A2 / 2, rel=ROUNDING)
        assert (weight.z, weight.angle_deg) == (I4.reference_z, 270.0)
        assert each.y == 0.05
    assert not fit.exerted_moment.any()
    assert abs(fit.exerted_force) == pytest.approx(2 * MR * A2, rel=ROUNDING)


def test_lanchester_pair_at_the_right_heights_cancels_the_roll_torque() -> None:
    _, _, torque = sampled(I4)
    b2 = time_domain.peak_phasors(torque, [2])[0] / (4 * MR * CYLINDER.crank_radius * OMEGA**2)
    height = 2 * abs(b2) * CYLINDER.crank_radius / A2
    assert 0.9 * CYLINDER.rod_length < height < CYLINDER.rod_length
    fit = cp.balance_shafts(I4, [2, -2], x=[0.08, -0.08])
    a, b = fit
    assert a.y - b.y == pytest.approx(height, rel=1e-9)
    pair = {"difference": pytest.approx(height, rel=1e-9), "right_sum": 0.0, "up_deg": 90.0}
    assert fit.heights == {2: pair}
    before, after = (e.balance(RPM, orders=[2])[2] for e in (I4, fit.fitted))
    assert after.force.peak == 0.0
    assert after.torque.peak <= ROUNDING * before.torque.peak
    exchanged = cp.balance_shafts(I4, [2, -2], x=[0.08, -0.08], y=[b.y, a.y])
    doubled = exchanged.fitted.balance(RPM, orders=[2])[2]
    assert doubled.force.peak == 0.0
    assert doubled.torque.peak == pytest.approx(2 * before.torque.peak, rel=ROUNDING)


def test_free_coordinates_make_up_for_those_given() -> None:
    fit = cp.balance_shafts(I4, [2, -2], x=[0.2, None], y=[0.3, None])
    a, b = fit
    pair = fit.heights[2]
    assert (a.x, a.y) == (0.2, 0.3)
    assert b.x == pytest.approx(-0.2, rel=1e-12)
    assert a.y - b.y == pytest.approx(pair["difference"], rel=1e-12)
    before, after = (e.balance(RPM, orders=[2])[2] for e in (I4, fit.fitted))
    assert after.torque.peak <= 10 * ROUNDING * before.torque.peak


def test_heights_with_gas_torque() -> None:
    """Δy = M_s/(F₂/2) and x_A + x_B = M_c/(F₂/2), of the torque of pressure by quadrature."""
    rpm = 3000.0
    fit = cp.balance_shafts(FIRED, [-2, 2], rpm=rpm)
    over = (2 * np.pi * rpm / 60) ** 2
    theta = np.radians(np.arange(0.25, 720.0, 0.5))
    gas = np.zeros(theta.shape)
    for phase in (0.0, 540.0, 180.0, 360.0):  # of 1-3-4-2
        at = theta - np.radians(phase)
        r, rod = CYLINDER.crank_radius, CYLINDER.rod_length
        height = np.sqrt(rod**2 - (r * np.sin(at)) ** 2)
        down = r * np.sin(at) * (1 + r * np.cos(at) / height)
        pressure = cp.Cycle.example().pressure_at(np.degrees(at)) - 101_325.0
        gas -= pressure * np.pi * BORE**2 / 4 * down
    inertia = rederived.sine_and_cosine(sampled(I4)[2] / OMEGA**2, 2)
    of_gas = [2 * np.mean(gas * part(2 * theta)) / over for part in (np.sin, np.cos)]
    sine, cosine = np.add(inertia, of_gas)
    half = 2 * MR * A2
    pair = fit.heights[2]
    # The midpoint rule at half degrees: pressure bends at the ends of the burn, (h²/24)·Δp″.
    assert pair["difference"] == pytest.approx(sine / half, rel=1e-6)
    assert pair["right_sum"] == pytest.approx(cosine / half, rel=1e-5)
    against, along = fit
    assert along.y - against.y == pytest.approx(pair["difference"], rel=1e-9)
    assert along.x + against.x == pytest.approx(pair["right_sum"], rel=1e-9)
    left = fit.fitted.balance(rpm, orders=[2])[2].torque
    assert left.peak < 1e-10 * left.gas.peak
    assert fit.residual[2].torque.peak == left.peak
    after = {each.quantity: each for each in fit.parts()}["torque"]
    assert after.after * over == pytest.approx(left.peak)
    assert "at 3000 rpm" in repr(fit)
    elsewhere = fit.fitted.balance(2 * rpm, orders=[2])[2].torque
    assert elsewhere.peak == pytest.approx(3 * left.gas.peak, rel=1e-9)


def test_a_fired_engine_needs_the_speed() -> None:
    with pytest.raises(cp.InputError, match=r"^rpm = None: the torque of gas"):
        cp.balance_shafts(FIRED, [-2, 2])
    for engine in (FIRED, I4):
        with pytest.raises(cp.InputError, match=r"^rpm = 0.0: shafts make no force at rest"):
            cp.balance_shafts(engine, [-2, 2], rpm=0)
    options = cp.balancer_options(I4, rpm=RPM, shaft_orders=2)
    assert options[-1].shafts[0].y == cp.balance_shafts(I4, [-2, 2])[0].y


def test_one_shaft_removes_the_backward_couple_of_an_inline_3() -> None:
    fit = cp.balance_shafts(I3, -1)
    assert turning(fit.fitted, -1, "moment") == 0.0
    assert turning(fit.fitted, 1, "moment") == turning(I3, 1, "moment")
    both = cp.balance_shafts(halved(I3), -1).fitted.balance(RPM, orders=[1])[1]
    assert both.moment.peak <= ROUNDING * MR * OMEGA**2
    assert both.force.peak <= ROUNDING * MR * OMEGA**2
    front, rear = fit[0].unbalances
    # |Σ z e^{i·tdc}| = √3 spacings, half of it backward; two opposite unbalances 2 spacings apart.
    for each in (front, rear):
        assert each.amount == pytest.approx(MR * np.sqrt(3) / 2 / 2, rel=ROUNDING)
    assert abs(float(front.angle_deg) - float(rear.angle_deg)) == 180.0
    assert fit.exerted_force[0] == 0.0


def test_even_firing_90_degree_v6_takes_counterweights_and_one_shaft() -> None:
    size = MR * OMEGA**2
    assert abs(turning(V6_90, 1, "moment")) / size == pytest.approx(1.673033, abs=1e-6)
    assert abs(turning(V6_90, -1, "moment")) / size == pytest.approx(0.448288, abs=1e-6)
    fit = cp.balance_shafts(halved(V6_90), -1)
    assert abs(fit.exerted_moment[0]) / MR == pytest.approx(0.448288, abs=1e-6)
    after = fit.fitted.balance(RPM, orders=[1])[1]
    assert max(after.force.peak, after.moment.peak) <= ROUNDING * size


def test_even_firing_60_degree_v6_takes_counterweights_and_one_shaft_at_twice_the_speed() -> None:
    size = MR * OMEGA**2
    assert abs(turning(V6_60, 1, "moment")) / size == pytest.approx(1.5, rel=ROUNDING)
    assert abs(turning(V6_60, -2, "moment")) / size == pytest.approx(1.5 * A2, rel=ROUNDING)
    fit = cp.balance_shafts(halved(V6_60), [-1, -2])
    assert fit[0].unbalances == ()
    assert (fit.exerted_force[0], fit.exerted_moment[0]) == (0.0, 0.0)
    assert abs(fit.exerted_moment[1]) / MR == pytest.approx(1.5 * A2, rel=ROUNDING)
    after = cp.balance_shafts(halved(V6_60), -2).fitted.balance(RPM, orders=[1, 2])
    assert max(after.total.force.peak, after.total.moment.peak) <= ROUNDING * size


@pytest.mark.parametrize(
    ("times", "first", "second"), [(1, 0.449028, 4.979797), (2, 4.979797, 0.449028)]
)
def test_couples_of_both_inline_5_cranks(times: int, first: float, second: float) -> None:
    throws = [float(times * each % 360) for each in (0, 216, 144, 72, 288)]
    i5 = cp.Engine.inline(CYLINDER, throws_deg=throws, spacing=1.0)
    before = i5.balance(RPM, orders=[1, 2])
    size = MR * OMEGA**2
    np.testing.assert_allclose(before.moment.peak / size, [first, second * A2], atol=1e-6)
    # Upright cylinders: as much forward as backward.
    fit = cp.balance_shafts(halved(i5), [-1, 2, -2])
    expected = [first / 2, second * A2 / 2, second * A2 / 2]
    np.testing.assert_allclose(abs(fit.exerted_moment) / MR, expected, atol=1e-6)
    after = fit.fitted.balance(RPM, orders=[1, 2]).total
    assert max(after.force.peak, after.moment.peak) <= 10 * ROUNDING * size


def test_90_degree_v_twin_at_half_needs_no_shaft_at_order_1() -> None:
    twin = cp.Engine.vee(CYLINDER, bank_angle_deg=90, throws_deg=[0], spacing=0.1)
    fit = cp.balance_shafts(halved(twin), -1)
    assert fit.unbalance == 0.0
    assert fit.fitted.balance(RPM, orders=[1])[1].force.peak <= ROUNDING * MR * OMEGA**2


def test_single_at_half_with_one_shaft_is_free_of_first_order_force() -> None:
    fit = cp.balance_shafts(halved(SINGLE), -1, x=0.0, y=0.0)
    (weight,) = fit[0].unbalances
    assert weight == Unbalance(MR / 2, 0.0, 270.0)
    assert fit.fitted.balance(RPM, orders=[1])[1].force.peak == 0.0
    verdicts = fit.fitted.vanishing_orders([1])
    assert [part[1] for _, part in verdicts.force.parts] == ["vanishes"] * 4


def test_shaft_beside_the_crank_leaves_a_rolling_couple() -> None:
    engine, offset = halved(SINGLE), 0.12
    at_the_crank = cp.balance_shafts(engine, -1, x=0.0, y=0.0).fitted.balance(RPM, orders=[1])[1]
    beside = cp.balance_shafts(engine, -1, x=offset, y=0.0)
    after = beside.fitted.balance(RPM, orders=[1])[1]
    assert after.force.peak == 0.0
    rolling = complex(after.torque.phasor) - complex(at_the_crank.torque.phasor)
    # x·F_y with the shaft's force MR/2·ω², straight down at θ = 0.
    assert rolling == pytest.approx(-MR / 2 * OMEGA**2 * offset, rel=1e-12)
    # Two shafts, one to each side, share the force and leave none.
    pair = cp.balance_shafts(engine, [-1, -1], x=[offset, -offset], y=0.0)
    amounts = [w.amount for each in pair for w in each.unbalances]
    assert amounts == pytest.approx([MR / 4] * 2, rel=ROUNDING)
    assert pair.fitted.balance(RPM, orders=[1])[1].torque.peak == pytest.approx(
        at_the_crank.torque.peak, rel=1e-9
    )


def test_free_place_of_one_shaft_cancels_the_roll_torque_of_its_order() -> None:
    engine = halved(SINGLE)
    fit = cp.balance_shafts(engine, -1)
    before, after = (e.balance(RPM, orders=[1])[1].torque.peak for e in (engine, fit.fitted))
    assert before > 0.0
    assert after <= ROUNDING * MR * OMEGA**2
    # With x given, height alone cannot: what is closest stays.
    best = cp.balance_shafts(engine, -1, x=0.1)
    heights = best[0].y + np.array([-0.01, 0.0, 0.01])
    low, least, high = (
        cp.balance_shafts(engine, -1, x=0.1, y=y).fitted.balance(RPM, orders=[1])[1].torque.peak
        for y in heights.tolist()
    )
    assert least < min(low, high)


# --- any engine -----------------------------------------------------------------------------------

RATIOS = (1, -1, 2, -2, 4, -4)


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
@pytest.mark.parametrize("name", UNLIKE)
def test_unlike_cylinders(name: str) -> None:
    """Unbalances by the lever rule from sampled waveforms; with them as masses nothing is left."""
    engine = UNLIKE[name]
    planes = (float(engine.z.min()) - 0.05, float(engine.z.max()) + 0.1)
    fit = cp.balance_shafts(engine, RATIOS, planes=planes, x=[0.1] * 6, y=-0.05)
    force, moment, torque = sampled(engine)
    size = sum(c.reciprocating_mass * c.crank_radius for c in engine.cylinders) * OMEGA**2
    for each in fit:
        ratio = each.ratio
        turn = [rederived.turning(samples, ratio) for samples in (force, moment)]
        wanted = rederived.in_two_planes(
            turn[0], turn[1], ratio * OMEGA, planes, engine.reference_z
        )
        found = {weight.z: vector(weight) for weight in each.unbalances}
        for z, expected in zip(planes, wanted, strict=True):
            assert abs(found.get(z, 0.0) - expected) * OMEGA**2 < SAMPLED * size
    parts = [rotors.wrench(rotors_of(each), RPM, engine.reference_z) for each in fit]
    for samples, k, scale in ((force, 0, size), (moment, 1, size)):
        left = samples + sum(part[k] for part in parts)
        for ratio in RATIOS:
            assert abs(rederived.turning(left, ratio)) < SAMPLED * scale
    # The roll torque that the places make is in what stays.
    roll = time_domain.peak_phasors(torque + sum(part[2] for part in parts), [1, 2, 4])
    after = fit.fitted.balance(RPM, orders=[1, 2, 4])
    np.testing.assert_allclose(np.asarray(after.torque), roll, rtol=0, atol=SAMPLED * size)
    assert abs(after.force.xy).max() <= ROUNDING * size
    assert abs(after.moment.xy).max() <= ROUNDING * size


@pytest.mark.parametrize("bearings", [(0.0, 0.3), (0.1, 0.15)])
def test_bearing_loads(bearings: tuple[float, float]) -> None:
    fit = cp.balance_shafts(HEAVIER, [-1, 2], planes=(0.05, 0.35), bearings=bearings)
    for k, each in enumerate(fit):
        expected = rederived.bearing_loads(rotors_of(each), RPM, bearings)
        loads = fit.bearing_loads(RPM)[k]
        theta = time_domain.crank_angles(256)
        turning_loads = loads * np.exp(1j * each.ratio * theta)[:, np.newaxis]
        np.testing.assert_allclose(turning_loads, expected, rtol=0, atol=SAMPLED * OMEGA**2)
        assert abs(loads.sum()) == pytest.approx(abs(fit.exerted_force[k]) * OMEGA**2, rel=1e-12)
    assert fit.bearings == (bearings, bearings)
    with pytest.raises(ValueError, match="read-only"):
        fit.bearing_loads(RPM)[0] = 0.0


def test_bearings_are_at_the_first_and_last_cylinder_unless_given() -> None:
    fit = cp.balance_shafts(I4, [2, -2], bearings=[[0.35, 0.05], None])
    assert fit.bearings == ((0.05, 0.35), (0.0, I4.z[3]))
    alone = cp.balance_shafts(SINGLE, -1)
    assert alone.bearings == (None,)
    with pytest.raises(cp.InputError, match="bearings = None: give bearings"):
        alone.bearing_loads(RPM)
    assert "bearings" not in repr(cp.balance_shafts(SINGLE, -1))


def test_free_planes() -> None:
    """One where that is enough, inside the engine; the first and last cylinder elsewhere."""
    single_plane = I4.replace(cylinder=[CYLINDER] + [CYLINDER.replace(reciprocating_mass=0.0)] * 3)
    (weight,) = cp.balance_shafts(single_plane, -1)[0].unbalances
    assert weight.z == pytest.approx(0.0, abs=1e-12)
    assert weight.amount == pytest.approx(MR / 2, rel=ROUNDING)
    # Two unlike pistons half a turn apart: their force acts far outside, at nine half spacings.
    twin = cp.Engine.inline(CYLINDER, throws_deg=[0, 180], spacing=0.1)
    unlike = twin.replace(cylinder=[CYLINDER, CYLINDER.replace(reciprocating_mass=0.4)])
    assert [w.z for w in cp.balance_shafts(unlike, -1)[0].unbalances] == [0.0, 0.1]
    # Of one heavier piston it acts there, beside three couples.
    assert [w.z for w in cp.balance_shafts(HEAVIER, 1)[0].unbalances] == [
        pytest.approx(0.1, abs=1e-9)
    ]
    assert [w.z for w in cp.balance_shafts(I3, 1)[0].unbalances] == [0.0, 2.0]


def test_counterweights_outside_the_cylinders_do_not_extend_the_engine() -> None:
    """A weight of a milligram-metre at a damper moves neither planes nor bearings."""
    weights = [Unbalance(1e-9, -0.12, 0), Unbalance(1e-9, 2.45, 180)]
    for engine in (I3, I3.with_counterweights(weights)):
        fit = cp.balance_shafts(engine, -1)
        assert [w.z for w in fit[0].unbalances] == [0.0, 2.0]
        assert fit.bearings == ((0.0, 2.0),)


def test_a_pair_is_where_it_cancels_whatever_its_planes() -> None:
    """Forces of the two differ by rounding only: no place follows from that difference."""
    engine = cp.Engine.preset("i4")
    for planes in itertools.combinations(range(31), 2):
        at = [z / 100.0 for z in planes]
        fit = cp.balance_shafts(engine, [2, -2], x=[0.08, -0.06], planes=at)
        # The half of 141.8 mm, to the digits that planes 10 mm apart leave.
        assert [each.y for each in fit] == [
            pytest.approx(0.0709, abs=5e-5),
            pytest.approx(-0.0709, abs=5e-5),
        ]


def test_axes_that_would_leave_the_engine_stay_with_a_warning() -> None:
    """Little third-order force and much roll torque: an axis 56 m away would cancel it."""
    engine = cp.Engine.preset("vr6")
    with pytest.warns(UserWarning, match=r"would be 56.* m from the crank axis; give x and y"):
        fit = cp.balance_shafts(engine, -3)
    # Ten lengths of the engine, in each direction.
    assert np.hypot(fit[0].x, fit[0].y) < 10.0 * np.sqrt(2.0) * np.ptp(engine.z)
    cp.balance_shafts(engine, -3, x=0.1, y=0.1)


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
def test_shafts_in_a_single_plane_share_a_force() -> None:
    fit = cp.balance_shafts(I4, [2, 2, -2, -2], x=0, y=0, planes=[0.0], remove="force")
    left = fit.fitted.balance(RPM, orders=[2])[2].force.peak
    assert left <= ROUNDING * MR * OMEGA**2
    assert fit[0].unbalances[0].amount == pytest.approx(fit[1].unbalances[0].amount)


def test_tables_show_angles_that_are_fractions() -> None:
    engine = cp.Engine.inline(
        CYLINDER, throws_deg=[f"{360 * k}/11" for k in range(11)], spacing=0.1,
        first_tdc_deg="180/7",
    )  # fmt: skip
    fit = cp.balance_shafts(engine, -1)
    exact = [Unbalance(w.amount, w.z, "5760/77") for w in fit[0].unbalances]
    shown = changed(fit, hardware=(fit[0].replace(unbalances=exact),))
    assert "74.805" in repr(shown)


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
def test_force_alone_and_moment_alone() -> None:
    for planes in (None, (0.02, 0.4), (0.0, 0.2, 0.5)):
        force = cp.balance_shafts(HEAVIER, -1, planes=planes, remove="force")
        assert abs(turning(force.fitted, -1, "force")) <= ROUNDING * MR * OMEGA**2
        assert turning(force.fitted, -1, "moment") == pytest.approx(turning(HEAVIER, -1, "moment"))
        moment = cp.balance_shafts(HEAVIER, -1, planes=planes, remove="moment")
        assert abs(turning(moment.fitted, -1, "moment")) <= ROUNDING * MR * OMEGA**2
        assert turning(moment.fitted, -1, "force") == pytest.approx(turning(HEAVIER, -1, "force"))
        assert moment.exerted_force[0] == 0.0
    off = cp.balance_shafts(I4, [2, -2], planes=[0.3], remove="force")
    assert off.fitted.balance(RPM, orders=[2])[2].force.peak <= ROUNDING * MR * OMEGA**2
    assert off.fitted.balance(RPM, orders=[2])[2].moment.peak == pytest.approx(
        4 * MR * A2 * OMEGA**2 * 0.15
    )


def test_reference_plane_of_a_force_alone() -> None:
    fit = cp.balance_shafts(HEAVIER.replace(reference_z=0.25), -1, remove="force")
    (weight,) = fit[0].unbalances
    assert weight.z == 0.25
    assert fit.residual.reference_z == 0.25


def test_single_plane_takes_the_least_sum_of_squares() -> None:
    plane, lever = 0.27, 0.15

    def left(engine: cp.Engine) -> float:
        parts = [turning(engine, -1, quantity) for quantity in ("force", "moment")]
        return float(np.hypot(abs(parts[0]), abs(parts[1]) / lever))

    fit = cp.balance_shafts(HEAVIER, -1, planes=[plane])
    (weight,) = fit[0].unbalances
    least = left(fit.fitted)
    assert 0.0 < least < left(HEAVIER)
    for change in (1e-4, -1e-4, 1e-4j, -1e-4j):
        other = vector(weight) + change
        moved = Unbalance(abs(other), plane, float(np.degrees(np.angle(other))))
        assert left(HEAVIER.with_shafts([Shaft(-1, [moved])])) > least


def test_more_planes_than_needed_take_the_least_sum_of_squares() -> None:
    fit = cp.balance_shafts(I4, 2, planes=(0.0, 0.15, 0.3))
    amounts = [weight.amount for weight in fit[0].unbalances]
    assert amounts == pytest.approx([MR * A2 / 6] * 3, rel=1e-12)


def test_shafts_of_one_ratio_share_their_task_whatever_their_order() -> None:
    mixed = cp.balance_shafts(HEAVIER, [-1, 2, -1], planes=[[0.0], [0.1, 0.3], [0.2]])
    assert [each.ratio for each in mixed] == [-1, 2, -1]
    assert [[w.z for w in each.unbalances] for each in mixed] == [[0.0], [0.1, 0.3], [0.2]]
    for quantity in ("force", "moment"):
        for ratio in (-1, 2):
            assert abs(turning(mixed.fitted, ratio, quantity)) <= ROUNDING * MR * OMEGA**2


def test_pair_of_a_lying_engine_has_its_heights_along_its_force() -> None:
    flat = cp.Engine.from_lists(
        CYLINDER, tdc_deg=[0, 180, 180, 0], bank_deg=[20] * 4, z=[0, 0.1, 0.2, 0.3]
    )
    pair = cp.balance_shafts(flat, [2, -2]).heights[2]
    upright = cp.balance_shafts(I4, [2, -2]).heights[2]
    assert pair["up_deg"] == pytest.approx(20.0)
    assert pair["difference"] == pytest.approx(upright["difference"])
    # No pair: without a force, of unequal forces, of three shafts.
    assert cp.balance_shafts(V6_60, [2, -2]).heights == {}
    twin = cp.Engine.vee(CYLINDER, bank_angle_deg=45, throws_deg=[0], spacing=0.1)
    assert cp.balance_shafts(twin, [2, -2]).heights == {}
    assert cp.balance_shafts(I4, [2, -2, -2]).heights == {}


# --- laws -----------------------------------------------------------------------------------------

ANY = [*UNLIKE.values(), I4, I3, V6_90, V6_60, SINGLE]
engines = st.sampled_from(ANY)
ratios = st.lists(st.sampled_from([-1, 1, -2, 2, -3, 4]), min_size=1, max_size=4)
planes_or_free = st.none() | st.lists(
    st.integers(-10, 40).map(lambda k: k / 50), min_size=1, max_size=3, unique=True
)


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
@settings(max_examples=40, deadline=None)
@given(engine=engines, chosen=ratios, planes=planes_or_free)
def test_a_shaft_changes_its_own_part_alone(
    engine: cp.Engine, chosen: list[int], planes: list[float] | None
) -> None:
    fit = cp.balance_shafts(engine, chosen, planes=planes, x=0.1, y=-0.1)
    size = sum(c.reciprocating_mass * c.crank_radius for c in engine.cylinders) * OMEGA**2
    for ratio in (-1, 1, -2, 2, -3, 3, -4, 4):
        if ratio not in chosen:
            for quantity in ("force", "moment"):
                before, after = (turning(e, ratio, quantity) for e in (engine, fit.fitted))
                assert abs(after - before) <= ROUNDING * size


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
@settings(max_examples=40, deadline=None)
@given(engine=engines, chosen=ratios, planes=planes_or_free)
def test_what_stays_never_exceeds_the_start(
    engine: cp.Engine, chosen: list[int], planes: list[float] | None
) -> None:
    fit = cp.balance_shafts(engine, chosen, planes=planes)
    span = float(np.ptp(engine.z)) / 2 or engine.cylinders[0].crank_radius
    for ratio in set(chosen):
        sizes = [
            np.hypot(abs(turning(e, ratio, "force")), abs(turning(e, ratio, "moment")) / span)
            for e in (engine, fit.fitted)
        ]
        assert sizes[1] <= sizes[0] * (1 + 1e-9)


@settings(max_examples=25, deadline=None)
@given(engine=engines, chosen=ratios, share=st.floats(0.01, 1.0))
def test_no_counterweight_changes_what_a_backward_shaft_carries(
    engine: cp.Engine, chosen: list[int], share: float
) -> None:
    weighted = engine.with_counterweights(bob_weights(engine, share))
    for ratio in chosen:
        if ratio < 0:
            fits = [cp.balance_shafts(e, ratio, planes=(0.0, 0.4)) for e in (engine, weighted)]
            size = MR * len(engine)
            assert abs(fits[0].exerted_force - fits[1].exerted_force).max() <= ROUNDING * size
            assert abs(fits[0].exerted_moment - fits[1].exerted_moment).max() <= ROUNDING * size


@pytest.mark.parametrize("engine", ANY)
def test_adding_and_removing_is_the_identity(engine: cp.Engine) -> None:
    own = [Shaft(3, [Unbalance(0.001, 0.1, 20)], x=0.2)]
    equipped = engine.with_counterweights(bob_weights(engine, 0.3)).with_shafts(own)
    fit = cp.balance_shafts(equipped, [-1, 2])
    assert fit.engine is equipped
    assert fit.fitted.shafts == (*equipped.shafts, *fit)
    assert fit.fitted.counterweights == equipped.counterweights
    assert fit.fitted.with_shafts(equipped.shafts) == equipped
    # What is removed once is not there to be removed again.
    again = cp.balance_shafts(fit.fitted, [-1, 2])
    assert again.unbalance <= 1e-12 * fit.unbalance


@settings(max_examples=25, deadline=None)
@given(engine=engines, turn=st.integers(-179, 180), crank=st.integers(0, 359))
def test_turning_the_engine_turns_the_answer(engine: cp.Engine, turn: int, crank: int) -> None:
    """In space all vectors turn alike; with the crank those of a shaft by its ratio."""
    chosen, planes = [-1, 1, 2, -2], (0.0, 0.4)
    there = cp.balance_shafts(engine, chosen, planes=planes)
    tilted = engine.replace(bank_deg=engine.bank_deg + turn)
    later = engine.with_first_tdc(float(engine.tdc_deg[0]) + crank)
    size = there.unbalance
    of_tilted = cp.balance_shafts(tilted, chosen, planes=planes)
    of_later = cp.balance_shafts(later, chosen, planes=planes)
    for k, (each, aslant, late) in enumerate(zip(there, of_tilted, of_later, strict=True)):
        force = complex(there.exerted_force[k])
        assert abs(of_tilted.exerted_force[k] - turned(force, turn)) <= 1e-11 * size
        back = -crank * each.ratio
        assert abs(of_later.exerted_force[k] - turned(force, back)) <= 1e-11 * size
        where = complex(each.x, each.y)
        if abs(force) > 1e-6 * size:
            room = 1e-6 * max(abs(where), 0.1)
            assert abs(complex(aslant.x, aslant.y) - turned(where, turn)) <= room
            assert abs(complex(late.x, late.y) - where) <= room


# --- the object -----------------------------------------------------------------------------------

FIT = cp.balance_shafts(V6_90, [-1, -2], x=0.1, y=[0.05, None])


def test_result_is_frozen_and_copies() -> None:
    for one in (FIT, FIT[0]):
        assert pickle.loads(pickle.dumps(one)) == one  # noqa: S301 - its own
        assert copy.deepcopy(one) == one
        assert hash(copy.copy(one)) == hash(one)
        with pytest.raises(AttributeError):
            one.ratio = 3  # type: ignore[misc, union-attr]
    assert cp.balance_shafts(V6_90, [-1, -2], x=0.1, y=0.05) != FIT
    assert (len(FIT), FIT.orders) == (2, (1, 2))


def test_tables_show_the_fit() -> None:
    unbalances, shafts, stays = FIT.frames.values()
    assert list(FIT.frames) == ["table", "shafts", "residual"]
    weights = [w for each in FIT for w in each.unbalances]
    assert list(unbalances["unbalance"].values) == [w.amount for w in weights]
    assert list(unbalances["phase"].values) == [w.angle_deg for w in weights]
    assert list(unbalances["z"].values) == [w.z for w in weights]
    assert list(shafts["moment"].values) == abs(FIT.exerted_moment).tolist()
    loads = abs(FIT.bearing_loads(RPM)) / OMEGA**2
    found = [shafts["front load"].values, shafts["rear load"].values]
    np.testing.assert_allclose(np.transpose(found), loads, rtol=1e-12)
    rows = zip(*(column.values for column in stays.columns), strict=True)
    for order, quantity, part, before, after in rows:
        names = {"shaking": "force", "rocking": "moment", "roll": "torque"}
        name = names[str(quantity).split()[0]]
        for engine, value in ((V6_90, before), (FIT.fitted, after)):
            one = getattr(engine.balance(RPM, orders=[1, 2])[int(order)], name)
            expected = abs(getattr(one, str(part) if part else "phasor")) / OMEGA**2
            assert value == pytest.approx(float(expected), rel=1e-9, abs=1e-15)
    assert repr(FIT).count("\n\n") == 2
    assert html_of(FIT).count("<table>") == 3


def test_to_pandas() -> None:
    table = FIT.to_pandas()
    assert table.columns.tolist() == [
        "shaft", "ratio", "x m", "y m", "z m", "unbalance kg·m", "phase °",
    ]  # fmt: skip
    weights = [w for each in FIT for w in each.unbalances]
    assert table["unbalance kg·m"].tolist() == [w.amount for w in weights]
    assert table["ratio"].tolist() == ["-1", "-1", "-2", "-2"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"ratios": 0}, "^ratios = 0: give a multiple of 1/2 other than 0"),
        ({"ratios": 1.3}, "^ratios = 1.3: give a multiple of 1/2"),
        ({"ratios": []}, "^ratios has 0 shafts: give 1 to 100"),
        ({"ratios": "2,1"}, "^ratios = '2,1'"),
        ({"ratios": 10**6}, "^ratios = 1000000: give"),
        ({"x": [1, 2]}, "^x has 2 entries: give one for each of 1 shafts"),
        ({"x": float("nan")}, "^x = nan: give a finite number"),
        ({"y": "up"}, "^y"),
        ({"planes": 0.1}, "^planes = 0.1: give places along the crank"),
        ({"planes": [0.1, 0.1]}, r"^planes\[0\] = \[0.1, 0.1\]: give different places"),
        ({"planes": []}, r"^planes\[0\] = \[\]: give different places"),
        ({"planes": [[0.1], [0.2]]}, "^planes has 2 entries"),
        ({"planes": [0.1], "remove": "moment"}, r"^planes\[0\] = \[0.1\]: a couple takes two"),
        ({"bearings": [0.1]}, r"^bearings\[0\] = \[0.1\]: give the places of two bearings"),
        ({"remove": "all"}, '^remove = \'all\': give "both", "force" or "moment"'),
        ({"ratios": [2, 2], "remove": ["force", "both"]}, "shafts of one ratio share their task"),
        ({"engine": "i4"}, "^engine = 'i4': give a crankpin.Engine"),
    ],
)
def test_errors_name_the_argument(given: dict[str, Any], words: str) -> None:
    arguments: dict[str, Any] = {"engine": I4, "ratios": -1} | given
    call: Callable[..., Any] = cp.balance_shafts
    with pytest.raises(cp.InputError, match=words):
        call(**arguments)
    with pytest.raises(cp.InputError, match=r"use crankpin\.balance_shafts"):
        cp.results.BalanceShafts(I4, (1,), (), (), None)  # type: ignore[arg-type]


# --- nearly dependent equations -------------------------------------------------------------------


def roll_left(fit: cp.results.BalanceShafts) -> float:
    """Return the roll torque that stays, over ω²."""
    return next(part.after for part in fit.parts() if part.quantity == "torque")


@pytest.mark.filterwarnings("ignore:.*which vanishes without this hardware")
@pytest.mark.parametrize(
    ("engine", "ratios", "options"),
    [
        (
            cp.Engine.preset("v8-crossplane"), [1, 1],
            {"x": [-0.07, -0.12], "planes": [[0.15, 0.22], [-0.03, 0.25]]},
        ),
        (
            cp.Engine.inline(cp.Cylinder(0.05, 0.15, 1.0), throws_deg=[0, 210], spacing=0.1),
            [2, 2],
            {"x": [0.16, -0.02], "planes": [[0, 0.19], [0, 0.18]], "remove": "moment"},
        ),
    ],
)  # fmt: skip
def test_couples_whose_forces_are_rounding_stay_at_height_0(
    engine: cp.Engine, ratios: list[int], options: dict[str, Any]
) -> None:
    free, fixed = (cp.balance_shafts(engine, ratios, y=y, **options) for y in (None, 0.0))
    assert [shaft.y for shaft in free] == [0.0, 0.0]
    assert roll_left(free) == roll_left(fixed)


@in_turn("seed", range(250))
def test_free_places_leave_no_more_roll_torque_than_numpys_least_squares(seed: int) -> None:
    """Heights of shafts whose forces are parallel, nearly so, or neither."""
    rng = np.random.default_rng(seed)
    throws = rng.integers(0, 24, int(rng.integers(1, 5))) * 15
    engine = cp.Engine.inline(cp.Cylinder(0.05, 0.15, 1.0), throws_deg=throws, spacing=0.1)
    order = int(rng.integers(1, 3))
    ratios = (rng.choice([-1, 1], int(rng.integers(1, 4))) * order).tolist()
    x = rng.uniform(-0.2, 0.2, len(ratios)).round(2).tolist()
    planes = [sorted(rng.uniform(0, 0.4, 2).tolist()) for _ in ratios]
    if seed % 3 == 0:
        planes = [[a, a + 1e-6] for a, _ in planes]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fit = cp.balance_shafts(engine, ratios, x=x, planes=planes)
        fixed = cp.balance_shafts(engine, ratios, x=x, y=0.0, planes=planes)
        left = fixed.residual[order].torque.phasor
        ours = roll_left(fit)
    # Torque for each metre of height: −F_x, which is F or its conjugate.
    rows = np.array([
        [-force.real, -force.imag if ratio > 0 else force.imag]
        for force, ratio in zip(fixed.exerted_force, ratios, strict=True)
    ]).T  # fmt: skip
    target = -np.array([left.real, left.imag])
    heights = np.linalg.lstsq(rows, target, rcond=1e-9)[0]
    rest = np.linalg.norm(rows @ heights - target)
    if abs(heights).max() < 1.0:  # others are beyond the reach of the engine
        # Some hundred units in the last place of the torques of the heights.
        rounding = 1e-13 * (np.linalg.norm(target) + abs(rows * heights).sum())
        # Angles of unbalances are known to 1e-13°, 2e-15 rad, and axes are within a metre.
        rounding += 2e-15 * order**2 * fit.unbalance
        assert ours <= rest + rounding


def test_cylinders_the_smallest_number_apart_are_at_one_place() -> None:
    both, one = (
        cp.Engine.from_lists(
            cp.Cylinder(0.05, 0.15, 1.0), bank_deg=[90, 90], tdc_deg=[0, 90], z=[0.0, z]
        )
        for z in (5e-324, 0.0)
    )
    for ratios in ([1], [1, -1], [2, -2]):
        near, same = (cp.balance_shafts(engine, ratios) for engine in (both, one))
        assert near.unbalance == pytest.approx(same.unbalance, rel=1e-12)
        assert near.residual.force.peak == pytest.approx(same.residual.force.peak, abs=1e-14)


def test_shafts_within_the_throws_are_noted() -> None:
    """A couple needs no place beside the crank, where the shaft would be."""
    i3 = cp.Engine.preset("i3")
    assert "Inside the crank: shaft 1; x= and y=" in cp.balance_shafts(i3, -1).table.note
    assert not cp.balance_shafts(i3, -1, x=0.1, y=0.0).table.note
    two = cp.balance_shafts(i3, [-1, -1], x=[0.1, 0.02], y=0.0)
    assert "Inside the crank: shaft 2;" in two.table.note
