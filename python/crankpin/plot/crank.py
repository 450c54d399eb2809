"""A crankshaft as a star seen from the flywheel, and from the side."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox

from crankpin._support import labels, units
from crankpin.analysis.geometry import (
    assumed_bores,
    direction,
    geometry,
    rotating_masses,
    weights_on_crank,
    weights_on_shafts,
)
from crankpin.model.crankpins import Crankpin, throws
from crankpin.plot.layout import in_units, inches_of, points_of
from crankpin.plot.section import shaft_text
from crankpin.plot.shapes import (
    JOURNAL,
    Inks,
    add,
    arrow_round,
    bar,
    box,
    by_direction,
    crank_radius,
    disc,
    inks_of,
    listed,
    outside,
    pins_in_line,
    radius_of_amounts,
    text_corner,
    wedge,
)
from crankpin.plot.style import write
from crankpin.plot.words import plain_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.geometry import Weight
    from crankpin.model.engine import Engine

PIN_MARKS = "crankpin pins"
"""Marks the main journal, then the crankpins."""
UNBALANCES = "crankpin unbalances"
"""Marks the discs of rotating masses in the star, then the sectors of counterweights."""
LINE_HEIGHT = 1.3
"""Height of a line of text over the size of its font."""
AS_LARGE = 6.0**-0.5
"""Radius of a disc over that of a sector of the same area."""
APART = 3.5
"""Distance of two stars, in what each needs on either side: numbers of pins need room between."""
WEIGHTS = "crankpin counterweights"
"""Marks the counterweights of the side view."""
LOAD_MARKS = "crankpin loads"
"""Marks the places of periodic loads in the side view."""
MOST_LOADS = 8
"""Places of loads that have their names."""
LONGEST_NAMES = 40
"""Most characters of the names at one place."""

# --- star ---------------------------------------------------------------------------------------


def cranks_with_parts(engine: Engine) -> list[int]:
    """Return the indices of the cranks that have throws or weights."""
    carrying = {weight.crank for weight in weights_on_crank(engine)}
    return sorted(carrying | {pin.crank for throw in throws(engine) for pin in throw}) or [0]


def crank_text(engine: Engine, crank: int) -> str:
    """Return the words at one of several cranks: which one, and how it turns."""
    ratio = engine._core.cranks[0][crank][2]
    return shaft_text(f"crank {crank}", ratio) if crank else "main crank"


def star(engine: Engine, ax: Axes, theta_deg: float, **style: object) -> None:
    """Draw crankpins in their directions, numbered, with rotating masses and counterweights.

    Unbalances of one direction are added up; the area of their disc or sector is as the sum. Stars
    of several cranks are beside each other.
    """
    ink = inks_of(ax)
    largest = crank_radius(engine)
    half = 0.65 * JOURNAL * largest
    cranks = cranks_with_parts(engine)
    pins = {crank: pins_in_line(engine, theta_deg, crank) for crank in cranks}
    masses, weights = rotating_masses(engine, theta_deg), weights_on_crank(engine, theta_deg)
    rotating, balancing = (
        [
            (crank, *group)
            for crank in cranks
            for group in by_direction(one for one in kind if one.crank == crank).items()
        ]
        for kind in (masses, weights)
    )
    radii = radius_of_amounts(engine, [amount for *_, amount in [*rotating, *balancing]])
    # Rotating masses are round and at their pins, so that they do not look like counterweights.
    rounds = [AS_LARGE * radius for radius in radii[: len(rotating)]]
    reach = max([1.25 * largest, *radii[len(rotating) :], *(largest + radius for radius in rounds)])
    limit = 1.25 * reach
    apart = APART * limit
    centres = {crank: complex(apart * k) for k, crank in enumerate(cranks)}
    sectors = [
        *(
            disc(centres[crank] + largest * at, radius)
            for (crank, at, _), radius in zip(rotating, rounds, strict=True)
        ),
        *(
            wedge(centres[crank], radius, float(np.degrees(np.angle(at))))
            for (crank, at, _), radius in zip(balancing, radii[len(rotating) :], strict=True)
        ),
    ]
    faces = [ink.journal] * len(rotating) + [ink.weight] * len(balancing)
    add(ax, sectors, facecolor=faces, edgecolor=ink.line, linewidth=0.6, zorder=2, gid=UNBALANCES)
    looks = {"facecolor": ink.web, "edgecolor": ink.line, "linewidth": 0.8, "zorder": 3}
    places = [(centres[crank], centres[crank] + at) for crank in cranks for at in pins[crank]]
    add(ax, [bar(axis, at, 2.6 * half, 1.3 * half) for axis, at in places], **(looks | style))
    journals = [
        *(disc(centre, 1.5 * half) for centre in centres.values()),
        *(disc(at, half) for _, at in places),
    ]
    faces = [ink.paper] * len(centres) + [ink.journal] * len(places)
    add(ax, journals, facecolor=faces, edgecolor=ink.line, linewidth=0.8, zorder=4, gid=PIN_MARKS)
    # The layout may make the axes smaller yet.
    width = 2.0 * limit + apart * (len(cranks) - 1)
    scale = 0.8 * 72.0 * inches_of(ax) / width
    lines = 1
    for crank, centre in centres.items():
        circle = centre + largest * direction(np.linspace(0.0, 360.0, 181))
        ax.plot(circle.real, circle.imag, color=ink.faint, linewidth=0.8, linestyle="-", zorder=1)
        gap = _widest_gap([*pins[crank]]) if pins[crank] else 0.0
        arrow_round(ax, largest, gap, ink, centre, engine._core.cranks[0][crank][2])
        for at, cylinders in _numbers(ax, pins[crank], scale * reach).items():
            text = listed(cylinders)
            if len(cranks) > 1:  # there is little room between stars
                on_a_line = "(, [^,]+), " if len(cranks) == 2 else "([^,]+), "
                text = re.sub(on_a_line, r"\1,\n", text)
            lines = max(lines, text.count("\n") + 1)
            outside(ax, centre + reach * at, text, centre)
    # Below the numbers of pins.
    line = LINE_HEIGHT * FontProperties(size="small").get_size_in_points()
    below = 9.0 + line * lines
    for crank, centre in centres.items() if len(cranks) > 1 else ():
        text = plain_text(crank_text(engine, crank))
        write(ax, text, centre - 1j * reach, -1j * below, va="top", fontsize="x-small")
    ax.set_aspect("equal")
    ax.set_xlim(-limit, width - limit)
    if len(cranks) == 1:
        ax.set_ylim(-limit, limit)
    else:
        ax.set_ylim(-reach - (below + line) / scale, reach + below / scale)
    ax.set_axis_off()


def _numbers(ax: Axes, pins: dict[complex, list[int]], radius: float) -> dict[complex, list[int]]:
    """Join the cylinders of pins whose numbers would overlap at a radius, points."""
    font = FontProperties(size="small")
    labels = [
        (at / abs(at), cylinders)
        for at, cylinders in sorted(pins.items(), key=lambda pin: float(np.angle(pin[0])))
    ]

    def place(towards: complex, cylinders: list[int]) -> Bbox:
        anchor = radius * towards
        left, bottom = text_corner(towards)
        width, height = points_of(ax, listed(cylinders), font), font.get_size_in_points()
        x0, y0 = anchor.real + left * width, anchor.imag + bottom * height
        return Bbox.from_bounds(x0, y0, width, height)

    k = 0
    while len(labels) > 1 and k < len(labels):
        (a, first), (b, second) = labels[k - 1], labels[k]
        if place(a, first).padded(1.0).overlaps(place(b, second).padded(1.0)):
            labels[k] = ((a + b) / abs(a + b), sorted(first + second))
            del labels[k - 1]
            k = 0
        else:
            k += 1
    return dict(labels)


def _widest_gap(places: list[complex]) -> float:
    """Return the middle of the widest gap between directions, degrees."""
    angles = np.sort(np.degrees(np.angle(places)))
    gaps = np.diff(angles, append=angles[0] + 360.0)
    widest = int(np.argmax(gaps.round(6)))
    return float(angles[widest] + 0.5 * gaps[widest])


# --- side ---------------------------------------------------------------------------------------


class Stretch(NamedTuple):
    """A crankpin, and the part of the crank that it takes as drawn."""

    pin: Crankpin
    low: float
    high: float
    """From one web to the next, m."""


def side(engine: Engine, ax: Axes, theta_deg: float, **style: object) -> None:
    """Draw journals, crankpins, webs, unbalances and balance shafts over z, as seen from x < 0.

    Several cranks are below each other, each about a line of its own.
    """
    ink = inks_of(ax)
    at = geometry(engine, theta_deg)
    up = (at.crankpin - at.axis).imag  # every crank on one line
    drawn, pitch = _stretches(engine)
    thick = 0.09 * pitch
    half = JOURNAL * crank_radius(engine)
    front = min(throw[0].low for throw in drawn) - 2.0 * thick
    back = max(throw[-1].high for throw in drawn) + 4.0 * thick
    lines = _lines(engine)
    per_metre = 0.7 * 72.0 * inches_of(ax) / (back - front)
    journals = [_rectangle(front, back, line - half, line + half) for line in lines.values()]
    webs = []
    taken: set[tuple[float, float, bool]] = set()
    reach = 2.0 * crank_radius(engine)
    for throw in drawn:
        line = lines[throw[0].pin.crank]
        heights = [line + float(up[stretch.pin.cylinders[0] - 1]) for stretch in throw]
        for (_, low, high), height in zip(throw, heights, strict=True):
            journals.append(_rectangle(low, high, height - half, height + half))
        middle = 0.5 * (throw[0].low + throw[-1].high)
        room = pitch / len(throw)
        for k, (stretch, height) in enumerate(zip(throw, heights, strict=True)):
            # Numbers of pins side by side have the room between throws too.
            z = middle + (k - 0.5 * (len(throw) - 1)) * room
            is_up = _is_up(taken, line, z, height, half)
            edge = complex(z, height + (1.2 if is_up else -1.2) * half)
            points = _number(ax, edge, is_up, stretch.pin.cylinders, 0.9 * room * per_metre)
            reach = max(reach, abs(height - line) + 1.2 * half + points / per_metre)
        # Webs: from the main journal to a pin, from pin to pin, and back to the main journal.
        joined = zip([line, *heights], [*heights, line], strict=True)
        edges = [throw[0].low, *(stretch.high for stretch in throw)]
        for (a, b), z in zip(joined, edges, strict=True):
            low, high = min(a, b) - 1.2 * half, max(a, b) + 1.2 * half
            webs.append(_rectangle(z - 0.5 * thick, z + 0.5 * thick, low, high))
    looks = {"facecolor": ink.journal, "edgecolor": ink.line, "linewidth": 0.8, "zorder": 3}
    add(ax, journals, gid=PIN_MARKS, **looks)
    add(ax, webs, **(looks | {"facecolor": ink.web} | style))
    flywheel = 1.5 * crank_radius(engine)
    wheels = [
        _rectangle(back, back + 2.0 * thick, line - flywheel, line + flywheel)
        for line in lines.values()
    ]
    add(ax, wheels, facecolor=ink.metal, edgecolor=ink.line, linewidth=0.8, zorder=3)
    _weights(engine, ax, theta_deg, ink, thick, lines)
    _shafts(engine, ax, theta_deg, ink, (front, back + 2.0 * thick), thick)
    low = _loads(engine, ax, ink, lines, min(lines.values()) - reach, (front, back))
    ax.update_datalim([(front - thick, low), (back + 3.0 * thick, lines[min(lines)] + reach)])
    to_scale = pitch > 0.5 * crank_radius(engine)
    if len(lines) > 1:
        _name_cranks(engine, ax, lines, back + 2.0 * thick)
        to_scale &= _fit_in_height(ax, drawn, pitch, lines[min(lines)] + reach - low)
    ax.set_aspect("equal" if to_scale else "auto")
    ax.autoscale_view()
    (upright,) = in_units(ax.yaxis, units.headed("y", "m"))
    ax.set_ylabel(upright if len(lines) == 1 else f"{upright}, cranks apart")
    said = "" if to_scale else " (not to the scale of y)"
    (along,) = in_units(ax.xaxis, units.Text(units.headed("z", "m"), said))
    ax.set_xlabel(along)


def _name_cranks(engine: Engine, ax: Axes, lines: dict[int, float], z: float) -> None:
    """Write which crank is which, beyond the flywheels."""
    for crank, line in lines.items():
        name = plain_text(crank_text(engine, crank))
        write(ax, name, complex(z, line), 4.0 + 0j, ha="left", fontsize="x-small")


def _fit_in_height(ax: Axes, drawn: list[list[Stretch]], pitch: float, height: float) -> bool:
    """Return whether numbers of pins have room between throws at the scale of the axes' height."""
    font = FontProperties(size="small")
    widest = max(points_of(ax, listed(pin.cylinders), font) for throw in drawn for pin, *_ in throw)
    return widest <= 0.9 * pitch * 0.7 * 72.0 * inches_of(ax, "height") / height


