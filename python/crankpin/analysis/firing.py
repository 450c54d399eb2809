"""When cylinders fire, and the crankpins that a firing order needs."""

from __future__ import annotations

import dataclasses
import operator
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, optional, tables
from crankpin._support.frozen import Frozen

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin._support.inputs import Angle, Angles
    from crankpin.model.engine import Engine

TIMES = ("intake_opens_deg", "intake_closes_deg", "exhaust_opens_deg", "exhaust_closes_deg")
PORT_TIMES = ("transfer_opens_deg", "exhaust_opens_deg")

Groups: TypeAlias = Iterable[Iterable[int]]
"""Cylinder numbers, manifold by manifold."""


class Gap(NamedTuple):
    """From one cylinder's firing to the next one's in a group."""

    before: int
    """Number of the cylinder that fires first."""
    after: int
    """Number of the next one; the same where a cylinder is alone."""
    gap_deg: float
    """Crank angle between them."""


class Overlap(NamedTuple):
    """Two cylinders whose exhaust valves, or ports, are open at one time."""

    before: int
    """Number of the cylinder whose exhaust is open."""
    after: int
    """Number of the one that opens into it."""
    gap_deg: float
    """Crank angle from one opening to the other."""
    overlap_deg: float
    """Crank angle for which both are open."""


class Valves(NamedTuple):
    """Crank angles at which valves open and close: (n_cylinders, 2) each, by cylinder number.

    Opening is in [0, 720), closing after it, up to 720 more.
    """

    intake: NDArray[np.float64]
    exhaust: NDArray[np.float64]


class Ports(NamedTuple):
    """Crank angles at which ports open and close: (n_cylinders, 2) each, by cylinder number.

    Opening is in [0, 360), closing after it, up to 360 more.
    """

    transfer: NDArray[np.float64]
    exhaust: NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class ValveTiming:
    """When the valves of a four-stroke open and close, in degrees of crank angle.

    Parameters
    ----------
    intake_opens_deg
        Before top dead centre.
    intake_closes_deg
        After bottom dead centre.
    exhaust_opens_deg
        Before bottom dead centre.
    exhaust_closes_deg
        After top dead centre.

    Each is above −90 and at most 180; below zero is later than the dead centre, or earlier. The
    defaults are those of an ordinary car engine.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.types.ValveTiming(exhaust_opens_deg=80, exhaust_closes_deg=50)
    >>> racing.exhaust_opens_deg
    80.0
    """

    intake_opens_deg: Angle = 10.0
    intake_closes_deg: Angle = 50.0
    exhaust_opens_deg: Angle = 50.0
    exhaust_closes_deg: Angle = 10.0

    def __post_init__(self) -> None:
        for name in TIMES:
            value = getattr(self, name)
            if not isinstance(value, (str, Fraction)):
                object.__setattr__(self, name, inputs.number(name, value))
        _core.valve_timing(self._given)

    @property
    def _given(self) -> tuple[str, str, str, str]:
        first, second, third, fourth = (inputs.angle(name, getattr(self, name)) for name in TIMES)
        return first, second, third, fourth


@dataclasses.dataclass(frozen=True)
class PortTiming:
    """When the ports of a two-stroke open and close, in degrees of crank angle.

    The piston opens them on its way down and closes them as far after bottom dead centre.

    Parameters
    ----------
    transfer_opens_deg
        Before bottom dead centre.
    exhaust_opens_deg
        Before bottom dead centre.

    Each is above 0 and below 180. The defaults are those of an ordinary road engine. With a pin
    offset, bottom dead centre is where the piston is lowest, and a port of some height is open a
    little longer to one side of it than to the other: that is left out.

    Examples
    --------
    >>> import crankpin as cp
    >>> racing = cp.types.PortTiming(transfer_opens_deg=66, exhaust_opens_deg=98)
    >>> racing.exhaust_opens_deg
    98.0
    """

    transfer_opens_deg: Angle = 60.0
    exhaust_opens_deg: Angle = 85.0

    def __post_init__(self) -> None:
        for name in PORT_TIMES:
            value = getattr(self, name)
            if not isinstance(value, (str, Fraction)):
                object.__setattr__(self, name, inputs.number(name, value))
        _core.port_timing(self._given)

    @property
    def _given(self) -> tuple[str, str]:
        transfer, exhaust = (inputs.angle(name, getattr(self, name)) for name in PORT_TIMES)
        return transfer, exhaust


