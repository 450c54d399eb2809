"""Angles are exact as typed: text, decimals, fractions and floats that mean one angle are one."""

from __future__ import annotations

import array
from decimal import Decimal
from fractions import Fraction
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import inputs
from hypothesis import given
from hypothesis import strategies as st
from support.engines import CYLINDER


def text(value: object) -> str:
    """The text of this angle that the core reads."""
    return inputs.angle("angle", value)


@pytest.mark.parametrize(
    "value",
    [
        49.54,
        np.float64(49.54),
        np.float32(49.54),
        np.longdouble("49.54"),
        np.array(49.54),
        "49.54",
        " 49.540 ",
        "4.954e1",
        "2477/50",
        "-2477/-50",
        Decimal("49.54"),
        Decimal("4.954E+1"),
        Fraction(2477, 50),
        Fraction("49.54"),
    ],
    ids=repr,
)
def test_one_angle_however_typed(value: object) -> None:
    assert text(value) == "49.54"


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (360 / 7, "360/7"),
        (Fraction(360, 7), "360/7"),
        (Decimal(360) / 7, "360/7"),
        (0.1 + 0.2, "0.3"),
        (Decimal.from_float(0.3), "0.3"),
        (Fraction(0.3), "0.3"),
        (Fraction(49.54), "49.54"),
        (Fraction(1, 2**20), "1/1048576"),
        (Decimal("-236.37001175040001"), "-23637001175040001/100000000000000"),
        (Fraction(1, 10**40), "1e-40"),
        (np.int64(90), "90"),
        (Decimal("49.1234567"), "491234567/10000000"),
    ],
    ids=repr,
)
def test_an_angle_is_what_it_stands_for(value: object, expected: str) -> None:
    assert text(value) == text(expected)


@pytest.mark.parametrize(
    "value",
    [Decimal("NaN"), Decimal("Infinity"), Decimal("1e1000000000"), Fraction(10**400), "1/0", "x"],
    ids=str,
)
def test_a_value_that_is_no_angle_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match="angle = "):
        text(value)


@given(st.integers(-(10**12), 10**12))
def test_six_decimals_are_one_angle_in_every_form(millionths: int) -> None:
    exact = Fraction(millionths, 10**6)
    decimal = Decimal(millionths).scaleb(-6)
    forms: list[Any] = [exact, decimal, str(decimal), float(exact), np.float64(float(exact))]
    assert len({text(form) for form in forms}) == 1


@given(st.integers(6, 14), st.integers(0, 720 * 10**14))
def test_typed_decimals_are_exact_and_a_turn_apart_the_same(places: int, number: int) -> None:
    """Equal engines, and there and back by another bank angle the same one."""
    here = Decimal(number // 10 ** (14 - places)).scaleb(-places)
    assert Fraction(text(str(here))) == Fraction(here)
    engines = {
        cp.Engine.from_lists(CYLINDER, tdc_deg=[0, form], bank_deg=[60, 120], z=[0, 0])
        for form in (str(here), here, Fraction(here), str(here - 360), f"{here + 720}")
    }
    assert len(engines) == 1
    (engine,) = engines
    other = str(here % 180)
    for hold in ("pins", "firing"):
        there = engine.with_bank_angle(other, hold=hold)
        assert there.with_bank_angle(60, hold=hold) == engine
        again = there.with_bank_angle("47.00000000000001", hold=hold)
        assert again.with_bank_angle(other, hold=hold) == there
    assert cp.Engine.from_toml(engine.to_toml()) == engine


@given(st.floats(-1e12, 1e12))
def test_text_of_a_float_reads_back(degrees: float) -> None:
    assert text(text(degrees)) == text(degrees)


def test_an_angle_taken_for_a_fraction_has_no_hint(recwarn: pytest.WarningsRecorder) -> None:
    for angle in (70.2439024390244, "70.2439024390244"):
        lists = [
            cp.Engine.from_lists(CYLINDER, tdc_deg=[0, each], bank_deg=[90, 90], z=[0, 0])
            for each in (angle, "2880/41")
        ]
        assert lists[0] == lists[1]
    assert not recwarn.list


SINGLES = [
    np.array([0, 49.54], dtype=np.float32),
    np.array([0, 49.54], dtype=np.float16),
    array.array("f", [0, 49.54]),
    memoryview(np.array([0, 49.54], dtype=np.float32)),  # type: ignore[arg-type]
    [np.float32(0), np.float32(49.54)],
]


@pytest.mark.parametrize("values", SINGLES, ids=lambda values: type(values).__name__)
def test_a_single_is_its_own_shortest_decimal(values: Any) -> None:  # noqa: ANN401
    """In single precision 49.54 is 49.54000091…, in half precision 49.53125."""
    meant = "49.53" if getattr(values, "dtype", None) == np.float16 else "49.54"
    assert inputs.angles("tdc_deg", values) == ["0", meant]
    assert inputs.array("z", values).tolist() == [0.0, float(meant)]
    assert inputs.number("z", values[1]) == float(meant) or isinstance(values[1], float)


def test_singles_of_other_libraries_are_decimals_too() -> None:
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    numbers = np.array([0, 49.54], dtype=np.float32)
    for values in (pandas.Series(numbers), xarray.DataArray(numbers)):
        assert inputs.angles("tdc_deg", values) == ["0", "49.54"]
        assert inputs.array("z", values).tolist() == [0.0, 49.54]
    cylinder = cp.Cylinder(np.float32(0.04), np.float32(0.14), np.array(0.5, dtype=np.float32))  # type: ignore[arg-type]
    assert cylinder == cp.Cylinder(0.04, 0.14, 0.5)


def test_a_vee_has_the_banks_that_are_typed() -> None:
    """Bank angles of whole hundredths, computed by the builder and typed in a list.

    Every seventh: banks computed in floats differ from those typed at 930 of these 2 572.
    """
    different = []
    for k in range(1, 18_000, 7):
        vee = cp.Engine.vee(CYLINDER, bank_angle_deg=k / 100, throws_deg=[0], spacing=0.1)
        right, left = (float(Decimal(90) - side * Decimal(k) / 200) for side in (1, -1))
        typed = cp.Engine.from_lists(
            CYLINDER, tdc_deg=[0, k / 100], bank_deg=[right, left], z=[0, 0]
        )
        if vee != typed.replace(name=vee.name):
            different.append(k)
    assert not different, f"{len(different)} differ, such as {different[:5]}"
