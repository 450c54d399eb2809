"""What must balance shafts carry, and where must they stand?

From waveforms over a turn of the crank, such as :mod:`rederivation.time_domain` samples: what turns
with a shaft is an average over the turn seen by somebody who turns with it, two planes share it by
the lever rule, and the loads on two bearings follow from equilibrium at each crank angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rederivation.rotors import Rotor, wrench
from rederivation.time_domain import crank_angles

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = NDArray[np.float64]


def turning(samples: Array, ratio: float) -> complex:
    """The part of a plane vector (n, 2) that turns at ``ratio`` times crank speed, at theta = 0."""
    theta = crank_angles(len(samples))
    return complex(np.mean((samples[:, 0] + 1j * samples[:, 1]) * np.exp(-1j * ratio * theta)))


def in_two_planes(
    force: complex, moment: complex, speed: float, planes: tuple[float, float], reference_z: float
) -> list[complex]:
    """Unbalances that cancel a force and a moment turning at ``speed`` rad/s, kg·m.

    A force F at z has the moment i(z − z₀)F; the rear plane takes the moment about the front one.
    """
    front, rear = planes
    about_front = moment - 1j * (front - reference_z) * force
    on_rear = about_front / (1j * (rear - front))
    return [-(force - on_rear) / speed**2, -on_rear / speed**2]


def sine_and_cosine(samples: Array, order: int) -> tuple[float, float]:
    """M_s and M_c of M_s sin(nθ) + M_c cos(nθ), by projection."""
    theta = crank_angles(len(samples))
    return (
        float(2.0 * np.mean(samples * np.sin(order * theta))),
        float(2.0 * np.mean(samples * np.cos(order * theta))),
    )


def bearing_loads(
    rotors: Sequence[Rotor], rpm: float, bearings: tuple[float, float]
) -> NDArray[np.complex128]:
    """Loads x + iy on two bearings at each crank angle: (n, 2), from equilibrium of the shaft.

    Forces of the rotors on the engine, and their moments about the origin, are those of the loads.
    """
    force, moment, _ = wrench(rotors, rpm, 0.0)
    pull = force[:, 0] + 1j * force[:, 1]
    # M_x = −z F_y and M_y = z F_x, so that z·F = M_y − i M_x.
    lever_pull = moment[:, 1] - 1j * moment[:, 0]
    equations = np.array([[1.0, 1.0], list(bearings)])
    return np.asarray(np.linalg.solve(equations, np.stack([pull, lever_pull])).T)
