"""Quantities: arrays of phasors of balances, single orders and sweeps; totals and exports."""

# ruff: noqa: ANN401, S301 - results of any kind; pickles of our own

from __future__ import annotations

import copy
import inspect
import io
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.model.presets import usual_speed
from matplotlib import pyplot as plt
from support import in_turn
from support.engines import OFFSET

if TYPE_CHECKING:
    from pathlib import Path

V6 = cp.Engine.preset("v6-60")
SWEPT: dict[str, Any] = {"rpm": [5000], "bank_angle_deg": [60, 75], "hold": "pins"}
PLANAR = ("xy", "x", "y", "forward", "backward", "peak", "peak_xy", "zero_bound")
SCALAR = ("phasor", "peak", "zero_bound")
NAMES = ("force", "moment", "torque", "crank_torque")


@in_turn("name", cp.presets())
def test_default_peaks_are_those_of_the_waveform(name: str) -> None:
    """Sampled exactly at 0.05°, within the bound of omitted orders and the step's effect."""
    engine = cp.Engine.preset(name)
    rpm = usual_speed(name, 5000)
    b, w = engine.balance(rpm), engine.waveform(rpm, theta_deg=np.arange(0.0, 360.0, 0.05))
    for quantity in NAMES:
        values = getattr(w, quantity)
        length = np.abs(values) if values.ndim == 1 else np.hypot(*values.T)
        total = getattr(b.total, quantity)
        largest = float(np.abs(getattr(b, quantity).peak).sum())
        # Half a step at the highest order that matters; then rounding.
        step = largest * 0.5 * (20 * np.deg2rad(0.025)) ** 2
        rounding = 1e-9 * float(np.abs(engine.balance(rpm, orders=[1, 2]).force.zero_bound).max())
        missing = total.error_bound + rounding + 1e-12 * largest + 1e-9
        assert length.max() <= total.peak + missing, quantity
        assert total.peak <= length.max() + step + missing, quantity


def test_points_of_a_sweep_are_balances() -> None:
    given: dict[str, Any] = {
        "bank_angle_deg": [60.0, 90.0],
        "hold": "pins",
        "rod_ratio": [0.2, 0.3],
    }
    s = cp.sweep({"a": V6, "b": cp.Engine.preset("v6-90")}, rpm=[1000.0, 6000.0], **given)
    for place in np.ndindex(2, 2, 2, 2):
        at = [values[k] for values, k in zip(s.coords.values(), place, strict=True)]
        engine = s.engine_at(engine=at[0], bank_angle_deg=at[1], rod_ratio=at[2])
        b = engine.balance(float(at[3]), orders=s.orders)
        for name in NAMES:
            swept, one = getattr(s, name), getattr(b, name)
            scale = float(np.abs(one).max()) or 1.0
            for part in PLANAR if name in ("force", "moment") else SCALAR:
                found, expected = getattr(swept, part)[place], getattr(one, part)
                np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13 * scale)
                single = getattr(getattr(s[2], name), part)[place]
                np.testing.assert_array_equal(single, found[s.orders.index(2)])
            total = getattr(s.total, name).peak[place]
            assert total == pytest.approx(getattr(b.total, name).peak, rel=1e-12, abs=1e-12 * scale)
    for figures in (s.moment.minor, s.moment.tilt_deg):
        assert figures.shape == (2, 2, 2, 2, len(s.orders))


def test_engine_at_names_what_is_wrong() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000], bank_angle_deg=[60, 90], hold="firing")
    with pytest.raises(cp.InputError, match="bank_angle_deg = 61: is not among the 2 swept values"):
        s.engine_at(bank_angle_deg=61)
    with pytest.raises(cp.InputError, match="bank_angle_deg is swept"):
        s.engine_at(rpm=1000)
    with pytest.raises(cp.InputError, match="dimension = 'speed'"):
        s.engine_at(speed=1)


def test_quantities_are_read_only_arrays() -> None:
    b = V6.balance(5000, orders=[1, 2])
    np.testing.assert_array_equal(abs(b.moment), b.moment.peak_xy)
    np.testing.assert_array_equal(2 * b.moment - b.moment, b.moment.xy)
    assert b.moment.shape == (2, 2)
    assert len(b.torque) == 2
    assert not np.asarray(b.moment.xy).flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        b.moment.xy[0] = 0
    for made in (
        copy.copy(b.moment),
        copy.deepcopy(b.moment),
        pickle.loads(pickle.dumps(b.moment)),
    ):
        np.testing.assert_array_equal(made, b.moment)


