"""Labelled arrays as xarray datasets and as tables in long form, and what arrays there are."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, optional
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from crankpin._support.quantities import Kind
    from crankpin.analysis.labelled import Labelled
    from crankpin.analysis.quantity import Quantity

SMALLER = "sweep one axis in parts, or use to_dask"
"""Hint for results too large for memory."""
COMPONENT_DIMS = ("axis", "component")
"""Dimensions of the components of a vector or a load, the last ones."""
VALUES = "values"
"""Name of the array itself: phasors of results by order, else values."""
COMPLEX = (VALUES, "forward", "backward")
"""Arrays by order of complex numbers."""
OF_TURNING = (VALUES, "forward", "backward", "zero_bound", "peak", "peak_xy", "total_peak",
              "total_peak_xy")  # fmt: skip
"""Arrays of a vector in the cross-section plane, by order."""
OF_TORQUES = (VALUES, "zero_bound", "peak", "total_peak", "cycle_mean")
"""Arrays of a torque, by order."""


def reduced(dims: tuple[str, ...], what: str) -> tuple[str, ...]:
    """Return the dimensions of one of the arrays of a quantity that has these."""
    if what == VALUES:
        return dims
    without = set() if what.endswith(("_xy", "_xyz")) else {"axis"}
    if what != "magnitude":
        without.add("theta_deg")
    if what.startswith("total_") or what == "cycle_mean":
        without.add("order")
    return tuple(name for name in dims if name not in without)


@cache
def readings(kind: Kind, dims: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the arrays of a quantity: of values over crank angle, or phasors."""
    if "theta_deg" in dims:
        return (VALUES, "magnitude", "mean_magnitude", "peak", *(("peak_xy",) if kind.axes else ()))
    if "order" not in dims or kind.real:
        return (VALUES,)
    by_order = ("peak", "peak_xyz", "rms", "rms_xyz") if kind.axes else ("peak",)
    total = by_order if kind.axes else ("peak",)
    return (VALUES, *by_order, *(f"total_{what}" for what in total))


def place_of(name: str, value: object, values: Any) -> int:  # noqa: ANN401 - texts or numbers
    """Return the place of a value among those of a coordinate."""
    if isinstance(values, tuple) and values and isinstance(values[0], str):
        return values.index(inputs.one_of(name, value, values))
    number, values_of = inputs.number(name, value), np.asarray(values)
    places = np.flatnonzero(values_of == number)
    if not places.size:
        nearest = ""
        if values_of.size:
            nearest = (
                f", {values_of.min():.10g} to {values_of.max():.10g}; "
                f"the nearest is {values_of[np.abs(values_of - number).argmin()]:.10g}"
            )
        swept = "swept " if name in labels.SWEPT else ""
        raise inputs.rejected(
            name, value, f"is not among the {len(values_of)} {swept}values{nearest}"
        )
    return int(places[0])


# --- datasets -------------------------------------------------------------------------------------


def dataset(
    result: Labelled, quantities: Sequence[Quantity], lazy: Mapping[str, Any] | None = None
) -> xr.Dataset:
    """Return arrays of some quantities with dimensions, units, loads and bounds.

    Parameters
    ----------
    result
        The result.
    quantities
        The quantities, or selections of them.
    lazy
        Name of a variable → its values where they are not those of the result, as of dask.
    """
    pairs = [
        (variable(quantity.name, what), quantity, what)
        for quantity in quantities
        for what in result._in_datasets(quantity.name)
    ]
    coords = union([quantity for _, quantity, _ in pairs])
    if lazy is None:
        fitting(
            coords,
            *(
                (quantity._dims_of(what), 16 if "order" in quantity.dims and what in COMPLEX else 8)
                for _, quantity, what in pairs
            ),
        )
    arrays = {
        name: (
            quantity._dims_of(what),
            lazy[name]
            if lazy is not None
            else quantity._picked(what, result.read(quantity.name, what)),
            {"units": quantity.kind.xarray_unit} if quantity.unit else {},
        )
        for name, quantity, what in pairs
    }
    attributes = dict(result._attributes) | labels.attributes(result.loads_counted)
    for quantity in quantities:
        whole = quantity.name.partition(".")[0]
        if whole in result.error_bound:
            attributes[f"{variable(quantity.name)}_error_bound"] = result.error_bound[whole]
    return optional.dataset(arrays, labels.coordinates(coords), attributes)


