"""All charts: every command one after the other, into one folder.

``python benchmarks/all.py`` writes raw figures (CSV, with hardware and versions) and pictures to
``--out``, by default ``benchmarks/out``; ``--quick`` takes two to three minutes and shows that
every command still runs. One that fails does not keep the others from running.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
COMMANDS = {
    "harmonics": ["--quick"],
    "waveforms": ["--quick"],
    "peaks": ["--quick"],
    "search": ["--quick"],
    "orders": ["--quick"],
    "bearings": ["--quick"],
    "gas_orders": ["--quick"],
    "mounts": ["--quick"],
    "web": ["--quick"],
    "stability": [],
}
"""Each a file beside this one that takes ``--out``, with what makes it quick."""


def present() -> list[str]:
    """List the commands that are there."""
    return [name for name in COMMANDS if (HERE / f"{name}.py").exists()]


def main() -> None:
    """Run all, and tell what was written."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--out", type=Path, default=HERE / "out")
    parser.add_argument("--quick", action="store_true", help="two to three minutes in all")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    begun, failed, taken = time.time(), [], []
    for name in present():
        print(f"\n=== {name}", flush=True)
        command = [sys.executable, str(HERE / f"{name}.py"), "--out", str(given.out)]
        start = time.perf_counter()
        command += COMMANDS[name] if given.quick else []
        done = subprocess.run(command, check=False)  # noqa: S603 - ours
        taken.append(f"{name} {time.perf_counter() - start:.0f} s")
        if done.returncode:
            failed.append(name)
    print(f"\nTook {', '.join(taken)}. Written to {given.out}:")
    for path in sorted(given.out.iterdir()):
        if path.stat().st_mtime >= begun - 1:
            print(f"  {path.name}, {path.stat().st_size / 1000:.0f} kB")
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
