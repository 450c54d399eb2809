"""Do computed cycles conserve energy, and are they those of the equations solved by SciPy?"""

from __future__ import annotations

from typing import Any, Literal

import crankpin as cp
import numpy as np
import pytest
from rederivation import pressure as again

CYLINDER = cp.Cylinder(0.043, 0.043 / 0.3, 0.5, bore=0.086)
OFFSET = cp.Cylinder(0.043, 0.15, 0.5, pin_offset=0.012, bore=0.08)
both = pytest.mark.parametrize("cylinder", [CYLINDER, OFFSET], ids=["centred", "offset"])
WIEBE = {
    "heat": 1200.0,
    "start_deg": -12.0,
    "duration_deg": 55.0,
    "a": 5.0,
    "m": 1.7,
    "gamma": 1.32,
    "intake_pressure": 0.9e5,
    "charge_temperature": 340.0,
    "intake_closes_deg": -145.0,
    "exhaust_opens_deg": 125.0,
}


def crank(cylinder: cp.Cylinder) -> tuple[float, float, float]:
    return cylinder.crank_radius, cylinder.rod_length, cylinder.pin_offset


def displacement(cylinder: cp.Cylinder) -> float:
    assert cylinder.bore
    return np.pi / 4 * cylinder.bore**2 * cylinder.travel


def test_the_otto_cycle_of_the_textbook() -> None:
    """Bore 86, r 43, λ 0.3, compression 10, n 1.3, p₀ 1 bar, p₃/p₂ 3.5."""
    otto = cp.Cycle.otto(CYLINDER, compression_ratio=10, pressure_ratio=3.5, intake_pressure=1e5)
    assert round(otto.imep(CYLINDER) / 1e5, 6) == 9.215392
    assert round(otto.mean_torque(CYLINDER), 5) == 36.63441


@both
@pytest.mark.parametrize("strokes", [2, 4])
@pytest.mark.parametrize(("pressure_ratio", "cutoff_ratio"), [(3.5, 1.0), (1.0, 2.2), (1.6, 1.8)])
def test_work_is_the_area_of_the_corners(
    cylinder: cp.Cylinder, strokes: int, pressure_ratio: float, cutoff_ratio: float
) -> None:
    cycle = cp.Cycle.dual(
        cylinder,
        compression_ratio=14,
        pressure_ratio=pressure_ratio,
        cutoff_ratio=cutoff_ratio,
        compression_exponent=1.35,
        expansion_exponent=1.28,
        intake_pressure=1.5e5,
        exhaust_pressure=1.2e5,
        strokes=strokes,
    )
    pressures, exponents = (1.5e5, 1.2e5), (1.35, 1.28)
    ratios = (14, pressure_ratio, cutoff_ratio)
    work = again.dual_work(displacement(cylinder), *ratios, exponents, pressures, strokes)
    # Polynomials to 2e-14 of pressures ten times the mean effective one.
    assert cycle.work(cylinder) == pytest.approx(work, rel=1e-12)


@both
def test_otto_and_diesel_are_ends_of_the_dual_cycle(cylinder: cp.Cylinder) -> None:
    options: Any = {"compression_ratio": 12, "name": "one"}
    otto = cp.Cycle.otto(cylinder, pressure_ratio=2, **options)
    diesel = cp.Cycle.diesel(cylinder, cutoff_ratio=2, **options)
    assert otto == cp.Cycle.dual(cylinder, pressure_ratio=2, cutoff_ratio=1, **options)
    assert diesel == cp.Cycle.dual(cylinder, pressure_ratio=1, cutoff_ratio=2, **options)
    theta = np.linspace(5.0, 170.0, 40)  # the piston is highest at 3.6° with the offset
    volume = again.chamber(np.radians(theta), 12, crank(cylinder))
    expansion = 101325.0 * 12**1.3 * 2 / volume**1.3
    np.testing.assert_allclose(otto.pressure_at(theta), expansion, rtol=1e-12)


@both
@pytest.mark.parametrize("strokes", [2, 4])
def test_motored_compression_does_no_work(cylinder: cp.Cylinder, strokes: int) -> None:
    cycle = cp.Cycle.motored(
        cylinder,
        compression_ratio=17,
        compression_exponent=1.4,
        expansion_exponent=1.4,
        strokes=strokes,
    )
    # Of 600 J that go in and come out: roundings.
    assert abs(cycle.work(cylinder)) < 1e-10
    assert cycle.pressure.max() == pytest.approx(101325 * 17**1.4, rel=1e-12)


