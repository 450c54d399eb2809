"""Do the laws hold of engines with several cranks, dead cylinders and shafts, about any point?"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.contributions import contributions, phasors
from crankpin.analysis.geometry import geometry, rotating_masses, weights_on_crank
from crankpin.model.crankpins import crankpins
from support import in_turn
from support.several_cranks import Draft, fired_engine, random_engine, size

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

RPM = 3000.0
ORDERS = (1, 2, 3, 4, 6)
SEEDS = range(24)
QUANTITIES = ("force", "moment", "torque", "crank_torque")
POINT = (0.3, -0.2, 0.15)
ROUNDING = 1e-12
"""Of terms of unlike sizes, at phases known to 1e-13: far above what sums of a dozen leave."""


def same(found: cp.results.Balance, expected: cp.results.Balance, names: tuple[str, ...]) -> None:
    allowed = ROUNDING * size(expected.engine, RPM)
    for name in names:
        apart = np.abs(np.asarray(getattr(found, name)) - np.asarray(getattr(expected, name)))
        assert apart.max() <= allowed, name


# --- crankpins ------------------------------------------------------------------------------------

PAIR = """
schema = 1
cranks = [{{ x = {x}, y = 0, ratio = {ratio} }}]
placements = [
  {{ tdc_deg = 0, bank_deg = 60, z = 0 }}, {{ tdc_deg = {tdc}, bank_deg = 120, z = 0, crank = 1 }}
]
cylinder = {{ crank_radius = 0.05, rod_length = 0.15, reciprocating_mass = 0.7 }}
"""


def pair(*, x: float = 0.2, ratio: int = 1, tdc: float = 60.0) -> cp.Engine:
    return cp.Engine.from_toml(PAIR.format(x=x, ratio=ratio, tdc=tdc))


def test_a_crankpin_of_a_crank_that_turns_the_other_way() -> None:
    engine = pair(ratio=-1, tdc=30.0)
    assert engine.pin_deg.tolist() == [60.0, 150.0]
    assert engine.replace(pin_deg=[60, 150]) == engine


def test_throws_of_two_cranks_do_not_compare() -> None:
    for engine in (pair(), pair().replace(bank_deg=[90, 90])):
        for name in ("throws_deg", "pin_split_deg"):
            with pytest.raises(AttributeError, match="on 2 crankshafts"):
                getattr(engine, name)
        assert "another crankshaft: ratio +1" in repr(engine)
    crossed = cp.Engine.from_toml(pair().replace(bank_deg=[120, 60]).to_toml())
    assert (crossed.banks, crossed.bank_angle_deg) == ({"right": (2,), "left": (1,)}, 60.0)
    with pytest.raises(cp.InputError, match="it has 2 cranks; one is needed"):
        crossed.with_bank_angle(90, hold="pins")
    with pytest.raises(cp.InputError, match="it has 2 cranks; one is needed"):
        cp.sweep(crossed, rpm=3000, bank_angle_deg=[60, 90], hold="pins")


@in_turn("seed", SEEDS)
def test_pins_are_where_a_mass_on_them_pulls(seed: int) -> None:
    engine = random_engine(seed)
    still = engine.replace(rotating_mass=0.0, counterweights=(), shafts=())
    for k, radius in enumerate(each.crank_radius for each in engine.cylinders):
        masses = np.zeros(len(engine))
        masses[k] = 1.0
        pulls = [
            one.waveform(RPM, theta_deg=[0.0]).force[0]
            for one in (still, still.replace(rotating_mass=masses))
        ]
        x, y = pulls[1] - pulls[0]
        apart = math.remainder(math.degrees(math.atan2(y, x)) - engine.pin_deg[k], 360.0)
        # Differences of forces that are some times as large as that of a kilogram.
        assert abs(apart) < 1e-9 * max(1.0, size(engine, RPM) / (radius * RPM**2))


@in_turn("seed", SEEDS)
def test_pins_say_as_much_as_top_dead_centres(seed: int) -> None:
    engine = random_engine(seed, ratios=(1, -1))  # faster cranks are at TDC several times a turn
    again = engine.replace(pin_deg=[repr(pin) for pin in engine.pin_deg.tolist()])
    same(again.balance(RPM, orders=ORDERS), engine.balance(RPM, orders=ORDERS), QUANTITIES)


@in_turn("seed", SEEDS)
def test_drawings_show_pins_and_weights_where_they_pull(seed: int) -> None:
    engine, theta = random_engine(seed), 77.0
    places = geometry(engine, theta)
    rods = np.abs(places.wrist_pin - places.crankpin)
    np.testing.assert_allclose(rods, [each.rod_length for each in engine.cylinders], rtol=1e-12)
    for weights, kept in (
        (weights_on_crank(engine, theta), {"rotating_mass": 0.0}),
        (rotating_masses(engine, theta), {"counterweights": ()}),
    ):
        alone = engine.replace(
            cylinder=[each.replace(reciprocating_mass=0.0) for each in engine.cylinders],
            shafts=(),
            **kept,
        )
        cranks = {(x, y): ratio for x, y, ratio in engine._core.cranks[0]}
        pulls = [
            each.amount
            * cranks[each.axis.real, each.axis.imag] ** 2
            * np.exp(1j * np.radians(each.angle_deg))
            for each in weights
        ]
        force = alone.waveform(30.0 / np.pi, theta_deg=[theta]).force[0]
        assert abs(complex(*force) - sum(pulls)) <= 1e-12 * (1.0 + sum(map(abs, pulls)))


def test_cylinders_on_two_cranks_share_no_bob_weight() -> None:
    engine = pair()
    assert [pin.cylinders for pin in crankpins(engine)] == [(1,), (2,)]
    assert cp.bob_weight(engine).grams.tolist() == [350.0, 350.0]
    assert [list(pin.cylinders) for pin in crankpins(engine.replace(tdc_deg=[0, 0]))] == [[1], [2]]


# --- parts ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [random_engine, fired_engine])
@in_turn("seed", SEEDS)
def test_parts_add_up_to_the_whole_about_any_point(
    seed: int, make: Callable[[int], cp.Engine]
) -> None:
    engine = make(seed)
    whole = engine.balance(RPM, orders=(0.5, *ORDERS)).about(POINT)
    for name in (*QUANTITIES, *(("torque.gas", "torque.inertia") if engine.fired else ())):
        parts = contributions(whole, name)
        assert len(parts) == len(engine) + len(engine.counterweights) + len(engine.shafts)
        expected = (
            phasors(whole, name)
            if "." not in name
            else whole.torque._part(name.partition(".")[2]).phasor[np.newaxis]
        )
        total = np.sum([part.phasors for part in parts], axis=0)
        # What vanishes to within a bound is zero, of parts and of the whole.
        bound = sum(part.zero_bound for part in parts) + whole.read(name, "zero_bound")
        assert (np.abs(total - expected) <= bound).all(), name


@in_turn("seed", SEEDS)
def test_what_a_kilogram_adds_is_linear(seed: int) -> None:
    engine = random_engine(seed)
    random = np.random.default_rng(seed)
    engine = engine.replace(
        cylinder=[each.replace(reciprocating_mass=1.0) for each in engine.cylinders]
    )
    pistons = random.uniform(0.9, 1.1, len(engine))
    found = cp.match_parts(engine, pistons, by="balance")
    best = min(
        np.linalg.norm(_vector(engine, pistons[list(order)] - pistons.mean()))
        for order in itertools.permutations(range(len(engine)))
    )
    # A rest may be some thousandths of what it is the difference of.
    assert found.values[0] == pytest.approx(best, rel=1e-9)


def _vector(engine: cp.Engine, more: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return what remains with other pistons, over ω²."""
    pairs = zip(engine.cylinders, more.tolist(), strict=True)
    changed = engine.replace(
        cylinder=[
            each.replace(reciprocating_mass=each.reciprocating_mass + mass) for each, mass in pairs
        ]
    )
    balance = changed.balance(30.0 / np.pi, orders=[1, 2], torque=False)
    half = 0.5 * np.ptp(engine.z)
    parts = [balance.force.forward, balance.force.backward]
    if half > 0.0:
        parts += [balance.moment.forward / half, balance.moment.backward / half]
    return np.concatenate(parts)


