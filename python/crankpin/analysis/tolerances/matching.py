"""Search of assignments: which measured part goes where.

Parts stand in rows of deviations, places in influence vectors: with part ``chosen[j]`` in place j
what remains is ``start + Σⱼ influences[j] · parts[chosen[j]]``, and its length is minimised.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Places = NDArray[np.intp]
    Report = Callable[[int, int], object] | None

MOST_ARRANGEMENTS = 2_000_000_000
"""Arrangements up to which all are compared: those of 12 parts, or of 8 pistons and rods, take
seconds, because halves of an engine are compared in one product of matrices."""
PAIRS = 2_000_000
"""Pairs of halves compared at a time."""
STARTS = 24
"""Random starts of the search by exchanges."""
ROUNDING = 1e-12
"""Part of the largest square that sums of products may be off; closer pairs are evaluated again."""


class Kind(NamedTuple):
    """Parts of one kind, such as pistons or rods."""

    parts: Array
    """Deviations of each part: (n_parts, n_figures)."""
    influences: Array
    """What a unit of each figure adds in each place: (n_places, n_figures, n_dimensions)."""

    def sums(self, places: Places, chosen: Places) -> Array:
        """Return what arrangements (n, n_places) in some places add: (n, n_dimensions)."""
        added = np.einsum("njf,jfd->nd", self.parts[chosen], self.influences[places])
        return np.asarray(added)


class Found(NamedTuple):
    """An assignment."""

    chosen: tuple[Places, ...]
    """For each kind the part in each place."""
    value: float
    """Length of what remains."""
    exact: bool
    """True if all arrangements were compared."""


def arrangements(kinds: tuple[Kind, ...]) -> int:
    """Return the number of ways to fill all places."""
    return math.prod(math.perm(len(kind.parts), len(kind.influences)) for kind in kinds)


def remains(start: Array, kinds: tuple[Kind, ...], chosen: tuple[Places, ...]) -> float:
    """Return the length of what remains."""
    places = np.arange(len(kinds[0].influences))
    added = [kind.sums(places, each[None])[0] for kind, each in zip(kinds, chosen, strict=True)]
    return float(np.linalg.norm(start + sum(added)))


def best(start: Array, kinds: tuple[Kind, ...], *, seed: int = 0, report: Report = None) -> Found:
    """Return the best assignment: of all where there are few enough, else found by exchanges.

    ``report`` is told the steps done and the steps in all.
    """
    start, kinds = _reduced(start, kinds)
    if arrangements(kinds) <= MOST_ARRANGEMENTS:
        return _of_all(start, kinds, report)
    return _by_exchanges(start, kinds, seed, report)


def lower_bound(start: Array, kinds: tuple[Kind, ...]) -> float:
    """Return a length below which no assignment comes.

    Along each of some orthogonal directions what the parts add lies between two sums: of each kind
    and figure by itself the largest influences take the smallest or the largest deviations
    (rearrangement inequality). What ``start`` has beyond them stays; the squares of orthogonal
    directions add up.
    """
    start, kinds = _reduced(start, kinds)
    low, high = start.copy(), start.copy()
    for kind in kinds:
        for figure in range(kind.parts.shape[1]):
            deviations = np.sort(kind.parts[:, figure])
            # (n_dimensions, n_places)
            falling = -np.sort(-kind.influences[:, figure], axis=0).T
            count = falling.shape[1]
            # Positive influences take parts from one end, negative ones from the other.
            from_below, from_above = deviations[:count], deviations[::-1][:count]
            up, down = np.maximum(falling, 0.0), np.minimum(falling, 0.0)[:, ::-1]
            low += up @ from_below + down @ from_above
            high += up @ from_above + down @ from_below
    beyond = np.maximum(np.maximum(low, -high), 0.0)
    return float(np.linalg.norm(beyond))


def _reduced(start: Array, kinds: tuple[Kind, ...]) -> tuple[Array, tuple[Kind, ...]]:
    """Return the same lengths in as few dimensions as the influences span, and one for the rest."""
    dimensions = len(start)
    stacked = np.concatenate([kind.influences.reshape(-1, dimensions) for kind in kinds])
    _, sizes, axes = np.linalg.svd(stacked, full_matrices=False)
    axes = axes[sizes > 1e-13 * sizes.max(initial=0.0)]
    rest = start
    for _ in range(2):
        # Twice: what rounding left of the first projection is not orthogonal.
        rest = rest - axes.T @ (axes @ rest)
    length = np.linalg.norm(rest)
    if length > 1e-13 * np.linalg.norm(start):
        axes = np.vstack([axes, rest / length])
    return axes @ start, tuple(kind._replace(influences=kind.influences @ axes.T) for kind in kinds)


# --- all arrangements ---------------------------------------------------------------------------


def _of_all(start: Array, kinds: tuple[Kind, ...], report: Report) -> Found:
    """Compare all arrangements: those of the first half of the places with those of the second.

    For every choice of the parts of each half, |start + a + b|² of all pairs is one product of
    matrices. Pairs within rounding of the least are evaluated again, term by term.
    """
    places = np.arange(len(kinds[0].influences))
    first, second = places[: len(places) // 2], places[len(places) // 2 :]
    best: tuple[float, tuple[Places, ...]] = (np.inf, ())
    choices = list(_choices([range(len(kind.parts)) for kind in kinds], len(first)))
    for done, ours in enumerate(choices, start=1):
        left = [
            sorted(set(range(len(kind.parts))) - set(taken))
            for kind, taken in zip(kinds, ours, strict=True)
        ]
        a_chosen, a = _arranged(kinds, first, ours)
        a = a + start
        for theirs in _choices(left, len(second)):
            b_chosen, b = _arranged(kinds, second, theirs)
            for row, column in _closest(a, b, best[0]):
                value = float(np.linalg.norm(a[row] + b[column]))
                if value < best[0]:
                    chosen = tuple(
                        np.concatenate([of_a[row], of_b[column]])
                        for of_a, of_b in zip(a_chosen, b_chosen, strict=True)
                    )
                    best = (value, chosen)
        if report:
            report(done, len(choices))
    return Found(best[1], remains(start, kinds, best[1]), exact=True)


def _choices(
    parts: list[range] | list[list[int]], count: int
) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Yield the sets of so many parts of every kind."""
    return itertools.product(*(itertools.combinations(each, count) for each in parts))


