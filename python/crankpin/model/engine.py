"""Engines: cylinders at their places on one crankshaft."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs
from crankpin._support.frozen import Frozen
from crankpin.model.cylinder import Cylinder

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles, Orders, Spectrum
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.closed_form import ClosedForm
    from crankpin.analysis.firing import Firing
    from crankpin.analysis.vanishing import VanishingOrders
    from crankpin.analysis.waveform import Waveform

Hold: TypeAlias = Literal["pins", "firing"]
Numbering: TypeAlias = Literal["alternating", "by-bank"]
Side: TypeAlias = Literal["right", "left"]
FiringRule: TypeAlias = Literal["even", "ijesc"]


_CoreEngine: TypeAlias = _core.Engine


class Engine(Frozen):
    """Cylinders at their places on one crankshaft: three lists.

    Made by :meth:`from_lists` from when each cylinder is at top dead centre, which way its bore
    points and where along the crank it is; by :meth:`inline`, :meth:`vee`, :meth:`flat` and
    :meth:`boxer` from throws; by :meth:`from_firing_order`; by :meth:`preset`; or from a file. An
    engine does not change; :meth:`replace` returns another. Two engines are equal when all their
    figures are, and their names.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=1.487)
    >>> v6 = cp.Engine.vee(cylinder, bank_angle_deg=60, throws_deg=[0, 120, 240], spacing=0.13)
    >>> len(v6)
    6
    >>> v6.tdc_deg
    array([  0.,  60., 240., 300., 120., 180.])
    """

    _core: _CoreEngine

    def __init__(self, core: _CoreEngine, name: str = "", source: str = "") -> None:
        if not isinstance(core, _core.Engine):
            raise InputError(
                f"Engine({inputs.shorten(core)}): use Engine.from_lists, .inline, .vee, .flat, "
                ".boxer, .from_firing_order, .preset or .load"
            )
        if name != "" or source != "":
            core = core.named(inputs.text("name", name), inputs.text("source", source))
        self._set(_core=core)

    # --- builders -------------------------------------------------------------------------------

    @classmethod
    def from_lists(
        cls,
        cylinder: Cylinder | Sequence[Cylinder],
        *,
        bank_deg: Angles,
        z: ArrayLike,
        tdc_deg: Angles | None = None,
        pin_deg: Angles | None = None,
        rotating_mass: ArrayLike = 0.0,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return the engine that these lists describe, one entry for each cylinder.

        Any layout: W, VR, radial, whatever turns one crank.

        Parameters
        ----------
        cylinder
            Moving parts of all cylinders, or one for each.
        bank_deg
            Directions of the bores from +x; 90 is upright.
        z
            Places along the crank, from the front to the flywheel, m.
        tdc_deg
            Crank angles at which each crankpin points along its bore.
        pin_deg
            In their place, the crankpins' directions from +x at θ = 0.
        rotating_mass
            Mass that turns at crank radius with each cylinder's crankpin, kg; a number stands for
            all. Cylinders that share a pin share its mass.
        name, source
            What it is called and where its layout is from.

        Raises
        ------
        InputError
            If lists differ in length, both or neither of ``tdc_deg`` and ``pin_deg`` are given, or
            a figure makes no engine.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(1.0, 2.0, 7.0)
        >>> i3 = cp.Engine.from_lists(
        ...     cylinder, tdc_deg=[0, 120, 240], bank_deg=[90, 90, 90], z=[-0.1, 0, 0.1]
        ... )
        >>> abs(i3.balance(rpm=10, orders=[1]).moment).round(3)
        array([[1.33, 0.  ]])
        """
        banks = inputs.angles("bank_deg", bank_deg)
        core = _core.Engine.from_lists(
            _each(cylinder, len(banks)),
            None if tdc_deg is None else inputs.angles("tdc_deg", tdc_deg),
            None if pin_deg is None else inputs.angles("pin_deg", pin_deg),
            banks,
            inputs.vector("z", z).tolist(),
            inputs.per_item("rotating_mass", rotating_mass, len(banks)),
            "",
            "",
        )
        return cls(core, name, source)

    @classmethod
    def inline(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return an upright engine of one bank.

        Parameters
        ----------
        cylinder
            Moving parts of every cylinder.
        throws_deg
            Crankpin angles in the direction of rotation, relative to each other, front to flywheel.
            A throw 120° ahead is at top dead centre 120° *earlier*.
        spacing
            Distance between neighbouring cylinders, m.
        rotating_mass
            Mass that turns with each throw at crank radius, kg; one for all, or one for each.
        first_tdc_deg
            Crank angle at which cylinder 1 is at top dead centre.
        name, source
            What it is called and where its layout is from.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.6)
        >>> i4 = cp.Engine.inline(cylinder, throws_deg=[0, 180, 180, 0], spacing=0.09)
        >>> abs(i4.balance(rpm=6000, orders=[1, 2]).force).round(0)
        array([[    0.,     0.],
               [    0., 12359.]])
        """
        layout = _inline_layout(throws_deg, spacing, rotating_mass, first_tdc_deg)
        return cls(_core.Engine.inline(parts(cylinder), layout), name, source)

    @classmethod
    def vee(
        cls,
        cylinder: Cylinder,
        *,
        bank_angle_deg: Angle,
        throws_deg: Angles,
        spacing: float,
        pin_split_deg: Angle = 0.0,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return an upright vee: two cylinders to a throw, one in each bank.

        Parameters
        ----------
        cylinder
            Moving parts of every cylinder.
        bank_angle_deg
            Angle between the banks, 0 to 180.
        throws_deg
            Angles of the right bank's crankpins in the direction of rotation, relative to each
            other, front to flywheel.
        spacing
            Distance between neighbouring throws, m.
        pin_split_deg
            Left pin minus right pin, in the direction of rotation; 0 for shared pins. Even firing
            needs bank angle − firing interval: −60 for a 60° V6, −30 for a 90° V6.
        bank_stagger
            How far the left bank stands behind the right, towards the flywheel, m.
        numbering
            ``"alternating"`` along the crank from bank to bank, or ``"by-bank"``.
        odd_bank
            The bank with cylinder 1, seen from the flywheel.
        rotating_mass
            Mass that turns with each throw at crank radius, half of it in the plane of each of its
            two cylinders, kg; one for all, or one for each.
        first_tdc_deg
            Crank angle at which cylinder 1 is at top dead centre.
        name, source
            What it is called and where its layout is from.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.045, 0.15, 0.5)
        >>> v8 = cp.Engine.vee(
        ...     cylinder, bank_angle_deg=90, throws_deg=[0, 90, 270, 180], spacing=0.1
        ... )
        >>> v8.balance(rpm=6000, orders=[1]).moment.backward  # all of it turns with the crank
        array([0.+0.j])
        """
        layout = _vee_layout(
            bank_angle_deg=bank_angle_deg,
            throws_deg=throws_deg,
            spacing=spacing,
            pin_split_deg=pin_split_deg,
            bank_stagger=bank_stagger,
            numbering=numbering,
            odd_bank=odd_bank,
            rotating_mass=rotating_mass,
            first_tdc_deg=first_tdc_deg,
        )
        return cls(_core.Engine.vee(parts(cylinder), layout), name, source)

    @classmethod
    def flat(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        **options: Any,  # noqa: ANN401
    ) -> Engine:
        """Return a flat engine whose opposed cylinders share a crankpin: a 180° vee.

        Takes what :meth:`vee` takes but ``bank_angle_deg``.

        Examples
        --------
        >>> import crankpin as cp
        >>> flat4 = cp.Engine.flat(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> abs(flat4.balance(rpm=10, orders=[1]).moment).round(2)
        array([[0.  , 3.95]])
        """
        return cls.vee(
            cylinder, bank_angle_deg=180, throws_deg=throws_deg, spacing=spacing, **options
        )

    @classmethod
    def boxer(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        **options: Any,  # noqa: ANN401
    ) -> Engine:
        """Return a boxer: opposed pistons move in mirror image, on pins half a turn apart.

        Takes what :meth:`vee` takes but ``bank_angle_deg`` and ``pin_split_deg``;
        ``bank_stagger`` is the distance that a crank web puts between opposed cylinders.

        Examples
        --------
        >>> import crankpin as cp
        >>> boxer = cp.Engine.boxer(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> boxer.tdc_deg
        array([  0.,   0., 180., 180.])
        """
        return cls.vee(
            cylinder,
            bank_angle_deg=180,
            pin_split_deg=180,
            throws_deg=throws_deg,
            spacing=spacing,
            **options,
        )

    @classmethod
    def from_firing_order(
        cls,
        cylinder: Cylinder,
        firing_order: str | Iterable[int],
        *,
        spacing: float,
        bank_angle_deg: Angle | None = None,
        rule: FiringRule = "even",
        intervals_deg: Angles | None = None,
        strokes: int = 4,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        bank_stagger: float = 0.0,
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return the engine that fires in this order.

        Parameters
        ----------
        cylinder
            Moving parts of every cylinder.
        firing_order
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list.
        spacing
            Distance between neighbouring throws, m.
        bank_angle_deg
            Angle between the banks of a vee; None for an inline engine.
        rule
            ``"even"``: all firing intervals are equal; top dead centres follow from the order, pins
            are split where the bank angle asks for it. ``"ijesc"``: the rule of the IJESC paper of
            2017, by which the cylinders of each bank, in the order in which they fire, lag by equal
            parts of a turn (0°, 120°, 240° in a V6) from the same crank angle in both banks.
        intervals_deg
            With ``rule="even"``: crank angles from each cylinder of the order to the next, and from
            the last to the first, in place of equal ones.
        strokes
            4 or 2: intervals add up to 720 or 360.
        numbering, odd_bank
            As in :meth:`vee`; the IJESC paper has odd cylinders right, the cross-plane page left.
        bank_stagger, rotating_mass, first_tdc_deg, name, source
            As in :meth:`vee`.

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
        text = inputs.firing_order(firing_order)
        rule_text = inputs.text("rule", rule, 'give "even" or "ijesc"')
        listed = None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg)
        from crankpin.analysis.firing import stroke_count  # noqa: PLC0415

        order = (text, rule_text, listed, stroke_count(strokes))
        if bank_angle_deg is None:
            inline = _inline_layout([], spacing, rotating_mass, first_tdc_deg)
            core = _core.Engine.inline_from_firing_order(parts(cylinder), *order, inline)
        else:
            vee = _vee_layout(
                bank_angle_deg=bank_angle_deg,
                throws_deg=[],
                spacing=spacing,
                pin_split_deg=0.0,
                bank_stagger=bank_stagger,
                numbering=numbering,
                odd_bank=odd_bank,
                rotating_mass=rotating_mass,
                first_tdc_deg=first_tdc_deg,
            )
            core = _core.Engine.vee_from_firing_order(parts(cylinder), *order, vee)
        return cls(core, name, source)

    @classmethod
    def preset(
        cls, name: str, *, cylinder: Cylinder | None = None, spacing: float | None = None
    ) -> Engine:
        """Return an engine by its name in :func:`crankpin.presets`.

        Parameters
        ----------
        name
            Such as ``"v8-crossplane"``.
        cylinder
            Moving parts in place of the preset's, for all cylinders.
        spacing
            Distance between neighbouring throws in place of the preset's, m: z and bank stagger are
            stretched about the front.

        Raises
        ------
        InputError
            If there is no such preset; the nearest name is suggested.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v8-crossplane").name
        'V8 90°, cross-plane'
        """
        from crankpin.model import presets  # noqa: PLC0415 - presets are made of engines

        return presets.preset(name, cylinder=cylinder, spacing=spacing)

    # --- files ----------------------------------------------------------------------------------

    @classmethod
    def from_toml(cls, text: str) -> Engine:
        """Return the engine that a TOML text describes; see :meth:`to_toml`."""
        return cls(_core.Engine.from_toml(text))

    @classmethod
    def from_json(cls, text: str) -> Engine:
        """Return the engine that a JSON text describes; see :meth:`to_json`."""
        return cls(_core.Engine.from_json(text))

    @classmethod
    def load(cls, path: str | Path) -> Engine:
        """Return the engine in a ``.toml`` or ``.json`` file.

        Raises
        ------
        InputError
            If the name ends otherwise, or the text describes no engine.
        OSError
            If the file cannot be read.
        """
        path = Path(path)
        read = {".toml": cls.from_toml, ".json": cls.from_json}.get(path.suffix.lower())
        if read is None:
            raise InputError(f"path = {str(path)!r}: an engine file ends in .toml or .json")
        try:
            return read(path.read_text(encoding="utf-8"))
        except UnicodeDecodeError as error:
            raise InputError(f"path = {str(path)!r}: {error}; an engine file is UTF-8") from None

    def to_toml(self) -> str:
        """Return the engine as TOML with a schema version; it reads back as an equal engine.

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
        """Return the engine as JSON with a schema version; it reads back as an equal engine."""
        return self._core.to_json()

    def save(self, path: str | Path) -> None:
        """Write the engine to a ``.toml`` or ``.json`` file."""
        path = Path(path)
        write = {".toml": self.to_toml, ".json": self.to_json}.get(path.suffix.lower())
        if write is None:
            raise InputError(f"path = {str(path)!r}: an engine file ends in .toml or .json")
        path.write_text(write(), encoding="utf-8")

    @property
    def core(self) -> _CoreEngine:
        """Compiled counterpart, private to crankpin."""
        return self._core

    # --- what it is -----------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """What it is called; may be empty."""
        return self._core.name

    @property
    def source(self) -> str:
        """Where its layout is from; may be empty."""
        return self._core.source

    @property
    def cylinders(self) -> tuple[Cylinder, ...]:
        """Moving parts, cylinder by cylinder."""
        return tuple(Cylinder(*parts) for parts in self._core.cylinders)

    @property
    def tdc_deg(self) -> NDArray[np.float64]:
        """Crank angles at which crankpins point along their bores, in [0, 360): (n_cylinders,)."""
        return self._core.tdc_deg

    @property
    def bank_deg(self) -> NDArray[np.float64]:
        """Directions of the bores from +x, in [0, 360): (n_cylinders,)."""
        return self._core.bank_deg

    @property
    def pin_deg(self) -> NDArray[np.float64]:
        """Directions of the crankpins from +x at θ = 0, in [0, 360): (n_cylinders,)."""
        return self._core.pin_deg

    @property
    def z(self) -> NDArray[np.float64]:
        """Places along the crank, m: (n_cylinders,)."""
        return self._core.z

    @property
    def rotating_mass(self) -> NDArray[np.float64]:
        """Mass that turns with each cylinder's crankpin at crank radius, kg: (n_cylinders,)."""
        return self._core.rotating_mass

    @property
    def bank_angle_deg(self) -> float:
        """Angle between the banks of an engine that has two; InputError for any other."""
        return self._core.bank_angle_deg

    @property
    def reference_z(self) -> float:
        """Default reference plane of moments: midway between first and last cylinder, m."""
        return self._core.middle

    def __len__(self) -> int:
        return len(self._core.z)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Engine) and self._core == other._core

    def __hash__(self) -> int:
        return hash(self._core)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Engine, (self._core,))

    def __repr__(self) -> str:
        name = f"{self.name!r}, " if self.name else ""
        banks = sorted(set(self.bank_deg.tolist()))
        bores = ", ".join(f"{bank:g}°" for bank in banks[:6]) + ("…" if len(banks) > 6 else "")
        return f"<Engine {name}{len(self)} cylinders, bores at {bores}>"

    def replace(
        self,
        *,
        cylinder: Cylinder | Sequence[Cylinder] | None = None,
        tdc_deg: Angles | None = None,
        pin_deg: Angles | None = None,
        bank_deg: Angles | None = None,
        z: ArrayLike | None = None,
        rotating_mass: ArrayLike | None = None,
        name: str | None = None,
        source: str | None = None,
    ) -> Engine:
        """Return a copy with some lists changed; see :meth:`from_lists`.

        Examples
        --------
        >>> import crankpin as cp
        >>> i4 = cp.Engine.preset("i4")
        >>> longer = i4.replace(cylinder=[c.replace(rod_length=0.2) for c in i4.cylinders])
        >>> longer == i4
        False
        """
        exact_tdc, exact_bank = self._core.exact_angles
        if tdc_deg is None and pin_deg is None:
            tdc_deg = exact_tdc
        return Engine.from_lists(
            self.cylinders if cylinder is None else cylinder,
            tdc_deg=tdc_deg,
            pin_deg=pin_deg,
            bank_deg=exact_bank if bank_deg is None else bank_deg,
            z=self.z if z is None else z,
            rotating_mass=self.rotating_mass if rotating_mass is None else rotating_mass,
            name=self.name if name is None else name,
            source=self.source if source is None else source,
        )

    def with_bank_angle(self, bank_angle_deg: Angle, *, hold: Hold) -> Engine:
        """Return the same engine with its two banks at another angle about the same bisector.

        Parameters
        ----------
        bank_angle_deg
            Angle between the banks, 0 to 180.
        hold
            ``"pins"``: the crank stays, firing intervals change (the IJESC paper).
            ``"firing"``: every top dead centre stays, pins are split as needed (Ito and Hattori).

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60").with_bank_angle(90, hold="pins")
        >>> v6.bank_angle_deg
        90.0
        """
        held = inputs.text("hold", hold, 'give "pins" or "firing"')
        return Engine(
            self._core.with_bank_angle(inputs.angle("bank_angle_deg", bank_angle_deg), held)
        )

    def with_first_tdc(self, tdc_deg: Angle) -> Engine:
        """Return the same engine, its crank turned so that cylinder 1 is at TDC at this angle."""
        return Engine(self._core.with_first_tdc(inputs.angle("tdc_deg", tdc_deg)))

    # --- how it shakes --------------------------------------------------------------------------

    def balance(
        self,
        rpm: float,
        *,
        orders: Orders = "auto",
        rtol: float | None = None,
        reference_z: float | None = None,
        spectrum: Spectrum | None = None,
        torque: bool = True,
    ) -> Balance:
        """Return how the engine shakes, order by order.

        Parameters
        ----------
        rpm
            Crank speed.
        orders
            Whole multiples of crank speed, or ``"auto"`` for the fewest that reach ``rtol``.
        rtol
            For ``"auto"``: what may be left out, relative to the largest m·r·ω² of any cylinder
            (its reciprocating or its rotating mass), times the longest lever for moments and the
            crank radius for torque.
        reference_z
            Plane about which moments are taken, m; by default midway between the first and the last
            cylinder. It matters where a force is left.
        spectrum
            Order → amplitude of one cylinder's force over ω², in kg·m, in place of every cylinder's
            slider-crank: one measurement or simulation, many layouts. ``rotating_mass`` still turns
            with the pins; torque is not known then.
        torque
            Whether torque is wanted. If not, it is neither worked out nor counted where orders are
            chosen.

        Returns
        -------
        Balance

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> b = cp.Engine.preset("i4").balance(rpm=6000, orders=[1, 2, 4])
        >>> b.force.shape, b.torque.shape
        ((3, 2), (3,))
        >>> b.force[0]  # an inline-4 has no force of order 1
        array([0.+0.j, 0.+0.j])
        """
        from crankpin.analysis.balance import balance  # noqa: PLC0415 - analysis reads engines

        return balance(
            self, rpm, orders=orders, rtol=rtol, reference_z=reference_z, spectrum=spectrum,
            torque=torque,
        )  # fmt: skip

    def waveform(
        self,
        rpm: float,
        *,
        theta_deg: ArrayLike | None = None,
        orders: Orders | None = None,
        rtol: float | None = None,
        reference_z: float | None = None,
        spectrum: Spectrum | None = None,
        torque: bool = True,
    ) -> Waveform:
        """Return force, moment and torque at given crank angles.

        Parameters
        ----------
        rpm
            Crank speed.
        theta_deg
            Crank angles, degrees: (n_theta,); by default 0, 1, …, 720.
        orders
            None for exact kinematics; whole numbers for the sum of those orders; ``"auto"`` for the
            fewest that reach ``rtol``, with what is left out in ``omitted`` and ``error_bound``, or
            for exact kinematics where that costs less than their sum: ``orders`` of the result is
            None then, ``omitted`` empty and ``error_bound`` zero.
        rtol, reference_z, spectrum, torque
            As in :meth:`balance`; a spectrum asks for orders.

        Returns
        -------
        Waveform

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> w = cp.Engine.preset("i4").waveform(rpm=6000, theta_deg=[0, 90, 180])
        >>> w.force.shape
        (3, 2)
        """
        from crankpin.analysis.waveform import waveform  # noqa: PLC0415 - analysis reads engines

        return waveform(
            self, rpm, theta_deg=theta_deg, orders=orders, rtol=rtol, reference_z=reference_z,
            spectrum=spectrum, torque=torque,
        )  # fmt: skip

    # --- when it fires --------------------------------------------------------------------------

    def firing(self, firing_order: str | Iterable[int], *, strokes: int = 4) -> Firing:
        """Return how the engine fires in this order; of several ways the most even.

        Parameters
        ----------
        firing_order
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list, from any of them on. In text,
            ``+`` joins cylinders that fire together: ``"1+4-2+3"``.
        strokes
            4, or 2 for a cycle in each turn.

        Returns
        -------
        Firing

        Raises
        ------
        InputError
            If the crank does not allow this order; the message says what it does allow.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v6-90-odd-fire").firing("1-6-5-4-3-2")
        <Firing 4-stroke 1-6-5-4-3-2, 150-90-150-90-150-90°>
        """
        from crankpin.analysis.firing import Firing, stroke_count  # noqa: PLC0415

        text, number = inputs.firing_order(firing_order), stroke_count(strokes)
        return Firing(_core.Firing.named(self._core, text, number), self)

    def firings(self, firing_order: str | Iterable[int], *, strokes: int = 4) -> tuple[Firing, ...]:
        """Return every way for the engine to fire in this order, the most even first.

        None if its crank does not allow it; several where the order goes through the top dead
        centres of one turn, so that the next turn may begin after any cylinder.

        Parameters
        ----------
        firing_order, strokes
            As in :meth:`firing`.

        Examples
        --------
        >>> import crankpin as cp
        >>> for f in cp.Engine.preset("i2-180").firings("1-2"):
        ...     print(f)
        <Firing 4-stroke 1-2, 180-540°>
        <Firing 4-stroke 1-2, 540-180°>
        """
        from crankpin.analysis.firing import Firing, stroke_count  # noqa: PLC0415

        text, number = inputs.firing_order(firing_order), stroke_count(strokes)
        found = _core.Firing.all_named(self._core, text, number)
        return tuple(Firing(each, self) for each in found)

    def firing_orders(self, *, strokes: int = 4) -> tuple[Firing, ...]:
        """Return every way for the engine to fire, the most even first.

        In a four-stroke each cylinder but the first has a choice of two turns: 2ⁿ⁻¹ ways, for up to
        16 cylinders. Cylinders at top dead centre together may fire together.

        Parameters
        ----------
        strokes
            4, or 2 for a cycle in each turn.

        Raises
        ------
        InputError
            If a four-stroke has more than 16 cylinders: name an order.

        Examples
        --------
        >>> import crankpin as cp
        >>> for f in cp.Engine.preset("i4").firing_orders()[:3]:
        ...     print(f)
        <Firing 4-stroke 1-2-4-3, even, 180°>
        <Firing 4-stroke 1-3-4-2, even, 180°>
        <Firing 4-stroke 1-2+3-4, 180-0-180-360°>
        """
        from crankpin.analysis.firing import Firing, stroke_count  # noqa: PLC0415

        found = _core.Firing.all(self._core, stroke_count(strokes))
        return tuple(Firing(each, self) for each in found)

    # --- exactly --------------------------------------------------------------------------------

    def vanishing_orders(
        self, orders: Orders = range(1, 13), *, reference_z: float | None = None
    ) -> VanishingOrders:
        """Return which orders of force, moment and torque vanish, with proof, at any speed.

        Parameters
        ----------
        orders
            Whole multiples of crank speed.
        reference_z
            Plane about which moments are taken, m; by default midway between the first and the last
            cylinder.

        Returns
        -------
        VanishingOrders

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("i6").vanishing_orders().force.vanishing
        (1, 2, 3, 4, 5, 7, 8, 9, 10, 11)
        """
        from crankpin.analysis.vanishing import vanishing_orders  # noqa: PLC0415

        return vanishing_orders(self, orders, reference_z=reference_z)

    def closed_form(
        self,
        order: int,
        quantity: Literal["force", "moment"] = "moment",
        *,
        reference_z: float | None = None,
    ) -> ClosedForm:
        """Return force or moment of one order as exact expressions (needs SymPy).

        Parameters
        ----------
        order
            Whole multiple of crank speed.
        quantity
            ``"force"`` or ``"moment"``.
        reference_z
            As in :meth:`vanishing_orders`.

        Returns
        -------
        ClosedForm

        Raises
        ------
        InputError
            If angles are no rational parts of a turn, masses or places no rational multiples of
            each other, or slider-cranks of different proportions.
        ImportError
            If SymPy is not installed.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("i3").closed_form(1).peak
        sqrt(3)*F*a
        """
        from crankpin.analysis.closed_form import closed_form  # noqa: PLC0415

        return closed_form(self, order, quantity, reference_z=reference_z)


