"""Objectives of phasors, smoothed for an optimiser, and their weighted sum.

Each objective is the largest of some sums of lengths of vectors that are real-linear in the
phasors. A length is not smooth at zero, nor a largest value where two are equal: with μ > 0 they
are replaced by √(u² + μ²) and μ·ln Σ exp(h/μ), which are, and tend to them with μ.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from crankpin.analysis.design.phasors import Row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin.analysis.design.phasors import Phasors
    from crankpin.analysis.ranking.objectives import Objective

    Complex = NDArray[np.complex128]
    Real = NDArray[np.float64]

LATER = 1e-3
"""Weight of each objective relative to the one before it.

A length that can vanish stays at zero under weights this small: its slope there is 1.
"""
SAMPLES = 12
"""Crank angles for each order at which peaks are looked for, in a turn of the highest order."""
NOTHING = 1e-9
"""Part of what phasors could add up to below which no peaks are looked for."""
ROUNDS = 5
"""Refinements of a peak's crank angle, each eight times as fine."""


class Term(Protocol):
    """An objective as a function of phasors."""

    def vectors(self, phasors: Complex) -> tuple[Complex, Complex]:
        """Return the matrices A, B whose A·P + B·conj(P) are the vectors.

        Of shape (n_sums, n_in_a_sum, n_rows); they may depend on the phasors P where a change of
        theirs does not matter to first order.
        """

    def sampled(self, phasors: Complex) -> Real:
        """Return the values at many phasors: (n, n_rows) → (n,)."""


class Lengths:
    """Largest of some sums of lengths."""

    def __init__(self, a: Complex, b: Complex) -> None:
        self._a, self._b = a, b

    def vectors(self, phasors: Complex) -> tuple[Complex, Complex]:
        """Return the matrices, which are the same for all phasors."""
        return self._a, self._b

    def sampled(self, phasors: Complex) -> Real:
        """Return the values, exact."""
        vectors = np.tensordot(phasors, self._a, axes=(1, 2))
        vectors = vectors + np.tensordot(phasors.conj(), self._b, axes=(1, 2))
        return np.asarray(np.abs(vectors).sum(axis=2).max(axis=1))


class Peaks:
    """Longest vector over crank angle of a sum of orders."""

    def __init__(
        self, rows: Sequence[Row], which: Sequence[int], projections: Sequence[complex]
    ) -> None:
        self._rows, self._which = len(rows), list(which)
        # Each row turns with the crank or against it.
        turning = [rows[k].order * (-1 if rows[k].part == "backward" else 1) for k in which]
        self._speeds = np.array(turning, dtype=np.float64)
        # 0 for a vector's length, else the directions along which it is measured.
        self._projections = np.array(projections)
        highest = int(np.abs(self._speeds).max(initial=1.0))
        self._theta: Real = np.linspace(0.0, 2.0 * np.pi, SAMPLES * highest, endpoint=False)

    def vectors(self, phasors: Complex) -> tuple[Complex, Complex]:
        """Return the matrices at the crank angles of the peaks."""
        forms = [self._peaks(phasors, projection) for projection in self._projections]
        return np.concatenate([a for a, _ in forms]), np.concatenate([b for _, b in forms])

    def sampled(self, phasors: Complex) -> Real:
        """Return the largest at some crank angles."""
        vectors = np.tensordot(phasors[:, self._which], self._turning(self._theta), axes=(1, 1))
        if not self._projections[0]:
            return np.asarray(np.abs(vectors).max(axis=1))
        along = np.abs(np.real(vectors[..., np.newaxis] * self._projections))
        return np.asarray(along.max(axis=(1, 2)))

    def _turning(self, theta: Real) -> Complex:
        return np.asarray(np.exp(1j * np.multiply.outer(theta, self._speeds)))

    def _forms(self, theta: Real, projection: complex) -> tuple[Complex, Complex]:
        turning = np.zeros((theta.size, self._rows), dtype=np.complex128)
        turning[:, self._which] = self._turning(theta)
        if not projection:
            return turning, np.zeros_like(turning)
        return 0.5 * projection * turning, 0.5 * (projection * turning).conj()

    def _peaks(self, phasors: Complex, projection: complex) -> tuple[Complex, Complex]:
        def heights(theta: Real) -> Real:
            vectors = (self._turning(theta) * kept).sum(axis=-1)
            return np.asarray(np.abs((projection * vectors).real if projection else vectors))

        kept = phasors[self._which]
        coarse = heights(self._theta)
        highest = (coarse >= np.roll(coarse, 1)) & (coarse > np.roll(coarse, -1))
        # Of what vanishes at all angles rounding has many peaks.
        highest &= coarse > NOTHING * np.abs(kept).sum()
        theta = self._theta[highest] if highest.any() else self._theta[:1]
        step = self._theta[1]
        for _ in range(ROUNDS):
            before, at, after = heights(theta + step * np.array([[-1.0], [0.0], [1.0]]))
            curvature = before - 2.0 * at + after
            moved = np.divide(
                0.5 * (before - after), curvature, out=np.zeros_like(at), where=curvature < 0.0
            )
            theta = theta + step * np.clip(moved, -1.0, 1.0)
            step /= 8.0
        a, b = self._forms(theta, projection)
        return a[:, np.newaxis], b[:, np.newaxis]