# --- laws -----------------------------------------------------------------------------------------


@in_turn("seed", SEEDS)
def test_a_mirrored_engine_mirrors(seed: int) -> None:
    draft = Draft(seed)
    draft.crank_of = [each % (len(draft.cranks) - 1) + 1 for each in draft.crank_of]
    plain, image = (each.engine() for each in (draft, draft.mirrored()))
    here, there = (each.balance(RPM, orders=ORDERS) for each in (plain, image))
    allowed = ROUNDING * size(plain, RPM)
    for (name, axis), sign in {
        ("force", 0): -1, ("force", 1): 1, ("moment", 0): 1, ("moment", 1): -1,
    }.items():  # fmt: skip
        one, other = (getattr(each, name).xy[:, axis] for each in (here, there))
        assert np.abs(other - sign * one).max() <= allowed, (name, axis)
    assert np.abs(there.torque + here.torque).max() <= allowed
    assert np.abs(there.crank_torque - here.crank_torque).max() <= allowed


@in_turn("seed", SEEDS)
def test_moving_all_axes_moves_levers_alone(seed: int) -> None:
    draft = Draft(seed)
    draft.crank_of = [each % (len(draft.cranks) - 1) + 1 for each in draft.crank_of]
    here = draft.engine().balance(RPM, orders=ORDERS)
    x, y = 0.17, -0.23
    draft.cranks = [draft.cranks[0], *((a + x, b + y, n) for a, b, n in draft.cranks[1:])]
    draft.shafts = [each.replace(x=each.x + x, y=each.y + y) for each in draft.shafts]
    moved = draft.engine().balance(RPM, orders=ORDERS)
    same(moved, here, ("force", "moment", "crank_torque"))
    same(moved.about((x, y, draft.reference_z)), here, ("torque",))


