"""Does an inverse design find the engines that were built, and those that a grid finds?"""

from __future__ import annotations

import itertools
import math
import pickle
from fractions import Fraction
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.arrangements.cranks import Crank, Symmetries
from crankpin.analysis.design.families import engines_of
from rederivation import design as brute
from support import html_of
from support.designing import A2, RPM, SPACING, UNIT, design, question
from support.engines import CYLINDER, OFFSET

CROSS_PLANE: dict[str, Any] = {"bank_angle_deg": 90, "throws_deg": [0, 90, 180, 270]}
"""A V8 whose four throws all point another way."""


# --- engines that were built --------------------------------------------------------------------


def test_even_firing_v10_on_shared_pins() -> None:
    found = design(10, bank_angle_deg=(60, 120), even_firing=True, by="total.moment.peak")
    assert found.cranks == 24
    assert {each.bank_angle_deg for each in found} == {72.0}
    assert found[0].throws_deg == (0.0, 144.0, 216.0, 288.0, 72.0)
    assert all(each.engine.firing_orders()[0].even for each in found)
    assert sum(each.equivalents for each in found) == 24
    values = [each.value for each in found]
    assert values == sorted(values)


def test_v10_with_counterweights_stands_at_90() -> None:
    found = design(
        10,
        bank_angle_deg=(60, 120),
        counterweights=True,
        by=["[1].moment.backward", "[2].moment.peak"],
    )
    assert {each.bank_angle_deg for each in found} == {90.0}
    assert all(each.value == 0.0 for each in found)
    assert found[0].throws_deg == (0.0, 72.0, 288.0, 144.0, 216.0)
    grid = [60.0 + k for k in range(61)]
    best = brute.least([0, 72, 144, 216, 288], grid, [1, 2], counterweights=True)
    assert best.bank_angle_deg == 90.0
    assert best.value < 1e-9
    images = {each.throws_deg for each in found[0].images.values()}
    assert best.throws_deg in {found[0].throws_deg, *images}
    second = brute.couple(np.array(best.throws_deg), 90.0, 2) * UNIT * A2 * SPACING
    # The grid of crank angles passes the peak by at most half a degree.
    assert found[0].values[1] == pytest.approx(second, rel=2e-4)


def test_the_least_first_order_couple_of_v10s_at_72_by_a_grid() -> None:
    found = design(10, bank_angle_deg=72, by="[1].moment.peak")
    best = brute.least([0, 72, 144, 216, 288], [72.0], [1], counterweights=False)
    assert best.throws_deg in {
        found[0].throws_deg,
        *(i.throws_deg for i in found[0].images.values()),
    }
    assert found[0].throws_deg == (0.0, 144.0, 216.0, 288.0, 72.0)
    assert found[0].value == pytest.approx(best.value * UNIT * SPACING, rel=2e-4)


def test_four_throw_cranks_of_a_90_degree_v8() -> None:
    bare = design(8, **CROSS_PLANE, by="[1].moment.peak")
    assert bare[0].throws_deg == (0.0, 180.0, 90.0, 270.0)
    couples = {each.throws_deg: each.value / (UNIT * SPACING) for each in bare}
    # √10 and √2 of a·m·r·ω² (balancing and torque, table): a ratio of √5.
    assert couples[0, 180, 90, 270] == pytest.approx(math.sqrt(2.0), rel=1e-12)
    assert couples[0, 90, 270, 180] == pytest.approx(math.sqrt(10.0), rel=1e-12)
    weighted = design(8, **CROSS_PLANE, counterweights=True, by="[1].moment.peak,[2].moment.peak")
    assert weighted[0].throws_deg == (0.0, 90.0, 270.0, 180.0)
    assert weighted[0].values == (0.0, 0.0)
    assert weighted[0].engine.vanishing_orders([1, 2]).moment.vanishing == (1, 2)