class Firing(Frozen):
    """One way for an engine to fire.

    A crank tells when each piston is at the top, in a four-stroke twice a cycle; at which of the
    two it fires is the camshaft's choice. So an engine has many firing orders, and a firing order
    may be had in more ways than one. A cylinder fires when its piston is highest: at ``tdc_deg``,
    but for a pin offset.

    Intervals of angles that are parts of a turn are exact; so is what is said to be even.

    Made by :meth:`Engine.firing`, :meth:`Engine.firings` and :meth:`Engine.firing_orders`.

    Examples
    --------
    >>> import crankpin as cp
    >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
    >>> f.even
    True
    >>> f.intervals_deg
    array([90., 90., 90., 90., 90., 90., 90., 90.])
    >>> left, right = f.gaps()  # within each bank
    >>> for gap in left:
    ...     print(gap)
    Gap(before=1, after=3, gap_deg=270.0)
    Gap(before=3, after=5, gap_deg=180.0)
    Gap(before=5, after=7, gap_deg=90.0)
    Gap(before=7, after=1, gap_deg=180.0)
    """

    engine: Engine
    """The engine."""
    strokes: int
    """4 or 2."""

    def __init__(self, core: _core.Firing, engine: Engine) -> None:
        if not isinstance(core, _core.Firing):
            raise InputError(
                f"Firing({inputs.shorten(core)}): use Engine.firing, .firings or .firing_orders"
            )
        self._set(_core=core, engine=engine, strokes=core.strokes)

    _core: _core.Firing

    # --- when -----------------------------------------------------------------------------------

    @cached_property
    def order(self) -> tuple[int, ...]:
        """Cylinders in the order in which they fire, from cylinder 1 on."""
        return tuple(self._core.order)

    @cached_property
    def firing_order(self) -> str:
        """The order as text, such as ``"1-3-4-2"``; ``+`` joins cylinders that fire together."""
        return self._core.text

    @cached_property
    def angles_deg(self) -> NDArray[np.float64]:
        """Crank angles θ at which cylinders fire, by number, in [0, 720): (n_cylinders,).

        In [0, 360) for a two-stroke. Cylinder 1 fires in the first turn.
        """
        return self._core.angles_deg

    @cached_property
    def intervals_deg(self) -> NDArray[np.float64]:
        """Crank angles from each cylinder of ``order`` to the next, the last to the first."""
        return self._core.intervals_deg

    @cached_property
    def revolutions(self) -> tuple[int, ...]:
        """In which turn after cylinder 1's firing each cylinder fires, by number: 0 or 1."""
        return tuple(map(int, self._core.later))

    @property
    def even(self) -> bool:
        """Whether all intervals are equal."""
        return self._core.even

    @property
    def unevenness_deg(self) -> float:
        """Root mean square difference of the intervals from equal ones; 0 for even firing."""
        return self._core.unevenness_deg

    @cached_property
    def banks(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the cylinders whose bores have one direction, bank by bank."""
        return tuple(map(tuple, self._core.banks))

    # --- exhaust --------------------------------------------------------------------------------

    def gaps(self, groups: Groups | None = None) -> tuple[tuple[Gap, ...], ...]:
        """Return the crank angles between firings within groups of cylinders, in firing order.

        Parameters
        ----------
        groups
            Cylinder numbers that share an exhaust manifold, group by group; by default the banks.
            Cylinders may be left out.

        Examples
        --------
        Manifolds across the banks give a cross-plane V8 even exhaust pulses:

        >>> import crankpin as cp
        >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
        >>> [[gap.gap_deg for gap in each] for each in f.gaps([[1, 4, 6, 7], [8, 3, 5, 2]])]
        [[180.0, 180.0, 180.0, 180.0], [180.0, 180.0, 180.0, 180.0]]
        """
        found = self._core.gaps(_groups(groups))
        return tuple(tuple(Gap(*gap) for gap in group) for group in found)

    def exhaust_overlaps(
        self, groups: Groups | None = None, *, timing: ValveTiming | PortTiming | None = None
    ) -> tuple[tuple[Overlap, ...], ...]:
        """Return where exhaust valves, or ports, of a group are open at one time.

        Parameters
        ----------
        groups
            As in :meth:`gaps`.
        timing
            When valves open and close; by default ``ValveTiming()``, of a two-stroke
            ``PortTiming()``.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("v8-crossplane").firing("1-8-4-3-6-5-7-2")
        >>> left, right = f.exhaust_overlaps()
        >>> max(left, key=lambda each: each.overlap_deg)
        Overlap(before=5, after=7, gap_deg=90.0, overlap_deg=150.0)
        """
        listed = _groups(groups)
        if self.strokes == 2:
            found = self._core.port_overlaps(listed, _port_timing(timing)._given)
        else:
            found = self._core.valve_overlaps(listed, _timing(timing)._given)
        return tuple(tuple(Overlap(*each) for each in group) for group in found)

    # --- strokes and valves ---------------------------------------------------------------------

    def strokes_deg(self) -> Mapping[str, NDArray[np.float64]]:
        """Return beginning and end of each stroke: name → (n_cylinders, 2), by cylinder number.

        ``"power"``, ``"exhaust"``, ``"intake"``, ``"compression"``; in a two-stroke ``"power"`` and
        ``"compression"``. Beginnings are in [0, 720), or [0, 360); ends are after them. A stroke
        takes 180° but for a pin offset.

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

    def valves(self, timing: ValveTiming | None = None) -> Valves:
        """Return when valves open and close; of a four-stroke.

        Parameters
        ----------
        timing
            When valves open and close; by default ``ValveTiming()``.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("single").firing("1")
        >>> f.valves().exhaust  # opens 50° before bottom, closes 10° after top dead centre
        array([[130., 370.]])
        """
        return Valves(*self._core.valves(_timing(timing)._given))

    def ports(self, timing: PortTiming | None = None) -> Ports:
        """Return when ports open and close; of a two-stroke.

        Parameters
        ----------
        timing
            When ports open and close; by default ``PortTiming()``.

        Examples
        --------
        >>> import crankpin as cp
        >>> f = cp.Engine.preset("single").firing("1", strokes=2)
        >>> f.ports().exhaust  # opens 85° before, closes 85° after bottom dead centre
        array([[ 95., 265.]])
        """
        return Ports(*self._core.ports(_port_timing(timing)._given))

    # --- tables and pictures --------------------------------------------------------------------

    def to_pandas(self) -> pd.DataFrame:
        """Return a table, one row a cylinder in firing order (needs pandas)."""
        pandas = optional.pandas()
        places = np.array(self.order) - 1
        columns = {
            "angle_deg": self.angles_deg[places],
            "interval_deg": self.intervals_deg,
            "gap_in_bank_deg": self._gap_in_bank(),
        }
        table: pd.DataFrame = pandas.DataFrame(
            columns, index=pandas.Index(self.order, name="cylinder")
        )
        return table

    def plot(
        self, ax: Axes | None = None, *, timing: ValveTiming | PortTiming | None = None
    ) -> Axes:
        """Draw when the valves or ports of each cylinder are open, over a cycle; return the axes.

        Intake or transfer is blue, exhaust red, a firing a black mark.

        Parameters
        ----------
        ax
            Axes to draw on; by default new ones.
        timing
            When valves open and close; by default ``ValveTiming()``, of a two-stroke
            ``PortTiming()``.
        """
        from crankpin.analysis.drawing import draw  # noqa: PLC0415 - drawing is optional

        return draw(self, ax, timing=timing)  # type: ignore[no-any-return]

    def _gap_in_bank(self) -> NDArray[np.float64]:
        """Crank angle to the next firing in the same bank, in firing order."""
        gaps = {gap.before: gap.gap_deg for bank in self.gaps() for gap in bank}
        return np.array([gaps[cylinder] for cylinder in self.order])

    def _table(self) -> tables.Table:
        name = self.engine.name or f"{len(self.engine)} cylinders"
        header = ["cylinder", "fires at °", "to the next °", "to the next of its bank °"]
        places = np.array(self.order) - 1
        rows = np.stack([self.angles_deg[places], self.intervals_deg, self._gap_in_bank()], axis=1)
        labels = [f"{cylinder}" for cylinder in self.order]
        return tables.Table(f"{name}: {self._told()}", header, labels, rows)

    def _told(self) -> str:
        how = f"even, {self.intervals_deg[0]:.10g}°" if self.even else f"{self._intervals()}°"
        return f"{self.strokes}-stroke {self.firing_order}, {how}"

    def _intervals(self) -> str:
        return "-".join(f"{interval:.10g}" for interval in self.intervals_deg)

    def __repr__(self) -> str:
        return f"<Firing {self._told()}>"

    def _repr_html_(self) -> str:
        return self._table().html()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Firing):
            return NotImplemented
        return self._core == other._core

    def __hash__(self) -> int:
        return hash((self.engine, self.strokes, self.revolutions))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self.engine, self.strokes, self.revolutions))


