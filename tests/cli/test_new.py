"""Does the shell make the engines that Python makes, from what a builder has measured?"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.cli import main
from crankpin.cli.new import BUILDERS
from support import in_turn

CAPTURE = pytest.CaptureFixture[str]
HARLEY = (
    "v-twin --bank-angle 45 --bore 88.9mm --stroke 96.8mm --rod-length 189mm "
    "--piston-mass 480g --rod-mass 560g"
)
PARTS = (
    "--bore 100mm --stroke 90mm --rod-length 150mm --reciprocating-mass 500g --rotating-mass 400g"
)
CYLINDER = cp.Cylinder(0.045, 0.15, 0.5, bore=0.1)


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    mpl.use("agg")


def printed(capsys: CAPTURE, line: str) -> str:
    """What a run that succeeds prints."""
    assert main(line.split()) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def made(capsys: CAPTURE, line: str) -> cp.Engine:
    """The engine that ``new`` prints, without its source."""
    engine = cp.Engine.from_toml(printed(capsys, f"new {line}"))
    assert engine.source == f"crankpin new {line}"
    return engine.replace(source="")


def refused(capsys: CAPTURE, line: str) -> str:
    """What a run that fails says, one line."""
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    (said,) = err.splitlines()
    return said.removeprefix("crankpin: error: ")


# --- a builder's own engine -----------------------------------------------------------------------


def test_a_45_degree_twin_from_weighed_parts(capsys: CAPTURE) -> None:
    said = printed(capsys, f"new {HARLEY} -o harley.toml")
    assert said.startswith("V-twin 45°: 2 cylinders, bank angle 45°\n")
    assert "Of the rod one third moves with the piston" in said
    assert said.endswith("Written to harley.toml: try crankpin balance harley.toml\n")
    engine = cp.Engine.load("harley.toml")
    (cylinder, _) = engine.cylinders
    assert (cylinder.stroke, cylinder.rod_length, cylinder.bore) == (0.0968, 0.189, 0.0889)
    # A third of 560 g and 480 g; two thirds. Rounded a few times to 1.1e-16.
    assert cylinder.reciprocating_mass == pytest.approx(0.48 + 0.56 / 3, rel=1e-15)
    assert engine.rotating_mass.tolist() == pytest.approx([0.56 * 2 / 3] * 2, rel=1e-15)
    assert cylinder.rod == cp.Rod.estimated(0.56, 0.189, 0.063)
    assert engine.firing().intervals_text == "405-315"
    assert "V-twin 45° at 3000 rpm" in printed(capsys, "balance harley.toml")
    assert "crank_radius = 0.0484  # m, half the stroke\n" in Path("harley.toml").read_text("utf-8")


def test_figures_in_any_unit_are_the_same_engine(capsys: CAPTURE) -> None:
    metric = made(capsys, HARLEY)
    twin = "v-twin --bank-angle 45"
    for line in (
        "--units mm,g --bore 88.9 --stroke 96.8 --rod-length 189 --piston-mass 480 --rod-mass 560",
        "--bore 3.5in --stroke 9.68cm --rod-length 0.189 --piston-mass 0.48kg --rod-mass .56",
    ):
        assert made(capsys, f"{twin} {line}") == metric


def test_a_rod_weighed_end_by_end_or_with_its_centre_of_mass(capsys: CAPTURE) -> None:
    parts = "single --bore 86mm --stroke 86mm --rod-length 145mm --piston-mass 400g"
    ends = made(capsys, f"{parts} --small-end 150g --big-end 450g")
    centre = made(capsys, f"{parts} --rod-mass 600g --rod-centre 36.25mm")
    for engine in (ends, centre):
        # 0.6 kg · 36.25/145 = 0.15 kg; a handful of roundings.
        assert engine.cylinders[0].reciprocating_mass == pytest.approx(0.55, rel=1e-15)
        assert engine.rotating_mass[0] == pytest.approx(0.45, rel=1e-15)
    tenths = made(capsys, f"{parts} --small-end 200g --big-end 555g")
    assert tenths.cylinders[0].rod is not None
    assert tenths.cylinders[0].rod.mass == 0.755
    weighed = made(capsys, f"{parts} --rod-mass 600g --rotating-mass 500g --pin-offset 1mm")
    assert weighed.rotating_mass.tolist() == [0.5]
    assert weighed.cylinders[0].pin_offset == 0.001


def test_a_rod_means_the_same_typed_and_in_python(capsys: CAPTURE) -> None:
    typed = "--bore 86mm --stroke 86mm --rod-length 145mm --piston-mass 400g --rod-mass 600g"
    # The e-book's layouts have a rotating mass, which is that of its own rod.
    for kind in ("single", "i4-ebook"):
        file = made(capsys, f"{kind} {typed} --spacing 100mm")
        built = cp.Engine.preset(kind, cylinder=file.cylinders[0], spacing=0.1)
        assert built == file.replace(source=built.source)
        assert built.rotating_mass.tolist() == pytest.approx([0.4] * len(built), rel=1e-15)


def test_json_and_names(capsys: CAPTURE) -> None:
    printed(capsys, "new boxer-4 --name Flat -o flat.json")
    assert json.loads(Path("flat.json").read_text("utf-8"))["name"] == "Flat"


# --- kinds ----------------------------------------------------------------------------------------


@in_turn("name", cp.presets())
def test_a_preset_is_a_kind(capsys: CAPTURE, name: str) -> None:
    preset = cp.Engine.preset(name)
    # The e-book's rotating mass belongs to its layout, as in Engine.preset(…, cylinder=…).
    assert made(capsys, name) == preset.replace(source="")


LAYOUTS: dict[str, tuple[str, dict[str, Any]]] = {
    "inline": ("--throws 0,360/7 --strokes 2", {"throws_deg": [0, "360/7"], "strokes": 2}),
    "vee": (
        "--bank-angle 75 --throws 0,180 --pin-split -15 --odd-bank left --numbering by-bank",
        {"bank_angle_deg": 75, "throws_deg": [0, 180], "pin_split_deg": -15, "odd_bank": "left",
         "numbering": "by-bank"},
    ),
    "flat": ("--throws 0,180 --bank-stagger 40mm", {"throws_deg": [0, 180], "bank_stagger": 0.04}),
    "boxer": ("--throws 0,120,240 --firing-order 1-6-3-2-5-4",
              {"throws_deg": [0, 120, 240], "firing_order": "1-6-3-2-5-4"}),
    "radial": ("--cylinders 14 --rows 2", {"cylinders": 14, "rows": 2}),
    "firing-order": ("--firing-order 1-3-4-2", {"firing_order": "1-3-4-2"}),
    "lists": ("--tdc 0,120 --banks 90,100 --z 0,80mm",
              {"tdc_deg": [0, 120], "bank_deg": [90, 100], "z": [0, 0.08]}),
    "banks": ("--banks 60,120,180 --throws 0,90",
              {"bank_deg": [60, 120, 180], "throws_deg": [0, 90]}),
    "w": ("--throws 0,180", {"bank_deg": "W", "throws_deg": [0, 180]}),
    "x": ("--throws 0,180", {"bank_deg": "X", "throws_deg": [0, 180]}),
    "opposed-pistons": ("--throws 0,180 --distance 0.9 --lead 25/2 --ratio=-1 --strokes 4",
                        {"throws_deg": [0, 180], "distance": 0.9, "lead_deg": "25/2", "ratio": -1,
                         "strokes": 4}),
    "u": ("--throws 0,180 --distance 300mm --phase 90",
          {"throws_deg": [0, 180], "distance": 0.3, "phase_deg": 90}),
    "square-four": ("--distance 12cm --ratio 1", {"distance": 0.12, "ratio": 1}),
    "h": ("--throws 0 --distance 0.3", {"throws_deg": [0], "distance": 0.3}),
    "compressor": ("--throws 0,180 --crosshead-mass 20kg",
                   {"throws_deg": [0, 180], "crosshead_mass": 20}),
}  # fmt: skip


@pytest.mark.parametrize("kind", BUILDERS)
def test_a_builder_is_a_kind(capsys: CAPTURE, kind: str) -> None:
    typed, arguments = LAYOUTS[kind]
    if kind != "lists":
        typed, arguments = f"{typed} --spacing 0.12", arguments | {"spacing": 0.12}
    build = getattr(cp.Engine, BUILDERS[kind])
    expected = build(CYLINDER, **arguments, rotating_mass=0.4)
    assert made(capsys, f"{kind} {typed} {PARTS}") == expected


def test_side_rods_drive_the_upper_pistons(capsys: CAPTURE) -> None:
    """Figures of the upper pistons follow those of the lower ones."""
    line = (
        "opposed-pistons --one-crankshaft --throws 0,180 --spacing 1.6 --lead 5 --bore 600mm "
        "--stroke 1.4,1.4,1,1 --rod-length 2.4,2.4,2.8,2.8 --firing-order 1-2 "
        "--reciprocating-mass 3500,3501,4900,4901 --rotating-mass 100,101,102,103"
    )
    lower, upper = (
        [cp.Cylinder(radius, rod, mass + k, bore=0.6) for k in (0, 1)]
        for radius, rod, mass in ((0.7, 2.4, 3500), (0.5, 2.8, 4900))
    )
    typed: dict[str, Any] = {
        "throws_deg": [0, 180], "spacing": 1.6, "lead_deg": 5, "firing_order": "1-2",
        "rotating_mass": [100, 101, 102, 103],
    }  # fmt: skip
    expected = cp.Engine.opposed_pistons(lower, upper=upper, one_crankshaft=True, **typed)
    assert made(capsys, line) == expected
    assert expected.rotating_mass.tolist() == [100, 101, 102, 103]
    two = line.replace("--one-crankshaft", "--distance 7")
    assert made(capsys, two) == cp.Engine.opposed_pistons(lower, upper=upper, distance=7, **typed)
    alike = "opposed-pistons --one-crankshaft --throws 0 --spacing 1 --stroke 1 --rod-length 2"
    one = cp.Cylinder(0.5, 2.0, 10)
    assert made(capsys, f"{alike} --reciprocating-mass 10") == cp.Engine.opposed_pistons(
        one, upper=one, throws_deg=[0], spacing=1, one_crankshaft=True
    )
    preset = made(capsys, "opposed-piston-3")
    assert preset.chambers == ((1, 4), (2, 5), (3, 6))
    assert [one.side_rods for one in preset.cylinders] == [False] * 3 + [True] * 3
    assert main(["new", "inline", "--throws", "0", "--one-crankshaft"]) == 2
    assert "--one-crankshaft does not apply to inline: side rods" in capsys.readouterr().err


def test_double_acting_needs_no_rod(capsys: CAPTURE) -> None:
    line = "compressor --throws 0,180 --spacing 0.3 --bore 300mm --stroke 250mm --rod-length 625mm"
    line += " --reciprocating-mass 200 --discharge 4bar"
    both = made(capsys, f"{line} --double-acting")
    one = both.cylinders[0]
    ends = [cp.Cycle.compressor(one, discharge=4e5, end=end) for end in ("head", "crank")]
    assert (both.cycles, both.crank_ends) == ((ends[0],) * 2, (ends[1],) * 2)
    assert not both.rod_diameter.any()
    assert made(capsys, line).crank_ends is None
    assert main(["new", *line.split()[:-2], "--double-acting"]) == 2
    assert "--discharge" in capsys.readouterr().err


def test_lists_have_a_figure_for_each_cylinder(capsys: CAPTURE) -> None:
    common = "--bore 100mm --stroke 90mm --rod-length 150mm --spacing 0.1"
    rods = "--small-end 165g --big-end 410g,411g,410g,410g"
    engine = made(capsys, f"i4 {common} {rods} --piston-mass 590g,591g,589g,590g")
    assert [each.piston_mass for each in engine.cylinders] == [0.590, 0.591, 0.589, 0.590]
    np.testing.assert_allclose(engine.rotating_mass, [0.410, 0.411, 0.410, 0.410], rtol=1e-15)
    vr6 = made(capsys, f"vr6 {common} --reciprocating-mass 500g,501g,500g,500g,500g,500g")
    assert [each.reciprocating_mass for each in vr6.cylinders] == [0.5, 0.501] + [0.5] * 4
    for line, flag in (
        (f"i4 {common} --reciprocating-mass 1,1,1", "cylinder"),
        (f"i4 {common} --piston-mass 1,1 {rods}", "--piston-mass"),
    ):
        assert main(["new", *line.split()]) == 2
        assert flag in capsys.readouterr().err


def test_layouts_as_wide_as_lists(capsys: CAPTURE) -> None:
    v5 = made(capsys, "vee --bank-angle 75.5 --throws 0,104.5,0 --absent 6 --spacing 100mm,110mm")
    assert v5.banks == {"right": (1, 3, 5), "left": (2, 4)}
    np.testing.assert_allclose(v5.z, [0, 0, 0.1, 0.1, 0.21], rtol=1e-15)
    four = made(
        capsys,
        "lists --tdc 0,180,180,0 --banks 90,90,90,90 --z 0,0.1,0,0.1 --cranks=100mm:0:-1 "
        "--crank 0,0,1,1",
    )
    assert "ratio = -1" in four.to_toml()
    assert made(capsys, "v8 --firing-order A1-B4-B2-A2-B3-A3-A4-B1").firing_order == (
        "1-8-4-3-6-5-7-2"
    )
    assert main(["new", "lists", "--tdc", "0", "--banks", "90", "--z", "0", "--cranks", "1"]) == 2
    assert "--cranks" in capsys.readouterr().err


def test_knuckles_of_link_rods(capsys: CAPTURE) -> None:
    sizes = "--stroke 120mm --rod-length 230mm --reciprocating-mass 1kg"
    for typed, rods in (
        ("52mm:178mm", cp.LinkRods(0.052, 0.178)),
        ("52mm:178mm:200g:73,145,217,289",
         cp.LinkRods(0.052, 0.178, [73, 145, 217, 289], 0.2)),
        ("52mm:178mm::equal-stroke", cp.LinkRods(0.052, 0.178, equal="stroke")),
        (":178mm:200g:equal-compression",
         cp.LinkRods(length=0.178, big_end_mass=0.2, equal="compression")),
    ):  # fmt: skip
        five = cp.Engine.radial(cp.Cylinder(0.06, 0.23, 1.0), 5, rods=rods)
        line = f"radial --cylinders 5 {sizes} --link-rods {typed}"
        assert made(capsys, line).link_rods == five.link_rods
    assert 'give "stroke" or "compression"' in refused(
        capsys, f"new radial --cylinders 5 {sizes} --link-rods 52mm:178mm::equal-height"
    )
    for typed, fault in (
        (":178mm", "radius = None"),
        ("52mm:178mm:-4g", "big_end_mass = -0.004"),
        ("52mm:178mm::equal-compression", "radius = 0.052"),
    ):
        said = refused(capsys, f"new radial --cylinders 5 {sizes} --link-rods {typed}")
        assert said.startswith(f"--link-rods = {typed}: {fault}")


def test_cylinders_fire_together(capsys: CAPTURE) -> None:
    for line, order, intervals in [
        (
            f"inline --throws 0,180,180,0 --firing-order 1+4-2+3 {PARTS}",
            "1+4-2+3",
            [0, 180, 0, 540],
        ),
        (f"flat-twin --firing-order 1+2 {PARTS}", "1+2", [0, 720]),
        (f"firing-order --firing-order 1+4-2+3 --strokes 2 {PARTS}", "1+4-2+3", [0, 180, 0, 180]),
    ]:
        engine = made(capsys, line)
        assert engine.firing_order == order
        assert engine.firing_intervals_deg.tolist() == intervals


def test_angles_may_have_their_sign(capsys: CAPTURE) -> None:
    plain, signed = (
        cp.Engine.from_toml(printed(capsys, f"new vee --bank-angle {angle} --throws {throws}"))
        for angle, throws in (("90", "0,180"), ("90°", "0°,180°"))
    )
    assert signed.replace(source="") == plain.replace(source="")


def test_spacing_is_in_proportion_to_the_bore(capsys: CAPTURE) -> None:
    # 100 mm at 86 mm, to three digits.
    assert made(capsys, f"i4 {PARTS}").z.tolist() == pytest.approx([0, 0.116, 0.232, 0.348])
    assert "Spacing 116 mm" in printed(capsys, f"new i4 {PARTS} -o i4.toml")
    assert "Spacing" not in printed(capsys, f"new single {PARTS} -o i1.toml")


@pytest.mark.parametrize(
    ("typed", "split", "even"),
    [
        ("v6 --bank-angle 90", -30.0, True),  # as even as the preset
        ("v6 --bank-angle 360/7", -68.571428571, True),
        ("v6 --bank-angle 90 --pin-split 0", 0.0, False),
        ("v-twin-52 --bank-angle 60", -68.0, False),  # 52 + 76 = 128 as far from even
        ("v8 --bank-angle 60", 0.0, False),  # on shared pins
        ("v8 --bank-angle 60 --pin-split even", -30.0, True),
        ("v-twin --bank-angle 45 --pin-split even", 45.0, True),
        ("vee --bank-angle 45 --throws 0,120,240 --strokes 2 --pin-split even", -15.0, None),
        ("vee --bank-angle 90 --throws 0,72,288,144,216 --pin-split even", 18.0, None),
    ],
)
def test_pin_splits_that_fire_evenly(
    capsys: CAPTURE, typed: str, split: float, even: bool | None
) -> None:
    engine = made(capsys, typed)
    assert engine.pin_split_deg[0] == pytest.approx(split, abs=1e-9)
    if even is not None:
        assert engine.fires_evenly is even
    else:
        assert engine.firing_orders()[0].even


def test_a_firing_order_that_the_crank_does_not_allow_is_dropped(capsys: CAPTURE) -> None:
    said = printed(capsys, "new i4 --throws 0,180,0,180 -o i4.toml")
    assert 'No firing order is known: "crankpin firing" lists those of the crank.' in said
    assert cp.Engine.load("i4.toml").firing_order == ""
    assert cp.Engine.load("i4.toml").name == ""  # not "Inline-4" of the usual crank
    assert made(capsys, "i2-180 --strokes 2").name == ""


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("new v6-75", '"v6-75": no such preset; .* build it by crankpin new v6 --bank-angle 75; '),
        (
            "new v-twin --throws 0,10,20",
            "--throws = 0,10,20: v-twin has 2 cylinders, this makes 6; give 1 crankpin, or ",
        ),
        (
            "new i4 --throws 0,120,240",
            "--throws = 0,120,240: i4 has 4 cylinders, this makes 3; give 4 crankpins, ",
        ),
        ("new radial-7 --cylinders 9", "--cylinders = 9: radial-7 has 7 cylinders, this makes 9"),
        ("new vee --bank-angle 75", "new vee needs --throws; see crankpin new --help"),
        ("new lists --banks 90 --z 0", "new lists needs --tdc or --pins; see crankpin new --help"),
        (
            "new v6 --stroke 80mm --rod-length 150mm --piston-mass 1 --rod-mass 1 --rod-centre .2",
            "--rod-centre = .2: give metres, 0 to length = 0.15",
        ),
        (
            "new v8 --cylinders 8",
            "--cylinders = 8: does not apply to v8, which takes --bank-angle, --throws, ",
        ),
        (
            "new vr6 --throws 0",
            "--throws = 0: does not apply to vr6, which takes --spacing, --firing-order",
        ),
        ("new v6 --stroke 80mm", "a cylinder of your own needs --rod-length"),
        (
            "new v6 --stroke 80mm --rod-length 150mm",
            "a rod needs --rod-mass, or both --small-end and ",
        ),
        (
            "new v6 --stroke 80mm --rod-length 150mm --rod-mass 1 --small-end 1",
            "a rod needs --rod-mass",
        ),
        (
            "new v6 --stroke 80mm --rod-length 150mm --rod-mass 500g",
            "needs --piston-mass, or --reciprocating-mass",
        ),
        (
            "new v6 --stroke 80mm --rod-length 150mm --reciprocating-mass 1 --piston-mass 1",
            "--piston-mass = 1: cannot be combined",
        ),
        (
            "new v6 --stroke 80lb --rod-length 150mm --reciprocating-mass 1",
            "--stroke = 80lb: give a number",
        ),
        ("new v6 --stroke 300mm --rod-length 150mm --reciprocating-mass 1", "rod_length = 0.15"),
        ("new v6 --bank-angle 60/x", "--bank-angle = 60/x: give degrees"),
        ("new v6 -o v6.txt", "--out = 'v6.txt': an engine file ends in .toml or .json"),
        ("new", "the following arguments are required: KIND"),
        ("new harley", "no such preset; builders are inline, vee, flat, boxer, radial, "),
        ("new i4 --firing-order 1-2-3-3", "--firing-order = 1-2-3-3: 3 is there twice"),
        ("new v6 --shared-pins", "--shared-pins does not apply to v6: pins follow from a firing"),
    ],
)
def test_refusals(capsys: CAPTURE, line: str, message: str) -> None:
    assert re.search(re.sub(r"([.(])(?!\*)", r"\\\1", message), refused(capsys, line))
    assert list(Path().iterdir()) == []


@pytest.mark.filterwarnings("default")
def test_warnings_of_a_firing_order_name_options(capsys: CAPTURE) -> None:
    order = "1L-3R-2L-1R-3L-2R"
    line = f"new firing-order --firing-order {order} --bank-angle 60"
    assert main(line.split()) == 0
    out, said = capsys.readouterr()
    assert f"--firing-order = {order}: even firing needs crankpins split by 60°" in said
    assert "shared ones, which --shared-pins gives, fire at 180-60°" in said
    shared = cp.Engine.from_toml(printed(capsys, f"{line} --shared-pins"))
    assert shared.firing().intervals_deg.tolist() == [180, 60] * 3
    assert not shared.pin_split_deg.any()
    assert cp.Engine.from_toml(out).pin_split_deg.any()
    assert main(["new", "firing-order", "--firing-order", "18436572", "--bank-angle", "90"]) == 0
    said = capsys.readouterr().err
    assert '--odd-bank = "right": this firing order needs' in said
    assert "with --odd-bank left pins are shared" in said


# --- what commands find ---------------------------------------------------------------------------


def test_what_is_found_is_saved(capsys: CAPTURE) -> None:
    v6 = cp.Engine.preset("v6-90", rotating_mass=0.3)
    v6.save("v6.toml")
    printed(capsys, "counterweights v6.toml --planes ends --save weights.toml")
    assert cp.Engine.load("weights.toml") == cp.counterweights(v6, planes="ends").fitted
    printed(capsys, "bob-weight v6.toml --factor 52% --oil 4g --save bob.json")
    assert cp.Engine.load("bob.json") == cp.bob_weight(v6, 0.52, 0.004).fitted
    names = ["v6-60", "v6-90", "v6-120"]
    printed(capsys, f"rank {' '.join(names)} --bank-angle own --save best.toml")
    ranked = cp.rank([cp.Engine.preset(name) for name in names], rpm=3000, by="total.moment.peak")
    assert cp.Engine.load("best.toml") == ranked[0].engine


def test_the_design_of_a_place_is_saved(capsys: CAPTURE) -> None:
    line = "design i4 --even-firing --count 3"
    printed(capsys, f"{line} --save first.toml")
    printed(capsys, f"{line} --pick 2 --save second.toml")
    found = cp.design(
        4, layout="inline", cylinder=cp.Engine.preset("i4").cylinders[0], spacing=0.1, rpm=3000,
        even_firing=True, count=3, by="total.moment.peak",
    )  # fmt: skip
    assert cp.Engine.load("first.toml") == found[0].engine
    assert cp.Engine.load("second.toml") == found[1].engine != found[0].engine
    assert "--pick = 0: give the place" in refused(capsys, f"{line} --pick 0")
    assert "--pick = 4: give the place" in refused(capsys, f"{line} --pick 4 --save x.toml")


def test_a_file_that_cannot_be_an_engine_s_is_rejected_first(capsys: CAPTURE) -> None:
    commands = ["counterweights", "bob-weight", "rank", "design", "shafts --ratios=-1"]
    for command in commands:
        line = f"{command} v6-90 --save x.txt"
        assert "--save = 'x.txt': an engine file ends in" in refused(capsys, line)


def test_rods_of_scotch_yokes_are_infinite(capsys: CAPTURE) -> None:
    parts = "--bore 90mm --stroke 90mm --reciprocating-mass 500g"
    engine = made(capsys, f"single {parts} --rod-length inf")
    assert engine.cylinders[0].rod_ratio == 0.0
    assert engine.balance(3000).orders == (1, 2)
    twin = made(capsys, f"boxer-2 {parts} --rod-length inf,150mm")
    assert [one.rod_length for one in twin.cylinders] == [float("inf"), 0.15]
    line = "new single --stroke 90mm --rod-length inf --rod-mass 500g"
    assert refused(capsys, line).startswith("--rod-length = inf: give --reciprocating-mass")
    line = "new single --stroke inf --rod-length 150mm --rod-mass 500g"
    assert refused(capsys, line) == "--stroke = inf: give a finite number"


def test_an_engine_is_told_in_the_units_that_were_typed(capsys: CAPTURE) -> None:
    typed = ["new", "single", "--bore", '3 1/2"', "--stroke", '3 13/16"', "--rod-length", '7 7/16"']
    typed += ["--piston-mass", "17oz", "--rod-mass", "1 1/4lb", "-o", "single.toml", "--force"]
    assert main(typed) == 0
    told = capsys.readouterr().out
    assert "stroke 3.8125 in, rod 7.4375 in, reciprocating mass 23.6667 oz" in told
    assert main([*typed, "--units", "mm,g"]) == 0
    told = capsys.readouterr().out
    assert "stroke 96.8375 mm, rod 188.913 mm, reciprocating mass 670.939 g" in told


# --- on mounts ------------------------------------------------------------------------------------


def test_a_body_and_all_that_mounts_have(capsys: CAPTURE) -> None:
    Path("rubber.csv").write_text("Hz,re,im\n1,1e5,1e4\n100,2e5,3e4\n")
    rows = [
        [hertz, *(part for k in range(3) for part in ((k + 1) * f, 0.1 * f))]
        for hertz, f in ((1, 1e5), (9, 2e5))
    ]
    lines = [",".join(map(str, row)) for row in rows]
    Path("each.csv").write_text("\n".join(["Hz,a,b,c,d,e,f", *lines]))
    bushing = "rotation=200,100,50:rotation-damping=1,2,3:rotation-loss=0.05:damping=150,200,150"
    mounts = [
        f"right:0.28,0,-0.09:220000,80000,80000:0.1,0.2,0.3:tilt=45:{bushing}",
        "left:-0.28,0,-0.09:2e5:dynamic=3e5,1e5,1e5:axes=0,1,0,-1,0,0,0,0,1",
        "front:0,-0.1,-0.3:1e5:track=1.8e5,10,0.25:rotation=70",
        "rear:0,-0.12,0.55:1e5:table=rubber.csv",
        "low:0,-0.3,0.55:1e5:table=each.csv",
        "stop:0,-0.3,0.2:1e5:gap=0.01,0.02,0.01,0.02,0.01,0.01:snubber=9e5,9e5,0",
    ]
    typed = " ".join(f"--mount {mount}" for mount in mounts)
    body = "148:20mm,70mm,90mm:8.1,7.6,4.9,0.1,-0.2,0.3:tensor"
    said = printed(capsys, f"new i4 --body {body} {typed} -o car.toml")
    assert said.endswith("Written to car.toml: try crankpin mounts car.toml\n")
    found = cp.Powertrain.load("car.toml")
    inertia = [[8.1, 0.1, -0.2], [0.1, 7.6, 0.3], [-0.2, 0.3, 4.9]]
    assert found.body == cp.RigidBody(148, (0.02, 0.07, 0.09), inertia, products="tensor")
    table = ([1.0, 100.0], np.repeat([[1e5 + 1e4j], [2e5 + 3e4j]], 3, axis=1))
    each = ([1.0, 9.0], [[(k + 1) * f + 0.1j * f for k in range(3)] for f in (1e5, 2e5)])
    assert found.mounts == (
        cp.Mount(
            "right", (0.28, 0, -0.09), (2.2e5, 8e4, 8e4), 45.0, loss_factor=(0.1, 0.2, 0.3),
            damping=(150, 200, 150), rotational_stiffness=(200, 100, 50),
            rotational_loss_factor=0.05, rotational_damping=(1, 2, 3),
        ),
        cp.Mount(
            "left", (-0.28, 0, -0.09), 2e5, axes=[[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
            dynamic_stiffness=(3e5, 1e5, 1e5),
        ),
        cp.Mount("front", (0, -0.1, -0.3), 1e5, track=cp.InertiaTrack(1.8e5, 10, 0.25),
                 rotational_stiffness=70),
        cp.Mount("rear", (0, -0.12, 0.55), 1e5, table=table),
        cp.Mount("low", (0, -0.3, 0.55), 1e5, table=each),
        cp.Mount("stop", (0, -0.3, 0.2), 1e5, gap=[(0.01, 0.02), (0.01, 0.02), 0.01],
                 snubber_stiffness=[9e5, 9e5, 0]),
    )  # fmt: skip
    Path("again.toml").write_text(printed(capsys, f"new i4 --body {body} {typed}"), "utf-8")
    assert cp.Powertrain.load("again.toml").replace(engine=found.engine) == found
    integrals = body.replace("tensor", "positive-integrals")
    printed(capsys, f"new i4 --body {integrals} {typed} -o other.toml")
    assert cp.Powertrain.load("other.toml").body.inertia[0][2] == 0.2
    assert "N·m/rad" in printed(capsys, "mounts car.toml --frequency 5 --frame mounts")


@pytest.mark.parametrize(
    ("body", "mount", "said"),
    [
        ("1:0,0,0:1,1", "a:0,0,0:1e5", "--body = 1:0,0,0:1,1: give MASS:X,Y,Z:IX,IY,IZ or"),
        ("1:0,0,0:1,1,1:tensor", "a:0,0,0:1e5", "--body = 1:0,0,0:1,1,1:tensor: give MASS"),
        ("1:0,0,0:1,1,1,0.1,0,0", "a:0,0,0:1e5", "products = None"),
        ("1:0,0,0:1,1,1", "a:0,0,0", "--mount = a:0,0,0: give NAME:X,Y,Z:K"),
        ("1:0,0,0:1,1,1", "a:0,0,0:1e5:bounce=3", "give fields of tilt, axes, dynamic, damping"),
        ("1:0,0,0:1,1,1", "a:0,0,0:1e5:axes=1,0,0", "give 9 numbers of axes"),
        ("1:0,0,0:1,1,1", "a:0,0,0:1e5:damping=1,2", "give 3 numbers of damping"),
        ("1:0,0,0:1,1,1", "a:0,0,0:1e5:table=none.csv", "none.csv"),
        ("1:0,0,0:1,1,1", "a:0,0,0:1e5:rotation=-1", "rotational_stiffness"),
    ],
)
def test_bodies_and_mounts_that_are_none_are_named(
    capsys: CAPTURE, body: str, mount: str, said: str
) -> None:
    assert said in refused(capsys, f"new i4 --body {body} --mount {mount}")
