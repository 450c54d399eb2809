"""Exercises: a sheet with random figures, and its solution."""

from __future__ import annotations

import html
import math
import textwrap
from functools import cached_property
from random import Random
from typing import TYPE_CHECKING, NamedTuple

from crankpin._support import inputs
from crankpin._support.frames import Frames, Tabled
from crankpin._support.record import Record, read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import balance
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.locomotive import Locomotive
from crankpin.model.cycle import Cycle
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

INLINES = ("i2-360", "i2-180", "i2-270", "i3", "i4", "i4-crossplane", "i6")
"""Inline engines with a measurable shaking force: that of an inline-5 is order 10, some mN."""
FIRING = ("i3", "i4", "i5", "i6", "v6-60", "v6-90-odd-fire", "v8-crossplane", "v12-60", "v-twin-45")
SECOND = "With λ = r / l the second harmonic is a₂ ≈ λ + λ³/4."
TEXT_WIDTH = 88
"""Width of a question in text, characters."""
RIGHT_WITHIN = 0.01
"""Answers within one per cent are right: slide rules and three digits are welcome."""


def exercise(topic: str, seed: int = 0) -> Exercise:
    """Return an exercise on a topic, with random figures, and its solution.

    The same seed gives the same sheet everywhere, another one other figures.

    Parameters
    ----------
    topic : str
        ``"single"``, ``"inline"``, ``"v-twin"``, ``"v-angle"``, ``"bob-weight"``,
        ``"counterweight"``, ``"balance-shafts"``, ``"firing-order"``, ``"flywheel"`` or
        ``"locomotive"``.
    seed : int, default 0
        Number of the sheet.

    Returns
    -------
    Exercise
        Question, steps and answers, and its engine.

    Raises
    ------
    InputError
        If there is no such topic, or the seed is not a whole number from 0.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.exercise("v-angle", seed=7)
    A V6 whose first-order moment turns with the crank (sheet v-angle 7)
    A V6 has the throws 0-120-240 of its right bank, 130 mm apart. Its left pins are split
    by -30° from them, in the direction of rotation. A piston with its part of the rod has
    458 g, the stroke is 96 mm, the rods are 154 mm long, the speed is 2500 rpm. At which
    bank angle does no part of the first-order rocking moment turn against the crank? How
    large is the moment there?
    Answers: bank_angle (°), moment (N·m)
    >>> cp.exercise("v-angle", seed=7).check(bank_angle=75, moment=300)
    {'bank_angle': True, 'moment': False}
    """
    name = inputs.one_of("topic", topic, TOPICS)
    number = inputs.whole("seed", seed, 0)
    return Exercise(name, number, *TOPICS[name](Random(f"{name} {number}")))  # noqa: S311 - no secret


class Step(Record):
    """Step of a solution."""

    text: str
    """Quantity computed in this step."""
    formula: str
    """Formula of the step."""
    value: float
    """Value."""
    unit: str
    """Unit of the value; empty for a ratio or a count."""
    answer: str = ""
    """Name of the answer that it is; empty for a step on the way."""


