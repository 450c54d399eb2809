"""Does the search find every balanced bank angle, and no other?"""

from __future__ import annotations

import copy
import csv
import itertools
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

import crankpin as cp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from rederivation import ito
from rederivation import search as numpy_search
from support import DATA
from support.engines import CYLINDER

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

MOMENT = 0.5 * 0.045 * (2 * np.pi * 3000 / 60) ** 2
"""m·r·ω² at 3000 rpm; with a spacing of 1 m moments are in units of it."""


def brute_force(phases: list[int], parts: int) -> tuple[int, int, set[int]]:
    """All pairs of arrangements, one by one, in doubles.

    Pairs with equal |Z|, those of them with Z = 0, and the distinct |α| in units of 1e-7 degrees:
    doubles are enough for so few throws (the classes are 1e-3 apart).
    """
    weights = np.arange(len(phases)) - (len(phases) - 1) / 2
    arrangements = np.array(sorted(set(itertools.permutations(phases))))
    moments = (weights * np.exp(2j * np.pi * arrangements / parts)).sum(axis=1)
    sizes = np.abs(moments)
    pairs = zeros = 0
    angles: set[int] = set()
    for moment, size in zip(moments, sizes, strict=True):
        equal = np.abs(sizes - size) < 1e-9
        pairs += int(equal.sum())
        if size < 1e-9:
            zeros += int(equal.sum())
            continue
        degrees = np.abs(np.degrees(np.angle(-moments[equal] / moment)))
        angles |= set(np.round(degrees * 1e7).astype(int).tolist())
    merged = [-9, *sorted(angles)]
    distinct = {b for a, b in itertools.pairwise(merged) if b - a > 2}
    return pairs, zeros, distinct


@pytest.mark.parametrize(
    ("cylinders", "phases_deg", "phases", "parts", "printed"),
    [
        (6, None, [0, 1, 2], 3, (36, 0, 4)),
        (8, [0, 90, 180, 270], [0, 1, 2, 3], 4, (192, 0, 7)),
        (10, None, [0, 1, 2, 3, 4], 5, (2_000, 0, 46)),
        (14, None, [0, 1, 2, 3, 4, 5, 6], 7, (169_344, 0, 2_248)),
        (12, [0, 60, 120, 180, 240, 300], [0, 1, 2, 3, 4, 5], 6, (27_648, 576, 46)),
        (8, None, [0, 0, 1, 1], 2, None),
        (12, None, [0, 0, 1, 1, 2, 2], 3, None),
        (4, None, [0, 0], 1, None),
        (6, [0, 90, 180], [0, 1, 2], 4, None),
        (8, [0, 0, 72, 144], [0, 0, 1, 2], 5, None),
    ],
)
def test_counts_are_those_of_brute_force(
    cylinders: int,
    phases_deg: list[int] | None,
    phases: list[int],
    parts: int,
    printed: tuple[int, int, int] | None,
) -> None:
    search = cp.search_arrangements(cylinders, phases_deg=phases_deg)
    pairs, zeros, angles = brute_force(phases, parts)
    assert (search.qualifying, search.balanced, len(search)) == (pairs, zeros, len(angles))
    assert search.candidates == len(set(itertools.permutations(phases))) ** 2
    # rounded to 1e-7 degrees, and arccosines near 0 and 180 good to 1e-6 at worst
    np.testing.assert_allclose(search.bank_angles_deg, np.array(sorted(angles)) / 1e7, atol=2e-6)
    if printed:
        assert (pairs, zeros, len(angles)) == printed


