"""The labelled array: a quantity of a result with name, dimensions, coordinates and unit."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any, Generic, Literal, Self, TypeAlias, overload

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import AbsentError, AbsentItemError, Record, changed, read_only
from crankpin.analysis import export
from crankpin.analysis.export import VALUES

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from numpy.typing import NDArray
    from typing_extensions import TypeVar

    from crankpin._core import InputError
    from crankpin._support.inputs import Order
    from crankpin._support.quantities import Kind
    from crankpin._support.tables import Table
    from crankpin.analysis.labelled import Labelled

    # Defaults, which Python has from 3.13 on: annotations need not name the parameters.
    Element = TypeVar("Element", bound=np.generic, default=Any)
    Values = TypeVar("Values", default=Any)
    Value = TypeVar("Value", default=Any)
else:
    from typing import TypeVar

    Element = TypeVar("Element")
    """Type of the values: complex of phasors, float over crank angle."""
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


class ArrayMember:
    """Attribute or method of a quantity's plain array, such as ``max``."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, quantity: object, owner: type | None = None) -> Any:  # noqa: ANN401 - of NumPy
        """Return the member of the array; of the class that of NumPy's arrays."""
        if quantity is None:
            return getattr(np.ndarray, self._name)
        return getattr(np.asarray(quantity), self._name)


