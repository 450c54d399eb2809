"""Do pictures honour axes, figures, style sheets and other results on the same axes?"""

from __future__ import annotations

import pickle
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from cycler import cycler
from matplotlib import pyplot as plt
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from support.engines import I4, V6
from support.pictures import over_bank_angle
from support.reading import figure_of, heights, legend_texts, series, title_of

if TYPE_CHECKING:
    from collections.abc import Callable

# --- what cannot be drawn -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("plot", "says"),
    [
        (lambda: V6.balance(3000).plot(quantity="moments"), "quantity"),
        (lambda: V6.balance(3000).plot(kind="bars"), "kind"),
        (lambda: V6.balance(3000).plot(log=1), "log"),
        (lambda: V6.balance(3000).plot(kind="ellipses", quantity="torque"), "traces no curve"),
        (lambda: V6.waveform(3000).plot(quantity="Moment"), "quantity"),
        (lambda: V6.waveform(3000).plot(kind="orbit", quantity="torque"), "traces no curve"),
        (lambda: over_bank_angle().plot(quantity="power"), "quantity"),
        (lambda: over_bank_angle().plot(x="rod_ratio"), 'give "engine" or "bank_angle_deg"'),
        (lambda: over_bank_angle().plot(kind="map"), 'give kind="curves"'),
        (lambda: over_bank_angle().plot(kind="bars"), "engines alone"),
        (lambda: over_bank_angle().plot(orders=[3.25]), "orders"),
        (lambda: cp.sweep([V6, I4], rpm=1000).plot(kind="orders"), "one swept number"),
        (lambda: cp.sweep([V6, I4], rpm=1000).plot(kind="bars", x="engine"), "leave it out"),
        (lambda: cp.sweep(V6, rpm=1000).plot(), "sweep is of one point"),
        (lambda: cp.sweep(I4, rpm=3000).waveform([0.0]).plot(quantity="speed"), "quantity"),
        (lambda: cp.sweep(I4, rpm=3000).waveform([0.0]).plot(kind="bars"), "kind"),
        (lambda: V6.balance(3000).plot(ax="left"), "give matplotlib axes"),  # type: ignore[call-overload]
        (lambda: V6.balance(3000).plot(kind="ellipses", figure=3), "Figure or SubFigure"),
        (lambda: V6.balance(3000).plot(figure=Figure()), "one panel; give ax"),
        (lambda: V6.waveform(3000).plot(figure=Figure()), "one panel; give ax"),
        (lambda: V6.waveform(3000).plot(axes=Figure().subplots()), "axes = .*: .* no such option"),
        (
            lambda: over_bank_angle().plot(Figure().subplots(), figure=Figure()),
            "cannot be combined",
        ),
        (
            lambda: over_bank_angle().plot(Figure().subplots(), orders=[1, 2]),
            "a single panel shows one order",
        ),
    ],
)
def test_what_cannot_be_drawn_leaves_no_figure(plot: Callable[[], Any], says: str) -> None:
    with pytest.raises(cp.InputError, match=says):
        plot()
    assert plt.get_fignums() == []


def test_without_torque_there_is_no_picture_of_it() -> None:
    given = V6.balance(3000, spectrum={1: 1.0})
    with pytest.raises(AttributeError, match="torque"):
        given.plot(quantity="torque")
    assert plt.get_fignums() == []


def test_without_matplotlib_the_error_tells_the_remedy() -> None:
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


# --- several results on the same axes -----------------------------------------------------------


def test_successive_results_get_successive_colours_and_names() -> None:
    ax = V6.waveform(5000).plot(label="60°")
    wide = V6.with_bank_angle(90, hold="pins").waveform(5000)
    wide.plot(ax, label="90°")
    lines = series(ax)
    assert len({to_hex(line.get_color()) for line in lines}) == 4
    assert len({str(line._dash_pattern) for line in lines}) == 4  # type: ignore[attr-defined]
    np.testing.assert_array_equal(heights(ax)[2:], wide.moment.T)
    assert legend_texts(ax) == [
        "60°, about x (pitch)",
        "60°, about y (yaw)",
        "90°, about x (pitch)",
        "90°, about y (yaw)",
    ]


