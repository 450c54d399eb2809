"""Sweeps as dask graphs: chunks that are ordinary sweeps, computed on demand."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin._support import inputs, optional
from crankpin._support.record import changed
from crankpin.analysis import export

if TYPE_CHECKING:
    import xarray as xr

    from crankpin.analysis.sweeps.sweep import Sweep

Chunks: TypeAlias = "int | str | Mapping[str, int | str | tuple[int, ...]]"
"""Points to a chunk: of every swept dimension, or by dimension, or ``"auto"``."""


def dataset(whole: Sweep, chunks: Chunks, quantities: Sequence[str]) -> xr.Dataset:
    """Return the sweep's arrays as an xarray Dataset of dask arrays."""
    dask = optional.library("dask.array")
    lengths = {name: len(values) for name, values in whole.coords.items()}
    if not lengths:
        raise inputs.faulty("sweep", "is of one point", "use to_xarray")
    sizes = lengths | {"order": len(whole.orders), "axis": 2}
    by_name = dict(zip(sizes, _normalized(chunks, lengths, sizes), strict=True))
    axes = {name: _axis(whole, name, by_name[name]) for name in lengths}
    # What every chunk has: its axes come in slices.
    first = {name: float(np.ravel(values)[0]) for name, values in whole.axes.items()}
    common = changed(whole, axes=first, _request=whole._of_parts)
    variables: dict[str, Any] = {}
    chosen = [whole._quantity(name) for name in quantities]
    pairs = [(kind, what) for kind in chosen for what in whole._in_datasets(kind.name)]
    for quantity, what in pairs:
        dims = quantity._dims_of(what)
        kind = np.complex128 if what in export.COMPLEX else np.float64
        slices = [part for dim in lengths for part in (axes[dim], (dim,))]
        if whole.orders:
            values = dask.blockwise(
                _block,
                dims,
                *slices,
                new_axes={dim: sizes[dim] for dim in dims if dim not in lengths},
                swept=tuple(lengths),
                common=common,
                quantity=quantity.name,
                what=what,
                # Slices of one axis along the one index that it has.
                concatenate=True,
                dtype=kind,
                meta=np.empty((0,) * len(dims), kind),
            )
        else:
            shape = tuple(sizes[dim] for dim in dims)
            values = dask.zeros(shape, dtype=kind, chunks=tuple(by_name[dim] for dim in dims))
        variables[export.variable(quantity.name, what)] = values
    return export.dataset(whole, chosen, variables)


def _block(
    *slices: Any,  # noqa: ANN401 - engines or numbers
    swept: tuple[str, ...],
    common: Sweep,
    quantity: str,
    what: str,
) -> Any:  # noqa: ANN401 - complex or real
    """Compute one chunk by an ordinary sweep."""
    axes: dict[str, Any] = dict(zip(swept, slices, strict=True))
    engines = tuple(axes.pop("engine", common.engines))
    names = None if common.names is None else tuple(engine.name for engine in engines)
    part = changed(common, engines=engines, names=names, axes={**common.axes, **axes})
    return part.read(quantity, what)


def _axis(whole: Sweep, name: str, chunks: tuple[int, ...]) -> Any:  # noqa: ANN401 - a dask array
    """Return the values of a dimension in chunks; of "engine" the engines."""
    dask = optional.library("dask.array")
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
    hint = 'give a number, "auto", or a mapping of ' + ", ".join(lengths) + " to these"
    wanted: dict[str, Any] = dict.fromkeys(sizes, -1)
    if isinstance(chunks, Mapping):
        for name in chunks:
            if name not in lengths:
                raise inputs.rejected("chunks", chunks, hint)
        wanted |= chunks
    else:
        wanted |= dict.fromkeys(lengths, chunks)
    try:
        if any(isinstance(length, (bool, np.bool_)) for length in wanted.values()):
            raise TypeError("True and False are not numbers of points")
        normalized: tuple[tuple[int, ...], ...] = optional.library(
            "dask.array"
        ).core.normalize_chunks(
            tuple(wanted.values()), shape=tuple(sizes.values()), dtype=np.complex128
        )
        if any(
            not length >= 1  # NaN too
            for size, lengths_of in zip(sizes.values(), normalized, strict=True)
            for length in lengths_of
            if size
        ):
            raise ValueError("a chunk has at least one point")
    except (TypeError, ValueError, ArithmeticError, NotImplementedError) as error:
        raise inputs.rejected("chunks", chunks, f"{hint} ({error})") from None
    return normalized