def dataset_of(quantity: Quantity) -> xr.Dataset:
    """Return a quantity, or what is selected of it, with its dimensions, unit and loads."""
    about = {"units": quantity.kind.xarray_unit} if quantity.unit else {}
    arrays = {variable(quantity.name): (quantity.dims, np.asarray(quantity), about)}
    attributes = dict(quantity.result._attributes) | labels.attributes(quantity.loads_counted)
    return optional.dataset(arrays, labels.coordinates(quantity.coords), attributes)


def variable(quantity: str, what: str = VALUES) -> str:
    """Return the name of an array in a dataset."""
    name = quantity.replace(".", "_")
    return name if what == VALUES else f"{name}_{what}"


def union(quantities: Sequence[Quantity]) -> dict[str, Any]:
    """Return the coordinates of some quantities: those of all first, axes last."""
    by_name = {name: values for quantity in quantities for name, values in quantity.coords.items()}
    return {name: by_name[name] for name in sorted(by_name, key=COMPONENT_DIMS.count)}


def fitting(coords: Mapping[str, Any], *arrays: tuple[Iterable[str], int]) -> None:
    """Raise an InputError if arrays are too large together: of each its dimensions and bytes."""
    lengths = {name: len(values) for name, values in coords.items()}
    size = sum(width * math.prod(lengths[dim] for dim in dims) for dims, width in arrays)
    inputs.fitting("sweep" if {*coords} & {*labels.SWEPT} else "table", size, SMALLER)


# --- tables ---------------------------------------------------------------------------------------


def points(coords: Mapping[str, Any], beside: int, times: int = 1) -> list[Column]:
    """Return a column of each dimension, a row for each point, or several times all points.

    Raises an InputError if these columns and as many ``beside`` them are too large.
    """
    fitting(coords, (coords, 8 * times * (len(coords) + beside)))
    shape = tuple(len(values) for values in coords.values())
    columns = []
    for axis, (name, values) in enumerate(coords.items()):
        along = column(values).reshape(-1, *(1,) * (len(shape) - axis - 1))
        columns.append(Column(name, np.broadcast_to(along, (times, *shape)), digits=10))
    return columns


def column(values: object) -> NDArray[Any]:
    """Return values as an array; texts as objects, which rows share."""
    array = np.asarray(values)
    return array.astype(object) if array.dtype.kind == "U" else array


def components(quantity: Quantity) -> Mapping[str, Mapping[str, NDArray[np.float64]]]:
    """Return the columns of each component of a quantity in long form."""
    values, kind = np.asarray(quantity), quantity.kind
    axes = quantity.coords.get("axis") or quantity.coords.get("component") or ()
    if "order" not in quantity.result._dims(quantity.name) or kind.real or values.dtype.kind != "c":
        parts = np.moveaxis(values, -1, 0) if axes else values[np.newaxis]
        names = axes if "component" in quantity.dims else kind.components[-len(parts) :]
        return {name: {"value": part} for name, part in zip(names, parts, strict=True)}
    by_name = dict(zip(_own_components(quantity), [values], strict=True))
    if axes:
        by_name = dict(zip(axes, np.moveaxis(values, -1, 0), strict=True))
    if "axis" in quantity.dims and kind.planar:
        by_name |= {part: getattr(quantity, part) for part in labels.TURNING_WORDS}
    return {
        name: {"real": part.real, "imag": part.imag, "peak": np.abs(part)}
        for name, part in by_name.items()
    }


