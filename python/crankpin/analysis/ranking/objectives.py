"""Objectives of a ranking: a number for an engine at a bank angle; the smallest is best."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from operator import attrgetter
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from crankpin._support import inputs
from crankpin._support.quantities import PART_WORDS, PLANE_VECTORS, QUANTITIES, kind_of
from crankpin.analysis.balance import Balance, balance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.sweeps.sweep import Sweep

Measure: TypeAlias = Callable[[Balance], float]
"""A user's objective."""

MOST_CYLINDERS_FIRING = 8
"""Cylinders up to which a table has the unevenness of firing, which takes all firing orders."""


LEFT = " (what the best counterweight leaves)"
"""Note on the backward part of order 1, if no crank turns against the main one."""


class Objective(NamedTuple):
    """A number for an engine at a bank angle; the smallest is best."""

    label: str
    """Name, as given."""
    head: str
    """Head of its column."""
    words: str
    """Description."""
    unit: str
    of_sweep: Callable[[Sweep], NDArray[np.float64]] | None = None
    """Computes it from a sweep of several engines at one speed: (n_engines, …)."""
    of_balance: Measure | None = None
    """Computation for one engine at one bank angle, if ``of_sweep`` is None."""
    order: Order | None = None
    """The order that it reads."""
    quantity: str = ""
    """``"force"``, ``"torque.gas"`` or another name of the registry; empty for a function."""
    what: str = ""
    """``"peak"``, ``"peak_xy"``, ``"forward"`` or ``"backward"``; empty for a function."""

    def values(self, swept: Sweep) -> NDArray[np.float64]:
        """Return the value of each engine at each bank angle: (n_engines, n_angles)."""
        if self.order is not None and self.order not in swept.orders:
            if swept._request.orders is not None:
                hint = f'by = "{self.label}" needs order {self.order}'
                raise inputs.rejected("orders", list(swept.orders), hint)
            # Left out as negligible, or zero.
            swept = swept._at_orders((self.order,))
        if self.of_sweep is not None:
            values = np.array(self.of_sweep(swept)).reshape(len(swept.engines), -1)
        else:
            rows = [[self._value(balance) for balance in row] for row in balances(swept)]
            values = np.array(rows, dtype=np.float64)
        values.setflags(write=False)
        return values

    @property
    def of_function(self) -> bool:
        """True if a function given computes it."""
        return self.words.endswith(FUNCTION_GIVEN)

    def bare(self) -> Objective:
        """Return the objective without its functions, so that it can be pickled and compared."""
        return self._replace(of_sweep=None, of_balance=None)

    def _value(self, balance: Balance) -> float:
        assert self.of_balance is not None  # noqa: S101 - one of the two is there
        value = inputs.number("by", self.of_balance(balance))
        if value == -np.inf:
            raise inputs.rejected(
                "by", value, "return finite numbers, or inf for an engine to avoid"
            )
        return value


class ByObjectives:
    """Mixin of results that are sorted by objectives."""

    if TYPE_CHECKING:
        objectives: tuple[Objective, ...]

    @property
    def by(self) -> tuple[str, ...]:
        """Names of the objectives."""
        return tuple(objective.label for objective in self.objectives)

    @property
    def unit(self) -> str:
        """Unit of the first objective; empty where it is a function."""
        return self.objectives[0].unit

    @property
    def _of_torque(self) -> bool:
        """True if gas pressure could matter: to a torque, or to what a function reads."""
        return any(
            "torque" in objective.quantity or objective.of_function for objective in self.objectives
        )

    def _minimised(self, count: int | None, *, with_orders: bool) -> str:
        """Return the objectives, all or the first few, in words; with the orders as given."""
        words = ", then ".join(objective.words for objective in self.objectives[:count])
        return words.replace("all orders", "all of the orders given") if with_orders else words


def tie_tolerance(tie_rtol: object) -> float:
    """Return the relative difference up to which objectives are equal."""
    tolerance = inputs.number("tie_rtol", tie_rtol)
    if not 0.0 <= tolerance < 1.0:
        raise inputs.rejected("tie_rtol", tie_rtol, "give 0 or more, less than 1")
    return tolerance


def balances(swept: Sweep) -> Iterator[Iterator[Balance]]:
    """Yield the balances of each engine at each bank angle."""
    angles = swept.coords.get("bank_angle_deg")
    request, hold = swept._request, swept.hold
    chosen = {"orders": swept.orders} if swept.orders else {"rtol": request.rtol}
    for engine in swept.engines:
        turned = (
            [engine]
            if angles is None or hold is None
            else (engine.with_bank_angle(float(angle), hold=hold) for angle in angles)
        )
        yield (
            balance(
                result,
                swept.fixed["rpm"],
                spectrum=request.spectrum,
                torque=request.torque,
                **chosen,
            )
            for result in turned
        )


# --- by name ------------------------------------------------------------------------------------

FUNCTION_GIVEN = ", a function given"
"""End of the words of an objective that is a function."""