@in_turn("seed", SEEDS)
def test_two_halves_make_a_cylinder(seed: int) -> None:
    draft = Draft(seed)
    whole = draft.engine().balance(RPM, orders=ORDERS)
    first = draft.cylinders[0]
    half = first.replace(
        reciprocating_mass=0.5 * first.reciprocating_mass,
        rod_inertia_excess=0.5 * first.rod_inertia_excess,
    )
    draft.cylinders = [half, *draft.cylinders[1:], half]
    draft.rotating_mass[0] *= 0.5
    for name in ("tdc_deg", "bank_deg", "z", "rotating_mass"):
        values = getattr(draft, name)
        setattr(draft, name, np.append(values, values[0]))
    draft.crank_of = [*draft.crank_of, draft.crank_of[0]]
    same(draft.engine().balance(RPM, orders=ORDERS), whole, QUANTITIES)


@in_turn("seed", SEEDS)
def test_a_crank_without_cylinders_changes_nothing(seed: int) -> None:
    draft = Draft(seed)
    before = draft.engine()
    draft.cranks = [*draft.cranks, (0.4, 0.1, -3)]
    after = draft.engine()
    same(after.balance(RPM, orders=ORDERS), before.balance(RPM, orders=ORDERS), QUANTITIES)
    assert after.pin_deg.tolist() == before.pin_deg.tolist()
    assert after.vanishing_orders(ORDERS).table == before.vanishing_orders(ORDERS).table
    assert cp.bob_weight(after).table == cp.bob_weight(before).table


@pytest.mark.slow
@pytest.mark.parametrize("make", [random_engine, fired_engine])
@in_turn("seed", SEEDS)
def test_a_balance_is_a_sweep_of_one_point(seed: int, make: Callable[[int], cp.Engine]) -> None:
    """Its orders and bounds; its figures within their rounding: each adds in its own order."""
    engine = make(seed)
    for rtol in (1e-2, 1e-5, 1e-9):
        b, s = engine.balance(RPM, rtol=rtol), cp.sweep(engine, rpm=RPM, rtol=rtol)
        assert (s.orders, s.omitted, s.error_bound) == (b.orders, b.omitted, b.error_bound)
    orders = (*ORDERS, 0.5, 1.5) if engine.fired else ORDERS
    b, s = engine.balance(RPM, orders=orders), cp.sweep(engine, rpm=RPM, orders=orders)
    for name in ("force", "moment"):
        vectors, swept = getattr(b, name), getattr(s, name)
        for part in ("forward", "backward"):
            apart = np.abs(getattr(swept, part) - getattr(vectors, part))
            assert (apart <= vectors.zero_bound).all(), (name, part)
        # ω² before or after the sum: two roundings.
        size = np.abs(vectors.forward) + np.abs(vectors.backward)
        bound = 5e-16 * size + vectors.zero_bound
        assert (np.abs(swept.xy - vectors.xy) <= bound[:, None]).all()
    for name in ("torque", "crank_torque"):
        swept, scalars = getattr(s, name), getattr(b, name)
        assert (np.abs(swept.phasor - scalars.phasor) <= scalars.zero_bound).all(), name


# --- bounds about another point -------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("make", [random_engine, fired_engine])
@in_turn("seed", SEEDS)
def test_bounds_hold_about_any_point(seed: int, make: Callable[[int], cp.Engine]) -> None:
    engine = make(seed)
    theta = np.linspace(0.0, 720.0, 289)
    exact = cp.sweep(engine, rpm=[RPM]).about(POINT).waveform(theta, exact=True)
    swept = cp.sweep(engine, rpm=[RPM], rtol=0.05).about(POINT)
    summed = swept.waveform(theta)
    single = engine.balance(RPM, rtol=0.05).about(POINT)
    turning = np.exp(1j * np.radians(theta)[:, None] * np.array(single.orders))
    for name in QUANTITIES:
        bound = swept.error_bound[name]
        apart = np.abs(np.asarray(getattr(summed, name)) - np.asarray(getattr(exact, name))).max()
        rounding = ROUNDING * size(engine, RPM) + 1e-9
        assert apart <= bound * (1 + 1e-9) + rounding, name
        assert summed.error_bound[name] == bound
        at = swept.sel(rpm=RPM)
        assert at.error_bound[name] == getattr(at, name).error_bound == bound
        bound = single.error_bound[name]
        assert getattr(single, name).error_bound == bound
        if name in ("torque", "crank_torque"):
            values = (turning * np.asarray(getattr(single, name))).real.sum(axis=1)
            values += getattr(single, name).cycle_mean
            apart = np.abs(values - np.asarray(getattr(exact, name)).reshape(-1)).max()
            assert apart <= bound * (1 + 1e-9) + rounding, name


