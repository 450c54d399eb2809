"""Hammer blow, variation of tractive effort and swaying couple of a locomotive."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.messages import suppressed
from crankpin._support.quantities import OF_WHEELS
from crankpin._support.tables import Table
from crankpin.analysis.geometry import direction
from crankpin.analysis.labelled import Labelled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from crankpin._support.frames import Frames
    from crankpin._support.quantities import Kind
    from crankpin.analysis.locomotive import Locomotive
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine


class LocomotiveForces(Labelled):
    """Hammer blow, variation of tractive effort and swaying couple over a turn of the wheels.

    Of inertia alone. The hammer blow is the vertical force of what turns with the wheels; that of
    slanting connecting rods acts between axle and frame. Made by :meth:`Locomotive.forces`.
    """

    locomotive: Locomotive
    """The locomotive."""
    rpm: float
    """Speed of the wheels, rpm."""
    theta_deg: NDArray[np.float64]
    """Angles of the wheels, degrees: (n_theta,)."""
    at_any_angle: bool = False
    """Whether peaks are those at any angle; else those at ``theta_deg``."""
    _along: ClassVar[tuple[str, ...]] = ("theta_deg",)
    _registry: ClassVar[Mapping[str, Kind]] = OF_WHEELS

    @property
    def engine(self) -> Engine:
        """The engine of the locomotive."""
        return self.locomotive.engine

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the angles of the wheels."""
        return {"theta_deg": self.theta_deg}

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"wheel": self.locomotive.wheels}

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; steam pressure makes no force."""
        return labels.without_gas(self.engine.loads_counted)

    @property
    def speed_kmh(self) -> float:
        """Speed of the locomotive, km/h; an AttributeError where its wheels are not known."""
        return self.rpm * self.locomotive._kmh_per_rpm

    @cached_property
    def _largest(self) -> dict[str, Any]:
        """Largest magnitudes at any angle."""
        with suppressed():  # Warned of where the forces were made.
            total = self.engine.balance(self.rpm, torque=False).total
        return {
            "hammer_blow": np.abs(self._turning),
            "tractive_variation": total.force.peak_xy[0],
            "swaying_couple": total.moment.peak_xy[1],
        }

    @property
    def _turning(self) -> NDArray[np.complex128]:
        """Force of the unbalance of each wheel at θ = 0, x + iy, N: (n_wheels,)."""
        omega = inputs.angular_speed(self.rpm)
        weights = self.locomotive.unbalances
        return np.array(
            [weight.amount * omega**2 * complex(direction(weight.angle_deg)) for weight in weights]
        )

    def _values(self, quantity: str) -> NDArray[np.float64]:
        if quantity == "hammer_blow":
            turned = np.multiply.outer(self._turning, direction(self.theta_deg))
            return -np.asarray(turned.imag)
        with suppressed():
            over_turn = self.engine.waveform(self.rpm, self.theta_deg, torque=False)
        if quantity == "swaying_couple":
            return np.asarray(over_turn.moment)[:, 1]
        return -np.asarray(over_turn.force)[:, 0]

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        if what == "peak" and self.at_any_angle:
            return np.asarray(self._largest[quantity])
        return super()._compute(quantity, what)

    @property
    def hammer_blow(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Hammer blow of each wheel, downwards on the rail, N: (n_wheels, n_theta)."""
        return self._quantity("hammer_blow")

    @property
    def tractive_variation(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of inertia on the frame in the direction of travel, N: (n_theta,)."""
        return self._quantity("tractive_variation")

    @property
    def swaying_couple(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Couple of inertia about the vertical through the middle, N·m: (n_theta,)."""
        return self._quantity("swaying_couple")

    @property
    def frames(self) -> Frames:
        """``table``; ``wheels``: the counterweights, as the table of the locomotive."""
        return self._frames(wheels=lambda: self.locomotive.table)

    @property
    def table(self) -> Table:
        """Largest forces; hammer blows beside the static load of their wheels."""
        loads = self.locomotive._loads or (None,) * len(self.locomotive.wheels)
        rows: list[tuple[str, str, float, float | None]] = [
            (OF_WHEELS[name].words, OF_WHEELS[name].unit, float(self._quantity(name).peak), None)
            for name in ("tractive_variation", "swaying_couple")
        ]
        rows += [
            (f"hammer blow, {wheel}", "N", peak, None if load is None else 100.0 * peak / load)
            for wheel, peak, load in zip(
                self.locomotive.wheels, self.hammer_blow.peak.tolist(), loads, strict=True
            )
        ]
        has_loads = bool(self.locomotive._loads)
        heads: list[str | tuple[str, str]] = ["quantity", "unit", "largest"]
        heads += [("of the static load", "%")] if has_loads else []
        speed = f"{self.rpm:.6g} rpm"
        if self.locomotive.wheel_diameter is not None:
            speed = f"{self.speed_kmh:.6g} km/h ({speed})"
        name = labels.one_line(self.locomotive.name) or "Locomotive"
        return Table.from_rows(
            units.Text(f"{name} at {speed}"),
            heads,
            [row if has_loads else row[:-1] for row in rows],
            loads=self.loads_counted,
            row_units=[unit for _, unit, *_ in rows],
        )
