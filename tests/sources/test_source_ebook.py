"""Does the library give the e-book's tables, and what do its wrong rows have instead?

The books turn rotating and rod masses into forces along the bore: nine kilograms act at first
order and seven above it. Given as a spectrum (kg m, at a crank radius of one metre) any layout of
theirs gives their figures. Their phases enter as exp(+j n phi), the engine turns clockwise in their
picture with x to the right and y up; ours turns counter-clockwise, so that phasors are conjugate
and sizes equal. What they call "pitch" is the size of our yaw, and the reverse.
"""

from __future__ import annotations

import csv
from fractions import Fraction

import crankpin as cp
import numpy as np
import pytest
from numpy.typing import NDArray
from rederivation import ebook
from support import DATA

Array = NDArray[np.float64]

ORDERS = (1, 2, 3, 4)
A2, A4, A6 = (float(a) for a in cp.slider_crank_harmonics(0.5, [2, 4, 6]))
AS_PRINTED = {1: ebook.MASS_AT_FIRST_ORDER, 2: ebook.MASS_ABOVE * A2, 4: ebook.MASS_ABOVE * A4}
OMEGA_SQUARED = (2.0 * np.pi * ebook.RPM / 60.0) ** 2
PISTON = cp.Cylinder(crank_radius=1.0, rod_length=2.0, reciprocating_mass=ebook.MASS_ABOVE)
ROTATING_MASS = 2.0  # kg a cylinder, what the nine kilograms have more than the seven
LAYOUTS = {**ebook.V_ENGINES, **ebook.MASTER}
BUILT = ebook.v_engine((0.0, 90.0, 270.0, 180.0), (-1.5, -0.5, 0.5, 1.5))

# Sums of up to eight terms, each rounded to 1.1e-16, relative to one of them.
ROUNDING = 1e-14


def read(name: str) -> list[dict[str, str]]:
    """Rows of a table in ``data/``."""
    with (DATA / name).open(newline="") as file:
        return list(csv.DictReader(file))


def half_digit(decimals: int) -> float:
    """Half a unit of the last printed digit, and a millionth of it for rounding in reading it."""
    return 0.5000005 * 10.0**-decimals


def engine(
    layout: ebook.Layout, *, rotating_mass: float = 0.0, mirrored: bool = False
) -> cp.Engine:
    """The engine of three lists; mirrored, phases are leads."""
    sign = -1.0 if mirrored else 1.0
    return cp.Engine.from_lists(
        PISTON,
        tdc_deg=[sign * phase for phase in layout.phases_deg],
        bank_deg=layout.banks_deg,
        z=[ebook.HALF_SPACING * place for place in layout.positions],
        rotating_mass=rotating_mass,
    )


def sizes(b: cp.results.Balance) -> Array:
    """|F_x|, |F_y|, |sum z F_x|, |sum z F_y| per order, (n_orders, 4)."""
    return np.hstack([b.force.peak_xy, b.moment.peak_xy[:, ::-1]])


def as_printed(layout: ebook.Layout) -> Array:
    """Table of one engine by the books' masses, orders 1 to 4, (4, 4)."""
    return sizes(engine(layout).balance(ebook.RPM, orders=ORDERS, spectrum=AS_PRINTED))


def physical(layout: ebook.Layout) -> Array:
    """The same where two kilograms turn with the pin, orders 1 to 4, (4, 4)."""
    return sizes(engine(layout, rotating_mass=ROTATING_MASS).balance(ebook.RPM, orders=ORDERS))


# --- the cylinder -------------------------------------------------------------------------------


def test_coefficients_of_the_slider_crank() -> None:
    assert pytest.approx(0.535552857, abs=half_digit(9)) == A2
    assert pytest.approx(-0.038426149, abs=half_digit(9)) == A4
    exact = ebook.exact_coefficients(0.5)
    # A Fourier transform of samples of order one.
    np.testing.assert_allclose([A2, A4, A6], exact[[2, 4, 6]], rtol=0, atol=ROUNDING)


