"""Quantities of a balance, of one of its orders and of a sweep: a plane vector and a scalar."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from crankpin._support import labels
from crankpin._support.frozen import Frozen
from crankpin._support.quantities import QUANTITIES
from crankpin._support.tables import Table
from crankpin.analysis.source import Source, shown_orders

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray


class Ellipse(NamedTuple):
    """Ellipse that a force or moment traces in one order, or ellipses as arrays."""

    major: Any
    """Longest half axis, N or N·m."""
    minor: Any
    """Shortest half axis, N or N·m; negative where the vector turns against the crank."""
    tilt_deg: Any
    """Direction of the long axis from +x, degrees in (−90, 90]; 0 for a circle."""


class Quantity(NDArrayOperatorsMixin, Frozen):
    """Peak phasors of a quantity as a read-only array, orders after the swept dimensions."""

    _fields: ClassVar[tuple[str, ...]] = ("source", "name", "place")
    _components: ClassVar[tuple[str, ...]] = ()
    """Dimensions after the orders."""

    source: Source
    """Arrays of the result that the quantity belongs to."""
    name: str
    """``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``."""
    place: int | None
    """Place of the order among those of the result; None for all orders."""

    def __init__(self, source: Source, name: str, place: int | None = None) -> None:
        source.request.check(name)
        self._set(source=source, name=name, place=place)

    @property
    def unit(self) -> str:
        """Unit: N for a force, N·m for a moment or a torque."""
        return QUANTITIES[self.name].unit

    @property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        orders = self.source.orders
        return orders if self.place is None else (orders[self.place],)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the array's dimensions."""
        order = ("order",) if self.place is None else ()
        return (*self.source.dims, *order, *self._components)

    @property
    def peak(self) -> NDArray[np.float64]:
        """Largest magnitude of each order, N or N·m: (…, n_orders)."""
        return self._read("peak")  # type: ignore[no-any-return]

    @property
    def zero_bound(self) -> NDArray[np.float64]:
        """Largest rounding error of a sum that vanishes, N or N·m: (…, n_orders).

        Phasors below it are reported as exactly zero.
        """
        return self._read("zero_bound")  # type: ignore[no-any-return]

    def _read(self, what: str) -> Any:  # noqa: ANN401 - an array, or a number of one order
        values = self.source.read(self.name, what)
        if self.place is None:
            return values
        axis = len(self.source.dims)
        return values[(slice(None),) * axis + (self.place,)]

    # --- an array of phasors --------------------------------------------------------------------

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:  # noqa: ANN401
        return np.array(self._read("phasors"), dtype=dtype, copy=copy)

    def __array_ufunc__(
        self,
        ufunc: np.ufunc,
        method: Any,  # noqa: ANN401 - as NumPy calls it
        *arguments: Any,  # noqa: ANN401
        **keywords: Any,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401
        if any(isinstance(out, Quantity) for out in keywords.get("out", ())):
            return NotImplemented
        plain = [np.asarray(a) if isinstance(a, Quantity) else a for a in arguments]
        return getattr(ufunc, method)(*plain, **keywords)

    def __getitem__(self, key: Any) -> Any:  # noqa: ANN401 - as of an array
        return self._read("phasors")[key]

    def __len__(self) -> int:
        return len(self._read("phasors"))

    def __iter__(self) -> Iterator[Any]:
        return iter(self._read("phasors"))

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        return np.shape(self._read("phasors"))

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    @property
    def dtype(self) -> np.dtype[np.complex128]:
        """Type of the phasors: complex128."""
        return np.dtype(np.complex128)

    @property
    def real(self) -> NDArray[np.float64]:
        """Real parts of the phasors: the value at θ = 0, N or N·m."""
        return np.real(np.asarray(self))

    @property
    def imag(self) -> NDArray[np.float64]:
        """Imaginary parts of the phasors, N or N·m."""
        return np.imag(np.asarray(self))

    def conj(self) -> NDArray[np.complex128]:
        """Return the conjugates of the phasors, N or N·m."""
        return np.asarray(np.conj(np.asarray(self)))

    def any(self) -> bool:
        """Return True if any phasor is not zero."""
        return bool(np.any(np.asarray(self)))

    # --- text -----------------------------------------------------------------------------------

    def _columns(self) -> dict[str, NDArray[np.float64]]:
        """Columns of the table of a balance: head → (n_orders,)."""
        raise NotImplementedError

    @property
    def table(self) -> Table:
        """Table that a quantity of a balance shows."""
        shown, omitted = shown_orders(self.source, self.name)
        columns = self._columns()
        rows = np.stack([values[list(shown)] for values in columns.values()], axis=-1)
        title = f"{QUANTITIES[self.name].words}, {self.unit}"
        names = [str(self.source.orders[place]) for place in shown]
        return Table.from_rows(
            title, ["order", *columns], names, rows.reshape(-1, len(columns)),
            note=labels.not_shown(omitted),
        )  # fmt: skip

    def __repr__(self) -> str:
        name = QUANTITIES[self.name].words
        if self.source.dims:
            over = ", ".join(f"{d}: {n}" for d, n in zip(self.dims, self.shape, strict=True))
            return f"<{type(self).__name__} {name}, {self.unit}, over ({over})>"
        if self.place is not None:
            peak = f"{self.peak:.5g} {self.unit}"
            return f"<{type(self).__name__} {name} of order {self.orders[0]}: peak {peak}>"
        return self.table.text()

    def _repr_html_(self) -> str | None:
        if self.source.dims or self.place is not None:
            return None
        return self.table.html()


class PlaneVector(Quantity):
    """Force or moment in the cross-section plane: peak phasors along (about) x and y.

    An array of complex peak phasors, (…, n_orders, 2). Order n is ``Re(P exp(inθ))``, and
    ``x + iy = forward exp(inθ) + backward exp(−inθ)``: ``forward`` turns with the crank, so that a
    counterweight can cancel it at order 1; ``backward`` turns against it.

    Examples
    --------
    >>> import crankpin as cp
    >>> moment = cp.Engine.preset("v8-crossplane").balance(rpm=6000, orders=[1, 2]).moment
    >>> moment.shape, moment.unit
    ((2, 2), 'N·m')
    >>> float(abs(moment.backward[0]))
    0.0
    """

    _components = ("axis",)

    @property
    def xy(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) x and y, N or N·m: (…, n_orders, 2)."""
        return self._read("phasors")  # type: ignore[no-any-return]

    @property
    def x(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) x, N or N·m: (…, n_orders)."""
        return self.xy[..., 0]

    @property
    def y(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) y, N or N·m: (…, n_orders)."""
        return self.xy[..., 1]

    @property
    def forward(self) -> NDArray[np.complex128]:
        """Part that turns with the crank, N or N·m: (…, n_orders)."""
        return self._read("forward")  # type: ignore[no-any-return]

    @property
    def backward(self) -> NDArray[np.complex128]:
        """Part that turns against the crank, N or N·m: (…, n_orders)."""
        return self._read("backward")  # type: ignore[no-any-return]

    @property
    def peak(self) -> NDArray[np.float64]:
        """Length of the longest vector of each order, N or N·m: (…, n_orders)."""
        return self._read("peak")  # type: ignore[no-any-return]

    @property
    def peak_xy(self) -> NDArray[np.float64]:
        """Peaks of each order along (about) x and y, N or N·m: (…, n_orders, 2)."""
        return self._read("peak_xy")  # type: ignore[no-any-return]

    @property
    def ellipse(self) -> Ellipse:
        """Ellipses that the vector traces, each field (…, n_orders)."""
        forward, backward = self.forward, self.backward
        f, b = np.abs(forward), np.abs(backward)
        directed = (f != 0.0) & (b != 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            # Half the sum of the phases; of the two directions of the axis the upper one.
            tilt = np.angle(np.sqrt(forward / f * (backward / b)), deg=True)
        tilt = np.where(tilt <= -90.0, 90.0, np.where(directed, tilt, 0.0))
        parts = (f + b, f - b, tilt)
        if self.place is not None and not self.source.dims:
            return Ellipse(*map(float, parts))
        for part in parts:
            part.setflags(write=False)
        return Ellipse(*parts)

    def _columns(self) -> dict[str, NDArray[np.float64]]:
        along = QUANTITIES[self.name].symbols
        letter = along[0][1]
        return {
            along[0]: self.peak_xy[:, 0],
            along[1]: self.peak_xy[:, 1],
            f"|{letter}|": self.peak,
            "forward": np.abs(self.forward),
            "backward": np.abs(self.backward),
        }


class Scalar(Quantity):
    """Torque about z: peak phasors, (…, n_orders).

    Order n is ``Re(P exp(inθ))``.

    Examples
    --------
    >>> import crankpin as cp
    >>> torque = cp.Engine.preset("i4").balance(rpm=6000, orders=[2, 4]).torque
    >>> torque.shape, torque.unit
    ((2,), 'N·m')
    """

    @property
    def phasor(self) -> NDArray[np.complex128]:
        """Peak phasors, N·m: (…, n_orders)."""
        return self._read("phasors")  # type: ignore[no-any-return]

    def _columns(self) -> dict[str, NDArray[np.float64]]:
        return {QUANTITIES[self.name].symbols[0]: self.peak}
