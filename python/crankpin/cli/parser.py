"""What every command's parser has, and the options that several commands share."""

from __future__ import annotations

import argparse
from typing import NoReturn, TypeAlias

from crankpin._core import InputError

PROG = "crankpin"


class Parser(argparse.ArgumentParser):
    """A parser whose errors are an InputError in one line."""

    def error(self, message: str) -> NoReturn:  # noqa: D102 - of the base class
        raise InputError(f"{message}; see {self.prog} --help")


Commands: TypeAlias = "argparse._SubParsersAction[Parser]"
"""What a command adds its parser to."""


def command(
    commands: Commands,
    name: str,
    what: str,
    *,
    example: str,
    run: object,
    note: str = "",
) -> Parser:
    """Add a command with its help to the others; return its parser."""
    parser = commands.add_parser(
        name,
        help=what,
        description=f"{what[0].upper()}{what[1:]}.",
        epilog=f"{note}\n\nexample:\n  {PROG} {example}".strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(run=run)
    return parser


def quantity_and_output(parser: Parser, quantity: str) -> None:
    """Add ``--quantity``, described by ``quantity``, and what :func:`cylinder_and_output` adds."""
    parser.add_argument(
        "--quantity",
        choices=("force", "moment", "torque"),
        default="moment",
        help=f"{quantity} (default: %(default)s)",
    )
    cylinder_and_output(parser)


def orders_and_rtol(parser: Parser) -> None:
    """Add ``--orders`` and ``--rtol``."""
    parser.add_argument(
        "--orders",
        default="auto",
        help="such as 1,2,4, or auto for all that matter (default: %(default)s)",
    )
    parser.add_argument(
        "--rtol",
        help="with --orders auto: what the omitted orders may add up to, relative to m·r·ω² "
        "(default: 1e-9)",
    )


def cylinder_and_output(parser: Parser) -> None:
    """Add what :func:`loads` adds, ``--csv`` and ``--plot``."""
    loads(parser)
    parser.add_argument("--csv", action="store_true", help="print CSV in place of the table")
    parser.add_argument("--plot", metavar="FILE", help="write a picture (.pdf, .png, .svg)")


def loads(parser: Parser) -> None:
    """Add ``--reference-z`` and ``--spectrum``."""
    parser.add_argument(
        "--reference-z",
        metavar="Z",
        help="plane about which moments are taken, m (default: midway between first and last)",
    )
    parser.add_argument(
        "--spectrum",
        metavar="N=A,…",
        help="one cylinder's force over ω² in each order, kg·m, in place of its slider-crank: "
        "1=9.0,2=3.75",
    )