def _lines(engine: Engine) -> dict[int, float]:
    """Return the height at which each crank is drawn: the first at its own, others below it, m."""
    first, *others = cranks_with_parts(engine)
    below = min([0.0, *(shaft.y for shaft in engine.shafts)])
    apart = 6.0 * crank_radius(engine)
    return {first: 0.0} | {crank: below - apart * k for k, crank in enumerate(others, 1)}


def _stretches(engine: Engine) -> tuple[list[list[Stretch]], float]:
    """Divide the crank among its throws, and each throw's stretch among its pins.

    Pins at one place along the crank are drawn side by side, as they are built. Also return the
    distance between throws.
    """
    throw_list = throws(engine)
    middles = [float(np.mean([pin.z for pin in throw])) for throw in throw_list]
    cranks = np.array([throw[0].crank for throw in throw_list])
    apart = np.concatenate(
        [np.diff(np.sort(np.array(middles)[cranks == crank])) for crank in set(cranks.tolist())]
    )
    pitch = float(apart[apart > 0.0].min(initial=np.inf))
    if not np.isfinite(pitch):
        pitch = 1.2 * float(assumed_bores(engine).max())
    width = 0.62 * pitch
    drawn = []
    for middle, throw in zip(middles, throw_list, strict=True):
        edges = middle + width * (np.linspace(0.0, 1.0, len(throw) + 1) - 0.5)
        drawn.append(
            [Stretch(*stretch) for stretch in zip(throw, edges[:-1], edges[1:], strict=True)]
        )
    return drawn, pitch


