"""Do actuators leave the least under their limits, and do stability limits hold?"""

from __future__ import annotations

import copy
import math
import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from rederivation import active as again
from support import in_turn

PRESETS = ("single", "i4", "v6-60", "v8-crossplane")
HEAD = cp.Actuator("head", (0, 0.3, 0.1), (0, 1, 0))
SIDE = cp.Actuator("side", (0.2, 0.0, 0.3), (1, 0, 0), mass=2, stroke=0.003)
I4 = cp.Engine.preset("i4")
BODY = cp.RigidBody(150.0, (0.0, 0.06, I4.reference_z), (7.0, 8.0, 4.5))
FOUR = [
    cp.Mount(f"{x} {z}", (x, -0.12, I4.reference_z + z), (1.5e5, 3e5, 1.2e5), loss_factor=0.1)
    for x in (0.22, -0.22)
    for z in (0.28, -0.28)
]
P = cp.Powertrain(I4, BODY, FOUR)
SEAT = ((0.22, -0.12, 0.4), (0, 1, 0))


def one_channel(rpm: Any = 3000.0, **limits: Any) -> cp.results.Cancellation:  # noqa: ANN401
    return P.response(rpm, orders=[2, 4]).cancel(HEAD.replace(**limits), {"seat": SEAT})


def random_case(seed: int) -> tuple[cp.Powertrain, list[cp.Actuator], list[Any]]:
    """Return a random powertrain, actuators with limits, and points."""
    draw = np.random.default_rng(seed)
    engine = cp.Engine.preset(PRESETS[seed % len(PRESETS)])
    engine = engine.with_counterweights([cp.Unbalance(0.01, z=draw.uniform(-0.3, 0.3))])
    body = cp.RigidBody(150.0, tuple(draw.uniform(-0.2, 0.2, 3)), (7, 8, 4.5))
    mounts = [
        cp.Mount(
            f"{k}",
            tuple(draw.uniform(-0.5, 0.5, 3)),
            tuple(draw.uniform(5e4, 4e5, 3)),
            tilt_deg=draw.uniform(-180, 180),
            loss_factor=tuple(draw.uniform(0.02, 0.3, 3)),
        )
        for k in range(4)
    ]
    actuators = [
        cp.Actuator(
            f"{k}",
            tuple(draw.uniform(-0.4, 0.4, 3)),
            tuple(draw.normal(size=3)),
            force=draw.uniform(5, 500) if k % 2 else None,
            mass=3,
            stroke=draw.uniform(1e-5, 1e-3) if k != 1 else None,
            resonance=draw.uniform(3, 30),
            damping_ratio=0.1,
        )
        for k in range(draw.integers(1, 5))
    ]
    points = [tuple(draw.uniform(-0.5, 0.5, 3)) for _ in range(draw.integers(1, 4))]
    return cp.Powertrain(engine, body, mounts), actuators, points


def optimal(
    target: np.ndarray,
    effect: np.ndarray,
    bounds: np.ndarray,
    effort: float = 0.0,
    widths: list[int] | None = None,
) -> np.ndarray:
    """Return the phasors of one point."""
    rows = (target[None].astype(complex), effect[None], bounds[None])
    return np.asarray(_core.actuator_phasors(*rows, effort, widths)[0])


# --- phasors --------------------------------------------------------------------------------------


def test_one_channel_is_cancelled_perfectly_by_the_closed_form() -> None:
    """The canceller of one sensor and one actuator: −d/S, to which a law that adapts comes."""
    c = one_channel()
    place = ("at", SEAT[0], "powertrain", "velocity")
    d = (c.before._vectors(place) @ np.array(SEAT[1]))[0]
    s = (c._alone(HEAD)._vectors(place) @ np.array(SEAT[1]))[0]
    assert c.forces[0, 0] == pytest.approx(-d / s, rel=1e-12)
    # 40 000 samples at a step of a hundredth: the transient is gone.
    assert again.adapted_weight(d, s, 100.0, 0.01) == pytest.approx(c.forces[0, 0], rel=1e-9)
    assert (c.residual < 1e-12).all()
    assert (
        c.response.at(SEAT[0]).velocity[2].peak_xyz[1]
        < 1e-12 * c.before[2].at(SEAT[0]).velocity.peak_xyz[1] + 1e-15
    )
    # Perfect there and not elsewhere.
    assert c.response.body_force[2].peak > 0.1 * c.before.body_force[2].peak


