"""Is the core in a browser the library's: the same numbers, the same sentences, in bounded memory?

Bits differ for two reasons alone. Processors multiply and add in one step, rounded once, where
WebAssembly rounds twice; and sines, exponentials and powers are those of another library, a unit in
the last place from the true value. Both are within the bounds of rounding that results report.
"""

from __future__ import annotations

import json
import math
import re
import warnings
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin import _core
from crankpin.model import presets
from crankpin.model.builders import FANS
from crankpin.model.checks import UNITS_ASSUMED
from crankpin.view.figures import figures
from numpy.polynomial import chebyshev
from support.core_in_page import Ask, Calls
from support.several_cranks import fired_engine, random_engine

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

ROOT = Path(__file__).parents[2]
RPM = 3000.0
ORDERS = [1, 2, 3, 4, 6, 8]
CYLINDER = cp.Cylinder(0.043, 0.145, 0.66, bore=0.086)


def results(ask: Ask, calls: Calls) -> list[Any]:
    answers = ask(calls)
    assert [answer["error"] for answer in answers if "error" in answer] == []
    return [answer["result"] for answer in answers]


def preset_engines() -> list[cp.Engine]:
    return [cp.presets()[name] for name in cp.presets()]


def random_engines() -> list[cp.Engine]:
    return [fired_engine(seed) if seed % 4 == 3 else random_engine(seed) for seed in range(200)]


def complexes(entry: dict[str, Any], *names: str) -> np.ndarray[Any, np.dtype[np.complex128]]:
    return np.array([complex(*entry[name]) for name in names])


# --- numbers ------------------------------------------------------------------------------------


@pytest.mark.parametrize("engines", [preset_engines, random_engines])
def test_balances_are_the_librarys(ask: Ask, engines: Callable[[], list[cp.Engine]]) -> None:
    listed = engines()
    calls: Calls = [
        ("balance", {"engine": each.to_json(), "rpm": RPM, "orders": ORDERS}) for each in listed
    ]
    same = 0
    for engine, found in zip(listed, results(ask, calls), strict=True):
        expected = _core.balance(engine._core, RPM, ORDERS, 1e-9, None, None, True)
        for k, entry in enumerate(found["orders"]):
            assert entry["order"] == ORDERS[k]
            for name in ("force", "moment"):
                bound = expected.zero_bound(name)[k]
                # Sizes of terms are of sines too: to a few units in the last place, of samples of
                # link rods to some hundred.
                linked = any(engine.link_rods)
                close = 1e-12 if linked else 1e-14
                assert math.isclose(entry[name]["zero_bound"], bound, rel_tol=close)
                ours = complexes(entry[name], "forward", "backward", "x", "y")
                theirs = np.concatenate(
                    [expected.phasors(name, turning=turning)[k] for turning in (True, False)]
                )
                same += int((ours == theirs).all())
                rest = 1e-12 * abs(theirs).max() if linked else 0.0
                assert (abs(ours - theirs) <= bound + rest).all()
            for name in ("torque", "torque.inertia", "torque.gas"):
                bound = expected.zero_bound(name)[k]
                crank = f"crank_{name}"
                theirs = np.array([expected.phasors(n, turning=False)[k] for n in (name, crank)])
                # Pressure is read between points of a table and integrated: 1e-13 of its torque.
                size = abs(theirs).max() if linked or name != "torque.inertia" else 0.0
                ours = complexes(entry[name], "roll", "crank")
                assert (abs(ours - theirs) <= bound + 1e-12 * size).all()
    # Most are those of the library to the last bit.
    assert same > 0.5 * 2 * len(ORDERS) * len(listed)


def test_totals_and_chosen_orders_are_the_librarys(ask: Ask) -> None:
    listed = preset_engines()
    rpm = 600.0  # the largest presets turn slowly
    calls: Calls = [("balance", {"engine": each.to_json(), "rpm": rpm}) for each in listed]
    for engine, found in zip(listed, results(ask, calls), strict=True):
        balance = engine.balance(rpm)
        assert [entry["order"] for entry in found["orders"]] == list(balance.orders)
        assert found["omitted"] == list(balance.omitted)
        for name in ("force", "moment"):
            total, of = found["total"][name], getattr(balance.total, name)
            size = max(float(getattr(balance, name).peak.sum()), 1e-6)
            # Extrema of sums whose terms are equal to rounding.
            assert abs(total["peak"] - of.peak) <= 1e-12 * size
            assert (abs(np.array(total["peak_xy"]) - of.peak_xy) <= 1e-12 * size).all()
            bound = balance.error_bound[name]
            assert math.isclose(found["error_bound"][name], bound, rel_tol=1e-9, abs_tol=1e-12)


