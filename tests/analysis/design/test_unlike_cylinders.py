"""Do masses, places and throws of unlike cylinders balance them, as vector polygons do?"""

from __future__ import annotations

import itertools
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.design.unlike import fewest_cylinders
from crankpin.analysis.ranking import objectives
from rederivation import unlike as polygons
from support import in_turn
from support.engines import OFFSET

PARTS = cp.Cylinder(crank_radius=0.3, rod_length=1.2, reciprocating_mass=400.0)
PRIMARY = "[1].force.peak,[1].moment.peak"
YST = f"{PRIMARY},[2].force.peak"
ALL = f"{YST},[2].moment.peak"


def design(count: int = 4, by: str = PRIMARY, **given: Any) -> cp.results.Designs:  # noqa: ANN401
    given = {"cylinder": PARTS, "rpm": 240, "by": by} | given
    return cp.design(count, layout="inline", **given)  # type: ignore[arg-type]


def masses(one: cp.results.Design) -> np.ndarray[Any, Any]:
    return np.array([each.reciprocating_mass for each in one.engine.cylinders])


def turned(one: cp.results.Design) -> list[np.ndarray[Any, Any]]:
    """The throws, and those of the mirror image."""
    return [np.array(one.throws_deg), -np.array(one.throws_deg) % 360]


def is_balanced(one: cp.results.Design, orders: tuple[int, ...] = (1,)) -> None:
    for order in orders:
        force, couple = polygons.sums(masses(one), one.engine.z, np.array(one.throws_deg), order)
        # Sums of four terms of order one, throws to their last digit.
        assert max(force, couple) < 1e-12


# --- printed examples ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mass", "z", "between", "printed"),
    [
        # askfilo.com …3334393237353739, printed: 240° and 0° (a slip: neither sum vanishes).
        (400, [0, 0.45, 1.2, 1.8], 120, ([400, 400], [240, 0])),
        # askfilo.com …3430393634363439, printed: opposite inner cranks, of cosines alone (a slip).
        (200, [0, 0.2, 0.8, 1.3], 120, ([350, 250], [180, 0])),
        # askfilo.com …3432343237303039, printed: each opposite an outer one (a couple is left).
        (100, [0, 0.6, 1.2, 1.8], 60, ([100, 100], [180, 240])),
    ],
)
def test_inner_masses_and_cranks(
    mass: float, z: list[float], between: float, printed: tuple[list[float], list[float]]
) -> None:
    found = design(
        masses=[mass, None, None, mass], positions=z, throws_deg=[0, None, None, between]
    )
    (one,) = found
    sizes, throws = polygons.inner((mass, mass), np.array(z), (0, between))
    np.testing.assert_allclose(masses(one), [mass, *sizes, mass], rtol=1e-13)
    np.testing.assert_allclose(one.throws_deg, [0, *throws, between], atol=1e-11)
    assert one.values == (0.0, 0.0)
    assert one.isolated
    is_balanced(one)
    slip = np.array([mass, *printed[0], mass]), np.array([0, *printed[1], between])
    assert max(polygons.sums(slip[0], np.array(z), slip[1], 1)) > 0.2


@pytest.mark.parametrize(
    ("given", "z", "printed"),
    [
        # Khurmi and Gupta, example 22.8, also askfilo.com …3335383131323536; 60 kg as remembered.
        ([50, 60, None, 50], [0, 0.2, 0.4, 0.6], 60.0),
        # askfilo.com …3335333031313736.
        ([40, 60, 70, None], [0, 0.2, 0.4, 0.52], None),
        # Khurmi and Gupta, exercises of chapter 22: 150, ?, 400 and 250 kg.
        ([150, None, 400, 250], [0, 0.75, 1.8, 2.4], None),
        # The same with a misprint, 10 kg, askfilo.com …3433313538383130: a straight couple polygon.
        # Printed: 140 kg, of a first cylinder behind the second.
        ([10, None, 400, 250], [0, 0.75, 1.8, 2.4], None),
    ],
)
def test_one_mass_and_all_cranks(
    given: list[float | None], z: list[float], printed: float | None
) -> None:
    which = given.index(None)
    known = np.array([np.nan if each is None else each for each in given])
    mass, throws = polygons.unknown_mass(known, np.array(z), which)
    (one,) = design(masses=given, positions=z)
    # Of the straight polygon, a double root, throws are right to the root of rounding.
    assert masses(one)[which] == pytest.approx(mass, rel=1e-12)
    apart = [np.abs((each - throws + 180) % 360 - 180).max() for each in turned(one)]
    assert min(apart) < 1e-6
    is_balanced(one)
    if printed is not None:
        assert mass == pytest.approx(printed, rel=1e-3)


