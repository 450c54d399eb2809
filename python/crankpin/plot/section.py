"""Cross-section of an engine, seen from the flywheel."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

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


def section(engine: Engine, ax: Axes, theta_deg: float, **style: object) -> None:
    """Draw bores, pistons, rods, crank, counterweights and balance shafts."""
    at = geometry(engine, theta_deg)
    bores = assumed_bores(engine)
    ink = inks_of(ax)
    _walls(engine, ax, at, bores, ink)
    _crank(engine, ax, at, ink)
    _moving_parts(engine, ax, at, bores, ink, style)
    _shafts(engine, ax, at.theta_deg, ink)
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.set_axis_off()
    _scale_bar(engine, ax, ink)


def _walls(engine: Engine, ax: Axes, at: Geometry, bores: NDArray[np.float64], ink: Inks) -> None:
    """Draw each bore once, with its head and the numbers of its cylinders.

    A bore in which pistons face each other is open at both ends; the numbers stand beside it.
    Numbers of bores behind each other stand together above the highest.
    """
    seen: dict[tuple[float, ...], list[int]] = {}
    above: dict[tuple[float, ...], list[int]] = {}
    lowest, heads = at.lowest - SKIRT * bores, at.highest + (CROWN + 0.04) * bores
    middles = heads.copy()  # between the pistons, where they face each other
    for pair, distance in _opposed(engine, at):
        middles[pair] = lowest[pair] + 0.5 * (distance - lowest[pair].sum())
    for k, (along, foot) in enumerate(zip(at.along, at.foot, strict=True)):
        place = np.round([along.real, along.imag, foot.real, foot.imag, bores[k], heads[k]], 9)
        seen.setdefault(tuple(place.tolist()), []).append(k)
        if middles[k] == heads[k]:
            above.setdefault(tuple(place[:4].tolist()), []).append(k)
    reached = [disc(axis, 1.8 * crank_radius(engine)) for axis in (0j, *at.axis.tolist())]
    for cylinders in seen.values():
        k = cylinders[0]
        is_open = middles[k] != heads[k]
        corners = box(at.foot[k], at.along[k], bores[k], lowest[k], middles[k])
        walls = corners.reshape(2, 2).T if is_open else corners
        ax.plot(walls.real, walls.imag, color=ink.line, linewidth=1.2, linestyle="-", zorder=2)
        axis = at.foot[k] + np.array([0.0, middles[k]]) * at.along[k]
        ax.plot(axis.real, axis.imag, color=ink.faint, linewidth=0.6, linestyle="-.", zorder=1)
        if is_open:
            side = corners[:2] if corners[0].real < corners[3].real else corners[2:]
            numbers = listed([place + 1 for place in cylinders])
            outside(ax, complex(side.mean()), numbers, complex(axis.mean()))
        reached.append(corners)
    for cylinders in above.values():
        k = max(cylinders, key=lambda place: float(heads[place]))
        numbers = listed([place + 1 for place in cylinders])
        outside(ax, complex(at.foot[k] + heads[k] * at.along[k]), numbers, complex(at.axis[k]))
    # Numbers need room beyond the heads.
    ax.update_datalim(points(1.06 * np.concatenate(reached)))


def _opposed(engine: Engine, at: Geometry) -> Iterator[tuple[list[int], float]]:
    """Yield pairs of cylinders whose pistons face each other in a bore, and between their feet."""
    for k, m in itertools.combinations(range(len(engine)), 2):
        between = (at.foot[m] - at.foot[k]) * at.along[k].conjugate()
        apart = [engine.z[k] - engine.z[m], between.imag, abs(at.along[k] + at.along[m])]
        if between.real > 0.0 and np.allclose(apart, 0.0, atol=1e-9):
            yield [k, m], float(between.real)


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


def _moving_parts(
    engine: Engine,
    ax: Axes,
    at: Geometry,
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
        low, high = -SKIRT * bores[k], CROWN * bores[k]
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
