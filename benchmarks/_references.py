"""The references of the tests, for the measurements beside them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

TESTS = Path(__file__).parent.parent / "tests"
sys.path.insert(0, str(TESTS))

from rederivation import faces, harmonics_mp, ijesc, ito, kinematics, pressure  # noqa: E402 - from the tests beside us

__all__ = [
    "TESTS",
    "faces",
    "harmonics_mp",
    "ijesc",
    "ito",
    "kinematics",
    "pressure",
    "relative_errors",
]

UNDERFLOW = 1e-300
"""Below it doubles lose their last digits."""


def relative_errors(found: ArrayLike, exact: ArrayLike) -> np.ndarray:
    """Worst of real and imaginary part, each relative to itself; NaN where nothing was found.

    Instead of a part that is exactly zero anything else is infinitely wrong.
    """
    mine, theirs = np.asarray(found, dtype=complex), np.asarray(exact, dtype=complex)
    errors = np.zeros(mine.shape)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        for a, b in ((mine.real, theirs.real), (mine.imag, theirs.imag)):
            counted = np.abs(b) > UNDERFLOW
            each = np.where(counted, np.abs(a - b) / np.abs(b), 0.0)
            each = np.where((b == 0) & (a != 0), np.inf, each)
            errors = np.maximum(errors, np.where(np.isnan(a), np.nan, each))
    return errors
