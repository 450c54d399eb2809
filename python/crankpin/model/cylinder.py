"""One cylinder: its moving parts, their motion and their harmonics."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, overload

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint, suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import Input
from crankpin.model import checks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders


LARGEST_LENGTH = 1e30
"""Largest length that the core takes, m."""

_Parts: TypeAlias = tuple[float, float, float, float, float]
_Details: TypeAlias = tuple[
    float | None, float | None, tuple[float, float, float] | None, bool, bool
]


@dataclasses.dataclass(frozen=True, slots=True)
class Cylinder:
    """The moving parts of one cylinder.

    The rod counts as two masses: one that moves with the piston and one that turns with the
    crankpin. For forces and moments that is exact, for any rod. The turning mass belongs to the
    throw: engines take it as ``rotating_mass``, by default that of the ``rod``. For torques the
    rod's moment of inertia counts too: ``rod_inertia_excess`` is what it has beyond its two masses.
    :meth:`from_rod` takes a whole rod.

    Parameters
    ----------
    crank_radius : float
        Crank radius r, half the stroke, m.
    rod_length : float
        Rod length l between its centres, m. It is above r + ``|pin_offset|``. ``math.inf`` is that
        of a Scotch yoke, whose piston moves by r cos θ: it has neither pin offset nor rod inertia.
    reciprocating_mass : float
        Mass that moves with the piston, kg: piston, pin, rings, clips and the rod's small end.
    pin_offset : float, default 0.0
        Offset e (désaxé) of the piston pin's path from the crank's axis, m; positive on the side to
        which the crankpin swings after top dead centre.
    rod_inertia_excess : float, default 0.0
        J = I - m·a·b, kg·m²: the moment of inertia of the rod about its centre of mass less that
        of its two masses there, a and b their distances from it. Mostly negative, as a rod's mass
        is not all at its ends. Torques depend on it, forces and moments do not.
    bore : float, optional
        Diameter of the bore, m, if it is known. Inertia forces do not depend on it.
    piston_mass : float, optional
        Mass of piston, pin and rings, kg, of which :meth:`from_rod` made the reciprocating
        mass; None where it is not known.
    rod : Rod, optional
        The rod of which :meth:`from_rod` made it; None where it is not known.
    dummy : bool, default False
        True for a dummy piston, a mass that balances others: it has no gas pressure, and no place
        in firing orders.
    side_rods : bool, default False
        True for a piston that side rods drive from beyond its chamber, as the upper one of two in a
        bore on one crankshaft: pressure in its cylinder pulls it away from the crank.

    Raises
    ------
    InputError
        If a figure is not finite or has the wrong sign, or the crank cannot turn.

    Warns
    -----
    UserWarning
        If a length seems to be in millimetres, or bore and stroke in different units.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=1.487)
    >>> round(cylinder.rod_ratio, 4)
    0.2848
    >>> cylinder.replace(rod_length=0.18).rod_ratio
    0.25
    """

    crank_radius: float
    rod_length: float
    reciprocating_mass: float
    pin_offset: float = 0.0
    rod_inertia_excess: float = 0.0
    bore: float | None = None
    piston_mass: float | None = None
    rod: Rod | None = None
    dummy: bool = False
    side_rods: bool = False

    __array_ufunc__: ClassVar[None] = None
    """None, so that NumPy leaves comparison and arithmetic with arrays to the cylinder."""

    @classmethod
    @documented(__doc__)
    def from_bore_stroke(
        cls,
        *,
        bore: float,
        stroke: float,
        rod_length: float,
        reciprocating_mass: float,
        pin_offset: float = 0.0,
        rod_inertia_excess: float = 0.0,
    ) -> Cylinder:
        """Return a cylinder given by its bore and stroke.

        Parameters
        ----------
        bore : float
            Diameter of the cylinder, m.
        stroke : float
            Twice the crank radius, m.

        Returns
        -------
        Cylinder
            The cylinder.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder.from_bore_stroke(
        ...     bore=0.086, stroke=0.086, rod_length=0.145, reciprocating_mass=0.66
        ... )
        >>> cylinder.crank_radius, cylinder.bore
        (0.043, 0.086)
        """
        figures = (
            inputs.number("bore", bore),
            inputs.number("stroke", stroke),
            inputs.number("rod_length", rod_length),
            inputs.number("reciprocating_mass", reciprocating_mass),
            inputs.number("pin_offset", pin_offset),
        )
        radius = _core.crank_radius_of_stroke(figures)
        return cls(
            radius, rod_length, reciprocating_mass, pin_offset, rod_inertia_excess, figures[0]
        )

    @classmethod
    @documented(__doc__)
    def from_rod(
        cls,
        rod: Rod,
        crank_radius: float,
        piston_mass: float,
        pin_offset: float = 0.0,
        *,
        bore: float | None = None,
    ) -> Cylinder:
        """Return a cylinder with a rod of known mass and inertia.

        An engine of such cylinders has ``rod.rotating_mass`` as ``rotating_mass``, unless it is
        given one: what else turns with the pin then counts, too.

        Parameters
        ----------
        rod : Rod
            The connecting rod.
        crank_radius : float
            Crank radius r, m.
        piston_mass : float
            Mass of piston, pin and rings, without any of the rod, kg.

        Returns
        -------
        Cylinder
            The cylinder, with the rod's share of the reciprocating mass.

        Examples
        --------
        >>> import crankpin as cp
        >>> rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
        >>> cylinder = cp.Cylinder.from_rod(rod, crank_radius=0.045, piston_mass=0.4)
        >>> round(cylinder.reciprocating_mass, 9), round(cylinder.rod_inertia_excess, 9)
        (0.6, -0.0005)
        """
        if not isinstance(rod, Rod):
            raise inputs.rejected("rod", rod, "give a Rod")
        mass = _checked_piston_mass(piston_mass)
        return cls(
            crank_radius=crank_radius,
            rod_length=rod.length,
            reciprocating_mass=mass + rod.reciprocating_mass,
            pin_offset=pin_offset,
            rod_inertia_excess=rod.inertia_excess,
            bore=bore,
            piston_mass=mass,
            rod=rod,
        )

    def __post_init__(self) -> None:
        inputs.flag("dummy", self.dummy)
        inputs.flag("side_rods", self.side_rods)
        for field in dataclasses.fields(self)[:-3]:
            value = getattr(self, field.name)
            if value is not None or field.default is not None:
                object.__setattr__(self, field.name, inputs.number(field.name, value))
        _core.check_cylinder(self._parts)
        if self.bore is not None and not 0.0 < self.bore <= LARGEST_LENGTH:
            raise inputs.rejected("bore", self.bore, "give metres above zero")
        checks.cylinder(self.crank_radius, self.rod_length, self.bore)
        if self.piston_mass is not None:
            _checked_piston_mass(self.piston_mass)
        if self.rod is not None:
            self._check_rod(self.rod)

    def _check_rod(self, rod: Rod) -> None:
        """Reject a rod, with its piston, that does not make the length, mass and inertia given."""
        if not isinstance(rod, Rod):
            raise inputs.rejected("rod", rod, "give a crankpin.Rod")
        if self.piston_mass is None:
            raise inputs.rejected("piston_mass", None, "give it with the rod, or leave out the rod")
        of_rod = {
            "rod_length": rod.length,
            "reciprocating_mass": self.piston_mass + rod.reciprocating_mass,
            "rod_inertia_excess": rod.inertia_excess,
        }
        for name, figure in of_rod.items():
            if (value := getattr(self, name)) != figure:
                why = f"`rod` and `piston_mass` make it {figure!r}"
                hint = "change them together, as Cylinder.from_rod does, or leave out the rod"
                raise inputs.rejected(name, value, Hint.of(f"{why}; {hint}"))

    @classmethod
    def _of(cls, parts: _Parts, details: _Details) -> Cylinder:
        """Return the cylinder of what the core has, without warnings: it was made before."""
        bore, piston_mass, figures, *flags = details
        rod = None
        if figures is not None:
            mass, inertia, to_crankpin = figures
            rod = Rod(mass, inertia, parts[1], to_crankpin)
        with suppressed():
            return cls(*parts, bore, piston_mass, rod, *flags)

    @property
    def _details(self) -> _Details:
        """Data that the core stores without computing with them."""
        rod = self.rod
        figures = None if rod is None else (rod.mass, rod.inertia, rod.to_crankpin)
        return self.bore, self.piston_mass, figures, self.dummy, self.side_rods

    @property
    def _parts(self) -> _Parts:
        return (
            self.crank_radius,
            self.rod_length,
            self.reciprocating_mass,
            self.pin_offset,
            self.rod_inertia_excess,
        )

    @property
    def rod_ratio(self) -> float:
        """λ = r/l, crank radius over rod length; zero of an infinite rod."""
        return self.crank_radius / self.rod_length

    @property
    def stroke(self) -> float:
        """Twice the crank radius, m (a pin offset lengthens the piston's travel a little)."""
        return 2.0 * self.crank_radius

    @property
    def travel(self) -> float:
        """Distance between the ends of the piston's travel, m: the stroke without pin offset."""
        return _core.piston_travel(self._parts)

    def replace(self, **changes: Any) -> Cylinder:  # noqa: ANN401 - numbers, or a Rod
        """Return a copy with some parts changed.

        Rod length, reciprocating mass and rod inertia follow from a piston and a rod that are
        changed; changed themselves, they take the place of both.

        Parameters
        ----------
        **changes : dict, optional
            New values of the parameters of :class:`Cylinder`, by name.

        Returns
        -------
        Cylinder
            The changed copy.

        Raises
        ------
        InputError
            If there is no such part, or a figure is out of range.
        """
        if {"rod_length", "reciprocating_mass", "rod_inertia_excess"} & changes.keys():
            changes = {"piston_mass": None, "rod": None} | changes
        elif {"piston_mass", "rod"} & changes.keys() and changes.get("rod", self.rod) is not None:
            fields = {name: getattr(self, name) for name in ("crank_radius", "pin_offset", "bore")}
            whole = {"rod": self.rod, "piston_mass": self.piston_mass} | fields | changes
            if whole["piston_mass"] is None:
                hint = Hint.of("give `piston_mass` too: it is not known what the rod's part was")
                raise inputs.rejected("rod", whole["rod"], hint)
            flags = {name: getattr(self, name) for name in ("dummy", "side_rods")}
            cylinder = Cylinder.from_rod(**{k: v for k, v in whole.items() if k not in flags})
            return dataclasses.replace(
                cylinder, **{name: whole.get(name, flag) for name, flag in flags.items()}
            )
        try:
            return dataclasses.replace(self, **changes)
        except TypeError as error:
            raise inputs.rejected("changes", list(changes), inputs.reason(error)) from None

    def position(self, theta_deg: ArrayLike) -> NDArray[np.float64]:
        """Return the piston pin's distance from the crank's axis along the bore, m.

        Exact: ``r cos θ + √(l² − (r sin θ − e)²)``. Of an infinite rod it is that from the middle
        of the stroke, ``r cos θ``.

        Parameters
        ----------
        theta_deg : array_like
            Crank angles from the crankpin's pointing along the bore, degrees; any shape.

        Returns
        -------
        ndarray of float, shape of theta_deg
            Distances, m.

        Raises
        ------
        InputError
            If an angle is no finite number.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Cylinder(0.05, 0.15, 0.5).position([0, 180])
        array([0.2, 0.1])
        """
        return self._motion(theta_deg, 0)

    def velocity(self, theta_deg: ArrayLike, rpm: float) -> NDArray[np.float64]:
        """Return the piston's velocity along the bore, away from the crank, m/s.

        Parameters
        ----------
        theta_deg : array_like
            Crank angles from the crankpin's pointing along the bore, degrees; any shape.
        rpm : float
            Crank speed.

        Returns
        -------
        ndarray of float, shape of theta_deg
            Velocities, m/s.

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> float(cp.Cylinder(0.05, 0.15, 0.5).velocity(90, rpm=6000).round(3))
        -31.416
        """
        return self._motion(theta_deg, 1) * inputs.angular_speed(rpm) + 0.0  # makes −0 0

    def acceleration(self, theta_deg: ArrayLike, rpm: float) -> NDArray[np.float64]:
        """Return the piston's acceleration along the bore, away from the crank, m/s².

        The inertia force on the engine, along the bore, is minus the reciprocating mass times it.

        Parameters
        ----------
        theta_deg : array_like
            Crank angles from the crankpin's pointing along the bore, degrees; any shape.
        rpm : float
            Crank speed.

        Returns
        -------
        ndarray of float, shape of theta_deg
            Accelerations, m/s².

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> float(cp.Cylinder(0.05, 0.15, 0.5).acceleration(0, rpm=6000).round(1))
        -26318.9
        """
        return self._motion(theta_deg, 2) * inputs.angular_speed(rpm) ** 2 + 0.0

    def harmonics(self, orders: Orders) -> NDArray[np.complex128]:
        """Return the harmonics aₙ of the inertia force, exact, complex, (n_orders,).

        The force on the engine along the bore is ``m r ω² Re Σ aₙ exp(in(θ − tdc))``.

        Parameters
        ----------
        orders : int or sequence of int
            Whole multiples of crank speed.

        Returns
        -------
        ndarray of complex, shape (n_orders,)
            aₙ, without unit.

        Raises
        ------
        InputError
            If an order is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Cylinder(1, 2, 7).harmonics([1, 2, 4]).real.round(9)
        array([ 1.        ,  0.53555286, -0.03842615])
        """
        return _core.cylinder_harmonics(self._parts, inputs.explicit_orders(orders))

    def torque_harmonics(self, orders: Orders) -> tuple[NDArray[np.complex128], ...]:
        """Return the harmonics of roll torque and crank torque over m·r²·ω², each (n_orders,).

        Roll torque is that of the inertia force on the block about +z, crank torque that on the
        crank. With neither pin offset nor rod inertia one is minus the other. Their sum is what
        all inertia forces do about the crank's axis: an offset adds the moment of the force along
        the bore, a rod the couple that swings it.

        Parameters
        ----------
        orders : int or sequence of int
            Whole multiples of crank speed.

        Returns
        -------
        roll : ndarray of complex, shape (n_orders,)
            Harmonics of roll torque, without unit.
        crank : ndarray of complex, shape (n_orders,)
            Harmonics of crank torque, without unit.

        Raises
        ------
        InputError
            If there is rod inertia and no reciprocating mass to compare it with.

        Examples
        --------
        >>> import crankpin as cp
        >>> roll, crank = cp.Cylinder(0.05, 0.15, 0.5).torque_harmonics([1, 2])
        >>> float(abs(roll + crank).max())
        0.0
        """
        return _core.cylinder_torque_harmonics(self._parts, inputs.explicit_orders(orders))

    @property
    def _ends(self) -> NDArray[np.float64]:
        """Piston pin's distance from the crank's axis where it is highest and lowest, m."""
        return self.position(_core.turning_points(self._parts))

    def _motion(self, theta_deg: ArrayLike, column: int) -> NDArray[np.float64]:
        theta = inputs.array("theta_deg", theta_deg)
        return _core.motion(self._parts, theta.ravel())[:, column].reshape(theta.shape)


class Rod(Input):
    """A rigid connecting rod, and the two masses and the inertia that replace it.

    It moves as a mass at either end and, for torques, an inertia that swings with it and has no
    mass. Both ends' masses together have the rod's mass and centre of mass, and exert its forces
    and moments exactly; ``inertia_excess`` makes up for their moment of inertia.

    Parameters
    ----------
    mass : float
        Mass m, kg.
    inertia : float
        Moment of inertia I about the centre of mass, about an axis parallel to the crank, kg·m².
    length : float
        Length l between the centres of its eyes, m.
    to_crankpin : float
        Distance a from the crankpin's eye to the centre of mass, m; 0 to l, or below 0, to −l, for
        a rod with a counterweight, whose centre lies beyond the crankpin.

    Raises
    ------
    InputError
        If a figure is not finite or has the wrong sign, or the centre of mass is further than l
        from the crankpin's eye.

    Examples
    --------
    >>> import crankpin as cp
    >>> rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.15, to_crankpin=0.05)
    >>> [round(mass, 9) for mass in (rod.reciprocating_mass, rod.rotating_mass)]
    [0.2, 0.4]
    """

    mass: float
    inertia: float
    length: float
    to_crankpin: float

    @classmethod
    @documented(__doc__)
    def estimated(cls, mass: float, length: float, to_crankpin: float) -> Rod:
        """Return a rod with an estimated moment of inertia, I = m·a·b/1.0965.

        Two masses at the ends have the moment of inertia m·a·b, b = l - a. For 19 measured rods of
        spark-ignition engines that is 9.65 % more than theirs on average, from 2.65 % less to 22 %
        more (ASME ICEF2002, vol. 46628, p. 305).

        Returns
        -------
        Rod
            The rod.

        Examples
        --------
        >>> import crankpin as cp
        >>> rod = cp.Rod.estimated(mass=0.6, length=0.15, to_crankpin=0.05)
        >>> round(rod.inertia, 6)
        0.002736
        """
        figures = {"mass": mass, "length": length, "to_crankpin": to_crankpin}
        numbers = {name: inputs.number(name, value) for name, value in figures.items()}
        return cls(inertia=_core.estimated_rod_inertia(*numbers.values()), **numbers)

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = inputs.number(field.name, getattr(self, field.name))
            object.__setattr__(self, field.name, value)
        _ = self._masses

    @property
    def _masses(self) -> _core._RodParts:
        return _core.rod_parts(self.mass, self.inertia, self.length, self.to_crankpin)

    @property
    def reciprocating_mass(self) -> float:
        """Mass that moves with the piston, m·a/l, kg."""
        return self._masses["reciprocating_mass"]

    @property
    def rotating_mass(self) -> float:
        """Mass that turns with the crankpin, m·(l - a)/l, kg."""
        return self._masses["rotating_mass"]

    @property
    def inertia_excess(self) -> float:
        """Inertia beyond that of the two masses, I - m·a·(l - a), kg·m²; mostly negative.

        Zero where the two are equal within rounding.
        """
        return self._masses["inertia_excess"]


def rod_length(crank_radius: float, rod_ratio: float) -> float:
    """Return the rod length at a rod ratio, m, which is infinite at 0."""
    return crank_radius / rod_ratio if rod_ratio else math.inf


def _checked_piston_mass(value: object) -> float:
    mass = inputs.finite("piston_mass", value)
    if mass < 0.0:
        raise inputs.rejected("piston_mass", mass, "give a number that is zero or more")
    return mass


@overload
def slider_crank_harmonics(
    rod_ratio: ArrayLike,
    orders: Orders,
    pin_offset_ratio: None = None,
    *,
    rtol: float | None = None,
) -> NDArray[np.float64]: ...
@overload
def slider_crank_harmonics(
    rod_ratio: ArrayLike, orders: Orders, pin_offset_ratio: ArrayLike, *, rtol: float | None = None
) -> NDArray[np.complex128]: ...
def slider_crank_harmonics(
    rod_ratio: ArrayLike,
    orders: Orders,
    pin_offset_ratio: ArrayLike | None = None,
    *,
    rtol: float | None = None,
) -> NDArray[Any]:
    """Return the harmonics aₙ of a slider-crank's inertia force, exact for any 0 ≤ λ < 1.

    The force along the bore is ``m r ω² Re Σ aₙ exp(in(θ − tdc))``; a₁ = 1 and a₂ ≈ λ. Every order
    has full relative accuracy: the coefficients come from the factors of
    √(l² − (r sin θ − e)²), not from samples nor from a series in λ.

    Parameters
    ----------
    rod_ratio : array_like
        λ = crank radius / rod length, 0 of an infinite rod; any shape.
    orders : int or sequence of int
        Whole multiples of crank speed.
    pin_offset_ratio : array_like, optional
        Pin offset / crank radius, ``|e/r| < 1/λ − 1``; broadcast with ``rod_ratio``. Without it the
        pin runs through the crank's axis, odd orders above 1 vanish, and the result is real.
    rtol : float, optional
        Relative tolerance of every order, 1e-15 to below 1; by default full double precision. A
        tolerance saves little: at 1e-3 a tenth of the time for many rod ratios about 0.3, a third
        for 0.6 to 0.99, nothing for a single one. With ``pin_offset_ratio`` it has no effect.

    Returns
    -------
    ndarray of float or complex, shape (..., n_orders)
        Of the broadcast shape; real without ``pin_offset_ratio``, complex with it.

    Raises
    ------
    InputError
        If a rod ratio is below 0, or 1 or more, an offset keeps the crank from turning, or ``rtol``
        is out of range.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.slider_crank_harmonics(0.5, [1, 2, 3, 4]).round(9)
    array([ 1.        ,  0.53555286,  0.        , -0.03842615])
    >>> cp.slider_crank_harmonics([0.25, 0.3], orders=2).shape
    (2, 1)
    >>> cp.slider_crank_harmonics(0.5, [2], rtol=1e-2).round(4)
    array([0.5359])
    """
    chosen = inputs.explicit_orders(orders)
    ratios = inputs.array("rod_ratio", rod_ratio)
    within = None if rtol is None else inputs.number("rtol", rtol)
    if pin_offset_ratio is None:
        table = _core.centred_table(inputs.contiguous(ratios).reshape(-1), chosen, within)
        return table.reshape(*ratios.shape, len(chosen))
    offsets = inputs.array("pin_offset_ratio", pin_offset_ratio)
    try:
        shape = np.broadcast_shapes(ratios.shape, offsets.shape)
    except (ValueError, RuntimeError) as error:
        hint = f"give shapes that broadcast ({inputs.reason(error)})"
        fault = f"has shape {offsets.shape}, rod_ratio has {ratios.shape}"
        raise inputs.faulty("pin_offset_ratio", fault, hint) from None
    # Nothing is copied until its size is known to be small enough.
    ratios = inputs.array("rod_ratio", np.broadcast_to(ratios, shape))
    offsets = inputs.array("pin_offset_ratio", np.broadcast_to(offsets, shape))
    ratios, offsets = (inputs.contiguous(a).reshape(-1) for a in (ratios, offsets))
    return _core.offset_table(ratios, offsets, chosen, within).reshape(*shape, len(chosen))
