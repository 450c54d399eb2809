"""Optional libraries, imported when they are used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from crankpin._support import lazy

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

EXTRAS = {
    "anywidget": "view",
    "dask.array": "dask",
    "matplotlib": "plot",
    "openpyxl": "excel",
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


def dataset(
    arrays: Mapping[str, object], coords: Mapping[str, object], attributes: Mapping[str, object]
) -> xr.Dataset:
    """Return arrays of xarray with their coordinates and attributes."""
    return library("xarray").Dataset(arrays, coords, attributes)  # type: ignore[no-any-return]
