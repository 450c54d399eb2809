"""Does the command line print the library's numbers, and say in a line what was wrong?"""

from __future__ import annotations

import csv
import importlib
import io
import os
import re
import shlex
import subprocess
import sys
import tomllib
from argparse import Namespace
from pathlib import Path
from typing import Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin import cli
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.record import AbsentItemError
from crankpin.cli import main
from crankpin.cli.arguments import Given
from crankpin.cli.naming import error_in_options
from crankpin.cli.options import option
from matplotlib import pyplot as plt
from support import DATA, in_turn

IJESC = [
    "ijesc-v6-1-3-5-2-4-6",
    "ijesc-v6-1-4-5-2-3-6",
    "ijesc-v6-1-6-5-4-3-2",
    "ijesc-v6-1-5-3-6-2-4",
]
IJESC_SPECTRUM = {1: 1.487 * 0.045, 2: 1.487 * 0.045**2 / 0.158}
BANK_ANGLES = np.arange(10.0, 171.0, 10.0)
CAPTURE = pytest.CaptureFixture[str]
LOADS = ("crankpin: without gas pressure", "crankpin: gas: ", "crankpin: spectrum given")


def printed(capsys: CAPTURE, *argv: str) -> str:
    """What a run that succeeds prints."""
    assert main(argv) == 0
    out, err = capsys.readouterr()
    # Beside CSV, which has no place for it, the loads counted.
    assert err == "" or ("--csv" in argv and err.startswith(LOADS) and err.count("\n") == 1)
    return out


def refused(capsys: CAPTURE, *argv: str) -> str:
    """What a run that fails says, one line."""
    assert main(argv) == 2
    out, err = capsys.readouterr()
    assert out == ""
    (line,) = err.splitlines()
    assert len(line) < 500
    start = "crankpin: error: "
    assert line.startswith(start)
    return line.removeprefix(start)


def numbers(text: str, labels: int = 1) -> tuple[list[str], list[list[str]], np.ndarray]:
    """Head, labels and numbers of a CSV text."""
    head, *rows = csv.reader(io.StringIO(text))
    return head, [row[:labels] for row in rows], np.array([row[labels:] for row in rows], float)


@pytest.fixture(autouse=True)
def _agg() -> None:
    mpl.use("agg")


# --- presets ------------------------------------------------------------------------------------


def test_presets_lists_all(capsys: CAPTURE) -> None:
    lines = printed(capsys, "presets").splitlines()
    assert " ".join(lines[1].split()) == "name cylinders bank angle ° firing order description"
    assert [line.split()[0] for line in lines[2:]] == list(cp.presets())
    head, *rows = csv.reader(io.StringIO(printed(capsys, "presets", "--csv")))
    assert head == ["name", "cylinders", "bank angle °", "firing order", "description"]
    assert {row[0]: row[-1] for row in rows} == dict(cp.presets().descriptions)
    assert ["v8-crossplane", "8", "90", "1-8-4-3-6-5-7-2"] in [row[:4] for row in rows]


# --- balance ------------------------------------------------------------------------------------


def test_balance_csv_is_the_library_s_numbers(capsys: CAPTURE) -> None:
    b = cp.Engine.preset("v6-60").balance(4321.0, orders=(1, 2, 4))
    head, orders, values = numbers(
        printed(capsys, "balance", "v6-60", "--rpm", "4321", "--orders", "1,2,4", "--csv")
    )
    assert head == ["order", "|F_x| N", "|F_y| N", "|M_x| N·m", "|M_y| N·m", "|M_z| N·m"]
    assert orders == [["1"], ["2"], ["4"], ["all"]]
    expected = np.hstack([b.force.peak_xy, b.moment.peak_xy, b.torque.peak[:, None]])
    together = [*b.total.force.peak_xy, *b.total.moment.peak_xy, b.total.torque.peak]
    expected = np.vstack([expected, together])
    np.testing.assert_array_equal(values, expected)
    assert values.any()


def test_balance_prints_what_python_prints(capsys: CAPTURE) -> None:
    text = printed(capsys, "balance", "v8-crossplane")
    balance = cp.Engine.preset("v8-crossplane").balance(3000)
    assert text.startswith(repr(balance) + "\nOmitted orders add at most ")
    text = printed(capsys, "balance", "v8-crossplane", "--orders", "1,2,4")
    assert text == repr(cp.Engine.preset("v8-crossplane").balance(3000, orders=[1, 2, 4])) + "\n"


def test_explain_prints_a_sentence_a_line(capsys: CAPTURE) -> None:
    v8 = cp.Engine.preset("v8-crossplane")
    argv = ["explain", "v8-crossplane", "--rpm", "6000"]
    assert printed(capsys, *argv).splitlines() == list(v8.explain(6000).sentences)
    assert printed(capsys, "explain", "v8-crossplane") == f"{v8.explain()}\n"
    beside = printed(capsys, *argv, "--reference-z", "100", "--units", "mm")
    assert beside == f"{v8.replace(reference_z=0.1).explain(6000)}\n"


def test_many_omitted_orders_are_not_all_listed(capsys: CAPTURE) -> None:
    text = printed(capsys, "torque", "i4", "--bore", "86mm")
    assert re.search(r"omitted: 26, 28, 30, …, \d+\.$", text)


