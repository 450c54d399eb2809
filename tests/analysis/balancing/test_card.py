"""Is the card of a balancing shop what is worked out by hand?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from rederivation import link_rods
from support import in_turn

if TYPE_CHECKING:
    from pathlib import Path

    from support.chromium import Open

PARTS = {
    "piston": 0.470, "pin": 0.118, "locks": 0.002, "rings": 0.060, "small end": 0.180,
    "big end": 0.430, "bearings": 0.042,
}  # fmt: skip
OIL = 0.004


def card_of_a_v8() -> cp.results.Card:
    """A cross-plane V8 whose crankshaft was balanced to 1850 g."""
    bob = cp.bob_weight(cp.Engine.preset("v8-crossplane"), 0.5, OIL, parts=PARTS)
    return bob.card(
        [0.48, 0.5, 0.52],
        rpm=6000,
        planes={"front": -0.02, "rear": 0.32},
        radius=0.07,
        balanced_to=1.85,
    )


def test_bob_weights_by_hand() -> None:
    """2 (470 + 118 + 2 + 60 + 180) = 1660 g and 2 (430 + 42) + 4 = 948 g; 948 + κ 1660."""
    card = card_of_a_v8()
    frame = card.frames["bob weights"]
    for share, grams in (("48", 1744.8), ("50", 1778.0), ("52", 1811.2)):
        np.testing.assert_allclose(frame[f"at {share} %"].values, [grams] * 4, rtol=1e-12)
    assert card.table["part"].values[:7] == (*PARTS,)
    assert card.table["each cylinder"].cells()[-2:] == ["830.0", "472.0"]
    assert set(card.table["share"].values) == {"48, 50, 52 %", "100 %"}


@in_turn("seed", range(10))
def test_factors_that_are_rounding_apart_are_one(seed: int) -> None:
    """In the card as in the bob weights' own table, whose remarks stand at one factor."""
    rng = np.random.default_rng(seed)
    angle = float(rng.choice([60.0, 90.0, 120.0, 180.0, *rng.uniform(20.0, 170.0, 4)]))
    twin = cp.Engine.vee(
        cp.Cylinder(0.04, 0.14, 0.5), bank_angle_deg=angle, throws_deg=[0.0], spacing=0.1
    )
    bob = cp.bob_weight(twin)
    own = [
        0.5,
        *(factor + rng.uniform(0.0, 1e-13) for factor, _ in bob.straight_line_factors("force")),
    ]
    for frame, name in ((bob.card(own).frames["residual"], "factor"), (bob.frames["factors"], "")):
        listed = np.array([float(each) for each in frame.columns[0].values])
        scale = 100.0 if name else 1.0
        assert (np.diff(listed) > 1e-9 * scale).all()
        for factor, _ in bob.straight_line_factors("force"):
            at = int(abs(listed - scale * factor).argmin())
            words = frame.columns[1].values[at]
            assert words.count("straight line of the force") + words.count("force along") == 1


def test_the_couple_that_two_per_cent_leaves_by_hand() -> None:
    """Four per cent of √10 a m r ω², the couple of throws at 0°, 90°, 270°, 180°."""
    card = card_of_a_v8()
    v8 = card.bob.engine
    omega = 2.0 * np.pi * 6000 / 60.0
    whole = np.sqrt(10.0) * 0.1 * 0.83 * v8.cylinders[0].crank_radius * omega**2
    residual = card.frames["residual"]
    found = dict(zip(residual["factor"].values, residual["moment, longest"].values, strict=True))
    # Rounding of a sum of eight cylinders.
    np.testing.assert_allclose([found[48.0], found[52.0]], 0.04 * whole, rtol=1e-10)
    assert found[50.0] == 0.0
    assert "force, longest" not in residual


