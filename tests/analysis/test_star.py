"""Are phase vectors of a firing order and their sums those of the equations and of the sources?"""

from __future__ import annotations

import math
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import firing as rederived
from support import in_turn
from support.engines import CYLINDER

if TYPE_CHECKING:
    from collections.abc import Sequence

# Sums of at most 24 vectors of length 1, each good to 2e-16.
ROUNDING = 1e-14
HALVES = [0.5 * k for k in range(1, 25)]


def inline(tdc_deg: Sequence[float], firing_order: str, **changes: Any) -> cp.Engine:  # noqa: ANN401
    count = len(tdc_deg)
    engine = cp.Engine.from_lists(
        CYLINDER, tdc_deg=tdc_deg, bank_deg=[90] * count, z=[0.1 * k for k in range(count)]
    )
    return engine.replace(firing_order=firing_order, **changes)


# --- printed figures ----------------------------------------------------------------------------


@pytest.mark.parametrize(("angle", "order"), rederived.STAR_OF_BANKS)
def test_sums_of_the_banks_of_a_v12(angle: int, order: float) -> None:
    """The two banks are alike: the sum is that of a cylinder of each, times six."""
    true, printed = rederived.STAR_OF_BANKS[angle, order]
    pair = cp.Engine.vee(CYLINDER, bank_angle_deg=angle, throws_deg=[0], spacing=0.1)
    found = cp.star_diagram(pair, [order], firing_order="1-2")
    assert found.firing.angles_deg.tolist() == [0.0, 360.0 + angle]
    assert found.sums.peak[0] == pytest.approx(true, abs=5e-7)  # six decimals
    slips = abs(found.sums.peak[0] - printed) > 1e-3  # printed to three
    assert slips == ((angle, order) == (30, 4.5))


def test_odd_firing_leaves_orders_that_even_firing_cancels() -> None:
    six = cp.star_diagram(cp.Engine.preset("v6-90-odd-fire"))
    twin = cp.star_diagram(cp.Engine.preset("v-twin-90"))
    assert twin.firing.intervals_deg.tolist() == [450.0, 270.0]
    for diagram, known in [
        (six, {1.5: 2.296101, 3: 4.242641}),
        (twin, {0.5: 0.765367, 1: 1.414214, 1.5: 1.847759}),
    ]:
        for order, size in known.items():
            assert abs(diagram[order]) == pytest.approx(size, abs=5e-7)  # six decimals
    assert six.verdicts.remaining == (1.5, 3, 4.5, 7.5, 9, 10.5, 12)
    assert six.major == (12,)


def test_a_mode_shape_weighs_the_cylinders() -> None:
    shape = [1, 0.95, 0.86, 0.73, 0.57, 0.39]
    found = cp.star_diagram(cp.Engine.preset("i6"), [0.5, 1.5, 3], mode_shape=shape)
    np.testing.assert_allclose(found.sums.peak, [0.415812, 1.12, 4.5], atol=5e-7)  # six decimals
    assert found.verdicts.remaining == (0.5, 1.5, 3)
    assert found.major == (3,)
    # 0.1 + 0.2 is 0.3 as typed: the vectors at 0 and 180° cancel, though doubles do not.
    pair = inline([0, 0, 180], "1+2-3")
    assert cp.star_diagram(pair, [1], mode_shape=[0.1, 0.2, 0.3])[1] == 0.0
    assert cp.star_diagram(pair, [1], mode_shape=[0.1, 0.2, 0.31]).verdicts[1] == "remains"


# --- laws ---------------------------------------------------------------------------------------


@in_turn("name", cp.presets())
def test_even_firing_leaves_multiples_of_half_the_number_of_cylinders(name: str) -> None:
    engine = cp.Engine.preset(name)
    if not engine.firing_order or engine.strokes != 4 or name in ("vr5", "vr6", "w8", "w12", "w16"):
        return  # tops dead centre of offset rows are no parts of a turn
    found = cp.star_diagram(engine)
    multiples = tuple(n for n in found.orders if 2 * n % len(engine) == 0)
    if found.firing.even:
        assert found.verdicts.remaining == found.major == multiples
        np.testing.assert_allclose(found.sums.peak[found.sums.peak > 0], len(engine), rtol=ROUNDING)
    else:
        assert found.verdicts.remaining != multiples


def test_half_orders_of_a_two_stroke_do_not_exist() -> None:
    three = inline([0, 120, 240], "1-2-3", strokes=2)
    assert cp.star_diagram(three).major == (3, 6, 9, 12)
    with pytest.raises(cp.InputError, match=r"orders = 1\.5: the cycle of a two-stroke repeats"):
        cp.star_diagram(three, [1, 1.5])


