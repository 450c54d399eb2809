"""Do pictures of a comparison show both balances, and by how much they differ?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.plot.compare import changed
from matplotlib import pyplot as plt
from support.engines import I4, V6

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDE = V6.with_bank_angle(90, hold="pins").replace(name="V6 90°")
BANKS = cp.compare(V6, WIDE, rpm=5000)
SHAFTS = cp.compare(
    I4,
    I4.with_shafts(
        [cp.Shaft(r, [cp.Unbalance(0.003, 0.15, -90)], x=0.04 * r) for r in (2, -2)]
    ),
    rpm=5000,
)  # fmt: skip


def heights(ax: Axes) -> list[dict[int, float]]:
    """Order → height of the bars before and after."""
    return [
        {round(bar.get_x() + 0.5 * bar.get_width()): bar.get_height() for bar in group}
        for group in ax.containers
    ]


@pytest.mark.parametrize("quantity", ["force", "moment", "torque", "crank_torque"])
def test_bars_are_the_peaks_of_both(quantity: str) -> None:
    bars, _ = BANKS.plot(quantity=quantity).flat
    for drawn, balance in zip(heights(bars), (BANKS.before, BANKS.after), strict=True):
        peaks = dict(zip(balance.orders, getattr(balance, quantity).peak.tolist(), strict=True))
        assert drawn == {order: peaks[order] for order in drawn}
        assert drawn
    largest = max(getattr(each, quantity).peak.max() for each in (BANKS.before, BANKS.after))
    for k, order in enumerate(BANKS.orders):
        pair = [getattr(each, quantity).peak[k] for each in (BANKS.before, BANKS.after)]
        assert (order in heights(bars)[0]) == (max(pair) > 1e-3 * largest)


def test_bars_say_by_how_much_an_order_changes() -> None:
    bars, _ = SHAFTS.plot(quantity="force").flat
    second = SHAFTS.change("force")[SHAFTS.orders.index(2)]
    assert [text.get_text() for text in bars.texts] == [
        f"{100 * second:.2g} %".replace("-", "−").replace(" ", "\N{NO-BREAK SPACE}"),
        "as before",
    ]


@pytest.mark.parametrize(
    ("pair", "text"),
    [
        ((1.0, 1.0), "as before"),
        ((0.0, 0.0), "as before"),
        ((0.0, 1.0), "new"),
        ((1.0, 0.0), "gone"),
        ((1.0, 0.07), "−93 %"),
        ((1.0, 0.0008), "−99.9 %"),
        ((1.0, 1.404), "+40 %"),
        ((2.0, 50.0), "25×"),
    ],
)
def test_changes_in_words(pair: tuple[float, float], text: str) -> None:
    assert changed(*pair) == text.replace(" %", "\N{NO-BREAK SPACE}%")


def test_curves_are_both_orbits_or_both_torques() -> None:
    for quantity in ("force", "moment"):
        _, orbit = BANKS.plot(quantity=quantity).flat
        for label, engine in (("V6 60°, shared pins", V6), ("V6 90°", WIDE)):
            (line,) = (line for line in orbit.lines if line.get_label() == label)
            wave = engine.waveform(5000, theta_deg=np.arange(361.0), orders=BANKS.orders)
            np.testing.assert_array_equal(line.get_xydata(), getattr(wave, quantity))
        assert orbit.get_legend() is None
    _, curves = BANKS.plot(quantity="torque").flat
    drawn = [line.get_ydata() for line in curves.lines if len(line.get_ydata()) == 361]
    for values, engine in zip(drawn, (V6, WIDE), strict=True):
        wave = engine.waveform(5000, theta_deg=np.arange(361.0), orders=BANKS.orders)
        np.testing.assert_array_equal(values, wave.torque)


def test_torque_of_gas_is_drawn_over_a_cycle_one_curve_for_each_engine() -> None:
    """A four-stroke's pressure repeats every other turn, and its many orders leave no room."""
    fired = cp.Engine.preset("v-twin-45").with_cycle(cp.Cycle.example())
    other = cp.counterweights(fired, planes="ends").fitted
    compared = cp.compare(fired, other, rpm=5000)
    bars, curves = compared.plot(quantity="crank_torque").flat
    drawn = [line for line in curves.lines if line.get_label() in compared.names]
    assert [line.get_xdata()[-1] for line in drawn] == [720.0, 720.0]
    wave = fired.waveform(5000, theta_deg=np.arange(721.0))
    for line in drawn:
        np.testing.assert_allclose(
            line.get_ydata(), wave.crank_torque, atol=1e-3 * line.get_ydata().max()
        )
    assert curves.get_title(loc="left") == "over two turns"
    assert len(bars.patches) > 40
    assert not any(text.get_text() for text in bars.texts)
    _, orbit = compared.plot(quantity="force").flat
    assert orbit.get_title(loc="left") == "over a turn"


def test_titles_and_legend_name_both() -> None:
    figure = BANKS.plot().flat[0].get_figure(root=True)
    first, second = figure.get_suptitle().split("\n")
    assert first == "V6 60°, shared pins → V6 90°"
    before, after = (each.total.moment.peak for each in (BANKS.before, BANKS.after))
    assert f"longest rocking moment {before:.4g} → {after:.4g} N·m" in second
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["V6 60°, shared pins", "V6 90°"]
    figure = SHAFTS.plot().flat[0].get_figure(root=True)
    assert figure.get_suptitle().startswith("Inline-4 → Inline-4 with 2 balance shafts\n")
    (legend,) = figure.legends
    assert legend.get_texts()[0].get_text() == "Inline-4"


def test_axes_given_get_the_bars() -> None:
    _, ax = plt.subplots()
    assert BANKS.plot(ax, linewidth=2.0) is ax
    assert {bar.get_linewidth() for group in ax.containers for bar in group} == {2.0}
    assert len(plt.get_fignums()) == 1
    with pytest.raises(cp.InputError, match="ax and figure cannot be combined"):
        BANKS.plot(ax, figure=plt.gcf())


def test_a_narrow_figure_has_its_panels_below_each_other() -> None:
    assert BANKS.plot().shape == (1, 2)
    assert BANKS.plot(figure=plt.figure(figsize=(3.4, 4.0))).shape == (2, 1)


def test_what_neither_has_is_said() -> None:
    twin = cp.Engine.preset("i6")
    bars, _ = cp.compare(twin, twin, rpm=3000, orders=[1, 2]).plot(quantity="force").flat
    assert [text.get_text() for text in bars.texts] == ["zero throughout"]


def test_an_error_leaves_no_figure() -> None:
    given = cp.compare(I4, V6, rpm=3000, spectrum={1: 1.0})
    for comparison, quantity in ((BANKS, "power"), (given, "torque")):
        with pytest.raises(cp.InputError):
            comparison.plot(quantity=quantity)
    assert plt.get_fignums() == []
