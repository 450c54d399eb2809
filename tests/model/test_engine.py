"""Engines as data: throws, banks, firing orders, units, files, presets."""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import copy
import dataclasses
import itertools
import json
import math
import pickle
import warnings
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.sweeps.sweep import engine_titles
from crankpin.model import presets as presets_module
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

CYLINDER = cp.Cylinder(0.043, 0.145, 0.45)
I4 = cp.Engine.inline(
    CYLINDER, throws_deg=[0, 180, 180, 0], spacing=0.1, firing_order="1-3-4-2", name="four"
)
SEARCH = cp.search_arrangements(14, alternating=True)
TWO_STROKE = cp.Engine.from_firing_order(CYLINDER, "1-3-2", strokes=2, spacing=0.1)
FIRED = I4.replace(cylinder=CYLINDER.replace(bore=0.086)).with_cycle(cp.Cycle.example())
V6 = cp.Engine.vee(CYLINDER, bank_angle_deg=90, throws_deg=[0, 240, 120], spacing=0.1)


def vee(**changes: Any) -> cp.Engine:
    given: dict[str, Any] = {"bank_angle_deg": 90, "throws_deg": [0, 240, 120], "spacing": 0.1}
    return cp.Engine.vee(CYLINDER, **given | changes)


# --- banks and throws ---------------------------------------------------------------------------


def test_throws_and_pin_split_of_a_vee() -> None:
    engine = vee(pin_split_deg=-30, odd_bank="left", first_tdc_deg=77)
    assert engine.throws_deg.tolist() == [0.0, 240.0, 120.0]
    assert engine.pin_split_deg.tolist() == [-30.0] * 3
    assert engine.banks == {"right": (2, 4, 6), "left": (1, 3, 5)}
    assert vee(numbering="by-bank").banks == {"right": (1, 2, 3), "left": (4, 5, 6)}
    for array in (engine.throws_deg, engine.pin_split_deg):
        assert not array.flags.writeable


@pytest.mark.parametrize("split", [180, -180, 540])
def test_pin_split_is_above_minus_180_and_at_most_180(split: int) -> None:
    assert vee(bank_angle_deg=180, pin_split_deg=split).pin_split_deg.tolist() == [180.0] * 3


def test_throws_of_one_bank_are_those_of_its_cylinders_along_the_crank() -> None:
    assert I4.throws_deg.tolist() == [0.0, 180.0, 180.0, 0.0]
    backward = I4.replace(z=I4.z[::-1], pin_deg=[10, 20, 30, 40])
    assert backward.throws_deg.tolist() == [0.0, 350.0, 340.0, 330.0]
    assert backward.banks == {"bank 1": (1, 2, 3, 4)}


def test_errors_of_arguments_name_what_people_call() -> None:
    with pytest.raises(TypeError, match=r"^Engine\.vee\(\) got an unexpected keyword argument"):
        cp.Engine.vee(bank_angle=90)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^Engine\.replace\(\) takes 1 positional argument"):
        cp.Engine.preset("i4").replace(4)  # type: ignore[call-arg, arg-type]


def test_right_bank_is_the_core_s() -> None:
    """The bank that turns clockwise as the bank angle grows."""
    rng = np.random.default_rng(3)
    pairs = [tuple(pair) for pair in rng.integers(0, 24, (40, 2)) * 15.0 if pair[0] != pair[1]]
    for banks in [*pairs, (0.0, 180.0), (180.0, 0.0), (90.0, 270.0), (270.0, 90.0)]:
        engine = cp.Engine.from_lists(CYLINDER, tdc_deg=[0, 0], bank_deg=banks, z=[0, 0])
        ((right,), (left,)) = (engine.banks[name] for name in ("right", "left"))
        narrowed = engine.with_bank_angle(10, hold="pins")
        turn = (narrowed.bank_deg[left - 1] - narrowed.bank_deg[right - 1]) % 360.0
        assert turn == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("name", "engine", "needed"),
    [
        ("bank_angle_deg", I4, "it has one bank (90°); exactly two are needed"),
        ("pin_split_deg", I4, "it has one bank (90°); exactly two are needed"),
        ("throws_deg", cp.Engine.preset("w12"), "it has 4 banks (61.5°, 46.5°, 133.5°, 118.5°);"),
        ("firing_intervals_deg", V6, "its firing order is not known"),
        ("fires_evenly", V6, "its firing order is not known"),
        (
            "pin_split_deg",
            cp.Engine.from_lists(CYLINDER, tdc_deg=[0] * 3, bank_deg=[60, 60, 120], z=[0] * 3),
            "it has 2 cylinders in the right bank and 1 in the left",
        ),
    ],
)
def test_undefined_properties_are_absent_and_say_why(
    name: str, engine: cp.Engine, needed: str
) -> None:
    assert not hasattr(engine, name)
    with pytest.raises(cp.InputError) as caught:
        getattr(engine, name)
    assert str(caught.value).startswith(f"{name} is undefined for this engine: {needed}")
    assert isinstance(caught.value, AttributeError)


def test_bank_angle_of_one_bank_cannot_be_changed() -> None:
    with pytest.raises(cp.InputError, match=r"bank_angle_deg is undefined .* one bank"):
        I4.with_bank_angle(90, hold="pins")


# --- firing order -------------------------------------------------------------------------------


