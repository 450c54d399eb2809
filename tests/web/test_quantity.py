"""Does the workbench read numbers with units as the shell does?"""

from __future__ import annotations

import re
from decimal import Decimal
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from crankpin._support import units
from crankpin.cli import arguments

if TYPE_CHECKING:
    from support.core_in_page import Ask

pytestmark = pytest.mark.slow  # a browser


def read(ask: Ask, texts: list[tuple[str, str, str]]) -> list[tuple[float | None, str]]:
    """Values of texts, each with its unit and that of plain numbers, or hints."""
    calls = [
        ("quantity", {"text": text, "unit": unit, "plain": plain}) for text, unit, plain in texts
    ]
    return [
        (answer["result"]["values"][0], "")
        if "result" in answer
        else (None, answer["error"]["hint"])
        for answer in ask(calls)
    ]


def test_every_unit_that_the_library_reads(ask: Ask) -> None:
    words = [*units.SYMBOLS, *units.ALIASES]
    words += [each for word in words for each in (word.lower(), word.upper(), word.title())]
    texts = [(f"3.1 {word}", unit, "") for word in words for unit in ("m", "kg")]
    got = read(ask, texts)
    for (text, unit, _), (value, _) in zip(texts, got, strict=True):
        factor = units.exact(text[4:], arguments.TYPED_UNITS[unit])
        expected = None if factor is None else float(Decimal("3.1") * factor)
        assert value == expected, text


def test_numbers_are_the_library_s_to_the_last_bit(ask: Ask) -> None:
    chance = np.random.default_rng(4)
    cases = []
    for _ in range(2000):
        digits = "".join(map(str, chance.integers(0, 10, chance.integers(1, 18))))
        point = chance.integers(0, len(digits) + 1)
        number = f"{digits[:point] or '0'}.{digits[point:]}" if chance.random() < 0.8 else digits
        number += str(chance.choice(["", "", "e-3", "E+2"]))
        unit = str(chance.choice(["m", "kg"]))
        word = chance.choice(
            [w for w in units.SYMBOLS if units.exact(w, arguments.TYPED_UNITS[unit])]
        )
        sign, gap = str(chance.choice(["", "-", "+"])), str(chance.choice(["", " "]))
        cases.append((sign + number, gap, str(word), unit))
    got = read(ask, [(f"{number}{gap}{word}", unit, "") for number, gap, word, unit in cases])
    for (number, _, word, unit), (value, _) in zip(cases, got, strict=True):
        assert value is not None
        factor = units.exact(word, arguments.TYPED_UNITS[unit])
        assert factor is not None
        assert float(value) == float(Decimal(number) * factor), (number, word)


def test_plain_numbers_are_in_the_unit_of_the_setting(ask: Ask) -> None:
    got = read(ask, [("86", "m", "mm"), ("3,5", "m", "in"), ("3.5", "m", "in"), ("12", "kg", "oz")])
    inches = float(Decimal("3.5") * units.LENGTHS["in"])
    ounces = float(12 * units.MASSES["oz"])
    assert [value for value, _ in got] == [0.086, inches, inches, ounces]


@pytest.mark.parametrize(
    ("text", "unit", "hint"),
    [
        ("", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("abc", "kg", "give a number, such as 12 or with a unit (g, lb, oz)"),
        ("12 kg", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("1e999", "m", "give a finite number"),
        ("1,000", "kg", "may be grouped in thousands: write 1000 or 1.000"),
        ("12 mn", "m", "give a number, such as 12 or with a unit (mm, in); did you mean mm?"),
        ("constructor", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("1 constructor", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("1 __proto__", "kg", "give a number, such as 12 or with a unit (g, lb, oz)"),
    ],
)
def test_what_is_no_number_says_what_to_give(ask: Ask, text: str, unit: str, hint: str) -> None:
    assert read(ask, [(text, unit, "mm")]) == [(None, hint)]


def test_fractions_of_an_inch_are_the_shell_s(ask: Ask) -> None:
    texts = ["3 7/16in", '3-7/16"', "1/2", "-7 1/3 in", "3½", '⅝"', "+2 1/7 mm", "1/0 in", "1/2/3"]
    got = read(ask, [(text, "m", "in") for text in texts])
    numbers = [3.4375, 3.4375, 0.5, None, 3.5, 0.625, None]
    third, seventh = Decimal(22) / Decimal(3), Decimal(15) / Decimal(7)
    expected = [None if number is None else float(Decimal(str(number)) * units.LENGTHS["in"])
                for number in numbers]  # fmt: skip
    expected[3] = float(-third * units.LENGTHS["in"])
    expected[6] = float(seventh * units.LENGTHS["mm"])
    assert [value for value, _ in got] == [*expected, None, None]


def test_shell_and_page_read_the_same(ask: Ask) -> None:
    """Numbers of signs that people type, drawn from few, in each form."""
    chance = np.random.default_rng(11)
    signs = [
        "1",
        "5",
        "0",
        "00",
        "500",
        "000",
        ",",
        ",",
        ".",
        " ",
        "mm",
        "g",
        "%",
        ":",
        "-",
        "/",
        "e",
    ]
    cases = []
    for _ in range(3000):
        text = "".join(chance.choice(signs, chance.integers(1, 8)))
        unit = str(chance.choice(["m", "kg", "rpm", "°", ""]))
        cases.append((text, unit, str(chance.choice(["number", "list", "range", "several"]))))
    calls = [("quantity", {"text": text, "unit": unit, "form": form}) for text, unit, form in cases]
    count = 0
    for (text, unit, form), answer in zip(cases, ask(calls), strict=True):
        if "error" in answer:
            message = re.escape(answer["error"]["message"])
            with pytest.raises(cp.InputError, match=rf"^{message}$"):
                _core.read_numbers("value", text, unit, form=form)
        else:
            count += 1
            values = _core.read_numbers("value", text, unit, form=form)[0]
            assert answer["result"]["values"] == values, text
    assert count > 300
