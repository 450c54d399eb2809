"""Do builders take parts and places of each cylinder, and firing orders as people write them?"""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from typing import Any

import crankpin as cp
import numpy as np
import pytest

PARTS = cp.Cylinder(0.043, 0.145, 0.5)
HEAVY = PARTS.replace(reciprocating_mass=0.51)
ROD = cp.Cylinder.from_rod(cp.Rod.estimated(0.6, 0.145, 0.05), 0.043, 0.4)
V8: dict[str, Any] = {
    "bank_angle_deg": 90, "throws_deg": [0, 90, 270, 180], "spacing": 0.1, "odd_bank": "left",
}  # fmt: skip


# --- parts and places ----------------------------------------------------------------------------


def test_measured_parts_of_each_cylinder() -> None:
    """What each cylinder has counts: 10 g more at one end rock an inline-2 of 360°."""
    twin = cp.Engine.inline([PARTS, HEAVY], throws_deg=[0, 0], spacing=0.1)
    assert twin.cylinders == (PARTS, HEAVY)
    same = cp.Engine.from_lists([PARTS, HEAVY], tdc_deg=[0, 0], bank_deg=[90, 90], z=[0, 0.1])
    assert twin == same
    omega = 2.0 * np.pi * 100.0
    peak = twin.balance(6000, orders=[1])[1].moment.peak
    assert peak == pytest.approx(0.010 * 0.043 * omega**2 * 0.05, rel=1e-12)


@pytest.mark.parametrize(
    "engine",
    [
        cp.Engine.vee([PARTS] * 7 + [HEAVY], **V8),
        cp.Engine.flat([PARTS] * 3 + [HEAVY], throws_deg=[0, 180], spacing=0.1),
        cp.Engine.boxer([PARTS] * 3 + [HEAVY], throws_deg=[0, 180], spacing=0.1),
        cp.Engine.radial([PARTS] * 4 + [HEAVY], 5),
        cp.Engine.from_firing_order([PARTS] * 3 + [HEAVY], "1-3-4-2", spacing=0.1),
        cp.Engine.from_banks([PARTS] * 3 + [HEAVY], "X", throws_deg=[0], spacing=0.1),
    ],
)
def test_every_builder_takes_a_list_of_parts(engine: cp.Engine) -> None:
    masses = [each.reciprocating_mass for each in engine.cylinders]
    assert masses == [0.5] * (len(engine) - 1) + [0.51]


def test_rods_bring_their_big_ends() -> None:
    engine = cp.Engine.inline([PARTS, ROD], throws_deg=[0, 180], spacing=0.1)
    assert ROD.rod is not None
    assert engine.rotating_mass.tolist() == [0.0, ROD.rod.rotating_mass]
    given = cp.Engine.inline([PARTS, ROD], throws_deg=[0, 180], spacing=0.1, rotating_mass=0.3)
    assert given.rotating_mass.tolist() == [0.3, 0.3]


def test_a_cylinder_for_each_bank() -> None:
    banks = {"right": PARTS, "left": PARTS.replace(pin_offset=0.001)}
    v8 = cp.Engine.vee(banks, **V8)
    assert [each.pin_offset for each in v8.cylinders] == [0.001, 0.0] * 4


def test_unequal_spacing() -> None:
    v8 = cp.Engine.vee(PARTS, **V8 | {"spacing": [0.1, 0.12, 0.1], "bank_stagger": 0.02})
    np.testing.assert_allclose(v8.z[1::2], [0.0, 0.1, 0.22, 0.32], atol=1e-15)
    np.testing.assert_allclose(v8.z[::2], [0.02, 0.12, 0.24, 0.34], atol=1e-15)
    even = cp.Engine.vee(PARTS, **V8 | {"bank_stagger": 0.02})
    listed = cp.Engine.vee(PARTS, **V8 | {"spacing": [0.1] * 3, "bank_stagger": 0.02})
    np.testing.assert_allclose(listed.z, even.z, atol=1e-15)
    inline = cp.Engine.inline(PARTS, throws_deg=[0, 120, 240], spacing=[0.1, 0.2])
    np.testing.assert_allclose(inline.z, [0.0, 0.1, 0.3], atol=1e-15)


