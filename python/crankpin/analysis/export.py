"""Balances and sweeps as xarray datasets and tidy pandas tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin.analysis.source import arrays_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from crankpin.analysis.source import Source


def variables(quantities: Sequence[str]) -> Iterator[tuple[str, str, str, tuple[str, ...]]]:
    """Yield name, quantity, array and trailing dimensions of each variable of a dataset."""
    for quantity in quantities:
        for what, dims in arrays_of(quantity).items():
            name = quantity if what == "phasors" else f"{quantity}_{what}"
            yield name, quantity, what, dims


def to_xarray(
    source: Source,
    quantities: Sequence[str],
    coords: Mapping[str, Any],
    attributes: Mapping[str, Any],
    *,
    split_complex: bool,
) -> xr.Dataset:
    """Return all arrays of some quantities with named dimensions and units."""
    arrays = {
        name: ((*source.dims, *dims), source.read(quantity, what), {"units": unit(quantity)})
        for name, quantity, what, dims in variables(quantities)
    }
    return dataset(source, quantities, arrays, coords, attributes, split_complex=split_complex)


def dataset(
    source: Source,
    quantities: Sequence[str],
    arrays: Mapping[str, Any],
    coords: Mapping[str, Any],
    attributes: Mapping[str, Any],
    *,
    split_complex: bool,
) -> xr.Dataset:
    """Return a dataset of arrays with the coordinates and attributes of a balance or sweep."""
    orders = np.array(source.orders, dtype=np.int64)
    labelled: dict[str, Any] = labels.coordinates(coords)
    labelled["order"] = ("order", orders, {"units": labels.XARRAY_UNITS["order"]})
    if {"force", "moment"} & set(quantities):
        labelled["axis"] = ("axis", ["x", "y"])
    bounds = source.error_bound._asdict()
    limits = {
        f"{quantity}_error_bound": bounds["torque" if quantity == "crank_torque" else quantity]
        for quantity in quantities
    }
    return made(arrays, labelled, {**attributes, **limits}, split_complex=split_complex)


def made(
    arrays: Mapping[str, Any],
    coords: Mapping[str, Any],
    attributes: Mapping[str, Any],
    *,
    split_complex: bool = False,
) -> xr.Dataset:
    """Return a dataset, complex arrays split into a dimension ``part`` if asked."""
    if inputs.flag("split_complex", split_complex):
        arrays = {name: _split(variable) for name, variable in arrays.items()}
        coords = {**coords, "part": ("part", ["re", "im"])}
    found: xr.Dataset = optional.xarray().Dataset(arrays, coords, attributes)
    return found


def _split(variable: tuple[tuple[str, ...], Any, dict[str, str]]) -> Any:  # noqa: ANN401
    dims, values, attributes = variable
    if values.dtype.kind != "c":
        return variable
    return ((*dims, "part"), np.stack([values.real, values.imag], axis=-1), attributes)


def unit(quantity: str) -> str:
    """Return the unit of a quantity as xarray's users write it."""
    return labels.XARRAY_UNITS[quantity]


def to_pandas(source: Source, quantities: Sequence[str], coords: Mapping[str, Any]) -> pd.DataFrame:
    """Return phasors and peaks as a tidy table: a row a point, order, quantity and component."""
    pandas = optional.pandas()
    parts = []
    points = {name: list(values) for name, values in coords.items()}
    for quantity in quantities:
        phasors = np.asarray(source.read(quantity, "phasors"))
        by_component: dict[str, NDArray[np.complex128]] = {"z": phasors}
        if quantity in ("force", "moment"):
            by_component = {
                "x": phasors[..., 0],
                "y": phasors[..., 1],
                "forward": source.read(quantity, "forward"),
                "backward": source.read(quantity, "backward"),
            }
        for component, values in by_component.items():
            index = pandas.MultiIndex.from_product(
                [*points.values(), source.orders], names=[*points, "order"]
            )
            flat = values.ravel()
            columns = {
                "quantity": quantity,
                "component": component,
                "real": flat.real,
                "imag": flat.imag,
                "peak": np.abs(flat),
                "unit": labels.UNITS[quantity],
            }
            parts.append(pandas.DataFrame(columns, index=index).reset_index())
    table: pd.DataFrame = pandas.concat(parts, ignore_index=True)
    return table
