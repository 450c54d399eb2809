"""Do powertrains on a second stage pass the force, motion and power that they should?"""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.frames import Framed
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

FIGURE = 6e-8
"""Relative error of figures of eight digits."""

SINGLE = cp.Engine.preset("single")
UPPER = cp.RigidBody(150.0, (0, 0, 0), (10, 10, 10))
LOWER = cp.RigidBody(300.0, (0, 0, 0), (20, 20, 20))
CORNERS = [(x, 0.0, z) for x in (0.3, -0.3) for z in (0.3, -0.3)]


def four(stiffness: float, loss: float) -> list[cp.Mount]:
    """Return four equal mounts at the corners of a square."""
    return [cp.Mount(f"{k}", at, stiffness / 4.0, loss_factor=loss) for k, at in enumerate(CORNERS)]


FIXED = cp.Powertrain(SINGLE, UPPER, four(1.2e6, 0.1))
STAGES = FIXED.with_support(cp.Subframe(LOWER, four(4e5, 0.05)))
RPM = 25.0 * 60.0


def near(expected: object, rel: float = FIGURE) -> object:
    return pytest.approx(expected, rel=rel, abs=0.0)


def test_a_mass_on_a_mass() -> None:
    """1-D at 25 Hz: 150 kg on 1.2e6(1 + .1i) on 300 kg on 4e5(1 + .05i)."""
    r = STAGES.response(RPM, orders=[1])
    force = abs(r.wrench[0, 1])
    assert r.transmissibility[0, 1] == near(0.64278754)
    assert FIXED.response(RPM, orders=[1]).transmissibility[0, 1] == near(0.48162752)
    centre = r.at((0, 0, 0), on="support")
    assert centre.acceleration.peak_xyz[0, 1] / force == near(0.0022650131)
    moved = r.subframe_motion[0, 1]
    assert r.ground_force[1].y == near(4e5 * (1 + 0.05j) * moved, 1e-12)
    assert r.power_in.item() == near(r.power_lost.sum() + r.power_passed.item(), 1e-12)
    assert r.power_passed[1] > 0.0
    assert FIXED.response(RPM, orders=[1]).power_passed[1] == 0.0


def as_receptance(receiver: bool = True) -> cp.Receptance:
    """Return the lower mass of `STAGES` as measured along y."""
    frequency = np.arange(20.0, 61.0, 5.0)
    omega = 2.0 * np.pi * frequency
    x = np.array([at[0] for at in CORNERS])
    z = np.array([at[2] for at in CORNERS])

    def under(inertia: float, stiffness: float) -> np.ndarray:
        return 1.0 / (stiffness * (1 + 0.05j) - inertia * omega**2)

    # Up and down, about z, about x: the springs are at the same corners.
    heave, roll, pitch = under(300, 4e5), under(20, 4e5 * 0.09), under(20, 4e5 * 0.09)
    values = (
        heave[:, None, None]
        + roll[:, None, None] * np.outer(x, x)
        + pitch[:, None, None] * np.outer(z, z)
    )
    # At the CG: along y alone.
    transfer = np.zeros((len(frequency), 3, 4), complex)
    transfer[:, 1, :] = heave[:, None]
    pairs = [(f"{k}", "y") for k in range(4)]
    points = {"seat rail": transfer} if receiver else None
    return cp.Receptance(pairs, (frequency, values), points)


def test_a_receptance_is_the_body_it_was_measured_on() -> None:
    whole, measured = (
        STAGES.response(RPM),
        FIXED.with_support(as_receptance()).response(RPM, orders=[1, 2]),
    )
    assert measured[1].body_force.y == near(whole[1].body_force.y, 1e-12)
    rail = measured.at("seat rail")
    expected = whole.at((0, 0, 0), on="support")
    assert rail.velocity[2].y == near(expected.velocity[2].y, 1e-12)
    assert rail.grade == STAGES.response(RPM, orders=[1, 2]).at((0, 0, 0), on="support").grade
    total = measured.power_lost.sum(axis=-1) + measured.power_passed
    assert measured.power_in == near(total, 1e-11)


@pytest.mark.filterwarnings("ignore:mass = 1e.12 kg")
@pytest.mark.parametrize("kind", ["body", "receptance"])
def test_what_does_not_move_is_one_stage(kind: str) -> None:
    still: Any = cp.Subframe(LOWER.replace(mass=1e12, inertia=(1e12,) * 3), four(4e5, 0.05))
    if kind == "receptance":
        table = ([1.0, 500.0], np.zeros((2, 4, 4)))
        still = as_receptance().replace(table=table, receivers=None)
    speeds = [700.0, 2500.0]
    one, two = (
        FIXED.response(speeds, rtol=1e-3),
        FIXED.with_support(still).response(speeds, rtol=1e-3),
    )
    # The ratio of inertias.
    assert np.abs(two.motion - one.motion).max() <= 1e-8 * np.abs(one.motion).max()
    assert two.body_force.xyz == pytest.approx(one.body_force.xyz, abs=1e-8 * one.wrench.real.max())


