"""Is the least hardware the least, and the front of hardware against residual the front?"""

from __future__ import annotations

import copy
import itertools
import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import Shaft, Unbalance
from crankpin.analysis.balancing.balancer_options import _front
from support import html_of
from support.engines import CYLINDER, I4

RPM = 3000.0
V6_90 = cp.Engine.preset("v6-90")
V6_60 = cp.Engine.preset("v6-60")
SINGLE = cp.Engine.preset("single")
HEAVIER = I4.replace(
    cylinder=[CYLINDER, CYLINDER.replace(reciprocating_mass=0.53), CYLINDER, CYLINDER]
)
OPTIONS = cp.balancer_options(
    V6_90, rpm=RPM, by=["total.moment.peak", "[1].moment.peak"], target={"[1].moment.peak": 0.0}
)


def least(engine: cp.Engine, **targets: float) -> str | None:
    """Name of the least hardware that removes these orders of force and moment."""
    wanted = {f"[{key[1:]}].{key[0]}": value for key, value in targets.items()}
    names = {"f": "force", "m": "moment"}
    target = {f"{k.split('.')[0]}.{names[k.split('.')[1]]}.peak": v for k, v in wanted.items()}
    found = cp.balancer_options(engine, rpm=RPM, by=list(target), target=target).smallest
    return None if found is None else found.name


HALVES = (-1.5, -0.5, 0.5, 1.5)


def half_speed(seed: int) -> cp.Engine:
    """Return an engine with loads that turn at halves of crank speed, and shafts that do."""
    random = np.random.default_rng(seed)
    z = [0.0, 0.1, 0.2, 0.3]
    loads = [
        cp.PeriodicLoad(
            f"gear {ratio}", on="block", force={0: random.choice([100.0, 300.0])},
            turning=True, ratio=ratio, rpm=RPM, scaling="speed squared", z=random.choice(z),
        )
        for ratio in random.choice(HALVES, 3)
    ]  # fmt: skip
    shafts = [
        Shaft(ratio, [Unbalance(0.002, random.choice(z), 90 * random.integers(4))])
        for ratio in random.choice(HALVES, 2)
    ]
    return I4.with_loads(loads).with_shafts(shafts)


def turning_parts(engine: cp.Engine, ratio: float) -> list[complex]:
    """Sum force and moment that turn with a shaft, over ω², by hand: pistons make whole orders."""
    middle = np.mean([engine.z.min(), engine.z.max()])
    parts = [
        (load.force[0] / (np.pi * RPM / 30.0) ** 2, load.z)
        for load in engine.loads
        if load.ratio == ratio
    ]
    parts += [
        (ratio**2 * u.amount * np.exp(1j * np.radians(float(u.angle_deg))), u.z)
        for shaft in engine.shafts
        for u in shaft.unbalances
        if shaft.ratio == ratio
    ]
    return [sum(part for part, _ in parts), sum(1j * (z - middle) * part for part, z in parts)]


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("ratio", HALVES)
def test_shafts_at_halves_remove_what_turns_with_them(seed: int, ratio: float) -> None:
    engine = half_speed(seed)
    options = cp.balancer_options(
        engine, RPM, shaft_orders=[abs(ratio)], counterweights=False, places={ratio: (0.1, 0.2)}
    )
    alone = [each for each in options if {shaft.ratio for shaft in each.shafts} == {ratio}]
    parts, middle = turning_parts(engine, ratio), np.mean([engine.z.min(), engine.z.max()])
    tiny = 1e-12 * CYLINDER.reciprocating_mass * CYLINDER.crank_radius
    assert bool(alone) == (max(map(abs, parts)) > tiny)
    # One set, or those that remove force and moment, force alone or moment alone.
    removed = []
    for option in alone:
        (shaft,) = option.shafts
        assert (shaft.x, shaft.y) == (0.1, 0.2)
        turning = [
            (ratio**2 * u.amount * np.exp(1j * np.radians(float(u.angle_deg))), u.z - middle)
            for u in shaft.unbalances
        ]
        sums = [sum(u for u, _ in turning), sum(1j * z * u for u, z in turning)]
        removed.append(np.allclose(sums, np.negative(parts), rtol=1e-9, atol=tiny))
    assert sum(removed) == bool(alone)


