"""Does a ranking choose what a plain loop does, tell all that ties, and find what lies between?"""

# ruff: noqa: ANN401 - options and angles are of any type

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.analysis.ranking import objectives
from matplotlib import pyplot as plt
from rederivation import ijesc
from support import html_of, in_turn
from support.engines import IJESC

if TYPE_CHECKING:
    from collections.abc import Iterator

MASS_RADIUS = ijesc.MASS * ijesc.CRANK_RADIUS
AS_PRINTED = {1: MASS_RADIUS, 2: MASS_RADIUS * ijesc.ROD_RATIO}  # a_2 = lambda, kg m
NAMES = ["-".join(map(str, order)) for order in ijesc.FIRING_ORDERS]
V6 = {
    name: cp.Engine.from_firing_order(
        IJESC, name, bank_angle_deg=60, rule="ijesc", spacing=ijesc.SPACING
    )
    for name in NAMES
}
SHARED = cp.Engine.vee(IJESC, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13)
I4 = cp.Engine.inline(IJESC, throws_deg=[0, 180, 180, 0], spacing=0.1, name="I4")

# A few dozen roundings of 1.1e-16, relative to the largest value.
ROUNDING = 1e-13


def paper(**options: Any) -> cp.results.Ranking:
    """The paper's four engines at its seventeen angles, with its data."""
    given: dict[str, Any] = {"rpm": ijesc.RPM, "bank_angle_deg": ijesc.V_ANGLES_DEG, "hold": "pins"}
    given |= {"orders": (1, 2), "spectrum": AS_PRINTED}
    given |= {"by": "total.moment.peak"}
    return cp.rank({k: e.replace(reference_z=0.0) for k, e in V6.items()}, **given | options)


def angles(ranking: cp.results.Ranking) -> dict[str, tuple[float, ...]]:
    return {choice.name: choice.bank_angles_deg for choice in ranking}


def parts_left(balance: cp.results.Balance) -> int:
    """How many of the paper's four figures, M_px, M_py, M_sx, M_sy, are not zero."""
    return int(np.count_nonzero(balance.moment.peak_xy))


# --- the paper's choice -------------------------------------------------------------------------


def test_the_paper_s_choice() -> None:
    """It takes the angle at which most of a table's four figures are zero.

    IJESC, section V: 90 degrees for 1-3-5-2-4-6, where the secondary moment in X is zero; 60 for
    1-4-5-2-3-6, where the primary in X and the secondary in Y are; 120 for 1-6-5-4-3-2, where by
    Table III both in Y are. For 1-5-3-6-2-4 it says 10 to 40 degrees: the one zero of Table IV is
    at 90, where its primary moment is the largest.
    """
    ranking = paper(by=parts_left)
    assert angles(ranking) == {
        "1-3-5-2-4-6": (90.0,),
        "1-4-5-2-3-6": (60.0,),
        "1-6-5-4-3-2": (120.0,),
        "1-5-3-6-2-4": (90.0,),
    }
    assert [choice.value for choice in ranking] == [2, 2, 3, 3]
    assert [choice.place for choice in ranking] == [1, 1, 3, 3]
    # Its own tables, computed as it did, say the same; sin and cos leave less than 1e-11 N m.
    counted = np.count_nonzero(ijesc.peaks_as_printed() > 1e-9, axis=-1)
    np.testing.assert_array_equal(paper(by=parts_left).values, counted)
    last = paper(by="[1].moment.peak")
    fourth = last.values[NAMES.index("1-5-3-6-2-4")]
    assert ijesc.V_ANGLES_DEG[fourth.argmax()] == 90.0
    assert dict(angles(last))["1-5-3-6-2-4"] == (10.0, 170.0)


def test_thirty_six_crank_angles_choose_as_the_true_peaks_do() -> None:
    """... among the paper's angles, though they are up to 0.8 % too low."""
    ranking = paper()
    sampled = ijesc.longest_moment(n_samples=36)
    chosen = {
        name: (float(ijesc.V_ANGLES_DEG[row.argmin()]),)
        for name, row in zip(NAMES, sampled, strict=True)
    }
    assert angles(ranking) == chosen
    assert chosen == {
        "1-3-5-2-4-6": (80.0,),
        "1-4-5-2-3-6": (40.0,),
        "1-6-5-4-3-2": (140.0,),
        "1-5-3-6-2-4": (10.0,),
    }
    order = [NAMES[k] for k in sampled.min(axis=1).argsort()]
    assert [choice.name for choice in ranking] == order
    miss = 1.0 - sampled / ranking.values
    assert miss.min() > -ROUNDING
    # The squared length is a polynomial of degree 4, which at half a step from its peak has lost at
    # most 1 - cos(4 h/2) of what lies between it and minus itself: of the length, that once.
    assert 0.005 < miss.max() < 1.0 - np.cos(2.0 * np.deg2rad(10.0))