def test_impossible_supports_are_rejected() -> None:
    measured: Any = as_receptance()
    frequency, values = measured.table
    cases: list[tuple[dict[str, Any], str]] = [
        ({"coordinates": []}, r"table: receptance has shape|coordinates = \[\]"),
        ({"coordinates": [("0", "up")] * 4}, r"coordinates\[0\]\[1\] = 'up'"),
        ({"coordinates": [("0", "y")] * 4}, r"coordinates\[1\] = 0 y: is there twice"),
        ({"table": (frequency, np.abs(values) * (1 + 1j))}, "conjugate them"),
        ({"table": (frequency[::-1], values)}, "ascending"),
        ({"table": (frequency, np.array(values)[:, :1])}, "table: receptance has shape"),
        ({"table": (frequency, np.array(values) * np.nan)}, "give finite numbers, m/N"),
        ({"receivers": {"seat": np.zeros((9, 4, 3))}}, r"receivers\['seat'\] has shape"),
    ]
    for change, said in cases:
        with pytest.raises(cp.InputError, match=said):
            measured.replace(**change)
    other = measured.replace(coordinates=[("left", "y"), *measured.coordinates[1:]])
    with pytest.raises(cp.InputError, match=r"coordinates\[0\] = left: is no mount"):
        FIXED.with_support(other)
    with pytest.raises(cp.InputError, match="support = 3"):
        FIXED.replace(support=3)
    with pytest.raises(cp.InputError, match=r"70\.000000 Hz: order 2 at 2100 rpm, is outside"):
        FIXED.with_support(measured).response(2100.0, orders=[2])
    r = FIXED.response(RPM, orders=[1])
    for wrong in (lambda: r.at((0, 0, 0), on="support"), lambda: r.ground_force):
        with pytest.raises(cp.InputError, match="no subframe carries the mounts"):
            wrong()
    with pytest.raises(cp.InputError, match="point = 'seat rail': no receptance"):
        r.at("seat rail")
    with pytest.raises(cp.InputError, match="point = 'roof'"):
        FIXED.with_support(measured).response(RPM, orders=[1]).at("roof")


@pytest.mark.parametrize("support", [STAGES.support, as_receptance()])
def test_supports_read_back_from_files(
    tmp_path: Path, support: cp.Subframe | cp.Receptance
) -> None:
    p = FIXED.with_support(support)
    for name in ("p.toml", "p.json"):
        p.save(tmp_path / name)
        assert cp.Powertrain.load(tmp_path / name) == p


# --- every reading counts what carries the mounts, or says that it does not -----------------------

SOFT = [mount.replace(damping=(30.0, 20.0, 40.0)) for mount in FIXED.mounts]
SHAKER = cp.Actuator(
    "shaker", (0.3, 0, 0.3), (0, 1, 0), mass=2, resonance=3, damping_ratio=0.3, force=100
)
NEEDED: dict[str, dict[str, Any]] = {
    "response": {"rpm": [700.0, 2500.0], "orders": [1, 2]},
    "sweep": {"rpm": [700.0, 2500.0], "factor": [0.3, 0.6], "orders": [1, 2]},
    "designs": {"rpm": [700.0], "vary": {"0": {"stiffness": [1e5, 2e5]}}, "orders": [1]},
    "velocity_feedback": {"actuator": SHAKER},
    "save_html": {"path": "page.html"},
    "load_cases": {"cases": {"drive": {"torque": 100.0}}},
    "design_mounts": {"vary": "stiffness", "bounds": {"stiffness": (1e4, 1e6)}},
}
"""Arguments without which a reading cannot be called."""
REJECTED = {"designs", "design_mounts", "save_html"}
"""Readings of mounts on what does not move alone."""
ON_RECEPTANCES = {"response", "sweep"}
"""Readings that need no modes of the support."""
NOT_READINGS = {
    "load",
    "save",
    "with_support",
    "in_axes",
    "replace",
    "with_misfire",
    "view",
    *dir(Framed),
}
"""Methods that compute no figure; a view is the page of `save_html` in a notebook."""


