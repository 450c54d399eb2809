"""Do measured parts go where they leave least?"""

from __future__ import annotations

import itertools
import math
import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.tolerances import match_parts as matching
from crankpin.model.loads import of_speed_squared
from hypothesis import given, settings
from hypothesis import strategies as st
from support import html_of, in_turn
from support.several_cranks import random_engine

if TYPE_CHECKING:
    from numpy.typing import NDArray

RNG = np.random.default_rng(5)
I3, I4 = cp.Engine.preset("i3"), cp.Engine.preset("i4")
V6 = cp.Engine.preset("v6-60").replace(rotating_mass=0.4)
BOXER = cp.Engine.preset("boxer-4")
PUMP = cp.PeriodicLoad(
    "pump", on="block", force={1: 40, 2: 25j}, scaling="speed squared", rpm=3000, z=0.3, cylinder=2
)
SPRINGS = cp.PeriodicLoad("springs", on="block", force={1: 900}, torque={0.5: 30}, z=0.1)
FIRED = cp.Engine.preset("i4", cylinder=I4.cylinders[0].replace(bore=0.086)).with_cycle(
    cp.Cycle.example()
)


def masses(count: int, mean: float = 0.4) -> NDArray[np.float64]:
    return np.asarray(mean + 0.003 * RNG.standard_normal(count))


def rods(count: int) -> NDArray[np.float64]:
    return np.column_stack([masses(count, 0.2), masses(count, 0.45)])


def remains(engine: cp.Engine, orders: tuple[int, ...] = (1, 2)) -> float:
    """What the objective is, read off a balance."""
    b = engine.balance(30.0 / np.pi, orders=orders, torque=False)
    half = 0.5 * np.ptp(engine.z)
    parts = [b.force.forward, b.force.backward]
    parts += [b.moment.forward / half, b.moment.backward / half] if half else []
    return float(np.linalg.norm(np.concatenate(parts)))


# --- one engine ---------------------------------------------------------------------------------


LOADED = [I4.with_loads([PUMP]), FIRED.with_loads([PUMP])]


@pytest.mark.parametrize(
    "engine", [I3, I4, BOXER, V6, *LOADED], ids=["i3", "i4", "boxer", "v6", "loaded", "fired"]
)
def test_the_best_of_all_arrangements_is_found(engine: cp.Engine) -> None:
    pistons = masses(len(engine))
    match = cp.match_parts(engine, pistons)
    assert match.exact
    assert match.bound == pytest.approx(match.value, rel=1e-12)
    best = np.inf
    mass = engine.cylinders[0].reciprocating_mass
    for order in itertools.permutations(range(len(engine))):
        chosen = mass + pistons[list(order)] - pistons.mean()
        cylinders = [
            c.replace(reciprocating_mass=m) for c, m in zip(engine.cylinders, chosen, strict=True)
        ]
        best = min(best, remains(engine.replace(cylinder=cylinders)))
    # Sums of a kilogram-metre and less.
    assert match.value == pytest.approx(best, rel=1e-9, abs=1e-15)
    assert remains(match.engines[0]) == pytest.approx(match.value, rel=1e-9, abs=1e-15)
    assert match.value <= match.initial_value


@pytest.mark.parametrize("by", ["balance", "spread"])
def test_loads_that_do_not_scale_with_inertia_change_no_assignment(by: matching.Objective) -> None:
    pistons, ends = masses(5), rods(4)
    with_pump = FIRED.with_loads([PUMP])
    matches = [
        cp.match_parts(engine, pistons, ends, by=by)
        for engine in (with_pump, with_pump.with_loads([SPRINGS, PUMP]))
    ]
    assert matches[0].assignment == matches[1].assignment
    assert matches[0].value == matches[1].value
    assert matches[1].engines[0].loads == (SPRINGS, PUMP)


@pytest.mark.parametrize("spacing", [0.08, 0.09, 0.1, 0.11])
@pytest.mark.parametrize("unit", [1.0, 1.0 + 2**-51])
def test_of_an_arrangement_and_its_mirror_image_the_first_is_chosen(
    spacing: float, unit: float
) -> None:
    engine = I4.replace(z=spacing * unit * np.arange(4), reference_z=None)
    for pistons in ([0.402, 0.398, 0.405, 0.401], [0.401, 0.405, 0.398, 0.402]):
        match = cp.match_parts(engine, np.array(pistons) * unit, orders=[1])
        assert match.assignment[0].pistons == (1, 3, 2, 4)


