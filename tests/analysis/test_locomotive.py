"""Do locomotives have the weights, blows and couples of textbooks and of free bodies?"""

from __future__ import annotations

import csv
import io
import math
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from rederivation.tables import Piston, Weight, in_wheels, on_frame
from support import in_turn

TEXTBOOK = cp.Cylinder(crank_radius=0.3, rod_length=math.inf, reciprocating_mass=300)
WHEEL = 1.7
KMH = 90.0
OMEGA = KMH / 3.6 / (WHEEL / 2)
UNIT = 300 * 0.3 * OMEGA**2
"""Inertia of one piston at 90 km/h, N."""


def two(**options: Any) -> cp.Locomotive:  # noqa: ANN401
    given: dict[str, Any] = {
        "cylinder": TEXTBOOK, "z": [-0.35, 0.35], "throws_deg": [0, 90], "wheel_z": [-0.8, 0.8],
        "wheel_diameter": WHEEL,
    }  # fmt: skip
    return cp.Locomotive(**given | options)


def few(
    seed: int, *, given: bool = False
) -> tuple[cp.Locomotive, list[Piston], list[list[Weight]]]:
    """A locomotive of figures drawn from few values; its pistons; what turns with each axle.

    Without counterweights, unless these are given.
    """
    random = np.random.default_rng(seed)
    count, axles = int(random.integers(1, 5)), int(random.integers(1, 4))
    throws = [0, *random.choice([0, 90, 120, 180, 240, 270], count - 1).tolist()]
    tilts = random.choice([0, 0, 5], count).tolist()
    z = random.choice([-0.6, -0.35, 0.0, 0.35, 0.6], count).tolist()
    masses = random.choice([0.0, 120.0], count).tolist()
    driving = random.integers(1, axles + 1, count).tolist()
    rod = float(random.choice([math.inf, 1.5, 2.4]))
    bore = [180.0 - tilt for tilt in tilts]
    pistons = [
        Piston(300.0, 0.3, rod, bore[k], bore[k] - bore[0] - throws[k], z[k]) for k in range(count)
    ]
    rods = [
        cp.Unbalance(
            20.0,
            float(side),
            float(random.choice([0, 180])),
            pin=int(random.integers(1, count + 1)),
        )
        for side in (-0.9, 0.9)
    ][: int(random.integers(0, 3))]
    pin = [bore[0] + throw for throw in throws]
    turning = [
        [Weight(0.3 * masses[k], pin[k], z[k]) for k in range(count) if driving[k] == axle + 1]
        + [Weight(rod.amount, rod.angle_deg + pin[(rod.pin or 1) - 1], rod.z) for rod in rods]
        for axle in range(axles)
    ]
    options: dict[str, Any] = {"share": random.choice([0.0, 0.1, 0.2], axles).tolist()}
    if given:
        weights = [
            [cp.Unbalance(float(random.choice([10, 30])), side, float(random.choice([0, 45, 180])))
             for side in (-0.8, 0.8)] for _ in range(axles)
        ]  # fmt: skip
        options = {"weights": weights}
        turning = [
            own + [Weight(one.amount, float(one.angle_deg), one.z) for one in more]
            for own, more in zip(turning, weights, strict=True)
        ]
    return (
        cp.Locomotive(
            cp.Cylinder(0.3, rod, 300.0), z=z, throws_deg=throws, wheel_z=[0.8, -0.8],
            rotating_mass=masses, inclination_deg=tilts, wheel_diameter=WHEEL, driving=driving,
            axle_x=[1.9 * k for k in range(axles)], coupling=rods, wheel_load=60e3, **options,
        ),
        pistons,
        turning,
    )  # fmt: skip


# --- figures --------------------------------------------------------------------------------------


