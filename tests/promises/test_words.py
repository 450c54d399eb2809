"""Is the project's prose written in the words of ``words.toml``?

Prose is what people read: docstrings, messages, labels and comments of the package, words of its
pages, the manual, README, and the text of notebooks. Code in backticks, fences and examples is not.
"""

from __future__ import annotations

import ast
import io
import json
import re
import tokenize
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
FOLDERS = {
    "python/crankpin": ("*.py", "*strings.mjs"), "docs": ("*.md",), "notebooks": ("*.ipynb",),
    "site": ("words.mjs", "fields.mjs", "*.py"),
    "rust/core/src": ("*.rs",), "rust/py/src": ("*.rs",), ".": ("*.md",),
}  # fmt: skip
"""Folder → names of the files whose prose is checked, in it and, but for the root, below it."""
LISTS = tomllib.loads(Path(__file__).with_name("words.toml").read_text("utf-8"))
WORDS = {pattern: instead for each in LISTS.values() for pattern, instead in each.items()}
PATTERNS = {
    # Words of a phrase may stand on two lines.
    pattern: re.compile(
        r"(?<![\w-])(?:" + pattern.replace(" ", r"\s+") + r")(?![\w-])", re.IGNORECASE
    )
    for pattern in WORDS
}
CODE = re.compile(
    r"^(?:```|~~~).*?^(?:```|~~~)$|``.*?``|`[^`\n]*`|\]\([^)\s]*\)|https?://\S+"
    r"|^ *(?:>>>|\.\.\.) .*?$|^\$\$.*?^\$\$|\{[^{}\n]*\}|crankpin\[\w+\]",
    re.MULTILINE | re.DOTALL,
)
"""Fenced blocks, text in backticks, addresses, lines of examples, formulae, fields, and extras."""


class Piece(NamedTuple):
    """A piece of prose, and the line on which it begins."""

    line: int
    text: str