def test_absent_torque_is_no_attribute() -> None:
    """It was an error of its own under hasattr."""
    b, s = V6.balance(5000, torque=False), cp.sweep(V6, rpm=[1.0], spectrum={1: 1.0}, orders=[1])
    for result in (b, s, b.total, s[1], V6.waveform(5000, torque=False), s.waveform([0.0])):
        assert not hasattr(result, "torque")
        assert not hasattr(result, "crank_torque")
        assert hasattr(result, "force")
    with pytest.raises(cp.InputError, match="torque is not available: it was not requested"):
        _ = b.torque
    with pytest.raises(cp.InputError, match="a force spectrum does not determine it"):
        _ = s.crank_torque


def test_an_order_is_a_key() -> None:
    """As an index it was another order: b.moment.peak[2] of (1, 2, 3) beside b[2].moment.peak."""
    b = V6.balance(5000)
    s = cp.sweep(V6, rpm=[5000], bank_angle_deg=[60, 75], hold="pins")
    for result in (b, s, b.moment, s.torque):
        assert list(result) == list(result.orders)
        assert len(result) == len(result.orders)
        assert (2 in result, 10**6 in result, "2" in result) == (True, False, False)
    for n in (1, 2, 3, 5, 10, 11):
        for name in ("force", "moment", "torque", "crank_torque"):
            one = getattr(b, name)[n]
            assert one.peak == getattr(b[n], name).peak
            assert one.peak == getattr(V6.balance(5000, orders=[n]), name).peak[0]
            expected = getattr(cp.sweep(V6, **SWEPT, orders=[n]), name).peak[..., 0]
            np.testing.assert_array_equal(getattr(s, name)[n].peak, expected)
    assert b["all"] == b.total
    assert b.moment["all"].peak == b.total.moment.peak


def test_an_order_says_why_it_is_zero_or_not_in_the_total() -> None:
    i4 = cp.Engine.preset("i4")
    b = i4.balance(6000, rtol=1e-3)
    assert b.force[2].status == "summed"
    assert b.force[1].peak == 0.0
    assert b.force[1].status == b.moment[2].status == b.torque[1].status == "zero, proved"
    assert b.omitted
    assert b.force[b.omitted[0]].peak > 0.0
    assert b.force[b.omitted[0]].status == "omitted"
    # A mass that is no rational multiple of the others, as large as two of them need.
    one = OFFSET.replace(pin_offset=0.0, reciprocating_mass=1.0)
    parts = [one, one, one.replace(reciprocating_mass=2.0 * np.cos(np.deg2rad(50.3)))]
    odd = cp.Engine.from_lists(
        parts, tdc_deg=[50.3, -50.3, 180], bank_deg=[90] * 3, z=[0, 0.1, 0.2]
    ).balance(6000)
    assert odd.force[1].status == "zero within rounding"
    for quantity in (b.force, b.total.force):
        with pytest.raises(cp.InputError, match="status is undefined for force: give one order"):
            quantity.status  # noqa: B018


def test_a_whole_order_is_an_int_and_a_half_order_a_float() -> None:
    whole: list[Any] = [2, 2.0, np.float64(2.0), np.int64(2), Fraction(4, 2)]
    half: list[Any] = [0.5, np.float32(0.5), Fraction(1, 2)]
    for keys, order in ((whole, "2"), (half, "0.5")):
        for key in keys:
            assert repr(V6.balance(5000).moment[key].order) == order


def test_a_torque_has_no_parts_of_a_vector() -> None:
    for result in (V6.balance(5000), cp.sweep(V6, rpm=[1.0])):
        for name in ("xy", "x", "y", "forward", "backward", "peak_xy", "minor", "tilt_deg"):
            assert hasattr(result.moment, name)
            assert not hasattr(result.torque, name)
        assert not hasattr(result.force, "phasor")
        assert result.torque.dims == (*result.dims, "order")


@pytest.mark.parametrize(
    "order", [0, -1, 1.25, np.nan, 1e9, True, None, "2", slice(None), (0, 1), ...]
)
def test_a_key_that_is_no_order_is_named(order: Any) -> None:
    b = V6.balance(5000)
    whole: list[Any] = [b, cp.sweep(V6, rpm=5000)]
    if isinstance(order, (slice, tuple)) or order is ...:  # an index of the array
        np.testing.assert_array_equal(b.moment[order], b.moment.xy[order])
    else:
        whole.append(b.moment)
    for result in whole:
        with pytest.raises(cp.InputError, match=r"^order = .*: the key is an order, a multiple"):
            result[order]