@in_turn("seed", range(60))
def test_phasors_are_optimal_within_their_bounds(seed: int) -> None:
    """A dual bound from below meets what they leave."""
    draw = np.random.default_rng(seed)
    receivers, actuators = draw.integers(1, 7), draw.integers(1, 6)
    effect = draw.normal(size=(receivers, actuators)) + 1j * draw.normal(
        size=(receivers, actuators)
    )
    if seed % 3 == 0 and actuators > 1:
        effect[:, 1] = effect[:, 0] * (1 + 1e-6)
    effect *= 10 ** draw.uniform(-6, 3)
    target = 10 ** draw.uniform(-3, 3) * (draw.normal(size=receivers) + 1j)
    free = np.linalg.lstsq(effect, -target, rcond=None)[0]
    bounds = np.abs(free) * draw.uniform(0.1, 1.5, actuators)
    if seed % 4 == 0:
        bounds[0] = np.inf
    if seed % 5 == 0:
        bounds[-1] *= 1e-6
    effort = (0.0, 1e-3)[seed % 2]
    found = optimal(target, effect, bounds, effort)
    assert (np.abs(found) <= bounds * (1 + 1e-12)).all()
    weight = effort * float(np.linalg.norm(effect, 2)) ** 2
    # The central path ends 1e-12 from the least; the dual is near the best to its square root.
    assert again.dual_gap(target.astype(complex), effect, bounds, weight, found) < 1e-10


@pytest.mark.slow
@in_turn("seed", range(24))
def test_the_largest_receiver_is_the_least_that_there_is(seed: int) -> None:
    """Weights of the receivers give a bound from below, which the largest meets (Lawson)."""
    draw = np.random.default_rng(seed)
    widths = [int(draw.choice([1, 3])) for _ in range(draw.integers(2, 6))]
    actuators, rows = int(draw.integers(1, 4)), sum(widths)
    effect = draw.normal(size=(rows, actuators)) + 1j * draw.normal(size=(rows, actuators))
    effect *= 10 ** draw.uniform(-6, 3)
    target = (draw.normal(size=rows) + 1j * draw.normal(size=rows)).astype(complex)
    target *= 10 ** draw.uniform(-3, 3)
    free = np.linalg.lstsq(effect, -target, rcond=None)[0]
    bounds = np.abs(free) * draw.uniform(0.3, 2.0, actuators)
    if seed % 3:
        bounds[:] = np.inf
    start = optimal(target, effect, bounds)
    found = optimal(target, effect, bounds, widths=widths)
    assert (np.abs(found) <= bounds * (1 + 1e-9)).all()
    groups = np.split(np.arange(rows), np.cumsum(widths)[:-1])

    def sizes(phasors: np.ndarray) -> np.ndarray:
        left = target + effect @ phasors
        return np.array([np.linalg.norm(left[group]) for group in groups])

    largest = sizes(found).max()
    assert largest <= sizes(start).max() * (1 + 1e-12)
    # No convex combination of squares is larger at its own least.
    weights = np.ones(len(groups)) / len(groups)
    least = 0.0
    for _ in range(400):
        root = np.sqrt(np.repeat(weights, widths))
        each = sizes(optimal(root * target, root[:, None] * effect, bounds))
        least = max(least, float(np.sqrt((weights * each**2).sum())))
        weights = weights * each / (weights * each).sum()
    assert least <= largest * (1 + 1e-6)
    # Lawson's weights converge slowly.
    assert largest <= least * (1 + 0.02) + 1e-12 * np.abs(target).max()


