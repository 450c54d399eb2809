"""What are the harmonics of one slider-crank, to fifty digits?

Inertia force = m r omega^2 Re sum a_n e^{i n theta}, theta from top dead centre, lambda = r/l and
offset e/r given as doubles and taken at their exact binary values. a_1 = 1 (plus the offset's
part); with d = sqrt(l^2 - (r sin theta - e)^2), a_n is -2/r times the n-th Fourier coefficient of
d''. As d depends on theta through sin theta alone, even orders are real (cosines) and odd ones
imaginary (sines); without offset the odd ones are zero.

``harmonics`` integrates the exact second derivative by the trapezoid rule. ``harmonics_by_series``
expands the position in powers of sin theta, and ``even_harmonic_closed_form`` is Gauss's
hypergeometric function for e = 0; ``harmonic_by_gauss_legendre`` integrates the position. They
share nothing but the geometry, and are there to confirm the first.
Run ``python -m rederivation.harmonics_mp`` in the directory above to write the stored table again.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import mpmath as mp  # type: ignore[import-untyped]

TABLE = Path(__file__).parent.parent / "data" / "harmonics_50_digits.csv"
MAX_ORDER = 40
DIGITS = 50

ROD_RATIOS = (
    *(1e-6, 1e-3, 0.05, 0.15, 0.25, 0.285, 1 / 3, 0.45, 0.5),
    *(0.6, 0.75, 0.9, 0.95, 0.99, 0.999),
)
OFFSETS_OVER_ROD = (0.0, 1e-12, 1e-8, 1e-4, 0.01, 0.05, 0.2)

Real = Any  # mpmath carries no types
Harmonics = tuple[tuple[Real, Real], ...]  # (real, imaginary) parts of a_1 ... a_max


def is_admissible(rod_ratio: float, offset_over_radius: float) -> bool:
    """The crank turns right round: l - |e| > r, with a margin that keeps the grid off the edge."""
    return rod_ratio * (1.0 + abs(offset_over_radius)) < 1.0 - 1e-9


def _decay(rod_ratio: float, offset_over_radius: float) -> float:
    """Rate at which a_n falls: Im theta of the nearest point with |r sin theta - e| = l.

    There cosh Im theta = (l - |e|)/r; a_n is about e^{-n Im theta}.
    """
    return math.acosh(1.0 / rod_ratio - abs(offset_over_radius))


def _working_digits(decay: float, offset_over_radius: float, max_order: int, digits: int) -> int:
    """Decimal digits so that the smallest harmonic keeps ``digits`` of its own."""
    small_offset = -math.log10(abs(offset_over_radius)) if offset_over_radius else 0.0
    return digits + 20 + int(decay * max_order / math.log(10.0) + max(small_offset, 0.0))


def _sine_part_second_derivative(sine: Real, square_cosine: Real, rod: Real, offset: Real) -> Real:
    """-d'' for r = 1: d d'' = -(w'^2 + w w'') - d'^2 with w = sin theta - e, d d' = -w w'."""
    w = sine - offset
    d_squared = (rod - w) * (rod + w)
    return (square_cosine - w * sine + w * w * square_cosine / d_squared) / mp.sqrt(d_squared)


@lru_cache(maxsize=256)
def harmonics(
    rod_ratio: float,
    offset_over_radius: float = 0.0,
    max_order: int = MAX_ORDER,
    digits: int = DIGITS,
) -> Harmonics:
    """(real, imaginary) of a_1 ... a_max_order with ``digits`` correct each, by the trapezoid rule.

    N samples miss a_n by a_{N-n}, hence N from the decay. d(pi - theta) = d(theta): half a turn
    will do. A parity that is zero by symmetry is returned as exact zero.
    """
    decay = _decay(rod_ratio, offset_over_radius)
    small = max(0.0, -math.log(abs(offset_over_radius))) if offset_over_radius else 0.0
    n = 2 * max_order + int(((digits + 5) * math.log(10.0) + small) / decay) + 8
    n += -n % 4
    with mp.workdps(_working_digits(decay, offset_over_radius, max_order, digits)):
        rod, offset = 1 / mp.mpf(rod_ratio), mp.mpf(offset_over_radius)
        cosine = [mp.cospi(mp.mpf(2 * k) / n) for k in range(n)]
        quarter = n // 4
        samples = {}
        for k in range(-quarter, quarter + 1):
            sine, square = cosine[(k - quarter) % n], cosine[k % n] ** 2
            weight = 1 if abs(k) == quarter else 2
            samples[k] = weight * _sine_part_second_derivative(sine, square, rod, offset)
        found = []
        for order in range(1, max_order + 1):
            shift = 0 if order % 2 == 0 else quarter
            total = mp.fsum(f * cosine[(order * k - shift) % n] for k, f in samples.items())
            value = 2 * total / n
            if order % 2 == 0:
                found.append((value, mp.mpf(0)))
            else:
                sine_part = -value if offset_over_radius else mp.mpf(0)
                found.append((mp.mpf(1 if order == 1 else 0), sine_part))
    return tuple(found)


def even_harmonic_closed_form(rod_ratio: float, order: int, digits: int = DIGITS) -> Real:
    """a_2k without offset: 8 k^2/lambda binom(1/2, k) (lambda^2/4)^k 2F1(k-1/2, k+1/2; 2k+1; l^2).

    From the binomial series of sqrt(1 - lambda^2 sin^2 theta) and the cosines of sin^{2j} theta.
    """
    k = order // 2
    with mp.workdps(digits + 20):
        lam = mp.mpf(rod_ratio)
        half = mp.mpf(1) / 2
        gauss = mp.hyp2f1(k - half, k + half, 2 * k + 1, lam**2)
        return 8 * k**2 / lam * mp.binomial(half, k) * (lam**2 / 4) ** k * gauss


def harmonics_by_series(
    rod_ratio: float,
    offset_over_radius: float = 0.0,
    max_order: int = MAX_ORDER,
    digits: int = DIGITS,
) -> Harmonics:
    """The same from d = sum y_j sin^j theta, y by the differential equation 2 q y' = q' y.

    q = l^2 - e^2 + 2 e s - s^2 in units of r. sin^j holds cos or sin of j, j - 2, ... times
    binomials. The series converges like (r/(l - |e|))^j: for ratios up to about 0.95.
    """
    decay = _decay(rod_ratio, offset_over_radius)
    ratio = 1.0 / math.cosh(decay)
    terms = max_order + int((digits + 10) * math.log(10.0) / -math.log(ratio)) + 80
    with mp.workdps(_working_digits(decay, offset_over_radius, max_order, digits) + 30):
        y = _sine_coefficients(1 / mp.mpf(rod_ratio), mp.mpf(offset_over_radius), terms)
        found = []
        for order in range(1, max_order + 1):
            size = _sine_power_sum(y, order)
            sign = -1 if (order // 2) % 2 else 1
            a = sign * 2 * order**2 * size
            if order % 2 == 0:
                found.append((a, mp.mpf(0)))
            else:
                found.append((mp.mpf(1 if order == 1 else 0), -a))
    return tuple(found)


def _sine_coefficients(rod: Real, offset: Real, terms: int) -> list[Real]:
    """y_0 ... of sqrt(q), q = q0 + 2 e s - s^2, from 2 q y' = q' y power by power of s:
    q0 (j + 1) y_{j+1} = e (1 - 2j) y_j + (j - 2) y_{j-1}.
    """
    q0 = (rod - offset) * (rod + offset)
    y = [mp.sqrt(q0)]
    y.append(offset * y[0] / q0)
    for j in range(1, terms):
        y.append((offset * (1 - 2 * j) * y[j] + (j - 2) * y[j - 1]) / (q0 * (j + 1)))
    return y


def _sine_power_sum(y: Sequence[Real], order: int) -> Real:
    """Sum of y_j 2^{-j} binom(j, (j - n)/2) over j = n, n + 2, ...: half the size of harmonic n."""
    total, weight = mp.mpf(0), mp.mpf(2) ** -order
    for j in range(order, len(y), 2):
        total += weight * y[j]
        up = j + 2
        weight = weight * up * (up - 1) / (4 * ((up - order) // 2) * ((up + order) // 2))
    return total


def harmonic_by_gauss_legendre(
    rod_ratio: float, offset_over_radius: float, order: int, digits: int = DIGITS
) -> Real:
    """a_n once more, its real (even n) or imaginary (odd n) part: n^2/pi times the integral of
    d(theta) cos or -sin(n theta), by Gauss-Legendre quadrature on pieces of the turn.
    """
    decay = _decay(rod_ratio, offset_over_radius)
    with mp.workdps(_working_digits(decay, offset_over_radius, order, digits)):
        rod, offset = 1 / mp.mpf(rod_ratio), mp.mpf(offset_over_radius)

        def integrand(theta: Real) -> Real:
            w = mp.sin(theta) - offset
            turn = mp.cos(order * theta) if order % 2 == 0 else -mp.sin(order * theta)
            return mp.sqrt((rod - w) * (rod + w)) * turn

        pieces = [mp.pi * k / 8 for k in range(-4, 5)]
        half_turn = mp.quad(integrand, pieces, method="gauss-legendre")
        return 2 * order**2 * half_turn / mp.pi


class ReferenceRow(NamedTuple):
    """One row of the stored table: the significant part of a_1 ... a_40 as decimal strings."""

    rod_ratio: float
    offset_over_radius: float
    digits: tuple[str, ...]
    """entry n - 1: real part of a_n for even n, imaginary part for odd n (a_1's real part is 1)"""

    def coefficients(self) -> list[complex]:
        """a_1 ... a_40 rounded to double precision."""
        parts = [float(text) for text in self.digits]
        return [
            complex(part, 0.0) if n % 2 == 0 else complex(1.0 if n == 1 else 0.0, part)
            for n, part in enumerate(parts, start=1)
        ]


def reference_table(path: Path = TABLE) -> list[ReferenceRow]:
    """The stored table; its rod ratios and offsets over radius are doubles written in full."""
    with path.open(newline="") as file:
        rows = csv.reader(file)
        next(rows)
        return [ReferenceRow(float(lam), float(e), tuple(rest)) for lam, e, *rest in rows]


def grid() -> list[tuple[float, float]]:
    """Rod ratio and offset over radius of every row, the latter (e/l)/lambda, rounded."""
    pairs = [(lam, e / lam) for lam in ROD_RATIOS for e in OFFSETS_OVER_ROD]
    return [pair for pair in pairs if is_admissible(*pair)]


def significant_parts(values: Harmonics) -> list[Real]:
    """Real parts of even orders and imaginary parts of odd ones."""
    return [real if n % 2 == 0 else imag for n, (real, imag) in enumerate(values, start=1)]


def write_reference_table(path: Path = TABLE) -> None:
    """Compute the grid and store fifty digits of each coefficient, one row per slider-crank."""
    with path.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        orders = [f"{'real' if n % 2 == 0 else 'imag'}_{n}" for n in range(1, MAX_ORDER + 1)]
        out.writerow(["rod_ratio", "offset_over_radius", *orders])
        for lam, e in grid():
            parts = significant_parts(harmonics(lam, e))
            out.writerow([repr(lam), repr(e), *(mp.nstr(part, DIGITS) for part in parts)])


if __name__ == "__main__":
    write_reference_table()
