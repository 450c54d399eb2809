"""Are figures of powertrains those computed by other routes, and those of textbooks?"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
    from crankpin.model.mounts import Products

FIGURE = 6e-8
"""Relative error of figures of eight digits."""

I4 = cp.Engine.inline(
    cp.Cylinder(0.043, 0.145, 0.45), throws_deg=[0, 180, 180, 0], spacing=0.1, name="I4"
)
CG = (0.0, 0.06, I4.reference_z)


def four_mounts(loss: float = 0.0) -> list[cp.Mount]:
    """Return four equal mounts at (±.22, −.18, ±.28) from the CG."""
    return [
        cp.Mount(
            f"{x:+} {z:+}",
            at=(x, CG[1] - 0.18, CG[2] + z),
            stiffness=(1.5e5, 3e5, 1.2e5),
            loss_factor=loss,
        )
        for x in (0.22, -0.22)
        for z in (0.28, -0.28)
    ]


BODY = cp.RigidBody(150.0, CG, (7.0, 8.0, 4.5))
PLAIN = cp.Powertrain(I4, BODY, four_mounts(0.1))


def near(expected: object, rel: float = FIGURE) -> object:
    return pytest.approx(expected, rel=rel, abs=0.0)


def test_modes_of_four_equal_mounts() -> None:
    m = PLAIN.modes()
    expected = [8.1983542, 8.4247674, 14.235251, 14.916478, 20.262275, 21.603265]
    assert m.frequency == near(expected)
    assert m.energy[[0, 5], 1] == near([92.331915, 7.6680847])
    assert m.energy.sum(axis=0) == near(np.full(6, 100.0), 1e-12)
    assert m.strain == pytest.approx(np.full((4, 6), 25.0))
    assert m.dominant == ("fore-aft", "lateral", "bounce", "yaw", "pitch", "roll")
    assert (m.groups, m.free) == (((1,), (2,), (3,), (4,), (5,), (6,)), ())
    assert m.loss_factor == near(np.full(6, 0.1), 1e-12)


def test_elastic_centre_of_inclined_mounts() -> None:
    """Two pairs of mounts tilted towards the middle, half as stiff each."""
    mounts = [
        cp.Mount(f"{x} {z}", (x, 0, z), (2e5, 4e4, 4e4), tilt_deg=90 + math.copysign(40, x))
        for x in (0.3, -0.3)
        for z in (0.2, -0.2)
    ]
    p = cp.Powertrain(I4, cp.RigidBody(100.0, (0, 0.22274808, 0), (7, 8, 4.5)), mounts)
    axes = p.axes()
    # Its distance from the CG, put there to eight digits, is left by rounding of that.
    assert axes.elastic_foot[1] == near(0.22274808)
    assert axes.roll_stiffness == near(27142.12)
    # The same to eight digits of the place of the CG.
    assert axes.cg_distance == pytest.approx(0.0, abs=1e-8)
    low = p.replace(body=p.body.replace(cg=(0.05, -0.1, 0.02))).axes()
    np.testing.assert_allclose(low.elastic_offset, [-0.05, 0.32274808, 0.0], atol=1e-8)
    assert low.cg_distance == near(math.hypot(0.05, 0.32274808))
    foot = np.array(low.elastic_foot) - low.elastic_offset
    np.testing.assert_allclose(foot, (0.05, -0.1, 0.02), atol=1e-15)
    assert low.table["off the CG"].values[1] == 1e3 * low.cg_distance
    # Forces along z act at the height of the mounts: a line, but no point for all directions.
    assert axes.elastic_centre is None
    lateral = p.modes().frequency[p.modes().dominant.index("lateral")]
    assert 100.0 * (2.0 * math.pi * lateral) ** 2 == near(424432.58)


def test_a_force_through_the_elastic_centre_causes_no_rotation() -> None:
    corners = [(x, -0.1, z) for x in (0.3, -0.3) for z in (0.0, 0.6)]
    mounts = [
        cp.Mount(f"{k}", at, (1e5, 2e5, 7e4), dynamic_stiffness=(1e5, 2e5 + 3e5 * (k == 0), 7e4))
        for k, at in enumerate(corners)
    ]
    p = cp.Powertrain(I4, cp.RigidBody(100.0, (0.1, 0.2, 0.3), (7, 8, 4.5)), mounts)
    axes = p.axes()
    centre = (0.0, -0.1, 0.3)
    assert axes.elastic_centre == near(centre, 1e-12)
    off = 1e3 * math.dist(centre, (0.1, 0.2, 0.3))
    assert f"Elastic centre with static stiffness: (0, -0.1, 0.3) m, {off:.5g} mm" in str(axes)
    for unit in np.eye(3):
        turned = p.static(gravity=(0, 0, 0), thrust=1e3 * unit, thrust_at=centre)
        # Rotations of the same force at the CG: some tenths of a degree.
        assert np.abs(turned.thrust_deg).max() < 1e-12
        apart = np.add(centre, (0.0, 1e-3, 0.0))
        other = p.static(gravity=(0, 0, 0), thrust=1e3 * unit, thrust_at=apart)
        assert np.abs(other.thrust_deg).max() > 1e-6 or unit[1]
    # One mount stiffer up and down in motion: forces up and sideways have different centres.
    assert axes.dynamic_elastic_centre is None
    assert axes.dynamic_cg_distance > 0.0
    assert "No elastic centre with dynamic stiffness: of any point, some force" in str(axes)
    raft = cp.Subframe(cp.RigidBody(50.0, (0, -0.3, 0.3), (3, 4, 3)), mounts)
    below = p.with_support(raft).axes()
    assert below.elastic_centre is not None
    on_both = p.with_support(raft).static(
        gravity=(0, 0, 0), thrust=(800, 900, 1e3), thrust_at=below.elastic_centre
    )
    assert np.abs(on_both.thrust_deg).max() < 1e-12


def test_roll_stiffness_at_rest_and_in_motion_are_two_figures() -> None:
    stiffer = [
        mount.replace(dynamic_stiffness=1.4 * np.array(mount.stiffness)) for mount in four_mounts()
    ]
    p = PLAIN.replace(mounts=stiffer)
    axes, turned = p.axes(), np.radians(p.static(-100.0).wind_up_deg[2])
    assert axes.roll_stiffness == near(100.0 / turned, 1e-12)
    assert axes.roll_stiffness == near(PLAIN.axes().roll_stiffness, 1e-12)
    assert axes.dynamic_roll_stiffness == near(1.4 * axes.roll_stiffness, 1e-12)
    # Of one mount alone: its height draws the elastic axis to it.
    low = four_mounts()
    low[0] = low[0].replace(dynamic_stiffness=[3 * k for k in low[0].stiffness])
    axes = PLAIN.replace(mounts=low).axes()
    assert axes.angle_deg == near(PLAIN.axes().angle_deg, 1e-9)
    assert axes.dynamic_angle_deg > axes.angle_deg + 1.0
    rows = axes.table["roll stiffness"].values
    assert rows == (None, axes.roll_stiffness, axes.dynamic_roll_stiffness)
    assert PLAIN.axes().dynamic_distance == PLAIN.axes().distance


@pytest.mark.parametrize(
    ("products", "x"), [("tensor", 0.15094511), ("positive-integrals", -0.14645593)]
)
def test_torque_roll_axis(products: Products, x: float) -> None:
    inertia = [[6, 0.4, -0.9], [0.4, 8.5, 0.3], [-0.9, 0.3, 3.2]]
    p = PLAIN.replace(body=cp.RigidBody(150.0, CG, inertia, products))
    axes = p.axes()
    assert axes.torque_roll[0] == near(x)
    if products == "tensor":
        assert axes.torque_roll_deg == near(9.0136102)
    assert axes.mount_distances.shape == (4,)


def vertical(*, ratio: float, **damping: float) -> float:
    """Return the vertical transmissibility of order 1 at a ratio of frequencies."""
    single = cp.Engine.preset("single")
    plain = cp.Mount("", (0, 0, 0), 2.5e5).replace(**damping)
    mounts = [plain.replace(name=f"{x} {z}", at=(x, 0, z)) for x in (1, -1) for z in (1, -1)]
    p = cp.Powertrain(single, cp.RigidBody(100.0, (0, 0, 0), (20, 20, 20)), mounts)
    omega = ratio * math.sqrt(1e6 / 100.0)
    r = p.response(60.0 * omega / (2.0 * math.pi), orders=[1])
    return float(r.transmissibility[0, 1])


def test_transmissibility_of_viscous_and_hysteretic_damping() -> None:
    viscous = 2.0 * 0.1 * math.sqrt(1e6 * 100.0) / 4.0
    assert vertical(ratio=4.0, damping=viscous) == near(0.085253826)
    assert vertical(ratio=4.0, loss_factor=0.2) == near(0.067980884)
    assert vertical(ratio=1.0, loss_factor=0.2) == near(5.0990195)
    assert vertical(ratio=1.0, damping=viscous) == near(5.0990195)


def test_bevan_15_7() -> None:
    """3 lb move by 3.5 in on springs that transmit 1/30 at 1200 rpm; amplitudes fall by a fifth."""
    ratio, damping = math.sqrt(31.0), math.log(1.25) / (2.0 * math.pi)
    viscous = 2.0 * damping * math.sqrt(1e6 * 100.0) / 4.0
    shaking = 3.0 / 32.2 * 1.75 / 12.0 * (2.0 * math.pi * 20.0) ** 2
    assert shaking == near(214.55662)
    # The book's stiffness and damping are rounded on the way, to a thousandth.
    assert shaking * vertical(ratio=ratio, damping=viscous) == near(7.6886199, 1e-3)
    at_resonance = shaking / 31.0 * vertical(ratio=1.0, damping=viscous)
    assert at_resonance == near(97.809847, 1.5e-3)


@pytest.mark.parametrize("stiffness", [2e5, (1e5, 3e5, 2e5)])
def test_three_mounts_carry_by_statics_alone(stiffness: float | tuple[float, ...]) -> None:
    places = [(0.3, 0, 0), (-0.3, 0, 0), (0, 0, 0.7)]
    mounts = [cp.Mount(f"{k}", at, stiffness) for k, at in enumerate(places)]
    body = cp.RigidBody(160.0, (0.03, 0.1, 0.2), (7, 8, 4.5))
    state = cp.Powertrain(I4, body, mounts).static()
    assert -state.preload[:, 1] == near([638.8332, 481.9268, 448.304])
    assert state.support_margin > 0.0


def test_an_inline_four_at_3000_rpm() -> None:
    r = PLAIN.response(3000, orders=[2, 4, 6])
    assert abs(r.wrench[0, [1, 5]]) == near([2317.3515, 164.32704])
    assert r[2].body_force.peak_xyz[:2] == near([10.606355, 48.169592])
    assert abs(r.motion[0, 1]) == near(39.942113e-6)
    head = r.at((0, CG[1] + 0.35, CG[2]))
    assert head.velocity.total.rms_xyz[:2] == near([14.966088e-3, 17.746952e-3])
    assert head.grade == 18.0
    assert r[2].power_in == near(83.048425e-3)
    assert r[2].power_lost.sum() == near(83.048425e-3)


def test_roll_of_a_half_order_at_idle() -> None:
    """60 N·m about z at order ½ and 800 rpm, as a pair of forces."""
    pair = tuple(
        cp.Actuator(name, (CG[0] + x, CG[1], CG[2]), (0, 1, 0))
        for name, x in (("up", 0.5), ("down", -0.5))
    )
    request = PLAIN.response(800, orders=[0.5])._request
    forces = np.array([[[60.0, -60.0]]], complex)
    speeds = np.array([800.0])
    r = cp.results.DrivenResponse(PLAIN, speeds, request, pair, forces, engine_runs=False)
    assert r.wrench[0, 0].tolist() == [0, 0, 0, 0, 0, 60]
    assert np.degrees(abs(r.motion[0, 0, 5])) == near(0.095812975)


def test_soft_mounts_leave_a_free_body() -> None:
    soft = [mount.replace(stiffness=1e3) for mount in four_mounts()]
    r = PLAIN.replace(mounts=soft).response(3000, orders=[2])
    # The mounts' stiffness over the inertia: 4e3/(150·628²).
    assert abs(r.motion[0, 1]) == near(39.1328e-6, 1e-4)


def test_hydraulic_mount() -> None:
    track = cp.InertiaTrack(stiffness=1.8e5, frequency=10, damping_ratio=0.25)
    mount = cp.Mount("front", (0, 0, 0), 2e5, loss_factor=0.06, track=track)
    along = mount.dynamic_at(8)[0]
    assert abs(along) == near(303865.19)
    assert np.degrees(np.angle(along)) == near(59.056968)
    assert abs(mount.dynamic_at(1e4)[0]) == near(380189.61)


def test_mean_torque_winds_up_against_its_sense() -> None:
    state = PLAIN.static(torque=100.0, gear_ratio=12.0)
    assert state.torque == 1200.0
    arms = np.array([mount.at[0] for mount in PLAIN.mounts])
    # About any line along z: forces of the mounts on what carries them make minus the torque.
    heights = np.array([mount.at[1] for mount in PLAIN.mounts])
    roll = arms @ state.torque_force[:, 1] - heights @ state.torque_force[:, 0]
    assert roll == near(-1200.0, 1e-12)
    assert state.wind_up_deg[2] < 0.0
    fired = PLAIN.replace(
        engine=cp.Engine.preset(
            "i4", cylinder=cp.Cylinder(0.043, 0.145, 0.45, bore=0.086)
        ).with_cycle(cp.Cycle.example())
    )
    assert fired.engine is not None
    mean = fired.engine.balance(1000).crank_torque.cycle_mean
    assert fired.static("engine").torque == near(mean, 1e-12)


def test_a_dead_cylinder_brings_half_orders() -> None:
    cylinder = cp.Cylinder(0.043, 0.145, 0.45, bore=0.086)
    fired = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    p = PLAIN.replace(engine=fired)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        whole, dead = p.response(850), p.with_misfire(3).response(850)
    assert 0.5 not in whole
    assert 0.5 in dead
    assert whole[0.5].body_force.peak == pytest.approx(0.0, abs=1e-9 * whole.body_force.peak.max())
    assert dead[0.5].body_force.peak > 1.0
    assert "cylinder 3 does not fire" in dead.loads_counted


def test_thrust_is_borne_by_the_mounts_where_it_acts() -> None:
    push, at = np.array([10.0, -20.0, -3500.0]), np.array([0.02, -0.1, 0.9])
    plain, state = PLAIN.static(100.0), PLAIN.static(100.0, thrust=push, thrust_at=at)
    forces = state.thrust_force
    assert forces.sum(axis=0) == near(push, 1e-12)
    arms = np.array([mount.at for mount in PLAIN.mounts])
    # Moments cancel from forty times the result.
    assert np.cross(arms, forces).sum(axis=0) == near(np.cross(at, push), 1e-11)
    assert state.preload == near(plain.preload + forces, 1e-12)
    # In the plane of the mounts, 0.18 m below the CG.
    moved = state.thrust_shift[2] - 0.18 * np.radians(state.thrust_deg[0])
    assert moved == near(-3500.0 / (4 * 1.2e5), 1e-12)
    assert "thrust F_z" in str(state.table)
    assert "thrust" not in str(plain.table)


def test_the_support_polygon_is_that_of_the_outer_mounts() -> None:
    inner = cp.Mount("inner", at=(0.0, 0.0, CG[2]), stiffness=1e5)
    state = PLAIN.replace(mounts=[*PLAIN.mounts, inner]).static()
    assert {*state.support_polygon} == {*PLAIN.names}
    corners = np.array([PLAIN.mounts[PLAIN.names.index(n)].at for n in state.support_polygon])
    edges = np.diff([*corners, corners[0]], axis=0)
    turns = np.cross(edges, np.roll(edges, -1, axis=0))[:, 1]
    assert (turns > 0.0).all() or (turns < 0.0).all()


def test_axes_of_symmetric_mounts_have_zeros_and_no_rounding() -> None:
    axes = PLAIN.axes()
    assert axes.torque_roll.tolist() == axes.elastic.tolist() == [0.0, 0.0, 1.0]
    assert (axes.elastic_foot[0], axes.pitch, axes.elastic_deg, axes.angle_deg) == (0, 0, 0, 0)
    # The foot is below the CG: lateral stiffness acts at the mounts' height.
    assert axes.elastic_foot[1] < CG[1]
    # A tilt of 1e-9 is no rounding.
    tilted = PLAIN.replace(
        body=cp.RigidBody(
            150.0, CG, [[7.0, 0.0, 1e-9], [0.0, 8.0, 0.0], [1e-9, 0.0, 4.5]], "tensor"
        )
    )
    assert tilted.axes().torque_roll[0] == near(-1e-9 / 7.0, 1e-6)
