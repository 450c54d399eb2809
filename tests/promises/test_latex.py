"""Is LaTeX that crankpin writes read by LaTeX: every table of every result, and closed forms?

Where pdflatex is there (``apt-get install texlive-latex-recommended``) all of it is compiled;
anywhere the mathematics in it is parsed by matplotlib.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from functools import cache
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.frames import Framed
from matplotlib.mathtext import MathTextParser
from support.objects import CHARACTERS, OBJECTS

if TYPE_CHECKING:
    from pathlib import Path

ENGINES = ("single", "v-twin-45", "i3", "v6-60", "v8-crossplane", "radial-5", "boxer-4")
PREAMBLE = r"""\documentclass{article}
\usepackage{amsmath,booktabs,textcomp}
\begin{document}
"""


@cache
def tables() -> dict[str, str]:
    """Every frame of every result, and tables of names with any characters in them."""
    found = {
        f"{name}: {frame}": value.to_latex(frame=frame)
        for name, value in OBJECTS.items()
        if isinstance(value, Framed)
        for frame in value.frames
    }
    rng = np.random.default_rng(1)
    for k in range(20):
        words = ["".join(rng.choice([*CHARACTERS], 12)) for _ in range(4)]
        table = cp.results.Table.from_rows(words[0], [words[1], "x"], words[2:], rng.random((2, 1)))
        found[f"any text {k}"] = table.to_latex()
    return found


@cache
def closed_forms() -> dict[str, str]:
    """Amplitudes of forces and moments as notebooks show them."""
    found = {}
    for name in ENGINES:
        for order in (1, 2):
            for quantity in ("force", "moment"):
                form = cp.Engine.preset(name).closed_form(order, quantity)
                found[f"{name}, {quantity} of order {order}"] = form._repr_latex_()
    return found


def test_mathematics_is_read_by_matplotlib() -> None:
    parser = MathTextParser("path")
    read = 0
    for name, latex in tables().items():
        for part in re.findall(r"(?<!\\)\$([^$]+)\$", latex):
            parser.parse(f"${part}$")
            read += 1
        assert "\\" not in re.sub(r"\\[A-Za-z]+|\\[\\&%$#_{}]", "", latex), name
    assert read > 100
    for latex in closed_forms().values():
        assert latex.count("{") == latex.count("}")
        plain = re.sub(r"\$|\\displaystyle|\\(?:begin|end)\{\w+\*?\}|&", "", latex)
        for row in re.split(r"\\\\", plain):
            parser.parse(f"${row.strip()}$")


@pytest.mark.slow
def test_tables_and_closed_forms_are_compiled(tmp_path: Path) -> None:
    if (engine := shutil.which("pdflatex")) is None:
        pytest.skip("pdflatex is not installed")
    parts = []
    for name, latex in (tables() | closed_forms()).items():
        named = re.sub(r"[^ -~]|[\\{}%#~^&_$]", "?", name)
        parts.append(rf"\typeout{{crankpin: {named}}}" + "\n" + latex + "\n\\clearpage\n")
    source = tmp_path / "all.tex"
    source.write_text(PREAMBLE + "".join(parts) + "\\end{document}\n", encoding="utf-8")
    run = subprocess.run(  # noqa: S603 - of a program by its path
        [engine, "-interaction=nonstopmode", "-halt-on-error", source.name],
        cwd=tmp_path,
        capture_output=True,
        check=False,
    )
    said = run.stdout.decode("utf-8", "replace")
    assert run.returncode == 0, said[-2000:]
    assert "Missing character" not in (tmp_path / "all.log").read_text("latin-1")
    assert (tmp_path / "all.pdf").stat().st_size > 10_000


def test_symbols_of_heads_are_mathematics() -> None:
    text = cp.Engine.preset("v6-60").balance(3000).to_latex()
    assert r"order & $|F_x|$ N & $|F_y|$ N & $|M_x|$ N$\cdot$m" in text
    assert r"\_" not in text.split(r"\midrule")[0]