def test_the_correction_by_hand() -> None:
    """1850 − 1778 = 72 g at each pin is taken off counterweights: √10 a 72 g r at 340 mm."""
    card = card_of_a_v8()
    radius = card.bob.engine.cylinders[0].crank_radius
    table = card.frames["correction"]
    at_50 = [k for k, share in enumerate(table["factor"].values) if share == "50 %"]
    amount = np.sqrt(10.0) * 100.0 * 72.0 * (1e3 * radius) / 340.0
    for k, angle in zip(at_50, (153.435, 333.435), strict=True):
        assert table["unbalance"].values[k] == pytest.approx(amount, rel=1e-9)
        assert table["weight"].values[k] == pytest.approx(amount / 70.0, rel=1e-9)
        # In steel of 7.85 g/cm³, of 17 g/cm³.
        assert table["as heavy metal"].values[k] == pytest.approx(amount / 70.0 / (1 - 7.85 / 17.0))
        assert table["add at"].values[k] == pytest.approx(angle, abs=1e-3)
        assert table["or drill at"].values[k] == pytest.approx((angle + 180.0) % 360.0, abs=1e-3)


def test_the_correction_is_what_the_bob_weight_lacks() -> None:
    """A crankshaft that is balanced to its bob weight takes nothing; without weights, all of it."""
    bob = cp.bob_weight(cp.Engine.preset("single"), 0.5, OIL, parts=PARTS)
    done = bob.card(planes=[0.0], balanced_to=bob.mass).frames["correction"]
    assert len(done) == 0 or max(done["unbalance"].values) < 1e-9
    (whole,) = bob.card(planes=[0.0]).frames["correction"]["unbalance"].values
    assert whole == pytest.approx(1e6 * bob.mass[0] * bob.engine.cylinders[0].crank_radius)


@pytest.mark.parametrize(
    ("bank_angle", "factor", "words"),
    [
        (45, (1 - np.cos(np.pi / 4)) / 2, "up and down"),  # the two straight lines of a V-twin
        (45, (1 + np.cos(np.pi / 4)) / 2, "sideways"),
        (45, 0.4, "up and down"),
        (45, 0.5, "all round, against the crank"),
        (90, 0.6, "all round, against the crank"),
    ],
)
def test_directions_in_words(bank_angle: int, factor: float, words: str) -> None:
    parts = cp.Cylinder(0.048, 0.19, 0.5)
    twin = cp.Engine.vee(parts, bank_angle_deg=bank_angle, throws_deg=[0], spacing=0.1)
    residual = cp.bob_weight(twin).card([factor]).frames["residual"]
    (row,) = [k for k, each in enumerate(residual["factor"].values) if each == 100.0 * factor]
    found = residual["direction of the longest"].values[row]
    assert found == (words if bank_angle == 45 else words.replace("against", "with"))


def test_a_leaning_single_leans_towards_a_side() -> None:
    """A cylinder 30° to the right of upright shakes along itself without counterweights."""
    parts = cp.Cylinder(0.04, 0.14, 0.4)
    for bank, words in ((60, "30° towards the exhaust side"), (120, "30° towards the intake side")):
        single = cp.Engine.from_lists(parts, bank_deg=[bank], tdc_deg=[0], z=[0.0])
        card = cp.bob_weight(single).card([0.0], sides=("exhaust", "intake"), rpm=6000)
        residual = card.frames["residual"]
        assert residual["direction of the longest"].values[0] == words
        pull = 0.4 * 0.04 * (2.0 * np.pi * 100.0) ** 2
        assert residual["force, longest"].values[0] == pytest.approx(pull, rel=1e-12)
        assert residual["shortest"].values[0] == 0.0


def test_the_ends_of_a_twin_at_180_move_up_and_down() -> None:
    parts = cp.Cylinder(0.04, 0.14, 0.4)
    twin = cp.Engine.inline(parts, throws_deg=[0, 180], spacing=0.1)
    residual = cp.bob_weight(twin).card([0.0, 1.0]).frames["residual"]
    assert residual["ends move"].values == ("up and down", "sideways")


