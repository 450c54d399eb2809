"""Do pulses of an encoder give back the crank angle, the speed and the pressure of an engine?"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from rederivation import oscillograms as again
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
TDC = -again.INDEX_DEG
STEADY = again.Motion(1500.0, {})
WAVERING = again.Motion(1500.0, {2: 0.02 * np.exp(0.3j), 0.5: 0.005 * np.exp(1j)})


def record(
    motion: again.Motion,
    *,
    places: int = 60,
    missing: int = 2,
    rate: float = 200e3,
    seconds: float = 0.6,
    period: float = 360.0,
    noise: float = 0.0,
) -> dict[str, Any]:
    """Return the channels of a record by name, V, and the true angles under ``theta``."""
    times = np.arange(0.0, seconds, 1.0 / rate)
    theta = motion.angles(times)
    random = np.random.default_rng(3)
    return {
        "t": times,
        "theta": theta,
        "p": again.pressure(theta) / 20e5 + 0.05 + random.normal(0.0, noise / 1e4, len(times)),
        "wheel": again.teeth(theta, places, missing) + random.normal(0.0, noise, len(times)),
        "mark": again.marks(theta, period) + random.normal(0.0, noise, len(times)),
    }


def read(channels: dict[str, Any], **options: Any) -> cp.results.Oscillogram:  # noqa: ANN401
    """Read a record of :func:`record`, without a warning."""
    usual: dict[str, Any] = {
        "pressure": "p:20bar/V,-1bar",
        "encoder": "wheel",
        "pulses": "60-2",
        "index": "mark",
        "tdc_deg": TDC,
        "time": "t",
    }
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return cp.oscillogram(channels, **usual | options)


# A crossing is known to a part of a sample, 0.045° at 1500 rpm and 200 kHz, of which the edges of
# square pulses show the middle: half of it, and half again by the mark.
CASES: list[tuple[again.Motion, dict[str, Any], dict[str, Any], float]] = [
    (STEADY, {"places": 360, "missing": 0}, {"pulses": 360}, 0.05),
    (WAVERING, {}, {}, 0.05),
    (WAVERING, {}, {"index": None}, 0.05),
    (WAVERING, {"places": 36, "missing": 1}, {"pulses": "36−1"}, 0.05),
    (WAVERING, {"period": 720.0}, {}, 0.05),
    (WAVERING, {"places": 720, "missing": 0}, {"pulses": "720"}, 0.05),
    (WAVERING, {"noise": 0.2}, {}, 0.06),
    (again.Motion(900.0, {1: 0.05, 3: 0.03j}), {"rate": 100e3, "seconds": 1.0}, {}, 0.06),
    (again.Motion(6000.0, {1.5: 0.01}), {"seconds": 0.3}, {"encoder": "wheel:rising,2.5V"}, 0.2),
    (STEADY, {"places": 3600, "missing": 0, "rate": 500e3}, {"pulses": 3600}, 0.03),
]


@in_turn("case", CASES)
def test_the_crank_angle_is_that_of_the_motion(
    case: tuple[again.Motion, dict[str, Any], dict[str, Any], float],
) -> None:
    motion, made, options, tolerance = case
    scope = read(record(motion, **made), **options)
    traces = scope.traces[0]
    steep = abs(np.sin(np.radians(traces.theta_deg) / 2.0)) > 0.3
    away = (traces.pressure - again.pressure(traces.theta_deg))[:, steep]
    error = abs(away / again.slope(traces.theta_deg[steep]))
    assert np.median(error) < tolerance
    assert error.max() < 3.0 * tolerance + (0.6 if made.get("noise") else 0.0)
    over_time = 1.0 / np.mean(1.0 / motion.speed(np.arange(0.0, 720.0)))
    np.testing.assert_allclose(scope.rpm, over_time, rtol=1e-3)
    orders = [order for order in (0.5, 1, 1.5, 2, 3) if order <= scope.highest_order]
    expected = [motion.rpm * motion.waver.get(order, 0.0) for order in orders]
    mean = scope.speed_harmonics(orders).mean(axis=0)
    np.testing.assert_allclose(mean, expected, atol=1.5e-3 * motion.rpm)


def clock(
    wheel: np.ndarray[Any, Any],
    mark: np.ndarray[Any, Any],
    seconds: np.ndarray[Any, Any],
    places: str,
) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any], list[tuple[float, int]]]:
    """Return times of pulses, their crank angles and faults, of signals with default thresholds."""
    at, angles, _, faults = _core.crank_clock(
        seconds, (wheel, None, False), places, (mark, None, False)
    )
    return at, angles, faults


def test_noise_at_slow_edges_makes_no_pulses_and_shifts_none() -> None:
    """A sine of 60 places with noise of a tenth of its range: edges cross many times."""
    seconds = np.arange(0.0, 0.4, 5e-6)
    turned = np.radians(9000.0 * seconds - 100.0)
    noise = np.random.default_rng(0).uniform(-0.6, 0.6, len(seconds))
    at, _, faults = clock(2.5 * np.sin(60.0 * turned) + noise, np.sin(turned), seconds, "60")
    assert not faults
    assert len(at) == 600  # 3600°
    late = ((9000.0 * at - 100.0 + 3.0) % 6.0 - 3.0) / 9000.0
    # The first of the crossings would be early by half of the time in which the sine is within the
    # noise, 1.2 V over 23.6 V/ms, 25 µs; the middle is early and late alike.
    assert abs(late.mean()) < 3e-6
    assert abs(late).max() < 30e-6


def test_the_index_is_the_mean_of_its_marks() -> None:
    """Marks alternately 0.4° early and late: their mean is the place, no single one."""
    seconds = np.arange(0.0, 0.6, 5e-6)
    theta = 9000.0 * seconds - 100.0
    late = np.where(theta // 360.0 % 2 < 1, 0.4, -0.4)
    mark = ((theta - late - 20.0) % 360.0 < 3.0) * 5.0
    at, angles, _ = clock(np.sin(360.0 * np.radians(theta)), mark, seconds, "360")
    # Marks are known to half a sample, 0.02°; of an odd number of them one is not paired.
    away = (angles + 20.0 - (9000.0 * at - 100.0) + 180.0) % 360.0 - 180.0
    assert abs(away).max() < 0.4 / 14 + 0.025


def test_a_late_tooth_before_a_lost_one_is_counted_on() -> None:
    """Two intervals of 1.45 places are three: what one is more than whole is added to the next."""
    seconds = np.arange(0.0, 0.6, 5e-6)
    theta = 9000.0 * seconds - 100.0
    place = theta / 6.0
    wheel = (place % 1.0 < 0.5) * 5.0
    for number in (20.0, 80.0):
        wheel[(place >= number) & (place < number + 3.0)] = 0.0
        for first in (number + 0.45, number + 1.9):  # for 0, 1 and 2
            wheel[(place >= first) & (place < first + 0.5)] = 5.0
    mark = ((theta - 3.0) % 360.0 < 3.0) * 5.0
    at, angles, faults = clock(wheel, mark, seconds, "60")
    assert [count for _, count in faults] == [1, 1]
    away = abs((angles + 3.0 - (9000.0 * at - 100.0) + 180.0) % 360.0 - 180.0)
    # All others are at their places, to a sample; these are late by 0.45 and early by 0.1 of 6°.
    np.testing.assert_allclose(np.sort(away)[-5:], [0.0, 0.6, 0.6, 2.7, 2.7], atol=0.1)


def test_cubics_are_those_of_the_four_points_about_each() -> None:
    random = np.random.default_rng(0)
    x = np.cumsum(random.choice([0.5, 1.0, 1.5], 12))
    y = random.normal(size=12)
    at = np.sort(random.uniform(x[0], x[-1], 50))
    for place, value in zip(at, _core.cubics(x, y, at), strict=True):
        first = min(max(int(np.searchsorted(x, place)) - 2, 0), 8)
        four = slice(first, first + 4)
        line = np.polynomial.polynomial.polyfit(x[four] - place, y[four], 3)
        # Four equations of numbers of order one.
        assert value == pytest.approx(line[0], abs=1e-10)


def test_a_steady_rise_of_speed_is_no_wave_within_cycles() -> None:
    seconds = np.arange(0.0, 1.0, 5e-6)
    theta = 9000.0 * seconds + 1500.0 * seconds**2 - 500.0  # 1500 to 2000 rpm
    turned = np.radians(theta - again.INDEX_DEG)
    channels = {"t": seconds, "p": again.pressure(theta) / 20e5 + 0.05}
    channels |= {"wheel": np.sin(60.0 * turned), "mark": np.sin(turned)}
    scope = read(channels, pulses=60)
    # Speed rises by 40 rpm in a cycle; what is left is its curvature, some 1 % of that.
    assert np.ptp(scope.speed, axis=1).max() < 2.0
    means = scope.speed.mean(axis=1)
    assert means[-1] - means[0] > 250.0


SPIKE, SPIKE_DEG, WIDTH_DEG = 60e5, 30.0, 1.0
"""A pressure peak that is narrower than any of combustion: height, Pa, place and width at half."""


@in_turn("sample_deg", [0.01, 0.05, 0.2])
def test_a_narrow_peak_survives_within_the_bound_of_averages_and_cubics(sample_deg: float) -> None:
    sigma = WIDTH_DEG / np.sqrt(8.0 * np.log(2.0))
    seconds = np.arange(0.0, 0.5, sample_deg / 9000.0)
    theta = -1000.0 + 9000.0 * seconds
    away = (theta - SPIKE_DEG + 360.0) % 720.0 - 360.0
    # Signals without edges: their crossings are known, and with them the crank angle.
    turned = np.radians(theta - again.INDEX_DEG)
    channels = {
        "t": seconds,
        "p": (again.pressure(theta) + SPIKE * np.exp(-0.5 * (away / sigma) ** 2)) / 20e5 + 0.05,
        "wheel": np.sin(180.0 * turned),
        "mark": np.sin(turned),
    }
    usual: dict[str, Any] = {"pressure": "p:20bar/V,-1bar", "time": "t", "tdc_deg": TDC}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*has a spike")  # as it has
        scope = cp.oscillogram(channels, encoder="wheel", pulses=180, index="mark", **usual)
    traces = scope.traces[0]
    smooth = again.pressure(traces.theta_deg)
    away = traces.theta_deg - SPIKE_DEG
    error = traces.pressure - smooth - SPIKE * np.exp(-0.5 * (away / sigma) ** 2)
    # Means over w lose w²/24 of the second derivative, h/σ² at most; cubics between samples d apart
    # 3/128·d⁴ of the fourth, 3·h/σ⁴. Blocks of half a step of the grid, at most, are averaged.
    grid = traces.theta_deg[1] - traces.theta_deg[0]
    block = max(1, int(grid / sample_deg / 2.0)) * sample_deg
    averaged = (block**2 - sample_deg**2) / 24.0 / sigma**2
    between = 3.0 / 128.0 * block**4 * 3.0 / sigma**4
    # Chords of a sine wave of 2°, for the crossings, and the roundings of times.
    crossing = 1e-4
    assert abs(error).max() < (averaged + between + crossing) * SPIKE
    peak = (traces.pressure - smooth).max(axis=1)
    assert (peak > SPIKE * (1.0 - averaged - between - crossing)).all()
    assert np.ptp(peak) < (averaged + between + crossing) * SPIKE


@in_turn("seed", range(4))
def test_speed_is_that_of_the_reciprocal_slope_of_times(seed: int) -> None:
    """Of exact times of a whole wheel the Fourier series is differentiated by its own sum."""
    random = np.random.default_rng(seed)
    order = float(random.choice([0.5, 1.0, 2.0, 4.0]))
    motion = again.Motion(1200.0, {order: 0.03 * np.exp(2j * random.uniform(0, 3))})
    channels = record(motion, places=60, missing=0, rate=1e6)
    scope = read(channels, pulses=60)
    theta, times = channels["theta"], channels["t"]
    start = np.ceil((theta[0] + 360.0) / 720.0) * 720.0 - 360.0
    angles = start + 6.0 * np.arange(120 * len(scope.speed) + 1)
    own = again.speed_phasors(np.interp(angles, theta, times), order, 2)
    own *= np.exp(1j * np.radians(order * 360.0))  # counted from the dead centre
    # Crossings are known to half a microsecond of the 0.83 ms of a tooth.
    np.testing.assert_allclose(scope.speed_harmonics(order).mean(), own, atol=0.3)
    np.testing.assert_allclose(own, 1200.0 * motion.waver[order], atol=0.3)
    curve = motion.speed(scope.theta_deg)
    np.testing.assert_allclose(scope.speed.mean(axis=0), curve, atol=1.5)
    share = (curve.max() - curve.min()) / 1200.0
    np.testing.assert_allclose(scope.irregularity.mean(), share, rtol=0.05)


def test_imep_and_spread_are_those_of_the_cycles() -> None:
    channels = record(WAVERING, seconds=1.0)
    theta = channels["theta"]
    strength = np.random.default_rng(0).normal(1.0, 0.05, 40)
    base = cp.Cycle.example().pressure_at(theta)
    number = ((theta + 1000.0 + 80.0) // 720.0).astype(int)
    channels["p"] = ((base - 1e5) * strength[number] + 2e5) / 20e5
    scope = read(channels)
    traces = scope.traces[0]
    one = cp.Cycle.example().imep(CYLINDER)
    imep = traces.imep(CYLINDER)
    first = int(number[np.searchsorted(theta, -360.0)])
    np.testing.assert_allclose(imep, one * strength[first : first + len(imep)], rtol=2e-3)


def test_cylinders_are_read_from_their_own_dead_centres() -> None:
    engine = cp.Engine.preset("i4")
    fires = engine.firing().angles_deg
    channels = record(WAVERING)
    for k, at in enumerate(fires):
        channels[f"p{k}"] = cp.Cycle.example().pressure_at(channels["theta"] - at) / 10e5
    of = {"pressure": [f"p{k}:10bar/V" for k in range(4)]}
    scope = read(channels, **of, tdc_deg=TDC + fires)
    for traces in scope.traces:
        imep = traces.imep(CYLINDER).mean()
        np.testing.assert_allclose(imep, cp.Cycle.example().imep(CYLINDER), rtol=2e-3)
    later = read(channels, **of, tdc_deg=TDC + 360.0 + fires)
    for traces, same in zip(later.traces, scope.traces, strict=True):  # pressure shows the turn
        np.testing.assert_allclose(traces.pressure, same.pressure, rtol=1e-6)
    with pytest.raises(cp.InputError, match="pressure of cylinder 2 fires a turn from where"):
        read(channels, pressure=of["pressure"], tdc_deg=TDC + fires[[0, 2, 1, 3]])


def test_missing_and_extra_pulses_are_named_once_and_bridged() -> None:
    channels = record(WAVERING)
    theta, wheel = channels["theta"], channels["wheel"]
    lost = (theta > 36.0 - 120.0) & (theta < 39.0 - 117.0)
    extra = np.flatnonzero(theta > 723.0 + 6.0 * 5 + 2.2)[:12]
    wheel[lost] = 0.0
    wheel[extra] = 5.0
    with pytest.warns(UserWarning, match="encoder has 1 pulse missing and 1 pulse extra") as caught:
        scope = cp.oscillogram(
            channels, pressure="p:20bar/V,-1bar", encoder="wheel", pulses="60-2", index="mark",
            tdc_deg=TDC, time="t",
        )  # fmt: skip
    assert len(caught) == 1
    assert scope.pulses["pulses"].values == ("missing", "extra")
    at = [channels["t"][lost.argmax()], channels["t"][extra[0]]]
    # A pulse is missing behind the one before it, 6° earlier.
    np.testing.assert_allclose(scope.pulses["time"].values, at, atol=8e-4)
    traces = scope.traces[0]
    away = traces.pressure - again.pressure(traces.theta_deg)
    assert abs(away).max() < 0.2 * abs(again.slope(traces.theta_deg)).max()


def test_columns_of_oscilloscopes_are_read(tmp_path: Path) -> None:
    """Of vendors' headers: names above units, millivolts, decimal commas, lines of titles."""
    channels = record(WAVERING, rate=50e3)
    columns = [channels[name] for name in ("t", "p", "wheel", "mark")]
    direct = read(channels)
    t, p, wheel, mark = columns
    layouts: dict[str, tuple[str, list[Any], str, dict[str, Any]]] = {
        "keysight.csv": ("x-axis,1,2,3\nsecond,Volt,Volt,Volt\n", [t, p, wheel, mark], ",", {
            "pressure": "1:20bar/V,-1bar", "encoder": 2, "index": 3}),
        "tektronix.csv": ("Model,MSO44\nLabel,p,enc,tdc\nRecord Length,30000\n\nTIME,CH1,CH2,CH3\n",
            [t, p, wheel, mark], ",", {
            "pressure": "CH1:20bar/V,-1bar", "encoder": "CH2", "index": "CH3"}),
        "pico.txt": ("Time\tChannel A\tChannel B\tChannel C\n(ms)\t(mV)\t(V)\t(V)\n\n",
            [1e3 * t, 1e3 * p, wheel, mark], "\t", {
            "pressure": "Channel A:2000kPa/V,-100kPa", "encoder": "Channel B:2.5V",
            "index": "Channel C:2500mV"}),
        "comma.csv": ("Zeit [ms];Druck;Geber;Marke\n", [1e3 * t, p, wheel, mark], ";", {
            "pressure": "Druck:20 bar/V,-1 bar", "encoder": "Geber", "index": "Marke"}),
        "plain.dat": ("", [p, wheel, mark], " ", {
            "pressure": "0:20bar/V,-1bar", "encoder": 1, "index": 2, "sampling_rate": 50e3}),
    }  # fmt: skip
    for name, (header, values, separator, options) in layouts.items():
        rows = [separator.join(f"{v:.9f}" for v in row) for row in zip(*values, strict=True)]
        text = "\n".join([*rows, ""])
        text = text.replace(".", ",") if name == "comma.csv" else text
        encoding = "utf-16" if name == "pico.txt" else "latin-1"
        (tmp_path / name).write_text(header + text, encoding=encoding)
        scope = cp.oscillogram(tmp_path / name, pulses="60-2", tdc_deg=TDC, **options)
        assert scope.name == name.partition(".")[0]
        np.testing.assert_allclose(
            scope.traces[0].pressure, direct.traces[0].pressure, atol=100.0, err_msg=name
        )