class Throws(Frozen):
    """The crankpins that a firing order needs.

    Made by :func:`crankpin.throws`.
    """

    throws_deg: NDArray[np.float64]
    """Crankpins in the direction of rotation from the front one, as builders take them, in
    [0, 360): (n_throws,); in a vee those of the right bank."""
    pin_splits_deg: NDArray[np.float64]
    """Left pin minus right pin of each throw, in (−180, 180]: (n_throws,); empty without banks."""

    def __init__(
        self, throws_deg: NDArray[np.float64], pin_splits_deg: NDArray[np.float64]
    ) -> None:
        given = {"throws_deg": throws_deg, "pin_splits_deg": pin_splits_deg}
        arrays = {name: inputs.vector(name, values).copy() for name, values in given.items()}
        for name, array in arrays.items():
            if not np.isfinite(array).all():
                raise InputError(f"{name} = {inputs.shorten(array)}: give finite degrees")
            array.setflags(write=False)
        self._set(**arrays)

    @property
    def shared_pins(self) -> bool:
        """Whether the two cylinders of every throw share its pin."""
        return bool(self.pin_splits_deg.size) and not self.pin_splits_deg.any()

    def __repr__(self) -> str:
        throws, splits = (
            "-".join(f"{angle:.10g}" for angle in angles)
            for angles in (self.throws_deg, self.pin_splits_deg)
        )
        if not splits:
            return f"<Throws {throws}>"
        if len(set(self.pin_splits_deg.tolist())) == 1:
            splits = f"{self.pin_splits_deg[0]:.10g}"
        else:
            splits = ", ".join(f"{angle:.10g}" for angle in self.pin_splits_deg)
        return f"<Throws {throws}, " + (
            "shared pins>" if self.shared_pins else f"pins split by {splits}>"
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Throws):
            return NotImplemented
        return np.array_equal(self.throws_deg, other.throws_deg) and np.array_equal(
            self.pin_splits_deg, other.pin_splits_deg
        )

    def __hash__(self) -> int:
        return hash((*self.throws_deg.tolist(), *self.pin_splits_deg.tolist()))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Throws, (self.throws_deg, self.pin_splits_deg))


