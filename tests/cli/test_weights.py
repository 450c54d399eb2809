"""Do the commands for counterweights and bob weights print the library's numbers?"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import crankpin as cp
import matplotlib as mpl
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]


def printed(capsys: CAPTURE, *argv: str) -> str:
    """What a run that succeeds prints."""
    assert main(argv) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: CAPTURE, *argv: str) -> str:
    """What a run that fails says, one line."""
    assert main(argv) == 2
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    return line.removeprefix("crankpin: error: ")


@pytest.fixture(autouse=True)
def _agg() -> None:
    mpl.use("agg")


@pytest.mark.parametrize(
    ("typed", "planes"),
    [
        (["--planes", "ends"], "ends"),
        ([], "webs"),
        (["--planes=-0.1,0.4"], [-0.1, 0.4]),
        (["--planes", "damper=-0.1,flywheel=0.4"], {"damper": -0.1, "flywheel": 0.4}),
    ],
)
def test_counterweights_are_those_of_the_library(
    capsys: CAPTURE, typed: list[str], planes: object
) -> None:
    engine = cp.Engine.preset("v6-90")
    fitted = cp.counterweights(engine, planes=planes)  # type: ignore[arg-type]
    assert printed(capsys, "counterweights", "v6-90", *typed) == (f"{fitted.frames.text()}\n")
    head, *rows = csv.reader(
        io.StringIO(printed(capsys, "counterweights", "v6-90", "--csv", *typed))
    )
    assert head == ["plane", "z m", "amount kg·m", "angle °"]
    assert [float(row[2]) for row in rows] == [w.amount for w in fitted.hardware]


def test_options_of_counterweights_are_those_of_the_library(capsys: CAPTURE) -> None:
    options = ["--target", "internal", "--factor", "0.4", "--minimise", "largest"]
    options += ["--bound", "0.004", "--angles", "0:330:30"]
    fitted = cp.counterweights(
        cp.Engine.preset("i4"),
        planes="webs",
        target="internal",
        factor=0.4,
        minimise="largest",
        bound=0.004,
        angles_deg=[30.0 * k for k in range(12)],
    )
    assert fitted.table.text() in printed(capsys, "counterweights", "i4", *options)
    elsewhere = printed(capsys, "counterweights", "single", "--reference-z", "1", "--planes", "0.2")
    one = cp.counterweights(cp.Engine.preset("single").replace(reference_z=1.0), planes=[0.2])
    assert one.table.text() in elsewhere


def test_bob_weights_are_those_of_the_library(capsys: CAPTURE) -> None:
    masses = ["--rotating-mass", "550g", "--reciprocating-mass", "620g"]
    typed = ["--factor", "52%", *masses, "--oil", "4g"]
    engine = cp.Engine.preset("v8-crossplane", rotating_mass=0.55)
    cylinders = [each.replace(reciprocating_mass=0.62) for each in engine.cylinders]
    bob = cp.bob_weight(engine.replace(cylinder=cylinders), 0.52, oil=0.004)
    assert printed(capsys, "bob-weight", "v8-crossplane", *typed) == (f"{bob.frames.text()}\n")
    *_, last = csv.reader(io.StringIO(printed(capsys, "bob-weight", "v8-crossplane", "--csv")))
    assert last == ["7, 8", "315.0", "0.0", "900.0", "0.0", "450.0"]
    assert "50 %" in printed(capsys, "bob-weight", "single")


@pytest.mark.parametrize("command", ["counterweights", "bob-weight"])
def test_pictures_are_written(capsys: CAPTURE, tmp_path: Path, command: str) -> None:
    file = tmp_path / "weights.png"
    printed(capsys, command, "v6-90", "--plot", str(file))
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (
            ["counterweights", "v6-90", "--planes", "middle"],
            "--planes = middle: give ends, webs, or places",
        ),
        (["counterweights", "v6-90", "--planes", "a=1,2"], "--planes = a=1,2: give ends, webs"),
        (["counterweights", "v6-90", "--planes", "a=1,a=2"], "--planes = a=1,a=2: give ends"),
        (
            ["counterweights", "v6-90", "--angles", "x"],
            "--angles = x: give one number, a list a,b,c or a range",
        ),
        (["counterweights", "v6-90", "--bound", "-1"], "--bound = -1: give a mass·radius"),
        (["counterweights", "ijesc-v6"], "NAME = ijesc-v6: counterweights takes one engine"),
        (["bob-weight", "v6-90", "--factor", "fifty"], "--factor = fifty: give a number"),
        (["bob-weight", "v6-90", "--factor", "50"], "--factor = 50: give a share"),
        (["bob-weight", "v6-90", "--plot", "x.txt"], "--plot = x.txt: a picture's name"),
    ],
)
def test_what_is_wrong_is_said(capsys: CAPTURE, argv: list[str], words: str) -> None:
    assert refused(capsys, *argv).startswith(words)
