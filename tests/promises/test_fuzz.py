"""Does any call with hostile arguments give anything worse than an error?

Subjects are the public surface itself, enumerated by ``fuzzing.surface``: every function,
constructor and method, with every argument. Of each there is a call that returns; then the
argument is each of the hostile values in turn, which must give finite figures or raise InputError,
OSError or ImportError, within seconds, and an error that names an argument. TypeError only where
Python itself raises it, of arguments that a signature has no place for and of operands. A panic of
the compiled core is none of these, nor is MemoryError.

With ``CRANKPIN_FUZZ_SECONDS=600`` in the environment,
``pytest tests/promises/test_fuzz.py -k fuzz_for_a_while`` goes on with other calls, up to three
arguments bad, a seed after the other, for as long with each of engine files, builders, harmonics
and everything; ``-k "fuzz_for_a_while and builders"`` is one of them. A failure prints the call,
which fails by itself.
"""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import faulthandler
import inspect
import itertools
import sys
import time
from typing import TYPE_CHECKING, Any

import crankpin as cp
import pytest
from fuzzing.calls import (
    DAMAGED,
    SECONDS,
    call_hostile,
    calls,
    of_operator,
    problem,
    read_damaged,
    undefined,
)
from fuzzing.sound import JSON, TOML, V6
from fuzzing.surface import (
    ALONE,
    CALLED,
    CLASSES,
    EXCEPT,
    OPERATORS,
    TARGETS,
    Call,
    Target,
    instances,
    members,
    shown,
    sound,
)
from fuzzing.values import DRAWN, FEW, HOSTILE
from hypothesis import HealthCheck, example, given, seed, settings
from hypothesis import strategies as st
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

UNDEFINED = {
    # Of directions without load.
    "MountResponse": {"transmissibility", "transmissibility_db"},
    "DrivenResponse": {"transmissibility", "transmissibility_db"},
    "PointMotion": {"base_transmissibility"},
    "BaseResponse": {"transmissibility", "transmissibility_db", "base_transmissibility"},
}
"""Figures of the instances that are not finite, by what their docstrings say."""

HOLD_ANYTHING = {
    *("AdaptiveLaw", "BalancerOption", "BobWeight", "Card", "Choice", "DeadCentres", "Design"),
    "Match",
    *("LoadCases", "MountDesign", "MountModes", "MountRobustness", "OrderBalance", "OrderResponse"),
    *("FoundationTable", "GuideMoments", "LocomotiveForces"),
    *("PointMotion", "Quantity", "RollAxes", "StarDiagram", "StaticState", "Table"),
    *("TorsionalExcitation", "VelocityFeedback", "Verdicts", "WorstForce"),
}
"""Results that do not check what they are made of: calls make them."""
by_target = pytest.mark.parametrize(
    "target",
    [
        pytest.param(target, marks=pytest.mark.slow if target.draws else (), id=target.label)
        for target in TARGETS
        if target.label not in EXCEPT
    ],
)


def close_pictures() -> None:
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


def hostile(examples: int) -> settings:
    return settings(
        max_examples=examples,
        deadline=None,
        derandomize=SECONDS == 0,
        database=None,
        report_multiple_bugs=True,
        suppress_health_check=list(HealthCheck),
    )


