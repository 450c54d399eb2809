"""Results that have quantities, labelled arrays: what is written once for all of them."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, optional
from crankpin._support import units as unit_names
from crankpin._support.frames import PHASES, Tabled, in_units
from crankpin._support.quantities import COMPONENTS_OF_LOADS, QUANTITIES, kind_of, parts_of
from crankpin._support.record import AbsentError, read_only
from crankpin.analysis import export
from crankpin.analysis.export import VALUES
from crankpin.analysis.quantity import Element, Quantity, Value, Values

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.quantities import Kind
    from crankpin._support.tables import Table
    from crankpin.analysis.request import Request
    from crankpin.model.engine import Engine
    from crankpin.model.vehicle_axes import VehicleAxes


class Labelled(Tabled):
    """Base class of results that have quantities, which are labelled arrays.

    A class names its quantities in ``_names``, computes their values in ``_values``, and has a
    property for each; dimensions, units and words are in the registry
    (``_support/quantities.py``). Reading, selection and export follow from these.
    """

    _along: ClassVar[tuple[str, ...]] = ()
    """Dimension along which values are at a point: ``order`` or ``theta_deg``; or none."""
    _registry: ClassVar[Mapping[str, Kind]] = {}
    """Name of each quantity that it may have → its entry in the registry."""
    _arrays: ClassVar[Any] = MappingProxyType({})
    """Quantity → its values, of classes that compute all at once."""

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; empty where none does."""
        return ""

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the speeds, where there are several."""
        rpm = getattr(self, "rpm", None)
        return {"rpm": rpm} if isinstance(rpm, np.ndarray) else {}

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions before orders and axes."""
        return tuple(self.coords)

    @property
    def quantities(self) -> Mapping[str, Quantity]:
        """Name → quantity, a labelled array; with the parts of those that have several causes."""
        return MappingProxyType({name: self._quantity(name) for name in self._names})

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → upper bound on what the omitted orders add, N or N·m; of some results."""
        return {}

    # --- what a class says of its quantities ----------------------------------------------------

    @property
    def _names(self) -> tuple[str, ...]:
        """Names of the quantities, with their parts."""
        return tuple(self._registry)

    def _values(self, quantity: str) -> NDArray[Any]:
        """Compute the values of a quantity; by default those of ``_arrays``, computed before."""
        values: NDArray[Any] = self._arrays[quantity]
        return values

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        """Dimension that single quantities have → its values: cylinders, bearings, mounts."""
        return {}

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset of the result: name of the engine, and its speed if it is one."""
        rpm, engine = getattr(self, "rpm", None), getattr(self, "engine", None)
        about = {} if engine is None else {"engine": engine.name}
        return about | ({"rpm": rpm} if isinstance(rpm, float) else {})

    def _quantity(self, name: str) -> Quantity[Any, Any, Any]:
        return Quantity(self, name)

    def _check(self, quantity: str) -> None:
        """Raise an error if there is no such quantity."""
        inputs.one_of("quantity", quantity, self._names)

    def _kind(self, quantity: str) -> Kind:
        """Return the entry of the registry."""
        return kind_of(quantity, self._registry)

    def _words_of(self, quantity: Quantity) -> str:
        """Return the name of a quantity in texts."""
        return quantity.kind.words

    def _parts(self, quantity: str) -> tuple[str, ...]:
        """Return the names of the parts of a quantity that has several causes."""
        return ()

    def _named_parts(self, quantity: str) -> tuple[str, ...]:
        """Return the causes whose part of a quantity may be read."""
        return ()

    def _loads_of(self, quantity: str) -> str:
        """Return the loads that count in a quantity, in words."""
        return self.loads_counted

    def _proved_zero(self, quantity: str, order: Order) -> bool:
        """Return whether a quantity of one order is proved to vanish."""
        hint = "only a balance has proofs; read them at a point of the sweep"
        raise inputs.faulty("status", f"is undefined for {quantity} of order {order}", hint,
                            AbsentError)  # fmt: skip

    def _table_of(self, quantity: Quantity) -> Table:
        """Return the table of a quantity."""
        return export.long([quantity], quantity.loads_counted, quantity.words)

    # --- amplitudes and phases ------------------------------------------------------------------

    @property
    def _for_programs(self) -> Mapping[str, Callable[[], Table]]:
        """Amplitudes and phases by order, where quantities are phasors."""
        are_phasors = any(
            not kind.real and "order" not in kind.without for kind in self._registry.values()
        )
        if "order" in self._along and are_phasors and getattr(self, "order", None) is None:
            return MappingProxyType({PHASES: self._phases})
        return super()._for_programs

    def _phases(self) -> Table:
        """Return amplitude and phase of each component, order by order: for other programs."""
        engines = self._of_engines
        title, rpm = "Amplitudes and phases", getattr(self, "rpm", None)
        if len(engines) == 1:
            at = f" {labels.at_speed(rpm)}" if isinstance(rpm, float) else ""
            title = f"{labels.name_of(engines[0])}{at}: {title.lower()}"
        of = [self._quantity(name) for name in self._names]
        return export.phases(of, title, self._sense_of_phases(), self.loads_counted)

    @property
    def _of_engines(self) -> tuple[Engine, ...]:
        """Engines of which this is a result."""
        of: Any = self
        for name in ("result", "before", "powertrain"):
            of = getattr(of, name, of)
        engine = getattr(of, "engine", None)  # a table of forces may take its place
        return () if engine is None else (engine,)

    def _sense_of_phases(self) -> str:
        """Return sign and reference of the phases, in words."""
        note = "Order n is amplitude·cos(n·θ + phase_deg), θ the crank angle in its sense of turn"
        turned = "bank_angle_deg" in self.dims
        first = {float(engine.tdc_deg[0]) for engine in self._of_engines}
        if turned or len(first) != 1:
            return f"{note}."
        (tdc,) = first
        at = f"{tdc:.10g}°" if tdc else "0"
        return f"{note}; cylinder 1 is at top dead centre at θ = {at}."

    # --- dimensions -----------------------------------------------------------------------------

    @property
    def _orders(self) -> tuple[Order, ...]:
        """Orders that are a dimension."""
        return getattr(self, "orders", None) or ()

    def _dims(self, quantity: str, what: str = VALUES) -> tuple[str, ...]:
        """Return the dimensions of one of the arrays of a quantity."""
        kind = self._kind(quantity)
        swept = (name for name in self.dims if name not in self._along)
        axis = ("axis",) if kind.axes else ()
        dims = (*swept, *kind.dims, *self._along, *axis)
        return export.reduced(tuple(name for name in dims if name not in kind.without), what)

    def _is_by_order(self, quantity: str) -> bool:
        """Return whether a quantity has the dimension ``order``."""
        return "order" in self._along and "order" not in self._kind(quantity).without

    def _coordinates(self, quantity: str) -> dict[str, Any]:
        """Return dimension → its values, of a quantity."""
        kind = self._kind(quantity)
        further = {"order": self._orders, "axis": kind.axes, "component": COMPONENTS_OF_LOADS}
        coords = {**further, **self._own_coords, **self.coords}
        return {name: coords[name] for name in self._dims(quantity)}

    # --- arrays ---------------------------------------------------------------------------------

    @property
    def _kept(self) -> dict[Any, Any]:
        """Arrays that were read, and results of orders that were requested later."""
        return self.__dict__.setdefault("_cache", {})  # type: ignore[no-any-return]

    def _once(self, key: object, compute: Callable[[], Any]) -> Any:  # noqa: ANN401 - any result
        """Return what was computed before, or now; threads that do it at once get one object."""
        value = self._kept.get(key)
        return self._kept.setdefault(key, compute()) if value is None else value

    def _readings(self, quantity: str) -> tuple[str, ...]:
        """Return the names of the arrays of a quantity."""
        return export.readings(self._kind(quantity), self._dims(quantity))

    def read(self, quantity: str, what: str = VALUES) -> NDArray[Any]:
        """Return one of the arrays of a quantity, read-only.

        Computed when it is first read, and kept; threads that read it at once get one array.

        Parameters
        ----------
        quantity : str
            One of ``quantities``, such as ``"force"``, or ``"torque.gas"``, a part of a torque.
        what : str, default "values"
            ``"values"``, of results by order peak phasors; or an attribute of
            :class:`~crankpin.results.Quantity`: ``"peak"``, ``"forward"``, ``"zero_bound"``; of all
            orders together ``"total_peak"``.

        Returns
        -------
        ndarray of float or complex
            The array, of the quantity's unit and dimensions.

        Raises
        ------
        InputError
            If there is no such quantity or array.
        """
        are_texts = isinstance(quantity, str) and isinstance(what, str)
        if are_texts and (quantity, what) in self._kept:
            return self._kept[quantity, what]  # type: ignore[no-any-return]
        self._check(quantity)
        if not are_texts or what != VALUES:
            inputs.one_of("what", what, self._readings(quantity))
        compute = self._compute
        array: NDArray[Any] = self._once(
            (quantity, what), lambda: read_only(np.asarray(compute(quantity, what)))
        )
        return array

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        """Compute one of the arrays of a quantity; from its values where the core has no other."""
        if what == VALUES:
            return self._turned(quantity, self._values(quantity))
        values, dims = self.read(quantity), self._dims(quantity)
        if what == "mean_magnitude":
            return _mean(self.read(quantity, "magnitude"), np.asarray(self.coords["theta_deg"]))
        if "order" not in dims:
            return _over_angle(values, dims.index("theta_deg"), what, vector=dims[-1] == "axis")
        if dims[-1] == "axis":
            return self._in_space(quantity, what)
        phasors = np.moveaxis(values, dims.index("order"), -1)
        return total_peaks(self._orders, phasors) if what == "total_peak" else np.abs(values)

    @property
    def _vehicle(self) -> VehicleAxes | None:
        """Axes of the vehicle in which vectors are; None for the engine's, in which they come."""
        return None

    def _turned(self, quantity: str, values: NDArray[Any]) -> NDArray[Any]:
        """Return values in the axes of a vehicle, if they are along x, y and z or about them."""
        vehicle, kind = self._vehicle, self._kind(quantity)
        if vehicle is None:
            return values
        if kind.axes == ("x", "y", "z"):
            about = kind.components[0].startswith("about")
            return vehicle._vectors(values, about=about)
        if kind.dims[-1:] == ("component",) and not kind.real:
            both = (values[..., :3], values[..., 3:])
            turned = (vehicle._vectors(part, about=k > 0) for k, part in enumerate(both))
            return np.concatenate([*turned], axis=-1)
        return values

    def _in_space(self, quantity: str, what: str) -> NDArray[np.float64]:
        """Compute peaks or rms values of phasors along x, y and z."""
        values, dims = self.read(quantity), self._dims(quantity)
        if what.endswith("rms"):
            return np.asarray(np.sqrt((self.read(quantity, f"{what}_xyz") ** 2).sum(axis=-1)))
        if what == "rms_xyz":
            return np.asarray(np.abs(values) / np.sqrt(2.0))
        if what == "total_rms_xyz":
            squares = self.read(quantity, "rms_xyz") ** 2
            return np.asarray(np.sqrt(squares.sum(axis=dims.index("order"))))
        total = what.startswith("total_")
        peaks = self._once((quantity, "peaks", total), lambda: self._peaks(values, dims, total))
        return peaks[..., :3] if what.endswith("_xyz") else peaks[..., 3]  # type: ignore[no-any-return]

    def _peaks(
        self, values: NDArray[np.complex128], dims: tuple[str, ...], total: bool
    ) -> NDArray[np.float64]:
        """Return peaks along x, y and z, and of the length: (…, 4)."""
        if total:
            values = np.moveaxis(values, dims.index("order"), -2)
            rows = np.ascontiguousarray(values.reshape(-1, 3))
            peaks = _core.peaks_of_vectors(list(self._orders), rows)
            return read_only(peaks.reshape(*values.shape[:-2], 4))
        # Each row by itself, an ellipse: whatever order it is of.
        peaks = _core.peaks_of_vectors([1], np.ascontiguousarray(values.reshape(-1, 3)))
        return read_only(peaks.reshape(*values.shape[:-1], 4))

    def _at_order(self, order: Order) -> Labelled:
        """Return the same result of an order that it does not have."""
        hint = f"choose from {labels.orders_text(self._orders)}"
        raise inputs.rejected("order", order, hint)

    def _read_order(self, order: Order, quantity: str, what: str) -> Any:  # noqa: ANN401 - as read
        """Return a part of an array: that of one order, which may not be among ``orders``."""
        orders = self._orders
        if order not in orders:
            return self._at_order(order)._read_order(order, quantity, what)
        axis = self._dims(quantity, what).index("order")
        at: Any = (*(slice(None) for _ in range(axis)), orders.index(order))
        return self.read(quantity, what)[at]

    # --- selection and export -------------------------------------------------------------------

    def sel(self, **coordinates: object) -> Any:  # noqa: ANN401 - more of some results
        """Return the quantities at values of coordinates.

        Parameters
        ----------
        **coordinates : dict, optional
            A value for some dimensions of ``coords``, or an ``order``.

        Returns
        -------
        mapping of str to Quantity
            Name → quantity without these dimensions, as far as it has them.

        Raises
        ------
        InputError
            If there is no such dimension, or the value is not among its coordinates.
        """
        for name in coordinates:
            inputs.one_of("dimension", name, dict.fromkeys((*self.dims, *self._along)))
        return MappingProxyType(
            {
                name: whole.sel(**{d: at for d, at in coordinates.items() if d in whole.dims})
                for name, whole in self.quantities.items()
            }
        )

    def _chosen(self, quantities: tuple[str, ...]) -> tuple[str, ...]:
        """Return the quantities named; if none is named, all with their parts."""
        names = self._names
        for name in quantities:
            inputs.one_of("quantity", name, names)
        return quantities or names

    def _in_datasets(self, quantity: str) -> tuple[str, ...]:
        """Return the names of the arrays of a quantity that a dataset has."""
        return (VALUES,)

    def tidy(self, *quantities: str) -> Table:
        """Return the long form, a row for each point, order, quantity and component.

        Columns are the dimensions, quantity, component, of peak phasors ``real``, ``imag`` and
        ``peak``, of others ``value``, and unit.

        Parameters
        ----------
        *quantities : str, optional
            Names of ``quantities``; by default all there are.

        Returns
        -------
        Table
            The rows; its ``to_pandas`` and ``to_csv`` write them.

        Raises
        ------
        InputError
            If there is no such quantity.

        Examples
        --------
        >>> import crankpin as cp
        >>> i4 = cp.Engine.preset("i4")
        >>> list(cp.sweep(i4, rpm=[3000, 6000], orders=[2]).tidy("torque"))
        ['rpm', 'order', 'quantity', 'component', 'real', 'imag', 'peak', 'unit']
        >>> list(i4.waveform(3000).tidy("force"))
        ['theta_deg', 'quantity', 'component', 'value', 'unit']
        """
        named = [self._quantity(name) for name in self._chosen(quantities)]
        return export.long(named, self.loads_counted)

    def to_xarray(
        self,
        *quantities: str,
        frame: str | None = None,
        units: str = "",
        split_complex: bool = False,
    ) -> xr.Dataset:
        """Return the arrays with dimensions, units and bounds (needs xarray).

        Of orders these are phasors, of balances and sweeps peaks and totals too.

        Parameters
        ----------
        *quantities : str, optional
            Names of ``quantities``; by default all there are.
        frame : str, optional
            Name of one of ``frames``, to return its rows instead.
        units : str, default ""
            Units of its numbers, as :func:`crankpin.units` takes them, by default those of results,
            SI.
        split_complex : bool, default False
            Store complex arrays as real ones with a dimension ``part`` of "re" and "im", for
            ``to_netcdf(path)``: netCDF has no complex numbers. With the package netCDF4,
            ``to_netcdf(path, auto_complex=True)`` writes complex arrays too.

        Returns
        -------
        xarray.Dataset
            The arrays, with units as attributes.

        Raises
        ------
        InputError
            If there is no such quantity, frame or unit.
        ImportError
            If xarray is not installed.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[1, 2])
        >>> s.to_xarray("force").force.dims
        ('rpm', 'order', 'axis')
        >>> s.waveform([0, 90, 180]).to_xarray("force").force.dims
        ('rpm', 'theta_deg', 'axis')
        """
        if frame is not None:
            return super().to_xarray(frame=frame, units=units, split_complex=split_complex)
        split = inputs.flag("split_complex", split_complex)
        named = [self._quantity(name) for name in self._chosen(quantities)]
        whole = in_units(export.dataset(self, named), unit_names.read(units))
        return optional.split_complex(whole) if split else whole