@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_balance_reads_engine_files(capsys: CAPTURE, tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"engine{suffix}"
    cp.Engine.preset("i5").save(file)
    assert printed(capsys, "balance", str(file)) == printed(capsys, "balance", "i5")


def test_balance_auto_says_what_it_left_out(capsys: CAPTURE) -> None:
    text = printed(capsys, "balance", "i4", "--orders", "auto", "--rtol", "1e-3")
    b = cp.Engine.preset("i4").balance(3000, orders="auto", rtol=1e-3)
    *table, note = text.splitlines()
    assert "\n".join(table) == repr(b)
    assert f"at most {b.error_bound['force']:.2g} N to the force" in note
    assert f"{b.error_bound['moment']:.2g} N·m to the rocking moment" in note
    assert f"omitted: {', '.join(map(str, b.omitted))}." in note
    assert b.omitted
    assert "mitted" not in printed(capsys, "balance", "i4", "--orders", "auto", "--csv")


def test_sweep_auto_says_what_it_left_out(capsys: CAPTURE) -> None:
    argv = ["sweep", "i4", "--rod-ratio", "0.25,0.3", "--orders", "auto", "--rtol", "1e-3"]
    table, note = printed(capsys, *argv).rstrip("\n").rsplit("\n", 1)
    i4 = cp.Engine.preset("i4")
    s = cp.sweep(i4, rpm=3000, rod_ratio=[0.25, 0.3], orders="auto", rtol=1e-3)
    assert all(f"order {n}" in table for n in s.orders)
    assert f"at most {s.error_bound['force']:.2g} N to the force" in note
    assert f"omitted: {', '.join(map(str, s.omitted))}." in note
    assert s.omitted
    assert "mitted" not in printed(capsys, *argv, "--csv")


def test_rank_and_tolerances_take_a_tolerance_of_orders(capsys: CAPTURE) -> None:
    i4, loose = cp.Engine.preset("i4"), ["i4", "--rtol", "1e-2", "--csv"]
    ranking = cp.rank(i4, 3000, by="total.force.peak", rtol=1e-2)
    out = printed(capsys, "rank", *loose, "--by", "total.force.peak")
    assert out == ranking.table.to_csv()
    assert ranking[0].value != cp.rank(i4, 3000, by="total.force.peak")[0].value
    spread = cp.tolerances(i4, 3000, reciprocating_mass=0.001, samples=20, rtol=1e-2)
    out = printed(capsys, "tolerances", *loose, "--reciprocating-mass", "1g", "--samples", "20")
    assert out == spread.table.to_csv()


def test_balance_takes_spectrum_and_reference_plane(capsys: CAPTURE) -> None:
    argv = ["balance", "i3-ebook", "--rpm", "10", "--orders", "1,2", "--csv"]
    argv += ["--spectrum", "1=9.0,2=3.75", "--reference-z", "-0.25"]
    head, _, values = numbers(printed(capsys, *argv))
    b = (
        cp.Engine.preset("i3-ebook")
        .replace(reference_z=-0.25)
        .balance(10, orders=(1, 2), spectrum={1: 9.0, 2: 3.75})
    )
    assert len(head) == 5  # a spectrum tells nothing of torque
    np.testing.assert_array_equal(values[:-1], np.hstack([b.force.peak_xy, b.moment.peak_xy]))


def test_reference_plane_matters_where_a_force_is_left(capsys: CAPTURE) -> None:
    argv = ["balance", "i4", "--orders", "2", "--csv"]
    _, _, middle = numbers(printed(capsys, *argv))
    _, _, front = numbers(printed(capsys, *argv, "--reference-z", "0"))
    assert middle[0, 2] == 0.0
    assert (
        front[0, 2]
        == cp.Engine.preset("i4")
        .replace(reference_z=0.0)
        .balance(3000, orders=2)
        .moment.peak_xy[0, 0]
    )
    assert front[0, 2] > 0.0


def test_balance_is_about_the_point_that_is_typed(capsys: CAPTURE, tmp_path: Path) -> None:
    path = tmp_path / "boxer.toml"
    cp.Engine.preset("single").save(path)
    argv = ["balance", str(path), "--orders", "1,2", "--csv", "--about"]
    whole = cp.Engine.load(path).balance(3000, orders=(1, 2))
    for typed, point in (("100mm,-200mm,300mm", (0.1, -0.2, 0.3)), ("0.3", 0.3)):
        moved = whole.about(point)
        _, _, values = numbers(printed(capsys, *argv, typed))
        found = np.hstack([moved.force.peak_xy, moved.moment.peak_xy, moved.torque.peak[:, None]])
        np.testing.assert_array_equal(values[:-1], found)
    assert main([*argv, "1,2"]) == 2
    assert "--about = 1,2: give X,Y,Z or Z, m" in capsys.readouterr().err


# --- sweep --------------------------------------------------------------------------------------


def test_sweep_of_a_family_is_the_library_s_numbers(capsys: CAPTURE) -> None:
    text = printed(capsys, "sweep", "ijesc-v6", "--rpm", "5000", "--orders", "1,2", "--csv")
    head, labels, values = numbers(text, labels=2)
    engines = [cp.Engine.preset(name) for name in IJESC]
    s = cp.sweep(engines, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="pins", orders=[1, 2])
    assert head == [
        "engine",
        "bank angle °",
        "|M_x| order 1 N·m",
        "|M_y| order 1 N·m",
        "|M_x| order 2 N·m",
        "|M_y| order 2 N·m",
    ]
    np.testing.assert_array_equal(values.reshape(4, 17, 2, 2), s.moment.peak_xy)
    assert labels == [[engine.name, str(angle)] for engine in engines for angle in BANK_ANGLES]


def test_sweep_prints_the_tables_of_the_ijesc_paper(capsys: CAPTURE) -> None:
    """Tables I to IV, where they have no misprint: to the second decimal, one table each."""
    spectrum = ",".join(f"{order}={amplitude!r}" for order, amplitude in IJESC_SPECTRUM.items())
    argv = ["sweep", "ijesc-v6", "--rpm", "5000", "--orders", "1,2", "--spectrum", spectrum]
    text = printed(capsys, *argv)
    tables = text.split("\n\n")
    assert len(tables) == 4
    ours = {}
    for name, table in zip(IJESC, tables, strict=True):
        title, _, *rows = table.splitlines()
        assert name.removeprefix("ijesc-v6-") in title
        assert "peaks of rocking moment, 5000 rpm, pins held" in title
        assert "60°" not in title  # the angle that the engine had before the sweep
        for angle, *peaks in (line.split() for line in rows):
            ours[name.removeprefix("ijesc-v6-"), angle] = peaks
    with (DATA / "v6_moment_tables.csv").open(newline="") as file:
        paper = [row for row in csv.DictReader(file) if not row["erratum"]]
    assert len(ours) == 68
    assert len(paper) > 60
    for row in paper:
        read = np.array(ours[row["firing_order"], row["bank_angle_deg"]], dtype=float)
        expected = [float(row[column]) for column in ("m_px", "m_py", "m_sx", "m_sy")]
        # Half a unit of the second decimal in the paper and in our table, and rounding of both.
        np.testing.assert_allclose(read, expected, rtol=0, atol=0.010001)


def test_sweep_holds_pins_unless_told_otherwise(capsys: CAPTURE) -> None:
    v6 = cp.Engine.preset("v6-60")
    argv = ["sweep", "v6-60", "--bank-angle", "60:90:15", "--orders", "1"]
    for hold, more in (
        ("pins", []),
        ("pins", ["--hold", "pins"]),
        ("firing", ["--hold", "firing"]),
    ):
        text = printed(capsys, *argv, *more)
        words = {"pins": "pins held", "firing": "top dead centres held"}[hold]
        assert f"{words} as the bank angle changes" in text.splitlines()[0]
        _, _, values = numbers(printed(capsys, *argv, *more, "--csv"))
        s = cp.sweep(v6, rpm=3000, bank_angle_deg=[60, 75, 90], hold=hold, orders=[1])  # type: ignore[arg-type]
        np.testing.assert_array_equal(values, s.moment.peak_xy[:, 0])


@pytest.mark.parametrize("quantity", ["force", "moment", "torque", "crank_torque"])
def test_sweep_of_several_things(capsys: CAPTURE, quantity: str) -> None:
    argv = ["sweep", "i4", "--rod-ratio", "0.2:0.4:0.1", "--pin-offset=-0.002,0.002"]
    argv += ["--rpm", "1000,2000", "--orders", "2,3", "--quantity", quantity]
    head, labels, values = numbers(printed(capsys, *argv, "--csv"), labels=3)
    s = cp.sweep(
        cp.Engine.preset("i4"),
        rpm=[1000, 2000],
        rod_ratio=[0.2, 0.3, 0.4],
        pin_offset=[-0.002, 0.002],
        orders=[2, 3],
    )
    found = getattr(s, quantity)
    peaks = found.peak if quantity.endswith("torque") else found.peak_xy
    np.testing.assert_array_equal(values, peaks.reshape(12, -1))
    assert values.any() == (quantity != "moment")  # an inline-4 has no rocking moment
    assert head[:3] == ["rod ratio", "pin offset m", "rpm"]
    assert labels[:3] == [
        ["0.2", "-0.002", "1000.0"],
        ["0.2", "-0.002", "2000.0"],
        ["0.2", "0.002", "1000.0"],
    ]
    first = {
        "force": "|F_x| order 2 N",
        "moment": "|M_x| order 2 N·m",
        "torque": "|M_z| order 2 N·m",
        "crank_torque": "|T| order 2 N·m",
    }
    assert head[3] == first[quantity]
    assert "held" not in printed(capsys, *argv)


def test_engines_alone_are_compared_in_one_table(capsys: CAPTURE) -> None:
    argv = ["sweep", "i4", "v6-60", "--orders", "2", "--quantity", "force"]
    title, head, *rows = printed(capsys, *argv).splitlines()
    assert title == "Peaks of shaking force, 3000 rpm"
    assert head.split() == ["engine", "|F_x|", "order", "2", "N", "|F_y|", "order", "2", "N"]
    assert [re.split(r"\s{2,}", row)[0] for row in rows] == [
        cp.Engine.preset("i4").name,
        cp.Engine.preset("v6-60").name,
    ]
    _, _, values = numbers(printed(capsys, *argv, "--csv"))
    expected = [
        cp.Engine.preset(name).balance(3000, orders=2).force.peak_xy[0] for name in ("i4", "v6-60")
    ]
    np.testing.assert_array_equal(values, expected)


def test_engines_of_one_name_are_told_apart_by_what_was_typed(
    capsys: CAPTURE, tmp_path: Path
) -> None:
    files = [str(tmp_path / f"{k}.toml") for k in (1, 2)]
    for file, spacing in zip(files, (0.1, 0.2), strict=True):
        cp.Engine.preset("i3", spacing=spacing).save(file)
    _, labels, values = numbers(printed(capsys, "sweep", *files, "--orders", "1", "--csv"))
    assert [label for (label,) in labels] == files
    np.testing.assert_allclose(values[1], 2 * values[0], rtol=1e-15)


def test_sweep_passes_reference_plane_and_says_so(capsys: CAPTURE) -> None:
    argv = ["sweep", "i4", "--rpm", "1000,2000", "--orders", "2", "--reference-z", "0.05"]
    assert ", about z = 0.05 m" in printed(capsys, *argv).splitlines()[0]
    _, _, values = numbers(printed(capsys, *argv, "--csv"))
    s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[2]).about(0.05)
    np.testing.assert_array_equal(values, s.moment.peak_xy[:, 0])
    assert values[:, 0].all()


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("60", 60.0),
        (" 0.3 ", 0.3),
        ("60,75", [60.0, 75.0]),
        ("60,", None),
        ("10:170:80", [10.0, 90.0, 170.0]),
        ("0.2:0.4:0.1", [0.2, 0.3, 0.4]),  # in floats 0.2 + 0.1 is 0.30000000000000004
        ("0:1:0.4", [0.0, 0.4, 0.8]),
        ("90:60:-15", [90.0, 75.0, 60.0]),
        ("60:60:1", [60.0]),
        ("-1e-3:1e-3:1e-3", [-0.001, 0.0, 0.001]),
        ("1:2", None),
        ("1:2:3:4", None),
        ("1:2:0", None),
        ("1:2:-1", None),
        ("1:2:1e-400", None),
        ("1:inf:1", None),
        ("nan:2:1", None),
        ("1e999999999:2:1", None),
        ("a", None),
        ("", None),
    ],
)
def test_ranges(text: str, values: float | list[float] | None) -> None:
    if values is None:
        with pytest.raises(cp.InputError, match=r"^--x = "):
            Given(Namespace(x=text)).range("--x")
    else:
        result: Any = Given(Namespace(x=text)).range("--x")
        assert np.ndim(result) == np.ndim(values)
        np.testing.assert_array_equal(result, values)


