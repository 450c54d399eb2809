"""Force or moment of one order as exact SymPy expressions."""

from __future__ import annotations

from dataclasses import field
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, optional, units
from crankpin._support.frames import Tabled
from crankpin._support.quantities import COMPONENTS, QUANTITIES
from crankpin._support.tables import Table
from crankpin.analysis.contributions import contributions
from crankpin.analysis.request import engine_core
from crankpin.model import checks

if TYPE_CHECKING:
    from crankpin.model.engine import Engine
    from crankpin.model.loads import PeriodicLoad

Expression: TypeAlias = Any
"""A SymPy expression; SymPy is imported when it is used."""


def closed_form(
    engine: Engine,
    order: int,
    quantity: Literal["force", "moment"] = "moment",
    *,
    reference_z: float | None = None,
) -> ClosedForm:
    """Return a closed form; :meth:`Engine.closed_form` documents the arguments."""
    word = inputs.one_of("quantity", quantity, ["force", "moment"])
    plane = inputs.optional_number("reference_z", reference_z)
    (single,) = inputs.explicit_orders([inputs.whole("order", order)], "order")
    checks.place(engine_core(engine), "reference_z", plane)
    return ClosedForm(engine, single, word, plane)


class ClosedForm(Tabled):
    """Force or moment of one order as SymPy expressions, exact.

    ``F`` stands for m·r·ω²·aₙ of the cylinder ``unit_cylinder`` (in magnitudes, for its size) and
    ``a`` for ``spacing``, of which all distances between cylinders are whole multiples. Phasors are
    those of :class:`Balance`: a quantity is ``Re(P exp(inθ))``, and ``x + iy = forward exp(inθ) +
    backward exp(−inθ)``. aₙ is below zero in orders 4, 8, …; with a pin offset it is complex, and
    ``backward`` goes with its conjugate.
    A periodic load that acts at the order is ``P1``, ``P2``, …: the phasor of its force along its
    direction, of one that turns ``P1f`` and ``P1b``, forward and backward; ``b1``, … are distances
    from the plane of moments. Other orders are as without it.
    Angles of 15° and its multiples, among others, give radicals; the rest stay cosines.

    Made by :meth:`Engine.closed_form`. Jupyter shows the sum over the cylinders and its value.

    Examples
    --------
    >>> import crankpin as cp
    >>> couple = cp.Engine.preset("v8-crossplane").closed_form(1)
    >>> couple.peak, couple.forward_phase
    (sqrt(10)*F*a, atan(2))
    """

    engine: Engine
    """The engine."""
    order: int
    """Multiple of crank speed."""
    quantity: str
    """"force" or "moment"."""
    plane: float | None
    """The reference plane that was given, m, or None."""
    unit_cylinder: int = field(init=False, compare=False)
    """Number of the cylinder whose force is F: the first that has reciprocating mass."""
    spacing: float = field(init=False, compare=False)
    """Distance that ``a`` stands for, m; 0 where no lever enters."""
    F: Expression = field(init=False, compare=False)
    """Symbol for m·r·ω²·aₙ of one cylinder."""
    a: Expression = field(init=False, compare=False)
    """Symbol for the spacing."""
    theta: Expression = field(init=False, compare=False)
    """Symbol for the crank angle."""
    loads: tuple[PeriodicLoad, ...] = field(init=False, compare=False)
    """Periodic loads that act at the order: those of ``P1``, ``P2``, …."""
    _unit: Expression = field(init=False, compare=False)
    _form: _core._Form = field(init=False, compare=False)

    def __post_init__(self) -> None:
        sp = optional.library("sympy")
        moment = self.quantity == "moment"
        form = _core.closed_form(engine_core(self.engine), self.order, moment, self.plane)
        F, a = sp.Symbol("F", positive=True), sp.Symbol("a", positive=True)
        self.__dict__.update(
            unit_cylinder=form["unit"] + 1,
            spacing=form["spacing"],
            F=F,
            a=a,
            theta=sp.Symbol("theta", real=True),
            loads=tuple(self.engine.loads[k] for k in form["loads"]),
            _unit=a * F if moment else F,
            _form=form,
        )

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        return self.engine.reference_z if self.plane is None else self.plane

    # --- phasors --------------------------------------------------------------------------------

    @cached_property
    def x(self) -> Expression:
        """Peak phasor along (about) x."""
        return self._phasor("x")

    @cached_property
    def y(self) -> Expression:
        """Peak phasor along (about) y."""
        return self._phasor("y")

    @cached_property
    def forward(self) -> Expression:
        """Part that turns with the crank."""
        return self._phasor("forward")

    @cached_property
    def backward(self) -> Expression:
        """Part that turns against the crank."""
        return self._phasor("backward")

    @cached_property
    def peak(self) -> Expression:
        """Length of the longest vector: forward and backward parts aligned."""
        sp = optional.library("sympy")
        if self.loads:
            return self.forward_magnitude + self.backward_magnitude
        return sp.expand(self._size("forward") + self._size("backward")) * self._unit

    @cached_property
    def peak_xy(self) -> tuple[Expression, Expression]:
        """Peaks along (about) x and y."""
        return (self._magnitude("x"), self._magnitude("y"))

    @cached_property
    def forward_magnitude(self) -> Expression:
        """Magnitude of the part that turns with the crank."""
        return self._magnitude("forward")

    @cached_property
    def backward_magnitude(self) -> Expression:
        """Magnitude of the part that turns against the crank."""
        return self._magnitude("backward")

    @cached_property
    def forward_phase(self) -> Expression:
        """Direction of the forward part from +x at θ = 0; 0 where there is none.

        That of an F above zero: the argument of another is to be added, π below zero.
        """
        return self._phase("forward")

    @cached_property
    def backward_phase(self) -> Expression:
        """Direction of the backward part from +x at θ = 0; 0 where there is none.

        That of an F above zero: the argument of another is to be taken away, π below zero.
        """
        return self._phase("backward")

    # --- the sum over the cylinders -------------------------------------------------------------

    @cached_property
    def x_terms(self) -> tuple[Expression, ...]:
        """Contribution of each cylinder along (about) x: weight × cos(nθ − phase), aₙ real."""
        return self._terms("x")

    @cached_property
    def y_terms(self) -> tuple[Expression, ...]:
        """Contribution of each cylinder along (about) y: weight × cos(nθ − phase), aₙ real."""
        return self._terms("y")

    @cached_property
    def x_sum(self) -> Expression:
        """Sum of ``x_terms``, over the crank angle ``theta``."""
        return self._sum("x")

    @cached_property
    def y_sum(self) -> Expression:
        """Sum of ``y_terms``, over the crank angle ``theta``."""
        return self._sum("y")

    # --- numbers --------------------------------------------------------------------------------

    def evaluate(self, rpm: float) -> dict[str, complex]:
        """Return the phasors "x", "y", "forward" and "backward" at a speed, N or N·m.

        Parameters
        ----------
        rpm : float
            Crank speed, rpm.

        Returns
        -------
        dict of str to complex
            Name → phasor, N or N·m.

        Raises
        ------
        InputError
            If an argument is out of range.
        """
        omega = inputs.angular_speed(rpm)
        cylinder = self.engine.cylinders[self.unit_cylinder - 1]
        scale = cylinder.reciprocating_mass * cylinder.crank_radius * omega**2
        unit = scale * complex(cylinder.harmonics(self.order)[0])
        if self.quantity == "moment":
            unit *= self.spacing
        values = {}
        for axis in COMPONENTS:
            real, imaginary = (complex(part.evalf(20)).real for part in self._parts_of(axis))
            factor = unit.conjugate() if axis == "backward" else unit
            values[axis] = complex(real, imaginary) * factor
        if self.loads:
            balance = self.engine.balance(rpm, orders=[self.order], torque=False)
            parts = contributions(balance.about(self.reference_z), self.quantity)
            phasors = [part.phasors[:, 0] for part in parts if part.group == "loads"]
            forward, backward = np.sum(phasors, axis=0)
            values["forward"] += forward
            values["backward"] += backward
            values["x"] += forward + np.conj(backward)
            values["y"] -= 1j * (forward - np.conj(backward))
        return {axis: complex(value) for axis, value in values.items()}

    # --- construction -------------------------------------------------------------------------

    def _cosines(self, coefficients: list[int], denominator: int) -> Expression:
        """Return Σ cₖ 2cos(2πk/N), in radicals where SymPy knows them."""
        sp = optional.library("sympy")
        if self._form["no_harmonic"]:
            return sp.Integer(0)
        period = self._form["period"]
        terms = [
            sp.Rational(c, denominator) * (2 * sp.cos(2 * sp.pi * k / period) if k else 1)
            for k, c in enumerate(coefficients)
            if c
        ]
        return sp.expand(sp.Add(*terms))

    def _parts_of(self, axis: str) -> tuple[Expression, Expression]:
        phasor, denominator = self._coefficients(axis), self._form["denominator"]
        real = self._cosines(phasor["real"], denominator)
        return real, self._cosines(phasor["imaginary"], denominator)

    def _coefficients(self, axis: str) -> _core._Coefficients:
        return self._form["phasors"][COMPONENTS.index(axis)]

    def _phasor(self, axis: str) -> Expression:
        real, imaginary = self._parts_of(axis)
        pistons = (real + optional.library("sympy").I * imaginary) * self._unit
        return pistons + sum(self._of_load(k, axis) for k in range(len(self.loads)))

    def _of_load(self, k: int, axis: str) -> Expression:
        """Return the phasor of a periodic load, in symbols."""
        sp = optional.library("sympy")
        load, name = self.loads[k], f"P{k + 1}"
        lever = sp.I * sp.Symbol(f"b{k + 1}", real=True) if self.quantity == "moment" else 1
        if load.turning:
            forward, backward = (
                sp.Symbol(f"{name}{side}") if turns else sp.Integer(0)
                for side, turns in zip("fb", self._turns(load), strict=True)
            )
        else:
            towards = sp.pi * sp.Rational(Fraction(load.exact_direction)) / 180
            along = (sp.cos(towards) + sp.I * sp.sin(towards)) / 2
            forward, backward = along * sp.Symbol(name), along * sp.conjugate(sp.Symbol(name))
        forward, backward = lever * forward, lever * backward
        if axis in ("forward", "backward"):
            return sp.expand(forward if axis == "forward" else backward)
        sum_of = forward + sp.conjugate(backward)
        return sp.expand(sum_of if axis == "x" else -sp.I * (forward - sp.conjugate(backward)))

    def _turns(self, load: PeriodicLoad) -> tuple[bool, bool]:
        """Return whether a force that turns has a forward and a backward part at the order."""
        ratio = load.ratio
        if load.crank is not None:
            ratio = engine_core(self.engine).cranks[0][load.crank][2]
        speeds = [
            speed
            for order, size in load.force.items()
            if np.any(size)
            for speed in (ratio + order, ratio - order)
        ]
        return self.order in speeds, -self.order in speeds

    def _magnitude(self, axis: str) -> Expression:
        if self.loads:
            return optional.library("sympy").Abs(self._phasor(axis))
        return self._size(axis) * self._unit

    def _size(self, axis: str) -> Expression:
        sp = optional.library("sympy")
        square = self._cosines(self._coefficients(axis)["square"], self._form["denominator"] ** 2)
        if square.has(sp.cos):
            return sp.sqrt(square)
        return sp.sqrtdenest(sp.sqrt(square))

    def _phase(self, axis: str) -> Expression:
        sp = optional.library("sympy")
        if self.loads:
            return sp.arg(self._phasor(axis))
        real, imaginary = self._parts_of(axis)
        if real == 0 or imaginary == 0:
            return sp.atan2(imaginary, real) if real != imaginary else sp.Integer(0)
        ratio = imaginary / real
        # Radicals of 2, 3 and 6 alone: dividing by them is cheap, and atan knows some values.
        if 24 % self._form["period"] == 0:
            ratio = sp.radsimp(ratio)
        if real.evalf() > 0:
            return sp.atan(ratio)
        return sp.atan(ratio) + (sp.pi if imaginary.evalf() > 0 else -sp.pi)

    def _terms(self, axis: str) -> tuple[Expression, ...]:
        sp = optional.library("sympy")
        of_loads = tuple(self._over_angle(self._of_load(k, axis)) for k in range(len(self.loads)))
        if self._form["no_harmonic"]:
            return of_loads
        # The moment of a force about x comes from its part along y, and is negative.
        moment = self.quantity == "moment"
        along, sign = ("y" if axis == "x" else "x", -1) if moment else (axis, 1)
        if axis == "y":
            sign = 1
        terms = []
        for part in self._form["parts"]:
            sense, direction = part["sense"], part["direction"]
            weight, lever = sp.Rational(*part["weight"]), sp.Rational(*part["lever"])
            factor = sign * weight * lever * self._unit
            lag = self.order * Fraction(*part["phase"])
            if sense:
                # What rotates is along y a quarter of a turn after x, or before.
                start = sense * Fraction(*direction) - lag
                quarter = Fraction(sense, 4) if along == "y" else Fraction(0)
                terms.append(factor * self._wave(start - quarter))
                continue
            bore = 2 * sp.pi * sp.Rational(*direction)
            component = sp.cos(bore) if along == "x" else sp.sin(bore)
            terms.append(component * factor * self._wave(-lag))
        return (*terms, *of_loads)

    def _over_angle(self, phasor: Expression) -> Expression:
        """Return what a load's phasor makes over the crank angle."""
        sp = optional.library("sympy")
        return sp.re(phasor * sp.exp(sp.I * self.order * self.theta), evaluate=False)

    def _wave(self, turns: Fraction) -> Expression:
        """Return cos(nθ + phase) unevaluated: SymPy would turn some into sines."""
        sp = optional.library("sympy")
        lag = -turns % 1
        phase = 2 * sp.pi * sp.Rational(lag.numerator, lag.denominator)
        return sp.cos(self.order * self.theta - phase, evaluate=False)

    def _sum(self, axis: str) -> Expression:
        sp = optional.library("sympy")
        real, imaginary = self._parts_of(axis)
        angle = self.order * self.theta
        pistons = (real * sp.cos(angle) - imaginary * sp.sin(angle)) * self._unit
        loads = range(len(self.loads))
        return pistons + sum(self._over_angle(self._of_load(k, axis)) for k in loads)

    # --- text -----------------------------------------------------------------------------------

    @property
    def units_text(self) -> str:
        """Values of the symbols F and a for this engine."""
        cylinder = self.engine.cylinders[self.unit_cylinder - 1]
        scale = cylinder.reciprocating_mass * cylinder.crank_radius
        factor = scale * complex(cylinder.harmonics(self.order)[0])
        order = str(self.order).translate(SUBSCRIPTS)
        converted = units.convert("kg·m")
        factor *= converted.factor
        value = f"{factor.real:.6g}"
        if factor.imag:
            value = f"({value} {'-' if factor.imag < 0 else '+'} {abs(factor.imag):.6g}i)"
        text = f"F = m·r·a{order}·ω² = {value} {converted.unit}·ω² of cylinder {self.unit_cylinder}"
        if factor != abs(factor):
            text += " (in lengths its size)"
        if self.quantity == "moment" and self.spacing:
            text += f", a = {units.shown(units.figure(1e3 * self.spacing, 'mm', 6))}"
        for k, load in enumerate(self.loads, 1):
            text += f", P{k} of the load {labels.one_line(load.name)}"
            if self.quantity == "moment":
                place = 1e3 * (load.z - self.reference_z)
                text += f", b{k} = {units.shown(units.figure(place, 'mm', 6))}"
        return text

    @property
    def table(self) -> Table:
        """Expressions as text: of the components, and of the longest vector."""
        rows = [(axis, str(getattr(self, axis))) for axis in COMPONENTS]
        rows.append(("longest", str(self.peak)))
        title = f"{labels.name_of(self.engine)}: {QUANTITIES[self.quantity].words}"
        note = f"where {self.units_text}"
        return Table.from_rows(
            f"{title} of order {self.order}", ["part", "expression"], rows, note=note
        )

    def __repr__(self) -> str:
        """Return the formulas: they are no table of numbers."""
        table = self.table
        lines = [f"{part:>9} {text}" for part, text in table.cells()]
        return "\n".join([table.title, *lines, f"{'where':>9} {self.units_text}"])

    def _repr_html_(self) -> None:
        """Return None, so that notebooks typeset the formulas."""

    def _repr_latex_(self) -> str:
        sp = optional.library("sympy")
        letter = "F" if self.quantity == "force" else "M"
        rows = []
        for axis in ("x", "y"):
            terms = [term for term in getattr(self, f"{axis}_terms") if term != 0]
            rows += _rows(f"{letter}_{axis}", [sp.latex(term) for term in terms])
            if terms:
                rows.append(f"&= {sp.latex(getattr(self, f'{axis}_sum'))}")
        rows.append(rf"\max |{letter}| &= {sp.latex(self.peak)}")
        from crankpin._support import latex  # noqa: PLC0415 - few forms are printed as LaTeX

        rows.append(f"&{latex.in_mathematics(self.units_text)}")
        body = " \\\\ ".join(rows)
        return rf"$\displaystyle \begin{{aligned}} {body} \end{{aligned}}$"


SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")

PER_ROW = 4
"""Cylinders to a row of a derivation, so that rows fit a page."""


def _rows(name: str, terms: list[str]) -> list[str]:
    """Return the lines of an aligned sum."""
    if not terms:
        return [f"{name} &= 0"]
    text = [term if k == 0 or term.startswith("-") else f"+{term}" for k, term in enumerate(terms)]
    lines = ["".join(text[k : k + PER_ROW]) for k in range(0, len(text), PER_ROW)]
    return [f"{name} &= {lines[0]}", *(rf"&\quad {line}" for line in lines[1:])]