def test_even_firing_60_degree_v6_has_its_pins_split_by_minus_60() -> None:
    v6: dict[str, Any] = {"even_firing": True, "shared_pins": False, "counterweights": True}
    found = design(6, **v6, bank_angle_deg=60, by="[1].moment.backward")
    assert found[0].pin_split_deg == (-60.0, -60.0, -60.0)
    assert found[0].value == 0.0
    assert found[1].value > 0.1 * UNIT * SPACING
    assert found[0].engine.firing_orders()[0].even
    own = cp.Engine.preset("v6-60")
    np.testing.assert_array_equal(found[0].engine.pin_split_deg, own.pin_split_deg)
    # With the bank angle free too, 60° is where it is.
    free = design(6, **v6, bank_angle_deg=(50, 80), by="[1].moment.backward")
    assert (free[0].bank_angle_deg, free[0].pin_split_deg) == (60, (-60, -60, -60))


def test_an_odd_fire_90_degree_v6_from_its_intervals() -> None:
    found = design(
        6, bank_angle_deg=(40, 130), intervals_deg=[150, 90] * 3, by="[1].moment.backward"
    )
    assert {each.bank_angle_deg for each in found} == {90.0}
    preset = cp.Engine.preset("v6-90-odd-fire")
    assert tuple(preset.throws_deg) in {
        found[0].throws_deg,
        *(image.throws_deg for image in found[0].images.values()),
    }


@pytest.mark.parametrize(
    ("cylinders", "layout", "given", "throws"),
    [
        (4, "inline", {}, (0, 180, 180, 0)),
        (6, "inline", {}, (0, 120, 240, 240, 120, 0)),
        (8, "vee", {"bank_angle_deg": 90}, (0, 180, 180, 0)),
    ],
)
def test_throws_that_point_the_same_way_are_compared_too(
    cylinders: int, layout: str, given: dict[str, Any], throws: tuple[float, ...]
) -> None:
    by = "[1].moment.peak" if layout == "vee" else "total.moment.peak"
    best = design(cylinders, layout, **given, by=by)[0]
    assert (best.throws_deg, best.value) == (throws, 0.0)


@pytest.mark.parametrize(
    ("cylinders", "given", "intervals"),
    [
        (6, {"bank_angle_deg": (40, 130)}, [150, 90] * 3),
        (4, {"bank_angle_deg": 90, "shared_pins": False}, [180, 90, 180, 270]),
        (4, {"layout": "inline"}, [180, 180, 180, 180]),
        # Only its mirror image fires in this sequence.
        (3, {"layout": "inline"}, [100, 200, 420]),
        (2, {"layout": "inline", "strokes": 2}, [180, 180]),
    ],
)
def test_designs_fire_at_the_intervals_asked_for(
    cylinders: int, given: dict[str, Any], intervals: list[int]
) -> None:
    found = design(cylinders, **given, intervals_deg=intervals, by="[1].moment.peak")
    turned = [[*intervals[k:], *intervals[:k]] for k in range(cylinders)]
    for each in found:
        engine = each.engine
        assert engine.strokes == sum(intervals) / 180
        firings = engine.firing_schedules(engine.firing_order)
        assert any(list(firing.intervals_deg) in turned for firing in firings), engine.firing_order


@pytest.mark.parametrize(
    ("cylinders", "layout", "given"), [(6, "inline", {}), (12, "vee", {"bank_angle_deg": 60})]
)
def test_what_needs_nothing(cylinders: int, layout: str, given: dict[str, Any]) -> None:
    by = [f"[{n}].{what}.peak" for n in (1, 2) for what in ("force", "moment")]
    found = design(cylinders, layout, **given, even_firing=True, by=by)
    engines = [each for each in found if each.place == 1]
    assert all(each.values == (0.0,) * 4 for each in engines)
    proved = engines[0].engine.vanishing_orders([1, 2])
    assert proved.force.vanishing == proved.moment.vanishing == (1, 2)
    assert (0, 120, 240, 240, 120, 0) in {each.throws_deg for each in engines}


