"""Does ``help()`` of everything public state parameters, types, defaults and results?

By introspection of what ``crankpin.__all__`` reaches, against the numpydoc standard.
"""

from __future__ import annotations

import ast
import functools
import inspect
import re
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import pytest
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Iterator

SECTIONS = (
    "Parameters", "Attributes", "Returns", "Raises", "Warns", "See Also", "Notes", "References",
    "Examples",
)  # fmt: skip
"""Sections in the order of numpydoc, those of which entries are listed first."""
LISTED = SECTIONS[:5]
ANNOTATION = re.compile(r" \| |\b(?:Sequence|Iterable|Mapping|Literal|Optional|Union|NDArray)\b")
"""What a type in words does not have."""

ELSEWHERE = re.compile(r"^As (?:in|for) :|\bor\s+as\s+for\s+:|^…|\bor …\.")
"""What an entry says that is not whole in itself."""
SHAPE = re.compile(r"\((?:…|n_\w+|2)(?:, (?:n_\w+|2))*,?\)")
"""Shape of an array, such as (n_cylinders, n_theta, 2)."""
STARS: dict[Any, str] = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}


class Entry(NamedTuple):
    """An entry of a section: a line such as ``rpm, load : float``, and the text below it."""

    names: tuple[str, ...]
    written: str
    text: str


def sections_of(docstring: str) -> dict[str, str]:
    """Return the sections by title; the summary is that of the empty title."""
    parts = re.split(r"^([A-Z][\w ]*)\n-{3,}$", docstring, flags=re.MULTILINE)
    return {"": parts[0].strip()} | dict(zip(parts[1::2], parts[2::2], strict=True))


def entries(section: str) -> list[Entry]:
    """Return the entries of a section."""
    heads = re.findall(r"^(\S.*)\n((?:[ \t]+\S.*\n|\s*\n)*)", f"{section.strip()}\n", re.MULTILINE)
    return [
        Entry(tuple(names.split(", ")) if colon else (), written if colon else head, text.strip())
        for head, text in heads
        for names, colon, written in [head.partition(" : ")]
    ]


def wrong_sections(docstring: str) -> Iterator[str]:
    """Yield what is wrong with titles, their order, and entries without text."""
    titles = [title for title in sections_of(docstring) if title]
    underlined = re.findall(r"^([A-Z].*)\n-+$", docstring, re.MULTILINE)
    if underlined != sorted(titles, key=lambda title: [*SECTIONS, title].index(title)):
        yield f"sections {underlined}"
    yield from (f"section {title}" for title in titles if title not in SECTIONS)
    if not sections_of(docstring)[""].split("\n\n")[0].rstrip().endswith((".", "?")):
        yield "summary is no sentence"
    for title in LISTED:
        for entry in entries(sections_of(docstring).get(title, "")):
            if not entry.text:
                yield f"{title}: {entry.written}: no text"
            if ELSEWHERE.search(entry.text):
                yield f"{title}: {entry.written}: the text is elsewhere"
            if ANNOTATION.search(entry.written):
                yield f"{title}: {entry.written} is an annotation"


def wrong_parameters(docstring: str, parameters: list[inspect.Parameter]) -> Iterator[str]:
    """Yield what is wrong with the parameters: names, sequence, types and defaults."""
    section = entries(sections_of(docstring).get("Parameters", ""))
    documented = [(name, entry.written) for entry in section for name in entry.names]
    untyped = [entry.written for entry in section if not entry.names]
    if untyped:
        yield f"no type of {untyped}"
    expected = [STARS.get(parameter.kind, "") + parameter.name for parameter in parameters]
    if [name for name, _ in documented] != expected:
        yield f"documented are {[name for name, _ in documented]}, not {expected}"
        return
    for (name, written), parameter in zip(documented, parameters, strict=True):
        has_default = parameter.default is not parameter.empty or parameter.kind in STARS
        states_one = re.search(r", optional$|, default (.*)$", written)
        if bool(states_one) is not has_default:
            yield f"{name} : {written}: optional or default where the signature has one, not else"
        elif states_one and states_one[1] and ast.literal_eval(states_one[1]) != parameter.default:
            yield f"{name} : {written}: the default is {parameter.default!r}"