@both
@pytest.mark.parametrize("wall", [{}, {"wall_temperature": 430.0, "rpm": 2500.0}])
def test_the_wiebe_cycle_is_that_of_solve_ivp(
    cylinder: cp.Cylinder, wall: dict[str, float]
) -> None:
    figures = {"compression_ratio": 9.5, **WIEBE, **wall}
    cycle = cp.Cycle.wiebe(cylinder, **figures)  # type: ignore[arg-type]
    assert cylinder.bore
    pressure, burnt, lost = again.wiebe(figures, crank(cylinder), cylinder.bore)
    theta = np.linspace(-144.9, 124.9, 300)
    # solve_ivp at rtol 1e-12, some hundred steps; with wall loss it crosses a kink of the
    # correlation, where p passes the motored pressure.
    tolerance = 1e-7 if wall else 1e-9
    np.testing.assert_allclose(
        cycle.pressure_at(theta), pressure(np.radians(theta)), rtol=tolerance
    )
    assert burnt == pytest.approx(1200 * (1 - np.exp(-5)), rel=1e-9)
    assert (lost > 50) == bool(wall)
    # First law of the closed part: p·V/(γ − 1) changes by heat less work.
    ends = np.radians([-145.0, 125.0])
    volume = displacement(cylinder) / 8.5 * again.chamber(ends, 9.5, crank(cylinder))
    energy = np.diff(cycle.pressure_at([-145.0, 125.0 - 1e-9]) * volume) / 0.32
    nodes, weights = np.polynomial.legendre.leggauss(400)
    angles = 0.5 * (ends[1] - ends[0]) * nodes + 0.5 * (ends[1] + ends[0])
    rate = -np.pi / 4 * cylinder.bore**2 * again.slope(angles, *crank(cylinder))
    work = (weights * cycle.pressure_at(np.degrees(angles)) * rate).sum() * np.ptp(ends) / 2
    # 400 nodes across the bends of pressure: 1e-5 of the heat.
    assert energy[0] + work == pytest.approx(burnt - lost, rel=2e-5)


def test_heat_of_fuel_follows_from_the_air() -> None:
    options = {"compression_ratio": 10.0, "intake_closes_deg": -180.0, "charge_temperature": 300.0}
    air = 101325 * displacement(CYLINDER) * 10 / 9 / (287.05 * 300)
    by_air = cp.Cycle.wiebe(CYLINDER, excess_air=1.25, name="x", **options)  # type: ignore[arg-type]
    heat = air / (1.25 * 14.6) * 43e6
    by_heat = cp.Cycle.wiebe(CYLINDER, heat=heat, name="x", **options)  # type: ignore[arg-type]
    np.testing.assert_allclose(by_air.pressure, by_heat.pressure, rtol=1e-12)


def test_harmonics_of_an_ideal_cycle_are_those_of_quadrature_and_fall_as_1_over_n_squared() -> None:
    otto = cp.Cycle.otto(CYLINDER, compression_ratio=10, pressure_ratio=3.5)
    orders = [0.5, 1, 1.5, 12, 100.5]
    assert CYLINDER.bore
    mean, phasors = again.torque_phasors(
        lambda theta: otto.pressure_at(np.degrees(theta)),
        np.radians([0.0, 180.0, 360.0, 540.0, 720.0]),
        np.array(orders),
        CYLINDER.bore,
        crank(CYLINDER),
        101325.0,
    )
    np.testing.assert_allclose(otto.torque_harmonics(CYLINDER, orders), phasors, atol=1e-10)
    assert otto.mean_torque(CYLINDER) == pytest.approx(mean, rel=1e-12)
    high = abs(otto.torque_harmonics(CYLINDER, [500, 1000]))
    # Jumps in the dead centres leave bends of the torque, Δp·A·r·(1 ± λ), which add up at even
    # orders, and 1/k² of them.
    jumps = 2.5 * 101325 * (10**1.3 * 1.3 + 0.7)
    bend = jumps * np.pi / 4 * 0.086**2 * 0.043 / (2 * np.pi)
    np.testing.assert_allclose(high, bend / np.array([500.0, 1000.0]) ** 2, rtol=1e-3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"compression_ratio": 1.0}, r"compression_ratio = 1\.0"),
        ({"heat": None}, "excess_air = None: give one of heat=…, excess"),
        ({"excess_air": 1.0}, "excess_air = 1.0: give one"),
        ({"rpm": 3000}, "rpm = 3000: heat loss needs both it and wall_temperature"),
        ({"start_deg": 200}, r"start_deg = 200\.0: give a number from"),
        ({"gamma": 3}, r"gamma = 3\.0"),
        ({"m": -0.5}, r"m = -0\.5"),
        ({"intake_closes_deg": 220}, r"intake_closes_deg = 220\.0"),
        ({"intake_pressure": -1}, r"intake_pressure = -1\.0: give absolute"),
        ({"heat": "1 kJ"}, "heat = '1 kJ': give a number"),
        ({"heat": 1e300}, "heat = 1e300|heat = 1.0*e300"),
    ],
)
def test_figures_of_no_engine_are_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.Cycle.wiebe(CYLINDER, **{"compression_ratio": 10, "heat": 1000} | changes)


