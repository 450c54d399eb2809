"""Is what is proved true, of engines drawn from so few values that sums vanish now and then?

Sixty digits of a computation that shares nothing with the library decide.
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import crankpin as cp
import numpy as np
import pytest
from rederivation.exact_sums import Piston, Place, Sums, Weight

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

T = TypeVar("T")

ORDERS = range(1, 7)
PISTONS = [
    Piston(
        Fraction(radius),
        Fraction(rod),
        Fraction(mass),
        Fraction(offset) * Fraction(radius),
        Fraction(inertia),
    )
    for radius, rod, mass in [
        (".04", ".12", ".5"),  # λ 1/3, and m·r of the next
        (".05", ".15", ".4"),
        (".04", ".16", ".5"),  # λ 1/4
        (".05", ".2", ".5"),
        (".04", ".13", ".5"),
    ]
    for offset in ("0", "0", ".2", "-.2")
    for inertia in ("0", "0", ".0003")
]
ANGLES = [Fraction(turns, 12) for turns in range(12)] + [
    Fraction(1, 5),
    Fraction(17123456789, 360 * 10**9),
]
BANKS = [
    Fraction(1, 4),
    Fraction(1, 4),
    Fraction(1, 6),
    Fraction(1, 3),
    Fraction(0),
    Fraction(3, 4),
]
PLACES = [Fraction(0), Fraction("0.1"), Fraction("0.2"), Fraction("0.3")]
AXES = [
    (Fraction(0), Fraction(0)),
    (Fraction("0.2"), Fraction(0)),
    (Fraction(0), Fraction("0.1")),
    (Fraction("-0.2"), Fraction(0)),
]
RATIOS = (1, -1, 2, -2, 3, -3)


class Draft(NamedTuple):
    """What an engine is made of, for the library and for sixty digits."""

    places: list[Place]
    cranks: list[tuple[Fraction, Fraction, int]]
    crank_of: list[int]
    counterweights: list[Weight]
    shafts: list[Weight]

    @property
    def middle(self) -> Fraction:
        """Plane midway between the first and the last cylinder."""
        z = [place.z for place in self.places]
        return (min(z) + max(z)) / 2

    def engine(self) -> cp.Engine:
        """Return the engine, fired where places have a cycle."""
        fired = any(place.cycle is not None for place in self.places)
        cylinders = [
            cp.Cylinder(
                float(piston.radius),
                float(piston.rod),
                float(piston.mass),
                float(piston.offset),
                rod_inertia_excess=float(piston.rod_inertia),
                bore=0.08 if fired else None,
            )
            for piston in (place.piston for place in self.places)
        ]
        shafts = [
            cp.Shaft(each.ratio, [unbalance(each)], x=float(each.axis[0]), y=float(each.axis[1]))
            for each in self.shafts
        ]
        engine = cp.Engine.from_lists(
            cylinders,
            tdc_deg=[degrees(place.tdc) for place in self.places],
            bank_deg=[degrees(place.bank) for place in self.places],
            z=[float(place.z) for place in self.places],
            rotating_mass=[float(place.turning) for place in self.places],
            cranks=[(float(x), float(y), ratio) for x, y, ratio in self.cranks],
            crank=self.crank_of,
            counterweights=list(map(unbalance, self.counterweights)),
            shafts=shafts,
        )
        if not fired:
            return engine
        engine = engine.replace(firing_order=engine.firing_orders()[0].firing_order)
        cycles = [cp.Cycle.example(each) for each in ("petrol", "diesel")]
        acting = [None if place.cycle is None else cycles[place.cycle] for place in self.places]
        return engine.with_cycle(acting)

    def sums(self, engine: cp.Engine, halves: int) -> Sums:
        """Return the sums of an order, in halves; unfired engines have one pressure in all."""
        places = self.places
        if engine.fired:
            turns = (
                engine.firing().angles_deg - np.array([float(p.tdc) for p in places]) * 360.0
            ) / 360.0
            later = (np.round(turns) % 2 == 1).tolist()
            places = [p._replace(later=late) for p, late in zip(places, later, strict=True)]
        else:
            # Whichever turns the cycles begin at.
            places = [place._replace(cycle=0, later=k % 2 == 1) for k, place in enumerate(places)]
        return Sums(places, [*self.counterweights, *self.shafts], halves, self.middle)


def degrees(turns: Fraction) -> str:
    """An angle as text, in which it is exact."""
    return str(360 * turns)


def unbalance(weight: Weight) -> cp.Unbalance:
    return cp.Unbalance(float(weight.amount), float(weight.z), degrees(weight.direction))


def bob_weight(place: Place) -> Weight:
    """What balances the mass that turns with a crankpin, and half of the piston's."""
    amount = (place.turning + place.piston.mass / 2) * place.piston.radius
    return Weight(amount, (place.bank - place.tdc + Fraction(1, 2)) % 1, place.z)


