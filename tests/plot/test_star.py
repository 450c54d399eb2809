"""Does the picture of a star diagram show its vectors and their sum?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.patches import FancyArrowPatch

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHAPE = [1, 0.95, 0.86, 0.73, 0.57, 0.39]
ODD = cp.star_diagram(cp.Engine.preset("v6-90-odd-fire"))
MODE = cp.star_diagram(cp.Engine.preset("i6"), [0.5, 1.5, 3], mode_shape=SHAPE)


def tips(ax: Axes) -> list[complex]:
    lines = [line for line in ax.lines if line.get_gid() == "tip"]
    return [complex(*point) for line in lines for point in np.asarray(line.get_xydata())]


def arrows(ax: Axes) -> list[complex]:
    found = []
    for patch in ax.patches:
        if isinstance(patch, FancyArrowPatch):
            start, end = patch._posA_posB  # type: ignore[attr-defined]
            assert start == (0.0, 0.0)
            found.append(complex(*end))
    return found


def titled(ax: Axes) -> str:
    return ax.get_title(loc="left")


@pytest.mark.parametrize(("diagram", "order"), [(ODD, 1.5), (MODE, 0.5), (MODE, 3)])
def test_vectors_are_drawn_to_the_longest_and_the_sum_to_that_of_all(
    diagram: cp.results.StarDiagram, order: float
) -> None:
    ax = diagram.plot(order=order)
    vectors = diagram.read("vectors")[diagram.orders.index(order)]
    expected = vectors / abs(vectors).max()
    np.testing.assert_allclose(np.sort(tips(ax)), np.sort(expected), atol=1e-12)
    size = abs(vectors).sum()
    assert any(abs(end - diagram[order] / size) < 1e-12 for end in arrows(ax))
    assert "major" in titled(ax) if order in diagram.major else "major" not in titled(ax)


def test_a_sum_that_vanishes_has_no_arrow() -> None:
    ax = ODD.plot(order=1)
    assert len(arrows(ax)) == len({complex(np.round(tip, 9)) for tip in tips(ax)})
    assert "sum 0, proved" in titled(ax)


def test_every_star_has_a_panel_that_names_its_orders() -> None:
    panels = [panel for panel in MODE.plot().flat if panel.get_visible()]
    assert [titled(panel).split("\n")[0] for panel in panels] == [
        "order 0.5",
        "order 1.5",
        "order 3",
    ]
    for panel, order in zip(panels, MODE.orders, strict=True):
        vectors = MODE.read("vectors")[MODE.orders.index(order)] / max(SHAPE)
        np.testing.assert_allclose(np.sort(tips(panel)), np.sort(vectors), atol=1e-12)
    # Directions of an even-firing inline-6 repeat after three orders.
    panels = list(cp.star_diagram(cp.Engine.preset("i6")).plot().flat)
    assert [" ".join(titled(panel).split()) for panel in panels] == [
        "orders 0.5, 3.5, 6.5, 9.5 sum 0, proved",
        "orders 1, 4, 7, 10 sum 0, proved",
        "orders 1.5, 4.5, 7.5, 10.5 sum 0, proved",
        "orders 2, 5, 8, 11 sum 0, proved",
        "orders 2.5, 5.5, 8.5, 11.5 sum 0, proved",
        "orders 3, 6, 9, 12 major: sum 6 of 6",
    ]


def test_stars_that_have_no_room_are_named() -> None:
    panels = ODD.plot()
    assert panels.size == 12
    title = panels[0, 0].get_figure(root=True).get_suptitle()
    assert "not shown: orders 6.5, 7, 7.5, 8, 8.5, 9, 9.5, 10, 10.5, 11, 11.5, 12" in title


def test_on_given_axes_the_first_order_that_remains_is_drawn() -> None:
    assert "order 1.5" in titled(ODD.plot(plt.subplots()[1]))
    assert "order 3" in titled(cp.star_diagram(cp.Engine.preset("i6")).plot(plt.subplots()[1]))
    with pytest.raises(cp.InputError, match="ax and figure cannot be combined"):
        ODD.plot(plt.subplots()[1], figure=plt.figure())
    with pytest.raises(cp.InputError, match=r"figure = .*: one order has one panel"):
        ODD.plot(order=1.5, figure=plt.figure())
    with pytest.raises(cp.InputError, match="order = 13: choose from orders"):
        ODD.plot(order=13)


def test_any_colour_of_matplotlib_is_taken() -> None:
    for panel in MODE.plot(color=np.array([1.0, 0.0, 0.0])).flat:
        dots = [line for line in panel.lines if line.get_gid() == "tip"]
        assert all(tuple(line.get_color()) == (1.0, 0.0, 0.0) for line in dots)
