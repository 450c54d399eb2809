"""Are the slider-crank's harmonics right, to the last digits, wherever methods usually fail?"""

from __future__ import annotations

import crankpin as cp
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import harmonics_mp, kinematics
from support import DATA, in_turn

TABLE = harmonics_mp.reference_table(DATA / "harmonics_50_digits.csv")
ORDERS = list(range(1, 41))


def ours(row: harmonics_mp.ReferenceRow) -> np.ndarray:
    if row.offset_over_radius == 0.0:
        return cp.slider_crank_harmonics(row.rod_ratio, ORDERS).astype(complex)
    return cp.slider_crank_harmonics(row.rod_ratio, ORDERS, row.offset_over_radius)


def relative_errors(found: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Worst of real and imaginary part, each relative to itself; an exact zero must be zero."""
    errors = np.zeros(len(found))
    for part in ("real", "imag"):
        mine, theirs = getattr(found, part), getattr(exact, part)
        assert np.all(mine[theirs == 0] == 0)
        # below 1e-300 doubles lose their last digits to underflow
        counted = np.abs(theirs) > 1e-300
        each = np.abs(mine[counted] - theirs[counted]) / np.abs(theirs[counted])
        errors[counted] = np.maximum(errors[counted], each)
    return errors


@in_turn("row", TABLE)
def test_orders_1_to_40_against_50_digits(row: harmonics_mp.ReferenceRow) -> None:
    errors = relative_errors(ours(row), np.array(row.coefficients()))
    # 45 units in the last place at order 40; ten times that where 1 − λ costs digits
    assert errors.max() <= (1e-14 if row.rod_ratio <= 0.5 else 1e-13)


def test_the_table_covers_what_it_should() -> None:
    ratios = {row.rod_ratio for row in TABLE}
    assert min(ratios) == 1e-6
    assert max(ratios) == 0.999
    smallest = min(
        row.offset_over_radius * row.rod_ratio for row in TABLE if row.offset_over_radius
    )
    assert smallest < 1.1e-12


def test_a_transform_of_samples_would_fail_this() -> None:
    """FFT of positions is wrong in the sixth digit of order 12 at λ = 0.285, at any N."""
    exact = cp.slider_crank_harmonics(0.285, [12])[0]
    for count in (64, 256, 1024):
        theta = 2 * np.pi * np.arange(count) / count
        sampled = kinematics.position(theta, 1.0, 1.0 / 0.285)
        coefficient = 12**2 * np.fft.rfft(sampled)[12].real * 2 / count
        assert abs(coefficient / exact - 1) > 1e-8


@pytest.mark.parametrize("gap", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15])
@pytest.mark.parametrize("order", [2, 4, 8, 20, 40])
def test_rod_ratios_next_to_one(gap: float, order: int) -> None:
    """√(1 − λ² sin²θ) by 30-digit quadrature graded towards its spike."""
    ratio = 1.0 - gap
    with mpmath.workdps(40):
        exact = mpmath.mpf(ratio)
        width = mpmath.sqrt(1 - exact**2)

        def height(angle: mpmath.mpf) -> mpmath.mpf:
            return mpmath.sqrt(1 - exact**2 * mpmath.cos(angle) ** 2) * mpmath.cos(order * angle)

        steps = [width * 4**k for k in range(-1, 60) if width * 4**k < mpmath.pi / 2]
        edges = [0, *steps, mpmath.pi / 2]
        # from sin θ = 1: cos n(π/2 − φ) = (−1)^{n/2} cos nφ
        integral = mpmath.quad(height, edges) * (-1) ** (order // 2)
        coefficient = float(order**2 * 4 / mpmath.pi * integral / exact)
    found = cp.slider_crank_harmonics(ratio, [order])[0]
    # the area of the spike to rounding, of which order 40 is a hundredth part at most
    assert abs(found / coefficient - 1) <= 1e-13


@settings(max_examples=60, deadline=None)
@given(ratio=st.floats(0.01, 0.95), share=st.floats(-0.99, 0.99), theta=st.floats(0, 360))
def test_all_orders_sum_to_the_exact_force(ratio: float, share: float, theta: float) -> None:
    offset = share * (1 / ratio - 1) * 0.9
    orders = np.arange(1, 1500)
    harmonics = cp.slider_crank_harmonics(ratio, orders, offset)
    angle = np.radians(theta)
    summed = (harmonics * np.exp(1j * orders * angle)).real.sum()
    exact = -kinematics.acceleration(angle, 1.0, 1.0 / ratio, offset)
    # p ≤ 0.99 leaves 1500² · 0.99¹⁵⁰⁰ = 0.6 of nothing below: far less at 0.9 of the limit; the
    # rest is rounding of n·θ, weighed by the harmonics
    scale = np.abs(harmonics * orders).sum()
    assert abs(summed - exact) <= 1e-13 * scale + 1e-9 * abs(harmonics[-1]) * 1500**2


@settings(max_examples=60, deadline=None)
@given(ratio=st.floats(0.01, 0.95), share=st.floats(-0.9, 0.9))
def test_torque_harmonics_are_those_of_the_time_domain(ratio: float, share: float) -> None:
    offset = share * (1 / ratio - 1)
    count = 4096
    theta = 2 * np.pi * np.arange(count) / count
    cylinder = cp.Cylinder(1.0, 1.0 / ratio, 1.0, offset)
    orders = np.arange(1, 13)
    roll, crank = cylinder.torque_harmonics(orders.tolist())
    samples = [
        kinematics.roll_torque(theta, 1.0, 1.0, 1.0, 1.0 / ratio, offset),
        kinematics.crank_torque(theta, 1.0, 1.0, 1.0, 1.0 / ratio, offset),
    ]
    for found, waveform in zip((roll, crank), samples, strict=True):
        transform = np.fft.rfft(waveform)[orders] * 2 / count
        # rounding of 4096 samples, and 4096 samples of a spike with p₂ ≤ 0.985
        assert np.abs(found - transform).max() <= 1e-12 * np.abs(waveform).max()


def test_vectorised_as_one_by_one() -> None:
    ratios = np.concatenate([np.linspace(0.01, 0.999, 301), [1 - 1e-9]])
    table = cp.slider_crank_harmonics(ratios, [1, 2, 3, 4, 18, 40])
    for ratio, row in zip(ratios, table, strict=True):
        cylinder = cp.Cylinder(1.0, 1.0 / ratio, 1.0)
        alone = cp.slider_crank_harmonics(float(ratio), [1, 2, 3, 4, 18, 40])
        # lanes and scalars take different roundings, 39 multiplications at most
        np.testing.assert_allclose(row, alone, rtol=1e-14)
        assert row[0] == 1.0
        assert row[2] == 0.0
        assert cylinder.harmonics([3])[0] == 0


@pytest.mark.parametrize("count", [1, 16, 19])
@settings(max_examples=60, deadline=None)
@given(
    ratio=st.one_of(st.floats(1e-6, 0.999), st.floats(1e-12, 1e-3).map(lambda gap: 1 - gap)),
    digits=st.floats(0.01, 15),
    order=st.integers(1, 100).map(lambda m: 2 * m),
)
def test_a_tolerance_is_kept_by_every_order(
    count: int, ratio: float, digits: float, order: int
) -> None:
    # lanes of sixteen share the number of terms, others go by themselves
    ratios = np.linspace(ratio / 2, ratio, count) if count > 1 else np.array([ratio])
    orders = [1, 2, 3, order] if order > 2 else [1, 2, 3]
    rtol = 10.0**-digits
    found = cp.slider_crank_harmonics(ratios, orders, rtol=rtol)
    exact = cp.slider_crank_harmonics(ratios, orders)
    # rounding of powers up to 200, as above
    assert np.all(np.abs(found - exact) <= (rtol + 1e-13) * np.abs(exact))


def test_a_tolerance_leaves_terms_out() -> None:
    ratios = np.linspace(0.2, 0.9, 64)
    exact = cp.slider_crank_harmonics(ratios, [2, 4, 8])
    for rtol in (1e-3, 1e-6, 1e-9):
        for many in (True, False):
            parts = [ratios] if many else np.split(ratios, 64)
            found = [cp.slider_crank_harmonics(part, [2, 4, 8], rtol=rtol) for part in parts]
            worst = np.abs(np.concatenate(found) / exact - 1).max()
            # the bound takes 1/2 for |b_k| b_{k+m}/b_m, 4e-4 after eleven terms; they fall by 0.155
            assert 1e-4 * rtol < worst <= rtol
    with_offset = cp.slider_crank_harmonics(0.3, [2, 3], 0.1, rtol=1e-3)
    np.testing.assert_array_equal(with_offset, cp.slider_crank_harmonics(0.3, [2, 3], 0.1))
    with pytest.raises(cp.InputError, match="rtol"):
        cp.slider_crank_harmonics(0.3, [2, 3], 0.1, rtol=1.0)


def test_rows_depend_on_their_own_rod_ratio_alone() -> None:
    """... to the last bit: not on their neighbours, with which they are worked out side by side."""
    rng = np.random.default_rng(16)
    ratios = rng.uniform(0.01, 0.95, 100_003)
    orders = (1, 2, 3, 4, 6, 8, 20)
    table = cp.slider_crank_harmonics(ratios, orders)
    mixed = rng.permutation(ratios.size)
    assert np.array_equal(cp.slider_crank_harmonics(ratios[mixed], orders), table[mixed])
    for k in range(20):
        assert np.array_equal(cp.slider_crank_harmonics(ratios[k], orders), table[k])
