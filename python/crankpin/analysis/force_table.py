"""The table of forces of an engine, as its maker prints it for the designer of a foundation."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import suppressed
from crankpin._support.record import changed
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.guide_moments import guide_moments
from crankpin.analysis.request import engine_core
from crankpin.analysis.torsional_excitation import GAS_AND_INERTIA, HIGHEST, orders_up_to
from crankpin.model import checks
from crankpin.model.forces import SCALINGS, ForceTable

if TYPE_CHECKING:
    from crankpin._support.inputs import Orders
    from crankpin.model.engine import Engine

FARTHEST = 1e9
"""Distance of a plane, m, beyond which moments are rejected."""
SCALING_OF = dict(zip(GAS_AND_INERTIA, reversed(SCALINGS), strict=True))
"""Part of a guide-force moment → what it does as the speed changes."""


def force_table(
    engine: Engine, rpm: float, *, orders: Orders = "auto", reference_z: float | None = None
) -> ForceTable:
    """Return the forces and moments of an engine at a speed as its maker prints them.

    Free forces and couples, vertical and horizontal, and guide-force moments of H and X type, order
    by order with phases: M1V, M1H, M2V, H6, X3. What grows with the square of the speed and what
    does not are apart; loads tabulated over speed are rejected.

    Parameters
    ----------
    engine : Engine
        The engine, with its cycle, shafts and counterweights.
    rpm : float
        Crank speed, rpm.
    orders : number, sequence of numbers or "auto", default "auto"
        Multiples of crank speed, halves too; ``"auto"`` for all up to 12, or to twice the number of
        cylinders where that is more, as of :func:`crankpin.guide_moments`.
    reference_z : float, optional
        Plane about which couples and the X-type bimoment are, m; by default the engine's own.

    Returns
    -------
    ForceTable
        The table, about the crank's axis in that plane.

    Raises
    ------
    InputError
        If an argument is out of range, or a load is tabulated over speed.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, as with lengths in millimetres.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.force_table(cp.Engine.preset("i4"), rpm=3000, orders=[2])
    Inline-4 at 3000 rpm: forces and moments about (0, 0, 0.15) m
    name  order  amplitude  unit  phase °  over speed      rpm  about
    F2V       2    2.31735  kN          0  speed squared  3000  0 0 0.15
    H2        2   0.164327  kN·m      -90  speed squared  3000  0 0 0.15
    Order n is amplitude·cos(n·θ + phase), θ the crank angle.
    """
    core = engine_core(engine)
    wanted = inputs.half_orders(orders)
    if wanted is None:
        chosen = orders_up_to(engine, max(HIGHEST, 2 * len(engine)))
        wanted = inputs.explicit_half_orders(chosen)
    speed = inputs.positive("rpm", rpm)
    plane = engine.reference_z
    if reference_z is not None:
        plane = inputs.finite("reference_z", reference_z)
        checks.place(core, "reference_z", plane)
    if abs(plane) > FARTHEST:
        raise inputs.rejected("reference_z", plane, f"give metres, at most {FARTHEST:g}")
    inputs.warn_of_units(mean_piston_speed(engine, speed))
    try:
        found = json.loads(_core.force_table(core, speed, wanted, (0.0, 0.0, plane)))
    except _core.InputError as error:
        if error.argument == "speed_squared" and error.value == "none":
            hint = "no force or moment of the engine is of these orders"
            raise inputs.rejected("orders", orders, hint) from None
        if (error.argument or "").startswith(("speed_squared", "independent", "about")):
            name, value = ("rpm", rpm) if reference_z is None else ("reference_z", reference_z)
            raise inputs.rejected(name, value, "forces or moments are too large") from None
        raise
    table = ForceTable._of(found | {"name": engine.title})
    rows: dict[str, dict[Any, list[complex]]] = {
        scaling: {n: list(values) for n, values in _of(table, scaling).items()}
        for scaling in SCALINGS
    }
    with suppressed():
        guide = guide_moments(engine, speed, orders=wanted, reference_z=plane)
    for part, scaling in SCALING_OF.items():
        of_part = guide.read(f"x_bimoment.{part}")
        for order, bimoment in zip(guide.orders, of_part.tolist(), strict=True):
            if bimoment:
                rows[scaling].setdefault(order, [0j] * 7)[6] = bimoment
    return changed(table, **{s.replace(" ", "_"): rows[s] for s in SCALINGS})


def _of(table: ForceTable, scaling: str) -> Any:  # noqa: ANN401 - a mapping of amplitudes
    return getattr(table, scaling.replace(" ", "_"))
