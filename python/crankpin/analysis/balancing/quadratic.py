"""Least squares of variables that are zero or more, under linear equations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import optional

if TYPE_CHECKING:
    from numpy.typing import NDArray

PENALTY = 1e4
"""Weight of the equations beside the squares; each round gains about as many digits."""
EXACT = 1e-13
"""What may be missing from an equation; figures are of order 1."""
ROUNDS = 30


def least_squares(
    rows: NDArray[np.float64],
    target: NDArray[np.float64],
    held: NDArray[np.float64],
    start: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Minimise |rows·x − target|² over x ≥ 0 with held·x as at the start (needs SciPy).

    An augmented Lagrangian: equations weigh so moderately that no digits are lost, and their
    multipliers make up for the rest.

    Parameters
    ----------
    rows
        (n_rows, n).
    target
        (n_rows,).
    held
        (n_held, n).
    start
        Zero or more, (n,); returned where the equations leave no room for another.
    """
    nnls = optional.scipy_optimize().nnls
    stacked = np.vstack([rows, np.sqrt(PENALTY) * held])
    value, multipliers = held @ start, np.zeros(len(held))
    for _ in range(ROUNDS):
        wanted = np.append(target, np.sqrt(PENALTY) * (value + multipliers / PENALTY))
        try:
            x, _ = nnls(stacked, wanted, maxiter=30 * stacked.shape[1])
        except RuntimeError:  # columns that are alike, taken up and dropped in turn
            break
        missing = value - held @ x
        if np.abs(missing).max(initial=0.0) <= EXACT:
            return np.asarray(x)
        multipliers += PENALTY * missing
    return start
