"""Velocity of a powertrain fed back through an inertial actuator: the largest stable gain."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, units
from crankpin._support.frames import Tabled
from crankpin._support.messages import Hint
from crankpin._support.record import computed, read_only
from crankpin._support.tables import Column, Table
from crankpin.model.actuators import Actuator

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._core import InputError
    from crankpin.analysis.mounts.powertrain import Powertrain

REACH = 30.0
"""Factor below the lowest and above the highest frequency of modes and actuator: the range."""
POINTS = 2000
"""Frequencies over that range, evenly on a logarithmic scale."""
BESIDE = np.geomspace(1e-6, 0.3, 60)
"""Distances from each mode, over its frequency, at which more are taken."""
ROUNDING = 1e-12
"""Share by which the ends of a table are left, for rounding of angular speeds."""


class VelocityFeedback(Tabled):
    """Stability of velocity fed back through an inertial actuator, and what it does.

    Made by :meth:`Powertrain.velocity_feedback`.
    """

    powertrain: Powertrain
    """The powertrain."""
    actuator: Actuator
    """The inertial actuator; the velocity is that of its place along its direction."""
    gain: float | None = None
    """Gain, N·s/m; None for half of the largest."""
    onset: float | None = computed()
    """Frequency at which it becomes unstable, Hz; None if it does not."""
    largest_gain: float = computed()
    """Gain from which on it is unstable, N·s/m; infinite if it is stable at any.

    Of mounts with tables it is that within their frequencies.
    """
    _modes: list[float] = computed()
    _grid: NDArray[np.float64] = computed()
    _on_grid: NDArray[np.complex128] = computed()
    _cut: tuple[float, float] | None = computed()

    def __post_init__(self) -> None:
        low, high = self._range()
        resonance = float(self.actuator.resonance or 0.0)
        at = float(np.clip(resonance, low, high))
        modes = self.powertrain.modes(at if self.powertrain._varies else None)
        core = self.powertrain._core
        undamped = core.undamped(self.actuator, at)
        if undamped is not None:
            stable = "a limit of gain is that of a powertrain and actuator that are stable without"
            damped = "give mounts a `loss_factor` or `damping`, and the actuator a `damping_ratio`"
            hint = Hint.of(f"{stable}: {damped}")
            raise inputs.faulty("nothing", f"damps the mode at {undamped:.5g} Hz", hint)
        own = [*modes.frequency[modes.frequency > 0.0].tolist(), resonance]
        grid = np.geomspace(min(own) / REACH, max(own) * REACH, POINTS)
        beside = np.multiply.outer(own, np.concatenate([1.0 - BESIDE, 1.0 + BESIDE]))
        grid = np.unique(np.concatenate([grid, beside.ravel()]))
        is_cut = low > grid[0] or high < grid[-1]
        grid = grid[(grid >= low) & (grid <= high)]
        if not grid.size:
            raise self._beyond(low, high)
        mobility = self._mobility(grid)
        largest, onset = core.feedback_margin(self.actuator, grid, mobility)
        if is_cut and onset is None:
            raise self._beyond(low, high)
        known = [f for f in own[:-1] if low <= f <= high]
        self.__dict__.update(
            largest_gain=largest, onset=onset, _modes=known, _grid=grid, _on_grid=mobility,
            _cut=(low, high) if is_cut else None,
        )  # fmt: skip
        super().__post_init__()

    def _range(self) -> tuple[float, float]:
        """Return the frequencies that all tables of stiffness have, Hz."""
        support: Any = self.powertrain.support
        mounts = (*self.powertrain.mounts, *getattr(support, "mounts", ()))
        tables = [mount.table[0] for mount in mounts if mount.table is not None]
        ends = [(table[0], table[-1]) for table in tables] or [(0.0, np.inf)]
        # Within, where rounding of an angular speed leaves them.
        inside = max(low for low, _ in ends), min(high for _, high in ends)
        return inside[0] * (1.0 + ROUNDING), inside[1] * (1.0 - ROUNDING)

    def _beyond(self, low: float, high: float) -> InputError:
        """Return the error of tables that do not reach to where roots turn."""
        at = f"{self.actuator.resonance:g} Hz"
        hint = (
            "no gain is a limit there, and it is that of frequencies near or below the actuator's "
            f"resonance, {at}: extend the tables, or give an actuator of another resonance"
        )
        return inputs.faulty("tables of stiffness", f"have {low:g} to {high:g} Hz in common", hint)

    def _mobility(self, frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return the velocity of 1 N of the motor, at frequencies."""
        return self.powertrain._core.mobility(self.actuator, frequency)

    @property
    def applied_gain(self) -> float:
        """The gain, N·s/m: that given, or half of the largest."""
        if self.gain is not None:
            return self.gain
        return 0.5 * self.largest_gain

    @property
    def margin_db(self) -> float:
        """Largest gain over the gain, dB; below zero it is unstable."""
        if self.applied_gain == 0.0 or not np.isfinite(self.largest_gain):
            return np.inf
        return float(20.0 * np.log10(self.largest_gain / self.applied_gain))

    def ratio(self, frequency: Any) -> NDArray[np.float64]:  # noqa: ANN401 - an array
        """Return velocity with feedback over that without it, under any load of the engine.

        Parameters
        ----------
        frequency : array_like
            Frequencies, Hz.

        Returns
        -------
        ndarray of float
            ``abs(1/(1 + gT))`` at the place of the actuator; above 1 it is made worse.

        Raises
        ------
        InputError
            If a frequency is not above zero.
        """
        given = inputs.vector("frequency", frequency)
        if not (given > 0.0).all():
            raise inputs.rejected("frequency", frequency, "give numbers that are more than zero")
        return read_only(1.0 / np.abs(1.0 + self.applied_gain * self._mobility(given)))

    @property
    def table(self) -> Table:
        """Velocity with over without feedback, at each mode and where it is worst."""
        grid = self._grid
        if not np.isfinite(self.applied_gain):
            ratios: list[float | None] = [None] * (len(self._modes) + 1)
            at = None
        else:
            whole = 1.0 / np.abs(1.0 + self.applied_gain * self._on_grid)
            k = int(np.argmax(whole))
            ratios = [*self.ratio(self._modes).tolist(), float(whole[k])]
            at = float(grid[k])
        names = [f"mode {k + 1}" for k in range(len(self._modes))]
        columns = (
            Column("at", (*names, "worst")),
            Column("f", (*self._modes, at), "Hz"),
            Column("with/without", tuple(ratios)),
        )
        onset = "" if self.onset is None else f", where {self.onset:.5g} Hz grows"
        state = "stable" if self.margin_db > 0.0 else "unstable"
        if (cut := self._cut) is not None:
            onset += f", within the tables of stiffness, {cut[0]:g} to {cut[1]:g} Hz"
        note = units.Text(
            "Gain ", units.figure(self.applied_gain, "N·s/m", 6),
            f", {state}: margin {self.margin_db:.4g} dB to ",
            units.figure(self.largest_gain, "N·s/m", 6), f"{onset}.",
        )  # fmt: skip
        title = f"{self.powertrain._title}: velocity fed back through {self.actuator.name!r}"
        return Table(title, columns, note)


def velocity_feedback(powertrain: Powertrain, actuator: object, gain: object) -> VelocityFeedback:
    """Return the feedback; :meth:`Powertrain.velocity_feedback` documents the arguments."""
    if not isinstance(actuator, Actuator):
        raise inputs.rejected("actuator", actuator, "give a crankpin.Actuator")
    if actuator.mass is None or actuator.resonance is None:
        hint = "give mass and resonance, those of an inertial actuator"
        raise inputs.rejected("actuator", actuator.name, hint)
    number = None if gain is None else inputs.finite("gain", gain)
    if number is not None and number < 0.0:
        raise inputs.rejected("gain", gain, "give zero or more, N·s/m")
    return VelocityFeedback(powertrain, actuator, number)
