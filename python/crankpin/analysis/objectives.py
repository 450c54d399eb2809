"""What is to be least when engines are ranked: a number for an engine at a bank angle."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, tables
from crankpin.analysis.balance import Balance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.sweep import Sweep

Measure: TypeAlias = Callable[[Balance], float]
"""An objective of the user's own."""

MOST_CYLINDERS = 8
"""Cylinders up to which a table looks through all firing orders at every bank angle."""


class Objective(NamedTuple):
    """A number for an engine at a bank angle; the least is the best."""

    label: str
    """Its name, and the head of its column."""
    words: str
    """What it is."""
    unit: str
    of_sweep: Callable[[Sweep], NDArray[np.float64]] | None = None
    """Takes a sweep of several engines at one speed; (n_engines, …)."""
    of_balance: Measure | None = None
    """Where there is no such: takes one engine at one bank angle."""
    order: int | None = None
    """The order that has to be there."""

    def values(self, swept: Sweep) -> NDArray[np.float64]:
        """Return the value of each engine at each bank angle: (n_engines, n_angles)."""
        if self.order is not None and self.order not in swept.orders:
            given = inputs.shorten(list(swept.orders))
            raise InputError(f'orders = {given}: by = "{self.label}" takes order {self.order} too')
        if self.of_sweep is not None:
            found = self.of_sweep(swept).reshape(len(swept.engines), -1)
        else:
            rows = [[self._value(each) for each in row] for row in balances(swept)]
            found = np.array(rows, dtype=np.float64)
        found.setflags(write=False)
        return found

    def bare(self) -> Objective:
        """Return it without what measures it, so that it can be written and compared."""
        return self._replace(of_sweep=None, of_balance=None)

    def _value(self, balance: Balance) -> float:
        assert self.of_balance is not None  # noqa: S101 - one of the two is there
        value = inputs.number("by", self.of_balance(balance))
        if value == -np.inf:
            raise InputError("by = -inf: return finite numbers, inf for what is not to be chosen")
        return value


def balances(swept: Sweep) -> Iterator[Iterator[Balance]]:
    """Yield the balances of each engine at each bank angle."""
    angles = swept.coords.get("bank_angle_deg")
    how = {name: swept._arguments[name] for name in ("reference_z", "spectrum")}
    for engine in swept.engines:
        turned = (
            [engine]
            if angles is None
            else (engine.with_bank_angle(float(angle), hold=_hold(swept)) for angle in angles)
        )
        yield (each.balance(swept.fixed["rpm"], swept.orders, **how) for each in turned)


def _hold(swept: Sweep) -> Literal["pins", "firing"]:
    assert swept.hold is not None  # noqa: S101 - a sweep of bank angle says what it holds
    return swept.hold


# --- by name ------------------------------------------------------------------------------------

_KINDS: tuple[Literal["moment", "force"], ...] = ("moment", "force")
_OF_ONE_ORDER = re.compile("(?:(moment|force)_peak_vector|(torque)_peak)_([1-9][0-9]{0,4})")
KNOWN = (
    *(f"{kind}_{what}" for what in ("sum_peak_vector", "sum_peak_xy") for kind in _KINDS),
    "torque_sum_peak",
    *(f"{kind}_after_counterweight" for kind in _KINDS),
    "moment_peak_vector_2",
    "unevenness_deg",
)
"""Names, one of the second order standing for those of every order."""