def pairs_by_angle(
    arrangements: NDArray[np.int64], parts: int, hold: str
) -> dict[int, NDArray[np.float64]]:
    """All pairs with Z, by the bank angle in units of 1e-6 degrees.

    Of each the larger second-order moment and the forward one of first order, over m·r·ω²·spacing
    and over a₂: of levers, bores and top dead centres, cylinder by cylinder.
    """
    levers = (arrangements.shape[1] - 1) / 2 - np.arange(arrangements.shape[1])
    turned = np.exp(2j * np.pi * arrangements / parts)
    moments = [(levers * turned**n).sum(axis=1) for n in (1, 2)]
    sizes = np.abs(moments[0])
    found = []
    for k in np.flatnonzero(sizes > 1e-9):
        equal = np.abs(sizes - sizes[k]) < 1e-9
        condition = np.angle(-moments[0][equal] / moments[0][k])
        halves = (0.5 * condition, 0.5 * condition - np.copysign(np.pi, condition))
        for angle in (condition,) if hold == "firing" else halves:
            # A left bank at a negative angle is the right one.
            bores = [np.exp(1j * (0.5 * np.pi + side * angle)) for side in (-0.5, 0.5)]
            banks = [[moment[k], moment[equal]] for moment in moments]
            if hold == "pins":  # a top dead centre is a bore less a pin
                banks = [
                    [sum_ / bore**n for sum_, bore in zip(bank, bores, strict=True)]
                    for n, bank in enumerate(banks, 1)
                ]
            one, two = (list(zip(bank, bores, strict=True)) for bank in banks)
            forward = abs(sum(0.5 * bore * sum_ for sum_, bore in one))
            about = [
                abs(sum(part(bore) * sum_ for sum_, bore in two)) for part in (np.real, np.imag)
            ]
            columns = np.abs(np.degrees(angle)), np.maximum(*about), forward
            found.append(np.stack(columns, axis=1))
    rows = np.concatenate(found)
    rows = rows[np.argsort(rows[:, 0])]
    ends = np.flatnonzero(np.diff(rows[:, 0]) > 1e-6) + 1
    groups = np.split(rows, ends)
    return {round(group[0, 0] * 1e6): group[:, 1:] for group in groups}


@pytest.mark.parametrize("hold", ["firing", "pins"])
@pytest.mark.parametrize(
    ("cylinders", "phases", "parts"),
    [
        (4, [0, 1], 2),
        (6, [0, 1, 2], 3),
        (8, [0, 0, 1, 1], 2),
        (8, [0, 1, 2, 3], 4),  # two-stroke
        (10, [0, 1, 2, 3, 4], 5),
        (12, [0, 0, 1, 1, 2, 2], 3),
        (12, [0, 1, 2, 3, 4, 5], 6),  # two-stroke
        (8, [0, 1, 3, 7], 12),
        (12, [0, 0, 1, 2, 2, 3], 4),
        (14, None, 7),  # alternating
    ],
)
def test_the_arrangement_of_an_angle_is_the_least_of_all_pairs(
    cylinders: int, phases: list[int] | None, parts: int, hold: Literal["firing", "pins"]
) -> None:
    """Listed is the least second order, of these the least counterweight; or inversely."""
    degrees = None if phases is None else [f"{360 * k}/{parts}" for k in phases]
    search = cp.search_arrangements(
        cylinders, phases_deg=degrees, alternating=phases is None, hold=hold
    )
    permuted = sorted(set(itertools.permutations(phases or [])))
    arrangements = ito.arrangements() if phases is None else np.array(permuted)
    brute = pairs_by_angle(arrangements, parts, hold)
    for by in ("second_order", "counterweight"):
        found = search.best(by, count=len(search))
        assert len(found) == len(search) == len(brute)
        found = tuple(sorted(found, key=lambda each: each.bank_angle_deg))
        if by == "second_order":
            assert found == tuple(search)
        for each, pairs in zip(found, brute.values(), strict=True):
            first = 0 if by == "second_order" else 1
            least = pairs[:, first].min()
            # sums of at most 14 terms of at most 3
            alike = pairs[pairs[:, first] < least + 1e-11]
            second, forward = max(each.second_order), each.counterweight
            assert (second, forward)[first] == pytest.approx(least, abs=1e-11)
            assert (forward, second)[first] == pytest.approx(alike[:, 1 - first].min(), abs=1e-11)


