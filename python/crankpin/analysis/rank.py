"""Which engine shakes least, and at which bank angles."""

from __future__ import annotations

import contextlib
import dataclasses
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, tables
from crankpin._support.frozen import Frozen
from crankpin.analysis import objectives
from crankpin.analysis.search import Arrangement, ArrangementSearch
from crankpin.analysis.sweep import Sweep, sweep
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.objectives import Measure, Objective
    from crankpin.analysis.sweep import Engines
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Hold

SHOWN = 10
"""Engines that text shows."""
SHOWN_IN_NOTEBOOKS = 50
MOST_ANGLES = 6
"""Bank angles that a cell shows."""


@dataclasses.dataclass(frozen=True)
class Choice:
    """An engine of a :class:`Ranking` at its best bank angles."""

    place: int
    """1 for the best; engines whose values are equal within the tolerance share a place."""
    name: str
    """What the engine is called."""
    engine: Engine
    """The engine at the first of these bank angles."""
    bank_angles_deg: tuple[float, ...]
    """All bank angles that tie for the least value, ascending; none where no value is finite, or
    where the engine does not have two banks and was taken as it is."""
    values: tuple[float, ...]
    """The value of each objective there; inf where none is finite."""

    @property
    def value(self) -> float:
        """The value of the first objective."""
        return self.values[0]


def rank(
    engines: Engines | Arrangement | Sequence[Arrangement] | ArrangementSearch,
    *,
    rpm: float,
    bank_angle_deg: ArrayLike | None = None,
    hold: Hold | None = None,
    by: str | Measure | Sequence[str | Measure] = "moment_sum_peak_vector",
    orders: Orders = (1, 2, 4, 6),
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    cylinder: Cylinder | None = None,
    spacing: float | None = None,
    refine: bool = False,
    rtol: float = 1e-9,
) -> Ranking:
    """Rank engines by an objective, each at the bank angles that serve it best.

    Parameters
    ----------
    engines
        An engine, several, or a mapping name → engine, such as one for each firing order; or
        arrangements: some of a search, such as its :meth:`~ArrangementSearch.best`, or all of an
        :class:`ArrangementSearch`.
    rpm
        Crank speed.
    bank_angle_deg
        Bank angles to choose from, 0 to 180; by default each engine is taken as it is.
    hold
        What a change of bank angle leaves as it is, as in :func:`crankpin.sweep`.
    by
        What is to be least: a name of the list below, a function that takes the
        :class:`Balance` of an engine at a bank angle and returns a number (NaN or inf: not to be
        chosen), or several of either: what ties by the first is told apart by the next.
    orders
        Whole multiples of crank speed that make up the balance.
    reference_z, spectrum
        As in :meth:`Engine.balance`.
    cylinder, spacing
        Of the engines of arrangements, as in :meth:`Arrangement.engine`.
    refine
        Look between the bank angles too: each dip of the first objective is followed down to its
        lowest point. Without it only the given angles are looked at. Dips that lie wholly between
        two neighbouring angles are found in neither case.
    rtol
        Values tie when they differ by at most this, relative to the largest value of the objective
        in the whole ranking.

    Returns
    -------
    Ranking
        The best first.

    Raises
    ------
    InputError
        If an argument is out of range, or an engine does not have the two banks to be turned.

    Notes
    -----
    Objectives known by name, N and N·m; *all orders* are those of ``orders``:

    ``moment_sum_peak_vector``, ``force_sum_peak_vector``
        Longest rocking moment or shaking force of all orders together; a true extremum.
    ``moment_sum_peak_xy``, ``force_sum_peak_xy``
        The larger of the peaks about (along) x and y of all orders together.
    ``torque_sum_peak``
        Largest roll torque of all orders together.
    ``moment_after_counterweight``, ``force_after_counterweight``
        What the best counterweights on the crank leave of the first order: its backward part.
    ``moment_peak_vector_2``, ``force_peak_vector_2``, ``torque_peak_2``
        Largest of one order, here the second; any of ``orders`` can be named.
    ``unevenness_deg``
        Root mean square difference of the firing intervals from equal ones, in the most even
        four-stroke order that the crank allows; up to 16 cylinders.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> orders = ("1-3-5-2-4-6", "1-4-5-2-3-6", "1-6-5-4-3-2", "1-5-3-6-2-4")
    >>> ranking = cp.rank(
    ...     {order: cp.Engine.preset(f"ijesc-v6-{order}") for order in orders},
    ...     rpm=5000,
    ...     bank_angle_deg=np.arange(10, 180, 10),
    ...     hold="pins",
    ...     by=["moment_after_counterweight", "moment_peak_vector_2"],
    ... )
    >>> for choice in ranking:
    ...     print(choice.name, choice.bank_angles_deg, np.round(choice.values, 1))
    1-6-5-4-3-2 (150.0,) [   0.  1160.3]
    1-3-5-2-4-6 (90.0,) [   0.  1698.9]
    1-4-5-2-3-6 (30.0,) [   0.  2009.8]
    1-5-3-6-2-4 (10.0,) [717.3 415.6]

    A function takes the balance of an engine at an angle, and ``refine`` looks between the angles:

    >>> (best,) = cp.rank(
    ...     cp.Engine.preset("ijesc-v6-1-6-5-4-3-2"),
    ...     rpm=5000,
    ...     bank_angle_deg=np.arange(10, 180, 10),
    ...     hold="pins",
    ...     by=lambda balance: np.hypot(*balance.moment_sum_peak_xy),
    ...     refine=True,
    ... )
    >>> round(best.bank_angles_deg[0], 3)
    140.657
    """
    ranked_by = objectives.listed(by)
    tolerance = inputs.number("rtol", rtol)
    if not 0.0 <= tolerance < 1.0:
        raise InputError(f"rtol = {inputs.shorten(rtol)}: give 0 or more, less than 1")
    between = inputs.flag("refine", refine)
    of_engines = _engines(engines, cylinder, spacing)
    with warnings.catch_warnings():
        # Once for the whole call, below.
        warnings.filterwarnings("ignore", "mean piston speed", UserWarning)
        swept = sweep(
            of_engines,
            rpm=inputs.number("rpm", rpm),
            bank_angle_deg=(
                None if bank_angle_deg is None else inputs.vector("bank_angle_deg", bank_angle_deg)
            ),
            hold=hold,
            orders=orders,
            reference_z=reference_z,
            spectrum=spectrum,
        )
        values = [objective.values(swept) for objective in ranked_by]
        if between and "bank_angle_deg" not in swept.coords:
            raise InputError("refine = True: looks between bank angles; give bank_angle_deg")
        choices = _chosen(swept, ranked_by, values, tolerance, refine=between)
    inputs.warn_of_units(swept._core.mean_piston_speed)
    return Ranking(swept, [objective.bare() for objective in ranked_by], values, choices)


