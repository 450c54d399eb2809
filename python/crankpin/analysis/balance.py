"""Force, moment and torque of an engine at one speed, order by order."""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.tables import Shown, Table
from crankpin.analysis import export
from crankpin.analysis.by_order import AllOrders
from crankpin.analysis.drawing import draw
from crankpin.analysis.request import Request, check_quantities, check_request, engine_core
from crankpin.analysis.source import ErrorBound, Source, shown_orders

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.model.engine import Engine


UNIT_RPM = 30.0 / math.pi
"""Crank speed at which ω is 1 rad/s."""


def balance(
    engine: Engine,
    rpm: float,
    *,
    orders: Orders = "auto",
    rtol: float | None = None,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
) -> Balance:
    """Return the balance of an engine; :meth:`Engine.balance` documents the arguments."""
    request = Request.checked(
        orders=orders, rtol=rtol, reference_z=reference_z, spectrum=spectrum, torque=torque
    )
    found = Balance(engine, inputs.number("rpm", rpm), request)
    inputs.warn_of_units(mean_piston_speed(engine, found.rpm))
    return found


def over_square(
    engine: Engine, orders: Sequence[int], reference_z: float | None = None, *, torque: bool = False
) -> Balance:
    """Return the balance over ω²: forces in kg·m, moments and torques in kg·m²."""
    return balance(engine, UNIT_RPM, orders=orders, reference_z=reference_z, torque=torque)


def at_orders(whole: Balance, orders: Sequence[int]) -> Balance:
    """Return the same balance at the orders given."""
    request = dataclasses.replace(whole.request, orders=tuple(orders))
    return Balance(whole.engine, whole.rpm, request)


def mean_piston_speed(engine: Engine, rpm: float) -> float:
    """Return the largest mean piston speed of any cylinder, m/s."""
    return 4.0 * engine_core(engine).largest_crank_radius * rpm / 60.0


class BalanceArrays(Source):
    """Arrays of a balance."""

    _fields: ClassVar[tuple[str, ...]] = ("engine", "rpm", "request")

    def __init__(self, engine: Engine, rpm: float, request: Request) -> None:
        check_request(request, "Engine.balance")
        core = _core.balance(
            engine_core(engine),
            rpm,
            request.listed_orders,
            request.rtol,
            request.reference_z,
            request.listed_spectrum,
            request.torque,
        )
        self._set(
            engine=engine,
            rpm=rpm,
            request=request,
            orders=tuple(core.orders),
            omitted=tuple(core.omitted),
            _core=core,
        )

    omitted: tuple[int, ...]
    _core: _core.Balance

    @cached_property
    def error_bound(self) -> ErrorBound:
        """Bounds on what the omitted orders add."""
        return error_bound(self._core, torque_known="torque" in self.request.quantities)

    def _turning(self, quantity: str) -> NDArray[np.complex128]:
        core = self._core
        return np.stack([core.forward(quantity), core.backward(quantity)], axis=-1)

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        core, planar = self._core, quantity in PLANE_VECTORS
        read: dict[str, Callable[[], Any]] = {
            "zero_bound": lambda: core.zero_bound(quantity if planar else "torque"),
            "peak_xy": lambda: np.abs(self.read(quantity, "phasors")),
        }
        if planar:
            read |= {
                "phasors": lambda: core.xy(quantity),
                "peak": lambda: np.abs(self._turning(quantity)).sum(axis=-1),
                "total_peak": lambda: np.array(core.sum_peak_vector(quantity)),
                "total_peak_xy": lambda: core.sum_peak_xy(quantity),
            }
        else:
            on_crank = quantity == "crank_torque"
            read |= {
                "phasors": core.crank_torque if on_crank else core.roll_torque,
                "peak": read["peak_xy"],
                "total_peak": lambda: np.array(core.torque_sum_peak(on_crank)),
            }
        found: NDArray[Any] = read[what]()
        return found


def error_bound(core: _core.Balance, *, torque_known: bool) -> ErrorBound:
    """Return the bounds on what the omitted orders add."""
    force, moment = core.error_bound("force"), core.error_bound("moment")
    return ErrorBound(force, moment, core.error_bound("torque") if torque_known else None)