def test_what_vanishes_is_proved_alike(ask: Ask) -> None:
    listed = preset_engines() + [random_engine(seed) for seed in range(40)]
    calls: Calls = [("vanishing", {"engine": each.to_json()}) for each in listed]
    names = [
        *("force.x", "force.y", "force.forward", "force.backward"),
        *("moment.x", "moment.y", "moment.forward", "moment.backward", "torque", "torque.gas"),
    ]
    for engine, found in zip(listed, results(ask, calls), strict=True):
        proofs = _core.vanishing(engine._core, list(range(2, 25, 2)), None, None)
        for k, entry in enumerate(found["orders"]):
            verdicts = [entry[name]["verdict"] for name in names]
            assert [verdict == "vanishes" for verdict in verdicts] == proofs["vanishes"][k].tolist()
            assert [verdict == "remains" for verdict in verdicts] == proofs["remains"][k].tolist()


def test_waveforms_and_sweeps_are_the_librarys(ask: Ask) -> None:
    theta = np.arange(0.0, 721.0, 7.3)
    listed = [cp.Engine.preset(name) for name in ("i4", "v6-60", "v8-crossplane", "v12-60", "w16")]
    listed.append(fired_engine(3))
    angles = np.linspace(0.0, 180.0, 37)
    for engine in listed:
        given = {"engine": engine.to_json(), "rpm": RPM}
        calls: Calls = [
            ("waveform", given | {"theta_deg": theta.tolist()} | how)
            for how in ({}, {"orders": ORDERS})
        ]
        for found, how in zip(results(ask, calls), (None, ORDERS), strict=True):
            waveform = engine.waveform(RPM, theta_deg=theta, orders=how)
            # Of the sizes of single cylinders, of which they are sums.
            size = max(abs(engine.balance(RPM, orders=[1]).force.zero_bound).max() / 1e-14, 1.0)
            for name in ("force", "moment"):
                ours = np.array([found[name]["x"], found[name]["y"]]).T
                assert abs(ours - waveform.read(name)).max() <= 1e-12 * size
            torque = waveform.read("torque")
            assert abs(np.array(found["torque"]) - torque).max() <= 1e-12 * (
                size + abs(torque).max()
            )
        if not hasattr(engine, "bank_angle_deg"):
            continue
        for hold in ("pins", "firing"):
            asked = given | {"bank_angle_deg": angles.tolist(), "hold": hold, "orders": [1, 2]}
            (found,) = results(ask, [("bank_angles", asked)])
            swept = cp.sweep(engine, rpm=RPM, bank_angle_deg=angles, hold=hold, orders=[1, 2])
            for name in ("force", "moment"):
                quantity = getattr(swept, name)
                for k, n in enumerate((1, 2)):
                    bound = 2.0 * quantity[n].zero_bound
                    assert (abs(np.array(found[name][k]) - quantity[n].peak) <= bound).all()


def test_harmonics_are_the_librarys(ask: Ask) -> None:
    ratios = [0.1, 0.25, 1 / 3, 0.5, 0.9, 0.995]
    cases = [(ratio, offset) for ratio in ratios for offset in (0.0, 0.01)]
    cases = [(ratio, offset) for ratio, offset in cases if 1 / ratio - offset > 1.0]
    calls: Calls = [
        ("harmonics", {"rod_ratio": ratio, "offset": offset, "count": 24})
        for ratio, offset in cases
    ]
    for (ratio, offset), found in zip(cases, results(ask, calls), strict=True):
        cylinder = cp.Cylinder(1.0, 1.0 / ratio, 1.0, offset)
        expected = _core.cylinder_harmonics(cylinder._parts, range(1, 25))
        ours = np.array(found["re"]) + 1j * np.array(found["im"])
        # Each order is known to some units in its own last place.
        assert (abs(ours - expected) <= 1e-13 * abs(expected)).all()


# --- engines ------------------------------------------------------------------------------------


def test_files_are_the_librarys(ask: Ask) -> None:
    listed = preset_engines() + random_engines()
    for text in ("to_toml", "to_json"):
        texts = [getattr(each, text)() for each in listed]
        found = results(ask, [("read", {"engine": each}) for each in texts])
        assert [each[text.removeprefix("to_")] for each in found] == texts


