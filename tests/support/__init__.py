"""What tests share: the folder of tables, what notebooks show, and values in turn."""

from __future__ import annotations

import functools
import inspect
import reprlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from crankpin._support.frames import Framed

    Test = Callable[..., None]

DATA = Path(__file__).parents[1] / "data"
"""Tables of the sources, and reference values."""


def html_of(result: Framed) -> str:
    """Return what notebooks show of a result that is shown as tables."""
    text = result._repr_html_()
    assert text is not None
    return text


def in_turn(names: str | Sequence[str], values: Iterable[Any]) -> Callable[[Test], Test]:
    """Call a test with each of the values in turn, as one test; a failure names the value.

    For seeds, and for lists too long for a test of each item; arguments are those of
    ``pytest.mark.parametrize``.
    """
    arguments = [name.strip() for name in names.split(",")] if isinstance(names, str) else [*names]
    rows: list[dict[str, Any]] = []
    for value in values:
        row = (value,) if len(arguments) == 1 else value
        if isinstance(value, type(pytest.param())):
            assert not value.marks, "a test has marks, not its values"
            row = value.values
        rows.append(dict(zip(arguments, row, strict=True)))

    def decorate(test: Test) -> Test:
        @functools.wraps(test)
        def run(**fixtures: object) -> None:
            skipped = []
            for number, row in enumerate(rows):
                try:
                    test(**fixtures, **row)
                except pytest.skip.Exception as reason:
                    skipped.append(reason)
                except BaseException as error:
                    error.add_note(f"in turn {number}: {reprlib.repr(row)}")
                    raise
                finally:
                    if "matplotlib.pyplot" in sys.modules:
                        sys.modules["matplotlib.pyplot"].close("all")
            assert rows, "no values"
            if len(skipped) == len(rows):
                raise skipped[0]

        signature = inspect.signature(test)
        others = [value for name, value in signature.parameters.items() if name not in arguments]
        assert len(others) == len(signature.parameters) - len(arguments), names
        run.__signature__ = signature.replace(parameters=others)  # type: ignore[attr-defined]
        return run

    return decorate