def test_values_are_the_limit_of_many_crank_angles() -> None:
    sampled = ijesc.longest_moment(n_samples=3600)
    np.testing.assert_allclose(paper().values, sampled, rtol=1.0 - np.cos(2.0 * np.deg2rad(0.1)))


def test_what_counterweights_leave_is_what_turns_against_the_crank() -> None:
    ranking = paper(by="[1].moment.backward")
    against = ijesc.primary_against_crank()
    atol = ROUNDING * float(against.max())
    np.testing.assert_allclose(ranking.values, against, rtol=0, atol=atol)
    assert angles(ranking) == {
        "1-3-5-2-4-6": (90.0,),
        "1-4-5-2-3-6": (30.0,),
        "1-6-5-4-3-2": (150.0,),
        "1-5-3-6-2-4": (10.0, 170.0),
    }
    assert [choice.value for choice in ranking][:3] == [0.0] * 3  # exactly
    assert [choice.place for choice in ranking] == [1, 1, 1, 4]


def test_between_the_paper_s_angles() -> None:
    """The lowest points are those of a loop over a fine grid."""
    refined = paper(refine=True)
    fine = np.arange(10.0, 170.001, 0.05)
    loop = paper(bank_angle_deg=fine).values
    for choice, coarse in zip(refined, paper(), strict=True):
        (angle,) = choice.bank_angles_deg
        row = loop[NAMES.index(choice.name)]
        assert choice.value <= row.min()
        assert abs(angle - fine[row.argmin()]) <= 0.05
        assert choice.value <= coarse.value


# --- objectives ---------------------------------------------------------------------------------

# Objective → the same as a function of a balance.
SAME: dict[str, Any] = {
    "total.moment.peak": lambda b: b.total.moment.peak,
    "total.force.peak": lambda b: b.total.force.peak,
    "total.moment.peak_xy": lambda b: b.total.moment.peak_xy.max(),
    "total.force.peak_xy": lambda b: b.total.force.peak_xy.max(),
    "total.torque.peak": lambda b: b.total.torque.peak,
    "[1].moment.backward": lambda b: abs(b[1].moment.backward),
    "[1].force.backward": lambda b: abs(b[1].force.backward),
    "[1].moment.peak": lambda b: b[1].moment.peak,
    "[6].moment.peak": lambda b: b[6].moment.peak,
    "[2].force.peak": lambda b: b[2].force.peak,
    "[2].torque.peak": lambda b: b[2].torque.peak,
    "unevenness_deg": lambda b: b.engine.firing_orders()[0].unevenness_deg,
}
ODD = SHARED.replace(
    cylinder=[IJESC.replace(reciprocating_mass=mass) for mass in (1, 1.1, 1.2, 1.3, 1.4, 1.5)]
)


@pytest.mark.parametrize("hold", ["pins", "firing"])
@in_turn("name", SAME)
def test_a_function_agrees_with_the_name(name: str, hold: Any) -> None:
    engines = {"shared": SHARED, "odd": ODD, "split": cp.Engine.preset("v6-60")}
    given: dict[str, Any] = {"rpm": 5000, "hold": hold, "orders": [1, 2, 4, 6]}
    given |= {"bank_angle_deg": [0, 33.3, 60, 90, 123, 180]}
    by_name = cp.rank(engines, by=name, **given)
    by_function = cp.rank(engines, by=SAME[name], **given)
    largest = max(float(by_name.values.max()), 1.0)
    np.testing.assert_allclose(
        by_name.values, by_function.values, rtol=ROUNDING, atol=ROUNDING * largest
    )
    assert angles(by_name) == angles(by_function)
    assert [choice.place for choice in by_name] == [choice.place for choice in by_function]
    np.testing.assert_array_equal(by_name.trade_off[name], by_name.values)


