"""Two engines on mounts beside each other: before and after a change of engine, body or mounts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.parameters import documented
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.comparison import change_of
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.analysis.mounts.response import MountResponse, PointMotion
from crankpin.analysis.quantity import ALL

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin.analysis.quantity import Quantity


@documented()
def compare_mounts(
    before: Powertrain,
    after: Powertrain,
    rpm: ArrayLike,
    *,
    point: ArrayLike | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
) -> MountComparison:
    """Return the responses of two engines on their mounts at the same speeds and orders.

    Parameters
    ----------
    before : Powertrain
        The powertrain before a change, or any.
    after : Powertrain
        The powertrain after it, or any other: of another engine, body or mounts.
    rpm : array_like
        Crank speeds, rpm: one, or several.
    point : sequence of float, optional
        Place (x, y, z) of both powertrains whose velocity is compared too, m.
    orders : number, sequence of numbers or "auto", default "auto"
        Multiples of crank speed, halves too; by default all that either needs to reach ``rtol``.

    Returns
    -------
    MountComparison
        Force on the body, and velocity of the point, of both.

    Raises
    ------
    InputError
        If an argument is out of range, or an order meets a mode without damping.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, or the mounts leave a motion free.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
    >>> mounts = [
    ...     cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1)
    ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
    ... ]
    >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
    >>> soft = p.replace(mounts=[m.replace(stiffness=1e5) for m in mounts])
    >>> cp.compare_mounts(p, soft, 3000, orders=[2, 4])
    Inline-4 on mounts at 3000 rpm: peaks
    quantity           order  unit   before     after  change %  change dB
    force on the body      2  N      23.876    11.868   -50.294    -6.0718
    force on the body      4  N     0.13612  0.067962   -50.073    -6.0333
    force on the body    all  N      24.011    11.935   -50.293    -6.0716
    Without gas pressure.
    """
    for name, one in (("before", before), ("after", after)):
        if not isinstance(one, Powertrain):
            raise inputs.rejected(name, one, "give a crankpin.Powertrain")
        one._require_engine_axes("compare_mounts")
    first, second = (one.response(rpm, orders=orders, rtol=rtol) for one in (before, after))
    both = tuple(sorted({*first.orders, *second.orders}))
    if isinstance(orders, str) and both:
        first, second = (one.response(rpm, orders=both) for one in (before, after))
    points = None if point is None else (first.at(point), second.at(point))
    return MountComparison(first, second, points)


class MountComparison(Tabled):
    """Responses of two engines on their mounts at the same speeds and orders.

    Made by :func:`crankpin.compare_mounts`.
    """

    before: MountResponse
    """Response before the change."""
    after: MountResponse
    """Response after the change."""
    _points: tuple[PointMotion, PointMotion] | None = None
    """Motion of a point of both; None where there is none."""

    def __post_init__(self) -> None:
        for name, state in (("before", self.before), ("after", self.after)):
            if not isinstance(state, MountResponse):
                raise inputs.rejected(name, state, "use crankpin.compare_mounts")
        same = np.array_equal(self.before.rpm, self.after.rpm)
        if self.before.orders != self.after.orders or not same:
            fault = "is at different orders or speeds than before"
            raise inputs.faulty("after", fault, "use crankpin.compare_mounts")

    @property
    def rpm(self) -> NDArray[np.float64] | float:
        """Crank speeds, rpm: (n_rpm,), or a number where one was given."""
        return self.before.rpm

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.before.orders

    def _pairs(self) -> list[tuple[str, str, float, Quantity, Quantity]]:
        """Return words, unit, units in an SI unit, and both quantities."""
        pairs = [("force on the body", "N", 1.0, self.before.body_force, self.after.body_force)]
        if self._points is not None:
            first, second = self._points
            words = f"velocity of {first._words}"
            pairs.append((words, "mm/s", 1e3, first.velocity, second.velocity))
        return pairs

    def change(self, quantity: str = "body_force") -> NDArray[np.float64]:
        """Return how the peak of each order changes, relative to that before: (…, n_orders).

        −1 where it vanishes, 0 where it stays, inf where it was zero.

        Parameters
        ----------
        quantity : {"body_force", "velocity"}, default "body_force"
            The force on the body, or the velocity of the point.

        Returns
        -------
        ndarray of float
            Relative changes, without unit.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        names = ("body_force", "velocity")[: len(self._pairs())]
        place = names.index(inputs.one_of("quantity", quantity, names))
        *_, first, second = self._pairs()[place]
        return read_only(change_of(np.asarray(first.peak), np.asarray(second.peak)))

    @property
    def loads_counted(self) -> str:
        """Loads that count, in words; both where they differ."""
        both = dict.fromkeys(one.loads_counted for one in (self.before, self.after))
        return "; ".join(text for text in both if text)

    @property
    def title(self) -> str:
        """Names of both, or the one they have."""
        names = dict.fromkeys(labels.name_of(one.powertrain) for one in (self.before, self.after))
        return " → ".join(names)

    @property
    def table(self) -> Table:
        """Peaks before and after, by order at one speed, else of all orders at each speed."""
        swept = bool(self.before.dims)
        heads, steps, row_units = list[str](), list[Any](), list[str]()
        rows = list[tuple[float, float]]()
        for words, unit, factor, *both in self._pairs():
            peaks, totals = (
                np.array([np.atleast_1d(factor * np.asarray(each)) for each in values])
                for values in ([one.peak for one in both], [one.total.peak for one in both])
            )
            if swept:
                along: list[Any] = np.asarray(self.rpm).tolist()
                values = totals
            else:
                is_large = peaks.max(axis=0) > labels.NEGLIGIBLE * peaks.max(initial=0.0)
                places = np.flatnonzero(is_large)
                along = [*(self.orders[k] for k in places), ALL]
                values = np.column_stack([peaks[:, places], totals])
            heads += [words] * len(along)
            steps += along
            row_units += [unit] * len(along)
            rows += zip(*values.tolist(), strict=True)
        before, after = np.array(rows).reshape(-1, 2).T
        change = change_of(before, after)
        with np.errstate(divide="ignore", invalid="ignore"):
            decibels = 20.0 * np.log10(1.0 + change)
        columns = (
            Column("quantity", tuple(heads)),
            Column("rpm" if swept else "order", tuple(steps)),
            Column("unit", tuple(row_units)),
            Column("before", before),
            Column("after", after),
            Column("change", _finite(100.0 * change), "%"),
            Column("change", _finite(decibels), "dB"),
        )
        at = "" if swept else f" {self.before._at()}"
        title = f"{self.title} on mounts{at}: peaks"
        return Table(title, columns, loads=self.loads_counted, row_units=tuple(row_units))


def _finite(values: NDArray[np.float64]) -> tuple[float | None, ...]:
    """Return numbers, None in place of those relative to nothing."""
    return tuple(value if np.isfinite(value) else None for value in values.tolist())
