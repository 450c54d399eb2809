"""Force, moment or torque of a balance or sweep: an order is a key, the phasors are an array."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Generic, Literal, Self, TypeAlias

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.quantities import Kind, kind_of, parts_of
from crankpin._support.record import AbsentError, AbsentItemError, Record, changed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis import export

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from typing_extensions import TypeVar

    from crankpin._core import InputError
    from crankpin._support.inputs import Order
    from crankpin.analysis.by_order import ByOrder

    # Defaults, which Python has from 3.13 on: annotations need not name the parameters.
    Values = TypeVar("Values", default=Any)
    Value = TypeVar("Value", default=Any)
else:
    from typing import TypeVar

    Values = TypeVar("Values")
    """Type of ``peak`` of a quantity: an array of all orders, a number of one of a balance."""
    Value = TypeVar("Value")
    """Type of ``peak`` of one of its orders: a number of a balance, an array of a sweep."""

ALL: Literal["all"] = "all"
"""Key of all orders together."""
Key: TypeAlias = 'Order | Literal["all"] | None'
"""An order, ``"all"`` for all orders together, None for arrays of every order."""


def order_key(order: object) -> Order | Literal["all"]:
    """Return a key that was given, or raise an InputError."""
    if isinstance(order, str) and order == ALL:
        return ALL
    try:
        if 0 < (number := inputs.order(order)) <= _core.HIGHEST_ORDER:
            return number
    except (TypeError, ValueError, OverflowError):
        pass
    hint = 'the key is an order, a multiple of crank speed such as 2 or 0.5, or "all"'
    if isinstance(order, str):
        hint += "; quantities are attributes, as in b.force, swept values are in coords"
    if isinstance(order, (slice, tuple)) or order is ... or order is None:
        hint += "; arrays of all orders are in xy, forward, backward and peak"
    raise inputs.rejected("order", order, hint)


def one_order(order: object) -> Order:
    """Return the order of a key, or raise an InputError, also for all orders together."""
    key = order_key(order)
    if isinstance(key, str):
        raise inputs.rejected("order", ALL, "give one order, such as 2 or 0.5")
    return key


class Keyed:
    """Mixin of what has orders as keys."""

    if TYPE_CHECKING:

        @property
        def orders(self) -> tuple[Order, ...]:
            """Multiples of crank speed: ints, and floats for halves."""

    def __contains__(self, order: object) -> bool:
        try:
            return inputs.order(order) in self.orders
        except (TypeError, ValueError, OverflowError):
            return False

    def __iter__(self) -> Iterator[Order]:
        return iter(self.orders)

    def __len__(self) -> int:
        return len(self.orders)

    def _place(self, order: object) -> int:
        """Return the index of an order, or raise an InputError."""
        if order not in self:
            hint = f"choose from {labels.orders_text(self.orders)}"
            raise inputs.rejected("order", order, hint, AbsentItemError)
        return self.orders.index(inputs.order(order))

    def __reversed__(self) -> Iterator[Order]:
        return reversed(self.orders)


# --- quantities ---------------------------------------------------------------------------------


class Quantity(Keyed, NDArrayOperatorsMixin, Tabled, Generic[Values, Value]):
    """Peak phasors of a quantity: of every order as an array, of one order, or of all together.

    Order n is ``Re(P exp(inθ))``. ``moment[2]`` is order 2, ``2 in moment`` says whether it is
    among ``orders``; ``moment.peak`` is an array in the sequence of ``orders``, ``moment[2].peak``
    that of order 2, ``total.moment.peak`` that of all orders together. In arithmetic and for NumPy
    a quantity is the array of its phasors, orders after the swept dimensions.

    Force and moment are vectors in the cross-section plane with phasors along (about) x and y, and
    ``x + iy = forward exp(inθ) + backward exp(−inθ)``: ``forward`` turns with the crank, so that a
    counterweight can cancel it at order 1; ``backward`` turns against it. A torque has one phasor
    an order, about z; :class:`AttributeError` for what only a vector has.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("v8-crossplane").balance(rpm=6000, orders=[1, 2])
    >>> b.moment.shape, b.moment.unit, b.torque.shape
    ((2, 2), 'N·m', (2,))
    >>> b.moment[2].status
    'zero, proved'
    """

    result: ByOrder[Value]
    """Balance or sweep that the quantity belongs to."""
    name: str
    """``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``, or a part: ``"torque.gas"``."""
    order: Key = None
    """The order; ``"all"`` for all orders together, None for every order."""

    def __post_init__(self) -> None:
        self.result.request.check(self.name, self.result)

    @property
    def kind(self) -> Kind:
        """Entry of the registry: name, symbols, unit and components."""
        return kind_of(self.name)

    @property
    def unit(self) -> str:
        """Unit: N for a force, N·m for a moment or a torque."""
        return self.kind.unit

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.result.orders if self.order is None or self.order == ALL else (self.order,)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the array's dimensions."""
        order = ("order",) if self.order is None else ()
        axis = ("axis",) if self.kind.planar else ()
        return (*self.result.dims, *order, *axis)

    @property
    def peak(self) -> Values:
        """Largest magnitude, N or N·m: (…, n_orders); of all orders together over θ: (…).

        Of a vector the length of the longest.
        """
        return self._read("peak")  # type: ignore[no-any-return]

    @property
    def xy(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) x and y, N or N·m: (…, n_orders, 2)."""
        return self._planar("phasors", "xy")  # type: ignore[no-any-return]

    @property
    def x(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) x, N or N·m: (…, n_orders)."""
        return self._planar("phasors", "x")[..., 0]  # type: ignore[no-any-return]

    @property
    def y(self) -> NDArray[np.complex128]:
        """Peak phasors along (about) y, N or N·m: (…, n_orders)."""
        return self._planar("phasors", "y")[..., 1]  # type: ignore[no-any-return]

    @property
    def forward(self) -> NDArray[np.complex128]:
        """Part that turns with the crank, N or N·m: (…, n_orders)."""
        return self._planar("forward")  # type: ignore[no-any-return]

    @property
    def backward(self) -> NDArray[np.complex128]:
        """Part that turns against the crank, N or N·m: (…, n_orders)."""
        return self._planar("backward")  # type: ignore[no-any-return]

    @property
    def peak_xy(self) -> NDArray[np.float64]:
        """Peaks along (about) x and y, N or N·m: (…, n_orders, 2); of all together: (…, 2)."""
        return self._planar("peak_xy")  # type: ignore[no-any-return]

    @property
    def minor(self) -> Values:
        """Shortest half axis of the ellipse that a vector traces, N or N·m: (…, n_orders).

        Negative where it turns against the crank, 0 on a straight line. ``peak`` is the longest.
        """
        forward, backward = (self._planar(part, "minor") for part in labels.TURNING)
        return self._of_one_order(np.abs(forward) - np.abs(backward))

    @property
    def tilt_deg(self) -> Values:
        """Direction of the longest half axis from +x, degrees in (−90, 90]: (…, n_orders).

        0 for a circle.
        """
        forward, backward = (self._planar(part, "tilt_deg") for part in labels.TURNING)
        return self._of_one_order(_core.tilts_deg(np.asarray(forward), np.asarray(backward)))

    def _of_one_order(self, values: Any) -> Values:  # noqa: ANN401 - an array
        """Return an array read-only, the value of one order of a balance as a number."""
        return read_only(values) if np.ndim(values) else float(values)  # type: ignore[return-value]

    @property
    def phasor(self) -> NDArray[np.complex128]:
        """Peak phasors of a torque, N·m: (…, n_orders)."""
        if self.kind.planar:
            raise self._absent("phasor", f"{self.name} has two per order; use xy, x or y")
        return self._read("phasors")  # type: ignore[no-any-return]

    @property
    def parts(self) -> tuple[str, ...]:
        """Causes of the quantity by name: ``inertia``, ``gas`` and those of further loads."""
        return tuple(name.partition(".")[-1] for name in parts_of(self.name, self.result.causes))

    def part(self, name: str) -> Self:
        """Return the part of the quantity that one name makes.

        Parameters
        ----------
        name : str
            One of ``parts``: ``"inertia"``, ``"gas"``, or the name of a load, see
            :meth:`Engine.with_loads`.

        Returns
        -------
        Quantity
            The part; all parts add up to the whole.

        Raises
        ------
        InputError
            If nothing of this name makes any.

        Examples
        --------
        >>> import crankpin as cp
        >>> fan = cp.PeriodicLoad("fan", on="shaft", force={4: 12}, z=-0.1)
        >>> b = cp.Engine.preset("i4").with_loads([fan]).balance(rpm=1000)
        >>> b.force.parts, float(b.force.part("fan")[4].peak)
        (('inertia', 'fan'), 12.0)
        """
        if "." in self.name:
            raise self._absent("part", "it is one; read it of the whole")
        known = self.result.request.parts(self.name, self.result.causes)
        return changed(self, name=f"{self.name}.{inputs.one_of('name', name, known)}")

    @property
    def gas(self) -> Self:
        """Part of a torque that is due to gas pressure."""
        return self._part("gas")

    @property
    def inertia(self) -> Self:
        """Part that is due to inertia forces; of a force or a moment where loads make another."""
        return self._part("inertia")

    @property
    def mean(self) -> Value:
        """Mean of a torque over the cycle, N·m: (…); zero without gas pressure."""
        if self.kind.planar or self.order not in (None, ALL):
            raise self._absent("mean", "give a torque, all orders together, as in b.torque.mean")
        values = self.result.read(self.name, "mean")
        mean: Any = values if values.ndim else float(values)
        return mean  # type: ignore[no-any-return]

    @property
    def zero_bound(self) -> Values:
        """Largest rounding error of a sum that vanishes, N or N·m: (…, n_orders).

        Phasors below it are reported as exactly zero.
        """
        return self._read("zero_bound")  # type: ignore[no-any-return]

    @property
    def error_bound(self) -> float:
        """Upper bound on what the omitted orders add at any crank angle, N or N·m."""
        return self.result.error_bound[self.name.partition(".")[0]]

    @property
    def status(self) -> str:
        """Whether one order of a balance counts in the total, and why it is zero.

        ``"summed"``; ``"omitted"``: not zero, left out of the total within its ``error_bound``, or
        because ``orders=`` was given without it; ``"zero, proved"``: decided in integers, as by
        :meth:`Engine.vanishing_orders`; ``"zero within rounding"``: below its ``zero_bound``.
        """
        if self.order is None or self.order == ALL:
            raise self._absent("status", 'give one order, as in "moment[2].status"')
        if np.any(self._read("phasors")):
            return "summed" if self.order in self.result.orders else "omitted"
        proved = self.result._proved_zero(self.name, self.order)
        return "zero, proved" if proved else "zero within rounding"

    def _read(self, what: str) -> Any:  # noqa: ANN401 - an array, or a number of one order
        if self.order is None:
            return self.result.read(self.name, what)
        if self.order != ALL:
            return self.result._read_order(self.order, self.name, what)
        if what not in ("peak", "peak_xy"):
            hint = f"as in b[2], or read the arrays of a balance, as in b.{self.name}"
            raise self._absent(what, f"all orders together have peaks alone; give an order, {hint}")
        values = self.result.read(self.name, f"total_{what}")
        return values if values.ndim else float(values)

    def _part(self, part: str) -> Self:
        if "." in self.name or (self.kind.planar and part not in self.parts):
            raise self._absent(part, "give torque or crank_torque, which have it")
        return changed(self, name=f"{self.name}.{part}")

    def _absent(self, what: str, hint: str) -> InputError:
        return inputs.faulty(what, f"is undefined for {self.name}", hint, AbsentError)

    def _planar(self, what: str, name: str = "") -> Any:  # noqa: ANN401 - as above
        """Return an array of a vector; of a torque raise an error that names what is read."""
        if not self.kind.planar:
            fault = f"is that of a vector; {self.name} is about z alone"
            raise inputs.faulty(name or what, fault, "it has phasor and peak", AbsentError)
        return self._read(what)

    def __getitem__(self, order: Order | Literal["all"]) -> Quantity[Value, Value]:
        """Return the quantity at one order, or at ``"all"``, of the orders that it has."""
        whole: Quantity[Any, Any] = self
        return changed(whole, order=order_key(order))

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
        try:
            return getattr(ufunc, method)(*plain, **keywords)
        except (ValueError, OverflowError, ZeroDivisionError) as error:
            hint = f"give numbers, or an array that broadcasts ({inputs.reason(error)})"
            raise inputs.rejected(f"operands of {ufunc.__name__}", arguments, hint) from None

    def __eq__(self, other: object) -> Any:  # noqa: ANN401 - an array, or a bool
        """Return where phasors are equal, as of arrays; False for what is no array of their shape.

        All orders together have no phasors: they are equal as other results are.
        """
        if self.order == ALL or (isinstance(other, Quantity) and other.order == ALL):
            return isinstance(other, Quantity) and Record.__eq__(self, other)
        try:
            return np.equal(self, other)  # type: ignore[call-overload] # of anything
        except (TypeError, ValueError, OverflowError):
            return False

    def __ne__(self, other: object) -> Any:  # noqa: ANN401 - as above
        equal = self == other
        return not equal if isinstance(equal, bool) else np.logical_not(equal)

    __hash__ = None  # type: ignore[assignment] # equal item by item, as arrays are

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        if self.order == ALL:
            return np.shape(self._read("phasors"))
        orders = (len(self.orders),) if self.order is None else ()
        return (*self._swept, *orders, *((2,) if self.kind.planar else ()))

    @property
    def _swept(self) -> tuple[int, ...]:
        """Lengths of the dimensions before orders and axes."""
        return tuple(len(values) for values in self.result.coords.values())

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    def any(self) -> bool:
        """Return True if any phasor is not zero.

        Returns
        -------
        bool
            Whether one is not exactly zero.
        """
        return bool(np.any(np.asarray(self)))

    # --- text -----------------------------------------------------------------------------------

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; of a force or a moment without gas."""
        if self.result.request.pairs is not None or not self.kind.planar:
            return self.result.loads_counted
        return labels.without_gas(self.result.loads_counted)

    def _columns(self) -> dict[str, str]:
        """Head of each column of the table → array that it shows."""
        if not self.kind.planar:
            return {self.kind.symbols[0]: "peak"}
        parts = {self.kind.vector_symbol: "peak", "forward": "forward", "backward": "backward"}
        return {head: f"peak_xy.{k}" for k, head in enumerate(self.kind.symbols)} | parts

    @property
    def table(self) -> Table:
        """Peaks by order, and of all orders together; those of a sweep at each point.

        Torques of a fired engine have their mean, their phases and their parts too.
        """
        keys: tuple[Order | Literal["all"], ...] = (self.order,) if self.order is not None else ()
        note = ""
        if self.order is None:
            shown, left_out = self.result._shown_orders(self.name)
            keys, note = (*(self.orders[k] for k in shown), ALL), labels.not_shown(left_out)
        title = f"{self.kind.words}, {self.unit}"
        if self.result.dims:
            columns = export.points(self.result.coords, len(keys))
            columns += [
                Column(ALL if key == ALL else f"order {key}", self[key]._read("peak"))
                for key in keys
            ]
        elif self._has_means:
            title, columns = self.kind.words, self._columns_of_parts(keys)
        else:
            columns = [Column("order", keys)]
            columns += [
                Column(head, tuple(self[key]._figure(what) for key in keys))
                for head, what in self._columns().items()
            ]
        whole = title == f"{self.kind.words}, {self.unit}"
        row_units = (self.unit,) * len(columns[0]) if whole and columns else ()
        return Table(title, tuple(columns), note, self.loads_counted, row_units)

    @property
    def _has_means(self) -> bool:
        """True of a torque that more than inertia may make."""
        return not self.kind.planar and self.result._has_means

    def _figure(self, what: str) -> float | None:
        """Return a figure of one order of a balance; None where all together have none."""
        name, _, axis = what.partition(".")
        if self.order == ALL and not name.startswith("peak"):
            return None
        values = np.abs(self._read(name))
        return float(values[int(axis)] if axis else values)

    def _columns_of_parts(self, keys: Sequence[Order | Literal["all"]]) -> list[Column]:
        """Return mean, peaks and phases of a torque and of its parts."""
        columns = [Column("order", ("mean", *keys))]
        parts = [self, *map(self.part, self.parts)]
        least = self.result._least_shown(np.asarray(self.peak))
        for part in parts:
            peaks = [part[key]._figure("peak") for key in keys]
            phases = [
                None if key == ALL or not peak else float(np.angle(part[key].phasor, deg=True))
                for key, peak in zip(keys, peaks, strict=True)
            ]
            name = "" if part is self else part.name.partition(".")[-1]
            mean = changed(part, order=None).mean
            head = name or self.kind.symbols[0]
            columns += [
                Column(head, (mean, *peaks), self.unit, least=least),
                Column(f"{name} phase".strip(), (None, *phases), "°", digits=4),
            ]
        return columns

    @property
    def _brief(self) -> str:
        if not self.result.dims and self.order is None:
            return ""
        name = self.kind.words
        which = f" of {'all orders' if self.order == ALL else f'order {self.order}'}"
        loads = f", {self.loads_counted}" if self.loads_counted else ""
        if not self.result.dims:
            highest: Any = self.peak
            peak = units.figure(highest, self.unit, 5)
            return f"<Quantity {name}{which}: peak {peak}{loads}>"
        dims, shape = self.result.dims, self._swept
        if self.order is None:
            dims, shape, which = self.dims, self.shape, ""
        over = ", ".join(f"{d}: {n}" for d, n in zip(dims, shape, strict=True))
        return f"<Quantity {name}{which}, {self.unit}, over ({over}){loads}>"


class Quantities(Generic[Values, Value]):
    """Mixin of what has force, moment and torques."""

    def _quantity(self, name: str) -> Quantity[Values, Value]:
        raise NotImplementedError

    @property
    def force(self) -> Quantity[Values, Value]:
        """Shaking force along x and y, N."""
        return self._quantity("force")

    @property
    def moment(self) -> Quantity[Values, Value]:
        """Rocking moment about x (pitch) and y (yaw), N·m."""
        return self._quantity("moment")

    @property
    def torque(self) -> Quantity[Values, Value]:
        """Roll torque of inertia forces, and of gas if it counts, on the block about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return self._quantity("torque")

    @property
    def crank_torque(self) -> Quantity[Values, Value]:
        """Torque of inertia forces, and of gas if it counts, on the crank about +z, N·m.

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        return self._quantity("crank_torque")


class OrderBalance(Quantities[Value, Value], Tabled, Generic[Value]):
    """One order of a balance or sweep, or all orders together: the quantities without orders.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("i4").balance(rpm=6000)
    >>> b[2].order, b[2].force.shape, float(b[2].force.x.real)
    (2, (2,), 0.0)
    >>> b["all"] == b.total
    True
    >>> b[2]
    Inline-4 at 6000 rpm: order 2
    quantity        unit  x       y  largest  forward  backward  status
    shaking force   N     0  9269.4   9269.4   4634.7    4634.7  summed
    rocking moment  N·m   0       0        0        0         0  zero, proved
    roll torque     N·m   –       –   657.31        –         –  summed
    crank torque    N·m   –       –   657.31        –         –  summed
    Without gas pressure.
    """

    result: ByOrder[Value]
    """Balance or sweep that it belongs to."""
    order: Order | Literal["all"]
    """Multiple of crank speed, or ``"all"``."""

    def _quantity(self, name: str) -> Quantity[Value, Value]:
        return Quantity(self.result, name, self.order)

    @property
    def table(self) -> Table:
        """Peaks along (about) x and y, the largest, and its parts; of a sweep at each point.

        The status is that of :attr:`Quantity.status`.
        """
        if self.result.dims:
            return self._table_by_point()
        parts = () if self.order == ALL else ("forward", "backward")
        rows: list[tuple[str | float | None, ...]] = []
        for each in self._each():
            beside: list[float | None] = [None] * (2 + len(parts))
            if each.kind.planar:
                beside = [*each.peak_xy.tolist(), *(abs(getattr(each, part)) for part in parts)]
            status = () if self.order == ALL else (each.status,)
            row = (*beside[:2], each.peak, *beside[2:], *status)
            rows.append((each.kind.words, each.unit, *row))
        heads = ["quantity", "unit", "x", "y", "largest", *parts]
        heads += [] if self.order == ALL else ["status"]
        speed = labels.at_speed(self.result._attributes["rpm"])
        title = f"{labels.name_of(self.result._engines[0])} {speed}: {self._which}"
        row_units = [each.unit for each in self._each()]
        return Table.from_rows(title, heads, rows, loads=self.loads_counted, row_units=row_units)

    def _table_by_point(self) -> Table:
        """Return the largest peak of each quantity of a sweep at each point."""
        shown = list(self._each())
        columns = export.points(self.result.coords, len(shown))
        columns += [Column(each.kind.vector_symbol, each.peak, each.unit) for each in shown]
        title = f"Peaks of {self._which}"
        return Table(title, tuple(columns), loads=self.loads_counted)

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as of the balance or sweep."""
        return self.result.loads_counted

    def _each(self) -> Iterator[Quantity]:
        """Yield the quantities, and their parts where more than inertia makes them."""
        for name in self.result.request.quantities:
            whole: Quantity = getattr(self, name)
            yield whole
            yield from map(whole.part, whole.parts)

    @property
    def _which(self) -> str:
        return "all orders" if self.order == ALL else f"order {self.order}"

    @property
    def _brief(self) -> str:
        if not self.result.dims:
            return ""
        lines = (f"  {getattr(self, name)!r}" for name in self.result.request.quantities)
        return "\n".join([f"<OrderBalance of {self._which}>", *lines])