def test_receivers_are_points_names_and_motions() -> None:
    frequency = np.array([0.1, 1e4])
    transfer = np.array([[[1e-7]], [[2e-7]], [[0.0]]]).reshape(3, 1)
    rail = cp.Receptance(
        [(P.names[0], "y")], (frequency, np.full((2, 1, 1), 1e-7 - 1e-9j)), {"rail": [transfer] * 2}
    )
    r = P.with_support(rail).response(3000.0, orders=[2])
    c = r.cancel(HEAD, "rail")
    # One force at one coordinate moves the rail: it is still.
    assert c.read("residual")[0] < 1e-9
    assert c.receivers[0][0] == "rail"
    assert c.forces == pytest.approx(r.cancel(HEAD, [r.at("rail")]).forces)
    up = r.cancel(HEAD, {"up": ("rail", (0, 1, 0))})
    assert up.forces == pytest.approx(c.forces)
    raft = cp.Subframe(BODY.replace(mass=300.0), [m.replace(stiffness=1e6) for m in FOUR])
    soft = P.with_support(raft).response(3000.0, orders=[2])
    point = soft.at((0.1, -0.2, 0.1), on="support")
    still = soft.cancel(HEAD, [(point, (0, 1, 0))])
    assert still.read("residual")[0] < 1e-9
    moved = still.response.at((0.1, -0.2, 0.1), on="support").velocity[2]
    assert abs(moved.y) < 1e-9 * abs(point.velocity[2].y)
    mounts = P.response([800.0, 3000.0], orders=[2]).cancel([HEAD, SIDE], "mount_force")
    least = mounts.before.cancel([HEAD, SIDE], "mount_force", norm="largest")
    force = [c.response.mount_force[2].peak[k].max()
             for c in (mounts, least) for k in (0, 1)]  # fmt: skip
    assert force[2] < force[0]
    assert force[3] < force[1]
    wrongs: list[tuple[dict[str, Any], str]] = [
        ({"norm": "max"}, "norm = 'max'"),
        ({"norm": "largest", "effort": 0.1}, r"effort = 0\.1"),
    ]
    for wrong, said in wrongs:
        with pytest.raises(cp.InputError, match=said):
            mounts.before.cancel(HEAD, "mount_force", **wrong)
    with pytest.raises(cp.InputError, match="receivers = 'roof'"):
        r.cancel(HEAD, ["roof"])


@in_turn("seed", range(8))
def test_superposition_limits_and_balance_of_random_powertrains(seed: int) -> None:
    p, actuators, points = random_case(seed)
    rpm = np.array([700.0, 2000.0, 4100.0])
    before = p.response(rpm, orders=[1, 2, 4])
    c = before.cancel(actuators, points, orders=[1, 2])
    r = c.response
    assert (c.utilisation <= 1.0 + 1e-9).all()
    assert (c.response.forces[:, 2] == 0.0).all()
    assert np.array_equal(r.motion[:, 2], before.motion[:, 2])
    assert (c.residual[~np.isnan(c.residual)] <= 1.0 + 1e-12).all()
    # Sum of the mounts' forces on the body: loads of engine and actuators, and inertia.
    mass = p.body.mass * np.eye(6)
    mass[3:, 3:] = p.body.inertia
    rate = np.multiply.outer(rpm, [1, 2, 4]) * (2.0 * np.pi / 60.0)
    inertia = rate[..., None] ** 2 * (r.motion @ mass)
    size = np.abs(r.wrench).max() + np.abs(inertia).max()
    # Some hundred roundings of what is added up.
    assert np.abs(r.wrench + inertia - r.support_wrench).max() < 1e-12 * size
    pushed = np.abs(r.wrench[..., :3] - before.wrench[..., :3])
    along = np.einsum(
        "soa,ai->soi", c.response.forces, np.array([one.direction for one in actuators])
    )
    assert pushed == pytest.approx(np.abs(along), abs=1e-12 * size)
    arms = np.array([one.at for one in actuators]) - np.array(p.body.cg)
    directions = np.array([one.direction for one in actuators])
    turned = np.einsum("soa,ai->soi", c.response.forces, np.cross(arms, directions))
    assert np.abs(r.wrench[..., 3:] - before.wrench[..., 3:] - turned).max() < 1e-12 * size
    lost = r.power_lost.sum(axis=-1)
    reactive = rate * np.linalg.norm(r.wrench, axis=-1) * np.linalg.norm(r.motion, axis=-1)
    assert (np.abs(r.power_in - lost) <= 1e-12 * reactive).all()
    one = r.sel(rpm=2000.0)
    assert one.motion == pytest.approx(r.motion[1, ...], rel=1e-12)
    assert np.array_equal(r[3].body_force.xyz, before[3].body_force.xyz)
    tight = [each.replace(force=0.1) for each in actuators]
    left, least = (
        np.nan_to_num(each.residual) for each in (before.cancel(tight, points, orders=[1, 2]), c)
    )
    assert (left >= least - 1e-9).all()