def throws(
    firing_order: str | Iterable[int],
    *,
    bank_angle_deg: Angle | None = None,
    odd_bank: Literal["right", "left"] = "right",
    numbering: Literal["alternating", "by-bank"] = "alternating",
    intervals_deg: Angles | None = None,
    strokes: int = 4,
) -> Throws:
    """Return the crankpins that a firing order needs.

    Parameters
    ----------
    firing_order
        Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list.
    bank_angle_deg
        Angle between the banks of a vee; None for an inline engine.
    odd_bank, numbering
        As in :meth:`Engine.vee`.
    intervals_deg
        Crank angles from each cylinder of the order to the next, and from the last to the first;
        by default equal ones.
    strokes
        4 or 2: intervals add up to 720 or 360.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.throws("1-8-4-3-6-5-7-2", bank_angle_deg=90, odd_bank="left")
    <Throws 0-90-270-180, shared pins>
    >>> cp.throws("1-2-3-4-5-6", bank_angle_deg=60)
    <Throws 0-120-240, pins split by -60>
    >>> cp.throws("1-6-5-4-3-2", bank_angle_deg=90, odd_bank="left", intervals_deg=[150, 90] * 3)
    <Throws 0-240-120, shared pins>
    """
    text = inputs.firing_order(firing_order)
    listed = None if intervals_deg is None else inputs.angles("intervals_deg", intervals_deg)
    number = stroke_count(strokes)
    # Whatever is given is looked at, for an inline engine too.
    side = inputs.text("odd_bank", odd_bank, 'give "right" or "left"')
    scheme = inputs.text("numbering", numbering, 'give "alternating" or "by-bank"')
    if bank_angle_deg is None:
        return Throws(_core.inline_throws(text, listed, number), np.empty(0))
    layout = {
        "throws": [],
        "spacing": 0.0,
        "rotating_mass": [],
        "first_tdc": "0",
        "bank_angle": inputs.angle("bank_angle_deg", bank_angle_deg),
        "pin_split": "0",
        "bank_stagger": 0.0,
        "numbering": scheme,
        "odd_bank": side,
    }
    return Throws(*_core.vee_throws(text, listed, number, layout))


