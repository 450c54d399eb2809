"""Balances and sweeps as xarray datasets and tidy pandas tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.source import arrays_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pandas as pd
    import xarray as xr
    from numpy.typing import NDArray

    from crankpin.analysis.source import Source
    from crankpin.analysis.sweeps.waveform import SweepWaveform
    from crankpin.analysis.waveform import Waveform


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
        name: (
            (*source.dims, *dims),
            source.read(quantity, what),
            {"units": QUANTITIES[quantity].xarray_unit},
        )
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
    labelled = _labelled(coords, quantities)
    labelled["order"] = ("order", orders, {"units": labels.XARRAY_UNITS["order"]})
    bounds = source.error_bound._asdict()
    limits = {
        f"{quantity}_error_bound": bounds["torque" if quantity == "crank_torque" else quantity]
        for quantity in quantities
    }
    return made(arrays, labelled, {**attributes, **limits}, split_complex=split_complex)


def waveforms_to_xarray(
    result: Waveform | SweepWaveform,
    quantities: Sequence[str],
    coords: Mapping[str, Any],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Return values over coordinates, with named dimensions and units."""
    arrays = {}
    for name in quantities:
        dims = (*coords, "axis") if name in PLANE_VECTORS else tuple(coords)
        arrays[name] = (dims, getattr(result, name), units(name))
    return made(arrays, _labelled(coords, quantities), attributes)


def _labelled(coords: Mapping[str, Any], quantities: Sequence[str]) -> dict[str, Any]:
    """Return coordinates with units, and the axes of forces and moments."""
    axes = {"axis": ("axis", ["x", "y"])} if set(PLANE_VECTORS) & set(quantities) else {}
    return labels.coordinates(coords) | axes


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


def units(quantity: str) -> dict[str, str]:
    """Return the attributes of a quantity's variables."""
    return {"units": QUANTITIES[quantity].xarray_unit}


def to_pandas(source: Source, quantities: Sequence[str], coords: Mapping[str, Any]) -> pd.DataFrame:
    """Return phasors and peaks as a tidy table: a row a point, order, quantity and component."""
    pandas = optional.pandas()
    parts = []
    points = {name: list(values) for name, values in coords.items()}
    for quantity in quantities:
        phasors = np.asarray(source.read(quantity, "phasors"))
        by_component: dict[str, NDArray[np.complex128]] = {"z": phasors}
        if quantity in PLANE_VECTORS:
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
                "unit": QUANTITIES[quantity].unit,
            }
            parts.append(pandas.DataFrame(columns, index=index).reset_index())
    table: pd.DataFrame = pandas.concat(parts, ignore_index=True)
    return table


def waveforms_to_pandas(
    result: Waveform | SweepWaveform, quantities: Sequence[str], coords: Mapping[str, Any]
) -> pd.DataFrame:
    """Return values as a tidy table: a row a point, quantity and component."""
    pandas = optional.pandas()
    points = {name: list(values) for name, values in coords.items()}
    index = pandas.MultiIndex.from_product(list(points.values()), names=list(points))
    parts = []
    for name in quantities:
        values = getattr(result, name)
        planar = name in PLANE_VECTORS
        for k, component in enumerate("xy" if planar else "z"):
            columns = {
                "quantity": name,
                "component": component,
                "value": (values[..., k] if planar else values).ravel(),
                "unit": QUANTITIES[name].unit,
            }
            parts.append(pandas.DataFrame(columns, index=index).reset_index())
    table: pd.DataFrame = pandas.concat(parts, ignore_index=True)
    return table
