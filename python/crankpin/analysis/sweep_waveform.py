"""Force, moment and torque over crank angle at every point of a sweep."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs, tables
from crankpin._support import progress as progress_bar
from crankpin._support.frozen import Frozen
from crankpin.analysis.balance import ErrorBound

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from crankpin._support.progress import Progress
    from crankpin.analysis.sweep import Quantity, Sweep

DIMS: dict[str, tuple[str, ...]] = {
    "force": ("theta_deg", "axis"),
    "moment": ("theta_deg", "axis"),
    "torque": ("theta_deg",),
}


class SweepWaveform(Frozen):
    """Force, moment and torque over crank angle at every point of a sweep.

    Each is worked out when it is asked for, and kept. Dimensions are those of the sweep without
    ``order``, then ``theta_deg`` and ``axis``. Made by :meth:`Sweep.waveform`.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> v8, ratios = cp.Engine.preset("v8-crossplane"), np.linspace(0.2, 0.35, 100)
    >>> s = cp.sweep(v8, rpm=6000, rod_ratio=ratios, orders="auto", rtol=1e-12, torque=False)
    >>> w = s.waveform(np.arange(720))
    >>> w.orders
    (1, 4, 8, 12, 16)
    >>> w.force.shape
    (100, 720, 2)
    >>> exact = s.waveform(np.arange(720), exact=True)
    >>> bool(abs(w.moment - exact.moment).max() < 1e-12 * abs(exact.moment).max())
    True
    """

    sweep: Sweep
    """The sweep."""
    theta_deg: NDArray[np.float64]
    """Crank angles, degrees: (n_theta,)."""
    orders: tuple[int, ...] | None
    """Orders that are summed; None for exact kinematics."""
    omitted: tuple[int, ...]
    """As :attr:`Sweep.omitted`; empty for exact kinematics."""
    error_bound: ErrorBound
    """As :attr:`Sweep.error_bound`; zero for exact kinematics."""

    _angles: _core.CrankAngles

    def __init__(self, sweep: Sweep, theta_deg: NDArray[np.float64], *, exact: bool) -> None:
        theta = theta_deg.copy()
        theta.setflags(write=False)
        bound = sweep.error_bound
        none = ErrorBound(0.0, 0.0, None if bound.torque is None else 0.0)
        self._set(
            sweep=sweep,
            theta_deg=theta,
            _angles=_core.CrankAngles(theta),
            orders=None if exact else sweep.orders,
            omitted=() if exact else sweep.omitted,
            error_bound=none if exact else bound,
        )

    @cached_property
    def force(self) -> NDArray[np.float64]:
        """Shaking force along x and y, N: (…, n_theta, 2)."""
        return self._frozen("force")

    @cached_property
    def moment(self) -> NDArray[np.float64]:
        """Rocking moment about x and y, N·m: (…, n_theta, 2)."""
        return self._frozen("moment")

    @cached_property
    def torque(self) -> NDArray[np.float64]:
        """Roll torque of the inertia forces on the block about +z, N·m: (…, n_theta)."""
        return self._frozen("torque")

    def _frozen(self, quantity: Quantity) -> NDArray[np.float64]:
        values = self.values(quantity)
        values.setflags(write=False)
        return values

    def values(
        self,
        quantity: Quantity = "moment",
        *,
        out: NDArray[np.float64] | None = None,
        progress: Progress = False,
    ) -> NDArray[np.float64]:
        """Return force, moment or torque, worked out again, in memory that may be given.

        Asking the operating system for memory takes longer than the sum of a few orders; who goes
        through many sweeps of one shape gives the same array each time.

        Parameters
        ----------
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.
        out
            Where to write: a C-contiguous array of float64, of the shape of the result.
        progress
            True for a tqdm bar, or a function of (steps done, steps in all).

        Returns
        -------
        numpy.ndarray
            ``out``, or a new array: (…, n_theta, 2), for torque (…, n_theta).

        Raises
        ------
        InputError
            If ``out`` does not fit, or torque is not known.

        Examples
        --------
        >>> import numpy as np
        >>> import crankpin as cp
        >>> i4, buffer = cp.Engine.preset("i4"), np.empty((2, 360, 2))
        >>> for rpm in (1000, 2000):
        ...     s = cp.sweep(i4, rpm=rpm, rod_ratio=[0.25, 0.3], orders=[2, 4])
        ...     force = s.waveform(np.arange(360)).values("force", out=buffer)
        >>> force is buffer
        True
        """
        name = inputs.one_of("quantity", quantity, DIMS)
        progress = progress_bar.checked(progress)
        core: _core.Sweep = self.sweep._core
        shape = tuple(core.waveform_shape(name, len(self.theta_deg)))
        values = np.empty(shape) if out is None else inputs.output("out", out, shape)
        with progress_bar.shown(progress, "waveforms") as told:
            core.waveform(name, self._angles, self.orders is None, values.reshape(-1), told)
        return values

    @cached_property
    def coords(self) -> Mapping[str, NDArray[np.float64] | list[str]]:
        """Dimension → its values: those of the sweep, then ``theta_deg``."""
        return MappingProxyType({**self.sweep.coords, "theta_deg": self.theta_deg})

    def dims(self, quantity: Quantity = "moment") -> tuple[str, ...]:
        """Return the names of a quantity's dimensions."""
        return (*self.sweep.coords, *DIMS[inputs.one_of("quantity", quantity, DIMS)])

    def to_xarray(self, *quantities: Quantity) -> xr.Dataset:
        """Return arrays with named dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``; by default force and moment.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("i4"), rpm=[1000, 2000], orders=[2, 4])
        >>> s.waveform([0, 90, 180]).to_xarray("force").force.dims
        ('rpm', 'theta_deg', 'axis')
        """
        chosen = quantities or ("force", "moment")
        variables: dict[str, Any] = {
            name: (self.dims(name), getattr(self, name), {"units": tables.XARRAY_UNITS[name]})
            for name in chosen
        }
        coords = tables.coordinates(self.coords)
        if any(quantity != "torque" for quantity in chosen):
            coords["axis"] = ("axis", ["x", "y"])
        dataset: xr.Dataset = tables.xarray().Dataset(variables, coords, self.sweep._attributes)
        return dataset

    def plot(self, quantity: Quantity = "moment") -> Figure:
        """Draw a quantity over crank angle, a panel for each axis; return the figure.

        Parameters
        ----------
        quantity
            ``"force"``, ``"moment"`` or ``"torque"``.

        Examples
        --------
        >>> import crankpin as cp
        >>> s = cp.sweep(cp.Engine.preset("v6-60"), rpm=5000, rod_ratio=[0.25, 0.3, 0.35])
        >>> figure = s.waveform().plot("moment")
        """
        from crankpin.plot import figures  # noqa: PLC0415 - matplotlib is imported when used

        return figures.sweep_waveform(self, quantity)

    def __repr__(self) -> str:
        how = "exact kinematics" if self.orders is None else f"orders {list(self.orders)}"
        swept = ", ".join(f"{name}: {len(values)}" for name, values in self.coords.items())
        return f"<SweepWaveform over ({swept}), {how}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self.sweep, self.theta_deg, self.orders is None))


def _again(sweep: Sweep, theta_deg: NDArray[np.float64], exact: bool) -> SweepWaveform:
    return SweepWaveform(sweep, theta_deg, exact=exact)
