"""Pictures compared with images, on dark at a column's width, on plain axes and in a grid.

After a change that is meant, and a look at every picture that differs:

    pytest tests/plot/test_looks.py -k test_picture --mpl-generate-path=tests/plot/baseline
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from support.reading import figure_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

COLUMN = 3.4
"""Inches: a column of a paper."""
TOLERANCE = 1.0
"""Root mean square of 255 grey levels: an allowance for rounding on other processors; wheels of
matplotlib have one FreeType. The head of a single arrow makes 1.3, a legend ten points lower 26."""

Test = TypeVar("Test", bound="Callable[..., Any]")


def _pinned() -> str:
    constraints = (Path(__file__).parents[2] / "constraints.txt").read_text(encoding="utf-8")
    found = re.search(r"^matplotlib==(\S+)$", constraints, re.MULTILINE)
    assert found is not None
    return found[1]


def compared(test: Test) -> Test:
    """Compare the figure that a test returns with the image kept."""
    image = pytest.mark.mpl_image_compare(
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
    marked: Test = image(skipped(test))
    return marked


def on_dark_column(plot: Callable[..., Any]) -> Figure:
    """Draw a picture on dark, at a column's width: the room and the colours that it has least."""
    plt.style.use("dark_background")  # the comparison resets it
    width, height = mpl.rcParams["figure.figsize"]
    mpl.rcParams["figure.figsize"] = (COLUMN, height * COLUMN / width)
    mpl.rcParams["font.size"] = 8
    parameters = dict(mpl.rcParams)
    drawn: Any = plot()
    several = has_several_panels(plot)
    assert isinstance(drawn, np.ndarray if several else Axes)
    figure: Figure = figure_of(drawn)
    assert plt.get_fignums() == [figure.number]
    assert dict(mpl.rcParams) == parameters
    return figure


def on_plain_axes(plot: Callable[..., Any]) -> Figure:
    """Draw a picture on axes or in a figure without a layout: there alone, and inside."""
    plt.rcParams["font.size"] = 9
    parameters = dict(mpl.rcParams)
    figure = plt.figure(figsize=(5.0, 3.3))
    if has_several_panels(plot):
        drawn = plot(figure=figure)
        assert isinstance(drawn, np.ndarray)
        assert {ax.get_figure(root=False) for ax in drawn.flat} == {figure}
    else:
        ax = figure.subplots()
        assert plot(ax=ax) is ax
    assert plt.get_fignums() == [figure.number]
    assert dict(mpl.rcParams) == parameters
    return figure


def in_a_grid(plot: Callable[..., Any]) -> Figure:
    """Draw a picture on two of four axes of a figure, or in two parts if it has several panels.

    The two have neighbours, and an edge of the figure, on every side between them.
    """
    figure = plt.figure(figsize=(7.0, 5.0), layout="constrained")
    if has_several_panels(plot):
        parts: Any = figure.subfigures(1, 2)
        for part in parts:
            assert {ax.get_figure(root=False) for ax in plot(figure=part).flat} == {part}
    else:
        for ax in figure.subplots(2, 2).diagonal():
            plot(ax=ax)
    return figure


def has_several_panels(plot: Callable[..., Any]) -> bool:
    """Whether a picture takes a figure; it rejects what is none before it draws."""
    try:
        plot(figure="none")
    except TypeError:  # of a picture that is called with axes alone
        return False
    except cp.InputError as error:
        return "one panel" not in str(error)
    pytest.fail("a word is taken for a figure")
