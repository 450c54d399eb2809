"""Response of a powertrain on its mounts to the engine's orders, over speed."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import Hint, warn
from crankpin._support.quantities import COMPONENTS_OF_LOADS, MOTIONS, MOUNTED
from crankpin._support.record import AbsentError, changed, read_only
from crankpin._support.tables import Column, Item, Table
from crankpin.analysis import export
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.export import VALUES
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.quantity import ALL, Key, Keyed, Quantity, order_key
from crankpin.analysis.request import Request, check_request
from crankpin.model import checks
from crankpin.model.mounts import _vector
from crankpin.model.supports import Receptance, Subframe

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin._support.quantities import Kind
    from crankpin.analysis.mounts.active import Cancellation
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.model.actuators import Actuator
    from crankpin.model.base_motion import BaseMotion
    from crankpin.model.engine import Engine
    from crankpin.model.vehicle_axes import VehicleAxes

Source: TypeAlias = tuple[Any, ...]
"""Origin of a vector: ``("support",)``, ``("mount", index)``, ``("at", point, on, name)``."""
READ = {"displacement": ("µm", 1e6), "velocity": ("mm/s", 1e3), "acceleration": ("m/s²", 1.0)}
"""Motion of a point → the unit in which it is read, and how many of it the unit of the array is."""
OF_SUBFRAME = ("ground_force", "subframe_motion")
"""Quantities of a response on a subframe."""
OF_BASE = ("base_motion", "base_transmissibility")
"""Quantities of a response on a base that moves."""
MOTION_COMPONENTS = ("x", "y", "z", "about x", "about y", "about z")
"""Names of displacements along the axes and rotations about them."""
HIGHEST_GRADE = "> 180"
"""Text of an infinite grade."""
SECONDS_PER_MINUTE = 60.0
SUPPORT = "support"
"""Name of the support, beside a place on it."""
SCOPE = (
    "ISO 10816-6:1995: reciprocating machines above 100 kW, not in road vehicles; rms of 2 Hz to "
    "1000 Hz."
)
"""Scope of severity grades."""


def response(
    powertrain: Powertrain,
    rpm: ArrayLike,
    *,
    orders: Orders,
    rtol: float | None,
    base: BaseMotion | None = None,
) -> MountResponse:
    """Return the response; :meth:`Powertrain.response` documents the arguments."""
    request = Request.checked(orders=orders, rtol=rtol, spectrum=None, torque=True)
    speeds = inputs.array("rpm", rpm)
    checked: Any = inputs.copied(inputs.vector("rpm", speeds)) if speeds.ndim else float(speeds)
    given = (powertrain, checked, request)
    response = MountResponse(*given) if base is None else BaseResponse(*given, base)
    if powertrain.engine is not None:
        inputs.warn_of_units(mean_piston_speed(powertrain.engine, float(np.max(speeds))))
    _warn_of_free_motion(response)
    return response


def response_to(base: BaseMotion, powertrain: Powertrain) -> BaseResponse:
    """Return the response to a base that moves by frequency alone, which is order 1 of a speed."""
    rpm: Any = SECONDS_PER_MINUTE * base._numbers
    request = Request.checked(orders=1, rtol=None, spectrum=None, torque=True)
    response = BaseResponse(powertrain, rpm if len(rpm) > 1 else float(rpm[0]), request, base)
    _warn_of_free_motion(response)
    return response


def _warn_of_free_motion(response: MountResponse) -> None:
    """Warn of a motion that no mount resists."""
    powertrain = response.powertrain
    if isinstance(powertrain.support, Receptance):
        powertrain = powertrain.with_support(None)  # What no mount resists is free on anything.
    frequency = None
    if powertrain._varies:
        turns = (
            np.multiply.outer(np.asarray(response.rpm), np.array(response.orders, dtype=float))
            / 60.0
        )
        frequency = float(np.min(turns, where=turns > 0.0, initial=np.inf))
        if frequency == np.inf:
            return
    try:
        free = powertrain._free(powertrain._core.free_motions(frequency))
    except InputError:  # where a hydraulic mount has no modes
        return
    if free:
        are, them = ("is", "it") if len(free) == 1 else ("are", "them")
        motions = f"{'; '.join(free)} {are} free, as of a body without mounts"
        hint = f"add a mount that resists {them}, or stiffness"
        warn("mounts", f"= {', '.join(powertrain.names)}: {motions}", hint)


class PointMotion(Labelled):
    """Motion of a point of the powertrain, or of what carries it.

    Made by :meth:`MountResponse.at`.
    """

    result: MountResponse
    """The response that it belongs to."""
    point: tuple[float, float, float] | str
    """Place, m, or the name of a receiver."""
    on: str
    """``"powertrain"`` or ``"support"``: what the place moves with."""
    order: Key = None
    """The order; ``"all"`` for all orders together, None for every order."""

    @property
    def _words(self) -> str:
        """Place, in words."""
        if isinstance(self.point, str):
            return f"{self.point!r}"
        on = " on the support" if self.on == SUPPORT else ""
        converted = units.convert("m")
        place = ", ".join(f"{converted.factor * float(x):.6g}" for x in self.point)
        return f"the point ({place}) {converted.unit}{on}"

    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = MOTIONS

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.result.orders

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the speeds, where there are several."""
        return self.result.coords

    def _quantity(self, name: str) -> Quantity[np.complex128]:
        return Quantity(self, name, self.order)

    def _words_of(self, quantity: Quantity) -> str:
        return f"{quantity.kind.words} of {self._words}"

    @property
    def _vehicle(self) -> VehicleAxes | None:
        return self.result._vehicle

    def _values(self, quantity: str) -> NDArray[np.complex128]:
        return self.result._vectors(("at", self.point, self.on, quantity))

    def _at_order(self, order: Order) -> PointMotion:
        return changed(self, result=self.result._at_order(order))

    def _table_of(self, quantity: Quantity) -> Table:
        return self.result._table_of(quantity)

    @property
    def displacement(self) -> Quantity[np.complex128]:
        """Displacement along x, y and z, m: (…, n_orders, 3)."""
        return self._quantity("displacement")

    @property
    def velocity(self) -> Quantity[np.complex128]:
        """Velocity along x, y and z, m/s: (…, n_orders, 3)."""
        return self._quantity("velocity")

    @property
    def acceleration(self) -> Quantity[np.complex128]:
        """Acceleration along x, y and z, m/s²: (…, n_orders, 3)."""
        return self._quantity("acceleration")

    @property
    def base_transmissibility(self) -> NDArray[np.float64]:
        """Magnitude along x, y and z over that of the base there: (…, n_orders, n_axes).

        Of a response on a base that moves; NaN where that does not move in the direction.
        """
        if isinstance(self.point, str) or self.on == SUPPORT:
            hint = "give a place of the powertrain"
            raise inputs.faulty("base_transmissibility", "is undefined", hint, AbsentError)
        moved, base = self.read("displacement"), self.result._base_at(self.point)
        ratio = ratio_of(moved, base)
        if self.order in (None, ALL):
            return ratio
        return np.asarray(ratio[..., self.orders.index(self.order), :])

    @property
    def grade(self) -> Any:  # noqa: ANN401 - a number at one speed
        """Vibration severity grade of ISO 10816-6 at each speed: (…).

        The worst of the rms displacement, velocity and acceleration along x, y and z, each of 2 Hz
        to 1000 Hz, of all orders together: 1.1, 1.8, 2.8, 4.5, 7.1, 11, 18, 28, 45, 71, 112 or 180;
        infinite above. The standard is for reciprocating machines above 100 kW that do not drive
        road vehicles; which zone a grade is in depends on the machine's class there.
        """
        if self.order not in (None, ALL):
            raise inputs.rejected("order", self.order, "grade is that of all orders together")
        place = self.result._core_place(self.point)
        grades = self.result._by_speed(self.result._core.grades(place, self.on == SUPPORT))
        return grades if grades.ndim else float(grades)

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.result.loads_counted

    @property
    def table(self) -> Table:
        """Rms values of displacement, velocity and acceleration, and the severity grade.

        By order at one speed, else of all orders together at each speed.
        """
        result, order, note = self.result, self.order, ""
        whole = result.dims or order is not None
        if result.dims:
            columns = [result._speeds()]
            order = ALL if order is None else order
        elif whole:
            columns = [Column("order", (order,))]
        else:
            places, note = result._shown()
            columns = [Column("order", (*(result.orders[k] for k in places), ALL))]
        for name, (unit, factor) in READ.items():
            moved = Quantity(self, name, order)
            if whole:
                values = np.atleast_1d(moved.rms)
            else:
                values = np.append(np.asarray(moved.rms)[places], moved.total.rms)
            columns.append(Column(f"{name} rms", factor * values, unit))
        if result.dims and len(speeds := columns[0].data) > 1:
            largest = int(np.argmax(columns[2].data))
            most = units.figure(columns[2].data[largest], "mm/s", 4)
            at = f" at {speeds[largest]:.10g} {columns[0].unit or columns[0].name}."
            note = units.Text("Largest velocity ", most, at)
        if self.order in (None, ALL):
            grades = [
                HIGHEST_GRADE if g == np.inf else g for g in np.atleast_1d(self.grade).tolist()
            ]
            columns.append(
                Column("grade", (*[None] * (len(columns[0].values) - len(grades)), *grades))
            )
            note = units.joined(" ", [note, f"Grade: {SCOPE}"])
        which = "" if order in (None, ALL) else f", order {order}"
        title = result._title(f"motion of {self._words}{which}")
        return Table(title, tuple(columns), note, loads=self.loads_counted)