@pytest.mark.parametrize(
    ("alternating", "pairs", "angles"), [(True, 12_936, 218), (False, 169_344, 2_248)]
)
def test_v14_against_the_rederivation(alternating: bool, pairs: int, angles: int) -> None:
    search = cp.search_arrangements(14, alternating=alternating)
    assert (search.qualifying, search.balanced, len(search)) == (pairs, 0, angles)
    theirs = ito.qualifying_angles(ito.arrangements(alternating=alternating))
    sizes = ito.distinct_sizes(theirs)
    # the re-derivation merges to seven digits
    np.testing.assert_allclose(search.bank_angles_deg, np.sort(sizes), atol=2e-7)


def test_all_angles_of_the_v14_paper_and_two_more() -> None:
    search = cp.search_arrangements(14, alternating=True)
    with (DATA / "v14_table1_bank_angles.csv").open(newline="") as file:
        printed = np.array([float(row["bank_angle_deg"]) for row in csv.DictReader(file)])
    assert len(printed) == 216
    nearest = np.abs(printed[:, None] - search.bank_angles_deg).argmin(axis=1)
    assert len(set(nearest.tolist())) == 216
    # printed to 0.01°, one of them (1.415) cut off rather than rounded
    assert np.abs(search.bank_angles_deg[nearest] - printed).max() < 0.0052
    missing = np.delete(search.bank_angles_deg, nearest)
    assert missing.round(2).tolist() == [90.91, 152.87]
    # their supplements are printed: a bank reversed changes the sign of Z
    assert np.abs(180 - missing[:, None] - printed).min(axis=1).max() < 0.0051


def test_no_exact_count_can_be_the_papers() -> None:
    """Both cranks turned (7), both banks end for end (2): each time another pair that qualifies."""
    for alternating in (True, False):
        assert cp.search_arrangements(14, alternating=alternating).qualifying % 14 == 0
    assert 7_682 % 14 != 0


@pytest.mark.parametrize(
    ("angle", "amplitude", "second"),
    [
        (49.54, 1.5363, (1.232, 7.214)),
        (63.03, 4.9216, (5.580, 7.828)),
        (9.13, 0.480, (1.250, 1.408)),
        (170.87, 0.480, (1.408, 1.250)),
    ],
)
def test_worked_cases(angle: float, amplitude: float, second: tuple[float, float]) -> None:
    (found,) = cp.search_arrangements(14, alternating=True).at_bank_angle(angle)
    # printed to these digits
    assert found.counterweight == pytest.approx(amplitude, abs=6e-4)
    assert found.second_order == pytest.approx(second, abs=6e-4)


@pytest.mark.parametrize("hold", ["firing", "pins"])
@pytest.mark.parametrize(
    ("cylinders", "alternating", "phases_deg"),
    [
        (6, False, None),
        (8, False, [0, 90, 180, 270]),
        (10, False, None),
        (12, False, None),
        (14, True, None),
    ],
)
def test_every_engine_keeps_its_promise(
    cylinders: int, alternating: bool, phases_deg: list[int] | None, hold: Literal["firing", "pins"]
) -> None:
    search = cp.search_arrangements(
        cylinders, alternating=alternating, phases_deg=phases_deg, hold=hold
    )
    assert np.all(np.diff(search.bank_angles_deg) > 0)
    ratio = CYLINDER.rod_ratio
    spectrum = {1: 0.5 * 0.045, 2: 0.5 * 0.045 * ratio}
    for found in search:
        engine = found.engine(CYLINDER, spacing=1.0)
        balance = engine.balance(3000, orders=[1, 2], spectrum=spectrum)
        assert balance.moment.backward[0] == 0
        # rounding of a sum of 14 terms of at most 3
        assert abs(balance.moment.forward[0]) / MOMENT == pytest.approx(
            found.counterweight, abs=1e-13
        )
        second = balance.moment.peak_xy[1] / MOMENT / ratio
        np.testing.assert_allclose(second, found.second_order, atol=1e-12)
        banks = engine.bank_deg[:2]
        between = abs(banks[1] - banks[0])
        assert min(between, 360 - between) == pytest.approx(found.bank_angle_deg, abs=1e-12)


