"""Is every result named frames, and do all forms of a frame have the same numbers?"""

from __future__ import annotations

import csv
import io
import math
import re
from html import escape
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.frames import Framed
from crankpin._support.tables import Item
from crankpin.cli import main
from support import in_turn
from support.objects import CHARACTERS, OBJECTS, RESULTS, UNTABLED

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

every_result = in_turn("name", RESULTS)


def result_of(name: str) -> Framed:
    """The result of a name."""
    found: Framed = RESULTS[name]
    return found


def test_every_class_is_frames_or_no_table() -> None:
    classes = {type(value).__name__ for value in OBJECTS.values()}
    tabled = {type(value).__name__ for value in OBJECTS.values() if isinstance(value, Framed)}
    assert classes - tabled == UNTABLED


@every_result
def test_frames_begin_with_the_table(name: str) -> None:
    result = result_of(name)
    assert next(iter(result.frames)) == "table"
    assert result.frames["table"] == result.table
    for frame in result.frames.values():
        assert frame.loads == result.table.loads
        assert isinstance(frame, cp.results.Table)
        assert frame.columns
        assert len({len(column.values) for column in frame.columns}) == 1


@every_result
def test_text_and_html_show_every_frame_or_a_line(name: str) -> None:
    result = result_of(name)
    text, html, named = repr(result), result._repr_html_(), result.frames
    frames = [table for name, table in named.items() if name not in named.for_programs]
    for of_programs in named.for_programs:
        assert named[of_programs].title not in text
    if isinstance(result, (cp.results.ClosedForm, cp.results.Exercise, cp.results.Explanation)):
        assert text.startswith(result.table.title)  # formulas, questions, sentences
        return
    if isinstance(result, Item):  # one of many
        assert "\n" not in text
        assert html == result.table.html()
        return
    if html is None or text.startswith("<Firing"):
        assert text.startswith("<")
        return
    assert html.count("<table>") == len(frames)
    for frame in frames:
        for line in frame.text(30).splitlines()[: 2 + min(len(frame), 30)]:
            assert line in text
        assert all(f"<th>{escape(head)}</th>" in html for head in frame.header)


@every_result
def test_csv_reads_back_the_same_numbers(name: str, tmp_path: Path) -> None:
    result = result_of(name)
    for frame, table in result.frames.items():
        head, *rows = csv.reader(io.StringIO(result.to_csv(frame=frame), newline=""))
        assert head == [column.header for column in table.columns]
        assert len(rows) == len(table)
        for column, cells in zip(table.columns, zip(*rows, strict=True), strict=False):
            for cell, value in zip(cells, column.values, strict=True):
                if isinstance(value, str):
                    assert cell in (value, f"'{value}")
                elif value is None or isinstance(value, bool):
                    assert cell == ("" if value is None else str(value))
                else:
                    assert float(cell) == value or math.isnan(value)
        path = tmp_path / f"{frame}.csv"
        assert result.to_csv(path, frame=frame) is None
        assert path.read_text(encoding="utf8") == result.to_csv(frame=frame)


@every_result
def test_data_frames_and_datasets_have_the_same_numbers(name: str) -> None:
    result = result_of(name)
    for frame, table in result.frames.items():
        data, arrays = result.to_pandas(frame=frame), result.to_xarray(frame=frame)
        assert data.shape == (len(table), len(table.columns))
        assert len(arrays) == len(table.columns)
        assert data.attrs.get("loads", "") == arrays.attrs.get("loads", "") == table.loads
        for k, (variable, column) in enumerate(zip(arrays.values(), table.columns, strict=True)):
            about = {name: text for name, text in variable.attrs.items() if name != "long_name"}
            assert about == ({"units": column.unit} if column.unit else {})
            if any(isinstance(value, (str, bool)) for value in column.values):
                assert [*data.iloc[:, k]] == [*column.values]
                continue
            numbers = np.array([np.nan if each is None else each for each in column.values])
            np.testing.assert_array_equal(data.iloc[:, k].to_numpy(dtype=np.float64), numbers)
            np.testing.assert_array_equal(variable.to_numpy().astype(np.float64), numbers)