def phases(quantities: Iterable[Quantity], title: str, note: str, loads: str) -> Table:
    """Return amplitude and phase of each component of phasors, order by order.

    Rows are in the sequence of points, then orders, then quantities and their components.
    """
    parts: list[tuple[Quantity, str, NDArray[Any]]] = []
    for quantity in quantities:
        phasors = np.asarray(quantity)
        if "order" not in quantity.dims or phasors.dtype.kind != "c":
            continue
        if quantity.dims[-1] in COMPONENT_DIMS:
            names, values = quantity.coords[quantity.dims[-1]], np.moveaxis(phasors, -1, 0)
        else:
            names, values = _own_components(quantity), phasors[np.newaxis]
        parts += zip([quantity] * len(names), names, values, strict=True)
    coords = union([quantity for quantity, *_ in parts])
    coords = {name: values for name, values in coords.items() if name not in COMPONENT_DIMS}
    fitting(coords, *((quantity.dims[: values.ndim], 64) for quantity, _, values in parts))
    # Place of each row along each dimension; −1 where its quantity has none.
    rows: dict[str, NDArray[np.intp]] = {}
    for name in coords:
        places = [np.empty(0, dtype=np.intp)]
        for quantity, _, values in parts:
            dims, along = quantity.dims[: values.ndim], np.full(values.shape, -1)
            if name in dims:
                along = np.indices(values.shape)[dims.index(name)]
            places.append(along.ravel())
        rows[name] = np.concatenate(places)
    shared = [d for d in coords if all(d in quantity.dims for quantity, *_ in parts)]
    others = [d for d in coords if d not in shared]
    sizes = [values.size for *_, values in parts]
    names_of = list(dict.fromkeys(quantity.name for quantity, *_ in parts))
    of_rows = np.repeat([names_of.index(quantity.name) for quantity, *_ in parts], sizes)
    keys = [*(rows[d] for d in shared), of_rows, *(rows[d] for d in others)]
    sequence = np.lexsort(keys[::-1])

    def repeated(texts: Iterable[str]) -> NDArray[Any]:
        return np.repeat(column([*texts]), sizes)[sequence]

    def coordinate(name: str) -> Column:
        places = rows[name][sequence]
        values = column(coords[name])[places]
        if (places < 0).any():
            none = "" if values.dtype.kind == "O" else None
            cells = zip(values.tolist(), places.tolist(), strict=True)
            return Column(name, tuple(none if k < 0 else value for value, k in cells), digits=10)
        return Column(name, values, digits=10)

    whole = np.concatenate([values.ravel() for *_, values in parts] or [np.empty(0)])[sequence]
    pairs = zip(whole.tolist(), np.angle(whole, deg=True).tolist(), strict=True)
    angles = tuple(angle if phasor else None for phasor, angle in pairs)
    units_of = repeated(_unit_of(quantity, component) for quantity, component, _ in parts)
    columns = (
        *map(coordinate, shared),
        Column("quantity", repeated(quantity.name for quantity, *_ in parts)),
        *map(coordinate, others),
        Column("component", repeated(component for _, component, _ in parts)),
        Column("amplitude", np.abs(whole)),
        Column("phase_deg", angles, digits=6),
        Column("unit", units_of),
    )
    return Table(title, columns, note, loads, tuple(units_of))


def _own_components(quantity: Quantity) -> tuple[str, ...]:
    """Return the name of the component of a quantity without axes, in long form."""
    (component, *_) = quantity.kind.components
    return ("z" if " " in component else component,)  # one of one word is its own name


def _unit_of(quantity: Quantity, component: str) -> str:
    """Return the unit of a component: of a load those of its forces and of its moments."""
    force, _, moment = quantity.unit.partition(", ")
    return moment if moment and component.startswith("M") else force


def long(quantities: Sequence[Quantity], loads: str, title: str = "Long form") -> Table:
    """Return values of each quantity and component, below each other."""
    lengths = [
        tuple(d for d in quantity.dims if d not in COMPONENT_DIMS) for quantity in quantities
    ]
    coords = {
        name: values for name, values in union(quantities).items() if name not in COMPONENT_DIMS
    }
    parts = [
        (quantity, dims, component, figures)
        for quantity, dims in zip(quantities, lengths, strict=True)
        for component, figures in components(quantity).items()
    ]
    heads = list(dict.fromkeys(head for *_, figures in parts for head in figures))
    sizes = [math.prod(len(coords[d]) for d in dims) for _, dims, *_ in parts]

    def repeated(name: str, texts: Iterable[str]) -> Column:
        return Column(name, np.repeat(column([*texts]), sizes))

    def along(name: str, dims: tuple[str, ...], size: int) -> NDArray[Any]:
        if name not in dims:
            return np.full(size, None, dtype=object)
        shape = tuple(len(coords[d]) for d in dims)
        values = column(coords[name]).reshape(-1, *(1,) * (len(dims) - dims.index(name) - 1))
        return np.broadcast_to(values, shape).reshape(size)

    columns = []
    if len({*lengths}) == 1:
        columns = points({name: coords[name] for name in lengths[0]}, 6, len(parts))
    else:
        fitting(coords, *((dims, 8 * (len(coords) + 6)) for _, dims, *_ in parts))
        for name in coords:
            pieces = [along(name, dims, n) for (_, dims, *_), n in zip(parts, sizes, strict=True)]
            columns.append(Column(name, np.concatenate(pieces), digits=10))
    columns.append(repeated("quantity", (kind.name for kind, *_ in parts)))
    columns.append(repeated("component", (component for _, _, component, _ in parts)))
    for head in heads:
        pieces = [
            np.ravel(figures[head]) if head in figures else np.full(n, np.nan)
            for (*_, figures), n in zip(parts, sizes, strict=True)
        ]
        columns.append(Column(head, np.concatenate(pieces)))
    columns.append(repeated("unit", (kind.unit for kind, *_ in parts)))
    return Table(title, tuple(columns), loads=loads, row_units=tuple(columns[-1].data))