def rows_of(objectives: Sequence[Objective], orders: Sequence[int]) -> list[Row]:
    """Return the phasors that objectives read; of a total those of these orders."""
    found: dict[Row, None] = {}
    for objective in objectives:
        plane = objective.quantity in ("force", "moment")
        for order in orders if objective.order is None else (objective.order,):
            for part in ("forward", "backward") if plane else ("",):
                found.setdefault(Row(objective.quantity, part, order))
    return list(found)


def term(objective: Objective, rows: Sequence[Row]) -> Term:
    """Return an objective as a function of phasors."""
    which = [
        k
        for k, row in enumerate(rows)
        if row.quantity == objective.quantity and objective.order in (None, row.order)
    ]
    if objective.order is None:
        plane = objective.quantity in ("force", "moment")
        along = {"peak_xy": (1.0, -1.0j)}.get(objective.what, (0.0,) if plane else (1.0,))
        return Peaks(rows, which, along)
    units = np.eye(len(rows), dtype=np.complex128)[which]
    if objective.what == "peak_xy":
        # Along x forward + conj(backward), along y forward − conj(backward).
        forward, backward = units
        return Lengths(np.array([[forward], [forward]]), np.array([[backward], [-backward]]))
    if objective.what in ("forward", "backward"):
        units = units[[int(objective.what == "backward")]]
    return Lengths(units[np.newaxis], np.zeros_like(units)[np.newaxis])


class Merit:
    """Objectives over what they could be at most, the later ones with small weights."""

    def __init__(self, phasors: Phasors, terms: Sequence[Term]) -> None:
        self._phasors, self._terms = phasors, terms
        at_most = phasors.sizes.astype(np.complex128)[np.newaxis]
        self.scales = np.array([float(term.sampled(at_most)[0]) or 1.0 for term in terms])
        """Largest value that each objective could have, in its unit."""
        steepest = phasors.steepest.astype(np.complex128)[np.newaxis]
        slopes = np.array([float(term.sampled(steepest)[0]) for term in terms]) / self.scales
        self.steepest = self.of(slopes)
        """Upper bound on what the merit changes by per radian of a variable."""

    def of(self, values: Real) -> float:
        """Return the weighted sum of objectives over their scales."""
        return float(values @ LATER ** np.arange(len(values)))

    def sampled(self, variables: Real) -> Real:
        """Return the merit at some values of the variables: (n, n_variables) → (n,)."""
        phasors = self._phasors.values(variables)
        values = [each.sampled(phasors) for each in self._terms]
        return np.asarray((np.transpose(values) / self.scales) @ LATER ** np.arange(len(values)))

    def values(self, variables: Real) -> Real:
        """Return each objective over its scale: (n_objectives,)."""
        phasors, _ = self._phasors.with_slopes(variables)
        found = []
        for each, scale in zip(self._terms, self.scales, strict=True):
            a, b = each.vectors(phasors)
            found.append(np.abs(_vectors(a, b, phasors)).sum(axis=1).max() / scale)
        return np.array(found)

    def smoothed(self, variables: Real, mu: float, objectives: int) -> tuple[float, Real]:
        """Return the smoothed merit of the first few objectives, and its gradient per radian."""
        phasors, slopes = self._phasors.with_slopes(variables)
        value, gradient = 0.0, np.zeros(len(variables))
        for k, each in enumerate(self._terms[:objectives]):
            a, b = (matrix / self.scales[k] for matrix in each.vectors(phasors))
            vectors = _vectors(a, b, phasors)
            lengths = np.sqrt(np.abs(vectors) ** 2 + mu**2)
            sums = lengths.sum(axis=1)
            shares = np.exp((sums - sums.max()) / mu)
            value += LATER**k * float(sums.max() + mu * np.log(shares.sum()))
            shares /= shares.sum()
            directions = vectors.conj() / lengths
            of_each = np.real(directions[..., np.newaxis] * _vectors(a, b, slopes))
            gradient += LATER**k * np.einsum("g,gmv->v", shares, of_each)
        return value, gradient


def _vectors(a: Complex, b: Complex, phasors: Complex) -> Complex:
    """Return A·P + B·conj(P), by einsum: threads of a BLAS cost more than such small products."""
    return np.asarray(
        np.einsum("gmr,r...->gm...", a, phasors) + np.einsum("gmr,r...->gm...", b, phasors.conj())
    )
