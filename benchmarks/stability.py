"""Where do methods fail? A map: method × condition → worst error, or "refuses".

``python benchmarks/stability.py`` prints the map and writes it to ``benchmarks/out`` (``--out``
another folder): ``stability.csv``, ``stability.png``, and ``stability.md``, the tables of
``docs/explanations/stability.md``, each with what ran it. Methods with a knob are shown at the best
of its settings. ``tests/promises/test_stability.py`` asserts that crankpin meets every bound and
that the other methods miss it.
"""

from __future__ import annotations

import argparse
import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import matplotlib as mpl
import methods
import numpy as np
from _timing import machine, print_table
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PIL import Image
from stability_cases import CASES, HARMONICS
from stability_links import LINKS
from stability_mounts import MOUNTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OUT = Path(__file__).parent / "out"
ALL = [*CASES, *LINKS, *MOUNTS]
"""Cases besides harmonics."""
LEAST, MOST = -17.0, 0.0
"""Colours run over these powers of ten: from exact to wholly wrong."""
COLOURS = "cividis"
"""Dark blue for exact, yellow for wrong: for those who do not distinguish red from green."""
SHARES = (0.0, 1e-12, 1 - 1e-9)
"""Offsets that the map shows, of the largest with which the crank turns; the tests have more."""


class Map(NamedTuple):
    """Errors of methods (columns) under conditions (rows); NaN where a method refuses."""

    conditions: list[str]
    methods: list[str]
    errors: np.ndarray
    promises: np.ndarray
    """what crankpin promises under each condition"""
    labels: list[list[str]]
    """what is written into each field beside the error"""


def of_harmonics() -> Map:
    """Every method for harmonics, at the best setting of its knob."""
    cases = [case for case in HARMONICS if case.share in SHARES]
    errors = [[case.best(method) for method in methods.HARMONICS] for case in cases]
    names = [method.name for method in methods.HARMONICS]
    blank = [[""] * len(names)] * len(cases)
    promises = np.array([case.promise for case in cases])
    return Map([case.name for case in cases], names, np.array(errors), promises, blank)


def of_the_rest() -> Map:
    """Take what one would do at first, and crankpin."""
    errors = [[case.plain(), case.ours()] for case in ALL]
    labels = [[case.method, ""] for case in ALL]
    conditions = [f"{case.group}: {case.condition}" for case in ALL]
    promises = np.array([case.promise for case in ALL])
    return Map(conditions, ["a plain method", "crankpin"], np.array(errors), promises, labels)


def shown(error: float) -> str:
    """Write an error as a reader wants it."""
    if math.isnan(error):
        return "refuses"
    if error == 0:
        return "exact"
    # where an exact zero is not zero, or nothing is right
    return "wrong" if error >= 1 else f"{error:.0e}"


def draw(ax: Axes, found: Map) -> None:
    """Draw one map as a table of coloured fields."""
    with np.errstate(divide="ignore"):
        powers = np.clip(np.log10(found.errors), LEAST, MOST)
    mesh = ax.pcolormesh(
        np.ma.masked_invalid(powers), cmap=COLOURS, vmin=LEAST, vmax=MOST, edgecolor="white"
    )
    mesh.set_linewidth(0.5)
    for (row, column), error in np.ndenumerate(found.errors):
        power = powers[row, column]
        if math.isnan(error):
            hatched = {"facecolor": "0.95", "edgecolor": "0.75", "hatch": "////", "lw": 0}
            ax.add_patch(Rectangle((column, row), 1, 1, **hatched))
        kept = math.isnan(error) or error <= found.promises[row]
        text = shown(error) if kept else f"✗ {shown(error)}"
        text = "\n".join(filter(None, [found.labels[row][column], text]))
        colour = "white" if power < 0.5 * LEAST else "black"
        place = {"ha": "center", "va": "center", "fontsize": 6.5}
        ax.text(column + 0.5, row + 0.5, text, color=colour, **place)
    ax.set_xticks(np.arange(len(found.methods)) + 0.5, found.methods, fontsize=7)
    ax.set_yticks(np.arange(len(found.conditions)) + 0.5, found.conditions, fontsize=7)
    ax.xaxis.tick_top()
    ax.tick_params(length=0)
    if len(found.methods) > 2:
        ax.tick_params(axis="x", rotation=25)
        for label in ax.get_xticklabels():
            label.set_horizontalalignment("left")
    ax.invert_yaxis()
    ax.spines[:].set_visible(False)


def picture(maps: list[Map], path: Path) -> None:
    """Write both maps, one above the other, as a PNG."""
    rows = [len(found.conditions) for found in maps]
    figure = Figure(figsize=(10, 0.22 * rows[0] + 0.34 * rows[1] + 1.6), layout="constrained")
    axes = figure.subplots(2, 1, height_ratios=[0.22 * rows[0], 0.34 * rows[1]])
    for ax, found in zip(axes, maps, strict=True):
        draw(ax, found)
    colours = ScalarMappable(Normalize(LEAST, MOST), mpl.colormaps[COLOURS])
    bar = figure.colorbar(colours, ax=axes, location="bottom", shrink=0.5, aspect=60, pad=0.01)
    bar.set_label(
        "log₁₀ of the worst relative error; ✗: beyond what crankpin promises; hatched: refuses",
        fontsize=7,
    )
    bar.ax.tick_params(labelsize=7)
    figure.savefig(path, dpi=110)
    with Image.open(path) as image:
        few_colours = image.convert("RGB").quantize(64)
    few_colours.save(path, optimize=True)


def tables(maps: list[Map]) -> str:
    """Write the tables of docs/explanations/stability.md."""
    harmonics, _ = maps
    lines = ["| condition | " + " | ".join(harmonics.methods) + " |"]
    lines.append("|---|" + "---:|" * len(harmonics.methods))
    for condition, errors in zip(harmonics.conditions, harmonics.errors, strict=True):
        lines.append(f"| {condition} | " + " | ".join(map(shown, errors)) + " |")
    lines += ["", "| condition | promise | because | plain method | its error | ours |"]
    lines.append("|---|---:|---|---|---:|---:|")
    for case in ALL:
        promise = "exact" if case.promise == 0 else f"{case.promise:.0e}"
        method = case.method.replace("|", r"\|")
        figures = f"{method} | {shown(case.plain())} | {shown(case.ours())}"
        lines.append(f"| {case.condition} | {promise} | {case.reason} | {figures} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Print and write the map."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=OUT, help="folder for CSV, PNG and tables")
    out: Path = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    maps = [of_harmonics(), of_the_rest()]
    print(machine())
    for found in maps:
        rows = [
            [condition, *map(shown, errors)]
            for condition, errors in zip(found.conditions, found.errors, strict=True)
        ]
        print_table("Worst relative error", ["condition", *found.methods], rows)
    with (out / "stability.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        file.write(f"# {machine()}\n")
        writer.writerow(["condition", "method", "worst_relative_error"])
        for found in maps:
            for (row, column), error in np.ndenumerate(found.errors):
                method = found.labels[row][column] or found.methods[column]
                text = "refuses" if math.isnan(error) else f"{error:.3e}"
                writer.writerow([found.conditions[row], method, text])
    (out / "stability.md").write_text(tables(maps), encoding="utf-8")
    picture(maps, out / "stability.png")
    print(f"written to {out}")


if __name__ == "__main__":
    main()
