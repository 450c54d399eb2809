"""Does ``orders="auto"`` take the fewest orders, and is its bound true and tight?

What is left out is found from the sum of all other orders, up to one above which nothing is left,
so that it is seen far below the rounding of a waveform.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.contributions import contributions
from hypothesis import given, settings
from hypothesis import strategies as st
from support import in_turn
from support.several_cranks import Draft, fired_engine, random_engine

if TYPE_CHECKING:
    from crankpin.model.engine import Hold
    from numpy.typing import NDArray

RPM = 100.0
OMEGA = RPM * 2.0 * np.pi / 60.0
OMEGA_6000 = 6000.0 * 2.0 * np.pi / 60.0
QUANTITIES = ("force", "moment", "torque")

# Radii, masses and places are random, and pressures.
pytestmark = [
    pytest.mark.filterwarnings("ignore:.*was it given in (grams|millimetres):UserWarning"),
    pytest.mark.filterwarnings("ignore:.*pressure (peaks|brakes|is .* at its least):UserWarning"),
]

examples = settings(max_examples=60, deadline=None, derandomize=True)


def scales(engine: cp.Engine) -> dict[str, float]:
    """What rtol is relative to: a load's, which grows with the square of the speed of its crank."""
    cranks, crank_of = engine._core.cranks
    radius = max(c.crank_radius for c in engine.cylinders)
    on_cranks = [
        (weight.amount, weight.z, cranks[0 if weight.pin is None else crank_of[weight.pin - 1]])
        for weight in engine.counterweights
    ]
    on_cranks += [
        (mass * c.crank_radius, z, cranks[crank])
        for c, mass, z, crank in zip(
            engine.cylinders, engine.rotating_mass, engine.z, crank_of, strict=True
        )
    ]
    turning = on_cranks + [
        (weight.amount, weight.z, (shaft.x, shaft.y, shaft.ratio))
        for shaft in engine.shafts
        for weight in shaft.unbalances
    ]
    # Force, lever and torque of each.
    loads = [
        (ratio**2 * amount, z, ratio**2 * amount * max(radius, float(np.hypot(x, y))))
        for amount, z, (x, y, ratio) in turning
    ]
    for c, z, crank in zip(engine.cylinders, engine.z, crank_of, strict=True):
        square, first = cranks[crank][2] ** 2, c.reciprocating_mass * c.crank_radius
        rod = abs(c.rod_inertia_excess) * c.rod_ratio
        loads.append((square * first, z, square * max(first * c.crank_radius, rod)))
    force, _, torque = (OMEGA**2 * max(each) for each in zip(*loads, strict=True))
    lever = max((abs(z - engine.reference_z) for size, z, _ in loads if size), default=0.0)
    return {"force": force, "moment": force * lever, "torque": torque}


def top(engine: cp.Engine) -> int:
    """An order above which every force is below 1e-22 of the first, by the largest root."""
    arms = [(c.rod_length - abs(c.pin_offset)) / c.crank_radius for c in engine.cylinders]
    root = max(arm - (arm**2 - 1.0) ** 0.5 for arm in arms)
    # The square of an order, which stands before the root's power, is 1e7 at most.
    return int((22.0 + 7.0) * np.log(10.0) / -np.log(root)) + 8


def peak(turning: NDArray[Any], against: NDArray[Any], orders: tuple[int, ...]) -> float:
    """Largest length over the turn of the sum of orders, from samples."""
    samples = 8 * max(orders)
    spectrum = np.zeros(samples, complex)
    spectrum[list(orders)] = turning
    spectrum[[-n for n in orders]] = against
    return float(np.abs(np.fft.ifft(spectrum) * samples).max())


def left_out(engine: cp.Engine, kept: tuple[float, ...]) -> dict[str, float]:
    """What all orders but these add to force, moment and either torque at the worst crank angle."""
    # Orders of link rods fall more slowly than those of a rod alone.
    last = max(top(engine), 2 * int(max(kept, default=1)))
    rest = tuple(n for n in range(1, last + 1) if n not in kept)
    b = engine.balance(RPM, orders=rest)
    torques = (peak(t / 2, np.conj(t) / 2, rest) for t in (b.torque, b.crank_torque))
    return {
        "force": peak(b.force.forward, b.force.backward, rest),
        "moment": peak(b.moment.forward, b.moment.backward, rest),
        "torque": max(torques),
    }


