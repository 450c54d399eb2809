"""Exact answers: which orders vanish, with proof, and what the others are in closed form."""

from __future__ import annotations

import html
import operator
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, tables
from crankpin._support.frozen import Frozen

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders
    from crankpin.model.engine import Engine

Expression: TypeAlias = Any
"""A SymPy expression; SymPy is imported when it is used."""

QUANTITIES = {
    "force_x": "F_x",
    "force_y": "F_y",
    "force_forward": "F fwd",
    "force_backward": "F back",
    "moment_x": "M_x",
    "moment_y": "M_y",
    "moment_forward": "M fwd",
    "moment_backward": "M back",
    "torque": "M_z",
}
"""Sums of one order, as the core counts them → how tables head them."""

AXES = ("x", "y", "forward", "backward")
"""Phasors of a closed form, as the core counts them."""


def _engine_core(engine: object) -> _core.Engine:
    core = getattr(engine, "core", None)
    if not isinstance(core, _core.Engine):
        raise InputError(f"engine = {inputs.shorten(engine)}: give a crankpin.Engine")
    return core


class VanishingOrders(Frozen):
    """Which sums of which orders are exactly zero, decided in integers.

    Of every order there are nine: force and moment along (about) x and y, their parts that turn
    with the crank and against it, and torque. Each is a sum of roots of unity with rational weights
    where angles are rational parts of a turn, and masses and places rational multiples of each
    other; it is zero if and only if the cyclotomic polynomial divides it, and that is a question of
    whole numbers. Places and masses are taken for such multiples (denominator up to 10 000) within
    four units in the last place: 0, 0.1, 0.2, 0.3 are equal steps, although 0.3 is not three times
    0.1 in binary.

    What is no rational multiple (a bank angle of 49.54°, the harmonic of another slider-crank)
    stands for itself: where several such parts are left, they may cancel or not, and the answer is
    ``undecided``, with ``obstacles`` to say why. ``within_rounding`` tells for each sum whether
    floating point finds it below what rounding can leave of zero, as in :class:`Balance`.

    Made by :meth:`Engine.vanishing_orders`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v = cp.Engine.preset("v8-crossplane").vanishing_orders(orders=[1, 2, 4])
    >>> v.of("force"), v.of("moment_backward")
    ((1, 2), (1, 2, 4))
    >>> v.order(1)["moment_forward"]
    'remains'
    >>> bool(v.undecided.any())
    False
    """

    engine: Engine
    """The engine."""
    orders: tuple[int, ...]
    """Multiples of crank speed."""
    reference_z: float | None
    """Plane about which moments are taken, m; None for midway between first and last cylinder."""
    quantities: tuple[str, ...]
    """Names of the nine sums, the columns of the tables below."""
    vanishes: NDArray[np.bool_]
    """Proved to be zero: (n_orders, 9)."""
    remains: NDArray[np.bool_]
    """Proved not to be zero: (n_orders, 9)."""
    undecided: NDArray[np.bool_]
    """Neither proved: (n_orders, 9)."""
    within_rounding: NDArray[np.bool_]
    """Zero as far as floating point can tell: (n_orders, 9)."""
    obstacles: tuple[str, ...]
    """Why sums are undecided; empty where none is."""

    def __init__(self, engine: Engine, orders: Orders, reference_z: float | None = None) -> None:
        core = _engine_core(engine)
        listed = inputs.explicit_orders(orders)
        plane = inputs.optional_number("reference_z", reference_z)
        vanishes, remains, within_rounding, obstacles = _core.vanishing(core, listed, plane)
        undecided = ~(vanishes | remains)
        undecided.setflags(write=False)
        self._set(
            engine=engine,
            orders=tuple(listed),
            reference_z=plane,
            quantities=tuple(QUANTITIES),
            vanishes=vanishes,
            remains=remains,
            undecided=undecided,
            within_rounding=within_rounding,
            obstacles=tuple(obstacles),
        )

    def of(self, quantity: str) -> tuple[int, ...]:
        """Return the orders in which a quantity is proved to vanish.

        Parameters
        ----------
        quantity
            One of ``quantities``, or ``"force"`` or ``"moment"`` for both directions.
        """
        names = [*self.quantities, "force", "moment"]
        name = inputs.one_of("quantity", quantity, names)
        wanted = [name] if name in self.quantities else [f"{name}_x", f"{name}_y"]
        columns = [self.quantities.index(each) for each in wanted]
        rows = self.vanishes[:, columns].tolist()
        return tuple(n for n, zeros in zip(self.orders, rows, strict=True) if all(zeros))

    def order(self, order: int) -> dict[str, str]:
        """Return what is known of one order: quantity → "vanishes", "remains" or "undecided".

        Raises
        ------
        InputError
            If the order was not asked for.
        """
        if not isinstance(order, (int, np.integer)) or order not in self.orders:
            listed = ", ".join(map(str, self.orders))
            cure = f"these answers are of orders {listed}"
            raise InputError(f"order = {inputs.shorten(order)}: {cure}")
        k = self.orders.index(order)
        return {name: self._verdict(k, column) for column, name in enumerate(self.quantities)}

    def to_pandas(self) -> pd.DataFrame:
        """Return the verdicts as a table of words, one row an order (needs pandas)."""
        pandas = tables.pandas()
        table: pd.DataFrame = pandas.DataFrame(
            [self.order(n) for n in self.orders], index=pandas.Index(self.orders, name="order")
        )
        return table

    def _verdict(self, k: int, column: int) -> str:
        if self.vanishes[k, column]:
            return "vanishes"
        return "remains" if self.remains[k, column] else "undecided"

    def _table(self) -> tables.Table:
        name = self.engine.name or f"{len(self.engine)} cylinders"
        title = f"{name}: 0 vanishes, ≠0 remains, both proved"
        if self.undecided.any():
            title += "; ?0 and ?≠0 undecided, as floating point has it"
        words = {"vanishes": "0", "remains": "≠0"}
        labels: list[list[str | float]] = []
        for k, order in enumerate(self.orders):
            cells: list[str | float] = [str(order)]
            for column in range(len(self.quantities)):
                guess = "?0" if self.within_rounding[k, column] else "?≠0"
                cells.append(words.get(self._verdict(k, column), guess))
            labels.append(cells)
        header = ["order", *QUANTITIES.values()]
        return tables.Table(title, header, labels, np.empty((len(labels), 0)))

    def __repr__(self) -> str:
        return "\n".join([self._table().text(), *self.obstacles])

    def _repr_html_(self) -> str:
        reasons = (f"<p>{html.escape(obstacle)}</p>" for obstacle in self.obstacles)
        return "".join([self._table().html(), *reasons])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, VanishingOrders):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        return (self.engine, self.orders, self.reference_z)

    def __reduce__(self) -> tuple[Any, ...]:
        return (VanishingOrders, self._key())


