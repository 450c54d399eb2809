"""Locomotives: an engine on axles, and the counterweights in its wheels."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.frames import Framed
from crankpin._support.messages import Hint, suppressed
from crankpin._support.record import AbsentError, Input, read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.balancing.counterweights import counterweights
from crankpin.analysis.geometry import direction
from crankpin.analysis.locomotive_forces import LocomotiveForces
from crankpin.model import checks
from crankpin.model.cylinder import Cylinder
from crankpin.model.engine import Engine
from crankpin.model.shafts import Unbalance, listed_items

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles

SIDES = ("right", "left")
"""Wheels of an axle in the direction of travel: the right one has the lower z."""
KMH = 3.6
"""A metre per second, km/h."""
NEGLIGIBLE = 1e-12
"""Part of all that turns with an axle below which its unbalance is rounding."""
LONGEST_FRACTION = 10**9
"""Largest denominator of an angle that is a fraction."""


class Locomotive(Framed, Input):
    """Steam locomotive: horizontal cylinders on axles, and the counterweights in its wheels.

    It is an engine with bores at 180° and a crank for each axle, z along the axles from right to
    left. The wheels turn counter-clockwise, so that it travels towards −x, and the cylinders are
    ahead of the axle. Weights in the two wheels of each axle balance all that turns with the axle
    and a ``share`` of the reciprocating masses, in force and moment: as those of
    :func:`crankpin.counterweights`. Their vertical part is the hammer blow; what they leave of the
    pistons' inertia pushes the frame to and fro (the variation of tractive effort) and from side
    to side (the swaying couple).

    Parameters
    ----------
    cylinder : Cylinder or sequence of Cylinder
        Moving parts of all cylinders, or of each; an infinite ``rod_length`` gives the textbook.
    z : sequence of float, shape (n_cylinders,)
        Places of the cylinders' axes along the axle, m.
    throws_deg : sequence of number or str, shape (n_cylinders,)
        Cranks in the direction of rotation, relative to each other, degrees.
    wheel_z : pair of float
        Places of the planes of the two wheels along the axle, where the weights are, m.
    share : array_like, default 0.0
        Share of the reciprocating mass that is balanced, 0 to 1, of all axles together, of which
        each has an equal part; or of each axle.
    rotating_mass : array_like, default 0.0
        Mass at the crank radius in the plane of each cylinder, crankpin and big end, kg.
    inclination_deg : number, str or sequence of these, default 0.0
        Angle of the cylinders, or of each, above the horizontal, degrees.
    wheel_diameter : float, optional
        Diameter of the wheels at the rail, m, for speeds in km/h.
    axle_x : sequence of float, default (0.0,)
        Places of the coupled axles along the rails, from the first one backwards, m.
    driving : int or sequence of int, default 1
        Number of the axle that the cylinders, or each of them, drive; 1 is the first.
    coupling : sequence of Unbalance, optional
        Parts of coupling rods and their pins that turn with every axle; with ``pin`` the angle is
        counted from the crank of that cylinder.
    weights : sequence of sequence of Unbalance, optional
        Counterweights of each axle in place of those that ``share`` asks for.
    wheel_load : array_like, optional
        Static load of a wheel on the rail, N; of all, or of right and left of each axle.
    name : str, optional
        Name of the locomotive; may be empty.

    Raises
    ------
    InputError
        If lists differ in length or a figure is out of range, the wheels are in one plane, or
        both ``share`` and ``weights`` are given.

    Examples
    --------
    >>> import math
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.3, rod_length=math.inf, reciprocating_mass=300)
    >>> two = cp.Locomotive(
    ...     cylinder, z=[-0.35, 0.35], throws_deg=[0, 90], wheel_z=[-0.8, 0.8], share=2 / 3,
    ...     wheel_diameter=1.7, wheel_load=71e3, name="Two cylinders",
    ... )
    >>> two
    Two cylinders: counterweights and what they leave
    wheel          z m  weight kg·m  angle °  unbalance kg·m  lifts at rpm  lifts at km/h
    axle 1 right  -0.8       46.309   21.371          46.309        373.91         119.82
    axle 1 left    0.8       46.309   68.629          46.309        373.91         119.82
    >>> round(two.forces(speed_kmh=90).tractive_variation.peak)
    36701
    """

    cylinder: Cylinder | tuple[Cylinder, ...]
    z: tuple[float, ...]
    throws_deg: tuple[str, ...]
    wheel_z: tuple[float, float]
    share: float | tuple[float, ...]
    rotating_mass: float | tuple[float, ...]
    inclination_deg: str | tuple[str, ...]
    wheel_diameter: float | None
    axle_x: tuple[float, ...]
    driving: int | tuple[int, ...]
    coupling: tuple[Unbalance, ...]
    weights: tuple[tuple[Unbalance, ...], ...] | None
    wheel_load: float | tuple[float, ...] | None
    name: str

    def __init__(
        self,
        cylinder: Cylinder | Sequence[Cylinder],
        *,
        z: ArrayLike,
        throws_deg: Angles,
        wheel_z: ArrayLike,
        share: ArrayLike = 0.0,
        rotating_mass: ArrayLike = 0.0,
        inclination_deg: Angle | Angles = 0.0,
        wheel_diameter: float | None = None,
        axle_x: ArrayLike = (0.0,),
        driving: int | Sequence[int] = 1,
        coupling: Iterable[Unbalance] = (),
        weights: Iterable[Iterable[Unbalance]] | None = None,
        wheel_load: ArrayLike | None = None,
        name: str = "",
    ) -> None:
        places, wheels, axles = (
            tuple(inputs.limited(argument, x) for x in inputs.listed_numbers(argument, values))
            for argument, values in (("z", z), ("wheel_z", wheel_z), ("axle_x", axle_x))
        )
        count = len(places)
        if not count:
            raise inputs.rejected("z", z, "give the place of one cylinder, or of several, m")
        if len(wheels) != 2 or wheels[0] == wheels[1]:
            raise inputs.rejected("wheel_z", wheel_z, "give the places of two wheels, m")
        if not axles:
            raise inputs.rejected("axle_x", axle_x, "give the place of one axle, or of several, m")
        drives = [driving] * count if not inputs.is_listed(driving) else driving
        driven = [inputs.whole("driving", axle, 1, len(axles)) for axle in drives]  # type: ignore[union-attr]
        cylinders = [cylinder] * count if isinstance(cylinder, Cylinder) else cylinder
        tilts = inclination_deg if inputs.is_listed(inclination_deg) else [inclination_deg] * count
        throws = tuple(inputs.angles("throws_deg", throws_deg))
        each: dict[str, tuple[Any, ...]] = {
            "cylinder": listed_items("cylinder", cylinders, Cylinder),
            "rotating_mass": tuple(inputs.per_item("rotating_mass", rotating_mass, count)),
            "inclination_deg": tuple(inputs.angles("inclination_deg", tilts)),
            "driving": tuple(driven),
        }
        for argument, values in ({"throws_deg": throws} | each).items():
            if len(values) != count:
                hint = f"give {count}, one for each place of z"
                raise inputs.faulty(argument, f"has {len(values)} entries", hint)
        each["share"] = _shares(share, len(axles))
        if weights is not None and any(each["share"]):
            raise inputs.rejected("share", share, "leave it out where the weights are given")
        each["wheel_load"] = _of_wheels(wheel_load, 2 * len(axles))
        diameter = wheel_diameter
        if diameter is not None:
            diameter = inputs.positive("wheel_diameter", diameter)
        one: dict[str, Any] = {
            "cylinder": cylinder,
            "rotating_mass": rotating_mass,
            "driving": driving,
        }
        one |= {"inclination_deg": inclination_deg, "wheel_load": wheel_load}
        # One figure for all stays one: a copy may have another number of axles.
        fields = {
            name: values[0] if values and not inputs.is_listed(one.get(name)) else values or None
            for name, values in each.items()
        }
        fields["share"] = each["share"] if np.ndim(share) else inputs.number("share", share)
        first, second = sorted(wheels)
        self.__dict__.update(
            fields, z=places, throws_deg=throws, wheel_z=(first, second), axle_x=axles,
            wheel_diameter=diameter, coupling=listed_items("coupling", coupling, Unbalance),
            weights=None if weights is None else _by_axle(weights, len(axles)),
            name=inputs.text("name", name), _each=each,
        )  # fmt: skip
        for field, weight in (
            *(("coupling", weight) for weight in self.coupling),
            *(("weights", weight) for of_axle in self.weights or () for weight in of_axle),
        ):
            if weight.crank or (weight.pin or 1) > count:
                fault = f"has crank {weight.crank} and pin {weight.pin}"
                hint = f"leave crank out, and give a pin of 1 to {count} or none"
                raise inputs.faulty(field, fault, hint)
            if field == "weights" and weight.z not in self.wheel_z:
                raise inputs.faulty(
                    field, f"has a place {weight.z:g}", Hint.of("give one of `wheel_z`, m")
                )
        engine = self.engine  # an error, or a warning, of the engine's figures
        checks.place(engine._core, "wheel_z", *self.wheel_z)
        checks.place(engine._core, "axle_x", *(x - self.axle_x[0] for x in axles), middle=0.0)

    def _of_each(self, name: str) -> tuple[Any, ...]:
        """Return a field of each cylinder, axle or wheel."""
        each: dict[str, tuple[Any, ...]] = self.__dict__["_each"]
        return each[name]

    @property
    def _loads(self) -> tuple[float, ...]:
        """Static load of each wheel, N; empty where it is not known."""
        return self._of_each("wheel_load")

    # --- the engine ------------------------------------------------------------------------------

    @property
    def wheels(self) -> tuple[str, ...]:
        """Names of the wheels: right and left of each axle, such as ``"axle 1 right"``."""
        return tuple(f"axle {k} {side}" for k in range(1, len(self.axle_x) + 1) for side in SIDES)

    @cached_property
    def engine(self) -> Engine:
        """The engine with a crank for each axle, and all that turns with them as counterweights.

        The main crank is the axle that cylinder 1 drives; moments are about the middle plane
        between the wheels.
        """
        main = self._of_each("driving")[0] - 1
        order = [main, *(k for k in range(len(self.axle_x)) if k != main)]
        weights = [
            weight.replace(crank=order.index(axle))
            for axle, of_axle in enumerate(self._balancing)
            for weight in (*self._coupled, *of_axle)
        ]
        return self._engine(
            rotating_mass=self._of_each("rotating_mass"),
            counterweights=weights,
            cranks=[(self.axle_x[k] - self.axle_x[main], 0.0, 1) for k in order[1:]],
            crank=[order.index(axle - 1) for axle in self._of_each("driving")]
            if order[1:]
            else None,
            name=self.name,
        )

    def _engine(self, **arguments: Any) -> Engine:  # noqa: ANN401 - of the builder
        return Engine.from_lists(
            self._of_each("cylinder"),
            bank_deg=self._bores,
            pin_deg=self._pins,
            z=self.z,
            reference_z=sum(self.wheel_z) / 2.0,
            strokes=2,
            **arguments,
        )

    @property
    def _bores(self) -> list[str]:
        """Directions of the bores, exact degrees."""
        return [_exact(180 - Fraction(tilt)) for tilt in self._of_each("inclination_deg")]

    @property
    def _pins(self) -> list[str]:
        """Directions of the cranks at θ = 0, where cylinder 1 is at its dead centre."""
        start = Fraction(self._bores[0]) - Fraction(self.throws_deg[0])
        return [_exact(start + Fraction(throw)) for throw in self.throws_deg]

    @property
    def _coupled(self) -> list[Unbalance]:
        return [self._fixed(weight) for weight in self.coupling]

    def _fixed(self, weight: Unbalance) -> Unbalance:
        """Return a weight by its direction at θ = 0, which no crankpin carries."""
        if weight.pin is None:
            return weight
        angle = Fraction(self._pins[weight.pin - 1]) + Fraction(weight.exact_angle)
        return Unbalance(weight.amount, weight.z, _exact(angle))

    # --- weights in the wheels -------------------------------------------------------------------

    @cached_property
    def _balancing(self) -> tuple[tuple[Unbalance, ...], ...]:
        """Counterweights of each axle."""
        if self.weights is not None:
            return tuple(tuple(map(self._fixed, of_axle)) for of_axle in self.weights)
        return tuple(
            tuple(weight for weight in self._opposing(axle, (), share) if weight.amount)
            for axle, share in enumerate(self._of_each("share"))
        )

    def _opposing(
        self, axle: int, weights: Iterable[Unbalance], share: float
    ) -> tuple[Unbalance, ...]:
        """Return the weights in both wheels of an axle that balance it, zero or not.

        Parameters
        ----------
        axle
            Index of the axle.
        weights
            Weights that it has besides its coupling rods.
        share
            Share of the reciprocating masses that is balanced too.
        """
        masses = [
            mass if driven == axle + 1 else 0.0
            for mass, driven in zip(
                self._of_each("rotating_mass"), self._of_each("driving"), strict=True
            )
        ]
        turning = [*self._coupled, *weights]
        planes = dict(zip(SIDES, self.wheel_z, strict=True))
        with suppressed():  # Warned of where the whole engine is made.
            engine = self._engine(rotating_mass=masses, counterweights=turning)
            fit = counterweights(engine, planes=planes, factor=share)
        size = sum(weight.amount for weight in turning) + sum(
            (mass + share * cylinder.reciprocating_mass) * cylinder.crank_radius
            for mass, cylinder in zip(masses, self._of_each("cylinder"), strict=True)
        )
        by_side = {
            side: weight for side, weight in fit.by_plane if weight.amount > NEGLIGIBLE * size
        }
        return tuple(by_side.get(side, Unbalance(0.0, planes[side])) for side in SIDES)

    @cached_property
    def unbalances(self) -> tuple[Unbalance, ...]:
        """Unbalance that turns with each wheel, in its plane, right and left of each axle.

        Its force is amount·ω², its vertical part the hammer blow.
        """
        left = []
        for axle, weights in enumerate(self._balancing):
            for weight in self._opposing(axle, weights, 0.0):
                angle = _exact(Fraction(weight.exact_angle) + 180)
                left.append(Unbalance(weight.amount, weight.z, angle) if weight.amount else weight)
        return tuple(left)

    @property
    def lifting_rpm(self) -> NDArray[np.float64]:
        """Speed at which the hammer blow of each wheel is its static load, rpm: (n_wheels,).

        Infinite without a hammer blow. An AttributeError where the loads are not given.
        """
        if not self._loads:
            hint = Hint.of("give the static load of the wheels, `wheel_load`")
            raise inputs.faulty("lifting_rpm", "is undefined", hint, AbsentError)
        amounts = np.array([weight.amount for weight in self.unbalances])
        with np.errstate(divide="ignore"):
            omega = np.sqrt(np.array(self._loads) / amounts)
        return read_only(np.where(amounts > 0.0, omega * 60.0 / math.tau, np.inf))

    @property
    def _kmh_per_rpm(self) -> float:
        """Speed at 1 rpm, km/h."""
        if self.wheel_diameter is None:
            hint = Hint.of("give the diameter of the wheels, `wheel_diameter`, m")
            raise inputs.faulty("speed_kmh", "is undefined", hint, AbsentError)
        return math.pi * self.wheel_diameter / 60.0 * KMH

    def _speed(self, rpm: float | None, speed_kmh: float | None) -> float:
        """Return the speed of the wheels, rpm."""
        inputs.only_one_of(rpm=rpm, speed_kmh=speed_kmh)
        if speed_kmh is None:
            inputs.angular_speed(rpm)
            return inputs.number("rpm", rpm)
        speed = inputs.finite("speed_kmh", speed_kmh) / self._kmh_per_rpm
        try:
            inputs.angular_speed(speed)
        except InputError:
            hint = "give km/h, zero or more, that these wheels can have"
            raise inputs.rejected("speed_kmh", speed_kmh, hint) from None
        return speed

    # --- questions -------------------------------------------------------------------------------

    def forces(
        self,
        rpm: float | None = None,
        *,
        speed_kmh: float | None = None,
        theta_deg: ArrayLike | None = None,
    ) -> LocomotiveForces:
        """Return hammer blow, variation of tractive effort and swaying couple at a speed.

        Parameters
        ----------
        rpm : float, optional
            Speed of the wheels, rpm.
        speed_kmh : float, optional
            Speed of the locomotive in its place, km/h.
        theta_deg : array_like, shape (n_theta,), optional
            Angles of the wheels, degrees; by default those of a turn in steps of one degree, while
            peaks are those at any angle.

        Returns
        -------
        LocomotiveForces
            Forces over the turn, N and N·m.

        Raises
        ------
        InputError
            If not one speed is given, or a figure is out of range.
        """
        speed = self._speed(rpm, speed_kmh)
        theta = inputs.crank_angles(np.arange(361.0) if theta_deg is None else theta_deg)
        inputs.warn_of_units(mean_piston_speed(self.engine, speed))
        return LocomotiveForces(self, speed, inputs.copied(theta), theta_deg is None)

    def share_for(
        self, hammer_blow: float, *, rpm: float | None = None, speed_kmh: float | None = None
    ) -> float:
        """Return the share of the reciprocating masses with which the hammer blow is a given one.

        Parameters
        ----------
        hammer_blow : float
            Largest hammer blow of any wheel, N.
        rpm : float, optional
            Speed of the wheels, rpm.
        speed_kmh : float, optional
            Speed of the locomotive in its place, km/h.

        Returns
        -------
        float
            The share, in equal parts on all axles; above 1 where all may be balanced.

        Raises
        ------
        InputError
            If not one speed is given, a figure is out of range, or the weights are given.
        """
        limit = inputs.positive("hammer_blow", hammer_blow)
        omega = inputs.angular_speed(self._speed(rpm, speed_kmh))
        if self.weights is not None:
            raise inputs.faulty("share_for", "is undefined", "leave out the weights", AbsentError)
        largest = max(weight.amount for weight in self.replace(share=1.0).unbalances)
        if not largest:
            raise inputs.faulty("share_for", "is undefined", "no piston has a mass", AbsentError)
        share = limit / largest / omega / omega if omega else math.inf
        if not share <= _core.LARGEST:
            name, speed = ("rpm", rpm) if speed_kmh is None else ("speed_kmh", speed_kmh)
            raise inputs.rejected(name, speed, "give a speed at which the wheels turn")
        return share

    @property
    def table(self) -> Table:
        """Counterweights of each wheel, the unbalance left, and the speed at which it lifts."""
        by_wheel: list[tuple[float | None, float | None]] = []
        for of_axle in self._balancing:
            for z in self.wheel_z:
                amount = sum(
                    (weight.amount * complex(direction(weight.angle_deg)) for weight in of_axle
                     if weight.z == z),
                    0j,
                )  # fmt: skip
                angle = float(np.angle(amount, deg=True)) % 360.0 if amount else None
                by_wheel.append((abs(amount), angle))
        amounts, angles = zip(*by_wheel, strict=True)
        columns = [
            Column("wheel", self.wheels),
            Column("z", self.wheel_z * len(self.axle_x), "m"),
            Column("weight", amounts, "kg·m"),
            Column("angle", angles, "°"),
            Column("unbalance", tuple(weight.amount for weight in self.unbalances), "kg·m"),
        ]
        if self._loads:
            columns.append(Column("lifts at", self.lifting_rpm, "rpm"))
            if self.wheel_diameter is not None:
                columns.append(Column("lifts at", self.lifting_rpm * self._kmh_per_rpm, "km/h"))
        title = f"{labels.one_line(self.name) or 'Locomotive'}: counterweights and what they leave"
        return Table(title, tuple(columns))


def _exact(angle: Fraction) -> str:
    """Return an angle less whole turns, as exact as the core takes it, degrees."""
    reduced = angle % 360
    return str(reduced) if reduced.denominator <= LONGEST_FRACTION else repr(float(reduced))


def _shares(share: ArrayLike, axles: int) -> tuple[float, ...]:
    """Return the share of each axle, of which one number is the sum."""
    shares = inputs.finite_array("share", inputs.listed_numbers("share", share)).tolist()
    if not np.ndim(share):
        shares = [shares[0] / axles] * axles
    if len(shares) != axles:
        hint = f"give one number, or {axles}, one for each axle"
        raise inputs.faulty("share", f"has {len(shares)} entries", hint)
    if not (min(shares) >= 0.0 and sum(shares) <= 1.0 + NEGLIGIBLE):
        raise inputs.rejected("share", share, "give 0 to 1, of all axles together")
    return tuple(shares)


def _of_wheels(load: ArrayLike | None, wheels: int) -> tuple[float, ...]:
    """Return the static load of each wheel, N; nothing where it is not given."""
    if load is None:
        return ()
    loads = inputs.per_item("wheel_load", load, wheels)
    if len(loads) != wheels:
        hint = f"give one number, or {wheels}, right and left of each axle"
        raise inputs.faulty("wheel_load", f"has {len(loads)} entries", hint)
    return tuple(inputs.positive_array("wheel_load", np.array(loads)).tolist())


def _by_axle(
    weights: Iterable[Iterable[Unbalance]], axles: int
) -> tuple[tuple[Unbalance, ...], ...]:
    """Return the weights of each axle."""
    hint = f"give {axles} lists of crankpin.Unbalance, one for each axle"
    by_axle = inputs.items("weights", weights, hint)
    if len(by_axle) != axles:
        raise inputs.faulty("weights", f"has {len(by_axle)} entries", hint)
    return tuple(listed_items("weights", of_axle, Unbalance) for of_axle in by_axle)