def test_the_misprinted_example_as_it_was_solved() -> None:
    (one,) = design(masses=[None, 10, 400, 250], positions=[0, 0.75, 1.05, 1.65])
    assert masses(one)[0] == pytest.approx(140.0, rel=1e-12)
    assert one.throws_deg == (0.0, 0.0, 180.0, 0.0)
    # A double root: throws may move by the root of rounding.
    assert not one.isolated


def test_inner_cranks_at_right_angles() -> None:
    """Rattan, chapter 14: inner cranks at 90°, 300 kg each, 600 mm apart, outer ones 1800 mm."""
    (one,) = design(
        masses=[None, 300, 300, None], positions=[0, 0.6, 1.2, 1.8], throws_deg=[None, 0, 90, None]
    )
    # m cos α = 300 cos 45°, m·0.9·sin α = 300·0.3·sin 45°.
    outer = 300 * np.hypot(1, 1 / 3) / np.sqrt(2)
    np.testing.assert_allclose(masses(one), [outer, 300, 300, outer], rtol=1e-13)
    apart = (one.throws_deg[3] - one.throws_deg[0]) % 360
    assert apart == pytest.approx(2 * np.degrees(np.arctan(1 / 3)), abs=1e-11)


def test_two_masses_a_place_and_a_throw() -> None:
    """Khurmi and Gupta, example 21.4, and studypool.com 183311: a shaft of four masses.

    Masses times radii, kg·cm: 18·6 and 12.5·6; the unknown ones are at 8 cm.
    """
    (one,) = design(
        masses=[None, 108, 75, None], positions=[0, 0.1, 0.3, None], throws_deg=[190, 0, 100, None]
    )
    b, c = 108, 75 * np.exp(1j * np.radians(100))
    turned_to_a = np.exp(-1j * np.radians(190))
    # About A: D's vector times its place; its force is −(A + b + c).
    couple = 0.1 * b + 0.3 * c
    # (A + b + c)·z = couple, A along 190°: the part across 190° has no A.
    place = (couple * turned_to_a).imag / ((b + c) * turned_to_a).imag
    first = (couple * turned_to_a).real / place - ((b + c) * turned_to_a).real
    assert one.engine.z[3] == pytest.approx(place, rel=1e-12)
    assert masses(one)[0] == pytest.approx(first, rel=1e-12)
    # In kilograms at 8 cm, as printed: 9.67 kg and 7.91 kg, 367 mm from A.
    assert masses(one)[[0, 3]] / 8 == pytest.approx([9.67, 7.91], abs=0.005)
    is_balanced(one)


# --- Yarrow, Schlick and Tweedy -----------------------------------------------------------------


@pytest.mark.parametrize("outer", [0.7, 0.9, 1.5])
def test_symmetrical_engines(outer: float) -> None:
    z = [-outer, -0.3, 0.3, outer]
    (one,) = design(masses=[400, None, None, 400], positions=z, by=YST)
    alpha, beta, ratio = polygons.symmetric(outer, 0.3)
    assert np.cos(np.radians(alpha)) * np.cos(np.radians(beta)) == pytest.approx(0.5, rel=1e-14)
    np.testing.assert_allclose(masses(one), [400, 400 * ratio, 400 * ratio, 400], rtol=1e-11)
    first, *inner_, last = one.throws_deg
    apart = [min(a % 360, -a % 360) for a in (last - first, inner_[1] - inner_[0])]
    np.testing.assert_allclose(apart, [2 * alpha, 2 * beta], atol=1e-9)
    assert one.values == (0.0, 0.0, 0.0)
    is_balanced(one)
    assert polygons.sums(masses(one), one.engine.z, np.array(one.throws_deg), 2)[0] < 1e-12


@in_turn("seed", range(6))
def test_unlike_engines_balance_by_the_core_and_by_numpy(seed: int) -> None:
    # Few values, so that pitches and masses coincide.
    random = np.random.default_rng(seed)
    z = np.cumsum([0.0, *random.choice([0.5, 0.75, 1.0], 3)]).tolist()
    found = design(masses=[float(random.choice([300, 400])), None, None, None], positions=z, by=YST)
    for one in found:
        assert one.values == (0.0, 0.0, 0.0)
        is_balanced(one)
        assert polygons.sums(masses(one), one.engine.z, np.array(one.throws_deg), 2)[0] < 1e-12
        swept = one.engine.balance(rpm=240, orders=[1, 2])
        # The couple of the second order stays, whatever the masses.
        assert swept[2].moment.peak > 1e-3 * swept[2].force.peak + 1.0
    assert len(found) == 1


