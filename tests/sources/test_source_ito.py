"""Does the library give Ito and Hattori's V-14 cases: pure precession at first order, and the rest?

The paper has x along the bisector, levers s = 3 ... -3 from the front, and phase numbers k that run
ahead by 2 pi (k - 1)/7. Here top dead centres are -(k - 1) 360/7 degrees, z = -s, the first bank
stands at 90 - alpha/2 and the second at 90 + alpha/2: the paper's pitch M_y is our pitch M_x, its
yaw M_x is our yaw M_y with the other sign. Moments are in units of M_0 = m r s omega^2.
"""

from __future__ import annotations

import csv

import crankpin as cp
import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray
from rederivation import ito
from support import DATA

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
    path = DATA / "ito_cases.csv"
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
        CYLINDER, tdc_deg=tdc_deg(phases), bank_deg=[direction_deg] * 7, z=-SPACING * ito.LEVERS
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
    assert not engine.balance(RPM, orders=[1, 2, 4, 6]).force.any()
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
        pitch, yaw = bank(arrangement(row, name)).balance(RPM, orders=1)[1].moment / M_0
        assert yaw == 0
        found += [pitch.real, -pitch.imag]
        expected = ito.bank_coefficients(arrangement(row, name))
        np.testing.assert_allclose(found[-2:], expected, rtol=0, atol=ROUNDING)
    for value, column in zip(found, ("a1", "a2", "b1", "b2"), strict=True):
        if row[column]:
            assert value == printed(row, column)


@each_case
def test_first_order_precesses_with_the_crank(row: Row) -> None:
    first = v14(row).balance(RPM, orders=1)
    assert first.moment.backward[0] == 0
    assert first.moment.minor == first.moment.peak
    amplitude = abs(first.moment.forward[0]) / M_0
    assert amplitude == printed(row, "amplitude")
    expected = ito.precession(arrangement(row, "first_bank"), arrangement(row, "second_bank"))
    assert amplitude == pytest.approx(expected.amplitude, rel=ROUNDING)
    # M_y = M cos(theta + theta_0), M_x = -M sin(theta + theta_0): forward is M exp(i theta_0).
    phase = np.rad2deg(np.angle(first.moment.forward[0]))
    assert phase == pytest.approx(expected.phase_deg, rel=ROUNDING)
    if row["phase_deg"]:
        assert phase == printed(row, "phase_deg")


@each_case
def test_at_other_angles_part_of_it_turns_backward(row: Row) -> None:
    angle = angle_deg(row)
    for off in (-5.0, 5.0):
        wrong = v14(row, angle + off).balance(RPM, orders=1)
        z = complex(ito.bank_sum(arrangement(row, "first_bank")))
        # |Z| |1 - exp(i off)| / 2.
        expected = abs(z) * np.sin(np.deg2rad(abs(off)) / 2.0)
        assert abs(wrong.moment.backward[0]) / M_0 == pytest.approx(expected, rel=1e-12)


@each_case
def test_a_sweep_that_holds_the_firing_finds_the_angle(row: Row) -> None:
    """From an engine made at another angle; the paper's condition depends on no pin."""
    angle = abs(angle_deg(row))
    angles = np.array([angle - 1.0, angle, angle + 1.0])
    start = v14(row, np.sign(angle_deg(row)) * 77.0)
    s = cp.sweep(start, rpm=RPM, bank_angle_deg=angles, hold="firing", orders=[1])
    pitch, yaw = s.moment.xy[:, 0, 0], s.moment.xy[:, 0, 1]
    backward = np.abs(pitch - 1j * yaw) / 2.0 / M_0
    assert backward[1] < ROUNDING
    assert backward[0] > 1e-3 < backward[2]


