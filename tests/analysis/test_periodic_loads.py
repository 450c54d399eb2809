"""Periodic loads that are given, in every reading: against plain free bodies, and laws of sums."""

from __future__ import annotations

import contextlib
import copy
import math
import pickle
import warnings
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin.view import mounted
from crankpin.view.figures import figures
from rederivation import periodic
from support import in_turn
from support.several_cranks import Draft

if TYPE_CHECKING:
    from collections.abc import Callable

QUANTITIES = ("force", "moment", "torque", "crank_torque")
THETA = np.arange(0.0, 720.0, 7.5)
SEEDS = range(24)


def drawn(random: np.random.Generator) -> dict[str, Any]:
    """Draw a load from few values, so that orders, phases and places coincide."""

    def pick(*values: Any) -> Any:  # noqa: ANN401 - one of them
        return values[int(random.integers(0, len(values)))]

    orders = (0.5, 1, 1.5, 2, 4)
    load: dict[str, Any] = {
        "on": pick("shaft", "block", "both"),
        "direction_deg": pick(0, 30, 90),
        "phase_deg": pick(0, 0, 45, 400),
        "z": pick(0.0, 0.1, -0.2),
        "turning": pick(False, False, True),
        "ratio": pick(1, 1, 0.5, -1, 2, -1.5),
        "axis": pick((0.0, 0.0), (0.1, -0.2)),
        "at_rpm": pick(None, None, 2000.0),
    }
    kinds = pick(("force",), ("torque",), ("force", "torque"))
    for kind in kinds:
        count = int(random.integers(1, 3))
        chosen = random.choice(orders, size=count, replace=False)
        load[kind] = {n: complex(pick(3, -8), pick(0, 2)) for n in chosen.tolist()}
    if "torque" in kinds:
        load["torque"][0] = complex(pick(5, -2))
    if load["turning"] and "force" in kinds:
        load["force"][0] = complex(7)
    return load


def built(load: dict[str, Any], name: str = "load", **changes: Any) -> cp.PeriodicLoad:  # noqa: ANN401
    """Return a drawn load as the library takes it."""
    x, y = load["axis"]
    scaled = {} if load["at_rpm"] is None else {"scaling": "speed squared", "rpm": load["at_rpm"]}
    fields = {k: v for k, v in load.items() if k not in ("axis", "at_rpm")}
    return cp.PeriodicLoad(name, **{**fields, **scaled, "x": x, "y": y, **changes})


def engine(seed: int) -> cp.Engine:
    """Return a random engine: of several cranks, or fired."""
    if seed % 2:
        return Draft(seed).engine()
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    four = cp.Engine.preset("i4", cylinder=cylinder)
    cycle = cp.Cycle.example()
    return four.with_cycle([cycle, None, cycle, cycle]) if seed % 4 else four


@in_turn("seed", SEEDS)
def test_a_load_is_its_free_body_in_waveforms_balances_and_sweeps(seed: int) -> None:
    random = np.random.default_rng(seed)
    bare, loads = engine(seed), [drawn(random) for _ in range(2)]
    plane, rpm = bare.reference_z, 3000.0
    with_loads = bare.with_loads([built(load, f"load {k}") for k, load in enumerate(loads)])
    exact, before = with_loads.waveform(rpm, THETA), bare.waveform(rpm, THETA)
    orders = [0.5 * n for n in range(1, 14)]
    balance = with_loads.balance(rpm, orders=orders)
    sweep = cp.sweep(with_loads, rpm=[1000.0, rpm], orders=orders)
    for quantity in QUANTITIES:
        parts = [periodic.net(load, THETA, rpm, plane)[quantity] for load in loads]
        whole = getattr(exact, quantity) - getattr(before, quantity)
        size = np.abs(getattr(before, quantity)).max() + np.abs(parts).max() + 1.0
        # Roundings of some twenty terms.
        assert np.abs(whole - sum(parts)).max() < 1e-12 * size, quantity
        for k, part in enumerate(parts):
            name = f"load {k}"
            if name not in exact.causes:
                assert not part.any()
                continue
            assert np.abs(exact.read(f"{quantity}.{name}") - part).max() < 1e-12 * size
            # By orders: the discrete transform of the free body's samples.
            read = balance._quantity(quantity).part(name)
            at = THETA[THETA < 720.0]
            for order in orders:
                kernel = np.exp(-1j * np.deg2rad(order * at))
                expected = 2.0 * (kernel[:, None] * part.reshape(len(at), -1)).mean(axis=0)
                phasor = np.ravel(read[order].xy if read.kind.planar else read[order].phasor)
                assert np.abs(phasor - expected).max() < 1e-11 * size, (quantity, order)
            swept = sweep._quantity(quantity).part(name)
            assert np.abs(np.asarray(swept)[1] - np.asarray(read)).max() < 1e-12 * size
            if quantity in ("torque", "crank_torque"):
                assert abs(read.cycle_mean - part.mean()) < 1e-12 * size
                assert abs(swept.cycle_mean[1] - read.cycle_mean) < 1e-12 * size