def test_further_actuators_act_beside_those_before() -> None:
    first = one_channel([1500.0, 3000.0], force=50.0)
    point = (0.1, 0.1, 0.1)
    second = first.response.cancel(SIDE.replace(stroke=None), [point])
    at = [r.at(point).velocity.xyz for r in (first.response, second.response)]
    left, before = (np.linalg.norm(each, axis=-1) for each in reversed(at))
    assert left / before == pytest.approx(second.residual, rel=1e-9)
    assert second.response.actuators == (*first.actuators, *second.actuators)
    # Forces superpose: what each adds to the motion without actuators.
    alone = (
        one._driven(one.actuators, one.read("forces"), engine_runs=False) for one in (first, second)
    )
    summed = first.before.motion + sum(each.motion for each in alone)
    size = 1e-12 * np.abs(summed).max()
    assert second.response.motion == pytest.approx(summed, rel=0, abs=size)


def test_limits_are_those_of_motor_and_stroke() -> None:
    free = one_channel()
    force = abs(free.forces[0, 0])
    half = one_channel(force=0.5 * force)
    assert abs(half.forces[0, 0]) == pytest.approx(0.5 * force, rel=1e-9)
    # Of one channel what is left is what the limit misses.
    assert half.read("residual")[0] == pytest.approx(0.5, rel=1e-9)
    stroke = force / (2 * (2 * math.pi * 100.0) ** 2)
    short = one_channel(mass=2, stroke=0.25 * stroke)
    assert short.read("residual")[0] == pytest.approx(0.75, rel=1e-9)
    assert short.actuators[0].stroke_of(abs(short.forces[0, 0]), 100.0) == pytest.approx(
        0.25 * stroke
    )
    # At its resonance the motor has but the damping to overcome.
    shaker = cp.Actuator(
        "s", (0, 0, 0), (0, 3, 4), force=10, mass=2, resonance=20, damping_ratio=0.1
    )
    assert shaker.largest_force(20.0) == pytest.approx(10 / 0.2)
    assert shaker.largest_force(2e4) == pytest.approx(10, rel=1e-5)
    assert shaker.direction == (0.0, 0.6, 0.8)
    assert shaker.motor_force(50.0, 20.0) == pytest.approx(10)


def test_effort_gives_up_a_little_for_smaller_forces() -> None:
    before = P.response(3000, orders=[2])
    plain = before.cancel([HEAD, SIDE], "mount_force")
    light = before.cancel([HEAD, SIDE], "mount_force", effort=0.1)
    assert np.linalg.norm(light.forces) < np.linalg.norm(plain.forces)
    assert plain.read("residual")[0] < light.read("residual")[0] < 1.0


def test_a_cancelling_shaft_out_of_phase() -> None:
    c = one_channel().with_error(phase_deg=5.0)
    assert c.read("residual") == pytest.approx([0.087238775] * 2, rel=6e-8)
    both = one_channel().with_error(amplitude=0.1, phase_deg=-20.0).read("residual")[0]
    assert both == pytest.approx(abs(1 - 1.1 * np.exp(-1j * math.radians(20))), rel=1e-9)
    attenuation = -20 * math.log10(one_channel().with_error(phase_deg=5.73).read("residual")[0])
    assert attenuation == pytest.approx(20.0, abs=0.01)


def test_what_is_raised_elsewhere_is_said() -> None:
    rpm = np.arange(800.0, 3000.0, 200.0)
    c = P.response(rpm, orders=[2, 4, 6]).cancel(
        HEAD, [SEAT], orders=[2], watch={"top": (0, 0.4, 0)}
    )
    assert "Raised at some speed:" in c.table.note
    assert "Orders 4, 6: as before." in c.table.note
    assert {"minimised", "elsewhere"} == {*c.table["role"].values}
    assert {"top", "body", "mount 0.22 0.28"} <= {*c.table["place"].values}
    raised = c.response.at((0, 0.4, 0)).velocity[2].peak > c.before.at((0, 0.4, 0)).velocity[2].peak
    at_most = [
        row[7]
        for row in zip(*(column.values for column in c.table.columns), strict=True)
        if row[0] == "top" and row[2] == 2
    ]
    assert raised.any() == (at_most[0] > 1.0)
    shaker = HEAD.replace(force=60.0)
    both = P.response(3000, orders=[2, 4]).cancel(shaker, [SEAT])
    assert "Limits hold order by order: all together can need" in both.table.note
    assert len(c.frames["actuators"]) == 1


