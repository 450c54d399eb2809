"""Do the tutorials run, and are they right?

Each runs in a kernel, as a reader runs it, with the checks of ``checks/`` after its cells.
"""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

TUTORIALS = sorted((Path(__file__).parents[2] / "docs" / "tutorials").glob("*.ipynb"))
CHECKS = Path(__file__).parent / "checks"


@pytest.mark.slow
@pytest.mark.parametrize("file", TUTORIALS, ids=lambda file: file.stem)
def test_tutorial(file: Path) -> None:
    notebook = nbformat.read(file, as_version=4)
    text = (CHECKS / f"{file.stem}.py").read_text(encoding="utf-8")
    pieces = re.split(r"^# %% after (\S+)\n", text, flags=re.MULTILINE)
    checks = dict(zip(pieces[1::2], pieces[2::2], strict=True))
    cells = []
    for cell in notebook.cells:
        cells.append(cell)
        if cell.id in checks:
            cells.append(nbformat.v4.new_code_cell(checks.pop(cell.id)))
    assert not checks, "cells that are not in the notebook"
    notebook.cells = cells
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": file.parent}}).execute()