tops = st.lists(st.integers(0, 71).map(lambda k: 5.0 * k), min_size=1, max_size=7)


@settings(max_examples=60, deadline=None)
@given(tops=tops, choice=st.integers(0, 63), first=st.integers(0, 71))
def test_any_firing_order_is_the_rederivation_of_its_angles(
    tops: list[float], choice: int, first: int
) -> None:
    ways = inline([top + 5.0 * first for top in tops], "").firing_orders()
    firing_order = ways[choice % len(ways)].firing_order
    found = cp.star_diagram(ways[0].engine, HALVES, firing_order=firing_order)
    fire = [Fraction(angle) for angle in found.firing.angles_deg]
    for order, vectors, total in zip(
        HALVES, found.read("vectors"), found.read("sums"), strict=True
    ):
        expected = rederived.phase_vectors(fire, order)
        np.testing.assert_allclose(vectors, expected, atol=ROUNDING)
        assert abs(total - sum(expected)) < ROUNDING
        # Whole weights below 8 of roots of order 144: no sum but zero is below 1e-9.
        assert found.verdicts[order] == ("vanishes" if abs(sum(expected)) < 1e-9 else "remains")
        aligned = abs(sum(expected)) > len(tops) - 1e-9
        assert (order in found.major) == aligned


@settings(max_examples=30, deadline=None)
@given(tops=tops)
def test_a_firing_order_and_its_mirror_have_equal_sums(tops: list[int]) -> None:
    engine = inline(tops, "")
    for way in engine.firing_orders()[:3]:
        fire = [720 - angle for angle in way.angles_deg]
        peaks = cp.star_diagram(engine, HALVES, firing_order=way.firing_order).sums.peak
        mirrored = [abs(sum(rederived.phase_vectors(fire, order))) for order in HALVES]
        if way == engine.firing(way.firing_order):
            np.testing.assert_allclose(peaks, mirrored, atol=ROUNDING)


# --- proofs -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["i4", "v6-90-odd-fire", "v8-crossplane", "i5", "vr6", "v-twin-90"]
)
def test_proofs_of_gas_torque_are_those_of_the_star(name: str) -> None:
    engine = cp.Engine.preset(name)
    proof, star = engine.vanishing_orders(HALVES), cp.star_diagram(engine, HALVES)
    if name == "vr6":
        # Rows of opposite offsets have gas torques of no known ratio.
        assert set(proof.gas_torque.vanishing) <= set(star.verdicts.vanishing)
        assert "different dimensions" in " ".join(proof.obstacles)
    else:
        assert proof.gas_torque.words == star.verdicts.words
    for n in (0.5, 1.5):
        assert proof.force[n] == proof.moment[n] == proof.torque[n] == "vanishes"


def test_whole_orders_of_gas_need_no_firing_order() -> None:
    unknown = inline([0, 180, 180, 0], "")
    assert unknown.vanishing_orders(range(1, 9)).gas_torque.remaining == (2, 4, 6, 8)
    with pytest.raises(cp.InputError, match="firing order is not known"):
        unknown.vanishing_orders([0.5, 1])
    with pytest.raises(cp.InputError, match="firing order is not known"):
        cp.star_diagram(unknown)
    two = inline([0, 120, 240], "1-2-3", strokes=2)
    assert two.vanishing_orders([0.5, 1, 3]).gas_torque.vanishing == (0.5, 1)


def test_unlike_cylinders_have_gas_torques_of_no_known_ratio() -> None:
    engine = inline([0, 180, 180, 0], "1-3-4-2")
    bores = [CYLINDER.replace(bore=bore) for bore in (0.086, 0.086, 0.08, 0.08)]
    mixed = engine.replace(cylinder=bores)
    proof = mixed.vanishing_orders([1, 2])
    # At order 1 the cylinders of each bore cancel by themselves.
    assert proof.gas_torque.words == ("vanishes", "undecided")
    assert proof.torque[2] == "remains"
    assert any("gas torques have no ratio" in text for text in proof.obstacles)
    masses = [CYLINDER.replace(reciprocating_mass=mass) for mass in (0.5, 0.5, 0.6, 0.6)]
    assert engine.replace(cylinder=masses).vanishing_orders([2]).gas_torque[2] == "remains"


def test_angles_that_are_no_parts_of_a_turn_are_undecided() -> None:
    odd = inline([0, math.sqrt(3e4)], "1-2")
    found = cp.star_diagram(odd, [1, 2])
    assert found.verdicts.undecided == (1, 2)
    assert found.major == ()
    assert found[1] != 0.0


