"""Is a measured trace what it was before sensor, encoder and noise, to stated bounds?"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from numpy.typing import NDArray
from rederivation import traces as again
from support import in_turn

Array = NDArray[np.float64]
THETA = np.arange(-360.0, 360.0, 0.5)


class Bench(NamedTuple):
    """What a cylinder had, and what was measured of it."""

    cylinder: cp.Cylinder
    crank: tuple[float, float, float]
    ratio: float
    n: float
    shift: float
    loss_angle: float
    offset: float
    noise: float
    true: Array
    traces: cp.Traces
    motored: cp.Traces


def bench(seed: int, *, noise: float | None = None) -> Bench:
    """Sixty cycles of a random engine, with shift, offset and noise that are random too."""
    rng = np.random.default_rng(seed)
    crank = (0.043, 0.043 / rng.uniform(0.2, 0.33), rng.uniform(-0.001, 0.001))
    ratio, n = rng.uniform(8.5, 13.0), rng.uniform(1.28, 1.36)
    shift, offset = rng.uniform(-1.5, 1.5), rng.uniform(-0.1e5, 0.9e5)
    noise = rng.uniform(2e3, 1.5e4) if noise is None else noise
    rise, loss = rng.uniform(2.0, 3.5), rng.uniform(0.01, 0.03)
    strength = 1.0 + rng.normal(0.0, 0.03, 60)
    strength += 1.0 - strength.mean()
    true, clean = (
        np.array([again.burnt(THETA - late, crank, ratio, n, float(rise * k)) for k in strength])
        for late in (0.0, shift)
    )
    still = again.motored(THETA - shift, crank, ratio, n, loss)
    drift = rng.normal(0.0, 3e3, (60, 1))
    drift -= drift.mean()
    shape = (60, len(THETA))
    traces = cp.Traces(THETA, clean + offset + drift + rng.normal(0.0, noise, shape))
    motored = cp.Traces(THETA, still + 1e5 + rng.normal(0.0, noise, shape))
    cylinder = cp.Cylinder(crank[0], crank[1], 0.5, pin_offset=crank[2], bore=0.086)
    peak = again.motored_peak(crank, ratio, n, loss)
    return Bench(
        cylinder, crank, ratio, n, shift, -peak, offset, noise, true, traces, motored
    )  # fmt: skip


@in_turn("seed", range(8))
def test_shift_offset_imep_and_spread_are_recovered(seed: int) -> None:
    known = bench(seed)
    prepared = cp.prepare_trace(
        known.traces,
        known.cylinder,
        motored=known.motored,
        loss_angle_deg=known.loss_angle,
        exponent=known.n,
        compression_ratio=known.ratio,
    )
    # The slope of a polynomial of degree 6 through 81 points over 40° has 0.05/° of their noise, in
    # a mean of 60; pressure of these engines bends by 2.5e3 Pa/deg² and more. Four deviations of
    # that, and 0.003° for what a polynomial leaves.
    allowed = 4.0 * 0.05 * known.noise / np.sqrt(60) / 2.5e3 + 0.003
    assert abs(prepared.tdc_deg - known.shift) < allowed
    # A constant beside V⁻ⁿ has 0.3 of the noise of one of 80 points, over sqrt(60), four
    # deviations; and a degree changes it by some 1.5e4 Pa.
    assert abs(prepared.offsets.mean() + known.offset) < 0.16 * known.noise + 1.5e4 * allowed
    true = again.imep(THETA, known.true, known.crank)
    # A degree of shift is 4 to 6 % of imep.
    np.testing.assert_allclose(prepared.imep()[-1].mean(), true.mean(), rtol=0.06 * allowed + 3e-4)
    # The noise of a cycle's imep is below 1e-3 of it.
    np.testing.assert_allclose(prepared.traces.cov(known.cylinder), again.cov(true), rtol=0.05)
    phasors = again.torque_phasors(
        THETA, known.true.mean(axis=0)[None], [0.5, 1, 6], known.crank, 0.086
    )[0]
    measured = prepared.cycle.torque_harmonics(known.cylinder, [0.5, 1, 6])
    np.testing.assert_allclose(measured, phasors, atol=6e-3 * abs(phasors).max())


@in_turn("seed", range(4))
def test_offsets_by_intake_sensor_and_two_points_agree(seed: int) -> None:
    known = bench(seed, noise=1.0)
    given: dict[str, Any] = {"tdc_deg": known.shift}
    by_intake = cp.prepare_trace(known.traces, known.cylinder, intake_pressure=1e5, **given)
    # The intake has 1 bar to −140°: noise of 1 Pa alone.
    raw = known.traces.pressure.mean(axis=0)
    assert abs(by_intake.offsets.mean() + known.offset) < 5.0
    pulsation = 400.0 * np.sin(np.radians(THETA - known.shift))  # none at the lower dead centre
    sensor = cp.Traces(THETA, np.full((60, len(THETA)), 1e5) + pulsation)
    by_sensor = cp.prepare_trace(known.traces, known.cylinder, intake_pressure=sensor, **given)
    np.testing.assert_allclose(by_sensor.offsets, by_intake.offsets, atol=5.0)
    options: dict[str, Any] = {"compression_ratio": known.ratio} | given
    by_exponent = cp.prepare_trace(known.traces, known.cylinder, exponent=known.n, **options)
    two = again.offset_of_two_points(THETA - known.shift, raw, known.crank, known.ratio, known.n)
    assert abs(by_exponent.offsets.mean() - two) < 30.0
    assert abs(two + known.offset) < 30.0
    fitted = cp.prepare_trace(known.traces, known.cylinder, exponent="fit", **options)
    exponent = float(fitted.names[-1].partition("n = ")[2].partition(" ")[0])
    assert abs(exponent - known.n) < 2e-3  # three decimals are shown
    assert abs(fitted.offsets.mean() - two) < 200.0


@in_turn("seed", range(8))
def test_the_fitted_exponent_is_that_of_the_compression(seed: int) -> None:
    """Without noise the offsets are those of the trace; with it no other exponent leaves less."""
    rng = np.random.default_rng([3, seed])
    crank = (0.043, 0.043 / rng.uniform(0.2, 0.33), rng.uniform(-0.005, 0.005))
    ratio, n, offset = rng.uniform(7.0, 20.0), rng.uniform(1.17, 1.43), rng.uniform(-1e5, 1e5)
    cylinder = cp.Cylinder(*crank[:2], 0.5, pin_offset=crank[2], bore=0.086)
    volume = again.relative_volume(THETA, crank, ratio)
    clean = rng.uniform(0.5e5, 2e5) * (ratio / volume) ** n
    options: dict[str, Any] = {"exponent": "fit", "compression_ratio": ratio}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of pressure that does no work
        exact = cp.prepare_trace(cp.Traces(THETA, [clean + offset]), cylinder, **options)
        # The fit of two terms amplifies the rounding of its polynomial, 1e-14.
        np.testing.assert_allclose(exact.offsets, -offset, atol=1e-2)
        noisy = clean + offset + rng.normal(0.0, 3.0, (5, len(THETA)))
        noisy_traces = cp.Traces(THETA, noisy)
        offsets = cp.prepare_trace(noisy_traces, cylinder, **options).offsets
    window = (THETA >= -100.0) & (THETA <= -60.0)
    mean, near = noisy.mean(axis=0)[window], volume[window]

    def left(exponent: float) -> tuple[float, float]:
        matrix = np.column_stack([np.ones(len(near)), near**-exponent])
        solved, *_ = np.linalg.lstsq(matrix, mean)
        return float(((matrix @ solved - mean) ** 2).sum()), -float(solved[0])

    squares, by_exponent = np.array([left(n) for n in np.linspace(1.15, 1.45, 3001)]).T
    best = int(squares.argmin())
    around = by_exponent[max(best - 1, 0) : best + 2]
    assert around.min() - 1.0 <= offsets.mean() <= around.max() + 1.0


@in_turn("seed", range(3))
def test_filters_take_noise_and_leave_orders_below_them(seed: int) -> None:
    known = bench(seed)
    prepared = cp.prepare_trace(known.traces, known.cylinder, lowpass_order=60)
    assert prepared.traces.noise < 0.02 * known.noise < prepared.stages[0].noise
    before, after = (
        each.mean_cycle.torque_harmonics(known.cylinder, [0.5, 1, 6, 12])
        for each in prepared.stages
    )
    # (12/60)⁸ = 3e-6 of order 12, and what limits of slopes make of noise.
    np.testing.assert_allclose(after, before, atol=2e-4 * abs(before).max())
    # At the order of the filter half of a wave is left, without a phase.
    wave = cp.Traces(THETA, np.array([5e5 + 1e5 * np.cos(np.radians(20.0 * THETA))] * 3))
    halved = cp.prepare_trace(wave, known.cylinder, lowpass_order=20).traces
    np.testing.assert_allclose(halved.pressure - 5e5, 0.5 * (wave.pressure - 5e5), atol=1e-3)


@in_turn("seed", range(6))
def test_peaks_offsets_and_filters_are_those_of_numpy(seed: int) -> None:
    """Its fits and transforms of all cycles at once; what differs is their rounding."""
    known = bench(seed)
    motored = known.motored.pressure.mean(axis=0)
    peak = again.compression_peak(THETA, motored, 720.0)
    # A slope that rounds by 1e-14 of its terms, 1e5 Pa/°, beside a curvature of 2.5e3 Pa/deg².
    assert abs(_core.compression_peak(THETA, motored, 720.0) - peak) < 1e-10
    window = (THETA >= -100.0) & (THETA <= -60.0)
    rows, volume = (
        known.traces.pressure[:, window],
        again.relative_volume(THETA[window], known.crank, known.ratio),
    )
    figures = (known.cylinder._parts, known.cylinder.bore, known.ratio, 4)
    parts = figures, THETA[window], rows
    n, offsets = _core.polytropic_offsets(*parts, None)
    # Squares that round by 1e-15 of themselves leave half of the digits of where they are least.
    assert abs(n - again.fitted_exponent(rows.mean(axis=0), volume)) < 1e-8
    np.testing.assert_allclose(offsets, again.polytropic_offsets(rows, volume, n), atol=1e-6)
    n, offsets = _core.polytropic_offsets(*parts, 1.3)
    assert n == 1.3
    np.testing.assert_allclose(offsets, again.polytropic_offsets(rows, volume, n), atol=1e-6)


@in_turn("seed", range(3))
def test_filters_of_records_of_any_length_are_those_of_numpy(seed: int) -> None:
    """Even and odd, prime, of large primes, closed or open, one cycle or many."""
    rng = np.random.default_rng([9, seed])
    for count, length in [(1, 8), (2, 9), (7, 16), (8, 7), (37, 74), (61, 131), (300, 721)]:
        rows, closed = rng.normal(size=(count, length)), bool(rng.integers(2))
        order = rng.uniform(0.1, length / 4.0)
        theta = 720.0 * np.arange(length + closed) / length
        given = np.column_stack([rows, rows[:, 0]]) if closed else rows
        filtered = _core.low_passed(theta, given, 720.0, order)
        expected = again.low_passed(rows, 720.0, order)
        np.testing.assert_allclose(filtered[:, :length], expected, atol=1e-13)
        if closed:
            np.testing.assert_array_equal(filtered[:, -1], filtered[:, 0])


def test_the_change_of_each_step_is_reported() -> None:
    """Half a degree of the example at full load: 1.9 % of imep, 8 % of order 12."""
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    pressure = cp.Cycle.example().pressure_at(THETA)
    traces = cp.Traces(THETA, pressure * np.array([[0.99], [1.01]]))
    prepared = cp.prepare_trace(traces, cylinder, tdc_deg=0.5, intake_pressure=1e5)
    table = prepared.table
    assert round(table["changes"].values[1], 1) == -1.9
    assert round(table["order 12"].values[1], 1) == 8.0
    assert abs(table["changes"].values[2]) < 1e-9  # a constant does no work
    assert table["order 1"].values[2] > 0.1
    assert table["step"].values == prepared.names
    orders = prepared.frames["orders"]
    expected = [abs(each.mean_cycle.torque_harmonics(cylinder, 6)[0]) for each in prepared.stages]
    np.testing.assert_allclose(orders["order 6"].values, expected, rtol=1e-13)
    assert prepared.cycle == prepared.traces.mean_cycle
    assert prepared.frames["spread"] == prepared.traces.spread(cylinder)
    plain = cp.prepare_trace(traces, cylinder)
    assert plain.traces == traces
    assert plain.names == ("as measured",)


def test_what_is_wrong_with_a_trace_is_warned_of() -> None:
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    rng = np.random.default_rng(1)
    pressure = cp.Cycle.example().pressure_at(THETA)
    noisy = cp.Traces(THETA, pressure + 4e5 + rng.normal(0.0, 5e4, (10, len(THETA))))
    with pytest.warns(UserWarning, match=r"noise of 0\.498 bar, .* lowpass_order=…"):
        cp.prepare_trace(noisy, cylinder)
    cp.prepare_trace(noisy, cylinder, lowpass_order=40)
    smooth = cp.Traces(THETA, pressure[None])
    with pytest.warns(UserWarning, match=r"tdc_deg = 8: more than an encoder is off"):
        cp.prepare_trace(smooth, cylinder, tdc_deg=8)
    with pytest.warns(UserWarning, match="at its least"):
        cp.prepare_trace(smooth, cylinder, intake_pressure=2.95e5, window_deg=(140, 150))
    mirrored = cp.Traces(THETA, pressure[::-1][None])
    with pytest.warns(UserWarning, match="takes work from the crank"):
        cp.prepare_trace(mirrored, cylinder)


def test_an_offset_that_makes_no_pressure_is_removed() -> None:
    """A piezoelectric sensor measures changes alone: its zero may be bars away."""
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    pressure = cp.Cycle.example().pressure_at(THETA) * np.array([[0.99], [1.0], [1.01]])
    known = cp.Traces(THETA, pressure)
    with pytest.warns(UserWarning, match=r"at its least: no .* crankpin\.prepare_trace removes it"):
        raw = cp.Traces(THETA, pressure - 7e5)
    with pytest.raises(cp.InputError, match="pressure is -605950 Pa at its least"):
        raw[0]
    assert not hasattr(raw, "mean")
    np.testing.assert_allclose(raw.imep(cylinder), known.imep(cylinder), rtol=1e-12)
    harmonics = raw.torque_harmonics(cylinder, [1, 2], crankcase=101325.0 - 7e5)
    np.testing.assert_allclose(harmonics, known.torque_harmonics(cylinder, [1, 2]), rtol=1e-10)
    assert "3 cycles" in repr(raw)
    prepared = cp.prepare_trace(raw, cylinder, intake_pressure=0.95e5)
    assert abs(prepared.cycle.pressure_at(-180) - 0.95e5) < 1.0
    assert "intake at 0.95 bar" in repr(prepared)


@pytest.mark.filterwarnings("ignore:pressure is")
def test_an_intake_in_bar_is_warned_of() -> None:
    traces = cp.Traces(THETA, cp.Cycle.example().pressure_at(THETA)[None])
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    with pytest.warns(UserWarning, match=r"intake_pressure = 0\.95 Pa: was it given in bar"):
        cp.prepare_trace(traces, cylinder, intake_pressure=0.95)
    cp.prepare_trace(traces, cylinder, intake_pressure=0.95e5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tdc_deg": 1, "motored": cp.Cycle.example()}, "tdc_deg = 1: motored gives it"),
        ({"loss_angle_deg": 1}, "loss_angle_deg = 1: needs motored"),
        ({"exponent": 1.3}, "compression_ratio = None: a polytropic compression needs it"),
        (
            {"exponent": 1.3, "compression_ratio": 0.5},
            r"compression_ratio = 0\.5: give a number from",
        ),
        ({"exponent": 3, "compression_ratio": 9}, r"exponent = 3\.0: give 1\.25"),
        ({"exponent": "best", "compression_ratio": 9}, "exponent = 'best': give"),
        ({"exponent": 1.3, "intake_pressure": 1e5}, r"exponent = 1\.3: intake_pressure gives"),
        ({"intake_pressure": -1}, r"intake_pressure = -1\.0: give absolute pressure"),
        ({"window_deg": (0, 9)}, r"window_deg = \(0, 9\): needs"),
        ({"intake_pressure": 1e5, "window_deg": (9, 0)}, "window_deg = .*: give two angles"),
        ({"intake_pressure": 1e5, "window_deg": (0.1, 0.2)}, "window_deg has 0 points"),
        ({"lowpass_order": 1e4}, r"lowpass_order = 10000\.0: give an order above 0 and below 360"),
        ({"motored": "trace"}, "motored = 'trace': give crankpin.Traces"),
        ({"motored": cp.Cycle(range(0, 720, 90), [2e5] * 8)}, "motored has 1 points within 20°"),
    ],
)
def test_arguments_that_exclude_each_other_are_named(options: Any, message: str) -> None:  # noqa: ANN401
    traces = cp.Traces(THETA, cp.Cycle.example().pressure_at(THETA)[None])
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    with pytest.raises(cp.InputError, match=message):
        cp.prepare_trace(traces, cylinder, **options)
    with pytest.raises(cp.InputError, match="bore = None: "):
        cp.prepare_trace(traces, cylinder.replace(bore=None))
    with pytest.raises(cp.InputError, match=r"traces = 3: give crankpin\.Traces"):
        cp.prepare_trace(3, cylinder)  # type: ignore[arg-type]
