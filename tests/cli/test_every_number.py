"""Is every number that any command takes read in one way, or rejected by its option's name?

Options are those of the parsers; what is no number is listed, so that a new option is tried too.
"""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import crankpin as cp
import numpy as np
import pytest
from cli.test_help_of_layouts import SOUND as OF_PARTS
from cli.test_units_printed import LINES, car
from crankpin.cli import ORDER, main, registered
from crankpin.cli.options import Parser
from support import in_turn

CAPTURE = pytest.CaptureFixture[str]
WORDS = {
    "--name", "--units", "--out", "--plot", "--save", "--html", "--motored", "--cycle", "--sheet",
    "--pressure-unit", "--controls", "--columns", "--sides", "--vary", "--by", "--firing-order",
    "--odd-bank", "--numbering", "--target", "--add-load", "--drive", "--load",
    "--pressure", "--encoder", "--pulses", "--index", "--time",
}  # fmt: skip
"""Options that are names, files and sequences, no numbers."""
NAMES = {
    ("mounts", "--case"), ("mounts", "--rest"), ("mounts", "--base"), ("mounts", "--axes"),
    ("new", "--axes"), ("mounts", "--mount"), ("new", "--mount"),
    ("new", "--body"), ("new", "--cranks"),
    ("new", "--link-rods"), ("new", "--master"),
    ("trace", "--leave-out"), ("trace", "--recorded-rpm"), ("trace", "--sampling-rate"),
}  # fmt: skip
"""Options that are so in one command, of fields, or of files with several cycles."""
BASE = LINES | {
    "new": "new lists --tdc 0,90 --banks 60,120 --z 0,0.1",
    "presets": "presets",
    "firing": "firing i4",
    "star": "star i4",
    "trace": "trace i4 run.csv --bore 86mm",
    "exercise": "exercise single",
    "view": "view i4 -o view.html",
    "gallery": "gallery -o gallery",
    "design": "design i2-360 --by total.force.peak --count 1",
    "mounts": "mounts car.toml",
    "tolerances": "tolerances i4 --z 1mm --samples 20 --orders 1,2",
    "sweep": "sweep v6-60 --rpm 1000 --orders 1,2",
    "torque": "torque i4 --bore 86mm --orders 1,2",
}
"""A line of each command, to which the option is added."""
VALUES = {
    "--rpm": "2000", "--orders": "1,2", "--rtol": "1e-3", "--reference-z": "10mm",
    "--about": "0,10mm,100mm", "--spectrum": "1=9.0,2=3.75", "--bank-angle": "60:70:10",
    "--rod-ratio": "0.2,0.3", "--pin-offset": "1mm", "--mode-shape": "1,0.5,0.5,1",
    "--bore": "86mm", "--crankcase": "1bar", "--atmosphere": "1.01bar --cycle run.csv",
    "--recorded-rpm": "1500 --cycle times.csv", "--tdc": "1 --cycle run.csv",
    "--loss-angle": "0.6 --motored run.csv", "--lowpass-order": "100",
    "--intake-pressure": "0.95bar", "--leave-out": "0", "--exponent": "1.3",
    "--compression-ratio": "10", "--inertia": "0.2", "--irregularity": "2%",
    "--frequency": "10", "--torque": "50", "--gear": "3.5", "--gravity": "0,-9.8,0",
    "--robustness": "0.1", "--misfire": "2", "--at": "0,0.1,0 --rpm 2000",
    "--stiffness": "50000,1000000", "--tilt": "10", "--x": "10mm", "--y": "10mm", "--z": "10mm",
    "--ratio": "1,10", "--modes-between": "1,90", "--roll-frequency": "12", "--starts": "1",
    "--seed": "3", "--planes": "0,0.2", "--factor": "40%", "--bound": "0.2",
    "--angles": "0,90,180,270", "--rotating-mass": "400g", "--reciprocating-mass": "450g",
    "--oil": "3g", "--piston": "400g", "--pin": "90g", "--locks": "2g", "--rings": "40g",
    "--small-end": "150g", "--big-end": "400g", "--radius": "70mm",
    "--balanced-to": "1.2kg", "--amounts": "5,3", "--measured": "0,335mm",
    "--correct": "-20mm,360mm", "--pistons": "0.45,0.46,0.45,0.47", "--sets": "1",
    "--small-ends": "0.1,0.1,0.1,0.1 --big-ends 0.3,0.3,0.3,0.3",
    "--big-ends": "0.3,0.3,0.3,0.3 --small-ends 0.1,0.1,0.1,0.1", "--ratios": "2,-2",
    "--bearings": "0,0.3", "--cylinders": "2", "--pin-split": "-30", "--throws": "0,180",
    "--intervals": "360,360", "--shafts": "1", "--count": "2", "--pick": "1", "--samples": "50",
    "--crank-radius": "0.01mm", "--rod-length": "0.01mm", "--order": "2",
    "--stroke": "86mm --rod-length 145mm", "--banks": "60,120", "--strokes": "4", "--crank": "0,0",
    "--dummy": "2", "--pins": "60,30", "--mean-diameter": "1m", "--stroke-load": "500,40",
    "--cylinder": "1",
    "--width-ratio": "2 --mean-diameter 1m", "--width": "100mm --mean-diameter 1m",
    "--thickness": "30mm --mean-diameter 1m", "--share": "95% --mean-diameter 1m",
    "--vertical": "180", "--length": "2.4m", "--wheels": "-0.8,0.8", "--inclination": "5,5",
    "--wheel-diameter": "1.7m", "--axles": "0,1.9m", "--driving": "1,1", "--wheel-load": "70kN",
    "--density": "7850 --mean-diameter 1m", "--rim-speed": "25", "--hoop-stress": "4MPa",
}  # fmt: skip
"""A sound value of each option, with what it needs beside it."""
ENGINE_OF_A_LOCOMOTIVE = (
    "--stroke 600mm --reciprocating-mass 300kg --z=-350mm,350mm --throws 0,90 --wheels=-800mm,800mm"
)
COMPRESSOR = (
    "compressor --throws 0,180 --bore 80mm --stroke 80mm --rod-length 140mm --piston-mass 400g "
    "--rod-mass 500g"
)
ON_SOIL = "marine-5 --rpm 210 --block 4,2.5,9 --soil 6e7"
IN_PLACE = {
    ("new", "--suction"): f"{COMPRESSOR} --discharge 4bar --suction 1bar",
    ("new", "--discharge"): f"{COMPRESSOR} --discharge 4bar",
    ("new", "--clearance"): f"{COMPRESSOR} --discharge 4bar --clearance 0.15",
    ("new", "--exponent"): f"{COMPRESSOR} --discharge 4bar --exponent 1.25",
    ("new", "--rod-diameter"): f"{COMPRESSOR} --discharge 4bar --rod-diameter 10mm",
    ("new", "--crosshead-mass"): f"{COMPRESSOR} --crosshead-mass 0.3",
    ("new", "--bank-angle"): "vee --throws 0,90 --bank-angle 60",
    ("new", "--throws"): "inline --throws 0,180",
    ("new", "--pin-split"): "v6 --pin-split 10",
    ("new", "--spacing"): "i3 --spacing 90mm",
    ("new", "--bank-stagger"): "v6 --bank-stagger 20mm",
    ("new", "--absent"): "v8 --absent 7,8",
    ("new", "--cylinders"): "radial --cylinders 5",
    ("new", "--rows"): "radial-14 --rows 2",
    ("new", "--distance"): "square-four --distance 10cm",
    ("new", "--ratio"): "square-four --distance 10cm --ratio 1",
    ("new", "--phase"): "u --throws 0,180 --distance 0.2 --phase 30",
    ("new", "--lead"): "opposed-pistons --throws 0,180 --distance 0.9 --lead 12",
    ("new", "--intervals"): "firing-order --firing-order 1-2 --intervals 360,360",
    ("new", "--strokes"): "i3 --strokes 4",
    ("new", "--dummy"): "i3 --dummy 2,3",
    ("new", "--tdc"): "lists --banks 60,120 --z 0,0.1 --tdc 0,90",
    ("new", "--pins"): "lists --banks 60,120 --z 0,0.1 --pins 60,30",
    ("new", "--banks"): "lists --tdc 0,90 --z 0,0.1 --banks 60,120",
    ("new", "--z"): "lists --tdc 0,90 --banks 60,120 --z 0,0.1",
    ("design", "--pin-split"): "v-twin-90 --pin-split -30 --count 1",
    ("design", "--bank-angle"): "v-twin-90 --bank-angle 60 --count 1",
    ("sweep", "--rtol"): "v6-60 --rpm 1000,2000 --rtol 1e-3",
    ("torque", "--rtol"): "i4 --bore 86mm --rtol 1e-3",
    ("tolerances", "--rtol"): "i4 --z 1mm --samples 20 --rtol 1e-3",
    ("tolerances", "--reciprocating-mass"): "i4 --samples 20 --orders 1,2 --reciprocating-mass 2g",
    ("tolerances", "--rotating-mass"): "v6-60-ebook --samples 9 --orders 1 --rotating-mass 2g",
    ("tolerances", "--pin"): "i4 --samples 20 --orders 1,2 --pin 0.1",
    ("rank", "--bank-angle"): "v6-60 v6-90 --by total.force.peak --bank-angle 60,70",
    ("two-plane", "--angles"): "--amounts 5,3 --measured 0,335mm --correct=-1,20 --angles 35,310",
    ("match", "--small-ends"): "i4 --pistons 0.45,0.46,0.45,0.47 --big-ends 0.3,0.3,0.3,0.3 "
    "--small-ends 0.1,0.1,0.1,0.1",
    ("match", "--big-ends"): "i4 --pistons 0.45,0.46,0.45,0.47 --small-ends 0.1,0.1,0.1,0.1 "
    "--big-ends 0.3,0.3,0.3,0.3",
    ("design", "--masses"): "i2-360 --by [1].force.peak --count 1 --masses 0.5,0.4",
    ("design", "--positions"): "i2-360 --by [1].force.peak --count 1 --positions 0,0.1",
    ("design", "--shafts"): "i2-360 --by total.force.peak --count 1 --shafts 2,-2",
    ("card", "--bearings"): "v8-crossplane --bearings 40g",
    ("mounts", "--base-hz"): "car.toml --base y=0.1mm --base-hz 5",
    ("mounts", "--base-about"): "car.toml --base y=0.1mm --base-hz 5 --base-about 0,0.1,0",
    ("mounts", "--misfire"): "fired.toml --misfire 2",
    ("foundation", "--top"): f"{ON_SOIL} --top 0,-1,1.5",
    ("foundation", "--density"): f"{ON_SOIL} --density 2350",
    ("foundation", "--machine"): f"{ON_SOIL} --machine 45000,0,0.4,1.5",
    ("foundation", "--soil-damping"): f"{ON_SOIL} --soil-damping 0.03",
    ("foundation", "--embedment"): f"{ON_SOIL} --embedment 1m",
    ("foundation", "--at"): f"{ON_SOIL} --at 0,0,1.5m",
    ("foundation", "--soil"): "marine-5 --rpm 210 --block 4,2.5,9 --soil 60MPa,0.35,1800",
    ("foundation", "--block"): "marine-5 --rpm 210 --soil 6e7 --block 4,2.5,9m",
    ("foundation", "--table-rpm"): "maker.csv --table-rpm 105",
    ("foundation", "--crankcase"): "marine-5 --rpm 210 --cycle diesel --crankcase 1bar",
    ("foundation", "--atmosphere"): "i4 --cycle run.csv --bore 86mm --atmosphere 1.01bar --maker",
    ("new", "--crank"): "lists --tdc 0,90 --banks 60,120 --z 0,0.1 --crank 0,0",
    ("trace", "--atmosphere"): "i4 run.csv --bore 86mm --atmosphere 1.01bar",
    ("trace", "--tdc"): "i4 run.csv --bore 86mm --tdc 1",
    ("trace", "--exponent"): "i4 run.csv --bore 86mm --compression-ratio 10 --exponent 1.3",
    ("trace", "--gamma"): "i4 run.csv --bore 86mm --compression-ratio 10 --gamma 1.3",
    (
        "trace",
        "--compression-ratio",
    ): "i4 run.csv --bore 86mm --exponent 1.3 --compression-ratio 10",
    ("harmonics", "--pin-offset"): "--stroke 86mm --rod-length 145mm --pin-offset 1mm",
    ("harmonics", "--stroke"): "--rod-length 145mm --stroke 86mm",
    ("harmonics", "--rod-length"): "--stroke 86mm --rod-length 145mm",
    ("harmonics", "--orders"): "0.3 --orders 1,2",
    ("shafts", "--x"): "i4 --ratios 2,-2 --x 80mm",
    ("shafts", "--y"): "i4 --ratios 2,-2 --y 80mm",
    ("shafts", "--planes"): "i4 --ratios 2,-2 --planes 0.1,0.2",
    ("shafts", "--bearings"): "i4 --ratios 2,-2 --bearings 0,0.3",
    ("shafts", "--rpm"): "i4 --rpm 2000",
    ("flywheel", "--inertia"): "i4 --bore 86mm --inertia 0.2",
    ("flywheel", "--areas"): "--rpm 600 --inertia 2 --areas 52,-52",
    ("flywheel", "--torque-scale"): "--areas 52,-52 --torque-scale 600",
    ("flywheel", "--angle-scale"): "--areas 52,-52 --angle-scale 3",
    ("guide-moments", "--bore"): "marine-5 --rpm 210 --cycle diesel --bore 350mm",
    ("guide-moments", "--crankcase"): "marine-5 --rpm 210 --cycle diesel --crankcase 1bar",
    ("locomotive", "--z"): f"{ENGINE_OF_A_LOCOMOTIVE} --rpm 280 --z -0.35,0.35",
    ("locomotive", "--rod-length"): f"{ENGINE_OF_A_LOCOMOTIVE} --rpm 280 --rod-length 2m",
    ("locomotive", "--share"): f"{ENGINE_OF_A_LOCOMOTIVE} --rpm 280 --share 66%",
    ("locomotive", "--coupling"): f"{ENGINE_OF_A_LOCOMOTIVE} --rpm 280 --coupling 20:0.9:180:1",
    ("locomotive", "--hammer-blow"): f"{ENGINE_OF_A_LOCOMOTIVE} --rpm 280 --hammer-blow 40kN",
    ("locomotive", "--speed"): f"{ENGINE_OF_A_LOCOMOTIVE} --wheel-diameter 1.7 --speed 90",
    ("sweep", "--rpm"): "v6-60 --orders 1,2 --rpm 1000,2000",
    ("tolerances", "--orders"): "i4 --z 1mm --samples 20 --orders 1,2",
    ("mounts", "--orders"): "car.toml --rpm 2000 --orders 1,2",
    ("mounts", "--rtol"): "car.toml --rpm 2000 --rtol 1e-3",
    ("mounts", "--at"): "car.toml --rpm 2000 --at 0,0.1,0",
    ("mounts", "--factor"): "car.toml --rpm 2000 --orders 1,2 --factor 40%",
    ("mounts-fit", "--rpm"): "car.toml --x 1mm --starts 1 --by mount_force[2] --rpm 2000",
    ("card", "--balanced-to"): "v8-crossplane --planes ends --radius 70mm --balanced-to 1.2kg",
    ("match", "--pistons"): "i4 --pistons 0.45,0.46,0.45,0.47",
}
"""Whole line where the option does not go behind that of :data:`BASE`."""
BAD = ["nan", "inf", "1e400", "", "x", "5furlong", "5kg·s"]
"""No finite numbers, and units that there are not or that are of nothing typed here."""


