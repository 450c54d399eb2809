"""Do the objects keep what they promise: frozen, read-only, copied, written and read back?

And do the examples in the docstrings say the truth, and does ``import crankpin`` leave alone the
libraries that draw and tabulate?
"""

# ruff: noqa: ANN401 - what is compared and changed here is of any type

from __future__ import annotations

import copy
import dataclasses
import doctest
import inspect
import pickle
import re
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import partial
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from support import html_of, in_turn
from support.engines import OFFSET
from support.objects import (
    I4,
    OBJECTS,
    ODD,
    SPECTRUM,
    THETA,
    V6,
    balance,
    designs,
    ranking,
    sweep,
    waveform,
)

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

every_object = in_turn("name", OBJECTS)


def figures(value: Any) -> dict[str, Any]:
    """Public figures of an object, by name; without those that a spectrum leaves unknown."""
    found = {}
    for name in dir(value):
        if name in ("_", "result") or name.startswith("_"):
            continue
        if name == "total" and getattr(value, "order", None) == "all":  # that of itself
            continue
        if callable(getattr(type(value), name, None)):
            continue
        try:
            found[name] = getattr(value, name)
        except (cp.InputError, AttributeError):
            continue
    return found


def assert_same(one: Any, other: Any) -> None:
    """Equal to the last bit, arrays and all."""
    assert type(one) is type(other)
    if isinstance(one, cp.results.Quantity) and one.order == "all":
        assert_same(figures(one), figures(other))
    elif isinstance(one, (np.ndarray, cp.results.Quantity)):
        np.testing.assert_array_equal(one, other)
    elif isinstance(one, (tuple, list)):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_same(a, b)
    elif isinstance(one, Mapping):
        assert list(one) == list(other)
        for key in one:
            assert_same(one[key], other[key])
    elif isinstance(
        one,
        (cp.results.OrderBalance, cp.results.Waveform, cp.results.Sweep, cp.results.SweepWaveform),
    ):
        assert_same(figures(one), figures(other))
    else:
        assert one == other


