"""An engine, the rigid body that it is part of, and the mounts that carry it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

from crankpin import _core
from crankpin._support import files, inputs, labels, units
from crankpin._support.frames import Framed
from crankpin._support.messages import suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import Input
from crankpin._support.tables import Column, Table
from crankpin.analysis.mounts import active, feedback, static_state
from crankpin.analysis.mounts import design_responses as many
from crankpin.analysis.mounts import load_cases as loaded
from crankpin.analysis.mounts import modes as natural
from crankpin.analysis.mounts import mount_sweep as swept
from crankpin.analysis.mounts import response as forced
from crankpin.analysis.mounts.robustness import MountRobustness
from crankpin.analysis.request import engine_core
from crankpin.model import engine_files, supports
from crankpin.model.base_motion import BaseMotion
from crankpin.model.engine import Engine
from crankpin.model.forces import ForceTable
from crankpin.model.mounts import Mount, RigidBody
from crankpin.model.supports import Receptance, Subframe, Support
from crankpin.model.vehicle_axes import VehicleAxes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from crankpin._core import Engine as CoreEngine
    from crankpin._core import InputError
    from crankpin._support.inputs import Orders
    from crankpin.analysis.mounts.active import Cancellation
    from crankpin.analysis.mounts.design_responses import DesignResponses
    from crankpin.analysis.mounts.feedback import VelocityFeedback
    from crankpin.analysis.mounts.load_cases import LoadCases
    from crankpin.analysis.mounts.modes import MountModes, RollAxes
    from crankpin.analysis.mounts.mount_sweep import MountSweep
    from crankpin.analysis.mounts.response import MountResponse
    from crankpin.analysis.mounts.static_state import StaticState
    from crankpin.model.actuators import Actuator
    from crankpin.view.widget import PowertrainWidget


def _of_receptance(support: Receptance) -> InputError:
    hint = "a receptance is measured along the engine's axes: give body and mounts in them"
    return inputs.rejected("support", support, hint)


def _in_engine_axes(vehicle: object, body: RigidBody, mounts: list[Any], support: object) -> Any:  # noqa: ANN401
    """Return body, mounts and subframe in the engine's axes, of those of a vehicle."""
    if not isinstance(vehicle, VehicleAxes):
        raise inputs.rejected("vehicle", vehicle, "give a crankpin.VehicleAxes")
    if isinstance(support, Receptance):
        raise _of_receptance(support)
    below = None if support is None else vehicle.to_engine(support)
    return vehicle.to_engine(body), [vehicle.to_engine(mount) for mount in mounts], below


