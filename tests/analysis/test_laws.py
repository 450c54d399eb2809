"""Do the laws hold that must hold for any engine? Through the Python surface, by hypothesis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

RPM = 3000.0
OMEGA_SQUARED = (2 * np.pi * RPM / 60) ** 2
ORDERS = (1, 2, 3, 4, 6)

angles = st.one_of(
    st.integers(0, 23).map(lambda k: 15 * k),
    st.integers(0, 6).map(lambda k: f"{360 * k}/7"),
    st.floats(0, 360),
)
cylinders = st.builds(
    lambda radius, rod, mass, offset: cp.Cylinder(radius, radius * rod, mass, radius * offset),
    st.floats(0.02, 0.2),
    st.floats(1.8, 6),
    st.floats(0.1, 3),
    st.floats(-0.5, 0.5),
)


@st.composite
def engines(draw: st.DrawFn) -> cp.Engine:
    count = draw(st.integers(1, 8))
    each: dict[str, Any] = {"min_size": count, "max_size": count}
    return cp.Engine.from_lists(
        draw(st.lists(cylinders, **each)),
        tdc_deg=draw(st.lists(angles, **each)),
        bank_deg=draw(st.lists(angles, **each)),
        z=draw(st.lists(st.floats(-0.5, 0.5), **each)),
        rotating_mass=draw(st.lists(st.just(0.0) | st.floats(1e-30, 2), **each)),
    )


def size(engine: cp.Engine) -> float:
    """What rounding is relative to: Σ m r ω² (1 + |z|)."""
    masses = np.array([c.reciprocating_mass for c in engine.cylinders]) + engine.rotating_mass
    radii = np.array([c.crank_radius for c in engine.cylinders])
    return float((masses * radii * (1 + np.abs(engine.z))).sum() * OMEGA_SQUARED)


def same(found: ArrayLike, expected: ArrayLike, scale: float) -> None:
    # phases of order 6 of angles up to 1024°: 6 · 1.1e-13° is 1.2e-14 rad; eight terms, ten allowed
    assert np.abs(np.asarray(found) - np.asarray(expected)).max() <= 2e-13 * scale


def of(engine: cp.Engine, reference_z: float = 0.0) -> cp.results.Balance:
    return engine.replace(reference_z=reference_z).balance(RPM, orders=ORDERS)


@settings(max_examples=60, deadline=None)
@given(engine=engines(), factor=st.floats(0.01, 1))
def test_force_goes_with_the_square_of_speed(engine: cp.Engine, factor: float) -> None:
    faster = engine.replace(reference_z=0.0).balance(RPM * factor, orders=ORDERS)
    same(faster.force, of(engine).force * factor**2, size(engine) * factor**2)
    same(faster.torque, of(engine).torque * factor**2, size(engine) * factor**2)


@settings(max_examples=60, deadline=None)
@given(engine=engines(), by=st.floats(0, 360))
def test_turning_the_engine_turns_the_result(engine: cp.Engine, by: float) -> None:
    turned = of(engine.replace(tdc_deg=engine.tdc_deg, bank_deg=engine.bank_deg + by))
    turn = np.exp(1j * np.radians(by))
    same(turned.moment.forward, of(engine).moment.forward * turn, size(engine))
    same(turned.moment.backward, of(engine).moment.backward * turn, size(engine))


@settings(max_examples=60, deadline=None)
@given(engine=engines(), data=st.data())
def test_relabelling_changes_nothing(engine: cp.Engine, data: st.DataObject) -> None:
    order = data.draw(st.permutations(range(len(engine))))
    relabelled = cp.Engine.from_lists(
        [engine.cylinders[k] for k in order],
        tdc_deg=engine.tdc_deg[list(order)],
        bank_deg=engine.bank_deg[list(order)],
        z=engine.z[list(order)],
        rotating_mass=engine.rotating_mass[list(order)],
    )
    same(of(relabelled).moment, of(engine).moment, size(engine))
    same(of(relabelled).torque, of(engine).torque, size(engine))


def test_another_point_takes_the_moment_of_the_force_off() -> None:
    """M′ = M − a × F with a = (x, y, z − z₀); also of sweeps, their totals and waveforms."""
    engine = cp.Engine.preset("v6-90-odd-fire").replace(rotating_mass=0.5)
    x, y, z = 0.3, -0.2, 0.7
    s = cp.sweep(engine, rpm=[1000.0, 3000.0], orders=range(1, 13))
    here, there = s.sel(rpm=3000.0), s.about((x, y, z)).sel(rpm=3000.0)
    by = z - engine.reference_z
    force, moment = here.force, here.moment
    same(there.moment.x, moment.x + by * force.y, 2 * size(engine))
    same(there.moment.y, moment.y - by * force.x, 2 * size(engine))
    expected = here.torque - (x * force.y - y * force.x)
    same(there.torque, expected, 2 * size(engine))
    assert here.force.any()
    alone = engine.balance(3000.0, orders=s.orders).about([x, y, z])
    same(alone.torque, expected, 2 * size(engine))
    theta = np.arange(0.0, 360.0, 0.5)
    w = s.about((x, y, z)).waveform(theta).torque[1]
    turned = np.exp(1j * np.deg2rad(theta)[:, np.newaxis] * np.array(s.orders))
    same(w, (turned * expected).sum(axis=1).real, 2 * size(engine))
    # Sampled at half degrees: within half the square of half a step at order 12.
    assert there.total.torque.peak == pytest.approx(np.abs(w).max(), rel=0.5 * 0.06**2)
    assert there.total.torque.peak == s.about((x, y, z)).total.torque.peak[1]
    for point in ("x", (1, 2), np.nan, [1, 2, np.inf], range(10**12)):
        with pytest.raises(cp.InputError, match="point"):
            here.about(point)
    assert here.about(z=z) == here.about(z) == here.about((0.0, 0.0, z))
    for mistake, named in (
        ({}, "z = None: give one of point=…, z=…"),
        ({"point": z, "z": z}, "give one of point=…, z=…"),
        ({"z": "x"}, "z = 'x'"),
    ):
        with pytest.raises(cp.InputError, match=named):
            here.about(**mistake)


@settings(max_examples=60, deadline=None)
@given(engine=engines(), by=st.floats(-1, 1))
def test_moving_the_plane_adds_force_times_distance(engine: cp.Engine, by: float) -> None:
    here, there = of(engine), of(engine, reference_z=by)
    shift = np.stack([here.force.xy[:, 1], -here.force.xy[:, 0]], axis=1) * by
    same(there.moment, here.moment + shift, 2 * size(engine))


@settings(max_examples=60, deadline=None)
@given(engine=engines())
def test_a_mirror_swaps_and_conjugates(engine: cp.Engine) -> None:
    still = engine.replace(rotating_mass=0.0)
    mirrored = of(still.replace(tdc_deg=still.tdc_deg, bank_deg=180 - still.bank_deg))
    same(mirrored.force.forward, -of(still).force.backward.conj(), size(engine))
    same(mirrored.force.backward, -of(still).force.forward.conj(), size(engine))


@settings(max_examples=60, deadline=None)
@given(engine=engines())
def test_reversing_the_crank_swaps_the_two(engine: cp.Engine) -> None:
    centred = [c.replace(pin_offset=0.0) for c in engine.cylinders]
    still = engine.replace(rotating_mass=0.0, cylinder=centred)
    reversed_ = of(still.replace(tdc_deg=-still.tdc_deg))
    same(reversed_.force.forward, of(still).force.backward, size(engine))
    same(reversed_.moment.backward, of(still).moment.forward, size(engine))


@settings(max_examples=40, deadline=None)
@given(engine=engines())
def test_parseval(engine: cp.Engine) -> None:
    """Mean square of the waveform is the sum of |forward|² + |backward|²."""
    force = engine.waveform(RPM, theta_deg=np.arange(512) * 360 / 512).force
    parts = engine.balance(RPM, orders=range(1, 121))
    total = (np.abs(parts.force.forward) ** 2 + np.abs(parts.force.backward) ** 2).sum()
    # λ ≤ 1/1.8 with e ≤ r/2: order 120 is below 1e-20 of the first
    assert abs((force**2).sum(axis=1).mean() - total) <= 1e-12 * size(engine) ** 2


@settings(max_examples=60, deadline=None)
@given(cylinder=cylinders, throws=st.lists(angles, min_size=1, max_size=5))
def test_boxer_pairs_cancel(cylinder: cp.Cylinder, throws: list[float | str]) -> None:
    engine = cp.Engine.boxer(cylinder, throws_deg=throws, spacing=0.1, rotating_mass=0.5)
    balance = of(engine, reference_z=0.03)
    assert not balance.force.any()
    assert not balance.moment.any()


@settings(max_examples=40, deadline=None)
@given(engine=engines())
def test_peaks_are_those_of_the_waveform(engine: cp.Engine) -> None:
    """No sample is higher than the true peak of the sum of orders, and a dense one is as high."""
    theta = np.linspace(0, 360, 2881)
    waveform = engine.replace(reference_z=0.0).waveform(RPM, theta_deg=theta, orders=ORDERS)
    balance = of(engine)
    for samples, peak, longest in (
        (waveform.force, balance.total.force.peak_xy, balance.total.force.peak),
        (waveform.moment, balance.total.moment.peak_xy, balance.total.moment.peak),
    ):
        rounding = 1e-12 * size(engine)
        dense = np.abs(samples).max(axis=0)
        assert np.all(dense <= peak + rounding)
        # half a step of 1/8° at order 6 (12 for the squared length): (12 · 1.1e-3)²/2 = 9e-5
        assert np.all(peak <= dense + 1e-4 * size(engine))
        length = np.hypot(*samples.T).max()
        assert length <= longest + rounding
        assert longest <= length + 1e-4 * size(engine)


QUESTIONS: dict[str, Callable[[cp.Engine], cp.results.Balance]] = {
    "balance": lambda e: e.balance(RPM, orders=(1, 2)),
    "another speed": lambda e: e.balance(2 * RPM, orders=(1, 2)),
    "other orders": lambda e: e.balance(RPM, orders=(2, 1)),
    "fewer": lambda e: e.balance(RPM, orders=(1,)),
    "chosen": lambda e: e.balance(RPM),
    "chosen of few": lambda e: e.balance(RPM, rtol=1e-2),
    "without torque": lambda e: e.balance(RPM, rtol=1e-2, torque=False),
    "another plane": lambda e: e.balance(RPM, orders=(1, 2)).about(z=0.25),
    "chosen about it": lambda e: e.balance(RPM).about(z=0.25),
    "spectrum": lambda e: e.balance(RPM, spectrum={1: 2.0, 2: 0.5}),
}


def answer(balance: cp.results.Balance) -> tuple[Any, ...]:
    """Return all that a balance says of its engine, as bits."""
    names = balance._request.quantities
    arrays = [balance.read(name, what) for name in names for what in ("values", "zero_bound")]
    totals = [balance.read(name, "total_peak") for name in names]
    bits = [np.asarray(array).tobytes() for array in (*arrays, *totals)]
    return balance.orders, balance.omitted, dict(balance.error_bound), bits


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_no_answer_depends_on_what_was_asked_before(data: st.DataObject) -> None:
    cylinder = cp.Cylinder(0.05, 0.15, 0.5, bore=0.09)
    engine = cp.Engine.preset("v6-60", cylinder=cylinder)
    kept = data.draw(
        st.sampled_from(
            [
                engine,
                engine.with_cycle(cp.Cycle.example()),
                engine.with_shafts([cp.Shaft(-2, [cp.Unbalance(0.01, z=0.1)], x=0.1)]),
                engine.with_loads([cp.PeriodicLoad("fan", on="shaft", force={4: 12}, z=-0.1)]),
            ]
        )
    )
    for name in data.draw(st.lists(st.sampled_from(list(QUESTIONS)), min_size=4, max_size=12)):
        ask = QUESTIONS[name]
        # A copy by its fields has a core of its own, which nothing was asked of.
        assert answer(ask(kept)) == answer(ask(kept.replace(name=kept.name)))
