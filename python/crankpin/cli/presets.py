"""The command ``presets``: the engines known by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin.cli import outputs, parser
from crankpin.model import presets

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``presets``."""
    listing = parser.command(
        commands, "presets", "list the engines known by name", example="presets", run=run
    )
    parser.shared(listing, "--csv")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    return outputs.printed([presets.presets().table("description")], csv=arguments.csv)