def wrong_with(name: str, thing: Any) -> list[str]:  # noqa: ANN401 - a class, function or property
    """Return all that is wrong with a docstring."""
    docstring = inspect.getdoc(thing)
    if not docstring:
        return ["no docstring"]
    problems = [*wrong_sections(docstring)]
    if isinstance(thing, (property, functools.cached_property)):
        function: Any = thing.fget if isinstance(thing, property) else thing.func
        is_array = inspect.signature(function).return_annotation.startswith("NDArray")
        if is_array and not SHAPE.search(docstring):
            problems.append("an array without a shape")
        return problems
    if inspect.isclass(thing):
        if name not in CONSTRUCTED:
            return problems
        parameters = [*inspect.signature(thing).parameters.values()]
        return [*problems, *wrong_parameters(docstring, parameters)]
    signature = inspect.signature(thing)
    parameters = [
        parameter for name, parameter in signature.parameters.items() if name not in {"self", "cls"}
    ]
    problems += wrong_parameters(docstring, parameters)
    returns = signature.return_annotation not in {None, "None"}
    if returns is not ("Returns" in sections_of(docstring)):
        problems.append(f"Returns of {signature.return_annotation}")
    return problems


def members(kind: type) -> Iterator[tuple[str, Any]]:
    """Yield the public methods and properties of a class that this package defines."""
    if hasattr(kind, "plot"):
        yield f"{kind.__name__}.plot", kind.plot
    for base in kind.__mro__:
        if not base.__module__.startswith("crankpin"):
            continue
        for name, member in vars(base).items():
            function = getattr(member, "__func__", member)  # of class methods
            if not name.startswith("_") and (
                inspect.isfunction(function)
                or isinstance(function, (property, functools.cached_property))
            ):
                yield f"{base.__name__}.{name}", function


CONSTRUCTED = {name for name in cp.__all__ if inspect.isclass(getattr(cp, name))} - {
    "Engine",
    "InputError",
}
"""Classes that people construct; functions and builders make the others."""


def public() -> dict[str, Any]:
    """Return all that is public, by name."""
    names = sorted({*cp.__all__} - {"results", "__version__"})
    things = {name: getattr(cp, name) for name in names}
    things |= {name: getattr(cp.results, name) for name in cp.results.__all__}
    for kind in filter(inspect.isclass, [*things.values()]):
        things |= dict(members(kind))
    return things


PUBLIC = public()


@in_turn("name", PUBLIC)
def test_docstring_states_parameters_types_and_results(name: str) -> None:
    assert wrong_with(name, PUBLIC[name]) == []


@in_turn("name", cp.results.__all__)
def test_help_of_a_result_has_its_fields(name: str) -> None:
    kind = getattr(cp.results, name)
    fields = {field.name for field in kind._fields if not field.name.startswith("_")}
    listed = entries(sections_of(inspect.getdoc(kind) or "").get("Attributes", ""))
    assert {name for entry in listed for name in entry.names} == fields


def function(rpm: float, orders: str = "auto", **style: object) -> float:
    return rpm


SOUND = """Return a value.

Parameters
----------
rpm : float
    Crank speed, rpm.
orders : sequence of int or "auto", default "auto"
    Multiples of crank speed.
**style : dict, optional
    Properties.

Returns
-------
float
    A value.

Raises
------
InputError
    If the speed is below zero.

"""
RETURNS = "Returns\n-------\nfloat\n    A value.\n\n"
RAISES = "Raises\n------\nInputError\n    If the speed is below zero.\n\n"


def test_a_sound_docstring_passes() -> None:
    function.__doc__ = SOUND
    assert wrong_with("function", function) == []


@pytest.mark.parametrize(
    ("part", "instead"),
    [
        ("rpm : float\n", "rpm\n"),
        ("rpm : float\n", "speed : float\n"),
        ("rpm : float\n    Crank speed, rpm.\n", ""),
        ("rpm : float\n", "rpm : float, optional\n"),
        ("rpm : float\n", "rpm : float | None\n"),
        ('"auto", default "auto"', '"auto"'),
        ('"auto", default "auto"', '"auto", default "all"'),
        ("**style : dict, optional", "style : dict, optional"),
        ("    A value.\n", ""),
        ("    Crank speed, rpm.\n", "    As in :meth:`balance`.\n"),
        ("Raises\n------", "Throws\n------"),
        ("Return a value.", "Return a value"),
        (SOUND[: SOUND.index("Returns")], "Return a value.\n\n"),
        (RETURNS, ""),
        (RETURNS + RAISES, RAISES + RETURNS),
        (SOUND, ""),
    ],
)  # fmt: skip
def test_a_broken_docstring_does_not(part: str, instead: str) -> None:
    function.__doc__ = SOUND.replace(part, instead)
    assert function.__doc__ != SOUND
    assert wrong_with("function", function)
