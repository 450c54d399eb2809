"""Builders of engines from lists, throws, firing orders and names of presets."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, Self, TypeAlias, TypeVar

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.messages import Hint
from crankpin._support.parameters import documented
from crankpin.model import checks
from crankpin.model import shafts as rotating
from crankpin.model.data import Cranks, EngineData, allowed, big_end, core_of_lists, parts
from crankpin.model.furnishing import furnished, one_of
from crankpin.model.links import LinkRods

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.furnishing import Cylinders
    from crankpin.model.links import Masters
    from crankpin.model.shafts import Shaft, Unbalance

FANS = {"W": (30, 90, 150), "X": (45, 135, 225, 315), "Y": (90, 210, 330), "H": (0, 180)}
"""Usual names of engines with several banks on one crank → directions of the bores."""

Numbering: TypeAlias = Literal["alternating", "by-bank"]
Side: TypeAlias = Literal["right", "left"]
FiringRule: TypeAlias = Literal["even", "ijesc"]
OfCranks = TypeVar("OfCranks", bound="Builders")


class Builders(EngineData):
    """Constructors of engines."""

    @classmethod
    @documented()
    def from_lists(
        cls,
        cylinder: Cylinder | Sequence[Cylinder],
        *,
        bank_deg: Angles,
        z: ArrayLike,
        tdc_deg: Angles | None = None,
        pin_deg: Angles | None = None,
        rotating_mass: ArrayLike | None = None,
        counterweights: Iterable[Unbalance] = (),
        shafts: Iterable[Shaft] = (),
        mains: ArrayLike | None = None,
        reference_z: float | None = None,
        cranks: Iterable[tuple[float, float, float]] = (),
        crank: Iterable[int] | None = None,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return the engine that these lists describe, one entry for each cylinder.

        For any layout, such as W and VR engines, and engines with several cranks.

        Parameters
        ----------
        cylinder : Cylinder or sequence of Cylinder
            Moving parts of all cylinders, or one for each.
        cranks : sequence of (float, float, int), optional
            Further crankshafts: x and y of the axis, m, and speed over that of the main one, below
            zero against it; by default none.
        crank : sequence of int, shape (n_cylinders,), optional
            Crankshaft of each cylinder: 0 is the main one, 1 the first of ``cranks``; by default
            all are on the main one.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If lists differ in length, both or neither of ``tdc_deg`` and ``pin_deg`` are given, a
            figure is out of range, or the crank does not allow the firing order.

        Warns
        -----
        UserWarning
            If a figure seems to be in another unit (millimetres, grams, radians), or an angle
            is next to a part of a turn without being it.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(1.0, 2.0, 7.0)
        >>> i3 = cp.Engine.from_lists(
        ...     cylinder, tdc_deg=[0, 120, 240], bank_deg=[90, 90, 90], z=[-0.1, 0, 0.1]
        ... )
        >>> abs(i3.balance(rpm=10, orders=[1]).moment).round(3)
        array([[1.33, 0.  ]])

        A square four, two cranks that turn against each other:

        >>> four = cp.Engine.from_lists(
        ...     cylinder,
        ...     tdc_deg=[0, 180, 180, 0],
        ...     bank_deg=[90] * 4,
        ...     z=[0, 0.1, 0, 0.1],
        ...     cranks=[(0.1, 0, -1)],
        ...     crank=[0, 0, 1, 1],
        ... )
        >>> four.vanishing_orders().force.remaining
        (2, 4, 6, 8, 10, 12)
        """
        core = core_of_lists(
            cylinder, tdc_deg, pin_deg, bank_deg, z, rotating_mass,
            mains=mains, reference_z=reference_z, cranks=_cranks(cranks, crank, bank_deg),
        )  # fmt: skip
        core = rotating.with_counterweights(core, counterweights)
        core = rotating.with_shafts(core, shafts)
        return cls(core, name, source, firing_order, strokes)

    @classmethod
    @documented(from_lists)
    def inline(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return an upright engine of one bank.

        Parameters
        ----------
        cylinder : Cylinder, sequence of Cylinder or mapping of str to Cylinder
            Moving parts of every cylinder, of each by number, or of each bank by its name: a
            piston that is heavier, a bank with a pin offset of its own.
        spacing : float or array_like
            Distance between neighbouring cylinders, m, or of each from the one before it.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If a figure is out of range, or the crank does not allow the firing order.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.6)
        >>> i4 = cp.Engine.inline(cylinder, throws_deg=[0, 180, 180, 0], spacing=0.09)
        >>> abs(i4.balance(rpm=6000, orders=[1, 2]).force).round(0)
        array([[    0.,     0.],
               [    0., 12359.]])
        """
        one = one_of(cylinder)
        layout = _along_crank(one, throws_deg, spacing, rotating_mass, first_tdc_deg)
        core = _kept(_core.Engine.inline(parts(one), layout), one)
        checks.angles(throws_deg=throws_deg, first_tdc_deg=first_tdc_deg)
        engine = cls(core, name, source, "", strokes)
        return furnished(engine, cylinder, rotating_mass, firing_order)

    @classmethod
    @documented(inline)
    def vee(
        cls,
        cylinder: Cylinders,
        *,
        bank_angle_deg: Angle,
        throws_deg: Angles,
        spacing: ArrayLike,
        pin_split_deg: Angle = 0.0,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        absent: Iterable[int] = (),
        rotating_mass: ArrayLike | None = None,
        rods: LinkRods | None = None,
        master: Masters | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return an upright vee: two cylinders to a throw, one in each bank.

        Parameters
        ----------
        bank_angle_deg : number or str
            Angle between the banks, degrees, 0 to 180.
        spacing : float or array_like
            Distance between neighbouring throws, m, or of each from the one before it.
        pin_split_deg : number or str, default 0.0
            Left pin minus right pin, in the direction of rotation, degrees; even firing needs bank
            angle − firing interval. That is −60 for a 60° V6, −30 for a 90° V6; shared pins have 0.
        absent : sequence of int, optional
            Cylinders that are not there, by their numbers in the whole vee: of three throws 6
            leaves a V5. Those that are there are numbered anew from 1; ``[2, 3, 6]`` leaves a V3
            with a cylinder on each throw, by turns right and left.
        rods : LinkRods, optional
            Link rods on the master rods of one bank; by default each rod is on its crankpin, side
            by side or as fork and blade.
        master : int, sequence of int or str, optional
            Bank with the master rods, ``"right"`` or ``"left"``, or numbers of their cylinders; by
            default the first of each throw.

        Returns
        -------
        Engine
            The engine.

        Warns
        -----
        UserWarning
            If the opposite pin split would fire evenly, or ….

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.045, 0.15, 0.5)
        >>> v8 = cp.Engine.vee(
        ...     cylinder, bank_angle_deg=90, throws_deg=[0, 90, 270, 180], spacing=0.1
        ... )
        >>> abs(v8.balance(rpm=6000, orders=[1]).moment.backward)  # all of it turns with the crank
        array([0.])
        """
        one = one_of(cylinder)
        layout = _along_crank(one, throws_deg, spacing, rotating_mass, first_tdc_deg)
        layout |= vee_layout(bank_angle_deg, pin_split_deg, bank_stagger, numbering, odd_bank)
        hint = "give numbers of cylinders, such as [6]"
        missing = [
            inputs.whole("absent", number, 1) for number in inputs.items("absent", absent, hint)
        ]
        core = _kept(_core.Engine.vee(parts(one), layout | {"absent": missing}), one)
        checks.angles(
            bank_angle_deg=bank_angle_deg, throws_deg=throws_deg, pin_split_deg=pin_split_deg,
            first_tdc_deg=first_tdc_deg,
        )  # fmt: skip
        checks.pin_split(core, layout["pin_split"])
        engine = cls(core, name, source, "", strokes)
        engine = furnished(engine, cylinder, rotating_mass, firing_order)
        return _linked(engine, rods, master)

    @classmethod
    @documented(vee)
    def flat(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return a flat engine whose opposed cylinders share a crankpin: a 180° vee.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> flat4 = cp.Engine.flat(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> flat4.tdc_deg
        array([  0., 180., 180.,   0.])
        """
        return cls.vee(
            cylinder, bank_angle_deg=180, throws_deg=throws_deg, spacing=spacing,
            bank_stagger=bank_stagger, numbering=numbering, odd_bank=odd_bank,
            rotating_mass=rotating_mass, first_tdc_deg=first_tdc_deg, firing_order=firing_order,
            strokes=strokes, name=name, source=source,
        )  # fmt: skip

    @classmethod
    @documented(vee)
    def boxer(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return a boxer: opposed pistons move in mirror image, on pins half a turn apart.

        Parameters
        ----------
        bank_stagger : float, default 0.0
            Distance that a crank web puts between opposed cylinders, m.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> boxer = cp.Engine.boxer(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> boxer.tdc_deg
        array([  0.,   0., 180., 180.])
        """
        return cls.vee(
            cylinder, bank_angle_deg=180, pin_split_deg=180, throws_deg=throws_deg, spacing=spacing,
            bank_stagger=bank_stagger, numbering=numbering, odd_bank=odd_bank,
            rotating_mass=rotating_mass, first_tdc_deg=first_tdc_deg, firing_order=firing_order,
            strokes=strokes, name=name, source=source,
        )  # fmt: skip

    @classmethod
    @documented(inline)
    def radial(
        cls,
        cylinder: Cylinders,
        cylinders: int = 7,
        *,
        rows: int = 1,
        spacing: ArrayLike | None = None,
        rotating_mass: ArrayLike | None = None,
        rods: LinkRods | None = None,
        master: Masters | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] | None = None,
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return a radial: the cylinders of a row stand evenly around one crankpin.

        Cylinder 1 is upright; numbers ascend in the direction of rotation, in two rows from row to
        row. Pins of several rows share the turn, half a turn apart of two, a quarter of four, and
        cylinders of each row stand between those of the others. Without ``rods`` all rods count as
        if each had its own bearing on the crankpin; link rods, whose pistons move a little
        differently, leave a force of order 2 that turns with the crank.

        Parameters
        ----------
        cylinders : int, default 7
            Number of cylinders of all rows, three or more in each.
        rows : int, default 1
            Number of rows, up to 6.
        spacing : float or array_like, optional
            Distance between neighbouring rows, m, or of each from the one before it; of one row it
            may be left out.
        rods : LinkRods, optional
            Link rods on a master rod in each row; by default there are none.
        master : int or sequence of int, optional
            Numbers of the cylinders that have the master rods, one in each row; by default the
            first of each.
        firing_order : str or sequence of int, optional
            …; by default every second cylinder of a row, and the rows by
            turns, if that is even: in a four-stroke for odd numbers of cylinders in a row.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If a row has fewer than three cylinders, two rows have no spacing, or ….

        Examples
        --------
        >>> import crankpin as cp
        >>> nine = cp.Engine.radial(cp.Cylinder(0.0659, 0.26, 2.5), 9)
        >>> nine.firing()
        <Firing 4-stroke 1-3-5-7-9-2-4-6-8, even, 80°>
        >>> nine.vanishing_orders().force.remaining  # order 1 turns with the crank
        (1, 8, 10)
        """
        count, banks = inputs.whole("cylinders", cylinders), inputs.whole("rows", rows)
        one = one_of(cylinder)
        layout = _along_crank(
            one, (), 0.0 if spacing is None else spacing, rotating_mass, first_tdc_deg
        )
        layout |= {"cylinders": count, "rows": banks}
        layout["spacing"] = None if spacing is None else layout["spacing"]
        core = _kept(_core.Engine.radial(parts(one), layout), one)
        checks.angles(first_tdc_deg=first_tdc_deg)
        order = firing_order
        if order is None:
            order = _core.Engine.radial_firing_order(layout, inputs.strokes(strokes))
        engine = cls(core, name, source, "", strokes)
        return _linked(furnished(engine, cylinder, rotating_mass, order), rods, master)

    @classmethod
    @documented(vee)
    def from_banks(
        cls,
        cylinder: Cylinders,
        bank_deg: Angles | Literal["W", "X", "Y", "H"],
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        bank_stagger: float = 0.0,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return an engine with a cylinder of every bank on every throw, such as a W or an X.

        Cylinders are numbered bank by bank, each from the front to the flywheel.

        Parameters
        ----------
        cylinder : Cylinder, sequence of Cylinder or mapping of str to Cylinder
            …; banks are ``"bank 1"``, ``"bank 2"``, ….
        bank_deg : sequence of number or str, or {"W", "X", "Y", "H"}
            Directions of the banks from +x, degrees; ``"W"`` is 30, 90, 150, ``"X"`` is 45, 135,
            225, 315, ``"Y"`` is 90, 210, 330, and ``"H"`` is 0, 180.
        bank_stagger : float, default 0.0
            How far each bank stands behind the one before it, m.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> x8 = cp.Engine.from_banks(
        ...     cp.Cylinder(0.04, 0.14, 0.4), "X", throws_deg=[0, 180], spacing=0.1
        ... )
        >>> x8.vanishing_orders().force.remaining
        ()
        >>> x8.banks["bank 4"]
        (7, 8)
        """
        if isinstance(bank_deg, str):
            bank_deg = FANS[inputs.one_of("bank_deg", bank_deg.upper(), FANS)]
        one = one_of(cylinder)
        layout = _along_crank(one, throws_deg, spacing, rotating_mass, first_tdc_deg)
        layout["banks"] = inputs.angles("bank_deg", bank_deg)
        layout["bank_stagger"] = inputs.number("bank_stagger", bank_stagger)
        core = _kept(_core.Engine.fan(parts(one), layout), one)
        checks.angles(bank_deg=bank_deg, throws_deg=throws_deg, first_tdc_deg=first_tdc_deg)
        engine = cls(core, name, source, "", strokes)
        return furnished(engine, cylinder, rotating_mass, firing_order)

    @classmethod
    @documented(vee)
    def from_firing_order(
        cls,
        cylinder: Cylinders,
        firing_order: str | Iterable[int],
        *,
        spacing: ArrayLike,
        bank_angle_deg: Angle | None = None,
        shared_pins: bool | None = None,
        rule: FiringRule = "even",
        intervals_deg: Angles | None = None,
        strokes: int = 4,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        bank_stagger: float = 0.0,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return an engine that fires in this order, and remembers it.

        Parameters
        ----------
        firing_order : str or sequence of int
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list; ``+`` joins cylinders that fire
            together, ``"1+4-2+3"``. Where ``rule="ijesc"`` gives a crank that cannot fire in this
            order, the engine's firing order is left empty.
        bank_angle_deg : number or str, optional
            Angle between the banks of a vee, degrees; None for an inline engine.
        shared_pins : bool, optional
            True for a vee whose opposed cylinders share crankpins: the bank of cylinder 1 fires as
            evenly as with split pins, and the other bank a bank angle later or earlier. False for
            even firing, with pins split where the bank angle requires it; the default is that too,
            with a warning that names the split and the intervals of shared pins.
        rule : {"even", "ijesc"}, default "even"
            ``"even"``: all firing intervals are equal; top dead centres follow from the order, pins
            are split where the bank angle asks for it. ``"ijesc"``: the rule of the IJESC paper of
            2017, by which the cylinders of each bank, in the order in which they fire, lag by equal
            parts of a turn (0°, 120°, 240° in a V6) from the same crank angle in both banks.
        intervals_deg : sequence of number or str, optional
            Firing intervals, degrees, in place of equal ones: crank angles from each cylinder of
            the order to the next, and from the last to the first. They need ``rule="even"``, and
            are 0 between those joined by ``+``. The
            engine keeps the turns in which its cylinders fire, as in twins that fire 30° apart.
        strokes : {4, 2}, default 4
            4 or 2: intervals add up to 720 or 360.
        numbering : {"alternating", "by-bank"}, default "alternating"
            …; the IJESC paper has odd cylinders right, the cross-plane page left.
        odd_bank : {"right", "left"}, default "right"
            …; the IJESC paper has odd cylinders right, the cross-plane page left.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If the order is no order of all cylinders, intervals do not add up to a cycle, or ….

        Warns
        -----
        UserWarning
            If pins are split without ``shared_pins=False``, or cylinder 1 in the other bank would
            need smaller splits.

        Examples
        --------
        The cross-plane crank follows from its firing order:

        >>> import crankpin as cp
        >>> v8 = cp.Engine.from_firing_order(
        ...     cp.Cylinder(0.045, 0.15, 0.5),
        ...     "1-8-4-3-6-5-7-2",
        ...     bank_angle_deg=90,
        ...     odd_bank="left",
        ...     spacing=0.1,
        ... )
        >>> (v8.pin_deg - v8.pin_deg[0])[::2] % 360
        array([  0.,  90., 270., 180.])

        See :func:`crankpin.throws` for the crank alone.
        """
        banks = banks_of_order(firing_order, bank_angle_deg, numbering, odd_bank)
        order = inputs.firing_order("firing_order", firing_order, banks)
        fired = (
            inputs.text("rule", rule, 'give "even" or "ijesc"'),
            None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg),
            inputs.strokes(strokes),
        )
        if shared_pins is not None and inputs.flag("shared_pins", shared_pins):
            even = rule == "even" and intervals_deg is None
            if bank_angle_deg is None or not even:
                hint = Hint.of("it is of vees, and needs `bank_angle_deg`")
                hint = (
                    hint
                    if even
                    else Hint.of(
                        "they have intervals of their own; leave out `rule` and `intervals_deg`"
                    )
                )
                raise inputs.rejected("shared_pins", shared_pins, hint)
        one = one_of(cylinder)
        along = _along_crank(one, (), spacing, rotating_mass, first_tdc_deg)
        across = vee_layout_of(bank_angle_deg, bank_stagger, numbering, odd_bank)
        moving = parts(one)
        if bank_angle_deg is None:
            core = _core.Engine.inline_from_firing_order(moving, order, *fired, along)
        else:
            core = _core.Engine.vee_from_firing_order(moving, order, *fired, along | across)
            if rule == "even":
                other = across | {"odd_bank": checks.other_bank(odd_bank)}
                exchanged = _core.Engine.vee_from_firing_order(moving, order, *fired, along | other)
                splits = _splits(core)
                shared = _sharing(core, along | across)
                if shared_pins:
                    _core.Firing.named(shared, order, strokes)  # an error if it cannot fire so
                    core = shared
                elif (
                    not checks.odd_bank(odd_bank, splits, _splits(exchanged))
                    and intervals_deg is None
                    and shared_pins is None
                ):
                    checks.split_pins(splits, shared, order, strokes, firing_order)
        core = _kept(core, one)
        checks.angles(
            bank_angle_deg=bank_angle_deg, intervals_deg=intervals_deg, first_tdc_deg=first_tdc_deg
        )
        engine = cls(core, name, source, "", strokes)
        possible = allowed(core, order, strokes)
        engine = furnished(engine, cylinder, rotating_mass, possible)
        if fired[1] is None:
            return engine
        return cls(_core.Firing.at_intervals(engine._core, order, strokes, fired[1]).kept())

    @classmethod
    @documented(from_lists)
    def on_cranks(
        cls,
        engines: Sequence[Self],
        *,
        cranks: Iterable[tuple[float, float, float]],
        phase_deg: Angles | None = None,
        tilt_deg: Angles | None = None,
        z: ArrayLike | None = None,
        hold: Literal["pins", "firing"] = "pins",
        firing_order: str | Iterable[int] = "",
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return one engine of several, each on a crank of its own.

        Cylinders are numbered in the order of the engines. Counterweights and balance shafts are
        those of the engines; cycles, further loads and main bearings are given to the whole.

        Parameters
        ----------
        engines : sequence of Engine
            The first, on the main crank, and further ones.
        cranks : sequence of (float, float, int)
            Crank of each further engine: x and y of its axis from that of the main one, m, and its
            speed over that of the main one, below zero against it.
        phase_deg : sequence of number or str, optional
            Crank angle of the main crank at which the own one of each further engine is 0, degrees;
            by default 0.
        tilt_deg : sequence of number or str, optional
            Angle by which each further engine is turned about its crank, bores and all, degrees in
            the direction of rotation; 180 stands it on its head. By default 0.
        z : array_like, optional
            How far each further engine stands behind its own places, towards the flywheel, m; by
            default 0.
        hold : {"pins", "firing"}, default "pins"
            What is kept where a crank turns against the main one. ``"pins"``: crank and bores, so
            that the engine runs backwards. ``"firing"``: every top dead centre, with the crankpins
            mirrored at their bores.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If lists differ in length, an engine has what belongs to the whole, or a figure is out
            of range.

        Examples
        --------
        Two twins side by side, their cranks geared against each other:

        >>> import crankpin as cp
        >>> twin = cp.Engine.preset("i2-180")
        >>> four = cp.Engine.on_cranks([twin, twin], cranks=[(0.15, 0, -1)], phase_deg=[180])
        >>> four.tdc_deg
        array([  0., 180., 180.,   0.])
        >>> four.vanishing_orders().force.remaining
        (2, 4, 6, 8, 10, 12)
        """
        parts = _engines(engines)
        further, count = _further(cranks), len(parts) - 1
        if len(further) != count:
            raise inputs.faulty("cranks", f"has {len(further)} entries", f"give {count}")
        none = ["0"] * count
        phases = none if phase_deg is None else inputs.angles("phase_deg", phase_deg)
        tilts = none if tilt_deg is None else inputs.angles("tilt_deg", tilt_deg)
        places = [0.0] * count if z is None else inputs.listed_numbers("z", z)
        for argument, length in {
            "phase_deg": len(phases), "tilt_deg": len(tilts), "z": len(places),
        }.items():  # fmt: skip
            if length != count:
                raise inputs.faulty(argument, f"has {length} entries", f"give {count}")
        held = inputs.one_of("hold", hold, ("pins", "firing"))
        cores = [part._core for part in parts]
        core = _core.Engine.on_cranks(cores, further, phases, tilts, places, held)
        return cls(core, name, source, firing_order, parts[0].strokes)

    @classmethod
    @documented(inline)
    def opposed_pistons(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        distance: float | None = None,
        lead_deg: Angle = 0.0,
        upper: Cylinders | None = None,
        ratio: int = 1,
        one_crankshaft: bool = False,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 2,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return an upright engine with two pistons in each bore, on a crank below and one above.

        Lower cylinders are numbered first, then upper ones. The two pistons of a bore share a
        chamber, which fires once, under the lower number (:attr:`chambers`). On one crankshaft, as
        in Doxford's engines, side rods drive the upper pistons from throws opposite the lower ones:
        order 1 cancels if mass times crank radius is equal, and order 2 adds.

        Parameters
        ----------
        spacing : float or array_like
            Distance between neighbouring bores, m, or of each from the one before it.
        distance : float, optional
            Distance of the upper crank above the lower one, m; of two cranks it must be given.
        lead_deg : number or str, default 0.0
            Angle by which the upper crank is ahead of the lower one, degrees; on one crankshaft the
            upper throws are half a turn and this angle ahead.
        upper : Cylinder, sequence of Cylinder or mapping of str to Cylinder, optional
            Moving parts of the upper cylinders; by default those of the lower ones. On one
            crankshaft they must be given: ``rod_length`` is that of the side rods.
        ratio : {1, -1}, default 1
            Speed of the second crank over that of the main one: 1 turns with it, -1 against it.
        one_crankshaft : bool, default False
            Whether side rods drive the upper pistons from the lower crank.
        rotating_mass : float or array_like, optional
            …; of twice as many as throws those of the upper cylinders follow.
        firing_order : str or sequence of int, optional
            …, of chambers.
        strokes : {2, 4}, default 2
            Strokes of a cycle.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.05, 0.2, 1.2)
        >>> twelve = cp.Engine.opposed_pistons(
        ...     cylinder,
        ...     throws_deg=[0, 120, 240, 240, 120, 0],
        ...     spacing=0.15,
        ...     distance=0.9,
        ...     lead_deg=12,
        ...     firing_order="1+6-3+4-2+5",
        ... )
        >>> twelve.vanishing_orders().force.remaining
        (6, 12)
        >>> upper = cp.Cylinder(0.05, 0.35, 1.2)
        >>> one = cp.Engine.opposed_pistons(
        ...     cylinder, upper=upper, throws_deg=[0], spacing=0.15, one_crankshaft=True
        ... )
        >>> balance = one.balance(rpm=1000, orders=[1, 2])
        >>> one.chambers, balance[1].force.status, f"{balance[2].force.peak:.1f} N"
        (((1, 2),), 'zero, proved', '261.6 N')
        """
        layout: dict[str, Any] = {
            "throws_deg": throws_deg, "spacing": spacing, "first_tdc_deg": first_tdc_deg,
            "strokes": strokes,
        }  # fmt: skip
        below = beyond = rotating_mass
        if rotating_mass is not None:
            count = len(inputs.angles("throws_deg", throws_deg))
            masses = inputs.per_item("rotating_mass", rotating_mass, 2 * count)
            if len(masses) == 2 * count:
                below, beyond = masses[:count], masses[count:]
        above = lower = cls.inline(cylinder, rotating_mass=below, **layout)
        if upper is not None or below is not beyond:
            try:
                above = cls.inline(
                    cylinder if upper is None else upper, rotating_mass=beyond, **layout
                )
            except InputError as error:
                raise inputs.renamed(error, "cylinder", "upper") from None
        if inputs.flag("one_crankshaft", one_crankshaft):
            if upper is None or distance is not None or ratio != 1:
                hint = "give upper, the pistons with side rods, and neither distance nor ratio"
                raise inputs.rejected("one_crankshaft", True, hint)
            names: dict[str, Any] = {
                "firing_order": firing_order, "strokes": strokes, "name": name, "source": source,
            }  # fmt: skip
            return _by_side_rods(cls, lower, above, lead_deg, **names)
        if distance is None:
            hint = Hint.of("give the distance of the cranks, m, or `one_crankshaft=True`")
            raise inputs.rejected("distance", None, hint)
        lead = inputs.angle("lead_deg", lead_deg)
        later = lead[1:] if lead.startswith("-") else f"-{lead}"
        checks.angles(lead_deg=lead_deg)
        return _doubled(
            cls, lower, distance, ratio, above=above, is_aside=False, phase_deg=later, tilt_deg=180,
            firing_order=firing_order, name=name, source=source,
        )  # fmt: skip

    @classmethod
    @documented(inline)
    def opposed_throws(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        crosshead_mass: ArrayLike | None = None,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 2,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return a horizontal machine whose throws drive cylinders to the right and left in turn.

        As balanced-opposed compressors: a cylinder for each throw, the first to the right. Two
        neighbours with throws half a turn apart move in mirror image; what is left of their forces
        is that of the difference of their masses, and a couple.

        Parameters
        ----------
        throws_deg : sequence of number or str
            Angle of the throw of each cylinder in the direction of rotation, degrees.
        spacing : float or array_like
            Distance between neighbouring throws, m, or of each from the one before it.
        crosshead_mass : array_like, optional
            Mass of crosshead, pin and nut, kg, of all throws or each, on top of the reciprocating
            mass of the cylinder.
        strokes : {2, 4}, default 2
            Strokes of a cycle.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        The force and the couple of 200 kg against 180 kg at 600 rpm:

        >>> import crankpin as cp
        >>> cylinders = [cp.Cylinder(0.125, 0.625, mass) for mass in (200, 180)]
        >>> pair = cp.Engine.opposed_throws(cylinders, throws_deg=[0, 180], spacing=0.32)
        >>> first = pair.balance(rpm=600)[1]
        >>> f"{first.force.peak:.4f} N, {first.moment.peak:.3f} N·m"
        '9869.6044 N, 30003.597 N·m'
        """
        throws = inputs.angles("throws_deg", throws_deg)
        along = cls.inline(cylinder, throws_deg=throws_deg, spacing=spacing,
                           rotating_mass=rotating_mass, strokes=strokes)  # fmt: skip
        cylinders = along.cylinders
        if crosshead_mass is not None:
            masses = inputs.per_item("crosshead_mass", crosshead_mass, len(throws))
            if len(masses) != len(throws):
                raise inputs.faulty(
                    "crosshead_mass", f"has {len(masses)} entries", f"give one, or {len(throws)}"
                )
            for mass in masses:
                if not mass >= 0.0:
                    raise inputs.rejected("crosshead_mass", mass, "give kg, zero or more")
            pairs = zip(cylinders, masses, strict=True)
            try:
                cylinders = tuple(_with_crosshead(one, mass) for one, mass in pairs)
            except InputError as error:
                raise inputs.renamed(error, "reciprocating_mass", "crosshead_mass") from None
        engine = cls.from_lists(
            cylinders, pin_deg=throws_deg, bank_deg=[180 * (k % 2) for k in range(len(throws))],
            z=along.z, rotating_mass=along.rotating_mass, strokes=strokes,
        )  # fmt: skip
        first = inputs.angle("first_tdc_deg", first_tdc_deg)
        checks.angles(throws_deg=throws_deg, first_tdc_deg=first_tdc_deg)
        return cls(engine._core.with_first_tdc(first), name, source, firing_order, strokes)

    @classmethod
    @documented(opposed_pistons)
    def u(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        distance: float,
        phase_deg: Angle = 0.0,
        ratio: int = -1,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return two upright engines of one bank side by side, their cranks geared together.

        Left cylinders are numbered first, then right ones.

        Parameters
        ----------
        cylinder : Cylinder, sequence of Cylinder or mapping of str to Cylinder
            Moving parts of every cylinder, of each of one engine by number, or of its bank by name.
        spacing : float or array_like
            Distance between neighbouring cylinders, m, or of each from the one before it.
        distance : float
            Distance of the second crank to the right of the main one, m.
        phase_deg : number or str, default 0.0
            Crank angle by which the second engine is later than the first, degrees.
        ratio : {-1, 1}, default -1
            Speed of the second crank over that of the main one: 1 turns with it, -1 against it.
        firing_order : str or sequence of int, optional
            ….
        strokes : {4, 2}, default 4
            Strokes of a cycle.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.6)
        >>> twin = cp.Engine.u(cylinder, throws_deg=[0], spacing=0.1, distance=0.2)
        >>> abs(twin.balance(rpm=3000, orders=[1]).force).round(1)
        array([[   0. , 5092.7]])
        """
        one = cls.inline(
            cylinder, throws_deg=throws_deg, spacing=spacing, rotating_mass=rotating_mass,
            first_tdc_deg=first_tdc_deg, strokes=strokes,
        )  # fmt: skip
        return _doubled(
            cls, one, distance, ratio, is_aside=True, phase_deg=phase_deg,
            firing_order=firing_order, name=name, source=source,
        )  # fmt: skip

    @classmethod
    @documented(u)
    def square_four(
        cls,
        cylinder: Cylinders,
        *,
        spacing: float,
        distance: float,
        ratio: int = -1,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return two upright twins of 180° side by side, of which diagonal pistons move together.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.027, 0.11, 0.3)
        >>> four = cp.Engine.square_four(cylinder, spacing=0.08, distance=0.1)
        >>> four.vanishing_orders().force.remaining
        (2, 4, 6, 8, 10, 12)
        """
        return cls.u(
            cylinder, throws_deg=[0, 180], spacing=spacing, distance=distance, phase_deg=180,
            ratio=ratio, rotating_mass=rotating_mass, first_tdc_deg=first_tdc_deg,
            firing_order=firing_order, strokes=strokes, name=name, source=source,
        )  # fmt: skip

    @classmethod
    @documented(u)
    def h(
        cls,
        cylinder: Cylinders,
        *,
        throws_deg: Angles,
        spacing: ArrayLike,
        distance: float,
        phase_deg: Angle = 0.0,
        ratio: int = -1,
        rotating_mass: ArrayLike | None = None,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Self:
        """Return two flat engines one above the other, their cranks geared together.

        Lower cylinders are numbered first, each engine as :meth:`flat` does.

        Parameters
        ----------
        spacing : float or array_like
            Distance between neighbouring throws, m, or of each from the one before it.
        distance : float
            Distance of the second crank above the main one, m.

        Returns
        -------
        Engine
            The engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.025, 0.1, 0.3)
        >>> h16 = cp.Engine.h(
        ...     cylinder, throws_deg=[0, 180, 180, 0], spacing=0.09, distance=0.2, phase_deg=90
        ... )
        >>> len(h16), h16.vanishing_orders().force.remaining
        (16, ())
        """
        one = cls.flat(
            cylinder, throws_deg=throws_deg, spacing=spacing, rotating_mass=rotating_mass,
            first_tdc_deg=first_tdc_deg, strokes=strokes,
        )  # fmt: skip
        return _doubled(
            cls, one, distance, ratio, is_aside=False, phase_deg=phase_deg,
            firing_order=firing_order, name=name, source=source,
        )  # fmt: skip


def _doubled(
    kind: type[OfCranks],
    one: OfCranks,
    distance: float,
    ratio: int,
    *,
    is_aside: bool,
    above: OfCranks | None = None,
    phase_deg: Angle,
    tilt_deg: float = 0.0,
    **names: Any,  # noqa: ANN401
) -> OfCranks:
    """Return an engine and one like it on a second crank as fast, whose firing is held."""
    apart = inputs.positive("distance", distance)
    if inputs.whole("ratio", ratio, -1) not in (1, -1):
        raise inputs.rejected("ratio", ratio, "give 1, or -1 against the main crank")
    phase = inputs.angle("phase_deg", phase_deg)
    checks.angles(phase_deg=phase_deg)
    return kind.on_cranks(
        [one, one if above is None else above],
        cranks=[(apart, 0.0, ratio) if is_aside else (0.0, apart, ratio)],
        phase_deg=[phase],
        tilt_deg=[tilt_deg],
        hold="firing",
        **names,
    )


def _by_side_rods(
    kind: type[OfCranks],
    lower: OfCranks,
    above: OfCranks,
    lead_deg: Angle,
    **names: Any,  # noqa: ANN401
) -> OfCranks:
    """Return an engine whose upper pistons side rods drive from throws opposite the lower ones."""
    phase = 180 - Fraction(inputs.angle("lead_deg", lead_deg))
    checks.angles(lead_deg=lead_deg)
    # Angles stay exact: those of a second crank that is later by that phase.
    pair = kind.on_cranks([lower, above], cranks=[(0.0, 1.0, 1)], phase_deg=[str(phase)])
    tdc_deg, bank_deg = pair._core.exact_angles
    uppers = [one.replace(side_rods=True) for one in above.cylinders]
    return kind.from_lists(
        [*lower.cylinders, *uppers], tdc_deg=tdc_deg, bank_deg=bank_deg, z=pair.z,
        rotating_mass=pair.rotating_mass, **names,
    )  # fmt: skip


def _with_crosshead(cylinder: Cylinder, mass: float) -> Cylinder:
    """Return a cylinder with a crosshead, outboard of whose pin it counts as the piston does."""
    if cylinder.rod is not None and cylinder.piston_mass is not None:
        return cylinder.replace(piston_mass=cylinder.piston_mass + mass)
    piston = None if cylinder.piston_mass is None else cylinder.piston_mass + mass
    return dataclasses.replace(
        cylinder, reciprocating_mass=cylinder.reciprocating_mass + mass, piston_mass=piston
    )


def _engines(engines: object) -> list[Any]:
    """Return engines; rejects what is none."""
    hint = "give a list of engines"
    listed = inputs.items("engines", engines, hint)
    for engine in listed:
        if not isinstance(engine, Builders):
            raise inputs.rejected("engines", engine, hint)
    if not listed:
        raise inputs.faulty("engines", "is empty", hint)
    return listed


def banks_of_order(
    firing_order: object, bank_angle_deg: Angle | None, numbering: object, odd_bank: object
) -> list[int]:
    """Return the bank of each cylinder of a vee that is named by its firing order."""
    if bank_angle_deg is None or not isinstance(firing_order, str):
        return []
    count, first = len(re.findall(r"\d+", firing_order)), int(odd_bank == "left")
    if numbering == "by-bank":
        return [first if 2 * k < count else 1 - first for k in range(count)]
    return [(first + k) % 2 for k in range(count)]


def _further(cranks: object) -> list[tuple[float, float, float]]:
    """Return crankshafts besides the main one."""
    hint = "give x and y in metres and a ratio, such as [(0.2, 0.0, -1)]"
    further = []
    for k, text in enumerate(inputs.items("cranks", cranks, hint), 1):
        figures = inputs.items("cranks", text, hint)
        if len(figures) != 3:
            raise inputs.rejected("cranks", text, hint)
        x, y = (inputs.finite("cranks", figure) for figure in figures[:2])
        further.append((x, y, inputs.speed_ratio(f"cranks[{k}].ratio", figures[2])))
    return further


def _cranks(cranks: object, crank: object, bank_deg: Angles) -> Cranks | None:
    """Return the crankshafts and that of each cylinder; None for the main one alone."""
    further = _further(cranks)
    if crank is None:
        if further:
            raise inputs.rejected("crank", None, "give the crankshaft of each cylinder, from 0")
        return None
    places = [
        inputs.whole("crank", place, 0)
        for place in inputs.items("crank", crank, "give a whole number for each cylinder")
    ]
    count = len(inputs.items("bank_deg", bank_deg, "give a list of degrees"))
    if len(places) != count:
        raise inputs.faulty("crank", f"has {len(places)} entries", f"give {count}")
    for text in places:
        if text > len(further):
            raise inputs.rejected("crank", text, f"there are cranks 0 to {len(further)}")
    return [(0.0, 0.0, 1), *further], places


def _linked(engine: OfCranks, rods: LinkRods | None, master: Masters | None) -> OfCranks:
    """Return an engine with link rods, if there are any."""
    if rods is None:
        inputs.only_with("rods", master=master)
        return engine
    if not isinstance(rods, LinkRods):
        raise inputs.rejected("rods", rods, "give crankpin.LinkRods; others: Engine.with_link_rods")
    return engine.with_link_rods(rods, master=master)


def vee_layout(
    bank_angle_deg: Angle,
    pin_split_deg: Angle,
    bank_stagger: float,
    numbering: Numbering,
    odd_bank: Side,
) -> dict[str, Any]:
    """Return where the cylinders of a vee are, as the core takes it."""
    return {
        "bank_angle": inputs.angle("bank_angle_deg", bank_angle_deg),
        "pin_split": inputs.angle("pin_split_deg", pin_split_deg),
        "bank_stagger": inputs.number("bank_stagger", bank_stagger),
        "numbering": inputs.text("numbering", numbering, 'give "alternating" or "by-bank"'),
        "odd_bank": inputs.text("odd_bank", odd_bank, 'give "right" or "left"'),
        "absent": [],
    }


def vee_layout_of(
    bank_angle_deg: Angle | None, bank_stagger: float, numbering: Numbering, odd_bank: Side
) -> dict[str, Any]:
    """Return where the cylinders of a vee are; rejects what an inline engine has no use for."""
    angle = 0.0 if bank_angle_deg is None else bank_angle_deg
    across = vee_layout(angle, 0.0, bank_stagger, numbering, odd_bank)
    if bank_angle_deg is None:
        plain = vee_layout(0.0, 0.0, 0.0, "alternating", "right")
        for name in ("bank_stagger", "numbering", "odd_bank"):
            if across[name] != plain[name]:
                inputs.only_with("bank_angle_deg", **{name: across[name]})
    return across


def _along_crank(
    cylinder: object,
    throws_deg: Angles,
    spacing: ArrayLike,
    rotating_mass: ArrayLike | None,
    first_tdc_deg: Angle,
) -> dict[str, Any]:
    """Return the arguments of places along a crank in the form of the core."""
    return {
        "throws": inputs.angles("throws_deg", throws_deg),
        "spacing": (
            inputs.listed_numbers("spacing", spacing)
            if inputs.is_listed(spacing)
            else inputs.number("spacing", spacing)
        ),
        "rotating_mass": (
            [big_end(cylinder)]
            if rotating_mass is None
            else inputs.listed_numbers("rotating_mass", rotating_mass)
        ),
        "first_tdc": inputs.angle("first_tdc_deg", first_tdc_deg),
    }


def _sharing(core: _core.Engine, layout: dict[str, Any]) -> _core.Engine:
    """Return a vee with the crankpins of the bank of cylinder 1, which the other bank shares."""
    of_first = (
        tdc
        for tdc, bank in zip(core.exact_angles[0], core.bank, strict=True)
        if bank == core.bank[0]
    )
    throws = [str(-Fraction(tdc)) for tdc in of_first]
    return _core.Engine.vee(core.cylinders[0], layout | {"throws": throws})


def _splits(core: _core.Engine) -> NDArray[np.float64]:
    return EngineData(core).pin_split_deg


def _kept(core: _core.Engine, cylinder: Cylinder) -> _core.Engine:
    """Return an engine that keeps what its cylinders were made of, its units checked."""
    checks.units(core)
    return core.keeping([cylinder._details] * len(core.z), [], None)