def test_the_firing_order_is_used_where_none_is_given() -> None:
    assert I4.firing() == I4.firing("1-3-4-2")
    assert I4.firing_schedules() == I4.firing_schedules("1-3-4-2")
    assert I4.fires_evenly
    assert I4.firing_intervals_deg.tolist() == [180.0] * 4
    assert not cp.Engine.preset("v6-90-odd-fire").fires_evenly
    with pytest.raises(cp.InputError, match=r"firing_order = None: .* is not known; give one"):
        V6.firing()
    with pytest.raises(cp.InputError, match="is that of a 4-stroke; give one"):
        I4.firing(strokes=2)


def test_the_firing_order_begins_with_cylinder_1() -> None:
    assert I4.replace(firing_order=[4, 2, 1, 3]) == I4
    assert I4.replace(firing_order=(k for k in (1, 3, 4, 2))) == I4
    made = cp.Engine.from_firing_order(CYLINDER, (k for k in (3, 4, 2, 1)), spacing=0.1)
    assert made.firing_order == "1-3-4-2"


@pytest.mark.parametrize(
    "build",
    [
        lambda spacing: cp.Engine.inline(CYLINDER, throws_deg=[0, 180], spacing=spacing),
        lambda spacing: vee(spacing=spacing),
        lambda spacing: cp.Engine.boxer(CYLINDER, throws_deg=[0, 180], spacing=spacing),
        lambda spacing: cp.Engine.from_firing_order(CYLINDER, "1-3-4-2", spacing=spacing),
        lambda spacing: cp.Engine.radial(CYLINDER, cylinders=14, rows=2, spacing=spacing),
        lambda spacing: SEARCH.at_bank_angle(9.13)[0].engine(CYLINDER, spacing=spacing),
    ],
)
def test_spacing_is_a_distance(build: Callable[[float], cp.Engine]) -> None:
    with pytest.raises(cp.InputError, match=r"spacing = -0.1: give a number that is zero or more"):
        build(-0.1)


def test_a_firing_order_that_the_crank_does_not_allow_is_rejected() -> None:
    with pytest.raises(cp.InputError, match="firing_order = 1-2-3-4"):
        I4.replace(firing_order="1-2-3-4")


def test_a_firing_order_is_dropped_where_a_changed_crank_does_not_allow_it() -> None:
    v6 = cp.Engine.preset("v6-120")
    assert v6.with_bank_angle(110, hold="pins").firing_order == v6.firing_order
    assert v6.with_bank_angle(0, hold="pins").firing_order == ""
    assert v6.with_bank_angle(60, hold="firing").firing_order == v6.firing_order
    assert I4.with_first_tdc(100).firing_order == I4.firing_order
    turned = TWO_STROKE.replace(pin_deg=-TWO_STROKE.pin_deg)
    assert (turned.firing_order, turned.strokes) == ("", 2)
    assert I4.replace(z=[0, 1, 2, 3]).firing_order == I4.firing_order


@pytest.mark.parametrize("engine", [I4, TWO_STROKE, cp.Engine.preset("w16")])
def test_equality_copies_and_files_carry_the_firing_order(
    engine: cp.Engine, tmp_path: Path
) -> None:
    without = engine.replace(firing_order="")
    assert without != engine
    engine.save(tmp_path / "engine.toml")
    engine.save(tmp_path / "engine.json")
    for back in (
        copy.copy(engine),
        pickle.loads(pickle.dumps(engine)),  # noqa: S301 - its own
        engine.replace(name="x").replace(name=engine.name),
        cp.Engine.from_toml(engine.to_toml()),
        cp.Engine.from_json(engine.to_json()),
        cp.Engine.load(tmp_path / "engine.toml"),
        cp.Engine.load(tmp_path / "engine.json"),
    ):
        assert back == engine
        assert hash(back) == hash(engine)
        assert (back.firing_order, back.strokes) == (engine.firing_order, engine.strokes)
    assert TWO_STROKE.firing().strokes == 2


def test_a_file_may_have_the_firing_order_anywhere_above_its_tables() -> None:
    text = I4.to_toml()
    moved = text.replace('firing_order = "1-3-4-2"\n', "")
    moved = moved.replace("\n[cylinder]", 'firing_order="1-3-4-2" # known\n\n[cylinder]')
    assert moved != text
    assert cp.Engine.from_toml(moved) == I4


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("firing_order", 7, "integer `7`, expected a string"),
        ("firing_order", "1-2-3-4", "firing_order = 1-2-3-4"),
        ("strokes", 3, "strokes = 3"),
        ("strokes", "2", 'string "2", expected'),
    ],
)
def test_a_file_with_a_wrong_firing_order_is_rejected(key: str, value: Any, words: str) -> None:
    document = json.loads(I4.to_json()) | {key: value}
    with pytest.raises(cp.InputError, match=words):
        cp.Engine.from_json(json.dumps(document))
    line = f"{key} = {json.dumps(value)}"
    text = I4.to_toml().replace('firing_order = "1-3-4-2"', line)
    assert line in text
    with pytest.raises(cp.InputError, match=words):
        cp.Engine.from_toml(text)


@pytest.mark.parametrize(
    "name", ['firing_order = "1-2"', 'a\nfiring_order = "1-3-4-2"\nb', '"firing_order": "1",']
)
def test_a_name_that_looks_like_a_firing_order_is_a_name(name: str) -> None:
    for engine in (I4.replace(name=name), I4.replace(name=name, firing_order="")):
        assert cp.Engine.from_toml(engine.to_toml()) == engine
        assert cp.Engine.from_json(engine.to_json()) == engine


