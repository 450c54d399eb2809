"""The orders that a picture shows: the few largest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._support import labels

if TYPE_CHECKING:
    from crankpin.analysis.by_order import ByOrder

MOST = 4
"""Number of orders in a picture."""
MATTERS = 1e-3
"""Orders whose peaks are all below this part of the largest are left out."""


def largest(result: ByOrder, quantity: str, most: int = MOST) -> tuple[list[int], str]:
    """Return places of the largest orders, ascending, and a note of the others, if not zero."""
    count = len(result.orders)
    peaks = (
        result.read(quantity, "peak").reshape(-1, max(1, count)).max(axis=0, initial=0.0)[:count]
    )
    by_size = np.argsort(-peaks, kind="stable")
    kept = [place for place in by_size[:most] if peaks[place] > MATTERS * peaks.max(initial=0.0)]
    rest = [result.orders[place] for place in by_size if peaks[place] > 0.0 and place not in kept]
    note = f"smaller, not shown: {labels.orders_text(tuple(sorted(rest)))}" if rest else ""
    return sorted(int(place) for place in kept), note
