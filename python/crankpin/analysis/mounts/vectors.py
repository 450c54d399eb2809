"""Spatial vectors by order: forces of mounts, motion of points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.record import AbsentError, changed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.quantity import ALL, Key, Keyed, order_key

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.mounts.response import MountResponse

Source: TypeAlias = tuple[Any, ...]
"""Origin of a vector: ``("support",)``, ``("mount", index)``, ``("at", point, on, name)``."""


def of_order(order: Key) -> str:
    """Return an order in words that follow a name."""
    if order is None:
        return ""
    return " of all orders" if order == ALL else f" of order {order}"


class VectorQuantity(Keyed, Tabled):
    """Peak phasors of a vector in space: of every order, of one, or of all orders together.

    Order n is ``Re(P exp(inθ))``. ``force[2]`` is order 2, also if it is not among ``orders``;
    ``force.peak`` is an array over speeds and orders, ``force.total.peak`` the true peak over the
    cycle of all orders together.

    Made by :class:`MountResponse`.
    """

    result: MountResponse
    """The response that it belongs to."""
    source: Source
    """Origin of the vector."""
    words: str
    """Name in texts."""
    unit: str
    """Unit."""
    order: Key = None
    """The order; ``"all"`` for all orders together, None for every order."""

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.result.orders if self.order is None or self.order == ALL else (self.order,)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions of ``xyz``."""
        return (*self.result.dims, *(("order",) if self.order is None else ()), "axis")

    @property
    def xyz(self) -> NDArray[np.complex128]:
        """Peak phasors along x, y and z: (…, n_orders, n_axes), of one order (…, n_axes)."""
        if self.order == ALL:
            hint = "all orders together have peaks and rms values; give an order"
            raise inputs.faulty("xyz", "is undefined", hint, AbsentError)
        if self.order is None:
            return self.result._vectors(self.source)
        one = self.result._with_order(self.order)
        return read_only(one._vectors(self.source)[..., one.orders.index(self.order), :])

    @property
    def x(self) -> NDArray[np.complex128]:
        """Peak phasors along x: (…, n_orders)."""
        return self.xyz[..., 0]

    @property
    def y(self) -> NDArray[np.complex128]:
        """Peak phasors along y: (…, n_orders)."""
        return self.xyz[..., 1]

    @property
    def z(self) -> NDArray[np.complex128]:
        """Peak phasors along z: (…, n_orders)."""
        return self.xyz[..., 2]

    @property
    def peak_xyz(self) -> NDArray[np.float64]:
        """Peaks along x, y and z: (…, n_orders, n_axes); of all orders together (…, n_axes)."""
        return self._peaks()[..., :3]

    @property
    def peak(self) -> Any:  # noqa: ANN401 - a number of one order at one speed
        """Length of the longest vector: (…, n_orders); of all orders together (…)."""
        peaks = self._peaks()[..., 3]
        return peaks if peaks.ndim else float(peaks)

    @property
    def rms_xyz(self) -> NDArray[np.float64]:
        """Root mean squares along the axes: (…, n_orders, n_axes); of all together (…, n_axes)."""
        if self.order == ALL:
            return read_only(np.sqrt((self[None].rms_xyz ** 2).sum(axis=-2)))
        return read_only(np.abs(self.xyz) / np.sqrt(2.0))

    @property
    def rms(self) -> Any:  # noqa: ANN401 - as above
        """Root mean square of the length: (…, n_orders); of all orders together (…)."""
        lengths = read_only(np.sqrt((self.rms_xyz**2).sum(axis=-1)))
        return lengths if lengths.ndim else float(lengths)

    @property
    def total(self) -> VectorQuantity:
        """All orders together."""
        return changed(self, order=ALL)

    def _peaks(self) -> NDArray[np.float64]:
        """Return peaks along x, y, z and of the length."""
        if self.order == ALL:
            vectors = self.result._vectors(self.source)
            rows = np.ascontiguousarray(vectors.reshape(-1, 3))
            peaks = _core.peaks_of_vectors(list(self.orders), rows)
            return read_only(peaks.reshape(*vectors.shape[:-2], 4))
        vectors = self.xyz
        # Each row by itself, an ellipse: whatever order it is of.
        peaks = _core.peaks_of_vectors([1], np.ascontiguousarray(vectors.reshape(-1, 3)))
        return read_only(peaks.reshape(*vectors.shape[:-1], 4))

    def __getitem__(self, order: Order | Literal["all"] | None) -> VectorQuantity:
        """Return the quantity at one order, or at ``"all"``."""
        return changed(self, order=None if order is None else order_key(order))

    @property
    def table(self) -> Table:
        """Peaks along x, y and z, length of the longest vector, and the rms of the length.

        By order at one speed, else at each speed of the order, or of all orders together.
        """
        result, order, note = self.result, self.order, ""
        order = ALL if order is None and result.dims else order
        vector = changed(self, order=order)
        if result.dims:
            columns = [Column("rpm", np.asarray(result.rpm), digits=10)]
        elif order is not None:
            columns = [Column("order", (order,))]
        else:
            places, note = result._shown()
            columns = [Column("order", (*(result.orders[k] for k in places), ALL))]
        peaks, rms = np.atleast_2d(vector._peaks()), np.atleast_1d(vector.rms)
        if order is None:
            peaks = np.vstack([peaks[places], self.total._peaks()])
            rms = np.append(rms[places], self.total.rms)
        heads = ("peak along x", "along y", "along z", "longest", "rms")
        for head, values in zip(heads, (*peaks.T, rms), strict=True):
            columns.append(Column(head, values, self.unit))
        which = of_order(order)
        title = result._title(f"{self.words}{which and f',{which}'}")
        return Table(title, tuple(columns), note, loads=result.loads_counted)

    @property
    def _brief(self) -> str:
        which = of_order(self.order)
        name, loads = labels.printable(self.words), self.result.loads_counted
        if not self.result.dims and self.order is not None:
            peak = units.figure(self.peak, self.unit, 5)
            return f"<VectorQuantity {name}{which}: peak {peak}, {loads}>"
        shape = ", ".join(
            f"{name}: {length}"
            for name, length in zip(self.dims, self.peak_xyz.shape, strict=False)
        )
        return f"<VectorQuantity {name}{which}, {self.unit}, ({shape}), {loads}>"
