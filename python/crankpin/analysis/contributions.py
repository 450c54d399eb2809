"""What each cylinder, counterweight and balance shaft adds to a balance."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support.quantities import PLANE_VECTORS
from crankpin._support.record import changed
from crankpin.analysis.balance import Balance
from crankpin.analysis.request import engine_core
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray


class Contribution(NamedTuple):
    """What one part of an engine adds to a quantity, order by order."""

    part: str
    """``"1"``, ``"2"``, … for cylinders, ``"W1"``, … for counterweights, ``"S1"``, … for shafts."""
    group: str
    """The cylinder's bank as the engine names it, ``"counterweights"`` or ``"balance shafts"``."""
    phasors: NDArray[np.complex128]
    """Forward and backward parts of force or moment, N or N·m: (2, n_orders); the phasors of a
    torque, N·m: (1, n_orders)."""


def contributions(whole: Balance, quantity: str) -> list[Contribution]:
    """Return what each part of an engine adds to a quantity of its balance; they sum to it.

    Each is the balance of an engine that has this part alone, at the same place, about the same
    reference plane. A cylinder's rotating mass counts with it.
    """
    given = changed(whole.request, orders=whole.orders, reference_z=whole.reference_z)
    found = []
    for part, group, alone in _parts(whole.engine):
        # A spectrum is that of a cylinder.
        pairs = given.pairs if part.isdigit() else None
        result = Balance(alone, whole.rpm, changed(given, pairs=pairs))
        found.append(Contribution(part, group, phasors(result, quantity)))
    return found


def phasors(result: Balance, quantity: str) -> NDArray[np.complex128]:
    """Return the parts of a balance's quantity, as of a :class:`Contribution`."""
    found = getattr(result, quantity)
    if quantity in PLANE_VECTORS:
        return np.stack([found.forward, found.backward])
    return np.asarray(found)[np.newaxis]


def _parts(engine: Engine) -> Iterator[tuple[str, str, Engine]]:
    """Yield each part's name and group, and an engine with it alone."""
    banks = {number: name for name, numbers in engine.banks.items() for number in numbers}
    core = engine_core(engine)
    tdc, bore = core.exact_angles
    z, rotating = core.z.tolist(), core.rotating_mass.tolist()
    # Made of the core's own lists: they were checked, and warned of, when the engine was made.
    for k, parts in enumerate(core.cylinders):
        alone = _core.Engine.from_lists(
            [parts], [tdc[k]], None, [bore[k]], None, [z[k]], [rotating[k]], "", ""
        )
        alone = alone.keeping([core.details[k]], [], None).fired_as(core, [k])
        yield str(k + 1), banks[k + 1], Engine(alone)
    # Counterweights follow crankpins: those of cylinders without masses.
    massless = [
        (radius, length, 0.0, offset, 0.0) for radius, length, _, offset, _ in core.cylinders
    ]
    zeros = [0.0] * len(massless)
    bare = Engine(_core.Engine.from_lists(massless, tdc, None, bore, core.bank, z, zeros, "", ""))
    for k, weight in enumerate(engine.counterweights, start=1):
        yield f"W{k}", "counterweights", bare.with_counterweights([weight])
    for k, shaft in enumerate(engine.shafts, start=1):
        yield f"S{k}", "balance shafts", bare.with_shafts([shaft])