@pytest.mark.parametrize("name", ["-3/2", -1.5])
def test_places_of_shafts_at_halves_are_named_as_ratios_are(name: str | float) -> None:
    engine = I4.with_shafts([Shaft("-3/2", [Unbalance(0.002, 0.1)])])
    options = cp.balancer_options(
        engine, RPM, shaft_orders=[1.5], places={name: (0.1, None)}, counterweights=False
    )
    shafts = {shaft for each in options for shaft in each.shafts}
    assert shafts
    assert all((shaft.ratio, shaft.x) == (-1.5, 0.1) for shaft in shafts)
    assert "shaft −1.5" in [each.name for each in options]


# --- known answers --------------------------------------------------------------------------------


def test_least_hardware_of_known_engines() -> None:
    assert least(cp.Engine.preset("i6"), f1=0, m1=0, f2=0, m2=0) == "nothing"
    assert least(I4, f1=0, f2=0) == "shafts −2, +2"
    assert least(cp.Engine.preset("i3"), m1=0) == "counterweights + shaft −1"
    assert least(V6_90, m1=0) == "counterweights + shaft −1"
    assert least(V6_60, m1=0) == "counterweights"
    assert least(V6_60, m1=0, m2=0) == "counterweights + shaft −2"
    assert least(cp.Engine.preset("v8-crossplane"), m1=0, m2=0) == "counterweights"
    assert least(cp.Engine.preset("v-twin-90"), f1=0) == "counterweights"
    assert least(SINGLE, f1=0) == "counterweights + shaft −1"
    assert least(cp.Engine.preset("i5"), m1=0, m2=0) == "counterweights + shafts −1, −2, +2"
    assert least(cp.Engine.preset("v12-60"), f1=0, m1=0, f2=0, m2=0) == "nothing"
    for name in ("i3", "v6-90"):
        assert least(cp.Engine.preset(name), m2=0) == "shafts −2, +2"
    for name in ("single", "v-twin-90"):
        assert least(cp.Engine.preset(name), f2=0) == "shafts −2, +2"
    assert least(cp.Engine.preset("vr6"), m1=0) == "counterweights + shaft −1"
    assert least(cp.Engine.preset("i4"), f4=0) is None


def test_relative_target() -> None:
    half = cp.balancer_options(I4, rpm=RPM, by="[2].force.peak", target=0.5, relative=True)
    start = I4.balance(RPM)[2].force.peak
    ((by, target),) = half.targets
    assert by == "[2].force.peak"
    assert target == pytest.approx(start / 2)
    assert half.smallest is not None
    assert half.smallest.name == "shaft +2"
    less = cp.balancer_options(I4, rpm=RPM, by="[2].force.peak", target=0.49, relative=True)
    assert less.smallest is not None
    assert less.smallest.name == "shafts −2, +2"
    absolute = cp.balancer_options(I4, rpm=RPM, by="[2].force.peak", target=float(start) * 0.51)
    assert absolute.smallest == half.smallest


def test_rounding_does_not_miss_a_target() -> None:
    def nearly_one(balance: cp.results.Balance) -> float:
        return 1.0 + 1e-12 * len(balance.engine.shafts)

    options = cp.balancer_options(I4, rpm=RPM, by=nearly_one, target=1.0)
    assert all(each.reaches for each in options)


def test_targets_of_several_objectives_must_all_be_reached() -> None:
    both = {"[1].moment.peak": 0.0, "[2].moment.peak": 0.0}
    options = cp.balancer_options(V6_90, rpm=RPM, by="total.force.peak", target=both)
    assert options.by == ("total.force.peak", "[1].moment.peak", "[2].moment.peak")
    assert options.smallest is not None
    assert options.smallest.name == "counterweights + shafts −1, −2, +2"
    assert [each.reaches for each in options].count(True) == 1
    assert options.fitted == options.smallest.fitted
    after = options.fitted.balance(RPM, orders=[1, 2])
    assert after.moment.peak.max() <= 1e-9 * V6_90.balance(RPM)[1].moment.peak