def test_both_five_cylinder_cranks() -> None:
    first = design(5, "inline", even_firing=True, by="[1].moment.peak")
    second = design(5, "inline", even_firing=True, by="[2].moment.peak")
    # Balancing and torque, table: 0.449028 at order 1 and 4.979797 at order 2, or the reverse.
    assert first[0].value / (UNIT * SPACING) == pytest.approx(0.449028, abs=1e-6)
    assert second[0].value / (UNIT * SPACING * A2) == pytest.approx(0.449028, abs=1e-6)
    assert first[-1].value / (UNIT * SPACING) == pytest.approx(4.979797, abs=1e-6)


def test_a_boxer() -> None:
    found = design(6, "boxer", even_firing=True, by="total.force.peak,total.moment.peak")
    assert found[0].values == (0.0, 0.0)
    assert set(found[0].pin_split_deg) == {180.0}


# --- candidates ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("cylinders", "angle", "throws"), [(4, 180, 2), (6, 120, 3), (8, 90, 4), (8, 180, 4)]
)
def test_all_even_firing_cranks_are_there(cylinders: int, angle: int, throws: int) -> None:
    found = design(
        cylinders, bank_angle_deg=angle, even_firing=True, by="total.force.peak", count=10_000
    )
    step = 720 // cylinders
    expected = set()
    for rest in itertools.product(range(0, 360, step), repeat=throws - 1):
        engine = cp.Engine.vee(
            CYLINDER, bank_angle_deg=angle, throws_deg=[0, *rest], spacing=SPACING
        )
        if engine.firing_orders()[0].even:
            expected.add((0.0, *map(float, rest)))
    listed = {each.throws_deg for each in found}
    listed |= {image.throws_deg for each in found for image in each.images.values()}
    assert listed == expected
    assert found.cranks == len(expected) == sum(each.equivalents for each in found)


def test_splits_of_their_own_are_all_there() -> None:
    found = design(
        4, bank_angle_deg=60, even_firing=True, shared_pins=False, same_split=False,
        by="total.force.peak", count=10_000,
    )  # fmt: skip
    expected = set()
    for second, one, two in itertools.product((0, 180), repeat=3):
        # Left minus right TDC of each throw, 60° less the split.
        tdcs = [0, one, -second, two - second]
        if sorted(tdc % 360 for tdc in tdcs) == [0, 0, 180, 180]:
            splits = tuple(float(180 - (180 - 60 + late) % 360) for late in (one, two))
            expected.add(((0.0, float(second)), splits))
    listed = {(each.throws_deg, each.pin_split_deg) for each in found}
    listed |= {(i.throws_deg, i.pin_split_deg) for each in found for i in each.images.values()}
    assert listed == expected
    assert all(each.engine.firing_orders()[0].even for each in found)


@pytest.mark.parametrize(
    ("cylinder", "stagger", "angle", "count"),
    [
        (CYLINDER, 0.0, 67, 3),
        (CYLINDER, 0.02, 67, 1),
        (OFFSET, 0.0, 67, 1),
        (OFFSET, 0.02, 67, 0),
        (CYLINDER, 0.0, 180, 7),
        (CYLINDER, 0.02, 180, 3),
        (OFFSET, 0.0, 180, 3),
        (OFFSET, 0.02, 180, 1),
    ],
)
def test_images_shake_alike(cylinder: cp.Cylinder, stagger: float, angle: int, count: int) -> None:
    asked = question(8, cylinder=cylinder, bank_stagger=stagger, rotating_mass=0.3)
    crank = Crank.of([0, 80, Fraction(360, 7), 200], [10, -20, 30, 170], angle)
    images = dict(Symmetries(offset=cylinder is OFFSET, staggered=stagger > 0).images(crank))
    assert len(images) == count
    own, *others = engines_of(asked, [crank, *images.values()])
    for other in others:
        for n in (1, 2, 3, 4):
            a, b = (each.balance(RPM, orders=[n])[n] for each in (own, other))
            assert a.force.peak == pytest.approx(b.force.peak, rel=1e-9, abs=1e-6)
            assert a.moment.peak_xy == pytest.approx(b.moment.peak_xy, rel=1e-9, abs=1e-6)
            assert abs(a.moment.backward) == pytest.approx(abs(b.moment.backward), abs=1e-6)
            assert a.torque.peak == pytest.approx(b.torque.peak, rel=1e-9, abs=1e-6)
    if stagger or cylinder is OFFSET:
        # What is left out does not shake alike.
        every = dict(Symmetries().images(crank))
        for change in every.keys() - images.keys():
            (other,) = engines_of(asked, [every[change]])
            a, b = (each.balance(RPM).total for each in (own, other))
            assert not np.allclose(a.moment.peak_xy, b.moment.peak_xy, rtol=1e-6)