def readings() -> dict[str, Any]:
    """Return all public methods of powertrains, and functions of the package on one, but inputs."""
    methods = inspect.getmembers(cp.Powertrain, callable)
    found = {name: each for name, each in methods if name[0] != "_" and name not in NOT_READINGS}
    for name in cp.__all__:
        if callable(each := getattr(cp, name)) and not inspect.isclass(each):
            first = next(iter(inspect.signature(each).parameters), "")
            found |= {name: each} if first == "powertrain" else {}
    return found


def numbers(result: cp.results.MountModes) -> list[str]:
    """Return the figures that a result prints, without words."""
    text = "\n".join(frame.text() for frame in result.frames.values())
    return re.findall(r"-?\d+\.?\d*(?:e[-+]\d+)?", text)


def test_readings_are_those_that_there_are() -> None:
    assert {"modes", "axes", "static", "robustness", *NEEDED} <= {*readings()}


@pytest.mark.parametrize("name", readings())
def test_no_reading_leaves_out_what_carries_the_mounts(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    firm = FIXED.replace(mounts=SOFT)
    frequency = np.array([0.01, 1e5])
    measured = as_receptance(receiver=False).replace(
        table=(frequency, np.full((2, 4, 4), 1e-6 - 1e-8j) * np.eye(4))
    )

    def read(support: Any) -> Any:  # noqa: ANN401 - a result
        return readings()[name](firm.with_support(support), **NEEDED.get(name, {}))

    plain = read(None)
    for support, kind in ((STAGES.support, "subframe"), (measured, "receptance")):
        if name in REJECTED or (kind == "receptance" and name not in ON_RECEPTANCES):
            with pytest.raises(cp.InputError, match=f"^support = a {kind}: "):
                read(support)
        else:
            found = read(support)
            assert numbers(found) != numbers(plain)
            assert kind in found.table.title


def test_refusals_are_one_sentence() -> None:
    said = set()
    for name in readings():
        if name not in (*ON_RECEPTANCES, "save_html"):
            with pytest.raises(cp.InputError) as error:
                readings()[name](FIXED.with_support(as_receptance()), **NEEDED.get(name, {}))
            said.add(str(error.value))
    assert len(said) == 1
    assert "give a subframe, or leave out the support" in said.pop()


def test_the_worst_force_is_near_one_of_twelve_modes_or_of_none() -> None:
    speeds = [900.0, RPM]
    modes = STAGES.modes().frequency
    worst = STAGES.response(speeds, orders=[1]).worst()
    assert len(modes) == 12
    assert worst.mode is not None
    assert worst.mode_frequency is not None
    assert worst.mode_frequency == modes[worst.mode - 1]
    nearest = np.abs(modes - worst.frequency).min()
    assert abs(worst.mode_frequency - worst.frequency) == nearest
    measured = FIXED.with_support(as_receptance()).response([RPM], orders=[1]).worst()
    assert (measured.mode, measured.mode_frequency) == (None, None)
    assert measured.force == near(STAGES.response([RPM], orders=[1]).worst().force, 1e-12)


def by_hand(p: cp.Powertrain) -> tuple[np.ndarray, np.ndarray]:
    """Return mass and stiffness of a powertrain on a subframe, from the equations of each body."""

    def moved(at: Sequence[float], cg: Sequence[float]) -> np.ndarray:
        x, y, z = np.subtract(at, cg)
        return np.hstack([np.eye(3), np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])])

    support: Any = p.support
    mass, stiffness = np.zeros((12, 12)), np.zeros((12, 12))
    for first, body in ((0, p.body), (6, support.body)):
        mass[first : first + 3, first : first + 3] = body.mass * np.eye(3)
        mass[first + 3 : first + 6, first + 3 : first + 6] = body.inertia
    for mounts, is_upper in ((p.mounts, True), (support.mounts, False)):
        for mount in mounts:
            t = np.radians(mount.tilt_deg or 0.0)
            axes = np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])
            rows = np.zeros((3, 12))
            if is_upper:
                rows[:, :6] = axes @ moved(mount.at, p.body.cg)
            sign = -1.0 if is_upper else 1.0
            rows[:, 6:] = sign * axes @ moved(mount.at, support.body.cg)
            along = mount.dynamic_stiffness or mount.stiffness
            stiffness += rows.T @ np.diag(along) @ rows
    return mass, stiffness