def arrays(value: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Public arrays of an object."""
    for name, figure in figures(value).items():
        listed: Iterable[Any] = figure.values() if isinstance(figure, Mapping) else [figure]
        listed = figure if isinstance(figure, tuple) else listed
        for each in listed:
            if isinstance(each, cp.results.Quantity) and each.order != "all":
                yield name, np.asarray(each)
            elif isinstance(each, np.ndarray):
                yield name, each


# --- frozen -------------------------------------------------------------------------------------


@every_object
def test_attributes_cannot_be_set_or_deleted(name: str) -> None:
    value = OBJECTS[name]
    for attribute in [*figures(value), "new"]:
        # A NamedTuple and a dataclass with slots raise what Python has them raise.
        with pytest.raises((AttributeError, TypeError)):
            setattr(value, attribute, 0)
        with pytest.raises((AttributeError, TypeError)):
            delattr(value, attribute)


@every_object
def test_arrays_are_read_only(name: str) -> None:
    found = list(arrays(OBJECTS[name]))
    without = (
        "PeriodicLoad",
        "Actuator",
        "MountDesign",
        "VelocityFeedback",
        "Cylinder",
        "Rod",
        "Actuator",
        "InertiaTrack",
        "Mount",
        "RigidBody",
        "ForceTable",
        "BaseMotion",
        "Powertrain",
        "Powertrain on a subframe",
        "Powertrain on a receptance",
        "Soil",
        "VehicleAxes",
        "Subframe",
        "Receptance",
        "PointMotion",
        "PointMotion of a receiver",
        "WorstForce",
        "Shaft",
        "Unbalance",
        "ValveTiming",
        "PortTiming",
        "Arrangement",
        "Match",
        "Table",
        "Verdicts",
        "Sweep of one",
        "Balance",
        "OrderBalance",
        "Exercise",
        "Explanation",
        "ClosedForm",
        "Comparison",
        "Choice",
        "Ranking",
        "Waveform",
        "Card",
        "Counterweights",
        "Design",
        "FlywheelDisc",
        "FlywheelRim",
        "LinkRod",
    )
    assert found or name.startswith(without)
    for attribute, array in found:
        assert not array.flags.writeable, attribute
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_every_class_is_among_the_objects() -> None:
    classes = {type(value) for value in OBJECTS.values()}
    assert all(name.startswith(type(value).__name__) for name, value in OBJECTS.items())
    public = {getattr(module, name) for module in (cp, cp.results) for name in module.__all__}
    assert {each for each in public if isinstance(each, type)} - classes == {cp.InputError}


def changed_in_place(value: Any) -> Iterator[str]:
    """Change all that can be changed of a value, to the bottom; yield how."""
    if isinstance(value, np.ndarray) and value.flags.writeable and value.size:
        value[...] = 0
        yield "an array"
    elif isinstance(value, dict | list | set):
        yield from (how for each in list(value) for how in changed_in_place(each))
        if isinstance(value, dict):
            yield from (how for each in value.values() for how in changed_in_place(each))
        value.clear()
        yield f"a {type(value).__name__}"
    elif isinstance(value, Mapping):
        yield from (how for each in value.values() for how in changed_in_place(each))
    elif isinstance(value, tuple):
        yield from (how for each in value for how in changed_in_place(each))


@every_object
def test_what_is_read_cannot_be_changed(name: str) -> None:
    """Fields are frozen to the bottom; of what a property makes anew, the next reader sees none."""
    value = OBJECTS[name]
    fields = {each.name for each in getattr(type(value), "_fields", ())}
    for attribute in figures(value):
        before = repr(getattr(value, attribute))
        ways = list(changed_in_place(getattr(value, attribute)))
        assert not (ways and attribute in fields), attribute
        assert repr(getattr(value, attribute)) == before, attribute


def test_given_arrays_are_copied() -> None:
    """What is changed afterwards outside changes nothing inside; what was given stays writable."""
    z, theta, rpm = np.array([0.0, 0.1]), np.array([0.0, 90.0]), np.array([1000.0, 2000.0])
    spectrum = dict(SPECTRUM)
    engine = cp.Engine.from_lists(OFFSET, tdc_deg=[0, 180], bank_deg=[90, 90], z=z)
    w, s = engine.waveform(1000, theta_deg=theta), cp.sweep(engine, rpm=rpm, orders=[1])
    b = engine.balance(1000, orders=[1], spectrum=spectrum)
    first = [engine.z.copy(), w.theta_deg.copy(), s.moment.xy.copy()]
    for array in (z, theta, rpm):
        array[:] = 7.0
    spectrum[1] = 9.0
    assert_same([engine.z, w.theta_deg, s.moment.xy], first)
    assert b.spectrum == SPECTRUM
    np.testing.assert_array_equal(s.coords["rpm"], [1000.0, 2000.0])


def test_completion_offers_what_is_public() -> None:
    assert dir(cp) == sorted(cp.__all__)
    assert [name for name in dir(cp) if inspect.ismodule(getattr(cp, name))] == ["results"]


# --- another question is another call -------------------------------------------------------------

INPUTS = (
    cp.Engine, cp.Cylinder, cp.Rod, cp.Shaft, cp.Unbalance, cp.Cycle, cp.CycleMap, cp.Traces,
    cp.ValveTiming, cp.LinkRod, cp.LinkRods,
    cp.PortTiming, cp.Actuator, cp.InertiaTrack, cp.Mount,
    cp.RigidBody, cp.Powertrain, cp.Subframe, cp.Receptance, cp.PeriodicLoad,
    cp.ForceTable, cp.BaseMotion, cp.Soil, cp.Locomotive, cp.VehicleAxes,
)  # fmt: skip


@every_object
def test_inputs_alone_have_replace(name: str) -> None:
    value = OBJECTS[name]
    if isinstance(value, INPUTS):
        assert value.replace() == value
        with pytest.raises((cp.InputError, TypeError)):
            value.replace(nonsense=1)  # type: ignore[call-arg]
        return
    assert not hasattr(value, "replace")
    assert not hasattr(value, "__replace__")
    with pytest.raises(TypeError):
        dataclasses.replace(value)


FRESH: dict[str, Callable[[Any], Any]] = {
    "Balance": lambda b: b.engine.balance(b.rpm, orders=b._request.orders, spectrum=b.spectrum),
    "BalanceShafts": lambda s: cp.balance_shafts(s.engine, [2, -2]),
    "BearingLoads": lambda b: cp.bearing_loads(b.engine, b.rpm, b.theta_deg),
    "RodLoads": lambda r: cp.rod_loads(r.engine, r.rpm, r.theta_deg),
    "Comparison": lambda c: cp.compare(c.before.engine, c.after.engine, c.rpm, orders=[1, 2]),
    "Exercise": lambda e: cp.exercise(e.topic, e.seed),
    "Explanation": lambda e: e.engine.explain(e.rpm),
    "Firing": lambda f: f.engine.firing(f.order, strokes=f.strokes),
    "StarDiagram": lambda d: cp.star_diagram(d.engine, d.orders, mode_shape=d.mode_shape),
    "Sweep": lambda s: cp.sweep(
        dict(zip(s.names, s.engines, strict=True)), **s.axes, hold=s.hold, orders=s.orders
    ),
    "TorsionalExcitation": lambda t: cp.torsional_excitation(t.engine, t.rpm, orders=t.orders),
    "VanishingOrders": lambda v: v.engine.vanishing_orders(v.orders),
    "Waveform": lambda w: w.engine.waveform(w.rpm, theta_deg=w.theta_deg, orders=w.orders),
    "Balance, fired": lambda b: b.engine.balance(b.rpm),
    "BearingLoads, fired": lambda b: cp.bearing_loads(b.engine, b.rpm, b.theta_deg),
    "Flywheel, fired": lambda f: cp.flywheel(f.engine, f.rpm, inertia=f.inertia),
    "TorsionalExcitation, fired": lambda t: cp.torsional_excitation(t.engine, t.rpm),
    "Waveform, fired": lambda w: w.engine.waveform(w.rpm, theta_deg=w.theta_deg),
}


@pytest.mark.parametrize("name", FRESH)
def test_equal_fields_are_equal_numbers(name: str) -> None:
    """A result's fields put to its function again give the same figures, to the last bit."""
    value = OBJECTS[name]
    again = FRESH[name](value)
    assert again == value
    assert_same(figures(again), figures(value))


# --- copies -------------------------------------------------------------------------------------


def pickled(value: Any, protocol: int = pickle.DEFAULT_PROTOCOL) -> Any:
    return pickle.loads(pickle.dumps(value, protocol))  # noqa: S301 - its own


COPIES: dict[str, Callable[[Any], Any]] = {"copy": copy.copy, "deepcopy": copy.deepcopy} | {
    f"pickle {protocol}": partial(pickled, protocol=protocol)
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)
}


