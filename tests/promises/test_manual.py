"""Is the manual complete?"""

from __future__ import annotations

import re
from pathlib import Path

import crankpin as cp

DOCS = Path(__file__).parents[2] / "docs"
TOCTREE = re.compile(r"```\{toctree\}\n(?::\w+:.*\n)*\n(.*?)```", re.DOTALL)


def test_its_reference_has_every_public_name() -> None:
    pages = [path.read_text(encoding="utf-8") for path in DOCS.glob("reference/*.md")]
    found = re.findall(
        r"^\.\. auto\w+:: (crankpin\.(?:types\.)?\w+)$", "\n".join(pages), re.MULTILINE
    )
    named = {f"crankpin.{name}" for name in cp.__all__ if name != "types"}
    named |= {f"crankpin.types.{name}" for name in cp.types.__all__}
    assert sorted(found) == sorted(named)


def test_every_page_is_in_a_table_of_contents_and_on_the_page_of_its_folder() -> None:
    for index in DOCS.glob("*/index.md"):
        if index.parent.name == "gallery":  # made by the build
            continue
        text = index.read_text(encoding="utf-8")
        pages = {path.stem for path in index.parent.iterdir() if path.suffix in (".md", ".ipynb")}
        (listed,) = TOCTREE.findall(text)
        assert set(listed.split()) == pages - {"index"}
        linked = re.findall(r"\]\(([^)/]+)\.(?:md|ipynb)\)", text)
        assert set(linked) == pages - {"index"}
