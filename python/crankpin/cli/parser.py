"""What every command's parser has, and the options that several commands share."""

from __future__ import annotations

import argparse
from typing import Any, NoReturn, TypeAlias

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


OPTIONS: dict[str, dict[str, Any]] = {
    "name": {"metavar": "NAME", "help": "a preset, or an engine file (.toml, .json)"},
    "--rpm": {"default": "3000", "help": "crank speed (default: %(default)s)"},
    "--by": {
        "metavar": "OBJECTIVE,…",
        "default": "total.moment.peak",
        "help": "what to minimise (default: %(default)s)",
    },
    "--hold": {
        "choices": ("pins", "firing"),
        "default": "pins",
        "help": "what is held as the bank angle changes: the crankpins, or the crank angles of all "
        "top dead centres (default: %(default)s)",
    },
    "--orders": {
        "default": "auto",
        "help": "such as 1,2,4, or auto for all that matter (default: %(default)s)",
    },
    "--rtol": {
        "help": "with --orders auto: what the omitted orders may add up to, relative to m·r·ω² "
        "(default: 1e-9)",
    },
    "--quantity": {"choices": ("force", "moment", "torque"), "default": "moment"},
    "--reference-z": {
        "metavar": "Z",
        "help": "plane about which moments are taken, m (default: midway between first and last)",
    },
    "--spectrum": {
        "metavar": "N=A,…",
        "help": "one cylinder's force over ω² in each order, kg·m, in place of its slider-crank: "
        "1=9.0,2=3.75",
    },
    "--seed": {"default": "0", "help": "seed of the random numbers (default: %(default)s)"},
    "--csv": {"action": "store_true", "help": "print CSV in place of the table"},
    "--plot": {"metavar": "FILE", "help": "write a picture (.pdf, .png, .svg)"},
}
"""Options of several commands."""


def shared(parser: Parser, *names: str, **changes: object) -> None:
    """Add options of :data:`OPTIONS`; a command may change, for one, what its help says."""
    for name in names:
        parser.add_argument(name, **OPTIONS[name] | changes)