def test_a_second_result_without_a_label_is_named_by_its_engine() -> None:
    ax = V6.waveform(5000).plot(quantity="torque")
    I4.waveform(5000).plot(ax, quantity="torque")
    assert legend_texts(ax) == ["about z (roll)", "Inline-4"]
    # What the two have in common.
    assert title_of(ax) == "5000 rpm, exact kinematics, without gas pressure"


def test_sweeps_on_the_same_axes_are_told_apart() -> None:
    one = cp.sweep(V6, rpm=[1000, 2000, 3000])
    ax = one.plot(plt.subplots()[1], label="V6")
    cp.sweep(I4, rpm=[1000, 2000, 3000]).plot(ax, quantity="moment", label="I4")
    first, second = series(ax)
    assert first.get_color() != second.get_color()
    assert legend_texts(ax) == ["V6", "I4"]
    np.testing.assert_array_equal(first.get_ydata(), one.total.moment.peak)


# --- style --------------------------------------------------------------------------------------


def test_keywords_go_on_to_the_lines() -> None:
    ax = V6.waveform(5000).plot(color="crimson", lw=3.5, alpha=0.5)
    lines = series(ax)
    assert [to_hex(line.get_color()) for line in lines] == [to_hex("crimson")] * 2
    assert [line.get_linewidth() for line in lines] == [3.5] * 2
    assert lines[0].get_linestyle() != lines[1].get_linestyle()  # still told apart


def test_the_style_sheet_in_use_gives_colours_and_sizes() -> None:
    with mpl.rc_context(
        {
            "axes.prop_cycle": cycler(color=["#123456", "#654321"]),
            "font.size": 7,
            "axes.titlesize": 5,
        }
    ):
        ax = V6.waveform(5000).plot()
        assert [line.get_color() for line in series(ax)] == ["#123456", "#654321"]
        legend = ax.get_legend()
        assert legend is not None
        assert legend.get_texts()[0].get_fontsize() == pytest.approx(7 * 0.833)
        assert ax._left_title.get_fontsize() == 5.0
        assert figure_of(ax).get_size_inches().tolist() == mpl.rcParams["figure.figsize"]


def test_a_cycle_with_line_styles_is_taken_whole() -> None:
    styles = cycler(color=["red", "blue"]) + cycler(linestyle=[":", "-"])
    with mpl.rc_context({"axes.prop_cycle": styles}):
        assert [line.get_linestyle() for line in series(V6.waveform(5000).plot())] == [":", "-"]


def test_marks_on_dark_axes_are_light_also_after_the_style_is_gone() -> None:
    with plt.style.context("dark_background"):
        figure = plt.figure()
        ax = figure.subplots()
    V8 = cp.Engine.preset("v8-crossplane")
    V8.waveform(5000).plot(ax, kind="orbit")
    angles = [text for text in ax.texts if "°" in text.get_text()]
    assert len(angles) == 4
    assert {to_hex(text.get_color()) for text in angles} == {"#ffffff"}


def test_our_own_look_is_a_style_sheet() -> None:
    with plt.style.context("crankpin.plot.crankpin"):
        ax = V6.waveform(5000).plot()
    assert not ax.spines["top"].get_visible()
    assert [line.get_color() for line in series(ax)] == ["#0072B2", "#D55E00"]


def test_names_with_dollar_signs_are_text() -> None:
    ax = V6.replace(name="a $x^2$ engine").waveform(5000).plot()
    ax.figure.canvas.draw()
    assert title_of(ax).startswith(r"a \$x^2\$ engine")


def test_figures_pickle() -> None:
    figure = figure_of(cp.sweep(V6, rpm=[1000, 2000], orders=[1]).plot())
    copy = pickle.loads(pickle.dumps(figure))  # noqa: S301 - our own
    np.testing.assert_array_equal(heights(copy.axes[0]), heights(figure.axes[0]))
