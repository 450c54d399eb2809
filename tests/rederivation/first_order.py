"""What do an engine and masses on its crankshaft exert at order 1, with the crank and against it?

Positions of pistons and of masses on circles are sampled over a turn, differentiated by their
Fourier series and added up; the two parts are bins of one transform of the sum. Divided by the
square of the speed they are kg·m and kg·m². No formula for a rotating force, for a balance factor
or for the forward part of a piston is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rederivation import rotors, time_domain

if TYPE_CHECKING:
    from collections.abc import Sequence

RPM = 300.0


class Parts(NamedTuple):
    """Parts that turn with and against the crank, over omega squared."""

    force_forward: complex
    force_backward: complex
    moment_forward: complex
    moment_backward: complex


def parts(
    engine: time_domain.EngineLists,
    weights: Sequence[tuple[float, float, float]],
    reference_z: float,
    n_samples: int = 256,
) -> Parts:
    """Parts of order 1 of an engine with weights (kg·m, degrees at theta = 0, z)."""
    theta = time_domain.crank_angles(n_samples)
    # Each weight is a mass at a tenth of a metre.
    masses = [rotors.Rotor(amount / 0.1, 0.1, angle, z) for amount, angle, z in weights]
    force, moment, _ = rotors.wrench(masses, RPM, reference_z, n_samples)
    force = force + time_domain.force(engine, RPM, theta)
    moment = moment + time_domain.moment(engine, RPM, theta, reference_z)
    square = time_domain.angular_speed(RPM) ** 2
    found = []
    for samples in (force, moment):
        forward, backward = time_domain.forward_backward(samples, [1])
        found += [complex(forward[0]) / square, complex(backward[0]) / square]
    return Parts(*found)
