"""Does one limit guard every door of a result, and is a frame no larger than its numbers?"""

from __future__ import annotations

import subprocess
import sys
import tracemalloc
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import inputs
from crankpin._support.tables import Column, Table
from support import in_turn
from support.objects import RESULTS

if TYPE_CHECKING:
    from pathlib import Path

I4 = cp.Engine.preset("i4")
TEXTS = ("to_csv", "to_latex", "cells", "text", "html")


@in_turn("name", RESULTS)
def test_every_text_of_every_result_has_the_limit(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    result: Any = RESULTS[name]
    frames = dict(result.frames)  # before anything is too large
    with monkeypatch.context() as patch:
        patch.setattr(inputs, "LARGEST_RESULT", 0)
        for table in frames.values():
            assert len(table) > 0
            for door in TEXTS:
                with pytest.raises(cp.InputError, match=r"the result would take .* limit of 0; "):
                    getattr(table, door)()
            with pytest.raises(cp.InputError, match="the result would take"):
                _ = table.columns[0].values


# What a sweep of 10⁹ points, or of its crank angles, answers, with three gigabytes of memory.
LARGE = """
import resource
import crankpin as cp
import numpy as np
import pandas, xarray, matplotlib.pyplot
from crankpin._support.frames import Framed
i4, points = cp.Engine.preset("i4"), np.linspace(0.2, 0.3, 31_623)
sweep = cp.sweep(i4, rpm=1e4 * points, rod_ratio=points, orders=[2])
results = [
    sweep, sweep.moment, sweep[2], sweep.total, sweep.torque[2], sweep.total.force,
    sweep.waveform([0.0, 90.0]),
]
def answer(result, door):
    "Use a door, and return what it says."
    try:
        value = getattr(result, door)
        _ = value() if callable(value) else dict(value) if door == "frames" else value
    except cp.InputError as error:
        return str(error)
    return "nothing"
used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, -1))
count = 0
for result in results:
    doors = [name for name in dir(type(result)) if name.startswith("to_") and name != "to_dask"]
    for door in [*doors, *({"table", "frames", "tidy", "plot"} & {*dir(type(result))})]:
        said = answer(result, door)
        assert "the result would take" in said and "in parts" in said, (result, door, said)
        count += 1
    assert repr(result).startswith("<") and result._repr_html_() is None
    used = min(used, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
assert count >= 45, count
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - used) / 1024)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits memory by address space")
def test_no_door_of_a_sweep_of_a_milliard_points_takes_memory() -> None:
    done = subprocess.run(  # noqa: S603 - this interpreter
        [sys.executable, "-c", LARGE], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 64  # MB


def frames_of(count: int) -> dict[str, Table]:
    """Return tables of results of about so many rows."""
    side = int(count**0.5)
    speeds, ratios = np.linspace(1000, 6000, side), np.linspace(0.2, 0.3, side)
    sweep = cp.sweep(I4, rpm=speeds, rod_ratio=ratios, orders=[2])
    torsion = cp.torsional_excitation(I4, np.linspace(1000, 6000, count // 8), orders=[2, 4])
    return {
        "sweep": sweep.table,
        "quantity": sweep.moment.table,
        "order": sweep[2].table,
        "long form": sweep.tidy("force"),
        "torsion": torsion.table,
    }


@pytest.mark.parametrize("name", ["sweep", "quantity", "order", "long form", "torsion"])
def test_a_frame_is_made_of_arrays_and_takes_little_more_than_they_do(
    name: str, tmp_path: Path
) -> None:
    table = frames_of(40_000)[name]
    size = sum(np.asarray(each.data).nbytes for each in table.columns)
    assert len(table) > 38_000
    lists = [each.name for each in table.columns if not isinstance(each.data, np.ndarray)]
    assert lists == (["order"] if name == "torsion" else [])  # of ints and halves, shared by rows
    assert size >= 8 * len(table) * len(table.columns)
    for what, most in (
        (table.to_pandas, 3.0),
        (lambda: table.to_csv(tmp_path / "table.csv"), 1.0),
        (lambda: table.text(30), 0.1),
        (lambda: table.html(60), 0.1),
    ):
        what()  # which imports what it needs
        tracemalloc.start()
        what()
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert peak < most * size + 2**18


def test_a_table_of_a_sweep_makes_no_object_for_a_row() -> None:
    sweep = cp.sweep(
        I4, rpm=np.linspace(1000, 6000, 200), rod_ratio=np.linspace(0.2, 0.3, 200), orders=[2]
    )
    _ = sweep.table, repr(sweep.table)
    before = sys.getallocatedblocks()
    tables = [sweep.table, sweep.moment.table, sweep[2].table]
    assert sys.getallocatedblocks() - before < 1000
    assert [len(each) for each in tables] == 3 * [40_000]


UNITS = ("", "N", "kg", "m", "N·m", "rpm")


def drawn(rng: np.random.Generator) -> tuple[Table, Table]:
    """Return a random table of arrays, and the same of objects."""
    count, columns = int(rng.integers(0, 6)), []
    for k in range(rng.integers(1, 5)):
        values = [
            rng.choice([0.0, -0.0, 1.5, -2e-7, 1e300, 0.1 + 0.2, np.nan, np.inf], count),
            rng.integers(-3, 3, count),
            rng.random(count) < 0.5,
            rng.choice(np.array(["a", "=1+1", "b N", "N", "1e5"], dtype=object), count),
        ][rng.integers(4)]
        unit = "" if values.dtype.kind in "bO" else str(rng.choice(UNITS))
        least = float(rng.choice([0.0, 1e-3]))
        head = str(rng.choice(["v", "order", f"c{k}"]))
        columns.append(Column(head, values, unit, int(rng.integers(3, 8)), least=least))
    listed = [
        Column(each.name, tuple(each.data.tolist()), each.unit, each.digits, least=each.least)  # type: ignore[union-attr]
        for each in columns
    ]
    rows = tuple(rng.choice(["N", "kg", ""], count)) if rng.random() < 0.5 else ()
    options: dict[str, Any] = {"title": "drawn, N", "row_units": tuple(map(str, rows))}
    return Table(columns=tuple(columns), **options), Table(columns=tuple(listed), **options)


def test_tables_of_arrays_are_those_of_objects() -> None:
    import pandas as pd

    rng = np.random.default_rng(5)
    for _ in range(400):
        arrays, objects = drawn(rng)
        for units in ("", "lbf, g, mm"):
            with cp.units(units):
                assert repr(arrays) == repr(objects)
                assert arrays._repr_html_() == objects._repr_html_()
                assert arrays.to_csv() == objects.to_csv()
                if len(arrays):  # of nothing the type of a column is lost
                    assert arrays.to_latex() == objects.to_latex()
                    pd.testing.assert_frame_equal(arrays.to_pandas(), objects.to_pandas())
                    assert arrays.to_xarray().identical(objects.to_xarray())
        for one, other in zip(arrays.columns, objects.columns, strict=True):
            assert repr(one.values) == repr(other.values)
            assert list(map(type, one.values)) == list(map(type, other.values))


def test_a_column_leaves_the_array_that_it_shows_writeable() -> None:
    values = np.arange(3.0)
    column = Column("v", values)
    assert values.flags.writeable
    assert not column.data.flags.writeable  # type: ignore[union-attr]
