"""Are stiffness, modes and response those of the elastic energy and of motion in time?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from rederivation import mounts as again
from scipy.spatial.transform import Rotation
from support import in_turn


def random_powertrain(seed: int, engine: cp.Engine) -> tuple[cp.Powertrain, list[again.Spring]]:
    """Return a random body on four random mounts with viscous damping, and its springs."""
    draw = np.random.default_rng(seed)
    root = draw.normal(size=(3, 3))
    moments = root @ root.T + np.eye(3)
    inertia = np.trace(moments) * np.eye(3) - moments
    body = cp.RigidBody(150.0, tuple(draw.uniform(-0.1, 0.1, 3)), inertia, products="tensor")
    mounts, springs = [], []
    for k in range(4):
        axes = Rotation.from_rotvec(draw.normal(size=3)).as_matrix()
        at = draw.uniform(-0.4, 0.4, 3)
        stiffness, damping = draw.uniform(1e5, 4e5, 3), draw.uniform(200.0, 900.0, 3)
        springs.append(again.Spring(at, axes, stiffness, damping))
        mounts.append(cp.Mount(f"{k}", tuple(at), stiffness, axes=axes, damping=tuple(damping)))
    return cp.Powertrain(engine, body, mounts), springs


CYLINDER = cp.Cylinder(0.045, 0.14, 0.6)
TWIN = cp.Engine.from_lists(CYLINDER, tdc_deg=[0, 130], bank_deg=[90, 90], z=[-0.07, 0.11])


@in_turn("seed", range(6))
def test_frequencies_are_those_of_the_curvature_of_the_energy(seed: int) -> None:
    p, springs = random_powertrain(seed, TWIN)
    cg = np.array(p.body.cg)
    stiffness = again.curvature(springs, cg, "stiffness")
    mass = again.mass_matrix(p.body.mass, np.array(p.body.inertia))
    # Second differences are right to the square of their step.
    assert p.modes().frequency == pytest.approx(again.frequencies(mass, stiffness), rel=1e-6)


@in_turn("seed", range(3))
def test_response_is_the_steady_motion_in_time(seed: int) -> None:
    p, springs = random_powertrain(seed, TWIN)
    rpm, cg = 900.0, np.array(p.body.cg)
    omega = 2.0 * np.pi * rpm / 60.0
    parts = [
        again.slider_crank_loads(np.radians(tdc), z, 0.045, 0.14, 0.6)
        for tdc, z in zip(TWIN.tdc_deg, TWIN.z, strict=True)
    ]

    def load(t: float) -> np.ndarray:
        whole = sum(part(omega * t, omega) for part in parts)
        about_cg = np.array(whole)
        about_cg[3:] -= np.cross(cg, about_cg[:3])
        return about_cg

    matrices = (
        again.mass_matrix(p.body.mass, np.array(p.body.inertia)),
        again.curvature(springs, cg, "damping"),
        again.curvature(springs, cg, "stiffness"),
    )
    times = np.linspace(0.0, 60.0 / rpm, 37, endpoint=False)
    moved = again.steady_motion(matrices, load, 60.0 / rpm, times)
    r = p.response(rpm, rtol=1e-12)
    units = np.exp(1j * omega * np.outer(times, r.orders))
    summed = (units @ r.motion).real
    # Second differences are right to the square of their step; near a mode that is amplified.
    assert np.abs(summed - moved).max() < 1e-5 * np.abs(moved).max()
