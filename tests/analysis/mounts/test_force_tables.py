"""Do tables of forces shake a powertrain as the engine does that they are made from?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from analysis.mounts.test_mount_laws import random_case
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

GAS = cp.Cycle.example("petrol")


def fired_case(seed: int) -> cp.Powertrain:
    """A random powertrain, of which every second one has gas pressure."""
    p, _ = random_case(seed)
    assert p.engine is not None
    return p.replace(engine=p.engine.with_cycle(GAS)) if seed % 2 else p


@in_turn("seed", range(8))
def test_a_table_of_an_engine_gives_its_response_at_any_speed(seed: int) -> None:
    p = fired_case(seed)
    assert p.engine is not None
    orders = [0.5, 1, 2, 4] if p.engine.fired else [1, 2, 4]
    table = cp.force_table(p.engine, rpm=1700.0, orders=orders, reference_z=0.07 * seed)
    rpm = [600.0, 1700.0, 4100.0]
    own = p.response(rpm, orders=orders)
    alone = cp.Powertrain(table, p.body, p.mounts).response(rpm, orders=orders)
    both = cp.Powertrain(p.engine, p.body, p.mounts, forces=table).response(rpm, orders=orders)
    for name in ("wrench", "motion", "body_force", "mount_force"):
        values, found, twice = (np.asarray(getattr(r, name)) for r in (own, alone, both))
        size = np.abs(values).max(axis=tuple(range(2, values.ndim)), keepdims=True)
        # Some roundings of the largest component: the table is about another point.
        assert (np.abs(found - values) <= 1e-13 * size).all(), name
        assert (np.abs(twice - 2.0 * values) <= 2e-13 * size).all(), name
    assert alone.at((0.1, 0.2, 0.3)).grade.tolist() == own.at((0.1, 0.2, 0.3)).grade.tolist()


def test_orders_of_a_table_are_chosen_by_themselves_and_beside_the_engines() -> None:
    p, _ = random_case(1)
    forces = cp.ForceTable(900, {3.5: (1, 0, 0, 0, 0, 0)}, {7: (0, 0, 0, 0, 0, 2j)})
    assert p.replace(engine=None, forces=forces).response(1000).orders == (3.5, 7)
    both = p.replace(forces=forces).response(1000)
    assert both.orders == tuple(sorted({*p.response(1000).orders, 3.5, 7}))
    assert p.replace(forces=forces).response(1000, orders=[5, 3.5]).orders == (5, 3.5)
    assert "forces of table of forces" in both.loads_counted


def test_amplitudes_scale_with_speed_as_the_table_says() -> None:
    p, _ = random_case(3)
    rows: dict[float, tuple[complex, ...]] = {2: (1.0, 2j, -3.0, 4.0, 5.0, 6j)}
    grows, stays = cp.ForceTable(500, rows), cp.ForceTable(500, None, rows)
    at = {n: cp.Powertrain(t, p.body, p.mounts).response([250.0, 500.0, 1500.0]).wrench
          for n, t in (("grows", grows), ("stays", stays))}  # fmt: skip
    unit = np.asarray(at["stays"])[1, 0]
    arm = -np.array(p.body.cg)
    moment = np.array([4.0, 5.0, 6j]) + np.cross(arm, [1.0, 2j, -3.0])
    np.testing.assert_allclose(unit, [1.0, 2j, -3.0, *moment], rtol=1e-14)
    np.testing.assert_allclose(np.asarray(at["stays"])[:, 0], [unit] * 3, rtol=1e-15)
    expected = np.multiply.outer([0.25, 1.0, 9.0], unit)
    np.testing.assert_allclose(np.asarray(at["grows"])[:, 0], expected, rtol=1e-14)


def test_all_readings_take_a_table(tmp_path: Path) -> None:
    p, _ = random_case(2)
    assert p.engine is not None
    table = cp.force_table(p.engine, rpm=3000.0, orders=[2])
    alone = p.replace(engine=None, forces=table)
    for file in ("table.toml", "table.json"):
        alone.save(tmp_path / file)
        assert cp.Powertrain.load(tmp_path / file) == alone
        with pytest.raises(cp.InputError, match=r"^placements = none: give a cylinder or more"):
            cp.Engine.load(tmp_path / file)
    both = p.replace(forces=[table, table])
    both.save(tmp_path / "both.toml")
    assert cp.Powertrain.load(tmp_path / "both.toml") == both
    assert (alone.modes().frequency == p.modes().frequency).all()
    assert (alone.static(50.0).preload == p.static(50.0).preload).all()
    designs = [
        each.designs([900, 3000], {"0": {"stiffness": [1e5, 2e5]}}, orders=[2]).body_force
        for each in (p, alone)
    ]
    np.testing.assert_allclose(designs[1], designs[0], rtol=1e-12)
    actuator = cp.Actuator("shaker", at=(0.2, 0, 0), direction=(0, 1, 0))
    point = {"foot": ((0.2, 0.0, 0.0), (0.0, 1.0, 0.0))}
    for each in (p, alone):
        left = each.response(3000.0, orders=[2]).cancel(actuator, point)
        assert left.response.at((0.2, 0, 0)).velocity[2].peak_xyz[1] < 1e-12
    fitted = [
        cp.design_mounts(each, by="body_force[2]", rpm=[900, 3000], vary="stiffness",
                         bounds={"stiffness": (5e4, 4e5)}, starts=1, seed=1)
        for each in (p, alone)
    ]  # fmt: skip
    stiffnesses = [np.array([m.stiffness for m in f.fitted.mounts]) for f in fitted]
    np.testing.assert_allclose(stiffnesses[0], stiffnesses[1], rtol=1e-4)
    assert fitted[1].fitted.forces == (table,)


def test_what_needs_an_engine_says_so() -> None:
    p, _ = random_case(1)
    table = cp.ForceTable(900, {1: (0, 50, 0, 0, 0, 0)}, name="Two throws")
    alone = cp.Powertrain(table, p.body, p.mounts)
    assert alone.title == "Two throws"
    assert alone == cp.Powertrain(None, p.body, p.mounts, forces=[table])
    with pytest.raises(cp.InputError, match=r"^cylinder has no engine"):
        alone.with_misfire(1)
    with pytest.raises(cp.InputError, match=r"^torque has no engine"):
        alone.static("engine")
    with pytest.raises(cp.InputError, match=r"^powertrain has no engine"):
        alone.save_html("page.html")
    with pytest.raises(cp.InputError, match=r"^forces = 'Two throws': a page has the loads of an"):
        p.replace(forces=table).save_html("page.html")
    with pytest.raises(cp.InputError, match=r"^engine = None: nothing shakes the body"):
        cp.Powertrain(None, p.body, p.mounts).response(900)
    with pytest.raises(cp.InputError, match=r"^forces\[1\] = 3: give a crankpin.ForceTable"):
        cp.Powertrain(None, p.body, p.mounts, forces=[table, 3])  # type: ignore[list-item]
    below = cp.Subframe(p.body, p.mounts)
    assert alone.with_support(below).response(900).ground_force.shape == (1, 3)