def test_a_textbook_share_by_the_hammer_blow() -> None:
    """Sarkar, example 12.7: 40 kN at 90 km/h, 300 kg, r 0.3 m, wheels 1.7 m, cylinders 0.7 m apart.

    The book draws the polygon of couples and reads 69.625·c kg·m off it, which is that of wheels
    1.577 m apart: 69.46 of 1.6 m, 69.83 of 1.55 m. Printed are 0.664, 36980.420 N and
    12943.147 N·m.
    """
    apart = 0.35 / math.sqrt(((69.625 / 90) ** 2 - 0.5) / 2)  # hypot(½ + k, ½ − k) = 69.625 / 90
    drawn = two(wheel_z=[-apart / 2, apart / 2], z=[-0.35, 0.35])
    k = 0.35 / apart
    assert 90 * math.hypot(0.5 + k, 0.5 - k) == pytest.approx(69.625)
    share = drawn.share_for(40e3, speed_kmh=KMH)
    assert share == pytest.approx(0.66412926, rel=1e-7)
    forces = drawn.replace(share=share).forces(speed_kmh=KMH)
    assert float(forces.tractive_variation.peak) == pytest.approx(36980.42, rel=1e-7)
    assert float(forces.swaying_couple.peak) == pytest.approx(12943.147, rel=1e-7)
    np.testing.assert_allclose(forces.hammer_blow.peak, 40e3, rtol=1e-12)
    for distance, polygon in ((1.6, 69.46), (1.55, 69.83)):
        own = two(wheel_z=[-distance / 2, distance / 2]).share_for(40e3, speed_kmh=KMH)
        assert 40e3 / OMEGA**2 / own == pytest.approx(polygon, abs=0.005)


@pytest.mark.parametrize("share", [0.0, 0.3, 2 / 3, 1.0])
@pytest.mark.parametrize("distance", [0.7, 1.5])
def test_two_cylinders_at_right_angles(share: float, distance: float) -> None:
    """The formulae of textbooks, for cylinders inside the wheels and in their planes or outside."""
    locomotive = two(z=[-distance / 2, distance / 2], share=share)
    forces = locomotive.forces(speed_kmh=KMH)
    k = distance / 2 / 1.6
    allowed = 1e-9 * UNIT
    blow = share * UNIT * math.hypot(0.5 + k, 0.5 - k)
    np.testing.assert_allclose(forces.hammer_blow.peak, [blow] * 2, rtol=1e-12, atol=allowed)
    rest = (1 - share) * UNIT
    assert float(forces.tractive_variation.peak) == pytest.approx(math.sqrt(2) * rest, abs=allowed)
    sway = distance * rest / math.sqrt(2)
    assert float(forces.swaying_couple.peak) == pytest.approx(sway, abs=allowed)


def test_three_cylinders_do_not_pull_and_push() -> None:
    three = two(z=[-0.6, 0, 0.6], throws_deg=[0, 120, 240])
    assert float(three.forces(speed_kmh=KMH).tractive_variation.peak) == 0.0
    # On rods the sixth order is left, and nothing below it.
    short = three.replace(cylinder=[TEXTBOOK.replace(rod_length=1.5)] * 3)
    balance = short.engine.balance(280)
    assert next(order for order in balance.orders if balance.force[order].x) == 6
    assert 0.0 < float(short.forces(280).tractive_variation.peak) < 0.01 * UNIT


# --- laws -----------------------------------------------------------------------------------------


@in_turn("seed", range(32))
def test_forces_are_those_of_free_bodies(seed: int) -> None:
    locomotive, pistons, turning = few(seed)
    shares = locomotive.share
    assert isinstance(shares, tuple)
    wheel_z = locomotive.wheel_z
    crank = [
        [Weight(share * 90.0, piston.bore_deg - piston.tdc_deg, piston.z) for piston in pistons]
        for share in shares
    ]
    forces = locomotive.forces(rpm=280)
    omega = 280 * 2 * math.pi / 60
    weights = [weight for of_axle in turning for weight in of_axle]
    for axle, of_axle in enumerate(turning):
        # Counterweights are opposite to what they balance: rotating parts, and a share of pistons.
        balance = -in_wheels([*of_axle, *crank[axle]], wheel_z)
        weights += [
            Weight(abs(pull), math.degrees(np.angle(pull)), z)
            for pull, z in zip(balance.tolist(), wheel_z, strict=True)
        ]
        left = balance + in_wheels(of_axle, wheel_z)
        theta = np.radians(forces.theta_deg)
        for k in range(2):
            expected = -(left[k] * np.exp(1j * theta)).imag * omega**2
            wheel = np.asarray(forces.hammer_blow)[2 * axle + k]
            np.testing.assert_allclose(wheel, expected, atol=1e-9 * UNIT)
            peak = forces.hammer_blow.peak[2 * axle + k]
            assert peak == pytest.approx(abs(left[k]) * omega**2, abs=1e-9 * UNIT)
    force, couple = on_frame(pistons, weights, omega, sum(wheel_z) / 2)
    for quantity, curve in (("tractive_variation", force), ("swaying_couple", couple)):
        own = getattr(forces, quantity)
        # Every tenth of a degree: its highest sample is within 2e-5 of the peak.
        allowed = 2e-5 * np.abs(curve).max() + 1e-8 * UNIT
        assert float(own.peak) == pytest.approx(np.abs(curve).max(), abs=allowed)
        sign = -1.0 if quantity == "tractive_variation" else 1.0
        np.testing.assert_allclose(np.asarray(own)[:-1], sign * curve[::10], atol=1e-8 * UNIT)