@pytest.mark.filterwarnings("ignore:pressure is as much as")  # a megajoule in half a litre
@pytest.mark.parametrize("heat", [1e-3, 1e6, 1e20])
@pytest.mark.parametrize("m", [0.0, 0.3, 20.0])
@pytest.mark.parametrize("duration", [0.1, 360.0])
def test_extreme_burns_end_with_a_cycle_or_an_error(heat: float, m: float, duration: float) -> None:
    try:
        cycle = cp.Cycle.wiebe(
            CYLINDER,
            compression_ratio=10,
            heat=heat,
            m=m,
            duration_deg=duration,
            wall_temperature=400,
            rpm=1,
        )
    except cp.InputError:
        return
    assert np.isfinite(cycle.work(CYLINDER))


def test_examples_are_engines_of_their_kind() -> None:
    petrol, diesel = cp.Cycle.example(), cp.Cycle.example("diesel")
    assert cp.Cycle.example("petrol") == petrol != diesel
    # Full load: 10 to 13 bar at 50 to 80 bar peak; turbocharged 13 to 18 bar at 90 to 160.
    assert 10e5 < petrol.imep(CYLINDER) < 13e5
    assert 50e5 < petrol.pressure.max() < 80e5
    assert 13e5 < diesel.imep(CYLINDER) < 18e5
    assert 90e5 < diesel.pressure.max() < 160e5
    assert petrol.name == "example petrol, full load"
    with pytest.raises(cp.InputError, match='kind = \'gas\': give "petrol" or "diesel"'):
        cp.Cycle.example("gas")  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["petrol", "diesel"])
@pytest.mark.parametrize("strokes", [4, 2])
def test_examples_at_part_load_have_the_pressure_that_load_says(
    kind: Literal["petrol", "diesel"], strokes: int
) -> None:
    """Imep is linear in load, from that of friction; peak, and nothing else, tells them apart."""
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    full = cp.Cycle.example(kind, strokes=strokes)
    loads = [0.0, 0.1, 0.37, 0.999]
    cycles = [cp.Cycle.example(kind, load=load, strokes=strokes) for load in loads]
    expected = [1.2e5 + load * (full.imep(cylinder) - 1.2e5) for load in loads]
    # The search ends at 1e-10.
    np.testing.assert_allclose([each.imep(cylinder) for each in cycles], expected, rtol=1e-9)
    peaks = [float(each.pressure.max()) for each in (*cycles, full)]
    assert peaks == sorted(peaks)
    assert [each.name.partition(", ")[2] for each in (*cycles, full)] == [
        "idling", "10 % load", "37 % load", "99.9 % load", "full load"
    ]  # fmt: skip
    for each in (*cycles, full):
        assert each.origin.startswith("Computed, not measured: Wiebe cycle, in SI units bore 0.086")
        assert each.origin in repr(each)
    assert len({each.origin for each in (*cycles, full)}) == 5
    for wrong in (-0.1, 1.01, float("nan")):
        with pytest.raises(cp.InputError, match=r"load = .*: give a part of full load"):
            cp.Cycle.example(kind, load=wrong)
