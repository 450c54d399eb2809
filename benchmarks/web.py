"""Time of the core in a browser, and of the library with one thread; times of the workbench.

    python benchmarks/web.py [--quick] [--out FOLDER]

Calls as a page makes them, with typed arrays: reading arguments and writing answers count. Least of
several rounds in turns, in Chromium. Needs ``packaging/web``; the workbench, ``site/build.py``.
"""

from __future__ import annotations

import argparse
import base64
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

os.environ["RAYON_NUM_THREADS"] = "1"

import crankpin as cp
import matplotlib.pyplot as plt
import numpy as np
from _timing import least, machine, milliseconds, print_table, write_csv
from crankpin import _core
from playwright.sync_api import sync_playwright

if TYPE_CHECKING:
    from playwright.sync_api import Page

ROOT = Path(__file__).parents[1]
MODULE = ROOT / "target" / "web" / "crankpin.wasm"
WORKBENCH = ROOT / "target" / "site" / "index.html"
ENGINE = "v8-crossplane"
RPM = 3000.0
ORDERS = [1, 2, 4, 6, 8]
ROUNDS = 5
ALLOWED = 4.0
"""Times the native time that calls in a browser may take."""

START = """async ([loader, module]) => {
    const url = URL.createObjectURL(new Blob([loader], { type: "text/javascript" }));
    const { load } = await import(url);
    globalThis.core = await load(Uint8Array.from(atob(module), (letter) => letter.charCodeAt(0)));
}"""
RUN = """([name, given, seconds]) => {
    for (const key in given) {
        if (Array.isArray(given[key])) given[key] = Float64Array.from(given[key]);
    }
    core.call(name, given);
    let best = Infinity;
    const end = performance.now() + 1e3 * seconds;
    // Browsers' clocks tick every tenth of a millisecond: many calls between two looks.
    for (let k = 0; k < 3 || performance.now() < end; k++) {
        const start = performance.now();
        for (let call = 0; call < 20; call++) core.call(name, given);
        best = Math.min(best, (performance.now() - start) / 20);
    }
    return best;
}"""

DRAWN = """() => {
    const seen = new MutationObserver(() => {
        if (!document.querySelector(".turning .scene")) return;
        seen.disconnect();
        requestAnimationFrame(() => setTimeout(() => { globalThis.drawn = performance.now(); }));
    });
    seen.observe(document, { childList: true, subtree: true });
}"""
"""Notes when the first engine has been drawn, ms after the navigation began."""
FRAMES = """(milliseconds) => new Promise((answer) => {
    let [count, begin] = [0, performance.now()];
    const next = () => {
        count++;
        if (performance.now() - begin > milliseconds) answer(count);
        else requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
})"""
CURVE = """() => {
    const [{ core, engine }] = workbench.slots;
    const bank_angle_deg = Array.from({ length: 361 }, (_, k) => k / 2);
    const begin = performance.now();
    core.call("bank_angles", { engine: engine.json, rpm: 3000, bank_angle_deg, orders: [1, 2, 4] });
    return performance.now() - begin;
}"""
FIRST, FRAME = 1.0, 0.016
"""Seconds until the first engine is drawn, and of a frame, that are allowed."""

Case = tuple[str, dict[str, Any], Callable[[], object]]


def cases(scale: int) -> dict[str, Case]:
    """Return calls by what they compute: name and arguments, and the same of the library."""
    engine = cp.Engine.preset(ENGINE)
    given = {"engine": engine.to_json(), "rpm": RPM}
    angles = np.linspace(0.0, 180.0, 361)
    theta = np.linspace(0.0, 720.0, 1440 * scale, endpoint=False)
    ratios = np.linspace(0.1, 0.4, 2000 * scale)
    speeds = np.linspace(500.0, 8000.0, 5000 * scale)
    count = 500 * scale
    third = cp.Cylinder(1.0, 3.0, 1.0)

    def bank_angles() -> object:
        swept = cp.sweep(engine, RPM, bank_angle_deg=angles, hold="pins", orders=[1, 2, 4])
        return swept.force.peak, swept.moment.peak

    def sweep(**axis: Any) -> Callable[[], object]:  # noqa: ANN401 - axes of a sweep
        return lambda: cp.sweep(engine, **({"rpm": RPM} | axis), orders=ORDERS).force.peak

    def waveform(orders: list[int] | None) -> Callable[[], object]:
        return lambda: engine.waveform(RPM, theta_deg=theta, orders=orders)

    of_sweep = given | {"orders": ORDERS}
    of_waveform = given | {"theta_deg": theta.tolist()}
    bank = given | {"bank_angle_deg": angles.tolist(), "orders": [1, 2, 4]}
    harmonics = {"rod_ratio": 1.0 / 3.0, "count": count}
    return {
        "361 bank angles": ("bank_angles", bank, bank_angles),
        f"{len(ratios)} rod ratios": (
            "sweep", of_sweep | {"rod_ratio": ratios.tolist()}, sweep(rod_ratio=ratios),
        ),
        f"{len(speeds)} speeds": ("sweep", of_sweep | {"rpm": speeds.tolist()}, sweep(rpm=speeds)),
        f"exact waveform, {len(theta)} angles": ("waveform", of_waveform, waveform(None)),
        f"sum of {len(ORDERS)} orders, {len(theta)} angles": (
            "waveform", of_waveform | {"orders": ORDERS}, waveform(ORDERS),
        ),
        f"{count} harmonics": (
            "harmonics", harmonics,
            lambda: _core.cylinder_harmonics(third._parts, range(1, count + 1)),
        ),
    }  # fmt: skip


