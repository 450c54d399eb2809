"""Do records follow from their fields, and texts, tables and datasets from the columns?"""

from __future__ import annotations

import copy
import csv
import io
import pickle
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.frames import Frames
from crankpin._support.record import Listed, Record
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


class Made(Record):
    name: str
    values: NDArray[np.float64]
    by_name: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    note: str = field(default="", compare=False)

    @cached_property
    def twice(self) -> NDArray[np.float64]:
        return 2.0 * self.values


class Rows(Listed[int], Record):
    _items = "rows"
    rows: tuple[int, ...]


class Others(Listed[int], Record):
    _items = "rows"
    rows: tuple[int, ...]


def made(**changes: Any) -> Made:  # noqa: ANN401 - of any field
    given: dict[str, Any] = {"name": "x", "values": np.array([1.0, np.nan])}
    return Made(**given | {"by_name": {"a": np.zeros(2)}} | changes)


def test_records_compare_hash_pickle_and_copy_by_their_fields() -> None:
    one = made()
    for other in (made(), made(note="other"), copy.copy(one), copy.deepcopy(one)):
        assert other == one
        assert hash(other) == hash(one)
    for unequal in (made(name="y"), made(values=np.ones(2)), made(by_name={}), 1, None):
        assert unequal != one
    assert copy.copy(one) is copy.deepcopy([one])[0] is one  # nothing in them changes
    assert Rows((1, 2)) != Others((1, 2))
    back = pickle.loads(pickle.dumps(made(note="kept")))  # noqa: S301 - its own
    assert (back, back.note) == (one, "kept")
    assert repr(Rows((1, 2))) == "Rows(rows=(1, 2))"
    assert list(Rows((1, 2))) == [1, 2]


def test_records_are_frozen_and_their_arrays_read_only() -> None:
    for one in (made(), pickle.loads(pickle.dumps(made()))):  # noqa: S301 - its own
        for name in ("name", "new"):
            with pytest.raises(AttributeError):
                setattr(one, name, "y")
        with pytest.raises(AttributeError):
            del one.name
        for array in (one.values, one.by_name["a"]):
            assert not array.flags.writeable
        assert one.twice is one.twice


TABLE = Table(
    "A <title>",
    (
        Column("order", (1, 2, "all")),
        Column("name", ("a", "bb", "c")),
        Column("|F_x|", (1234.5678, 0.0, -0.0), "N"),
        Column("share", (0.5, None, 1.0), "%", decimals=1),
    ),
    note="A note.",
)


def test_numbers_that_round_to_zero_have_no_minus() -> None:
    assert Column("share", (-0.04, -0.06, 0.04), "%", decimals=1).cells() == ["0.0", "-0.1", "0.0"]


def test_a_table_is_text_html_csv_and_data_frame(tmp_path: Path) -> None:
    assert TABLE.text().splitlines() == [
        "A <title>",
        "order  name  |F_x| N  share %",
        "    1  a      1234.6      0.5",
        "    2  bb          0        –",
        "  all  c           0      1.0",
        "A note.",
    ]
    assert TABLE.text(1).splitlines()[-2:] == ["1 of 3 rows", "A note."]
    assert "&lt;title&gt;" in TABLE.html()
    head, *rows = csv.reader(io.StringIO(TABLE.to_csv()))
    assert head == ["order", "name", "|F_x| N", "share %"]
    assert float(rows[0][2]) == 1234.5678
    file = tmp_path / "table.csv"
    TABLE.to_csv(file)
    assert file.read_bytes() == TABLE.to_csv().encode()
    with pytest.raises(cp.InputError, match=r"path = 'table.xlsx': name a .csv file"):
        TABLE.to_csv("table.xlsx")
    assert TABLE.to_pandas()["|F_x| N"].tolist() == [1234.5678, 0.0, 0.0]
    dataset = TABLE.to_xarray()
    assert dataset["|F_x|"].attrs == {"units": "N"}
    assert dataset.attrs == {"title": "A <title>"}


def test_tables_of_no_rows_are_tables_and_stand_below_each_other() -> None:
    empty = Table.from_rows("Nothing", ["a", ("b", "N")], [], np.empty((0, 1)))
    assert empty.text() == "Nothing\na  b N"
    assert empty.to_csv() == "a,b N\n"
    assert len(empty.to_pandas()) == 0
    both = Frames({"first": lambda: TABLE, "second": lambda: empty})
    assert both.text() == f"{TABLE.text()}\n\n{empty.text()}"
    assert both._repr_html_() == TABLE.html() + empty.html()
    assert list(both) == ["first", "second"]
    assert both["second"] is empty
    assert "third" not in both
    with pytest.raises(KeyError, match=r'frame = .third.: give "first" or "second"'):
        both["third"]
    assert list(TABLE.frames) == ["table"]
    assert TABLE.frames["table"] is TABLE


def test_numbers_too_small_to_matter_are_marked_but_kept() -> None:
    fired = cp.Engine.preset("v6-60").with_cycle(cp.Cycle.example())
    table = fired.balance(rpm=3000).table
    column = table["|F_y|"]
    assert column.cells().count("~0") == 3
    exact = [value == 0.0 for value in column.values[1:]]  # below the mean, which forces lack
    assert [text == "0" for text in column.cells()[1:]] == exact
    for text in (str(table), table.html()):
        assert "~0: not zero, but too small to matter." in text
    assert "~" not in table.to_csv()
    # Of orders that are asked for the numbers are.
    asked = fired.balance(rpm=3000, orders=[6, 30]).table
    assert "~0" not in str(asked)
    assert 0.0 < min(each for each in asked["|F_y|"].values[1:] if each) < 1e-15
