"""Do pictures stay readable where the user, the engine or the result is unusual?"""

from __future__ import annotations

import itertools
import threading
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.collections import QuadMesh
from support.engines import CYLINDER, I4, V6
from support.reading import heights, legend_texts, series, title_of, xtick_texts

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

SINGLE = cp.Engine.preset("single")
V16 = cp.Engine.preset("v16-45")
NOTHING = cp.Engine.inline(cp.Cylinder(0.043, 0.145, 0.0), throws_deg=[0, 180], spacing=0.1)
RADIAL = cp.Engine.from_lists(CYLINDER, tdc_deg=[0, 120, 240], bank_deg=[90, 210, 330], z=[0, 0, 0])
SPEEDS = [1000.0, 2000.0]


def over_speed(engine: cp.Engine) -> cp.results.Sweep:
    return cp.sweep(engine, rpm=SPEEDS)


# --- layout -------------------------------------------------------------------------------------


def inside(figure: Figure, ax: Any) -> None:  # noqa: ANN401 - axes
    """Everything that belongs to axes is within the figure, a pixel allowed for hinting."""
    figure.canvas.draw()
    box, page = ax.get_tightbbox(), figure.bbox.padded(1.0)
    assert page.containsx(box.x0)
    assert page.containsx(box.x1)
    assert page.containsy(box.y0)
    assert page.containsy(box.y1)


def test_axes_of_a_figure_without_layout_keep_legend_and_labels() -> None:
    figure, ax = plt.subplots()
    V6.balance(5000).plot(ax=ax)
    assert legend_texts(ax)
    inside(figure, ax)


def test_titles_of_neighbours_do_not_overlap() -> None:
    figure, panels = plt.subplots(1, 2, figsize=(5.0, 3.3))
    for ax in panels:
        V6.replace(name="a long name of an engine with six cylinders").waveform(5000).plot(ax)
        inside(figure, ax)
    left, right = (ax._left_title.get_window_extent() for ax in panels)
    assert left.x1 < right.x0


def test_margins_set_by_hand_stay() -> None:
    figure, ax = plt.subplots()
    figure.subplots_adjust(left=0.3)
    V6.balance(5000).plot(ax=ax)
    figure.canvas.draw()
    assert figure.get_layout_engine() is None
    assert ax.get_position().x0 == pytest.approx(0.3)


def test_ticks_of_narrow_axes_do_not_touch() -> None:
    figure, panels = plt.subplots(1, 2, figsize=(3.3, 2.5))
    sweep = cp.sweep(V6, rpm=np.linspace(1000.0, 9000.0, 9))
    for ax in panels:
        sweep.plot(ax)
    figure.canvas.draw()
    for ax in panels:
        low, high = ax.get_xlim()
        shown = [t for t in ax.get_xticklabels() if low <= t.get_position()[0] <= high]
        boxes = [text.get_window_extent() for text in shown if text.get_text()]
        assert all(a.x1 < b.x0 for a, b in itertools.pairwise(boxes))


def test_orders_have_ticks_at_whole_numbers() -> None:
    for width in (2.0, 6.4):
        ax = SINGLE.balance(3000, orders=[1]).plot(plt.subplots(figsize=(width, 3.0))[1])
        assert set(xtick_texts(ax)) <= {"0", "1", "2"}


# --- what there is to draw ----------------------------------------------------------------------


def test_without_a_moment_the_force_is_drawn() -> None:
    fitted = cp.balance_shafts(I4, [2, -2])
    for ax in (I4.balance(6000).plot(), SINGLE.waveform(6000).plot(), fitted.plot()):
        assert "force" in ax.get_ylabel() + ax.get_xlabel()
        assert any(np.nanmax(np.abs(line)) > 0.0 for line in heights(ax))
    panels = over_speed(I4).plot()
    assert "shaking force" in panels[0, 0].get_figure().get_suptitle()


DRAWN: dict[str, Callable[[cp.Engine], Any]] = {
    "spectrum": lambda e: e.balance(3000).plot(),
    "ellipses": lambda e: e.balance(3000).plot(kind="ellipses"),
    "phasors": lambda e: e.balance(3000).plot(kind="phasors"),
    "without torque": lambda e: e.balance(3000, torque=False).plot(),
    "spectrum given": lambda e: e.balance(3000, spectrum={1: 1.0, 2: 0.3}).plot(),
    "waveform": lambda e: e.waveform(3000).plot(),
    "orbit": lambda e: e.waveform(3000).plot(kind="orbit"),
    "engine": lambda e: e.plot(),
    "curves": lambda e: over_speed(e).plot(),
    "parts": lambda e: over_speed(e).plot(kind="parts"),
    "orders": lambda e: over_speed(e).plot(kind="orders"),
    "map": lambda e: cp.sweep(e, rpm=SPEEDS, rod_ratio=[0.2, 0.3]).plot(kind="map"),
    "bars": lambda e: cp.sweep([e, e], rpm=1000).plot(),
    "comparison": lambda e: cp.compare(e, e, rpm=1000).plot(),
    "counterweights": lambda e: cp.counterweights(e, planes="ends").plot(),
    "bob weight": lambda e: cp.bob_weight(e).plot(),
    "shafts": lambda e: cp.balance_shafts(e, [2, -2]).plot(),
    "tolerances": lambda e: cp.tolerances(e, rpm=3000, pin_deg=0.1, samples=100).plot(),
}