def opened(browser: Any) -> Page:  # noqa: ANN401 - a browser
    """Return a page that has the core."""
    page: Page = browser.new_page()
    loader = (ROOT / "site" / "core.mjs").read_text("utf-8")
    page.evaluate(START, [loader, base64.b64encode(MODULE.read_bytes()).decode()])
    return page


def measured(quick: bool) -> list[tuple[str, float, float]]:
    """Return what was computed, and the seconds of the library and of the browser."""
    rows = []
    seconds = 0.02 if quick else 0.3
    path = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium"))), None)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        page = opened(browser)
        for label, (name, arguments, native) in cases(1 if quick else 5).items():
            web, own = float("inf"), float("inf")
            for _ in range(ROUNDS):
                web = min(web, 1e-3 * page.evaluate(RUN, [name, arguments, seconds]))
                own = min(own, least(native, seconds, 3))
            rows.append((label, own, web))
        browser.close()
    return rows


def of_workbench(quick: bool) -> list[tuple[str, float, float]]:
    """Return what the workbench does, its seconds, and those that it may take.

    A frame is what its thread computes for it, by the processor's clock: without a graphics
    processor painting takes longer than that.
    """
    path = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium"))), None)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        first = float("inf")
        for _ in range(2 if quick else 5):
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.add_init_script(f"({DRAWN})()")
            page.goto(WORKBENCH.as_uri())
            first = min(first, 1e-3 * page.wait_for_function("() => globalThis.drawn").json_value())
            page.close()
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(f"{WORKBENCH.as_uri()}#preset=v16-45")
        page.wait_for_selector(".turning .scene")
        curve = 1e-3 * min(page.evaluate(CURVE) for _ in range(10))
        clock = page.context.new_cdp_session(page)
        clock.send("Performance.enable", {"timeDomain": "threadTicks"})
        frames = []
        for pane in ("Orders", "Vectors", "Crank angle"):
            page.get_by_role("tab", name=pane, exact=True).click()
            page.evaluate("workbench.slots[0].bench.set({ playing: true })")
            page.wait_for_timeout(200)
            before = metrics(clock)
            count = page.evaluate(FRAMES, 300 if quick else 3000)
            after = metrics(clock)
            for part in ("Script", "RecalcStyle", "Layout"):
                of_part = (after[f"{part}Duration"] - before[f"{part}Duration"]) / count
                frames.append((f"a frame of the turning V16, {pane}: {part.lower()}", of_part))
            page.evaluate("workbench.slots[0].bench.set({ playing: false })")
        browser.close()
    return [
        ("navigation to first engine", first, FIRST),
        ("361 bank angles of the V16", curve, FRAME),
        *((label, seconds, FRAME) for label, seconds in frames),
    ]


def metrics(clock: Any) -> dict[str, float]:  # noqa: ANN401 - a session
    """Return the seconds that Chromium counts by what they are spent on."""
    listed = clock.send("Performance.getMetrics")["metrics"]
    return {each["name"]: each["value"] for each in listed}


def draw(rows: list[tuple[str, float, float]], file: Path) -> None:
    """Write the chart of times over those of the library."""
    figure, ax = plt.subplots(figsize=(7.0, 3.2), layout="constrained")
    labels = [label for label, *_ in rows][::-1]
    ax.barh(labels, [web / own for _, own, web in rows][::-1])
    ax.axvline(ALLOWED, color="0.4", linestyle="--")
    ax.set_xlabel("time in the browser over that of the library, one thread")
    figure.savefig(file)
    plt.close(figure)


def main() -> None:
    """Time both, print a table, write figures and chart."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "out")
    parser.add_argument("--quick", action="store_true", help="few numbers, some seconds")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if not MODULE.exists():
        print("Left out: the core for browsers is not built (packaging/web).")
        return
    rows = measured(given.quick)
    print(machine())
    table = [
        [label, milliseconds(own), milliseconds(web), f"{web / own:.2f}"]
        for label, own, web in rows
    ]
    title = f"The core in Chromium ({MODULE.stat().st_size / 1e3:.0f} kB) and the library, {ENGINE}"
    print_table(title, ["computed", "library", "browser", "ratio"], table)
    header = ("computed", "library_s", "browser_s")
    write_csv(given.out / "web.csv", machine(), header, rows)
    draw(rows, given.out / "web.png")
    if WORKBENCH.exists():
        page = of_workbench(given.quick)
        table = [[label, milliseconds(took), milliseconds(most)] for label, took, most in page]
        print_table("The workbench in Chromium", ["what", "time", "allowed"], table)
        write_csv(given.out / "workbench.csv", machine(), ("what", "seconds", "allowed_s"), page)


if __name__ == "__main__":
    main()
