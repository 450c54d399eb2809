"""Optional libraries, imported when they are used."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


def pandas() -> Any:  # noqa: ANN401 - a module
    """Return pandas, or raise an ImportError that names the extra to install."""
    return _imported("pandas")


def data_frame(data: object, **options: object) -> pd.DataFrame:
    """Return a table of pandas, or raise an ImportError that names the extra to install."""
    table: pd.DataFrame = pandas().DataFrame(data, **options)
    return table


def xarray() -> Any:  # noqa: ANN401 - a module
    """Return xarray, or raise an ImportError that names the extra to install."""
    return _imported("xarray")


def dask() -> Any:  # noqa: ANN401 - a module
    """Return dask.array, or raise an ImportError that names the extra to install."""
    return _imported("dask.array", "dask")


def sympy() -> Any:  # noqa: ANN401 - a module
    """Return SymPy, or raise an ImportError that names the extra to install."""
    return _imported("sympy", "exact")


def matplotlib() -> Any:  # noqa: ANN401 - a module
    """Return matplotlib, or raise an ImportError that names the extra to install."""
    return _imported("matplotlib", "plot")


def anywidget() -> Any:  # noqa: ANN401 - a module
    """Return anywidget, or raise an ImportError that names the extra to install."""
    return _imported("anywidget", "view")


def scipy_optimize() -> Any:  # noqa: ANN401 - a module
    """Return ``scipy.optimize``, or raise an ImportError that names the extra to install."""
    return _imported("scipy.optimize", "optimize")


def _imported(name: str, extra: str | None = None) -> Any:  # noqa: ANN401 - a module
    try:
        return importlib.import_module(name)
    except ImportError as error:
        hint = f'pip install "crankpin[{extra or name}]"'
        raise ImportError(f"{name} is not installed: {hint}") from error
