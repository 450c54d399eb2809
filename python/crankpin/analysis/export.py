"""Results as xarray datasets and as tables in long form."""

from __future__ import annotations

import itertools
import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin._support.quantities import KINDS, PLANE_VECTORS
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from crankpin.analysis.by_order import ByOrder
    from crankpin.analysis.waveform import OverAngle

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
OF_GAS = ("mean",)
"""Arrays that only torques of fired engines have."""


def variables(
    quantities: Sequence[str], *, fired: bool
) -> Iterator[tuple[str, str, str, tuple[str, ...]]]:
    """Yield name, quantity, array and trailing dimensions of each variable of a dataset."""
    for quantity in quantities:
        planar = KINDS[quantity].planar
        absent = OF_GAS if planar else NOT_OF_SCALARS if fired else (*NOT_OF_SCALARS, *OF_GAS)
        for what, dims in TRAILING.items():
            if what not in absent:
                name = quantity.replace(".", "_")
                name = name if what == "phasors" else f"{name}_{what}"
                yield name, quantity, what, tuple(d for d in dims if planar or d != "axis")


@cache
def arrays(quantity: str) -> tuple[str, ...]:
    """Return the names of the arrays of a quantity."""
    return tuple(what for _, _, what, _ in variables([quantity], fired=True))


def to_xarray(
    result: ByOrder,
    quantities: Sequence[str],
    arrays: Mapping[str, Any] | None = None,
    *,
    split_complex: bool = False,
) -> xr.Dataset:
    """Return the arrays of some quantities, or those given, with named dimensions and units."""
    if arrays is None:
        arrays = {
            name: ((*result.dims, *dims), result.read(quantity, what), units(quantity))
            for name, quantity, what, dims in variables(quantities, fired=result.fired)
        }
    whole = all(isinstance(order, int) for order in result.orders)
    orders = np.array(result.orders, dtype=np.int64 if whole else np.float64)
    coords = _labelled(result.coords, quantities)
    coords["order"] = ("order", orders, {"units": labels.XARRAY_UNITS["order"]})
    bounds = {
        f"{name.replace('.', '_')}_error_bound": result.error_bound[name.partition(".")[0]]
        for name in quantities
    }
    if inputs.flag("split_complex", split_complex):
        arrays = {name: _split(variable) for name, variable in arrays.items()}
        coords["part"] = ("part", ["re", "im"])
    loads = labels.attributes(result.loads_counted)
    return optional.dataset(arrays, coords, {**result._attributes, **loads, **bounds})


def _split(variable: tuple[tuple[str, ...], Any, dict[str, str]]) -> Any:  # noqa: ANN401
    dims, values, attributes = variable
    if values.dtype.kind != "c":
        return variable
    return ((*dims, "part"), np.stack([values.real, values.imag], axis=-1), attributes)


def _labelled(coords: Mapping[str, Any], quantities: Sequence[str]) -> dict[str, Any]:
    """Return coordinates with units, and the axes of forces and moments."""
    axes = {"axis": ("axis", ["x", "y"])} if set(PLANE_VECTORS) & set(quantities) else {}
    return labels.coordinates(coords) | axes


def units(quantity: str) -> dict[str, str]:
    """Return the attributes of a quantity's variables."""
    return {"units": KINDS[quantity].xarray_unit}


def tidy(result: ByOrder, quantities: Sequence[str]) -> Table:
    """Return phasors and peaks in long form: a row a point, order, quantity and component."""
    parts = []
    for quantity in quantities:
        phasors = result.read(quantity, "phasors")
        by_component: dict[str, NDArray[np.complex128]] = {"z": phasors}
        if quantity in PLANE_VECTORS:
            by_component = {
                "x": phasors[..., 0],
                "y": phasors[..., 1],
                "forward": result.read(quantity, "forward"),
                "backward": result.read(quantity, "backward"),
            }
        parts += [
            (quantity, component, {"real": each.real, "imag": each.imag, "peak": np.abs(each)})
            for component, each in by_component.items()
        ]
    coords = {**result.coords, "order": result.orders}
    return _long("Peak phasors by order", coords, parts, result.loads_counted)


def waveforms_tidy(result: OverAngle, quantities: Sequence[str]) -> Table:
    """Return values in long form: a row a point, quantity and component."""
    parts = []
    for name in quantities:
        values = result.read(name)
        planar = name in PLANE_VECTORS
        parts += [
            (name, component, {"value": values[..., k] if planar else values})
            for k, component in enumerate("xy" if planar else "z")
        ]
    return _long("Values over crank angle", result.coords, parts, result.loads_counted)


def points(coords: Mapping[str, Any], times: int = 1) -> list[Column]:
    """Return a column of each dimension, a row for each point, or several times all points."""
    listed = itertools.product(*(np.asarray(values).tolist() for values in coords.values()))
    columns = list(zip(*listed, strict=True)) or [()] * len(coords)
    return [
        Column(name, values * times, digits=10)
        for name, values in zip(coords, columns, strict=True)
    ]


def _long(
    title: str,
    coords: Mapping[str, Any],
    parts: Sequence[tuple[str, str, Mapping[str, NDArray[np.float64]]]],
    loads: str,
) -> Table:
    """Return figures of each quantity and component, below each other."""
    count = math.prod(len(values) for values in coords.values())

    def repeated(texts: Iterable[str]) -> tuple[str, ...]:
        return tuple(text for text in texts for _ in range(count))

    columns = points(coords, len(parts))
    columns.append(Column("quantity", repeated(quantity for quantity, _, _ in parts)))
    columns.append(Column("component", repeated(component for _, component, _ in parts)))
    for head in parts[0][2]:
        values = (figures[head].ravel().tolist() for *_, figures in parts)
        columns.append(Column(head, tuple(itertools.chain.from_iterable(values))))
    columns.append(Column("unit", repeated(KINDS[quantity].unit for quantity, _, _ in parts)))
    return Table(title, tuple(columns), loads=loads)


def waveforms_to_xarray(result: OverAngle, quantities: Sequence[str]) -> xr.Dataset:
    """Return values over coordinates, with named dimensions and units."""
    arrays = {}
    for name in quantities:
        dims = (*result.dims, "axis") if name in PLANE_VECTORS else result.dims
        arrays[name.replace(".", "_")] = (dims, result.read(name), units(name))
    coords = _labelled(result.coords, quantities)
    loads = labels.attributes(result.loads_counted)
    return optional.dataset(arrays, coords, {**result._attributes, **loads})
