"""Errors and warnings of the library in the names of a shell."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from crankpin._support import labels
from crankpin.cli.options import PROG
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from crankpin._core import InputError
    from crankpin.cli.options import Option

BUILDER = re.compile(
    r"\bEngine\.(?:from_)?(lists|banks|firing_order|inline|vee|flat|boxer|radial)\b"
)
"""A builder of the library, by the name of its kind."""
BARE = re.compile(r"(?<![\w.(-])[a-z]+(?:_[a-z]+)+(?![\w(=.])")
"""A name of several words that stands alone."""
CALL = re.compile(r'(?<![\w.(-])(\w+)=(\([^()]*\)|\[[^\[\]]*\]|"[^"]*"|[^\s,;()]+)')
"""An argument with its value, ``orders=[1, 2]``."""
BEGINS = re.compile(r"(?:(?<=^)|(?<=; ))\w+(?=(?: =| is| has|\[))")
"""What a warning is about."""


def error_in_options(
    error: InputError, options: Iterable[Option], typed: Mapping[str, object]
) -> InputError:
    """Return an error of the library with its argument, value and hint as in a shell.

    Parameters
    ----------
    error
        The error.
    options
        Options of the command.
    typed
        Their values; None for those that are left out.
    """
    if error.argument is None or error.hint is None:
        return error
    options = [*options]
    fault = str(error)[len(error.argument) : -len(error.hint)]
    name = error.argument.partition("[")[0].partition(".")[0]
    # One that is left out is named only where that is the fault.
    among = [
        option
        for option in options
        if option.gives(name) and (error.value == "None" or typed.get(option.dest) is not None)
    ]
    if among:
        # Of several the one with this value.
        of_value = (option for option in among if str(typed.get(option.dest)) in str(error.value))
        one = next(of_value, among[0])
        if fault.startswith(" = ") and name == error.argument:
            fault = _fault(error.value, typed.get(one.dest)) or fault
        error.argument = one.label + error.argument[len(name) :]
        if fault.startswith(" = "):
            error.value = fault[len(" = ") : -len(": ")]
    error.hint = BARE.sub(lambda match: _label(match[0], options), _hint(error.hint, options))
    error.args = (f"{error.argument}{fault}{error.hint}",)
    return error


def _fault(value: str | None, typed: object) -> str | None:
    """Return what is wrong with a value in the words of who typed it."""
    if value == "None" or typed is None:
        return " is left out: "
    if typed is True:
        return " is set: "
    several = isinstance(typed, str) and re.search(r"[,:]", typed) is not None
    if not isinstance(typed, str) or (several and "[" not in str(value)):
        return None  # which of the values it is says the library
    return f" = {labels.cut(typed)}: "


def warning_in_options(message: str, options: Iterable[Option], typed: Mapping[str, object]) -> str:
    """Return a warning of the library with the names of arguments and units of the shell."""
    # What a new engine is made of is an option or its default; of others it may be in the file.
    new = "kind" in typed
    typed_options = [option for option in options if new or typed.get(option.dest) is not None]
    if typed.get("piston_mass") is not None:  # Of which the reciprocating mass is computed.
        typed_options = [option for option in typed_options if option.dest != "reciprocating_mass"]
    named = BEGINS.sub(lambda match: _label(match[0], typed_options), message)
    named = _hint(named, [*options])
    if named == message and not new:  # a figure of an engine file, which has no units
        return message
    units = "plain numbers are metres and kilograms; type units, such as 86mm or 480g"
    return named.replace(checks.UNITS_ASSUMED, units)


def _label(argument: str, options: Iterable[Option]) -> str:
    """Return the option among some that gives an argument, else the argument."""
    return next((option.label for option in options if option.gives(argument)), argument)


def _hint(text: str, options: list[Option]) -> str:
    """Return a text with arguments, ``orders=[1, 2]``, as they are typed in a shell."""

    def hint(match: re.Match[str]) -> str:
        name, value = match.groups()
        flags = [option for option in options if option.gives(name)]
        if value in ("True", "False"):
            # One that has another name than its argument sets that to False.
            flags = [flag for flag in flags if (flag.dest == name) is (value == "True")]
            return flags[0].label if flags else match[0]
        plain = re.sub(r'[\[\]()"]|(?<=,) ', "", value)
        return f"{flags[0].label} {plain}" if flags else match[0]

    return BUILDER.sub(_kind, CALL.sub(hint, text))


def _kind(builder: re.Match[str]) -> str:
    """Return the command that builds an engine as a method does."""
    return f"{PROG} new {builder[1].replace('_', '-')}"
