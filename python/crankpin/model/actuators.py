"""Actuators that push on a powertrain: place, direction, and the limits of motor and stroke."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import warn
from crankpin._support.record import Input
from crankpin.model import checks
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

LONGEST_STROKE = 0.1
"""Stroke, m, above which one was given in millimetres."""


class Actuator(Input):
    """Actuator that pushes on a powertrain at a place, along a direction.

    Without ``mass`` it pushes from what does not move, else it is an inertial actuator: its force
    on the powertrain is the reaction of a mass that it accelerates, F = mω²·stroke, so that
    little is left at low frequency. A pair of counter-rotating eccentric masses whose angle to each
    other is adjusted is one too, with their radius as ``stroke``.

    Parameters
    ----------
    name : str
        Name of the actuator, such as ``"front"``.
    at : sequence of float
        Place (x, y, z) in the engine's axes, m.
    direction : sequence of float
        Direction of its force in the engine's axes, of any length above zero.
    force : float, optional
        Largest force of its motor, N, peak; by default there is no limit.
    mass : float, optional
        Mass that it moves, kg.
    stroke : float, optional
        Largest displacement of that mass from its middle, m; by default there is no limit.
    resonance : float, optional
        Frequency of the mass on its own spring, Hz; by default it has none.
    damping_ratio : float, default 0.0
        Damping of that spring over its critical damping.

    Raises
    ------
    InputError
        If a figure is out of range, or one of the mass is given without it.

    Examples
    --------
    >>> import crankpin as cp
    >>> shaker = cp.Actuator("shaker", at=(0, 0.3, 0), direction=(0, 1, 0), force=150, mass=2,
    ...                      stroke=0.004)
    >>> shaker.largest_force([10, 50, 100]).round(1)
    array([ 31.6, 150. , 150. ])
    """

    name: str
    at: Sequence[float]
    direction: Sequence[float]
    force: float | None = None
    mass: float | None = None
    stroke: float | None = None
    resonance: float | None = None
    damping_ratio: float = 0.0

    def __post_init__(self) -> None:
        at = _vector("at", self.at)
        fields: dict[str, object] = {"name": inputs.text("name", self.name), "at": at}
        along = _vector("direction", self.direction)
        length = math.hypot(*along)
        if length == 0.0:
            raise inputs.rejected("direction", self.direction, "give one of a length above zero")
        fields["direction"] = tuple(part / length + 0.0 for part in along)
        for name in ("force", "mass", "stroke", "resonance"):
            value = getattr(self, name)
            fields[name] = None if value is None else inputs.positive(name, value)
            if name in ("stroke", "resonance") and value is not None and self.mass is None:
                raise inputs.rejected(name, value, "give mass too, that of what it moves")
        damping = inputs.finite("damping_ratio", self.damping_ratio)
        if damping < 0.0 or (damping > 0.0 and self.resonance is None):
            hint = "give zero or more, and resonance where it is above zero"
            raise inputs.rejected("damping_ratio", damping, hint)
        checks.point("at", at)
        self.__dict__.update(fields, damping_ratio=damping)
        if self.stroke is not None and self.stroke > LONGEST_STROKE:
            warn("stroke", f"= {self.stroke:g} m", "was it given in millimetres?")

    def stroke_of(self, force: ArrayLike, frequency: ArrayLike) -> NDArray[np.float64]:
        """Return the displacement of the mass that a force on the powertrain takes, m.

        Parameters
        ----------
        force : array_like
            Force on the powertrain, N, peak.
        frequency : array_like
            Frequency, Hz.

        Returns
        -------
        ndarray of float
            Displacement, m, peak; zero of an actuator without mass. That of the powertrain itself,
            which is micrometres, does not count.

        Raises
        ------
        InputError
            If a figure is no number, or a frequency not above zero.
        """
        size, omega = (
            np.abs(inputs.finite_array("force", force)),
            2.0 * np.pi * _frequency(frequency),
        )
        if self.mass is None:
            return np.zeros(np.broadcast_shapes(size.shape, omega.shape))
        return np.asarray(size / (self.mass * omega**2))

    def motor_force(self, force: ArrayLike, frequency: ArrayLike) -> NDArray[np.float64]:
        """Return the force of the motor that a force on the powertrain takes, N.

        Parameters
        ----------
        force : array_like
            Force on the powertrain, N, peak.
        frequency : array_like
            Frequency, Hz.

        Returns
        -------
        ndarray of float
            Force, N, peak: less than that on the powertrain near the resonance, more below it.

        Raises
        ------
        InputError
            If a figure is no number, or a frequency not above zero.
        """
        share = np.abs(self._motor_share(_frequency(frequency)))
        return np.asarray(np.abs(inputs.finite_array("force", force)) * share)

    def _motor_share(self, frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return the motor's force over that on the powertrain, where this does not move."""
        flat = np.ascontiguousarray(frequency).ravel()
        shares = _core.motor_shares(self.resonance or 0.0, self.damping_ratio, flat)
        return shares.reshape(frequency.shape)

    def largest_force(self, frequency: ArrayLike) -> NDArray[np.float64]:
        """Return the largest force on the powertrain that motor and stroke allow, N.

        Parameters
        ----------
        frequency : array_like
            Frequency, Hz.

        Returns
        -------
        ndarray of float
            Force, N, peak; infinite without limits.

        Raises
        ------
        InputError
            If a frequency is not above zero.
        """
        hertz = _frequency(frequency)
        limit = np.full(hertz.shape, np.inf)
        if self.force is not None:
            with np.errstate(divide="ignore"):  # at an undamped resonance the stroke is the limit
                limit = self.force / np.abs(self._motor_share(hertz))
        if self.mass is not None and self.stroke is not None:
            limit = np.minimum(limit, self.mass * self.stroke * (2.0 * np.pi * hertz) ** 2)
        return limit


def _frequency(frequency: ArrayLike) -> NDArray[np.float64]:
    hint = "give numbers that are more than zero, Hz"
    return inputs.positive_array("frequency", frequency, hint)
