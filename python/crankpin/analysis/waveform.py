"""Force, moment and torque of an engine over crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.frozen import Frozen
from crankpin.analysis import export
from crankpin.analysis.balance import error_bound, mean_piston_speed
from crankpin.analysis.drawing import draw
from crankpin.analysis.request import Request, check_quantities, check_request, engine_core
from crankpin.analysis.source import ErrorBound

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.model.engine import Engine


def waveform(
    engine: Engine,
    rpm: float,
    *,
    theta_deg: ArrayLike | None = None,
    orders: Orders | None = None,
    rtol: float | None = None,
    reference_z: float | None = None,
    spectrum: Spectrum | None = None,
    torque: bool = True,
) -> Waveform:
    """Return the waveform of an engine; :meth:`Engine.waveform` documents the arguments."""
    theta = inputs.vector("theta_deg", np.arange(721.0) if theta_deg is None else theta_deg)
    if orders is None and rtol is not None:
        raise InputError(
            f'rtol = {inputs.shorten(rtol)}: needs orders="auto"; exact kinematics has no tolerance'
        )
    if orders is None and spectrum is not None:
        raise InputError(
            "orders = None: exact kinematics needs the slider-crank; "
            'give orders, or orders="auto", with a spectrum'
        )
    request = Request.checked(
        orders="auto" if orders is None else orders,
        rtol=rtol,
        reference_z=reference_z,
        spectrum=spectrum,
        torque=torque,
        default_rtol=1e-6,
    )
    found = Waveform(engine, inputs.number("rpm", rpm), theta, orders is not None, request)
    inputs.warn_of_units(mean_piston_speed(engine, found.rpm))
    return found


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

    _fields: ClassVar[tuple[str, ...]] = ("engine", "rpm", "theta_deg", "summed", "request")

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    theta_deg: NDArray[np.float64]
    """Crank angles, degrees: (n_theta,)."""
    summed: bool
    """True if a sum of orders was requested, False for exact kinematics."""
    request: Request
    """The options of the waveform, checked."""
    force: NDArray[np.float64]
    """Shaking force along x and y, N: (n_theta, 2)."""
    moment: NDArray[np.float64]
    """Rocking moment about x (pitch) and y (yaw), N·m: (n_theta, 2)."""
    orders: tuple[int, ...] | None
    """Orders that were summed; None for exact kinematics."""
    omitted: tuple[int, ...]
    """With ``orders="auto"``: orders that were left out; see :attr:`Balance.omitted`."""
    error_bound: ErrorBound
    """With ``orders="auto"``: upper bounds on what the omitted orders add, N and N·m."""

    def __init__(
        self,
        engine: Engine,
        rpm: float,
        theta_deg: NDArray[np.float64],
        summed: bool,
        request: Request,
    ) -> None:
        check_request(request, "Engine.waveform")
        force, moment, torque, crank_torque, balance = _core.waveform(
            engine_core(engine),
            rpm,
            theta_deg,
            summed,
            request.listed_orders if summed else None,
            request.rtol,
            request.reference_z,
            request.listed_spectrum,
            request.torque,
        )
        theta = inputs.copied(theta_deg)
        theta.setflags(write=False)
        known = torque is not None
        exact = ErrorBound(0.0, 0.0, 0.0 if known else None)
        self._set(
            engine=engine,
            rpm=rpm,
            theta_deg=theta,
            summed=summed,
            request=request,
            force=force,
            moment=moment,
            _torque=torque,
            _crank_torque=crank_torque,
            orders=None if balance is None else tuple(balance.orders),
            omitted=() if balance is None else tuple(balance.omitted),
            error_bound=exact if balance is None else error_bound(balance, torque_known=known),
        )

    _torque: NDArray[np.float64]
    _crank_torque: NDArray[np.float64]

    @property
    def torque(self) -> NDArray[np.float64]:
        """Roll torque of the inertia forces on the block about +z, N·m: (n_theta,).

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        self.request.check("torque")
        return self._torque

    @property
    def crank_torque(self) -> NDArray[np.float64]:
        """Torque of the inertia forces on the crank about +z, N·m: (n_theta,).

        An AttributeError where it was not requested, or a force spectrum does not determine it.
        """
        self.request.check("crank_torque")
        return self._crank_torque

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self, *quantities: str) -> pd.DataFrame:
        """Return a tidy table, one row a crank angle, quantity and component (needs pandas).

        Columns are theta_deg, quantity, component, value and unit.

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
        """
        names = check_quantities(quantities, self.request.quantities)
        return export.waveforms_to_pandas(self, names, {"theta_deg": self.theta_deg})

    def to_xarray(self, *quantities: str) -> xr.Dataset:
        """Return arrays with named dimensions and units (needs xarray).

        Parameters
        ----------
        *quantities
            ``"force"``, ``"moment"``, ``"torque"``, ``"crank_torque"``; by default all there are.
        """
        names = check_quantities(quantities, self.request.quantities)
        attributes = {"engine": self.engine.name, "rpm": self.rpm}
        coords = {"theta_deg": self.theta_deg}
        return export.waveforms_to_xarray(self, names, coords, attributes)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        kind: str = "curves",
        quantity: str = "moment",
        **options: Any,  # noqa: ANN401 - as below
    ) -> Axes:
        """Draw a quantity over crank angle, or the curve that its tip traces; return the axes.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        kind
            ``"curves"``: a curve over crank angle for each axis; ``"orbit"``: the tip of force or
            moment in the cross-section plane, arrows in its direction, a dot every 30°.
        quantity
            ``"force"``, ``"moment"``, ``"torque"`` or ``"crank_torque"``.
        **options
            ``label``, for a legend of several results on the same axes; colour, line width and
            other properties of matplotlib lines.

        Raises
        ------
        InputError
            If there is no such picture of the quantity: a torque has no orbit.

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60")
        >>> ax = v6.waveform(rpm=6000).plot(label="60°")
        >>> ax = v6.with_bank_angle(90, hold="pins").waveform(rpm=6000).plot(ax, label="90°")
        """
        return draw(self, ax, kind=kind, quantity=quantity, **options)  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        how = "exact kinematics" if self.orders is None else labels.orders_text(self.orders)
        count = len(self.theta_deg)
        return f"<Waveform of {self.engine!r} at {self.rpm:g} rpm, {count} angles, {how}>"