def _is_up(
    taken: set[tuple[float, float, bool]], line: float, z: float, height: float, half: float
) -> bool:
    """Return whether the number of a pin is above it: two throws may lie in the middle."""
    is_up = height - line > -1e-9 * half
    is_up ^= (line, round(z, 9), is_up) in taken
    taken.add((line, round(z, 9), is_up))
    return is_up


def _number(ax: Axes, edge: complex, up: bool, cylinders: Sequence[int], room: float) -> float:
    """Write the numbers of a pin's cylinders above its edge, or below it.

    They are below each other where they are wider than ``room``, points. Return how far they reach,
    points.
    """
    text, font = listed(cylinders), FontProperties(size="small")
    if points_of(ax, text, font) > room:
        text = text.replace(", ", "\n")
    write(ax, text, edge, 3.0j if up else -3.0j, va="bottom" if up else "top")
    return 3.0 + LINE_HEIGHT * font.get_size_in_points() * (text.count("\n") + 1)


def _weights(
    engine: Engine, ax: Axes, theta: float, ink: Inks, thick: float, lines: dict[int, float]
) -> None:
    weights = weights_on_crank(engine, theta)
    radii = radius_of_amounts(engine, [weight.amount for weight in weights])
    plates = [
        _plate(weight, radius, lines[weight.crank], thick)
        for weight, radius in zip(weights, radii, strict=True)
    ]
    add(ax, plates, facecolor=ink.weight, edgecolor=ink.line, linewidth=0.8, zorder=4, gid=WEIGHTS)


