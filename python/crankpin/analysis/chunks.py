"""Sweeps in chunks that dask works out when it is asked: the graph of a sweep of any size."""

from __future__ import annotations

import hashlib
import pickle
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, tables
from crankpin.analysis.sweep import Sweep, sweep, variables_of

if TYPE_CHECKING:
    import xarray as xr

Chunks: TypeAlias = "int | str | Mapping[str, int | str | tuple[int, ...]]"
"""Points to a chunk: of every swept dimension, or by dimension, or ``"auto"``."""


def dataset(whole: Sweep, chunks: Chunks) -> xr.Dataset:
    """Return the sweep's phasors and peaks as an xarray Dataset of dask arrays."""
    dask = tables.dask()
    lengths = {name: len(values) for name, values in whole.coords.items()}
    if not lengths:
        raise InputError("chunks: nothing is swept; leave it out")
    quantities: tuple[Any, ...] = ("force", "moment")
    if whole._arguments["torque"] and whole._arguments["spectrum"] is None:
        quantities = (*quantities, "torque")
    sizes = lengths | {"order": len(whole.orders), "axis": 2}
    by_name = dict(zip(sizes, _normalized(chunks, lengths, sizes), strict=True))
    axes = {name: _axis(whole, name, by_name[name]) for name in lengths}
    fixed: dict[str, Any] = {**whole.fixed, **whole._arguments, "orders": whole.orders}
    if "engine" not in lengths:
        fixed["engines"] = whole.engines[0]
    variables: dict[str, Any] = {}
    for variable in variables_of(*quantities):
        complex_valued = variable.name == variable.quantity
        dims = whole._variable_dims(variable)
        slices = [part for name in lengths for part in (axes[name], (name,))]
        values = dask.blockwise(
            _block,
            dims,
            *slices,
            new_axes={name: sizes[name] for name in dims if name not in lengths},
            dims=tuple(lengths),
            fixed=fixed,
            attribute=variable.name,
            # Slices of one axis along the one index that it has.
            concatenate=True,
            dtype=np.complex128 if complex_valued else np.float64,
            meta=np.empty((0,) * len(dims), np.complex128 if complex_valued else np.float64),
        )
        variables[variable.name] = (dims, values, variable.attributes)
    return whole._dataset(variables, quantities)


def _block(
    *slices: Any,  # noqa: ANN401 - engines or numbers
    dims: tuple[str, ...],
    fixed: Mapping[str, Any],
    attribute: str,
) -> Any:  # noqa: ANN401 - complex or real
    """Work out one chunk by an ordinary sweep."""
    given = dict(zip(dims, slices, strict=True))
    if "engine" in given:
        given["engines"] = list(given.pop("engine"))
    with warnings.catch_warnings():
        # Said once, of the whole.
        warnings.filterwarnings("ignore", "mean piston speed", UserWarning)
        return getattr(sweep(**fixed, **given), attribute)


def _axis(whole: Sweep, name: str, chunks: tuple[int, ...]) -> Any:  # noqa: ANN401 - a dask array
    """Return the values of a dimension in chunks; of "engine" the engines."""
    dask = tables.dask()
    if name != "engine":
        return dask.from_array(whole.coords[name], chunks=(chunks,))
    engines = np.empty(len(whole.engines), dtype=object)
    engines[:] = whole.engines
    token = hashlib.sha256(pickle.dumps(whole.engines)).hexdigest()[:32]
    return dask.from_array(engines, chunks=(chunks,), name=f"engines-{token}")


def _normalized(
    chunks: object, lengths: Mapping[str, int], sizes: Mapping[str, int]
) -> tuple[tuple[int, ...], ...]:
    """Return the lengths of the chunks of every dimension; those that are not swept stay whole."""
    cure = 'give a number, "auto", or a mapping of ' + ", ".join(lengths) + " to these"
    wanted: dict[str, Any] = dict.fromkeys(sizes, -1)
    if isinstance(chunks, Mapping):
        for name in chunks:
            if name not in lengths:
                raise InputError(f"chunks = {inputs.shorten(chunks)}: {cure}")
        wanted |= chunks
    else:
        wanted |= dict.fromkeys(lengths, chunks)
    try:
        if any(isinstance(length, (bool, np.bool_)) for length in wanted.values()):
            raise TypeError("True and False are no numbers of points")
        found: tuple[tuple[int, ...], ...] = tables.dask().core.normalize_chunks(
            tuple(wanted.values()), shape=tuple(sizes.values()), dtype=np.complex128
        )
        if any(length < 1 for lengths in found for length in lengths):
            raise ValueError("a chunk has one point at least")
    except (TypeError, ValueError, ArithmeticError, NotImplementedError) as error:
        raise InputError(f"chunks = {inputs.shorten(chunks)}: {cure} ({error})") from None
    return found
