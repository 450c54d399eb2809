"""A browser for the tests of pages: Debian's Chromium, or any that is on the path."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from pathlib import Path

    import crankpin as cp
    from playwright.sync_api import Browser, Page

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "chrome")
"""The first has no windows: 0.8 s of work to open a page, where the others take 2.5 s."""
ARGUMENTS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]

Open = Callable[..., "Page"]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One browser for a file of tests, which skip without one."""
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        pytest.skip("needs Chromium: apt-get install chromium-headless-shell")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def open_file(browser: Browser) -> Iterator[Open]:
    """Open a file; when the test ends the page must have asked for nothing and met no error."""
    contexts = []
    troubles: list[str] = []

    def opened(file: Path, *, fragment: str = "", **context: object) -> Page:
        size = {"width": 1280, "height": 1000}
        options: dict[str, Any] = {"viewport": size} | context
        contexts.append(browser.new_context(**options))
        page = contexts[-1].new_page()
        page.on("console", lambda message: troubles.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: troubles.append(f"{error}"))
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(file.as_uri() + fragment)
        page.asked = asked  # type: ignore[attr-defined]
        return page

    yield opened
    for context in contexts:
        context.close()
    assert troubles == []


@pytest.fixture
def open_engine(open_file: Open, tmp_path: Path) -> Open:
    """Open the page of an engine, or of one on its mounts."""

    def opened(
        engine: cp.Engine | cp.Powertrain,
        *,
        rpm: float = 3000.0,
        save: dict[str, Any] | None = None,
        **context: object,
    ) -> Page:
        file = tmp_path / "engine.html"
        engine.save_html(file, rpm=rpm, **(save or {}))
        return open_file(file, **context)

    return opened


def values(page: Page, selector: str = "[data-name]") -> dict[str, float]:
    """Return the numbers that a page shows, by name."""
    pairs = page.eval_on_selector_all(
        selector, "found => found.map(each => [each.dataset.name, each.dataset.value])"
    )
    numbers = {}
    for name, value in pairs:
        try:
            numbers[name] = float(value)
        except ValueError:
            continue
    return numbers
