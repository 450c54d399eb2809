"""Do options follow from the functions that declare their arguments, in help and errors?

Every option of every command, by introspection.
"""

from __future__ import annotations

import ast
import inspect
import re
from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.parameters import parameter
from crankpin.analysis.prepared_trace import prepare_trace
from crankpin.cli import ORDER, _homes, registered
from crankpin.cli.arguments import READERS, Given
from crankpin.cli.naming import error_in_options
from crankpin.cli.options import Parser
from crankpin.model.cycle_files import ANGLE_UNITS, PRESSURE_UNITS, load

if TYPE_CHECKING:
    from crankpin.cli.options import Option


def parser(command: str) -> Parser:
    """The parser of a command."""
    commands = Parser().add_subparsers()
    registered([command])[command](commands)
    result: Parser = commands.choices[command]
    return result


def options(command: str) -> list[Option]:
    """The options of a command."""
    result: list[Option] = parser(command).get_default("options")
    return result


DECLARED = [
    (command, each) for command in ORDER for each in options(command) if each.function is not None
]


@pytest.mark.parametrize(
    ("command", "option"), DECLARED, ids=[f"{command} {each.label}" for command, each in DECLARED]
)
def test_an_option_is_an_argument_of_its_function(command: str, option: Option) -> None:
    assert option.function is not None
    assert option.argument in inspect.signature(option.function).parameters
    declared = parameter(option.function, option.argument)
    assert option.read or any(re.search(words, declared.type) for words, _ in READERS)
    if "default" not in option.settings:  # that of the function counts
        assert parser(command).get_default(option.dest) in (None, False)


def test_commands_are_those_of_the_modules_with_and_without_sources(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert {*registered()} == {*ORDER}

    def absent(*_: object, **__: object) -> str:
        raise OSError

    monkeypatch.setattr(Path, "read_text", absent)
    assert [*_homes()] == [*ORDER]


@pytest.mark.parametrize("command", ORDER)
def test_the_help_is_plain_and_names_options_that_there_are(command: str) -> None:
    shell = parser(command)
    flags = {flag for action in shell._actions for flag in action.option_strings}
    for action in shell._actions:
        text = action.help or ""
        assert text, action.dest
        assert not re.search(r"``|:\w+:`|\.\.", text), text
        assert text[:1].islower() or text[1:2].isupper(), text
        assert {*re.findall(r"(?<![\w-])--[a-z][\w-]*", text)} <= flags, text
        assert text.count("(default: ") <= 1, text


def test_errors_name_every_option_and_what_was_typed() -> None:
    for command in ORDER:
        known = options(command)
        for each in known:
            if each.dest in ("name", "names") and not each.argument:
                continue
            error = inputs.rejected(each.argument or each.dest, 3.0, "give another")
            said = str(error_in_options(error, known, {each.dest: "3kg"}))
            assert said == f"{each.label} = 3kg: give another", (command, each.label)


def test_a_value_of_a_list_and_one_left_out_are_said() -> None:
    known = options("counterweights")
    several = inputs.rejected("angles_deg[1]", 370.0, "give less")
    said = str(error_in_options(several, known, {"angles": "0,370"}))
    assert said == "--angles[1] = 370.0: give less"
    without = inputs.rejected("bound", None, Hint.of("give it, or `minimise=None`"))
    said = str(error_in_options(without, known, {"bound": None}))
    assert said == "--bound is left out: give it, or --minimise None"
    # Words stay as they are: a user may have named something so.
    words = inputs.rejected("bound", 3.0, "of planes='keep=[1]' and pin_split_deg")
    said = str(error_in_options(words, options("counterweights"), {"keep": "1", "bound": "3"}))
    assert said == "--bound = 3: of planes='keep=[1]' and pin_split_deg"


def test_hints_name_arguments_in_parts() -> None:
    """What an option gives in a command stands in backticks of ``Hint.of``, not among words."""
    words = re.compile(r"(?<![`\w(])(\w+)=(?:…|\[|True\b|False\b|None\b|\"\w)")
    package, wrong = Path(cp.__file__).parent, list[str]()
    callers = ("rejected", "faulty", "warn", "Hint", "Hint.of")
    for file in package.rglob("*.py"):
        if "cli" in file.relative_to(package).parts:
            continue
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            called = isinstance(node, ast.Call) and ast.unparse(node.func).endswith(callers)
            if called or (isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "hint"):
                wrong += [
                    f"{file.name}:{text.lineno}: {text.value}"
                    for text in ast.walk(node)
                    if isinstance(text, ast.Constant)
                    and isinstance(text.value, str)
                    and words.search(text.value)
                ]
    # Methods of objects, which no command has.
    assert [text for text in wrong if "(…, crankcase=…)" not in text] == []


def test_units_of_files_are_those_that_are_read() -> None:
    assert parameter(load, "angle_unit").choices == tuple(ANGLE_UNITS)
    units = re.findall(
        r"(\w+)(?:,| or |$)", parameter(load, "pressure_unit").text.partition(": ")[2]
    )
    assert units == [*PRESSURE_UNITS]


def test_values_are_read_as_their_function_declares_them() -> None:
    typed = {
        "loss_angle": "0.6°", "lowpass_order": None, "intake_pressure": "0.95bar",
        "leave_out": "1,3", "spikes": "replace", "exponent": "fit", "compression_ratio": "10,5",
        "units": None,
    }  # fmt: skip
    given = Given(Namespace(options=options("trace"), **typed))
    assert given.keywords(prepare_trace) == {
        "loss_angle_deg": 0.6, "intake_pressure": 95000.0, "leave_out": [1, 3],
        "spikes": "replace", "exponent": "fit", "compression_ratio": 10.5,
    }  # fmt: skip
