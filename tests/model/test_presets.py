"""Are the ready-made engines the engines that they say they are?

What is known of each layout is checked from outside: when its cylinders fire, which forces and
moments cancel and what is left in closed form, and the sources' own tables through the independent
re-derivation. Amplitudes are in units of m r ω² aₙ, moments in that times the spacing.
"""

from __future__ import annotations

import csv
import math
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin.model import presets as presets_module
from rederivation import crossplane, ebook, faces, ijesc
from support import DATA, in_turn
from support.built_engines import EVEN, UNEVEN

if TYPE_CHECKING:
    from numpy.typing import NDArray

NAMES = list(cp.presets())
RPM = 10.0  # slow enough for the e-book's crank of 1 m radius; nothing here depends on it
OMEGA = 2.0 * math.pi * RPM / 60.0

# Sums of at most 16 terms, each rounded a few times to 1.1e-16.
ROUNDING = 1e-13

SQRT3, SQRT10 = math.sqrt(3.0), math.sqrt(10.0)
# Σ k e^{in·tdc}, k = 0 … 4, of 1-2-4-5-3 at orders 1 and 2; 1-5-2-3-4, as in V10s, swaps them.
I5_MOMENT = (0.449028, 4.979797)
SIX_DECIMALS = 5e-7  # half of their last digit


def read(name: str) -> list[dict[str, str]]:
    """Rows of a table in ``data/``."""
    with (DATA / name).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def unit(engine: cp.Engine, order: int) -> float:
    """One cylinder's m r ω² |aₙ|."""
    part = engine.cylinders[0]
    scale = part.reciprocating_mass * part.crank_radius * OMEGA**2
    return scale * float(abs(part.harmonics(order)[0]))


def force(name: str, order: int) -> float:
    """Longest force of one order."""
    engine = cp.Engine.preset(name)
    return float(engine.balance(RPM, orders=order).force.peak[0]) / unit(engine, order)


def moment(name: str, order: int) -> float:
    """Longest moment of one order, at a spacing of 1 m."""
    engine = cp.Engine.preset(name, spacing=1.0)
    return float(engine.balance(RPM, orders=order).moment.peak[0]) / unit(engine, order)


def highest(engine: cp.Engine) -> NDArray[np.float64]:
    """Crank angles, degrees, at which the pistons are highest: crank and rod in line."""
    past = []
    for part in engine.cylinders:
        reach = part.rod_length + part.crank_radius
        angle = math.degrees(math.asin(part.pin_offset / reach))
        # In line, crank and rod are the hypotenuse of offset and height.
        assert float(part.position(angle)) == pytest.approx(
            math.sqrt(reach**2 - part.pin_offset**2), rel=ROUNDING
        )
        past.append(angle)
    return np.asarray(engine.tdc_deg + np.array(past))


# --- every preset ---------------------------------------------------------------------------------


@in_turn("name", NAMES)
def test_it_builds_balances_and_comes_back_from_its_file(name: str) -> None:
    engine = cp.Engine.preset(name)
    assert engine.name
    assert engine.source
    balance = engine.balance(RPM, orders=range(1, 17))  # the V14's torque begins at order 14
    for part in (balance.force, balance.moment, balance.torque):
        assert np.isfinite(part).all()
    assert balance.torque.peak.max() > 0.0
    assert cp.Engine.from_toml(engine.to_toml()) == engine
    assert cp.Engine.from_json(engine.to_json()) == engine


@in_turn("name", NAMES)
def test_names_and_conventions(name: str) -> None:
    engine, about = cp.Engine.preset(name), cp.presets().descriptions[name]
    assert name == name.lower()
    assert not set(name) - set("abcdefghijklmnopqrstuvwxyz0123456789-.")
    assert about
    assert "\n" not in about
    assert engine.z.min() == 0.0
    if not name.startswith("v14"):  # Ito counts θ from the phase number 1
        assert engine.tdc_deg[0] == 0.0


def test_no_two_have_the_same_name_or_title() -> None:
    assert len(NAMES) == len(set(NAMES)) == len(cp.presets())
    assert len({cp.Engine.preset(name).name for name in NAMES}) == len(NAMES)


def test_a_title_names_the_source_of_parts_only_while_they_are_its() -> None:
    own = cp.Engine.preset("i4-ebook")
    assert own.name == "Inline-4 (e-book)"
    other = cp.Engine.preset("i4-ebook", cylinder=own.cylinders[0].replace(rod_length=3.0))
    assert other.name == "Inline-4"
    assert cp.Engine.preset("i4-ebook", cylinder=own.cylinders[0]).name == own.name


