"""Contribution of each cylinder, counterweight and balance shaft to a balance."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support.quantities import PLANE_VECTORS
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.balance import Balance


class Contribution(NamedTuple):
    """Contribution of one part of an engine to a quantity, order by order."""

    part: str
    """``"1"``, ``"2"``, … for cylinders, ``"W1"``, … for counterweights, ``"S1"``, … for shafts,
    ``"L1"``, … for periodic loads."""
    group: str
    """The cylinder's bank as the engine names it, ``"counterweights"``, ``"balance shafts"`` or
    ``"loads"``."""
    phasors: NDArray[np.complex128]
    """Forward and backward parts of force or moment, N or N·m: (2, n_orders); the phasors of a
    torque, N·m: (1, n_orders)."""
    zero_bound: NDArray[np.float64]
    """Largest rounding error of each order, N or N·m: (n_orders,)."""


def contributions(whole: Balance, quantity: str) -> list[Contribution]:
    """Return what each part of an engine adds to a quantity of its balance; they sum to it.

    About the same point, and of the same orders; a cylinder's rotating mass counts with it.
    """
    engine, request = whole.engine, whole._request
    request.check(quantity)
    terms = _core.terms(
        engine_core(engine),
        whole.rpm,
        whole.orders,
        whole.reference_z,
        request.pairs,
        request.torque,
        request.aside,
    )
    banks = {number: name for name, numbers in engine.banks.items() for number in numbers}
    parts = []
    for kind, index, part in terms:
        name, group = str(index + 1), banks.get(index + 1, "")
        if kind == "counterweight":
            name, group = f"W{name}", "counterweights"
        elif kind == "shaft":
            name, group = f"S{name}", "balance shafts"
        elif kind == "load":
            name, group = f"L{name}", "loads"
        vectors = part.phasors(quantity, quantity in PLANE_VECTORS)
        by_order = vectors.T if vectors.ndim == 2 else vectors[np.newaxis]
        parts.append(Contribution(name, group, by_order, part.zero_bound(quantity)))
    return parts


def of_cylinders(whole: Balance, torque: str) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Return a torque that each cylinder makes, by order, and the bounds of its rounding errors.

    Both of shape (n_cylinders, n_orders).
    """
    parts = contributions(whole, torque)[: len(whole.engine)]
    return (
        np.concatenate([part.phasors for part in parts]),
        np.stack([part.zero_bound for part in parts]),
    )


def phasors(result: Balance, quantity: str) -> NDArray[np.complex128]:
    """Return the parts of a balance's quantity, as of a :class:`Contribution`."""
    values = getattr(result, quantity)
    if quantity in PLANE_VECTORS:
        return np.stack([values.forward, values.backward])
    return np.asarray(values)[np.newaxis]