def test_what_is_held_matters() -> None:
    """A V6 with pins 0-120-240 in both banks has no backward part at 90°, with its TDCs at 120°."""
    by_pins = cp.search_arrangements(6, hold="pins")
    by_firing = cp.search_arrangements(6, hold="firing")
    assert by_firing.bank_angles_deg.round(9).tolist() == [0, 60, 120, 180]
    # half of 0, 60, 120, 180, and their supplements
    assert by_pins.bank_angles_deg.round(9).tolist() == [0, 30, 60, 90, 120, 150, 180]
    shared = cp.Engine.vee(CYLINDER, bank_angle_deg=90, throws_deg=[0, 120, 240], spacing=1.0)
    assert shared.balance(3000, orders=[1]).moment.backward[0] == 0
    assert by_pins.qualifying == by_firing.qualifying


def test_angles_come_with_their_supplements() -> None:
    """A bank reversed changes the sign of its moment, and the angle to its supplement."""
    for cylinders in (10, 14):
        angles = cp.search_arrangements(cylinders).bank_angles_deg
        np.testing.assert_allclose(np.sort(180 - angles), angles, atol=1e-11)


@pytest.mark.parametrize("throws", [3, 5, 7, 9])
def test_counts_and_all_angles_of_exact_keys_in_numpy(throws: int) -> None:
    found = cp.search_arrangements(2 * throws)
    banks = numpy_search.banks(throws)
    keys = numpy_search.magnitude_keys(banks.levers)
    assert banks.multiplicity.sum() ** 2 == found.candidates
    assert numpy_search.qualifying(keys, banks.multiplicity) == found.qualifying
    angles = np.degrees(numpy_search.bank_angles(banks.levers, keys))
    # Z of magnitude 1e-3 at least, its terms' rounding 1e-15, in degrees
    np.testing.assert_allclose(found.bank_angles_deg, angles, rtol=0, atol=1e-10)


def test_count_of_a_v22() -> None:
    banks = numpy_search.banks(11)
    keys = numpy_search.magnitude_keys(banks.levers)
    found = cp.search_arrangements(22)
    assert found.qualifying == numpy_search.qualifying(keys, banks.multiplicity) == 1_854_562_160


@pytest.mark.slow
def test_classes_crowd_until_no_tolerance_serves() -> None:
    """The least gap between different |2Z|, and how far rounding parts equal ones."""
    gaps, double, single = [], [], []
    for throws in (5, 7, 9, 11):
        banks = numpy_search.banks(throws)
        keys = numpy_search.magnitude_keys(banks.levers)
        gaps.append(numpy_search.smallest_gap(np.unique(keys), throws).of_2z)
        double.append(numpy_search.rounding(banks, keys))
        single.append(numpy_search.rounding(banks, keys, np.float32))
    assert gaps == pytest.approx([0.4596, 1.957e-3, 2.989e-5, 4.286e-9], rel=5e-4)
    assert all(np.array(double) < np.array(gaps))
    # in single precision a tolerance can be found up to a V-18, not for a V-22
    assert (np.array(single) < np.array(gaps)).tolist() == [True, True, True, False]


def test_every_thousandth_engine_of_a_v18() -> None:
    search = cp.search_arrangements(18)
    angles = search.bank_angles_deg
    assert len(angles) == len(search) == 103_510
    assert np.all(np.diff(angles) > 0)
    for k in [*range(0, len(search), 997), len(search) - 1]:
        balance = search[k].engine(CYLINDER, spacing=1.0).balance(3000, orders=[1])
        assert balance.moment.backward[0] == 0
        assert search[k].bank_angle_deg == pytest.approx(angles[k], abs=1e-11)


# --- symmetries -----------------------------------------------------------------------------------