def test_engine_is_undefined_without_a_set_that_reaches_the_target() -> None:
    for target, words in ((None, "no target was given"), ({"[4].force.peak": 0.0}, "no set")):
        options = cp.balancer_options(I4, rpm=RPM, target=target)
        assert options.smallest is None
        for name in ("fitted", "hardware", "residual"):
            assert not hasattr(options, name)
            with pytest.raises(cp.InputError, match=words):
                getattr(options, name)


# --- what is compared -----------------------------------------------------------------------------


def test_sets_are_all_combinations_that_have_something_to_remove() -> None:
    names = {each.name for each in OPTIONS}
    shafts = ["", "−1", "−2", "+2", "−1, −2", "−1, +2", "−2, +2", "−1, −2, +2"]
    words = [f"shaft{'s' * (',' in each)} {each}" if each else "" for each in shafts]
    expected = {" + ".join(filter(None, [c, w])) for c in ("", "counterweights") for w in words}
    assert names == {each or "nothing" for each in expected}
    assert len(OPTIONS) == len(names)
    assert OPTIONS[0].name == "nothing"
    assert OPTIONS[0].fitted == V6_90
    assert OPTIONS[0].hardware == ()
    key = [(len(each.shafts), each.unbalance) for each in OPTIONS]
    assert key == sorted(key)


def test_without_counterweights_a_shaft_at_plus_1_is_compared() -> None:
    options = cp.balancer_options(SINGLE, rpm=RPM, counterweights=False, shaft_orders=1)
    assert {each.name for each in options} == {"nothing", "shaft −1", "shaft +1", "shafts −1, +1"}
    assert all(each.counterweights == () for each in options)


def test_force_and_moment_are_removed_together_or_alone() -> None:
    options = cp.balancer_options(HEAVIER, rpm=RPM, shaft_orders=1, most_shafts=1)
    assert {each.name for each in options} == {
        f"{weights}{shaft}" or "nothing"
        for weights in ("", "counterweights")
        for shaft in (
            ["", "shaft −1", "shaft −1 (force alone)", "shaft −1 (moment alone)"]
            if not weights
            else ["", *(f" + shaft −1{way}" for way in ("", " (force alone)", " (moment alone)"))]
        )
    }
    (alone,) = (each for each in options if each.name == "shaft −1 (force alone)")
    after, before = (e.balance(RPM, orders=[1])[1] for e in (alone.fitted, HEAVIER))
    assert abs(after.force.backward) <= 1e-12 * abs(before.force.backward)
    assert after.moment.backward == pytest.approx(complex(before.moment.backward))


def test_most_shafts() -> None:
    options = cp.balancer_options(V6_90, rpm=RPM, most_shafts=1)
    assert {len(each.shafts) for each in options} == {0, 1}


def test_counterweights_stand_in_the_planes_given() -> None:
    options = cp.balancer_options(V6_90, rpm=RPM, planes=[-0.05, 0.3], shaft_orders=[2])
    assert {w.z for each in options for w in each.counterweights} == {-0.05, 0.3}
    for each in options:
        forward = each.fitted.balance(RPM, orders=[1])[1].moment.forward
        assert (abs(forward) < 1e-9) == bool(each.counterweights)


def test_what_the_engine_has_stays() -> None:
    own = [Unbalance(0.01, 0.1, 30, pin=2)]
    shaft = [Shaft(3, [Unbalance(0.001, 0.0)])]
    equipped = V6_90.with_counterweights(own).with_shafts(shaft)
    for each in cp.balancer_options(equipped, rpm=RPM):
        assert each.fitted.counterweights == (*own, *each.counterweights)
        assert each.fitted.shafts == (*shaft, *each.shafts)
        assert each.unbalance == pytest.approx(
            sum(w.amount for w in each.counterweights)
            + sum(w.amount for f in each.shafts for w in f.unbalances)
        )


def test_places() -> None:
    at = {-2: (0.1, None), 2: (-0.1, 0.05)}
    options = cp.balancer_options(I4, rpm=RPM, by="[2].torque.peak", places=at)
    pair = options[-1]
    assert [each.x for each in pair.shafts] == [0.1, -0.1]
    assert pair.shafts[1].y == 0.05
    assert pair.values[0] <= 1e-9 * options[0].values[0]
    free = cp.balancer_options(I4, rpm=RPM, by="[2].torque.peak")[-1]
    assert free.values[0] <= 1e-9 * options[0].values[0]


