"""Data of an engine: lists, names, hardware, changed copies, files and a table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NoReturn, Self, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import ATMOSPHERE, InputError
from crankpin._support import files, inputs, labels
from crankpin._support.messages import Hint, suppressed
from crankpin._support.parameters import documented
from crankpin._support.record import AbsentError, read_only
from crankpin.model import checks, engine_files, links
from crankpin.model import loads as periodic
from crankpin.model import shafts as rotating
from crankpin.model.cycle import Cycle
from crankpin.model.cylinder import Cylinder

if TYPE_CHECKING:
    from types import EllipsisType

    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles, Order
    from crankpin.model.links import LinkRod, LinkRods, Masters
    from crankpin.model.loads import PeriodicLoad
    from crankpin.model.shafts import Shaft, Unbalance

Hold: TypeAlias = Literal["pins", "firing"]
_CoreEngine: TypeAlias = _core.Engine
_CoreCycle: TypeAlias = _core.Cycle
Cranks: TypeAlias = tuple[Sequence[tuple[float, float, "Order"]], Sequence[int]]
"""Axis and speed ratio of each crankshaft, and the index of each cylinder's own."""

BANK_ANGLE = "{bank_angle}"
"""Placeholder of names: the bank angle in degrees."""


class EngineData:
    """Data of an engine; :class:`Engine` adds builders and analyses."""

    _core: _CoreEngine

    __array_ufunc__: Any = None
    """None, so that NumPy leaves comparison and arithmetic with arrays to the engine."""

    def __init__(
        self,
        core: _CoreEngine,
        name: str = "",
        source: str = "",
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
    ) -> None:
        if not isinstance(core, _core.Engine):
            raise inputs.rejected(
                "core", core, "use Engine.inline, .vee, .from_lists, .preset, .load or the like"
            )
        title, origin = inputs.text("name", name), inputs.text("source", source)
        count = inputs.strokes(strokes)
        order = inputs.firing_order("firing_order", firing_order, core.bank, _silent(core))
        if order:
            core = core.firing_as(_core.Firing.named(core, order, count).text, count)
        elif count != 4:
            core = core.firing_as("", count)
        object.__setattr__(self, "_core", core.named(title, origin) if title or origin else core)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"Engine is frozen: {name} cannot be set; use replace(…)")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"Engine is frozen: {name} cannot be deleted")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, EngineData):
            return NotImplemented
        if self._core.name != other._core.name and self.name == other.name:
            return self._core == other._core.named(self._core.name, other.source)
        return self._core == other._core

    def __hash__(self) -> int:
        return hash(self._core)

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self._core,))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __len__(self) -> int:
        return len(self._core.z)

    # --- lists ----------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Name of the engine; may be empty.

        In a name that is given, ``{bank_angle}`` stands for the bank angle, degrees, and ``{pins}``
        for "shared pins" or "split pins", so that changed copies are named by their own figures.
        """
        return self._named(self._core.name)

    @property
    def title(self) -> str:
        """Name of the engine, or its number of cylinders, with the hardware fitted to it."""
        return self._title()

    def _title(self, *, with_bank_angle: bool = True) -> str:
        """Return the title; without the bank angle where that varies."""
        count = len(self)
        name = self._core.name or f"{count} cylinder{'s' * (count > 1)}"
        if not with_bank_angle:
            name = name.replace(f" {BANK_ANGLE}°", "").replace(f"{BANK_ANGLE}° ", "")
        counts = {
            "counterweight": len(self._core.counterweights),
            "balance shaft": len(self._core.shafts),
        }
        fitted = [f"{n} {what}{'s' * (n > 1)}" for what, n in counts.items() if n]
        return self._named(name) + (f" with {' and '.join(fitted)}" if fitted else "")

    def _named(self, pattern: str) -> str:
        """Return a name with its placeholders filled in."""
        return self._core.filled(pattern)

    @property
    def source(self) -> str:
        """Source of the layout; may be empty."""
        return self._core.source

    @property
    def firing_order(self) -> str:
        """Firing order, such as ``"1-3-4-2"``; empty if it is not known."""
        return self._core.firing_order

    @property
    def strokes(self) -> int:
        """Strokes of a cycle: 4 or 2."""
        return self._core.strokes

    @property
    def cylinders(self) -> tuple[Cylinder, ...]:
        """Moving parts of each cylinder."""
        keys = [*zip(self._core.cylinders, self._core.details, strict=True)]
        by_key = {key: Cylinder._of(*key) for key in set(keys)}
        return tuple(by_key[key] for key in keys)

    @property
    def tdc_deg(self) -> NDArray[np.float64]:
        """Crank angles at which crankpins point along their bores, degrees in [0, 360).

        Of shape (n_cylinders,).
        """
        return self._core.tdc_deg

    @property
    def bank_deg(self) -> NDArray[np.float64]:
        """Directions of the bores from +x, degrees in [0, 360): (n_cylinders,)."""
        return self._core.bank_deg

    @property
    def pin_deg(self) -> NDArray[np.float64]:
        """Directions of the crankpins from +x at θ = 0, degrees in [0, 360): (n_cylinders,)."""
        return self._core.pin_deg

    @property
    def z(self) -> NDArray[np.float64]:
        """Places along the crank, from the front to the flywheel, m: (n_cylinders,)."""
        return self._core.z

    @property
    def rotating_mass(self) -> NDArray[np.float64]:
        """Rotating mass at the crank radius, each cylinder's share of its pin, kg.

        Of shape (n_cylinders,).
        """
        return self._core.rotating_mass

    @property
    def counterweights(self) -> tuple[Unbalance, ...]:
        """Unbalances on the crankshaft besides ``rotating_mass``: amounts in kg·m, z in m."""
        return rotating.counterweights(self._core)

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """Balance shafts: axes and z in m, unbalances in kg·m."""
        return rotating.shafts(self._core)

    @property
    def mains(self) -> NDArray[np.float64]:
        """Places of the bearings along the main crankshaft, m, ascending: (n_mains,).

        Those given; by default one midway between neighbouring throws, and one at either end as far
        outside the last throw as the bearing on its other side. An engine with throws at one place
        only has one a crank radius in front of them and one behind; a crankshaft without throws has
        none.
        """
        return read_only(np.array(self._core.bearings))

    @property
    def reference_z(self) -> float:
        """Plane about which moments are taken, m; by default midway between the end cylinders."""
        z = self._core.reference_z
        return self._core.middle if z is None else z

    @property
    def cycles(self) -> tuple[Cycle | None, ...] | None:
        """Pressure in each cylinder over its cycle, None where it has none; None without any."""
        cores = self._core.cycles
        if cores is None:
            return None
        by_core: dict[_core.Cycle, Cycle] = {}
        for core in cores:
            if core is not None and core not in by_core:
                with suppressed():  # Warned of where it was given.
                    by_core[core] = Cycle._of(core)
        return tuple(None if core is None else by_core[core] for core in cores)

    @property
    def crank_ends(self) -> tuple[Cycle | None, ...] | None:
        """Pressure at the crank end of each cylinder, of one on side rods at the head end.

        None without any.
        """
        ends = self._core.crank_ends
        if ends is None:
            return None
        with suppressed():
            return tuple(None if end is None else Cycle._of(end[0]) for end in ends)

    @property
    def rod_diameter(self) -> NDArray[np.float64]:
        """Diameters of piston rods through crank ends, m: (n_cylinders,); zero without one."""
        ends = self._core.crank_ends or [None] * len(self)
        return read_only(np.array([0.0 if end is None else end[1] for end in ends]))

    @property
    def crankcase(self) -> float | None:
        """Absolute pressure in the crankcase, Pa; None without cycles."""
        return self._core.crankcase

    def _below_pistons(self, crankcase: float | None) -> float:
        """Return a pressure in the crankcase, Pa; of None the engine's own, or the atmosphere's."""
        if crankcase is not None:
            return inputs.number("crankcase", crankcase)
        return ATMOSPHERE if self.crankcase is None else self.crankcase

    @property
    def fired(self) -> bool:
        """True if gas pressure is counted."""
        return self._core.crankcase is not None

    @property
    def loads_counted(self) -> str:
        """Loads besides those of moving parts that results of the engine count, in words.

        ``"without gas pressure"``, or the name of the cycle and which cylinders do not fire; and
        the names of the :attr:`loads`.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> i4 = cp.Engine.preset("i4", cylinder=cylinder)
        >>> i4.loads_counted
        'without gas pressure'
        >>> petrol = cp.Cycle.example()
        >>> i4.with_cycle([petrol, petrol, None, petrol]).loads_counted
        'gas: example petrol, full load; cylinder 3 does not fire'
        """
        return labels.Loads(self._core.loads_counted, self._core.further_loads)

    @property
    def firing_deg(self) -> NDArray[np.float64]:
        """Crank angles of the firing top dead centres, degrees: (n_cylinders,).

        Of pistons that share a chamber those at which it is smallest. In [0, 720) for a
        four-stroke, [0, 360) for a two-stroke; undefined without cycles.
        """
        angles = self._core.firing_deg
        if angles is None:
            raise self._undefined("firing_deg", "it has no cycles; use firing().angles_deg")
        return read_only(np.array(angles))

    # --- banks and throws -----------------------------------------------------------------------

    @property
    def banks(self) -> dict[str, tuple[int, ...]]:
        """Numbers of the cylinders of each bank, by its name.

        Two banks are ``"right"`` and ``"left"``, as seen from the flywheel; others, and parallel
        ones of several cranks, ``"bank 1"``, ``"bank 2"``, …. A bank is an index: a vee at 0° has
        two.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v8-crossplane").banks
        {'right': (2, 4, 6, 8), 'left': (1, 3, 5, 7)}
        """
        members: dict[int, list[int]] = {}
        for number, bank in enumerate(self._core.bank, start=1):
            members.setdefault(bank, []).append(number)
        ordered = sorted(members)
        is_vee = len(ordered) == 2 and self._has_sides()
        names = ["right", "left"] if is_vee else [f"bank {k + 1}" for k in ordered]
        return {name: tuple(members[bank]) for name, bank in zip(names, ordered, strict=True)}

    @property
    def chambers(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the cylinders of each chamber: two where pistons face each other in one bore.

        Such pistons are on different cranks, or side rods drive one. Their chamber fires once,
        under the first number, where it is smallest; dummy pistons have none.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.05, 0.2, 1.2)
        >>> cp.Engine.opposed_pistons(
        ...     cylinder, throws_deg=[0, 120, 240], spacing=0.2, distance=0.9
        ... ).chambers
        ((1, 4), (2, 5), (3, 6))
        """
        return tuple(tuple(chamber) for chamber in self._core.chambers)

    @property
    def bank_angle_deg(self) -> float:
        """Angle between the two banks, degrees.

        Undefined for any other number of banks, and for parallel ones of several cranks.
        """
        if len(self.banks) != 2:
            raise self._of_banks("bank_angle_deg", "exactly two are needed")
        if not self._has_sides():
            self._banks_of_one_crank("bank_angle_deg")
        return self._core.bank_angle_deg

    def _has_sides(self) -> bool:
        """Return whether two banks are a vee: on one crank, or neither parallel nor opposite."""
        return len(set(self._core.cranks[1])) == 1 or 0.0 < self._core.bank_angle_deg < 180.0

    @property
    def throws_deg(self) -> NDArray[np.float64]:
        """Crankpins in the direction of rotation from the front one, degrees in [0, 360).

        Those of the right bank if there are two; undefined for more, and for cylinders on several
        crankshafts. Of shape (n_throws,).
        """
        banks = self._banks_of_one_crank("throws_deg")
        if len(banks) > 2:
            raise self._of_banks("throws_deg", Hint.of("one or two are needed; see `pin_deg`"))
        pins = self.pin_deg[self._along(next(iter(banks.values())))]
        return read_only(_reduced(pins - pins[0]))

    @property
    def pin_split_deg(self) -> NDArray[np.float64]:
        """Left pin minus right pin of each throw, degrees in (−180, 180]: (n_throws,).

        Undefined unless there are two banks of as many cylinders, on one crankshaft.
        """
        banks = self._banks_of_one_crank("pin_split_deg")
        if len(banks) != 2:
            raise self._of_banks("pin_split_deg", "exactly two are needed")
        right, left = (self._along(numbers) for numbers in banks.values())
        if len(right) != len(left):
            sizes = f"{len(right)} cylinders in the right bank and {len(left)} in the left"
            raise self._undefined("pin_split_deg", f"it has {sizes}; as many are needed")
        split = _reduced(self.pin_deg[left] - self.pin_deg[right])
        return read_only(np.where(split > 180.0, split - 360.0, split))

    def _banks_of_one_crank(self, name: str) -> dict[str, tuple[int, ...]]:
        """Return the banks; directions of crankpins on several crankshafts do not compare."""
        if (count := len(set(self._core.cranks[1]))) > 1:
            reason = Hint.of(
                f"its cylinders are on {count} crankshafts; one is needed, see `pin_deg`"
            )
            raise self._undefined(name, reason)
        return self.banks

    def _along(self, numbers: tuple[int, ...]) -> NDArray[np.intp]:
        """Return the places in the lists of these cylinders, front to flywheel."""
        places = np.array(numbers) - 1
        return np.asarray(places[np.argsort(self.z[places], kind="stable")])

    def _of_banks(self, name: str, needed: str) -> InputError:
        directions = list(dict.fromkeys(self.bank_deg.tolist()))
        texts = ", ".join(f"{direction:.6g}°" for direction in directions[:4])
        texts += ", …" if len(directions) > 4 else ""
        count = "one bank" if len(self.banks) == 1 else f"{len(self.banks)} banks"
        return self._undefined(name, f"it has {count} ({texts}); {needed}")

    @staticmethod
    def _undefined(name: str, reason: str) -> InputError:
        return inputs.faulty(name, "is undefined for this engine", reason, AbsentError)

    @property
    def loads(self) -> tuple[PeriodicLoad, ...]:
        """Periodic loads besides pistons, pressure and unbalances."""
        return periodic.loads(self._core)

    @property
    def link_rods(self) -> tuple[LinkRod | None, ...]:
        """Where the rod of each cylinder hangs on a master rod; None of a rod on its crankpin."""
        return links.links(self._core)

    # --- changed copies -------------------------------------------------------------------------

    def _rotating(self, cylinder: Cylinder | Sequence[Cylinder] | None) -> list[float]:
        """Return the rotating masses that stay, or come with the rods, as cylinders change."""
        masses: list[float] = self.rotating_mass.tolist()
        cylinders: Any = [cylinder] * len(self) if isinstance(cylinder, Cylinder) else cylinder
        if not isinstance(cylinders, (list, tuple)) or len(cylinders) != len(self):
            return masses  # those of the engine, or rejected where cylinders are read
        return [
            big_end(new) if getattr(new, "rod", None) and mass == big_end(old) else mass
            for new, old, mass in zip(cylinders, self.cylinders, masses, strict=True)
        ]

    def with_counterweights(self, counterweights: Iterable[Unbalance]) -> Self:
        """Return the same engine with these counterweights in place of those it has.

        All analyses count them: balances, waveforms, sweeps and proofs.

        Parameters
        ----------
        counterweights : sequence of Unbalance
            Unbalances on the crankshaft, each at an angle of its own or at a crankpin.

        Returns
        -------
        Engine
            The engine with them.

        Raises
        ------
        InputError
            If one is no :class:`Unbalance`, or follows the pin of a cylinder that there is not.

        Warns
        -----
        UserWarning
            If an amount or a place seems to be in another unit.

        Examples
        --------
        The couple of the cross-plane V8 turns with the crank: weights at both ends remove it.

        >>> import numpy as np
        >>> import crankpin as cp
        >>> v8 = cp.Engine.preset("v8-crossplane")
        >>> couple = v8.balance(rpm=60)[1].moment.forward / (2 * np.pi) ** 2
        >>> distance = v8.z.max() - v8.z.min()
        >>> angle = np.degrees(np.angle(couple)) + 90
        >>> ends = [
        ...     cp.Unbalance(abs(couple) / distance, z, side + angle)
        ...     for z, side in [(v8.z.min(), 180), (v8.z.max(), 0)]
        ... ]
        >>> bool(v8.with_counterweights(ends).balance(rpm=60, orders=[1])[1].moment.peak < 1e-9)
        True
        """
        return type(self)(rotating.with_counterweights(self._core, counterweights))

    def with_link_rods(
        self, rods: LinkRods | Sequence[LinkRod | None], *, master: Masters | None = None
    ) -> Self:
        """Return the same engine with link rods that hang on master rods.

        A link rod's piston moves a little differently from its master's: see :doc:`what a link rod
        does to balance </explanations/link-rods>`. All analyses count it. Its cycle begins where
        the piston is highest, some degrees from where the crankpin points along the bore. Sweeps of
        lengths and of the bank angle, and tolerances of lengths, reject engines with link rods.

        Parameters
        ----------
        rods : LinkRods or sequence of LinkRod or None
            Link rods of all cylinders that share a crankpin with a master rod, or one for each
            cylinder, None of a rod on its crankpin; ``[None] * len(engine)`` takes them away.
        master : int, sequence of int or str, optional
            With :class:`LinkRods`: number of the cylinder of the master rod, several of engines
            with several crankpins, or the name of their bank; by default the first cylinder of each
            crankpin that several share.

        Returns
        -------
        Engine
            The engine with them.

        Raises
        ------
        InputError
            If a link rod is too short for its knuckle, or its cylinder is not on the crankpin of
            the master.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.048, 0.19, 1.0)
        >>> v12 = cp.Engine.vee(
        ...     cylinder, bank_angle_deg=60, throws_deg=[0, 120, 240, 240, 120, 0], spacing=0.1
        ... )
        >>> rods = cp.LinkRods(radius=0.038, length=0.152, angles_deg=[67] * 6)
        >>> force = v12.with_link_rods(rods, master="right").vanishing_orders(range(1, 8)).force
        >>> force.remaining, force.undecided
        ((3, 6), ())
        """
        if isinstance(rods, links.LinkRods):
            return type(self)(links.with_masters(self._core, self.banks, rods, master))
        inputs.only_with("rods", master=master)
        return type(self)(links.with_links(self._core, rods))

    def with_shafts(self, shafts: Iterable[Shaft]) -> Self:
        """Return the same engine with these balance shafts in place of those it has.

        Parameters
        ----------
        shafts : sequence of Shaft
            Balance shafts; see :class:`crankpin.Shaft`.

        Returns
        -------
        Engine
            The engine with them.

        Raises
        ------
        InputError
            If one is no :class:`Shaft`.

        Warns
        -----
        UserWarning
            If an amount or a place seems to be in another unit.
        """
        return type(self)(rotating.with_shafts(self._core, shafts))

    def with_loads(self, loads: Iterable[PeriodicLoad]) -> Self:
        """Return the same engine with these periodic loads in place of those it has.

        Every result counts each under its name; see :class:`crankpin.PeriodicLoad`.

        Parameters
        ----------
        loads : sequence of PeriodicLoad
            Loads besides pistons, pressure and unbalances; empty for none.

        Returns
        -------
        Engine
            The engine with them.

        Raises
        ------
        InputError
            If one is no :class:`PeriodicLoad`, or is at a crank or a cylinder that the engine does
            not have.

        Examples
        --------
        >>> import crankpin as cp
        >>> belt = cp.PeriodicLoad("belt", on="shaft", force={2: 30}, direction_deg=45, z=-0.1)
        >>> six = cp.Engine.preset("i6").with_loads([belt])
        >>> float(six.balance(rpm=3000)[2].force.peak.round(9))
        30.0
        """
        return type(self)(periodic.with_loads(self._core, loads))

    def with_cycle(
        self,
        cycle: Cycle | Sequence[Cycle | None] | None,
        *,
        crankcase: float | None = None,
        double_acting: bool | Sequence[bool] = False,
        crank_end: Cycle | Sequence[Cycle | None] | None = None,
        rod_diameter: ArrayLike | None = None,
    ) -> Self:
        """Return the same engine with gas pressure in its cylinders, by its firing order.

        Balances, waveforms and sweeps count it: ``torque`` and ``crank_torque`` have the parts
        ``gas`` and ``inertia``, half orders and a ``mean``. Gas pressure makes no force and no
        rocking moment, since its forces on head, wall and bearings cancel.

        Below a piston acts the pressure of the crankcase, unless its crank end has a cycle too. The
        force on a piston is then ``p_head·A - p_crank·(A - A_rod) - p_crankcase·A_rod``, of
        absolute pressures. The cycle of a crank end counts angles from where the piston is lowest;
        in a four-stroke it fires half a turn after the head end. Of a piston on side rods, whose
        inner face is at the chamber of ``cycle``, the other end is the head end, which counts from
        top dead centre and through which the piston rod goes.
        Firing orders and intervals are those of head ends alone.

        Parameters
        ----------
        cycle : Cycle, sequence of Cycle or None, or None
            Pressure over a cycle, for all cylinders but dummy pistons, or one for each; None for a
            cylinder without gas load, as with its valves open. None for an engine without gas
            pressure.
        crankcase : float, optional
            Absolute pressure below the pistons, Pa, at crank ends on the cross-section of the
            piston rod; by default what the engine has, or that of the atmosphere.
        double_acting : bool or sequence of bool, default False
            Whether the cycle acts at the crank end too, in all cylinders or each.
        crank_end : Cycle or sequence of Cycle or None, optional
            In place of ``double_acting``: pressure at the crank ends, of pistons on side rods at
            the head ends, as that of a compressor with ``end="crank"`` or below the pistons of a
            two-stroke that pump its air.
        rod_diameter : array_like, optional
            Diameter of the piston rod through the crank end, m, of all cylinders or each; by
            default 0.

        Returns
        -------
        Engine
            The engine with gas pressure.

        Raises
        ------
        InputError
            If a four-stroke has no firing order (the message has those that the crank allows), a
            cylinder no bore, or a cycle other strokes than the engine, or ``crankcase`` is given
            without a cycle.

        Warns
        -----
        UserWarning
            If the pressure takes more work from the crank than an engine does, or ``crankcase``
            seems to be in another unit.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
        >>> i4 = cp.Engine.preset("i4", cylinder=cylinder).with_cycle(cp.Cycle.example())
        >>> torque = i4.balance(rpm=3000).crank_torque
        >>> f"{torque.cycle_mean:.1f}, {torque[2].gas.peak:.1f}, {torque[2].inertia.peak:.1f} N·m"
        '192.6, 312.7, 182.6 N·m'
        >>> torque[0.5].status  # fires evenly
        'zero, proved'
        """
        ends = self._crank_ends(cycle, double_acting, crank_end, rod_diameter)
        return self._fired_by(cycle, crankcase, self, ends)

    def _crank_ends(
        self,
        cycle: object,
        double_acting: object,
        crank_end: object,
        rod_diameter: ArrayLike | None,
    ) -> list[tuple[_CoreCycle, float] | None]:
        """Return the cycle at the crank end of each cylinder and its rod's diameter, m."""
        count = len(self)
        hint = "give True or False, or one for each cylinder"
        several = not isinstance(double_acting, bool)
        flags = inputs.items("double_acting", double_acting, hint) if several else [double_acting]
        acts = [inputs.flag("double_acting", flag) for flag in flags]
        if crank_end is not None and any(acts):
            hint = Hint.of("it acts at crank ends where `crank_end` is not given; leave one out")
            raise inputs.rejected("double_acting", double_acting, hint)
        of = cycle if crank_end is None else crank_end
        name = "double_acting" if crank_end is None else "crank_end"
        if crank_end is None and not any(acts):
            inputs.only_with("crank_end or double_acting", rod_diameter=rod_diameter)
            return []
        cycles = self._cycle_of_each("crank_end" if crank_end is not None else "cycle", of)
        if len(cycles) != count or (several and len(acts) != count):
            raise inputs.faulty(name, "has another number of entries", f"give one, or {count}")
        if crank_end is None:
            flags_of = acts if several else acts * count
            cycles = [one if flag else None for one, flag in zip(cycles, flags_of, strict=True)]
        if all(one is None for one in cycles):
            inputs.only_with("crank_end or double_acting", rod_diameter=rod_diameter)
            return []
        diameters = inputs.per_item(
            "rod_diameter", 0.0 if rod_diameter is None else rod_diameter, count
        )
        if len(diameters) != count:
            fault = f"has {len(diameters)} entries"
            raise inputs.faulty("rod_diameter", fault, f"give one, or {count}")
        return [
            None if one is None else (one._core, diameter)
            for one, diameter in zip(cycles, diameters, strict=True)
        ]

    def _cycle_of_each(self, name: str, cycle: object) -> list[Any]:
        """Return a cycle for each cylinder but dummy pistons, or those of a list."""
        if cycle is None:
            return [None] * len(self)
        hint = "give a crankpin.Cycle, or one or None for each cylinder"
        if isinstance(cycle, Cycle):
            return [None if one.dummy else cycle for one in self.cylinders]
        cycles = inputs.items(name, cycle, hint)
        for k, one in enumerate(cycles):
            if not (one is None or isinstance(one, Cycle)):
                raise inputs.rejected(f"{name}[{k}]", one, hint)
        return cycles

    @documented(with_loads, with_cycle)
    def replace(
        self,
        *,
        cylinder: Cylinder | Sequence[Cylinder] | None = None,
        tdc_deg: Angles | None = None,
        pin_deg: Angles | None = None,
        bank_deg: Angles | None = None,
        z: ArrayLike | None = None,
        rotating_mass: ArrayLike | None = None,
        counterweights: Iterable[Unbalance] | None = None,
        shafts: Iterable[Shaft] | None = None,
        loads: Iterable[PeriodicLoad] | None = None,
        mains: ArrayLike | EllipsisType | None = ...,
        reference_z: float | EllipsisType | None = ...,
        cycle: Cycle | Sequence[Cycle | None] | EllipsisType | None = ...,
        crankcase: float | None = None,
        firing_order: str | Iterable[int] | None = None,
        strokes: int | None = None,
        name: str | None = None,
        source: str | None = None,
    ) -> Self:
        """Return a copy with some lists changed; see :meth:`from_lists`.

        A firing order that the changed crank does not allow is dropped, unless it is given; dummy
        pistons leave it, and have no cycle. A cylinder with another ``rod`` brings its big end as
        rotating mass, unless the engine's differs from the big end of the rod that it had. Link
        rods hang where they did.

        Parameters
        ----------
        cylinder : Cylinder or sequence of Cylinder, optional
            Moving parts of all cylinders, or one for each; by default unchanged.
        tdc_deg, pin_deg, bank_deg : sequence of number or str, optional
            …; by default unchanged.
        z, rotating_mass : array_like, optional
            …; by default unchanged.
        counterweights : sequence of Unbalance, optional
            …; by default unchanged.
        shafts : sequence of Shaft, optional
            …; by default unchanged.
        loads : sequence of PeriodicLoad, optional
            …; by default unchanged.
        mains : array_like or None, optional
            …; by default unchanged, None for the default of :attr:`mains`.
        reference_z : float or None, optional
            …; by default unchanged, None for the default of :attr:`reference_z`.
        cycle : Cycle, sequence of Cycle or None, or None, optional
            …; by default unchanged.
        crankcase : float, optional
            …; by default unchanged.
        firing_order : str or sequence of int, optional
            …; by default unchanged.
        strokes : {4, 2}, optional
            …; by default unchanged.
        name, source : str, optional
            …; by default unchanged.

        Returns
        -------
        Engine
            The changed copy.

        Raises
        ------
        InputError
            If lists differ in length, both of ``tdc_deg`` and ``pin_deg`` are given, a figure is
            out of range, or the crank does not allow the firing order.

        Examples
        --------
        >>> import crankpin as cp
        >>> i4 = cp.Engine.preset("i4")
        >>> longer = i4.replace(cylinder=[c.replace(rod_length=0.2) for c in i4.cylinders])
        >>> longer == i4
        False
        """
        exact_tdc, exact_bank = self._core.exact_angles
        bearings: Any = self._core.mains if mains is ... else mains
        plane: Any = self._core.reference_z if reference_z is ... else reference_z
        core = core_of_lists(
            self.cylinders if cylinder is None else cylinder,
            exact_tdc if tdc_deg is None and pin_deg is None else tdc_deg,
            pin_deg,
            exact_bank if bank_deg is None else bank_deg,
            self.z if z is None else z,
            self._rotating(cylinder) if rotating_mass is None else rotating_mass,
            mains=bearings,
            reference_z=plane,
            bank=self._core.bank if bank_deg is None else None,
            cranks=self._core.cranks if len(self._core.cranks[0]) > 1 else None,
        )
        weights = self.counterweights if counterweights is None else counterweights
        core = rotating.with_counterweights(core, weights)
        core = links.with_links(core, self.link_rods)
        core = rotating.with_shafts(core, self.shafts if shafts is None else shafts)
        core = periodic.with_loads(core, self.loads if loads is None else loads)
        count = self.strokes if strokes is None else inputs.strokes(strokes)
        changed = type(self)(
            core,
            self._core.name if name is None else name,
            self.source if source is None else source,
            allowed(core, self.firing_order, count) if firing_order is None else firing_order,
            count,
        )
        as_before = tdc_deg is None and pin_deg is None and count == self.strokes
        if as_before and firing_order is None and changed.firing_order == self.firing_order:
            changed = type(self)(changed._core.with_turns(self._core.chosen_turns))
        cycles: Any = self.cycles if cycle is ... else cycle
        if cycles is None:
            inputs.only_with("cycle", crankcase=crankcase)
            return changed
        if cycle is ... and (dummies := _dummies(core)) != _dummies(self._core):
            cycles = [None if k in dummies else one for k, one in enumerate(cycles, start=1)]
            as_before = False
        if cycle is ... and as_before and firing_order is None:
            # Each cylinder fires in the turn in which it did, whether or not its order was dropped.
            below = self._below_pistons(crankcase)
            fired = changed._core.fired_as(self._core, list(range(len(self))), below)
            checks.absolute("crankcase", below)
            fired = fired.firing_as(changed.firing_order, count)
            return type(self)(fired.with_turns(changed._core.chosen_turns))
        ends = (self._core.crank_ends or []) if cycle is ... else []
        ends_kept = [None if k in _dummies(core) else end for k, end in enumerate(ends, start=1)]
        return changed._fired_by(cycles, crankcase, self, ends_kept)

    def _fired_by(
        self,
        cycle: object,
        crankcase: float | None,
        other: EngineData,
        ends: Sequence[tuple[_CoreCycle, float] | None] = (),
    ) -> Self:
        """Return the same engine with cycles, its crankcase by default that of another."""
        at_ends = [None if end is None else end[0] for end in ends]
        cycles = self._cycle_of_each("cycle", cycle)
        cores = [None if one is None else one._core for one in cycles]
        if all(core is None for core in [*cores, *at_ends]):
            inputs.only_with("cycle", crankcase=crankcase)
            if cycle is None:
                return type(self)(self._core.without_cycles())
        below = other._below_pistons(crankcase)
        distinct = [core for core in dict.fromkeys([*cores, *at_ends]) if core is not None]
        cycle_of = [None if core is None else distinct.index(core) for core in cores]
        crank_ends = [None if end is None else (distinct.index(end[0]), end[1]) for end in ends]
        fired = self._core.with_cycles(distinct, cycle_of, below, crank_ends)
        checks.gas(fired)
        return type(self)(fired)

    def with_bank_angle(self, bank_angle_deg: Angle, *, hold: Hold) -> Self:
        """Return the same engine with its two banks at another angle about the same bisector.

        A firing order that the changed crank does not allow is dropped.

        Parameters
        ----------
        bank_angle_deg : number or str
            Angle between the banks, degrees, 0 to 180.
        hold : {"pins", "firing"}
            ``"pins"``: crankpins are held, firing intervals change (the IJESC paper).
            ``"firing"``: all top dead centres are held, pins are split as needed (Ito and Hattori).

        Returns
        -------
        Engine
            The engine at that bank angle.

        Raises
        ------
        InputError
            If the engine does not have two banks, or the angle is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60").with_bank_angle(90, hold="pins")
        >>> v6.bank_angle_deg, v6.name
        (90.0, 'V6 90°, split pins')
        """
        held = inputs.text("hold", hold, 'give "pins" or "firing"')
        if len(self.banks) != 2:
            self.bank_angle_deg  # noqa: B018 - raises
        core = self._core.with_bank_angle(inputs.angle("bank_angle_deg", bank_angle_deg), held)
        checks.radians("bank_angle_deg", bank_angle_deg, [bank_angle_deg])
        order = allowed(core, self.firing_order, self.strokes)
        return type(self)(core if order else core.firing_as("", self.strokes))

    def with_first_tdc(self, first_tdc_deg: Angle) -> Self:
        """Return the same engine, its crank turned so that cylinder 1 is at TDC at this angle.

        Parameters
        ----------
        first_tdc_deg : number or str
            Crank angle, degrees.

        Returns
        -------
        Engine
            The engine, its crank turned.

        Raises
        ------
        InputError
            If the angle is no angle.
        """
        return type(self)(self._core.with_first_tdc(inputs.angle("first_tdc_deg", first_tdc_deg)))

    # --- files ----------------------------------------------------------------------------------

    @classmethod
    def from_toml(cls, text: str) -> Self:
        """Return the engine that a TOML text describes; see :meth:`to_toml`.

        Parameters
        ----------
        text : str
            TOML, as in the reference of engine files.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If the text does not describe an engine.
        """
        return cls._read(_core.Engine.from_toml(_file_text(text)))

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the engine that a JSON text describes; see :meth:`to_json`.

        Parameters
        ----------
        text : str
            JSON, as in the reference of engine files.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If the text does not describe an engine.
        """
        return cls._read(_core.Engine.from_json(_file_text(text)))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the engine in a ``.toml`` or ``.json`` file.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.toml`` or ``.json``.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If the name ends otherwise, or the text does not describe an engine.
        OSError
            If the file cannot be read.
        """
        file = engine_files.checked(path)
        text = engine_files.read(file)
        return cls.from_toml(text) if engine_files.is_toml(file) else cls.from_json(text)

    @classmethod
    def _read(cls, core: _CoreEngine) -> Self:
        """Return the engine of a file, its parts and firing order checked."""
        if core.firing_order:
            order = _core.Firing.named(core, core.firing_order, core.strokes)
            core = core.firing_as(order.text, core.strokes).with_turns(core.chosen_turns)
        read = cls(core)
        with suppressed():
            read.cylinders  # noqa: B018 - rods that contradict their cylinders raise
        checks.engine(core)
        for cycle in dict.fromkeys(cycle for _, cycle in core.face_cycles):
            checks.cycle(cycle)
        checks.gas(core)
        for name in ("tdc_deg", "bank_deg"):
            angles = getattr(core, name).tolist()
            checks.radians(name, angles, angles)
        return read

    def to_toml(self) -> str:
        """Return the engine as TOML with a schema version; it reads back as an equal engine.

        Returns
        -------
        str
            The text.

        Examples
        --------
        >>> import crankpin as cp
        >>> single = cp.Engine.inline(cp.Cylinder(0.05, 0.15, 0.5), throws_deg=[0], spacing=0.1)
        >>> print(single.to_toml())
        schema = 1
        <BLANKLINE>
        [cylinder]
        crank_radius = 0.05
        rod_length = 0.15
        reciprocating_mass = 0.5
        pin_offset = 0.0
        <BLANKLINE>
        [[placements]]
        tdc_deg = 0.0
        bank_deg = 90.0
        z = 0.0
        rotating_mass = 0.0
        <BLANKLINE>
        """
        return self._core.to_toml()

    def to_json(self) -> str:
        """Return the engine as JSON with a schema version; it reads back as an equal engine.

        Returns
        -------
        str
            The text.
        """
        return self._core.to_json()

    def save(self, path: str | Path) -> None:
        """Write the engine to a ``.toml`` or ``.json`` file; TOML has comments that explain it.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.toml`` or ``.json``.

        Raises
        ------
        InputError
            If the name ends otherwise, or the file is there and has a ``[powertrain]``, which would
            be lost.
        OSError
            If the file cannot be written.
        """
        file = engine_files.checked(path)
        engine_files.check_keeps_mounts(file)
        toml = engine_files.is_toml(file)
        text = engine_files.commented(self.to_toml()) if toml else self.to_json()
        files.write(file, text)


