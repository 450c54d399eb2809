"""Are bob weights what the trade weighs, and is what every factor leaves what turning masses do?"""

from __future__ import annotations

import pickle
from typing import Any

import crankpin as cp
import numpy as np
import pytest
from crankpin import Unbalance
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import first_order, time_domain
from support import html_of, in_turn

UNIT = cp.Cylinder(crank_radius=1.0, rod_length=4.0, reciprocating_mass=1.0)
UNIT_SPEED = 60.0 / (2.0 * np.pi)


def v_twin(bank_angle_deg: float, **options: Any) -> cp.Engine:  # noqa: ANN401
    return cp.Engine.vee(
        UNIT, bank_angle_deg=bank_angle_deg, **{"throws_deg": [0], "spacing": 1.0, **options}
    )


def preset(name: str, **options: Any) -> cp.Engine:  # noqa: ANN401
    return cp.Engine.preset(name, cylinder=UNIT, spacing=1.0, **options)


def order_1(engine: cp.Engine) -> cp.results.OrderBalance:
    return engine.balance(UNIT_SPEED, orders=[1])[1]


# --- what is weighed -----------------------------------------------------------------------------


def test_a_bob_weight_is_rotating_and_a_part_of_reciprocating_mass_and_oil() -> None:
    """A V8 trade example: two rods on a pin, so twice what one cylinder has."""
    v8 = cp.Engine.preset("v8-crossplane", rotating_mass=0.55)
    bob = cp.bob_weight(v8, factor=0.52, oil=0.004)
    np.testing.assert_allclose(bob.grams, [2 * 550 + 0.52 * 2 * 450 + 4] * 4)
    np.testing.assert_array_equal(bob.mass * 1e3, bob.grams)
    assert [pin.cylinders for pin in bob.crankpins] == [(1, 2), (3, 4), (5, 6), (7, 8)]
    frame = bob.to_pandas()
    assert list(frame.cylinders) == ["1, 2", "3, 4", "5, 6", "7, 8"]
    assert list(frame["bob weight g"]) == list(bob.grams)


@pytest.mark.parametrize(
    ("engine", "pins"),
    [
        (preset("i4"), [(1,), (2,), (3,), (4,)]),
        (preset("v6-90"), [(1,), (2,), (3,), (4,), (5,), (6,)]),  # split by 30°
        (preset("v6-90-odd-fire"), [(1, 2), (3, 4), (5, 6)]),
        (preset("boxer-4"), [(1,), (2,), (3,), (4,)]),
        (preset("flat-4"), [(1, 2), (3, 4)]),
        (preset("vr6"), [(1,), (2,), (3,), (4,), (5,), (6,)]),
        (preset("w16"), [(1, 9), (2, 10), (3, 11), (4, 12), (5, 13), (6, 14), (7, 15), (8, 16)]),
        (preset("v8-flatplane"), [(1, 2), (3, 4), (5, 6), (7, 8)]),
        # Rods side by side, up to a crank radius; farther apart are two throws.
        (v_twin(90, bank_stagger=0.6), [(1, 2)]),
        (v_twin(90, bank_stagger=-0.6), [(1, 2)]),
        (v_twin(90, bank_stagger=1.2), [(1,), (2,)]),
        (
            cp.Engine.vee(
                UNIT,
                bank_angle_deg=60,
                throws_deg=[0, 0],
                spacing=1.0,
                bank_stagger=0.7,
                numbering="by-bank",
            ),
            [(1, 3), (2, 4)],
        ),
        # Two cylinders of one bank have two throws, however close.
        (cp.Engine.inline(UNIT, throws_deg=[0, 0], spacing=0.5), [(1,), (2,)]),
        # A radial has all its rods on one pin.
        (
            cp.Engine.from_lists(
                UNIT, pin_deg=[0.0] * 5, bank_deg=[0, 72, 144, 216, 288], z=[0.0] * 5
            ),
            [(1, 2, 3, 4, 5)],
        ),
    ],
)
def test_cylinders_share_a_crankpin(engine: cp.Engine, pins: list[tuple[int, ...]]) -> None:
    bob = cp.bob_weight(engine)
    assert [pin.cylinders for pin in bob.crankpins] == pins
    assert bob.reciprocating.tolist() == [len(pin) for pin in pins]
    for pin in bob.crankpins:
        assert min(engine.z) <= pin.z <= max(engine.z)
        assert all(
            abs((pin.pin_deg - engine.pin_deg[n - 1] + 180) % 360 - 180) < 1e-9
            for n in pin.cylinders
        )


