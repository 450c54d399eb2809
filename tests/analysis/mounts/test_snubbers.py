"""Is a powertrain on snubbers where its energy is least, and does it move about that?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from rederivation import snubbers
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

PLACES = [(0.3, -0.1, 0.1), (-0.3, -0.1, 0.1), (0.0, 0.2, 0.5), (0.3, 0.0, 0.5)]
ENGINE = cp.Engine.preset("i4")
AXES = [np.eye(3), np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])]


def drawn(seed: int) -> tuple[cp.Powertrain, dict[str, Any]]:
    """Return a powertrain and a case, of few figures, so that gaps and deflections coincide.

    Of some of them Newton's whole steps go round in a circle.
    """
    draw = np.random.default_rng(seed)
    mounts = [
        cp.Mount(
            f"{k}",
            at=at,
            stiffness=draw.choice([1e4, 1e5, 2e5], 3),
            axes=AXES[draw.integers(2)],
            gap=draw.choice([0.0, 0.001, 0.002], (3, 2)).tolist(),
            snubber_stiffness=draw.choice([0.0, 2e5, 1e6, 1e8], (3, 2)).tolist(),
            loss_factor=0.1,
        )
        for k, at in enumerate(PLACES[: draw.integers(3, 5)])
    ]
    body = cp.RigidBody(160.0, (0.0, draw.choice([0.0, 0.1]), 0.2), (7.0, 8.0, 4.5))
    case = {
        "torque": draw.choice([0.0, 500.0, -1500.0]),
        "acceleration": draw.choice([0.0, 8.0, -4.0], 3).tolist(),
        "thrust": draw.choice([0.0, 500.0], 3).tolist(),
    }
    return cp.Powertrain(ENGINE, body, mounts), case


def again(p: cp.Powertrain) -> list[snubbers.Snubbed]:
    return [
        snubbers.Snubbed(*map(np.array, (m.at, m.axes, m.stiffness, m.gap, m.snubber_stiffness)))
        for m in p.mounts
    ]


def load_of(p: cp.Powertrain, case: dict[str, Any]) -> np.ndarray:
    """Weight, torque and thrust about the centre of gravity."""
    falling = np.array([0.0, -9.80665, 0.0]) - case["acceleration"]
    push = np.array(case["thrust"])
    force = p.body.mass * falling + push
    moment = np.cross(-np.array(p.body.cg), push) - [0.0, 0.0, case["torque"]]
    return np.concatenate([force, moment])


def motion_of(state: cp.results.StaticState) -> np.ndarray:
    shift = np.asarray(state.sag) + state.wind_up + state.thrust_shift
    turn = np.asarray(state.sag_deg) + state.wind_up_deg + state.thrust_deg
    return np.concatenate([shift, np.radians(turn)])


@in_turn("seed", range(150))
def test_energy_is_least_at_rest(seed: int) -> None:
    p, case = drawn(seed)
    mounts, cg, load = again(p), np.array(p.body.cg), load_of(p, case)
    state = p.static(**case)
    motion, least = motion_of(state), snubbers.at_rest(mounts, cg, load)
    # Roundings of SciPy's solution of up to 30 unknowns, of stiffnesses 1e4 apart.
    np.testing.assert_allclose(motion, least, rtol=0, atol=1e-9 * np.abs(least).max())
    newtons = 1e-6 * np.abs(load).max()
    for step in 1e-5 * np.vstack([np.eye(6), -np.eye(6)]):
        assert snubbers.energy(mounts, cg, load, motion + step) > snubbers.energy(
            mounts, cg, load, motion
        )
    # Forces are in equilibrium, and those of the energy.
    for k, mount in enumerate(mounts):
        along = mount.rows(cg) @ least
        np.testing.assert_allclose(state.deflection[k], along, rtol=0, atol=1e-11)
        np.testing.assert_allclose(state.travel[k], mount.axes.T @ along, rtol=0, atol=1e-11)
        beyond = np.maximum(np.stack([-along, along], axis=-1) - mount.gap, 0.0) * mount.further
        pushed = mount.stiffness * along - beyond[:, 0] + beyond[:, 1]
        np.testing.assert_allclose(state.preload[k], mount.axes.T @ pushed, rtol=0, atol=newtons)
        np.testing.assert_allclose(
            state.snubber_force[k], beyond[:, 1] - beyond[:, 0], rtol=0, atol=newtons
        )


def stiffened(mounts: Sequence[cp.Mount], deflections: ArrayLike) -> list[cp.Mount]:
    """Return mounts with the stiffness of what acts at these deflections, and no snubbers."""
    plain = []
    for mount, along in zip(mounts, np.asarray(deflections), strict=True):
        # Nearer to its gap than rounding counts as touched; of two without play the stiffer.
        acts = np.stack([-along, along], axis=-1) - mount.gap >= -1e-13
        more = (np.array(mount.snubber_stiffness) * acts).max(axis=1)
        plain.append(
            mount.replace(
                gap=0.0, snubber_stiffness=0.0, stiffness=np.array(mount.stiffness) + more
            )
        )
    return plain


@in_turn("seed", range(4))
def test_motion_has_the_stiffness_of_snubbers_that_act_at_rest(seed: int) -> None:
    p, case = drawn(seed)
    p = p.replace(rest=case)
    linear = p.replace(mounts=stiffened(p.mounts, p.static(**case).deflection), rest=None)
    np.testing.assert_allclose(p.modes().frequency, linear.modes().frequency, rtol=1e-9)
    one, other = (each.response(2000, orders=[2]).body_force[2] for each in (p, linear))
    np.testing.assert_allclose(one, other, rtol=1e-9)
    assert p.axes().roll_stiffness == pytest.approx(linear.axes().roll_stiffness, rel=1e-9)
    vary = {"0": {"loss_factor": [0.1, 0.2]}}
    varied = [each.designs([1000, 2000], vary, orders=[2]) for each in (p, linear)]
    np.testing.assert_allclose(varied[0].body_force, varied[1].body_force, rtol=1e-9)
    bounds = [each.robustness(0.1, corners="mounts").frequency_bounds for each in (p, linear)]
    np.testing.assert_allclose(bounds[0], bounds[1], rtol=1e-9)


@in_turn("seed", range(20))
def test_limits_are_springs(seed: int) -> None:
    p, case = drawn(seed)
    plain = p.replace(mounts=[m.replace(gap=0.0, snubber_stiffness=0.0) for m in p.mounts])
    far = p.replace(mounts=[m.replace(gap=0.4) for m in p.mounts])
    soft = p.replace(mounts=[m.replace(snubber_stiffness=0.0) for m in p.mounts])
    for limit in (far, soft):
        assert (motion_of(limit.static(**case)) == motion_of(plain.static(**case))).all()
        assert not limit.static(**case).snubbers
        assert (limit.modes().frequency == plain.modes().frequency).all()
    tight = [m.replace(gap=0.0, snubber_stiffness=3e5) for m in p.mounts]
    stiff = [
        m.replace(gap=0.0, snubber_stiffness=0.0, stiffness=np.array(m.stiffness) + 3e5)
        for m in p.mounts
    ]
    one, other = (p.replace(mounts=mounts).static(**case) for mounts in (tight, stiff))
    scale = np.abs(motion_of(other)).max()
    np.testing.assert_allclose(motion_of(one), motion_of(other), rtol=0, atol=1e-12 * scale)
    frequencies = [p.replace(mounts=mounts).modes().frequency for mounts in (tight, stiff)]
    np.testing.assert_allclose(frequencies[0], frequencies[1], rtol=1e-12)


def test_three_mounts_bear_a_weight_by_equilibrium_alone() -> None:
    """Three mounts bear a weight by equilibrium alone, snubbed or not."""
    body = cp.RigidBody(160, (0.03, 0.1, 0.2), (7, 8, 4.5))
    mounts = [
        cp.Mount(name, at, 2e5, gap=[0, (0.0023, 0), 0], snubber_stiffness=[0, (8e5, 0), 0])
        for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
    ]
    p = cp.Powertrain(ENGINE, body, mounts)
    state = p.static()
    assert state.preload[:, 1] == pytest.approx([-638.8332, -481.9268, -448.304], abs=5e-5)
    # By hand: 2e5·d up to 2.3 mm, 1e6 beyond, which a and b reach.
    forces = np.array([638.8332, 481.9268, 448.304])
    by_hand = np.where(forces > 460, 0.0023 + (forces - 460) / 1e6, forces / 2e5)
    assert state.deflection[:, 1] == pytest.approx(-by_hand, abs=1e-9)
    assert state.snubbers == ("a −2", "b −2")
    assert "snubbers as at rest under gravity (act: a −2, b −2)" in repr(p.modes())


def test_snubbers_alone_hold_a_body_or_not() -> None:
    """Of mounts that are free up and down: it falls onto its snubbers; upwards none is there."""
    body = cp.RigidBody(100, (0.0, 0.1, 0.2), (7, 8, 4.5))
    stops: dict[str, Any] = {"gap": [0, (0.01, 0), 0], "snubber_stiffness": [0, (1e6, 0), 0]}
    places = [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7)), ("d", (0, 0, -0.3))]
    mounts = [cp.Mount(name, at, (1e5, 0, 1e5), **stops) for name, at in places]
    p = cp.Powertrain(ENGINE, body, mounts)
    state = p.static()
    assert len(state.snubbers) == 4
    assert state.deflection[:, 1].max() < -0.01
    assert state.preload[:, 1].sum() == pytest.approx(-980.665, rel=1e-12)
    assert not p.modes().free
    with pytest.raises(cp.InputError, match=r"^mounts = a, b, c, d: .* free: add a mount"):
        p.static(gravity=(0, 5, 0))
    # Without weight nothing pushes it out of its play, where it is not held.
    with pytest.raises(cp.InputError, match=r"free: add a mount"):
        p.static(gravity=(0, 0, 0))
    plain = [m.replace(snubber_stiffness=0.0) for m in mounts]
    assert cp.Powertrain(ENGINE, body, plain).modes().free


@in_turn("seed", range(10))
def test_a_subframe_has_snubbers_too(seed: int) -> None:
    """What bears on the ground is both weights; a stiff subframe is firm ground."""
    p, case = drawn(seed)
    base = [
        cp.Mount(f"g{k}", (x, -0.4, z), 1e7, gap=2e-5, snubber_stiffness=1e8)
        for k, (x, z) in enumerate([(0.4, 0), (-0.4, 0), (0, 0.6)])
    ]
    frame = cp.RigidBody(50, (0, -0.3, 0.2), (3, 4, 3))
    whole = p.with_support(cp.Subframe(frame, base))
    state, firm = whole.static(**case), p.static(**case)
    up = np.array([0, -9.80665, 0]) - case["acceleration"]
    total = (p.body.mass + 50) * up + case["thrust"]
    np.testing.assert_allclose(state.ground_preload.sum(axis=0), total, rtol=0, atol=1e-6)
    assert len(state.travel) == len(p.mounts) + 3
    cases = whole.load_cases({"a": case})
    assert (cases.ground_preload.sel(case="a") == state.ground_preload).all()
    assert len(cases.table.columns[0].values) == len(p.mounts) + 3
    # What is above follows the base as a rigid body.
    np.testing.assert_allclose(state.preload, firm.preload, rtol=0, atol=1e-6 * np.abs(total).max())
    assert any(name.startswith("subframe: g") for name in state.snubbers)
    count, deflections = len(p.mounts), state.deflection
    stiff = cp.Subframe(frame, stiffened(base, deflections[count:]))
    linear = p.replace(mounts=stiffened(p.mounts, deflections[:count]), support=stiff)
    frequency = whole.replace(rest=case).modes().frequency
    np.testing.assert_allclose(frequency, linear.modes().frequency, rtol=1e-9)


def test_files_keep_snubbers_and_the_case_at_rest(tmp_path: Path) -> None:
    p, case = drawn(3)
    p = p.replace(rest=case)
    for suffix in ("toml", "json"):
        p.save(tmp_path / f"p.{suffix}")
        read = cp.Powertrain.load(tmp_path / f"p.{suffix}")
        assert read == p
        assert read.rest == p.rest
        assert (read.modes().frequency == p.modes().frequency).all()
    assert p.replace(rest={}).rest is None


@pytest.mark.parametrize(
    ("figures", "words"),
    [
        ({"gap": -0.1}, r"^gap\[0\]\[0\] = -0.1"),
        ({"gap": [0.1, 0.2]}, r"^gap = \[0.1, 0.2\]: give a number, or for each of three axes"),
        ({"gap": [0.1, (0.1, 0.2, 0.3), 0]}, r"^gap\[1\] = \(0.1, 0.2, 0.3\): give a number"),
        ({"snubber_stiffness": float("nan")}, r"^snubber_stiffness\[0\]\[0\] = NaN"),
        ({"snubber_stiffness": [0, 0, (0, -1.0)]}, r"^snubber_stiffness\[2\]\[1\] = -1.0"),
        ({"snubber_stiffness": "stiff"}, r"^snubber_stiffness"),
    ],
)
def test_bad_snubbers_are_named(figures: dict[str, Any], words: str) -> None:
    with pytest.raises(cp.InputError, match=words):
        cp.Mount("a", (0, 0, 0), 1e5, **figures)


def test_figures_in_other_units_are_warned_of() -> None:
    with pytest.warns(UserWarning, match="gap of mount 'a' = 8 m: was it given in millimetres"):
        cp.Mount("a", (0, 0, 0), 1e5, gap=8, snubber_stiffness=1e6)
    with pytest.warns(UserWarning, match="snubber_stiffness of mount 'a' = 900 N/m"):
        cp.Mount("a", (0, 0, 0), 1e5, gap=0.008, snubber_stiffness=900)


def test_pages_reject_snubbers(tmp_path: Path) -> None:
    p, _ = drawn(3)
    with pytest.raises(cp.InputError, match=r"^snubber_stiffness of mount '0' is given"):
        p.save_html(tmp_path / "p.html")


def test_a_bad_case_is_named() -> None:
    p, _ = drawn(0)
    with pytest.raises(cp.InputError, match=r"^argument of rest = 'torqe': give .*torque"):
        p.replace(rest={"torqe": 3})
    with pytest.raises(cp.InputError, match=r"^rest = 3: give a mapping"):
        p.replace(rest=3)
    with pytest.raises(cp.InputError, match=r"^torque = 'engine': the engine has no cycle"):
        p.replace(rest={"torque": "engine"})
    hostile: list[Any] = [{}, [], 3]
    for wrong in hostile:
        with pytest.raises(cp.InputError, match=r"^cases = .*give a mapping"):
            p.load_cases(wrong)
    with pytest.raises(cp.InputError, match=r"^cases\['a'\] = 3: give a mapping"):
        p.load_cases({"a": 3})  # type: ignore[dict-item]
    with pytest.raises(cp.InputError, match=r"^acceleration"):
        p.load_cases({"a": {"acceleration": 3}})
    with pytest.raises(cp.InputError, match=r"^case = 'b': give \"a\""):
        p.load_cases({"a": {}}).sel(case="b")


@in_turn("seed", range(10))
def test_load_cases_are_states_at_rest(seed: int) -> None:
    p, case = drawn(seed)
    cases = p.load_cases({"rest": {}, "other": case, "tilted": {"gravity": (3, -9, 0)}})
    for name, arguments in (("rest", {}), ("other", case), ("tilted", {"gravity": (3, -9, 0)})):
        state = p.static(**arguments)
        assert cases.sel(case=name) == state
        for quantity, values in state.quantities.items():
            if quantity == "ground_preload":  # of a subframe
                assert not hasattr(cases, quantity)
                continue
            assert (cases.quantities[quantity].sel(case=name) == values).all()
    # An accelerated vehicle has another gravity.
    one, other = p.static(acceleration=(-3, 0, 0)), p.static(gravity=(3, -9.80665, 0))
    assert (motion_of(one) == motion_of(other)).all()
    assert one.support_margin == other.support_margin
    worst = {column.name: column.values for column in cases.frames["worst"].columns}
    lengths = np.linalg.norm(cases.travel, axis=-1)
    assert worst["largest travel"] == pytest.approx(1e3 * lengths.max(axis=0))
    assert worst["case of travel"] == tuple([*cases.states][k] for k in lengths.argmax(axis=0))
    assert len(cases.table.columns[0].values) == 3 * len(p.mounts)
