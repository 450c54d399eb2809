"""Flywheels: the speed of a crank over a cycle, and the moment of inertia that keeps it even."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, cast

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.frames import Frames, Tabled
from crankpin._support.messages import suppressed
from crankpin._support.tables import Column, Table
from crankpin.analysis.request import engine_core
from crankpin.analysis.turning_moment import formula
from crankpin.analysis.waveform import Waveform, waveform
from crankpin.model import checks
from crankpin.model.cycle import Cycle
from crankpin.model.data import EngineData

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin.model.engine import Engine

Curve: TypeAlias = "Callable[[NDArray[np.float64]], ArrayLike] | tuple[ArrayLike, ArrayLike] | str"
"""Torque over crank angle: a function of degrees, angles and torques, or a formula."""
CURVE_HINT = "give a function of degrees, (angles in degrees, torques in N·m), or a formula"
TWO_TURNS = 720.0
"""Period of functions, degrees: that of whole and half orders."""
MOST_KNOTS = 100_000
"""Largest number of angles of a table, and of a load over the period of the drive."""
MOST_BENDS = 7201
"""Largest number of angles of a cycle that are edges of cells: every tenth of a degree. Closer ones
take seconds; half degrees sample them."""
EQUAL = 1e-9
"""Relative difference up to which a ratio of periods is whole."""
NEGLIGIBLE = 1e-9
"""Irregularity of an order, %, and its swing, degrees, below which it is rounding."""
APPROXIMATIONS = ("gas torque alone", "gas and inertia torque")
"""Textbooks' approximations, both with the mean moment of inertia."""


