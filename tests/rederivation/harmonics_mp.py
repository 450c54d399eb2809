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
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import mpmath as mp

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

DATA = Path(__file__).parent.parent / "data"
TABLE = DATA / "harmonics_50_digits.csv"
HARD_TABLE = DATA / "harmonics_where_methods_fail.csv"
MAX_ORDER = 40
DIGITS = 50

ROD_RATIOS = (
    *(1e-6, 1e-3, 0.05, 0.15, 0.25, 0.285, 1 / 3, 0.45, 0.5),
    *(0.6, 0.75, 0.9, 0.95, 0.99, 0.999),
)
OFFSETS_OVER_ROD = (0.0, 1e-12, 1e-8, 1e-4, 0.01, 0.05, 0.2)

HARD_ORDERS = (*range(1, 9), 20, 21, 40, 41, 100, 101, 150, 199, 200)
HARD_ROD_RATIOS = (1e-8, 1e-3, 0.3, 0.6, 0.9, 0.99, 0.999, 1 - 2e-5, 1 - 1e-6, 1 - 1e-12)
HARD_SHARES = (1e-12, 1e-6, 0.5, 1 - 1e-3, 1 - 1e-6, 1 - 1e-9)
"""Of the offset at which the crank cannot turn any more, l - r."""

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


@lru_cache(maxsize=256)
def harmonics_by_recurrence(
    rod_ratio: float, offset_over_radius: float = 0.0, max_order: int = 200, digits: int = DIGITS
) -> Harmonics:
    """The same from three Fourier coefficients of d, for rod ratios next to 1 and high orders.

    d = sqrt(Q) with Q = q0 + q1 s - s^2, s = sin theta, gives 2 Q d' = Q' d, and with c_n the
    coefficient of e^{in theta}: sum over j = -2 ... 2 of Q_j (2n - 3j) c_{n-j} = 0. Upwards that
    loses digits, as the c fall and the recurrence's other solutions rise: as many are added as
    that takes. The spikes of d'' at sin theta = +-1 are left to panels that halve towards them.
    """
    with mp.workdps(digits + 40):
        above = 1 / mp.mpf(rod_ratio) + mp.mpf(offset_over_radius)
        below = 1 / mp.mpf(rod_ratio) - mp.mpf(offset_over_radius)
        lost = max_order * (mp.acosh(above) + mp.acosh(below)) / mp.log(10)
        small = -math.log10(abs(offset_over_radius)) if offset_over_radius else 0.0
    with mp.workdps(digits + 20 + int(lost) + int(max(small, 0.0))):
        above = 1 / mp.mpf(rod_ratio) + mp.mpf(offset_over_radius)
        below = 1 / mp.mpf(rod_ratio) - mp.mpf(offset_over_radius)
        c = [_rod_height_coefficient(above, below, n) for n in range(3)]
        q0 = above * below - mp.mpf(1) / 2
        q1 = (above - below) / mp.mpc(0, 2)
        fourier = {-2: mp.mpf(1) / 4, -1: -q1, 0: q0, 1: q1, 2: mp.mpf(1) / 4}
        for n in range(1, max_order - 1):
            known = {j: c[n - j] if n >= j else mp.conj(c[j - n]) for j in range(-1, 3)}
            total = sum(fourier[j] * (2 * n - 3 * j) * known[j] for j in known)
            c.append(-total / (fourier[-2] * (2 * n + 6)))
        found = []
        for order in range(1, max_order + 1):
            value = 2 * order**2 * c[order]
            if order % 2 == 0:
                found.append((value.real, mp.mpf(0)))
            else:
                found.append((mp.mpf(1 if order == 1 else 0), value.imag))
    return tuple(found)


