"""Sweeps in chunks, worked out by dask: the same bits as one sweep of everything."""

from __future__ import annotations

import sys
from typing import Any

import crankpin as cp
import numpy as np
import pytest


@pytest.fixture(autouse=True)
def _needs_dask() -> None:
    pytest.importorskip("xarray")
    pytest.importorskip("dask")


V6, V8 = cp.Engine.preset("v6-60"), cp.Engine.preset("v8-crossplane")
SINGLE = cp.Engine.from_lists(
    cp.Cylinder(0.045, 0.15, 0.5, bore=0.09), bank_deg=[90], tdc_deg=[0], z=[0], firing_order="1"
)
MAP = cp.CycleMap(
    rpm=[1000, 6000],
    load=[0, 1],
    cycles=[
        [cp.Cycle(range(0, 720, 90), [peak, 3e5, *6 * [1e5]]) for peak in peaks]
        for peaks in ([2e6, 5e6], [3e6, 8e6])
    ],
)
AXES: dict[str, dict[str, Any]] = {
    "every axis": {
        "engines": [V6, V8],
        "bank_angle_deg": np.linspace(0, 180, 7),
        "hold": "pins",
        # Both sides of 0.9, where the series ends, and no multiple of the lanes.
        "rod_ratio": np.linspace(0.1, 0.95, 70),
        "rpm": [1000, 2000, 7000],
        "orders": [1, 2, 3, 4, 6, 12],
        "chunks": {"engine": 1, "bank_angle_deg": 3, "rod_ratio": 69, "rpm": 2},
    },
    "bank angle alone, some blocks": {
        "engines": V6,
        "bank_angle_deg": np.linspace(0, 180, 200),
        "hold": "firing",
        "rpm": 5000,
        "chunks": 199,
    },
    "offsets": {
        "engines": {"a": V6.replace(reference_z=0.07), "b": V8},
        "rod_ratio": np.linspace(0.2, 0.4, 5),
        "pin_offset": np.linspace(-0.003, 0.003, 67),
        "rpm": np.linspace(500, 9000, 5),
        "chunks": {"pin_offset": 66, "rpm": 1, "rod_ratio": "auto"},
    },
    "orders chosen for the whole": {
        "engines": V6,
        "rod_ratio": np.linspace(0.1, 0.6, 50),
        "rpm": [3000, 6000],
        "orders": "auto",
        "rtol": 1e-4,
        "chunks": {"rod_ratio": (1, 16, 33)},
    },
    "cycles over speed and load": {
        "engines": SINGLE,
        "rpm": [1000, 2000, 3500],
        "load": [0, 0.3, 0.7, 1],
        "cycle": MAP,
        "orders": [0.5, 1, 2],
        "chunks": {"rpm": 2, "load": 3},
    },
    "a spectrum": {
        "engines": V6,
        "bank_angle_deg": np.linspace(0, 180, 9),
        "hold": "pins",
        "rpm": [1000, 2000],
        "spectrum": {1: 1.0, 2: 0.3},
        "orders": [1, 2],
        "chunks": 4,
    },
}


def in_chunks(arguments: dict[str, Any]) -> Any:  # noqa: ANN401 - an xarray Dataset
    given = {key: value for key, value in arguments.items() if key != "chunks"}
    return cp.sweep(**given).to_dask(arguments["chunks"])


@pytest.mark.slow
@pytest.mark.parametrize("name", AXES)
def test_chunks_have_the_bits_of_the_whole(name: str) -> None:
    arguments = AXES[name]
    whole = cp.sweep(**{key: value for key, value in arguments.items() if key != "chunks"})
    chunked = whole.to_dask(arguments["chunks"])
    assert all(variable.chunks for variable in chunked.values())
    labelled = whole.to_xarray()
    assert ("crank_torque" in labelled) == (name != "a spectrum")
    found = chunked.compute(scheduler="threads")
    assert found.identical(labelled)
    for variable in found:
        assert chunked[variable].dtype == found[variable].dtype


