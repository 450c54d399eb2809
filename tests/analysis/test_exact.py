"""Is what is said to vanish zero, what is said to remain not, and are closed forms the numbers?

The proofs are held against floating point for every preset, against 50 digits for any rational
layout, and against the classical results by name.
"""

# ruff: noqa: ANN401 - SymPy has no types

from __future__ import annotations

import math
import subprocess
import sys
from fractions import Fraction
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import crankpin as cp
import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from rederivation import crossplane
from support import html_of, in_turn
from support.engines import CYLINDER

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin.model.engine import Hold

RPM = 10.0
NAMES = list(cp.presets())
# Tops dead centre of the right rows come from an arc sine; banks of the V14s from an argument.
IRRATIONAL = {
    "vr5",
    "vr6",
    "w8",
    "w12",
    "w16",
    *(name for name in NAMES if name.startswith("v14-")),
    # of pistons that face each other on several cranks
    "opposed-piston-6",
    "delta-18",
    # of unlike proportions
    "opposed-piston-3",
    *(name for name in NAMES if name.endswith("-link-rods")),
}
# Sums of at most 16 terms, each rounded a few times to 1.1e-16.
ROUNDING = 1e-13


def zeros(b: cp.results.Balance) -> dict[str, np.ndarray]:
    """Which of a balance's sums are given as zero, by the names of the proofs."""
    return {
        "force_x": b.force.xy[:, 0] == 0,
        "force_y": b.force.xy[:, 1] == 0,
        "force_forward": b.force.forward == 0,
        "force_backward": b.force.backward == 0,
        "moment_x": b.moment.xy[:, 0] == 0,
        "moment_y": b.moment.xy[:, 1] == 0,
        "moment_forward": b.moment.forward == 0,
        "moment_backward": b.moment.backward == 0,
        "torque": b.torque == 0,
        "gas_torque": gas_torque(b) == 0,
    }


def gas_torque(b: cp.results.Balance) -> np.ndarray:
    """Sums of gas on the block: of the star, on cranks of two senses of a fired engine."""
    if all(ratio > 0 for _, _, ratio in b.engine._core.cranks[0]):
        star = cp.star_diagram(b.engine, b.orders, firing_order=_any_order(b))
        return np.asarray(star.read("sums"))
    fired = b.engine.with_cycle(cp.Cycle.example(strokes=b.engine.strokes))
    return np.asarray(fired.balance(RPM, orders=b.orders).torque.gas)


def _any_order(b: cp.results.Balance) -> str:
    """At whole orders gas does not depend on the firing order."""
    return b.engine.firing_order or b.engine.firing_orders()[0].firing_order


def joined(pair: tuple[str, str]) -> str:
    return pair[0] if "torque" in pair[0] else "_".join(pair)


# --- what vanishes ------------------------------------------------------------------------------


@in_turn("name", [name for name in NAMES if name not in IRRATIONAL])
def test_proofs_agree_with_floating_point_both_ways(name: str) -> None:
    engine = cp.Engine.preset(name)
    v = engine.vanishing_orders()
    assert v.orders == tuple(range(1, 13))
    assert not v.undecided.any()
    assert v.obstacles == ()
    found = zeros(engine.balance(RPM, orders=range(1, 13)))
    for column, quantity in enumerate(map(joined, v.sums)):
        np.testing.assert_array_equal(v.vanishes[:, column], found[quantity], quantity)
        np.testing.assert_array_equal(v.remains[:, column], ~found[quantity], quantity)
        np.testing.assert_array_equal(v.within_rounding[:, column], found[quantity], quantity)


@pytest.mark.parametrize("name", sorted(IRRATIONAL))
def test_of_the_others_no_proof_is_wrong_and_some_are_given(name: str) -> None:
    v = cp.Engine.preset(name).vanishing_orders()
    assert v.undecided.any()
    assert v.vanishes.any()
    assert v.obstacles
    assert v.within_rounding[v.vanishes].all()
    assert not v.within_rounding[v.remains].any()


def test_rows_of_a_vr6_cancel_row_by_row() -> None:
    v = cp.Engine.preset("vr6").vanishing_orders()
    # Offset bores have odd orders too: orders 3 and 9 are left like 6 and 12.
    assert v.force.vanishing == (1, 2, 4, 5, 7, 8, 10, 11)
    assert v.force.y[6] == "remains"  # two rows are left, which by their values do not cancel


