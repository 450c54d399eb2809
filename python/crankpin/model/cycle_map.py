"""Cycles over speed and load."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._core import ATMOSPHERE
from crankpin._support import inputs
from crankpin._support.frames import Tabled
from crankpin._support.messages import suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import Input, read_only
from crankpin._support.tables import Table
from crankpin.model.cycle import Cycle

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.cylinder import Cylinder


class CycleMap(Tabled, Input):
    """Cycles at speeds and loads, and linear interpolation of pressure between them.

    Parameters
    ----------
    rpm : array_like, shape (n_rpm,)
        Crank speeds of the cycles, rpm, ascending.
    load : array_like, shape (n_load,)
        Loads of the cycles, ascending, in any unit, such as 0 to 1 or imep.
    cycles : sequence of sequence of Cycle
        Cycles of one period: a row for each speed, a cycle in it for each load.

    Raises
    ------
    InputError
        If speeds or loads are not ascending, or there is not one cycle for each pair.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> cycles = [
    ...     [cp.Cycle.wiebe(cylinder, compression_ratio=10, heat=heat) for heat in (300, 1200)]
    ... ]
    >>> half = cp.CycleMap([3000], [0, 1], cycles).cycle_at(rpm=3000, load=0.5)
    >>> round((half.imep(cylinder) - cycles[0][0].imep(cylinder)) / 1e5, 3)
    4.587
    """

    rpm: NDArray[np.float64]
    """Crank speeds: (n_rpm,)."""
    load: NDArray[np.float64]
    """Loads: (n_load,)."""
    cycles: tuple[tuple[Cycle, ...], ...]
    """Cycles, by speed and load."""

    def __init__(self, rpm: ArrayLike, load: ArrayLike, cycles: Iterable[Iterable[Cycle]]) -> None:
        for name, values in (("rpm", rpm), ("load", load)):
            axis = inputs.vector(name, values).copy()
            if not axis.size or not np.isfinite(axis).all() or (np.diff(axis) <= 0.0).any():
                raise inputs.rejected(name, axis, "give ascending numbers")
            object.__setattr__(self, name, read_only(axis))
        hint = "give a list for each speed, of a crankpin.Cycle for each load"
        rows = tuple(
            tuple(inputs.items(f"cycles[{k}]", row, hint))
            for k, row in enumerate(inputs.items("cycles", cycles, hint))
        )
        if len(rows) != len(self.rpm) or {*map(len, rows)} != {len(self.load)}:
            shape = f"{len(self.rpm)} speeds and {len(self.load)} loads"
            raise inputs.rejected("cycles", [len(row) for row in rows], f"for {shape} {hint}")
        for entry in (cycle for row in rows for cycle in row):
            if not isinstance(entry, Cycle):
                raise inputs.rejected("cycles", entry, f"is not a Cycle; {hint}")
            if entry.strokes != rows[0][0].strokes:
                raise inputs.faulty("cycles", "have 2 and 4 strokes", "give cycles of one period")
        object.__setattr__(self, "cycles", rows)

    @cached_property
    def _cores(self) -> list[_core.Cycle]:
        """Compiled counterparts of the cycles, load by load of one speed after the other."""
        return [cycle._core for row in self.cycles for cycle in row]

    def cycle_at(self, *, rpm: float, load: float) -> Cycle:
        """Return the cycle at a speed and a load.

        Parameters
        ----------
        rpm : float
            Crank speed, rpm, within the map: nothing is extrapolated.
        load : float
            Load, within the map.

        Returns
        -------
        Cycle
            The cycle, interpolated.

        Raises
        ------
        InputError
            If the point is outside the map.
        """
        rpm, load = inputs.number("rpm", rpm), inputs.number("load", load)
        by_speed, by_load = _weights("rpm", self.rpm, rpm), _weights("load", self.load, load)
        parts = [
            (float(w * v), self.cycles[k][j]._core)
            for k, w in enumerate(by_speed)
            for j, v in enumerate(by_load)
            if w * v
        ]
        (_, core), *others = parts
        if others:
            core = _core.Cycle.blend(parts, f"{rpm:.10g} rpm, load {load:.10g}")
        with suppressed():  # Warned of where they were given.
            return Cycle._of(core)

    @documented(Cycle.torque_harmonics)
    def torque_harmonics(
        self,
        cylinder: Cylinder,
        orders: Order | Iterable[Order],
        *,
        rpm: ArrayLike,
        load: ArrayLike,
        crankcase: float = ATMOSPHERE,
    ) -> NDArray[np.complex128]:
        """Return the peak phasors of the torque on the crank at many speeds and loads, N·m.

        Those of the cycles that :meth:`at` returns: harmonics are linear in pressure.

        Parameters
        ----------
        rpm, load : array_like
            Speeds and loads within the map, of shapes that broadcast.

        Returns
        -------
        ndarray of complex, shape (..., n_orders)
            Peak phasors, N·m, of the shape of the points.

        Raises
        ------
        InputError
            If a point is outside the map, the cylinder has no bore, or an argument is out of
            range.
        """
        of_nodes = np.array(
            [
                [cycle.torque_harmonics(cylinder, orders, crankcase=crankcase) for cycle in row]
                for row in self.cycles
            ]
        )
        by_speed = _weights("rpm", self.rpm, inputs.array("rpm", rpm))
        by_load = _weights("load", self.load, inputs.array("load", load))
        try:
            weights = by_speed[..., :, np.newaxis] * by_load[..., np.newaxis, :]
        except ValueError:
            shapes = f"{np.shape(rpm)} and load {np.shape(load)}"
            raise inputs.faulty(
                "rpm", f"has shape {shapes}", "give shapes that broadcast"
            ) from None
        phasors: NDArray[np.complex128] = np.tensordot(weights, of_nodes, 2)
        return phasors

    @property
    def table(self) -> Table:
        """Peak pressure by speed and load."""
        rows = [
            (speed, load, float(cycle.pressure.max()), cycle.name)
            for speed, row in zip(self.rpm.tolist(), self.cycles, strict=True)
            for load, cycle in zip(self.load.tolist(), row, strict=True)
        ]
        heads = (("speed", "rpm"), "load", ("peak pressure", "Pa"), "cycle")
        return Table.from_rows("CycleMap over speed and load", heads, rows)


def _weights(
    name: str, axis: NDArray[np.float64], at: float | NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the weight of each value of an axis in linear interpolation: (…, n)."""
    values = np.asarray(at, dtype=np.float64)
    lower, share = _core.places_on_axis(name, axis, values.ravel())
    weights = np.zeros((values.size, len(axis)))
    rows = np.arange(values.size)
    weights[rows, np.minimum(lower + 1, len(axis) - 1)] = share
    weights[rows, lower] = 1.0 - share
    by_node: NDArray[np.float64] = weights.reshape(*values.shape, len(axis))
    return by_node