class Drawing:
    """Random choices among few values."""

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)

    def one(self, values: Sequence[T]) -> T:
        return values[int(self._random.integers(len(values)))]

    def chance(self, share: float) -> bool:
        return bool(self._random.random() < share)

    def alike(self, first: Place, pistons: Sequence[Piston], *, fired: bool) -> Place:
        """A cylinder that differs from another one in few things."""
        like = first
        if self.chance(0.6):
            step = self.one([Fraction(1, 2), Fraction(1, 3), Fraction(2, 3), Fraction(1, 4)])
            like = like._replace(tdc=(like.tdc + step) % 1)
        if self.chance(0.3):
            like = like._replace(bank=(like.bank + Fraction(1, 2)) % 1)
        if self.chance(0.3):
            like = like._replace(z=self.one(PLACES))
        if self.chance(0.3):
            like = like._replace(piston=like.piston._replace(offset=-like.piston.offset))
        if self.chance(0.2):
            like = like._replace(piston=self.one(pistons))
        if fired and self.chance(0.2):
            like = like._replace(cycle=None)
        return like

    def weight(self, ratio: int, axis: tuple[Fraction, Fraction]) -> Weight:
        amount = self.one([Fraction("0.01"), Fraction("0.02"), Fraction("0.005")])
        return Weight(amount, self.one(ANGLES), self.one(PLACES), ratio, axis)

    def draft(self, *, fired: bool) -> Draft:
        """One to three cylinders, and of each up to two more that differ in few things."""
        speeds = RATIOS[:2] if fired else RATIOS
        others = self.one([0, 1, 2])
        cranks = [(*self.one(AXES), self.one(speeds)) for _ in range(others)]
        pistons = [self.one(PISTONS) for _ in range(2)]
        places: list[Place] = []
        crank_of: list[int] = []
        for _ in range(self.one([1, 2, 3])):
            first = Place(self.one(pistons), self.one(ANGLES), self.one(BANKS), self.one(PLACES))
            if self.chance(0.2):
                first = first._replace(turning=Fraction("0.25"))
            if fired:
                first = first._replace(cycle=int(self.chance(0.2)))
            crank = self.one(range(others + 1))
            places.append(first)
            crank_of.append(crank)
            for _ in range(self.one([0, 1, 2])):
                places.append(self.alike(first, pistons, fired=fired))
                crank_of.append(self.one(range(others + 1)) if self.chance(0.5) else crank)
        everywhere = [(Fraction(0), Fraction(0), 1), *cranks]
        for k, crank in enumerate(crank_of):
            x, y, ratio = everywhere[crank]
            places[k] = places[k]._replace(ratio=ratio, axis=(x, y))
        weights = [self.weight(1, AXES[0]) for _ in range(2)] if self.chance(0.2) else []
        if not cranks and self.chance(0.3):
            weights = list(map(bob_weight, places))
        shafts = []
        if self.chance(0.2):
            shafts = [self.weight(self.one(RATIOS), self.one(AXES)) for _ in range(2)]
        return Draft(places, cranks, crank_of, weights, shafts)


def verdicts(draft: Draft) -> Iterator[tuple[tuple[float, str, str], str, bool]]:
    """Yield what is proved of each sum of an engine, and whether it is zero."""
    engine = draft.engine()
    orders = sorted({n / 2 for n in range(1, 13)} if engine.fired else ORDERS)
    found = engine.vanishing_orders(orders)
    for k, order in enumerate(orders):
        sums = draft.sums(engine, round(2 * order))
        for column, named in enumerate(found.sums):
            if order % 1 and named[0] != "gas_torque":
                continue
            yield (order, *named), found._word(k, column), sums.is_zero(*named)


def wrong(draft: Draft, counts: Counter[tuple[str, bool]]) -> list[tuple[float, str, str]]:
    """Return the sums of which the contrary of what is proved is true, and count all."""
    faults = []
    for named, word, zero in verdicts(draft):
        counts[word, zero] += 1
        if word == ("remains" if zero else "vanishes"):
            faults.append(named)
    return faults


def upright(
    *cylinders: cp.Cylinder, tdc_deg: list[float], cranks: tuple[int, ...] = ()
) -> cp.Engine:
    """Cylinders side by side, on cranks of these speeds after the main one if there are any."""
    count = len(cylinders)
    return cp.Engine.from_lists(
        cylinders,
        tdc_deg=tdc_deg,
        bank_deg=[90] * count,
        z=[0.1 * k for k in range(count)],
        cranks=[(0.0, 0.0, ratio) for ratio in cranks],
        crank=range(count) if cranks else None,
    )


def test_rod_ratios_that_repeat_among_unlike_cylinders() -> None:
    """λ is 1/3, 1/3 and 1/4: order 2 of the third cylinder is another multiple of its m·r."""
    unlike = [
        cp.Cylinder(0.05, 0.15, 0.5),
        cp.Cylinder(0.04, 0.12, 0.5),
        cp.Cylinder(0.05, 0.2, 0.5),
    ]
    engine = cp.Engine.from_lists(unlike, bank_deg=[90, 0, 90], tdc_deg=[0, 0, 90], z=[0, 0, 0])
    assert engine.vanishing_orders([2]).force.y[2] == "remains"
    assert engine.balance(3000, orders=[2])[2].force.peak_xy[1] > 200.0
    with pytest.raises(cp.InputError, match="of different proportions"):
        engine.closed_form(2, "force")


