"""Bearing loads and irregularity over speed and load of an engine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.drawing import draw
from crankpin._support.frames import Tabled
from crankpin._support.parameters import documented
from crankpin._support.quantities import LOADS
from crankpin._support.tables import Column, Table
from crankpin._support.warnings import suppressed
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.bearings import BearingLoads, bearing_loads
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.request import engine_core
from crankpin.analysis.sweeps.gas import GasMap
from crankpin.model import checks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.cycle_map import CycleMap
    from crankpin.model.engine import Engine


def operating_map(
    engine: Engine,
    rpm: ArrayLike,
    *,
    cycle: CycleMap | Sequence[CycleMap | None] | None = None,
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
    >>> (found.peak("main").max(axis=-1) / 1e3).round(1)  # kN, by speed and load
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
        inputs.only_with("cycle", load=load, crankcase=crankcase)
        gas, points = None, np.zeros(1)
    else:
        gas = GasMap.checked(cycle, [engine], crankcase)
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
                    of_point = loads.peak(name)
                    peaks.setdefault(name, np.zeros((*shape, len(of_point))))[j, k] = of_point
                if inertia is not None:
                    found = flywheel(fired, speed, inertia=inertia)
                    wheel[:, j, k] = found.irregularity, found.swing_deg
    inputs.warn_of_units(mean_piston_speed(engine, float(np.abs(speeds).max())))
    checks.flywheel(engine._core, inputs.optional_number("inertia", inertia) or 0.0)
    uneven, swing = (None, None) if inertia is None else wheel
    load_axis = None if gas is None else points
    return OperatingMap(
        engine,
        speeds,
        load_axis,
        peaks,
        None if uneven is None else uneven.copy(),
        None if swing is None else swing.copy(),
        engine.loads_counted if gas is None else gas.loads_counted([engine], [""]),
    )


class OperatingMap(Tabled):
    """Largest bearing loads, and irregularity, over speed and load.

    Made by :func:`crankpin.operating_map`.
    """

    engine: Engine
    """The engine."""
    rpm: NDArray[np.float64]
    """Crank speeds, rpm: (n_rpm,)."""
    load: NDArray[np.float64] | None
    """Loads: (n_load,); None where the engine has its own pressure."""
    peaks: Mapping[str, NDArray[np.float64]]
    """Largest loads by name, N: (n_rpm, n_load, n) each."""
    irregularity: NDArray[np.float64] | None
    """Largest less smallest speed over the mean speed: (n_rpm, n_load); None without inertia."""
    swing_deg: NDArray[np.float64] | None
    """Largest less smallest lead over an even rotation, degrees: (n_rpm, n_load); or None."""
    gas: str
    """Gas pressure that counts, in words."""

    def __post_init__(self) -> None:
        engine_core(self.engine)
        inputs.vector("rpm", self.rpm)
        if not isinstance(self.peaks, Mapping) or list(self.peaks) != list(LOADS):
            raise inputs.rejected("peaks", self.peaks, "use crankpin.operating_map")
        super().__post_init__()

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.gas

    @documented(BearingLoads.read)
    def peak(self, load: str) -> NDArray[np.float64]:
        """Return the largest magnitude of a load at each point, N: (n_rpm, n_load, n).

        Returns
        -------
        ndarray of float, shape (n_rpm, n_load, n)
            Largest magnitudes, N.

        Raises
        ------
        InputError
            If there is no such load.
        """
        return self.peaks[inputs.one_of("load", load, LOADS)]

    def plot(
        self,
        ax: Axes | None = None,
        *,
        quantity: Literal[
            "main",
            "crankpin",
            "wrist_pin",
            "side_thrust",
            "rod_force",
            "gas_force",
            "irregularity",
            "swing_deg",
        ] = "main",
        **style: object,
    ) -> Axes:
        """Draw a quantity over speed and load; return the axes.

        A map, or a curve where there is one load or one speed.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; by default new ones.
        quantity : str, default "main"
            A load of :meth:`peak`, the largest of all bearings or cylinders, or
            ``"irregularity"`` or ``"swing_deg"``.
        **style : dict, optional
            Properties of ``pcolormesh``, such as ``cmap``; of a curve ``label`` and properties of
            matplotlib lines.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        InputError
            If there is no such quantity, or none without ``inertia``.
        ImportError
            If matplotlib is not installed.

        Examples
        --------
        >>> import crankpin as cp
        >>> ax = cp.operating_map(cp.Engine.preset("i4"), range(1000, 7000, 500)).plot()
        """
        return draw(self, ax, quantity=quantity, **style)  # type: ignore[no-any-return]

    @property
    def table(self) -> Table:
        """Largest of all bearings' loads, irregularity and swing by speed and load."""
        count = (len(self.rpm), 1 if self.load is None else len(self.load))
        columns = [Column("speed", np.repeat(self.rpm, count[1]), "rpm")]
        if self.load is not None:
            columns.append(Column("load", np.tile(self.load, count[0])))
        for name, each in self.peaks.items():
            columns.append(Column(name.replace("_", " "), each.max(axis=-1), "N"))
        for name, unit, values, scale in (
            ("irregularity", "%", self.irregularity, 100.0),
            ("swing", "°", self.swing_deg, 1.0),
        ):
            if values is not None:
                columns.append(Column(name, scale * values, unit))
        title = f"OperatingMap of {labels.name_of(self.engine)}: largest load of any bearing"
        return Table(title, tuple(columns), loads=self.loads_counted)
