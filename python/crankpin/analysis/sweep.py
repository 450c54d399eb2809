"""Sweeps over engines, bank angle, rod ratio, pin offset and speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias, overload

import numpy as np

from crankpin import _core
from crankpin._support import inputs, tables
from crankpin._support import progress as progress_bar
from crankpin._support.frozen import Frozen
from crankpin.analysis.balance import ErrorBound
from crankpin.analysis.sweep_waveform import SweepWaveform
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin._support.progress import Progress
    from crankpin.analysis.chunks import Chunks
    from crankpin.model.engine import Hold

Engines: TypeAlias = Engine | Iterable[Engine] | Mapping[str, Engine]
Quantity: TypeAlias = Literal["force", "moment", "torque"]


@overload
def sweep(
    engines: Engines,
    *,
    rpm: ArrayLike,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    rod_ratio: ArrayLike | None = None,
    pin_offset: ArrayLike | None = None,
    orders: Orders = (1, 2, 4, 6),
    rtol: float = 1e-9,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
    progress: Progress = False,
    chunks: None = None,
) -> Sweep: ...
@overload
def sweep(
    engines: Engines,
    *,
    rpm: ArrayLike,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    rod_ratio: ArrayLike | None = None,
    pin_offset: ArrayLike | None = None,
    orders: Orders = (1, 2, 4, 6),
    rtol: float = 1e-9,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
    progress: Progress = False,
    chunks: Chunks,
) -> xr.Dataset: ...
def sweep(
    engines: Engines,
    *,
    rpm: ArrayLike,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    rod_ratio: ArrayLike | None = None,
    pin_offset: ArrayLike | None = None,
    orders: Orders = (1, 2, 4, 6),
    rtol: float = 1e-9,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
    progress: Progress = False,
    chunks: Chunks | None = None,
) -> Sweep | xr.Dataset:
    """Return how engines shake over any combination of bank angle, rod ratio, offset and speed.

    No crank angle is sampled: each point is a layout sum times a harmonic. Every array argument is
    a dimension of the result; a scalar is not. Values are worked out when they are asked for.

    Parameters
    ----------
    engines
        An engine, several, or a mapping name → engine.
    rpm
        Crank speeds.
    bank_angle_deg
        Angles between the two banks, 0 to 180.
    hold
        What a change of bank angle leaves as it is; must be said: ``"pins"`` (the crank; firing
        intervals change) or ``"firing"`` (every top dead centre; pins are split as needed).
    rod_ratio
        Crank radius / rod length; the radius stays, the rod changes.
    pin_offset
        Pin offset of every cylinder, m.
    orders
        Whole multiples of crank speed, or ``"auto"`` for the fewest that reach ``rtol`` at every
        point, each order counted with its worst point. Choosing takes about the time of a sweep of
        all orders that may matter, at one speed.
    rtol, reference_z, spectrum
        As in :meth:`Engine.balance`.
    torque
        Whether torque will be asked for. If not, it is not counted where orders are chosen.
    progress
        True for a tqdm bar while values are worked out, or a function of (steps done, steps in all)
        that is called now and then; what it raises stops the work.
    chunks
        Leaves the work to dask (needs dask and xarray): points to a chunk of each swept dimension,
        or a mapping dimension → points, dimensions that it leaves out staying whole, or ``"auto"``.
        The result may be larger than memory; each chunk is an ordinary sweep, in any of dask's
        schedulers, and its values have the same bits as those of one sweep of everything.

    Returns
    -------
    Sweep
        Or with ``chunks`` an :class:`xarray.Dataset` of dask arrays: phasors and peaks, named as
        the attributes of :class:`Sweep`.

    Raises
    ------
    InputError
        If an argument is out of range, or an engine does not have the two banks to be swept.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> angles = np.arange(10, 180, 10)
    >>> s = cp.sweep(v6, rpm=5000, bank_angle_deg=angles, hold="pins", orders=[1, 2])
    >>> s.dims("moment")
    ('bank_angle_deg', 'order', 'axis')
    >>> s.moment.shape
    (17, 2, 2)
    >>> cp.sweep(v6, rpm=5000, rod_ratio=[0.25, 0.3], orders="auto", rtol=1e-3, torque=False).orders
    (1, 2, 4, 6)
    """
    shown = progress_bar.checked(progress)
    listed, names = _listed(engines)
    given = {
        "bank_angle_deg": bank_angle_deg,
        "rod_ratio": rod_ratio,
        "pin_offset": pin_offset,
    }
    swept = {name: values for name, values in given.items() if values is not None} | {"rpm": rpm}
    arrays = {name: inputs.array(name, values) for name, values in swept.items()}
    ranks = {name: values.ndim for name, values in arrays.items()}
    axes = {name: inputs.vector(name, values) for name, values in arrays.items()}
    wanted, rtol = inputs.orders(orders), inputs.number("rtol", rtol)
    torque = inputs.flag("torque", torque)
    core = _core.Sweep(
        [engine.core for engine in listed],
        axes.get("bank_angle_deg"),
        None if hold is None else inputs.text("hold", hold, 'give "pins" or "firing"'),
        axes.get("rod_ratio"),
        axes.get("pin_offset"),
        axes["rpm"],
        wanted,
        rtol,
        inputs.optional_number("reference_z", reference_z),
        inputs.spectrum(spectrum),
        torque,
        [names is not None, *(ranks.get(name, 0) > 0 for name in (*given, "rpm"))],
    )
    inputs.warn_of_units(core.mean_piston_speed)
    arguments = {
        "hold": hold,
        "orders": "auto" if wanted is None else tuple(wanted),
        "rtol": rtol,
        "reference_z": reference_z,
        "spectrum": spectrum,
        "torque": torque,
    }
    whole = Sweep(core, listed, names, ranks, arguments, shown)
    if chunks is None:
        return whole
    if shown is not False:
        raise _core.InputError(
            "progress: dask tells it itself, by dask.diagnostics.ProgressBar; leave it out"
        )
    from crankpin.analysis.chunks import dataset  # noqa: PLC0415 - it makes sweeps

    return dataset(whole, chunks)


class Sweep(Frozen):
    """How engines shake over swept quantities: labelled arrays, worked out when asked for.

    Dimensions, where swept, come in the order ``engine``, ``bank_angle_deg``, ``rod_ratio``,
    ``pin_offset``, ``rpm``, then ``order`` and ``axis``. Made by :func:`crankpin.sweep`.

    Examples
    --------
    >>> import crankpin as cp
    >>> i4, i6 = cp.Engine.preset("i4"), cp.Engine.preset("i6")
    >>> s = cp.sweep([i4, i6], rpm=[3000, 6000], rod_ratio=[0.25, 0.3, 0.35], orders=[2])
    >>> s.force_peak_xy.shape
    (2, 3, 2, 1, 2)
    >>> s.force_sum_peak_vector.shape
    (2, 3, 2)
    """

    engines: tuple[Engine, ...]
    """The engines."""

    def __init__(
        self,
        core: _core.Sweep,
        engines: list[Engine],
        names: Sequence[str] | None,
        ranks: dict[str, int],
        arguments: dict[str, Any],
        progress: Progress,
    ) -> None:
        if not isinstance(core, _core.Sweep):
            raise _core.InputError(f"Sweep({inputs.shorten(core)}): use crankpin.sweep")
        self._set(
            _core=core,
            engines=tuple(engines),
            _names=names,
            _ranks=ranks,
            _arguments=arguments,
            _progress=progress,
        )

    _core: _core.Sweep
    _names: Sequence[str] | None
    """Names of the engines where there may be several."""
    _ranks: dict[str, int]
    """Quantity → 1 where it is swept, 0 where it was given as a single value."""
    _arguments: dict[str, Any]
    _progress: Progress

    @property
    def hold(self) -> Hold | None:
        """What a change of bank angle leaves as it is."""
        hold: Hold | None = self._arguments["hold"]
        return hold

    @cached_property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        return tuple(self._core.orders)

    @cached_property
    def omitted(self) -> tuple[int, ...]:
        """With ``orders="auto"``: orders left out that are not zero at some point.

        Orders above the last one looked at add less than a hundredth of ``rtol``.
        """
        return tuple(self._core.omitted)

    @cached_property
    def error_bound(self) -> ErrorBound:
        """With ``orders="auto"``: what all orders left out can add at any point."""
        force, moment, torque = self._core.error_bound
        known = self._arguments["torque"] and self._arguments["spectrum"] is None
        return ErrorBound(force, moment, torque if known else None)

    @cached_property
    def coords(self) -> Mapping[str, NDArray[np.float64] | list[str]]:
        """Swept dimension → its values, in the order of the result's dimensions."""
        coords: dict[str, NDArray[np.float64] | list[str]] = {}
        if self._names is not None:
            coords["engine"] = _told_apart(self._names)
        coords |= {name: self._core.axis(name) for name, rank in self._ranks.items() if rank}
        return MappingProxyType(coords)

    @cached_property
    def fixed(self) -> Mapping[str, float]:
        """What was given as a single value."""
        fixed = {
            name: float(self._core.axis(name)[0]) for name, rank in self._ranks.items() if not rank
        }
        return MappingProxyType(fixed)

    def dims(self, quantity: Quantity = "moment") -> tuple[str, ...]:
        """Return the names of a quantity's dimensions."""
        return (*self.coords, *_ORDER_DIMS[inputs.one_of("quantity", quantity, _ORDER_DIMS)])

    # --- phasors --------------------------------------------------------------------------------

    @cached_property
    def force(self) -> NDArray[np.complex128]:
        """Peak phasors of the shaking force along x and y, N: (…, n_orders, 2)."""
        return self._phasors("force")

    @cached_property
    def moment(self) -> NDArray[np.complex128]:
        """Peak phasors of the rocking moment about x and y, N·m: (…, n_orders, 2)."""
        return self._phasors("moment")

    @cached_property
    def torque(self) -> NDArray[np.complex128]:
        """Peak phasors of the roll torque on the block, N·m: (…, n_orders)."""
        return self._phasors("torque")

    # --- peaks of each order --------------------------------------------------------------------

    @cached_property
    def force_peak_xy(self) -> NDArray[np.float64]:
        """Largest force of each order along x and along y, N: (…, n_orders, 2)."""
        return self._figures("force", "amplitude")

    @cached_property
    def moment_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment of each order about x and about y, N·m: (…, n_orders, 2)."""
        return self._figures("moment", "amplitude")

    @cached_property
    def torque_peak(self) -> NDArray[np.float64]:
        """Largest roll torque of each order, N·m: (…, n_orders)."""
        return self._figures("torque", "amplitude")

    @cached_property
    def force_peak_vector(self) -> NDArray[np.float64]:
        """Longest force of each order, N: (…, n_orders)."""
        return self._figures("force", "length")

    @cached_property
    def moment_peak_vector(self) -> NDArray[np.float64]:
        """Longest moment of each order, N·m: (…, n_orders)."""
        return self._figures("moment", "length")

    # --- peaks of the sum of orders -------------------------------------------------------------

    @cached_property
    def force_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest force along x and along y of all orders together, N: (…, 2); true extrema."""
        return self._figures("force", "sum")

    @cached_property
    def moment_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment about x and y of all orders together, N·m: (…, 2); true extrema."""
        return self._figures("moment", "sum")

    @cached_property
    def torque_sum_peak(self) -> NDArray[np.float64]:
        """Largest roll torque of all orders together, N·m: (…); true extrema."""
        return self._figures("torque", "sum")

    @cached_property
    def force_sum_peak_vector(self) -> NDArray[np.float64]:
        """Longest force of all orders together, N: (…); true extrema."""
        return self._figures("force", "length of sum")

    @cached_property
    def moment_sum_peak_vector(self) -> NDArray[np.float64]:
        """Longest moment of all orders together, N·m: (…); true extrema."""
        return self._figures("moment", "length of sum")

    # --- over crank angle -----------------------------------------------------------------------

    def waveform(
        self, theta_deg: ArrayLike | None = None, *, exact: bool | None = None
    ) -> SweepWaveform:
        """Return force, moment and torque over crank angle at every point.

        As sums of the sweep's orders, or by exact kinematics. Orders that the layout cancels are
        not summed, cylinders that move alike are worked out once.

        Parameters
        ----------
        theta_deg
            Crank angles, degrees: (n_theta,); by default 0, 1, …, 720.
        exact
            True for exact kinematics, False for the sum of orders. By default the sum, unless its
            orders were chosen with ``orders="auto"`` and kinematics cost less.

        Returns
        -------
        SweepWaveform

        Raises
        ------
        InputError
            If an argument is out of range, or exact kinematics are asked of a spectrum.

        Examples
        --------
        >>> import crankpin as cp
        >>> i4, i6 = cp.Engine.preset("i4"), cp.Engine.preset("i6")
        >>> s = cp.sweep([i4, i6], rpm=[3000, 6000], orders="auto", rtol=1e-9)
        >>> s.waveform(range(360)).torque.shape
        (2, 2, 360)
        """
        theta = inputs.vector("theta_deg", np.arange(721.0) if theta_deg is None else theta_deg)
        by_spectrum = self._arguments["spectrum"] is not None
        if exact is None:
            exact = self._arguments["orders"] == "auto" and self._core.kinematics_cost_less
        elif inputs.flag("exact", exact) and by_spectrum:
            cure = "exact kinematics needs the slider-crank; leave out the spectrum, or exact"
            raise _core.InputError(f"exact = True: {cure}")
        return SweepWaveform(self, theta, exact=bool(exact))

    # --- tables and pictures --------------------------------------------------------------------

    def to_xarray(self, *quantities: Quantity) -> xr.Dataset:
        """Return phasors and peaks with named dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``; by default force and moment.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[1, 2])
        >>> s.to_xarray("force").force.dims
        ('rpm', 'order', 'axis')
        """
        wanted = quantities or ("force", "moment")
        variables = {
            variable.name: (
                self._variable_dims(variable),
                getattr(self, variable.name),
                variable.attributes,
            )
            for variable in variables_of(*wanted)
            if "vector" not in variable.name
        }
        return self._dataset(variables, wanted)

    def _variable_dims(self, variable: Variable) -> tuple[str, ...]:
        """Return the names of a variable's dimensions."""
        return (*self.coords, *variable.dims)

    def _dataset(self, variables: dict[str, Any], quantities: Sequence[Quantity]) -> xr.Dataset:
        """Return variables with this sweep's coordinates."""
        coords = tables.coordinates(self.coords)
        coords["order"] = ("order", list(self.orders), {"units": tables.XARRAY_UNITS["order"]})
        if any(quantity != "torque" for quantity in quantities):
            coords["axis"] = ("axis", ["x", "y"])
        dataset: xr.Dataset = tables.xarray().Dataset(variables, coords, self._attributes)
        return dataset

    @property
    def _attributes(self) -> dict[str, Any]:
        """What holds for the whole of a dataset."""
        return dict(self.fixed) | ({"hold": self.hold} if self.hold else {})

    def to_pandas(self, quantity: Quantity = "moment") -> pd.DataFrame:
        """Return the peaks of each order as a table, one row a swept point (needs pandas).

        Columns are (order, axis); rows are labelled by the swept values.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[3000, 6000], orders=[2])
        >>> s.to_pandas("force").shape
        (2, 2)
        """
        pandas = tables.pandas()
        peaks = self._peaks(quantity)
        axes = ["z"] if quantity == "torque" else ["x", "y"]
        columns = pandas.MultiIndex.from_product([self.orders, axes], names=["order", "axis"])
        if self.coords:
            index = pandas.MultiIndex.from_product(
                list(self.coords.values()), names=list(self.coords)
            )
            if len(self.coords) == 1:
                index = index.get_level_values(0)
        else:
            index = None
        table: pd.DataFrame = pandas.DataFrame(
            peaks.reshape(-1, len(columns)), index=index, columns=columns
        )
        return table

    def plot(self, *, quantity: Quantity = "moment", x: str | None = None) -> Figure:
        """Draw the peaks of each order over a swept quantity; return the figure.

        One panel for each order and axis, one curve for each combination of the other dimensions.

        Parameters
        ----------
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.
        x
            The dimension along the horizontal axis; by default the longest.
        """
        from crankpin.plot import figures  # noqa: PLC0415 - matplotlib is imported when used

        return figures.sweep(self, quantity, x)

    def _phasors(self, quantity: Quantity) -> NDArray[np.complex128]:
        with progress_bar.shown(self._progress, f"{quantity}, phasors") as told:
            return self._core.phasors(quantity, told)

    def _figures(self, quantity: Quantity, which: str) -> NDArray[np.float64]:
        with progress_bar.shown(self._progress, f"{quantity}, {which}") as told:
            return self._core.peaks(quantity, which, told)

    def _peaks(self, quantity: Quantity) -> NDArray[np.float64]:
        inputs.one_of("quantity", quantity, _ORDER_DIMS)
        name = "torque_peak" if quantity == "torque" else f"{quantity}_peak_xy"
        return getattr(self, name)  # type: ignore[no-any-return]

    def __reduce__(self) -> tuple[Any, ...]:
        axes = {
            name: self._core.axis(name) if rank else float(self._core.axis(name)[0])
            for name, rank in self._ranks.items()
        }
        return (
            _again,
            (self.engines, self._names, self._arguments | axes),
        )

    def __repr__(self) -> str:
        swept = ", ".join(f"{name}: {len(values)}" for name, values in self.coords.items())
        held = f", hold={self.hold!r}" if self.hold else ""
        return f"<Sweep over ({swept}), orders {list(self.orders)}{held}>"


