"""Force, moment and torque over crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, tables
from crankpin._support.frozen import Frozen
from crankpin.analysis.balance import ErrorBound, error_bound, no_torque

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.model.engine import Engine


class Waveform(Frozen):
    """Force, moment and torque of an engine at given crank angles.

    Made by :meth:`Engine.waveform`.

    Examples
    --------
    >>> import crankpin as cp
    >>> engine = cp.Engine.preset("v6-60")
    >>> exact = engine.waveform(rpm=6000, theta_deg=[0, 10, 20])
    >>> summed = engine.waveform(rpm=6000, theta_deg=[0, 10, 20], orders="auto", rtol=1e-6)
    >>> bool(abs(exact.moment - summed.moment).max() <= summed.error_bound.moment)
    True
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed."""
    theta_deg: NDArray[np.float64]
    """Crank angles, degrees: (n_theta,)."""
    force: NDArray[np.float64]
    """Shaking force along x and y, N: (n_theta, 2)."""
    moment: NDArray[np.float64]
    """Rocking moment about x (pitch) and y (yaw), N·m: (n_theta, 2)."""
    orders: tuple[int, ...] | None
    """Orders that were summed; None for exact kinematics, which ``orders="auto"`` takes where it
    costs less."""
    omitted: tuple[int, ...]
    """With ``orders="auto"``: orders left out that are not zero; see :attr:`Balance.omitted`."""
    error_bound: ErrorBound
    """With ``orders="auto"``: what all orders left out can add; see :attr:`Balance.error_bound`."""

    def __init__(
        self,
        engine: Engine,
        rpm: float,
        theta_deg: NDArray[np.float64],
        parts: _core._WaveformParts,
        *,
        by_spectrum: bool,
    ) -> None:
        if not isinstance(parts, tuple):
            raise InputError(f"Waveform({inputs.shorten(parts)}): use Engine.waveform")
        force, moment, torque, crank_torque, balance = parts
        theta = inputs.copied(theta_deg)
        theta.setflags(write=False)
        known = torque is not None
        exact = ErrorBound(0.0, 0.0, 0.0 if known else None)
        self._set(
            engine=engine,
            rpm=rpm,
            theta_deg=theta,
            force=force,
            moment=moment,
            _by_spectrum=by_spectrum,
            _torque=torque,
            _crank_torque=crank_torque,
            orders=None if balance is None else tuple(balance.orders),
            omitted=() if balance is None else tuple(balance.omitted),
            error_bound=exact if balance is None else error_bound(balance, torque_known=known),
        )

    _by_spectrum: bool
    _torque: NDArray[np.float64] | None
    _crank_torque: NDArray[np.float64] | None

    @property
    def torque(self) -> NDArray[np.float64]:
        """Roll torque of the inertia forces on the block about +z, N·m: (n_theta,).

        InputError where it was not asked for, or a spectrum of forces tells nothing of it.
        """
        return self._known(self._torque)

    @property
    def crank_torque(self) -> NDArray[np.float64]:
        """Torque of the inertia forces on the crank about +z, N·m: (n_theta,)."""
        return self._known(self._crank_torque)

    def _known(self, torque: NDArray[np.float64] | None) -> NDArray[np.float64]:
        if torque is None:
            raise no_torque(by_spectrum=self._by_spectrum)
        return torque

    def to_pandas(self) -> pd.DataFrame:
        """Return a table, one row a crank angle (needs pandas)."""
        pandas = tables.pandas()
        columns = {
            "force_x": self.force[:, 0],
            "force_y": self.force[:, 1],
            "moment_x": self.moment[:, 0],
            "moment_y": self.moment[:, 1],
        }
        if self._torque is not None:
            columns |= {"torque": self._torque, "crank_torque": self.crank_torque}
        index = pandas.Index(self.theta_deg, name="theta_deg")
        table: pd.DataFrame = pandas.DataFrame(columns, index=index)
        return table

    def to_xarray(self) -> xr.Dataset:
        """Return arrays with named dimensions and units (needs xarray)."""
        variables: dict[str, Any] = {
            "force": (("theta_deg", "axis"), self.force, {"units": "N"}),
            "moment": (("theta_deg", "axis"), self.moment, {"units": "N m"}),
        }
        if self._torque is not None:
            variables["torque"] = (("theta_deg",), self._torque, {"units": "N m"})
            variables["crank_torque"] = (("theta_deg",), self.crank_torque, {"units": "N m"})
        coords = {
            "theta_deg": ("theta_deg", self.theta_deg, {"units": "degree"}),
            "axis": ("axis", ["x", "y"]),
        }
        attributes = {"engine": self.engine.name, "rpm": self.rpm}
        dataset: xr.Dataset = tables.xarray().Dataset(variables, coords, attributes)
        return dataset

    def plot(self, ax: Axes | None = None, *, quantity: str = "moment") -> Axes:
        """Draw a quantity over crank angle; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.
        """
        from crankpin.plot import figures  # noqa: PLC0415 - matplotlib is imported when used

        return figures.waveform(self, ax, quantity)

    def __repr__(self) -> str:
        how = "exact kinematics" if self.orders is None else f"orders {list(self.orders)}"
        count = len(self.theta_deg)
        return f"<Waveform of {self.engine!r} at {self.rpm:g} rpm, {count} angles, {how}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self.__dict__,))


def _again(state: dict[str, Any]) -> Waveform:
    waveform = Waveform.__new__(Waveform)
    for value in state.values():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
    waveform._set(**state)
    return waveform


def waveform(
    engine: Engine,
    rpm: float,
    theta_deg: ArrayLike | None = None,
    orders: Orders | None = None,
    rtol: float | None = None,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    *,
    torque: bool = True,
) -> Waveform:
    """Return force, moment and torque over crank angle; see :meth:`Engine.waveform`."""
    rpm = inputs.number("rpm", rpm)
    theta = inputs.vector("theta_deg", np.arange(721.0) if theta_deg is None else theta_deg)
    if spectrum is not None and orders is None:
        cure = 'give orders, or orders="auto", with a spectrum'
        raise InputError(f"orders = None: exact kinematics needs the slider-crank; {cure}")
    wanted = [] if orders is None else inputs.orders(orders)
    core = _core.waveform(
        engine.core,
        rpm,
        theta,
        orders is not None,
        None if orders is None else wanted,
        inputs.tolerance(rtol, wanted, 1e-6),
        inputs.optional_number("reference_z", reference_z),
        inputs.spectrum(spectrum),
        inputs.flag("torque", torque),
    )
    inputs.warn_of_units(4.0 * engine.core.largest_crank_radius * rpm / 60.0)
    return Waveform(engine, rpm, theta, core, by_spectrum=spectrum is not None)