@in_turn("how", COPIES)
@every_object
def test_copies_are_equal_and_frozen(name: str, how: str) -> None:
    value = OBJECTS[name]
    copied = COPIES[how](value)
    assert_same(figures(copied), figures(value))
    assert repr(copied) == repr(value)
    for attribute, array in arrays(copied):
        assert not array.flags.writeable, attribute
    with pytest.raises((AttributeError, TypeError)):
        copied.new = 0


@in_turn("name", [name for name in OBJECTS if name.startswith(("C", "E", "B", "V", "R"))])
def test_copies_compare_and_hash_equal(name: str) -> None:
    value = OBJECTS[name]
    for copied in (how(value) for how in COPIES.values()):
        assert copied == value
        assert hash(copied) == hash(value)


def test_what_was_left_out_is_pickled_with_the_rest() -> None:
    auto = balance(orders="auto", rtol=1e-3)
    assert auto.omitted
    assert auto.error_bound["moment"] > 0.0
    for how in COPIES.values():
        copied = how(auto)
        assert copied.omitted == auto.omitted
        assert copied.error_bound == auto.error_bound


@pytest.mark.parametrize("name", ["", "x" * 10_000, "\x01" * 10_000])
def test_a_large_engine_is_pickled_like_any_other(name: str) -> None:
    """A thousand cylinders, every one with parts of its own and angles of many digits, and the
    longest name that is taken, also where a file writes six letters for one.
    """
    count = 1000
    rng = np.random.default_rng(1)
    engine = cp.Engine.from_lists(
        [OFFSET.replace(reciprocating_mass=float(mass)) for mass in rng.random(count)],
        tdc_deg=rng.random(count) * 360.0,
        bank_deg=rng.random(count) * 360.0,
        z=rng.random(count),
        rotating_mass=rng.random(count),
        name=name,
    )
    assert pickled(engine) == engine
    assert cp.Engine.from_toml(engine.to_toml()) == engine
    with pytest.raises(cp.InputError, match="name"):
        engine.replace(name="x" * 10_001)


# --- equality and hash --------------------------------------------------------------------------

CHANGES: dict[str, dict[str, Any]] = {
    "cylinder": {"cylinder": OFFSET.replace(rod_length=0.16)},
    "tdc_deg": {"tdc_deg": [1, 60, 240, 300, 120, 180]},
    "pin_deg": {"pin_deg": [0] * 6},
    "bank_deg": {"bank_deg": [60, 121] * 3},
    "z": {"z": [0, 0, 0.13, 0.13, 0.26, 0.27]},
    "rotating_mass": {"rotating_mass": 0.9},
    "name": {"name": "another"},
    "source": {"source": "elsewhere"},
}


def test_equal_engines_have_equal_figures_and_hashes() -> None:
    again = cp.Engine.from_lists(
        OFFSET,
        tdc_deg=V6.tdc_deg + 360.0,
        bank_deg=V6.bank_deg - 360.0,
        z=V6.z,
        rotating_mass=V6.rotating_mass,
        name="V6",
        source="a test",
    )
    assert again == V6
    assert hash(again) == hash(V6)
    assert len({again, V6}) == 1


