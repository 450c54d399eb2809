"""Are the forces and couples of foundation tables those of free bodies, and of the balance?"""

from __future__ import annotations

import csv
import io
import math

import crankpin as cp
import numpy as np
import pytest
from rederivation.tables import Piston, foundation
from support import in_turn
from support.several_cranks import fired_engine, random_engine, size

RPM = 600.0
NAMES = ("horizontal_force", "vertical_force", "horizontal_couple", "vertical_couple")
VERTICALS = (90, 0, 180, -90, 30, "360/7")


def few(seed: int) -> tuple[cp.Engine, list[Piston]]:
    """An engine of figures drawn from few values, and the same as free bodies."""
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 6))
    pistons = [
        Piston(
            mass=float(random.choice([0.0, 180.0, 200.0])),
            radius=float(random.choice([0.1, 0.125])),
            rod=float(random.choice([0.4, 0.625, math.inf])),
            bore_deg=float(random.choice([0, 90, 180])),
            tdc_deg=float(random.choice([0, 90, 120, 180, 240])),
            z=float(random.choice([0.0, 0.3, 0.6])),
            rotating=float(random.choice([0.0, 50.0])),
        )
        for _ in range(count)
    ]
    return engine_of(pistons), pistons


def engine_of(pistons: list[Piston]) -> cp.Engine:
    return cp.Engine.from_lists(
        [cp.Cylinder(one.radius, one.rod, one.mass) for one in pistons],
        tdc_deg=[one.tdc_deg for one in pistons],
        bank_deg=[one.bore_deg for one in pistons],
        z=[one.z for one in pistons],
        rotating_mass=[one.rotating for one in pistons],
    )


# --- figures --------------------------------------------------------------------------------------


def test_unlike_pistons_on_opposed_throws_make_a_force() -> None:
    """Two throws of 200 and 180 kg, r 125 mm, λ = 0.2, 600 rpm, 0.32 m between: 9.87 kN."""
    one = cp.Cylinder(crank_radius=0.125, rod_length=0.625, reciprocating_mass=200)
    compressor = cp.Engine.from_lists(
        [one, one.replace(reciprocating_mass=180)], tdc_deg=[0, 0], bank_deg=[0, 180], z=[0, 0.32]
    )
    table = cp.foundation_table(compressor, rpm=600)
    assert table.horizontal_force[1].peak == pytest.approx(9869.6044, rel=1e-8)
    assert table.horizontal_couple[1].peak == pytest.approx(30003.597, rel=1e-7)
    assert not table.vertical_force.peak.any()
    assert not table.vertical_couple.peak.any()


def test_a_radial_compressor_of_three_cylinders() -> None:
    """Khurmi, Theory of Machines, example 22.14: 1.5 kg, r 50 mm, l 150 mm, 3000 rpm.

    Of order 1 11.1 kN; of order 2 3.70 kN with r/l in place of a₂.
    """
    cylinder = cp.Cylinder(crank_radius=0.05, rod_length=0.15, reciprocating_mass=1.5)
    radial = cp.Engine.radial(cylinder, cylinders=3, spacing=0.1)
    table = cp.foundation_table(radial, rpm=3000)
    for way in ("horizontal", "vertical"):
        first, second = np.ravel(np.abs(getattr(table, f"{way}_force")))
        assert first == pytest.approx(11103.305, rel=1e-7)
        assert second == pytest.approx(3809.6392, rel=1e-7)
    a_2 = abs(cylinder.harmonics([2])[0])
    assert second / a_2 * 0.05 / 0.15 == pytest.approx(3701.1017, rel=1e-7)


@pytest.mark.parametrize(
    ("order", "first", "second"),
    [("1-4-3-2-5", 0.44902798, 4.9797966), ("1-5-3-4-2-6", 0, 3.4641016)],
)
def test_couples_of_marine_two_strokes(order: str, first: float, second: float) -> None:
    """Vertical couples of 5 and 6 cylinders over the force of one times the pitch."""
    cylinder = cp.Cylinder(crank_radius=0.5, rod_length=1.5, reciprocating_mass=1000)
    engine = cp.Engine.from_firing_order(cylinder, firing_order=order, strokes=2, spacing=1.0)
    # The throw of the k-th cylinder to fire is at −k·360°/N.
    numbers = [int(number) for number in order.split("-")]
    step = 360 / len(numbers)
    throws = [float(engine.throws_deg[number - 1]) for number in numbers]
    assert throws == [-k * step % 360 for k in range(len(numbers))]
    assert engine.fires_evenly
    table = cp.foundation_table(engine, rpm=120)
    unit = cylinder.reciprocating_mass * cylinder.crank_radius * (4 * math.pi) ** 2
    a_2 = abs(cylinder.harmonics([2])[0])
    found = np.ravel(np.abs(table.vertical_couple)) / [unit, unit * a_2]
    np.testing.assert_allclose(found, [first, second], rtol=1e-7)
    if not first:
        assert table.vertical_couple[1].peak == 0.0


