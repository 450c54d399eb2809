"""Are the optimiser's phasors the library's, its gradients right, its optima those of a grid?"""

from __future__ import annotations

import dataclasses
import sys
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from crankpin.analysis.design.families import Family, engines_of, families
from crankpin.analysis.ranking import objectives
from rederivation import design as brute
from support import in_turn
from support.designing import A2, RPM, UNIT, design, question
from support.engines import OFFSET

if TYPE_CHECKING:
    from crankpin.analysis.design.question import Question

OMEGA = RPM * np.pi / 30.0
BY = (
    "[1].moment.backward",
    "[1].moment.peak",
    "[1].force.peak_xy",
    "[2].moment.forward",
    "[2].torque.peak",
    "total.moment.peak",
    "total.force.peak_xy",
    "total.torque.peak",
    "total.crank_torque.peak",
)
QUESTIONS: dict[str, Any] = {
    "a bank angle, pins held": question(10, bank_angle_deg=(60, 120), rotating_mass=0.3),
    "a bank angle, firing held": question(6, even_firing=True, shared_pins=False),
    "splits of their own": question(
        6,
        even_firing=True,
        shared_pins=False,
        same_split=False,
        cylinder=OFFSET,
        bank_stagger=0.02,
        counterweights=True,
    ),
    "everything": question(
        6, shared_pins=False, same_split=False, throws_deg="free", cylinder=OFFSET
    ),
    "with shafts": question(6, shared_pins=False, throws_deg="free", shafts=(-1, 2)),
    "inline": question(5, "inline", throws_deg="free", rotating_mass=0.3, counterweights=True),
}