@pytest.mark.parametrize("name", CHANGES)
def test_replace_changes_one_thing(name: str) -> None:
    before = figures(V6)
    changed = V6.replace(**CHANGES[name])
    assert changed != V6
    assert not changed == V6  # noqa: SIM201 - the other operator
    assert_same(figures(V6), before)
    affected = {"cylinder": {"cylinders"}, "tdc_deg": {"tdc_deg", "pin_deg"}}
    affected |= {"pin_deg": {"tdc_deg", "pin_deg"}, "z": {"z", "reference_z", "mains"}}
    affected |= {"name": {"name", "title"}}
    # With other bores and the same top dead centres the crankpins are elsewhere.
    affected |= {"bank_deg": {"bank_deg", "pin_deg", "bank_angle_deg"}}
    for moved in ("tdc_deg", "pin_deg", "bank_deg"):
        affected[moved] |= {"throws_deg", "pin_split_deg"}
    after = figures(changed)
    for figure in before.keys() & after.keys() - affected.get(name, {name}) - {"table", "frames"}:
        assert_same(after[figure], before[figure])
    assert changed.replace(**undo(name)) == V6


def undo(name: str) -> dict[str, Any]:
    """The change back."""
    if name == "cylinder":
        return {"cylinder": V6.cylinders}
    return {name: getattr(V6, name)}


def test_replace_of_nothing_is_equal_even_for_odd_angles() -> None:
    assert ODD.replace() == ODD
    assert V6.replace() == V6
    assert OFFSET.replace() == OFFSET


def test_a_cylinder_is_compared_by_its_figures() -> None:
    assert cp.Cylinder(1, 2, 7) == cp.Cylinder(1.0, 2.0, 7.0, 0.0)
    assert hash(cp.Cylinder(1, 2, 7)) == hash(cp.Cylinder(1.0, 2.0, 7.0, -0.0))
    assert OFFSET.replace(pin_offset=0.0) != OFFSET
    assert OFFSET.stroke == 0.09
    assert OFFSET.rod_ratio == 0.045 / 0.158


def test_balances_are_compared_by_what_was_asked() -> None:
    assert balance() == balance()
    assert hash(balance()) == hash(balance())
    for other in (
        balance(rpm=5001),
        balance(orders=[1, 2]),
        balance().about(0.0),
        balance(spectrum=SPECTRUM),
        V6.replace(name="another").balance(5000, orders=[1, 2, 6]),
    ):
        assert other != balance()


def test_rankings_are_compared_by_what_was_asked_and_found() -> None:
    assert ranking() == ranking()
    assert hash(ranking()) == hash(ranking())
    others = (
        ranking(rpm=5001),
        ranking(orders=[1, 2, 4]),
        ranking(bank_angle_deg=[60, 75, 91]),
        ranking(hold="firing"),
        ranking(spectrum=SPECTRUM),
        ranking(by="[2].moment.peak"),
        ranking(by=["total.moment.peak", "[2].moment.peak"]),
        cp.rank(
            [V6],
            rpm=5000,
            by="total.moment.peak",
            bank_angle_deg=[60, 75, 90],
            hold="pins",
            orders=[1, 2],
        ),
    )
    for other in others:
        assert other != ranking()


def test_nothing_equals_something_else() -> None:
    for value in OBJECTS.values():
        for other in (None, 0, "V6", object()):
            # Of a quantity, an array, item by item.
            assert np.all(value != other)
            assert not np.any(value == other)


# What nobody means as a key, an item or an operand; True is 1 to Python.
ODD_VALUES: list[Any] = [
    None, True, 0, -1, 2.5, float("nan"), 1j, "x", "all", "", b"x", [], (1, 2), {}, {1: 2}, set(),
    np.array([1, 2]), np.array([]), np.datetime64("2020"), object(), ...,
    slice(None), slice("a", 1), 10**400, "\ud800", cp.Engine, len,
]  # fmt: skip
TOTALS = {"Quantity, all orders": lambda: balance().total.moment, "Presets": cp.presets}


@in_turn("name", [*OBJECTS, *TOTALS])
def test_operators_answer_whatever_they_meet(name: str) -> None:
    """``==`` and ``in`` answer; a key that is not there is an InputError, and one of lookups."""
    value = (OBJECTS | TOTALS)[name]
    for other in ODD_VALUES:
        assert np.all(value != other)
        assert not np.any(value == other)
        if hasattr(value, "__iter__"):
            known = isinstance(other, float) and other in list(value)
            assert (other in value) is known
        if hasattr(value, "__getitem__"):
            try:
                value[other]
            except cp.InputError as error:
                assert str(error)  # noqa: PT017 - some keys are there
    if not isinstance(value, cp.results.Quantity):
        assert hash(value) == hash(value)
        assert value == value  # noqa: PLR0124 - the law
        assert not value != value  # noqa: PLR0124, SIM202 - the law
        assert bool(value) == (len(value) > 0 if hasattr(value, "__len__") else True)


