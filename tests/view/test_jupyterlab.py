"""Does the widget turn in JupyterLab?"""

from __future__ import annotations

import importlib.util
import json
import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from support.chromium import values

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, Page

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        importlib.util.find_spec("jupyterlab") is None,
        reason="needs JupyterLab: pip install jupyterlab",
    ),
]

CELLS = [
    "import crankpin as cp\nwidget = cp.Engine.preset('v8-crossplane').view(rpm=5000)\nwidget",
    "widget.angle_deg, widget.bank_angle_deg = 97.25, 60",
    "print(widget.angle_deg, widget.rod_ratio, widget.engine.cylinders[0].rod_ratio)",
]


@pytest.fixture
def notebook(tmp_path: Path) -> Iterator[str]:
    """Address of a notebook with these cells, served by JupyterLab on this machine alone."""
    cells: list[dict[str, object]] = [
        {
            "cell_type": "code",
            "id": f"cell-{k}",
            "metadata": {},
            "execution_count": None,
            "outputs": [],
            "source": source,
        }
        for k, source in enumerate(CELLS)
    ]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    content = {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    (tmp_path / "engine.ipynb").write_text(json.dumps(content))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = [
        "--no-browser",
        "--allow-root",
        f"--port={port}",
        f"--ServerApp.root_dir={tmp_path}",
        "--IdentityProvider.token=",
        "--LabApp.news_url=None",
        "--LabApp.extension_manager=readonly",
    ]
    home = dict.fromkeys(("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "HOME"), f"{tmp_path}")
    server = subprocess.Popen(  # noqa: S603 - JupyterLab of this environment
        [sys.executable, "-m", "jupyterlab", *options],
        env=os.environ | home,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        root = f"http://127.0.0.1:{port}"
        _wait(f"{root}/api", server)
        yield f"{root}/lab/tree/engine.ipynb"
    finally:
        server.terminate()
        server.wait(30)


def _run(page: Page, cell: int, shows: Locator) -> None:
    """Run a cell; again if JupyterLab, still loading, took the keys for something else."""
    from playwright.sync_api import expect

    prompt = page.locator(".jp-Notebook .jp-CodeCell .jp-InputPrompt").nth(cell)
    for _ in range(6):
        page.locator(".jp-Notebook .jp-CodeCell .jp-InputArea-editor").nth(cell).click()
        page.keyboard.press("Shift+Enter")
        try:
            expect(prompt).not_to_have_text("[ ]:", timeout=10_000)
        except AssertionError:
            continue
        break
    shows.wait_for()


def _wait(address: str, server: subprocess.Popen[bytes]) -> None:
    for _ in range(600):
        assert server.poll() is None, "JupyterLab has ended"
        try:
            urllib.request.urlopen(address, timeout=5)  # noqa: S310 - this machine
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            time.sleep(0.1)
        else:
            return
    pytest.fail("JupyterLab does not answer")


def test_widget_and_kernel_move_each_other(browser: Browser, notebook: str) -> None:
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(f"{error}"))
    page.set_default_timeout(120_000)
    page.goto(notebook)
    page.get_by_text("Python 3 (ipykernel)").first.wait_for()
    page.locator(".jp-Notebook-ExecutionIndicator[data-status=idle]").wait_for()
    _run(page, 0, page.locator(".crankpin"))
    # From Python.
    _run(page, 1, page.locator("[data-name=crank-angle][data-value='97.25']"))
    # A click on the crank gives the keys to the widget, though another cell was selected.
    page.locator(".crankpin circle.handle").first.click()
    page.keyboard.press("ArrowRight")
    page.locator("[data-name=crank-angle][data-value='98.25']").wait_for(timeout=20_000)
    page.keyboard.press("ArrowLeft")
    engine = cp.Engine.preset("v8-crossplane").with_bank_angle(60, hold="pins")
    wave = engine.waveform(5000, theta_deg=[97.25])
    expected = [*np.asarray(wave.force)[0], *np.asarray(wave.moment)[0], np.asarray(wave.torque)[0]]
    found = values(page)
    names = ["force-x", "force-y", "moment-x", "moment-y", "torque"]
    np.testing.assert_allclose([found[name] for name in names], expected, rtol=1e-9, atol=1e-6)
    # To Python.
    page.get_by_label("crank angle").fill("77.5")
    page.locator("[data-name=rod-ratio]").fill("0.25")
    # Keys are the widget's alone: "r" would make the cell raw, two of "d" would delete it.
    page.get_by_label("turn the crank").focus()
    for key in ("r", "d", "d"):
        page.keyboard.press(key)
    page.locator(".crankpin input[type=checkbox]").first.click()
    for key in ("ArrowRight", "m", "d", "d"):
        page.keyboard.press(key)
    assert page.locator(".jp-Notebook .jp-CodeCell").count() == len(CELLS)
    assert page.get_by_role("button", name="reverse").get_attribute("aria-pressed") == "true"
    _run(page, 2, page.get_by_text("78.5 0.25 0.25"))
    assert errors == []
    page.close()