@pytest.mark.parametrize("ratio", ["1/2", "-1/2", 1, -1, "3/2", "-3/2", 2])
@in_turn("seed", range(4))
def test_an_unbalance_is_the_load_that_states_its_force(seed: int, ratio: int | str) -> None:
    """On shafts of any speed, in every reading, and as a free body."""
    random = np.random.default_rng(seed)
    x, y, z = (float(random.choice([0.0, 0.1, -0.2])) for _ in range(3))
    angle, amount, rpm = int(random.choice([0, 30, 90, 200])), 0.02, 3000.0
    speed = float(Fraction(ratio))
    shaft = cp.Shaft(ratio, [cp.Unbalance(amount, z, angle)], x + 0.1, y)
    force = amount * (speed * math.tau * rpm / 60.0) ** 2
    stated: dict[str, Any] = {"scaling": "speed squared", "rpm": rpm, "ratio": ratio, "z": z}
    load = cp.PeriodicLoad(
        "weight", on="shaft", force={0: force}, turning=True, direction_deg=angle, x=x + 0.1, y=y,
        **stated,
    )  # fmt: skip
    bare = engine(seed)
    one, other = bare.with_shafts([*bare.shafts, shaft]), bare.with_loads([load])
    orders = [0.5 * n for n in range(1, 9)]

    def both(read: Callable[[cp.Engine], Any], *quantities: str) -> None:
        for quantity in quantities:
            a, b = (np.asarray(getattr(read(each), quantity)) for each in (one, other))
            assert np.abs(a - b).max() <= 1e-12 * (np.abs(a).max() + force), quantity

    for read in (
        lambda each: each.balance(rpm, orders=orders),
        lambda each: each.balance(rpm, orders=orders).about((0.05, 0.1, 0.2)),
        lambda each: each.waveform(rpm, THETA),
        lambda each: each.waveform(rpm, THETA, orders=orders),
        lambda each: cp.sweep(each, rpm=[1000.0, rpm], orders=orders),
    ):
        both(read, *QUANTITIES)
    both(lambda each: each.balance(rpm, orders=orders).total.force, "peak")
    if seed % 2 == 0:
        both(lambda each: cp.bearing_loads(each, rpm), "main", "crankpin")
    # The free body: a force that turns with the shaft, and its moments.
    turned = force * np.exp(1j * np.deg2rad(angle + speed * THETA))
    exact, before = one.waveform(rpm, THETA), bare.waveform(rpm, THETA)
    plane = z - bare.reference_z
    roll = (x + 0.1) * turned.imag - y * turned.real
    expected = {
        "force": np.column_stack([turned.real, turned.imag]),
        "moment": plane * np.column_stack([-turned.imag, turned.real]),
        "torque": roll,
        "crank_torque": 0.0 * roll,
    }
    for quantity, part in expected.items():
        whole, was = (np.asarray(getattr(each, quantity)) for each in (exact, before))
        size = np.abs(was).max() + force
        assert np.abs(whole - was - part).max() < 1e-12 * size, quantity
    # At half orders an inline engine has nothing but the shaft.
    if not bare.firing_order:
        return
    halves = [0.5, 1.5, 2.5]
    remain = [order for order in halves if order == abs(speed)]
    for proved in (one.vanishing_orders(halves), other.vanishing_orders(halves)):
        assert proved.force.vanishing == tuple(order for order in halves if order not in remain)
    assert one.balance(rpm, orders=halves).force[0.5].status == (
        "summed" if 0.5 in remain else "zero, proved"
    )


