"""Are many designs at once those one by one, and tolerances exact at their ends?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

I4 = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.45, bore=0.086))
FIRED = I4.with_cycle(cp.Cycle.example())
BODY = cp.RigidBody(
    150.0, (0.02, 0.06, 0.1), [[7, 0.2, -0.4], [0.2, 8, 0.3], [-0.4, 0.3, 4.5]], "tensor"
)
MOUNTS = [
    cp.Mount("right", (0.25, -0.1, 0), (2e5, 1e5, 1e5), tilt_deg=130, loss_factor=0.1),
    cp.Mount("left", (-0.25, -0.1, 0), (2e5, 1e5, 1e5), tilt_deg=50, loss_factor=0.1),
    cp.Mount("rear", (0, -0.12, 0.6), (1e5, 2e5, 1e5), loss_factor=0.2),
]
P = cp.Powertrain(FIRED, BODY, MOUNTS)
RPM = np.linspace(700.0, 5000.0, 21)


@pytest.mark.parametrize("damping", [0.0, 300.0])
def test_designs_are_powertrains_one_by_one(damping: float) -> None:
    draw = np.random.default_rng(3)
    p = P.replace(mounts=[mount.replace(damping=damping) for mount in MOUNTS])
    vary = {
        "right": {"stiffness": draw.uniform(1e5, 4e5, (5, 3)), "tilt_deg": draw.uniform(0, 90, 5)},
        "rear": {"at": draw.uniform(-0.5, 0.5, (5, 3)), "loss_factor": draw.uniform(0, 0.3, 5)},
    }
    point = (0.1, 0.3, 0.2)
    d = p.designs(RPM, vary, orders=[0.5, 1, 2, 4], mount_force=True, points=[point])
    assert len(d) == 5
    for k in range(5):
        one = d.powertrain_of(k)
        r = one.response(RPM, orders=[0.5, 1, 2, 4])
        assert d.frequency[k] == pytest.approx(one.modes().frequency, rel=1e-14)
        vectors = [r.body_force, *(r.mount_force[n] for n in p.names), r.at(point).velocity]
        largest = [d.body_force, *(d.mount_force[n] for n in p.names), d.velocity[:, 0]]
        rms = [d.body_force_rms, *(d.mount_force_rms[n] for n in p.names), d.velocity_rms[:, 0]]
        for vector, most, level in zip(vectors, largest, rms, strict=True):
            # What one factorisation with and one without pivots differ by.
            size = 1e-10 * vector.peak.max()
            assert most[k, ...] == pytest.approx(vector.peak_xyz.max(axis=0), abs=size)
            assert level[k] == pytest.approx(vector.total.rms_xyz.max(axis=0), abs=size)
    assert d == p.designs(RPM, vary, orders=[0.5, 1, 2, 4], mount_force=True, points=[point])


def test_impossible_designs_are_rejected_by_name() -> None:
    ok = np.full(3, 2e5)
    for vary, said in [
        ({}, "vary = no design"),
        ({"front": {"stiffness": ok}}, "vary = 'front'"),
        ({"right": {"mass": ok}}, r"vary\['right'\] = 'mass'"),
        ({"right": {"stiffness": ok}, "left": {"stiffness": ok[:2]}}, "vary has 2, 3 values"),
        ({"right": {"stiffness": np.ones((3, 2))}}, r"\['stiffness'\] has shape \(3, 2\)"),
        ({"right": {"at": ok}}, r"\['at'\] has shape \(3,\)"),
        ({"right": {"loss_factor": [0.1, -0.1]}}, r"design 1: .*loss_factor\[0\] = -0\.1"),
        ({"right": 3}, r"vary\['right'\] = 3"),
    ]:
        with pytest.raises(cp.InputError, match=said):
            P.designs(RPM, vary, orders=[2])  # type: ignore[arg-type]
    dynamic = P.replace(mounts=[MOUNTS[0].replace(dynamic_stiffness=3e5), *MOUNTS[1:]])
    with pytest.raises(cp.InputError, match="does not count in motion"):
        dynamic.designs(RPM, {"right": {"stiffness": ok}})
    with pytest.warns(UserWarning, match="N/mm"):
        P.designs(RPM, {"right": {"stiffness": [200.0, 300.0]}}, orders=[2])
    bare = P.replace(mounts=[mount.replace(loss_factor=0.0) for mount in MOUNTS])
    resonance = 30.0 * bare.modes().frequency[5]
    with pytest.raises(cp.InputError, match=r"design 0: .*mode without damping"):
        bare.designs([resonance], {"right": {"stiffness": [(2e5, 1e5, 1e5)]}}, orders=[2])
    fluid = P.replace(mounts=[MOUNTS[0].replace(track=cp.InertiaTrack(1e5, 9, 0.2)), *MOUNTS[1:]])
    d = fluid.designs(RPM, {"left": {"stiffness": ok}}, orders=[2])
    assert np.isnan(d.frequency).all()
    given = fluid.designs(RPM, {"left": {"stiffness": ok}}, orders=[2], frequency=15)
    assert given.frequency[0] == pytest.approx(d.powertrain_of(0).modes(15).frequency, rel=1e-14)


def test_a_million_designs_would_be_too_large_or_fit() -> None:
    with pytest.raises(cp.InputError, match="the result would take"):
        P.designs(
            [1000.0],
            {"right": {"stiffness": np.full(10_000_000, 2e5)}},
            orders=list(range(1, 200)),
            mount_force=True,
        )


def test_robustness() -> None:
    r = P.robustness(stiffness=0.19, mass=0.19, inertia=0.19, cg=1e-5)
    f = P.modes().frequency
    assert r.frequency_bounds == pytest.approx(np.array([f * 0.9, f * np.sqrt(1.19)]), rel=1e-12)
    assert r.mass_bounds == pytest.approx(np.array([f / np.sqrt(1.19), f / 0.9]), rel=1e-12)
    assert (r.cg_range[0] <= f).all()
    assert (r.cg_range[1] >= f).all()
    # Derivatives, to the step over a length of 0.1 m.
    linear = np.abs(r.cg_slope).sum(axis=0) * 1e-5
    assert r.cg_range[1] - f == pytest.approx(linear, rel=1e-3)
    assert (r.least_purity <= r.purity).all()
    for mode in range(1, 7):
        mounts = [
            mount.replace(stiffness=np.array(mount.stiffness) * r.least_pure(mode)[mount.name])
            for mount in MOUNTS
        ]
        purity = P.replace(mounts=mounts).modes().purity[mode - 1]
        assert purity == pytest.approx(r.least_purity[mode - 1], rel=1e-9)
    one = P.robustness({"rear": 0.1}, corners="mounts")
    assert (one.frequency_bounds[0] > r.frequency_bounds[0]).all()
    assert "f least" in str(one.table)
    assert len(r.frames["cg"]) == 6
    for wrong, said in [
        ({"stiffness": 1.0}, "stiffness = 1"),
        ({"stiffness": {"front": 0.1}}, "stiffness = 'front'"),
        ({"mass": -0.1}, "mass = -0.1"),
        ({"cg": -1}, "cg = -1"),
        ({"corners": "all"}, "corners = 'all'"),
    ]:
        with pytest.raises(cp.InputError, match=said):
            P.robustness(**wrong)  # type: ignore[arg-type]
    many = [MOUNTS[0].replace(name=f"{k}") for k in range(7)]
    with pytest.raises(cp.InputError, match=r"2 to the power of 21 corners.*corners=\"mounts\""):
        P.replace(mounts=[*many]).robustness()


@in_turn("seed", range(4))
def test_purity_is_searched_within_the_tolerances(seed: int) -> None:
    """Inside of the box it is less than at any corner, and no draw is less than what was found."""
    draw = np.random.default_rng(seed)
    r = P.robustness(stiffness=0.1)
    least = np.full(6, np.inf)
    for factor in draw.uniform(0.9, 1.1, (300, len(MOUNTS), 3)):
        mounts = [m.replace(stiffness=f * m.stiffness) for m, f in zip(MOUNTS, factor, strict=True)]
        least = np.minimum(least, P.replace(mounts=mounts).modes().purity)
    # Of a search: half a point for bands narrower than its steps.
    assert (r.least_purity <= least + 0.5).all()
    for mode in range(1, 7):
        factors = np.array([*r.least_pure(mode).values()])
        assert (np.abs(factors - 1.0) <= 0.1 + 1e-12).all()


def test_the_least_purity_is_inside_where_frequencies_approach_each_other() -> None:
    """Lateral and bounce of one frequency, a little coupled: they mix, at corners they do not."""
    body = cp.RigidBody(100.0, (0, 0, 0), (5, 6, 4))
    mounts = [
        cp.Mount(f"{x:+g} {z:+g}", (x, 0, z), (1e5, 1.001e5, 2e5), tilt_deg=1.0)
        for x in (0.3, -0.3)
        for z in (0.4, -0.4)
    ]
    p = cp.Powertrain(FIRED, body, mounts)
    found = p.robustness(0.1, corners="axes")
    corners = []
    for signs in np.ndindex(2, 2):
        factor = 1.0 + 0.1 * (2.0 * np.array([*signs, 0]) - 1.0)
        each = [mount.replace(stiffness=factor * mount.stiffness) for mount in mounts]
        corners.append(p.replace(mounts=each).modes().purity)
    mixed = found.least_purity < np.min(corners, axis=0) - 20.0
    assert mixed.any()
    assert "least found %" in found.table.header
    assert "search" in found.table.note