def test_the_bound_about_a_point_is_one_figure_everywhere() -> None:
    i4 = cp.Engine.preset("i4")
    b = i4.balance(6000, rtol=0.1).about((0.5, 0, 0.1))
    bound = b.error_bound["torque"]
    plain = i4.balance(6000, rtol=0.1).error_bound
    assert bound == plain["torque"] + 0.5 * plain["force"]
    assert b.torque.error_bound == b.torque.inertia.error_bound == bound
    data = b.to_xarray("torque")
    assert data.attrs["torque_error_bound"] == bound
    assert b.error_bound["crank_torque"] == plain["crank_torque"]


# --- the forward theorem --------------------------------------------------------------------------


@in_turn("seed", range(30))
def test_a_sample_of_tolerances_is_an_engine(seed: int) -> None:
    engine = random_engine(seed)
    masses = [each.reciprocating_mass for each in engine.cylinders]
    spreads: dict[str, Any] = {
        "reciprocating_mass": 0.01 * np.array(masses),
        "rotating_mass": 0.01,
        "crank_radius": 1e-5,
        "pin_deg": 0.3,
        "z": 1e-3,
        "rod_length": 1e-4,
    }
    t = cp.tolerances(engine, RPM, samples=3, seed=seed, **spreads)
    known = t.engine_at(1).replace(reference_z=engine.reference_z).balance(RPM, orders=t.orders)
    for name in ("force", "moment", "torque", "crank_torque"):
        found, expected = np.asarray(getattr(t, name))[1], np.asarray(getattr(known, name))
        # Rounding of some thirty terms, some of which cancel.
        scale = size(engine, RPM) + abs(expected).max()
        assert abs(found - expected).max() <= 1e-12 * scale
        peak = getattr(t.total, name).peak[1]
        assert peak == pytest.approx(getattr(known.total, name).peak, rel=1e-10, abs=1e-12 * scale)


def test_cylinders_on_two_cranks_share_no_pin_of_tolerances() -> None:
    draft = next(d for d in map(Draft, range(30)) if {0, 1} <= {*d.crank_of})
    draft.cranks[1] = (0.2, 0.0, 1)
    draft.tdc_deg, draft.bank_deg = np.zeros((2, len(draft.crank_of)))
    one, other = (draft.crank_of.index(crank) + 1 for crank in (0, 1))
    alone = [[n] for n in range(1, len(draft.crank_of) + 1) if n not in (one, other)]
    pair = rf"\[{min(one, other)}, {max(one, other)}\]"
    with pytest.raises(cp.InputError, match=rf"pins = {pair}: .* different cranks"):
        cp.tolerances(draft.engine(), RPM, pin_deg=0.1, pins=[[one, other], *alone])


@in_turn("seed", SEEDS)
def test_bob_weights_act_in_the_sense_of_their_cranks(seed: int) -> None:
    engine = random_engine(seed, ratios=(1, -1), offset=seed % 2 == 1)
    bob = cp.bob_weight(engine)
    for name in ("force", "moment"):
        scale = 1e-12 * size(engine, 30.0 / np.pi)
        for factor in (0.0, 0.3, 0.5, 1.0, 1.7):
            left = getattr(cp.bob_weight(engine, factor).residual[1], name)
            longest, shortest = bob.half_axes(name, factor)
            assert abs(longest - left.peak) <= scale
            assert abs(shortest - left.minor) <= scale
        least = bob.optimal_factor(name)
        if least is not None:
            longest, _ = bob.half_axes(name, np.linspace(0.0, 3.0, 601))
            assert bob.half_axes(name, least)[0] <= longest.min() + scale
        for factor, direction in bob.straight_line_factors(name):
            left = getattr(cp.bob_weight(engine, factor).residual[1], name)
            assert abs(left.minor) <= 1e-9 * left.peak
            assert math.remainder(left.tilt_deg - direction, 180.0) == pytest.approx(0.0, abs=1e-5)


