"""What peak moments does the IJESC paper's V6 have at each V-angle, for each firing order?

Source: "selecting the V-angle for six cylinders V-engine", IJESC, April 2017, equations 1 to 11
and Tables I to IV. The paper calls the bisector of the V "X" (our y) and the lateral direction
"Y" (our x, its positive side to the left), and weights forces by z: its M_x is the size of our
pitch moment M_x, its M_y of our yaw moment M_y, both about the plane of crank 1.

Corrected on the way: equation (3) prints cos 2(theta + gamma) for the left bank where (5) goes on
with theta - gamma; brackets missing in (6) and (7) make its r/l act on one half of a sum; the list
after (11) names the sum of z sin phi a second "sum of z cos phi". Not printed at all is how
a firing order becomes lags: ``lags_deg`` is the rule that makes the tables come out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rederivation import kinematics

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = NDArray[np.float64]

MASS = 1.487  # kg, reciprocating, per cylinder
CRANK_RADIUS = 0.045  # m
ROD_LENGTH = 0.158  # m; the printed "n = 3.51" is l/r
RPM = 5000.0
SPACING = 0.13  # m, between neighbouring cylinders of a bank
FIRING_ORDERS: tuple[tuple[int, ...], ...] = (
    (1, 3, 5, 2, 4, 6),
    (1, 4, 5, 2, 3, 6),
    (1, 6, 5, 4, 3, 2),
    (1, 5, 3, 6, 2, 4),
)  # Tables I to IV
V_ANGLES_DEG = np.arange(10.0, 171.0, 10.0)
ROD_RATIO = CRANK_RADIUS / ROD_LENGTH  # what the paper uses as second-order coefficient


def force_scale(rpm: float = RPM) -> float:
    """Peak first-order force of one cylinder, m r omega^2 (newtons)."""
    return MASS * CRANK_RADIUS * (2.0 * np.pi * rpm / 60.0) ** 2


def exact_a2(n_samples: int = 256) -> float:
    """Second-order coefficient of the true motion, by Fourier transform: 0.29082 for 0.28481."""
    theta = 2.0 * np.pi * np.arange(n_samples) / n_samples
    a = -kinematics.acceleration(theta, 1.0, ROD_LENGTH / CRANK_RADIUS)
    return float(2.0 * np.mean(a * np.cos(2.0 * theta)))


def lags_deg(firing_order: Sequence[int]) -> Array:
    """Lag phi of cylinders 1 to 6, degrees: each bank's cylinders in the order in which they fire.

    Right bank (odd numbers) and left bank (even) each count 0, 120, 240 for themselves. Example:
    1-4-5-2-3-6 fires 1, 5, 3 on the right and 4, 2, 6 on the left.
    """
    lag = np.empty(6)
    for parity in (1, 0):
        bank = [cylinder for cylinder in firing_order if cylinder % 2 == parity]
        lag[np.array(bank) - 1] = (0.0, 120.0, 240.0)
    return lag


# --- equations 1 to 5: one cylinder and a V-twin ------------------------------------------------


def single(theta: ArrayLike, a2: float = ROD_RATIO) -> Array:
    """Equation (1) over m r omega^2: cos theta + (r/l) cos 2 theta."""
    th = np.asarray(theta, dtype=np.float64)
    return np.cos(th) + a2 * np.cos(2.0 * th)


def twin(theta: ArrayLike, gamma: float, a2: float = ROD_RATIO) -> tuple[Array, Array]:
    """Equations (2) and (3), right and left bank: the crank angle plus and minus gamma."""
    th = np.asarray(theta, dtype=np.float64)
    return single(th + gamma, a2), single(th - gamma, a2)


def twin_expanded(theta: ArrayLike, gamma: float, a2: float = ROD_RATIO) -> tuple[Array, Array]:
    """Equations (4) and (5), the same with the cosines of sums written out."""
    th = np.asarray(theta, dtype=np.float64)
    c1, s1 = np.cos(th) * np.cos(gamma), np.sin(th) * np.sin(gamma)
    c2, s2 = np.cos(2 * th) * np.cos(2 * gamma), np.sin(2 * th) * np.sin(2 * gamma)
    return (c1 - s1) + a2 * (c2 - s2), (c1 + s1) + a2 * (c2 + s2)


# --- equations 6 to 11: banks of three ----------------------------------------------------------


def bank_sum(wt: Array, gamma: float, lag: Array, weight: Array, order: int, right: bool) -> Array:
    """One order of equations (6), (7) (weight 1) and (9), (10) (weight z), over m r omega^2.

    Right: (cos n wt cos n gamma - sin n wt sin n gamma) sum w cos n phi
    + (cos n wt sin n gamma + sin n wt cos n gamma) sum w sin n phi; left: gamma negative.
    """
    g = order * (gamma if right else -gamma)
    t, phi = order * wt, order * lag
    ahead = np.cos(t) * np.cos(g) - np.sin(t) * np.sin(g)
    aside = np.cos(t) * np.sin(g) + np.sin(t) * np.cos(g)
    return np.asarray(ahead * np.sum(weight * np.cos(phi)) + aside * np.sum(weight * np.sin(phi)))


def components(
    wt: ArrayLike,
    v_angle_deg: float,
    firing_order: Sequence[int],
    a2: float = ROD_RATIO,
    spacing: float = SPACING,
    moments: bool = True,
) -> Array:
    """Equations (8) or (11): px, py, sx, sy at each wt, (4, n_wt), N m (or N for forces).

    X is the bisector, (left + right) cos gamma; Y is lateral, (left - right) sin gamma.
    """
    t = np.asarray(wt, dtype=np.float64)
    gamma, lag = np.deg2rad(v_angle_deg) / 2.0, np.deg2rad(lags_deg(firing_order))
    weight = spacing * np.arange(3.0) if moments else np.ones(3)
    rows = []
    for order, coefficient in ((1, 1.0), (2, a2)):
        right = bank_sum(t, gamma, lag[0::2], weight, order, right=True)
        left = bank_sum(t, gamma, lag[1::2], weight, order, right=False)
        scale = coefficient * force_scale()
        rows += [scale * (left + right) * np.cos(gamma), scale * (left - right) * np.sin(gamma)]
    return np.stack(rows)


def peaks_as_printed(
    v_angles_deg: ArrayLike = V_ANGLES_DEG,
    firing_orders: Sequence[Sequence[int]] = FIRING_ORDERS,
    a2: float = ROD_RATIO,
) -> Array:
    """The tables by the paper's own way, (n_firing, n_angle, 4): M_px, M_py, M_sx, M_sy, N m.

    One pass over the crank angle, 0 to 360 degrees by one degree, per V-angle and firing order;
    the peak is the largest sample.
    """
    angles = np.asarray(v_angles_deg, dtype=np.float64)
    wt = np.deg2rad(np.arange(361.0))
    peaks = np.empty((len(firing_orders), angles.size, 4))
    for i, firing_order in enumerate(firing_orders):
        for j, angle in enumerate(angles):
            peaks[i, j] = np.abs(components(wt, float(angle), firing_order, a2)).max(axis=1)
    return peaks


# --- what a designer would have least -----------------------------------------------------------


def longest_moment(
    v_angles_deg: ArrayLike = V_ANGLES_DEG,
    firing_orders: Sequence[Sequence[int]] = FIRING_ORDERS,
    a2: float = ROD_RATIO,
    n_samples: int = 36,
) -> Array:
    """Longest moment of both orders together among a few crank angles, (n_firing, n_angle), N m."""
    angles = np.asarray(v_angles_deg, dtype=np.float64)
    wt = 2.0 * np.pi * np.arange(n_samples) / n_samples
    longest = np.empty((len(firing_orders), angles.size))
    for i, firing_order in enumerate(firing_orders):
        for j, angle in enumerate(angles):
            px, py, sx, sy = components(wt, float(angle), firing_order, a2)
            longest[i, j] = np.hypot(px + sx, py + sy).max()
    return longest


def primary_against_crank(
    v_angles_deg: ArrayLike = V_ANGLES_DEG,
    firing_orders: Sequence[Sequence[int]] = FIRING_ORDERS,
    n_samples: int = 36,
) -> Array:
    """Primary moment that no counterweight on the crank can take, (n_firing, n_angle), N m.

    The mean of (X + iY) e^{i wt}: from X, the bisector, to Y, on its left, is the way that the
    crank turns, and what turns against it goes with e^{-i wt}.
    """
    angles = np.asarray(v_angles_deg, dtype=np.float64)
    wt = 2.0 * np.pi * np.arange(n_samples) / n_samples
    against = np.empty((len(firing_orders), angles.size))
    for i, firing_order in enumerate(firing_orders):
        for j, angle in enumerate(angles):
            px, py, _, _ = components(wt, float(angle), firing_order)
            against[i, j] = abs(np.mean((px + 1j * py) * np.exp(1j * wt)))
    return against


# --- the same without samples -------------------------------------------------------------------


def bank_phasors(firing_orders: Sequence[Sequence[int]]) -> NDArray[np.complex128]:
    """Z = sum z e^{-i n phi}, (n_firing, 2 orders, right and left), metres."""
    lag = np.deg2rad(np.array([lags_deg(firing_order) for firing_order in firing_orders]))
    each = np.exp(-1j * np.array([1.0, 2.0])[:, np.newaxis] * lag[:, np.newaxis, :])
    by_bank = each.reshape(len(firing_orders), 2, 3, 2)
    return np.asarray(SPACING * np.einsum("p,fopb->fob", np.arange(3.0), by_bank))


def peaks_closed_form(
    v_angles_deg: ArrayLike = V_ANGLES_DEG,
    firing_orders: Sequence[Sequence[int]] = FIRING_ORDERS,
    a2: float = ROD_RATIO,
) -> Array:
    """Peaks from phasors, plainly vectorised, (n_firing, n_angle, 4) in newton metres.

    |left e^{-i n gamma} +- right e^{i n gamma}| times cos gamma or sin gamma, no crank angle.
    """
    gamma = np.deg2rad(np.asarray(v_angles_deg, dtype=np.float64)) / 2.0
    z = bank_phasors(firing_orders)
    peaks = np.empty((len(firing_orders), gamma.size, 4))
    for k, coefficient in enumerate((1.0, a2)):
        right = z[:, k, 0, np.newaxis] * np.exp(1j * (k + 1) * gamma)
        left = z[:, k, 1, np.newaxis] * np.exp(-1j * (k + 1) * gamma)
        scale = coefficient * force_scale()
        peaks[:, :, 2 * k] = scale * np.abs((left + right) * np.cos(gamma))
        peaks[:, :, 2 * k + 1] = scale * np.abs((left - right) * np.sin(gamma))
    return peaks


def _bisector_lateral_forms(
    firing_orders: Sequence[Sequence[int]], a2: float
) -> tuple[Array, Array]:
    """Real coefficients of the peaks' real and imaginary parts, each (4, n_firing, 2).

    With c = cos n gamma, s = sin n gamma and right R, left L:
    L e^{-i n gamma} + R e^{i n gamma} = (R + L) c + i (R - L) s, and the difference (L - R)
    exchanges sums and differences. The last axis multiplies c and s.
    """
    z = bank_phasors(firing_orders) * (force_scale() * np.array([1.0, a2]))[:, np.newaxis]
    total, difference = z[..., 0] + z[..., 1], z[..., 0] - z[..., 1]
    c_part = np.stack([total, difference], axis=-1).reshape(-1, 4).T
    s_part = 1j * np.stack([difference, total], axis=-1).reshape(-1, 4).T
    both = np.stack([c_part, s_part], axis=-1)
    return np.asarray(both.real), np.asarray(both.imag)


def peaks_closed_form_fast(
    v_angles_deg: ArrayLike = V_ANGLES_DEG,
    firing_orders: Sequence[Sequence[int]] = FIRING_ORDERS,
    a2: float = ROD_RATIO,
    block: int = 512,
) -> Array:
    """The same peaks as fast as NumPy goes, (n_firing, n_angle, 4) in newton metres.

    One cosine and one sine per angle, shared by all firing orders; second order by doubling the
    angle; each part a product of small real matrices; blocks of angles that stay in the cache.
    """
    gamma = np.deg2rad(np.asarray(v_angles_deg, dtype=np.float64)) / 2.0
    c1, s1 = np.cos(gamma), np.sin(gamma)
    c2, s2 = (c1 - s1) * (c1 + s1), 2.0 * s1 * c1
    basis = np.empty((4, 2, gamma.size))
    np.stack([c1 * c1, s1 * c1, c1 * s1, s1 * s1], out=basis[:2].reshape(4, -1))
    np.stack([c2 * c1, s2 * c1, c2 * s1, s2 * s1], out=basis[2:].reshape(4, -1))
    real, imag = _bisector_lateral_forms(firing_orders, a2)
    peaks = np.empty((len(firing_orders), gamma.size, 4))
    for start in range(0, gamma.size, block):
        part = basis[:, :, start : start + block]
        re, im = real @ part, imag @ part
        re *= re
        im *= im
        re += im
        np.sqrt(re, out=re)
        peaks[:, start : start + block, :] = re.transpose(1, 2, 0)
    return peaks