def named(label: str) -> Objective:
    """Return the objective of this name."""
    if label == "unevenness_deg":
        words = "firing intervals, root mean square difference from equal ones"
        return Objective(label, words, "°", of_balance=_unevenness)
    if found := _OF_ONE_ORDER.fullmatch(label):
        kind, order = found[1] or found[2], int(found[3])
        words = f"longest {tables.NAMES[kind]} of order {order}"
        return Objective(label, words, tables.UNITS[kind], _one_order(kind, order), order=order)
    kind, _, what = inputs.one_of("by", label, KNOWN).partition("_")
    name, unit = tables.NAMES[kind], tables.UNITS[kind]
    if what == "after_counterweight":
        words = f"first-order {name} after the best counterweight"
        return Objective(label, words, unit, lambda swept: _backward(swept, kind), order=1)
    if what == "sum_peak_xy":
        words = f"largest {name} {'about' if kind == 'moment' else 'along'} x or y, all orders"
        return Objective(label, words, unit, lambda swept: getattr(swept, label).max(axis=-1))
    words = f"l{'arge' if kind == 'torque' else 'onge'}st {name}, all orders"
    return Objective(label, words, unit, lambda swept: getattr(swept, label))


def of_table(swept: Sweep) -> list[Objective]:
    """Return what a table of trade-offs shows: what there is without more being asked for."""
    labels = [
        f"{kind}_{what}"
        for kind in _KINDS
        for what in ("sum_peak_vector", "after_counterweight", "peak_vector_2")
    ]
    if swept._arguments["spectrum"] is None:
        labels.append("torque_sum_peak")
    if all(len(engine) <= MOST_CYLINDERS for engine in swept.engines):
        labels.append("unevenness_deg")
    return [each for each in map(named, labels) if each.order in (None, *swept.orders)]


def _one_order(kind: str, order: int) -> Callable[[Sweep], NDArray[np.float64]]:
    peaks = "torque_peak" if kind == "torque" else f"{kind}_peak_vector"
    return lambda swept: getattr(swept, peaks)[..., swept.orders.index(order)]


def _backward(swept: Sweep, kind: str) -> NDArray[np.float64]:
    """First-order part that turns against the crank; zero where that is rounding's."""
    x, y = np.moveaxis(getattr(swept, kind)[..., swept.orders.index(1), :], -1, 0)
    size = np.abs(x - 1j * y) / 2.0
    how = {name: swept._arguments[name] for name in ("reference_z", "spectrum")}
    alone = (engine.balance(swept.fixed["rpm"], [1], **how) for engine in swept.engines)
    bound = np.array([getattr(each, f"{kind}_zero_bound")[0] for each in alone])
    size[size <= bound.reshape(-1, *[1] * (size.ndim - 1))] = 0.0
    return np.asarray(size)


def _unevenness(balance: Balance) -> float:
    return balance.engine.firing_orders()[0].unevenness_deg


# --- by function --------------------------------------------------------------------------------


def listed(by: object) -> list[Objective]:
    """Return the objectives that names and functions stand for."""
    if isinstance(by, str) or callable(by):
        by = [by]
    cure = f"give a name ({', '.join(KNOWN)}), a function of a Balance, or a list of these"
    found: list[Objective] = []
    for each in inputs.items("by", by, cure):
        if isinstance(each, str):
            found.append(named(each))
        elif callable(each):
            label = _free(each, found)
            words = f"{label}, a function given"
            found.append(Objective(label, words, "", of_balance=each))
        else:
            raise InputError(f"by = {inputs.shorten(each)}: {cure}")
    if not found:
        raise InputError(f"by = {inputs.shorten(by)}: {cure}")
    twice = {each.label for each in found if [one.label for one in found].count(each.label) > 1}
    if twice:
        raise InputError(f"by = {inputs.shorten(by)}: {min(twice)} is given twice; give it once")
    return found


def _free(function: object, taken: list[Objective]) -> str:
    """Return a name for the column of a function that no other column has."""
    name = str(getattr(function, "__name__", ""))
    name = name if name.isidentifier() else "objective"
    used = {*KNOWN, "engine", "bank_angle_deg", *(each.label for each in taken)}
    used_too = _OF_ONE_ORDER.fullmatch(name)
    if name not in used and not used_too:
        return name
    return next(new for k in range(2, 10**6) if (new := f"{name}_{k}") not in used)
