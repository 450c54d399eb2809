"""Results that have force, moment and torques: balances, sweeps, waveforms."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic

from crankpin._support import labels
from crankpin._support.quantities import kind_of, parts_of
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.quantity import Element, Quantity, Value, Values

if TYPE_CHECKING:
    from crankpin.analysis.request import Request


class ShakingQuantities(Generic[Element, Values, Value]):
    """Mixin of what has force, moment and torques."""

    def _quantity(self, name: str) -> Quantity[Any, Any, Any]:
        raise NotImplementedError

    @property
    def force(self) -> Quantity[Element, Values, Value]:
        """Shaking force along x and y, N: (…, n_orders, 2) or (…, n_theta, 2)."""
        return self._quantity("force")

    @property
    def moment(self) -> Quantity[Element, Values, Value]:
        """Rocking moment about x (pitch) and y (yaw), N·m: shaped as ``force``."""
        return self._quantity("moment")

    @property
    def torque(self) -> Quantity[Element, Values, Value]:
        """Roll torque on the block about +z, N·m: (…, n_orders) or (…, n_theta).

        Of inertia forces, and of gas if it counts. An AttributeError where it was not requested, or
        a force spectrum does not determine it.
        """
        return self._quantity("torque")

    @property
    def crank_torque(self) -> Quantity[Element, Values, Value]:
        """Torque on the crank about +z, N·m: (…, n_orders) or (…, n_theta).

        Of inertia forces, and of gas if it counts. An AttributeError where it was not requested, or
        a force spectrum does not determine it.
        """
        return self._quantity("crank_torque")


class Shaking(ShakingQuantities[Element, Values, Value], Labelled, Generic[Element, Values, Value]):
    """Base class of results that have force, moment and torques, by a request."""

    if TYPE_CHECKING:

        @property
        def request(self) -> Request:
            """The options of the result, checked."""

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return False

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return ("inertia",)

    def _quantity(self, name: str) -> Quantity[Element, Values, Value]:
        return Quantity(self, name)

    @property
    def _names(self) -> tuple[str, ...]:
        return self.request.named((), self.causes)

    def _check(self, quantity: str) -> None:
        self.request.check(quantity, self)

    def _parts(self, quantity: str) -> tuple[str, ...]:
        return parts_of(quantity, self.causes)

    def _named_parts(self, quantity: str) -> tuple[str, ...]:
        return self.request.parts(quantity, self.causes)

    def _loads_of(self, quantity: str) -> str:
        if self.request.pairs is not None or not kind_of(quantity).planar:
            return self.loads_counted
        return labels.without_gas(self.loads_counted)
