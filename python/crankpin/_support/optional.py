"""Optional libraries, imported when they are used."""

from __future__ import annotations

import importlib
from typing import Any


def pandas() -> Any:  # noqa: ANN401 - a module
    """Return pandas, or raise an ImportError that names the extra to install."""
    return _imported("pandas")


def xarray() -> Any:  # noqa: ANN401 - a module
    """Return xarray, or raise an ImportError that names the extra to install."""
    return _imported("xarray")


def dask() -> Any:  # noqa: ANN401 - a module
    """Return dask.array, or raise an ImportError that names the extra to install."""
    return _imported("dask.array", "dask")


def sympy() -> Any:  # noqa: ANN401 - a module
    """Return SymPy, or raise an ImportError that names the extra to install."""
    return _imported("sympy", "exact")


def anywidget() -> Any:  # noqa: ANN401 - a module
    """Return anywidget, or raise an ImportError that names the extra to install."""
    return _imported("anywidget", "view")


def _imported(name: str, extra: str | None = None) -> Any:  # noqa: ANN401 - a module
    try:
        return importlib.import_module(name)
    except ImportError as error:
        remedy = f'pip install "crankpin[{extra or name}]"'
        raise ImportError(f"{name} is not installed: {remedy}") from error
