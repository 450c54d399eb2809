"""Does the command ``shafts`` print and save what the library fits?"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from pathlib import Path

CAPTURE = pytest.CaptureFixture[str]
I4 = cp.Engine.preset("i4")
V6 = cp.Engine.preset("v6-90")


def printed(capsys: CAPTURE, *argv: str) -> str:
    assert main(["shafts", *argv]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_prints_the_fit(capsys: CAPTURE) -> None:
    out = printed(capsys, "i4", "--ratios", "2,-2", "--x", "0.08,-0.08")
    assert out == f"{cp.balance_shafts(I4, [2, -2], x=[0.08, -0.08])!r}\n"


def test_every_option_of_a_fit(capsys: CAPTURE) -> None:
    out = printed(
        capsys, "v6-90", "--ratios=-1,2", "--x", "0.1", "--y", "0.05,", "--planes", "0,0.3",
        "--bearings", "0.1,0.2", "--remove", "moment", "--reference-z", "0.05",
    )  # fmt: skip
    fit = cp.balance_shafts(
        V6.replace(reference_z=0.05), [-1, 2], x=0.1, y=[0.05, None], planes=(0, 0.3),
        bearings=(0.1, 0.2), remove="moment",
    )  # fmt: skip
    assert out == f"{fit!r}\n"


def test_csv_has_the_unbalances_in_full(capsys: CAPTURE) -> None:
    head, *rows = csv.reader(io.StringIO(printed(capsys, "i3", "--ratios", "-1", "--csv")))
    assert head == ["shaft", "ratio", "x m", "y m", "z m", "unbalance kg·m", "phase °"]
    weights = cp.balance_shafts(cp.Engine.preset("i3"), -1)[0].unbalances
    expected = [[0.0, 0.0, w.z, w.amount, w.angle_deg] for w in weights]
    assert np.array([row[2:] for row in rows], float).tolist() == expected


def test_saves_the_engine_with_the_shafts(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "smooth.toml"
    printed(capsys, "i4", "--ratios", "2,-2", "--save", str(file))
    assert cp.Engine.load(file) == cp.balance_shafts(I4, [2, -2]).fitted


def test_compares_hardware(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "smooth.json"
    target = {"[1].moment.peak": 0.0}
    options = cp.balancer_options(V6, rpm=3000, target=target)
    out = printed(capsys, "v6-90", "--target", "[1].moment.peak=0", "--save", str(file))
    assert out == f"{options!r}\n"
    assert cp.Engine.load(file) == options.fitted
    by = ["total.moment.peak", "[2].moment.peak"]
    options = cp.balancer_options(
        V6.replace(reference_z=0.2), rpm=4000, by=by, target={by[0]: 0.05}, relative=True
    )
    out = printed(
        capsys, "v6-90", "--rpm", "4000", "--by", ",".join(by), "--target", f"{by[0]}=5%",
        "--reference-z", "0.2",
    )  # fmt: skip
    assert out == f"{options!r}\n"


@pytest.mark.parametrize("argv", [["i4", "--ratios", "2", "--quantity", "force"], ["i4"]])
def test_writes_a_picture(capsys: CAPTURE, tmp_path: Path, argv: list[str]) -> None:
    file, before = tmp_path / "picture.png", plt.get_fignums()
    printed(capsys, *argv, "--plot", str(file))
    assert file.read_bytes().startswith(b"\x89PNG")
    assert plt.get_fignums() == before


def test_a_speed_of_zero_is_zero(capsys: pytest.CaptureFixture[str]) -> None:
    """As the library takes it: not the default speed."""
    try:
        said = f"{cp.balancer_options(cp.Engine.preset('i4'), rpm=0)}\n"
    except cp.InputError as error:
        said = str(error.hint)
    main(["shafts", "i4", "--rpm", "0"])
    out, err = capsys.readouterr()
    assert said in out + err
    assert "3000 rpm" not in out


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["i4", "--x", "0.1"], "--x needs --ratios"),
        (["i4", "--quantity", "force"], "--quantity needs --ratios"),
        (["i4", "--ratios", "2", "--rpm", "3"], "--rpm is of the comparison without --ratios"),
        (["i4", "--ratios", "2", "--target", "a=1"], "--target is of the comparison"),
        (["i4", "--ratios", "half"], "--ratios = half: give a multiple of 1/2"),
        (["i4", "--ratios", "0"], "--ratios = 0: give a multiple of 1/2 other than 0"),
        (["i4", "--ratios", "2", "--planes", "a"], "--planes = a: give a number"),
        (["i4", "--ratios", "2", "--x", "1,2"], "x has 2 entries"),
        (["i4", "--target", "total.force.peak"], "--target = total.force.peak: give OBJECTIVE"),
        (
            ["i4", "--target", "total.force.peak=1,total.moment.peak=5%"],
            "--target = total.force.peak=1,total.moment.peak=5%: give all values in %, or none",
        ),
        (["i4", "--target", "total.force.peak=x"], "--target = x: give a number"),
        (["i4", "--save", "x.toml"], "--save = x.toml: needs --ratios or --target"),
        (["i4", "--save", "x.toml", "--target", "[4].force.peak=0"], "no set reaches the target"),
        (["ijesc-v6", "--ratios", "1"], "NAME = ijesc-v6: shafts takes one engine"),
        (["i4", "--ratios", "2", "--plot", "x.gif"], "--plot = x.gif"),
    ],
)
def test_errors_name_the_option(capsys: CAPTURE, argv: list[str], words: str) -> None:
    assert main(["shafts", *argv]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
    assert err.count("\n") == 1