def test_the_second_order_couple_of_four_cranks_stays_and_says_so() -> None:
    found = design(masses=[400, None, None, None], positions=[0, 0.5, 1.2, 1.8], by=ALL)
    assert found[0].values[:3] == (0.0, 0.0, 0.0)
    assert found[0].values[3] > 1e3
    assert "vanish of no fewer than 5 cylinders" in repr(found)


def test_five_cranks_have_nothing_left() -> None:
    found = design(5, by=ALL, masses=[400, None, None, None, None], spacing=1.0)
    assert [each.values for each in found] == [(0.0,) * 4] * 2
    halved = next(each for each in found if masses(each)[1] < 500)
    np.testing.assert_allclose(masses(halved), [400, 400, 800, 400, 400], rtol=1e-12)
    assert halved.throws_deg == (0.0, 240.0, 120.0, 240.0, 0.0)
    assert found[0].engine.vanishing_orders([1, 2]).force.vanishing == (1, 2)


VANISHING = {
    "[1].force.peak": 2,
    "[1].moment.peak": 1,
    PRIMARY: 3,
    "[2].force.peak,[2].moment.peak": 3,
    "[1].force.peak,[2].force.peak": 3,
    YST: 4,
    "[1].force.peak,[2].force.peak,[2].moment.peak": 4,
    ALL: 5,
}


@pytest.mark.slow
@pytest.mark.parametrize("by", [by for by, fewest in VANISHING.items() if fewest > 1])
def test_fewer_cylinders_cannot(by: str) -> None:
    listed = objectives.listed(by)
    forces = {int(each.order or 0) for each in listed if each.quantity == "force"}
    moments = {int(each.order or 0) for each in listed if each.quantity == "moment"}
    fewest = fewest_cylinders(listed)
    assert not any(polygons.can_vanish(count, forces, moments) for count in range(2, fewest))
    found = design(fewest, by=by, masses=[400, *[None] * (fewest - 1)], spacing=1.0)
    assert set(found[0].values) == {0.0}


@pytest.mark.parametrize(("by", "fewest"), VANISHING.items())
def test_the_fewest_cylinders(by: str, fewest: int) -> None:
    assert fewest_cylinders(objectives.listed(by)) == fewest


def test_three_cranks_keep_the_second_order_force() -> None:
    (one,) = design(3, by=YST, masses=[400, None, None], spacing=1.0)
    np.testing.assert_allclose(masses(one), [400, 800, 400], rtol=1e-12)
    assert one.throws_deg == (0.0, 180.0, 0.0)
    # All three in phase at order 2.
    a2 = abs(PARTS.harmonics([2])[0])
    omega = 240 * np.pi / 30
    assert one.value == 0.0
    assert one.values[2] == pytest.approx(1600 * 0.3 * a2 * omega**2, rel=1e-12)


# --- the call -----------------------------------------------------------------------------------


def test_what_is_left_of_a_linear_question_is_least() -> None:
    # Only one mass is free: force and couple cannot both vanish; the force can.
    (one,) = design(
        3, masses=[400, None, 400], spacing=1.0, throws_deg=[0, 180, 0], by="[1].force.peak"
    )
    assert masses(one)[1] == pytest.approx(800.0, rel=1e-12)
    (one,) = design(3, masses=[400, None, 500], spacing=1.0, throws_deg=[0, 180, 0])
    assert masses(one)[1] == pytest.approx(900.0, rel=1e-12)
    assert one.values[0] == 0.0
    assert one.values[1] == pytest.approx(0.3 * 100 * (240 * np.pi / 30) ** 2, rel=1e-12)


def test_what_cannot_vanish_is_least() -> None:
    unit = 0.3 * (240 * np.pi / 30) ** 2
    # Forces 5, 3 and 1 close no triangle; opposite they leave 1.
    (one,) = design(3, masses=[5, 3, 1], spacing=1.0, by="[1].force.peak")
    assert one.throws_deg == (0.0, 180.0, 180.0)
    assert one.value == pytest.approx(unit, rel=1e-12)
    assert one.isolated
    # The force vanishes with any throw of the third; the moment is least, 400 − 300, with the outer
    # cranks in phase. The minimum is flat: its place is known to the root of its rounding.
    (one,) = design(3, masses=[400, None, 300], spacing=1.0)
    assert one.values == pytest.approx([0.0, 100 * unit], rel=1e-10)
    np.testing.assert_allclose(masses(one), [400, 700, 300], rtol=1e-9)
    assert one.isolated


