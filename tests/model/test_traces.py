"""Do records of many cycles have the mean and the spread of their cycles?"""

from __future__ import annotations

import warnings
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from rederivation import traces as again
from support import in_turn

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
CRANK = (0.043, 0.145, 0.0)
THETA = np.arange(-360.0, 360.0, 0.5)


def measured(seed: int) -> cp.Traces:
    """Sixty cycles of a combustion that varies, of random strength."""
    rng = np.random.default_rng(seed)
    base = cp.Cycle.example().pressure_at(THETA) - 1e5
    strength = rng.normal(1.0, rng.uniform(0.01, 0.1), (60, 1))
    return cp.Traces(THETA, 1e5 + base * strength)


@in_turn("seed", range(5))
def test_imep_cov_and_harmonics_are_those_of_sums_over_points(seed: int) -> None:
    traces = measured(seed)
    imep = again.imep(THETA, traces.pressure, CRANK)
    # Trapezes of 0.5° over the kinks of opening valves.
    np.testing.assert_allclose(traces.imep(CYLINDER), imep, rtol=2e-4)
    np.testing.assert_allclose(traces.cov(CYLINDER), again.cov(imep), rtol=2e-3)
    phasors = traces.torque_harmonics(CYLINDER, [0.5, 1, 6])
    expected = again.torque_phasors(THETA, traces.pressure, [0.5, 1, 6], CRANK, 0.086)
    np.testing.assert_allclose(phasors, expected, atol=1e-4 * abs(expected).max())
    mean = traces.mean_cycle.torque_harmonics(CYLINDER, [0.5, 1, 6])
    # Limits of slopes are not linear in pressure: below the error of interpolation.
    np.testing.assert_allclose(phasors.mean(axis=0), mean, atol=1e-4 * abs(mean).max())
    assert len(traces) == 60
    assert traces[-1] == cp.Cycle(THETA, traces.pressure[59])
    assert [*traces][7] == traces[7]


@in_turn("seed", range(5))
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
    actual = abs(traces.mean_cycle.torque_harmonics(CYLINDER, [0.5, 6, 12]) - known)
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


MOTORED = cp.Cycle.motored(CYLINDER, compression_ratio=10.5).pressure_at(THETA)


