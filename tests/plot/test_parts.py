"""Do pictures of a sweep's parts draw what turns with the crank and what turns against it?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from support.engines import V6
from support.pictures import over_bank_angle
from support.reading import figure_of, heights, legend_texts, marks, series, title_of, xtick_texts

ANGLES = np.arange(0.0, 181.0, 5.0)


def of_one(**options: Any) -> cp.results.Sweep:  # noqa: ANN401 - of a sweep
    """A V6 that at 60° has pins split for even firing."""
    v6 = cp.Engine.preset("v6-60")
    return cp.sweep(v6, rpm=5000, bank_angle_deg=ANGLES, hold="firing", **options)


def test_a_row_is_an_order_and_a_column_an_engine() -> None:
    s = over_bank_angle()
    panels = s.plot(kind="parts", orders=[1, 2], quantity="moment")
    assert panels.shape == (2, 4)
    for i, order in enumerate((1, 2)):
        for k, panel in enumerate(panels[i]):
            both = [abs(s[order].moment.forward[k]), abs(s[order].moment.backward[k])]
            np.testing.assert_array_equal(heights(panel), both)
            assert title_of(panel).startswith(f"order {order},")
    assert legend_texts(figure_of(panels))[:2] == ["with the crank", "against the crank"]


def test_the_orders_of_one_engine_stand_beside_each_other_where_there_is_room() -> None:
    for width, rows in ((9.0, 1), (3.4, 3)):
        figure = plt.figure(figsize=(width, 5.0))
        panels = of_one().plot(kind="parts", figure=figure)
        assert panels.shape == (3, 1)  # by default the three largest
        assert [title_of(panel) for panel in panels[:, 0]] == ["order 1", "order 2", "order 4"]
        assert panels[0, 0].get_gridspec().nrows == rows
    assert "orders 8" in figure.get_suptitle()


def test_zeros_are_marked_at_their_place() -> None:
    (first,), (second,) = of_one(orders=[1, 2]).plot(kind="parts")
    assert marks(first) == {"o": [(60.0, 0.0)]}  # what turns against the crank
    assert marks(second) == {"o": [(60.0, 0.0)]}  # what turns with it
    rings = [line for line in first.lines if line.get_gid() == "crankpin mark"]
    assert rings[0].get_markeredgecolor() == series(first)[1].get_color()


@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_a_single_panel_goes_on_axes_that_are_given(quantity: str) -> None:
    _, ax = plt.subplots()
    s = cp.sweep(V6, rpm=5000, bank_angle_deg=ANGLES, hold="pins")
    assert s.plot(ax, kind="parts", quantity=quantity, orders=[2]) is ax
    vector = getattr(s[2], quantity)
    np.testing.assert_array_equal(heights(ax), abs(np.array([vector.forward, vector.backward])))
    assert legend_texts(ax)[:2] == ["with the crank", "against the crank"]
    assert xtick_texts(ax)[-1].endswith("°")


@pytest.mark.parametrize(
    ("sweep", "options", "says"),
    [
        (of_one, {"quantity": "torque"}, 'give "force" or "moment"'),
        (lambda: cp.sweep([V6, V6], rpm=1000), {}, "draws over a number"),
        (of_one, {"ax": True}, "a panel for each order and engine; give figure"),
        (lambda: cp.sweep([V6] * 9, rpm=[1e3, 2e3]), {}, "a panel for each of 9 engines"),
    ],
)
def test_what_has_no_such_picture(sweep: Any, options: dict[str, Any], says: str) -> None:  # noqa: ANN401
    s = sweep()
    if options.get("ax"):
        options = {"ax": plt.subplots()[1]}
    with pytest.raises(cp.InputError, match=says):
        s.plot(kind="parts", **options)


def test_what_is_zero_throughout_is_said_and_what_is_missing_leaves_no_figure() -> None:
    s = cp.sweep(cp.Engine.preset("v12-60"), rpm=[1000, 2000])
    panels = s.plot(kind="parts", quantity="moment")
    assert panels.shape == (1, 1)
    assert [text.get_text() for text in panels[0, 0].texts] == ["zero throughout"]
    plt.close("all")
    with pytest.raises(cp.InputError, match="orders = 0"):
        s.plot(kind="parts", orders=[0])
    assert plt.get_fignums() == []
