"""Pictures compared with images: on dark, and at a column's width.

A test is marked by ``@in_every_look`` and returns ``seen(look, plot)``. After a change that is
meant, and a look at every picture that differs:

    pytest tests/plot --mpl-generate-path=tests/plot/baseline
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

LOOKS = ("dark", "column")
"""Looks of images; on white, in a grid and on plain axes pictures differ by their layout alone."""
COLUMN = 3.4
"""Inches: a column of a paper."""
TOLERANCE = 4.0
"""Root mean square of 255 grey levels: an allowance for type drawn by another build of FreeType.
A legend ten points lower makes 26 and more."""

Test = TypeVar("Test", bound="Callable[..., Any]")


def _pinned() -> str:
    constraints = (Path(__file__).parents[2] / "constraints.txt").read_text(encoding="utf-8")
    found = re.search(r"^matplotlib==(\S+)$", constraints, re.MULTILINE)
    assert found is not None
    return found[1]


def in_every_look(test: Test) -> Test:
    """Run a test for each look, and compare the figure that it returns with the image kept."""
    compared = pytest.mark.mpl_image_compare(
        style="default",
        backend="agg",
        tolerance=TOLERANCE,
        savefig_kwargs={"dpi": 50},
        deterministic=True,
    )
    pinned = _pinned()
    skipped = pytest.mark.skipif(
        mpl.__version__ != pinned,
        reason=f"images are of matplotlib {pinned}; this is {mpl.__version__}",
    )
    return pytest.mark.parametrize("look", LOOKS)(compared(skipped(test)))


def seen(look: str, plot: Callable[..., Any]) -> Figure:
    """Draw a picture in one look.

    ``plot`` draws on new axes; in a grid it is called with ``ax=`` four times, or, where it makes
    several panels by itself, with ``figure=`` twice.
    """
    if look == "dark":
        plt.style.use("dark_background")  # the comparison resets it
    if look == "column":
        width, height = mpl.rcParams["figure.figsize"]
        mpl.rcParams["figure.figsize"] = (COLUMN, height * COLUMN / width)
        mpl.rcParams["font.size"] = 8
    drawn = plot()
    made = np.ravel(drawn)[0].get_figure(root=True)
    if look != "grid":
        return made
    plt.close(made)
    figure = plt.figure(figsize=(7.0, 5.0), layout="constrained")
    if isinstance(drawn, np.ndarray):
        for part in figure.subfigures(1, 2):
            plot(figure=part)
    else:
        for ax in figure.subplots(2, 2).ravel():
            plot(ax=ax)
    return figure
