"""Are cycles between those of a map the weighted sums of their pressures?"""

from __future__ import annotations

from typing import Any

import crankpin as cp
import numpy as np
import pytest

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
LOADS = [0.0, 0.4, 1.0]


def cycle(rpm: float, load: float) -> cp.Cycle:
    start, heat = -12.0 - rpm / 500, 200 + 900 * load
    return cp.Cycle.wiebe(CYLINDER, compression_ratio=10, heat=heat, start_deg=start)


def table(phase: float) -> cp.Cycle:
    theta = np.arange(-360.0 + phase, 360.0, 2.0)
    return cp.Cycle(theta, 1e5 + 2e6 * np.exp(-(((theta - 10.0) / 40.0) ** 2)))


MAP = cp.CycleMap([1000, 4000], LOADS, [[cycle(n, load) for load in LOADS] for n in (1000, 4000)])


def test_cycles_of_the_map_come_back_as_they_are() -> None:
    assert MAP.cycle_at(rpm=4000, load=0.4) == MAP.cycles[1][1]
    assert MAP.cycle_at(rpm=1000, load=0) == MAP.cycles[0][0]
    assert MAP.cycle_at(rpm=1000, load=1.0) == MAP.cycles[0][2]


def test_pressure_is_bilinear_between_cycles() -> None:
    theta = np.linspace(-350.3, 360.0, 711)
    found = MAP.cycle_at(rpm=1750, load=0.55).pressure_at(theta)
    near = [[MAP.cycles[k][j].pressure_at(theta) for j in (1, 2)] for k in (0, 1)]
    expected = 0.75 * (0.75 * near[0][0] + 0.25 * near[0][1])
    expected += 0.25 * (0.75 * near[1][0] + 0.25 * near[1][1])
    # Polynomials through sums of polynomials: roundings.
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_tables_of_different_grids_and_computed_cycles_mix() -> None:
    mixed = cp.CycleMap([2000], [0, 1, 2], [[table(0.0), table(0.7), cp.Cycle.example()]])
    theta = np.linspace(-340.0, 340.0, 69)
    halves = [
        0.5 * (a.pressure_at(theta) + b.pressure_at(theta))
        for a, b in zip(mixed.cycles[0][:-1], mixed.cycles[0][1:], strict=True)
    ]
    for load, expected in zip((0.5, 1.5), halves, strict=True):
        between = mixed.cycle_at(rpm=2000, load=load)
        np.testing.assert_allclose(between.pressure_at(theta), expected, rtol=1e-12)


def test_harmonics_of_many_points_are_those_of_their_cycles() -> None:
    rpm, load = np.array([[1000.0], [2300.0], [4000.0]]), np.array([0.0, 0.3, 0.4, 0.9, 1.0])
    orders = [0.5, 2, 6.5]
    found = MAP.torque_harmonics(CYLINDER, orders, rpm=rpm, load=load)
    assert found.shape == (3, 5, 3)
    for k, speed in enumerate(rpm[:, 0]):
        for j, each in enumerate(load):
            one = MAP.cycle_at(rpm=speed, load=each).torque_harmonics(CYLINDER, orders)
            np.testing.assert_allclose(found[k, j], one, rtol=1e-11)


def test_maps_are_values_with_a_table() -> None:
    assert MAP.replace(load=LOADS) == MAP
    assert hash(MAP) == hash(MAP.replace(load=LOADS))
    assert MAP.table["speed"].values == (1000, 1000, 1000, 4000, 4000, 4000)
    assert MAP.table["peak pressure"].values[5] == cycle(4000, 1.0).pressure.max()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rpm": [4000, 1000]}, "rpm = .*: give ascending numbers"),
        ({"load": []}, "load = .*: give ascending numbers"),
        ({"rpm": [1000]}, "cycles = .*: for 1 speeds and 3 loads give a list for each speed"),
        ({"cycles": [[1, 2, 3]] * 2}, "cycles = 1: is not a Cycle"),
        ({"cycles": 3}, "cycles = 3: give a list for each speed"),
    ],
)
def test_maps_that_are_none_are_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        MAP.replace(**changes)


def test_nothing_is_extrapolated() -> None:
    with pytest.raises(cp.InputError, match=r"rpm = 900\.0: the map has 1000 to 4000"):
        MAP.cycle_at(rpm=900, load=0.5)
    with pytest.raises(cp.InputError, match="load = NaN: the map has 0 to 1"):
        MAP.cycle_at(rpm=1000, load=np.nan)
    with pytest.raises(cp.InputError, match="shapes that broadcast"):
        MAP.torque_harmonics(CYLINDER, 1, rpm=[1000, 2000], load=LOADS)
    two = cp.Cycle.motored(CYLINDER, compression_ratio=8, strokes=2)
    with pytest.raises(cp.InputError, match="2 and 4 strokes"):
        cp.CycleMap([1, 2], [0], [[two], [cp.Cycle.example()]])