def test_proportions_are_compared_as_typed() -> None:
    """2/7 is 2/7, though 0.14/0.04 and 0.21/0.06 are two doubles."""
    twin = cp.Engine.from_lists(
        [cp.Cylinder(0.04, 0.14, 0.6), cp.Cylinder(0.06, 0.21, 0.4)],
        tdc_deg=[0, 90],
        bank_deg=[90, 90],
        z=[0, 0],
    )
    assert twin.vanishing_orders([2]).force.vanishing == (2,)
    assert twin.closed_form(2, "force").peak == 0


@pytest.mark.parametrize("hold", ["firing", "pins"])
def test_an_arrangement_hands_its_proof_on(hold: Hold) -> None:
    """The bank angle of an arrangement is exact, though it is no part of a turn."""
    found = cp.search_arrangements(10, hold=hold)
    for k in range(0, len(found), 7):
        engine = found[k].engine(CYLINDER, spacing=0.13)
        assert engine.vanishing_orders([1]).moment.backward[1] == "vanishes", k
    (ito,) = cp.search_arrangements(14).within(60, 90).best()
    engine = ito.engine(CYLINDER, spacing=0.13)
    beside = engine.with_bank_angle(float(engine.bank_angle_deg) + 1e-11, hold="firing")
    assert beside.vanishing_orders([1]).moment.backward[1] == "undecided"


def test_classical_results() -> None:
    def vanishing(name: str, quantity: str) -> set[int]:
        return set(attrgetter(quantity)(cp.Engine.preset(name).vanishing_orders()).vanishing)

    all_orders = set(range(1, 13))
    assert vanishing("i4", "force") == all_orders - {2, 4, 6, 8, 10, 12}
    assert vanishing("i4", "moment") == all_orders
    assert vanishing("i6", "force") == all_orders - {6, 12}
    assert vanishing("v8-crossplane", "moment") == all_orders - {1}
    assert vanishing("v8-crossplane", "moment.backward") == all_orders
    assert vanishing("v12-60", "force") == all_orders - {6, 12}
    assert vanishing("v12-60", "moment") == all_orders


@pytest.mark.filterwarnings("ignore:z .or spacing, bank_stagger. = 1e.06 m apart:UserWarning")
@pytest.mark.parametrize("spacing", [0.1, 0.13, 0.091, 1e-3 / 3, 1e6])
def test_equal_steps_in_decimals_are_equal(spacing: float) -> None:
    """0, 0.1, 0.2, 0.3 as they are typed: 0.3 is not three times 0.1 in binary."""
    assert 3 * 0.1 != 0.3
    z = [float(f"{k * spacing:.15g}") for k in range(4)]
    i4 = cp.Engine.from_lists(CYLINDER, tdc_deg=[0, 180, 180, 0], bank_deg=[90] * 4, z=z)
    assert i4.vanishing_orders(1).moment.x.vanishing == (1,)
    z[3] += 1e-6 * spacing
    moved = i4.replace(z=z).vanishing_orders(1)
    assert moved.moment.x.vanishing == ()


def test_the_plane_of_reference_matters_where_a_force_is_left() -> None:
    i4 = cp.Engine.preset("i4")
    assert i4.vanishing_orders(2).moment.x[2] == "vanishes"
    assert i4.vanishing_orders(2, reference_z=0.0).moment.x[2] == "remains"
    # No rational multiple of the spacing: still only one thing is left, the force times it.
    assert i4.vanishing_orders(2, reference_z=math.pi).moment.x[2] == "remains"


def test_an_angle_that_is_no_part_of_a_turn_is_not_decided() -> None:
    i3 = cp.Engine.from_lists(
        CYLINDER, tdc_deg=[0, 120.000000001234, 240], bank_deg=[90] * 3, z=[0, 0.1, 0.2]
    )
    v = i3.vanishing_orders([1, 2])
    assert v.force.y[1] == "undecided"
    assert not v.force.y.within_rounding[0]
    assert v.force.x[1] == "vanishes"  # upright bores
    assert any("cylinders 2" in text for text in v.obstacles)
    assert "?≠0" in repr(v)
    assert v.obstacles[0] in repr(v)
    assert f"<p>{v.obstacles[0]}</p>" in html_of(v)
    assert v.tidy()["verdict"].values[1] == "undecided"
    close = cp.Engine.from_lists(
        CYLINDER, tdc_deg=[0, 120 + 1e-13, 240], bank_deg=[90] * 3, z=[0, 0.1, 0.2]
    ).vanishing_orders(1)
    # Taken for 120°, or not proved: never proved to be zero and found not to be.
    assert close.within_rounding[close.vanishes].all()


