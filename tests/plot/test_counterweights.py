"""Do pictures of counterweights and bob weights show the library's numbers?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.quiver import Quiver
from support.pictures import V6_90, V8
from support.reading import figure_of, legend_texts, marks, series, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FITTED = cp.counterweights(V6_90, planes="webs")
UNIT_SPEED = 60.0 / (2.0 * np.pi)


def points(ax: Axes, gid: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places, heights and directions in degrees of weights or crankpins."""
    (line,) = [line for line in ax.lines if line.get_gid() == gid]
    (needles,) = [c for c in ax.collections if isinstance(c, Quiver) and c.get_gid() == gid]
    angles = np.degrees(np.arctan2(np.asarray(needles.V), np.asarray(needles.U))) % 360.0
    np.testing.assert_array_equal(needles.XY, line.get_xydata())
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata()), angles


def test_weights_stand_at_their_places_and_point_their_way() -> None:
    ax = FITTED.plot(kind="weights")
    z, height, angle = points(ax, "crankpin weights")
    assert z.tolist() == [w.z for w in FITTED.hardware]
    assert height.tolist() == [w.amount for w in FITTED.hardware]
    np.testing.assert_allclose(angle, [float(w.angle_deg) for w in FITTED.hardware])
    z, height, angle = points(ax, "crankpin pins")
    np.testing.assert_array_equal(z, V6_90.z)
    np.testing.assert_allclose(angle, V6_90.pin_deg)
    assert (height < 0.0).all()
    assert min(ax.get_yticks()) >= 0.0
    (line,) = series(ax)
    assert np.nanmax(line.get_ydata()) == FITTED.largest
    assert title_of(ax).startswith("V6 90°, split pins\ncounterweights")


def test_weights_of_a_plane_stand_on_each_other() -> None:
    fitted = cp.counterweights(V8, planes="ends", angles_deg=[0, 90, 180, 270])
    assert len(fitted.hardware) == 4
    z, height, angle = points(fitted.plot(plt.subplots()[1]), "crankpin weights")
    first, second, *_ = fitted.hardware
    assert height[0] == first.amount
    assert height[1] == first.amount + second.amount
    assert height.max() == pytest.approx(fitted.largest)
    assert z[0] == z[1]
    assert angle[0] != angle[1]


def traced(ax: Axes, place: int) -> np.ndarray:
    line = series(ax)[place]
    return np.asarray(line.get_xdata()) + 1j * np.asarray(line.get_ydata())


def test_ellipses_are_those_before_and_after() -> None:
    ax = FITTED.plot(kind="ellipses")
    for place, engine in enumerate((V6_90, FITTED.fitted)):
        moment = engine.balance(UNIT_SPEED, orders=[1])[1].moment
        curve = traced(ax, place)
        assert abs(curve).max() == pytest.approx(float(moment.peak), rel=1e-3)
        assert abs(curve).min() == pytest.approx(abs(float(moment.minor)), rel=1e-3)
    assert legend_texts(ax) == ["before: with the crank", "after: against the crank"]
    assert ax.get_xlabel() == "about x (pitch), kg·m²"
    force = FITTED.plot(plt.subplots()[1], kind="ellipses", quantity="force")
    assert legend_texts(force) == ["before: zero", "after: zero"]
    assert "along x, kg·m" in force.get_xlabel()


def test_a_summary_has_a_panel_for_what_is_not_zero() -> None:
    panels = FITTED.plot().ravel()
    assert [title_of(ax) for ax in panels] == ["weights at θ = 0", "rocking moment"]
    assert legend_texts(figure_of(panels)) == ["before", "after"]
    single = cp.counterweights(cp.Engine.preset("single"), planes=[0.0])
    assert [title_of(ax) for ax in single.plot().ravel()[1:]] == ["shaking force"]
    nothing = cp.counterweights(cp.Engine.preset("i4"), planes="ends").plot().ravel()
    assert [text.get_text() for text in nothing[1].texts] == ["zero throughout"]
    figure = plt.figure(figsize=(3.4, 5.0))
    assert FITTED.plot(figure=figure).shape == (2, 1)  # below each other
    assert FITTED.plot(figure=plt.figure(figsize=(8.0, 4.0))).shape == (1, 2)


def test_bob_weights_show_what_stays() -> None:
    bob = cp.bob_weight(V6_90, 0.55)
    ax = bob.plot()
    longest, shortest = series(ax)
    factors = np.asarray(longest.get_xdata())
    stays = bob.half_axes("moment", factors)
    np.testing.assert_array_equal(longest.get_ydata(), stays[0])
    np.testing.assert_array_equal(shortest.get_ydata(), np.abs(stays[1]))
    assert {0.0, 0.5, 0.55, 1.0} <= set(factors.round(12))
    own = bob.half_axes("moment", 0.55)
    assert marks(ax)["o"] == [(0.55, own[0]), (0.55, abs(own[1]))]
    lines = bob.straight_line_factors("moment")
    assert marks(ax)["D"] == [(factor, 0.0) for factor, _ in lines]
    assert [text.get_text() for text in ax.texts] == ["90°", "0°"]
    assert title_of(ax) == "V6 90°, split pins\nrocking moment of order 1 over ω²"
    assert legend_texts(ax)[:2] == ["longest", "shortest"]


def test_bob_weights_show_the_force_if_there_is_one() -> None:
    single, twin = cp.bob_weight(cp.Engine.preset("single")), cp.bob_weight(V8)
    ax = single.plot()
    assert ax.get_ylabel() == "half axes, kg·m"
    assert twin.plot().get_ylabel() == "half axes, kg·m²"
    assert single.plot(plt.subplots()[1], quantity="moment").get_ylabel() == "half axes, kg·m²"
    again = cp.bob_weight(cp.Engine.preset("v-twin-90"), 1.2).plot(ax)
    assert again is ax
    assert "V-twin 90°: longest" in legend_texts(ax)
    assert ax.get_xlim() == (0.0, 1.2)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kind": "arrows"}, "kind = 'arrows': give"),
        ({"quantity": "torque"}, "quantity = 'torque': give"),
        ({"ax": 3, "kind": "weights"}, "ax = 3: give matplotlib axes"),
        ({"figure": 3}, "figure = 3: give a matplotlib Figure"),
        ({"kind": "weights", "figure": 3}, "figure = 3: kind='weights' has one panel"),
        ({"label": "x"}, 'label = .*: kind="summary" shows one result'),
    ],
)
def test_options_that_do_not_fit_are_named(options: dict[str, Any], words: str) -> None:
    with pytest.raises(cp.InputError, match=words):
        FITTED.plot(**options)
    with pytest.raises(cp.InputError, match="quantity = 'torque'"):
        cp.bob_weight(V8).plot(quantity="torque")
    with pytest.raises(cp.InputError, match="cannot be combined"):
        FITTED.plot(plt.subplots()[1], figure=plt.figure())
