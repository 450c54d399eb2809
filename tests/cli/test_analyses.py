"""Do the commands on comparisons, flywheels, stars and formulas print the library's numbers?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def _agg() -> None:
    mpl.use("agg")


def printed(capsys: CAPTURE, line: str) -> str:
    """What a run that succeeds prints."""
    assert main(line.split()) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: CAPTURE, line: str) -> str:
    """What a run that fails says."""
    assert main(line.split()) == 2
    return capsys.readouterr().err.removeprefix("crankpin: error: ")


def test_compare(capsys: CAPTURE, tmp_path: Path) -> None:
    before, after = (cp.Engine.preset(name) for name in ("i4", "i4-crossplane"))
    comparison = cp.compare(before, after, rpm=6000)
    picture = tmp_path / "both.png"
    line = f"compare i4 i4-crossplane --rpm 6000 --plot {picture}"
    assert printed(capsys, line) == f"{comparison.frames.text()}\n"
    assert picture.stat().st_size > 10_000
    assert "give two" in refused(capsys, "compare i4")


def test_flywheel(capsys: CAPTURE) -> None:
    cylinder = cp.Engine.preset("i4").cylinders[0].replace(bore=0.086)
    i4 = cp.Engine.preset("i4").replace(cylinder=cylinder).with_cycle(cp.Cycle.example())
    found = cp.flywheel(i4, rpm=800, irregularity=0.02)
    line = "flywheel i4 --rpm 800 --bore 86mm --cycle petrol"
    assert printed(capsys, f"{line} --irregularity 2%") == f"{found.frames.text()}\n"
    (row,) = (
        each.split()
        for each in printed(capsys, f"{line} --inertia 8000lb·in²").splitlines()
        if each.startswith("moment of inertia")
    )
    assert row[-2:] == [f"{8000 * 0.45359237 * 0.0254**2:.6g}", "kg·m²"]
    assert "inertia" in refused(capsys, line)


def test_star(capsys: CAPTURE) -> None:
    shape = [1, 0.95, 0.86, 0.73, 0.57, 0.39]
    star = cp.star_diagram(cp.Engine.preset("i6"), [0.5, 3], mode_shape=shape)
    line = "star i6 --orders 0.5,3 --mode-shape 1,0.95,0.86,0.73,0.57,0.39"
    assert printed(capsys, line) == f"{star.frames.text()}\n"
    assert printed(capsys, "star i4") == f"{cp.star_diagram(cp.Engine.preset('i4'))}\n"


def test_closed_form(capsys: CAPTURE) -> None:
    pytest.importorskip("sympy")
    form = cp.Engine.preset("i3").closed_form(1)
    assert printed(capsys, "closed-form i3") == f"{form!r}\n"
    force = cp.Engine.preset("i4").closed_form(2, "force")
    assert printed(capsys, "closed-form i4 --order 2 --quantity force") == f"{force!r}\n"


def test_harmonics(capsys: CAPTURE) -> None:
    """a₂ of λ = 0.5 is 0.53555286 (to eight digits, from 50-digit arithmetic)."""
    rows = printed(capsys, "harmonics 0.5 --orders 1,2,4 --csv").splitlines()
    assert rows[0] == "order,amplitude,phase °"
    second, fourth = (row.split(",") for row in rows[2:])
    assert float(second[1]) == pytest.approx(0.53555286, abs=5e-9)
    assert float(fourth[1]) == pytest.approx(0.03842615, abs=5e-9)
    assert float(fourth[2]) == 180.0
    same = "harmonics --stroke 80mm --rod-length 80mm --orders 1,2,4 --csv"
    assert printed(capsys, same).splitlines() == rows
    cylinder = cp.Cylinder(0.043, 0.145, 1.0, 0.001)
    offset = printed(capsys, "harmonics --stroke 86mm --rod-length 145mm --pin-offset 1mm --csv")
    for row, value in zip(
        offset.splitlines()[1:], abs(cylinder.harmonics([*range(1, 13)])), strict=True
    ):
        assert float(row.split(",")[1]) == pytest.approx(value, rel=1e-12)
    assert float(printed(capsys, "harmonics 1/3.5 --csv").splitlines()[2].split(",")[1]) == (
        pytest.approx(cp.slider_crank_harmonics(1 / 3.5, 2)[0], rel=1e-15)
    )
    for line in ("harmonics", "harmonics 0.3 --stroke 1 --rod-length 2", "harmonics 1/0"):
        assert "RATIO" in refused(capsys, line)
    assert "--pin-offset" in refused(capsys, "harmonics 0.3 --pin-offset 1mm")


def test_exercise(capsys: CAPTURE) -> None:
    sheet = cp.exercise("v-angle", seed=7)
    assert printed(capsys, "exercise v-angle --seed 7") == f"{sheet}\n"
    both = printed(capsys, "exercise v-angle --seed 7 --solution")
    assert both == f"{sheet}\n\n{sheet.solution}\n"
    assert refused(capsys, "exercise v-angel").startswith("TOPIC = 'v-angel': give \"single\"")
    assert "--seed" in refused(capsys, "exercise single --seed 1.5")


def test_a_plain_inertia_is_in_the_unit_of_the_help_whatever_the_others(capsys: CAPTURE) -> None:
    line = "flywheel i4 --rpm 800 --bore 86mm --frame table --csv --inertia"
    main(f"{line} 0.15 --units g,mm".split())
    plain = capsys.readouterr().out
    main(f"{line} 150000kg·mm² --units g,mm".split())
    assert capsys.readouterr().out == plain
    main(f"{line} 0.15".split())
    irregularity = [text for text in capsys.readouterr().out.splitlines() if "irregul" in text]
    assert irregularity[0] in plain


def test_a_preset_is_compared_with_itself_as_textbooks_lump_it(capsys: CAPTURE) -> None:
    comparison = cp.compare(cp.Engine.preset("v6-60-ebook"), "lumped", 10, orders=[1, 2])
    line = "compare v6-60-ebook lumped --rpm 10 --orders 1,2"
    assert printed(capsys, line) == f"{comparison.frames.text()}\n"
    assert refused(capsys, f"{line} --spectrum 1=9.0").startswith("--spectrum = ")
    uneven = cp.Engine.preset("i4", rotating_mass=[0.1, 0.2, 0.1, 0.1])
    with pytest.raises(cp.InputError, match="has cylinders that differ"):
        cp.compare(uneven, "lumped", 3000)
    with pytest.raises(cp.InputError, match="lumped"):
        cp.compare(uneven, "lumpd", 3000)  # type: ignore[arg-type]


DIAGRAM = "flywheel --areas 52,-124,92,-140,85,-72,107 --torque-scale 600 --angle-scale 3"


def test_flywheels_without_an_engine(capsys: CAPTURE, tmp_path: Path) -> None:
    text = printed(
        capsys, f"{DIAGRAM} --rpm 600 --irregularity 3% --mean-diameter 1 --width-ratio 2"
    )
    diagram = cp.turning_moment_areas(
        [52, -124, 92, -140, 85, -72, 107], torque_scale=600, angle_scale_deg=3, rpm=600,
        irregularity=0.03,
    )  # fmt: skip
    rim = cp.flywheel_rim(diagram.inertia or 0.0, mean_diameter=1, rpm=600, width_ratio=2)
    assert text.strip() == f"{diagram}\n\n{rim}"
    table = tmp_path / "torque.csv"
    theta = np.arange(0.0, 720.0)
    torque = 5000 + 600 * np.sin(np.radians(2 * theta))
    rows = "\n".join(f"{a},{t}" for a, t in zip(theta, torque, strict=True))
    table.write_text(f"angle [deg],torque [N·m]\n{rows}\n")
    wheel = cp.flywheel((theta, torque), 150, load_torque="5000 + 500 sin θ", inertia=80)
    machine = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.45, bore=0.086))
    machine = machine.with_cycle(cp.Cycle.example())
    machine.save(tmp_path / "machine.toml")
    path = tmp_path / "machine.toml"
    line = f"flywheel {path} --rpm 800 --inertia 0.3 --load {path}"
    both = cp.flywheel(machine, 800, load_torque=machine, inertia=0.3)
    assert printed(capsys, line).strip() == str(both)
    line = f"flywheel --drive {table} --load 5000+500sin(θ) --rpm 150 --inertia 80"
    assert printed(capsys, line).strip() == str(wheel)
    work = cp.stroke_load(500, duration_deg=40, start_deg=10, period_deg=720)
    punch = cp.flywheel(None, 60, load_torque=work, irregularity=0.1)
    text = printed(
        capsys, "flywheel --stroke-load 500,40,10,720 --rpm 60 --irregularity 10% --frame table"
    )
    assert text.strip() == punch.table.text()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("flywheel --rpm 600 --inertia 1", "NAME is missing"),
        (f"{DIAGRAM} i4", "NAME = i4: leave it out"),
        (f"{DIAGRAM} --load 5", "--load = .*leave out --areas"),
        (f"{DIAGRAM} --bore 86mm", "--bore = 86mm: leave it out: it needs an engine"),
        (f"{DIAGRAM} --mean-diameter 1", "--irregularity is missing"),
        ("flywheel --load 5 --tdc 4 --inertia 1", "--tdc = 4: leave it out"),
        ("flywheel i4 --drive 5 --inertia 1", "--drive = 5: leave it out"),
        ("flywheel i4 --spread --inertia 1", "--areas is missing"),
        ("flywheel --stroke-load 5 --inertia 1", "give E,DURATION"),
        ("flywheel --load x --inertia 1", "--load = 'x': give terms"),
    ],
)
def test_flywheels_that_cannot_be(capsys: CAPTURE, words: str, message: str) -> None:
    assert re.search(message, refused(capsys, words))
