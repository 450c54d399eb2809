"""The command ``sweep``: peaks over bank angle, rod ratio, pin offset or speed."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels, tables
from crankpin._support.quantities import QUANTITIES
from crankpin.analysis.sweeps.sweep import Sweep, engine_titles, sweep
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from numpy.typing import NDArray

    from crankpin.cli.parser import Commands


FLAGS = {
    "bank_angle_deg": "--bank-angle",
    "rod_ratio": "--rod-ratio",
    "pin_offset": "--pin-offset",
    "rpm": "--rpm",
}
"""Swept dimension → its option."""
COLUMNS = {
    "bank_angle_deg": "bank angle °",
    "rod_ratio": "rod ratio",
    "pin_offset": "pin offset m",
    "rpm": "rpm",
}
"""Swept dimension → head of its column."""


def add(commands: Commands) -> None:
    """Add the command ``sweep``."""
    many = parser.command(
        commands,
        "sweep",
        "peaks of each order over bank angle, rod ratio, pin offset or speed",
        example="sweep ijesc-v6 --rpm 5000 --bank-angle 10:170:10 --plot v6.png",
        run=run,
        note="A range is START:STOP:STEP (stop included), a list a,b,c, or one number. Write one\n"
        "that begins with minus as --pin-offset=-0.002:0.002:0.001. With nothing to sweep, bank\n"
        "angle goes from 10 to 170 by 10.",
    )
    many.add_argument(
        "names",
        metavar="NAME",
        nargs="+",
        help="presets, engine files (.toml, .json), or families of presets: ijesc-v6 stands for "
        "all whose names begin with ijesc-v6-",
    )
    many.add_argument("--bank-angle", dest="bank_angle_deg", metavar="RANGE", help="degrees")
    many.add_argument("--rod-ratio", metavar="RANGE", help="crank radius / rod length")
    many.add_argument("--pin-offset", metavar="RANGE", help="m")
    parser.shared(many, "--rpm", metavar="RANGE", help="default: %(default)s")
    parser.shared(many, "--hold", "--orders", "--rtol")
    parser.shared(many, "--quantity", help="quantity of the table (default: %(default)s)")
    parser.shared(many, "--reference-z", "--spectrum", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    known = inputs.engines(arguments.names)
    engines = {name: inputs.about_plane(each, arguments) for name, each in known.items()}
    texts = {dim: getattr(arguments, dim) for dim in FLAGS}
    given = {
        dim: inputs.number_or_range(FLAGS[dim], text)
        for dim, text in texts.items()
        if text is not None
    }
    if not any(np.ndim(values) for values in given.values()):
        vees = all(hasattr(engine, "bank_angle_deg") for engine in engines.values())
        if "bank_angle_deg" not in given and vees:
            given["bank_angle_deg"] = np.arange(10.0, 171.0, 10.0)
        elif len(engines) == 1:
            raise InputError(
                "nothing to sweep: give --rod-ratio, --pin-offset, --rpm, or --bank-angle for an "
                "engine of two banks, as START:STOP:STEP or a,b,c"
            )
    rows = math.prod([len(engines), *map(np.size, given.values())])
    if rows > inputs.MOST_ROWS:
        raise InputError(f"{rows} points to sweep: give {inputs.MOST_ROWS} at most")
    chosen = inputs.chosen(arguments)
    picture = inputs.picture_file(arguments.plot)
    result = sweep(
        engines if len(engines) > 1 else next(iter(engines.values())),
        rpm=given["rpm"],
        bank_angle_deg=given.get("bank_angle_deg"),
        rod_ratio=given.get("rod_ratio"),
        pin_offset=given.get("pin_offset"),
        hold=arguments.hold if "bank_angle_deg" in given else None,
        spectrum=inputs.spectrum(arguments.spectrum),
        **chosen,
    )
    tables, negligible = _tables_of(result, arguments)
    outputs.draw(result, picture, quantity=arguments.quantity)
    text = outputs.printed(tables, csv=arguments.csv)
    if arguments.csv or chosen["orders"] != "auto":
        return text
    return text + negligible + outputs.left_out(result)


def _tables_of(result: Sweep, arguments: argparse.Namespace) -> tuple[list[tables.Table], str]:
    """Return a table for each engine, or a single one with a column of engines; and a note.

    For reading, engines that are swept along something else stand below each other, as in the
    papers; a program needs a single table, and so does a comparison of engines alone. The note
    names the chosen orders that are left out of tables for reading.
    """
    quantity = arguments.quantity
    symbols = QUANTITIES[quantity].symbols
    peaks = _peaks(result, quantity).reshape(-1, len(result.orders), len(symbols))
    shown, note = np.full(len(result.orders), fill_value=True), ""
    if arguments.orders == "auto" and not arguments.csv:
        largest = peaks.max(axis=(0, 2), initial=0.0)
        shown = largest >= labels.NEGLIGIBLE * largest.max(initial=0.0)
        left = tuple(n for n, kept in zip(result.orders, shown, strict=True) if not kept)
        note = f"{labels.not_shown(left)}\n" if left else ""
    rows = peaks[:, shown].reshape(len(result.engines), -1, int(shown.sum()) * len(symbols))
    dims = [dim for dim in result.coords if dim != "engine"]
    swept = list(itertools.product(*(np.asarray(result.coords[dim]).tolist() for dim in dims)))
    heads = [COLUMNS[dim] for dim in dims]
    heads += [
        f"{symbol} order {order} {QUANTITIES[quantity].unit}"
        for order in np.array(result.orders)[shown].tolist()
        for symbol in symbols
    ]
    how = _how(result, arguments)
    decimals = tables.common_decimals(rows)
    if "engine" not in result.coords or (dims and not arguments.csv):
        return [
            tables.Table.from_rows(f"{name}: {how}", heads, swept, each, decimals)
            for name, each in zip(engine_titles(result), rows, strict=True)
        ], note
    points = [(name, *point) for name in result.coords["engine"] for point in swept]
    title = f"{how[0].upper()}{how[1:]}"
    table = rows.reshape(len(points), -1)
    return [tables.Table.from_rows(title, ["engine", *heads], points, table, decimals)], note


def _peaks(result: Sweep, quantity: str) -> NDArray[np.float64]:
    """Return the peaks of a quantity: (…, n_orders, components)."""
    drawn = getattr(result, quantity)
    peaks: NDArray[np.float64] = drawn.peak if quantity == "torque" else drawn.peak_xy
    return peaks


def _how(result: Sweep, arguments: argparse.Namespace) -> str:
    """Return what the table shows, and what is fixed, held or given."""
    parts = [f"peaks of {QUANTITIES[arguments.quantity].words}"]
    parts += [labels.value_text(dim, value) for dim, value in result.fixed.items()]
    if result.hold is not None:
        parts.append(labels.HELD[result.hold])
    if arguments.quantity == "moment" and arguments.reference_z is not None:
        parts.append(f"about z = {inputs.number('', arguments.reference_z):g} m")
    if arguments.spectrum is not None:
        parts.append(f"spectrum {arguments.spectrum} kg·m")
    return ", ".join(parts)
