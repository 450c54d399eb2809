"""Places of an engine's moving parts at a crank angle."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support import inputs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance

WIDEST_BORE = 0.9
"""Assumed bore over the distance to the next cylinder of the bank, at most: walls need the rest."""
NARROWEST_BORE = 0.6
"""Assumed bore over stroke, at least: engines whose spacing is not to scale stay readable."""


@dataclasses.dataclass(frozen=True)
class Geometry:
    """Places of an engine's moving parts at one crank angle, cylinder by cylinder.

    Points and directions of the cross-section plane are complex, x + iy as seen from the flywheel;
    all arrays are (n_cylinders,).
    """

    theta_deg: float
    """Crank angle, degrees."""
    axis: NDArray[np.complex128]
    """Axes of the cranks, m; 0 of the main one."""
    along: NDArray[np.complex128]
    """Directions of the bores, unit length."""
    foot: NDArray[np.complex128]
    """Points of the bores' axes nearest to the crank's axis, m; on it without pin offset."""
    crankpin: NDArray[np.complex128]
    """Crankpins, m."""
    rod_foot: NDArray[np.complex128]
    """Lower ends of the rods, m: crankpins, knuckles of link rods, bars of Scotch yokes."""
    wrist_pin: NDArray[np.complex128]
    """Piston pins, m."""
    lowest: NDArray[np.float64]
    """Least distance of the piston pin from the foot over a turn, m."""
    highest: NDArray[np.float64]
    """Largest distance of the piston pin from the foot over a turn, m."""


def drawn_rod(cylinder: Cylinder) -> float:
    """Return the length of a rod in pictures, m: an infinite one is the bar of a Scotch yoke."""
    return _core.drawn_rod(cylinder._parts)


def geometry(engine: Engine, theta_deg: float = 0.0) -> Geometry:
    """Return the places of an engine's parts at a crank angle, by exact kinematics."""
    theta = crank_angle(theta_deg)
    cylinders = engine.cylinders
    radius, offset = np.array(
        [(cylinder.crank_radius, cylinder.pin_offset) for cylinder in cylinders]
    ).T
    ends = np.array([end[2:4] for end in engine._core.dead_centres(None)])
    highest, lowest = ends[:, 0], ends[:, 0] - ends[:, 1]
    # The bar of a yoke stands between the piston and the middle of its stroke.
    yokes = np.isinf([cylinder.rod_length for cylinder in cylinders])
    bar = np.where(yokes, [drawn_rod(cylinder) for cylinder in cylinders], 0.0)
    along = direction(engine.bank_deg)
    axis, ratio = _cranks(engine)
    # The offset is on the side to which the crankpin swings after top dead centre.
    foot = axis + 1j * np.sign(ratio) * offset * along
    lower, wrist_pin = np.array(engine._core.rod_ends(theta)).T
    wrist_pin = wrist_pin + bar * along
    crankpin = axis + radius * direction(engine.pin_deg + ratio * theta)
    return Geometry(
        theta_deg=theta,
        axis=axis,
        along=along,
        foot=foot,
        crankpin=crankpin,
        rod_foot=np.where(yokes, wrist_pin - bar * along, lower),
        wrist_pin=wrist_pin,
        lowest=lowest + bar,
        highest=highest + bar,
    )


def _cranks(engine: Engine) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Return the axis and the speed of each cylinder's crank."""
    cranks, crank_of = engine._core.cranks
    x, y, ratio = np.array([cranks[k] for k in crank_of]).T
    return x + 1j * y, ratio


class Weight(NamedTuple):
    """An unbalance at a crank angle."""

    z: float
    """Place along the crank, m."""
    amount: float
    """Mass × eccentricity, kg·m."""
    angle_deg: float
    """Direction from +x, degrees."""
    axis: complex = 0j
    """Axis that it turns about, m; 0 of the main crank."""
    crank: int = 0
    """Index of the crank that carries it; 0 of balance shafts too."""


def weights_on_crank(engine: Engine, theta_deg: float = 0.0) -> list[Weight]:
    """Return the counterweights, turned to a crank angle."""
    pins, (cranks, crank_of) = engine.pin_deg, engine._core.cranks
    weights = []
    for weight in engine.counterweights:
        crank = weight.crank if weight.pin is None else crank_of[weight.pin - 1]
        x, y, ratio = cranks[crank]
        angle = inputs.degrees(weight.angle_deg)
        if weight.pin is not None:
            # Ahead of the pin in the sense in which its crank turns.
            angle = float(pins[weight.pin - 1] + np.sign(ratio) * angle)
        turned = (angle + ratio * theta_deg) % 360.0
        weights.append(Weight(weight.z, weight.amount, turned, complex(x, y), crank))
    return weights


def rotating_masses(engine: Engine, theta_deg: float = 0.0) -> list[Weight]:
    """Return the unbalances of the cylinders' rotating masses at a crank angle."""
    amounts = engine.rotating_mass * [cylinder.crank_radius for cylinder in engine.cylinders]
    axes, ratios = _cranks(engine)
    angles = engine.pin_deg + ratios * theta_deg
    crank_of = engine._core.cranks[1]
    lists = (engine.z.tolist(), amounts.tolist(), angles.tolist(), axes.tolist(), crank_of)
    return [Weight(*row) for row in zip(*lists, strict=True) if row[1]]


def weights_on_shafts(engine: Engine, theta_deg: float = 0.0) -> list[list[Weight]]:
    """Return the unbalances of each balance shaft, turned to a crank angle."""
    return [
        [_turned(unbalance, shaft.ratio * theta_deg) for unbalance in shaft.unbalances]
        for shaft in engine.shafts
    ]


def _turned(unbalance: Unbalance, by_deg: float) -> Weight:
    angle = inputs.degrees(unbalance.angle_deg) + by_deg
    return Weight(unbalance.z, unbalance.amount, angle % 360.0)


def crank_angle(theta_deg: object) -> float:
    """Return a crank angle that was given, degrees."""
    theta = inputs.number("theta_deg", theta_deg)
    if not np.isfinite(theta):
        raise inputs.rejected("theta_deg", theta, "give a crank angle in degrees, such as 90")
    return theta


def direction(degrees: NDArray[np.float64] | float) -> NDArray[np.complex128]:
    """Return unit vectors at these angles from +x, x + iy; along the axes exactly."""
    quarters, rest = np.divmod(degrees, 90.0)
    of_quarters = np.array([1.0, 1.0j, -1.0, -1.0j])[np.mod(quarters, 4.0).astype(int)]
    return np.asarray(of_quarters * np.exp(1j * np.radians(rest)))


def assumed_bores(engine: Engine) -> NDArray[np.float64]:
    """Return diameters of the bores to draw, m: (n_cylinders,).

    Those given; a bore that is not known is as wide as the stroke is long, but at most 0.9 of the
    distance to the next cylinder of the bank, and at least 0.6 of the stroke.
    """
    banks = np.array(engine._core.bank)
    cylinders = engine.cylinders
    bores = np.array([cylinder.bore or cylinder.stroke for cylinder in cylinders])
    for k, z in enumerate(engine.z):
        if cylinders[k].bore is not None:
            continue
        distances = abs(engine.z[banks == banks[k]] - z)
        nearest = distances[distances > 0.0].min(initial=np.inf)
        bores[k] *= np.clip(WIDEST_BORE * nearest / bores[k], NARROWEST_BORE, 1.0)
    return bores
