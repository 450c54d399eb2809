"""Outlines of engine parts, as complex points x + iy, and the inks they are drawn in."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch

from crankpin._support import units
from crankpin.analysis.geometry import (
    direction,
    geometry,
    rotating_masses,
    weights_on_crank,
    weights_on_shafts,
)
from crankpin.model.crankpins import crankpins
from crankpin.plot.style import background, colours, foreground, muted, tint, write
from crankpin.plot.words import rounded

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.geometry import Weight
    from crankpin.model.engine import Engine

ROUND = direction(np.arange(0.0, 360.0, 18.0))
"""Corners of what is drawn as a circle."""
WEDGE = direction(np.linspace(-30.0, 30.0, 9))
"""Corners of the arc of a sector, in which an unbalance is drawn."""
JOURNAL = 0.28
"""Radius of crankpins and main journals as drawn, over the crank radius."""


# --- inks ---------------------------------------------------------------------------------------


class Inks(NamedTuple):
    """Colours of the parts of an engine on axes."""

    line: Any
    """Outlines and text."""
    faint: Any
    """Centre lines."""
    paper: Any
    """Background."""
    metal: Any
    """Pistons, rods and flywheel."""
    web: Any
    journal: Any
    """Crankpins, main journals, and rotating masses on them."""
    weight: Any
    """Counterweights."""
    shaft: Any
    """Unbalances of balance shafts."""


def inks_of(ax: Axes) -> Inks:
    """Return the colours of parts: foreground, background, and the first of the axes' cycle."""
    crank, weight, shaft = colours(ax, 3)
    return Inks(
        line=foreground(ax),
        faint=muted(ax, 0.5),
        paper=background(ax),
        metal=muted(ax, 0.15),
        web=tint(ax, crank, 0.9),
        journal=tint(ax, crank, 0.35),
        weight=tint(ax, weight, 0.75),
        shaft=tint(ax, shaft, 0.75),
    )


def legend_handles(engine: Engine, ink: Inks) -> list[Patch]:
    """Return what explains the colours of unbalances, of those that the engine has."""
    on_shafts = [weight for shaft in weights_on_shafts(engine) for weight in shaft]
    kinds = [
        (rotating_masses(engine), ink.journal, "rotating masses"),
        (weights_on_crank(engine), ink.weight, "counterweights"),
        (on_shafts, ink.shaft, "balance shafts"),
    ]
    return [
        Patch(
            facecolor=colour,
            edgecolor=ink.line,
            linewidth=0.6,
            label=f"{name}, up to {_amount(max(weight.amount for weight in weights))} each",
        )
        for weights, colour, name in kinds
        if any(weight.amount for weight in weights)
    ]


# --- outlines -----------------------------------------------------------------------------------


def disc(centre: complex, radius: float) -> NDArray[np.complex128]:
    """Return a circle."""
    return np.asarray(centre + radius * ROUND)


def bar(
    start: complex, end: complex, start_width: float, end_width: float
) -> NDArray[np.complex128]:
    """Return a bar with round ends, each of a width."""
    along = (end - start) / abs(end - start)
    half = direction(np.linspace(90.0, 270.0, 9))
    return np.concatenate(
        [start + 0.5 * start_width * half * along, end - 0.5 * end_width * half * along]
    )


def box(
    foot: complex, along: complex, width: float, low: float, high: float
) -> NDArray[np.complex128]:
    """Return a rectangle about an axis, between two distances along it."""
    side = 0.5j * width * along
    near, far = foot + low * along, foot + high * along
    return np.array([near - side, far - side, far + side, near + side])


def wedge(centre: complex, radius: float, angle_deg: float) -> NDArray[np.complex128]:
    """Return a sector, in which an unbalance in this direction is drawn."""
    return np.concatenate([[centre], centre + radius * WEDGE * direction(angle_deg)])