# --- rotating mass ------------------------------------------------------------------------------


@pytest.mark.parametrize("mass", [0.8, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])
def test_rotating_mass_means_the_same_to_every_builder_and_to_replace(mass: Any) -> None:
    made = (
        vee(rotating_mass=mass),
        cp.Engine.flat(CYLINDER, throws_deg=[0, 120, 240], spacing=0.1, rotating_mass=mass),
        cp.Engine.boxer(CYLINDER, throws_deg=[0, 120, 240], spacing=0.1, rotating_mass=mass),
        cp.Engine.inline(CYLINDER, throws_deg=[0] * 6, spacing=0.1, rotating_mass=mass),
        cp.Engine.from_firing_order(CYLINDER, "1-5-3-6-2-4", spacing=0.1, rotating_mass=mass),
        cp.Engine.from_firing_order(
            CYLINDER,
            "1-2-3-4-5-6",
            bank_angle_deg=60,
            shared_pins=False,
            spacing=0.1,
            rotating_mass=mass,
        ),
    )
    for engine in made:
        assert engine.rotating_mass.tolist() == np.broadcast_to(mass, 6).tolist()
        assert engine.replace(rotating_mass=mass) == engine
        assert engine.replace(rotating_mass=0).replace(rotating_mass=mass) == engine


ROD = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
WITH_ROD = cp.Cylinder.from_rod(ROD, crank_radius=0.045, piston_mass=0.4, bore=0.09)
BIG_END = ROD.rotating_mass
TWO: dict[str, Any] = {"throws_deg": [0, 180], "spacing": 0.1}


@pytest.mark.parametrize(
    "build",
    [
        lambda c, **mass: cp.Engine.inline(c, **TWO, **mass),
        lambda c, **mass: cp.Engine.vee(c, bank_angle_deg=60, **TWO, **mass),
        lambda c, **mass: cp.Engine.flat(c, **TWO, **mass),
        lambda c, **mass: cp.Engine.boxer(c, **TWO, **mass),
        lambda c, **mass: cp.Engine.radial(c, 5, **mass),
        lambda c, **mass: cp.Engine.from_firing_order(c, "1-3-4-2", spacing=0.1, **mass),
        lambda c, **mass: cp.Engine.from_lists(
            [c, c], tdc_deg=[0, 90], bank_deg=[90, 90], z=[0, 1], **mass
        ),
        lambda c, **mass: cp.Engine.preset("vr6", cylinder=c, **mass),
        lambda c, **mass: cp.Engine.preset("i4-ebook", cylinder=c, **mass),
    ],
)  # fmt: skip
def test_the_big_end_of_a_rod_turns_unless_it_is_left_out_by_name(build: Any) -> None:
    engine = build(WITH_ROD)
    assert engine.rotating_mass.tolist() == [BIG_END] * len(engine)
    assert build(WITH_ROD, rotating_mass=BIG_END) == engine
    assert build(WITH_ROD, rotating_mass=0).rotating_mass.tolist() == [0.0] * len(engine)
    assert build(WITH_ROD, rotating_mass=0.7).rotating_mass.tolist() == [0.7] * len(engine)
    for each in (engine, build(WITH_ROD, rotating_mass=0)):
        assert cp.Engine.from_toml(each.to_toml()) == each
        assert cp.Engine.from_json(each.to_json()) == each
    # A file written by hand has no other meaning than a builder.
    text = "".join(
        line for line in engine.to_toml().splitlines(True) if "rotating_mass" not in line
    )
    assert cp.Engine.from_toml(text) == engine


def test_a_changed_rod_brings_its_big_end_where_the_last_one_had() -> None:
    heavier = WITH_ROD.replace(rod=dataclasses.replace(ROD, mass=0.9))
    heavy = heavier.rod.rotating_mass  # type: ignore[union-attr]
    plain = cp.Cylinder(0.045, 0.15, 0.6)
    engine = cp.Engine.inline(WITH_ROD, **TWO)
    assert engine.replace(cylinder=heavier).rotating_mass.tolist() == [heavy] * 2
    assert engine.replace(cylinder=[WITH_ROD, heavier]).rotating_mass.tolist() == [BIG_END, heavy]
    assert cp.Engine.inline(plain, **TWO).replace(cylinder=heavier) == cp.Engine.inline(
        heavier, **TWO
    )
    # A rod that is not known any more has taken nothing away, and what was given by name stays.
    assert engine.replace(cylinder=plain).rotating_mass.tolist() == [BIG_END] * 2
    for mass in (0.0, 0.7):
        kept = engine.replace(rotating_mass=mass).replace(cylinder=heavier)
        assert kept.rotating_mass.tolist() == [mass] * 2


def test_searches_and_designs_build_engines_with_the_whole_cylinder() -> None:
    arrangement = cp.search_arrangements(cylinders=6)[0].engine(WITH_ROD, spacing=0.1)
    assert set(arrangement.cylinders) == {WITH_ROD}
    assert arrangement.rotating_mass.tolist() == [BIG_END] * 6
    question: Any = {"layout": "inline", "cylinder": WITH_ROD, "spacing": 0.1, "rpm": 3000}
    question |= {"by": "total.moment.peak", "count": 1}
    assert cp.design(3, **question)[0].engine.rotating_mass.tolist() == [BIG_END] * 3
    assert not cp.design(3, **question, rotating_mass=0)[0].engine.rotating_mass.any()


# --- tables -------------------------------------------------------------------------------------