# --- balancers ----------------------------------------------------------------------------------


@pytest.mark.parametrize("cylinder", [CYLINDER, OFFSET])
def test_counterweights_remove_the_forward_part_and_nothing_else(cylinder: cp.Cylinder) -> None:
    given: dict[str, Any] = {"bank_angle_deg": 77, "cylinder": cylinder, "rotating_mass": 0.4}
    by = "[1].moment.backward"
    bare = design(6, **given, by=by, count=1)[0].engine.balance(RPM)[1]
    weighted = design(6, **given, by=by, count=1, counterweights=True)[0].engine.balance(RPM)[1]
    assert abs(weighted.moment.forward) < 1e-12 * abs(bare.moment.forward)
    assert abs(weighted.moment.backward) == pytest.approx(abs(bare.moment.backward), rel=1e-12)
    assert abs(bare.moment.forward) > 1.0


def test_shafts_remove_their_part_and_nothing_else() -> None:
    given: dict[str, Any] = {"bank_angle_deg": 77, "by": "[1].moment.peak"}
    given |= {"throws_deg": [0, 120, 250]}
    crank = design(6, **given)[0]
    found = design(6, **given, shafts=[-1, 2])
    with_shafts = next(each.engine for each in found if each.crank == crank.crank)
    bare, smooth = (each.balance(RPM) for each in (crank.engine, with_shafts))
    for quantity in ("force", "moment"):
        a, b = getattr(bare, quantity), getattr(smooth, quantity)
        scale = abs(a).max()
        one, two = (bare.orders.index(n) for n in (1, 2))
        assert abs(b.backward[one]) < 1e-12 * scale < abs(a.backward[one])
        assert abs(b.forward[two]) < 1e-12 * scale < abs(a.forward[two])
        np.testing.assert_allclose(b.forward[one], a.forward[one], rtol=1e-12)
        np.testing.assert_allclose(b.backward[two], a.backward[two], rtol=1e-12)
    np.testing.assert_allclose(smooth.torque.phasor, bare.torque.phasor, atol=1e-9)


def test_a_v6_needs_one_shaft_of_order_2() -> None:
    found = design(
        6, bank_angle_deg=60, even_firing=True, shared_pins=False, counterweights=True,
        shafts=[-2], by="[1].moment.peak,[2].moment.peak",
    )  # fmt: skip
    assert found[0].pin_split_deg == (-60.0, -60.0, -60.0)
    assert found[0].values[0] == 0.0
    assert found[0].values[1] < 1e-12 * UNIT
    assert [shaft.ratio for shaft in found[0].engine.shafts] == [-2]


def test_shafts_at_halves_find_nothing_to_remove_beside_pistons() -> None:
    given: dict[str, Any] = {"by": "[2].moment.peak", "throws_deg": [0, 120, 250]}
    given |= {"bank_angle_deg": 77}
    plain, halves = (design(6, **given, shafts=shafts) for shafts in ([-2], ["-2", "3/2", -0.5]))
    assert [shaft.ratio for shaft in halves[0].engine.shafts] == [-2, 1.5, -0.5]
    assert [each.values for each in halves] == [each.values for each in plain]


