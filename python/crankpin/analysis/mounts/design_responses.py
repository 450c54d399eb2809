"""Many designs of mounts at once: natural frequencies, and the largest responses over speed."""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.messages import Hint
from crankpin._support.quantities import DESIGNS
from crankpin._support.record import AbsentError, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import Request, check_request
from crankpin.model import checks
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Order, Orders
    from crankpin._support.quantities import Kind
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.mounts import Mount

MOUNT_FIGURES = ("at", "tilt_deg", "stiffness", "dynamic_stiffness", "loss_factor", "damping")
"""Figures of a mount that can differ between designs."""


class DesignResponses(Labelled):
    """Natural frequencies and largest responses of many designs of a powertrain's mounts.

    Responses are reduced over speed as they are computed, so that a million designs fit in memory:
    the largest peak of each order, and the largest rms value of all orders together. Made by
    :meth:`Powertrain.designs`.
    """

    powertrain: Powertrain
    """The powertrain whose mounts differ."""
    vary: Mapping[str, Mapping[str, NDArray[np.float64]]]
    """Name of a mount → figure → its value in each design: (n_designs,) or (n_designs, n_axes)."""
    rpm: NDArray[np.float64]
    """Crank speeds."""
    _request: Request
    """Orders and tolerance, checked."""
    with_mount_force: bool
    """True if the force of each mount is computed."""
    points: tuple[tuple[float, float, float], ...]
    """Places whose velocity is computed, m."""
    at_frequency: float | None
    """Frequency at which natural frequencies take the stiffness, Hz."""

    def __post_init__(self) -> None:
        request = check_request(self._request, "Powertrain.designs")
        names = self.powertrain.names
        vary = []
        for name, figures in self.vary.items():
            for figure, values in figures.items():
                rows = values if values.ndim == 2 else np.repeat(values[:, None], 3, axis=1)
                vary.append((names.index(name), figure, rows))
        responses = self.powertrain._core.designs(
            self.powertrain._engine_core,
            vary,
            self.rpm,
            (request.orders, request.rtol),
            (self.with_mount_force, list(self.points)),
            self.at_frequency,
        )
        (orders, omitted, bounds), frequency, largest, rms = responses
        self.__dict__.update(_orders=(tuple(orders), tuple(omitted)), _bounds=bounds)
        self.__dict__.update(_frequency=frequency, _largest=largest, _rms=rms)
        super().__post_init__()

    def __len__(self) -> int:
        return len(self.__dict__["_frequency"])

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed, of a fired engine halves too."""
        return self.__dict__["_orders"][0]  # type: ignore[no-any-return]

    @property
    def omitted(self) -> tuple[Order, ...]:
        """With ``orders="auto"``: orders of the engine left out that are not zero."""
        return self.__dict__["_orders"][1]  # type: ignore[no-any-return]

    @property
    def error_bound(self) -> Mapping[str, float]:
        """Quantity → bound of what omitted orders add to the engine's load at the highest speed."""
        names = ("force", "moment", "torque")
        return MappingProxyType(dict(zip(names, self.__dict__["_bounds"], strict=True)))

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.powertrain.loads_counted

    _along: ClassVar[tuple[str, ...]] = ("order",)
    _registry: ClassVar[Mapping[str, Kind]] = DESIGNS

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the index of each design."""
        return {"design": read_only(np.arange(len(self)))}

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        modes = np.arange(1, self.__dict__["_frequency"].shape[1] + 1)
        points = np.arange(1, len(self.points) + 1)
        return {"mode": modes, "mount": self.powertrain.names, "point": points}

    @property
    def _names(self) -> tuple[str, ...]:
        without: tuple[str, ...] = (
            () if self.with_mount_force else ("mount_force", "mount_force_rms")
        )
        without += () if self.points else ("velocity", "velocity_rms")
        return tuple(name for name in DESIGNS if name not in without)

    def _check(self, quantity: str) -> None:
        if quantity in DESIGNS and quantity not in self._names:
            hint = Hint.of("give Powertrain.designs `mount_force=True`, or `points`")
            raise inputs.faulty(quantity, "is not available", hint, AbsentError)
        super()._check(quantity)

    def _values(self, quantity: str) -> NDArray[np.float64]:
        if quantity == "frequency":
            return self.__dict__["_frequency"]  # type: ignore[no-any-return]
        arrays = self.__dict__["_rms" if quantity.endswith("_rms") else "_largest"]
        first = 1 + (len(self.powertrain.mounts) if self.with_mount_force else 0)
        at = {"body": 0, "mount": slice(1, first), "velocity": slice(first, None)}
        return arrays[:, at[quantity.partition("_")[0]]]  # type: ignore[no-any-return]

    @property
    def frequency(self) -> Quantity[np.float64]:
        """Natural frequencies, Hz, ascending: (n_designs, n_modes).

        NaN where a mount's stiffness depends on frequency and none was given.
        """
        return self._quantity("frequency")

    @property
    def body_force(self) -> Quantity[np.float64]:
        """Largest peak over speed of the force on the body, N: (n_designs, n_orders, 3)."""
        return self._quantity("body_force")

    @property
    def body_force_rms(self) -> Quantity[np.float64]:
        """Largest rms over speed of all orders of the force on the body, N: (n_designs, 3)."""
        return self._quantity("body_force_rms")

    @property
    def mount_force(self) -> Quantity[np.float64]:
        """The same of the force of each mount, N: (n_designs, n_mounts, n_orders, 3).

        The name of a mount is a key. An AttributeError without ``mount_force=True``.
        """
        return self._quantity("mount_force")

    @property
    def mount_force_rms(self) -> Quantity[np.float64]:
        """The same of the force of each mount, N: (n_designs, n_mounts, 3)."""
        return self._quantity("mount_force_rms")

    @property
    def velocity(self) -> Quantity[np.float64]:
        """Largest peak over speed of the velocity of each point, m/s.

        Of shape (n_designs, n_points, n_orders, 3).
        """
        return self._quantity("velocity")

    @property
    def velocity_rms(self) -> Quantity[np.float64]:
        """Largest rms over speed of all orders, m/s: (n_designs, n_points, 3)."""
        return self._quantity("velocity_rms")

    def powertrain_of(self, design: int) -> Powertrain:
        """Return the powertrain of one design.

        Parameters
        ----------
        design : int
            Its index, from 0.

        Returns
        -------
        Powertrain
            The powertrain with the mounts of that design.

        Raises
        ------
        InputError
            If there is no such design.
        """
        number = inputs.whole("design", design)
        if not 0 <= number < len(self):
            raise inputs.rejected("design", design, f"give an index from 0 to {len(self) - 1}")
        mounts: list[Mount] = []
        for mount in self.powertrain.mounts:
            figures = self.vary.get(mount.name, {})
            values = {name: values[number].tolist() for name, values in figures.items()}
            mounts.append(mount.replace(**values))
        return self.powertrain.replace(mounts=mounts)

    @property
    def table(self) -> Table:
        """Natural frequencies, and the largest rms of the force on the body, of each design."""
        columns = [Column("design", np.arange(len(self)))]
        for k, values in enumerate(self.read("frequency").T.tolist()):
            cells = (None if math.isnan(value) else value for value in values)
            columns.append(Column(f"f{k + 1}", tuple(cells), "Hz"))
        for axis, values in zip("xyz", self.read("body_force_rms").T, strict=True):
            columns.append(Column(f"F_{axis} rms", values, "N"))
        name = labels.name_of(self.powertrain)
        title = f"{name} on {len(self)} designs of its mounts: largest force on the body"
        return Table(title, tuple(columns), loads=self.loads_counted)


def designs(
    powertrain: Powertrain,
    rpm: ArrayLike,
    vary: Mapping[str, Mapping[str, ArrayLike]],
    *,
    orders: Orders,
    rtol: float | None,
    mount_force: bool,
    points: Iterable[ArrayLike],
    frequency: float | None,
) -> DesignResponses:
    """Return designs; :meth:`Powertrain.designs` documents the arguments."""
    request = Request.checked(orders=orders, rtol=rtol, spectrum=None, torque=True)
    speeds = inputs.copied(inputs.vector("rpm", np.atleast_1d(inputs.array("rpm", rpm))))
    by_name = {mount.name: mount for mount in powertrain.mounts}
    values: dict[str, Mapping[str, NDArray[np.float64]]] = {}
    if not hasattr(vary, "items"):
        raise inputs.rejected("vary", vary, 'give {"name of a mount": {"stiffness": values}}')
    for name, figures in vary.items():
        inputs.one_of("vary", name, tuple(by_name))
        if not hasattr(figures, "items"):
            raise inputs.rejected(f"vary[{name!r}]", figures, 'give {"stiffness": values}')
        values[name] = {
            figure: _values(by_name[name], figure, values) for figure, values in figures.items()
        }
    counts = {len(value) for figures in values.values() for value in figures.values()}
    if len(counts) > 1:
        numbers = ", ".join(map(str, sorted(counts)))
        raise inputs.faulty(
            "vary", f"has {numbers} values", "give one value of each figure for each design"
        )
    listed = inputs.items("points", points, "give a list of points (x, y, z), m")
    places = tuple(_vector(f"points[{k}]", place) for k, place in enumerate(listed))
    hertz = None if frequency is None else inputs.number("frequency", frequency)
    is_each = inputs.flag("mount_force", mount_force)
    result = DesignResponses(
        powertrain, MappingProxyType(values), speeds, request, is_each, places, hertz
    )
    if powertrain.engine is not None:
        inputs.warn_of_units(mean_piston_speed(powertrain.engine, float(speeds.max())))
    return result


def _values(mount: Mount, figure: str, numbers: ArrayLike) -> NDArray[np.float64]:
    """Return the values of a figure, one or three of each design."""
    name = f"vary[{mount.name!r}]"
    inputs.one_of(name, figure, MOUNT_FIGURES)
    name = f"{name}[{figure!r}]"
    if figure == "stiffness" and mount.dynamic_stiffness is not None:
        static = "vary that: the static one does not count in motion"
        hint: str = Hint.of(f"the mount has a `dynamic_stiffness`; {static}")
        raise inputs.rejected(name, numbers, hint)
    if figure == "tilt_deg" and mount.axes is not None:
        raise inputs.rejected(
            name, numbers, Hint.of("the mount has `axes`; give it a `tilt_deg` instead")
        )
    values = inputs.array(name, numbers)
    is_vector = values.ndim == 2 and values.shape[1] == 3 and figure != "tilt_deg"
    is_number = values.ndim == 1 and figure != "at"
    if not (is_vector or is_number) or not len(values):
        shape = "(n_designs, 3)" if figure == "at" else "(n_designs,)"
        also = "" if figure in ("at", "tilt_deg") else ", or (n_designs, 3) along its axes"
        hint = f"give an array of shape {shape}{also}"
        raise inputs.faulty(name, f"has shape {values.shape}", hint)
    if "stiffness" in figure:
        checks.stiffness(figure, mount.name, (float(values.min()), float(values.max())))
    elif figure == "at":
        checks.point(name, tuple(np.abs(values).max(axis=0).tolist()))
    return read_only(np.array(values, order="C"))
