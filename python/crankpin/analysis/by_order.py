"""Results order by order: force, moment and torques as phasors, an order as a key, totals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, Self, TypeAlias

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.absent import AbsentError
from crankpin._support.quantities import QUANTITIES, Kind
from crankpin._support.record import Record, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis import export
from crankpin.analysis.request import check_quantities

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from crankpin._support.inputs import Spectrum
    from crankpin.analysis.request import Request

ALL: Literal["all"] = "all"
"""Key of all orders together."""
Key: TypeAlias = 'int | Literal["all"] | None'
"""An order, ``"all"`` for all orders together, None for arrays of every order."""


class ErrorBound(NamedTuple):
    """Upper bounds on what the omitted orders add to the length of a vector at any crank angle."""

    force: float
    """Of the shaking force, N."""
    moment: float
    """Of the rocking moment, N·m."""
    torque: float | None
    """Of roll and crank torque, N·m; None where torque is not available."""


class Ellipse(NamedTuple):
    """Ellipse that a force or moment traces in one order, or ellipses as arrays."""

    major: Any
    """Longest half axis, N or N·m."""
    minor: Any
    """Shortest half axis, N or N·m; negative where the vector turns against the crank."""
    tilt_deg: Any
    """Direction of the long axis from +x, degrees in (−90, 90]; 0 for a circle."""


def order_key(order: object) -> int | Literal["all"]:
    """Return a key that was given, or raise an InputError."""
    if isinstance(order, str) and order == ALL:
        return ALL
    if isinstance(order, (int, np.integer)) and not isinstance(order, bool) and order > 0:
        return int(order)
    hint = 'the key is an order, a whole multiple of crank speed such as 2, or "all"'
    if isinstance(order, (slice, tuple)) or order is ... or order is None:
        hint += "; arrays of all orders are in xy, forward, backward and peak"
    raise InputError(f"order = {inputs.shorten(order)}: {hint}")


# --- quantities ---------------------------------------------------------------------------------


class Quantity(NDArrayOperatorsMixin, Record):
    """Peak phasors of a quantity: of every order as an array, of one order, or of all together.

    ``moment[2]`` is order 2, ``2 in moment`` says whether it is among ``orders``. In arithmetic and
    for NumPy a quantity is the array of its phasors, orders after the swept dimensions.
    """

    result: ByOrder
    """Balance or sweep that the quantity belongs to."""
    name: str
    """``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``."""
    order: Key = None
    """The order; ``"all"`` for all orders together, None for every order."""

    _components: ClassVar[tuple[str, ...]] = ()
    """Dimensions after the orders."""

    def __post_init__(self) -> None:
        self.result.request.check(self.name)

    @property
    def kind(self) -> Kind:
        """Entry of the registry: name, symbols, unit and components."""
        return QUANTITIES[self.name]

    @property
    def unit(self) -> str:
        """Unit: N for a force, N·m for a moment or a torque."""
        return self.kind.unit

    @property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        return (self.order,) if isinstance(self.order, int) else self.result.orders

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the array's dimensions."""
        order = ("order",) if self.order is None else ()
        return (*self.result.dims, *order, *self._components)

    @property
    def peak(self) -> Any:  # noqa: ANN401 - a number of one order of a balance
        """Largest magnitude, N or N·m: (…, n_orders); of all orders together over θ: (…)."""
        return self._read("peak")

    @property
    def zero_bound(self) -> Any:  # noqa: ANN401 - as above
        """Largest rounding error of a sum that vanishes, N or N·m: (…, n_orders).

        Phasors below it are reported as exactly zero.
        """
        return self._read("zero_bound")

    @property
    def error_bound(self) -> float:
        """Upper bound on what the omitted orders add at any crank angle, N or N·m."""
        bound = float(getattr(self.result.error_bound, self.kind.bound))
        lever = sum(map(abs, self.result.request.aside)) if self.name == "torque" else 0.0
        return bound + lever * self.result.error_bound.force

    @property
    def status(self) -> str:
        """Whether one order of a balance counts in the total, and why it is zero.

        ``"summed"``; ``"omitted"``: not zero, left out of the total within its ``error_bound``, or
        because ``orders=`` was given without it; ``"zero, proved"``: decided in integers, as by
        :meth:`Engine.vanishing_orders`; ``"zero within rounding"``: below its ``zero_bound``.
        """
        if not isinstance(self.order, int):
            raise AbsentError(
                'status is that of one order: give an order, as in "moment[2].status"'
            )
        if np.any(self._read("phasors")):
            return "summed" if self.order in self.result.orders else "omitted"
        proved = self.result.proved_zero(self.name, self.order)
        return "zero, proved" if proved else "zero within rounding"

    def _read(self, what: str) -> Any:  # noqa: ANN401 - an array, or a number of one order
        if self.order is None:
            return self.result.read(self.name, what)
        if self.order != ALL:
            one = self.result.with_order(self.order)
            at = (slice(None),) * len(one.dims) + (one.orders.index(self.order),)
            return one.read(self.name, what)[at]
        if what not in ("peak", "peak_xy"):
            raise AbsentError(
                "all orders together have peaks alone; give an order, as in b[2], or read the "
                f"arrays of a balance, as in b.{self.name}"
            )
        values = self.result.read(self.name, f"total_{what}")
        return values if values.ndim else float(values)

    def __getitem__(self, order: int | Literal["all"]) -> Self:
        """Return the quantity at one order, or at ``"all"``, of the orders that it has."""
        return self.replace(order=order_key(order))

    def __contains__(self, order: object) -> bool:
        return order in self.orders

    def __iter__(self) -> Iterator[int]:
        return iter(self.orders)

    def __len__(self) -> int:
        return len(self.orders)

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

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        return np.shape(self._read("phasors"))

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    def any(self) -> bool:
        """Return True if any phasor is not zero."""
        return bool(np.any(np.asarray(self)))

    # --- text -----------------------------------------------------------------------------------

    def _columns(self) -> dict[str, str]:
        """Head of each column of the table → array that it shows."""
        return dict(zip(self.kind.symbols, ["peak"], strict=True))

    @property
    def table(self) -> Table:
        """Table that a quantity of a balance shows: peaks by order, and of all orders together."""
        if self.result.dims or self.order is not None:
            raise AbsentError("table is that of a balance's orders: use the table of the result")
        shown, left_out = shown_orders(self.result, self.name)
        columns = [Column("order", (*(self.orders[k] for k in shown), ALL))]
        total = self[ALL]
        for head, what in self._columns().items():
            name, _, axis = what.partition(".")
            values = np.abs(self._read(name))[list(shown)]
            whole = getattr(total, name) if name.startswith("peak") else None
            if axis:
                values, whole = values[:, int(axis)], float(total._read(name)[int(axis)])
            columns.append(Column(head, (*values.tolist(), whole)))
        title = f"{self.kind.words}, {self.unit}"
        return Table(title, tuple(columns), labels.not_shown(left_out))

    def __repr__(self) -> str:
        kind, name = type(self).__name__, self.kind.words
        which = f" of {'all orders' if self.order == ALL else f'order {self.order}'}"
        if self.result.dims:
            dims, shape = self.result.dims, self.peak.shape
            if self.order is None:
                dims, shape, which = self.dims, self.shape, ""
            over = ", ".join(f"{d}: {n}" for d, n in zip(dims, shape, strict=True))
            return f"<{kind} {name}{which}, {self.unit}, over ({over})>"
        if self.order is not None:
            return f"<{kind} {name}{which}: peak {self.peak:.5g} {self.unit}>"
        return repr(self.table)

    def _repr_html_(self) -> str | None:
        plain = self.result.dims or self.order is not None
        return None if plain else self.table._repr_html_()


