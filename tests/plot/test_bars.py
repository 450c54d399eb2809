"""Are the bars over engines those of the summary, and the classes right?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
from matplotlib import pyplot as plt
from support.engines import I4, V6
from support.pictures import SUMMARY
from support.reading import figure_of, legend_texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def widths(ax: Axes) -> NDArray[np.float64]:
    """Lengths of the bars: (n_engines, n_orders)."""
    return np.array([[bar.get_width() for bar in group] for group in ax.containers]).T


def test_bars_are_the_longest_vectors_of_the_orders_up_to_four() -> None:
    s = cp.sweep(SUMMARY, rpm=10)
    force, moment = s.plot()[0]
    shown = [order for order in s.orders if order <= 4]
    np.testing.assert_array_equal(widths(force), s.force.peak[:, : len(shown)])
    np.testing.assert_array_equal(widths(moment), s.moment.peak[:, : len(shown)])
    assert [force.get_xlabel(), moment.get_xlabel()] == ["peak, N", "peak, N·m"]
    assert legend_texts(figure_of(force)) == [f"order {order}" for order in shown]


def test_master_bars_of_the_summary() -> None:
    """The e-book's table at 10 rpm, R/L = 0.5: forces of the single cylinder and the inline-4."""
    force, _ = cp.sweep(SUMMARY, rpm=10, orders=[1, 2, 3, 4]).plot()[0]
    np.testing.assert_allclose(widths(force)[0], [9.87, 4.11, 0.0, 0.295], atol=0.006)
    np.testing.assert_allclose(widths(force)[2], [0.0, 16.44, 0.0, 1.18], atol=0.006)


def test_engines_are_classed_as_in_the_summary() -> None:
    _, moment = cp.sweep(SUMMARY, rpm=10).plot()[0]
    classes = [text.get_text() for text in moment.texts]
    assert classes == ["shakes", "rocks", "shakes", "balanced", "rocks", "balanced"]
    lopsided = V6.replace(name="without cylinder 1")
    (_, moment) = cp.sweep([lopsided, I4], rpm=10).plot()[0]
    assert [text.get_text() for text in moment.texts] == ["rocks", "shakes"]


def test_zeros_are_hollow() -> None:
    s = cp.sweep([I4, V6], rpm=1000, orders=[1, 2])
    force, _ = s.plot()[0]
    hollow = sum(len(np.asarray(line.get_xdata())) for line in force.lines)
    assert hollow == (s.force.peak == 0.0).sum() > 0


def test_one_quantity_and_given_axes() -> None:
    s = cp.sweep([I4, V6], rpm=1000, orders=[2, 6])
    panels = s.plot(quantity="torque")
    assert panels.shape == (1, 1)
    np.testing.assert_array_equal(widths(panels[0, 0]), s.torque.peak[:, :1])
    ax = s.plot(plt.subplots()[1], quantity="force", orders=[6])
    np.testing.assert_array_equal(widths(ax), s[6].force.peak[:, np.newaxis])
    assert "orders" not in ax.get_title(loc="left").split("\n")[-1]
    # Without low orders the largest ones.
    high = cp.sweep([I4, V6], rpm=1000, orders=[6, 8]).plot(quantity="torque")[0, 0]
    assert len(high.containers) == 2
