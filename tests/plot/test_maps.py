"""Are maps the peaks of a sweep, with readable scales?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from support.engines import I4, V6
from support.pictures import FIRED, over_two
from support.reading import figure_of, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def cells(ax: Axes) -> Any:  # noqa: ANN401 - an array
    """Values of a map: (along y, along x)."""
    return ax.collections[0].get_array()


def bars(panels: Any) -> list[Any]:  # noqa: ANN401 - axes
    return [ax for ax in figure_of(panels).axes if ax not in panels]


def test_two_long_dimensions_make_a_map() -> None:
    s = over_two()
    panels = s.plot()
    assert panels.shape == (4, 2)
    np.testing.assert_array_equal(cells(panels[0, 1]), s.total.moment.peak_xy[..., 1].T)
    np.testing.assert_array_equal(cells(panels[2, 0]), s[2].moment.peak_xy[..., 0].T)
    assert panels[-1, 0].get_xlabel() == "bank angle"
    assert panels[1, 0].get_ylabel() == "order 1\nrod ratio"


def test_the_axis_named_is_along_x_and_values_may_come_in_any_order() -> None:
    s = cp.sweep(V6, rpm=[3000, 1000, 2000], rod_ratio=[0.3, 0.2], orders=[2])
    ax = s.plot(kind="map", x="rod_ratio")[0, 0]
    sorted_ = s[2].moment.peak_xy[..., 0][::-1][:, [1, 2, 0]]
    np.testing.assert_array_equal(cells(ax), sorted_.T)
    assert ax.get_xlabel() == "rod ratio"


def test_scales_of_colours_begin_at_zero_with_round_numbers() -> None:
    panels = over_two().plot()
    figure_of(panels).canvas.draw()
    for bar, row in zip(bars(panels), panels, strict=True):
        assert row[0].collections[0].get_clim()[0] == 0.0
        assert row[0].collections[0].get_clim() == row[1].collections[0].get_clim()
        assert bar.get_ylabel() == "peak, N·m"
        texts = [text.get_text() for text in bar.get_yticklabels()]
        assert 3 <= len(texts) <= 7
        assert max(map(len, texts)) <= 5


def test_zeros_are_dotted() -> None:
    s = over_two()
    panels = s.plot()
    (dots,) = [line for line in panels[2, 0].lines if line.get_gid() == "crankpin zeros"]
    angle, ratio = np.nonzero(s[2].moment.peak_xy[..., 0] == 0.0)
    assert set(zip(dots.get_xdata(), dots.get_ydata(), strict=True)) == set(
        zip(s.coords["bank_angle_deg"][angle], s.coords["rod_ratio"][ratio], strict=True)
    )
    assert "white dots: exactly zero" in figure_of(panels).get_suptitle()


def test_engines_get_a_row_each() -> None:
    s = cp.sweep([V6, I4], rpm=[1000, 2000], rod_ratio=[0.2, 0.3], orders=[2])
    panels = s.plot(kind="map", quantity="force")
    np.testing.assert_array_equal(cells(panels[1, 1]), s.force.peak_xy[1, :, :, 0, 1].T)
    assert panels[1, 0].get_ylabel().split()[:3] == ["Inline-4,", "order", "2"]
    with pytest.raises(cp.InputError, match="give figure"):
        s.plot(plt.subplots()[1], kind="map")


def test_a_map_on_given_axes_has_the_longest_vector() -> None:
    s = over_two(orders=[1, 2])
    ax = s.plot(plt.subplots()[1])
    np.testing.assert_array_equal(cells(ax), s.total.moment.peak.T)
    assert title_of(ax).endswith("all orders given, longest vector")


def test_map_of_orders_is_logarithmic_over_a_numeric_order() -> None:
    s = cp.sweep(V6, rpm=[1000, 3000, 2000], orders=[1, 2, 4, 5])
    panels = s.plot(kind="orders")
    drawn = cells(panels[0, 1])
    expected = np.full((5, 3), np.nan)
    expected[[0, 1, 3]] = s.moment.peak_xy[[0, 2, 1], :3, 1].T
    np.testing.assert_array_equal(np.ma.filled(drawn, np.nan), expected)
    # Order 3 was not asked for; order 5 is zero and says so.
    assert [(text.get_position()[1], text.get_text()) for text in panels[0, 1].texts] == [
        (5, "zero")
    ]
    assert panels[0, 0].get_ylim() == (0.5, 5.5)
    norm = panels[0, 0].collections[0].norm
    assert norm.vmax == s.moment.peak_xy.max()
    assert type(norm).__name__ == "LogNorm"


def test_colours_of_orders_begin_at_a_ten_thousandth_of_the_largest() -> None:
    s = cp.sweep(V6, rpm=[1000, 3000], orders=[1, 2, 4, 8])
    largest = s.moment.peak_xy.max()
    assert s.moment.peak_xy[s.moment.peak_xy > 0.0].min() < 1e-4 * largest  # of order 8
    mesh = s.plot(kind="orders")[-1, -1].collections[0]
    assert mesh.norm.vmin == 1e-4 * largest
    assert mesh.colorbar.extend == "min"
    assert mesh.cmap(mesh.norm(1e-5 * largest))[3] < 0.5  # pale, on any background
    first = cp.sweep(V6, rpm=[1000, 3000], orders=[1]).plot(kind="orders")[-1, -1]
    assert first.collections[0].colorbar.extend == "neither"


def test_map_of_half_orders_has_a_row_for_each() -> None:
    s = cp.sweep(FIRED, rpm=[1000, 2000], orders=[0.5, 1, 1.5, 3])
    ax = s.plot(plt.subplots()[1], kind="orders", quantity="crank_torque")
    expected = np.full((6, 2), np.nan)
    expected[[0, 1, 2, 5]] = s.crank_torque.peak.T  # ½, 1, 1½ and 3 of ½ to 3
    expected[expected == 0.0] = np.nan  # which are written
    np.testing.assert_array_equal(np.ma.filled(cells(ax), np.nan), expected)
    assert ax.get_ylim() == (0.25, 3.25)
    zero = [order for order in s.orders if not s[order].crank_torque.peak.any()]
    assert zero == [0.5, 1]
    assert [text.get_position()[1] for text in ax.texts] == zero


def test_engines_beyond_the_rows_are_counted() -> None:
    s = cp.sweep([I4] * 6, rpm=[1000, 2000], orders=[2])
    panels = s.plot(kind="orders", quantity="force")
    assert len(panels) == 4
    assert "2 more engines not shown" in figure_of(panels).get_suptitle()
    norm = panels[0, 1].collections[0].norm
    assert norm.vmin == 0.1 * norm.vmax  # a decade at least, of peaks a quarter apart


@pytest.mark.parametrize("more", [{"kind": "orders"}, {"kind": "map", "rod_ratio": [0.2, 0.3]}])
def test_engines_on_a_map_share_a_scale_of_colours(more: dict[str, Any]) -> None:
    kind = more.pop("kind")
    heavy = I4.replace(cylinder=I4.cylinders[0].replace(reciprocating_mass=5.0))
    s = cp.sweep({"light": I4, "heavy": heavy, "V6": V6}, rpm=[1000, 2000], orders=[2], **more)
    panels = s.plot(kind=kind, quantity="force")
    largest = {each.collections[0].norm.vmax for each in panels.ravel()}
    assert largest == {s.force.peak_xy.max()}
    # An engine whose forces are all zero says so once, not at each order.
    assert ["zero throughout" in text.get_text() for text in panels[2, 1].texts] == [True]


def test_map_of_orders_on_axes() -> None:
    s = cp.sweep(I4, rpm=[1000, 3000], orders=[2, 4])
    ax = s.plot(plt.subplots()[1], kind="orders", quantity="torque")
    np.testing.assert_array_equal(np.asarray(cells(ax))[[1, 3]], s.torque.peak.T)
    ax = s.plot(plt.subplots()[1], kind="orders", quantity="force")
    np.testing.assert_array_equal(np.asarray(cells(ax))[[1, 3]], s.force.peak.T)


@pytest.mark.parametrize(
    ("more", "x", "swept"),
    [
        ({"rpm": [1000, 2000], "rod_ratio": [0.2, 0.3]}, None, "rod_ratio, rpm"),
        ({"rpm": 1000}, None, "engine"),
        ({"rpm": [1000, 2000]}, "engine", "engine, rpm"),
    ],
)
def test_map_of_orders_is_over_one_number(more: dict[str, Any], x: str | None, swept: str) -> None:
    s = cp.sweep(I4 if "rod_ratio" in more else [I4, V6], **more, orders=[2])
    with pytest.raises(cp.InputError, match=f"'orders': needs one swept number, not {swept}; give"):
        s.plot(kind="orders", x=x)


def test_map_of_nothing_has_no_scale_of_colours() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000], orders=[1])
    panels = s.plot(kind="orders", quantity="force")
    assert figure_of(panels).axes == [*panels.ravel()]


def test_map_of_nothing_is_drawn() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000], orders=[1])
    figure_of(s.plot(kind="orders", quantity="force")).canvas.draw()
    s = cp.sweep(V6, rpm=[1000, 2000], rod_ratio=[0.2, 0.3], orders=[1])
    figure_of(s.plot(kind="map", quantity="force")).canvas.draw()


def test_a_map_of_orders_ends_at_the_last_that_is_not_zero() -> None:
    """Orders of gas torque are many, those of the moment that is drawn few."""
    v8 = cp.Engine.preset("v8-crossplane", cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086))
    swept = cp.sweep(v8.with_cycle(cp.Cycle.example()), rpm=[2000, 4000, 6000])
    panels = swept.plot(kind="orders", quantity="moment")
    last = max(int(order) for order in swept.orders if swept[order].moment.peak.any())
    assert last < max(swept.orders)
    for panel in panels.flat:
        figure_of(panels).canvas.draw()
        assert panel.get_ylim() == (0.5, last + 0.5)
        drawn = np.ma.filled(cells(panel), np.nan)[last - 1]
        np.testing.assert_array_equal(np.sort(drawn), drawn)
        mesh = panel.collections[0]
        heights = np.diff(np.asarray(mesh.get_coordinates())[:, 0, 1])
        assert (heights > 0.0).all()
    assert f"above order {last}: zero" in figure_of(panels)._suptitle.get_text().replace("\n", " ")
    given = cp.sweep(v8, rpm=[2000, 4000], orders=[1, 2, 3]).plot(kind="orders", quantity="moment")
    assert given[0, 0].get_ylim() == (0.5, 3.5)


def test_maps_of_sweeps_are_in_cividis() -> None:
    for panels in (over_two().plot(), cp.sweep(V6, rpm=[1000, 2000]).plot(kind="orders")):
        assert {panel.collections[0].get_cmap().name for panel in panels.flat} == {"cividis"}
