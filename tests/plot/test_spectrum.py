"""Are stems of a spectrum the peaks, and exact zeros told from small values?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from matplotlib.figure import Figure
from support.engines import I4, V6
from support.pictures import UNNAMED
from support.reading import legend_texts, series, title_of, xtick_texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def peaks_of(ax: Axes) -> list[list[float]]:
    """Where the markers are, of each series."""
    return [np.asarray(line.get_ydata())[line.get_markevery()].tolist() for line in series(ax)]  # type: ignore[index]


def hollow(ax: Axes) -> list[list[float]]:
    """Orders that are exactly zero, of each series."""
    return [
        np.asarray(line.get_xdata()).tolist()
        for line in ax.lines
        if line.get_gid() == "crankpin zeros"
    ]


def test_stems_are_the_peaks_over_a_numeric_order() -> None:
    b = V6.balance(5000, orders=(1, 2, 8))
    ax = b.plot()
    np.testing.assert_array_equal(np.transpose(peaks_of(ax)), b.moment.peak_xy)
    for line in series(ax):
        assert np.asarray(line.get_xdata())[line.get_markevery()].tolist() == [1.0, 2.0, 8.0]  # type: ignore[index]
    assert legend_texts(ax) == ["about x (pitch)", "about y (yaw)"]
    assert title_of(ax) == "V6 60°, shared pins\n5000 rpm, orders given"
    assert ax.get_ylabel().split() == ["peak", "rocking", "moment,", "N·m"]
    assert all(float(text) == int(text) for text in xtick_texts(ax))
    assert ax.get_ylim()[0] == 0.0
    assert ax.get_ylim()[1] > b.moment.peak_xy.max()


def test_zeros_are_hollow_and_small_values_are_not() -> None:
    b = I4.balance(12_000, orders=(1, 2, 3, 12))
    ax = b.plot(quantity="force")
    assert 0.0 < b.force.peak_xy[3, 1] < 1e-3 * b.force.peak_xy[1, 1]
    assert hollow(ax) == [[1.0, 2.0, 3.0, 12.0], [1.0, 3.0]]
    assert legend_texts(ax) == ["along x", "along y", "exactly zero"]
    assert "12\N{NO-BREAK SPACE}000 rpm" in title_of(ax)


def test_logarithmic_spectrum_shows_the_smallest_peak() -> None:
    b = V6.balance(5000, orders=range(1, 11))
    ax = b.plot(log=True)
    nonzero = b.moment.peak_xy[b.moment.peak_xy > 0.0]
    low, high = ax.get_ylim()
    assert ax.get_yscale() == "log"
    assert (low, high) == pytest.approx((0.3 * nonzero.min(), 3.0 * nonzero.max()))
    np.testing.assert_array_equal(np.transpose(peaks_of(ax)), b.moment.peak_xy)
    assert hollow(ax)[0] == [3.0, 5.0, 6.0, 7.0, 9.0]


def test_orders_that_cannot_be_seen_take_no_room() -> None:
    fired = cp.Engine.preset("radial-14").with_cycle(cp.Cycle.example()).balance(2500)
    for quantity, log, least in (
        ("moment", False, 1e-6),
        ("crank_torque", False, 1e-3),
        ("crank_torque", True, 1e-6),
    ):
        peaks = fired.read(quantity, "peak")
        last = max(
            order
            for order, peak in zip(fired.orders, peaks, strict=True)
            if peak > least * peaks.max()
        )
        ax = fired.plot(quantity=quantity, log=log)
        drawn = [float(np.asarray(line.get_xdata()).max()) for line in series(ax)]
        assert drawn == [last] * len(drawn)
        cut = last < fired.orders[-1]
        assert (f"above order {last}: below {least:g} of the largest" in title_of(ax)) == cut
        # Inertia torque of order 189 is 1e-148 of the whole.
        assert not log or ax.get_ylim()[0] >= 0.3e-6 * peaks.max()


def test_stems_of_an_order_stand_beside_each_other() -> None:
    ax = V6.balance(5000).plot(label="60°")
    V6.with_bank_angle(90, hold="pins").balance(5000).plot(ax, label="90°")
    places = [line.get_transform().transform((1.0, 0.0))[0] for line in series(ax)]
    steps = np.diff(places) / ax.figure.dpi * 72.0
    np.testing.assert_allclose(steps, 6.0)
    assert np.mean(places) == pytest.approx(ax.transData.transform((1.0, 0.0))[0])


def test_stems_stand_beside_a_picture_of_another_kind() -> None:
    ax = cp.sweep(V6, rpm=[0, 3000, 6000]).plot(Figure().subplots())
    (curve,) = series(ax)
    alone = V6.balance(3000, orders=(1, 2)).plot()
    V6.balance(3000, orders=(1, 2)).plot(ax)
    assert series(ax)[0] is curve
    for drawn, other in zip(series(ax)[1:], series(alone), strict=True):
        np.testing.assert_array_equal(drawn.get_ydata(), other.get_ydata())


def test_torque_has_one_series_and_no_legend() -> None:
    b = I4.balance(3000, orders=[2, 4, 6])
    ax = b.plot(quantity="torque")
    assert peaks_of(ax) == [b.torque.peak.tolist()]
    assert ax.get_legend() is None
    # Without zeros their circles take no room, which they would at the figure's corner.
    assert [line.get_in_layout() for line in ax.lines] == [True, False]


def test_a_given_spectrum_is_named_and_unnamed_cylinders_are_counted() -> None:
    ax = UNNAMED.balance(600, orders=(1,), spectrum={1: 9.0}).plot()
    assert title_of(ax) == "3 cylinders\n600 rpm, orders given, spectrum given"


def test_a_spectrum_of_nothing_has_no_scale() -> None:
    for log in (False, True):
        ax = V6.balance(3000, orders=(1,)).plot(quantity="force", log=log)
        assert ax.get_yticks().tolist() == [0.0]
        ax.figure.canvas.draw()


def test_stems_of_half_orders_stay_between_their_neighbours() -> None:
    fired = cp.Engine.preset("single").with_cycle(cp.Cycle.example())
    ax = fired.balance(3000).plot(quantity="crank_torque")
    half = np.diff(ax.transData.transform([(1.0, 0.0), (1.5, 0.0)])[:, 0])
    places = [line.get_transform().transform((1.0, 0.0))[0] for line in series(ax)]
    assert len(places) == 3
    assert places[-1] - places[0] < half
