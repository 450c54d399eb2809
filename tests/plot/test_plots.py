"""Do pictures show the library's numbers, say what they are, and leave nothing open?"""

from __future__ import annotations

import io
import pickle
import subprocess
import sys
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from conftest import CYLINDER, I4, V6
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

UNNAMED = cp.Engine.inline(CYLINDER, throws_deg=[0, 120, 240], spacing=0.1)
ORDERS = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
FAMILY = [
    cp.Engine.from_firing_order(
        CYLINDER,
        order,
        bank_angle_deg=60,
        spacing=0.13,
        rule="ijesc",
        name=f"IJESC V6 60°, firing order {order}",
    )
    for order in ORDERS
]
BANK_ANGLES = np.arange(10.0, 171.0, 10.0)


def legend_texts(ax: Axes) -> list[str]:
    legend = ax.get_legend()
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def rendered(figure: object) -> bytes:
    """Draw, so that locators, formatters and layout run too; return the pixels."""
    assert isinstance(figure, Figure)
    file = io.BytesIO()
    figure.savefig(file, format="rgba")
    return file.getvalue()


def xtick_texts(ax: Axes) -> list[str]:
    ax.figure.canvas.draw()
    low, high = ax.get_xlim()
    inside = [low <= place <= high for place in ax.get_xticks()]
    return [t.get_text() for t, seen in zip(ax.get_xticklabels(), inside, strict=True) if seen]


def figure_of(axes: Any) -> Any:  # noqa: ANN401 - axes and a figure
    """The figure of an array of axes."""
    return np.ravel(axes)[0].get_figure(root=True)


# --- new figures and given axes -----------------------------------------------------------------


@pytest.mark.parametrize("quantity", ["force", "moment", "torque"])
@pytest.mark.parametrize("method", ["balance", "waveform"])
def test_makes_one_figure_or_draws_on_given_axes(method: str, quantity: str) -> None:
    result = getattr(I4, method)(3000)
    made = result.plot(quantity=quantity)
    assert isinstance(made, Axes)
    assert [plt.figure(number) for number in plt.get_fignums()] == [made.figure]
    plt.close("all")
    figure = Figure()
    ax = figure.subplots()
    assert result.plot(ax, quantity=quantity) is ax
    assert ax.has_data()
    assert plt.get_fignums() == []
    assert len(set(rendered(figure))) > 50  # no empty canvas


def test_narrow_axes_keep_the_legend_inside() -> None:
    figure = Figure(figsize=(7, 3), layout="constrained")
    left, right = figure.subplots(1, 2)
    V6.balance(3000).plot(left)
    V6.waveform(3000).plot(right)
    rendered(figure)
    for ax in (left, right):
        legend, frame = ax.get_legend(), ax.get_window_extent()
        assert legend is not None
        box = legend.get_window_extent()
        assert frame.x0 <= box.x0 <= box.x1 <= frame.x1
        assert frame.y0 <= box.y0 <= box.y1 <= frame.y1


def test_what_cannot_be_drawn_leaves_no_figure() -> None:
    b, w = V6.balance(3000), V6.waveform(3000)
    s = cp.sweep(V6, rpm=[1000, 2000])
    given = V6.balance(3000, spectrum={1: 1.0})
    for plot in (
        lambda: b.plot(quantity="moments"),
        lambda: w.plot(quantity="Moment"),
        lambda: s.plot(quantity="power"),  # type: ignore[arg-type]
        lambda: given.plot(quantity="torque"),
        lambda: s.plot(x="rod_ratio"),
        lambda: cp.sweep(V6, rpm=1000).plot(),
    ):
        with pytest.raises(cp.InputError):
            plot()
    assert plt.get_fignums() == []


def test_without_matplotlib_the_error_tells_the_cure() -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "import crankpin as cp\n"
        "cp.Engine.preset('i4').balance(3000).plot()"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)  # noqa: S603
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1].endswith('pip install "crankpin[plot]"')
    assert "ImportError" in run.stderr.splitlines()[-1]


