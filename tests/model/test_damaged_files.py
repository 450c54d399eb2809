"""Does a damaged file of pressure give the right numbers, a warning, or an error with its place?"""

# ruff: noqa: ANN401 - readers and options of any type

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import numpy as np
import pytest
from crankpin.cli import main
from crankpin.model.cycle_files import PRESSURE_UNITS
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

THETA = np.arange(-360.0, 360.0, 1.0)
RANDOM = np.random.default_rng(3)
BURNT = cp.Cycle.example().pressure_at(THETA)
MOTORED = cp.Cycle.motored(
    cp.Cylinder(0.043, 0.145, 0.5, bore=0.086), compression_ratio=10.5
).pressure_at(THETA)


def cycles(count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Cycles of one compression and combustion that varies, bar."""
    strength = np.random.default_rng(3).normal(1.0, 0.02, (count, 1))
    return np.array((MOTORED + strength * (BURNT - MOTORED)) / 1e5)


class Layout(NamedTuple):
    """Cells of a sound file, its head, and the columns with pressure of the cylinder."""

    head: list[str]
    cells: list[list[str]]
    pressures: int
    n_cycles: int


def layouts() -> dict[str, Layout]:
    angle, pressure = "crank angle [deg]", "p abs [bar]"
    one, ten = cycles(1), cycles(10)
    row = np.arange(-360.0, -360.0 + 7200.0, 1.0)

    def text(*columns: Any) -> list[list[str]]:
        return [[f"{each:.7g}" for each in cells] for cells in zip(*columns, strict=True)]

    return {
        "one": Layout([angle, pressure], text(THETA, one[0]), 1, 1),
        "columns": Layout([angle, *[pressure] * 10], text(THETA, *ten), 10, 10),
        "blocks": Layout([angle, pressure], text(np.tile(THETA, 10), ten.ravel()), 1, 10),
        "row": Layout([angle, pressure], text(row, ten.ravel()), 1, 10),
        "time": Layout(["time [ms]", pressure], text((row + 360) / 18.0, ten.ravel()), 1, 10),
    }


LAYOUTS = layouts()
AT = 400
"""Row that is damaged: 40° after the dead centre of the first cycle."""
Cells = list[list[str]]
CELLS = ["nan", "inf", "-inf", "n/a", "", "high", "1.2.3", "1e999", "--", "0x1F", "1_0"]


def in_cell(k: int, value: str) -> Callable[[Cells], Cells]:
    def damage(cells: Cells) -> Cells:
        cells[AT][k] = value
        return cells

    return damage


def spike(cells: Cells) -> Cells:
    cells[AT][1] = f"{float(cells[AT][1]) + 60.0:.7g}"
    return cells


def swapped(cells: Cells) -> Cells:
    return [[row[1], row[0], *row[2:]] for row in cells]


ROWS: dict[str, Callable[[Cells], Cells]] = {
    "swapped": swapped,
    "repeated": lambda cells: [*cells[: AT + 1], *cells[AT:]],
    "angle twice": lambda cells: [
        *cells[: AT + 1], [cells[AT][0], *cells[AT + 9][1:]], *cells[AT + 1 :]
    ],
    "reversed": lambda cells: cells[::-1],
    "two in the wrong order": lambda cells: [
        *cells[:AT], cells[AT + 1], cells[AT], *cells[AT + 2 :]
    ],
    "spike": spike,
    "gap": lambda cells: [*cells[:AT], *cells[AT + 8 :]],
    "missing tooth": lambda cells: [*cells[:AT], *cells[AT + 1 :]],
    "gap of half a cycle": lambda cells: [*cells[:AT], *cells[AT + 365 :]],
    "a cell too many": lambda cells: [*cells[:AT], [*cells[AT], "7", "8"], *cells[AT + 1 :]],
    "angle wild": in_cell(0, "5000"),
    "first angle wild": lambda cells: [["5000", *cells[0][1:]], *cells[1:]],
    "angle below": in_cell(0, "-5000"),
    "decimal comma in a line": in_cell(1, "12,5"),
    "thousands": in_cell(1, "1,234.5"),
    "end missing": lambda cells: cells[:-240],
    "sound": lambda cells: cells,
}  # fmt: skip


def write(folder: Path, layout: Layout, cells: Cells, **options: Any) -> Path:
    separator, encoding = options.get("separator", ";"), options.get("encoding", "utf-8")
    lines = [separator.join(each) for each in [layout.head, *cells]]
    if options.get("comma"):
        lines = [line.replace(".", ",") for line in lines]
    path = folder / "bench.csv"
    path.write_bytes("\n".join(lines).encode(encoding))
    return path


def options_of(layout: Layout) -> dict[str, Any]:
    return {"tdc_deg": 360.0} if layout.head[0].startswith("time") else {}


Reading = tuple[Any, Any, int]


def mean_of(cycle: cp.Cycle) -> Reading:
    return cycle.theta_deg, cycle.pressure, 1


def read_cycle(path: Path, layout: Layout) -> Reading:
    return mean_of(cp.Cycle.load(path, **options_of(layout)))


def read_traces(path: Path, layout: Layout) -> Reading:
    traces = cp.Traces.load(path, **options_of(layout))
    return traces.theta_deg, traces.pressure.mean(axis=0), len(traces)


def read_columns(path: Path, layout: Layout) -> Reading:
    columns = range(layout.pressures + 1)
    traces = cp.Traces.load(path, columns=columns, **options_of(layout))
    return traces.theta_deg, traces.pressure.mean(axis=0), len(traces)


def read_cylinders(path: Path, layout: Layout) -> Reading:
    tdc = options_of(layout).get("tdc_deg", 0.0)
    pressures = [*range(1, layout.pressures + 1)]
    (traces,) = cp.Traces.load_cylinders(path, columns=[0, pressures], tdc_deg=tdc)
    return traces.theta_deg, traces.pressure.mean(axis=0), len(traces)


READERS = (read_cycle, read_traces, read_columns, read_cylinders)


def outcome(path: Path, layout: Layout, reader: Any) -> str:
    """Return the error, the warnings, "right", or what is wrong without a word."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            theta, pressure, count = reader(path, layout)
        except cp.InputError as error:
            return f"error: {error}"
    if caught:
        return "warned: " + "; ".join(str(each.message) for each in caught)
    away = (theta + 360.0) % 720.0 - 360.0
    # Seven digits are written; a record over time is resampled; an incomplete cycle is left out.
    every = cycles(layout.n_cycles) * 1e5
    wrong = 1.0
    for whole in (every, every[:-1]):
        if len(whole) and (reader is read_cycle or count == len(whole)):
            wanted = np.interp(away, THETA, whole.mean(axis=0))
            wrong = min(wrong, abs(pressure - wanted).max() / wanted.max())
    if wrong < 1e-3:
        return "right"
    return f"SILENT: {count} cycles, {wrong:.1e} of the peak off"


def cases() -> Iterator[Any]:
    for name, layout in LAYOUTS.items():
        for column in range(min(3, layout.pressures + 1)):
            for value in CELLS:
                yield pytest.param(
                    layout, in_cell(column, value), True, id=f"{name}-{column}-{value}"
                )
        for damage, change in ROWS.items():
            yield pytest.param(layout, change, False, id=f"{name}-{damage}")


@pytest.mark.slow
@in_turn("reader", READERS)
@in_turn(("layout", "damage", "cell"), list(cases()))
def test_no_damage_is_silent(
    tmp_path: Path, layout: Layout, damage: Callable[[Cells], Cells], cell: bool, reader: Any
) -> None:
    path = write(tmp_path, layout, damage([list(row) for row in layout.cells]))
    said = outcome(path, layout, reader)
    assert not said.startswith("SILENT"), said
    if cell:
        assert f"of line {AT + 2}" in said, said
        assert "column" in said


@in_turn("reader", READERS)
@in_turn("layout", list(LAYOUTS.values()))
@in_turn("form", [
    {"encoding": "utf-8-sig"}, {"encoding": "utf-16"}, {"encoding": "utf-16-le"},
    {"encoding": "latin-1"}, {"comma": True}, {"separator": "\t"},
    {"separator": "\t", "comma": True},
    {"separator": ","}, {"separator": ",", "comma": True}, {"separator": "; "},
])  # fmt: skip
def test_forms_of_text_are_read_or_named(
    tmp_path: Path, layout: Layout, form: dict[str, Any], reader: Any
) -> None:
    said = outcome(write(tmp_path, layout, [*layout.cells], **form), layout, reader)
    ambiguous = form == {"separator": ",", "comma": True}
    assert said.startswith("error: path" if ambiguous else "right"), said


@in_turn("typed", PRESSURE_UNITS)
@in_turn("head", PRESSURE_UNITS)
def test_pressure_under_another_unit_is_never_silent(tmp_path: Path, typed: str, head: str) -> None:
    layout = LAYOUTS["one"]._replace(head=["crank angle [deg]", f"p abs [{head}]"])
    scale = 1e5 / PRESSURE_UNITS[typed]
    cells = [[angle, f"{float(p) * scale:.9g}"] for angle, p in layout.cells]
    said = outcome(write(tmp_path, layout, cells), layout, read_traces)
    same = PRESSURE_UNITS[head] == PRESSURE_UNITS[typed]
    assert said.startswith("right" if same else "warned"), said


@in_turn("reader", READERS)
@in_turn("layout", list(LAYOUTS.values()))
@pytest.mark.parametrize("head", ["crank angle [deg]", "phi [rad]", "t [s]", "t [ms]"])
def test_angles_under_another_unit_are_never_silent(
    tmp_path: Path, layout: Layout, head: str, reader: Any
) -> None:
    changed = layout._replace(head=[head, *layout.head[1:]])
    said = outcome(write(tmp_path, changed, [*layout.cells]), layout, reader)
    assert not said.startswith("SILENT"), said


SHELL = (
    ["trace", "i4", "FILE", "--bore", "86mm"],
    ["trace", "i4", "OTHER", "--bore", "86mm", "--motored", "FILE"],
    ["torque", "i4", "--rpm", "2000", "--bore", "86mm", "--cycle", "FILE"],
    ["bearings", "i4", "--rpm", "2000", "--bore", "86mm", "--cycle", "FILE"],
    ["flywheel", "i4", "--rpm", "2000", "--bore", "86mm", "--cycle", "FILE"],
)  # fmt: skip


@in_turn("command", SHELL)
@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("value", ["nan", "inf", "high", ""])
def test_the_shell_names_line_and_column(
    tmp_path: Path, capsys: Any, command: list[str], k: int, value: str
) -> None:
    layout = LAYOUTS["one"]
    other = write(tmp_path, layout, layout.cells).rename(tmp_path / "other.csv")
    path = write(tmp_path, layout, in_cell(k, value)([list(row) for row in layout.cells]))
    names = {"FILE": str(path), "OTHER": str(other)}
    assert main([names.get(each, each) for each in command]) == 2
    said = capsys.readouterr().err
    assert f"'{path.name}' has no number in column {k} of line {AT + 2}" in said, said


def test_a_short_record_over_time_is_named_by_its_file(tmp_path: Path, capsys: Any) -> None:
    layout = LAYOUTS["time"]
    path = write(tmp_path, layout, layout.cells[:720])
    assert main(["torque", "i4", "--rpm", "2000", "--bore", "86mm", "--cycle", str(path)]) == 2
    said = capsys.readouterr().err
    assert f"'{path.name}' has fewer than three cycles over time" in said
    assert "--recorded-rpm" in said


def test_gaps_and_repetitions_name_their_lines(tmp_path: Path) -> None:
    layout = LAYOUTS["blocks"]
    for damage, words in (
        ("gap", r"nothing between 39 and 48 \(lines 401 and 402\)"),
        ("missing tooth", r"nothing between 39 and 41 \(lines 401 and 402\)"),
        ("repeated", "lines twice, 403 as the one before"),
        ("angle twice", "has twice 40 in lines 402 and 403|traces.0. has a spike"),
    ):
        path = write(tmp_path, layout, ROWS[damage]([list(row) for row in layout.cells]))
        with pytest.warns(UserWarning, match=words) as caught:
            traces = cp.Traces.load(path)
        assert len(caught) == 1 + (damage == "angle twice")
        if damage != "angle twice":
            # Cubics across 9° of an expansion.
            np.testing.assert_allclose(traces.pressure[0] / 1e5, cycles(10)[0], rtol=2e-2)
            np.testing.assert_allclose(traces.pressure[1:] / 1e5, cycles(10)[1:], rtol=1e-6)


def test_columns_are_named_without_their_units(tmp_path: Path) -> None:
    layout = LAYOUTS["columns"]._replace(
        head=["Angle [deg]", "p 1 [bar abs]", "p 2 [bar abs]", *[f"q{k} [bar]" for k in range(8)]]
    )
    path = write(tmp_path, layout, layout.cells)
    two = cp.Traces.load(path, columns=("angle", "p 1", "p 2"))
    np.testing.assert_allclose(two.pressure, cycles(10)[:2] * 1e5, rtol=1e-6)
    path = write(tmp_path, LAYOUTS["columns"], layout.cells)
    with pytest.raises(cp.InputError, match=r"columns = 'p abs': there are 'p abs \[bar\]', "):
        cp.Traces.load(path, columns=("crank angle", "p abs"))


def test_four_cylinders_of_one_file_are_read_in_one_call(tmp_path: Path) -> None:
    tdc = [0.0, 540.0, 180.0, 360.0]
    every = cycles(10).mean(axis=0)
    columns = [np.roll(every, round(each)) for each in tdc]
    cells = [[f"{each:.9g}" for each in row] for row in zip(THETA, *columns, strict=True)]
    layout = Layout(["angle [deg]", *[f"p{k} abs [bar]" for k in range(1, 5)]], cells, 4, 1)
    path = write(tmp_path, layout, cells)
    four = cp.Traces.load_cylinders(
        path, columns=["angle", "p1 abs", 2, "p3 abs", ["p4 abs"]], tdc_deg=tdc
    )
    for k, traces in enumerate(four):
        at = np.interp(traces.theta_deg % 720.0, (THETA + 360) % 720, np.roll(every, -360) * 0)
        assert at.shape == traces.theta_deg.shape
        mean = traces.mean_cycle.pressure_at(THETA)
        np.testing.assert_allclose(mean, every * 1e5, rtol=1e-6)
        assert traces.name == f"bench, p{k + 1} abs [bar]"
    engine = cp.Engine.preset("i4").with_cycle([each.mean_cycle for each in four])
    assert engine.fired
    with pytest.warns(UserWarning, match="columns 2, 3, 4 are headed as pressure, but unlike"):
        assert len(cp.Traces.load(path)) == 1
    with pytest.raises(cp.InputError, match="tdc_deg has 3 angles for 4 cylinders"):
        cp.Traces.load_cylinders(path, columns=[0, 1, 2, 3, 4], tdc_deg=tdc[:3])
    with pytest.raises(cp.InputError, match=r"columns = .*give that of angle"):
        cp.Traces.load_cylinders(path, columns=[0], tdc_deg=0.0)


def test_spreadsheets_are_read_like_text(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    layout = LAYOUTS["columns"]
    book = openpyxl.Workbook()
    book.active.title = "run 7"
    book.active.append(["bench of today"])
    book.active.append(layout.head)
    for row in layout.cells:
        book.active.append([float(each) for each in row])
    book.create_sheet("notes").append(["none"])
    path = tmp_path / "bench.xlsx"
    book.save(path)
    traces = cp.Traces.load(path, sheet="run 7")
    assert traces == cp.Traces.load(write(tmp_path, layout, layout.cells))
    assert traces == cp.Traces.load(path)
    with pytest.raises(cp.InputError, match="no line of two numbers"):
        cp.Traces.load(path, sheet="notes")
    with pytest.raises(cp.InputError, match="sheet = 'run 8': give"):
        cp.Traces.load(path, sheet="run 8")
    with pytest.raises(cp.InputError, match="sheet = 'run 7': text files have none"):
        cp.Traces.load(write(tmp_path, layout, layout.cells), sheet="run 7")
    book["run 7"].cell(row=30, column=3).value = "high"
    book.save(path)
    with pytest.raises(cp.InputError, match=r"column 2 \('p abs \[bar\]'\) of line 30"):
        cp.Traces.load(path)
    for data in (b"", b"PK\x03\x04 broken", path.read_bytes()[:3000], b"\xd0\xcf\x11\xe0old"):
        path.write_bytes(data)
        with pytest.raises(cp.InputError, match="path cannot be read as a spreadsheet"):
            cp.Traces.load(path)


def test_without_openpyxl_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "openpyxl", None)
    path = tmp_path / "bench.xlsx"
    path.write_bytes(b"PK")
    with pytest.raises(
        ImportError, match=r'openpyxl is not installed: pip install "crankpin\[excel\]"'
    ):
        cp.Traces.load(path)