def changed(**by: Any) -> dict[str, Any]:  # noqa: ANN401 - arrays
    channels = record(WAVERING, rate=50e3)
    return channels | {name: change(channels[name]) for name, change in by.items()}


def nan(values: Any) -> Any:  # noqa: ANN401
    return np.where(np.arange(len(values)) == 700, np.nan, values)


NOISE = np.random.default_rng(1).normal(0.0, 1.0, 30_000)


@pytest.mark.parametrize(
    ("channels", "options", "message"),
    [
        (changed(p=nan), {}, "pressure has nan as sample 700"),
        (changed(wheel=nan), {}, "encoder has nan as sample 700"),
        (changed(wheel=lambda v: 0 * v), {}, "encoder has no pulses: it is constant"),
        (changed(wheel=lambda v: 0 * v + NOISE), {}, "encoder has .* missing or extra|pulses = "),
        (changed(mark=lambda v: 0 * v), {}, "index has no pulses: it is constant"),
        (changed(mark=lambda v: 0 * v + NOISE), {}, "pulses = 60-2: |index "),
        (changed(), {"encoder": "mark"}, r"encoder has 15 pulses, a turn of 60-2 has 58"),
        (changed(), {"pulses": 1}, "pulses = 1: give 4 to 36000 pulses"),
        (changed(), {"pulses": "60-30"}, "pulses = 60-30: a quarter"),
        (changed(), {"pulses": "many"}, "pulses = many: give the pulses of a turn"),
        (changed(), {"pulses": "36-1"}, "36-1: the encoder's gaps, of 2 missing .* 60 places"),
        (changed(), {"pulses": 60}, "pulses = 60: each turn has a gap; is it 60-2?"),
        (changed(), {"pulses": 360}, "pulses = 360: 60 pulses, gaps filled, are between marks"),
        (changed(), {"pulses": 60, "index": None}, "index is not given, and the enc"),
        (changed(), {"encoder": "wheel:9V"}, "encoder never crosses 9: it is between 0 and 5"),
        (changed(), {"encoder": "wheel:up"}, "encoder = 'wheel:up': give rising or falling"),
        (changed(), {"encoder": "teeth"}, "encoder = 'teeth': there is none; the source has 't'"),
        (changed(), {"pressure": "p"}, "pressure_unit = None: the file does not name one"),
        (changed(), {"pressure": "p:20/V"}, "pressure = 'p:20': it has no unit"),
        (changed(), {"pressure": "p:0bar/V"}, "pressure = 'p:0bar/V': a gain of zero"),
        (changed(), {"pressure": "p:20kg/V"}, "pressure = 'p:20kg': give gain and offset"),
        (changed(), {"pressure": "p:-20bar/V"}, "pressure of cylinder 1 falls by .* upside down"),
        (changed(), {"pressure": []}, r"pressure = \[\]: give the channel"),
        (changed(), {"tdc_deg": [0, 180]}, "tdc_deg has 2 angles for 1 cylinders"),
        (changed(t=lambda v: v[::-1]), {}, "time has .* after .*: times must ascend"),
        (changed(t=lambda v: v * 0), {}, "time has 0 after 0, sample 1: times must ascend"),
        (changed(t=lambda v: v * 1e9), {}, "time = .* rpm"),
        (changed(), {"time": None}, "time = None: give it, or sampling_rate="),
        (changed(), {"sampling_rate": 5e4}, "time = 't': sampling_rate gives it"),
        (changed(), {"time": None, "sampling_rate": 0.0}, "sampling_rate = 0.0: give samples"),
        (changed(), {"strokes": 3}, "strokes = 3"),
        (changed(mark=lambda v: v[:-1]), {}, "index has 29999 samples, pressure 30000"),
        (
            {name: values[:6000] for name, values in changed().items()}, {},
            "source has .*° of crank angle: no whole cycle of 720°",
        ),
        (
            changed(p=lambda _: 1 + np.cos(np.radians(record(WAVERING, rate=50e3)["theta"])) ** 40),
            {},
            "of cylinder 1 peaks at .* bar about the dead centre at 114° and .* either may",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_one_error(
    channels: dict[str, Any], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(cp.InputError, match=message):
        read(channels, **options)


def test_orders_that_teeth_do_not_resolve_are_rejected() -> None:
    scope = read(record(WAVERING, places=36, missing=1, rate=50e3), pulses="36-1")
    assert scope.highest_order == 7.0
    with pytest.raises(cp.InputError, match="orders = 8: the pulses resolve orders up to 7"):
        scope.speed_harmonics([1, 8])


def test_a_two_stroke_needs_no_cycle_mark() -> None:
    channels = record(STEADY)
    theta = channels["theta"]
    channels["p"] = (1.2 + np.cos(np.radians(theta))) ** 4 / 10.0 + 0.1
    scope = read(channels, strokes=2)
    assert scope.traces[0].strokes == 2
    expected = 1e5 + 20e5 * (1.2 + np.cos(np.radians(scope.traces[0].theta_deg))) ** 4 / 10.0
    np.testing.assert_allclose(scope.traces[0].mean_cycle.pressure, expected, atol=2e3)
    assert [row for row in scope.table["figure"].values if "0.5" in row] == []
