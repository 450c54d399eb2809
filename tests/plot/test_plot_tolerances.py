"""Do the pictures of tolerances show the numbers of the samples?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest

pytest.importorskip("matplotlib")

from typing import TYPE_CHECKING

from matplotlib import pyplot as plt
from matplotlib.patches import Rectangle, StepPatch

if TYPE_CHECKING:
    from matplotlib.axes import Axes

T = cp.tolerances(
    cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, pin_deg=0.1, samples=400
)


@pytest.fixture
def ax() -> Axes:
    return plt.subplots()[1]


def vertical(ax: Axes, label: str) -> float:
    (line,) = (line for line in ax.lines if line.get_label() == label)
    return float(np.asarray(line.get_xdata())[0])


def test_a_histogram_of_equal_values_has_one_bar(ax: Axes) -> None:
    # The force of a single cylinder does not depend on where its pin points.
    single = cp.tolerances(cp.Engine.preset("single"), rpm=3000, pin_deg=0.1, samples=100)
    single.plot(ax, by="total.force.peak")
    assert ax.get_ylim()[1] >= 100.0


def test_a_histogram_has_all_samples_and_the_nominal_value(ax: Axes) -> None:
    assert T.plot(ax) is ax
    steps = [patch for patch in ax.patches if isinstance(patch, StepPatch)]
    values, edges, _ = steps[-1].get_data()
    found = np.histogram(T.sample_values(), edges)[0]
    np.testing.assert_allclose(values, 100.0 * found / 400)
    assert values.sum() == pytest.approx(100.0)
    assert vertical(ax, "nominal") == T.nominal_value()
    lines = ax.collections[0].get_segments()  # type: ignore[attr-defined]
    assert [line[0, 0] for line in lines] == T.quantile().tolist()
    assert ax.get_xlabel() == "longest shaking force, N"


def test_an_ecdf_rises_by_a_sample_at_each_value(ax: Axes) -> None:
    T.plot(ax, kind="ecdf", by="[1].force.forward", label="2 g", color="tab:green")
    curve = next(line for line in ax.lines if line.get_label() == "2 g")
    np.testing.assert_array_equal(curve.get_xdata(), np.sort(T.sample_values("[1].force.forward")))
    np.testing.assert_allclose(np.asarray(curve.get_ydata()), 100.0 * np.arange(1, 401) / 400)
    assert curve.get_color() == "tab:green"
    dots = next(line for line in ax.lines if "quantiles" in str(line.get_label()))
    assert np.array(dots.get_xdata()).tolist() == T.quantile(by="[1].force.forward").tolist()


def test_shares_are_bars_one_after_the_other(ax: Axes) -> None:
    T.plot(ax, kind="shares")
    bars = [patch for patch in ax.patches if isinstance(patch, Rectangle)]
    parts = T.shares.columns[1:-1]
    widths = np.array([bar.get_width() for bar in bars]).reshape(len(parts), -1)
    np.testing.assert_allclose(widths, [part.values for part in parts])
    second = bars[len(T.by) :]
    for bar, before in zip(second, widths[0], strict=True):
        assert bar.get_x() == pytest.approx(before)
    rows = [text.get_text() for text in ax.get_yticklabels()]
    assert len(rows) == len(T.by)
    assert rows[:2] == ["total force", "total moment"]  # in words, not as the paths of T.by


def test_two_results_share_axes_in_successive_colours(ax: Axes) -> None:
    other = cp.tolerances(T.engine, rpm=6000, reciprocating_mass=0.004, samples=400)
    for result, label in ((T, "2 g"), (other, "4 g")):
        result.plot(ax, kind="ecdf", label=label)
    curves = [line for line in ax.lines if line.get_label() in ("2 g", "4 g")]
    assert curves[0].get_color() != curves[1].get_color()
    legend = ax.get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts == ["2 g", "5, 50, 95 % quantiles", "4 g", "nominal"]


def test_new_axes_and_errors() -> None:
    ax = T.plot(kind="shares", by="total.force.peak")
    assert len(ax.patches) == len(T.shares.columns) - 2
    plt.close("all")
    with pytest.raises(cp.InputError, match=r'kind = .pie.: give "histogram", "ecdf" or "shares"'):
        T.plot(kind="pie")
    with pytest.raises(cp.InputError, match="by = "):
        T.plot(by="weight")
    assert not plt.get_fignums()
