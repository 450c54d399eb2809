"""Crank angles at which cylinders fire, the gaps between them, and crankpins for an order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import inputs, labels, tables
from crankpin._support.frames import Tabled
from crankpin._support.parameters import documented
from crankpin._support.record import read_only
from crankpin.analysis.gas_exchange import PortTiming, Timing, ValveTiming, angles
from crankpin.model import checks
from crankpin.model.builders import banks_of_order, vee_layout_of
from crankpin.model.data import EngineData

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle, Angles
    from crankpin.model.builders import Numbering, Side
    from crankpin.model.engine import Engine

Groups: TypeAlias = Iterable[Iterable[int]]
"""Cylinder numbers, manifold by manifold."""

Gaps: TypeAlias = Mapping[tuple[int, int], float]
"""Numbers of a cylinder and of the next one of its group → crank angle, degrees."""


class Firing(Tabled):
    """One way for an engine to fire.

    The crank determines when each piston is at the top, in a four-stroke twice a cycle; the
    camshaft determines at which of the two it fires. An engine therefore has many firing orders,
    and can fire in one order in several ways. A cylinder fires when its piston is highest: at
    ``tdc_deg``, but for a pin offset. Of an engine with cycles (:meth:`Engine.with_cycle`) only
    cylinders that have one fire; of an engine without any all do.

    Intervals of angles that are rational parts of a turn are exact, and so is ``even``.

    Made by :meth:`Engine.firing`, :meth:`Engine.firing_schedules` and :meth:`Engine.firing_orders`.

    Examples
    --------
    >>> import crankpin as cp
    >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
    >>> f.even
    True
    >>> f.intervals_deg
    array([90., 90., 90., 90., 90., 90., 90., 90.])
    >>> left, right = f.gaps()  # within each bank
    >>> left
    {(1, 3): 270.0, (3, 5): 180.0, (5, 7): 90.0, (7, 1): 180.0}
    """

    engine: Engine
    """The engine."""
    strokes: int
    """4 or 2."""
    revolutions: tuple[int, ...]
    """Turns of the crank from cylinder 1's firing to each cylinder's, by number: 0 or 1."""

    @classmethod
    def _of(cls, core: _core.Firing, engine: Engine) -> Firing:
        return cls(engine, core.strokes, tuple(map(int, core.later)))

    def __post_init__(self) -> None:
        # The core checks the turns when they are first read: of thousands few are.
        if not all(map(isinstance, (self.engine, self.revolutions), (EngineData, tuple))):
            hint = "use Engine.firing, .firings or .firing_orders"
            raise inputs.rejected("engine", self.engine, hint)

    @cached_property
    def _core(self) -> _core.Firing:
        later = [bool(turn) for turn in self.revolutions]
        return _core.Firing.with_later(self.engine._core, self.strokes, later)

    # --- when -----------------------------------------------------------------------------------

    @cached_property
    def order(self) -> tuple[int, ...]:
        """Cylinders that fire, in their order, from cylinder 1 or the next one that fires on."""
        return tuple(self._core.order)

    @cached_property
    def firing_order(self) -> str:
        """The order of all cylinders as text, such as ``"1-3-4-2"``.

        ``+`` joins cylinders that fire together. Those that do not fire are named too, where the
        camshaft has them.
        """
        return self._core.text

    @cached_property
    def angles_deg(self) -> NDArray[np.float64]:
        """Crank angles θ at which cylinders fire, by number, degrees in [0, 720): (n_cylinders,).

        In [0, 360) for a two-stroke. Cylinder 1 fires in the first turn. Of cylinders that do not
        fire it is where they would.
        """
        return self._core.angles_deg

    @cached_property
    def intervals_deg(self) -> NDArray[np.float64]:
        """Crank angles from each cylinder of ``order`` to the next, the last to the first, degrees.

        One for each cylinder that fires: (n_firing,).
        """
        return self._core.intervals_deg

    @property
    def even(self) -> bool:
        """True if all intervals are equal."""
        return self._core.even

    @property
    def unevenness_deg(self) -> float:
        """Root mean square difference of the intervals from equal ones, degrees; 0 if even."""
        return self._core.unevenness_deg

    @cached_property
    def banks(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the cylinders whose bores have one direction, bank by bank."""
        return tuple(map(tuple, self._core.banks))

    # --- exhaust --------------------------------------------------------------------------------

    def gaps(self, groups: Groups | None = None) -> tuple[Gaps, ...]:
        """Return the crank angles between firings within groups of cylinders, in firing order.

        A mapping for each group: (number, number of the next to fire) → degrees. A cylinder alone
        is followed by itself.

        Parameters
        ----------
        groups : sequence of sequence of int, optional
            Cylinder numbers that share an exhaust manifold, group by group; by default the banks.
            Cylinders may be left out; those that do not fire are.

        Returns
        -------
        tuple of mapping of (int, int) to float
            A mapping for each group, degrees.

        Raises
        ------
        InputError
            If a number is that of no cylinder.

        Examples
        --------
        Manifolds across the banks give a cross-plane V8 even exhaust pulses:

        >>> import crankpin as cp
        >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
        >>> [list(gaps.values()) for gaps in f.gaps([[1, 4, 6, 7], [8, 3, 5, 2]])]
        [[180.0, 180.0, 180.0, 180.0], [180.0, 180.0, 180.0, 180.0]]
        """
        return tuple(map(dict, self._core.gaps(_groups(groups))))

    @documented(gaps)
    def exhaust_overlaps(
        self, groups: Groups | None = None, *, timing: Timing | None = None
    ) -> tuple[Gaps, ...]:
        """Return the crank angles for which two exhausts of a group are open at one time.

        A mapping for each group: (number, number of the one that opens later) → degrees.

        Parameters
        ----------
        timing : ValveTiming or PortTiming, optional
            When valves open and close; by default ``ValveTiming()``, of a two-stroke
            ``PortTiming()``.

        Returns
        -------
        tuple of mapping of (int, int) to float
            A mapping for each group, degrees.

        Raises
        ------
        InputError
            If a number is that of no cylinder, or the timing is that of other strokes.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
        >>> left, right = f.exhaust_overlaps()
        >>> left
        {(3, 5): 60.0, (5, 7): 150.0, (7, 1): 60.0}
        """
        kind = PortTiming if self.strokes == 2 else ValveTiming
        overlaps = self._core.overlaps(_groups(groups), angles(timing, kind))
        return tuple(map(dict, overlaps))

    # --- strokes and valves ---------------------------------------------------------------------

    def strokes_deg(self) -> Mapping[str, NDArray[np.float64]]:
        """Return beginning and end of each stroke: name → (n_cylinders, 2), by cylinder number.

        ``"power"``, ``"exhaust"``, ``"intake"``, ``"compression"``; in a two-stroke ``"power"`` and
        ``"compression"``. Beginnings are in [0, 720), or [0, 360); ends are after them. A stroke
        takes 180° but for a pin offset.

        Returns
        -------
        mapping of str to ndarray of float, shape (n_cylinders, 2)
            Stroke → its beginnings and ends, degrees.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("i4").firing("1-3-4-2")
        >>> f.strokes_deg()["intake"]
        array([[360., 540.],
               [180., 360.],
               [540., 720.],
               [  0., 180.]])
        """
        return MappingProxyType(dict(self._core.stroke_periods()))

    def valves(self, timing: ValveTiming | None = None) -> Mapping[str, NDArray[np.float64]]:
        """Return when valves open and close: name → (n_cylinders, 2), of a four-stroke.

        ``"intake"`` and ``"exhaust"``, degrees by cylinder number. Opening is in [0, 720), closing
        after it, up to 720 more.

        Parameters
        ----------
        timing : ValveTiming, optional
            When valves open and close; by default ``ValveTiming()``.

        Returns
        -------
        mapping of str to ndarray of float, shape (n_cylinders, 2)
            Valve → its openings and closings, degrees.

        Raises
        ------
        InputError
            If the engine is a two-stroke.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("single").firing("1")
        >>> f.valves()["exhaust"]  # opens 50° before bottom, closes 10° after top dead centre
        array([[130., 370.]])
        """
        intake, exhaust = self._core.open(angles(timing, ValveTiming))
        return MappingProxyType({"intake": intake, "exhaust": exhaust})

    def ports(self, timing: PortTiming | None = None) -> Mapping[str, NDArray[np.float64]]:
        """Return when ports open and close: name → (n_cylinders, 2), of a two-stroke.

        ``"transfer"`` and ``"exhaust"``, degrees by cylinder number. Opening is in [0, 360),
        closing after it, up to 360 more.

        Parameters
        ----------
        timing : PortTiming, optional
            When ports open and close; by default ``PortTiming()``.

        Returns
        -------
        mapping of str to ndarray of float, shape (n_cylinders, 2)
            Port → its openings and closings, degrees.

        Raises
        ------
        InputError
            If the engine is a four-stroke.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("single").firing("1", strokes=2)
        >>> f.ports()["exhaust"]  # opens 85° before, closes 85° after bottom dead centre
        array([[ 95., 265.]])
        """
        transfer, exhaust = self._core.open(angles(timing, PortTiming))
        return MappingProxyType({"transfer": transfer, "exhaust": exhaust})

    # --- tables and pictures --------------------------------------------------------------------

    def _gap_in_bank(self) -> NDArray[np.float64]:
        """Crank angle to the next firing in the same bank, in firing order."""
        gaps = {first: gap for bank in self.gaps() for (first, _), gap in bank.items()}
        return np.array([gaps[cylinder] for cylinder in self.order])

    @property
    def table(self) -> tables.Table:
        """Table of the cylinders in firing order."""
        name = labels.name_of(self.engine)
        places = np.array(self.order) - 1
        rows = np.stack([self.angles_deg[places], self.intervals_deg, self._gap_in_bank()], axis=1)
        return tables.Table.from_rows(
            f"{name}: {self.summary}",
            ["cylinder", ("fires at", "°"), ("to the next", "°"), ("to the next of its bank", "°")],
            [(cylinder,) for cylinder in self.order],
            rows,
        )

    @property
    def summary(self) -> str:
        """Strokes, firing order and intervals in a line of text, and who does not fire."""
        how = f"even, {self.intervals_deg[0]:.10g}°" if self.even else f"{self.intervals_text}°"
        dead = labels.dead_text(self.engine.cycles or ())
        return f"{self.strokes}-stroke {self.firing_order}, {dead}{', ' * bool(dead)}{how}"

    @property
    def intervals_text(self) -> str:
        """Intervals in degrees, joined by hyphens."""
        return "-".join(f"{interval:.10g}" for interval in self.intervals_deg)

    def __repr__(self) -> str:
        """Return a line in place of the table: firings are listed by the dozen."""
        return f"<Firing {self.summary}>"


