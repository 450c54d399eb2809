"""Are the parts of an engine where the slider-crank puts them?"""

from __future__ import annotations

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.geometry import assumed_bores, geometry, weights_on_crank, weights_on_shafts
from crankpin.model.crankpins import bays, throws
from support import in_turn
from support.engines import CYLINDER

STAGGERED = cp.Engine.vee(
    CYLINDER, bank_angle_deg=90, throws_deg=[0, 120, 240], spacing=0.11, bank_stagger=0.022
)
RADIAL = cp.Engine.from_lists(
    CYLINDER, bank_deg=[90 + 40 * k for k in range(9)], z=[0.0] * 9, pin_deg=[90] * 9
)


@in_turn("name", cp.presets())
@in_turn("theta", [0.0, 37.0, -700.0])
def test_pins_and_pistons_are_on_an_exact_slider_crank(name: str, theta: float) -> None:
    engine = cp.Engine.preset(name)
    engine = engine.with_link_rods([None] * len(engine))  # tested with those
    at = geometry(engine, theta)
    for k, cylinder in enumerate(engine.cylinders):
        r, rod, e = cylinder.crank_radius, cylinder.rod_length, cylinder.pin_offset
        # From the definitions: the pin on its circle, the piston pin beside the bore's axis by e on
        # the side to which the crankpin swings, the rod between them.
        cranks, crank_of = engine._core.cranks
        ratio = cranks[crank_of[k]][2]
        turn = np.radians(ratio * theta + engine.pin_deg[k] - engine.bank_deg[k])
        along_bore = np.exp(1j * np.radians(engine.bank_deg[k]))
        pin = r * np.exp(1j * turn)
        e *= np.sign(ratio)
        height = pin.real + np.sqrt(rod**2 - (pin.imag - e) ** 2)
        # Angles above are rounded a few times: 1e-13 of a radian.
        crankpin, wrist_pin = (
            (place[k] - at.axis[k]) / along_bore for place in (at.crankpin, at.wrist_pin)
        )
        assert crankpin == pytest.approx(pin, abs=1e-12 * r)
        assert wrist_pin == pytest.approx(height + 1j * e, abs=1e-12 * rod)
        assert abs(at.wrist_pin[k] - at.crankpin[k]) == pytest.approx(rod, rel=1e-12)


def test_a_piston_reaches_both_ends_of_its_travel() -> None:
    engine = cp.Engine.preset("vr6")
    all_angles = [geometry(engine, theta) for theta in np.arange(0.0, 360.0, 0.25)]
    heights = np.array([((at.wrist_pin - at.foot) / at.along).real for at in all_angles])
    at = all_angles[0]
    # A step of a quarter of a degree misses an extremum by r·(0.125°)²/2 at most.
    np.testing.assert_allclose(heights.max(axis=0), at.highest, atol=2e-7)
    np.testing.assert_allclose(heights.min(axis=0), at.lowest, atol=2e-7)


@pytest.mark.parametrize("theta", ["x", np.nan, np.inf, None])
def test_the_crank_angle_is_a_finite_number(theta: object) -> None:
    with pytest.raises(cp.InputError, match="theta_deg = "):
        geometry(STAGGERED, theta)  # type: ignore[arg-type]


# --- crankpins ----------------------------------------------------------------------------------


def numbers(engine: cp.Engine) -> list[list[tuple[int, ...]]]:
    return [[pin.cylinders for pin in throw] for throw in throws(engine)]


def test_rods_share_crankpins_as_built() -> None:
    preset = cp.Engine.preset
    assert numbers(preset("i4")) == [[(1,)], [(2,)], [(3,)], [(4,)]]
    assert numbers(preset("v8-crossplane")) == [[(1, 2)], [(3, 4)], [(5, 6)], [(7, 8)]]
    assert numbers(preset("v6-60")) == [[(1,), (2,)], [(3,), (4,)], [(5,), (6,)]]
    assert numbers(preset("boxer-4")) == [[(1,), (2,)], [(3,), (4,)]]
    assert numbers(preset("v12-60")) == [[(k, k + 6)] for k in range(1, 7)]
    assert numbers(preset("w16")) == [[(k, k + 8)] for k in range(1, 9)]
    assert numbers(preset("vr6")) == [[(k,)] for k in range(1, 7)]
    assert numbers(RADIAL) == [[tuple(range(1, 10))]]
    assert numbers(STAGGERED) == [[(1, 2)], [(3, 4)], [(5, 6)]]
    assert [pin.z for (pin,) in throws(STAGGERED)] == pytest.approx([0.011, 0.121, 0.231])


