"""Output of commands, also to closed or full streams and broken pipes."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

import numpy as np

from crankpin._support import files, labels, units
from crankpin._support.frames import FIRST, SHOWN, Frames
from crankpin._support.messages import without_controls
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import changed

if TYPE_CHECKING:
    from pathlib import Path

    from crankpin._support.tables import Table
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.sweeps.sweep import Sweep
    from crankpin.cli.arguments import Given
    from crankpin.cli.options import Run
    from crankpin.model.engine import Engine


class Shown(NamedTuple):
    """Result of a command."""

    frames: Frames
    drawn: Any = None
    """Result of which ``--plot`` is a picture."""
    options: Mapping[str, Any] = MappingProxyType({})
    """Options of its plot."""
    engine: Engine | Powertrain | None = None
    """Engine written by ``--save``."""
    note: str = ""
    """Text below the tables, of which CSV has none."""


def shown(call: Given, run: Run) -> str:
    """Run a command; write its picture and engine to the files given, return what it prints."""
    picture, file = call.picture_file(), call.save_file()
    result = run(call)
    if isinstance(result, str):
        return result
    printed, loads = _printed(call, result)
    if file is not None and result.engine is not None:
        result.engine.save(file)
    if picture is not None:
        _draw(result.drawn, picture, **result.options)
    if loads:
        say(loads)
    return printed


def _printed(call: Given, result: Shown) -> tuple[str, str]:
    """Return text or CSV, and the loads beside CSV, where a line would be a row to a program."""
    name = call.frame()
    if call.text("--csv"):
        table = result.frames[name or FIRST]._in(units.current())
        return table.to_csv(), table.loads
    frames = result.frames if name is None else result.frames[name]
    return f"{frames.text()}\n{units.shown(result.note)}", ""


def only(table: Table) -> Frames:
    """Return a table as the only frame."""
    return Frames({FIRST: lambda: table})


def left_out(result: Balance | Sweep) -> str:
    """Return what omitted orders can add, in words."""
    bound = result.error_bound
    omitted = labels.orders_text(result.omitted, labels.MOST_LISTED).partition(" ")[2]
    seen = f"; omitted: {omitted}" if result.omitted else ""
    words = {"force": "the force", "moment": "the rocking moment", "torque": "the roll torque"}
    parts = [
        units.Text(units.figure(bound[name], QUANTITIES[name].unit, 2), f" to {text}")
        for name, text in words.items()
        if name in bound
    ]
    listing = units.joined(" and ", [units.joined(", ", parts[:2]), *parts[2:]])
    return units.Text("Omitted orders add at most ", listing, f"{seen}.\n")


def in_short(table: Table, balance: Balance, *names: str) -> Table:
    """Return a table of chosen orders that fits a screen, if it has some too small to matter.

    Parameters
    ----------
    table
        The table, whose first column has the orders.
    balance
        The balance of which it is.
    *names
        The quantities that it shows.
    """
    if len(table) <= SHOWN or balance._request.orders is not None:
        return table
    peaks = [balance.read(name, "peak") for name in names]
    small = {
        order
        for k, order in enumerate(balance.orders)
        if all(sizes[k] <= labels.MATTERS * sizes.max() for sizes in peaks)
    }
    heads = table.columns[0].values
    places = [k for k, order in enumerate(heads) if order not in small]
    note = (
        f"Not shown: {len(heads) - len(places)} orders (their peaks are below "
        f"{labels.MATTERS:g} of the largest); --csv prints them."
    )
    columns = (
        changed(column, data=tuple(column.values[k] for k in places)) for column in table.columns
    )
    row_units = tuple(table.row_units[k] for k in places if table.row_units)
    notes = units.joined("\n", [table.note, note]) if len(places) < len(heads) else table.note
    return changed(table, columns=tuple(columns), note=notes, row_units=row_units)


def _draw(result: Any, path: Path, **options: str) -> None:  # noqa: ANN401 - what has plot
    figure = np.ravel(result.plot(**options))[0].get_figure(root=True)
    from matplotlib import pyplot as plt  # noqa: PLC0415 - plot() says if it is missing

    picture = io.BytesIO()
    try:
        figure.savefig(picture, format=path.suffix[1:].lower(), dpi=200)
    finally:
        plt.close(figure)
    files.write(path, picture.getvalue())


# --- streams ------------------------------------------------------------------------------------


def write(text: str) -> None:
    """Write to standard output."""
    if sys.stdout is None:
        raise OSError("standard output is closed")
    try:
        # Line by line: a pipe that breaks within a single long write can go unnoticed.
        sys.stdout.writelines(without_controls(text).splitlines(keepends=True))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        abandon(sys.stdout)
        raise OSError(f"standard output: {error.strerror}") from None


def abandon(stream: TextIO) -> None:
    """Discard what is buffered: Python would fail once more while it closes the stream."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)


def say(message: str) -> None:
    """Write a line to standard error, if there is one; print(file=None) would write to stdout."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(f"crankpin: {without_controls(message)}\n")
        sys.stderr.flush()
    except OSError:
        abandon(sys.stderr)
