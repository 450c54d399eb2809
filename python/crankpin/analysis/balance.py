"""How an engine shakes, order by order."""

from __future__ import annotations

import dataclasses
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from crankpin import _core
from crankpin._support import inputs, tables
from crankpin._support.frozen import Frozen

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.model.engine import Engine


class Ellipse(NamedTuple):
    """What force or moment traces in one order: half axes and the direction of the long one."""

    major: Any
    """Longest half axis."""
    minor: Any
    """Shortest half axis; below zero where the vector turns against the crank."""
    tilt_deg: Any
    """Direction of the long axis from +x, in (−90, 90]; 0 for a circle."""


class ErrorBound(NamedTuple):
    """What orders left out can add to the length of a vector at any crank angle."""

    force: float
    """N."""
    moment: float
    """N·m."""
    torque: float | None
    """N·m; None where torque was not asked for, or a spectrum of forces tells nothing of it."""


@dataclasses.dataclass(frozen=True, eq=False)
class OrderBalance:
    """One order of a :class:`Balance`; complex peak phasors."""

    order: int
    force: NDArray[np.complex128]
    """Along x and y, N: (2,)."""
    moment: NDArray[np.complex128]
    """About x (pitch) and y (yaw), N·m: (2,)."""
    forward_force: complex
    backward_force: complex
    forward_moment: complex
    backward_moment: complex
    force_ellipse: Ellipse
    moment_ellipse: Ellipse

    def __post_init__(self) -> None:
        for array in (self.force, self.moment):
            array.setflags(write=False)

    def __reduce__(self) -> tuple[Any, ...]:
        values = (getattr(self, field.name) for field in dataclasses.fields(self))
        return (OrderBalance, tuple(values))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, OrderBalance):
            return NotImplemented
        pairs = (
            (getattr(self, field.name), getattr(other, field.name))
            for field in dataclasses.fields(self)
        )
        return all(np.array_equal(mine, theirs) for mine, theirs in pairs)

    def __hash__(self) -> int:
        return hash((self.order, self.forward_force, self.forward_moment))


