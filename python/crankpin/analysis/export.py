"""Results as xarray datasets and as tables in long form."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin._support import units as unit_names
from crankpin._support.frames import Tabled, in_units
from crankpin._support.quantities import PLANE_VECTORS, kind_of
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from crankpin.analysis.request import Request

SMALLER = "sweep one axis in parts, or use to_dask"
"""Hint for results too large for memory."""
Variable: TypeAlias = "tuple[tuple[str, ...], Any, dict[str, str]]"
"""Dimensions, values and attributes of a variable of a dataset."""
TRAILING: dict[str, tuple[str, ...]] = {
    "phasors": ("order", "axis"),
    "forward": ("order",),
    "backward": ("order",),
    "zero_bound": ("order",),
    "peak": ("order",),
    "peak_xy": ("order", "axis"),
    "total_peak": (),
    "total_peak_xy": ("axis",),
    "mean": (),
}
"""Array of a plane vector → its dimensions after the swept ones; a scalar has no ``axis``."""
NOT_OF_SCALARS = ("forward", "backward", "peak_xy", "total_peak_xy")
COMPLEX = ("phasors", "forward", "backward")
"""Arrays of complex numbers."""
MEANS = ("mean",)
"""Arrays that only torques have which more than inertia makes."""


def variables(
    quantities: Sequence[str], *, means: bool
) -> Iterator[tuple[str, str, str, tuple[str, ...]]]:
    """Yield name, quantity, array and trailing dimensions of each variable of a dataset."""
    for quantity in quantities:
        planar = kind_of(quantity).planar
        absent = MEANS if planar else NOT_OF_SCALARS if means else (*NOT_OF_SCALARS, *MEANS)
        for what, dims in TRAILING.items():
            if what not in absent:
                name = quantity.replace(".", "_")
                name = name if what == "phasors" else f"{name}_{what}"
                yield name, quantity, what, tuple(d for d in dims if planar or d != "axis")


@cache
def arrays(quantity: str) -> tuple[str, ...]:
    """Return the names of the arrays of a quantity."""
    return tuple(what for _, _, what, _ in variables([quantity], means=True))


class Labelled(Tabled):
    """Base class of results that are arrays over dimensions, of which frames show the most."""

    if TYPE_CHECKING:

        @property
        def request(self) -> Request:
            """The options of the result, checked."""

        @property
        def error_bound(self) -> Mapping[str, float]:
            """Quantity → upper bound on what the omitted orders add, N or N·m."""

        @property
        def loads_counted(self) -> str:
            """Loads that count where more could, in words."""

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return False

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the causes of the quantities."""
        return ("inertia",)

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values."""
        return {}

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions before orders and axes."""
        return tuple(self.coords)

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset of the result."""
        return {}

    def _arrays(self, quantities: Sequence[str]) -> tuple[dict[str, Any], dict[str, Variable]]:
        """Return dimension → values, and the variables of a dataset of some quantities."""
        raise NotImplementedError

    def _figures(self, quantity: str) -> Mapping[str, Mapping[str, NDArray[np.float64]]]:
        """Return the columns of each component of a quantity in long form."""
        raise NotImplementedError

    def tidy(self, *quantities: str) -> Table:
        """Return the long form, a row for each point, order, quantity and component.

        Columns are the dimensions, ``order`` where there are orders, quantity, component, the peak
        phasor as ``real`` and ``imag`` with its ``peak``, or over crank angle ``value``, and unit.

        Parameters
        ----------
        *quantities : str, optional
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.

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
        named = self.request.named(quantities, self.causes)
        parts = [
            (quantity, component, figures)
            for quantity in named
            for component, figures in self._figures(quantity).items()
        ]
        return _long(self._arrays(())[0], parts, self.loads_counted)

    def to_xarray(
        self,
        *quantities: str,
        frame: str | None = None,
        units: str = "",
        split_complex: bool = False,
    ) -> xr.Dataset:
        """Return the arrays with dimensions, units and bounds (needs xarray).

        Of orders these are phasors, peaks and totals.

        Parameters
        ----------
        *quantities : str, optional
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
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
        named = self.request.named(quantities, self.causes)
        whole = in_units(dataset(self, named, *self._arrays(named)), unit_names.read(units))
        return optional.split_complex(whole) if split else whole


def dataset(
    result: Labelled,
    quantities: Sequence[str],
    coords: Mapping[str, Any],
    arrays: Mapping[str, Variable],
) -> xr.Dataset:
    """Return arrays of some quantities with dimensions, units, loads and bounds."""
    labelled = labels.coordinates(coords)
    if set(PLANE_VECTORS) & set(quantities):
        labelled["axis"] = ("axis", ["x", "y"])
    attributes = dict(result._attributes) | labels.attributes(result.loads_counted)
    for name in quantities:
        bound = result.error_bound[name.partition(".")[0]]
        attributes[f"{name.replace('.', '_')}_error_bound"] = bound
    return optional.dataset(arrays, labelled, attributes)


def units(quantity: str) -> dict[str, str]:
    """Return the attributes of a quantity's variables."""
    return {"units": kind_of(quantity).xarray_unit}


def fitting(coords: Mapping[str, Any], *arrays: tuple[Iterable[str], int]) -> None:
    """Raise an InputError if arrays are too large together: of each its dimensions and bytes."""
    lengths = {name: len(values) for name, values in coords.items()} | {"axis": 2}
    size = sum(width * math.prod(lengths[dim] for dim in dims) for dims, width in arrays)
    inputs.fitting("sweep" if {*coords} & {*labels.SWEPT} else "table", size, SMALLER)


def points(coords: Mapping[str, Any], beside: int, times: int = 1) -> list[Column]:
    """Return a column of each dimension, a row for each point, or several times all points.

    Raises an InputError if these columns and as many ``beside`` them are too large.
    """
    fitting(coords, (coords, 8 * times * (len(coords) + beside)))
    shape = tuple(len(values) for values in coords.values())
    columns = []
    for axis, (name, values) in enumerate(coords.items()):
        along = column(values).reshape(-1, *(1,) * (len(shape) - axis - 1))
        columns.append(Column(name, np.broadcast_to(along, (times, *shape)), digits=10))
    return columns


def column(values: object) -> NDArray[Any]:
    """Return values as an array; texts as objects, which rows share."""
    array = np.asarray(values)
    return array.astype(object) if array.dtype.kind == "U" else array


def _long(
    coords: Mapping[str, Any],
    parts: Sequence[tuple[str, str, Mapping[str, NDArray[np.float64]]]],
    loads: str,
) -> Table:
    """Return figures of each quantity and component, below each other."""
    count = math.prod(len(values) for values in coords.values())

    def repeated(name: str, texts: Iterable[str]) -> Column:
        return Column(name, np.repeat(column([*texts]), count))

    columns = points(coords, 6, len(parts))
    columns.append(repeated("quantity", (quantity for quantity, _, _ in parts)))
    columns.append(repeated("component", (component for _, component, _ in parts)))
    for head in parts[0][2]:
        columns.append(Column(head, np.concatenate([np.ravel(each[head]) for *_, each in parts])))
    columns.append(repeated("unit", (kind_of(quantity).unit for quantity, _, _ in parts)))
    units = tuple(columns[-1].data)
    return Table("Long form", tuple(columns), loads=loads, row_units=units)
