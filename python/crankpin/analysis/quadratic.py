"""Least squares of variables that are zero or more, under linear equations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import optional

if TYPE_CHECKING:
    from numpy.typing import NDArray

PENALTY = 1e4
"""Weight of the equations beside the squares; each round gains about as many digits."""
EXACT = 1e-14
"""What may be missing from an equation; figures are of order 1."""
ROUNDS = 30


def least_squares(
    rows: NDArray[np.float64],
    target: NDArray[np.float64],
    held: NDArray[np.float64],
    value: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Minimise |rows·x − target|² over x ≥ 0 with held·x = value (needs SciPy).

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
    value
        (n_held,); some x ≥ 0 satisfies the equations.
    """
    nnls = optional.scipy_optimize().nnls
    stacked = np.vstack([rows, np.sqrt(PENALTY) * held])
    multipliers = np.zeros(len(held))
    for _ in range(ROUNDS):
        wanted = np.append(target, np.sqrt(PENALTY) * (value + multipliers / PENALTY))
        x, _ = nnls(stacked, wanted, maxiter=30 * stacked.shape[1])
        missing = value - held @ x
        if np.abs(missing).max(initial=0.0) <= EXACT:
            break
        multipliers += PENALTY * missing
    return np.asarray(x)
