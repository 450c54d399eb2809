"""Force, moment and torque of an engine at one speed, order by order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.messages import suppressed
from crankpin._support.quantities import QUANTITIES, kind_of
from crankpin._support.tables import Column, Table
from crankpin.analysis.by_order import ByOrder
from crankpin.analysis.export import VALUES
from crankpin.analysis.quantity import ALL, one_order
from crankpin.analysis.request import Request, check_request, engine_core
from crankpin.analysis.vanishing import SUMS
from crankpin.model import shafts as rotating
from crankpin.model.loads import of_speed_squared

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order, Orders, Spectrum
    from crankpin.model.engine import Engine


EXPLAINED = 3
"""Sentences under a table in notebooks."""


def balance(
    engine: Engine,
    rpm: float,
    *,
    orders: Orders = "auto",
    rtol: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
) -> Balance:
    """Return the balance of an engine; :meth:`Engine.balance` documents the arguments."""
    request = Request.checked(orders=orders, rtol=rtol, spectrum=spectrum, torque=torque)
    whole = Balance(engine, inputs.number("rpm", rpm), request)
    inputs.warn_of_units(mean_piston_speed(engine, whole.rpm))
    return whole


def over_square(engine: Engine, orders: Sequence[Order]) -> Balance:
    """Return the balance over ω², of what scales so: forces in kg·m, moments in kg·m²."""
    return balance(of_speed_squared(engine), labels.UNIT_RPM, orders=orders, torque=False)


def mean_piston_speed(engine: Engine, rpm: float) -> float:
    """Return the largest mean piston speed of any cylinder, m/s."""
    return engine_core(engine).mean_piston_speed(rpm)


class Balance(ByOrder[float]):
    """Force, moment and torque of an engine at one speed, order by order.

    ``force``, ``moment``, ``torque`` and ``crank_torque`` are complex peak phasors, each a
    :class:`~crankpin.results.Quantity`. An order is a key: ``balance[2].force`` and
    ``balance.force[2]`` are order 2, also if it is not among ``orders``; ``balance.total`` is all
    orders together. Sums that vanish are exactly zero: a phasor below its
    ``zero_bound``, the largest rounding error of such a sum, is reported as zero.

    Made by :meth:`Engine.balance` and :meth:`Sweep.sel`.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("v8-crossplane").balance(rpm=6000)
    >>> list(b)
    [1, 4, 8, 12]
    >>> b.force[2].peak, b.force[2].status, 2 in b
    (np.float64(0.0), 'zero, proved', False)
    >>> bool(b[1].moment.minor == b[1].moment.peak)  # a circle
    True
    >>> round(b.total.moment.peak) == round(b[1].moment.peak)
    True
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    _request: Request
    """The options of the balance, checked."""
    _within: tuple[ByOrder, tuple[int, ...]] | None = None
    """Sweep, and place in it, whose arrays it reads; None where it was computed for itself."""

    def __post_init__(self) -> None:
        request = check_request(self._request, "Engine.balance")
        self.__dict__["_core"] = (
            _core.balance(
                engine_core(self.engine),
                self.rpm,
                request.orders,
                request.rtol,
                request.reference_z,
                request.pairs,
                request.torque,
            )
            if self._within is None
            else self._within[0]
        )

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return self._within[0].fired if self._within is not None else self.engine.fired

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → upper bound on what the omitted orders add at any crank angle, N or N·m.

        It covers the orders in ``omitted`` and all above them; zero where orders were given.
        Rounding is not included: sums that vanish to within ``zero_bound`` are zero.
        """
        if self._within is not None:
            return self._within[0].error_bound
        return self._request.bounds(self.__dict__["_core"].error_bound)

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return super().causes if self._within is None else self._within[0].causes

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        plane = self._request.reference_z
        return self.engine.reference_z if plane is None else plane

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset: name of the engine, speed, and the plane of moments."""
        return {"engine": self.engine.name, "rpm": self.rpm, "reference_z": self.reference_z}

    @property
    def _engines(self) -> tuple[Engine, ...]:
        return (self.engine,)

    def _with_request(self, request: Request) -> Self:
        """Return the same balance by another request."""
        within = self._within
        if within is not None:
            within = (within[0]._with_request(request), within[1])
        return type(self)(self.engine, self.rpm, request, within)

    def _proved_zero(self, quantity: str, order: Order) -> bool:
        """Return whether a quantity of one order is proved to vanish."""
        self._request.check(quantity, self)
        whole, _, part = quantity.partition(".")
        order = one_order(order)
        if part not in ("", "inertia", "gas"):
            return False  # numbers that were given
        engine = self.engine if not part else self.engine.with_loads([])
        bare = kind_of(whole).planar or not self.fired or part == "inertia"
        if order % 1 and bare and not engine.loads and rotating.repeat_in_a_turn(engine._core):
            return True
        if self._request.pairs is not None or (whole == "torque" and any(self._request.aside)):
            return False
        core, plane = engine_core(engine), self._request.reference_z
        proofs = _core.vanishing(core, [round(2 * order)], plane, None)
        vanishes = dict(zip(SUMS, proofs["vanishes"][0], strict=True))
        if whole == "crank_torque" and any(ratio < 0 for _, _, ratio in core.cranks[0]):
            return False  # cranks of opposite senses exert on the block what adds up on the crank
        if kind_of(whole).planar:
            return bool(vanishes[whole, "x"] and vanishes[whole, "y"])
        # A torque of inertia on the crank vanishes with that on the block.
        without_inertia = part == "gas" or bool(vanishes["torque", "z"])
        without_gas = part == "inertia" or not (part or self.fired)
        return without_inertia and (without_gas or bool(vanishes["gas_torque", "z"]))

    def _read_order(self, order: Order, quantity: str, what: str) -> Any:  # noqa: ANN401 - as read
        if what == "peak" and self._within is None and not any(self._request.aside):
            alone: _core.Balance | None = self.__dict__["_core"].alone(one_order(order))
            if alone is not None:  # quicker than the peaks of all orders
                planar = kind_of(quantity).planar
                lengths = np.abs(alone.phasors(quantity, planar))[0]
                return lengths[0] + lengths[1] if planar else lengths
        return super()._read_order(order, quantity, what)

    def _at_order(self, order: Order) -> ByOrder[float]:
        core = None if self._within is not None else self.__dict__["_core"].alone(order)
        if core is None or order in self._kept:
            return super()._at_order(order)
        # What was evaluated as orders were chosen is not computed again.
        alone = object.__new__(type(self))
        request = self._request.at_orders((order,))
        fields = {"engine": self.engine, "rpm": self.rpm, "_request": request, "_within": None}
        alone.__dict__.update(fields, _core=core)
        return self._kept.setdefault(order, alone)  # type: ignore[no-any-return]

    def _about_point(self, quantity: str, what: str) -> NDArray[Any]:
        if self._within is None:
            return super()._about_point(quantity, what)
        whole, at = self._within
        part: NDArray[Any] = whole.read(quantity, what)[at]
        return part

    def _about_axis(self, quantity: str, what: str) -> NDArray[Any]:
        core: _core.Balance = self.__dict__["_core"]
        if what == VALUES:
            return core.phasors(quantity, False)
        if what in labels.TURNING_WORDS:
            return core.phasors(quantity, True)[:, int(what == "backward")]
        if what == "peak" and kind_of(quantity).planar:
            forward, backward = np.abs(core.phasors(quantity, True)).T
            return np.asarray(forward + backward)
        if what in ("peak", "peak_xy"):
            return np.asarray(np.abs(self.read(quantity)))
        # "zero_bound", "total_peak", "total_peak_xy" and "cycle_mean"
        return np.asarray(getattr(core, what.removeprefix("cycle_"))(quantity))

    # --- tables and pictures --------------------------------------------------------------------

    def _repr_html_(self) -> str | None:
        """Return the table and, under it, what matters most in words."""
        table = super()._repr_html_()
        if self._request.pairs is not None:
            return table
        with suppressed():  # Warned of where the balance was made.
            explanation = self.engine.replace(reference_z=self.reference_z).explain(self.rpm)
        return f"{table}{explanation.html(count=EXPLAINED)}"

    @property
    def table(self) -> Table:
        """Table that is shown: peaks by order and of all together, negligible orders left out."""
        names = [name for name in self._request.quantities if name != "crank_torque"]
        places, left_out = self._shown_orders(*names)
        mean = ("mean",) if self._has_means else ()
        columns = [Column("order", (*mean, *(self.orders[k] for k in places), ALL))]
        for name in names:
            kind = QUANTITIES[name]
            peaks = self.read(name, "peak_xy" if kind.planar else "peak")
            total = self.read(name, "total_peak_xy" if kind.planar else "total_peak")
            rows = np.concatenate(
                [
                    peaks.reshape(len(self.orders), len(kind.symbols))[list(places)],
                    total.reshape(1, -1),
                ]
            )
            means: tuple[float | None, ...] = ()
            if self._has_means:
                means = (None if kind.planar else getattr(self, name).cycle_mean,)
            least = self._least_shown(rows)
            columns += [
                Column(symbol, (*means, *values), kind.unit, least=least)
                for symbol, values in zip(kind.symbols, rows.T.tolist(), strict=True)
            ]
        which = " of the orders given" if self._request.orders is not None else ""
        title = f"{labels.name_of(self.engine)} {labels.at_speed(self.rpm)}: peaks{which}"
        notes = [labels.not_shown(left_out)]
        if "torque" in names:
            notes.append(self._roll_axis())
        note = units.joined(" ", notes)
        return Table(title, tuple(columns), note, loads=self.loads_counted)

    def _roll_axis(self) -> str:
        """Return about which axis the roll torque is, where there are several to choose from."""
        x, y = self._request.aside
        if x or y:
            place = units.figure(x, "m", 6), ", y = ", units.figure(y, "m", 6)
            return units.Text("|M_z| is about the axis at x = ", *place, ".")
        about = labels.about_axis(engine_core(self.engine).cranks[0])
        return f"|M_z| is{about}." if about else ""
