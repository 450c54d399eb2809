"""Can builders do in the workbench what they do: by mouse, by keyboard, with slips?"""

from __future__ import annotations

import base64
import inspect
import json
import shutil
import tomllib
import zlib
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.parameters import parameter
from crankpin.model import presets
from support.building import SITE, cells, choose, engine, faults, field, settle, take_file, type_in
from support.chromium import ARGUMENTS, NAMES

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from playwright.sync_api import Browser, Page

    Open = Callable[..., Page]

pytestmark = pytest.mark.slow  # a browser

UNLABELLED = """() => [...document.querySelectorAll(".bench :is(input, select, button)")]
    .filter(each => !each.hidden && each.type !== "file" && !each.labels?.length)
    .filter(each => !(each.ariaLabel || each.textContent.trim() || each.title))
    .map(each => each.outerHTML)"""
"""Controls without a name for those who do not see the page."""


BUILDERS: dict[str, Any] = {
    "inline": cp.Engine.inline, "vee": cp.Engine.vee, "flat": cp.Engine.flat,
    "boxer": cp.Engine.boxer, "fan": cp.Engine.from_banks, "radial": cp.Engine.radial,
    "opposed_pistons": cp.Engine.opposed_pistons, "u": cp.Engine.u,
    "square_four": cp.Engine.square_four, "h": cp.Engine.h, "lists": cp.Engine.from_lists,
}  # fmt: skip
"""Kind of the form → the builder that takes its fields."""
ELSEWHERE = {
    "cylinder", "upper", "one_crankshaft", "rotating_mass", "name", "source",  # of every kind
    "first_tdc_deg", "counterweights", "shafts", "mains", "reference_z", "pin_deg", "cranks",
    "crank", "rods", "master",  # of engine files
}  # fmt: skip
"""Arguments of builders that are no fields of a layout."""


def test_fields_are_the_arguments_of_builders(open_workbench: Open) -> None:
    fields, kinds = open_workbench().evaluate("[FIELDS, KINDS]")
    assert kinds.keys() == BUILDERS.keys()
    for kind, builder in BUILDERS.items():
        typed = {*kinds[kind]["fields"]} - {"gas", "inertia"}
        assert typed == {*inspect.signature(builder).parameters} - ELSEWHERE, kind
        for name in typed:
            declared = parameter(builder, name)
            unit = declared.unit.replace("degrees", "°")
            assert fields[name].get("unit", "") == unit, name
            if declared.choices:
                assert fields[name]["choices"].keys() == {*declared.choices}, name
            else:
                assert fields[name]["said"], name


def test_fields_of_loads_are_arguments_of_periodic_loads(open_workbench: Open) -> None:
    fields = open_workbench().evaluate("LOAD_FIELDS")
    for name, shown in fields.items():
        declared = parameter(cp.PeriodicLoad, name)
        if name not in {"rpm", "turning"}:  # a choice, and a field that reads tables too
            assert shown.get("unit", "") == declared.unit.replace("degrees", "°"), name
            assert shown.get("choices", {}).keys() == {*declared.choices}, name
    elsewhere = {"scaling", "crank"}  # follows from what is typed; of engine files
    assert fields.keys() == {*inspect.signature(cp.PeriodicLoad).parameters} - elsewhere


# --- tasks --------------------------------------------------------------------------------------


def test_own_45_degree_twin_in_inches_and_ounces(open_workbench: Open) -> None:
    page = open_workbench("#preset=v-twin-45")
    choose(page, units="in, oz, lbf")
    type_in(page, bore="3½", stroke="4.25", rod_length="7 7/16", reciprocating_mass="27",
            rotating_mass="11 oz", spacing="0")  # fmt: skip
    assert field(page, "stroke").input_value() == "4.25 in"
    assert field(page, "rod_length").input_value() == "7 7/16 in"
    inch, ounce = 0.0254, 0.028349523125
    twin = engine(page)
    assert twin.cylinders[0].crank_radius == pytest.approx(4.25 * inch / 2, rel=1e-15)
    assert twin.cylinders[0].rod_length == pytest.approx(7.4375 * inch, rel=1e-15)
    assert twin.cylinders[0].bore == pytest.approx(3.5 * inch, rel=1e-15)
    assert twin.cylinders[0].reciprocating_mass == pytest.approx(27 * ounce, rel=1e-15)
    first = twin.balance(rpm=3000)[1]
    shown = page.locator("td[data-name=force-peak]").first.get_attribute("data-value")
    assert float(shown or "nan") == pytest.approx(first.force.peak, rel=1e-14)
    assert "lbf" in page.locator(".tabled thead").first.inner_text()


