"""A rigid body on springs and snubbers again: its state at rest as the least energy.

A snubber beyond its gap has ½ s (d − gap)², which is the least over slacks v ≥ 0 of
½ s (d − gap + v)²: the whole is a linear least-squares problem with bounds, which SciPy solves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import lsq_linear

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Snubbed(NamedTuple):
    """Springs and snubbers along three axes, rows, at a place."""

    at: NDArray[np.float64]
    axes: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    gap: NDArray[np.float64]
    """Against and along each axis: (3, 2)."""
    further: NDArray[np.float64]
    """Stiffness of the snubbers: (3, 2)."""

    def rows(self, cg: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the deflection along the axes, of displacement and rotation about the centre."""
        x, y, z = self.at - cg
        turn = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        return np.asarray(self.axes @ np.hstack([np.eye(3), turn]))


def energy(
    mounts: list[Snubbed],
    cg: NDArray[np.float64],
    load: NDArray[np.float64],
    q: NDArray[np.float64],
) -> float:
    """Return the potential of a motion under a load about the centre of gravity."""
    total = -float(load @ q)
    for mount in mounts:
        along = mount.rows(cg) @ q
        beyond = np.maximum(np.stack([-along, along], axis=-1) - mount.gap, 0.0)
        total += 0.5 * float(mount.stiffness @ along**2 + (mount.further * beyond**2).sum())
    return total


def at_rest(
    mounts: list[Snubbed], cg: NDArray[np.float64], load: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the motion of least potential, of springs that resist every motion."""
    springs = np.vstack([np.sqrt(m.stiffness)[:, None] * m.rows(cg) for m in mounts])
    of_load = np.linalg.pinv(springs).T @ load
    signs = np.array([-1.0, 1.0])
    snubbers = [
        (signs[side] * mount.rows(cg)[axis], mount.gap[axis, side], mount.further[axis, side])
        for mount in mounts
        for axis in range(3)
        for side in range(2)
        if mount.further[axis, side] > 0.0
    ]
    count = len(snubbers)
    matrix = np.zeros((len(springs) + count, 6 + count))
    matrix[: len(springs), :6] = springs
    right = np.concatenate([of_load, np.zeros(count)])
    for k, (row, gap, further) in enumerate(snubbers, len(springs)):
        matrix[k, :6] = np.sqrt(further) * row
        matrix[k, 6 + k - len(springs)] = np.sqrt(further)
        right[k] = np.sqrt(further) * gap
    least = [-np.inf] * 6 + [0.0] * count
    found = lsq_linear(matrix, right, (least, np.inf), method="bvls", tol=1e-15, max_iter=10_000)
    return np.asarray(found.x[:6])