def test_a_heavier_piston_weighs_on_its_pin() -> None:
    v8 = cp.Engine.preset("v8-crossplane")
    masses = [0.45] * 4 + [0.47] + [0.45] * 3
    heavy = v8.replace(
        cylinder=[
            c.replace(reciprocating_mass=m) for c, m in zip(v8.cylinders, masses, strict=True)
        ]
    )
    np.testing.assert_allclose(cp.bob_weight(heavy).grams, [450, 450, 460, 450])


# --- residual ------------------------------------------------------------------------------------

ENGINES = {
    **{name: cp.Engine.preset(name) for name in ("single", "v6-90", "i3", "v6-60", "v-twin-90")},
    "45° V-twin": v_twin(45, rotating_mass=0.3),
    "unlike": cp.Engine.from_lists(
        [UNIT, cp.Cylinder(0.8, 3.0, 1.4), cp.Cylinder(1.2, 4.0, 0.6)],
        tdc_deg=[10, 77, 200],
        bank_deg=[90, 50, 130],
        z=[0.0, 0.9, 2.1],
        rotating_mass=[0.2, 0.3, 0.4],
        counterweights=[Unbalance(0.7, 0.3, 12.0)],
    ),
    "vr6": cp.Engine.preset("vr6"),
    "w12": cp.Engine.preset("w12"),
}


@settings(max_examples=40, deadline=None)
@given(name=st.sampled_from(list(ENGINES)), factor=st.floats(0.0, 1.5))
def test_what_stays_is_what_turning_masses_leave(name: str, factor: float) -> None:
    engine = ENGINES[name]
    parts, plane = engine.cylinders, float(engine.z.max() + engine.z.min()) / 2
    lists = time_domain.EngineLists(
        crank_radius=[c.crank_radius for c in parts],
        rod_length=[c.rod_length for c in parts],
        reciprocating_mass=[c.reciprocating_mass for c in parts],
        pin_offset=[c.pin_offset for c in parts],
        tdc_deg=engine.tdc_deg,
        bank_deg=engine.bank_deg,
        z=engine.z,
        rotating_mass=engine.rotating_mass,
    )
    weights = [
        ((m + factor * c.reciprocating_mass) * c.crank_radius, pin + 180.0, z)
        for m, c, pin, z in zip(engine.rotating_mass, parts, engine.pin_deg, engine.z, strict=True)
    ]
    found = first_order.parts(lists, weights, plane)
    bob = cp.bob_weight(engine, factor, oil=0.1)
    after = order_1(bob.fitted)
    size = sum(c.reciprocating_mass * c.crank_radius for c in parts)
    for quantity, (forward, backward) in {"force": found[:2], "moment": found[2:]}.items():
        near = 1e-10 * max(size, size * float(np.ptp(engine.z)))
        assert abs(complex(getattr(after, quantity).forward) - forward) < near
        assert abs(complex(getattr(after, quantity).backward) - backward) < near
        longest, shortest = bob.half_axes(quantity, factor)
        assert longest == pytest.approx(abs(forward) + abs(backward), abs=near)
        assert shortest == pytest.approx(abs(forward) - abs(backward), abs=near)
        vector = getattr(bob.residual[1], quantity)
        assert (vector.peak, vector.minor) == pytest.approx((longest, shortest), abs=near)
        assert bob.half_axes(quantity, [0.1, factor])[0][1] == longest


@in_turn("seed", range(20))
def test_what_cancels_is_zero_and_not_its_rounding(seed: int) -> None:
    """As the balance of the fitted engine has it, whose zeros are those of sums."""
    rng = np.random.default_rng(seed)
    pins, bank = int(rng.choice([2, 3, 4, 6])), rng.choice([60.0, 90.0, 180.0])
    masses = 0.5 + 0.001 * (rng.integers(20) + np.arange(2 * pins))
    engine = cp.Engine.vee(
        [UNIT.replace(reciprocating_mass=float(mass)) for mass in masses],
        bank_angle_deg=bank,
        throws_deg=[360.0 * k / pins for k in range(pins)],
        spacing=1.0,
        rotating_mass=0.4,
    )
    bob = cp.bob_weight(engine, 0.5)
    for quantity in ("force", "moment"):
        vector, axes = getattr(bob.residual[1], quantity), bob.half_axes(quantity, 0.5)
        assert [each == 0.0 for each in axes] == [vector.peak == 0.0, vector.minor == 0.0]
        for factor, _ in bob.straight_line_factors(quantity):
            assert bob.half_axes(quantity, factor)[1] == 0.0


