"""Arguments of commands: parsers, shared options, and values with units."""

from __future__ import annotations

import argparse
import re
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, units
from crankpin._support.quantities import QUANTITIES
from crankpin.model import checks, engine_files, presets
from crankpin.model.cycle_files import ANGLE_UNITS, PRESSURE_UNITS
from crankpin.model.engine import Engine
from crankpin.model.loads import PeriodicLoad, of_rows

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.balance import Balance
    from crankpin.cli.outputs import Shown

PROG = "crankpin"
MOST_ROWS = 1_000_000
"""Largest number of rows in a table."""
PICTURES = (".pdf", ".png", ".svg")

# --- units --------------------------------------------------------------------------------------

UNITS: dict[str, units.Dimension] = {
    "kg": (1, 0, 0, 0),
    "m": (0, 1, 0, 0),
    "kg·m": (1, 1, 0, 0),
    "N": (0, 0, 1, 0),
    "N·m": (0, 1, 1, 0),
    "kg·m²": (1, 2, 0, 0),
    "Pa": (0, 0, 0, 1),
}
"""Unit that the library takes → what may be typed behind a number: any unit of that dimension."""


# --- parsers ------------------------------------------------------------------------------------


class Parser(argparse.ArgumentParser):
    """A parser whose errors are an InputError in one line."""

    refused: Callable[[argparse.Namespace], set[str]]
    """Options that are rejected beside what was typed before them."""

    def parse_known_args(  # type: ignore[override] # of two overloads
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Reject, as the command that it is, words that it does not take."""
        found, others = super().parse_known_args(args, namespace)
        if others:
            meant = inputs.nearest(others[0].partition("=")[0], self._option_string_actions)
            hint = meant or f"; see {self.prog} --help"
            if Path(others[0]).suffix.lower() == ".csv" and getattr(found, "csv", False):
                hint = f"; --csv prints CSV, so write it to a file by: --csv > {others[0]}"
            raise InputError(f"unrecognized arguments: {labels.cut(' '.join(others))}{hint}")
        return found, []

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
    "--pressure-unit": {
        "metavar": "UNIT",
        "help": f"{', '.join(PRESSURE_UNITS)} (default: what its header names)",
    },
    "--gauge": {
        "action": "store_true",
        "help": "pressure is above that of the atmosphere (default: what its header says)",
    },
    "--atmosphere": {
        "metavar": "P",
        "help": "pressure added to gauge pressure, Pa or 1.01bar (default: 101325)",
    },
    "--absolute": {"action": "store_true", "help": "pressure is absolute"},
    "--angle-unit": {
        "choices": tuple(ANGLE_UNITS),
        "help": "unit of angles, or of times (default: what its header names, else deg)",
    },
    "--tdc": {
        "metavar": "ANGLE",
        "help": "angle of the firing top dead centre as the file counts, degrees (default: 0)",
    },
    "--columns": {
        "metavar": "A,P,…",
        "help": "columns of angle and pressure, those of further cycles after them, by number from "
        "0 or name (default: 0,1 and all that are like 1); several cycles are averaged",
    },
    "--sheet": {"metavar": "NAME", "help": "sheet of a spreadsheet (default: the first)"},
    "--recorded-rpm": {
        "metavar": "RPM",
        "help": "crank speed of a record over time of less than three cycles",
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

LOAD_FIELDS = {
    "on": ("on", ""),
    "force": ("force", "N"),
    "torque": ("torque", "N·m"),
    "rpm": ("rpm", "rpm"),
    "direction": ("direction_deg", ""),
    "turning": ("turning", ""),
    "phase": ("phase_deg", ""),
    "z": ("z", "m"),
    "crank": ("crank", "count"),
    "ratio": ("ratio", ""),
    "x": ("x", "m"),
    "y": ("y", "m"),
    "cylinder": ("cylinder", "count"),
}
"""Field of ``--add-load`` → argument of :class:`PeriodicLoad` and its unit; empty of a word."""


OPPOSITES = {"gauge": "absolute"}
"""Argument of the library that may be False → the option that sets it."""
RENAMED = {
    "path": "out", "to_crankpin": "rod_centre", "cylinder": "misfire", "amount_g_mm": "amounts",
    "angle_deg": "angles", "measured_z": "measured", "correction_z": "correct", "point": "at",
    "rods": "small_ends", "cycles": "leave_out",
}  # fmt: skip
"""Argument of the library → the option of a command that has it under another name."""


BUILDER = re.compile(
    r"\bEngine\.(?:from_)?(lists|banks|firing_order|inline|vee|flat|boxer|radial)\b"
)
"""A builder of the library, by the name of its kind."""


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


class Option(NamedTuple):
    """An option as argparse takes it."""

    names: tuple[str, ...]
    settings: dict[str, Any]
    group: str
    """Title of its group in the help; empty for none."""


def option(*names: str, group: str = "", **settings: object) -> Option:
    """Return an option of one command, or of :data:`OPTIONS` with other settings."""
    return Option(names, OPTIONS.get(names[0], {}) | settings, group)


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
    listed = list[Option]()
    for each in options:
        if isinstance(each, Option):
            listed.append(each)
        else:
            listed += (Option((flag,), OPTIONS[flag], "") for flag in each.split())
    if "name" in " ".join(each for each in options if isinstance(each, str)).split():
        listed.append(Option(("--add-load",), OPTIONS["--add-load"], ""))

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
            parser.set_defaults(run=run)
            groups: dict[str, argparse._ActionsContainer] = {"": parser}
            for names, settings, group in listed:
                if group not in groups:
                    groups[group] = parser.add_argument_group(group)
                groups[group].add_argument(*names, **settings)

        COMMANDS[name] = add
        return run

    return register


# --- values -------------------------------------------------------------------------------------


def rejected(option: str, text: str, hint: str) -> InputError:
    """Return the error of an option: its name, what was typed and a hint."""
    return inputs.faulty(option, f"= {labels.cut(text)}", hint)


def error_in_options(error: InputError, typed: Mapping[str, object]) -> InputError:
    """Return an error of the library with its argument and hint named as in a shell.

    Parameters
    ----------
    error
        The error.
    typed
        Values of all options of the command; None for those that are left out.
    """
    if error.argument is None or error.hint is None:
        return error
    value = str(error)[len(error.argument) : -len(error.hint)]
    # One that is left out is named only where that is the fault.
    among = _options(typed, left_out=error.value == "None")
    error.argument = re.sub(r"^\w+", lambda word: _option(word[0], among), error.argument)
    if error.value == "None" and error.argument.startswith("--"):  # None was not typed
        value = " is left out: "
    all_options = _options(typed, left_out=True)
    # Names of several words that stand alone.
    bare = r"(?<![\w.(-])[a-z]+(_[a-z]+)+(?![\w(=.])"
    hint = _hint_in_options(error.hint, typed)
    error.hint = re.sub(bare, lambda word: _option(word[0], all_options), hint)
    error.args = (error.argument + value + error.hint,)
    return error


def warning_in_options(message: str, typed: Mapping[str, object]) -> str:
    """Return a warning of the library with the names of arguments and units of the shell."""
    # What a new engine is made of is an option or its default; of others it may be in the file.
    known = _options(typed, left_out="kind" in typed)
    if typed.get("piston_mass") is not None:  # Of which the reciprocating mass is computed.
        known.discard("reciprocating_mass")
    begins = r"(?:(?<=^)|(?<=; ))\w+(?=(?: =| is| has|\[))"
    said = re.sub(begins, lambda word: _option(word[0], known), message)
    said = _hint_in_options(said, typed)
    if said == message and "kind" not in known:  # a figure of an engine file, which has no units
        return message
    asked = "plain numbers are metres and kilograms; type units, such as 86mm or 480g"
    return said.replace(checks.UNITS, asked)


def _options(typed: Mapping[str, object], *, left_out: bool) -> set[str]:
    """Return the names of options that were typed, or of all."""
    among = {name for name, value in typed.items() if left_out or value is not None}
    return among - {"name", "names"}


def _option(argument: str, among: set[str]) -> str:
    """Return the option among some that gives an argument, else the argument."""
    names = (argument, argument.removesuffix("_deg"), RENAMED.get(argument, argument))
    return next((f"--{each.replace('_', '-')}" for each in names if each in among), argument)


def _hint_in_options(text: str, typed: Mapping[str, object]) -> str:
    """Return a text with arguments, ``orders=[1, 2]``, as they are typed in a shell."""
    options = _options(typed, left_out=True)

    def hint(found: re.Match[str]) -> str:
        name, value = found.groups()
        if value in ("True", "False"):
            name = name if value == "True" else OPPOSITES.get(name, "")
            named = _option(name, options)
            return named if named != name else found[0]
        plain = re.sub(r'[\[\]()"]|(?<=,) ', "", value)
        named = _option(name, options)
        return f"{named} {plain}" if named != name else found[0]

    pattern = r'(?<![\w.(-])(\w+)=(\([^()]*\)|\[[^\[\]]*\]|"[^"]*"|[^\s,;()]+)'
    return re.sub(BUILDER, _kind, re.sub(pattern, hint, text))


def _kind(builder: re.Match[str]) -> str:
    """Return the command that builds an engine as a method does."""
    return f"{PROG} new {builder[1].replace('_', '-')}"


class Given:
    """Arguments of a command, read as values in the library's units.

    Options are named as they are typed, ``"--reference-z"``; one that is left out reads as None.
    """

    def __init__(self, arguments: argparse.Namespace, typed: Sequence[str] = ()) -> None:
        self.typed = tuple(typed)
        """The words of the command line."""
        self._typed = vars(arguments)
        for name, text in self._typed.items():
            if isinstance(text, str) and "\0" in text:
                raise rejected(name, labels.printable(text), "has a NUL byte")
        self.said = list[str]()
        """Notices of values that were read differently from their spelling."""
        self._setting = units.read(self._typed.get("units") or "", "--units")
        self.written: units.Setting = {}
        """Units that numbers were typed with, the first of each kind."""

    def text(self, flag: str) -> Any:  # noqa: ANN401 - text or None, True or False of a flag
        """Return what was typed."""
        return self._typed[flag.removeprefix("--").replace("-", "_")]

    def names(self, flag: str) -> list[str] | None:
        """Return names separated by commas, if they are given."""
        text: str | None = self.text(flag)
        return None if text is None else [name.strip() for name in text.split(",")]

    def one(self, flag: str, text: str, unit: str = "", what: str = "a number") -> float:
        """Return a number, typed with a unit or without, in the library's unit."""
        return self._read(flag, text, unit, "number", what)[0][0]

    def _read(
        self, flag: str, text: str, unit: str, form: str, what: str, *, infinite: bool = False
    ) -> tuple[list[float], bool]:
        """Return numbers in the library's unit, finite ones unless ``inf`` is allowed.

        And whether it is a list. A decimal comma that is read as a point is said.
        """
        # Plain moments of inertia stay in kg·m²: no flywheel is weighed in g·mm².
        has_setting = unit in UNITS and unit != "kg·m²"
        plain = units.convert(unit, self._setting).unit if has_setting else ""
        values, word, is_listed, point = _core.read_numbers(
            flag, text, unit, form=form, plain=plain, what=what, infinite=infinite
        )
        if point is not None:
            self.said.append(f"{flag} {text.strip()} is read as {point}")
        if word and unit in UNITS and (name := units.symbol(word)) is not None:
            self.written.setdefault(UNITS[unit], name)
        return values, is_listed

    def echo(self, flag: str, unit: str) -> str:
        """Return what was typed, with the unit that a plain number has."""
        text: str = self.text(flag)
        own = re.search(r"[^\d\s.,=:eE+/-]", text)
        return text if own else f"{text} {units.convert(unit, self._setting).unit}"

    def number(self, flag: str, unit: str = "") -> float:
        """Return the number of an option that has one."""
        return self.one(flag, self.text(flag), unit)

    def optional(self, flag: str, unit: str = "") -> float | None:
        """Return the number of an option, if it is given."""
        return None if self.text(flag) is None else self.number(flag, unit)

    def numbers(self, flag: str, unit: str = "", *, infinite: bool = False) -> list[float] | None:
        """Return a list of numbers, if it is given."""
        text = self.text(flag)
        return None if text is None else self.listed(flag, text, unit, infinite=infinite)

    def listed(
        self,
        flag: str,
        text: str,
        unit: str = "",
        what: str = "a number",
        *,
        infinite: bool = False,
    ) -> list[float]:
        """Return the numbers of a text, separated by commas."""
        return self._read(flag, text, unit, "list", what, infinite=infinite)[0]

    def whole(self, flag: str) -> int:
        """Return a whole number."""
        text = self.text(flag)
        number = self.one(flag, text, "count", "a whole number")
        if number != int(number):
            raise rejected(flag, text, "give a whole number")
        return int(number)

    def whole_numbers(self, flag: str, hint: str = "give whole numbers, such as 1,2") -> list[int]:
        """Return a list of whole numbers."""
        text = self.text(flag)
        try:
            return [int(part) for part in text.split(",")]
        except ValueError:
            raise rejected(flag, text, hint) from None

    def range(self, flag: str, unit: str = "") -> float | NDArray[np.float64] | None:
        """Return a number, a list of numbers, or START:STOP:STEP with the stop included."""
        text = self.text(flag)
        if text is None:
            return None
        what = "one number, a list a,b,c or a range START:STOP:STEP"
        numbers, is_listed = self._read(flag, text, unit, "range", what)
        return np.array(numbers) if is_listed else numbers[0]

    def engines(self, names: Sequence[str] | None = None) -> dict[str, Engine]:
        """Return the engines of NAME…, by their titles, or by what was typed where these repeat."""
        typed: dict[str, Engine] = {}
        for name in names or self._typed.get("names") or [self.text("name")]:
            if Path(name).suffix.lower() in engine_files.ENDINGS:
                typed[name] = Engine.load(name)
                continue
            for member in presets.family(name):
                if member not in presets.Presets():
                    raise presets.unknown("NAME", name, typed=True)
                typed[member] = Engine.preset(member)
        if (plane := self._typed.get("reference_z")) is not None:
            z = self.one("--reference-z", plane, "m")
            typed = {name: engine.replace(reference_z=z) for name, engine in typed.items()}
        typed = {name: self.with_loads(engine) for name, engine in typed.items()}
        titles = [engine.title if engine.name else "" for engine in typed.values()]
        return {
            title if title and titles.count(title) == 1 else name: engine
            for title, (name, engine) in zip(titles, typed.items(), strict=True)
        }

    def with_loads(self, engine: Engine) -> Engine:
        """Return an engine with the loads of ``--add-load`` besides its own."""
        typed = self._typed.get("add_load") or []
        return engine.with_loads([*engine.loads, *map(self._load, typed)]) if typed else engine

    def _load(self, text: str) -> PeriodicLoad:
        """Return a load as it is typed: its name, then fields."""
        flag = "--add-load"
        name, _, rest = text.partition(":")
        fields = dict[str, Any]()
        for part in re.split(r"\s+(?=\w+=)", rest.strip()):
            key, _, value = (each.strip() for each in part.partition("="))
            if key not in LOAD_FIELDS or not value:
                hint = f'give "NAME: on=shaft force=2:8 z=-0.1", of {", ".join(LOAD_FIELDS)}'
                raise rejected(flag, text, hint)
            argument, unit = LOAD_FIELDS[key]
            if key in ("force", "torque"):
                plain = units.convert(unit, self._setting).unit
                rows = _core.read_amplitudes(flag, value, unit, plain)
                fields[argument] = of_rows(rows, table=any(len(row) > 3 for row in rows))
            elif unit:
                listed = [self.one(flag, each, unit) for each in value.split("/")]
                fields[argument] = listed if len(listed) > 1 else listed[0]
            else:
                fields[argument] = {"yes": True, "no": False}.get(value, value)
        if "on" not in fields:
            raise rejected(flag, text, "say what it acts on: on=shaft, on=block or on=both")
        if isinstance(fields.get("rpm"), float):
            fields["scaling"] = "speed squared"
        fields |= {key: int(fields[key]) for key in ("crank", "cylinder") if key in fields}
        try:
            return PeriodicLoad(name.strip(), **fields)
        except InputError as error:
            raise rejected(flag, text, str(error)) from None

    def about(self, balance: Balance) -> Balance:
        """Return a balance about the point of ``--about``, if it is given."""
        point = self.numbers("--about", "m")
        if point is None:
            return balance
        if len(point) not in (1, 3):
            raise rejected("--about", self.text("--about"), "give X,Y,Z or Z, m")
        return balance.about(point if len(point) == 3 else point[0])

    def engine(self, command: str) -> Engine:
        """Return the engine of a command that takes one."""
        found = self.engines()
        if len(found) > 1:
            name = self.text("name")
            members = ", ".join(presets.family(name))
            raise rejected("NAME", name, f"{command} takes one engine of {members}")
        return next(iter(found.values()))

    def quantity(self, engines: Iterable[Engine]) -> str:
        """Return ``--quantity``; by default moment, or force if no cylinder has a lever."""
        typed: str | None = self.text("--quantity")
        return typed or ("moment" if any(np.ptp(each.z) for each in engines) else "force")

    def orders(self) -> Orders:
        """Return the orders of ``--orders``, or "auto"."""
        if self.text("--orders") == "auto":
            return "auto"
        try:
            return [inputs.order(Decimal(part)) for part in self.text("--orders").split(",")]
        except (InvalidOperation, ValueError, OverflowError):
            hint = "give multiples of crank speed, such as 1,2,4 or 0.5,1,1.5, or auto"
            raise rejected("--orders", self.text("--orders"), hint) from None

    def chosen(self) -> dict[str, Any]:
        """Return orders, or "auto", and the tolerance by which they are chosen, if it is given."""
        listed = self.orders()
        if self.text("--rtol") is None:
            return {"orders": listed}
        if listed != "auto":
            raise rejected("--rtol", self.text("--rtol"), "needs --orders auto")
        return {"orders": listed, "rtol": self.number("--rtol")}

    def spectrum(self) -> Spectrum | None:
        """Return the spectrum of ``--spectrum``, order → amplitude in kg·m, if it is given."""
        if (text := self.text("--spectrum")) is None:
            return None
        amplitudes = dict[int, float]()
        for part in text.split(","):
            typed, _, amplitude = part.partition("=")
            order = int(typed) if typed.strip().isdecimal() and len(typed) < 10 else 0
            if not amplitude or order < 1:
                hint = "give order=amplitude, such as 1=9.0,2=3.75"
                raise rejected("--spectrum", text, hint)
            if order in amplitudes:
                raise rejected("--spectrum", text, f"order {order} is given twice")
            amplitudes[order] = self.one("--spectrum", amplitude, "kg·m")
        return amplitudes

    def frame(self) -> str | None:
        """Return the table to print, if one is named."""
        return self._typed.get("frame")

    def picture_file(self) -> Path | None:
        """Return the file of the picture, checked before anything is computed for it."""
        if (text := self._typed.get("plot")) is None:
            return None
        path = Path(text)
        if path.suffix.lower() not in PICTURES:
            hint = f"a picture's name ends in {', '.join(PICTURES)}"
            raise rejected("--plot", text, hint)
        return path

    def save_file(self) -> Path | None:
        """Return the file for the engine that is found, checked before anything is computed."""
        return self.engine_file("--save") if "save" in self._typed else None

    def engine_file(self, flag: str) -> Path | None:
        """Return the engine file to write, if it is given; without ``--force`` no old one."""
        if (text := self.text(flag)) is None:
            return None
        file = engine_files.checked(text, flag)
        if file.is_file() and not self.text("--force"):
            hint = "it is there already; give another name, or --force to replace it"
            raise rejected(flag, str(file), hint)
        return file
