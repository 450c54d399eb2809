"""Proofs of which orders of force, moment and torque vanish."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.frames import Tabled
from crankpin._support.quantities import COMPONENTS
from crankpin._support.record import AbsentError, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis import firing as fires
from crankpin.analysis.quantity import Keyed
from crankpin.analysis.request import engine_core
from crankpin.model import checks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin.model.engine import Engine


SUMS = {
    ("force", "x"): "F_x",
    ("force", "y"): "F_y",
    ("force", "forward"): "F fwd",
    ("force", "backward"): "F back",
    ("moment", "x"): "M_x",
    ("moment", "y"): "M_y",
    ("moment", "forward"): "M fwd",
    ("moment", "backward"): "M back",
    ("torque", "z"): "M_z",
    ("gas_torque", "z"): "gas",
}
"""Sums of one order (quantity and component), as the core counts them → heads of columns."""


def vanishing_orders(
    engine: Engine, orders: Orders = range(1, 13), *, reference_z: float | None = None
) -> VanishingOrders:
    """Return the vanishing orders; :meth:`Engine.vanishing_orders` documents the arguments."""
    chosen = tuple(inputs.explicit_half_orders(orders))
    plane = inputs.optional_number("reference_z", reference_z)
    checks.place(engine_core(engine), "reference_z", plane)
    return VanishingOrders(engine, chosen, plane)


class Verdicts(Keyed, Tabled):
    """Verdicts on a sum by order: "vanishes", "remains" or "undecided".

    A mapping from orders to verdicts; ``np.asarray`` makes an array of text. A force or moment
    vanishes where both components do, and has verdicts on its parts.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.Engine.preset("i4").vanishing_orders([1, 2]).force
    Verdicts
    order  verdict   x         y         forward   backward
        1  vanishes  vanishes  vanishes  vanishes  vanishes
        2  remains   vanishes  remains   remains   remains
    """

    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    words: tuple[str, ...]
    """Verdicts: (n_orders,)."""
    within_rounding: tuple[bool, ...]
    """True where floating point finds the sum below its rounding error: (n_orders,)."""
    parts: tuple[tuple[str, Verdicts], ...] = ()
    """Name and verdicts of each part of a force or moment."""

    @classmethod
    def _of_vector(cls, parts: dict[str, Verdicts]) -> Verdicts:
        """Return the verdicts on a force or moment of these parts."""
        x, y = parts["x"], parts["y"]
        pairs = list(zip(x.words, y.words, strict=True))
        words = (
            "remains" if "remains" in pair else "undecided" if "undecided" in pair else "vanishes"
            for pair in pairs
        )  # fmt: skip
        within = (a and b for a, b in zip(x.within_rounding, y.within_rounding, strict=True))
        return cls(x.orders, tuple(words), tuple(within), tuple(parts.items()))

    @property
    def x(self) -> Verdicts:
        """Verdicts of the component along (about) x."""
        return self._part("x")

    @property
    def y(self) -> Verdicts:
        """Verdicts of the component along (about) y."""
        return self._part("y")

    @property
    def forward(self) -> Verdicts:
        """Verdicts of the forward part."""
        return self._part("forward")

    @property
    def backward(self) -> Verdicts:
        """Verdicts of the backward part."""
        return self._part("backward")

    def _part(self, name: str) -> Verdicts:
        if not self.parts:
            hint = "give a force or a moment, which have parts"
            raise inputs.faulty(name, "is undefined for a single sum", hint, AbsentError)
        return dict(self.parts)[name]

    @property
    def vanishing(self) -> tuple[Order, ...]:
        """Orders in which the sum is proved to vanish."""
        return self._orders_with("vanishes")

    @property
    def remaining(self) -> tuple[Order, ...]:
        """Orders in which the sum is proved not to vanish."""
        return self._orders_with("remains")

    @property
    def undecided(self) -> tuple[Order, ...]:
        """Orders in which neither is proved."""
        return self._orders_with("undecided")

    def _orders_with(self, verdict: str) -> tuple[Order, ...]:
        return tuple(n for n, word in zip(self.orders, self.words, strict=True) if word == verdict)

    def __getitem__(self, order: Order) -> str:
        """Return the verdict on one order.

        Raises
        ------
        InputError
            If the order is not among ``orders``.
        """
        return self.words[self._place(order)]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:  # noqa: ANN401
        return np.array(self.words, dtype=dtype)

    @property
    def table(self) -> Table:
        """Table of the verdicts by order, and of those on the parts of a force or moment."""
        columns = [Column("order", self.orders, digits=10), Column("verdict", self.words)]
        columns += [Column(name, part.words) for name, part in self.parts]
        return Table("Verdicts", tuple(columns))


class VanishingOrders(Tabled):
    """Orders in which sums are exactly zero, decided in integers.

    Each order has ten sums: force and moment along (about) x and y, their parts that turn with the
    crank and against it, torque of inertia, and torque of gas of cylinders with one cycle. Inertia
    has half orders of shafts at half the speed alone; those of gas follow from the engine's firing
    order.

    Each is a sum of roots of unity with rational weights where angles are rational parts of a turn,
    and masses and positions rational multiples of each other; it is zero if and only if the
    cyclotomic polynomial divides it, which integers decide. Positions and masses are taken for such
    multiples (denominator up to 10 000) within four units in the last place: 0, 0.1, 0.2, 0.3 are
    equal steps, although 0.3 is not three times 0.1 in binary.

    A quantity with no rational relation to the others (an angle that is not rational, the harmonic
    of another slider-crank) is treated as an independent symbol: where several such symbols remain
    and their sum is too small for its value to be beyond any error of evaluation, they may cancel
    or not, and the verdict is "undecided"; ``obstacles`` lists the reasons.
    The bank angle of an arrangement of :func:`crankpin.search_arrangements` is exact too: doubles
    of it stand for the angle at which two sums of one size cancel. ``within_rounding`` is true
    where floating point finds a sum below its rounding error, as in :class:`Balance`.

    Made by :meth:`Engine.vanishing_orders`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v = cp.Engine.preset("v8-crossplane").vanishing_orders(orders=[1, 2, 4])
    >>> v.force.vanishing, v.moment.backward.vanishing
    ((1, 2), (1, 2, 4))
    >>> v.moment.forward[1]
    'remains'
    >>> bool(v.undecided.any())
    False

    Of an odd-fire V6 the gas leaves 1½ too:

    >>> odd = cp.Engine.preset("v6-90-odd-fire")
    >>> odd.vanishing_orders([0.5, 1, 1.5, 2, 2.5, 3]).gas_torque.remaining
    (1.5, 3)
    """

    engine: Engine
    """The engine."""
    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    plane: float | None
    """The reference plane that was given, m, or None."""
    vanishes: NDArray[np.bool_] = field(init=False, compare=False)
    """True where a sum is proved to be zero: (n_orders, 10)."""
    remains: NDArray[np.bool_] = field(init=False, compare=False)
    """True where a sum is proved not to be zero: (n_orders, 10)."""
    undecided: NDArray[np.bool_] = field(init=False, compare=False)
    """True where neither is proved: (n_orders, 10)."""
    within_rounding: NDArray[np.bool_] = field(init=False, compare=False)
    """True where floating point finds a sum below its rounding error: (n_orders, 10)."""
    obstacles: tuple[str, ...] = field(init=False, compare=False)
    """Reasons why sums are undecided; empty where none is."""

    def __post_init__(self) -> None:
        core, firing = engine_core(self.engine), None
        if any(order % 1 for order in self.orders) and not self.engine.fired:
            # An engine with cycles knows its firing; at whole orders a turn changes nothing.
            firing = fires.firing(self.engine, None, None)._core
        halves = [round(2 * order) for order in self.orders]
        proofs = _core.vanishing(core, halves, self.plane, firing)
        undecided = read_only(~(proofs["vanishes"] | proofs["remains"]))
        obstacles = tuple(proofs["obstacles"])
        self.__dict__.update(proofs, undecided=undecided, obstacles=obstacles)

    @property
    def sums(self) -> tuple[tuple[str, str], ...]:
        """Quantity and component of the ten sums, the columns of the tables."""
        return tuple(SUMS)

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        return self.engine.reference_z if self.plane is None else self.plane

    @property
    def force(self) -> Verdicts:
        """Shaking force: verdicts on the whole, and on x, y, forward and backward."""
        return Verdicts._of_vector({axis: self._verdicts("force", axis) for axis in COMPONENTS})

    @property
    def moment(self) -> Verdicts:
        """Rocking moment: verdicts on the whole, on x (pitch), y (yaw), forward and backward."""
        return Verdicts._of_vector({axis: self._verdicts("moment", axis) for axis in COMPONENTS})

    @property
    def torque(self) -> Verdicts:
        """Roll torque of inertia: verdicts."""
        return self._verdicts("torque", "z")

    @property
    def gas_torque(self) -> Verdicts:
        """Torque of gas: verdicts, of alike cylinders with one cycle; see also ``star_diagram``.

        Undecided where a cylinder is on a crank faster than the main one.
        """
        return self._verdicts("gas_torque", "z")

    def _verdicts(self, quantity: str, component: str) -> Verdicts:
        column = self.sums.index((quantity, component))
        words = tuple(self._word(k, column) for k in range(len(self.orders)))
        within = tuple(map(bool, self.within_rounding[:, column]))
        return Verdicts(self.orders, words, within)

    def _word(self, k: int, column: int) -> str:
        if self.vanishes[k, column]:
            return "vanishes"
        return "remains" if self.remains[k, column] else "undecided"

    # --- tables ---------------------------------------------------------------------------------

    def tidy(self, *quantities: str) -> Table:
        """Return the long form, a row for each order, quantity and component.

        Columns are order, quantity, component, verdict and within_rounding.

        Parameters
        ----------
        *quantities : str, optional
            ``"force"``, ``"moment"``, ``"torque"`` or ``"gas"``; by default all.

        Returns
        -------
        Table
            The rows; its ``to_pandas`` and ``to_csv`` write them.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        names = dict.fromkeys(quantity for quantity, _ in self.sums)
        chosen = [inputs.one_of("quantities", name, names) for name in quantities] or names
        rows = [
            (order, *sums, self._word(k, column), bool(self.within_rounding[k, column]))
            for k, order in enumerate(self.orders)
            for column, sums in enumerate(self.sums)
            if sums[0] in chosen
        ]
        heads = ("order", "quantity", "component", "verdict", "within_rounding")
        return Table.from_rows(f"{labels.name_of(self.engine)}: verdicts", heads, rows)

    @property
    def table(self) -> Table:
        """Table that is shown: a verdict for each order and sum."""
        name = labels.name_of(self.engine)
        title = f"{name}: 0 vanishes, ≠0 remains, both proved"
        if self.undecided.any():
            title += "; ?0 and ?≠0 undecided, with the finding of floating point"
        words = {"vanishes": "0", "remains": "≠0"}
        cells: list[list[str | float]] = []
        for k, order in enumerate(self.orders):
            row: list[str | float] = [str(order)]
            for column in range(len(self.sums)):
                guess = "?0" if self.within_rounding[k, column] else "?≠0"
                row.append(words.get(self._word(k, column), guess))
            cells.append(row)
        header, note = ["order", *SUMS.values()], "\n".join(self.obstacles)
        return Table.from_rows(title, header, cells, note=note)