# --- force, moment and torques --------------------------------------------------------------------


class ShakingQuantities(Generic[Element, Values, Value]):
    """Mixin of what has force, moment and torques."""

    if TYPE_CHECKING:

        def _quantity(self, name: str) -> Quantity[Any, Any, Any]: ...

    @property
    def force(self) -> Quantity[Element, Values, Value]:
        """Shaking force along x and y, N: (…, n_orders, 2) or (…, n_theta, 2)."""
        return self._quantity("force")

    @property
    def moment(self) -> Quantity[Element, Values, Value]:
        """Rocking moment about x (pitch) and y (yaw), N·m: shaped as ``force``."""
        return self._quantity("moment")

    @property
    def torque(self) -> Quantity[Element, Values, Value]:
        """Roll torque on the block about +z, N·m: (…, n_orders) or (…, n_theta).

        Of inertia forces, and of gas if it counts. An AttributeError where it was not requested, or
        a force spectrum does not determine it.
        """
        return self._quantity("torque")

    @property
    def crank_torque(self) -> Quantity[Element, Values, Value]:
        """Torque on the crank about +z, N·m: (…, n_orders) or (…, n_theta).

        Of inertia forces, and of gas if it counts. An AttributeError where it was not requested, or
        a force spectrum does not determine it.
        """
        return self._quantity("crank_torque")


