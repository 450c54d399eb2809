"""Are polar load diagrams, curves and bending the figures of the bearing loads?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection
from support.pictures import LOADED
from support.reading import heights, legend_texts, series, title_of


def test_polar_diagrams_trace_the_loads_once() -> None:
    ax = LOADED.plot(plt.figure().subplots(), numbers=[3, 1])
    assert legend_texts(ax) == ["main bearing 3", "main bearing 1"]
    for line, expected in zip(series(ax), LOADED.main[[2, 0]], strict=True):
        # Without gas a turn is all there is.
        np.testing.assert_array_equal(line.get_xydata(), expected[:361])
    assert title_of(ax) == "Inline-4\nmain bearing loads, 6000 rpm, without gas pressure"
    assert ax.get_aspect() == 1.0


@pytest.mark.parametrize("numbers", [None, [5, 2, 3, 4]])
def test_each_bearing_has_a_panel_of_the_same_scale(numbers: list[int] | None) -> None:
    figure = None if numbers is None else plt.figure()
    drawn = LOADED.plot(numbers=numbers, figure=figure)
    panels = [panel for panel in drawn.flat if panel.get_visible()]
    named = numbers or [1, 2, 3, 4, 5]
    assert [title_of(panel) for panel in panels] == [f"main bearing {k}" for k in named]
    drawn.flat[0].figure.canvas.draw()
    for panel, number in zip(panels, named, strict=True):
        (line,) = series(panel)
        np.testing.assert_array_equal(line.get_xydata(), LOADED.main[number - 1][:361])
        assert panel.get_aspect() == 1.0
        assert panel.get_xlim() == panels[0].get_xlim()
        assert panel.get_ylim() == panels[0].get_ylim()
        ends = panel.transData.inverted().transform(panel.bbox.get_points())
        assert (ends[0] < LOADED.main.min(axis=(0, 1))).all()
        assert (ends[1] > LOADED.main.max(axis=(0, 1))).all()
    # Below each column and beside each row there are numbers.
    columns = drawn.shape[1]
    assert [panel.xaxis.get_tick_params()["labelbottom"] for panel in panels] == [
        k + columns >= len(panels) for k in range(len(panels))
    ]


@pytest.mark.parametrize(
    ("axes", "along"), [("crank", "along the throw"), ("rod", "along the rod")]
)
def test_crankpins_are_drawn_in_axes_that_turn(axes: str, along: str) -> None:
    ax = LOADED.plot(load="crankpin", numbers=[2], axes=axes, label="a pin")
    (line,) = series(ax)
    expected = LOADED.turned("crankpin", axes)[1, :361]
    np.testing.assert_array_equal(line.get_xydata(), expected)
    assert ax.get_xlabel().startswith(along)
    # Crank angles beside the only curve.
    assert {"0°", "90°", "180°", "270°"} >= {text.get_text() for text in ax.texts} - {""}
    assert line.get_label() == "a pin"


def test_polar_diagrams_go_no_further_than_the_loads_and_the_origin() -> None:
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    single = cp.Engine.preset("single", cylinder=cylinder).with_cycle(cp.Cycle.example())
    loads = cp.bearing_loads(single, rpm=1500)
    ax = loads.plot(load="crankpin", axes="rod")
    ax.figure.canvas.draw()
    along = loads.turned("crankpin", "rod")[0, :, 0]
    low, high = ax.get_xlim()
    # Gas presses: the rod pushes the pin, ten times as far as it pulls. A fifth of the extent is
    # left on either side for angles, some per cent more or less for one scale on both axes.
    assert along.min() < -8 * along.max()
    assert low == pytest.approx(along.min() - 0.2 * np.ptp(along), abs=0.05 * np.ptp(along))
    assert high == pytest.approx(along.max() + 0.2 * np.ptp(along), abs=0.05 * np.ptp(along))
    # Angles stand above and below a level line, and those at one point together.
    texts = {text.get_text(): text for text in ax.texts if text.get_text()}
    offsets = [float(text.xyann[1]) for text in texts.values()]
    assert offsets == [11.0, -11.0] * (len(offsets) // 2) + [11.0] * (len(offsets) % 2)
    assert "180°, 360°, 540°" in texts


def test_curves_are_magnitudes_of_vectors_and_values_of_others() -> None:
    ax = LOADED.plot(kind="curves", load="wrist_pin")
    np.testing.assert_array_equal(heights(ax), LOADED.wrist_pin.magnitude)
    ax = LOADED.plot(kind="curves", load="rod_force", numbers=[4])
    np.testing.assert_array_equal(heights(ax)[0], LOADED.rod_force[3])
    assert (heights(ax) < 0.0).any()


def test_bending_is_drawn_along_z_with_the_main_bearings() -> None:
    ax = LOADED.plot(kind="bending")
    cp.bearing_loads(LOADED.engine, 3000.0, LOADED.theta_deg).plot(
        ax, kind="bending", part="crankcase", label="slow"
    )
    moments = [LOADED.bending(part) for part in ("crank", "crankcase")]
    expected = [np.hypot(*np.moveaxis(each, -1, 0)).max(axis=1) for each in moments]
    np.testing.assert_array_equal(heights(ax)[:2], expected)
    np.testing.assert_allclose(heights(ax)[2], expected[1] / 4.0, rtol=1e-14, atol=1e-9)
    assert legend_texts(ax) == ["crank", "crankcase", "slow"]
    (mains,) = ax.collections
    assert isinstance(mains, LineCollection)
    np.testing.assert_array_equal(
        [line[0, 0] for line in mains.get_segments()], LOADED.engine.mains
    )


def test_an_engine_at_rest_says_so() -> None:
    still = cp.bearing_loads(LOADED.engine, 0.0, LOADED.theta_deg)
    drawn: list[Any] = [still.plot(), still.plot(kind="curves"), still.plot(kind="bending")]
    for axes in drawn:
        for panel in np.ravel(axes):
            texts = {text.get_text() for text in panel.texts}
            assert not panel.get_visible() or "zero throughout" in texts


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kind": "bars"}, "kind = 'bars': "),
        ({"numbers": [0]}, r"numbers = \[0\]: give whole numbers from 1 to 5"),
        ({"numbers": []}, r"numbers = \[\]: "),
        ({"numbers": [5], "load": "crankpin"}, r"numbers = \[5\]: give whole numbers from 1 to 4"),
        ({"load": "side_thrust"}, "load = 'side_thrust': "),
        ({"kind": "curves", "load": "moment"}, "load = 'moment': "),
        ({"kind": "bending", "part": "head"}, "part = 'head': "),
        ({"axes": "rod"}, "axes = "),
        ({"kind": "curves", "figure": 1}, "figure = 1: kind='curves' has one panel; give ax"),
        ({"kind": "bending", "figure": 1}, "figure = 1: kind='bending' has one panel; give ax"),
        ({"figure": 1}, "figure = 1: give a matplotlib Figure"),
        ({"figure": 1, "ax": 1}, "ax and figure cannot be combined"),
    ],
)
def test_errors_name_the_option(options: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        LOADED.plot(**options)


def test_angles_stand_beside_a_narrow_load() -> None:
    """A single's loads are a fifth as wide as high: away from the origin is along the curve."""
    single = cp.Engine.preset("single").with_cycle(cp.Cycle.example())
    for panel in cp.bearing_loads(single, 6000).plot(color="tab:blue").flat:
        wide, high = np.ptp([panel.get_xlim(), panel.get_ylim()], axis=1)
        assert wide == pytest.approx(0.75 * high)  # narrower ones have no room for angles
        places = [(text.xy, text.xyann) for text in panel.texts if text.get_text()]
        assert len(places) > 1
        for (x, _), (aside, up) in places:
            assert up == 0.0
            # Of a point within rounding of the axis either side will do.
            assert aside * x > 0.0 or (aside != 0.0 and abs(x) < 1e-9 * high)


def test_panels_are_coloured_by_crank_angle_with_one_bar() -> None:
    v12 = cp.Engine.preset("v12-60").with_cycle(cp.Cycle.example())
    loads = cp.bearing_loads(v12, 5000)
    drawn = loads.plot()
    figure = drawn.flat[0].figure
    panels = [panel for panel in drawn.flat if panel.get_visible()]
    assert len(figure.axes) == drawn.size + 1  # one bar
    assert figure.axes[-1].get_ylim() == (0.0, 720.0)
    for panel, vectors in zip(panels, loads.main, strict=True):
        (curve,) = (each for each in panel.collections if isinstance(each, LineCollection))
        np.testing.assert_array_equal([each[0] for each in curve.get_segments()], vectors[:-1])
        np.testing.assert_allclose(np.diff(np.asarray(curve.get_array())), 1.0, rtol=1e-12)
        assert not any(text.get_text() for text in panel.texts)