# arg of sums of at most 12 terms, |Z| not below 1e-2 for these few throws
SAME_ANGLE = 1e-9


@st.composite
def phase_sets(draw: st.DrawFn) -> tuple[int, list[int]]:
    """N, and 2 to 5 phases in N-ths of a turn, repeats allowed."""
    parts = draw(st.integers(2, 12))
    return parts, draw(st.lists(st.integers(0, parts - 1), min_size=2, max_size=5))


def searched(
    parts: int, phases: list[int], hold: Literal["firing", "pins"] = "firing"
) -> cp.results.ArrangementSearch:
    texts = [f"{360 * k}/{parts}" for k in phases]
    return cp.search_arrangements(2 * len(phases), phases_deg=texts, hold=hold)


def test_phases_that_are_mirrored_about_another_phase_than_zero() -> None:
    """The same phases turned: 10 bank angles by brute force, whichever comes first."""
    about_zero, elsewhere = (searched(3, phases) for phases in ([1, 1, 2, 2, 0], [0, 0, 1, 1, 2]))
    _, _, angles = brute_force([0, 0, 1, 1, 2], 3)
    assert len(about_zero) == len(angles) == 10
    assert len(elsewhere) == 10


@settings(max_examples=60, deadline=None)
@given(phase_sets(), st.integers(1, 11), st.sampled_from(["firing", "pins"]))
def test_what_leaves_the_answer_alone(
    drawn: tuple[int, list[int]], turn: int, hold: Literal["firing", "pins"]
) -> None:
    """All phases turned alike; all cranks running backward; phases in another order."""
    parts, phases = drawn
    alike = ([k + turn for k in phases], [-k for k in phases], phases[::-1])
    found = searched(parts, phases, hold)
    for others in alike:
        other = searched(parts, others, hold)
        assert other.qualifying == found.qualifying
        assert other.balanced == found.balanced
        assert other.candidates == found.candidates
        np.testing.assert_allclose(
            other.bank_angles_deg, found.bank_angles_deg, rtol=0, atol=SAME_ANGLE
        )


def condition(first: Sequence[float], second: Sequence[float]) -> tuple[complex, complex]:
    """Z of both banks."""
    levers = np.arange(len(first)) - (len(first) - 1) / 2
    one, two = (complex(levers @ np.exp(1j * np.radians(bank))) for bank in (first, second))
    return one, two


@settings(max_examples=40, deadline=None)
@given(phase_sets(), st.data())
def test_the_solutions_are_closed_under_the_symmetries(
    drawn: tuple[int, list[int]], data: st.DataObject
) -> None:
    """A solution reversed, mirrored or with its banks exchanged is one, at an angle found."""
    parts, phases = drawn
    search = searched(parts, phases)
    assume(len(search) > 0)
    found = search[data.draw(st.integers(0, len(search) - 1))]
    one, two = found.first_deg, found.second_deg
    z1, z2 = condition(one, two)
    assert abs(z1) == pytest.approx(abs(z2), abs=1e-12)  # sums of at most 5 terms
    assume(abs(z1) >= 1e-9)  # such an arrangement is balanced at every angle
    alpha = abs(np.degrees(np.angle(-z2 / z1)))
    assert alpha == pytest.approx(found.bank_angle_deg, abs=SAME_ANGLE)
    turned = [tuple(-k for k in bank) for bank in (one, two)]
    for first, second, angle in (
        (two, one, alpha),  # banks exchanged
        (one[::-1], two[::-1], alpha),  # seen from the other end
        (one, two[::-1], 180 - alpha),  # one bank reversed
        (turned[0], turned[1], alpha),  # running backward: a solution for phases with that sign
    ):
        a, b = condition(first, second)
        assert abs(np.degrees(np.angle(-b / a))) == pytest.approx(angle, abs=SAME_ANGLE)
        assert search.at_bank_angle(angle, tolerance_deg=SAME_ANGLE)
        engine = cp.Engine.from_lists(
            CYLINDER,
            tdc_deg=[-k for k in (*first, *second)],
            bank_deg=[90 - np.degrees(np.angle(-b / a)) / 2] * len(first)
            + [90 + np.degrees(np.angle(-b / a)) / 2] * len(first),
            z=[*range(len(first)), *range(len(first))],
        )
        balance = engine.balance(3000, orders=[1])
        # A force at first order makes the moment depend on the plane: the middle is meant.
        # What rounding leaves of ten terms of at most 2, angles in degrees to 1e-14.
        assert abs(balance.moment.backward[0]) / MOMENT < 1e-13


