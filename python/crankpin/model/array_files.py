"""Variables of files of arrays, MATLAB and HDF5, as columns of numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.optional import library
from crankpin.model.table_files import MATLAB

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

NUMBERS = "biuf"
"""Kinds of arrays that are numbers."""
LISTED = 10
"""Variables that an error lists."""


def read(file: Path) -> tuple[list[str], list[str], list[NDArray[np.float64]]]:
    """Return variable, head and numbers of each column.

    A table is split along its shorter axis. The head has the unit that an attribute names.
    """
    arrays = _of_matlab(file) if file.suffix.lower() in MATLAB else _of_hdf5(file)
    variables, heads = list[str](), list[str]()
    columns: list[NDArray[np.float64]] = []
    for name, unit, values in arrays:
        squeezed = np.squeeze(values)
        if squeezed.ndim not in (1, 2):
            continue
        behind = f" [{unit}]" if unit else ""
        if squeezed.ndim == 1:
            tables = [squeezed]
        else:
            tables = list(squeezed if squeezed.shape[0] <= squeezed.shape[1] else squeezed.T)
        for k, column in enumerate(tables):
            variables.append(name)
            heads.append(f"{name} {k}{behind}" if len(tables) > 1 else f"{name}{behind}")
            columns.append(np.ascontiguousarray(column, dtype=np.float64))
    if len(columns) < 2:
        words = ", ".join(map(repr, variables)) or "none"
        raise inputs.faulty(
            "path", f"has no two variables of numbers; it has {words}", "name another file"
        )
    return variables, heads, columns


def same_length(heads: list[str], columns: list[NDArray[np.float64]]) -> None:
    """Reject columns of different lengths, by their names."""
    if len({len(column) for column in columns}) > 1:
        lengths = [
            f"{head!r} of {len(column)}" for head, column in zip(heads, columns, strict=True)
        ]
        fault = f"has variables of different lengths: {', '.join(lengths[:LISTED])}"
        raise inputs.faulty("path", fault, Hint.of("name those of one length, `columns=…`"))


def _of_matlab(file: Path) -> Iterator[tuple[str, str, NDArray[Any]]]:
    """Yield name and numbers of the variables of a MATLAB file; those of 7.3 are HDF5."""
    matlab = library("scipy.io")
    with file.open("rb") as opened:
        try:
            whole = matlab.loadmat(opened, simplify_cells=True)
        except NotImplementedError:
            whole = None
        except MemoryError:
            raise
        except Exception as error:  # of a broken file, of any kind
            raise _broken("a MATLAB file", error) from None
    if whole is None:
        yield from _of_hdf5(file)
        return
    for name, values in _flat("", {k: v for k, v in whole.items() if not k.startswith("__")}):
        yield name, "", values


def _flat(prefix: str, value: object) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the arrays of numbers in structures, with dotted names."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat(f"{prefix}.{key}" if prefix else str(key), inner)
    elif isinstance(value, np.ndarray) and value.dtype.kind in NUMBERS:
        yield prefix, value


def _of_hdf5(file: Path) -> list[tuple[str, str, NDArray[Any]]]:
    """Return name, unit and numbers of the variables of an HDF5 file; groups are dotted names."""
    hdf5 = library("h5py")
    found = list[tuple[str, str, Any]]()

    def visit(name: str, item: Any) -> None:  # noqa: ANN401 - a group or a data set
        if not isinstance(item, hdf5.Dataset) or item.dtype.kind not in NUMBERS or "#" in name:
            return
        if item.size > inputs.MOST_NUMBERS:
            fault = f"has more than {inputs.MOST_NUMBERS} numbers in {name!r}"
            raise inputs.faulty("path", fault, "split it")
        found.append((name.replace("/", "."), _unit(item.attrs), item[()]))

    with file.open("rb") as opened:
        try:
            with hdf5.File(opened, "r") as book:
                book.visititems(visit)
        except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
            if isinstance(error, InputError):
                raise
            raise _broken("an HDF5 file", error) from None
    return found


def _unit(attributes: Any) -> str:  # noqa: ANN401 - of h5py
    """Return the unit that an attribute names; empty for none."""
    for key in ("units", "unit", "Units", "Unit"):
        value = attributes.get(key)
        if isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        if isinstance(value, str):
            return " ".join(value.split())
    return ""


def _broken(kind: str, error: Exception) -> InputError:
    fault = f"cannot be read as {kind} ({inputs.reason(error)})"
    return inputs.faulty("path", fault, "save it again, or as .csv")
