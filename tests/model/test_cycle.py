"""Do cycles read tables as they stand, and is their torque that of pressure over the piston?"""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from rederivation import pressure as again
from support import in_turn

if TYPE_CHECKING:
    from numpy.typing import NDArray

CYLINDER = cp.Cylinder(0.043, 0.043 / 0.3, 0.5, bore=0.086)
OFFSET = cp.Cylinder(0.043, 0.15, 0.5, pin_offset=0.012, bore=0.08)
ORDERS = [0.5, 1, 1.5, 2, 6, 12]


def fired(theta_deg: Any) -> Any:
    """Return a smooth pressure of a period of 720°, Pa: a peak of 40 bar at 12°, some 50° wide."""
    wave = np.cos(np.radians((np.asarray(theta_deg) - 12.0) / 2.0))
    return 1e5 + 3.9e6 * np.exp(20.0 * (wave - 1.0))


def sampled(theta_deg: Any, **options: Any) -> cp.Cycle:
    return cp.Cycle(theta_deg, fired(theta_deg), **options)


def expected(
    cylinder: cp.Cylinder, orders: list[float], crankcase: float = 101325.0
) -> tuple[float, NDArray[np.complex128]]:
    crank = (cylinder.crank_radius, cylinder.rod_length, cylinder.pin_offset)
    assert cylinder.bore
    return again.torque_phasors(
        lambda theta: fired(np.degrees(theta)),
        np.radians([0.0, 720.0]),
        np.array(orders),
        cylinder.bore,
        crank,
        crankcase,
    )


@pytest.mark.parametrize("cylinder", [CYLINDER, OFFSET])
@pytest.mark.parametrize("crankcase", [101325.0, 0.0, 3e5])
def test_torque_is_that_of_pressure_over_the_piston(
    cylinder: cp.Cylinder, crankcase: float
) -> None:
    cycle = sampled(np.arange(0.0, 720.0, 0.25))
    mean, phasors = expected(cylinder, ORDERS, crankcase)
    # Cubics through points 0.25° apart of a peak 50° wide: (1/200)⁴ of the largest torque, 400 N·m.
    np.testing.assert_allclose(cycle.mean_torque(cylinder), mean, atol=1e-6)
    found = cycle.torque_harmonics(cylinder, ORDERS, crankcase=crankcase)
    np.testing.assert_allclose(found, phasors, atol=1e-6)
    assert cycle.work(cylinder) == pytest.approx(4 * np.pi * mean, rel=1e-7)


def test_grids_closed_open_shifted_and_uneven_give_one_torque() -> None:
    uneven = np.arange(720) + 0.4 * np.sin(np.arange(720))
    grids = {
        "closed, every 1°": np.linspace(0, 720, 721),
        "open, every 1°": np.arange(720),
        "closed, every 0.5°": np.linspace(-360, 360, 1441),
        "open, steps of 0.6165° to 1.384°": uneven - 200.0,
    }
    _, phasors = expected(CYLINDER, ORDERS)
    for grid, theta in grids.items():
        cycle = sampled(theta)
        assert cycle.grid == grid
        # Steps of 1.4° at most: 256 times those of 0.25° and more.
        np.testing.assert_allclose(cycle.torque_harmonics(CYLINDER, ORDERS), phasors, atol=2e-3)


def test_the_error_estimate_of_a_table_holds_and_follows_its_resolution() -> None:
    _, phasors = expected(CYLINDER, ORDERS)
    before = np.inf
    for count in (90, 180, 360, 720):
        cycle = sampled(np.linspace(0, 720, count, endpoint=False))
        estimate = cycle.resolution_error(CYLINDER, ORDERS)
        error = abs(cycle.torque_harmonics(CYLINDER, ORDERS) - phasors)
        assert (error <= estimate).all()
        assert estimate.max() < before
        before = float(estimate.max())
    # From 180 points to 720: twice a factor of 16, and room for the limited slopes.
    assert before < 0.0466 / 100


def test_a_two_stroke_has_no_half_orders() -> None:
    theta = np.arange(0.0, 360.0, 0.5)
    cycle = cp.Cycle(theta, 1e5 + 3e6 * np.exp(5 * (np.cos(np.radians(theta)) - 1)), strokes=2)
    assert cycle.period_deg == 360.0
    harmonics = cycle.torque_harmonics(CYLINDER, [0.5, 1, 1.5, 2])
    assert (harmonics[[0, 2]] == 0.0).all()
    assert (abs(harmonics[[1, 3]]) > 10.0).all()


def test_pressure_at_takes_any_angle_and_shape() -> None:
    cycle = sampled(np.arange(720))
    theta = np.array([[0.0, 12.0, 733.5], [-360.0, 1e4, 359.25]])
    # Second differences of the fourth order of a peak 50° wide at steps of 1°.
    np.testing.assert_allclose(cycle.pressure_at(theta), fired(theta), rtol=1e-6)
    assert cycle.pressure_at(12.0).shape == ()