@pytest.mark.parametrize("name", SAME)
def test_engines_as_they_are(name: str) -> None:
    engines = [SHARED, I4, cp.Engine.preset("v8-crossplane")]
    given: dict[str, Any] = {"orders": range(1, 7)}
    ranking = cp.rank(engines, rpm=3000, by=name, **given)
    expected = [SAME[name](engine.balance(3000, **given)) for engine in engines]
    assert ranking.values.shape == (3, 1)
    # Relative to the largest force of one cylinder, 6.6 kN, times some levers.
    np.testing.assert_allclose(ranking.values[:, 0], expected, rtol=ROUNDING, atol=1e-9)
    assert ranking.bank_angles_deg is None
    places = {choice.engine: choice.bank_angles_deg for choice in ranking}
    assert places == {SHARED: (60.0,), I4: (), engines[2]: (90.0,)}


def test_the_table_has_the_objectives_that_are_known() -> None:
    ranking = paper(by=[parts_left, "[2].moment.peak"], spectrum=None)
    assert list(ranking.trade_off) == [
        "parts_left",
        "[2].moment.peak",
        "total.moment.peak",
        "[1].moment.backward",
        "total.force.peak",
        "[1].force.backward",
        "[2].force.peak",
        "total.torque.peak",
        "unevenness_deg",
    ]
    for name in itertools.islice(ranking.trade_off, 1, None):
        np.testing.assert_array_equal(ranking.trade_off[name], paper(by=name, spectrum=None).values)
    known = paper().trade_off
    assert "total.torque.peak" not in known  # a spectrum of forces tells nothing of it
    assert "[2].moment.peak" not in paper(orders=[1]).trade_off
    assert (
        "unevenness_deg"
        not in cp.rank(cp.Engine.preset("v12-60"), rpm=5000, by="total.moment.peak").trade_off
    )


# --- what is least ------------------------------------------------------------------------------


def of_tables(*tables: list[list[float]], **options: Any) -> cp.results.Ranking:
    """Ranking by given numbers: a row for each engine, columns for 10, 20, 30 … degrees."""

    def look_up(table: list[list[float]]) -> Any:
        return lambda b: table[int(b.engine.name)][round(b.engine.bank_angle_deg / 10.0) - 1]

    engines = [SHARED.replace(name=f"{k}") for k in range(len(tables[0]))]
    at = 10.0 * np.arange(1, len(tables[0][0]) + 1)
    given: dict[str, Any] = {"rpm": 1000, "bank_angle_deg": at, "hold": "pins"}
    return cp.rank(engines, **given | {"by": [look_up(table) for table in tables]} | options)


def found(ranking: cp.results.Ranking) -> list[tuple[int, str, tuple[float, ...]]]:
    return [(each.place, each.name, each.bank_angles_deg) for each in ranking]


def test_all_that_ties_is_told() -> None:
    table = [[3.0, 2.0, 4.0, 2.0], [5.0, 1.0, 1.0 + 4e-9, 1.0 + 6e-9], [2.0, 2.0, 9.0, 9.0]]
    # 5e-9 is a billionth of the largest, 5; then of 9 with rtol given for it.
    assert found(of_tables(table, tie_rtol=5e-9 / 9.0)) == [
        (1, "1", (20.0, 30.0)),
        (2, "0", (20.0, 40.0)),
        (2, "2", (10.0, 20.0)),
    ]
    assert found(of_tables(table, tie_rtol=0))[0] == (1, "1", (20.0,))
    assert found(of_tables(table))[0] == (1, "1", (20.0, 30.0, 40.0))  # 9e-9 by default


def test_ties_are_told_apart_by_the_next_objective() -> None:
    first = [[1.0, 1.0, 2.0], [1.0, 3.0, 1.0], [0.0, 5.0, 5.0]]
    second = [[4.0, 3.0, 0.0], [2.0, 0.0, 2.0], [9.0, 0.0, 0.0]]
    ranking = of_tables(first, second)
    assert found(ranking) == [(1, "2", (10.0,)), (2, "1", (10.0, 30.0)), (3, "0", (20.0,))]
    assert [choice.values for choice in ranking] == [(0.0, 9.0), (1.0, 2.0), (1.0, 3.0)]
    assert ranking[1].value == 1.0
    assert ranking.by == ("objective", "objective_2")


@pytest.mark.parametrize("unwanted", [np.nan, np.inf])
def test_what_is_unwanted_is_not_chosen(unwanted: float) -> None:
    ranking = of_tables([[unwanted] * 2, [1.0, unwanted], [unwanted, 0.5], [unwanted] * 2])
    assert found(ranking) == [(1, "2", (20.0,)), (2, "1", (10.0,)), (3, "0", ()), (3, "3", ())]
    assert ranking[2].value == np.inf
    assert ranking[2].engine == ranking.engines[0]
    assert "–" in repr(ranking)
    ranking.plot()


