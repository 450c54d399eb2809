"""How many pairs of bank arrangements have the same first-order moment, and at which bank angles?

Ito and Hattori's question for any odd number of throws n, one at each n-th of a turn, levers
m ... -m, m = (n - 1)/2, in whole numbers with NumPy. With Z = sum s zeta^k over the phases k,
zeta = exp(2 pi i/n), |Z|^2 = sum c_k zeta^k, c the cyclic autocorrelation of the levers by phase.
Two such sums are equal if and only if they leave the same remainder modulo the cyclotomic
polynomial of n. Turning (n), mirroring and exchanging front and rear leave |Z| alone, so that one
arrangement in 4n will do.

Arrays of levers and correlations are (n or fewer, arrangements), so that sums run over long rows.
"""

from __future__ import annotations

import functools
from itertools import permutations
from typing import NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.integer]
WHOLE = np.int32  # all sums below fit: 13 throws have c_k to 182, products of two to 13 * 182^2


class Banks(NamedTuple):
    """Arrangements that stand for all others, and for how many each of them does."""

    levers: IntArray
    """Lever of the throw at each phase, (n, arrangements)."""
    multiplicity: IntArray
    """(arrangements,)."""


def banks(throws: int) -> Banks:
    """All arrangements of so many throws.

    Turned until the central throw has phase 0. The first and the last throw then have phases p and
    q; mirror and exchange carry (p, q) to (-p, -q) and (q, p): one of each such set is taken.
    """
    m = (throws - 1) // 2
    inner = np.array(list(permutations([s for s in range(1 - m, m) if s])), dtype=WHOLE).T
    blocks, multiplicity = [], []
    for p, q in permutations(range(1, throws), 2):
        images = {(p, q), (q, p), (throws - p, throws - q), (throws - q, throws - p)}
        if (p, q) == min(images):
            block = np.zeros((throws, inner.shape[1]), dtype=WHOLE)
            block[p], block[q] = m, -m
            block[[k for k in range(1, throws) if k not in (p, q)]] = inner
            blocks.append(block)
            multiplicity.append(np.full(inner.shape[1], throws * len(images)))
    return Banks(np.concatenate(blocks, axis=1), np.concatenate(multiplicity))


def cyclotomic(n: int) -> IntArray:
    """Coefficients of the n-th cyclotomic polynomial, the constant first."""
    found = np.array([-1.0] + [0.0] * (n - 1) + [1.0])
    for d in range(1, n):
        if n % d == 0:
            found, _ = np.polynomial.polynomial.polydiv(found, cyclotomic(d))
    return np.round(found).astype(np.int64)


@functools.cache
def remainders(n: int) -> IntArray:
    """Column k: the remainder of x^k modulo the n-th cyclotomic polynomial, (degree, n)."""
    lower = -cyclotomic(n)[:-1]
    columns = [np.eye(len(lower), dtype=np.int64)[0]]
    for _ in range(n - 1):
        last = columns[-1]
        columns.append(np.concatenate([[0], last[:-1]]) + last[-1] * lower)
    return np.stack(columns, axis=1)


def correlation(one: IntArray, other: IntArray) -> IntArray:
    """Coefficients of Z_one conj(Z_other): sum over j of one_{j + k} other_j, (n, arrangements)."""
    return _shifted_products(one, other, range(len(one)))