def test_random_cards_are_balances_of_the_fitted_engine() -> None:
    """What a factor leaves is the balance of the engine with its bob weights, at any speed."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        count = int(rng.integers(1, 6))
        engine = cp.Engine.from_lists(
            [cp.Cylinder(0.04, 0.14, mass) for mass in rng.uniform(0.2, 0.8, count)],
            tdc_deg=rng.uniform(0, 360, count).round(3).tolist(),
            bank_deg=rng.uniform(0, 180, count).round(3).tolist(),
            z=np.sort(rng.uniform(0, 0.5, count)),
            rotating_mass=0.3,
        )
        factor, rpm = float(rng.uniform(0.1, 0.9)), float(rng.uniform(1000, 9000))
        residual = cp.bob_weight(engine).card([factor], rpm=rpm).frames["residual"]
        row = residual["factor"].values.index(100.0 * factor)
        left = cp.bob_weight(engine, factor).fitted.balance(rpm, orders=[1])[1]
        scale = left.force.peak
        assert residual["force, longest"].values[row] == pytest.approx(scale, rel=1e-9)
        assert residual["shortest"].values[row] == pytest.approx(
            abs(left.force.minor), abs=1e-9 * scale
        )


def test_parts_that_differ_have_a_column_for_each_cylinder() -> None:
    masses = [0.47, 0.471, 0.469, 0.47]
    bob = cp.bob_weight(cp.Engine.preset("i4"), parts={"piston": masses, "small_end": 0.18})
    table = bob.card().table
    assert [table[f"cylinder {k + 1}"].values[0] for k in range(4)] == pytest.approx(
        [470.0, 471.0, 469.0, 470.0], rel=1e-12
    )
    assert [each.reciprocating_mass for each in bob.engine.cylinders] == [
        0.65, 0.651, 0.649, 0.65,
    ]  # fmt: skip


def test_the_page_has_every_number_and_prints(tmp_path: Path) -> None:
    card, file = card_of_a_v8(), tmp_path / "card.html"
    card.save_html(file)
    text = file.read_text(encoding="utf-8")
    for frame in card.frames.values():
        for row in frame.cells():
            for cell in row:
                assert f"<td>{cell}</td>" in text
    assert "@media print" in text
    assert not re.search(r"(src|href)=", text)  # it loads nothing


@pytest.mark.parametrize("name", ["v8-crossplane", "v12-60", "v16-45"])
def test_parts_of_every_cylinder_fit_on_a_sheet(name: str, open_file: Open, tmp_path: Path) -> None:
    engine, file = cp.Engine.preset(name), tmp_path / "card.html"
    pistons = [0.480 + 0.001 * k for k in range(len(engine))]
    bob = cp.bob_weight(engine, parts=PARTS | {"piston": pistons})
    bob.card([0.48, 0.5, 0.52], rpm=7000).save_html(file)
    paper = {"width": 703, "height": 1000}  # A4 less margins of 12 mm
    page = open_file(file, viewport=paper)
    page.emulate_media(media="print")
    assert page.evaluate("document.documentElement.scrollWidth") <= paper["width"]
    modes = "all => all.map((each) => getComputedStyle(each).writingMode)"
    assert set(page.eval_on_selector_all("th", modes)) == {"horizontal-tb"}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"factors": 52}, "factor"),
        ({"sides": ("right",)}, "sides"),
        ({"radius": 0.07}, "radius"),
        ({"planes": "ends", "radius": 0.0}, "radius"),
        ({"planes": "ends", "balanced_to": [1.0, 2.0]}, "balanced_to"),
        ({"rpm": -1}, "rpm"),
    ],
)
def test_arguments_that_are_wrong(options: dict[str, object], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        cp.bob_weight(cp.Engine.preset("i4")).card(**options)  # type: ignore[arg-type]


@pytest.mark.parametrize("parts", [{"crown": 0.4}, {"piston": -0.1}, {"piston": [0.4, 0.5]}, 0.5])
def test_parts_that_are_wrong(parts: object) -> None:
    with pytest.raises(cp.InputError, match="parts"):
        cp.bob_weight(cp.Engine.preset("i4"), parts=parts)  # type: ignore[arg-type]
    with pytest.raises(cp.InputError, match=r"52 % is 0\.52"):
        cp.bob_weight(cp.Engine.preset("i4"), factor=52)


def rodded_twin() -> cp.Engine:
    """A V-twin whose pistons weigh 482 g and whose rods 640 g, 189 g of them at the small end."""
    rod = cp.Rod(0.64, 0.003, 0.15, 0.15 * 0.189 / 0.64)
    cylinder = cp.Cylinder.from_rod(rod, 0.045, 0.482)
    return cp.Engine.vee(cylinder, bank_angle_deg=60, throws_deg=[0], spacing=0.1)


def test_ends_of_rods_that_are_not_weighed_are_those_of_the_engine() -> None:
    """480 + 100 g of pistons and 189 g of the rod each, of which half, and 451 g of the big end."""
    bob = cp.bob_weight(rodded_twin(), parts={"piston": 0.48, "pin": 0.1})
    assert bob.grams == pytest.approx([2 * (0.5 * (480.0 + 100.0 + 189.0) + 451.0)])
    assert bob.of_rods == ("small end",)
    for frame in (bob.table, bob.card().table, bob.card().frames["bob weights"]):
        assert "Not weighed, but of the engine's rods: small end." in frame.note
        assert "Not weighed, and not counted: locks, rings." in frame.note
    everything = cp.bob_weight(rodded_twin(), parts=PARTS)
    assert everything.grams == pytest.approx([2 * (0.5 * 830.0 + 472.0)])
    assert not everything.table.note
    assert cp.bob_weight(rodded_twin()).parts == {}


def test_a_card_says_what_was_not_weighed() -> None:
    engine = rodded_twin().replace(cylinder=cp.Cylinder(0.045, 0.15, 0.671))
    note = cp.bob_weight(engine, parts={"piston": 0.48, "pin": 0.1}).card().table.note
    assert "Not weighed, and not counted: locks, rings, small end." in note


@pytest.mark.parametrize("name", ["v8-crossplane", "single"])
def test_bob_weights_without_rotating_masses_are_not_given_as_known(name: str) -> None:
    bob = cp.bob_weight(cp.Engine.preset(name))
    for frame in (bob.table, bob.card().frames["bob weights"]):
        assert "Rotating masses are not known: bob weights lack the big ends" in frame.note
    known = cp.bob_weight(cp.Engine.preset(name, rotating_mass=0.4))
    assert not known.table.note


def test_big_ends_at_knuckles_of_a_star_by_hand() -> None:
    """Four of 0.4 kg: k adds up to −52/230 of each; half of it leaves N − 1 + a/2l, as printed."""
    rods = cp.LinkRods(radius=0.052, length=0.178, big_end_mass=0.4)
    star = cp.Engine.radial(
        cp.Cylinder(0.06, 0.23, 1.0), 5, rods=rods, rotating_mass=[1.1, 0, 0, 0, 0]
    )
    bob = cp.bob_weight(star)
    moving = 0.4 * 52 / 230
    assert bob.rotating == pytest.approx([1.1 + 4 * 0.4 + moving], rel=1e-14)
    assert bob.reciprocating == pytest.approx([5.0 - moving], rel=1e-14)
    # 4.1130435: order 1 forward of unit masses at the knuckles.
    assert bob.mass == pytest.approx([1.1 + 2.5 + 0.4 * 4.1130435], abs=1e-8)
    assert not bob.across.any()
    assert "across" not in bob.table.to_csv()
    known = "Bob weights of all rotating and half the reciprocating mass remove what turns"
    assert known in str(star.replace(rotating_mass=0).explain(3000))


def test_big_ends_on_one_side_act_across_the_crankpin() -> None:
    """A link at 60° whose k is ¼·e^{i60°}: 0.4 kg less (1 − κ)·0.1 kg at 60°."""
    rods = cp.LinkRods(radius=0.05, length=0.15, angles_deg=[60.0], big_end_mass=0.4)
    twin = cp.Engine.vee(
        cp.Cylinder(0.05, 0.2, 1.0), bank_angle_deg=60, throws_deg=[0], spacing=0.1, rods=rods
    )
    bob = cp.bob_weight(twin, 0.3)
    assert bob.mass == pytest.approx([0.4 - 0.7 * 0.1 * 0.5 + 0.3 * 2.0], rel=1e-14)
    assert bob.across == pytest.approx([-0.7 * 0.1 * 3**0.5 / 2], rel=1e-14)
    card = bob.card([0.3, 1.0]).frames["bob weights"]
    assert card.table["across"].values == pytest.approx(1e3 * bob.across, rel=1e-12)
    assert "no weight clamped to the crankpin has it" in bob.table.note
    # The whole of what moves with the piston needs nothing across.
    assert not cp.bob_weight(twin, 1.0).across.any()


@in_turn("seed", range(40))
def test_bob_weights_leave_what_their_factor_says_of_moving_parts(seed: int) -> None:
    """1 − 2κ of what turns with the crank, big ends at knuckles too, in either sense."""
    rng = np.random.default_rng(seed)
    bores = rng.choice([0.0, 60.0, 90.0, 150.0, 180.0, 300.0], 3, replace=False)
    masses, radii, ends = (rng.choice(of, 3) for of in ([0.5, 1.0], [0.03, 0.05], [0.0, 0.4]))
    angles = (bores - bores[0]) % 360.0
    sense = int(rng.choice([1, -1]))
    engine = cp.Engine.from_lists(
        [cp.Cylinder(0.05, 0.2, float(mass)) for mass in masses],
        tdc_deg=bores * sense,
        bank_deg=bores,
        z=[0.0] * 3,
        rotating_mass=[0.7, 0.0, 0.0],
        cranks=[(0.3, 0.0, -1)],
        crank=[0 if sense > 0 else 1] * 3,
    ).with_link_rods(
        [None, *(cp.LinkRod(1, float(radii[k]), float(angles[k]), float(ends[k])) for k in (1, 2))]
    )
    hung = [link_rods.Hung(float(bores[0]), 0.2, masses[0])]
    hung += [
        link_rods.Hung(float(bores[k]), 0.2, masses[k], 0, radii[k], angles[k], ends[k])
        for k in (1, 2)
    ]
    direction = np.exp(2j * np.pi * sense * np.arange(256) / 256)
    moving = link_rods.cylinder_forces(hung, [0.05 * direction] * 3, 256).sum(axis=0) @ [1.0, 1j]

    def turning(factor: float) -> complex:
        """The part of order 1 that turns with the crank, over ω²."""
        bob = cp.bob_weight(engine, factor)
        weights = sum(
            weight.amount * np.exp(1j * sense * np.radians(weight.angle_deg))
            for weight in bob.hardware
        )
        # What the table has is what the crankshaft gets.
        clamped = -0.05 * (bob.mass[0] + 1j * sense * bob.across[0])
        assert complex(weights) == pytest.approx(clamped, abs=1e-14)
        turned = 0.7 * 0.05 + weights
        left = complex(np.fft.fft(moving + turned * direction)[sense] / 256)
        residual = bob.residual[1].force
        found = residual.forward if sense > 0 else residual.backward
        assert complex(found) == pytest.approx(left, abs=1e-14)  # of sums of 0.1
        return left

    assert abs(turning(0.0)) > 0.01
    for factor in (0.5, 0.6, 1.5):
        assert turning(factor) == pytest.approx((1.0 - 2.0 * factor) * turning(0.0), abs=1e-14)


@in_turn("seed", range(20))
def test_a_crankshaft_at_its_bob_weights_takes_nothing(seed: int) -> None:
    """Also where rods beside each other share a pin and its oil, which is midway between them."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 4))
    engine = cp.Engine.vee(
        cp.Cylinder(0.04, 0.14, 0.5),
        bank_angle_deg=float(rng.choice([45.0, 60.0, 90.0])),
        throws_deg=(90.0 * rng.integers(0, 4, count)).tolist(),
        spacing=0.1,
        bank_stagger=float(rng.choice([0.0, 0.021])),
        rotating_mass=0.4,
    )
    bob = cp.bob_weight(engine, float(rng.choice([0.0, 0.5, 0.52])), OIL)
    card = bob.card(planes=[-0.05, 0.3], balanced_to=bob.mass)
    amounts = card.frames["correction"]["unbalance"].values if card.frames["correction"] else ()
    assert max(amounts, default=0.0) < 1e-6  # g·mm, of oil of 160 g·mm