class Ranking(Frozen):
    """Engines by how well they serve an objective, each at its best bank angles.

    A sequence of :class:`Choice`, the best first. Made by :func:`crankpin.rank`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> ranking = cp.rank(v6, rpm=5000, bank_angle_deg=[60, 90, 120], hold="pins")
    >>> ranking[0].bank_angles_deg
    (60.0,)
    >>> ranking.table["moment_after_counterweight"].round(1)
    array([[  0. , 459.4, 795.7]])
    """

    by: tuple[str, ...]
    """Names of the objectives."""
    choices: tuple[Choice, ...]
    """The engines, the best first."""

    def __init__(
        self,
        swept: Sweep,
        objectives: Sequence[Objective],
        values: Sequence[NDArray[np.float64]],
        choices: tuple[Choice, ...],
    ) -> None:
        if not isinstance(swept, Sweep):
            raise InputError(f"Ranking({inputs.shorten(swept)}): use crankpin.rank")
        for each in values:
            each.setflags(write=False)
        self._set(
            _sweep=swept,
            _objectives=tuple(objectives),
            _values=tuple(values),
            by=tuple(objective.label for objective in objectives),
            choices=choices,
        )

    _sweep: Sweep
    _objectives: tuple[Objective, ...]
    _values: tuple[NDArray[np.float64], ...]

    @property
    def engines(self) -> tuple[Engine, ...]:
        """The engines as they were given."""
        return self._sweep.engines

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What the engines are called, as given."""
        return tuple(tables.engine_names(self._sweep))

    @property
    def hold(self) -> Hold | None:
        """What a change of bank angle leaves as it is."""
        return self._sweep.hold

    @cached_property
    def bank_angles_deg(self) -> NDArray[np.float64] | None:
        """The bank angles that were given: (n_angles,); None where engines were taken as are."""
        return _angles(self._sweep)

    @cached_property
    def _own_angles_deg(self) -> NDArray[np.float64]:
        """The bank angles that the engines were given with, NaN where there are not two banks."""
        own = _own_angles(self.engines)
        own.setflags(write=False)
        return own

    @property
    def values(self) -> NDArray[np.float64]:
        """The first objective of each engine at each bank angle: (n_engines, n_angles).

        Engines as given; one column where they were taken as they are.
        """
        return self._values[0]

    @cached_property
    def table(self) -> Mapping[str, NDArray[np.float64]]:
        """The trade-off: objective → (n_engines, n_angles), engines as given.

        The objectives that were asked for; then moment and force of all orders, what
        counterweights leave of the first one, the second one, torque, and, of engines with up to 8
        cylinders, the unevenness of firing.
        """
        columns = dict(zip(self.by, self._values, strict=True))
        for objective in objectives.of_table(self._sweep):
            if objective.label not in columns:
                columns[objective.label] = objective.values(self._sweep)
        return MappingProxyType(columns)

    def best(self, count: int = 1) -> tuple[Choice, ...]:
        """Return so many engines, the best first."""
        wanted = inputs.number("count", count)
        if not 0 <= wanted <= len(self) or wanted != int(wanted):
            cure = f"give a whole number, 0 to {len(self)}"
            raise InputError(f"count = {inputs.shorten(count)}: {cure}")
        return self.choices[: int(wanted)]

    def __len__(self) -> int:
        return len(self.choices)

    def __getitem__(self, index: int) -> Choice:
        return self.choices[index]

    def __iter__(self) -> Iterator[Choice]:
        return iter(self.choices)

    @property
    def unit(self) -> str:
        """Unit of the first objective; empty where it is a function."""
        return self._objectives[0].unit

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self) -> pd.DataFrame:
        """Return the trade-off as a table, one row an engine and bank angle (needs pandas).

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60")
        >>> cp.rank(v6, rpm=5000, bank_angle_deg=[60, 90], hold="pins").to_pandas().shape
        (2, 8)
        """
        pandas = tables.pandas()
        angles = self.bank_angles_deg
        if angles is None:
            rows = list(zip(self.names, self._own_angles_deg, strict=True))
            index = pandas.MultiIndex.from_tuples(rows, names=["engine", "bank_angle_deg"])
        else:
            index = pandas.MultiIndex.from_product(
                [self.names, angles], names=["engine", "bank_angle_deg"]
            )
        columns = {label: values.ravel() for label, values in self.table.items()}
        table: pd.DataFrame = pandas.DataFrame(columns, index=index)
        return table

    def to_xarray(self) -> xr.Dataset:
        """Return the trade-off with named dimensions and units (needs xarray).

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60")
        >>> ranking = cp.rank(v6, rpm=5000, bank_angle_deg=[60, 90], hold="pins")
        >>> ranking.to_xarray().moment_sum_peak_vector.dims
        ('engine', 'bank_angle_deg')
        """
        angles = self.bank_angles_deg
        dims = ("engine",) if angles is None else ("engine", "bank_angle_deg")
        units = {each.label: each.unit for each in objectives.of_table(self._sweep)}
        units |= {each.label: each.unit for each in self._objectives}
        variables: dict[str, Any] = {
            label: (
                dims,
                values[:, 0] if angles is None else values,
                {"units": _XARRAY_UNITS.get(units[label], units[label])},
            )
            for label, values in self.table.items()
        }
        coords: dict[str, Any] = {
            "engine": list(self.names),
            "bank_angle_deg": (
                dims[-1],
                self._own_angles_deg if angles is None else angles,
                {"units": "degree"},
            ),
        }
        attributes: dict[str, Any] = {"rpm": self._sweep.fixed["rpm"]}
        attributes |= {"hold": self.hold} if self.hold else {}
        dataset: xr.Dataset = tables.xarray().Dataset(variables, coords, attributes)
        return dataset

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first objective over bank angle, the best marked; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        """
        from crankpin.plot import figures  # noqa: PLC0415 - matplotlib is imported when used

        return figures.ranking(self, ax)

    def _told(self, objectives: int | None = None) -> str:
        """Say what was ranked by, all or the first few objectives."""
        least = ", then ".join(each.words for each in self._objectives[:objectives])
        return f"{least}, {tables.value_text('rpm', self._sweep.fixed['rpm'])}"

    def _table(self, shown: int | None = None) -> tables.Table:
        choices = self.choices[:shown]
        rest = len(self) - len(choices)
        parts = [f"Ranked by {self._told()}", *([tables.HELD[self.hold]] if self.hold else [])]
        title = ", ".join(parts) + (f"; {len(choices)} of {len(self)}" if rest else "")
        heads = [f"{each.label} {each.unit}".strip() for each in self._objectives]
        labels = [(each.place, each.name, _several(each.bank_angles_deg)) for each in choices]
        rows = np.array([each.values for each in choices]).reshape(-1, len(heads))
        return tables.Table(title, ["place", "engine", "bank angle °", *heads], labels, rows)

    def __repr__(self) -> str:
        return self._table(SHOWN).text()

    def _repr_html_(self) -> str:
        return self._table(SHOWN_IN_NOTEBOOKS).html()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Ranking):
            return NotImplemented
        mine, theirs = ([*each._values, *_grid(each._sweep)] for each in (self, other))
        return self._key() == other._key() and all(
            np.array_equal(a, b, equal_nan=True) for a, b in zip(mine, theirs, strict=True)
        )

    def __hash__(self) -> int:
        return hash((self.engines, self.names, self.by))

    def _key(self) -> tuple[Any, ...]:
        swept = self._sweep
        asked = (swept.orders, dict(swept.fixed), swept._arguments)
        return (self.choices, self.engines, self.names, self._objectives, asked)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Ranking, (self._sweep, self._objectives, self._values, self.choices))


