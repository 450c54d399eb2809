"""The workbench, built for tests, which skip where its core is not compiled."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

    from chromium import Open
    from playwright.sync_api import Page

SITE = Path(__file__).parents[1] / "site"
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
        page = open_file(workbench, fragment=fragment, **context)
        page.wait_for_selector(".turning .scene")
        return page

    return opened