def test_masses_of_other_proportions_cancel_group_by_group() -> None:
    longer = CYLINDER.replace(rod_length=0.2)
    parts = [CYLINDER, longer, longer, CYLINDER]
    layout: dict[str, Any] = {"bank_deg": [90] * 4, "z": [0.0] * 4}
    paired = cp.Engine.from_lists(parts, tdc_deg=[0, 0, 90, 90], **layout).vanishing_orders([1, 2])
    assert paired.force.y[2] == "vanishes"
    mixed = cp.Engine.from_lists(parts, tdc_deg=[0, 90, 0, 90], **layout).vanishing_orders([1, 2])
    assert mixed.force.y[2] == "vanishes"
    crossed = cp.Engine.from_lists(parts, tdc_deg=[0, 90, 90, 0], **layout)
    v = crossed.vanishing_orders([1, 2])
    assert v.force.y[2] == "remains"
    # Order 1 is the same for any rod.
    assert v.force.y[1] == "remains"
    # As heavy as order 2 then is of one size: whether it cancels, no values say.
    short, long = (one.harmonics([2])[0].real for one in (CYLINDER, longer))
    mass = CYLINDER.reciprocating_mass * short / long
    even = [CYLINDER, longer.replace(reciprocating_mass=mass)]
    balanced = cp.Engine.from_lists(even, tdc_deg=[0, 90], bank_deg=[90] * 2, z=[0, 0])
    v = balanced.vanishing_orders([2])
    assert v.force.y[2] == "undecided"
    assert "proportions" in v.obstacles[0]


def test_masses_that_are_no_ratio_of_each_other() -> None:
    mass = CYLINDER.reciprocating_mass
    for apart, verdict in ((1e-12 * math.sqrt(2), "undecided"), (math.sqrt(2), "remains")):
        parts = [CYLINDER, CYLINDER.replace(reciprocating_mass=mass * (1 + apart))]
        twin = cp.Engine.from_lists(parts, tdc_deg=[0, 180], bank_deg=[90, 90], z=[0, 0.1])
        v = twin.vanishing_orders([1, 3])
        assert v.force.y[1] == verdict
        assert any("masses" in text for text in v.obstacles) == (verdict == "undecided")
    assert v.force.y[3] == "vanishes"  # no rod has a third order without an offset


fractions = st.builds(Fraction, st.integers(0, 23), st.sampled_from([1, 2, 3, 5, 7, 12, 24]))


@st.composite
def rational_engines(draw: st.DrawFn) -> cp.Engine:
    """Sets of evenly spaced cylinders, so that something vanishes, with some that are not."""
    tdc: list[Fraction] = []
    banks: list[Fraction] = []
    z: list[int] = []
    mass: list[int] = []
    for _ in range(draw(st.integers(1, 3))):
        count = draw(st.sampled_from([1, 1, 2, 3, 4, 5]))
        start, bank = draw(fractions), draw(fractions)
        step = draw(st.sampled_from([-1, 0, 1]))
        place = draw(st.integers(-3, 3))
        weight = draw(st.integers(1, 3))
        for k in range(count):
            tdc.append(360 * (start + Fraction(k, count)))
            banks.append(360 * bank)
            z.append(place + step * k)
            mass.append(weight)
    spacing = draw(st.sampled_from([0.1, 0.13, 0.0907]))
    turning = draw(st.sampled_from([0.0, 0.3]))
    return cp.Engine.from_lists(
        [CYLINDER.replace(reciprocating_mass=0.3 * m) for m in mass],
        tdc_deg=tdc,
        bank_deg=banks,
        z=[place * spacing for place in z],
        rotating_mass=[turning * m for m in mass],
    )


def part_of_turn(text: str) -> Fraction:
    """The angle that this text of degrees, a fraction or the nearest double to one, stands for."""
    return (Fraction(text) / 360).limit_denominator(1000)


