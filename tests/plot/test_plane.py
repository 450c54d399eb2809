"""Are ellipses and orbits what force and moment trace, passed in the right direction?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from support.engines import I4, V6
from support.pictures import V8
from support.reading import legend_texts, series, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def traced(ax: Axes, place: int = 0) -> np.ndarray:
    line = series(ax)[place]
    return np.asarray(line.get_xdata()) + 1j * np.asarray(line.get_ydata())


def arrows(ax: Axes) -> list[complex]:
    """Directions of the arrows."""
    found = []
    for text in ax.texts:
        if not text.get_text():
            (x, y), (x0, y0) = text.xy, text.xyann  # type: ignore[attr-defined]
            found.append(complex(x - x0, y - y0))
    return found


def test_ellipses_are_those_of_the_balance() -> None:
    b = V6.balance(5000)
    panels = b.plot(kind="ellipses").ravel()
    for ax, order in zip(panels, (1, 2, 4), strict=False):
        moment, curve = b[order].moment, traced(ax)
        assert abs(curve).max() == pytest.approx(moment.peak, rel=1e-3)  # sampled each 2°
        assert abs(curve).min() == pytest.approx(abs(moment.minor), rel=1e-3)
        start = complex(*b[order].moment.xy.real)  # at θ = 0
        assert curve[0] == pytest.approx(start, abs=1e-9 * moment.peak)
        assert ax.get_aspect() == 1.0
        # Counter-clockwise is with the crank: the arrow points to the left of the radius.
        (arrow,) = arrows(ax)
        turn = np.sign((np.conj(curve[len(curve) // 8]) * arrow).imag)
        assert turn == np.sign(moment.minor)
        words = "with" if moment.minor > 0 else "against"
        assert ax.get_title(loc="left") == f"order {order}\n{words} the crank"
    assert not panels[3].get_visible()
    title = panels[0].get_figure(root=True).get_suptitle()
    assert "smaller, not shown: orders 8, 10" in title


def test_an_ellipse_may_be_a_line_without_direction() -> None:
    ax = I4.balance(3000, orders=[2]).plot(kind="ellipses", quantity="force")[0, 0]
    assert ax.get_title(loc="left") == "order 2\nstraight line"
    assert arrows(ax) == []


def test_ellipses_on_one_axes_are_named() -> None:
    ax = V6.balance(5000).plot(plt.subplots()[1], kind="ellipses")
    assert legend_texts(ax) == [
        "order 1: with the crank",
        "order 2: with the crank",
        "order 4: against the crank",
    ]


def test_nothing_traces_nothing() -> None:
    panels = V6.balance(5000, orders=[1]).plot(kind="ellipses", quantity="force")
    assert [text.get_text() for text in panels[0, 0].texts] == ["zero throughout"]
    ax = cp.Engine.preset("i4").waveform(3000, orders=[1]).plot(kind="orbit")
    assert [text.get_text() for text in ax.texts] == ["zero throughout"]


def test_an_orbit_is_the_waveform_with_crank_angles_and_direction() -> None:
    w = V8.waveform(5000, theta_deg=np.arange(0.0, 721.0))
    ax = w.plot(kind="orbit")
    # The first turn: a second one would fill the gaps of dashes.
    np.testing.assert_array_equal(traced(ax), w.moment[:361, 0] + 1j * w.moment[:361, 1])
    later = V8.waveform(5000, theta_deg=np.arange(720.0, 1441.0)).plot(kind="orbit")
    np.testing.assert_allclose(traced(later), traced(ax), rtol=0, atol=1e-9)
    labels = {text.get_text(): complex(*text.xy) for text in ax.texts if text.get_text()}
    assert labels == {f"{k}°": complex(*w.moment[k]) for k in (0, 90, 180, 270)}
    (dots,) = [line for line in ax.lines if line.get_marker() == "o"]
    np.testing.assert_array_equal(dots.get_xdata(), w.moment[:360:30, 0])
    for arrow, angle in zip(arrows(ax), (15, 135, 255), strict=True):
        passed = complex(*(w.moment[angle] - w.moment[angle - 1]))
        assert abs(np.angle(arrow / passed)) < 1e-6
    assert title_of(ax).split("\n") == [
        "V8 90°, cross-plane",
        "rocking moment, 5000 rpm, exact kinematics",
    ]


def test_crank_angles_at_one_point_share_a_label() -> None:
    ax = I4.waveform(3000, orders=[2]).plot(kind="orbit", quantity="force")
    assert [text.get_text() for text in ax.texts if text.get_text()] == ["0°, 180°", "90°, 270°"]


@pytest.mark.parametrize("theta", [[], [30.0], [10.0, 10.0], [400.0, 390.0]])
def test_orbits_of_few_angles_are_drawn(theta: list[float]) -> None:
    V6.waveform(5000, theta_deg=theta).plot(kind="orbit").figure.canvas.draw()


def test_panels_that_share_both_axes_keep_one_scale() -> None:
    figure, panels = plt.subplots(1, 2, sharex=True, sharey=True)
    V6.balance(5000, orders=[1]).plot(panels[0], kind="ellipses")
    V8.waveform(5000).plot(panels[1], kind="orbit")
    figure.canvas.draw()
    for ax in panels:
        assert ax.get_data_ratio() == pytest.approx(ax.bbox.height / ax.bbox.width, rel=1e-6)