def firing(engine: Engine, firing_order: str | Iterable[int] | None, strokes: int | None) -> Firing:
    """Return the way of a fired engine, or the most even in an order; see :meth:`Engine.firing`."""
    text, count = _order_and_strokes(engine, firing_order, strokes)
    if firing_order is None and count == engine.strokes:
        return Firing._of(_core.Firing.own(engine._core), engine)
    return Firing._of(_core.Firing.named(engine._core, text, count), engine)


def firings(
    engine: Engine, firing_order: str | Iterable[int] | None, strokes: int | None
) -> tuple[Firing, ...]:
    """Return every way to fire in an order; see :meth:`Engine.firing_schedules`."""
    text, count = _order_and_strokes(engine, firing_order, strokes)
    return tuple(
        Firing._of(core, engine) for core in _core.Firing.all_named(engine._core, text, count)
    )


def firing_orders(engine: Engine, strokes: int | None) -> tuple[Firing, ...]:
    """Return every way to fire; see :meth:`Engine.firing_orders`."""
    count = engine.strokes if strokes is None else inputs.strokes(strokes)
    return tuple(Firing._of(core, engine) for core in _core.Firing.all(engine._core, count))


@documented()
def throws(
    firing_order: str | Iterable[int],
    *,
    bank_angle_deg: Angle | None = None,
    intervals_deg: Angles | None = None,
    numbering: Numbering = "alternating",
    odd_bank: Side = "right",
    strokes: int = 4,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the crankpins that a firing order needs.

    Parameters
    ----------
    firing_order : str or sequence of int
        Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list; ``+`` joins those that fire together.
    bank_angle_deg : number or str, optional
        Angle between the banks of a vee, degrees; None for an inline engine.
    intervals_deg : sequence of number or str, shape (n_cylinders,), optional
        Crank angles from each cylinder of the order to the next, and from the last to the
        first, degrees, 0 between those joined by ``+``; by default equal ones.
    strokes : {4, 2}, default 4
        4 or 2: intervals add up to 720 or 360.

    Returns
    -------
    throws_deg : ndarray of float, shape (n_throws,)
        Crankpins in the direction of rotation from the front one, as builders take them,
        degrees in [0, 360); in a vee those of the right bank.
    pin_split_deg : ndarray of float, shape (n_throws,)
        Left pin minus right pin of each throw, degrees in (−180, 180]; zero for shared pins,
        empty for an inline engine.

    Raises
    ------
    InputError
        If an argument is out of range, or intervals do not add up to a cycle.

    Examples
    --------
    >>> import crankpin as cp
    >>> throws, splits = cp.throws("1-8-4-3-6-5-7-2", bank_angle_deg=90, odd_bank="left")
    >>> throws, splits
    (array([  0.,  90., 270., 180.]), array([0., 0., 0., 0.]))
    >>> throws, splits = cp.throws("1-2-3-4-5-6", bank_angle_deg=60)
    >>> throws, splits
    (array([  0., 120., 240.]), array([-60., -60., -60.]))
    >>> cp.throws("1-3-4-2")[0]
    array([  0., 180., 180.,   0.])
    """
    banks = banks_of_order(firing_order, bank_angle_deg, numbering, odd_bank)
    text = inputs.firing_order("firing_order", firing_order, banks)
    intervals = None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg)
    number = inputs.strokes(strokes)
    across = vee_layout_of(bank_angle_deg, 0.0, numbering, odd_bank)
    if bank_angle_deg is None:
        return _core.inline_throws(text, intervals, number), read_only(np.empty(0))
    layout = {"throws": [], "spacing": 0.0, "rotating_mass": [], "first_tdc": "0"}
    angles, splits = _core.vee_throws(text, intervals, number, layout | across)
    if intervals_deg is None:
        other = across | {"odd_bank": checks.other_bank(odd_bank)}
        _, others = _core.vee_throws(text, intervals, number, layout | other)
        checks.odd_bank(odd_bank, splits, others)
    return angles, splits


def _order_and_strokes(
    engine: Engine, firing_order: str | Iterable[int] | None, strokes: int | None
) -> tuple[str, int]:
    """Return the arguments, or what the engine knows in their place."""
    count = engine.strokes if strokes is None else inputs.strokes(strokes)
    if firing_order is not None:
        return inputs.firing_order("firing_order", firing_order, engine._core.bank), count
    if engine.firing_order and count == engine.strokes:
        return engine.firing_order, count
    fault = "the engine's firing order is not known"
    if engine.firing_order:
        fault = f"the engine's firing order is that of a {engine.strokes}-stroke"
    hint = "give one, such as '1-3-4-2', or list them by firing_orders()"
    raise inputs.rejected("firing_order", None, f"{fault}; {hint}")


def _groups(groups: Groups | None) -> list[list[int]] | None:
    if groups is None:
        return None
    hint = "give lists of cylinder numbers, such as [[1, 4], [2, 3]]"
    texts = []
    for k, group in enumerate(inputs.items("groups", groups, hint)):
        name = f"groups[{k}]"
        numbers = [inputs.whole(name, number) for number in inputs.items(name, group, hint)]
        for number in numbers:
            if not 1 <= number < 2**32:
                raise inputs.rejected(name, number, hint)
        texts.append(numbers)
    return texts
