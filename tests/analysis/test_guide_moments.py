"""Are guide-force moments those of pistons on their walls, and of the engine's roll torque?"""

from __future__ import annotations

import csv
import io
import math

import crankpin as cp
import numpy as np
import pytest
from rederivation.tables import SAMPLES, Piston, guide_moments, orders_of
from rederivation.time_domain import angular_speed, crank_angles
from support import in_turn
from support.several_cranks import fired_engine, random_engine, size

RPM = 120.0
CYLINDER = cp.Cylinder(crank_radius=0.5, rod_length=1.5, reciprocating_mass=1000, bore=0.35)
WHOLES = ("h_moment", "x_bimoment", "cylinder_moment")


def marine(order: str, spacing: float = 1.0) -> cp.Engine:
    return cp.Engine.from_firing_order(CYLINDER, firing_order=order, strokes=2, spacing=spacing)


def few(seed: int) -> tuple[cp.Engine, list[Piston]]:
    """An upright two-stroke of figures drawn from few values, and the same as free bodies."""
    random = np.random.default_rng(seed)
    pistons = [
        Piston(
            mass=float(random.choice([0.0, 900.0, 1000.0])),
            radius=0.5,
            rod=float(random.choice([1.2, 1.5, 2.4])),
            bore_deg=float(random.choice([90, 60])),
            tdc_deg=float(random.choice([0, 60, 90, 120, 180, 240])),
            z=float(random.choice([0.0, 0.6, 1.2])),
        )
        for _ in range(int(random.integers(1, 7)))
    ]
    engine = cp.Engine.from_lists(
        [cp.Cylinder(one.radius, one.rod, one.mass) for one in pistons],
        tdc_deg=[one.tdc_deg for one in pistons],
        bank_deg=[one.bore_deg for one in pistons],
        z=[one.z for one in pistons],
    )
    return engine, pistons


# --- figures --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("order", "x_type"), [(3, 9.0), (4, 3.4641016), (6, 0.0)])
def test_x_type_of_six_cylinders(order: int, x_type: float) -> None:
    """Firing order 1-5-3-4-2-6: bimoment over the moment of one cylinder times the pitch."""
    found = cp.guide_moments(marine("1-5-3-4-2-6", spacing=0.6), RPM, orders=[order])
    one = found.cylinder_moment.sel(cylinder=1)[order].peak
    assert found.x_bimoment[order].peak / one / 0.6 == pytest.approx(x_type, rel=1e-7)
    assert bool(found.x_bimoment[order].peak == 0.0) is (x_type == 0.0)


def test_h_type_of_the_order_of_firing_is_that_of_all_cylinders() -> None:
    """MAN B&W project guide 17.05: of order N an engine of N cylinders has N times one's."""
    for order in ("1-4-3-2-5", "1-5-3-4-2-6"):
        engine = marine(order)
        count = len(engine)
        found = cp.guide_moments(engine.with_cycle(cp.Cycle.example("diesel", strokes=2)), RPM)
        one = found.cylinder_moment.sel(cylinder=1)
        for whole in (count, 2 * count):
            expected = count * float(one[whole].peak)
            assert found.h_moment[whole].peak == pytest.approx(expected, rel=1e-10)
            assert found.x_bimoment[whole].peak == 0.0
        for n in set(found.orders) - {count, 2 * count}:
            assert found.h_moment[n].peak == 0.0


# --- laws -----------------------------------------------------------------------------------------


@in_turn("seed", range(24))
def test_moments_are_those_of_pistons_on_their_walls(seed: int) -> None:
    engine, pistons = few(seed)
    orders = (1, 2, 3, 4, 6)
    for plane in (0.0, 0.45):
        found = cp.guide_moments(engine, RPM, orders=orders, reference_z=plane)
        expected = guide_moments(pistons, RPM, orders, plane)
        # Second derivatives of 256 samples: 256² roundings of positions.
        allowed = 1e-10 * size(engine, RPM)
        for name, phasors in zip(WHOLES, expected, strict=True):
            np.testing.assert_allclose(getattr(found, name), phasors, atol=allowed)


def test_gas_presses_pistons_on_their_walls() -> None:
    cycle = cp.Cycle.example("diesel", strokes=2)
    single = cp.Engine.inline(
        CYLINDER, throws_deg=[0], spacing=1, strokes=2, firing_order="1"
    ).with_cycle(cycle)
    piston = Piston(1000.0, 0.5, 1.5, 90.0, 0.0, 0.0)
    theta, omega = crank_angles(SAMPLES), angular_speed(RPM)
    area = math.pi * 0.35**2 / 4

    def gas_force(theta: np.typing.NDArray[np.float64]) -> np.typing.NDArray[np.float64]:
        return np.asarray((cycle.pressure_at(np.degrees(theta)) - 101325.0) * area)

    orders = (1, 2, 3)
    expected = orders_of(piston.wall_moment(theta, omega, gas_force), orders)
    found = cp.guide_moments(single, RPM, orders=orders)
    # Harmonics of a cycle are those of its own points, of which 256 samples see every third.
    np.testing.assert_allclose(found.h_moment, expected, rtol=2e-3)
    parts = [np.asarray(found.h_moment.part(part)) for part in ("gas", "inertia")]
    np.testing.assert_allclose(parts[0] + parts[1], found.h_moment, rtol=1e-12)


