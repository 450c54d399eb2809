"""All candidates: the finite choices, each with the angles that may still vary; their engines."""

from __future__ import annotations

import dataclasses
from collections import Counter
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint, suppressed
from crankpin.analysis.arrangements.cranks import (
    MOST_CRANKS,
    TURN,
    Crank,
    Exact,
    exact,
    permutations,
    throw_orders,
    too_many,
)
from crankpin.analysis.balancing.planes import ends
from crankpin.model.engine import Engine
from crankpin.model.shafts import Shaft, Unbalance, unbalance_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from crankpin._support.inputs import Order
    from crankpin.analysis.design.question import Question


@dataclasses.dataclass(frozen=True)
class Variable:
    """An angle that may vary, and what varies with it."""

    low: Exact
    high: Exact
    """Limits, degrees; of a throw those of a turn, which are one and the same place."""
    bank_angle: int = 0
    """1 if it is the bank angle."""
    throws: tuple[int, ...] = ()
    """1 for each throw that it turns; empty for none."""
    splits: tuple[int, ...] = ()
    """1 for each pin split that grows with it; empty for none."""

    @property
    def periodic(self) -> bool:
        """True for the angle of a throw."""
        return bool(self.throws)

    def turns(self, banks: int, count: int) -> tuple[list[float], list[float]]:
        """Return how far it turns the bore and the crankpin of each cylinder, per unit."""
        throws, splits = (each or (0,) * count for each in (self.throws, self.splits))
        if banks == 1:
            return [0.0] * count, [float(throw) for throw in throws]
        bores = [side * self.bank_angle for _ in throws for side in (-0.5, 0.5)]
        pairs = zip(throws, splits, strict=True)
        return bores, [float(pin) for throw, split in pairs for pin in (throw, throw + split)]


@dataclasses.dataclass(frozen=True)
class Family:
    """A candidate whose angles may vary; one whose angles are fixed has no variables."""

    base: Crank
    """The crank with every variable at 0."""
    variables: tuple[Variable, ...] = ()

    def crank(self, values: Sequence[Exact]) -> Crank:
        """Return the crank with these values of the variables."""
        throws, splits = list(self.base.throws), list(self.base.splits)
        angle = self.base.bank_angle
        for variable, value in zip(self.variables, values, strict=True):
            throws = _plus(throws, variable.throws, value)
            splits = _plus(splits, variable.splits, value)
            if angle is not None:
                angle += variable.bank_angle * value
        return Crank.of(throws, splits, angle)


def families(question: Question) -> tuple[list[Family], int]:
    """Return one of each set of equivalent candidates, and the number of all."""
    distinct: dict[Family, None] = {}
    everything: set[Family] = set()
    for family in _all(question):
        if family in everything:
            continue
        everything.add(family)
        if len(everything) > MOST_CRANKS:
            raise too_many(question.count)
        fixed = not family.variables
        base = question.symmetries.first(family.base, exchange=fixed)
        distinct.setdefault(dataclasses.replace(family, base=base))
    if not distinct:
        between = "{} to {}".format(*question.bank_angle)
        why = "no crank fires at these intervals; allow other bank angles, or pins that are split "
        hint = Hint.of(f"{why}(`shared_pins=False`)")
        raise inputs.faulty("bank_angle_deg", f"= {between}", hint)
    return list(distinct), len(everything)


def _all(question: Question) -> Iterator[Family]:
    if question.tdcs is None:
        yield from _of_throws(question)
    elif question.banks == 1:
        for tdcs in throw_orders(question.tdcs):
            yield Family(Crank.of([-each for each in tdcs]))
    else:
        seen: set[tuple[Exact, ...]] = set()
        for right, left in _pairs(question):
            # Left minus right TDC is bank angle minus split, throw by throw.
            later = tuple((b - a) % TURN for a, b in zip(right, left, strict=True))
            throws = Crank.of([-each for each in right]).throws
            if (*throws, *later) in seen:
                continue
            seen.add((*throws, *later))
            yield from _between(question, throws, later)


# --- any firing ---------------------------------------------------------------------------------