@each_case
def test_second_order_in_units_of_rod_ratio_times_m_0(row: Row) -> None:
    b = v14(row).balance(RPM, orders=2, spectrum=AS_THE_PAPER)
    left = b.moment.peak_xy[0] / (ROD_RATIO * M_0)
    expected = ito.precession(arrangement(row, "first_bank"), arrangement(row, "second_bank"))
    np.testing.assert_allclose(left, expected[3:], rtol=0, atol=ROUNDING)
    if row["second_order_pitch"]:
        assert left[0] == printed(row, "second_order_pitch")
        assert left[1] == printed(row, "second_order_yaw")


def test_pitch_and_yaw_change_places_at_the_supplement() -> None:
    narrow, wide = (
        v14(row).balance(RPM, orders=2, spectrum=AS_THE_PAPER).moment.peak_xy[0]
        for row in CASES[2:]
    )
    np.testing.assert_allclose(narrow, wide[::-1], rtol=1e-12)  # angles from an arctangent each


def test_the_paper_and_the_exact_second_order_differ_by_two_per_cent() -> None:
    row = CASES[0]
    (a2,) = cp.slider_crank_harmonics(ROD_RATIO, 2)
    paper = v14(row).balance(RPM, orders=2, spectrum=AS_THE_PAPER).moment
    exact = v14(row).balance(RPM, orders=2).moment
    np.testing.assert_allclose(exact, paper * a2 / ROD_RATIO, rtol=ROUNDING)
    assert a2 / ROD_RATIO == pytest.approx(1.0235, abs=5e-5)


@each_case
def test_waveform_of_exact_kinematics(row: Row) -> None:
    """The paper's equations (3) and (5) in the time domain, its lost square restored."""
    longer = CYLINDER.replace(rod_length=CYLINDER.crank_radius / ROD_RATIO)
    engine = v14(row).replace(cylinder=longer)
    found = engine.waveform(RPM, theta_deg=THETA).moment / M_0
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
    w = v14(row).waveform(RPM, theta_deg=THETA, orders=[1])
    length = np.hypot(*w.moment.T) / M_0
    assert length[0] == printed(row, "amplitude")
    assert np.ptp(length) < ROUNDING


def test_amplitude_of_each_bank_is_the_same() -> None:
    """|Z_1| = |Z_2| is what makes an angle exist."""
    for row in CASES:
        one, two = (
            bank(arrangement(row, name)).balance(RPM, orders=1).moment.peak[0]
            for name in ("first_bank", "second_bank")
        )
        assert one == pytest.approx(two, rel=ROUNDING)


# --- what comparing computed magnitudes finds -----------------------------------------------------

EXACT = 12_936
ARRANGEMENTS = ito.arrangements()


def pairs(formula: str, dtype: type, digits: int | None, tolerance: float) -> int:
    """Pairs of the 504 arrangements whose computed |Z|^2 are equal within a tolerance."""
    return ito.pairs_within(ito.squared_magnitudes(ARRANGEMENTS, formula, dtype, digits), tolerance)


def test_cosines_that_the_counts_rest_on_are_rounded_once() -> None:
    """The counts below depend on the last bit of these: they are the nearest doubles."""
    cos, sin = ito.constants(np.float64)
    with mpmath.workprec(200):
        for k, turn in enumerate(2.0 * np.pi * j / 7 for j in range(7)):
            assert float(mpmath.cos(turn)) == cos[k]
            assert float(mpmath.sin(turn)) == sin[k]