# --- fired engines ------------------------------------------------------------------------------

CYCLE = cp.Cycle([0, 20, 60, 150, 300, 420, 540, 640, 700], 1e5 * np.array(
    [40, 55, 20, 4, 1.1, 0.9, 1, 3, 20]))  # fmt: skip
BORED = CYLINDER.replace(bore=0.086)


@pytest.mark.parametrize("name", ["i3", "i4", "v6-90-odd-fire", "v-twin-90", "v8-crossplane"])
def test_gas_torque_is_that_of_one_cylinder_times_the_star(name: str) -> None:
    engine = cp.Engine.preset(name).replace(cylinder=BORED)
    alone = inline([0], "1").replace(cylinder=BORED).with_cycle(CYCLE)
    one = alone.balance(3000, orders=HALVES).crank_torque.gas
    fired = engine.with_cycle(CYCLE)
    found = fired.balance(3000, orders=HALVES).crank_torque.gas
    star, proof = cp.star_diagram(engine, HALVES), fired.vanishing_orders(HALVES)
    # Sums of at most 8 phasors, rounded relative to the largest of a cylinder.
    largest = float(np.abs(np.asarray(one)).max())
    np.testing.assert_allclose(
        np.asarray(found), np.asarray(one) * star.sums, atol=1e-13 * len(engine) * largest
    )
    assert proof.gas_torque.words == star.verdicts.words
    for order in HALVES:
        assert (proof.gas_torque[order] == "vanishes") == (found[order].peak == 0.0)


def test_a_misfire_leaves_every_half_order() -> None:
    i4 = cp.Engine.preset("i4").replace(cylinder=BORED)
    misfiring = i4.with_cycle([CYCLE, None, CYCLE, CYCLE])
    assert misfiring.vanishing_orders(HALVES).gas_torque.remaining == tuple(HALVES)
    assert i4.with_cycle(CYCLE).vanishing_orders(HALVES).gas_torque.remaining == tuple(
        n for n in HALVES if n % 2 == 0
    )
    other = i4.with_cycle([CYCLE, CYCLE.replace(pressure=2 * CYCLE.pressure), CYCLE, CYCLE])
    # Of unlike cycles, whose sums have no ratio, the value decides.
    assert other.vanishing_orders([1, 2]).gas_torque.words == ("remains", "remains")


def test_a_balance_says_which_zeros_of_a_fired_engine_are_proved() -> None:
    b = (
        cp.Engine.preset("i4")
        .replace(cylinder=BORED)
        .with_cycle(CYCLE)
        .balance(3000, orders=HALVES)
    )
    for quantity in ("torque", "crank_torque"):
        assert [n for n in HALVES if b._proved_zero(quantity, n)] == [n for n in HALVES if n % 2]
        assert getattr(b, quantity)[0.5].status == "zero, proved"
    assert b._proved_zero("force", 0.5)


# --- results ------------------------------------------------------------------------------------


def test_a_diagram_is_read_by_order() -> None:
    found = cp.star_diagram(cp.Engine.preset("v6-90-odd-fire"), [1.5, 3])
    assert list(found) == [1.5, 3]
    assert 3 in found
    assert 1 not in found
    assert found[3] == found.read("sums")[1] == found.sums[3]
    with pytest.raises(cp.InputError, match=r"order = 2: choose from orders 1\.5, 3"):
        found[2]
    assert pickle.loads(pickle.dumps(found)) == found  # noqa: S301 - its own
    with pytest.raises(ValueError, match="read-only"):
        found.read("vectors")[0] = 0
    table = found.to_pandas()
    assert table["sum"].tolist() == found.sums.peak.tolist()
    assert table["share %"].tolist() == pytest.approx((100.0 * found.sums.peak / 6.0).tolist())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"mode_shape": [1, 2]},
            r"mode_shape = \[1, 2\]: give a finite amplitude for each of the 6",
        ),
        ({"mode_shape": [math.nan] * 6}, "mode_shape = "),
        ({"orders": [0.25]}, r"orders = \[0\.25\]"),
        ({"orders": [1, 1.0]}, "give each order once"),
        ({"orders": []}, "give each order once"),
        ({"firing_order": "1-2-3-4-5-6"}, "this crank cannot fire in this order"),
    ],
)
def test_errors_name_the_argument(changes: dict[str, object], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.star_diagram(cp.Engine.preset("i6"), **changes)  # type: ignore[arg-type]