def test_a_summary_says_what_the_engine_is(ask: Ask) -> None:
    listed = preset_engines()
    calls: Calls = [("read", {"engine": each.to_json()}) for each in listed]
    for engine, found in zip(listed, results(ask, calls), strict=True):
        summary = found["summary"]
        assert summary["cylinders"] == len(engine)
        assert summary["bank_angle_deg"] == getattr(engine, "bank_angle_deg", None)
        assert summary["pin_deg"] == engine.pin_deg.tolist()
        assert summary["mains"] == engine.mains.tolist()
        if engine.firing_order:
            assert summary["firing"]["text"] == engine.firing_order
            assert summary["firing"]["angles_deg"] == engine.firing().angles_deg.tolist()


def test_builders_are_the_librarys(ask: Ask) -> None:
    parts = {"stroke": 0.086, "rod_length": 0.145, "reciprocating_mass": 0.66, "bore": 0.086}
    calls, expected = Calls(), list[cp.Engine]()
    for name in cp.presets():
        found = presets.layout(name)
        arguments = {key: value for key, value in found.arguments.items() if key != "name"}
        named = {"from_firing_order": "firing_order", "from_banks": "fan"}
        kind = named.get(found.builder, found.builder)
        kinds = ("inline", "vee", "flat", "boxer", "fan", "radial")
        if kind not in kinds or "rods" in arguments:  # link rods are of engine files
            continue
        if isinstance(arguments.get("bank_deg"), str):
            arguments["bank_deg"] = FANS[arguments["bank_deg"]]
        calls.append(("build", {"kind": kind, "spacing": found.spacing, **parts, **arguments}))
        engine = getattr(cp.Engine, found.builder)(CYLINDER, spacing=found.spacing, **arguments)
        expected.append(engine)
    assert len(calls) > 30
    throws = {"throws_deg": [0, 120, 240], "spacing": [0.1, 0.13], "first_tdc_deg": 7}
    banks = {**throws, "bank_stagger": 0.02}
    for kind, builder, given in (
        ("inline", cp.Engine.inline, throws),
        ("vee", cp.Engine.vee, {**banks, "bank_angle_deg": 75, "absent": [2, 6]}),
        ("fan", cp.Engine.from_banks, {**banks, "bank_deg": [30, 90, 150]}),
    ):
        calls.append(("build", {"kind": kind, **parts, **given}))
        expected.append(builder(CYLINDER, **given))  # type: ignore[arg-type]
    twin: dict[str, Any] = {"throws_deg": [0, "360/7"], "spacing": 0.1, "distance": 0.3}
    machines: tuple[tuple[str, dict[str, Any]], ...] = (
        ("opposed_pistons", {**twin, "lead_deg": 12}),
        ("opposed_pistons", {**twin, "ratio": -1, "strokes": 4}),
        ("u", {**twin, "phase_deg": "360/7"}),
        ("h", {**twin, "ratio": 1, "phase_deg": 90, "strokes": 2}),
        ("square_four", {"spacing": 0.1, "distance": 0.12, "first_tdc_deg": 7}),
    )
    for kind, given in machines:
        calls.append(("build", {"kind": kind, **parts, **given}))
        expected.append(getattr(cp.Engine, kind)(CYLINDER, **given))
    for rows, cylinders in [(1, 7), (2, 14), (2, 18), (4, 28), (2, 12), (3, 9)]:
        for strokes in (4, 2):
            figures = {"cylinders": cylinders, "rows": rows, "spacing": 0.2, "strokes": strokes}
            calls.append(("build", {"kind": "radial", **parts, **figures}))
            expected.append(cp.Engine.radial(CYLINDER, **figures))  # type: ignore[arg-type]
    for found, engine in zip(results(ask, calls), expected, strict=True):
        assert cp.Engine.from_toml(found["toml"]) == engine


