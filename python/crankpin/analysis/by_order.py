"""Results by order: arrays computed when read, orders as keys, totals, tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Generic, Literal, Self

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.frames import Tabled
from crankpin._support.quantities import QUANTITIES, kind_of
from crankpin._support.record import AbsentError, changed
from crankpin._support.tables import Column, Table
from crankpin.analysis import export
from crankpin.analysis.export import VALUES
from crankpin.analysis.labelled import Shaking, ShakingQuantities, total_peaks
from crankpin.analysis.quantity import ALL, Keyed, Quantity, Value, one_order, order_key
from crankpin.analysis.request import engine_core
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Spectrum
    from crankpin.analysis.request import Request
    from crankpin.model.engine import Engine


class ByOrder(Keyed, Shaking["np.complex128", "NDArray[np.float64]", Value], Generic[Value]):
    """Base class of balances and sweeps: arrays computed when first read, orders as keys."""

    _along: ClassVar[tuple[str, ...]] = ("order",)

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed, ascending where they were chosen."""
        return tuple(self.__dict__["_core"].orders)

    @property
    def omitted(self) -> tuple[Order, ...]:
        """With ``orders="auto"``: orders left out that are not zero, of a sweep at every point.

        Orders above the last candidate add less than a hundredth of ``rtol``; ``error_bound``
        includes them.
        """
        return tuple(self.__dict__["_core"].omitted)

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return tuple(getattr(self.__dict__.get("_core"), "names", ("inertia",)))

    @property
    def _has_means(self) -> bool:
        """True if more than inertia may make a torque: then it may have a mean."""
        return set(self.causes) != {"inertia"}

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as :attr:`Engine.loads_counted`.

        Empty without torque: gas pressure makes no force and no moment.
        """
        return self._request.loads_counted(labels.loads_of(self._engines, self._titles))

    @property
    def _titles(self) -> tuple[str, ...]:
        """Names that distinguish the engines."""
        return tuple(map(labels.name_of, self._engines))

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum used in place of the slider-crank's harmonics, kg·m, or None."""
        return self._request.spectrum

    @property
    def total(self) -> OrderBalance[Value]:
        """All orders together, as in ``total.force.peak`` and ``total.moment.peak_xy``."""
        return OrderBalance(self, ALL)

    def __getitem__(self, order: Order | Literal["all"]) -> OrderBalance[Value]:
        """Return one order, or with ``"all"`` all of ``orders`` together.

        An order that is not among ``orders`` is computed when it is read: zero where the layout
        cancels it, and else what it is, though it does not count in the total;
        :attr:`Quantity.status` says which.

        Raises
        ------
        InputError
            If the key is no order.
        """
        return OrderBalance(self, order_key(order))

    def about(self, point: ArrayLike | None = None, *, z: float | None = None) -> Self:
        """Return the same result with moments and roll torque about another point.

        Parameters
        ----------
        point : float or array_like, shape (3,), optional
            Position z along the crank, or (x, y, z), m.
        z : float, optional
            Position along the crank, m, by name.

        Returns
        -------
        Balance, Sweep or Tolerances
            A result of the same class.

        Raises
        ------
        InputError
            If both are given or none, or one is no position.

        Examples
        --------
        >>> import crankpin as cp
        >>> b = cp.Engine.preset("i4").balance(rpm=6000)
        >>> b[2].moment.peak, round(b.about(z=0.0)[2].moment.peak, 1)
        (np.float64(0.0), np.float64(1390.4))
        """
        inputs.only_one_of(point=point, z=z)
        name = "z" if point is None else "point"
        request = self._request.about(name, z if point is None else point)
        for engine in self._engines:
            checks.place(engine_core(engine), name, request.reference_z)
            checks.place(engine_core(engine), name, *request.aside, middle=0.0)
        return self._with_request(request)

    # --- arrays ---------------------------------------------------------------------------------

    def _readings(self, quantity: str) -> tuple[str, ...]:
        return export.OF_TURNING if kind_of(quantity).planar else export.OF_TORQUES

    def _in_datasets(self, quantity: str) -> tuple[str, ...]:
        names = self._readings(quantity)
        return names if self._has_means else tuple(n for n in names if n != "cycle_mean")

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        return self._about_point(quantity, what)

    def _about_point(self, quantity: str, what: str) -> NDArray[Any]:
        """Compute an array; roll torque about a point beside the crank from that about its axis."""
        x, y = self._request.aside
        whole, point, part = quantity.partition(".")
        if whole != "torque" or what == "cycle_mean" or (x, y) == (0.0, 0.0) or part == "gas":
            return self._about_axis(quantity, what)
        force_name = f"force{point}{part}"
        if what == VALUES:
            force = self.read(force_name)
            return self._about_axis(quantity, what) - (x * force[..., 1] - y * force[..., 0])
        if what == "zero_bound":
            bound = (abs(x) + abs(y)) * self.read(force_name, "zero_bound")
            return self._about_axis(quantity, what) + bound
        phasors = self.read(quantity)
        if what == "peak":
            return np.asarray(np.abs(phasors))
        return total_peaks(self.orders, phasors, self.read(quantity, "cycle_mean"))

    def _about_axis(self, quantity: str, what: str) -> NDArray[Any]:
        """Compute an array; of the roll torque about the axis of the crank."""
        raise NotImplementedError

    def _at_order(self, order: Order) -> ByOrder[Value]:
        """Return the same result of one order."""
        order = one_order(order)
        one: ByOrder[Value] = self._once(
            order, lambda: self._with_request(self._request.at_orders((order,)))
        )
        return one

    @property
    def _engines(self) -> tuple[Engine, ...]:
        """Engines of which this is a result."""
        raise NotImplementedError

    @property
    def _of_engines(self) -> tuple[Engine, ...]:
        return self._engines

    def _with_request(self, request: Request) -> Self:
        """Return the same result by another request."""
        raise NotImplementedError

    def _at_orders(self, orders: tuple[Order, ...]) -> Self:
        """Return the same result at the orders given."""
        wanted = inputs.half_orders(orders)
        if wanted is None:
            raise inputs.rejected("orders", orders, "give orders, such as (1, 2)")
        return self._with_request(self._request.at_orders(tuple(wanted)))

    def _proved_zero(self, quantity: str, order: Order) -> bool:
        """Return whether a quantity of one order is proved to vanish."""
        name = inputs.one_of("quantity", quantity, QUANTITIES)
        hint = "only a balance has proofs; read them at a point of the sweep"
        raise inputs.rejected("quantity", name, hint, AbsentError)

    # --- tables -----------------------------------------------------------------------------------

    def _shown_orders(self, *names: str) -> tuple[tuple[int, ...], tuple[Order, ...]]:
        """Return places of the orders that tables and pictures show, and the orders they leave out.

        Orders chosen automatically are left out where every peak is below
        :data:`labels.NEGLIGIBLE` of the largest peak of its quantity; orders given are all shown.

        Parameters
        ----------
        *names
            The quantities that are shown.
        """
        places = tuple(range(len(self.orders)))
        if self._request.orders is not None:
            return places, ()
        swept = tuple(range(len(self.dims)))
        is_kept = np.zeros(len(places), dtype=bool)
        for name in names:
            peaks = self.read(name, "peak").max(axis=swept, initial=0.0)
            is_kept |= peaks > labels.NEGLIGIBLE * peaks.max(initial=0.0)
        if not is_kept.any():
            return places, ()
        visible = tuple(place for place in places if is_kept[place])
        return visible, tuple(self.orders[place] for place in places if not is_kept[place])

    def _least_shown(self, peaks: NDArray[np.float64]) -> float:
        """Return the least peak that tables write as a number, of a quantity with these."""
        chosen = self._request.orders is None
        return labels.NEGLIGIBLE * float(peaks.max(initial=0.0)) if chosen else 0.0

    def _table_of(self, quantity: Quantity) -> Table:
        """Return peaks by order, and of all orders together; those of a sweep at each point.

        Torques of a fired engine have their mean, their phases and their parts too.
        """
        keys: tuple[Order | Literal["all"], ...] = ()
        note = ""
        if quantity.order is not None:
            keys = (quantity.order,)
        else:
            visible, left_out = self._shown_orders(quantity.name)
            keys, note = (*(self.orders[k] for k in visible), ALL), labels.not_shown(left_out)
        unit, words = quantity.unit, quantity.words
        title: str = units.headed(words, unit)
        coords = {name: values for name, values in quantity.coords.items() if name in self.dims}
        if coords:
            columns = export.points(coords, len(keys))
            columns += [
                Column(ALL if key == ALL else f"order {key}", changed(quantity, order=key).peak)
                for key in keys
            ]
        elif self._has_means and not quantity.kind.planar:
            title, columns = words, self._columns_of_parts(quantity, keys)
        else:
            columns = [Column("order", keys)]
            columns += [
                Column(head, tuple(_figure(quantity, key, what) for key in keys))
                for head, what in _columns_of(quantity).items()
            ]
        row_units = (unit,) * len(columns[0]) if columns and title != words else ()
        return Table(title, tuple(columns), note, quantity.loads_counted, row_units)

    def _columns_of_parts(
        self, quantity: Quantity, keys: Sequence[Order | Literal["all"]]
    ) -> list[Column]:
        """Return mean, peaks and phases of a torque and of its parts."""
        columns = [Column("order", ("mean", *keys))]
        parts = [quantity, *map(quantity.part, quantity.parts)]
        least = self._least_shown(np.asarray(quantity.peak))
        for part in parts:
            peaks = [_figure(part, key, "peak") for key in keys]
            phases = [
                None
                if key == ALL or not peak
                else float(np.angle(changed(part, order=key).phasor, deg=True))
                for key, peak in zip(keys, peaks, strict=True)
            ]
            name = "" if part is quantity else part.name.partition(".")[-1]
            mean = changed(part, order=None).cycle_mean
            head = name or quantity.kind.symbols[0]
            columns += [
                Column(head, (mean, *peaks), quantity.unit, least=least),
                Column(f"{name} phase".strip(), (None, *phases), "°", digits=4),
            ]
        return columns


