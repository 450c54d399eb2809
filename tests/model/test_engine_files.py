"""Does the schema describe the engine files that are written and read, in its words?"""

from __future__ import annotations

import inspect
import json
import re
import tomllib
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.parameters import parameter
from crankpin.model import computed_cycles, engine_files
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

SCHEMA = engine_files.schema()
ROD = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
PISTON_AND_ROD = cp.Cylinder.from_rod(ROD, crank_radius=0.045, piston_mass=0.4, bore=0.088)
EVERYTHING = (
    cp.Engine.vee(
        PISTON_AND_ROD, bank_angle_deg=60, throws_deg=[0, "360/7"], spacing=0.1, rotating_mass=0.4,
        firing_order="1-2-3-4", name="Whole {bank_angle}", source="a # and a [table]",
    )
    .with_counterweights([cp.Unbalance(0.01, z=0, angle_deg="180/7", pin=1), cp.Unbalance(0, 0.1)])
    .with_shafts([cp.Shaft(-1, [cp.Unbalance(0.01, z=0.1)], x=0.1, name="balancer")])
    .replace(mains=[-0.05, 0.05, 0.15], reference_z=0.02)
    .with_cycle([cp.Cycle.example(), None, cp.Cycle(range(0, 720, 90), [2e5] * 8), None],
                crank_end=[None, cp.Cycle(range(0, 720, 90), [3e5] * 8), None, None],
                rod_diameter=0.01, crankcase=1e5)
)  # fmt: skip
TWO_CRANKS = """
schema = 1
cranks = [{ x = 0.2, y = 0, ratio = -1 }]
placements = [
  { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 0, bank_deg = 90, z = 0, crank = 1 },
]
cylinder = { crank_radius = 0.05, rod_length = 0.15, reciprocating_mass = 0.5 }
"""
ENGINES = {
    "everything": EVERYTHING,
    "cylinders of their own": cp.Engine.preset("vr6"),
    "two-stroke": cp.Engine.preset("i2-180-two-stroke"),
    "vee at 0°": cp.Engine.vee(PISTON_AND_ROD, bank_angle_deg=0, throws_deg=[0], spacing=0.1),
    "two cranks": cp.Engine.from_toml(TWO_CRANKS),
    "lines in its name": cp.Engine.preset("single").replace(name="one\n[two]\nz = 3", source="'''"),
}


@cache
def validator() -> Any:  # noqa: ANN401 - of a package without types
    """What checks files; its package takes seconds to import, for which other tests do not wait."""
    from jsonschema import Draft202012Validator

    return Draft202012Validator(SCHEMA)


def mistakes(data: object) -> list[str]:
    """What the schema says of a file."""
    return [each.message for each in validator().iter_errors(data)]


def test_the_schema_is_one() -> None:
    validator().check_schema(SCHEMA)


@pytest.mark.parametrize("name", ENGINES)
def test_the_schema_accepts_what_is_written(name: str, tmp_path: Path) -> None:
    engine = ENGINES[name]
    engine.save(tmp_path / "engine.toml")
    engine.save(tmp_path / "engine.json")
    text = (tmp_path / "engine.toml").read_text(encoding="utf-8")
    assert mistakes(tomllib.loads(text)) == []
    assert mistakes(json.loads((tmp_path / "engine.json").read_text(encoding="utf-8"))) == []
    assert cp.Engine.load(tmp_path / "engine.toml") == engine
    assert cp.Engine.load(tmp_path / "engine.json") == engine


@in_turn("name", cp.presets())
def test_the_schema_accepts_presets(name: str) -> None:
    assert mistakes(json.loads(cp.Engine.preset(name).to_json())) == []


def test_changed_copies_keep_their_crankshafts() -> None:
    engine = ENGINES["two cranks"]
    assert "another crankshaft: ratio -1 at (0.2, 0) m" in repr(engine)
    assert engine.replace() == engine
    moved = engine.replace(z=[0, 0.1])
    assert "another crankshaft" in repr(moved)
    # The second crank turns the other way: the two pull together upright, against each other level.
    unbalanced = engine.replace(rotating_mass=0.5).balance(600, orders=1).force
    pull = 0.5 * 0.05 * (20 * np.pi) ** 2
    np.testing.assert_allclose(unbalanced.peak_xy[0], [0.0, 4.0 * pull], rtol=1e-15, atol=1e-13)