def core_of_lists(
    cylinder: Cylinder | Sequence[Cylinder],
    tdc_deg: Angles | None,
    pin_deg: Angles | None,
    bank_deg: Angles,
    z: ArrayLike,
    rotating_mass: ArrayLike | None,
    *,
    mains: ArrayLike | None,
    reference_z: float | None,
    bank: list[int] | None = None,
    cranks: Cranks | None = None,
) -> _CoreEngine:
    """Return the engine of :meth:`Engine.from_lists`; cylinders of equal ``bank`` form one."""
    banks = inputs.angles("bank_deg", bank_deg)
    if isinstance(cylinder, Cylinder):
        cylinders = [cylinder] * len(banks)
    else:
        cylinders = inputs.items(
            "cylinder", cylinder, "give a crankpin.Cylinder, or one for each cylinder"
        )
    core = _core.Engine.from_lists(
        [parts(one) for one in cylinders],
        None if tdc_deg is None else inputs.angles("tdc_deg", tdc_deg),
        None if pin_deg is None else inputs.angles("pin_deg", pin_deg),
        banks,
        bank,
        inputs.listed_numbers("z", z),
        (
            [big_end(one) for one in cylinders]
            if rotating_mass is None
            else inputs.per_item("rotating_mass", rotating_mass, len(banks))
        ),
        cranks,
    )
    bearings = [] if mains is None else inputs.listed_numbers("mains", mains)
    plane = inputs.optional_number("reference_z", reference_z)
    core = core.keeping([one._details for one in cylinders], bearings, plane)
    checks.units(core)
    checks.angles(tdc_deg=tdc_deg, pin_deg=pin_deg, bank_deg=bank_deg)
    checks.place(core, "reference_z", plane)
    return core