# --- a law that adapts ----------------------------------------------------------------------------


@pytest.mark.parametrize(("delay", "limit"), [(0, 2.0), (1, 1.0), (2, 0.61803399), (3, 0.44504187)])
def test_largest_step_of_updates_that_are_late(delay: int, limit: float) -> None:
    law = one_channel().adaptive(update_delay=delay)
    assert law.read("largest_step") == pytest.approx([limit] * 2, rel=6e-8)
    for share, stable in ((0.99, True), (1.01, False)):
        near = one_channel().adaptive(update_delay=delay, step=share * limit)
        assert (near.stable == stable).all()
        assert ((near.rate > 0.0) == stable).all()


@in_turn("seed", range(8))
def test_largest_step_is_where_roots_leave_the_unit_circle(seed: int) -> None:
    draw = np.random.default_rng(seed)
    delay, phase = int(draw.integers(0, 4)), float(draw.uniform(-80, 80))
    law = one_channel().adaptive(update_delay=delay, phase_error_deg=phase)
    expected = again.largest_step(delay, math.radians(phase))
    assert law.read("largest_step")[0] == pytest.approx(expected, rel=1e-6)


def test_convergence_with_a_wrong_phase() -> None:
    law = one_channel().adaptive(step=0.05, phase_error_deg=45.0)
    assert law.residual(100)[0, -1] == pytest.approx(0.02923388, rel=6e-8)
    assert 10 ** (-law.read("rate")[0] / 20) ** 1 == pytest.approx(
        0.02923388 ** (1 / 100), rel=1e-8
    )
    assert not one_channel().adaptive(phase_error_deg=91.0).stable.any()


def test_a_delay_of_a_quarter_of_the_period_is_fatal() -> None:
    law = one_channel().adaptive()
    assert 1e3 * law.critical_delay == pytest.approx([2.5, 1.25], rel=1e-12)
    before, beyond = (one_channel().adaptive(delay=d, step=1e-3) for d in (2.49e-3, 2.51e-3))
    assert before.stable[0]
    assert not beyond.stable[0]
    assert before.residual(2000)[0, -1] < 1.0 < beyond.residual(2000)[0, -1]


def test_several_channels_come_to_what_is_optimal() -> None:
    before = P.response([900.0, 3000.0], orders=[2])
    c = before.cancel([HEAD, SIDE.replace(stroke=None)], [(0.2, -0.1, 0.4), (-0.2, 0.1, 0)])
    law = c.adaptive(step=1.0)
    assert law.residual(20_000)[..., -1] == pytest.approx(c.residual, rel=1e-6)
    assert law.residual(0)[..., 0] == pytest.approx(1.0)


# --- velocity fed back ----------------------------------------------------------------------------


def bouncing(mass: float, frequency: float, damping: float) -> cp.Powertrain:
    """A body that moves up and down alone under a force at its CG."""
    stiffness = mass * (2 * math.pi * frequency) ** 2
    viscous = 2 * damping * math.sqrt(stiffness * mass)
    mounts = [
        cp.Mount(f"{x} {z}", (x, 0, z), stiffness / 4, damping=viscous / 4)
        for x in (0.3, -0.3)
        for z in (0.3, -0.3)
    ]
    return cp.Powertrain(I4, cp.RigidBody(mass, (0, 0, 0), (7, 8, 4.5)), mounts)


def test_largest_gain_of_an_inertial_actuator() -> None:
    p = bouncing(150.0, 8.0, 0.04)
    actuator = cp.Actuator("a", (0, 0, 0), (0, 1, 0), mass=3, resonance=5, damping_ratio=0.3)
    f = p.velocity_feedback(actuator)
    assert f.largest_gain == pytest.approx(4823.8109, rel=6e-8)
    assert f.margin_db == pytest.approx(20 * math.log10(2))
    assert f.ratio([8.0])[0] < 1.0
    assert "margin 6.021 dB" in f.table.note
    beyond = p.velocity_feedback(actuator, gain=5000.0)
    assert beyond.margin_db < 0.0
    assert ", unstable: margin" in beyond.table.note