def test_a_bob_weight_on_a_crank_that_turns_against_the_main_one_meets_the_backward_part() -> None:
    twins = pair(ratio=-1, tdc=0.0).replace(bank_deg=[90, 90], tdc_deg=[0, 0])
    bob = cp.bob_weight(twins)
    # Each crank leaves half the pull of its piston, turning the other way: a line, half as long.
    before, _ = bob.half_axes("force", 0.0)
    assert bob.half_axes("force", 0.5) == (before / 2.0, 0.0)
    assert bob.half_axes("force", 0.5)[0] == bob.residual[1].force.peak
    text = str(twins.explain(3000))
    assert "Counterweights on the cranks could remove all of the shaking force of order 1" in text
    assert "what turns with the crank of each piston" in text


@in_turn("seed", SEEDS)
def test_a_weight_on_a_crank_is_one_at_its_pin_turned(seed: int) -> None:
    """A free weight in the direction of a crankpin, and one at the pin, ahead by as much."""
    engine = random_engine(seed)
    rows, crank_of = engine._core.cranks
    k = seed % len(engine)
    crank, ahead = crank_of[k], 77.0
    along = float(engine.pin_deg[k]) + math.copysign(ahead, rows[crank][2])
    free = engine.with_counterweights([cp.Unbalance(0.02, 0.3, along, crank=crank)])
    at_pin = engine.with_counterweights([cp.Unbalance(0.02, 0.3, ahead, pin=k + 1)])
    found, expected = (each.balance(RPM, orders=ORDERS) for each in (free, at_pin))
    for name in QUANTITIES:
        apart = np.asarray(getattr(found, name)) - np.asarray(getattr(expected, name))
        assert np.abs(apart).max() <= 1e-10 * size(engine, RPM), name  # angles of a few roundings
    turned = free.with_first_tdc(33.0).balance(RPM, orders=ORDERS)
    same_at_pin = at_pin.with_first_tdc(33.0).balance(RPM, orders=ORDERS)
    apart = np.asarray(turned.force) - np.asarray(same_at_pin.force)
    assert np.abs(apart).max() <= 1e-10 * size(engine, RPM)
    assert cp.Engine.from_toml(free.to_toml()) == cp.Engine.from_json(free.to_json()) == free


def test_weights_are_on_cranks_that_are_there() -> None:
    engine = pair()
    with pytest.raises(cp.InputError, match=r"counterweights\[0\].crank = 2: give the number"):
        engine.with_counterweights([cp.Unbalance(0.01, 0.0, crank=2)])
    with pytest.raises(cp.InputError, match="crank = 1: leave it out: a weight at a crankpin"):
        cp.Unbalance(0.01, 0.0, pin=1, crank=1)
    with pytest.raises(cp.InputError, match="the shaft carries it"):
        cp.Shaft(1, [cp.Unbalance(0.01, 0.0, crank=1)])
    with pytest.raises(cp.InputError, match="of ratio 1 or -1"):
        cp.counterweights(pair(ratio=2), planes={"web": (0.0, 1)})


@in_turn("seed", SEEDS)
def test_the_fastest_piston_is_that_of_any_crank(seed: int) -> None:
    """Twice the distance between its dead centres in a turn of its own crank."""
    engine = random_engine(seed, ratios=(1, -1, 2, -3))
    rows, crank_of = engine._core.cranks
    speeds = []
    for cylinder, crank in zip(engine.cylinders, crank_of, strict=True):
        heights = cylinder.position(np.linspace(0.0, 360.0, 3601))
        speeds.append(2.0 * np.ptp(heights) * abs(rows[crank][2]) * RPM / 60.0)
    found = cp.sweep(engine, rpm=[RPM / 2, RPM]).mean_piston_speed
    assert found == pytest.approx(max(speeds), rel=1e-6)
    assert engine._core.mean_piston_speed(RPM) == found
    longer = cp.sweep(engine, rpm=[RPM], pin_offset=[0.0, 0.004]).mean_piston_speed
    moved = [each.replace(pin_offset=0.004) for each in engine.cylinders]
    expected = engine.replace(cylinder=moved)._core.mean_piston_speed(RPM)
    assert longer == pytest.approx(expected, rel=1e-12)


def test_a_fast_piston_on_a_second_crank_is_warned_of() -> None:
    engine = pair(ratio=4)
    with pytest.warns(UserWarning, match="mean piston speed is 80 m/s"):
        engine.balance(6000)


def test_pistons_on_faster_cranks_do_not_fire() -> None:
    fast = pair(ratio=2)
    for ask in (
        lambda: fast.firing("1-2"),
        fast.firing_orders,
        lambda: fast.replace(firing_order="1-2"),
    ):
        with pytest.raises(cp.InputError, match=r"cranks\[1\].ratio = 2: cylinders but dummy"):
            ask()
    assert "fires" not in str(fast.explain(RPM))
    still = fast.replace(cylinder=[fast.cylinders[0], fast.cylinders[1].replace(dummy=True)])
    assert still.firing("1").order == (1,)


