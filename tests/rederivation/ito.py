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

import functools
import math
import operator
from itertools import permutations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

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
    first: Sequence[int], second: Sequence[int], v_angle: float, theta: ArrayLike, rod_ratio: float
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


# --- what comparing computed magnitudes finds -----------------------------------------------------

FORMULAS = ("equation (6)", "term by term", "hypot", "|exp sum|", "correlations")


def constants(dtype: type, digits: int | None = None) -> tuple[Array, Array]:
    """Cos and sin of 2 pi k/7 in a precision, or first rounded to so many decimal digits.

    Doubles one by one by the C library, which gives the nearest to cos and sin of the rounded
    angle; NumPy's own depend on the processor in the last bit, and the counts depend on that bit.
    """
    if dtype is np.longdouble:
        angles = 2 * np.arccos(np.longdouble(-1)) * np.arange(CYLINDERS) / CYLINDERS
        return np.cos(angles), np.sin(angles)
    turns = [2.0 * math.pi * k / CYLINDERS for k in range(CYLINDERS)]
    cos, sin = np.array([math.cos(t) for t in turns]), np.array([math.sin(t) for t in turns])
    if digits is not None:
        cos, sin = np.round(cos, digits), np.round(sin, digits)
    return cos.astype(dtype), sin.astype(dtype)


def squared_magnitudes(
    arrangements_: IntArray, formula: str, dtype: type = np.float64, digits: int | None = None
) -> Array:
    """|Z|^2 of arrangements (n, 7) as computed in floating point, (n,).

    "equation (6)": a^2 + b^2 with a = 3 (c_h - c_p) + 2 (c_j - c_n) + (c_k - c_m), b the same in
    sines. "term by term": a = 3 c_h + 2 c_j + c_k + 0 c_l - ..., from the front on. "hypot": the
    same a and b, hypot(a, b)^2. "|exp sum|": abs of a sum of complex exponentials, squared.
    "correlations": c_0 + 2 (c_1 cos 1/7 + c_2 cos 2/7 + c_3 cos 3/7) of a turn with whole c_k.
    """
    cos, sin = constants(dtype, digits)
    if formula == "correlations":
        twice: Array = (2 * magnitude_key(arrangements_)).astype(dtype)
        total = dtype(28) + twice[:, 0] * cos[1]
        return np.asarray((total + twice[:, 1] * cos[2]) + twice[:, 2] * cos[3])
    if formula == "|exp sum|":
        terms = (
            LEVERS.astype(dtype)
            * (cos + 1j * sin).astype(cos.dtype.char.upper())[arrangements_ - 1]
        )
        return np.asarray(np.abs(functools.reduce(operator.add, terms.T)) ** 2)
    a, b = (_bank_coefficient(part[arrangements_ - 1].T, formula) for part in (cos, sin))
    return np.asarray(np.hypot(a, b) ** 2 if formula == "hypot" else a * a + b * b)


def _bank_coefficient(by_place: Array, formula: str) -> Array:
    """A or b of the formulas above from cosines or sines by place, (7, n)."""
    kind = by_place.dtype.type
    if formula == "equation (6)":
        h, j, k, _, m, n, p = by_place
        return np.asarray(kind(3) * (h - p) + kind(2) * (j - n) + (k - m))
    terms = (kind(s) * part for s, part in zip(LEVERS, by_place, strict=True))
    return np.asarray(functools.reduce(operator.add, terms))


def pairs_within(squares: Array, tolerance: float) -> int:
    """Ordered pairs whose squared magnitudes differ by the tolerance at most; 0 is ==."""
    return int((np.abs(squares[:, np.newaxis] - squares) <= tolerance).sum())


# --- groups ---------------------------------------------------------------------------------------


def groups(*, signed: bool, shift: bool, negated: bool, backward: bool, digits: int = 6) -> int:
    """How many of the qualifying pairs differ in V-angle or wave, by one reading of "same wave".

    The wave is pitch and yaw of first and second order (equation 11). Same V-angle: with its sign,
    or its size. Same wave: as it is, or also if it begins at another crank angle (``shift``), if
    all of it has the other sign (``negated``), or if it runs backward in time with yaw's sign
    changed, as the mirrored engine's does (``backward``).
    """
    all_ = arrangements()
    one, two = bank_sum(all_), bank_sum(all_, 2)
    _, label = np.unique(magnitude_key(all_), axis=0, return_inverse=True)
    i, j = np.nonzero(label.ravel()[:, np.newaxis] == label.ravel())
    alpha = np.angle(-one[j] / one[i])
    first = (one[i] * np.exp(-0.5j * alpha) + one[j] * np.exp(0.5j * alpha)) / 2.0
    pitch = (two[i] + two[j]) * np.cos(alpha / 2.0)
    yaw = (two[i] - two[j]) * np.sin(alpha / 2.0)
    # At 0 and 180 degrees nothing is left at any order.
    still = np.abs(first) < 1e-9
    if shift:
        start = np.where(still, 1.0, first / np.where(still, 1.0, np.abs(first)))
        first, pitch, yaw = first / start, pitch / start**2, yaw / start**2
    waves = np.where(still, 0.0, np.stack([first, pitch, yaw]))
    same = [waves]
    if negated:
        # With the second order's sign alone where the start is free: half a turn later.
        same.append(waves * np.array([[1], [-1], [-1]]) if shift else -waves)
    if backward:
        same += [wave.conj() * np.array([[1], [1], [-1]]) for wave in same]
    angle = np.rad2deg(alpha) if signed else np.abs(np.rad2deg(alpha))
    rows = [np.concatenate([angle[np.newaxis], w.real, w.imag]) for w in same]
    rounded = np.round(np.stack(rows), digits) + 0.0
    rounded[:, 0] = np.where(rounded[:, 0] == -180.0, 180.0, rounded[:, 0])
    return len({min(map(tuple, of_pair)) for of_pair in rounded.transpose(2, 0, 1).tolist()})