def same_rows(found: Any, expected: Any) -> None:  # noqa: ANN401 - of JSON
    """Compare numbers of nested lists, of which sines are another library's."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        found, expected = list(found.values()), list(expected.values())
    if isinstance(expected, list):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            same_rows(one, other)
    elif expected is None:
        assert found is None
    else:
        assert math.isclose(found, expected, rel_tol=1e-13, abs_tol=1e-13)


def test_amplitudes_are_read_as_in_a_shell(ask: Ask) -> None:
    texts = ["2:8, 4: 1.5@-30, 6:4-1j", "0.5: 1/2j/-1e-3-2e+3j", "2: 3 lbf@90; 3: 1 kN"]
    calls: Calls = [("amplitudes", {"text": text, "unit": "N", "name": "f"}) for text in texts]
    for text, found in zip(texts, results(ask, calls), strict=True):
        same_rows(found, _core.read_amplitudes("f", text, "N", ""))
    (first, table, _) = (_core.read_amplitudes("f", text, "N", "") for text in texts)
    assert [first[0], first[2]] == [[2.0, 8.0, 0.0], [6.0, 4.0, -1.0]]
    assert table == [[0.5, 1.0, 0.0, 0.0, 2.0, -1e-3, -2e3]]
    for text in ("", "2", "2:", "2:x", "x:2", "0.3:1", "2:1j2", "2:1@x"):
        with pytest.raises(cp.InputError, match=r"f|orders"):
            _core.read_amplitudes("f", text, "N", "")


def test_intervals_are_kept_as_they_were_typed(ask: Ask) -> None:
    """Twingles and big bangs are no more even for being possible in other turns."""
    parts = {"stroke": 0.086, "rod_length": 0.145, "reciprocating_mass": 0.66, "bore": 0.086}
    calls, expected = Calls(), list[cp.Engine]()
    for order, intervals, more in [
        ("1-2", [30, 690], {}),
        ("1-2", [540, 180], {}),
        ("1-2", [360, 360], {}),
        ("1-2-3-4", [10, 10, 10, 690], {}),
        ("1+2-3", [0, 300, 420], {}),
        ("1-2", [405, 315], {"bank_angle_deg": 45}),
    ]:
        given: dict[str, Any] = {"firing_order": order, "intervals_deg": intervals, **more}
        calls.append(("build", {"kind": "firing_order", "spacing": 0.1, **parts, **given}))
        engine = cp.Engine.from_firing_order(CYLINDER, spacing=0.1, **given)
        assert engine.firing().intervals_deg.tolist() == intervals
        expected.append(engine)
    for found, engine in zip(results(ask, calls), expected, strict=True):
        assert cp.Engine.from_toml(found["toml"]) == engine


def same_sums(rows: list[Any], of_page: list[Any], page: dict[str, Any], within: float) -> None:
    """Compare rows of the own rod ratios with those of all, to what polynomials leave out."""
    # Of an engine whose rods are not to be changed the page has the own ones too.
    least, most, turning = page["rod_ratios"] or (0.0, 0.1, 1.0)
    own = page["rod_ratio"] if page["rod_ratios"] else None
    low, high, q = (
        math.tan(0.5 * math.asin(ratio / turning)) for ratio in (least, most, own or 0.0)
    )
    sums: list[dict[Any, Any]] = [{}, {}]
    for of, listed in zip(sums, (rows, of_page), strict=True):
        for order, power, polynomial, groups, *factor in listed:
            if listed is rows or own is None:
                (by,) = factor
            else:
                at = (2.0 * q - low - high) / (high - low)
                by = q**power * chebyshev.chebval(at, polynomial)
            for group, *values in groups:
                of[order, group] = of.get((order, group), 0.0) + by * np.array(values)
    size = max((abs(each).max() for each in sums[0].values()), default=0.0)
    for key in {*sums[0], *sums[1]}:
        one, other = (of.get(key, 0.0) for of in sums)
        assert np.max(np.abs(np.subtract(one, other))) <= within * size, key


def test_figures_have_what_the_page_of_the_library_has(ask: Ask) -> None:
    listed = [*preset_engines(), *(fired_engine(seed) for seed in range(8))]
    fan = cp.PeriodicLoad("fan", on="shaft", force={0.5: 8, 2: 1j}, torque={0: 3, 4: 1}, z=-0.1)
    mill = cp.PeriodicLoad(
        "mill", on="both", torque={1.5: [2, 1j]}, rpm=[500, 900], ratio="1/2", cylinder=1
    )
    listed += [each.with_loads([fan, mill]) for each in listed[-10:]]
    rpm = 600.0
    calls: Calls = [("figures", {"engine": each.to_json(), "rpm": rpm}) for each in listed]
    others = {
        "rod_ratio", "rod_ratios", "motions", "terms", "flywheel", "sentences", "loads", "name",
    }  # fmt: skip
    for engine, found in zip(listed, results(ask, calls), strict=True):
        expected = json.loads(json.dumps(figures(engine, rpm, spectrum=None)))
        del expected["units"], expected["controls"]  # of the page, not of the engine
        assert found.keys() == expected.keys()
        for name in found.keys() - others:
            if name == "block":
                # A product of three figures.
                for key, value in expected[name].items():
                    assert math.isclose(found[name][key], value, rel_tol=1e-15)
            else:
                assert found[name] == expected[name], name
        terms, theirs = found["terms"], expected["terms"]
        assert terms["orders"] == theirs["orders"]
        for one, other in zip(found["motions"], expected["motions"], strict=True):
            for name in ("height", "turning"):
                same_sums(one[name], other[name], expected, 1e-10)  # cut at 1e-11
        for name in ("planar", "torque"):
            same_sums(terms[name], theirs[name], expected, 1e-11)  # cut at 1e-13
        same_rows(terms["loads"], theirs["loads"])
        for name, size in theirs["sizes"].items():
            assert math.isclose(terms["sizes"][name], size, rel_tol=1e-14), name
        numbers = list(dict.fromkeys(row[0] for row in terms["planar"]))
        ours = np.zeros((len(numbers), 3, 8))
        for order, _, _, groups, factor in terms["planar"]:
            for group, *values in groups:
                ours[numbers.index(order), group] += factor * np.array(values)
        if not numbers:  # nothing shakes it
            continue
        balance = engine.with_loads([]).balance(30.0 / np.pi, orders=numbers, torque=False)
        vectors = (balance.force, balance.moment)
        planar = np.stack([part for of in vectors for part in (of.forward, of.backward)], axis=1)
        size = abs(planar).max(initial=0.0)
        # Sums of a few terms, each a product of a few figures.
        assert abs(ours.sum(axis=1).view(complex) - planar).max(initial=0.0) <= 1e-14 * size


# --- parts that are fitted ----------------------------------------------------------------------


def test_counterweights_and_shafts_are_the_librarys(ask: Ask) -> None:
    names = ("single", "i3", "v6-90", "v8-crossplane", "boxer-4", "radial-7")
    for name in names:
        engine = cp.Engine.preset(name)
        given = {"engine": engine.to_json()}
        weights, shafts = results(
            ask,
            [
                ("counterweights", given),
                ("balance_shafts", given | {"ratios": [1, -1], "x": [0.1, -0.1], "y": [0, 0]}),
            ],
        )
        turns = pytest.warns(UserWarning, match="roll torque of order 1")
        with turns if name == "radial-7" else nullcontext():
            pairs = [
                (weights, cp.counterweights(engine).fitted),
                (shafts, cp.balance_shafts(engine, [1, -1], x=[0.1, -0.1], y=[0, 0]).fitted),
            ]
        for found, expected in pairs:
            ours = cp.Engine.from_toml(found["toml"])
            size = engine.balance(RPM, orders=[1]).force.peak.max() + 1.0
            for quantity in ("force", "moment"):
                left = [
                    getattr(each.balance(RPM, orders=[1]), quantity) for each in (ours, expected)
                ]
                # Solutions of least squares, to their rounding.
                assert abs(left[0].forward - left[1].forward).max() <= 1e-9 * size
                assert abs(left[0].backward - left[1].backward).max() <= 1e-9 * size


@pytest.mark.parametrize("load", [1.0, 0.25, 0.0])
@pytest.mark.parametrize("kind", ["petrol", "diesel"])
def test_example_cycles_are_the_librarys(
    ask: Ask, kind: Literal["petrol", "diesel"], load: float
) -> None:
    engine = cp.Engine.preset("i4", cylinder=CYLINDER)
    given = {"engine": engine.to_json(), "kind": kind, "load": load}
    (found,) = results(ask, [("with_cycle", given)])
    expected = cp.Cycle.example(kind, load=load)
    assert len(found["theta_deg"]) == len(expected.theta_deg)
    # Solved by iteration, with powers of another library.
    assert np.allclose(found["pressure"], expected.pressure, rtol=1e-9)
    assert cp.Engine.from_toml(found["toml"]).loads_counted == f"gas: {expected.name}"


def test_modes_are_the_librarys(ask: Ask, tmp_path: Path) -> None:
    engine = cp.Engine.preset("i4")
    body = cp.RigidBody(mass=150.0, cg=(0, 0.1, 0.2), inertia=np.diag([6.0, 8.5, 3.2]))
    corners = [(0.3, -0.1, -0.2), (-0.3, -0.1, -0.2), (0.3, -0.1, 0.6), (-0.3, -0.1, 0.6)]
    mounts = [cp.Mount(f"{k}", at, stiffness=(2e5, 3e5, 1e5)) for k, at in enumerate(corners)]
    powertrain = cp.Powertrain(engine, body, mounts)
    powertrain.save(tmp_path / "car.toml")
    text = (tmp_path / "car.toml").read_text("utf-8")
    (found,) = results(ask, [("mounts", {"engine": text})])
    modes = powertrain.modes()
    assert np.allclose(found["modes"]["frequency"], modes.frequency, rtol=1e-10)
    raft = cp.Subframe(body.replace(mass=300.0), [m.replace(stiffness=5e5) for m in mounts])
    soft = powertrain.with_support(raft)
    soft.save(tmp_path / "soft.toml")
    text = (tmp_path / "soft.toml").read_text("utf-8")
    (found,) = results(ask, [("mounts", {"engine": text})])
    assert np.allclose(found["modes"]["frequency"], soft.modes().frequency, rtol=1e-10)
    assert found["mounts"][4] == "subframe: 0"
    assert np.allclose(found["static"]["displacement"][0][:3], soft.static().sag, rtol=1e-9)
    other = ask([("mounts", {"engine": engine.to_toml()})])[0]["error"]
    assert other["argument"] == "powertrain"


# --- what is wrong ------------------------------------------------------------------------------


def doubtful_engine(seed: int) -> cp.Engine:
    """Return an engine of figures of which some are in other units."""
    chance = np.random.default_rng(seed)

    def either(right: Any, *wrong: Any) -> Any:  # noqa: ANN401 - as given
        return right if chance.random() < 0.7 else wrong[chance.integers(len(wrong))]

    radius = either(0.043, 43.0)
    parts = [
        cp.Cylinder(radius, radius * either(3.4, 3400.0), mass, bore=either(2.0 * radius, None, 86))
        for mass in [either(0.45, 450.0) for _ in range(2)]
    ]
    z = [0.0, either(0.1, 100.0)]
    if chance.random() < 0.1:  # two pistons to a bore
        engine = cp.Engine.from_lists(
            parts, bank_deg=[90, 270], tdc_deg=[0, 0], z=[0, 0], cranks=[(0, 0.8, -1)], crank=[0, 1]
        )
    else:
        engine = cp.Engine.from_lists(
            parts, bank_deg=[90, 90], tdc_deg=either([0, 180], [0, 3.1416]), z=z,
            rotating_mass=either(0.3, 300.0),
        )  # fmt: skip
    amounts = either((0.001, 0.002), (0.001, 200.0), (8e3, 0.001))
    weights = [cp.Unbalance(amount, either(0.05, 500.0), 20) for amount in amounts]
    shaft = cp.Shaft(-1, [cp.Unbalance(0.001, 0.05)], either(0.1, 80.0), either(0.0, -90.0))
    engine = engine.with_counterweights(weights).with_shafts([shaft])
    if any(part.bore is None for part in parts) or chance.random() < 0.5:
        return engine
    cycle = cp.Cycle.example()
    theta = np.arange(0.0, 720.0, 2.0)
    sense = either(1, -1)
    pressure = cycle.pressure_at(sense * theta - either(0.0, 200.0)) * either(1.0, 1e-5, 1e-3)
    engine = engine.replace(firing_order="1-2" if np.ptp(engine.z) else "1")
    return engine.with_cycle(cp.Cycle(theta, pressure), crankcase=either(101325.0, 1.01))


def doubtful_powertrain(seed: int) -> cp.Powertrain:
    """Return an engine on mounts, of figures of which some are in other units."""
    chance = np.random.default_rng(seed)

    def either(right: Any, *wrong: Any) -> Any:  # noqa: ANN401 - as given
        return right if chance.random() < 0.7 else wrong[chance.integers(len(wrong))]

    def body() -> cp.RigidBody:
        inertia = either((7.0, 8.0, 4.5), (7e6, 8e6, 4.5e6), (2.0, 8.0, 4.5))
        return cp.RigidBody(either(150.0, 150e3), (0, either(0.1, 100.0), 0.2), inertia)

    def mount(name: str) -> cp.Mount:
        at, table = (0.3, either(-0.1, -120.0), 0.2), ([5, 500], np.full((2, 3), 240 + 7j))
        stiffness = either(2e5, 200.0, (0.0, 2e5, 3e5))
        if chance.random() < 0.1:
            return cp.Mount(name, at, stiffness, table=table)
        return cp.Mount(
            name, at, stiffness, dynamic_stiffness=either(None, 240.0, 3e5),
            loss_factor=either(0.1, 8.0), damping=either(0.0, 0.2, 200.0),
        )  # fmt: skip

    powertrain = cp.Powertrain(doubtful_engine(seed), body(), [mount("left"), mount("right's")])
    raft = [mount("below")]
    return (
        powertrain.with_support(cp.Subframe(body(), raft)) if chance.random() < 0.5 else powertrain
    )


def test_what_is_warned_of_is_the_librarys(ask: Ask, tmp_path: Path) -> None:
    """All sentences of one are those of the other, of engines alone and on mounts."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        texts = [doubtful_engine(seed).to_json() for seed in range(400)]
        texts += [doubtful_powertrain(seed)._text(toml=False) for seed in range(200)]
    found = results(ask, [("warnings", {"engine": text}) for text in texts])
    seen = set[str]()
    file = tmp_path / "engine.json"
    for text, ours in zip(texts, found, strict=True):
        file.write_text(text, "utf-8")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            if "powertrain" in text:
                cp.Powertrain.load(file)
            else:
                cp.Engine.load(file)
        said = [f"{each.message}" for each in caught]
        # Of angles that are no texts the library speaks besides, and of its own argument.
        theirs = " ".join(each for each in said if "radians" not in each)
        theirs = theirs.replace(UNITS_ASSUMED, "").replace(": tdc_deg=…", "")
        for each in ours:
            assert each["message"] in theirs, (each, theirs)
            theirs = theirs.replace(each["message"], "", 1)
            seen.add(re.sub(r"\[\d+\]", "", each["argument"]))
        assert not theirs.strip("; "), theirs
    of_mounts = ("at", "damping", "dynamic_stiffness", "loss_factor", "stiffness", "table")
    on_mounts = [f"body.{each}" for each in ("cg", "inertia", "mass")]
    on_mounts += [f"mounts.{each}" for each in of_mounts]
    assert seen == {
        "amount", "bore", "crank_radius", "crankcase", "imep", "pressure",
        "reciprocating_mass", "rod_length", "rotating_mass", "theta_deg", "x", "y", "z",
        "z (or spacing, bank_stagger)", *(f"powertrain.{each}" for each in on_mounts),
        *(f"powertrain.subframe.{each}" for each in on_mounts),
    }  # fmt: skip


