"""What do deviating parts leave of an engine's balance?"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import labels
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import tolerances as rederived
from support import html_of, in_turn

if TYPE_CHECKING:
    from numpy.typing import NDArray

RPM = 6000
OMEGA = RPM * 2.0 * np.pi / 60.0
V6 = cp.Engine.preset("v6-60").replace(rotating_mass=0.4)
I6 = cp.Engine.preset("i6")
SPREADS: dict[str, Any] = {
    "reciprocating_mass": 0.005,
    "rotating_mass": 0.01,
    "crank_radius": 5e-5,
    "pin_deg": 0.2,
    "z": 3e-4,
    "rod_length": 2e-4,
}
NONE: dict[str, Any] = {"reciprocating_mass": 1e-30}
"""A spread that changes no mass by a unit in its last place."""
QUANTITIES = ("force", "moment", "torque", "crank_torque")


def tolerances(engine: cp.Engine = V6, **changes: object) -> cp.results.Tolerances:
    arguments: dict[str, Any] = (
        {"rpm": RPM, "orders": [1, 2, 4, 6], "samples": 500} | SPREADS | changes
    )
    return cp.tolerances(engine, **arguments)


def per_cylinder(t: cp.results.Tolerances, name: str) -> NDArray[np.float64]:
    draws = t.draws(name)
    if name in ("crank_radius", "pin_deg"):
        places = [next(k for k, pin in enumerate(t.pins) if n in pin) for n in range(1, 7)]
        return draws[:, places]
    return draws


# --- samples ------------------------------------------------------------------------------------


@pytest.mark.parametrize("distribution", ["normal", "uniform"])
@pytest.mark.parametrize(
    "engine",
    [
        V6,
        cp.Engine.preset("v8-crossplane").replace(rotating_mass=0.5),
        # Rotating masses deviate below zero.
        V6.replace(rotating_mass=0.0),
        V6.replace(cylinder=[c.replace(pin_offset=1e-3) for c in V6.cylinders]),
        V6.replace(cylinder=[c.replace(rod_inertia_excess=-1e-3) for c in V6.cylinders]),
        cp.Engine.preset("single").replace(
            rotating_mass=0.3,
            counterweights=[
                cp.Unbalance(0.01, z=0, angle_deg=175, pin=1),
                cp.Unbalance(0.01, z=0.1),
            ],
            shafts=[cp.Shaft(-1, [cp.Unbalance(0.004, z=0.1)], x=0.1)],
        ),
    ],
    ids=["v6", "shared pins", "balanced throws", "offset", "rods", "weights"],
)
def test_a_sample_is_an_engine(engine: cp.Engine, distribution: str) -> None:
    t = tolerances(engine, distribution=distribution, samples=20)
    for k in (0, 7, 19):
        drawn = t.engine_at(k)
        known = drawn.replace(reference_z=engine.reference_z).balance(RPM, orders=t.orders)
        for name in QUANTITIES:
            found, expected = np.asarray(getattr(t, name))[k], np.asarray(getattr(known, name))
            # Rounding of some twenty terms of the size of the largest order.
            scale = max(abs(np.asarray(known.force)).max(), abs(expected).max())
            assert abs(found - expected).max() <= 1e-12 * scale
            peak = getattr(t.total, name).peak[k]
            assert peak == pytest.approx(getattr(known.total, name).peak, rel=1e-11)


def test_samples_agree_with_the_rederivation_given_the_same_draws() -> None:
    t = tolerances()
    cylinders = V6.cylinders
    nominal = rederived.Nominal(
        np.array([c.crank_radius for c in cylinders]),
        np.array([c.rod_length for c in cylinders]),
        np.array([c.reciprocating_mass for c in cylinders]),
        V6.rotating_mass,
        V6.tdc_deg,
        V6.bank_deg,
        V6.z,
    )
    draws = {name: per_cylinder(t, name) for name in SPREADS}
    orders = [int(order) for order in t.orders]
    known = rederived.remains(nominal, draws, RPM, orders, V6.reference_z)
    pairs = [
        (t.force.forward, known.force_forward),
        (t.force.backward, known.force_backward),
        (t.moment.forward, known.moment_forward),
        (t.moment.backward, known.moment_backward),
        (t.torque.phasor, known.roll),
    ]
    for found, expected in pairs:
        # Sums of six terms of some 20 kN lose as much to rounding.
        assert abs(found - expected).max() <= 1e-12 * max(abs(expected).max(), 1e3)
    totals = t.total
    for peak, longest in [
        (totals.force.peak, known.force_peak),
        (totals.moment.peak, known.moment_peak),
        (totals.torque.peak, known.roll_peak),
    ]:
        # Newton's method is right to rounding; the rederivation polishes three peaks of each.
        np.testing.assert_allclose(peak, longest, rtol=1e-11)


@in_turn("name", cp.presets())
def test_without_deviations_a_sample_is_the_nominal_balance(name: str) -> None:
    engine = cp.Engine.preset(name).with_cycle(None)
    t = cp.tolerances(engine, rpm=100, orders=[1, 2, 3, 4], samples=2, **NONE)
    known = engine.balance(100, orders=[1, 2, 3, 4])
    for quantity in QUANTITIES:
        samples, nominal = getattr(t, quantity), getattr(known, quantity)
        assert np.array_equal(np.asarray(samples)[1], np.asarray(nominal))
        assert np.array_equal(samples.peak[1], nominal.peak)
        assert getattr(t.total, quantity).peak[1] == getattr(known.total, quantity).peak
    for quantity in ("force", "moment"):
        samples, nominal = getattr(t, quantity), getattr(known, quantity)
        assert np.array_equal(samples.forward[1], nominal.forward)
        assert np.array_equal(samples.backward[1], nominal.backward)
        total = getattr(t.total, quantity).peak_xy[1]
        assert np.array_equal(total, getattr(known.total, quantity).peak_xy)


@pytest.mark.parametrize("distribution", ["normal", "uniform"])
def test_draws_are_those_of_numpys_generators(distribution: str) -> None:
    t = tolerances(seed=12345, samples=30, distribution=distribution)
    for stream, name in enumerate(SPREADS):
        draws = t.draws(name)
        random = np.random.default_rng(np.random.SeedSequence(12345, spawn_key=(stream,)))
        if distribution == "normal":
            expected = random.standard_normal(draws.shape)
        else:
            expected = 2.0 * random.random(draws.shape) - 1.0
        assert np.array_equal(draws, expected * SPREADS[name])


def test_a_seed_may_be_a_sequence_or_a_generator() -> None:
    sequence = np.random.SeedSequence(7)
    assert tolerances(seed=sequence, samples=3) == tolerances(seed=sequence, samples=3)
    one, two = np.random.default_rng(7), np.random.default_rng(7)
    first = tolerances(seed=one, samples=3)
    assert first == tolerances(seed=two, samples=3)
    assert first.seed != tolerances(seed=one, samples=3).seed
    assert first == tolerances(seed=first.seed, samples=3)


def test_samples_depend_on_nothing_but_seed_and_number() -> None:
    t = tolerances(samples=300)
    for other in (tolerances(samples=1000), tolerances(samples=300, torque=False)):
        assert np.array_equal(t.force.xy, other.force.xy[:300])
        assert np.array_equal(t.total.moment.peak, other.total.moment.peak[:300])
    assert not np.array_equal(t.force.xy, tolerances(samples=300, seed=1).force.xy)
    alone = cp.tolerances(V6, rpm=RPM, pin_deg=0.2, samples=300)
    assert np.array_equal(alone.draws("pin_deg"), t.draws("pin_deg"))
    assert not alone.draws("z").any()


# --- laws ---------------------------------------------------------------------------------------


def test_a_spread_of_masses_makes_forces_of_known_variance() -> None:
    """Independent masses δm: E|Σ ½·a₁·r·ω²·δm·e^{iφ}|² = Σ(½·r·ω²·σ)², whatever the angles."""
    t = tolerances(
        I6, samples=20_000, **dict.fromkeys(SPREADS, 0.0) | {"reciprocating_mass": 0.005}
    )
    single = 0.5 * I6.cylinders[0].crank_radius * OMEGA**2 * 0.005
    for part in (t[1].force.forward, t[1].force.backward):
        # Of 20 000 squares of two normal numbers each: 1 % is 1.4 standard deviations or more.
        assert np.mean(abs(part) ** 2) == pytest.approx(6 * single**2, rel=0.03)
    levers = I6.z - I6.reference_z
    known = (levers**2).sum() * single**2
    assert np.mean(abs(t[1].moment.forward) ** 2) == pytest.approx(known, rel=0.03)
    # An inline-6 has equal moments of both directions: a line, whose length is Rayleigh's.
    from scipy import stats  # of a third of a second

    expected = stats.rayleigh.ppf(0.95, scale=np.sqrt(3.0) * single)
    assert t.quantile(0.95, by="[1].force.forward") == pytest.approx(expected, rel=0.02)


def test_a_spread_of_pins_turns_what_follows_them() -> None:
    """To first order δ turns a phasor by nδ: its change is i·n·δ times it."""
    t = tolerances(I6, samples=20_000, **dict.fromkeys(SPREADS, 0.0) | {"pin_deg": 0.05})
    cylinder = I6.cylinders[0]
    for place, order in enumerate(t.orders):
        amplitude = abs(cylinder.harmonics([order])[0]) * cylinder.reciprocating_mass
        single = 0.5 * amplitude * cylinder.crank_radius * OMEGA**2 * order * np.radians(0.05)
        nominal = t.nominal.force.forward[place]
        spread = np.mean(abs(t.force.forward[:, place] - nominal) ** 2)
        # Of 20 000 squares; second powers of nδ ≤ 0.005.
        assert spread == pytest.approx(6 * single**2, rel=0.04)


@pytest.mark.parametrize(
    ("name", "affected"), [("z", {"moment"}), ("rotating_mass", {"force", "moment"})]
)
def test_what_a_figure_cannot_touch_stays(name: str, affected: set[str]) -> None:
    t = tolerances(**dict.fromkeys(SPREADS, 0.0) | {name: SPREADS[name]}, samples=50)
    for quantity in QUANTITIES:
        changed = not np.array_equal(
            np.asarray(getattr(t, quantity)),
            np.broadcast_to(np.asarray(getattr(t.nominal, quantity)), getattr(t, quantity).shape),
        )
        assert changed == (quantity in affected)
    # What turns with the crankpins has no backward part.
    assert not name.startswith("rotating") or np.array_equal(
        t.moment.backward, np.broadcast_to(t.nominal.moment.backward, t.moment.backward.shape)
    )


@settings(max_examples=20, deadline=None)
@given(factor=st.floats(0.1, 10.0), seed=st.integers(0, 2**64 - 1))
def test_what_remains_is_linear_in_masses_and_goes_with_the_square_of_speed(
    factor: float, seed: int
) -> None:
    none = dict.fromkeys(SPREADS, 0.0)
    one = tolerances(I6, **none | {"reciprocating_mass": 1e-3}, seed=seed, samples=5)
    more = tolerances(I6, **none | {"reciprocating_mass": 1e-3 * factor}, seed=seed, samples=5)
    np.testing.assert_allclose(
        more[1].force.xy, factor * np.asarray(one[1].force.xy), rtol=1e-9, atol=1e-9
    )
    fast = tolerances(I6, **none | {"reciprocating_mass": 1e-3}, seed=seed, samples=5, rpm=2 * RPM)
    np.testing.assert_allclose(fast[1].force.xy, 4.0 * one[1].force.xy, rtol=1e-12, atol=1e-9)


def test_turning_the_engine_turns_the_samples() -> None:
    t, turned = tolerances(), tolerances(V6.with_first_tdc(40))
    np.testing.assert_allclose(t.moment.peak, turned.moment.peak, rtol=1e-9)
    np.testing.assert_allclose(
        t[1].force.forward * np.exp(1j * np.radians(-40.0)),
        turned[1].force.forward,
        atol=1e-9 * OMEGA,
    )


def test_pins_that_cylinders_share_deviate_together() -> None:
    shared = cp.Engine.preset("v8-crossplane")

    def pins(engine: cp.Engine) -> tuple[tuple[int, ...], ...]:
        return cp.tolerances(engine, rpm=RPM, samples=1, **NONE).pins

    assert pins(shared) == ((1, 2), (3, 4), (5, 6), (7, 8))
    assert pins(I6) == tuple((n,) for n in range(1, 7))
    radial = cp.Engine.from_lists(
        shared.cylinders[0], bank_deg=[90, 162, 234, 306, 18], pin_deg=[0] * 5, z=[0] * 5
    )
    assert pins(radial) == ((1, 2, 3, 4, 5),)
    two_throws = cp.Engine.flat(
        shared.cylinders[0], throws_deg=[0, 0], spacing=0.1, bank_stagger=0.02
    )
    assert pins(two_throws) == ((1, 2), (3, 4))
    # Pins of one's own, where the maker has them.
    t = cp.tolerances(shared, rpm=RPM, samples=4, pin_deg=0.1, pins=[[n] for n in range(1, 9)])
    assert t.draws("pin_deg").shape == (4, 8)


def test_pins_that_only_rounding_parts_may_be_named_together() -> None:
    def vee(second_tdc: float) -> cp.Engine:
        return cp.Engine.from_lists(
            V6.cylinders[0], tdc_deg=[0.1, second_tdc], bank_deg=[45.7, 135.7], z=[0, 0.02]
        )

    turned, elsewhere = vee(90.1 + 3e-10), vee(0.1)
    given: dict[str, Any] = {"rpm": RPM, "samples": 1, "pin_deg": 0.1}
    (shared,) = cp.tolerances(turned, **given).pins
    assert turned.pin_deg[0] != turned.pin_deg[1]
    assert cp.tolerances(turned, **given, pins=[shared]).pins == (shared,)
    with pytest.raises(cp.InputError, match="do not point the same way"):
        cp.tolerances(elsewhere, **given, pins=[[1, 2]])


def test_spreads_may_differ_between_cylinders_and_pins() -> None:
    t = cp.tolerances(
        V6, rpm=RPM, reciprocating_mass=[0, 0.01, 0, 0, 0, 0], pin_deg=[0.1] * 5 + [0], samples=50
    )
    assert np.flatnonzero(t.draws("reciprocating_mass").any(axis=0)).tolist() == [1]
    assert not t.draws("pin_deg")[:, 5].any()
    assert t.spreads["reciprocating_mass"] == (0, 0.01, 0, 0, 0, 0)


# --- statistics ---------------------------------------------------------------------------------


def test_orders_that_the_nominal_engine_cancels_are_kept() -> None:
    t = cp.tolerances(I6, rpm=RPM, reciprocating_mass=0.002, samples=200)
    assert {1, 2, 4} <= set(t.orders)
    assert not t.nominal.force.peak[:2].any()
    assert t.force.peak[:, :2].all()
    # Of one cylinder 1e-4 of m·r·ω² may be left out, of six at most six times that.
    cylinder = I6.cylinders[0]
    scale = cylinder.reciprocating_mass * cylinder.crank_radius * OMEGA**2
    assert 0.0 < t.error_bound["force"] <= 6e-4 * scale


@in_turn("seed", range(12))
def test_what_is_left_out_is_within_its_bound_cylinder_by_cylinder(seed: int) -> None:
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 7))
    engine = cp.Engine.from_lists(
        [
            cp.Cylinder(
                random.uniform(0.02, 0.06),
                random.uniform(0.09, 0.2),
                random.uniform(0.2, 0.9),
                pin_offset=random.uniform(-0.01, 0.01),
                rod_inertia_excess=random.uniform(-2e-4, 2e-4),
            )
            for _ in range(count)
        ],
        tdc_deg=random.uniform(0, 360, count),
        bank_deg=random.uniform(0, 360, count),
        z=random.uniform(-0.3, 0.3, count),
    )
    rtol = 10.0 ** random.uniform(-6, -1)
    t = cp.tolerances(engine, rpm=RPM, rotating_mass=0.001, samples=2, rtol=rtol)
    every = engine.balance(RPM, orders=range(1, 200))
    left = [k for k, order in enumerate(every.orders) if order not in t.orders]
    for name in ("force", "moment", "torque", "crank_torque"):
        peak = getattr(every, name).peak[left].sum()
        # The sum of what is left out as if it peaked together; rounding of some 200 orders.
        assert peak <= t.error_bound[name] * (1 + 1e-9) + 1e-9
    for cylinder in engine.cylinders:
        alone = cp.Engine.from_lists(cylinder, bank_deg=[90], tdc_deg=[0], z=[0])
        kept = alone.balance(RPM, orders=t.orders)
        exact = alone.balance(RPM, rtol=1e-12)
        scale = cylinder.reciprocating_mass * cylinder.crank_radius * OMEGA**2
        lost = exact.force.peak.sum() - kept.force.peak.sum()
        assert lost <= (rtol + 1e-9) * scale


@pytest.mark.parametrize("orders", [(2,), (2, 4), (3,)])
def test_any_orders_can_be_asked_for(orders: tuple[int, ...]) -> None:
    every = tolerances(orders=(1, 2, 3, 4))
    few = tolerances(orders=orders)
    for n in orders:
        for name in ("force", "moment", "torque"):
            ours, theirs = (getattr(t[n], name).peak for t in (few, every))
            np.testing.assert_allclose(ours, theirs, rtol=1e-13, atol=1e-13 * theirs.max())


def test_statistics_are_those_of_the_values() -> None:
    t = tolerances(by=["[1].moment.backward", "total.force.peak"])
    values = t.sample_values()
    assert np.array_equal(values, abs(t[1].moment.backward))
    assert t.sample_values("total.force.peak") is not values
    # The mean is that of differences from the first: some roundings of 1.1e-16.
    assert t.mean_value() == pytest.approx(values.mean(), rel=1e-14)
    assert t.std() == pytest.approx(values.std(), rel=1e-14)
    assert np.array_equal(t.quantile([0.1, 0.9]), np.quantile(values, [0.1, 0.9]))
    assert t.nominal_value("total.moment.peak") == t.nominal.total.moment.peak
    table = t.table
    assert [column.values[0] for column in table.columns] == [
        "[1].moment.backward", "N·m", t.nominal_value(), t.mean_value(), t.std(),
        *np.quantile(values, [0.05, 0.5, 0.95]),
    ]  # fmt: skip
    assert "standard deviations: reciprocating mass 0.005 kg" in repr(t)
    assert "<table>" in html_of(t)


def test_shares_add_up_where_what_remains_is_linear() -> None:
    t = tolerances(I6, samples=4000, by=["[1].force.forward", "[1].force.backward"])
    shares = t.shares
    # Rayleigh's variance goes with the sum of squares; 4000 samples tell it to 2 %.
    assert (abs(np.array(shares["interaction"].values)) < 8).all()
    by_name = {name: shares[labels.TOLERANCES[name][0]].values for name in SPREADS}
    assert by_name["z"] == (0.0, 0.0)
    assert by_name["rotating_mass"][1] == 0.0
    cylinder = I6.cylinders[0]
    parts = {
        "reciprocating_mass": 0.005 / 2,
        "rotating_mass": 0.01,
        "crank_radius": cylinder.reciprocating_mass / 2 * 5e-5 / cylinder.crank_radius,
        "pin_deg": cylinder.reciprocating_mass / 2 * np.radians(0.2),
    }
    total = sum(part**2 for part in parts.values())
    for name, part in parts.items():
        assert by_name[name][0] == pytest.approx(100 * part**2 / total, abs=5)
    assert "interaction %" in repr(shares)
    second = t.shares_of("[1].force.backward")
    assert [each.values for each in second.columns] == [each.values[1:] for each in shares.columns]
    table = shares.to_pandas().drop(columns="")
    assert table.sum(axis=1).round(10).tolist() == [100.0, 100.0]


def test_exports_have_all_samples() -> None:
    t = tolerances(samples=20)
    data = t.to_xarray()
    assert data.force_peak.dims == ("sample", "order")
    assert np.array_equal(data.moment_total_peak, t.total.moment.peak)
    assert data.attrs["seed"] == 0
    table = t.tidy("force")
    assert len(table) == 20 * 4 * 4
    assert {"sample", "order", "component", "peak", "unit"} <= set(table)


def test_results_are_values() -> None:
    t = tolerances(samples=10)
    again = pickle.loads(pickle.dumps(t))  # noqa: S301 - its own
    assert again == t
    assert hash(again) == hash(t)
    assert np.array_equal(again.force.xy, t.force.xy)
    assert t != tolerances(samples=11)
    assert pickle.loads(pickle.dumps(t.shares)) == t.shares  # noqa: S301 - its own
    with pytest.raises(AttributeError):
        t.by = ()  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        t.force.xy[0] = 0


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    tolerances(samples=5000, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 1


# --- errors -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"reciprocating_mass": -0.1}, r"reciprocating_mass = -0.1: give a spread that is zero"),
        ({"pin_deg": np.nan}, r"pin_deg = nan: give a spread"),
        ({"z": [1e-3, 1e-3]}, r"z has 2 entries, the engine has 6 cylinders: give one number, or"),
        ({"crank_radius": [0.0] * 5}, r"crank_radius has 5 entries, the engine has 6 crankpins"),
        ({"rod_length": "long"}, r"rod_length = 'long': give numbers"),
        ({"reciprocating_mass": 0.3}, r"reciprocating_mass = 0.3: a draw may take more than the"),
        ({"rod_length": 0.1}, r"rod_length = 0.1: a draw may keep the crank of cylinder 1 from"),
        ({"pin_deg": 60}, r"pin_deg = 60.0: a draw may exceed half a turn; give 14.634 at most"),
        ({"distribution": "cauchy"}, r"distribution = 'cauchy': give \"normal\" or \"uniform\""),
        ({"samples": 0}, r"samples = 0: give 1 to"),
        ({"samples": 10**30}, "samples = 10+: give 1 to 10+"),
        ({"samples": 10**9}, r"samples: the result would take .* bytes"),
        ({"samples": 2.5}, r"samples = 2.5: give a whole number"),
        ({"seed": -1}, r"seed = -1: give a whole number, 0 to 2\*\*64 - 1"),
        (
            {"by": "[3].force.peak"},
            r"orders = \[1, 2, 4, 6\]: by = \"\[3\].force.peak\" needs order 3",
        ),
        ({"by": "unevenness_deg"}, r"by = 'unevenness_deg': has no value for each sample"),
        ({"by": "total.torque.peak", "torque": False}, r"torque is not available: it was not"),
        ({"pins": [[1, 2], [3, 4]]}, r"pins = .*: name each cylinder once"),
        (
            {"pins": [[1, 2], [3], [4], [5], [6]]},
            r"the crankpins of cylinders \(1, 2\) do not point",
        ),
        ({"rpm": -1}, r"rpm = -1"),
    ],
)
def test_errors_name_the_argument(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        tolerances(**changes)


def test_errors_of_results() -> None:
    t = tolerances(samples=3)
    with pytest.raises(cp.InputError, match=r"^point is .*: moments of samples .* engine\.replace"):
        t.about(0.1)
    with pytest.raises(cp.InputError, match="sample = 3: give a number from 0 to 2"):
        t.engine_at(3)
    with pytest.raises(cp.InputError, match=r"name = 'mass': give \"reciprocating_mass\""):
        t.draws("mass")
    with pytest.raises(cp.InputError, match="q = 2: give numbers from 0 to 1"):
        t.quantile(2)
    with pytest.raises(cp.InputError, match=r"give a crankpin\.Engine"):
        cp.tolerances("v6", rpm=1)  # type: ignore[arg-type]


def test_quantiles_have_the_shape_of_what_was_asked() -> None:
    t = tolerances(samples=3)
    assert t.quantile([]).shape == (0,)
    assert t.quantile([[]]).shape == (1, 0)
    assert t.quantile([[0.1, 0.9]]).shape == (1, 2)


def test_nothing_varies_where_nothing_deviates() -> None:
    t = cp.tolerances(cp.Engine.preset("v6-60"), rpm=RPM, samples=7, **NONE)
    for name in t.by:
        assert (t.mean_value(name), t.std(name)) == (t.nominal_value(name), 0.0)
    assert {column.values for column in t.shares.columns[1:]} == {(0.0,) * len(t.by)}


@pytest.mark.parametrize("given", [{}, {"pin_deg": 0}, {"z": [0.0] * 6}])
def test_some_part_must_deviate(given: dict[str, Any]) -> None:
    with pytest.raises(cp.InputError, match="no part deviates; give a spread, recip"):
        cp.tolerances(I6, rpm=RPM, **given)
