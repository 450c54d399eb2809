"""Bearing loads and irregularity over speed and load of an engine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.messages import suppressed
from crankpin._support.quantities import LOADS, OF_POINTS
from crankpin._support.record import AbsentError
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.bearings import InsideLoads, bearing_loads
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core
from crankpin.analysis.sweeps.gas import GasMap
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.cycle_map import CycleMap
    from crankpin.model.engine import Engine


OF_WHEEL = {"irregularity": (100.0, "%"), "swing_deg": (1.0, "°")}
"""Quantity of the flywheel → how it is shown: factor and unit."""
OF_NUMBERS = {"cylinder": "crankpin", "main_bearing": "main"}
"""Dimension of numbers from 1 → a load that has it."""


def operating_map(
    engine: Engine,
    rpm: ArrayLike,
    *,
    cycle: CycleMap | Sequence[CycleMap | None] | None = None,
    crank_end: CycleMap | Sequence[CycleMap | None] | None = None,
    load: ArrayLike | None = None,
    inertia: float | None = None,
    crankcase: float | None = None,
) -> OperatingMap:
    """Compute the largest bearing loads, and the irregularity, at speeds and loads of an engine.

    Parameters
    ----------
    engine : Engine
        The engine, fired or not.
    rpm : float or array_like, shape (n_rpm,)
        Crank speeds, rpm.
    cycle : CycleMap or sequence of CycleMap, optional
        Cycles over speed and load, of all cylinders or of each, as of :func:`sweep`; by default the
        engine's own pressure at every speed.
    crank_end : CycleMap or sequence of CycleMap or None, optional
        The same of the crank ends that the engine has.
    load : float or array_like, shape (n_load,), optional
        Loads within ``cycle``.
    inertia : float, optional
        Moment of inertia of all that turns with the crank, kg·m², as of :func:`flywheel`, for
        irregularity and swing.
    crankcase : float, optional
        Absolute pressure below the pistons, Pa, with ``cycle``; by default the engine's.

    Returns
    -------
    OperatingMap
        Largest loads, at any crank angle, and irregularity.

    Raises
    ------
    InputError
        If a point is outside the map, an argument is missing or out of range, or the engine is not
        fired where ``inertia`` is given.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, or the inertia seems to be in another unit.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> i4 = cp.Engine.preset("i4", cylinder=cylinder)
    >>> cycles = [[cp.Cycle.example(load=load) for load in (0, 1)]] * 2
    >>> gas = cp.CycleMap([1000, 4000], [0, 1], cycles)  # the same at all speeds
    >>> found = cp.operating_map(i4, [1000, 4000], cycle=gas, load=[0, 1], inertia=0.15)
    >>> (found.main.max(axis=-1) / 1e3).round(1)  # kN, by speed and load
    array([[ 2.6, 18.6],
           [ 4. , 17.7]])
    >>> (100 * found.irregularity).round(2)  # %
    array([[ 2.11, 19.64],
           [ 1.04,  0.32]])
    """
    engine_core(engine)
    speeds = inputs.vector("rpm", rpm).copy()
    if not len(speeds):
        raise inputs.rejected("rpm", rpm, "give a crank speed, or several")
    if cycle is None:
        inputs.only_with("cycle", crank_end=crank_end, load=load, crankcase=crankcase)
        gas, points = None, np.zeros(1)
    else:
        gas = GasMap.checked(cycle, crank_end, [engine], crankcase)
        gas.places(None if load is None else inputs.vector("load", load))
        points = inputs.vector("load", load).copy()  # type: ignore[arg-type] # checked before
        if not len(points):
            raise inputs.rejected("load", load, "give a part of full load, or several")
    shape = (len(speeds), len(points))
    peaks: dict[str, NDArray[np.float64]] = {}
    wheel = np.zeros((2, *shape))
    for j, speed in enumerate(speeds.tolist()):
        for k, part in enumerate(points.tolist()):
            fired = engine if gas is None else gas.at(engine, speed, part)
            with suppressed():  # Warned of once, below.
                loads = bearing_loads(fired, speed)
                for name in LOADS:
                    of_point = loads.read(name, "peak")
                    peaks.setdefault(name, np.zeros((*shape, len(of_point))))[j, k] = of_point
                if inertia is not None:
                    result = flywheel(fired, speed, inertia=inertia)
                    wheel[:, j, k] = result.irregularity, result.swing_deg
    inputs.warn_of_units(mean_piston_speed(engine, float(np.abs(speeds).max())))
    checks.flywheel(engine._core, inputs.optional_number("inertia", inertia) or 0.0)
    arrays = peaks | ({} if inertia is None else dict(zip(OF_WHEEL, wheel.copy(), strict=True)))
    if gas is None:
        arrays = {name: values[:, 0] for name, values in arrays.items()}
    return OperatingMap(
        engine,
        speeds,
        None if gas is None else points,
        arrays,
        engine.loads_counted if gas is None else gas.loads_counted([engine], [""]),
    )


class OperatingMap(InsideLoads, Labelled):
    """Largest bearing loads, and irregularity, over speed and load.

    Made by :func:`crankpin.operating_map`.
    """

    engine: Engine
    """The engine."""
    rpm: NDArray[np.float64]
    """Crank speeds, rpm: (n_rpm,)."""
    load: NDArray[np.float64] | None
    """Loads: (n_load,); None where the engine has its own pressure."""
    arrays: Mapping[str, NDArray[np.float64]]
    """Values of the quantities by name: (n_rpm, n_load, …); without cycles (n_rpm, …)."""
    gas: str
    """Gas pressure that counts, in words."""

    _registry: ClassVar[Mapping[str, Kind]] = OF_POINTS

    def __post_init__(self) -> None:
        engine_core(self.engine)
        inputs.vector("rpm", self.rpm)
        if not isinstance(self.arrays, Mapping) or list(self.arrays)[: len(LOADS)] != list(LOADS):
            raise inputs.rejected("arrays", self.arrays, "use crankpin.operating_map")
        super().__post_init__()

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.gas

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: speeds and, with cycles over load, loads."""
        return {"rpm": self.rpm} | ({} if self.load is None else {"load": self.load})

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        counts = {name: self.arrays[of].shape[-1] for name, of in OF_NUMBERS.items()}
        return {name: np.arange(1, count + 1) for name, count in counts.items()}

    @property
    def _names(self) -> tuple[str, ...]:
        return tuple(self.arrays)

    def _check(self, quantity: str) -> None:
        if quantity in OF_WHEEL and quantity not in self.arrays:
            hint = "give operating_map the inertia of all that turns"
            raise inputs.faulty(quantity, "is not available", hint, AbsentError)
        super()._check(quantity)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        return self.arrays[quantity]

    @property
    def irregularity(self) -> Quantity[np.float64]:
        """Largest less smallest speed over the mean speed: (n_rpm, n_load).

        An AttributeError without ``inertia``.
        """
        return self._quantity("irregularity")

    @property
    def swing_deg(self) -> Quantity[np.float64]:
        """Largest less smallest lead over an even rotation, degrees: (n_rpm, n_load).

        An AttributeError without ``inertia``.
        """
        return self._quantity("swing_deg")

    @property
    def table(self) -> Table:
        """Largest of all bearings' loads, irregularity and swing by speed and load."""
        count = (len(self.rpm), 1 if self.load is None else len(self.load))
        columns = [Column("speed", np.repeat(self.rpm, count[1]), "rpm")]
        if self.load is not None:
            columns.append(Column("load", np.tile(self.load, count[0])))
        columns += [
            Column(name.replace("_", " "), self.arrays[name].max(axis=-1), "N") for name in LOADS
        ]
        for name, (scale, unit) in OF_WHEEL.items():
            if name in self.arrays:
                head = name.removesuffix("_deg")
                columns.append(Column(head, scale * self.arrays[name], unit))
        title = f"OperatingMap of {labels.name_of(self.engine)}: largest load of any bearing"
        return Table(title, tuple(columns), loads=self.loads_counted)
