"""Errors for unknown arguments, with the argument that was probably meant."""

from __future__ import annotations

import difflib
import functools
import inspect
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

UNEXPECTED = re.compile(r"unexpected keyword argument '(\w+)'")
MOST_NAMED = 8
"""Arguments that an error lists."""


def guided(function: Callable[..., Any], owner: type | None = None) -> Callable[..., Any]:
    """Return a function that says how to call it where its arguments are wrong.

    Parameters
    ----------
    function
        A function or method.
    owner
        The class of a method, whose other methods may take the argument.
    """

    @functools.wraps(function)
    def call(*args: object, **named: object) -> Any:  # noqa: ANN401 - of any function
        try:
            return function(*args, **named)
        except TypeError as error:
            # One with a further frame comes from within the function.
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise
            text = f"{error}{_hint(function, owner, str(error))}"
        raise TypeError(text)

    return call


def guide(kind: type, owner: type | None = None, *, with_constructor: bool = False) -> None:
    """Make the public methods that a class adds guided ones, and its constructor if asked.

    ``owner`` is the class by whose name its methods are called, if that is another.
    """
    owner = kind if owner is None else owner
    for name, member in [*vars(kind).items()]:
        if name.startswith("_") and not (with_constructor and name == "__init__"):
            continue
        if isinstance(member, (classmethod, staticmethod)):
            if not hasattr(member.__func__, "__wrapped__"):
                setattr(kind, name, type(member)(guided(member.__func__, owner)))
        elif inspect.isfunction(member) and not hasattr(member, "__wrapped__"):
            setattr(kind, name, guided(member, owner))


def _hint(function: Callable[..., Any], owner: type | None, error: str) -> str:
    """Return what to call in place of it."""
    parameters = inspect.signature(function).parameters
    names = [name for name in parameters if name not in ("self", "cls")]
    if (unexpected := UNEXPECTED.search(error)) is None:
        if "positional argument" not in error or "missing" in error:
            return ""
        kinds = inspect.Parameter
        named = [name for name in names if parameters[name].kind is kinds.KEYWORD_ONLY]
        return f"; give by name: {_listed(named)}" if named else ""
    name = unexpected[1]
    if others := [*_that_take(owner, name)]:
        return f"; it is an argument of {_listed(others)}"
    if near := difflib.get_close_matches(name, names, 1):
        return "" if "Did you mean" in error else f"; did you mean '{near[0]}'?"
    return f"; it takes {_listed(names)}" if names else ""


def _that_take(owner: type | None, argument: str) -> Iterator[str]:
    """Yield the public methods of a class that take an argument, those that change one first."""
    if owner is None:
        return
    names = [name for name in dir(owner) if not name.startswith("_")]
    for name in sorted(names, key=lambda name: (not name.startswith("with_"), name)):
        member = inspect.getattr_static(owner, name)
        member = getattr(member, "__func__", member)
        if inspect.isfunction(member) and argument in inspect.signature(member).parameters:
            yield f"{owner.__name__}.{name}"


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MOST_NAMED]) + (", …" if len(names) > MOST_NAMED else "")