class Powertrain(Framed, Input):
    """An engine on its mounts: the engine, the rigid body that moves with it, and the mounts.

    Every load of the engine counts: pistons, rods, counterweights, balance shafts, and gas pressure
    where it has cycles. Tables of forces, as makers print them, may take its place, or count
    besides. What carries the mounts does not move, unless it is given.

    Parameters
    ----------
    engine : Engine or ForceTable or None
        The engine, with its cycle, shafts and counterweights; or a table of forces without one;
        None beside ``forces``, or of a body that its base alone shakes, such as an instrument.
    body : RigidBody
        Engine, gearbox and all that moves with them.
    mounts : sequence of Mount
        One mount or more, of distinct names.
    support : Subframe or Receptance, optional
        Flexible support of the mounts; by default firm ground. A subframe counts in every result
        except :meth:`designs` and pages, which reject it; a receptance gives a response, but no
        modes, axes, state at rest or tolerances.
    forces : ForceTable or sequence of ForceTable, optional
        Tables of forces that shake the body besides the engine, such as those of a driven machine,
        or without one.
    rest : mapping, optional
        Arguments of :meth:`static` for the state about which the powertrain moves, of mounts with
        snubbers: modes, response and all else of motion count the stiffness of those that act
        there, the tangent stiffness. By default it rests under gravity; a receptance counts as
        firm ground here.
    vehicle : VehicleAxes, optional
        Axes of body, mounts, support and ``rest``, and of whatever else has places or directions:
        arguments and results. By default the engine's: x to the right seen from the flywheel and y
        up from the crank's axis, z along it. Tables of forces are in the engine's in any case, and
        so are kinetic energies and shapes of modes.

    Raises
    ------
    InputError
        If there is no mount, or two have one name, the support's coordinates are at other mounts,
        or mounts with snubbers leave a motion free.

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

    engine: Engine | None
    body: RigidBody
    mounts: tuple[Mount, ...]
    support: Support | None
    forces: tuple[ForceTable, ...]
    rest: Mapping[str, Any] | None
    vehicle: VehicleAxes | None

    def __init__(
        self,
        engine: Engine | ForceTable | None,
        body: RigidBody,
        mounts: Iterable[Mount],
        support: Support | None = None,
        forces: ForceTable | Iterable[ForceTable] = (),
        rest: Mapping[str, Any] | None = None,
        vehicle: VehicleAxes | None = None,
    ) -> None:
        listed = [forces] if isinstance(forces, ForceTable) else forces
        tables = inputs.items("forces", listed, "give a list of crankpin.ForceTable")
        for k, table in enumerate(tables):
            if not isinstance(table, ForceTable):
                raise inputs.rejected(f"forces[{k}]", table, "give a crankpin.ForceTable")
        if isinstance(engine, ForceTable):
            engine, tables = None, [engine, *tables]
        if engine is not None:
            engine_core(engine)
        if not isinstance(body, RigidBody):
            raise inputs.rejected("body", body, "give a crankpin.RigidBody")
        entries = inputs.items("mounts", mounts, "give a list of crankpin.Mount")
        for k, mount in enumerate(entries):
            if not isinstance(mount, Mount):
                raise inputs.rejected(f"mounts[{k}]", mount, "give a crankpin.Mount")
        carrier: object = support
        if not isinstance(carrier, Subframe | Receptance | None):
            hint = "give a crankpin.Subframe or a crankpin.Receptance"
            raise inputs.rejected("support", carrier, hint)
        texts = ", ".join(table._text() for table in tables)
        self.__dict__.update(engine=engine, body=body, mounts=tuple(entries), support=support)
        turned: Any = (body, entries, carrier)
        self.__dict__.update(vehicle=vehicle, rest=None)
        if vehicle is not None:
            turned = _in_engine_axes(vehicle, body, entries, carrier)
        of_body, of_mounts, below = turned
        upright = case = static_state.upright(vehicle)
        if rest is not None:
            case = static_state.named_case(self, "rest", rest)
            rest = None if case == upright else MappingProxyType(case._asdict())
        core = _core.Powertrain(
            of_body._figures,
            [mount._figures for mount in of_mounts],
            None if below is None else below._figures,
            f"[{texts}]",
            case.figures(vehicle),
        )
        self.__dict__.update(forces=tuple(tables), rest=rest, _powertrain=core)

    @property
    def _core(self) -> _core.Powertrain:
        return self.__dict__["_powertrain"]  # type: ignore[no-any-return]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the mounts."""
        return tuple(mount.name for mount in self.mounts)

    @property
    def _varies(self) -> bool:
        """True if the stiffness of a mount, or of one of a subframe, depends on frequency."""
        below = self.support.mounts if isinstance(self.support, Subframe) else ()
        return any(
            mount.track is not None or mount.table is not None for mount in (*self.mounts, *below)
        )

    @property
    def _engine_core(self) -> CoreEngine | None:
        """The engine as the core has it, if there is one."""
        return None if self.engine is None else self.engine._core

    @property
    def title(self) -> str:
        """Names of the engine and the tables of forces, or substitutes."""
        engine = [] if self.engine is None else [self.engine.title]
        return " and ".join([*engine, *(table.title for table in self.forces)]) or "body"

    @property
    def loads_counted(self) -> str:
        """What shakes the body, in words: gas pressure and further loads, tables of forces."""
        engine = [] if self.engine is None else [self.engine.loads_counted]
        return "; ".join([*engine, *(table.loads_counted for table in self.forces)])

    def _require_engine(self, name: str) -> Engine:
        """Return the engine, or raise an error of an argument or a reading that needs one."""
        if self.engine is None:
            hint = "a table of forces alone shakes the body: give an engine"
            raise inputs.faulty(name, "has no engine", hint)
        return self.engine

    @property
    def _title(self) -> str:
        """Name in titles."""
        return self._title_with("")

    def _title_with(self, driven: str) -> str:
        """Return the name in titles, with what drives it besides the engine."""
        return f"{labels.name_of(self)} on its mounts{driven}{self._carried}{self._resting}"

    @property
    def _resting(self) -> str:
        """State about which mounts with snubbers move, in titles."""
        if not self._core.is_snubbed:
            return ""
        acting = static_state.snubbers_in_words(self._core.all_names, self._core.contacts)
        under = "under gravity" if self.rest is None else "in the case given"
        words = f"act: {', '.join(acting)}" if acting else "none acts"
        return f", snubbers as at rest {under} ({words})"

    @property
    def _carried(self) -> str:
        """Flexible support of the mounts, in titles."""
        on = "" if self.support is None else f" and a {type(self.support).__name__.lower()}"
        return on if self.vehicle is None else f"{on} ({self.vehicle._words})"

    def in_axes(self, vehicle: VehicleAxes | None) -> Self:
        """Return the same powertrain with figures and results in other axes.

        Parameters
        ----------
        vehicle : VehicleAxes or None
            The axes; None for the engine's.

        Returns
        -------
        Powertrain
            The same, of which body, mounts, subframe and ``rest`` are turned.

        Raises
        ------
        InputError
            If a receptance carries the mounts.

        Examples
        --------
        >>> import crankpin as cp
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> body = cp.RigidBody(mass=160, cg=(0.03, 0.1, 0.2), inertia=(7, 8, 4.5))
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> seen = p.in_axes(cp.VehicleAxes(flywheel="left", origin=(1.5, 0.3, 0.4)))
        >>> seen.body.cg, seen.static().preload[:, 2].round(4)
        ((1.53, 0.1, 0.5), array([-638.8332, -481.9268, -448.304 ]))
        >>> seen.in_axes(None) == p
        True
        """
        target: object = vehicle
        if not isinstance(target, VehicleAxes | None):
            raise inputs.rejected("vehicle", target, "give a crankpin.VehicleAxes")
        plain = self
        if self.vehicle is not None:
            plain = self._turned(self.vehicle.to_engine, self.vehicle, inverse=True, vehicle=None)
        if vehicle is None or vehicle == self.vehicle:
            return plain if vehicle is None else self
        return plain._turned(vehicle.from_engine, vehicle, inverse=False, vehicle=vehicle)

    def _turned(
        self,
        move: Callable[[Any], Any],
        by: VehicleAxes,
        *,
        inverse: bool,
        vehicle: VehicleAxes | None,
    ) -> Self:
        """Return the same in the axes of what moves places, or of none."""
        if isinstance(self.support, Receptance):
            raise _of_receptance(self.support)
        case = self.rest or static_state.upright(self.vehicle)._asdict()
        rest = {
            name: tuple(by._vectors(case[name], inverse=inverse).tolist())
            for name in ("gravity", "acceleration", "thrust")
        }
        place = move(case["thrust_at"]) if any(case["thrust"]) else static_state.STILL
        rest |= {"torque": case["torque"], "thrust_at": place}
        return self.replace(
            body=move(self.body),
            mounts=[move(mount) for mount in self.mounts],
            support=None if self.support is None else move(self.support),
            rest=rest,
            vehicle=vehicle,
        )

    def _free(self, motions: Iterable[str]) -> tuple[str, ...]:
        """Return motions that no mount resists, in words that say in which axes they are."""
        axes = "" if self.vehicle is None else ", in the engine's axes"
        return tuple(f"{motion}{axes}" for motion in motions)

    def _require_engine_axes(self, name: str) -> None:
        """Raise an error where figures are in the axes of a vehicle."""
        if self.vehicle is not None:
            hint = "it takes the engine's axes: take powertrain.in_axes(None)"
            raise inputs.faulty(name, f"is undefined in the axes {self.vehicle._words}", hint)

    @property
    def table(self) -> Table:
        """Places of the mounts and static stiffness, about their axes too; mass of the body."""
        place, stiffness = (
            [*zip(*(getattr(mount, name) for mount in self.mounts), strict=True)]
            for name in ("at", "stiffness")
        )
        columns: tuple[Column, ...] = (
            Column("mount", self.names),
            *(Column(axis, values, "m") for axis, values in zip("xyz", place, strict=True)),
            *(
                Column(f"stiffness along axis {k}", values, "N/m")
                for k, values in enumerate(stiffness, 1)
            ),
        )
        about = np.array([mount.rotational_stiffness for mount in self.mounts])
        if about.any():
            columns += tuple(
                Column(f"stiffness about axis {k}", values, "N·m/rad")
                for k, values in enumerate(about.T, 1)
            )
        mass = units.figure(self.body.mass, "kg", 6)
        title = units.Text(f"{self._title}\nbody of ", mass)
        return Table(title, columns, loads=self.loads_counted)

    # --- questions --------------------------------------------------------------------------------

    def static(
        self,
        torque: float | Literal["engine"] = 0.0,
        *,
        gear_ratio: float = 1.0,
        gravity: ArrayLike | None = None,
        acceleration: ArrayLike = static_state.STILL,
        rpm: float = 1000.0,
        thrust: ArrayLike = static_state.STILL,
        thrust_at: ArrayLike = static_state.STILL,
    ) -> StaticState:
        """Return sag, preloads and wind-up, with the static stiffness of the mounts.

        Snubbers act beyond their gaps: the equilibrium is exact.

        Parameters
        ----------
        torque : float or "engine", default 0.0
            Mean torque of the crank, N·m, in its sense of rotation, or ``"engine"`` for that of the
            engine's cycle.
        gear_ratio : float, default 1.0
            Speed of the crank over that of the shaft on which torque leaves the unit, parallel to
            the crank; below zero if it turns against it. 1 for a bare engine; the whole ratio of
            gearbox and final drive where both are on the same mounts, as of a transverse
            powertrain: 10 to 15 in first gear.
        gravity : sequence of float, optional
            Acceleration of gravity, m/s²; by default that of ``rest``, which is 9.80665 along −y,
            or down in the axes of a ``vehicle``. Of an inclined engine it has another direction.
        acceleration : sequence of float, default (0.0, 0.0, 0.0)
            Acceleration of the vehicle, m/s²: of braking against the motion.
        rpm : float, default 1000.0
            Crank speed at which the mean torque of the engine is read, rpm.
        thrust : sequence of float, default (0.0, 0.0, 0.0)
            Force of a propeller's shaft on the unit, N, where its gearbox bears that: along its
            axis, away from the propeller when it drives ahead.
        thrust_at : sequence of float, default (0.0, 0.0, 0.0)
            Place where it acts, m.

        Returns
        -------
        StaticState
            Displacements, and forces of the mounts by cause.

        Raises
        ------
        InputError
            If a motion is free, the engine has no cycle, or a receptance carries the mounts.

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
        case = static_state.case_of(
            self,
            torque=torque,
            gear_ratio=gear_ratio,
            gravity=gravity,
            acceleration=acceleration,
            rpm=rpm,
            thrust=thrust,
            thrust_at=thrust_at,
        )
        return static_state.StaticState(self, *case)

    def load_cases(self, cases: Mapping[str, Mapping[str, Any]]) -> LoadCases:
        """Return travel and force of each mount at rest under several load cases.

        Parameters
        ----------
        cases : mapping of str to mapping of str to object
            Name of each case → arguments of :meth:`static`, such as ``torque``, ``gear_ratio``,
            ``acceleration`` or ``gravity``; an empty one is rest under gravity.

        Returns
        -------
        LoadCases
            Travels and forces by case and mount, the worst case of each mount.

        Raises
        ------
        InputError
            If there is no case, an argument is out of range, a motion is free, the engine has no
            cycle, or a receptance carries the mounts.

        Examples
        --------
        >>> import crankpin as cp
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5, gap=0.006, snubber_stiffness=1e6)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> body = cp.RigidBody(mass=160, cg=(0.03, 0.1, 0.2), inertia=(7, 8, 4.5))
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> cases = p.load_cases(
        ...     {"rest": {}, "first gear": {"torque": 150, "gear_ratio": 13}, "braking":
        ...      {"acceleration": (0, 0, 8)}}
        ... )
        >>> cases.travel.dims, cases.sel(case="first gear").snubbers
        (('case', 'all_mounts', 'axis'), ('a −2', 'b +2'))
        """
        return loaded.load_cases(self, cases)

    def modes(self, frequency: float | None = None) -> MountModes:
        """Return the natural modes, with the dynamic stiffness of the mounts: six, or twelve.

        On a subframe there are twelve, of both bodies.

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
            If stiffness depends on frequency and none is given, or is below zero there, or a
            receptance carries the mounts.

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
        hertz = None if frequency is None else inputs.number("frequency", frequency)
        return natural.MountModes(self, hertz)

    @documented(modes)
    def axes(self, frequency: float | None = None) -> RollAxes:
        """Return torque roll axis and elastic roll axis, with static and with dynamic stiffness.

        Returns
        -------
        RollAxes
            Directions, angles, distances.

        Raises
        ------
        InputError
            If a motion is free, stiffness depends on frequency and none is given, or a receptance
            carries the mounts.
        """
        hertz = None if frequency is None else inputs.number("frequency", frequency)
        return natural.RollAxes(self, hertz)

    @documented()
    def response(
        self,
        rpm: ArrayLike | None = None,
        *,
        orders: Orders = "auto",
        rtol: float | None = None,
        base: BaseMotion | None = None,
    ) -> MountResponse:
        """Return forces, motion and power at each speed and order of the engine.

        The engine's force, moment and roll torque of each order, moved to the centre of gravity,
        act on the body; its mean torque does not count here (:meth:`static`).

        Parameters
        ----------
        rpm : array_like, optional
            Crank speeds, rpm: one, or several as a dimension of the result. Left out where a base
            moves by frequency, and the engine stands.
        orders : number, sequence of numbers or "auto", default "auto"
            Multiples of crank speed, halves too, or ``"auto"`` for those of the engine's balance
            that reach ``rtol``, and those of a base that moves.
        base : BaseMotion, optional
            Motion of what carries the mounts, or the subframe under them; by default it does not
            move. By frequency it moves alone, by order while the engine runs.

        Returns
        -------
        MountResponse
            Forces of the mounts, motion of points, power, transmissibility; on a base that moves a
            :class:`~crankpin.results.BaseResponse`.

        Raises
        ------
        InputError
            If an order meets a mode without damping, or a table of stiffness does not reach to its
            frequency.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine, or the mounts leave a motion free.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> floor = cp.BaseMotion({f: (0, 0.05, 0) for f in (2, 10, 50)}, of="acceleration")
        >>> r = p.response(base=floor)
        >>> r.at((0, 0.3, 0)).base_transmissibility[:, 0, 1].round(3)
        array([1.048, 6.809, 0.03 ])
        """
        moving: object = base
        if not isinstance(moving, BaseMotion | None):
            raise inputs.rejected("base", moving, "give a crankpin.BaseMotion")
        if base is not None:
            self._require_engine_axes("base")
        if base is not None and base.by == "frequency":
            hint = "leave it out: the base moves by frequency"
            for name, value, default in (("rpm", rpm, None), ("rtol", rtol, None)):
                if value is not default:
                    raise inputs.rejected(name, value, hint)
            if not isinstance(orders, str):
                raise inputs.rejected("orders", orders, hint)
            return forced.response_to(base, self)
        if rpm is None:
            hint = "give crank speeds, or a base that moves by frequency"
            raise inputs.rejected("rpm", rpm, hint)
        return forced.response(self, rpm, orders=orders, rtol=rtol, base=base)

    def _cancelled(
        self,
        response: MountResponse,
        *given: Any,  # noqa: ANN401 - as MountResponse.cancel documents them
        **options: Any,  # noqa: ANN401
    ) -> Cancellation:
        """Return a cancellation, for responses, which it is made of."""
        self._require_engine_axes("cancel")
        return active.cancel(response, *given, **options)

    def velocity_feedback(
        self, actuator: Actuator, *, gain: float | None = None
    ) -> VelocityFeedback:
        """Return the largest stable gain of velocity feedback through an inertial actuator.

        The motor pushes with −gain times the velocity of its place on the powertrain, and with the
        opposite force on its mass. Below the resonance of that mass it pushes the wrong way: it is
        stable up to a gain only, and of use where the resonance is well below the modes. Without
        gain every mode that it drives has to be damped, by mounts or by the actuator's own spring:
        where nothing is, any gain makes some of them grow. Of mounts with tables the limit is that
        within their frequencies.

        Parameters
        ----------
        actuator : Actuator
            An actuator with mass and resonance.
        gain : float, optional
            Gain, N·s/m; by default half of the largest that is stable.

        Returns
        -------
        VelocityFeedback
            Largest stable gain, margin, and velocities with over without feedback.

        Raises
        ------
        InputError
            If it is no inertial actuator, nothing damps a mode that it drives, a table of stiffness
            does not reach to the frequencies that decide, or a receptance carries the mounts.
        """
        self._require_engine_axes("velocity_feedback")
        return feedback.velocity_feedback(self, actuator, gain)

    @documented(response)
    def sweep(
        self,
        rpm: ArrayLike,
        *,
        factor: ArrayLike | None = None,
        engines: Mapping[str, Engine] | None = None,
        receivers: Any = "body_force",  # noqa: ANN401 - points, pairs, a mapping or a word
        orders: Orders = "auto",
        rtol: float | None = None,
    ) -> MountSweep:
        """Return motion or force at receivers by balance factor, or of several engines.

        Which balance factor leaves the least velocity at a bar end or a seat depends on mounts and
        body, which direction they mind: the best one of a range of factors is exact.

        Parameters
        ----------
        rpm : array_like
            Crank speeds, rpm, over which the largest responses are taken.
        factor : array_like, optional
            Balance factors: shares κ of the reciprocating mass that counterweights opposite the
            crankpins balance, 0 to 10, in place of the engine's counterweights
            (:func:`crankpin.bob_weight`).
        engines : mapping of str to Engine, optional
            Name → engine on these mounts, in place of ``factor``: of other throws, or masses.
        receivers : sequence, mapping or {"body_force", "mount_force"}, default "body_force"
            What is read: the velocity of points (x, y, z) of the powertrain, of receivers of a
            receptance by name, or of motions of :meth:`MountResponse.at`; or of pairs of one of
            these and a direction, along that; in a list or by name in a mapping. Or the mounts'
            sum, or their forces.

        Returns
        -------
        MountSweep
            Rms of all orders by factor or engine, speed and receiver, and the best factor.

        Raises
        ------
        InputError
            If an argument is out of range, both of ``factor`` and ``engines`` are given, or an
            order meets a mode without damping.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine, or the mounts leave a motion free.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=45, cg=(0, 0.05, 0.02), inertia=(1.1, 1.3, 0.9))
        >>> mounts = [  # stiff fore and aft, soft up and down
        ...     cp.Mount(name, at=at, stiffness=(4e6, 4e5, 1e6), loss_factor=0.1)
        ...     for name, at in [("a", (0.2, 0, 0.1)), ("b", (-0.2, 0, 0.1)), ("c", (0, 0.2, -0.1))]
        ... ]
        >>> p = cp.Powertrain(cp.Engine.preset("single"), body, mounts)
        >>> f = p.sweep(range(3000, 7001, 100), factor=[0, 0.5, 1])
        >>> f.force.dims, f.force.shape, 0 < f.best() < 0.1
        (('factor', 'rpm', 'receiver'), (3, 41, 1), True)
        """
        self._require_engine_axes("sweep")
        return swept.sweep(
            self, rpm, factor=factor, engines=engines, receivers=receivers, orders=orders, rtol=rtol
        )

    @documented(response)
    def designs(
        self,
        rpm: ArrayLike,
        vary: Mapping[str, Mapping[str, ArrayLike]],
        *,
        orders: Orders = "auto",
        rtol: float | None = None,
        mount_force: bool = False,
        points: Iterable[ArrayLike] = (),
        frequency: float | None = None,
    ) -> DesignResponses:
        """Return natural frequencies and largest responses of many designs of the mounts.

        Parameters
        ----------
        rpm : array_like
            Crank speeds, rpm, over which the largest responses are taken.
        vary : mapping of str to mapping of str to array_like
            Name of a mount to its figures that differ: ``"at"``, ``"tilt_deg"``, ``"stiffness"``,
            ``"dynamic_stiffness"``, ``"loss_factor"`` or ``"damping"``, one value, or one along
            each axis, of each design: of shape (n_designs,) or (n_designs, 3).
        mount_force : bool, default False
            True: with the force of each mount, besides their sum.
        points : sequence of points, default ()
            Places (x, y, z) in the engine's axes, m, whose velocity counts.
        frequency : float, optional
            Frequency at which natural frequencies take the dynamic stiffness, Hz, where it depends
            on frequency.

        Returns
        -------
        DesignResponses
            Frequencies, largest peaks of each order, largest rms values of all orders.

        Raises
        ------
        InputError
            If a design has figures that no mount has (its index is named), an order meets a mode
            without damping, or the powertrain has a flexible support.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine, or a stiffness seems to be in N/mm,
            or a place in millimetres.

        Examples
        --------
        >>> import crankpin as cp
        >>> import numpy as np
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5, loss_factor=0.1)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> stiffness = np.linspace(1e5, 4e5, 1000)
        >>> d = p.designs(range(700, 6001, 50), {"c": {"stiffness": stiffness}}, orders=[2])
        >>> d.body_force.shape, d.powertrain_of(999).mounts[2].stiffness
        ((1000, 1, 3), (400000.0, 400000.0, 400000.0))
        """
        self._require_engine_axes("designs")
        return many.designs(
            self,
            rpm,
            vary,
            orders=orders,
            rtol=rtol,
            mount_force=mount_force,
            points=points,
            frequency=frequency,
        )

    @documented(modes)
    def robustness(
        self,
        stiffness: float | Mapping[str, float] = 0.1,
        *,
        mass: float = 0.0,
        inertia: float = 0.0,
        cg: float = 0.0,
        corners: Literal["axes", "mounts"] = "axes",
        frequency: float | None = None,
    ) -> MountRobustness:
        """Return the ranges of natural frequencies and purity within tolerances.

        Bounds of frequencies by stiffness, mass and inertia are exact: each frequency is monotone
        in each of them. Purity is not, and searched: at every corner of the stiffnesses, at random
        points, and from the worst of them along lines. The place of the centre of gravity is taken
        by itself. A subframe is as it is.

        Parameters
        ----------
        stiffness : float or mapping of str to float, default 0.1
            Tolerance of the stiffness of every mount, or of mounts by name, over it: 0.1 is ±10 %.
        mass : float, default 0.0
            Tolerance of the mass, over it.
        inertia : float, default 0.0
            Tolerance of the tensor of inertia, over it.
        cg : float, default 0.0
            Tolerance of the centre of gravity along x, y and z, m.
        corners : {"axes", "mounts"}, default "axes"
            Whether the axes of a mount are stiff or soft each by itself, or together; there are
            corners of 2 to the power of their number, at most 2¹⁸.

        Returns
        -------
        MountRobustness
            Bounds of the frequencies, the least purity found and where, derivatives by the CG.

        Raises
        ------
        InputError
            If a tolerance is not from 0 to 1, there are too many corners, or a receptance carries
            the mounts.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> mounts = [
        ...     cp.Mount(name, at=at, stiffness=2e5)
        ...     for name, at in [("a", (0.3, 0, 0)), ("b", (-0.3, 0, 0)), ("c", (0, 0, 0.7))]
        ... ]
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> r = p.robustness(stiffness=0.19)
        >>> (r.frequency_bounds[0] / r.frequency).round(12)
        array([0.9, 0.9, 0.9, 0.9, 0.9, 0.9])
        """
        self._require_engine_axes("robustness")
        if isinstance(stiffness, Mapping):
            for name in stiffness:
                inputs.one_of("stiffness", name, self.names)
            shares = [stiffness.get(name, 0.0) for name in self.names]
        else:
            shares = [stiffness] * len(self.names)
        inputs.one_of("corners", corners, ("axes", "mounts"))
        hertz = None if frequency is None else inputs.number("frequency", frequency)
        return MountRobustness(
            self,
            tuple(inputs.finite("stiffness", share) for share in shares),
            inputs.finite("mass", mass),
            inputs.finite("inertia", inertia),
            inputs.finite("cg", cg),
            corners == "axes",
            hertz,
        )

    def with_support(self, support: Support | None) -> Self:
        """Return the same powertrain on a flexible support.

        Parameters
        ----------
        support : Subframe or Receptance or None
            What carries the mounts; None for what does not move.

        Returns
        -------
        Powertrain
            The same with that support.

        Raises
        ------
        InputError
            If it cannot carry the mounts.

        Examples
        --------
        >>> import crankpin as cp
        >>> body = cp.RigidBody(mass=150, cg=(0, 0.06, 0.15), inertia=(7, 8, 4.5))
        >>> places = [(0.3, 0, 0), (-0.3, 0, 0), (0, 0, 0.7)]
        >>> mounts = [cp.Mount(f"{k}", at, 2e5, loss_factor=0.1) for k, at in enumerate(places)]
        >>> p = cp.Powertrain(cp.Engine.preset("i4"), body, mounts)
        >>> base = cp.Subframe(
        ...     cp.RigidBody(mass=100, cg=(0, -0.1, 0.2), inertia=(9, 12, 6)),
        ...     [mount.replace(stiffness=8e5) for mount in mounts],
        ... )
        >>> r = p.with_support(base).response(rpm=3000, orders=[2])
        >>> bool(r.ground_force[2].peak < r.body_force[2].peak)
        True
        """
        return self.replace(support=support)

    def with_misfire(self, cylinder: int) -> Self:
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
            If the engine has no cycles, no such cylinder, or none that fires besides it.
        """
        number = inputs.whole("cylinder", cylinder)
        engine = self._require_engine("cylinder")
        cycles = engine.cycles
        if cycles is None:
            raise inputs.rejected(
                "cylinder", number, "no cylinder fires; give engine.with_cycle(…)"
            )
        if not 1 <= number <= len(cycles):
            raise inputs.rejected("cylinder", number, f"give a number from 1 to {len(cycles)}")
        of_cylinders: list[Any] = [*cycles]
        of_cylinders[number - 1] = None
        if all(one is None for one in of_cylinders):
            hint = "it is the last that fires; give engine.with_cycle(None), without gas at all"
            raise inputs.rejected("cylinder", number, hint)
        ends = [one if k != number else None for k, one in enumerate(engine.crank_ends or (), 1)]
        if not any(ends):
            return self.replace(engine=engine.with_cycle(of_cylinders))
        rods = engine.rod_diameter
        fired = engine.with_cycle(of_cylinders, crank_end=ends, rod_diameter=rods)
        return self.replace(engine=fired)

    # --- pages ------------------------------------------------------------------------------------

    @documented(modes)
    def view(
        self,
        rpm: float = 800.0,
        *,
        frequency: float | None = None,
        controls: str | Sequence[str] | None = None,
    ) -> PowertrainWidget:
        """Return the engine turning on its mounts as a widget for notebooks (needs anywidget).

        Mounts can be dragged; modes and response follow. Its traits ``angle_deg``, ``rpm``,
        ``order``, ``mode`` and ``mounts`` move the page when they are set, and follow its reader;
        ``powertrain`` is the one with the mounts as they stand.

        Parameters
        ----------
        rpm : float, default 800.0
            Crank speed at first, rpm.
        controls : str or sequence of str, optional
            Names of the controls that are shown, in this order, or one name: ``"crank_angle"``,
            ``"rpm"``, ``"order"``, ``"mode"``, ``"rocking"`` for how much the motion is magnified,
            ``"mounts"`` for the table of mounts and to drag them, and ``"view"`` for the choice
            above the curves over speed. ``"none"`` or an empty sequence leaves the pictures alone.
            By default all.

        Returns
        -------
        PowertrainWidget
            A widget of anywidget.

        Raises
        ------
        InputError
            If an argument is out of range, stiffness depends on frequency and none is given, or
            the powertrain has a flexible support.
        ImportError
            If anywidget is not installed.
        """
        from crankpin.view.widget import PowertrainWidget  # noqa: PLC0415

        return PowertrainWidget(self, rpm, frequency=frequency, controls=controls)

    @documented(view, modes)
    def save_html(
        self,
        path: str | Path,
        rpm: float = 800.0,
        *,
        frequency: float | None = None,
        controls: str | Sequence[str] | None = None,
    ) -> None:
        """Write the engine turning on its mounts as a self-contained page for browsers.

        The page evaluates the library's coefficients: mounts can be dragged in it, and modes and
        response follow.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.html``.

        Raises
        ------
        InputError
            If an argument is out of range, the name ends otherwise, stiffness depends on frequency
            and none is given, or the powertrain has a flexible support.
        OSError
            If the file cannot be written.
        """
        from crankpin.view.page import save_mounted_html  # noqa: PLC0415

        save_mounted_html(self, path, rpm=rpm, frequency=frequency, controls=controls)

    # --- files ------------------------------------------------------------------------------------

    def save(self, path: str | Path) -> None:
        """Write engine, body and mounts to an engine file, ``.toml`` or ``.json``.

        Files are in the engine's axes. :meth:`Engine.load` reads the engine of such a file alone.

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
        text = self._text(toml=toml)
        files.write(file, engine_files.commented(text) if toml else text)

    def _text(self, *, toml: bool) -> str:
        """Return the text of an engine file."""
        return self._core.to_text(self._engine_core, toml)

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
            hint = "the file has no [powertrain], body and mounts; Engine.load reads its engine"
            raise inputs.rejected("path", str(file), hint)
        body = RigidBody._of(core.body)
        mounts = [Mount._of(figures) for figures in core.mounts]
        support = supports.of_core(core.support)
        for mount in (*mounts, *getattr(support, "mounts", ())):
            mount._warn()
        engine = None if core_engine is None else Engine._read(core_engine)
        forces = [ForceTable._of(fields) for fields in json.loads(core.forces)]
        vectors, torque = core.rest
        gravity, acceleration, thrust, place = vectors
        rest = {"gravity": gravity, "acceleration": acceleration, "torque": torque}
        rest |= {"thrust": thrust, "thrust_at": place}
        with suppressed():
            return cls(engine, body, mounts, support, forces, rest=rest)
