"""Are curves of a sweep its peaks, with the right rows, names and marks?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from support.engines import I4, V6
from support.pictures import BANK_ANGLES, FAMILY, ORDERS, UNNAMED, over_bank_angle, over_two
from support.reading import figure_of, heights, legend_texts, marks, series, title_of, xtick_texts


def test_all_orders_come_first_then_the_largest() -> None:
    s = over_bank_angle()
    panels = s.plot()
    assert panels.shape == (4, 2)
    for column in range(2):
        np.testing.assert_array_equal(
            heights(panels[0, column]), s.total.moment.peak_xy[..., column]
        )
        for row, order in ((1, 1), (2, 2), (3, 4)):
            drawn = s[order].moment.peak_xy[..., column]
            np.testing.assert_array_equal(heights(panels[row, column]), drawn)
    np.testing.assert_array_equal(series(panels[0, 0])[0].get_xdata(), BANK_ANGLES)
    assert [ax.get_title(loc="left") for ax in panels[0]] == ["about x (pitch)", "about y (yaw)"]
    rows = [ax.get_ylabel().split("\n")[0] for ax in panels[:, 0]]
    assert rows == ["all orders", "order 1", "order 2", "order 4"]
    assert [ax.get_xlabel() for ax in panels[-1]] == ["bank angle"] * 2
    left_out = [n for n in s.orders if n not in (1, 2, 4) and s[n].moment.peak.any()]
    assert figure_of(panels).get_suptitle().split("\n") == [
        "IJESC V6",  # without the bank angle that the engines had before
        "rocking moment, 5000 rpm, pins held as the bank angle changes",
        f"smaller, not shown: orders {', '.join(map(str, left_out))}",
    ]


def test_of_many_orders_left_out_the_first_and_the_last_are_named() -> None:
    bored = [each.replace(bore=0.08) for each in I4.cylinders]
    fired = I4.replace(cylinder=bored, firing_order="1-3-4-2").with_cycle(cp.Cycle.example())
    s = cp.sweep(fired, rpm=[1000, 2000])
    note = figure_of(s.plot(quantity="torque")).get_suptitle().split("\n")[-1]
    left_out = [n for n in s.orders if n not in (2, 4, 6)]
    assert len(left_out) > 8
    first, last = ", ".join(map(str, left_out[:3])), left_out[-1]
    assert note == f"smaller, not shown: orders {first}, …, {last}"


def test_panels_of_a_row_have_one_scale_from_zero() -> None:
    panels = over_bank_angle().plot()
    for row in panels:
        assert row[0].get_ylim() == row[1].get_ylim()
        assert row[0].get_ylim()[0] == 0.0
        assert row[0].get_xlim() == (10.0, 170.0)
    assert panels[0, 0].get_ylim() != panels[2, 0].get_ylim()


def test_orders_asked_for_get_a_row_each() -> None:
    s = over_bank_angle(orders=[1, 2, 3])
    panels = s.plot(orders=[3, 1])
    assert [ax.get_ylabel().split("\n")[0] for ax in panels[:, 0]] == ["order 3", "order 1"]
    np.testing.assert_array_equal(heights(panels[1, 1]), s[1].moment.peak_xy[..., 1])
    # Orders that were asked for and are zero are drawn, and say so.
    assert [text.get_text() for text in panels[0, 0].texts] == ["zero throughout"]
    # Not asked for, they take no row.
    assert s.plot().shape == (3, 2)


def test_one_order_needs_no_row_of_all() -> None:
    assert over_bank_angle(orders=[1]).plot().shape == (1, 2)
    assert cp.sweep([V6, I4], rpm=[1000, 2000], orders=[2]).plot(quantity="torque").shape == (1, 1)


def test_engines_are_named_in_the_legend() -> None:
    panels = over_bank_angle().plot()
    figure = figure_of(panels)
    assert legend_texts(figure) == [*ORDERS, "exactly zero", "least of all"]
    assert figure.legends[0].get_title().get_text() == "firing order"
    colours = [line.get_color() for line in series(panels[0, 0])]
    assert [line.get_color() for line in figure.legends[0].get_lines()[:4]] == colours
    assert len(set(colours)) == 4


def test_zeros_and_the_least_value_are_marked() -> None:
    s = over_bank_angle()
    panels = s.plot()
    for row, order in ((1, 1), (2, 2), (3, 4)):
        for column in range(2):
            peaks = s[order].moment.peak_xy[..., column]
            zeros = [(angle, 0.0) for _, angle in zip(*np.nonzero(peaks == 0.0), strict=True)]
            expected = {(float(BANK_ANGLES[k]), zero) for k, zero in zeros}
            assert set(marks(panels[row, column]).get("o", [])) == expected
            texts = {text.get_text() for text in panels[row, column].texts}
            assert texts == {f"{angle:g}°" for angle, _ in expected}
    total = s.total.moment.peak_xy[..., 0]
    engine, place = np.unravel_index(total.argmin(), total.shape)
    assert marks(panels[0, 0])["D"] == [(BANK_ANGLES[place], total[engine, place])]
    assert {text.get_text() for text in panels[0, 0].texts} == {f"{BANK_ANGLES[place]:g}°"}


def test_nothing_is_best_at_the_lowest_speed() -> None:
    assert marks(cp.sweep(V6, rpm=[1000, 2000, 3000]).plot()[0, 0]) == {}


def test_on_given_axes_the_longest_vector_is_drawn() -> None:
    s = over_bank_angle()
    ax = s.plot(plt.subplots()[1])
    np.testing.assert_array_equal(heights(ax), s.total.moment.peak)
    assert legend_texts(ax) == [*ORDERS, "least of all"]
    assert title_of(ax).endswith("longest vector")
    ax = s.plot(plt.subplots()[1], orders=[2])
    np.testing.assert_array_equal(heights(ax), s[2].moment.peak)


def test_the_longest_dimension_is_along_x_or_the_one_named() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000, 3000], rod_ratio=[0.2, 0.3], orders=[2])
    along = s.plot()
    np.testing.assert_array_equal(series(along[0, 0])[0].get_xdata(), [1000, 2000, 3000])
    np.testing.assert_array_equal(heights(along[0, 1]), s.moment.peak_xy[..., 0, 1])
    assert legend_texts(figure_of(along)) == ["rod ratio 0.2", "rod ratio 0.3"]
    assert along[0, 0].get_xlabel() == "crank speed, rpm"
    across = s.plot(x="rod_ratio")
    np.testing.assert_array_equal(series(across[0, 0])[0].get_xdata(), [0.2, 0.3])
    np.testing.assert_array_equal(heights(across[0, 1]).T, s.moment.peak_xy[..., 0, 1])
    assert legend_texts(figure_of(across)) == ["1000 rpm", "2000 rpm", "3000 rpm"]


def test_values_in_any_order_are_drawn_from_left_to_right() -> None:
    s = cp.sweep(V6, rpm=[3000, 1000, 2000], orders=[1])
    (line,) = series(s.plot()[0, 0])
    np.testing.assert_array_equal(line.get_xdata(), [1000, 2000, 3000])
    np.testing.assert_array_equal(line.get_ydata(), s.moment.peak_xy[[1, 2, 0], 0, 0])


def test_engines_along_x_stand_below_each_other() -> None:
    engines = [V6, I4, UNNAMED.replace(name="Inline-3")]
    s = cp.sweep(engines, rpm=[1000, 5000], orders=[1, 2])
    panels = s.plot(quantity="force", x="engine")
    slow, fast = series(panels[1, 1])
    np.testing.assert_array_equal(slow.get_xdata(), s[2].force.peak_xy[:, 0, 1])
    np.testing.assert_array_equal(fast.get_xdata(), s[2].force.peak_xy[:, 1, 1])
    names = [text.get_text() for text in panels[0, 0].get_yticklabels()]
    assert names == ["V6 60°, shared pins", "Inline-4", "Inline-3"]
    assert panels[-1, 0].get_xlabel() == "peak, N"
    assert legend_texts(figure_of(panels)) == ["1000 rpm", "5000 rpm"]


def test_many_values_get_a_scale_of_colours_with_round_numbers() -> None:
    s = over_two(orders=[2])
    panels = s.plot(kind="curves")
    assert len({tuple(line.get_color()) for line in series(panels[0, 0])}) == 12
    (scale,) = [ax for ax in figure_of(panels).axes if ax not in panels]
    assert scale.get_ylabel() == "rod ratio"
    assert [text.get_text() for text in scale.get_yticklabels()] == [
        "0.2",
        "0.25",
        "0.3",
        "0.35",
        "0.4",
    ]
    # 0.2 is the first of the colours and 0.4 the last.
    np.testing.assert_allclose(scale.get_yticks(), [0.0, 2.75, 5.5, 8.25, 11.0])
    assert not figure_of(panels).legends or "rod" not in str(legend_texts(figure_of(panels)))


def test_of_many_engines_the_best_are_named() -> None:
    cylinders = [V6.cylinders[0].replace(rod_length=0.12 + 0.01 * k) for k in range(10)]
    engines = {f"λ = {k}": V6.replace(cylinder=each) for k, each in enumerate(cylinders)}
    s = cp.sweep(engines, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="pins", orders=[1, 2])
    panels = s.plot()
    assert len(series(panels[0, 0])) == 10
    least = s.total.moment.peak_xy.max(axis=-1).min(axis=1)
    best = sorted(np.argsort(least, kind="stable")[:5])
    names = [str(k) for k in best]
    assert legend_texts(figure_of(panels))[:6] == [*names, "5 others"]


def test_two_more_dimensions_get_colours_and_dashes() -> None:
    s = cp.sweep(
        FAMILY[:2],
        rpm=[1000, 2000, 3000],
        bank_angle_deg=[60, 90],
        hold="pins",
        rod_ratio=[0.2, 0.3],
        orders=[1],
    )
    panels = s.plot(x="rpm")
    lines = series(panels[0, 0])
    looks = {(line.get_color(), str(line._dash_pattern)) for line in lines}  # type: ignore[attr-defined]
    assert len(lines) == len(looks) == 8
    assert legend_texts(figure_of(panels)) == [
        *ORDERS[:2],
        "bank angle 60°, rod ratio 0.2",
        "bank angle 60°, rod ratio 0.3",
        "bank angle 90°, rod ratio 0.2",
        "bank angle 90°, rod ratio 0.3",
    ]


def test_more_than_can_be_told_apart_is_drawn_as_bundles() -> None:
    s = cp.sweep(FAMILY[:2], rpm=np.arange(1000, 2000, 100), rod_ratio=np.linspace(0.2, 0.3, 7))
    panels = s.plot()
    assert len(series(panels[0, 0])) == 14
    assert legend_texts(figure_of(panels)) == [*ORDERS[:2], "each: 7 of rod ratio"]


def test_curves_that_coincide_are_both_seen() -> None:
    """First-order moment does not depend on the rod: the second curve is dashed over the first."""
    s = cp.sweep(V6, rpm=[1000, 2000, 3000], rod_ratio=[0.2, 0.3])
    first, second = series(s.plot(orders=[1])[0, 0])
    np.testing.assert_allclose(np.asarray(first.get_ydata()), np.asarray(second.get_ydata()))
    assert first.get_linestyle() == "-"
    assert second.get_linestyle() == "--"


def test_panels_of_nothing_say_so() -> None:
    panels = cp.sweep(V6, rpm=[1000, 2000], orders=[1]).plot(quantity="force")
    assert [text.get_text() for ax in panels.flat for text in ax.texts] == ["zero throughout"] * 2
    assert panels[0, 0].get_yticks().tolist() == [0.0]


def test_one_point_is_marked() -> None:
    ax = cp.sweep(V6, rpm=[1000], orders=[1]).plot()[0, 0]
    assert series(ax)[0].get_marker() == "o"
    ax.figure.canvas.draw()


def test_what_firing_holds_is_said() -> None:
    s = cp.sweep(FAMILY, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="firing", orders=[1])
    assert "top dead centres held" in figure_of(s.plot()).get_suptitle()


@pytest.mark.parametrize(("width", "fewest"), [(3.4, 2), (6.4, 3)])
def test_ticks_fit_the_width(width: float, fewest: int) -> None:
    panels = over_bank_angle(orders=[1]).plot(figure=plt.figure(figsize=(width, 3.0)))
    assert len(xtick_texts(panels[0, 0])) >= fewest


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("V6 {bank_angle}°", "V6"),
        ("{bank_angle}° V6", "V6"),
        ("V6 {bank_angle}°, {pins}", "V6, split pins"),
        ("V6 60°", "V6 60°"),  # what its user typed
    ],
)
def test_titles_leave_out_the_bank_angle_alone(name: str, title: str) -> None:
    engine = cp.Engine.preset("v6-60").replace(name=name)
    s = cp.sweep(engine, rpm=5000, bank_angle_deg=[60, 90], hold="pins", orders=[1])
    assert figure_of(s.plot()).get_suptitle().split("\n")[0] == title


def test_a_scale_of_colours_leaves_the_title_of_given_axes() -> None:
    _, ax = plt.subplots()
    over_two(orders=[1]).plot(ax, kind="curves")
    assert title_of(ax).split("\n")[0] == "V6 60°, shared pins"