# --- rank ---------------------------------------------------------------------------------------


def test_rank_csv_is_the_library_s_choice(capsys: CAPTURE) -> None:
    by = ["[1].moment.backward", "[2].moment.peak"]
    argv = ["rank", "ijesc-v6", "--rpm", "5000", "--by", ",".join(by), "--reference-z", "0"]
    argv += [
        "--bank-angle",
        "10:170:10",
        "--orders",
        "1,2",
        "--spectrum",
        "1=0.0669,2=0.0191",
        "--refine",
    ]
    known = [cp.Engine.preset(name) for name in IJESC]
    engines = {each.name: each.replace(reference_z=0.0) for each in known}
    for hold in ("pins", "firing"):
        how: dict[str, Any] = {"hold": hold, "refine": True, "orders": [1, 2]}
        how |= {"spectrum": {1: 0.0669, 2: 0.0191}, "bank_angle_deg": BANK_ANGLES}
        ranking = cp.rank(engines, rpm=5000, by=by, **how)
        out = printed(capsys, *argv, "--hold", hold, "--csv")
        head, labels, values = numbers(out, labels=3)
        words = ["order-1 rocking moment, backward N·m", "order-2 rocking moment N·m"]
        assert head == ["place", "engine", "bank angle °", *words]
        np.testing.assert_array_equal(values, [choice.values for choice in ranking])
        assert [(int(place), name) for place, name, _ in labels] == [
            (choice.place, choice.name) for choice in ranking
        ]
        # Angles are printed to eight digits.
        told = [[float(angle) for angle in angles.split(", ")] for _, _, angles in labels]
        for mine, choice in zip(told, ranking, strict=True):
            assert mine == pytest.approx(list(choice.bank_angles_deg), rel=1e-7)


