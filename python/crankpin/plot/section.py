"""Cross-section of an engine, seen from the flywheel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin._support import units
from crankpin.analysis.geometry import (
    assumed_bores,
    direction,
    geometry,
    weights_on_crank,
    weights_on_shafts,
)
from crankpin.plot.shapes import (
    JOURNAL,
    Inks,
    add,
    arrow_round,
    bar,
    box,
    crank_radius,
    disc,
    inks_of,
    listed,
    outside,
    points,
    radius_of_amounts,
    wedge,
)
from crankpin.plot.style import write
from crankpin.plot.words import number, plain_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.geometry import Geometry
    from crankpin.model.engine import Engine

MOVING = "crankpin moving parts"
"""Marks pistons, rods, piston pins and crankpins, in turn for each cylinder from the front."""
CROWN = 0.32
"""Top of a piston above its pin, over the bore."""
SKIRT = 0.26
"""Bottom of a piston below its pin, over the bore."""
CROSSHEADS = "crankpin crossheads"
"""Marks piston rods, crossheads and what joins these."""
SLIPPER = 0.16
"""Half the length of a crosshead along the bore, over the bore."""
SIDE_RODS = 0.66
"""Distance of side rods from the axis of the bore, over the bore."""
GAP = 0.06
"""Least distance of a piston from a head, of another piston and of a crosshead, over the bore."""


class PistonRods(NamedTuple):
    """Pistons that crossheads drive from outside their cylinders, lengths in m: (n_cylinders,).

    How long piston rods are, no result depends on: crossheads stay outside the cylinders.
    """

    lengths: NDArray[np.float64]
    """From the crosshead's pin to the piston's; 0 of pistons that are their own crossheads."""
    beams: NDArray[np.float64]
    """From the crosshead's pin to the beam above the cylinder on side rods; 0 without these."""
    low: NDArray[np.float64]
    """Distance of the lower end of a cylinder from the foot of the bore's axis."""
    high: NDArray[np.float64]
    """Distance of its upper end: a head, or the place where two pistons meet."""
    side_rods: NDArray[np.bool_]
    """Whether a piston faces the crank and hangs from side rods."""
    is_open: NDArray[np.bool_]
    """Whether a cylinder has no head, as its piston faces another."""
    is_closed: NDArray[np.bool_]
    """Whether it has a head at the crank end."""
    has_head: NDArray[np.bool_]
    """Whether one on side rods has a head beyond its piston."""


def piston_rods(engine: Engine, at: Geometry, bores: NDArray[np.float64]) -> PistonRods:
    """Return piston rods, and the ends of the cylinders that go with them."""
    count = len(engine)
    lengths, beams = np.zeros((2, count))
    low, high = at.lowest - SKIRT * bores, at.highest + (CROWN + 0.04) * bores
    side_rods = np.array([cylinder.side_rods for cylinder in engine.cylinders])
    is_open, is_closed = np.zeros((2, count), dtype=bool)
    above = dict[int, int]()
    for k, m in _sharing(engine):
        is_open[[k, m]] = True
        if side_rods[m]:
            above[k] = m
        else:
            distance = ((at.foot[m] - at.foot[k]) / at.along[k]).real
            high[[k, m]] = low[[k, m]] + 0.5 * (distance - low[[k, m]].sum())
    double = np.array([end is not None for end in engine.crank_ends or [None] * count])
    beyond = at.highest + (SLIPPER + GAP) * bores  # crossheads
    # Between two cranks there is no room for piston rods.
    for k in {*np.flatnonzero(double & ~is_open).tolist(), *above}:
        low[k] = max(beyond[[k, above.get(k, k)]])
        lengths[k] = low[k] + (SKIRT + GAP) * bores[k] - at.lowest[k]
        high[k] = at.highest[k] + lengths[k] + (CROWN + 0.04) * bores[k]
        is_closed[k] = double[k]
    below = {m: k for k, m in above.items()}
    for m in np.flatnonzero(side_rods).tolist():
        low[m] = high[below[m]] if m in below else beyond[m]
        is_closed[m] = m not in below
        is_open[m] = True
        lengths[m] = low[m] + (CROWN + GAP) * bores[m] - at.lowest[m]
        high[m] = at.highest[m] + lengths[m] + (SKIRT + GAP) * bores[m]
        beams[m] = high[m] + GAP * bores[m] - at.lowest[m]
    has_head = side_rods & double
    return PistonRods(lengths, beams, low, high, side_rods, is_open, is_closed, has_head)