class Shaking(ShakingQuantities[Element, Values, Value], Labelled, Generic[Element, Values, Value]):
    """Base class of results that have force, moment and torques, by a request."""

    _registry: ClassVar[Mapping[str, Kind]] = QUANTITIES

    if TYPE_CHECKING:

        @property
        def _request(self) -> Request:
            """The options of the result, checked."""

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return False

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return ("inertia",)

    @property
    def _names(self) -> tuple[str, ...]:
        return self._request.named((), self.causes)

    def _check(self, quantity: str) -> None:
        self._request.check(quantity, self)

    def _parts(self, quantity: str) -> tuple[str, ...]:
        return parts_of(quantity, self.causes)

    def _named_parts(self, quantity: str) -> tuple[str, ...]:
        return self._request.parts(quantity, self.causes)

    def _loads_of(self, quantity: str) -> str:
        if self._request.pairs is not None or not kind_of(quantity).planar:
            return self.loads_counted
        return labels.without_gas(self.loads_counted)


# --- arrays of arrays -----------------------------------------------------------------------------


def _over_angle(
    values: NDArray[np.float64], along: int, what: str, *, vector: bool
) -> NDArray[np.float64]:
    """Return magnitudes of values over crank angle, or the largest of them."""
    if what == "peak_xy":
        return np.asarray(np.abs(values).max(axis=along, initial=0.0))
    sizes = np.hypot(values[..., 0], values[..., 1]) if vector else np.abs(values)
    return np.asarray(sizes if what == "magnitude" else sizes.max(axis=along, initial=0.0))


def _mean(values: NDArray[np.float64], theta_deg: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean over crank angles, the last dimension, by the trapezoidal rule."""
    order = np.argsort(theta_deg, kind="stable")
    values, theta = values[..., order], theta_deg[order]
    if len(theta) < 2 or theta[0] == theta[-1]:
        return values.mean(axis=-1) if len(theta) else np.zeros(values.shape[:-1])
    return np.asarray(np.trapezoid(values, theta, axis=-1) / (theta[-1] - theta[0]))


def total_peaks(
    orders: tuple[Order, ...], phasors: NDArray[np.complex128], mean: ArrayLike = 0.0
) -> NDArray[np.float64]:
    """Return the largest magnitude over θ of a mean and all orders: (…), of (…, n_orders)."""
    if not orders:
        return np.array(np.broadcast_to(np.abs(mean), phasors.shape[:-1]))
    rows = np.ascontiguousarray(phasors.reshape(-1, len(orders)))
    means = np.broadcast_to(mean, phasors.shape[:-1]).ravel()
    return _core.peaks_of_sums(list(orders), rows, means).reshape(phasors.shape[:-1])
