"""Rotating parts besides the throws: counterweights and balance shafts."""

from __future__ import annotations

import dataclasses
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from crankpin._support import inputs, labels, units
from crankpin._support.messages import Hint, suppressed
from crankpin._support.record import Input
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Iterable

    from crankpin import _core
    from crankpin._support.inputs import Angle, Order
    from crankpin._support.record import Item

_Weight: TypeAlias = tuple[float, str, float, int | None, int]


class Unbalance(Input):
    """Mass times eccentricity on a shaft (unbalance, ISO 21940): its force is amount·ω².

    Parameters
    ----------
    amount : float
        Mass × distance of its centre from the axis, kg·m.
    z : float
        Place along the crank, from the front to the flywheel, m.
    angle_deg : number or str, default 0.0
        Direction at θ = 0, degrees from +x; with ``pin`` from the direction of that crankpin, in
        the direction in which the crank turns: 180 is opposite.
    pin : int, optional
        Number of a cylinder whose crankpin it follows wherever the pin moves, such as 1; None for
        a weight that keeps its direction. On the cranks only.
    crank : int, default 0
        Index of the crank that carries it, as in :meth:`Engine.from_lists`: 0 is the main one. Left
        out with ``pin``, whose crank it is on, and on balance shafts.

    Raises
    ------
    InputError
        If the amount is below zero, a figure is not finite, or ``pin`` and ``crank`` are given.

    Examples
    --------
    Half of the reciprocating mass opposite the pin leaves no forward part of order 1:

    >>> import crankpin as cp
    >>> single = cp.Engine.preset("single")
    >>> half = 0.5 * 0.45 * 0.043
    >>> weight = cp.Unbalance(amount=half, z=0, angle_deg=180, pin=1)
    >>> complex(single.with_counterweights([weight]).balance(rpm=3000)[1].force.forward)
    0j
    """

    amount: float
    z: float
    angle_deg: float = dataclasses.field(compare=False, metadata={"exact": "exact_angle"})
    pin: int | None
    crank: int
    exact_angle: str = dataclasses.field(init=False, repr=False)
    """The angle as text that is exact, such as ``"1350/7"``, degrees."""

    def __init__(
        self,
        amount: float,
        z: float,
        angle_deg: Angle = 0.0,
        pin: int | None = None,
        crank: int = 0,
    ) -> None:
        object.__setattr__(self, "amount", inputs.finite("amount", amount))
        object.__setattr__(self, "z", inputs.finite("z", z))
        if self.amount < 0.0:
            hint: str = Hint.of("give zero or more; `angle_deg` turns it round")
            raise inputs.rejected("amount", self.amount, hint)
        checks.unbalance(self.amount)
        angle = inputs.angle("angle_deg", angle_deg)
        object.__setattr__(self, "angle_deg", inputs.degrees(angle))
        object.__setattr__(self, "exact_angle", angle)
        if pin is not None:
            pin = inputs.whole("pin", pin)
            if pin < 1:
                raise inputs.rejected("pin", pin, "give the number of a cylinder, from 1")
        object.__setattr__(self, "pin", pin)
        on = inputs.whole("crank", crank)
        if on < 0:
            raise inputs.rejected("crank", on, "give the number of a crank, 0 for the main one")
        if on and pin is not None:
            hint = "leave it out: a weight at a crankpin is on the crank of that"
            raise inputs.rejected("crank", on, hint)
        object.__setattr__(self, "crank", on)


class Shaft(Input):
    """A balance shaft: it turns at a fixed ratio to the crankshaft about an axis parallel to it.

    An unbalance U on it makes the force U·(ratio·ω)² at order ``|ratio|``: all of it turns with the
    crank if the ratio is above zero, against it if below. About the crank axis it makes a roll
    torque, ``x·F_y − y·F_x``.

    Parameters
    ----------
    ratio : number or str
        Speed over crank speed, a multiple of 1/2 other than 0: −1 turns against the crank, 2 with
        it at twice its speed; ``"1/2"`` is a camshaft.
    unbalances : sequence of Unbalance
        What the shaft carries, each without ``pin``.
    x, y : float, default 0.0
        Place of its axis from the crank axis, seen from the flywheel, m.
    name : str, optional
        Name of the shaft; may be empty.

    Raises
    ------
    InputError
        If the ratio is no multiple of 1/2 or 0, or an unbalance has a pin.

    Examples
    --------
    Two shafts remove the second-order force of an inline-4 (Lanchester):

    >>> import crankpin as cp
    >>> i4 = cp.Engine.preset("i4")
    >>> needed = abs(i4.balance(rpm=60, orders=[2])[2].force.y) / (2 * 3.141592653589793) ** 2
    >>> pair = [
    ...     cp.Shaft(ratio, [cp.Unbalance(needed / 8, z=0.15, angle_deg=-90)], x=x)
    ...     for ratio, x in [(2, 0.08), (-2, -0.08)]
    ... ]
    >>> smooth = i4.with_shafts(pair)
    >>> bool(smooth.balance(rpm=6000)[2].force.peak < 1e-9 * i4.balance(rpm=6000)[2].force.peak)
    True
    """

    ratio: Order
    unbalances: tuple[Unbalance, ...]
    x: float
    y: float
    name: str

    def __init__(
        self,
        ratio: float | str | Fraction,
        unbalances: Iterable[Unbalance],
        x: float = 0.0,
        y: float = 0.0,
        name: str = "",
    ) -> None:
        object.__setattr__(self, "ratio", inputs.speed_ratio("ratio", ratio))
        object.__setattr__(self, "x", inputs.finite("x", x))
        object.__setattr__(self, "y", inputs.finite("y", y))
        object.__setattr__(self, "name", inputs.text("name", name))
        object.__setattr__(self, "unbalances", listed_items("unbalances", unbalances, Unbalance))
        for k, weight in enumerate(self.unbalances):
            if weight.pin is not None:
                hint = "leave it out: only the crankshaft has crankpins"
                raise inputs.rejected(f"unbalances[{k}].pin", weight.pin, hint)
            if weight.crank:
                hint = "leave it out: the shaft carries it"
                raise inputs.rejected(f"unbalances[{k}].crank", weight.crank, hint)


