"""Does a test of values in turn try each, fail with any, and name the one that failed?"""

from __future__ import annotations

import inspect

import pytest
from support import in_turn


def test_every_value_is_tried_beside_fixtures() -> None:
    tried = []

    @in_turn("number", range(3))
    @in_turn(("letter", "word"), [("a", "b"), pytest.param("c", "d", id="last")])
    def test(folder: str, letter: str, word: str, number: int) -> None:
        tried.append(f"{folder}{number}{letter}{word}")

    assert list(inspect.signature(test).parameters) == ["folder"]
    test(folder="x")
    assert tried == ["x0ab", "x0cd", "x1ab", "x1cd", "x2ab", "x2cd"]


def test_the_value_that_fails_is_named() -> None:
    @in_turn("number", [3, 4, 5])
    def test(number: int) -> None:
        assert number != 5

    with pytest.raises(AssertionError) as raised:
        test()
    assert raised.value.__notes__ == ["in turn 2: {'number': 5}"]


def test_values_that_are_skipped_do_not_hide_those_that_fail() -> None:
    @in_turn("number", [0, 1])
    def test(number: int) -> None:
        if number == 0:
            pytest.skip("zero")
        assert number == 0

    with pytest.raises(AssertionError):
        test()
    with pytest.raises(pytest.skip.Exception, match="zero"):
        in_turn("number", [0])(inspect.unwrap(test))()


def test_no_values_are_no_test() -> None:
    with pytest.raises(AssertionError, match="no values"):
        in_turn("number", [])(lambda number: None)()
    with pytest.raises(AssertionError, match="other"):
        in_turn("other", [1])(lambda number: None)