def merit(asked: Question, by: str) -> tuple[Family, _core.Objectives]:
    candidates, _ = families(asked)
    family = candidates[len(candidates) // 2]
    (base,) = engines_of(dataclasses.replace(asked, shafts=()), [family.base])
    turns = [each.turns(asked.banks, asked.count) for each in family.variables]
    listed: list[Any] = [(each.quantity, each.what, each.order) for each in objectives.listed(by)]
    return family, _core.Objectives(base._core, turns, listed, list(range(1, 13)), asked.shafts)


def points(family: Any, count: int) -> list[list[Fraction]]:  # noqa: ANN401
    random = np.random.default_rng(1)
    return [
        [
            Fraction(f"{random.uniform(float(each.low), float(each.high)):.4f}")
            for each in family.variables
        ]
        for _ in range(count)
    ]


@in_turn("by", BY)
@in_turn("asked", QUESTIONS.values())
def test_its_objectives_are_the_library_s(asked: Any, by: str) -> None:  # noqa: ANN401
    family, found = merit(asked, by)
    listed = points(family, 3)
    engines = engines_of(asked, [family.crank(each) for each in listed])
    swept = cp.sweep(engines, rpm=RPM, orders=range(1, 13))
    expected = objectives.named(by).values(swept)[:, 0]
    radians = np.radians(np.array(listed, dtype=np.float64))
    scale = found.scales[0] * OMEGA**2
    mine = found.evaluated(radians)[0][:, 0] * scale
    np.testing.assert_allclose(mine, expected, rtol=0, atol=1e-10 * scale)
    assert (expected <= scale * (1 + 1e-12)).all()


@in_turn("by", [*BY, "[1].moment.peak_xy,[2].force.forward,total.moment.peak"])
@in_turn("asked", QUESTIONS.values())
def test_gradients_are_finite_differences(asked: Any, by: str) -> None:  # noqa: ANN401
    family, found = merit(asked, by)
    for values in points(family, 3):
        at = np.radians(np.array(values, dtype=np.float64))
        for mu in (1e-2, 1e-4):
            _, gradient = found.smoothed(at.tolist(), mu, 3)
            step = 1e-6 * np.eye(at.size)
            sides = [
                [found.smoothed((at + sign * each).tolist(), mu, 3)[0] for sign in (1, -1)]
                for each in step
            ]
            expected = np.array([(a - b) / 2e-6 for a, b in sides])
            # Central differences of a merit of order 1 are good to 1e-10; its curvature is 1/μ.
            np.testing.assert_allclose(gradient, expected, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("by", ["[1].moment.backward", "total.moment.peak,[2].moment.peak"])
def test_the_steepest_slope_is_one(by: str) -> None:
    asked = QUESTIONS["a bank angle, pins held"]
    _, found = merit(asked, by)
    grid = np.radians(np.linspace(60.0, 120.0, 601))
    values, slopes = found.evaluated(grid[:, np.newaxis])
    heights, steep = values @ found.weights, slopes[:, :, 0] @ found.weights
    between = np.diff(heights) / np.diff(grid)
    assert abs(between).max() <= found.steepest
    assert abs(steep).max() <= found.steepest
    # Over 0.1° a slope changes by up to 1 %, and jumps where two peaks are equally high.
    lowest, highest = np.minimum(steep[1:], steep[:-1]), np.maximum(steep[1:], steep[:-1])
    margin = 0.01 * found.steepest
    assert ((lowest - margin <= between) & (between <= highest + margin)).all()


# --- optima -------------------------------------------------------------------------------------


@pytest.mark.parametrize("by", ["[1].moment.peak", "[1].moment.peak_xy"])
def test_a_bank_angle_is_that_of_a_fine_grid(by: str) -> None:
    given: dict[str, Any] = {"throws_deg": [0, 70, 200, 310], "by": by}
    found = design(8, bank_angle_deg=(20, 150), **given, count=50)
    best = found[0]
    angles = np.linspace(20.0, 150.0, 13_001)
    values = found.over_bank_angle(angles)[0]
    assert best.value <= values.min() * (1 + 1e-12)
    assert abs(angles[values.argmin()] - best.bank_angle_deg) <= 0.01
    every = np.array([found.over_bank_angle(angles[::100], 50)[k] for k in range(len(found))])
    assert best.value <= every.min() * (1 + 1e-12)


@pytest.mark.parametrize(
    ("throws", "limits", "by"),
    [
        ([0, 70, 200], (10, 170), "[2].moment.peak"),
        # Dips narrower than a degree, at an end of the range and inside.
        ([0, 15, 105], (28, 146), "total.moment.peak"),
        ([0, 15, 105], (28, 146), "[4].moment.peak"),
        # One of 139.87°, whose next twelfth of a turn is lower.
        ([0, 63, 292], (58, 170), "total.torque.peak"),
    ],
)
def test_every_dip_is_found(throws: list[int], limits: tuple[int, int], by: str) -> None:
    found = design(6, bank_angle_deg=limits, throws_deg=throws, by=by, count=1000)
    angles = np.linspace(*limits, 10 * (limits[1] - limits[0]) + 1)
    for each in {each.throws_deg: each for each in found}.values():
        k = list(found).index(each)
        values = found.over_bank_angle(angles, k + 1)[k]
        around = np.pad(values, 1, constant_values=np.inf)
        margin = 1e-9 * values.max()
        lower = (values < around[:-2] - margin) & (values < around[2:] - margin)
        inside = np.flatnonzero(lower)
        listed = [d.bank_angle_deg for d in found if d.throws_deg == each.throws_deg]
        for dip in angles[inside]:
            assert np.abs(np.array(listed) - dip).min() < 0.2


@pytest.mark.parametrize("seed", [0, 7])
def test_free_throws_of_an_inline_5_are_equally_spaced(seed: int) -> None:
    by = "[1].force.peak,[2].force.peak,[1].moment.peak"
    free = design(5, "inline", throws_deg="free", by=by, seed=seed)
    spaced = design(5, "inline", by=by)
    assert [each.throws_deg for each in free] == [each.throws_deg for each in spaced]
    np.testing.assert_allclose(
        [each.values for each in free], [each.values for each in spaced], atol=1e-9 * UNIT
    )
    assert all(each.isolated for each in free)


@pytest.mark.parametrize("seed", [0, 7])
def test_free_angles_find_the_split_of_a_60_degree_v6(seed: int) -> None:
    found = design(
        6, bank_angle_deg=60, shared_pins=False, throws_deg="free", counterweights=True,
        by="[1].force.peak,[1].moment.peak,[2].force.peak,[2].moment.peak", seed=seed,
    )  # fmt: skip
    assert found[0].pin_split_deg == (-60.0, -60.0, -60.0)
    assert max(found[0].values[:2]) < 1e-9 * UNIT


def test_a_free_v_twin() -> None:
    # Shared pin, any angle: first-order backward part cos α (balancing and torque, 2).
    found = design(2, bank_angle_deg=(30, 150), counterweights=True, by="[1].force.peak")
    assert [(each.bank_angle_deg, each.value) for each in found] == [(90.0, 0.0)]


def test_a_continuum_is_named() -> None:
    # Without a couple at any bank angle.
    found = design(8, bank_angle_deg=(30, 150), throws_deg=[0, 180, 180, 0], by="[1].moment.peak")
    best = next(each for each in found if each.throws_deg == (0, 180, 180, 0))
    assert not best.isolated
    assert "0-180-180-0*" in repr(found)
    assert repr(found).splitlines()[-1] == "* other angles nearby are as good"
    others = [each for each in found if each.throws_deg != (0, 180, 180, 0)]
    assert others
    assert all(each.isolated for each in others)


def test_a_continuum_of_one_crank_leaves_those_of_others() -> None:
    # No second-order couple: 0-90-270-180, and the three orders of two throws a half turn from two
    # others, all in phase at order 2. That holds at any bank angle.
    by = "[2].moment.peak"
    fixed = [each for each in design(8, bank_angle_deg=90, by=by) if each.place == 1]
    free = [each for each in design(8, bank_angle_deg=(40, 140), by=by) if each.place == 1]
    assert {each.throws_deg for each in fixed} == {each.throws_deg for each in free}
    assert len(free) == 4
    assert not any(each.isolated for each in free)


def test_later_objectives_decide_where_the_first_leaves_a_choice() -> None:
    by = "[1].moment.peak,[2].moment.peak,[2].force.peak"
    found = design(8, bank_angle_deg=(30, 150), throws_deg=[0, 180, 180, 0], by=by)
    best = next(each for each in found if each.throws_deg == (0, 180, 180, 0))
    angles = np.linspace(30.0, 150.0, 121)
    forces = [
        brute.couple(np.array(best.throws_deg), angle, 2, lever=False) * UNIT * A2
        for angle in angles
    ]
    assert abs(angles[np.argmin(forces)] - best.bank_angle_deg) <= 1.0
    assert best.values[2] <= min(forces) * (1 + 1e-3)


# --- progress and interruption ------------------------------------------------------------------


@pytest.mark.parametrize("given", [{"bank_angle_deg": (60, 90)}, {"throws_deg": "free"}])
def test_progress(given: dict[str, Any]) -> None:
    steps: list[tuple[int, int]] = []
    arguments: dict[str, Any] = {"bank_angle_deg": 60, "by": "[1].moment.peak"} | given
    design(6, **arguments, progress=lambda done, total: steps.append((done, total)))
    done, total = np.array(steps).T
    assert (np.diff(done) > 0).all()
    assert (done <= total).all()
    assert done[-1] == total[-1]


@pytest.mark.parametrize("given", [{"bank_angle_deg": (60, 90)}, {"throws_deg": "free"}])
def test_ctrl_c_stops_it(given: dict[str, Any]) -> None:
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    arguments: dict[str, Any] = {"bank_angle_deg": 60, "by": "[1].moment.peak"} | given
    with pytest.raises(KeyboardInterrupt):
        design(6, **arguments, progress=stop)


def test_ctrl_c_inside_the_optimiser(monkeypatch: pytest.MonkeyPatch) -> None:
    def minimize(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("scipy.optimize.minimize", minimize)
    with pytest.raises(KeyboardInterrupt):
        design(6, bank_angle_deg=60, throws_deg="free", by="[1].moment.peak")


def test_without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    assert design(10, bank_angle_deg=72, by="[1].moment.peak")[0].value > 0.0
    assert design(10, bank_angle_deg=(60, 90), by="[1].moment.peak")[0].value > 0.0
    with pytest.raises(ImportError, match=r"crankpin\[optimize\]"):
        design(6, bank_angle_deg=60, throws_deg="free", by="[1].moment.peak")


def test_an_angle_that_is_no_round_number_is_not_rounded() -> None:
    found = design(4, bank_angle_deg=(20, 160), throws_deg=[0, 77], by="total.moment.peak")
    inside = [each for each in found if each.bank_angle_deg not in (20.0, 160.0)]
    assert inside
    for each in inside:
        assert each.bank_angle_deg is not None
        beside = found.over_bank_angle(np.array([each.bank_angle_deg + d for d in (-1e-3, 1e-3)]))
        assert (each.value <= beside[0] * (1 + 1e-9)).all()


def test_the_best_few_are_the_first_of_all() -> None:
    # Between two angles of the grid, 90.25°, first-order couples vanish: only there the second
    # order, whose sequence of cranks is the reverse, decides.
    given: dict[str, Any] = {"bank_angle_deg": (80, 100), "pin_split_deg": 0.5}
    given |= {"counterweights": True, "by": "[1].moment.backward,[2].moment.peak"}
    every = design(10, **given, count=1000)
    assert len(every) == 8
    assert {each.bank_angle_deg for each in every} == {90.25}
    for count in (1, 2, 4):
        assert design(10, **given, count=count).designs == every.designs[:count]