def fifty_digits(engine: cp.Engine, order: int) -> dict[str, Any]:
    """The ten sums, each over aₙ, from the exact angles, to 50 digits."""
    mpmath.mp.dps = 50
    tdc_text, bank_text = engine._core.exact_angles
    places = [Fraction(z).limit_denominator(10**6) for z in engine.z]
    middle = (max(places) + min(places)) / 2
    sums = {"force": [mpmath.mpc(0)] * 2, "moment": [mpmath.mpc(0)] * 2}
    torque = gas = mpmath.mpc(0)
    for k, cylinder in enumerate(engine.cylinders):
        tdc, bank = (
            2 * mpmath.pi * mpmath.mpf(turns.numerator) / turns.denominator
            for turns in (part_of_turn(tdc_text[k]), part_of_turn(bank_text[k]))
        )
        weight = Fraction(cylinder.reciprocating_mass).limit_denominator(1000)
        turning = Fraction(engine.rotating_mass[k]).limit_denominator(1000)
        w = mpmath.mpf(weight.numerator) / weight.denominator
        phase = mpmath.expjpi(-order * tdc / mpmath.pi)
        has = 1 if order == 1 or order % 2 == 0 else 0
        x, y = (has * w * part * phase for part in (mpmath.cos(bank), mpmath.sin(bank)))
        if order == 1:
            pin = mpmath.mpf(turning.numerator) / turning.denominator
            pin *= mpmath.expjpi((bank - tdc) / mpmath.pi)
            x, y = x + pin, y - 1j * pin
        lever = places[k] - middle
        z = mpmath.mpf(lever.numerator) / lever.denominator
        sums["force"] = [sums["force"][0] + x, sums["force"][1] + y]
        sums["moment"] = [sums["moment"][0] - z * y, sums["moment"][1] + z * x]
        torque += w * phase
        gas += phase
    found = {"torque": torque, "gas_torque": gas}
    for name, (x, y) in sums.items():
        found[f"{name}_x"], found[f"{name}_y"] = x, y
        found[f"{name}_forward"], found[f"{name}_backward"] = x + 1j * y, x - 1j * y
    return found


@settings(max_examples=80, deadline=None)
@given(engine=rational_engines(), order=st.integers(1, 6))
def test_any_rational_layout_against_fifty_digits(engine: cp.Engine, order: int) -> None:
    v = engine.vanishing_orders(order)
    assert not v.undecided.any()
    sums = fifty_digits(engine, order)
    for column, quantity in enumerate(map(joined, v.sums)):
        # Whole multiples of 1/10^8 of roots of orders below 10^4: no sum but zero is below 1e-40.
        assert bool(v.vanishes[0, column]) == (abs(sums[quantity]) < 1e-40), quantity


@st.composite
def mixed_engines(draw: st.DrawFn) -> cp.Engine:
    """Rational layouts of two kinds of rods, with offsets to either side or none."""
    engine = draw(rational_engines())
    kinds = [
        (rod, offset)
        for rod in (0.158, 0.2)
        for offset in (0.0, 0.004, -0.004)
        if rod < 0.2 or offset == 0.0
    ]
    parts = []
    for cylinder in engine.cylinders:
        rod, offset = draw(st.sampled_from(kinds))
        parts.append(cylinder.replace(rod_length=rod, pin_offset=offset))
    return engine.replace(cylinder=parts)


@settings(max_examples=150, deadline=None)
@given(engine=mixed_engines())
def test_no_proof_about_unlike_cylinders_is_refuted(engine: cp.Engine) -> None:
    """Offsets of a tenth of the radius: what remains is far above what rounding leaves."""
    v = engine.vanishing_orders(range(1, 7))
    assert v.within_rounding[v.vanishes].all()
    assert not v.within_rounding[v.remains].any()


# --- closed forms -------------------------------------------------------------------------------


def in_units(form: cp.results.ClosedForm, what: str = "peak") -> Any:
    """A magnitude over F, or a·F."""
    return getattr(form, what) / (form.F if form.quantity == "force" else form.a * form.F)


def equal(found: Any, expected: Any) -> bool:
    return bool(sp.simplify(found - expected) == 0)