def test_a_quantity_is_equal_item_by_item_and_has_no_hash() -> None:
    b = balance()
    assert not any(isinstance(each, Hashable) for each in [b.moment])
    with pytest.raises(TypeError, match="unhashable"):
        hash(b.moment)
    assert (b.moment == b.moment.xy).all()
    assert (b.moment != b.force).any()
    assert (b.moment == [1, 2, 3, 4, 5]) is False
    assert (b.total.moment == None) is False  # noqa: E711 - the comparison meant
    assert (b.total.moment == balance().total.moment) is True
    assert b.total.moment != b.total.force
    with pytest.raises(cp.InputError, match=r"operands of add = .*: give numbers, or an array"):
        np.add(b.moment, [1, 2, 3, 4, 5])
    assert True not in b
    assert np.array([1, 2]) not in b
    assert 1.0 in b
    assert list(reversed(b)) == [6, 2, 1]


def test_missing_items_are_input_errors_and_those_of_lookups() -> None:
    listed = {cp.search_arrangements(6): 99, ranking(): 99, designs(): "x", balance().table: "x"}
    for value, key in listed.items():
        with pytest.raises(cp.InputError) as caught:
            value[key]  # type: ignore[index]
        assert isinstance(caught.value, KeyError)
        assert isinstance(caught.value, IndexError)
        assert str(caught.value).startswith(("index = ", "column = "))
    with pytest.raises(cp.InputError, match='did you mean "order"'):
        balance().table["ordre"]
    assert next(iter(balance().table)) == "order"
    assert "order" in balance().table
    with pytest.raises(cp.InputError, match="order = True"):
        cp.star_diagram(I4)[True]


def test_zero_has_one_sign_for_equality_and_hash() -> None:
    one, other = (
        cp.Engine.from_lists(OFFSET, tdc_deg=[0.0], bank_deg=[90], z=[zero]) for zero in (0.0, -0.0)
    )
    assert one == other
    assert hash(one) == hash(other)


# --- files --------------------------------------------------------------------------------------


def rng_engine(number: int) -> cp.Engine:
    """Figures with all their digits."""
    rng = np.random.default_rng(number)
    count = int(rng.integers(1, 9))
    return cp.Engine.from_lists(
        [cp.Cylinder(*(rng.random(3) * [0.1, 1.0, 2.0] + [0.0, 0.2, 0.0])) for _ in range(count)],
        tdc_deg=[f"{n}/{d}" for n, d in rng.integers(1, 10**6, (count, 2))],
        bank_deg=(rng.random(count) * 720.0 - 360.0).tolist(),
        z=rng.standard_normal(count),
        rotating_mass=rng.random(count),
    )


FILED = {"V6": V6, "odd": ODD, **{f"random {k}": rng_engine(k) for k in range(20)}}


@in_turn("name", FILED)
def test_texts_read_back_as_the_same_engine(name: str, tmp_path: Path) -> None:
    engine = FILED[name]
    toml, json = engine.to_toml(), engine.to_json()
    for read in (cp.Engine.from_toml(toml), cp.Engine.from_json(json)):
        assert read == engine
        assert_same(figures(read), figures(engine))
    assert cp.Engine.from_json(json).to_toml() == toml
    for suffix in (".toml", ".json", ".TOML"):
        path = tmp_path / f"engine{suffix}"
        engine.save(path)
        assert cp.Engine.load(path) == engine
        assert cp.Engine.load(str(path)) == engine


@pytest.mark.parametrize("angle", ["360/7", Fraction(1, 3), Fraction(360, 999), "-1/3", 1e-17, 7.3])
def test_angles_survive_files_and_copies_exactly(angle: Any) -> None:
    """Sums that vanish are exact zeros only while the angle is the fraction that was given."""
    count = Fraction(360) / Fraction(angle) if not isinstance(angle, float) else Fraction(0)
    engine = cp.Engine.from_lists(OFFSET, tdc_deg=[0, angle], bank_deg=[90, 90], z=[0, 0.1])
    for back in (
        cp.Engine.from_toml(engine.to_toml()),
        cp.Engine.from_json(engine.to_json()),
        pickled(engine),
        engine.replace(name="x").replace(name=""),
        engine if isinstance(angle, float) else engine.with_first_tdc("1/11").with_first_tdc(0),
    ):
        assert back == engine
        assert back.to_toml() == engine.to_toml()
    if count.denominator == 1 and 1 < count <= 100:
        step = Fraction(angle)
        wheel = cp.Engine.from_lists(
            OFFSET,
            tdc_deg=[step * k for k in range(int(count))],
            bank_deg=[90] * int(count),
            z=[0.1 * k for k in range(int(count))],
        )
        again = cp.Engine.from_toml(wheel.to_toml())
        assert not again.balance(1000, orders=[1, 2]).force.any()


