"""Do curves, axes and rows that pictures share show what they are given?"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from crankpin.plot import painter
from crankpin.plot.style import SERIES
from matplotlib import pyplot as plt
from matplotlib.colors import same_color


def test_curves_have_their_data_and_names_in_successive_looks() -> None:
    ax = plt.subplots()[1]
    columns = {"first": [1.0, 2.0], "second": [3.0, 4.0]}
    drawn = painter.draw_curves(ax, [0.0, 90.0], columns, {"linewidth": 3.0}, "mine", marker="o")
    assert [line.get_label() for line in drawn] == ["mine, first", "mine, second"]
    for line, values in zip(drawn, columns.values(), strict=True):
        assert np.asarray(line.get_xydata()).tolist() == [[0.0, values[0]], [90.0, values[1]]]
        assert (line.get_linewidth(), line.get_marker(), line.get_gid()) == (3.0, "o", SERIES)
    (again,) = painter.draw_curves(ax, [0.0, 90.0], {"": [5.0, 0.0]}, {})
    colours = {line.get_color() for line in ax.lines}
    assert len(colours) == 3
    assert again.get_label() == "_"
    assert painter.highest(ax) == 5.0


def test_magnitudes_begin_at_zero_and_nothing_but_zero_is_said() -> None:
    ax, empty = plt.subplots(1, 2)[1]
    for axes, values in ((ax, [1.0, 2.0]), (empty, [0.0, 0.0])):
        painter.draw_curves(axes, [0.0, 90.0], {"": values}, {})
        painter.x_axis(axes, "crank angle θ", [0.0, 90.0], by_angle=True)
        painter.y_axis(axes, "torque, N·m", largest=painter.highest(axes))
        axes.figure.draw_without_rendering()
        assert axes.get_ylim()[0] == 0.0
        assert axes.get_xticklabels()[-1].get_text() == "90°"
        assert " ".join(axes.get_ylabel().split()) == "torque, N·m"
    assert not ax.texts
    assert [text.get_text() for text in empty.texts] == ["zero throughout"]


def test_rows_are_named_from_the_top_in_no_formula() -> None:
    ax = plt.subplots()[1]
    painter.name_rows(ax, ["a", "5 $ b$"])
    low, high = ax.get_ylim()
    assert (low, high) == (1.5, -0.5)
    assert [text.get_text() for text in ax.get_yticklabels()] == ["a", r"5 \$ b\$"]


def test_what_does_not_change_is_a_dot_in_a_ring() -> None:
    ax = plt.subplots()[1]
    columns = {"before": np.array([1.0, 2.0]), "after": np.array([1.0, 5.0])}
    painter.draw_changes(ax, np.arange(2), columns, {})
    ring, dot = ax.lines
    assert ring.get_markersize() > dot.get_markersize()
    face: Any = ring.get_markerfacecolor()
    assert same_color(face, ax.get_facecolor())
    assert dot.get_xdata() == pytest.approx([1.0, 5.0])
    (changes,) = ax.collections
    assert changes.get_gid() == painter.CHANGE
