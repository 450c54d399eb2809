"""Do the commands of a balancing shop print the library's numbers?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

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