@pytest.mark.parametrize("name", DRAWN)
def test_degenerate_engines_are_drawn(name: str) -> None:
    for engine in (SINGLE, NOTHING, RADIAL):
        np.ravel(DRAWN[name](engine))[0].get_figure(root=True).canvas.draw()
        plt.close("all")


def test_a_map_of_zeros_has_no_scale() -> None:
    bank_angles = [45.0, 90.0, 135.0]
    sweep = cp.sweep(V16, rpm=SPEEDS, bank_angle_deg=bank_angles, hold="pins", orders=[3])
    panels = sweep.plot(kind="map", quantity="moment")
    figure = panels[0, 0].get_figure()
    assert not any(
        np.any(mesh.get_array())
        for ax in panels.flat
        for mesh in ax.collections
        if isinstance(mesh, QuadMesh)
    )
    assert len(figure.axes) == panels.size
    assert "zero throughout" in [text.get_text() for text in panels[0, 0].texts]


def test_bars_are_to_the_scale_of_the_engines_shown() -> None:
    large = V6.replace(cylinder=CYLINDER.replace(reciprocating_mass=4.0))
    panels = cp.sweep([*[V6] * 24, large], rpm=1000).plot(orders=[1])
    top = max(bar.get_width() for bar in panels[0, 1].patches)
    assert panels[0, 1].get_xlim()[1] == pytest.approx(1.08 * top)


def test_numbers_of_close_arrows_do_not_overlap() -> None:
    panels = cp.Engine.preset("w16").balance(5000).plot(kind="phasors")
    panels[0, 0].get_figure().canvas.draw()
    for panel in panels.flat:
        boxes = [text.get_window_extent().shrunk(0.8, 0.6) for text in panel.texts]
        assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k]), (
            panel.get_title(loc="left")
        )


def test_arrows_drawn_side_by_side_are_explained() -> None:
    figure = cp.Engine.preset("v8-crossplane").balance(5000).plot(kind="phasors")[0, 0].get_figure()
    assert "side by side" in figure.get_suptitle()


def test_curves_of_designs_are_dotted_where_pins_would_be_split_too_far() -> None:
    found = cp.design(
        6,
        layout="vee",
        cylinder=CYLINDER,
        spacing=0.1,
        rpm=5000,
        by="total.moment.peak",
        bank_angle_deg=(40, 140),
        pin_split_deg=(-30, 0),
        even_firing=True,
    )
    ax = found.plot(count=1)
    (curve,) = series(ax)
    values = np.asarray(curve.get_ydata(), float)
    assert np.isnan(values).any()
    assert np.nanmin(values) == pytest.approx(found[0].value, rel=1e-9)
    assert "needs a pin split that is not allowed" in legend_texts(ax)


def test_shares_that_interact_are_explained() -> None:
    spread = cp.tolerances(
        I4, rpm=5000, reciprocating_mass=0.002, pin_deg=0.1, samples=500, by="[1].force.backward"
    )
    words = " ".join(title_of(spread.plot(kind="shares")).split())
    interact = abs(spread.shares["interaction"].values[0]) > 5
    assert ("where tolerances interact" in words) == interact


# --- arguments and settings ---------------------------------------------------------------------


@pytest.mark.parametrize("draw", [V6.balance(3000).plot, over_speed(V6).plot, V6.plot])
def test_an_option_that_does_not_exist_is_named(draw: Callable[..., Any]) -> None:
    with pytest.raises(cp.InputError, match=r"^quantiy = 'force': "):
        draw(quantiy="force")
    assert plt.get_fignums() == []


def test_no_orders_are_rejected() -> None:
    with pytest.raises(cp.InputError, match="at least one order"):
        over_speed(V6).plot(orders=[], kind="curves")
    with pytest.raises(cp.InputError, match="at least one order"):
        V6.balance(3000).plot(orders=[], kind="phasors")


def test_pictures_in_threads_leave_settings_alone() -> None:
    before = dict(mpl.rcParams)
    seen = []

    def show() -> None:
        V6._repr_html_()
        seen.append(dict(mpl.rcParams) == before)

    threads = [threading.Thread(target=show) for _ in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [True] * 12
    assert dict(mpl.rcParams) == before