def test_an_engine_is_shown_as_a_table() -> None:
    title, parts, throws, firing, head, *rows = repr(cp.Engine.preset("v6-90")).splitlines()
    assert title == "V6 90°, split pins: 6 cylinders, bank angle 90°"
    assert parts == "stroke 0.086 m, rod 0.145 m, reciprocating mass 0.45 kg"
    assert throws == "throws 0-240-120°, pins split by -30°"
    assert firing == "4-stroke 1-6-5-4-3-2, even, 120°"
    assert head.split()[:2] == ["cylinder", "bank"]
    assert [row.split()[:3] for row in rows[:2]] == [["1", "left", "135"], ["2", "right", "45"]]
    assert len(rows) == 6
    html = I4.replace(name="<b>")._repr_html_()
    assert "&lt;b&gt;: 4 cylinders, bores at 90°; stroke 0.086 m, rod" in html
    assert "; throws 0-180-180-0°; 4-stroke 1-3-4-2" in html
    stepped = I4.replace(cylinder=[CYLINDER.replace(rod_length=0.14 + k / 100) for k in range(4)])
    assert "rod 0.14 to 0.17 m" in repr(stepped)


def test_a_table_of_many_cylinders_is_cut() -> None:
    engine = cp.Engine.inline(CYLINDER, throws_deg=range(1000), spacing=0.1, name="a\n" * 90)
    assert repr(engine).endswith("\n30 of 1000 rows")
    assert len(repr(engine)) < 2000
    assert repr(engine).count("\n") == 34


# --- names ---------------------------------------------------------------------------------------


def test_names_follow_the_engine_s_own_figures() -> None:
    v6 = cp.Engine.preset("v6-60")
    assert v6.name == "V6 60°, split pins"
    assert v6.with_bank_angle(90, hold="pins").name == "V6 90°, split pins"
    assert v6.with_bank_angle(120, hold="firing").name == "V6 120°, shared pins"
    assert v6.with_bank_angle("72.5", hold="pins").name == "V6 72.5°, split pins"
    for twin in (
        cp.Engine.from_toml(v6.to_toml()),
        pickle.loads(pickle.dumps(v6)),  # noqa: S301 - its own
        v6.replace(z=v6.z),
    ):
        assert twin.with_bank_angle(90, hold="pins").name == "V6 90°, split pins"
    named = vee(name="my {bank_angle}° engine")
    assert (named.name, named.replace(bank_deg=[90] * 6).name) == ("my 90° engine", "my –° engine")
    assert v6.replace(name=v6.name) == v6
    literal = v6.replace(name=v6.name).with_bank_angle(90, hold="pins")
    assert literal.name == v6.name  # what its user typed
    assert cp.Engine.preset("w16").name == "W16 90°"


def test_titles_name_the_hardware_that_is_fitted() -> None:
    v6 = cp.Engine.preset("v6-60")
    weight = cp.Unbalance(0.01, 0)
    fitted = v6.with_shafts([cp.Shaft(-1, [weight])])
    assert (fitted.name, fitted.title) == (v6.name, "V6 60°, split pins with 1 balance shaft")
    both = fitted.with_counterweights([weight, weight])
    assert both.title == "V6 60°, split pins with 2 counterweights and 1 balance shaft"
    assert I4.replace(name="").title == "4 cylinders"
    ranking = cp.rank([v6, fitted], rpm=6000, by="total.moment.peak")
    assert {choice.name for choice in ranking} == {v6.title, fitted.title}
    twins = cp.sweep([v6, v6], rpm=6000)
    assert list(twins.coords["engine"]) == ["V6 60°, split pins (1)", "V6 60°, split pins (2)"]


def test_a_swept_bank_angle_is_in_no_title() -> None:
    v6, v8 = cp.Engine.preset("v6-60"), cp.Engine.preset("v8-crossplane")
    swept = cp.sweep([v6, v8], rpm=6000, bank_angle_deg=[60, 90], hold="pins")
    assert engine_titles(swept) == ["V6, split pins", "V8, cross-plane"]
    plain = v6.replace(name="V6 60° of a drawing")
    swept = cp.sweep([plain, v8], rpm=6000, bank_angle_deg=[60, 90], hold="pins")
    assert engine_titles(swept) == ["V6 60° of a drawing", "V8, cross-plane"]


# --- mistakes -----------------------------------------------------------------------------------