@pytest.mark.parametrize("spare", [0, 1])
def test_pistons_and_rods_are_chosen_together(spare: int) -> None:
    pistons, ends = masses(3 + spare), rods(3)
    match = cp.match_parts(I3, pistons, ends, orders=[1])
    places = range(3)
    found = [
        cp.match_parts(I3, pistons, ends, orders=[1]).parts.value(
            "balance", type(match.assignment[0])(tuple(k + 1 for k in a), tuple(k + 1 for k in b))
        )
        for a in itertools.permutations(range(len(pistons)), 3)
        for b in itertools.permutations(places)
    ]
    assert match.exact
    assert match.value == pytest.approx(min(found), rel=1e-12)
    assert remains(match.engines[0], (1,)) == pytest.approx(match.value, rel=1e-9)
    assert len(match.unused[0]) == spare


def test_rods_that_are_lighter_than_a_balanced_throw_allows_are_unbalances() -> None:
    balanced = I3.replace(rotating_mass=0.0)
    match = cp.match_parts(balanced, masses(3), rods(3), orders=[1])
    (engine,) = match.engines
    assert engine.counterweights
    assert all(weight.angle_deg == 180 for weight in engine.counterweights)
    assert remains(engine, (1,)) == pytest.approx(match.value, rel=1e-9)


def test_equal_parts_leave_the_engine_as_it_is() -> None:
    match = cp.match_parts(V6, [0.4] * 6)
    assert match.engines[0].balance(3000, orders=[1, 2]).moment.peak == pytest.approx(
        V6.balance(3000, orders=[1, 2]).moment.peak, rel=1e-12
    )


# --- the search by exchanges, and its bound -----------------------------------------------------


def test_a_bound_above_zero_where_the_parts_cannot_make_up_for_what_remains() -> None:
    v8 = cp.Engine.preset("v8-crossplane")
    match = cp.match_parts(v8, masses(20), sets=2)
    assert not match.exact
    assert 0.98 * match.value <= match.bound <= match.value


def test_more_than_all_can_be_compared() -> None:
    v12 = cp.Engine.preset("v12-60")
    match = cp.match_parts(v12, masses(14), rods(13))
    assert not match.exact
    assert match.bound <= match.value < 0.5 * match.initial_value
    assert match == cp.match_parts(v12, match.parts.pistons, match.parts.rods)


# --- several engines ----------------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(0.1, 1.0), min_size=6, max_size=7), st.integers(1, 2))
def test_sets_of_pistons_have_the_least_sum_of_ranges(parts: list[float], sets: int) -> None:
    values = np.array(parts)
    found = cp.match_parts(I3, values, by="spread", sets=sets).value
    places = range(len(parts))
    best = np.inf
    for one in itertools.combinations(places, 3):
        rest = sorted(set(places) - set(one))
        others = itertools.combinations(rest, 3) if sets == 2 else [()]
        for other in others:
            both = [np.ptp(values[list(each)]) for each in (one, other) if each]
            best = min(best, float(sum(both)))
    assert found == pytest.approx(best, abs=1e-12)


def test_spread_of_sets() -> None:
    pistons = masses(14)
    match = cp.match_parts(I4, pistons, by="spread")
    assert (match.exact, len(match.assignment), len(match.unused[0])) == (True, 3, 2)
    assert match.bound == match.value == sum(match.values)
    chosen = [np.ptp(pistons[np.array(each.pistons) - 1]) for each in match.assignment]
    assert list(match.values) == chosen
    assert match.unit == "kg"


def test_heavy_pistons_go_with_light_rods() -> None:
    pistons, ends = masses(4), rods(4)
    match = cp.match_parts(I4, pistons, ends, by="spread")
    ranges = [np.ptp(pistons + ends[list(order), 0]) for order in itertools.permutations(range(4))]
    assert match.exact
    assert match.value == pytest.approx(min(ranges), rel=1e-12)
    several = cp.match_parts(I4, masses(13), rods(12), by="spread")
    assert (several.exact, several.bound) == (False, 0.0)
    assert several.value < several.initial_value