def test_the_couple_of_the_cross_plane_eight() -> None:
    v8 = cp.Engine.from_firing_order(
        CYLINDER, crossplane.FIRING_ORDER, bank_angle_deg=90, odd_bank="left", spacing=0.1
    )
    couple = v8.closed_form(1)
    assert couple.peak == sp.sqrt(10) * couple.a * couple.F
    assert couple.peak_xy == (couple.peak, couple.peak)
    assert couple.backward == 0
    assert couple.spacing == pytest.approx(0.1, rel=1e-15)
    # The page's phase counts from the other side: half a turn less π/4 + arctan 3.
    page = sp.pi / 4 + sp.atan(3)
    assert couple.forward_phase == sp.atan(2)
    assert abs((couple.forward_phase + page - sp.pi).evalf(40)) < 1e-39
    assert float(page) == pytest.approx(crossplane.COUPLE_PHASE, rel=1e-15)
    fourth = v8.closed_form(4, "force")
    assert fourth.peak == 4 * sp.sqrt(2) * fourth.F
    assert fourth.x == 0
    assert v8.closed_form(2).peak == 0
    assert v8.closed_form(3, "force").peak == 0


CLASSICAL: list[tuple[str, int, str, Any]] = [
    ("i3", 1, "moment", sp.sqrt(3)),
    ("i3", 2, "moment", sp.sqrt(3)),
    ("i3", 6, "force", sp.Integer(3)),
    ("i4", 2, "force", sp.Integer(4)),
    ("i4", 1, "moment", sp.Integer(0)),
    ("i6", 6, "force", sp.Integer(6)),
    ("v12-60", 1, "moment", sp.Integer(0)),
    ("v12-60", 2, "moment", sp.Integer(0)),
    ("v12-60", 4, "force", sp.Integer(0)),
    ("v8-crossplane", 1, "moment", sp.sqrt(10)),
    ("v8-crossplane", 4, "force", 4 * sp.sqrt(2)),
    ("v8-crossplane-ebook", 1, "moment", 2 * sp.sqrt(2)),
    ("v8-crossplane-ebook", 2, "moment", 2 * sp.sqrt(2)),
    ("i5", 1, "moment", sp.sqrt(sp.Rational(25, 2) - 11 * sp.sqrt(5) / 2)),
    ("i5", 2, "moment", sp.sqrt(sp.Rational(25, 2) + 11 * sp.sqrt(5) / 2)),
]


@pytest.mark.parametrize(("name", "order", "quantity", "expected"), CLASSICAL)
def test_classical_amplitudes(name: str, order: int, quantity: Any, expected: Any) -> None:
    engine = cp.Engine.preset(name)
    form = engine.replace(rotating_mass=0).closed_form(order, quantity)
    assert equal(in_units(form), expected)


def test_the_shared_pin_v6_of_the_ijesc_paper() -> None:
    """60°, throws 0-120-240: each bank √3, the left one 60° later.

    Half of |1 + e^{i(60° − n·60°)}| √3 turns forward: √3 and 3/2 in orders 1 and 2. Half of
    |1 + e^{i(60° + n·60°)}| √3 turns backward: √3/2 and nothing.
    """
    v6 = cp.Engine.vee(CYLINDER, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13)
    first, second = v6.closed_form(1), v6.closed_form(2)
    assert equal(in_units(first, "forward_magnitude"), sp.sqrt(3))
    assert equal(in_units(first, "backward_magnitude"), sp.sqrt(3) / 2)
    assert equal(in_units(first), 3 * sp.sqrt(3) / 2)
    assert equal(first.peak_xy[0] / (first.a * first.F), 3 * sp.sqrt(3) / 2)
    assert equal(first.peak_xy[1] / (first.a * first.F), sp.sqrt(3) / 2)
    assert equal(in_units(second, "forward_magnitude"), sp.Rational(3, 2))
    assert second.backward == 0
    assert first.spacing == pytest.approx(0.13, rel=1e-15)


@pytest.mark.parametrize("tdc", range(0, 360, 45))
def test_phases_in_every_quadrant(tdc: int) -> None:
    """With a cylinder at an odd place, so that nothing lies along an axis."""
    tdcs = [tdc, tdc + 10, tdc + 70]
    engine = cp.Engine.from_lists(CYLINDER, tdc_deg=tdcs, bank_deg=[90, 75, 60], z=[0, 0.1, 0.3])
    for order in (1, 2):
        form, b = engine.closed_form(order), engine.balance(RPM, orders=order)
        for phase, part in (
            (form.forward_phase, b.moment.forward[0]),
            (form.backward_phase, b.moment.backward[0]),
        ):
            assert float(phase) == pytest.approx(math.atan2(part.imag, part.real), rel=1e-12)