@in_turn("seed", SEEDS)
def test_an_engine_with_a_load_is_the_sum_of_both(seed: int) -> None:
    """In numbers and bounds, of orders given and chosen, and about any point."""
    random = np.random.default_rng(100 + seed)
    bare, load = engine(seed), drawn(random)
    both = bare.with_loads([built(load)])
    rpm = 2500.0
    chosen, exact = both.balance(rpm), both.waveform(rpm, THETA)
    for quantity in QUANTITIES:
        summed = chosen.engine.waveform(rpm, THETA, orders=chosen.orders)
        lost = np.abs(getattr(exact, quantity) - getattr(summed, quantity))
        lost = np.linalg.norm(lost, axis=-1) if lost.ndim == 2 else lost
        size = np.abs(getattr(exact, quantity)).max() + 1.0
        assert lost.max() <= chosen.error_bound[quantity] + 1e-12 * size, quantity
    point = (0.1, -0.2, 0.3)
    orders = [0.5, 1, 2, 3, 4]
    moved = both.balance(rpm, orders=orders).about(point)
    alone = bare.balance(rpm, orders=orders).about(point)
    for quantity in QUANTITIES:
        whole, own = moved._quantity(quantity), alone._quantity(quantity)
        if "load" not in whole.parts:
            continue
        added = np.asarray(whole.part("load"))
        size = np.abs(np.asarray(whole)).max() + np.abs(added).max() + 1.0
        assert np.abs(np.asarray(whole) - np.asarray(own) - added).max() < 1e-12 * size
        parts = sum(np.asarray(whole.part(name)) for name in whole.parts)
        assert np.abs(np.asarray(whole) - parts).max() < 1e-12 * size


@in_turn("seed", SEEDS)
def test_loads_add_up_in_bearings_mounts_tolerances_and_words(seed: int) -> None:
    """Of two loads: with both, less with either, plus without is nothing, at half orders too."""
    random = np.random.default_rng(400 + seed)
    bare = engine(seed)
    one, other = (built(drawn(random), name) for name in ("one", "other"))
    engines = [bare.with_loads(loads) for loads in ([], [one], [other], [one, other])]
    orders, rpm = [0.5, 1, 1.5, 2, 3, 4], 2500.0

    def read(each: cp.Engine) -> list[np.ndarray[Any, Any]]:
        arrays = [np.asarray(on_mounts(each).response(rpm, orders=orders).wrench)]
        with contextlib.suppress(cp.InputError):  # a crank without throws has no bearings
            arrays.append(np.asarray(cp.bearing_loads(each, rpm, THETA).main))
        if each.cycles is None:
            spread = cp.tolerances(each, rpm=rpm, orders=orders, z=1e-3, samples=3)
            arrays += [np.asarray(getattr(spread, quantity)) for quantity in QUANTITIES]
        return arrays

    for without, first, second, both in zip(*map(read, engines), strict=True):
        size = np.abs(both).max() + np.abs(without).max() + 1.0
        assert np.abs(both - first - second + without).max() < 1e-11 * size
    texts = [each.explain(rpm).findings for each in engines]
    for findings in texts[1:]:
        assert [each for each in findings if each.kind != "load"] == list(texts[0])
        assert len(findings) > len(texts[0])
    if bare.firing_order:
        stars = [cp.star_diagram(each, orders) for each in engines]
        assert all(np.array_equal(stars[0].sums, star.sums) for star in stars)


@in_turn("seed", SEEDS)
def test_a_load_of_no_size_changes_names_alone(seed: int) -> None:
    random = np.random.default_rng(200 + seed)
    bare, load = engine(seed), drawn(random)
    for kind in ("force", "torque"):
        if kind in load:
            load[kind] = dict.fromkeys(load[kind], 0j)
    nothing = bare.with_loads([built(load)])
    one, other = bare.balance(2000), nothing.balance(2000)
    assert one.orders == other.orders
    for quantity in QUANTITIES:
        assert one.error_bound[quantity] == other.error_bound[quantity]
        mine, theirs = np.asarray(one._quantity(quantity)), np.asarray(other._quantity(quantity))
        assert np.array_equal(mine, theirs), quantity
    proofs = [each.vanishing_orders([1, 2, 3, 4]) for each in (bare, nothing)]
    for kind in ("force", "moment", "torque"):
        mine, theirs = (getattr(each, kind).vanishing for each in proofs)
        assert mine == theirs, kind