class PlaneVector(Quantity):
    """Force or moment in the cross-section plane: peak phasors along (about) x and y.

    Order n is ``Re(P exp(inθ))``, and ``x + iy = forward exp(inθ) + backward exp(−inθ)``:
    ``forward`` turns with the crank, so that a counterweight can cancel it at order 1; ``backward``
    turns against it. ``moment.peak`` is an array in the sequence of ``orders``,
    ``moment[2].peak`` that of order 2, ``total.moment.peak`` that of all orders together.

    Examples
    --------
    >>> import crankpin as cp
    >>> moment = cp.Engine.preset("v8-crossplane").balance(rpm=6000, orders=[1, 2]).moment
    >>> moment.shape, moment.unit
    ((2, 2), 'N·m')
    >>> moment[2].status
    'zero, proved'
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
    def peak(self) -> Any:  # noqa: ANN401 - a number of one order of a balance
        """Length of the longest vector, N or N·m: (…, n_orders); of all orders together: (…)."""
        return self._read("peak")

    @property
    def peak_xy(self) -> NDArray[np.float64]:
        """Peaks along (about) x and y, N or N·m: (…, n_orders, 2); of all together: (…, 2)."""
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
        if self.order is not None and not self.result.dims:
            return Ellipse(*map(float, parts))
        return Ellipse(*read_only(parts))

    def _columns(self) -> dict[str, str]:
        along_x, along_y = self.kind.symbols
        return {
            along_x: "peak_xy.0",
            along_y: "peak_xy.1",
            self.kind.vector_symbol: "peak",
            "forward": "forward",
            "backward": "backward",
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


class Quantities:
    """Mixin of what has force, moment and torques."""

    def _quantity(self, name: str) -> Any:  # noqa: ANN401 - a vector or a scalar
        raise NotImplementedError

    @property
    def force(self) -> PlaneVector:
        """Shaking force along x and y, N."""
        return self._quantity("force")  # type: ignore[no-any-return]

    @property
    def moment(self) -> PlaneVector:
        """Rocking moment about x (pitch) and y (yaw), N·m."""
        return self._quantity("moment")  # type: ignore[no-any-return]

    @property
    def torque(self) -> Scalar:
        """Roll torque of the inertia forces on the block about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return self._quantity("torque")  # type: ignore[no-any-return]

    @property
    def crank_torque(self) -> Scalar:
        """Torque of the inertia forces on the crank about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return self._quantity("crank_torque")  # type: ignore[no-any-return]


class OrderBalance(Quantities, Record):
    """One order of a balance or sweep, or all orders together: the quantities without orders.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("i4").balance(rpm=6000)
    >>> b[2].order, b[2].force.shape, float(b[2].force.x.real)
    (2, (2,), 0.0)
    >>> b["all"] == b.total
    True
    """

    result: ByOrder
    """Balance or sweep that it belongs to."""
    order: int | Literal["all"]
    """Multiple of crank speed, or ``"all"``."""

    def _quantity(self, name: str) -> Quantity:
        return CLASSES[name](self.result, name, self.order)

    def __repr__(self) -> str:
        names = self.result.request.quantities
        lines = (f"  {getattr(self, name)!r}" for name in names)
        what = "all orders" if self.order == ALL else f"order {self.order}"
        return "\n".join([f"<OrderBalance of {what}>", *lines])


CLASSES: dict[str, type[Quantity]] = {
    name: PlaneVector if kind.planar else Scalar for name, kind in QUANTITIES.items()
}
"""Quantity → class of its phasors."""


# --- results ------------------------------------------------------------------------------------


class ByOrder(Quantities):
    """Mixin of balances and sweeps: arrays computed when they are first read, orders as keys."""

    request: Request
    """The options of the result, checked."""

    @property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        raise NotImplementedError

    @property
    def omitted(self) -> tuple[int, ...]:
        """With ``orders="auto"``: orders that were left out although they are not zero."""
        raise NotImplementedError

    @property
    def error_bound(self) -> ErrorBound:
        """Upper bounds on what the orders in ``omitted`` and above add at any crank angle.

        Zero where orders were given. Rounding is not included: sums that vanish to within the
        quantities' ``zero_bound`` are zero.
        """
        raise NotImplementedError

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the swept dimensions."""
        return ()

    @property
    def coords(self) -> Mapping[str, Any]:
        """Swept dimension → its values."""
        return {}

    @property
    def attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset of the result."""
        return {}

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum used in place of the slider-crank's harmonics, kg·m, or None."""
        return self.request.spectrum

    @property
    def total(self) -> OrderBalance:
        """All orders together, as in ``total.force.peak`` and ``total.moment.peak_xy``."""
        return OrderBalance(self, ALL)

    def __getitem__(self, order: int | Literal["all"]) -> OrderBalance:
        """Return one order, or with ``"all"`` all of ``orders`` together.

        An order that is not among ``orders`` is computed when it is read: zero where the layout
        cancels it, and else what it is, though it does not count in the total;
        :attr:`PlaneVector.status` says which.

        Raises
        ------
        InputError
            If the key is no whole order.
        """
        return OrderBalance(self, order_key(order))

    def __contains__(self, order: object) -> bool:
        return order in self.orders

    def __iter__(self) -> Iterator[int]:
        return iter(self.orders)

    def __len__(self) -> int:
        return len(self.orders)

    def _quantity(self, name: str) -> Quantity:
        return CLASSES[name](self, name)

    def about(self, point: float | Sequence[float]) -> Self:
        """Return the same result with moments and roll torque about another point.

        Parameters
        ----------
        point
            Position z along the crank, or (x, y, z), m.

        Examples
        --------
        >>> import crankpin as cp
        >>> b = cp.Engine.preset("i4").balance(rpm=6000)
        >>> b[2].moment.peak, round(b.about(0.0)[2].moment.peak, 1)
        (np.float64(0.0), np.float64(1390.4))
        """
        return self.with_request(self.request.about(point))

    # --- arrays ---------------------------------------------------------------------------------

    @property
    def _kept(self) -> dict[Any, Any]:
        """Arrays that were read, and results of orders that were asked for later."""
        return self.__dict__.setdefault("_cache", {})  # type: ignore[no-any-return]

    def read(self, quantity: str, what: str) -> NDArray[Any]:
        """Return one of the arrays of a quantity, read-only: ``"peak"``, ``"phasors"`` and others.

        Computed when it is first read, and kept; threads that read it at once get one array.
        """
        self.request.check(quantity)
        if not isinstance(what, str):
            raise InputError(f"what = {inputs.shorten(what)}: give the name of an array")
        found: NDArray[Any] | None = self._kept.get((quantity, what))
        if found is None:
            there = [what for _, _, what, _ in export.variables([quantity])]
            inputs.one_of("what", what, [*there, "turning"])
            found = read_only(np.asarray(self._about_point(quantity, what)))
            found = self._kept.setdefault((quantity, what), found)
        return found

    def _about_point(self, quantity: str, what: str) -> NDArray[Any]:
        """Compute an array; roll torque about a point beside the crank from that about its axis."""
        x, y = self.request.aside
        if quantity != "torque" or (x == 0.0 and y == 0.0):
            return self._compute(quantity, what)
        if what == "phasors":
            force = self.read("force", "phasors")
            return self._compute(quantity, what) - (x * force[..., 1] - y * force[..., 0])
        if what == "zero_bound":
            bound = (abs(x) + abs(y)) * self.read("force", "zero_bound")
            return self._compute(quantity, what) + bound
        phasors = self.read(quantity, "phasors")
        return np.abs(phasors) if what == "peak" else total_peaks(self.orders, phasors)

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        raise NotImplementedError

    def with_order(self, order: int) -> ByOrder:
        """Return this result if it has an order, else the same of that order alone."""
        if order_key(order) in (*self.orders, ALL):
            return self
        found: ByOrder | None = self._kept.get(order)
        if found is None:
            found = self._kept.setdefault(order, self.at_orders((order,)))
        return found

    def with_request(self, request: Request) -> Self:
        """Return the same result by another request."""
        raise NotImplementedError

    def at_orders(self, orders: tuple[int, ...]) -> Self:
        """Return the same result at the orders given."""
        wanted = inputs.orders(orders)
        if wanted is None:
            raise InputError(f"orders = {inputs.shorten(orders)}: give orders, such as (1, 2)")
        return self.with_request(self.request.at_orders(tuple(wanted)))

    def proved_zero(self, quantity: str, order: int) -> bool:
        """Return whether a quantity of one order is proved to vanish."""
        name = inputs.one_of("quantity", quantity, QUANTITIES)
        raise AbsentError(f"{name}: proofs are those of a balance, not of a sweep")

    # --- tables ---------------------------------------------------------------------------------

    def named(self, quantities: tuple[str, ...]) -> tuple[str, ...]:
        """Return the quantities named, all that there are if none is named."""
        return check_quantities(quantities, self.request.quantities)

    def to_pandas(self, *quantities: str) -> pd.DataFrame:
        """Return a tidy table, one row a point, order, quantity and component (needs pandas).

        Columns are the swept dimensions, order, quantity, component, real and imag (the peak
        phasor), peak and unit.

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[3000, 6000], orders=[2])
        >>> s.to_pandas("torque").columns.tolist()
        ['rpm', 'order', 'quantity', 'component', 'real', 'imag', 'peak', 'unit']
        """
        return export.to_pandas(self, self.named(quantities))

    def to_xarray(self, *quantities: str, split_complex: bool = False) -> xr.Dataset:
        """Return phasors, peaks, totals and bounds with dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
        split_complex
            Store complex arrays as real ones with a dimension ``part`` of "re" and "im". netCDF
            needs it: ``balance.to_xarray(split_complex=True).to_netcdf(path)``.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[1, 2])
        >>> s.to_xarray("force").force.dims
        ('rpm', 'order', 'axis')
        """
        return export.to_xarray(self, self.named(quantities), split_complex=split_complex)