def test_parts_of_equal_masses_are_not_exchanged_for_ever() -> None:
    # To a gram, many are equal: exchanging them changes a sum by its rounding alone.
    pistons = np.round(0.45 + np.random.default_rng(3).normal(0.0, 0.004, 60), 3)
    match = cp.match_parts(cp.Engine.preset("i6"), pistons, orders=[1])
    assert not match.exact
    assert 0.0 < match.value < 0.1 * match.initial_value


@pytest.mark.parametrize(("sets", "spare"), [(1, 1), (1, 2), (2, 0), (2, 1)])
def test_spreads_of_pistons_and_rods_with_spare_ones_by_brute_force(sets: int, spare: int) -> None:
    engine = cp.Engine.preset("i2-180")
    count = 2 * sets + spare
    for _ in range(5):
        pistons, ends = masses(count), rods(count)
        sums = pistons[:, None] + ends[:, 0]
        # Of each engine the rod of the one and of the other piston.
        best = min(
            sum(abs(sums[a[k], b[k]] - sums[a[k + 1], b[k + 1]]) for k in range(0, 2 * sets, 2))
            for a in itertools.combinations(range(count), 2 * sets)
            for a in ({(a[0], *rest) for rest in itertools.permutations(a[1:])})
            for b in itertools.permutations(range(count), 2 * sets)
        )
        match = cp.match_parts(engine, pistons, ends, by="spread", sets=sets)
        assert match.value == pytest.approx(best, abs=1e-12)  # sums of masses below 1 kg
        assert not match.exact


@pytest.mark.parametrize("spare", [0, 1])
@pytest.mark.parametrize("orders", [(1,), (1, 2)])
def test_parts_are_exchanged_between_engines(spare: int, orders: tuple[int, ...]) -> None:
    """By brute force: all sets of three pistons, each in its best order."""
    for _ in range(10):
        pistons = masses(6 + spare)
        match = cp.match_parts(I3, pistons, sets=2, orders=orders)
        value, assignment = match.parts.value, type(match.assignment[0])
        values = {
            chosen: min(
                value("balance", assignment(tuple(each), None))
                for each in itertools.permutations(k + 1 for k in chosen)
            )
            for chosen in itertools.combinations(range(6 + spare), 3)
        }
        best = min(
            one + other
            for (a, one), (b, other) in itertools.combinations(values.items(), 2)
            if not {*a} & {*b}
        )
        assert match.exact
        # Sums of a kilogram-metre and less.
        assert match.value == pytest.approx(best, rel=1e-9, abs=1e-15)
        assert match.bound == match.value


@pytest.mark.parametrize("spare", [0, 4])
def test_many_parts_come_close_to_the_least_of_few(spare: int) -> None:
    """More engines than can be searched exhaustively: no worse than those matched four by four."""
    pistons = masses(48 + spare)
    match = cp.match_parts(I4, pistons, sets=12, orders=[1])
    fours = (cp.match_parts(I4, pistons[4 * k : 4 * k + 4], orders=[1]).value for k in range(12))
    assert not match.exact
    assert 0.0 <= match.bound <= match.value < 0.2 * sum(fours)


def test_pistons_and_rods_of_several_engines() -> None:
    match = cp.match_parts(I4, masses(12), rods(12))
    assert len(match.engines) == 3
    used = [number for each in match.assignment for number in each.pistons]
    assert sorted(used) == [*range(1, 13)]
    for engine, value in zip(match.engines, match.values, strict=True):
        assert remains(engine) == pytest.approx(value, rel=1e-9)
    assert match.bound <= match.value < match.initial_value
    assert match.engines[1].name.endswith(", set 2")


# --- results ------------------------------------------------------------------------------------


