"""Do powertrains on a second stage pass the force, motion and power that they should?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest

if TYPE_CHECKING:
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
STAGES = FIXED.on(cp.Subframe(LOWER, four(4e5, 0.05)))
RPM = 25.0 * 60.0


def near(expected: object, rel: float = FIGURE) -> object:
    return pytest.approx(expected, rel=rel, abs=0.0)


def test_a_mass_on_a_mass() -> None:
    """1-D at 25 Hz: 150 kg on 1.2e6(1 + .1i) on 300 kg on 4e5(1 + .05i)."""
    r = STAGES.response(RPM, orders=[1])
    force = abs(r.load[0, 1])
    assert r.transmissibility[0, 1] == near(0.64278754)
    assert FIXED.response(RPM, orders=[1]).transmissibility[0, 1] == near(0.48162752)
    centre = r.at((0, 0, 0), on="support")
    assert centre.acceleration.peak_xyz[0, 1] / force == near(0.0022650131)
    moved = r.subframe_motion[0, 1]
    assert r.ground_force[1].y == near(4e5 * (1 + 0.05j) * moved, 1e-12)
    assert r.power_in[0] == near(r.power_lost.sum() + r.power_passed[0], 1e-12)
    assert r.power_passed[0] > 0.0
    assert FIXED.response(RPM, orders=[1]).power_passed[0] == 0.0


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
    whole, measured = STAGES.response(RPM), FIXED.on(as_receptance()).response(RPM, orders=[1, 2])
    assert measured[1].body_force.y == near(whole[1].body_force.y, 1e-12)
    rail = measured.at("seat rail")
    expected = whole.at((0, 0, 0), on="support")
    assert rail.velocity[2].y == near(expected.velocity[2].y, 1e-12)
    assert rail.grade == STAGES.response(RPM, orders=[1, 2]).at((0, 0, 0), on="support").grade
    total = measured.power_lost.sum(axis=-1) + measured.power_passed
    assert measured.power_in == near(total, 1e-11)


@pytest.mark.parametrize("kind", ["body", "receptance"])
def test_what_does_not_move_is_one_stage(kind: str) -> None:
    still: Any = cp.Subframe(LOWER.replace(mass=1e12, inertia=(1e12,) * 3), four(4e5, 0.05))
    if kind == "receptance":
        table = ([1.0, 500.0], np.zeros((2, 4, 4)))
        still = as_receptance().replace(table=table, receivers=None)
    speeds = [700.0, 2500.0]
    one, two = FIXED.response(speeds, rtol=1e-3), FIXED.on(still).response(speeds, rtol=1e-3)
    # The ratio of inertias.
    assert np.abs(two.motion - one.motion).max() <= 1e-8 * np.abs(one.motion).max()
    assert two.body_force.xyz == pytest.approx(one.body_force.xyz, abs=1e-8 * one.load.real.max())


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
        FIXED.on(other)
    with pytest.raises(cp.InputError, match="support = 3"):
        FIXED.replace(support=3)
    with pytest.raises(cp.InputError, match=r"70\.000000 Hz: order 2 at 2100 rpm, is outside"):
        FIXED.on(measured).response(2100.0, orders=[2])
    r = FIXED.response(RPM, orders=[1])
    for wrong in (lambda: r.at((0, 0, 0), on="support"), lambda: r.ground_force):
        with pytest.raises(cp.InputError, match="no subframe carries the mounts"):
            wrong()
    with pytest.raises(cp.InputError, match="point = 'seat rail': no receptance"):
        r.at("seat rail")
    with pytest.raises(cp.InputError, match="point = 'roof'"):
        FIXED.on(measured).response(RPM, orders=[1]).at("roof")


@pytest.mark.parametrize("support", [STAGES.support, as_receptance()])
def test_supports_read_back_from_files(
    tmp_path: Path, support: cp.Subframe | cp.Receptance
) -> None:
    p = FIXED.on(support)
    for name in ("p.toml", "p.json"):
        p.save(tmp_path / name)
        assert cp.Powertrain.load(tmp_path / name) == p