def test_values_below_zero_are_less() -> None:
    assert found(of_tables([[0.0, 1.0], [0.0, -1.0]])) == [(1, "1", (20.0,)), (2, "0", (10.0,))]


def test_a_choice_hands_back_its_engine() -> None:
    ranking = paper(by=["[1].moment.backward", "[2].moment.peak"])
    for choice in ranking:
        assert choice.engine.bank_angle_deg == pytest.approx(choice.bank_angles_deg[0], abs=1e-12)
        b = choice.engine.replace(reference_z=0.0).balance(
            ijesc.RPM, orders=[1, 2], spectrum=AS_PRINTED
        )
        again = (abs(b.moment.backward[0]), b.moment.peak[1])
        assert choice.values == pytest.approx(again, rel=ROUNDING)
    assert ranking[:2] == (ranking[0], ranking[1])
    assert list(ranking) == [ranking[k] for k in range(len(ranking))]


def test_angles_in_any_order_and_twice() -> None:
    ranking = paper(bank_angle_deg=[170, 30, 10, 30, 170, 90], by="[1].moment.backward")
    assert angles(ranking)["1-4-5-2-3-6"] == (30.0,)
    assert angles(ranking)["1-5-3-6-2-4"] == (10.0, 170.0)
    again = paper(bank_angle_deg=[170, 31, 10, 31, 170, 91], refine=True)
    fine = paper(bank_angle_deg=np.arange(10.0, 170.01, 0.05))
    assert again[0].bank_angles_deg == fine[0].bank_angles_deg == (10.0,)


# --- between the angles -------------------------------------------------------------------------


def by_angle(function: Any, at: Any, **options: Any) -> cp.results.Choice:
    """The choice where the objective is a function of the bank angle."""
    return cp.rank(
        SHARED,
        rpm=1000,
        bank_angle_deg=at,
        hold="pins",
        by=lambda b: float(function(np.ptp(b.engine.bank_deg))),
        **{"refine": True} | options,
    )[0]


def test_a_point_is_found_exactly() -> None:
    """Where the backward part vanishes: 30, 90 and 150 degrees, from angles that miss them."""
    ranking = paper(by="[1].moment.backward", bank_angle_deg=range(3, 178, 7), refine=True)
    assert angles(ranking) == {
        "1-3-5-2-4-6": (90.0,),
        "1-4-5-2-3-6": (30.0,),
        "1-6-5-4-3-2": (150.0,),
        "1-5-3-6-2-4": (3.0,),
    }
    assert [choice.value for choice in ranking][:3] == [0.0] * 3


def test_a_smooth_dip_is_found() -> None:
    choice = by_angle(lambda a: 1.0 - np.cos(np.deg2rad(a - 47.123456)) + 1.0, range(0, 181, 20))
    (angle,) = choice.bank_angles_deg
    # cos is 1 to rounding, 1.1e-16, within 1.5e-8 rad; the search stops at 1e-14: 1.4e-7 rad.
    assert angle == pytest.approx(47.123456, abs=np.degrees(2e-7))
    assert choice.value == pytest.approx(1.0, abs=1e-13)


def test_all_equal_dips_are_found() -> None:
    choice = by_angle(lambda a: abs((a - 33.25) * (a - 120.5)) + 1.0, range(0, 181, 15))
    assert choice.bank_angles_deg == (33.25, 120.5)


def test_a_dip_lower_than_that_at_the_lowest_angle_is_found() -> None:
    """The lowest given angle, 100, stands in the shallower of two dips."""
    choice = by_angle(lambda a: min(abs(a - 24.75) + 1.0, abs(a - 100.0) + 2.0), range(0, 181, 10))
    assert choice.bank_angles_deg == (24.75,)
    assert choice.value == pytest.approx(1.0)


def test_dips_between_two_equal_angles_are_one() -> None:
    choice = by_angle(lambda a: (a - 45.0) ** 2, range(0, 181, 10))
    assert choice.bank_angles_deg == pytest.approx((45.0,), abs=1e-5)
    # A point at an angle that rounds to no short number, come upon from both sides.
    point = 33.0 + 12345.0 / 2**16
    at = point + np.array([-31.7, -10.0, 10.0, 47.3])
    choice = by_angle(lambda a: 1.0 + abs(a - point), at)
    assert choice.bank_angles_deg == pytest.approx((point,), abs=1e-9)