def _sharing(engine: Engine) -> Iterator[tuple[int, int]]:
    """Yield the two pistons of shared chambers, by index; one with side rods is the second."""
    for chamber in engine.chambers:
        if len(chamber) == 2:
            one, other = sorted(chamber, key=lambda k: engine.cylinders[k - 1].side_rods)
            yield one - 1, other - 1


def section(engine: Engine, ax: Axes, theta_deg: float, **style: object) -> None:
    """Draw bores, pistons, rods, crank, counterweights and balance shafts."""
    at = geometry(engine, theta_deg)
    bores = assumed_bores(engine)
    ink = inks_of(ax)
    rods = piston_rods(engine, at, bores)
    _walls(engine, ax, at, rods, bores, ink)
    _crank(engine, ax, at, ink)
    _crossheads(engine, ax, at, rods, bores, ink)
    _moving_parts(engine, ax, at, rods, bores, ink, style)
    _shafts(engine, ax, at.theta_deg, ink)
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.set_axis_off()
    _scale_bar(engine, ax, ink)


def _walls(
    engine: Engine, ax: Axes, at: Geometry, rods: PistonRods, bores: NDArray[np.float64], ink: Inks
) -> None:
    """Draw each bore once, with its heads and the numbers of its cylinders.

    A bore in which pistons face each other is open at both ends; the numbers stand beside it.
    Numbers of bores behind each other stand together above the highest.
    """
    seen: dict[tuple[float, ...], list[int]] = {}
    above: dict[tuple[float, ...], list[int]] = {}
    for k, (along, foot) in enumerate(zip(at.along, at.foot, strict=True)):
        ends = rods.low[k], rods.high[k]
        place = np.round([along.real, along.imag, foot.real, foot.imag, bores[k], *ends], 9)
        seen.setdefault(tuple(place.tolist()), []).append(k)
        if not rods.is_open[k]:
            above.setdefault(tuple(place[:4].tolist()), []).append(k)
    cranks = np.mean([complex(x, y) for x, y, _ in engine._core.cranks[0]])
    reached = [disc(axis, 1.8 * crank_radius(engine)) for axis in (0j, *at.axis.tolist())]
    for cylinders in seen.values():
        k = cylinders[0]
        corners = box(at.foot[k], at.along[k], bores[k], rods.low[k], rods.high[k])
        outline = np.append(corners, corners[0]) if rods.is_closed[k] else corners
        walls = corners.reshape(2, 2).T if rods.is_open[k] else outline
        ax.plot(walls.real, walls.imag, color=ink.line, linewidth=1.2, linestyle="-", zorder=2)
        heads = [rods.is_open[k] and rods.is_closed[k], rods.has_head[k]]
        for head, present in zip((corners[[0, 3]], corners[[1, 2]]), heads, strict=True):
            if present:  # at one end alone
                ax.plot(head.real, head.imag, color=ink.line, linewidth=1.2)
        axis = at.foot[k] + np.array([0.0, rods.high[k]]) * at.along[k]
        ax.plot(axis.real, axis.imag, color=ink.faint, linewidth=0.6, linestyle="-.", zorder=1)
        if rods.is_open[k]:
            width = 2.0 * (SIDE_RODS + 0.08) if rods.lengths[k] else 1.0
            beside = box(at.foot[k], at.along[k], width * bores[k], rods.low[k], rods.high[k])
            sides = beside[:2], beside[2:]
            # Away from the cranks, or to the left.
            away = [abs(side.mean() - cranks) - 1e-6 * side.mean().real for side in sides]
            side = sides[int(np.argmax(away))]
            numbers = listed([place + 1 for place in cylinders])
            outside(ax, complex(side.mean()), numbers, complex(beside.mean()))
            top = at.highest[k] + rods.beams[k] + 2.0 * SLIPPER * bores[k] * rods.side_rods[k]
            reached += [beside, box(at.foot[k], at.along[k], width * bores[k], rods.low[k], top)]
        reached.append(corners)
    for cylinders in above.values():
        k = max(cylinders, key=lambda place: float(rods.high[place]))
        numbers = listed([place + 1 for place in cylinders])
        head = at.foot[k] + rods.high[k] * at.along[k]
        outside(ax, complex(head), numbers, complex(at.axis[k]))
    # Numbers need room beyond the heads.
    ax.update_datalim(points(1.06 * np.concatenate(reached)))


