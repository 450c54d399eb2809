"""Does the help of a layout list what that layout takes, and nothing that it refuses?"""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import warnings
from pathlib import Path

import crankpin as cp
import pytest
from crankpin.cli import main
from crankpin.cli.new import BUILDERS, LAYOUT, SWITCHES
from crankpin.model import presets
from support import in_turn

CAPTURE = pytest.CaptureFixture[str]
LINES = {
    "inline": "--throws 0,180",
    "vee": "--bank-angle 60 --throws 0,120,240",
    "flat": "--throws 0,180",
    "boxer": "--throws 0,180",
    "radial": "--cylinders 5",
    "firing-order": "--firing-order 1-3-4-2 --bank-angle 90",
    "lists": "--tdc 0,90 --banks 60,120 --z 0,0.1",
    "banks": "--banks 60,120 --throws 0,120,240",
    "w": "--throws 0,120,240",
    "x": "--throws 0,90,270,180",
    "opposed-pistons": "--throws 0,120,240 --distance 0.9",
    "u": "--throws 0,180 --distance 0.3",
    "square-four": "--distance 0.1",
    "h": "--throws 0,180 --distance 0.3",
    "compressor": "--throws 0,180",
}
"""Builder → what it needs."""
WHOLE = "--stroke 80mm --rod-length 140mm --piston-mass 400g --rod-mass 500g"
SOUND = {
    "--bore": "--bore 80mm " + WHOLE,
    "--stroke": WHOLE,
    "--rod-length": WHOLE,
    "--pin-offset": "--pin-offset 1mm " + WHOLE,
    "--rod-centre": "--rod-centre 45mm " + WHOLE,
    "--piston-mass": WHOLE,
    "--rod-mass": WHOLE,
    "--small-end": f"{WHOLE.replace('--rod-mass 500g', '--small-end 150g --big-end 350g')}",
    "--big-end": f"{WHOLE.replace('--rod-mass 500g', '--small-end 150g --big-end 350g')}",
    "--reciprocating-mass": "--stroke 80mm --rod-length 140mm --reciprocating-mass 0.5",
    "--rotating-mass": "--rotating-mass 0.4",
    "--dummy": "--dummy 1",
    "--bank-angle": "--bank-angle 75",
    "--pin-split": "--pin-split 12",
    "--spacing": "--spacing 90mm",
    "--bank-stagger": "--bank-stagger 20mm",
    "--odd-bank": "--odd-bank left",
    "--numbering": "--numbering by-bank",
    "--absent": "--absent 2",
    "--rows": "--rows 1",
    "--distance": "--distance 0.2",
    "--ratio": "--ratio 1",
    "--phase": "--phase 30",
    "--lead": "--lead 12",
    "--strokes": "--strokes 4",
    "--shared-pins": "--shared-pins",
    "--one-crankshaft": "--one-crankshaft",
    "--suction": f"--bore 80mm {WHOLE} --suction 1bar --discharge 4bar --strokes 2",
    "--discharge": f"--bore 80mm {WHOLE} --discharge 4bar --strokes 2",
    "--clearance": f"--bore 80mm {WHOLE} --clearance 0.15 --discharge 4bar --strokes 2",
    "--exponent": f"--bore 80mm {WHOLE} --exponent 1.25 --discharge 4bar --strokes 2",
    "--rod-diameter": f"--bore 80mm {WHOLE} --rod-diameter 10mm --discharge 4bar --strokes 2",
    "--double-acting": f"--bore 80mm {WHOLE} --double-acting --discharge 4bar --strokes 2",
    "--crosshead-mass": "--crosshead-mass 0.3",
    "--body": "--body 150:0,0.06,0.1:7,8,4.5 --mount a:0.3,0,0:200000",
    "--mount": "--body 150:0,0.06,0.1:7,8,4.5 --mount a:0.3,0,0:200000:0.1",
    "--axes": "--body 150:0,0.06,0.1:7,8,4.5 --mount a:0.3,0,0:200000 --axes back,right,up",
    "--name": "--name mine",
    "--add-load": "--add-load 'fan: on=shaft force=2:8 z=-10mm'",
    "--units": "--units g,mm",
    "--out": "-o new.toml --force",
    "--force": "-o new.toml --force",
}
"""Option → a sound value, with what it needs beside it; of others :func:`of_the_engine`."""


