"""Share of each tolerance in what remains."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import labels
from crankpin._support.record import Tabled, read_only
from crankpin._support.tables import Table

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Shares(Tabled):
    """Share of each tolerance in the variance of what remains.

    ``shares.values`` is (n_by, n_tolerances); ``shares.interaction`` is what their sums lack of 1.

    Made by :attr:`Tolerances.shares`.

    Examples
    --------
    >>> import crankpin as cp
    >>> t = cp.tolerances(
    ...     cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, pin_deg=0.1, samples=2000,
    ...     by="[1].force.forward",
    ... )
    >>> t.shares.tolerances
    ('reciprocating_mass', 'pin_deg')
    >>> bool(abs(t.shares.interaction[0]) < 0.05)
    True
    """

    by: tuple[str, ...]
    """What was read of the samples."""
    tolerances: tuple[str, ...]
    """Figures that spread."""
    values: NDArray[np.float64]
    """Variance that each figure makes by itself over that of all together: (n_by, n_tolerances)."""

    @cached_property
    def interaction(self) -> NDArray[np.float64]:
        """1 less the sum of the shares, zero where nothing varies: (n_by,).

        Near zero where what remains is linear in the deviations, or grows as their root of squares.
        """
        sums = self.values.sum(axis=1)
        return read_only(np.where(self.values.any(axis=1), 1.0 - sums, 0.0))  # type: ignore[no-any-return]

    @property
    def table(self) -> Table:
        """Table that is shown, in percent."""
        names = [(labels.TOLERANCES[name][0], "%") for name in self.tolerances]
        rows = 100.0 * np.column_stack([self.values, self.interaction])
        title = "Share of each tolerance in the variance"
        return Table.from_rows(
            title, ["", *names, ("interaction", "%")], [(by,) for by in self.by], rows, 1
        )
