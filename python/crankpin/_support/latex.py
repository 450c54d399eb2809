"""Tables as LaTeX: a tabular with the rules of booktabs."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from crankpin._support import labels

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

LATEX_NUMBER = re.compile(r"(-?[\d.]+)(?:e([-+]?\d+))?", re.ASCII)

SYMBOL = re.compile(r"(\|[A-Za-z](?:_[a-z])?\||\b[A-Z]_[a-z]\b)")
"""Symbols of quantities as heads have them."""

SPECIAL = {
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}",
}  # fmt: skip
"""Characters that are commands in LaTeX, or are typeset differently."""
GREEK = (
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
)  # fmt: skip
LATEX_SYMBOLS = {
    "−": "-", "±": r"\pm", "·": r"\cdot", "×": r"\times", "→": r"\rightarrow",
    "≠": r"\neq", "≤": r"\leq", "≥": r"\geq", "√": r"\surd", "Ω": r"\Omega", "Δ": r"\Delta",
    "Σ": r"\Sigma", "°": r"^\circ", "½": r"\frac{1}{2}", "∞": r"\infty", "′": r"^\prime",
    "″": r"^{\prime\prime}", "ₙ": "_n", "ₖ": "_k",
    **{letter: rf"\{name}" for letter, name in zip("αβγδεζηθικλμνξπρστυφχψω", GREEK, strict=True)},
    **{"⁰¹²³⁴⁵⁶⁷⁸⁹"[k]: f"^{k}" for k in range(10)},
    **{"₀₁₂₃₄₅₆₇₈₉"[k]: f"_{k}" for k in range(10)},
}  # fmt: skip
"""Characters that fonts of text lack."""
ESCAPES = str.maketrans(
    SPECIAL
    | {character: f"${command}$" for character, command in LATEX_SYMBOLS.items()}
    | {"–": "--"}
)


def escaped(text: str) -> str:
    """Return a text as LaTeX sets it, in one line."""
    return labels.one_line(text).translate(ESCAPES)


def in_mathematics(text: str) -> str:
    """Return a text as it stands in a formula: words as text, symbols as mathematics."""
    words = escaped(text).split("$")  # by turns words and symbols
    return "".join(part if k % 2 else rf"\text{{{part}}}" for k, part in enumerate(words) if part)


def _cell(text: str) -> str:
    """Return a cell; a number with a sign or an exponent in mathematics."""
    match = LATEX_NUMBER.fullmatch(text)
    if match is None:
        return escaped(text)
    figure, exponent = match.groups()
    if exponent is None:
        return f"${text}$" if text.startswith("-") else text
    return rf"${figure} \times 10^{{{int(exponent)}}}$"


def _head(text: str) -> str:
    """Return a head of a column: symbols with an index in mathematics, ``|F_x|`` or ``M_z``."""
    parts = SYMBOL.split(labels.one_line(text))  # by turns text and symbols
    return "".join(
        f"${part}$" if k % 2 else part.translate(ESCAPES) for k, part in enumerate(parts)
    )


def _row(cells: Iterable[str]) -> str:
    """Return a row; one that begins with a bracket or a star is no option of the line before it."""
    row = " & ".join(cells)
    return ("{}" if row.startswith(("[", "*")) else "") + row + r" \\"


def table(
    title: str,
    heads: Iterable[str],
    rows: Sequence[Sequence[str]],
    notes: Iterable[str],
    columns: str,
) -> str:
    """Return a table: heads and rows between rules, the title as caption, notes below.

    Parameters
    ----------
    title
        The caption; without one there is none.
    heads
        Head of each column.
    rows
        Cells of each row.
    notes
        Lines under the table.
    columns
        ``l`` or ``r`` for each column.
    """
    lines = [_row(map(_cell, row)) for row in rows]
    caption = [rf"\caption{{{escaped(title)}}}"] if title else []
    return "\n".join(
        [
            r"\begin{table}",
            r"\centering",
            *caption,
            rf"\begin{{tabular}}{{{columns}}}",
            r"\toprule",
            _row(map(_head, heads)),
            r"\midrule",
            *lines,
            r"\bottomrule",
            r"\end{tabular}",
            *(rf"\par\smallskip{{\footnotesize {escaped(note)}}}" for note in notes),
            r"\end{table}",
            "",
        ]
    )