def test_the_engines_of_the_sources_are_there() -> None:
    wanted = {"single", "i3", "i4", "i6", "boxer-4", "flat-4", "v-twin-90", "v6-60-ebook"}
    wanted |= {"v8-flatplane", "v8-crossplane", "v8-crossplane-ebook"}
    wanted |= {f"ijesc-v6-{'-'.join(map(str, order))}" for order in ijesc.FIRING_ORDERS}
    wanted |= {f"v14-{row['bank_angle_deg']}" for row in read("ito_cases.csv")}
    assert wanted <= set(NAMES)


def test_importing_keeps_no_engine() -> None:
    code = (
        "import gc, crankpin; crankpin.presets(); "
        "assert not any(isinstance(each, crankpin.Engine) for each in gc.get_objects())"
    )
    subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603 - our own code


# --- when they fire -------------------------------------------------------------------------------


def intervals(name: str, order: str) -> NDArray[np.float64]:
    """Crank angles from one firing to the next, none above a turn, in this order."""
    tops = highest(cp.Engine.preset(name))
    numbers = np.array([int(number) for number in order.split("-")]) - 1
    assert sorted(numbers) == list(range(len(tops)))
    gaps = np.diff(tops[np.append(numbers, numbers[0])]) % 360.0
    gaps[np.minimum(gaps, 360.0 - gaps) < 1e-9] = 360.0
    return np.asarray(gaps)


@in_turn(("name", "order"), EVEN.items())
def test_even_firing(name: str, order: str) -> None:
    # In this order all intervals are equal and fill two turns. Angles below 720 to a few ulp.
    count = order.count("-") + 1
    np.testing.assert_allclose(intervals(name, order), 720.0 / count, rtol=0, atol=1e-12 * 720)


@pytest.mark.parametrize(("name", "order", "gaps"), [(n, *f) for n, f in UNEVEN.items()])
def test_uneven_firing(name: str, order: str, gaps: tuple[int, ...]) -> None:
    assert sum(gaps) == 720
    np.testing.assert_array_equal(intervals(name, order), gaps)


@pytest.mark.parametrize(
    "name", [n for n in EVEN if "even firing 1-" in cp.presets().descriptions[n]]
)
def test_the_description_names_that_firing_order(name: str) -> None:
    assert f"even firing {EVEN[name]}" in cp.presets().descriptions[name]


@pytest.mark.parametrize(("name", "bores"), [("opposed-piston-6", 6), ("delta-18", 18)])
def test_two_pistons_in_each_bore_fire_evenly(name: str, bores: int) -> None:
    engine = cp.Engine.preset(name)
    assert engine.chambers == tuple((k, k + bores) for k in range(1, bores + 1))
    np.testing.assert_allclose(engine.firing_intervals_deg, 360.0 / bores, rtol=0, atol=1e-9)


def test_the_180_twin_fires_at_180_and_540() -> None:
    assert cp.Engine.preset("i2-180").tdc_deg.tolist() == [0.0, 180.0]


@pytest.mark.parametrize(
    ("name", "gaps"),
    [
        ("i2-270", (270.0, 450.0)),
        ("v-twin-45", (315.0, 405.0)),  # Harley-Davidson
        ("v-twin-52", (232.0, 488.0)),  # Honda VT500
        ("v-twin-60", (300.0, 420.0)),
        ("i2-180-two-stroke", (180.0, 180.0)),
        ("i3-two-stroke", (120.0, 120.0, 120.0)),
    ],
)
def test_twins_and_two_strokes_fire_as_their_makers_have_it(
    name: str, gaps: tuple[float, ...]
) -> None:
    engine = cp.Engine.preset(name)
    assert tuple(engine.firing().intervals_deg.tolist()) == gaps
    assert sum(gaps) == 180.0 * engine.strokes


# --- pins -----------------------------------------------------------------------------------------


def split(name: str) -> set[float]:
    """Left pin minus right pin of each throw, in (-180, 180]."""
    engine = cp.Engine.preset(name)
    left = engine.bank_deg > 90.0
    found = set()
    for z in set(engine.z.tolist()):
        here = engine.z == z
        (one,), (two,) = engine.pin_deg[here & left], engine.pin_deg[here & ~left]
        found.add(-((two - one + 180.0) % 360.0 - 180.0))
    return found


@pytest.mark.parametrize(
    ("name", "angle"),
    [
        ("flat-4", 0.0),
        ("v4-90-180", 0.0),
        ("v-twin-52", -76.0),
        ("v6-60", -60.0),
        ("v6-90", -30.0),
        ("v6-90-odd-fire", 0.0),
        ("v6-120", 0.0),
        ("v8-crossplane", 0.0),
        ("v8-60", -30.0),
        ("v10-72", 0.0),
        ("v10-90-even", 18.0),
        ("v12-60", 0.0),
        ("v16-45", 0.0),
    ],
)
def test_pin_split(name: str, angle: float) -> None:
    assert split(name) == {angle}


