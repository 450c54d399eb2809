"""Is what the README says true?"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import crankpin as cp
import pytest

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")


def test_its_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names: dict[str, Any] = {}
    exec(compile(code, "README.md", "exec"), names)  # noqa: S102 - our own text
    assert names["s"].moment.peak_xy.shape == (17, 2, 2)
    assert cp.Engine.load(tmp_path / "v8.toml") == names["v8"]
    names["plt"] = pytest.importorskip("matplotlib.pyplot")
    names["plt"].close("all")


def test_it_counts_the_presets() -> None:
    (count,) = re.findall(r"# (\d+) engines by name", README)
    assert int(count) == len(cp.presets())


def test_its_two_commands_are_there() -> None:
    commands = re.findall(r'^pip install "\..*$', README, re.MULTILINE)
    assert len(commands) == 2
    assert commands[0].startswith('pip install ".[plot]" && python -m crankpin sweep ')
    assert commands[1] == 'pip install ".[test]" && pytest'


def test_what_it_links_to_is_there() -> None:
    root = Path(__file__).parents[2]
    for target in re.findall(r"\]\(([^)#:]+)\)", README):
        assert (root / target).exists(), target