def _of_throws(question: Question) -> Iterator[Family]:
    """Yield the families of given throws in all orders, or of free ones."""
    count = question.count
    variables: list[Variable] = []
    splits: tuple[Exact, ...] = ()
    angle: Exact | None = None
    if question.banks == 2:
        low, high = question.bank_angle
        angle = low if low == high else 0
        variables += [Variable(low, high, bank_angle=1)] if low < high else []
        splits = (question.pin_split[0] if question.fixed_split else 0,) * count
        if not question.fixed_split:
            groups = [(1,) * count] if question.same_split else _units(count)
            variables += [Variable(*question.pin_split, splits=group) for group in groups]
    if question.free_throws:
        turning = [Variable(0, TURN, throws=unit) for unit in _units(count)[1:]]
        base = Crank.of([0] * count, splits, angle)
        yield Family(base, (*variables, *turning))
        return
    for angles in question.throws:
        for throws in throw_orders(angles):
            yield Family(Crank.of(throws, splits, angle), tuple(variables))


# --- a given firing -----------------------------------------------------------------------------


def _pairs(question: Question) -> Iterator[tuple[tuple[Exact, ...], tuple[Exact, ...]]]:
    """Yield top dead centres of the right and the left bank, throw by throw."""
    assert question.tdcs is not None  # noqa: S101 - the caller has looked
    counts = Counter(question.tdcs)
    if not question.same_split:
        for half in _halves(counts, question.count):
            for right in throw_orders(tuple(half.elements())):
                for left in permutations(counts - half):
                    yield right, left
        return
    first = question.tdcs[0]
    steps = {(each - first) % TURN for each in counts} | {(first - each) % TURN for each in counts}
    for step in sorted(steps):
        for half in shifted_halves(counts, step):
            for right in throw_orders(tuple(half.elements())):
                yield right, tuple((each + step) % TURN for each in right)


def _halves(counts: Counter[Exact], size: int) -> Iterator[Counter[Exact]]:
    """Yield the choices of ``count`` of these angles."""
    keys = list(counts)
    for numbers in product(*(range(counts[key] + 1) for key in keys)):
        if sum(numbers) == size:
            yield Counter(dict(zip(keys, numbers, strict=True)))


def shifted_halves(counts: Counter[Exact], step: Exact) -> Iterator[Counter[Exact]]:
    """Yield the halves of these angles that, turned by a step, are the other half.

    Of an angle that comes m times, r in the half and r′ of the angle one step before add up to m:
    along each chain of angles a step apart one number determines the others.
    """
    chains: list[list[dict[Exact, int]]] = []
    rest = set(counts)
    while rest:
        start = origin = min(rest)
        before = (start - step) % TURN
        while before in counts and before != origin:
            start, before = before, (before - step) % TURN
        closed = before in counts
        chain = [start]
        while (after := (chain[-1] + step) % TURN) in counts and after != chain[0]:
            chain.append(after)
        rest -= set(chain)
        ways = []
        for number in range(counts[chain[0]] + 1) if closed else (counts[chain[0]],):
            numbers = [number]
            for key in chain[1:]:
                numbers.append(counts[key] - numbers[-1])
            last = counts[chain[0]] - numbers[0] if closed else 0
            if min(numbers) >= 0 and numbers[-1] == last:
                ways.append(dict(zip(chain, numbers, strict=True)))
        chains.append(ways)
    for chosen in product(*chains):
        yield Counter({key: number for way in chosen for key, number in way.items() if number})


def _between(
    question: Question, throws: tuple[Exact, ...], later: tuple[Exact, ...]
) -> Iterator[Family]:
    """Yield the ranges of bank angle in which splits are within their limits."""
    ranges = [question.bank_angle]
    low, high = question.pin_split
    if high - low < TURN:
        for each in set(later):
            allowed = [(each + low + turn, each + high + turn) for turn in (-TURN, 0, TURN)]
            ranges = list(_common(ranges, allowed))
    for first, last in ranges:
        if first == last:
            yield Family(Crank.of(throws, [first - each for each in later], first))
            continue
        base = Crank.of(throws, [-each for each in later], 0)
        yield Family(base, (Variable(first, last, bank_angle=1, splits=(1,) * len(later)),))


def _common(
    one: Iterable[tuple[Exact, Exact]], other: Iterable[tuple[Exact, Exact]]
) -> Iterator[tuple[Exact, Exact]]:
    for a, b in product(one, other):
        low, high = max(a[0], b[0]), min(a[1], b[1])
        if low <= high:
            yield low, high


