"""Errors and warnings of the library in the names of a shell."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._support import labels
from crankpin._support.messages import Hint, WarningText, hint_of
from crankpin.cli.options import PROG
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from crankpin._core import InputError
    from crankpin._support.messages import Name
    from crankpin.cli.options import Option

BUILDERS = {
    f"Engine.{'from_' * (kind in ('lists', 'banks', 'firing_order'))}{kind}": kind.replace("_", "-")
    for kind in ("lists", "banks", "firing_order", "inline", "vee", "flat", "boxer", "radial")
}
"""Method that builds an engine → the kind that ``new`` calls it."""
BRACKETS = str.maketrans("", "", '[]()"')
"""What Python writes about values, and a shell does not."""
UNITS_TYPED = "plain numbers are metres and kilograms; type units, such as 86mm or 480g"


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
    hint, fault = hint_of(error), str(error)[len(error.argument) : -len(error.hint)]
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
    error.hint = _in_shell(hint, options)
    error.args = (f"{error.argument}{fault}{error.hint}",)
    return error


def _fault(value: str | None, typed: object) -> str | None:
    """Return what is wrong with a value in the words of who typed it."""
    if value == "None" or typed is None:
        return " is left out: "
    if typed is True:
        return " is set: "
    several = isinstance(typed, str) and ("," in typed or ":" in typed)
    if not isinstance(typed, str) or (several and "[" not in str(value)):
        return None  # which of the values it is says the library
    return f" = {labels.cut(typed)}: "


def warning_in_options(text: str, options: Iterable[Option], typed: Mapping[str, object]) -> str:
    """Return a warning of the library with the names of arguments and units of the shell."""
    if not isinstance(text, WarningText):
        return text
    # What a new engine is made of is an option or its default; of others it may be in the file.
    new = "kind" in typed
    every = [*options]
    chosen = [option for option in every if new or typed.get(option.dest) is not None]
    if typed.get("piston_mass") is not None:  # Of which the reciprocating mass is computed.
        chosen = [option for option in chosen if option.dest != "reciprocating_mass"]
    entries = [
        entry._replace(
            about=_label(entry.about, chosen),
            fault=_in_shell(Hint(entry.fault), every),
            hint=Hint(_in_shell(entry.hint, every)),
        )
        for entry in text.entries
    ]
    closing = text.closing
    # A figure of an engine file has no units.
    if closing == checks.UNITS_ASSUMED and (new or entries != [*text.entries]):
        closing = UNITS_TYPED
    return WarningText(entries, closing)


def _label(argument: str, options: Iterable[Option]) -> str:
    """Return the option among some that gives an argument, else the argument."""
    return next((option.label for option in options if option.gives(argument)), argument)


def _in_shell(hint: Hint, options: list[Option]) -> str:
    """Return a hint with its names as they are typed in a shell."""

    def typed(name: Name) -> str:
        if name.name in BUILDERS:
            return f"{PROG} new {BUILDERS[name.name]}"
        flags = [option for option in options if option.gives(name.name)]
        if name.value in ("True", "False"):
            # One that has another name than its argument sets that to False.
            flags = [flag for flag in flags if (flag.dest == name.name) is (name.value == "True")]
            return flags[0].label if flags else name.text
        if not flags:
            return name.text
        return f"{flags[0].label} {name.value.translate(BRACKETS).replace(', ', ',')}".rstrip()

    return hint.named(typed)
