"""Which V-14 arrangements have a bank angle that leaves only first-order moment a counterweight
can cancel, and what is left?

Source: Ito and Hattori, "Exciting Moment Analysis of V-Type Engine (14-Cylinder V-Type Engine)",
JSME International Journal, equations 3 to 14 and Table 1. x lies along the bisector; the paper's
pitch M_y is the bisector's sum of s F, its yaw M_x minus the lateral one. An arrangement is the
list of phase numbers 1 ... 7 from the front cylinder (s = 3) to the rear one (s = -3); phase
number k runs ahead by 2 pi (k - 1)/7. Moments are in units of m_rec r s omega^2, those of the
second order in lambda times that. Every top dead centre is held while the V-angle changes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import permutations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
ComplexArray = NDArray[np.complex128]

CYLINDERS = 7  # of one bank
LEVERS = np.arange(3, -4, -1)  # s = 3 ... -3


def piston_force(theta: ArrayLike, rod_ratio: float) -> Array:
    """Equation (3) with its lost square restored, F over m_rec r omega^2.

    cos theta + lambda cos 2 theta/cos delta + lambda^3 sin^2 2 theta/(4 cos^3 delta),
    sin delta = lambda sin theta. The scan prints sin 2 theta.
    """
    th = np.asarray(theta, dtype=np.float64)
    cos_rod = np.sqrt(1.0 - (rod_ratio * np.sin(th)) ** 2)
    second = rod_ratio * np.cos(2 * th) / cos_rod
    return np.cos(th) + second + rod_ratio**3 * np.sin(2 * th) ** 2 / (4.0 * cos_rod**3)


def bank_moment(arrangement: Sequence[int], theta: ArrayLike, rod_ratio: float) -> Array:
    """Equation (6) over M_0: sum s F(theta + 2 pi (k - 1)/7), in the shape of theta."""
    th = np.asarray(theta, dtype=np.float64)
    ahead = 2.0 * np.pi * (np.asarray(arrangement) - 1) / CYLINDERS
    return np.asarray(
        sum(s * piston_force(th + a, rod_ratio) for s, a in zip(LEVERS, ahead, strict=True))
    )


def engine_moment(
    first: Sequence[int],
    second: Sequence[int],
    v_angle: float,
    theta: ArrayLike,
    rod_ratio: float,
) -> tuple[Array, Array]:
    """Equation (5) over M_0, pitch M_y and yaw M_x; alpha_2 = -alpha_1 = v_angle/2 (radians)."""
    one, two = bank_moment(first, theta, rod_ratio), bank_moment(second, theta, rod_ratio)
    a1, a2 = -v_angle / 2.0, v_angle / 2.0
    pitch = one * np.cos(a1) + two * np.cos(a2)
    return pitch, -(one * np.sin(a1) + two * np.sin(a2))


def bank_sum(arrangements: ArrayLike, order: int = 1) -> ComplexArray:
    """Z = sum s e^{2 pi i n (k - 1)/7} of arrangements (..., 7), shape (...)."""
    ahead = 2.0j * np.pi * order * (np.asarray(arrangements) - 1) / CYLINDERS
    return np.asarray(np.sum(LEVERS * np.exp(ahead), axis=-1))


def bank_coefficients(arrangement: Sequence[int]) -> tuple[float, float]:
    """a_1, a_2 (or b_1, b_2) of equation (7): bank moment a_1 cos theta + a_2 sin theta."""
    z = complex(bank_sum(arrangement))
    return z.real, -z.imag


def bank_angle(first: ArrayLike, second: ArrayLike) -> Array:
    """V-angle, radians, (...), at which the first-order moment has no backward part.

    M_y - i M_x = M_01 e^{i alpha_1} + M_02 e^{i alpha_2}; its part with e^{-i theta} vanishes if
    conj Z_1 e^{i alpha_1} = -conj Z_2 e^{i alpha_2}: |Z_1| = |Z_2|, alpha = arg(-Z_2/Z_1).
    """
    return np.asarray(np.angle(-bank_sum(second) / bank_sum(first)))


class Precession(NamedTuple):
    """First-order moment at the right V-angle, equation (13), and what the second order leaves."""

    v_angle_deg: float
    amplitude: float
    phase_deg: float
    second_order_pitch: float
    second_order_yaw: float


def precession(first: Sequence[int], second: Sequence[int]) -> Precession:
    """V-angle, amplitude and phase of M_y = M cos(theta + theta_0), M_x = -M sin(theta + theta_0),
    and peaks of second-order pitch and yaw in units of lambda M_0.
    """
    alpha = float(bank_angle(first, second))
    turns = np.exp([-0.5j * alpha, 0.5j * alpha])
    forward = (bank_sum(first) * turns[0] + bank_sum(second) * turns[1]) / 2.0
    one, two = bank_sum(first, 2), bank_sum(second, 2)
    return Precession(
        v_angle_deg=float(np.rad2deg(alpha)),
        amplitude=float(np.abs(forward)),
        phase_deg=float(np.rad2deg(np.angle(forward))),
        second_order_pitch=float(np.abs((one + two) * np.cos(alpha / 2.0))),
        second_order_yaw=float(np.abs((one - two) * np.sin(alpha / 2.0))),
    )


def _place_sequences() -> Iterator[tuple[int, ...]]:
    """Places 0 (front) ... 6 in the order in which they fire, the central cylinder first.

    After the central cylinder front three and rear three take turns, either beginning.
    """
    for front in permutations((0, 1, 2)):
        for rear in permutations((4, 5, 6)):
            for one, other in ((front, rear), (rear, front)):
                yield (3, *(place for pair in zip(one, other, strict=True) for place in pair))


def arrangements(alternating: bool = True) -> IntArray:
    """Phase numbers by place, (504, 7), or all of them, (5040, 7).

    Equal firing intervals of two turns over seven cylinders step through the phases by two.
    Ignition alternates across the central cylinder; 2 * 3! * 3! orders, begun at any of 7 phases.
    """
    if not alternating:
        return np.array(list(permutations(range(1, CYLINDERS + 1))), dtype=np.int64)
    found = np.empty((504, CYLINDERS), dtype=np.int64)
    rows = ((start, places) for start in range(CYLINDERS) for places in _place_sequences())
    for row, (start, places) in enumerate(rows):
        phases = (start + 2 * np.arange(CYLINDERS)) % CYLINDERS
        found[row, list(places)] = phases + 1
    return found


def magnitude_key(arrangements_: IntArray) -> IntArray:
    """|Z|^2 exactly, as integers, (n, 3): equal rows if and only if equal |Z|.

    |Z|^2 = sum c_k zeta^k with c_k = c_{7-k} the cyclic autocorrelation of the levers by phase;
    c_0 and the sum of all c_k are the same for every arrangement, and the powers of zeta satisfy
    no other rational relation than that they add up to zero. So c_1, c_2, c_3 decide.
    """
    by_phase = LEVERS[np.argsort(arrangements_, axis=1)]
    keys = [np.sum(by_phase * np.roll(by_phase, k, axis=1), axis=1) for k in (1, 2, 3)]
    return np.stack(keys, axis=1)


def qualifying_angles(arrangements_: IntArray) -> Array:
    """V-angle, degrees, of every pair of arrangements with |Z_1| = |Z_2|, (n_pairs,)."""
    z = bank_sum(arrangements_)
    _, label = np.unique(magnitude_key(arrangements_), axis=0, return_inverse=True)
    label = label.ravel()
    angles = []
    for value in range(label.max() + 1):
        alike = z[label == value]
        angles.append(np.angle(-alike[np.newaxis, :] / alike[:, np.newaxis]).ravel())
    return np.asarray(np.rad2deg(np.concatenate(angles)))


def distinct_sizes(angles_deg: Array, digits: int = 7) -> Array:
    """The sizes |alpha| that occur, sorted; angles 1e-7 degrees apart count as one."""
    return np.unique(np.round(np.abs(angles_deg), digits))


def pairs_with_angle(
    arrangements_: IntArray, v_angle_deg: float, tolerance_deg: float = 0.005
) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Qualifying pairs whose V-angle has the given (signed) size to the printed two decimals."""
    z = bank_sum(arrangements_)
    _, label = np.unique(magnitude_key(arrangements_), axis=0, return_inverse=True)
    label = label.ravel()
    for i, row in enumerate(arrangements_):
        alike = np.flatnonzero(label == label[i])
        angle = np.rad2deg(np.angle(-z[alike] / z[i]))
        for j in alike[np.abs(np.abs(angle) - v_angle_deg) <= tolerance_deg]:
            yield tuple(map(int, row)), tuple(map(int, arrangements_[j]))
