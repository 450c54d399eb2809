"""Link rods: rods that hang on the master rod of another cylinder, beside the crankpin."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.record import Input
from crankpin.model import checks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles, Orders

Masters: TypeAlias = "int | str | Sequence[int]"
"""Number of the cylinder of a master rod, several, or the name of their bank."""

EQUAL = ("stroke", "compression")
"""What knuckles are solved for."""

RODS = "give crankpin.LinkRods, or a crankpin.LinkRod or None for each cylinder"


class LinkRod(Input):
    """Where the rod of one cylinder hangs on the master rod of another.

    Its length is the rod length of its cylinder.

    Parameters
    ----------
    master : int
        Number of the cylinder of the master rod, on the same crankpin and at the same z.
    radius : float
        Distance of the knuckle pin from the crankpin, m.
    angle_deg : number or str
        Angle of the knuckle from the master's shank, degrees, counter-clockwise as directions of
        bores. With that between the two bores odd orders above the first vanish.
    big_end_mass : float, default 0.0
        Mass of the link rod at the knuckle, kg; the rest of it moves with the piston.

    Raises
    ------
    InputError
        If a figure is not finite or below zero.

    Examples
    --------
    >>> import crankpin as cp
    >>> twin = cp.Engine.preset("v-twin-45").with_link_rods(
    ...     [None, cp.LinkRod(master=1, radius=0.038, angle_deg=45)]
    ... )
    >>> twin.link_rods[1].angle_deg
    45.0
    """

    master: int
    radius: float
    angle_deg: float = dataclasses.field(compare=False, metadata={"exact": "exact_angle"})
    big_end_mass: float
    exact_angle: str = dataclasses.field(init=False, repr=False)
    """The angle as text that is exact, such as ``"360/7"``, degrees."""

    def __init__(
        self, master: int, radius: float, angle_deg: Angle, big_end_mass: float = 0.0
    ) -> None:
        object.__setattr__(self, "master", inputs.whole("master", master, 1))
        object.__setattr__(self, "radius", _not_negative("radius", radius))
        angle = inputs.angle("angle_deg", angle_deg)
        object.__setattr__(self, "angle_deg", inputs.degrees(angle))
        object.__setattr__(self, "exact_angle", angle)
        object.__setattr__(self, "big_end_mass", _not_negative("big_end_mass", big_end_mass))


class LinkRods(Input):
    """Link rods of all cylinders that share a crankpin with that of a master rod.

    Parameters
    ----------
    radius : float, optional
        Distance of the knuckle pins from the crankpin, m; left out where it is solved for.
    length : float, optional
        Length of the link rods between their centres, m; by default the rod length of their
        cylinders.
    angles_deg : {"bores"} or sequence of number or str, default "bores"
        Angles of the knuckles from the master's shank, degrees, counter-clockwise: one for each
        link rod in the order of the cylinders' numbers; ``"bores"`` are those between the bores.
    big_end_mass : float, optional
        Mass of each link rod at its knuckle, kg; by default the big end of the cylinder's ``rod``.
    equal : {"stroke", "compression"}, optional
        What is equal in all cylinders of a crankpin, with knuckles solved for near their bores:
        ``"stroke"`` by their angles, at the ``radius`` given; ``"compression"``, stroke and height
        above the crank, hence the compression ratio below heads equally far from it, by angles and
        radii, at the ``length`` given.

    Raises
    ------
    InputError
        If a figure is not finite or below zero, is missing, or is solved for and given.

    Examples
    --------
    The order-2 force of a star turns with the crank at twice its speed, N·(r/L)·(a/l) and a little:

    >>> import crankpin as cp
    >>> five = cp.Engine.radial(
    ...     cp.Cylinder(0.06, 0.23, 1.0), 5, rods=cp.LinkRods(radius=0.052, length=0.178)
    ... )
    >>> b = five.balance(rpm=3000, orders=[1, 2])
    >>> round(float(abs(b[2].force.forward) / abs(b[1].force.forward)), 4)
    0.1598
    """

    radius: float | None
    length: float | None
    angles_deg: Literal["bores"] | tuple[str, ...]
    big_end_mass: float | None
    equal: Literal["stroke", "compression"] | None

    def __init__(
        self,
        radius: float | None = None,
        length: float | None = None,
        angles_deg: Literal["bores"] | Angles = "bores",
        big_end_mass: float | None = None,
        equal: Literal["stroke", "compression"] | None = None,
    ) -> None:
        chosen = None if equal is None else inputs.one_of("equal", equal, EQUAL)
        object.__setattr__(self, "equal", chosen)
        is_solved = chosen == "compression"
        if radius is None and not is_solved:
            hint = (
                'give the distance of the knuckles from the crankpin, m, or `equal="compression"`'
            )
            raise inputs.rejected("radius", radius, Hint.of(hint))
        solved = Hint.of("is solved for with `equal`; leave it out")
        if radius is not None and is_solved:
            raise inputs.rejected("radius", radius, solved)
        knuckle = None if radius is None else _not_negative("radius", radius)
        object.__setattr__(self, "radius", knuckle)
        rod = None if length is None else inputs.positive("length", length)
        object.__setattr__(self, "length", rod)
        is_named = isinstance(angles_deg, str)
        angles: Any = (
            inputs.one_of("angles_deg", angles_deg, ("bores",))
            if is_named
            else tuple(inputs.angles("angles_deg", angles_deg))
        )
        if chosen is not None and angles != "bores":
            raise inputs.rejected("angles_deg", angles_deg, solved)
        object.__setattr__(self, "angles_deg", angles)
        mass = None if big_end_mass is None else _not_negative("big_end_mass", big_end_mass)
        object.__setattr__(self, "big_end_mass", mass)


def link_rod_harmonics(
    rod_ratio: ArrayLike,
    orders: Orders,
    *,
    master_ratio: ArrayLike,
    knuckle_ratio: ArrayLike,
    bore_deg: ArrayLike,
    knuckle_deg: ArrayLike | None = None,
) -> NDArray[np.complex128]:
    """Return the harmonics aₙ of the inertia force of link rods' pistons, of many at once.

    The force along the bore is ``m r ω² Re Σ aₙ exp(in(θ − tdc))``, to 1e-12 of the largest. Odd
    orders above the first are in proportion to the sine of the angle between knuckle and bore, with
    all digits down to none.

    Parameters
    ----------
    rod_ratio : array_like
        Crank radius / length of the link rod; any shape, with which the others broadcast.
    orders : int or sequence of int
        Whole multiples of crank speed.
    master_ratio : array_like
        Crank radius / length of the master rod, which has no pin offset.
    knuckle_ratio : array_like
        Distance of the knuckle from the crankpin / crank radius.
    bore_deg : array_like
        Angle of the bore ahead of the master's, degrees.
    knuckle_deg : array_like, optional
        Angle of the knuckle from the master's shank, degrees; by default ``bore_deg``.

    Returns
    -------
    ndarray of complex, shape (..., n_orders)
        Of the broadcast shape.

    Raises
    ------
    InputError
        If a ratio is out of range, or a link rod is too short for its knuckle.

    Examples
    --------
    >>> import crankpin as cp
    >>> a = cp.link_rod_harmonics(
    ...     60 / 178, [1, 2, 3], master_ratio=60 / 230, knuckle_ratio=52 / 60, bore_deg=[72, 144]
    ... )
    >>> a.shape, bool((a[:, 0] == 1).all()), bool((a[:, 2] == 0).all())
    ((2, 3), True, True)
    """
    given = {
        "rod_ratio": rod_ratio,
        "master_ratio": master_ratio,
        "knuckle_ratio": knuckle_ratio,
        "bore_deg": bore_deg,
        "knuckle_deg": bore_deg if knuckle_deg is None else knuckle_deg,
    }
    chosen = inputs.explicit_orders(orders)
    arrays = {name: inputs.array(name, values) for name, values in given.items()}
    try:
        shape = np.broadcast_shapes(*(values.shape for values in arrays.values()))
    except (ValueError, RuntimeError) as error:
        hint = f"give shapes that broadcast ({inputs.reason(error)})"
        shapes = ", ".join(f"{name} {values.shape}" for name, values in arrays.items())
        raise inputs.faulty("rod_ratio", f"has another shape than others: {shapes}", hint) from None
    rods, masters, knuckles, bores, angles = (
        inputs.contiguous(inputs.array(name, np.broadcast_to(values, shape))).reshape(-1)
        for name, values in arrays.items()
    )
    table = _core.link_rod_table(rods, masters, knuckles, bores, angles, chosen)
    return table.reshape(*shape, len(chosen))


def _not_negative(name: str, value: float) -> float:
    number = inputs.finite(name, value)
    if number < 0.0:
        raise inputs.rejected(name, value, "give a number that is zero or more")
    return number


def links(core: _core.Engine) -> tuple[LinkRod | None, ...]:
    """Return the link rod of each cylinder of an engine, None of a rod on its crankpin."""
    return tuple(
        None if link is None else LinkRod(link[0] + 1, link[1], link[2], link[3])
        for link in core.link_rods
    )


def with_links(core: _core.Engine, rods: object) -> _core.Engine:
    """Return an engine of the core with the link rod of each cylinder, or None of it."""
    entries = inputs.items("rods", rods, RODS)
    if len(entries) != len(core.z):
        raise inputs.faulty("rods", f"has {len(entries)} entries", f"give {len(core.z)}")
    for k, one in enumerate(entries):
        if not (one is None or isinstance(one, LinkRod)):
            raise inputs.rejected(f"rods[{k}]", one, RODS)
    if not any(entries) and not any(core.link_rods):
        return core
    return core.with_link_rods(
        [
            None if one is None else (one.master - 1, one.radius, one.exact_angle, one.big_end_mass)
            for one in entries
        ]
    )


def with_masters(
    core: _core.Engine, banks: dict[str, tuple[int, ...]], rods: LinkRods, master: Masters | None
) -> _core.Engine:
    """Return an engine of the core with master rods in some cylinders, and links beside them."""
    numbers: list[int] | None = None
    if isinstance(master, str):
        numbers = [*banks[inputs.one_of("master", master, banks)]]
    elif master is not None:
        hint = "give the number of a cylinder, several, or the name of a bank"
        given = inputs.items("master", master if isinstance(master, Iterable) else [master], hint)
        numbers = [inputs.whole("master", one, 1, len(core.z)) for one in given]
        if not numbers:
            raise inputs.rejected("master", master, hint)
    checks.place(core, "radius", rods.radius, middle=0.0)
    checks.place(core, "length", rods.length, middle=0.0)
    checks.masses(core, big_end_mass=rods.big_end_mass or 0.0)
    return core.with_master_rods(
        rods.radius,
        rods.length,
        None if rods.angles_deg == "bores" else list(rods.angles_deg),
        rods.big_end_mass,
        rods.equal,
        None if numbers is None else [number - 1 for number in numbers],
    )
