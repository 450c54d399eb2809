"""Has every result, with engines and powertrains, one grammar: frames, long form, exports, picture?

Enumerated over the objects of ``support.objects`` and the public classes.
"""

from __future__ import annotations

import inspect
import math
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.frames import Framed
from support import in_turn
from support.objects import OBJECTS, RESULTS
from support.shown_units import IMPERIAL, si_units

if TYPE_CHECKING:
    from collections.abc import Iterator

plt = pytest.importorskip("matplotlib.pyplot")
from crankpin.plot.table import WITHOUT_PICTURE  # noqa: E402 - it needs matplotlib
from matplotlib.text import Text  # noqa: E402

every_name = in_turn("name", RESULTS)
GRAMMAR = (
    "frames", "table", "tidy", "to_pandas", "to_xarray", "to_csv", "to_latex", "plot",
    "_repr_html_",
)  # fmt: skip


@pytest.fixture(autouse=True)
def _no_figures() -> Iterator[None]:
    plt.switch_backend("agg")
    plt.close("all")
    yield
    plt.close("all")


def test_every_result_engine_and_powertrain_has_the_whole_grammar() -> None:
    kinds = [getattr(cp.results, name) for name in cp.results.__all__]
    for kind in (*kinds, cp.Engine, cp.Powertrain):
        assert issubclass(kind, Framed), kind
        assert [name for name in GRAMMAR if not hasattr(kind, name)] == []
        assert any(isinstance(value, kind) for value in RESULTS.values()), kind


def test_the_grammar_is_written_once() -> None:
    """A class overrides what an export of its arrays needs, and nothing else."""
    for kind in {type(value) for value in RESULTS.values()}:
        for base in kind.__mro__[:-1]:
            if base is not Framed and base.__module__.startswith("crankpin"):
                own = {*vars(base)} & {"to_pandas", "to_csv", "to_latex", "plot"}
                assert not own, (base, own)


@every_name
def test_every_one_has_a_picture_or_a_reason(name: str) -> None:
    value = RESULTS[name]
    if type(value) in WITHOUT_PICTURE or name == "Sweep of one":
        with pytest.raises(cp.InputError, match=r"has no picture|is of one point"):
            value.plot()
        assert not plt.get_fignums()
        return
    plt.close("all")
    with cp.units(IMPERIAL):
        drawn = value.plot()
        plt.gcf().canvas.draw()
    (number,) = plt.get_fignums()
    panels = np.ravel(drawn)
    figure = plt.figure(number)
    assert all(ax.get_figure(root=True) is figure for ax in panels)
    assert all(ax.has_data() or ax.texts or not ax.get_visible() for ax in panels)
    for text in figure.findobj(Text):
        assert not si_units(text.get_text()), text


@every_name
def test_help_of_plot_has_the_options_of_the_picture(name: str) -> None:
    value = RESULTS[name]
    signature, text = inspect.signature(value.plot), inspect.getdoc(value.plot) or ""
    for parameter in signature.parameters:
        assert f"{parameter} : " in text
    assert "self" not in signature.parameters
    assert inspect.signature(type(value).plot).parameters.keys() - {"self"} == {
        *signature.parameters
    }


def number_of(cell: object) -> float:
    """A cell as a number; NaN for none."""
    return float(cell) if isinstance(cell, (int, float)) else math.nan


@every_name
def test_the_long_form_has_every_number_of_the_table(name: str) -> None:
    value = RESULTS[name]
    whole, table = value.tidy(), value.table
    assert isinstance(whole, cp.results.Table)
    assert len(value.tidy().to_pandas()) == len(whole)
    assert whole.loads == table.loads
    if type(value).tidy is not Framed.tidy:  # of arrays that the table shows in part
        assert {"unit", "verdict"} & {*whole}
        return
    heads = whole["component" if "quantity" in table else "quantity"].values
    numbers = {head: column for head, column in table._distinct(units=False) if head in heads}
    listed = [number_of(cell) for column in numbers.values() for cell in column.values]
    np.testing.assert_array_equal([number_of(cell) for cell in whole["value"].values], listed)
    texts = {column.name for column in table.columns if column.is_text}
    assert texts <= {*whole}
    if not table.row_units:
        units = [column.unit for column in numbers.values() for _ in column.values]
        assert [*whole["unit"].values] == units


def test_chosen_columns_of_the_long_form() -> None:
    table: Any = OBJECTS["PreparedTrace"]
    name = "changes"
    assert {*table.tidy(name)["quantity"].values} == {name}
    with pytest.raises(cp.InputError, match="columns = 'power'"):
        table.tidy("power")


def exported(value: Framed) -> list[object]:
    """All that leaves the program without ``units=``."""
    whole, array = value.to_xarray(), value.to_pandas()
    units = [(name, each.attrs.get("units")) for name, each in whole.variables.items()]
    texts = [value.to_csv(frame=frame) for frame in value.frames]
    return [*texts, value.tidy().to_csv(), [*array.columns], array.to_csv(), units]


@every_name
def test_exports_are_si_whatever_units_are_shown(name: str) -> None:
    value = RESULTS[name]
    before = exported(value)
    with cp.units(IMPERIAL):
        assert exported(value) == before
