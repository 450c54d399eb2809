"""Are pictures of cycles their pressures?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from support.reading import figure_of, legend_texts, title_of

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
MOTORED = cp.Cycle.motored(CYLINDER, compression_ratio=10)


def test_pressure_is_drawn_over_crank_angle_and_closed() -> None:
    theta = np.arange(-360, 360)
    pressure = 1e5 + 1e6 * np.exp(-((theta / 30.0) ** 2))
    ax = cp.Cycle(theta, pressure, name="bench").plot()
    (line,) = ax.lines
    np.testing.assert_array_equal(line.get_xdata(), np.arange(-360, 361))
    np.testing.assert_array_equal(line.get_ydata(), np.append(pressure, pressure[0]) / 1e5)
    assert title_of(ax) == "Cylinder pressure\nbench"
    assert ax.get_ylabel() == "absolute pressure, bar"
    MOTORED.plot(ax)
    assert title_of(ax) == "Cylinder pressure"
    assert legend_texts(ax) == ["bench", MOTORED.name]
    plt.close(figure_of(ax))


def test_pressure_over_volume_encloses_the_work() -> None:
    otto = cp.Cycle.otto(CYLINDER, compression_ratio=10, pressure_ratio=3)
    ax = otto.plot(cylinder=CYLINDER, label="Otto")
    (line,) = ax.lines
    x, y = (np.asarray(values, dtype=float) for values in line.get_data())
    work = (0.5 * (y[1:] + y[:-1]) * np.diff(x)).sum() * 0.1  # bar cm³
    # Trapezia between points some degrees apart.
    assert work == pytest.approx(otto.work(CYLINDER), rel=0.01)
    assert x.max() == pytest.approx(np.pi / 4 * 8.6**3)
    assert ax.get_xlabel() == "volume swept, cm³"
    with pytest.raises(cp.InputError, match="bore = None"):
        otto.plot(cylinder=CYLINDER.replace(bore=None))
    plt.close("all")