def test_pistons_handed_over_as_loads_give_the_engine_again() -> None:
    """Each cylinder's force by its harmonics, along its bore, from its top dead centre on."""
    v6 = cp.Engine.preset("v6-90-odd-fire")
    cylinder = v6.cylinders[0]
    harmonics = cp.slider_crank_harmonics(cylinder.rod_ratio, range(1, 9))
    omega = 3000.0 * np.pi / 30.0
    amount = cylinder.reciprocating_mass * cylinder.crank_radius * omega**2
    given = [
        cp.PeriodicLoad(
            f"piston {k}", on="block", force=dict(enumerate(amount * harmonics, 1)), z=z,
            scaling="speed squared", rpm=3000.0, direction_deg=bank, phase_deg=tdc, cylinder=k,
        )
        for k, (bank, tdc, z) in enumerate(zip(v6.bank_deg, v6.tdc_deg, v6.z, strict=True), 1)
    ]  # fmt: skip
    light = v6.replace(cylinder=cylinder.replace(reciprocating_mass=0.0)).with_loads(given)
    for rpm in (1000.0, 4000.0):
        pins, firing = (
            [each.with_bank_angle(75, hold=hold) for each in (v6, light)]
            for hold in ("pins", "firing")
        )
        for one, other in [(v6, light), pins, firing]:
            a, b = (each.balance(rpm, orders=range(1, 9)) for each in (one, other))
            for quantity in ("force", "moment"):
                mine, theirs = a._quantity(quantity), b._quantity(quantity)
                size = np.abs(np.asarray(mine)).max()
                assert np.abs(np.asarray(mine) - np.asarray(theirs)).max() < 1e-13 * size * 8
    sweeps = [
        cp.sweep(
            each, rpm=[1000.0, 4000.0], bank_angle_deg=[60, 75, 90], hold=hold, orders=[1, 2, 3]
        )
        for hold in ("pins", "firing")
        for each in (v6, light)
    ]
    for swept, again in zip(sweeps[::2], sweeps[1::2], strict=True):
        size = swept.moment.peak.max()
        assert np.abs(swept.moment.peak - again.moment.peak).max() < 1e-12 * size


def test_a_table_over_speed_is_linear_between_its_rows_and_refused_outside() -> None:
    table = cp.PeriodicLoad(
        "generator", on="both", torque={0: [10, 30], 2: [4, 8j]}, rpm=[1000, 3000]
    )
    four = cp.Engine.preset("i4").with_loads([table])
    for rpm, share in [(1000, 0.0), (1500, 0.25), (3000, 1.0)]:
        torque = four.balance(rpm, orders=[2]).crank_torque.part("generator")
        assert abs(torque.cycle_mean - (10 + 20 * share)) < 1e-12
        assert abs(torque[2].phasor - (4 * (1 - share) + 8j * share)) < 1e-12
    swept = cp.sweep(four, rpm=[1000, 1500, 3000], orders=[2]).crank_torque.part("generator")
    assert np.allclose(np.asarray(swept)[:, 0], [4, 3 + 2j, 8j], atol=1e-12)
    for outside in (999, 3001):
        with pytest.raises(cp.InputError, match=r'"generator" is given from 1000 to 3000 rpm'):
            four.balance(outside)
        with pytest.raises(cp.InputError, match="generator"):
            cp.sweep(four, rpm=[2000, outside], orders=[2])
        with pytest.raises(cp.InputError, match="generator"):
            four.waveform(outside)


def test_samples_are_the_orders_that_pass_through_them() -> None:
    random = np.random.default_rng(7)
    for turns, count in [(1, 12), (2, 24), (2, 25), (1, 9)]:
        samples = random.normal(size=count)
        load = cp.PeriodicLoad.from_samples("machine", on="shaft", torque=samples, turns=turns)
        theta = 360.0 * turns * np.arange(count) / count
        torque = cp.Engine.preset("single").with_loads([load]).waveform(1000, theta)
        assert np.abs(torque.read("crank_torque.machine") - samples).max() < 1e-13 * count
    with pytest.warns(UserWarning, match="torque jumps from 9 to 0"):
        cp.PeriodicLoad.from_samples("ramp", on="shaft", torque=np.arange(10.0))


def test_proofs_hold_where_no_load_acts_and_are_undecided_where_one_does() -> None:
    six = cp.Engine.preset("i6")
    along_x = cp.PeriodicLoad("belt", on="shaft", force={1: 5, 0.5: 2}, z=six.reference_z)
    verdicts = six.with_loads([along_x]).vanishing_orders([0.5, 1, 2, 3])
    before = six.vanishing_orders([1, 2, 3])
    assert verdicts.force.vanishing == (2, 3)
    assert before.force.vanishing == (1, 2, 3)
    assert verdicts.moment.vanishing == (0.5, 1, 2, 3)
    balance = six.with_loads([along_x]).balance(3000)
    assert balance.force[1].status == "summed"
    assert balance.force[2].status == "zero, proved"