class Exercise(Tabled):
    """A question with its figures, the engine that it is about, and the solution in steps.

    Made by :func:`crankpin.exercise`.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.exercise("counterweight", seed=7).solution
    Solution of sheet counterweight 7
    step                             formula         value  unit
    angular speed                    ω = 2π n / 60  680.68  rad/s
    first-order force of one piston  F = m r ω²     9536.1  N
    along the bore                   (1 − κ) F      3814.4  N
    across it                        κ F            5721.7  N
    """

    topic: str
    """Topic, an argument of :func:`crankpin.exercise`."""
    seed: int
    """Number of the sheet."""
    title: str
    """Title of the sheet."""
    question: str
    """Question with its figures."""
    engine: Engine
    """Engine of the question."""
    steps: tuple[Step, ...]
    """Steps of the solution."""

    def __post_init__(self) -> None:
        steps: object = self.steps
        sound = isinstance(steps, tuple) and all(isinstance(step, Step) for step in steps)
        if not (sound and steps):
            raise inputs.rejected("steps", steps, "use cp.exercise")
        super().__post_init__()

    @property
    def table(self) -> Table:
        """Answers that the sheet asks for, with their units, and the question."""
        rows = [(step.answer, step.unit) for step in self._answered]
        return Table.from_rows(self._head, ["answer", "unit"], rows, note=self.question)

    @property
    def frames(self) -> Frames:
        """``table``; ``solution``: its steps."""
        return self._frames(solution=lambda: self.solution)

    @cached_property
    def solution(self) -> Table:
        """Solution: steps, formulae and values."""
        return Table.from_rows(
            f"Solution of sheet {self.topic} {self.seed}",
            ["step", "formula", "value", "unit"],
            [(step.text, step.formula, step.value, step.unit) for step in self.steps],
        )

    @cached_property
    def answers(self) -> Mapping[str, float]:
        """Right answers by name, in the units that the sheet asks for."""
        return read_only({step.answer: step.value for step in self._answered})

    @property
    def _answered(self) -> list[Step]:
        """Steps that are answers."""
        return [step for step in self.steps if step.answer]

    def check(self, **answers: float) -> dict[str, bool]:
        """Return which answers are right, to one per cent.

        Parameters
        ----------
        **answers : float, optional
            Answers by the names that the sheet gives.

        Returns
        -------
        dict of str to bool
            True for each that is right.

        Raises
        ------
        InputError
            If the sheet asks for nothing of this name, an answer is no number, or there is none.
        """
        right = self.answers
        if not answers:
            hint = f"give {' or '.join(f'{name}=…' for name in right)}"
            raise inputs.faulty("answers", "are left out", hint)
        return {
            inputs.one_of("answers", name, right): math.isclose(
                inputs.finite(name, value),
                right[name],
                rel_tol=RIGHT_WITHIN,
                abs_tol=RIGHT_WITHIN * RIGHT_WITHIN,
            )
            for name, value in answers.items()
        }

    def __str__(self) -> str:
        return "\n".join((self._head, textwrap.fill(self.question, TEXT_WIDTH), self._asks))

    __repr__ = __str__

    @property
    def _head(self) -> str:
        return f"{self.title} (sheet {self.topic} {self.seed})"

    @property
    def _asks(self) -> str:
        return "Answers: " + ", ".join(
            f"{step.answer} ({step.unit})" if step.unit else step.answer for step in self._answered
        )

    def _repr_html_(self) -> str:
        head, question, asks = map(html.escape, (self._head, self.question, self._asks))
        return f"<h4>{head}</h4><p>{question}</p><p><i>{asks}</i></p>"


# --- topics -------------------------------------------------------------------------------------


class Figures(NamedTuple):
    """Figures of a cylinder, as a sheet gives them."""

    grams: int
    stroke: int
    rod: int
    rpm: int

    @classmethod
    def drawn(cls, random: Random) -> Figures:
        """Return figures of a car's engine."""
        stroke = random.randrange(66, 97, 2)
        rod = round(stroke * random.choice((1.5, 1.6, 1.7, 1.8, 2.0)))
        return cls(random.randrange(350, 701), stroke, rod, random.randrange(2000, 7001, 500))

    @property
    def cylinder(self) -> Cylinder:
        """Cylinder with these figures."""
        return Cylinder(
            crank_radius=self.stroke / 2000,
            rod_length=self.rod / 1000,
            reciprocating_mass=self.grams / 1000,
        )

    def __str__(self) -> str:
        return (
            f"A piston with its part of the rod has {self.grams} g, the stroke is {self.stroke} "
            f"mm, the rods are {self.rod} mm long, the speed is {self.rpm} rpm."
        )

    @property
    def first_order(self) -> list[Step]:
        """Steps to the first-order force of one piston."""
        omega = inputs.angular_speed(self.rpm)
        force = self.cylinder.reciprocating_mass * self.cylinder.crank_radius * omega**2
        return [
            Step("angular speed", "ω = 2π n / 60", omega, "rad/s"),
            Step("first-order force of one piston", "F = m r ω²", force, "N"),
        ]

    @property
    def second_order(self) -> list[Step]:
        """Steps to the second-order force of one piston."""
        cylinder = self.cylinder
        second = float(abs(cylinder.harmonics([2])[0]))
        force = self.first_order[-1].value * second
        return [
            *self.first_order,
            Step("rod ratio", "λ = r / l", cylinder.rod_ratio, ""),
            Step("second harmonic", "a₂ = λ + λ³/4 + 15 λ⁵/128 + …", second, ""),
            Step("second-order force of one piston", "a₂ F", force, "N"),
        ]


