"""Valves and ports: when they open and close, and which are open at one time."""

from __future__ import annotations

import dataclasses
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle

TIMES = ("intake_opens_deg", "intake_closes_deg", "exhaust_opens_deg", "exhaust_closes_deg")
PORT_TIMES = ("transfer_opens_deg", "exhaust_opens_deg")


@dataclasses.dataclass(frozen=True)
class ValveTiming:
    """Opening and closing of the valves of a four-stroke, in degrees of crank angle.

    Parameters
    ----------
    intake_opens_deg
        Before top dead centre.
    intake_closes_deg
        After bottom dead centre.
    exhaust_opens_deg
        Before bottom dead centre.
    exhaust_closes_deg
        After top dead centre.

    Each is above −90 and at most 180; a negative angle is on the other side of the dead centre. The
    defaults are those of an ordinary car engine.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.types.ValveTiming(exhaust_opens_deg=80, exhaust_closes_deg=50)
    >>> racing.exhaust_opens_deg
    80.0
    """

    intake_opens_deg: Angle = 10.0
    intake_closes_deg: Angle = 50.0
    exhaust_opens_deg: Angle = 50.0
    exhaust_closes_deg: Angle = 10.0

    def __post_init__(self) -> None:
        _keep_numbers(self, TIMES)
        _core.valve_timing(_valve_texts(self))


@dataclasses.dataclass(frozen=True)
class PortTiming:
    """Opening of the ports of a two-stroke, in degrees of crank angle.

    The piston opens them on its way down and closes them as far after bottom dead centre.

    Parameters
    ----------
    transfer_opens_deg
        Before bottom dead centre.
    exhaust_opens_deg
        Before bottom dead centre.

    Each is above 0 and below 180. The defaults are those of an ordinary road engine. With a pin
    offset, bottom dead centre is where the piston is lowest; the small difference between opening
    and closing that a port of some height then has is neglected.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.types.PortTiming(transfer_opens_deg=66, exhaust_opens_deg=98)
    >>> racing.exhaust_opens_deg
    98.0
    """

    transfer_opens_deg: Angle = 60.0
    exhaust_opens_deg: Angle = 85.0

    def __post_init__(self) -> None:
        _keep_numbers(self, PORT_TIMES)
        _core.port_timing(_port_texts(self))


def valves(core: _core.Firing, timing: ValveTiming | None) -> Mapping[str, NDArray[np.float64]]:
    """Return when valves open and close; see :meth:`Firing.valves`."""
    intake, exhaust = core.valves(_valve_texts(valve_timing(timing)))
    return MappingProxyType({"intake": intake, "exhaust": exhaust})


def ports(core: _core.Firing, timing: PortTiming | None) -> Mapping[str, NDArray[np.float64]]:
    """Return when ports open and close; see :meth:`Firing.ports`."""
    transfer, exhaust = core.ports(_port_texts(port_timing(timing)))
    return MappingProxyType({"transfer": transfer, "exhaust": exhaust})


def overlaps(
    core: _core.Firing, groups: list[list[int]] | None, timing: ValveTiming | PortTiming | None
) -> list[list[tuple[int, int, float, float]]]:
    """Return the overlaps of exhausts in each group; see :meth:`Firing.exhaust_overlaps`."""
    if core.strokes == 2:
        return core.port_overlaps(groups, _port_texts(port_timing(timing)))
    return core.valve_overlaps(groups, _valve_texts(valve_timing(timing)))


def valve_timing(timing: object) -> ValveTiming:
    """Return a timing of valves, by default the ordinary one."""
    if timing is None:
        return ValveTiming()
    if not isinstance(timing, ValveTiming):
        hint = "give a crankpin.ValveTiming, of a two-stroke a crankpin.PortTiming"
        raise InputError(f"timing = {inputs.shorten(timing)}: {hint}")
    return timing


def port_timing(timing: object) -> PortTiming:
    """Return a timing of ports, by default the ordinary one."""
    if timing is None:
        return PortTiming()
    if not isinstance(timing, PortTiming):
        hint = "give a crankpin.PortTiming, of a four-stroke a crankpin.ValveTiming"
        raise InputError(f"timing = {inputs.shorten(timing)}: {hint}")
    return timing


def _keep_numbers(timing: ValveTiming | PortTiming, names: tuple[str, ...]) -> None:
    """Keep angles as numbers where they are not exact text."""
    for name in names:
        value = getattr(timing, name)
        if not isinstance(value, (str, Fraction)):
            object.__setattr__(timing, name, inputs.number(name, value))


def _valve_texts(timing: ValveTiming) -> tuple[str, str, str, str]:
    """Return the angles as text that reads back exactly, as the core takes them."""
    first, second, third, fourth = (inputs.angle(name, getattr(timing, name)) for name in TIMES)
    return first, second, third, fourth


def _port_texts(timing: PortTiming) -> tuple[str, str]:
    transfer, exhaust = (inputs.angle(name, getattr(timing, name)) for name in PORT_TIMES)
    return transfer, exhaust
