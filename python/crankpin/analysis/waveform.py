"""Force, moment and torque of an engine over crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Generic

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.messages import Hint
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.labelled import Shaking
from crankpin.analysis.quantity import Values
from crankpin.analysis.request import Request, check_request, engine_core

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders, Spectrum
    from crankpin.model.engine import Engine


def waveform(
    engine: Engine,
    rpm: float,
    theta_deg: ArrayLike | None = None,
    *,
    orders: Orders | None = None,
    rtol: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
) -> Waveform:
    """Return the waveform of an engine; :meth:`Engine.waveform` documents the arguments."""
    theta = inputs.crank_angles(theta_deg)
    if orders is None and rtol is not None:
        hint = Hint.of('needs `orders="auto"`; exact kinematics has no tolerance')
        raise inputs.rejected("rtol", rtol, hint)
    if orders is None and spectrum is not None:
        raise inputs.rejected(
            "orders",
            None,
            Hint.of(
                "exact kinematics needs the slider-crank; give `orders`, or "
                '`orders="auto"`, with a `spectrum`'
            ),
        )
    request = Request.checked(
        orders="auto" if orders is None else orders,
        rtol=rtol,
        spectrum=spectrum,
        torque=torque,
        default_rtol=1e-6,
    )
    curves = Waveform(engine, inputs.number("rpm", rpm), theta, orders is not None, request)
    inputs.warn_of_units(mean_piston_speed(engine, curves.rpm))
    return curves


class OverAngle(Shaking["np.float64", Values, Values], Generic[Values]):
    """Base class of waveforms: force, moment and torques over crank angle."""

    _along: ClassVar[tuple[str, ...]] = ("theta_deg",)

    @property
    def orders(self) -> tuple[Order, ...] | None:
        """Orders that are summed; None for exact kinematics."""
        raise NotImplementedError

    @property
    def _how(self) -> str:
        return "exact kinematics" if self.orders is None else labels.orders_text(self.orders)


class Waveform(OverAngle[float]):
    """Force, moment and torque of an engine at given crank angles.

    Made by :meth:`Engine.waveform`.

    Examples
    --------
    >>> import crankpin as cp
    >>> engine = cp.Engine.preset("v6-60")
    >>> exact = engine.waveform(rpm=6000, theta_deg=[0, 10, 20])
    >>> summed = engine.waveform(rpm=6000, theta_deg=[0, 10, 20], orders="auto", rtol=1e-6)
    >>> bool(abs(exact.moment - summed.moment).max() <= summed.error_bound["moment"])
    True
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    theta_deg: NDArray[np.float64]
    """Crank angles, degrees: (n_theta,)."""
    summed: bool
    """True if a sum of orders was requested, False for exact kinematics."""
    _request: Request
    """The options of the waveform, checked."""

    def __post_init__(self) -> None:
        check_request(self._request, "Engine.waveform")
        request = self._request
        theta = inputs.copied(self.theta_deg)
        (planar, torques), parts, balance = _core.waveform(
            engine_core(self.engine),
            self.rpm,
            theta,
            self.summed,
            request.orders if self.summed else None,
            request.rtol,
            request.reference_z,
            request.pairs,
            request.torque,
        )
        arrays = (*(planar or ()), *(torques or (None, None)))
        by_name: dict[str, Any] = dict(zip(QUANTITIES, arrays, strict=True))
        zeros = {2: np.zeros((len(theta), 2)), 1: np.zeros(len(theta))}
        # Inertia makes the rest.
        rest = {name: values for name, values in by_name.items() if values is not None}
        for part, (of_planar, of_torques) in parts:
            buffers = (*(of_planar or (None, None)), *(of_torques or (None, None)))
            for name, values in zip(QUANTITIES, buffers, strict=True):
                if name in rest:
                    by_name[f"{name}.{part}"] = zeros[rest[name].ndim] if values is None else values
                    rest[name] = rest[name] if values is None else rest[name] - values
        by_name |= {f"{name}.inertia": read_only(values) for name, values in rest.items()}
        names = ("inertia", *(part for part, _ in parts))
        self.__dict__.update(theta_deg=theta, _by_name=by_name, _balance=balance, _names=names)
        super().__post_init__()

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return self.__dict__["_names"]  # type: ignore[no-any-return]

    @property
    def _summed(self) -> _core.Balance | None:
        """Balance whose orders were summed, if any."""
        return self.__dict__["_balance"]  # type: ignore[no-any-return]

    @property
    def orders(self) -> tuple[Order, ...] | None:
        """Orders that were summed; None for exact kinematics."""
        return None if self._summed is None else tuple(self._summed.orders)

    @property
    def omitted(self) -> tuple[Order, ...]:
        """With ``orders="auto"``: orders that were left out; see :attr:`Balance.omitted`."""
        return () if self._summed is None else tuple(self._summed.omitted)

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → upper bound on what the omitted orders add, N or N·m; zero if exact."""
        if self._summed is None:
            return self._request.bounds((0.0, 0.0, 0.0))
        return self._request.bounds(self._summed.error_bound)

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return self.engine.fired

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as :attr:`Balance.loads_counted`."""
        return self._request.loads_counted(self.engine.loads_counted)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        by_name: dict[str, NDArray[np.float64]] = self.__dict__["_by_name"]
        if (values := by_name.get(quantity)) is None:  # gas that there is none of
            return read_only(np.zeros_like(by_name[quantity.partition(".")[0]]))
        return values

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the crank angles."""
        return {"theta_deg": self.theta_deg}

    # --- tables and pictures --------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Table that is shown: least and largest value of each component, and where."""
        rows = []
        for name in self._request.quantities:
            kind = QUANTITIES[name]
            values = self.read(name).reshape(-1, len(kind.components))
            for component, column in zip(kind.components, values.T, strict=True):
                at = [column.argmin(), column.argmax()] if column.size else []
                ends = np.stack([column[at], self.theta_deg[at]], axis=1).ravel().tolist()
                rows.append((kind.words, component, kind.unit, *(ends or [np.nan] * 4)))
        where = f"{labels.name_of(self.engine)} at {self.rpm:g} rpm"
        title = f"{where}, {len(self.theta_deg)} crank angles, {self._how}"
        return Table.from_rows(
            title,
            ["quantity", "component", "unit", "least", ("at", "°"), "largest", ("at", "°")],
            rows,
            loads=self.loads_counted,
            row_units=[str(row[2]) for row in rows],
        )
