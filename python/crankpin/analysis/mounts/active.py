"""Actuators against an engine's orders: phasors within limits, and their effect elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.quantities import CANCELLED
from crankpin._support.record import changed, computed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.export import VALUES
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.mounts.adaptive import MOST_UPDATE_DELAYS, AdaptiveLaw
from crankpin.analysis.mounts.response import SUPPORT, MountResponse, PointMotion
from crankpin.analysis.quantity import ALL
from crankpin.model.actuators import Actuator
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin._support.frames import Frames
    from crankpin._support.inputs import Order, Orders
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.mounts.response import Source
    from crankpin.analysis.quantity import Quantity
    from crankpin.analysis.request import Request

Direction: TypeAlias = "tuple[float, float, float] | None"
Place: TypeAlias = "tuple[str, Source, Direction]"
"""Name, what moves or pushes there, and the direction that counts, or None for all three."""

FORCES = ("body_force", "mount_force")
"""Quantities that can be minimised besides the motion of points."""
LEVEL = 1e-9
"""Share of a limit, or of an amplitude, by which rounding may exceed it."""


class DrivenResponse(MountResponse):
    """Response of a powertrain to its engine and to actuators: read as a response without them.

    ``wrench`` is that of both. Made by :meth:`Cancellation.response`.
    """

    powertrain: Powertrain
    """The powertrain."""
    rpm: NDArray[np.float64] | float
    """Crank speeds: an array where several were given, else a number."""
    _request: Request
    """Orders and tolerance, checked."""
    actuators: tuple[Actuator, ...]
    """The actuators."""
    forces: NDArray[np.complex128]
    """Peak phasors of their forces on the powertrain, N: (…, n_orders, n_actuators)."""
    engine_runs: bool = True
    """False for the actuators alone."""

    def _drive(self) -> tuple[Any, ...]:
        places = [(one.at, one.direction) for one in self.actuators]
        forces = np.reshape(np.asarray(self.forces, dtype=complex), (-1, len(places)))
        return ((places, np.ascontiguousarray(forces), self.engine_runs),)

    def _of_speed(self, index: int | slice) -> dict[str, Any]:
        return {"forces": self.forces[index]}

    def _of_order(self) -> dict[str, Any]:
        shape = (*self.forces.shape[:-2], 1, len(self.actuators))
        return {"forces": np.zeros(shape, dtype=complex)}

    _driven = ", with actuators"


class Cancellation(Labelled):
    """Forces of actuators that leave the least at receivers, order by order, and what they do.

    Limits of motor and stroke hold for each order by itself. A force of one order changes no other:
    the powertrain is linear. Made by :meth:`MountResponse.cancel`.
    """

    _along = ("order",)
    _registry = CANCELLED

    before: MountResponse
    """The response without actuators."""
    actuators: tuple[Actuator, ...]
    """The actuators."""
    receivers: tuple[Any, ...]
    """Minimised motions or forces: name, source, direction."""
    watched: tuple[Any, ...]
    """Other points that are reported."""
    orders: tuple[Order, ...]
    """Orders that are cancelled."""
    effort: float = 0.0
    """Weight of the forces relative to the residual."""
    norm: Literal["rms", "largest"] = "rms"
    """Minimised norm over the receivers: the sum of squares, or the largest."""
    amplitude_error: float = 0.0
    """Share by which all forces are too large."""
    phase_error_deg: float = 0.0
    """Angle by which all forces are ahead, degrees."""
    _forces: NDArray[np.complex128] = computed()
    _effect: NDArray[np.complex128] = computed()
    _target: NDArray[np.complex128] = computed()

    def __post_init__(self) -> None:
        if not isinstance(self.before, MountResponse):
            raise inputs.rejected("before", self.before, "use MountResponse.cancel")
        places = [self.before.orders.index(order) for order in self.orders]
        shape = np.shape(self._frequency())
        points = int(np.prod(shape))
        target = _stacked(self.before, self.receivers)
        effects = [_stacked(self._alone(one), self.receivers) for one in self.actuators]
        effect = np.stack(effects, axis=-1)
        bounds = np.stack([one.largest_force(self._frequency()) for one in self.actuators], -1)
        widths = [1 if direction else 3 for *_, direction in self.receivers]
        found = _core.actuator_phasors(
            np.ascontiguousarray(target.reshape(points, -1)),
            np.ascontiguousarray(effect.reshape(points, -1, len(self.actuators))),
            np.ascontiguousarray(bounds.reshape(points, -1)),
            self.effort,
            widths if self.norm == "largest" else None,
        )
        found = found.reshape(*shape, -1)
        error = (1.0 + self.amplitude_error) * np.exp(1j * np.radians(self.phase_error_deg))
        forces = np.zeros_like(found)
        forces[..., places, :] = found[..., places, :] * error
        self.__dict__.update(_forces=read_only(forces), _effect=effect, _target=target)
        super().__post_init__()

    def _frequency(self) -> NDArray[np.float64]:
        """Return nω over 2π, Hz: (…, n_orders) of the response."""
        speeds, orders = np.asarray(self.before.rpm, dtype=float), np.array(self.before.orders)
        return np.asarray(np.multiply.outer(speeds, orders.astype(float)) / 60.0)

    def _driven(
        self, actuators: tuple[Actuator, ...], forces: NDArray[Any], *, engine_runs: bool = True
    ) -> DrivenResponse:
        before = self.before
        if engine_runs and isinstance(before, DrivenResponse):
            actuators = (*before.actuators, *actuators)
            forces = np.concatenate([before.forces, forces], axis=-1)
        return DrivenResponse(
            before.powertrain, before.rpm, before._request, actuators, forces, engine_runs
        )

    def _alone(self, actuator: Actuator) -> DrivenResponse:
        """Return the response to 1 N of an actuator at every order."""
        unit = np.ones((*np.shape(self._frequency()), 1), dtype=complex)
        return self._driven((actuator,), unit, engine_runs=False)

    @cached_property
    def response(self) -> DrivenResponse:
        """Response with the actuators: forces, points, power, as one without them."""
        return self._driven(self.actuators, self._forces)

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: those of the response without actuators."""
        return self.before.coords

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"actuator": tuple(one.name for one in self.actuators)}

    def _dims(self, quantity: str, what: str = VALUES) -> tuple[str, ...]:
        return tuple(sorted(super()._dims(quantity, what), key=("actuator",).count))

    def _values(self, quantity: str) -> NDArray[Any]:
        places = [self.before.orders.index(order) for order in self.orders]
        if quantity == "residual":
            left = self._target + (self._effect @ self._forces[..., None])[..., 0]
            return _ratio(self._size(left), self._size(self._target))[..., places]
        forces = self._forces[..., places, :]
        if quantity == "utilisation":
            bounds = [one.largest_force(self._frequency()[..., places]) for one in self.actuators]
            return np.asarray(np.abs(forces) / np.stack(bounds, axis=-1))
        return forces

    @property
    def forces(self) -> Quantity[np.complex128]:
        """Peak phasors of the actuators' forces on the powertrain, N: (…, n_orders, n_actuators).

        Of the orders that are cancelled; those of others are zero.
        """
        return self._quantity("forces")

    @property
    def residual(self) -> Quantity[np.float64]:
        """Residual at all receivers over the value without actuators: (…, n_orders).

        Of the orders that are cancelled; NaN where there was nothing. Of the norm ``"largest"`` the
        largest of the receivers over the largest.
        """
        return self._quantity("residual")

    def _size(self, values: NDArray[np.complex128]) -> NDArray[np.float64]:
        """Return the objective of phasors of the receivers side by side: (…, n_orders)."""
        if self.norm == "rms":
            return np.asarray(np.linalg.norm(values, axis=-1))
        ends = np.cumsum([1 if direction else 3 for *_, direction in self.receivers])
        parts = np.split(values, ends[:-1], axis=-1)
        return np.asarray(np.max([np.linalg.norm(part, axis=-1) for part in parts], axis=0))

    @property
    def utilisation(self) -> Quantity[np.float64]:
        """Force over the largest that motor and stroke allow: (…, n_orders, n_actuators)."""
        return self._quantity("utilisation")

    def with_error(self, *, amplitude: float = 0.0, phase_deg: float = 0.0) -> Cancellation:
        """Return the same forces with errors, as of shafts that follow the crank inexactly.

        Of a perfect cancellation ``abs(1 − (1 + ε)·exp(iδ))`` is left: 20 dB of attenuation need
        less than 5.7°.

        Parameters
        ----------
        amplitude : float, default 0.0
            Share ε by which the forces are too large.
        phase_deg : float, default 0.0
            Angle δ by which they are ahead, degrees.

        Returns
        -------
        Cancellation
            The same with these errors; limits are not checked again.

        Raises
        ------
        InputError
            If a figure is not finite.
        """
        share = inputs.limited("amplitude", amplitude)
        ahead = inputs.finite("phase_deg", phase_deg)
        return changed(self, amplitude_error=share, phase_error_deg=ahead)

    def adaptive(
        self,
        *,
        step: float = 0.05,
        delay: float = 0.0,
        phase_error_deg: float = 0.0,
        update_delay: int = 0,
    ) -> AdaptiveLaw:
        """Return how a law that adapts a complex weight per order and actuator converges.

        w ← w − μ·Ŝᴴe (narrowband filtered-x LMS), Ŝ the model of what actuators do at the
        receivers.

        Parameters
        ----------
        step : float, default 0.05
            μ times the largest singular value of S squared: of one channel μ|S|².
        delay : float, default 0.0
            Delay of the loop that the model does not have, s.
        phase_error_deg : float, default 0.0
            Further error of the model's phase, degrees.
        update_delay : int, default 0
            Updates after which the effect of one is measured.

        Returns
        -------
        AdaptiveLaw
            Limits of stability and rate of convergence of each order.

        Raises
        ------
        InputError
            If an argument is out of range.
        """
        size = inputs.positive("step", step)
        late = inputs.finite("delay", delay)
        if late < 0.0:
            raise inputs.rejected("delay", delay, "give zero or more, s")
        error = inputs.finite("phase_error_deg", phase_error_deg)
        updates = inputs.whole("update_delay", update_delay, 0, MOST_UPDATE_DELAYS)
        return AdaptiveLaw(self, size, late, error, updates)

    # --- tables -----------------------------------------------------------------------------------

    def _elsewhere(self) -> list[Place]:
        """Return what is not minimised: points watched, the body, each mount."""
        names = self.before.powertrain.names
        further: list[Place] = [*self.watched, ("body", ("support",), None)]
        further += [(f"mount {name}", ("mount", k), None) for k, name in enumerate(names)]
        own = [source for _, source, _ in self.receivers]
        return [each for each in further if each[1] not in own]

    def _rms(self, place: Place, order: Order | None) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the rms value before and after, of one order or of all together: (…,)."""
        pair = []
        for result in (self.before, self.response):
            squares = (np.abs(_values(result, place)) ** 2).sum(axis=-1) / 2.0
            which = slice(None) if order is None else [self.before.orders.index(order)]
            pair.append(np.sqrt(squares[..., which].sum(axis=-1)))
        return pair[0], pair[1]

    def _rows(self) -> list[tuple[Any, ...]]:
        """Return place, role, order, unit, and rms before and after over the speeds."""
        roles = [(each, "minimised") for each in self.receivers]
        roles += [(each, "elsewhere") for each in self._elsewhere()]
        rows = []
        for place, role in roles:
            unit = "m/s" if place[1][0] == "at" else "N"
            for order in (*self.orders, None):
                before, after = self._rms(place, order)
                rows.append((place[0], role, ALL if order is None else order, unit, before, after))
        return rows

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.before.loads_counted

    @property
    def table(self) -> Table:
        """Rms values with and without actuators: minimised, and elsewhere, by order and in all.

        Of several speeds the largest values, and where a value is raised most.
        """
        rows = self._rows()
        names, role, order, unit, before, after = zip(*rows, strict=True)
        largest = [(float(np.max(a)), float(np.max(b))) for a, b in zip(before, after, strict=True)]
        ratio = tuple(b / a if a > 0.0 else None for a, b in largest)
        columns = [
            Column("place", names),
            Column("role", role),
            Column("order", order),
            Column("before", tuple(a for a, _ in largest)),
            Column("after", tuple(b for _, b in largest)),
            Column("unit", unit),
            Column("after/before", ratio),
        ]
        if self.before.dims:
            ratios = [_ratio(b, a) for a, b in zip(before, after, strict=True)]
            worst = [None if np.isnan(each).all() else int(np.nanargmax(each)) for each in ratios]
            speeds = np.asarray(self.before.rpm)
            most = (
                None if k is None else float(each[k]) for each, k in zip(ratios, worst, strict=True)
            )
            where = (None if k is None else float(speeds[k]) for k in worst)
            columns += [Column("at most", tuple(most)), Column("at", tuple(where), "rpm", 10)]
        over = ", largest over speed" if self.before.dims else ""
        title = self.before._title(f"rms with and without actuators{over}")
        return Table(title, tuple(columns), self._notes(rows), self.loads_counted, unit)

    def _notes(self, rows: list[tuple[Any, ...]]) -> str:
        notes = []
        raised = [
            name
            for name, role, order, _, before, after in rows
            if role == "elsewhere"
            and order == ALL
            and np.any(np.asarray(after) > (1.0 + LEVEL) * np.asarray(before))
        ]
        if raised:
            at = " at some speed" if self.before.dims else ""
            notes.append(f"Raised{at}: {', '.join(raised)}.")
        others = [order for order in self.before.orders if order not in self.orders]
        if others:
            notes.append(f"{labels.orders_text(tuple(others)).capitalize()}: as before.")
        together = self.read("utilisation").sum(axis=-2)
        for k, one in enumerate(self.actuators):
            share = float(np.max(together[..., k]))
            if len(self.orders) > 1 and share > 1.0 + LEVEL:
                notes.append(
                    f"Limits hold order by order: all together can need {share:.3g} times what "
                    f"{one.name} has."
                )
        return " ".join(notes)

    @property
    def frames(self) -> Frames:
        """``table``; ``actuators``: force, stroke and share of the limit used, by order."""
        return self._frames(actuators=self._of_actuators)

    def _of_actuators(self) -> Table:
        swept = bool(self.before.dims)
        places = [self.before.orders.index(order) for order in self.orders]
        frequency = self._frequency()[..., places]
        used, forces = self.read("utilisation"), self.read("forces")
        speeds = np.asarray(self.before.rpm, dtype=float)
        rows: list[list[Any]] = []
        for j, one in enumerate(self.actuators):
            for place, order in enumerate(self.orders):
                size = np.abs(forces[..., place, j])
                key = np.where(np.isfinite(size), used[..., place, j], 0.0)
                row = int(np.argmax(key if np.any(key) else size)) if swept else 0
                at = (row, place, j) if swept else (place, j)
                hertz, force = float(frequency[at[:-1]]), complex(forces[at])
                limit = float(one.largest_force(hertz))
                has_limit = np.isfinite(limit)
                rows.append(
                    [
                        one.name,
                        order,
                        *([float(speeds[row])] if swept else []),
                        hertz,
                        abs(force),
                        float(np.degrees(np.angle(force))) + 0.0,
                        limit if has_limit else None,
                        100.0 * abs(force) / limit if has_limit else None,
                        1e3 * float(one.stroke_of(abs(force), hertz)) if one.mass else None,
                        float(one.motor_force(abs(force), hertz)),
                        1e6 * abs(force) / (2.0 * np.pi * hertz) ** 2,
                    ]
                )
        heads = [("actuator", ""), ("order", ""), *([("at", "rpm")] if swept else [])]
        heads += [("f", "Hz"), ("force", "N"), ("phase", "°"), ("limit", "N"), ("used", "%")]
        heads += [("stroke", "mm"), ("motor", "N"), ("force/ω²", "kg·mm")]
        columns = zip(heads, zip(*rows, strict=True), strict=True)
        title = self.before._title(
            "forces of actuators" + (", where most is used" if swept else "")
        )
        listed = tuple(Column(name, values, unit) for (name, unit), values in columns)
        return Table(title, listed, "", self.loads_counted)


def _values(result: MountResponse, place: Place) -> NDArray[np.complex128]:
    """Return phasors of a place: (…, n_orders, 3), or along its direction (…, n_orders, 1)."""
    _, source, direction = place
    vectors = result._vectors(source)
    return vectors if direction is None else vectors @ np.array(direction)[:, None]


def _stacked(result: MountResponse, places: Sequence[Place]) -> NDArray[np.complex128]:
    """Return phasors of all receivers side by side: (…, n_orders, n_receivers)."""
    return np.concatenate([_values(result, place) for place in places], axis=-1)


def _ratio(after: NDArray[np.float64], before: NDArray[np.float64]) -> NDArray[np.float64]:
    ratio = np.full(np.shape(before), np.nan)
    np.divide(after, before, out=ratio, where=before > 0.0)
    return read_only(ratio)


# --- arguments ------------------------------------------------------------------------------------


def cancel(
    response: MountResponse,
    actuators: object,
    receivers: object,
    *,
    orders: Orders | None,
    watch: object,
    effort: float,
    norm: str,
) -> Cancellation:
    """Return the cancellation; :meth:`MountResponse.cancel` documents the arguments."""
    listed = [actuators] if isinstance(actuators, Actuator) else actuators
    hint = "give a list of crankpin.Actuator"
    given = inputs.items("actuators", listed, hint)
    for k, one in enumerate(given):
        if not isinstance(one, Actuator):
            raise inputs.rejected(f"actuators[{k}]", one, hint)
        if any(one.name == other.name for other in given[:k]):
            raise inputs.rejected(f"actuators[{k}].name", one.name, "give each its own name")
    if not given:
        raise inputs.rejected("actuators", actuators, hint)
    weight = inputs.finite("effort", effort)
    if weight < 0.0:
        raise inputs.rejected("effort", effort, "give zero or more")
    inputs.one_of("norm", norm, ("rms", "largest"))
    if norm == "largest" and weight > 0.0:
        raise inputs.rejected("effort", effort, 'is that of the norm "rms"; leave it out')
    chosen = list(response.orders)
    if orders is not None and (wanted := inputs.half_orders(orders)) is not None:
        chosen = [order for order in response.orders if order in wanted]
        if absent := [order for order in wanted if order not in response.orders]:
            hint = f"is not among the orders of the response: {labels.orders_text(response.orders)}"
            raise inputs.rejected("orders", absent[0], hint)
    if not chosen:
        raise inputs.rejected("orders", orders, "give one order or more")
    places = _places("receivers", receivers, response)
    watched = () if watch is None else _places("watch", watch, response)
    shared = (response, tuple(given), places, watched, tuple(chosen), weight)
    return Cancellation(*shared, norm)  # type: ignore[arg-type] # checked


def _places(name: str, given: object, response: MountResponse) -> tuple[Place, ...]:
    """Return points, with their directions, or forces by name."""
    points = tuple(dict(getattr(response.powertrain.support, "receivers", None) or ()))
    if isinstance(given, str):
        names, chosen = response.powertrain.names, inputs.one_of(name, given, (*FORCES, *points))
        forces: dict[str, tuple[Place, ...]] = {
            "body_force": (("body", ("support",), None),),
            "mount_force": tuple((f"mount {n}", ("mount", k), None) for k, n in enumerate(names)),
        }
        if chosen in forces:
            return forces[chosen]
        given = [given]
    hint = (
        "give points (x, y, z), names of receivers, motions of response.at(…), or pairs of one of "
        'these and a direction; or "body_force"'
    )
    given = [given] if isinstance(given, PointMotion) else given
    if isinstance(given, Mapping):
        pairs = [(inputs.text(name, key), value) for key, value in given.items()]
    else:
        pairs = [("", value) for value in inputs.items(name, given, hint)]
        if pairs and all(np.isscalar(one) and not isinstance(one, str) for _, one in pairs):
            pairs = [("", [value for _, value in pairs])]
    places: list[Place] = []
    for key, value in pairs:
        parts: Any = (
            [value] if isinstance(value, str | PointMotion) else inputs.items(name, value, hint)
        )
        along = None
        if len(parts) == 2:
            direction = np.array(_vector(f"{name}: direction", parts[1]))
            length = float(np.linalg.norm(direction))
            if length == 0.0:
                raise inputs.rejected(f"{name}: direction", parts[1], "give one above zero")
            parts, along = parts[0], tuple((direction / length).tolist())
        point, on = _point(name, parts, points)
        words = point if isinstance(point, str) else "({:g}, {:g}, {:g})".format(*point)
        places.append((key or words, ("at", point, on, "velocity"), along))
    if not places:
        raise inputs.rejected(name, [], hint)
    return tuple(places)


def _point(name: str, given: Any, points: tuple[str, ...]) -> tuple[Any, str]:  # noqa: ANN401 - checked here
    """Return a place or the name of a receiver, and what it moves with."""
    one = given[0] if isinstance(given, list) and len(given) == 1 else given
    if isinstance(one, PointMotion):
        return one.point, one.on
    if isinstance(one, str):
        return inputs.one_of(name, one, points), SUPPORT
    return _vector(name, given), "powertrain"