@pytest.mark.parametrize(
    ("formula", "dtype", "digits", "tolerance", "count"),
    [
        # == tears equal magnitudes apart
        ("equation (6)", np.float64, None, 0.0, 2_544),
        ("term by term", np.float64, None, 0.0, 2_526),
        ("equation (6)", np.float32, None, 0.0, 3_384),
        ("equation (6)", np.float64, 6, 0.0, 1_992),
        ("equation (6)", np.float64, 4, 0.0, 1_992),
        # a tolerance within rounding: some
        ("equation (6)", np.float64, None, 1e-15, 4_072),
        ("equation (6)", np.float64, None, 1e-14, 11_776),
        ("equation (6)", np.float32, None, 1e-6, 7_640),
        ("equation (6)", np.float64, 6, 1e-5, 6_600),
        ("equation (6)", np.float64, 4, 1e-3, 8_072),
        # above rounding, below the least difference of two magnitudes: all
        ("equation (6)", np.float64, None, 1e-13, EXACT),
        ("equation (6)", np.float64, None, 1e-1, EXACT),
        ("equation (6)", np.float32, None, 1e-5, EXACT),
        ("equation (6)", np.float64, 6, 1e-4, EXACT),
        ("equation (6)", np.float64, 4, 1e-2, EXACT),
        # above that: others too
        ("equation (6)", np.float64, None, 0.5, 16_856),
        ("equation (6)", np.float32, None, 0.5, 16_856),
        ("equation (6)", np.float64, None, 1.0, 21_560),
        # equal whole numbers make equal sums in any precision
        ("correlations", np.float64, None, 0.0, EXACT),
        ("correlations", np.float32, None, 0.0, EXACT),
        ("correlations", np.float64, 4, 0.0, EXACT),
    ],
)
def test_what_comparing_floating_point_finds(
    formula: str, dtype: type, digits: int | None, tolerance: float, count: int
) -> None:
    """The paper's 7 682 is no count of pairs with equal |Z|; comparing numbers gives such figures.

    Measured: each row is what this formula, precision and tolerance finds.
    """
    assert pairs(formula, dtype, digits, tolerance) == count
    search = cp.search_arrangements(14, alternating=True)
    assert (count == search.qualifying) == (count == EXACT)


@pytest.mark.slow
@pytest.mark.parametrize("formula", ito.FORMULAS)
def test_no_count_by_comparing_is_the_papers(formula: str) -> None:
    for dtype in (np.float32, np.float64, np.longdouble):
        for digits in (None, 4, 6, 8):
            squares = ito.squared_magnitudes(ARRANGEMENTS, formula, dtype, digits)
            counts = [ito.pairs_within(squares, t) for t in (0.0, *np.logspace(-16, 0, 17))]
            assert 7_682 not in counts


# --- groups with the same wave --------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("signed", "shift", "negated", "reversed_", "count"),
    [
        (True, False, False, False, 11_930),
        (True, True, False, False, 1_706),
        (True, True, True, False, 854),
        (True, True, True, True, 674),
        (False, True, False, False, 854),
        (False, True, True, False, 428),
        (False, True, True, True, 338),
    ],
)
def test_groups_with_the_same_wave(
    signed: bool, shift: bool, negated: bool, reversed_: bool, count: int
) -> None:
    """The paper has 806 groups "which have the same wave of exciting moment and the same V-angle".

    None of these readings of "same" gives that number.
    """
    assert ito.groups(signed=signed, shift=shift, negated=negated, backward=reversed_) == count
    assert count != 806


# --- figures 4, 6 and 8: the engines that the search hands back -----------------------------------

SEARCH = cp.search_arrangements(14, alternating=True)
SIX = cp.search_arrangements(6)


def found_engine(search: cp.results.ArrangementSearch, bank_angle_deg: float) -> cp.Engine:
    """The engine of a bank angle as printed."""
    (index,) = np.flatnonzero(np.abs(search.bank_angles_deg - bank_angle_deg) < 0.005)
    return search[int(index)].engine(CYLINDER, spacing=SPACING)


def remaining(engine: cp.Engine) -> Array:
    """Second-order pitch and yaw, in units of lambda M_0."""
    b = engine.balance(RPM, orders=2, spectrum=AS_THE_PAPER)
    return np.asarray(b.moment.peak_xy[0] / (ROD_RATIO * M_0))