@pytest.mark.parametrize(("name", "angle"), [("w8", -18.0), ("w12", 12.0), ("w16", 0.0)])
def test_pin_split_of_w_engines(name: str, angle: float) -> None:
    # Published for the W12; its angles pass through an arcsine, so to rounding of 360°.
    assert list(split(name)) == pytest.approx([angle] * len(split(name)), abs=1e-12)


@pytest.mark.parametrize(
    ("name", "throws"),
    [
        ("v8-crossplane", [0.0, 90.0, 270.0, 180.0]),
        ("v8-crossplane-ebook", [0.0, 90.0, 180.0, 270.0]),
        ("v8-flatplane", [0.0, 180.0, 180.0, 0.0]),
    ],
)
def test_throws_of_v8s(name: str, throws: list[float]) -> None:
    pins = cp.Engine.preset(name).pin_deg[::2]
    assert ((pins - pins[0]) % 360.0).tolist() == throws


def test_the_built_cross_plane_follows_from_its_firing_order() -> None:
    engine = cp.Engine.preset("v8-crossplane")
    assert engine.bank_deg[0] == 135.0  # odd cylinders left
    other = cp.Engine.from_firing_order(
        engine.cylinders[0],
        EVEN["v8-crossplane"],
        bank_angle_deg=90,
        odd_bank="left",
        spacing=0.1,
        name=engine.name,
        source=engine.source,
    )
    assert other == engine


# --- what cancels, and what is left ---------------------------------------------------------------

ZERO = {  # orders of force, orders of moment
    "i2-180": ([1], [2]),  # half a turn apart: even orders in step, no couple
    "i2-270": ([2, 6], [4]),  # a quarter of a turn apart: order 2 in opposition
    "i3": ([1, 2, 4], []),
    "i3-180": ([], [1, 2, 4, 6]),
    "i3-t-plane": ([], [2, 4, 6]),  # the outer two are half a turn apart
    "i3-two-stroke": ([1, 2, 4], []),
    "i4-crossplane": ([1, 2, 6], [2, 4, 6]),
    "i4": ([1], [1, 2, 4, 6]),  # mirror-symmetric crank
    "i5": ([1, 2, 4, 6], []),
    "i6": ([1, 2, 4], [1, 2, 4, 6]),
    "boxer-2": ([1, 2, 3, 4, 5, 6, 7, 8], []),
    "boxer-4": ([1, 2, 3, 4, 5, 6, 7, 8], [1, 2, 3, 4, 5, 6, 7, 8]),  # each pair by itself
    "boxer-6": ([1, 2, 3, 4, 5, 6, 7, 8], [1, 2, 3, 4, 5, 6, 7, 8]),
    "flat-4": ([1, 2, 4, 6], [2, 4, 6]),
    "v4-90-180": ([1], [2, 4, 6]),
    "v4-90-360": ([], [1, 2, 4, 6]),
    "v4-narrow": ([1], []),
    "v6-60": ([1, 2, 4], [6]),
    "v6-90": ([1, 2, 4], [6]),
    "v6-90-odd-fire": ([1, 2, 4], [6]),
    "v6-120": ([1, 2, 4], [6]),
    "vr6": ([1, 2, 4], []),
    "v8-flatplane": ([1], [1, 2, 4, 6]),
    "v8-crossplane": ([1, 2, 6], [2, 4, 6]),
    "v8-60": ([1, 2, 6], [2, 4, 6]),
    "v10-72": ([1, 2, 4, 6], []),
    "v10-90": ([1, 2, 4, 6], []),
    "v10-90-even": ([1, 2, 4, 6], []),
    "v12-60": ([1, 2, 4], [1, 2, 4, 6]),  # two straight-sixes
    "v16-45": ([1, 2, 6], [1, 2, 4, 6]),  # two straight-eights
    "w8": ([1], []),  # flat-plane: order 2 is left to two shafts
    "w12": ([1, 2, 4], []),
    "radial-5": ([2, 8], [1, 2, 4, 6]),
    "radial-7": ([2, 4], [1, 2, 4, 6]),
    "radial-9": ([2, 4, 6], [1, 2, 4, 6, 8]),
    "radial-14": ([1, 2, 4, 6, 8], [2, 4]),  # rows pull against each other at order 1
    "w16": ([1, 2, 6], [2, 6]),
    "opposed-piston-6": ([1, 2, 4], [1]),  # two sixes, one 11° ahead
    "opposed-piston-3": ([1, 2, 4], [1]),  # order 1 within each bore
    "delta-18": ([1, 2, 4], [1]),
    "rg500": ([1], [1, 2, 4]),
    "compressor-4": ([1, 2, 4], [2]),  # pairs in mirror image
}


@in_turn(("name", "force_orders", "moment_orders"), [(n, *o) for n, o in ZERO.items()])
def test_what_cancels_is_exactly_zero(
    name: str, force_orders: list[int], moment_orders: list[int]
) -> None:
    engine = cp.Engine.preset(name)
    if force_orders:
        assert not engine.balance(RPM, orders=force_orders).force.any()
    if moment_orders:
        assert not engine.balance(RPM, orders=moment_orders).moment.any()


