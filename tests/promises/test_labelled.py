"""Is every quantity of every result one labelled array, and an array for NumPy?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import quantities as registry
from crankpin.analysis.labelled import Labelled
from support import in_turn
from support.objects import OBJECTS

Quantity = cp.results.Quantity
every_object = in_turn("name", OBJECTS)
RANDOM = np.random.default_rng(1)
NOT_QUANTITIES = {
    "BearingLoads": {"main_z", "z", "shares"},  # places, and shares of places
    "RodLoads": {"compression_deg", "tension_deg", "reversal_deg"},  # crank angles
    "TorsionalExcitation": {"angular_frequency"},  # what an order is at a speed
}
"""Class → its arrays of numbers that are neither quantities nor coordinates."""


def labelled(name: str) -> Iterator[tuple[Any, Any]]:
    """Yield the result of a name with each of its quantities."""
    result = OBJECTS[name]
    if isinstance(result, Labelled) and getattr(result, "order", None) is None:
        assert result.quantities
        for quantity in result.quantities.values():
            yield result, quantity


@every_object
def test_a_quantity_fits_its_labels(name: str) -> None:
    for result, quantity in labelled(name):
        assert isinstance(quantity, Quantity)
        array = np.asarray(quantity)
        assert quantity.shape == array.shape, quantity.name
        assert len(quantity.dims) == quantity.ndim == array.ndim
        assert tuple(quantity.coords) == quantity.dims
        assert tuple(map(len, quantity.coords.values())) == array.shape
        assert quantity.unit == quantity.kind.unit
        assert quantity.size == array.size
        for dim in {"cylinder", "main_bearing", "mode", "point"} & {*quantity.dims}:
            assert list(quantity.coords[dim]) == list(range(1, len(quantity.coords[dim]) + 1))
        whole, _, part = quantity.name.partition(".")
        read = getattr(result, whole)
        read = read.part(part) if part else read
        assert isinstance(read, Quantity)
        assert read.dims == quantity.dims
        np.testing.assert_array_equal(read, array)
        assert result.read(quantity.name) is result.read(quantity.name)
        assert not result.read(quantity.name).flags.writeable


@every_object
def test_a_result_has_no_array_beside_its_quantities(name: str) -> None:
    """Arrays of numbers are labelled, or they are coordinates."""
    result = OBJECTS[name]
    for attribute in dir(type(result)):
        if attribute.startswith("_") or callable(getattr(type(result), attribute, None)):
            continue
        try:
            value = getattr(result, attribute)
        except AttributeError:
            continue
        is_result = isinstance(result, Labelled) and not isinstance(result, cp.results.Table)
        if isinstance(value, np.ndarray) and type(result).__module__.startswith(
            "crankpin.analysis"
        ):
            assert attribute not in registry.QUANTITIES or isinstance(result, Quantity), attribute
            if is_result and value.dtype.kind in "fc":
                allowed = NOT_QUANTITIES.get(type(result).__name__, set())
                assert attribute in {*result.coords, *allowed}, attribute


@every_object
def test_a_dataset_has_the_values_and_the_labels(name: str) -> None:
    pytest.importorskip("xarray")
    datasets: dict[int, Any] = {}
    for result, quantity in labelled(name):
        if id(result) not in datasets:
            datasets[id(result)] = result.to_xarray()
        for dataset in (datasets[id(result)], quantity.to_xarray()):
            array = dataset[quantity.name.replace(".", "_")]
            assert array.dims == quantity.dims
            np.testing.assert_array_equal(array.values, quantity)
            assert array.attrs.get("units", "") == quantity.kind.xarray_unit
            for dim, values in quantity.coords.items():
                np.testing.assert_array_equal(dataset[dim].values, np.asarray(values))


@every_object
def test_the_long_form_has_a_row_for_each_value(name: str) -> None:
    rows, result = 0, None
    for result, quantity in labelled(name):
        turning = quantity.kind.planar and np.iscomplexobj(quantity)  # forward and backward too
        table = result.tidy(quantity.name)
        assert len(table) == quantity.size * (2 if turning else 1), quantity.name
        heads = ("real", "imag") if "real" in table else ("value",)
        values = [np.ravel(table[head].data) for head in heads]
        array = np.asarray(quantity)
        by_axis = quantity.dims and quantity.dims[-1] in ("axis", "component")
        flat = np.moveaxis(array, -1, 0).ravel() if by_axis else array.ravel()
        np.testing.assert_array_equal(values[0][: array.size].astype(float), flat.real)
        if len(values) > 1:
            np.testing.assert_array_equal(values[1][: array.size].astype(float), flat.imag)
        rows += len(table)
    if result is not None:
        assert len(result.tidy()) == rows


@every_object
def test_an_index_by_coordinate_is_one_by_position(name: str) -> None:
    for result, quantity in labelled(name):
        array = np.asarray(quantity)
        for axis, (dim, values) in enumerate(quantity.coords.items()):
            listed = list(values)
            for place in {0, len(listed) // 2, len(listed) - 1} if listed else ():
                value = listed[place]
                first = listed.index(value)  # of values given twice
                expected = np.take(array, first, axis)
                one = quantity.sel(**{dim: value})
                np.testing.assert_array_equal(one, expected, err_msg=f"{quantity.name} {dim}")
                assert one.dims == quantity.dims[:axis] + quantity.dims[axis + 1 :]
                assert dim not in one.coords
                if isinstance(value, str) or dim == "order":
                    np.testing.assert_array_equal(quantity[value], expected)
                at = (*(slice(None),) * axis, first)
                np.testing.assert_array_equal(quantity[at], expected)
                for what in ("peak", "magnitude", "rms", "peak_xy", "peak_xyz"):
                    known = result._readings(quantity.name)
                    wide = f"{what}_{''.join(quantity.kind.axes)}" if dim == "axis" else what
                    dims = result._dims(quantity.name, wide)
                    if {what, wide} <= {*known} and dim in dims:
                        part = np.take(result.read(quantity.name, wide), first, dims.index(dim))
                        np.testing.assert_array_equal(getattr(one, what), part)
            with pytest.raises(cp.InputError, match=rf"^{dim} = "):
                quantity.sel(**{dim: "none" if isinstance(listed[:1], str) else -9.75e300})
        with pytest.raises(cp.InputError, match=r"^dimension = 'flavour'"):
            quantity.sel(flavour=1)


FUNCTIONS: list[Callable[[Any], Any]] = [
    np.max, np.min, np.sum, np.mean, np.std, np.any, np.all, np.abs, np.real, np.imag, np.shape,
    np.ravel, np.isnan, np.transpose, np.array, np.cumsum, np.argmax,
    lambda a: np.concatenate([a, a], axis=None), lambda a: np.stack([a, 2 * a]),
    lambda a: np.where(np.isnan(a), 0.0, a), lambda a: np.linalg.norm(np.ravel(a)),
    lambda a: a + a, lambda a: 2.0 * a, lambda a: a - 1j, lambda a: -a, lambda a: a**2,
    lambda a: a == a.tolist(), lambda a: a.T, lambda a: a.max(), lambda a: a.sum(),
    lambda a: a.real, lambda a: a.any(), lambda a: a.tolist(), lambda a: a[...],
    lambda a: a.reshape(-1), lambda a: a.mean(), lambda a: a.astype(complex), lambda a: a.copy(),
]  # fmt: skip


@every_object
def test_functions_of_numpy_give_plain_arrays(name: str) -> None:
    for _, quantity in labelled(name):
        array = np.asarray(quantity)
        if not array.size:
            continue
        for place, function in enumerate(FUNCTIONS):
            found, expected = function(quantity), function(array)
            assert not isinstance(found, Quantity), (quantity.name, place)
            assert type(found) is type(expected), (quantity.name, place)
            np.testing.assert_array_equal(found, expected, err_msg=f"{quantity.name} {place}")


@every_object
def test_the_total_is_the_peak_over_a_cycle_of_all_orders(name: str) -> None:
    """At least that of samples, and at most that of all orders at their worst angles."""
    theta = np.deg2rad(np.arange(0.0, 720.0, 0.5))
    for _, quantity in labelled(name):
        if not quantity._by_order or "peak" not in quantity.result._readings(quantity.name):
            continue
        array = np.moveaxis(np.asarray(quantity), quantity.dims.index("order"), -1)
        waves = np.exp(1j * np.multiply.outer(np.array(quantity.orders, dtype=float), theta))
        sampled = (array @ waves).real  # dimensions, then angles
        if "axis" in quantity.dims:
            along = quantity.dims.index("axis") - 1
            sampled = np.sqrt((sampled**2).sum(axis=along))
        mean = np.abs(getattr(quantity, "cycle_mean", 0.0))
        largest = np.abs(sampled).max(axis=-1)
        peaks = np.asarray(quantity.total.peak)
        most = np.asarray(quantity.peak).sum(axis=quantity._dims_of("peak").index("order")) + mean
        assert np.all(peaks >= (largest - mean) * (1.0 - 1e-9)), quantity.name
        assert np.all(peaks <= most * (1.0 + 1e-9)), quantity.name


@every_object
def test_a_selection_of_a_result_is_that_of_its_quantities(name: str) -> None:
    for result, quantity in labelled(name):
        if type(result).sel is not Labelled.sel:
            continue  # a balance, a sweep or a response, with tests of their own
        for dim in {*result.dims, *result._along} & {*quantity.dims}:
            value = list(quantity.coords[dim])[-1]
            one = result.sel(**{dim: value})[quantity.name]
            np.testing.assert_array_equal(one, quantity.sel(**{dim: value}))
        with pytest.raises(cp.InputError, match=r"^dimension = 'flavour'"):
            result.sel(flavour=1)
