"""Is the manual complete?"""

from __future__ import annotations

import re
from pathlib import Path

import crankpin as cp

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOKS = DOCS.parent / "notebooks"
TOCTREE = re.compile(r"```\{toctree\}\n(?::\w+:.*\n)*\n(.*?)```", re.DOTALL)


def test_its_reference_has_every_public_name() -> None:
    pages = [path.read_text(encoding="utf-8") for path in DOCS.glob("reference/*.md")]
    found = re.findall(
        r"^\.\. auto\w+:: (crankpin\.(?:results\.)?\w+)$", "\n".join(pages), re.MULTILINE
    )
    named = {f"crankpin.{name}" for name in cp.__all__ if name != "results"}
    named |= {f"crankpin.results.{name}" for name in cp.results.__all__}
    assert sorted(found) == sorted(named)


def test_every_page_is_in_a_table_of_contents_and_on_the_page_of_its_folder() -> None:
    for index in DOCS.glob("*/index.md"):
        if index.parent.name == "gallery":  # made by the build
            continue
        text = index.read_text(encoding="utf-8")
        pages = {path.stem for path in index.parent.glob("*.md")}
        if index.parent.name == "tutorials":  # the build copies the notebooks there
            pages |= {path.stem for path in NOTEBOOKS.glob("*.ipynb")}
        (listed,) = TOCTREE.findall(text)
        assert set(listed.split()) == pages - {"index"}
        linked = re.findall(r"\]\((?:\.\./\.\./notebooks/)?([^)/]+)\.(?:md|ipynb)\)", text)
        assert set(linked) == pages - {"index"}


def test_notebooks_are_in_one_folder() -> None:
    """Copies that a build made are not looked at."""
    kept = [path for path in DOCS.parent.glob("*/*.ipynb") if path.parent != DOCS / "tutorials"]
    assert {path.parent for path in kept} == {NOTEBOOKS}
    assert "/docs/tutorials/*.ipynb" in (DOCS.parent / ".gitignore").read_text("utf-8").split()


def test_links_in_the_repository_lead_somewhere() -> None:
    """From pages and notebooks as they lie here; the build checks those of the manual."""
    files = [*DOCS.rglob("*.md"), *NOTEBOOKS.glob("*.ipynb"), *DOCS.parent.glob("*.md")]
    for file in files:
        if "gallery" in file.parts:
            continue
        for target in re.findall(
            r"\]\((\.\.?/[^)#\s]+|[\w/-]+\.\w+)(?:#[^)]*)?\)", file.read_text("utf-8")
        ):
            if not target.startswith(("http", "/")) and "gallery/" not in target:
                assert (file.parent / target).exists(), f"{file}: {target}"
