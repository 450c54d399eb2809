"""Does the independent re-derivation give back what the source documents print?

Where it does not, the row is named as an erratum in ``data/`` and the value it should have is
checked instead. Nothing here imports the library under test.
"""

from __future__ import annotations

import csv
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from rederivation import crossplane, ebook, harmonics_mp, ijesc, ito, kinematics, time_domain
from support import DATA, in_turn

TURN = np.linspace(0.0, 2.0 * np.pi, 721)

# Sums of a few dozen terms of order one, each rounded to 1.1e-16.
ROUNDING = 1e-13


def read(name: str) -> list[dict[str, str]]:
    """Rows of a table in ``data/``."""
    with (DATA / name).open(newline="") as file:
        return list(csv.DictReader(file))


def half_digit(decimals: int) -> float:
    """Half a unit of the last printed digit, and a millionth of it for rounding in reading it."""
    return 0.5000005 * 10.0**-decimals


# --- one slider-crank ---------------------------------------------------------------------------

GEOMETRIES = [(0.045, 0.158, 0.0), (0.045, 0.158, 0.004), (1.0, 2.0, 0.0), (0.05, 0.06, -0.005)]


@pytest.mark.parametrize(("r", "rod", "e"), GEOMETRIES)
def test_rod_keeps_its_length(r: float, rod: float, e: float) -> None:
    x = kinematics.position(TURN, r, rod, e)
    length = np.hypot(x - r * np.cos(TURN), e - r * np.sin(TURN))
    np.testing.assert_allclose(length, rod, rtol=1e-14)  # a handful of roundings


@pytest.mark.parametrize(("r", "rod", "e"), GEOMETRIES)
def test_derivatives_agree_with_spectral_differentiation(r: float, rod: float, e: float) -> None:
    theta = time_domain.crank_angles(512)
    order = np.fft.rfftfreq(512, 1.0 / 512)
    spectrum = np.fft.rfft(kinematics.position(theta, r, rod, e))
    first = np.fft.irfft(1j * order * spectrum)
    second = np.fft.irfft(-(order**2) * spectrum)
    # Differentiating lifts the rounding of position, a few 1e-16 of it in each of 256 orders, by
    # the order and by its square.
    np.testing.assert_allclose(
        first, kinematics.velocity(theta, r, rod, e), rtol=0, atol=rod * 256 * 1e-15
    )
    np.testing.assert_allclose(
        second, kinematics.acceleration(theta, r, rod, e), rtol=0, atol=rod * 256**2 * 1e-15
    )


def test_offset_lies_where_the_crankpin_swings_after_top_dead_centre() -> None:
    """With the bore's line at v = +e the rod stands straight when the crankpin is at v = e."""
    r, rod, e = 0.045, 0.158, 0.01
    upright = np.arcsin(e / r)
    assert kinematics.rod_height(upright, r, rod, e) == pytest.approx(rod, rel=1e-15)
    assert abs(kinematics.wall_force(upright, 1.0, 1.0, r, rod, e)) < 1e-17  # sine of ~1e-16 rad


@pytest.mark.parametrize(("r", "rod", "e"), GEOMETRIES)
def test_roll_torque_follows_from_angular_momentum(r: float, rod: float, e: float) -> None:
    """The piston's angular momentum about the crank axis is -m e x' omega; its rate is what block
    and driven crank together exert, so that roll torque = -crank torque + m omega^2 e x''.
    """
    mass, omega = 1.5, 500.0
    roll = kinematics.roll_torque(TURN, mass, omega, r, rod, e)
    crank = kinematics.crank_torque(TURN, mass, omega, r, rod, e)
    rest = mass * omega**2 * e * kinematics.acceleration(TURN, r, rod, e)
    scale = mass * omega**2 * r * rod
    np.testing.assert_allclose(roll, -crank + rest, rtol=0, atol=ROUNDING * scale)
    if e == 0.0:
        np.testing.assert_allclose(roll, -crank, rtol=0, atol=ROUNDING * scale)
    else:
        assert np.abs(roll + crank).max() > 1e-3 * scale


