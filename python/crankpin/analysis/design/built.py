"""Engines of cranks, with the counterweights and balance shafts that they are allowed."""

from __future__ import annotations

import cmath
import dataclasses
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from crankpin._support import inputs
from crankpin._support.warnings import suppressed
from crankpin.analysis.arrangements.cranks import Crank, exact
from crankpin.analysis.balance import UNIT_RPM
from crankpin.analysis.balancing.planes import Turning, ends, weights_in
from crankpin.analysis.sweeps.sweep import sweep
from crankpin.model.engine import Engine
from crankpin.model.shafts import Shaft, Unbalance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin.analysis.design.question import Question
    from crankpin.analysis.sweeps.sweep import Sweep


def engines(question: Question, cranks: Sequence[Crank]) -> list[Engine]:
    """Return the engine of each crank."""
    found = []
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
            found.append(engine)
    return _with_shafts(question, found) if question.shafts else found


def turned(question: Question, crank: Crank, bank_angle_deg: float) -> Crank:
    """Return a crank at another bank angle: pins held, or top dead centres."""
    angle = exact(inputs.angle("bank_angle_deg", bank_angle_deg))
    assert crank.bank_angle is not None  # noqa: S101 - two banks
    more = angle - crank.bank_angle if question.hold == "firing" else 0
    return Crank.of(crank.throws, [split + more for split in crank.splits], angle)


def one_cylinder(question: Question) -> Engine:
    """Return an upright engine of one cylinder, with what follows its crankpin."""
    single = dataclasses.replace(question, cylinders=1, banks=1, shafts=())
    return engines(single, [Crank.of([0])])[0]


def warn_of_units(question: Question) -> None:
    """Warn, as builders do, of lengths in millimetres and masses in grams."""
    zeros = [0] * question.count
    _bare(question, Crank.of(zeros) if question.banks == 1 else Crank.of(zeros, zeros, 90))


def _bare(question: Question, crank: Crank) -> Engine:
    given: dict[str, Any] = {
        "spacing": question.spacing,
        "rotating_mass": question.rotating_mass,
        "throws_deg": crank.throws,
    }
    if crank.bank_angle is None:
        name = f"I{question.cylinders} {crank.text}"
        return Engine.inline(question.cylinder, **given, name=name)
    alike = len(set(crank.splits)) == 1
    split = f", split {crank.splits_text}" if crank.splits_text else ""
    engine = Engine.vee(
        question.cylinder,
        bank_angle_deg=crank.bank_angle,
        pin_split_deg=crank.splits[0] if alike else 0,
        bank_stagger=question.bank_stagger,
        **given,
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
    """Return the weight at a pin that removes the forward part of its cylinder's first order.

    Half the reciprocating mass, whatever the bank (all of it forward); with an offset piston pin
    the first harmonic is a complex number, and the weight stands beside the opposite of the pin.
    """
    cylinder = question.cylinder
    (first,) = cylinder.harmonics([1])
    mass = 0.5 * cylinder.reciprocating_mass * complex(first) + question.rotating_mass
    vector = -mass * cylinder.crank_radius
    return Unbalance(abs(vector), 0.0, round(math.degrees(cmath.phase(vector)), 13))


def _with_shafts(question: Question, bare: list[Engine]) -> list[Engine]:
    """Return the engines with shafts that remove all of their part of an order.

    Each stands on the crank axis, so that it adds no roll torque, and has two unbalances at the
    first and the last throw: force and moment determine them.
    """
    orders = sorted({abs(ratio) for ratio in question.shafts})
    swept = sweep(bare, rpm=UNIT_RPM, orders=orders, torque=False)
    return [
        engine.with_shafts([_shaft(swept, k, ratio) for ratio in question.shafts])
        for k, engine in enumerate(bare)
    ]


def _shaft(swept: Sweep, k: int, ratio: int) -> Shaft:
    engine, found = swept.engines[k], swept[abs(ratio)]
    part = "forward" if ratio > 0 else "backward"
    force, moment = (getattr(each, part)[k] / ratio**2 for each in (found.force, found.moment))
    wanted = Turning(-complex(force), -complex(moment))
    needed = weights_in(engine, wanted, ends(engine))
    return Shaft(ratio, needed, name=f"of order {abs(ratio)}")