@every_result
def test_every_frame_and_every_dataset_is_written_as_netcdf_and_read_back(
    name: str, tmp_path: Path
) -> None:
    """Whatever heads and names are; complex numbers as their parts."""
    import xarray as xr

    result, path = result_of(name), tmp_path / "result.nc"
    for frame in (None, *result.frames):
        whole = result.to_xarray(frame=frame)
        dataset = result.to_xarray(frame=frame, split_complex=True)
        dataset.to_netcdf(path, engine="scipy")
        with xr.open_dataset(path, engine="scipy") as again:
            assert set(again.data_vars) == set(whole.data_vars)
            for variable, array in whole.data_vars.items():
                found = again[variable]
                assert found.attrs.get("long_name") == array.attrs.get("long_name")
                if array.dtype.kind == "c":
                    found = found.sel(part="re") + 1j * found.sel(part="im")
                if array.dtype.kind in "cfiub":
                    np.testing.assert_array_equal(found.values, array.values)


def test_names_that_netcdf_cannot_have_are_replaced_and_kept(tmp_path: Path) -> None:
    import xarray as xr

    names = ["fan 2/rev", "fan 2:rev", "fan_2_rev", "'quoted'", "ωt", "trailing ", "double"]
    loads = [cp.PeriodicLoad(name, on="block", force={1: 10.0 + 1j}) for name in names]
    balance = cp.Engine.preset("i4").with_loads(loads).balance(3000, orders=[1, 2])
    balance.to_xarray(split_complex=True).to_netcdf(tmp_path / "b.nc", engine="scipy")
    with xr.open_dataset(tmp_path / "b.nc", engine="scipy") as found:
        for name in names:
            known = [
                found[key] for key in found if found[key].attrs.get("long_name") == f"force_{name}"
            ]
            array = known[0] if known else found[f"force_{name}"]
            phasors = array.sel(part="re") + 1j * array.sel(part="im")
            np.testing.assert_array_equal(phasors, balance.force.part(name))


def tabular(latex: str) -> tuple[str, list[list[str]]]:
    """Return alignment and cells of a table, as a reader of LaTeX finds them."""
    plain = re.sub(r"\\[\\{}&%$#_]", lambda found: "  " if found[0] != r"\\" else "\n\n", latex)
    assert plain.count("{") == plain.count("}")
    assert plain.count("$") % 2 == 0
    assert not set(re.sub(r"\$[^$]*\$", "", plain)) & set("_^#%~")
    begin = latex.index(r"\begin{tabular}{") + len(r"\begin{tabular}{")
    columns = latex[begin : latex.index("}", begin)]
    body = latex[latex.index("\n", begin) : latex.index(r"\end{tabular}")]
    rules = re.findall(r"\\(?:top|mid|bottom)rule", body)
    assert rules == [r"\toprule", r"\midrule", r"\bottomrule"]
    lines = [line for line in body.splitlines() if line and not line.endswith("rule")]
    assert all(line.endswith(r" \\") for line in lines)
    return columns, [re.split(r"(?<!\\) ?& ?", line.removesuffix(r" \\")) for line in lines]


@every_result
def test_latex_has_every_cell_between_rules(name: str) -> None:
    result = result_of(name)
    for frame, table in result.frames.items():
        latex = result.to_latex(frame=frame)
        columns, (head, *rows) = tabular(latex)
        assert set(columns) <= {"l", "r"}
        assert {len(columns), len(head), len(table.columns)} == {len(columns)}
        assert len(rows) == len(table)
        for cells, texts in zip(rows, table.cells(), strict=True):
            assert len(cells) == len(columns)
            for cell, text in zip(cells, texts, strict=True):
                if re.fullmatch(r"-?[\d.]+(e[-+]\d+)?", text):
                    figure = re.sub(r" \\times 10\^\{(-?\d+)\}", r"e\1", cell.strip("$"))
                    assert float(figure) == float(text)
        assert not set(latex) & set("°·²³ωθλπ→−≠≤₂₁\t")
        assert (table.loads == "") or f"{table.loads[1:6]}" in latex