@pytest.mark.parametrize("name", ["single", "v6-90", "i3", "45° V-twin"])
def test_half_axes_are_those_of_the_theorem(name: str) -> None:
    """|(1 − 2κ)f| ± |b|, least at one half, straight at ½(1 ± |b|/|f|)."""
    engine = ENGINES[name].replace(rotating_mass=0)
    before, bob = order_1(engine), cp.bob_weight(engine)
    for quantity in ("force", "moment"):
        f = abs(complex(getattr(before, quantity).forward))
        b = abs(complex(getattr(before, quantity).backward))
        if f == 0.0:
            assert bob.optimal_factor(quantity) is None
            assert bob.straight_line_factors(quantity) == ()
            continue
        factors = np.linspace(0.0, 1.2, 13)
        longest, shortest = bob.half_axes(quantity, factors)
        np.testing.assert_allclose(longest, np.abs(1 - 2 * factors) * f + b, atol=1e-14)
        np.testing.assert_allclose(shortest, np.abs(1 - 2 * factors) * f - b, atol=1e-14)
        assert bob.optimal_factor(quantity) == pytest.approx(0.5, abs=1e-15)
        lines = bob.straight_line_factors(quantity)
        assert [factor for factor, _ in lines] == pytest.approx(
            [(1 - b / f) / 2, (1 + b / f) / 2], abs=1e-12
        )
        for factor, direction_deg in lines:
            longest, shortest = bob.half_axes(quantity, factor)
            assert shortest == pytest.approx(0.0, abs=1e-12)
            assert longest == pytest.approx(2 * b)
            traced = order_1(cp.bob_weight(engine, factor).fitted)
            path = getattr(traced, quantity).xy[..., :] @ np.eye(2)
            turns = np.exp(1j * np.linspace(0, 2 * np.pi, 60))
            xy = (path[:, None] * turns).real
            angle = np.deg2rad(direction_deg)
            across = xy[1] * np.cos(angle) - xy[0] * np.sin(angle)
            assert np.abs(across).max() < 1e-9 * longest


