"""Are the points of an operating map those of the analyses at each speed and load?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest

CYLINDER = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
I4 = cp.Engine.preset("i4", cylinder=CYLINDER)
MAP = cp.CycleMap(
    [1000, 5000],
    [0, 1],
    [[cp.Cycle.example(kind, load=part) for part in (0, 1)] for kind in ("petrol", "diesel")],
)


def test_each_point_is_that_of_its_speed_and_load() -> None:
    speeds, loads = [1000.0, 2500.0, 5000.0], [0.0, 0.4]
    found = cp.operating_map(I4, speeds, cycle=MAP, load=loads, inertia=0.2)
    for j, rpm in enumerate(speeds):
        for k, load in enumerate(loads):
            engine = I4.with_cycle(MAP.cycle_at(rpm=rpm, load=load))
            alone = cp.bearing_loads(engine, rpm)
            for name in ("main", "crankpin", "wrist_pin", "side_thrust", "rod_force", "gas_force"):
                np.testing.assert_array_equal(found.read(name)[j, k], alone.read(name, "peak"))
            wheel = cp.flywheel(engine, rpm, inertia=0.2)
            assert found.irregularity[j, k] == wheel.irregularity
            assert found.swing_deg[j, k] == wheel.swing_deg
    table = found.table
    assert table["speed"].values == (1000, 1000, 2500, 2500, 5000, 5000)
    assert table["load"].values == (0.0, 0.4) * 3
    assert table["main"].values[3] == found.main[1, 1].max()
    assert table["irregularity"].values[5] == 100 * found.irregularity[2, 1]
    assert "cycle map" in repr(found)


def test_an_engine_has_its_own_pressure_or_none() -> None:
    fired = I4.with_cycle(cp.Cycle.example())
    found = cp.operating_map(fired, [1000, 3000])
    assert found.load is None
    assert not hasattr(found, "irregularity")
    assert found.main.shape == (2, 5)
    np.testing.assert_array_equal(found.main[1], cp.bearing_loads(fired, 3000).main.peak)
    assert "Gas: example petrol, full load." in repr(found)
    assert "Without gas pressure." in repr(cp.operating_map(I4, 3000))


def test_wrong_arguments_are_named() -> None:
    with pytest.raises(cp.InputError, match="load = 1: needs cycle"):
        cp.operating_map(I4, 3000, load=1)
    with pytest.raises(cp.InputError, match="load = None: give loads from 0 to 1"):
        cp.operating_map(I4, 3000, cycle=MAP)
    with pytest.raises(cp.InputError, match=r"rpm = 9000\.0"):
        cp.operating_map(I4, 9000, cycle=MAP, load=1)
    with pytest.raises(cp.InputError, match=r"rpm = \[\]: give a crank speed"):
        cp.operating_map(I4, [])
    with pytest.raises(cp.InputError, match=r"drive = .*: has no driving torque"):
        cp.operating_map(I4, 3000, inertia=0.2)
    with pytest.raises(cp.InputError, match="quantity = 'pin': give"):
        cp.operating_map(I4, 3000).read("pin")
    with pytest.warns(UserWarning, match=r"inertia = .* kg·cm²"):
        cp.operating_map(I4.with_cycle(cp.Cycle.example()), 3000, inertia=2e3)
