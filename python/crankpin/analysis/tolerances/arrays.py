"""Arrays of an engine's samples, drawn by the core."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import progress as progress_bar
from crankpin._support.frozen import Frozen
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin.analysis.balance import Balance
from crankpin.analysis.by_order import ByOrder, ErrorBound
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.progress import Progress
    from crankpin.analysis.request import Request
    from crankpin.analysis.tolerances.spreads import Spreads
    from crankpin.model.engine import Engine


class ToleranceArrays(ByOrder, Frozen):
    """Arrays of samples: dimension ``sample``, then orders."""

    _fields: ClassVar[tuple[str, ...]] = (
        "engine", "rpm", "spreads", "samples", "seed", "request", "bound",
    )  # fmt: skip

    def __init__(
        self,
        engine: Engine,
        rpm: float,
        spreads: Spreads,
        samples: int,
        seed: int,
        request: Request,
        bound: ErrorBound,
        progress: Progress = False,
    ) -> None:
        orders = request.orders or ()
        core = _core.Tolerances(
            engine_core(engine),
            rpm,
            list(orders),
            request.reference_z,
            request.torque,
            spreads.values,
            spreads.distribution,
            seed,
            spreads.pin_of,
        )
        with progress_bar.shown(progress, "tolerances") as report:
            force, moment, torque, peaks = core.sample(0, samples, report)
        self._set(
            engine=engine,
            rpm=rpm,
            spreads=spreads,
            samples=samples,
            seed=seed,
            request=request,
            bound=bound,
            _orders=orders,
            core=core,
            _planar={"force": force, "moment": moment},
            _torques=torque,
            _peaks=peaks,
        )

    engine: Engine
    rpm: float
    spreads: Spreads
    samples: int
    seed: int
    bound: ErrorBound
    """Bounds on what omitted orders add to the nominal engine."""
    core: _core.Tolerances
    """Compiled counterpart."""
    _planar: dict[str, NDArray[np.complex128]]
    _torques: NDArray[np.complex128]
    _peaks: NDArray[np.float64]

    _orders: tuple[int, ...]

    @property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        return self._orders

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimension of the samples."""
        return ("sample",)

    @property
    def error_bound(self) -> ErrorBound:
        """Bounds on what omitted orders add to the nominal engine."""
        return self.bound

    @cached_property
    def nominal(self) -> Balance:
        """Balance of the engine without deviations, of the same orders."""
        return Balance(self.engine, self.rpm, self.request)

    def only(self, name: str) -> ToleranceArrays:
        """Return the same samples with one figure alone deviating."""
        return ToleranceArrays(
            self.engine,
            self.rpm,
            self.spreads.only(name),
            self.samples,
            self.seed,
            self.request,
            self.bound,
        )

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        planar = quantity in PLANE_VECTORS
        if what in ("forward", "backward"):
            return self._planar[quantity][..., 2 + int(what == "backward")]
        if what == "zero_bound":
            bound = self.nominal.read(quantity, what)
            return np.broadcast_to(bound, (self.samples, *bound.shape))
        if what == "total_peak":
            return self._peaks[:, tuple(QUANTITIES).index(quantity)]
        phasors = self._planar[quantity][..., :2] if planar else self._torque(quantity)
        if what == "total_peak_xy":
            orders = list(self.orders)
            along = [np.ascontiguousarray(phasors[..., axis]) for axis in (0, 1)]
            return np.stack([_core.peaks_of_sums(orders, each) for each in along], axis=-1)
        if what == "peak" and planar:
            return np.asarray(np.abs(self._planar[quantity][..., 2:]).sum(axis=-1))
        return phasors if what == "phasors" else np.asarray(np.abs(phasors))

    def _torque(self, quantity: str) -> NDArray[np.complex128]:
        return self._torques[..., int(quantity == "crank_torque")]
