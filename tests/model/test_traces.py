"""Do records of many cycles have the mean and the spread of their cycles?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from rederivation import traces as again

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
CRANK = (0.043, 0.145, 0.0)
THETA = np.arange(-360.0, 360.0, 0.5)


def measured(seed: int) -> cp.Traces:
    """Sixty cycles of a combustion that varies, of random strength."""
    rng = np.random.default_rng(seed)
    base = cp.Cycle.example().pressure_at(THETA) - 1e5
    strength = rng.normal(1.0, rng.uniform(0.01, 0.1), (60, 1))
    return cp.Traces(THETA, 1e5 + base * strength)


@pytest.mark.parametrize("seed", range(5))
def test_imep_cov_and_harmonics_are_those_of_sums_over_points(seed: int) -> None:
    traces = measured(seed)
    imep = again.imep(THETA, traces.pressure, CRANK)
    # Trapezes of 0.5° over the kinks of opening valves.
    np.testing.assert_allclose(traces.imep(CYLINDER), imep, rtol=2e-4)
    np.testing.assert_allclose(traces.cov(CYLINDER), again.cov(imep), rtol=2e-3)
    phasors = traces.torque_harmonics(CYLINDER, [0.5, 1, 6])
    expected = again.torque_phasors(THETA, traces.pressure, [0.5, 1, 6], CRANK, 0.086)
    np.testing.assert_allclose(phasors, expected, atol=1e-4 * abs(expected).max())
    mean = traces.mean.torque_harmonics(CYLINDER, [0.5, 1, 6])
    # Limits of slopes are not linear in pressure: below the error of interpolation.
    np.testing.assert_allclose(phasors.mean(axis=0), mean, atol=1e-4 * abs(mean).max())
    assert len(traces) == 60
    assert traces[-1] == cp.Cycle(THETA, traces.pressure[59])
    assert [*traces][7] == traces[7]


@pytest.mark.parametrize("seed", range(5))
def test_noise_is_found_and_is_in_the_error_of_harmonics(seed: int) -> None:
    """The standard error over cycles of a constant combustion is that of noise, by its own sum."""
    noise = float(np.random.default_rng(seed).uniform(1e3, 1.5e4))
    rng = np.random.default_rng(100 + seed)
    base = cp.Cycle.example().pressure_at(THETA)
    traces = cp.Traces(THETA, base + rng.normal(0.0, noise, (60, len(THETA))))
    assert abs(traces.noise / noise - 1.0) < 0.03  # of 86 000 differences, by their median
    errors = traces.resolution_error(CYLINDER, [0.5, 6, 12])
    expected = again.noise_of_phasors(noise, THETA, CRANK, 0.086) / np.sqrt(60)
    # Deviations of 60 phasors of two parts each are known to 1/sqrt(2·118) = 7 %, three of these;
    # the change of thinning, of a mean that has noise, contains it once more.
    assert (errors > 0.8 * expected).all()
    assert (errors < 4.0 * expected).all()
    known = cp.Cycle.example().torque_harmonics(CYLINDER, [0.5, 6, 12])
    actual = abs(traces.mean.torque_harmonics(CYLINDER, [0.5, 6, 12]) - known)
    assert (actual < 4.0 * errors).all()
    assert np.isnan(cp.Traces(THETA, base[None]).resolution_error(CYLINDER, 1)).all()


def test_spread_has_peaks_imep_and_orders() -> None:
    traces = measured(1)
    table = traces.spread(CYLINDER, [0.5, 6])
    assert table["figure"].values == (
        "peak pressure", "angle of peak", "imep", "torque order 0.5", "torque order 6"
    )  # fmt: skip
    imep = traces.imep(CYLINDER) / 1e5
    row = [table[name].values[2] for name in ("mean", "deviation", "COV", "least", "largest")]
    expected = [imep.mean(), imep.std(ddof=1), 100 * traces.cov(CYLINDER), imep.min(), imep.max()]
    np.testing.assert_allclose(row, expected, rtol=1e-14)
    assert table["least"].values[0] == traces.peaks.min() / 1e5
    assert table["largest"].values[1] == traces.peaks_deg.max()
    phasors = traces.torque_harmonics(CYLINDER, [0.5, 6])
    np.testing.assert_allclose(table["mean"].values[3:], abs(phasors.mean(axis=0)), rtol=1e-14)


def test_spread_of_one_cycle_and_of_cycles_alike() -> None:
    theta = np.arange(-360.0, 360.0, 0.45)
    pressure = cp.Cycle.example().pressure_at(theta)
    alike = cp.Traces(theta, np.tile(pressure, (60, 1))).spread(CYLINDER)
    assert set(alike["deviation"].values) == {0.0}  # not the rounding of their mean
    one = cp.Traces(theta, pressure[None]).spread(CYLINDER)
    assert set(one["deviation"].cells()) == {"–"}
    assert "nan" not in one.text()


@pytest.mark.parametrize(
    ("pressure", "message"),
    [
        (np.full(1440, 1e6), r"pressure has shape \(1440,\): give a row of 1440 pressures"),
        (np.full((2, 3), 1e6), r"pressure has shape \(2, 3\): give a row"),
        (np.full((0, 1440), 1e6), r"pressure has shape \(0, 1440\): give a row"),
        (np.full((2, 1440), np.nan), "pressure has numbers that are not finite"),
    ],
)
def test_wrong_shapes_are_rejected(pressure: Any, message: str) -> None:  # noqa: ANN401
    with pytest.raises(cp.InputError, match=message):
        cp.Traces(THETA, pressure)


def test_what_is_wrong_is_warned_of_once() -> None:
    base = np.array([cp.Cycle.example().pressure_at(THETA)] * 3)
    for pressure, message in (
        (base / 1e5, "was it given in bar"),
        (base - 2e5 * (THETA > 300), "pressure is .* at its least"),
        (np.roll(base, 300, axis=1), "far from the firing top dead centre"),
    ):
        with pytest.warns(UserWarning, match=message) as caught:
            cp.Traces(THETA, pressure)[1].torque_harmonics(CYLINDER, 1)
        assert len(caught) == 1
        assert caught[0].filename == __file__
