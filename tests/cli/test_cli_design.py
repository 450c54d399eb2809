"""Does the command ``design`` print the library's designs?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from cli.test_cli import CAPTURE, numbers, printed, refused

if TYPE_CHECKING:
    from pathlib import Path

V10 = cp.Engine.preset("v10-72")
PRIMARY = "--by [1].force.peak,[1].moment.peak"
SPLIT = "v6-60 --even-firing --pin-split=-180:180 --counterweights"


@pytest.fixture(autouse=True)
def _agg() -> None:
    mpl.use("agg")


def test_the_question_most_asked(capsys: CAPTURE) -> None:
    text = printed(
        capsys, "design", "v10-72", "--bank-angle", "60:120", "--even-firing", "--rpm", "6000"
    )
    found = cp.design(
        10,
        layout="vee",
        cylinder=V10.cylinders[0],
        spacing=float(V10.z[1] - V10.z[0]),
        rotating_mass=float(V10.rotating_mass[0]),
        bank_angle_deg=(60, 120),
        even_firing=True,
        by="total.moment.peak",
        rpm=6000,
    )
    assert text == repr(found) + "\n"
    assert text.splitlines()[2].split()[:3] == ["1", "0-144-216-288-72", "72"]


def test_csv_is_the_library_s_numbers(capsys: CAPTURE) -> None:
    argv = ["design", "v10-72", "--bank-angle", "60:120", "--counterweights", "--count", "3"]
    argv += ["--by", "[1].moment.backward,[2].moment.peak", "--csv"]
    head, labels, values = numbers(printed(capsys, *argv), 4)
    assert head[:4] == ["place", "throws °", "bank angle °", "equivalent"]
    assert [row[2] for row in labels] == ["90"] * 3
    assert values.shape == (3, 2)
    assert np.all(values[:, 0] == 0.0)
    assert np.all(np.diff(values[:, 1]) > 0.0)


@pytest.mark.parametrize(
    ("argv", "row"),
    [
        ("i4 --throws 0,0,180,180 --by [1].moment.peak", "1 0-180-180-0 1 0"),
        (f"{SPLIT} --shafts=-2 --by [1].moment.peak,[2].moment.peak", "1 0-120-240 -60 60 2 0"),
        ("v6-90 --layout boxer --even-firing --by total.force.peak", "1 0-120-240 180 180 2 0"),
        ("v6-90 --intervals 150,90,150,90,150,90", "1 0-120-240 90 2"),
        ("v6-90 --cylinders 2 --by [1].force.peak --bank-angle 90 --counterweights", "1 0 90 1 0"),
        ("i3 --throws free --by [1].force.peak --seed 3", "1 0-120-240 2"),
        (
            f"i4 --masses 400,,?,400kg --positions 0,450mm,1.2,1.8 --throws 0,,,120 {PRIMARY}",
            "1 0-160.893-313.898-120 846.64 865.33 0 0",
        ),
        (
            "i3 --masses 400,,400 --throws free --by [1].force.peak,[1].moment.peak",
            "1 0-180-0 800 0 0",
        ),
        (f"{SPLIT} --own-splits --by [1].moment.peak", "1 0-120-0 -60, 60, -60 60 1 0"),
    ],
)
def test_options(capsys: CAPTURE, argv: str, row: str) -> None:
    lines = printed(capsys, "design", *argv.split()).splitlines()
    assert " ".join(lines[2].split()).startswith(row)


def test_a_picture(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "v10.png"
    printed(capsys, "design", "v10-72", "--even-firing", "--plot", str(file))
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        ("w12", "NAME = w12: give an engine with one or two banks and one kind of cylinder"),
        ("v6-60 --bank-angle 10:20:30", "--bank-angle = 10:20:30: give one angle, or LOW:HIGH"),
        ("v6-60 --count 1.5", "--count = 1.5: give a whole number"),
        ("v6-60 --shafts=1", "give different speed ratios"),
        ("v6-60 --throws 0,1", "give 3 angles to be put in order"),
        ("i3 --masses 1,,", "--by = total.moment.peak: unlike cylinders are designed by"),
        (f"i3 --masses 1,x,1 {PRIMARY}", "--masses = x: give a number"),
        (f"i3 --masses 1,1 {PRIMARY}", "give one mass, kg, for each of the 3 cylinders"),
        ("v6-60 --masses 1,,1,1,1,1", "unlike cylinders stand in line"),
    ],
)
def test_what_cannot_be_designed(capsys: CAPTURE, argv: str, message: str) -> None:
    assert message in refused(capsys, "design", *argv.split())