def with_rod(engine: cp.Engine, rod_ratio: float, offset: float) -> cp.Engine:
    """The engine with other rods; the offset as a part of what can turn."""
    cylinders = [
        cp.Cylinder(
            c.crank_radius,
            c.crank_radius / rod_ratio,
            c.reciprocating_mass,
            offset * c.crank_radius * (1.0 / rod_ratio - 1.0),
        )
        for c in engine.cylinders
    ]
    return engine.replace(cylinder=cylinders)


# --- the bound ----------------------------------------------------------------------------------


@pytest.mark.slow
@in_turn("offset", [0.0, 0.1])
@in_turn("name", cp.presets())
def test_the_bound_is_true_and_tight(name: str, offset: float) -> None:
    preset = cp.Engine.preset(name).with_cycle(None)
    for rod_ratio in (0.1, 0.3, 0.6, 0.9, 0.99):
        # Link rods keep the lengths of their stars: shorter ones would not reach.
        engine = preset if any(preset.link_rods) else with_rod(preset, rod_ratio, offset)
        scale = scales(engine)
        for rtol in (1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-14):
            b = engine.balance(RPM, orders="auto", rtol=rtol)
            for quantity, true in left_out(engine, b.orders).items():
                bound = b.error_bound[quantity]
                # Each of the sums is rounded.
                assert true <= bound * (1.0 + 1e-12), (rod_ratio, rtol, quantity)
                assert bound <= rtol * scale[quantity] * (1.0 + 1e-12)
                # A hundredth of the tolerance is added for all that is above the last candidate.
                rest = 0.01 * rtol * scale[quantity]
                # That of link rods is the one of a strip, and larger.
                if any(engine.link_rods):
                    continue
                assert bound <= 10.0 * true + rest, (rod_ratio, rtol, quantity)


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Floats of a range."""
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


ANGLES = st.one_of(
    numbers(0.0, 360.0), st.integers(0, 23).map(lambda k: 15.0 * k), st.just("360/7")
)


@st.composite
def engines(draw: st.DrawFn) -> cp.Engine:
    """One to six cylinders, each its own or all alike, anywhere."""
    count = draw(st.integers(1, 6))
    one = st.tuples(numbers(0.1, 0.9), numbers(-0.5, 0.5), numbers(0.1, 2.0))
    shared = draw(st.one_of(st.none(), one))
    cylinders = []
    for _ in range(count):
        slant, offset, mass = shared or draw(one)
        # The crank takes this part of what the offset leaves of a rod of 0.15 m.
        radius = 0.15 * (1.0 - abs(offset)) * slant
        cylinders.append(cp.Cylinder(radius, 0.15, mass, 0.15 * offset))
    return cp.Engine.from_lists(
        cylinders,
        tdc_deg=[draw(ANGLES) for _ in range(count)],
        bank_deg=[draw(ANGLES) for _ in range(count)],
        z=[draw(numbers(-1.0, 1.0)) for _ in range(count)],
        rotating_mass=[draw(st.one_of(st.just(0.0), numbers(1e-30, 2.0))) for _ in range(count)],
    )


TOLERANCES = st.sampled_from([1e-2, 1e-4, 1e-7, 1e-10, 1e-13])


@examples
@given(engines(), TOLERANCES)
def test_the_bound_holds_for_any_engine(engine: cp.Engine, rtol: float) -> None:
    b = engine.balance(RPM, orders="auto", rtol=rtol)
    for quantity, true in left_out(engine, b.orders).items():
        bound = b.error_bound[quantity]
        assert true <= bound * (1.0 + 1e-12) + 1e-18 * scales(engine)[quantity]
        assert bound <= rtol * scales(engine)[quantity] * (1.0 + 1e-12)


@examples
@given(engines(), TOLERANCES)
def test_the_bound_holds_against_kinematics(engine: cp.Engine, rtol: float) -> None:
    theta = np.linspace(0.0, 360.0, 97)
    b = engine.balance(RPM, orders="auto", rtol=rtol)
    exact = engine.waveform(RPM, theta_deg=theta)
    summed = engine.waveform(RPM, theta_deg=theta, orders=b.orders) if b.orders else None
    for quantity, scale in scales(engine).items():
        off = getattr(exact, quantity) - (getattr(summed, quantity) if summed else 0.0)
        length = np.abs(off) if quantity == "torque" else np.hypot(*off.T)
        # Near a rod ratio of 0.9 accelerations are some 20 times the first order's, and angles are
        # rounded to 1e-15 rad of slopes as much again; of up to six cylinders.
        rounding = 1e-12 * len(engine) * (scale + scales(engine)["force"] * (quantity == "moment"))
        assert length.max() <= b.error_bound[quantity] + rounding


@examples
@given(
    engines(),
    st.dictionaries(st.integers(1, 40), numbers(1e-9, 1.0), min_size=1, max_size=12),
    TOLERANCES,
)
def test_the_bound_holds_for_spectra(
    engine: cp.Engine, spectrum: dict[int, float], rtol: float
) -> None:
    b = engine.balance(RPM, orders="auto", rtol=rtol, spectrum=spectrum)
    listed = tuple(sorted({1, *spectrum} - set(b.orders)))
    assert set(b.error_bound) == {"force", "moment"}
    if listed:
        rest = engine.balance(RPM, orders=listed, spectrum=spectrum)
        force = peak(rest.force.forward, rest.force.backward, listed)
        moment = peak(rest.moment.forward, rest.moment.backward, listed)
        assert force <= b.error_bound["force"] * (1.0 + 1e-12)
        assert moment <= b.error_bound["moment"] * (1.0 + 1e-12)


def test_what_cancels_at_every_order_has_a_bound_far_below_the_tolerance() -> None:
    """Only what is above the last candidate is left, bounded without the layout."""
    boxer, i6 = cp.Engine.preset("boxer-6"), cp.Engine.preset("i6")
    bounds = boxer.balance(RPM, orders="auto", rtol=1e-9).error_bound
    assert bounds["force"] <= 1e-11 * scales(boxer)["force"]
    bounds = i6.balance(RPM, orders="auto", rtol=1e-9).error_bound
    assert bounds["moment"] <= 1e-11 * scales(i6)["moment"]
    assert bounds["moment"] > 0.0


# --- the fewest ---------------------------------------------------------------------------------


def fewest(engine: cp.Engine, rtol: float, *, torque: bool) -> int:
    """Try every set of orders that could be left out, by the same bound."""
    wanted = QUANTITIES if torque else QUANTITIES[:2]
    scale = scales(engine)
    everything = tuple(range(1, top(engine) + 1))
    b = engine.balance(RPM, orders=everything)
    sizes = {
        "force": b.force.peak,
        "moment": b.moment.peak,
        "torque": np.maximum(np.abs(b.torque), np.abs(b.crank_torque)),
    }
    parts = np.array(
        [sizes[q] / (rtol * scale[q]) if scale[q] else 0.0 * sizes[q] for q in wanted]
    ).T
    worst = parts.max(axis=1)
    needed = int((worst > 1.0).sum())
    # The small ones are left out by any best set of at most twelve that are not.
    open_ = sorted(np.flatnonzero((worst <= 1.0) & (worst > 1e-5)), key=lambda k: -worst[k])[:12]
    small = parts[[k for k in np.flatnonzero(worst <= 1.0) if k not in open_]].sum(axis=0)
    assert (small < 0.5).all()
    for kept in range(len(open_) + 1):
        for some in itertools.combinations(open_, len(open_) - kept):
            if (parts[list(some)].sum(axis=0) + small <= 1.0).all():
                return needed + kept
    raise AssertionError


@settings(max_examples=40, deadline=None, derandomize=True)
@given(engines(), st.sampled_from([3e-2, 1e-3, 1e-5]), st.booleans())
def test_no_fewer_orders_would_do(engine: cp.Engine, rtol: float, torque: bool) -> None:
    b = engine.balance(RPM, orders="auto", rtol=rtol, torque=torque)
    assert len(b.orders) == fewest(engine, rtol, torque=torque)


def test_cancellations_save_orders() -> None:
    """A V12 is two inline sixes: only every sixth order is left."""
    for rtol in (1e-2, 1e-4):
        v12 = cp.Engine.preset("v12-60").balance(RPM, orders="auto", rtol=rtol, torque=False)
        single = cp.Engine.preset("single").balance(RPM, orders="auto", rtol=rtol, torque=False)
        assert len(v12.orders) < len(single.orders)
        assert all(n % 6 == 0 for n in v12.orders)


@pytest.mark.parametrize("rpm", [0.0, 1.0, 6000.0])
def test_speed_changes_no_choice(rpm: float) -> None:
    v6 = cp.Engine.preset("v6-60")
    assert v6.balance(rpm, orders="auto").orders == v6.balance(RPM, orders="auto").orders


# --- of several cranks, with weights, shafts, rods and dead cylinders ----------------------------

SEEDS = range(24)
FAST = (1, -1, 2, -2, 3, -3)
"""Speeds of cranks of which orders of one are not all those of another."""


def sizes(engine: cp.Engine, rpm: float, orders: tuple[float, ...]) -> dict[str, NDArray[Any]]:
    """The largest that each order adds, of torque by part."""
    b = engine.balance(rpm, orders=orders)
    torques = {
        part: np.maximum(*(b.read(f"{name}.{part}", "peak") for name in ("torque", "crank_torque")))
        for part in ("inertia", "gas")
    }
    return {"force": b.force.peak, "moment": b.moment.peak, **torques}


def check(
    b: cp.results.Balance,
    bounds: dict[str, float],
    allowed: dict[str, float],
    orders: tuple[float, ...],
) -> None:
    """What is left out is within the bound, that within what is allowed, and no order kept fits."""
    added = sizes(b.engine, RPM, orders)
    is_kept, is_omitted = np.isin(orders, b.orders), np.isin(orders, b.omitted)
    for quantity, of_orders in added.items():
        lost = float(of_orders[~is_kept].sum())
        assert lost <= bounds[quantity] * (1.0 + 1e-9), quantity
        assert bounds[quantity] <= allowed[quantity] * (1.0 + 1e-9), quantity
        # Above the last order that was evaluated; that of pressure declines slowly.
        rest = bounds[quantity] - float(of_orders[is_omitted].sum())
        share = 0.25 if quantity == "gas" else 0.01
        assert rest <= share * allowed[quantity] * (1.0 + 1e-9), quantity
    for order in b.orders:
        more = {name: float(each[orders.index(order)]) for name, each in added.items()}
        over = (bounds[name] + size > allowed[name] * (1.0 - 1e-9) for name, size in more.items())
        assert any(over), order


def highest(engine: cp.Engine) -> int:
    """An order above which nothing counts, of the fastest crank or shaft."""
    ratios = [ratio for *_, ratio in engine._core.cranks[0]] + [s.ratio for s in engine.shafts]
    return math.ceil(top(engine) * max(map(abs, ratios)))


def allowed(engine: cp.Engine, rtol: float) -> dict[str, float]:
    """What may be left out, without gas."""
    found = {quantity: rtol * scale for quantity, scale in scales(engine).items()}
    return {**found, "inertia": found["torque"], "gas": 0.0}


def on_the_second_crank(draft: Draft, count: int) -> Draft:
    """The first cylinder of a draft, alive, as often as this on its second crank, and no more."""
    alive = draft.cylinders[0].replace(reciprocating_mass=0.7)
    draft.cylinders, draft.crank_of = [alive] * count, [1] * count
    for name in ("tdc_deg", "bank_deg", "z", "rotating_mass"):
        setattr(draft, name, np.repeat(getattr(draft, name)[:1], count))
    draft.weights, draft.shafts = [], []
    return draft


@in_turn("seed", SEEDS)
def test_fewest_orders_are_kept_of_several_cranks(seed: int) -> None:
    far = on_the_second_crank(Draft(seed, ratios=FAST), 1)
    # The torque of its force about the main crank is far larger than that of its rod.
    far.cranks[1], far.rotating_mass = (300.0, 400.0, far.cranks[1][2]), np.zeros(1)
    engines = [Draft(seed, ratios=FAST), on_the_second_crank(Draft(seed, ratios=FAST), 1), far]
    for engine, rtol in itertools.product([each.engine() for each in engines], (3e-2, 1e-4, 1e-8)):
        b = engine.balance(RPM, rtol=rtol)
        bounds = {**b.error_bound, "inertia": b.error_bound["torque"], "gas": 0.0}
        orders = tuple(range(1, highest(engine) + 1))
        check(b, bounds, allowed(engine, rtol), orders)


@in_turn("seed", SEEDS)
def test_the_lever_is_that_of_what_has_a_force(seed: int) -> None:
    """Of a pair that makes a moment alone, about a plane aside; one of no mass is far off."""
    draft = on_the_second_crank(Draft(seed), 3)
    draft.reference_z = -3.0 if seed % 2 else 0.07
    draft.bank_deg[1] += 180.0
    draft.z += [0.0, 0.3, 9.0]
    draft.rotating_mass[2] = 0.0
    draft.cylinders[2] = draft.cylinders[0].replace(reciprocating_mass=0.0, rod_inertia_excess=0.0)
    engine = draft.engine()
    for rtol in (3e-2, 1e-4, 1e-8):
        b = engine.balance(RPM, rtol=rtol, torque=False)
        assert not b.force.peak.any()
        most = allowed(engine, rtol) | {"inertia": np.inf}
        bounds = {**b.error_bound, "inertia": np.inf, "gas": 0.0}
        check(b, bounds, most, tuple(range(1, highest(engine) + 1)))


def smooth(seed: int) -> cp.Cycle:
    """A cycle whose pressure bends nowhere, and is largest anywhere in two turns."""
    random = np.random.default_rng(seed)
    theta = np.arange(0.0, 720.0, 4.0)
    apart = (theta - random.uniform(0.0, 720.0) + 360.0) % 720.0 - 360.0
    more = random.uniform(0.5, 3.0) * np.exp(-((apart / random.uniform(25.0, 60.0)) ** 2))
    return cp.Cycle(theta, 1e5 * random.uniform(0.1, 1.5) + 1e6 * more)


def smoothly_fired(seed: int, crankcase: float = 2e5) -> cp.Engine:
    """An engine of two such cycles."""
    cycles = [smooth(seed), smooth(seed + 1000)]
    engine = fired_engine(seed)
    own = [each and cycles[k % 2] for k, each in enumerate(engine.cycles or ())]
    return engine.with_cycle(own, crankcase=crankcase)


def largest_of_gas(engine: cp.Engine) -> float:
    """The largest torque of pressure on a cylinder."""
    theta, below = np.arange(720.0), engine.crankcase
    assert below is not None
    torques = [
        np.abs((cycle.pressure_at(theta) - below) * c.velocity(theta, 30.0 / np.pi))
        * (np.pi / 4.0 * c.bore**2)
        for c, cycle in zip(engine.cylinders, engine.cycles or (), strict=True)
        if cycle is not None and c.bore is not None
    ]
    return max(float(each.max()) for each in torques)


@in_turn("seed", SEEDS)
def test_fewest_orders_are_kept_of_gas(seed: int) -> None:
    engine = smoothly_fired(seed, 3e5 if seed % 2 else 0.0)
    orders = tuple(n / 2 for n in range(1, 2 * max(192, highest(engine)) + 1))
    for rtol in (0.1, 1e-2, 1e-6):
        b = engine.balance(RPM, rtol=rtol)
        # At rest there is gas alone.
        gas = engine.balance(0.0, rtol=rtol).error_bound["torque"]
        # What is left of inertia is rounded as both together are.
        inertia = b.error_bound["torque"] - gas + np.spacing(b.error_bound["torque"])
        bounds = {**b.error_bound, "inertia": inertia, "gas": gas}
        # Orders of pressure decline slowly: less than a thousandth is not asked of them.
        most = allowed(engine, rtol) | {"gas": max(rtol, 1e-3) * largest_of_gas(engine)}
        check(b, bounds, most, orders)


@in_turn("seed", SEEDS)
def test_a_sweep_leaves_out_no_more_than_its_bound_wherever_a_point_stands(seed: int) -> None:
    """Of two engines at some rod ratios and speeds, in this order and in another."""
    make = smoothly_fired if seed % 2 else random_engine
    engines = [make(seed), make(seed + 2)]
    # Up to where no order grows with the rod ratio any more, of engines with offset and without.
    ratios = [0.2, 0.45, 0.98] if seed % 4 == 2 else [0.2, 0.4, 0.3]
    if seed % 4 == 2:
        engines = [
            engine.replace(cylinder=[each.replace(pin_offset=0.0) for each in engine.cylinders])
            for engine in engines
        ]
    speeds, rtol = [RPM, 3.0 * RPM, 2.0 * RPM], 1e-2
    kinds: dict[str, Any] = {"orders": "auto", "rtol": rtol}
    s = cp.sweep(engines, rpm=speeds, rod_ratio=ratios, **kinds)
    other = cp.sweep(engines[::-1], rpm=speeds[::-1], rod_ratio=ratios[::-1], **kinds)
    assert (other.orders, other.omitted) == (s.orders, s.omitted)
    for quantity, bound in s.error_bound.items():
        assert other.error_bound[quantity] == pytest.approx(bound, rel=1e-12)
    for engine, ratio in itertools.product(engines, ratios):
        rods = [each.replace(rod_length=each.crank_radius / ratio) for each in engine.cylinders]
        there = engine.replace(cylinder=rods)
        rest = tuple(n / 2 for n in range(1, 1 + 2 * min(highest(there), 400)))
        rest = tuple(n for n in rest if n not in s.orders)
        lost = {name: each.sum() for name, each in sizes(there, max(speeds), rest).items()}
        lost["torque"] = lost.pop("inertia") + lost.pop("gas")
        for quantity, most in lost.items():
            assert most <= s.error_bound[quantity] * (1.0 + 1e-9), (ratio, quantity)


# --- of each cylinder by itself -------------------------------------------------------------------


@in_turn("seed", SEEDS)
def test_samples_have_the_orders_of_each_cylinder_and_of_shafts(seed: int) -> None:
    engine = random_engine(seed, ratios=FAST)
    shaft = cp.Shaft(-5, [cp.Unbalance(1e-3, 0.1, 30.0)], x=0.1)
    engine = engine.with_shafts([*engine.shafts, shaft])
    for rtol in (3e-2, 1e-5):
        t = cp.tolerances(engine, RPM, z=1e-9, samples=1, rtol=rtol)
        assert {abs(each.ratio) for each in engine.shafts} <= set(t.orders)
        rest = tuple(n for n in range(1, highest(engine) + 1) if n not in t.orders)
        whole = engine.balance(RPM, orders=rest)
        for names in (("force",), ("moment",), ("torque", "crank_torque")):
            parts = [contributions(whole, name)[: len(engine)] for name in names]
            # The longest vector of a part that moves along a line.
            lost = sum(
                np.max([np.linalg.norm(each.phasors, axis=0) for each in of_part], axis=0).sum()
                for of_part in zip(*parts, strict=True)
            )
            bound = t.error_bound[names[0]]
            assert lost <= bound * (1.0 + 1e-9), names
            # Each by its own scale, of which that of the whole is the largest.
            assert bound <= len(engine) * allowed(engine, rtol)[names[0]] * (1.0 + 1e-9)


# --- torque only when asked ---------------------------------------------------------------------


def test_torque_counts_only_when_asked() -> None:
    i6 = cp.Engine.preset("i6")
    with_torque, without = (i6.balance(RPM, orders="auto", torque=asked) for asked in (True, False))
    assert {3, 9} <= set(with_torque.orders)
    assert not {3, 9} & set(without.orders)
    assert "torque" not in without.error_bound
    explicit = i6.balance(RPM, orders=[6], torque=False)
    w = i6.waveform(RPM, theta_deg=[0.0], torque=False)
    s = cp.sweep(i6, rpm=RPM, torque=False)
    for result in (without, explicit, w, s):
        with pytest.raises(cp.InputError, match="torque=True"):
            _ = result.torque
    np.testing.assert_array_equal(w.force, i6.waveform(RPM, theta_deg=[0.0]).force)
    assert w.error_bound == {"force": 0.0, "moment": 0.0}
    assert "torque" not in explicit.to_pandas()
    assert "torque" not in explicit.to_xarray()
    assert "M_z" not in repr(explicit)


# --- waveforms ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "rod_ratio", "rtol"), [("i4", 0.99, 1e-12), ("v12-60", 0.3, 1e-6)]
)
def test_waveform_sums_the_orders_of_a_balance(name: str, rod_ratio: float, rtol: float) -> None:
    engine, theta = with_rod(cp.Engine.preset(name), rod_ratio, 0.0), np.arange(0.0, 360.0, 7.0)
    w = engine.waveform(RPM, theta_deg=theta, orders="auto", rtol=rtol)
    b = engine.balance(RPM, orders="auto", rtol=rtol)
    assert (w.orders, w.omitted, w.error_bound) == (b.orders, b.omitted, b.error_bound)
    assert w.orders
    exact = engine.waveform(RPM, theta_deg=theta)
    assert (exact.orders, exact.omitted) == (None, ())
    assert exact.error_bound == dict.fromkeys(b.error_bound, 0.0)


def test_auto_is_rejected_where_no_number_of_orders_suffices() -> None:
    stuck = with_rod(cp.Engine.preset("i4"), 1.0 - 1e-12, 0.0)
    for analysis in (stuck.balance, stuck.waveform):
        with pytest.raises(cp.InputError, match="rtol"):
            analysis(RPM, orders="auto")
    assert stuck.waveform(RPM, theta_deg=[0.0, 1.0]).orders is None


def test_a_spectrum_is_always_summed() -> None:
    w = cp.Engine.preset("single").waveform(
        RPM, theta_deg=[0.0], orders="auto", spectrum={1: 1.0, 2: 0.3, 4: 0.1}
    )
    assert w.orders == (1, 2, 4)


# --- sweeps -------------------------------------------------------------------------------------


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    st.sampled_from(["v6-60", "v8-crossplane", "v10-90", "v14-9.13", "w16"]),
    st.lists(numbers(0.1, 0.9), min_size=1, max_size=3),
    st.one_of(st.none(), st.lists(numbers(-0.5, 0.5), min_size=1, max_size=2)),
    st.sampled_from(["pins", "firing"]),
    st.booleans(),
    st.sampled_from([1e-2, 1e-5, 1e-9]),
)
def test_sweeps_reach_the_tolerance_everywhere(
    name: str,
    ratios: list[float],
    offsets: list[float] | None,
    hold: Hold,
    torque: bool,
    rtol: float,
) -> None:
    engine = cp.Engine.preset(name)
    radius = engine.cylinders[0].crank_radius
    # Parts of what the longest crank of the sweep leaves.
    room = radius * (1.0 / max(ratios) - 1.0)
    if name == "w16" and offsets is None:
        offsets = [0.0]  # its own offsets take short rods only
    offsets = None if offsets is None else [room * offset for offset in offsets]
    angles = None if name == "w16" else [30.0, 90.0, 117.3]
    s = cp.sweep(
        engine,
        rpm=[RPM, 0.5 * RPM],
        bank_angle_deg=angles,
        hold=hold if angles else None,
        rod_ratio=ratios,
        pin_offset=offsets,
        orders="auto",
        rtol=rtol,
        torque=torque,
    )
    wanted = QUANTITIES if torque else QUANTITIES[:2]
    swept: list[Any] = [angles or [None], ratios, offsets or [None]]
    for angle, ratio, offset in itertools.product(*swept):
        there = engine if angle is None else engine.with_bank_angle(angle, hold=hold)
        cylinders = [
            cp.Cylinder(
                c.crank_radius,
                c.crank_radius / ratio,
                c.reciprocating_mass,
                c.pin_offset if offset is None else offset,
            )
            for c in there.cylinders
        ]
        there = there.replace(cylinder=cylinders)
        # One more than all, so that something is left.
        last = int(max(top(there), *s.orders)) + 1
        rest = tuple(n for n in range(1, last + 1) if n not in s.orders)
        b = there.balance(RPM, orders=rest)
        true = {
            "force": peak(b.force.forward, b.force.backward, rest),
            "moment": peak(b.moment.forward, b.moment.backward, rest),
            "torque": peak(b.torque / 2, np.conj(b.torque) / 2, rest),
        }
        for quantity in wanted:
            bound, scale = s.error_bound[quantity], scales(engine)[quantity]
            assert true[quantity] <= bound * (1.0 + 1e-12) + 1e-14 * scale
            assert bound <= rtol * scale * (1.0 + 1e-12)


@examples
@given(engines(), TOLERANCES)
def test_an_order_that_was_left_out_is_read_as_if_it_were_given(
    engine: cp.Engine, rtol: float
) -> None:
    b = engine.balance(RPM, orders="auto", rtol=rtol)
    for order in range(1, 9):
        alone = engine.balance(RPM, orders=[order])
        assert b._at_order(order).orders == alone.orders
        for name in ("force", "moment", "torque", "crank_torque"):
            one, given_alone = getattr(b[order], name), getattr(alone, name)
            bound = given_alone.zero_bound[0]  # of the rounding of either
            assert one.zero_bound == pytest.approx(bound, rel=1e-12)
            assert np.abs(np.asarray(one) - np.asarray(given_alone)[0]).max() <= 2.0 * bound
            assert one.peak == pytest.approx(given_alone.peak[0], abs=4.0 * bound)
            assert one.peak == b._at_order(order).read(name, "peak")[0]


def test_a_sweep_of_one_point_is_a_balance() -> None:
    i4 = cp.Engine.preset("i4")
    for rtol in (1e-2, 1e-6, 1e-12):
        s = cp.sweep(i4, rpm=RPM, orders="auto", rtol=rtol, torque=False)
        assert s.orders == i4.balance(RPM, orders="auto", rtol=rtol, torque=False).orders


@pytest.mark.parametrize("rtol", [0.2, 1e-2, 1e-4])
def test_orders_below_that_of_a_fast_shaft_are_bounded(rtol: float) -> None:
    """All orders of one upright cylinder peak together."""
    single = cp.Engine.inline(cp.Cylinder(0.05, 0.15, 0.5), throws_deg=[0], spacing=0.1)
    engine = single.with_shafts([cp.Shaft(20, [cp.Unbalance(1e-6, 0.0)])])
    b = engine.balance(RPM, rtol=rtol, torque=False)
    s = cp.sweep(engine, rpm=[RPM, 0.5 * RPM], rtol=rtol, torque=False)
    assert (s.orders, s.error_bound) == (b.orders, b.error_bound)
    assert left_out(engine, b.orders)["force"] <= b.error_bound["force"] * (1.0 + 1e-12)


def test_the_largest_rod_ratio_is_the_worst() -> None:
    """Sizes of all orders of force grow with the rod ratio; the series says so for every order."""
    ratios = np.linspace(0.01, 0.99, 99)
    table = np.abs(cp.slider_crank_harmonics(ratios, range(2, 41, 2)))
    assert (np.diff(table, axis=0) > 0.0).all()


def test_a_sweep_may_have_no_order() -> None:
    boxer = cp.Engine.preset("boxer-6")
    s = cp.sweep(boxer, rpm=[RPM, 2 * RPM], orders="auto", rtol=0.99, torque=False)
    assert s.orders == ()
    assert s.force.xy.shape == (2, 0, 2)
    assert s.total.force.peak.tolist() == [0.0, 0.0]


def test_sweeps_keep_orders_that_shafts_balance_at_one_rod_ratio_only() -> None:
    v8 = cp.Engine.preset("v8-flatplane")
    own = v8.cylinders[0].rod_ratio
    # Lanchester shafts: they cancel order 2 of the engine, and do not grow with the rod ratio.
    left = v8.balance(6000, orders=[2]).force

    def shaft(ratio: int, part: complex) -> cp.Shaft:
        degrees = float(np.degrees(np.angle(-part)))
        weight = cp.Unbalance(abs(part) / (2.0 * OMEGA_6000) ** 2, v8.reference_z, degrees)
        return cp.Shaft(ratio, unbalances=[weight])

    balanced = v8.with_shafts([shaft(2, left.forward[0]), shaft(-2, left.backward[0])])
    ratios = [0.15, 0.2, own]
    sweep = cp.sweep(balanced, rpm=6000, rod_ratio=ratios)
    expected = cp.sweep(balanced, rpm=6000, rod_ratio=ratios, orders=range(1, 40))
    assert 2 in sweep.orders
    # The tolerance, 1e-9 of one of eight cylinders, is far below what shows here.
    np.testing.assert_allclose(sweep.total.force.peak, expected.total.force.peak, rtol=1e-7)


@pytest.mark.parametrize("mass", [1e-3, 0.5, 50.0])
def test_the_tolerance_of_a_spectrum_does_not_depend_on_the_masses_it_replaces(mass: float) -> None:
    engine = cp.Engine.preset("v6-60").replace(cylinder=cp.Cylinder(0.045, 0.15, mass))
    spectrum = {1: 1e-3, 2: 1e-4, 4: 1e-6}
    # Order 4 leaves a moment of 1.5e-7 kg·m²; the scale is 1e-3 kg·m times a lever of 0.1 m.
    assert engine.balance(5000, spectrum=spectrum, rtol=1.6e-3).orders == (1, 2)
    assert engine.balance(5000, spectrum=spectrum, rtol=1.4e-3).orders == (1, 2, 4)
    assert cp.sweep(engine, rpm=5000, spectrum=spectrum, rtol=1.6e-3).orders == (1, 2)


@pytest.mark.filterwarnings("ignore:.*was it given in millimetres:UserWarning")
def test_what_weighs_nothing_has_no_lever() -> None:
    engine = cp.Engine.preset("i3")
    weighted = engine.with_counterweights([cp.Unbalance(0.0, z=1e9)])
    assert weighted.balance(6000).orders == engine.balance(6000).orders
    assert weighted.balance(6000).total.moment.peak == engine.balance(6000).total.moment.peak