_XARRAY_UNITS = {"N·m": "N m", "°": "degree"}


# --- choosing -----------------------------------------------------------------------------------


def _chosen(
    swept: Sweep,
    objectives: Sequence[Objective],
    values: Sequence[NDArray[np.float64]],
    rtol: float,
    *,
    refine: bool,
) -> tuple[Choice, ...]:
    """Return each engine at its best angles, the best engine first."""
    tolerances = np.array([rtol * _largest(each) for each in values])
    names, grid = tables.engine_names(swept), _angles(swept)
    found: list[Choice] = []
    for k, engine in enumerate(swept.engines):
        rows = np.stack([each[k] for each in values], axis=1)
        angles = grid
        if refine and grid is not None:
            between = _dips(swept, engine, objectives[0], grid, rows[:, 0], float(tolerances[0]))
            if between.size:
                part = _part(swept, engine, between)
                more = [objective.values(part)[0] for objective in objectives]
                rows, angles = np.vstack([rows, np.transpose(more)]), np.append(grid, between)
        kept = _least(rows, tolerances)
        best = tuple(map(float, rows[kept].min(axis=0))) if kept.size else (np.inf,) * len(values)
        if angles is None:
            own = _own_angles([engine])
            where = tuple(own.tolist()) if kept.size and np.isfinite(own[0]) else ()
        else:
            where = tuple(sorted(set(angles[kept].tolist())))
            if where and swept.hold is not None:
                engine = engine.with_bank_angle(where[0], hold=swept.hold)  # noqa: PLW2901
        found.append(Choice(0, names[k], engine, where, best))
    rows = np.array([each.values for each in found])
    ranked: list[Choice] = []
    for group in _groups(rows, np.arange(len(found)), tolerances):
        place = len(ranked) + 1
        ranked += [dataclasses.replace(found[k], place=place) for k in group]
    return tuple(ranked)