def test_single_cylinder() -> None:
    found = as_printed(ebook.MASTER["single"])[:, 0]
    np.testing.assert_allclose(found, (9.870, 4.111, 0.0, 0.295), rtol=0, atol=half_digit(3))


@pytest.mark.parametrize("name", LAYOUTS)
def test_tables_agree_with_the_rederivation(name: str) -> None:
    expected = ebook.table(LAYOUTS[name])
    # One cylinder's force is ten newtons; no lever is longer than half a metre. Order 3 vanishes by
    # symmetry, which a Fourier transform of samples finds to rounding.
    np.testing.assert_allclose(
        as_printed(LAYOUTS[name]), expected[1:], rtol=0, atol=10.0 * len(ORDERS) * ROUNDING
    )
    assert expected[0].max() < 1e-12  # there is no steady force, and the library reports none


@pytest.mark.parametrize("name", LAYOUTS)
def test_their_phasors_are_ours_seen_in_a_mirror(name: str) -> None:
    layout = LAYOUTS[name]
    ours = engine(layout).balance(ebook.RPM, orders=ORDERS, spectrum=AS_PRINTED)
    leading = engine(layout, mirrored=True).balance(ebook.RPM, orders=ORDERS, spectrum=AS_PRINTED)
    for k, order in enumerate(ORDERS):
        one = AS_PRINTED.get(order, 0.0) * OMEGA_SQUARED
        book = one * ebook.phasor_sum_2d(layout, order)
        np.testing.assert_allclose(leading.force.xy[k], book, rtol=0, atol=100 * ROUNDING)
        np.testing.assert_allclose(ours.force.xy[k], book.conj(), rtol=0, atol=100 * ROUNDING)


# --- V-engine tables ----------------------------------------------------------------------------

V_COLUMNS = ("force_x", "force_y", "sum_z_force_x", "sum_z_force_y")
WRONG_ROWS = {  # (engine, order): what the listed phases give
    ("v_twin_90", 2): (5.814, 0.0, 0.0, 0.0),
    ("v_twin_90", 4): (0.0, 0.417, 0.0, 0.0),
    ("v6_60", 1): (0.0, 0.0, 0.855, 2.564),
    ("v6_60", 2): (0.0, 0.0, 0.617, 0.617),
    ("v6_60", 4): (0.0, 0.0, 0.044, 0.044),
}


def printed_v_engines() -> dict[tuple[str, int], tuple[Array, int]]:
    """Printed figures and their decimals, by engine and order."""
    return {
        (row["engine"], int(row["order"])): (
            np.array([float(row[name]) for name in V_COLUMNS]),
            len(row["force_x"].split(".")[1]),
        )
        for row in read("ebook_v_engines.csv")
    }


def test_v_engine_tables_but_the_wrong_rows() -> None:
    wrong = {}
    for (name, order), (row, decimals) in printed_v_engines().items():
        found = as_printed(ebook.V_ENGINES[name])[order - 1]
        if np.abs(found - row).max() > half_digit(decimals):
            wrong[name, order] = found
    assert wrong.keys() == WRONG_ROWS.keys()
    for place, found in wrong.items():
        np.testing.assert_allclose(found, WRONG_ROWS[place], rtol=0, atol=half_digit(3))


