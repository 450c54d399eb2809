"""Commands: presets, firing orders, and turning pages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import labels
from crankpin._support.tables import Table
from crankpin.cli.options import command, keyword, option, rejected
from crankpin.cli.outputs import Shown, only
from crankpin.model.engine import Engine
from crankpin.model.presets import Presets
from crankpin.view.gallery import save_gallery

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given

MOST_FIRING_ORDERS = 20
"""Largest number of firing orders in a table; CSV has all."""


@command("presets", "list the engines known by name", "--csv", example="presets")
def _presets(_: Given) -> Shown:
    return Shown(only(Presets().table("description")))


@command(
    "firing",
    "intervals and exhaust gaps of a firing order, or all orders that a crank allows",
    "name",
    "--firing-order",
    option("--all", action="store_true", help="list all orders that the crank allows"),
    option(
        "--strokes", choices=("4", "2"), help="strokes of a cycle (default: the engine's own, or 4)"
    ),
    "--csv",
    option("--plot", help="write the chart of strokes (.pdf, .png, .svg)"),
    example="firing v8-crossplane --plot v8.png",
)
def _firing(call: Given) -> Shown:
    engine = call.engine("firing")
    strokes = None if call.text("--strokes") is None else int(call.text("--strokes"))
    if call.text("--all") or (call.text("--firing-order") is None and not engine.firing_order):
        if call.text("--plot") is not None:
            raise rejected("--plot", call.text("--plot"), "needs --firing-order")
        return _firing_orders(engine, strokes, csv=call.text("--csv"))
    ways = engine.firing_schedules(call.text("--firing-order"), strokes=strokes)
    best = engine.firing(call.text("--firing-order"), strokes=strokes)
    others = "".join(f"  {way.intervals_text}\n" for way in ways[1:])
    note = f"The same order in other turns, intervals in degrees:\n{others}" if others else ""
    return Shown(best.frames, best, note=note)


def _firing_orders(engine: Engine, strokes: int | None, *, csv: bool) -> Shown:
    firings = engine.firing_orders(strokes=strokes)
    first = firings if csv else firings[:MOST_FIRING_ORDERS]
    rows_of_texts = [
        (firing.firing_order, "even" if firing.even and not csv else firing.intervals_text)
        for firing in first
    ]
    rows = np.array([[firing.unevenness_deg] for firing in first])
    name = labels.name_of(engine)
    table = Table.from_rows(
        f"{name}: {firings[0].strokes}-stroke, most even first",
        ["firing order", ("intervals", "°"), ("rms from even", "°")],
        rows_of_texts,
        rows,
    )
    rest = len(firings) - len(first)
    return Shown(only(table), note=f"and {rest} more: --csv prints all\n" if rest else "")


@command(
    "view",
    "a page in which an engine turns: one file, for any browser",
    "name",
    option(
        "-o",
        "--out",
        argument="path",
        metavar="FILE",
        required=True,
        help="the page to write (.html)",
    ),
    option("--rpm", help="crank speed at first (default: %(default)s)"),
    keyword(Engine.save_html, "compact"),
    "--controls --reference-z --spectrum --units",
    example="view v8-crossplane --out v8.html",
)
def _view(call: Given) -> str:
    """Write the page; return what the command prints."""
    engine = call.engine("view")
    file = Path(call.text("--out"))
    engine.save_html(
        file,
        rpm=call.number("--rpm", "rpm"),
        spectrum=call.spectrum(),
        **call.keywords(Engine.save_html),
        controls=call.names("--controls"),
    )
    return f"{file}: {file.stat().st_size / 1e3:.0f} kB\n"


@command(
    "gallery",
    "a page for each preset, and one with pictures that links them",
    option(
        "-o", "--out", argument="path", metavar="DIR", required=True, help="the folder to write to"
    ),
    option("--rpm", help="crank speed at first (default: %(default)s)"),
    example="gallery --out engines",
)
def _gallery(call: Given) -> str:
    """Write the pages; return what the command prints."""
    files = save_gallery(call.text("--out"), rpm=call.number("--rpm", "rpm"))
    size = sum(file.stat().st_size for file in files)
    return f"{files[0]}: {len(files) - 1} engines, {size / 1e6:.1f} MB\n"