def with_counterweights(core: _core.Engine, weights: Iterable[Unbalance]) -> _core.Engine:
    """Return an engine with these unbalances on its cranks."""
    entries = listed_items("counterweights", weights, Unbalance)
    changed_core = core.with_counterweights([_weight(weight) for weight in entries])
    checks.hardware(changed_core, of_shafts=False)
    return changed_core


def with_more(
    core: _core.Engine, weights: Iterable[Unbalance] = (), shafts: Iterable[Shaft] = ()
) -> _core.Engine:
    """Return an engine with these in addition to its own, without warnings."""
    core = core.with_counterweights([*core.counterweights, *map(_weight, weights)])
    return core.with_shafts([*core.shafts, *map(_shaft, shafts)])


def counterweights(core: _core.Engine) -> tuple[Unbalance, ...]:
    """Return the unbalances on the cranks besides the rotating masses."""
    return tuple(unbalance_of(weight) for weight in core.counterweights)


def with_shafts(core: _core.Engine, shafts: Iterable[Shaft]) -> _core.Engine:
    """Return an engine with these balance shafts."""
    entries = listed_items("shafts", shafts, Shaft)
    changed_core = core.with_shafts([_shaft(shaft) for shaft in entries])
    checks.hardware(changed_core, of_shafts=True)
    return changed_core


def shafts(core: _core.Engine) -> tuple[Shaft, ...]:
    """Return the balance shafts."""
    return tuple(
        Shaft(ratio, tuple(unbalance_of(weight) for weight in weights), x, y, name)
        for name, ratio, x, y, weights in core.shafts
    )


def repeat_in_a_turn(core: _core.Engine) -> bool:
    """Return whether cranks and shafts all come round in a turn of the main crank."""
    ratios = [ratio for *_, ratio in core.cranks[0]] + [shaft[1] for shaft in core.shafts]
    return all(ratio % 1 == 0 for ratio in ratios)


def lines(core: _core.Engine) -> list[units.Text]:
    """Return counterweights, shafts and further crankshafts in words."""
    texts = []
    for x, y, ratio in core.cranks[0][1:5]:
        texts.append(units.Text(f"another crankshaft: ratio {ratio:+g} at ", _place(x, y)))
    if core.counterweights:
        amounts = units.joined(", ", map(_text, core.counterweights[:4]))
        more = ", …" if len(core.counterweights) > 4 else ""
        texts.append(units.Text("counterweights: ", amounts, more))
    for name, ratio, x, y, weights in core.shafts[:4]:
        total = sum(weight[0] for weight in weights)
        title = f"balance shaft {labels.one_line(name)}".strip()
        amount = units.figure(total, "kg·m", 4)
        texts.append(units.Text(f"{title}: ratio {ratio:+g} at ", _place(x, y), ", ", amount))
    return texts


def _place(x: float, y: float) -> units.Figure:
    return units.Figure((x, y), "m", ".4g", "({}, {})")


def listed_items(name: str, values: object, kind: type[Item]) -> tuple[Item, ...]:
    """Return the items of a list, each of which is of a class."""
    entries = inputs.items(name, values, f"give a list of crankpin.{kind.__name__}")
    for k, shaft in enumerate(entries):
        if not isinstance(shaft, kind):
            raise inputs.rejected(f"{name}[{k}]", shaft, f"give a crankpin.{kind.__name__}")
    return tuple(entries)


def _weight(unbalance: Unbalance) -> _Weight:
    pin = None if unbalance.pin is None else unbalance.pin - 1
    return (unbalance.amount, unbalance.exact_angle, unbalance.z, pin, unbalance.crank)


def _shaft(shaft: Shaft) -> tuple[str, Order, float, float, list[_Weight]]:
    return (shaft.name, shaft.ratio, shaft.x, shaft.y, [_weight(u) for u in shaft.unbalances])


def unbalance_of(weight: _Weight) -> Unbalance:
    """Return an unbalance of the core."""
    amount, angle, z, pin, crank = weight
    with suppressed():  # Warned of where it was given.
        return Unbalance(amount, z, angle, None if pin is None else pin + 1, crank)


def _text(weight: _Weight) -> units.Text:
    amount, angle, z, pin, crank = weight
    place = f"pin {pin + 1} + " if pin is not None else f"crank {crank}, " if crank else ""
    where = f" at {place}{inputs.degrees(angle):.6g}°, z = "
    return units.Text(units.figure(amount, "kg·m", 4), where, units.figure(z, "m", 4))