def _units(count: int) -> list[tuple[int, ...]]:
    return [tuple(int(j == k) for j in range(count)) for k in range(count)]


def _plus(angles: list[Exact], which: tuple[int, ...], value: Exact) -> list[Exact]:
    if not which:
        return angles
    return [angle + each * value for angle, each in zip(angles, which, strict=True)]


# --- their engines --------------------------------------------------------------------------------


def engines_of(question: Question, cranks: Sequence[Crank]) -> list[Engine]:
    """Return the engine of each crank."""
    engines = []
    with suppressed():
        # Of units once for the whole call; pins may be split to any side here.
        for crank in cranks:
            engine = _bare(question, crank)
            if question.counterweights:
                weight = _bob_weight(question)
                pins = enumerate(engine.z.tolist(), start=1)
                engine = engine.with_counterweights(
                    [dataclasses.replace(weight, z=z, pin=pin) for pin, z in pins]
                )
            engines.append(_with_shafts(engine, question.shafts) if question.shafts else engine)
    return engines


def turned(question: Question, crank: Crank, bank_angle_deg: float) -> Crank:
    """Return a crank at another bank angle: pins held, or top dead centres."""
    angle = exact(inputs.angle("bank_angle_deg", bank_angle_deg))
    assert crank.bank_angle is not None  # noqa: S101 - two banks
    more = angle - crank.bank_angle if question.hold == "firing" else 0
    return Crank.of(crank.throws, [split + more for split in crank.splits], angle)


def one_cylinder(question: Question) -> Engine:
    """Return an upright engine of one cylinder, with what follows its crankpin."""
    single = dataclasses.replace(question, cylinders=1, banks=1, shafts=())
    return engines_of(single, [Crank.of([0])])[0]


def warn_of_units(question: Question) -> None:
    """Warn, as builders do, of lengths in millimetres and masses in grams."""
    zeros = [0] * question.count
    _bare(question, Crank.of(zeros) if question.banks == 1 else Crank.of(zeros, zeros, 90))


def _bare(question: Question, crank: Crank) -> Engine:
    arguments: dict[str, Any] = {
        "spacing": question.spacing,
        "rotating_mass": question.rotating_mass,
        "throws_deg": crank.throws,
        "strokes": question.strokes,
    }
    if crank.bank_angle is None:
        name = f"I{question.cylinders} {crank.text}"
        return Engine.inline(question.cylinder, **arguments, name=name)
    alike = len(set(crank.splits)) == 1
    split = f", split {crank.splits_text}" if crank.splits_text else ""
    engine = Engine.vee(
        question.cylinder,
        bank_angle_deg=crank.bank_angle,
        pin_split_deg=crank.splits[0] if alike else 0,
        bank_stagger=question.bank_stagger,
        **arguments,
        name=f"V{question.cylinders} {float(crank.bank_angle):.6g}°, {crank.text}{split}",
    )
    if alike:
        return engine
    pins = []
    for throw, left in zip(crank.throws, crank.left, strict=True):
        # The builder has cylinder 1, in the right bank, at top dead centre.
        bore = 90 - Fraction(crank.bank_angle) / 2
        pins += [bore + throw, bore + left]
    return engine.replace(pin_deg=pins)


def _bob_weight(question: Question) -> Unbalance:
    """Return the weight at a pin that removes the forward part of its cylinder's first order."""
    amount, angle_deg = _core.forward_weight(question.cylinder._parts, question.rotating_mass)
    return Unbalance(amount, 0.0, angle_deg)


def _with_shafts(engine: Engine, ratios: tuple[Order, ...]) -> Engine:
    """Return an engine with shafts that remove all of their part of an order.

    Each stands on the crank axis, so that it adds no roll torque, and has two unbalances at the
    first and the last throw: force and moment determine them.
    """
    wanted = [(ratio, (0.0, 0.0), ends(engine), "both") for ratio in ratios]
    fitted, _ = _core.fit_shafts(engine._core, wanted, None)
    return engine.with_shafts(
        Shaft(ratio, tuple(map(unbalance_of, weights)), name=f"of order {abs(ratio):g}")
        for ratio, (_, weights, _) in zip(ratios, fitted, strict=True)
    )
