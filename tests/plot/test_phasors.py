"""Are polygons of phasors made of the cylinders' own balances, and closed by the balance?"""

from __future__ import annotations

import itertools
import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.contributions import contributions
from crankpin.plot.phasors import SUM
from matplotlib import pyplot as plt
from matplotlib.patches import FancyArrowPatch
from support import in_turn
from support.engines import I4, V6

if TYPE_CHECKING:
    from matplotlib.axes import Axes

V8 = cp.Engine.preset("v8-crossplane")


def arrows(ax: Axes) -> tuple[list[tuple[complex, complex]], list[tuple[complex, complex]]]:
    """Start and end of the arrows of parts, and of the sum."""
    found: tuple[list[Any], list[Any]] = [], []
    for patch in ax.patches:
        assert isinstance(patch, FancyArrowPatch)
        ends = tuple(complex(*end) for end in patch._posA_posB)  # type: ignore[attr-defined]
        found[patch.get_linewidth() == SUM].append(ends)
    return found


def texts(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts]


@pytest.mark.slow
@pytest.mark.parametrize("engine", [V8, V6, cp.Engine.preset("vr6")])
@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_arrows_are_head_to_tail_and_end_at_the_sum(engine: cp.Engine, quantity: str) -> None:
    balance = engine.balance(5000, orders=[1, 2, 3])
    axes = balance.plot(kind="phasors", quantity=quantity)
    assert axes.shape == (2, 3)
    vector = getattr(balance, quantity)
    parts = contributions(balance, quantity)
    for row, whole in enumerate((vector.forward, vector.backward)):
        for column, ax in enumerate(axes[row]):
            own = [part.phasors[row, column] for part in parts]
            largest = max(map(abs, own))
            chain, total = arrows(ax)
            if not largest:
                assert texts(ax) == ["zero throughout"]
                continue
            assert abs(chain[0][0]) < 1e-6 * largest
            for (_, end), (start, _) in itertools.pairwise(chain):
                assert abs(start - end) < 1e-6 * largest  # phasors of nothing are left out
            lengths = [end - start for start, end in chain]
            expected = [phasor for phasor in own if abs(phasor) > 1e-9 * largest]
            np.testing.assert_allclose(lengths, expected, atol=1e-12 * largest * len(own))
            assert chain[-1][1] == pytest.approx(whole[column], abs=1e-12 * largest * len(own))
            if whole[column]:
                assert total == [(0j, whole[column])]
            else:
                assert total == []  # the polygon closes


def test_a_v12_in_a_column_is_not_crowded() -> None:
    """Arrows stay in their panels, and names that would cover others are left out."""
    with plt.rc_context({"figure.figsize": (3.5, 2.625), "font.size": 8}):
        axes = cp.Engine.preset("v12-60").balance(3000).plot(kind="phasors", quantity="moment")
        figure = axes[0, 0].get_figure(root=True)
        figure.canvas.draw()
        for ax in axes.flat:
            panel = ax.get_window_extent()
            for patch in ax.patches:
                box = patch.get_window_extent()
                assert panel.x0 <= box.x0
                assert panel.y0 <= box.y0
                assert box.x1 <= panel.x1
                assert box.y1 <= panel.y1
            shown = [text for text in ax.texts if text.get_visible()]
            boxes = [text.get_window_extent() for text in shown]
            assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))
            assert 5 <= len(shown) <= 12
            assert not any("," in name for name in texts(ax))
    assert "not all named" in axes[0, 0].get_figure(root=True).get_suptitle()


def test_rounding_does_not_choose_the_names() -> None:
    """Of arrows that are equally long the first are named, however their lengths are rounded."""
    names = []
    with plt.rc_context({"figure.figsize": (3.5, 2.625), "font.size": 8}):
        for changed in ([], [0, 2, 4, 6], [1, 3, 5, 7], [4, 5], [2, 3]):
            engine = V8.replace(
                z=[np.nextafter(z, 1) if k in changed else z for k, z in enumerate(V8.z)]
            )
            axes = engine.balance(5000).plot(kind="phasors", quantity="moment")
            assert "not all named" in axes[0, 0].get_figure(root=True).get_suptitle()
            names.append([texts(ax) for ax in axes.flat])
    assert names[1:] == names[:-1]


def test_arrows_are_named_by_cylinder() -> None:
    (forward,), (backward,) = V8.balance(6000).plot(kind="phasors", orders=[2])
    for ax in (forward, backward):
        assert texts(ax) == [str(k) for k in range(1, 9)]
        assert ax.get_title(loc="left").endswith("\n0")
    assert forward.get_title(loc="left").startswith("order 2 forward")
    assert backward.get_title(loc="left").startswith("order 2 backward")
    assert forward.get_ylabel() == "about y, N·m"