def test_random_vees_with_spacings_are_lists_with_these_places() -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        count = int(rng.integers(2, 6))
        distances = rng.uniform(0.05, 0.2, count - 1)
        throws = rng.integers(0, 360, count).tolist()
        masses = rng.uniform(0.4, 0.6, 2 * count)
        parts = [PARTS.replace(reciprocating_mass=mass) for mass in masses]
        engine = cp.Engine.vee(
            parts, bank_angle_deg=60, throws_deg=throws, spacing=distances, numbering="by-bank"
        )
        z = np.concatenate([[0.0], np.cumsum(distances)])
        lists = cp.Engine.from_lists(
            parts,
            pin_deg=[(each - throws[0] + 60) % 360 for each in [*throws, *throws]],
            bank_deg=[60] * count + [120] * count,
            z=[*z, *z],
        )
        for order in (1, 2):
            one, other = (each.balance(3000, orders=[order])[order] for each in (engine, lists))
            np.testing.assert_allclose(one.force.peak, other.force.peak, rtol=1e-9, atol=1e-9)
            np.testing.assert_allclose(one.moment.peak, other.moment.peak, rtol=1e-9, atol=1e-9)


def test_places_are_the_decimals_that_a_person_would_write() -> None:
    rng = np.random.default_rng(36)
    for _ in range(200):
        throws, digits = int(rng.integers(2, 7)), int(rng.integers(1, 4))
        gaps = [Decimal(int(each)).scaleb(-digits) for each in rng.integers(1, 10**digits, throws)]
        gap, stagger = gaps[0], Decimal(int(rng.integers(-9, 10))).scaleb(-3)
        even = rng.random() < 0.5
        distances = [gap] * (throws - 1) if even else gaps[1:]
        spacing = float(gap) if even else [float(each) for each in distances]
        at = [sum(distances[:k], Decimal(0)) for k in range(throws)]
        along: dict[str, Any] = {"throws_deg": [0] * throws, "spacing": spacing}
        along_vee = {**along, "bank_angle_deg": 60, "numbering": "by-bank"}
        banks = [60, 75, 105, 130]
        rows: dict[str, Any] = {"rows": throws, "spacing": spacing, "firing_order": ""}
        for engine, z in [
            (cp.Engine.inline(PARTS, **along), at),
            (
                cp.Engine.vee(PARTS, **along_vee, bank_stagger=float(stagger)),
                [*(a + stagger for a in at), *at],
            ),
            (
                cp.Engine.from_banks(PARTS, banks, **along, bank_stagger=float(stagger)),
                [a + k * stagger for k in range(4) for a in at],
            ),
            (cp.Engine.radial(PARTS, 3 * throws, **rows), sorted(at * 3)),
        ]:
            assert sorted(engine.z.tolist()) == sorted(map(float, z))
    for name in cp.presets():
        written = re.findall(r"\bz = (\S+)", cp.Engine.preset(name, spacing=0.098).to_toml())
        assert max(map(len, written)) <= len("-1.234"), (name, written)


# --- odd vees, radials, fans ----------------------------------------------------------------------


def test_a_v3_has_a_cylinder_on_each_throw() -> None:
    v3 = cp.Engine.vee(
        PARTS, bank_angle_deg=90, throws_deg=[0, 120, 240], spacing=0.1, absent=[2, 3, 6]
    )
    assert v3.banks == {"right": (1, 3), "left": (2,)}
    np.testing.assert_allclose(v3.pin_deg - v3.pin_deg[0], [0, 120, 240])
    np.testing.assert_allclose(v3.z, [0.0, 0.1, 0.2])


def test_a_v5_balances_itself_at_75_and_a_half_degrees() -> None:
    """Honda's RC211V: three in front and two behind, its middle throw 104.5° from the others.

    The force of order 1 that turns against the crank is the sum of exp(i(2·bank − pin)): it
    vanishes where two cylinders of 2 + 1 and two of one pin at 151° add up to nothing.
    """
    v5 = cp.Engine.vee(
        PARTS, bank_angle_deg="75.5", throws_deg=[0, "104.5", 0], spacing=0.1, absent=[6]
    )
    assert (len(v5), v5.bank_angle_deg) == (5, 75.5)
    lists = cp.Engine.from_lists(
        PARTS,
        pin_deg=[Fraction(209, 4)] * 2 + [Fraction(627, 4)] * 2 + [Fraction(209, 4)],
        bank_deg=["52.25", "127.75"] * 2 + ["52.25"],
        z=[0, 0, 0.1, 0.1, 0.2],
    )
    np.testing.assert_allclose(v5.pin_deg, lists.pin_deg, atol=1e-12)
    np.testing.assert_allclose(v5.tdc_deg, lists.tdc_deg, atol=1e-12)


def test_a_vr5_is_every_second_cylinder_of_five_throws() -> None:
    throws = [0, 144, 288, 216, 72]
    vr5 = cp.Engine.vee(
        PARTS, bank_angle_deg=15, throws_deg=throws, spacing=0.065, absent=[2, 3, 6, 7, 10]
    )
    assert vr5.banks == {"right": (1, 3, 5), "left": (2, 4)}
    np.testing.assert_allclose((vr5.pin_deg - vr5.pin_deg[0]) % 360, throws)