def _require_subframe(powertrain: Powertrain, name: str) -> None:
    """Raise an error where no subframe carries the mounts."""
    if not isinstance(powertrain.support, Subframe):
        hint = "no subframe carries the mounts; give one, p.with_support(cp.Subframe(…))"
        raise inputs.faulty(name, "is undefined", hint, AbsentError)


def ratio_of(part: NDArray[Any], whole: NDArray[Any]) -> NDArray[np.float64]:
    """Return the ratio of magnitudes, NaN where there is nothing."""
    size = np.abs(whole)
    ratio = np.full(size.shape, np.nan)
    np.divide(np.abs(part), size, out=ratio, where=size > 0.0)
    return ratio


class MountQuantities:
    """Mixin of a response and of one of its orders: the vectors that both have."""

    if TYPE_CHECKING:

        def _quantity(self, name: str) -> Quantity[Any, Any, Any]: ...

    @property
    def body_force(self) -> Quantity[np.complex128]:
        """Sum of the mounts' forces on what carries them, N: (…, n_orders, 3)."""
        return self._quantity("body_force")

    @property
    def mount_force(self) -> Quantity[np.complex128]:
        """Force of each mount on what carries it, N: (…, n_orders, n_mounts, 3).

        The name of a mount is a key: ``mount_force["front"]``.
        """
        return self._quantity("mount_force")

    @property
    def ground_force(self) -> Quantity[np.complex128]:
        """Sum of the forces of a subframe's mounts on what carries them, N: (…, n_orders, 3)."""
        return self._quantity("ground_force")

    @property
    def wrench(self) -> Quantity[np.complex128]:
        """Load of the engine on the body, force, N, and moment, N·m: (…, n_orders, n_loads).

        Moments are about the CG, or the point of :meth:`MountResponse.about`.
        """
        return self._quantity("wrench")

    @property
    def motion(self) -> Quantity[np.complex128]:
        """Displacement of the CG, m, and rotation, rad: (…, n_orders, n_loads)."""
        return self._quantity("motion")

    @property
    def subframe_motion(self) -> Quantity[np.complex128]:
        """Displacement of a subframe's CG, m, and rotation, rad: (…, n_orders, n_loads)."""
        return self._quantity("subframe_motion")

    @property
    def support_wrench(self) -> Quantity[np.complex128]:
        """Sum of the mounts' forces on what carries them, N, and moments, N·m.

        Moments are about the CG, or the point of :meth:`MountResponse.about`. Of shape
        (…, n_orders, n_loads).
        """
        return self._quantity("support_wrench")

    @property
    def transmissibility(self) -> Quantity[np.float64]:
        """Load on what carries the mounts over that of the engine, of each component.

        Magnitude of ``support_wrench`` over that of ``wrench``, NaN where the engine has no load in
        that direction beside rounding: there mounts make some of loads in others.
        Of shape (…, n_orders, n_loads).
        """
        return self._quantity("transmissibility")

    @property
    def transmissibility_db(self) -> Quantity[np.float64]:
        """``transmissibility`` in decibels, 20 lg; below zero mounts isolate.

        Of shape (…, n_orders, n_loads).
        """
        return self._quantity("transmissibility_db")

    @property
    def base_motion(self) -> Quantity[np.complex128]:
        """Displacement of a base that moves at the CG, m, and rotation, rad.

        Of shape (…, n_orders, n_loads); an AttributeError where the base does not move.
        """
        return self._quantity("base_motion")

    @property
    def base_transmissibility(self) -> Quantity[np.float64]:
        """Magnitude of ``motion`` over that of ``base_motion``, of each component.

        NaN where the base does not move in that direction. Of shape (…, n_orders, n_loads); an
        AttributeError where the base does not move.
        """
        return self._quantity("base_transmissibility")

    @property
    def power_in(self) -> Quantity[np.float64]:
        """Mean power that the engine puts into the motion, W: (…, n_orders)."""
        return self._quantity("power_in")

    @property
    def power_lost(self) -> Quantity[np.float64]:
        """Mean power that each mount dissipates, W: (…, n_orders, n_mounts)."""
        return self._quantity("power_lost")

    @property
    def power_passed(self) -> Quantity[np.float64]:
        """Mean power that the mounts pass to what carries them, W: (…, n_orders).

        Zero where that does not move.
        """
        return self._quantity("power_passed")

    def _of(self) -> tuple[MountResponse, Key]:
        """Return the response, and the order."""
        raise NotImplementedError

    def at(
        self, point: ArrayLike | str, on: Literal["powertrain", "support"] = "powertrain"
    ) -> PointMotion:
        """Return the motion of a point.

        Parameters
        ----------
        point : sequence of float or str
            Place (x, y, z), m, or the name of a receiver of the receptance that carries the mounts,
            such as ``"seat rail"``.
        on : {"powertrain", "support"}, default "powertrain"
            What a place moves with: the powertrain, or the subframe that carries its mounts.

        Returns
        -------
        PointMotion
            Displacement, velocity, acceleration and severity grade.

        Raises
        ------
        InputError
            If it is no point, no receiver has the name, or there is no subframe.
        """
        result, order = self._of()
        inputs.one_of("on", on, ("powertrain", SUPPORT))
        powertrain = result.powertrain
        if isinstance(point, str):
            names = tuple(dict(getattr(powertrain.support, "receivers", None) or ()))
            if not names:
                hint = "no receptance with receivers carries the mounts: give a place, m"
                raise inputs.rejected("point", point, hint)
            return PointMotion(result, inputs.one_of("point", point, names), SUPPORT, order)
        if on == SUPPORT:
            _require_subframe(powertrain, "on")
        place = _vector("point", point)
        checks.point("point", place)
        return PointMotion(result, place, on, order)


