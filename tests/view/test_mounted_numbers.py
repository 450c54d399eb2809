"""Are modes and response of the page of mounts the library's, also after mounts were moved?

Both solve the same equations of six unknowns, each in its own way: with the damping of these
powertrains they lose a few digits of sixteen at most. 1e-10 is far above that, and far below a
digit that is shown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.view import mounted
from crankpin.view.page import module
from support.chromium import Open, values

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

WITHIN = 1e-10
FIRED = cp.Cylinder(0.043, 0.145, 0.45, bore=0.086)
ENGINES: dict[str, Callable[[], cp.Engine]] = {
    "single": lambda: cp.Engine.preset("single"),
    "i4 fired": lambda: cp.Engine.preset("i4", cylinder=FIRED).with_cycle(cp.Cycle.example()),
    "v6-60": lambda: cp.Engine.preset("v6-60"),
    "v8-crossplane": lambda: cp.Engine.preset("v8-crossplane"),
    "i3 lame": lambda: cp.Engine.preset("i3", cylinder=FIRED).with_cycle(
        [cp.Cycle.example(), None, cp.Cycle.example()]
    ),
    "vr6": lambda: cp.Engine.preset("vr6"),
}


def powertrain(name: str, seed: int, *, varies: bool = False) -> cp.Powertrain:
    """Return an engine on random mounts; a hydraulic one and a table among them if so said."""
    draw = np.random.default_rng(seed)
    root = draw.normal(size=(3, 3))
    moments = 2.0 * (root @ root.T) + np.eye(3)
    inertia = np.trace(moments) * np.eye(3) - moments
    body = cp.RigidBody(150.0, draw.uniform(-0.2, 0.2, 3), inertia, products="tensor")
    mounts = [
        cp.Mount(
            f"{k}",
            draw.uniform(-0.5, 0.5, 3),
            draw.uniform(5e4, 4e5, 3),
            axes=np.linalg.qr(draw.normal(size=(3, 3)))[0],
            dynamic_stiffness=draw.uniform(1e5, 4e5, 3) if k % 2 else None,
            loss_factor=draw.uniform(0.02, 0.3, 3),
            damping=draw.uniform(0.0, 500.0, 3),
        )
        for k in range(draw.integers(3, 7))
    ]
    if varies:
        track = cp.InertiaTrack(1.5e5, draw.uniform(8.0, 14.0), draw.uniform(0.1, 1.0))
        mounts[0] = mounts[0].replace(track=track)
        frequency = np.array([0.0, 10.0, 50.0, 5000.0])
        rows = draw.uniform(1e5, 3e5, (4, 3)) * (1.0 + 0.2j)
        mounts[1] = cp.Mount("table", mounts[1].at, 2e5, tilt_deg=20, table=(frequency, rows))
    return cp.Powertrain(ENGINES[name](), body, mounts)


def moved(p: cp.Powertrain, page: Page) -> cp.Powertrain:
    """Return the powertrain with the mounts of the page."""
    return mounted.changed(p, page.evaluate("crankpin.state.mounts"))


def complex_of(pairs: list[Any]) -> np.ndarray:
    return np.array(pairs, float).view(complex)[..., 0]


def assert_modes_agree(page: Page, p: cp.Powertrain, frequency: float | None = None) -> None:
    modes, found = p.modes(frequency), page.evaluate("crankpin.modes")
    np.testing.assert_allclose([m["frequency"] for m in found], modes.frequency, rtol=WITHIN)
    energy = np.array([m["energy"] for m in found]).T
    np.testing.assert_allclose(energy, modes.energy, rtol=0, atol=100 * WITHIN)
    np.testing.assert_allclose([m["purity"] for m in found], modes.purity, atol=100 * WITHIN)
    size = np.abs(modes.shapes).max()
    np.testing.assert_allclose(
        np.array([m["shape"] for m in found]).T, modes.shapes, atol=WITHIN * size
    )
    shown = values(page)
    for k in range(6):
        assert shown[f"mode-{k + 1}-frequency"] == found[k]["frequency"]
        assert shown[f"mode-{k + 1}-purity"] == found[k]["purity"]


def assert_response_agrees(page: Page, p: cp.Powertrain, rpm: float) -> None:
    r = p.response(rpm)
    assert page.evaluate("crankpin.figures.mounted.orders") == list(r.orders)
    page.evaluate("rpm => crankpin.set({ rpm, order: 'all' })", rpm)
    parts = page.evaluate("crankpin.parts")
    assert [part["order"] for part in parts] == list(r.orders)
    for key, expected in (("motion", r.motion), ("force", r.body_force.xyz)):
        found = complex_of([part[key] for part in parts])
        # Displacement and rotation by themselves.
        for rows in (slice(0, 3), slice(3, 6)):
            whole = np.abs(expected[:, rows]).max(initial=0.0)
            assert np.abs(found[:, rows] - expected[:, rows]).max(initial=0.0) <= WITHIN * whole
    assert_shown(page, r.body_force.total.rms_xyz, r.at(p.body.cg).displacement.total.rms_xyz)
    for order in (r.orders[0], r.orders[-1]):
        page.evaluate("order => crankpin.set({ order })", order)
        one = r[order]
        assert_shown(page, one.body_force.rms_xyz, one.at(p.body.cg).displacement.rms_xyz)


def assert_shown(page: Page, force: np.ndarray, displacement: np.ndarray) -> None:
    shown = values(page)
    for name, expected in (("force", force), ("displacement", displacement)):
        length = float(np.linalg.norm(expected))
        found = [shown[f"{name}-{part}"] for part in (*"xyz", "length")]
        np.testing.assert_allclose(found, [*expected, length], rtol=0, atol=WITHIN * length)


def assert_run_up_agrees(page: Page, p: cp.Powertrain) -> None:
    for order in ("all", p.response(1000.0).orders[0]):
        page.evaluate("order => crankpin.set({ order })", order)
        curves = page.evaluate("crankpin.curves")
        r = p.response(curves["speeds"])
        expected = (r.body_force.total if order == "all" else r.body_force[order]).rms_xyz
        size = np.linalg.norm(expected, axis=-1, keepdims=True)
        assert (np.abs(np.array(curves["values"]) - expected) <= WITHIN * size).all()


@pytest.mark.parametrize("name", ENGINES)
def test_modes_and_response_as_given_and_moved(open_engine: Open, name: str) -> None:
    p = powertrain(name, len(name))
    page = open_engine(p)
    draw = np.random.default_rng(7)
    for step in range(3):
        if step:
            states = [
                {
                    "at": draw.uniform(-0.5, 0.5, 3).tolist(),
                    "stiffness": draw.uniform(1e5, 5e5, 3).tolist(),
                }
                for _ in p.mounts
            ]
            page.evaluate("mounts => crankpin.set({ mounts })", states)
        now = moved(p, page)
        assert (now == p) == (step == 0)
        assert_modes_agree(page, now)
        assert_response_agrees(page, now, draw.uniform(300.0, 6000.0))
        assert_run_up_agrees(page, now)


@pytest.mark.parametrize("seed", range(2))
def test_hydraulic_mounts_and_tables(open_engine: Open, seed: int) -> None:
    p = powertrain("i4 fired", seed, varies=True)
    page = open_engine(p, save={"frequency": 9.0})
    draw = np.random.default_rng(seed)
    for _ in range(2):
        now = moved(p, page)
        assert_modes_agree(page, now, 9.0)
        assert_response_agrees(page, now, draw.uniform(300.0, 4000.0))
        assert_run_up_agrees(page, now)
        # Places of all, and the rubber of those that are no table.
        states = page.evaluate("crankpin.state.mounts")
        for state in states:
            state["at"] = draw.uniform(-0.5, 0.5, 3).tolist()
            if state["stiffness"] is not None:
                state["stiffness"] = draw.uniform(1e5, 5e5, 3).tolist()
        page.evaluate("mounts => crankpin.set({ mounts })", states)


@pytest.mark.filterwarnings("ignore:mounts = .* (is|are) free:UserWarning")
def test_few_mounts_leave_motions_of_exactly_zero(open_engine: Open) -> None:
    for places in ([(0.3, 0, 0), (-0.3, 0, 0)], [(0.1, 0.0, 0.0)]):
        mounts = [cp.Mount(f"{k}", at, 2e5, loss_factor=0.1) for k, at in enumerate(places)]
        body = cp.RigidBody(160.0, (0.0, 0.05, 0.0), (7, 8, 4.5))
        p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        page = open_engine(p)
        modes = p.modes()
        found = np.array([m["frequency"] for m in page.evaluate("crankpin.modes")])
        free = len(modes.free)
        assert (found[:free] == 0.0).all()
        np.testing.assert_allclose(found, modes.frequency, rtol=WITHIN)
        assert page.get_by_text("No mount resists the motions of zero frequency.").is_visible()
        assert_response_agrees(page, p, 900.0)


def test_equal_frequencies_share_their_energies(open_engine: Open) -> None:
    mounts = [
        cp.Mount(f"{x} {z}", (x, 0, z), 1e5, loss_factor=0.1)
        for x in (0.3, -0.3)
        for z in (0.3, -0.3)
    ]
    body = cp.RigidBody(100.0, (0.0, 0.0, 0.0), (9, 18, 9))
    p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
    page = open_engine(p)
    modes, found = p.modes(), page.evaluate("crankpin.modes")
    assert modes.groups == ((1, 2, 3, 4, 5, 6),)
    np.testing.assert_allclose([m["purity"] for m in found], modes.purity, atol=100 * WITHIN)
    np.testing.assert_allclose(
        np.array([m["energy"] for m in found]).T, modes.energy, atol=100 * WITHIN
    )


def test_where_there_is_no_answer_none_is_shown(open_engine: Open) -> None:
    """An undamped resonance that is met exactly, and the end of a table."""
    body = cp.RigidBody(100.0, (0.0, 0.0, 0.0), (9, 18, 9))
    places = [(x, 0, z) for x in (0.3, -0.3) for z in (0.3, -0.3)]
    bare = cp.Powertrain(
        cp.Engine.preset("i4"), body, [cp.Mount(f"{at}", at, 1e5) for at in places]
    )
    rpm = 60.0 * float(bare.modes().frequency[0]) / 2.0
    table = ([0.0, 60.0], np.full((2, 3), 1e5 + 1e4j))
    ended = bare.replace(mounts=[cp.Mount(f"{at}", at, 1e5, table=table) for at in places])
    for p, at, save in ((bare, rpm, {}), (ended, 2000.0, {"frequency": 10.0})):
        with pytest.raises(cp.InputError):
            p.response(at, orders=[2])
        page = open_engine(p, save=save)
        page.evaluate("rpm => crankpin.set({ rpm, order: 2 })", at)
        assert page.locator("[data-name=force-x]").text_content() == "no answer"
        assert "force-x" not in values(page)
        assert page.locator(".trouble").is_visible()
        page.evaluate("crankpin.set({ rpm: 500 })")
        assert not page.locator(".trouble").is_visible()
        one = p.response(500.0, orders=[2])[2]
        assert_shown(page, one.body_force.rms_xyz, one.at(body.cg).displacement.rms_xyz)


def test_a_stiffness_below_zero_has_no_modes(open_engine: Open) -> None:
    """Of a fluid below its resonance, once the rubber beside it is soft."""
    p = powertrain("i4 fired", 1, varies=True)
    track = cp.InertiaTrack(2e5, 10.0, 0.1)
    first = p.mounts[0].replace(track=track, dynamic_stiffness=8e5)
    p = p.replace(mounts=[first, *p.mounts[1:]])
    page = open_engine(p, save={"frequency": 8.5})
    assert_modes_agree(page, p, 8.5)
    states = page.evaluate("crankpin.state.mounts")
    states[0]["stiffness"] = [1e4, 1e4, 1e4]
    page.evaluate("mounts => crankpin.set({ mounts })", states)
    with pytest.raises(cp.InputError, match="below zero at this frequency"):
        moved(p, page).modes(8.5)
    assert page.get_by_text("There are no modes").is_visible()
    assert not page.locator(".modes").is_visible()
    assert_response_agrees(page, moved(p, page), 900.0)


def test_linear_algebra_of_any_matrix(open_file: Open, tmp_path: Path) -> None:
    """Singular values and complex equations, beside those of LAPACK."""
    file = tmp_path / "linear.html"
    script = f"{module('linear.mjs')}\nglobalThis.linear = {{ singular, solveComplex }};"
    icon = "<link rel=icon href='data:,'>"
    file.write_text(f"<!DOCTYPE html>{icon}<script type=module>{script}</script>")
    page = open_file(file)
    draw = np.random.default_rng(3)
    for rank in (6, 6, 6, 5, 3, 1):
        rows = draw.normal(size=(12, rank)) @ draw.normal(size=(rank, 6))
        found = page.evaluate("rows => linear.singular(rows)", rows.tolist())
        own = np.array([each["value"] for each in found])
        expected = np.sort(np.linalg.svd(rows, compute_uv=False))
        assert (own[: 6 - rank] == 0.0).all()
        np.testing.assert_allclose(own, expected, rtol=0, atol=1e-13 * expected[-1])
        vectors = np.array([each["vector"] for each in found]).T
        np.testing.assert_allclose(vectors.T @ vectors, np.eye(6), atol=1e-13)
        lengths = np.linalg.norm(rows @ vectors, axis=0)
        np.testing.assert_allclose(lengths, own, atol=1e-13 * own[-1])
    solve = """([re, im, x, y]) => {
        const [a, b, c, d] = [re, im, x, y].map((each) => Float64Array.from(each));
        return linear.solveComplex(a, b, c, d) && [[...c], [...d]];
    }"""
    for _ in range(20):
        matrix = draw.normal(size=(6, 6)) + 1j * draw.normal(size=(6, 6))
        right = draw.normal(size=6) + 1j * draw.normal(size=6)
        given = [matrix.real.ravel(), matrix.imag.ravel(), right.real, right.imag]
        x, y = np.array(page.evaluate(solve, [each.tolist() for each in given]))
        # Some roundings, times the condition of the matrix.
        within = 1e-15 * np.linalg.cond(matrix) * np.linalg.norm(right)
        assert np.linalg.norm(matrix @ (x + 1j * y) - right) <= 10 * within
    given[0], given[1] = np.outer(right.real, right.real).ravel(), np.zeros(36)
    assert page.evaluate(solve, [each.tolist() for each in given]) is False