def test_a_fan_of_three_bores_on_one_pin() -> None:
    """Bores at 18, 90 and 162°: order 1 turns forward 3/2 F₁, and backward cos 72° of it."""
    cylinder = cp.Cylinder(0.05, 0.15, 1.0)
    fan = cp.Engine.from_lists(cylinder, pin_deg=[90] * 3, bank_deg=[18, 90, 162], z=[0.0] * 3)
    one, a_2 = 0.05 * (math.pi * 100) ** 2, abs(cylinder.harmonics([2])[0])
    force = fan.balance(3000, orders=(1, 2)).force
    parts = np.abs([force.forward, force.backward]) / [one, one * a_2]
    np.testing.assert_allclose(parts, [[1.5, 0.80901699], [0.30901699, 0.30901699]], rtol=1e-7)
    # The ellipse's axes lie horizontally and upright, so the table has their lengths.
    table = cp.foundation_table(fan, 3000)
    for way, sign in (("horizontal", 1), ("vertical", -1)):
        found = np.abs(getattr(table, f"{way}_force"))[0] / [one, one * a_2]
        np.testing.assert_allclose(found, np.abs(parts[0] + sign * parts[1]), rtol=1e-12)


# --- laws -----------------------------------------------------------------------------------------


@in_turn("seed", range(24))
def test_tables_are_sums_of_free_bodies(seed: int) -> None:
    engine, pistons = few(seed)
    plane = float(np.random.default_rng(seed).choice([0.0, 0.3, 0.45]))
    for vertical in VERTICALS:
        degrees = 360 / 7 if isinstance(vertical, str) else vertical
        expected = foundation(pistons, RPM, (1, 2, 4), degrees, plane)
        found = cp.foundation_table(
            engine, RPM, orders=(1, 2, 4), vertical_deg=vertical, reference_z=plane
        )
        for name in NAMES:
            # Second derivatives of 256 samples: 256² roundings of positions.
            allowed = 1e-10 * size(engine, RPM)
            np.testing.assert_allclose(
                np.asarray(getattr(found, name))[0], expected[name], atol=allowed
            )


@in_turn("seed", range(24))
def test_the_table_is_the_balance(seed: int) -> None:
    engine = random_engine(seed) if seed % 2 else fired_engine(seed)
    found = cp.foundation_table(engine, RPM, orders=(1, 2, 4))
    state = "with" if engine.shafts else "without"
    balance = engine.balance(RPM, orders=(1, 2, 4))
    for name, phasors in {
        "horizontal_force": balance.force.x,
        "vertical_force": balance.force.y,
        "horizontal_couple": balance.moment.y,
        "vertical_couple": -balance.moment.x,
    }.items():
        own = getattr(found, name).sel(compensators=state)
        np.testing.assert_allclose(own, phasors, rtol=1e-12, atol=1e-13 * size(engine, RPM))
    assert ("gas" in found.loads_counted) is False
    bare = engine.with_shafts([])
    again = cp.foundation_table(bare, RPM, orders=(1, 2, 4))
    for name in NAMES:
        without = getattr(found, name).sel(compensators="without")
        np.testing.assert_array_equal(without, np.asarray(getattr(again, name))[0])


@in_turn("seed", range(12))
def test_forces_scale_with_the_square_of_the_speed(seed: int) -> None:
    engine = random_engine(seed)
    found = cp.foundation_table(engine, [200.0, 600.0], orders=(1, 3))
    for name in NAMES:
        slow, fast = np.asarray(getattr(found, name))
        np.testing.assert_allclose(fast, 9.0 * slow, rtol=1e-12, atol=1e-12 * size(engine, 600.0))
        alone = getattr(cp.foundation_table(engine, 600.0, orders=(1, 3)), name)
        np.testing.assert_array_equal(np.asarray(alone), fast)