@pytest.mark.parametrize(
    ("cylinders", "alternating", "step"),
    [
        (6, False, 120),
        (8, False, 180),
        (10, False, 72),
        (12, False, 120),
        (14, False, 360 / 7),
        (14, True, 360 / 7),
    ],
)
def test_turning_one_bank_by_a_step_gives_another_angle_of_the_list(
    cylinders: int, alternating: bool, step: float
) -> None:
    search = cp.search_arrangements(cylinders, alternating=alternating)
    angles = search.bank_angles_deg
    for turned in (angles + step, angles - step):
        folded = np.abs((turned + 180) % 360 - 180)
        nearest = np.abs(folded[:, np.newaxis] - angles).min(axis=1)
        assert nearest.max() < SAME_ANGLE


def test_best_and_windows() -> None:
    search = cp.search_arrangements(14, alternating=True)
    everywhere = [max(found.second_order) for found in search]
    assert max(search.best()[0].second_order) == min(everywhere)
    window = search.within(40, 70).best("counterweight", count=5)
    assert all(40 <= found.bank_angle_deg <= 70 for found in window)
    weights = [found.counterweight for found in window]
    assert weights == sorted(weights)
    # All pairs of an angle are compared by it; by a function those listed are.
    inside = [f.counterweight for f in search if 40 <= f.bank_angle_deg <= 70]
    assert weights[0] < min(inside)
    by_function = search.within(40, 70).best(lambda found: found.counterweight, count=5)
    assert [found.counterweight for found in by_function] == sorted(inside)[:5]
    assert search.at_bank_angle(33.0) == ()
    assert search[-1] == search[217]
    table = search.within(0, 30).to_pandas()
    assert len(table) == int((search.bank_angles_deg <= 30).sum())


def test_table_has_every_bank_angle() -> None:
    search = cp.search_arrangements(6)
    table = search.table
    assert list(table["bank angle"].values) == search.bank_angles_deg.tolist()
    last = search[-1]
    assert [column.values[-1] for column in table.columns[2:]] == [
        last.bank_angle_deg, last.counterweight, *last.second_order, "yes",
    ]  # fmt: skip
    assert [float(angle) for angle in table["left bank"].values[-1].split("-")] == [
        *last.second_deg
    ]
    assert len(table.to_csv().splitlines()) == len(search) + 1


def test_moments_that_cancel_are_zero() -> None:
    for search in (cp.search_arrangements(6), cp.search_arrangements(14, alternating=True)):
        moments = np.array([(each.counterweight, *each.second_order) for each in search])
        assert (moments == 0.0).any()
        # Sums of a few sevenths of a turn that do not cancel are not small; rounding leaves 1e-16.
        assert moments[moments > 0.0].min() > 1e-6


