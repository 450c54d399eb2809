"""Do pictures of balance shafts and of hardware compared show the results' numbers?"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.plot import balancing, painter
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

V6 = cp.Engine.preset("v6-90")
FIT = cp.balance_shafts(V6, [-1, 2])
OPTIONS = cp.balancer_options(
    V6, rpm=6000, target={"total.moment.peak": 900.0, "[1].force.peak": 1.0}
)
UNTARGETED = cp.balancer_options(cp.Engine.preset("i4"), rpm=6000)
PLOTS = {"fit": FIT.plot, "options": OPTIONS.plot, "no target": UNTARGETED.plot}


def lines(ax: Axes) -> dict[str, Any]:
    """Lines of axes by their names in the legend."""
    return {str(line.get_label()): line for line in ax.lines}


@pytest.mark.parametrize("quantity", ["force", "moment", "torque"])
def test_fit_is_drawn_with_and_without_shafts(quantity: str) -> None:
    ax = FIT.plot(quantity=quantity)
    parts = [each for each in FIT.parts() if each.quantity == quantity]
    drawn = lines(ax)
    for name, when in (("without shafts", "before"), ("with shafts", "after")):
        assert drawn[name].get_xdata().tolist() == [getattr(each, when) for each in parts]
        assert drawn[name].get_ydata().tolist() == list(range(len(parts)))
    rows = [text.get_text() for text in ax.get_yticklabels()]
    assert rows == [f"order {each.order} {each.part}".strip() for each in parts]
    (paths,) = (each for each in ax.collections if each.get_gid() == painter.CHANGE)
    assert isinstance(paths, LineCollection)
    ends = [segment[:, 0].tolist() for segment in paths.get_segments()]
    assert ends == [[each.after, each.before] for each in parts]
    assert ax.get_xlim()[1] > max(each.before for each in parts)


def test_front_is_drawn_in_per_cent_of_what_there_is() -> None:
    ax = OPTIONS.plot()
    drawn, start = lines(ax), OPTIONS[0].values
    # Order 1 has no force to begin with, and no per cent of it.
    assert {name for name in drawn if name[0] != "_"} == {
        "total shaking force",
        "total rocking moment",
        balancing.REACHED,
    }
    for k, name in enumerate(["total shaking force", "total rocking moment"]):
        expected = [100.0 * each.values[k] / start[k] for each in OPTIONS.pareto_front]
        np.testing.assert_allclose(drawn[name].get_xdata(), expected, rtol=1e-12)
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert names[:3] == ["nothing", "weights", "+2"]
    assert names[-1] == "weights, −1, −2, +2"
    (target,) = (line for line in ax.lines if line.get_gid() == balancing.TARGET)
    assert np.asarray(target.get_xdata())[0] == pytest.approx(100.0 * 900.0 / start[1])
    ringed = drawn["target reached"].get_ydata().tolist()
    assert ringed == [k for k, each in enumerate(OPTIONS.pareto_front) if each.reaches]
    assert 0 < len(ringed) < len(OPTIONS.pareto_front)
    (amounts,) = ax.child_axes
    shown = [
        float(text.get_text().replace("\N{NO-BREAK SPACE}", ""))
        for text in amounts.get_yticklabels()
    ]
    np.testing.assert_allclose(shown, [1000 * e.unbalance for e in OPTIONS.pareto_front], rtol=1e-2)


def test_sets_that_do_not_fit_are_counted() -> None:
    figure = Figure(figsize=(3.0, 1.4))
    ax = figure.subplots()
    OPTIONS.plot(ax)
    rows = len(ax.get_yticks())
    assert rows < len(OPTIONS.pareto_front)
    title = " ".join(ax.get_title(loc="left").split())
    assert title.endswith(f"; {len(OPTIONS.pareto_front) - rows} more")
    (size,) = {text.get_fontsize() for text in ax.get_yticklabels()}
    assert float(size) >= balancing.SMALLEST


def test_several_fits_share_rows_of_the_same_name() -> None:
    other = cp.balance_shafts(cp.Engine.preset("i3"), [2, -4])
    ax = other.plot(FIT.plot())
    rows = [text.get_text() for text in ax.get_yticklabels()]
    assert rows == [f"order {n} {part}" for n in (1, 2, 4) for part in ("forward", "backward")]
    drawn = lines(ax)
    assert drawn["Inline-3, with shafts"].get_ydata().tolist() == [2, 3, 4, 5]
    assert len({line.get_color() for line in drawn.values()}) == 4
    assert ax.get_title(loc="left") == "with and without balance shafts"


def test_several_comparisons_share_rows_of_the_same_name() -> None:
    ax = UNTARGETED.plot(OPTIONS.plot())
    rows = [text.get_text() for text in ax.get_yticklabels()]
    assert len(set(rows)) == len(rows)
    line = lines(ax)["Inline-4, total shaking force"]
    at = {rows[row]: value for row, value in zip(line.get_ydata(), line.get_xdata(), strict=True)}
    assert set(at) == {"nothing", "+2", "−2", "−2, +2"}
    assert at["nothing"] == 100.0
    assert not any(child.get_visible() for child in ax.child_axes)


def test_nothing_to_remove_is_said() -> None:
    ax = cp.balancer_options(cp.Engine.preset("i6"), rpm=6000, by="[1].force.peak").plot()
    assert [text.get_text() for text in ax.texts] == ["zero throughout"]
    assert not OPTIONS.plot().texts


def test_bob_weights_of_a_balanced_engine_say_zero() -> None:
    ax = cp.bob_weight(cp.Engine.preset("v12-60")).plot()
    assert "zero throughout" in [text.get_text() for text in ax.texts]
    ax = cp.bob_weight(cp.Engine.preset("single")).plot()
    assert "zero throughout" not in [text.get_text() for text in ax.texts]


def test_no_target_has_no_ring() -> None:
    ax = UNTARGETED.plot()
    assert balancing.REACHED not in lines(ax)
    assert "more" not in ax.get_title(loc="left")


@pytest.mark.parametrize("name", PLOTS)
def test_drawn_where_told_with_style_and_label(name: str) -> None:
    figure = Figure(figsize=(6.0, 4.0))
    ax = figure.subplots()
    assert PLOTS[name](ax, color="green", label="mine") is ax
    assert plt.get_fignums() == []
    legend = ax.get_legend()
    texts = [] if legend is None else [text.get_text() for text in legend.get_texts()]
    named = [text for text in texts if text != balancing.REACHED]
    assert all(text.startswith("mine, ") for text in named)
    colours = {to_rgb(line.get_color()) for line in ax.lines if line.get_gid() == "crankpin series"}
    assert colours == {to_rgb("green")}
    with pytest.raises(cp.InputError, match=r"^ax = 'here': give matplotlib axes"):
        PLOTS[name]("here")  # type: ignore[call-overload]


@pytest.mark.parametrize("look", ["default", "dark_background", "column"])
@pytest.mark.parametrize("name", PLOTS)
def test_legend_and_rows_stay_off_each_other(name: str, look: str) -> None:
    narrow: dict[str, Any] = {"figure.figsize": (3.4, 2.55), "font.size": 8}
    style = narrow if look == "column" else look
    with plt.style.context(style):
        ax = PLOTS[name]()
        figure = ax.get_figure()
        assert figure is not None
        figure.canvas.draw()
        legend = ax.get_legend()
        if legend is not None:
            box = legend.get_window_extent()
            assert not box.shrunk(0.99, 0.99).overlaps(ax.get_window_extent())
            assert figure.bbox.x1 >= box.x1
        boxes = sorted((t.get_window_extent() for t in ax.get_yticklabels()), key=lambda b: b.y0)
        for lower, upper in itertools.pairwise(boxes):
            assert lower.y1 <= upper.y0 + 2.0
        assert all(box.x0 >= 0.0 for box in boxes)
    plt.close("all")


def test_unknown_quantity() -> None:
    with pytest.raises(cp.InputError, match=r"^quantity = 'gas': give"):
        FIT.plot(quantity="gas")
    before = dict(mpl.rcParams)
    FIT.plot()
    assert dict(mpl.rcParams) == before
