"""Loads inside an engine: bearings and walls over crank angle, shear and bending along z."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels
from crankpin._support.messages import warn
from crankpin._support.quantities import INSIDE, LOADS
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table
from crankpin.analysis.balance import mean_piston_speed
from crankpin.analysis.geometry import direction
from crankpin.analysis.labelled import Labelled
from crankpin.analysis.request import engine_core
from crankpin.model.crankpins import crankpins

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.frames import Frames
    from crankpin._support.quantities import Kind
    from crankpin.analysis.quantity import Quantity
    from crankpin.model.engine import Engine
    from crankpin.model.shafts import Shaft

REFERENCE_AXES = ("engine", "crank", "rod")
"""Axes in which vectors are given: fixed in the engine, or turning with crank or rod."""
LARGEST_BEARING = 10.0
"""Width or diameter of a bearing, in crank radii, above which it is not in metres: pins have 1."""
CUT_PARTS = ("crank", "crankcase")
"""Parts that are cut along z."""


def bearing_loads(engine: Engine, rpm: float, theta_deg: ArrayLike | None = None) -> BearingLoads:
    """Compute the loads of crankpins, wrist pins, cylinder walls and main bearings.

    Every cylinder is taken apart into piston, rod and crank; the rod's moment of inertia counts
    where the cylinder has one, and gas pressure where the engine has it
    (:meth:`Engine.with_cycle`); ``engine.with_cycle(None)`` is without. The crank is taken as
    statically determinate between neighbouring main bearings: each load on it is shared by the
    bearing in front of it and the one behind by the lever rule, and one outside the end bearings is
    carried by the two nearest, one of which is pulled. A real crankshaft is continuous, and bends
    over its bearings. The places of the bearings are :attr:`Engine.mains`: those given, or else one
    between all throws. Further cranks have bearings between their throws as well; each turns evenly
    by a flywheel of its own, and the gears between cranks load no bearing.

    Parameters
    ----------
    engine : Engine
        The engine. Its ``rotating_mass`` and counterweights load the main bearings. A rod's own
        rotating mass loads its crankpin too, where the cylinder has a ``rod``
        (:meth:`Cylinder.from_rod`); else the crankpin's load is that of the reciprocating mass.
        The wrist pin carries the ``piston_mass``, where it is not known the whole reciprocating
        mass.
    rpm : float
        Crank speed, rpm.
    theta_deg : array_like, shape (n_theta,), optional
        Crank angles, degrees; by default 0° to 720° in steps of one degree. Peaks are
        those at these angles, by default those of the whole cycle, at any angle. Means are over
        these angles.

    Returns
    -------
    BearingLoads
        Loads over crank angle, N.

    Raises
    ------
    InputError
        If a figure cannot be used.

    Warns
    -----
    UserWarning
        If pistons are faster than in any engine, or angles seem to be in radians.

    Examples
    --------
    >>> import crankpin as cp
    >>> loads = cp.bearing_loads(cp.Engine.preset("i4"), rpm=6000)
    >>> loads.main.shape, loads.side_thrust.shape
    ((5, 721, 2), (4, 721))

    The middle main bearing of an inline four carries two throws that point the same way:

    >>> (loads.main.peak / 1e3).round(1)
    array([5. , 2.4, 9.9, 2.4, 5. ])
    """
    loads = BearingLoads(engine, rpm, inputs.crank_angles(theta_deg), theta_deg is None)
    inputs.warn_of_units(mean_piston_speed(engine, loads.rpm))
    return loads


class InsideLoads:
    """Mixin of what has loads inside an engine: over crank angle, or the largest of a point.

    Shapes are those over crank angle; of an operating map they are (n_rpm, n_load, n).
    """

    if TYPE_CHECKING:

        def _quantity(self, name: str) -> Quantity[Any, Any, Any]: ...

    @property
    def crankpin(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of each rod on its crankpin along x and y, N: (n_cylinders, n_theta, 2).

        Rods that share a crankpin have a bearing each.
        """
        return self._quantity("crankpin")

    @property
    def wrist_pin(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of each rod on its wrist pin along x and y, N: (n_cylinders, n_theta, 2)."""
        return self._quantity("wrist_pin")

    @property
    def main(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of the crank on each main bearing along x and y, N: (n_mains, n_theta, 2).

        Where they are is in ``main_z`` and ``main_crank``.
        """
        return self._quantity("main")

    @property
    def side_thrust(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of each piston on its cylinder wall, N: (n_cylinders, n_theta).

        Positive towards the side from which the crankpin swings after top dead centre, to which
        gas pressure pushes the piston as it expands: F·tan φ, with the rod's moment of inertia.
        """
        return self._quantity("side_thrust")

    @property
    def rod_force(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force along each rod at its wrist pin, compression positive, N.

        Of shape (n_cylinders, n_theta).
        """
        return self._quantity("rod_force")

    @property
    def gas_force(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Gas force on each piston towards the crank, N: (n_cylinders, n_theta).

        The same force acts on the cylinder head away from the crank.
        """
        return self._quantity("gas_force")


class BearingLoads(InsideLoads, Labelled):
    """Loads inside an engine at given crank angles.

    Vectors are along x and y, fixed in the engine; :meth:`turned` gives them in the axes of the
    crank or the rod. Made by :func:`crankpin.bearing_loads`.

    Main bearings, walls and heads push the engine block as a whole as the shaking force of
    :meth:`Engine.waveform` does (with that of the balance shafts, in :meth:`shaft_bearings`).

    Examples
    --------
    >>> import crankpin as cp
    >>> loads = cp.bearing_loads(cp.Engine.preset("v8-crossplane"), rpm=6000)
    >>> loads.shares[1].round(2)  # of the throws of cylinders 1 to 8, on the second main bearing
    array([0.5, 0.5, 0.5, 0.5, 0. , 0. , 0. , 0. ])
    """

    engine: Engine
    """The engine."""
    rpm: float
    """Crank speed, rpm."""
    theta_deg: NDArray[np.float64]
    """Crank angles, degrees: (n_theta,)."""
    at_any_angle: bool = False
    """Whether peaks are those of the whole cycle, at any angle; else those at the crank angles."""

    _along: ClassVar[tuple[str, ...]] = ("theta_deg",)
    _registry: ClassVar[Mapping[str, Kind]] = INSIDE

    def __post_init__(self) -> None:
        engine, rpm = engine_core(self.engine), inputs.number("rpm", self.rpm)
        theta = inputs.copied(inputs.vector("theta_deg", self.theta_deg))
        core = _core.BearingLoadsModel(engine, rpm)
        by_name = core.loads(theta)
        at_any_angle = inputs.flag("at_any_angle", self.at_any_angle)
        self.__dict__.update(rpm=rpm, theta_deg=theta, at_any_angle=at_any_angle)
        self.__dict__.update(_model=core, _by_name=by_name)
        super().__post_init__()

    @property
    def _core(self) -> _core.BearingLoadsModel:
        return self.__dict__["_model"]  # type: ignore[no-any-return]

    @property
    def loads_counted(self) -> str:
        """Gas pressure that counts, in words: as :attr:`Engine.loads_counted`."""
        return self.engine.loads_counted

    @property
    def coords(self) -> Mapping[str, Any]:
        """Dimension → its values: the crank angles."""
        return {"theta_deg": self.theta_deg}

    @property
    def _own_coords(self) -> Mapping[str, Any]:
        """Numbers of cylinders and main bearings, from 1; the cylinders on each crankpin."""
        return {
            "cylinder": np.arange(1, len(self.engine) + 1),
            "main_bearing": np.arange(1, len(self.main_z) + 1),
            "shared_pin": tuple("+".join(map(str, numbers)) for numbers in self.crankpins),
        }

    def _values(self, quantity: str) -> NDArray[np.float64]:
        by_name: dict[str, NDArray[np.float64]] = self.__dict__["_by_name"]
        if quantity == "whole_crankpin":
            rods = by_name["crankpin"]
            return np.array([sum(rods[k - 1] for k in pin) for pin in self.crankpins])
        return by_name[quantity]

    def _compute(self, quantity: str, what: str) -> NDArray[Any]:
        if what == "peak" and self.at_any_angle:
            return np.asarray(np.abs(self._extremes[quantity]).max(axis=1))
        return super()._compute(quantity, what)

    # --- loads ----------------------------------------------------------------------------------

    @property
    def main_z(self) -> NDArray[np.float64]:
        """Places of the main bearings, those of each crank ascending, m: (n_mains,)."""
        return read_only(np.array([z for _, z in self._core.mains()]))

    @property
    def main_crank(self) -> NDArray[np.intp]:
        """Index of the crank of each main bearing, 0 for the main one: (n_mains,)."""
        return read_only(np.array([crank for crank, _ in self._core.mains()], dtype=np.intp))

    @cached_property
    def crankpins(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the cylinders whose rods share each crankpin, from front to flywheel."""
        return tuple(crankpin.cylinders for crankpin in crankpins(self.engine))

    @property
    def whole_crankpin(self) -> Quantity[np.float64, NDArray[np.float64]]:
        """Force of all rods together on each crankpin along x and y, N: (n_crankpins, n_theta, 2).

        What the pin itself carries, in the order of ``crankpins``; each rod's bearing carries its
        own part, ``crankpin``.
        """
        return self._quantity("whole_crankpin")

    def specific(self, load: str, *, width: ArrayLike, diameter: ArrayLike) -> NDArray[np.float64]:
        """Return the largest load of each bearing over its projected area, Pa: (n,).

        Parameters
        ----------
        load : str
            ``"crankpin"``, ``"wrist_pin"`` or ``"main"``.
        width, diameter : float or array_like, shape (n,)
            Width and diameter of the bearings, m; of all, or of each.

        Returns
        -------
        ndarray of float, shape (n,)
            Specific loads, Pa: the largest load over width times diameter.

        Raises
        ------
        InputError
            If the load is of no bearing, or there is not one figure above zero for each.

        Examples
        --------
        >>> import crankpin as cp
        >>> loads = cp.bearing_loads(cp.Engine.preset("i4"), rpm=6000)
        >>> (loads.specific("main", width=0.022, diameter=0.054) / 1e6).round(1)  # MPa
        array([4.2, 2. , 8.3, 2. , 4.2])
        """
        name = inputs.one_of("load", load, _VECTORS)
        peaks = self._quantity(name).peak
        area = np.ones(len(peaks))
        for argument, sizes_of in (("width", width), ("diameter", diameter)):
            sizes = np.array(inputs.per_item(argument, sizes_of, len(peaks)))
            hint = f"give metres above zero, one or one for each of {len(peaks)} bearings"
            if len(sizes) != len(peaks):
                raise inputs.rejected(argument, sizes_of, hint)
            if not (np.isfinite(sizes).all() and (sizes > 0.0).all()):
                raise inputs.rejected(argument, sizes_of, hint)
            inputs.positive_array(argument, sizes, hint)
            if sizes.max() > LARGEST_BEARING * self.engine.cylinders[0].crank_radius:
                warn(argument, f"= {sizes.max():g} m", "was it given in millimetres?")
            area *= sizes
        return np.asarray(peaks / area)

    def shaft_bearings(self, z: Sequence[float] | None = None) -> NDArray[np.float64]:
        """Return the load of the two bearings of each balance shaft, N: (n_shafts, 2).

        Each unbalance is carried by both in inverse proportion to its distances, as that of a
        straight stiff shaft is; one outside them lifts the farther. The loads turn with the shaft
        and have a constant magnitude.

        Parameters
        ----------
        z : pair of float, optional
            Places of the bearings along the crank, of all shafts, m; by default those of the end
            main bearings.

        Returns
        -------
        ndarray of float, shape (n_shafts, 2)
            Magnitudes, N, in the order of :attr:`Engine.shafts`.

        Raises
        ------
        InputError
            If there are not two different places.
        """
        places = self._ends if z is None else inputs.listed_numbers("z", z)
        if len(places) != 2 or not np.isfinite(places).all() or places[0] == places[1]:
            raise inputs.rejected("z", z, "give the places of two bearings, m")
        front, rear = places
        loads = [on_shaft_bearings(shaft, front, rear, self.rpm) for shaft in self.engine.shafts]
        return np.abs(np.array(loads).reshape(-1, 2))

    @property
    def _ends(self) -> list[float]:
        """Places of the end bearings of the main crank, m."""
        z = self.main_z[self.main_crank == 0]
        return [float(z.min()), float(z.max())]

    def turned(self, load: str = "crankpin", axes: str = "crank") -> NDArray[np.float64]:
        """Return the loads of bearings in axes that turn, N: (n, n_theta, 2).

        Parameters
        ----------
        load : str, default "crankpin"
            ``"crankpin"``, ``"wrist_pin"`` or ``"main"``.
        axes : {"crank", "rod", "engine"}, default "crank"
            ``"crank"``: along the throw outwards, and a quarter turn ahead in the direction of
            rotation of its crank; of main bearings the throw is that of the first cylinder on their
            crank. This shows where a pin or a journal is loaded. ``"rod"``: along the rod to the
            wrist pin, and a quarter turn ahead, for the bearings in the rod. ``"engine"``: x and y,
            as the arrays are.

        Returns
        -------
        ndarray of float, shape (n, n_theta, 2)
            Loads, N.

        Raises
        ------
        InputError
            If a name is unknown, or ``"rod"`` is given for main bearings.

        Examples
        --------
        >>> import crankpin as cp
        >>> loads = cp.bearing_loads(cp.Engine.preset("i4"), rpm=6000, theta_deg=[0, 180])
        >>> loads.turned("crankpin")[0].round(-1)
        array([[9900.,    0.],
               [5370.,    0.]])
        """
        name = inputs.one_of("load", load, _VECTORS)
        chosen = inputs.one_of("axes", axes, REFERENCE_AXES)
        if chosen == "engine":
            return self.read(name)
        if (name, chosen) == ("main", "rod"):
            raise inputs.rejected(
                "axes", "rod", 'main bearings have none; give "crank" or "engine"'
            )
        return self._core.turned(name, chosen, self.theta_deg)

    def _range(self, load: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the least and largest value of a load that is no vector."""
        if self.at_any_angle:
            low, high = self._extremes[load].T
            return low, high
        values = self.read(load)
        if not len(self.theta_deg):
            return np.zeros(len(values)), np.zeros(len(values))
        return values.min(axis=-1), values.max(axis=-1)

    @cached_property
    def _extremes(self) -> dict[str, NDArray[np.float64]]:
        return self._core.extremes(180 * self.engine.strokes)

    @cached_property
    def shares(self) -> NDArray[np.float64]:
        """Share of each cylinder's crankpin load that a main bearing carries.

        Of shape (n_mains, n_cylinders).
        """
        return read_only(self._core.shares())

    @cached_property
    def tension_deg(self) -> tuple[tuple[tuple[float, float], ...], ...]:
        """Ranges of crank angles in which a rod is in tension at its wrist pin, by cylinder.

        Degrees from and to, over a cycle of the engine; a range that 0° cuts begins below it. A
        wrist pin without any, or with one that is the whole cycle, never changes sides in its
        bearing, whose oil film is then not renewed.
        """
        return tuple(map(tuple, self._core.tension(180 * self.engine.strokes)))

    # --- along z --------------------------------------------------------------------------------

    @cached_property
    def z(self) -> NDArray[np.float64]:
        """Places of throws, counterweights, balance shafts' unbalances and main bearings, m.

        Ascending, of shape (n_places,).
        """
        return read_only(np.array(self._core.places()))

    def shear(self, part: str = "crankcase", *, crank: int = 0) -> NDArray[np.float64]:
        """Return the sum of the loads on a part up to each place of ``z`` and at it, N.

        Along x and y, of shape (n_places, n_theta, 2).

        Parameters
        ----------
        part : {"crank", "crankcase"}, default "crankcase"
            ``"crank"``: loaded by rods and unbalances, supported by the main bearings.
            ``"crankcase"``: loaded by main bearings, walls, heads and balance shafts. What holds it
            (mounts, its own inertia) is not computed: past the last load its shear is the shaking
            force.
        crank : int, default 0
            Index of the crank that is cut; 0 is the main one.

        Returns
        -------
        ndarray of float, shape (n_places, n_theta, 2)
            Shear along x and y, N.

        Raises
        ------
        InputError
            If there is no such part or crank.
        """
        return self._sections(part, crank)[0]

    def bending(self, part: str = "crankcase", *, crank: int = 0) -> NDArray[np.float64]:
        """Return the moment about each place of ``z`` of the loads on a part in front of it, N·m.

        About x and y, of shape (n_places, n_theta, 2). That of the crank is zero at main bearings,
        where the model has hinges, unless a load overhangs the end one; there the crankcase has
        the internal couple of the engine, Σ (z − zₖ)·Fₖ over the loads in front.

        Parameters
        ----------
        part : {"crank", "crankcase"}, default "crankcase"
            ``"crank"`` or ``"crankcase"``, as of :meth:`shear`.
        crank : int, default 0
            Index of the crank that is cut, as of :meth:`shear`.

        Returns
        -------
        ndarray of float, shape (n_places, n_theta, 2)
            Moments about x and y, N·m.

        Raises
        ------
        InputError
            If there is no such part or crank.

        Examples
        --------
        The rocking moment of an inline four vanishes in order 1. Its front half bends its middle by
        m·r·ω² times the spacing:

        >>> import crankpin as cp
        >>> i4 = cp.Engine.inline(
        ...     cp.Cylinder(0.05, 1e6, 0.5), throws_deg=[0, 180, 180, 0], spacing=0.1
        ... )
        >>> loads = cp.bearing_loads(i4, rpm=6000, theta_deg=[0])
        >>> middle = list(loads.z).index(i4.reference_z)
        >>> couple = float(abs(loads.bending()[middle, 0]).max())
        >>> round(couple / (0.5 * 0.05 * (2 * 3.141592653589793 * 100) ** 2 * 0.1), 6)
        1.0
        """
        return self._sections(part, crank)[1]

    def _sections(self, part: str, crank: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        index, count = inputs.whole("crank", crank, 0), len(engine_core(self.engine).cranks[0])
        if index >= count:
            raise inputs.rejected("crank", crank, f"give the index of a crank, 0 to {count - 1}")
        cut = (inputs.one_of("part", part, CUT_PARTS), index)
        cache = self.__dict__.setdefault("_cut", {})
        if cut not in cache:
            cache[cut] = self._core.sections(*cut, self.theta_deg)
        return cache[cut]  # type: ignore[no-any-return]

    # --- tables and pictures ---------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Largest and mean loads of each cylinder."""
        where = f"{labels.name_of(self.engine)} at {self.rpm:g} rpm"
        over = "of a cycle" if self.at_any_angle else f"at {len(self.theta_deg)} crank angles"
        least, most = self._range("rod_force")
        in_tension = [sum(to - begin for begin, to in arcs) for arcs in self.tension_deg]
        columns = {
            "crankpin": self.crankpin.peak,
            "mean": self.crankpin.mean_magnitude,
            "wrist pin": self.wrist_pin.peak,
            "side thrust": self.side_thrust.peak,
            "rod compressed": np.maximum(most, 0.0),
            "pulled": np.maximum(-least, 0.0),
        }
        return Table(
            f"{where}, largest loads {over}",
            (
                _counted("cylinder", len(most)),
                *(Column(name, values, "N") for name, values in columns.items()),
                Column("pulled for", tuple(in_tension), "°"),
            ),
            loads=self.loads_counted,
        )

    @property
    def frames(self) -> Frames:
        """``table``; ``mains``: loads of each main bearing; ``crankpins`` and ``shafts``.

        The third is there where pins are shared, the fourth where there are balance shafts.
        """
        others = {"crankpins": self._of_crankpins} if self._shares_pins else {}
        if self.engine.shafts:
            others["shafts"] = self._of_shafts
        return self._frames(mains=self._of_mains, **others)

    @property
    def _shares_pins(self) -> bool:
        return any(len(numbers) > 1 for numbers in self.crankpins)

    def _of_crankpins(self) -> Table:
        shared = self._own_coords["shared_pin"]
        return Table(
            "Crankpins as a whole, with the rods of all cylinders on them",
            (Column("cylinders", shared), Column("largest", self.whole_crankpin.peak, "N")),
            loads=self.loads_counted,
        )

    def _of_shafts(self) -> Table:
        front, rear = self.shaft_bearings().T.tolist()
        shafts = self.engine.shafts
        return Table(
            "Bearings of balance shafts beside the end main bearings, whose loads turn with them",
            (
                Column("shaft", tuple(shaft.name or k for k, shaft in enumerate(shafts, start=1))),
                Column("speed ratio", tuple(shaft.ratio for shaft in shafts)),
                Column("front", tuple(front), "N"),
                Column("rear", tuple(rear), "N"),
            ),
            loads=self.loads_counted,
        )

    def _of_mains(self) -> Table:
        loads = {"largest": self.main.peak, "mean": self.main.mean_magnitude}
        cranks = Column("crank", self.main_crank)
        return Table(
            "Main bearings, which share the loads between them by the lever rule",
            (
                _counted("main", len(self.main)),
                *([cranks] if self.main_crank.any() else ()),
                Column("z", self.main_z, "m"),
                *(Column(name, values, "N") for name, values in loads.items()),
            ),
            loads=self.loads_counted,
        )


def on_shaft_bearings(
    shaft: Shaft, front: float, rear: float, rpm: float
) -> NDArray[np.complex128]:
    """Return what a balance shaft puts on its two bearings at θ = 0, x + iy, N."""
    forces = [
        (unbalance.amount * complex(direction(inputs.degrees(unbalance.angle_deg))), unbalance.z)
        for unbalance in shaft.unbalances
    ]
    loads = np.array(_core.shared(forces, front, rear), dtype=np.complex128)
    return loads * (shaft.ratio * inputs.angular_speed(rpm)) ** 2


def _counted(name: str, count: int) -> Column:
    return Column(name, tuple(range(1, count + 1)))


_VECTORS = tuple(name for name, kind in LOADS.items() if kind.planar)
"""Names of the loads that are vectors."""