def test_presets_are_the_librarys(open_workbench: Open) -> None:
    """With what the form has no fields for, such as link rods."""
    page = open_workbench()
    take = """name => {
        workbench.slots[0].take(Design.preset(name));
        const [{ engine, faults }] = workbench.slots;
        return faults.length ? faults[0].message : engine.json;
    }"""
    for name in cp.presets():
        assert cp.Engine.from_json(page.evaluate(take, name)) == cp.Engine.preset(name), name
    listed = page.locator("[data-field=preset] optgroup option").evaluate_all(
        "options => options.map(({ value }) => value)"
    )
    own_parts = {name for name in cp.presets() if name.endswith(presets.OWN_PARTS)}
    assert sorted(listed) == sorted({*cp.presets()} - own_parts)


def test_own_engines_of_two_cranks(open_workbench: Open) -> None:
    cylinder = cp.Cylinder.from_bore_stroke(
        bore=0.086, stroke=0.086, rod_length=0.145, reciprocating_mass=0.45
    )
    page = open_workbench("#kind=square_four")
    type_in(page, distance="110 mm")
    assert engine(page) == cp.Engine.square_four(cylinder, spacing=0.1, distance=0.11)
    choose(page, kind="opposed_pistons", ratio="1", strokes="2")
    type_in(page, throws_deg="0, 120, 240", distance="500 mm", lead_deg="12")
    throws: Any = {"throws_deg": [0, 120, 240], "spacing": 0.1}
    opposed = cp.Engine.opposed_pistons(cylinder, **throws, distance=0.5, lead_deg=12)
    assert engine(page) == opposed
    choose(page, kind="u", ratio="-1", strokes="4")
    type_in(page, throws_deg="0, 120, 240", phase_deg="360/7", firing_order="")
    geared = cp.Engine.u(cylinder, **throws, distance=0.5, phase_deg="360/7")
    assert engine(page) == geared


def test_270_degree_twin(open_workbench: Open) -> None:
    page = open_workbench("#preset=i2-360")
    type_in(page, throws_deg="0, 90")
    assert engine(page).throws_deg.tolist() == [0, 90]
    assert engine(page).firing().intervals_deg.tolist() == [270, 450]
    assert "360" not in page.locator("h1").inner_text()
    assert field(page, "preset").input_value() == ""
    choose(page, preset="i2-360")
    assert engine(page) == cp.Engine.preset("i2-360")


def test_v6_with_split_pins(open_workbench: Open) -> None:
    page = open_workbench("#kind=vee")
    type_in(page, bank_angle_deg="60", throws_deg="0 240 120", pin_split_deg="-60°")
    type_in(page, spacing="110 mm", firing_order="1-2-4-6-3-5")
    v6 = engine(page)
    assert v6.pin_split_deg.tolist() == [-60, -60, -60]
    assert v6.firing().even


def test_absent_cylinders_unequal_spacing_and_fans_are_typed(open_workbench: Open) -> None:
    page = open_workbench("#kind=vee")
    type_in(page, bank_angle_deg="75.5", throws_deg="0 104.5 0", absent="6", spacing="100, 120 mm")
    v5 = engine(page)
    assert v5.banks == {"right": (1, 3, 5), "left": (2, 4)}
    assert v5.z.tolist() == [0.0, 0.0, 0.1, 0.1, 0.22]
    type_in(page, absent="7")
    assert faults(page) == ["the whole vee has cylinders 1 to 6"]
    type_in(page, absent="", spacing="100")
    assert len(engine(page)) == 6
    choose(page, kind="fan")
    type_in(page, throws_deg="0 180", bank_stagger="20 mm")
    w6 = engine(page)
    assert w6.bank_deg.tolist() == [30, 30, 90, 90, 150, 150]
    np.testing.assert_allclose(w6.z, [0, 0.1, 0.02, 0.12, 0.04, 0.14], rtol=1e-15)
    assert faults(page) == []


