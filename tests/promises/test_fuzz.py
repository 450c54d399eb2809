"""Does any call with hostile arguments give anything worse than an error?

Every public function, method, constructor and operator is called with hostile values in place of
one to three arguments: each call must return finite figures or raise InputError, OSError or
ImportError, within seconds; TypeError only where Python itself raises it, of arguments that a
signature has no place for and of operands. A panic of the compiled core is none of these, nor is
MemoryError.

By default that takes a minute, the same calls each time. With ``CRANKPIN_FUZZ_SECONDS=600`` in the
environment, ``pytest tests/promises/test_fuzz.py -k fuzz_for_a_while`` goes on with other calls, a
seed after the other, for as long with each of engine files, builders, harmonics and everything;
``-k "fuzz_for_a_while and builders"`` is one of them. A failure prints the call, which fails by
itself.
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
    Call,
    call_hostile,
    calls,
    finite,
    problem,
    read_damaged,
    sound_call,
)
from fuzzing.sound import CURE, JSON, TOML, V6
from fuzzing.surface import (
    ALONE,
    OPERANDS,
    OPERATORS,
    PICTURES,
    PLAIN,
    RESULTS_MADE_ELSEWHERE,
    SUBJECTS,
    TARGETS,
    Target,
)
from fuzzing.values import HOSTILE
from hypothesis import HealthCheck, example, given, seed, settings
from hypothesis import strategies as st

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


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
    yield
    faulthandler.cancel_dump_traceback_later()


def test_fuzz_reaches_the_whole_public_surface() -> None:
    labels = {each.label for each in TARGETS + PICTURES}
    for name in cp.__all__:
        assert name in labels | PLAIN | {"__version__", "types"}
    for label in ("firing.gaps", "firing.valves", "i4.firings", "throws", "ValveTiming"):
        assert label in labels
    for label in ("Engine.from_lists", "v6.balance", "sweep.tidy", "balance.plot", "i4.save"):
        assert label in labels
    for label in ("balance []", "quantity ==", "sweep in", "ranking []", "i4 <", "v6 r+"):
        assert label in labels
    for label in ("rank", "ranking.to_pandas", "ranking.plot"):
        assert label in labels


def test_only_engines_and_proofs_take_a_reference_plane() -> None:
    """The plane of moments is in one place, on the engine; proofs are of any plane."""
    named = {
        each.label.rpartition(".")[2]
        for each in TARGETS + PICTURES
        if any(parameter.name == "reference_z" for parameter in each.parameters)
    }
    assert named == {"from_lists", "replace", "vanishing_orders", "closed_form"}


@pytest.mark.parametrize("name", sorted(RESULTS_MADE_ELSEWHERE))
@pytest.mark.parametrize("value", [None, "text", 0, [], V6])
def test_results_cannot_be_made_of_anything(name: str, value: Any) -> None:
    kind = getattr(cp.types, name)
    count = len(inspect.signature(kind).parameters)
    with pytest.raises((TypeError, ValueError)):
        kind(*[value] * count)


@pytest.mark.slow
@hostile(1200)
@given(calls(TARGETS))
def test_fuzz_calls(call: Call) -> None:
    call_hostile(call)


@pytest.mark.slow
@hostile(40)
@given(calls(PICTURES or TARGETS))
def test_fuzz_pictures(call: Call) -> None:
    found = problem(call)
    close_pictures()
    assert not found


@pytest.mark.slow
@pytest.mark.parametrize("each", TARGETS, ids=lambda each: each.label)
def test_fuzz_one_argument_at_a_time(each: Target) -> None:
    """Each argument in turn is each of the hostile values, the others being good."""
    found = []
    for parameter in each.parameters:
        # A call that stops at a missing argument would try nothing; few samples do.
        others = sound_call(each, but=parameter.name).arguments
        if parameter.kind is not parameter.VAR_KEYWORD:
            calls_ = (Call(each, others | {parameter.name: value}) for value in HOSTILE)
            found += [text for call in calls_ if (text := problem(call))]
    assert not found, f"{len(found)} calls\n" + "\n".join(found[:20])


@pytest.mark.parametrize(
    "label", [name for name, each in SUBJECTS.items() if not isinstance(each, type)]
)
def test_properties_give_figures_or_say_why_not(label: str) -> None:
    subject = SUBJECTS[label]
    for name in dir(subject):
        if not name.startswith("_") and not callable(getattr(type(subject), name, None)):
            try:
                assert finite(getattr(subject, name))
            except cp.InputError as error:
                assert len(str(error)) > CURE  # noqa: PT017 - either is right


@pytest.mark.parametrize("label", OPERANDS)
def test_operators_of_one_operand_answer_or_raise_what_python_does(label: str) -> None:
    subject, problems = OPERANDS[label], []
    for name, of in ALONE.items():
        try:
            of(subject)
        except (cp.InputError, TypeError):
            continue
        except Exception as error:
            problems.append(f"{name}: {type(error).__name__}: {error}")
    assert not problems


@pytest.mark.slow
@hostile(400)
@given(DAMAGED)
@example(("\ufeff" + TOML, "\ufeff" + JSON))
def test_fuzz_files(texts: tuple[str, str]) -> None:
    read_damaged(texts)


def named(*names: str) -> st.SearchStrategy[Call]:
    """Calls of the targets whose label ends in one of the names."""
    chosen = [each for each in TARGETS if each.label.rpartition(".")[2] in names]
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
    "operators": (
        calls([each for each in TARGETS if each.label.split()[-1] in OPERATORS]),
        call_hostile,
    ),
    "everything": (calls(TARGETS), call_hostile),
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
