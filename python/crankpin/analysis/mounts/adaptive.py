"""Stability and convergence of a law that adapts actuators' phasors to what receivers measure.

w ← w − μ·Ŝᴴe with e = d + S w. In the singular vectors of S its parts are each by itself: with an
error φ of the model's phase, and D updates until one is measured, xₙ₊₁ = xₙ − a·e^{iφ}·xₙ₋D. Roots
of z^D(z − 1) + a·e^{iφ} leave the unit circle at a = 2 sin((π/2 − |φ|)/(2D + 1)).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.frames import Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin.analysis.mounts.active import Cancellation

QUARTER = 90.0
"""Phase error, degrees, at which no step converges."""
MOST_UPDATES = 1_000_000
"""Updates that are followed."""
MOST_UPDATE_DELAYS = 100
"""Largest delay in updates: rates are roots of polynomials of that degree."""


class AdaptiveLaw(Tabled):
    """Convergence of adaptive weights at each speed and order.

    Made by :meth:`Cancellation.adaptive`.
    """

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
    def frequency(self) -> NDArray[np.float64]:
        """Frequencies of the orders, Hz: (…, n_orders)."""
        return read_only(self._cancelled(self.cancellation._frequency()))

    def _cancelled(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the values of the orders that are cancelled, of (…, n_orders) of the response."""
        orders = self.cancellation.before.orders
        return values[..., [orders.index(order) for order in self.cancellation.orders]]

    @property
    def critical_delay(self) -> NDArray[np.float64]:
        """Delay at which no step converges, s: a quarter of the period: (…, n_orders).

        What is left of it where the model's phase is wrong otherwise.
        """
        left = max(0.0, QUARTER - abs(self.phase_error_deg)) / 360.0
        return read_only(left / self.frequency)

    @property
    def error_deg(self) -> NDArray[np.float64]:
        """Error of the model's phase with the delay, −180 to 180 degrees: (…, n_orders)."""
        error = self.phase_error_deg - 360.0 * self.frequency * self.delay
        return read_only(180.0 - np.mod(180.0 - error, 360.0))

    @property
    def largest_step(self) -> NDArray[np.float64]:
        """Step from which on it diverges, 0 where any does: (…, n_orders)."""
        left = np.maximum(QUARTER - np.abs(self.error_deg), 0.0)
        return read_only(2.0 * np.sin(np.radians(left) / (2 * self.update_delay + 1)))

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Whether it converges: (…, n_orders)."""
        return read_only(self.step < self.largest_step)

    @property
    def rate(self) -> NDArray[np.float64]:
        """Attenuation of the slowest part, dB per update, below zero of growth: (…, n_orders)."""
        sizes = self._sizes()
        rate = np.full(sizes.shape[:-1], np.inf)
        errors = np.exp(1j * np.radians(self.error_deg))
        for place in np.ndindex(rate.shape):
            for size in sizes[place]:
                if size > 0.0:
                    poly = np.zeros(self.update_delay + 2, dtype=complex)
                    poly[:2] = 1.0, -1.0
                    poly[-1] += self.step * size * errors[place]
                    largest = np.abs(np.roots(poly)).max(initial=0.0)
                    with np.errstate(divide="ignore"):  # at once
                        rate[place] = min(rate[place], -20.0 * np.log10(largest))
        return read_only(rate)

    def _sizes(self) -> NDArray[np.float64]:
        """Return squares of singular values over the largest: (…, n_orders, n)."""
        values = np.linalg.svd(self._effect(), compute_uv=False) ** 2
        first = values[..., :1]
        sizes = np.zeros(values.shape)
        np.divide(values, first, out=sizes, where=first > 0.0)
        # What rounding leaves of none is no part.
        return np.where(sizes > 1e-24, sizes, 0.0)

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
        left = np.linalg.svd(self._effect(), full_matrices=False)[0]
        parts = np.abs((np.swapaxes(left.conj(), -1, -2) @ target[..., None])[..., 0]) ** 2
        whole = (np.abs(target) ** 2).sum(axis=-1)
        beyond = np.maximum(whole - parts.sum(axis=-1), 0.0)
        factor = self.step * self._sizes() * np.exp(1j * np.radians(self.error_deg))[..., None]
        history = np.empty((*whole.shape, count + 1))
        late = [np.ones(factor.shape, dtype=complex)] * (self.update_delay + 1)
        for n in range(count + 1):
            rest = (parts * np.abs(late[-1]) ** 2).sum(axis=-1) + beyond
            history[..., n] = rest
            late = [*late[1:], late[-1] - factor * late[0]]
        ratio = np.full(history.shape, np.nan)
        np.divide(history, whole[..., None], out=ratio, where=whole[..., None] > 0.0)
        return read_only(np.sqrt(ratio))

    @property
    def table(self) -> Table:
        """Frequency, critical delay, phase error, largest step and rate of each order."""
        before, orders = self.cancellation.before, self.cancellation.orders
        shape = self.frequency.shape
        speeds = np.repeat(np.atleast_1d(np.asarray(before.rpm, dtype=float)), len(orders))
        columns = [Column("rpm", speeds, digits=10)] if before.dims else []
        columns.append(Column("order", tuple(orders) * (shape[0] if before.dims else 1)))
        figures = [
            ("f", self.frequency, "Hz"),
            ("critical delay", 1e3 * self.critical_delay, "ms"),
            ("phase error", self.error_deg, "°"),
            ("largest step", self.largest_step, ""),
            ("rate", self.rate, "dB/update"),
        ]
        columns += [Column(name, values, unit) for name, values, unit in figures]
        columns.append(Column("stable", self.stable))
        title = before._title(f"adaptive law of step {self.step:g}, by order")
        note = (
            f"It converges below the largest step, and with a phase error below {QUARTER:g}°. "
            "A rate below zero is growth."
        )
        return Table(title, tuple(columns), note)
