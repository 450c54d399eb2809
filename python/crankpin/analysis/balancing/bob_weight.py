"""Bob weights: masses that a crankshaft is balanced against, and residuals by balance factor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.frames import Frames, Tabled
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.record import read_only
from crankpin._support.tables import Table
from crankpin.analysis.balance import over_square
from crankpin.analysis.balancing import planes as correction_planes
from crankpin.analysis.balancing.card import (
    Card,
    from_rods,
    remarks,
    remarks_by_factor,
    weighed,
    with_parts,
)
from crankpin.analysis.balancing.fitting import check_factor, warn_of_appearing, with_bob_weights
from crankpin.analysis.request import engine_core
from crankpin.model import checks
from crankpin.model.crankpins import Crankpin, crankpins

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.balancing.planes import Planes
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Unbalance

TABULATED = (0.0, 0.5, 1.0)
"""Factors in the table of residuals."""
SIDES = 'give two texts, such as ("right", "left")'


def bob_weight(
    engine: Engine,
    factor: float = 0.5,
    oil: float = 0.0,
    *,
    parts: Mapping[str, ArrayLike] | None = None,
) -> BobWeight:
    """Return the bob weight of every crankpin for a balance factor, and the residual.

    A crankshaft is balanced with ``rotating + factor · reciprocating`` mass clamped to each pin,
    that of all rods on the pin together. Its counterweights then cancel these masses. Half of the
    reciprocating mass leaves no part of force and moment that turns with a pin's own crank, in any
    engine without pin offset; the part that turns against it does not depend on the factor. The big
    end of a link rod counts as rotating, but for the part k = a·e^{iψ}/l of it that reciprocates
    with the master's piston; what of that acts across the crankpin is ``across``.

    Parameters
    ----------
    engine : Engine
        The engine; ``rotating_mass`` is what turns with the pin and is not part of the crankshaft:
        big ends, bolts, bearing shells. Its counterweights are replaced.
    factor : float, default 0.5
        Share κ of the reciprocating mass, 0 to 10; 0.5 is a balance factor of 50 %.
    oil : float, default 0.0
        Oil in the bearings and the bore of a crankpin, kg of each pin.
    parts : mapping of str to array_like, optional
        Weighed parts of a cylinder, kg: a number for all cylinders, or one for each. ``"piston"``,
        ``"pin"``, ``"locks"``, ``"rings"`` and ``"small end"`` add up to the reciprocating mass,
        ``"big end"`` and ``"bearings"`` to the rotating mass; by default the engine's. An end of a
        rod that is left out beside other parts of its kind is that of the cylinder's rod, if it has
        one; tables name what is neither.

    Returns
    -------
    BobWeight
        The bob weights, the engine balanced with them, and the residual.

    Raises
    ------
    InputError
        If an argument is out of range.

    Warns
    -----
    UserWarning
        If ``oil`` seems to be in grams, or an order that vanishes appears with the bob weights.

    Examples
    --------
    >>> import crankpin as cp
    >>> v8 = cp.Engine.preset("v8-crossplane", rotating_mass=0.5)
    >>> bob = cp.bob_weight(v8, oil=0.004)
    >>> bob.grams
    array([1454., 1454., 1454., 1454.])
    >>> overbalanced = cp.bob_weight(v8, factor=0.52)
    >>> before = v8.replace(rotating_mass=0).balance(rpm=6000)[1].moment.peak
    >>> after = overbalanced.fitted.balance(rpm=6000)[1].moment.peak
    >>> round(float(after / before), 9)  # 2 % too much leaves 4 %
    0.04
    """
    engine_core(engine)
    part, of_oil = inputs.number("factor", factor), inputs.number("oil", oil)
    check_factor("factor", part)
    if not 0.0 <= of_oil <= 1e6:
        raise inputs.rejected("oil", of_oil, "give the oil of a crankpin in kilograms, 0 or more")
    of_parts = weighed(engine, {} if parts is None else parts)
    ends = from_rods(engine, of_parts)
    of_parts |= ends
    engine = with_parts(engine, of_parts)
    checks.oil(of_oil, engine.cylinders[0].reciprocating_mass)
    bob = BobWeight(engine, part, of_oil, of_parts, tuple(ends))
    warn_of_appearing(engine, _core.with_bob_weights(engine_core(engine), part))
    return bob


class BobWeight(Tabled):
    """Bob weights of an engine's crankpins, from front to flywheel.

    Made by :func:`crankpin.bob_weight`.

    Examples
    --------
    A single shakes along a straight line if nothing or all of its piston is balanced:

    >>> import crankpin as cp
    >>> single = cp.bob_weight(cp.Engine.preset("single"))
    >>> single.straight_line_factors("force")
    ((0.0, 90.0), (1.0, 0.0))
    >>> single.optimal_factor("force")
    0.5
    """

    engine: Engine
    """The engine to be balanced."""
    factor: float
    """Share κ of the reciprocating mass."""
    oil: float
    """Oil of each crankpin, kg."""
    parts: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    """Weighed parts of each cylinder, kg: part to (n_cylinders,); empty where none were given."""
    of_rods: tuple[str, ...] = ()
    """Parts that were not weighed: those of the engine's rods."""

    def __post_init__(self) -> None:
        engine_core(self.engine)
        super().__post_init__()

    @cached_property
    def crankpins(self) -> tuple[Crankpin, ...]:
        """The crankpins.

        Cylinders of one crankshaft share one if they are of different banks, their pins point the
        same way, and their places are less than a crank radius apart; split pins are two.
        """
        return crankpins(self.engine)

    @property
    def rotating(self) -> NDArray[np.float64]:
        """Rotating mass of each crankpin's rods, without oil, kg: (n_crankpins,)."""
        return read_only(self._masses[:, 0])

    @property
    def reciprocating(self) -> NDArray[np.float64]:
        """Reciprocating mass on each crankpin, kg: (n_crankpins,)."""
        return read_only(self._masses[:, 1])

    @property
    def mass(self) -> NDArray[np.float64]:
        """Bob weight of each crankpin, at the crank radius, kg: (n_crankpins,)."""
        return read_only(self._masses[:, 2])

    @property
    def across(self) -> NDArray[np.float64]:
        """What bob weights clamped to the crankpins lack, kg: (n_crankpins,).

        Mass at the crank radius, a quarter of a turn ahead of the crankpin, of big ends of link
        rods on one side of their master rod. ``fitted`` balances it too.
        """
        return read_only(self._masses[:, 3])

    @cached_property
    def _masses(self) -> NDArray[np.float64]:
        return self._masses_at(self.factor)

    def _masses_at(self, factor: float) -> NDArray[np.float64]:
        """Return rotating, reciprocating, bob weight and across: (n_crankpins, 4), kg."""
        return np.array(_core.masses_on_pins(engine_core(self.engine), factor, self.oil))

    @property
    def grams(self) -> NDArray[np.float64]:
        """Bob weight of each crankpin, g: (n_crankpins,)."""
        return read_only((1e3 * self.mass).round(9))

    @cached_property
    def fitted(self) -> Engine:
        """The engine with a crankshaft that is balanced with these weights.

        Its counterweights are opposite the crankpins, in place of those it has. The oil turns with
        the pins and is balanced, so that neither shows.
        """
        return with_bob_weights(self.engine, self.factor)

    @property
    def hardware(self) -> tuple[Unbalance, ...]:
        """The counterweights of the balanced crankshaft."""
        return self.fitted.counterweights

    # --- residual --------------------------------------------------------------------------------

    @cached_property
    def residual(self) -> Balance:
        """Order 1 of the engine with the balanced crankshaft, over ω²: at 1 rad/s, N are kg·m."""
        return over_square(self.fitted, [1])

    @cached_property
    def _first_order(self) -> _core.FirstOrder:
        """Force and moment of order 1 by factor, over ω²."""
        return _core.FirstOrder(engine_core(self.engine))

    def half_axes(self, quantity: str, factor: ArrayLike) -> tuple[Any, Any]:
        """Return the longest and shortest half axis of order 1 by balance factor, over ω².

        On one crankshaft, without pin offset, they are ``|1 − 2κ|·|forward| ± |backward|``, in
        which forward and backward are those of the pistons alone. On a crank that turns against the
        main one bob weights act on the backward part. The shortest is negative where the vector
        turns against the main crank. Of this bob weight they are ``residual[1].force.peak`` and
        ``.minor``.

        Parameters
        ----------
        quantity : str
            ``"force"`` (kg·m) or ``"moment"`` (kg·m²).
        factor : array_like
            Shares κ of the reciprocating mass.

        Returns
        -------
        longest : float or ndarray of float, shape of factor
            Longest half axis, kg·m or kg·m².
        shortest : float or ndarray of float, shape of factor
            Shortest half axis, kg·m or kg·m².

        Raises
        ------
        InputError
            If there is no such quantity, or a factor is not from 0 to 10.
        """
        name = _vector(quantity)
        factors = inputs.array("factor", factor)
        check_factor("factor", factors)
        longest, shortest = (
            read_only(axis.reshape(factors.shape))
            for axis in self._first_order.half_axes(name, factors.ravel().tolist())
        )
        return (longest, shortest) if factors.ndim else (float(longest), float(shortest))

    def optimal_factor(self, quantity: str) -> float | None:
        """Return the factor of the least longest vector: 0.5 on one crankshaft, without pin offset.

        From 0 to 10, as ``factor`` is taken. None if the factor makes no difference: the pistons
        have no part that turns with their crank.

        Parameters
        ----------
        quantity : str
            ``"force"`` or ``"moment"``.

        Returns
        -------
        float or None
            The factor, without unit.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        return self._first_order.least(_vector(quantity))

    def straight_line_factors(self, quantity: str) -> tuple[tuple[float, float], ...]:
        """Return the factors that leave a vector along a straight line, and its direction.

        On one crankshaft, without pin offset, ``½(1 ± |backward|/|forward|)``; none if either part
        is zero, or if every factor does, as of two cranks that mirror each other. Those below 0 or
        above 10 are left out. Directions are degrees from +x in (−90, 90].

        Parameters
        ----------
        quantity : str
            ``"force"`` or ``"moment"``.

        Returns
        -------
        tuple of (float, float)
            Pairs of a factor and a direction, degrees.

        Raises
        ------
        InputError
            If there is no such quantity.
        """
        return tuple(self._first_order.straight(_vector(quantity)))

    # --- tables ---------------------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Table of the bob weights in grams."""
        columns: dict[str, Any] = {
            "rotating": self.rotating,
            "reciprocating": self.reciprocating,
            "oil": np.full(len(self.crankpins), self.oil),
            "bob weight": self.mass,
        }
        if self.across.any():
            columns["across"] = self.across
        pins = np.array([pin.pin_deg for pin in self.crankpins])
        rows = np.stack([pins, *((1e3 * masses).round(9) for masses in columns.values())], axis=1)
        name = labels.name_of(self.engine)
        title = f"{name}: bob weights, rotating + {100.0 * self.factor:.6g} % of reciprocating"
        title += " + oil" if self.oil else ""
        return Table.from_rows(
            title,
            ["cylinders", ("crankpin", "°"), *((name, "g") for name in columns)],
            [(_numbers(pin),) for pin in self.crankpins],
            rows,
            decimals=1,
            note=remarks(self),
        )

    @property
    def frames(self) -> Frames:
        """``table``; ``factors``: residual of order 1 by balance factor, half axes over ω²."""
        return self._frames(factors=self._by_factor)

    def _by_factor(self) -> Table:
        """Return the residual at the usual factors, and at those of a straight line."""
        remarks = remarks_by_factor(TABULATED, self._remarkable())
        factors = sorted(remarks)
        # An engine without force or moment of order 1 has no columns of it.
        quantities = [name for name in PLANE_VECTORS if self._first_order.exists(name)]
        header: list[str | tuple[str, str]] = ["factor", ""]
        columns = []
        for name in quantities or ["moment"]:
            longest, shortest = self.half_axes(name, factors)
            unit = QUANTITIES[name].unit_over_square
            header += [(f"{name}, longest", unit), ("shortest", unit)]
            columns += [longest, abs(shortest)]
        names = [(f"{factor:.6g}", remarks[factor]) for factor in factors]
        title = "Residual of order 1, half axes over ω²"
        return Table.from_rows(title, header, names, np.stack(columns, axis=-1))

    def _remarkable(self) -> Iterator[tuple[float, str]]:
        """Return the factors with a property of their own, and that in words."""
        yield self.factor, ""
        for name in PLANE_VECTORS:
            if (least := self.optimal_factor(name)) is not None:
                yield least, f"least {name}"
            for factor, direction_deg in self.straight_line_factors(name):
                yield factor, f"{name} along {direction_deg:.4g}°"

    # --- card -----------------------------------------------------------------------------------

    def card(
        self,
        factors: ArrayLike | None = None,
        *,
        rpm: float = 3000.0,
        sides: tuple[str, str] = ("right", "left"),
        planes: Planes | None = None,
        radius: ArrayLike | None = None,
        balanced_to: ArrayLike | None = None,
    ) -> Card:
        """Return the card of a balancing shop: parts, bob weights, residuals, correction.

        Parameters
        ----------
        factors : array_like, optional
            Shares κ of the reciprocating mass that are compared; by default ``factor``.
        rpm : float, default 3000.0
            Crank speed of the residuals.
        sides : (str, str), default ("right", "left")
            What is on the right and on the left of the engine, seen from the flywheel, such as
            ``("exhaust", "intake")``, for directions in words.
        planes : {"webs", "ends"}, sequence of float or mapping of str to float, optional
            Where metal can be added or drilled away, as in :func:`crankpin.counterweights`.
        radius : array_like, optional
            Radius of the weights or holes, m: of all planes, or one for each.
        balanced_to : array_like, optional
            Bob weight to which the crankshaft is balanced now, kg: of all crankpins, or one for
            each; by default its counterweights are those of the engine.

        Returns
        -------
        Card
            The card.

        Raises
        ------
        InputError
            If an argument is out of range, or ``radius`` or ``balanced_to`` stands without
            ``planes``.

        Notes
        -----
        Heavy metal takes the place of steel: a slug of 17.0 g/cm³ in a hole of 7.85 g/cm³ weighs
        1.858 times what it adds.

        Examples
        --------
        >>> import crankpin as cp
        >>> single = cp.Engine.preset("single", rotating_mass=0.5)
        >>> single = cp.bob_weight(single, parts={"piston": 0.4, "pin": 0.1})
        >>> single.card([0.5, 0.6], rpm=6000).frames["bob weights"]
        Bob weight of each crankpin
        cylinders  crankpin °  rotating g  reciprocating g  oil g  at 50 % g  at 60 % g
        1                  90       500.0            500.0      0      750.0      800.0
        Not weighed, and not counted: locks, rings, small end.
        """
        shares = inputs.vector("factors", self.factor if factors is None else factors)
        check_factor("factors", shares)
        speed = self.engine.balance(rpm, orders=[1]).rpm  # which checks it
        named = [inputs.text("sides", side) for side in inputs.items("sides", sides, SIDES)]
        if len(named) != 2:
            raise inputs.rejected("sides", sides, SIDES)
        if planes is None:
            inputs.only_with("planes", radius=radius, balanced_to=balanced_to)
        places = {} if planes is None else correction_planes.named(self.engine, planes)
        radii = [None] * len(places)
        if radius is not None:
            radii = _positive("radius", radius, len(places), "give metres, above 0")
        weights = None
        if balanced_to is not None:
            hint = "give kilograms, above 0"
            weights = tuple(_positive("balanced_to", balanced_to, len(self.crankpins), hint))
        return Card(
            self,
            tuple(dict.fromkeys(shares.tolist())),
            speed,
            (named[0], named[1]),
            tuple(
                (name, place.z, at_radius, place.crank)
                for (name, place), at_radius in zip(places.items(), radii, strict=True)
            ),
            weights,
        )


def _vector(quantity: object) -> str:
    """Return the name of a vector, or raise an InputError."""
    return inputs.one_of("quantity", quantity, ["force", "moment"])


def _positive(name: str, values: ArrayLike, count: int, hint: str) -> list[Any]:
    """Return one number above zero for each item; a scalar is that of all."""
    numbers = inputs.per_item(name, values, count)
    if len(numbers) != count:
        raise inputs.faulty(name, f"has {len(numbers)} figures", f"give one, or {count}")
    if not all(0.0 < radius <= 1e6 for radius in numbers):
        raise inputs.rejected(name, values, hint)
    return numbers


def _numbers(pin: Crankpin) -> str:
    return ", ".join(map(str, pin.cylinders))
