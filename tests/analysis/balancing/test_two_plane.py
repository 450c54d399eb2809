"""Do corrections in two planes do what the measured imbalance does, the other way round?"""

from __future__ import annotations

import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from rederivation import rotors
from support import html_of

PLACES = st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=2)


@settings(max_examples=50, deadline=None)
@given(
    # What a balancing machine reads: figures below 1e-307 have no relative accuracy.
    amounts=st.lists(st.floats(0.0, 1e4, allow_subnormal=False), min_size=2, max_size=2),
    angles=st.lists(st.floats(0.0, 360.0), min_size=2, max_size=2),
    measured=PLACES,
    corrected=PLACES,
)
def test_a_corrected_rotor_exerts_nothing(
    amounts: list[float], angles: list[float], measured: list[float], corrected: list[float]
) -> None:
    assume(abs(corrected[0] - corrected[1]) > 0.01)
    found = cp.two_plane_correction(amounts, angles, measured_z=measured, correction_z=corrected)
    # Grams at a millimetre, as masses that turn.
    masses = [
        rotors.Rotor(1e-3 * amount, 1e-3, angle, z)
        for amount, angle, z in [
            *zip(amounts, angles, measured, strict=True),
            *zip(found.amount_g_mm, found.angle_deg, corrected, strict=True),
        ]
    ]
    size = sum(mass.mass for mass in masses) * 1e-3 * (2 * np.pi * 1000 / 60) ** 2
    for plane in (0.0, 0.7):
        force, moment, _ = rotors.wrench(masses, 1000.0, plane, n_samples=16)
        assert np.abs(force).max() <= 1e-11 * size
        assert np.abs(moment).max() <= 1e-11 * size


def test_an_engine_with_measured_imbalance_is_corrected() -> None:
    i4 = cp.Engine.preset("i4")
    found = cp.two_plane_correction(
        [900, 400], [10, 250], measured_z=[0.0, 0.3], correction_z=[-0.15, 0.45]
    )
    bad = i4.with_counterweights(found.measured)
    good = i4.with_counterweights([*found.measured, *found.hardware])
    assert bad.balance(6000, orders=[1])[1].force.peak > 100
    order_1 = good.balance(6000, orders=[1])[1]
    assert order_1.force.peak < 1e-9
    assert order_1.moment.peak < 1e-9


def test_planes_of_measurement_are_corrected_opposite() -> None:
    found = cp.two_plane_correction(
        [120, 80], [30, 200], measured_z=[0, 0.4], correction_z=[0, 0.4]
    )
    np.testing.assert_allclose(found.amount_g_mm, [120, 80])
    np.testing.assert_allclose(found.angle_deg, [210, 20])
    np.testing.assert_allclose(found.drill_deg, [30, 200])
    assert [w.amount for w in found.hardware] == pytest.approx([120e-6, 80e-6])
    assert [w.z for w in found.hardware] == [0.0, 0.4]


def test_table_and_copies() -> None:
    found = cp.two_plane_correction([1, 2], [3, 4], measured_z=[0, 1], correction_z=[0.2, 0.7])
    lines = repr(found).splitlines()
    assert lines[0] == "Two-plane correction"
    assert found.table.header == ["plane", "z m", "unbalance g·mm", "add at °", "or drill at °"]
    assert lines[1].split() == " ".join(found.table.header).split()
    assert "<table>" in html_of(found)
    assert list(found.to_pandas().columns) == found.table.header
    back = pickle.loads(pickle.dumps(found))  # noqa: S301 - its own
    assert back == found
    assert hash(back) == hash(found)
    assert not found.amount_g_mm.flags.writeable


@pytest.mark.parametrize(
    ("given_", "words"),
    [
        ({"amount_g_mm": [1, -2]}, r"amount_g_mm = \[1, -2\]: give zero or more"),
        ({"amount_g_mm": 3}, "amount_g_mm has 1 figure: give two"),
        ({"angle_deg": [1, 2, 3]}, "angle_deg has 3 figures: give two"),
        ({"angle_deg": [1, float("nan")]}, "angle_deg = .*give finite numbers"),
        ({"measured_z": ["a", 0]}, "measured_z = .*give numbers"),
        ({"correction_z": [0.1, 0.1]}, r"correction_z = \[0.1, 0.1\]: give two different places"),
    ],
)
def test_arguments_that_do_not_fit_are_named(given_: dict[str, Any], words: str) -> None:
    good: dict[str, Any] = {
        "amount_g_mm": [1, 2],
        "angle_deg": [0, 0],
        "measured_z": [0, 1],
        "correction_z": [0, 1],
    }
    with pytest.raises(cp.InputError, match=words):
        cp.two_plane_correction(**good | given_)