@pytest.mark.parametrize("angle", [-1e-300, -5e-324, -1e-17, "-1/1000000000000", 360.0, -0.0])
def test_angles_beside_a_whole_turn_read_back(angle: Any) -> None:
    """Less whole turns such an angle rounds to 360 degrees, which is none."""
    engine = cp.Engine.from_lists(OFFSET, tdc_deg=[angle], bank_deg=[90], z=[0])
    assert cp.Engine.from_json(engine.to_json()) == engine
    assert cp.Engine.from_toml(engine.to_toml()) == engine
    assert pickled(engine) == engine
    assert engine.replace() == engine
    assert 0.0 <= engine.tdc_deg[0] < 360.0


def test_a_file_names_its_schema() -> None:
    assert V6.to_toml().startswith("schema = 1\n")
    assert '"schema": 1' in V6.to_json()


# --- what people see ----------------------------------------------------------------------------


class Cells(HTMLParser):
    """Counts rows and cells, and sees that what is opened is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.count: dict[str, int] = {}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.count[tag] = self.count.get(tag, 0) + 1

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@every_object
def test_repr_is_short_and_names_the_kind(name: str) -> None:
    text = repr(OBJECTS[name])
    assert text.isprintable() or "\n" in text
    assert len(text) < 2200  # thirty rows and notes
    tables = (
        "Balance",
        "OrderBalance",
        "Comparison",
        "Engine",
        "Vanishing",
        "ClosedForm",
        "Ranking",
        "ForceTable",
        "BaseMotion",
        "BaseResponse",
        "MountComparison",
        "Powertrain",
        "StaticState",
        "LoadCases",
        "MountModes",
        "MountResponse",
        "MountRobustness",
        "MountDesign",
        "DesignResponses",
        "MountSweep",
        "DrivenResponse",
        "Cancellation",
        "AdaptiveLaw",
        "VelocityFeedback",
        "PointMotion",
        "Oscillogram",
        "PreparedTrace",
        "RollAxes",
        "Waveform",
        "Counterweights",
        "BearingLoads",
        "BobWeight",
        "Card",
        "DeadCentres",
        "Exercise",
        "Explanation",
        "Flywheel",
        "TurningMoment",
        "FoundationTable",
        "GuideMoments",
        "RodLoads",
        "Locomotive",
        "Match",
        "Quantity",
        "Table",
        "Tolerances",
        "TwoPlane",
        "Star",
        "Sweep",
    )
    if not name.startswith(tables):  # tables under a title
        assert name.split(maxsplit=1)[0].rstrip(",") in text


@every_object
def test_columns_have_their_units_apart(name: str) -> None:
    for table in getattr(OBJECTS[name], "frames", {}).values():
        for column in table.columns:
            assert column.name.split()[-1:] not in [["°"], ["m"], ["kg"], ["g"], ["N"], ["N·m"]]


def test_a_balance_is_shown_as_a_table() -> None:
    *lines, loads = repr(balance()).splitlines()
    assert loads == "Without gas pressure."
    assert "V6" in lines[0]
    assert "5000 rpm" in lines[0]
    assert [line.split()[0] for line in lines[1:]] == ["order", "1", "2", "6", "all"]
    assert all(len(line) <= 100 for line in lines)
    assert len({len(line) for line in lines[1:]}) == 1
    known = repr(balance(spectrum=SPECTRUM))
    assert "M_z" in repr(balance())
    assert "M_z" not in known


def test_a_balance_is_shown_as_html_in_notebooks() -> None:
    parser = Cells()
    parser.feed(html_of(balance()))
    parser.close()
    assert not parser.open
    assert parser.count["table"] == 1
    assert parser.count["tr"] == 5
    assert parser.count.get("th", 0) + parser.count["td"] == 5 * 6
    html = html_of(V6.replace(name="<b>&").balance(1000))
    assert "<b>" not in html
    assert "&lt;b&gt;&amp;" in html


# --- tables of other libraries ------------------------------------------------------------------


def test_balance_in_long_form() -> None:
    import pandas as pd

    frame = balance().tidy().to_pandas()
    assert isinstance(frame, pd.DataFrame)
    assert frame.shape == (3 * (4 + 4 + 1 + 1), 7)
    assert set(frame.quantity) == {"force", "moment", "torque", "crank_torque"}
    y = frame[(frame.quantity == "moment") & (frame.component == "y")]
    assert list(y.order) == [1, 2, 6]
    np.testing.assert_array_equal(y.real + 1j * y.imag, balance().moment.y)
    assert "torque" not in balance(spectrum=SPECTRUM).tidy()["quantity"].values


def test_waveform_in_long_form() -> None:
    frame = waveform().tidy().to_pandas()
    assert list(frame.columns) == ["theta_deg", "quantity", "component", "value", "unit"]
    assert len(frame) == 6 * len(THETA)
    crank = frame[frame.quantity == "crank_torque"]
    np.testing.assert_array_equal(crank.value, waveform().crank_torque)
    assert len(waveform(orders=[1], spectrum=SPECTRUM).tidy()) == 4 * len(THETA)


def test_sweep_in_long_form() -> None:
    frame = sweep().tidy("force").to_pandas()
    assert list(frame.columns)[:4] == ["engine", "bank_angle_deg", "rpm", "order"]
    x = frame[frame.component == "x"].set_index(["engine", "bank_angle_deg", "rpm", "order"])
    assert x.peak["again", 75.0, 5000.0, 2] == sweep().force.peak_xy[1, 1, 1, 1, 0]
    torque = sweep().tidy("torque")
    np.testing.assert_array_equal(torque["peak"].values, sweep().torque.peak.ravel())
    assert len(cp.sweep(V6, rpm=5000, orders=[1]).tidy("torque")) == 1


UNITS = {"force": "N", "moment": "N m", "torque": "N m", "crank_torque": "N m"}
UNITS |= {"order": "1/rev", "bank_angle_deg": "degree", "theta_deg": "degree"}
UNITS |= {"rpm": "1/min", "rod_ratio": "1", "pin_offset": "m"}


def assert_units(dataset: xr.Dataset) -> None:
    for name, variable in dataset.variables.items():
        if name in {"axis", "engine"}:
            continue
        quantity = re.sub("_(total|peak|forward|backward|zero|bound|xy)(?=_|$)", "", str(name))
        assert variable.attrs["units"] == UNITS[quantity], name


def test_balance_to_xarray() -> None:
    dataset = balance().to_xarray()
    assert dataset["moment"].dims == ("order", "axis")
    assert dataset["torque"].dims == ("order",)
    assert dataset.attrs["rpm"] == 5000
    assert dataset.attrs["engine"] == "V6"
    assert dataset.attrs["reference_z"] == balance().reference_z == pytest.approx(0.13)
    assert dataset["force"].sel(order=6, axis="y").item() == balance().force.xy[2, 1]
    assert_units(dataset)
    assert "torque" not in balance(spectrum=SPECTRUM).to_xarray()


def test_waveform_to_xarray() -> None:
    dataset = waveform().to_xarray()
    assert dict(dataset.sizes) == {"theta_deg": len(THETA), "axis": 2}
    assert dataset["moment"].sel(axis="x", theta_deg=90.0).item() == waveform().moment[9, 0]
    assert_units(dataset)


def test_sweep_to_xarray() -> None:
    dataset = sweep().to_xarray("force", "moment", "torque")
    swept = ("engine", "bank_angle_deg", "rpm")
    assert dataset["moment"].dims == (*swept, "order", "axis") == sweep().moment.dims
    assert dataset["torque"].dims == (*swept, "order") == sweep().torque.dims
    assert dataset["moment_total_peak_xy"].dims == (*swept, "axis")
    assert dataset["torque_total_peak"].dims == swept
    assert list(dataset["engine"].values) == ["even", "again"]
    at = {"engine": "again", "bank_angle_deg": 90.0, "rpm": 3000.0, "order": 2, "axis": "y"}
    assert dataset["moment"].sel(at).item() == sweep().moment.xy[1, 2, 0, 1, 1]
    assert dataset.attrs["hold"] == "pins"
    assert_units(dataset)
    swept_rods = cp.sweep(V6, rpm=5000, rod_ratio=[0.2, 0.3], pin_offset=[0.0, 0.001])
    other = swept_rods.to_xarray()
    assert other["force"].dims == ("rod_ratio", "pin_offset", "order", "axis")
    assert other.attrs["rpm"] == 5000
    assert_units(other)


def test_shapes_of_a_sweep() -> None:
    s = sweep()
    assert s.force.shape == s.moment.shape == (2, 3, 2, 2, 2)
    assert s.torque.shape == s.torque.peak.shape == s.force.peak.shape == (2, 3, 2, 2)
    assert s.total.moment.peak_xy.shape == (2, 3, 2, 2)
    assert s.total.moment.peak.shape == s.total.torque.peak.shape == (2, 3, 2)
    assert cp.sweep(V6, rpm=5000, orders=1).force.shape == (1, 2)
    assert cp.sweep([V6], rpm=5000, orders=1).force.shape == (1, 1, 2)


# --- import, warnings, examples -----------------------------------------------------------------


def run(code: str) -> str:
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)  # noqa: S603
    return done.stdout.strip()


USE = """
import sys
import crankpin as cp
engine = cp.Engine.inline(cp.Cylinder(1, 2, 7), throws_deg=[0], spacing=1)
repr(engine.balance(10)), engine.balance(10)._repr_html_(), cp.sweep(engine, rpm=[1, 2]).moment
print(*{name.partition(".")[0] for name in sys.modules})
"""


def test_import_and_use_load_numpy_and_the_standard_library_alone() -> None:
    there = run('import sys, numpy; print(*{name.partition(".")[0] for name in sys.modules})')
    more = set(run(USE).split()) - set(there.split())
    assert more - sys.stdlib_module_names == {"crankpin"}
    # Which take longer than all of crankpin.
    assert not more & {"asyncio", "email", "http", "multiprocessing", "unittest", "xml"}


@pytest.mark.skipif(not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="Python has its lock")
def test_free_threaded_python_stays_without_its_lock() -> None:
    assert run("import sys, crankpin; print(sys._is_gil_enabled())") == "False"


def test_a_piston_faster_than_any_engines_warns_of_units() -> None:
    """Mean speed 4 r rpm/60: 60 m/s at r = 45 mm is 20000 rpm."""
    calls: list[Callable[[float], Any]] = [
        V6.balance,
        lambda rpm: V6.waveform(rpm, theta_deg=[0.0]),
        lambda rpm: cp.sweep(V6, rpm=[rpm, 10.0]),
        lambda rpm: cp.sweep([V6, V6], rpm=rpm),
    ]
    for call in calls:
        call(19_999.0)  # warnings are errors
        with pytest.warns(UserWarning, match="mean piston speed is 60 m/s.*millimetres"):
            call(20_100.0)


@pytest.mark.parametrize("method", ["balance", "waveform", "sweep"])
def test_the_warning_of_units_points_at_who_typed_them(method: str) -> None:
    millimetres = cp.Engine.inline(cp.Cylinder(4.5, 15.8, 1.487), throws_deg=[0], spacing=13)
    call = partial(cp.sweep, millimetres) if method == "sweep" else getattr(millimetres, method)
    with pytest.warns(UserWarning, match="millimetres") as caught:
        call(rpm=5000)
    assert [warning.filename for warning in caught] == [__file__]


def documented() -> dict[str, str]:
    """Docstrings with examples of everything public, by name."""
    found = {"crankpin": inspect.getdoc(cp) or ""}
    listed = {name: getattr(cp, name) for name in cp.__all__ if name != "results"}
    listed |= {name: getattr(cp.results, name) for name in cp.results.__all__}
    for name, value in listed.items():
        if isinstance(value, str) or value is cp.InputError:
            continue
        found[name] = inspect.getdoc(value) or ""
        if inspect.isclass(value):
            own = (each for each in dir(value) if not each.startswith("_"))
            found |= {f"{name}.{each}": inspect.getdoc(getattr(value, each)) or "" for each in own}
    return found


def is_of_numpy(name: str, text: str) -> bool:
    """Whether a docstring is that of the same method of NumPy's arrays, whose examples it has."""
    return inspect.getdoc(getattr(np.ndarray, name.rpartition(".")[2], None)) == text


