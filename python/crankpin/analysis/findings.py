"""Facts about an engine, as data."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from crankpin._support.inputs import Order


class Finding(NamedTuple):
    """A fact about an engine, before it is put into words."""

    kind: str
    """``"hardware"``, ``"shakes"``, ``"remedy"``, ``"bob weights"``, ``"cancels"``, ``"rest"``,
    ``"inertia torque"``, ``"gas torque"``, ``"gas orders"``, ``"firing"``, ``"load"`` or
    ``"articulated"``."""
    quantity: str = ""
    """``"force"``, ``"moment"``, or empty."""
    orders: tuple[Order, ...] = ()
    """Orders that it is about."""
    values: tuple[float, ...] = ()
    """Figures: N, N·m and degrees; without a speed forces and moments are over ω²."""
    reason: str = ""
    """Why it is so, or what does it."""
    groups: tuple[tuple[int, ...], ...] = ()
    """Numbers of the cylinders that cancel each other, or share a crankpin."""
    proved: bool = False
    """True if its zeros are proved, as by :meth:`Engine.vanishing_orders`."""
