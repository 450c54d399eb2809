"""Words on pictures: names, titles and numbers."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.textpath import TextPath

from crankpin._support import labels
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.font_manager import FontProperties
    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.sweeps.waveform import SweepWaveform
    from crankpin.analysis.waveform import Waveform


def plain_text(text: str) -> str:
    """Return text that matplotlib shows unchanged: dollar signs would start a formula."""
    return text.replace("$", r"\$")


def number(value: float) -> str:
    """Write 12000.0 as 12 000, and minus as minus."""
    text = f"{value:,.10g}" if abs(value) >= 1e4 else f"{value:.10g}"
    return text.replace(",", "\N{NO-BREAK SPACE}").replace("-", "−")


def in_degrees(value: float) -> str:
    """Write an angle with its unit."""
    return f"{number(value)}°"


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

HINTED = 1.06
"""Text drawn with few dots per inch, relative to its outlines: hinting moves letters apart."""


def width_of(text: str, font: FontProperties) -> float:
    """Return the width of a line of text at screen resolution, points."""
    if not text.strip():
        return 0.0
    path = TextPath((0.0, 0.0), plain_text(text), size=font.get_size_in_points(), prop=font)
    return HINTED * float(path.get_extents().x1)


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


# --- quantities ---------------------------------------------------------------------------------


def with_unit(quantity: str, *, peak: bool = False) -> str:
    """Return the name of a quantity with its unit, for an axis."""
    name = QUANTITIES[quantity].words
    return f"{'peak ' if peak else ''}{name}, {QUANTITIES[quantity].unit}"


def by_component(values: NDArray[Any], quantity: str) -> NDArray[Any]:
    """Return values whose last dimension is the component: x and y, or z alone."""
    return values if quantity in PLANE_VECTORS else values[..., np.newaxis]


def series_names(quantity: str, label: str | None) -> list[str]:
    """Return names of the components of a quantity for a legend, with a label before them."""
    names = list(QUANTITIES[quantity].components)
    if not label:
        return names
    return [label] if len(names) == 1 else [f"{label}, {name}" for name in names]


def summed(result: Waveform | SweepWaveform, quantity: str) -> str:
    """Return how a waveform was computed: exact, or which orders and what the rest can add."""
    if result.orders is None:
        return "exact kinematics"
    text = labels.orders_text(result.orders)
    bound = getattr(result.error_bound, "torque" if quantity == "crank_torque" else quantity)
    return f"{text} (the rest ≤ {rounded(bound, 2)} {QUANTITIES[quantity].unit})" if bound else text