def _rod_height_coefficient(above: Real, below: Real, order: int) -> Real:
    """Coefficient of e^{in theta} of sqrt((A - sin theta)(B + sin theta)), by quadrature.

    Over a quarter turn from each of sin theta = 1 and -1, where 1 - sin theta = 2 sin^2(phi/2).
    """

    def quarter(near: Real, far: Real) -> Real:
        def integrand(phi: Real) -> Real:
            sine, cosine = mp.sin(phi / 2) ** 2, mp.cos(phi / 2) ** 2
            height = mp.sqrt((near - 1 + 2 * sine) * (far - 1 + 2 * cosine))
            return height * mp.cos(order * phi)

        edges = [mp.pi / 2]
        while edges[-1] > mp.sqrt(2 * (near - 1)) / 2:
            edges.append(edges[-1] / 2)
        return mp.quad(integrand, [mp.mpf(0), *reversed(edges)], method="gauss-legendre")

    # theta = pi/2 - phi, and -pi/2 + phi: e^{-in theta} is even in phi times (-i)^n and i^n
    total = (-1j) ** order * quarter(above, below) + 1j**order * quarter(below, above)
    return total / mp.pi


class ReferenceRow(NamedTuple):
    """One row of a stored table: the significant parts of the a_n as decimal strings."""

    rod_ratio: float
    offset_over_radius: float
    orders: tuple[int, ...]
    digits: tuple[str, ...]
    """of each order: real part of a_n for even n, imaginary for odd n; a_1 has 1 as real part"""

    def coefficients(self) -> list[complex]:
        """The a_n rounded to double precision."""
        parts = [(n, float(text)) for n, text in zip(self.orders, self.digits, strict=True)]
        return [
            complex(part, 0.0) if n % 2 == 0 else complex(1.0 if n == 1 else 0.0, part)
            for n, part in parts
        ]


def reference_table(path: Path = TABLE) -> list[ReferenceRow]:
    """A stored table; its rod ratios and offsets over radius are doubles written in full."""
    with path.open(newline="") as file:
        rows = csv.reader(file)
        orders = tuple(int(name.partition("_")[2]) for name in next(rows)[2:])
        return [ReferenceRow(float(lam), float(e), orders, tuple(rest)) for lam, e, *rest in rows]


def grid() -> list[tuple[float, float]]:
    """Rod ratio and offset over radius of every row, the latter (e/l)/lambda, rounded."""
    pairs = [(lam, e / lam) for lam in ROD_RATIOS for e in OFFSETS_OVER_ROD]
    return [pair for pair in pairs if is_admissible(*pair)]


def hard_grid() -> list[tuple[float, float]]:
    """Rod ratio and offset over radius where methods fail: near both ends of either."""
    pairs = [(lam, 0.0) for lam in HARD_ROD_RATIOS]
    for lam in (0.3, 0.9, 0.999, 1 - 1e-6, 1 - 1e-12):
        # 1 - lam is exact next to 1
        pairs += [(lam, share * (1 - lam) / lam) for share in HARD_SHARES]
    return pairs


def significant_parts(values: Harmonics) -> list[Real]:
    """Real parts of even orders and imaginary parts of odd ones."""
    return [real if n % 2 == 0 else imag for n, (real, imag) in enumerate(values, start=1)]


def write_reference_table(path: Path = TABLE) -> None:
    """Compute the grid and store fifty digits of each coefficient, one row per slider-crank."""
    rows = ((lam, e, significant_parts(harmonics(lam, e))) for lam, e in grid())
    _write(path, range(1, MAX_ORDER + 1), rows)


def write_hard_table(path: Path = HARD_TABLE) -> None:
    """The same for the hard grid, orders up to 200; takes minutes."""
    _write(path, HARD_ORDERS, map(_hard_row, hard_grid()))


def _hard_row(pair: tuple[float, float]) -> tuple[float, float, list[Real]]:
    lam, e = pair
    # Samples of a turn grow without bound towards the crank that cannot turn, digits of the
    # recurrence towards the long rod.
    method = harmonics if _decay(lam, e) > 0.05 else harmonics_by_recurrence
    parts = significant_parts(method(lam, e, max(HARD_ORDERS)))
    return lam, e, [parts[order - 1] for order in HARD_ORDERS]


def _write(path: Path, orders: Iterable[int], rows: Iterable[tuple[float, float, Any]]) -> None:
    with path.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        names = [f"{'real' if n % 2 == 0 else 'imag'}_{n}" for n in orders]
        out.writerow(["rod_ratio", "offset_over_radius", *names])
        for lam, e, parts in rows:
            out.writerow([repr(lam), repr(e), *(mp.nstr(part, DIGITS) for part in parts)])


if __name__ == "__main__":
    write_reference_table()
    write_hard_table()