DECLARED: dict[str, Any] = {
    "cylinder": cp.Cylinder, "rod": cp.Rod, "unbalance": cp.Unbalance, "shaft": cp.Shaft,
    "load": cp.PeriodicLoad, "mount": cp.Mount, "body": cp.RigidBody, "cycle": cp.Cycle,
    "powertrain": cp.Powertrain, "subframe": cp.Subframe, "receptance": cp.Receptance,
}  # fmt: skip
"""Part of the schema → the class whose arguments it has."""
OTHERWISE = {
    "rod": {"length"},  # the cylinder's
    "load": {"scaling", "rpm", "over_speed", "x", "y", "axis"},
    "cycle": {"example", "origin"},
    # Files are in the axes of the engine.
    "powertrain": {"engine", "support", "subframe", "receptance", "vehicle"},
    "receptance": {"table", "frequency", "real", "imaginary"},
}
"""Entries and arguments that the other does not have: what one writes otherwise than the other."""
UNIT = re.compile(r"(?:^|, )(kg·m²|kg·m|kg|N·s/m|N·m|N/m|N|Pa|Hz|m|degrees)(?![\w·/²])")


@pytest.mark.parametrize("part", DECLARED)
def test_entries_are_the_arguments_of_the_class_in_its_units(part: str) -> None:
    properties = SCHEMA["$defs"][part]["properties"]
    arguments = {*inspect.signature(DECLARED[part]).parameters}
    assert properties.keys() ^ arguments == OTHERWISE.get(part, set())
    for name in properties.keys() & arguments - {"table"}:  # a pair of two units
        unit = UNIT.search(properties[name]["description"])
        assert (unit[1] if unit else "") == parameter(DECLARED[part], name).unit, name


def test_every_part_with_arguments_of_a_class_is_compared() -> None:
    classes = [getattr(cp, name) for name in cp.__all__ if inspect.isclass(getattr(cp, name))]
    named = {kind.__name__.lower(): kind for kind in classes}
    assert {*DECLARED.values()} >= {named[part] for part in SCHEMA["$defs"] if part in named}


TABLES = {  # where an unknown entry is put → the part of the schema that lists the known ones
    "": SCHEMA,
    "cylinder": SCHEMA["$defs"]["cylinder"],
    "cylinder.rod": SCHEMA["$defs"]["rod"],
    "placements.0": SCHEMA["$defs"]["placement"],
    "counterweights.0": SCHEMA["$defs"]["unbalance"],
    "shafts.0": SCHEMA["$defs"]["shaft"],
    "shafts.0.unbalances.0": SCHEMA["$defs"]["unbalance"],
    "cranks.0": SCHEMA["$defs"]["crank"],
    "cycles.0": SCHEMA["$defs"]["cycle"],
}


def everything() -> dict[str, Any]:
    """All there can be, as data."""
    data: dict[str, Any] = json.loads(EVERYTHING.to_json())
    return data | {"cranks": [{"x": 0.2, "y": 0, "ratio": -1}], "strokes": 4}


def inside(data: Any, place: str) -> Any:  # noqa: ANN401 - of JSON
    """The table at a place."""
    for key in filter(None, place.split(".")):
        data = data[int(key) if key.isdigit() else key]
    return data


@pytest.mark.parametrize("place", TABLES)
def test_the_schema_has_the_entries_that_the_reader_knows(place: str) -> None:
    data = everything()
    cp.Engine.from_json(json.dumps(data))
    inside(data, place)["zzz"] = 1
    assert mistakes(data)
    with pytest.raises(cp.InputError, match="unknown field `zzz`") as caught:
        cp.Engine.from_json(json.dumps(data))
    listed = re.findall("`([a-z_]+)`", str(caught.value))[1:]
    entries = list(TABLES[place]["properties"])
    assert listed
    assert entries[: len(listed)] == listed
    if "…" not in str(caught.value):
        assert entries == listed
    for entry in entries[len(listed) :]:  # of more than the message has room for
        data = everything()
        inside(data, place)[entry] = {"zzz": 1}
        with pytest.raises(cp.InputError) as caught:
            cp.Engine.from_json(json.dumps(data))
        assert f"unknown field `{entry}`" not in str(caught.value)