def test_a_v6_is_typed_over_a_v8(open_workbench: Open) -> None:
    """The preset's firing order goes while other throws cannot have it, and comes back."""
    page = open_workbench("#preset=v8-crossplane")
    type_in(page, bank_angle_deg="60", throws_deg="0 240 120", pin_split_deg="-60", spacing="110")
    assert len(engine(page)) == 6
    (said,) = faults(page)
    assert said.startswith("Left out, as the engine is another: name each of the engine's 6")
    assert field(page, "firing_order").get_attribute("aria-invalid") is None
    assert page.locator(".fault.whole:visible").count() == 0
    choose(page, odd_bank="right")
    type_in(page, firing_order="1-2-4-6-3-5")
    assert engine(page).firing().even
    assert faults(page) == []
    type_in(page, firing_order="1-2-4-6-5-5")
    assert len(faults(page)) == 1
    assert field(page, "firing_order").get_attribute("aria-invalid") == "true"
    choose(page, preset="v8-crossplane")
    type_in(page, throws_deg="0, 90")
    assert engine(page).firing_order == ""
    type_in(page, throws_deg="0, 90, 270, 180")
    assert engine(page) == cp.Engine.preset("v8-crossplane")


def test_single_with_a_balance_shaft(open_workbench: Open) -> None:
    page = open_workbench("#preset=single")
    before = engine(page)
    page.get_by_role("tab", name="Balance shafts").click()
    page.get_by_role("button", name="Fit it to the engine").first.click()
    settle(page)
    after = engine(page)
    assert len(after.shafts) == 1
    assert after.balance(rpm=3000)[1].force.peak < before.balance(rpm=3000)[1].force.peak