def _arranged(
    kinds: tuple[Kind, ...], places: Places, parts: tuple[tuple[int, ...], ...]
) -> tuple[list[Places], Array]:
    """Return all arrangements of these parts in some places, and what they add."""
    orders = np.array(list(itertools.permutations(range(len(places)))), dtype=np.intp)
    orders = orders.reshape(-1, len(places))
    chosen = [np.array(each, dtype=np.intp)[orders] for each in parts]
    sums = [kind.sums(places, each) for kind, each in zip(kinds, chosen, strict=True)]
    if len(kinds) == 1:
        return chosen, sums[0]
    one, other = (each.ravel() for each in np.indices((len(orders), len(orders))))
    return [chosen[0][one], chosen[1][other]], sums[0][one] + sums[1][other]


def _closest(a: Array, b: Array, known: float) -> list[tuple[int, int]]:
    """Return pairs of rows whose sum is shortest, and may be shorter than what is known.

    All pairs within rounding of the shortest are returned.
    """
    of_b = np.concatenate([2.0 * b, np.ones((len(b), 1)), (b * b).sum(axis=1)[:, None]], axis=1)
    found: list[tuple[int, int]] = []
    step = max(1, PAIRS // len(b))
    of_each = (a * a).sum(axis=1)
    rounding = ROUNDING * float(of_each.max() + of_b[:, -1].max())
    least = known * known
    for begin in range(0, len(a), step):
        rows = slice(begin, begin + step)
        part = np.column_stack([a[rows], of_each[rows], np.ones(len(a[rows]))])
        squares = part @ of_b.T
        if (lowest := float(squares.min())) > least + rounding:
            continue
        least = min(least, lowest)
        near = np.argwhere(squares <= lowest + rounding)
        found += [(begin + i, j) for i, j in near.tolist()]
    return found


# --- exchanges ----------------------------------------------------------------------------------


def _by_exchanges(start: Array, kinds: tuple[Kind, ...], seed: int, report: Report = None) -> Found:
    """Exchange two parts, or a part and an unused one, while that is better; several starts."""
    random = np.random.default_rng(seed)
    count = len(kinds[0].influences)
    best: tuple[float, tuple[Places, ...]] = (np.inf, ())
    for done in range(1, STARTS + 1):
        orders = [random.permutation(len(kind.parts)) for kind in kinds]
        value = np.inf
        while True:
            chosen = tuple(order[:count] for order in orders)
            now = start + sum(
                kind.sums(np.arange(count), each[None])[0]
                for kind, each in zip(kinds, chosen, strict=True)
            )
            steps = [_exchange(now, kind, order) for kind, order in zip(kinds, orders, strict=True)]
            which = int(np.argmin([length for length, _, _ in steps]))
            length, i, j = steps[which]
            value = float(np.linalg.norm(now))
            if not length < value * (1.0 - 1e-12):
                break
            orders[which][[i, j]] = orders[which][[j, i]]
        if value < best[0]:
            best = (value, tuple(each.copy() for each in chosen))
        if report:
            report(done, STARTS)
    return Found(best[1], best[0], exact=False)


def _exchange(now: Array, kind: Kind, order: Places) -> tuple[float, int, int]:
    """Return the least length after an exchange of two parts, and their places in the order."""
    count, total = len(kind.influences), len(order)
    influences = np.zeros((total, *kind.influences.shape[1:]))
    influences[:count] = kind.influences
    i, j = np.triu_indices(total, 1)
    used = i < count
    i, j = i[used], j[used]
    difference = kind.parts[order[j]] - kind.parts[order[i]]
    change = np.einsum("nf,nfd->nd", difference, influences[i] - influences[j])
    lengths = np.linalg.norm(now + change, axis=1)
    if not lengths.size:
        return np.inf, 0, 0
    least = int(np.argmin(lengths))
    return float(lengths[least]), int(i[least]), int(j[least])


# --- sets of equal masses -----------------------------------------------------------------------


def windows(masses: Array, size: int, sets: int) -> list[Places]:
    """Return sets of equally many parts whose ranges have the least sum; the rest stays unused.

    Exact. Of sorted parts that are all used, a gap between neighbours with m parts below it, m no
    multiple of ``size``, is straddled by at least one set, because no sets consist of m parts;
    sorted sets straddle each of these gaps once and no other. The sum of ranges is the sum of the
    gaps straddled. An unused part within the range of a set may replace one of its ends without
    widening it. So the sets are windows of neighbours, and dynamic programming finds the best.

    Where all parts are used, sorted sets have the least largest range too: the first
    (t − 1)·size + 1 parts lie in at least t sets, which reach the (t·size)-th part; so that one of
    them has at least the range of the t-th sorted set.
    """
    order = np.argsort(masses, kind="stable")
    ranges = masses[order][size - 1 :] - masses[order][: len(masses) - size + 1]
    # least[t][m]: least sum of t sets of the first m parts.
    least = np.full((sets + 1, len(masses) + 1), np.inf)
    least[0] = 0.0
    taken = np.zeros(least.shape, dtype=bool)
    for t in range(1, sets + 1):
        for m in range(t * size, len(masses) + 1):
            with_last = least[t - 1, m - size] + ranges[m - size]
            taken[t, m] = with_last < least[t, m - 1]
            least[t, m] = min(with_last, least[t, m - 1])
    found, m = [], len(masses)
    for t in range(sets, 0, -1):
        while not taken[t, m]:
            m -= 1
        found.append(order[m - size : m])
        m -= size
    return found[::-1]