def test_the_compressor_has_the_work_and_rod_loads_of_its_stated_figures() -> None:
    engine, rpm, n = cp.Engine.preset("compressor-4"), 600.0, 1.3
    assert presets_module.usual_speed("compressor-4", 3000.0) == rpm
    area, rod = np.pi / 4 * 0.3**2, np.pi / 4 * 0.06**2
    each = n / (n - 1.0) * (4.0 ** ((n - 1.0) / n) - 1.0) * 1e5 * 0.25
    drawn_in = [1.0 - clearance * (4.0 ** (1.0 / n) - 1.0) for clearance in (0.12, 0.15)]
    work = each * (area * drawn_in[0] + (area - rod) * drawn_in[1])
    mean = engine.balance(rpm, orders=[1]).crank_torque.cycle_mean
    assert mean == pytest.approx(-4.0 * work / (2.0 * np.pi), rel=1e-10)  # of cycles within 1e-10
    degrees = np.arange(3.0, 360.0, 7.0)  # where the piston turns a volume is rounded
    theta = np.radians(degrees)
    ends = []
    for end, clearance in (("head", 0.12), ("crank", 0.15)):
        part, grows = faces.swept(theta, end, 0.125, 0.625)
        ends.append(faces.compressed(part, grows, 1e5, 4e5, clearance, n))
    gas = faces.gas_force(ends[0], ends[1], 101_325.0, 0.3, 0.06)
    inertia = 200.0 * (2.0 * np.pi * rpm / 60.0) ** 2 * faces.bend(theta, 0.125, 0.625)
    loads = cp.rod_loads(engine, rpm, degrees)
    for k, tdc in enumerate(engine.tdc_deg):
        load = cp.rod_loads(engine, rpm, degrees + tdc).rod_load[k]
        np.testing.assert_allclose(load, gas + inertia, atol=1e-9 * np.abs(inertia).max())
    assert loads.loads_counted == "gas: Compressor; crank ends: Compressor, crank end"


def test_a_compressor_of_other_parts_has_cycles_of_their_motion() -> None:
    other = cp.Cylinder(0.05, 0.2, 9.0, bore=0.1)
    engine = cp.Engine.preset("compressor-4", cylinder=other)
    figures: dict[str, Any] = {"suction": 1e5, "discharge": 4e5, "n": 1.3}
    assert engine.cycles == (cp.Cycle.compressor(other, clearance=0.12, **figures),) * 4
    crank = cp.Cycle.compressor(other, clearance=0.15, **figures, end="crank")
    assert engine.crank_ends == (crank,) * 4
    np.testing.assert_allclose(engine.rod_diameter, 0.02, rtol=1e-15)
    assert not cp.Engine.preset("compressor-4", cylinder=other.replace(bore=None)).fired


@pytest.mark.parametrize(
    ("name", "order", "size"),
    [
        ("single", 1, 1.0),
        ("i2-360", 1, 2.0),
        ("i2-180", 2, 2.0),
        ("i3", 6, 3.0),
        ("i3-180", 1, 1.0),
        ("i3-t-plane", 1, 1.0),
        ("i3-two-stroke", 6, 3.0),
        ("i4", 2, 4.0),
        ("i4-crossplane", 4, 4.0),
        ("radial-3", 1, 1.5),  # half of all reciprocating masses, turning with the crank
        ("radial-3", 2, 1.5),  # turning against it
        ("radial-9", 1, 4.5),
        ("radial-9", 8, 4.5),
        ("i6", 6, 6.0),  # balanced at every order but multiples of 6
        ("v-twin-45", 1, 1.0 + math.cos(math.pi / 4)),  # upright, 1 − cos 45° level
        ("v-twin-52", 1, math.cos(math.radians(76) / 2.0)),  # turns with the crank
        ("v-twin-90", 1, 1.0),  # turns with the crank
        ("v-twin-90", 2, math.sqrt(2.0)),  # level
        ("v4-90-360", 1, 2.0),
        ("v6-60", 6, 3.0 * SQRT3),  # six in step, 2 · 3 cos 30°
        ("v8-flatplane", 2, 4.0 * math.sqrt(2.0)),  # level
        ("v8-crossplane", 4, 4.0 * math.sqrt(2.0)),  # upright
        ("v12-60", 6, 6.0 * SQRT3),
    ],
)
def test_force_left(name: str, order: int, size: float) -> None:
    assert force(name, order) == pytest.approx(size, rel=ROUNDING)


@pytest.mark.parametrize(
    ("name", "order", "size"),
    [
        ("i2-180", 1, 1.0),
        ("i3", 1, SQRT3),
        ("i3", 2, SQRT3),
        ("flat-4", 1, 2.0),
        ("v8-crossplane", 1, SQRT10),
        ("v8-crossplane-ebook", 2, 2.0 * math.sqrt(2.0)),  # pins 0-90-180-270 leave it
    ],
)
def test_moment_left(name: str, order: int, size: float) -> None:
    assert moment(name, order) == pytest.approx(size, rel=ROUNDING)