@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_closed_forms_have_a_symbol_where_a_load_acts(
    quantity: Literal["force", "moment"], turning: bool
) -> None:
    sp = pytest.importorskip("sympy")
    six = cp.Engine.preset("v6-60")
    load = cp.PeriodicLoad(
        "belt", on="shaft", force={1: 50 - 20j, 3: 4}, turning=turning, z=0.4, direction_deg=30,
        scaling="speed squared", rpm=2000,
    )  # fmt: skip
    other = cp.PeriodicLoad("pump", on="both", torque={2: 4}, force={2: 3})
    loaded = six.with_loads([other, load])
    acting, orders = ((0, 2, 4) if turning else (1, 3)), (1, 2, 3, 4)
    for order in orders:
        form, bare = loaded.closed_form(order, quantity), six.closed_form(order, quantity)
        assert form.loads == ((load,) if order in acting else ())
        if order not in acting:
            assert form.peak == bare.peak
            assert form.forward == bare.forward
        else:
            assert "belt" in form.units_text
            assert form.peak.has(sp.Abs)
        balance = getattr(loaded.balance(3000, orders=[order]), quantity)
        values = form.evaluate(3000)
        size = 1e-9 * float(max(balance.peak[0], 1e3))
        for axis in ("x", "y", "forward", "backward"):
            assert abs(values[axis] - getattr(balance, axis)[0]) < size


@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_symbols_of_loads_are_their_phasors(quantity: Literal["force", "moment"]) -> None:
    sp = pytest.importorskip("sympy")
    six = cp.Engine.preset("i6")  # balanced in order 1: nothing but the load
    place = six.reference_z + 0.3
    load = cp.PeriodicLoad(
        "belt", on="block", force={1: 50 - 20j}, z=place, direction_deg=30, phase_deg=40
    )
    form = six.with_loads([load]).closed_form(1, quantity)
    values = {sp.Symbol("P1"): (50 - 20j) * np.exp(-1j * np.radians(40))}
    lever = sp.Symbol("b1", real=True)
    for axis, expected in form.evaluate(1000).items():
        found = complex(getattr(form, axis).subs({**values, lever: 0.3}))
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert float(form.peak.subs({**values, lever: 0.3})) == pytest.approx(
        float(getattr(six.with_loads([load]).balance(1000), quantity)[1].peak)
    )
    text = str(form)
    assert "belt" in text
    assert "P1" in form._repr_latex_().replace("_", "").replace("{", "").replace("}", "")


def test_flywheels_are_driven_by_loads_too() -> None:
    four = cp.Engine.preset("i4", cylinder=cp.Cylinder(0.043, 0.145, 0.5, bore=0.086))
    fired = four.with_cycle(cp.Cycle.example())
    mill = cp.PeriodicLoad("mill", on="shaft", torque={0: -120, 1: 60 - 9j, 0.5: 25j}, ratio="1/2")
    loaded = cp.flywheel(fired.with_loads([mill]), 1500, inertia=0.3)

    def against(theta: np.ndarray) -> np.ndarray:
        waves = [(1, 60 - 9j), (0.5, 25j)]
        angle = np.radians(theta)
        return np.asarray(-0.5 * sum((a * np.exp(1j * n * angle)).real for n, a in waves))

    same = cp.flywheel(fired, 1500, inertia=0.3, load_torque=against)
    assert loaded.irregularity == pytest.approx(same.irregularity, rel=1e-9)
    assert loaded.loads_counted.endswith("loads: mill")
    alone = cp.flywheel(four.with_loads([mill]), 1500, inertia=0.3)
    assert alone.irregularity > 0.0
    with pytest.raises(cp.InputError, match="no driving torque"):
        cp.flywheel(four, 1500, inertia=0.3)


def test_parts_of_pictures_name_loads() -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    fan = cp.PeriodicLoad("fan $1", on="shaft", force={2: 80}, torque={2: 5}, z=-0.1)
    four = cp.Engine.preset("i4").with_loads([fan, fan.replace(name="fan 2")])
    ax = four.plot(kind="side")
    assert any("fan" in text.get_text() and "fan 2" in text.get_text() for text in ax.texts)
    (mark,) = (line for line in ax.lines if line.get_gid() == "crankpin loads")
    assert mark.get_xdata() == pytest.approx([-0.1])
    axes = four.balance(2000).plot(kind="phasors", quantity="force", orders=[2])
    legend = axes[0, 0].figure.legends[0]
    assert "loads" in [text.get_text() for text in legend.get_texts()]
    plt.close("all")