def burnt(seed: int, count: int = 50) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Cycles of one compression and a combustion that varies, with noise and drift, Pa."""
    rng = np.random.default_rng(seed)
    strength = rng.normal(1.0, 0.03, (count, 1))
    rows = MOTORED + strength * (cp.Cycle.example().pressure_at(THETA) - MOTORED)
    noise = rng.uniform(0.0, 8e3)
    return np.array(rows + rng.normal(0.0, noise, rows.shape) + rng.normal(0, 3e3, (count, 1)))


def quietly(theta: Any, pressure: Any) -> cp.Traces:  # noqa: ANN401
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cp.Traces(theta, pressure)


@in_turn("seed", range(8))
def test_spikes_and_odd_cycles_are_named_and_nothing_else(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = burnt(seed)
    assert len(cp.Traces(THETA, rows).anomalies) == 0
    k = rng.permutation(50)[:7]
    at = rng.integers(len(THETA), size=3)
    height = rng.choice([-1.0, 1.0], 3) * rng.uniform(5.0, 60.0, 3)
    rows[k[:3], at] += 1e5 * height
    rows[k[3]] = MOTORED
    shift = int(rng.choice([-40, -6, 6, 40, 300]))
    rows[k[4]] = np.roll(rows[k[4]], shift)
    rows[k[5]] = 5e5
    rows[k[6], 760:820] += 5e5 * np.sin(np.arange(60))
    with pytest.warns(UserWarning, match="measured pressure: traces") as caught:
        traces = cp.Traces(THETA, rows)
    assert len(caught) == 1
    table = traces.anomalies
    found = {
        cycle: (kind, angle)
        for cycle, kind, angle in zip(
            *(table[name].values for name in ("cycle", "kind", "crank angle")), strict=True
        )
    }
    kinds = ["misfire", "shifted", "unlike"]
    expected = {int(k[j]): ("spike", THETA[at[j]]) for j in range(3)}
    expected |= {int(k[3 + j]): (kind, None) for j, kind in enumerate(kinds)}
    oscillates = found.pop(int(k[6]))
    assert oscillates[0] == "oscillation"
    assert 15.0 < oscillates[1] < 55.0
    assert found == expected
    (size,) = (
        table["size"].values[j] for j, each in enumerate(table["cycle"].values) if each == k[4]
    )
    # A charge that differs by 1 % looks like 0.3°; beyond 40° the peak decides, of combustion too.
    assert abs(size - shift / 2.0) < (2.0 if abs(shift) > 80 else 0.7)
    left = cp.prepare_trace(traces, CYLINDER, leave_out="odd", spikes="replace")
    assert len(left.traces) == 46
    assert left.names[1] == "3 spikes replaced"
    sound = np.delete(burnt(seed), k[3:], axis=0)
    # Between neighbours noise stands in for noise.
    assert abs(left.traces.pressure - sound).max() < 1e5
    clean = cp.Traces(THETA, sound)
    np.testing.assert_allclose(left.traces.cov(CYLINDER), clean.cov(CYLINDER), rtol=1e-2)


def test_spikes_are_in_neither_offset_nor_spread() -> None:
    """Fifty cycles with a spike of 60 bar in each: as the bench has them."""
    rng = np.random.default_rng(5)
    rows = burnt(5) + 0.3e5
    spiked = rows.copy()
    for row in spiked:
        row[rng.integers(len(THETA))] += rng.choice([-6e6, 6e6])
    window = (THETA + 360) % 720 - 360
    spiked[::5, np.flatnonzero((window > -185) & (window < -175))[3]] -= 6e6
    traces = quietly(THETA, spiked)
    options: dict[str, Any] = {"intake_pressure": 0.95e5}
    sound = cp.prepare_trace(cp.Traces(THETA, rows), CYLINDER, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        kept = cp.prepare_trace(traces, CYLINDER, **options)
    replaced = cp.prepare_trace(traces, CYLINDER, spikes="replace", **options)
    for each in (kept, replaced):
        np.testing.assert_allclose(each.offsets, sound.offsets, atol=500.0)
    assert replaced.names[1] == "60 spikes replaced"
    np.testing.assert_allclose(replaced.traces.cov(CYLINDER), sound.traces.cov(CYLINDER), rtol=0.01)
    assert kept.traces.cov(CYLINDER) > 1.1 * sound.traces.cov(CYLINDER)
    before, after = (each.cycle.torque_harmonics(CYLINDER, 12) for each in (sound, replaced))
    np.testing.assert_allclose(after, before, rtol=2e-2)


def test_slices_and_cycles_left_out_are_traces() -> None:
    traces = measured(3)
    assert traces[:10] == cp.Traces(THETA, traces.pressure[:10])
    assert traces[::-1].pressure[0, 0] == traces.pressure[-1, 0]
    assert traces.without_cycles([0, -1]) == cp.Traces(THETA, traces.pressure[1:-1])
    assert traces.without_cycles(int(np.int64(3))) == traces.without_cycles([3])
    for call, message in (
        (lambda: traces[60:], "one cycle must stay"),
        (lambda: traces.without_cycles(range(60)), "one cycle must stay"),
        (lambda: traces.without_cycles([60]), "cycles = 60: give an index from 0 to 59"),
        (lambda: traces[60], "index = 60: give an index from 0 to 59"),
        (lambda: cp.prepare_trace(traces, CYLINDER, leave_out=[61]), "leave_out = 61: give"),
        (lambda: cp.prepare_trace(traces, CYLINDER, leave_out="all"), "leave_out = 'all': give"),  # type: ignore[arg-type]
        (lambda: cp.prepare_trace(traces, CYLINDER, spikes="cut"), "spikes = 'cut': give"),  # type: ignore[arg-type]
    ):
        with pytest.raises(cp.InputError, match=message):
            call()
    prepared = cp.prepare_trace(traces, CYLINDER, leave_out=[3, 7])
    assert prepared.names == ("as measured, without cycles 3, 7",)
    assert prepared.imep().shape == (1, 58)


@pytest.mark.parametrize("start", [-720.0, -360.0, 0.0, 300.0])
def test_angles_of_peaks_are_in_one_turn_of_the_cycle(start: float) -> None:
    theta = start + np.arange(0.0, 720.0, 0.5)
    rows = cp.Cycle.example().pressure_at(theta) * np.linspace(0.95, 1.05, 9)[:, None]
    traces = cp.Traces(theta, rows)
    np.testing.assert_allclose(traces.peaks_deg, 14.0)
    assert traces.spread(CYLINDER)["mean"].values[1] == 14.0
    assert "at 14°" in traces.mean_cycle.table.title
    # About the opposite dead centre they are not torn apart.
    with pytest.warns(UserWarning, match=r"peaks at -?\d+°, far from the firing") as caught:
        far = cp.Traces(theta + 346.0, rows)
    assert len(caught) == 1
    assert np.ptp(far.peaks_deg) == 0.0
    assert abs(abs(far.peaks_deg[0]) - 360.0) < 1e-9


@pytest.mark.parametrize("shift", [90.0, 200.0, -150.0])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("options", [{"lowpass_order": 60}, {"intake_pressure": 0.95e5}], ids=str)
def test_one_wrong_dead_centre_is_warned_of_once(
    shift: float, turned: bool, options: dict[str, Any]
) -> None:
    rows = burnt(2) + 4e4
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        traces = cp.Traces(THETA, rows if turned else np.roll(rows, round(2 * shift), axis=1))
        tdc: dict[str, Any] = {"tdc_deg": shift} if turned else {}
        prepared = cp.prepare_trace(traces, CYLINDER, **tdc, **options)
        assert prepared.table.text()
        assert prepared.imep().shape == (len(prepared.stages), 50)
        if "lowpass_order" in options:  # pressure of the intake elsewhere makes it negative
            prepared.cycle.imep(CYLINDER)
            cp.Engine.preset("i4", cylinder=CYLINDER).with_cycle(prepared.cycle).balance(2000)
    said = [str(each.message) for each in caught]
    if "lowpass_order" in options:
        assert len(said) == 1, said
    assert "far from the firing top dead centre" in said[0]
    assert not any("imep =" in each or "more than an encoder" in each for each in said), said


def test_numbers_that_are_none_are_named_by_cycle_and_angle() -> None:
    rows = burnt(0, 9)
    rows[4, 700] = np.nan
    with pytest.raises(cp.InputError, match=r"pressure has .* first nan in cycle 4 at -10°: give"):
        cp.Traces(THETA, rows)


# Exponent of the gas, heat in J, begin and duration of the burn, degrees, and Wiebe's exponent.
BURNS = [
    (1.33, 1000.0, -15.0, 50.0, 2.0),
    (1.25, 1500.0, -5.0, 60.0, 1.0),
    (1.4, 400.0, 0.0, 30.0, 3.0),
    (1.3, 50.0, -20.0, 70.0, 2.0),
    (1.35, 2000.0, 5.0, 80.0, 1.5),
]


@in_turn("burn", BURNS)
def test_heat_release_is_the_heat_of_the_burn(burn: tuple[float, ...]) -> None:
    gamma, heat, start, duration, m = burn
    cycle = cp.Cycle.wiebe(
        CYLINDER, compression_ratio=10.5, heat=heat, start_deg=start, duration_deg=duration,
        a=6.908, m=m, gamma=gamma,
    )  # fmt: skip
    fine = np.arange(-360.0, 360.0, 0.2)
    traces = cp.Traces(fine, cycle.pressure_at(fine) * np.array([[1.0], [1.0]]))
    theta = np.arange(-60.0, 100.5, 0.5)
    figures: dict[str, Any] = {"compression_ratio": 10.5, "gamma": gamma}
    released = traces.heat_release(CYLINDER, theta, **figures)
    # From the first angle on; and heat adds up over parts of the window, to rounding.
    np.testing.assert_array_equal(released[:, 0], 0.0)
    later = traces.heat_release(CYLINDER, theta[80:], **figures)
    np.testing.assert_allclose(released[:, 80:], released[:, 80:81] + later, atol=1e-9 * heat)
    over = np.clip((theta - start) / duration, 0.0, 1.0)
    burnt = heat * (1.0 - np.exp(-6.908 * over ** (m + 1.0)))
    # Pressure between points of 0.2° where a burn begins and ends with a bend; trapezes of 0.5°.
    np.testing.assert_allclose(released[0], burnt, atol=2e-3 * max(heat, 300.0))
    rate = again.heat_rate(fine, traces.pressure[0], CRANK, 0.086, 10.5, gamma)
    inside = (fine > -60.0 - 1e-9) & (fine < 100.0 + 1e-9)
    summed = np.cumsum(0.5 * 0.2 * (rate[inside][1:] + rate[inside][:-1]))
    np.testing.assert_allclose(released[0, -1], summed[-1], atol=3e-3 * max(heat, 300.0))
    table = traces.heat_spread(CYLINDER, **figures)
    half = start + duration * (np.log(2.0) / 6.908) ** (1.0 / (m + 1.0))
    assert table["figure"].values[2] == "angle of 50 %"
    np.testing.assert_allclose(table["mean"].values[2], half, atol=1.0)
    np.testing.assert_allclose(table["mean"].values[0], heat * (1 - np.exp(-6.908)), rtol=0.02)
    assert table["deviation"].values[0] == 0.0


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"gamma": 1.0}, "gamma = 1"),
        ({"gamma": np.nan}, "gamma = nan"),
        ({"compression_ratio": 1.0}, "compression_ratio = 1"),
        ({"theta_deg": [0.0, -1.0]}, "theta_deg = .* give ascending"),
        ({"theta_deg": [0.0, 721.0]}, "theta_deg has angles over 721°"),
        ({"cylinder": cp.Cylinder(0.043, 0.145, 0.5)}, "bore = None"),
    ],
)
def test_heat_release_of_wrong_figures_is_rejected(changed: Any, message: str) -> None:  # noqa: ANN401
    usual = {"cylinder": CYLINDER, "theta_deg": [-60.0, 100.0], "compression_ratio": 10.5}
    with pytest.raises(cp.InputError, match=message):
        cp.Traces(THETA, MOTORED[None]).heat_release(**usual | changed)
    with pytest.raises(cp.InputError, match=r"window_deg = .* give two angles"):
        cp.Traces(THETA, MOTORED[None]).heat_spread(
            CYLINDER, compression_ratio=10.5, window_deg=(10.0, -10.0)
        )
