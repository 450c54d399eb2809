"""Words on pictures: names, titles and numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.messages import without_controls
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES, parts_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.waveform import SweepWaveform
    from crankpin.analysis.waveform import Waveform


def plain_text(text: str) -> str:
    """Return text that matplotlib shows: dollar signs would start a formula.

    Control characters are in no font, and not allowed in SVG.
    """
    return without_controls(text).replace("$", r"\$")


def number(value: float) -> str:
    """Write 12000.0 as 12 000, and minus as minus."""
    text = f"{value:,.10g}" if abs(value) >= 1e4 else f"{value:.10g}"
    return text.replace(",", "\N{NO-BREAK SPACE}").replace("-", "−")


def in_degrees(value: float) -> str:
    """Write an angle with its unit."""
    return f"{number(value)}°"


def rounded(value: float, digits: int = 3) -> str:
    """Write a number to ``digits`` significant digits."""
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
    shortest = min(len(word) for word in words) - 1
    start = tail = 0
    if len(set(names)) > 1:
        while start < shortest and len({word[start] for word in words}) == 1:
            start += 1
        while tail < shortest - start and len({word[-1 - tail] for word in words}) == 1:
            tail += 1
    shared = words[0][:start] + words[0][len(words[0]) - tail :]
    short = [" ".join(word[start : len(word) - tail]).strip(",;:") for word in words]
    return short, " ".join(shared).rstrip(",;:")


# --- quantities ---------------------------------------------------------------------------------


def nonzero_in(*results: object) -> Callable[[str], bool]:
    """Return a test of a name: whether one of the results has a quantity that is not all zero."""

    def exists(name: str) -> bool:
        values = (getattr(result, name, None) for result in results)
        return any(value is not None and np.any(getattr(value, "peak", value)) for value in values)

    return exists


def drawn_quantity(
    quantity: object, exists: Callable[[str], bool], among: Collection[str] = QUANTITIES
) -> str:
    """Return the requested quantity; by default the moment, or the first that exists."""
    if quantity is not None:
        return inputs.one_of("quantity", quantity, among)
    names = [name for name in ("moment", "force", "torque") if name in among]
    return next((name for name in names if exists(name)), names[0])


def objective_words(objective: Objective) -> units.Text:
    """Return what an objective is, with its unit, for an axis."""
    return units.headed(objective.words.split(", ")[0], objective.unit)


def with_unit(quantity: str, *, peak: bool = False) -> units.Text:
    """Return the name of a quantity with its unit, for an axis."""
    name = QUANTITIES[quantity].words
    return units.headed(f"{'peak ' if peak else ''}{name}", QUANTITIES[quantity].unit)


def by_component(values: NDArray[Any], quantity: str) -> NDArray[Any]:
    """Return values whose last dimension is the component: x and y, or z alone."""
    return values if quantity in PLANE_VECTORS else values[..., np.newaxis]


def series_of(result: Balance | Waveform, quantity: str) -> list[str]:
    """Return what is drawn of a quantity: of a torque its parts too, where there are several."""
    parts = () if quantity in PLANE_VECTORS else parts_of(quantity, result.causes)
    return [quantity, *parts]


def loads_of(result: object, quantity: str = "torque") -> str:
    """Return which loads a picture of a quantity counts; empty where no others could."""
    loads: str = getattr(result, "loads_counted", "")
    return loads if "torque" in quantity or loads == labels.SPECTRUM_GIVEN else ""


def joined(*parts: str) -> str:
    """Return the parts of a subtitle that are there, with commas."""
    return ", ".join(filter(None, parts))


def series_names(drawn: Sequence[str], label: str | None) -> list[str]:
    """Return names of the components of what is drawn for a legend, with a label before them."""
    names = [name.partition(".")[-1] or "whole" for name in drawn]
    if len(drawn) == 1:
        names = list(QUANTITIES[drawn[0]].components)
    if not label:
        return names
    return [label] if len(names) == 1 else [f"{label}, {name}" for name in names]


def summed(result: Waveform | SweepWaveform, quantity: str) -> str:
    """Return how a waveform was computed: exact, or which orders and what the rest can add."""
    if result.orders is None:
        return "exact kinematics"
    text = labels.orders_text(result.orders)
    bound = result.error_bound[quantity]
    converted = units.convert(QUANTITIES[quantity].unit)
    rest = f"{rounded(bound * converted.factor, 2)} {converted.unit}"
    return f"{text} (the rest ≤ {rest})" if bound else text