def test_objects() -> None:
    search = cp.search_arrangements(6)
    for other in (copy.copy(search), copy.deepcopy(search), pickle.loads(pickle.dumps(search))):  # noqa: S301
        assert other == search
        assert list(other) == list(search)
    assert search != cp.search_arrangements(10)
    assert not search.bank_angles_deg.flags.writeable
    with pytest.raises(AttributeError):
        search.cylinders = 8  # type: ignore[misc]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: cp.search_arrangements(7), ["cylinders", "7", "even"]),
        (lambda: cp.search_arrangements(2), ["cylinders", "2"]),
        (lambda: cp.search_arrangements(26), ["cylinders", "26", "4 to 24"]),
        (lambda: cp.search_arrangements("V6"), ["cylinders", "V6"]),  # type: ignore[arg-type]
        (lambda: cp.search_arrangements(6, phases_deg=[0, 120]), ["phases_deg", "2", "3"]),
        (lambda: cp.search_arrangements(6, phases_deg=[0, np.pi, 9]), ["phases_deg", "rational"]),
        (lambda: cp.search_arrangements(6, phases_deg=[0, 1, "360/7"]), ["phases_deg", "part"]),
        (
            lambda: cp.search_arrangements(6, alternating=True, phases_deg=[0, 120, 240]),
            ["alternating", "leave out"],
        ),
        (lambda: cp.search_arrangements(6).best("beauty"), ["by", "beauty", "counterweight"]),
        (lambda: cp.search_arrangements(6).best(count=-1), ["count", "-1"]),
        (lambda: cp.search_arrangements(6).best(count=1.9), ["count", "1.9", "whole"]),  # type: ignore[arg-type]
        (lambda: cp.search_arrangements(6).best(count=np.inf), ["count", "inf", "whole"]),  # type: ignore[arg-type]
        (lambda: cp.search_arrangements(6).within(np.nan, 10), ["low", "nan"]),
        (lambda: cp.search_arrangements(6).within(10, np.nan), ["high", "nan"]),
    ],
)
def test_what_is_refused(call: object, words: list[str]) -> None:
    with pytest.raises(cp.InputError) as caught:
        call()  # type: ignore[operator]
    assert all(word in str(caught.value) for word in words), caught.value


def test_within_includes_both_ends() -> None:
    search = cp.search_arrangements(6)
    assert search.within(60, 120).bank_angles_deg.tolist() == [60, 120]
    assert search.within(180, 180).bank_angles_deg.tolist() == [180]
    assert search.within(0, 0).bank_angles_deg.tolist() == [0]
    for angle in cp.search_arrangements(14).bank_angles_deg[::100].tolist():
        assert cp.search_arrangements(14).within(angle, angle).bank_angles_deg.tolist() == [angle]
    best = search.within(60, 120).best(count=9)
    assert sorted(found.bank_angle_deg for found in best) == [60, 120]


@pytest.mark.parametrize("hold", ["firing", "pins"])
@pytest.mark.parametrize("cylinders", [8, 12, 14])
def test_bank_angle_of_an_arrangement_is_the_one_listed(
    cylinders: int, hold: Literal["firing", "pins"]
) -> None:
    search = cp.search_arrangements(cylinders, hold=hold)
    assert [found.bank_angle_deg for found in search] == search.bank_angles_deg.tolist()


@pytest.mark.parametrize("hold", ["firing", "pins"])
def test_an_engine_at_0_or_180_degrees_has_two_banks(hold: Literal["firing", "pins"]) -> None:
    search = cp.search_arrangements(6, hold=hold)
    for angle in (0.0, 180.0):
        (found,) = search.at_bank_angle(angle)
        engine = found.engine(CYLINDER, spacing=0.1)
        assert engine.bank_angle_deg == angle
        assert engine.banks == {"right": (1, 3, 5), "left": (2, 4, 6)}


@pytest.mark.parametrize("hold", ["firing", "pins"])
@pytest.mark.parametrize("throws", [3, 4, 5, 6, 7, 9])
def test_bank_angles_that_are_rational_parts_of_a_turn_are_correctly_rounded(
    throws: int, hold: Literal["firing", "pins"]
) -> None:
    parts = (4 if hold == "firing" else 8) * throws
    exact = {float(Fraction(360 * k, parts)) for k in range(parts + 1)}
    angles = cp.search_arrangements(2 * throws, hold=hold).bank_angles_deg
    rational = [angle for angle in angles.tolist() if min(abs(angle - e) for e in exact) < 1e-9]
    assert len(rational) >= 2
    assert set(rational) <= exact