def test_sentences_say_where_a_load_is_the_largest_part() -> None:
    six = cp.Engine.preset("i6")
    large = cp.PeriodicLoad("belt", on="shaft", force={1: 50}, torque={3: 1e-3})
    said = six.with_loads([large]).explain(3000).sentences[-1]
    assert "force of 50 N at order 1, the largest part of it" in said
    assert said.count("largest part") == 1


def test_bearings_carry_what_is_on_the_crank_and_the_crankcase_the_rest() -> None:
    four = cp.Engine.preset("i4")
    theta = np.arange(0.0, 720.0, 15.0)
    before = cp.bearing_loads(four, 3000, theta_deg=theta)
    share: dict[Literal["shaft", "both", "block"], float]
    share = {"shaft": 1.0, "both": 1.0, "block": 0.0}
    for on in share:
        force = {0.5: 40, 2: 30 - 10j}
        load = cp.PeriodicLoad("belt", on=on, force=force, direction_deg=30, z=four.mains[1])
        after = cp.bearing_loads(four.with_loads([load]), 3000, theta_deg=theta)
        x, y = periodic.force_on_shaft(
            {"force": {n: complex(a) for n, a in force.items()}, "direction_deg": 30}, theta, 3000.0
        )
        added = np.asarray(after.main) - np.asarray(before.main)
        expected = np.zeros_like(added)
        expected[1] = share[on] * np.stack([x, y], axis=-1)
        assert np.abs(added - expected).max() < 1e-11 * np.abs(np.asarray(before.main)).max()


def test_loads_survive_files_copies_and_changes(tmp_path: Any) -> None:  # noqa: ANN401 - a path
    random = np.random.default_rng(3)
    loads = [built(drawn(random), f"load {k}") for k in range(6)]
    table = cp.PeriodicLoad(
        "table", on="block", force={1: [1, 2], 2: [0, 1j]}, rpm=[0, 6000], crank=0
    )
    four = cp.Engine.preset("i4").with_loads([*loads, table])
    assert four.loads == (*loads, table)
    assert pickle.loads(pickle.dumps(four)) == four == copy.deepcopy(four)  # noqa: S301
    for suffix in ("toml", "json"):
        path = tmp_path / f"four.{suffix}"
        four.save(path)
        assert cp.Engine.load(path).loads == four.loads
    assert four.replace(name="other").loads == four.loads
    assert four.with_loads([]).loads == ()
    assert hash(loads[0]) == hash(copy.copy(loads[0]))
    assert loads[0].replace(z=0.5).z == 0.5
    assert "load 0" in four.loads_counted
    assert "load 0" in repr(four.balance(1000, torque=False))


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"on": "crank"}, "on"),
        ({"torque": None}, "force"),
        ({"torque": {}}, "force"),
        ({"torque": {1: "a"}}, r"torque\[1\]"),
        ({"torque": {1.25: 3}}, "order"),
        ({"torque": {1: float("nan")}}, r"torque\[1\]"),
        ({"torque": {0: 1j}}, "mean"),
        ({"force": {0: 1}}, "mean"),
        ({"ratio": 0.3}, "ratio"),
        ({"ratio": "a"}, "ratio"),
        ({"ratio": 0}, "ratio"),
        ({"rpm": 1000}, "rpm"),
        ({"scaling": "speed squared"}, "rpm"),
        ({"rpm": [1000, 2000]}, r"torque\[1\]"),
        ({"torque": {1: [1, 2]}, "rpm": [2000, 1000]}, "ascending"),
        ({"crank": 0, "ratio": 2}, "ratio"),
        ({"name": "inertia"}, "name"),
        ({"name": " "}, "name"),
        ({"cylinder": 0}, "cylinder"),
    ],
)
def test_what_no_load_can_be_is_refused(changes: dict[str, Any], match: str) -> None:
    fields: dict[str, Any] = {"name": "load", "on": "both", "torque": {1: 5}, **changes}
    with pytest.raises(cp.InputError, match=match):
        cp.PeriodicLoad(**fields)