def parts(cylinder: Cylinder) -> tuple[float, float, float, float, float]:
    """Return the figures of a cylinder, or say that it is none."""
    if not isinstance(cylinder, Cylinder):
        raise InputError(f"cylinder = {inputs.shorten(cylinder)}: give a crankpin.Cylinder")
    return cylinder._parts


def _each(
    cylinder: Cylinder | Sequence[Cylinder], count: int
) -> list[tuple[float, float, float, float, float]]:
    if isinstance(cylinder, Cylinder):
        return [parts(cylinder)] * count
    listed = inputs.items(
        "cylinder", cylinder, "give a crankpin.Cylinder, or one for each cylinder"
    )
    return [parts(each) for each in listed]


def _inline_layout(
    throws_deg: Angles, spacing: float, rotating_mass: ArrayLike, first_tdc_deg: Angle
) -> dict[str, Any]:
    return {
        "throws": inputs.angles("throws_deg", throws_deg),
        "spacing": inputs.number("spacing", spacing),
        "rotating_mass": inputs.vector("rotating_mass", rotating_mass).tolist(),
        "first_tdc": inputs.angle("first_tdc_deg", first_tdc_deg),
    }


def _vee_layout(
    *,
    bank_angle_deg: Angle,
    throws_deg: Angles,
    spacing: float,
    pin_split_deg: Angle,
    bank_stagger: float,
    numbering: str,
    odd_bank: str,
    rotating_mass: ArrayLike,
    first_tdc_deg: Angle,
) -> dict[str, Any]:
    return _inline_layout(throws_deg, spacing, rotating_mass, first_tdc_deg) | {
        "bank_angle": inputs.angle("bank_angle_deg", bank_angle_deg),
        "pin_split": inputs.angle("pin_split_deg", pin_split_deg),
        "bank_stagger": inputs.number("bank_stagger", bank_stagger),
        "numbering": inputs.text("numbering", numbering, 'give "alternating" or "by-bank"'),
        "odd_bank": inputs.text("odd_bank", odd_bank, 'give "right" or "left"'),
    }
