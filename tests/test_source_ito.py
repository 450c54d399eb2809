"""Does the library give Ito and Hattori's V-14 cases: pure precession at first order, and the rest?

The paper has x along the bisector, levers s = 3 ... -3 from the front, and phase numbers k that run
ahead by 2 pi (k - 1)/7. Here top dead centres are -(k - 1) 360/7 degrees, z = -s, the first bank
stands at 90 - alpha/2 and the second at 90 + alpha/2: the paper's pitch M_y is our pitch M_x, its
yaw M_x is our yaw M_y with the other sign. Moments are in units of M_0 = m r s omega^2.
"""

from __future__ import annotations

import csv
from pathlib import Path

import crankpin as cp
import numpy as np
import pytest
from numpy.typing import NDArray
from rederivation import ito

Array = NDArray[np.float64]
Row = dict[str, str]

RPM = 3000.0
ROD_RATIO = 0.3
SPACING = 0.25  # m, the paper's s
CYLINDER = cp.Cylinder(crank_radius=0.06, rod_length=0.2, reciprocating_mass=2.0)
MASS_RADIUS = CYLINDER.reciprocating_mass * CYLINDER.crank_radius
M_0 = MASS_RADIUS * SPACING * (2.0 * np.pi * RPM / 60.0) ** 2
AS_THE_PAPER = {1: MASS_RADIUS, 2: MASS_RADIUS * ROD_RATIO}  # a_2 = lambda, kg m
THETA = np.arange(0.0, 720.0, 3.0)

# Fourteen terms of up to 3, each rounded to 1.1e-16.
ROUNDING = 2e-14


def read_cases() -> list[Row]:
    """The worked cases."""
    path = Path(__file__).parent / "data" / "ito_cases.csv"
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


CASES = read_cases()
each_case = pytest.mark.parametrize("row", CASES, ids=lambda row: row["bank_angle_deg"])


def printed(row: Row, column: str) -> object:
    """A printed figure, to half a unit of its last digit."""
    return pytest.approx(float(row[column]), abs=half_digit(row[column]))


def half_digit(text: str) -> float:
    """Half a unit of the last printed digit, and a millionth of it for rounding in reading it."""
    return 0.5000005 * 10.0 ** -len(text.split(".")[1])


def arrangement(row: Row, bank: str) -> list[int]:
    """Phase numbers of one bank, front to rear."""
    return [int(k) for k in row[bank].split("-")]


def tdc_deg(phases: list[int]) -> list[str]:
    """Top dead centres, exact: sevenths of a turn as text."""
    return [f"{-(k - 1) * 360}/7" for k in phases]


def bank(phases: list[int], direction_deg: float = 90.0) -> cp.Engine:
    """One bank as an engine of its own."""
    return cp.Engine.from_lists(
        CYLINDER,
        tdc_deg=tdc_deg(phases),
        bank_deg=[direction_deg] * 7,
        z=-SPACING * ito.LEVERS,
    )


def angle_deg(row: Row) -> float:
    """V-angle, signed, degrees, to full accuracy."""
    return ito.precession(arrangement(row, "first_bank"), arrangement(row, "second_bank"))[0]


def v14(row: Row, bank_angle_deg: float | None = None) -> cp.Engine:
    """The engine of a worked case, at its own V-angle or another."""
    half = (angle_deg(row) if bank_angle_deg is None else bank_angle_deg) / 2.0
    one, two = arrangement(row, "first_bank"), arrangement(row, "second_bank")
    return cp.Engine.from_lists(
        CYLINDER,
        tdc_deg=tdc_deg(one) + tdc_deg(two),
        bank_deg=[90.0 - half] * 7 + [90.0 + half] * 7,
        z=np.tile(-SPACING * ito.LEVERS, 2),
    )


@each_case
def test_sevenths_of_a_turn_are_exact(row: Row) -> None:
    """No force is left at any order below seven, and none is reported."""
    engine = v14(row)
    assert not engine.balance(RPM, [1, 2, 4, 6]).force.any()
    assert engine == v14(row).replace(tdc_deg=[float(tdc) for tdc in engine.tdc_deg])


@each_case
def test_v_angle_as_printed(row: Row) -> None:
    angle = v14(row).bank_angle_deg
    assert angle == pytest.approx(abs(angle_deg(row)), rel=ROUNDING)
    assert angle == printed(row, "bank_angle_deg")


@each_case
def test_bank_coefficients(row: Row) -> None:
    """Bank moment a_1 cos theta + a_2 sin theta: our pitch phasor is a_1 - i a_2."""
    found = []
    for name in ("first_bank", "second_bank"):
        pitch, yaw = bank(arrangement(row, name)).balance(RPM, 1).order(1).moment / M_0
        assert yaw == 0
        found += [pitch.real, -pitch.imag]
        expected = ito.bank_coefficients(arrangement(row, name))
        np.testing.assert_allclose(found[-2:], expected, rtol=0, atol=ROUNDING)
    for value, column in zip(found, ("a1", "a2", "b1", "b2"), strict=True):
        if row[column]:
            assert value == printed(row, column)