def test_importing_crankpin_does_not_import_matplotlib() -> None:
    code = "import sys, crankpin; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0  # noqa: S603


# --- balance ------------------------------------------------------------------------------------


def test_balance_bars_are_the_peaks() -> None:
    b = V6.balance(5000, orders=(1, 2, 4))
    ax = b.plot()
    heights = np.array([[bar.get_height() for bar in group] for group in ax.containers[:2]])
    np.testing.assert_array_equal(heights.T, b.moment.peak_xy)
    assert [text.get_text() for text in ax.get_xticklabels()] == ["1", "2", "4"]
    assert legend_texts(ax) == ["about x (pitch)", "about y (yaw)"]
    assert ax.get_title(loc="left") == "V6 60°, shared pins\n5000 rpm, orders given"
    assert ax.get_ylabel() == "peak rocking moment, N·m"
    assert ax.get_ylim()[0] == 0.0
    assert ax.get_ylim()[1] > b.moment.peak_xy.max()


def test_balance_force_is_along_the_axes_and_zeros_are_written() -> None:
    ax = I4.balance(12_000, orders=(1, 2)).plot(quantity="force")
    assert legend_texts(ax) == ["along x", "along y"]
    assert ax.get_ylabel() == "peak shaking force, N"
    assert ax.get_title(loc="left").endswith("12\N{NO-BREAK SPACE}000 rpm, orders given")
    texts = [text.get_text() for text in ax.texts]
    assert texts[:3] == ["0", "0", "0"]
    peak = I4.balance(12_000, orders=(2,)).force.peak_xy[0, 1]
    assert float(texts[3].replace("\N{NO-BREAK SPACE}", "")) == pytest.approx(peak, rel=5e-4)


def test_balance_of_torque_has_one_series_and_no_legend() -> None:
    b = I4.balance(3000, orders=[2, 4, 6])
    ax = b.plot(quantity="torque")
    assert [bar.get_height() for bar in ax.patches] == b.torque.peak.tolist()  # type: ignore[attr-defined]
    assert ax.get_legend() is None


def test_balance_says_that_a_spectrum_stands_in_and_counts_unnamed_cylinders() -> None:
    ax = UNNAMED.balance(600, orders=(1,), spectrum={1: 9.0}).plot()
    assert ax.get_title(loc="left") == "3 cylinders\n600 rpm, orders given, spectrum given"


def test_balance_of_nothing_has_no_scale() -> None:
    ax = V6.balance(3000, orders=(1,)).plot(quantity="force")
    assert xtick_texts(ax) == ["1"]
    assert ax.get_yticks().tolist() == [0.0]


# --- waveform -----------------------------------------------------------------------------------


def test_waveform_curves_are_the_values() -> None:
    w = V6.waveform(5000)
    ax = w.plot()
    curves = {str(line.get_label()): line for line in ax.lines}
    for k, name in enumerate(("about x (pitch)", "about y (yaw)")):
        np.testing.assert_array_equal(curves[name].get_xdata(), w.theta_deg)
        np.testing.assert_array_equal(curves[name].get_ydata(), w.moment[:, k])
    assert legend_texts(ax) == ["about x (pitch)", "about y (yaw)"]
    assert xtick_texts(ax) == [f"{angle}°" for angle in range(0, 721, 90)]
    assert ax.get_title(loc="left") == "V6 60°, shared pins\n5000 rpm, exact kinematics"
    assert ax.get_ylabel() == "rocking moment, N·m"
    assert ax.get_xlabel() == "crank angle θ"
    low, high = ax.get_ylim()
    assert low < 0 < high


@pytest.mark.parametrize(
    ("theta", "ticks"),
    [
        (np.arange(0.0, 361.0), ["0°", "60°", "120°", "180°", "240°", "300°", "360°"]),
        (np.arange(-180.0, 181.0), ["−180°", "−120°", "−60°", "0°", "60°", "120°", "180°"]),
        (np.arange(0.0, 91.0), ["0°", "15°", "30°", "45°", "60°", "75°", "90°"]),
    ],
)
def test_waveform_ticks_are_parts_of_a_turn(theta: np.ndarray, ticks: list[str]) -> None:
    assert xtick_texts(V6.waveform(5000, theta_deg=theta).plot()) == ticks