def test_inertia_torque_gives_no_work_over_a_turn() -> None:
    theta = time_domain.crank_angles(512)
    work = kinematics.crank_torque(theta, 1.0, 1.0, 1.0, 2.0, 0.3).mean()
    assert abs(work) < ROUNDING  # the trapezoid rule is exact here: harmonics end near order 60


# --- harmonics ----------------------------------------------------------------------------------


def test_stored_table_covers_the_grid() -> None:
    rows = harmonics_mp.reference_table()
    assert [(row.rod_ratio, row.offset_over_radius) for row in rows] == harmonics_mp.grid()
    assert all(len(row.digits) == harmonics_mp.MAX_ORDER for row in rows)


SAMPLE = [
    (1e-6, 0.0),
    (1e-6, 0.05 / 1e-6),
    (0.285, 0.0),
    (0.285, 1e-12 / 0.285),
    (0.285, 0.05 / 0.285),
    (0.75, 0.2 / 0.75),
]


@pytest.mark.parametrize(("lam", "offset"), SAMPLE)
def test_stored_harmonics_agree_with_series_in_the_sine(lam: float, offset: float) -> None:
    stored = {
        (row.rod_ratio, row.offset_over_radius): row for row in harmonics_mp.reference_table()
    }
    series = harmonics_mp.significant_parts(harmonics_mp.harmonics_by_series(lam, offset))
    with mp.workdps(400):
        for text, value in zip(stored[lam, offset].digits, series, strict=True):
            # Stored to 50 significant digits, so within 5e-50 of the truth.
            assert abs(mp.mpf(text) - value) <= mp.mpf("6e-50") * abs(value)


@pytest.mark.parametrize("lam", [1e-3, 0.5, 0.99, 0.999])
def test_trapezoid_rule_agrees_with_gauss_hypergeometric_function(lam: float) -> None:
    found = harmonics_mp.harmonics(lam)
    with mp.workdps(400):
        for n in (2, 4, 12, 40):
            closed = harmonics_mp.even_harmonic_closed_form(lam, n)
            # Both are asked for 50 digits.
            assert abs(found[n - 1][0] - closed) < mp.mpf("1e-50") * abs(closed)


def test_trapezoid_rule_agrees_with_gauss_legendre_near_the_limit() -> None:
    lam, offset = 0.99, 1e-4 / 0.99
    with mp.workdps(100):
        value = harmonics_mp.harmonic_by_gauss_legendre(lam, offset, 3)
        # Both are asked for 50 digits.
        assert abs(harmonics_mp.harmonics(lam, offset)[2][1] / value - 1) < mp.mpf("1e-50")


@in_turn("row", harmonics_mp.reference_table()[::5])
def test_fourier_transform_of_time_domain_gives_the_harmonics(
    row: harmonics_mp.ReferenceRow,
) -> None:
    theta = time_domain.crank_angles(4096)
    rod, e = 1.0 / row.rod_ratio, row.offset_over_radius
    samples = -kinematics.acceleration(theta, 1.0, rod, e)
    orders = range(1, 21)
    found = time_domain.peak_phasors(samples, orders)
    # Rounding of angle, 1/lambda and e, lifted by the slope of the acceleration.
    atol = 1e-15 * float(np.abs(np.gradient(samples, theta)).max())
    expected = np.array(row.coefficients()[:20])
    np.testing.assert_allclose(found, expected, rtol=0, atol=atol)


def test_textbook_values_of_second_and_fourth_harmonic() -> None:
    a = ebook.exact_coefficients(0.5)
    assert a[2] == pytest.approx(0.535552857, abs=5e-10)  # nine digits given
    assert a[4] == pytest.approx(-0.038426149, abs=5e-10)
    assert ijesc.exact_a2() == pytest.approx(0.29082, abs=5e-6)


# --- IJESC --------------------------------------------------------------------------------------

IJESC_COLUMNS = ("m_px", "m_py", "m_sx", "m_sy")
MISPRINTS = {  # (firing order, printed angle, column): value of the equations
    ("1-4-5-2-3-6", 30.0, "m_py"): 2065.36,
    ("1-6-5-4-3-2", 10.0, "m_py"): 589.81,
    ("1-6-5-4-3-2", 60.0, "m_py"): 2065.36,
}


