"""Tables as text, HTML and CSV, and the libraries that make others, imported when used."""

from __future__ import annotations

import csv
import dataclasses
import html
import importlib
import io
import math
import re
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from crankpin.analysis.sweep import Sweep

Label: TypeAlias = "str | Sequence[str | float]"
"""What stands before a row's numbers: a text, or several texts and numbers, a column each."""

SYMBOLS = {
    "force": ("|F_x|", "|F_y|"),
    "moment": ("|M_x|", "|M_y|"),
    "torque": ("|M_z|",),
}
"""Quantity → peaks of its parts."""

UNITS = {"force": "N", "moment": "N·m", "torque": "N·m"}
"""Quantity → unit."""

NAMES = {"force": "shaking force", "moment": "rocking moment", "torque": "roll torque"}
"""Quantity → what it is called."""

XARRAY_UNITS = {
    "bank_angle_deg": "degree",
    "rod_ratio": "1",
    "pin_offset": "m",
    "rpm": "1/min",
    "theta_deg": "degree",
    "order": "1/rev",
    "force": "N",
    "moment": "N m",
    "torque": "N m",
}
"""Dimension or quantity → unit, as xarray's users write it."""

SWEPT = {
    "bank_angle_deg": ("bank angle", "°"),
    "rod_ratio": ("rod ratio", ""),
    "pin_offset": ("pin offset", " m"),
    "rpm": ("", " rpm"),
}
"""Swept dimension → what it is called, and what follows its value."""

HELD = {
    "pins": "pins held as the bank angle changes",
    "firing": "top dead centres held as the bank angle changes",
}
"""What a change of bank angle leaves as it is."""


def coordinates(coords: Mapping[str, Any]) -> dict[str, Any]:
    """Return coordinates with their units, as xarray takes them."""
    return {
        name: (name, values, {"units": XARRAY_UNITS[name]} if name in XARRAY_UNITS else {})
        for name, values in coords.items()
    }


def pandas() -> Any:  # noqa: ANN401 - a module
    """Return pandas, or say how to get it."""
    return _optional("pandas")


def xarray() -> Any:  # noqa: ANN401 - a module
    """Return xarray, or say how to get it."""
    return _optional("xarray")


def dask() -> Any:  # noqa: ANN401 - a module
    """Return dask.array, or say how to get it."""
    return _optional("dask.array", "dask")


def sympy() -> Any:  # noqa: ANN401 - a module
    """Return SymPy, or say how to get it."""
    return _optional("sympy", "exact")


def _optional(name: str, extra: str | None = None) -> Any:  # noqa: ANN401 - a module
    try:
        return importlib.import_module(name)
    except ImportError as error:
        cure = f'pip install "crankpin[{extra or name}]"'
        raise ImportError(f"{name} is not installed: {cure}") from error


def value_text(dimension: str, value: float) -> str:
    """Return a swept quantity with its value: ``bank angle 60°``, ``5000 rpm``."""
    name, unit = SWEPT[dimension]
    return f"{name} {value:.10g}{unit}".strip()


def engine_names(sweep: Sweep) -> list[str]:
    """Return what a sweep's engines are called.

    Where bank angle is swept, a name that tells the angle which the engine had before, such as
    "V6 60°", goes without it.
    """
    given = sweep.coords.get("engine")
    names = [engine.name or f"{len(engine)} cylinders" for engine in sweep.engines]
    if given is not None:
        names = [str(name) for name in given]
    if "bank_angle_deg" not in {*sweep.coords, *sweep.fixed}:
        return names
    pairs = zip(names, sweep.engines, strict=True)
    without = [re.sub(rf"\s*\b{engine.bank_angle_deg:g}°", "", name) for name, engine in pairs]
    told_apart = all(without) and len(set(without)) == len(names)
    return without if told_apart else names


@dataclasses.dataclass(frozen=True)
class Table:
    """Labelled rows of numbers under a title."""

    title: str
    header: list[str]
    """Names of the label columns and of the columns of numbers."""
    labels: Sequence[Label]
    rows: NDArray[np.float64]
    decimals: int | None = None
    """Digits after the point in text; None for five significant digits."""

    def cells(self) -> list[list[str]]:
        """Return the rows as text, numbers rounded and exact zeros as 0."""
        return [
            [*(_short(part) for part in label), *(self._rounded(value) for value in row)]
            for label, row in self._lines()
        ]

    def text(self) -> str:
        """Return the table as aligned text, columns of words to the left."""
        lines = [self.header, *self.cells()]
        widths = [max(len(line[k]) for line in lines) for k in range(len(self.header))]
        # A label that is a text alone stays to the right: most are orders.
        first = next(iter(self.labels), "")
        words = () if isinstance(first, str) else [isinstance(part, str) for part in first]
        leftwards = {k for k, is_text in enumerate(words) if is_text}
        body = (
            "  ".join(
                cell.ljust(width) if k in leftwards else cell.rjust(width)
                for k, (cell, width) in enumerate(zip(line, widths, strict=True))
            ).rstrip()
            for line in lines
        )
        return "\n".join([*([self.title] if self.title else []), *body])

    def html(self) -> str:
        """Return the table as HTML for notebooks."""
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.header)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self.cells()
        )
        caption = f"<caption>{html.escape(self.title)}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def csv(self) -> str:
        """Return the table as CSV, numbers in full: they read back as they were."""
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(self.header)
        writer.writerows([*label, *row] for label, row in self._lines())
        return file.getvalue()

    def _lines(self) -> list[tuple[Sequence[str | float], list[float]]]:
        pairs = zip(self.labels, self.rows.tolist(), strict=True)
        return [([label] if isinstance(label, str) else label, row) for label, row in pairs]

    def _rounded(self, value: float) -> str:
        if not value:
            return "0"
        return f"{value:.5g}" if self.decimals is None else f"{value:.{self.decimals}f}"


def decimals(rows: NDArray[np.float64]) -> int | None:
    """Return how many decimals show the largest number to six digits, None where that is silly.

    Columns of one quantity read best with their points in line.
    """
    largest = float(abs(rows).max(initial=0.0))
    if not 0.01 <= largest < 1e9:
        return None
    return max(0, 5 - math.floor(math.log10(largest)))


def cut(text: str, longest: int = 60) -> str:
    """Return a text that fits a title."""
    return text if len(text) <= longest else f"{text[: longest - 1]}…"


def _short(part: str | float) -> str:
    return part if isinstance(part, str) else f"{part:.10g}"
