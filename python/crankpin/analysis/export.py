"""Results as xarray datasets and tidy pandas tables."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin._support.quantities import KINDS, PLANE_VECTORS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pandas as pd
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


def to_pandas(result: ByOrder, quantities: Sequence[str]) -> pd.DataFrame:
    """Return phasors and peaks as a tidy table: a row a point, order, quantity and component."""
    columns = []
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
        for component, values in by_component.items():
            flat = values.ravel()
            figures = {"real": flat.real, "imag": flat.imag, "peak": np.abs(flat)}
            columns.append((quantity, component, figures))
    return _tidy({**result.coords, "order": result.orders}, columns, result.loads_counted)


def waveforms_to_pandas(result: OverAngle, quantities: Sequence[str]) -> pd.DataFrame:
    """Return values as a tidy table: a row a point, quantity and component."""
    columns = []
    for name in quantities:
        values = result.read(name)
        planar = name in PLANE_VECTORS
        for k, component in enumerate("xy" if planar else "z"):
            figures = {"value": (values[..., k] if planar else values).ravel()}
            columns.append((name, component, figures))
    return _tidy(result.coords, columns, result.loads_counted)


def _tidy(
    coords: Mapping[str, Any], columns: Sequence[tuple[str, str, Mapping[str, Any]]], loads: str
) -> pd.DataFrame:
    """Return figures of each quantity and component, below each other."""
    pandas = optional.library("pandas")
    points = {name: list(values) for name, values in coords.items()}
    index = pandas.MultiIndex.from_product(list(points.values()), names=list(points))
    parts = [
        pandas.DataFrame(
            {"quantity": quantity, "component": component, **figures, "unit": KINDS[quantity].unit},
            index=index,
        ).reset_index()
        for quantity, component, figures in columns
    ]
    table: pd.DataFrame = pandas.concat(parts, ignore_index=True)
    table.attrs.update(labels.attributes(loads))
    return table


def waveforms_to_xarray(result: OverAngle, quantities: Sequence[str]) -> xr.Dataset:
    """Return values over coordinates, with named dimensions and units."""
    arrays = {}
    for name in quantities:
        dims = (*result.dims, "axis") if name in PLANE_VECTORS else result.dims
        arrays[name.replace(".", "_")] = (dims, result.read(name), units(name))
    coords = _labelled(result.coords, quantities)
    loads = labels.attributes(result.loads_counted)
    return optional.dataset(arrays, coords, {**result._attributes, **loads})