# --- what is read ---------------------------------------------------------------------------------


def test_values_are_those_of_the_balance() -> None:
    for each in OPTIONS:
        balance = each.fitted.balance(RPM)
        first = each.fitted.balance(RPM, orders=[1])[1]
        expected = (balance.total.moment.peak, float(first.moment.peak))
        # Orders are chosen for all sets together, or for one.
        assert each.values == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_functions_and_reference_plane() -> None:
    def pitch(balance: cp.results.Balance) -> float:
        return float(balance.total.moment.peak_xy[0])

    engine = HEAVIER.replace(reference_z=0.4)
    options = cp.balancer_options(engine, rpm=RPM, by=pitch, shaft_orders=1)
    assert options.by == ("pitch",)
    for each in options:
        balance = each.fitted.balance(RPM)
        assert each.values[0] == pytest.approx(balance.total.moment.peak_xy[0], rel=1e-6)


@pytest.mark.parametrize("name", ["v6-90", "vr6", "single", "i3"])
def test_front(name: str) -> None:
    """No set of the front is beaten, and each other set is beaten by one of the front."""
    options = cp.balancer_options(cp.Engine.preset(name), rpm=RPM)
    rows = {
        each.name: np.array([len(each.shafts), each.unbalance, *each.values]) for each in options
    }
    scale = np.max(list(rows.values()), axis=0)
    slack = 1e-9 * np.where(scale > 0.0, scale, 1.0)

    def beats(one: np.ndarray, other: np.ndarray) -> bool:
        return bool((one <= other + slack).all() and (one < other - slack).any())

    front = [each.name for each in options.pareto_front]
    for each, row in rows.items():
        assert (each in front) != any(beats(rows[other], row) for other in front), each
    assert 1 < len(front) < len(options)


def test_front_has_the_least_that_reaches_the_target() -> None:
    assert OPTIONS.smallest in OPTIONS.pareto_front
    assert OPTIONS.smallest == next(each for each in OPTIONS if each.reaches)


# --- the object -----------------------------------------------------------------------------------


def test_result_is_frozen_and_copies() -> None:
    for one in (OPTIONS, OPTIONS[3]):
        assert pickle.loads(pickle.dumps(one)) == one  # noqa: S301 - its own
        assert copy.deepcopy(one) == one
        assert hash(copy.copy(one)) == hash(one)
        with pytest.raises(AttributeError):
            one.rpm = 3  # type: ignore[misc, union-attr]
    assert cp.balancer_options(V6_90, rpm=RPM) != OPTIONS
    with pytest.raises(cp.InputError, match=r"use crankpin\.balancer_options"):
        cp.results.BalancerOptions(V6_90, RPM, (), (), ())


def test_table_shows_the_front_and_whether_it_reaches_the_target() -> None:
    table = OPTIONS.table
    words = {True: "reached", False: "missed"}
    expected = [
        (each.name, str(len(each.shafts)), words[each.reaches], each.unbalance, *each.values)
        for each in OPTIONS.pareto_front
    ]
    assert list(zip(*(column.values for column in table.columns), strict=True)) == expected
    last = repr(OPTIONS).splitlines()[-1]
    assert last == "Target: order-1 rocking moment ≤ 0 N·m; least counterweights + shaft −1."
    assert f"{len(OPTIONS.pareto_front)} of {len(OPTIONS)} sets" in repr(OPTIONS).splitlines()[0]
    assert html_of(OPTIONS).startswith("<table>")
    assert "\n" not in repr(OPTIONS[0])
    assert "no set reaches it" in repr(
        cp.balancer_options(I4, rpm=RPM, target={"[4].force.peak": 0.0})
    )
    assert "arget" not in repr(cp.balancer_options(I4, rpm=RPM))