def of_the_engine(kind: str, flag: str) -> str:
    """A sound value of an option that goes with the number of cylinders: the engine's own."""
    base = presets.layout(presets.named(kind)) if kind not in LINES else None
    if base is None:
        typed = LINES[kind].split()
        known = dict(zip(typed[::2], typed[1::2], strict=True))
        engine = cp.Engine.from_toml(toml_of(kind, *typed))
    else:
        known, engine = {}, base.build(base.cylinder, base.spacing)
    count = len(engine)
    throws = ",".join(map(str, base.arguments.get("throws_deg", ()))) if base else ""
    radius, rod = engine.cylinders[0].crank_radius, engine.cylinders[0].rod_length
    links = f"--link-rods {0.7 * radius}:{rod}"
    if flag in ("--link-rods", "--master"):
        return f"{links} --master 1" if flag == "--master" else links
    own = {
        "--throws": throws,
        "--cylinders": str(count),
        "--firing-order": engine.firing_order or engine.firing_orders()[0].firing_order,
        "--intervals": ",".join([f"{720 / count:g}"] * count),
        "--tdc": ",".join(map(str, engine.tdc_deg.tolist())),
        "--pins": ",".join(map(str, engine.pin_deg.tolist())),
        "--banks": "60,120",
        "--crank": ",".join("0" * count),
        "--cranks": "0.3:0:-1 --crank 0,1",
        "--z": "0,0.1",
    } | known
    return f"{flag} {own[flag]}"


def toml_of(*typed: str) -> str:
    """What ``new`` prints."""
    out = io.StringIO()
    quiet = contextlib.redirect_stderr(io.StringIO())
    with warnings.catch_warnings(), contextlib.redirect_stdout(out), quiet:
        warnings.simplefilter("ignore")  # of split pins
        assert main(["new", *typed]) == 0, " ".join(typed)
    return out.getvalue()


def listed(kind: str) -> list[str]:
    """The options that the help of a kind lists."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), pytest.raises(SystemExit, match=r"^0$"):
        main(["new", kind, "--help"])
    return [
        flag
        for flag in re.findall(r"^  (?:-\w \w+, )?(--[\w-]+)", out.getvalue(), re.MULTILINE)
        if flag != "--help"
    ]


KINDS = [*BUILDERS, *presets.aliases(), *presets.Presets()]


@pytest.mark.slow
@in_turn("kind", KINDS)
def test_every_option_in_the_help_of_a_kind_is_taken(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    flags = listed(kind)
    assert len(flags) > 20
    needed = LINES.get(kind, "").split()
    for flag in flags:
        typed = shlex.split(SOUND.get(flag) or of_the_engine(kind, flag))
        if flag == "--pin-offset" and kind.endswith("link-rods"):  # a master's alone
            typed = f"--pin-offset 0 {WHOLE}".split()
        beside = [each for each in zip(needed[::2], needed[1::2], strict=True) if flag != each[0]]
        if (kind, flag) == ("lists", "--pins"):
            beside = [each for each in beside if each[0] != "--tdc"]
        if "--strokes" in typed and "--strokes" not in flags:  # of a compressor, always 2
            typed = typed[: typed.index("--strokes")]
        if flag == "--one-crankshaft":
            beside = [each for each in beside if each[0] != "--distance"]
        toml_of(kind, *(word for pair in beside for word in pair), *typed)


@in_turn("kind", KINDS)
def test_no_option_is_taken_that_the_help_of_a_kind_lacks(
    kind: str, capsys: CAPTURE, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for flag in {*LAYOUT, *SWITCHES, "--dummy"} - {*listed(kind), "--spacing"}:
        value = [] if flag in SWITCHES else ["90"]
        assert main(["new", kind, *LINES.get(kind, "").split(), flag, *value]) == 2
        assert flag in capsys.readouterr().err


def test_spacing_is_named_where_it_places_something(capsys: CAPTURE, tmp_path: Path) -> None:
    file = str(tmp_path / "a.toml")
    for line in ("v-twin", "v-twin --bank-stagger 20mm", "single", "boxer-2", "i3", "radial-14"):
        matters = line in ("boxer-2", "i3", "radial-14")
        assert main(["new", *line.split(), "-o", file, "--force"]) == 0
        assert ("in proportion to the bore" in capsys.readouterr().out) == matters
