"""What are the harmonics of a swinging rod's torques, to fifty digits?

The rod stands at -phi from the bore, sin phi = (r sin theta - e)/l. Its inertia J makes the torque
-J omega^2 phi'' phi' on the crank and J omega^2 phi''(1 + phi') on the block. Figures are doubles
taken at their exact binary values; offsets are over r.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mpmath as mp

if TYPE_CHECKING:
    from collections.abc import Sequence

DIGITS = 50

Real = Any  # mpmath carries no types
Torques = list[tuple[complex, complex]]


def by_samples(rod_length: float, radius: float, offset: float, orders: Sequence[int]) -> Torques:
    """Roll and crank of each order by the trapezoid rule: N samples miss order n by order N - n."""
    with mp.workdps(DIGITS + 20):
        r = mp.mpf(radius)
        rod, shift = mp.mpf(rod_length) / r, mp.mpf(offset) / r
        decay = float(mp.acosh(rod - abs(shift)))
        count = 2 * max(orders) + int((DIGITS + 5) * math.log(10.0) / decay) + 8
        roll, crank = [], []
        for k in range(count):
            sine, cosine = mp.sinpi(mp.mpf(2 * k) / count), mp.cospi(mp.mpf(2 * k) / count)
            u = sine - shift
            height = mp.sqrt(rod**2 - u**2)
            velocity = cosine / height
            acceleration = -sine / height + cosine**2 * u / height**3
            roll.append(acceleration * (1 + velocity))
            crank.append(-acceleration * velocity)
        roots = [mp.expjpi(-mp.mpf(2 * k) / count) for k in range(count)]
        found = []
        for n in orders:
            turns = [roots[n * k % count] for k in range(count)]
            pair = [2 * mp.fdot(values, turns) / count for values in (roll, crank)]
            found.append((complex(pair[0]), complex(pair[1])))
        return found


def by_panels(rod_length: float, radius: float, offset: float, orders: Sequence[int]) -> Torques:
    """The same next to the crank that cannot turn, from phi' and its square by quadrature.

    Both change within sqrt(2 (l - |e| - r)/r) of sin theta = 1 and -1; panels halve towards them.
    """
    with mp.workdps(DIGITS):
        r = mp.mpf(radius)
        above = (mp.mpf(rod_length) + mp.mpf(offset)) / r - 1
        below = (mp.mpf(rod_length) - mp.mpf(offset)) / r - 1
        edges = [mp.pi / 2]
        while edges[-1] > mp.sqrt(2 * min(above, below)) / 2:
            edges.append(edges[-1] / 2)
        panels = [mp.mpf(0), *reversed(edges)]

        def quarter(near: Real, far: Real, square: bool, n: int) -> Real:
            def integrand(psi: Real) -> Real:
                rise, rest = 2 * mp.sin(psi / 2) ** 2, 2 * mp.cos(psi / 2) ** 2
                height = mp.sqrt((near + rise) * (far + rest))
                if square:
                    return (mp.sin(psi) / height) ** 2 * mp.cos(n * psi)
                return mp.sin(psi) / height * mp.sin(n * psi)

            return mp.quad(integrand, panels, method="gauss-legendre")

        found = []
        for n in orders:
            # theta = pi/2 + psi, where cos theta = -sin psi; and -pi/2 + psi.
            linear = mp.mpc(0, 1) * (
                mp.mpc(0, -1) ** n * quarter(above, below, False, n)
                - mp.mpc(0, 1) ** n * quarter(below, above, False, n)
            )
            square = mp.mpc(0, -1) ** n * quarter(above, below, True, n)
            square += mp.mpc(0, 1) ** n * quarter(below, above, True, n)
            velocity, half = 2 * linear / mp.pi, square / mp.pi
            roll, crank = mp.mpc(0, n) * (velocity + half), -mp.mpc(0, n) * half
            found.append((complex(roll), complex(crank)))
        return found