@pytest.mark.parametrize("name", ["v-twin-52", "v-twin-90", "radial-5", "radial-7", "radial-9"])
def test_counterweights_could_remove_all_of_order_1(name: str) -> None:
    assert cp.Engine.preset(name).balance(RPM, orders=1).force.backward[0] == 0.0


@pytest.mark.parametrize("count", [3, 5, 7, 9, 11])
def test_what_a_radial_leaves(count: int) -> None:
    # Σ e^{i(1 ∓ n)2πk/N}: forward where N divides n − 1, backward where N divides n + 1.
    engine = cp.Engine.radial(cp.Cylinder(0.05, 0.15, 0.5), count)
    for order in (1, 2, 4, 6, 8, 10, 12):
        balance = engine.balance(RPM, orders=order)
        forward, backward = (count / 2 if (order - s) % count == 0 else 0.0 for s in (1, -1))
        found = [
            abs(part[0]) / unit(engine, order)
            for part in (balance.force.forward, balance.force.backward)
        ]
        assert found == pytest.approx([forward, backward], rel=ROUNDING, abs=0.0)


def test_rows_of_a_radial() -> None:
    one, two = cp.Engine.preset("radial-7"), cp.Engine.preset("radial-14", spacing=0.2)
    assert set(one.z) == {0.0}
    for name in (each for each in EVEN if each.startswith("radial")):
        assert cp.Engine.preset(name).firing_order == EVEN[name]
    assert set(two.pin_deg) == {90.0, 270.0}
    assert two.z.tolist() == [0.0, 0.2] * 7
    # Of two-strokes one cylinder fires after the other, all round.
    two_stroke = cp.Engine.radial(one.cylinders[0], 4, strokes=2)
    assert two_stroke.firing().firing_order == "1-2-3-4"
    both = cp.Engine.radial(one.cylinders[0], 6, rows=2, spacing=0.2, strokes=2)
    assert both.firing_order == "1+4-3+6-2+5"
    assert both.fires_evenly is False
    turned = cp.Engine.radial(one.cylinders[0], 5, first_tdc_deg=30)
    assert turned.tdc_deg[0] == 30.0
    # A row of 6 fires every cylinder at one top dead centre of two: not evenly in turn.
    assert cp.Engine.radial(one.cylinders[0], 6).firing_order == ""


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"cylinders": 2}, "cylinders = 2: give three or more to each row; .* Engine.flat"),
        ({"cylinders": 7, "rows": 2, "spacing": 0.1}, "cylinders = 7: give a multiple of rows, 2"),
        ({"cylinders": 28, "rows": 7}, "rows = 7: give 1 to 6; Engine.from_lists"),
        ({"cylinders": 14, "rows": 2}, "spacing = None: give the distance between rows"),
        ({"cylinders": 7.5}, "cylinders = 7.5: give a whole number"),
        ({"cylinders": 10**9}, "cylinders = 1000000000: an engine has 1 to 1000"),
        ({"firing_order": "1-3-2"}, "firing_order = .*1-3-2"),
    ],
)
def test_radials_that_are_none(given: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.Engine.radial(cp.Cylinder(0.05, 0.15, 0.5), **given)


def test_inline_five() -> None:
    for order, size in enumerate(I5_MOMENT, start=1):
        assert moment("i5", order) == pytest.approx(size, abs=SIX_DECIMALS)


@pytest.mark.parametrize(
    ("name", "bank_angle", "interval", "of_one_bank", "tolerance"),
    [
        ("v4-90-180", 90, 90, 1.0, ROUNDING),
        ("v6-60", 60, 120, SQRT3, ROUNDING),  # 3/2 forward, none backward
        ("v6-90", 90, 120, SQRT3, ROUNDING),
        ("v6-90-odd-fire", 90, 90, SQRT3, ROUNDING),
        ("v6-120", 120, 120, SQRT3, ROUNDING),
        ("v8-crossplane", 90, 90, SQRT10, ROUNDING),
        ("v8-60", 60, 90, SQRT10, ROUNDING),
        ("v10-72", 72, 72, I5_MOMENT[1], SIX_DECIMALS),
        ("v10-90", 90, 90, I5_MOMENT[1], SIX_DECIMALS),
        ("v10-90-even", 90, 72, I5_MOMENT[1], SIX_DECIMALS),
    ],
)
def test_first_order_moment_of_two_like_banks(
    name: str, bank_angle: int, interval: int, of_one_bank: float, tolerance: float
) -> None:
    # A bank's rocking moment is half forward, half backward. The left bank's comes `interval`
    # later and points `bank_angle` further on: its forward part differs by the difference of the
    # two angles (the pin split), its backward part by their sum.
    engine = cp.Engine.preset(name, spacing=1.0)
    balance = engine.balance(RPM, orders=1)
    forward = abs(balance.moment.forward[0]) / unit(engine, 1)
    backward = abs(balance.moment.backward[0]) / unit(engine, 1)
    expected = of_one_bank * abs(math.cos(math.radians(bank_angle - interval) / 2.0))
    assert forward == pytest.approx(expected, abs=tolerance)
    if bank_angle + interval == 180:
        assert backward == 0.0
    else:
        expected = of_one_bank * abs(math.cos(math.radians(bank_angle + interval) / 2.0))
        assert backward == pytest.approx(expected, abs=tolerance)


# --- the cross-plane page -------------------------------------------------------------------------


def test_cross_plane_couple_turns_as_the_page_has_it() -> None:
    engine = cp.Engine.preset("v8-crossplane", spacing=1.0)
    balance = engine.balance(RPM, orders=1)
    # Its levers count towards the front: Σ z F is the other way round; M_x = −Σ z F_y.
    horizontal, vertical = -crossplane.couple(1) * unit(engine, 1)
    np.testing.assert_allclose(balance.moment.xy[0], [-vertical, horizontal], rtol=ROUNDING)
    assert balance.moment.backward[0] == 0.0


# --- the IJESC paper ------------------------------------------------------------------------------

LAGS = {  # of cylinders 1 … 6: each bank's in the order in which they fire, 0, 120, 240
    "1-3-5-2-4-6": [0, 0, 120, 120, 240, 240],
    "1-4-5-2-3-6": [0, 120, 240, 0, 120, 240],
    "1-6-5-4-3-2": [0, 240, 240, 120, 120, 0],
    "1-5-3-6-2-4": [0, 120, 240, 240, 120, 0],
}


@pytest.mark.parametrize(("order", "lags"), LAGS.items())
def test_ijesc_lags(order: str, lags: list[int]) -> None:
    engine = cp.Engine.preset(f"ijesc-v6-{order}")
    assert engine.bank_deg.tolist() == [60.0, 120.0] * 3  # odd cylinders right
    # Top dead centre is at φ ∓ γ from an upright crank: φ = tdc − bank + 90°, cylinder 1 has 0.
    lag = engine.tdc_deg - engine.bank_deg
    assert ((lag - lag[0]) % 360.0).tolist() == lags


@pytest.mark.parametrize("order", LAGS)
def test_ijesc_tables(order: str) -> None:
    engine = cp.Engine.preset(f"ijesc-v6-{order}")
    scale = ijesc.MASS * ijesc.CRANK_RADIUS
    rows = [row for row in read("v6_moment_tables.csv") if row["firing_order"] == order]
    checked = 0
    for row in rows:
        if row["erratum"]:
            continue
        turned = engine.with_bank_angle(float(row["bank_angle_deg"]), hold="pins")
        # Printed with a₂ = λ, about the plane of crank 1.
        spectrum = {1: scale, 2: scale * ijesc.ROD_RATIO}
        peaks = (
            turned.replace(reference_z=0.0)
            .balance(ijesc.RPM, orders=[1, 2], spectrum=spectrum)
            .moment.peak_xy
        )
        printed = [float(row[column]) for column in ("m_px", "m_py", "m_sx", "m_sy")]
        # Printed to two decimals: half of the last, and a little for reading it.
        np.testing.assert_allclose(peaks.ravel(), printed, rtol=0, atol=0.0050001)
        checked += 1
    assert checked >= 14  # of 17, three of them misprinted at most


# --- Ito and Hattori ------------------------------------------------------------------------------


@pytest.mark.parametrize("row", read("ito_cases.csv"), ids=lambda row: str(row["bank_angle_deg"]))
def test_v14(row: dict[str, str]) -> None:
    engine = cp.Engine.preset(f"v14-{row['bank_angle_deg']}", spacing=1.0)
    # Half of the last printed digit, and 1e-9 of it for reading it.
    assert engine.bank_angle_deg == pytest.approx(float(row["bank_angle_deg"]), abs=0.005 + 1e-11)
    balance = engine.balance(RPM, orders=[1, 2])
    assert balance.moment.backward[0] == 0.0
    digits = len(row["amplitude"].split(".")[1])
    amplitude = abs(balance.moment.forward[0]) / unit(engine, 1)
    assert amplitude == pytest.approx(float(row["amplitude"]), abs=0.5000005 * 10.0**-digits)
    assert not balance.force.any()
    # Printed in units of λ m r s ω², rod ratio left open: a₂ here. Pitch is about our x.
    pitch, yaw = balance.moment.peak_xy[1] / unit(engine, 2)
    for found, column in ((pitch, "second_order_pitch"), (yaw, "second_order_yaw")):
        if row[column]:
            assert found == pytest.approx(float(row[column]), abs=0.0005 + 1e-9)


def test_v14_fires_as_ito_numbers_it() -> None:
    engine = cp.Engine.preset("v14-49.54")
    phases = [1, 4, 5, 2, 6, 3, 7, 3, 7, 6, 2, 5, 1, 4]  # section 4.1, front to rear, bank by bank
    # F_k = F(θ + (k − 1)2π/7) is at its peak at −(k − 1)2π/7.
    expected = [-(k - 1) * 360.0 / 7.0 % 360.0 for k in phases]
    np.testing.assert_allclose(engine.tdc_deg, expected, rtol=0, atol=ROUNDING * 360.0)


# --- the e-book -----------------------------------------------------------------------------------

EBOOK = {
    "single-ebook": ebook.MASTER["single"],
    "i3-ebook": ebook.MASTER["straight_3"],
    "i4-ebook": ebook.MASTER["inline_4"],
    "i6-ebook": ebook.MASTER["straight_6"],
    "boxer-4-ebook": ebook.MASTER["boxer_4"],
    "flat-4-ebook": ebook.MASTER["flat_4_non_boxer"],
    "v-twin-90-ebook": ebook.V_ENGINES["v_twin_90"],
    "v6-60-ebook": ebook.V_ENGINES["v6_60"],
    "v8-flatplane-ebook": ebook.V_ENGINES["v8_flat_plane"],
    "v8-crossplane-ebook": ebook.V_ENGINES["v8_cross_plane"],
}


@pytest.mark.parametrize(("name", "layout"), EBOOK.items())
def test_ebook_tables(name: str, layout: ebook.Layout) -> None:
    engine = cp.Engine.preset(name)
    if layout.banks_deg == (0,) * len(engine):  # its inline engines lie along x
        engine = engine.replace(bank_deg=[0] * len(engine), tdc_deg=engine.tdc_deg)
    orders = [1, 2, 3, 4]
    assert engine.rotating_mass.tolist() == [2.0] * len(engine)
    # Its 9 kg at order 1, all along the bore; 7 kg above.
    spectrum = dict(zip(orders, ebook.single_cylinder()[1:] / OMEGA**2, strict=False))
    balance = engine.replace(rotating_mass=0).balance(RPM, orders=orders, spectrum=spectrum)
    # Σ z F_x and Σ z F_y are the sizes of M_y and M_x.
    found = np.hstack([balance.force.peak_xy, balance.moment.peak_xy[:, ::-1]])
    # The re-derivation's harmonics come from a Fourier transform of samples, sums of 9.87 N.
    np.testing.assert_allclose(found, ebook.table(layout)[1:], rtol=1e-11, atol=1e-11)


def test_ebook_cylinder_has_9_kg_along_the_bore_and_2_kg_across() -> None:
    balance = cp.Engine.preset("single-ebook").balance(RPM, orders=1)
    np.testing.assert_allclose(balance.force.peak_xy[0] / OMEGA**2, [2.0, 9.0], rtol=ROUNDING)
    # 9.870 N is printed.
    assert round(float(balance.force.peak_xy[0, 1]), 3) == 9.870


# --- VR and W -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "groups"), [("vr5", 1), ("vr6", 1), ("w8", 2), ("w12", 2), ("w16", 2)]
)
def test_planes_of_a_groups_rows_meet_below_the_crank(name: str, groups: int) -> None:
    engine = cp.Engine.preset(name)
    along = np.exp(1j * np.deg2rad(engine.bank_deg))
    # An offset is positive on the side to which the crankpin swings after TDC: counter-clockwise.
    foot = 1j * along * np.array([part.pin_offset for part in engine.cylinders])
    for group in range(groups):
        first = group * len(engine) // groups
        one, two = first, first + 1
        matrix = np.array(
            [[along[one].real, -along[two].real], [along[one].imag, -along[two].imag]]
        )
        gap = foot[two] - foot[one]
        s, t = np.linalg.solve(matrix, [gap.real, gap.imag])
        # Both lines reach the point at the same distance, backwards: 12.5 mm / tan 7.5° below.
        assert [s, t] == pytest.approx([-0.0125 / math.tan(math.radians(7.5))] * 2, rel=1e-12)