def test_waveform_says_which_orders_and_what_the_rest_can_add() -> None:
    assert V6.waveform(5000, orders=(1, 2)).plot().get_title(loc="left").endswith("orders 1, 2")
    w = V6.waveform(5000, orders="auto", rtol=1e-2)
    text = w.plot().get_title(loc="left")
    assert w.error_bound.moment > 0.0
    assert text.endswith(f"(the rest ≤ {w.error_bound.moment:.2g} N·m)")
    assert float(text.split("≤ ")[1].split(" ")[0]) == pytest.approx(w.error_bound.moment, rel=0.05)


@pytest.mark.parametrize("theta", [[], [30.0], [10.0, 10.0]])
def test_waveform_of_few_angles_is_drawn(theta: list[float]) -> None:
    rendered(V6.waveform(5000, theta_deg=theta).plot().figure)


def test_waveforms_of_a_sweep_have_a_panel_for_each_axis_and_a_curve_for_each_point() -> None:
    s = cp.sweep([V6, I4], rpm=[3000, 5000], orders=[1, 2])
    w = s.waveform(np.arange(0.0, 361.0))
    figure = figure_of(w.plot(quantity="force"))
    along_x, along_y = figure.axes
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["along x", "along y"]
    assert [ax.get_xlabel() for ax in figure.axes] == ["crank angle θ"] * 2
    assert along_x.get_ylabel() == "shaking force, N"
    assert figure.get_suptitle() == "2 engines\nshaking force\norders 1, 2"
    for k, ax in enumerate((along_x, along_y)):
        # the first line is the axis
        np.testing.assert_array_equal(
            np.array([line.get_ydata() for line in ax.lines[1:]]), w.force[..., k].reshape(4, -1)
        )
        np.testing.assert_array_equal(ax.lines[1].get_xdata(), w.theta_deg)
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts == ["V6 60°, shared pins", "Inline-4", "3000 rpm", "5000 rpm"]
    rendered(figure)


def test_waveforms_of_one_point_may_be_zero() -> None:
    figure = figure_of(cp.sweep(I4, rpm=3000, orders=[1]).waveform([0.0, 90.0]).plot())
    assert [text.get_text() for ax in figure.axes for text in ax.texts] == ["zero throughout"] * 2
    assert figure.axes[0].get_ylim() == (-1.0, 1.0)
    assert not figure.legends
    with pytest.raises(cp.InputError, match="quantity"):
        cp.sweep(I4, rpm=3000).waveform([0.0]).plot(quantity="speed")  # type: ignore[arg-type]


# --- sweep --------------------------------------------------------------------------------------


def curves_of(ax: Axes) -> np.ndarray:
    return np.array([line.get_ydata() for line in ax.lines])