@in_turn("seed", range(24))
def test_h_type_is_the_roll_torque(seed: int) -> None:
    """Of an engine without shafts and unbalances aside, whatever its cranks and gas."""
    engine = random_engine(seed) if seed % 2 else fired_engine(seed)
    engine = engine.with_shafts([])
    orders = (1, 2, 3, 4) if not engine.fired else (0.5, 1, 2, 3, 4)
    found = cp.guide_moments(engine, RPM, orders=orders)
    # Counterweights make none about their own axis; those of other cranks do about the main one.
    torque = engine.with_counterweights([]).balance(RPM, orders=orders).torque
    single = np.abs(np.asarray(found.cylinder_moment)).sum()
    # Roundings of sums of a dozen terms.
    allowed = 1e-12 * (size(engine, RPM) + single)
    np.testing.assert_allclose(found.h_moment, torque, atol=allowed)


@in_turn("seed", range(24))
def test_sums_over_cylinders_and_the_lever_law(seed: int) -> None:
    engine = random_engine(seed) if seed % 2 else fired_engine(seed)
    orders = (1, 2, 3)
    here = cp.guide_moments(engine, RPM, orders=orders, length=0.5)
    single = np.asarray(here.cylinder_moment)
    # Roundings of sums of a dozen terms.
    allowed = 1e-12 * (size(engine, RPM) + np.abs(single).sum())
    np.testing.assert_allclose(here.h_moment, single.sum(axis=0), atol=allowed)
    levers = engine.z - engine.reference_z
    np.testing.assert_allclose(here.x_bimoment, levers @ single, atol=allowed)
    np.testing.assert_allclose(here.x_moment, np.asarray(here.x_bimoment) / 0.5, rtol=1e-12)
    further = cp.guide_moments(engine, RPM, orders=orders, reference_z=here.reference_z + 0.3)
    np.testing.assert_allclose(
        further.x_bimoment, here.x_bimoment - 0.3 * np.asarray(here.h_moment), atol=allowed
    )


@in_turn("seed", range(8))
def test_masses_scale_with_the_square_of_the_speed_and_gas_does_not(seed: int) -> None:
    engine = fired_engine(seed)
    found = cp.guide_moments(engine, [100.0, 300.0], orders=[0.5, 1, 2])
    alone = cp.guide_moments(engine, 300.0, orders=[0.5, 1, 2])
    for name in WHOLES:
        whole = getattr(found, name)
        # Roundings of sums of a dozen terms.
        allowed = 1e-12 * float(np.abs(found.cylinder_moment).sum())
        slow, fast = np.asarray(whole.part("inertia"))
        np.testing.assert_allclose(fast, 9.0 * slow, atol=allowed)
        slow, fast = np.asarray(whole.part("gas"))
        np.testing.assert_array_equal(slow, fast)
        np.testing.assert_allclose(np.asarray(whole)[1], getattr(alone, name), atol=allowed)


def test_a_dead_cylinder_leaves_its_own_moment() -> None:
    cycle = cp.Cycle.example("diesel", strokes=2)
    engine = marine("1-5-3-4-2-6").with_cycle(cycle)
    dead = engine.with_cycle([cycle, cycle, None, cycle, cycle, cycle])
    orders = [1, 2, 6]
    whole, left = (cp.guide_moments(one, RPM, orders=orders) for one in (engine, dead))
    third = np.asarray(whole.cylinder_moment.gas.sel(cylinder=3))
    np.testing.assert_allclose(
        np.asarray(whole.h_moment) - left.h_moment, third, atol=1e-12 * np.abs(third).max()
    )
    lever = engine.z[2] - engine.reference_z
    np.testing.assert_allclose(
        np.asarray(whole.x_bimoment) - left.x_bimoment,
        lever * third,
        atol=1e-11 * np.abs(third).max(),
    )


# --- the table ------------------------------------------------------------------------------------


def test_orders_go_beyond_the_number_of_cylinders() -> None:
    five = marine("1-4-3-2-5")
    assert cp.guide_moments(five, RPM).orders == tuple(range(1, 13))
    eight = cp.Engine.preset("v8-crossplane")
    assert cp.guide_moments(eight, RPM).orders == tuple(range(1, 17))
    bored = [one.replace(bore=0.09) for one in eight.cylinders]
    fired = eight.replace(cylinder=bored).with_cycle(cp.Cycle.example())
    assert cp.guide_moments(fired, RPM).orders == tuple(
        k / 2 if k % 2 else k // 2 for k in range(1, 33)
    )


def test_columns_of_the_table() -> None:
    found = cp.guide_moments(marine("1-5-3-4-2-6"), [100, 120], orders=[3, 6], length=4.0)
    rows = list(csv.reader(io.StringIO(found.table.to_csv())))
    assert rows[0] == [
        "speed rpm", "order", "H-type N·m", "H-type phase °", "X-type N·m²", "X-type phase °",
        "X-type over length N·m", "one cylinder N·m",
    ]  # fmt: skip
    assert [float(cell) for cell in rows[3][:2]] == [120.0, 3.0]
    assert float(rows[3][4]) == 4.0 * float(rows[3][6]) == np.abs(found.x_bimoment)[1, 0]
    assert float(rows[4][2]) == pytest.approx(6.0 * float(rows[4][7]))


def test_the_x_moment_needs_a_length() -> None:
    found = cp.guide_moments(marine("1-4-3-2-5"), RPM)
    assert not hasattr(found, "x_moment")
    with pytest.raises(cp.InputError, match="give length to crankpin"):
        found.x_moment  # noqa: B018 - the error
    assert found.x_bimoment[13].peak >= 0.0


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"length": 0}, "length"),
        ({"reference_z": math.inf}, "reference_z"),
        ({"orders": []}, "orders"),
    ],
)
def test_errors_name_the_argument(options: dict[str, object], match: str) -> None:
    with pytest.raises(cp.InputError, match=f"^{match}"):
        cp.guide_moments(marine("1-4-3-2-5"), RPM, **options)  # type: ignore[arg-type]
