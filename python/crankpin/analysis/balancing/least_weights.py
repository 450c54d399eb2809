"""Least weights in given planes that make, or come nearest to, a force and a moment.

A plane's weight is a complex number u, its mass·radius |u|, or, at allowed angles, the sum of the
amounts there. Wanted are weights with ``matrix @ u`` nearest to ``target``, and of those the least:
by the sum of the squares of the planes' mass·radius, or by the largest of them.

Without bounds, and at any angle, the pseudo-inverse answers by squares. The rest are convex
problems, with linear constraints once every plane has a list of angles; where any angle is allowed
the list is refined about the angles in use until it makes no difference.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from crankpin._support import optional
from crankpin.analysis.balancing.quadratic import least_squares

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

COARSE = np.pi / 8.0
"""First distance between angles, radians."""
FINEST = 1e-6
"""Last distance between angles, radians: mass·radius is then least to within FINEST²/8."""
FAN = np.arange(-5, 6)
"""Angles tried about one in use, in distances between angles."""
MOST_AGAIN = 8
"""Fans of one distance between angles that are tried where the best was at the end of the last."""
REACHED = 1e-9
"""Part of the target that solvers may miss, to be made up by weights with room for it."""
ROOM = 1e-6
"""Room of such weights, relative to the target and to their bounds."""
RANK = 1e-12
"""Singular values below this part of the largest are zero."""
NOTHING = 1e-200
"""Targets below this are none."""
UNBOUNDED = 1e9
"""Bounds above this multiple of the target bind nowhere; those below its inverse leave nothing."""


@dataclasses.dataclass(frozen=True)
class Problem:
    """Weights that are wanted."""

    matrix: NDArray[np.complex128]
    """What a unit weight of each plane makes: (n_targets, n_planes)."""
    target: NDArray[np.complex128]
    """What the weights are to make: (n_targets,)."""
    bounds: NDArray[np.float64]
    """Largest mass·radius of each plane, infinite for none: (n_planes,)."""
    angles: tuple[NDArray[np.float64], ...] | None
    """Angles allowed in each plane, radians; None for any."""
    largest: bool
    """Whether the largest mass·radius is minimised, in place of the sum of squares."""


class Weights(NamedTuple):
    """Weights, each in a plane at an angle."""

    plane: NDArray[np.intp]
    """Index of the plane: (n_weights,)."""
    angle: NDArray[np.intp]
    """Index among the angles allowed in the plane, 0 where any is: (n_weights,)."""
    value: NDArray[np.complex128]
    """Mass·radius and direction: (n_weights,)."""
    reached: bool
    """True if weights beside these, by no more than rounding, are proved to make the target
    wherever weights of any size in these planes do."""
    missing: float
    """Part of the target that is not made."""


class Columns(NamedTuple):
    """Places for weights, each in a plane at an angle."""

    plane: NDArray[np.intp]
    angle: NDArray[np.float64]

    @classmethod
    def at(cls, angles: Sequence[NDArray[np.float64]]) -> Columns:
        """Return the columns of planes with these angles, radians."""
        counts = [len(each) for each in angles]
        return cls(np.repeat(np.arange(len(counts)), counts), np.concatenate(angles))

    @property
    def direction(self) -> NDArray[np.complex128]:
        """Unit vectors."""
        return np.asarray(np.exp(1j * self.angle))

    def resultants(self, amounts: NDArray[np.float64], planes: int) -> NDArray[np.complex128]:
        """Return the sum of the weights in each plane."""
        found = np.zeros(planes, dtype=np.complex128)
        np.add.at(found, self.plane, amounts * self.direction)
        return found


def least(problem: Problem) -> Weights:
    """Return the least of the weights that come nearest to the target."""
    scale = float(np.abs(problem.target).max(initial=0.0))
    wanted = scale > NOTHING
    bounds = problem.bounds / scale if wanted else np.zeros(len(problem.bounds))
    kept = np.flatnonzero(bounds > 1.0 / UNBOUNDED)
    if not kept.size:
        nothing = np.empty(0, dtype=np.intp)
        return Weights(
            nothing,
            nothing,
            nothing.astype(np.complex128),
            reached=not wanted,
            missing=float(wanted),
        )
    scaled = Problem(
        problem.matrix[:, kept],
        problem.target / scale,
        np.where(bounds[kept] < UNBOUNDED, bounds[kept], np.inf),
        None if problem.angles is None else tuple(problem.angles[k] for k in kept),
        problem.largest,
    )
    if scaled.angles is None:
        plane, angle = np.arange(len(kept)), np.zeros(len(kept), dtype=np.intp)
        value, reached = _at_any_angle(scaled)
    else:
        columns = Columns.at(scaled.angles)
        amounts, reached = _at_angles(scaled, columns)
        used = np.flatnonzero(amounts)
        first = np.searchsorted(columns.plane, np.arange(len(kept)))
        plane, angle = columns.plane[used], used - first[columns.plane[used]]
        value = (amounts * columns.direction)[used]
    missing = float(np.abs(scaled.target - scaled.matrix[:, plane] @ value).max())
    return Weights(kept[plane], angle, scale * value, reached, missing)


def _at_angles(problem: Problem, columns: Columns) -> tuple[NDArray[np.float64], bool]:
    """Return the amount in each column, and whether the target is reached."""
    amounts = _nearest(problem, columns, np.zeros(len(columns.plane)))
    solve = _largest if problem.largest else _squares
    amounts = np.maximum(solve(problem, columns, amounts), 0.0)
    sums = np.bincount(columns.plane, amounts, len(problem.bounds))
    with np.errstate(divide="ignore"):
        amounts *= np.minimum(1.0, problem.bounds / sums)[columns.plane]
    rows = _real(problem.matrix[:, columns.plane] * columns.direction)
    missing = _real(problem.target[:, None])[:, 0] - rows @ amounts
    count = np.bincount(columns.plane, minlength=len(problem.bounds))
    room = np.minimum(amounts, ((problem.bounds - sums) / count)[columns.plane])
    change, reached = _made_up(rows, missing, room, 2 * _rank(problem.matrix))
    return amounts + change, reached


def _at_any_angle(problem: Problem) -> tuple[NDArray[np.complex128], bool]:
    """Return the weight in each plane, and whether the target is reached."""
    inverse = np.linalg.pinv(problem.matrix, rcond=RANK)
    found: NDArray[np.complex128] = inverse @ problem.target
    bound = bool((np.abs(found) > problem.bounds).any())
    if bound:
        found = _refined(problem, 0.0 * found, _nearest)
    if problem.largest:
        found = _refined(problem, found, _largest)
    elif bound:
        found = _refined(problem, found, _squares)
    with np.errstate(divide="ignore"):
        found *= np.minimum(1.0, problem.bounds / np.abs(found))
    missing = problem.target - problem.matrix @ found
    room = problem.bounds - np.abs(found)
    change, reached = _made_up(problem.matrix, missing, room, _rank(problem.matrix))
    return found + change, reached


def _made_up(
    rows: NDArray[Any], missing: NDArray[Any], room: NDArray[np.float64], rank: int
) -> tuple[NDArray[Any], bool]:
    """Return the change of weights with room that makes what is missing, and whether it is proved.

    The weights with room make whatever all of them can if their equations have the same rank. The
    change then exists, however small what is missing looks; otherwise it is the nearest.
    """
    change = np.zeros(rows.shape[1], dtype=rows.dtype)
    free = room > ROOM
    made = rows[:, free]
    if np.abs(missing).max() > REACHED or not free.any():
        return change, False
    change[free] = np.linalg.lstsq(made, missing, rcond=RANK)[0]
    if (np.abs(change) > np.maximum(room, 0.0)).any():
        return np.zeros_like(change), False
    return change, _rank(made) == rank


def _rank(rows: NDArray[Any]) -> int:
    if not rows.size:
        return 0
    values = np.linalg.svd(rows, compute_uv=False)
    return int((values > RANK * values[0]).sum())


class _Solver(Protocol):
    def __call__(
        self, problem: Problem, columns: Columns, amounts: NDArray[np.float64]
    ) -> NDArray[np.float64]: ...


def _refined(
    problem: Problem, found: NDArray[np.complex128], solve: _Solver
) -> NDArray[np.complex128]:
    """Solve with angles about those in use, closer and closer together.

    The problem is convex: once the best of a fan of angles is within it, it is the best of all.
    """
    planes, step, again = len(found), COARSE, 0
    circle = np.arange(0.0, 2.0 * np.pi, COARSE)
    fans = [circle] * planes
    while True:
        # The weights found so far stay possible, so that what is minimised never grows.
        columns = Columns.at([np.append(f, np.angle(u)) for f, u in zip(fans, found, strict=True)])
        amounts = np.zeros(len(columns.plane))
        last = np.append(np.flatnonzero(np.diff(columns.plane)), len(amounts) - 1)
        amounts[last] = np.abs(found)
        amounts = solve(problem, columns, amounts)
        centres, found = np.angle(found), columns.resultants(amounts, planes)
        if step <= FINEST:
            return found
        turned = np.abs(np.angle(found * np.exp(-1j * centres)))
        outside = [
            len(fan) == len(FAN) and turn > 0.75 * FAN[-1] * step
            for fan, turn in zip(fans, turned, strict=True)
        ]
        # Where several weights are equally good, directions may wander for ever.
        again = again + 1 if any(outside) and again < MOST_AGAIN else 0
        step = step if again else step / 4.0
        fans = [np.angle(u) + FAN * step if u else circle for u in found]


# --- planes with lists of angles ------------------------------------------------------------------


def _nearest(
    problem: Problem, columns: Columns, amounts: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return amounts within bounds that come nearest to the target, from amounts within bounds."""
    made, filled, room = _constraints(problem, columns, amounts)
    target = _real(problem.target[:, None])[:, 0]
    return least_squares(made, target, filled, np.append(amounts, room))[: len(amounts)]