def test_forces_are_relative_to_that_of_a_piston_on_its_own_crank() -> None:
    fast = cp.Engine.from_lists(
        cp.Cylinder(0.04, 0.14, 0.5), tdc_deg=[0], bank_deg=[90], z=[0], cranks=[(0.2, 0, 2)],
        crank=[1],
    )  # fmt: skip
    assert "Order 2 leaves a shaking force of one piston's first-order force" in str(fast.explain())
    assert fast.explain(RPM).unit == pytest.approx(fast.balance(RPM)[2].force.peak)


def apart() -> cp.Engine:
    """Two throws that are opposite, 0.6 m apart."""
    return cp.Engine.from_lists(
        cp.Cylinder(0.043, 0.145, 0.0), tdc_deg=[0, 180], bank_deg=[90, 90], z=[0, 0],
        cranks=[(0.6, 0, 1)], crank=[0, 1], rotating_mass=1.0,
    )  # fmt: skip


def test_throws_on_axes_apart_make_a_roll_torque_that_is_told_and_removed() -> None:
    """m·r·ω²·a = 0.043 kg·m · 0.6 m · ω²: no force and no moment across the crank."""
    engine = apart()
    torque = 0.043 * 0.6
    fit = cp.counterweights(engine)
    assert {weight.crank for weight in fit.hardware} == {0, 1}
    assert fit.exact
    residual = fit.frames["residual"]
    rows = dict(zip(residual["state"].values[-2:], residual["longest"].values[-2:], strict=True))
    assert rows == {"before": pytest.approx(torque), "after": 0.0}
    assert "about the axis of the main crank" in residual["quantity"].values[-1]
    at = 3000 * np.pi / 30
    said = f"Order 1 leaves a roll torque of {torque * at**2 / 1e3:.3g} kN·m about the axis of the"
    assert said in str(engine.explain(3000))
    assert "counterweights on the cranks could remove it" in str(engine.explain(3000))
    assert "|M_z| is about the axis of the main crank." in str(engine.balance(3000))
    moved = str(engine.balance(3000).about((0.3, 0.1, 0.0)))
    assert "|M_z| is about the axis at x = 0.3 m, y = 0.1 m." in moved


def test_a_card_has_the_roll_torque_of_cranks_apart() -> None:
    """Pistons pull against each other: weights at 100 % push as much, sideways."""
    engine = apart().replace(cylinder=cp.Cylinder(0.043, 0.145, 0.5))
    bob = cp.bob_weight(engine)
    residual = bob.card([0.0, 0.5, 1.0], rpm=3000).frames["residual"]
    (name,) = (each.name for each in residual.columns if each.name.startswith("roll torque about"))
    expected = [
        cp.bob_weight(engine, factor).fitted.balance(3000)[1].torque.peak
        for factor in (0.0, 0.5, 1.0)
    ]
    factors = residual["factor"].values
    found = [residual[name].values[factors.index(each)] for each in (0.0, 50.0, 100.0)]
    assert found == pytest.approx(expected, rel=1e-9)
    assert max(found) > 100.0


OPPOSED = """
schema = 1
cranks = [{ x = 0.0, y = 0.5, ratio = -1 }]
placements = [
  { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 20, bank_deg = 270, z = 0, crank = 1 },
  { tdc_deg = 0, bank_deg = 90, z = 0.1 }, { tdc_deg = 0, bank_deg = 270, z = 0.2, crank = 1 }
]
cylinder = { crank_radius = 0.04, rod_length = 0.12, reciprocating_mass = 0.7, bore = 0.07 }
"""


def test_pistons_that_face_each_other_share_a_chamber() -> None:
    engine = cp.Engine.from_toml(OPPOSED)
    assert engine.chambers == ((1, 2), (3,), (4,))
    order = engine.firing_orders()[0].firing_order
    fired, petrol = engine.replace(firing_order=order), cp.Cycle.example()
    assert fired.with_cycle(petrol).cycles == (petrol,) * 4
    with pytest.raises(cp.InputError, match="two ends of one chamber: give both the same cycle"):
        fired.with_cycle([petrol, None, petrol, petrol])
    with pytest.raises(cp.InputError, match="2 shares the chamber of 1, which fires once"):
        engine.firing("1-2-3-4")
    # Beside each other, and away from each other, as of a boxer on two cranks.
    for place, other in (("x = 0.0", "x = 0.01"), ("y = 0.5", "y = -0.5")):
        apart = cp.Engine.from_toml(OPPOSED.replace(place, other))
        assert apart.chambers == ((1,), (2,), (3,), (4,))
        apart.replace(firing_order=apart.firing_orders()[0].firing_order).with_cycle(petrol)


