"""Counterweights and balance shafts: what they are, and that every analysis counts them."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
import sympy as sp
from crankpin import Shaft, Unbalance
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import rotors, time_domain
from support import engines, in_turn
from support.engines import CYLINDER

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from crankpin.model.engine import Hold

I4 = cp.Engine.preset("i4")
V6 = cp.Engine.preset("v6-60")
RPM = 500.0
OMEGA = 2 * np.pi * RPM / 60

# Sums of some tens of terms, each rounded a few times to 1.1e-16.
ROUNDING = 1e-13

WEIGHTS = [
    Unbalance(0.011, z=-0.05, angle_deg=30),
    Unbalance(0.02, z=0.33, angle_deg=180, pin=2),
    Unbalance(0.007, z=0.1, angle_deg="2160/7", pin=4),
]
SHAFTS = [
    Shaft(-1, [Unbalance(0.009, 0.02, 77), Unbalance(0.01, 0.2, 270)], x=0.05, y=-0.1, name="left"),
    Shaft(2, [Unbalance(0.003, 0.15, "360/7")], x=-0.08, y=0.2),
    Shaft(-2, [Unbalance(0.004, 0.0, 10)], y=0.03),
    Shaft(1, [Unbalance(0.005, 0.25, 200)], x=0.1),
]
FAST = Shaft(3, [Unbalance(0.002, 0.1, 40)], x=-0.1, y=0.05)
EQUIPPED = V6.replace(rotating_mass=0.3).with_counterweights(WEIGHTS).with_shafts(SHAFTS)


# --- what they are --------------------------------------------------------------------------------


def test_unbalance_and_shaft_keep_what_is_given() -> None:
    weight = Unbalance(amount=np.float64(0.01), z=0, angle_deg="51.4", pin=np.int64(3))  # type: ignore[arg-type]
    assert (weight.amount, weight.z, weight.angle_deg, weight.pin) == (0.01, 0.0, 51.4, 3)
    third = Unbalance(0.01, 0.0, "1/3")
    assert (third.angle_deg, third.exact_angle) == (1.0 / 3.0, "1/3")
    for exact in ("1/1001", "1350/7", "10/3"):  # floats of the first read back as themselves
        one = Unbalance(0.01, 0.0, exact)
        copies = [one.replace(z=0.0), pickle.loads(pickle.dumps(one))]  # noqa: S301
        engine = cp.Engine.preset("single").with_counterweights([one])
        copies += [*engine.counterweights, *cp.Engine.from_toml(engine.to_toml()).counterweights]
        assert all(each == one and each.exact_angle == one.exact_angle for each in copies)
        assert all(type(each.angle_deg) is float for each in copies)
    assert Unbalance(0.01, 0.0).angle_deg == 0.0
    weight = Unbalance(0.01, 0.0, "51.4")
    shaft = Shaft(-2, [weight], x=1, y=2, name="lower")
    assert (shaft.ratio, shaft.x, shaft.y, shaft.name) == (-2, 1.0, 2.0, "lower")
    assert shaft.unbalances == (weight,)
    assert shaft == Shaft(-2, (weight,), 1, 2, "lower")
    halves = [Shaft(ratio, [weight]).ratio for ratio in ("1/2", -0.5, Fraction(3, 2), "-2", 1.0)]
    assert halves == [0.5, -0.5, 1.5, -2, 1]
    assert [type(ratio) for ratio in halves] == [float, float, float, int, int]
    assert hash(shaft) == hash(Shaft(-2, (weight,), 1, 2, "lower"))
    assert eval(repr(shaft)) == shaft  # noqa: S307 - its own
    assert shaft.replace(x=3.0) == Shaft(-2, [weight], 3, 2, "lower")
    assert weight.replace(z=0.1) == Unbalance(0.01, 0.1, "51.4")
    with pytest.raises(cp.InputError, match="ratio = 0"):
        shaft.replace(ratio=0)
    with pytest.raises(AttributeError):
        shaft.ratio = 1  # type: ignore[misc]


def test_files_carry_shafts_at_halves_of_crank_speed() -> None:
    camshafts = [Shaft(ratio, [Unbalance(0.02, 0.1)]) for ratio in ("1/2", "-3/2", 2)]
    engine = I4.with_shafts(camshafts)
    text = engine.to_toml()
    assert all(f"ratio = {ratio}\n" in text for ratio in ("0.5", "-1.5", "2"))
    for typed in (text, text.replace("ratio = 0.5", 'ratio = "1/2"')):
        assert cp.Engine.from_toml(typed).shafts == tuple(camshafts)
    with pytest.raises(cp.InputError, match=r"multiple of 1/2"):
        cp.Engine.from_toml(text.replace("ratio = 0.5", "ratio = 0.4"))
    with pytest.raises(cp.InputError, match=r"cranks\[1\].ratio = 1/2: cylinders need a"):
        cp.Engine.from_lists(
            CYLINDER, tdc_deg=[0, 0], bank_deg=[90, 90], z=[0, 0.1], cranks=[(0.2, 0, 0.5)],
            crank=[0, 1],
        )  # fmt: skip


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Unbalance("x", 0), "^amount = 'x': give a number"),  # type: ignore[arg-type]
        (lambda: Unbalance(0.1, None), "^z = None: give a number"),  # type: ignore[arg-type]
        (lambda: Unbalance(0.1, 0, "x"), "^angle_deg = x: give degrees"),
        (lambda: Unbalance(0.1, 0, float("nan")), "^angle_deg = NaN"),
        (lambda: Unbalance(-0.1, 0), "^amount = -0.1: give zero or more"),
        (lambda: Unbalance(float("nan"), 0), "^amount = nan: give a finite number"),
        (lambda: Unbalance(0.1, float("-inf")), "^z = -inf: give a finite number"),
        (lambda: Shaft(0, []), "^ratio = 0: give a multiple of 1/2 other than 0"),
        (lambda: Shaft(1, [], x=float("inf")), "^x = inf: give a finite number"),
        (lambda: Shaft(1, [Unbalance(1, 0, pin=2)]), r"^unbalances\[0\].pin = 2: leave it out"),
        (lambda: Unbalance(0.1, 0, pin=0), "^pin = 0: give the number of a cylinder, from 1"),
        (lambda: Unbalance(0.1, 0, pin=1.5), "^pin = 1.5: give a whole number"),  # type: ignore[arg-type]
        (lambda: Shaft(1.3, []), "^ratio = 1.3: give a multiple of 1/2"),
        (lambda: Shaft("1/3", []), "^ratio = '1/3': give a multiple of 1/2"),
        (lambda: Shaft("1/0", []), "^ratio = '1/0': give a multiple of 1/2"),
        (lambda: Shaft(1, [], x="left"), "^x = 'left': give a number"),  # type: ignore[arg-type]
        (lambda: Shaft(1, [], name=3), "^name = 3"),  # type: ignore[arg-type]
        (lambda: Shaft(1, [3]), r"^unbalances\[0\] = 3: give a crankpin.Unbalance"),  # type: ignore[list-item]
        (lambda: Shaft(1, Unbalance(0.1, 0)), "^unbalances = .* list of crankpin.Unbalance"),  # type: ignore[arg-type]
        (lambda: I4.with_counterweights([3]), r"^counterweights\[0\] = 3: give a crankpin.Unbal"),  # type: ignore[list-item]
        (lambda: I4.with_counterweights(Unbalance(1, 0)), "^counterweights = .*: give a list of"),  # type: ignore[arg-type]
        (lambda: I4.with_shafts([Unbalance(1, 0)]), r"^shafts\[0\] = .*: give a crankpin.Shaft"),  # type: ignore[list-item]
        (lambda: I4.with_shafts(Shaft(1, [])), "^shafts = .*: give a list of crankpin.Shaft"),  # type: ignore[arg-type]
    ],
)
def test_unbalances_and_shafts_of_the_wrong_kind_are_rejected_by_name(
    make: Callable[[], Any], words: str
) -> None:
    with pytest.raises(cp.InputError, match=words):
        make()


@pytest.mark.parametrize(
    ("weight", "words"),
    [
        (lambda: Unbalance(0.1, 0, pin=5), "pin = 5: give a cylinder's number, 1 to 4"),
        (lambda: Unbalance(1e31, 0), "amount = 1e31: give a finite number of magnitude 1e30"),
    ],
)
@pytest.mark.filterwarnings("ignore:amount = 1e.31 kg·m. was it given in g·mm")
def test_an_engine_rejects_a_counterweight_out_of_range(
    weight: Callable[[], Unbalance], words: str
) -> None:
    with pytest.raises(cp.InputError, match=words):
        I4.with_counterweights([Unbalance(0.1, 0), weight()])
    with pytest.raises(cp.InputError, match=words):
        I4.replace(counterweights=[weight()])


@pytest.mark.parametrize(
    ("shaft", "words"),
    [
        (lambda: Shaft(21, []), "ratio = 21: give a multiple of 1/2 from -20 to 20 except 0"),
        (lambda: Shaft(-(10**9), []), "ratio = -1000000000: give a multiple of 1/2 from -20 to 20"),
        (lambda: Shaft(1, [], y=1e31), "y = 1e31"),
    ],
)
def test_an_engine_rejects_a_shaft_out_of_range(shaft: Callable[[], Shaft], words: str) -> None:
    with pytest.raises(cp.InputError, match=rf"shafts\[1\].{words}"):
        I4.with_shafts([Shaft(1, []), shaft()])


def test_with_counterweights_and_with_shafts_replace_those_of_the_engine() -> None:
    assert EQUIPPED.counterweights == tuple(WEIGHTS)
    assert EQUIPPED.shafts == tuple(SHAFTS)
    assert V6.counterweights == V6.shafts == ()
    assert EQUIPPED.with_counterweights([]).with_shafts([]) == V6.replace(rotating_mass=0.3)
    assert EQUIPPED.with_shafts(SHAFTS[:1]).shafts == tuple(SHAFTS[:1])
    assert EQUIPPED.with_counterweights(iter(WEIGHTS)) == EQUIPPED


def test_with_counterweights_means_what_the_builders_and_replace_mean() -> None:
    given: dict[str, Any] = {"counterweights": WEIGHTS, "shafts": SHAFTS}
    assert cp.Engine.preset("v6-60", rotating_mass=0.3, **given) == EQUIPPED
    assert V6.replace(rotating_mass=0.3, **given) == EQUIPPED
    arrays: dict[str, Any] = {name: np.array(each) for name, each in given.items()}
    assert cp.Engine.preset("v6-60", rotating_mass=0.3, **arrays) == EQUIPPED
    lists: dict[str, Any] = {"tdc_deg": V6.tdc_deg, "bank_deg": V6.bank_deg, "z": V6.z}
    made = cp.Engine.from_lists(V6.cylinders, rotating_mass=0.3, **lists, **given)
    assert made.counterweights == EQUIPPED.counterweights
    assert made.shafts == EQUIPPED.shafts
    assert EQUIPPED.replace(name="x").replace(name=V6.name) == EQUIPPED
    assert EQUIPPED.replace(shafts=[]).counterweights == EQUIPPED.counterweights


def test_equality_tells_engines_of_other_counterweights_and_shafts_apart() -> None:
    others = [
        V6,
        EQUIPPED.with_counterweights(WEIGHTS[:2]),
        EQUIPPED.with_counterweights([*WEIGHTS[:2], Unbalance(0.007, 0.1, "2160/7", pin=3)]),
        EQUIPPED.with_shafts(SHAFTS[:3]),
        EQUIPPED.with_shafts([*SHAFTS[:3], Shaft(1, [Unbalance(0.005, 0.25, 201)], x=0.1)]),
    ]
    assert all(other != EQUIPPED for other in others)


def test_copies_and_files_carry_counterweights_and_shafts(tmp_path: Path) -> None:
    EQUIPPED.save(tmp_path / "engine.toml")
    EQUIPPED.save(tmp_path / "engine.json")
    for back in (
        copy.copy(EQUIPPED),
        copy.deepcopy(EQUIPPED),
        pickle.loads(pickle.dumps(EQUIPPED)),  # noqa: S301 - its own
        cp.Engine.from_toml(EQUIPPED.to_toml()),
        cp.Engine.from_json(EQUIPPED.to_json()),
        cp.Engine.load(tmp_path / "engine.toml"),
        cp.Engine.load(tmp_path / "engine.json"),
    ):
        assert back == EQUIPPED
        assert hash(back) == hash(EQUIPPED)
        assert back.counterweights == tuple(WEIGHTS)
        assert back.shafts == tuple(SHAFTS)


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("pin = 2", "pin = 7", r"counterweights\[1\].pin = 7: give a cylinder's number, 1 to 6"),
        ("pin = 2", "pin = 0", r"counterweights\[1\].pin = 0"),
        ("ratio = -2", "ratio = 0", r"shafts\[2\].ratio = 0"),
        ("amount = 0.011", "amount = -0.011", r"counterweights\[0\].amount = -0.011"),
        ("amount = 0.009", "weight = 0.009", "weight"),
        ("x = 0.05", "x = nan", r"shafts\[0\].x = NaN"),
    ],
)
def test_a_file_with_a_wrong_shaft_is_rejected_by_name(before: str, after: str, words: str) -> None:
    text = EQUIPPED.to_toml()
    assert before in text
    with pytest.raises(cp.InputError, match=words):
        cp.Engine.from_toml(text.replace(before, after, 1))


def test_repr_lists_counterweights_and_shafts() -> None:
    lines = repr(EQUIPPED).splitlines()
    assert lines[4].startswith(
        "counterweights: 0.011 kg·m at 30°, z = -0.05 m, 0.02 kg·m at pin 2 + 180°, z = 0.33 m, "
    )
    assert len(lines[4]) == 100
    assert lines[5:9] == [
        "balance shaft left: ratio -1 at (0.05, -0.1) m, 0.019 kg·m",
        "balance shaft: ratio +2 at (-0.08, 0.2) m, 0.003 kg·m",
        "balance shaft: ratio -2 at (0, 0.03) m, 0.004 kg·m",
        "balance shaft: ratio +1 at (0.1, 0) m, 0.005 kg·m",
    ]
    assert "balance shaft left: ratio -1" in EQUIPPED._repr_html_()
    many = I4.with_counterweights([Unbalance(0.01, 0)] * 1000).with_shafts([Shaft(1, [])] * 1000)
    assert repr(many).count("\n") < 17


# --- what they do ---------------------------------------------------------------------------------


def rotors_of(engine: cp.Engine) -> list[rotors.Rotor]:
    """All that rotates of an engine, each as one mass at 0.1 m from its axis."""
    found = [
        rotors.Rotor(mass, c.crank_radius, pin, z)
        for mass, c, pin, z in zip(
            engine.rotating_mass, engine.cylinders, engine.pin_deg, engine.z, strict=True
        )
    ]
    for weight in engine.counterweights:
        start = 0.0 if weight.pin is None else engine.pin_deg[weight.pin - 1]
        found.append(rotors.Rotor(weight.amount / 0.1, 0.1, start + degrees(weight), weight.z))
    for shaft in engine.shafts:
        axis = complex(shaft.x, shaft.y)
        found += [
            rotors.Rotor(w.amount / 0.1, 0.1, degrees(w), w.z, shaft.ratio, axis)
            for w in shaft.unbalances
        ]
    return found


def degrees(weight: Unbalance) -> float:
    over, _, under = str(weight.angle_deg).partition("/")
    return float(over) / float(under or 1)


def rederived(engine: cp.Engine, reference_z: float | None) -> dict[str, np.ndarray]:
    """Force, moment and roll torque at 256 crank angles, in plain NumPy."""
    parts, theta = engine.cylinders, time_domain.crank_angles(256)
    lists = time_domain.EngineLists(
        crank_radius=[c.crank_radius for c in parts],
        rod_length=[c.rod_length for c in parts],
        reciprocating_mass=[c.reciprocating_mass for c in parts],
        pin_offset=[c.pin_offset for c in parts],
        tdc_deg=engine.tdc_deg,
        bank_deg=engine.bank_deg,
        z=engine.z,
    )
    plane = (engine.z.max() + engine.z.min()) / 2 if reference_z is None else reference_z
    force, moment, torque = rotors.wrench(rotors_of(engine), RPM, plane)
    return {
        "force": force + time_domain.force(lists, RPM, theta),
        "moment": moment + time_domain.moment(lists, RPM, theta, plane),
        "torque": torque + time_domain.roll_torque(lists, RPM, theta),
    }


# Differentiating 256 samples twice lifts rounding by up to 128²; a few kg·m turn at levers of 1 m.
NEAR = 1e-11 * OMEGA**2


def agree(found: np.ndarray, expected: np.ndarray) -> bool:
    return bool(np.abs(found - expected).max() <= NEAR)


@pytest.mark.parametrize("reference_z", [None, 0.0, -1.3])
@pytest.mark.parametrize(
    "engine", [EQUIPPED, I4.with_shafts([*SHAFTS, FAST]), V6.replace(rotating_mass=1)]
)
def test_waveform_counts_what_rotates(engine: cp.Engine, reference_z: float | None) -> None:
    theta = np.degrees(time_domain.crank_angles(256))
    expected = rederived(engine, reference_z)
    for orders in (None, range(1, 60)):
        w = engine.replace(reference_z=reference_z).waveform(RPM, theta_deg=theta, orders=orders)
        for quantity in ("force", "moment", "torque"):
            assert agree(getattr(w, quantity), expected[quantity]), (orders, quantity)


@pytest.mark.parametrize("reference_z", [None, 0.07])
def test_balance_counts_what_rotates(reference_z: float | None) -> None:
    expected, orders = rederived(EQUIPPED, reference_z), [1, 2, 3, 4, 6]
    b = EQUIPPED.replace(reference_z=reference_z).balance(RPM, orders=orders)
    for quantity in ("force", "moment"):
        found = getattr(b, quantity)
        forward, backward = time_domain.forward_backward(expected[quantity], orders)
        assert agree(found.xy, time_domain.peak_phasors(expected[quantity], orders))
        assert agree(found.forward, forward)
        assert agree(found.backward, backward)
        total = getattr(EQUIPPED.replace(reference_z=reference_z).balance(RPM).total, quantity).peak
        samples = np.hypot(*expected[quantity].T)
        # Between samples 1.4° apart the largest is hidden by about n²·(1.4°/2)²/2.
        assert samples.max() * (1 - 1e-9) <= total <= samples.max() * (1 + 1e-2)
    torque = time_domain.peak_phasors(expected["torque"], orders)
    assert agree(np.asarray(b.torque), torque)


def test_sweep_counts_what_rotates() -> None:
    s = cp.sweep(EQUIPPED, rpm=[RPM / 3, RPM], rod_ratio=[0.2, 0.3], orders=[1, 2, 4])
    for place, ratio in enumerate([0.2, 0.3]):
        cylinders = [c.replace(rod_length=c.crank_radius / ratio) for c in EQUIPPED.cylinders]
        engine = EQUIPPED.replace(cylinder=cylinders)
        expected = rederived(engine, None)
        for quantity in ("force", "moment"):
            phasors = time_domain.peak_phasors(expected[quantity], [1, 2, 4])
            assert agree(getattr(s, quantity).xy[place, 1], phasors)
        torque = time_domain.peak_phasors(expected["torque"], [1, 2, 4])
        assert agree(np.asarray(s.torque)[place, 1], torque)
        w = s.waveform(np.degrees(time_domain.crank_angles(256)), exact=True)
        assert agree(w.force[place, 1], expected["force"])
        assert agree(w.torque[place, 1], expected["torque"])


@pytest.mark.parametrize("hold", ["pins", "firing"])
def test_sweep_of_bank_angles_moves_weights_at_pins_and_no_others(hold: Hold) -> None:
    angles = [40.0, 60.0, 110.0]
    s = cp.sweep(EQUIPPED, rpm=RPM, bank_angle_deg=angles, hold=hold, orders=[1, 2])
    for place, angle in enumerate(angles):
        engine = EQUIPPED.with_bank_angle(angle, hold=hold)
        assert engine.counterweights == tuple(WEIGHTS)
        assert engine.shafts == tuple(SHAFTS)
        expected = rederived(engine, None)
        for quantity in ("force", "moment"):
            phasors = time_domain.peak_phasors(expected[quantity], [1, 2])
            assert agree(getattr(s, quantity).xy[place], phasors)


def test_with_first_tdc_turns_what_rotates_with_the_crank() -> None:
    turned = EQUIPPED.with_first_tdc(60 + 30)
    before = EQUIPPED.waveform(RPM, theta_deg=np.arange(0.0, 360.0, 7.0))
    shift = float(turned.tdc_deg[0] - EQUIPPED.tdc_deg[0])
    after = turned.waveform(RPM, theta_deg=np.arange(0.0, 360.0, 7.0) + shift)
    for quantity in ("force", "moment", "torque"):
        expected = getattr(before, quantity)
        apart = np.abs(getattr(after, quantity) - expected).max()
        assert apart <= ROUNDING * np.abs(expected).max()


def test_spectrum_replaces_pistons_and_leaves_what_rotates() -> None:
    bare = V6.replace(rotating_mass=0.3)
    spectrum, orders = {1: 0.01, 2: 0.003}, [1, 2, 3]
    found = EQUIPPED.balance(RPM, orders=orders, spectrum=spectrum).force.xy
    without = bare.balance(RPM, orders=orders, spectrum=spectrum).force.xy
    equipment = (
        EQUIPPED.balance(RPM, orders=orders).force.xy - bare.balance(RPM, orders=orders).force.xy
    )
    # Forces are some kg·m times ω².
    np.testing.assert_allclose(found - without, equipment, rtol=0, atol=ROUNDING * 0.1 * OMEGA**2)


@pytest.mark.parametrize("ratio", [3, -7, 20, -20])
def test_auto_orders_count_shafts_of_any_ratio(ratio: int) -> None:
    # At orders 19 and above pistons add less than any tolerance.
    shaft = Shaft(ratio, [Unbalance(0.001, 0.1)], x=0.1)
    odd, order = I4.with_shafts([shaft]), abs(ratio)
    b = odd.balance(RPM)
    assert order in b.orders
    assert order not in I4.balance(RPM).orders
    part = b[order].force.forward if ratio > 0 else b[order].force.backward
    np.testing.assert_allclose(abs(part), 0.001 * (ratio * OMEGA) ** 2, rtol=1e-13)
    s = cp.sweep(odd, rpm=[1000, 2000], rod_ratio=[0.2, 0.3])
    assert order in s.orders


# --- the forward theorem --------------------------------------------------------------------------


def bob_weights(engine: cp.Engine, part: str | float = 0.5) -> list[Unbalance]:
    """Half of each reciprocating mass opposite its crankpin."""
    return [
        Unbalance(float(part) * c.reciprocating_mass * c.crank_radius, float(z), 180, pin=number)
        for number, (c, z) in enumerate(zip(engine.cylinders, engine.z, strict=True), start=1)
    ]


ALL_PRESETS = {name: cp.Engine.preset(name).replace(rotating_mass=0) for name in cp.presets()}
PRESETS = {
    # Of a crank that turns backwards bob weights remove backward parts; link rods have others.
    name: engine
    for name, engine in ALL_PRESETS.items()
    if all(ratio > 0 for *_, ratio in engine._core.cranks[0]) and not any(engine._core.link_rods)
}
CENTRED = [name for name, e in PRESETS.items() if not any(c.pin_offset for c in e.cylinders)]


@in_turn("name", CENTRED)
def test_bob_weights_of_half_the_mass_remove_all_forward_parts_of_order_1(name: str) -> None:
    engine = PRESETS[name]
    balanced = engine.with_counterweights(bob_weights(engine))
    for reference_z in (None, 0.123):
        before = engine.replace(reference_z=reference_z).balance(RPM, orders=[1])
        after = balanced.replace(reference_z=reference_z).balance(RPM, orders=[1])
        for quantity in ("force", "moment"):
            assert getattr(after, quantity).forward.tolist() == [0.0]
            np.testing.assert_allclose(
                getattr(after, quantity).backward,
                getattr(before, quantity).backward,
                rtol=1e-12,
                atol=getattr(before, quantity).zero_bound.max(),
            )
        verdicts = balanced.vanishing_orders([1], reference_z=reference_z)
        assert verdicts.force.forward[1] == "vanishes"
        assert verdicts.moment.forward[1] == "vanishes"


@pytest.mark.parametrize("name", sorted(set(PRESETS) - set(CENTRED)))
def test_bob_weights_leave_half_of_what_a_pin_offset_adds_to_order_1(name: str) -> None:
    engine = PRESETS[name]
    b = engine.with_counterweights(bob_weights(engine)).balance(RPM, orders=[1])
    expected = {"force": 0j, "moment": 0j}
    for c, pin, z in zip(engine.cylinders, engine.pin_deg, engine.z, strict=True):
        first = rederived_first_harmonic(c)
        part = 0.5 * (first - 1) * np.exp(1j * np.deg2rad(pin))
        part *= c.reciprocating_mass * c.crank_radius * OMEGA**2
        expected["force"] += part
        expected["moment"] += 1j * (z - engine.reference_z) * part
    size = sum(c.reciprocating_mass * c.crank_radius for c in engine.cylinders) * OMEGA**2
    assert abs(b.force.forward[0] - expected["force"]) < 1e-10 * size
    assert abs(b.moment.forward[0] - expected["moment"]) < 1e-10 * size * np.ptp(engine.z)


def rederived_first_harmonic(cylinder: cp.Cylinder) -> complex:
    """a₁ by Fourier transform of the piston's height, whose second derivative is minus it."""
    r, rod, e = cylinder.crank_radius, cylinder.rod_length, cylinder.pin_offset
    theta = time_domain.crank_angles(256)
    height = r * np.cos(theta) + np.sqrt(rod**2 - (r * np.sin(theta) - e) ** 2)
    return complex(time_domain.peak_phasors(height, [1])[0] / r)