def test_a_point_of_a_sweep_is_a_balance_to_the_last_bit() -> None:
    engines = {"a": V6, "b": V6.replace(cylinder=OFFSET.replace(pin_offset=0.001))}
    axes: dict[str, Any] = {
        "bank_angle_deg": [60, 75.3],
        "rod_ratio": [0.2, 0.2848101],
        "rpm": [1000, 5000],
    }
    s = cp.sweep(engines, **axes, hold="firing", rtol=1e-5)
    b = s.sel(engine="b", bank_angle_deg=75.3, rod_ratio=0.2848101, rpm=5000)
    assert isinstance(b, cp.results.Balance)
    assert (b.orders, b.omitted, b.error_bound) == (s.orders, s.omitted, s.error_bound)
    at = (1, 1, 1, 1)
    for name in ("force", "moment", "torque", "crank_torque"):
        one, all_points = getattr(b, name), getattr(s, name)
        np.testing.assert_array_equal(one, np.asarray(all_points)[at])
        np.testing.assert_array_equal(one.peak, all_points.peak[at])
        np.testing.assert_array_equal(one[11].peak, all_points[11].peak[at])
        assert getattr(b.total, name).peak == getattr(s.total, name).peak[at]
    alone = b.engine.balance(5000, orders=b.orders)
    np.testing.assert_allclose(b.moment.peak, alone.moment.peak, rtol=1e-12, atol=1e-9)
    back = pickle.loads(pickle.dumps(b))
    assert back == b
    np.testing.assert_array_equal(back.moment, b.moment)


def test_a_part_of_a_sweep_is_a_sweep() -> None:
    s = cp.sweep({"a": V6, "b": V6}, **SWEPT, orders=[1, 2])
    part = s.sel(engine="b", bank_angle_deg=75)
    assert isinstance(part, cp.results.Sweep)
    assert part.dims == ("rpm",)
    np.testing.assert_array_equal(part.moment, np.asarray(s.moment)[1, 1])
    assert s.sel() == s
    for wrong, words in (
        ({"rpm": 4999}, "rpm = 4999: is not among .*; the nearest is 5000"),
        ({"rod_ratio": 0.3}, "dimension = 'rod_ratio'"),
        ({"engine": "c"}, "engine = 'c'"),
    ):
        with pytest.raises(cp.InputError, match=words):
            s.sel(**wrong)


