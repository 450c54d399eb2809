"""The command ``firing``: intervals of a firing order, or all orders that a crank allows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels, tables
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands
    from crankpin.model.engine import Engine


MOST_SHOWN = 20
"""Largest number of firing orders in a table; CSV has all."""


def add(commands: Commands) -> None:
    """Add the command ``firing``."""
    fires = parser.command(
        commands,
        "firing",
        "intervals and exhaust gaps of a firing order, or all orders that a crank allows",
        example="firing v8-crossplane --plot v8.png",
        run=run,
    )
    parser.shared(fires, "name")
    fires.add_argument(
        "--order",
        help="such as 1-3-4-2, with + for cylinders that fire together: 1+4-2+3 (default: the "
        "engine's own, if it is known)",
    )
    fires.add_argument("--all", action="store_true", help="list all orders that the crank allows")
    fires.add_argument("--strokes", choices=("4", "2"), help="default: the engine's own, or 4")
    parser.shared(fires, "--csv")
    parser.shared(fires, "--plot", help="write the chart of valve periods (.pdf, .png, .svg)")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "firing")
    strokes = None if arguments.strokes is None else int(arguments.strokes)
    if arguments.all or (arguments.order is None and not engine.firing_order):
        if arguments.plot is not None:
            raise InputError("--plot needs --order")
        return _firing_orders(engine, strokes, csv=arguments.csv)
    picture = inputs.picture_file(arguments.plot)
    ways = engine.firings(arguments.order, strokes=strokes)
    best = engine.firing(arguments.order, strokes=strokes)
    outputs.draw(best, picture)
    text = outputs.printed([best.table], csv=arguments.csv)
    if arguments.csv or len(ways) == 1:
        return text
    others = "".join(f"  {way.intervals_text}\n" for way in ways[1:])
    return f"{text}The same order in other turns, intervals in degrees:\n{others}"


def _firing_orders(engine: Engine, strokes: int | None, *, csv: bool) -> str:
    firings = engine.firing_orders(strokes=strokes)
    shown = firings if csv else firings[:MOST_SHOWN]
    listed = [
        (each.firing_order, "even" if each.even and not csv else each.intervals_text)
        for each in shown
    ]
    rows = np.array([[each.unevenness_deg] for each in shown])
    name = labels.name_of(engine)
    header = ["firing order", "intervals °", "rms from even °"]
    table = tables.Table.from_rows(
        f"{name}: {firings[0].strokes}-stroke, most even first", header, listed, rows
    )
    text = outputs.printed([table], csv=csv)
    rest = len(firings) - len(shown)
    return f"{text}and {rest} more: --csv prints all\n" if rest else text
