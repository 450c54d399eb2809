"""Time of a frame in which an engine turns, and of one in which a setting changes, in Chromium.

    python benchmarks/view.py [NAME …]

Milliseconds of the page's own work (performance.now around the update), and of all work of the
browser's main thread, which has style, layout and painting besides, by its own clock.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
from playwright.sync_api import sync_playwright

if TYPE_CHECKING:
    from playwright.sync_api import CDPSession, Page

NAMES = ("i4", "v6-60", "v8-crossplane", "v16-45")
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
FRAMES = 200
CHANGES = {
    "crank angle": "{ angle_deg: 1.37 * k }",
    "engine speed": "{ rpm: 3000 + k }",
    "rod ratio": "{ rod_ratio: 0.2 + 0.0005 * k }",
    "bank angle": "{ bank_angle_deg: 60 + 0.2 * k }",
}
RUN = """async (frames) => {
    const times = [];
    for (let k = 0; k < frames; k++) {
        await new Promise(requestAnimationFrame);
        const start = performance.now();
        crankpin.set(CHANGE);
        times.push(performance.now() - start);
    }
    return times.sort((a, b) => a - b);
}"""


def main() -> None:
    """Print a line for each engine and each change."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", metavar="NAME", nargs="*", default=NAMES, help="presets")
    names = parser.parse_args().names
    print(
        f"{'engine':<16}{'change':<14}{'update: least':>14}{'median':>8}{'whole frame':>13}  (ms)"
    )
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=ARGUMENTS
        )
        page = browser.new_page(viewport={"width": 1280, "height": 1000})
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable", {"timeDomain": "threadTicks"})
        for name in names:
            engine, file = cp.Engine.preset(name), Path(folder) / f"{name}.html"
            engine.save_html(file)
            page.goto(file.as_uri())
            for change, code in CHANGES.items():
                if change != "bank angle" or hasattr(engine, "bank_angle_deg"):
                    least, median, whole = measured(page, session, code)
                    print(f"{name:<16}{change:<14}{least:>14.2f}{median:>8.2f}{whole:>13.2f}")
        browser.close()


def measured(page: Page, session: CDPSession, code: str) -> tuple[float, float, float]:
    """Return least and median update and the mean whole frame, milliseconds."""
    run = RUN.replace("CHANGE", code)
    page.evaluate(run, 50)  # until the compiler has seen it
    before = main_thread(session)
    times = page.evaluate(run, FRAMES)
    whole = 1e3 * (main_thread(session) - before) / FRAMES
    return times[0], times[FRAMES // 2], whole


def main_thread(session: CDPSession) -> float:
    """Return the time that the main thread has worked, seconds."""
    metrics = session.send("Performance.getMetrics")["metrics"]
    return float(next(each["value"] for each in metrics if each["name"] == "TaskDuration"))


if __name__ == "__main__":
    main()