def test_results_are_read_by_threads_at_once() -> None:
    """A dict that other threads filled was iterated: "dictionary changed size"."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(30):
            b = V6.balance(5000)
            reads = [
                partial(b.read, quantity, what)
                for quantity in ("force", "moment", "torque", "torque.gas", "torque.inertia")
                for what in b._readings(quantity)
            ]
            with ThreadPoolExecutor(8) as pool:
                found = list(pool.map(lambda read: read(), reads * 4))
            for k, array in enumerate(found):
                assert array is found[k % len(reads)]
    finally:
        sys.setswitchinterval(interval)


@pytest.mark.parametrize(
    "call",
    [
        lambda **given: V6.balance(5000, **given),
        lambda **given: V6.waveform(5000, **given),
        lambda **given: cp.sweep(V6, rpm=5000, **given),
        lambda **given: cp.rank(V6, rpm=5000, by="total.moment.peak", **given),
    ],
)
def test_rtol_with_given_orders_is_refused(call: Any) -> None:
    with pytest.raises(cp.InputError, match=r"rtol = 0\.1: needs orders"):
        call(orders=[1, 2], rtol=0.1)


def test_a_spectrum_is_copied() -> None:
    spectrum = {1: 1.0, 2: 0.5}
    s = cp.sweep(V6, rpm=[1000.0], spectrum=spectrum, orders=[1, 2])
    before = s.force.xy
    spectrum[1] = 99.0
    assert s.spectrum == {1: 1.0, 2: 0.5}
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(s)).force, before)
    np.testing.assert_array_equal(s.to_dask(1).force.compute(scheduler="synchronous"), before)


def test_a_sweep_without_orders_is_as_a_balance() -> None:
    """An I6 has no shaking within a coarse tolerance: neither keeps an order."""
    i6 = cp.Engine.preset("i6")
    b, s = (
        i6.balance(5000, rtol=0.5, torque=False),
        cp.sweep(i6, rpm=[5000], rtol=0.5, torque=False),
    )
    assert b.orders == s.orders == ()
    assert s.force.shape == (1, 0, 2)
    assert s.force.forward.shape == (1, 0)
    assert s.total.force.peak_xy.tolist() == [[0.0, 0.0]]
    buffer = np.full((1, 2, 2), 7.0)  # memory need not be zero before it is written to
    assert not s.waveform([0.0, 1.0], exact=False).computed("force", out=buffer).any()
    assert s.to_dask(1).force.compute(scheduler="synchronous").shape == (1, 0, 2)


def test_progress_of_many_speeds_advances() -> None:
    told: list[tuple[int, int]] = []
    s = cp.sweep(
        V6,
        rpm=np.linspace(1.0, 6000.0, 400_000),
        orders=[1, 2],
        progress=lambda done, total: told.append((done, total)),
    )
    assert s.moment.any()
    assert told[-1][0] == told[-1][1] > 10


def test_negligible_orders_are_left_out_and_named() -> None:
    b = V6.balance(5000)
    assert "Not shown: order" in repr(b)
    assert "Not shown" not in repr(V6.balance(5000, orders=b.orders))
    assert "of the orders given" in repr(V6.balance(5000, orders=b.orders))
    shown = b.plot(quantity="moment").get_xticklabels()
    assert len(shown) < len(b.orders)
    plt.close("all")


@pytest.mark.parametrize("result", [V6.balance(5000), cp.sweep(V6, rpm=[1000.0, 2000.0])])
def test_phasors_survive_csv(result: Any) -> None:
    import pandas as pd

    table = result.tidy().to_pandas()
    text = io.StringIO(result.tidy().to_csv())
    # The default of pandas 2 rounds the last digit; pandas 3 does not, and warns of the option.
    exact: Any = {"float_precision": "round_trip"} if pd.__version__ < "3" else {}
    again = pd.read_csv(text, **exact)
    for column in ("real", "imag", "peak"):
        np.testing.assert_array_equal(again[column], table[column])
    x = table[(table.quantity == "moment") & (table.component == "x")]
    np.testing.assert_array_equal(x.real + 1j * x.imag, np.asarray(result.moment.x).ravel())
    assert set(table.unit) == {"N", "N·m"}


@pytest.mark.parametrize("result", [V6.balance(5000), cp.sweep({"a b": V6}, rpm=[1000.0, 2000.0])])
def test_datasets_survive_netcdf(result: Any, tmp_path: Path) -> None:
    import xarray as xr

    dataset = result.to_xarray(split_complex=True)
    dataset.to_netcdf(tmp_path / "result.nc", engine="scipy")
    with xr.open_dataset(tmp_path / "result.nc", engine="scipy") as found:
        moment = found.moment.sel(part="re") + 1j * found.moment.sel(part="im")
        np.testing.assert_array_equal(moment, result.moment)
        assert found.moment.attrs["units"] == "N m"


@pytest.mark.slow
def test_names_with_dollar_signs_are_drawn() -> None:
    engine = V6.replace(name=r"V6 $\foo$")
    s = cp.sweep([engine, V6], rpm=[1000.0], bank_angle_deg=[60.0, 90.0], hold="pins")
    ranking = cp.rank(
        [engine, V6], rpm=1000, by="total.moment.peak", bank_angle_deg=[60, 90], hold="pins"
    )
    for result in (
        engine.balance(1000),
        engine.waveform(1000),
        s,
        s.waveform(),
        ranking,
        cp.rank([engine, V6], rpm=1000, by="total.torque.peak"),
        engine.firing_orders()[0],
        cp.sweep([engine, V6], rpm=1000),
    ):
        axes: Any = result.plot()
        np.ravel(axes)[0].get_figure(root=True).canvas.draw()
    plt.close("all")


# --- ranking ------------------------------------------------------------------------------------


def test_a_dip_between_tied_angles_at_the_end_is_found() -> None:
    given: dict[str, Any] = {"rpm": 3000, "by": "[1].moment.backward", "refine": True}
    (best,) = cp.rank(V6, bank_angle_deg=np.arange(55, 180, 10), hold="firing", **given)
    assert best.bank_angles_deg == (60.0,)
    assert best.value == 0.0


def test_names_stay_as_typed() -> None:
    ranking = cp.rank(
        {"V6 60° mine": V6}, rpm=3000, by="total.moment.peak", bank_angle_deg=[90], hold="pins"
    )
    assert ranking.names == ("V6 60° mine",)
    assert ranking[0].name == "V6 60° mine"


def test_engines_among_arrangements_are_refused() -> None:
    search = cp.search_arrangements(6)
    given: dict[str, Any] = {"rpm": 1000, "by": "total.moment.peak"}
    given |= {"cylinder": V6.cylinders[0], "spacing": 0.1}
    with pytest.raises(cp.InputError, match="engines = 'rubbish': give arrangements alone"):
        cp.rank([search[0], "rubbish", None], **given)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="the search has no bank angle in its window"):
        cp.rank(search.within(1, 2), **given)


def test_the_objective_is_required() -> None:
    with pytest.raises(cp.InputError, match=r"by = None: .*total\.moment\.peak"):
        cp.rank(V6, rpm=1000, by=None)  # type: ignore[arg-type]
    for function in (cp.rank, cp.design):
        assert inspect.signature(function).parameters["by"].default is inspect.Parameter.empty


def test_without_gas_pressure_inertia_is_the_whole_torque() -> None:
    for result in (V6.balance(5000), cp.sweep(V6, **SWEPT), V6.balance(5000).about((0.1, 0.2, 0))):
        for whole in (result.torque, result.crank_torque, result[3].torque):
            np.testing.assert_array_equal(whole.inertia, whole)
            np.testing.assert_array_equal(whole.inertia.peak, whole.peak)
            assert whole.gas.shape == whole.shape
            assert not whole.gas.any()
        assert np.all(result.torque.cycle_mean == 0.0)
        np.testing.assert_array_equal(result.total.torque.inertia.peak, result.total.torque.peak)
        for wrong in ("gas", "inertia", "cycle_mean"):
            assert not hasattr(result.moment, wrong)
        assert not hasattr(result.torque.gas, "gas")
        assert not hasattr(result[2].torque, "cycle_mean")
        assert "torque_cycle_mean" not in result.to_xarray()
    for waves in (V6.waveform(5000), cp.sweep(V6, **SWEPT).waveform([0.0, 90.0])):
        np.testing.assert_array_equal(waves.read("torque.inertia"), waves.torque)
        np.testing.assert_array_equal(waves.read("crank_torque.gas"), 0.0 * waves.crank_torque)
        with pytest.raises(cp.InputError, match=r"quantity = 'moment\.gas': give"):
            waves.read("moment.gas")


def test_half_orders_are_keys_rows_and_coordinates() -> None:
    cylinder = OFFSET.replace(bore=0.09)
    fired = cp.Engine.preset("v6-90-odd-fire", cylinder=cylinder).with_cycle(cp.Cycle.example())
    b = fired.balance(3000, orders=[0.5, 1, 1.5, 3])
    assert (1.5 in b, 2.5 in b, list(b)) == (True, False, [0.5, 1, 1.5, 3])
    assert b[1.5].crank_torque.peak == b.crank_torque.peak[2] > 0.0
    assert (
        b[2.5].crank_torque.status == "zero, proved"
    )  # three pairs 240° apart: only multiples of 1.5 stay
    parts = b.crank_torque.gas + b.crank_torque.inertia
    np.testing.assert_allclose(parts, b.crank_torque, rtol=1e-12)
    rows = b.crank_torque.table
    assert rows["order"].values == ("mean", 0.5, 1, 1.5, 3, "all")
    assert (
        rows["gas"].values[:1] == (b.crank_torque.gas.cycle_mean,) == (b.crank_torque.cycle_mean,)
    )
    assert rows["phase"].values[3] == np.angle(b.crank_torque[1.5].phasor, deg=True)
    assert b.table["order"].values == ("mean", 0.5, 1, 1.5, 3, "all")
    dataset = b.to_xarray("torque", "torque.gas")
    assert dataset.order.dtype == np.float64
    assert complex(dataset.torque_gas.sel(order=1.5)) == b.torque.gas[1.5].phasor
    assert float(dataset.torque_cycle_mean) == b.torque.cycle_mean == -b.crank_torque.cycle_mean
    table = b.tidy("crank_torque.gas").to_pandas()
    assert table.order.tolist() == [0.5, 1, 1.5, 3]
    assert table.peak.tolist() == b.crank_torque.gas.peak.tolist()
