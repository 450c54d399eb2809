"""Print the oldest supported releases of the dependencies as constraints for pip."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]


def main() -> None:
    """Print a line for each dependency whose floor pyproject.toml gives."""
    groups = [PROJECT["dependencies"], *PROJECT["optional-dependencies"].values()]
    entries = {entry for group in groups for entry in group}
    floors = (re.match(r"([\w-]+)(?:\[.*\])?>=([\d.]+)", entry) for entry in entries)
    for name, floor in sorted({found.groups() for found in floors if found}):
        print(f"{name}=={floor}.*")


if __name__ == "__main__":
    main()