def test_vr6_pins_are_split_as_published() -> None:
    engine = cp.Engine.preset("vr6")
    # 1-6, 5-2 and 3-4 fire a turn apart, as in a straight-six; 22° is published, to a degree.
    for left, right in ((1, 6), (5, 2), (3, 4)):
        apart = (engine.pin_deg[left - 1] - engine.pin_deg[right - 1]) % 360.0
        assert apart == pytest.approx(22.0, abs=0.5)


def test_vr6_shakes_less_than_any_other_v6() -> None:
    # It has a straight-six's crank but for 7° of its pins; what is left goes with its 15°.
    others = [moment(name, 1) for name in ("v6-60", "v6-90", "v6-90-odd-fire", "v6-120")]
    assert 0.0 < moment("vr6", 1) < min(others)


# --- asking ---------------------------------------------------------------------------------------


def test_another_cylinder_leaves_the_crank() -> None:
    part = cp.Cylinder(0.04, 0.13, 0.5)
    preset = cp.Engine.preset("v6-60")
    engine = cp.Engine.preset("v6-60", cylinder=part)
    assert engine.cylinders == (part,) * 6
    assert engine == preset.replace(cylinder=part)
    assert engine.name == preset.name
    massive = cp.Engine.preset("v8-crossplane-ebook", cylinder=part)
    assert massive.rotating_mass.tolist() == [2.0] * 8