def test_what_counterweights_leave_is_said_of_one_sense_alone() -> None:
    ranked = [cp.rank([pair(ratio=ratio)], 3000, by="[1].force.backward") for ratio in (1, -1)]
    leaves = ["what the best counterweight leaves" in each.table.title for each in ranked]
    assert leaves == [True, False]


# --- proofs ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [random_engine, fired_engine])
@in_turn("seed", SEEDS)
def test_what_is_said_does_not_fail(seed: int, make: Callable[[int], cp.Engine]) -> None:
    engine = make(seed)
    assert engine.explain(RPM).sentences
    assert engine.balance(RPM)._repr_html_()
    assert cp.bob_weight(engine)._repr_html_()
    if engine.mains.size:
        assert cp.counterweights(engine)._repr_html_()
    found = engine.vanishing_orders(ORDERS)
    balance = engine.balance(RPM, orders=ORDERS)
    for name in ("force", "moment", "torque"):
        for order in getattr(found, name).vanishing:
            quantity = balance.torque.inertia if name == "torque" else getattr(balance, name)
            assert quantity[order].peak == 0.0
            assert quantity[order].status == "zero, proved"
    message = ""
    try:
        engine.closed_form(2)
    except cp.InputError as error:
        message = str(error)
    # What no closed form can have is said in the words of its input.
    assert not message or "a closed form needs" in message or "exact sums" in message


def test_a_square_four_is_proved() -> None:
    square = cp.Engine.from_toml(
        """
        schema = 1
        cranks = [{ x = 0.12, y = 0, ratio = -1 }]
        placements = [
          { tdc_deg = 0, bank_deg = 90, z = 0 }, { tdc_deg = 180, bank_deg = 90, z = 0.1 },
          { tdc_deg = 180, bank_deg = 90, z = 0, crank = 1 },
          { tdc_deg = 0, bank_deg = 90, z = 0.1, crank = 1 },
        ]
        cylinder = { crank_radius = 0.025, rod_length = 0.1, reciprocating_mass = 0.25 }
        """
    )
    found = square.vanishing_orders([1, 2])
    assert found.force[1] == "vanishes"
    assert found.force[2] == "remains"
    assert found.moment[1] == "vanishes"
    assert found.obstacles is not None
    balance = square.balance(6000)
    assert balance.force[1].status == "zero, proved"
    # Roll torques cancel on the block, and add up on the crank.
    assert balance.crank_torque[2].peak > 0.0
    assert str(square.closed_form(2, quantity="force"))


# --- bearings -------------------------------------------------------------------------------------


def as_complex(vectors: ArrayLike) -> NDArray[np.complex128]:
    x, y = np.moveaxis(np.asarray(vectors), -1, 0)
    return np.asarray(x + 1j * y)


ANGLES = np.arange(-30.0, 720.0, 7.3)


@pytest.mark.parametrize("make", [random_engine, fired_engine])
@in_turn("seed", SEEDS)
def test_loads_of_bearings_and_walls_are_the_waveform(
    seed: int, make: Callable[[int], cp.Engine]
) -> None:
    engine = make(seed).replace(reference_z=0.0)
    loads = cp.bearing_loads(engine, RPM, ANGLES)
    cranks, crank_of = (np.array(each) for each in engine._core.cranks)
    sense = np.sign(cranks[crank_of, 2])[:, np.newaxis]
    axis = (cranks[:, 0] + 1j * cranks[:, 1])[:, np.newaxis]
    bore = np.exp(1j * np.deg2rad(engine.bank_deg))[:, np.newaxis]
    mains = as_complex(loads.main)
    pushed = bore * (loads.gas_force - 1j * sense * loads.side_thrust)
    speed = np.abs(cranks[crank_of, 2])
    height = np.array(
        [
            cylinder.position(ratio * (ANGLES - tdc))
            for cylinder, ratio, tdc in zip(engine.cylinders, speed, engine.tdc_deg, strict=True)
        ]
    )
    offset = np.array([each.pin_offset for each in engine.cylinders])[:, np.newaxis]
    at = axis[crank_of] + bore * (height + 1j * sense * offset)
    force = mains.sum(axis=0) + pushed.sum(axis=0)
    moment = 1j * (loads.main_z @ mains + engine.z @ pushed)
    roll = (axis[loads.main_crank].conj() * mains).imag.sum(axis=0)
    roll = roll + (at.conj() * pushed).imag.sum(axis=0)
    for shaft in engine.shafts:
        for each in shaft.unbalances:
            angle = np.deg2rad(shaft.ratio * ANGLES + float(each.angle_deg))
            turning = each.amount * (shaft.ratio * np.pi * RPM / 30.0) ** 2 * np.exp(1j * angle)
            force, moment = force + turning, moment + 1j * each.z * turning
            roll = roll + (complex(shaft.x, -shaft.y) * turning).imag
    shaken = engine.waveform(RPM, theta_deg=ANGLES)
    whole = size(engine, RPM) + 4.0 * np.abs(loads.gas_force).max()
    for found, expected in (
        (force, as_complex(shaken.force)),
        (moment, as_complex(shaken.moment)),
        (roll, shaken.torque),
    ):
        assert np.abs(found - expected).max() <= ROUNDING * whole
    radii = np.array([each.crank_radius for each in engine.cylinders])
    turned = (speed * radii) @ loads.turned("crankpin", "crank")[..., 1]
    assert np.abs(turned - shaken.crank_torque).max() <= ROUNDING * whole


