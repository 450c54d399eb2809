"""Balance shafts fitted to an engine."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint, warn
from crankpin.analysis.balancing.fitted_shafts import BalanceShafts
from crankpin.analysis.balancing.fitting import warn_of_appearing
from crankpin.analysis.balancing.planes import Turning, ends
from crankpin.analysis.request import engine_core
from crankpin.model import checks
from crankpin.model.shafts import Shaft, unbalance_of, with_more

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Order
    from crankpin.model.engine import Engine


Remove: TypeAlias = Literal["both", "force", "moment"]
REMOVE: tuple[Remove, ...] = ("both", "force", "moment")

MOST_SHAFTS = 100
"""Largest number of shafts fitted at once."""


def balance_shafts(
    engine: Engine,
    ratios: float | str | Fraction | Sequence[float | str | Fraction],
    *,
    x: ArrayLike | Sequence[float | None] | None = None,
    y: ArrayLike | Sequence[float | None] | None = None,
    planes: ArrayLike | Sequence[ArrayLike | None] | None = None,
    bearings: ArrayLike | Sequence[ArrayLike | None] | None = None,
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
    engine : Engine
        The engine, with its counterweights.
    ratios : number, str or sequence of these
        Speed of each shaft over crank speed, a multiple of 1/2: −1 for one that turns against the
        crank, ``[2, -2]`` for a Lanchester pair, ``"1/2"`` for one as fast as a camshaft.
    x, y : float or sequence of float or None, optional
        Axis of each shaft from the crank axis, seen from the flywheel, m: a number for all, or a
        list with one for each. None is free: such coordinates are placed where the shafts cancel
        the roll torque of their order, or come closest to it, as near the crank axis as that
        allows. Where that is further away than ten times the distance from the first to the last
        cylinder, or ten times crank radius and rod length together where these are longer, the
        torque stays, with a warning.
    planes : sequence of float, or sequence of these or None, optional
        Places of the unbalances along the crank, m. For all shafts, such as ``[0.0, 0.3]``, or a
        list of these, one for each shaft. None is free: a single plane where that is enough, the
        first and last cylinder elsewhere.
    bearings : sequence of float, or sequence of these or None, optional
        Places of the two bearings along the crank, m; by default the first and last
        cylinder.
    remove : {"both", "force", "moment"} or sequence of these, default "both"
        What the shafts remove: force by an unbalance that makes no moment about the engine's
        reference plane, moment by a couple without force. One for all shafts, or a list with one
        for each. Shafts of the same ratio have the same.
    rpm : float, optional
        Crank speed, rpm, needed for a fired engine: its roll torque of gas pressure does not
        scale with the square of the speed as that of shafts does, so that places cancel the
        whole at this speed. The residual is that at this speed; by default it is over ω².

    Returns
    -------
    BalanceShafts
        The shafts, the engine with them, and the residual.

    Raises
    ------
    InputError
        If an argument is out of range, or a single plane is to remove a couple.

    Warns
    -----
    UserWarning
        If free axes that cancel the roll torque would be too far from the crank axis, a place
        seems to be in millimetres, or an order that vanishes appears with the shafts.

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
    >>> [round(weight.amount, 6) for weight in fit[0].unbalances]
    [0.008379, 0.008379]
    >>> bool(fit.fitted.balance(rpm=3000)[1].moment.backward)
    False

    A Lanchester pair, 160 mm apart, at the heights that cancel the second-order roll torque too:

    >>> i4 = cp.Engine.preset("i4")
    >>> pair = cp.balance_shafts(i4, [2, -2], x=[0.08, -0.08])
    >>> [round(shaft.y, 4) for shaft in pair]
    [0.0709, -0.0709]
    >>> second = pair.fitted.balance(rpm=6000, orders=[2])[2]
    >>> float(round(second.force.peak, 6)), float(round(second.torque.peak, 6))
    (0.0, 0.0)
    """
    core = engine_core(engine)
    requests = _shaft_requests(ratios, x=x, y=y, planes=planes, bearings=bearings, remove=remove)
    checks.place(core, "x", *(request.x for request in requests), middle=0.0)
    checks.place(core, "y", *(request.y for request in requests), middle=0.0)
    checks.place(core, "planes", *(z for request in requests for z in request.planes or ()))
    checks.place(core, "bearings", *(z for request in requests for z in request.bearings or ()))
    speed = inputs.optional_number("rpm", rpm)
    fitted, beyond = _core.fit_shafts(
        core,
        [
            (request.ratio, (request.x, request.y), request.planes, request.remove)
            for request in requests
        ],
        speed,
    )
    if beyond is not None:
        far = f"is not cancelled: shafts that do so would be {beyond:.3g} m from the crank axis"
        warn("the roll torque", Hint.of(f"{far}; give `x` and `y`"))
    first, last = ends(engine)[0], ends(engine)[-1]
    supports = (first, last) if first < last else None
    fit = BalanceShafts(
        engine,
        tuple(
            Shaft(request.ratio, tuple(map(unbalance_of, weights)), x, y)
            for request, ((x, y), weights, _) in zip(requests, fitted, strict=True)
        ),
        tuple(Turning(*exerts) for _, _, exerts in fitted),
        tuple(request.bearings or supports for request in requests),
        speed,
    )
    warn_of_appearing(engine, with_more(core, shafts=fit.hardware))
    return fit