def test_vr_engines_keep_their_bores_offset() -> None:
    part = cp.Cylinder(0.045, 0.16, 0.5, pin_offset=0.0005)
    engine = cp.Engine.preset("vr6", cylinder=part)
    offsets = [each.pin_offset for each in engine.cylinders]
    assert offsets == pytest.approx([0.013, -0.012] * 3, rel=ROUNDING)
    np.testing.assert_array_equal(engine.tdc_deg, cp.Engine.preset("vr6").tdc_deg)
    with pytest.raises(cp.InputError, match=r"pin_offset = 0\.0125: the crank cannot turn"):
        cp.Engine.preset("vr6", cylinder=cp.Cylinder(0.045, 0.05, 0.5))


@in_turn("name", NAMES)
def test_spacing_stretches_the_crank(name: str) -> None:
    preset, engine = cp.Engine.preset(name), cp.Engine.preset(name, spacing=0.25)
    throws = np.unique(engine.z)
    np.testing.assert_allclose(np.diff(throws), 0.25, rtol=ROUNDING)
    if len(throws) > 1:
        stretch = 0.25 / (np.unique(preset.z)[1] - np.unique(preset.z)[0])
        np.testing.assert_allclose(engine.z, preset.z * stretch, rtol=ROUNDING)
    assert engine.replace(z=preset.z) == preset


