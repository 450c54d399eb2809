"""How everything here is timed: warm-up, then the least of many runs; tables with the hardware."""

from __future__ import annotations

import csv
import os
import platform
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

import crankpin
import numpy as np


def least(run: Callable[[], object], seconds: float = 1.0, runs: int = 20) -> float:
    """Return the least time of at least so many runs, in seconds; the first is not counted.

    These machines are shared: the least is what the work costs, the rest is what others cost.
    """
    run()
    best = float("inf")
    count = 0
    deadline = time.perf_counter() + seconds
    while count < runs or time.perf_counter() < deadline:
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
        count += 1
    return best


def interleaved(
    methods: Mapping[str, Callable[[], object]],
    rounds: int = 5,
    seconds: float = 0.4,
    runs: int = 4,
) -> dict[str, float]:
    """Return the least time of each method, taken in turns so that all meet the same machine."""
    best = dict.fromkeys(methods, float("inf"))
    for _ in range(rounds):
        for name, run in methods.items():
            best[name] = min(best[name], least(run, seconds / rounds, runs))
    return best


def machine(*packages: str) -> str:
    """Return what ran this, with the versions of further packages."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = info.read_text(encoding="utf-8").splitlines()
        cpu = next(
            (line.split(":")[1].strip() for line in lines if line.startswith("model name")), cpu
        )
    others = "".join(f", {name} {version(name)}" for name in packages)
    return (
        f"{cpu}, {os.cpu_count()} cores; Python {platform.python_version()}, "
        f"NumPy {np.__version__}, "
        f"crankpin {crankpin.__version__}{others}"
    )


def print_table(title: str, header: list[str], rows: list[list[str]]) -> None:
    """Print aligned columns."""
    widths = [max(len(row[k]) for row in [header, *rows]) for k in range(len(header))]
    print(f"\n{title}")
    for row in [header, *rows]:
        cells = (
            c.ljust(w) if k == 0 else c.rjust(w)
            for k, (c, w) in enumerate(zip(row, widths, strict=True))
        )
        print("  " + "  ".join(cells))


def write_csv(
    path: Path, ran_on: str, header: Sequence[str], rows: Iterable[Sequence[object]]
) -> None:
    """Write raw figures; the first line, a comment, says what ran this."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(f"# {ran_on}\n")
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


def milliseconds(seconds: float) -> str:
    """Return a time as text."""
    return f"{seconds * 1e3:.4g} ms"
