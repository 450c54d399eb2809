"""Does the gallery show and link every preset?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import pytest
from crankpin.view.gallery import save_gallery

if TYPE_CHECKING:
    from pathlib import Path

    from support.chromium import Open

pytestmark = pytest.mark.slow  # a browser


def test_shows_and_links_all_presets(open_file: Open, tmp_path: Path) -> None:
    files = save_gallery(tmp_path / "gallery")
    assert [file.name for file in files] == ["index.html", *(f"{n}.html" for n in cp.presets())]
    page = open_file(files[0], viewport={"width": 360, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    links = page.eval_on_selector_all("a", "found => found.map(each => each.getAttribute('href'))")
    assert links == [file.name for file in files[1:]]
    names = page.eval_on_selector_all("a b", "found => found.map(each => each.textContent)")
    assert names == [engine.name for engine in cp.presets().values()]
    pistons = page.eval_on_selector_all(
        "a", "found => found.map(each => each.querySelectorAll('.piston').length)"
    )
    assert pistons == [len(engine) for engine in cp.presets().values()]
    assert page.asked == [files[0].as_uri()]  # type: ignore[attr-defined]
    page.get_by_role("link", name="V8 90°, cross-plane").first.click()
    assert page.locator("h1").text_content() == "V8 90°, cross-plane"


def test_engines_of_a_metre_turn_slowly(tmp_path: Path) -> None:
    save_gallery(tmp_path, rpm=4000)
    assert '"rpm":10.0' in (tmp_path / "i4-ebook.html").read_text(encoding="utf-8")
    assert '"rpm":4000.0' in (tmp_path / "i4.html").read_text(encoding="utf-8")
