"""Words on pictures: names, titles and numbers."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.textpath import TextPath

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.font_manager import FontProperties
    from numpy.typing import ArrayLike

    from crankpin.model.engine import Engine


def name_of(engine: Engine) -> str:
    """Return the name of an engine, or its number of cylinders."""
    return engine.name or f"{len(engine)} cylinders"


def plain_text(text: str) -> str:
    """Return text that matplotlib shows unchanged: dollar signs would start a formula."""
    return text.replace("$", r"\$")


def number(value: float) -> str:
    """Write 12000.0 as 12 000, and minus as minus."""
    text = f"{value:,.10g}" if abs(value) >= 1e4 else f"{value:.10g}"
    return text.replace(",", "\N{NO-BREAK SPACE}").replace("-", "−")


def rounded(value: float, digits: int = 3) -> str:
    """Write a number to so many significant digits."""
    return number(float(f"{value:.{digits}g}"))


def numbers(values: ArrayLike) -> list[str]:
    """Write numbers with few digits that distinguish them: 0.3364 for 0.33636364, but 51.4286."""
    exact = [float(value) for value in np.asarray(values, dtype=np.float64).ravel()]
    for digits in range(4, 11):
        short = [float(f"{value:.{digits}g}") for value in exact]
        if len(set(short)) == len(set(exact)):
            break
    texts = (number(value) for value in exact)
    return [
        text if len(text) <= 7 else number(value) for text, value in zip(texts, short, strict=True)
    ]


def short_names(names: Sequence[str]) -> tuple[list[str], str]:
    """Return names without the words they share at either end, and these words."""
    words = [name.split() for name in names]
    shortest = min(len(each) for each in words) - 1
    head = tail = 0
    if len(set(names)) > 1:
        while head < shortest and len({each[head] for each in words}) == 1:
            head += 1
        while tail < shortest - head and len({each[-1 - tail] for each in words}) == 1:
            tail += 1
    shared = words[0][:head] + words[0][len(words[0]) - tail :]
    short = [" ".join(each[head : len(each) - tail]).strip(",;:") for each in words]
    return short, " ".join(shared).rstrip(",;:")


# --- text that fits -----------------------------------------------------------------------------


def width_of(text: str, font: FontProperties) -> float:
    """Return the width of a line of text, points."""
    if not text.strip():
        return 0.0
    path = TextPath((0.0, 0.0), text, size=font.get_size_in_points(), prop=font)
    return float(path.get_extents().x1)


def wrapped(text: str, width: float, font: FontProperties) -> str:
    """Break lines of text between words, so that they are narrower than ``width`` points."""
    lines = []
    for line in text.split("\n"):
        whole = width_of(line, font)
        if whole <= width:
            lines.append(line)
            continue
        characters = max(8, int(len(line) * width / whole))
        lines += textwrap.wrap(line, characters, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines)


def shortened(text: str, width: float, font: FontProperties) -> str:
    """Cut text to ``width`` points, with an ellipsis."""
    whole = width_of(text, font)
    if whole <= width:
        return text
    return f"{text[: max(1, int(len(text) * width / whole) - 1)].rstrip(' ,;:')}…"
