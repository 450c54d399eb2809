"""Does the workbench read numbers with units as the library does?"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

import numpy as np
import pytest
from building import SITE, builder
from crankpin._support import units
from crankpin.cli import arguments
from crankpin.view import page as pages

if TYPE_CHECKING:
    from pathlib import Path

    from chromium import Open
    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

READ = """(texts) => texts.map(([text, unit, plain]) => {
    try { return [quantity(text, unit, plain), ""]; } catch (error) { return [null, error.hint]; }
})"""


@pytest.fixture
def reader(open_file: Open, tmp_path: Path) -> Page:
    """A page with the workbench's reader of numbers alone."""
    script = "\n".join(pages.modules("quantity.mjs", folder=SITE).values())
    tables = pages.as_json(builder().tables())
    body = f'<script type="application/json" id="tables">{tables}</script>'
    text = pages.document("", (), f"{script}\nglobalThis.quantity = quantity;", body=body)
    (tmp_path / "reader.html").write_text(text, encoding="utf-8")
    return open_file(tmp_path / "reader.html")


def read(page: Page, texts: list[tuple[str, str, str]]) -> list[tuple[float | None, str]]:
    return [(value, hint) for value, hint in page.evaluate(READ, [list(text) for text in texts])]


def test_every_unit_that_the_library_reads(reader: Page) -> None:
    words = [*units.SYMBOLS, *units.ALIASES]
    words += [each for word in words for each in (word.lower(), word.upper(), word.title())]
    texts = [(f"3.1 {word}", unit, "") for word in words for unit in ("m", "kg")]
    got = read(reader, texts)
    for (text, unit, _), (value, _) in zip(texts, got, strict=True):
        factor = units.exact(text[4:], arguments.UNITS[unit])
        expected = None if factor is None else float(Decimal("3.1") * factor)
        assert value == expected, text


def test_numbers_are_the_library_s_to_the_last_bit(reader: Page) -> None:
    chance = np.random.default_rng(4)
    cases = []
    for _ in range(2000):
        digits = "".join(map(str, chance.integers(0, 10, chance.integers(1, 18))))
        point = chance.integers(0, len(digits) + 1)
        number = f"{digits[:point] or '0'}.{digits[point:]}" if chance.random() < 0.8 else digits
        number += str(chance.choice(["", "", "e-3", "E+2"]))
        unit = str(chance.choice(["m", "kg"]))
        word = chance.choice([w for w in units.SYMBOLS if units.exact(w, arguments.UNITS[unit])])
        sign, gap = str(chance.choice(["", "-", "+"])), str(chance.choice(["", " "]))
        cases.append((sign + number, gap, str(word), unit))
    got = read(reader, [(f"{number}{gap}{word}", unit, "") for number, gap, word, unit in cases])
    for (number, _, word, unit), (value, _) in zip(cases, got, strict=True):
        assert value is not None
        factor = units.exact(word, arguments.UNITS[unit])
        assert factor is not None
        assert float(value) == float(Decimal(number) * factor), (number, word)


def test_plain_numbers_are_in_the_unit_of_the_setting(reader: Page) -> None:
    got = read(
        reader, [("86", "m", "mm"), ("3,5", "m", "in"), ("3.5", "m", "in"), ("12", "kg", "oz")]
    )
    inches = float(Decimal("3.5") * units.LENGTHS["in"])
    ounces = float(12 * units.MASSES["oz"])
    assert [value for value, _ in got] == [0.086, inches, inches, ounces]


@pytest.mark.parametrize(
    ("text", "unit", "hint"),
    [
        ("", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("abc", "kg", "give a number, such as 12 or with a unit (g, lb, oz)"),
        ("12 kg", "m", "give a number with a unit of this kind (mm, in)"),
        ("1e999", "m", "give a finite number"),
        ("constructor", "m", "give a number, such as 12 or with a unit (mm, in)"),
        ("1 constructor", "m", "give a number with a unit of this kind (mm, in)"),
        ("1 __proto__", "kg", "give a number with a unit of this kind (g, lb, oz)"),
    ],
)
def test_what_is_no_number_says_what_to_give(reader: Page, text: str, unit: str, hint: str) -> None:
    assert read(reader, [(text, unit, "mm")]) == [(None, hint)]


def test_fractions_of_an_inch_are_the_shell_s(reader: Page) -> None:
    texts = ["3 7/16in", '3-7/16"', "1/2", "-7 1/3 in", "3½", '⅝"', "+2 1/7 mm", "1/0 in", "1/2/3"]
    got = read(reader, [(text, "m", "in") for text in texts])
    numbers = [3.4375, 3.4375, 0.5, None, 3.5, 0.625, None]
    third, seventh = Decimal(22) / Decimal(3), Decimal(15) / Decimal(7)
    expected = [None if number is None else float(Decimal(str(number)) * units.LENGTHS["in"])
                for number in numbers]  # fmt: skip
    expected[3] = float(-third * units.LENGTHS["in"])
    expected[6] = float(seventh * units.LENGTHS["mm"])
    assert [value for value, _ in got] == [*expected, None, None]
