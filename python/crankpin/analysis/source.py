"""Arrays that quantities read, computed when they are first read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin._support import labels
from crankpin._support.frozen import Frozen
from crankpin._support.quantities import PLANE_VECTORS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.request import Request

TRAILING: dict[str, tuple[str, ...]] = {
    "phasors": ("order", "axis"),
    "forward": ("order",),
    "backward": ("order",),
    "zero_bound": ("order",),
    "peak": ("order",),
    "peak_xy": ("order", "axis"),
    "total_peak": (),
    "total_peak_xy": ("axis",),
}
"""Array of a plane vector → its dimensions after the swept ones; a scalar has no ``axis``."""


def arrays_of(quantity: str) -> dict[str, tuple[str, ...]]:
    """Return the arrays of a quantity, each with its dimensions after the swept ones."""
    if quantity in PLANE_VECTORS:
        return TRAILING
    return {
        what: tuple(dim for dim in dims if dim != "axis")
        for what, dims in TRAILING.items()
        if not what.endswith("_xy") and what not in ("forward", "backward")
    }


class ErrorBound(NamedTuple):
    """Upper bounds on what the omitted orders add to the length of a vector at any crank angle."""

    force: float
    """Of the shaking force, N."""
    moment: float
    """Of the rocking moment, N·m."""
    torque: float | None
    """Of roll and crank torque, N·m; None where torque is not available."""


class Source(Frozen):
    """Arrays of a result, computed when they are first read, and kept."""

    orders: tuple[int, ...]
    request: Request
    dims: tuple[str, ...] = ()
    """Swept dimensions."""

    @property
    def error_bound(self) -> ErrorBound:
        """Bounds on what the omitted orders add."""
        raise NotImplementedError

    def read(self, quantity: str, what: str) -> NDArray[Any]:
        """Return one of :func:`arrays_of` a quantity, read-only."""
        self.request.check(quantity)
        kept: dict[tuple[str, str], NDArray[Any]] = self.__dict__.setdefault("_kept", {})
        if (quantity, what) not in kept:
            if what in ("forward", "backward"):
                turning = self._turning(quantity)
                kept[quantity, "forward"] = turning[..., 0]
                kept[quantity, "backward"] = turning[..., 1]
            else:
                kept[quantity, what] = self._compute(quantity, what)
            for values in kept.values():
                values.setflags(write=False)
        return kept[quantity, what]

    def _turning(self, quantity: str) -> NDArray[np.complex128]:
        raise NotImplementedError

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        raise NotImplementedError


def shown_orders(source: Source, *names: str) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return places of the orders that tables and pictures show, and the orders they leave out.

    Orders chosen automatically are left out where every peak is below :data:`labels.NEGLIGIBLE`
    of the largest peak of its quantity; orders that were given are all shown.
    """
    places = tuple(range(len(source.orders)))
    if source.request.orders is not None:
        return places, ()
    kept = np.zeros(len(places), dtype=bool)
    for name in names:
        peaks = source.read(name, "peak").reshape(-1, len(places)).max(axis=0, initial=0.0)
        kept |= peaks > labels.NEGLIGIBLE * peaks.max(initial=0.0)
    if not kept.any():
        return places, ()
    shown = tuple(place for place in places if kept[place])
    return shown, tuple(source.orders[place] for place in places if not kept[place])