def test_all_analyses_have_the_same_crankpins_and_throws() -> None:
    boxer = cp.Engine.preset("boxer-4")
    # Neighbouring pins of two throws point the same way.
    assert boxer.pin_deg[1] == boxer.pin_deg[2]
    for engine in (boxer, cp.Engine.preset("w16"), RADIAL, STAGGERED):
        pins = tuple(each for throw in numbers(engine) for each in throw)
        assert cp.tolerances(engine, rpm=60, z=1e-4, samples=1).pins == pins
        assert tuple(pin.cylinders for pin in cp.bob_weight(engine).crankpins) == pins
    # Pins split on a throw are between two main bearings, rods side by side or not.
    split = cp.Engine.vee(
        CYLINDER,
        bank_angle_deg=60,
        throws_deg=[0, 120, 240],
        spacing=0.11,
        pin_split_deg=-60,
        bank_stagger=0.022,
    )
    assert numbers(split) == [[(1,), (2,)], [(3,), (4,)], [(5,), (6,)]]
    assert [bay.cylinders for bay in bays(split)] == [(1, 2), (3, 4), (5, 6)]


def test_crankpins_are_numbered_from_the_front() -> None:
    i3 = cp.Engine.from_lists(CYLINDER, bank_deg=[90] * 3, z=[0.2, 0.0, 0.1], pin_deg=[0, 120, 240])
    assert numbers(i3) == [[(2,)], [(3,)], [(1,)]]
    ((first,), _, (last,)) = throws(i3)
    assert (first.z, last.z) == (0.0, 0.2)
    assert last.pin_deg == 0.0


# --- bores and unbalances -----------------------------------------------------------------------


def test_bores_are_as_wide_as_the_stroke_unless_the_next_cylinder_is_close() -> None:
    def bores(spacing: float) -> float:
        engine = cp.Engine.inline(CYLINDER, throws_deg=[0, 180], spacing=spacing)
        first, second = assumed_bores(engine)
        assert first == second
        return float(first / CYLINDER.stroke)

    assert bores(2.0 * CYLINDER.stroke) == 1.0
    assert bores(CYLINDER.stroke) == pytest.approx(0.9)
    assert bores(0.01) == pytest.approx(0.6)
    assert assumed_bores(cp.Engine.preset("single")).tolist() == [0.086]
    # The other bank's cylinder is not in the way.
    vr6 = cp.Engine.preset("vr6", cylinder=cp.Cylinder(0.04515, 0.164, 0.45))
    assert set(assumed_bores(vr6).tolist()) == {0.0903}


@pytest.mark.parametrize("theta", [0.0, 25.0])
def test_unbalances_at_an_angle_make_the_force_of_the_balance(theta: float) -> None:
    massless = CYLINDER.replace(reciprocating_mass=0.0)
    engine = cp.Engine.inline(massless, throws_deg=[0, 120, 240], spacing=0.1)
    weights = [cp.Unbalance(0.01, 0.0, "360/7"), cp.Unbalance(0.02, 0.2, 170, pin=3)]
    shaft = cp.Shaft(-2, [cp.Unbalance(0.003, 0.1, 33), cp.Unbalance(0.001, 0.0)], x=0.1)
    engine = engine.with_counterweights(weights).with_shafts([shaft])
    rpm = 60.0 / (2.0 * np.pi)  # one radian a second
    force = engine.waveform(rpm, theta_deg=[theta]).force[0]
    vectors = [
        scale * weight.amount * np.exp(1j * np.radians(weight.angle_deg))
        for scale, found in ((1.0, weights_on_crank(engine, theta)),
                             (4.0, weights_on_shafts(engine, theta)[0]))
        for weight in found
    ]  # fmt: skip
    assert sum(vectors) == pytest.approx(complex(*force), abs=1e-15)
    assert [weight.z for weight in weights_on_crank(engine)] == [0.0, 0.2]


def test_bores_that_are_known_are_drawn_as_wide() -> None:
    bored = CYLINDER.replace(bore=0.07)
    engine = cp.Engine.inline(bored, throws_deg=[0, 180], spacing=0.05)
    assert assumed_bores(engine).tolist() == [0.07, 0.07]