@in_turn("seed", range(16))
def test_weights_that_are_given(seed: int) -> None:
    locomotive, pistons, turning = few(seed, given=True)
    omega = 200 * 2 * math.pi / 60
    forces = locomotive.forces(rpm=200)
    for axle, of_axle in enumerate(turning):
        left = np.abs(in_wheels(of_axle, locomotive.wheel_z)) * omega**2
        found = forces.hammer_blow.peak[2 * axle : 2 * axle + 2]
        np.testing.assert_allclose(found, left, rtol=1e-9, atol=1e-6)
    weights = [weight for of_axle in turning for weight in of_axle]
    force, _ = on_frame(pistons, weights, omega, 0.0)
    peak = float(forces.tractive_variation.peak)
    assert peak == pytest.approx(np.abs(force).max(), rel=2e-5)


@in_turn("seed", range(16))
def test_the_engine_has_what_the_locomotive_pushes(seed: int) -> None:
    locomotive, *_ = few(seed)
    engine, forces = locomotive.engine, locomotive.forces(150)
    over_turn = engine.waveform(150, forces.theta_deg)
    np.testing.assert_array_equal(forces.tractive_variation, -over_turn.force[:, 0])
    np.testing.assert_array_equal(forces.swaying_couple, over_turn.moment[:, 1])
    # Vertical force of all wheels: that of the engine without pistons.
    bare = [one.replace(reciprocating_mass=0.0) for one in engine.cylinders]
    turning = engine.replace(cylinder=bare, rotating_mass=engine.rotating_mass)
    without_pistons = turning.waveform(150, forces.theta_deg)
    blows = -np.asarray(forces.hammer_blow).reshape(len(locomotive.axle_x), 2, -1).sum(axis=1)
    np.testing.assert_allclose(blows.sum(axis=0), without_pistons.force[:, 1], atol=1e-9 * UNIT)
    # Each axle at its own place, they pitch the locomotive.
    assert isinstance(locomotive.driving, tuple)
    levers = np.array(locomotive.axle_x) - locomotive.axle_x[locomotive.driving[0] - 1]
    np.testing.assert_allclose(levers @ blows, without_pistons.torque, atol=1e-9 * UNIT)


@in_turn("seed", range(16))
def test_a_blow_scales_with_the_square_of_the_speed_and_lifts_at_its_own(seed: int) -> None:
    locomotive, *_ = few(seed)
    slow, fast = locomotive.forces(100), locomotive.forces(300)
    np.testing.assert_allclose(fast.hammer_blow.peak, 9 * slow.hammer_blow.peak, rtol=1e-12)
    blows = slow.hammer_blow.peak
    # A wheel loaded by its blow at 100 rpm lifts there; one without a blow never does.
    loaded = locomotive.replace(wheel_load=np.where(blows > 0, blows, 60e3).tolist())
    expected = np.where(blows > 0, 100.0, np.inf)
    np.testing.assert_allclose(loaded.lifting_rpm, expected, rtol=1e-12)


def test_no_share_is_no_hammer_blow() -> None:
    locomotive, *_ = few(5)
    none = locomotive.replace(share=0.0)
    assert [weight.amount for weight in none.unbalances] == [0.0] * len(none.wheels)
    assert np.isinf(none.lifting_rpm).all()


def test_axles_share_the_weights() -> None:
    """The same share on three axles is a third of the hammer blow on each."""
    one = two(share=0.6)
    three = two(share=0.6, axle_x=[0, 1.9, 3.8], driving=2)
    blow = one.forces(200).hammer_blow.peak
    np.testing.assert_allclose(three.forces(200).hammer_blow.peak, np.tile(blow / 3, 3), rtol=1e-12)
    for name in ("tractive_variation", "swaying_couple"):
        found = float(getattr(three.forces(200), name).peak)
        assert found == pytest.approx(float(getattr(one.forces(200), name).peak))
    assert three.share_for(40e3, rpm=200) == pytest.approx(3 * one.share_for(40e3, rpm=200))


