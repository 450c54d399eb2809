"""Balance factors, and engines, swept on their mounts: motion or force at receivers over speed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support.messages import Hint
from crankpin._support.quantities import AT_RECEIVERS, PLANE_VECTORS, QUANTITIES
from crankpin._support.record import AbsentError, computed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balancing.fitting import check_factor, with_bob_weights
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.mounts import active
from crankpin.analysis.mounts import response as forced
from crankpin.analysis.mounts.response import READ, MountResponse
from crankpin.analysis.request import Request, check_request, engine_core
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.frames import Frames
    from crankpin._support.inputs import Orders
    from crankpin._support.quantities import Kind
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity

Norm = Literal["largest", "rms"]
NORMS: tuple[Norm, ...] = ("largest", "rms")
ALL_RECEIVERS = "all"
"""Row of all receivers together."""


class MountSweep(Labelled):
    """Rms of all orders at receivers on mounts, by balance factor or engine, and by speed.

    The balance factors are shares of the reciprocating mass that counterweights opposite the
    crankpins balance, as :func:`crankpin.bob_weight` has them. Made by :meth:`Powertrain.sweep`.
    """

    powertrain: Powertrain
    """The powertrain."""
    rpm: NDArray[np.float64]
    """Crank speeds."""
    factor: NDArray[np.float64] | None
    """Balance factors, or None where engines are compared."""
    engines: Mapping[str, Engine]
    """Name → engine that is compared; empty where factors are swept."""
    receivers: tuple[Any, ...]
    """Motions or forces: name, source, direction."""
    _request: Request
    """Orders and tolerance, checked."""
    _rms: NDArray[np.float64] = computed()

    _registry: ClassVar[Mapping[str, Kind]] = AT_RECEIVERS

    def __post_init__(self) -> None:
        request = check_request(self._request, "Powertrain.sweep")
        factors = self.factor
        if factors is None:
            engines = list(self.engines.values())
        else:
            engines = [with_bob_weights(self.engine, each) for each in factors.tolist()]
        responses = [self._response(engine, request) for engine in engines]
        rows = [np.stack(_sizes(self._vectors(one)), axis=-1) for one in responses]
        self.__dict__["_rms"] = read_only(np.stack(rows))
        super().__post_init__()

    def _response(self, engine: Engine, request: Request) -> MountResponse:
        return MountResponse(self.powertrain.replace(engine=engine), self.rpm, request)

    def _vectors(self, response: MountResponse) -> list[NDArray[np.complex128]]:
        """Return phasors of each receiver: (n_rpm, n_orders, 3), along a direction (…, 1)."""
        return [active._values(response, place) for place in self.receivers]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the receivers."""
        return tuple(name for name, *_ in self.receivers)

    @property
    def engine(self) -> Engine:
        """The engine of the powertrain."""
        return self.powertrain._require_engine("powertrain")

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: ``factor`` or ``engine``, then ``rpm``."""
        if self.factor is None:
            return {"engine": tuple(self.engines), "rpm": self.rpm}
        return {"factor": self.factor, "rpm": self.rpm}

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"receiver": self.names}

    @property
    def _kind_of_receivers(self) -> str:
        """Quantity that the receivers have."""
        return "velocity" if all(source[0] == "at" for _, source, _ in self.receivers) else "force"

    @property
    def _names(self) -> tuple[str, ...]:
        return (self._kind_of_receivers,)

    def _check(self, quantity: str) -> None:
        if quantity in AT_RECEIVERS and quantity not in self._names:
            hint = Hint.of("give `receivers` that are points, or forces")
            raise inputs.faulty(quantity, "is not available", hint, AbsentError)
        super()._check(quantity)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        return self._rms

    @property
    def velocity(self) -> Quantity[np.float64]:
        """Rms velocity of points, all orders together, m/s: (n, n_rpm, n_receivers).

        The length of the vector, or the part along the direction given. An AttributeError where
        receivers are forces.
        """
        return self._quantity("velocity")

    @property
    def force(self) -> Quantity[np.float64]:
        """Rms force on what carries the mounts, all orders together, N: (n, n_rpm, n_receivers).

        An AttributeError where receivers are points.
        """
        return self._quantity("force")

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        engines = [self.engine] if self.factor is not None else [*self.engines.values()]
        return labels.loads_of(engines, [labels.name_of(engine) for engine in engines])

    # --- the best factor ------------------------------------------------------------------------

    def _require_factors(self, name: str) -> NDArray[np.float64]:
        if self.factor is None:
            hint = Hint.of("engines are compared; give Powertrain.sweep a `factor`")
            raise inputs.faulty(name, "is undefined", hint, AbsentError)
        return self.factor

    @cached_property
    def _ends(self) -> tuple[list[NDArray[np.complex128]], list[NDArray[np.complex128]]]:
        """Phasors at the lowest factor, and their change to the highest: motion is linear in it."""
        factors = self._require_factors("best")
        ends = [with_bob_weights(self.engine, float(end)) for end in (factors.min(), factors.max())]
        orders = {order for one in ends for order in self._response(one, self._request).orders}
        request = self._request.at_orders(tuple(sorted(orders)))
        low, high = (self._vectors(self._response(one, request)) for one in ends)
        return low, [after - before for before, after in zip(low, high, strict=True)]

    def _at(self, factor: float) -> NDArray[np.float64]:
        """Return the rms at a factor: (n_rpm, n_receivers)."""
        factors = self._require_factors("best")
        span = float(np.ptp(factors))
        share = (factor - float(factors.min())) / span if span else 0.0
        pairs = zip(*self._ends, strict=True)
        return np.stack(_sizes([start + share * change for start, change in pairs]), axis=-1)

    def best(self, receiver: str | None = None, norm: Norm = "largest") -> float | None:
        """Return the factor, of those between the lowest and the highest swept, that is best.

        Exact, not one of the factors swept: motion is linear in the factor, so that its rms is
        convex.

        Parameters
        ----------
        receiver : str, optional
            Name of a receiver; by default all together.
        norm : {"largest", "rms"}, default "largest"
            What is minimised over the speeds: the largest rms, or the root of their mean square.

        Returns
        -------
        float or None
            The factor; None if it makes no difference.

        Raises
        ------
        InputError
            If there is no such receiver or norm, or engines are compared.
        """
        factors = self._require_factors("best")
        inputs.one_of("norm", norm, NORMS)
        if receiver is not None:
            inputs.one_of("receiver", receiver, self.names)
        places = [k for k, name in enumerate(self.names) if receiver in (None, name)]
        low, span = float(factors.min()), float(np.ptp(factors))

        def least() -> tuple[float | None]:
            if not span:
                return (low,)
            rows = [[part[k].reshape(len(self.rpm), -1) for k in places] for part in self._ends]
            widths = [row.shape[1] for row in rows[0]] * len(self.rpm)
            start, change = (np.ascontiguousarray(np.concatenate(row, axis=1)) for row in rows)
            groups = widths if norm == "largest" else None
            share = _core.least_share(start.ravel(), change.ravel(), groups)
            return (None if share is None else low + share * span,)

        return self._once(("best", receiver, norm), least)[0]  # type: ignore[no-any-return]

    @property
    def fitted(self) -> Powertrain:
        """The powertrain with the factor of the least largest rms at all receivers together."""
        factor = self.best()
        if factor is None:
            factor = float(self._require_factors("fitted").min())
        return self.powertrain.replace(engine=with_bob_weights(self.engine, factor))

    # --- tables -----------------------------------------------------------------------------------

    @property
    def _shown_in(self) -> tuple[str, float]:
        """Unit in which the rms is read, and how many of it the unit of the array is."""
        return READ["velocity"] if self._kind_of_receivers == "velocity" else ("N", 1.0)

    def _title(self, what: str) -> str:
        words = AT_RECEIVERS[self._kind_of_receivers].words
        low, high = float(self.rpm.min()), float(self.rpm.max())
        speeds = f"{low:g} to {high:g} rpm" if low < high else f"{low:g} rpm"
        return f"{self.powertrain._title}, {speeds}: {words}, {what}"

    @property
    def table(self) -> Table:
        """Largest rms over the speeds at each receiver, and where, by factor or engine.

        Beside factors the half axes of the engine's order 1 by itself, over ω²: the ellipse of the
        classical answer.
        """
        unit, scale = self._shown_in
        head, values = next(iter(self.coords.items()))
        columns = [Column(head, values, digits=10)]
        for k, name in enumerate(self.names):
            rows = self._rms[..., k]
            columns.append(Column(f"{name} rms", scale * rows.max(axis=1), unit))
            columns.append(Column("at", self.rpm[rows.argmax(axis=1)], "rpm", digits=10))
        if self.factor is not None:
            columns += self._classical(self.factor)
        note = ""
        if self.factor is not None and (best := self.best()) is not None:
            most = scale * float(self._at(best).max())
            least = units.figure(most, unit, 5)
            note = units.Text("Least largest: ", least, f" at a factor of {best:.6g}.")
        title = self._title("largest over speed")
        return Table(title, tuple(columns), note, self.loads_counted)

    @cached_property
    def _first_order(self) -> _core.FirstOrder:
        """Force and moment of order 1 by factor, over ω², of the engine by itself."""
        return _core.FirstOrder(engine_core(self.engine))

    @property
    def _classical_factor(self) -> float | None:
        """Factor of the least force, or without one moment, of the engine by itself."""
        least = (self._first_order.least(name) for name in PLANE_VECTORS)
        return next((factor for factor in least if factor is not None), None)

    def _classical(self, factors: NDArray[np.float64]) -> list[Column]:
        """Return half axes of the engine's force or moment of order 1, over ω²."""
        columns = []
        for name in PLANE_VECTORS:
            if self._first_order.exists(name):
                unit = QUANTITIES[name].unit_over_square
                longest, shortest = self._first_order.half_axes(name, factors.tolist())
                columns += [Column(f"{name}, longest", longest, unit),
                            Column("shortest", np.abs(shortest), unit)]  # fmt: skip
        return columns

    @property
    def frames(self) -> Frames:
        """``table``; of factors ``best``: at each receiver, and at all together."""
        return self._frames() if self.factor is None else self._frames(best=self._best_table)

    def _best_table(self) -> Table:
        unit, scale = self._shown_in
        names: list[str | None] = [*self.names, *([None] if len(self.names) > 1 else [])]
        rows: list[Sequence[Any]] = []
        for name in names:
            places = [k for k, one in enumerate(self.names) if name in (None, one)]
            row: list[Any] = [ALL_RECEIVERS if name is None else name]
            for norm in NORMS:
                factor = self.best(name, norm)
                if factor is None:
                    row += [None] * (3 if norm == "largest" else 2)
                    continue
                values = scale * self._at(factor)[:, places]
                if norm == "largest":
                    speed = int(values.max(axis=1).argmax())
                    row += [factor, float(values.max()), float(self.rpm[speed])]
                else:
                    row += [factor, float(np.sqrt((values**2).sum(axis=1).mean()))]
            rows.append(row)
        heads: list[str | tuple[str, str]] = ["receiver", "factor", ("least largest", unit)]
        heads += [("at", "rpm"), "factor of rms", ("least rms over speeds", unit)]
        return Table.from_rows(
            self._title("at the best factor"), heads, rows, loads=self.loads_counted
        )