@in_turn("seed", SEEDS)
def test_each_crank_is_loaded_as_that_of_an_engine_of_its_own(seed: int) -> None:
    """Faster by its ratio; one that turns against the main crank seen in a mirror."""
    engine = random_engine(seed)
    loads = cp.bearing_loads(engine, RPM)
    rows, crank_of = (np.array(each) for each in engine._core.cranks)
    for k in set(crank_of.tolist()):
        own = np.flatnonzero(crank_of == k)
        speed, is_turned = abs(rows[k, 2]), rows[k, 2] < 0
        bank = engine.bank_deg[own]
        alone = cp.Engine.from_lists(
            [engine.cylinders[i] for i in own],
            bank_deg=180.0 - bank if is_turned else bank,
            tdc_deg=speed * engine.tdc_deg[own],
            z=engine.z[own],
            rotating_mass=engine.rotating_mass[own],
            mains=loads.main_z[loads.main_crank == k],
        ).with_counterweights(
            [
                *(
                    each.replace(pin=own.tolist().index(each.pin - 1) + 1)
                    for each in engine.counterweights
                    if each.pin is not None and each.pin - 1 in own
                ),
                *(
                    each.replace(
                        crank=0,
                        angle_deg=(-1.0) ** is_turned * float(each.angle_deg) + 180.0 * is_turned,
                    )
                    for each in engine.counterweights
                    if each.pin is None and each.crank == k
                ),
            ]
        )
        expected = cp.bearing_loads(alone, speed * RPM, speed * loads.theta_deg)
        mirror = np.array([-1.0 if is_turned else 1.0, 1.0])
        allowed = ROUNDING * size(engine, RPM)
        mains = loads.main_crank == k
        for name, which in (("main", mains), ("crankpin", own), ("wrist_pin", own)):
            apart = loads.read(name)[which] - mirror * expected.read(name)
            assert np.abs(apart).max() <= allowed, name
        for name in ("side_thrust", "rod_force"):
            assert np.abs(loads.read(name)[own] - expected.read(name)).max() <= allowed, name
        for name, axes in (("main", "crank"), ("crankpin", "rod"), ("wrist_pin", "crank")):
            which = mains if name == "main" else own
            apart = loads.turned(name, axes)[which] - expected.turned(name, axes)
            assert np.abs(apart).max() <= allowed, (name, axes)
        np.testing.assert_array_equal(loads.shares[np.ix_(mains, own)], expected.shares)
        assert not loads.shares[~mains][:, own].any()
        whole = cp.bearing_loads(alone, speed * RPM)  # of all angles
        for name, which in (("main", mains), ("crankpin", own), ("side_thrust", own)):
            # Peaks are found to 1e-9 of themselves.
            np.testing.assert_allclose(
                loads.read(name, "peak")[which], whole.read(name, "peak"), rtol=1e-8, atol=allowed
            )
        for cut in ("shear", "bending"):
            at = np.searchsorted(loads.z, expected.z)
            found, alike = (
                getattr(loads, cut)("crank", crank=k)[at],
                getattr(expected, cut)("crank"),
            )
            apart = found - mirror[:: -1 if cut == "bending" else 1] * alike
            assert np.abs(apart).max() <= allowed, cut


def test_a_crank_that_is_not_there_cannot_be_cut() -> None:
    loads = cp.bearing_loads(pair(), RPM, [0.0])
    with pytest.raises(cp.InputError, match="crank = 2: give the index of a crank, 0 to 1"):
        loads.shear("crank", crank=2)
    assert loads.frames["mains"].columns[1].values == (0, 0, 1, 1)


@in_turn("seed", range(30))
def test_bounds_of_zeros_are_those_of_the_sweep(seed: int) -> None:
    """Of each quantity its own terms: a force at an arm is none of the torque on the crank."""
    engine = random_engine(seed)
    orders = range(1, 13)
    balance = engine.balance(3000.0, orders=orders)
    sweep = cp.sweep(engine, rpm=[3000.0], orders=orders)
    for name in QUANTITIES:
        found = getattr(balance, name).zero_bound
        expected = getattr(sweep, name).zero_bound[0]
        np.testing.assert_allclose(found, expected, rtol=1e-12, err_msg=name)