def flywheel(
    drive: Engine | Curve | None,
    rpm: float,
    *,
    inertia: float | None = None,
    irregularity: float | None = None,
    load_torque: Engine | Curve | Sequence[Engine | Curve] | None = None,
    period_deg: float | None = None,
) -> Flywheel:
    """Return the speed over a cycle with a flywheel, or the flywheel that keeps it even.

    The speed follows from the first integral of the equation of motion,
    ½J(θ)ω² = E₀ + ∫(T − T_load)dθ, exact for any fluctuation. Of an engine T is the torque of gas
    pressure and of its further loads, and J varies with the motion of pistons and rods: that is
    their inertia torque, which does not count in T a second time.

    Parameters
    ----------
    drive : Engine, callable, pair of array_like, str or None
        A fired engine (:meth:`Engine.with_cycle`), or one with periodic loads
        (:meth:`Engine.with_loads`); or a turning-moment diagram, the torque on the
        crank, N·m: a function of an array of crank angles in degrees, or a pair of angles, degrees,
        and torques, between which it is linear; or a formula, ``"5000 + 600 sin 2θ"``. None is a
        motor of even torque, the load's mean. An angle given twice is one where torque jumps.
        Angles over one or two turns, open or closed, are read as those of a :class:`Cycle`; those
        over another period end with the torque of their beginning.
    rpm : float
        Mean crank speed, rpm: turns over the time that they take.
    inertia : float, optional
        Moment of inertia of all that turns with the crank, kg·m². Crankshaft, flywheel, big ends of
        the rods and what is driven; without pistons, small ends and the rods' swing.
    irregularity : float, optional
        Irregularity to find the moment of inertia for, in place of ``inertia``: largest less
        smallest speed, over the mean speed.
    load_torque : Engine, callable, pair of array_like, str or sequence of these, optional
        Torque of the load over crank angle, as ``drive``, or of several loads; by default constant.
        At a constant mean speed its mean is that of the drive: only its variation about its mean
        counts. :func:`stroke_load` is that of a punch. An engine is a machine on the same crank,
        such as a compressor with its cycle, which takes the torque that it would give; its pistons
        and rods count in J.
    period_deg : float, optional
        Period of a turning-moment diagram, degrees; by default that of the angles, and 720 of a
        function.

    Returns
    -------
    Flywheel
        Speed over the cycle, rpm, moment of inertia and irregularity.

    Raises
    ------
    InputError
        If an argument is out of range, the engine has neither cycle nor load, both or neither of
        ``inertia`` and ``irregularity`` are given, or the crank would stop within the cycle.

    Warns
    -----
    UserWarning
        If the moment of inertia seems to be in another unit.

    Examples
    --------
    Khurmi and Gupta, Theory of Machines, example 16.12: 5000 + 600 sin 2θ N·m against
    5000 + 500 sin θ N·m, with 500 kg at a radius of gyration of 0.4 m, at 150 rpm:

    >>> import numpy as np
    >>> import crankpin as cp
    >>> wheel = cp.flywheel(
    ...     lambda deg: 5000 + 600 * np.sin(np.radians(2 * deg)),
    ...     load_torque=lambda deg: 5000 + 500 * np.sin(np.radians(deg)),
    ...     rpm=150,
    ...     inertia=500 * 0.4**2,
    ... )
    >>> round(wheel.energy, 3), round(100 * wheel.irregularity, 3)
    (1204.167, 6.161)
    >>> round(100 * wheel.approximations[0], 3)  # the book's, 1 % too low
    6.1

    A flywheel for an inline-4 with a computed cycle, and how far textbooks' approximations are off:

    >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    >>> i4 = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
    >>> wheel = cp.flywheel(i4, rpm=3000, irregularity=0.02)
    >>> round(wheel.inertia, 4), [f"{100 * error:+.0f} %" for error in wheel.errors]
    (0.0871, ['+93 %', '-1 %'])

    The moment of inertia that keeps the speed of a diagram within 1 %:

    >>> torque = lambda deg: 5000 + 600 * np.sin(np.radians(2 * deg))
    >>> round(cp.flywheel(torque, rpm=150, irregularity=0.01).inertia, 2)
    243.17
    """
    if isinstance(drive, Waveform):
        raise inputs.faulty(
            "drive",
            "= a waveform",
            "its crank torque contains the inertia torque, which would count twice beside the "
            "inertia of pistons and rods that varies; give the torque of the gas",
        )
    inputs.only_one_of(inertia=inertia, irregularity=irregularity)
    speed = inputs.number("rpm", rpm)
    engine = drive if isinstance(drive, EngineData) else None
    if engine is not None:
        if period_deg is not None:
            hint = "the period is that of the engine's cycle; leave it out"
            raise inputs.rejected("period_deg", period_deg, hint)
        torque = _of_engine("drive", engine, speed)
        checks.flywheel(engine._core, inputs.optional_number("inertia", inertia) or 0.0)
    else:
        torque = _even(period_deg) if drive is None else _diagram("drive", drive, period_deg)
    curves = [] if load_torque is None else _curves(load_torque)
    loads = [_of_load(curve, speed) for curve in curves]
    machines = [*filter(None, [engine]), *(one for one in curves if isinstance(one, EngineData))]
    if drive is None and not loads:
        raise inputs.rejected("load_torque", None, "give the load of a motor of even torque")
    periods = [against.period for against in loads if against.period]
    period = torque.period or (max(periods) if drive is None and periods else TWO_TURNS)
    knots = np.concatenate([torque.knots, *(_repeated(against, period) for against in loads)])
    grid = _core.CycleGrid(period, knots)
    nodes, edges = grid.nodes_deg, grid.edges_deg

    def of_loads(theta: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(sum((against.at(theta) for against in loads), np.zeros(theta.shape)))

    even = grid.mean(of_loads(nodes)) if drive is None else 0.0

    def of_drive(theta: NDArray[np.float64]) -> NDArray[np.float64]:
        return torque.at(theta) + even

    found = grid.speed(
        of_drive(nodes),
        of_loads(nodes),
        [machine._core for machine in machines],
        speed,
        inputs.optional_number("inertia", inertia),
        0.0 if irregularity is None else inputs.number("irregularity", irregularity),
    )
    lowest, highest = found["extremes"]
    of_one_rpm = _core.angular_speed(1.0)
    return Flywheel(
        engine,
        speed,
        found["inertia"],
        found["irregularity"],
        found["energy"],
        found["mean_torque"],
        found["acceleration"],
        lowest / of_one_rpm,
        highest / of_one_rpm,
        found["approximations"],
        edges,
        found["speed"] / of_one_rpm,
        of_drive(edges),
        of_loads(edges) if loads else np.full(edges.shape, found["mean_torque"]),
        found["inertia_torque"],
        found["moving_inertia"],
    )


class Flywheel(Tabled):
    """Speed of a crank over a cycle, with the moment of inertia that turns with it.

    ``plot`` draws torque over the cycle with its mean, and below it the speed, which stands alone
    on axes that were given. Made by :func:`crankpin.flywheel`.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> wheel = cp.flywheel(
    ...     lambda deg: 300 - 400 * np.cos(np.radians(2 * deg)), rpm=1500, inertia=2.0
    ... )
    >>> round(wheel.lowest_rpm, 2), round(wheel.highest_rpm, 2)
    (1493.93, 1506.09)
    """

    engine: Engine | None
    """The engine whose pistons and rods move; None for a turning-moment diagram."""
    rpm: float
    """Mean crank speed: turns over the time that they take."""
    inertia: float
    """Moment of inertia of all that turns with the crank, kg·m²."""
    irregularity: float
    """Largest less smallest speed, over the mean speed."""
    energy: float
    """Largest less smallest work of drive and load over the cycle, J: fluctuation of energy."""
    mean_torque: float
    """Mean torque of the drive, N·m."""
    acceleration: float
    """Largest angular acceleration, either way, at any crank angle, rad/s²."""
    lowest_rpm: float
    """Lowest speed, at any crank angle, rpm."""
    highest_rpm: float
    """Highest speed, at any crank angle, rpm."""
    approximations: tuple[float, float]
    """Irregularity from the mean moment of inertia: of the gas torque alone, and of gas and inertia
    torque together."""
    theta_deg: NDArray[np.float64]
    """Crank angles of one period, degrees: (n_theta,)."""
    speed_rpm: NDArray[np.float64]
    """Speed there, rpm."""
    torque: NDArray[np.float64]
    """Torque of the drive there, N·m; of an engine without that of inertia."""
    load_torque: NDArray[np.float64]
    """Torque of the load there, N·m."""
    inertia_torque: NDArray[np.float64]
    """Torque on the crank of the inertia of pistons and rods at the mean speed, N·m."""
    moving_inertia: NDArray[np.float64]
    """Moment of inertia of pistons and rods as seen from the crank, kg·m²."""

    def __post_init__(self) -> None:
        if self.engine is not None:
            engine_core(self.engine)
        figures = ("rpm", "inertia", "irregularity", "energy", "mean_torque", "acceleration")
        for name in (*figures, "lowest_rpm", "highest_rpm"):
            inputs.number(name, getattr(self, name))
        inputs.vector("approximations", self.approximations)
        curves = (
            "theta_deg",
            "speed_rpm",
            "torque",
            "load_torque",
            "inertia_torque",
            "moving_inertia",
        )
        if len({len(inputs.vector(name, getattr(self, name))) for name in curves}) != 1:
            raise inputs.faulty("theta_deg", "and curves differ in length", "use crankpin.flywheel")
        super().__post_init__()

    @property
    def errors(self) -> tuple[float, float]:
        """Relative errors of the approximations."""
        if self.irregularity == 0.0:
            return 0.0, 0.0  # all three are below the rounding of speeds
        first, second = (each / self.irregularity - 1.0 for each in self.approximations)
        return first, second

    @functools.cached_property
    def swing_deg(self) -> float:
        """Largest less smallest angle by which the crank leads one that turns evenly, degrees."""
        return _core.swing_deg(self.theta_deg, self.speed_rpm)

    def electrical_swing_deg(self, poles: int) -> float:
        """Return the swing of a generator on the crank in electrical degrees.

        Parameters
        ----------
        poles : int
            Number of poles, even; half of it times ``swing_deg`` is the swing. A limit of ±2.5
            electrical degrees is one of 5.

        Returns
        -------
        float
            Largest less smallest lead, electrical degrees.

        Raises
        ------
        InputError
            If the number is odd or below 2.
        """
        count = inputs.whole("poles", poles)
        if count < 2 or count % 2:
            raise inputs.rejected("poles", poles, "give an even number of poles, such as 4")
        return self.swing_deg * count / 2.0

    def irregularity_of(self, orders: Order | Iterable[Order]) -> NDArray[np.float64]:
        """Return the irregularity of each order of the speed alone.

        Parameters
        ----------
        orders : number or sequence of numbers
            Multiples of crank speed, whole or half, that come round in the period.

        Returns
        -------
        ndarray of float, shape (n_orders,)
            Largest less smallest speed of each order, over the mean speed.

        Raises
        ------
        InputError
            If an order does not come round in the period.
        """
        halves = [round(2 * order) for order in inputs.explicit_half_orders(orders)]
        return _core.irregularity_by_order(self.theta_deg, self.speed_rpm, self.rpm, halves)

    @property
    def table(self) -> Table:
        """Speed, inertia, energy and torque."""
        figures = (
            ("moment of inertia", self.inertia, "kg·m²"),
            ("irregularity", 100.0 * self.irregularity, "%"),
            ("lowest speed", self.lowest_rpm, "rpm"),
            ("highest speed", self.highest_rpm, "rpm"),
            ("fluctuation of energy", self.energy, "J"),
            ("mean torque", self.mean_torque, "N·m"),
            ("largest acceleration", self.acceleration, "rad/s²"),
            ("swing", self.swing_deg, "°"),
        )
        return Table._of_figures(self.title, figures, self.loads_counted)

    @property
    def frames(self) -> Frames:
        """``table``; ``approximations``: textbooks', and their errors; ``orders``: irregularity."""
        return self._frames(approximations=self._approximated, orders=self._by_order)

    def _by_order(self) -> Table:
        """Return irregularity and swing of the orders up to 6 that matter."""
        turns = float(self.theta_deg[-1] - self.theta_deg[0]) / 360.0
        orders = np.array([k / 2 for k in range(1, 13) if (k / 2 * turns) % 1.0 < EQUAL])
        uneven = self.irregularity_of(orders.tolist()) if orders.size else np.empty(0)
        # Those that the engine cancels are rounding.
        matter = uneven > max(NEGLIGIBLE * uneven.max(initial=0.0), EQUAL)
        orders, uneven = orders[matter], uneven[matter]
        columns = (
            Column("order", orders),
            Column("irregularity", 100.0 * uneven, "%"),
            Column("swing", np.degrees(uneven / orders), "°"),
        )
        title = "Irregularity and swing of each order alone"
        return Table(title, columns, loads=self.loads_counted)

    @property
    def loads_counted(self) -> str:
        """Gas pressure that drives the crank, in words; empty for a turning-moment diagram."""
        return "" if self.engine is None else self.engine.loads_counted

    def _approximated(self) -> Table:
        # Without pistons there is one.
        names: Sequence[str] = APPROXIMATIONS if self.engine is not None else ("torque",)
        if self.engine is not None and self.engine.loads:
            names = [name.replace("gas", "gas, loads", 1) for name in names]
        pairs = zip(names, self.approximations, self.errors, strict=False)
        return Table.from_rows(
            "Textbooks' irregularity, fluctuation of energy over mean inertia and speed squared",
            ["of", ("irregularity", "%"), ("error", "%")],
            [(name, 100.0 * value, 100.0 * error) for name, value, error in pairs],
            loads=self.loads_counted,
        )

    @property
    def title(self) -> str:
        """Title of table and picture."""
        name = "turning-moment diagram" if self.engine is None else labels.name_of(self.engine)
        return f"{labels.cut(name)}: speed over a cycle at {self.rpm:g} rpm"


# --- torque over crank angle ---------------------------------------------------------------------


class _Diagram(NamedTuple):
    at: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    """Torque at crank angles in degrees."""
    period: float | None
    """Period, degrees; None where any will do."""
    knots: NDArray[np.float64]
    """Angles at which it bends or jumps."""


def _of_load(load: object, rpm: float) -> _Diagram:
    """Return the torque that a load takes."""
    if not isinstance(load, EngineData):
        return _diagram("load_torque", load, None)
    giving = _of_engine("load_torque", cast("Engine", load), rpm)
    return giving._replace(at=lambda theta: -giving.at(theta))


def _of_engine(name: str, engine: Engine, rpm: float) -> _Diagram:
    """Return the torque of an engine's gas pressure and periodic loads on the crank."""
    if not (engine.fired or engine.loads):
        hint = "has no driving torque; give it gas pressure with engine.with_cycle(…)"
        raise inputs.rejected(name, labels.name_of(engine), hint)
    # Where pressure jumps or bends, at the firing of each cylinder.
    with suppressed():
        fired = [(start, Cycle._of(core)) for start, core in engine._core.face_cycles]
    cycle_deg = 180.0 * engine.strokes
    # Half orders of loads repeat after two turns.
    period = TWO_TURNS if engine.loads else cycle_deg
    bends = [
        start + turned + _bends(cycle)
        for start, cycle in fired
        for turned in np.arange(0.0, period, cycle_deg)
    ]

    def at(theta: NDArray[np.float64]) -> NDArray[np.float64]:
        whole = waveform(engine, rpm, theta_deg=theta)
        parts = [whole.read(f"crank_torque.{name}") for name in whole.causes if name != "inertia"]
        return np.asarray(sum(parts))

    return _Diagram(at, period, np.concatenate([*bends, []]))


def _even(period_deg: object) -> _Diagram:
    """Return no torque; rejects a period, which is that of the load."""
    if period_deg is not None:
        hint = "the period is that of the load; leave it out"
        raise inputs.rejected("period_deg", period_deg, hint)
    return _Diagram(np.zeros_like, None, np.empty(0))


def _curves(load: object) -> list[object]:
    """Return the loads: one, or those of a list."""
    if callable(load) or isinstance(load, (str, EngineData)):
        return [load]
    curves = inputs.items("load_torque", load, CURVE_HINT)

    def is_curve(item: Any) -> bool:  # noqa: ANN401 - whatever a list has
        pair = isinstance(item, (list, tuple)) and len(item) == 2
        return (
            callable(item)
            or isinstance(item, (str, EngineData))
            or (pair and all(np.ndim(i) for i in item))
        )

    return curves if curves and all(map(is_curve, curves)) else [load]


def _repeated(against: _Diagram, period: float) -> NDArray[np.float64]:
    """Return the knots of a load over the period of the drive; rejects periods that do not fit."""
    ratio = period / against.period if against.period else 0.0
    if ratio * len(against.knots) > MOST_KNOTS:
        fault = f"has {len(against.knots)} angles in {against.period:.10g}°, which is "
        fault += f"{ratio:.10g} times in {period:.10g}°"
        raise inputs.faulty("load_torque", fault, "give a longer period, or fewer angles")
    if abs(ratio - round(ratio)) > EQUAL * ratio:
        hint = f"give one of which {period:.10g}°, the whole period, is a multiple"
        raise inputs.faulty("load_torque", f"has a period of {against.period:.10g}°", hint)
    turns = np.arange(max(round(ratio), 1)) * (against.period or 0.0)
    return np.asarray(np.add.outer(turns, against.knots).ravel())


def _bends(cycle: Cycle) -> NDArray[np.float64]:
    """Return the angles at which pressure jumps or bends: all of a table that is not a fine one."""
    theta: NDArray[np.float64] = cycle.theta_deg
    if cycle.degree is None and len(theta) <= MOST_BENDS:
        return theta
    twice: NDArray[np.float64] = theta[1:][np.diff(theta) == 0.0]
    return twice


def _diagram(name: str, curve: object, period_deg: object) -> _Diagram:
    period = inputs.optional_number("period_deg", period_deg)
    if period is not None and not 0.0 < period < np.inf:
        raise inputs.rejected("period_deg", period, "give the period of the torque, such as 720")
    if isinstance(curve, str):
        return _Diagram(formula(name, curve), period, np.empty(0))
    if callable(curve):

        def of_function(theta: NDArray[np.float64]) -> NDArray[np.float64]:
            found = inputs.array(name, curve(theta.copy()))
            if found.shape not in ((), theta.shape):
                fault = f"returned values of shape {found.shape} for {theta.shape}"
                raise inputs.faulty(name, fault, "give one torque for each angle")
            return np.ascontiguousarray(np.broadcast_to(found, theta.shape))

        return _Diagram(of_function, period, np.empty(0))
    hint = CURVE_HINT
    pair = inputs.items(name, curve, hint)
    if len(pair) != 2:
        raise inputs.rejected(name, curve, hint)
    theta, torque = (inputs.vector(name, each) for each in pair)
    if len(theta) != len(torque) or len(theta) < 2:
        raise inputs.faulty(name, f"has {len(theta)} angles and {len(torque)} torques", hint)
    if len(theta) > MOST_KNOTS:
        raise inputs.faulty(name, f"has {len(theta)} angles", f"give at most {MOST_KNOTS}")
    span = float(theta[-1] - theta[0])
    period = _period(name, theta, torque) if period is None else period
    closed = _core.repeats_first(f"{name}[0]", theta, period)
    if closed is None:
        hint = f"the angles span {span:.10g}°, and no step of theirs is as wide as what is left"
        raise inputs.faulty(
            "period_deg", f"= {period:.10g}", f"{hint}; give angles over one period"
        )
    start = float(theta[0])
    end = start + period
    if closed:
        theta = np.where(theta == theta[-1], end, np.minimum(theta, end))
    else:
        theta, torque = np.append(theta, end), np.append(torque, torque[0])

    def of_table(where: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.interp((where - start) % period + start, theta, torque)

    return _Diagram(of_table, period, theta)


def _period(name: str, theta: NDArray[np.float64], torque: NDArray[np.float64]) -> float:
    """Return the period of a table: one or two turns, as of a cycle, or that of its own.

    A table of its own period repeats its first torque. One of few angles, such as a load in steps,
    does that on purpose: it does not go on to the end of a turn.
    """
    repeated = bool(torque[-1] == torque[0])
    few = len(theta) < _core.FEWEST_POINTS
    for turns in (TWO_TURNS / 2.0, TWO_TURNS):
        closed = _core.repeats_first(f"{name}[0]", theta, turns)
        if closed or (closed is False and not (few and repeated)):
            return turns
    span = float(theta[-1] - theta[0])
    if repeated and span > 0.0:
        return span
    fault = f"ends in {torque[-1]:.10g} N·m after {span:.10g}°"
    hint = "give angles over a whole period, the first torque repeated at its end"
    hint = f"that is neither a turn, nor two, nor the first torque again; {hint}"
    raise inputs.faulty(name, fault, hint)