def _least(rows: NDArray[np.float64], tolerances: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return which rows are least by the first column, of those by the second, and so on."""
    kept = np.flatnonzero(np.isfinite(rows).all(axis=1))
    for column, tolerance in zip(rows.T, tolerances, strict=True):
        if kept.size:
            kept = kept[column[kept] <= column[kept].min() + tolerance]
    return kept


def _groups(
    rows: NDArray[np.float64], which: NDArray[np.intp], tolerances: NDArray[np.float64]
) -> Iterator[list[int]]:
    """Yield rows that tie, the least first: each least of the rest stands for those near it."""
    rest = which
    while rest.size:
        tied = rest[_least(rows[rest], tolerances)]
        tied = tied if tied.size else rest  # nothing finite is left
        yield tied.tolist()
        rest = rest[~np.isin(rest, tied)]


def _largest(values: NDArray[np.float64]) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


# --- between the given angles -------------------------------------------------------------------

POINTS = 9
"""Angles at which a dip is looked at in each round, which leaves a quarter of it."""
NARROW = 1e-10
"""Degrees to which a dip with a point is followed."""
FLAT = 1e-14
"""Relative difference of values within a dip that rounding could be: its middle is taken."""
SAME = 1e-3
"""Degrees within which two dips are one, found from either side."""


def _dips(
    swept: Sweep,
    engine: Engine,
    objective: Objective,
    angles: NDArray[np.float64],
    values: NDArray[np.float64],
    tolerance: float,
) -> NDArray[np.float64]:
    """Return bank angles between the given ones at which the objective is lower than at them."""

    def at(where: NDArray[np.float64]) -> NDArray[np.float64]:
        found = objective.values(_part(swept, engine, where.ravel()))
        return np.where(np.isnan(found), np.inf, found).reshape(where.shape)

    angles, first = np.unique(angles, return_index=True)
    values = np.where(np.isnan(values), np.inf, values)[first]
    before, after = np.append(np.nan, values[:-1]), np.append(values[1:], np.nan)
    higher = (before > values + tolerance) | (after > values + tolerance)
    lower = (before < values) | (after < values)
    dips = np.flatnonzero(np.isfinite(values) & higher & ~lower)
    if not dips.size:
        return np.empty(0)
    low, high = angles[np.maximum(dips - 1, 0)], angles[np.minimum(dips + 1, angles.size - 1)]
    while (high - low).max() > NARROW:
        across = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, POINTS)
        heights = at(across)
        lowest, rows = heights.argmin(axis=1), np.arange(dips.size)
        low = across[rows, np.maximum(lowest - 1, 0)]
        high = across[rows, np.minimum(lowest + 1, POINTS - 1)]
        highest = np.abs(heights).max(axis=1)
        flat = np.isfinite(highest) & (heights.max(axis=1) <= heights.min(axis=1) + FLAT * highest)
        low[flat] = high[flat] = across[flat, POINTS // 2]
    middle = 0.5 * (low + high)
    # The roundest angle that is as good: 30 for 30.00000000001.
    rounded = np.stack([middle.round(digits) for digits in range(8)] + [middle], axis=1)
    rounded = np.clip(rounded, angles[0], angles[-1])
    heights = at(rounded)
    as_good = heights <= heights[:, -1:] + FLAT * np.abs(values[dips])[:, None]
    rows, chosen = np.arange(dips.size), as_good.argmax(axis=1)
    found, depths = rounded[rows, chosen], heights[rows, chosen]
    found = np.sort(found[depths < values[dips] - tolerance])
    return found[np.append(True, np.diff(found) > SAME)] if found.size else found


def _part(swept: Sweep, engine: Engine, angles: NDArray[np.float64]) -> Sweep:
    """Return the sweep of one engine at other angles."""
    rpm = swept.fixed["rpm"]
    how = swept._arguments | {"orders": swept.orders}
    part: Sweep = sweep([engine], rpm=rpm, bank_angle_deg=angles, **how)
    return part


# --- engines and angles -------------------------------------------------------------------------


def _engines(
    given: Engines | Arrangement | Sequence[Arrangement] | ArrangementSearch,
    cylinder: object,
    spacing: object,
) -> Engines:
    """Return engines, or those of arrangements."""
    if isinstance(given, ArrangementSearch) and len(given) > inputs.MOST_ITEMS:
        raise InputError(
            f"engines is a search with {len(given)} bank angles, more than {inputs.MOST_ITEMS}: "
            "give those of interest, such as its best(count=100) or within(60, 61)"
        )
    arrangements: list[Arrangement] = []
    if isinstance(given, Arrangement):
        arrangements = [given]
    elif isinstance(given, ArrangementSearch | Sequence):
        arrangements = [one for one in given if isinstance(one, Arrangement)]
    if not arrangements:
        for name, value in (("cylinder", cylinder), ("spacing", spacing)):
            if value is not None:
                cure = "is for arrangements; engines have theirs, leave it out"
                raise InputError(f"{name} = {inputs.shorten(value)}: {cure}")
        return cast("Engines", [given] if isinstance(given, Engine) else given)
    for name, value in (("cylinder", cylinder), ("spacing", spacing)):
        if value is None:
            raise InputError(f"{name} = None: arrangements need one, as Arrangement.engine does")
    return {
        f"arrangement {k}, {one.bank_angle_deg:.6g}°": one.engine(cylinder, spacing)  # type: ignore[arg-type]
        for k, one in enumerate(arrangements)
    }


def _angles(swept: Sweep) -> NDArray[np.float64] | None:
    """Return the bank angles of a sweep, if it has any."""
    angles = swept.coords.get("bank_angle_deg")
    return None if angles is None else np.asarray(angles)


def _grid(swept: Sweep) -> list[NDArray[np.float64]]:
    angles = _angles(swept)
    return [np.empty(0) if angles is None else angles]


def _own_angles(engines: Sequence[Engine]) -> NDArray[np.float64]:
    """Return the engines' bank angles, NaN where there are not two banks."""
    found = np.full(len(engines), np.nan)
    for k, engine in enumerate(engines):
        with contextlib.suppress(InputError):
            found[k] = engine.bank_angle_deg
    return found


def _several(angles: tuple[float, ...]) -> str:
    """Return a few angles as text."""
    shown = ", ".join(f"{angle:.8g}" for angle in angles[:MOST_ANGLES])
    rest = len(angles) - MOST_ANGLES
    return f"{shown} and {rest} more" if rest > 0 else shown or "–"
