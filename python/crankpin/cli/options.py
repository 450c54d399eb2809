"""Options of commands, made of what functions of the library declare, and the parsers of them."""

from __future__ import annotations

import argparse
import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeAlias

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.parameters import parameter
from crankpin._support.quantities import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from crankpin.cli.arguments import Given
    from crankpin.cli.outputs import Shown

PROG = "crankpin"


def rejected(option: str, text: str, hint: str) -> InputError:
    """Return the error of an option: its name, what was typed and a hint."""
    return inputs.faulty(option, f"= {labels.cut(text)}", hint)


class Parser(argparse.ArgumentParser):
    """A parser whose errors are an InputError in one line."""

    refused: Callable[[argparse.Namespace], set[str]]
    """Options that are rejected beside what was typed before them."""

    def parse_known_args(  # type: ignore[override] # of two overloads
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Reject, as the command that it is, words that it does not take."""
        values, others = super().parse_known_args(args, namespace)
        if others:
            meant = inputs.nearest(others[0].partition("=")[0], self._option_string_actions)
            hint = meant or f"; see {self.prog} --help"
            if Path(others[0]).suffix.lower() == ".csv" and getattr(values, "csv", False):
                hint = f"; --csv prints CSV, so write it to a file by: --csv > {others[0]}"
            raise InputError(f"unrecognized arguments: {labels.cut(' '.join(others))}{hint}")
        return values, []

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """Reject a word that is none of the choices, as the library does."""
        if action.choices is not None and value not in action.choices:
            name = "/".join(action.option_strings) or str(action.metavar)
            words = list(map(str, action.choices))
            hint = "no such command" if action.nargs == argparse.PARSER else None
            hint = hint or f"give {' or '.join(words)}"
            meant = inputs.nearest(value, words) or f"; see {self.prog} --help"
            raise rejected(name, str(value), f"{hint}{meant}")

    def error(self, message: str) -> NoReturn:  # noqa: D102 - of the base class
        flag = re.fullmatch(r"argument (?:-\w/)?(--[\w-]+): expected one argument", message)
        minus = f"; write a value that begins with a minus as {flag[1]}=-…" if flag else ""
        raise InputError(f"{message}{minus}; see {self.prog} --help")


Commands: TypeAlias = "argparse._SubParsersAction[Parser]"
"""Subparsers, to which a command adds its own."""
Run: TypeAlias = "Callable[[Given], str | Shown]"
"""Computes what a command prints."""

OPTIONS: dict[str, dict[str, Any]] = {
    "name": {"metavar": "NAME", "help": "a preset, or an engine file (.toml, .json)"},
    "--add-load": {
        "metavar": "LOAD",
        "action": "append",
        "help": "a periodic load that the engine has besides: NAME: on=shaft|block|both, "
        "force=ORDER:N,… torque=ORDER:NM,… (8@-30 is 8 at a phase of −30°, 4-1j complex), and any "
        "of z= direction= turning=yes phase= crank= ratio= x= y= cylinder= rpm= (with which it "
        "grows from that speed on by its square; rpm=1000/2000 force=2:8/9 is a table); once for "
        "each",
    },
    "--axes": {
        "metavar": "X,Y,Z:FIELD=VALUE:…",
        "help": "axes of places and directions, such as "
        "'back,right,up:flywheel=left:origin=1450mm,0,360mm:incline=12': directions of x, y and z "
        "in the vehicle, side of the flywheel, place of the engine's origin, m, and degrees by "
        "which the engine is turned about its crank, counter-clockwise seen from the flywheel "
        "(default: the engine's)",
    },
    "--rpm": {
        "default": "3000",
        "help": "crank speed (default: %(default)s, of a preset that turns slowly its own)",
    },
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
        "help": "such as 1,2,4 or 0.5,1,1.5, or auto for all that matter (default: %(default)s)",
    },
    "--rtol": {
        "help": "with --orders auto: largest sum of the omitted orders, relative to m·r·ω² "
        "(default: 1e-9)"
    },
    "--quantity": {
        "choices": tuple(QUANTITIES),
        "help": "quantity of the picture (default: moment, or force if all cylinders are at one z)",
    },
    "--reference-z": {
        "metavar": "Z",
        "help": "plane about which moments are taken, m (default: the engine's)",
    },
    "--about": {
        "metavar": "X,Y,Z",
        "help": "point about which moments and roll torque are taken, m: X,Y,Z or Z; X and Y are "
        "from the axis of the main crank (default: that axis)",
    },
    "--spectrum": {
        "metavar": "N=A,…",
        "help": "one cylinder's force over ω² in each order, kg·m, in place of its slider-crank: "
        "1=9.0,2=3.75",
    },
    "--cycle": {
        "metavar": "FILE",
        "help": "cylinder pressure over crank angle: a text file of columns under a header such as "
        "angle [deg], absolute pressure [bar]; petrol or diesel for an example at full load, "
        "petrol:30%% at part load, petrol:0 idling; none for no gas pressure (default: the "
        "engine's own, or else petrol)",
    },
    "--firing-order": {
        "help": "such as 1-3-4-2, with + for cylinders that fire together: 1+4-2+3 (default: the "
        "engine's own, if it is known)"
    },
    "--bore": {"help": "bore of all cylinders, m (default: the engine's, or else the stroke)"},
    "--crankcase": {
        "metavar": "P",
        "help": "absolute pressure below the pistons, Pa or 1.01bar (default: that of the engine, "
        "or 101325)",
    },
    "--seed": {"default": "0", "help": "seed of the random numbers (default: %(default)s)"},
    "--controls": {
        "metavar": "NAMES",
        "help": "controls that the page has, such as rpm,crank_angle; none for the pictures alone",
    },
    "--units": {
        "metavar": "UNIT,…",
        "help": "units of numbers typed without one, and of all that is printed: g,mm or "
        "lb,in,lbf; kg, g, lb, oz, m, mm, in, ft, N, kN, lbf, bar, psi, and products such as oz·in "
        "or lbf·ft; a number may have its own: 86mm, 480g, 3.4in, 2oz, 180g·mm (default: kg,m)",
    },
    "--frame": {"help": "print this table alone (default: all; with --csv the first)"},
    "--csv": {"action": "store_true", "help": "print CSV in place of the table"},
    "--plot": {"metavar": "FILE", "help": "write a picture (.pdf, .png, .svg)"},
    "--save": {
        "metavar": "FILE",
        "help": "write the engine with what was found, an engine file (.toml, .json)",
    },
    "--force": {"action": "store_true", "help": "replace an existing engine file"},
}
"""Options of several commands."""


class Option(NamedTuple):
    """An option as argparse takes it, and what the library does with its value."""

    names: tuple[str, ...]
    settings: dict[str, Any]
    group: str = ""
    """Title of its group in the help; empty for none."""
    argument: str = ""
    """Argument of the library that it gives; empty if that has its name."""
    function: Callable[..., Any] | None = None
    """Function that declares the argument."""
    read: Callable[[Given, str], Any] | None = None
    """What reads it, if that does not follow from the type that the function declares."""

    @property
    def dest(self) -> str:
        """Name of its value."""
        return self.names[-1].lstrip("-").replace("-", "_")

    @property
    def label(self) -> str:
        """Name as it is typed."""
        return self.names[-1] if self.names[-1][0] == "-" else str(self.settings["metavar"])

    def gives(self, argument: str) -> bool:
        """Return whether it gives an argument of the library."""
        if self.argument:
            return argument == self.argument
        return argument.removesuffix("_deg") == self.dest and self.dest not in ("name", "names")


def option(*names: str, group: str = "", argument: str = "", **settings: object) -> Option:
    """Return an option of one command, or of :data:`OPTIONS` with other settings."""
    return Option(names, OPTIONS.get(names[0], {}) | settings, group, argument)


METAVARS = {"kg": "MASS", "m": "LENGTH", "degrees": "ANGLE", "Pa": "P", "Hz": "HZ"}
"""Unit → name of a number in the help."""


def keyword(
    function: Callable[..., Any],
    argument: str,
    flag: str = "",
    *,
    group: str = "",
    read: Callable[[Given, str], Any] | None = None,
    more: str = "",
    default: str | None = None,
    **settings: object,
) -> Option:
    """Return the option that gives an argument of a function, as its docstring declares it.

    Parameters
    ----------
    function
        The function.
    argument
        Name of the argument.
    flag
        Name of the option; by default that of the argument.
    group
        Title of its group in the help.
    read
        What reads it; by default that of its type.
    more
        What the help says behind the first sentence of the docstring.
    default
        The default, in words; by default that of the docstring or the signature.
    **settings
        Settings of argparse in place of those that follow from the declaration.
    """
    declared = parameter(function, argument)
    default_text = _spoken(function, declared.default if default is None else default)
    by_default = f" (default: {default_text})" if default_text else ""
    text = f"{_spoken(function, declared.text)}{more}{by_default}"
    keywords: dict[str, Any] = {"help": text.replace("%", "%%")}
    if declared.type == "bool":
        keywords["action"] = "store_true"
    elif declared.choices:
        keywords["choices"] = declared.choices
    else:
        counted = re.search(r"\bnumber of|by index", text) is not None
        one = (
            "N"
            if counted
            else METAVARS.get(declared.unit, argument.rsplit("_", maxsplit=1)[-1].upper())
        )
        several = re.search("^(array|sequence)|iterable|, or sequence", declared.type) is not None
        keywords["metavar"] = "LOW,HIGH" if "pair" in declared.type else f"{one}{',…' * several}"
    return Option(
        (flag or _flag(argument),),
        keywords | settings,
        group,
        argument,
        inspect.unwrap(function),
        read,
    )


def _flag(argument: str) -> str:
    """Return the option that an argument has where none is named."""
    return f"--{argument.removesuffix('_deg').replace('_', '-')}"


def _spoken(function: Callable[..., Any], text: str) -> str:
    """Return a text of a docstring as a shell says it: lower case, options for arguments."""
    names = inspect.signature(function).parameters
    code = re.compile(r"``([^`]*)``")
    text = code.sub(lambda match: _flag(match[1]) if match[1] in names else match[1], text)
    text = re.sub(r"^(?:True (?:for|to)|Whether to) ", "", text).replace('"', "")
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def keywords(function: Callable[..., Any], arguments: str, group: str = "") -> list[Option]:
    """Return the options of several arguments of a function, named in one text."""
    return [keyword(function, name, group=group) for name in arguments.split()]


class Help(argparse._HelpAction):
    """Help without the options that are rejected beside what is typed before it."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, *_: object
    ) -> None:
        """Print the help of what was typed."""
        refused = parser.refused(namespace) if isinstance(parser, Parser) else set()
        for action in parser._actions:
            if refused & {*action.option_strings}:
                action.help = argparse.SUPPRESS
        super().__call__(parser, namespace, None)