class Balance(Frozen):
    """How an engine shakes at one speed: complex peak phasors, order by order.

    A quantity of order n is ``Re(P exp(inθ))``. In the cross-section, force and moment are
    ``x + iy = forward exp(inθ) + backward exp(−inθ)``: what turns with the crank, which a
    counterweight can cancel at order 1, and what turns against it. Sums that vanish are exactly
    zero: they are reported so when below ``force_zero_bound`` and its companions, what rounding
    can leave of them.

    Made by :meth:`Engine.balance`.

    Examples
    --------
    >>> import crankpin as cp
    >>> b = cp.Engine.preset("v8-crossplane").balance(rpm=6000, orders=[1, 2, 4])
    >>> b.orders
    (1, 2, 4)
    >>> bool(abs(b.force[:2]).max() == 0)
    True
    >>> b.order(1).moment_ellipse.minor == b.order(1).moment_ellipse.major  # a circle
    True
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed."""
    reference_z: float
    """Plane about which moments are taken, m."""
    spectrum: Spectrum | None
    """What stood in for the slider-cranks."""

    def __init__(
        self,
        core: _core.Balance,
        engine: Engine,
        rpm: float,
        reference_z: float | None,
        spectrum: Spectrum | None,
        how: Mapping[str, Any],
    ) -> None:
        if not isinstance(core, _core.Balance):
            raise _core.InputError(f"Balance({inputs.shorten(core)}): use Engine.balance")
        plane = engine.reference_z if reference_z is None else reference_z
        frozen = None if spectrum is None else MappingProxyType(dict(spectrum))
        self._set(
            _core=core, engine=engine, rpm=rpm, reference_z=plane, spectrum=frozen, _how=dict(how)
        )

    _core: _core.Balance
    _how: dict[str, Any]
    """Whether torque was asked for; the tolerance by which orders were chosen, if they were."""

    # --- phasors --------------------------------------------------------------------------------

    @cached_property
    def orders(self) -> tuple[int, ...]:
        """Multiples of crank speed."""
        return tuple(self._core.orders)

    @cached_property
    def omitted(self) -> tuple[int, ...]:
        """With ``orders="auto"``: orders left out that are not zero, until the rest is negligible.

        All orders above add less than 1e-17 of what ``rtol`` is relative to; ``error_bound`` has
        them in it.
        """
        return tuple(self._core.omitted)

    @property
    def error_bound(self) -> ErrorBound:
        """With ``orders="auto"``: what all orders left out can add at any crank angle.

        Rounding is not in it: sums that vanish to within ``force_zero_bound`` count as zero.
        """
        return error_bound(self._core, torque_known=self._has_torque)

    @property
    def _has_torque(self) -> bool:
        return self.spectrum is None and bool(self._how["torque"])

    def _need_torque(self) -> None:
        if not self._has_torque:
            raise no_torque(by_spectrum=self.spectrum is not None)

    @cached_property
    def force(self) -> NDArray[np.complex128]:
        """Shaking force along x and y, N: (n_orders, 2)."""
        return self._core.xy("force")

    @cached_property
    def moment(self) -> NDArray[np.complex128]:
        """Rocking moment about x (pitch) and y (yaw), N·m: (n_orders, 2)."""
        return self._core.xy("moment")

    @cached_property
    def torque(self) -> NDArray[np.complex128]:
        """Roll torque of the inertia forces on the block about +z, N·m: (n_orders,).

        InputError where it was not asked for, or a spectrum of forces tells nothing of it.
        """
        self._need_torque()
        return self._core.roll_torque()

    @cached_property
    def crank_torque(self) -> NDArray[np.complex128]:
        """Torque of the inertia forces on the crank about +z, N·m: (n_orders,)."""
        self._need_torque()
        return self._core.crank_torque()

    @cached_property
    def forward_force(self) -> NDArray[np.complex128]:
        """Part of the force that turns with the crank, N: (n_orders,)."""
        return self._core.forward("force")

    @cached_property
    def backward_force(self) -> NDArray[np.complex128]:
        """Part of the force that turns against the crank, N: (n_orders,)."""
        return self._core.backward("force")

    @cached_property
    def forward_moment(self) -> NDArray[np.complex128]:
        """Part of the moment that turns with the crank, N·m: (n_orders,)."""
        return self._core.forward("moment")

    @cached_property
    def backward_moment(self) -> NDArray[np.complex128]:
        """Part of the moment that turns against the crank, N·m: (n_orders,)."""
        return self._core.backward("moment")

    @cached_property
    def force_zero_bound(self) -> NDArray[np.float64]:
        """What rounding can leave of a force that vanishes, N: (n_orders,)."""
        return self._core.zero_bound("force")

    @cached_property
    def moment_zero_bound(self) -> NDArray[np.float64]:
        """What rounding can leave of a moment that vanishes, N·m: (n_orders,)."""
        return self._core.zero_bound("moment")

    @cached_property
    def torque_zero_bound(self) -> NDArray[np.float64]:
        """What rounding can leave of a torque that vanishes, N·m: (n_orders,)."""
        self._need_torque()
        return self._core.zero_bound("torque")

    # --- peaks ----------------------------------------------------------------------------------

    @cached_property
    def force_peak_xy(self) -> NDArray[np.float64]:
        """Largest force of each order along x and along y, N: (n_orders, 2)."""
        return _read_only(np.abs(self.force))

    @cached_property
    def moment_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment of each order about x and about y, N·m: (n_orders, 2)."""
        return _read_only(np.abs(self.moment))

    @cached_property
    def torque_peak(self) -> NDArray[np.float64]:
        """Largest roll torque of each order, N·m: (n_orders,)."""
        return _read_only(np.abs(self.torque))

    @cached_property
    def force_ellipse(self) -> Ellipse:
        """Ellipses that the force traces, each field (n_orders,)."""
        return _ellipse(self.forward_force, self.backward_force)

    @cached_property
    def moment_ellipse(self) -> Ellipse:
        """Ellipses that the moment traces, each field (n_orders,)."""
        return _ellipse(self.forward_moment, self.backward_moment)

    @property
    def force_peak_vector(self) -> NDArray[np.float64]:
        """Longest force of each order, N: (n_orders,)."""
        return self.force_ellipse.major  # type: ignore[no-any-return]

    @property
    def moment_peak_vector(self) -> NDArray[np.float64]:
        """Longest moment of each order, N·m: (n_orders,)."""
        return self.moment_ellipse.major  # type: ignore[no-any-return]

    @cached_property
    def force_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest force along x and along y of all orders together, N: (2,); true extrema."""
        return self._core.sum_peak_xy("force")

    @cached_property
    def moment_sum_peak_xy(self) -> NDArray[np.float64]:
        """Largest moment about x and about y of all orders together, N·m: (2,); true extrema."""
        return self._core.sum_peak_xy("moment")

    @cached_property
    def force_sum_peak_vector(self) -> float:
        """Longest force of all orders together, N; a true extremum."""
        return self._core.sum_peak_vector("force")

    @cached_property
    def moment_sum_peak_vector(self) -> float:
        """Longest moment of all orders together, N·m; a true extremum."""
        return self._core.sum_peak_vector("moment")

    @cached_property
    def torque_sum_peak(self) -> float:
        """Largest roll torque of all orders together, N·m; a true extremum."""
        self._need_torque()
        return self._core.torque_sum_peak()

    def order(self, order: int) -> OrderBalance:
        """Return one order.

        Raises
        ------
        InputError
            If the order was not asked for.
        """
        if not isinstance(order, (int, np.integer)) or order not in self.orders:
            listed = ", ".join(map(str, self.orders))
            raise _core.InputError(
                f"order = {inputs.shorten(order)}: this balance has orders {listed}"
            )
        k = self.orders.index(order)
        return OrderBalance(
            order=int(order),
            force=self.force[k].copy(),
            moment=self.moment[k].copy(),
            forward_force=complex(self.forward_force[k]),
            backward_force=complex(self.backward_force[k]),
            forward_moment=complex(self.forward_moment[k]),
            backward_moment=complex(self.backward_moment[k]),
            force_ellipse=Ellipse(*(float(axis[k]) for axis in self.force_ellipse)),
            moment_ellipse=Ellipse(*(float(axis[k]) for axis in self.moment_ellipse)),
        )

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self) -> pd.DataFrame:
        """Return the complex peak phasors as a table, one row an order (needs pandas)."""
        pandas = tables.pandas()
        columns = {
            "force_x": self.force[:, 0],
            "force_y": self.force[:, 1],
            "moment_x": self.moment[:, 0],
            "moment_y": self.moment[:, 1],
        }
        if self._has_torque:
            columns["torque"] = self.torque
        table: pd.DataFrame = pandas.DataFrame(
            columns, index=pandas.Index(self.orders, name="order")
        )
        return table

    def to_xarray(self) -> xr.Dataset:
        """Return the complex peak phasors with named dimensions and units (needs xarray)."""
        variables: dict[str, Any] = {
            "force": (("order", "axis"), self.force, {"units": "N"}),
            "moment": (("order", "axis"), self.moment, {"units": "N m"}),
        }
        if self._has_torque:
            variables["torque"] = (("order",), self.torque, {"units": "N m"})
        coords = {
            "order": ("order", list(self.orders), {"units": "1/rev"}),
            "axis": ("axis", ["x", "y"]),
        }
        attributes = {"engine": self.engine.name, "rpm": self.rpm, "reference_z": self.reference_z}
        dataset: xr.Dataset = tables.xarray().Dataset(variables, coords, attributes)
        return dataset

    def plot(self, ax: Axes | None = None, *, quantity: str = "moment") -> Axes:
        """Draw the peaks of each order along (about) x and y as bars; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.
        """
        from crankpin.plot import figures  # noqa: PLC0415 - matplotlib is imported when used

        return figures.balance(self, ax, quantity)

    def _table(self) -> tables.Table:
        header = ["order", "|F_x| N", "|F_y| N", "|M_x| N·m", "|M_y| N·m"]
        columns = [self.force_peak_xy, self.moment_peak_xy]
        if self._has_torque:
            header.append("|M_z| N·m")
            columns.append(self.torque_peak[:, None])
        rows = np.hstack(columns)
        name = self.engine.name or f"{len(self.engine)} cylinders"
        title = f"{name} at {self.rpm:g} rpm: peaks of force, rocking moment and roll torque"
        labels = [f"{order}" for order in self.orders]
        return tables.Table(title, header, labels, rows)

    def __repr__(self) -> str:
        return self._table().text()

    def _repr_html_(self) -> str:
        return self._table().html()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Balance):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key()[:4])

    def _key(self) -> tuple[Any, ...]:
        return (self.engine, self.rpm, self.orders, self.reference_z, self.spectrum, self._how)

    def __reduce__(self) -> tuple[Any, ...]:
        orders = "auto" if "rtol" in self._how else self.orders
        spectrum = None if self.spectrum is None else dict(self.spectrum)
        how = self._how | {"reference_z": self.reference_z}
        return (_again, (self.engine, self.rpm, orders, spectrum, how))