def test_an_order_that_no_rod_has_is_zero() -> None:
    """Although the sum over the layout is not."""
    third = cp.Engine.preset("single").closed_form(3, "force")
    assert third.peak == third.y == third.y_sum == 0
    assert third.y_terms == ()
    assert third.forward_phase == 0


def test_sevenths_stay_cosines() -> None:
    throws = [f"{360 * k}/7" for k in (0, 3, 5, 1, 4, 6, 2)]
    i7 = cp.Engine.inline(CYLINDER, throws_deg=throws, spacing=0.1)
    form = i7.closed_form(1)
    assert form.peak.has(sp.cos)
    unit = 0.5 * 0.045 * (2 * math.pi * RPM / 60) ** 2 * 0.1
    expected = float(i7.balance(RPM, orders=1).moment.peak[0]) / unit
    assert float(in_units(form)) == pytest.approx(expected, rel=ROUNDING)


@in_turn("name", [name for name in NAMES if name not in IRRATIONAL])
def test_closed_forms_are_the_numbers(name: str) -> None:
    engine = cp.Engine.preset(name)
    omega = 2 * math.pi * RPM / 60
    for order in (1, 2, 4):
        b = engine.balance(RPM, orders=order)[order]
        unit = engine.cylinders[0]
        scale = unit.reciprocating_mass * unit.crank_radius * omega**2 * len(engine)
        scale *= abs(complex(unit.harmonics(order)[0]))
        for quantity in ("force", "moment"):
            form = engine.closed_form(order, quantity)
            values = form.evaluate(RPM)
            xy, size = getattr(b, quantity).xy, scale
            if quantity == "moment":
                size *= max(np.ptp(engine.z), 1e-30)
            for axis, expected in (
                ("x", xy[0]),
                ("y", xy[1]),
                ("forward", getattr(b, quantity).forward),
                ("backward", getattr(b, quantity).backward),
            ):
                assert abs(values[axis] - expected) <= ROUNDING * size, (order, quantity, axis)
            f, back = abs(values["forward"]), abs(values["backward"])
            numbers = {form.F: abs(scale) / len(engine), form.a: form.spacing}
            assert float(form.peak.subs(numbers)) == pytest.approx(f + back, rel=1e-12)


@pytest.mark.parametrize("name", ["v6-60", "v8-crossplane", "i5", "boxer-4"])
@pytest.mark.parametrize("quantity", ["force", "moment"])
def test_the_terms_add_up_to_the_sum(name: str, quantity: Any) -> None:
    engine = cp.Engine.preset(name).replace(rotating_mass=0.3)
    for order in (1, 2):
        form = engine.closed_form(order, quantity)
        loads = 2 if order == 1 else 1  # pistons, and what rotates
        assert len(form.x_terms) == len(form.y_terms) == loads * len(engine)
        for terms, total in ((form.x_terms, form.x_sum), (form.y_terms, form.y_sum)):
            for theta in (0.3, 2.0):
                numbers = {form.theta: theta, form.F: 1.0, form.a: 1.0}
                found = sum(complex(term.subs(numbers)) for term in terms)
                assert abs(found - complex(total.subs(numbers))) < ROUNDING


def test_an_offset_has_a_closed_form_of_its_own_unit() -> None:
    i3 = cp.Engine.inline(CYLINDER.replace(pin_offset=0.004), throws_deg=[0, 120, 240], spacing=0.1)
    for order in (1, 2, 3):
        values, b = i3.closed_form(order).evaluate(RPM), i3.balance(RPM, orders=order)[order]
        size = abs(b.moment).max() + 1e-12
        for axis, expected in (("x", b.moment.xy[0]), ("backward", b.moment.backward)):
            assert abs(values[axis] - expected) <= ROUNDING * size