class ClosedForm(Frozen):
    """Force or moment of one order as SymPy expressions, exact.

    ``F`` stands for m·r·ω²·aₙ of the cylinder ``unit_cylinder`` (in magnitudes, for its size) and
    ``a`` for ``spacing``, of which all distances between cylinders are whole multiples. Phasors are
    those of :class:`Balance`: a quantity is ``Re(P exp(inθ))``, and ``x + iy = forward exp(inθ) +
    backward exp(−inθ)``. With a pin offset aₙ is complex, and ``backward`` goes with its conjugate.
    Angles of 15° and its multiples, among others, give radicals; the rest stay cosines.

    Made by :meth:`Engine.closed_form`; in Jupyter, the sum over the cylinders and what it comes to.

    Examples
    --------
    >>> import crankpin as cp
    >>> couple = cp.Engine.preset("v8-crossplane").closed_form(1)
    >>> couple.magnitude, couple.forward_phase
    (sqrt(10)*F*a, atan(2))
    """

    engine: Engine
    """The engine."""
    order: int
    """Multiple of crank speed."""
    quantity: str
    """"force" or "moment"."""
    reference_z: float | None
    """Plane about which moments are taken, m; None for midway between first and last cylinder."""
    unit_cylinder: int
    """Number of the cylinder whose force is F: the first that has reciprocating mass."""
    spacing: float
    """What ``a`` stands for, m; 0 where no lever enters."""

    def __init__(
        self,
        engine: Engine,
        order: int,
        quantity: str = "moment",
        reference_z: float | None = None,
    ) -> None:
        core = _engine_core(engine)
        (n,) = _one_order(order)
        word = inputs.one_of("quantity", quantity, ["force", "moment"])
        plane = inputs.optional_number("reference_z", reference_z)
        sp = tables.sympy()
        moment = word == "moment"
        unit, spacing, zero, parts, period, denominator, phasors = _core.closed_form(
            core, n, moment, plane
        )
        F, a = sp.Symbol("F", positive=True), sp.Symbol("a", positive=True)
        self._set(
            engine=engine,
            order=n,
            quantity=word,
            reference_z=plane,
            unit_cylinder=unit + 1,
            spacing=spacing,
            F=F,
            a=a,
            theta=sp.Symbol("theta", real=True),
            _unit=a * F if moment else F,
            _zero=zero,
            _parts=parts,
            _period=period,
            _denominator=denominator,
            _phasors=dict(zip(AXES, phasors, strict=True)),
        )

    F: Expression
    """Symbol for m·r·ω²·aₙ of one cylinder."""
    a: Expression
    """Symbol for the spacing."""
    theta: Expression
    """Symbol for the crank angle."""
    _unit: Expression
    _zero: bool
    _parts: list[Any]
    _period: int
    _denominator: int
    _phasors: dict[str, tuple[list[int], list[int], list[int]]]

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
    def x_magnitude(self) -> Expression:
        """Largest value along (about) x."""
        return self._size("x") * self._unit

    @cached_property
    def y_magnitude(self) -> Expression:
        """Largest value along (about) y."""
        return self._size("y") * self._unit

    @cached_property
    def forward_magnitude(self) -> Expression:
        """Size of the part that turns with the crank."""
        return self._size("forward") * self._unit

    @cached_property
    def backward_magnitude(self) -> Expression:
        """Size of the part that turns against the crank."""
        return self._size("backward") * self._unit

    @cached_property
    def magnitude(self) -> Expression:
        """Length of the longest vector: forward and backward parts in line."""
        sp = tables.sympy()
        return sp.expand(self._size("forward") + self._size("backward")) * self._unit

    @cached_property
    def forward_phase(self) -> Expression:
        """Direction of the forward part from +x at θ = 0; 0 where there is none."""
        return self._phase("forward")

    @cached_property
    def backward_phase(self) -> Expression:
        """Direction of the backward part from +x at θ = 0; 0 where there is none."""
        return self._phase("backward")

    # --- the sum over the cylinders -------------------------------------------------------------

    @cached_property
    def x_terms(self) -> tuple[Expression, ...]:
        """What each cylinder adds along (about) x: weight × cos(nθ − phase)."""
        return self._terms("x")

    @cached_property
    def y_terms(self) -> tuple[Expression, ...]:
        """What each cylinder adds along (about) y: weight × cos(nθ − phase)."""
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
        """Return the phasors "x", "y", "forward" and "backward" at a speed, N or N·m."""
        omega = inputs.angular_speed(rpm)
        cylinder = self.engine.cylinders[self.unit_cylinder - 1]
        scale = cylinder.reciprocating_mass * cylinder.crank_radius * omega**2
        unit = scale * complex(cylinder.harmonics(self.order)[0])
        if self.quantity == "moment":
            unit *= self.spacing
        found = {}
        for axis in AXES:
            real, imaginary = (complex(part.evalf(20)).real for part in self._parts_of(axis))
            factor = unit.conjugate() if axis == "backward" else unit
            found[axis] = complex(real, imaginary) * factor
        return found

    # --- how it is made -------------------------------------------------------------------------

    def _cosines(self, coefficients: list[int], denominator: int) -> Expression:
        """Σ cₖ 2cos(2πk/N), of radicals where SymPy knows them."""
        sp = tables.sympy()
        if self._zero:
            return sp.Integer(0)
        terms = [
            sp.Rational(c, denominator) * (2 * sp.cos(2 * sp.pi * k / self._period) if k else 1)
            for k, c in enumerate(coefficients)
            if c
        ]
        return sp.expand(sp.Add(*terms))

    def _parts_of(self, axis: str) -> tuple[Expression, Expression]:
        real, imaginary, _ = self._phasors[axis]
        return (
            self._cosines(real, self._denominator),
            self._cosines(imaginary, self._denominator),
        )

    def _phasor(self, axis: str) -> Expression:
        real, imaginary = self._parts_of(axis)
        return (real + tables.sympy().I * imaginary) * self._unit

    def _size(self, axis: str) -> Expression:
        sp = tables.sympy()
        square = self._cosines(self._phasors[axis][2], self._denominator**2)
        if square.has(sp.cos):
            return sp.sqrt(square)
        return sp.sqrtdenest(sp.sqrt(square))

    def _phase(self, axis: str) -> Expression:
        sp = tables.sympy()
        real, imaginary = self._parts_of(axis)
        if real == 0 or imaginary == 0:
            return sp.atan2(imaginary, real) if real != imaginary else sp.Integer(0)
        ratio = imaginary / real
        # Radicals of 2, 3 and 6 alone: dividing by them is cheap, and atan knows some values.
        if 24 % self._period == 0:
            ratio = sp.radsimp(ratio)
        if real.evalf() > 0:
            return sp.atan(ratio)
        return sp.atan(ratio) + (sp.pi if imaginary.evalf() > 0 else -sp.pi)

    def _terms(self, axis: str) -> tuple[Expression, ...]:
        sp = tables.sympy()
        if self._zero:
            return ()
        # The moment of a force about x comes from its part along y, and is negative.
        moment = self.quantity == "moment"
        along, sign = ("y" if axis == "x" else "x", -1) if moment else (axis, 1)
        if axis == "y":
            sign = 1
        found = []
        for weight, lever, rotating, bank, tdc in self._parts:
            factor = sign * sp.Rational(*lever) * self._unit
            bore = 2 * sp.pi * sp.Rational(*bank)
            direction = sp.cos(bore) if along == "x" else sp.sin(bore)
            term = (
                sp.Rational(*weight) * direction * factor * self._wave(-self.order * Fraction(*tdc))
            )
            if rotating[0]:
                # Along y a quarter of a turn later.
                pin = Fraction(*bank) - Fraction(*tdc) - (Fraction(1, 4) if along == "y" else 0)
                term += sp.Rational(*rotating) * factor * self._wave(pin)
            found.append(term)
        return tuple(found)

    def _wave(self, turns: Fraction) -> Expression:
        """cos(nθ + phase), written as it stands: SymPy would make sines of some."""
        sp = tables.sympy()
        lag = -turns % 1
        phase = 2 * sp.pi * sp.Rational(lag.numerator, lag.denominator)
        return sp.cos(self.order * self.theta - phase, evaluate=False)

    def _sum(self, axis: str) -> Expression:
        sp = tables.sympy()
        real, imaginary = self._parts_of(axis)
        angle = self.order * self.theta
        return (real * sp.cos(angle) - imaginary * sp.sin(angle)) * self._unit

    # --- text -----------------------------------------------------------------------------------

    def __repr__(self) -> str:
        name = self.engine.name or f"{len(self.engine)} cylinders"
        lines = [f"{name}: {tables.NAMES[self.quantity]} of order {self.order}"]
        lines += [f"{axis:>9} {getattr(self, axis)}" for axis in AXES]
        lines.append(f"{'longest':>9} {self.magnitude}")
        return "\n".join(lines)

    def _repr_latex_(self) -> str:
        sp = tables.sympy()
        letter = "F" if self.quantity == "force" else "M"
        rows = []
        for axis in ("x", "y"):
            terms = [term for term in getattr(self, f"{axis}_terms") if term != 0]
            rows += _rows(f"{letter}_{axis}", [sp.latex(term) for term in terms])
            if terms:
                rows.append(f"&= {sp.latex(getattr(self, f'{axis}_sum'))}")
        rows.append(rf"\max |{letter}| &= {sp.latex(self.magnitude)}")
        body = " \\\\ ".join(rows)
        return rf"$\displaystyle \begin{{aligned}} {body} \end{{aligned}}$"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ClosedForm):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        return (self.engine, self.order, self.quantity, self.reference_z)

    def __reduce__(self) -> tuple[Any, ...]:
        return (ClosedForm, self._key())


PER_ROW = 4
"""Cylinders to a row of a derivation: more do not fit a page."""


def _rows(name: str, terms: list[str]) -> list[str]:
    """Lines of an aligned sum."""
    if not terms:
        return [f"{name} &= 0"]
    text = [term if k == 0 or term.startswith("-") else f"+{term}" for k, term in enumerate(terms)]
    lines = ["".join(text[k : k + PER_ROW]) for k in range(0, len(text), PER_ROW)]
    return [f"{name} &= {lines[0]}", *(rf"&\quad {line}" for line in lines[1:])]


def _one_order(order: object) -> list[int]:
    """Return a single order, as a list."""
    try:
        return inputs.explicit_orders([operator.index(order)], "order")  # type: ignore[arg-type]
    except TypeError:
        cure = "give one whole multiple of crank speed, such as 1"
        raise InputError(f"order = {inputs.shorten(order)}: {cure}") from None