@in_turn("seed", range(12))
def test_couples_obey_the_lever_law(seed: int) -> None:
    engine = random_engine(seed)
    here = cp.foundation_table(engine, RPM, reference_z=0.1)
    further = cp.foundation_table(engine, RPM, reference_z=0.4)
    for way in ("horizontal", "vertical"):
        expected = np.asarray(getattr(here, f"{way}_couple"))
        expected = expected - 0.3 * np.asarray(getattr(here, f"{way}_force"))
        np.testing.assert_allclose(
            getattr(further, f"{way}_couple"), expected, atol=1e-12 * size(engine, RPM)
        )


def test_an_engine_that_lies() -> None:
    """Horizontal and vertical change places; what was to the right is then below."""
    upright = random_engine(3)
    stands = cp.foundation_table(upright, RPM)
    lies = cp.foundation_table(upright, RPM, vertical_deg=180)
    for word in ("force", "couple"):
        across, up = (
            np.asarray(getattr(stands, f"{way}_{word}")) for way in ("horizontal", "vertical")
        )
        np.testing.assert_array_equal(getattr(lies, f"vertical_{word}"), -across)
        np.testing.assert_array_equal(getattr(lies, f"horizontal_{word}"), up)


def test_zeros_are_exact_along_slanting_axes() -> None:
    single = cp.Engine.from_lists(
        cp.Cylinder(0.05, 0.15, 1.0), tdc_deg=[0], bank_deg=["360/7"], z=[0]
    )
    table = cp.foundation_table(single, 3000, vertical_deg="360/7")
    assert table.horizontal_force.peak.tolist() == [[0.0, 0.0]]
    assert (np.asarray(table.vertical_force.peak) > 0).all()


def test_one_cylinder_twice_is_twice_the_force() -> None:
    engine, _ = few(7)
    doubled = cp.Engine.from_lists(
        [*engine.cylinders] * 2,
        tdc_deg=[*engine.tdc_deg] * 2,
        bank_deg=[*engine.bank_deg] * 2,
        z=[*engine.z] * 2,
        rotating_mass=[*engine.rotating_mass] * 2,
    )
    one, two = (cp.foundation_table(each, RPM) for each in (engine, doubled))
    for name in NAMES:
        np.testing.assert_allclose(
            getattr(two, name), 2.0 * np.asarray(getattr(one, name)), rtol=1e-12, atol=1e-6
        )


# --- the table ------------------------------------------------------------------------------------


def test_columns_with_and_without_compensators() -> None:
    i4 = cp.Engine.preset("i4")
    fitted = cp.balance_shafts(i4, [2, -2]).fitted
    table = cp.foundation_table(fitted, [1500, 3000], orders=[2])
    rows = list(csv.reader(io.StringIO(table.to_csv())))
    assert rows[0] == [
        "speed rpm", "order", "direction", "force N", "force phase °", "couple N·m",
        "couple phase °", "force without N", "force phase without °", "couple without N·m",
        "couple phase without °",
    ]  # fmt: skip
    assert [row[:3] for row in rows[1:]] == [
        [speed, "2", way] for speed in ("1500.0", "3000.0") for way in ("horizontal", "vertical")
    ]
    assert float(rows[4][3]) == 0.0
    assert float(rows[4][7]) == i4.balance(3000, orders=[2])[2].force.peak
    assert "without: without the balance shafts." in repr(table)
    assert "without" not in cp.foundation_table(i4, 3000).table


def test_an_order_that_was_not_given() -> None:
    table = cp.foundation_table(cp.Engine.preset("i4"), 3000)
    assert table.vertical_force[4].peak == cp.Engine.preset("i4").balance(3000)[4].force.peak
    assert table.coords == {}
    assert table.states == ("without",)


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"orders": "auto"}, "orders"),
        ({"vertical_deg": "up"}, "vertical_deg"),
        ({"reference_z": math.nan}, "reference_z"),
        ({"rpm": []}, "rpm"),
    ],
)
def test_errors_name_the_argument(options: dict[str, object], match: str) -> None:
    given: dict[str, object] = {"rpm": 600} | options
    with pytest.raises(cp.InputError, match=f"^{match}"):
        cp.foundation_table(cp.Engine.preset("i4"), **given)  # type: ignore[arg-type]