@settings(max_examples=25, deadline=None)
@given(fraction=st.floats(1e-20, 2.0), name=st.sampled_from(["v6-60", "i3", "v-twin-90", "single"]))
def test_forward_part_falls_by_twice_the_fraction_balanced(fraction: float, name: str) -> None:
    engine = PRESETS[name]
    before = engine.balance(RPM, orders=[1])
    after = engine.with_counterweights(bob_weights(engine, fraction)).balance(RPM, orders=[1])
    size = len(engine) * 0.45 * 0.05 * OMEGA**2
    for quantity, scale in (("force", size), ("moment", size * max(np.ptp(engine.z), 1e-9))):
        expected = (1 - 2 * fraction) * getattr(before, quantity).forward
        np.testing.assert_allclose(
            getattr(after, quantity).forward, expected, rtol=0, atol=ROUNDING * scale
        )


# --- exact sums -----------------------------------------------------------------------------------


def test_closed_form_has_a_term_for_each_load() -> None:
    half = I4.replace(rotating_mass=0.45).with_counterweights(bob_weights(I4))
    form = half.closed_form(1, "force")
    assert len(form.x_terms) == len(form.y_terms) == 12  # pistons, rotating masses, weights
    assert form.peak == 0
    lone = PRESETS["single"]
    form = lone.with_counterweights(bob_weights(lone)).closed_form(1, "force")
    assert (form.forward, form.backward) == (0, form.F * sp.I / 2)
    assert form.peak_xy == (form.F / 2, form.F / 2)


