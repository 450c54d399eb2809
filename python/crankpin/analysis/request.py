"""Operating point and options that balances, waveforms and sweeps share."""

from __future__ import annotations

from collections.abc import Iterable
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, Protocol

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.messages import Hint
from crankpin._support.quantities import PART_WORDS, PLANE_VECTORS, QUANTITIES, parts_of
from crankpin._support.record import AbsentError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from crankpin._support.inputs import Order, Orders, Spectrum

ENGINE_HINT = 'give a crankpin.Engine, such as Engine.preset("i4")'


class Caused(Protocol):
    """A result whose quantities have parts."""

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the causes of the quantities."""


class Request(NamedTuple):
    """Orders, tolerance, reference plane, spectrum and whether torque is computed; checked."""

    orders: tuple[Order, ...] | None
    """The orders given, or None for ``"auto"``."""
    rtol: float
    """Tolerance by which orders are chosen."""
    reference_z: float | None
    """Plane about which moments are taken, m; None for that of the engine."""
    pairs: tuple[tuple[int, complex], ...] | None
    """Spectrum as pairs of order and amplitude."""
    torque: bool
    """Whether torque is computed."""
    aside: tuple[float, float] = (0.0, 0.0)
    """Point of the cross-section about which the roll torque is taken, m; the crank's axis."""

    @classmethod
    def checked(
        cls,
        *,
        orders: Orders,
        rtol: float | None,
        spectrum: Spectrum | None,
        torque: bool,
        default_rtol: float = 1e-9,
    ) -> Request:
        """Return a request, or raise an InputError that names the argument at fault."""
        wanted = inputs.half_orders(orders)
        if wanted is not None and rtol is not None:
            hint = Hint.of('needs `orders="auto"`; leave out `rtol` or `orders`')
            raise inputs.rejected("rtol", rtol, hint)
        pairs = inputs.spectrum(spectrum)
        return cls(
            None if wanted is None else tuple(wanted),
            default_rtol if rtol is None else inputs.number("rtol", rtol),
            None,
            None if pairs is None else tuple(pairs),
            inputs.flag("torque", torque),
        )

    def about(self, name: str, point: object) -> Request:
        """Return the same request with moments about the point of a name: z, or (x, y, z), m."""
        if name == "z" or not isinstance(point, Iterable) or getattr(point, "ndim", 1) == 0:
            return self._replace(reference_z=inputs.finite(name, point), aside=(0.0, 0.0))
        hint = "point is a position z along the crank, or (x, y, z), m"
        coordinates = [
            inputs.finite(name, coordinate) for coordinate in inputs.items(name, point, hint)
        ]
        if len(coordinates) != 3:
            raise inputs.rejected(name, point, hint)
        x, y, z = coordinates
        return self._replace(reference_z=z, aside=(x, y))

    def at_orders(self, orders: tuple[Order, ...]) -> Request:
        """Return the same request of the orders given."""
        return self._replace(orders=orders)

    def loads_counted(self, loads: str) -> str:
        """Return the loads that a result counts, where more could: in torque gas pressure does."""
        if self.pairs is not None:
            return labels.SPECTRUM_GIVEN
        return loads if self.torque else labels.without_gas(loads)

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum as a read-only mapping, or None."""
        return None if self.pairs is None else MappingProxyType(dict(self.pairs))

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the available quantities."""
        return tuple(QUANTITIES) if self._has_torque else PLANE_VECTORS

    @property
    def _has_torque(self) -> bool:
        return self.torque and self.pairs is None

    def bounds(self, of_vectors_and_torque: Iterable[float]) -> Mapping[str, float]:
        """Return quantity → bound, of bounds on force, moment and torque about the crank's axis."""
        force, moment, torque = of_vectors_and_torque
        *_, roll = _core.bounds_about((force, moment, torque), (*self.aside, 0.0))
        bounds = dict(zip(QUANTITIES, (force, moment, roll, torque), strict=True))
        return MappingProxyType({name: bounds[name] for name in self.quantities})

    def named(self, quantities: tuple[str, ...], names: tuple[str, ...]) -> tuple[str, ...]:
        """Return the named quantities; if none is named, all with their parts."""
        existing = self.quantities
        parts = [part for quantity in existing for part in parts_of(quantity, names)]
        return check_quantities(quantities, (*existing, *parts))

    @staticmethod
    def parts(quantity: str, names: Sequence[str]) -> tuple[str, ...]:
        """Return the parts that may be asked for, of the names of what makes a quantity."""
        if QUANTITIES[quantity].planar or not names:
            return tuple(names)
        return tuple(dict.fromkeys((*PART_WORDS, *names)))

    def check(self, quantity: str, of: Caused | None = None) -> None:
        """Raise an error if a quantity, or a part of one of a result, is not available."""
        whole, point, _ = (
            quantity.partition(".") if isinstance(quantity, str) else (quantity, "", "")
        )
        kind = QUANTITIES[inputs.one_of("quantity", whole, QUANTITIES)]
        if point:
            names = ("inertia",) if of is None else of.causes
            if not names:
                raise inputs.rejected("quantity", quantity, f"has no parts here; give {whole!r}")
            parts = [f"{whole}.{part}" for part in self.parts(whole, names)]
            inputs.one_of("quantity", quantity, parts)
        if self._has_torque or kind.planar:
            return
        if self.pairs is not None:
            hint = Hint.of("a force spectrum does not determine it; leave out `spectrum`")
        else:
            hint = Hint.of("it was not requested; give `torque=True`")
        name = quantity.replace("_", " ")
        raise inputs.faulty(name, "is not available", hint, AbsentError)


def check_request(request: object, maker: str) -> Request:
    """Return a request, or raise an InputError that names functions returning such results."""
    if not isinstance(request, Request):
        raise inputs.rejected("request", request, f"use {maker}")
    return request


def engine_core(engine: object, name: str = "engine") -> _core.Engine:
    """Return the compiled counterpart of an engine; an InputError for other values."""
    core = getattr(engine, "_core", None)
    if not isinstance(core, _core.Engine):
        hint = "give its .fitted, an engine" if hasattr(engine, "fitted") else ENGINE_HINT
        raise inputs.rejected(name, engine, hint)
    return core


def check_quantities(names: tuple[str, ...], existing: tuple[str, ...]) -> tuple[str, ...]:
    """Return the quantities named, all that are known if none is named."""
    for name in names:
        inputs.one_of("quantity", name, existing)
    return names or existing
