"""Engines ranked by objectives, each at its best bank angles."""

from __future__ import annotations

from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.record import Listed, Tabled
from crankpin._support.tables import Table
from crankpin.analysis.drawing import draw
from crankpin.analysis.ranking.choices import Choice, angles_of, own_angles
from crankpin.analysis.ranking.objectives import of_table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.model.engine import Engine, Hold

MOST_ANGLES = 6
"""Bank angles shown in a cell."""


class Ranking(Listed[Choice], Tabled):
    """Engines sorted by objectives, each at its best bank angles.

    A sequence of :class:`Choice`, the best first. Made by :func:`crankpin.rank`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> ranking = cp.rank(
    ...     v6, rpm=5000, by="total.moment.peak", bank_angle_deg=[60, 90, 120], hold="pins"
    ... )
    >>> ranking[0].bank_angles_deg
    (60.0,)
    >>> ranking.trade_off["[1].moment.backward"].round(1)
    array([[  0. , 459.4, 795.7]])
    """

    _items, _item, _maker = "choices", Choice, "crankpin.rank"

    sweep: Sweep
    """The sweep of the engines over the bank angles."""
    objectives: tuple[Objective, ...]
    """The objectives."""
    values_by: tuple[NDArray[np.float64], ...]
    """Values of each objective: (n_engines, n_angles), in its unit."""
    choices: tuple[Choice, ...]
    """The engines, the best first."""

    @property
    def by(self) -> tuple[str, ...]:
        """Names of the objectives."""
        return tuple(objective.label for objective in self.objectives)

    @property
    def engines(self) -> tuple[Engine, ...]:
        """The engines as they were given."""
        return self.sweep.engines

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the engines as given; engines with the same name, or none, are numbered."""
        return tuple(map(str, self.sweep.coords["engine"]))

    @property
    def hold(self) -> Hold | None:
        """Quantity that a change of bank angle does not change: "pins", "firing" or None."""
        return self.sweep.hold

    @cached_property
    def bank_angles_deg(self) -> NDArray[np.float64] | None:
        """The bank angles that were given, degrees: (n_angles,); None where none were."""
        return angles_of(self.sweep)

    @cached_property
    def own_angles_deg(self) -> NDArray[np.float64]:
        """Bank angles of the engines as given, degrees; NaN where there are not two banks."""
        own = own_angles(self.engines)
        own.setflags(write=False)
        return own

    @property
    def values(self) -> NDArray[np.float64]:
        """Values of the first objective, in its unit: (n_engines, n_angles).

        Engines in the order given; one column where no bank angles were given.
        """
        return self.values_by[0]

    @cached_property
    def trade_off(self) -> Mapping[str, NDArray[np.float64]]:
        """The trade-off: objective → (n_engines, n_angles), in its unit; engines as given.

        The objectives of the ranking; then total moment and force, the backward part of the first
        order, the second order, total torque, and, of engines with up to 8 cylinders, the
        unevenness of firing.
        """
        columns = dict(zip(self.by, self.values_by, strict=True))
        for objective in of_table(self.sweep):
            if objective.label not in columns:
                columns[objective.label] = objective.values(self.sweep)
        return MappingProxyType(columns)

    def best(self, count: int = 1) -> tuple[Choice, ...]:
        """Return the ``count`` best engines, best first."""
        wanted = inputs.number("count", count)
        if not 0 <= wanted <= len(self) or wanted != int(wanted):
            remedy = f"give a whole number, 0 to {len(self)}"
            raise InputError(f"count = {inputs.shorten(count)}: {remedy}")
        return self.choices[: int(wanted)]

    @property
    def unit(self) -> str:
        """Unit of the first objective; empty where it is a function."""
        return self.objectives[0].unit

    # --- tables and pictures --------------------------------------------------------------------

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:  # noqa: ANN401 - as below
        """Draw the first objective over bank angle, the best angles ringed; return the axes.

        Engines ranked without bank angles are listed, the best first. Of many engines the best
        are named, the others thin lines.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        **options
            ``label``, put before the names in the legend; colour, line width and other properties
            of matplotlib lines.
        """
        return draw(self, ax, **options)  # type: ignore[no-any-return]

    def description(self, objectives: int | None = None) -> str:
        """Return the objectives, all or the first few, and the speed in words."""
        least = ", then ".join(each.words for each in self.objectives[:objectives])
        if self.sweep.request.orders is not None:
            least = least.replace("all orders", "all of the orders given")
        return f"{least}, {labels.value_text('rpm', self.sweep.fixed['rpm'])}"

    @property
    def table(self) -> Table:
        """Table that is shown: the choices, best first."""
        choices = self.choices
        parts = [
            f"Ranked by {self.description()}",
            *([labels.HELD[self.hold]] if self.hold else []),
        ]
        title = ", ".join(parts)
        heads = [(each.label, each.unit) for each in self.objectives]
        rows_of = [(each.place, each.name, _several(each.bank_angles_deg)) for each in choices]
        rows = np.array([each.values for each in choices]).reshape(-1, len(heads))
        return Table.from_rows(
            title, ["place", "engine", ("bank angle", "°"), *heads], rows_of, rows
        )


def _several(angles: tuple[float, ...]) -> str:
    """Return a few angles as text."""
    shown = ", ".join(f"{angle:.8g}" for angle in angles[:MOST_ANGLES])
    rest = len(angles) - MOST_ANGLES
    return f"{shown} and {rest} more" if rest > 0 else shown or "–"
