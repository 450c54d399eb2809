"""The command ``view``: a page in which an engine turns."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from crankpin.cli import inputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``view``."""
    page = parser.command(
        commands,
        "view",
        "a page in which an engine turns: one file, for any browser",
        example="view v8-crossplane --out v8.html",
        run=run,
    )
    parser.shared(page, "name")
    page.add_argument("--out", metavar="FILE", required=True, help="the page to write (.html)")
    parser.shared(page, "--rpm", help="crank speed at first (default: %(default)s)")
    parser.shared(page, "--reference-z", "--spectrum")


def run(arguments: argparse.Namespace) -> str:
    """Write the page; return what the command prints."""
    engine = inputs.engine(arguments.name, "view")
    file = Path(arguments.out)
    engine.save_html(
        file,
        rpm=inputs.number("--rpm", arguments.rpm),
        reference_z=inputs.optional_number("--reference-z", arguments.reference_z),
        spectrum=inputs.spectrum(arguments.spectrum),
    )
    return f"{file}: {file.stat().st_size / 1e3:.0f} kB\n"