def test_shafts_are_fitted_anew_at_other_bank_angles() -> None:
    given: dict[str, Any] = {"by": "[2].moment.peak", "shafts": [-2], "throws_deg": [0, 120, 250]}
    found = design(6, bank_angle_deg=77, **given)
    other = design(6, bank_angle_deg=90, **given)
    values = found.over_bank_angle(np.array([77.0, 90.0]))[0]
    same = next(each for each in other if each.throws_deg == found[0].throws_deg)
    assert values.tolist() == [found[0].value, same.value]
    assert values[0] != values[1]


# --- arguments and result -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"cylinders": 5}, "cylinders = 5: give an even number"),
        ({"cylinders": 0}, "cylinders = 0"),
        ({"layout": "w"}, "layout = 'w'"),
        ({"bank_angle_deg": None}, "bank_angle_deg = None: give an angle"),
        ({"bank_angle_deg": (90, 60)}, "give an angle, or the lowest and the highest, 0 to 180"),
        ({"bank_angle_deg": (60, 90, 120)}, "the lowest and the highest"),
        ({"layout": "inline"}, 'layout="inline" has no banks; leave it out'),
        ({"layout": "boxer"}, 'layout="boxer" has its banks at 180'),
        ({"shared_pins": True, "pin_split_deg": 10}, "shared pins have none"),
        ({"throws_deg": [0, 120]}, "give 3 angles"),
        ({"throws_deg": "any"}, "give 3 angles"),
        ({"throws_deg": "free", "even_firing": True}, "the firing intervals determine the throws"),
        ({"even_firing": True, "intervals_deg": [120] * 6}, "leave it out, or even_firing"),
        ({"intervals_deg": [100] * 6}, "give 6 intervals"),
        ({"even_firing": True, "bank_angle_deg": (50, 100)}, "no crank fires at these intervals"),
        ({"shafts": [1]}, "give different speed ratios"),
        ({"shafts": [-1, -1]}, "give different speed ratios"),
        ({"count": 0}, "count = 0"),
        ({"seed": -1}, "seed = -1"),
        ({"tie_rtol": 1.0}, "tie_rtol"),
        ({"by": None}, "by = None"),
        ({"by": "[1].moment.size"}, "by = "),
        ({"by": "[0.5].torque.peak"}, "designs have no gas pressure"),
        ({"by": "total.torque.gas.peak"}, "designs have no gas pressure"),
        ({"by": lambda b: b.rpm}, "rank the engines"),
        ({"by": "unevenness_deg"}, "rank the engines"),
        ({"orders": [2], "bank_angle_deg": 60}, "needs order 1"),
        ({"cylinders": 24, "bank_angle_deg": 60}, "more than 50000 cranks"),
    ],
)
def test_what_cannot_be_designed(given: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"cylinders": 6, "bank_angle_deg": (60, 90)}
    arguments |= {"by": "[1].moment.peak"} | given
    with pytest.raises(cp.InputError) as caught:
        design(**arguments)
    assert message in str(caught.value)


def test_an_angle_may_be_an_array_without_dimensions() -> None:
    found = design(6, bank_angle_deg=np.array(60.0), by="total.moment.peak")
    assert found == design(6, bank_angle_deg=60, by="total.moment.peak")


@pytest.mark.parametrize("by", ["total.moment.peak", "[1].moment.backward", "total.torque.peak"])
@pytest.mark.parametrize("rotating", [0.0, 0.5])
def test_cylinders_without_mass_leave_every_choice(by: str, rotating: float) -> None:
    cylinder = CYLINDER.replace(reciprocating_mass=0.0)
    found = design(4, bank_angle_deg=(30, 120), cylinder=cylinder, rotating_mass=rotating, by=by)
    assert found[0].value == 0.0
    assert found.table.cells()


