"""The core for browsers in an empty page, and calls of it."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

ROOT = Path(__file__).parents[2]
MODULE = ROOT / "target" / "web" / "crankpin.wasm"
LOADER = ROOT / "site" / "core.mjs"
NOT_BUILT = "the core for browsers is not built: packaging/web"

Calls = list[tuple[str, dict[str, Any]]]
Ask = Callable[[Calls], list[dict[str, Any]]]

START = """async ([loader, module]) => {
    const url = URL.createObjectURL(new Blob([loader], { type: "text/javascript" }));
    const { load } = await import(url);
    const bytes = Uint8Array.from(atob(module), (letter) => letter.charCodeAt(0));
    globalThis.core = await load(bytes);
}"""
ASK = """(calls) => {
    const answered = (name, given) => {
        try {
            return { result: core.call(name, given) };
        } catch (error) {
            const { message, argument, value, hint } = error;
            return { error: { name: error.name, message, argument, value, hint } };
        }
    };
    const long = (value) => Array.isArray(value) && value.length > 50 && Number.isFinite(value[0]);
    const typed = (_, value) => (long(value) ? Float64Array.from(value) : value);
    const plain = (_, value) => (ArrayBuffer.isView(value) ? [...value] : value);
    const answers = JSON.parse(calls, typed).map(([name, given]) => answered(name, given));
    return JSON.stringify(answers, plain);
}"""


@pytest.fixture(scope="module")
def core_page(browser: Browser) -> Iterator[Page]:
    """An empty page that has the core."""
    if not MODULE.exists():
        pytest.skip(NOT_BUILT)
    page = browser.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.evaluate(
        START, [LOADER.read_text("utf-8"), base64.b64encode(MODULE.read_bytes()).decode()]
    )
    yield page
    assert all(url.startswith("blob:") for url in asked)  # nothing leaves
    page.close()


@pytest.fixture(scope="module")
def ask(core_page: Page) -> Ask:
    """Call the core, several times at once."""
    return lambda calls: json.loads(core_page.evaluate(ASK, json.dumps(calls)))
