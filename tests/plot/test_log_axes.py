"""Do pictures of magnitudes show their data on logarithmic axes too?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib.pyplot as plt
import numpy as np
import pytest
from crankpin.plot.style import SERIES

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


@pytest.mark.parametrize("quantity", ["moment", "torque"])
def test_a_sweep_is_drawn_on_a_logarithmic_scale(quantity: str) -> None:
    panels = cp.sweep(V6, rpm=[1000, 2000]).plot(quantity=quantity, log=True)
    assert {ax.get_yscale() for ax in np.ravel(panels) if ax.lines} <= {"log", "linear"}
    assert np.ravel(panels)[0].get_yscale() == "log"
    assert all(ax.get_ylim()[0] > 0.0 for ax in np.ravel(panels) if ax.get_yscale() == "log")
    with pytest.raises(cp.InputError, match="log = 1: give True or False"):
        SWEPT.plot(log=1)
    plt.close("all")