def big_end(cylinder: object) -> float:
    """Return the rotating mass of a cylinder whose engine has none by name: its rod's, kg."""
    rod = cylinder.rod if isinstance(cylinder, Cylinder) else None
    return 0.0 if rod is None else rod.rotating_mass


def parts(cylinder: object) -> tuple[float, float, float, float, float]:
    """Return the figures of a cylinder, as the core takes them."""
    if not isinstance(cylinder, Cylinder):
        raise inputs.rejected("cylinder", cylinder, "give a crankpin.Cylinder")
    return cylinder._parts


def _silent(core: _CoreEngine) -> set[int]:
    """Return the numbers that have no place in a firing order: dummies, and second pistons."""
    return {*range(1, len(core.details) + 1)} - {chamber[0] for chamber in core.chambers}


def _dummies(core: _CoreEngine) -> set[int]:
    """Return the numbers of dummy pistons."""
    return {number for number, (*_, dummy, _) in enumerate(core.details, start=1) if dummy}


def allowed(core: _CoreEngine, firing_order: str, strokes: int) -> str:
    """Return a firing order of all chambers; an empty text if the crank does not allow it."""
    silent = {str(number) for number in _silent(core)}
    groups = ([number for number in group.split("+") if number not in silent]
              for group in firing_order.split("-"))  # fmt: skip
    order = "-".join("+".join(group) for group in groups if group)
    try:
        possible = order and _core.Firing.all_named(core, order, strokes)
    except _core.InputError:  # it lacks a piston that was a dummy
        return ""
    return order if possible else ""


def _reduced(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return angles in [0, 360), rounded to what a sum of angles is known to."""
    return np.asarray((degrees % 360.0).round(10) % 360.0)


def _file_text(text: object) -> str:
    return inputs.text("text", text, "give the text of an engine file")
