"""Loads of piston rods over a turn: compression, tension and their reversal."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.quantities import ROD_LOADS
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine

USUAL_REVERSAL = 15.0
"""Least reversal that API 618 asks of a rod, degrees of a turn."""


def rod_loads(engine: Engine, rpm: float, theta_deg: ArrayLike | None = None) -> RodLoads:
    """Return the load of each piston rod at its crosshead pin, or of each piston at its wrist pin.

    The combined load along the bore is that of the gas on both faces of the piston and of the
    inertia of what is outboard of the pin, compression positive. Its maxima and its changes of sign
    are those of the whole cycle, at any crank angle. Where it never changes sign the pin's oil film
    is not renewed; API 618 asks for a reversal, usually of 15° at least.

    Parameters
    ----------
    engine : Engine
        The engine, with gas pressure (:meth:`Engine.with_cycle`) or inertia alone. Outboard of the
        pin is the ``piston_mass`` of a cylinder: piston, piston rod and crosshead; where it is not
        known the whole reciprocating mass.
    rpm : float
        Crank speed, rpm.
    theta_deg : array_like, shape (n_theta,), optional
        Crank angles of the curves, degrees; by default 0° to 360° in steps of one degree, of a
        four-stroke to 720°.

    Returns
    -------
    RodLoads
        Loads of each rod, N, and angles.

    Raises
    ------
    InputError
        If a figure cannot be used.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, or angles seem to be in radians.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(0.125, 0.625, 180, bore=0.3)
    >>> one = cp.Engine.inline(cylinder, throws_deg=[0], spacing=0.3, strokes=2)
    >>> ends = {
    ...     end: cp.Cycle.compressor(cylinder, suction=1e5, discharge=4e5, end=end)
    ...     for end in ("head", "crank")
    ... }
    >>> one = one.with_cycle(ends["head"], crank_end=ends["crank"], rod_diameter=0.06)
    >>> loads = cp.rod_loads(one, rpm=600)
    >>> f"{loads.compression[0]:.0f} N, {loads.tension[0]:.0f} N, {loads.reversal_deg[0]:.1f}°"
    '61141 N, 86293 N, 155.6°'
    """
    turns = engine_core(engine).strokes // 2
    default = np.arange(360.0 * turns + 1.0)
    theta = inputs.crank_angles(default if theta_deg is None else theta_deg)
    loads = RodLoads(engine, inputs.number("rpm", rpm), theta)
    inputs.warn_of_units(mean_piston_speed(engine, loads.rpm))
    return loads


class RodLoads(Labelled):
    """Loads of piston rods over crank angle, their maxima and reversals.

    Compression is positive. Made by :func:`crankpin.rod_loads`.
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    theta_deg: NDArray[np.float64]
    """Crank angles of the curves, degrees: (n_theta,)."""

    _along: ClassVar[tuple[str, ...]] = ("theta_deg",)
    _registry: ClassVar[Mapping[str, Kind]] = ROD_LOADS

    def __post_init__(self) -> None:
        engine, rpm = engine_core(self.engine), inputs.number("rpm", self.rpm)
        theta = inputs.copied(inputs.vector("theta_deg", self.theta_deg))
        model = _core.BearingLoadsModel(engine, rpm)
        curves = model.rod_load_curves(theta)
        self.__dict__.update(rpm=rpm, theta_deg=theta, _model=model, _curves=curves)
        super().__post_init__()

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.engine.loads_counted

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the crank angles."""
        return {"theta_deg": self.theta_deg}

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        return {"cylinder": np.arange(1, len(self.engine) + 1)}

    @cached_property
    def _figures(self) -> list[_core._RodFigures]:
        model: _core.BearingLoadsModel = self.__dict__["_model"]
        return model.rod_loads(180 * self.engine.strokes)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        if quantity == "compression":
            return np.maximum(self._range_of("load")[:, 1, 0], 0.0)
        if quantity == "tension":
            return np.maximum(-self._range_of("load")[:, 0, 0], 0.0)
        curves: dict[str, NDArray[np.float64]] = self.__dict__["_curves"]
        return curves[quantity]

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        if (
            what == "peak" and quantity in self.__dict__["_curves"]
        ):  # of the whole cycle, at any angle
            part = "load" if quantity == "rod_load" else quantity.removesuffix("_load")
            return np.asarray(np.abs(self._range_of(part)[:, :, 0]).max(axis=1))
        return super()._compute(quantity, what)

    @property
    def rod_load(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Load along each bore at the pin, compression positive, N: (n_cylinders, n_theta)."""
        return self._quantity("rod_load")

    @property
    def gas_load(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Part of the gas on both faces of the piston, N: (n_cylinders, n_theta)."""
        return self._quantity("gas_load")

    @property
    def inertia_load(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Part of the inertia of what is outboard of the pin, N: (n_cylinders, n_theta)."""
        return self._quantity("inertia_load")

    def _range_of(self, part: str) -> NDArray[np.float64]:
        """Return largest tension and compression, each with its angle: (n_cylinders, 2, 2)."""
        return np.array([figures[part] for figures in self._figures])  # type: ignore[literal-required]

    @property
    def compression(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Largest compression of each rod, N: (n_cylinders,); zero where there is none."""
        return self._quantity("compression")

    @property
    def tension(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Largest tension of each rod, N, above zero: (n_cylinders,); zero where there is none."""
        return self._quantity("tension")

    @property
    def compression_deg(self) -> NDArray[np.float64]:
        """Crank angles at which rods have the largest load, degrees: (n_cylinders,)."""
        return read_only(self._range_of("load")[:, 1, 1])

    @property
    def tension_deg(self) -> NDArray[np.float64]:
        """Crank angles at which rods have the least load, degrees: (n_cylinders,)."""
        return read_only(self._range_of("load")[:, 0, 1])

    @property
    def tension_ranges_deg(self) -> tuple[tuple[tuple[float, float], ...], ...]:
        """Ranges of crank angles in which each rod is in tension: from and to, degrees."""
        return tuple(tuple(figures["tension_deg"]) for figures in self._figures)

    @property
    def reversal_deg(self) -> NDArray[np.float64]:
        """Longest angle in which the load has the sign that it has for less of the cycle, degrees.

        Of shape (n_cylinders,): zero where it never changes sign.
        """
        longest = (max((to - begin for begin, to in arcs), default=0.0) for arcs in self._reversals)
        return read_only(np.array([*longest]))

    @property
    def _reversals(self) -> list[list[tuple[float, float]]]:
        """Ranges of angles in which each rod has the sign that it has for less of the cycle."""
        cycle = 180.0 * self.engine.strokes
        return [lesser_ranges(arcs, cycle) for arcs in self.tension_ranges_deg]

    @property
    def table(self) -> Table:
        """Largest loads of each rod, its parts and its reversal."""
        where = f"{labels.name_of(self.engine)} at {self.rpm:g} rpm"
        gas, inertia = self._range_of("gas"), self._range_of("inertia")
        outboard = [one.piston_mass for one in self.engine.cylinders]
        known = [
            one.reciprocating_mass if mass is None else mass
            for one, mass in zip(self.engine.cylinders, outboard, strict=True)
        ]
        columns: dict[str, tuple[NDArray[np.float64], str]] = {
            "compression": (self.read("compression"), "N"),
            "most at": (self.compression_deg, "°"),
            "tension": (self.read("tension"), "N"),
            "least at": (self.tension_deg, "°"),
            "reversal": (self.reversal_deg, "°"),
            "gas from": (gas[:, 0, 0], "N"),
            "gas to": (gas[:, 1, 0], "N"),
            "inertia from": (inertia[:, 0, 0], "N"),
            "inertia to": (inertia[:, 1, 0], "N"),
            "outboard": (np.array(known), "kg"),
        }
        return Table(
            f"{where}: rod loads at the crosshead pin, compression positive",
            (
                Column("cylinder", tuple(range(1, len(known) + 1))),
                *(Column(name, values, unit) for name, (values, unit) in columns.items()),
            ),
            loads=self.loads_counted,
        )


def lesser_ranges(
    tension: tuple[tuple[float, float], ...], cycle_deg: float
) -> list[tuple[float, float]]:
    """Return the ranges of the sign that a load has for less of a cycle, degrees.

    Parameters
    ----------
    tension
        Ranges in which it is tension.
    cycle_deg
        The cycle.
    """
    if not tension:
        return []
    following = [*tension[1:], (tension[0][0] + cycle_deg, 0.0)]
    others = [(to, after) for (_, to), (after, _) in zip(tension, following, strict=True)]
    both = [[(begin, to) for begin, to in arcs if to > begin] for arcs in (tension, others)]
    return min(both, key=lambda arcs: sum(to - begin for begin, to in arcs))
