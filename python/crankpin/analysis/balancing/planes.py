"""Unbalances in given planes of a shaft: those that make a given force and moment."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin.analysis.balance import over_square
from crankpin.analysis.geometry import direction
from crankpin.model.shafts import Unbalance, degrees

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.engine import Engine

NOTHING = 1e-14
"""Part of the largest of several values below which another is a rounding error."""

DECIMALS = 13
"""Decimals of the angle of an unbalance, degrees: 1e-15 rad, less than its rounding error."""


class Turning(NamedTuple):
    """Force and moment that turn with a shaft, as vectors x + iy at θ = 0, over ω²."""

    force: complex
    """Force, kg·m."""
    moment: complex
    """Moment about the reference plane, kg·m²."""


def turning(engine: Engine, ratio: int, reference_z: float | None = None) -> Turning:
    """Return the part of an engine's force and moment that turns with a shaft of this ratio."""
    order = abs(ratio)
    found = over_square(engine, [order], reference_z)[order]
    part = "forward" if ratio > 0 else "backward"
    return Turning(*(complex(getattr(each, part)) for each in (found.force, found.moment)))


def roll_torque(engine: Engine, order: int) -> complex:
    """Return the phasor of an order of an engine's roll torque over ω², kg·m²."""
    return complex(over_square(engine, [order], torque=True)[order].torque.phasor)


def influence(z: ArrayLike, reference_z: float) -> NDArray[np.complex128]:
    """Return force and moment of a unit unbalance in each plane: 1 and i(z − z₀), (2, n_planes)."""
    lever = np.asarray(z, dtype=np.float64) - reference_z
    return np.stack([np.ones(lever.shape, dtype=complex), 1j * lever])


def fitted(
    wanted: Turning, z: Sequence[float], reference_z: float, length: float
) -> NDArray[np.complex128]:
    """Return the unbalances in these planes whose force and moment come closest to those wanted.

    From two different planes on both are met; of more planes the unbalances are those with the
    smallest sum of squares. In a single plane the sum of the squares of what is missed is least,
    moments counted over a length.

    Parameters
    ----------
    wanted
        Force, kg·m, and moment about the reference plane, kg·m².
    z
        Places of the planes, m: (n_planes,).
    reference_z
        Reference plane, m.
    length
        Length over which a moment weighs as much as a force, m.

    Returns
    -------
    numpy.ndarray
        Unbalances as vectors x + iy at θ = 0, kg·m: (n_planes,).
    """
    weights = np.array([1.0, 1.0 / length])
    rows = weights[:, np.newaxis] * influence(z, reference_z)
    return without_rounding(np.linalg.lstsq(rows, weights * np.array(wanted), rcond=None)[0])


def without_rounding(values: NDArray[Any], largest: float | None = None) -> NDArray[Any]:
    """Return values with zero for what is rounding beside the largest of them."""
    sizes = np.abs(values)
    scale = sizes.max(initial=0.0) if largest is None else largest
    return np.where(sizes <= NOTHING * scale, 0.0, values)


def unbalance(vector: complex, z: float) -> Unbalance:
    """Return a vector x + iy at θ = 0, kg·m, as an unbalance."""
    return Unbalance(abs(vector), z, round(math.degrees(cmath.phase(vector)), DECIMALS) % 360.0)


def unbalances(vectors: NDArray[np.complex128], z: Sequence[float]) -> tuple[Unbalance, ...]:
    """Return vectors in planes as unbalances; those that are zero are left out."""
    listed = zip(vectors.tolist(), z, strict=True)
    return tuple(unbalance(vector, place) for vector, place in listed if vector)


def vectors(unbalances: Iterable[Unbalance]) -> NDArray[np.complex128]:
    """Return unbalances, none at a pin, as vectors x + iy at θ = 0, kg·m: (n_unbalances,)."""
    listed = [(each.amount, degrees(each.angle_deg)) for each in unbalances]
    amounts, angles = np.array(listed, dtype=np.float64).reshape(-1, 2).T
    return amounts * direction(angles)


def shares(z: ArrayLike, front: float, rear: float) -> NDArray[np.float64]:
    """Return the parts of forces at places z that two planes take, by the lever rule: (2, n)."""
    on_rear = (np.asarray(z) - front) / (rear - front)
    return np.stack([1.0 - on_rear, on_rear])


def ends(engine: Engine) -> tuple[float, ...]:
    """Return the first and the last place of a cylinder or counterweight, m; one if they agree."""
    places = [*engine.z.tolist(), *(weight.z for weight in engine.counterweights)]
    return (min(places), max(places)) if max(places) > min(places) else (min(places),)


def length_of(engine: Engine) -> float:
    """Return half the distance between the ends, m; the crank radius where they agree."""
    first, last = ends(engine)[0], ends(engine)[-1]
    return (last - first) / 2.0 or max(each.crank_radius for each in engine.cylinders)
