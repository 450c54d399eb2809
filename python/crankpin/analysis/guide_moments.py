"""Guide-force moments of H and X type per order: how the walls of the cylinders rock an engine."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._support import inputs, labels, units
from crankpin._support.messages import Hint, suppressed
from crankpin._support.quantities import GUIDES
from crankpin._support.record import AbsentError, changed
from crankpin._support.tables import Column, Table
from crankpin.analysis.contributions import of_cylinders
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core
from crankpin.analysis.torsional_excitation import GAS_AND_INERTIA, HIGHEST, orders_up_to
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine


def guide_moments(
    engine: Engine,
    rpm: ArrayLike,
    *,
    orders: Orders = "auto",
    reference_z: float | None = None,
    length: float | None = None,
) -> GuideMoments:
    """Return the guide-force moments of H and X type per order.

    Piston or crosshead presses on its guide; with the crank's bearings that is a moment about the
    crank axis, the roll torque of one cylinder. Those of all cylinders together are the H-type
    moment, which rocks the engine sideways as a whole; times their distances from the middle they
    are the X-type bimoment, which twists it.

    Parameters
    ----------
    engine : Engine
        The engine; gas pressure counts where it has cycles.
    rpm : float or array_like, shape (n_rpm,)
        Crank speed, rpm, or several. What gas makes is the same at all of them.
    orders : number, sequence of numbers or "auto", default "auto"
        Multiples of crank speed; ``"auto"`` for all up to 12, or to twice the number of cylinders
        where that is more, halves among them for a fired four-stroke.
    reference_z : float, optional
        Plane from which the distances of the X-type are counted, m; by default the engine's own,
        in its middle.
    length : float, optional
        Distance by which the bimoment is divided, m, such as that of the top bracings; the result
        then has ``x_moment`` too, N·m.

    Returns
    -------
    GuideMoments
        Phasors of H-type, X-type and of each cylinder, N·m and N·m².

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
    >>> cylinder = cp.Cylinder(crank_radius=0.5, rod_length=1.5, reciprocating_mass=1000)
    >>> six = cp.Engine.from_firing_order(
    ...     cylinder, firing_order="1-5-3-4-2-6", strokes=2, spacing=0.6
    ... )
    >>> guide = cp.guide_moments(six, rpm=200)
    >>> one = guide.cylinder_moment.sel(cylinder=1)
    >>> (guide.x_bimoment[3].peak / one[3].peak / 0.6).round(4)
    np.float64(9.0)
    >>> (guide.h_moment[6].peak / one[6].peak).round(4), float(guide.x_bimoment[6].peak)
    (np.float64(6.0), 0.0)
    """
    core = engine_core(engine)
    wanted = inputs.half_orders(orders)
    if wanted is None:
        chosen = orders_up_to(engine, max(HIGHEST, 2 * len(engine)))
        wanted = inputs.explicit_half_orders(chosen)
    plane = engine.reference_z
    if reference_z is not None:
        plane = inputs.finite("reference_z", reference_z)
        checks.place(core, "reference_z", plane)
    divisor = None if length is None else inputs.positive("length", length)
    speeds = inputs.speeds(rpm)
    balance = engine.balance(inputs.fastest(speeds), orders=wanted)
    return GuideMoments(engine, speeds, balance.orders, plane, divisor)


class GuideMoments(Labelled):
    """Guide-force moments of H and X type, and of each cylinder, per order.

    Phasors of ``Re(P exp(inθ))``, of masses and gas; of each ``quantity.gas`` and
    ``quantity.inertia`` are the parts. Made by :func:`crankpin.guide_moments`.
    """

    engine: Engine
    """The engine."""
    rpm: float | NDArray[np.float64]
    """Crank speed, rpm, or speeds: (n_rpm,)."""
    orders: tuple[Order, ...]
    """Multiples of crank speed."""
    reference_z: float
    """Plane from which distances are counted, m."""
    length: float | None = None
    """Distance by which the bimoment is divided, m; None where there is none."""
    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = GUIDES

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"cylinder": np.arange(1, len(self.engine) + 1)}

    @property
    def _wholes(self) -> tuple[str, ...]:
        return tuple(n for n in GUIDES if self.length is not None or n != "x_moment")

    @property
    def _names(self) -> tuple[str, ...]:
        return tuple(n for whole in self._wholes for n in (whole, *self._parts(whole)))

    def _parts(self, quantity: str) -> tuple[str, ...]:
        return tuple(f"{quantity}.{part}" for part in self._named_parts(quantity))

    def _named_parts(self, quantity: str) -> tuple[str, ...]:
        return () if "." in quantity else GAS_AND_INERTIA

    @property
    def _attributes(self) -> Mapping[str, Any]:
        return {**super()._attributes, "reference_z": self.reference_z}

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.engine.loads_counted

    def _at_order(self, order: Order) -> GuideMoments:
        one: GuideMoments = self._once(order, lambda: changed(self, orders=(order,)))
        return one

    @cached_property
    def _by_cylinder(self) -> dict[str, tuple[NDArray[np.complex128], NDArray[np.float64]]]:
        """Phasors of each cylinder by part, and the bounds of their rounding errors.

        Both of shape (n_rpm, n_cylinders, n_orders).
        """
        speeds, fastest = np.ravel(self.rpm), inputs.fastest(self.rpm)
        with suppressed():  # Warned of where the moments were made.
            balance = self.engine.balance(fastest, orders=self.orders)
        # Torque of masses has the square of the speed as a factor, that of gas none.
        squares = (speeds / fastest) ** 2 if fastest else np.ones(len(speeds))
        scales = {"gas": np.ones(len(speeds)), "inertia": squares}
        parts = {}
        for name in GAS_AND_INERTIA:
            phasors, bounds = of_cylinders(balance, f"torque.{name}")
            parts[name] = tuple(np.multiply.outer(scales[name], of) for of in (phasors, bounds))
        parts[""] = tuple(sum(of) for of in zip(*parts.values(), strict=True))
        return parts

    def _values(self, quantity: str) -> NDArray[Any]:
        whole, _, part = quantity.partition(".")
        phasors, bounds = self._by_cylinder[part]
        if whole != "cylinder_moment":
            weights = np.ones(len(self.engine))
            if whole != "h_moment":
                weights = (self.engine.z - self.reference_z) / (
                    self.length if whole == "x_moment" and self.length else 1.0
                )
            sums = np.einsum("c,rcn->rn", weights, phasors)
            bound = np.einsum("c,rcn->rn", np.abs(weights), bounds)
            phasors = np.where(np.abs(sums) > bound, sums, 0.0)
        return phasors if self.coords else phasors[0]

    @property
    def h_moment(self) -> Quantity[np.complex128]:
        """H-type moment, the sum over cylinders, N·m: (…, n_orders)."""
        return self._quantity("h_moment")

    @property
    def x_bimoment(self) -> Quantity[np.complex128]:
        """X-type bimoment, Σ (z − z₀)·M of the cylinders, N·m²: (…, n_orders)."""
        return self._quantity("x_bimoment")

    @property
    def x_moment(self) -> Quantity[np.complex128]:
        """X-type bimoment over ``length``, N·m: (…, n_orders); undefined without a length."""
        if self.length is None:
            hint = Hint.of("give `length` to crankpin.guide_moments, or take x_bimoment")
            raise inputs.faulty("x_moment", "is undefined without a length", hint, AbsentError)
        return self._quantity("x_moment")

    @property
    def cylinder_moment(self) -> Quantity[np.complex128]:
        """Moment of each cylinder, M_H, N·m: (…, n_cylinders, n_orders)."""
        return self._quantity("cylinder_moment")

    @property
    def table(self) -> Table:
        """Amplitudes and phases by speed and order; the largest of a single cylinder beside."""
        speeds = np.atleast_1d(self.rpm)
        columns = []
        if np.ndim(self.rpm):
            columns.append(Column("speed", np.repeat(speeds, len(self.orders)), "rpm"))
        columns.append(Column("order", self.orders * len(speeds)))
        heads = {"h_moment": "H-type", "x_bimoment": "X-type", "x_moment": "X-type over length"}
        for name, head in heads.items():
            if name not in self._wholes:
                continue
            phasors = np.asarray(self.read(name))
            angles = np.angle(phasors, deg=True).ravel().tolist()
            columns.append(Column(head, np.abs(phasors), GUIDES[name].unit))
            if name != "x_moment":
                phases = tuple(
                    angle if phasor else None
                    for angle, phasor in zip(angles, phasors.ravel().tolist(), strict=True)
                )
                columns.append(Column(f"{head} phase", phases, "°", digits=4))
        largest = np.abs(self.read("cylinder_moment")).max(axis=-2)
        columns.append(Column("one cylinder", largest, "N·m"))
        at = f"{speeds.min():g} to {speeds.max():g}" if len(speeds) > 1 else f"{speeds[0]:g}"
        title = units.Text(
            f"{labels.name_of(self.engine)} at {at} rpm: guide-force moments, X-type about z = ",
            units.figure(self.reference_z, "m", 6),
        )
        return Table(title, tuple(columns), loads=self.loads_counted)