MISTAKES: dict[str, tuple[Callable[[], Any], str]] = {
    "all lengths in mm": (
        lambda: cp.Engine.inline(cp.Cylinder(43, 145, 0.45), throws_deg=[0], spacing=100),
        "crank_radius = 43 m: was it given in millimetres",
    ),
    "spacing in mm": (
        lambda: vee(spacing=100),
        r"bank_stagger. = 100 m apart at a crank radius of 0\.043 m: was it given in millimetres",
    ),
    "z in mm": (lambda: I4.replace(z=[0, 100, 200, 300]), "= 100 m apart"),
    "stagger in mm": (lambda: vee(bank_stagger=20), "bank_stagger. = 19.* m apart"),
    "rod in mm": (
        lambda: cp.Engine.inline(cp.Cylinder(0.043, 158, 0.5), throws_deg=[0], spacing=0.1),
        "^rod_length = 158 m at a crank radius of 0.043 m: was it given in millimetres",
    ),
    "bore in mm": (
        lambda: cp.Cylinder.from_bore_stroke(
            bore=86, stroke=0.086, rod_length=0.145, reciprocating_mass=0.5
        ),
        "^bore = 86 m and stroke = 0.086 m: are both in metres",
    ),
    "shaft in mm": (
        lambda: I4.with_shafts([cp.Shaft(2, [cp.Unbalance(0.003, 0.15)], x=80)]),
        "^x = 80 m at a crank radius of 0.043 m: was it given in millimetres",
    ),
    "weight in mm": (lambda: I4.with_counterweights([cp.Unbalance(0.003, z=150)]), "^z = 150 m at"),
    "weight in g·mm": (
        lambda: I4.with_counterweights([cp.Unbalance(8000, z=0.1)]),
        "^amount = 8000 kg·m: was it given in g·mm or g·m",
    ),
    "weight in g·mm, alone": (lambda: cp.Unbalance(8000, z=0), "^amount = 8000 kg·m: was it"),
    "rod in mm, alone": (lambda: cp.Cylinder(0.043, 158, 0.5), "^rod_length = 158 m"),
    "cylinder in mm, alone": (
        lambda: cp.Cylinder.from_bore_stroke(
            bore=86, stroke=86, rod_length=145, reciprocating_mass=0.5
        ),
        "^crank_radius = 43 m: was it given in millimetres",
    ),
    "shaft's weight in g·mm": (
        lambda: I4.with_shafts([cp.Shaft(2, [cp.Unbalance(3100, 0.15)])]),
        "^amount = 3100 kg·m",
    ),
    "a point in mm": (lambda: I4.balance(3000).about(150), "^point = 150 m at a crank radius of"),
    "a point beside the crank in mm": (
        lambda: cp.sweep(I4, rpm=3000).about((0, 80, 0.15)),
        "^point = 80 m at",
    ),
    "the plane of proofs in mm": (
        lambda: I4.vanishing_orders(reference_z=150),
        "^reference_z = 150 m",
    ),
    "that of closed forms": (lambda: I4.closed_form(2, reference_z=150), "^reference_z = 150 m"),
    "a bound in g·mm": (
        lambda: cp.counterweights(I4, planes="ends", bound={"rear": 20_000}),
        r"^bound = 20000 kg·m at a crank radius of 0.043 m: was it given in g·mm or g·m",
    ),
    "a length in mm": (
        lambda: cp.counterweights(I4, planes="ends", length=300),
        "^length = 300 m at a crank radius of 0.043 m: was it given in millimetres",
    ),
    "a flywheel in kg·cm²": (
        lambda: cp.flywheel(FIRED, 3000, inertia=1500),
        "^inertia = 1500 kg·m² at a crank radius of 0.043 m: was it given in kg·cm²",
    ),
    "planes in mm": (lambda: cp.counterweights(I4, planes=[0, 300]), "^planes = 300 m"),
    "an axis in mm": (lambda: cp.balance_shafts(I4, [2, -2], x=[80, -80]), "^x = 80 m"),
    "planes of a shaft in mm": (
        lambda: cp.balance_shafts(I4, [2, -2], planes=[0, 300]),
        "^planes = 300 m",
    ),
    "bearings of a shaft in mm": (
        lambda: cp.balance_shafts(I4, -2, bearings=[0, 300]),
        "^bearings = 300 m",
    ),
    "crankcase in bar": (
        lambda: I4.replace(cylinder=CYLINDER.replace(bore=0.086)).with_cycle(
            cp.Cycle.example(), crankcase=1.01
        ),
        "^crankcase = 1.01 Pa: was it given in bar",
    ),
    "oil in g": (lambda: cp.bob_weight(I4, oil=4), "^oil = 4 kg .*: was it given in grams"),
    "pistons in g": (
        lambda: cp.match_parts(I4, [402, 398, 405, 401]),
        "^pistons = 405 kg at a crank radius of 0.043 m: was it given in grams",
    ),
    "grams": (
        lambda: cp.Engine.inline(
            CYLINDER.replace(reciprocating_mass=450), throws_deg=[0], spacing=0.1
        ),
        "^reciprocating_mass = 450 kg .* was it given in grams",
    ),
    "rotating grams": (lambda: vee(rotating_mass=300), "^rotating_mass = 300 kg"),
    "throws in radians": (
        lambda: vee(throws_deg=[0.0, 2.0944, 4.18879]),
        r"throws_deg = \[0\.0, 2\.0944, 4\.18879\]: was it given in radians.* 120°, 240°",
    ),
    "bank angle in radians": (lambda: vee(bank_angle_deg=math.pi / 3), "bank_angle_deg = 1.0472?"),
    "a bank angle changed in radians": (
        lambda: V6.with_bank_angle(math.pi / 3, hold="pins"),
        "^bank_angle_deg = 1.0471.* degrees here: 60°",
    ),
    "swept in radians": (
        lambda: cp.sweep(V6, rpm=3000, bank_angle_deg=np.radians(range(1, 181)), hold="pins"),
        "^bank_angle_deg = .* degrees here: 180°",
    ),
    "designed in radians": (
        lambda: cp.design(
            2,
            layout="vee",
            cylinder=CYLINDER,
            bank_angle_deg=(0.0, math.pi / 2),
            spacing=0.1,
            rpm=3000,
            by="total.moment.peak",
        ),
        "^bank_angle_deg = .* degrees here: 90°",
    ),
    "directions in radians in a file": (
        lambda: cp.Engine.from_toml(
            V6.to_toml()
            .replace("bank_deg = 45.0", "bank_deg = 0.7854")
            .replace("bank_deg = 135.0", "bank_deg = 2.3562")
        ),
        r"^bank_deg = \[0.7854, 2.3562, .*: was it given in radians",
    ),
    "a bore in millimetres in a file": (
        lambda: cp.Engine.from_toml(
            cp.Engine.preset("i4", cylinder=CYLINDER.replace(bore=0.086))
            .to_toml()
            .replace("bore = 0.086", "bore = 86")
        ),
        "^bore = 86 m and stroke = ",
    ),
    "in three decimals": (
        lambda: vee(bank_angle_deg=0.785),
        "^bank_angle_deg = 0.785: .* 44.9772°",
    ),
    "crank angles in radians": (
        lambda: I4.waveform(3000, theta_deg=np.linspace(0, 4 * math.pi, 721)),
        "^theta_deg ends at 12.5664: was it given in radians",
    ),
    "and without their end": (
        lambda: cp.sweep(I4, rpm=3000).waveform(np.radians(np.arange(360))),
        "^theta_deg ends at 6.26573: was it given in radians",
    ),
    "of bearings": (
        lambda: cp.bearing_loads(I4, 3000, theta_deg=[0, math.pi, 2 * math.pi]),
        "^theta_deg ends at 6.28319",
    ),
    "link rods in millimetres": (
        lambda: vee(rods=cp.LinkRods(0.03, 115)),
        "^length = 115 m at a crank radius of .* millimetres",
    ),
    "their big ends in grams": (
        lambda: vee(rods=cp.LinkRods(0.03, big_end_mass=400)),
        "^big_end_mass = 400 kg at a crank radius of .* grams",
    ),
    "sevenths of a turn cut off": (
        lambda: I4.replace(tdc_deg=[0, 51.428571, 180, 180]),
        r"^tdc_deg = .*: 51\.428571 is 4\.3e-7° from 360/7; if that is meant, give it as text",
    ),
    "tdc in radians": (lambda: I4.replace(tdc_deg=np.radians([0, 180, 180, 0])), "tdc_deg"),
    "a small-block with cylinder 1 right": (
        lambda: cp.Engine.from_firing_order(
            CYLINDER, "1-8-4-3-6-5-7-2", bank_angle_deg=90, spacing=0.11
        ),
        'odd_bank = "right": .* split by 180°; with odd_bank="left" pins are shared',
    ),
    "its throws": (
        lambda: cp.throws("1-8-4-3-6-5-7-2", bank_angle_deg=90),
        '^odd_bank = "right": .* with odd_bank="left" pins are shared',
    ),
    "throws of a 90° V6": (
        lambda: cp.throws("1-6-5-4-3-2", bank_angle_deg=90),
        'split by 150°; with odd_bank="left" pins are split by 30°',
    ),
    "split to the wrong side": (
        lambda: vee(pin_split_deg=30, odd_bank="left"),
        "pin_split_deg = 30: .* unevenly; with pin_split_deg = -30 it would fire evenly",
    ),
}


