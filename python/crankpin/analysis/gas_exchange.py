"""Timing of valves and ports."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.record import Input

if TYPE_CHECKING:
    from crankpin._support.inputs import Angle


class _Timing(Input):
    """Angles of valves or ports, checked."""

    def __post_init__(self) -> None:
        for name in self._names:
            value = getattr(self, name)
            if not isinstance(value, (str, Fraction)):
                object.__setattr__(self, name, inputs.number(name, value))
        _core.check_timing(self._texts)

    @property
    def _texts(self) -> list[str]:
        """The angles as text that reads back exactly, as the core takes them."""
        return [inputs.angle(name, getattr(self, name)) for name in self._names]

    @property
    def _names(self) -> list[str]:
        return [field.name for field in self._fields]


class ValveTiming(_Timing):
    """Opening and closing of the valves of a four-stroke, in degrees of crank angle.

    Each is above −90 and at most 180; a negative angle is on the other side of the dead centre. The
    defaults are those of an ordinary car engine.

    Parameters
    ----------
    intake_opens_deg : number or str, default 10.0
        Opening of the intake before top dead centre, degrees.
    intake_closes_deg : number or str, default 50.0
        Closing of the intake after bottom dead centre, degrees.
    exhaust_opens_deg : number or str, default 50.0
        Opening of the exhaust before bottom dead centre, degrees.
    exhaust_closes_deg : number or str, default 10.0
        Closing of the exhaust after top dead centre, degrees.

    Raises
    ------
    InputError
        If an angle is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.ValveTiming(exhaust_opens_deg=80, exhaust_closes_deg=50)
    >>> racing.exhaust_opens_deg
    80.0
    """

    intake_opens_deg: Angle = 10.0
    intake_closes_deg: Angle = 50.0
    exhaust_opens_deg: Angle = _core.EXHAUST_OPENS_DEG[0]
    exhaust_closes_deg: Angle = 10.0


class PortTiming(_Timing):
    """Opening of the ports of a two-stroke, in degrees of crank angle.

    The piston opens them on its way down and closes them as far after bottom dead centre.

    Each is above 0 and below 180. The defaults are those of an ordinary road engine. With a pin
    offset, bottom dead centre is where the piston is lowest; the small difference between opening
    and closing that a port of some height then has is neglected.

    Parameters
    ----------
    transfer_opens_deg : number or str, default 60.0
        Opening of the transfer ports before bottom dead centre, degrees.
    exhaust_opens_deg : number or str, default 85.0
        Opening of the exhaust port before bottom dead centre, degrees.

    Raises
    ------
    InputError
        If an angle is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.PortTiming(transfer_opens_deg=66, exhaust_opens_deg=98)
    >>> racing.exhaust_opens_deg
    98.0
    """

    transfer_opens_deg: Angle = 60.0
    exhaust_opens_deg: Angle = _core.EXHAUST_OPENS_DEG[1]


Timing: TypeAlias = ValveTiming | PortTiming


def angles(timing: Timing | None, kind: type[ValveTiming | PortTiming]) -> list[str]:
    """Return the angles of a timing of this kind, by default the ordinary one."""
    chosen = kind() if timing is None else timing
    if not isinstance(chosen, kind):
        other = "four-stroke a crankpin.ValveTiming"
        if kind is ValveTiming:
            other = "two-stroke a crankpin.PortTiming"
        raise inputs.rejected("timing", timing, f"give a crankpin.{kind.__name__}, of a {other}")
    return chosen._texts
