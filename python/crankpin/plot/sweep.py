"""Sweeps: the picture of each kind, chosen by the swept dimensions."""

from __future__ import annotations

from typing import Any

from crankpin._core import InputError
from crankpin._support import inputs
from crankpin.analysis.sweeps.sweep import Sweep
from crankpin.plot.axes import check_one_place
from crankpin.plot.bars import bars
from crankpin.plot.curves import curves
from crankpin.plot.dispatch import draw
from crankpin.plot.maps import heat_map, order_map
from crankpin.plot.parts import parts
from crankpin.plot.style import MOST_TOLD_APART

KINDS = {
    "curves": curves,
    "parts": parts,
    "map": heat_map,
    "orders": order_map,
    "bars": bars,
}


@draw.register(Sweep)
def _sweep(
    result: Sweep,
    ax: Any = None,  # noqa: ANN401 - checked
    *,
    figure: Any = None,  # noqa: ANN401 - checked
    kind: str | None = None,
    x: str | None = None,
    **options: Any,  # noqa: ANN401 - of the kind
) -> Any:  # noqa: ANN401 - axes, or an array of axes
    check_one_place(ax, figure)
    if options.get("quantity", "") is None:
        del options["quantity"]  # each kind has its own default
    if not result.coords:
        raise InputError("nothing was swept: give an array, such as bank_angle_deg=[60, 75, 90]")
    if x is not None and x not in result.coords:
        names = ", ".join(result.coords)
        raise InputError(f"x = {inputs.shorten(x)} is not a swept dimension; choose from: {names}")
    chosen = _chosen(result, x) if kind is None else inputs.one_of("kind", kind, KINDS)
    if chosen == "bars":
        if x is not None:
            raise InputError(f'x = {x!r} has no meaning for kind="bars"; leave it out')
        return bars(result, ax, figure, **options)
    return KINDS[chosen](result, ax, figure, x=x, **options)


def _chosen(sweep: Sweep, x: str | None) -> str:
    """Return the kind of picture that shows a sweep best."""
    lengths = [len(values) for dim, values in sweep.coords.items() if dim != "engine"]
    if not lengths and x is None:
        return "bars"
    if x is None and len(lengths) == 2 and "engine" not in sweep.coords:
        return "map" if min(lengths) > MOST_TOLD_APART else "curves"
    return "curves"