def test_masses_by_themselves_and_places_by_themselves() -> None:
    equal = design(4, masses=[400, None, None, 400], spacing=0.5, throws_deg=[0, 180, 180, 0])
    np.testing.assert_allclose(masses(equal[0]), 400.0, rtol=1e-12)
    placed = design(3, positions=[0, None, 2.0], throws_deg=[0, 120, 240], by="[1].force.peak")
    assert placed[0].value == 0.0
    assert not placed[0].isolated
    assert "masses, places or throws nearby" in repr(placed)


def test_an_offset_of_the_pins_changes_nothing_but_the_mirror_image() -> None:
    plain = design(masses=[50, 60, None, 50], spacing=0.2)
    offset = design(masses=[50, 60, None, 50], spacing=0.2, cylinder=OFFSET)
    assert len(plain) == 1
    assert len(offset) == 2
    assert [masses(each)[2] for each in offset] == pytest.approx([masses(plain[0])[2]] * 2)
    assert not offset[0].images
    assert list(plain[0].images) == ["mirrored"]


def test_orders_that_a_cylinder_lacks_ask_nothing() -> None:
    simple = cp.Cylinder(0.3, np.inf, 400.0)
    (one,) = design(3, by=ALL, masses=[400, None, None], spacing=1.0, cylinder=simple)
    assert set(one.values) == {0.0}
    with pytest.raises(cp.InputError, match="no force of this order"):
        design(3, by="[2].force.peak", masses=[400, None, None], spacing=1.0, cylinder=simple)


def test_progress_and_seeds() -> None:
    steps: list[tuple[int, int]] = []
    given: dict[str, Any] = {"masses": [400, None, None, 400], "positions": [0, 0.6, 1.2, 1.8]}
    one = design(by=YST, **given, progress=lambda done, total: steps.append((done, total)))
    assert steps[-1][0] == steps[-1][1]
    other = design(by=YST, **given, seed=3)
    np.testing.assert_allclose(masses(one[0]), masses(other[0]), rtol=1e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"masses": [400, None, 400]}, r"masses = \[400, None, 400\]: give one mass, kg, for each"),
        ({"masses": [400, 0.0, None, 1]}, "masses = .*: give masses above zero"),
        ({"masses": [None] * 4}, "masses = .*: give one mass at least"),
        ({"masses": [1, 2, 3, 4], "throws_deg": [0] * 4}, "masses = .*: give None in masses, "),
        ({"positions": [0, None, None, None]}, "positions = .*: give places that ascend"),
        ({"positions": [0, 1, 0.5, None]}, "positions = .*: give places that ascend"),
        ({"masses": [1, None, 1, 1], "spacing": None}, "spacing = None: give it, or positions"),
        ({"masses": [1, None, 1, 1], "throws_deg": [0, None]}, "throws_deg = .*: give one angle"),
        ({"masses": [1, None, 1, 1], "throws_deg": "any"}, "throws_deg = 'any': give one angle"),
        ({"masses": [1, None, 1, 1], "by": "total.force.peak"}, "by = 'total.force.peak': unlike"),
        ({"masses": [1, None, 1, 1], "by": "[1].torque.peak"}, "by = .*: unlike cylinders are"),
        ({"masses": [1, None, 1, 1], "even_firing": True}, "masses = .*: unlike cylinders stand"),
        ({"masses": [1, None, 1, 1], "shafts": [-1]}, "masses = .*: unlike cylinders stand"),
        ({"masses": [1, None, 1, 1], "rotating_mass": 1.0}, "rotating_mass = 1.0: unlike"),
        # The force of three cranks at 0° has no mass to meet it.
        (
            {"masses": [1, None, 1, 1], "throws_deg": [0, 0, 0, 0], "by": "[1].force.peak"},
            "by cannot be reached with positive masses",
        ),
    ],
)
def test_bad_input(given: dict[str, Any], words: str) -> None:
    with pytest.raises(cp.InputError, match=words):
        design(**{"spacing": 0.5} | given)


def test_any_subset_of_positions_may_be_unknown() -> None:
    z = [0.0, 0.6, 1.2, 1.8]
    for free in itertools.combinations(range(4), 2):
        places = [None if k in free else each for k, each in enumerate(z)]
        found = design(masses=[400, None, None, 400], positions=places, by=PRIMARY)
        for one in found:
            assert (np.diff(one.engine.z) > 0).all()
            is_balanced(one)