def _crank(engine: Engine, ax: Axes, at: Geometry, ink: Inks) -> None:
    largest = crank_radius(engine)
    width = 2.0 * JOURNAL * largest
    weights = weights_on_crank(engine, at.theta_deg)
    radii = radius_of_amounts(engine, [weight.amount for weight in weights])
    sectors = [
        wedge(weight.axis, radius, weight.angle_deg)
        for radius, weight in zip(radii, weights, strict=True)
        if radius
    ]
    add(ax, sectors, facecolor=ink.weight, edgecolor=ink.line, linewidth=0.6, zorder=2.5)
    pins = zip(at.axis.tolist(), at.crankpin.round(9).tolist(), strict=True)
    webs = [bar(*pin, 1.3 * width, width) for pin in dict.fromkeys(pins)]
    add(ax, webs, facecolor=ink.web, edgecolor=ink.line, linewidth=0.6, zorder=3)
    axes = dict.fromkeys([0j, *at.axis.tolist(), *(weight.axis for weight in weights)])
    journals = [disc(axis, 0.5 * width) for axis in axes]
    add(ax, journals, facecolor=ink.paper, edgecolor=ink.line, zorder=3.1)
    carrying = {weight.axis for weight in weights} | set(at.axis.tolist())
    cranks = [(complex(x, y), ratio) for x, y, ratio in engine._core.cranks[0]]
    for axis, ratio in cranks:
        if axis in carrying or not axis:
            middle = _free(at, axis, [other for other, _ in cranks])
            arc = axis + 1.7 * largest * direction(middle + np.linspace(-30.0, 30.0, 25))
            ax.plot(arc.real, arc.imag, color=ink.faint, linewidth=1.0, linestyle="-", zorder=2)
            tip = middle + (30.0 if ratio > 0 else -30.0)
            arrow_round(ax, 1.7 * largest, tip, ink, axis, ratio)


def _free(at: Geometry, axis: complex, axes: list[complex]) -> float:
    """Return the direction, degrees, in which there is room beside a crank.

    Away from its bores, on the side that has no other crank.
    """
    bores = complex(at.along[at.axis == axis].sum())
    away = -90.0 if abs(bores) < 1e-6 else float(np.degrees(np.angle(-bores)))
    side = -1.0 if axis.real < np.mean(axes).real else 1.0
    return max(away + 45.0, away - 45.0, key=lambda angle: side * np.cos(np.deg2rad(angle)))


def _crossheads(
    engine: Engine, ax: Axes, at: Geometry, rods: PistonRods, bores: NDArray[np.float64], ink: Inks
) -> None:
    """Draw piston rods and crossheads; those of side rods are beams, outside the bore."""
    outlines = []
    diameters = engine.rod_diameter
    for k in np.argsort(engine.z, kind="stable"):
        bore, length = bores[k], rods.lengths[k]
        if not length:
            continue
        head = at.wrist_pin[k], at.along[k]
        if rods.side_rods[k]:
            back = rods.beams[k]
            upper, width = back + 2.0 * SLIPPER * bore, 2.0 * (SIDE_RODS + 0.08) * bore
            outlines += [
                box(
                    head[0] + side * 1j * SIDE_RODS * bore * head[1], head[1], 0.1 * bore, 0.0, back
                )
                for side in (-1.0, 1.0)
            ]
            outlines += [
                box(*head, 0.2 * bore, length, back),
                box(*head, width, back, upper),
                box(*head, width, -0.5 * SLIPPER * bore, 0.5 * SLIPPER * bore),
            ]
        else:
            width = diameters[k] or 0.16 * bore
            outlines += [
                box(*head, width, 0.0, length),
                box(*head, 0.5 * bore, -SLIPPER * bore, SLIPPER * bore),
            ]
    look = {"facecolor": ink.metal, "edgecolor": ink.line, "linewidth": 0.8, "gid": CROSSHEADS}
    add(ax, outlines, zorder=3.9, **look)


