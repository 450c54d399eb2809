"""The command line: tables, pictures and pages of results."""

from __future__ import annotations

import argparse
import pkgutil
import re
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from crankpin._core import InputError, __version__
from crankpin._support import lazy, units
from crankpin.cli import outputs
from crankpin.cli.arguments import Given
from crankpin.cli.naming import error_in_options, warning_in_options
from crankpin.cli.options import COMMANDS, PROG, Parser, rejected
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from crankpin.cli.options import Commands

FIRST_COMMANDS = (
    "presets",
    "new",
    "balance",
    "explain",
    "compare",
    "sweep",
    "rank",
    "firing",
    "star",
)
"""Commands that the help lists before the others."""
_NAMED = re.compile(r'^@command\(\s*"([\w-]+)"', re.MULTILINE)


def _homes() -> dict[str, str]:
    """Return the module of each command in the order of the help.

    Read from the sources, so that a command imports its own module only; where there are none the
    modules are imported.
    """
    homes = dict[str, str]()
    for module in sorted(module_info.name for module_info in pkgutil.iter_modules(__path__)):
        try:
            source = Path(__file__).with_name(f"{module}.py").read_text(encoding="utf-8")
        except OSError:
            home = lazy.imported(f"{__name__}.{module}").__name__
            names = [name for name, add in COMMANDS.items() if add.__module__ == home]
        else:
            names = _NAMED.findall(source)
        homes |= dict.fromkeys(names, module)
    return {name: homes[name] for name in (*FIRST_COMMANDS, *homes)}


ORDER = _homes()
"""Command → the module that has it, in the order of the help."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    try:
        outputs.write(_text(argv))
    except BrokenPipeError:
        # The reader of the pipe has closed it.
        outputs.abandon(sys.stdout)
        return 128 + 13  # as a shell reports SIGPIPE
    except OSError as error:
        reason = error.strerror if error.filename else None
        outputs.say(f"error: {error.filename}: {reason}" if reason else f"error: {error}")
        return 2
    except (InputError, ImportError) as error:
        outputs.say(f"error: {error}")
        return 2
    except KeyboardInterrupt:
        return 128 + 2
    return 0


def _text(argv: Sequence[str] | None) -> str:
    """Return what a command prints."""
    typed = [*(sys.argv[1:] if argv is None else argv)]
    if typed[:2] == ["mounts", "fit"]:
        typed[:2] = ["mounts-fit"]
    for word in typed:
        if word.startswith("--") and word.endswith("=--"):  # on which argparse fails
            raise rejected(word.removesuffix("=--"), "--", "give a value")
    try:
        names = [name for name in typed[:1] if name in ORDER] or ORDER
        arguments = _parser(names).parse_args(typed)
    except SystemExit:
        if sys.stdout is not None:
            outputs.write("")  # flushes the help while a broken pipe can still be answered
        raise
    with warnings.catch_warnings():
        warnings.showwarning = _Warnings(arguments)
        try:
            call = Given(arguments, typed)
            with units.units(vars(arguments).get("units") or ""):
                printed = outputs.shown(call, arguments.run)
        except InputError as error:
            raise error_in_options(error, arguments.options, vars(arguments)) from None
        for word in call.said:
            outputs.say(word)
        return printed


class _Warnings:
    """Replaces ``warnings.showwarning``: shows warnings, of those of units the first only."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._arguments, self._of_units = arguments, False

    def __call__(self, message: Warning | str, *_: object, **__: object) -> None:
        text = message.args[0] if isinstance(message, Warning) else message
        of_units = getattr(text, "closing", "") == checks.UNITS_ASSUMED
        if not (of_units and self._of_units):
            options, typed = self._arguments.options, vars(self._arguments)
            outputs.say(f"warning: {warning_in_options(text, options, typed)}")
        self._of_units |= of_units


def registered(names: Iterable[str] = ORDER) -> Mapping[str, Callable[[Commands], None]]:
    """Import the modules of commands, by default of all; return all commands that are imported."""
    for name in names:
        lazy.imported(f"{__name__}.{ORDER[name]}")
    return COMMANDS


def _parser(names: Iterable[str] = ORDER) -> Parser:
    """Return the parser of some commands, by default of all."""
    parser = Parser(
        prog=PROG,
        description="Shaking forces, rocking moments and torques of piston engines.",
        epilog=f"NAME is a preset or an engine file; {PROG} new makes a file.\n\n"
        f"example:\n  {PROG} balance v8-crossplane --rpm 6000",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"crankpin {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name in names:
        registered([name])[name](commands)
    return parser
