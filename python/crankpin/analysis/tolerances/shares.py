"""Share of each tolerance in what remains."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels, optional
from crankpin._support.frozen import Frozen
from crankpin._support.tables import Shown, Table

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray


class Shares(Frozen, Shown):
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

    _fields: ClassVar[tuple[str, ...]] = ("by", "tolerances", "values")

    by: tuple[str, ...]
    """What was read of the samples."""
    tolerances: tuple[str, ...]
    """Figures that spread."""
    values: NDArray[np.float64]
    """Variance that each figure makes by itself over that of all together: (n_by, n_tolerances)."""

    def __init__(
        self, by: tuple[str, ...], tolerances: tuple[str, ...], values: NDArray[np.float64]
    ) -> None:
        shape = (len(by), len(tolerances))
        if not isinstance(values, np.ndarray) or values.shape != shape:
            raise InputError(f"values = {inputs.shorten(values)}: give an array of shape {shape}")
        kept = values.copy()
        kept.setflags(write=False)
        self._set(by=by, tolerances=tolerances, values=kept)

    @property
    def interaction(self) -> NDArray[np.float64]:
        """1 less the sum of the shares, zero where nothing varies: (n_by,).

        Near zero where what remains is linear in the deviations, or grows as their root of squares.
        """
        sums = self.values.sum(axis=1)
        return np.where(self.values.any(axis=1), 1.0 - sums, 0.0)

    def to_pandas(self) -> pd.DataFrame:
        """Return a tidy table: by, tolerance ("interaction" is one) and share (needs pandas)."""
        rows = [
            (by, name, share)
            for by, shares, rest in zip(self.by, self.values, self.interaction, strict=True)
            for name, share in zip((*self.tolerances, "interaction"), [*shares, rest], strict=True)
        ]
        return optional.data_frame(rows, columns=["by", "tolerance", "share"])

    @property
    def table(self) -> Table:
        """Table that is shown, in percent."""
        names = [f"{labels.TOLERANCES[name][0]} %" for name in self.tolerances]
        rows = 100.0 * np.column_stack([self.values, self.interaction])
        title = "Share of each tolerance in the variance"
        return Table.from_rows(
            title, ["", *names, "interaction %"], [(by,) for by in self.by], rows, 1
        )