@each_case
def test_first_order_precesses_with_the_crank(row: Row) -> None:
    first = v14(row).balance(RPM, 1)
    assert first.backward_moment[0] == 0
    assert first.moment_ellipse.minor == first.moment_ellipse.major
    amplitude = abs(first.forward_moment[0]) / M_0
    assert amplitude == printed(row, "amplitude")
    expected = ito.precession(arrangement(row, "first_bank"), arrangement(row, "second_bank"))
    assert amplitude == pytest.approx(expected.amplitude, rel=ROUNDING)
    # M_y = M cos(theta + theta_0), M_x = -M sin(theta + theta_0): forward is M exp(i theta_0).
    phase = np.rad2deg(np.angle(first.forward_moment[0]))
    assert phase == pytest.approx(expected.phase_deg, rel=ROUNDING)
    if row["phase_deg"]:
        assert phase == printed(row, "phase_deg")


@each_case
def test_at_other_angles_part_of_it_turns_backward(row: Row) -> None:
    angle = angle_deg(row)
    for off in (-5.0, 5.0):
        wrong = v14(row, angle + off).balance(RPM, 1)
        z = complex(ito.bank_sum(arrangement(row, "first_bank")))
        # |Z| |1 - exp(i off)| / 2.
        expected = abs(z) * np.sin(np.deg2rad(abs(off)) / 2.0)
        assert abs(wrong.backward_moment[0]) / M_0 == pytest.approx(expected, rel=1e-12)


@each_case
def test_a_sweep_that_holds_the_firing_finds_the_angle(row: Row) -> None:
    """From an engine made at another angle; the paper's condition depends on no pin."""
    angle = abs(angle_deg(row))
    angles = np.array([angle - 1.0, angle, angle + 1.0])
    start = v14(row, np.sign(angle_deg(row)) * 77.0)
    s = cp.sweep(start, rpm=RPM, bank_angle_deg=angles, hold="firing", orders=[1])
    pitch, yaw = s.moment[:, 0, 0], s.moment[:, 0, 1]
    backward = np.abs(pitch - 1j * yaw) / 2.0 / M_0
    assert backward[1] < ROUNDING
    assert backward[0] > 1e-3 < backward[2]


@each_case
def test_second_order_in_units_of_rod_ratio_times_m_0(row: Row) -> None:
    b = v14(row).balance(RPM, 2, spectrum=AS_THE_PAPER)
    left = b.moment_peak_xy[0] / (ROD_RATIO * M_0)
    expected = ito.precession(arrangement(row, "first_bank"), arrangement(row, "second_bank"))
    np.testing.assert_allclose(left, expected[3:], rtol=0, atol=ROUNDING)
    if row["second_order_pitch"]:
        assert left[0] == printed(row, "second_order_pitch")
        assert left[1] == printed(row, "second_order_yaw")


def test_pitch_and_yaw_change_places_at_the_supplement() -> None:
    narrow, wide = (
        v14(row).balance(RPM, 2, spectrum=AS_THE_PAPER).moment_peak_xy[0] for row in CASES[2:]
    )
    np.testing.assert_allclose(narrow, wide[::-1], rtol=1e-12)  # angles from an arctangent each


def test_the_paper_and_the_exact_second_order_differ_by_two_per_cent() -> None:
    row = CASES[0]
    (a2,) = cp.slider_crank_harmonics(ROD_RATIO, 2)
    paper = v14(row).balance(RPM, 2, spectrum=AS_THE_PAPER).moment
    exact = v14(row).balance(RPM, 2).moment
    np.testing.assert_allclose(exact, paper * a2 / ROD_RATIO, rtol=ROUNDING)
    assert a2 / ROD_RATIO == pytest.approx(1.0235, abs=5e-5)


@each_case
def test_waveform_of_exact_kinematics(row: Row) -> None:
    """The paper's equations (3) and (5) in the time domain, its lost square restored."""
    longer = CYLINDER.replace(rod_length=CYLINDER.crank_radius / ROD_RATIO)
    engine = v14(row).replace(cylinder=longer)
    found = engine.waveform(RPM, THETA).moment / M_0
    pitch, yaw = ito.engine_moment(
        arrangement(row, "first_bank"),
        arrangement(row, "second_bank"),
        np.deg2rad(angle_deg(row)),
        np.deg2rad(THETA),
        ROD_RATIO,
    )
    # Angles of up to 6 pi in radians there: their last bit is 3.6e-15, times fourteen forces on
    # levers of 24 altogether that change by up to 2.3 a radian.
    np.testing.assert_allclose(found, np.stack([pitch, -yaw], axis=1), rtol=0, atol=2e-13)


@each_case
def test_first_order_waveform_is_a_circle(row: Row) -> None:
    w = v14(row).waveform(RPM, THETA, [1])
    length = np.hypot(*w.moment.T) / M_0
    assert length[0] == printed(row, "amplitude")
    assert np.ptp(length) < ROUNDING


def test_amplitude_of_each_bank_is_the_same() -> None:
    """|Z_1| = |Z_2| is what makes an angle exist."""
    for row in CASES:
        one, two = (
            bank(arrangement(row, name)).balance(RPM, 1).moment_peak_vector[0]
            for name in ("first_bank", "second_bank")
        )
        assert one == pytest.approx(two, rel=ROUNDING)
