"""Infinite rods, those of Scotch yokes: limits of long ones, a free body, proofs, files, pages."""

from __future__ import annotations

import json
import math
import pickle
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin.view.figures import figures
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

YOKE = cp.Cylinder(0.045, math.inf, 0.5, bore=0.09)
LONG = 1e-9
"""Rod ratio of a rod that is nearly infinite: what it adds goes with it."""
WITHIN = 1e-8
"""Of the size of what a cylinder makes: ten times what such a rod adds to each of ten cylinders."""


def long_rods(engine: cp.Engine) -> cp.Engine:
    """Return an engine with long rods in place of infinite ones."""
    each = [
        one.replace(rod_length=one.crank_radius / LONG) if math.isinf(one.rod_length) else one
        for one in engine.cylinders
    ]
    return engine.replace(cylinder=each)


def random_engine(rng: np.random.Generator) -> cp.Engine:
    """Return an engine some of whose rods are infinite, at random places of its crank."""
    count = int(rng.integers(1, 6))
    each = []
    for k in range(count):
        radius, mass = rng.uniform(0.03, 0.06), rng.uniform(0.2, 0.8)
        rod = math.inf if k == 0 or rng.random() < 0.5 else radius / rng.uniform(0.2, 0.4)
        each.append(cp.Cylinder(radius, rod, mass, bore=0.09))
    return cp.Engine.from_lists(
        each,
        tdc_deg=rng.uniform(0, 360, count).round(3),
        bank_deg=rng.choice([60.0, 90.0, 120.0], count),
        z=np.cumsum(rng.uniform(0.05, 0.15, count)),
        rotating_mass=rng.uniform(0.0, 0.5, count),
    )


def fired(engine: cp.Engine) -> cp.Engine:
    order = engine.firing_schedules("-".join(map(str, np.argsort(engine.tdc_deg) + 1)))[0]
    return engine.replace(firing_order=order.firing_order).with_cycle(cp.Cycle.example())


@in_turn("seed", range(12))
def test_infinite_rods_are_the_limit_of_long_ones(seed: int) -> None:
    engine = random_engine(np.random.default_rng(seed))
    engine = fired(engine) if seed % 2 else engine
    both = engine, long_rods(engine)
    size = sum(one.reciprocating_mass * one.crank_radius for one in engine.cylinders)
    size *= (2.0 * math.pi * 50.0) ** 2
    orders = [0.5, 1, 1.5, 2, 3, 4, 6] if engine.fired else [1, 2, 3, 4, 6, 8]

    def near(results: list[np.ndarray], scale: float) -> bool:
        found, expected = results
        return bool((abs(found - expected) <= WITHIN * scale).all())

    balances = [each.balance(3000, orders=orders) for each in both]
    waves = [each.waveform(3000) for each in both]
    whole = [each.balance(3000) for each in both]
    for name in ("force", "moment"):
        assert near([getattr(each, name).xy for each in balances], size)
        assert near([getattr(each, name) for each in waves], size)
        assert near([getattr(each.total, name).peak_xy for each in whole], size)
    for name in ("torque", "crank_torque"):
        assert near([getattr(each, name).phasor for each in balances], size)
        assert near([getattr(each, name) for each in waves], size)
    loads = [cp.bearing_loads(each, 3000) for each in both]
    for name in ("crankpin", "main", "wrist_pin", "side_thrust", "rod_force"):
        scale = max(size, abs(getattr(loads[1], name)).max())  # gas presses harder
        assert near([getattr(each, name) for each in loads], scale), name
    swept = [cp.sweep(each, rpm=[1000, 3000], orders=[1, 2, 4]) for each in both]
    assert near([each.force.xy for each in swept], size)


