"""Does the picture of a star diagram show its vectors and their sum?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from matplotlib.patches import FancyArrowPatch

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHAPE = [1, 0.95, 0.86, 0.73, 0.57, 0.39]
ODD = cp.star_diagram(cp.Engine.preset("v6-90-odd-fire"))
MODE = cp.star_diagram(cp.Engine.preset("i6"), [0.5, 1.5, 3], mode_shape=SHAPE)


def tips(ax: Axes) -> list[complex]:
    lines = [line for line in ax.lines if line.get_gid() == "tip"]
    return [complex(*point) for line in lines for point in line.get_xydata()]


def arrows(ax: Axes) -> list[complex]:
    found = []
    for patch in ax.patches:
        if isinstance(patch, FancyArrowPatch):
            start, end = patch._posA_posB
            assert start == (0.0, 0.0)
            found.append(complex(*end))
    return found


def titled(ax: Axes) -> str:
    return ax.get_title(loc="left")


@pytest.mark.parametrize(("diagram", "order"), [(ODD, 1.5), (MODE, 0.5), (MODE, 3)])
def test_vectors_are_drawn_to_the_longest_and_the_sum_to_that_of_all(
    diagram: cp.types.StarDiagram, order: float
) -> None:
    ax = diagram.plot(order=order)
    vectors = diagram.vectors[diagram.orders.index(order)]
    expected = vectors / abs(vectors).max()
    np.testing.assert_allclose(np.sort_complex(tips(ax)), np.sort_complex(expected), atol=1e-12)
    size = abs(vectors).sum()
    assert any(abs(end - diagram[order] / size) < 1e-12 for end in arrows(ax))
    assert "major" in titled(ax) if order in diagram.major else "major" not in titled(ax)


def test_a_sum_that_vanishes_has_no_arrow() -> None:
    ax = ODD.plot(order=1)
    assert len(arrows(ax)) == len({complex(np.round(tip, 9)) for tip in tips(ax)})
    assert "sum 0, proved" in titled(ax)


def test_the_first_order_that_remains_is_drawn() -> None:
    assert "order 1.5" in titled(ODD.plot())
    assert "order 3" in titled(cp.star_diagram(cp.Engine.preset("i6")).plot())
    with pytest.raises(cp.InputError, match="order = 13: choose from orders"):
        ODD.plot(order=13)