@pytest.mark.parametrize("name", ebook.V_ENGINES)
def test_a_preset_is_compared_with_its_printed_table_by_one_call(name: str) -> None:
    preset = cp.Engine.preset(f"{name.replace('_plane', 'plane').replace('_', '-')}-ebook")
    comparison = cp.compare(preset, "lumped", ebook.RPM, orders=ORDERS, torque=False)
    assert comparison.before == preset.balance(ebook.RPM, orders=ORDERS, torque=False)
    # One cylinder's force is ten newtons; the page's phases are a mirror of the preset's pins.
    expected = as_printed(ebook.V_ENGINES[name])
    np.testing.assert_allclose(
        np.sort(sizes(comparison.after)[:, 2:]), np.sort(expected[:, 2:]), rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(sizes(comparison.after)[:, :2], expected[:, :2], rtol=0, atol=1e-12)


def v_twin(lag_deg: float) -> Array:
    """Forces of a 90-degree V-twin, its second cylinder later by some angle, (4, 2)."""
    return as_printed(ebook.Layout((0.0, lag_deg), (45.0, 135.0), (0.0, 0.0)))[:, :2]


def test_no_phases_give_the_printed_second_order_of_the_v_twin() -> None:
    """Two bores at right angles: |F_x|^2 + |F_y|^2 is 2 F^2 whatever the phases."""
    row, _ = printed_v_engines()["v_twin_90", 2]
    one = AS_PRINTED[2] * OMEGA_SQUARED
    assert np.hypot(row[0], row[1]) == pytest.approx(one, abs=half_digit(3))  # root 2 too short
    for lag in range(360):
        assert np.hypot(*v_twin(lag)[1]) == pytest.approx(2**0.5 * one, rel=ROUNDING)


def test_no_phases_give_first_and_fourth_order_of_the_v_twin() -> None:
    (first, _), (fourth, _) = (printed_v_engines()["v_twin_90", n] for n in (1, 4))
    lags = [lag for lag in range(360) if np.allclose(v_twin(lag)[0], first[:2], rtol=0, atol=1e-3)]
    assert lags == [90, 270]
    for lag in lags:
        # Fourth order has no x part where both cylinders are in step four times a turn.
        assert np.abs(v_twin(lag)[3] - fourth[:2]).max() > 0.1


def test_no_pins_give_the_printed_moments_of_the_v6() -> None:
    """Printed is nearly a straight three, all of it about one axis, at both orders. Two banks of
    three at 60 degrees never have that at both, however their pins are split.
    """
    (first, _), (second, _) = (printed_v_engines()["v6_60", n] for n in (1, 2))
    straight_three = as_printed(ebook.MASTER["straight_3"])[:2, 2]
    assert (first[3], second[3]) == pytest.approx(tuple(straight_three), abs=1.5e-3)
    squares = np.empty((360, 2))
    for split in range(360):
        v6 = cp.Engine.vee(
            PISTON,
            bank_angle_deg=60,
            throws_deg=[0, 120, 240],
            spacing=ebook.HALF_SPACING,
            pin_split_deg=split,
        )
        b = v6.balance(ebook.RPM, orders=(1, 2), spectrum=AS_PRINTED)
        squares[split] = (b.moment.peak_xy**2).sum(axis=1) / straight_three**2
    assert squares[0] == pytest.approx([2.5, 1.5])  # shared pins, as listed
    # Print has 1 and 1. No split comes near, as the second order turns with twice the split.
    assert squares.min() == pytest.approx(1.0)
    assert np.abs(squares - 1.0).max(axis=1).min() > 0.3


def test_the_presets_crank_is_not_the_one_that_is_built() -> None:
    """Pins at 0, 90, 180, 270 leave a second-order couple, at 0, 90, 270, 180 there is none."""
    one = AS_PRINTED[1] * OMEGA_SQUARED * ebook.HALF_SPACING
    preset, built = as_printed(ebook.V_ENGINES["v8_cross_plane"]), as_printed(BUILT)
    np.testing.assert_allclose(preset[0, 2:], 8**0.5 * one, rtol=ROUNDING)
    np.testing.assert_allclose(built[0, 2:], 10**0.5 * one, rtol=ROUNDING)
    assert preset[1, 2] == pytest.approx(1.1628, abs=half_digit(4))
    assert not built[1].any()


# --- summary: master table and rod ratios -------------------------------------------------------


def test_master_table() -> None:
    wrong = []
    for row in read("ebook_master.csv"):
        printed = np.array([float(row[f"order_{n}"]) for n in ORDERS])
        column = {"force": 0, "moment": 2}[row["quantity"]]
        miss = np.abs(as_printed(ebook.MASTER[row["engine"]])[:, column] - printed)
        if miss.max() > half_digit(2):
            wrong.append((row["engine"], row["quantity"], ORDERS[int(miss.argmax())]))
        assert float(row["dc"]) == 0.0
    assert wrong == [("single", "force", 4)]  # 0.29497, rounded to 0.295 and that to 0.30
    assert as_printed(ebook.MASTER["single"])[3, 0] == pytest.approx(0.29497, abs=half_digit(5))


BUILDERS = {
    "straight_3": cp.Engine.inline(PISTON, throws_deg=[0, 240, 120], spacing=0.1),
    "inline_4": cp.Engine.inline(PISTON, throws_deg=[0, 180, 180, 0], spacing=0.2),
    "boxer_4": cp.Engine.boxer(PISTON, throws_deg=[0, 180], spacing=0.2),
    "flat_4_non_boxer": cp.Engine.flat(PISTON, throws_deg=[0, 180], spacing=0.2),
    "straight_6": cp.Engine.inline(PISTON, throws_deg=[0, 240, 120, 120, 240, 0], spacing=0.1),
}


@pytest.mark.parametrize("name", BUILDERS)
def test_builders_give_the_engines_of_the_lists(name: str) -> None:
    b = BUILDERS[name].balance(ebook.RPM, orders=ORDERS, spectrum=AS_PRINTED)
    listed = as_printed(ebook.MASTER[name])
    # The books' bores lie along x, an inline engine's stand upright.
    np.testing.assert_allclose(
        b.force.peak, np.hypot(*listed[:, :2].T), rtol=0, atol=100 * ROUNDING
    )
    np.testing.assert_allclose(
        b.moment.peak, np.hypot(*listed[:, 2:].T), rtol=0, atol=100 * ROUNDING
    )


def rod_ratio_sweep(ratios: list[float], mass: float) -> dict[str, cp.results.Sweep]:
    """Engines over rod ratio, one mass at all orders."""
    cylinder = PISTON.replace(reciprocating_mass=mass)
    names = ("single", "inline_4", "flat_4_non_boxer", "straight_3", "boxer_4")
    engines = {name: engine(ebook.MASTER[name]).replace(cylinder=cylinder) for name in names}
    return {
        name: cp.sweep(each, rpm=ebook.RPM, rod_ratio=ratios, orders=(1, 2))
        for name, each in engines.items()
    }


def rod_ratio_table() -> tuple[list[float], dict[str, Array]]:
    """The summary's sweep: ratios, and columns by name."""
    ratios = [float(Fraction(row["rod_ratio"])) for row in read("ebook_rod_ratio.csv")]
    nine = rod_ratio_sweep(ratios, ebook.MASS_AT_FIRST_ORDER)
    seven = rod_ratio_sweep(ratios, ebook.MASS_ABOVE)
    columns = {
        "single_1x": nine["single"].force.peak_xy[:, 0, 0],
        "single_2x": seven["single"].force.peak_xy[:, 1, 0],
        "inline_4_2x": seven["inline_4"].force.peak_xy[:, 1, 0],
        "flat_4_1x_moment": nine["flat_4_non_boxer"].moment.peak_xy[:, 0, 1],
        "straight_3_1x_moment": nine["straight_3"].moment.peak_xy[:, 0, 1],
        "boxer_4_2x": seven["boxer_4"].force.peak_xy[:, 1, 0],
    }
    return ratios, columns


def test_rod_ratio_sweep_as_printed() -> None:
    _, columns = rod_ratio_table()
    for name, values in columns.items():
        printed = [float(row[name]) for row in read("ebook_rod_ratio.csv")]
        decimals = 0 if name == "boxer_4_2x" else 2
        np.testing.assert_allclose(values, printed, rtol=0, atol=half_digit(decimals))
    assert not columns["boxer_4_2x"].any()  # printed as a plain 0: it is one


def test_rod_ratio_sweep_agrees_with_the_rederivation() -> None:
    ratios, columns = rod_ratio_table()
    expected = ebook.rod_ratio_sweep(tuple(ratios))
    # At 2/3 the acceleration's Fourier sum is of terms of ten newtons, times four cylinders.
    np.testing.assert_allclose(
        np.stack(list(columns.values()), axis=1), expected, rtol=0, atol=400 * ROUNDING
    )


def test_second_order_does_not_scale_with_the_rod_ratio() -> None:
    """From a third to two thirds "exactly linear" would be 2."""
    ratios, columns = rod_ratio_table()
    growth = columns["single_2x"][0] / columns["single_2x"][2]
    assert ratios[0] == 2.0 * ratios[2]
    assert growth == pytest.approx(2.22, abs=half_digit(2))


def test_engines_said_to_be_balanced_shake_at_order_six() -> None:
    one = ebook.MASS_ABOVE * abs(A6) * OMEGA_SQUARED
    six = BUILDERS["straight_6"].balance(ebook.RPM, orders=(1, 2, 3, 4, 5, 6))
    np.testing.assert_allclose(six.force.peak, [0, 0, 0, 0, 0, 6.0 * one], rtol=ROUNDING)
    v6 = engine(ebook.V_ENGINES["v6_60"]).balance(ebook.RPM, orders=6)
    forces = v6.force.peak_xy[0]
    assert np.hypot(*forces) == pytest.approx(3.0 * 3.0**0.5 * one, rel=ROUNDING)
    assert 6 in engine(ebook.MASTER["straight_6"]).balance(ebook.RPM, orders="auto").orders


# --- the physical engine beside it --------------------------------------------------------------


@pytest.mark.parametrize("name", LAYOUTS)
def test_turning_masses_change_no_order_but_the_first(name: str) -> None:
    layout = LAYOUTS[name]
    # 7 a_n kg m by the spectrum, and by the slider-crank itself.
    np.testing.assert_allclose(
        physical(layout)[1:], as_printed(layout)[1:], rtol=0, atol=100 * ROUNDING
    )


@pytest.mark.parametrize(
    "layout", [ebook.V_ENGINES["v8_cross_plane"], BUILT], ids=["book", "built"]
)
def test_a_90_degree_v_has_eleven_kilograms_a_pin_where_the_book_has_nine(
    layout: ebook.Layout,
) -> None:
    """Two bores at right angles on one pin: 7 kg reciprocating turn with it, with 2 x 2 kg. The
    book's sum pushes 9 kg along each bore, as if 9 kg turned with the pin.
    """
    found = physical(layout)[0, 2:]
    np.testing.assert_allclose(found, as_printed(layout)[0, 2:] * 11.0 / 9.0, rtol=ROUNDING)


def test_along_an_inline_engines_bores_the_book_is_right_and_across_them_not() -> None:
    """Nine kilograms along the bore, but the two that turn push sideways too."""
    lumped, real = (f(ebook.MASTER["straight_3"])[0] for f in (as_printed, physical))
    assert real[2] == pytest.approx(lumped[2], rel=ROUNDING)
    assert lumped[3] == 0.0
    assert real[3] == pytest.approx(lumped[2] * 2.0 / 9.0, rel=ROUNDING)


@pytest.mark.parametrize("name", ["inline_4", "boxer_4", "straight_6", "v8_flat_plane"])
def test_where_throws_balance_each_other_nothing_differs(name: str) -> None:
    assert not as_printed(LAYOUTS[name])[0].any()
    assert not physical(LAYOUTS[name])[0].any()