def test_cycles_are_values() -> None:
    theta = np.arange(720)
    pressure = fired(theta)
    cycle = cp.Cycle(theta, pressure, name="bench")
    pressure[0] = 0.0
    assert cycle.pressure[0] > 1e5
    assert cycle == pickle.loads(pickle.dumps(cycle))  # noqa: S301 - our own
    assert hash(cycle) == hash(sampled(theta, name="bench"))
    assert cycle != cycle.replace(name="other")
    assert cycle.table["pressure"].values == tuple(cycle.pressure)
    assert repr(cycle).startswith("bench, four-stroke, 720 points (open, every 1°), 40 bar at 12°")


@pytest.mark.parametrize(
    ("theta_deg", "pressure", "message"),
    [
        (np.arange(360), None, r"theta_deg = 359° in all: .*give strokes = 2"),
        (np.radians(np.arange(720)), None, r"theta_deg = .*radians"),
        (np.arange(720)[::-1], None, r"theta_deg\[1\] = 718.0: give ascending angles"),
        (np.arange(720), np.full(719, 1e5), "pressure has 719 entries"),
        (np.arange(720), fired(np.arange(720)) - 3e5, r"pressure\[\d+\] = -.*absolute"),
        (np.arange(721), np.linspace(1e5, 2e5, 721), r"pressure\[720\] = 200000.0: .* closed"),
        (np.arange(720), "high", "pressure = 'high': give numbers"),
        (np.arange(720), np.full(720, np.nan), r"pressure\[0\] = NaN"),
    ],
)
def test_tables_that_are_no_cycle_are_named(theta_deg: Any, pressure: Any, message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.Cycle(theta_deg, fired(theta_deg) if pressure is None else pressure)


@pytest.mark.parametrize(
    ("pressure", "message"),
    [
        (fired(np.arange(720)) / 1e3, "was it given in kPa"),
        (fired(np.arange(720)) / 1e5, "was it given in bar"),
        (fired(np.arange(720)) - 1e5, "is it gauge pressure"),
        (fired(np.arange(720)) * 1e5, "more than any engine's"),
        (fired(np.arange(720)) * 1e3, "more than any engine's"),
    ],
)
def test_other_units_are_warned_of(pressure: Any, message: str) -> None:
    with pytest.warns(UserWarning, match=message):
        cp.Cycle(np.arange(720), pressure)


@pytest.mark.parametrize("count", [16, 17, 225, 719, 720, 1440, 1441])
@pytest.mark.parametrize("closed", [False, True])
def test_any_number_of_points_has_an_error_estimate(count: int, *, closed: bool) -> None:
    theta = np.linspace(0, 720, count + closed, endpoint=closed)
    assert sampled(theta).resolution_error(CYLINDER, [0.5, 6]).max() > 0.0


def test_error_estimates_of_random_tables_hold() -> None:
    random = np.random.default_rng(1)
    _, phasors = expected(CYLINDER, ORDERS)
    for count in random.integers(180, 1440, 60):
        start = random.uniform(-360, 360)
        cycle = sampled(np.linspace(start, start + 720, count, endpoint=False))
        error = abs(cycle.torque_harmonics(CYLINDER, ORDERS) - phasors)
        assert error.max() <= cycle.resolution_error(CYLINDER, ORDERS).max()


@in_turn("seed", range(12))
def test_bounds_of_random_tables_hold_whatever_is_between_points(seed: int) -> None:
    """Pressure between two points that goes from one value to the other in any manner."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(40, 300))
    theta = np.sort(rng.choice(np.arange(720.0), count, replace=False))
    values = rng.uniform(2e6, 3.9e6, count)  # far from smooth, without a peak
    powers = 10.0 ** rng.uniform(-1.0, 1.0, count)
    edges = np.append(theta, theta[0] + 720.0)
    closed = np.append(values, values[0])

    def pressure(angle: Any) -> Any:
        place = (np.degrees(angle) - theta[0]) % 720.0 + theta[0]
        k = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, count - 1)
        share = (place - edges[k]) / (edges[k + 1] - edges[k])
        return closed[k] + (closed[k + 1] - closed[k]) * share ** powers[k]

    mean, phasors = again.torque_phasors(
        pressure, np.radians(edges), np.array(ORDERS), CYLINDER.bore or 0.0,
        (CYLINDER.crank_radius, CYLINDER.rod_length, CYLINDER.pin_offset), 101325.0,
    )  # fmt: skip
    cycle = cp.Cycle(theta, values)
    bound = cycle.resolution_bound(CYLINDER, 1)[0]
    assert (abs(cycle.torque_harmonics(CYLINDER, ORDERS) - phasors) < bound).all()
    assert 2.0 * abs(cycle.mean_torque(CYLINDER) - mean) < bound


def test_bounds_fall_with_the_step_and_are_none_of_polynomials() -> None:
    bounds = [
        sampled(np.arange(0, 720, step)).resolution_bound(CYLINDER, 1)[0] for step in (4, 2, 1)
    ]
    np.testing.assert_allclose(np.divide(bounds[:2], bounds[1:]), 2.0, rtol=0.02)
    assert cp.Cycle.example().resolution_bound(CYLINDER, [0.5, 1]).tolist() == [0.0, 0.0]
    # Closed or open, and with a jump, whose step is none.
    closed = sampled(np.linspace(0, 720, 721)).resolution_bound(CYLINDER, 1)[0]
    np.testing.assert_allclose(closed, bounds[2], rtol=1e-12)
    corners = [0, 90, 180, 180, 360, 540, 540, 630]
    square = cp.Cycle(corners, [2e6] * 3 + [1e6] * 3 + [2e6] * 2)
    assert square.resolution_bound(CYLINDER, 1)[0] < 1e-6  # rounding of pressures that are equal


def test_too_few_points_have_no_error_estimate() -> None:
    with pytest.raises(cp.InputError, match="has 12 points: give 16 or more for an estimate"):
        sampled(np.arange(0, 720, 60)).resolution_error(CYLINDER, 1)


@pytest.mark.parametrize("shift", [360, 90, -90, 200])
def test_a_peak_far_from_firing_tdc_is_warned_of(shift: int) -> None:
    theta = np.arange(720.0)
    with pytest.warns(UserWarning, match=r"theta_deg: pressure peaks at .* tdc_deg"):
        cp.Cycle(theta, fired(theta - shift))


def test_peaks_of_running_engines_are_not_warned_of() -> None:
    """Any phase of the grid, and burns from early to late, at full load or motored."""
    random = np.random.default_rng(2)
    for _ in range(100):
        start = random.uniform(-1000, 1000)
        theta = np.arange(720.0) + start
        late, load = random.uniform(-5, 30), random.uniform(0.2, 1)
        compression = 2e6 * np.exp(-((((theta + 360) % 720 - 360) / 35) ** 2))
        cp.Cycle(theta, 1e5 + compression + load * (fired(theta - late) - 1e5))
    flat = np.full(720, 101325.0)
    cp.Cycle(np.arange(720), flat)


def test_noise_below_zero_is_warned_of_and_counted_as_it_is() -> None:
    theta = np.arange(720.0)
    noise = np.random.default_rng(3).normal(0.0, 4e4, 720)
    with pytest.warns(UserWarning, match="which noise or an offset of the sensor does"):
        noisy = cp.Cycle(theta, fired(theta) + noise)
    found = noisy.torque_harmonics(CYLINDER, ORDERS) - sampled(theta).torque_harmonics(
        CYLINDER, ORDERS
    )
    # Linear but for limited slopes: the noise's own harmonics, below 4e4 Pa · area · radius / √720.
    assert abs(found).max() < 4 * 4e4 * 5.8e-3 * 0.043 / np.sqrt(720) * 2


def test_work_taken_from_the_crank_is_warned_of() -> None:
    theta = np.arange(720.0)
    backward = cp.Cycle(theta, fired(-theta))
    with pytest.warns(UserWarning, match=r"imep = -.* bar: pressure brakes the crank"):
        backward.imep(CYLINDER)
    i4 = cp.Engine.preset("i4", cylinder=CYLINDER)
    with pytest.warns(UserWarning, match="pressure brakes the crank"):
        fired_engine = i4.with_cycle(backward)
    with pytest.warns(UserWarning, match="pressure brakes the crank"):
        cp.Engine.from_toml(fired_engine.to_toml())
    motored = cp.Cycle.wiebe(
        CYLINDER, compression_ratio=16, heat=0, wall_temperature=400, rpm=1000, intake_pressure=3e5
    )
    assert motored.imep(CYLINDER) < 0.0
    i4.with_cycle(motored)


def test_a_crankcase_in_other_units_is_warned_of() -> None:
    cycle = sampled(np.arange(720))
    i4 = cp.Engine.preset("i4", cylinder=CYLINDER)
    for pressure in (1.01325, 101.325, 1e10):
        with pytest.warns(UserWarning, match="Pressures are Pa here"):
            i4.with_cycle(cycle, crankcase=pressure)
        with pytest.warns(UserWarning, match="Pressures are Pa here"):
            cycle.torque_harmonics(CYLINDER, 1, crankcase=pressure)


def test_torque_needs_a_bore_and_says_so() -> None:
    cycle = sampled(np.arange(720))
    with pytest.raises(cp.InputError, match=r"bore = None: .*cylinder\.replace\(bore="):
        cycle.mean_torque(cp.Cylinder(0.043, 0.145, 0.5))
    with pytest.raises(cp.InputError, match=r"cylinder = 0\.086: give a crankpin.Cylinder"):
        cycle.imep(0.086)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"orders = 0\.3"):
        cycle.torque_harmonics(CYLINDER, 0.3)


def test_travel_is_the_distance_of_the_piston_s_ends() -> None:
    theta = np.radians(np.linspace(0, 360, 200_001))
    x = again.height(theta, 0.043, 0.15, 0.012)
    # Between samples 3e-5 apart a maximum is missed by 1e-10 of its curvature.
    assert pytest.approx(np.ptp(x), rel=1e-9) == OFFSET.travel
    assert CYLINDER.travel == CYLINDER.stroke
