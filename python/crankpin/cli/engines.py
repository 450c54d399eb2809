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

MOST_SHOWN = 20
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
def _firing(given: Given) -> Shown:
    engine = given.engine("firing")
    strokes = None if given.text("--strokes") is None else int(given.text("--strokes"))
    if given.text("--all") or (given.text("--firing-order") is None and not engine.firing_order):
        if given.text("--plot") is not None:
            raise rejected("--plot", given.text("--plot"), "needs --firing-order")
        return _firing_orders(engine, strokes, csv=given.text("--csv"))
    ways = engine.firing_schedules(given.text("--firing-order"), strokes=strokes)
    best = engine.firing(given.text("--firing-order"), strokes=strokes)
    others = "".join(f"  {way.intervals_text}\n" for way in ways[1:])
    note = f"The same order in other turns, intervals in degrees:\n{others}" if others else ""
    return Shown(best.frames, best, note=note)


def _firing_orders(engine: Engine, strokes: int | None, *, csv: bool) -> Shown:
    firings = engine.firing_orders(strokes=strokes)
    shown = firings if csv else firings[:MOST_SHOWN]
    listed = [
        (firing.firing_order, "even" if firing.even and not csv else firing.intervals_text)
        for firing in shown
    ]
    rows = np.array([[firing.unevenness_deg] for firing in shown])
    name = labels.name_of(engine)
    table = Table.from_rows(
        f"{name}: {firings[0].strokes}-stroke, most even first",
        ["firing order", ("intervals", "°"), ("rms from even", "°")],
        listed,
        rows,
    )
    rest = len(firings) - len(shown)
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
def _view(given: Given) -> str:
    """Write the page; return what the command prints."""
    engine = given.engine("view")
    file = Path(given.text("--out"))
    engine.save_html(
        file,
        rpm=given.number("--rpm", "rpm"),
        spectrum=given.spectrum(),
        **given.keywords(Engine.save_html),
        controls=given.names("--controls"),
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
def _gallery(given: Given) -> str:
    """Write the pages; return what the command prints."""
    files = save_gallery(given.text("--out"), rpm=given.number("--rpm", "rpm"))
    size = sum(file.stat().st_size for file in files)
    return f"{files[0]}: {len(files) - 1} engines, {size / 1e6:.1f} MB\n"
