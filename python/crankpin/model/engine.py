"""Engines: cylinders at their places on one crankshaft."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, tables
from crankpin._support.absent import AbsentError
from crankpin._support.frozen import Frozen
from crankpin.model import builders, files, layout
from crankpin.model import shafts as rotating
from crankpin.model.cylinder import Cylinder

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angle, Angles, Orders, Spectrum
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.closed_form import ClosedForm
    from crankpin.analysis.firing import Firing
    from crankpin.analysis.vanishing import VanishingOrders
    from crankpin.analysis.waveform import Waveform
    from crankpin.model.builders import FiringRule, Numbering, Side
    from crankpin.model.shafts import Shaft, Unbalance
    from crankpin.view.widget import EngineWidget

Hold: TypeAlias = Literal["pins", "firing"]

_CoreEngine: TypeAlias = _core.Engine
MOST_SHOWN = 24
"""Cylinders that a table shows."""


class Engine(Frozen):
    """Cylinders at their places on one crankshaft.

    Three lists describe it: the crank angle of each cylinder's top dead centre, the direction of
    its bore and its place along the crank. Made by :meth:`from_lists` from these; by
    :meth:`inline`, :meth:`vee`, :meth:`flat` and :meth:`boxer` from throws; by
    :meth:`from_firing_order`; by :meth:`preset`; or from a file. An engine does not change;
    :meth:`replace` returns another. Two engines are equal if all their figures, their names and
    their firing orders are.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=1.487)
    >>> v6 = cp.Engine.vee(
    ...     cylinder, bank_angle_deg=60, throws_deg=[0, 120, 240], pin_split_deg=-60, spacing=0.13,
    ...     firing_order="1-2-3-4-5-6", name="V6",
    ... )
    >>> v6
    V6: 6 cylinders, bank angle 60°
    throws 0-120-240°, pins split by -60°
    4-stroke 1-2-3-4-5-6, even, 120°
    cylinder  bank   bore °  TDC °  crankpin °   z m
           1  right      60      0          60     0
           2  left      120    120           0     0
           3  right      60    240         180  0.13
           4  left      120      0         120  0.13
           5  right      60    120         300  0.26
           6  left      120    240         240  0.26
    >>> len(v6), v6.firing().even
    (6, True)
    """

    _core: _CoreEngine

    def __init__(
        self,
        core: _CoreEngine,
        name: str = "",
        source: str = "",
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
    ) -> None:
        if not isinstance(core, _core.Engine):
            raise InputError(
                f"Engine({inputs.shorten(core)}): use Engine.from_lists, .inline, .vee, .flat, "
                ".boxer, .from_firing_order, .preset or .load"
            )
        title, origin = inputs.text("name", name), inputs.text("source", source)
        count = inputs.strokes(strokes)
        order = inputs.firing_order("firing_order", firing_order)
        if order:
            core = core.firing_as(_core.Firing.named(core, order, count).text, count)
        elif count != 4:
            core = core.firing_as("", count)
        self._set(_core=core.named(title, origin) if title or origin else core)

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
        counterweights: Iterable[Unbalance] = (),
        shafts: Iterable[Shaft] = (),
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return the engine that these lists describe, one entry for each cylinder.

        For any layout on one crank: W, VR, radial.

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
            Directions of the crankpins from +x at θ = 0, in place of ``tdc_deg``.
        rotating_mass
            Rotating mass at the crank radius, each cylinder's share of its crankpin, kg: a number
            for all cylinders, or one for each. Of a pin that two cylinders share it is half.
        counterweights, shafts
            What rotates besides: see :class:`crankpin.Unbalance` and :class:`crankpin.Shaft`.
        firing_order
            Firing order of the engine, such as ``"1-3-2"``, if it is known: :meth:`firing` uses it,
            and files keep it.
        strokes
            4 or 2: strokes of a cycle.
        name, source
            Name of the engine, and the source of its layout.

        Raises
        ------
        InputError
            If lists differ in length, both or neither of ``tdc_deg`` and ``pin_deg`` are given, a
            figure is out of range, or the crank does not allow the firing order.

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
        core = builders.from_lists(cylinder, tdc_deg, pin_deg, bank_deg, z, rotating_mass)
        core = rotating.with_counterweights(core, counterweights)
        core = rotating.with_shafts(core, shafts)
        return cls(core, name, source, firing_order, strokes)

    @classmethod
    def inline(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
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
            As in :meth:`from_lists`.
        first_tdc_deg
            Crank angle at which cylinder 1 is at top dead centre.
        firing_order, strokes, name, source
            As in :meth:`from_lists`.

        Examples
        --------
        >>> import crankpin as cp
        >>> cylinder = cp.Cylinder(0.043, 0.145, 0.6)
        >>> i4 = cp.Engine.inline(cylinder, throws_deg=[0, 180, 180, 0], spacing=0.09)
        >>> abs(i4.balance(rpm=6000, orders=[1, 2]).force).round(0)
        array([[    0.,     0.],
               [    0., 12359.]])
        """
        core = builders.inline(cylinder, throws_deg, spacing, rotating_mass, first_tdc_deg)
        return cls(core, name, source, firing_order, strokes)

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
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
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
            Rotating mass at the crank radius, each cylinder's share of its crankpin, kg: a number
            for all cylinders, or one for each. Of a pin that two cylinders share it is half.
        first_tdc_deg
            Crank angle at which cylinder 1 is at top dead centre.
        firing_order, strokes, name, source
            As in :meth:`from_lists`.

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
        core = builders.vee(
            cylinder,
            bank_angle_deg,
            throws_deg,
            spacing,
            pin_split_deg,
            bank_stagger,
            numbering,
            odd_bank,
            rotating_mass,
            first_tdc_deg,
        )
        return cls(core, name, source, firing_order, strokes)

    @classmethod
    def flat(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return a flat engine whose opposed cylinders share a crankpin: a 180° vee.

        Parameters are those of :meth:`vee`.

        Examples
        --------
        >>> import crankpin as cp
        >>> flat4 = cp.Engine.flat(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> flat4.tdc_deg
        array([  0., 180., 180.,   0.])
        """
        core = builders.vee(
            cylinder,
            180,
            throws_deg,
            spacing,
            0.0,
            bank_stagger,
            numbering,
            odd_bank,
            rotating_mass,
            first_tdc_deg,
        )
        return cls(core, name, source, firing_order, strokes)

    @classmethod
    def boxer(
        cls,
        cylinder: Cylinder,
        *,
        throws_deg: Angles,
        spacing: float,
        bank_stagger: float = 0.0,
        numbering: Numbering = "alternating",
        odd_bank: Side = "right",
        rotating_mass: ArrayLike = 0.0,
        first_tdc_deg: Angle = 0.0,
        firing_order: str | Iterable[int] = "",
        strokes: int = 4,
        name: str = "",
        source: str = "",
    ) -> Engine:
        """Return a boxer: opposed pistons move in mirror image, on pins half a turn apart.

        Parameters are those of :meth:`vee`; ``bank_stagger`` is the distance that a crank web puts
        between opposed cylinders, m.

        Examples
        --------
        >>> import crankpin as cp
        >>> boxer = cp.Engine.boxer(cp.Cylinder(1, 2, 9), throws_deg=[0, 180], spacing=0.2)
        >>> boxer.tdc_deg
        array([  0.,   0., 180., 180.])
        """
        core = builders.vee(
            cylinder,
            180,
            throws_deg,
            spacing,
            180,
            bank_stagger,
            numbering,
            odd_bank,
            rotating_mass,
            first_tdc_deg,
        )
        return cls(core, name, source, firing_order, strokes)

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
        """Return an engine that fires in this order, and remembers it.

        Parameters
        ----------
        cylinder
            Moving parts of every cylinder.
        firing_order
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list. Where ``rule="ijesc"`` gives a
            crank that cannot fire in this order, the engine's firing order is left empty.
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
        order = inputs.firing_order("firing_order", firing_order)
        core = builders.from_firing_order(
            cylinder,
            order,
            spacing,
            bank_angle_deg,
            rule,
            intervals_deg,
            strokes,
            numbering,
            odd_bank,
            bank_stagger,
            rotating_mass,
            first_tdc_deg,
        )
        return cls(core, name, source, _allowed(core, order, strokes), strokes)

    @classmethod
    def preset(
        cls,
        name: str,
        *,
        cylinder: Cylinder | None = None,
        spacing: float | None = None,
        rotating_mass: ArrayLike | None = None,
        counterweights: Iterable[Unbalance] | None = None,
        shafts: Iterable[Shaft] | None = None,
    ) -> Engine:
        """Return an engine by its name in :func:`crankpin.presets`.

        Parameters
        ----------
        name
            Such as ``"v8-crossplane"``.
        cylinder
            Moving parts of all cylinders, in place of the preset's.
        spacing
            Distance between neighbouring throws, in place of the preset's, m.
        rotating_mass, counterweights, shafts
            As in :meth:`from_lists`, in place of the preset's.

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
        from crankpin.model import presets

        engine = presets.preset(name, cylinder=cylinder, spacing=spacing)
        return engine.replace(
            rotating_mass=rotating_mass,
            counterweights=counterweights,
            shafts=shafts,
        )

    # --- files ----------------------------------------------------------------------------------

    @classmethod
    def from_toml(cls, text: str) -> Engine:
        """Return the engine that a TOML text describes; see :meth:`to_toml`."""
        return cls(files.from_toml(text))

    @classmethod
    def from_json(cls, text: str) -> Engine:
        """Return the engine that a JSON text describes; see :meth:`to_json`."""
        return cls(files.from_json(text))

    @classmethod
    def load(cls, path: str | Path) -> Engine:
        """Return the engine in a ``.toml`` or ``.json`` file.

        Raises
        ------
        InputError
            If the name ends otherwise, or the text does not describe an engine.
        OSError
            If the file cannot be read.
        """
        return cls(files.load(path))

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
        files.save(path, self._core)

    # --- what it is -----------------------------------------------------------------------------

    @property
    def core(self) -> _CoreEngine:
        """Compiled counterpart of the engine; private to crankpin."""
        return self._core

    @property
    def name(self) -> str:
        """Name of the engine; may be empty."""
        return self._core.name

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
        return tuple(Cylinder(*parts) for parts in self._core.cylinders)

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
    def reference_z(self) -> float:
        """Default reference plane of moments, midway between first and last cylinder, m."""
        return self._core.middle

    @property
    def banks(self) -> dict[str, tuple[int, ...]]:
        """Numbers of the cylinders whose bores have one direction, by the name of the bank.

        Two banks are ``"right"`` and ``"left"``, as seen from the flywheel; others ``"bank 1"``,
        ``"bank 2"``, ….

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v8-crossplane").banks
        {'right': (2, 4, 6, 8), 'left': (1, 3, 5, 7)}
        """
        return layout.banks(self._core)

    @property
    def bank_angle_deg(self) -> float:
        """Angle between the two banks, degrees; undefined for any other number of banks."""
        return layout.bank_angle_deg(self._core)

    @property
    def throws_deg(self) -> NDArray[np.float64]:
        """Crankpins in the direction of rotation from the front one, degrees in [0, 360).

        Those of the right bank if there are two; undefined for more. Of shape (n_throws,).
        """
        return layout.throws_deg(self._core)

    @property
    def pin_split_deg(self) -> NDArray[np.float64]:
        """Left pin minus right pin of each throw, degrees in (−180, 180]: (n_throws,).

        Undefined unless there are two banks of as many cylinders.
        """
        return layout.pin_split_deg(self._core)

    @property
    def firing_intervals_deg(self) -> NDArray[np.float64]:
        """Crank angles between the firings of ``firing_order``, degrees: (n_cylinders,).

        Undefined if the firing order is not known.
        """
        return self._own_firing("firing_intervals_deg").intervals_deg

    @property
    def fires_evenly(self) -> bool:
        """True if all intervals of ``firing_order`` are equal; undefined if it is not known."""
        return self._own_firing("fires_evenly").even

    def _own_firing(self, name: str) -> Firing:
        if not self.firing_order:
            raise AbsentError(
                f"{name} is undefined for this engine: its firing order is not known; give it with "
                "replace(firing_order=…), or use firing(…)"
            )
        return self.firing()

    def __len__(self) -> int:
        return len(self._core.z)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Engine):
            return NotImplemented
        return self._core == other._core

    def __hash__(self) -> int:
        return hash(self._core)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Engine, (self._core,))

    def _lines(self) -> list[str]:
        """Return what a table of the engine has above it."""
        count = len(self.banks)
        if count == 2:
            banks = f"bank angle {self.bank_angle_deg:.6g}°"
        else:
            banks = f"{count} banks" if count > 1 else f"bores at {self.bank_deg[0]:.6g}°"
        cylinders = f"{len(self)} cylinder" + "s" * (len(self) > 1)
        name = " ".join(self.name.split()) or "Engine"
        lines = [f"{labels.cut(name)}: {cylinders}, {banks}"]
        lines += [text] if (text := layout.text(self._core)) else []
        return [
            *(line if len(line) <= 100 else f"{line[:99]}…" for line in lines),
            *([labels.cut(self.firing().summary, 100)] if self.firing_order else []),
            *(labels.cut(line, 100) for line in rotating.lines(self._core)),
        ]

    def _table(self, title: str) -> tables.Table:
        names = {number: name for name, numbers in self.banks.items() for number in numbers}
        columns = {
            "bore °": self.bank_deg,
            "TDC °": self.tdc_deg,
            "crankpin °": self.pin_deg,
            "z m": self.z,
        }
        if self.rotating_mass.any():
            columns["rotating mass kg"] = self.rotating_mass
        labels = [(number, names[number]) for number in range(1, len(self) + 1)][:MOST_SHOWN]
        rows = np.stack(list(columns.values()), axis=1)[:MOST_SHOWN]
        return tables.Table.from_rows(title, ["cylinder", "bank", *columns], labels, rows)

    def __repr__(self) -> str:
        rest = len(self) - MOST_SHOWN
        more = [f"and {rest} more cylinders"] if rest > 0 else []
        return "\n".join([*self._lines(), self._table("").text(), *more])

    def _repr_html_(self) -> str:
        table = self._table("; ".join(self._lines())).html()
        picture = self._repr_svg_()
        return table if picture is None else f"<div>{picture}</div>{table}"

    def _repr_svg_(self) -> str | None:
        from crankpin.analysis.drawing import inline_svg

        return inline_svg(self)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        figure: FigureBase | None = None,
        kind: Literal["section", "star", "side"] | None = None,
        theta_deg: float = 0.0,
        **style: Any,  # noqa: ANN401 - of matplotlib's collections
    ) -> Axes | NDArray[Any]:
        """Draw the engine at a crank angle: cross-section, crank star, crank from the side.

        Seen from the flywheel; the side view from x < 0, front to flywheel. Numbers are those of
        the cylinders. An unbalance is a sector whose area is proportional to its amount. An engine
        does not store its bores: they are drawn as wide as the stroke is long, but at most 0.9 of
        the distance to the next cylinder of the bank, and at least 0.6 of the stroke. Crankpins at
        one place along the crank are drawn side by side.

        Parameters
        ----------
        ax
            Axes for one picture; without ``kind`` the cross-section.
        figure
            Figure or SubFigure for all three; by default a new one.
        kind
            ``"section"``, ``"star"`` or ``"side"`` for one picture; None for all three.
        theta_deg
            Crank angle, degrees.
        **style
            Passed on to the main parts, such as ``facecolor=``: pistons and rods of the section,
            throws of the star, webs of the side view.

        Returns
        -------
        The axes; of all three pictures an array: (3,).

        Raises
        ------
        InputError
            If ``ax`` and ``figure`` are combined, or an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> ax = cp.Engine.preset("v8-crossplane").plot(kind="star", theta_deg=45)
        """
        from crankpin.analysis.drawing import draw

        return draw(  # type: ignore[no-any-return]
            self, ax, figure=figure, kind=kind, theta_deg=theta_deg, **style
        )

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
        firing_order: str | Iterable[int] | None = None,
        strokes: int | None = None,
        name: str | None = None,
        source: str | None = None,
    ) -> Engine:
        """Return a copy with some lists changed; see :meth:`from_lists`.

        A firing order that the changed crank does not allow is dropped, unless it is given.

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
        core = builders.from_lists(
            self.cylinders if cylinder is None else cylinder,
            tdc_deg,
            pin_deg,
            exact_bank if bank_deg is None else bank_deg,
            self.z if z is None else z,
            self.rotating_mass if rotating_mass is None else rotating_mass,
            self._core.bank if bank_deg is None else None,
        )
        weights = self.counterweights if counterweights is None else counterweights
        core = rotating.with_counterweights(core, weights)
        core = rotating.with_shafts(core, self.shafts if shafts is None else shafts)
        count = self.strokes if strokes is None else inputs.strokes(strokes)
        kept = _allowed(core, self.firing_order, count)
        return Engine(
            core,
            self.name if name is None else name,
            self.source if source is None else source,
            kept if firing_order is None else firing_order,
            count,
        )

    def with_counterweights(self, counterweights: Iterable[Unbalance]) -> Engine:
        """Return the same engine with these counterweights in place of those it has.

        All analyses count them: balances, waveforms, sweeps and proofs.

        Parameters
        ----------
        counterweights
            Unbalances on the crankshaft, each at an angle of its own or at a crankpin.

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
        return Engine(rotating.with_counterweights(self._core, counterweights))

    def with_shafts(self, shafts: Iterable[Shaft]) -> Engine:
        """Return the same engine with these balance shafts in place of those it has.

        Parameters
        ----------
        shafts
            Balance shafts; see :class:`crankpin.Shaft`.
        """
        return Engine(rotating.with_shafts(self._core, shafts))

    def with_bank_angle(self, bank_angle_deg: Angle, *, hold: Hold) -> Engine:
        """Return the same engine with its two banks at another angle about the same bisector.

        A firing order that the changed crank does not allow is dropped.

        Parameters
        ----------
        bank_angle_deg
            Angle between the banks, 0 to 180.
        hold
            ``"pins"``: crankpins are held, firing intervals change (the IJESC paper).
            ``"firing"``: all top dead centres are held, pins are split as needed (Ito and Hattori).

        Examples
        --------
        >>> import crankpin as cp
        >>> v6 = cp.Engine.preset("v6-60").with_bank_angle(90, hold="pins")
        >>> v6.bank_angle_deg
        90.0
        """
        held = inputs.text("hold", hold, 'give "pins" or "firing"')
        if len(self.banks) != 2:
            self.bank_angle_deg  # noqa: B018 - raises
        core = self._core.with_bank_angle(inputs.angle("bank_angle_deg", bank_angle_deg), held)
        order = _allowed(core, self.firing_order, self.strokes)
        return Engine(core if order else core.firing_as("", self.strokes))

    def with_first_tdc(self, tdc_deg: Angle) -> Engine:
        """Return the same engine, its crank turned so that cylinder 1 is at TDC at this angle.

        Parameters
        ----------
        tdc_deg
            Crank angle, degrees.
        """
        return Engine(self._core.with_first_tdc(inputs.angle("tdc_deg", tdc_deg)))

    # --- analyses -------------------------------------------------------------------------------

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
        """Return force, moment and torque at one speed, order by order.

        Parameters
        ----------
        rpm
            Crank speed.
        orders
            Whole multiples of crank speed; by default the few that reach ``rtol``.
        rtol
            For ``orders="auto"``: what the omitted orders may add up to, relative to the largest
            m·r·ω² of any cylinder (its reciprocating or its rotating mass), times the longest lever
            for moments and the crank radius for torque. By default 1e-9.
        reference_z
            Plane about which moments are taken, m; by default midway between the first and the last
            cylinder. Moments depend on it where a force remains.
        spectrum
            Order → amplitude of one cylinder's force over ω², in kg·m, in place of every cylinder's
            slider-crank: one measurement or simulation, many layouts. ``rotating_mass`` still
            counts; torque is undefined then.
        torque
            False to leave out torque, in the result and in the choice of orders.

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
        >>> b.force.xy[0]  # an inline-4 has no force of order 1
        array([0.+0.j, 0.+0.j])
        """
        from crankpin.analysis.balance import balance

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
            few that reach ``rtol``, the rest being in ``omitted`` and ``error_bound``.
        rtol
            For ``orders="auto"``, as in :meth:`balance`; by default 1e-6.
        reference_z, spectrum, torque
            As in :meth:`balance`; a spectrum needs ``orders``.

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
        from crankpin.analysis.waveform import waveform

        return waveform(
            self, rpm, theta_deg=theta_deg, orders=orders, rtol=rtol, reference_z=reference_z,
            spectrum=spectrum, torque=torque,
        )  # fmt: skip

    def firing(
        self, firing_order: str | Iterable[int] | None = None, *, strokes: int | None = None
    ) -> Firing:
        """Return angles and intervals of firing in an order; of several ways the most even.

        Parameters
        ----------
        firing_order
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list, beginning with any of them. In
            text, ``+`` joins cylinders that fire together: ``"1+4-2+3"``. By default the engine's
            ``firing_order``.
        strokes
            4, or 2 for a cycle in each turn; by default the engine's ``strokes``.

        Returns
        -------
        Firing

        Raises
        ------
        InputError
            If the crank does not allow this order (the message has those it does allow), or none is
            given nor known.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v6-90-odd-fire").firing()
        <Firing 4-stroke 1-6-5-4-3-2, 150-90-150-90-150-90°>
        """
        from crankpin.analysis import firing

        return firing.firing(self, firing_order, strokes)

    def firings(
        self, firing_order: str | Iterable[int] | None = None, *, strokes: int | None = None
    ) -> tuple[Firing, ...]:
        """Return every way for the engine to fire in this order, the most even first.

        Empty if the crank does not allow the order. There are several where the order follows the
        top dead centres of one turn, so that the next turn may begin after any cylinder.

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
        from crankpin.analysis import firing

        return firing.firings(self, firing_order, strokes)

    def firing_orders(self, *, strokes: int | None = None) -> tuple[Firing, ...]:
        """Return every way for the engine to fire, the most even first.

        In a four-stroke each cylinder but the first fires in either of two turns: 2ⁿ⁻¹ ways, for up
        to 16 cylinders. Cylinders at top dead centre together may fire together.

        Parameters
        ----------
        strokes
            4, or 2 for a cycle in each turn; by default the engine's ``strokes``.

        Raises
        ------
        InputError
            If a four-stroke has more than 16 cylinders; give an order to :meth:`firings` then.

        Examples
        --------
        >>> import crankpin as cp
        >>> for f in cp.Engine.preset("i4").firing_orders()[:3]:
        ...     print(f)
        <Firing 4-stroke 1-2-4-3, even, 180°>
        <Firing 4-stroke 1-3-4-2, even, 180°>
        <Firing 4-stroke 1-2+3-4, 180-0-180-360°>
        """
        from crankpin.analysis import firing

        return firing.firing_orders(self, strokes)

    def vanishing_orders(
        self, orders: Orders = range(1, 13), *, reference_z: float | None = None
    ) -> VanishingOrders:
        """Return which orders of force, moment and torque vanish at any speed, proved in integers.

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
        from crankpin.analysis.vanishing import vanishing_orders

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
        from crankpin.analysis.closed_form import closed_form

        return closed_form(self, order, quantity, reference_z=reference_z)

    # --- pages ----------------------------------------------------------------------------------

    def view(
        self,
        rpm: float = 3000.0,
        *,
        reference_z: float | None = None,
        spectrum: Spectrum | None = None,
    ) -> EngineWidget:
        """Return the engine turning, as a widget for notebooks (needs anywidget).

        Its traits ``angle_deg``, ``rpm``, ``bank_angle_deg``, ``rod_ratio`` and ``hold`` move the
        page when they are set, and follow its reader.

        Parameters
        ----------
        rpm
            Crank speed at first.
        reference_z
            Plane about which moments are taken, m; by default midway between the first and the last
            cylinder.
        spectrum
            As in :meth:`balance`: order → amplitude of one cylinder's force over ω², in kg·m. The
            page has no torque then.

        Raises
        ------
        InputError
            If an argument is out of range.
        ImportError
            If anywidget is not installed.
        """
        from crankpin.view.widget import EngineWidget

        return EngineWidget(self, rpm, reference_z=reference_z, spectrum=spectrum)

    def save_html(
        self,
        path: str | Path,
        *,
        rpm: float = 3000.0,
        reference_z: float | None = None,
        spectrum: Spectrum | None = None,
    ) -> None:
        """Write the engine turning, as a page that needs a browser alone and loads nothing.

        Parameters
        ----------
        path
            Name of the file, which ends in ``.html``.
        rpm, reference_z, spectrum
            As in :meth:`view`.

        Raises
        ------
        InputError
            If an argument is out of range, or the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        from crankpin.view.page import save_html

        save_html(self, path, rpm=rpm, reference_z=reference_z, spectrum=spectrum)


def _allowed(core: _CoreEngine, firing_order: str, strokes: int) -> str:
    """Return a firing order, or an empty text if the crank does not allow it."""
    allowed = firing_order and _core.Firing.all_named(core, firing_order, strokes)
    return firing_order if allowed else ""