def test_what_is_warned_of_at_a_speed_and_of_typed_angles(ask: Ask) -> None:
    layout: dict[str, Any] = {"bank_angle_deg": 90, "throws_deg": [0, 240, 120], "spacing": 0.1}
    with pytest.warns(UserWarning, match="pin_split_deg = 30") as caught:
        v6 = cp.Engine.vee(CYLINDER, pin_split_deg=30, **layout)
    given = {"engine": v6.to_json(), "rpm": 3e5, "inertia": 2e3, "pin_split_deg": "30"}
    angles = {"throws_deg": ["0", "2.0944", "4.18879"], "bank_deg": ["51.428571", "360/7", "90"]}
    (found,) = results(ask, [("warnings", given | {"angles": angles})])
    said = {each["argument"]: each["message"] for each in found}
    assert said["pin_split_deg"] == str(caught[0].message)
    assert "mean piston speed" in said["rpm"]
    assert "kg·cm²" in said["inertia"]
    assert said["throws_deg"].endswith("degrees here: 120°, 240°")
    assert said["bank_deg"] == "51.428571 is 4.3e-7° from 360/7"


def mutated(text: str, seed: int) -> str:
    """Return a text with some characters exchanged, left out or doubled."""
    rng = np.random.default_rng(seed)
    letters = list(text)
    for _ in range(int(rng.integers(1, 6))):
        k = int(rng.integers(len(letters)))
        letters[k] = str(
            rng.choice(["", letters[k] * 2, "=", "-", "9", '"', "\n", "e", "[", "é", "<"])
        )
    return "".join(letters)


