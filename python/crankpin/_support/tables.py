"""Tables as text, HTML and CSV."""

from __future__ import annotations

import csv
import dataclasses
import html
import io
import math
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

Label: TypeAlias = "str | Sequence[str | float]"
"""Text before a row's numbers, or several texts and numbers, a column each."""


@dataclasses.dataclass(frozen=True, repr=False)
class Table:
    """Labelled rows of numbers under a title."""

    title: str
    header: list[str]
    """Names of the label columns and of the columns of numbers."""
    labels: Sequence[Label]
    rows: NDArray[np.float64]
    decimals: int | None = None
    """Digits after the point in text; None for five significant digits."""
    note: str = ""
    """Line under the table in text and HTML."""

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
        # A label that is a single text stays to the right: most are orders.
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
        return "\n".join(filter(None, [self.title, *body, self.note]))

    def __repr__(self) -> str:
        return self.text()

    def _repr_html_(self) -> str:
        return self.html()

    def html(self) -> str:
        """Return the table as HTML for notebooks."""
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.header)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self.cells()
        )
        caption = f"<caption>{html.escape(self.title)}</caption>"
        note = f"<p>{html.escape(self.note)}</p>" if self.note else ""
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{note}"

    def csv(self) -> str:
        """Return the table as CSV, numbers in full: they read back unchanged."""
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


class Shown:
    """Base class of results that are shown by their table."""

    def table(self) -> Table:
        """Return the table that is shown."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.table().text()

    def _repr_html_(self) -> str:
        return self.table().html()


def decimals(rows: NDArray[np.float64]) -> int | None:
    """Return how many decimals show the largest number to six digits, None outside 0.01 to 1e9.

    Columns of one quantity read best with their points aligned.
    """
    largest = float(abs(rows).max(initial=0.0))
    if not 0.01 <= largest < 1e9:
        return None
    return max(0, 5 - math.floor(math.log10(largest)))


def _short(part: str | float) -> str:
    return part if isinstance(part, str) else f"{part:.10g}"