def ijesc_row(row: dict[str, str], angle: float | None = None) -> np.ndarray:
    """Peaks of one printed row by the paper's own way, (4,)."""
    order = [int(number) for number in row["firing_order"].split("-")]
    where = float(row["bank_angle_deg"]) if angle is None else angle
    return np.asarray(ijesc.peaks_as_printed([where], [order])[0, 0])


def test_all_ijesc_entries_but_the_misprints() -> None:
    rows = read("v6_moment_tables.csv")
    wrong, entries = {}, 0
    for row in rows:
        angle = float(row["bank_angle_deg"])
        peaks = ijesc_row(row, 160.0 if angle == 180.0 else None)
        for name, value in zip(IJESC_COLUMNS, peaks, strict=True):
            entries += 1
            if abs(float(row[name]) - value) > half_digit(2):  # printed to 0.01 N m
                wrong[row["firing_order"], angle, name] = value
    assert entries == 272
    assert wrong.keys() == MISPRINTS.keys()
    for place, value in wrong.items():
        assert value == pytest.approx(MISPRINTS[place], abs=half_digit(2))


def test_the_row_headed_180_is_not_the_row_of_180_degrees() -> None:
    (row,) = (row for row in read("v6_moment_tables.csv") if row["bank_angle_deg"] == "180")
    peaks = ijesc_row(row)
    assert peaks[0] == pytest.approx(0.0, abs=1e-9)  # cos 90 degrees: no bisector component
    assert float(row["m_px"]) == pytest.approx(1348.06)


def test_ijesc_lags_entered_as_throws_do_not_give_the_tables() -> None:
    """Read as leads, the lags 0, 120, 240 are 0, 240, 120: other tables."""
    phasors = ijesc.bank_phasors(ijesc.FIRING_ORDERS)
    gamma = np.deg2rad(5.0)
    z = phasors[1, 0].conj()
    lead = ijesc.force_scale() * abs(z[1] * np.exp(-1j * gamma) + z[0] * np.exp(1j * gamma))
    assert abs(lead * np.cos(gamma) - 3478.14) > 100.0


def test_ijesc_closed_forms_agree_with_sampled_peaks() -> None:
    sampled = ijesc.peaks_as_printed()
    plain, fast = ijesc.peaks_closed_form(), ijesc.peaks_closed_form_fast()
    assert sampled.shape == plain.shape == fast.shape == (4, 17, 4)
    # 1e4 N m times rounding.
    np.testing.assert_allclose(sampled, plain, rtol=0, atol=1e4 * ROUNDING)
    np.testing.assert_allclose(fast, plain, rtol=0, atol=1e4 * ROUNDING)


def test_ijesc_peaks_fall_on_whole_degrees_at_every_v_angle() -> None:
    """|Z| is root 3 times the spacing for any lags of 0, 120, 240, hence the peak's place is half
    way between the banks' and does not depend on the V-angle: one degree steps lose nothing.
    """
    phasors = ijesc.bank_phasors(ijesc.FIRING_ORDERS)
    np.testing.assert_allclose(np.abs(phasors), 3**0.5 * ijesc.SPACING, rtol=ROUNDING)
    angles = np.arange(0.3, 180.0, 1.7)
    sampled, exact = ijesc.peaks_as_printed(angles), ijesc.peaks_closed_form(angles)
    np.testing.assert_allclose(sampled, exact, rtol=0, atol=1e4 * ROUNDING)


def test_ijesc_fast_form_agrees_on_odd_block_lengths() -> None:
    angles = np.linspace(0.1, 179.9, 1003)
    fast = ijesc.peaks_closed_form_fast(angles, a2=ijesc.exact_a2(), block=100)
    plain = ijesc.peaks_closed_form(angles, a2=ijesc.exact_a2())
    np.testing.assert_allclose(fast, plain, rtol=0, atol=1e4 * ROUNDING)


def test_ijesc_expanded_equations_and_balanced_forces() -> None:
    for plain, expanded in zip(ijesc.twin(TURN, 0.4), ijesc.twin_expanded(TURN, 0.4), strict=True):
        np.testing.assert_allclose(plain, expanded, rtol=0, atol=ROUNDING)
    forces = ijesc.components(TURN, 60.0, ijesc.FIRING_ORDERS[1], moments=False)
    assert np.abs(forces).max() < ROUNDING * ijesc.force_scale()


