"""Are pictures of makers' tables and of hammer blows drawn from the results' numbers?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.plot.balance import ZEROS
from crankpin.plot.style import SERIES
from support.pictures import LOCOMOTIVE, SHIP

I4 = cp.balance_shafts(cp.Engine.preset("i4"), [2, -2]).fitted


def drawn(ax: Any) -> dict[str, Any]:  # noqa: ANN401 - axes
    """Series on axes by their names."""
    return {line.get_label(): line for line in ax.lines if line.get_gid() == SERIES}


def peaks(line: Any) -> Any:  # noqa: ANN401 - a line of stems
    return np.asarray(line.get_ydata())[1::3]


def test_stems_of_a_foundation_table() -> None:
    table = cp.foundation_table(I4, 3000, orders=[1, 2, 4])
    force, couple = table.plot().ravel()
    states = {"": "with", ", without shafts": "without"}
    for ax, word in ((force, "force"), (couple, "couple")):
        stems = drawn(ax)
        assert len(stems) == 4
        for way in ("horizontal", "vertical"):
            for behind, state in states.items():
                expected = np.abs(getattr(table, f"{way}_{word}").sel(compensators=state))
                np.testing.assert_array_equal(peaks(stems[f"{way}{behind}"]), expected)
    assert any(line.get_gid() == ZEROS for line in couple.lines)
    one = table.plot(quantity="couple")
    assert one.shape == (1, 1)
    with pytest.raises(cp.InputError, match="quantity"):
        table.plot(quantity="moment")


def test_curves_of_a_foundation_table_over_speed() -> None:
    speeds = [1000, 2000, 3000]
    table = cp.foundation_table(I4.with_shafts([]), speeds, orders=[1, 2, 4])
    force, couple = table.plot(label="I4").ravel()
    curves = drawn(force)
    assert list(curves) == ["I4, order 2, vertical", "I4, order 4, vertical"]
    for order in (2, 4):
        line = curves[f"I4, order {order}, vertical"]
        expected = np.ravel(np.abs(table.vertical_force[order]))
        np.testing.assert_array_equal(line.get_ydata(), expected)
        assert line.get_xdata().tolist() == speeds
    assert drawn(couple) == {}


def test_guide_moments_and_their_parts() -> None:
    moments = cp.guide_moments(SHIP, 210, orders=[1, 2, 3, 6])
    panels = moments.plot().ravel()
    for ax, name in zip(panels, ("h_moment", "x_bimoment"), strict=True):
        stems = drawn(ax)
        assert list(stems) == ["sum", "masses", "gas"]
        whole = getattr(moments, name)
        np.testing.assert_array_equal(peaks(stems["sum"]), np.abs(whole))
        np.testing.assert_array_equal(peaks(stems["gas"]), np.abs(whole.gas))
        np.testing.assert_array_equal(peaks(stems["masses"]), np.abs(whole.inertia))
    (alone,) = cp.guide_moments(SHIP.with_cycle(None), 210).plot(quantity="x_bimoment").ravel()
    assert len(drawn(alone)) == 1


def test_hammer_blow_over_the_turn() -> None:
    forces = LOCOMOTIVE.forces(speed_kmh=90)
    ax = forces.plot()
    curves = drawn(ax)
    assert list(curves) == list(LOCOMOTIVE.wheels)
    for wheel, line in curves.items():
        np.testing.assert_array_equal(line.get_ydata(), forces.hammer_blow.sel(wheel=wheel))
    (load,) = (line for line in ax.lines if line.get_gid() == "crankpin load")
    assert set(load.get_ydata()) == {-45e3}
    for name in ("tractive_variation", "swaying_couple"):
        ((_, line),) = drawn(forces.plot(quantity=name, label="here")).items()
        np.testing.assert_array_equal(line.get_ydata(), getattr(forces, name))
        assert line.get_label() == "here"