def test_a_given_angle_that_ties_with_the_bottom_of_its_dip_is_kept() -> None:
    choice = by_angle(lambda a: 1.0 + (a - 60.001234) ** 2, range(0, 181, 20))
    assert choice.bank_angles_deg == (60.0,)  # 1.5e-6 above the bottom: 1.1e-10 of the largest


def test_an_angle_is_not_rounded_out_of_the_range() -> None:
    choice = by_angle(lambda a: max(10.45, a), [10.4, 60.4, 90.0])
    assert 10.4 <= choice.bank_angles_deg[0] <= 10.45


def test_a_dip_of_one_angle_among_the_unwanted() -> None:
    choice = by_angle(lambda a: 1.0 if a == 50.0 else np.inf, [30.0, 50.0, 80.0])
    assert choice.bank_angles_deg == (50.0,)


@pytest.mark.parametrize("at", [[60.0], [60.0, 60.0], range(0, 181, 20)])
def test_nothing_is_made_up_where_it_is_flat(at: Any) -> None:
    refined, given = by_angle(lambda _: 7.0, at), by_angle(lambda _: 7.0, at, refine=False)
    assert refined == given
    assert refined.bank_angles_deg == tuple(sorted(set(map(float, at))))


def test_nothing_beyond_the_given_angles() -> None:
    for function, best in ((lambda a: a, 40.0), (lambda a: -a, 80.0)):
        assert by_angle(function, [40.0, 60.0, 80.0]).bank_angles_deg == (best,)


def test_dips_beside_what_is_unwanted() -> None:
    choice = by_angle(lambda a: abs(a - 52.5) if a > 50.0 else np.nan, range(0, 181, 20))
    assert choice.bank_angles_deg == (52.5,)


# --- searches -----------------------------------------------------------------------------------


def test_a_search_is_ranked_arrangement_by_arrangement() -> None:
    search = cp.search_arrangements(14, alternating=True)
    given: dict[str, Any] = {"cylinder": IJESC, "spacing": 0.1, "rpm": 3000}
    ranking = cp.rank(search, by="[2].moment.peak", **given)
    assert ranking.engines == tuple(
        search[k].engine(IJESC, spacing=0.1) for k in range(len(search))
    )
    scale = MASS_RADIUS * (2 * np.pi * 3000 / 60) ** 2 * 0.1 * IJESC.harmonics(2)[0]
    # The longest second-order moment of each, in its units, at least the longer of two axes.
    longer = np.array([max(each.second_order) for each in search])
    assert (ranking.values[:, 0] / scale >= longer * (1.0 - 1e-12) - 1e-12).all()
    within = [each for each in ranking if each.bank_angles_deg and 5 < each.bank_angles_deg[0] < 60]
    assert round(within[0].bank_angles_deg[0], 2) == 9.13  # the paper's, its section 5
    after = cp.rank(search, by="[1].moment.backward", **given)
    assert {choice.place for choice in after} == {1}
    # Angles of the search are rounded to 1.4e-14 of a degree or so.
    assert after.values.max() < 1e-12 * scale / IJESC.harmonics(2)[0] * 10.0


def test_a_search_with_too_many_angles_is_refused() -> None:
    with pytest.raises(cp.InputError, match="engines is a search with"):
        cp.rank(
            cp.search_arrangements(18),
            cylinder=IJESC,
            spacing=0.1,
            rpm=3000,
            by="total.moment.peak",
        )


# --- tables and pictures ------------------------------------------------------------------------


def test_what_is_shown() -> None:
    ranking = paper(by=["[1].moment.backward", parts_left])
    title, head, *rows, loads = repr(ranking).splitlines()
    assert loads == "Spectrum given."
    assert title.startswith(
        "Ranked by backward part of rocking moment, order 1 (what the best counterweight leaves)"
    )
    assert "5000 rpm, pins held" in title
    assert head.split("  ")[0] == "place"
    assert len(rows) == 4
    assert rows[0].split() == ["1", "1-3-5-2-4-6", "90", "0", "3"]
    html = html_of(ranking)
    assert html.count("<tr>") == 5
    assert "1-6-5-4-3-2" in html
    flat = cp.rank({"<b>": SHARED}, rpm=1, bank_angle_deg=range(181), hold="pins", by=lambda _: 0)
    assert "0, 1, 2, 3, 4, 5 and 175 more" in repr(flat)
    assert "<b>" not in html_of(flat)