def test_absent_cylinders_that_are_none() -> None:
    for absent in ([9], [0], [*range(1, 9)], 3):
        with pytest.raises(cp.InputError, match="absent"):
            cp.Engine.vee(PARTS, **V8, absent=absent)  # type: ignore[arg-type]


def test_radials_of_several_rows() -> None:
    """The R-4360 has four rows of seven, and fires evenly every 720°/28."""
    wasp = cp.Engine.radial(PARTS, 28, rows=4, spacing=0.2)
    firing = wasp.firing()
    assert firing.even
    assert firing.firing_order.count("-") == 27
    np.testing.assert_allclose(np.unique(wasp.z), [0.0, 0.2, 0.4, 0.6])
    assert cp.Engine.radial(PARTS, 14, rows=2, spacing=0.2) == cp.Engine.radial(
        PARTS, 14, rows=2, spacing=[0.2]
    )
    unequal = cp.Engine.radial(PARTS, 9, rows=3, spacing=[0.2, 0.3], firing_order="")
    np.testing.assert_allclose(np.unique(unequal.z), [0.0, 0.2, 0.5])


def test_fans_are_their_lists() -> None:
    w6 = cp.Engine.from_banks(PARTS, "W", throws_deg=[0, 180], spacing=0.1)
    lists = cp.Engine.from_lists(
        PARTS, pin_deg=[30, 210] * 3, bank_deg=[30, 30, 90, 90, 150, 150], z=[0, 0.1] * 3
    )
    np.testing.assert_array_equal(w6.tdc_deg, lists.tdc_deg)
    np.testing.assert_array_equal(w6.z, lists.z)
    assert w6.banks == {"bank 1": (1, 2), "bank 2": (3, 4), "bank 3": (5, 6)}
    staggered = cp.Engine.from_banks(
        PARTS, [60, 120], throws_deg=[0, 180], spacing=0.1, bank_stagger=0.02
    )
    np.testing.assert_allclose(staggered.z, [0.0, 0.1, 0.02, 0.12])
    unequal = cp.Engine.from_banks(
        PARTS, "W", throws_deg=[0, 120, 240], spacing=[0.1, 0.2], bank_stagger=0.02
    )
    along = np.array([0.0, 0.1, 0.3])
    np.testing.assert_allclose(unequal.z, [*along, *(along + 0.02), *(along + 0.04)], rtol=1e-15)
    with pytest.raises(cp.InputError, match="number of cylinders = 25000000"):
        cp.Engine.from_banks(PARTS, [90] * 5000, throws_deg=[0] * 5000, spacing=0.1)


def test_several_cranks_in_lists() -> None:
    """Two cranks that turn against each other: what turns with one meets what turns with the other.

    The same engine from a file.
    """
    four = cp.Engine.from_lists(
        PARTS,
        tdc_deg=[0, 180, 180, 0],
        bank_deg=[90] * 4,
        z=[0, 0.1, 0, 0.1],
        cranks=[(0.1, 0.0, -1)],
        crank=[0, 0, 1, 1],
    )
    assert cp.Engine.from_toml(four.to_toml()) == four
    assert "crank = 1" in four.to_toml()
    assert four.balance(3000, orders=[1])[1].force.peak == 0.0
    lists: dict[str, Any] = {"tdc_deg": [0], "bank_deg": [90], "z": [0]}
    for wrong in (
        {"cranks": [(0.1, 0.0, -1)]},
        {"crank": [1]},
        {"crank": [0, 0]},
        {"cranks": [(0.1, 0.0)], "crank": [1]},
    ):
        with pytest.raises(cp.InputError, match="crank"):
            cp.Engine.from_lists(PARTS, **lists, **wrong)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"cylinder": [PARTS] * 3}, "cylinder has 3 entries"),
        ({"cylinder": []}, "cylinder"),
        ({"cylinder": {"right": PARTS}}, "left"),
        ({"cylinder": {"middle": PARTS}}, "cylinder"),
        ({"cylinder": [PARTS] * 7 + [3]}, "cylinder"),
        ({"spacing": [0.1]}, "spacing has 1 entries, the crank has 3: give one for each gap"),
        ({"spacing": [0.1, -0.1, 0.1]}, "spacing"),
    ],
)
def test_parts_and_places_that_are_wrong(options: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"cylinder": PARTS} | V8 | options
    with pytest.raises(cp.InputError, match=message):
        cp.Engine.vee(given.pop("cylinder"), **given)


# --- firing orders as people write them ----------------------------------------------------------


