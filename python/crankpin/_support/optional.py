"""Optional libraries, imported at first use."""

from __future__ import annotations

import itertools
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import lazy

if TYPE_CHECKING:
    from collections.abc import Container, Mapping

    import xarray as xr

EXTRAS = {
    "anywidget": "view",
    "dask.array": "dask",
    "h5py": "hdf5",
    "matplotlib": "plot",
    "openpyxl": "excel",
    "scipy.io": "optimize",
    "scipy.optimize": "optimize",
    "sympy": "exact",
    "tqdm.auto": "progress",
}
"""Library → the extra that installs it, where that has another name."""


def library(name: str) -> Any:  # noqa: ANN401 - a module
    """Return a library, or raise an ImportError that names the extra to install."""
    try:
        return lazy.imported(name)
    except ImportError as error:
        hint = f'pip install "crankpin[{EXTRAS.get(name, name)}]"'
        raise ImportError(f"{name} is not installed: {hint}") from error


LEGAL = re.compile(r"[-0-9A-Za-z_.@+ !\"#$%&\\()*,:;<=>?\[\]^`{|}~\xa1-\xff]+(?<! )")
"""Names of variables and attributes that every writer of NetCDF 3 takes."""


def dataset(
    arrays: Mapping[str, tuple[Any, ...]],
    coords: Mapping[str, object],
    attributes: Mapping[str, object],
) -> xr.Dataset:
    """Return arrays of xarray with their coordinates and attributes.

    A name that files of NetCDF cannot have is replaced, and is the array's ``long_name``.
    """
    named: dict[str, tuple[Any, ...]] = {}
    for name, (dims, values, about) in arrays.items():
        legal = _legal(name, named)
        named[legal] = (dims, values, about if legal == name else about | {"long_name": name})
    of_whole: dict[str, object] = {}
    for name, value in attributes.items():
        of_whole[_legal(name, of_whole)] = value
    return library("xarray").Dataset(named, coords, of_whole)  # type: ignore[no-any-return]


def _legal(name: str, others: Container[str]) -> str:
    """Return a name that files of NetCDF can have, and none of the others."""
    legal = name
    if not LEGAL.fullmatch(name):
        legal = re.sub(r"[^0-9A-Za-z]+", "_", name).strip("_") or "value"
    numbered = (f"{legal}_{k}" for k in itertools.count(2))
    return next(
        candidate for candidate in itertools.chain([legal], numbered) if candidate not in others
    )


def split_complex(whole: xr.Dataset) -> xr.Dataset:
    """Return the arrays with a dimension ``part``, "re" and "im", in place of complex numbers."""
    parts = {
        name: (
            (*array.dims, "part"),
            np.stack([array.values.real, array.values.imag], -1),
            array.attrs,
        )
        for name, array in whole.data_vars.items()
        if array.dtype.kind == "c"
    }
    return whole.assign(parts).assign_coords(part=["re", "im"]) if parts else whole
