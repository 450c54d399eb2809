"""Are makers' tables of forces read, checked and printed by their names?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

MARINE = cp.Engine.preset("marine-5").with_cycle(cp.Cycle.example("diesel", strokes=2))
MAKERS = """name;amplitude kNm;phase
M1V;1200;0
M1H;800,5;-90
M2V;2300;45
H5;640;12
"""


def rows_of(table: cp.ForceTable) -> np.ndarray:
    """All amplitudes of a table, side by side."""
    parts = [getattr(table, name) for name in ("speed_squared", "independent")]
    orders = table.orders
    return np.array([[part.get(n, (0j,) * 7) for n in orders] for part in parts])


@in_turn("name", ["marine-5", "marine-6", "i4", "v6-60", "single"])
def test_tables_have_the_figures_of_foundation_and_guide_moments(name: str) -> None:
    engine = cp.Engine.preset(name)
    strokes = 2 if name.startswith("marine") else 4
    cycle = cp.Cycle.example("diesel" if strokes == 2 else "petrol", strokes=strokes)
    if engine.firing_order:
        engine = engine.with_cycle(cycle)
    orders, rpm = (1, 2, 3, 4), 140.0
    table = cp.force_table(engine, rpm, orders=orders)
    free = cp.foundation_table(engine, rpm, orders=orders)
    guide = cp.guide_moments(engine, rpm, orders=orders)
    makers = {(called, scaling): value * 1e3 for called, _, value, _, scaling in table._listed()}
    size = max(map(abs, makers.values()))
    for n in orders:
        of_free = {
            f"F{n}V": free.vertical_force, f"F{n}H": free.horizontal_force,
            f"M{n}V": free.vertical_couple, f"M{n}H": free.horizontal_couple,
        }  # fmt: skip
        expected = {
            (key, "speed squared"): complex(np.ravel(of[n])[-1]) for key, of in of_free.items()
        }
        for key, of in ((f"H{n}", guide.h_moment), (f"X{n}", guide.x_bimoment)):
            expected[key, "speed squared"] = complex(of.inertia[n])
            expected[key, "independent"] = complex(of.gas[n])
        for pair, value in expected.items():
            # Roundings of the largest of all.
            assert abs(makers.pop(pair, 0j) - value) <= 1e-12 * size, pair
    assert not makers


def test_a_table_reads_back_as_it_was_written(tmp_path: Path) -> None:
    table = cp.force_table(MARINE, 105.0, reference_z=0.4)
    table.to_csv(tmp_path / "table.csv")
    again = cp.ForceTable.from_csv(tmp_path / "table.csv", name=table.name)
    assert (again.rpm, again.about, again.orders) == (105.0, (0.0, 0.0, 0.4), table.orders)
    size = np.abs(rows_of(table)).max(axis=(0, 1))
    # Roundings of amplitude, phase and thousands.
    assert (np.abs(rows_of(again) - rows_of(table)) <= 1e-14 * size).all()


def test_makers_tables_are_read_with_their_units_and_signs(tmp_path: Path) -> None:
    file = tmp_path / "makers.csv"
    file.write_text(MAKERS, encoding="utf-8")
    table = cp.ForceTable.from_csv(file, rpm=97.0, about=(0, 0, 2.5))
    assert (table.rpm, table.about, table.orders) == (97.0, (0.0, 0.0, 2.5), (1, 2, 5))
    # M1V is Σ z·F_y, which turns against +x.
    assert np.isclose(table.speed_squared[1][3], -1.2e6)
    assert np.isclose(table.speed_squared[1][4], -8.005e5j)
    assert np.isclose(table.speed_squared[2][3], -2.3e6 * np.exp(0.25j * math.pi))
    assert np.isclose(table.independent[5][5], 6.4e5 * np.exp(1j * math.radians(12)))
    lagging = cp.ForceTable.from_csv(file, rpm=97.0, lag=True)
    assert np.isclose(lagging.speed_squared[1][4], 8.005e5j)
    file.write_text("component,order,value [N],over speed\nF_z,0.5,3,independent\n")
    assert cp.ForceTable.from_csv(file, rpm=50).independent == {0.5: (0, 0, 3, 0, 0, 0, 0)}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "path has no lines under a header"),
        ("name,phase\nM1V,0\n", "path has no column amplitude"),
        ("name,amplitude,unit\nM1Q,3,kN\n", "path has no order of 'M1Q' in line 2"),
        ("name,amplitude,unit\nM1V,3,kN\n", "path has the unit 'kN' in place of kN·m in line 2"),
        ("name,amplitude\nM1V,3\n", "path has the unit '' in place of kN·m in line 2"),
        ("name,amplitude,unit\nM1V,x,kN·m\n", "path has no number but 'x' in line 2"),
        ("name,amplitude,unit\nM1V,3,kN·m\n", "path has no speed: give the crank speed"),
        ("name,amplitude,unit,rpm\nM1V,3,kNm,9\nM2V,3,kNm,8\n", "path has 2 speeds"),
        ("name,amplitude,unit\nH,3,kNm\n", "path has no order of 'H' in line 2"),
        ("name,order,amplitude,unit\nH,0.3,3,kNm\n", "path has the order '0.3' in line 2"),
        ("name,amplitude,unit,scaling\nH1,3,kNm,no\n", "path has the word 'no' in place of"),
        ("name,amplitude,unit,rpm,about\nH1,3,kNm,9,a b\n", "path has no number but 'a' in col"),
    ],
)
def test_lines_that_cannot_be_read_are_named(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "table.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(cp.InputError) as caught:
        cp.ForceTable.from_csv(file)
    assert str(caught.value).startswith(said)


@pytest.mark.parametrize(
    ("figures", "said"),
    [
        ({}, "speed_squared = none"),
        ({"speed_squared": {1: (1, 2, 3)}}, "speed_squared[1] has 3 numbers"),
        ({"speed_squared": {0: (1,) * 6}}, "speed_squared = 0"),
        ({"independent": {1: (1,) * 6, 1.0 + 1e-18: (1,) * 6}, "rpm": 0}, "rpm = 0"),
        ({"independent": [1]}, "independent = [1]: give a mapping"),
        ({"independent": {1: ("a",) * 6}}, "independent[1] = 'a'"),
    ],
)
def test_figures_out_of_range_are_named(figures: dict[str, object], said: str) -> None:
    with pytest.raises(cp.InputError) as caught:
        cp.ForceTable(**{"rpm": 100.0} | figures)  # type: ignore[arg-type]
    assert str(caught.value).startswith(said)


def test_loads_over_speed_are_no_table() -> None:
    load = cp.PeriodicLoad("fan", on="block", torque={1: [1, 2]}, rpm=[100, 200])
    with pytest.raises(cp.InputError, match=r"^loads = .*no tables over speed"):
        cp.force_table(cp.Engine.preset("i4").with_loads([load]), 150.0)


# --- universal files ------------------------------------------------------------------------------


PUBLISHED = """    -1
    58
