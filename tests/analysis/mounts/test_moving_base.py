"""Do powertrains on a base that moves follow the laws that they should?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from analysis.mounts.test_mount_laws import random_case
from analysis.mounts.test_soil import bushings
from rederivation import moving_base as again
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

REST = np.zeros(6, dtype=complex)
RATE = {"displacement": 0, "velocity": 1, "acceleration": 2}


def springs_of(mounts: Sequence[cp.Mount], omega: float) -> list[again.Spring]:
    """The springs of mounts at an angular speed, from their figures alone."""
    found = []
    for m in mounts:
        t = np.radians(m.tilt_deg or 0.0)
        axes = np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])
        along = np.array(m.stiffness) * (1 + 1j * np.array(m.loss_factor))
        about = np.array(m.rotational_stiffness) * (1 + 1j * np.array(m.rotational_loss_factor))
        along = along + 1j * omega * np.array(m.damping)
        about = about + 1j * omega * np.array(m.rotational_damping)
        found.append(again.Spring(np.array(m.at), axes, along, about))
    return found


def body_of(body: cp.RigidBody) -> again.Body:
    return again.Body(body.mass, np.array(body.cg), np.array(body.inertia))


def drawn(seed: int, count: int = 3) -> tuple[cp.BaseMotion, np.random.Generator]:
    """A random motion of a base at a few frequencies, of few values so that some coincide."""
    draw = np.random.default_rng(seed)
    frequencies = draw.choice([0.5, 4.0, 8.0, 15.0, 60.0], count, replace=False)
    size = draw.choice([0.0, 1e-4, 2e-3], (count, 6))
    turned = np.exp(1j * draw.choice([0.0, 0.5, np.pi], (count, 6)))
    size[:, 1] = 1e-3
    of = draw.choice([*RATE])
    about = tuple(draw.choice([0.0, 0.3, -0.5], 3))
    motion = dict(zip(frequencies.tolist(), (size * turned).tolist(), strict=True))
    return cp.BaseMotion(motion, of, about=about), draw


def displaced(base: cp.BaseMotion, frequency: float) -> np.ndarray:
    """Displacement and rotation of a base at its own point."""
    return np.array(base.motion[frequency]) / (2j * np.pi * frequency) ** RATE[base.of]


@in_turn("seed", range(12))
def test_motion_and_forces_are_those_of_single_springs(seed: int) -> None:
    p, _ = bushings(seed)
    base, draw = drawn(seed)
    r = p.response(base=base)
    point = draw.uniform(-0.5, 0.5, 3)
    moved = np.asarray(r.at(point).velocity)
    body, about = body_of(p.body), np.array(base.about)
    assert r.coords["frequency"].tolist() == [*base.motion]
    for k, frequency in enumerate(base.motion):
        omega = 2 * np.pi * frequency
        g, springs = displaced(base, frequency), springs_of(p.mounts, omega)
        q = again.motion_on_base(springs, body, omega, g, about, REST)
        # Some thousand roundings of a well-conditioned solution.
        close = {"rtol": 0.0, "atol": 1e-10 * np.abs(q).max()}
        np.testing.assert_allclose(np.asarray(r.motion)[k, 0], q, **close)
        at = 1j * omega * again.displacement(q, body.cg, point)
        np.testing.assert_allclose(moved[k, 0], at, **(close | {"atol": 1e-10 * np.abs(at).max()}))
        forces = np.asarray(r.mount_force)[k, 0]
        for spring, force in zip(springs, forces, strict=True):
            stretch = again.displacement(q, body.cg, spring.at)
            stretch = stretch - again.displacement(g, about, spring.at)
            expected, _ = again.wrench_on_ends(spring, stretch, REST[:3])
            size = np.abs(spring.along).max() * (np.abs(q).max() + np.abs(g).max())
            assert np.abs(force - expected).max() <= 1e-11 * size
        inertia = -again.inertia_of(body, omega, q)
        wrench = np.asarray(r.support_wrench)[k, 0]
        # Without a load the mounts bear the body's inertia alone.
        assert np.abs(wrench - inertia).max() <= 1e-9 * np.abs(inertia).max() + 1e-12
        at_cg = np.concatenate([again.displacement(g, about, body.cg), g[3:]])
        np.testing.assert_allclose(np.asarray(r.base_motion)[k, 0], at_cg, rtol=1e-12, atol=1e-18)


@in_turn("seed", range(8))
def test_two_bodies_are_those_of_single_springs(seed: int) -> None:
    above, _ = bushings(seed)
    below, _ = bushings(seed + 40)
    p = above.with_support(cp.Subframe(below.body, below.mounts))
    base, _ = drawn(seed)
    r = p.response(base=base)
    for k, frequency in enumerate(base.motion):
        omega = 2 * np.pi * frequency
        upper = springs_of(above.mounts, omega), body_of(above.body)
        lower = springs_of(below.mounts, omega), body_of(below.body)
        g, about = displaced(base, frequency), np.array(base.about)
        q = again.motions_on_base(upper, lower, omega, g, about, REST)
        found = np.concatenate([np.asarray(r.motion)[k, 0], np.asarray(r.subframe_motion)[k, 0]])
        np.testing.assert_allclose(found, q, rtol=0.0, atol=1e-9 * np.abs(q).max())
        whole = again.of_springs(lower[0], lower[1], q[6:], g, about)
        ground = np.asarray(r.ground_force)[k, 0]
        assert np.abs(ground + whole[:3]).max() <= 1e-9 * np.abs(whole).max()


@in_turn("seed", range(6))
def test_an_engine_on_a_base_that_moves_is_the_sum_of_both(seed: int) -> None:
    p, rpm = random_case(seed)
    rows = {1: (1e-4, 2e-4j, 0), 1.5: (0, 1e-4, 0, 0, 1e-4, 0)}
    base = cp.BaseMotion(rows, by="order", about=(0, -0.3, 0.1))
    both = p.response(rpm, orders=[1, 1.5, 2], base=base)
    own = p.response(rpm, orders=[1, 1.5, 2])
    for j, order in enumerate((1, 1.5)):
        for k, speed in enumerate(rpm):
            alone = cp.BaseMotion({order * speed / 60: rows[order]}, about=base.about)
            floor = p.response(base=alone)
            for name in ("motion", "support_wrench", "mount_force"):
                sums = np.asarray(getattr(own, name))[k, j] + np.asarray(getattr(floor, name))[0]
                found = np.asarray(getattr(both, name))[k, j]
                assert np.abs(found - sums).max() <= 1e-10 * np.abs(sums).max()
    np.testing.assert_array_equal(np.asarray(both.motion)[:, 2], np.asarray(own.motion)[:, 2])
    np.testing.assert_array_equal(both.wrench, own.wrench)
    assert np.isnan(np.asarray(both.base_transmissibility)[:, 2]).all()
    total = both.power_lost.sum(axis=-1) + both.power_passed
    size = np.abs(both.power_in) + np.abs(both.power_passed)
    assert (np.abs(both.power_in - total) <= 1e-10 * size).all()
    every = p.response(rpm, base=base)
    assert every.orders == tuple(sorted({*p.response(rpm).orders, 1, 1.5}))


@in_turn("seed", range(6))
def test_slowly_the_body_moves_with_its_base(seed: int) -> None:
    p, _ = bushings(seed)
    rows = {1e-4: (1e-3, -2e-3, 1e-3, 1e-3, 2e-3, -1e-3)}
    for powertrain in (p, p.with_support(cp.Subframe(p.body, p.mounts))):
        r = powertrain.response(base=cp.BaseMotion(rows, about=(0.1, 0.2, 0.3)))
        # The inertia over the stiffness, at a ten-thousandth of a hertz.
        assert np.abs(r.motion - r.base_motion).max() < 1e-8
        point = (0.3, 0.4, -0.2)
        np.testing.assert_allclose(r.at(point).base_transmissibility, 1.0, rtol=1e-6)
        np.testing.assert_allclose(r.base_transmissibility, 1.0, rtol=1e-6)


@in_turn("seed", range(6))
def test_a_rigid_motion_of_base_and_body_is_that_of_its_inertia(seed: int) -> None:
    """(K − ω²M)(q − g) = ω²Mg: seen from the base, the body is loaded by its own inertia."""
    p, _ = bushings(seed)
    base, _ = drawn(seed)
    r = p.response(base=base)
    mass = p.body.mass * np.eye(6)
    mass[3:, 3:] = p.body.inertia
    for k, frequency in enumerate(base.motion):
        omega = 2 * np.pi * frequency
        g = np.asarray(r.base_motion)[k, 0]
        inertia = omega**2 * mass @ g
        table = cp.ForceTable(60 * frequency, None, {1: tuple(inertia)}, about=p.body.cg)
        relative = p.replace(engine=None, forces=table).response(60 * frequency)
        found = np.asarray(r.motion)[k, 0] - g
        expected = np.asarray(relative.motion)[0]
        assert np.abs(found - expected).max() <= 1e-9 * (np.abs(expected).max() + np.abs(g).max())


@in_turn("seed", range(6))
def test_what_the_base_does_to_a_point_a_force_there_does_to_the_base(seed: int) -> None:
    """Reciprocity: displacement by that of the base is force on the base by force at the point."""
    p, _ = bushings(seed)
    omega = 2 * np.pi * 9.0
    point, about = np.array([0.2, 0.3, -0.1]), np.array([0.1, -0.4, 0.2])
    transfer, forces = np.empty((3, 6), complex), np.empty((6, 3), complex)
    for j, unit in enumerate(np.eye(6)):
        base = cp.BaseMotion({9.0: tuple(unit)}, about=tuple(about))
        transfer[:, j] = np.asarray(p.response(base=base).at(point).displacement)[0]
    for i, unit in enumerate(np.eye(3)):
        table = cp.ForceTable(540.0, None, {1: (*unit, 0, 0, 0)}, about=tuple(point))
        r = p.replace(engine=None, forces=table).response(540.0).about(about)
        forces[:, i] = np.asarray(r.support_wrench)[0]
    # Some thousand roundings of a well-conditioned solution.
    assert np.abs(transfer - forces.T).max() <= 1e-10 * np.abs(transfer).max()
    assert omega > 0.0


@pytest.mark.parametrize(
    ("damping", "ratio", "expected"),
    [
        ({"damping": 0.1}, 4.0, 0.085253826),
        ({"loss": 0.2}, 4.0, 0.067980884),
        ({"loss": 0.2}, 1.0, 5.0990195),
        ({"damping": 0.1}, 1.0, 5.0990195),
    ],
)
def test_one_degree_of_freedom_passes_motion_as_it_passes_force(
    damping: dict[str, float], ratio: float, expected: float
) -> None:
    mass, stiffness = 100.0, 4e5
    natural = np.sqrt(stiffness / mass)
    viscous = 2 * damping.get("damping", 0.0) * mass * natural
    corners = [(x, 0.0, z) for x in (0.3, -0.3) for z in (0.3, -0.3)]
    mounts = [
        cp.Mount(
            f"{k}", at, stiffness / 4, loss_factor=damping.get("loss", 0.0), damping=viscous / 4
        )
        for k, at in enumerate(corners)
    ]
    table = cp.ForceTable(60.0, None, {1: (0, 1, 0, 0, 0, 0)})
    p = cp.Powertrain(table, cp.RigidBody(mass, (0, 0, 0), (9, 9, 9)), mounts)
    frequency = ratio * natural / (2 * np.pi)
    force = p.response(60 * frequency, orders=1).transmissibility[0, 1]
    motion = p.response(base=cp.BaseMotion({frequency: (0, 1e-3, 0)})).base_transmissibility[0, 1]
    # Figures of eight digits.
    assert force == pytest.approx(expected, rel=6e-8)
    assert motion == pytest.approx(force, rel=1e-12)


def test_a_block_on_soil_follows_the_ground_and_then_its_inertia() -> None:
    body = cp.RigidBody.block(width=4, height=2.5, length=6)
    ground = cp.Soil(6e7, 0.35, 1800, 0.03).mount(body, width=4, length=6, y=-2.5)
    p = cp.Powertrain(None, body, [ground])
    rows = dict.fromkeys((0.01, 5.0, 500.0), (1e-4, 0, 0))
    r = p.response(base=cp.BaseMotion(rows))
    t = np.asarray(r.at((0, 0, 0)).base_transmissibility)[:, 0, 0]
    assert t[0] == pytest.approx(1.0, abs=1e-5)
    assert t[2] < 0.1
    omega = 2 * np.pi * 5.0
    g = np.array([1e-4, 0, 0, 0, 0, 0])
    q = again.motion_on_base(
        springs_of([ground], omega), body_of(body), omega, g, np.zeros(3), REST
    )
    np.testing.assert_allclose(np.asarray(r.motion)[1, 0], q, rtol=0, atol=1e-11 * np.abs(q).max())


def test_results_are_read_by_frequency() -> None:
    p, _ = bushings(3)
    base = cp.BaseMotion({5: (0, 0.1, 0), 20: (0, 0.3, 0)}, of="acceleration")
    r: Any = p.response(base=base)
    assert r.dims == ("frequency",)
    assert r.body_force.shape == (2, 1, 3)
    one = r.sel(frequency=20)
    assert one.frequency == 20.0
    np.testing.assert_array_equal(np.asarray(one.motion)[0], np.asarray(r.motion)[1, 0])
    assert list(one.frames)[:3] == ["table", "loads", "power"]
    assert "at 20 Hz" in one.table.text()
    assert "engine" not in "".join(column.name for column in one.frames["loads"].columns)
    assert r.table.columns[0].data.tolist() == [5.0, 20.0]
    acceleration = p.response(base=base).at(p.body.cg).acceleration
    ratio = np.asarray(acceleration.peak_xyz)[:, 0, 1] / np.array([0.1, 0.3])
    expected = np.asarray(r.base_transmissibility)[:, 0, 1]
    np.testing.assert_allclose(ratio, expected, rtol=1e-12)
    assert one.power_passed[1] < 0.0 < one.power_lost.sum()
    assert one[1].body_force.peak == np.asarray(one.body_force.peak)[0]
    for name in ("base_motion", "base_transmissibility"):
        assert not hasattr(p.response(900), name)
    assert not hasattr(p.response(900).at((0, 0, 0)), "base_transmissibility")


def test_an_instrument_needs_no_engine(tmp_path: Path) -> None:
    p, _ = bushings(2)
    alone = p.replace(engine=None)
    base = cp.BaseMotion({7.0: (0, 1e-4, 0)})
    np.testing.assert_array_equal(alone.response(base=base).motion, p.response(base=base).motion)
    np.testing.assert_array_equal(alone.modes().frequency, p.modes().frequency)
    with pytest.raises(cp.InputError, match="nothing shakes the body"):
        alone.response(900)
    for ending in ("toml", "json"):
        alone.save(path := tmp_path / f"alone.{ending}")
        assert cp.Powertrain.load(path) == alone


def test_motions_are_read_from_files(tmp_path: Path) -> None:
    path = tmp_path / "floor.csv"
    path.write_text(
        "Frequency [Hz],y [mm/s],phase y [deg],about z [rad/s]\n5.0,2,90,0\n10,3,0,0.01\n"
    )
    base = cp.BaseMotion.from_csv(path, about=(0, -0.1, 0))
    np.testing.assert_allclose(base.motion[5.0], [0, 2e-3j, 0, 0, 0, 0], atol=1e-18)
    np.testing.assert_allclose(base.motion[10.0], [0, 3e-3, 0, 0, 0, 0.01], atol=1e-18)
    assert base == cp.BaseMotion(dict(base.motion), "velocity", about=(0.0, -0.1, 0.0))
    path.write_text("order;x g;z g\n1;0.1;0\n1.5;0;0.2\n")
    base = cp.BaseMotion.from_csv(path)
    assert [*base.motion[1.5]] == [0, 0, 0.2 * 9.80665, 0, 0, 0]
    assert base == cp.BaseMotion(dict(base.motion), "acceleration", "order")
    path.write_text("frequency,y\n5,1e-4\n10,2e-4\n")
    assert cp.BaseMotion.from_csv(path).of == "displacement"
    cases = [
        ("frequency,up\n1,2\n3,4\n", "has a column 'up'"),
        ("y,z\n1,2\n3,4\n", "has no column frequency"),
        ("frequency,phase y\n1,2\n3,4\n", "has no column of motion"),
        ("frequency,x [mm],y [g]\n1,2,3\n4,5,6\n", "has columns of acceleration and displacement"),
        ("frequency,x [furlong]\n1,2\n3,4\n", "furlong"),
    ]
    for text, said in cases:
        path.write_text(text)
        with pytest.raises(cp.InputError, match=said):
            cp.BaseMotion.from_csv(path)


def test_impossible_bases_are_rejected() -> None:
    p, _ = bushings(1)
    base = cp.BaseMotion({5.0: (0, 1e-4, 0)})
    wrong: Any = [
        ({}, {}, "motion = {}"),
        ({5.0: (1, 2)}, {}, r"motion\[5.0\] has 2 numbers"),
        ({0.0: (1, 2, 3)}, {}, "motion = 0.0"),
        ({1.3: (1, 2, 3)}, {"by": "order"}, "motion"),
        ({5.0: (1, np.nan, 3)}, {}, r"motion\[5.0\]"),
        ({5.0: (1, 2, 3)}, {"of": "jerk"}, "of = 'jerk'"),
        ({5.0: (1, 2, 3)}, {"about": (1, 2)}, "about"),
    ]
    for motion, options, said in wrong:
        with pytest.raises(cp.InputError, match=said):
            cp.BaseMotion(motion, **options)
    asked: Any = [
        ({"rpm": 900, "base": base}, "rpm = 900: leave it out"),
        ({"orders": [1], "base": base}, "orders = "),
        ({"base": 3}, "base = 3: give a crankpin.BaseMotion"),
        ({}, "rpm = None: give crank speeds, or a base"),
        ({"base": cp.BaseMotion({1: (0, 1, 0)}, by="order")}, "rpm = None"),
    ]
    for options, said in asked:
        with pytest.raises(cp.InputError, match=said):
            p.response(**options)
    r: Any = p.response(base=base)
    with pytest.raises(cp.InputError, match="order = 2: the base moves by frequency"):
        _ = r[2].body_force.peak
    with pytest.raises(cp.InputError, match="cancel is undefined"):
        r.cancel(cp.Actuator("a", at=(0, 0, 0), direction=(0, 1, 0), force=1), "body_force")
    with pytest.raises(cp.InputError, match="kind = 'map'"):
        p.response(base=cp.BaseMotion(dict.fromkeys((5, 6), (0, 1, 0)))).plot(kind="map")
    none = {"loss_factor": 0, "damping": 0, "rotational_damping": 0, "rotational_loss_factor": 0}
    stiff = cp.Powertrain(None, p.body, [m.replace(**none) for m in p.mounts])
    mode = float(stiff.modes().frequency[0])
    with pytest.raises(cp.InputError, match=r"^frequency = .*unbounded"):
        stiff.response(base=cp.BaseMotion({mode: (1, 1, 1, 1, 1, 1)}))
    table = ([1.0, 10.0], np.full((2, 3), 1e5 + 1e4j))
    measured = p.replace(mounts=[cp.Mount("a", (0, 0, 0), 1e5, table=table), *p.mounts[1:]])
    with pytest.raises(cp.InputError, match="20 Hz, is outside"):
        measured.response(base=cp.BaseMotion({20.0: (0, 1e-4, 0)}))
    plain = cp.Powertrain(
        None, p.body, [cp.Mount(f"{k}", m.at, 1e5) for k, m in enumerate(p.mounts)]
    )
    panel = cp.Receptance([("0", "y")], ([1.0, 100.0], np.full((2, 1, 1), 1e-7)))
    with pytest.raises(cp.InputError, match="support = a receptance"):
        plain.with_support(panel).response(base=base)