@in_turn("seed", range(20))
def test_twelve_modes_are_eigenvalues_of_both_bodies(seed: int) -> None:
    p = random_stages(seed)
    mass, stiffness = by_hand(p)
    factor = np.linalg.inv(np.linalg.cholesky(mass))
    squares = np.linalg.eigvalsh(factor @ stiffness @ factor.T)
    expected = np.sqrt(squares) / (2.0 * np.pi)
    modes = p.modes()
    # Eigenvalues keep half of the digits of the lowest.
    assert modes.frequency == pytest.approx(expected, rel=1e-7)
    assert modes.energy.sum(axis=0) == pytest.approx(np.full(12, 100.0))
    lower = modes.shapes[6:]
    share = 100.0 * np.einsum("im,ij,jm->m", lower, mass[6:, 6:], lower)
    assert modes.subframe_share == pytest.approx(share, abs=1e-9)
    # At rest: gravity on both bodies, a torque on the upper one.
    state = p.static(-70.0)
    loads = np.zeros((2, 12))
    loads[0, [1, 7]] = -9.80665 * p.body.mass, -9.80665 * p.support.body.mass  # type: ignore[union-attr]
    loads[1, 5] = 70.0
    at_rest = [m.replace(dynamic_stiffness=None) for m in p.mounts]
    _, static = by_hand(p.replace(mounts=at_rest))
    sag, wind_up = np.linalg.solve(static, loads.T).T
    assert state.sag == pytest.approx(sag[:3], abs=1e-9 * np.abs(sag).max())
    assert state.wind_up_deg == pytest.approx(np.degrees(wind_up[3:6]), rel=1e-6, abs=1e-9)
    firm = p.with_support(None).static(-70.0)
    assert state.preload == pytest.approx(firm.preload, abs=1e-7 * np.abs(firm.preload).max())
    weight = 9.80665 * (p.body.mass + p.support.body.mass)  # type: ignore[union-attr]
    assert state.ground_preload[:, 1].sum() == pytest.approx(-weight)
    assert 1.0 / p.axes().roll_stiffness == pytest.approx(wind_up[5] / 70.0, rel=1e-6)
    dynamic = np.linalg.solve(stiffness, loads[1])[5] / 70.0
    assert 1.0 / p.axes().dynamic_roll_stiffness == pytest.approx(dynamic, rel=1e-6)
    # Undamped, the motion of the response grows without bound at each of them.
    for k, f in enumerate(modes.frequency):
        gap = np.abs(np.delete(modes.frequency, k) - f).min() / f
        if gap > 1e-3:
            r = p.response([60.0 * f * (1.0 + 1e-7), 60.0 * f * (1.0 + 0.3 * gap)], orders=[1])
            size = np.abs(r.motion[:, 0]).max(axis=1)
            assert size[0] > 1e3 * size[1], (k, gap)


def random_stages(seed: int) -> cp.Powertrain:
    """Return a random powertrain on a random subframe, undamped, from few values."""
    draw = np.random.default_rng(seed)

    def body(mass: float) -> cp.RigidBody:
        return cp.RigidBody(
            mass, tuple(draw.choice([-0.1, 0.0, 0.2], 3)), draw.choice([6.0, 9.0], 3)
        )

    def mounts(count: int, scale: float) -> list[cp.Mount]:
        corners = [(x, y, z) for x in (0.3, -0.3) for z in (0.4, -0.3) for y in (0.0, -0.1)]
        return [
            cp.Mount(
                f"{k}",
                corners[place],
                tuple(scale * draw.choice([1e5, 2e5, 3e5], 3)),
                tilt_deg=float(draw.choice([0.0, 30.0, 110.0])),
            )
            for k, place in enumerate(draw.permutation(8)[:count])
        ]

    plain = mounts(4, 1.0)
    upper = [m.replace(dynamic_stiffness=[1.4 * k for k in m.stiffness]) for m in plain]
    # An engine that excites every direction.
    engine = cp.Engine.preset("single").with_counterweights(
        [cp.Unbalance(0.05, z=0.3, angle_deg=40)]
    )
    p = cp.Powertrain(engine, body(150.0), upper)
    return p.with_support(cp.Subframe(body(100.0), mounts(int(draw.integers(3, 6)), 3.0)))


def test_a_subframe_that_swings_by_itself_is_named_with_its_line() -> None:
    line = [cp.Mount(f"{x}", (x, -0.2, 0.1), 2e5) for x in (0.3, -0.3)]
    upper = cp.RigidBody(150.0, (0, 0.1, 0), (7, 8, 4.5))
    lower = cp.RigidBody(300.0, (0.1, -0.5, 0.3), (30, 35, 15))
    stiffer = [mount.replace(stiffness=4e5) for mount in line]
    free = cp.Powertrain(SINGLE, upper, line, cp.Subframe(lower, stiffer)).modes().free
    about = "about the line through (0.1, -0.2, 0.1) m along (1, 0, 0)"
    assert f"rotation of the subframe {about}" in free
