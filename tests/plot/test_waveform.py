"""Are curves over crank angle the waveform's values?"""

from __future__ import annotations

import numpy as np
import pytest
from support.engines import V6
from support.pictures import FAMILY
from support.reading import heights, legend_texts, series, title_of, xtick_texts


def test_curves_are_the_values() -> None:
    w = V6.waveform(5000)
    ax = w.plot()
    np.testing.assert_array_equal(heights(ax), w.moment.T)
    np.testing.assert_array_equal(series(ax)[0].get_xdata(), w.theta_deg)
    assert legend_texts(ax) == ["about x (pitch)", "about y (yaw)"]
    assert xtick_texts(ax) == [f"{angle}°" for angle in range(0, 721, 90)]
    assert title_of(ax) == "V6 60°, shared pins\n5000 rpm, exact kinematics"
    assert ax.get_ylabel() == "rocking moment, N·m"
    assert ax.get_xlabel() == "crank angle θ"
    low, high = ax.get_ylim()
    assert low < 0 < high


@pytest.mark.parametrize(
    ("theta", "ticks"),
    [
        (
            np.arange(0.0, 361.0),
            ["0°", "45°", "90°", "135°", "180°", "225°", "270°", "315°", "360°"],
        ),
        (
            np.arange(-180.0, 181.0),
            ["−180°", "−135°", "−90°", "−45°", "0°", "45°", "90°", "135°", "180°"],
        ),
        (np.arange(0.0, 91.0), ["0°", "15°", "30°", "45°", "60°", "75°", "90°"]),
        (np.arange(0.0, 21.0), ["0°", "5°", "10°", "15°", "20°"]),
    ],
)
def test_ticks_are_parts_of_a_turn(theta: np.ndarray, ticks: list[str]) -> None:
    assert xtick_texts(V6.waveform(5000, theta_deg=theta).plot()) == ticks


@pytest.mark.parametrize("angle", [30, 60, 90, 120, 150])
def test_figures_of_the_ijesc_paper(angle: int) -> None:
    """Figures 4-8: primary and secondary moments over a turn, an order on the same axes each."""
    engine = FAMILY[0].with_bank_angle(angle, hold="pins")
    theta = np.arange(361.0)
    primary = engine.waveform(5000, theta_deg=theta, orders=[1])
    ax = primary.plot(label="primary")
    secondary = engine.waveform(5000, theta_deg=theta, orders=[2])
    secondary.plot(ax, label="secondary")
    expected = np.hstack([primary.moment, secondary.moment]).T
    np.testing.assert_array_equal(heights(ax), expected)
    # A balance has the same peaks.
    b = engine.balance(5000, orders=[1, 2])
    np.testing.assert_allclose(
        abs(heights(ax)).max(axis=1), b.moment.peak_xy.ravel(), rtol=2e-3, atol=1e-9
    )  # sampled each degree, of order 2 each 2°
    assert len(legend_texts(ax)) == 4


def test_orders_and_what_the_rest_can_add_are_said() -> None:
    assert title_of(V6.waveform(5000, orders=(1, 2)).plot()).endswith("orders 1, 2")
    w = V6.waveform(5000, orders="auto", rtol=1e-2)
    text = title_of(w.plot())
    assert w.error_bound["moment"] > 0.0
    assert text.endswith(f"(the rest ≤ {w.error_bound['moment']:.2g} N·m)")


@pytest.mark.parametrize("theta", [[], [30.0], [10.0, 10.0]])
def test_few_angles_are_drawn(theta: list[float]) -> None:
    V6.waveform(5000, theta_deg=theta).plot().figure.canvas.draw()


def test_zero_throughout_is_said() -> None:
    ax = V6.waveform(5000, orders=[1]).plot(quantity="force")
    assert [text.get_text() for text in ax.texts] == ["zero throughout"]
    assert ax.get_ylim() == (-1.0, 1.0)