def test_sweep_has_a_panel_for_each_order_and_axis_and_a_curve_for_each_engine() -> None:
    s = cp.sweep(FAMILY, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="pins", orders=[1, 2])
    figure = figure_of(s.plot())
    assert isinstance(figure, Figure)
    assert plt.get_fignums() == [figure.number]
    panels = figure.axes
    assert [ax.get_title(loc="left") for ax in panels] == [
        "order 1, about x (pitch)",
        "order 1, about y (yaw)",
        "order 2, about x (pitch)",
        "order 2, about y (yaw)",
    ]
    for k, ax in enumerate(panels):
        np.testing.assert_array_equal(curves_of(ax), s.moment.peak_xy[..., k // 2, k % 2])
        for line in ax.lines:
            np.testing.assert_array_equal(line.get_xdata(), BANK_ANGLES)
        assert ax.get_ylim()[0] == 0.0
        assert ax.get_xlim() == (10.0, 170.0)
    assert panels[0].get_ylim() == panels[1].get_ylim()
    assert panels[0].get_ylim() != panels[2].get_ylim()
    assert [ax.get_ylabel() for ax in panels] == ["peak, N·m", "", "peak, N·m", ""]
    assert [ax.get_xlabel() for ax in panels] == ["", "", "bank angle", "bank angle"]
    assert xtick_texts(panels[2]) == ["30°", "60°", "90°", "120°", "150°"]
    # The angle that the engines had before the sweep is not said.
    assert figure.get_suptitle() == (
        "IJESC V6\nrocking moment, 5000 rpm, pins held as the bank angle changes"
    )
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == list(ORDERS)
    assert legend.get_title().get_text() == "firing order"
    handles = [line.get_color() for line in legend.get_lines()]
    assert handles == [line.get_color() for line in panels[0].lines]
    assert len(set(handles)) == 4


def test_sweep_says_what_firing_holds_and_keeps_its_legend_off_the_panels() -> None:
    s = cp.sweep(FAMILY, rpm=5000, bank_angle_deg=BANK_ANGLES, hold="firing", orders=[1, 2])
    figure = figure_of(s.plot())
    assert "top dead centres held" in figure.get_suptitle()
    rendered(figure)
    legend = figure.legends[0].get_window_extent()
    (title,) = figure.texts
    for ax in figure.axes:
        box = ax.get_tightbbox()
        assert box is not None
        assert not box.overlaps(legend)
        assert not box.overlaps(title.get_window_extent())
    assert not legend.overlaps(title.get_window_extent())
    assert legend.x0 >= 0
    assert legend.x1 <= figure.bbox.x1


def test_sweep_takes_the_longest_dimension_along_x_or_the_one_named() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000, 3000], rod_ratio=[0.2, 0.3], orders=[2])
    along = figure_of(s.plot())
    np.testing.assert_array_equal(along.axes[0].lines[0].get_xdata(), [1000, 2000, 3000])
    np.testing.assert_array_equal(curves_of(along.axes[1]), s.moment.peak_xy[..., 0, 1])
    assert [t.get_text() for t in along.legends[0].get_texts()] == [
        "rod ratio 0.2",
        "rod ratio 0.3",
    ]
    assert along.axes[0].get_xlabel() == "crank speed, rpm"
    across = figure_of(s.plot(x="rod_ratio"))
    np.testing.assert_array_equal(across.axes[0].lines[0].get_xdata(), [0.2, 0.3])
    np.testing.assert_array_equal(curves_of(across.axes[1]).T, s.moment.peak_xy[..., 0, 1])
    assert [t.get_text() for t in across.legends[0].get_texts()] == [
        "1000 rpm",
        "2000 rpm",
        "3000 rpm",
    ]


def test_sweep_of_torque_has_one_column() -> None:
    s = cp.sweep([V6, I4], rpm=5000, rod_ratio=[0.2, 0.25, 0.3], orders=[2, 4, 6])
    figure = figure_of(s.plot(quantity="torque"))
    assert [ax.get_title(loc="left") for ax in figure.axes] == [
        f"order {order}, about z (roll)" for order in (2, 4, 6)
    ]
    for k, ax in enumerate(figure.axes):
        np.testing.assert_array_equal(curves_of(ax), s.torque.peak[..., k])


def test_sweep_in_any_order_draws_from_left_to_right() -> None:
    s = cp.sweep(V6, rpm=[3000, 1000, 2000], orders=[1])
    line = figure_of(s.plot()).axes[0].lines[0]
    np.testing.assert_array_equal(line.get_xdata(), [1000, 2000, 3000])
    np.testing.assert_array_equal(line.get_ydata(), s.moment.peak_xy[[1, 2, 0], 0, 0])


def test_sweep_over_engines_alone_names_them() -> None:
    s = cp.sweep([V6, I4, UNNAMED.replace(name="Inline-3")], rpm=5000, orders=[1, 2])
    figure = figure_of(s.plot(quantity="force"))
    np.testing.assert_array_equal(figure.axes[3].lines[0].get_xdata(), s.force.peak_xy[:, 1, 1])
    names = [text.get_text() for text in figure.axes[0].get_yticklabels()]
    assert names == ["V6 60°, shared pins", "Inline-4", "Inline-3"]
    assert figure.get_suptitle() == "3 engines\nshaking force, 5000 rpm"
    assert figure.axes[2].get_xlabel() == "peak, N"
    rendered(figure)