def test_a_single_is_straight_at_nothing_and_at_all() -> None:
    single = cp.bob_weight(preset("single"))
    assert single.straight_line_factors("force") == ((0.0, 90.0), (1.0, 0.0))
    assert single.half_axes("force", [0, 1])[0].tolist() == [1.0, 1.0]
    assert single.half_axes("force", 0.5) == (0.5, -0.5)
    assert single.residual[1].force.tilt_deg == 0.0
    assert single.straight_line_factors("moment") == ()


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_half_the_mass_removes_the_forward_part_of_any_engine_without_offset(seed: int) -> None:
    """The forward theorem for engines that differ; tests/model/test_shafts.py has the presets."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 13))
    radius, ratio, mass = rng.uniform([0.5, 0.1, 0.1], [2.0, 0.6, 3.0], (count, 3)).T
    engine = cp.Engine.from_lists(
        [cp.Cylinder(r, r / x, m) for r, x, m in zip(radius, ratio, mass, strict=True)],
        tdc_deg=rng.uniform(0, 360, count).tolist(),
        bank_deg=rng.uniform(0, 360, count).tolist(),
        z=rng.uniform(-2, 2, count),
        rotating_mass=rng.uniform(0, 2, count),
    )
    bob = cp.bob_weight(engine)
    for plane in (None, 0.7):
        after = bob.fitted.replace(reference_z=plane).balance(UNIT_SPEED, orders=[1])[1]
        assert complex(after.force.forward) == complex(after.moment.forward) == 0.0
        before = engine.replace(reference_z=plane).balance(UNIT_SPEED, orders=[1])[1]
        for quantity in ("force", "moment"):
            found = complex(getattr(after, quantity).backward)
            expected = complex(getattr(before, quantity).backward)
            assert abs(found - expected) <= 1e-13 * float((mass * radius).sum())


@pytest.mark.parametrize(("angle", "stays"), [(90, 0.0), (60, 0.5), (45, 0.707107)])
def test_v_twins_at_half(angle: float, stays: float) -> None:
    bob = cp.bob_weight(v_twin(angle, rotating_mass=0.4))
    assert bob.half_axes("force", 0.5)[0] == pytest.approx(stays, abs=1e-6)
    assert float(order_1(bob.fitted).force.peak) == pytest.approx(stays, abs=1e-6)


def test_pin_offsets_move_the_best_factor() -> None:
    """Of a₁ = 1 + ib a factor κ leaves ½a₁ − κ: least at ½, and not zero."""
    engine = cp.Engine.inline(UNIT.replace(pin_offset=0.4), throws_deg=[0], spacing=1.0)
    a1 = complex(engine.cylinders[0].harmonics([1])[0])
    bob = cp.bob_weight(engine)
    assert bob.optimal_factor("force") == pytest.approx(0.5)
    assert bob.half_axes("force", 0.5)[0] == pytest.approx(abs(a1) / 2 + abs(a1.imag) / 2)
    vr6 = cp.bob_weight(cp.Engine.preset("vr6"))
    factors = np.linspace(0, 1, 2001)
    best = factors[vr6.half_axes("moment", factors)[0].argmin()]
    assert vr6.optimal_factor("moment") == pytest.approx(best, abs=5e-4)
    for factor, _ in vr6.straight_line_factors("moment"):
        assert vr6.half_axes("moment", factor)[1] == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize(("angle", "least"), [(180.0, 0.0), (0.0, 10.0)])
def test_the_least_factor_is_one_that_can_be_given(angle: float, least: float) -> None:
    """A shaft that turns with the crank would ask for factors of −49.5 and 50.5."""
    engine = preset("single")
    shaft = cp.Shaft(1, [cp.Unbalance(50.0, 0.0, float(engine.pin_deg[0]) + angle)])
    bob = cp.bob_weight(engine.with_shafts([shaft]))
    assert bob.optimal_factor("force") == least
    assert cp.bob_weight(bob.engine, least).factor == least


def test_straight_lines_point_above_minus_90_degrees() -> None:
    vee = cp.Engine.vee(UNIT, bank_angle_deg=35, throws_deg=[0, 210], spacing=1.0)
    assert [direction for _, direction in cp.bob_weight(vee).straight_line_factors("force")] == [
        90.0,
        0.0,
    ]


# --- what it is ----------------------------------------------------------------------------------


def test_counterweights_are_replaced_and_oil_cancels() -> None:
    engine = v_twin(60, rotating_mass=0.4, name="twin").with_counterweights([Unbalance(1.0, 0.0)])
    dry, oiled = cp.bob_weight(engine), cp.bob_weight(engine, oil=0.02)
    assert dry.fitted == oiled.fitted
    assert len(dry.fitted.counterweights) == 2
    np.testing.assert_allclose(oiled.grams - dry.grams, [20.0])
    assert float(order_1(dry.fitted).force.peak) == pytest.approx(0.5)
    assert dry.residual[1].force.peak == pytest.approx(0.5)


def test_tables_and_copies() -> None:
    bob = cp.bob_weight(cp.Engine.preset("v6-90", rotating_mass=0.3), 0.55, oil=0.005)
    text = repr(bob)
    assert text.startswith(
        "V6 90°, split pins: bob weights, rotating + 55 % of reciprocating + oil"
    )
    assert "least moment" in text
    assert "moment along 90°" in text
    assert "\n0.55 " in text
    assert "-0°" not in text
    assert html_of(bob).count("<table>") == 2
    table = bob.frames["factors"]
    assert len(table.columns) == 4  # without the force, of which there is none
    half = table["factor"].values.index("0.5")
    assert table.columns[2].values[half] == bob.half_axes("moment", 0.5)[0]
    back = pickle.loads(pickle.dumps(bob))  # noqa: S301 - its own
    assert back == bob
    assert hash(back) == hash(bob)
    assert cp.bob_weight(bob.engine, 0.55) != bob
    for values in (
        bob.mass,
        bob.grams,
        bob.rotating,
        bob.reciprocating,
        *bob.half_axes("force", [1]),
    ):
        assert not values.flags.writeable


@pytest.mark.parametrize(
    ("given_", "words"),
    [
        ({"factor": -0.1}, "factor = -0.1: give a share of the reciprocating mass"),
        ({"factor": 50}, "factor = 50.0: give a share of the reciprocating mass, 0 to 10"),
        ({"factor": float("nan")}, "factor = nan"),
        ({"factor": [0.5]}, r"factor = \[0.5\]: give a number"),
        ({"oil": -1}, "oil = -1.0: give the oil of a crankpin in kilograms"),
        ({"engine": 3}, r"engine = 3: give a crankpin\.Engine"),
    ],
)
def test_arguments_that_do_not_fit_are_named(given_: dict[str, Any], words: str) -> None:
    arguments: dict[str, Any] = {"engine": v_twin(90)} | given_
    with pytest.raises(cp.InputError, match=words):
        cp.bob_weight(**arguments)
    bob = cp.bob_weight(v_twin(90))
    with pytest.raises(cp.InputError, match="quantity = 'torque'"):
        bob.half_axes("torque", 0.5)
    with pytest.raises(cp.InputError, match=r"factor = .*inf.*give a share"):
        bob.half_axes("force", [0.1, np.inf])