def test_mutated_files_give_the_librarys_errors(ask: Ask) -> None:
    texts = [mutated(cp.Engine.preset("v6-60").to_toml(), seed) for seed in range(300)]
    texts += [mutated(random_engine(3).to_json(), seed) for seed in range(300)]
    same = 0
    for text, answer in zip(
        texts, ask([("read", {"engine": each}) for each in texts]), strict=True
    ):
        json_file = text.lstrip().startswith("{")
        try:
            engine = cp.Engine.from_json(text) if json_file else cp.Engine.from_toml(text)
        except cp.InputError as error:
            expected = {name: getattr(error, name) for name in ("argument", "value", "hint")}
            expected |= {"name": "InputError", "message": str(error)}
            same += answer.get("error") == expected
            continue
        same += answer["result"]["toml"] == engine.to_toml()
    assert same == len(texts)


def test_wrong_arguments_are_named(ask: Ask) -> None:
    engine = cp.Engine.preset("v6-60").to_json()
    wrong: list[tuple[str, dict[str, Any], str]] = [
        ("balance", {"rpm": -1}, "rpm"),
        ("balance", {"rpm": "fast"}, "rpm"),
        ("balance", {}, "rpm"),
        ("balance", {"rpm": 1, "orders": [0]}, "order"),
        ("balance", {"rpm": 1, "rtol": 2}, "rtol"),
        ("balance", {"rpm": 1, "speed": 2}, "argument"),
        ("bank_angles", {"rpm": 1, "bank_angle_deg": [200], "orders": [1]}, "bank_angle_deg"),
        ("bank_angles", {"rpm": 1, "bank_angle_deg": [1], "hold": "x", "orders": [1]}, "hold"),
        ("waveform", {"rpm": 1, "theta_deg": [1e300]}, "theta_deg"),
        ("sweep", {"rpm": [1.0] * 10, "quantity": "sound"}, "quantity"),
        ("with_cycle", {"load": 2}, "load"),
        ("balance_shafts", {"ratios": [0]}, "order"),
        ("toast", {}, "call"),
    ]
    answers = ask([(name, {"engine": engine} | given) for name, given, _ in wrong])
    for (name, _, argument), answer in zip(wrong, answers, strict=True):
        error = answer["error"]
        assert error["name"] == "InputError", name
        assert argument in error["argument"], (name, error)
        assert error["hint"]
    same = ask([("balance", {"engine": engine, "rpm": -1})])[0]["error"]
    with pytest.raises(cp.InputError) as raised:
        cp.Engine.preset("v6-60").balance(rpm=-1)
    assert (same["message"], same["hint"]) == (str(raised.value), raised.value.hint)