COMMON = (
    "total.moment.peak",
    "total.force.peak",
    "total.moment.peak_xy",
    "total.force.peak_xy",
    "total.torque.peak",
    "total.crank_torque.peak",
    "[1].moment.backward",
    "[1].force.backward",
    "[2].moment.peak",
    "unevenness_deg",
)
"""Names of objectives; any order may take the place of 1 and 2, a part as torque.gas of torque."""
_PATH = re.compile(
    r"(?:total|\[([1-9][0-9]{0,8}(?:\.[05])?|0\.5)\])"
    rf"\.(?:({'|'.join(PLANE_VECTORS)})\.(peak|peak_xy|forward|backward)"
    rf"|((?:{'|'.join(name for name in QUANTITIES if name not in PLANE_VECTORS)})"
    rf"(?:\.(?:{'|'.join(PART_WORDS)}))?)\.(peak))"
)

_ORDER_LAST = re.compile(rf"({'|'.join(QUANTITIES)})(\[[^]]*\])(\..*)")


def named(label: str, argument: str = "by") -> Objective:
    """Return the objective of this name."""
    if label == "unevenness_deg":
        words = "root mean square difference of the firing intervals from equal ones"
        return Objective(label, "firing unevenness", words, "°", of_balance=_unevenness)
    # As of results, moment[1] is [1].moment.
    match = _PATH.fullmatch(_ORDER_LAST.sub(r"\2.\1\3", label))
    if not match or (match[1] is None and match[3] in ("forward", "backward")):
        inputs.one_of(argument, label, COMMON)
    assert match is not None  # noqa: S101 - else rejected above
    order = None if match[1] is None else inputs.order(float(match[1]))
    quantity, what = match[2] or match[4], match[3] or match[5]
    name = kind_of(quantity).words
    head = f"{'total' if order is None else f'order-{order}'} {name}"
    head += {"peak": "", "peak_xy": " along x or y"}.get(what, f", {what}")
    sort = {
        "peak": "longest" if kind_of(quantity).planar else "largest",
        "peak_xy": "larger peak along (about) x and y of",
        "forward": "forward part of",
        "backward": "backward part of",
    }[what]
    words = f"{sort} {name}, " + ("all orders" if order is None else f"order {order}")
    if (what, order) == ("backward", 1):
        words += LEFT

    def of_sweep(swept: Sweep) -> NDArray[np.float64]:
        source = swept.total if order is None else swept[order]
        values = np.abs(attrgetter(f"{quantity}.{what}")(source))
        return np.asarray(values.max(axis=-1) if what == "peak_xy" else values)

    kind = kind_of(quantity)
    return Objective(label, head, words, kind.unit, of_sweep, None, order, quantity, what)


def of_table(swept: Sweep) -> list[Objective]:
    """Return the objectives of a table of trade-offs, those that need no further argument."""
    names = [
        f"{path[0]}.{quantity}.{path[1]}"
        for quantity in ("moment", "force")
        for path in (("total", "peak"), ("[1]", "backward"), ("[2]", "peak"))
    ]
    if "torque" in swept._request.quantities:
        names.append("total.torque.peak")
    if all(len(engine) <= MOST_CYLINDERS_FIRING for engine in swept.engines):
        names.append("unevenness_deg")
    orders = swept._request.orders
    return [
        objective
        for objective in map(named, names)
        if orders is None or objective.order in (None, *orders)
    ]


def _unevenness(balance: Balance) -> float:
    return balance.engine.firing_orders()[0].unevenness_deg


# --- by function --------------------------------------------------------------------------------


def listed(by: object, argument: str = "by") -> list[Objective]:
    """Return the objectives that names and functions give."""
    if by is None:
        some = ", ".join(f'"{name}"' for name in COMMON[:6])
        hint = f"give the quantity to minimise, such as {some}, or a function of a Balance"
        raise inputs.rejected(argument, by, hint)
    if isinstance(by, str):
        by = [name.strip() for name in by.split(",")]
    elif callable(by):
        by = [by]
    hint = f"give a name ({', '.join(COMMON)}), a function of a Balance, or a list of these"
    objectives: list[Objective] = []
    for objective in inputs.items(argument, by, hint):
        if isinstance(objective, str):
            objectives.append(named(objective, argument))
        elif callable(objective):
            label = _free(objective, objectives)
            words = f"{label}{FUNCTION_GIVEN}"
            objectives.append(Objective(label, label, words, "", of_balance=objective))
        else:
            raise inputs.rejected(argument, objective, hint)
    if not objectives:
        raise inputs.rejected(argument, by, hint)
    twice = {
        objective.label
        for objective in objectives
        if [one.label for one in objectives].count(objective.label) > 1
    }
    if twice:
        raise inputs.rejected(argument, by, f"{min(twice)} is given twice; give it once")
    return objectives


def _free(function: object, taken: list[Objective]) -> str:
    """Return a name for the column of a function that no other column has."""
    name = str(getattr(function, "__name__", ""))
    name = name if name.isidentifier() else "objective"
    used = {"unevenness_deg", "engine", "bank_angle_deg", *(objective.label for objective in taken)}
    if name not in used:
        return name
    return next(new for k in range(2, 10**6) if (new := f"{name}_{k}") not in used)
