"""Results with quantities order by order: all orders, one order, and their total."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.frozen import Frozen
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.quantities import PlaneVector, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from crankpin.analysis.source import ErrorBound, Source


def place_of(order: object, orders: tuple[int, ...], why: str = "") -> int:
    """Return the place of an order in a result, or raise an InputError that ends with ``why``."""
    if not isinstance(order, (int, np.integer)) or order not in orders:
        missing = f"is not among the orders of this result ({labels.orders_text(orders)})"
        raise InputError(f"order = {inputs.shorten(order)}: {missing}{why}")
    return orders.index(int(order))


# --- all orders together ------------------------------------------------------------------------


class TotalQuantity(Frozen):
    """Torque of all orders together."""

    _fields: ClassVar[tuple[str, ...]] = ("source", "name")

    source: Source
    """Arrays of the result that the quantity belongs to."""
    name: str
    """``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``."""

    def __init__(self, source: Source, name: str) -> None:
        source.request.check(name)
        self._set(source=source, name=name)

    @property
    def unit(self) -> str:
        """Unit: N for a force, N·m for a moment or a torque."""
        return QUANTITIES[self.name].unit

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions of ``peak``."""
        return self.source.dims

    @property
    def peak(self) -> Any:  # noqa: ANN401 - a number of a balance
        """Largest magnitude of all orders together, N or N·m: (…); a true extremum over θ."""
        values = self.source.read(self.name, "total_peak")
        return values if self.source.dims else float(values)

    @property
    def error_bound(self) -> float:
        """Upper bound on what the omitted orders add at any crank angle, N or N·m.

        0 where orders were given: ``peak`` is then of the orders given.
        """
        name = "torque" if self.name == "crank_torque" else self.name
        return float(getattr(self.source.error_bound, name))

    def __repr__(self) -> str:
        what = f"total {QUANTITIES[self.name].words}"
        if self.source.dims:
            over = ", ".join(f"{d}: {n}" for d, n in zip(self.dims, self.peak.shape, strict=True))
            return f"<{type(self).__name__} {what}, {self.unit}, over ({over})>"
        return f"<{type(self).__name__} {what}: peak {self.peak:.5g} {self.unit}>"


class TotalVector(TotalQuantity):
    """Force or moment of all orders together."""

    @property
    def peak(self) -> Any:  # noqa: ANN401 - a number of a balance
        """Length of the longest vector of all orders together, N or N·m: (…); a true extremum."""
        return super().peak

    @property
    def peak_xy(self) -> NDArray[np.float64]:
        """Peaks of all orders together along (about) x and y, N or N·m: (…, 2); true extrema."""
        return self.source.read(self.name, "total_peak_xy")


class Total(Frozen):
    """All orders of a balance or sweep together: peaks and bounds of each quantity."""

    _fields: ClassVar[tuple[str, ...]] = ("source",)

    source: Source
    """Arrays of the result."""

    def __init__(self, source: Source) -> None:
        self._set(source=source)

    @property
    def force(self) -> TotalVector:
        """Shaking force, N."""
        return TotalVector(self.source, "force")

    @property
    def moment(self) -> TotalVector:
        """Rocking moment, N·m."""
        return TotalVector(self.source, "moment")

    @property
    def torque(self) -> TotalQuantity:
        """Roll torque on the block, N·m; an AttributeError where it is not available."""
        return TotalQuantity(self.source, "torque")

    @property
    def crank_torque(self) -> TotalQuantity:
        """Torque on the crank, N·m; an AttributeError where it is not available."""
        return TotalQuantity(self.source, "crank_torque")

    def __repr__(self) -> str:
        return "\n".join(repr(getattr(self, name)) for name in self.source.request.quantities)


# --- what has quantities ------------------------------------------------------------------------


class Quantities(Frozen):
    """Base class of results with force, moment and torques order by order."""

    source: Source
    """Arrays of the result; read them by its quantities."""
    _place: int | None = None

    @property
    def force(self) -> PlaneVector:
        """Shaking force along x and y, N."""
        return PlaneVector(self.source, "force", self._place)

    @property
    def moment(self) -> PlaneVector:
        """Rocking moment about x (pitch) and y (yaw), N·m."""
        return PlaneVector(self.source, "moment", self._place)

    @property
    def torque(self) -> Scalar:
        """Roll torque of the inertia forces on the block about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return Scalar(self.source, "torque", self._place)

    @property
    def crank_torque(self) -> Scalar:
        """Torque of the inertia forces on the crank about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return Scalar(self.source, "crank_torque", self._place)


class OrderBalance(Quantities):
    """One order of a balance or sweep, the same quantities without the dimension of orders.

    Examples
    --------
    >>> import crankpin as cp
    >>> second = cp.Engine.preset("i4").balance(rpm=6000)[2]
    >>> second.order, second.force.shape, float(second.force.x.real)
    (2, (2,), 0.0)
    """

    _fields: ClassVar[tuple[str, ...]] = ("source", "place")

    def __init__(self, source: Source, place: int) -> None:
        self._set(source=source, _place=place)

    @property
    def place(self) -> int | None:
        """Place of the order among those of the whole result."""
        return self._place

    @property
    def order(self) -> int:
        """Multiple of crank speed."""
        assert self._place is not None  # noqa: S101 - by the constructor
        return self.source.orders[self._place]

    def __repr__(self) -> str:
        names = self.source.request.quantities
        lines = (f"  {getattr(self, name)!r}" for name in names)
        return "\n".join([f"<OrderBalance of order {self.order}>", *lines])


class AllOrders(Quantities):
    """Base class of balances and sweeps: quantities, single orders and totals."""

    @property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        return self.source.orders

    @property
    def error_bound(self) -> ErrorBound:
        """Upper bounds on what the orders in ``omitted`` and above add at any crank angle.

        Zero where orders were given. Rounding is not included: sums that vanish to within the
        quantities' ``zero_bound`` are zero.
        """
        return self.source.error_bound

    @property
    def total(self) -> Total:
        """All orders together, as in ``total.force.peak`` and ``total.moment.peak_xy``."""
        return Total(self.source)

    @property
    def omitted(self) -> tuple[int, ...]:
        """With ``orders="auto"``: orders that were left out although they are not zero."""
        raise NotImplementedError

    def __getitem__(self, order: int) -> OrderBalance:
        """Return one order.

        Raises
        ------
        InputError
            If the order is not among ``orders``.
        """
        why = ""
        if self.source.request.orders is None and isinstance(order, (int, np.integer)):
            zero = "it is exactly zero, or above all that matter"
            reason = "it was omitted as negligible" if order in self.omitted else zero
            why = f": {reason}; give orders=[{order}] to have it"
        return OrderBalance(self.source, place_of(order, self.orders, why))

    def __iter__(self) -> Iterator[OrderBalance]:
        return (OrderBalance(self.source, place) for place in range(len(self.orders)))
