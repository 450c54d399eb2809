"""Do pictures of operating maps and of torsional excitation show the numbers of their tables?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support.quantities import LOADS
from matplotlib import pyplot as plt
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from support import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
BARE = cp.Engine.preset("i4", cylinder=CYLINDER)
FIRED = BARE.with_cycle(cp.Cycle.example())
PART = [0.0, 0.5, 1.0]
GAS = cp.CycleMap([1000, 6000], PART, [[cp.Cycle.example(load=each) for each in PART]] * 2)
SPEEDS = [1000.0, 5000.0, 3000.0]
OVER_BOTH = cp.operating_map(BARE, SPEEDS, cycle=GAS, load=PART, inertia=0.5)


def mesh_of(ax: Axes) -> QuadMesh:
    (mesh,) = (each for each in ax.collections if isinstance(each, QuadMesh))
    return mesh


def label_of_bar(ax: Axes) -> str:
    bar = mesh_of(ax).colorbar
    assert bar is not None
    return bar.ax.get_ylabel().replace("\n", " ")


@pytest.mark.parametrize("quantity", [*LOADS, "irregularity", "swing_deg"])
def test_a_map_has_the_numbers_of_the_table(quantity: Any) -> None:  # noqa: ANN401 - a literal
    ax = OVER_BOTH.plot(quantity=quantity)
    mesh = mesh_of(ax)
    column = quantity.removesuffix("_deg").replace("_", " ")
    table = OVER_BOTH.table
    names = [each.name for each in table.columns]
    values = np.array(table.columns[names.index(column)].values).reshape(3, 3)
    drawn = np.asarray(mesh.get_array())
    np.testing.assert_array_equal(drawn, values[np.argsort(SPEEDS)].T)
    unit = table.columns[names.index(column)].unit
    assert label_of_bar(ax).endswith(f", {unit}")
    assert mesh.get_cmap().name == "cividis"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("speed, rpm", "load")
    assert "gas: cycle map" in ax.get_title(loc="left").replace("\n", " ")


def test_one_load_or_one_speed_is_a_curve() -> None:
    over_speed = cp.operating_map(BARE, SPEEDS)
    ax = over_speed.plot(quantity="crankpin", label="bare")
    (line,) = ax.lines
    np.testing.assert_array_equal(line.get_xdata(), np.sort(SPEEDS))
    np.testing.assert_array_equal(
        line.get_ydata(), over_speed.crankpin.max(axis=-1)[np.argsort(SPEEDS)]
    )
    cp.operating_map(BARE, SPEEDS, cycle=GAS, load=[1.0]).plot(ax, label="full load")
    legend = ax.get_legend()
    assert legend is not None
    assert [each.get_text() for each in legend.get_texts()] == ["bare", "full load"]
    over_load = cp.operating_map(BARE, 3000, cycle=GAS, load=PART)
    ax = over_load.plot()
    assert (ax.get_xlabel(), ax.get_title(loc="left").count("3000 rpm")) == ("load", 1)
    (dot,) = cp.operating_map(BARE, 3000).plot().lines
    assert dot.get_marker() == "o"


def test_a_colour_map_is_the_user_s() -> None:
    with plt.rc_context({"image.cmap": "magma"}):
        assert mesh_of(OVER_BOTH.plot()).get_cmap().name == "magma"
        swept = cp.sweep(BARE, rpm=[1000, 2000], orders=[1, 2]).plot(kind="orders")
    assert {mesh_of(each).get_cmap().name for each in swept.flat} == {"magma"}
    assert mesh_of(OVER_BOTH.plot(cmap="gray")).get_cmap().name == "gray"


def test_maps_are_shown_in_units_that_are_set() -> None:
    with cp.units("lbf"):
        ax = OVER_BOTH.plot()
    assert label_of_bar(ax) == "largest main bearing load, lbf"
    mesh = mesh_of(ax)
    assert mesh.get_array().max() == OVER_BOTH.main.max()  # type: ignore[union-attr]
    assert mesh.colorbar is not None
    mesh.colorbar.ax.figure.canvas.draw()
    texts = [
        float(each.get_text().replace("\N{NO-BREAK SPACE}", ""))
        for each in mesh.colorbar.ax.get_yticklabels()
        if each.get_text()
    ]
    assert max(texts) <= OVER_BOTH.main.max() / (0.45359237 * 9.80665) * 1.3
    assert max(texts) < 0.5 * OVER_BOTH.main.max()


@in_turn("seed", range(3))
def test_a_spectrum_has_the_amplitudes_of_gas_masses_and_sum(seed: int) -> None:
    random = np.random.default_rng(seed)
    cylinder = int(random.integers(1, 5))
    excitation = cp.torsional_excitation(FIRED, float(random.uniform(800, 6000)))
    ax = excitation.plot(cylinder=cylinder)
    drawn = {
        str(line.get_label()): np.asarray(line.get_ydata())[1::3]
        for line in ax.lines
        if line.get_gid() == "crankpin series"
    }
    for name, values in (
        ("gas", excitation.crank_torque.gas), ("masses", excitation.crank_torque.inertia),
        ("sum", excitation.crank_torque),
    ):  # fmt: skip
        np.testing.assert_array_equal(drawn.pop(name), abs(values.sel(cylinder=cylinder)))
    assert not drawn
    title = ax.get_title(loc="left").replace("\n", " ")
    assert f"torque on the crank, cylinder {cylinder}" in title


def test_without_gas_there_are_the_masses_alone() -> None:
    excitation = cp.torsional_excitation(BARE, rpm=3000)
    named = [line for line in excitation.plot().lines if line.get_gid() == "crankpin series"]
    assert [line.get_label() for line in named] == ["masses"]
    (line,) = (
        each
        for each in excitation.plot(part="inertia", label="bare", log=True).lines
        if each.get_gid() == "crankpin series"
    )
    assert line.get_label() == "bare"
    assert line.axes is not None
    assert line.axes.get_yscale() == "log"


@pytest.mark.parametrize("part", [None, "gas", "inertia"])
def test_over_speed_there_is_a_map_of_orders(part: Any) -> None:  # noqa: ANN401 - a literal
    excitation = cp.torsional_excitation(FIRED, SPEEDS, orders=[0.5, 2, 3.5])
    ax = excitation.plot(part=part, cylinder=2)
    mesh = mesh_of(ax)
    cells: Any = np.ma.filled(np.ma.asarray(mesh.get_array()), np.nan)
    torque = excitation.crank_torque
    of = {None: torque, "gas": torque.gas}
    expected = abs(of.get(part, torque.inertia)[:, 1])[np.argsort(SPEEDS)].T
    for row, order in enumerate((0.5, 2, 3.5)):
        found = np.nan_to_num(cells[round(2 * order) - 1])
        np.testing.assert_array_equal(found, expected[row])
    assert isinstance(mesh.norm, LogNorm)
    assert mesh.get_cmap().name == "cividis"
    assert not isinstance(mesh_of(excitation.plot(log=False)).norm, LogNorm)
    assert label_of_bar(ax) == "amplitude, N·m"


def test_what_is_not_there_is_rejected() -> None:
    excitation = cp.torsional_excitation(FIRED, rpm=3000)
    bare = cp.operating_map(BARE, SPEEDS)
    rejected: list[tuple[Callable[[], object], str]] = [
        (lambda: excitation.plot(cylinder=5), "cylinder = 5: give 1 to 4"),
        (lambda: excitation.plot(cylinder=0), "cylinder = 0"),
        (lambda: excitation.plot(part="oil"), "part = 'oil': give"),
        (lambda: bare.plot(quantity="power"), "quantity = 'power': give"),
        (
            lambda: bare.plot(quantity="irregularity"),
            "quantity = 'irregularity': needs the inertia",
        ),
    ]
    for draw, message in rejected:
        with pytest.raises(cp.InputError, match=message):
            draw()
    assert plt.get_fignums() == []
