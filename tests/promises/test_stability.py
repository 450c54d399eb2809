"""Are the promises kept where methods fail, and do the methods fail there?

Conditions, promises and their reasons stand in ``benchmarks/stability_cases.py``,
``stability_links.py`` and ``stability_mounts.py``, the other methods in ``methods.py`` beside them;
``docs/explanations/stability.md`` has the measured figures.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import crankpin as cp
import methods
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import kinematics
from stability_cases import CASES, HARMONICS, Case, HarmonicCase
from stability_links import LINKS
from stability_mounts import MOUNTS
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

# Engines of any size on purpose.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:.*Lengths are metres here:UserWarning"),
]

NAMED = {method.name: method for method in methods.HARMONICS}


def fails(error: float, promise: float) -> bool:
    """Whether a method refuses or is further off than promised."""
    return math.isnan(error) or error > promise


# --- harmonics ----------------------------------------------------------------------------------

# Where a method cannot keep the promise at the best of its settings, and why.
FAILS: dict[str, Callable[[HarmonicCase, float], bool]] = {
    # terms fall by λ² each; no offset
    "series in λ": lambda case, ratio: ratio >= 0.3 or case.share > 0,
    # rounding of the low orders goes into the high ones, samples miss the spike
    "FFT of positions": lambda case, ratio: case.high or ratio <= 0.3 or ratio > 0.9999,
    "FFT of accelerations": lambda case, ratio: case.high or ratio < 0.01 or ratio > 0.9999,
    # amplifies rounding by p⁻²ⁿ
    "elliptic integrals, recurrence up": lambda case, ratio: case.high or ratio <= 0.9,
    # begins too near
    "recurrence down": lambda case, ratio: ratio > 0.9999 or case.share > 0,
    # does not converge at high orders
    "hyp2f1": lambda case, ratio: (case.high and ratio >= 0.99) or case.share > 0,
}
# What FFTs still manage: an offset that spreads over all orders.
EASY = {0.5, 0.999}


@in_turn("case", HARMONICS)
def test_harmonics(case: HarmonicCase) -> None:
    assert case.error(NAMED["crankpin"]) <= case.promise
    ratio = case.row.rod_ratio
    for name, expected in FAILS.items():
        if expected(case, ratio) and not (case.share in EASY and "FFT" in name and not case.high):
            assert fails(case.best(NAMED[name]), case.promise), name


@in_turn("case", HARMONICS)
def test_what_vanishes_in_harmonics_is_zero(case: HarmonicCase) -> None:
    """Without offset odd orders above 1; with it sines of even orders, cosines of odd ones."""
    row = case.row
    found = cp.slider_crank_harmonics(row.rod_ratio, row.orders, row.offset_over_radius)
    odd = np.array(row.orders) % 2 == 1
    assert np.all(found.imag[~odd] == 0)
    assert np.array_equal(found.real[odd], [float(n == 1) for n in np.array(row.orders)[odd]])
    if not row.offset_over_radius:
        assert np.all(found.imag == 0)
        plain = cp.slider_crank_harmonics(row.rod_ratio, row.orders)
        # one table goes through lanes, the other does not: 39 multiplications at most
        np.testing.assert_allclose(plain, found.real, rtol=1e-14)


# --- everything else ----------------------------------------------------------------------------


@in_turn("case", [*CASES, *LINKS, *MOUNTS])
def test_promises(case: Case) -> None:
    assert case.ours() <= case.promise
    assert case.plain() > case.promise


def test_an_imbalance_of_one_part_in_1e9_is_no_rounding() -> None:
    """The same force is far above what rounding can leave, and without it there is none."""
    cylinder = cp.Cylinder(0.045, 0.158, 0.5)
    heavier = cylinder.replace(reciprocating_mass=0.5 * (1 + 1e-9))
    six = cp.Engine.preset("i6").replace(cylinder=cylinder, rotating_mass=0.0)
    uneven = six.replace(cylinder=[*[cylinder] * 5, heavier])
    assert np.all(six.balance(20_000, orders=[1, 2, 4]).force == 0)
    found = uneven.balance(20_000, orders=[1, 2, 4])
    assert np.all(np.abs(found.force.xy[:, 1]) > 1e4 * found.force.zero_bound)


# --- refusals -----------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [0.3, 0.9, 1 - 1e-6, 1 - 1e-12])
def test_a_crank_that_cannot_turn_is_refused_and_its_neighbour_is_not(ratio: float) -> None:
    """To the last digit: the largest offset is (1 − λ)/λ, exact up to its own rounding."""
    limit = (1 - ratio) / ratio
    for offset in (limit * (1 + 1e-15), -limit * (1 + 1e-15), 1.0 + limit):
        with pytest.raises(cp.InputError, match="pin_offset_ratio"):
            cp.slider_crank_harmonics(ratio, [1, 2], offset)
        # kinematics goes on, with the root of a negative number or the rod through the crank
        with np.errstate(invalid="ignore"):
            moved = kinematics.position([0.5 * np.pi, 1.5 * np.pi], 1.0, 1 / ratio, 1.0 + limit)
        assert np.any(np.isnan(moved))
    for offset in (limit * (1 - 1e-15), -limit * (1 - 1e-15)):
        assert np.all(np.isfinite(cp.slider_crank_harmonics(ratio, [1, 2, 3, 200], offset)))
    for outside in (1.0, np.nextafter(1.0, 2.0), -0.3, 1e-31):  # 0 is an infinite rod
        with pytest.raises(cp.InputError, match="rod_ratio"):
            cp.slider_crank_harmonics(outside, [1, 2])
    assert np.all(np.isfinite(cp.slider_crank_harmonics(np.nextafter(1.0, 0.0), [2, 200])))


DENORMAL = [5e-324, 1e-310, 2.2e-308, 1e-31]
SOUND: dict[str, Any] = {"crank_radius": 0.05, "rod_length": 0.15, "reciprocating_mass": 0.5}


@pytest.mark.parametrize("value", DENORMAL)
def test_figures_too_small_for_products_of_them_are_refused_by_name(value: float) -> None:
    """m·r of denormals has lost its digits: 5e-324 kg · 0.05 m is 0."""
    assert 5e-324 * 0.05 == 0.0
    for name in SOUND:
        with pytest.raises(cp.InputError, match=name):
            cp.Cylinder(**SOUND | {name: value})
    single = cp.Engine.preset("single")
    with pytest.raises(cp.InputError, match="rpm"):
        single.balance(value)
    with pytest.raises(cp.InputError, match="rotating_mass"):
        single.replace(rotating_mass=value)
    assert np.all(single.balance(0.0).force == 0)


@pytest.mark.parametrize("value", DENORMAL)
def test_tiny_places_and_offsets_count_for_what_they_are(value: float) -> None:
    """They are added to lengths, where they are far below rounding."""
    cylinder = cp.Cylinder(**SOUND, pin_offset=value)
    np.testing.assert_array_equal(
        cylinder.harmonics([1, 2, 4]).real, cp.Cylinder(**SOUND).harmonics([1, 2, 4]).real
    )
    # a₃ of a tiny offset goes with it: 3 λ³/8 · (e/r) · 3 at first order in both
    third = cylinder.harmonics([3])[0].imag
    assert 0 <= third <= value / 0.05
    engine = cp.Engine.inline(cp.Cylinder(**SOUND), throws_deg=[0, 180], spacing=value)
    assert np.all(np.isfinite(engine.balance(6000).moment))


# --- scale --------------------------------------------------------------------------------------


def figures(engine: cp.Engine, rpm: float) -> dict[str, tuple[ArrayLike, int, int]]:
    """Results with their powers of length and of mass, at the same piston speed."""
    balance = engine.balance(rpm, orders=[1, 2, 3, 4, 12])
    waveform = engine.waveform(rpm, theta_deg=np.arange(0.0, 360.0, 7.0))
    return {
        "harmonics": (engine.cylinders[0].harmonics([1, 2, 3, 40]), 0, 0),
        "force": (balance.force, -1, 1),
        "moment": (balance.moment, 0, 1),
        "torque": (balance.torque, 0, 1),
        "peaks": (balance.total.moment.peak_xy, 0, 1),
        "longest": (np.array(balance.total.force.peak), -1, 1),
        "exact force": (waveform.force, -1, 1),
        "exact moment": (waveform.moment, 0, 1),
        "exact torque": (waveform.torque, 0, 1),
    }


@settings(max_examples=60, deadline=None)
@given(
    ratio=st.floats(0.01, 0.99),
    # next to 0 odd orders fall below the smallest double of full precision
    share=st.just(0.0) | st.floats(1e-9, 0.99) | st.floats(-0.99, -1e-9),
    length=st.integers(-80, 80),
    mass=st.integers(-80, 80),
)
def test_powers_of_two_scale_every_result_exactly(
    ratio: float, share: float, length: int, mass: int
) -> None:
    """No figure has a size of its own: no threshold in newtons, no square that overflows."""

    def engine(unit: float, weight: float) -> cp.Engine:
        rod = 0.05 / ratio
        parts = (0.05 * unit, rod * unit, 0.5 * weight, 0.9 * share * (rod - 0.05) * unit)
        layout: dict[str, Any] = {"bank_angle_deg": 61.5, "throws_deg": [0, 123.4, 240]}
        return cp.Engine.vee(cp.Cylinder(*parts), spacing=0.1 * unit, **layout)

    unit, weight = 2.0**length, 2.0**mass
    expected = figures(engine(1.0, 1.0), 6000)
    for name, (found, of_length, of_mass) in figures(engine(unit, weight), 6000 / unit).items():
        factor = 2.0 ** (length * of_length + mass * of_mass)
        np.testing.assert_array_equal(found, np.asarray(expected[name][0]) * factor, err_msg=name)