def _moving_parts(
    engine: Engine,
    ax: Axes,
    at: Geometry,
    rods: PistonRods,
    bores: NDArray[np.float64],
    ink: Inks,
    style: dict[str, Any],
) -> None:
    """Draw pistons and rods, the ones close to the flywheel over those behind them."""
    outlines, faces = [], []
    for k in np.argsort(engine.z, kind="stable"):
        eye = 0.16 * bores[k]
        pin, wrist = at.crankpin[k], at.wrist_pin[k]
        width = 2.0 * JOURNAL * abs(pin - at.axis[k])
        # The crown of a piston with side rods is towards the crank.
        ends = (CROWN, SKIRT) if rods.side_rods[k] else (SKIRT, CROWN)
        low, high = rods.lengths[k] + np.array([-ends[0], ends[1]]) * bores[k]
        outlines += [
            box(wrist, at.along[k], 0.97 * bores[k], low, high),
            bar(at.rod_foot[k], wrist, 1.3 * width, 1.5 * eye),
            disc(wrist, 0.5 * eye),
            disc(pin, 0.5 * width),
        ]
        faces += [ink.metal, ink.metal, ink.paper, ink.journal]
    looks = {
        "facecolor": faces,
        "edgecolor": ink.line,
        "linewidth": 0.8,
        "zorder": 4,
        "gid": MOVING,
    }
    add(ax, outlines, **(looks | style))


def _shafts(engine: Engine, ax: Axes, theta_deg: float, ink: Inks) -> None:
    """Draw balance shafts at their places, with their unbalances and ratios."""
    weights = weights_on_shafts(engine, theta_deg)
    amounts = [weight.amount for shaft in weights for weight in shaft]
    radii = iter(radius_of_amounts(engine, amounts))
    names: dict[complex, list[str]] = {}
    sectors, discs = [], []
    for shaft, carried in zip(engine.shafts, weights, strict=True):
        place = complex(shaft.x, shaft.y)
        sectors += [wedge(place, 0.7 * next(radii), weight.angle_deg) for weight in carried]
        discs.append(disc(place, 0.5 * JOURNAL * crank_radius(engine)))
        names.setdefault(place, []).append(shaft_text(shaft.name, shaft.ratio))
    add(ax, sectors, facecolor=ink.shaft, edgecolor=ink.line, linewidth=0.6, zorder=5)
    add(ax, discs, facecolor=ink.paper, edgecolor=ink.line, linewidth=0.8, zorder=5.1)
    for place, texts in names.items():
        below = place - 0.9j * crank_radius(engine)
        look: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": "x-small"}
        ax.text(below.real, below.imag, plain_text("\n".join(texts)), **look)
        reach = disc(place, 1.1 * crank_radius(engine))
        ax.update_datalim(points(reach))


def shaft_text(name: str, ratio: float) -> str:
    """Return the words at a balance shaft: its name and its speed over the crank's."""
    return f"{name} {ratio:+g}×".strip().replace("-", "−")


def _scale_bar(engine: Engine, ax: Axes, ink: Inks) -> None:
    """Draw a round length, about as long as the stroke, below the drawing on the left."""
    converted = units.convert("m")
    stroke = 2.0 * crank_radius(engine) * converted.factor
    decade = 10.0 ** np.floor(np.log10(stroke))
    length = max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= stroke)
    left, (low, high) = ax.get_xlim()[0], ax.get_ylim()
    low -= 0.16 * (high - low)  # below the numbers of hanging cylinders
    ax.set_ylim(low, high)
    right = left + length / converted.factor
    ax.plot([left, right], [low, low], color=ink.line, linewidth=1.5, linestyle="-")
    middle = complex(0.5 * (left + right), low)
    write(ax, f"{number(length)} {converted.unit}", middle, -3.0j, va="top", fontsize="x-small")