def test_tables() -> None:
    match = cp.match_parts(I4, masses(4), rods(4))
    assert match.table.header == [
        "set", "cylinder", "piston", "piston mass kg", "rod", "small end kg", "big end kg",
    ]  # fmt: skip
    assert "no assignment is better" in html_of(match)
    table = match.to_pandas()
    assert table.piston.tolist() == list(match.assignment[0].pistons)
    assert match.parts.rods is not None
    assert table["small end kg"].tolist() == match.parts.rods[table.rod - 1, 0].tolist()
    again = pickle.loads(pickle.dumps(match))  # noqa: S301 - its own
    assert again == match


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pistons": [0.4] * 3}, r"pistons has 3 entries: the engine has 4 cylinders"),
        ({"sets": 3}, r"sets = 3: 8 pistons suffice for 2 of 4 cylinders; give 1 to 2"),
        ({"sets": 0}, r"sets = 0: "),
        ({"pistons": [0.4, -0.1, 0.4, 0.4]}, r"pistons = .*: give masses above zero"),
        (
            {"pistons": [[0.4] * 4]},
            r"pistons has shape \(1, 4\): give masses in kg of shape \(n,\)",
        ),
        ({"rods": [0.6] * 4}, r"rods has shape \(4,\): .*small end and big end of each rod"),
        ({"rods": [[0.2, 0.4]] * 3}, r"rods has 3 entries"),
        ({"by": "weight"}, r'by = \'weight\': give "balance" or "spread"'),
        ({"orders": "auto"}, r"orders = 'auto': give whole numbers"),
        ({"seed": -1}, r"seed = -1"),
        ({"pistons": [0.4] * 1001}, r"pistons has 1001 entries: give 1000 at most"),
    ],
)
def test_errors_name_the_argument(changes: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"pistons": [0.4, 0.41] * 4} | changes
    with pytest.raises(cp.InputError, match=message):
        cp.match_parts(I4, **arguments)


def test_the_parts_given_stay_writable() -> None:
    pistons, ends = masses(3), rods(3)
    match = cp.match_parts(I3, pistons, ends)
    assert pistons.flags.writeable
    assert ends.flags.writeable
    assert not match.parts.pistons.flags.writeable


@pytest.mark.slow
@pytest.mark.parametrize(("name", "masses"), [("i4", 4), ("v12-60", 12), ("v16-45", 32)])
def test_progress_is_reported_and_all_of_twelve_pistons_are_compared(
    name: str, masses: int
) -> None:
    told: list[tuple[int, int]] = []
    pistons = 0.4 + 0.001 * np.sin(np.arange(masses))
    found = cp.match_parts(
        cp.Engine.preset(name), pistons, progress=lambda done, total: told.append((done, total))
    )
    assert found.exact is (masses <= 12)
    done, total = np.array(told).T
    assert (np.diff(done) >= 0).all()
    assert (done <= total).all()
    assert done[-1] == total[-1] >= 25
    with pytest.raises(cp.InputError, match="progress = 'yes': give True for a tqdm bar"):
        cp.match_parts(cp.Engine.preset(name), pistons, progress="yes")  # type: ignore[arg-type]


# --- influences -----------------------------------------------------------------------------------


@in_turn("seed", range(30))
def test_a_residual_is_that_of_the_engine_with_these_parts(seed: int) -> None:
    engine, random = random_engine(seed), np.random.default_rng(seed)
    if seed % 2:
        engine = engine.with_loads([PUMP.replace(cylinder=None), SPRINGS])
    count, orders = len(engine), (1, 2, 3, 4)
    # Apart by kilograms, so that each influence counts.
    lightest = min(cylinder.reciprocating_mass for cylinder in engine.cylinders)
    pistons = 5.0 + lightest * random.random(count) / 2
    ends = 5.0 + np.column_stack([lightest * random.random(count) / 2, random.random(count)])
    for rods_ in (None, ends):
        parts = matching.MeasuredParts(engine, pistons, rods_, orders)
        chosen = [random.permutation(count) for _ in ([0] if rods_ is None else [0, 1])]
        assignment = matching.assignment_of(*chosen)
        residual = remains(of_speed_squared(parts.engine_of(assignment, "")), orders)
        # Rounding of the whole engine's sums, of terms up to some kilograms and levers.
        assert parts.value("balance", assignment) == pytest.approx(residual, rel=1e-9, abs=1e-12)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("length", [1e-310, 1e-300, 1e-12])
def test_an_engine_of_next_to_no_length_is_matched_without_a_word_of_numpy(length: float) -> None:
    cylinders = [cp.Cylinder(0.05, 0.15, 0.5)] * 4
    z = [k * length for k in range(4)]
    engine = cp.Engine.from_lists(cylinders, tdc_deg=[0, 180, 180, 0], bank_deg=[90] * 4, z=z)
    match = cp.match_parts(engine, [0.5, 0.51, 0.52, 0.53])
    assert math.isfinite(match.value)
