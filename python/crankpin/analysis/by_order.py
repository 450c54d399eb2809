"""Results by order: arrays computed when read, orders as keys, totals, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Generic, Literal, Self

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.quantities import QUANTITIES, kind_of
from crankpin._support.record import AbsentError, read_only
from crankpin.analysis import export
from crankpin.analysis.export import Labelled
from crankpin.analysis.quantity import (
    ALL,
    Keyed,
    OrderBalance,
    Quantities,
    Quantity,
    Value,
    one_order,
    order_key,
)
from crankpin.analysis.request import engine_core
from crankpin.model import checks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Spectrum
    from crankpin.analysis.request import Request
    from crankpin.model.engine import Engine


class ByOrder(Keyed, Quantities["NDArray[np.float64]", Value], Labelled, Generic[Value]):
    """Base class of balances and sweeps: arrays computed when first read, orders as keys."""

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
        return self.request.loads_counted(labels.loads_of(self._engines, self._titles))

    @property
    def _titles(self) -> tuple[str, ...]:
        """Names that distinguish the engines."""
        return tuple(map(labels.name_of, self._engines))

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum used in place of the slider-crank's harmonics, kg·m, or None."""
        return self.request.spectrum

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

    def _quantity(self, name: str) -> Quantity[NDArray[np.float64], Value]:
        return Quantity(self, name)

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
        request = self.request.about(name, z if point is None else point)
        for engine in self._engines:
            checks.place(engine_core(engine), name, request.reference_z)
            checks.place(engine_core(engine), name, *request.aside, middle=0.0)
        return self._with_request(request)

    # --- arrays ---------------------------------------------------------------------------------

    @property
    def _kept(self) -> dict[Any, Any]:
        """Arrays that were read, and results of orders that were requested later."""
        return self.__dict__.setdefault("_cache", {})  # type: ignore[no-any-return]

    def read(self, quantity: str, what: str) -> NDArray[Any]:
        """Return one of the arrays of a quantity, read-only: ``"peak"``, ``"phasors"`` and others.

        Computed when it is first read, and kept; threads that read it at once get one array.

        Parameters
        ----------
        quantity : str
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``, or a part of a torque,
            such as ``"torque.gas"``.
        what : str
            ``"phasors"``, ``"forward"``, ``"backward"``, ``"peak"``, ``"peak_xy"``,
            ``"zero_bound"``, ``"total_peak"``, ``"total_peak_xy"``, or ``"mean"`` of a torque.

        Returns
        -------
        ndarray of float or complex
            The array, N or N·m, of the swept dimensions, then orders and axes.

        Raises
        ------
        InputError
            If there is no such quantity or array.
        """
        self.request.check(quantity, self)
        inputs.one_of("what", what, export.arrays(quantity))
        array: NDArray[Any] | None = self._kept.get((quantity, what))
        if array is None:
            array = read_only(np.asarray(self._about_point(quantity, what)))
            array = self._kept.setdefault((quantity, what), array)
        return array

    def _about_point(self, quantity: str, what: str) -> NDArray[Any]:
        """Compute an array; roll torque about a point beside the crank from that about its axis."""
        x, y = self.request.aside
        whole, point, part = quantity.partition(".")
        if whole != "torque" or what == "mean" or (x == 0.0 and y == 0.0) or part == "gas":
            return self._compute(quantity, what)
        force_name = f"force{point}{part}"
        if what == "phasors":
            force = self.read(force_name, "phasors")
            return self._compute(quantity, what) - (x * force[..., 1] - y * force[..., 0])
        if what == "zero_bound":
            bound = (abs(x) + abs(y)) * self.read(force_name, "zero_bound")
            return self._compute(quantity, what) + bound
        phasors = self.read(quantity, "phasors")
        if what == "peak":
            return np.asarray(np.abs(phasors))
        return total_peaks(self.orders, phasors, self.read(quantity, "mean"))

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        raise NotImplementedError

    def _read_order(self, order: Order, quantity: str, what: str) -> Any:  # noqa: ANN401 - as read
        """Return a part of an array: that of one order, which may not be among ``orders``."""
        orders = self.orders
        if order not in orders:
            return self._alone(one_order(order))._read_order(order, quantity, what)
        at: Any = (*(slice(None) for _ in self.dims), orders.index(order))
        return self.read(quantity, what)[at]

    def _alone(self, order: Order) -> ByOrder[Value]:
        """Return the same result of one order."""
        result: ByOrder[Value] | None = self._kept.get(order)
        if result is None:
            result = self._with_request(self.request.at_orders((order,)))
            result = self._kept.setdefault(order, result)
        return result

    @property
    def _engines(self) -> tuple[Engine, ...]:
        """Engines of which this is a result."""
        raise NotImplementedError

    def _with_request(self, request: Request) -> Self:
        """Return the same result by another request."""
        raise NotImplementedError

    def _at_orders(self, orders: tuple[Order, ...]) -> Self:
        """Return the same result at the orders given."""
        wanted = inputs.half_orders(orders)
        if wanted is None:
            raise inputs.rejected("orders", orders, "give orders, such as (1, 2)")
        return self._with_request(self.request.at_orders(tuple(wanted)))

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
        if self.request.orders is not None:
            return places, ()
        swept = tuple(range(len(self.dims)))
        kept = np.zeros(len(places), dtype=bool)
        for name in names:
            peaks = self.read(name, "peak").max(axis=swept, initial=0.0)
            kept |= peaks > labels.NEGLIGIBLE * peaks.max(initial=0.0)
        if not kept.any():
            return places, ()
        shown = tuple(place for place in places if kept[place])
        return shown, tuple(self.orders[place] for place in places if not kept[place])

    def _least_shown(self, peaks: NDArray[np.float64]) -> float:
        """Return the least peak that tables write as a number, of a quantity with these."""
        chosen = self.request.orders is None
        return labels.NEGLIGIBLE * float(peaks.max(initial=0.0)) if chosen else 0.0

    # --- in other forms -----------------------------------------------------------------------

    def _arrays(self, quantities: Sequence[str]) -> tuple[dict[str, Any], dict[str, Any]]:
        variables = list(export.variables(quantities, means=self._has_means))
        coords = {**self.coords, "order": self.orders}
        export.fitting(
            coords,
            *(
                ((*self.dims, *dims), 16 if what in export.COMPLEX else 8)
                for _, _, what, dims in variables
            ),
        )
        return coords, {
            name: ((*self.dims, *dims), self.read(quantity, what), export.units(quantity))
            for name, quantity, what, dims in variables
        }

    def _figures(self, quantity: str) -> Mapping[str, Mapping[str, NDArray[np.float64]]]:
        phasors = self.read(quantity, "phasors")
        parts = {"z": phasors}
        if kind_of(quantity).planar:
            parts = {"x": phasors[..., 0], "y": phasors[..., 1]}
            parts |= {part: self.read(quantity, part) for part in labels.TURNING}
        return {
            component: {"real": values.real, "imag": values.imag, "peak": np.abs(values)}
            for component, values in parts.items()
        }


def total_peaks(
    orders: tuple[Order, ...], phasors: NDArray[np.complex128], mean: ArrayLike = 0.0
) -> NDArray[np.float64]:
    """Return the largest magnitude over θ of a mean and all orders: (…), of (…, n_orders)."""
    if not orders:
        return np.array(np.broadcast_to(np.abs(mean), phasors.shape[:-1]))
    rows = np.ascontiguousarray(phasors.reshape(-1, len(orders)))
    means = np.broadcast_to(mean, phasors.shape[:-1]).ravel()
    return _core.peaks_of_sums(list(orders), rows, means).reshape(phasors.shape[:-1])