def ijesc_engine(firing_order: tuple[int, ...], v_angle: float) -> time_domain.EngineLists:
    """The paper's engine in our lists: a lag phi is a throw of -phi, tdc = phi -+ gamma."""
    side = np.tile([-1.0, 1.0], 3) * v_angle / 2.0
    return time_domain.EngineLists(
        crank_radius=ijesc.CRANK_RADIUS,
        rod_length=ijesc.ROD_LENGTH,
        reciprocating_mass=ijesc.MASS,
        tdc_deg=ijesc.lags_deg(firing_order) + side,
        bank_deg=90.0 + side,
        z=ijesc.SPACING * np.repeat(np.arange(3.0), 2),
    )


@pytest.mark.parametrize("firing_order", ijesc.FIRING_ORDERS)
def test_ijesc_tables_from_the_time_domain(firing_order: tuple[int, ...]) -> None:
    expected = ijesc.peaks_closed_form([50.0], [firing_order], a2=ijesc.exact_a2())[0, 0]
    engine = ijesc_engine(firing_order, 50.0)
    moment = time_domain.phasors(engine, ijesc.RPM, (1, 2), reference_z=0.0, n_samples=512).moment
    # 1e4 N m times rounding; harmonics have died out at order 256.
    np.testing.assert_allclose(np.abs(moment).ravel(), expected, rtol=0, atol=1e4 * ROUNDING)


# --- e-book -------------------------------------------------------------------------------------

V_COLUMNS = ("force_x", "force_y", "sum_z_force_x", "sum_z_force_y")
EBOOK_ERRATA = {  # (engine, order): what the listed phases give
    ("v_twin_90", 2): (5.814, 0.0, 0.0, 0.0),
    ("v_twin_90", 4): (0.0, 0.417, 0.0, 0.0),
    ("v6_60", 1): (0.0, 0.0, 0.855, 2.564),
    ("v6_60", 2): (0.0, 0.0, 0.617, 0.617),
    ("v6_60", 4): (0.0, 0.0, 0.044, 0.044),
}


def test_ebook_single_cylinder_amplitudes() -> None:
    printed = np.array((9.870, 4.111, 0.0, 0.295))  # to three decimals
    found = np.abs(ebook.single_cylinder()[1:5])
    np.testing.assert_allclose(found, printed, rtol=0, atol=half_digit(3))


def test_ebook_v_engine_tables() -> None:
    wrong = {}
    for row in read("ebook_v_engines.csv"):
        order = int(row["order"])
        found = ebook.table(ebook.V_ENGINES[row["engine"]])[order]
        printed = np.array([float(row[name]) for name in V_COLUMNS])
        decimals = len(row["force_x"].split(".")[1])
        if np.abs(found - printed).max() > half_digit(decimals):
            wrong[row["engine"], order] = found
            assert row["erratum"]
    assert wrong.keys() == EBOOK_ERRATA.keys()
    for place, found in wrong.items():
        np.testing.assert_allclose(found, np.array(EBOOK_ERRATA[place]), rtol=0, atol=half_digit(3))


def test_ebook_v_twin_second_order_cannot_be_4_and_0() -> None:
    """|F_x|^2 + |F_y|^2 of two bores at right angles is 2 F^2 whatever the phases."""
    for phase in np.linspace(0.0, 360.0, 73):
        layout = ebook.Layout((0.0, phase), (45.0, 135.0), (0.0, 0.0))
        size = np.sum(np.abs(ebook.phasor_sum_2d(layout, 2)) ** 2)
        assert size == pytest.approx(2.0, rel=ROUNDING)


def test_ebook_v6_row_is_nearly_the_straight_three() -> None:
    """Printed 1.710, 0.711, 0.051 against the straight-3's 1.709, 0.712, 0.051."""
    moments = ebook.table(ebook.MASTER["straight_3"])[[1, 2, 4], 2]
    # One and a half units of the third decimal: 0.711 is printed for 0.71206.
    np.testing.assert_allclose(moments, np.array([1.710, 0.711, 0.051]), rtol=0, atol=1.5e-3)


