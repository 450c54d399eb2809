"""Samples of an engine whose parts deviate, and their statistics."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, units
from crankpin._support import progress as progress_bar
from crankpin._support.parameters import documented
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.record import changed, read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import Balance
from crankpin.analysis.by_order import ByOrder
from crankpin.analysis.export import VALUES
from crankpin.analysis.labelled import total_peaks
from crankpin.analysis.ranking import objectives
from crankpin.analysis.request import check_request, engine_core
from crankpin.analysis.tolerances.spreads import (
    FIGURES,
    OF_PINS,
    Distribution,
    Spreads,
    deviating,
    deviations,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress
    from crankpin.analysis.ranking.objectives import Objective
    from crankpin.analysis.request import Request
    from crankpin.model.engine import Engine

QUANTILES = (0.05, 0.5, 0.95)
"""Quantiles that tables and pictures show."""


def names_of(by: object, request: Request) -> tuple[str, ...]:
    """Return the names of what tables and pictures show."""
    if by is None:
        torque = ["total.torque.peak"] if request.torque else []
        first = [
            f"[1].{quantity}.{part}"
            for quantity in ("force", "moment")
            for part in ("forward", "backward")
        ]
        named = ["total.force.peak", "total.moment.peak", *torque]
        return (*named, *(first if 1 in (request.orders or ()) else []))
    names = tuple(objective.label for objective in objectives.listed(by))
    for name in names:
        _checked(name, request)
    return names


def _checked(name: str, request: Request) -> Objective:
    """Return an objective that has a value for each sample."""
    objective = objectives.named(name)
    if objective.of_sweep is None:
        named = ", ".join(f'"{example}"' for example in objectives.COMMON[:3])
        hint = f"has no value for each sample; give names such as {named}"
        raise inputs.rejected("by", name, hint)
    if objective.order is not None and objective.order not in (request.orders or ()):
        hint = f'by = "{name}" needs order {objective.order}'
        raise inputs.rejected("orders", list(request.orders or ()), hint)
    if "torque" in name:
        request.check("torque")
    return objective


class Tolerances(ByOrder["NDArray[np.float64]"]):
    """Samples of an engine whose parts deviate: force, moment and torque, order by order.

    The quantities are those of a balance with the dimension ``sample`` first: ``t.force.peak`` is
    (n_samples, n_orders), ``t[1].moment.backward`` and ``t.total.moment.peak`` are (n_samples,).

    Made by :func:`crankpin.tolerances`.

    Examples
    --------
    >>> import crankpin as cp
    >>> v6 = cp.Engine.preset("v6-60")
    >>> t = cp.tolerances(v6, rpm=6000, orders=[1, 2], reciprocating_mass=0.002, samples=500)
    >>> t.force.shape, t[1].moment.backward.shape, t.total.moment.peak.shape
    ((500, 2, 2), (500,), (500,))
    >>> t.draws("reciprocating_mass").shape
    (500, 6)
    >>> b = t.engine_at(7).balance(rpm=6000, orders=[1, 2])
    >>> bool(abs(b.moment.peak - t.moment.peak[7]).max() < 1e-9)
    True
    """

    engine: Engine
    """The nominal engine."""
    rpm: float
    """Crank speed, rpm."""
    figures: Spreads
    """Deviating figures, checked."""
    samples: int
    """Number of samples."""
    seed: int
    """Seed of the random numbers."""
    _request: Request
    """The options of the samples, checked."""
    bounds: tuple[float, float, float]
    """Bounds on what omitted orders add to force, moment and torque of the nominal engine."""
    by: tuple[str, ...]
    """Names of what tables and pictures show."""

    def __post_init__(self) -> None:
        if not isinstance(self.figures, Spreads):
            raise inputs.rejected("figures", self.figures, "use crankpin.tolerances")
        check_request(self._request, "crankpin.tolerances")

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return self._request.orders or ()

    @property
    def omitted(self) -> tuple[int, ...]:
        """Orders of the nominal engine that were left out: empty, those of samples are chosen."""
        return ()

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → upper bound on what omitted orders add to the nominal engine, N or N·m."""
        return self._request.bounds(self.bounds)

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the number of each sample."""
        return {"sample": read_only(np.arange(self.samples))}

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset: engine, speed, seed and spreads."""
        return {
            "engine": self.engine.name, "rpm": self.rpm, "seed": self.seed,
            "spreads": self.figures.text,
        }  # fmt: skip

    @property
    def _engines(self) -> tuple[Engine, ...]:
        return (self.engine,)

    def _with_request(self, request: Request) -> Tolerances:
        """Raise an InputError: samples have the orders and the plane that were given."""
        orders = check_request(request, "crankpin.tolerances").orders
        if orders == self._request.orders:
            hint = "moments of samples are; give the tolerances of engine.replace(reference_z=…)"
            raise inputs.faulty("point", "is not in the engine's plane", hint)
        orders_text = labels.orders_text(self.orders)
        raise inputs.rejected(
            "orders", orders, f"is not among those of the samples ({orders_text})"
        )

    @property
    def spreads(self) -> Mapping[str, tuple[float, ...]]:
        """Figure → its spread in each cylinder or crankpin, of those that were given."""
        values = self.figures.values
        return {name: draws for name, draws in zip(FIGURES, values, strict=True) if draws}

    @property
    def distribution(self) -> Distribution:
        """``"normal"`` or ``"uniform"``."""
        return self.figures.distribution

    @property
    def pins(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the cylinders on each crankpin."""
        return self.figures.pins

    @cached_property
    def nominal(self) -> Balance:
        """Balance of the nominal engine, of the same orders."""
        return Balance(self.engine, self.rpm, self._request)

    @property
    def causes(self) -> tuple[str, ...]:
        """None: samples do not separate the causes of a quantity."""
        return ()

    def _readings(self, quantity: str) -> tuple[str, ...]:
        return tuple(reading for reading in super()._readings(quantity) if reading != "cycle_mean")

    @property
    def _has_means(self) -> bool:
        """False: spreads are of harmonics, and means have none."""
        return False

    # --- arrays ---------------------------------------------------------------------------------

    @cached_property
    def _core(self) -> _core.Tolerances:
        """Compiled counterpart."""
        return _core.Tolerances(
            engine_core(self.engine),
            self.rpm,
            list(self.orders),
            self._request.reference_z,
            self._request.torque,
            self.figures.values,
            self.figures.distribution,
            self.figures.pin_of,
            self.samples,
        )

    @cached_property
    def _deviations(self) -> dict[str, NDArray[np.float64]]:
        """Figure → its deviations: (n_samples, n_items); empty where it does not spread."""
        return deviations(self.figures, self.samples, self.seed)

    def evaluate(self, progress: Progress = False) -> None:
        """Evaluate the samples now.

        Parameters
        ----------
        progress : bool or callable, default False
            True for a tqdm bar, or a function that is called with the steps done and the steps
            in all.
        """
        core = self._core  # which checks the size of the result, before anything is drawn
        drawn = list(self._deviations.values())
        with progress_bar.shown(progress, "tolerances") as report:
            force, moment, torques, peaks = core.sample(self.samples, drawn, report)
        vars(self)["_drawn"] = {"force": force, "moment": moment}, torques, peaks

    @cached_property
    def _drawn(
        self,
    ) -> tuple[dict[str, NDArray[np.complex128]], NDArray[np.complex128], NDArray[np.float64]]:
        """Force and moment, both torques, and peaks of all orders together."""
        self.evaluate()
        return vars(self)["_drawn"]  # type: ignore[no-any-return]

    def _about_axis(self, quantity: str, what: str) -> NDArray[Any]:
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
            along = [total_peaks(self.orders, phasors[..., axis]) for axis in (0, 1)]
            return np.stack(along, axis=-1)
        if what == "peak" and planar:
            return np.asarray(np.abs(vectors[quantity][..., 2:]).sum(axis=-1))
        return phasors if what == VALUES else np.asarray(np.abs(phasors))

    # --- statistics -----------------------------------------------------------------------------

    def sample_values(self, by: str | None = None) -> NDArray[np.float64]:
        """Return a value of each sample, N or N·m: (n_samples,).

        Parameters
        ----------
        by : str, optional
            A name as in :func:`crankpin.rank`; by default the first of ``by``.

        Returns
        -------
        ndarray of float, shape (n_samples,)
            Values, N or N·m.

        Raises
        ------
        InputError
            If there is no such objective.
        """
        return _read(self._objective(by), self)

    @documented(sample_values)
    def nominal_value(self, by: str | None = None) -> float:
        """Return the same of the nominal engine, N or N·m.

        Returns
        -------
        float
            Value, N or N·m.

        Raises
        ------
        InputError
            If there is no such objective.
        """
        return float(_read(self._objective(by), self.nominal))

    @documented(sample_values)
    def mean_value(self, by: str | None = None) -> float:
        """Return the mean of :meth:`sample_values`.

        Returns
        -------
        float
            Mean, N or N·m.

        Raises
        ------
        InputError
            If there is no such objective.
        """
        values = self.sample_values(by)
        # Equal values are their mean, to the last digit.
        return float(values[0] + (values - values[0]).mean())

    @documented(sample_values)
    def std(self, by: str | None = None) -> float:
        """Return the standard deviation of :meth:`sample_values`.

        Returns
        -------
        float
            Standard deviation, N or N·m.

        Raises
        ------
        InputError
            If there is no such objective.
        """
        values = self.sample_values(by)
        return float((values - values[0]).std())

    @documented(sample_values)
    def quantile(self, q: ArrayLike = QUANTILES, by: str | None = None) -> Any:  # noqa: ANN401
        """Return quantiles of :meth:`sample_values`, of the shape of ``q``.

        Parameters
        ----------
        q : array_like, optional
            Parts of the samples below, 0 to 1; by default 0.05, 0.5 and 0.95.

        Returns
        -------
        float or ndarray of float, shape of q
            Quantiles, N or N·m.

        Raises
        ------
        InputError
            If a part is not from 0 to 1, or there is no such objective.
        """
        parts = inputs.array("q", q)
        if not ((parts >= 0.0) & (parts <= 1.0)).all():
            raise inputs.rejected("q", q, "give numbers from 0 to 1")
        quantiles: NDArray[np.float64] = np.quantile(self.sample_values(by), parts.ravel())
        return quantiles.reshape(parts.shape)[()]

    @cached_property
    def shares(self) -> Table:
        """Share of each tolerance in the variance of each of ``by``, in percent."""
        return self.shares_of(self.by)

    def shares_of(self, by: str | Sequence[str]) -> Table:
        """Return the share of each tolerance in the variance of some values, in percent.

        The samples are evaluated once more with each figure alone deviating as it did. A share is
        the variance that it makes by itself over that of all together. Shares add up to 100 % less
        the interaction, which is near zero where values are linear in the deviations, or grow as
        the root of their squares; zero where nothing varies.

        Parameters
        ----------
        by : str or sequence of str
            Names as in :func:`crankpin.rank`.

        Returns
        -------
        Table
            A row for each value, a column for each figure, per cent.

        Raises
        ------
        InputError
            If there is no such objective.

        Examples
        --------
        >>> import crankpin as cp
        >>> t = cp.tolerances(
        ...     cp.Engine.preset("i6"), rpm=6000, reciprocating_mass=0.002, pin_deg=0.1,
        ...     samples=2000,
        ... )
        >>> shares = t.shares_of("[1].force.forward")
        >>> [column.name for column in shares.columns[1:]]
        ['reciprocating mass', 'crankpin angle', 'interaction']
        >>> abs(shares["interaction"].values[0]) < 5  # %
        True
        """
        named = names_of(by, self._request)
        figures = self.figures.given
        total = np.array([self.std(name) ** 2 for name in named])
        parts = [changed(self, figures=self.figures.only(figure), by=named) for figure in figures]
        variances = np.array([[part.std(name) ** 2 for part in parts] for name in named])
        varies = total > 0.0
        rows = 100.0 * variances / np.where(varies, total, 1.0)[:, None]
        rest = np.where(varies, 100.0 - rows.sum(axis=1), 0.0)
        heads = [*(labels.TOLERANCES[figure][0] for figure in figures), "interaction"]
        return Table.from_rows(
            "Share of each tolerance in the variance",
            ["", *((head, "%") for head in heads)],
            named,
            np.column_stack([rows, rest]),
            decimals=1,
        )

    # --- samples --------------------------------------------------------------------------------

    def draws(self, name: str) -> NDArray[np.float64]:
        """Return the deviations of a figure in each sample.

        Parameters
        ----------
        name : str
            A figure, such as ``"reciprocating_mass"`` or ``"pin_deg"``.

        Returns
        -------
        ndarray of float, shape (n_samples, n_cylinders) or (n_samples, n_pins)
            Deviations, kg, m or degrees.

        Raises
        ------
        InputError
            If there is no such figure.
        """
        drawn = self._deviations[inputs.one_of("name", name, FIGURES)]
        items = len(self.pins) if name in OF_PINS else len(self.engine)
        return drawn if drawn.size else np.broadcast_to(0.0, (self.samples, items))

    def engine_at(self, sample: int) -> Engine:
        """Return the engine of a sample; moments of its own are about its own middle.

        A rotating mass that deviates below zero is an unbalance opposite its crankpin.

        Parameters
        ----------
        sample : int
            Number of the sample, from 0.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If there is no such sample.
        """
        k = inputs.whole("sample", sample)
        if not 0 <= k < self.samples:
            raise inputs.rejected("sample", k, f"give a number from 0 to {self.samples - 1}")
        pin_of = self.figures.pin_of
        by_name = {name: self.draws(name)[k] for name in FIGURES}
        radius, turn = by_name["crank_radius"][pin_of], by_name["pin_deg"][pin_of]
        cylinders = [
            cylinder.replace(
                crank_radius=cylinder.crank_radius + float(radius[i]),
                rod_length=cylinder.rod_length + float(by_name["rod_length"][i]),
                reciprocating_mass=cylinder.reciprocating_mass
                + float(by_name["reciprocating_mass"][i]),
            )
            for i, cylinder in enumerate(self.engine.cylinders)
        ]
        # As text an angle beside a part of a turn is meant.
        turned = [repr(float(angle)) for angle in self.engine.pin_deg + turn]
        return deviating(
            self.engine,
            cylinders,
            self.engine.rotating_mass + by_name["rotating_mass"],
            pin_deg=turned if turn.any() else None,
            z=self.engine.z + by_name["z"],
            name=f"{self.engine.name}, sample {k}".lstrip(", "),
        )

    # --- tables and pictures --------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Table that is shown: nominal value, mean, spread and quantiles."""
        header = ["", "unit", "nominal", "mean", "std"]
        header += [f"{100 * q:g} %" for q in QUANTILES]
        rows = []
        for by in self.by:
            figures = (self.nominal_value(by), self.mean_value(by), self.std(by))
            rows.append((by, self._objective(by).unit, *figures, *self.quantile(by=by).tolist()))
        engine = labels.name_of(self.engine)
        title = units.Text(
            f"{engine} at {self.rpm:g} rpm: {self.samples} samples, ", self.figures.text
        )
        of_torque = any("torque" in self._objective(by).quantity for by in self.by)
        return Table.from_rows(
            title,
            header,
            rows,
            loads=self.loads_counted if of_torque else "",
            row_units=[self._objective(by).unit for by in self.by],
        )

    def _objective(self, by: str | None) -> Objective:
        name = self.by[0] if by is None else inputs.text("by", by)
        return _checked(name, self._request)


def _read(objective: Objective, result: Any) -> NDArray[np.float64]:  # noqa: ANN401 - see below
    """Return what an objective reads off samples, or off a balance: quantities are the same."""
    assert objective.of_sweep is not None  # noqa: S101 - checked
    return objective.of_sweep(result)