def numeric(command: str) -> list[str]:
    """The options of a command that are numbers."""
    commands = Parser().add_subparsers()
    registered([command])[command](commands)
    valued = (each for each in commands.choices[command]._actions if each.nargs != 0)
    flags = [each.option_strings[-1] for each in valued if each.option_strings and not each.choices]
    return [flag for flag in flags if flag not in WORDS and (command, flag) not in NAMES]


def line(command: str, flag: str) -> list[str]:
    """A sound line of a command with an option, which is the last word but one."""
    if (command, flag) in IN_PLACE:
        return [command, *IN_PLACE[command, flag].split()]
    if command == "new":
        return ["new", "i3", *OF_PARTS[flag].split()]
    beside = BASE[command].split()
    if flag in beside:
        at = beside.index(flag)
        del beside[at : at + 2]
    return [*beside, flag, *VALUES[flag].split()]


def with_value(typed: list[str], flag: str, value: str) -> list[str]:
    """A line with another value of an option."""
    at = typed.index(flag)
    return [*typed[:at], f"{flag}={value}", *typed[at + 2 :]]


def run(typed: list[str], capsys: CAPTURE) -> tuple[int, str]:
    """The code with which a line ends, and what it says."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        code = main(typed)
    return code, capsys.readouterr().err


@pytest.fixture
def _files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    car(tmp_path)
    theta = np.arange(-360.0, 360.0)
    bar = cp.Cycle.example().pressure_at(theta) / 1e5
    names = ["left", "right", "rear"]
    places = [(0.3, 0, 0), (-0.3, 0, 0), (0, 0, 0.7)]
    mounts = [cp.Mount(name, at, 2e5) for name, at in zip(names, places, strict=True)]
    fired = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086))
    body = cp.RigidBody(150, (0, 0.06, 0.15), (7, 8, 4.5))
    cp.Powertrain(fired.with_cycle(cp.Cycle.example()), body, mounts).save("fired.toml")
    head = "time [s] absolute pressure [bar]"
    np.savetxt("times.csv", np.c_[(theta + 360.0) / 9000.0, bar], header=head)
    Path("maker.csv").write_text("name,amplitude,unit\nM1V,1200,kNm\n", encoding="utf-8")
    np.savetxt("run.csv", np.c_[theta, bar], header="angle [deg] absolute pressure [bar]")


@pytest.mark.slow
@pytest.mark.usefixtures("_files")
@in_turn("command", [name for name in ORDER if numeric(name)])
def test_numbers_are_read_or_rejected_by_name(command: str, capsys: CAPTURE) -> None:
    faults = list[str]()
    for flag in numeric(command):
        typed = line(command, flag)
        at = typed.index(flag)
        sound = with_value(typed, flag, typed[at + 1])
        code, err = run(sound, capsys)
        if code:
            faults.append(f"{' '.join(sound)}: {err}")
            continue
        for value in BAD:
            if value == "inf" and flag in INFINITE:
                continue
            bad = with_value(typed, flag, value)
            code, err = run(bad, capsys)
            if code != 2 or not err.startswith(f"crankpin: error: {flag}"):
                faults.append(f"{' '.join(bad)}: {code} {err}")
        if re.fullmatch(r"-?[\d.e-]+(mm|g|bar|kg|%)?", typed[at + 1]):
            many = with_value(typed, flag, "6,000")
            code, err = run(many, capsys)
            both = "6000" in err and "6.000" in err
            if code != 2 or not err.startswith(f"crankpin: error: {flag}") or not both:
                faults.append(f"{' '.join(many)}: {code} {err}")
    assert not faults, "\n".join(faults)


INFINITE = {"--rod-length", "--bound"}
"""Options of which ``inf`` is a number."""