def test_ebook_crank_that_is_built() -> None:
    built = ebook.v_engine((0.0, 90.0, 270.0, 180.0), (-1.5, -0.5, 0.5, 1.5))
    preset = ebook.v_engine((0.0, 90.0, 180.0, 270.0), (-1.5, -0.5, 0.5, 1.5))
    assert preset == ebook.V_ENGINES["v8_cross_plane"]
    first = np.array([np.abs(ebook.phasor_moment_sum_2d(e, 1)) for e in (built, preset)])
    second = np.array([np.abs(ebook.phasor_moment_sum_2d(e, 2)) for e in (built, preset)])
    root_8, root_10 = np.sqrt([8.0, 10.0])
    expected = np.array([[root_10, root_10], [root_8, root_8]])
    np.testing.assert_allclose(first, expected, rtol=ROUNDING)
    np.testing.assert_allclose(second, np.array([[0, 0], [root_8, 0]]), rtol=0, atol=ROUNDING)


def test_ebook_master_table() -> None:
    found = ebook.master_table()
    wrong = []
    for row in read("ebook_master.csv"):
        printed = [float(row[name]) for name in ("dc", *(f"order_{n}" for n in range(1, 5)))]
        kind = ("force", "moment").index(row["quantity"])
        miss = np.abs(found[row["engine"]][kind] - printed)
        if miss.max() > half_digit(2):
            wrong.append((row["engine"], row["quantity"], int(miss.argmax())))
    assert wrong == [("single", "force", 4)]  # 0.29497, rounded twice to 0.30
    assert found["single"][0, 4] == pytest.approx(0.29497, abs=half_digit(5))


def test_ebook_rod_ratio_sweep() -> None:
    rows = read("ebook_rod_ratio.csv")
    found = ebook.rod_ratio_sweep(tuple(float(Fraction(row["rod_ratio"])) for row in rows))
    names = ("single_1x", "single_2x", "inline_4_2x", "flat_4_1x_moment", "straight_3_1x_moment")
    for row, values in zip(rows, found, strict=True):
        for name, value in zip(names, values[:5], strict=True):
            assert value == pytest.approx(float(row[name]), abs=half_digit(2))
        assert values[5] < 10 * ROUNDING  # the boxer-4: four terms of a few newtons cancel
    growth = found[0, 1] / found[2, 1]  # "linear" would be 2
    assert growth == pytest.approx(2.22, abs=half_digit(2))


def test_ebook_engines_said_to_be_balanced_fail_at_order_six() -> None:
    six = abs(ebook.single_cylinder()[6])
    assert ebook.table(ebook.MASTER["straight_6"], 6)[6, 0] == pytest.approx(6 * six)
    v6 = ebook.table(ebook.V_ENGINES["v6_60"], 6)[6]
    assert np.hypot(v6[0], v6[1]) == pytest.approx(3 * 3**0.5 * six)


def test_ebook_cross_plane_from_the_time_domain() -> None:
    """Seven kilograms from 2x on; the mirrored turning direction leaves the sizes alone."""
    layout = ebook.V_ENGINES["v8_cross_plane"]
    engine = time_domain.EngineLists(
        crank_radius=ebook.CRANK_RADIUS,
        rod_length=ebook.ROD_LENGTH,
        reciprocating_mass=ebook.MASS_ABOVE,
        tdc_deg=layout.phases_deg,
        bank_deg=layout.banks_deg,
        z=[ebook.HALF_SPACING * z for z in layout.positions],
    )
    found = time_domain.phasors(engine, ebook.RPM, (2, 4), n_samples=512)
    expected = ebook.table(layout)[[2, 4]]
    np.testing.assert_allclose(np.abs(found.force), expected[:, :2], rtol=0, atol=30 * ROUNDING)
    sums = np.abs(found.moment)[:, ::-1]  # M_y is the sum of z F_x, M_x that of -z F_y
    np.testing.assert_allclose(sums, expected[:, 2:], rtol=0, atol=30 * ROUNDING)


# --- cross-plane V8 -----------------------------------------------------------------------------


def test_crossplane_forces_and_couples_that_vanish() -> None:
    for order in (1, 2, 6):
        assert np.abs(crossplane.force(order)).max() < ROUNDING
    assert np.abs(crossplane.couple(2)).max() < ROUNDING