def points(outline: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return an outline as matplotlib takes it: (n, 2)."""
    return np.stack([outline.real, outline.imag], axis=-1)


def add(ax: Axes, outlines: Iterable[NDArray[np.complex128]], **style: Any) -> None:  # noqa: ANN401
    """Draw outlines, each over the ones before it."""
    if "color" in style:  # of faces and edges; matplotlib warns of both
        style = {
            key: value for key, value in style.items() if key not in {"facecolor", "edgecolor"}
        }
    drawn = PolyCollection([points(outline) for outline in outlines], **style)
    ax.add_collection(drawn, autolim=False)


# --- crank and unbalances -----------------------------------------------------------------------


def pins_in_line(
    engine: Engine, theta_deg: float = 0.0, crank: int = 0
) -> dict[complex, list[int]]:
    """Return the pins of a crank seen from the flywheel: place from its axis, m → cylinders."""
    places = geometry(engine, theta_deg)
    at = places.crankpin - places.axis
    pins: dict[complex, list[int]] = {}
    for pin in (pin for pin in crankpins(engine) if pin.crank == crank):
        place = complex(at[pin.cylinders[0] - 1].round(9))
        pins.setdefault(place, []).extend(pin.cylinders)
    return {complex(at[numbers[0] - 1]): sorted(numbers) for numbers in pins.values()}


def radius_of_amounts(engine: Engine, amounts: Sequence[float]) -> list[float]:
    """Return radii of sectors whose areas are as the amounts; the largest reaches past the pins."""
    largest = max(amounts, default=0.0)
    reach = 1.25 * crank_radius(engine)
    return [reach * float(np.sqrt(amount / largest)) if largest else 0.0 for amount in amounts]


def crank_radius(engine: Engine) -> float:
    """Return the largest crank radius, m."""
    return engine._core.largest_crank_radius


def by_direction(weights: Iterable[Weight]) -> dict[complex, float]:
    """Add up unbalances that point the same way: unit vector → kg·m."""
    sums: dict[complex, float] = {}
    for weight in weights:
        towards = complex(np.round(direction(weight.angle_deg), 6))
        sums[towards] = sums.get(towards, 0.0) + weight.amount
    return sums


# --- words and arrows --------------------------------------------------------------------------


def listed(numbers: Sequence[int]) -> str:
    """Write cylinder numbers, even steps of many in short: ``1, 3, …, 15``."""
    steps = {b - a for a, b in itertools.pairwise(numbers)}
    if len(numbers) >= 3 and steps == {1}:
        return f"{numbers[0]}–{numbers[-1]}"
    if len(numbers) >= 5 and len(steps) == 1:
        return f"{numbers[0]}, {numbers[1]}, …, {numbers[-1]}"
    return ", ".join(map(str, numbers))


def outside(ax: Axes, place: complex, text: str, centre: complex = 0j) -> None:
    """Write beyond a point, as seen from another."""
    towards = (place - centre) / abs(place - centre)
    left, bottom = text_corner(towards)
    ha = {0.0: "left", -0.5: "center", -1.0: "right"}[left]
    va = {0.0: "bottom", -0.5: "center", -1.0: "top"}[bottom]
    write(ax, text, place, 6.0 * towards, ha=ha, va=va)


def text_corner(towards: complex) -> tuple[float, float]:
    """Return the lower left corner of text beyond a point: parts of its width and height."""
    x, y = towards.real, towards.imag
    left = 0.0 if x > 0.02 else -1.0 if x < -0.02 else -0.5
    bottom = 0.0 if y > 0.4 else -1.0 if y < -0.4 else -0.5
    return left, bottom


def arrow_round(
    ax: Axes, radius: float, at_deg: float, ink: Inks, centre: complex = 0j, ratio: float = 1.0
) -> None:
    """Draw the head of an arrow that goes round a crank's axis as it turns."""
    turns = (2.0, -2.0) if ratio > 0.0 else (-2.0, 2.0)
    tip, tail = (centre + radius * complex(direction(at_deg + turn)) for turn in turns)
    look = {"arrowstyle": "-|>", "color": ink.faint, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (tip.real, tip.imag), (tail.real, tail.imag), arrowprops=look)


def _amount(unbalance: float) -> str:
    """Write an unbalance, kg·m."""
    converted = units.convert("kg·m")
    return f"{rounded(unbalance * converted.factor)} {converted.unit}"
