"""Do commands read the units that people type, and print in those asked for?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin.cli import ORDER, main, registered
from crankpin.cli.options import Parser
from support import in_turn
from support.shown_units import IMPERIAL, si_units

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]
LINES = {
    "new": "new v6 --bore 96.5mm --stroke 86.4mm --rod-length 148.5mm --piston-mass 590g "
    "--rod-mass 560g -o v6.toml",
    "balance": "balance v8-crossplane --rpm 6000",
    "explain": "explain v8-crossplane --rpm 6000",
    "compare": "compare i4 i4-crossplane --rpm 6000",
    "flywheel": "flywheel i4 --rpm 800 --irregularity 2% --bore 86mm",
    "foundation": "foundation marine-5 --rpm 210",
    "guide-moments": "guide-moments marine-5 --rpm 210 --length 2.4m",
    "locomotive": "locomotive --stroke 600mm --reciprocating-mass 300kg --z=-350mm,350mm "
    "--throws 0,90 --wheels=-800mm,800mm --share 66% --rpm 280",
    "two-plane": "two-plane --amounts 5oz·in,3 --angles 35,310 --measured 0,335mm --correct=-1,20 "
    "--radius 70mm",
    "match": "match v8-crossplane --pistons 470g,473g,471g,469g,474g,470g,467g,472g",
    "closed-form": "closed-form i3",
    "harmonics": "harmonics --stroke 86mm --rod-length 145mm --pin-offset 0.04",
    "sweep": "sweep i4 --rpm 1000,2000 --quantity force",
    "rank": "rank i4 i6 --by total.force.peak",
    "torque": "torque i4 --rpm 1500 --bore 86mm",
    "bearings": "bearings i4 --rpm 6000",
    "rod-load": "rod-load i4 --rpm 6000",
    "mounts": "mounts car.toml --rpm 2000",
    "mounts-fit": "mounts-fit car.toml --stiffness 50000,1000000 --starts 1",
    "counterweights": "counterweights v8-crossplane --planes ends",
    "bob-weight": "bob-weight v8-crossplane --rotating-mass 550g --oil 4g",
    "card": "card v8-crossplane --piston 470g --planes ends --radius 70mm --oil 4g",
    "shafts": "shafts i4 --ratios 2,-2 --x 0.08m,-0.08m",
    "design": "design i4 --by total.force.peak --count 3",
    "tolerances": "tolerances i4 --rpm 6000 --reciprocating-mass 2g --samples 100",
}
"""A line of each command with ``--units`` that prints numbers; ``view`` writes a page."""


def has_units(name: str) -> bool:
    """Whether a command takes ``--units``."""
    commands = Parser().add_subparsers()
    registered([name])[name](commands)
    return "--units" in commands.choices[name]._option_string_actions


def run(capsys: CAPTURE, *argv: str) -> str:
    """What a run that succeeds prints."""
    assert main(argv) == 0
    return capsys.readouterr().out


def car(folder: Path) -> None:
    """Write an engine on three mounts."""
    engine = cp.Engine.preset("i4")
    mounts = [
        cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1)
        for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
    ]
    body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
    cp.Powertrain(engine, body, mounts).save(folder / "car.toml")


def test_every_command_that_prints_numbers_has_a_line() -> None:
    of_files = {"view", "trace"}  # a page, and a measured file, which test_loads has
    assert {name for name in ORDER if has_units(name)} - of_files == {*LINES}


@in_turn("name", LINES)
def test_nothing_is_printed_in_other_units(
    capsys: CAPTURE, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if name.startswith("mounts"):
        car(tmp_path)
    typed = [*LINES[name].split(), "--units", IMPERIAL.replace(" ", "")]
    frames = [[], ["--csv"]] if name not in ("new", "explain", "closed-form") else [[]]
    for more in frames:
        for line in run(capsys, *typed, *more).splitlines():
            assert not si_units(line), line


@pytest.mark.parametrize(
    ("typed", "metres"),
    [
        ('3.5"', 0.0889), ("88.9MM", 0.0889), ("88.9 mm", 0.0889), ("3.5inches", 0.0889),
        ("8.89CM", 0.0889), ("88,9mm", 0.0889),
    ],
)  # fmt: skip
def test_lengths_as_people_type_them(capsys: CAPTURE, typed: str, metres: float) -> None:
    argv = ["new", "single", "--bore", typed, "--stroke", "80mm", "--rod-length", "150mm"]
    assert main([*argv, "--piston-mass", "1.06lbs", "--rod-mass", "560gm"]) == 0
    out, err = capsys.readouterr()
    engine = cp.Engine.from_toml(out)
    assert engine.cylinders[0].bore == metres
    point = typed.replace(",", ".")
    assert err == (f"crankpin: --bore {typed} is read as {point}\n" if "," in typed else "")
    piston = engine.cylinders[0].piston_mass
    assert piston is not None
    assert piston == pytest.approx(1.06 * 0.45359237, rel=1e-15)


def test_a_list_in_which_a_comma_may_be_a_point_is_refused(capsys: CAPTURE) -> None:
    assert main(["card", "i4", "--piston", "470,500g"]) == 2
    assert "write 470.500g, or the unit behind both" in capsys.readouterr().err
    assert main(["card", "i4", "--piston", "470,5g"]) == 0
    assert capsys.readouterr().err == "crankpin: --piston 470,5g is read as 470.5g\n"
    assert main(["counterweights", "i4", "--planes", "0,200mm"]) == 0  # zero needs no unit


def test_an_echo_repeats_what_was_typed(capsys: CAPTURE) -> None:
    line = ["sweep", "v6-60", "--bank-angle", "50,60", "--reference-z"]
    assert "about z = 3.5in" in run(capsys, *line, "3.5in")
    assert "about z = 3.5 in" in run(capsys, *line, "3.5", "--units", "in")
    assert "about z = 0.0889 m" in run(capsys, *line, "0.0889")
    spectrum = [*line[:-1], "--spectrum", "1=9.0"]
    assert "spectrum 1=9.0 oz·in" in run(capsys, *spectrum, "--units", "oz,in")


def test_a_card_in_ounces_by_hand(capsys: CAPTURE) -> None:
    """A pound is 16 ounces, and 453.59237 g: 450 g are 15.873 oz."""
    out = run(capsys, "card", "single", "--piston", "450g", "--units", "oz,in")
    row = next(line for line in out.splitlines() if line.startswith("piston"))
    assert re.split(r"\s{2,}", row)[-1] == "15.87"
