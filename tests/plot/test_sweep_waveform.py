"""Are waveforms of a sweep its curves, or their envelope where they are many?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
from matplotlib import pyplot as plt
from support.engines import I4, V6
from support.pictures import over_two
from support.reading import figure_of, heights, legend_texts, series, title_of

THETA = np.arange(0.0, 361.0)


def test_few_points_are_curves() -> None:
    w = cp.sweep([V6, I4], rpm=[3000, 5000], orders=[1, 2]).waveform(THETA)
    panels = w.plot(quantity="force")
    assert panels.shape == (1, 2)
    for k, ax in enumerate(panels[0]):
        np.testing.assert_array_equal(heights(ax), w.force[..., k].reshape(4, -1))
        np.testing.assert_array_equal(series(ax)[0].get_xdata(), THETA)
        assert ax.get_xlabel() == "crank angle θ"
    assert [ax.get_title(loc="left") for ax in panels[0]] == ["along x", "along y"]
    assert panels[0, 0].get_ylabel().split() == ["shaking", "force,", "N"]
    figure = figure_of(panels)
    assert figure.get_suptitle() == "2 engines\nshaking force\norders 1, 2"
    assert legend_texts(figure) == ["V6 60°, shared pins", "Inline-4", "3000 rpm", "5000 rpm"]


def test_a_panel_of_zeros_does_not_cut_its_neighbour() -> None:
    w = cp.sweep(I4, rpm=[3000, 5000], orders=[2]).waveform(THETA)
    across, along = w.plot(quantity="force")[0]
    assert across.get_ylim() == along.get_ylim()
    assert along.get_ylim()[1] > w.force.max()
    assert [text.get_text() for text in across.texts] == ["zero throughout"]
    assert not along.texts
    none = cp.sweep(I4, rpm=[3000, 5000], orders=[1]).waveform(THETA).plot(quantity="force")
    assert none[0, 0].get_ylim() == (-1.0, 1.0)


def test_many_points_are_an_envelope_with_quantiles() -> None:
    w = over_two(orders=[1, 2]).waveform(THETA)
    panels = w.plot()
    flat = w.moment.reshape(-1, len(THETA), 2)
    for k, ax in enumerate(panels[0]):
        np.testing.assert_array_equal(heights(ax)[0], np.quantile(flat[..., k], 0.5, axis=0))
        for band, low, high in zip(ax.collections, (0.0, 0.25), (1.0, 0.75), strict=True):
            corners = band.get_paths()[0].vertices
            for at in (0, 90, 250):
                ends = corners[corners[:, 0] == at][:, 1]
                assert ends.min() == np.quantile(flat[:, at, k], low)
                assert ends.max() == np.quantile(flat[:, at, k], high)
    figure = figure_of(panels)
    assert legend_texts(figure) == ["smallest to largest", "middle half", "median"]
    assert figure.get_suptitle().endswith("228 points of a sweep")


def test_the_kind_may_be_asked_for() -> None:
    few = cp.sweep([V6, I4], rpm=3000).waveform(THETA)
    assert len(few.plot(kind="envelope")[0, 0].collections) == 2
    many = over_two(orders=[2]).waveform(THETA)
    assert len(series(many.plot(kind="curves")[0, 0])) == 228


def test_on_given_axes_the_length_of_the_vector() -> None:
    w = cp.sweep([V6, I4], rpm=3000, orders=[1, 2]).waveform(THETA)
    ax = w.plot(plt.subplots()[1], quantity="force")
    np.testing.assert_array_equal(heights(ax), np.linalg.norm(w.force, axis=-1))
    assert "length of the vector" in title_of(ax)
    ax = w.plot(plt.subplots()[1], quantity="torque")
    np.testing.assert_array_equal(heights(ax), w.torque)
    assert legend_texts(ax) == ["V6 60°, shared pins", "Inline-4"]


def test_one_point_may_be_zero() -> None:
    panels = cp.sweep(I4, rpm=3000, orders=[1]).waveform([0.0, 90.0]).plot()
    assert [text.get_text() for ax in panels.flat for text in ax.texts] == ["zero throughout"] * 2
    assert panels[0, 0].get_ylim() == (-1.0, 1.0)
    assert not figure_of(panels).legends