@in_turn("seed", range(8))
def test_largest_gain_is_that_of_routh(seed: int) -> None:
    draw = np.random.default_rng(seed)
    body = (draw.uniform(50, 300), draw.uniform(4, 25), draw.uniform(0.01, 0.2))
    own = (draw.uniform(1, 9), draw.uniform(2, 15), draw.uniform(0.05, 0.6))
    actuator = cp.Actuator(
        "a", (0, 0, 0), (0, 1, 0), mass=own[0], resonance=own[1], damping_ratio=own[2]
    )
    found = bouncing(*body).velocity_feedback(actuator).largest_gain
    assert found == pytest.approx(again.largest_gain(body, own), rel=1e-6)


def growth(
    p: cp.Powertrain, actuator: cp.Actuator, damping: np.ndarray, gain: float
) -> tuple[float, float]:
    """Return the largest real part of the roots of powertrain and actuator, over the frequency.

    ``damping`` is the viscous one of each mount. Also the least distance to the axis of a root.
    """
    mass, stiffness = (np.array(each) for each in p._core.matrices(None))
    count = len(mass)
    rows = np.array(p._core.deflections())[:, :, :6]
    viscous = np.zeros((count, count))
    for row, along in zip(rows, damping, strict=True):
        viscous[:6, :6] += row.T @ np.diag(along) @ row
    assert count == 6
    place = np.zeros(7)
    place[:3] = actuator.direction
    place[3:6] = np.cross(np.subtract(actuator.at, p.body.cg), actuator.direction)
    both = place.copy()
    both[6] = -1.0
    moving, omega = float(actuator.mass or 0), 2 * np.pi * float(actuator.resonance or 0)
    m, k, c = np.diag([0.0] * 6 + [moving]), np.zeros((7, 7)), np.zeros((7, 7))
    m[:6, :6], k[:6, :6], c[:6, :6] = mass, stiffness.real, viscous
    k += moving * omega**2 * np.outer(both, both)
    c += 2.0 * actuator.damping_ratio * moving * omega * np.outer(both, both)
    c += gain * np.outer(both, place)
    inverse = np.linalg.inv(m)
    whole = np.block([[np.zeros((7, 7)), np.eye(7)], [-inverse @ k, -inverse @ c]])
    roots = np.linalg.eigvals(whole)
    share = roots.real / np.abs(roots)
    return float(share.max()), float(np.abs(share).min())


@in_turn("seed", range(60))
def test_largest_gain_is_that_of_eigenvalues_or_nothing_damps_a_mode(seed: int) -> None:
    """Systems of few values: of mounts and actuator all, some or none are damped."""
    draw = np.random.default_rng(seed)
    damping = draw.choice([0.0, 0.0, 60.0, 300.0], (4, 3)) * draw.choice([0.0, 1.0, 1.0])
    mounts = [
        mount.replace(damping=tuple(each), loss_factor=0.0, tilt_deg=draw.choice([0.0, 35.0]))
        for mount, each in zip(FOUR, damping, strict=True)
    ]
    p = P.replace(mounts=mounts)
    actuator = cp.Actuator(
        "a",
        tuple(draw.choice([0.0, 0.1, 0.2], 3)),
        (*draw.choice([0.0, 1.0], 2), 1.0),
        mass=draw.choice([1.0, 4.0]),
        resonance=draw.choice([2.0, 5.0, 12.0]),
        damping_ratio=draw.choice([0.0, 0.1, 0.4]),
    )
    try:
        found = p.velocity_feedback(actuator)
    except cp.InputError as error:
        said = str(error)
    else:
        limit = found.largest_gain
        assert growth(p, actuator, damping, 0.999 * limit)[0] < 0.0
        assert growth(p, actuator, damping, 1.001 * limit)[0] > 0.0
        return
    assert said.startswith("nothing damps the mode at ")
    # A root is on the axis without gain; where nothing is damped any gain makes one grow.
    assert growth(p, actuator, damping, 0.0)[1] < 1e-9
    if not damping.any() and actuator.damping_ratio == 0.0:
        for gain in (1e-3, 1.0, 1e3):
            assert growth(p, actuator, damping, gain)[0] > 0.0


