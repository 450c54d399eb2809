"""Tables as text and HTML, and the libraries that make others, imported when used."""

from __future__ import annotations

import dataclasses
import html
import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def pandas() -> Any:  # noqa: ANN401 - a module
    """Return pandas, or say how to get it."""
    return _optional("pandas")


def xarray() -> Any:  # noqa: ANN401 - a module
    """Return xarray, or say how to get it."""
    return _optional("xarray")


def _optional(name: str) -> Any:  # noqa: ANN401 - a module
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f'{name} is not installed: pip install "crankpin[{name}]"') from error


@dataclasses.dataclass(frozen=True)
class Table:
    """Labelled rows of numbers under a title."""

    title: str
    header: list[str]
    """Names of the label column and of the columns of numbers."""
    labels: list[str]
    rows: NDArray[np.float64]

    def cells(self) -> list[list[str]]:
        """Return the rows as text, numbers to five significant digits and zeros as 0."""
        return [
            [label, *(f"{value:.5g}" if value else "0" for value in row)]
            for label, row in zip(self.labels, self.rows.tolist(), strict=True)
        ]

    def text(self) -> str:
        """Return the table as aligned text."""
        lines = [self.header, *self.cells()]
        widths = [max(len(line[k]) for line in lines) for k in range(len(self.header))]
        body = ("  ".join(cell.rjust(w) for cell, w in zip(line, widths, strict=True)) for line in lines)
        return "\n".join([self.title, *body])

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
        """Return the table as CSV, numbers in full."""
        lines = [",".join(_quoted(name) for name in self.header)]
        for label, row in zip(self.labels, self.rows.tolist(), strict=True):
            lines.append(",".join([_quoted(label), *(repr(value) for value in row)]))
        return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    if any(character in text for character in ',"\n'):
        return '"' + text.replace('"', '""') + '"'
    return text
