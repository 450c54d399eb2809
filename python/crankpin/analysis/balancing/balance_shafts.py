"""Balance shafts fitted to an engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.warnings import warn
from crankpin.analysis.balancing.fitted_shafts import BalanceShafts
from crankpin.analysis.balancing.planes import Turning, ends
from crankpin.analysis.balancing.shaft_requests import shaft_requests
from crankpin.analysis.request import engine_core
from crankpin.model.shafts import Shaft, unbalance_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crankpin.analysis.balancing.shaft_requests import Remove
    from crankpin.model.engine import Engine


def balance_shafts(
    engine: Engine,
    ratios: int | Sequence[int],
    *,
    x: float | Sequence[float | None] | None = None,
    y: float | Sequence[float | None] | None = None,
    planes: Sequence[float] | Sequence[Sequence[float] | None] | None = None,
    bearings: Sequence[float] | Sequence[Sequence[float] | None] | None = None,
    remove: Remove | Sequence[Remove] = "both",
    rpm: float | None = None,
) -> BalanceShafts:
    """Fit balance shafts to an engine.

    A shaft of ratio n > 0 removes the forward part of order n, of force and of moment, a shaft of
    ratio −n the backward part; neither changes the other part. Shafts of the same ratio share their
    task so that the sum of the squares of their unbalances is least. The shafts are added to those
    that the engine has, and its counterweights stay.

    Parameters
    ----------
    engine
        The engine, with its counterweights.
    ratios
        Speed of each shaft over crank speed: −1 for one that turns against the crank, ``[2, -2]``
        for a Lanchester pair.
    x, y
        Axis of each shaft from the crank axis, seen from the flywheel, m: a number for all, or a
        list with one for each. None is free: such coordinates are placed where the shafts cancel
        the roll torque of their order, or come closest to it, as near the crank axis as that
        allows. Where that is further away than ten times the engine's length, the torque stays,
        with a warning.
    planes
        Places of the unbalances along the crank, m: for all shafts, such as ``[0.0, 0.3]``, or a
        list of these, one for each shaft. None is free: a single plane where that is enough, the
        first and last cylinder elsewhere.
    bearings
        Places of the two bearings along the crank, m, as ``planes``; by default the first and last
        cylinder.
    remove
        ``"both"``, ``"force"`` (by an unbalance that makes no moment about the
        engine's ``reference_z``) or ``"moment"`` (by a couple, without force): for all shafts, or a
        list with one for each. Shafts of the same ratio have the same.
    rpm
        Crank speed, needed for a fired engine: its roll torque of gas pressure does not scale with
        the square of the speed as that of shafts does, so that places cancel the whole at this
        speed. The residual is that at this speed; by default it is over ω².

    Returns
    -------
    BalanceShafts
        The shafts, the engine with them, and the residual.

    Raises
    ------
    InputError
        If an argument is out of range, or a single plane is to remove a couple.

    Notes
    -----
    From two planes on, force and moment are both removed. In a single plane the sum of squares of
    the residual is least, moments taken over half the distance between the first and last cylinder;
    ``remove="force"`` removes all of the force there.

    Examples
    --------
    One shaft against the crank removes the backward first-order couple of an inline-3, whose
    forward one takes counterweights:

    >>> import crankpin as cp
    >>> i3 = cp.Engine.preset("i3")
    >>> fit = cp.balance_shafts(i3, -1)
    >>> [round(each.amount, 6) for each in fit[0].unbalances]
    [0.008379, 0.008379]
    >>> bool(fit.fitted.balance(rpm=3000)[1].moment.backward)
    False

    A Lanchester pair, 160 mm apart, at the heights that cancel the second-order roll torque too:

    >>> i4 = cp.Engine.preset("i4")
    >>> pair = cp.balance_shafts(i4, [2, -2], x=[0.08, -0.08])
    >>> [round(each.y, 4) for each in pair]
    [0.0709, -0.0709]
    >>> second = pair.fitted.balance(rpm=6000, orders=[2])[2]
    >>> float(round(second.force.peak, 6)), float(round(second.torque.peak, 6))
    (0.0, 0.0)
    """
    engine_core(engine)
    asked = shaft_requests(ratios, x=x, y=y, planes=planes, bearings=bearings, remove=remove)
    speed = inputs.optional_number("rpm", rpm)
    found, beyond = _core.fit_shafts(
        engine_core(engine),
        [(each.ratio, (each.x, each.y), each.planes, each.remove) for each in asked],
        speed,
    )
    if speed == 0.0:
        raise InputError(f"rpm = {speed:g}: shafts make no force at rest; give a speed above zero")
    if beyond is not None:
        warn(
            "the roll torque is not cancelled: shafts that do so would be "
            f"{beyond:.3g} m from the crank axis; give x and y"
        )
    first, last = ends(engine)[0], ends(engine)[-1]
    supports = (first, last) if first < last else None
    return BalanceShafts(
        engine,
        tuple(
            Shaft(each.ratio, tuple(map(unbalance_of, weights)), x, y)
            for each, ((x, y), weights, _) in zip(asked, found, strict=True)
        ),
        tuple(Turning(*exerts) for _, _, exerts in found),
        tuple(each.bearings or supports for each in asked),
        speed,
    )
