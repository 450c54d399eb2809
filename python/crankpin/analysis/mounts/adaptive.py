"""Stability and convergence of a law that adapts actuators' phasors to what receivers measure."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.quantities import ADAPTED
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.labelled import Labelled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.mounts.active import Cancellation
    from crankpin.analysis.quantity import Quantity

QUARTER = 90.0
"""Phase error, degrees, at which no step converges."""
MOST_UPDATES = 1_000_000
"""Updates that are followed."""
MOST_UPDATE_DELAYS = 100
"""Largest delay in updates: rates are roots of polynomials of that degree."""


class AdaptiveLaw(Labelled):
    """Convergence of adaptive weights at each speed and order.

    Made by :meth:`Cancellation.adaptive`.
    """

    _along = ("order",)
    _registry = ADAPTED

    cancellation: Cancellation
    """The cancellation to which it converges."""
    step: float
    """μ times the largest singular value squared of what actuators do at the receivers."""
    delay: float
    """Delay of the loop that the model does not have, s."""
    phase_error_deg: float
    """Further error of the model's phase, degrees."""
    update_delay: int
    """Updates after which the effect of one is measured."""

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: those of the response without actuators."""
        return self.cancellation.before.coords

    @property
    def orders(self) -> tuple[Order, ...]:
        """Orders that are cancelled."""
        return self.cancellation.orders

    def _values(self, quantity: str) -> NDArray[np.float64]:
        frequency = self._cancelled(self.cancellation._frequency())
        if quantity == "critical_delay":
            left = max(0.0, QUARTER - abs(self.phase_error_deg)) / 360.0
            return np.asarray(left / frequency)
        if quantity == "error_deg":
            error = self.phase_error_deg - 360.0 * frequency * self.delay
            return np.asarray(180.0 - np.mod(180.0 - error, 360.0))
        if quantity == "frequency":
            return frequency
        found = self._law.largest_steps() if quantity == "largest_step" else self._law.rates()
        return np.reshape(found, frequency.shape)

    @property
    def frequency(self) -> Quantity[np.float64]:
        """Frequencies of the orders, Hz: (…, n_orders)."""
        return self._quantity("frequency")

    def _cancelled(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the values of the orders that are cancelled, of (…, n_orders) of the response."""
        orders = self.cancellation.before.orders
        return values[..., [orders.index(order) for order in self.cancellation.orders]]

    @property
    def critical_delay(self) -> Quantity[np.float64]:
        """Delay at which no step converges, s: a quarter of the period: (…, n_orders).

        What is left of it where the model's phase is wrong otherwise.
        """
        return self._quantity("critical_delay")

    @property
    def error_deg(self) -> Quantity[np.float64]:
        """Error of the model's phase with the delay, −180 to 180 degrees: (…, n_orders)."""
        return self._quantity("error_deg")

    @cached_property
    def _law(self) -> _core.AdaptiveLaw:
        effect, errors = self._effect(), self.read("error_deg").ravel()
        points = np.ascontiguousarray(effect.reshape(-1, *effect.shape[-2:]))
        return _core.AdaptiveLaw(points, errors, self.step, self.update_delay)

    @property
    def largest_step(self) -> Quantity[np.float64]:
        """Step from which on it diverges, 0 where any does: (…, n_orders)."""
        return self._quantity("largest_step")

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Whether it converges: (…, n_orders)."""
        return read_only(self.step < self.read("largest_step"))

    @property
    def rate(self) -> Quantity[np.float64]:
        """Attenuation of the slowest part, dB per update, below zero of growth: (…, n_orders)."""
        return self._quantity("rate")

    def _effect(self) -> NDArray[np.complex128]:
        effect = self.cancellation._effect
        return np.moveaxis(self._cancelled(np.moveaxis(effect, -3, -1)), -1, -3)

    def residual(self, updates: int) -> NDArray[np.float64]:
        """Return what is left at the receivers after each update, over what there was.

        Parameters
        ----------
        updates : int
            Number of updates.

        Returns
        -------
        ndarray of float, shape (…, n_orders, updates + 1)
            Rms of all receivers over that without actuators; NaN where there was nothing.

        Raises
        ------
        InputError
            If it is below zero, or too large.
        """
        count = inputs.whole("updates", updates, 0, MOST_UPDATES)
        target = self.cancellation._target
        target = np.moveaxis(self._cancelled(np.moveaxis(target, -1, 0)), 0, -1)
        rows = np.ascontiguousarray(target.reshape(-1, target.shape[-1]))
        found = self._law.residuals(rows, count)
        return read_only(found.reshape(*target.shape[:-1], count + 1))

    @property
    def table(self) -> Table:
        """Frequency, critical delay, phase error, largest step and rate of each order."""
        before, orders = self.cancellation.before, self.cancellation.orders
        shape = self.frequency.shape
        speeds = np.repeat(np.atleast_1d(np.asarray(before.rpm, dtype=float)), len(orders))
        columns = [Column("rpm", speeds, digits=10)] if before.dims else []
        columns.append(Column("order", tuple(orders) * (shape[0] if before.dims else 1)))
        figures = [
            ("f", self.read("frequency"), "Hz"),
            ("critical delay", 1e3 * self.critical_delay, "ms"),
            ("phase error", self.read("error_deg"), "°"),
            ("largest step", self.read("largest_step"), ""),
            ("rate", self.read("rate"), "dB/update"),
        ]
        columns += [Column(name, values, unit) for name, values, unit in figures]
        columns.append(Column("stable", self.stable))
        title = before._title(f"adaptive law of step {self.step:g}, by order")
        note = (
            f"It converges below the largest step, and with a phase error below {QUARTER:g}°. "
            "A rate below zero is growth."
        )
        return Table(title, tuple(columns), note)
