"""Unlike cylinders in line: which of their masses, places and throws are to be chosen."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin.analysis.arrangements.cranks import Exact, exact

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin.analysis.ranking.objectives import Objective


@dataclasses.dataclass(frozen=True)
class Unlike:
    """Masses, places and throws of cylinders; None for those that are to be chosen."""

    masses: tuple[float | None, ...]
    """Reciprocating masses, kg."""
    positions: tuple[float | None, ...]
    """Places along the crank, m."""
    throws: tuple[Exact | None, ...]
    """Crankpins, degrees."""


def unknowns(
    count: int,
    masses: object,
    positions: object,
    spacing: float | None,
    mass: float,
    throws: object,
) -> Unlike:
    """Return the unknowns that these arguments leave open, or raise an InputError."""
    kilograms = _values("masses", masses, count) if masses is not None else [mass] * count
    if any(each is not None and not each > 0.0 for each in kilograms):
        raise inputs.rejected("masses", masses, "give masses above zero, kg, None for unknown ones")
    if positions is not None:
        places = _values("positions", positions, count)
    elif spacing is None:
        raise inputs.rejected("spacing", None, Hint.of("give it, or `positions`"))
    else:
        places = [spacing * k for k in range(count)]
    known = [each for each in places if each is not None]
    if len(known) < 2 or (np.diff(known) <= 0.0).any():
        hint = "give places that ascend from the front, m, two at least, None for unknown ones"
        raise inputs.rejected("positions", positions, hint)
    if all(each is None for each in kilograms):
        raise inputs.rejected("masses", masses, "give one mass at least, which the others follow")
    angles: list[Exact | None] = [None] * count
    if throws is not None and not isinstance(throws, str):
        listed = inputs.items("throws_deg", throws, _hint("throws_deg", count))
        if len(listed) != count:
            raise inputs.rejected("throws_deg", throws, _hint("throws_deg", count))
        angles = [
            None if each is None else exact(inputs.angle(f"throws_deg[{k}]", each))
            for k, each in enumerate(listed)
        ]
    elif isinstance(throws, str) and throws != "free":
        raise inputs.rejected("throws_deg", throws, _hint("throws_deg", count))
    if all(each is None for each in angles):
        angles[0] = 0  # the crank may turn
    if not any(each is None for each in (*kilograms, *places, *angles)):
        hint = Hint.of("give None in `masses`, `positions` or `throws_deg` for what is unknown")
        raise inputs.rejected("masses", masses, hint)
    return Unlike(tuple(kilograms), tuple(places), tuple(angles))


def _hint(name: str, count: int) -> str:
    what = {"throws_deg": "angle", "masses": "mass, kg,", "positions": "place, m,"}[name]
    return f"give one {what} for each of the {count} cylinders, None for unknown ones"


def _values(name: str, values: object, count: int) -> list[float | None]:
    listed = inputs.items(name, values, _hint(name, count))
    if len(listed) != count:
        raise inputs.rejected(name, values, _hint(name, count))
    return [
        None if each is None else inputs.finite(f"{name}[{k}]", each)
        for k, each in enumerate(listed)
    ]


def fewest_cylinders(objectives: Sequence[Objective]) -> int:
    """Return a number of cylinders below which these cannot all vanish.

    With positive masses at different places and one kind of rod. The sums of order n are those of
    Σ p·v(φ) and Σ p·z·v(φ), v = (cos nφ, sin nφ): where force and moment of an order vanish, two
    vectors, p and p·z, are in the kernel of the matrix of the v.

    * One order, force: two. Force and moment: with two cylinders the kernel would be all of the
      plane; with three the v are on one line: three.
    * Forces of orders 1 and 2: two would be opposite at order 1, in phase at order 2: three.
    * And the moment of order 1: three would be on one line at order 1, all in phase at order 2; of
      order 2: three would lie on two lines at right angles, of which one has a single force: four.
    * All four: v = (cos φ, sin φ, cos 2φ, sin 2φ) of four different directions has rank three at
      least, since a sum of these waves has four zeros at most, which determine it; a kernel of
      two needs rank two. Of three directions the kernel is p alone, so that the cylinders of each
      direction have one centre, and the two that are alone in theirs one place. Of fewer, forces
      of order 2 are in phase. So five: 120° apart, two of them halved about the third.
    """
    forces = {each.order for each in objectives if each.quantity == "force"}
    moments = {each.order for each in objectives if each.quantity == "moment"} & forces
    fewest = (3 if moments else 2) if forces else 1
    if forces >= {1, 2}:
        fewest = 3 + len(moments & {1, 2})
    return fewest