class Balance(AllOrders, Shown):
    """Force, moment and torque of an engine at one speed, order by order.

    ``force`` and ``moment`` are :class:`~crankpin.types.PlaneVector`, ``torque`` and
    ``crank_torque`` :class:`~crankpin.types.Scalar`: arrays of complex peak phasors, orders first.
    ``balance[2]`` is one order, ``balance.total`` all orders together. Sums that vanish are exactly
    zero: a phasor below its ``zero_bound``, the largest rounding error of such a sum, is reported
    as zero.

    Made by :meth:`Engine.balance`.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("v8-crossplane").balance(rpm=6000, orders=[1, 2, 4])
    >>> b.orders
    (1, 2, 4)
    >>> float(abs(b.force[:2]).max())
    0.0
    >>> b[1].moment.ellipse.minor == b[1].moment.ellipse.major  # a circle
    True
    >>> round(b.total.moment.peak) == round(b[1].moment.peak)  # of the orders given
    True
    """

    _fields: ClassVar[tuple[str, ...]] = ("engine", "rpm", "request")

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    request: Request
    """The options of the balance, checked."""

    def __init__(self, engine: Engine, rpm: float, request: Request) -> None:
        source = BalanceArrays(engine, rpm, request)
        self._set(engine=engine, rpm=rpm, request=request, source=source)

    source: BalanceArrays

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m."""
        plane = self.request.reference_z
        return self.engine.reference_z if plane is None else plane

    @property
    def spectrum(self) -> Spectrum | None:
        """Spectrum used in place of the slider-crank's harmonics, kg·m, or None."""
        return self.request.spectrum

    @property
    def omitted(self) -> tuple[int, ...]:
        """With ``orders="auto"``: orders that were left out although they are not zero.

        All orders above add less than 1e-17 of the quantity that ``rtol`` is relative to;
        ``error_bound`` includes them.
        """
        return self.source.omitted

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self, *quantities: str) -> pd.DataFrame:
        """Return a tidy table, one row an order, quantity and component (needs pandas).

        Columns are order, quantity, component, real and imag (the peak phasor), peak and unit.

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
        """
        return export.to_pandas(self.source, self._named(quantities), {})

    def to_xarray(self, *quantities: str, split_complex: bool = False) -> xr.Dataset:
        """Return phasors, peaks, totals and bounds with dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
        split_complex
            Store complex arrays as real ones with a dimension ``part`` of "re" and "im". netCDF
            needs it: ``balance.to_xarray(split_complex=True).to_netcdf(path)``.
        """
        attributes = {
            "engine": self.engine.name, "rpm": self.rpm, "reference_z": self.reference_z,
        }  # fmt: skip
        names = self._named(quantities)
        return export.to_xarray(self.source, names, {}, attributes, split_complex=split_complex)

    def _named(self, quantities: tuple[str, ...]) -> tuple[str, ...]:
        return check_quantities(quantities, self.request.quantities)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        figure: Figure | SubFigure | None = None,
        kind: str = "spectrum",
        quantity: str = "moment",
        **options: Any,  # noqa: ANN401 - as below
    ) -> Any:  # noqa: ANN401 - axes, or an array of axes
        """Draw the orders; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones. ``"ellipses"`` draws all orders on them.
        figure
            Figure or SubFigure for the panels of ``"ellipses"`` or ``"phasors"``; by default a new
            one.
        kind
            ``"spectrum"``: peaks along (about) x and y over order, exact zeros as hollow circles;
            ``"ellipses"``: the ellipse that force or moment traces in each of the four largest
            orders, with its direction and, as a dot, the place at θ = 0; ``"phasors"``: what
            cylinders, counterweights and shafts add to each order, head to tail, and their sum.
        quantity
            ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``.
        **options
            ``log=True`` for a logarithmic spectrum; ``orders=`` of phasors, by default those given
            to the balance, or else 1 and 2; ``label``, for a legend of several results on
            the same axes; colour, line width and other properties of matplotlib lines.

        Returns
        -------
        matplotlib.axes.Axes, or numpy.ndarray of them
            The axes; of ``"ellipses"`` without ``ax``, and of ``"phasors"``, an array of panels.

        Raises
        ------
        InputError
            If ``ax`` and ``figure`` are both given, or there is no such picture of the quantity.

        Examples
        --------
        >>> import crankpin as cp
        >>> b = cp.Engine.preset("v6-60").balance(rpm=6000)
        >>> ax = b.plot(quantity="torque", log=True, color="black")
        >>> b.plot(kind="ellipses").shape
        (2, 2)
        """
        return draw(self, ax, figure=figure, kind=kind, quantity=quantity, **options)

    @property
    def table(self) -> Table:
        """Table that is shown: peaks by order, negligible orders left out."""
        names = [name for name in self.request.quantities if name != "crank_torque"]
        shown, left_out = shown_orders(self.source, *names)
        header = ["order"]
        columns = []
        for name in names:
            header += [f"{symbol} {QUANTITIES[name].unit}" for symbol in QUANTITIES[name].symbols]
            peaks = self.source.read(name, "peak_xy" if name in PLANE_VECTORS else "peak")
            columns.append(peaks.reshape(len(self.orders), -1))
        rows = np.hstack(columns)[list(shown)].reshape(-1, len(header) - 1)
        given = " of the orders given" if self.request.orders is not None else ""
        engine = labels.name_of(self.engine)
        title = f"{engine} at {self.rpm:g} rpm: peaks{given}"
        names = [f"{self.orders[place]}" for place in shown]
        return Table.from_rows(title, header, names, rows, note=labels.not_shown(left_out))