def test_the_long_form_has_all_sets() -> None:
    table = OPTIONS.tidy()
    assert list(table) == [
        "name", "n_shafts", "unbalance", "on_pareto_front", "reaches", "objective", "value", "unit",
    ]  # fmt: skip
    assert list(table["value"].values) == [value for each in OPTIONS for value in each.values]
    assert list(table["name"].values) == [each.name for each in OPTIONS for _ in range(2)]
    assert table.to_pandas()["on_pareto_front"].sum() == 2 * len(OPTIONS.pareto_front)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"engine": "i4"}, "^engine = 'i4': give a crankpin.Engine"),
        ({"rpm": "fast"}, "^rpm = 'fast': give a number"),
        ({"by": "force"}, "^by = 'force': give"),
        ({"target": 3.0}, "^target = 3.0: by has objectives of several units"),
        ({"target": -1.0, "by": "total.force.peak"}, "^target = -1.0: give 0 or more"),
        ({"target": {"total.force.peak": np.nan}}, r"^target\['total.force.peak'\] = nan"),
        ({"target": {"force": 1.0}}, "^target = 'force': give"),
        ({"relative": 1}, "^relative = 1: give True or False"),
        ({"counterweights": None}, "^counterweights = None: give True or False"),
        ({"shaft_orders": 0}, "^shaft_orders = 0"),
        ({"shaft_orders": "auto"}, "^shaft_orders = .auto.: give numbers"),
        ({"most_shafts": -1}, "^most_shafts = -1: give 0 or more"),
        ({"places": 3}, "^places = 3: give a mapping"),
        ({"places": {-1: (1, 2, 3)}}, r"^places\[-1\] = \(1, 2, 3\): give a mapping"),
        (
            {"places": {3: (1, 2)}},
            r"^places\[3\] = .*: ratios of the shafts compared are -1, -2, 2",
        ),
        ({"places": {-1: (1, "x")}}, r"^places\[-1\] = 'x': give a number"),
        ({"planes": "x"}, r"^planes = 'x': give \"ends\" or"),
        ({"orders": [1], "by": "[2].force.peak"}, r"^orders = \[1\]"),
    ],
)
def test_errors_name_the_argument(given: dict[str, Any], words: str) -> None:
    arguments: dict[str, Any] = {"engine": I4, "rpm": RPM} | given
    with pytest.raises(cp.InputError, match=words):
        cp.balancer_options(**arguments)


def test_too_many_sets() -> None:
    with pytest.raises(cp.InputError, match=r"^shaft_orders make .* sets of shafts: give fewer"):
        cp.balancer_options(V6_90, rpm=RPM, shaft_orders=range(1, 20), most_shafts=19)


@pytest.mark.parametrize("most", [0, 1, 2])
def test_sets_are_all_those_of_at_most_so_many_shafts(most: int) -> None:
    """However many there would be of more."""
    options = cp.balancer_options(V6_90, rpm=RPM, shaft_orders=range(1, 20), most_shafts=most)
    of_one = cp.balancer_options(V6_90, rpm=RPM, shaft_orders=range(1, 20), most_shafts=1)
    shafts = {each.shafts[0].ratio: 0 for each in of_one if each.shafts}
    for ratio in shafts:  # shafts of one ratio: those that remove both, or one of the two
        same = [each for each in of_one if each.shafts and each.shafts[0].ratio == ratio]
        shafts[ratio] = len(same) // 2  # with counterweights and without
    counts = list(shafts.values())
    expected = [1, sum(counts), sum(a * b for a, b in itertools.combinations(counts, 2))]
    for number in range(3):
        got = sum(len(each.shafts) == number for each in options)
        assert got == (2 * expected[number] if number <= most else 0)


def test_the_front_is_what_nothing_is_better_than() -> None:
    """Of few values, so that rows are equal, or differ by less than the slack."""
    random = np.random.default_rng(3)
    for _ in range(300):
        shape = (random.integers(1, 30), random.integers(1, 5))
        values = random.integers(0, 3, shape) + 0.4e-9 * random.integers(0, 4, shape)
        slack = np.full(shape[1], 1e-9)
        slack[0] = 0.0
        better = [
            [(other <= row + slack).all() and (other < row - slack).any() for other in values]
            for row in values
        ]
        np.testing.assert_array_equal(_front(values, slack), ~np.any(better, axis=1))