def test_one_figure_of_all_stays_so() -> None:
    one = two(share=0.6, rotating_mass=120, wheel_load=70e3, inclination_deg=5)
    more = one.replace(axle_x=[0, 1.9], driving=2)
    expected = two(
        cylinder=[TEXTBOOK] * 2, share=[0.3, 0.3], rotating_mass=[120, 120], driving=[2, 2],
        wheel_load=[70e3] * 4, inclination_deg=[5, 5], axle_x=[0, 1.9],
    )  # fmt: skip
    assert more.table == expected.table
    assert more.engine == expected.engine
    assert (more.share, more.rotating_mass, more.driving) == (0.6, 120.0, 2)
    assert expected.share == (0.3, 0.3)


def test_coupling_rods_opposite_to_inside_cranks_help_to_balance() -> None:
    rods = [cp.Unbalance(20, z, 180, pin=pin) for z, pin in ((-0.9, 1), (0.9, 2))]
    plain, coupled = two(rotating_mass=200), two(rotating_mass=200, coupling=rods)
    weight = [loco.table["weight"].values[0] for loco in (plain, coupled)]
    assert weight[1] < weight[0]
    assert not coupled.forces(200).hammer_blow.peak.any()


def test_speed_in_kmh_is_that_of_the_rim() -> None:
    forces = two(share=0.5).forces(speed_kmh=KMH)
    assert forces.rpm == pytest.approx(OMEGA * 60 / (2 * math.pi))
    assert forces.speed_kmh == pytest.approx(KMH)
    bare = two(wheel_diameter=None)
    with pytest.raises(cp.InputError, match="wheel_diameter"):
        bare.forces(speed_kmh=KMH)
    assert not hasattr(bare, "lifting_rpm")
    assert not hasattr(bare.forces(100), "speed_kmh")


def test_at_other_angles_peaks_are_those_of_the_angles() -> None:
    locomotive = two(share=0.5)
    forces = locomotive.forces(200, theta_deg=[0.0, 30.0])
    for name in ("hammer_blow", "tractive_variation", "swaying_couple"):
        own = getattr(forces, name)
        np.testing.assert_array_equal(own.peak, np.abs(np.asarray(own)).max(axis=-1))


def test_tables() -> None:
    locomotive = two(share=2 / 3, wheel_load=70e3, name="Two cylinders")
    rows = list(csv.reader(io.StringIO(locomotive.table.to_csv())))
    assert rows[0] == [
        "wheel", "z m", "weight kg·m", "angle °", "unbalance kg·m", "lifts at rpm", "lifts at km/h",
    ]  # fmt: skip
    assert [row[0] for row in rows[1:]] == ["axle 1 right", "axle 1 left"]
    forces = locomotive.forces(speed_kmh=KMH)
    assert "Two cylinders at 90 km/h (280.862 rpm)" in repr(forces)
    rows = list(csv.reader(io.StringIO(forces.table.to_csv())))
    share = float(rows[3][3]) / 100 * 70e3
    assert float(rows[3][2]) == pytest.approx(share) == forces.hammer_blow.peak[0]


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"wheel_z": [0.8, 0.8]}, "wheel_z"),
        ({"wheel_z": [0.8]}, "wheel_z"),
        ({"z": []}, "z"),
        ({"weights": [[cp.Unbalance(1, 0.5)]]}, "weights"),
        ({"throws_deg": [0]}, "throws_deg"),
        ({"share": 1.2}, "share"),
        ({"share": [0.1, 0.2]}, "share"),
        ({"share": 0.5, "weights": [[]]}, "share"),
        ({"weights": [[], []]}, "weights"),
        ({"weights": [[cp.Unbalance(1, 0, crank=1)]]}, "weights"),
        ({"coupling": [cp.Unbalance(1, 0, pin=3)]}, "coupling"),
        ({"driving": 2}, "driving"),
        ({"axle_x": []}, "axle_x"),
        ({"wheel_load": [1, 2, 3]}, "wheel_load"),
        ({"rotating_mass": [1, 2, 3]}, "rotating_mass"),
        ({"inclination_deg": "steep"}, "inclination_deg"),
    ],
)
def test_errors_name_the_argument(options: dict[str, Any], match: str) -> None:
    with pytest.raises(cp.InputError, match=f"^{match}"):
        two(**options)


def test_errors_of_questions() -> None:
    locomotive = two(share=0.5)
    for speeds in ({}, {"rpm": 100, "speed_kmh": 30}):
        with pytest.raises(cp.InputError, match="speed_kmh"):
            locomotive.forces(**speeds)
    given = two(weights=[[cp.Unbalance(10, 0.8)]])
    with pytest.raises(cp.InputError, match="leave out the weights"):
        given.share_for(1e3, rpm=100)
