"""Does the library give what the cross-plane V8 page derives, and what it should have derived?

Firing order 1-8-4-3-6-5-7-2, 90 degrees, odd cylinders on the left bank. The page counts levers
towards the front and calls forces horizontal (to the right) and vertical: its horizontal couple is
minus our yaw M_y, its vertical couple our pitch M_x. Its fourth-order force is wrong.
"""

from __future__ import annotations

from typing import Literal

import crankpin as cp
import numpy as np
import pytest
from rederivation import crossplane, ebook
from support.engines import CYLINDER

RPM = 3000.0
SPACING = 0.1  # m, the page's a
MASS_RADIUS = CYLINDER.reciprocating_mass * CYLINDER.crank_radius
ONE = MASS_RADIUS * (2.0 * np.pi * RPM / 60.0) ** 2  # N, first-order force of one cylinder
THETA = np.arange(0.0, 720.0, 1.0)

# Sums of eight terms of order one (a lever of 1.5 at most), each rounded to 1.1e-16.
ROUNDING = 1e-14


def crossplane_v8(odd_bank: Literal["left", "right"] = "left") -> cp.Engine:
    """The engine that fires in the page's order."""
    return cp.Engine.from_firing_order(
        CYLINDER, crossplane.FIRING_ORDER, bank_angle_deg=90, odd_bank=odd_bank, spacing=SPACING
    )


BALANCE = crossplane_v8().balance(RPM, orders=(1, 2, 4, 6))


def test_top_dead_centres_follow_the_firing_order() -> None:
    v8 = crossplane_v8()
    assert (v8.tdc_deg == 90.0 * np.argsort(crossplane.FIRING_ORDER) % 360.0).all()
    assert (v8.bank_deg == [135.0, 45.0] * 4).all()
    assert (v8.pin_deg[::2] == v8.pin_deg[1::2]).all()  # two cylinders to a crankpin
    assert v8 == cp.Engine.vee(
        CYLINDER,
        bank_angle_deg=90,
        throws_deg=[0, 90, 270, 180],
        spacing=SPACING,
        odd_bank="left",
        firing_order=crossplane.FIRING_ORDER,
    )


@pytest.mark.parametrize("order", [1, 2, 6])
def test_forces_vanish_exactly(order: int) -> None:
    assert not BALANCE[order].force.any()
    assert np.abs(crossplane.force(order)).max() < ROUNDING


def test_second_order_couple_vanishes_exactly() -> None:
    assert not BALANCE[2].moment.any()


def test_first_order_couple_is_root_ten() -> None:
    pitch, yaw = BALANCE[1].moment / (ONE * SPACING)
    np.testing.assert_allclose([-yaw, pitch], crossplane.couple(1), rtol=0, atol=ROUNDING)
    assert abs(pitch) == pytest.approx(10**0.5, rel=ROUNDING)
    assert abs(yaw) == pytest.approx(10**0.5, rel=ROUNDING)


def test_first_order_couple_turns_with_the_crank_from_the_phase_of_the_page() -> None:
    first = BALANCE[1]
    assert first.moment.backward == 0j
    # pitch + i yaw = -i (horizontal... ) = -sqrt 10 (cos t + i sin t) with t = theta - phase.
    expected = -(10**0.5) * np.exp(-1j * crossplane.COUPLE_PHASE)
    assert first.moment.forward / (ONE * SPACING) == pytest.approx(expected, rel=ROUNDING)
    assert first.moment.minor == first.moment.peak


def test_first_order_couple_instant_by_instant() -> None:
    w = crossplane_v8().waveform(RPM, theta_deg=THETA, orders=[1])
    sums = np.stack([-w.moment[:, 1], w.moment[:, 0]], axis=1) / (ONE * SPACING)
    expected = crossplane.first_order_couple(np.deg2rad(THETA))
    # Angles up to 4 pi in radians on the other side: their last bit is 1.8e-15.
    np.testing.assert_allclose(sums, expected, rtol=0, atol=10 * ROUNDING)
    printed = crossplane.first_order_couple(np.deg2rad(THETA), printed=True)
    assert np.abs(sums - printed).max() > 6.0  # its horizontal part points the other way


def test_fourth_order_force_is_vertical_where_the_page_draws_a_circle() -> None:
    (a4,) = cp.slider_crank_harmonics(CYLINDER.rod_ratio, 4)
    fourth = BALANCE[4]
    x, y = fourth.force.xy
    assert x == 0j
    assert y == pytest.approx(4.0 * 2**0.5 * ONE * a4, rel=ROUNDING)
    assert fourth.force.minor == pytest.approx(0.0, abs=ROUNDING * abs(y))
    w = crossplane_v8().waveform(RPM, theta_deg=THETA, orders=[4])
    in_units = w.force / (ONE * a4)
    right = crossplane.fourth_order_force(np.deg2rad(THETA))
    wrong = crossplane.fourth_order_force_as_printed(np.deg2rad(THETA))
    # Four times an angle of up to 4 pi in radians.
    np.testing.assert_allclose(in_units, right, rtol=0, atol=40 * ROUNDING)
    assert np.abs(in_units - wrong).max() > 2.0


@pytest.mark.parametrize("stroke_ratio", [1.5, 3.0])
def test_fourth_order_coefficient_by_length_over_stroke(stroke_ratio: float) -> None:
    (a4,) = cp.slider_crank_harmonics(1.0 / (2.0 * stroke_ratio), 4)
    two_terms = crossplane.fourth_order_coefficient(stroke_ratio)
    printed = crossplane.fourth_order_coefficient(stroke_ratio, printed=True)
    # The next term of the series is smaller by 1/(30 lambda^4).
    assert -a4 == pytest.approx(two_terms, rel=0.05 / stroke_ratio**4)
    assert abs(-a4 - printed) > 5.0 * abs(-a4 - two_terms)


def test_odd_bank_right_needs_other_pins_and_its_couple_turns_backward() -> None:
    left = crossplane_v8("left")
    with pytest.warns(UserWarning, match='odd_bank="left" pins are shared'):
        right = crossplane_v8("right")
    assert (left.tdc_deg == right.tdc_deg).all()
    split = (right.pin_deg[1::2] - right.pin_deg[::2]) % 360.0
    assert (split == 180.0).all()  # no two cylinders share a pin
    first = right.balance(RPM, orders=1)[1]
    assert first.moment.forward == 0j
    assert abs(first.moment.backward) == pytest.approx(10**0.5 * ONE * SPACING, rel=ROUNDING)


def test_pins_of_the_ebook_leave_a_second_order_couple() -> None:
    """Pins at 0, 90, 180, 270: the same forces, but 2 sqrt 2 at order 1 and a couple at order 2."""
    v8 = cp.Engine.vee(CYLINDER, bank_angle_deg=90, throws_deg=[0, 90, 180, 270], spacing=SPACING)
    b = v8.balance(RPM, orders=(1, 2))
    assert not b.force.any()
    (a2,) = cp.slider_crank_harmonics(CYLINDER.rod_ratio, 2)
    expected = [[8**0.5] * 2, [0.0, 8**0.5 * a2]]
    np.testing.assert_allclose(b.moment.peak_xy / (ONE * SPACING), expected, rtol=0, atol=ROUNDING)
    layout = ebook.V_ENGINES["v8_cross_plane"]
    sums = np.abs([ebook.phasor_moment_sum_2d(layout, n) for n in (1, 2)])[:, ::-1]
    np.testing.assert_allclose(np.array(expected) / [[1.0], [a2]], sums, rtol=0, atol=ROUNDING)
