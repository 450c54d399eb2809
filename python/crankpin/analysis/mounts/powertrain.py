"""An engine, the rigid body that it is part of, and the mounts that carry it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Self

from crankpin import _core
from crankpin._support import files, inputs
from crankpin._support.record import Input
from crankpin._support.warnings import suppressed
from crankpin.analysis.mounts import modes as natural
from crankpin.analysis.mounts import response as forced
from crankpin.analysis.mounts import static_state
from crankpin.analysis.request import engine_core
from crankpin.model import checks, engine_files
from crankpin.model.engine import Engine
from crankpin.model.mounts import Mount, RigidBody

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Orders
    from crankpin.analysis.mounts.modes import MountModes, RollAxes
    from crankpin.analysis.mounts.response import MountResponse
    from crankpin.analysis.mounts.static_state import StaticState


class Powertrain(Input):
    """An engine on its mounts: the engine, the rigid body that moves, and what carries it.

    Every load of the engine counts: pistons, rods, counterweights, balance shafts, and gas pressure
    where it has cycles. What carries the mounts does not move.

    Parameters
    ----------
    engine : Engine
        The engine, with its cycle, shafts and counterweights.
    body : RigidBody
        Engine, gearbox and all that moves with them.
    mounts : sequence of Mount
        One mount or more, of distinct names.

    Raises
    ------
    InputError
        If there is no mount, or two have one name.

    Examples
    --------
    >>> import crankpin as cp
    >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
    >>> mounts = [
    ...     cp.Mount(f"{x:+g} {z:+g}", at=(x, -0.12, z + 0.15), stiffness=(1.5e5, 3e5, 1.2e5),
    ...              loss_factor=0.1)
    ...     for x in (0.22, -0.22) for z in (0.28, -0.28)
    ... ]
    >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
    >>> p.modes().frequency.round(2)
    array([ 8.2 ,  8.42, 14.24, 14.92, 20.26, 21.6 ])
    >>> r = p.response(rpm=[800, 3000])
    >>> r.body_force[2].peak_xyz.shape, r.sel(rpm=800).orders[0]
    ((2, 3), 2)
    """

    engine: Engine
    body: RigidBody
    mounts: tuple[Mount, ...]

    def __init__(self, engine: Engine, body: RigidBody, mounts: Iterable[Mount]) -> None:
        engine_core(engine)
        if not isinstance(body, RigidBody):
            raise inputs.rejected("body", body, "give a crankpin.RigidBody")
        listed = inputs.items("mounts", mounts, "give a list of crankpin.Mount")
        for k, mount in enumerate(listed):
            if not isinstance(mount, Mount):
                raise inputs.rejected(f"mounts[{k}]", mount, "give a crankpin.Mount")
        figures = [mount._figures for mount in listed]
        core = _core.Powertrain(body._figures, figures)
        self.__dict__.update(engine=engine, body=body, mounts=tuple(listed), _powertrain=core)

    @property
    def _core(self) -> _core.Powertrain:
        return self.__dict__["_powertrain"]  # type: ignore[no-any-return]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the mounts."""
        return tuple(mount.name for mount in self.mounts)

    @property
    def _varies(self) -> bool:
        """True if the stiffness of a mount depends on frequency."""
        return any(mount.track is not None or mount.table is not None for mount in self.mounts)

    # --- questions --------------------------------------------------------------------------------

    def static(
        self,
        torque: float | Literal["engine"] = 0.0,
        *,
        gear_ratio: float = 1.0,
        gravity: ArrayLike = static_state.GRAVITY,
        rpm: float = 1000.0,
    ) -> StaticState:
        """Return sag, preloads and wind-up, with the static stiffness of the mounts.

        Parameters
        ----------
        torque : float or "engine", default 0.0
            Mean torque of the crank, N·m, in its sense of rotation; ``"engine"``: that of the
            engine's cycle.
        gear_ratio : float, default 1.0
            Speed of the crank over that of the shaft on which torque leaves the unit, parallel to
            the crank: below zero if it turns against it. 1 for a bare engine; the whole ratio of
            gearbox and final drive where both are on the same mounts, as of a transverse
            powertrain: 10 to 15 in first gear.
        gravity : sequence of float, default (0.0, -9.80665, 0.0)
            Acceleration of gravity in the engine's axes, m/s²: of an inclined engine another
            direction.
        rpm : float, default 1000.0
            Crank speed at which the mean torque of the engine is read, rpm.

        Returns
        -------
        StaticState
            Displacements, and forces of the mounts by cause.

        Raises
        ------
        InputError
            If a motion is free, or the engine has no cycle.

        Examples
        --------
        >>> import crankpin as cp
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> body = cp.RigidBody(mass=160, cg=(0.03, 0.1, 0.2), inertia=(7, 8, 4.5))
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> p.static().preload[:, 1].round(4)
        array([-638.8332, -481.9268, -448.304 ])
        """
        return static_state.static(self, torque, gear_ratio, gravity, rpm)

    def modes(self, frequency: float | None = None) -> MountModes:
        """Return the natural modes, with the dynamic stiffness of the mounts.

        Parameters
        ----------
        frequency : float, optional
            Frequency at which dynamic stiffness and damping are taken, Hz; required where a mount
            is hydraulic or has a table. Without it the damping of each mode is that at its own
            frequency.

        Returns
        -------
        MountModes
            Frequencies, kinetic and elastic energy, loss factors.

        Raises
        ------
        InputError
            If stiffness depends on frequency and none is given, or is below zero there.

        Examples
        --------
        >>> import crankpin as cp
        >>> mounts = [
        ...     cp.Mount(name, at=(x, 0, 0), stiffness=2e5) for name, x in [("a", 0.3), ("b", -0.3)]
        ... ]
        >>> body = cp.RigidBody(mass=160, cg=(0, 0, 0), inertia=(7, 8, 4.5))
        >>> cp.Powertrain(cp.Engine.preset("i4"), body, mounts).modes().free
        ('rotation about the line through (0, 0, 0) m along (1, 0, 0)',)
        """
        given = None if frequency is None else inputs.number("frequency", frequency)
        return natural.MountModes(self, given)

    def axes(self, frequency: float | None = None) -> RollAxes:
        """Return torque roll axis and elastic roll axis.

        Parameters
        ----------
        frequency : float, optional
            As in :meth:`modes`.

        Returns
        -------
        RollAxes
            Directions, angles, distances.

        Raises
        ------
        InputError
            If a motion is free, or stiffness depends on frequency and none is given.
        """
        given = None if frequency is None else inputs.number("frequency", frequency)
        return natural.RollAxes(self, given)

    def response(
        self, rpm: ArrayLike, *, orders: Orders = "auto", rtol: float | None = None
    ) -> MountResponse:
        """Return forces, motion and power at each speed and order of the engine.

        The engine's force, moment and roll torque of each order, moved to the centre of gravity,
        act on the body; its mean torque does not count here (:meth:`static`).

        Parameters
        ----------
        rpm : array_like
            Crank speeds, rpm: one, or several as a dimension of the result.
        orders : number, sequence of numbers or "auto", default "auto"
            Multiples of crank speed, halves too, or ``"auto"`` for those of the engine's balance
            that reach ``rtol``.
        rtol : float, optional
            As in :meth:`Engine.balance`.

        Returns
        -------
        MountResponse
            Forces of the mounts, motion of points, power, transmissibility.

        Raises
        ------
        InputError
            If an order meets a mode without damping, or a table of stiffness does not reach to its
            frequency.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine.
        """
        return forced.response(self, rpm, orders=orders, rtol=rtol)

    def without(self, cylinder: int) -> Self:
        """Return the same powertrain with a cylinder that does not fire.

        Parameters
        ----------
        cylinder : int
            Number of the cylinder, from 1.

        Returns
        -------
        Powertrain
            The same with an engine whose cylinder has no cycle.

        Raises
        ------
        InputError
            If the engine has no cycles, or no such cylinder.
        """
        number = inputs.whole("cylinder", cylinder)
        cycles = self.engine.cycles
        if cycles is None:
            raise inputs.rejected(
                "cylinder", number, "no cylinder fires; give engine.with_cycle(…)"
            )
        if not 1 <= number <= len(cycles):
            raise inputs.rejected("cylinder", number, f"give a number from 1 to {len(cycles)}")
        listed: list[Any] = [*cycles]
        listed[number - 1] = None
        engine = self.engine.with_cycle(listed, crankcase=self.engine.crankcase)
        return self.replace(engine=engine)

    # --- files ------------------------------------------------------------------------------------

    def save(self, path: str | Path) -> None:
        """Write engine, body and mounts to an engine file, ``.toml`` or ``.json``.

        :meth:`Engine.load` reads the engine of such a file alone.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file.

        Raises
        ------
        InputError
            If the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        file = engine_files.checked(path)
        toml = engine_files.is_toml(file)
        text = self._core.to_text(self.engine._core, toml)
        files.write(file, engine_files.commented(text) if toml else text)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the powertrain in an engine file.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.toml`` or ``.json``.

        Returns
        -------
        Powertrain
            Engine, body and mounts.

        Raises
        ------
        InputError
            If the text does not describe an engine with a ``[powertrain]``.
        OSError
            If the file cannot be read.
        """
        file = engine_files.checked(path)
        read = _core.Powertrain.from_text(engine_files.read(file), engine_files.is_toml(file))
        core_engine, core = read
        if core is None:
            raise inputs.rejected(
                "path", str(file), "the file has no [powertrain]: use Engine.load"
            )
        mass, cg, inertia = core.body
        body = RigidBody(mass, cg, inertia, products="tensor")
        mounts = [Mount._of(figures) for figures in core.mounts]
        for name, at, _, stiffness, *_ in core.mounts:
            checks.mount(name, at, stiffness)
        engine = Engine._read(core_engine)
        with suppressed():
            return cls(engine, body, mounts)