def test_closed_form_evaluates_to_the_balance() -> None:
    weights = [Unbalance(0.01, 0.1, 30), Unbalance(0.02, 0.3, 180, pin=2)]
    shafts = [Shaft(-1, [Unbalance(0.01, 0.2, "360/7")], x=0.1), Shaft(1, [Unbalance(0.03, 0.1)])]
    engine = I4.with_counterweights(weights).with_shafts(shafts)
    b = engine.balance(RPM, orders=[1])[1]
    for quantity in ("force", "moment"):
        values = engine.closed_form(1, quantity).evaluate(RPM)
        found = getattr(b, quantity)
        expected = {"x": found.x, "y": found.y, "forward": found.forward}
        expected["backward"] = found.backward
        for axis, value in expected.items():
            assert abs(values[axis] - complex(value)) < ROUNDING * OMEGA**2, (quantity, axis)


def test_lanchester_shafts_remove_the_second_order_of_an_inline_four() -> None:
    amplitude = float(CYLINDER.harmonics([2])[0].real) * 0.5 * 0.045
    i4, middle = engines.I4, engines.I4.reference_z
    # Each shaft has half of four pistons' amplitude, over the square of its ratio.
    pair = [
        Shaft(ratio, [Unbalance(4 * amplitude / 2 / 4, z=middle, angle_deg=-90)], x=x)
        for ratio, x in [(2, 0.08), (-2, -0.08)]
    ]
    smooth = i4.with_shafts(pair)
    before, after = (engine.balance(RPM, orders=[2])[2] for engine in (i4, smooth))
    assert after.force.peak <= ROUNDING * before.force.peak
    assert after.moment.peak <= ROUNDING * before.force.peak * 0.3
    # Both shafts push down together, at the same distance to either side.
    assert after.torque.peak == pytest.approx(before.torque.peak, rel=ROUNDING)
    high = [
        Shaft(ratio, [Unbalance(4 * amplitude / 2 / 4, z=middle, angle_deg=-90)], x=x, y=y)
        for ratio, x, y in [(2, 0.08, 0.1), (-2, -0.08, 0.0)]
    ]
    raised = i4.with_shafts(high).balance(RPM, orders=[2])[2]
    assert raised.force.peak <= ROUNDING * before.force.peak
    assert raised.torque.peak != pytest.approx(before.torque.peak, rel=1e-3)


@pytest.mark.parametrize("ratio", [1, -1, 2, -2, 5])
def test_vanishing_orders_count_shafts(ratio: int) -> None:
    opposed = [Unbalance(0.01, 0.1, 0), Unbalance(0.01, 0.2, 180)]
    boxer = cp.Engine.preset("boxer-6").replace(rotating_mass=0)
    order = abs(ratio)
    couple = boxer.with_shafts([Shaft(ratio, opposed, x=0.1)]).vanishing_orders([order])
    assert [word[order] for _, word in couple.force.parts] == ["vanishes"] * 4
    assert couple.moment.forward[order] == ("remains" if ratio > 0 else "vanishes")
    assert couple.moment.backward[order] == ("remains" if ratio < 0 else "vanishes")
    alone = boxer.with_shafts([Shaft(ratio, opposed[:1], x=0.1)]).vanishing_orders([order])
    assert alone.force.forward[order] == ("remains" if ratio > 0 else "vanishes")
    assert alone.force.backward[order] == ("remains" if ratio < 0 else "vanishes")
