"""Order 1 over ω² (kg·m, kg·m²) of an engine and of its bays."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from crankpin.analysis.balance import over_square
from crankpin.analysis.balancing.planes import turning
from crankpin.model.crankpins import bays
from crankpin.model.engine import Engine
from crankpin.model.shafts import Unbalance, degrees

if TYPE_CHECKING:
    from crankpin.analysis.by_order import Ellipse, OrderBalance
    from crankpin.model.crankpins import Bay


class ForwardPart(NamedTuple):
    """Forward part of order 1 over ω²: what weights on the crankshaft can change."""

    force: complex
    """Shaking force, x + iy at θ = 0, kg·m."""
    moment: complex
    """Rocking moment, x + iy at θ = 0, kg·m²."""


class Ellipses(NamedTuple):
    """Ellipses that force and moment of order 1 trace, over ω²."""

    force: Ellipse
    """Shaking force, half axes in kg·m."""
    moment: Ellipse
    """Rocking moment, half axes in kg·m²."""


class BayLoad(NamedTuple):
    """What a throw brings upon its two main bearings: its forward part of order 1 over ω²."""

    cylinders: tuple[int, ...]
    """Numbers of the cylinders."""
    z: float
    """Place of the crankpins, about which the moment is taken, m."""
    force: complex
    """Force, x + iy at θ = 0, kg·m."""
    moment: complex
    """Moment, x + iy at θ = 0, kg·m²."""


def first_order(engine: Engine, reference_z: float | None = None) -> OrderBalance:
    """Return order 1 over ω²: force in kg·m and moment in kg·m²."""
    return over_square(engine, [1], reference_z)[1]


def ellipses_of(engine: Engine, plane: float) -> Ellipses:
    """Return the ellipses that force and moment trace."""
    order_1 = first_order(engine, plane)
    return Ellipses(order_1.force.ellipse, order_1.moment.ellipse)


def bay_loads_of(engine: Engine) -> tuple[BayLoad, ...]:
    """Return what each throw brings upon its main bearings."""
    return tuple(
        BayLoad(bay.cylinders, bay.z, *turning(bay_alone(engine, bay), 1, bay.z))
        for bay in bays(engine)
    )


def bay_alone(engine: Engine, bay: Bay) -> Engine:
    """Return the cylinders of a bay with what rotates there: an engine of one throw."""
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
    )


def _in_bay(engine: Engine, weight: Unbalance) -> Unbalance:
    """Return a weight at its own angle: its pin has another number in a bay, or none."""
    start = 0.0 if weight.pin is None else float(engine.pin_deg[weight.pin - 1])
    return Unbalance(weight.amount, weight.z, start + degrees(weight.angle_deg))