class OrderResponse(MountQuantities, Tabled):
    """One order of a response, or all orders together.

    Made by a response's ``[order]``.
    """

    result: MountResponse
    """The response."""
    order: Order | Literal["all"]
    """Multiple of crank speed, or ``"all"``."""

    def _of(self) -> tuple[MountResponse, Key]:
        return self.result, self.order

    def _quantity(self, name: str) -> Quantity[Any, Any, Any]:
        return Quantity(self.result, name, self.order)

    @property
    def _brief(self) -> str:
        return f"<OrderResponse{self.body_force._which}: {self.body_force!r}>"

    @property
    def table(self) -> Table:
        """Peaks of the force on the body, and of each mount, at each speed."""
        body = self.body_force.table
        mounts = [
            Column(name, np.atleast_1d(self.mount_force[name].peak), "N")
            for name in self.result.powertrain.names
        ]
        title = self.result._title(
            f"peaks of the force on the body, and of each mount,{self.body_force._which}"
        )
        return changed(body, title=title, columns=(*body.columns[:-1], *mounts))

    def _beginning(self, rows: int) -> Table | None:
        return self.result._first_rows(rows, lambda head: changed(self, result=head).table)


class WorstForce(Item):
    """Largest force of one order on what carries the mounts, and the mode nearest to it."""

    force: float
    """Length of the longest vector, N."""
    mount: str
    """Name of the mount; empty for the sum of all."""
    rpm: float
    """Crank speed."""
    order: Order
    """Multiple of crank speed."""
    frequency: float
    """Frequency of the order, Hz."""
    mode: int | None
    """Number of the mode of the nearest frequency, from 1; None on a receptance, without modes."""
    mode_frequency: float | None
    """Its frequency, Hz; None on a receptance."""

    @property
    def table(self) -> Table:
        """Figures and their units."""
        figures = self._figures()
        units = {"force": "N", "rpm": "rpm", "frequency": "Hz", "mode_frequency": "Hz"}
        rows = [(name, value, units.get(name, "")) for name, value in figures.items()]
        return Table.from_rows(
            "Largest force of one order", ["figure", "value", "unit"], rows,
            row_units=[unit for _, _, unit in rows],
        )  # fmt: skip