def _sizes(vectors: Sequence[NDArray[np.complex128]]) -> list[NDArray[np.float64]]:
    """Return the rms of all orders of each receiver: (n_rpm,)."""
    return [np.sqrt(0.5 * (np.abs(vector) ** 2).sum(axis=(-2, -1))) for vector in vectors]


def sweep(
    powertrain: Powertrain,
    rpm: ArrayLike,
    *,
    factor: ArrayLike | None,
    engines: Mapping[str, Engine] | None,
    receivers: object,
    orders: Orders,
    rtol: float | None,
) -> MountSweep:
    """Return the sweep; :meth:`Powertrain.sweep` documents the arguments."""
    inputs.only_one_of(factor=factor, engines=engines)
    speeds = inputs.copied(inputs.vector("rpm", np.atleast_1d(inputs.array("rpm", rpm))))
    factors, named = None, dict[str, Engine]()
    if factor is not None:
        shares = inputs.array("factor", factor)
        check_factor("factor", shares if shares.ndim else float(shares))
        factors = inputs.copied(inputs.vector("factor", np.atleast_1d(shares)))
    elif not isinstance(engines, Mapping) or not engines:
        raise inputs.rejected("engines", engines, 'give {"name": a crankpin.Engine}')
    else:
        for name, engine in engines.items():
            engine_core(engine, "engines")
            named[inputs.text("engines", name)] = engine
    # Orders, free motions and units are checked and warned of once, of the engine as it is.
    response = forced.response(powertrain, speeds, orders=orders, rtol=rtol)
    places = active._places("receivers", receivers, response)
    return MountSweep(
        powertrain, speeds, factors, MappingProxyType(named), places, response._request
    )