@pytest.mark.parametrize(
    "typed",
    [
        "18436572",
        "1 8 4 3 6 5 7 2",
        "1,8,4,3,6,5,7,2",
        "1–8–4–3–6–5–7–2",
        "1—8—4—3—6—5—7—2",
        "A1-B4-B2-A2-B3-A3-A4-B1",
        "a1-b4-b2-a2-b3-a3-a4-b1",
        "1L-4R-2R-2L-3R-3L-4L-1R",
        "L1,R4,R2,L2,R3,L3,L4,R1",
        [1, 8, 4, 3, 6, 5, 7, 2],
    ],
)
def test_firing_orders_as_people_write_them(typed: Any) -> None:  # noqa: ANN401
    v8 = cp.Engine.vee(PARTS, **V8, firing_order=typed)
    assert v8.firing_order == "1-8-4-3-6-5-7-2"
    assert v8.firing(typed).firing_order == v8.firing_order
    again = cp.Engine.from_firing_order(
        PARTS, typed, bank_angle_deg=90, spacing=0.1, odd_bank="left"
    )
    assert again.firing_order == v8.firing_order


def test_firing_orders_together() -> None:
    flat = cp.Engine.inline(PARTS, throws_deg=[0, 180, 180, 0], spacing=0.1)
    assert flat.replace(firing_order="1+4-2+3").firing_order == "1+4-2+3"


@pytest.mark.parametrize("typed", ["A1-B9", "A1-C1", "1L-1X", "A0-B1"])
def test_firing_orders_of_banks_that_are_none(typed: str) -> None:
    with pytest.raises(cp.InputError, match="banks and cylinders are"):
        cp.Engine.vee(PARTS, **V8, firing_order=typed)


# --- cylinders that fire together -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("order", "strokes", "intervals", "throws"),
    [
        ("1+4-2+3", 2, None, [0, 180, 180, 0]),
        ("1+4-2+3", 4, None, [0, 0, 0, 0]),  # two firings in two turns
        ("1 + 2 – 3 + 4", 2, None, [0, 0, 180, 180]),
        ("4+1-2+3", 4, [0, 180, 0, 540], [0, 180, 180, 0]),
        ("1-2+3", 2, [120, 0, 240], [0, 240, 240]),
    ],
)
def test_pins_of_cylinders_that_fire_together(
    order: str, strokes: int, intervals: list[int] | None, throws: list[int]
) -> None:
    """Those that are joined by ``+`` reach the top together; the rest is as for single ones."""
    engine = cp.Engine.from_firing_order(
        PARTS, order, spacing=0.1, strokes=strokes, intervals_deg=intervals
    )
    turned = (engine.pin_deg - engine.pin_deg[0]) % 360
    assert turned.tolist() == throws
    found, _ = cp.throws(order, strokes=strokes, intervals_deg=intervals)
    assert found.tolist() == throws
    inline = cp.Engine.inline(
        PARTS, throws_deg=throws, spacing=0.1, firing_order=order, strokes=strokes
    )
    assert inline.firing() == engine.firing()
    assert cp.Engine.from_toml(engine.to_toml()) == engine
    if intervals is not None:
        assert sorted(engine.firing_intervals_deg.tolist()) == sorted(intervals)


def test_a_flat_twin_that_fires_both_at_once() -> None:
    """Both pistons of a boxer are at the top together: order ½ is twice one's."""
    boxer = cp.Engine.boxer(PARTS, throws_deg=[0], spacing=0.1, firing_order="1+2")
    named = cp.Engine.from_firing_order(
        PARTS, "1+2", bank_angle_deg=180, spacing=0.1, shared_pins=False
    )
    for engine in (boxer, named):
        assert engine.firing_intervals_deg.tolist() == [0.0, 720.0]
        bored = engine.replace(cylinder=[one.replace(bore=0.08) for one in engine.cylinders])
        both = bored.with_cycle(cp.Cycle.example())
        one = both.with_cycle([cp.Cycle.example(), None])
        peaks = [each.balance(3000)[0.5].crank_torque.gas.peak for each in (both, one)]
        assert peaks[0] == pytest.approx(2.0 * peaks[1], rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"intervals_deg": [180, 180, 180, 180]}, r"intervals_deg\[0\] = 180: give 0 between"),
        (
            {"intervals_deg": [0, 0, 0, 720]},
            r"intervals_deg\[1\] = 0: give degrees above 0, or join",
        ),
        ({"rule": "ijesc"}, "knows no cylinders that fire together"),
    ],
)
def test_pins_that_cannot_fire_together(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(cp.InputError, match=said):
        cp.Engine.from_firing_order(PARTS, "1+4-2+3", spacing=0.1, **arguments)