def test_many_values_get_a_scale_of_colours() -> None:
    ratios = np.linspace(0.2, 0.4, 11)
    s = cp.sweep(V6, rpm=np.arange(1000.0, 6001.0, 250.0), rod_ratio=ratios, orders=[2])
    figure = figure_of(s.plot())
    x_panel, y_panel, scale = figure.axes
    assert len(x_panel.lines) == len(y_panel.lines) == 11
    assert len({tuple(line.get_color()) for line in x_panel.lines}) == 11
    assert scale.get_ylabel() == "rod ratio"
    assert not figure.legends
    assert {"0.2", "0.3", "0.4"} <= {text.get_text() for text in scale.get_yticklabels()}


def test_two_more_dimensions_get_colours_and_dashes() -> None:
    s = cp.sweep(
        FAMILY[:2],
        rpm=[1000, 2000, 3000],
        bank_angle_deg=[60, 90],
        hold="pins",
        rod_ratio=[0.2, 0.3],
        orders=[1],
    )
    figure = figure_of(s.plot(x="rpm"))
    lines = figure.axes[0].lines
    assert len(lines) == 8
    looks = {(line.get_color(), str(line._dash_pattern)) for line in lines}  # type: ignore[attr-defined]
    assert len(looks) == 8
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        *ORDERS[:2],
        "bank angle 60°, rod ratio 0.2",
        "bank angle 60°, rod ratio 0.3",
        "bank angle 90°, rod ratio 0.2",
        "bank angle 90°, rod ratio 0.3",
    ]


def test_more_than_can_be_told_apart_is_drawn_as_bundles() -> None:
    s = cp.sweep(FAMILY[:2], rpm=np.arange(1000, 2000, 100), rod_ratio=np.linspace(0.2, 0.3, 7))
    figure = figure_of(s.plot())
    assert len(figure.axes[0].lines) == 14
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts == [*ORDERS[:2], "each: 7 × rod ratio"]


def test_curves_that_coincide_are_both_seen() -> None:
    """First-order moment does not depend on the rod: the second curve is dashed over the first."""
    s = cp.sweep(V6, rpm=[1000, 2000, 3000], rod_ratio=[0.2, 0.3], orders=[1, 2])
    figure = figure_of(s.plot())
    first, second = figure.axes[0].lines
    assert first.get_linestyle() == "-"
    assert second.get_linestyle() == "--"
    assert [line.get_linestyle() for line in figure.axes[2].lines] == ["-", "-"]


def test_panels_of_nothing_say_so() -> None:
    figure = figure_of(cp.sweep(V6, rpm=[1000, 2000], orders=[1]).plot(quantity="force"))
    assert [text.get_text() for ax in figure.axes for text in ax.texts] == ["zero throughout"] * 2
    assert figure.axes[0].get_yticks().tolist() == [0.0]


def test_one_point_is_marked() -> None:
    ax = cp.sweep(V6, rpm=[1000], orders=[1]).plot()[0, 0]
    assert ax.lines[0].get_marker() == "o"
    rendered(ax.figure)


def test_sweeps_are_drawn_on_given_axes() -> None:
    s = cp.sweep(V6, rpm=[1000, 2000], orders=[1, 2])
    _, given = plt.subplots(2, 2)
    assert (s.plot(given) == given).all()
    assert (s.waveform().plot(given[0]) == given[0]).all()
    with pytest.raises(cp.InputError, match="give an array of matplotlib axes, "):
        s.plot(given[0])


def test_figures_pickle() -> None:
    figure = figure_of(cp.sweep(V6, rpm=[1000, 2000], orders=[1]).plot())
    copy = pickle.loads(pickle.dumps(figure))  # noqa: S301 - our own
    np.testing.assert_array_equal(curves_of(copy.axes[0]), curves_of(figure.axes[0]))
