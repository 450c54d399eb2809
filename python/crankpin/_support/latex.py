"""Tables as LaTeX: a tabular with the rules of booktabs."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from crankpin._support import labels

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

NUMBER = re.compile(r"(-?[\d.]+)(?:e([-+]?\d+))?", re.ASCII)

SPECIAL = {
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}",
}  # fmt: skip
"""What LaTeX takes for commands, or sets as other characters."""
SYMBOLS = {
    "−": "-", "±": r"\pm", "·": r"\cdot", "×": r"\times", "→": r"\rightarrow",
    "≠": r"\neq", "≤": r"\leq", "≥": r"\geq", "θ": r"\theta", "λ": r"\lambda", "ω": r"\omega",
    "Ω": r"\Omega", "κ": r"\kappa", "°": r"^\circ", "½": r"\frac{1}{2}", "∞": r"\infty",
    **{"⁰¹²³⁴⁵⁶⁷⁸⁹"[k]: f"^{k}" for k in range(10)},
    **{"₀₁₂₃₄₅₆₇₈₉"[k]: f"_{k}" for k in range(10)},
}  # fmt: skip
"""Characters that fonts of text lack."""
ESCAPES = str.maketrans(
    SPECIAL | {character: f"${command}$" for character, command in SYMBOLS.items()} | {"–": "--"}
)


def escaped(text: str) -> str:
    """Return a text as LaTeX sets it, in one line."""
    return labels.printable(text).translate(ESCAPES)


def _cell(text: str) -> str:
    """Return a cell; a number with a sign or an exponent in mathematics."""
    match = NUMBER.fullmatch(text)
    if match is None:
        return escaped(text)
    figure, exponent = match.groups()
    if exponent is None:
        return f"${text}$" if text.startswith("-") else text
    return rf"${figure} \times 10^{{{int(exponent)}}}$"


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
    lines = [" & ".join(map(_cell, row)) + r" \\" for row in rows]
    caption = [rf"\caption{{{escaped(title)}}}"] if title else []
    return "\n".join(
        [
            r"\begin{table}",
            r"\centering",
            *caption,
            rf"\begin{{tabular}}{{{columns}}}",
            r"\toprule",
            " & ".join(map(escaped, heads)) + r" \\",
            r"\midrule",
            *lines,
            r"\bottomrule",
            r"\end{tabular}",
            *(rf"\par\smallskip{{\footnotesize {escaped(note)}}}" for note in notes),
            r"\end{table}",
            "",
        ]
    )