class MountResponse(MountQuantities, Keyed, Labelled):
    """Response of a powertrain on its mounts: forces on what carries it, motion, power.

    An order is a key: ``response[2].body_force``, ``response.body_force[2]``;
    ``response.body_force.total`` is all orders together. Arrays are over ``rpm``, if several speeds
    were given, then orders, then axes. Phasors are peaks at e^{inθ}. Made by
    :meth:`Powertrain.response`.
    """

    powertrain: Powertrain
    """The powertrain."""
    rpm: NDArray[np.float64] | float
    """Crank speeds: an array where several were given, else a number."""
    _request: Request
    """Orders and tolerance, checked."""

    def __post_init__(self) -> None:
        request = check_request(self._request, "Powertrain.response")
        speeds = np.atleast_1d(np.asarray(self.rpm, dtype=float))
        core = self.powertrain._core.response(
            self.powertrain._engine_core, speeds, request.orders, request.rtol, *self._drive()
        )
        self.__dict__.update(_response=core, _own_orders=tuple(core.orders))
        super().__post_init__()

    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = MOUNTED

    def _of(self) -> tuple[MountResponse, Key]:
        return self, None

    @property
    def _core(self) -> _core.Response:
        return self.__dict__["_response"]  # type: ignore[no-any-return]

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed, of a fired engine halves too."""
        return self.__dict__["_own_orders"]  # type: ignore[no-any-return]

    @property
    def omitted(self) -> tuple[Order, ...]:
        """With ``orders="auto"``: orders of the engine left out that are not zero."""
        return tuple(self._core.omitted)

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → bound of what omitted orders add to the engine's load at the highest speed.

        ``"force"``, N, ``"moment"`` and ``"torque"`` about the CG, or the point of :meth:`about`,
        N·m.
        """
        names = ("force", "moment", "torque")
        vehicle, cg = self.powertrain.vehicle, self.powertrain.body.cg
        x, y, z = np.subtract(cg, self._point or cg).tolist()
        if vehicle is not None:
            x, y, z = vehicle._vectors((x, y, z), inverse=True).tolist()
        bounds = _core.bounds_about(self._core.error_bound, (x, y, z))
        return MappingProxyType(dict(zip(names, bounds, strict=True)))

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"mount": self.powertrain.names}

    @property
    def _names(self) -> tuple[str, ...]:
        has_subframe = isinstance(self.powertrain.support, Subframe)
        absent = (*(() if has_subframe else OF_SUBFRAME), *(() if self._base_moves else OF_BASE))
        return tuple(name for name in MOUNTED if name not in absent)

    def _check(self, quantity: str) -> None:
        if quantity in OF_SUBFRAME:
            _require_subframe(self.powertrain, quantity)
        if quantity in OF_BASE and not self._base_moves:
            hint = "the base does not move; give its motion, `base`"
            raise inputs.faulty(quantity, "is undefined", Hint.of(hint), AbsentError)
        super()._check(quantity)

    def _dims(self, quantity: str, what: str = VALUES) -> tuple[str, ...]:
        kind = self._kind(quantity)
        axis = ("axis",) if kind.axes else ()
        return export.reduced((*self.dims, "order", *kind.dims, *axis), what)

    def _words_of(self, quantity: Quantity) -> str:
        mount = dict(quantity.selected).get("mount")
        if mount is None:
            return quantity.kind.words
        return f"force of mount {self.powertrain.names[mount]!r}"

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.powertrain.loads_counted

    def _by_speed(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return values over speeds, or those of the one speed."""
        return values if self.dims else values[0]

    def _values(self, quantity: str) -> NDArray[Any]:
        if quantity == "body_force":
            return self.read("support_wrench")[..., :3]
        if quantity in ("transmissibility", "transmissibility_db"):
            return self._ratio(quantity)
        if quantity == "base_transmissibility":
            return ratio_of(self.read("motion"), self.read("base_motion"))
        if quantity.startswith("power"):
            power = self._once("power", lambda: self._by_speed(self._core.power()))
            places: dict[str, Any] = {
                "power_in": 0,
                "power_passed": 1,
                "power_lost": slice(2, None),
            }
            return power[..., places[quantity]]  # type: ignore[no-any-return]
        core = self._core
        compute: dict[str, Callable[[], NDArray[Any]]] = {
            "mount_force": core.mount_forces,
            "ground_force": lambda: core.ground_forces().sum(axis=-2),
            "wrench": lambda: core.loads(self._core_place(self._point)),
            "support_wrench": lambda: core.support_loads(self._core_place(self._point)),
            "motion": core.motions,
            "subframe_motion": core.subframe_motions,
            "base_motion": core.base_motions,
        }
        return self._by_speed(compute[quantity]())

    @property
    def _vehicle(self) -> VehicleAxes | None:
        return self.powertrain.vehicle

    def _turned(self, quantity: str, values: NDArray[Any]) -> NDArray[Any]:
        # A part of the load on the body, which is turned.
        return values if quantity == "body_force" else super()._turned(quantity, values)

    def _core_place(self, point: Any) -> Any:  # noqa: ANN401 - a place, a name or None
        """Return a place in the engine's axes; a name of a receiver, or None, as it is."""
        if self._vehicle is None or point is None or isinstance(point, str):
            return point
        return self._vehicle.to_engine(point)

    def _ratio(self, quantity: str) -> NDArray[np.float64]:
        """Return the transmissibility, as a ratio or in decibels."""
        if quantity == "transmissibility_db":
            with np.errstate(divide="ignore"):  # nothing passes
                return np.asarray(20.0 * np.log10(self.read("transmissibility")))
        return ratio_of(self.read("support_wrench"), self.read("wrench"))

    def _base_at(self, point: tuple[float, float, float]) -> NDArray[np.complex128]:
        """Return the displacement of a base that moves at a point."""
        self._check("base_motion")
        return self._by_speed(self._core.base_at(point, "displacement"))

    def _vectors(self, source: Source) -> NDArray[np.complex128]:
        """Return peak phasors of a vector: (…, n_orders, 3)."""
        kind, *rest = source
        if kind == "at":
            point, on, name = rest
            place = self._core_place(point)
            return self._once(  # type: ignore[no-any-return]
                source, lambda: read_only(self._by_speed(self._core.at(place, name, on == SUPPORT)))
            )
        if kind == "mount":
            return self.read("mount_force")[..., rest[0], :]
        return self.read("body_force")

    def _at_order(self, order: Order) -> MountResponse:
        """Return this response if it has an order, else the same of that order alone."""
        if order in self.orders:
            return self
        request = self._request.at_orders((order,))
        one: MountResponse = self._once(
            ("order", order), lambda: changed(self, _request=request, **self._of_order())
        )
        return one

    def __getitem__(self, order: Order | Literal["all"]) -> OrderResponse:
        """Return one order, or with ``"all"`` all of ``orders`` together."""
        return OrderResponse(self, order_key(order))

    @property
    def total(self) -> OrderResponse:
        """All of ``orders`` together."""
        return self[ALL]

    def about(self, point: ArrayLike | None = None, *, z: float | None = None) -> Self:
        """Return the same response with moments of loads about another point than the CG.

        Parameters
        ----------
        point : float or array_like, shape (3,), optional
            Position z along the crank, or (x, y, z) in the engine's axes, m.
        z : float, optional
            Position along the crank, m, by name.

        Returns
        -------
        MountResponse
            The response, whose ``wrench``, ``support_wrench``, ``transmissibility`` and
            ``error_bound`` have moments about the point.

        Raises
        ------
        InputError
            If both are given or none, or one is no position.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> r = cp.Powertrain(cp.Engine.preset("i4"), body, mounts).response(3000)
        >>> pitch = [abs(each[2].wrench[3]).round(1) for each in (r, r.about(z=0.0))]
        >>> pitch == [0.0, 347.6]
        True
        """
        inputs.only_one_of(point=point, z=z)
        name = "z" if point is None else "point"
        if point is None:
            self.powertrain._require_engine_axes("z")
        request = self._request.about(name, z if point is None else point)
        if (core := self.powertrain._engine_core) is not None:
            x, y, along = self._core_place((*request.aside, request.reference_z))
            checks.place(core, name, along)
            checks.place(core, name, x, y, middle=0.0)
        return changed(self, _request=request)

    @property
    def _point(self) -> tuple[float, float, float] | None:
        """Point about which moments are; None for the CG."""
        z = self._request.reference_z
        return None if z is None else (*self._request.aside, z)

    def sel(  # type: ignore[override] # of its one dimension
        self, *, rpm: float | None = None, frequency: float | None = None
    ) -> Self:
        """Return the response at one of the speeds, or of the frequencies.

        Parameters
        ----------
        rpm : float, optional
            One of the speeds given.
        frequency : float, optional
            In its place, one of the frequencies of a base that moves by frequency, Hz.

        Returns
        -------
        MountResponse
            The response at that alone.

        Raises
        ------
        InputError
            If it is not among them, or both are given or none.
        """
        inputs.only_one_of(rpm=rpm, frequency=frequency)
        name, value = ("rpm", rpm) if frequency is None else ("frequency", frequency)
        inputs.one_of("dimension", name, ("frequency",) if self._stands else ("rpm",))
        index = export.place_of(name, value, np.atleast_1d(self._speeds().data))
        speed = float(np.atleast_1d(self.rpm)[index])
        return changed(self, rpm=speed, **(self._of_speed(index) if self.dims else {}))

    def _of_speed(self, index: int | slice) -> dict[str, Any]:
        """Return what else changes where one of the speeds is taken, or some."""
        return {}

    def _of_order(self) -> dict[str, Any]:
        """Return what else changes where another order is taken."""
        return {}

    def _drive(self) -> tuple[Any, ...]:
        """Return actuators, their forces, and whether the engine runs, as the core takes them."""
        return ()

    def cancel(
        self,
        actuators: Actuator | Sequence[Actuator],
        receivers: Any,  # noqa: ANN401 - points, pairs, a mapping or a word
        *,
        orders: Orders | None = None,
        watch: Any = None,  # noqa: ANN401 - as above
        effort: float = 0.0,
        norm: Literal["rms", "largest"] = "rms",
    ) -> Cancellation:
        """Return the forces of actuators that leave the least at receivers, order by order.

        Parameters
        ----------
        actuators : Actuator or sequence of Actuator
            What pushes, of distinct names.
        receivers : sequence, mapping or {"body_force", "mount_force"}
            What is minimised: the velocity of points (x, y, z) of the powertrain, of receivers of a
            receptance by name, such as ``"seat rail"``, or of motions of :meth:`at`, which may be
            of a subframe; or of pairs of one of these and a direction, along that; in a list or by
            name in a mapping. Or the mounts' sum, or their forces.
        orders : number or sequence of numbers, optional
            Orders to cancel, of those of the response; by default all.
        watch : sequence or mapping, optional
            Further points, which are reported.
        effort : float, default 0.0
            Weight of the squares of forces, over the largest of what they do at the receivers:
            1e-4 gives up a little for smaller forces.
        norm : {"rms", "largest"}, default "rms"
            What is minimised of several receivers: the sum of squares, or the largest of them.

        Returns
        -------
        Cancellation
            Forces, what is left, what is raised elsewhere, and the limits used.

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> mounts = [
        ...     cp.Mount(f"{x:+g} {z:+g}", at=(x, -0.12, z + 0.15), stiffness=2e5, loss_factor=0.1)
        ...     for x in (0.22, -0.22) for z in (0.28, -0.28)
        ... ]
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> shaker = cp.Actuator("shaker", at=(0.22, -0.12, 0.43), direction=(0, 1, 0), force=200)
        >>> foot = {"foot": ((0.22, -0.12, 0.43), (0, 1, 0))}
        >>> c = p.response(3000).cancel(shaker, foot, orders=2)
        >>> bool(c.response[2].body_force.peak < c.before[2].body_force.peak)
        True
        """
        # By way of the powertrain: what it returns is made of responses.
        return self.powertrain._cancelled(
            self, actuators, receivers, orders=orders, watch=watch, effort=effort, norm=norm
        )

    def worst(self, quantity: Literal["mount_force", "body_force"] = "mount_force") -> WorstForce:
        """Return the largest force of one order: where, at which speed, near to which mode.

        Parameters
        ----------
        quantity : {"mount_force", "body_force"}, default "mount_force"
            The force of one mount, or the sum of all.

        Returns
        -------
        WorstForce
            Force, mount, speed, order, and the mode of the nearest frequency.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        inputs.one_of("quantity", quantity, ("mount_force", "body_force"))
        names = self.powertrain.names if quantity == "mount_force" else ("",)
        speeds = np.atleast_1d(self.rpm)
        shape = (len(speeds), len(self.orders), len(names))
        peaks = np.moveaxis(np.reshape(self.read(quantity, "peak"), shape), -1, 0)
        mount, speed, place = np.unravel_index(int(peaks.argmax()), peaks.shape)
        order = self.orders[place]
        frequency = float(order) * float(speeds[speed]) / 60.0
        force = float(peaks[mount, speed, place])
        worst = (force, names[mount], float(speeds[speed]), order, frequency)
        if isinstance(self.powertrain.support, Receptance):
            return WorstForce(*worst, None, None)
        varies = self.powertrain._varies
        modes = self.powertrain.modes(frequency if varies else None).frequency
        mode = int(np.abs(modes - frequency).argmin())
        return WorstForce(*worst, mode + 1, float(modes[mode]))

    # --- tables -----------------------------------------------------------------------------------

    def _shown(self) -> tuple[list[int], str]:
        """Return the places of the orders that tables at one speed show, and a line on the others.

        Of orders chosen automatically, those whose forces are all negligible are left out.
        """
        places = list(range(len(self.orders)))
        if self._request.orders is not None:
            return places, ""
        peaks = self.read("mount_force", "peak").max(axis=-1)
        is_large = peaks > labels.NEGLIGIBLE * peaks.max()
        if not is_large.any():
            return places, ""
        left_out = [
            order for order, is_visible in zip(self.orders, is_large, strict=True) if not is_visible
        ]
        return np.flatnonzero(is_large).tolist(), labels.not_shown(left_out)

    _driven = ""
    """What its titles say of actuators."""

    _base_moves = False
    """True of a response on a base that moves."""
    _stands = False
    """True where nothing but the base moves, by frequency."""

    def _at(self) -> str:
        """Return the speed, in words, of one speed."""
        return labels.at_speed(float(self.rpm))

    def _speeds(self) -> Column:
        """Return the speeds as a column."""
        return Column("rpm", np.asarray(self.rpm), digits=10)

    def _title(self, of: str) -> str:
        at = "" if self.dims else f" {self._at()}"
        given = self._request.orders is not None and not self._stands
        which = " of the orders given" if given else ""
        return units.Text(f"{self.powertrain._title_with(self._driven)}{at}: ", of, which)

    def _first_rows(self, rows: int, read: Callable[[Self], Table]) -> Table | None:
        """Return the table of the first speeds of many, which says how many there are."""
        if not self.dims or len(speeds := np.asarray(self.rpm)) <= rows:
            return None
        head = changed(self, rpm=speeds[:rows], **self._of_speed(slice(rows)))
        return changed(read(head), whole=len(speeds))

    def _beginning(self, rows: int) -> Table | None:
        return self._first_rows(rows, lambda head: head.table)

    @property
    def table(self) -> Table:
        """Peaks of the force on the body, and of each mount.

        By order at one speed, else of all orders together at each speed.
        """
        force, note = self.body_force, ""
        if self.dims:
            columns = [self._speeds()]
            force = force.total
        else:
            places, note = self._shown()
            orders = [self.orders[k] for k in places]
            frequency = [float(order) * float(self.rpm) / 60.0 for order in orders]
            columns = [Column("order", (*orders, ALL)), Column("f", (*frequency, None), "Hz")]

        def peaks(vector: Quantity, what: str) -> NDArray[np.float64]:
            values = np.asarray(getattr(vector, what))
            if self.dims:
                return values
            return np.concatenate([values[places], np.asarray(getattr(vector.total, what))[None]])

        for axis, values in zip("xyz", peaks(force, "peak_xyz").T, strict=True):
            columns.append(Column(f"|F_{axis}|", values, "N"))
        columns.append(Column("|F|", peaks(force, "peak"), "N"))
        for name in self.powertrain.names:
            of_mount = self.mount_force[name].total if self.dims else self.mount_force[name]
            columns.append(Column(name, peaks(of_mount, "peak"), "N"))
        title = self._title("peaks of the force on the body, and of each mount")
        return Table(title, tuple(columns), note, loads=self.loads_counted)

    @property
    def frames(self) -> Frames:
        """``table``; at one speed ``loads``: those of the engine, on the body, and their ratio.

        And ``power``: what the engine puts in, and what each mount dissipates.
        """
        if self.dims:
            return self._frames()
        return self._frames(loads=self._of_loads, power=self._of_power)

    def _of_loads(self) -> Table:
        places, note = self._shown()
        columns = [Column("order", tuple(self.orders[k] for k in places))]
        readings = (
            self.wrench,
            self.support_wrench,
            self.transmissibility,
            self.transmissibility_db,
        )
        pairs = zip(*(np.asarray(values)[places].T for values in readings), strict=True)
        for name, (load, support, ratio, decibels) in zip(COMPONENTS_OF_LOADS, pairs, strict=True):
            unit = "N" if name.startswith("F") else "N·m"
            if not np.any(load) and not np.any(support):
                continue
            if np.any(load) or not self._base_moves:
                columns.append(Column(f"|{name}| of the engine", np.abs(load), unit))
            columns.append(Column(f"|{name}| on the body", np.abs(support), unit))
            for values, in_unit in ((ratio, ""), (decibels, "dB")):
                if np.isnan(values).all():
                    continue
                cells = (None if np.isnan(value) else value for value in values.tolist())
                columns.append(Column(f"T {name}", tuple(cells), in_unit))
        point = self._point and units.Figure(self._point, "m", "", "({}, {}, {})")
        at = units.Text(point or "the CG")
        title = self._title(units.Text("loads about ", at))
        return Table(title, tuple(columns), note, loads=self.loads_counted)

    def _of_power(self) -> Table:
        places, note = self._shown()

        def listed(power: ArrayLike) -> tuple[float, ...]:
            values = np.asarray(power)
            return (*values[places].tolist(), float(values.sum()))

        columns = [Column("order", (*(self.orders[k] for k in places), ALL))]
        columns.append(Column("put in", listed(self.power_in), "W"))
        for name, lost in zip(self.powertrain.names, self.power_lost.T, strict=True):
            columns.append(Column(name, listed(lost), "W"))
        if self.powertrain.support is not None or self._base_moves:
            columns.append(Column("passed on", listed(self.power_passed), "W"))
        title = self._title("mean power that the engine puts in, and that each mount dissipates")
        return Table(title, tuple(columns), note, loads=self.loads_counted)

    def _table_of(self, quantity: Quantity) -> Table:
        """Return peaks along x, y and z, length of the longest vector, and the rms of the length.

        By order at one speed, else at each speed of the order, or of all orders together.
        """
        free = [name for name in quantity.dims if name not in (*self.dims, "order", "axis")]
        if not quantity.kind.axes or free or "axis" in dict(quantity.selected):
            return super()._table_of(quantity)
        swept, order, note = {*self.dims} <= {*quantity.dims}, quantity.order, ""
        swept = swept and bool(self.dims)
        vector = changed(quantity, order=ALL if order is None and swept else order)
        if swept:
            columns = [self._speeds()]
        elif order is not None:
            columns = [Column("order", (order,))]
        else:
            places, note = self._shown()
            columns = [Column("order", (*(self.orders[k] for k in places), ALL))]
        figures = np.column_stack(
            [np.atleast_2d(vector.peak_xyz), np.atleast_1d(vector.peak), np.atleast_1d(vector.rms)]
        )
        if order is None and not swept:
            whole = vector.total
            figures = np.vstack([figures[places], [*whole.peak_xyz, whole.peak, whole.rms]])
        heads = ("peak along x", "along y", "along z", "longest", "rms")
        for head, values in zip(heads, figures.T, strict=True):
            columns.append(Column(head, values, quantity.unit))
        which = vector._which
        title = self._title(f"{quantity.words}{which and f',{which}'}")
        return Table(title, tuple(columns), note, loads=self.loads_counted)


class BaseResponse(MountResponse):
    """Response of a powertrain on a base that moves: read as one on a base that does not.

    Where the base moves by frequency the engine stands, arrays are over ``frequency``, if there are
    several, and the frequency itself is order 1; ``rpm`` is 60 times the frequency. ``wrench`` is
    the load of the engine alone. Made by :meth:`Powertrain.response`.
    """

    powertrain: Powertrain
    """The powertrain."""
    rpm: NDArray[np.float64] | float
    """Crank speeds: an array where several were given, else a number."""
    _request: Request
    """Orders and tolerance, checked."""
    base: BaseMotion
    """Motion of the base."""

    _base_moves = True
    _driven = ", on a base that moves"

    @property
    def _stands(self) -> bool:  # type: ignore[override] # of each
        """True if the base moves by frequency, and the engine stands."""
        return self.base.by == "frequency"

    def _drive(self) -> tuple[Any, ...]:
        return None, self.base._figures()

    def _of_speed(self, index: int | slice) -> dict[str, Any]:
        return {"base": self.base._picked(index)} if self._stands else {}

    @property
    def frequency(self) -> NDArray[np.float64] | float:
        """Frequencies of the base, Hz: (n_frequencies,), or a number where there is one."""
        if not self._stands:
            hint = "the base moves by order of crank speed"
            raise inputs.faulty("frequency", "is undefined", hint, AbsentError)
        numbers = self.base._numbers
        return read_only(numbers) if len(numbers) > 1 else float(numbers[0])

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the speeds, or the frequencies, where there are several."""
        if not self._stands:
            return super().coords
        return {"frequency": self.frequency} if isinstance(self.rpm, np.ndarray) else {}

    @property
    def _attributes(self) -> Mapping[str, Any]:
        if not self._stands:
            return super()._attributes
        return {} if self.dims else {"frequency": self.frequency}

    @property
    def loads_counted(self) -> str:
        """Loads that count beside the base, in words: as :attr:`Engine.loads_counted`."""
        return "" if self._stands else super().loads_counted

    @property
    def _of_engines(self) -> tuple[Engine, ...]:
        return () if self._stands else super()._of_engines

    def _sense_of_phases(self) -> str:
        if self._stands:
            return "A motion is amplitude·cos(ω·t + phase_deg), with the phases of the base."
        return super()._sense_of_phases()

    def _at(self) -> str:
        return f"at {self.frequency:g} Hz" if self._stands else super()._at()

    def _speeds(self) -> Column:
        if self._stands:
            return Column("f", np.asarray(self.frequency), "Hz", digits=10)
        return super()._speeds()

    def cancel(self, *arguments: Any, **options: Any) -> Cancellation:  # noqa: ANN401
        """Raise an error: actuators act on a base that does not move.

        Parameters
        ----------
        *arguments : tuple, optional
            Those of :meth:`MountResponse.cancel`.
        **options : dict, optional
            Its options.

        Returns
        -------
        Cancellation
            Nothing: it raises.

        Raises
        ------
        InputError
            Always.
        """
        hint = "actuators act against the engine's orders, on a base that does not move"
        raise inputs.faulty("cancel", "is undefined", hint)

    def _at_order(self, order: Order) -> MountResponse:
        if self._stands and order not in self.orders:
            raise inputs.rejected("order", order, "the base moves by frequency, which is order 1")
        return super()._at_order(order)

    @property
    def table(self) -> Table:
        """Peaks of the force on the body, and of each mount, and transmissibility from the base.

        By order at one speed, else at each frequency, or of all orders together at each speed.
        """
        table = super().table
        if self.dims and not self._stands:
            return table
        ratio = np.asarray(self.base_transmissibility)
        if self.dims:
            rows = ratio[:, 0]
        else:
            rows = np.concatenate([ratio[self._shown()[0]], np.full((1, ratio.shape[-1]), np.nan)])
        columns = [*table.columns]
        for name, values in zip(MOTION_COMPONENTS, rows.T, strict=True):
            if not np.isnan(values).all():
                cells = (None if np.isnan(value) else value for value in values.tolist())
                columns.append(Column(f"T {name}", tuple(cells)))
        note = units.joined(" ", [table.note, "T: motion of the CG over that of the base there."])
        return changed(table, columns=tuple(columns), note=note)
