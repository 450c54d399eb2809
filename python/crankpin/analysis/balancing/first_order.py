"""Order 1 over ω² (kg·m, kg·m²): engines with bob weights, and the bays of engines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.record import read_only
from crankpin.analysis.balancing.planes import turning
from crankpin.model.crankpins import bays
from crankpin.model.engine import Engine
from crankpin.model.shafts import Unbalance, degrees

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.crankpins import Bay

LARGEST_FACTOR = 10.0
SMALLEST = 1e-30
"""Smallest unbalance that engines take, kg·m."""


def check_factor(name: str, factor: ArrayLike) -> None:
    """Raise an InputError unless factors are shares of the reciprocating mass."""
    listed = np.asarray(factor)
    if not ((listed >= 0.0) & (listed <= LARGEST_FACTOR)).all():
        hint = f"give a share of the reciprocating mass, 0 to {LARGEST_FACTOR:g}, such as 0.5"
        raise InputError(f"{name} = {inputs.shorten(factor)}: {hint}")


def with_bob_weights(engine: Engine, factor: float) -> Engine:
    """Return the engine with counterweights that balance a bob weight at each crankpin.

    They are opposite the crankpins, in place of the counterweights that it has: all of the rotating
    and ``factor`` of the reciprocating mass.
    """
    masses = zip(engine.cylinders, engine.rotating_mass.tolist(), engine.z.tolist(), strict=True)
    weights = []
    for number, (parts, rotating, z) in enumerate(masses, start=1):
        amount = (rotating + factor * parts.reciprocating_mass) * parts.crank_radius
        if amount >= SMALLEST:
            weights.append(Unbalance(amount, z, 180, pin=number))
    return engine.with_counterweights(weights)


def bay_loads(engine: Engine) -> NDArray[np.complex128]:
    """Return what each throw exerts on its main bearings: forward force and moment, (n_bays, 2)."""
    found = [turning(bay_alone(engine, bay), 1) for bay in bays(engine)]
    return read_only(np.array(found, dtype=np.complex128))


def bay_alone(engine: Engine, bay: Bay) -> Engine:
    """Return the cylinders of a bay with what rotates there: an engine of one throw, about it."""
    places = [number - 1 for number in bay.cylinders]
    tdc_deg, bank_deg = ([angles[k] for k in places] for angles in engine.core.exact_angles)
    return Engine.from_lists(
        [engine.cylinders[k] for k in places],
        tdc_deg=tdc_deg,
        bank_deg=bank_deg,
        z=engine.z[places],
        rotating_mass=engine.rotating_mass[places],
        counterweights=[
            _in_bay(engine, weight) for weight in engine.counterweights if bay.holds(weight.z)
        ],
        reference_z=bay.z,
    )


def _in_bay(engine: Engine, weight: Unbalance) -> Unbalance:
    """Return a weight at its own angle: its pin has another number in a bay, or none."""
    start = 0.0 if weight.pin is None else float(engine.pin_deg[weight.pin - 1])
    return Unbalance(weight.amount, weight.z, start + degrees(weight.angle_deg))
