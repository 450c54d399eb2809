"""Commands on engines as they are: presets, firing orders, and pages that turn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels
from crankpin._support.tables import Table
from crankpin.cli.arguments import command, shared
from crankpin.cli.outputs import draw, printed
from crankpin.model.presets import Presets
from crankpin.view.page import save_gallery

if TYPE_CHECKING:
    from crankpin.cli.arguments import Commands, Given
    from crankpin.model.engine import Engine

MOST_SHOWN = 20
"""Largest number of firing orders in a table; CSV has all."""


def add_presets(commands: Commands) -> None:
    """Add the command ``presets``."""
    listing = command(
        commands, "presets", "list the engines known by name", example="presets", run=_presets
    )
    shared(listing, "--csv")


def _presets(given: Given) -> str:
    return printed(Presets().table("description"), csv=given.text("--csv"))


def add_firing(commands: Commands) -> None:
    """Add the command ``firing``."""
    fires = command(
        commands,
        "firing",
        "intervals and exhaust gaps of a firing order, or all orders that a crank allows",
        example="firing v8-crossplane --plot v8.png",
        run=_firing,
    )
    shared(fires, "name")
    fires.add_argument(
        "--order",
        help="such as 1-3-4-2, with + for cylinders that fire together: 1+4-2+3 (default: the "
        "engine's own, if it is known)",
    )
    fires.add_argument("--all", action="store_true", help="list all orders that the crank allows")
    fires.add_argument(
        "--strokes", choices=("4", "2"), help="strokes of a cycle (default: the engine's own, or 4)"
    )
    shared(fires, "--csv")
    shared(fires, "--plot", help="write the chart of strokes (.pdf, .png, .svg)")


def _firing(given: Given) -> str:
    engine = given.engine("firing")
    strokes = None if given.text("--strokes") is None else int(given.text("--strokes"))
    if given.text("--all") or (given.text("--order") is None and not engine.firing_order):
        if given.text("--plot") is not None:
            raise InputError("--plot needs --order")
        return _firing_orders(engine, strokes, csv=given.text("--csv"))
    picture = given.picture_file()
    ways = engine.firings(given.text("--order"), strokes=strokes)
    best = engine.firing(given.text("--order"), strokes=strokes)
    draw(best, picture)
    text = printed(best.table, csv=given.text("--csv"))
    if given.text("--csv") or len(ways) == 1:
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
    table = Table.from_rows(
        f"{name}: {firings[0].strokes}-stroke, most even first", header, listed, rows
    )
    text = printed(table, csv=csv)
    rest = len(firings) - len(shown)
    return f"{text}and {rest} more: --csv prints all\n" if rest else text


def add_view(commands: Commands) -> None:
    """Add the command ``view``."""
    page = command(
        commands,
        "view",
        "a page in which an engine turns: one file, for any browser",
        example="view v8-crossplane --out v8.html",
        run=_view,
    )
    shared(page, "name")
    page.add_argument(
        "-o", "--out", metavar="FILE", required=True, help="the page to write (.html)"
    )
    shared(page, "--rpm", help="crank speed at first (default: %(default)s)")
    page.add_argument(
        "--compact",
        action="store_true",
        help="the cross-section and one vector alone, for a slide or a frame of 640 by 360 pixels",
    )
    shared(page, "--reference-z", "--spectrum", "--units")


def _view(given: Given) -> str:
    """Write the page; return what the command prints."""
    engine = given.engine("view")
    file = Path(given.text("--out"))
    engine.save_html(
        file,
        rpm=given.number("--rpm", "rpm"),
        spectrum=given.spectrum(),
        compact=given.text("--compact"),
    )
    return f"{file}: {file.stat().st_size / 1e3:.0f} kB\n"


def add_gallery(commands: Commands) -> None:
    """Add the command ``gallery``."""
    pages = command(
        commands,
        "gallery",
        "a page for each preset, and one with pictures that links them",
        example="gallery --out engines",
        run=_gallery,
    )
    pages.add_argument("-o", "--out", metavar="DIR", required=True, help="the folder to write to")
    shared(pages, "--rpm", help="crank speed at first (default: %(default)s)")


def _gallery(given: Given) -> str:
    """Write the pages; return what the command prints."""
    files = save_gallery(given.text("--out"), rpm=given.number("--rpm", "rpm"))
    size = sum(file.stat().st_size for file in files)
    return f"{files[0]}: {len(files) - 1} engines, {size / 1e6:.1f} MB\n"