def test_sweeps_of_other_engines_keep_apart() -> None:
    """What dask takes for the same it works out once."""
    names = ["v6-60", "v6-90"]
    pairs = [[cp.Engine.preset(name), V8] for name in names]
    moments = [cp.sweep(each, rpm=[1000, 2000], orders=[1]).to_dask(1).moment for each in pairs]
    dask = pytest.importorskip("dask")
    together = dask.compute(*moments, scheduler="synchronous")
    for found, engines in zip(together, pairs, strict=True):
        assert np.array_equal(found, cp.sweep(engines, rpm=[1000, 2000], orders=[1]).moment)


@pytest.mark.slow
def test_other_processes() -> None:
    arguments = AXES["every axis"]
    moment = in_chunks(arguments).moment
    alone = moment.compute(scheduler="synchronous")
    assert moment.compute(scheduler="processes", num_workers=2).identical(alone)


@pytest.mark.skipif(sys.platform == "win32", reason="ports")
@pytest.mark.slow
def test_a_cluster() -> None:
    distributed = pytest.importorskip("distributed")
    moment = in_chunks(AXES["every axis"]).moment
    cluster = distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    )
    with cluster, distributed.Client(cluster):
        found = moment.compute()
    assert found.identical(moment.compute(scheduler="synchronous"))


@pytest.mark.slow
def test_more_than_one_call_takes() -> None:
    """Some ten gigabytes of phasors, of which one number is wanted."""
    ratios, speeds = np.linspace(0.2, 0.4, 40_000), np.linspace(1000, 6000, 4000)
    with pytest.raises(cp.InputError, match=r"more than .* in parts, or use to_dask"):
        _ = cp.sweep(V6, rpm=speeds, rod_ratio=ratios, orders=[1, 2]).moment.xy
    swept = cp.sweep(V6, rpm=speeds, rod_ratio=ratios, orders=[1, 2])
    chunked = swept.to_dask({"rod_ratio": 4000})
    assert chunked.moment.nbytes > 2**32
    largest = chunked.moment_peak.max().compute(scheduler="threads", num_workers=1)
    # moments grow with speed and with rod ratio: the corner is the largest
    corner = cp.sweep(V6, rpm=speeds[-1:], rod_ratio=ratios[-1:], orders=[1, 2])
    assert largest == corner.moment.peak.max()


def test_nothing_is_worked_out_before_it_is_asked_for() -> None:
    """A graph for 10¹⁵ points, which no machine works out."""
    axis = np.linspace(0.1, 0.5, 100_000)
    given: dict[str, Any] = {"rod_ratio": axis, "pin_offset": axis * 1e-3, "orders": [1, 2, 4, 6]}
    swept = cp.sweep(V6, rpm=axis * 1e4, **given)
    chunked = swept.to_dask({"rpm": -1, "rod_ratio": 10_000, "pin_offset": 50_000})
    assert chunked.moment.shape == (100_000, 100_000, 100_000, 4, 2)
    part = chunked.moment_peak_xy[0, 0, :3].data
    assert part.dtype == np.float64


def test_units_are_warned_of_once() -> None:
    with pytest.warns(UserWarning, match="mean piston speed") as told:
        chunked = cp.sweep(V6, rpm=[1e5, 2e5]).to_dask(1)
    assert len(told) == 1
    chunked.force.compute(scheduler="synchronous")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"rpm": [1, 2], "chunks": {"speed": 1}}, "chunks = .*mapping of rpm to"),
        *(
            ({"rpm": [1, 2], "chunks": chunks}, "chunks = .*mapping of rpm to")
            for chunks in (False, True, 0, -5, {"rpm": False}, {"rpm": (0, 2)})
        ),
        ({"rpm": [1, 2], "chunks": "much"}, "chunks = 'much'"),
        ({"rpm": [1, 2], "chunks": (3,)}, "chunks = "),
        ({"rpm": [1, 2], "chunks": {"rpm": (1, 2)}}, "chunks = "),
        ({"rpm": 1, "chunks": 1}, "sweep is of one point"),
        ({"rpm": [1, 2], "chunks": 1, "progress": print}, "progress cannot be combined"),
    ],
)
def test_what_is_wrong_is_named(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        in_chunks({"engines": V6, **arguments})


def test_without_dask(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "dask.array", None)
    with pytest.raises(ImportError, match=r'pip install "crankpin\[dask\]"'):
        cp.sweep(V6, rpm=[1, 2]).to_dask(1)
