"""Crankpins that a firing order needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.record import Record, read_only
from crankpin.model import checks
from crankpin.model.builders import vee_layout

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle, Angles
    from crankpin.model.builders import Numbering, Side


class Throws(Record):
    """Crankpins that a firing order needs.

    Made by :func:`crankpin.throws`.
    """

    throws_deg: NDArray[np.float64]
    """Crankpins in the direction of rotation from the front one, as builders take them, degrees in
    [0, 360): (n_throws,); in a vee those of the right bank."""
    pin_split_deg: NDArray[np.float64]
    """Left pin minus right pin of each throw, degrees in (−180, 180]: (n_throws,); empty without
    banks."""

    def __post_init__(self) -> None:
        for name in ("throws_deg", "pin_split_deg"):
            array = inputs.vector(name, getattr(self, name)).copy()
            if not np.isfinite(array).all():
                raise InputError(f"{name} = {inputs.shorten(array)}: give finite degrees")
            object.__setattr__(self, name, read_only(array))

    @property
    def shared_pins(self) -> bool:
        """True if the two cylinders of every throw share its pin."""
        return bool(self.pin_split_deg.size) and not self.pin_split_deg.any()

    def __repr__(self) -> str:
        throws, splits = (
            "-".join(f"{angle:.10g}" for angle in angles)
            for angles in (self.throws_deg, self.pin_split_deg)
        )
        if not splits:
            return f"<Throws {throws}>"
        if len(set(self.pin_split_deg.tolist())) == 1:
            splits = f"{self.pin_split_deg[0]:.10g}"
        else:
            splits = ", ".join(f"{angle:.10g}" for angle in self.pin_split_deg)
        return f"<Throws {throws}, " + (
            "shared pins>" if self.shared_pins else f"pins split by {splits}>"
        )


def throws(
    firing_order: str | Iterable[int],
    *,
    bank_angle_deg: Angle | None = None,
    odd_bank: Side = "right",
    numbering: Numbering = "alternating",
    intervals_deg: Angles | None = None,
    strokes: int = 4,
) -> Throws:
    """Return the crankpins that a firing order needs.

    Parameters
    ----------
    firing_order
        Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list.
    bank_angle_deg
        Angle between the banks of a vee; None for an inline engine.
    odd_bank, numbering
        As in :meth:`Engine.vee`.
    intervals_deg
        Crank angles from each cylinder of the order to the next, and from the last to the first;
        by default equal ones.
    strokes
        4 or 2: intervals add up to 720 or 360.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.throws("1-8-4-3-6-5-7-2", bank_angle_deg=90, odd_bank="left")
    <Throws 0-90-270-180, shared pins>
    >>> cp.throws("1-2-3-4-5-6", bank_angle_deg=60)
    <Throws 0-120-240, pins split by -60>
    >>> cp.throws("1-6-5-4-3-2", bank_angle_deg=90, odd_bank="left", intervals_deg=[150, 90] * 3)
    <Throws 0-240-120, shared pins>
    """
    text = inputs.firing_order("firing_order", firing_order)
    listed = None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg)
    number = inputs.strokes(strokes)
    # What an inline engine ignores is checked all the same.
    angle = 0.0 if bank_angle_deg is None else bank_angle_deg
    across = vee_layout(angle, 0.0, 0.0, numbering, odd_bank)
    if bank_angle_deg is None:
        return Throws(_core.inline_throws(text, listed, number), np.empty(0))
    layout = {"throws": [], "spacing": 0.0, "rotating_mass": [], "first_tdc": "0"}
    found = Throws(*_core.vee_throws(text, listed, number, layout | across))
    if intervals_deg is None:
        other = across | {"odd_bank": checks.other_bank(odd_bank)}
        _, splits = _core.vee_throws(text, listed, number, layout | other)
        checks.odd_bank(odd_bank, found.pin_split_deg, splits)
    return found