Sheet = tuple[str, str, Engine, tuple[Step, ...]]


def _single(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    engine = Engine.inline(figures.cylinder, throws_deg=[0], spacing=0.1)
    first, second = balance(engine, figures.rpm, orders=(1, 2)).force.peak.tolist()
    steps = (
        *figures.second_order,
        Step("first order", "F", first, "N", "first"),
        Step("second order", "a₂ F", second, "N", "second"),
    )
    question = f"{figures} {SECOND} How large are the shaking forces of orders 1 and 2 of a single?"
    return "A single shakes", question, engine, steps


def _inline(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    engine = Engine.preset(random.choice(INLINES), cylinder=figures.cylinder)
    b = balance(engine, figures.rpm)
    lowest = next(order for order in b.orders if b[order].force.peak > 0)
    force = float(b[lowest].force.peak)
    steps = (
        *figures.first_order,
        Step(
            "star of each order: arrows at n times the throws; the first that does not close",
            "Σ e^(i n φ) ≠ 0",
            float(lowest),
            "",
            "order",
        ),
        Step("force of that order", "aₙ F |Σ e^(i n φ)|", force, "N", "force"),
    )
    angles = "-".join(f"{angle:g}" for angle in engine.throws_deg)
    evens = ", ".join(
        f"a{n} = {value:.4g}"
        for n, value in zip("₂₄₆", figures.cylinder.harmonics([2, 4, 6]).real, strict=True)
    )
    question = (
        f"An inline-{len(engine)} has the throws {angles}. {figures} The piston's harmonics are "
        f"a₁ = 1, {evens}, and no others of odd order. Which is the lowest order with a shaking "
        "force, and how large is it?"
    )
    return "What an inline engine leaves", question, engine, steps


def _v_twin(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    angle = random.choice((42, 45, 50, 52, 56, 60, 72, 75, 80, 90))
    engine = Engine.vee(figures.cylinder, bank_angle_deg=angle, throws_deg=[0], spacing=0.1)
    half = bob_weight(engine, 0.5)
    rest = float(half.fitted.balance(figures.rpm, orders=(1,))[1].force.peak)
    steps = (
        *figures.first_order,
        Step(
            "bob weight, half of both pistons", "½ · 2 m", figures.grams / 1000, "kg", "bob_weight"
        ),
        Step(
            "what is left turns against the crank: two arrows F/2 at twice the bank angle",
            "F |cos α|",
            rest,
            "N",
            "force",
        ),
    )
    question = (
        f"Two cylinders at a bank angle of {angle}° share one crankpin. {figures} Half of the "
        "reciprocating masses is balanced. How large is the bob weight (without rotating parts), "
        "and the first-order force that is left?"
    )
    return "Half of a V-twin", question, engine, steps


def _v_angle(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    split = random.choice((-60, -48, -36, -30, -24, -12, 12, 24, 30))
    spacing = random.randrange(90, 150, 10)
    angle = 90 + split / 2
    engine = Engine.vee(
        figures.cylinder,
        bank_angle_deg=angle,
        throws_deg=[0, 120, 240],
        pin_split_deg=split,
        spacing=spacing / 1000,
    )
    moment = float(balance(engine, figures.rpm, orders=(1,))[1].moment.peak)
    steps = (
        *figures.first_order,
        Step(
            "backward parts of the banks point at 2β − pin: they are opposite where",
            "2α − σ = 180°",
            angle,
            "°",
            "bank_angle",
        ),
        Step(
            "one bank's throws, at −s, 0, s",
            "|Σ z e^(i φ)| = √3 s",
            math.sqrt(3) * spacing / 1000,
            "m",
        ),
        Step(
            "forward parts: of half the force, the banks' σ apart",
            "√3 s F |cos σ/2|",
            moment,
            "N·m",
            "moment",
        ),
    )
    question = (
        f"A V6 has the throws 0-120-240 of its right bank, {spacing} mm apart. Its left pins are "
        f"split by {split:+}° from them, in the direction of rotation. {figures} At which bank "
        "angle does no part of the first-order rocking moment turn against the crank? How large is "
        "the moment there?"
    )
    return "A V6 whose first-order moment turns with the crank", question, engine, steps


def _bob_weight(random: Random) -> Sheet:
    parts = {
        "a piston": random.randrange(380, 521),
        "a pin with its locks": random.randrange(90, 151),
        "a set of rings": random.randrange(30, 61),
        "a small end": random.randrange(150, 211),
        "a big end": random.randrange(380, 481),
        "a pair of bearing shells": random.randrange(38, 55),
    }
    oil = random.choice((2, 3, 4, 5))
    percent = random.choice((48, 50, 50, 52))
    *reciprocating, big_end, shells = parts.values()
    cylinder = Cylinder(
        crank_radius=0.045, rod_length=0.152, reciprocating_mass=sum(reciprocating) / 1000
    )
    engine = Engine.preset(
        "v8-crossplane", cylinder=cylinder, rotating_mass=(big_end + shells) / 1000
    )
    grams = float(bob_weight(engine, percent / 100, oil / 1000).grams[0])
    steps = (
        Step("reciprocating, of one cylinder", "sum", sum(reciprocating), "g"),
        Step("rotating, of one rod", "sum", big_end + shells, "g"),
        Step(
            "bob weight, two rods on a pin",
            f"2 rotating + {percent} % · 2 reciprocating + oil",
            grams,
            "g",
            "grams",
        ),
    )
    weighed = ", ".join(f"{name} {mass} g" for name, mass in parts.items())
    question = (
        f"The parts of a V8 with two rods on each crankpin weigh: {weighed}; oil of a pin {oil} g. "
        f"How heavy is a bob weight at {percent} %?"
    )
    return "A bob weight", question, engine, steps


def _counterweight(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    percent = random.choice((30, 40, 45, 55, 60, 65, 70))
    engine = Engine.inline(figures.cylinder, throws_deg=[0], spacing=0.1)
    left = bob_weight(engine, percent / 100).fitted.balance(figures.rpm, orders=(1,))[1]
    across, along = left.force.peak_xy.tolist()
    steps = (
        *figures.first_order,
        Step("along the bore", "(1 − κ) F", along, "N", "along"),
        Step("across it", "κ F", across, "N", "across"),
    )
    question = (
        f"The crank of a single is balanced at {percent} % of its reciprocating mass. {figures} "
        "How large is the first-order force along the bore, and across it?"
    )
    return "A counterweight trades up and down for to and fro", question, engine, steps


def _balance_shafts(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    engine = Engine.preset("i4", cylinder=figures.cylinder)
    fit = balance_shafts(engine, [2, -2])
    unbalance = fit.fitted.shafts[0].unbalances[0].amount * 1e6
    steps = (
        *figures.second_order,
        Step("four pistons together", "4 a₂ F", 4 * figures.second_order[-1].value, "N"),
        Step(
            "two shafts at twice the speed share it",
            "U = 4 a₂ F / (2 (2ω)²)",
            unbalance,
            "g·mm",
            "unbalance",
        ),
    )
    question = (
        f"{figures} {SECOND} Two shafts at twice crank speed, one with the crank and one against "
        "it, are to remove the second-order force of an inline-4. How large is the unbalance of "
        "one of them?"
    )
    return "Balance shafts of an inline-4", question, engine, steps


def _firing_order(random: Random) -> Sheet:
    name = random.choice(FIRING)
    engine = Engine.preset(name)
    chart = engine.firing()
    longest = max(chart.intervals_deg.tolist())
    fired = engine.with_cycle(Cycle.example())
    b = balance(fired, 2000.0)
    lowest = next(order for order in b.orders if b.crank_torque[order].gas.peak > 0)
    steps = (
        Step(
            "longest firing interval", "differences of the firing angles", longest, "°", "interval"
        ),
        Step(
            "lowest order of gas torque: the arrows at n times the firing angles do not close",
            "Σ e^(−i n φ) ≠ 0, n = ½, 1, 1½, …",
            float(lowest),
            "",
            "order",
        ),
    )
    angles = ", ".join(f"{angle:g}°" for angle in sorted(chart.angles_deg.tolist()))
    question = (
        f"A four-stroke engine of {len(engine)} cylinders fires at {angles} of 720°. How long is "
        "its longest interval between firings, and which is the lowest order of its gas torque?"
    )
    return "Which orders do the gases leave?", question, engine, steps


def _flywheel(random: Random) -> Sheet:
    figures = Figures.drawn(random)
    share = random.choice((50, 80, 100, 150, 200))
    name = random.choice(("single", "i2-360", "i3", "i4"))
    cylinder = figures.cylinder.replace(bore=figures.stroke / 1000)
    engine = Engine.preset(name, cylinder=cylinder).with_cycle(Cycle.example())
    fit = flywheel(engine, figures.rpm, irregularity=1 / share)
    omega = figures.first_order[0].value
    of_gas, with_inertia = fit.approximations
    energy = fit.energy * with_inertia / of_gas
    steps = (
        figures.first_order[0],
        Step(
            "inertia of all that turns",
            "J = ΔE / (δ ω²)",
            energy * share / omega**2,
            "kg·m²",
            "inertia",
        ),
    )
    question = (
        f"Over a cycle the work of gas and inertia torque on a crankshaft at {figures.rpm} rpm "
        f"swings by {energy:.4g} J. Which inertia of all that turns keeps its irregularity at "
        f"1/{share}?"
    )
    return "A flywheel", question, engine, steps


def _locomotive(random: Random) -> Sheet:
    mass, stroke = random.randrange(240, 361, 10), random.randrange(560, 701, 20)
    apart, wheels = random.randrange(600, 761, 20), random.randrange(1500, 1601, 10)
    diameter, kmh = random.randrange(1500, 2001, 100), random.randrange(70, 111, 10)
    percent = random.choice((50, 60, 65, 70, 75))
    locomotive = Locomotive(
        Cylinder(stroke / 2000, math.inf, mass),
        z=[-apart / 2000, apart / 2000],
        throws_deg=[0, 90],
        wheel_z=[-wheels / 2000, wheels / 2000],
        share=percent / 100,
        wheel_diameter=diameter / 1000,
    )
    forces = locomotive.forces(speed_kmh=kmh)
    omega = inputs.angular_speed(forces.rpm)
    steps = (
        Step("angular speed of the wheels", "ω = 2 v / D", omega, "rad/s"),
        Step("inertia of one piston", "F = m r ω²", mass * stroke / 2000 * omega**2, "N"),
        Step("cylinders over wheels, halved", "k = a / (2 b)", apart / wheels / 2, ""),
        Step(
            "hammer blow of a wheel",
            "c F √((½ + k)² + (½ − k)²)",
            float(forces.hammer_blow.peak[0]),
            "N",
            "hammer_blow",
        ),
        Step(
            "variation of tractive effort",
            "√2 (1 − c) F",
            float(forces.tractive_variation.peak),
            "N",
            "tractive_variation",
        ),
        Step(
            "swaying couple",
            "a (1 − c) F / √2",
            float(forces.swaying_couple.peak),
            "N·m",
            "swaying_couple",
        ),
    )
    question = (
        f"A locomotive has two cylinders {apart} mm apart, its cranks are at right angles. The "
        f"reciprocating parts of each have {mass} kg, the stroke is {stroke} mm. All that turns "
        f"and {percent} % of the reciprocating parts are balanced in the planes of the wheels, "
        f"{wheels} mm apart, of {diameter} mm diameter. Rods are long. How large are hammer blow, "
        f"variation of tractive effort and swaying couple at {kmh} km/h?"
    )
    return "A locomotive of two cylinders", question, locomotive.engine, steps


TOPICS: dict[str, Callable[[Random], Sheet]] = {
    "single": _single,
    "inline": _inline,
    "v-twin": _v_twin,
    "v-angle": _v_angle,
    "bob-weight": _bob_weight,
    "counterweight": _counterweight,
    "balance-shafts": _balance_shafts,
    "firing-order": _firing_order,
    "flywheel": _flywheel,
    "locomotive": _locomotive,
}
"""Topics, and what makes a sheet of each."""
