"""Do calls with wrong arguments say how to call, for every public callable?"""

from __future__ import annotations

import inspect
import timeit
import warnings
from typing import TYPE_CHECKING, Any

import crankpin as cp
import pytest
from crankpin._support import calls
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

RECORDS = {name: getattr(cp.results, name) for name in cp.results.__all__}


def public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Every public function, constructor and method of the package."""
    for name in cp.__all__:
        value = getattr(cp, name)
        if inspect.isfunction(value):
            yield name, value
    kinds = {getattr(cp, name) for name in cp.__all__ if inspect.isclass(getattr(cp, name))}
    for kind in sorted({*kinds, *RECORDS.values()}, key=lambda kind: kind.__name__):
        for name in dir(kind):
            member = inspect.getattr_static(kind, name)
            member = getattr(member, "__func__", member)
            is_own = member.__module__.startswith("crankpin.") if inspect.isfunction(member) else 0
            if is_own and not name.startswith("_"):
                yield f"{kind.__name__}.{name}", getattr(kind, name)


CALLABLES = dict(public())
PRESET: Any = cp.Engine.preset
FROM_BORE_STROKE: Any = cp.Cylinder.from_bore_stroke
SWEEP: Any = cp.sweep


@in_turn("name", CALLABLES)
def test_slips_in_names_of_arguments_are_answered(name: str) -> None:
    function = CALLABLES[name]
    kinds = inspect.Parameter
    parameters = inspect.signature(function).parameters.values()
    if any(each.kind is kinds.VAR_KEYWORD for each in parameters):
        return  # takes them, and says itself which it does not know
    names = [each.name for each in parameters if each.kind is not kinds.POSITIONAL_ONLY]
    for argument in names:
        if argument == "self" or len(argument) < 4:
            continue
        wrong = argument[:-2] + argument[:-3:-1] if argument[-1] != argument[-2] else argument[:-1]
        if wrong in names:
            continue
        with pytest.raises(TypeError, match=rf"'{wrong}'.*(did you mean|is an argument of)"):
            function(**{wrong: None})


@pytest.mark.parametrize(
    ("call", "way"),
    [
        (lambda e: e.replace(bank_angle_deg=60), "Engine.with_bank_angle"),
        (lambda _: PRESET("v6-60", bank_angle_deg=60), "Engine.with_bank_angle"),
        (lambda _: FROM_BORE_STROKE(piston_mass=0.3), "Cylinder.from_rod"),
        (lambda e: e.balance(rmp=3000), "did you mean 'rpm'"),
        (lambda e: e.balance(3000, [1, 2]), "give by name: orders"),
        (lambda e: SWEEP(e, rmp=3000), "did you mean 'rpm'"),
    ],
)
def test_errors_name_the_way(call: Callable[[cp.Engine], Any], way: str) -> None:
    with pytest.raises(TypeError, match=way):
        call(cp.Engine.preset("v6-60"))


def test_errors_from_within_stay_as_they_are() -> None:
    def inner(rpm: float) -> float:
        return rpm

    def outer() -> float:
        return inner(rmp=3)  # type: ignore[call-arg]

    with pytest.raises(TypeError) as error:
        calls.guided(outer)()
    assert "did you mean" not in str(error.value).lower() or "Did you mean" in str(error.value)


def test_a_guided_call_takes_little_time() -> None:
    """A call of a guided function takes less than that of a balance by a factor of 10."""
    guided = calls.guided(lambda rpm: rpm)
    balance = cp.Engine.preset("single").balance
    several = min(timeit.repeat(lambda: guided(rpm=3), number=1000, repeat=5))
    assert several < min(timeit.repeat(lambda: balance(rpm=3), number=100, repeat=5))


@in_turn("name", [name for name in RECORDS if name not in cp.__all__])
def test_results_have_no_replace(name: str) -> None:
    assert not hasattr(RECORDS[name], "replace")


@in_turn("kind", [cp.Unbalance, *RECORDS.values()])
def test_a_field_has_one_type(kind: type) -> None:
    for field in getattr(kind, "_fields", ()):
        types = {each.strip() for each in str(field.type).split("|")} - {"None"}
        assert not ("str" in types and types & {"float", "int"}), field.name


def test_warnings_of_a_loop_are_shown_once_for_its_line() -> None:
    """Whatever figures an optimiser tries; of another line they are shown again."""
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("default")
        for k in range(50):
            cp.Cylinder(43.0 + k / 7.0, 145.0, 0.45)
        assert len(shown) == 1
        cp.Cylinder(43.0, 145.0, 0.45)
        assert len(shown) == 2
        for _ in range(3):
            cp.throws("1-2", intervals_deg=[360, 360])
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        for k in range(5):
            cp.Cylinder(43.0 + k, 145.0, 0.45)
    assert len({str(each.message) for each in shown}) == 5