F_y of S
speed squared
NONE
about 0 0 1.5 m
NONE
   27         0    0         0 NONE               1   2 NONE               0   0
         6         2         0  0.00000E+00  0.00000E+00  1.05000E+02
        20    0    0    0 Order                NONE
        13    0    1    0 Force                N
         0    0    0    0 NONE                 NONE
        19    0    0    0 Speed                rpm
  1.00000E+00 -1.500000000000E+03  2.500000000000E+02
  4.00000E+00  0.000000000000E+00 -7.125000000000E+01
    -1
"""
"""Records at the columns of the published format: (I5,I10) twice, (1X,10A1,I10,I4) twice, (3I10,
3E13.5), (I10,3I5,2(1X,20A1)), E13.5 and 2E20.12."""


def test_universal_files_have_the_published_columns(tmp_path: Path) -> None:
    rows: dict[float, tuple[complex, ...]] = {
        1: (0, -1500 + 250j, 0, 0, 0, 0),
        4: (0, -71.25j, 0, 0, 0, 0),
    }
    table = cp.ForceTable(105, rows, about=(0, 0, 1.5), name="S")
    table.to_unv(tmp_path / "table.unv")
    written = (tmp_path / "table.unv").read_text(encoding="utf-8").splitlines()
    assert [line.rstrip() for line in written] == PUBLISHED.splitlines()
    assert cp.ForceTable.from_unv(tmp_path / "table.unv", name="S") == table


def test_a_table_reads_back_from_a_universal_file(tmp_path: Path) -> None:
    table = cp.force_table(MARINE, 105.0, reference_z=0.4)
    table.to_unv(tmp_path / "table.uff")
    again = cp.ForceTable.from_unv(tmp_path / "table.uff")
    assert (again.rpm, again.about) == (105.0, (0.0, 0.0, 0.4))
    for name in ("speed_squared", "independent"):
        for order, values in getattr(table, name).items():
            found = getattr(again, name).get(order, (0j,) * 7)
            # Twelve digits after the first, and no X type.
            np.testing.assert_allclose(found[:6], values[:6], rtol=1e-12)


def test_universal_files_of_others_are_read(tmp_path: Path) -> None:
    """Single precision, even frequencies, numbers that touch, against +x, other datasets."""
    file = tmp_path / "maker.unv"
    other = "    -1\n   151\nmodel\n    -1\n"
    text = PUBLISHED.splitlines()
    text[3] = text[5] = "NONE"
    text[7] = text[7].replace("   27", "   12").replace("   1   2", "   1  -4")
    text[8] = "         5         3         1  1.00000E+00  1.00000E+00  0.00000E+00"
    text[9] = text[9].replace("20 ", "18 ", 1)
    text[13:15] = ["  0.00000E+00-2.00000E+02  3.00000E+00 -1.00000E+00  0.00000E+00  0.00000E+00"]
    file.write_text(other + "\n".join(text), encoding="utf-8")
    table = cp.ForceTable.from_unv(file, rpm=120)
    assert table.speed_squared == {0.5: (0, 0, 0, 200j, 0, 0, 0), 1: (0, 0, 0, -3 + 1j, 0, 0, 0)}
    with pytest.raises(cp.InputError, match=r"^path has 0 speeds"):
        cp.ForceTable.from_unv(file)
    with pytest.raises(cp.InputError, match=r"^path has the order 0\.6: orders are multiples"):
        cp.ForceTable.from_unv(file, rpm=100)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("    58", "    55", "path has no dataset 58"),
        ("   1   2 ", "   1   0 ", "path has a dataset at line 2 that is no force or moment"),
        ("         6 ", "         4 ", "path has a dataset at line 2 that is no force or moment"),
        ("        20 ", "        17 ", "path has a dataset at line 2 that is no force or moment"),
        ("         6         2 ", "         6         3 ", "path has 6 numbers in the dataset at"),
        ("1.00000E+00 -1", "1.000x0E+00 -1", "path has a dataset at line 2 that cannot be read"),
    ],
)
def test_universal_files_that_are_wrong_say_where(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    assert old in PUBLISHED
    file = tmp_path / "table.unv"
    file.write_text(PUBLISHED.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(cp.InputError) as caught:
        cp.ForceTable.from_unv(file)
    assert str(caught.value).startswith(said)