# --- arguments, one for all shafts or one for each -----------------------------------------------


@dataclasses.dataclass(frozen=True)
class ShaftRequest:
    """A shaft to be fitted; None is free."""

    ratio: Order
    """Speed over crank speed."""
    x: float | None
    """Axis to the right of the crank axis, m."""
    y: float | None
    """Axis above the crank axis, m."""
    planes: tuple[float, ...] | None
    """Places of its unbalances, m."""
    bearings: tuple[float, float] | None
    """Places of its two bearings, front first, m."""
    remove: Remove
    """Part that the shaft removes."""


def _shaft_requests(
    ratios: object, *, x: object, y: object, planes: object, bearings: object, remove: object
) -> list[ShaftRequest]:
    """Return the shafts to be fitted; :func:`crankpin.balance_shafts` documents the arguments."""
    shaft_ratios = _ratios(ratios)
    count = len(shaft_ratios)
    removals = _removals(remove, shaft_ratios)
    requests = list(
        map(
            ShaftRequest,
            shaft_ratios,
            _coordinates("x", x, count),
            _coordinates("y", y, count),
            _places("planes", planes, count),
            _bearings(bearings, count),
            removals,
        )
    )
    for k, request in enumerate(requests):
        if request.planes is not None and len(request.planes) < 2 and request.remove == "moment":
            message = "a couple takes two planes; give two, or remove the force"
            raise inputs.rejected(f"planes[{k}]", list(request.planes), message)
    return requests


def _ratios(ratios: object) -> list[Order]:
    hint = 'give multiples of 1/2 other than 0, such as -1, "1/2" or [2, -2]'
    several = isinstance(ratios, Iterable) and not isinstance(ratios, str)
    entries = inputs.items("ratios", ratios, hint) if several else [ratios]
    numbers = [inputs.speed_ratio("ratios", value) for value in entries]
    if not 1 <= len(numbers) <= MOST_SHAFTS:
        raise inputs.faulty("ratios", f"has {len(numbers)} shafts", f"give 1 to {MOST_SHAFTS}")
    for number in numbers:
        if abs(number) > _core.HIGHEST_ORDER:
            raise inputs.rejected("ratios", ratios, hint)
    return numbers


def _removals(remove: object, ratios: list[Order]) -> list[Remove]:
    alike = isinstance(remove, str) or not isinstance(remove, Iterable)
    words = [remove] * len(ratios) if alike else _each("remove", remove, len(ratios))
    removals: dict[Order, Remove] = {}
    for ratio, value in zip(ratios, words, strict=True):
        word = cast("Remove", inputs.one_of("remove", value, REMOVE))
        if removals.setdefault(ratio, word) != word:
            hint = "shafts of one ratio share their task; give them the same"
            raise inputs.rejected("remove", remove, hint)
    return [removals[ratio] for ratio in ratios]


def _each(name: str, values: object, count: int) -> list[Any]:
    entries = inputs.items(name, values, f"give one for each of {count} shafts")
    if len(entries) != count:
        raise inputs.faulty(
            name, f"has {len(entries)} entries", f"give one for each of {count} shafts"
        )
    return entries


def _coordinates(name: str, values: object, count: int) -> list[float | None]:
    numbers = _each(name, values, count) if isinstance(values, Iterable) else [values] * count
    return [None if value is None else inputs.finite(name, value) for value in numbers]


def _places(name: str, values: object, count: int) -> list[tuple[float, ...] | None]:
    if values is None:
        return [None] * count
    hint = "give places along the crank, m, such as [0.0, 0.3], or a list of these"
    entries = inputs.items(name, values, hint)
    if any(value is None or isinstance(value, Iterable) for value in entries):
        each_has = _each(name, entries, count)
    else:
        each_has = [entries] * count
    intervals: list[tuple[float, ...] | None] = []
    for k, place in enumerate(each_has):
        if place is None:
            intervals.append(None)
            continue
        numbers = [
            inputs.finite(f"{name}[{k}]", z) for z in inputs.items(f"{name}[{k}]", place, hint)
        ]
        places = tuple(sorted(numbers))
        if not places or len(set(places)) < len(places):
            raise inputs.rejected(f"{name}[{k}]", place, "give different places")
        intervals.append(places)
    return intervals


def _bearings(bearings: object, count: int) -> list[tuple[float, float] | None]:
    pairs: list[tuple[float, float] | None] = []
    for k, pair in enumerate(_places("bearings", bearings, count)):
        if pair is not None and len(pair) != 2:
            raise inputs.rejected(f"bearings[{k}]", list(pair), "give the places of two bearings")
        pairs.append(None if pair is None else (pair[0], pair[1]))
    return pairs