def test_latex_shows_the_sum_and_what_it_comes_to() -> None:
    latex = cp.Engine.preset("v8-crossplane").closed_form(1)._repr_latex_()
    assert latex.startswith("$\\displaystyle \\begin{aligned} M_x &=")
    assert "\\max |M| &= \\sqrt{10} F a \\\\" in latex
    assert latex.endswith(" of cylinder 1, a = 100 mm} \\end{aligned}$")
    assert latex.count("\\cos{\\left(\\theta - \\frac{3 \\pi}{2} \\right)}") == 4
    zero = cp.Engine.preset("i4").closed_form(3)._repr_latex_()
    assert "M_x &= 0" in zero


def refusals() -> Sequence[tuple[dict[str, Any], str]]:
    return [
        ({"bank_deg": [90, 49.541234567]}, "bank_deg = 49.541234567"),
        ({"tdc_deg": [0, 51.4123]}, "tdc_deg = 51.4123: a closed form needs parts of a turn"),
        ({"cylinder": [CYLINDER, CYLINDER.replace(rod_length=0.2)]}, "proportions"),
        ({"cylinder": [CYLINDER, CYLINDER.replace(reciprocating_mass=math.pi)]}, "m·r"),
        ({"cylinder": CYLINDER.replace(reciprocating_mass=0.0)}, "reciprocating_mass"),
        ({"z": [0, 0.1, math.pi], "tdc_deg": [0] * 3, "bank_deg": [90] * 3}, "z ="),
        ({"cylinder": CYLINDER.replace(pin_offset=1e-3), "rotating_mass": 0.1}, "pin_offset"),
    ]


def test_a_closed_form_says_what_its_symbols_are() -> None:
    couple = cp.Engine.preset("v8-crossplane").closed_form(1)
    cylinder = couple.engine.cylinders[0]
    scale = cylinder.reciprocating_mass * cylinder.crank_radius
    assert f"F = m·r·a₁·ω² = {scale:.6g} kg·m·ω² of cylinder 1" in repr(couple)
    assert repr(couple).endswith(f", a = {1000 * couple.spacing:.6g} mm")
    assert ", a" not in repr(couple.engine.closed_form(4, "force"))


@pytest.mark.parametrize(("changes", "words"), refusals())
def test_what_has_no_closed_form_is_refused_with_the_reason(
    changes: dict[str, Any], words: str
) -> None:
    lists: dict[str, Any] = {"cylinder": CYLINDER, "tdc_deg": [0, 90], "bank_deg": [90, 90]}
    engine = cp.Engine.from_lists(**lists | {"z": [0, 0.1]} | changes)
    with pytest.raises(cp.InputError, match=words):
        engine.closed_form(1)


def test_sympy_is_imported_when_it_is_used() -> None:
    script = (
        "import sys\nsys.modules['sympy'] = None\nimport crankpin as cp\n"
        "i3 = cp.Engine.preset('i3')\ni3.vanishing_orders()\n"
        "try:\n    i3.closed_form(1)\nexcept ImportError as error:\n    print(error)"
    )
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603 - its own
    assert 'pip install "crankpin[exact]"' in done.stdout


@pytest.mark.parametrize(
    ("pin_offset", "order", "words", "named"),
    [
        (0.0, 2, "0.00583559 kg·m·ω² of cylinder 1", 0.00583559),
        (0.0, 4, "-0.000124211 kg·m·ω² of cylinder 1 (in lengths its size)", -0.000124211),
        (
            0.002,
            1,
            "(0.02 - 0.000294969i) kg·m·ω² of cylinder 1 (in lengths its size)",
            0.02 - 0.000294969j,
        ),
    ],
)
def test_the_force_that_a_closed_form_names_has_its_sign(
    pin_offset: float, order: int, words: str, named: complex
) -> None:
    """The phasors with the figure in place of F are those of the balance."""
    cylinder = cp.Cylinder(0.04, 0.14, 0.5, pin_offset)
    engine = cp.Engine.inline(cylinder, throws_deg=[0, 90, 90], spacing=0.1)
    form = engine.closed_form(order, "force")
    assert form.units_text.endswith(words)
    there = engine.balance(60 / (2 * np.pi))[order].force
    # Six digits are printed.
    for part, F in (("y", named), ("forward", named), ("backward", named.conjugate())):
        found = complex(getattr(form, part).subs(form.F, F))
        assert found == pytest.approx(complex(getattr(there, part)), rel=1e-5)
    direction = float(form.forward_phase) + np.angle(named)
    assert np.exp(1j * direction) == pytest.approx(there.forward / abs(there.forward), rel=1e-5)
