"""Do pictures of a mounted engine draw the result's numbers?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CYLINDER = cp.Cylinder(crank_radius=0.043, rod_length=0.145, reciprocating_mass=0.45, bore=0.086)
MOUNTED = cp.Powertrain(
    cp.Engine.preset("i4", cylinder=CYLINDER).with_cycle(cp.Cycle.example()),
    cp.RigidBody(
        mass=148,
        cg=(0.02, 0.07, 0.09),
        inertia=[[8.1, 1.3, -0.4], [1.3, 7.6, 0.5], [-0.4, 0.5, 4.9]],
        products="tensor",
    ),
    [
        cp.Mount("right", at=(0.28, 0, -0.09), stiffness=(2.2e5, 8e4, 8e4), loss_factor=0.1),
        cp.Mount("left", at=(-0.28, 0, -0.09), stiffness=(2.2e5, 8e4, 8e4), loss_factor=0.1),
        cp.Mount("rear", at=(0, -0.12, 0.55), stiffness=(1e5, 1.8e5, 1e5), loss_factor=0.1),
    ],
)
RUN_UP = MOUNTED.with_misfire(cylinder=3).response(np.arange(600, 3001, 100))
COORDINATES = (2, 0, 1, 5, 3, 4)


def bars_of(ax: Axes) -> list[Rectangle]:
    return [patch for patch in ax.patches if isinstance(patch, Rectangle)]


def test_a_row_of_modes_is_its_energy() -> None:
    modes = MOUNTED.modes()
    ax = modes.plot()
    (image,) = ax.images
    np.testing.assert_array_equal(image.get_array(), modes.energy[list(COORDINATES)].T)
    below = int((modes.energy < -0.1).sum())
    assert len(ax.patches) == below > 0
    assert [text.get_text().split()[0] for text in ax.get_yticklabels()] == [
        f"{k}:" for k in range(1, 7)
    ]


def test_cuts_are_all_orders_and_the_largest() -> None:
    ax = RUN_UP.plot(mount="rear")
    force = RUN_UP.mount_force["rear"]
    whole, *cuts = ax.lines
    np.testing.assert_array_equal(whole.get_ydata(), force.total.peak)
    assert len(cuts) == 5
    for line in cuts:
        order = float(str(line.get_label()).removeprefix("order "))
        np.testing.assert_array_equal(line.get_ydata(), force[order].peak)
    least = min(float(np.max(line.get_ydata())) for line in cuts)
    assert (np.sort(force.peak.max(axis=0))[-5:] >= least).all()


def test_a_map_has_a_row_of_cells_for_each_order_and_its_modes() -> None:
    ax = RUN_UP.plot(kind="map", orders=[0.5, 1, 2])
    (mesh,) = ax.collections
    drawn: Any = mesh.get_array()
    cells = drawn.filled(np.nan).reshape(4, -1)
    for row, order in ((0, 0.5), (1, 1), (3, 2)):
        expected = np.maximum(RUN_UP.body_force[order].peak, 0.0)
        np.testing.assert_allclose(cells[row], expected, rtol=1e-12)
    for line, frequency in zip(ax.lines, RUN_UP.powertrain.modes().frequency, strict=True):
        speed, multiple = map(np.asarray, line.get_data())
        np.testing.assert_allclose(speed * multiple / 60.0, frequency)


def stems_of(ax: Axes) -> LineCollection:
    (stems,) = (
        each
        for each in ax.collections
        if isinstance(each, LineCollection) and each.get_array() is not None
    )
    return stems


def test_a_waterfall_has_a_spectrum_of_each_speed_above_the_one_before() -> None:
    ax = RUN_UP.plot(kind="waterfall", mount="left", orders=[0.5, 2])
    stems = stems_of(ax)
    force = RUN_UP.mount_force["left"]
    expected = {
        (order * rpm / 60.0, rpm): peak
        for order in (0.5, 2)
        for rpm, peak in zip(
            np.atleast_1d(RUN_UP.rpm), np.atleast_1d(force[order].peak), strict=True
        )
    }
    largest = max(expected.values())
    drawn: Any = stems.get_array()
    for (foot, tip), colour in zip(stems.get_segments(), drawn, strict=True):
        peak = expected.pop((float(foot[0]), float(foot[1])))
        assert foot[0] == tip[0]
        assert colour == peak
        # Three decades are four steps of 100 rpm high.
        height = 400.0 * max(0.0, 1.0 + np.log10(peak / largest) / 3.0)
        np.testing.assert_allclose(tip[1] - foot[1], height, rtol=1e-9, atol=1e-9)
    assert not expected
    modes = [np.asarray(line.get_xdata())[0] for line in ax.lines]
    np.testing.assert_array_equal(modes, RUN_UP.powertrain.modes().frequency)
    assert [text.get_text() for text in ax.texts] in (["0.5", "2"], ["2", "0.5"])


def test_a_waterfall_of_many_speeds_draws_forty_and_of_nothing_none() -> None:
    rpm = np.random.default_rng(4).permutation(np.arange(600.0, 3001.0, 10.0))
    ax = MOUNTED.response(rpm, orders=[2]).plot(kind="waterfall")
    speeds = {float(foot[1]) for foot, _ in stems_of(ax).get_segments()}
    assert (len(speeds), min(speeds), max(speeds)) == (40, 600.0, 3000.0)
    still = MOUNTED.response(rpm[:3], orders=[1]).plot(kind="waterfall")
    assert [text.get_text() for text in still.texts] == ["zero throughout"]


def test_a_spectrum_has_bars_along_each_axis() -> None:
    one = RUN_UP.sel(rpm=800)
    ax = one.plot(orders=[0.5, 1, 2])
    heights = np.array([bar.get_bbox().height for bar in bars_of(ax)]).reshape(3, 3)
    expected = [one.body_force[order].peak_xyz for order in (0.5, 1, 2)]
    np.testing.assert_array_equal(heights.T, expected)


def test_a_base_that_moves_is_drawn_over_frequency() -> None:
    floor = cp.BaseMotion({20.0: (0, 1e-4, 0), 5.0: (0, 1e-4, 0), 10.0: (1e-4, 0, 0)})
    shaken: Any = MOUNTED.response(base=floor)
    ax = shaken.plot()
    (line,) = ax.lines
    np.testing.assert_array_equal(line.get_xdata(), [5.0, 10.0, 20.0])
    np.testing.assert_array_equal(line.get_ydata(), shaken.body_force.total.peak)
    assert ax.get_xlabel() == "frequency, Hz"
    point = shaken.at((0, 0.3, 0))
    (line,) = point.plot(quantity="displacement").lines
    np.testing.assert_array_equal(line.get_ydata(), 1e6 * point.displacement.total.peak)
    one = shaken.sel(frequency=10.0).plot()
    assert "10 Hz" in one.get_title(loc="left") + "".join(t.get_text() for t in one.texts)
    for kind in ("map", "waterfall"):
        with pytest.raises(cp.InputError, match=rf"kind = '{kind}': is of orders over speed"):
            shaken.plot(kind=kind)
    with pytest.raises(cp.InputError, match=r"kind = 'spectrum': give one frequency, as r\.sel"):
        shaken.plot(kind="spectrum")
    plt.close("all")


def test_unfit_pictures_are_rejected() -> None:
    with pytest.raises(cp.InputError, match=r"kind = 'spectrum': give one speed"):
        RUN_UP.plot(kind="spectrum")
    with pytest.raises(cp.InputError, match=r"kind = 'map': needs several speeds"):
        RUN_UP.sel(rpm=800).plot(kind="map")
    for kind in ("map", "waterfall"):
        with pytest.raises(cp.InputError, match=rf"label = 'a': a {kind} has no legend"):
            RUN_UP.plot(kind=kind, label="a")
        with pytest.raises(cp.InputError, match=rf"kind = '{kind}': needs two different speeds"):
            MOUNTED.response([800.0, 800.0]).plot(kind=kind)
    with pytest.raises(cp.InputError, match=r"mount = 'reer'"):
        RUN_UP.plot(mount="reer")
    assert not plt.get_fignums()


def test_a_design_is_its_frequencies_before_and_after() -> None:
    designed = cp.design_mounts(
        MOUNTED, vary="stiffness", bounds={"stiffness": (3e4, 6e5)}, modes_between=(4, 30), starts=1
    )
    ax = designed.plot()
    before, after = ax.lines
    np.testing.assert_array_equal(before.get_xdata(), MOUNTED.modes().frequency)
    np.testing.assert_array_equal(after.get_xdata(), designed.fitted.modes().frequency)
    (window,) = bars_of(ax)
    assert window.get_bbox().intervalx.tolist() == [4.0, 30.0]
    assert "decoupling" in ax.get_title(loc="left")


def scattered() -> cp.results.DesignResponses:
    draw = np.random.default_rng(2)
    vary = {"right": {"stiffness": draw.uniform(1e5, 4e5, (9, 3))}}
    return MOUNTED.designs([700.0, 1500.0, 1100.0], vary, orders=[1, 2])


def test_designs_are_their_forces_over_speed_and_one_bold() -> None:
    designs = scattered()
    ax = designs.plot(design=4, order=2, count=5)
    *thin, bold = ax.lines
    assert len(thin) == 5
    speeds = [700.0, 1100.0, 1500.0]
    for k, line in zip([0, 2, 4, 6, 8], thin, strict=True):
        force = designs.powertrain_of(k).response(speeds, orders=[1, 2]).body_force[2]
        np.testing.assert_array_equal(line.get_data(), (speeds, force.peak))
    np.testing.assert_array_equal(bold.get_ydata(), thin[2].get_ydata())
    assert bold.get_linewidth() > 3 * thin[0].get_linewidth()
    least = int(np.linalg.norm(designs.body_force_rms, axis=1).argmin())
    of_mount = designs.plot(mount="right")
    response = designs.powertrain_of(least).response(speeds, orders=[1, 2])
    drawn = of_mount.lines[-1].get_ydata()
    np.testing.assert_array_equal(drawn, response.mount_force["right"].total.peak)
    for wrong in ({"order": 3}, {"mount": "reer"}, {"design": 9}, {"count": 0}):
        with pytest.raises(cp.InputError, match=next(iter(wrong))):
            designs.plot(**wrong)


def test_robustness_is_a_bar_for_each_mode_and_cause() -> None:
    result = MOUNTED.robustness(0.2, mass=0.02, cg=0.01)
    ax = result.plot()
    ends = [bar.get_bbox().intervalx for bar in bars_of(ax)]
    expected = [result.frequency_bounds.T, result.mass_bounds.T, result.cg_range.T]
    np.testing.assert_allclose(ends, np.concatenate(expected), rtol=1e-14)
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels[0].endswith(f"{result.purity[0]:.0f} → {result.least_purity[0]:.0f} %")


def test_axes_of_roll_are_drawn_in_three_views() -> None:
    axes = MOUNTED.axes()
    side, rear, above = axes.plot().flat
    for panel, right, up in ((side, 2, 1), (rear, 0, 1), (above, 2, 0)):
        lines = {str(line.get_label()): line for line in panel.lines}
        mounts = np.array([mount.at for mount in MOUNTED.mounts])
        np.testing.assert_array_equal(lines["mounts"].get_data(), mounts[:, [right, up]].T)
        np.testing.assert_array_equal(
            np.ravel(lines["centre of gravity"].get_data()),
            [MOUNTED.body.cg[right], MOUNTED.body.cg[up]],
        )
        (polygon,) = panel.patches
        corners = {tuple(corner) for corner in polygon.get_xy().tolist()}
        assert corners == {tuple(place) for place in mounts[:, [right, up]].tolist()}
    for name, through, along in (
        ("torque roll axis", np.array(MOUNTED.body.cg), axes.torque_roll),
        ("elastic roll axis", axes.elastic_foot, axes.elastic),
    ):
        line = next(each for each in side.lines if each.get_label() == name)
        z, y = map(np.asarray, line.get_data())
        np.testing.assert_allclose(
            (y - through[1]) * along[2], (z - through[2]) * along[1], atol=1e-12
        )
    one = plt.figure().subplots()
    assert axes.plot(one) is one