def _shafts(
    engine: Engine, ax: Axes, theta: float, ink: Inks, ends: tuple[float, float], thick: float
) -> None:
    weights = weights_on_shafts(engine, theta)
    radii = iter(
        radius_of_amounts(engine, [weight.amount for shaft in weights for weight in shaft])
    )
    half = 0.35 * JOURNAL * crank_radius(engine)
    rods, plates = [], []
    names: dict[float, list[str]] = {}
    for shaft, carried in zip(engine.shafts, weights, strict=True):
        rods.append(_rectangle(*ends, shaft.y - half, shaft.y + half))
        plates += [_plate(weight, 0.7 * next(radii), shaft.y, thick) for weight in carried]
        names.setdefault(shaft.y, []).append(shaft_text(shaft.name, shaft.ratio))
    add(ax, rods, facecolor=ink.paper, edgecolor=ink.line, linewidth=0.8, zorder=2)
    add(ax, plates, facecolor=ink.shaft, edgecolor=ink.line, linewidth=0.8, zorder=4)
    for y, texts in names.items():
        name = plain_text(", ".join(texts))
        write(ax, name, complex(ends[1], y), 4.0 + 0j, ha="left", fontsize="x-small")
        ax.update_datalim([(ends[0], y - crank_radius(engine)), (ends[1], y)])


