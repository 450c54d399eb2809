"""Unbalances in given planes of a shaft: those that make a given force and moment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin.analysis.balance import over_square
from crankpin.model.shafts import Unbalance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

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


def influence(z: Sequence[float], reference_z: float) -> NDArray[np.complex128]:
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


def unbalances(vectors: NDArray[np.complex128], z: Sequence[float]) -> tuple[Unbalance, ...]:
    """Return vectors x + iy, kg·m, in planes as unbalances; those that are zero are left out."""
    angles = np.round(np.degrees(np.angle(vectors)), DECIMALS) % 360.0
    listed = zip(np.abs(vectors).tolist(), z, angles.tolist(), strict=True)
    return tuple(Unbalance(amount, place, angle) for amount, place, angle in listed if amount)


def ends(engine: Engine) -> tuple[float, ...]:
    """Return the first and the last place of a cylinder or counterweight, m; one if they agree."""
    places = [*engine.z.tolist(), *(weight.z for weight in engine.counterweights)]
    return (min(places), max(places)) if max(places) > min(places) else (min(places),)


def length_of(engine: Engine) -> float:
    """Return half the distance between the ends, m; the crank radius where they agree."""
    first, last = ends(engine)[0], ends(engine)[-1]
    return (last - first) / 2.0 or max(each.crank_radius for each in engine.cylinders)
