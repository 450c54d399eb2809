"""A short record of an oscilloscope, of which tests make results and pictures."""

from __future__ import annotations

import functools
from typing import Any

import crankpin as cp
import numpy as np


@functools.cache
def channels() -> dict[str, Any]:
    """Return the samples of three cycles by name: two turns a cycle, of 12 less 1 pulses."""
    theta = np.arange(-500.0, 2200.0, 0.5)
    slowness = 1.0 / (9000.0 * (1.0 + 0.02 * np.cos(np.radians(2.0 * theta))))
    return {
        "time [s]": np.cumsum(0.5 * slowness),
        "p abs [Pa]": cp.Cycle.example().pressure_at(theta),
        "wheel": (theta % 30.0 < 15.0) * (theta % 360.0 < 330.0) * 5.0,
        "mark": (theta % 360.0 < 4.0) * 5.0,
    }


def scope() -> cp.results.Oscillogram:
    """Return them read."""
    return cp.oscillogram(
        channels(), pressure="p abs [Pa]", encoder="wheel", pulses="12-1", time="time [s]"
    )
