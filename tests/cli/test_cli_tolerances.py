"""The command ``tolerances``."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

COMMAND = ["tolerances", "i6", "--rpm", "6000", "--reciprocating-mass", "0.002", "--samples", "200"]


def test_the_table_is_that_of_the_library(capsys: pytest.CaptureFixture[str]) -> None:
    t = cp.tolerances(
        cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, pin_deg=0.1, seed=3, samples=200
    )
    options = ["--pin", "0.1", "--seed", "3"]
    assert main([*COMMAND, *options]) == 0
    assert capsys.readouterr().out == f"{t}\n"
    assert main([*COMMAND, *options, "--shares"]) == 0
    assert capsys.readouterr().out == f"{t.shares}\n"


def test_csv_has_full_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    main([*COMMAND, "--by", "[1].force.forward,total.force.peak", "--orders", "1,2", "--csv"])
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    t = cp.tolerances(
        cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, samples=200, orders=[1, 2]
    )
    assert float(rows[1]["95 %"]) == t.quantile(0.95, by="total.force.peak")


def test_a_picture_is_written(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    for options in ([], ["--shares"]):
        assert main([*COMMAND, *options, "--plot", str(tmp_path / "t.png")]) == 0
        assert (tmp_path / "t.png").stat().st_size > 5_000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--samples", "many"], "--samples = many: give a whole number"),
        (["--samples", "100000000"], "--samples = 100000000: give 10000000 at most"),
        (["--pin", "x"], "--pin = x: give a number"),
        (["--z=-1"], "--z = -1: give a spread that is zero or more"),
        (["--by", "beauty"], "--by = beauty"),
        (["--plot", "t.txt"], "--plot = t.txt"),
    ],
)
def test_errors(options: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*COMMAND, *options]) == 2
    assert message in capsys.readouterr().err
