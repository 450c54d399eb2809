"""Does every block of code in the manual and the README run, and print what is said?"""

from __future__ import annotations

import doctest
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from crankpin.cli import main

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    path.relative_to(ROOT).as_posix()
    for path in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")]
    if "gallery" not in path.parts  # made by the build
)
BLOCK = re.compile(r"^```(.*)\n((?:.*\n)*?)```$", re.MULTILINE)
SHOWN = {
    "",
    "csv",
    "json",
    "text",
    "toml",
    "{commands}",
    "{engine-file}",
    "{eval-rst}",
    "{raw} html",
    "{toctree}",
}
"""Blocks that are not code of ours to run."""
OTHERS = ("#", "cargo ", "git ", "jupyter ", "pip ", "pytest", "python benchmarks/", "sphinx-")
"""Beginnings of lines of shell that no page can run here."""


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(page, marks=[pytest.mark.slow] * page.endswith("/pictures.md"))
        for page in PAGES
    ],
)
def test_code_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for line, language, code in blocks((ROOT / name).read_text(encoding="utf-8")):
        if language.startswith("{workbench}"):  # a link with an engine in it
            continue
        if language == "sh":
            run_commands(code)
        elif ">>>" in code:
            run_examples(code, names, name, line)
        elif language in ("python", "{picture}"):
            exec(compile("\n" * line + code, name, "exec"), names)  # noqa: S102 - our own text
            assert language == "python" or plt.get_fignums(), f"no picture: {name}, line {line}"
        else:
            assert language in SHOWN, f"```{language}: {name}, line {line}"
        plt.close("all")


def blocks(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield line, language and code of each fenced block."""
    for found in BLOCK.finditer(text):
        yield text.count("\n", 0, found.start()) + 1, found[1], found[2]


def run_examples(code: str, names: dict[str, Any], name: str, line: int) -> None:
    """Run examples at a prompt, and compare what they print."""
    report: list[str] = []
    test = doctest.DocTestParser().get_doctest(code, names, name, name, line)
    result = doctest.DocTestRunner(verbose=False).run(test, out=report.append, clear_globs=False)
    assert result.failed == 0, "".join(report)
    names |= test.globs


def run_commands(code: str) -> None:
    """Run the lines of shell that call crankpin, without the shell."""
    for line in code.replace("\\\n", " ").splitlines():
        command, *more = line.split(" && ")
        for each in (command, *more):
            match shlex.split(each, comments=True):
                case ["crankpin", *arguments] | ["python", "-m", "crankpin", *arguments]:
                    if "--help" not in arguments:
                        assert main(arguments) == 0, line
                case words:
                    assert not words or each.startswith(OTHERS), line


@pytest.mark.slow
def test_code_passes_mypy(tmp_path: Path) -> None:
    """Each page is a script; what is shown to be rejected is left out."""
    pytest.importorskip("mypy")
    for page in PAGES:
        lines = ["from typing import Any\n"]
        for _, language, code in blocks((ROOT / page).read_text(encoding="utf-8")):
            if ">>>" in code:
                examples = doctest.DocTestParser().get_examples(code)
                lines += [each.source for each in examples if each.exc_msg is None]
            elif language in ("python", "{picture}"):
                lines.append(code)
        script = "".join(lines)
        # mypy passes a mapping on to arguments of several types if it is said to hold any.
        for mapping in re.findall(r"\*\*(\w+)", script):
            script = re.sub(rf"(?m)^{mapping} = ", f"{mapping}: dict[str, Any] = ", script, count=1)
        (tmp_path / f"{re.sub(r'[^a-z]', '_', page.lower())}.py").write_text(script)
    command = [sys.executable, "-m", "mypy", "--config-file=", "--cache-dir=cache", *OPTIONS, "."]
    found = subprocess.run(  # noqa: S603 - our own text
        command, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stdout + found.stderr


OPTIONS = ("--strict", "--allow-untyped-defs", "--allow-untyped-calls", "--allow-redefinition")
"""Options of mypy: pages are scripts without annotations, which use names again."""