@pytest.fixture(autouse=True)
def somewhere_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Files are written where it does no harm; a call that hangs says where."""
    monkeypatch.chdir(tmp_path)
    faulthandler.dump_traceback_later(SECONDS + 300.0, exit=True)
    instances()
    yield
    faulthandler.cancel_dump_traceback_later()
    close_pictures()


def test_sound_calls_return_every_public_class() -> None:
    assert [name for name, kind in CLASSES.items() if kind not in instances()] == []


@by_target
def test_hostile_arguments(target: Target) -> None:
    """Each argument in turn is each of the hostile values, beside those with which it is sound."""
    for owner in target.owners if not target.of_class else ():
        label = f"{owner.__name__}.{target.name}"
        assert sound(target, "", owner) or label in EXCEPT, f"no sound call of {label}"
    found = []
    values = FEW if target.draws else HOSTILE
    sound_call = sound(target)
    assert sound_call, "no sound call"
    if not target.draws:  # words of pictures are matplotlib's
        with pytest.raises((cp.InputError, TypeError)):
            sound_call.changed(nonsense=1).make()
    for parameter in target.parameters:
        if parameter.kind is parameter.VAR_KEYWORD:
            continue
        call = sound(target, parameter.name)
        assert call is not None, f"no sound value of {parameter.name}"
        assert parameter.name in call.arguments, f"no sound value of {parameter.name}"
        calls_ = (call.changed(**{parameter.name: value}) for value in values)
        found += [text for each in calls_ if (text := problem(each, parameter.name))]
        close_pictures()
    assert not found, f"{len(found)} calls\n" + "\n".join(found[:20])


@in_turn("name", CLASSES)
def test_properties_give_figures_or_say_why_not(name: str) -> None:
    for each in instances()[CLASSES[name]]:
        assert undefined(each) <= UNDEFINED.get(name, set())


def test_objects_of_other_classes_that_calls_return() -> None:
    """What a call returns is public too, though its class has no public name."""
    others: dict[str, Any] = {}
    for target in CALLED:
        if call := sound(target):
            value = call.make()
            kind = type(value)
            if kind.__module__.startswith("crankpin.") and kind not in CLASSES.values():
                others[kind.__name__] = value
    found = []
    for target in members({name: type(each) for name, each in others.items()}):
        subject = others[target.owners[0].__name__]
        for parameter, hostile_value in itertools.product(target.parameters, DRAWN):
            if text := problem(Call(target, subject, {parameter.name: hostile_value})):
                found.append(text)
    assert "Presets" in others
    assert not found, "\n".join(found[:20])


@in_turn("name", sorted({*cp.results.__all__} - HOLD_ANYTHING))
def test_results_cannot_be_made_of_anything(name: str) -> None:
    count = len(inspect.signature(CLASSES[name]).parameters)
    values: tuple[Any, ...] = (None, "text", 0, [], V6)
    for value in values:
        with pytest.raises((TypeError, ValueError)):
            CLASSES[name](*[value] * count)


@in_turn("name", CLASSES)
def test_operators_answer_or_raise_what_python_does(name: str) -> None:
    """What a value beside an operator raises before any code of the package ran is its own."""
    found = []
    for subject in instances()[CLASSES[name]]:
        for sign, alone in ALONE.items():
            if problem_of := of_operator(alone, subject):
                found.append(f"{sign} {name} {problem_of}")
        for sign, of in OPERATORS.items():
            found += [
                f"{name} {sign} {shown(value)} {problem_of}"
                for value in DRAWN
                if (problem_of := of_operator(of, subject, value))
            ]
    assert not found, f"{len(found)} operators\n" + "\n".join(found[:20])


@pytest.mark.slow
@hostile(600)
@given(calls(CALLED))
def test_fuzz_calls(call: Call) -> None:
    """Up to three arguments are bad."""
    call_hostile(call)


@hostile(400)
@given(DAMAGED)
@example(("\ufeff" + TOML, "\ufeff" + JSON))
def test_fuzz_files(texts: tuple[str, str]) -> None:
    read_damaged(texts)


def named(*names: str) -> st.SearchStrategy[Call]:
    """Calls of the targets whose label ends in one of the names."""
    chosen = [each for each in CALLED if each.label.rpartition(".")[2] in names]
    assert len({each.label.rpartition(".")[2] for each in chosen}) == len(names)
    return calls(chosen)


BUILDERS = (
    *("Cylinder", "from_lists", "inline", "vee", "flat", "boxer", "from_firing_order", "preset"),
    *("throws", "replace", "with_bank_angle", "with_first_tdc"),
)
HARMONICS = ("slider_crank_harmonics", "harmonics", "torque_harmonics")
FUZZED: dict[str, tuple[st.SearchStrategy[Any], Callable[[Any], None]]] = {
    "engine files": (DAMAGED, read_damaged),
    "builders": (named(*BUILDERS), call_hostile),
    "harmonics": (named(*HARMONICS), call_hostile),
    "everything": (calls(CALLED), call_hostile),
}


@pytest.mark.skipif(SECONDS == 0, reason="CRANKPIN_FUZZ_SECONDS is not set")
@pytest.mark.parametrize("what", FUZZED)
def test_fuzz_for_a_while(what: str) -> None:
    """Other examples, a seed after the other, until the time is up."""
    examples, check = FUZZED[what]
    end = time.monotonic() + SECONDS
    for number in itertools.count():
        if time.monotonic() > end:
            return

        @seed(number)
        @settings(hostile(1000), derandomize=False)
        @given(examples)
        def more(example_: Any) -> None:
            if time.monotonic() < end:
                check(example_)

        more()