def test_a_third_crank_has_a_motion_of_its_own() -> None:
    cylinder = cp.Cylinder(0.04, 0.13, 0.5)
    engine = upright(cylinder, cylinder, cylinder, tdc_deg=[0, 0, 0], cranks=(-1, -3))
    verdicts = engine.vanishing_orders([3]).force
    assert (verdicts.x[3], verdicts.y[3]) == ("vanishes", "remains")
    assert engine.balance(60, orders=[3])[3].force.peak_xy[1] > 1.0


def test_mirrored_offsets_on_cranks_of_either_sense_cancel_in_pairs() -> None:
    plus, minus = (cp.Cylinder(0.05, 0.15, 0.5, offset) for offset in (0.01, -0.01))
    engine = cp.Engine.from_lists(
        [minus, plus] * 3,
        tdc_deg=[210, 0, 150, 210, 0, 150],
        bank_deg=[90] * 6,
        z=[0.0] * 6,
        cranks=[(0.0, 0.0, -1)],
        crank=[0, 1, 1, 1, 0, 0],
    )
    assert engine.balance(3000, orders=[3])[3].force.peak == 0
    assert engine.vanishing_orders([3]).force[3] == "vanishes"


def test_nothing_is_known_of_gas_on_faster_cranks() -> None:
    """At order 1 of a crank of ratio 2, half its own, it matters which of its turns fires."""
    cylinder = cp.Cylinder(0.04, 0.13, 0.5)
    twin = cp.Engine.from_lists(
        cylinder,
        tdc_deg=[0, 180],
        bank_deg=[90, 90],
        z=[0, 0.1],
        cranks=[(0.1, 0.0, 2)],
        crank=[1, 1],
    )
    found = twin.vanishing_orders([1, 2])
    assert found.gas_torque.undecided == (1, 2)
    assert any("gas on cranks of other speeds" in text for text in found.obstacles)


# --- what is said -------------------------------------------------------------------------------

COMPONENTS = {"force": ("x", "y"), "moment": ("x", "y"), "torque": ("z",)}


def said(draft: Draft) -> Iterator[tuple[str, float, bool]]:
    """Yield what is said to be zero, or left, with proof, and whether sixty digits agree."""
    engine = draft.engine()
    sums = {order: draft.sums(engine, 2 * order) for order in ORDERS}

    def zero(quantity: str, order: int, parts: Sequence[str] = ()) -> bool:
        of = parts or COMPONENTS[quantity]
        return all(sums[order].is_zero(quantity, part) for part in of)

    balance = engine.balance(3000.0, orders=list(ORDERS))
    for order in ORDERS:
        for quantity in ("force", "moment"):
            if getattr(balance[order], quantity).status == "zero, proved":
                yield f"balance: {quantity}", order, zero(quantity, order)
            try:
                form = engine.closed_form(order, "force" if quantity == "force" else "moment")
            except cp.InputError:
                continue
            for part in ("x", "y", "forward", "backward"):
                phasor = form._coefficients(part)
                terms = phasor["real"] + phasor["imaginary"] + phasor["square"]
                nothing = form._form["no_harmonic"] or not any(terms)
                yield f"form: {quantity} {part}", order, nothing == zero(quantity, order, [part])
    for finding in engine.explain(3000.0).findings:
        if finding.kind == "gas orders":
            for half in finding.orders:
                of_gas = draft.sums(engine, round(2 * half))
                yield "gas: left", half, not of_gas.is_zero("gas_torque", "z")
        orders = [int(order) for order in finding.orders if order in ORDERS]
        if not finding.proved or finding.quantity not in {"force", "moment"}:
            continue
        for order in orders:
            if finding.kind == "cancels":
                yield f"explain: {finding.quantity}", order, zero(finding.quantity, order)
            elif finding.kind == "hardware":
                before, after = finding.values[:2], finding.values[2:4]
                parts = zip(("forward", "backward"), before, after, strict=True)
                gone = [part for part, was, now in parts if was and not now]
                yield f"hardware: {finding.quantity}", order, zero(finding.quantity, order, gone)


def test_nothing_that_is_said_to_be_proved_is_false() -> None:
    counts: Counter[str] = Counter()
    drawing = Drawing(45)
    for k in range(150):
        draft = drawing.draft(fired=k % 3 == 0)
        for words, order, true in said(draft):
            assert true, (words, order, draft)
            counts[words.partition(":")[0]] += 1
    assert min(counts[of] for of in ("balance", "form", "explain")) > 80, counts
    assert min(counts["hardware"], counts["gas"]) > 0, counts


@pytest.mark.parametrize("fired", [False, True])
def test_no_proof_is_false(fired: bool) -> None:
    counts: Counter[tuple[str, bool]] = Counter()
    drawing = Drawing(36)
    while counts.total() < 10_000:
        draft = drawing.draft(fired=fired)
        assert wrong(draft, counts) == [], draft
    # Some 70 in 100 are decided, and 22 or more vanish: neither is a matter of chance.
    assert counts["vanishes", True] > 2000
    assert counts["remains", False] > 3500