def test_counterweights_and_shafts_are_further_arrows() -> None:
    engine = I4.replace(
        counterweights=[cp.Unbalance(0.01, 0.1, 180, pin=1)],
        shafts=[cp.Shaft(-1, [cp.Unbalance(0.02, 0.0)], x=0.1)],
    )
    balance = engine.balance(3000, orders=[1])
    ((forward,), (backward,)) = balance.plot(kind="phasors", quantity="force")
    assert texts(forward) == ["1", "2", "3", "4", "W1"]
    assert texts(backward) == ["1", "2", "3", "4", "S1"]
    assert arrows(backward)[1][0][1] == pytest.approx(balance.force.backward[0])
    (legend,) = forward.get_figure(root=True).legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["bank 1", "counterweights", "balance shafts", "sum"]


def test_a_torque_has_one_row() -> None:
    balance = I4.balance(3000, orders=[2, 4])
    axes = balance.plot(kind="phasors", quantity="torque")
    assert axes.shape == (1, 2)
    assert arrows(axes[0, 0])[1][0][1] == pytest.approx(balance.torque.phasor[0])
    assert axes[0, 0].get_xlabel() == "real part, N·m"


def test_orders_are_those_given_or_the_first_two() -> None:
    def orders(axes: Any) -> list[str]:  # noqa: ANN401 - axes
        return [ax.get_title(loc="left").split()[1] for ax in axes[0]]

    assert orders(V6.balance(5000).plot(kind="phasors")) == ["1", "2"]
    assert orders(V6.balance(5000, orders=[3]).plot(kind="phasors")) == ["3"]
    assert orders(V6.balance(5000, orders=[3]).plot(kind="phasors", orders=[1, 6])) == ["1", "6"]


def test_arrows_that_would_cover_each_other_are_moved_aside() -> None:
    """The four of an inline-4 lie on one line: two lanes show them all."""
    ax = I4.balance(3000).plot(kind="phasors", quantity="force", orders=[1])[0, 0]
    ax.get_figure(root=True).canvas.draw()
    places = [patch.get_transform().transform((0.0, 0.0)) for patch in ax.patches]
    first, second, third, fourth = (place[0] for place in places)
    assert first == third
    assert second == fourth
    assert abs(second - first) > 5.0


def test_each_name_is_measured_once_and_no_arrow_by_the_layout(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    measured = []

    def measure(ax: object, text: str, font: object) -> float:
        measured.append(text)
        return 5.0 * len(text)

    monkeypatch.setattr("crankpin.plot.phasors.points_of", measure)
    n = 60
    long = cp.Engine.from_lists(
        I4.cylinders[0], bank_deg=[90] * n, tdc_deg=[7 * k for k in range(n)], z=range(n)
    )
    panels = long.balance(3000).plot(kind="phasors", quantity="force", orders=[1])
    assert len(measured) == n + panels.size  # of panels the comma between names
    arrows = [patch for panel in panels.flat for patch in panel.patches]
    assert len(arrows) > panels.size * n / 2
    assert not any(arrow.get_in_layout() for arrow in arrows)


def test_they_need_a_figure() -> None:
    _, ax = plt.subplots()
    with pytest.raises(
        cp.InputError, match=r'ax = .*: kind="phasors" has several panels; give figure='
    ):
        I4.balance(3000).plot(ax, kind="phasors")
    figure = plt.figure()
    parts: Any = figure.subfigures(1, 2)
    part = parts[0]
    axes = I4.balance(3000).plot(figure=part, kind="phasors")
    assert {panel.get_figure(root=False) for panel in axes.flat} == {part}
    with pytest.raises(cp.InputError, match="quantity = 'power'"):
        I4.balance(3000).plot(kind="phasors", quantity="power")


def test_style_is_passed_on_to_the_arrows() -> None:
    axes = I4.balance(3000).plot(kind="phasors", quantity="force", linewidth=3.0)
    widths = {patch.get_linewidth() for patch in axes[0, 0].patches}
    assert widths == {3.0}


@in_turn("seed", range(3))
def test_names_of_many_arrows_do_not_cover_each_other(seed: int) -> None:
    random = np.random.default_rng(seed)
    engine = cp.Engine.preset(str(random.choice(["v12-60", "v16-45", "w16", "v10-90"])))
    with plt.rc_context({"figure.figsize": (3.5, 2.7), "font.size": 8}):
        panels = engine.balance(float(random.uniform(2000, 8000))).plot(kind="phasors")
        figure = panels[0, 0].figure
        figure.draw_without_rendering()
        for panel in panels.flat:
            boxes = [text.get_window_extent() for text in panel.texts if text.get_visible()]
            assert boxes
            for k, box in enumerate(boxes):
                assert not any(box.overlaps(other) for other in boxes[:k])
        assert pickle.loads(pickle.dumps(figure))  # noqa: S301 - of this process