def test_a_crank_or_cylinder_that_is_not_there_is_refused() -> None:
    four = cp.Engine.preset("i4")
    with pytest.raises(cp.InputError, match=r"loads\[0\].crank"):
        four.with_loads([cp.PeriodicLoad("a", on="shaft", torque={1: 1}, crank=1)])
    with pytest.raises(cp.InputError, match=r"loads\[0\].cylinder = 5"):
        four.with_loads([cp.PeriodicLoad("a", on="shaft", torque={1: 1}, cylinder=5)])
    with pytest.raises(cp.InputError, match="PeriodicLoad"):
        four.with_loads(["a"])  # type: ignore[list-item]


def on_mounts(engine: cp.Engine) -> cp.Powertrain:
    body = cp.RigidBody(150, (0.01, 0.06, 0.1), (7, 8, 4.5))
    places = [(0.3, 0.0, 0.0), (-0.3, 0.0, 0.0), (0.0, 0.1, 0.5)]
    mounts = [
        cp.Mount(f"{k}", at, stiffness=(2e5, 1e5, 1e5), loss_factor=0.1)
        for k, at in enumerate(places)
    ]
    return cp.Powertrain(engine, body, mounts)


@in_turn("seed", SEEDS)
def test_pages_of_mounts_have_the_loads_of_a_response(seed: int) -> None:
    random = np.random.default_rng(seed)
    engine = cp.Engine.preset("i4")
    if random.random() < 0.5:
        bored = [each.replace(bore=0.08) for each in engine.cylinders]
        engine = engine.replace(cylinder=bored).with_cycle(cp.Cycle.example())
    loads = [built(drawn(random), f"load {k}") for k in range(3)]
    powertrain = on_mounts(engine.with_loads(loads))
    page = mounted.figures(powertrain, 3000.0)["mounted"]
    for rpm in (900.0, 4200.0):
        response = powertrain.response(rpm, orders=page["orders"])
        omega = rpm * np.pi / 30
        inertia, still = (np.array(page[name]) @ [1, 1j] for name in ("inertia", "gas"))
        expected = np.asarray(response.wrench)
        # Each of some hundred terms is rounded once or twice.
        assert np.abs(omega**2 * inertia + still - expected).max() < 1e-12 * np.abs(expected).max()
    table = cp.PeriodicLoad("pump", on="both", torque={2: [1, 2]}, rpm=[1000, 6000])
    with pytest.raises(cp.InputError, match="a page has loads at any speed"):
        mounted.figures(on_mounts(engine.with_loads([table])), 3000.0)


def test_what_is_fitted_over_the_square_of_speed_leaves_other_orders_loads_out() -> None:
    fan = cp.PeriodicLoad("fan", on="shaft", force={2: [1, 2]}, rpm=[1000, 6000], z=-0.1)
    pump = cp.PeriodicLoad("pump", on="block", force={3: 50.0}, z=0.1)
    engine = cp.Engine.preset("v6-60")
    for load in (fan, pump):
        for fit in (cp.counterweights, lambda e: cp.balance_shafts(e, ratios=[1, -1])):
            with_load, without = fit(engine.with_loads([load])), fit(engine)
            assert str(with_load.table) == str(without.table)
            assert with_load.residual[1].moment.peak == without.residual[1].moment.peak
    weights = cp.bob_weight(engine.with_loads([pump])).residual[1].force.peak
    assert weights == cp.bob_weight(engine).residual[1].force.peak