def test_crossplane_couple_is_root_ten_and_turns_with_the_crank() -> None:
    phasor = crossplane.couple(1)
    np.testing.assert_allclose(np.abs(phasor), 10**0.5, rtol=ROUNDING)
    waveform = np.real(phasor * np.exp(1j * TURN[:, np.newaxis]))
    np.testing.assert_allclose(waveform, crossplane.first_order_couple(TURN), rtol=0, atol=ROUNDING)
    backward = np.conj(phasor[0] - 1j * phasor[1]) / 2
    assert abs(backward) < ROUNDING


def test_crossplane_couple_as_printed_turns_backward() -> None:
    printed = crossplane.first_order_couple(time_domain.crank_angles(64), printed=True)
    forward, backward = time_domain.forward_backward(printed, (1,))
    assert abs(forward[0]) < ROUNDING
    assert abs(backward[0]) == pytest.approx(10**0.5)


def test_crossplane_fourth_order_is_vertical_not_a_circle() -> None:
    phasor = crossplane.force(4)
    np.testing.assert_allclose(phasor, [0.0, 32**0.5], rtol=0, atol=ROUNDING)
    waveform = np.real(phasor * np.exp(4j * TURN[:, np.newaxis]))
    right, wrong = (
        crossplane.fourth_order_force(TURN),
        crossplane.fourth_order_force_as_printed(TURN),
    )
    np.testing.assert_allclose(waveform, right, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(np.hypot(*wrong.T), 4.0, rtol=ROUNDING)
    assert np.abs(wrong - right).max() > 2.0


@pytest.mark.parametrize("stroke_ratio", [1.5, 3.0])
def test_crossplane_fourth_order_coefficient(stroke_ratio: float) -> None:
    exact = -ebook.exact_coefficients(1.0 / (2.0 * stroke_ratio))[4]
    right, printed = (
        crossplane.fourth_order_coefficient(stroke_ratio, printed) for printed in (False, True)
    )
    # The next term of the series is of relative size 1/lambda^4 times about 1/30.
    assert right == pytest.approx(exact, rel=0.05 / stroke_ratio**4)
    assert abs(printed - exact) > 5 * abs(right - exact)


def test_crossplane_from_the_time_domain() -> None:
    """Cylinders 1 ... 8 from the front, odd ones on the left at 135 degrees seen from behind."""
    r, rod, mass, a, rpm = 0.045, 0.158, 0.6, 0.1, 3000.0
    order = np.argsort(crossplane.FIRING_ORDER)
    engine = time_domain.EngineLists(
        crank_radius=r,
        rod_length=rod,
        reciprocating_mass=mass,
        tdc_deg=[90.0 * place for place in order],
        bank_deg=[135.0, 45.0] * 4,
        z=np.repeat(-crossplane.LEVERS, 2) * a,
    )
    found = time_domain.phasors(engine, rpm, (1, 2, 4, 6), n_samples=512)
    one = mass * r * time_domain.angular_speed(rpm) ** 2
    pitch, yaw = found.moment[0] / (one * a)
    # The page's levers count towards the front: yaw is minus its horizontal sum, pitch plus its
    # vertical one.
    np.testing.assert_allclose([-yaw, pitch], crossplane.couple(1), rtol=0, atol=10 * ROUNDING)
    a4 = harmonics_mp.harmonics(r / rod, max_order=4)[3][0]
    expected = np.array([crossplane.force(n) for n in (1, 2, 4, 6)]) * float(a4)
    np.testing.assert_allclose(found.force / one, expected, rtol=0, atol=10 * ROUNDING)


# --- Ito and Hattori ----------------------------------------------------------------------------


def banks(row: dict[str, str]) -> tuple[list[int], list[int]]:
    """First and second bank of one worked case."""
    first, second = (
        [int(k) for k in row[name].split("-")] for name in ("first_bank", "second_bank")
    )
    return first, second


def test_ito_piston_force_with_its_square_is_the_exact_acceleration() -> None:
    exact = -kinematics.acceleration(TURN, 1.0, 1.0 / 0.3)
    np.testing.assert_allclose(ito.piston_force(TURN, 0.3), exact, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("row", read("ito_cases.csv"), ids=lambda row: row["bank_angle_deg"])
def test_ito_worked_cases(row: dict[str, str]) -> None:
    first, second = banks(row)
    found = ito.precession(first, second)
    assert abs(found.v_angle_deg) == pytest.approx(float(row["bank_angle_deg"]), abs=half_digit(2))
    decimals = len(row["amplitude"].split(".")[1])
    assert found.amplitude == pytest.approx(float(row["amplitude"]), abs=half_digit(decimals))
    if row["phase_deg"]:
        assert found.phase_deg == pytest.approx(float(row["phase_deg"]), abs=half_digit(2))
    if row["a1"]:
        printed = [float(row[name]) for name in ("a1", "a2", "b1", "b2")]
        sums = [*ito.bank_coefficients(first), *ito.bank_coefficients(second)]
        np.testing.assert_allclose(sums, printed, rtol=0, atol=half_digit(4))
    if row["second_order_pitch"]:
        left = (found.second_order_pitch, found.second_order_yaw)
        printed = [float(row["second_order_pitch"]), float(row["second_order_yaw"])]
        np.testing.assert_allclose(left, printed, rtol=0, atol=half_digit(3))


@pytest.mark.parametrize("row", read("ito_cases.csv"), ids=lambda row: row["bank_angle_deg"])
def test_ito_first_order_turns_with_the_crank(row: dict[str, str]) -> None:
    first, second = banks(row)
    alpha = float(ito.bank_angle(first, second))
    theta = time_domain.crank_angles(64)
    pitch, yaw = ito.engine_moment(first, second, alpha, theta, rod_ratio=1e-12)
    forward, backward = time_domain.forward_backward(np.stack([pitch, -yaw], axis=1), (1,))
    assert abs(backward[0]) < ROUNDING
    assert abs(forward[0]) == pytest.approx(ito.precession(first, second).amplitude, rel=1e-12)


def test_ito_arrangements_and_exact_count() -> None:
    arrangements = ito.arrangements()
    assert len(np.unique(arrangements, axis=0)) == 504
    for row in read("ito_cases.csv"):
        for bank in banks(row):
            assert (arrangements == bank).all(axis=1).any()
    angles = ito.qualifying_angles(arrangements)
    assert angles.size == 12936  # the paper: 7682, which symmetry rules out (not 14 times anything)
    assert ito.distinct_sizes(angles).size == 218  # the paper: 216
    gaps = np.diff(ito.distinct_sizes(angles)) * 60.0
    assert gaps.min() == pytest.approx(8.87, abs=half_digit(2))  # minutes of arc
    assert gaps.max() == pytest.approx(176.37, abs=half_digit(2))


def test_ito_table_of_bank_angles() -> None:
    sizes = ito.distinct_sizes(ito.qualifying_angles(ito.arrangements()))
    printed = np.array([float(row["bank_angle_deg"]) for row in read("v14_table1_bank_angles.csv")])
    distance = np.abs(sizes[:, np.newaxis] - printed)
    # Printed to two decimals; 1.41 stands for 1.41509, whose supplement 178.58 is rightly rounded.
    assert distance.min(axis=0).max() < 0.0051
    missing = sizes[distance.min(axis=1) > 0.0051]
    np.testing.assert_allclose(missing, [90.91, 152.87], rtol=0, atol=half_digit(2))


def test_ito_starred_angles_have_most_arrangements() -> None:
    angles = np.abs(ito.qualifying_angles(ito.arrangements()))
    starred = 180.0 * np.arange(8) / 7.0
    counts = [int(np.sum(np.abs(angles - angle) < 1e-6)) for angle in starred]  # gaps are 0.15
    assert counts == [504, *[1008] * 6, 504]


def test_ito_without_the_alternation_rule() -> None:
    angles = ito.qualifying_angles(ito.arrangements(alternating=False))
    assert (angles.size, ito.distinct_sizes(angles).size) == (169344, 2248)


def test_ito_exact_key_against_floating_point() -> None:
    arrangements = ito.arrangements()
    size = np.abs(ito.bank_sum(arrangements))
    key = ito.magnitude_key(arrangements)
    same = (key[:, np.newaxis] == key).all(axis=2)
    difference = np.abs(size[:, np.newaxis] - size)
    assert difference[same].max() < ROUNDING
    assert difference[~same].min() > 1e-4  # this V-14's classes lie that far apart
