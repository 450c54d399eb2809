"""Sweeps over engines, bank angle, rod ratio, pin offset and speed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core, _inputs, _tables
from crankpin._cylinder import explicit
from crankpin._engine import Engine
from crankpin._frozen import Frozen

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from crankpin._engine import Hold
    from crankpin._inputs import Orders, Spectrum

Engines: TypeAlias = Engine | Iterable[Engine] | Mapping[str, Engine]
Quantity: TypeAlias = Literal["force", "moment", "torque"]

UNITS = {
    "bank_angle_deg": "degree",
    "rod_ratio": "1",
    "pin_offset": "m",
    "rpm": "1/min",
    "order": "1/rev",
    "force": "N",
    "moment": "N m",
    "torque": "N m",
}


def sweep(
    engines: Engines,
    *,
    rpm: ArrayLike,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    rod_ratio: ArrayLike | None = None,
    pin_offset: ArrayLike | None = None,
    orders: Orders = (1, 2, 4, 6),
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
) -> Sweep:
    """Return how engines shake over any combination of bank angle, rod ratio, offset and speed.

    No crank angle is sampled: each point is a layout sum times a harmonic. Every array argument is a
    dimension of the result; a scalar is not. Values are worked out when they are asked for.

    Parameters
    ----------
    engines
        An engine, several, or a mapping name → engine.
    rpm
        Crank speeds.
    bank_angle_deg
        Angles between the two banks, 0 to 180.
    hold
        What a change of bank angle leaves as it is; must be said: ``"pins"`` (the crank; firing
        intervals change) or ``"firing"`` (every top dead centre; pins are split as needed).
    rod_ratio
        Crank radius / rod length; the radius stays, the rod changes.
    pin_offset
        Pin offset of every cylinder, m.
    orders
        Whole multiples of crank speed.
    reference_z, spectrum
        As in :meth:`Engine.balance`.

    Returns
    -------
    Sweep

    Raises
    ------
    InputError
        If an argument is out of range, or an engine does not have the two banks to be swept.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=np.arange(10, 180, 10), hold="pins", orders=[1, 2])
    >>> s.dims("moment")
    ('bank_angle_deg', 'order', 'axis')
    >>> s.moment.shape
    (17, 2, 2)
    """
    listed, names = _listed(engines)
    given = {
        "bank_angle_deg": bank_angle_deg,
        "rod_ratio": rod_ratio,
        "pin_offset": pin_offset,
        "rpm": rpm,
    }
    axes: dict[str, NDArray[np.float64]] = {}
    swept: dict[str, NDArray[np.float64] | list[str]] = {} if names is None else {"engine": names}
    fixed: dict[str, float] = {}
    for name, values in given.items():
        if values is None:
            continue
        axes[name] = axis = _inputs.vector(name, values)
        if np.ndim(values):
            swept[name] = _read_only(axis)
        else:
            fixed[name] = float(axis[0])
    wanted = explicit(orders)
    core = _core.Sweep(
        [engine._core for engine in listed],  # noqa: SLF001 - the two are one package
        axes.get("bank_angle_deg"),
        hold,
        axes.get("rod_ratio"),
        axes.get("pin_offset"),
        axes["rpm"],
        wanted,
        reference_z,
        _inputs.spectrum(spectrum),
    )
    _inputs.warn_of_units(core.largest_crank_radius, float(axes["rpm"].max()))
    arguments = {"reference_z": reference_z, "spectrum": spectrum, "orders": tuple(wanted)}
    return Sweep(core, tuple(listed), swept, fixed, hold, arguments)


class Sweep(Frozen):
    """How engines shake over swept quantities: labelled arrays, worked out when asked for.

    Dimensions, where swept, come in the order ``engine``, ``bank_angle_deg``, ``rod_ratio``,
    ``pin_offset``, ``rpm``, then ``order`` and ``axis``. Made by :func:`crankpin.sweep`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4, i6 = cp.Engine.preset("i4"), cp.Engine.preset("i6")
    >>> s = cp.sweep([i4, i6], rpm=[3000, 6000], rod_ratio=[0.25, 0.3, 0.35], orders=[2])
    >>> s.force_peak_xy.shape
    (2, 3, 2, 1, 2)
    >>> s.force_sum_peak_vector.shape
    (2, 3, 2)
    """

    engines: tuple[Engine, ...]
    """The engines."""
    orders: tuple[int, ...]
    """Multiples of crank speed."""
    coords: Mapping[str, NDArray[np.float64] | list[str]]
    """Swept dimension → its values, in the order of the result's dimensions."""
    fixed: Mapping[str, float]
    """What was given as a single value."""
    hold: Hold | None
    """What a change of bank angle leaves as it is."""

    def __init__(
        self,
        core: _core.Sweep,
        engines: tuple[Engine, ...],
        swept: dict[str, NDArray[np.float64] | list[str]],
        fixed: dict[str, float],
        hold: Hold | None,
        arguments: dict[str, Any],
    ) -> None:
        self._set(
            _core=core,
            engines=engines,
            coords=MappingProxyType(swept),
            orders=arguments["orders"],
            fixed=MappingProxyType(fixed),
            hold=hold,
            _arguments=arguments,
            _swept_shape=tuple([len(values) for values in swept.values()]),
        )

    _core: _core.Sweep
    _arguments: dict[str, Any]
    _swept_shape: tuple[int, ...]

    def dims(self, quantity: Quantity = "moment") -> tuple[str, ...]:
        """Return the names of a quantity's dimensions."""
        return (*self.coords, *_ORDER_DIMS[quantity])

    # --- phasors --------------------------------------------------------------------------------

    @cached_property
    def force(self) -> NDArray[np.complex128]:
        """Peak phasors of the shaking force along x and y, N: (…, n_orders, 2)."""
        return self._shaped(self._core.phasors("force"), 2)

    @cached_property
    def moment(self) -> NDArray[np.complex128]:
        """Peak phasors of the rocking moment about x and y, N·m: (…, n_orders, 2)."""
        return self._shaped(self._core.phasors("moment"), 2)

    @cached_property
    def torque(self) -> NDArray[np.complex128]:
        """Peak phasors of the roll torque on the block, N·m: (…, n_orders)."""
        return self._shaped(self._core.phasors("torque")[..., 0], 1)

    # --- peaks of each order --------------------------------------------------------------------

    @cached_property
    def force_peak_xy(self) -> NDArray[np.float64]:
        """Largest force of each order along x and along y, N: (…, n_orders, 2)."""
        return self._shaped(self._core.peaks("force"), 2)

    @cached_property
    def moment_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment of each order about x and about y, N·m: (…, n_orders, 2)."""
        return self._shaped(self._core.peaks("moment"), 2)

    @cached_property
    def torque_peak(self) -> NDArray[np.float64]:
        """Largest roll torque of each order, N·m: (…, n_orders)."""
        return self._shaped(self._core.peaks("torque")[..., 0], 1)

    @cached_property
    def force_peak_vector(self) -> NDArray[np.float64]:
        """Longest force of each order, N: (…, n_orders)."""
        return self._shaped(self._core.vector_peaks("force"), 1)

    @cached_property
    def moment_peak_vector(self) -> NDArray[np.float64]:
        """Longest moment of each order, N·m: (…, n_orders)."""
        return self._shaped(self._core.vector_peaks("moment"), 1)

    # --- peaks of the sum of orders -------------------------------------------------------------

    @cached_property
    def force_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest force along x and along y of all orders together, N: (…, 2); true extrema."""
        return self._shaped(self._core.sum_peaks("force"), 1)

    @cached_property
    def moment_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment about x and y of all orders together, N·m: (…, 2); true extrema."""
        return self._shaped(self._core.sum_peaks("moment"), 1)

    @cached_property
    def torque_sum_peak(self) -> NDArray[np.float64]:
        """Largest roll torque of all orders together, N·m: (…); true extrema."""
        return self._shaped(self._core.sum_peaks("torque")[..., 0], 0)

    @cached_property
    def force_sum_peak_vector(self) -> NDArray[np.float64]:
        """Longest force of all orders together, N: (…); true extrema."""
        return self._shaped(self._core.sum_vector_peaks("force"), 0)

    @cached_property
    def moment_sum_peak_vector(self) -> NDArray[np.float64]:
        """Longest moment of all orders together, N·m: (…); true extrema."""
        return self._shaped(self._core.sum_vector_peaks("moment"), 0)

    def _shaped(self, values: NDArray[Any], kept: int) -> NDArray[Any]:
        return values.reshape(self._swept_shape + values.shape[values.ndim - kept :])

    # --- tables and pictures --------------------------------------------------------------------

    def to_xarray(self, *quantities: Quantity) -> xr.Dataset:
        """Return phasors and peaks with named dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``; by default force and moment.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[1, 2])
        >>> s.to_xarray("force").force.dims
        ('rpm', 'order', 'axis')
        """
        variables = {}
        for quantity in quantities or ("force", "moment"):
            dims, attributes = self.dims(quantity), {"units": UNITS[quantity]}
            suffix = "" if quantity == "torque" else "_xy"
            summed = tuple(dim for dim in dims if dim != "order")
            variables[quantity] = (dims, getattr(self, quantity), attributes)
            for name, of in ((f"{quantity}_peak{suffix}", dims), (f"{quantity}_sum_peak{suffix}", summed)):
                variables[name] = (of, getattr(self, name), attributes)
        coords: dict[str, Any] = {
            name: (name, values, {"units": UNITS[name]} if name in UNITS else {})
            for name, values in self.coords.items()
        }
        coords["order"] = ("order", list(self.orders), {"units": UNITS["order"]})
        if any(quantity != "torque" for quantity in quantities or ("force",)):
            coords["axis"] = ("axis", ["x", "y"])
        attributes = dict(self.fixed) | ({"hold": self.hold} if self.hold else {})
        return _tables.xarray().Dataset(variables, coords, attributes)

    def to_pandas(self, quantity: Quantity = "moment") -> pd.DataFrame:
        """Return the peaks of each order as a table, one row a swept point (needs pandas).

        Columns are (order, axis); rows are labelled by the swept values.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[3000, 6000], orders=[2])
        >>> s.to_pandas("force").shape
        (2, 2)
        """
        pandas = _tables.pandas()
        peaks = self._peaks(quantity)
        axes = ["z"] if quantity == "torque" else ["x", "y"]
        columns = pandas.MultiIndex.from_product([self.orders, axes], names=["order", "axis"])
        if self.coords:
            index = pandas.MultiIndex.from_product(list(self.coords.values()), names=list(self.coords))
            if len(self.coords) == 1:
                index = index.get_level_values(0)
        else:
            index = None
        return pandas.DataFrame(peaks.reshape(-1, len(columns)), index=index, columns=columns)

    def plot(self, *, quantity: Quantity = "moment", x: str | None = None) -> Figure:
        """Draw the peaks of each order over a swept quantity; return the figure.

        One panel for each order and axis, one curve for each combination of the other dimensions.

        Parameters
        ----------
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.
        x
            The dimension along the horizontal axis; by default the longest.
        """
        from crankpin import _plots  # noqa: PLC0415 - matplotlib is imported when used

        return _plots.sweep(self, quantity, x)

    def _peaks(self, quantity: Quantity) -> NDArray[np.float64]:
        name = "torque_peak" if quantity == "torque" else f"{quantity}_peak_xy"
        return getattr(self, name)  # type: ignore[no-any-return]

    def __reduce__(self) -> tuple[Any, ...]:
        axes = {name: values for name, values in self.coords.items() if name != "engine"}
        names = self.coords.get("engine")
        arguments = self._arguments | dict(self.fixed) | axes | {"hold": self.hold}
        return (_again, (self.engines, names, arguments))

    def __repr__(self) -> str:
        swept = ", ".join(f"{name}: {len(values)}" for name, values in self.coords.items())
        held = f", hold={self.hold!r}" if self.hold else ""
        return f"<Sweep over ({swept}), orders {list(self.orders)}{held}>"


_ORDER_DIMS: dict[str, tuple[str, ...]] = {
    "force": ("order", "axis"),
    "moment": ("order", "axis"),
    "torque": ("order",),
}


def _again(engines: tuple[Engine, ...], names: list[str] | None, arguments: dict[str, Any]) -> Sweep:
    if names is None:
        return sweep(engines[0], **arguments)
    return sweep(dict(zip(names, engines, strict=True)), **arguments)


def _listed(engines: Engines) -> tuple[list[Engine], list[str] | None]:
    """Return the engines, and their names where there may be several."""
    if isinstance(engines, Engine):
        return [engines], None
    names: list[str] | None = None
    if isinstance(engines, Mapping):
        names, engines = [str(name) for name in engines], list(engines.values())
    listed = list(engines) if isinstance(engines, Iterable) else [engines]
    for engine in listed:
        if not isinstance(engine, Engine):
            raise _core.InputError(f"engines = {_inputs.shorten(engine)}: give crankpin.Engine objects")
    return listed, _names(listed) if names is None else names


def _names(engines: list[Engine]) -> list[str]:
    """Name engines by their names where these tell them apart, else by number."""
    names = [engine.name for engine in engines]
    if "" not in names and len(set(names)) == len(names):
        return names
    return [f"{k + 1} {name}".strip() for k, name in enumerate(names)]


def _read_only(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a copy: the caller's own array stays writable."""
    values = values.copy()
    values.setflags(write=False)
    return values
