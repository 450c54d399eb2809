"""Do the commands of a balancing shop print the library's numbers?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

PARTS = {
    "piston": 0.470, "pin": 0.118, "locks": 0.002, "rings": 0.060, "small end": 0.180,
    "big end": 0.430, "bearings": 0.042,
}  # fmt: skip
TYPED = (
    "--piston 470g --pin 118g --locks 2g --rings 60g --small-end 180g --big-end 430g "
    "--bearings 42g --oil 4g"
)


def printed(capsys: pytest.CaptureFixture[str], line: str) -> str:
    """What a run that succeeds prints."""
    assert main(line.split()) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: pytest.CaptureFixture[str], line: str) -> str:
    """What a run that fails says."""
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    return err.removeprefix("crankpin: error: ")


def test_the_card_is_that_of_the_library(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    page, other = tmp_path / "card.html", tmp_path / "other.html"
    found = printed(
        capsys,
        f"card v8-crossplane {TYPED} --factor 48%,50%,52% --rpm 6000 --planes ends "
        f"--radius 70mm --balanced-to 1850g -o {page}",
    )
    bob = cp.bob_weight(cp.Engine.preset("v8-crossplane"), 0.48, 0.004, parts=PARTS)
    card = bob.card([0.48, 0.5, 0.52], rpm=6000, planes="ends", radius=0.07, balanced_to=1.85)
    assert found == f"{card.frames.text()}\nWritten to {page}: print it in a browser.\n"
    card.save_html(other)
    assert page.read_text() == other.read_text()


def test_cards_of_parts_that_differ_and_of_an_engine_alone(
    capsys: pytest.CaptureFixture[str],
) -> None:
    found = printed(capsys, "card i4 --piston 470g,471g,469g,470g --sides exhaust,intake --csv")
    bob = cp.bob_weight(cp.Engine.preset("i4"), parts={"piston": [0.470, 0.471, 0.469, 0.470]})
    assert found == bob.card().to_csv()
    assert printed(capsys, "card i4 --frame residual").startswith("What order 1 leaves")


def test_cards_that_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert "52 % is 0.52" in refused(capsys, "card i4 --factor 52")
    assert "--planes" in refused(capsys, "card i4 --radius 70mm")
    assert "--planes" in refused(capsys, "card i4 --frame correction")
    assert "--sides" in refused(capsys, "card i4 --sides exhaust")
    assert "--piston" in refused(capsys, "card i4 --piston 470g,471g")


def test_directions_are_in_words_of_the_sides_given(capsys: pytest.CaptureFixture[str]) -> None:
    """A vee along the frame of a motorcycle: what is across it goes from front to rear."""
    for sides, across in {"": "sideways", " --sides rear,front": "front to rear"}.items():
        found = printed(capsys, f"card v-twin-45 --factor 100%{sides}")
        assert found.count(f"  {across}\n") == 2
        assert ("sideways" in found) == (not sides)


def test_two_planes_are_those_of_the_library(capsys: pytest.CaptureFixture[str]) -> None:
    """57.1 g at 70 mm are 3997.5 g·mm, and 4200 g·mm are 5.8327 oz·in."""
    places = "--angles 35,310 --measured 0,335mm --correct=-20mm,360mm"
    fix = cp.two_plane_correction(
        [4200, 2600], [35, 310], measured_z=[0, 0.335], correction_z=[-0.02, 0.36]
    )
    assert printed(capsys, f"two-plane --amounts 4200,2600 {places}") == f"{fix.table.text()}\n"
    weighted = printed(capsys, f"two-plane --amounts 4200,2600 {places} --radius 70mm --csv")
    grams = [float(row.rpartition(",")[2]) for row in weighted.splitlines()[1:]]
    assert grams == [each / 70.0 for each in fix.amount_g_mm]
    imperial = printed(
        capsys, f"two-plane --amounts 5.8327oz·in,2600g·mm {places} --units in,oz --csv"
    )
    amount = float(imperial.splitlines()[1].split(",")[2])
    # As typed, to five digits; an ounce inch is 720.077887375 g·mm.
    np.testing.assert_allclose(amount * 720.077887375, fix.amount_g_mm[0], rtol=1e-5)
    assert "--radius" in refused(capsys, f"two-plane --amounts 1,2 {places} --radius 0")


def test_matched_parts_are_those_of_the_library(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "matched.toml"
    masses = [0.402, 0.398, 0.405, 0.401]
    found = printed(capsys, f"match i4 --pistons 402g,398g,405g,401g --save {file}")
    match = cp.match_parts(cp.Engine.preset("i4"), masses)
    assert found == f"{match.frames.text()}\n"
    assert cp.Engine.load(file) == match.engines[0]
    rods = "--small-ends 0.2,0.2,0.201,0.2 --big-ends 0.4,0.41,0.4,0.4"
    both = printed(capsys, f"match i4 --pistons 402g,398g,405g,401g {rods} --by spread")
    ends = [(0.2, 0.4), (0.2, 0.41), (0.201, 0.4), (0.2, 0.4)]
    match = cp.match_parts(cp.Engine.preset("i4"), masses, ends, by="spread")
    assert both == f"{match.frames.text()}\n"
    assert "--big-ends" in refused(capsys, "match i4 --pistons 1,1,1,1 --small-ends 1,1,1,1")


@pytest.mark.filterwarnings("default:pistons")
def test_errors_name_what_was_typed(capsys: pytest.CaptureFixture[str]) -> None:
    v8 = "v8-crossplane"
    two = "--measured 0,0.3 --correct=-0.1,0.4"
    masses = ",".join(f"{each}" for each in (828, 833, 831, 829, 834, 830, 827, 832))
    for typed, said in (
        (f"two-plane --amounts 4200,2600 --angles 35 {two}", "--angles has 1 figure: give two"),
        (f"two-plane --amounts=-1,2 --angles 35,36 {two}", "--amounts = -1,2: give zero or more"),
        (
            f"match {v8} --pistons {masses} --units g --big-ends {masses}",
            "--small-ends is left out: ",
        ),
        (f"firing {v8} --firing-order L1-R2-L4", "--firing-order = L1-R2-L4: name each of"),
        (f"compare {v8}", "NAME stands for 1 engine: "),
        ("new radial --cylinders 9 --rows 2", "--cylinders = 9: give a multiple of rows, 2"),
        (f"flywheel {v8}", "--irregularity is left out: give one of --inertia …"),
        ("new v8 --bore 4in --stroke 3in --rod-length 6in", "--rod-mass is left out: "),
        ("balance v8.tml", 'NAME = "v8.tml": no such preset; crankpin new makes'),
    ):
        assert refused(capsys, typed).startswith(said)
    assert main(f"match {v8} --pistons {masses}".split()) == 2
    assert "--pistons = 827.0: the lightest is 3.5 kg below" in capsys.readouterr().err
    line = printed(capsys, "closed-form single --order 1").splitlines()[0]
    assert line == "Single: shaking force of order 1"