def test_rank_of_engines_as_they_are(capsys: CAPTURE) -> None:
    out = printed(capsys, "rank", "i4", "i6", "--bank-angle", "own", "--by", "[2].force.peak")
    title, _, first, last = out.splitlines()
    assert title == "Ranked by longest shaking force, order 2, 3000 rpm"
    assert first.split() == ["1", "Inline-6", "–", "0"]
    assert last.split()[:3] == ["2", "Inline-4", "–"]


# --- pictures -----------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("suffix", "start"),
    [(".png", b"\x89PNG"), (".pdf", b"%PDF"), (".svg", b"<?xml"), (".PNG", b"\x89PNG")],
)
@pytest.mark.parametrize("argv", [["balance", "v6-60"], ["sweep", "ijesc-v6"]], ids=lambda a: a[0])
def test_pictures_are_written_and_closed(
    capsys: CAPTURE, tmp_path: Path, argv: list[str], suffix: str, start: bytes
) -> None:
    file = tmp_path / f"picture{suffix}"
    before = plt.get_fignums()
    assert printed(capsys, *argv, "--plot", str(file)) == printed(capsys, *argv)
    assert file.read_bytes().startswith(start)
    assert plt.get_fignums() == before


def test_engines_without_levers_are_swept_for_force(capsys: CAPTURE) -> None:
    argv = ["sweep", "v-twin-90", "--bank-angle", "45,90", "--orders", "1", "--csv"]
    head, _, values = numbers(printed(capsys, *argv))
    assert head == ["bank angle °", "|F_x| order 1 N", "|F_y| order 1 N"]
    assert values.any()
    assert printed(capsys, *argv, "--quantity", "force") == printed(capsys, *argv)
    assert "|M_x|" in printed(capsys, "sweep", "v-twin-90", "v6-60", "--orders", "1")


def test_half_orders_without_gas_pressure_are_explained(capsys: CAPTURE, tmp_path: Path) -> None:
    note = "Half orders are those of gas pressure, which this engine lacks: try crankpin torque.\n"
    assert printed(capsys, "balance", "i4", "--orders", "0.5,1").endswith(note)
    assert note not in printed(capsys, "balance", "i4", "--orders", "1,2")
    assert note not in printed(capsys, "balance", "i4", "--orders", "0.5", "--csv")
    file = tmp_path / "fired.toml"
    cp.Engine.preset("i4").with_cycle(cp.Cycle.example()).save(file)
    assert note not in printed(capsys, "balance", str(file), "--orders", "0.5")


