"""Rows of a sweep's picture: all orders together, then the largest ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.sweeps.sweep import engine_titles
from crankpin.plot.words import joined, loads_of, numbers, short_names

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.by_order import ByOrder
    from crankpin.analysis.sweeps.sweep import Sweep

MOST_ORDERS_DRAWN = 4
"""Number of orders in a picture."""


def given_orders(orders: object) -> list[Order]:
    """Return orders that are to be drawn, one at least."""
    if chosen := inputs.explicit_half_orders(orders):
        return chosen
    raise inputs.rejected("orders", [], "give at least one order, such as [1, 2]")


def largest(result: ByOrder, quantity: str, most: int = MOST_ORDERS_DRAWN) -> tuple[list[int], str]:
    """Return places of the largest orders, ascending, and a note of the others, if not zero."""
    count = len(result.orders)
    peaks = (
        result.read(quantity, "peak").reshape(-1, max(1, count)).max(axis=0, initial=0.0)[:count]
    )
    by_size = np.argsort(-peaks, kind="stable")
    chosen = [
        place for place in by_size[:most] if peaks[place] > labels.MATTERS * peaks.max(initial=0.0)
    ]
    rest = [result.orders[place] for place in by_size if peaks[place] > 0.0 and place not in chosen]
    rest_text = labels.orders_text(sorted(rest), labels.MOST_LISTED)
    note = f"smaller, not shown: {rest_text}" if rest else ""
    return sorted(int(place) for place in chosen), note


class Row(NamedTuple):
    """Peaks in a row of panels."""

    name: str
    """``all orders``, or the order."""
    peaks: NDArray[np.float64]
    """Peaks along each component, or the largest magnitude: (…, columns)."""


class Rows(NamedTuple):
    """Rows of a picture, what their columns are, and a note of the orders left out."""

    rows: list[Row]
    columns: tuple[str, ...]
    note: str


def rows_of(sweep: Sweep, quantity: str, orders: object = None, *, single: bool = False) -> Rows:
    """Return the rows of a sweep's picture.

    By default all orders together and the three largest ones; with ``orders`` given a row for each
    of them. With ``single`` the largest magnitude of all orders, or of the one given.
    """
    planar = quantity in PLANE_VECTORS and not single

    def row(name: str, quantities: Any) -> Row:  # noqa: ANN401 - what has quantities
        vector = getattr(quantities, quantity)
        return Row(name, vector.peak_xy if planar else vector.peak[..., np.newaxis])

    def one(order: Order) -> Row:
        return row(f"order {order}", sweep[order])

    columns = QUANTITIES[quantity].components
    if single and quantity in PLANE_VECTORS:
        columns = ("longest vector",)
    if orders is not None:
        chosen = given_orders(orders)
        if single and len(chosen) > 1:
            raise inputs.rejected("orders", orders, "a single panel shows one order; give figure")
        return Rows([one(order) for order in chosen], columns, "")
    if len(sweep.orders) == 1:
        return Rows([one(sweep.orders[0])], columns, "")
    which = " given" if sweep._request.orders is not None else ""
    rows = [row(f"all orders{which}", sweep.total)]
    if single:
        return Rows(rows, columns, "")
    places, note = largest(sweep, quantity, MOST_ORDERS_DRAWN - 1)
    rows += [one(sweep.orders[place]) for place in places]
    return Rows(rows, columns, note)


# --- words --------------------------------------------------------------------------------------


class Words(NamedTuple):
    """Texts of a sweep's picture."""

    names: list[str]
    """Engines, without what they have in common."""
    common: str
    """End of the common words of the names, such as ``firing order``."""
    title: str
    parts: list[str]
    """Fixed or held quantities."""
    loads_counted: str
    """Loads that the sweep counts."""

    def subtitle(self, quantity: str) -> str:
        """Return the quantity, the arguments that are fixed or held, and the loads that count."""
        return joined(QUANTITIES[quantity].words, *self.parts, loads_of(self, quantity))


def words_of(sweep: Sweep) -> Words:
    """Return the words of a sweep's picture."""
    parts = [labels.value_text(dim, value) for dim, value in sweep.fixed.items()]
    if sweep.hold is not None:
        parts.append(labels.HELD[sweep.hold])
    full = engine_titles(sweep)
    if "engine" not in sweep.coords:
        return Words([], "", full[0], parts, sweep.loads_counted)
    names, shared = short_names(full)
    title, _, common = shared.rpartition(", ")
    if not title:
        title, common = common, ""
    title = title or f"{len(names)} engines"
    return Words(names, common, title, parts, sweep.loads_counted)


def values_of(sweep: Sweep, dim: str, words: Words) -> list[str]:
    """Return the values of a swept dimension as text with their unit, engines by name."""
    if dim == "engine":
        return words.names
    name, unit = labels.SWEPT[dim]
    texts = numbers(np.asarray(sweep.coords[dim], dtype=np.float64))
    return [f"{name} {text}{unit}".strip() for text in texts]


def dimension(dim: str) -> str:
    """Return the name of a swept dimension, with its unit, for an axis."""
    if dim in ("engine", "order"):
        return dim
    name, symbol = labels.SWEPT[dim]
    # Degrees stand at the numbers.
    return units.headed(name or "crank speed", symbol.strip(" °"))


def at(dim: str, value: float) -> str:
    """Return a value of a swept dimension as text, without its name."""
    (text,) = numbers([value])
    return f"{text}°" if dim.endswith("_deg") else text


def along_x(sweep: Sweep, x: str | None, among: Sequence[str] | None = None) -> str:
    """Return the dimension along the horizontal axis: the requested one, or the longest."""
    if x is not None:
        return x
    swept: dict[str, Any] = {dim: len(sweep.coords[dim]) for dim in among or sweep.coords}
    numeric = {dim: count for dim, count in swept.items() if dim != "engine"} or swept
    return max(numeric, key=lambda dim: numeric[dim])