def _loads(
    engine: Engine, ax: Axes, ink: Inks, lines: dict[int, float], low: float, ends: Sequence[float]
) -> float:
    """Mark where periodic loads sit, with their names below everything else; return how low, m.

    Their shafts are at the height of their axes; those of one place share a mark.
    """
    places: dict[tuple[float, float], list[str]] = {}
    for load in engine.loads:
        y = load.y if load.crank is None else lines.get(load.crank, 0.0)
        names = places.setdefault((load.z, y), [])
        if load.name not in names:
            names.append(load.name)
    along = [*ends, *(z for z, _ in places)]
    per_metre = 0.5 * 72.0 * inches_of(ax) / (max(along) - min(along))
    line = LINE_HEIGHT * FontProperties(size="x-small").get_size_in_points() / per_metre
    for k, ((z, y), names) in enumerate(sorted(places.items())):
        at = {"color": ink.line, "zorder": 6}
        ax.plot(z, y, marker="D", markersize=5, markerfacecolor=ink.paper, gid=LOAD_MARKS, **at)
        if k < MOST_LOADS:
            low = min(low, y) - line
            ax.plot([z, z], [y, low], linewidth=0.6, linestyle=":", **at)
            text = labels.cut(labels.one_line(", ".join(names)), LONGEST_NAMES)
            write(ax, plain_text(text), complex(z, low), 3.0 + 0j, ha="left", fontsize="x-small")
        ax.update_datalim([(z, low)])
    return low


def _plate(weight: Weight, radius: float, y: float, thick: float) -> NDArray[np.complex128]:
    """Return the outline from the side of a sector in which an unbalance is drawn."""
    heights = wedge(1j * y, radius, weight.angle_deg).imag
    z = weight.z
    return _rectangle(z - 0.8 * thick, z + 0.8 * thick, heights.min(), heights.max())


def _rectangle(left: float, right: float, low: float, high: float) -> NDArray[np.complex128]:
    return box(complex(0.5 * (left + right), 0.0), 1j, right - left, low, high)
