"""Do pictures of magnitudes show their data on logarithmic axes too?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib.pyplot as plt
import numpy as np
import pytest
from crankpin.plot.style import SERIES
from crankpin.plot.sweep import SWEEP_PICTURES
from matplotlib.colors import LogNorm
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable

V6 = cp.Engine.preset("v6-60")
SWEPT = cp.sweep(V6, rpm=5000, bank_angle_deg=range(10, 180, 10), hold="pins", orders=[1, 2])
PICTURES: dict[str, Callable[[], Any]] = {
    "bob weight": lambda: cp.bob_weight(V6, 0.6).plot(),
    "balance": lambda: V6.balance(5000, orders=[1, 2, 4]).plot(),
    "sweep": SWEPT.plot,
    "parts": lambda: SWEPT.plot(kind="parts"),
    "bending": lambda: cp.bearing_loads(V6, 5000).plot(kind="bending"),
    "pressure": lambda: cp.Cycle.example().plot(),
}


@pytest.mark.parametrize("name", PICTURES)
def test_limits_follow_a_scale_that_becomes_logarithmic(name: str) -> None:
    for ax in np.ravel(PICTURES[name]()):
        if ax.get_ylim()[0] != 0.0:
            continue
        ax.set_yscale("log")
        low, high = ax.get_ylim()
        drawn = [
            np.asarray(line.get_ydata(), dtype=float)
            for line in ax.lines
            if line.get_gid() == SERIES
        ]
        drawn = [values[np.isfinite(values) & (values > 0.0)] for values in drawn]
        largest = max((values.max() for values in drawn if values.size), default=0.0)
        assert 0.0 < low < largest <= high * (1 + 1e-9)
        assert np.log(high / largest) < 0.2 * np.log(high / low)  # not squeezed
    plt.close("all")


GRID = cp.sweep(V6, rpm=[1e3, 2e3, 4e3], bank_angle_deg=[50, 60, 70], hold="pins", orders=[1, 2])
SPEEDS = cp.sweep(V6, rpm=[1000, 2000, 4000], orders=[1, 2])
SWEEPS = {"curves": SWEPT, "parts": SWEPT, "map": GRID, "orders": SPEEDS}


@pytest.mark.parametrize("kind", SWEEP_PICTURES)
def test_every_kind_of_a_sweep_has_a_logarithmic_scale_or_says_why_not(kind: Any) -> None:  # noqa: ANN401 - a word
    if kind == "bars":
        engines = cp.sweep([V6, V6], rpm=3000, orders=[1, 2])
        with pytest.raises(cp.InputError, match='log = True: has no meaning for kind="bars"'):
            engines.plot(kind=kind, log=True)
        return
    swept = SWEEPS[kind]
    with pytest.raises(cp.InputError, match="log = 1: give True or False"):
        swept.plot(kind=kind, log=1)
    for log in (True, False):
        panels = np.ravel(swept.plot(kind=kind, log=log))
        panels[0].get_figure(root=True).draw_without_rendering()
        if kind in ("curves", "parts"):
            assert {ax.get_yscale() for ax in panels} <= {"log" if log else "linear", "linear"}
            assert panels[0].get_yscale() == ("log" if log else "linear")
            continue
        for ax in panels:
            norm = ax.collections[0].norm
            assert isinstance(norm, LogNorm) == log
            drawn = np.ma.getdata(ax.collections[0].get_array())
            assert norm.vmin <= drawn[np.nonzero(drawn)].min() or kind == "orders"
            assert norm.vmax >= drawn.max()
    plt.close("all")


@in_turn("seed", range(5))
def test_a_logarithmic_map_has_the_peaks_of_the_linear_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles, speeds = np.sort(rng.uniform(20, 170, 5)), np.sort(rng.uniform(500, 6000, 4))
    swept = cp.sweep(V6, rpm=speeds, bank_angle_deg=angles, hold="pins", orders=[1, 2])
    pairs = (np.ravel(swept.plot(kind="map", log=log)) for log in (True, False))
    for logarithmic, linear in zip(*pairs, strict=True):
        low = logarithmic.collections[0].norm.vmin
        drawn, peaks = (ax.collections[0].get_array() for ax in (logarithmic, linear))
        np.testing.assert_array_equal(drawn, np.maximum(peaks, low))
    plt.close("all")


@pytest.mark.parametrize("quantity", ["moment", "torque"])
def test_a_sweep_is_drawn_on_a_logarithmic_scale(quantity: str) -> None:
    panels = cp.sweep(V6, rpm=[1000, 2000]).plot(quantity=quantity, log=True)
    assert {ax.get_yscale() for ax in np.ravel(panels) if ax.lines} <= {"log", "linear"}
    assert np.ravel(panels)[0].get_yscale() == "log"
    assert all(ax.get_ylim()[0] > 0.0 for ax in np.ravel(panels) if ax.get_yscale() == "log")
    with pytest.raises(cp.InputError, match="log = 1: give True or False"):
        SWEPT.plot(log=1)
    plt.close("all")
