"""The arrangement search once more, with numba: the best that could be written there.

As ``tests/rederivation/search.py``, but arrangements are made as they are needed, on all cores, and
never stored where only their number is asked. Threads share out compiled loops that let go of the
interpreter: as fast as numba's own ``parallel``, and compiled in a tenth of the time.
"""

# ruff: noqa: ANN001, ANN202 - numba finds the types of what it compiles

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise, permutations
from math import factorial
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray
from rederivation import search

Array = NDArray[np.float64]
IntArray = NDArray[np.integer[Any]]

compiled: Callable[..., Any] = numba.njit(error_model="numpy", nogil=True)
CORES = os.cpu_count() or 1
POOL = ThreadPoolExecutor(CORES)


def on_all_cores(loop: Callable[..., None], length: int, work: int, *arguments: object) -> None:
    """Run loop(start, stop, ...) over parts of a range, or over it all if there is little work."""
    if work < 1000:
        loop(0, length, *arguments)
        return
    ends = np.linspace(0, length, 4 * CORES + 1).astype(int).tolist()
    parts = pairwise(ends)
    list(POOL.map(lambda part: loop(*part, *arguments), parts))


@compiled
def pack(levers, forms, base):
    """|Z|^2 as one whole number."""
    n = len(levers)
    found = np.int64(0)
    correlations = np.empty((n + 1) // 2, np.int64)
    for k in range(len(correlations)):
        total = np.int64(0)
        for j in range(n - k):
            total += levers[j] * levers[j + k]
        for j in range(n - k, n):
            total += levers[j] * levers[j + k - n]
        correlations[k] = total
    for d in range(len(base)):
        found = found * base[d] + base[d] // 2
        for k in range(len(correlations)):
            found += forms[d, k] * correlations[k]
    return found


@compiled
def next_permutation(values):
    """Step to the next in lexicographic order, in place."""
    i = len(values) - 2
    while i >= 0 and values[i] > values[i + 1]:
        i -= 1
    if i < 0:
        return
    j = len(values) - 1
    while values[j] < values[i]:
        j -= 1
    values[i], values[j] = values[j], values[i]
    values[i + 1 :] = values[i + 1 :][::-1].copy()


@compiled
def generate(first, stop, starts, places, block, forms, base, keys, table):
    """Keys of all arrangements that begin with each start; their levers too if table has room."""
    for chunk in range(first, stop):
        n = starts.shape[1]
        levers = starts[chunk].copy()
        rest = np.sort(levers[places[chunk]])
        for i in range(block):
            for j in range(len(rest)):
                levers[places[chunk, j]] = rest[j]
            keys[chunk * block + i] = pack(levers, forms, base)
            if len(table):
                for k in range(n):
                    table[chunk * block + i, k] = levers[k]
            next_permutation(rest)


@functools.cache
def plan(throws: int) -> tuple[IntArray, IntArray, IntArray]:
    """Chunks of arrangements: levers with the last few to be permuted, their places, and weights.

    Central throw at phase 0, first and last at (p, q) as in ``search.banks``, and the next two
    throws at each pair of the phases left.
    """
    m = (throws - 1) // 2
    starts, places, weights = [], [], []
    inner = [s for s in range(1 - m, m) if s]
    for p, q in permutations(range(1, throws), 2):
        images = {(p, q), (q, p), (throws - p, throws - q), (throws - q, throws - p)}
        if (p, q) != min(images):
            continue
        free = [k for k in range(1, throws) if k not in (p, q)]
        for head in permutations(inner, 2) if len(inner) > 4 else [()]:
            levers = np.zeros(throws, dtype=np.int64)
            levers[p], levers[q] = m, -m
            levers[free] = [*head, *(s for s in inner if s not in head)]
            starts.append(levers)
            places.append(free[len(head) :])
            weights.append(throws * len(images))
    return np.array(starts), np.array(places), np.array(weights)


@compiled
def merge_count(one, other, light):
    """Sum of squares of class sizes from two sorted lists of keys; the last bit is the weight."""
    i = j = 0
    total, size, last = np.int64(0), np.int64(0), np.int64(-1)
    while i < len(one) or j < len(other):
        if j == len(other) or (i < len(one) and one[i] <= other[j]):
            key = one[i]
            i += 1
        else:
            key = other[j]
            j += 1
        if key >> 1 != last:
            total += size * size
            size, last = np.int64(0), key >> 1
        size += light << (key & 1)
    return total + size * size


def sort_halves(keys: IntArray) -> tuple[IntArray, IntArray]:
    """Sort both halves in place at once: NumPy lets go of the interpreter."""
    halves = keys[: len(keys) // 2], keys[len(keys) // 2 :]
    list(POOL.map(np.ndarray.sort, halves))
    return halves


def keys_of(throws: int, with_levers: bool = False) -> tuple[IntArray, IntArray, IntArray]:
    """Keys of the arrangements that stand for all, levers (or none), weight of each chunk."""
    starts, places, weights = plan(throws)
    block = factorial(places.shape[1])
    keys = np.empty(len(starts) * block, dtype=np.int64)
    table = np.empty((len(keys) if with_levers else 0, throws), dtype=np.int8)
    forms, base = search.key(throws)
    arguments_ = (starts, places, block, forms, base, keys, table)
    on_all_cores(generate, len(starts), len(keys), *arguments_)
    return keys, table, weights


def count(throws: int) -> int:
    """Ordered pairs of arrangements with equal |Z|."""
    keys, _, weights = keys_of(throws)
    light = 2 * throws
    by_chunk = keys.reshape(len(weights), -1)
    by_chunk *= 2
    by_chunk += (weights // light - 1)[:, np.newaxis]
    return int(merge_count(*sort_halves(keys), light))


# --- bank angles ----------------------------------------------------------------------------------


@compiled
def arguments(start, stop, table, cos, sin, found):
    """Arg Z of each row."""
    for i in range(start, stop):
        a = b = 0.0
        for k in range(table.shape[1]):
            a += cos[k] * table[i, k]
            b += sin[k] * table[i, k]
        found[i] = np.arctan2(b, a)


@compiled
def fold(order, keys, argument, step):
    """All pairs of a class: folded angle, a, b, and how it was folded."""
    n = len(order)
    pairs = 0
    first = 0
    for i in range(n):
        if keys[order[i]] != keys[order[first]]:
            first = i
        pairs += 2 * (i - first) + 1
    angles = np.empty(pairs)
    members = np.empty((pairs, 2), np.int32)
    how = np.empty((pairs, 3), np.int8)
    at = 0
    first = 0
    for i in range(n):
        if keys[order[i]] != keys[order[first]]:
            first = i
        b = order[i]
        for j in range(first, i + 1):
            a = order[j]
            for mirrored in range(0 if j < i else 1, 2):
                raw = argument[b] + (argument[a] if mirrored else -argument[a])
                turns = np.floor(raw / step)
                angle = raw - turns * step
                negated = angle > step / 2
                angles[at] = step - angle if negated else angle
                members[at, 0], members[at, 1] = a, b
                how[at, 0], how[at, 1], how[at, 2] = mirrored, np.int8(turns), negated
                at += 1
    return angles, members, how


@compiled
def product(table, members, how, found):
    """Coefficients of Z_b conj(Z_a), folded as the angle was: see ``search.products``."""
    n = table.shape[1]
    a, b = members
    mirrored, turns, negated = how
    odd = turns % 2
    shift = (turns + n * odd) // 2
    for k in range(n):
        total = 0
        for j in range(n):
            lever = table[a, (n - j) % n] if mirrored else table[a, j]
            total += table[b, (j + k) % n] * lever
        place = (k - shift) % n
        sign = -1 if odd else 1
        if negated:
            place = ((n + 1) // 2 - place) % n
            sign = -sign
        found[place] = sign * total


@compiled
def differ(start, stop, angles, order, members, how, table, reduce, near, found):
    """Whether each angle differs from the one before; decided in whole numbers where near."""
    n = table.shape[1]
    difference, moment = np.empty(n, np.int64), np.empty(n, np.int64)
    square = np.empty(n, np.int64)
    for i in range(max(start, 1), stop):
        if angles[order[i]] - angles[order[i - 1]] >= near:
            continue
        one, other = order[i - 1], order[i]
        difference[:] = 0
        for side in range(2):
            mine, theirs = (one, other) if side else (other, one)
            product(table, members[mine], how[mine], moment)
            row = table[members[theirs, 0]]
            for k in range(n):
                total = 0
                for j in range(n):
                    total += row[(j + k) % n] * row[j]
                square[k] = total
            for k in range(n):
                total = 0
                for j in range(n):
                    total += moment[(j + k) % n] * square[j]
                difference[k] += total if side else -total
        same = True
        for d in range(len(reduce)):
            total = 0
            for k in range(n):
                total += reduce[d, k] * difference[k]
            same = same and total == 0
        found[i] = not same


@compiled
def spread(start, stop, half, mirror, step, found):
    """Repeat folded angles and their mirror images on some steps of pi/n."""
    run = len(half) + mirror - 1
    for turn in range(start, stop):
        for k in range(len(half)):
            found[turn * run + k] = half[k] + step * turn
        for k in range(1, mirror):
            found[turn * run + run - k] = step * (turn + 1) - half[k]


def angles(throws: int, given: IntArray | None = None) -> Array:
    """All |alpha| in [0, pi], ascending; of the given arrangements (rows of levers) or of all."""
    if given is None:
        keys, table, _ = keys_of(throws, with_levers=True)
    else:
        table = given
        keys = table_keys(table, *search.key(throws))
    phases, step = 2 * np.pi * np.arange(throws) / throws, np.pi / throws
    argument = np.empty(len(table))
    on_all_cores(arguments, len(table), len(table), table, np.cos(phases), np.sin(phases), argument)
    folded, members, how = fold(np.argsort(keys), keys, argument, step)
    order = np.argsort(folded)
    new = np.ones(len(order), dtype=bool)
    reduce = search.remainders(throws)
    compared = (folded, order, members, how, table, reduce, 1e-9, new)
    on_all_cores(differ, len(order), len(order), *compared)
    half = folded[order[new]]
    half[0] = 0.0
    mirror = len(half) - int(half[-1] >= step / 2 * (1 - 1e-12))
    found = np.empty(throws * (len(half) + mirror - 1) + 1)
    on_all_cores(spread, throws, len(found) // 100, half, mirror, step, found)
    found[-1] = np.pi
    return found


@compiled
def table_keys(table, forms, base):
    """Keys of given arrangements."""
    found = np.empty(len(table), np.int64)
    for i in range(len(table)):
        found[i] = pack(table[i].astype(np.int64), forms, base)
    return found


def count_given(throws: int, given: IntArray, weight: int) -> int:
    """Pairs among given arrangements, each standing for so many."""
    keys = np.sort(table_keys(given, *search.key(throws)))
    return int(merge_count(2 * keys, keys[:0], weight))