def test_phases_of_any_part_of_a_turn_are_searched() -> None:
    assert cp.search_arrangements(6, phases_deg=[0, 120, 235]).bank_angles_deg.tolist() == [0, 180]


# --- shared pins --------------------------------------------------------------------------------


def test_arrangements_on_shared_pins_are_all_orders_at_90() -> None:
    search = cp.search_arrangements(10, shared_pins=True, hold="pins")
    assert (search.candidates, search.qualifying, search.balanced) == (120, 120, 0)
    assert search.bank_angles_deg.tolist() == [90.0] * 8
    assert all(each.first_deg == each.second_deg for each in search)
    assert repr(search) == "<ArrangementSearch of a V10 on shared pins: 120 of 120 pairs>"
    cylinder = cp.Cylinder(0.045, 0.158, 0.5)
    for each in search:
        engine = each.engine(cylinder, spacing=0.1)
        assert not engine.pin_split_deg.any()
        one, two = (engine.balance(6000, orders=[n])[n].moment for n in (1, 2))
        unit = 0.5 * 0.045 * (200 * np.pi) ** 2 * 0.1
        assert abs(one.backward) == 0.0
        assert each.counterweight == pytest.approx(abs(one.forward) / unit, rel=1e-12)
        a2 = abs(cylinder.harmonics([2])[0])
        np.testing.assert_allclose(each.second_order, two.peak_xy / unit / a2, atol=1e-9)
    (best,) = search.best()
    # Of the V10s at 90° with counterweights, the one with the least second order.
    assert best.first_deg == (0, 72, 288, 144, 216)


def test_shared_pins_are_searched_with_progress() -> None:
    told: list[tuple[int, int]] = []
    search = cp.search_arrangements(
        18, hold="pins", shared_pins=True, progress=lambda done, total: told.append((done, total))
    )
    # 8! cranks; 9 throws have turns and images, 10 176 up to these.
    assert (search.candidates, len(search)) == (362_880, 10_176)
    assert told
    assert told[-1][0] == told[-1][1] > 1
    with pytest.raises(cp.InputError, match="at most 1048576 are listed"):
        len(cp.search_arrangements(24, hold="pins", shared_pins=True, phases_deg=range(0, 360, 30)))


def test_shared_pins_among_all_pairs() -> None:
    # In the search of all pairs those with the same pins twice are 3! of the V6.
    shared = cp.search_arrangements(6, shared_pins=True, hold="pins")
    every = cp.search_arrangements(6, hold="pins")
    assert shared.candidates == 6
    assert set(shared.bank_angles_deg.round(9)) <= set(every.bank_angles_deg.round(9))
    flat = cp.search_arrangements(8, shared_pins=True, hold="pins")
    # Two phases, each twice: of six orders two have no first-order moment (0-180-180-0).
    assert (flat.candidates, flat.balanced, len(flat)) == (6, 2, 3)
    own = cp.search_arrangements(8, shared_pins=True, hold="pins", phases_deg=[0, 90, 180, 270])
    assert (own.candidates, own.balanced, len(own)) == (24, 0, 3)
    again = pickle.loads(pickle.dumps(own.within(80, 100)))  # noqa: S301 - our own
    assert again == own.within(80, 100) != flat
    assert len(own.within(0, 80)) == 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"cylinders": 7}, "cylinders = 7: a vee has an even number"),
        ({"hold": "firing"}, 'give hold="pins"'),
        ({"alternating": True}, "leave out alternating"),
        ({"phases_deg": [0, 120]}, "phases_deg has 2"),
        ({"cylinders": 30}, "give 4 to 24"),
    ],
)
def test_what_shared_pins_cannot_be_searched_for(given: dict[str, object], message: str) -> None:
    arguments = {"cylinders": 6, "hold": "pins", "shared_pins": True} | given
    with pytest.raises(cp.InputError) as caught:
        cp.search_arrangements(**arguments)  # type: ignore[arg-type]
    assert message in str(caught.value)
