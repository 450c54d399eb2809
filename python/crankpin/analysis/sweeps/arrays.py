"""Arrays of a sweep, computed by the core when they are first read."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import progress as progress_bar
from crankpin._support.quantities import PLANE_VECTORS
from crankpin.analysis.request import Request, check_request, engine_core
from crankpin.analysis.source import ErrorBound, Source

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from crankpin._support.progress import Progress
    from crankpin.model.engine import Engine, Hold

AXES = ("bank_angle_deg", "rod_ratio", "pin_offset", "rpm")
"""Dimensions after "engine", in the order of results."""


class SweepArrays(Source):
    """Arrays of a sweep."""

    _fields: ClassVar[tuple[str, ...]] = ("engines", "names", "axes", "hold", "request")

    def __init__(
        self,
        engines: tuple[Engine, ...],
        names: tuple[str, ...] | None,
        axes: Mapping[str, Any],
        hold: str | None,
        request: Request,
        progress: Progress = False,
    ) -> None:
        check_request(request, "crankpin.sweep")
        swept = [name for name in AXES if isinstance(axes.get(name), np.ndarray)]
        by_name = {
            name: values if name in swept else np.array([values]) for name, values in axes.items()
        }
        core = _core.Sweep(
            [engine_core(engine) for engine in engines],
            by_name.get("bank_angle_deg"),
            hold,
            by_name.get("rod_ratio"),
            by_name.get("pin_offset"),
            by_name["rpm"],
            request.listed_orders,
            request.rtol,
            request.reference_z,
            request.listed_spectrum,
            request.torque,
            [names is not None, *(name in swept for name in AXES)],
        )
        self._set(
            engines=engines,
            names=names,
            hold=hold,
            request=request,
            orders=tuple(core.orders),
            omitted=tuple(core.omitted),
            dims=(*(["engine"] if names is not None else []), *swept),
            given=tuple(name for name in AXES if name in axes),
            core=core,
            progress=progress,
        )

    engines: tuple[Engine, ...]
    names: tuple[str, ...] | None
    hold: Hold | None
    omitted: tuple[int, ...]
    given: tuple[str, ...]
    """Arguments that were given, swept or not."""
    core: _core.Sweep
    """Compiled counterpart."""
    progress: Progress

    @property
    def axes(self) -> Mapping[str, NDArray[np.float64] | float]:
        """Values of each argument: an array where it is swept, else a number."""
        values = {name: self.core.axis(name) for name in self.given}
        return {
            name: axis if name in self.dims else float(axis[0]) for name, axis in values.items()
        }

    @cached_property
    def error_bound(self) -> ErrorBound:
        """Bounds on what the omitted orders add, at any point."""
        force, moment, torque = self.core.error_bound
        return ErrorBound(force, moment, torque if "torque" in self.request.quantities else None)

    def _turning(self, quantity: str) -> NDArray[np.complex128]:
        with progress_bar.shown(self.progress, f"{quantity}, forward and backward") as report:
            return self.core.turning(quantity, report)

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        with progress_bar.shown(self.progress, f"{quantity}, {what}") as report:
            if what == "phasors":
                return self.core.phasors(quantity, report)
            figures = {
                "peak": "length" if quantity in PLANE_VECTORS else "amplitude",
                "peak_xy": "amplitude",
                "total_peak": "length of sum" if quantity in PLANE_VECTORS else "sum",
                "total_peak_xy": "sum",
                "zero_bound": "zero bound",
            }
            return np.asarray(self.core.peaks(quantity, figures[what], report))