EXAMPLES = {
    name: text
    for name, text in documented().items()
    if ">>>" in text and not is_of_numpy(name, text)
}


def test_every_public_object_is_documented_and_the_main_ones_by_example() -> None:
    bare = [name for name, text in documented().items() if not text]
    fields = {
        field
        for kind in (
            cp.Cycle,
            cp.CycleMap,
            cp.Traces,
            cp.Cylinder,
            cp.results.Balance,
            cp.results.OrderBalance,
            cp.results.Table,
            cp.results.MountDesign,
            cp.results.VelocityFeedback,
            cp.Actuator,
            cp.Mount,
            cp.Receptance,
            cp.RigidBody,
            cp.Rod,
            cp.Shaft,
            cp.Unbalance,
        )
        for field in kind.__annotations__
    }
    fields |= {"within", "progress", "order", "gas_map"}
    assert {name for name in bare if name.rpartition(".")[2] not in fields} == set()
    for name in ("Cylinder", "Engine", "Engine.vee", "Engine.balance", "sweep", "Sweep", "Balance"):
        assert name in EXAMPLES


@pytest.mark.slow
@in_turn("name", EXAMPLES)
def test_docstring_examples(name: str) -> None:
    report: list[str] = []
    test = doctest.DocTestParser().get_doctest(EXAMPLES[name], {}, name, None, None)
    result = doctest.DocTestRunner(verbose=False).run(test, out=report.append)
    assert result.attempted > 0
    assert result.failed == 0, "".join(report)