COMMANDS: dict[str, Callable[[Commands], None]] = {}
"""Name of each command → the function that adds its parser."""


def command(
    name: str,
    what: str,
    *options: str | Option,
    example: str,
    note: str = "",
    refused: Callable[[argparse.Namespace], set[str]] = lambda _: set(),
) -> Callable[[Run], Run]:
    """Make a function a command; several options of :data:`OPTIONS` are named in one text.

    ``refused`` names options that the help leaves out beside what is typed before it.
    """
    taken = list[Option]()
    for flag in options:
        taken += [flag] if isinstance(flag, Option) else map(option, flag.split())
    if any(option.names == ("name",) and option.settings == OPTIONS["name"] for option in taken):
        taken.append(option("--add-load"))

    def register(run: Run) -> Run:
        def add(commands: Commands) -> None:
            parser = commands.add_parser(
                name,
                help=what,
                description=f"{what[0].upper()}{what[1:]}.",
                epilog=f"{note}\n\nexample:\n  {PROG} {example}".strip(),
                formatter_class=argparse.RawDescriptionHelpFormatter,
                add_help=False,
            )
            parser.refused = refused
            words = "show this help message and exit"
            parser.add_argument("-h", "--help", action=Help, help=words)
            parser.set_defaults(run=run, options=taken)
            groups: dict[str, argparse._ActionsContainer] = {"": parser}
            for option in taken:
                if option.group not in groups:
                    groups[option.group] = parser.add_argument_group(option.group)
                groups[option.group].add_argument(*option.names, **option.settings)

        add.__module__ = run.__module__
        COMMANDS[name] = add
        return run

    return register