@in_turn("name", MISTAKES)
def test_likely_mistakes_are_warned_of_once_by_name(name: str) -> None:
    call, words = MISTAKES[name]
    with pytest.warns(UserWarning, match=words) as caught:
        call()
    assert [warning.filename for warning in caught] == [__file__]


SOUND: dict[str, Callable[[], Any]] = {
    "a small-block": lambda: cp.Engine.from_firing_order(
        CYLINDER, "1-8-4-3-6-5-7-2", bank_angle_deg=90, odd_bank="left", spacing=0.11
    ),
    "a 60° V6 whose pins are split less this way": lambda: cp.throws(
        "1-2-3-4-5-6", bank_angle_deg=60
    ),
    "large two-stroke": lambda: cp.Engine.inline(  # RT-flex96C
        cp.Cylinder(1.25, 2.5, 15_000), throws_deg=range(0, 360, 30), spacing=1.67
    ),
    "largest stroke": lambda: cp.Engine.inline(
        cp.Cylinder(1.73, 3.5, 20_000), throws_deg=[0, 120, 240], spacing=1.7, rotating_mass=9_000
    ),
    "Formula 1": lambda: cp.Engine.vee(
        cp.Cylinder(0.0199, 0.102, 0.35),
        bank_angle_deg=90,
        throws_deg=[0, 90, 270, 180],
        spacing=0.11,
        rotating_mass=0.25,
    ),
    "rod without end": lambda: cp.Engine.inline(
        cp.Cylinder(0.043, 1e6, 0.4), throws_deg=[0], spacing=0.1
    ),
    "8/41 of a turn within rounding": lambda: I4.replace(tdc_deg=[0, 70.2439024390244, 90, 90]),
    "a shaft two metres beside": lambda: I4.with_shafts(
        [cp.Shaft(1, [cp.Unbalance(0.5, 1.2)], x=2.0)]
    ),
    "model": lambda: cp.Engine.inline(cp.Cylinder(0.005, 0.02, 0.002), throws_deg=[0], spacing=0.1),
    "small angles": lambda: vee(bank_angle_deg=5, throws_deg=[0, 1.5, 3], pin_split_deg=-2.25),
    "sevenths of a turn cut off, as text": lambda: I4.replace(tdc_deg=[0, "51.428571", 90, 90]),
    "exact small angles": lambda: vee(bank_angle_deg="1.0472"),
    "even by its split": lambda: vee(pin_split_deg=-30),
    "even by the other split of a 60° V6": lambda: vee(bank_angle_deg=60, pin_split_deg=60),
    "uneven either way": lambda: vee(bank_angle_deg=80, pin_split_deg=10),
    "one place": lambda: I4.replace(z=[0, 0, 0, 0]),
}


