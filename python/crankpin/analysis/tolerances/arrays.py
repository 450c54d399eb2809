"""Arrays of an engine's samples: deviations drawn by NumPy, evaluated by the core."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import progress as progress_bar
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.record import Record
from crankpin.analysis.balance import Balance
from crankpin.analysis.by_order import ByOrder, ErrorBound
from crankpin.analysis.request import engine_core
from crankpin.analysis.tolerances.spreads import FIGURES, OF_PINS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress
    from crankpin.analysis.request import Request
    from crankpin.analysis.tolerances.spreads import Spreads
    from crankpin.model.engine import Engine


PIECE = 2**20
"""Random numbers drawn between two looks at Ctrl-C."""


def deviations(spreads: Spreads, samples: int, seed: int) -> dict[str, NDArray[np.float64]]:
    """Return the deviations of each figure: (n_samples, n_items), empty where it does not spread.

    Each figure has a generator of its own, spawned from the seed, that draws sample after sample:
    a sample does not depend on how many follow, nor on what else spreads.
    """
    found = {}
    for stream, (name, each) in enumerate(zip(FIGURES, spreads.values, strict=True)):
        random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(stream,)))
        values = np.empty((samples if each else 0, len(each)))
        rows = PIECE // max(len(each), 1)
        for start in range(0, len(values), rows):
            piece = values[start : start + rows]
            if spreads.distribution == "normal":
                random.standard_normal(out=piece)
            else:
                random.random(out=piece)
                piece *= 2.0
                piece -= 1.0
            piece *= each
        values.setflags(write=False)
        found[name] = values
    return found


class ToleranceArrays(ByOrder, Record):
    """Arrays of samples: dimension ``sample``, then orders."""

    engine: Engine
    rpm: float
    spreads: Spreads
    samples: int
    seed: int
    request: Request
    bound: ErrorBound
    """Bounds on what omitted orders add to the nominal engine."""

    @cached_property
    def core(self) -> _core.Tolerances:
        """Compiled counterpart."""
        return _core.Tolerances(
            engine_core(self.engine),
            self.rpm,
            list(self.orders),
            self.request.reference_z,
            self.request.torque,
            self.spreads.values,
            self.spreads.distribution,
            self.spreads.pin_of,
            self.samples,
        )

    @cached_property
    def deviations(self) -> dict[str, NDArray[np.float64]]:
        """Figure → its deviations: (n_samples, n_items); empty where it does not spread."""
        return deviations(self.spreads, self.samples, self.seed)

    def draw(self, progress: Progress) -> None:
        """Evaluate the samples now."""
        core, drawn = self.core, list(self.deviations.values())
        with progress_bar.shown(progress, "tolerances") as report:
            force, moment, torques, peaks = core.sample(self.samples, drawn, report)
        vars(self)["_drawn"] = {"force": force, "moment": moment}, torques, peaks

    @cached_property
    def _drawn(
        self,
    ) -> tuple[dict[str, NDArray[np.complex128]], NDArray[np.complex128], NDArray[np.float64]]:
        """Force and moment, both torques, and peaks of all orders together."""
        self.draw(progress=False)
        return vars(self)["_drawn"]  # type: ignore[no-any-return]

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self.request.orders or ()

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

    def spread_out(self, figure: str) -> NDArray[np.float64]:
        """Return the deviations of a figure, zero where it does not spread."""
        drawn = self.deviations[figure]
        items = len(self.spreads.pins) if figure in OF_PINS else len(self.engine)
        return drawn if drawn.size else np.broadcast_to(0.0, (self.samples, items))

    def only(self, name: str) -> ToleranceArrays:
        """Return the same samples with one figure alone deviating."""
        return self.replace(spreads=self.spreads.only(name))

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        planar = quantity in PLANE_VECTORS
        vectors, torques, peaks = self._drawn
        if what in ("forward", "backward"):
            return vectors[quantity][..., 2 + int(what == "backward")]
        if what == "zero_bound":
            bound = self.nominal.read(quantity, what)
            return np.broadcast_to(bound, (self.samples, *bound.shape))
        if what == "total_peak":
            return peaks[:, tuple(QUANTITIES).index(quantity)]
        phasors = (
            vectors[quantity][..., :2] if planar else torques[..., int(quantity == "crank_torque")]
        )
        if what == "total_peak_xy":
            orders = list(self.orders)
            along = [np.ascontiguousarray(phasors[..., axis]) for axis in (0, 1)]
            return np.stack([_core.peaks_of_sums(orders, each, 0.0) for each in along], axis=-1)
        if what == "peak" and planar:
            return np.asarray(np.abs(vectors[quantity][..., 2:]).sum(axis=-1))
        return phasors if what == "phasors" else np.asarray(np.abs(phasors))