def test_cross_plane_against_flat_plane(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    page.get_by_role("button", name="Compare").click()
    choose(page, preset="v8-flatplane")
    assert engine(page, 0).firing_order == presets.preset("v8-crossplane").firing_order
    assert engine(page, 1).throws_deg.tolist() == presets.preset("v8-flatplane").throws_deg.tolist()
    assert page.locator(".turning").count() == 2
    page.evaluate("workbench.slots[1].bench.set({ angle_deg: 75 })")
    assert page.evaluate("workbench.slots[0].bench.state.angle_deg") == 75
    assert page.locator(".pane.orders").count() == 2
    page.wait_for_timeout(600)
    both = open_workbench(page.evaluate("location.hash"))
    assert [engine(both, k) for k in (0, 1)] == [engine(page, k) for k in (0, 1)]


def test_own_file_opened_and_saved(open_workbench: Open, tmp_path: Path) -> None:
    own = cp.Engine.preset("vr6").replace(name="Öwn & <VR6>")
    own = own.with_counterweights([cp.Unbalance(0.001, 10, 0.02)])
    own.save(tmp_path / "own.toml")
    page = open_workbench()
    page.locator("input[type=file]").set_input_files(tmp_path / "own.toml")
    page.wait_for_function("() => workbench.slots[0].engine.summary.name.includes('VR6')")
    assert engine(page) == own
    with page.expect_download() as download:
        page.get_by_role("button", name="Save", exact=True).click()
    download.value.save_as(tmp_path / "saved.toml")
    assert cp.Engine.load(tmp_path / "saved.toml") == own
    assert download.value.suggested_filename.endswith(".toml")
    tomllib.loads((tmp_path / "saved.toml").read_text("utf-8"))


def test_a_link_opens_the_same_engine(open_workbench: Open, tmp_path: Path) -> None:
    page = open_workbench("#preset=v6-60")
    type_in(page, stroke="3.25 in", name="a & b #1 = <c>", bank_angle_deg="72")
    page.wait_for_timeout(600)
    fragment: str = page.evaluate("location.hash")
    again = open_workbench(fragment)
    assert engine(again) == engine(page)
    assert field(again, "stroke").input_value() == "3.25 in"
    own = cp.Engine.preset("w8").replace(name="w")
    own.save(tmp_path / "w.json")
    page.locator("input[type=file]").set_input_files(tmp_path / "w.json")
    page.wait_for_function("() => workbench.slots[0].engine.summary.name === 'w'")
    page.wait_for_timeout(600)
    assert engine(open_workbench(page.evaluate("location.hash"))) == own


@pytest.mark.parametrize(
    ("name", "wrong", "part", "right"),
    [
        ("stroke", "86 kg", "with a unit (mm, in)", "86 mm"),
        ("rod_length", "40 mm", "the crank cannot turn", "145 mm"),
        ("bank_angle_deg", "181", "between 0 and 180", "180"),
        ("throws_deg", "0, x", "give degrees, such as", "0, 120"),
        ("reciprocating_mass", "", "give the reciprocating mass", "1 lb"),
    ],
)
def test_a_wrong_figure_is_mended_by_its_hint(
    open_workbench: Open, name: str, wrong: str, part: str, right: str
) -> None:
    page = open_workbench("#preset=v4-90-180")
    type_in(page, firing_order="")
    before = engine(page)
    type_in(page, **{name: wrong})
    (said,) = faults(page)
    assert part in said
    assert field(page, name).get_attribute("aria-invalid") == "true"
    described = (field(page, name).get_attribute("aria-describedby") or "").split()
    assert any(page.locator(f"#{each}").inner_text() == said for each in described)
    assert engine(page) == before
    type_in(page, **{name: right})
    assert faults(page) == []


def test_everything_is_reached_by_keyboard(open_workbench: Open) -> None:
    page = open_workbench("#preset=i4")
    field(page, "stroke").focus()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("90 mm")
    page.keyboard.press("Tab")
    settle(page)
    assert engine(page).cylinders[0].stroke == pytest.approx(0.09)
    first = page.get_by_role("tab", selected=True)
    first.focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.getAttribute('aria-selected')") == "true"
    assert page.evaluate(UNLABELLED) == []


# --- one page -----------------------------------------------------------------------------------


def test_asks_the_network_for_nothing(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    for tab in page.get_by_role("tab").all():
        tab.click()
        page.wait_for_timeout(100)
    asked = [url for url in page.asked if not url.startswith("blob:")]  # type: ignore[attr-defined]
    assert asked == [page.url.partition("#")[0]] or asked == [page.url]


@pytest.mark.parametrize(
    "name", ["</script><script>alert(1)</script>", "<img src=x onerror=alert(2)>"]
)
def test_hostile_names_stay_text(open_workbench: Open, tmp_path: Path, name: str) -> None:
    page = open_workbench()
    page.on("dialog", lambda dialog: pytest.fail(dialog.message))
    scripts = page.evaluate("document.scripts.length")
    own = cp.Engine.preset("i4").replace(name=name, source=name)
    own.save(tmp_path / "own.toml")
    page.locator("input[type=file]").set_input_files(tmp_path / "own.toml")
    page.wait_for_function("name => workbench.slots[0].engine.summary.name === name", arg=name)
    assert page.locator("h1").inner_text() == name
    assert page.locator("img").count() == 0
    assert page.evaluate("document.scripts.length") == scripts
    with page.expect_download() as download:
        page.get_by_role("button", name="Save page").click()
    download.value.save_as(tmp_path / "page.html")
    page.goto((tmp_path / "page.html").as_uri())
    assert page.locator("h1").inner_text() == name
    assert page.evaluate("document.scripts.length") == 1


@pytest.mark.parametrize(
    "fragment",
    [
        "#preset=nothing",
        "#preset=__proto__",
        "#preset=i4&rpm=-1",
        "#preset=i4&rpm=-1&throws_deg=%00",
        "#kind=constructor",
        "#kind=lists&file=AAAA",
        "#kind=lists&file=" + "A" * 5000,
        "#kind=inline&throws_deg=" + "0," * 20000,
    ],
)
def test_a_hostile_link_says_what_is_wrong_and_freezes_nothing(
    open_file: Open, workbench: Path, fragment: str
) -> None:
    page = open_file(workbench, fragment=fragment)
    page.wait_for_selector(".form")
    page.wait_for_timeout(600)
    said = page.locator(".said, .fault").all_inner_texts()
    assert any(said) or fragment == "#preset=i4&rpm=-1"
    choose(page, preset="i4")
    assert engine(page) == cp.Engine.preset("i4")


def test_all_of_it_is_less_than_910_kb(workbench: Path) -> None:
    """Core, styles, scripts and presets are compressed, and a sixth longer as letters.

    A twelfth of it is that the core's loops are vectors. It measured 898 kB: the core computes the
    rows of the turning page, and link rods, faces of pistons, snubbers and moving bases are in it.
    """
    assert workbench.stat().st_size < 910_000


def test_every_preset_is_the_library_s(open_workbench: Open) -> None:
    page = open_workbench()
    names = page.eval_on_selector_all(
        "[data-field=preset] option[value]:not([value=''])", "all => all.map(each => each.value)"
    )
    assert len(names) > 50
    for name in names:
        choose(page, preset=name)
        assert engine(page) == cp.Engine.preset(name), name


def test_nothing_is_wider_than_a_phone(open_workbench: Open) -> None:
    page = open_workbench(viewport={"width": 390, "height": 844})
    for tab in page.get_by_role("tab").all():
        tab.click()
        page.wait_for_timeout(200)
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, tab.inner_text()
    assert json.loads(page.evaluate("JSON.stringify(workbench.slots.length)")) == 1


def test_links_of_the_manual_make_engines(open_workbench: Open) -> None:
    folder = SITE.parent / "docs"
    links = [
        line.split()[1]
        for file in folder.rglob("*.md")
        for line in file.read_text("utf-8").splitlines()
        if line.startswith("```{workbench} ")
    ]
    assert len(links) > 4
    page = open_workbench(f"#{links[0]}")
    for link in links:
        page.evaluate("link => { location.hash = link; }", link)
        page.wait_for_timeout(700)
        assert page.locator(".fault:visible, .said:visible").all_inner_texts() == [], link
        preset = dict(part.split("=") for part in link.split("&"))["preset"]
        assert page.evaluate("workbench.slots[0].design.preset") == preset


def test_many_engines_take_no_more_memory_than_few(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    typed = """count => {
        const [slot] = workbench.slots;
        for (let k = 0; k < count; k++) {
            slot.design.fields.stroke = `${70 + (k % 30)} mm`;
            slot.design.fields.throws_deg = k % 2 ? "0, 90, 270, 180" : "0, 180, 180, 0, 90";
            slot.design.fields.firing_order = "";
            slot.follow();
        }
        return [workbench.core.memory, document.querySelectorAll("*").length];
    }"""
    page.evaluate(typed, 60)
    few = page.evaluate(typed, 60)
    assert page.evaluate(typed, 210) == few  # which ends with the same engine


def test_long_work_can_be_cancelled(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    answer = page.evaluate("""async () => {
        const theta_deg = Array.from({ length: 2e6 }, (_, k) => k / 1e3);
        const engine = workbench.slots[0].engine.json;
        const asked = workbench.jobs.ask("test", "waveform", { engine, rpm: 3000, theta_deg });
        setTimeout(() => workbench.jobs.cancel(), 50);
        return asked.then(() => "answered", (error) => error.constructor.name);
    }""")
    assert answer == "Outdated"
    again = """() => workbench.jobs.ask("test", "read", { engine: workbench.slots[0].engine.json })
        .then(({ summary }) => summary.cylinders)"""
    assert page.evaluate(again) == 8


@pytest.mark.parametrize(
    ("count", "words"),
    [(9000, "an engine has 1 to 1000 cylinders"), (65, "the workbench draws up to 64")],
)
def test_sizes_beyond_limits_are_errors(open_workbench: Open, count: int, words: str) -> None:
    page = open_workbench("#preset=i4")
    type_in(page, firing_order="", throws_deg=", ".join(["0"] * count))
    page.wait_for_timeout(600)
    assert words in page.locator(".fault.whole").inner_text()


def test_bob_weights_at_50_and_52_percent(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane&reciprocating_mass=620+g&rotating_mass=550+g")
    page.get_by_role("tab", name="Bob weight").click()
    page.wait_for_selector("td[data-name=bob-weight]")
    cells = page.locator("td[data-name=bob-weight]").all()
    shown = [float(cell.get_attribute("data-value") or "nan") for cell in cells]
    v8 = engine(page)
    masses = [cp.bob_weight(v8, factor=factor).grams[0] / 1000 for factor in (0.5, 0.52)]
    assert shown[:2] == pytest.approx(masses, rel=1e-14)


def test_sentences_are_the_library_s(open_workbench: Open) -> None:
    page = open_workbench("#preset=i4")
    shown = page.locator(".explained li").all_text_contents()
    assert shown == list(engine(page).explain(rpm=3000).sentences)


def test_sentences_are_in_the_units_that_are_chosen(open_workbench: Open) -> None:
    page = open_workbench("#preset=i4&units=in%2C+oz%2C+lbf")
    shown = page.locator(".explained li").all_text_contents()
    with cp.units("in, oz, lbf"):
        assert shown == list(engine(page).explain(rpm=3000).sentences)
    assert any("lbf" in text for text in shown)


def test_hints_are_in_the_units_that_are_chosen(open_workbench: Open) -> None:
    page = open_workbench("#preset=i4&units=in%2C+oz%2C+lbf")
    type_in(page, rod_length="1.5")
    assert [text.endswith("= 1.5 in") for text in faults(page)] == [True]


# --- what a file can have -----------------------------------------------------------------------


@pytest.mark.parametrize("on", ["ground", "subframe"])
def test_an_engine_on_mounts(open_workbench: Open, tmp_path: Path, on: str) -> None:
    i4 = cp.Engine.preset("i4").with_cycle(cp.Cycle.example())
    body = cp.RigidBody(mass=148, cg=(0.02, 0.07, 0.09), inertia=(8.1, 7.6, 4.9))
    places = {"right": (0.28, 0, -0.09), "left": (-0.28, 0, -0.09), "rear": (0, -0.12, 0.55)}
    mounts = [cp.Mount(name, at, stiffness=(2.2e5, 8e4, 9e4)) for name, at in places.items()]
    car = cp.Powertrain(i4, body, mounts)
    if on == "subframe":
        raft = cp.RigidBody(mass=90, cg=(0, -0.2, 0.2), inertia=(6, 7, 5))
        car = car.with_support(
            cp.Subframe(raft, [mount.replace(stiffness=5e5) for mount in mounts])
        )
    car.save(tmp_path / "car.toml")
    page = open_workbench()
    take_file(page, tmp_path / "car.toml")
    page.get_by_role("tab", name="Mounts").click()
    modes, still = car.modes(), car.static()
    assert cells(page, "frequency") == pytest.approx(modes.frequency, rel=1e-12)
    assert cells(page, "purity") == pytest.approx(modes.purity, rel=1e-9)
    forces = [*still.weight_force[:, 1], *still.ground_preload[:, 1]]
    assert cells(page, "force-y") == pytest.approx(forces, rel=1e-9)
    mainly = page.locator(".mounts table").first.locator("tbody td:nth-child(3)")
    assert mainly.all_inner_texts() == list(modes.dominant)
    assert field(page, "gas").locator("option:checked").inner_text() == "as in the file"


def test_a_dummy_piston_does_not_fire(open_workbench: Open, tmp_path: Path) -> None:
    part = cp.Cylinder(0.043, 0.145, 0.45)
    three = [part, part, part.replace(dummy=True)]
    own = cp.Engine.inline(three, throws_deg=[0, 180, 90], spacing=0.1, firing_order="1-2")
    own.save(tmp_path / "own.toml")
    page = open_workbench()
    take_file(page, tmp_path / "own.toml")
    assert page.locator("[data-name=firing-order]").inner_text() == "1-2"
    assert page.evaluate("workbench.slots[0].bench.figures.firing_deg") == [0, 180, None]


def test_an_engine_of_a_kind_becomes_one_of_lists(open_workbench: Open) -> None:
    page = open_workbench("#preset=v6-60&spacing=110+mm")
    before = engine(page)
    choose(page, kind="lists")
    assert engine(page).tdc_deg.tolist() == before.tdc_deg.tolist()
    assert engine(page).z.tolist() == pytest.approx(before.z, rel=1e-12)
    assert field(page, "name").input_value() == before.name
    assert field(page, "z").input_value() == "0 mm, 0 mm, 110 mm, 110 mm, 220 mm, 220 mm"
    type_in(page, z="0 mm, 0 mm, 110 mm, 110 mm, 235 mm, 235 mm")
    assert engine(page).z.tolist() == [0, 0, 0.11, 0.11, 0.235, 0.235]


# --- what the reader sees -----------------------------------------------------------------------


def test_hardware_that_removes_nothing_is_not_offered(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    page.get_by_role("tab", name="Balance shafts").click()
    fit = page.get_by_role("button", name="Fit it to the engine")
    fit.wait_for()
    assert fit.is_disabled()
    assert "nothing to remove" in page.locator(".shafts .hint").inner_text()


def test_who_fits_hardware_by_keyboard_keeps_the_place(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    page.get_by_role("tab", name="Counterweights").click()
    page.get_by_role("button", name="Fit it to the engine").press("Enter")
    page.wait_for_function("() => workbench.slots[0].engine.summary.counterweights > 0")
    off = page.get_by_role("button", name="Take it off")
    page.wait_for_function(
        "() => !document.querySelector('.results .buttons button + button').disabled"
    )
    assert page.evaluate("document.activeElement.textContent") == "Fit it to the engine"
    off.press("Enter")
    page.wait_for_function("() => workbench.slots[0].engine.summary.counterweights === 0")
    page.wait_for_function(
        "() => document.querySelector('.results .buttons button + button').disabled"
    )
    assert page.evaluate("document.activeElement.textContent") == "Fit it to the engine"


def test_engines_side_by_side_have_one_scale_and_one_drive(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane&with=preset%3Dv8-flatplane")
    page.wait_for_function("() => document.querySelectorAll('.charts').length === 2")
    ticks = [
        page.locator(".charts").nth(k).locator("figure").first.locator("text.tick[text-anchor=end]")
        for k in (0, 1)
    ]
    assert ticks[0].all_text_contents() == ticks[1].all_text_contents()
    assert page.locator(".transport:visible").count() == 1
    assert page.locator(".charts").nth(1).locator("figure").nth(1).locator(".hint").count() == 1
    wide = """() => [...document.querySelectorAll(".panel")].filter((panel) =>
        [...panel.querySelectorAll("figcaption, select")].some((each) =>
            each.getBoundingClientRect().right > panel.getBoundingClientRect().right)).length"""
    assert page.evaluate(wide) == 0


def test_two_engines_are_printed_with_their_figures(open_workbench: Open, tmp_path: Path) -> None:
    page = open_workbench("#preset=v8-crossplane&with=preset%3Dv8-flatplane")
    page.wait_for_selector(".explained")
    page.pdf(path=tmp_path / "two.pdf")
    assert page.locator("details").count() == page.locator("details[open]").count() > 0
    page.emulate_media(media="print")
    assert page.locator(".form:visible").count() == 2
    assert page.locator("[data-field=preset]:visible, .transport:visible").count() == 0
    assert page.locator(".views > :visible").count() == 6


def test_results_are_one_key_from_the_form(open_workbench: Open) -> None:
    page = open_workbench(viewport={"width": 390, "height": 844})
    page.get_by_role("button", name="To the results").press("Enter")
    assert page.evaluate("document.activeElement.id") == "tab-orders"
    seen = """id => {
        const { left, top } = document.getElementById(id).getBoundingClientRect();
        return document.elementFromPoint(left + 9, top + 9)?.id;
    }"""
    assert page.evaluate(seen, "tab-orders") == "tab-orders"
    field(page, "spacing").focus()  # the picture stays in sight above what is typed
    for name in ("throws_deg", "reciprocating_mass", "stroke"):
        field(page, name).focus()
        identity = field(page, name).get_attribute("id")
        assert page.evaluate(seen, identity) == identity
        assert page.locator(".turning .scene").first.is_visible()
    pinned = "document.querySelector('.turning').getBoundingClientRect().top"
    assert page.evaluate(pinned) == 0


def test_enlarged_fonts_are_no_wider_than_a_phone(browser: Browser, workbench: Path) -> None:
    path = next(filter(None, map(shutil.which, NAMES)))
    arguments = [*ARGUMENTS, "--blink-settings=defaultFontSize=32"]
    large = browser.browser_type.launch(executable_path=path, args=arguments)
    page = large.new_page(viewport={"width": 390, "height": 844})
    page.goto(workbench.as_uri())
    page.wait_for_selector(".turning .scene")
    assert page.evaluate("getComputedStyle(document.documentElement).fontSize") == "32px"
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    box = field(page, "stroke").bounding_box()
    assert box is not None
    assert box["width"] > 300
    large.close()


def test_work_says_which_share_of_it_is_done(open_workbench: Open) -> None:
    page = open_workbench("#preset=v8-crossplane")
    said = page.evaluate("""async () => {
        const { jobs } = workbench, seen = [], before = jobs.busy;
        jobs.busy = (share) => { seen.push(share); before(share); };
        const engine = workbench.slots[0].engine.json;
        await Promise.all([1, 2, 3, 4].map((k) => jobs.ask(`test ${k}`, "read", { engine })));
        jobs.busy = before;
        return [seen, document.querySelector(".working").textContent];
    }""")
    assert said[0][-1] is None
    assert sorted({share for share in said[0] if share is not None}) == [0, 0.25, 0.5, 0.75]
    assert "75 %" in said[1]


@pytest.mark.parametrize("name", ["W" * 300, "W" * 20 + " w" * 200])
@pytest.mark.parametrize("width", [390, 1280])
def test_long_names_widen_nothing(open_workbench: Open, name: str, width: int) -> None:
    page = open_workbench(f"#preset=i4&name={name}", viewport={"width": width, "height": 844})
    for tab in page.get_by_role("tab").all():
        tab.click()
        page.wait_for_timeout(100)
        assert page.evaluate("document.documentElement.scrollWidth") <= width, tab.inner_text()
    page.get_by_role("button", name="Compare").click()
    settle(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("spacing", ["1e-320 mm", "1e-30 mm", "1e-9 mm", "0", "1e30 mm"])
def test_cylinders_that_all_but_share_a_place_are_drawn(open_workbench: Open, spacing: str) -> None:
    page = open_workbench("#preset=i4")
    type_in(page, spacing=spacing)
    assert page.locator("[d*=NaN], [transform*=NaN], [points*=NaN], [cx*=NaN]").count() == 0


def test_a_phone_shows_results_below_the_picture(open_workbench: Open) -> None:
    page = open_workbench(viewport={"width": 390, "height": 844})
    top = "selector => document.querySelector(selector).getBoundingClientRect().top"
    assert page.evaluate(top, ".tabs") < 844 - 40
    page.get_by_role("button", name="To the figures").click()
    assert page.evaluate("document.activeElement.dataset.field") == "preset"
    assert abs(page.evaluate(top, ".form")) < 50
    page.get_by_role("button", name="To the results").click()
    assert abs(page.evaluate(top, ".tabs")) < 50


def test_columns_beyond_the_edge_are_marked(open_workbench: Open) -> None:
    page = open_workbench(viewport={"width": 390, "height": 844})
    style = "getComputedStyle(document.querySelector('.tabled .scrolls')).backgroundAttachment"
    assert page.evaluate(style) == "local, local, scroll, scroll"


@pytest.mark.parametrize("motion", ["reduce", "no-preference"])
def test_it_opens_turning_unless_the_reader_wants_it_still(
    open_workbench: Open, motion: str
) -> None:
    page = open_workbench(reduced_motion=motion)
    page.wait_for_timeout(300)
    turned = page.evaluate("workbench.slots[0].bench.state.angle_deg")
    assert (turned > 0) == (motion == "no-preference")


# --- what the library warns of ------------------------------------------------------------------


def test_warnings_stand_beside_what_was_typed(open_workbench: Open, tmp_path: Path) -> None:
    page = open_workbench("#preset=v6-90&firing_order=")
    type_in(page, reciprocating_mass="450 kg", throws_deg="0, 2.0944, 4.18879", inertia="9000")
    said = faults(page)
    assert len(said) == 3
    assert "was it given in grams?" in said[0]
    assert "was it given in radians?" in said[1]
    assert "kg·cm²" in said[2]
    assert page.locator("[aria-invalid]").count() == 0
    type_in(page, reciprocating_mass="450", throws_deg="0, 120, 240", inertia="")
    assert faults(page) == []
    page.evaluate("workbench.slots[0].bench.set({ rpm: 90000 })")
    (said_of_speed,) = faults(page)
    assert "mean piston speed" in said_of_speed
    page.evaluate("workbench.slots[0].bench.set({ rpm: 3000 })")
    assert faults(page) == []
    heavy = cp.Engine.preset("i4")
    with pytest.warns(UserWarning, match="was it given in g·mm"):
        heavy = heavy.with_counterweights([cp.Unbalance(500, 0.1)])
    heavy.save(tmp_path / "heavy.toml")
    take_file(page, tmp_path / "heavy.toml")
    page.wait_for_timeout(600)
    whole = page.locator(".fault.whole.note")
    assert "was it given in g·mm or g·m?" in whole.inner_text()
    with pytest.warns(UserWarning, match="given in grams"):
        body = cp.RigidBody(150e3, (0, 0.1, 0.2), (7, 8, 4.5))
    with pytest.warns(UserWarning, match="given in N/mm"):
        soft = [cp.Mount(f"{x}", (x, 0, 0), stiffness=200) for x in (-0.3, 0.3)]
    cp.Powertrain(cp.Engine.preset("i4"), body, soft).save(tmp_path / "soft.toml")
    take_file(page, tmp_path / "soft.toml")
    page.wait_for_timeout(600)
    for sentence in ("given in grams?", "stiffness of mount '0.3' = 200 N/m: was it given in N/mm"):
        assert sentence in whole.inner_text()


@pytest.mark.parametrize(
    "extra",
    [{"placements": []}, {"name": "x"}, {"bob": 1}, [], 5, {"counterweights": [{"amount": 1}]}],
)
def test_a_link_fits_hardware_and_nothing_else(
    open_file: Open, workbench: Path, extra: object
) -> None:
    text = json.dumps(extra).encode()
    packer = zlib.compressobj(wbits=-15)
    packed = base64.urlsafe_b64encode(packer.compress(text) + packer.flush()).decode().rstrip("=")
    page = open_file(workbench, fragment=f"#preset=i4&extra={packed}")
    page.wait_for_selector(".form")
    page.wait_for_timeout(600)
    said = [each for each in page.locator(".said, .fault").all_inner_texts() if each]
    assert said
    assert not any("undefined" in each or "TypeError" in each for each in said)


@pytest.mark.parametrize("file", ["AAAA", "!!", "x" * 300, "q1YqSyxSslKKjgUA"])
def test_a_damaged_link_is_said_in_words(open_file: Open, workbench: Path, file: str) -> None:
    page = open_file(workbench, fragment=f"#kind=lists&file={file}")
    page.wait_for_selector(".form")
    said = page.locator(".said").inner_text()
    assert said == "This link is damaged: the engine in it cannot be read."
