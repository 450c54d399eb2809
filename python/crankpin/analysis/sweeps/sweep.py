"""Sweeps over engines, bank angle, rod ratio, pin offset, speed and load."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support import progress as progress_bar
from crankpin._support.messages import Hint
from crankpin._support.parameters import documented
from crankpin._support.quantities import QUANTITIES, kind_of
from crankpin._support.record import changed, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis import export
from crankpin.analysis.balance import Balance
from crankpin.analysis.by_order import ByOrder
from crankpin.analysis.export import VALUES
from crankpin.analysis.request import ENGINE_HINT, Request, check_request, engine_core
from crankpin.analysis.sweeps import dask
from crankpin.analysis.sweeps.gas import GasMap
from crankpin.analysis.sweeps.waveform import SweepWaveform
from crankpin.model import checks
from crankpin.model.cylinder import rod_length
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin._support.progress import Progress
    from crankpin.analysis.sweeps.dask import Chunks
    from crankpin.model.cycle_map import CycleMap
    from crankpin.model.engine import Hold

SWEEP_DIMS = ("bank_angle_deg", "rod_ratio", "pin_offset", "rpm", "load")
"""Dimensions after "engine", in the order of results."""
MOST_POINTS_SHOWN = 1000
"""Points of a sweep whose values are shown: more would take long to compute at a prompt."""

Engines: TypeAlias = Engine | Iterable[Engine] | Mapping[str, Engine]


@documented()
def sweep(
    engines: Engines,
    rpm: ArrayLike,
    *,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    rod_ratio: ArrayLike | None = None,
    pin_offset: ArrayLike | None = None,
    load: ArrayLike | None = None,
    cycle: CycleMap | Sequence[CycleMap | None] | None = None,
    crank_end: CycleMap | Sequence[CycleMap | None] | None = None,
    crankcase: float | None = None,
    orders: Orders = "auto",
    rtol: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
    progress: Progress = False,
) -> Sweep:
    """Return the balance of engines at every combination of the swept arguments.

    Crank angle is not sampled: each point is a layout sum times a harmonic. Every array argument is
    a dimension of the result; a scalar is not. Values are computed when they are first read. Of
    engines with cycles (:meth:`Engine.with_cycle`) torques include that of gas pressure, which does
    not depend on speed; with ``cycle`` it is that of a map's cycle at each speed and load.

    Parameters
    ----------
    engines : Engine, sequence of Engine or mapping of str to Engine
        An engine, several, or a mapping name → engine.
    rpm : array_like
        Crank speeds, rpm.
    bank_angle_deg : array_like, optional
        Angles between the two banks, degrees, 0 to 180; by default each engine's own.
    hold : {"pins", "firing"}, optional
        Quantity that a change of bank angle does not change; required with ``bank_angle_deg``:
        ``"pins"`` (the crank; firing intervals change) or ``"firing"`` (every top dead centre; pins
        are split as needed).
    rod_ratio : array_like, optional
        Crank radius / rod length; the radius stays, the rod changes. By default that of every
        cylinder.
    pin_offset : array_like, optional
        Pin offset of every cylinder, m; by default its own.
    load : array_like, optional
        Loads at which ``cycle`` is read, in its unit; required with ``cycle``.
    cycle : CycleMap or sequence of CycleMap or None, optional
        Cycles over speed and load, for all cylinders, or for each a map of the same speeds and
        loads, None for a cylinder without gas load. They replace those of the engines. Harmonics
        are linear in pressure: those of the map's own cycles are computed once, and interpolated.
    crank_end : CycleMap or sequence of CycleMap or None, optional
        The same of the crank ends that the engines have; required with ``cycle`` where they have
        some. The diameters of their piston rods stay.
    crankcase : float, optional
        Absolute pressure below the pistons, Pa, with ``cycle``; by default that of each engine, or
        of the atmosphere. Without ``cycle`` an engine has its own (:meth:`Engine.with_cycle`).
    orders : number, sequence of numbers or "auto", default "auto"
        Multiples of crank speed, or ``"auto"`` for the fewest that reach ``rtol`` at every
        point. Choosing takes no longer for more points: it bounds every order over the axes.
    spectrum : mapping of int to complex, optional
        … Moments are about each engine's own reference plane.
    torque : bool, default True
        Whether torque is computed. If not, it does not count in the choice of orders.
    progress : bool or callable, default False
        True for a tqdm bar during computations, or a function of (steps done, steps in all) that is
        called now and then; an exception that it raises stops the computation.

    Returns
    -------
    Sweep
        Labelled arrays of force, moment and torque, N and N·m.

    Raises
    ------
    InputError
        If an argument is out of range, or an engine does not have the two banks to be swept.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, as with lengths in millimetres.

    Notes
    -----
    Phasors and peaks of a point have the same bits whatever else is swept with it and however many
    threads compute it, if the orders are the same ones in the same sequence. Sums over crank angle
    (:meth:`Sweep.waveform`) may differ in the last bits, since orders that vanish at all points of
    a sweep are left out of its sums.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> angles = np.arange(10, 180, 10)
    >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=angles, hold="pins", orders=[1, 2])
    >>> s.moment.dims
    ('bank_angle_deg', 'order', 'axis')
    >>> s.moment.shape
    (17, 2, 2)
    >>> cp.sweep(v6, rpm=5000, rod_ratio=[0.25, 0.3], rtol=1e-3, torque=False).orders
    (1, 2, 4, 6)
    """
    bar = progress_bar.checked(progress)
    engine_list, names = _listed(engines)
    arguments = {
        "bank_angle_deg": bank_angle_deg,
        "rod_ratio": rod_ratio,
        "pin_offset": pin_offset,
        "rpm": rpm,
        "load": load,
    }
    swept: dict[str, Any] = {
        name: values for name, values in arguments.items() if values is not None or name == "rpm"
    }
    axes: dict[str, NDArray[np.float64] | float] = {}
    for name, values in swept.items():
        array = inputs.array(name, values)
        axes[name] = inputs.copied(inputs.vector(name, array)) if array.ndim else float(array)
    held: Any = None if hold is None else inputs.text("hold", hold, 'give "pins" or "firing"')
    request = Request.checked(orders=orders, rtol=rtol, spectrum=spectrum, torque=torque)
    if cycle is None and load is not None:
        hint: str = Hint.of("applies to a cycle map; give `cycle=CycleMap(…)`")
        raise inputs.rejected("load", load, hint)
    if cycle is None and crankcase is not None:
        hint = "applies to a cycle map; engine.with_cycle(…, crankcase=…) has that of an engine"
        raise inputs.rejected("crankcase", crankcase, hint)
    if cycle is None:
        inputs.only_with("cycle", crank_end=crank_end)
    maps = None if cycle is None else GasMap.checked(cycle, crank_end, engine_list, crankcase)
    whole = Sweep(tuple(engine_list), names, axes, held, request, maps, bar)
    inputs.warn_of_units(whole.mean_piston_speed)
    # The last value alone shows radians: a sweep in degrees passes parts of a turn in radians.
    angles = axes.get("bank_angle_deg")
    last = angles[-1] if isinstance(angles, np.ndarray) else angles
    checks.radians("bank_angle_deg", bank_angle_deg, [last])
    return whole


class Sweep(ByOrder[Any]):
    """Force, moment and torque of engines over swept arguments: labelled arrays.

    The quantities are those of :class:`Balance` over more dimensions: ``s.moment.backward``,
    ``s.total.force.peak``, ``s[2].torque.peak``. Dimensions, where swept, come in the order
    ``engine``, ``bank_angle_deg``, ``rod_ratio``, ``pin_offset``, ``rpm``, ``load``, then ``order``
    and ``axis``. Arrays are computed when they are first read, and kept. Made by
    :func:`crankpin.sweep`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4, i6 = cp.Engine.preset("i4"), cp.Engine.preset("i6")
    >>> s = cp.sweep([i4, i6], rpm=[3000, 6000], rod_ratio=[0.25, 0.3, 0.35], orders=[2])
    >>> s.force.peak_xy.shape
    (2, 3, 2, 1, 2)
    >>> s.total.force.peak.shape
    (2, 3, 2)
    >>> s[2].torque.dims
    ('engine', 'rod_ratio', 'rpm')
    """

    engines: tuple[Engine, ...]
    """The engines."""
    names: tuple[str, ...] | None
    """Names of the engines as given, empty where none was; None for a single engine, which is no
    dimension."""
    axes: Mapping[str, NDArray[np.float64] | float]
    """Values of each argument: an array where it is swept, else a number."""
    hold: Hold | None
    """Quantity that a change of bank angle does not change: "pins", "firing" or None."""
    _request: Request
    """The options of the sweep, checked."""
    gas_map: GasMap | None = None
    """Cycles over speed and load, and the pressure below the pistons; None without ``cycle``."""
    _progress: Progress = field(default=False, compare=False, repr=False)
    """The progress bar, as given."""

    def __post_init__(self) -> None:
        super().__post_init__()
        request = check_request(self._request, "crankpin.sweep")
        axes = {
            name: values if isinstance(values, np.ndarray) else np.array([values])
            for name, values in self.axes.items()
        }
        swept = [isinstance(self.axes.get(name), np.ndarray) for name in SWEEP_DIMS]
        cores = [engine_core(engine) for engine in self.engines]
        core = _core.Sweep(
            cores if self.gas_map is None else self.gas_map.fired(self.engines),
            axes.get("bank_angle_deg"),
            self.hold,
            axes.get("rod_ratio"),
            axes.get("pin_offset"),
            axes["rpm"],
            None if self.gas_map is None else self.gas_map.places(axes.get("load")),
            request.orders,
            request.rtol,
            request.reference_z,
            request.pairs,
            request.torque,
            [self.names is not None, *swept],
        )
        self.__dict__["_core"] = core

    @cached_property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → upper bound on what the omitted orders add at any point, N or N·m.

        As :attr:`Balance.error_bound`.
        """
        return self._request.bounds(self._core.error_bound)

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted, of any engine."""
        return self.gas_map is not None or any(engine.fired for engine in self.engines)

    @property
    def _titles(self) -> tuple[str, ...]:
        return self.coords.get("engine", ("",))  # type: ignore[return-value] # one engine is no dimension

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: as :attr:`Balance.loads_counted`."""
        if self.gas_map is None:
            return super().loads_counted
        return self._request.loads_counted(self.gas_map.loads_counted(self._engines, self._titles))

    @property
    def _core(self) -> _core.Sweep:
        """Compiled counterpart."""
        return self.__dict__["_core"]  # type: ignore[no-any-return]

    @property
    def mean_piston_speed(self) -> float:
        """Largest mean piston speed of any engine at any point, m/s."""
        return self._core.mean_piston_speed

    @cached_property
    def coords(self) -> Mapping[str, NDArray[np.float64] | tuple[str, ...]]:
        """Swept dimension → its values, in the order of the result's dimensions.

        Engines with the same name, or none, are numbered.
        """
        coords: dict[str, Any] = {}
        if self.names is not None:
            pairs = zip(self.names, self.engines, strict=True)
            coords["engine"] = _distinct([name or _name_of(engine) for name, engine in pairs])
        swept = {name: self.axes.get(name) for name in SWEEP_DIMS}
        coords |= {name: values for name, values in swept.items() if isinstance(values, np.ndarray)}
        return read_only(coords)

    @cached_property
    def fixed(self) -> Mapping[str, float]:
        """Argument that was given as a single value → the value."""
        values = {name: self.axes[name] for name in SWEEP_DIMS if name in self.axes}
        return read_only(
            {name: float(value) for name, value in values.items() if name not in self.dims}
        )

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset of the sweep: arguments given as single values, and ``hold``."""
        return dict(self.fixed) | ({"hold": self.hold} if self.hold else {})

    def __reduce__(self) -> tuple[Any, ...]:
        # A progress bar stays where it is shown; functions cannot be pickled.
        rebuild, (kind, fields) = super().__reduce__()
        return rebuild, (kind, fields | {"_progress": False})

    @property
    def _of_parts(self) -> Request:
        """The request of parts of the sweep: orders chosen for the whole serve them."""
        return self._request.at_orders(self.orders) if self.orders else self._request

    @property
    def _engines(self) -> tuple[Engine, ...]:
        return self.engines

    def _with_request(self, request: Request) -> Self:
        """Return the same sweep by another request."""
        return changed(self, _request=check_request(request, "crankpin.sweep"))

    def _about_axis(self, quantity: str, what: str) -> NDArray[Any]:
        with progress_bar.shown(self._progress, f"{quantity}, {what}") as report:
            if what == VALUES:
                return self._core.phasors(quantity, False, report)
            if what in labels.TURNING_WORDS:
                both = read_only(self._core.phasors(quantity, True, report))
                for k, part in enumerate(labels.TURNING_WORDS):  # computed together
                    self._kept.setdefault((quantity, part), read_only(both[..., k]))
                return self._kept[quantity, what]  # type: ignore[no-any-return]
            planar = kind_of(quantity).planar
            figures = {
                "peak": "length" if planar else "amplitude",
                "peak_xy": "amplitude",
                "total_peak": "length of sum" if planar else "sum",
                "total_peak_xy": "sum",
                "zero_bound": "zero bound",
                "cycle_mean": "mean",
            }
            return self._core.peaks(quantity, figures[what], report)

    # --- points ---------------------------------------------------------------------------------

    def sel(self, **selection: object) -> Any:  # noqa: ANN401 - a balance or a sweep
        """Return the balance at a point of the sweep, or the sweep of what is left to choose.

        The values of a balance are those of the sweep, to the last bit; to rounding where
        periodic loads act.

        Parameters
        ----------
        **selection : dict, optional
            A swept value for each swept dimension, or for some: ``engine`` (a name),
            ``bank_angle_deg``, ``rod_ratio``, ``pin_offset``, ``rpm``, ``load``.

        Returns
        -------
        Balance or Sweep
            The balance, if every swept dimension is named; otherwise the sweep over the others.

        Raises
        ------
        InputError
            If a dimension is not swept, or a value is not among the swept ones.

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60")
        >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=[60, 90], hold="pins")
        >>> b = s.sel(bank_angle_deg=90)
        >>> b.engine.bank_angle_deg, bool(b[1].moment.peak == s[1].moment.peak[1])
        (90.0, True)
        """
        places = self._places(selection)
        if len(places) < len(self.dims):
            axes = dict(self.axes)
            engines, names = self.engines, self.names
            for name, place in places.items():
                if name == "engine":
                    engines, names = (engines[place],), None
                else:
                    axes[name] = float(self.coords[name][place])
            return changed(self, engines=engines, names=names, axes=axes)
        return self._balance_at(tuple(places[name] for name in self.dims))

    def at_minimum(self, values: ArrayLike) -> Balance:
        """Return the balance at the swept point where values of the sweep are least.

        Parameters
        ----------
        values : array_like
            A number for each point, such as the peaks of an order: the shape of the sweep.

        Returns
        -------
        Balance
            The balance at the first such point.

        Raises
        ------
        InputError
            If the shape is another, or all values are NaN.

        Examples
        --------
        The speed at which gas and inertia torque of order 2 are nearest to cancelling:

        >>> import crankpin as cp
        >>> fired = cp.Engine.preset("i4").with_cycle(cp.Cycle.example())
        >>> s = cp.sweep(fired, rpm=range(1000, 6001, 50))
        >>> s.at_minimum(s[2].crank_torque.peak).rpm
        4150.0
        """
        if isinstance(values, str):
            raise inputs.rejected("values", values, "give numbers, as in s.total.moment.peak")
        array = inputs.array("values", values)
        shape = tuple(len(self.coords[name]) for name in self.dims)
        if array.shape != shape or np.isnan(array).all():
            raise inputs.faulty(
                "values",
                f"have shape {array.shape}",
                f"give a number for each point, of shape {shape}",
            )
        least = np.unravel_index(int(np.nanargmin(array)), shape)
        return self._balance_at(tuple(int(place) for place in least))

    def _balance_at(self, places: tuple[int, ...]) -> Balance:
        """Return the balance at a point, given by its place in each swept dimension."""
        at = {name: self.coords[name][k] for name, k in zip(self.dims, places, strict=True)}
        rpm = float({**self.fixed, **at}["rpm"])
        return Balance(self.engine_at(**at), rpm, self._request, (self, places))

    def _places(self, selection: Mapping[str, Any]) -> dict[str, int]:
        """Return the place of each selected value in its dimension."""
        return {
            name: export.place_of(
                name, value, self.coords[inputs.one_of("dimension", name, self.dims)]
            )
            for name, value in selection.items()
        }

    def engine_at(self, **selection: object) -> Engine:
        """Return the engine of a point of the sweep.

        Parameters
        ----------
        **selection : dict, optional
            A swept value for each swept dimension that changes the engine: ``engine`` (a name),
            ``bank_angle_deg``, ``rod_ratio``, ``pin_offset``, with ``cycle`` also ``rpm`` and
            ``load``. ``rpm`` may be given without it too.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If a dimension is missing, is not swept, or a value is not among the swept ones.

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60")
        >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=[60, 90], hold="pins", rod_ratio=[0.25, 0.3])
        >>> engine = s.engine_at(bank_angle_deg=90, rod_ratio=0.3)
        >>> engine.bank_angle_deg, engine.cylinders[0].rod_ratio
        (90.0, 0.3)
        """
        at: dict[str, Any] = {name: [value] for name, value in self.fixed.items()} | dict(
            self.coords
        )
        for name, value in selection.items():
            values = at[inputs.one_of("dimension", name, list(at))]
            at[name] = [values[export.place_of(name, value, values)]]
        for name, values in at.items():
            if len(values) > 1 and (name != "rpm" or self.gas_map is not None):
                raise inputs.faulty(
                    name, "is swept", "give the value at which the engine is wanted"
                )
        place = list(self.coords["engine"]).index(at["engine"][0]) if "engine" in at else 0
        engine = self.engines[place]
        changes = []
        for cylinder in engine.cylinders:
            changed = {}
            if "rod_ratio" in at:
                changed["rod_length"] = rod_length(cylinder.crank_radius, float(at["rod_ratio"][0]))
            if "pin_offset" in at:
                changed["pin_offset"] = float(at["pin_offset"][0])
            changes.append(cylinder.replace(**changed))
        if tuple(changes) != engine.cylinders:
            engine = engine.replace(cylinder=changes)
        if self.gas_map is not None:
            engine = self.gas_map.at(engine, float(at["rpm"][0]), float(at["load"][0]))
        if "bank_angle_deg" in at and self.hold is not None:
            # Last: banks that move take along the angles at which their cylinders fire.
            engine = engine.with_bank_angle(float(at["bank_angle_deg"][0]), hold=self.hold)
        return engine

    # --- over crank angle -----------------------------------------------------------------------

    def waveform(self, theta_deg: ArrayLike | None = None, *, exact: bool = False) -> SweepWaveform:
        """Return force, moment and torque over crank angle at every point.

        As sums of the sweep's orders, or by exact kinematics. Orders that the layout cancels are
        not summed; the motion of cylinders that move alike is computed once.

        Parameters
        ----------
        theta_deg : array_like, shape (n_theta,), optional
            Crank angles, degrees; by default 0, 1, …, 720.
        exact : bool, default False
            True for exact kinematics, False for the sum of the sweep's orders.

        Returns
        -------
        SweepWaveform
            Arrays over crank angle, N and N·m, computed when they are first read.

        Raises
        ------
        InputError
            If an argument is out of range, or exact kinematics is requested with a spectrum.

        Examples
        --------
        >>> import crankpin as cp
        >>> i4, i6 = cp.Engine.preset("i4"), cp.Engine.preset("i6")
        >>> s = cp.sweep([i4, i6], rpm=[3000, 6000])
        >>> s.waveform(range(360)).torque.shape
        (2, 2, 360)
        """
        theta = inputs.crank_angles(theta_deg)
        if inputs.flag("exact", exact) and self._request.pairs is not None:
            hint = "exact kinematics needs the slider-crank; leave out the spectrum, or exact"
            raise inputs.rejected("exact", True, hint)
        return SweepWaveform(self, theta, bool(exact))

    # --- tables and pictures --------------------------------------------------------------------

    def to_dask(self, chunks: Chunks, *quantities: str) -> xr.Dataset:
        """Return the arrays of :meth:`to_xarray`, computed by dask (needs dask and xarray).

        The result may be larger than memory; each chunk is an ordinary sweep, in any of dask's
        schedulers, and its values have the same bits as those of one sweep of everything.

        Parameters
        ----------
        chunks : int, "auto" or mapping of str to int
            Points to a chunk of each swept dimension; or a mapping dimension → points, the
            dimensions that it leaves out staying whole; or ``"auto"``.
        *quantities : str, optional
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.

        Returns
        -------
        xarray.Dataset
            Arrays of dask, with units as attributes.

        Raises
        ------
        InputError
            If chunks are out of range, or there is no such quantity.
        ImportError
            If dask or xarray is not installed.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=range(1000, 7000), orders=[2])
        >>> s.to_dask(1000).force_peak.chunks
        ((1000, 1000, 1000, 1000, 1000, 1000), (1,))
        """
        if self._progress is not False:
            hint = "use dask.diagnostics.ProgressBar"
            raise inputs.faulty("progress", "cannot be combined with to_dask", hint)
        return dask.dataset(self, chunks, self._chosen(quantities))

    @property
    def table(self) -> Table:
        """Table that is shown: peaks of all orders together at each point."""
        return self._by_point(self._title(), lambda name: self.read(name, "total_peak"))

    def _by_point(self, title: str, peaks: Callable[[str], NDArray[np.float64]]) -> Table:
        """Return a table of the points, with a peak of each quantity."""
        names = [name for name in self._request.quantities if name != "crank_torque"]
        columns = export.points(self.coords, len(names))
        for name in names:
            kind = QUANTITIES[name]
            columns.append(Column(kind.vector_symbol, peaks(name), kind.unit))
        return Table(title, tuple(columns), loads=self.loads_counted)

    def _title(self, of: str = "") -> str:
        which = " of the orders given" if self._request.orders is not None else ""
        fixed = [labels.value_text(name, value) for name, value in self.fixed.items()]
        held = [labels.HELD[self.hold]] if self.hold else []
        engine = f"{engine_titles(self)[0]}: " if self.names is None else ""
        of = of or which or " of all orders together"
        text = ", ".join([f"{engine}peaks{of}", *fixed, *held])
        return f"{text[0].upper()}{text[1:]}"

    @property
    def _brief(self) -> str:
        if math.prod(len(values) for values in self.coords.values()) <= MOST_POINTS_SHOWN:
            return ""
        swept = ", ".join(f"{name}: {len(values)}" for name, values in self.coords.items())
        loads = f", {self.loads_counted}" if self.loads_counted else ""
        return f"<Sweep over ({swept})> {self._title()}{loads}"


def _listed(engines: Engines) -> tuple[list[Engine], tuple[str, ...] | None]:
    """Return the engines, and where there are several their names, empty unless in a mapping."""
    if isinstance(engines, Engine):
        return [engines], None
    names: Sequence[str] | None = None
    if not isinstance(engines, (list, tuple)):
        if isinstance(engines, Mapping):
            names, engines = [str(name) for name in engines], engines.values()
        engines = inputs.items("engines", engines, f"{ENGINE_HINT}, or several")
    for engine in engines:
        engine_core(engine, "engines")
    if names is None:
        names = [""] * len(engines)
    return list(engines), tuple(names)


def _name_of(engine: Engine) -> str:
    return labels.name_of(engine) if engine.name else ""


def _distinct(names: Sequence[str]) -> tuple[str, ...]:
    """Return names, numbered where they do not distinguish the engines."""
    if "" not in names and len(set(names)) == len(names):
        return tuple(names)
    return tuple(f"{name} ({k})" if name else f"{k}" for k, name in enumerate(names, start=1))


def engine_titles(sweep: Sweep) -> list[str]:
    """Return names of a sweep's engines for titles and legends.

    Where bank angle is swept, names of engines (not those of a mapping) go without the bank angle
    that the engine had before, such as in "V6 60°".
    """
    coordinate = sweep.coords.get("engine")
    titles = [labels.name_of(engine) for engine in sweep.engines]
    names = titles if coordinate is None else [str(name) for name in coordinate]
    if "bank_angle_deg" not in {*sweep.coords, *sweep.fixed} or names != titles:
        return names
    without = [labels.one_line(engine._title(with_bank_angle=False)) for engine in sweep.engines]
    return without if len(set(without)) == len(names) else names