@in_turn("seed", range(30))
def test_any_text_is_escaped_in_latex(seed: int) -> None:
    rng = np.random.default_rng(seed)
    words = ["".join(rng.choice([*CHARACTERS], 12)) for _ in range(4)]
    table = cp.results.Table.from_rows(words[0], [words[1], "x"], words[2:], rng.random((2, 1)))
    columns, rows = tabular(table.to_latex())
    assert columns == "lr"
    assert [len(row) for row in rows] == [2, 2, 2]


def test_a_name_of_a_frame_that_is_not_there_names_those_that_are() -> None:
    bob = OBJECTS["BobWeight"]
    assert list(bob.frames) == ["table", "factors"]
    for call in (bob.to_csv, bob.to_latex, bob.to_pandas, bob.to_xarray):
        with pytest.raises(cp.InputError, match=r'^frame = .factor.: give "table" or'):
            call(frame="factor")
    with pytest.raises(KeyError, match="frame = 3: give"):
        bob.frames[3]
    assert "factors" in bob.frames
    assert 3 not in bob.frames


@pytest.mark.parametrize("name", ["Balance", "Sweep", "Waveform, fired", "BearingLoads"])
def test_arrays_keep_their_dimensions_unless_a_frame_is_named(name: str) -> None:
    result: Any = OBJECTS[name]
    assert "row" not in result.to_xarray().dims
    assert (
        result.to_xarray(frame="table").dims == ("row",)
        or "row" in result.to_xarray(frame="table").dims
    )
    with pytest.raises(cp.InputError, match="frame = 'nothing'"):
        result.to_xarray(frame="nothing")


@pytest.mark.parametrize(
    ("typed", "made"),
    [
        ("bob-weight v8-crossplane", cp.bob_weight),
        (
            "counterweights v8-crossplane --planes ends",
            lambda e: cp.counterweights(e, planes="ends"),
        ),
        ("bearings v8-crossplane --rpm 4000 --cycle none", lambda e: cp.bearing_loads(e, 4000)),
        ("shafts v8-crossplane --ratios=-1", lambda e: cp.balance_shafts(e, [-1])),
    ],
)
def test_the_command_line_has_every_frame(
    typed: str, made: Callable[[cp.Engine], Framed], capsys: pytest.CaptureFixture[str]
) -> None:
    result = made(cp.Engine.preset("v8-crossplane"))
    for frame, table in result.frames.items():
        for options, expected in ((["--csv"], table.to_csv()), ([], f"{table.text()}\n")):
            assert main([*typed.split(), "--frame", frame, *options]) == 0
            out, err = capsys.readouterr()
            assert out == expected
            assert err == (f"crankpin: {table.loads}\n" if options and table.loads else "")
    assert main([*typed.split(), "--frame", "tables"]) == 2
    assert "--frame = tables: give table or" in capsys.readouterr().err


@every_result
def test_exports_are_si_whatever_is_shown_and_in_units_that_are_asked(name: str) -> None:
    result, units = result_of(name), "g, mm, lbf, psi"
    plain = {frame: exports(result, frame, "") for frame in result.frames}
    with cp.units(units):
        for frame, before in plain.items():
            assert exports(result, frame, "") == before
    for frame in result.frames:
        with cp.units(units):
            table = result.frames[frame].to(units)
        shown = exports(result, frame, units)
        assert shown[0] == table.to_csv()
        assert shown[1] == [head for head, _ in table._distinct()]
        assert shown[2] == [column.unit for column in table.columns]
    whole, other = result.to_xarray(), result.to_xarray(units="mm, lbf")
    for key, variable in whole.variables.items():
        if variable.attrs.get("units") == "N":
            assert other[key].attrs["units"] == "lbf"
            np.testing.assert_allclose(other[key] * 4.4482216152605, variable, rtol=1e-12)


def exports(result: Any, frame: str, units: str) -> tuple[str, list[str], list[str]]:  # noqa: ANN401
    """CSV, and the heads and units of a data frame and a dataset."""
    data = result.to_pandas(frame=frame, units=units)
    arrays = result.to_xarray(frame=frame, units=units)
    units_of = [variable.attrs.get("units", "") for variable in arrays.values()]
    heads = [*data.columns]
    return result.to_csv(frame=frame, units=units), heads, units_of
