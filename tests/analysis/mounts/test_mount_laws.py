"""Do forces, moments and power of random engines on random mounts balance?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

PRESETS = ("single", "i4", "v6-60", "v8-crossplane")


def random_case(seed: int) -> tuple[cp.Powertrain, np.ndarray]:
    """Return a random powertrain and random speeds."""
    draw = np.random.default_rng(seed)
    engine = cp.Engine.preset(PRESETS[seed % len(PRESETS)])
    weight = cp.Unbalance(draw.uniform(0, 0.02), z=draw.uniform(-0.3, 0.3), angle_deg=30)
    engine = engine.with_counterweights([*engine.counterweights, weight])
    root = draw.normal(size=(3, 3))
    moments = root @ root.T + np.eye(3)
    inertia = np.trace(moments) * np.eye(3) - moments
    body = cp.RigidBody(150.0, tuple(draw.uniform(-0.2, 0.2, 3)), inertia, products="tensor")
    mounts = [
        cp.Mount(
            f"{k}",
            tuple(draw.uniform(-0.5, 0.5, 3)),
            tuple(draw.uniform(5e4, 4e5, 3)),
            tilt_deg=draw.uniform(-180, 180),
            loss_factor=tuple(draw.uniform(0.02, 0.3, 3)),
            damping=tuple(draw.uniform(0, 500, 3)),
        )
        for k in range(draw.integers(3, 7))
    ]
    return cp.Powertrain(engine, body, mounts), draw.uniform(300, 6000, 4)


@in_turn("seed", range(12))
def test_forces_moments_and_power_balance(seed: int) -> None:
    p, rpm = random_case(seed)
    r = p.response(rpm, rtol=1e-6)
    rate = np.multiply.outer(rpm, np.array(r.orders)) * (2.0 * np.pi / 60.0)
    mass = p.body.mass * np.eye(6)
    mass[3:, 3:] = p.body.inertia
    inertia = rate[..., None] ** 2 * (r.motion @ mass)
    size = np.linalg.norm(r.wrench, axis=-1) + np.linalg.norm(inertia, axis=-1)
    size += np.linalg.norm(r.support_wrench, axis=-1)
    # Some hundred roundings of what is added up.
    assert (np.linalg.norm(r.wrench + inertia - r.support_wrench, axis=-1) <= 1e-12 * size).all()
    forces = np.stack([r.mount_force[name].xyz for name in p.names], axis=-2)
    arms = np.array([mount.at for mount in p.mounts]) - np.array(p.body.cg)
    moments = np.cross(arms, forces).sum(axis=-2)
    whole = np.concatenate([forces.sum(axis=-2), moments], axis=-1)
    assert (np.linalg.norm(whole - r.support_wrench, axis=-1) <= 1e-12 * size).all()
    reactive = rate * np.linalg.norm(r.wrench, axis=-1) * np.linalg.norm(r.motion, axis=-1)
    assert (np.abs(r.power_in - r.power_lost.sum(axis=-1)) <= 1e-12 * reactive).all()
    assert (r.power_lost >= 0.0).all()


@in_turn("seed", range(6))
def test_load_is_the_balance_about_the_cg(seed: int) -> None:
    p, rpm = random_case(seed)
    r = p.response(rpm[0], orders=[1, 2, 4])
    assert p.engine is not None
    b = p.engine.balance(rpm[0], orders=[1, 2, 4]).about(p.body.cg)
    expected = np.concatenate(
        [b.force.xy, np.zeros((3, 1)), b.moment.xy, b.torque.phasor[:, None]], axis=-1
    )
    # Rounding of what cancels: of the largest force and its lever.
    assert np.abs(r.wrench - expected).max() <= 1e-12 * np.abs(expected).max()


@in_turn("seed", range(6))
def test_points_orders_and_speeds_agree_however_they_are_read(seed: int) -> None:
    p, rpm = random_case(seed)
    r = p.response(rpm, orders=[0.5, 1, 2, 4])
    at_cg = r.at(p.body.cg)
    assert at_cg.displacement.xyz == pytest.approx(r.motion[..., :3], abs=1e-18)
    one = r.sel(rpm=float(rpm[2]))
    assert np.array_equal(one.motion, r.motion[2, ...])
    point = one.at((0.1, 0.2, 0.3))
    rate = 1j * 2.0 * np.pi / 60.0 * rpm[2] * np.array(r.orders)[:, None]
    assert point.velocity.xyz == pytest.approx(rate * point.displacement.xyz)
    assert point.acceleration.xyz == pytest.approx(rate * point.velocity.xyz)
    theta = np.radians(np.arange(0, 720, 0.5))
    waves = np.exp(1j * np.multiply.outer(theta, np.array(r.orders)))
    sampled = (waves @ point.velocity.xyz).real
    peaks = np.array([*point.velocity.total.peak_xyz, point.velocity.total.peak])
    found = np.append(np.abs(sampled).max(axis=0), np.linalg.norm(sampled, axis=1).max())
    # Samples at half degrees of order 4 miss 1 − cos(1°) at most.
    assert (peaks >= found * (1 - 1e-12)).all()
    assert (peaks <= found * (1 + 2e-4) + 1e-18).all()
    rms = np.sqrt((sampled**2).mean(axis=0))
    assert point.velocity.total.rms_xyz == pytest.approx(rms)
    other = one[3].body_force
    assert np.array_equal(other.xyz, p.response(float(rpm[2]), orders=[3]).body_force.xyz[0])
    assert one.total == one["all"]
    assert one.total.body_force.peak == one.body_force.total.peak
    worst = r.worst()
    peaks_of_mounts = [r.mount_force[name].peak.max() for name in p.names]
    assert worst.force == max(peaks_of_mounts)
    assert r.mount_force[worst.mount][worst.order].peak.max() == worst.force


def lever(at: np.ndarray, cg: np.ndarray) -> np.ndarray:
    """Return the motion of a point, of displacement of the CG and rotation: (3, 6)."""
    x, y, z = at - cg
    return np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])


def moved_by_force(
    p: cp.Powertrain, rpm: np.ndarray, at: np.ndarray, along: np.ndarray
) -> cp.results.DrivenResponse:
    """Return the response to 1 N of order 1 alone."""
    pusher = cp.Actuator("pusher", tuple(at), tuple(along))
    request = p.response(rpm, orders=[1])._request
    forces = np.ones((len(rpm), 1, 1), complex)
    return cp.results.DrivenResponse(p, rpm, request, (pusher,), forces, engine_runs=False)


@in_turn("seed", range(8))
def test_motion_is_reciprocal_across_two_stages(seed: int) -> None:
    """Push on the block, look at the rail; push on the rail, look at the block.

    Of the second experiment the subframe is the body that stands on all mounts, and the block,
    free, is the receptance that carries the upper ones.
    """
    upper, rpm = random_case(seed)
    below, _ = random_case(seed + 100)
    lower = [mount.replace(name=f"ground {mount.name}") for mount in below.mounts]
    draw = np.random.default_rng(1000 + seed)
    block_at, rail_at = draw.uniform(-0.5, 0.5, (2, 3))
    # Actuators make their direction one of length 1.
    block_along, rail_along = (v / np.linalg.norm(v) for v in draw.normal(size=(2, 3)))
    rpm = np.sort(rpm)
    one = moved_by_force(
        upper.with_support(cp.Subframe(below.body, lower)), rpm, block_at, block_along
    )
    there = one.at(rail_at, on="support").displacement.xyz[:, 0] @ rail_along

    cg, mass = np.array(upper.body.cg), upper.body.mass * np.eye(6)
    mass[3:, 3:] = upper.body.inertia
    # Beyond the speeds at both ends, which are inside but for rounding.
    frequency = np.array([0.9 * rpm[0], *rpm, 1.1 * rpm[-1]]) / 60.0
    free = -np.linalg.inv(mass) / (2.0 * np.pi * frequency[:, None, None]) ** 2
    levers = np.vstack([lever(np.array(mount.at), cg) for mount in upper.mounts])
    transfer = {"block": (lever(block_at, cg) @ free @ levers.T).astype(complex)}
    pairs = [(name, axis) for name in upper.names for axis in "xyz"]
    table = (frequency, (levers @ free @ levers.T).astype(complex))
    hung = cp.Powertrain(upper.engine, below.body, [*upper.mounts, *lower])
    other = moved_by_force(
        hung.with_support(cp.Receptance(pairs, table, transfer)), rpm, rail_at, rail_along
    )
    back = other.at("block").displacement.xyz[:, 0] @ block_along
    # Two factorisations of the same dozen of equations, the second one after a subtraction.
    assert back == pytest.approx(there, rel=1e-9)


@in_turn("seed", range(6))
def test_moments_about_a_point_are_those_of_the_balance_and_of_the_mounts(seed: int) -> None:
    p, rpm = random_case(seed)
    r = p.response(rpm, orders=[1, 2, 4])
    point = tuple(np.random.default_rng(seed).uniform(-0.4, 0.4, 3))
    moved = r.about(point)
    assert p.engine is not None
    b = p.engine.balance(rpm[0], orders=[1, 2, 4]).about(point)
    moments = [[b[n].moment.x, b[n].moment.y, b[n].torque.phasor] for n in r.orders]
    size = np.abs(moved.wrench[0, ...]).max()
    # Some roundings of forces times arms below a metre.
    np.testing.assert_allclose(moved.wrench[0, :, 3:], moments, rtol=0, atol=1e-13 * size)
    np.testing.assert_array_equal(moved.wrench[..., :3], r.wrench[..., :3])
    forces = np.stack([r.mount_force[name].xyz for name in p.names], axis=-2)
    arms = np.array([mount.at for mount in p.mounts]) - np.array(point)
    sums = np.cross(arms, forces).sum(axis=-2)
    size = np.abs(moved.support_wrench).max()
    np.testing.assert_allclose(moved.support_wrench[..., 3:], sums, rtol=0, atol=1e-12 * size)
    np.testing.assert_array_equal(moved.motion, r.motion)
    assert moved.sel(rpm=rpm[1])[2].wrench.tolist() == moved[2].wrench[1].tolist()
    assert r.about(p.body.cg).wrench.tolist() == r.wrench.tolist()
    auto = p.response(rpm, rtol=1e-3)
    bound, about = auto.error_bound, auto.about(point).error_bound
    assert about["force"] == bound["force"]
    assert about["moment"] >= bound["moment"]
    assert str(tuple(map(float, point))) in moved.sel(rpm=rpm[0]).frames["loads"].title


def test_power_is_a_frame_whose_columns_balance() -> None:
    p, rpm = random_case(3)
    one = p.response(rpm[0], orders=[1, 2, 4])
    frame = one.frames["power"]
    assert frame["order"].values == (1, 2, 4, "all")
    put_in = np.array(frame["put in"].values)
    lost = np.array([frame[name].values for name in p.names])
    np.testing.assert_array_equal(put_in[:-1], one.power_in)
    np.testing.assert_array_equal(lost[:, :-1].T, one.power_lost)
    np.testing.assert_allclose(put_in[-1], lost[:, -1].sum(), rtol=1e-10)
    assert "passed on" not in frame
    raft = cp.Subframe(p.body, p.mounts)
    assert "passed on" in p.with_support(raft).response(rpm[0], orders=[2]).frames["power"]


@in_turn("seed", range(6))
def test_slow_motion_is_that_at_rest(seed: int) -> None:
    """Of gas pressure, whose torque does not fall with speed, on mounts with viscous damping."""
    p, _ = random_case(seed)
    cylinder = cp.Cylinder(0.043, 0.145, 0.45, bore=0.086)
    fired = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    p = p.replace(engine=fired, mounts=[each.replace(loss_factor=0.0) for each in p.mounts])
    r = p.response(1e-6, orders=[2, 4])
    state = p.static(torque=-1.0)
    unit = np.append(state.wind_up, np.radians(state.wind_up_deg))
    # ωc/k: 4e-7 rad/s, 500 N·s/m and 5e4 N/m.
    for load, motion in zip(r.wrench[:], r.motion[:], strict=True):
        size = np.abs(load[5] * unit).max()
        assert motion == pytest.approx(load[5] * unit, rel=0, abs=1e-7 * size)


@in_turn("seed", range(6))
def test_fast_motion_is_that_of_a_free_body(seed: int) -> None:
    p, _ = random_case(seed)
    soft = [each.replace(stiffness=1e3, damping=0.0) for each in p.mounts]
    p = p.replace(mounts=soft)
    at, along = np.random.default_rng(seed).normal(size=(2, 3))
    rpm = np.array([6000.0])
    moved = moved_by_force(p, rpm, 0.3 * at, along)
    mass = p.body.mass * np.eye(6)
    mass[3:, 3:] = p.body.inertia
    free = -np.linalg.solve(mass, moved.wrench[0, 0]) / (2.0 * np.pi * 100.0) ** 2
    # Stiffness over inertia at 628 rad/s: six mounts of 1e3 N/m, half a metre off, 3 kg·m².
    assert moved.motion[0, 0] == pytest.approx(free, rel=0, abs=1e-2 * np.abs(free).max())
    assert np.abs(moved.motion[0, 0] - free).max() > 0.0


# --- what is shown, and where the engine has no load ----------------------------------------------


def test_a_shown_response_computes_what_it_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    r = random_case(1)[0].response(np.linspace(500, 6000, 20_000), rtol=1e-4)
    counted = []
    whole = cp._core.peaks_of_vectors

    def counting(orders: list[float], rows: np.ndarray) -> np.ndarray:
        counted.append(len(rows))
        return whole(orders, rows)

    monkeypatch.setattr("crankpin.analysis.labelled._core.peaks_of_vectors", counting)
    vectors = 1 + len(r.powertrain.names)
    for shown, rows in ((repr, 30), (lambda each: each._repr_html_(), 60)):
        for result in (r, r[2], r.total):
            counted.clear()
            text = shown(result.frames if result is not r else result)
            assert 0 < sum(counted) <= 3 * vectors * rows * len(r.orders)
            assert f"{rows} of 20000 rows" in text
    # What is shown is the beginning of the whole.
    few = r.sel(rpm=500.0).powertrain.response(np.asarray(r.rpm)[:200], rtol=1e-4)
    lines = repr(few).splitlines()
    assert lines[2:20] == few.table.text().splitlines()[2:20]
    assert len(few.table) == 200


@in_turn("seed", range(12))
def test_there_is_a_ratio_only_where_the_engine_has_a_load(seed: int) -> None:
    p, _ = random_case(seed)
    p = p.replace(engine=cp.Engine.preset(("i4", "i6", "v8-crossplane", "single")[seed % 4]))
    # Between two cranks of degrees rounding is never far.
    assert p.engine is not None
    for about in (None, (0.1, 0.05, p.engine.reference_z)):
        r = p.response(3000.0, orders=[1, 2, 3, 4])
        r = r if about is None else r.about(about)
        load, ratio = np.abs(r.wrench), r.transmissibility
        size = np.linalg.norm(load, axis=-1, keepdims=True)
        assert (np.isnan(ratio) == (load == 0.0)).all()
        # No load beside rounding of the others of its order.
        assert (load[load > 0.0] > 1e-12 * np.broadcast_to(size, load.shape)[load > 0.0]).all()
        known = ~np.isnan(ratio)
        assert r.transmissibility_db[known] == pytest.approx(20.0 * np.log10(ratio[known]))
        assert "T F_y dB" in r.frames["loads"].header or not known[:, 1].any()


def test_free_motions_are_all_named() -> None:
    p, _ = random_case(3)
    loose = p.replace(mounts=[mount.replace(stiffness=(0, 1e5, 0)) for mount in p.mounts[:2]])
    assert len(loose.modes().free) > 1
    with pytest.warns(UserWarning, match="are free, as of a body") as warned:
        loose.response(1000.0, orders=[1])
    for words in loose.modes().free:
        assert words in str(warned[0].message)


def test_a_table_that_ends_says_which_argument_keeps_within_it() -> None:
    p, _ = random_case(2)
    table = ([1.0, 200.0], np.full((2, 3), 1e5 * (1 + 0.1j)))
    measured = p.replace(
        mounts=[m.replace(loss_factor=0, damping=0, table=table) for m in p.mounts]
    )
    with pytest.raises(cp.InputError, match=r"is outside: .*; extend the table, or give orders="):
        measured.response(6000.0)
    assert measured.response(6000.0, orders=[1, 2]).orders == (1, 2)