class Quantity(Keyed, NDArrayOperatorsMixin, Tabled, Generic[Element, Values, Value]):
    """Labelled array: a quantity of a result, with name, dimensions, coordinates and unit.

    For NumPy it is a plain array, and arithmetic gives plain arrays: ``np.max(w.force)``,
    ``2 * w.torque``, ``w.force[:, 0]``. :meth:`sel` selects by values of coordinates, a text as key
    by name.

    Of results by order the array has peak phasors: order n is ``Re(P exp(inθ))``. There a number as
    key is an order: ``moment[2]`` is order 2, ``2 in moment`` says whether it is among ``orders``;
    ``moment.peak`` is an array in the sequence of ``orders``, ``moment[2].peak`` that of order 2,
    ``total.moment.peak`` that of all orders together. Over crank angle the array has values, and
    ``peak`` is the largest magnitude of these.

    A vector has an axis: ``xy`` in the cross-section plane, ``xyz`` in space. Phasors in the plane
    have parts, ``x + iy = forward exp(inθ) + backward exp(−inθ)``: ``forward`` turns with the
    crank, so that a counterweight can cancel it at order 1; ``backward`` turns against it. A torque
    is about z; :class:`AttributeError` for what only a vector has.

    Examples
    --------
    >>> import crankpin as cp
    >>> v8 = cp.Engine.preset("v8-crossplane")
    >>> b, w = v8.balance(rpm=6000, orders=[1, 2]), v8.waveform(rpm=6000)
    >>> b.moment.shape, b.moment.unit, b.torque.shape
    ((2, 2), 'N·m', (2,))
    >>> b.moment[2].status
    'zero, proved'
    >>> w.moment.dims, w.moment.unit
    (('theta_deg', 'axis'), 'N·m')
    >>> bool(w.moment.sel(theta_deg=90, axis="x") == w.moment[90, 0])
    True
    """

    result: Labelled
    """Result that the quantity belongs to."""
    name: str
    """Its name in the result, such as ``"force"`` or ``"main"``, or a part: ``"torque.gas"``."""
    order: Key = None
    """The order; ``"all"`` for all orders together, None for every order, or where none are."""
    selected: tuple[tuple[str, int], ...] = ()
    """Dimension → index, of those that :meth:`sel` has selected."""

    def __post_init__(self) -> None:
        self.result._check(self.name)

    @property
    def kind(self) -> Kind:
        """Entry of the registry: name, symbols, unit and components."""
        return self.result._kind(self.name)

    @property
    def unit(self) -> str:
        """Unit: N for a force, N·m for a moment or a torque."""
        return self.kind.unit

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed; empty where there are none."""
        if self.order is not None and self.order != ALL:
            return (self.order,)
        return self.result._orders if self.result._is_by_order(self.name) else ()

    @property
    def _by_order(self) -> bool:
        """True if a number as key is an order: of every order, and of all together."""
        return self.order in (None, ALL) and self.result._is_by_order(self.name)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the array's dimensions."""
        return self._dims_of(VALUES)

    def _dims_of(self, what: str) -> tuple[str, ...]:
        """Return the dimensions of one of the quantity's arrays."""
        without = {name for name, _ in self.selected}
        without |= set() if self.order is None else {"order"}
        return tuple(d for d in self.result._dims(self.name, what) if d not in without)

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values, in the sequence of ``dims``."""
        by_dim = self.result._coordinates(self.name)
        coords: Mapping[str, Any] = read_only({name: by_dim[name] for name in self.dims})
        return coords

    @property
    def peak(self) -> Values:
        """Largest magnitude, in ``unit``: (…, n_orders); of all orders together over θ: (…).

        Of a vector the length of the longest. Of values over crank angle the largest: (…).
        """
        return self._read("peak")  # type: ignore[no-any-return]

    @property
    def magnitude(self) -> NDArray[np.float64]:
        """Lengths of vectors, or magnitudes, over crank angle, in ``unit``: (…, n_theta)."""
        return self._read("magnitude")  # type: ignore[no-any-return]

    @property
    def mean_magnitude(self) -> Values:
        """Mean of ``magnitude`` over the crank angles, in ``unit``: (…).

        Each angle counts for the distance between its neighbours (trapezoidal rule), in whichever
        order angles are given.
        """
        return self._read("mean_magnitude")  # type: ignore[no-any-return]

    @property
    def xy(self) -> NDArray[Element]:
        """Values or peak phasors along (about) x and y, in ``unit``: (…, n_orders, 2)."""
        return self._along(VALUES, "xy", 2)  # type: ignore[no-any-return]

    @property
    def xyz(self) -> NDArray[Element]:
        """Peak phasors along x, y and z, in ``unit``: (…, n_orders, n_axes)."""
        return self._along(VALUES, "xyz", 3)  # type: ignore[no-any-return]

    @property
    def x(self) -> NDArray[Element]:
        """Component along (about) x, in ``unit``: (…, n_orders) or (…, n_theta)."""
        return self._along(VALUES, "x")[..., 0]  # type: ignore[no-any-return]

    @property
    def y(self) -> NDArray[Element]:
        """Component along (about) y, in ``unit``: (…, n_orders) or (…, n_theta)."""
        return self._along(VALUES, "y")[..., 1]  # type: ignore[no-any-return]

    @property
    def z(self) -> NDArray[Element]:
        """Component along z, in ``unit``: (…, n_orders)."""
        return self._along(VALUES, "z", 3)[..., 2]  # type: ignore[no-any-return]

    @property
    def forward(self) -> NDArray[np.complex128]:
        """Part that turns with the crank, in ``unit``: (…, n_orders)."""
        return self._along("forward", count=2)  # type: ignore[no-any-return]

    @property
    def backward(self) -> NDArray[np.complex128]:
        """Part that turns against the crank, in ``unit``: (…, n_orders)."""
        return self._along("backward", count=2)  # type: ignore[no-any-return]

    @property
    def peak_xy(self) -> NDArray[np.float64]:
        """Peaks along (about) x and y, in ``unit``: (…, n_orders, 2); of all together: (…, 2)."""
        return self._along("peak_xy", count=2)  # type: ignore[no-any-return]

    @property
    def peak_xyz(self) -> NDArray[np.float64]:
        """Peaks along x, y, z, in ``unit``: (…, n_orders, n_axes); of all together: (…, n_axes)."""
        return self._along("peak_xyz", count=3)  # type: ignore[no-any-return]

    @property
    def rms(self) -> Values:
        """Root mean square of the length, in ``unit``: (…, n_orders); of all together: (…)."""
        return self._read("rms")  # type: ignore[no-any-return]

    @property
    def rms_xyz(self) -> NDArray[np.float64]:
        """Root mean squares along x, y, z, in ``unit``: (…, n_orders, n_axes); (…, n_axes)."""
        return self._along("rms_xyz", count=3)  # type: ignore[no-any-return]

    @property
    def minor(self) -> Values:
        """Shortest half axis of the ellipse that a vector traces, in ``unit``: (…, n_orders).

        Negative where it turns against the crank, 0 on a straight line. ``peak`` is the longest.
        """
        forward, backward = (self._along(part, "minor", 2) for part in labels.TURNING_WORDS)
        return self._of_one_order(np.abs(forward) - np.abs(backward))

    @property
    def tilt_deg(self) -> Values:
        """Direction of the longest half axis from +x, degrees in (−90, 90]: (…, n_orders).

        0 for a circle.
        """
        forward, backward = (self._along(part, "tilt_deg", 2) for part in labels.TURNING_WORDS)
        return self._of_one_order(_core.tilts_deg(np.asarray(forward), np.asarray(backward)))

    def _of_one_order(self, values: Any) -> Values:  # noqa: ANN401 - an array
        """Return an array read-only, the value of one order of a balance as a number."""
        return read_only(values) if np.ndim(values) else float(values)  # type: ignore[return-value]

    @property
    def phasor(self) -> NDArray[np.complex128]:
        """Peak phasors of what is no vector, in ``unit``: (…, n_orders)."""
        if self.kind.axes or not self.orders:
            raise self._absent("phasor", f"{self.name} has values by axis; use xy, x or y")
        return self._read(VALUES)  # type: ignore[no-any-return]

    @property
    def parts(self) -> tuple[str, ...]:
        """Causes of the quantity by name: ``inertia``, ``gas`` and those of further loads."""
        return tuple(name.partition(".")[-1] for name in self.result._parts(self.name))

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
        parts = self.result._named_parts(self.name)
        return changed(self, name=f"{self.name}.{inputs.one_of('name', name, parts)}")

    @property
    def gas(self) -> Self:
        """Part of a torque that is due to gas pressure."""
        return self._part("gas")

    @property
    def inertia(self) -> Self:
        """Part that is due to inertia forces; of a force or a moment where loads make another."""
        return self._part("inertia")

    @property
    def cycle_mean(self) -> Value:
        """Mean of a torque over the cycle, N·m: (…); zero without gas pressure."""
        if self.order not in (None, ALL) or "cycle_mean" not in self.result._readings(self.name):
            hint = "give a torque, all orders together, as in b.torque.cycle_mean"
            raise self._absent("cycle_mean", hint)
        values = self._picked("cycle_mean", self.result.read(self.name, "cycle_mean"))
        mean: Any = values if values.ndim else float(values)
        return mean  # type: ignore[no-any-return]

    @property
    def zero_bound(self) -> Values:
        """Largest rounding error of a sum that vanishes, in ``unit``: (…, n_orders).

        Phasors below it are reported as exactly zero.
        """
        return self._read("zero_bound")  # type: ignore[no-any-return]

    @property
    def error_bound(self) -> float:
        """Upper bound on what the omitted orders add at any crank angle, in ``unit``."""
        bounds, whole = self.result.error_bound, self.name.partition(".")[0]
        if whole not in bounds:
            raise self._absent("error_bound", "it has no bound of its own")
        return bounds[whole]

    @property
    def status(self) -> str:
        """Whether one order of a balance counts in the total, and why it is zero.

        ``"summed"``; ``"omitted"``: not zero, left out of the total within its ``error_bound``, or
        because ``orders=`` was given without it; ``"zero, proved"``: decided in integers, as by
        :meth:`Engine.vanishing_orders`; ``"zero within rounding"``: below its ``zero_bound``.
        """
        if self.order is None or self.order == ALL:
            raise self._absent("status", 'give one order, as in "moment[2].status"')
        if np.any(self._read(VALUES)):
            return "summed" if self.order in self.result._orders else "omitted"
        proved = self.result._proved_zero(self.name, self.order)
        return "zero, proved" if proved else "zero within rounding"

    @property
    def total(self) -> Quantity[Element, Value, Value]:
        """All orders together."""
        return self[ALL]

    def _read(self, what: str) -> Any:  # noqa: ANN401 - an array, or a number of one order
        if self.selected and "axis" in dict(self.selected):  # there are values by axis
            axes = "".join(self.kind.axes)
            what = {"peak": f"peak_{axes}", "rms": f"rms_{axes}"}.get(what, what)
        if what not in self.result._readings(self.name):
            raise self._absent(what, "it has no such array")
        if self.order is None:
            values = self.result.read(self.name, what)
            number = values.ndim == 0 and what != VALUES
            return self._picked(what, float(values) if number else values)
        if self.order != ALL:
            return self._picked(what, self.result._read_order(self.order, self.name, what))
        if f"total_{what}" not in self.result._readings(self.name):
            hint = f"as in b[2], or read the arrays of a balance, as in b.{self.name}"
            raise self._absent(what, f"all orders together have peaks alone; give an order, {hint}")
        values = self._picked(what, self.result.read(self.name, f"total_{what}"))
        return values if values.ndim else float(values)

    def _picked(self, what: str, values: Any) -> Any:  # noqa: ANN401 - as above
        """Return the selected places of one of the arrays."""
        if not self.selected:
            return values
        places = dict(self.selected)
        without = {"order"} if self.order is not None else set()
        dims = (d for d in self.result._dims(self.name, what) if d not in without)
        return values[tuple(places.get(d, slice(None)) for d in dims)]

    def _part(self, part: str) -> Self:
        if part not in self.parts and (self.name not in QUANTITIES or self.kind.axes):
            raise self._absent(part, "give torque or crank_torque, which have it")
        return changed(self, name=f"{self.name}.{part}")

    def _absent(self, what: str, hint: str) -> InputError:
        return inputs.faulty(what, f"is undefined for {self.name}", hint, AbsentError)

    def _along(self, what: str, name: str = "", count: int = 0) -> Any:  # noqa: ANN401 - as above
        """Return an array of a vector of 2 or 3 axes, or raise an error that names it."""
        axes = len(self.kind.axes) if "axis" not in dict(self.selected) else 0
        if axes == 0 or count not in (0, axes):
            if self.name.partition(".")[0] not in QUANTITIES or self.kind.axes:
                raise self._absent(name or what, f"its dimensions are {', '.join(self.dims)}")
            fault = f"is that of a vector; {self.name} is about z alone"
            hint = "it has phasor and peak"
            raise inputs.faulty(name or what, fault, hint, AbsentError)
        return self._read(what)

    # --- keys -----------------------------------------------------------------------------------

    def __len__(self) -> int:
        return super().__len__() if self._by_order else len(np.asarray(self))

    def __iter__(self) -> Iterator[Any]:
        return super().__iter__() if self._by_order else iter(np.asarray(self))

    def __contains__(self, value: object) -> bool:
        return super().__contains__(value) if self._by_order else bool(np.any(self == value))

    def __reversed__(self) -> Iterator[Any]:
        return super().__reversed__() if self._by_order else reversed(np.asarray(self))

    @overload
    def __getitem__(
        self: Quantity[np.complex128, Any, Any], key: Order | str
    ) -> Quantity[Element, Value, Value]: ...

    @overload
    def __getitem__(self, key: str) -> Quantity[Element, Any, Any]: ...

    @overload
    def __getitem__(self, key: Any) -> Any: ...  # noqa: ANN401 - as NumPy has it

    def __getitem__(self, key: Any) -> Any:
        """Return the quantity at an order, ``"all"`` or a name; else what NumPy's index gives.

        Parameters
        ----------
        key : number, str, slice, tuple or array
            An order, where there are orders; ``"all"`` for all of them together; the name of a
            coordinate, such as that of a mount; or an index of the plain array.

        Returns
        -------
        Quantity or ndarray
            The quantity at the order or name; the plain array's values at an index.

        Raises
        ------
        InputError
            If there is no such order, name or place.
        """
        whole: Quantity[Any, Any, Any] = self
        if isinstance(key, str):
            for name, values in self.coords.items():
                if isinstance(values, tuple) and key in values and isinstance(values[0], str):
                    return self.sel(**{name: key})
            if key == ALL and self.orders:
                return changed(whole, order=ALL)
        by_place = (
            isinstance(key, (slice, tuple, list)) or key is ... or bool(getattr(key, "ndim", 0))
        )
        if self._by_order and not by_place:
            return changed(whole, order=order_key(key))
        array = np.asarray(self)
        try:
            return array[key]
        except (IndexError, TypeError, ValueError, OverflowError) as error:
            hint = f"give an index, or a name ({inputs.reason(error)})"
            raise inputs.rejected("index", key, hint, AbsentItemError) from None

    def sel(self, **coordinates: object) -> Quantity[Element, Any, Any]:
        """Return the quantity at values of coordinates.

        Parameters
        ----------
        **coordinates : dict, optional
            A value for some of ``dims``: ``rpm=3000``, ``axis="x"``, ``cylinder=1``.

        Returns
        -------
        Quantity
            The same without these dimensions.

        Raises
        ------
        InputError
            If there is no such dimension, or the value is not among its coordinates.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[2])
        >>> bool(s.force.sel(rpm=2000).peak[0] == s.force.peak[1, 0])
        True
        """
        selected, coords = self, self.coords
        for name, value in coordinates.items():
            values = coords[inputs.one_of("dimension", name, self.dims)]
            if name == "order":
                place = self._place(value)
                selected = changed(selected, order=self.orders[place])
            else:
                place = export.place_of(name, value, values)
                selected = changed(selected, selected=(*selected.selected, (name, place)))
        return selected

    # --- an array -------------------------------------------------------------------------------

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Element]:  # noqa: ANN401
        array = np.array(self._read(VALUES), dtype=dtype, copy=copy)
        return array if array.ndim or copy else read_only(array)

    def __array_ufunc__(
        self,
        ufunc: np.ufunc,
        method: Any,  # noqa: ANN401 - as NumPy calls it
        *arguments: Any,  # noqa: ANN401
        **keywords: Any,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401
        if any(isinstance(out, Quantity) for out in keywords.get("out", ())):
            return NotImplemented
        try:
            return getattr(ufunc, method)(*_plain(arguments), **keywords)
        except (ValueError, OverflowError, ZeroDivisionError) as error:
            hint = f"give numbers, or an array that broadcasts ({inputs.reason(error)})"
            raise inputs.rejected(f"operands of {ufunc.__name__}", arguments, hint) from None

    def __pow__(self, exponent: Any) -> Any:  # noqa: ANN401 - as arrays: squares are products
        array = np.asarray(self)
        try:
            return array**exponent
        except (ValueError, OverflowError) as error:
            hint = f"give numbers, or an array that broadcasts ({inputs.reason(error)})"
            raise inputs.rejected("exponent", exponent, hint) from None

    def __array_function__(
        self,
        function: Callable[..., Any],
        types: Iterable[type],
        arguments: tuple[Any, ...],
        keywords: dict[str, Any],
    ) -> Any:  # noqa: ANN401 - what the function returns
        return function(*_plain(arguments), **_plain(keywords))

    def __eq__(self, other: object) -> Any:  # noqa: ANN401 - an array, or a bool
        """Return where values are equal, as of arrays; False for what is no array of their shape.

        All orders together have no phasors: they are equal as other results are.
        """
        if self.order == ALL or (isinstance(other, Quantity) and other.order == ALL):
            return isinstance(other, Quantity) and Record.__eq__(self, other)
        if getattr(other, "__array_ufunc__", ...) is None:
            return NotImplemented  # it compares itself with arrays
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
            return np.shape(self._read(VALUES))
        return tuple(len(values) for values in self.coords.values())

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    @property
    def size(self) -> int:
        """Number of values."""
        return math.prod(self.shape)

    def __float__(self) -> float:
        return float(np.asarray(self))

    def __complex__(self) -> complex:
        return complex(np.asarray(self))

    def __format__(self, spec: str) -> str:
        return format(np.asarray(self)[()], spec) if spec else str(self)

    dtype, flags, real, imag, T = (ArrayMember() for _ in range(5))
    max, min, sum, mean, std, any, all = (ArrayMember() for _ in range(7))
    argmax, argmin, round, item, tolist, copy = (ArrayMember() for _ in range(6))
    astype, reshape, ravel, cumsum, conj = (ArrayMember() for _ in range(5))

    # --- text -----------------------------------------------------------------------------------

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; of a force or a moment without gas."""
        return self.result._loads_of(self.name)

    @property
    def table(self) -> Table:
        """Values in long form; of phasors peaks by order, and of all orders together.

        Those of a sweep at each point. Torques of a fired engine have their mean, their phases and
        their parts too.
        """
        return self.result._table_of(self)

    @property
    def words(self) -> str:
        """Name in texts."""
        return self.result._words_of(self)

    @property
    def _which(self) -> str:
        """Order, in words that follow a name."""
        if self.order is None:
            return ""
        return " of all orders" if self.order == ALL else f" of order {self.order}"

    @property
    def _brief(self) -> str:
        dims = self._dims_of(VALUES if self.order is None else "peak")
        if self.order is None and dims[:1] == ("order",):
            return ""
        text = f"<Quantity {labels.one_line(self.words)}{self._which}"
        loads = f", {self.loads_counted}" if self.loads_counted else ""
        if not dims:
            peak = "peak " if "peak" in self.result._readings(self.name) else ""
            highest: Any = self.peak if peak else np.asarray(self)[()]
            return f"{text}: {peak}{units.shown(units.figure(highest, self.unit, 5))}{loads}>"
        coords = self.result._coordinates(self.name)
        over = ", ".join(f"{d}: {len(coords[d])}" for d in dims)
        return f"{text}, {self.unit}, over ({over}){loads}>"

    def _dataset(self) -> xr.Dataset | None:
        return None if self.order == ALL else export.dataset_of(self)


def _plain(value: Any) -> Any:  # noqa: ANN401 - arguments of functions of NumPy
    """Return arguments with plain arrays in place of quantities."""
    if isinstance(value, Quantity):
        return np.asarray(value)
    if type(value) in (list, tuple):
        return type(value)(map(_plain, value))
    return {key: _plain(inner) for key, inner in value.items()} if type(value) is dict else value
