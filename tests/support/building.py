"""The workbench, built for tests, which skip where its core is not compiled, and how it is used."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Any

import crankpin as cp
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Locator, Page

    from support.chromium import Open

SITE = Path(__file__).parents[2] / "site"
NOT_BUILT = "the core for browsers is not built: packaging/web"


def builder() -> Any:  # noqa: ANN401 - a module
    """Return the module ``site/build.py``, whose folder is no package."""
    spec = importlib.util.spec_from_file_location("workbench_build", SITE / "build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page, of the core that was compiled last."""
    build = builder()
    if not build.WASM.exists():
        pytest.skip(NOT_BUILT)
    file: Path = tmp_path_factory.mktemp("site") / "index.html"
    file.write_bytes(build.build(build.WASM.read_bytes()).encode())
    return file


@pytest.fixture
def open_workbench(workbench: Path, open_file: Open) -> Callable[..., Page]:
    """Open the workbench, with the engine of a fragment, and wait for its picture."""

    def opened(fragment: str = "", **context: object) -> Page:
        # Nothing turns by itself where the reader wants things still.
        page = open_file(workbench, fragment=fragment, **{"reduced_motion": "reduce"} | context)
        page.wait_for_selector(".turning .scene")
        return page

    return opened


def field(page: Page, name: str) -> Locator:
    return page.locator(f"[data-field={name}]:visible")


def type_in(page: Page, **texts: str) -> None:
    """Type texts into fields, and leave each."""
    for name, text in texts.items():
        field(page, name).fill(text)
        field(page, name).press("Tab")
    settle(page)


def choose(page: Page, **choices: str) -> None:
    for name, value in choices.items():
        field(page, name).select_option(value)
    settle(page)


def settle(page: Page) -> None:
    """Wait for the frame after which an engine is the one that is typed."""
    page.evaluate("() => new Promise(requestAnimationFrame)")
    page.evaluate("() => new Promise(requestAnimationFrame)")


def engine(page: Page, slot: int = 0) -> cp.Engine:
    """Return the engine that the page has, by its file."""
    text: str = page.evaluate("slot => workbench.slots[slot].engine.toml", slot)
    return cp.Engine.from_toml(text)


def faults(page: Page) -> list[str]:
    page.wait_for_timeout(600)  # errors wait until nobody types
    return [text for text in page.locator(".entry .fault:visible").all_inner_texts() if text]


def take_file(page: Page, file: Path) -> None:
    page.locator("input[type=file]").set_input_files(file)
    page.wait_for_function("name => document.querySelector('.said').textContent.includes(name)",
                           arg=file.name)  # fmt: skip


def cells(page: Page, name: str) -> list[float]:
    page.wait_for_selector(f"td[data-name={name}]")
    shown = page.locator(f"td[data-name={name}]").all()
    return [float(cell.get_attribute("data-value") or "nan") for cell in shown]
