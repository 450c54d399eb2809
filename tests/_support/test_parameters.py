"""Are docstrings completed from those of functions with the same parameters?"""

from __future__ import annotations

import inspect

import pytest
from crankpin._support.parameters import SHARED, documented, entries, sections


def home(rpm: float, count: int = 3) -> None:
    """Return nothing.

    Parameters
    ----------
    rpm : float
        Crank speed, rpm.
    count : int, default 3
        Number of them; by default three.

    Raises
    ------
    InputError
        If a figure is out of range.
    """


def completed(docstring: str, **defaults: object) -> str:
    def function(rpm: float, *, count: int = 5, strokes: int = 4) -> int:
        return 0

    function.__doc__ = docstring
    return inspect.getdoc(documented(home)(function)) or ""


def test_parameters_are_those_of_the_home_with_the_defaults_of_the_signature() -> None:
    text = completed("Return a number.\n\n    Returns\n    -------\n    int\n        One.\n    ")
    assert [*sections(text)] == ["", "Parameters", "Returns", "Raises"]
    result = entries(text)
    assert [*result] == ["rpm", "count", "strokes"]
    assert result["rpm"] == entries(home.__doc__ or "")["rpm"]
    assert result["count"].words == "int, default 5"
    assert result["strokes"].words == "{4, 2}, default 4"
    assert result["strokes"].text == entries(SHARED)["strokes"].text
    assert "If a figure is out of range." in sections(text)["Raises"]


@pytest.mark.parametrize(
    ("typed", "text"),
    [
        ("Another number.", "Another number."),
        ("… Or none.", "Number of them; by default three. Or none."),
        ("…; by default five.", "Number of them; by default five."),
        ("Zero, or ….", "Zero, or number of them; by default three."),
        ("0, 1, …, 5.", "0, 1, …, 5."),
    ],
)
def test_an_entry_may_continue_that_of_the_home(typed: str, text: str) -> None:
    head = "Return a number.\n\n    Parameters\n    ----------\n    count : int, default 5\n"
    assert entries(completed(f"{head}        {typed}\n    "))["count"] == ("int, default 5", text)


def test_without_docstrings_nothing_is_completed() -> None:
    def function(rpm: float) -> None: ...

    assert documented(home)(function).__doc__ is None