def test_a_picture_shows_the_quantity_asked_for(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "picture.svg"
    with mpl.rc_context({"svg.fonttype": "none"}):
        printed(
            capsys,
            "sweep",
            "i4",
            "--rpm",
            "1000:3000:500",
            "--quantity",
            "force",
            "--plot",
            str(file),
        )
    assert "peak, N<" in file.read_text(encoding="utf-8")
    with mpl.rc_context({"svg.fonttype": "none"}):
        printed(capsys, "balance", "i4", "--quantity", "torque", "--plot", str(file))
    assert "peak roll torque, N·m" in file.read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_picture_that_cannot_be_written_leaves_no_figure(capsys: CAPTURE, tmp_path: Path) -> None:
    before = plt.get_fignums()
    missing = tmp_path / "missing" / "picture.png"
    assert str(missing) in refused(capsys, "sweep", "ijesc-v6", "--plot", str(missing))
    assert plt.get_fignums() == before


# --- units ----------------------------------------------------------------------------------------


@in_turn(
    ("text", "unit", "value"),
    [
        ("0.086", "m", 0.086),
        ("86mm", "m", 0.086),
        ("86 mm", "m", 0.086),
        ("-8.6e1mm", "m", -0.086),
        ("3.4in", "m", 0.08636),
        ("480g", "kg", 0.48),
        ("2oz", "kg", 0.05669904625),
        ("0.2lb", "kg", 0.090718474),
        ("180g·mm", "kg·m", 0.00018),
        ("180g*mm", "kg·m", 0.00018),
        ("180gmm", "kg·m", 0.00018),
        ("1oz·in", "kg·m", 0.000720077887375),
        ('1 1/2"', "m", 0.0381),
        ("7/16 in", "m", 0.0111125),
        ('3-7/16"', "m", 0.0873125),
        ("3 - 7/16in", "m", 0.0873125),
        ('3½"', "m", 0.0889),
        ("⅞in", "m", 0.022225),
        ("-1/4in", "m", -0.00635),
        ("1/3ft", "m", 0.1016),
        ("1 1/2 lb", "kg", 0.680388555),
        ("5 3/4 oz·in", "kg·m", 0.00414044785240625),
        ("1/2", "m", 0.5),
        ("52%", "", 0.52),
        ("90°", "°", 90.0),
        ("6000rpm", "rpm", 6000.0),
        ("86kg", "m", None),
        ("86mm", "kg", None),
        ("52%", "m", None),
        ("mm", "m", None),
        ("8 6mm", "m", None),
        ("3 7/16", "°", None),
        ("1/0in", "m", None),
        ("1/2/3in", "m", None),
        ("3 7/16kg", "m", None),
        ("1.5 1/2in", "m", None),
    ],
)
def test_numbers_with_units(text: str, unit: str, value: float | None) -> None:
    given = Given(Namespace(x=text))
    if value is None:
        with pytest.raises(cp.InputError, match=rf"^--x = {re.escape(text)}: give a number"):
            given.number("--x", unit)
    else:
        assert given.number("--x", unit) == value  # decimals are exact before they are floats


def test_plain_numbers_are_in_the_units_asked_for(capsys: CAPTURE) -> None:
    given = Given(Namespace(x="86", units="g,mm"))
    assert [given.number("--x", unit) for unit in ("m", "kg", "kg·m", "°", "")] == [
        0.086, 0.086, 0.000086, 86.0, 86.0,
    ]  # fmt: skip
    typed = ["bob-weight", "v8-crossplane", "--oil"]
    in_grams = printed(capsys, *typed, "4", "--units", "g")
    assert in_grams == printed(capsys, *typed, "0.004kg", "--units", "g")
    assert printed(capsys, *typed, "4g") == printed(capsys, *typed, "0.004")
    planes, in_mm = ["counterweights", "v6-90", "--planes"], ["--units", "mm"]
    assert printed(capsys, *planes, "0,200", *in_mm) == printed(capsys, *planes, "0,0.2m", *in_mm)


def test_rank_of_engines_with_and_without_banks(capsys: CAPTURE) -> None:
    ranking = cp.rank(
        [cp.Engine.preset("i4"), cp.Engine.preset("v6-60")], rpm=3000, by="total.moment.peak"
    )
    assert printed(capsys, "rank", "i4", "v6-60") == f"{ranking.table.text()}\n"


def test_control_characters_do_not_reach_the_terminal(capsys: CAPTURE, tmp_path: Path) -> None:
    """A name may set colours, move the cursor, or retitle the window (OSC)."""
    name = "red \x1b[31m\x1b]0;title\x07 \x9b2J engine\r\nnext"
    shaft = cp.Shaft(2, [], name=name)
    engine = cp.Engine.preset("i4").replace(name=name, source=name, shafts=[shaft])
    file = tmp_path / "engine.toml"
    engine.save(file)
    texts = [repr(engine), repr(engine.balance(3000))]
    texts += [
        printed(capsys, *argv.split())
        for argv in (
            f"balance {file}",
            f"firing {file} --all",
            f"rank {file} i4",
            f"sweep {file} i4",
        )
    ]
    texts.append(refused(capsys, "balance", "\x1b[2Jno"))
    for text in texts:
        assert not [c for c in text if not c.isprintable() and c != "\n"], text


# --- what goes wrong ----------------------------------------------------------------------------


@in_turn(
    ("argv", "said"),
    [
        ("balance v8-crosplane", "v8-crossplane"),
        ("balance ijesc-v6", "balance takes one engine of ijesc-v6-1-3-5-2-4-6, "),
        ("balance missing.toml", "missing.toml"),
        ("balance i4 --rpm fast", "--rpm = fast: give a number"),
        ("balance i4 --rpm inf", "--rpm = inf: give a finite number"),
        ("balance i4 --rpm 1e999999999", "give a finite number"),
        ("balance i4 --rpm -5", "--rpm = -5: give zero or more; the crank turns counter-clockwise"),
        ("balance i4 --orders 1,x", "--orders = 1,x: give multiples of crank speed"),
        ("balance i4 --orders 1.25", "--orders = 1.25: give multiples of crank speed"),
        ("balance i4 --orders 0", "orders"),
        ("balance i4 --orders 1,2 --rtol 1e-3", "--rtol = 1e-3: needs --orders auto"),
        ("balance i4 --reference-z front", "--reference-z = front"),
        ("balance i4 --spectrum 9.0", "--spectrum = 9.0: give order=amplitude"),
        ("balance i4 --spectrum 1=9.0,1=8.0", "order 1 is given twice"),
        ("balance i4 --spectrum 0=9.0", "--spectrum = 0=9.0"),
        ("balance i4 --spectrum 1=much", "give a number"),
        ("balance i4 --plot picture.bmp", "a picture's name ends in .pdf, .png, .svg"),
        ("balance i4 --quantity torque --spectrum 1=9.0 --plot picture.png", "torque"),
        ("sweep i4", "nothing to sweep"),
        ("sweep i4 --rpm 2000", "nothing to sweep"),
        ("sweep i4 --bank-angle 10:170:10", "bank"),
        ("sweep v6-60 --bank-angle 0:180:1e-12", "1.8e+14 steps; give 1000000 at most"),
        ("sweep v6-60 --bank-angle 0:180:0.1 --rpm 1:1000:1", "1801000 points to sweep"),
        ("sweep v6-60 --bank-angle 10:170:-10", "the step does not lead from 10 to 170"),
        ("sweep v6-60 --bank-angle 10:170", "give START:STOP:STEP"),
        ("sweep v6-60 --bank-angle 10:190:10", "--bank-angle = 190.0"),
        ("sweep v6-60 --rod-ratio 0.5:1.5:0.5", "--rod-ratio = 1.0: give"),
        ("sweep v6-60 --hold nothing", "--hold"),
        ("sweep v6-60 --orders 1 --rtol 1e-3", "--rtol = 1e-3: needs --orders auto"),
        ("balance i4 --rpm sNaN", "--rpm = sNaN: give a finite number"),
        ("balance i4 --rpm " + "9" * 100_000, "--rpm = 999999"),
        ("sweep i4 --rpm 1:" + "x" * 100_000 + ":1", "give a number"),
        ("balance i4 --spectrum 1=" + "x" * 100_000, "--spectrum = xxx"),
        ("balance i4 --orders " + "x" * 100_000, "--orders = xxx"),
        ("balance i4 --plot " + "x" * 100_000, "--plot = xxx"),
        ("balance " + "x" * 100_000, "no such preset"),
        ("balance inline-4", 'did you mean "i4"?'),
        ("balance v6", "balance takes one engine of v6-60, v6-90, v6-90-odd-fire, v6-120"),
        ("rank v6-60 --orders all", "--orders = all"),
        ("rank v6-60 --by shake", "--by = shake: give"),
        ("rank v6-60 --orders 1,2 --by [3].moment.peak", "by = "),
        ("rank v6-60 --bank-angle own --refine", "--refine is set: searches between"),
        ("rank v6-60 v6-90 --bank-angle 0:180:0.0002", "1800002 points to rank"),
        ("rank i4 --bank-angle 60", "bank"),
        ("balance i4 --rpm=--", "--rpm = --: give a value"),
        ("balance i4 --rpm 60mm", "--rpm = 60mm: give a number"),
        ("balance i4 --reference-z 3kg", "give a number, such as 12 or with a unit (mm, in)"),
        ("balance i4 --reference-z 3 --units g,cubit", "--units = 'g,cubit': give units of mass"),
        ("sweep v6-60 --bank-angle 10-170", "such as 10:170:10"),
        ("sweep v6-60 --rod-ratio 0.25..0.3", "such as 0.25:0.3:0.01"),
        ("sweep v6-60 --rpm 1000-6000", "such as 1000:6000:1000"),
        ("counterweights i3 --planes -0.1,0.4", "begins with a minus as --planes=-"),
        ("firing i4 --firing-order 1-3-4", "--firing-order = 1-3-4: 2 is missing"),
        ("view i4 -o i4.txt", "--out = i4.txt: a page ends in .html"),
        ("sweep v-twin-90 --bank-angle 45", "nothing to sweep: all options have one value; give"),
        ("bob-weight harley", 'NAME = "harley": no such preset; crankpin new makes engines'),
        ("tolerances v6-60", "no part deviates; give a spread, --reciprocating-mass, "),
        ("rank v6-60 --plot picture.bmp", "a picture's name ends in"),
        ("sweep", "NAME"),
        ("presets v6-60", "unrecognized arguments: v6-60"),
        ("shake", "COMMAND = shake: no such command; see crankpin --help"),
        ("blance i4", 'COMMAND = blance: no such command; did you mean "balance"?'),
        ("balance i4 --rpn 3000", 'unrecognized arguments: --rpn 3000; did you mean "--rpm"?'),
        ("new v6 --bankangle=90", '--bankangle=90; did you mean "--bank-angle"?'),
        ("balance i4 --much", "unrecognized arguments: --much; see crankpin balance --help"),
        ("sweep v6-60 --hold crank", "--hold = crank: give pins or firing; see crankpin sweep"),
        ("balance my-v6.toml", "my-v6.toml: No such file"),
        ("balance v6_90", 'NAME = "v6_90": no such preset; did you mean "v6-90"? "crankpin'),
        ("new vtwin", 'KIND = vtwin: no such layout; did you mean "v-twin"?'),
        ("", "COMMAND"),
    ],
)
def test_errors_are_one_line(
    capsys: CAPTURE, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, argv: str, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, *argv.split())
    assert not any(tmp_path.iterdir())


def test_engines_are_ranked_as_they_are_unless_angles_are_given(capsys: CAPTURE) -> None:
    ranking = cp.rank(
        {"a": cp.Engine.preset("v6-60"), "b": cp.Engine.preset("v6-120")},
        rpm=3000,
        by="total.moment.peak",
    )
    _, rows, values = numbers(printed(capsys, "rank", "v6-60", "v6-120", "--csv"), labels=3)
    np.testing.assert_array_equal(values, [choice.values for choice in ranking])
    assert sorted(angle for _, _, angle in rows) == ["120", "60"]


def test_an_error_named_as_in_a_shell_keeps_its_fields() -> None:
    hint = Hint.of('give `hold="pins"`, or `rpm=[1, 2]`; see `bank_angle`')
    options = [option("--bank-angle"), option("--hold"), option("--rpm")]
    error = error_in_options(
        inputs.rejected("bank_angle_deg[1]", 190.0, hint, AbsentItemError),
        options,
        {"bank_angle": "190", "hold": None, "rpm": None},
    )
    assert type(error) is AbsentItemError
    assert (error.argument, error.value) == ("--bank-angle[1]", "190.0")
    assert error.hint == "give --hold pins, or --rpm 1,2; see --bank-angle"
    assert str(error) == f"{error.argument} = {error.value}: {error.hint}"
    assert error_in_options(cp.InputError("a sentence"), options, {}).args == ("a sentence",)


@pytest.mark.filterwarnings("default")
def test_warnings_are_one_line(capsys: CAPTURE) -> None:
    assert main(["balance", "i4-ebook", "--rpm", "3000"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(cp.Engine.preset("i4-ebook").name)
    (line,) = err.splitlines()
    assert line.startswith("crankpin: warning: mean piston speed")


PLAIN = " plain numbers are metres and kilograms; type units, such as 86mm or 480g"


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(
    ("argv", "said"),
    [
        (
            "bob-weight v8-crossplane --reciprocating-mass 620 --rotating-mass 550",
            "--reciprocating-mass = 620 kg at a crank radius of 0.043 m: was it given in grams?"
            + PLAIN,
        ),
        (
            "new i4 --bore 86mm --stroke 86mm --rod-length 145mm --piston-mass 400 --rod-mass 500g",
            "reciprocating_mass = 400.167 kg at a crank radius of 0.043 m: was it given in grams?"
            + PLAIN,
        ),
        (
            "new v-twin --bank-angle 0.785",
            "--bank-angle = '0.785': was it given in radians? Angles are degrees here: 44.9772°",
        ),
    ],
)
def test_wrong_units_are_warned_of_once_in_words_of_the_shell(
    capsys: CAPTURE, argv: str, said: str
) -> None:
    assert main(argv.split()) == 0
    assert capsys.readouterr().err == f"crankpin: warning: {said}\n"


@pytest.mark.filterwarnings("default")
def test_figures_of_a_file_are_not_to_be_typed_with_units(capsys: CAPTURE, tmp_path: Path) -> None:
    text = cp.Engine.preset("i4").to_toml().replace("bore = 0.086", "bore = 86")
    (tmp_path / "i4.toml").write_text(text, encoding="utf-8")
    assert main(["balance", f"{tmp_path / 'i4.toml'}"]) == 0
    assert capsys.readouterr().err == (
        "crankpin: warning: bore = 86 m and stroke = 0.086 m: are both in metres? Lengths are "
        "metres here, masses kilograms\n"
    )


def test_other_errors_are_ours_and_stay_visible(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(cp.Engine, "balance", broken)
    with pytest.raises(ZeroDivisionError):
        main(["balance", "i4"])


def test_interrupt_is_quiet(monkeypatch: pytest.MonkeyPatch, capsys: CAPTURE) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(cp.Engine, "balance", interrupted)
    assert main(["balance", "i4"]) == 130
    assert capsys.readouterr() == ("", "")


def test_phases_are_those_of_the_phasors(capsys: CAPTURE) -> None:
    """A peak and its phase are the phasor P of Re(P·exp(inθ)), of each component."""
    for name in ("v6-90-odd-fire", "i5", "boxer-2"):
        argv = ["balance", name, "--orders", "1,2,3,4", "--phases", "--csv"]
        balance = cp.Engine.preset(name).balance(3000, orders=(1, 2, 3, 4))
        head, *rows = csv.reader(io.StringIO(printed(capsys, *argv)))
        assert head[1:5] == ["|F_x| N", "F_x phase °", "|F_y| N", "F_y phase °"]
        for order, *cells in rows[:4]:
            parts = balance[int(order)]
            phasors = [*parts.force.xy, *parts.moment.xy, parts.torque.phasor]
            for peak, phase, phasor in zip(cells[::2], cells[1::2], phasors, strict=True):
                turned = float(peak) * np.exp(1j * np.radians(float(phase or 0)))
                assert abs(turned - phasor) <= 1e-14 * abs(phasor)
                assert bool(phase) == bool(phasor)
        assert rows[4][2::2] == [""] * 5
    theta = np.arange(0.0, 360.0, 7.0)
    wave = cp.Engine.preset("v6-90-odd-fire").waveform(3000, theta, orders=(1,)).moment
    argv = ["balance", "v6-90-odd-fire", "--orders", "1", "--phases", "--csv"]
    _, first, *_ = csv.reader(io.StringIO(printed(capsys, *argv)))
    along = float(first[5]) * np.cos(np.radians(theta + float(first[6])))
    np.testing.assert_allclose(along, wave[..., 0], atol=1e-9)
    text = printed(capsys, "balance", "v6-90-odd-fire", "--phases")
    assert "Order n is peak·cos(n·θ + phase)" in text


def test_errors_name_what_a_shell_user_typed(capsys: CAPTURE) -> None:
    assert refused(capsys, "mounts", "i4").startswith("FILE = i4: an engine file ends in")
    assert refused(capsys, "mounts-fit", "i4", "--x", "1mm").startswith("FILE = i4: ")
    line = ["new", "firing-order", "--firing-order", "1-3-4-2"]
    said = refused(capsys, *line, "--odd-bank", "left")
    assert said.startswith("--odd-bank = left: needs --bank-angle; give --bank-angle")
    assert refused(capsys, *line, "--shared-pins").endswith("needs --bank-angle")


def test_a_file_behind_csv_is_answered_with_where_csv_goes(capsys: CAPTURE) -> None:
    said = refused(capsys, "balance", "i4", "--csv", "out.csv")
    assert said.endswith("--csv prints CSV, so write it to a file by: --csv > out.csv")
    assert "--csv >" not in refused(capsys, "balance", "i4", "out.csv")


# --- help ---------------------------------------------------------------------------------------


def test_version(capsys: CAPTURE) -> None:
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["--version"])
    assert capsys.readouterr().out == f"crankpin {cp.__version__}\n"


@pytest.mark.slow
def test_the_help_lists_every_command() -> None:
    assert sorted(cli.ORDER) == sorted(cli.registered())


@pytest.mark.parametrize("command", [[], *([name] for name in cli.registered())])
def test_examples_of_help_run(
    capsys: CAPTURE, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, command: list[str]
) -> None:
    with pytest.raises(SystemExit, match=r"^0$"):
        main([*command, "--help"])
    (example,) = re.findall(r"example:\n  crankpin (.*)\n", capsys.readouterr().out)
    monkeypatch.chdir(tmp_path)
    body = cp.RigidBody(mass=150, cg=(0, 0, 0.15), inertia=(7, 8, 4.5))
    places = {"left": (-0.3, 0, 0), "right": (0.3, 0, 0), "rear": (0, 0, 0.5)}
    mounts = [cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1) for name, at in places.items()]
    cp.Powertrain(cp.Engine.preset("i4"), body, mounts).save("car.toml")
    theta = np.arange(-360.0, 360.0)
    bar = cp.Cycle.example().pressure_at(theta) / 1e5
    np.savetxt("run7.csv", np.c_[theta, bar], header="angle [deg] absolute pressure [bar]")
    assert printed(capsys, *example.split())
    Path("car.toml").unlink()
    Path("run7.csv").unlink()
    written = re.findall(r"(?:--plot|--save|--out|-o) (\S+)", example)
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(written)


# --- as a program -------------------------------------------------------------------------------


# Python holds back what it prints, unless told otherwise as in many a container.
BUFFERED = {"PYTHONUNBUFFERED": ""}


def program(*argv: str, **environment: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(  # noqa: S603 - our own program
        [sys.executable, "-m", "crankpin", *argv],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=os.environ | BUFFERED | environment,
    )


@pytest.mark.slow
def test_runs_as_a_module(capsys: CAPTURE, tmp_path: Path) -> None:
    file = tmp_path / "v6.png"
    argv = ["sweep", "v6-60", "--plot", str(file)]
    with program(*argv, PYTHONUTF8="1", MPLBACKEND="module://no_window") as run:
        out, err = run.communicate()
    assert (run.returncode, err) == (0, b"")
    assert out.decode().replace("\r\n", "\n") == printed(capsys, *argv)
    assert file.read_bytes().startswith(b"\x89PNG")


def test_exit_code_of_errors() -> None:
    with program("balance", "no-such-engine") as run:
        out, err = run.communicate()
    assert run.returncode == 2
    assert out == b""
    assert err.startswith(b"crankpin: error: ")
    assert b"Traceback" not in err


def test_terminals_without_the_letters_are_served() -> None:
    with program("balance", "i4", PYTHONIOENCODING="ascii", PYTHONUTF8="0") as run:
        out, err = run.communicate()
    assert (run.returncode, err) == (0, b"")
    assert b"N?m" in out


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="pipes break otherwise there")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_broken_pipe_is_quiet(unbuffered: str) -> None:
    argv = ["sweep", "v6-60", "--bank-angle", "0:180:0.01", "--csv"]  # more than any pipe holds
    with program(*argv, PYTHONUNBUFFERED=unbuffered) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        assert run.stdout.readline().startswith(b"bank angle")
        run.stdout.close()
        assert run.stderr.read() == b""
        assert run.wait(60) == 141


@pytest.mark.skipif(sys.platform == "win32", reason="pipes break otherwise there")
def test_pipe_that_is_broken_from_the_start_is_quiet() -> None:
    """A table so short that it is written no earlier than at the end."""
    reading, writing = os.pipe()
    os.close(reading)
    run = subprocess.run(
        [sys.executable, "-m", "crankpin", "balance", "i4"],
        stdout=writing,
        stderr=subprocess.PIPE,
        env=os.environ | BUFFERED,
        check=False,
    )
    os.close(writing)
    assert (run.returncode, run.stderr) == (141, b"")


@pytest.mark.slow
@pytest.mark.parametrize("argv", ["balance i4 --plot x.png", "sweep v6-60 --plot x.png"])
def test_without_matplotlib_tables_are_printed_and_pictures_are_refused(
    tmp_path: Path, argv: str
) -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "from crankpin.cli import main\n"
        f"assert main({argv.split()[:2]!r}) == 0\n"
        f"sys.exit(main({argv.split()!r}))"
    )
    run = subprocess.run(  # noqa: S603 - our own program
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, check=False
    )
    assert run.returncode == 2
    expected = b'crankpin: error: matplotlib is not installed: pip install "crankpin[plot]"'
    assert run.stderr.splitlines() == [expected]


# --- streams that are closed or full ------------------------------------------------------------


def shell(line: str) -> subprocess.CompletedProcess[bytes]:
    """Run a line of shell, ``crankpin`` standing for the program."""
    program_ = f"{shlex.quote(sys.executable)} -m crankpin"
    return subprocess.run(  # noqa: S602 - our own program
        line.replace("crankpin", program_),
        shell=True,
        capture_output=True,
        env=os.environ | BUFFERED,
        check=False,
    )


WARNS = "balance i4-ebook --rpm 3000"  # of a piston faster than any


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell")
@pytest.mark.parametrize("command", ["balance i4", "--version", WARNS])
def test_closed_standard_output_is_an_error_in_a_line(command: str) -> None:
    run = shell(f"crankpin {command} >&-")
    assert run.returncode == (0 if command == "--version" else 2)  # argparse prints to stderr then
    assert b"Traceback" not in run.stderr
    assert b"Exception" not in run.stderr
    if command != "--version":
        assert run.stderr.splitlines()[-1] == b"crankpin: error: standard output is closed"


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/full")
def test_full_disk_is_an_error_in_a_line() -> None:
    run = shell("crankpin balance i4 > /dev/full")
    assert run.returncode == 2
    assert run.stderr == b"crankpin: error: standard output: No space left on device\n"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell")
@pytest.mark.parametrize("closed", ["2>&-", "2>/dev/full"])
def test_warnings_do_not_land_in_the_csv(closed: str) -> None:
    if "full" in closed and sys.platform != "linux":
        pytest.skip("needs /dev/full")
    heard, deaf = (shell(f"crankpin {WARNS} --csv {end}") for end in ("", closed))
    assert b"warning" in heard.stderr
    assert b"warning" not in heard.stdout
    assert deaf.stdout == heard.stdout
    assert deaf.returncode == 0
    error = shell(f"crankpin balance nothing {closed}")
    assert (error.returncode, error.stdout) == (2, b"")


@pytest.mark.skipif(sys.platform == "win32", reason="pipes break otherwise there")
def test_help_into_a_closed_pipe_is_quiet() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    run = subprocess.run(
        [sys.executable, "-m", "crankpin", "--help"],
        stdout=writing,
        stderr=subprocess.PIPE,
        env=os.environ | BUFFERED,
        check=False,
    )
    os.close(writing)
    assert (run.returncode, run.stderr) == (141, b"")


# --- what is shown ------------------------------------------------------------------------------


def test_negligible_orders_are_left_out_of_tables_and_named(capsys: CAPTURE) -> None:
    argv = ["sweep", "ijesc-v6", "--rpm", "5000"]
    text = printed(capsys, *argv)
    s = cp.sweep(
        [cp.Engine.preset(name) for name in IJESC],
        rpm=5000,
        bank_angle_deg=BANK_ANGLES,
        hold="pins",
        orders="auto",
    )
    (note,) = re.findall(r"Not shown: orders ([\d, ]+) \(their peaks are below 1e-06", text)
    left = [int(order) for order in note.split(", ")]
    shown = {int(order) for order in re.findall(r"\|M_x\| order (\d+)", text)}
    assert sorted([*left, *shown]) == list(s.orders)
    head = printed(capsys, *argv, "--csv").splitlines()[0]
    assert {int(order) for order in re.findall(r"\|M_x\| order (\d+)", head)} == set(s.orders)
    assert "Not shown" not in printed(capsys, *argv, "--orders", "1,2,3,4,5")


def test_firing_of_the_engine_s_own_order(capsys: CAPTURE) -> None:
    own = printed(capsys, "firing", "v8-crossplane")
    assert own == printed(capsys, "firing", "v8-crossplane", "--firing-order", "1-8-4-3-6-5-7-2")
    assert "most even first" in printed(capsys, "firing", "flat-4")  # whose order is not known


def test_crankpin_is_a_command() -> None:
    text = (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    module, _, function = tomllib.loads(text)["project"]["scripts"]["crankpin"].partition(":")
    assert callable(getattr(importlib.import_module(module), function))
