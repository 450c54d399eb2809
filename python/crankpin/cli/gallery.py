"""The command ``gallery``: pages of all presets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin.cli import inputs, parser
from crankpin.view.gallery import save_gallery

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``gallery``."""
    pages = parser.command(
        commands,
        "gallery",
        "a page for each preset, and one with pictures that links them",
        example="gallery --out engines",
        run=run,
    )
    pages.add_argument("--out", metavar="DIR", required=True, help="the folder to write to")
    parser.shared(pages, "--rpm", help="crank speed at first (default: %(default)s)")


def run(arguments: argparse.Namespace) -> str:
    """Write the pages; return what the command prints."""
    files = save_gallery(arguments.out, rpm=inputs.number("--rpm", arguments.rpm))
    size = sum(file.stat().st_size for file in files)
    return f"{files[0]}: {len(files) - 1} engines, {size / 1e6:.1f} MB\n"