_ORDER_DIMS: dict[str, tuple[str, ...]] = {
    "force": ("order", "axis"),
    "moment": ("order", "axis"),
    "torque": ("order",),
}


class Variable(NamedTuple):
    """What a sweep tells of a quantity: an attribute and the dimensions after the swept ones."""

    name: str
    quantity: Quantity
    dims: tuple[str, ...]

    @property
    def attributes(self) -> dict[str, str]:
        """What an xarray variable is labelled with."""
        return {"units": tables.XARRAY_UNITS[self.quantity]}


def variables_of(*quantities: Quantity) -> Iterator[Variable]:
    """Yield phasors and peaks of some quantities."""
    for quantity in quantities:
        dims = _ORDER_DIMS[inputs.one_of("quantity", quantity, _ORDER_DIMS)]
        yield Variable(quantity, quantity, dims)
        if quantity == "torque":
            yield Variable("torque_peak", quantity, dims)
            yield Variable("torque_sum_peak", quantity, ())
            continue
        yield Variable(f"{quantity}_peak_xy", quantity, dims)
        yield Variable(f"{quantity}_sum_peak_xy", quantity, ("axis",))
        yield Variable(f"{quantity}_peak_vector", quantity, ("order",))
        yield Variable(f"{quantity}_sum_peak_vector", quantity, ())


def _again(
    engines: tuple[Engine, ...], names: Sequence[str] | None, arguments: dict[str, Any]
) -> Sweep:
    again: Sweep = sweep(engines[0] if names is None else engines, **arguments)
    if names is not None:
        again._set(_names=names)
    return again


def _listed(engines: Engines) -> tuple[list[Engine], Sequence[str] | None]:
    """Return the engines, and their names where there may be several."""
    if isinstance(engines, Engine):
        return [engines], None
    names: Sequence[str] | None = None
    if not isinstance(engines, (list, tuple)):
        if isinstance(engines, Mapping):
            names, engines = [str(name) for name in engines], engines.values()
        engines = inputs.items("engines", engines, "give crankpin.Engine objects")
    for engine in engines:
        if not isinstance(engine, Engine):
            raise _core.InputError(
                f"engines = {inputs.shorten(engine)}: give crankpin.Engine objects"
            )
    return list(engines), [engine.name for engine in engines] if names is None else names


def _told_apart(names: Sequence[str]) -> list[str]:
    """Return names, numbered where they do not tell the engines apart."""
    if "" not in names and len(set(names)) == len(names):
        return list(names)
    return [f"{k + 1} {name}".strip() for k, name in enumerate(names)]
