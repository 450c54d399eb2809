"""Do the commands that write pages write what the library does?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from pathlib import Path


def test_view_writes_the_library_s_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ours, theirs = tmp_path / "ours.html", tmp_path / "v8.html"
    argv = ["view", "v8-crossplane", "--out", f"{theirs}", "--rpm", "4500", "--reference-z", "0.1"]
    assert main(argv) == 0
    cp.Engine.preset("v8-crossplane").replace(reference_z=0.1).save_html(ours, rpm=4500)
    assert theirs.read_bytes() == ours.read_bytes()
    assert capsys.readouterr().out == f"{theirs}: {theirs.stat().st_size / 1e3:.0f} kB\n"


def test_view_writes_a_compact_page(tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours.html", tmp_path / "theirs.html"
    cp.Engine.preset("i4").save_html(ours, compact=True)
    assert main(["view", "i4", "--out", f"{theirs}", "--compact"]) == 0
    assert theirs.read_text(encoding="utf-8") == ours.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("typed", "given"), [("rpm,bank_angle", ["rpm", "bank_angle"]), ("none", ()), ("rpm", "rpm")]
)
def test_view_takes_controls_and_units(tmp_path: Path, typed: str, given: list[str]) -> None:
    ours, theirs = tmp_path / "ours.html", tmp_path / "theirs.html"
    with cp.units("g, mm, lbf"):
        cp.Engine.preset("v6-60").save_html(ours, controls=given)
    argv = ["view", "v6-60", "--out", f"{theirs}", "--controls", typed, "--units", "g,mm,lbf"]
    assert main(argv) == 0
    assert theirs.read_bytes() == ours.read_bytes()
    assert '"lbf"' in theirs.read_text(encoding="utf-8")


def test_view_takes_a_spectrum_and_a_file(tmp_path: Path) -> None:
    engine = cp.Engine.preset("i4")
    engine.save(tmp_path / "i4.toml")
    argv = ["view", f"{tmp_path / 'i4.toml'}", "--out", f"{tmp_path / 'a.html'}"]
    assert main([*argv, "--spectrum", "1=9.0,2=3.75"]) == 0
    engine.save_html(tmp_path / "b.html", spectrum={1: 9.0, 2: 3.75})
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_gallery_counts_its_pages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gallery", "--out", f"{tmp_path / 'all'}"]) == 0
    files = list((tmp_path / "all").iterdir())
    size = sum(file.stat().st_size for file in files) / 1e6
    index = tmp_path / "all" / "index.html"
    count = len(cp.presets())
    assert len(files) == count + 1
    assert capsys.readouterr().out == f"{index}: {count} engines, {size:.1f} MB\n"


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        ("view v8-crossplane", "the following arguments are required: -o/--out"),
        ("view ijesc-v6 --out x.html", "NAME = ijesc-v6: view takes one engine of"),
        ("view i4 --out x.html --rpm fast", "--rpm = fast: give a number"),
        ("view i4 --out nowhere/x.html", "No such file"),
    ],
)
def test_errors_are_one_line(argv: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(argv.split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