def test_a_yoke_is_a_free_body() -> None:
    """Force, torque and energy of one piston from x = r cos θ alone."""
    engine = cp.Engine.inline(YOKE, throws_deg=[0], spacing=0.1)
    theta = np.radians(np.arange(0.0, 360.0, 7.5))
    speed = 2.0 * np.pi * 3000 / 60.0
    size = 0.5 * 0.045 * speed**2
    wave = engine.waveform(3000, theta_deg=np.degrees(theta))
    np.testing.assert_allclose(wave.force[:, 1], size * np.cos(theta), atol=1e-12 * size)
    np.testing.assert_allclose(wave.force[:, 0], 0.0, atol=1e-12 * size)
    # Power into the piston is the change of its kinetic energy, ½ m (r ω sin θ)².
    power = size * 0.045 * np.sin(theta) * np.cos(theta)
    np.testing.assert_allclose(wave.crank_torque, -power, atol=1e-12 * size)
    np.testing.assert_allclose(wave.torque, power, atol=1e-12 * size)
    loads = cp.bearing_loads(engine, 3000, theta_deg=np.degrees(theta))
    np.testing.assert_allclose(loads.side_thrust, 0.0, atol=1e-12 * size)
    # On a crankpin that carries nothing across the bore, the arm of the torque is r sin θ.
    along = loads.crankpin[..., 1].reshape(theta.shape)
    np.testing.assert_allclose(along * -0.045 * np.sin(theta), -power, atol=1e-12 * size)
    assert engine.balance(3000).orders == (1, 2)
    assert engine.balance(3000).total.force.peak == pytest.approx(size, rel=1e-14)


@in_turn("seed", range(6))
def test_all_higher_orders_are_proved_zero(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 5))
    engine = cp.Engine.vee(
        YOKE,
        bank_angle_deg=int(rng.integers(0, 181)),
        throws_deg=rng.integers(0, 360, count).tolist(),
        spacing=0.1,
    )
    proof = engine.vanishing_orders()
    for quantity in (proof.force, proof.moment):
        assert set(quantity.remaining) <= {1}
        assert set(range(2, 13)) <= set(quantity.vanishing)
    assert set(proof.torque.remaining) <= {2}
    assert {1, *range(3, 13)} <= set(proof.torque.vanishing)
    for form in (engine.closed_form(4, "force"), engine.closed_form(4, "moment")):
        assert str(form.peak) == "0"


def test_files_keep_infinite_rods(tmp_path: Path) -> None:
    dummy = YOKE.replace(rod_length=0.15, reciprocating_mass=0.3)
    for each in (YOKE, [YOKE, dummy]):
        throws = [0] if each is YOKE else [0, 180]
        engine = cp.Engine.inline(each, throws_deg=throws, spacing=0.1)
        for file in (tmp_path / "yoke.toml", tmp_path / "yoke.json"):
            engine.save(file)
            assert cp.Engine.load(file) == engine
        assert pickle.loads(pickle.dumps(engine)) == engine  # noqa: S301 - its own
    assert "rod_length = inf" in (tmp_path / "yoke.toml").read_text()
    text = (tmp_path / "yoke.json").read_text()
    parts = json.loads(text)["placements"][0]["cylinder"]
    assert parts["rod_length"] is None
    with pytest.raises(cp.InputError, match="rod_length"):
        cp.Engine.from_json(text.replace('"rod_length": null,', ""))


def test_pages_and_pictures_draw_a_yoke() -> None:
    engine = cp.Engine.inline(YOKE, throws_deg=[0], spacing=0.1)
    found = figures(engine, 3000.0, spectrum=None)
    json.dumps(found, allow_nan=False)  # which JavaScript reads
    assert found["rod_ratio"] == 0.0
    (cylinder,) = found["cylinders"]
    assert cylinder["yoke"]
    assert cylinder["rod_length"] == pytest.approx(4 * 0.045)


def test_sweeps_reach_infinite_rods() -> None:
    i2 = cp.Engine.inline(YOKE.replace(rod_length=0.15), throws_deg=[0, 180], spacing=0.1)
    sweep = cp.sweep(i2, rpm=3000, rod_ratio=[0.0, LONG, 0.3], orders=[1, 2, 4])
    peaks = sweep.force.peak.reshape(3, 3)
    assert peaks[0].tolist() == [0.0, 0.0, 0.0]
    assert abs(peaks[1] - peaks[0]).max() <= WITHIN * peaks[2, 1]
    at = sweep.engine_at(rod_ratio=0.0)
    assert at.cylinders == (YOKE, YOKE)
    np.testing.assert_array_equal(cp.slider_crank_harmonics([0.0], [1, 2, 3]), [[1.0, 0.0, 0.0]])


@pytest.mark.parametrize("changes", [{"pin_offset": 0.01}, {"rod_inertia_excess": -1e-3}])
def test_an_infinite_rod_never_leans(changes: dict[str, float]) -> None:
    (name,) = changes
    with pytest.raises(cp.InputError, match=rf"{name} = .*an infinite rod never leans"):
        YOKE.replace(**changes)
    for length in (-math.inf, math.nan):
        with pytest.raises(cp.InputError, match="rod_length"):
            YOKE.replace(rod_length=length)