@in_turn(
    ("place", "entry", "value"),
    [
        ("", "schema", 2),
        ("", "schema", None),
        ("", "placements", None),
        ("", "placements", []),
        ("", "strokes", 3),
        ("", "name", 3),
        ("", "mains", "none"),
        ("", "reference_z", "middle"),
        ("", "crankcase", -1.0),
        ("cylinder", "crank_radius", None),
        ("cylinder", "crank_radius", 0.0),
        ("cylinder", "crank_radius", "45mm"),
        ("cylinder", "rod_length", -0.15),
        ("cylinder", "reciprocating_mass", None),
        ("cylinder", "reciprocating_mass", -1.0),
        ("cylinder", "bore", 0.0),
        ("cylinder", "piston_mass", -0.1),
        ("cylinder.rod", "mass", None),
        ("cylinder.rod", "inertia", -1.0),
        ("placements.0", "tdc_deg", None),
        ("placements.0", "tdc_deg", "upright"),
        ("placements.0", "bank_deg", "360/"),
        ("placements.0", "bank_deg", "51.3/2.5"),
        ("placements.0", "z", "0 m"),
        ("placements.0", "rotating_mass", -1.0),
        ("placements.0", "crank", -1),
        ("placements.0", "cycle", 0),
        ("placements.0", "second_turn", "yes"),
        ("counterweights.0", "amount", -0.1),
        ("counterweights.0", "angle_deg", None),
        ("counterweights.0", "pin", 0),
        ("shafts.0", "ratio", 0),
        ("shafts.0", "ratio", 21),
        ("shafts.0", "ratio", 1.3),
        ("shafts.0", "unbalances", None),
        ("cranks.0", "ratio", 0),
        ("cranks.0", "x", None),
        ("cycles.0", "example", None),
        ("cycles.0", "example", "steam"),
        ("cycles.0", "example", 1),
        ("cycles.0", "name", "mine"),
        ("cycles.0", "pressure", [1e5] * 8),
        ("cycles.0", "degree", 1),
        ("cycles.1", "pressure", None),
        ("cycles.1", "theta_deg", None),
        ("cycles.1", "strokes", None),
        ("cycles.1", "pressure", [-2e5, *everything()["cycles"][1]["pressure"][1:]]),
        ("cycles.1", "strokes", 3),
        ("cycles.1", "degree", 0),
        ("cycles.1", "example", "petrol"),
    ],
)
def test_schema_and_reader_reject_the_same_mistakes(place: str, entry: str, value: object) -> None:
    data = everything()
    if value is None:
        del inside(data, place)[entry]
    else:
        inside(data, place)[entry] = value
    assert mistakes(data)
    with pytest.raises(cp.InputError):
        cp.Engine.from_json(json.dumps(data))


@pytest.mark.parametrize("angle", ["90", " 360/7 ", "-1e2", "49.54", "+.5", "513 / 25"])
def test_the_schema_takes_angles_that_the_reader_takes(angle: str) -> None:
    data = everything()
    del data["firing_order"], data["cycles"], data["crankcase"]
    for placement in data["placements"]:
        for name in ("cycle", "crank_end", "rod_diameter", "second_turn"):
            placement.pop(name, None)
    data["placements"][0]["tdc_deg"] = angle
    assert mistakes(data) == []
    cp.Engine.from_json(json.dumps(data))


@pytest.mark.parametrize("kind", computed_cycles.EXAMPLES)
@pytest.mark.parametrize("strokes", [4, 2])
def test_examples_are_written_by_name_and_read_back_to_the_last_bit(
    kind: Literal["petrol", "diesel"], strokes: int
) -> None:
    example = cp.Cycle.example(kind, strokes=strokes)
    single = cp.Engine.inline(PISTON_AND_ROD, throws_deg=[0], spacing=0.1, strokes=strokes)
    for cycle, by_name in [
        (example, True),
        (example.replace(name="mine"), False),
        (example.replace(pressure=np.nextafter(example.pressure, 1e9)), False),
        (cp.Cycle.example(kind, strokes=strokes, load=0.5), False),
    ]:
        engine = single.with_cycle(cycle)
        for text, read in [
            (engine.to_toml(), cp.Engine.from_toml),
            (engine.to_json(), cp.Engine.from_json),
        ]:
            assert ("pressure" not in text) == by_name
            assert read(text) == engine
            cycles = read(text).cycles
            assert cycles is not None
            assert cycles[0] == cycle


def test_files_explain_each_entry_once() -> None:
    text = engine_files.commented(EVERYTHING.to_toml())
    assert tomllib.loads(text) == tomllib.loads(EVERYTHING.to_toml())
    comments = [line.rpartition("  # ")[2] for line in text.splitlines() if "  # " in line]
    about = engine_files.descriptions()
    assert set(comments) <= set(about.values())
    assert text.count(f"  # {about['placements.tdc_deg']}\n") == 1
    known = {
        f"{table.strip('[]')}.{line.partition(' = ')[0]}".strip(".")
        for table, lines in _tables(EVERYTHING.to_toml())
        for line in lines
    }
    assert known <= set(about)  # no entry without words
    assert len(comments) >= len(known)


def _tables(text: str) -> list[tuple[str, list[str]]]:
    found = [("", list[str]())]
    for line in filter(None, text.splitlines()):
        if line.startswith("["):
            found.append((line, []))
        else:
            found[-1][1].append(line)
    return found


def test_words_of_the_schema_fit_behind_an_entry() -> None:
    for place, words in engine_files.descriptions().items():
        assert "\n" not in words, place
        assert len(words) <= 100, place