def test_refusals() -> None:
    with pytest.raises(cp.InputError) as refusal:
        cp.Engine.preset("v8-crosplane")
    assert str(refusal.value) == (
        'name = "v8-crosplane": no such preset; did you mean "v8-crossplane"? '
        "crankpin.presets() lists all"
    )
    with pytest.raises(cp.InputError, match='mean "v8-crossplane"'):
        cp.Engine.preset("V8-CrossPlane")
    with pytest.raises(cp.InputError, match=r'"v14-9\.13" or "v14-49\.54" or .* or "v14-170\.87"'):
        cp.Engine.preset("v14")
    with pytest.raises(cp.InputError, match="name = 6: give the name of a preset"):
        cp.Engine.preset(6)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"cylinder = 0\.5: give a crankpin\.Cylinder"):
        cp.Engine.preset("i4", cylinder=0.5)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match="spacing = nan: give a finite distance"):
        cp.Engine.preset("i4", spacing=math.nan)
    with pytest.raises(cp.InputError, match="spacing = 'wide': give a number"):
        cp.Engine.preset("i4", spacing="wide")  # type: ignore[arg-type]


def test_names_close_to_several_presets_are_no_slip_of_one() -> None:
    with pytest.raises(cp.InputError, match=r'"v8-60" or "v6-60" or .* build it by Engine\.vee'):
        cp.Engine.preset("v9-60")


@pytest.mark.parametrize(
    ("usual", "name"), [("straight-6", "i6"), ("Inline-four", "i4"), ("V8-60", "v8-60")]
)
def test_usual_names(usual: str, name: str) -> None:
    assert presets_module.named(usual) == name


def test_they_are_a_mapping_that_lacks_what_it_does_not_know() -> None:
    known: Any = cp.presets()
    assert known.get("v9-60") is None  # by a KeyError
    assert ["i4"] not in known  # which has no hash
    assert known["i4"] == cp.Engine.preset("i4")
    rows = {row[0]: row for row in known.table().cells()}
    assert [row[3] for row in (rows["i4"], rows["flat-4"])] == ["1-3-4-2", "–"]
    assert [row[2] for row in (rows["i4"], rows["v6-60"])] == ["–", "60"]


def test_families() -> None:
    assert "v6-60-ebook" not in presets_module.family("v6")
    assert presets_module.family("ijesc-v6") == [f"ijesc-v6-{order}" for order in LAGS]
    assert presets_module.family("v14") == ["v14-9.13", "v14-49.54", "v14-63.03", "v14-170.87"]
    assert presets_module.family("v6-60") == ["v6-60"]  # not v6-60-ebook: a preset is itself
    assert presets_module.family("v7") == ["v7"]


def test_presets_take_no_further_attributes() -> None:
    with pytest.raises(AttributeError):
        cp.presets().other = 1  # type: ignore[attr-defined]