def test_a_function_where_nothing_varies() -> None:
    by = [lambda b: b.total.moment.peak, "unevenness_deg"]
    found = design(6, bank_angle_deg=60, by=by)
    named = design(6, bank_angle_deg=60, by="total.moment.peak")
    # A function is called with a balance, a name is read from a sweep: other roundings.
    assert [each.value for each in found] == pytest.approx(
        [each.value for each in named], rel=1e-13
    )
    with pytest.raises(cp.InputError, match="give the name of a force"):
        found.over_bank_angle(np.array([60.0]))


def test_the_result_is_a_table() -> None:
    found = design(8, **CROSS_PLANE, by="[1].moment.peak,[2].moment.peak", count=2)
    assert (found.optima, len(found), found.cranks) == (3, 2, 6)
    lines = repr(found).splitlines()
    assert lines[0].endswith("order 2, 6000 rpm; 2 of 3")
    assert lines[2].split()[:4] == ["1", "0-180-90-270", "90", "2"]
    assert "<table>" in html_of(found)
    table = found.to_pandas()
    assert table["order-2 rocking moment N·m"].tolist() == [each.values[1] for each in found]
    assert table["throws °"].tolist() == [each.crank.text for each in found]
    assert "Engine" not in repr(found[0])
    again = pickle.loads(pickle.dumps(found))  # noqa: S301 - our own
    assert again == found
    assert hash(again) == hash(found)
    assert again[1].engine == found[1].engine
    # A sweep over bank angles turns the sum of each bank, designs sum their cylinders: either has
    # some eight roundings of eight moments, which make 8 in phase.
    np.testing.assert_allclose(
        again.over_bank_angle(np.array([60.0, 90.0]), 2)[:, 1],
        [each.value for each in found],
        rtol=0,
        atol=8 * np.finfo(float).eps * (8 * UNIT * SPACING),
    )


def test_ties_share_a_place() -> None:
    found = design(10, bank_angle_deg=90, counterweights=True, by="[1].moment.peak")
    assert [each.place for each in found] == [1] * 8
    # Couples of √2, √8 and √10; in phase all cylinders would make 8.
    for tolerance, places in ((0.04, [1, 2, 3]), (0.05, [1, 2, 2]), (0.25, [1, 1, 1])):
        found = design(8, **CROSS_PLANE, by="[1].moment.peak", tie_rtol=tolerance)
        assert [each.place for each in found] == places


def test_units_are_warned_of_once() -> None:
    with pytest.warns(UserWarning, match="spacing") as caught:
        design(6, bank_angle_deg=60, by="[1].moment.peak", spacing=130.0)
    assert len(caught) == 1
    assert caught[0].filename.endswith("designing.py")
    with pytest.warns(UserWarning, match="mean piston speed") as caught:
        design(6, bank_angle_deg=60, by="total.moment.peak", rpm=60_000)
    assert len(caught) == 1


def test_another_bank_angle_is_that_of_the_library() -> None:
    found = design(
        6, bank_angle_deg=(50, 80), even_firing=True, shared_pins=False, by="[1].moment.backward",
        counterweights=True,
    )  # fmt: skip
    angles = np.array([55.0, 60.0, 71.5])
    engine = cp.Engine.vee(
        CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], pin_split_deg=-60, spacing=SPACING
    )
    swept = cp.sweep(engine, rpm=RPM, bank_angle_deg=angles, hold="firing", orders=[1])
    np.testing.assert_allclose(
        found.over_bank_angle(angles)[0], abs(swept[1].moment.backward), rtol=1e-9, atol=1e-6
    )


@pytest.mark.parametrize(
    ("limits", "splits"),
    [((-180, 180), {-60, 60, 180}), ((-90, 0), {-60}), ((0, 90), {60}), ((100, 180), {180})],
)
def test_splits_stay_within_their_limits(limits: tuple[int, int], splits: set[int]) -> None:
    found = design(
        6, bank_angle_deg=60, even_firing=True, pin_split_deg=limits, by="[1].moment.peak"
    )
    assert {each.pin_split_deg[0] for each in found} == splits
