"""Free forces and couples of an engine, horizontal and vertical, as makers print them."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.messages import suppressed
from crankpin._support.quantities import FOUNDATION, PLANE_VECTORS
from crankpin._support.record import changed
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.geometry import direction
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core
from crankpin.analysis.sweeps.sweep import sweep
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Order
    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine

WAYS = ("horizontal", "vertical")
"""Directions, each with the couple of the forces along it."""
COMPENSATED = ("with", "without")
"""States of an engine that has balance shafts: as it is, and without them."""


def foundation_table(
    engine: Engine,
    rpm: ArrayLike,
    *,
    orders: Order | Iterable[Order] = (1, 2),
    vertical_deg: Angle = 90.0,
    reference_z: float | None = None,
) -> FoundationTable:
    """Return the free forces and couples of an engine, horizontal and vertical, order by order.

    As makers of compressors and ships' engines print them: amplitude and phase of each order,
    about one plane, with and without the balance shafts, which they call compensators. They are
    the forces and moments of :meth:`Engine.balance`; gas pressure makes none.

    Parameters
    ----------
    engine : Engine
        The engine, with its counterweights, balance shafts and loads.
    rpm : float or array_like, shape (n_rpm,)
        Crank speed, rpm, or several.
    orders : number or sequence of numbers, default (1, 2)
        Multiples of crank speed; ships' engines have 4 and 6 too.
    vertical_deg : number or str, default 90.0
        Direction of the vertical, upwards, degrees from +x, seen from the flywheel: 0 or 180 for
        an engine with upright bores that lies. The horizontal is a quarter turn before it.
    reference_z : float, optional
        Plane about which couples are taken, m; by default the engine's own.

    Returns
    -------
    FoundationTable
        Phasors and amplitudes, N and N·m.

    Raises
    ------
    InputError
        If an argument is out of range.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, as with lengths in millimetres.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.125, rod_length=0.625, reciprocating_mass=200)
    >>> lighter = cylinder.replace(reciprocating_mass=180)
    >>> compressor = cp.Engine.from_lists(
    ...     [cylinder, lighter], tdc_deg=[0, 0], bank_deg=[0, 180], z=[0, 0.32], name="Two throws"
    ... )
    >>> cp.foundation_table(compressor, rpm=600)
    Two throws at 600 rpm: free forces and couples about z = 0.16 m
    order  direction   force N  force phase °  couple N·m  couple phase °
        1  horizontal   9869.6              0       30004             180
        1  vertical          0              –           0               –
        2  horizontal     1994              0      6061.9             180
        2  vertical          0              –           0               –
    """
    core = engine_core(engine)
    explicit = tuple(inputs.explicit_half_orders(orders))
    vertical = inputs.degrees(inputs.angle("vertical_deg", vertical_deg))
    checks.angles(vertical_deg=vertical_deg)
    plane = engine.reference_z
    if reference_z is not None:
        plane = inputs.finite("reference_z", reference_z)
        checks.place(core, "reference_z", plane)
    speeds = inputs.speeds(rpm)
    inputs.warn_of_units(mean_piston_speed(engine, inputs.fastest(speeds)))
    return FoundationTable(engine, speeds, explicit, vertical, plane)


class FoundationTable(Labelled):
    """Free forces and couples, horizontal and vertical, per order, at a speed or several.

    The dimension ``compensators`` has ``"with"`` and ``"without"`` for an engine with balance
    shafts, ``"without"`` alone for others; a phasor P is ``Re(P exp(inθ))``. Made by
    :func:`crankpin.foundation_table`.
    """

    engine: Engine
    """The engine."""
    rpm: float | NDArray[np.float64]
    """Crank speed, rpm, or speeds: (n_rpm,)."""
    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    vertical_deg: float
    """Direction of the vertical, upwards, degrees from +x."""
    reference_z: float
    """Plane about which couples are taken, m."""
    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = FOUNDATION

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"compensators": self.states}

    @property
    def states(self) -> tuple[str, ...]:
        """States of the engine: ``"with"`` balance shafts, if it has any, and ``"without"``."""
        return COMPENSATED if self.engine.shafts else COMPENSATED[1:]

    @property
    def _attributes(self) -> Mapping[str, Any]:
        return {
            **super()._attributes,
            "reference_z": self.reference_z,
            "vertical_deg": self.vertical_deg,
        }

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words; gas pressure makes no force."""
        return labels.without_gas(self.engine.loads_counted)

    def _at_order(self, order: Order) -> FoundationTable:
        one: FoundationTable = self._once(order, lambda: changed(self, orders=(order,)))
        return one

    @cached_property
    def _vectors(self) -> dict[str, NDArray[np.complex128]]:
        """Phasors by quantity: (n_rpm, n_states, n_orders)."""
        whole = self.engine.replace(reference_z=self.reference_z)
        engines = {name: whole if name == "with" else whole.with_shafts([]) for name in self.states}
        with suppressed():  # Warned of where the table was made.
            swept = sweep(engines, np.ravel(self.rpm), orders=self.orders, torque=False)
        up = complex(direction(self.vertical_deg))
        vectors = {}
        for word, name in zip(("force", "couple"), PLANE_VECTORS, strict=True):
            shape = (len(self.states), -1, len(self.orders))
            x, y = np.moveaxis(np.reshape(swept.read(name), (*shape, 2)), -1, 0)
            if name == "moment":  # Σ z·F along x is that about y, along y minus that about x
                x, y = y, -x
            bound = np.reshape(swept.read(name, "zero_bound"), shape)
            along = {"vertical": up.real * x + up.imag * y, "horizontal": up.imag * x - up.real * y}
            for way, phasors in along.items():
                sound = np.where(np.abs(phasors) > bound, phasors, 0.0)
                vectors[f"{way}_{word}"] = np.swapaxes(sound, 0, 1)
        return vectors

    def _values(self, quantity: str) -> NDArray[Any]:
        values = self._vectors[quantity]
        return values if self.coords else values[0]

    @property
    def horizontal_force(self) -> Quantity[np.complex128]:
        """Horizontal force, positive a quarter turn before the vertical, N: (…, n, n_orders)."""
        return self._quantity("horizontal_force")

    @property
    def vertical_force(self) -> Quantity[np.complex128]:
        """Vertical force, positive upwards, N: (…, n, n_orders)."""
        return self._quantity("vertical_force")

    @property
    def horizontal_couple(self) -> Quantity[np.complex128]:
        """Couple of the horizontal forces, Σ (z − z₀)·F, N·m: (…, n, n_orders)."""
        return self._quantity("horizontal_couple")

    @property
    def vertical_couple(self) -> Quantity[np.complex128]:
        """Couple of the vertical forces, Σ (z − z₀)·F, N·m: (…, n, n_orders).

        Ships' engines' M_1V, M_2V and M_4V; ``horizontal_couple`` is M_1H.
        """
        return self._quantity("vertical_couple")

    @property
    def table(self) -> Table:
        """Amplitudes and phases by speed, order and direction, with and without shafts."""
        speeds = np.atleast_1d(self.rpm)
        rows = len(speeds) * len(self.orders)
        columns = []
        if np.ndim(self.rpm):
            columns.append(Column("speed", np.repeat(speeds, 2 * len(self.orders)), "rpm"))
        columns += [
            Column("order", tuple(np.repeat(self.orders, 2).tolist()) * len(speeds)),
            Column("direction", WAYS * rows),
        ]
        for k, state in enumerate(self.states):
            behind = " without" if state == "without" and k else ""
            for word, unit in (("force", "N"), ("couple", "N·m")):
                ways = np.stack([self._vectors[f"{way}_{word}"][:, k] for way in WAYS], axis=-1)
                phases = tuple(
                    float(np.angle(phasor, deg=True)) if phasor else None
                    for phasor in ways.ravel().tolist()
                )
                columns += [
                    Column(f"{word}{behind}", np.abs(ways), unit),
                    Column(f"{word} phase{behind}", phases, "°", digits=4),
                ]
        at = f"{speeds.min():g} to {speeds.max():g}" if len(speeds) > 1 else f"{speeds[0]:g}"
        title = units.Text(
            f"{labels.name_of(self.engine)} at {at} rpm: free forces and couples about z = ",
            units.figure(self.reference_z, "m", 6),
        )
        notes = []
        if self.vertical_deg != 90.0:
            notes.append(f"The vertical is at {self.vertical_deg:.6g}° from +x.")
        if len(self.states) > 1:
            notes.append("without: without the balance shafts.")
        return Table(title, tuple(columns), " ".join(notes), self.loads_counted)
