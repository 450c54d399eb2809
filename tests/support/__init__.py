"""What tests share: the folder of tables, and what notebooks show."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from crankpin._support.frames import Tabled

DATA = Path(__file__).parents[1] / "data"
"""Tables of the sources, and reference values."""


def html_of(result: Tabled) -> str:
    """Return what notebooks show of a result that is shown as tables."""
    text = result._repr_html_()
    assert text is not None
    return text