def autocorrelation(levers: IntArray) -> IntArray:
    """c_0 ... c_m of |Z|^2 = c_0 + sum c_k (zeta^k + zeta^-k), (m + 1, arrangements)."""
    return _shifted_products(levers, levers, range((len(levers) + 1) // 2))


def _shifted_products(one: IntArray, other: IntArray, shifts: range) -> IntArray:
    found = np.zeros((len(shifts), one.shape[1]), dtype=one.dtype)
    buffer = np.empty(one.shape[1], dtype=one.dtype)
    for k in shifts:
        for j, lever in enumerate(other):
            found[k] += np.multiply(one[(j + k) % len(one)], lever, out=buffer)
    return found


class Key(NamedTuple):
    """|Z|^2 of n throws as one whole number: digits, each a combination of c_0 ... c_m."""

    forms: IntArray
    """(digits, m + 1)."""
    base: IntArray
    """Each digit is within +-(base - 1)/2, (digits,)."""


@functools.cache
def key(throws: int) -> Key:
    """Which digits there must be: remainders of |Z|^2 on which the others depend linearly."""
    m = (throws - 1) // 2
    columns = remainders(throws)
    folded = columns[:, : m + 1].copy()
    folded[:, 1:] += columns[:, :m:-1]
    chosen: list[int] = []
    for row in range(len(folded)):
        if np.linalg.matrix_rank(folded[[*chosen, row]]) > len(chosen):
            chosen.append(row)
    forms = folded[chosen]
    largest = m * (m + 1) * (2 * m + 1) // 3  # c_0; no other c_k is larger
    return Key(forms, 2 * largest * np.abs(forms).sum(axis=1) + 1)


def magnitude_keys(levers: IntArray) -> IntArray:
    """|Z|^2 exactly as one integer an arrangement: equal if and only if |Z| is."""
    forms, base = key(len(levers))
    correlations = autocorrelation(levers)
    keys = np.zeros(levers.shape[1], dtype=np.int64)
    for form, size in zip(forms, base, strict=True):
        keys *= size
        keys += size // 2
        for factor, row in zip(form, correlations, strict=True):
            if factor:
                keys += factor * row
    return keys


def qualifying(keys: IntArray, multiplicity: IntArray) -> int:
    """Ordered pairs of arrangements with the same |Z|, a bank with itself included."""
    order = np.argsort(keys)
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    sizes = np.add.reduceat(multiplicity[order], first)
    return int(sizes @ sizes)


def moments(levers: IntArray, order: int = 1) -> NDArray[np.complex128]:
    """Z, (arrangements,)."""
    n = len(levers)
    return np.asarray(np.exp(2j * np.pi * order * np.arange(n) / n) @ levers)


# --- how close two classes come -------------------------------------------------------------------


class Gap(NamedTuple):
    """The least distance of two different magnitudes."""

    of_2z: float
    """Of |2Z|: 2Z is a whole combination of powers of zeta for even numbers of throws too."""
    of_squares: float
    """Of |Z|^2."""


def smallest_gap(distinct_keys: IntArray, throws: int) -> Gap:
    """To full accuracy: neighbours in double precision, the closest of them again at 50 digits."""
    forms, base = key(throws)
    with mpmath.workdps(50):
        cosines = [mpmath.mpf(1)]
        cosines += [2 * mpmath.cos(2 * mpmath.pi * k / throws) for k in range(1, forms.shape[1])]
        # |Z|^2 = cosines . c and is a combination of the digits: its factors
        system = mpmath.matrix(forms.T.tolist())
        factors = mpmath.lu_solve(system, mpmath.matrix(cosines))
        rest, squares = distinct_keys.copy(), np.zeros(len(distinct_keys))
        for k in range(len(base))[::-1]:
            squares += float(factors[k]) * (rest % base[k] - base[k] // 2)
            rest //= base[k]
        order = np.argsort(squares)
        apart = np.diff(squares[order])
        closest = np.argpartition(apart, min(200, len(apart) - 1))[:200]
        found = []
        for k in closest:
            exact = []
            for place in (order[k], order[k + 1]):
                digits, left = [], int(distinct_keys[place])
                for size in base[::-1].tolist():
                    left, digit = divmod(left, size)
                    digits.append(digit - size // 2)
                exact.append(mpmath.fdot(factors, digits[::-1]))
            of_squares = abs(exact[0] - exact[1])
            of_2z = 2 * of_squares / (mpmath.sqrt(exact[0]) + mpmath.sqrt(exact[1]))
            found.append(Gap(float(of_2z), float(of_squares)))
        return Gap(min(g.of_2z for g in found), min(g.of_squares for g in found))


def rounding(banks_: Banks, keys: IntArray, dtype: type = np.float64) -> float:
    """How far apart floating point puts magnitudes |2Z| that are equal, at most.

    Computed as 2 sqrt(a^2 + b^2), added up by phase, for each arrangement as it is, turned by one
    phase and mirrored.
    """
    levers = banks_.levers
    n = len(levers)
    angles = 2 * np.pi * np.arange(n) / n
    cos: Array = np.cos(angles).astype(dtype)
    sin: Array = np.sin(angles).astype(dtype)
    order = np.argsort(keys)
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    highest, lowest = np.full(len(first), -np.inf), np.full(len(first), np.inf)
    for image in (np.arange(n), np.arange(n) - 1, -np.arange(n) % n):
        a: Array = np.zeros(len(keys), dtype=dtype)
        b: Array = np.zeros(len(keys), dtype=dtype)
        for k in range(n):
            lever = levers[image[k]].astype(dtype)
            a += cos[k] * lever
            b += sin[k] * lever
        size = (dtype(2) * np.sqrt(a * a + b * b))[order].astype(np.float64)
        highest = np.maximum(highest, np.maximum.reduceat(size, first))
        lowest = np.minimum(lowest, np.minimum.reduceat(size, first))
    return float((highest - lowest).max())


# --- bank angles ----------------------------------------------------------------------------------


class Folded(NamedTuple):
    """Bank angles up to symmetry, ascending, with the moments Z_b conj(Z_a) or Z_b Z_a behind them.

    An angle comes with all +-alpha + pi j/n, as arrangements can be turned, mirrored, exchanged.
    """

    angles: Array
    """In [0, pi/2n], radians, (pairs,)."""
    first: IntArray
    """a, (pairs,)."""
    second: IntArray
    """b, (pairs,)."""
    mirrored: IntArray
    """1 if a counts mirrored, (pairs,)."""
    turns: IntArray
    """Steps of pi/n taken away, (pairs,)."""
    negated: IntArray
    """1 if the sign was changed after that, one step added, (pairs,)."""


def folded_angles(levers: IntArray, keys: IntArray) -> Folded:
    """All angles between arrangements of equal |Z|, folded; each pair of arrangements once."""
    n = len(levers)
    order = np.argsort(keys)
    ordered, argument = keys[order], np.angle(moments(levers))
    found = []
    for distance in range(len(keys)):
        same = np.flatnonzero(ordered[distance:] == ordered[: len(keys) - distance])
        if not len(same):
            break
        a, b = order[same], order[same + distance]
        found.append((argument[b] + argument[a], a, b, np.ones(len(a), np.int64)))
        if distance:
            found.append((argument[b] - argument[a], a, b, np.zeros(len(a), np.int64)))
    raw, first, second, mirrored = (np.concatenate(part) for part in zip(*found, strict=True))
    step = np.pi / n
    turns = np.floor(raw / step).astype(np.int64)
    angles = raw - turns * step
    negated = (angles > step / 2).astype(np.int64)
    angles = np.where(negated, step - angles, angles)
    by_angle = np.argsort(angles)
    pairs = (first, second, mirrored, turns, negated)
    return Folded(angles[by_angle], *(column[by_angle] for column in pairs))


def products(levers: IntArray, folded: Folded, which: IntArray) -> IntArray:
    """Whole coefficients of Z_b conj(Z_a), folded as the angle was, (n, pairs)."""
    n = len(levers)
    a, b = levers[:, folded.first[which]], levers[:, folded.second[which]]
    # The mirrored arrangement has its levers at -k: conj(Z).
    a = np.where(folded.mirrored[which] == 1, a[-np.arange(n) % n], a)
    product = correlation(b, a)
    # exp(-i pi j/n) is zeta^(-j/2), or -zeta^(-(j + n)/2) for odd j.
    turns, negated = folded.turns[which], folded.negated[which]
    odd = turns % 2
    shift = (turns + n * odd) // 2
    place = np.arange(n)[:, np.newaxis]
    product = np.take_along_axis(product, (place + shift) % n, axis=0) * (1 - 2 * odd)
    # conj, times exp(i pi/n) = -zeta^((1 + n)/2)
    other = -np.take_along_axis(product, ((n + 1) // 2 - place) % n, axis=0)
    return np.where(negated == 1, other, product)


def distinct(levers: IntArray, folded: Folded, near: float = 1e-9) -> NDArray[np.bool_]:
    """Which folded angles differ from the one before: decided in whole numbers where near.

    The angle is that of P, P conj(P) = K^2, K = |Z|^2: two are equal if P K' = P' K.
    """
    n = len(levers)
    different = np.ones(len(folded.angles), dtype=bool)
    close = np.flatnonzero(np.diff(folded.angles) < near)
    one, other = close, close + 1
    sides = []
    for mine, theirs in ((one, other), (other, one)):
        square = levers[:, folded.first[theirs]]
        square = correlation(square, square)
        product = products(levers, folded, mine)
        # K is real: correlating with it is multiplying by it
        sides.append(remainders(n) @ correlation(product, square))
    different[other] = (sides[0] != sides[1]).any(axis=0)
    return different


def bank_angles(levers: IntArray, keys: IntArray) -> Array:
    """All |alpha| in [0, pi], ascending, radians: those folded, mirrored, and steps of pi/n on."""
    n = len(levers)
    folded = folded_angles(levers, keys)
    half = folded.angles[distinct(levers, folded)]
    step = np.pi / n
    # 0 is among them for any n, pi/2n may be: these two are their own mirror images.
    half[0] = 0.0
    mirror = (step - half[half < step / 2 * (1 - 1e-12)])[::-1]
    run = np.concatenate([half, mirror[:-1]])
    return np.append((run + step * np.arange(n)[:, np.newaxis]).ravel(), np.pi)