def _again(
    engine: Engine, rpm: float, orders: Orders, spectrum: Spectrum | None, how: dict[str, Any]
) -> Balance:
    return engine.balance(rpm, orders, spectrum=spectrum, **how)


def no_torque(*, by_spectrum: bool) -> _core.InputError:
    """Return the error that says why there is no torque."""
    if by_spectrum:
        return _core.InputError(
            "spectrum = given: a spectrum of forces tells nothing of torque; leave it out"
        )
    return _core.InputError("torque = False: it was not asked for; give torque=True")


def error_bound(core: _core.Balance, *, torque_known: bool) -> ErrorBound:
    """Return what the orders left out can add."""
    force, moment = core.error_bound("force"), core.error_bound("moment")
    return ErrorBound(force, moment, core.error_bound("torque") if torque_known else None)


def _ellipse(forward: NDArray[np.complex128], backward: NDArray[np.complex128]) -> Ellipse:
    axes = np.array(_core.ellipse(list(zip(forward.tolist(), backward.tolist(), strict=True))))
    major, minor, tilt = axes.reshape(-1, 3).T.copy()
    return Ellipse(_read_only(major), _read_only(minor), _read_only(np.degrees(tilt)))


def _read_only(values: NDArray[Any]) -> NDArray[Any]:
    values.setflags(write=False)
    return values


def balance(
    engine: Engine,
    rpm: float,
    orders: Orders = "auto",
    rtol: float | None = None,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    *,
    torque: bool = True,
) -> Balance:
    """Return force, moment and torque order by order; see :meth:`Engine.balance`."""
    rpm = inputs.number("rpm", rpm)
    wanted = inputs.orders(orders)
    tolerance = inputs.tolerance(rtol, wanted, 1e-9)
    plane = inputs.optional_number("reference_z", reference_z)
    pairs = inputs.spectrum(spectrum)
    torque = inputs.flag("torque", torque)
    core = _core.balance(engine.core, rpm, wanted, tolerance, plane, pairs, torque)
    inputs.warn_of_units(4.0 * engine.core.largest_crank_radius * rpm / 60.0)
    how: dict[str, Any] = ({"rtol": tolerance} if wanted is None else {}) | {"torque": torque}
    return Balance(core, engine, rpm, plane, None if pairs is None else dict(pairs), how)
