"""Do the tutorials run, are they right, and is what they show what they give?

Each runs in a kernel, as a reader runs it, with the checks of ``checks/`` after its cells.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

TUTORIALS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
CHECKS = Path(__file__).parent / "checks"
TIMED = "6-speed-against-accuracy"
"""The tutorial whose outputs are measurements."""


def read(file: Path) -> Any:  # noqa: ANN401 - a notebook
    import nbformat

    return nbformat.read(file, as_version=4)


@pytest.mark.parametrize("file", TUTORIALS, ids=lambda file: file.stem)
def test_a_tutorial_opens_with_what_will_be_seen(file: Path) -> None:
    title, _, picture, *_ = read(file).cells
    head, _, sentence = title.source.partition("\n\n")
    assert head.startswith("# ")
    assert sentence.startswith("**You will see** ")
    assert sentence.endswith(".")
    assert "\n\n" not in sentence
    assert any("image/png" in output.get("data", {}) for output in picture.outputs)


@pytest.mark.parametrize("file", TUTORIALS, ids=lambda file: file.stem)
def test_a_tutorial_needs_the_package_alone_or_says_what_besides(file: Path) -> None:
    cells = read(file).cells
    reaches_out = any("../" in cell.source for cell in cells if cell.cell_type == "code")
    said = any("runs in a\nclone of the repository" in cell.source for cell in cells)
    assert reaches_out == said == (file.stem == TIMED)


@pytest.mark.slow
@pytest.mark.parametrize("file", TUTORIALS, ids=lambda file: file.stem)
def test_tutorial(file: Path) -> None:
    import nbformat  # of seconds, with what runs notebooks
    from nbclient import NotebookClient

    notebook = read(file)
    text = (CHECKS / f"{file.stem}.py").read_text(encoding="utf-8")
    pieces = re.split(r"^# %% after (\S+)\n", text, flags=re.MULTILINE)
    checks = dict(zip(pieces[1::2], pieces[2::2], strict=True))
    saved = notebook.cells
    before = [texts(cell) for cell in saved]
    cells = []
    for cell in saved:
        cells.append(cell)
        if cell.id in checks:
            cells.append(nbformat.v4.new_code_cell(checks.pop(cell.id)))
    assert not checks, "cells that are not in the notebook"
    notebook.cells = cells
    # On a busy machine a kernel sends what a cell prints in pieces.
    place = {"metadata": {"path": file.parent}}
    NotebookClient(notebook, timeout=600, resources=place, coalesce_streams=True).execute()
    if file.stem != TIMED:
        # What readers see is what they would get; CONTRIBUTING says how to save it again.
        for cell, shown in zip(saved, before, strict=True):
            assert texts(cell) == shown, cell.source


def texts(cell: Any) -> list[str]:  # noqa: ANN401 - of a notebook
    """Return what a cell has written, without pictures, and without warnings, which name files."""
    found = []
    for output in cell.get("outputs", []):
        data = output.get("data", {"text/plain": output.get("text", "")})
        if "image/png" not in data and output.get("name") != "stderr":
            found += [data[kind] for kind in ("text/plain", "text/html") if kind in data]
    return [text for text in found if "<svg" not in text]