def stroke_count(strokes: object) -> int:
    """Return 2 or 4."""
    cure = "give 4 for a four-stroke or 2 for a two-stroke"
    try:
        number = operator.index(strokes)  # type: ignore[arg-type]
    except TypeError:
        number = 0
    if number not in (2, 4):
        raise InputError(f"strokes = {inputs.shorten(strokes)}: {cure}")
    return number


def _again(engine: Engine, strokes: int, revolutions: tuple[int, ...]) -> Firing:
    later = [bool(turn) for turn in revolutions]
    return Firing(_core.Firing.with_later(engine._core, strokes, later), engine)


def _timing(timing: object) -> ValveTiming:
    if timing is None:
        return ValveTiming()
    if not isinstance(timing, ValveTiming):
        cure = "give a crankpin.ValveTiming, of a two-stroke a crankpin.PortTiming"
        raise InputError(f"timing = {inputs.shorten(timing)}: {cure}")
    return timing


def _port_timing(timing: object) -> PortTiming:
    if timing is None:
        return PortTiming()
    if not isinstance(timing, PortTiming):
        cure = "give a crankpin.PortTiming, of a four-stroke a crankpin.ValveTiming"
        raise InputError(f"timing = {inputs.shorten(timing)}: {cure}")
    return timing


def _groups(groups: Groups | None) -> list[list[int]] | None:
    if groups is None:
        return None
    cure = "give lists of cylinder numbers, such as [[1, 4], [2, 3]]"
    listed = []
    for k, group in enumerate(inputs.items("groups", groups, cure)):
        name = f"groups[{k}]"
        try:
            numbers = [operator.index(number) for number in inputs.items(name, group, cure)]
        except TypeError:
            raise InputError(f"{name} = {inputs.shorten(group)}: {cure}") from None
        for number in numbers:
            if not 1 <= number < 2**32:
                raise InputError(f"{name} = {inputs.shorten(number)}: {cure}")
        listed.append(numbers)
    return listed