@in_turn("seed", range(40))
def test_weights_of_several_cranks_count_what_scales_as_they_do(seed: int) -> None:
    draft = Draft(seed, ratios=(1, -1))
    engine = draft.engine()
    fan = cp.PeriodicLoad(
        "fan", on="shaft", force={1: 900 - 300j}, z=0.1, scaling="speed squared", rpm=3000
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        fit = cp.counterweights(engine.with_loads([fan]))
        before = cp.counterweights(engine)
    with_load, without = (each.residual[1].force.forward for each in (fit, before))
    # Weights of cranks that turn forwards balance half of a force to and fro; others cannot.
    half = 0.5 * (900 - 300j) / (3000 * np.pi / 30) ** 2
    turns_forwards = any(draft.cranks[crank][2] == 1 for crank in draft.crank_of)
    left = 0.0 if turns_forwards else half
    assert abs(with_load - without - left) < 1e-9 * (abs(without) + abs(half))


@pytest.mark.parametrize("hold", ["pins", "firing"])
def test_shafts_of_loads_turn_with_their_bank(hold: Literal["pins", "firing"]) -> None:
    """In a sweep as in an engine at that bank angle."""
    load = cp.PeriodicLoad(
        "cam", on="block", force={1: 100, 2: 50j}, x=0.1, y=0.2, cylinder=1, direction_deg=20
    )
    six = cp.Engine.preset("v6-60").with_loads([load])
    swept = cp.sweep(six, rpm=1000, bank_angle_deg=[60, 90], hold=hold, orders=[1, 2])
    turned = six.with_bank_angle(90, hold=hold)
    alone = turned.balance(1000, orders=[1, 2])
    np.testing.assert_allclose(swept.torque.peak[1], alone.torque.peak, rtol=1e-12)
    at = turned.loads[0]
    assert abs(complex(at.x, at.y) / complex(0.1, 0.2) - np.exp(-1j * np.pi / 12)) < 1e-12


def test_stars_are_of_firings_and_say_nothing_of_loads() -> None:
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    fired = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    fan = cp.PeriodicLoad("fan", on="shaft", torque={2: 8})
    star, before = (cp.star_diagram(each) for each in (fired.with_loads([fan]), fired))
    assert star.loads_counted == before.loads_counted == "gas: example petrol, full load"
    assert (star.sums == before.sums).all()


def test_pages_say_which_loads_they_count() -> None:
    fan = cp.PeriodicLoad("fan", on="shaft", force={2: 8}, z=-0.1)
    four = cp.Engine.preset("i4")
    assert figures(four.with_loads([fan]), 3000, spectrum=None)["loads"] == (
        "Without gas pressure; loads: fan."
    )
    assert figures(four, 3000, spectrum=None)["loads"] == "Without gas pressure."


def test_what_is_ranked_by_force_names_the_loads_that_act_on_it() -> None:
    fan = cp.PeriodicLoad("fan", on="shaft", force={2: 8}, z=-0.1)
    v6 = cp.Engine.preset("v6-60")
    engines = [each.with_loads([fan]) for each in (v6, v6.with_bank_angle(70, hold="pins"))]
    ranked = cp.rank(engines, rpm=3000, by="total.force.peak")
    assert ranked.loads_counted == "loads: fan"
    assert cp.rank([v6], rpm=3000, by="total.force.peak").loads_counted == ""


@in_turn("seed", SEEDS)
def test_parts_of_a_sweep_are_those_of_its_balances(seed: int) -> None:
    random = np.random.default_rng(seed)
    loaded = engine(seed).with_loads([built(drawn(random), "pump"), built(drawn(random), "fan")])
    speeds = [1000.0, 3500.0]
    swept = cp.sweep(loaded, rpm=speeds, orders=[0.5, 1, 2, 3])
    for quantity in QUANTITIES:
        whole: Any = getattr(swept, quantity)
        names = [quantity, *(f"{quantity}.{part}" for part in whole.parts)]
        assert len(names) >= 1 + 2 * (quantity != "moment")
        for name, what in [(each, what) for each in names for what in swept._readings(each)]:
            found = swept.read(name, what)
            for k, rpm in enumerate(speeds):
                alone = loaded.balance(rpm, orders=swept.orders).read(name, what)
                assert found[k].shape == alone.shape, (name, what)
                # Sums of parts are of other order.
                size = max(np.abs(alone).max(), np.abs(swept.read(quantity, "peak")[k]).max())
                assert np.abs(found[k] - alone).max() <= 1e-12 * size, (name, what)
    dataset = swept.to_xarray()
    assert dataset["force_pump_peak"].dims == ("rpm", "order")


@in_turn("seed", SEEDS)
def test_parts_of_a_sweep_are_read_over_angle_as_in_waveforms(seed: int) -> None:
    random = np.random.default_rng(seed)
    loaded = engine(seed).with_loads([built(drawn(random), "pump"), built(drawn(random), "fan")])
    speeds, theta = [1000.0, 3500.0], np.arange(0, 720, 7.5)
    orders = [0.5, 1, 1.5, 2, 3, 4]
    swept = cp.sweep(loaded, rpm=speeds, orders=orders)
    over_angle = swept.waveform(theta_deg=theta)
    for k, rpm in enumerate(speeds):
        alone = loaded.waveform(rpm, theta_deg=theta, orders=orders)
        for quantity in QUANTITIES:
            size = np.abs(alone.read(quantity)).max()
            parts = getattr(swept, quantity).parts
            # Also one that adds nothing.
            for name in [quantity, *(f"{quantity}.{part}" for part in parts)]:
                found = alone.read(name)
                largest = max(size, np.abs(found).max())
                # Sums of parts are of other order.
                assert np.abs(over_angle.read(name)[k] - found).max() <= 1e-12 * largest, name