def test_a_long_ranking_is_cut_in_text() -> None:
    search = cp.search_arrangements(14, alternating=True)
    ranking = cp.rank(search, cylinder=IJESC, spacing=0.1, rpm=3000, by="total.moment.peak")
    assert "30 of 218 rows" in repr(ranking)
    assert len(repr(ranking).splitlines()) == 33
    assert html_of(ranking).count("<tr>") == 61


def test_the_table_is_exported() -> None:
    ranking = paper(by=parts_left)
    frame = ranking.to_pandas()
    assert list(frame.columns) == ["place", "engine", "bank angle °", "parts_left"]
    assert frame.engine.tolist() == [each.name for each in ranking]
    assert frame.parts_left.tolist() == [each.value for each in ranking]
    assert ranking.to_xarray()["parts_left"].dims == ("row",)
    by_name = cp.rank([SHARED, I4], rpm=3000, by="total.moment.peak")
    assert by_name.to_xarray()["total rocking moment"].attrs["units"] == "N·m"


# --- the rest -----------------------------------------------------------------------------------


def test_engines_that_cannot_be_turned_are_refused() -> None:
    with pytest.raises(cp.InputError, match="bank"):
        cp.rank([SHARED, I4], rpm=1000, by="total.force.peak", bank_angle_deg=[60], hold="pins")


def test_a_warning_of_units_comes_once_and_points_here() -> None:
    millimetres = SHARED.replace(cylinder=cp.Cylinder(4.5, 15.8, 1.487))
    with pytest.warns(UserWarning, match="mean piston speed") as caught:
        cp.rank(millimetres, rpm=5000, by=["total.torque.peak", lambda b: b.rpm])
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_errors_of_a_function_come_through() -> None:
    def fail(_: cp.results.Balance) -> float:
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        cp.rank(SHARED, rpm=1000, by=fail)


@pytest.fixture(autouse=True)
def _agg() -> Iterator[None]:
    mpl.use("agg")
    yield
    plt.close("all")


def test_some_arrangements_of_a_search() -> None:
    cylinder = cp.Cylinder(0.045, 0.158, 0.5)
    chosen = cp.search_arrangements(14, alternating=True).within(30, 90).best(count=4)
    by_arrangement = cp.rank(chosen, cylinder=cylinder, spacing=0.1, rpm=3000, by="[2].moment.peak")
    engines = [one.engine(cylinder, spacing=0.1) for one in chosen]
    by_engine = cp.rank(engines, rpm=3000, by="[2].moment.peak")
    assert [one.value for one in by_arrangement] == [one.value for one in by_engine]
    assert {one.engine for one in by_arrangement} == set(engines)
    with pytest.raises(cp.InputError, match="spacing = None"):
        cp.rank(chosen, cylinder=cylinder, rpm=3000, by="total.moment.peak")
    with pytest.raises(cp.InputError, match=r"spacing = 0\.1: is for arrangements"):
        cp.rank(engines, spacing=0.1, rpm=3000, by="total.moment.peak")


def test_an_order_may_stand_after_its_quantity() -> None:
    for name, other in [
        ("moment[2].peak", "[2].moment.peak"),
        ("force[1].backward", "[1].force.backward"),
        ("torque[1.5].gas.peak", "[1.5].torque.gas.peak"),
    ]:
        first, second = cp.rank(V6, 3000, by=[name, other], orders=[1, 1.5, 2])[0].values
        assert first == second
    with pytest.raises(cp.InputError, match="by ="):
        cp.rank(V6, 3000, by="moment.peak[2]")  # of a balance that is its third order


def test_objectives_take_half_orders_and_parts_of_torque() -> None:
    for path, order, quantity, head in (
        ("[0.5].crank_torque.peak", 0.5, "crank_torque", "order-0.5 crank torque"),
        ("[1.5].torque.gas.peak", 1.5, "torque.gas", "order-1.5 roll torque of gas pressure"),
        ("total.torque.inertia.peak", None, "torque.inertia", None),
        ("[2.0].torque.peak", 2, "torque", "order-2 roll torque"),
    ):
        found = objectives.named(path)
        assert (found.order, found.quantity) == (order, quantity)
        assert type(found.order) is type(order)
        assert head is None or found.head == head
    for wrong in ("[0.25].torque.peak", "[0].torque.peak", "total.moment.gas.peak"):
        with pytest.raises(cp.InputError, match=r"^by = "):
            objectives.named(wrong)