def _squares(
    problem: Problem, columns: Columns, amounts: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return amounts that make what the given ones make, with the least sum of squares."""
    made, filled, room = _constraints(problem, columns, amounts)
    sums = np.zeros((len(problem.bounds), made.shape[1]))
    sums[columns.plane, np.arange(len(amounts))] = 1.0
    held = np.vstack([made, filled])
    start = np.append(amounts, room)
    return least_squares(sums, np.zeros(len(sums)), held, start)[: len(amounts)]


def _largest(
    problem: Problem, columns: Columns, amounts: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return amounts that make what the given ones make, the largest plane's the least."""
    made, filled, room = _constraints(problem, columns, amounts)
    sums = (columns.plane == np.arange(len(problem.bounds))[:, None]).astype(float)
    count = len(amounts)
    solution = optional.scipy_optimize().linprog(
        np.append(np.zeros(count + len(room)), 1.0),
        A_ub=np.hstack([sums, np.zeros((len(sums), len(room))), -np.ones((len(sums), 1))]),
        b_ub=np.zeros(len(sums)),
        A_eq=np.hstack([np.vstack([made, filled]), np.zeros((len(made) + len(filled), 1))]),
        b_eq=np.append(made[:, :count] @ amounts, filled @ np.append(amounts, room)),
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    # The amounts given satisfy all constraints but for rounding, to which a solver may object.
    return np.maximum(solution.x[:count], 0.0) if solution.success else amounts


def _constraints(
    problem: Problem, columns: Columns, amounts: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return what columns make, rows of amount and room that fill each bound, and the room left.

    Variables are the amounts and, for each plane with a bound, the room that it leaves.
    """
    bounded = np.flatnonzero(np.isfinite(problem.bounds))
    made = _real(problem.matrix[:, columns.plane] * columns.direction)
    made = np.hstack([made, np.zeros((len(made), len(bounded)))])
    sums = (columns.plane == bounded[:, None]).astype(float)
    room = np.maximum(problem.bounds[bounded] - sums @ amounts, 0.0)
    return made, np.hstack([sums, np.eye(len(bounded))]), room


def _real(rows: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.vstack([rows.real, rows.imag])