def test_hostile_names_stay_texts(ask: Ask, core_page: Page) -> None:
    names = ["<script>alert(1)</script>", "__proto__", '"; throw 1; //', "\u2028", "é" * 999, "\0x"]
    engines = [cp.Engine.preset("i4").replace(name=name) for name in names]
    found = results(ask, [("read", {"engine": each.to_json()}) for each in engines])
    assert [each["summary"]["name"] for each in found] == names
    assert core_page.evaluate("Object.keys({}).length + Object.keys(Object.prototype).length") == 0


def test_what_is_too_large_is_an_error_and_the_next_call_works(ask: Ask) -> None:
    engine = cp.Engine.preset("v6-60").to_json()
    many = [float(k) for k in range(20_000)]
    offsets = [1e-6 * k for k in range(2_000)]
    large = {"engine": engine, "rpm": many, "pin_offset": offsets, "orders": ORDERS}
    answers = ask([("sweep", large), ("balance", {"engine": engine, "rpm": RPM, "orders": [2]})])
    assert answers[0]["error"]["name"] == "InputError", answers[0]
    assert answers[1]["result"]["orders"][0]["order"] == 2


def test_memory_stays_bounded_after_a_thousand_engines(ask: Ask, core_page: Page) -> None:
    texts = [each.to_json() for each in random_engines()[:100]]

    def once() -> None:
        # Figures take thirty times as long as balances.
        for name, some in (("figures", texts[:20]), ("balance", texts)):
            results(ask, [(name, {"engine": text, "rpm": RPM}) for text in some])

    once()
    before = core_page.evaluate("core.memory")
    for _ in range(9):
        once()
    # The allocator's own fragments: two pages of 64 KiB.
    assert core_page.evaluate("core.memory") <= before + 2 * 65536
    assert before < 32 << 20