def total_peaks(orders: tuple[int, ...], phasors: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the largest magnitude over θ of the sum of all orders: (…), of (…, n_orders)."""
    flat = np.ascontiguousarray(phasors.reshape(-1, len(orders)))
    return _core.peaks_of_sums(list(orders), flat).reshape(phasors.shape[:-1])


def largest_peaks(result: ByOrder, name: str) -> NDArray[np.float64]:
    """Return the largest peak of each order at any point: (n_orders,)."""
    axes = tuple(range(len(result.dims)))
    found: NDArray[np.float64] = result.read(name, "peak").max(axis=axes, initial=0.0)
    return found


def shown_orders(result: ByOrder, *names: str) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return places of the orders that tables and pictures show, and the orders they leave out.

    Orders chosen automatically are left out where every peak is below :data:`labels.NEGLIGIBLE`
    of the largest peak of its quantity; orders that were given are all shown.
    """
    places = tuple(range(len(result.orders)))
    if result.request.orders is not None:
        return places, ()
    kept = np.zeros(len(places), dtype=bool)
    for name in names:
        peaks = largest_peaks(result, name)
        kept |= peaks > labels.NEGLIGIBLE * peaks.max(initial=0.0)
    if not kept.any():
        return places, ()
    shown = tuple(place for place in places if kept[place])
    return shown, tuple(result.orders[place] for place in places if not kept[place])
