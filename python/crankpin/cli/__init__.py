"""The command line: tables and pictures of balances, sweeps and firings, and pages."""

from __future__ import annotations

import argparse
import sys
import warnings
from typing import TYPE_CHECKING

from crankpin._core import InputError, __version__
from crankpin.cli import balance, firing, gallery, presets, rank, streams, sweep, view
from crankpin.cli.parser import PROG, Parser

if TYPE_CHECKING:
    from collections.abc import Sequence

COMMANDS = (presets, balance, sweep, rank, firing, view, gallery)
"""Modules of the commands, in the order of the help: each adds its parser and runs it."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = streams.warn
            streams.write(_text(argv))
    except BrokenPipeError:
        # The reader of the pipe has closed it.
        streams.abandon(sys.stdout)
        return 128 + 13  # as a shell reports SIGPIPE
    except (InputError, OSError, ImportError) as error:
        streams.say(f"error: {error}")
        return 2
    except KeyboardInterrupt:
        return 128 + 2
    return 0


def _text(argv: Sequence[str] | None) -> str:
    """Return what a command prints."""
    try:
        arguments = _parser().parse_args(argv)
    except SystemExit:
        if sys.stdout is not None:
            streams.write("")  # flushes the help while a broken pipe can still be answered
        raise
    text: str = arguments.run(arguments)
    return text


def _parser() -> Parser:
    parser = Parser(
        prog=PROG,
        description="Shaking forces, rocking moments and torques of piston engines.",
        epilog=f"example:\n  {PROG} balance v8-crossplane --rpm 6000",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"crankpin {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for each in COMMANDS:
        each.add(commands)
    return parser
