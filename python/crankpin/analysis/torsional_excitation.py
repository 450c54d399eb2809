"""Torque of each cylinder on the crank per order: input of programs for torsional vibration."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.messages import suppressed
from crankpin._support.quantities import EXCITATIONS, PART_WORDS
from crankpin._support.record import changed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.contributions import of_cylinders
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core
from crankpin.model.computed_cycles import area

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine

HIGHEST = 12
"""Highest order by default, as in the tables of classification societies."""
GAS_AND_INERTIA = tuple(PART_WORDS)
"""Parts of a torque of a cylinder."""


class TorsionalExcitation(Labelled):
    """Torque of each cylinder's gas and masses on the crank, per order, at a speed or several.

    Made by :func:`crankpin.torsional_excitation`.
    """

    engine: Engine
    """The engine."""
    rpm: float | NDArray[np.float64]
    """Crank speed, or speeds: (n_rpm,)."""
    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = EXCITATIONS

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"cylinder": np.arange(1, len(self.engine) + 1)}

    @property
    def _names(self) -> tuple[str, ...]:
        name, *others = EXCITATIONS
        return (name, *self._parts(name), *others)

    def _parts(self, quantity: str) -> tuple[str, ...]:
        return tuple(f"{quantity}.{part}" for part in self._named_parts(quantity))

    def _named_parts(self, quantity: str) -> tuple[str, ...]:
        return GAS_AND_INERTIA if quantity == "crank_torque" else ()

    def _at_order(self, order: Order) -> TorsionalExcitation:
        one: TorsionalExcitation = self._once(order, lambda: changed(self, orders=(order,)))
        return one

    @functools.cached_property
    def _phasors(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Phasors of gas: (n_cylinders, n_orders), and of masses: (…, n_cylinders, n_orders)."""
        speeds, fastest = np.ravel(self.rpm), inputs.fastest(self.rpm)
        with suppressed():  # Warned of where the excitation was made.
            balance = self.engine.balance(fastest, orders=self.orders)
        gas, inertia = (of_cylinders(balance, f"crank_torque.{of}")[0] for of in GAS_AND_INERTIA)
        # Torque of masses has the square of the speed as a factor.
        scales = (speeds / fastest) ** 2 if fastest else np.ones(len(speeds))
        return gas, np.multiply.outer(scales, inertia) if self.coords else inertia

    def _values(self, quantity: str) -> NDArray[Any]:
        gas, inertia = self._phasors
        if quantity == "crank_torque.gas":
            return np.array(np.broadcast_to(gas, inertia.shape))
        if quantity == "mean_torque":
            return np.array(engine_core(self.engine).mean_gas_torques())
        if quantity == "reciprocating_inertia":
            return _core.mean_inertias(engine_core(self.engine))
        if quantity == "tangential_pressure":
            return self._pressures()
        return inertia if quantity == "crank_torque.inertia" else gas + inertia

    @property
    def crank_torque(self) -> Quantity[np.complex128]:
        """Torque of each cylinder on the crank, N·m: (…, n_cylinders, n_orders).

        Peak phasors of ``Re(P exp(ikθ))``, θ the engine's crank angle; positive torque drives the
        crank. ``crank_torque.gas`` is that of gas pressure, the same at any speed,
        ``crank_torque.inertia`` that of masses, with the square of the speed.
        """
        return self._quantity("crank_torque")

    @property
    def mean_torque(self) -> Quantity[np.float64]:
        """Mean torque of each cylinder, N·m: (n_cylinders,)."""
        return self._quantity("mean_torque")

    @functools.cached_property
    def angular_frequency(self) -> NDArray[np.float64]:
        """Angular frequencies of the orders, rad/s: (n_orders,), of speeds (n_rpm, n_orders).

        As ``orders`` and ``rpm`` an array without labels: programs loop over frequencies.
        """
        omega = np.array([inputs.angular_speed(rpm) for rpm in np.ravel(self.rpm)])
        outer = np.multiply.outer(omega, np.array(self.orders, dtype=np.float64))
        return read_only(outer if self.coords else outer[0])

    @property
    def reciprocating_inertia(self) -> Quantity[np.float64]:
        """Mean moment of inertia of each cylinder's piston and rod, kg·m²: (n_cylinders,).

        Its kinetic energy is, on average over a turn, that of a disk of this inertia on the main
        crank: near ½·m·r² of the reciprocating mass, on a crank of another speed times the square
        of its ratio. The rotating mass of the rod comes on top.
        """
        return self._quantity("reciprocating_inertia")

    @property
    def tangential_pressure(self) -> Quantity[np.complex128]:
        """Torque of gas over piston area and crank radius, Pa: (n_cylinders, n_orders).

        Phasors about each cylinder's own firing top dead centre, as class rules tabulate harmonics
        of the tangential pressure: ``a cos kθ + b sin kθ`` with a the real part and b minus the
        imaginary one. Zero for cylinders without gas pressure.
        """
        return self._quantity("tangential_pressure")

    def _pressures(self) -> NDArray[np.complex128]:
        scale = [
            1.0 / (area(cylinder) * cylinder.crank_radius) if fired else 0.0
            for cylinder, fired in zip(self.engine.cylinders, self._fired, strict=True)
        ]
        angles = np.radians(self.engine.firing_deg) if any(self._fired) else np.zeros(len(scale))
        turned = np.exp(1j * np.multiply.outer(angles, np.array(self.orders, dtype=np.float64)))
        return np.asarray(self._phasors[0] * turned * np.array(scale)[:, np.newaxis])

    @property
    def _fired(self) -> list[bool]:
        cycles = self.engine.cycles
        return [cycle is not None for cycle in cycles or [None] * len(self.engine)]

    @property
    def table(self) -> Table:
        """Amplitude and phase by speed, cylinder and order."""
        at = np.ravel(self.rpm).tolist()
        several = f"{min(at):.10g} to {max(at):.10g}" if np.ndim(self.rpm) else f"{at[0]:.10g}"
        title = f"TorsionalExcitation of {labels.name_of(self.engine)}: torque on the crank, "
        torque = np.asarray(self.crank_torque)
        columns = [Column("frequency", self._of_rows(self.angular_frequency), "rad/s")]
        columns += [
            Column("amplitude", np.abs(torque), "N·m"),
            Column("phase", np.angle(torque), "rad"),
        ]
        return self._by_row(f"{title}{several} rpm", columns)

    def parts(self) -> Table:
        """Return amplitudes and phases of gas and masses by speed, cylinder and order.

        Returns
        -------
        Table
            A row for each speed, cylinder and order, as ``table``.
        """
        parts = (self.crank_torque.gas, self.crank_torque.inertia)
        columns = [
            Column(f"{name} {what}".strip(), of(np.asarray(part)), unit)
            for name, part in zip(("gas", "inertia"), parts, strict=True)
            for what, of, unit in (("", np.abs, "N·m"), ("phase", np.angle, "rad"))
        ]
        return self._by_row("Torque of gas and of masses on the crank", columns)

    def _of_rows(self, by_order: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return values by speed and order for each cylinder."""
        rows = by_order.reshape(-1, 1, len(self.orders))
        return np.broadcast_to(rows, (len(rows), len(self.engine), len(self.orders)))

    def _by_row(self, title: str, columns: list[Column]) -> Table:
        """Return a table of columns by speed, cylinder and order."""
        speeds, cylinders = np.atleast_1d(self.rpm), range(1, len(self.engine) + 1)
        orders = self.orders * (len(speeds) * len(cylinders))
        numbers = np.repeat(cylinders, len(self.orders))
        before = (
            [Column("speed", np.repeat(speeds, len(numbers)), "rpm")] if np.ndim(self.rpm) else []
        )
        before += [Column("cylinder", np.tile(numbers, len(speeds))), Column("order", orders)]
        return Table(title, (*before, *columns), loads=self.loads_counted)

    def tangential(self) -> Table:
        """Return the harmonics of the tangential pressure by cylinder and order.

        Returns
        -------
        Table
            Cosine, sine and amplitude of ``tangential_pressure``, bar.
        """
        rows = [
            (number, order, phasor.real / 1e5, -phasor.imag / 1e5, abs(phasor) / 1e5)
            for number, pressures in enumerate(self.tangential_pressure.tolist(), 1)
            for order, phasor in zip(self.orders, pressures, strict=True)
        ]
        return Table.from_rows(
            "Tangential pressure of gas, from each cylinder's firing top dead centre",
            ["cylinder", "order", ("cosine", "bar"), ("sine", "bar"), ("amplitude", "bar")],
            rows,
            loads=self.loads_counted,
        )

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.engine.loads_counted

    def to_dict(self) -> dict[str, Any]:
        """Return the excitation as plain lists.

        ``rpm``, ``loads`` in words, ``orders``, ``angular_frequency`` in rad/s; by cylinder
        ``mean`` in N·m, ``reciprocating_inertia`` in kg·m² and, with a list over orders in each,
        ``amplitude`` in N·m and ``phase`` in rad, the same of ``gas`` and ``inertia``. Of several
        speeds the lists that depend on speed have one for each. openTorsion's
        ``PeriodicExcitation.add_sines`` takes amplitudes and phases with the node of a cylinder.

        Returns
        -------
        dict
            Lists by name, as above.
        """
        gas, inertia = self._phasors
        parts = {"": gas + inertia, "gas_": gas, "inertia_": inertia}
        return {
            "rpm": self.rpm.tolist() if isinstance(self.rpm, np.ndarray) else self.rpm,
            "loads": self.loads_counted,
            "orders": list(self.orders),
            "angular_frequency": self.angular_frequency.tolist(),
            "mean": self.mean_torque.tolist(),
            "reciprocating_inertia": self.reciprocating_inertia.tolist(),
            **{f"{name}amplitude": np.abs(phasors).tolist() for name, phasors in parts.items()},
            **{f"{name}phase": np.angle(phasors).tolist() for name, phasors in parts.items()},
        }


def torsional_excitation(
    engine: Engine, rpm: ArrayLike, *, orders: Order | Iterable[Order] | None = None
) -> TorsionalExcitation:
    """Return the torque of each cylinder on the crank per order, of gas and masses.

    Parameters
    ----------
    engine : Engine
        The engine, with or without cycles.
    rpm : float or array_like, shape (n_rpm,)
        Crank speed, rpm, or several. The torque of gas is the same at all of them.
    orders : number or sequence of numbers, optional
        Multiples of crank speed; by default up to 12, halves among them for a fired four-stroke.

    Returns
    -------
    TorsionalExcitation
        Phasors about the engine's crank angle, firing order included: their sums over cylinders
        are ``engine.balance(rpm).crank_torque``.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> i4 = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    >>> excitation = cp.torsional_excitation(i4, rpm=3000, orders=[0.5, 2])
    >>> abs(excitation.crank_torque[0.5]).round(1)
    array([99.2, 99.2, 99.2, 99.2])
    >>> over_speed = cp.torsional_excitation(i4, rpm=[1000, 3000, 5000], orders=[2])
    >>> abs(over_speed.crank_torque.sel(cylinder=1)[2]).round(1)  # of cylinder 1
    array([73.1, 32.6, 48.7])
    """
    engine_core(engine)
    chosen = orders_up_to(engine, HIGHEST) if orders is None else orders
    speeds = inputs.speeds(rpm)
    explicit = inputs.explicit_half_orders(chosen)
    balance = engine.balance(inputs.fastest(speeds), orders=explicit)
    return TorsionalExcitation(engine, speeds, balance.orders)


def orders_up_to(engine: Engine, highest: int) -> list[float]:
    """Return all orders up to one, halves among them for a fired four-stroke."""
    step = 1 if engine.cycles is None or engine.strokes == 2 else 0.5
    return [step * k for k in range(1, round(highest / step) + 1)]