def test_feedback_asks_for_damping_of_what_it_drives() -> None:
    bare = P.replace(mounts=[mount.replace(loss_factor=0.0) for mount in FOUR])
    with pytest.raises(cp.InputError, match=r"^nothing damps the mode at .*damping_ratio"):
        bare.velocity_feedback(SIDE.replace(resonance=4))
    # The mounts' damping is enough, and so is damping along what it drives.
    assert P.velocity_feedback(SIDE.replace(resonance=4)).largest_gain > 0.0
    up = cp.Actuator("up", BODY.cg, (0, 1, 0), mass=2, resonance=4)
    along = [mount.replace(loss_factor=(0, 0.1, 0)) for mount in FOUR]
    assert P.replace(mounts=along).velocity_feedback(up).onset is not None


def test_feedback_is_that_within_the_tables_of_stiffness() -> None:
    frequency = np.array([1.0, 30.0, 200.0])
    stiffness = np.multiply.outer(np.ones(3), np.array([1.5e5, 3e5, 1.2e5]) * (1 + 0.1j))
    measured = [mount.replace(loss_factor=0.0, table=(frequency, stiffness)) for mount in FOUR]
    actuator = SIDE.replace(resonance=4, damping_ratio=0.2)
    plain = P.velocity_feedback(actuator)
    found = P.replace(mounts=measured).velocity_feedback(actuator)
    assert found.largest_gain == pytest.approx(plain.largest_gain, rel=1e-9)
    assert "within the tables of stiffness, 1 to 200 Hz" in found.table.note
    short = [mount.replace(table=(frequency[1:], stiffness[1:])) for mount in measured]
    with pytest.raises(cp.InputError, match=r"^tables of stiffness have 30 to 200 Hz in common: "):
        P.replace(mounts=short).velocity_feedback(actuator)


# --- inputs ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"direction": (0, 0, 0)}, "direction = .*above zero"),
        ({"at": (0, 1)}, "at = .*three numbers"),
        ({"force": -1}, "force = -1.0: give a number that is more than zero"),
        ({"stroke": 0.001}, "stroke = 0.001: give mass"),
        ({"resonance": 5}, "resonance = 5: give mass"),
        ({"damping_ratio": 0.1}, "damping_ratio = 0.1: .*resonance"),
        ({"mass": True}, "mass"),
    ],
)
def test_impossible_actuators_are_rejected(change: dict[str, Any], said: str) -> None:
    with pytest.raises(cp.InputError, match=said):
        HEAD.replace(**change)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"actuators": []}, "actuators = "),
        ({"actuators": [HEAD, HEAD]}, "actuators.1..name = .*own name"),
        ({"actuators": [3]}, "actuators.0. = 3"),
        ({"receivers": []}, "receivers = "),
        ({"receivers": "bodyforce"}, 'receivers = .*give "body_force" or "mount_force"'),
        ({"receivers": [((0, 0, 0), (0, 0, 0))]}, "receivers: direction"),
        ({"receivers": [(0, 0)]}, "receivers"),
        ({"orders": [3]}, "orders = 3: is not among the orders"),
        ({"effort": -1}, "effort = -1"),
    ],
)
def test_impossible_cancellations_are_rejected(given: dict[str, Any], said: str) -> None:
    response = P.response(3000, orders=[2, 4])
    arguments: dict[str, Any] = {"actuators": HEAD, "receivers": [SEAT], **given}
    with pytest.raises(cp.InputError, match=said):
        response.cancel(arguments.pop("actuators"), arguments.pop("receivers"), **arguments)


def test_impossible_laws_and_feedbacks_are_rejected() -> None:
    c = one_channel()
    for arguments, said in [
        ({"step": 0}, "step"),
        ({"delay": -1}, "delay"),
        ({"update_delay": -1}, "update_delay"),
    ]:
        with pytest.raises(cp.InputError, match=said):
            c.adaptive(**arguments)
    with pytest.raises(cp.InputError, match="actuator = 'head': give mass and resonance"):
        P.velocity_feedback(HEAD)
    with pytest.warns(UserWarning, match="stroke = 4 m: was it given in millimetres"):
        HEAD.replace(mass=2, stroke=4)


def test_records_are_rebuilt() -> None:
    c = one_channel()
    for each in (HEAD, c, c.response, c.adaptive(), P.velocity_feedback(SIDE.replace(resonance=4))):
        assert pickle.loads(pickle.dumps(each)) == each  # noqa: S301 - our own
        assert hash(each) == hash(copy.deepcopy(each))