@pytest.mark.parametrize("name", SOUND)
def test_sound_figures_are_not_warned_of(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SOUND[name]()


def test_presets_are_not_warned_of_and_alike_builders_name_their_own_arguments() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in cp.presets():
            cp.Engine.preset(name)
    for builder in (cp.Engine.flat, cp.Engine.boxer):
        with pytest.raises(TypeError, match=rf"{builder.__name__}\(\).*'stagger'"):
            builder(CYLINDER, throws_deg=[0], spacing=0.1, stagger=0)  # type: ignore[call-arg]


# --- arguments of all kinds ---------------------------------------------------------------------


@pytest.mark.parametrize(
    "call",
    [
        lambda bad: vee(name=bad),
        lambda bad: vee(source=bad),
        cp.Engine.from_toml,
        cp.Engine.from_json,
    ],
)
@pytest.mark.parametrize("bad", [np.array(["a", "b"]), None, b"text", 7, "\ud800", [""]])
def test_texts_that_are_none_are_rejected_by_name(call: Callable[[Any], Any], bad: Any) -> None:
    with pytest.raises(cp.InputError, match=r"^(name|source|text) = "):
        call(bad)


@pytest.mark.parametrize("path", [None, 7, b"\xff.toml", ["engine.toml"], "x" * 10**6])
def test_paths_that_are_none_are_rejected_in_few_words(path: Any) -> None:
    for call in (cp.Engine.load, I4.save):
        with pytest.raises(cp.InputError, match=r"^path = ") as caught:
            call(path)
        assert len(str(caught.value)) < 300


def test_byte_order_marks_are_ignored(tmp_path: Path) -> None:
    for suffix, text in ((".toml", I4.to_toml()), (".json", I4.to_json())):
        file = tmp_path / f"engine{suffix}"
        file.write_text(text, encoding="utf-8-sig")
        assert cp.Engine.load(file) == I4
    assert cp.Engine.from_json("\ufeff" + I4.to_json()) == I4
    assert cp.Engine.from_toml("\ufeff" + I4.to_toml()) == I4


def test_misaligned_arrays_are_taken() -> None:
    data = bytearray(8 * 4 + 1)
    z = np.frombuffer(data, dtype=np.float64, offset=1)
    z[:] = [0.0, 0.1, 0.2, 0.3]
    assert not z.flags.aligned
    assert I4.replace(z=z).z.tolist() == [0.0, 0.1, 0.2, 0.3]
    assert CYLINDER.position(z).shape == (4,)


LONG = "x" * 10**6


@pytest.mark.parametrize(
    "call",
    [
        lambda: vee(spacing=LONG),
        lambda: vee(throws_deg=[LONG]),
        lambda: vee(numbering=LONG),
        lambda: vee(rotating_mass=[LONG]),
        lambda: vee(firing_order=LONG),
        lambda: I4.replace(z=[LONG] * 4),
        lambda: I4.replace(name=LONG),
        lambda: I4.firing("1-" * 10**6),
        lambda: cp.Engine.preset(LONG),
        lambda: cp.Engine.from_toml(LONG),
        lambda: cp.Engine.from_json(f'{{"{LONG[: 10**5]}": 1}}'),
        lambda: cp.Cylinder(LONG, 1, 1),  # type: ignore[arg-type]
        lambda: cp.throws(LONG),
    ],
)
def test_messages_are_short_whatever_is_given(call: Callable[[], Any]) -> None:
    with pytest.raises(cp.InputError) as caught:
        call()
    assert len(str(caught.value)) < 500
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("values", [range(10**12), range(10**30), itertools.repeat(0.0)])
def test_what_has_no_end_is_rejected_at_once(values: Any) -> None:
    for call in (
        lambda: I4.replace(z=values),
        lambda: vee(throws_deg=values),
        lambda: vee(rotating_mass=values),
        lambda: vee(firing_order=values),
        lambda: CYLINDER.position(values),
    ):
        with pytest.raises(cp.InputError):
            call()


def test_a_file_says_which_cylinder_cannot_turn() -> None:
    parts = [CYLINDER, CYLINDER.replace(rod_length=0.2), CYLINDER, CYLINDER]
    text = I4.replace(cylinder=parts).to_json().replace("0.2", "0.02", 1)
    with pytest.raises(cp.InputError, match=r"^placements\[1\]\.cylinder\.crank_radius = 0\.043"):
        cp.Engine.from_json(text)
    with pytest.raises(cp.InputError, match=r"^cylinder\.crank_radius = 0\.043.* cannot turn"):
        cp.Engine.from_toml(I4.to_toml().replace("0.145", "0.02"))


# --- presets ------------------------------------------------------------------------------------


def test_presets_are_a_mapping_to_engines() -> None:
    presets = cp.presets()
    assert len(presets) == len(list(presets)) > 40
    assert presets["i4"] == cp.Engine.preset("i4")
    assert presets.get("nothing") is None
    assert "v8-crossplane" in presets
    assert 8 not in presets  # type: ignore[comparison-overlap]
    with pytest.raises(KeyError):
        presets["v8-crosplane"]
    with pytest.raises(cp.InputError, match=r'^name = "v8-crosplane": .* "v8-crossplane"'):
        presets["v8-crosplane"]


def test_presets_are_shown_as_a_table() -> None:
    head, *rows = repr(cp.presets()).splitlines()[1:]
    assert head.split() == ["name", "cylinders", "bank", "angle", "°", "firing", "order", "source"]
    assert [row.split()[0] for row in rows] == list(cp.presets())
    (v8,) = (row for row in rows if row.startswith("v8-crossplane "))
    assert v8.split()[1:4] == ["8", "90", "1-8-4-3-6-5-7-2"]
    html = cp.presets()._repr_html_()
    for engine in cp.presets().values():
        assert engine.source.split('"')[0] in html


@pytest.mark.parametrize(
    ("name", "meant", "call", "command"),
    [
        ("inline-4", '"i4"', "", ""),
        ("Straight-six", '"i6"', "", ""),
        ("v8-cross-plane", '"v8-crossplane"', "", ""),
        ("triple", '"i3"', "", ""),
        ("v10", '"v10-72" or "v10-90" or "v10-90-even"', "", ""),
        (
            "boxer-5",
            '"boxer-2" or "boxer-4" or "boxer-6"',
            "Engine.boxer(…, throws_deg=[…])",
            "crankpin new boxer --throws …",
        ),
        (
            "v10-80",
            '"v10-72" or "v10-90" or "v10-90-even"',
            "Engine.vee(…, bank_angle_deg=80, …)",
            "crankpin new v10 --bank-angle 80",
        ),
        ("i7", None, "Engine.inline(…, throws_deg=[…])", "crankpin new inline --throws …"),
        (
            "v3",
            None,
            "Engine.vee(…, bank_angle_deg=…, absent=[…])",
            "crankpin new vee --bank-angle … --throws … --absent …",
        ),
        ("w18", '"w8"', "Engine.from_lists(…)", "crankpin new lists --tdc … --banks … --z …"),
        ("rotary", None, "", ""),
    ],
)
def test_unknown_presets_suggest_near_names_and_what_builds_them(
    name: str, meant: str | None, call: str, command: str
) -> None:
    with pytest.raises(cp.InputError) as caught:
        cp.Engine.preset(name)
    hint = f"did you mean {meant}? " if meant else ""
    built = f"build it by {call}; " if call else ""
    alone = not (meant or call)
    built = "Engine.inline, vee and the like make engines of your own; " if alone else built
    expected = f'name = "{name}": no such preset; {hint}{built}crankpin.presets() lists all'
    assert str(caught.value) == expected
    built = f"build it by {command}; " if command else ""
    built = "crankpin new makes engines of your own; " if alone else built
    assert presets_module.unknown("NAME", name, typed=True).hint == (
        f'no such preset; {hint}{built}"crankpin presets" lists all; engine files end in '
        ".toml or .json"
    )


@pytest.mark.parametrize(
    ("name", "builder"),
    [("u16", "u"), ("H-24", "h"), ("square four", "square_four"), ("opposed-6", "opposed_pistons")],
)
def test_engines_of_two_crankshafts_have_builders(name: str, builder: str) -> None:
    with pytest.raises(cp.InputError, match=rf"build it by Engine.{builder}\("):
        cp.Engine.preset(name)


def test_presets_of_a_family_have_comparable_parts() -> None:
    assert presets_module.family("v6") == ["v6-60", "v6-90", "v6-90-odd-fire", "v6-120"]
    assert presets_module.family("v6-60") == ["v6-60"]
    assert presets_module.family("v6-60-ebook") == ["v6-60-ebook"]


def test_presets_that_fire_take_the_example_of_a_cycle() -> None:
    # The e-book's have moving parts of no scale, without a bore.
    fired = {
        name: engine
        for name, engine in cp.presets().items()
        if engine.firing_order and not name.endswith("-ebook")
    }
    assert len(fired) > 20
    for name, engine in fired.items():
        cycle = cp.Cycle.example(strokes=engine.strokes)
        rpm = presets_module.usual_speed(name, 3000)
        balance = engine.with_cycle(cycle).balance(rpm, orders=[0.5])
        assert balance.crank_torque.cycle_mean > 0


def test_presets_whose_firing_order_is_known_fire_in_it() -> None:
    for name, engine in cp.presets().items():
        if engine.firing_order:
            assert engine.firing().engine == engine, name
    assert sum(bool(engine.firing_order) for engine in cp.presets().values()) >= 30


def test_rows_of_vr_and_w_engines_follow_from_their_offset() -> None:
    """Right rows are at TDC 2 asin(|e|/(l + r)) after they fire, left rows as they fire."""
    for name in ("vr6", "w12", "w16"):
        engine = cp.Engine.preset(name)
        order = [int(number) for number in engine.firing_order.split("-")]
        for number, part in enumerate(engine.cylinders, start=1):
            reach = part.rod_length + part.crank_radius
            late = 2.0 * math.degrees(math.asin(max(-part.pin_offset, 0.0) / reach))
            fires = Fraction(720 * order.index(number), len(order))
            expected = (float(fires) + late) % 360.0
            assert engine.tdc_deg[number - 1] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("field", ["cycle", "mains", "reference_z"])
def test_no_word_stands_for_what_is_not_replaced(field: str) -> None:
    engine = cp.Engine.preset("i4")
    with pytest.raises(cp.InputError, match=field):
        engine.replace(**{field: "kept"})  # type: ignore[arg-type]
    assert engine.replace(**{field: ...}) == engine  # type: ignore[arg-type]