def of_python(source: str) -> Iterator[Piece]:
    """Yield docstrings, other strings of several words, and comments."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            yield Piece(node.lineno, node.value)
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    yield from joined([(t.start[0], t.string) for t in tokens if t.type == tokenize.COMMENT])


def joined(lines: list[tuple[int, str]]) -> Iterator[Piece]:
    """Yield comments on lines that follow each other as one piece."""
    first, texts = 0, list[str]()
    for number, text in lines:
        if texts and number != first + len(texts):
            yield Piece(first, "\n".join(texts))
            texts = []
        first = first if texts else number
        texts.append(text.lstrip("#/!"))
    if texts:
        yield Piece(first, "\n".join(texts))


def of_rust(source: str) -> Iterator[Piece]:
    """Yield comments, of the library and not of its tests."""
    lines = enumerate((line.strip() for line in source.splitlines()), 1)
    yield from joined([(number, line) for number, line in lines if line.startswith("//")])


def of_notebook(source: str) -> Iterator[Piece]:
    """Yield the cells of text, each from line 1."""
    for cell in json.loads(source)["cells"]:
        if cell["cell_type"] == "markdown":
            yield Piece(1, "".join(cell["source"]))


def of_text(source: str) -> Iterator[Piece]:
    yield Piece(1, source)


PROSE = {
    ".py": of_python, ".rs": of_rust, ".ipynb": of_notebook, ".md": of_text, ".mjs": of_text,
}  # fmt: skip


def found(source: str, suffix: str) -> list[str]:
    """Return each word of the list in some prose, where it is, and what to write instead."""
    listed = []
    for piece in PROSE[suffix](source):
        # Code goes, the lines that it has stay.
        text = CODE.sub(lambda code: "\n" * code.group().count("\n") or "x", piece.text)
        for pattern, compiled in PATTERNS.items():
            for match in compiled.finditer(text):
                line = piece.line + text.count("\n", 0, match.start())
                words = " ".join(match.group().split())
                listed.append(f"line {line}: {words!r}: write {WORDS[pattern]}")
    return listed


@pytest.mark.parametrize("folder", FOLDERS)
def test_prose_has_the_words_of_the_list(folder: str) -> None:
    below = "" if folder == "." else "**/"
    paths = [path for name in FOLDERS[folder] for path in (ROOT / folder).glob(below + name)]
    assert paths
    wrong = [
        f"{path.relative_to(ROOT)}, {each}"
        for path in sorted(paths)
        for each in found(path.read_text("utf-8"), path.suffix)
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    ("suffix", "source", "line"),
    [
        (".py", 'def f():\n    """Return the\n    imbalance of a shaft."""\n', 3),
        (".py", 'x = 1\nerror = f"{x} {y}: no imbalance is known"\n', 2),
        (".py", "x = 1\n# A comment that goes on to the\n# the next line.\n", 2),
        (".rs", "//! Shafts.\n\n/// An imbalance\nfn f() {}\n", 3),
        (".md", "# Title\n\n```sh\nimbalance\n```\n\nThe imbalance.\n", 7),
        (".ipynb", '{"cells": [{"cell_type": "markdown", "source": ["a", "\\nimbalance"]}]}', 2),
        (".mjs", 'export const shaft = "imbalance of the shaft";\n', 1),
    ],
)
def test_a_word_of_the_list_is_found(suffix: str, source: str, line: int) -> None:
    (only,) = found(source, suffix)
    assert only.startswith(f"line {line}: ")


@pytest.mark.parametrize(
    ("suffix", "source"),
    [
        (".py", 'def f():\n    """Return ``imbalance``.\n\n    >>> imbalance = 2\n    """\n'),
        (".py", 'ha = "center"\nimbalance = f"{imbalance} of a shaft"\n'),
        (".md", "See `imbalance` in [a page](https://example.org/imbalance).\n"),
        (".ipynb", '{"cells": [{"cell_type": "code", "source": ["# imbalance"]}]}'),
    ],
)
def test_code_is_not_prose(suffix: str, source: str) -> None:
    assert found(source, suffix) == []


@in_turn("pattern", WORDS)
def test_no_hint_has_a_word_of_the_list(pattern: str) -> None:
    assert WORDS[pattern]
    assert found(WORDS[pattern], ".md") == []


PYTHON = re.compile(
    r"\w=(?:…|True|False|None|\\\")|\borders=|\bstrokes=|\bcp\.|\bto_dask\b|\.on\(|\bwith_\w+\("
    r"|\b(?:Engine|Firing|Cylinder)\.[a-z]|\b(?:Port|Valve)Timing\b"
)
"""Calls and names that Python alone has."""
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)


def literals(source: str) -> list[str]:
    """Return the strings of a Rust file, without comments and tests, each on one line."""
    code = re.sub(r"^\s*//.*$", "", source.partition("#[cfg(test)]")[0], flags=re.MULTILINE)
    code = code.replace(r"'\"'", "").replace("'\"'", "")
    return [re.sub(r"\\\n\s*", "", text) for text in LITERAL.findall(code)]


def test_the_core_says_no_names_of_python_and_its_binding_adds_them() -> None:
    paths = (ROOT / "rust/core/src").rglob("*.rs")
    said = [text for path in paths for text in literals(path.read_text("utf-8"))]
    assert not [text for text in said if " " in text and PYTHON.search(text)]
    binding = (ROOT / "rust/py/src/convert.rs").read_text("utf-8")
    (table,) = re.findall(r"const NAMES: .*?= \[\n(.*?)\n\];", binding, re.DOTALL)
    names = re.findall(r'\("(.*?)", "(.*?)"\),\n', table + "\n")
    assert len(names) == table.count("\n") + 1
    for rust, python in names:
        assert any(rust in text for text in said), rust
        assert PYTHON.search(python) or python == "Engine.flat", python


@pytest.mark.parametrize(
    "text", ["give bore=… to it", "or strokes=4", "torque=False was given", "p.with_support(…)"]
)
def test_names_of_python_are_known(text: str) -> None:
    (literal,) = literals(f'error("{text}")')
    assert PYTHON.search(literal)
