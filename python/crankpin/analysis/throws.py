"""Crankpins that a firing order needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.record import read_only
from crankpin.model import checks
from crankpin.model.builders import vee_layout

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle, Angles
    from crankpin.model.builders import Numbering, Side


def throws(
    firing_order: str | Iterable[int],
    *,
    bank_angle_deg: Angle | None = None,
    odd_bank: Side = "right",
    numbering: Numbering = "alternating",
    intervals_deg: Angles | None = None,
    strokes: int = 4,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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

    Returns
    -------
    throws_deg
        Crankpins in the direction of rotation from the front one, as builders take them, degrees in
        [0, 360): (n_throws,); in a vee those of the right bank.
    pin_split_deg
        Left pin minus right pin of each throw, degrees in (−180, 180]: (n_throws,); zero for shared
        pins, empty for an inline engine.

    Examples
    --------
    >>> import crankpin as cp
    >>> throws, splits = cp.throws("1-8-4-3-6-5-7-2", bank_angle_deg=90, odd_bank="left")
    >>> throws, splits
    (array([  0.,  90., 270., 180.]), array([0., 0., 0., 0.]))
    >>> throws, splits = cp.throws("1-2-3-4-5-6", bank_angle_deg=60)
    >>> throws, splits
    (array([  0., 120., 240.]), array([-60., -60., -60.]))
    >>> cp.throws("1-3-4-2")[0]
    array([  0., 180., 180.,   0.])
    """
    text = inputs.firing_order("firing_order", firing_order)
    listed = None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg)
    number = inputs.strokes(strokes)
    # What an inline engine ignores is checked all the same.
    angle = 0.0 if bank_angle_deg is None else bank_angle_deg
    across = vee_layout(angle, 0.0, 0.0, numbering, odd_bank)
    if bank_angle_deg is None:
        return _core.inline_throws(text, listed, number), read_only(np.empty(0))
    layout = {"throws": [], "spacing": 0.0, "rotating_mass": [], "first_tdc": "0"}
    found, splits = _core.vee_throws(text, listed, number, layout | across)
    if intervals_deg is None:
        other = across | {"odd_bank": checks.other_bank(odd_bank)}
        _, others = _core.vee_throws(text, listed, number, layout | other)
        checks.odd_bank(odd_bank, splits, others)
    return found, splits
