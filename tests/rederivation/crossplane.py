"""What forces and couples does the cross-plane V8 of the Japanese page exert?

Source: "V-type 8-cylinder engine: inertia forces and couples (cross-plane)", firing order
1-8-4-3-6-5-7-2, 90 degrees, cylinders 1, 3, 5, 7 from the front on the left bank and 2, 4, 6, 8
on the right, theta from cylinder 1's top dead centre. The page works in units of one cylinder's
force at the order in question and of the distance a between neighbouring pins; levers count
positive towards the front (our z the other way), horizontal is positive to the right.

The page's fourth order is wrong: it writes cos(4 theta - pi/2) where the right bank's lag of pi/2
makes cos 4(theta - pi/2) = cos 4 theta, and so draws a circle of 4 units for what is a vertical
force of 4 sqrt 2. Both are here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

FIRING_ORDER = (1, 8, 4, 3, 6, 5, 7, 2)
LEFT, RIGHT = (1, 3, 5, 7), (2, 4, 6, 8)
LEVERS = np.array([1.5, 0.5, -0.5, -1.5])  # of the four pins, front first, in units of a
ALPHA = np.pi / 4.0  # half the bank angle
COUPLE_AMPLITUDE = np.sqrt(10.0)  # units of M omega^2 (S/2) a
COUPLE_PHASE = np.pi / 4.0 + np.arctan(3.0)


def lags(cylinders: tuple[int, ...]) -> Array:
    """Angle by which each cylinder lags cylinder 1, radians, (n,): 90 degrees per firing."""
    return np.array([FIRING_ORDER.index(cylinder) for cylinder in cylinders]) * np.pi / 2.0


def along_banks(order: int, levers: Array) -> tuple[complex, complex]:
    """Sums w cos n(theta - lag) along the left and the right bore, as phasors of e^{i n theta}."""
    left, right = (
        complex(np.sum(levers * np.exp(-1j * order * lags(bank)))) for bank in (LEFT, RIGHT)
    )
    return left, right


def horizontal_vertical(left: complex, right: complex) -> ComplexArray:
    """Components of the two banks' sums, (2,): (right - left) sin alpha, (right + left) cos alpha.

    The page names the complement alpha in one line and swaps sine and cosine; at 45 degrees
    they are equal.
    """
    return np.array([(right - left) * np.sin(ALPHA), (right + left) * np.cos(ALPHA)])


def force(order: int) -> ComplexArray:
    """Shaking force, horizontal and vertical phasor, (2,), in units of one cylinder's force."""
    return horizontal_vertical(*along_banks(order, np.ones(4)))


def couple(order: int) -> ComplexArray:
    """Sums of lever times horizontal and vertical force, (2,), in units of a times one force."""
    return horizontal_vertical(*along_banks(order, LEVERS))


def first_order_couple(theta: ArrayLike, printed: bool = False) -> Array:
    """The page's result, (n, 2): sqrt 10 (sin, -cos)(theta - pi/4 - arctan 3), horiz., vert.

    The page prints the horizontal part with the other sign: its sentence turns the left bank
    round, its formula the right one, so that "horizontal" points left there. Only pointing right
    makes the couple turn with the crank, as its remark on counterweights needs.
    """
    t = np.asarray(theta, dtype=np.float64) - COUPLE_PHASE
    horizontal = -np.sin(t) if printed else np.sin(t)
    return np.asarray(COUPLE_AMPLITUDE * np.stack([horizontal, -np.cos(t)], axis=-1))


def fourth_order_force_as_printed(theta: ArrayLike) -> Array:
    """The page's circle, WRONG, (n, 2): 4 sin(4 theta - pi/4), 4 cos(4 theta - pi/4)."""
    t = 4.0 * np.asarray(theta, dtype=np.float64) - np.pi / 4.0
    return 4.0 * np.stack([np.sin(t), np.cos(t)], axis=-1)


def fourth_order_force(theta: ArrayLike) -> Array:
    """What it should be, (n, 2): every cylinder in step, 0 and 8 cos 45 degrees cos 4 theta."""
    t = 4.0 * np.asarray(theta, dtype=np.float64)
    return np.stack([np.zeros_like(t), 4.0 * np.sqrt(2.0) * np.cos(t)], axis=-1)


def fourth_order_coefficient(stroke_ratio: float, printed: bool = False) -> float:
    """Leading terms of -a_4 by lambda = l/S (rod over stroke): 1/(32 lambda^3) + 3/(512 lambda^5).

    One cylinder's fourth order is M (S/2) omega^2 a_4, four units are the page's -2 M omega^2 S
    times this number. The page prints 3/1024.
    """
    divisor = 1024.0 if printed else 512.0
    return 1.0 / (32.0 * stroke_ratio**3) + 3.0 / (divisor * stroke_ratio**5)