@each_case
def test_the_balancer_of_the_engine_that_the_search_hands_back(row: Row) -> None:
    """Dashed in the figures: M_yb = M cos(theta + theta_0), M_xb = -M sin(theta + theta_0)."""
    engine = found_engine(SEARCH, float(row["bank_angle_deg"]))
    length = np.hypot(*engine.waveform(RPM, theta_deg=THETA, orders=[1]).moment.T) / M_0
    assert np.max(length) == printed(row, "amplitude")
    assert np.ptp(length) < ROUNDING
    phase = np.angle(engine.balance(RPM, orders=1).moment.forward[0], deg=True)
    if row["phase_deg"]:
        # The same engine turned by a seventh, reversed or mirrored: theta_0 in steps of 180/7
        # degrees, either sign.
        step = 180.0 / 7.0
        off = [np.mod(phase - sign * float(row["phase_deg"]), step) for sign in (1, -1)]
        nearest = min(min(value, step - value) for value in off)
        assert nearest < half_digit(row["phase_deg"])


@each_case
def test_moment_balancer_and_rest_are_the_rederivations(row: Row) -> None:
    """Full, dashed and remaining curves, from exact kinematics, through equations (3) to (6)."""
    engine = found_engine(SEARCH, float(row["bank_angle_deg"]))
    engine = engine.replace(cylinder=CYLINDER.replace(rod_length=CYLINDER.crank_radius / ROD_RATIO))
    (found,) = SEARCH.at_bank_angle(float(row["bank_angle_deg"]))
    one, two = (
        (np.round(np.array(bank) * 7 / 360).astype(int) + 1).tolist()
        for bank in (found.first_deg, found.second_deg)
    )
    # theta counts from cylinder 1's top dead centre; the first bank may stand on either side.
    theta = np.deg2rad(THETA + engine.tdc_deg[0] + found.first_deg[0])
    sides = np.sign(engine.bank_deg[1] - engine.bank_deg[0])
    pitch, yaw = ito.engine_moment(
        one, two, sides * np.deg2rad(found.bank_angle_deg), theta, ROD_RATIO
    )
    whole = engine.waveform(RPM, theta_deg=THETA).moment / M_0
    # z runs to the rear as -s from a middle plane: as in the cases above.
    np.testing.assert_allclose(whole, np.stack([pitch, -yaw], axis=1), rtol=0, atol=3e-13)
    balancer = engine.waveform(RPM, theta_deg=THETA, orders=[1]).moment / M_0
    rest = whole - balancer
    # What is left has the peaks of the second order, and the fourth and sixth on top of it.
    above = [np.abs(engine.balance(RPM, orders=n).moment.peak_xy[0]) / M_0 for n in (4, 6, 8)]
    second = engine.balance(RPM, orders=2).moment.peak_xy[0] / M_0
    assert np.all(np.abs(rest).max(axis=0) <= second + np.sum(above, axis=0) + 1e-4)
    assert np.all(np.abs(rest).max(axis=0) >= 0.99 * (second - np.sum(above, axis=0)))


def test_beside_the_v6() -> None:
    """Section 4: 170.87 and 9.13 degrees are better than the V-6, 49.54 in pitch, 63.03 in neither.

    The V-6 in use is taken to be the even-firing one at 60 degrees, whose first order a
    counterweight takes away too; same cylinders and spacing.
    """
    six = remaining(found_engine(SIX, 60.0))
    np.testing.assert_allclose(six, 1.5, rtol=ROUNDING)
    for angle in (9.13, 170.87):
        assert np.all(remaining(found_engine(SEARCH, angle)) < six)
    pitch, yaw = remaining(found_engine(SEARCH, 49.54))
    assert 0.8 * six[0] < pitch < six[0]
    assert yaw > six[1]
    assert np.all(remaining(found_engine(SEARCH, 63.03)) > six)
    # "about 6-fold larger" than at 170.87 degrees
    assert 5 < yaw / remaining(found_engine(SEARCH, 170.87))[1] < 6
