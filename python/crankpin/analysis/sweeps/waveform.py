"""Force, moment and torque over crank angle at every point of a sweep."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support import progress as progress_bar
from crankpin.analysis.waveform import OverAngle

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin._support.progress import Progress
    from crankpin._support.tables import Table
    from crankpin.analysis.request import Request
    from crankpin.analysis.sweeps.sweep import Sweep


class SweepWaveform(OverAngle["NDArray[np.float64]"]):
    """Force, moment and torque over crank angle at every point of a sweep.

    Each is computed when it is first read, and kept. Dimensions are those of the sweep without
    ``order``, then ``theta_deg`` and ``axis``. Made by :meth:`Sweep.waveform`.

    Examples
    --------
    >>> import numpy as np
    >>> import crankpin as cp
    >>> v8, ratios = cp.Engine.preset("v8-crossplane"), np.linspace(0.2, 0.35, 100)
    >>> s = cp.sweep(v8, rpm=6000, rod_ratio=ratios, rtol=1e-12, torque=False)
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
    exact: bool
    """True for exact kinematics, False for the sum of orders."""

    def __post_init__(self) -> None:
        if not hasattr(self.sweep, "_core"):
            raise inputs.rejected("sweep", self.sweep, "use Sweep.waveform")
        theta = inputs.copied(inputs.vector("theta_deg", self.theta_deg))
        self.__dict__.update(theta_deg=theta, _angles=_core.CrankAngles(theta))
        super().__post_init__()

    @property
    def _request(self) -> Request:
        """The options of the sweep, checked."""
        return self.sweep._request

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted, of any engine."""
        return self.sweep.fired

    @property
    def causes(self) -> tuple[str, ...]:
        """Causes of the quantities by name: ``inertia``, ``gas`` and those of further loads."""
        return self.sweep.causes

    @property
    def orders(self) -> tuple[Order, ...] | None:
        """Orders that are summed; None for exact kinematics."""
        return None if self.exact else self.sweep.orders

    @property
    def omitted(self) -> tuple[Order, ...]:
        """As :attr:`Sweep.omitted`; empty for exact kinematics."""
        return () if self.exact else self.sweep.omitted

    @property
    def error_bound(self) -> Mapping[str, float]:
        """As :attr:`Sweep.error_bound`, N and N·m; zero for exact kinematics."""
        return self._request.bounds((0.0, 0.0, 0.0)) if self.exact else self.sweep.error_bound

    def _values(self, quantity: str) -> NDArray[np.float64]:
        return self.computed(quantity)

    def computed(
        self,
        quantity: str = "moment",
        *,
        out: NDArray[np.float64] | None = None,
        progress: Progress = False,
    ) -> NDArray[np.float64]:
        """Compute force, moment or torque anew, into a given array or a new one.

        Allocating a large array takes longer than summing a few orders; when looping over sweeps of
        one shape, pass the same array each time.

        Parameters
        ----------
        quantity : str, default "moment"
            ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``, or a part of a torque,
            such as ``"torque.gas"``.
        out : ndarray of float, optional
            Buffer for the result: a C-contiguous array of float64, of the shape of the result.
        progress : bool or callable, default False
            True for a tqdm bar, or a function of (steps done, steps in all).

        Returns
        -------
        ndarray of float, shape (..., n_theta, 2) or (..., n_theta)
            ``out``, or a new array, N or N·m; of a torque without axes.

        Raises
        ------
        InputError
            If ``out`` does not fit, or torque is not available.

        Examples
        --------
        >>> import numpy as np
        >>> import crankpin as cp
        >>> i4, buffer = cp.Engine.preset("i4"), np.empty((2, 360, 2))
        >>> for rpm in (1000, 2000):
        ...     s = cp.sweep(i4, rpm=rpm, rod_ratio=[0.25, 0.3], orders=[2, 4])
        ...     force = s.waveform(np.arange(360)).computed("force", out=buffer)
        >>> force is buffer
        True
        """
        self.sweep._request.check(quantity, self)
        name = quantity
        progress = progress_bar.checked(progress)
        core = self.sweep._core
        shape = tuple(core.waveform_shape(name, len(self.theta_deg)))
        values = np.empty(shape) if out is None else inputs.output("out", out, shape)
        with progress_bar.shown(progress, "waveforms") as report:
            core.waveform(name, self.__dict__["_angles"], self.exact, values.reshape(-1), report)
        x, y = self._request.aside
        whole, point, part = name.partition(".")
        if whole == "torque" and part != "gas" and (x != 0.0 or y != 0.0):
            force = self.read(f"force{point}{part}")
            values -= x * force[..., 1] - y * force[..., 0]
        return values

    @cached_property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: those of the sweep, then ``theta_deg``."""
        return MappingProxyType({**self.sweep.coords, "theta_deg": self.theta_deg})

    @property
    def _attributes(self) -> Mapping[str, Any]:
        """Attributes of a dataset: those of the sweep."""
        return self.sweep._attributes

    @property
    def loads_counted(self) -> str:
        """Loads that count where more could, in words: those of the sweep."""
        return self.sweep.loads_counted

    @property
    def table(self) -> Table:
        """Table of the points: the largest magnitudes over crank angle."""
        title = self.sweep._title(f" at {len(self.theta_deg)} crank angles, {self._how}")
        return self.sweep._by_point(title, lambda name: self.read(name, "peak"))

    # --- pictures -------------------------------------------------------------------------------

    @property
    def _brief(self) -> str:
        swept = ", ".join(f"{name}: {len(values)}" for name, values in self.coords.items())
        loads = f", {self.loads_counted}" if self.loads_counted else ""
        return f"<SweepWaveform over ({swept}), {self._how}{loads}>"