def _columns_of(quantity: Quantity) -> dict[str, str]:
    """Head of each column of the table of a quantity → array that it shows."""
    kind = quantity.kind
    if not kind.planar:
        return {kind.symbols[0]: "peak"}
    if "axis" in dict(quantity.selected):
        return {"peak": "peak"}
    parts = {kind.vector_symbol: "peak", "forward": "forward", "backward": "backward"}
    return {head: f"peak_xy.{k}" for k, head in enumerate(kind.symbols)} | parts


def _figure(quantity: Quantity, order: Order | Literal["all"], what: str) -> float | None:
    """Return a figure of one order of a balance; None where all together have none."""
    name, _, axis = what.partition(".")
    if order == ALL and not name.startswith("peak"):
        return None
    values = np.abs(getattr(changed(quantity, order=order), name))
    return float(values[int(axis)] if axis else values)


class OrderBalance(ShakingQuantities["np.complex128", Value, Value], Tabled, Generic[Value]):
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

    def _quantity(self, name: str) -> Quantity[np.complex128, Value, Value]:
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
        for quantity in self._each():
            beside: list[float | None] = [None] * (2 + len(parts))
            if quantity.kind.planar:
                beside = [
                    *quantity.peak_xy.tolist(),
                    *(abs(getattr(quantity, part)) for part in parts),
                ]
            status = () if self.order == ALL else (quantity.status,)
            row = (*beside[:2], quantity.peak, *beside[2:], *status)
            rows.append((quantity.kind.words, quantity.unit, *row))
        heads = ["quantity", "unit", "x", "y", "largest", *parts]
        heads += [] if self.order == ALL else ["status"]
        speed = labels.at_speed(self.result._attributes["rpm"])
        title = f"{labels.name_of(self.result._engines[0])} {speed}: {self._which}"
        row_units = [quantity.unit for quantity in self._each()]
        return Table.from_rows(title, heads, rows, loads=self.loads_counted, row_units=row_units)

    def _table_by_point(self) -> Table:
        """Return the largest peak of each quantity of a sweep at each point."""
        quantities = list(self._each())
        columns = export.points(self.result.coords, len(quantities))
        columns += [
            Column(quantity.kind.vector_symbol, quantity.peak, quantity.unit)
            for quantity in quantities
        ]
        title = f"Peaks of {self._which}"
        return Table(title, tuple(columns), loads=self.loads_counted)

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as of the balance or sweep."""
        return self.result.loads_counted

    def _each(self) -> Iterator[Quantity]:
        """Yield the quantities, and their parts where more than inertia makes them."""
        for name in self.result._request.quantities:
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
        lines = (f"  {getattr(self, name)!r}" for name in self.result._request.quantities)
        return "\n".join([f"<OrderBalance of {self._which}>", *lines])
