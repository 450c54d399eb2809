"""Search of all crank arrangements of a vee for bank angles that a counterweight can balance."""

from __future__ import annotations

import dataclasses
import heapq
import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

from crankpin import _core
from crankpin._support import inputs
from crankpin._support import progress as progress_bar
from crankpin._support.frames import Tabled
from crankpin._support.messages import Hint
from crankpin._support.record import Record, changed, item_key
from crankpin._support.tables import Item, Table
from crankpin.model.data import parts
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Angles
    from crankpin._support.progress import Progress
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Hold

_LISTED = "second_order"
"""Measure that is least in the arrangement listed."""
_WHOLE = (0.0, 180.0)


class Arrangement(Item, Record):
    """A bank angle at which first-order moment is all forward, and the phases of both banks."""

    bank_angle_deg: float
    """Angle between the banks, degrees."""
    first_deg: tuple[float, ...]
    """Phases of the right bank's throws, front to flywheel, degrees: pins, or minus the TDCs."""
    second_deg: tuple[float, ...]
    """Phases of the left bank's throws."""
    counterweight: float
    """First-order moment that a counterweight cancels, over m·r·ω²·spacing."""
    second_order: tuple[float, float]
    """Second-order moments about x and about y, over m·r·ω²·spacing·a₂ (a₂ ≈ rod ratio)."""
    hold: Hold
    """``"firing"`` if phases are minus the TDCs, ``"pins"`` if they are the crankpins."""

    def __init__(
        self,
        bank_angle_deg: float,
        first_deg: ArrayLike,
        second_deg: ArrayLike,
        counterweight: float,
        second_order: ArrayLike,
        hold: Hold = "firing",
    ) -> None:
        numbers = {"bank_angle_deg": bank_angle_deg, "counterweight": counterweight}
        for name, value in numbers.items():
            object.__setattr__(self, name, inputs.number(name, value))
        lists: dict[str, Any] = {
            "first_deg": first_deg,
            "second_deg": second_deg,
            "second_order": second_order,
        }
        for name, values in lists.items():
            # Searches make thousands, of tuples of floats.
            is_plain = type(values) is tuple and all(type(value) is float for value in values)
            floats = values if is_plain else tuple(inputs.listed_numbers(name, values))
            object.__setattr__(self, name, floats)
        inputs.one_of("hold", hold, ("firing", "pins"))
        object.__setattr__(self, "hold", hold)

    @property
    def near_circular(self) -> bool:
        """True if the two second-order moments differ by at most a tenth of the larger."""
        low, high = sorted(self.second_order)
        return high - low <= 0.1 * high

    def engine(self, cylinder: Cylinder, *, spacing: float) -> Engine:
        """Return the vee, numbered along the crank, odd cylinders in the right bank.

        Parameters
        ----------
        cylinder : Cylinder
            Moving parts of every cylinder.
        spacing : float
            Distance between neighbouring throws, m.

        Returns
        -------
        Engine
            The engine, its bank angle exact.

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> (best,) = cp.search_arrangements(cylinders=14).within(60, 90).best()
        >>> engine = best.engine(cp.Cylinder(0.045, 0.15, 0.5), spacing=0.1)
        >>> abs(engine.balance(rpm=6000, orders=[1]).moment.backward)
        array([0.])
        """
        angle = inputs.number("bank_angle_deg", self.bank_angle_deg)
        banks = (
            inputs.angles("first_deg", self.first_deg),
            inputs.angles("second_deg", self.second_deg),
        )
        distance = inputs.number("spacing", spacing)
        held = inputs.text("hold", self.hold)
        core = _core.arrangement(held, angle, *banks, parts(cylinder), distance)
        return Engine(core).replace(cylinder=cylinder)


def search_arrangements(
    cylinders: int,
    *,
    alternating: bool = False,
    phases_deg: Angles | None = None,
    hold: Hold = "firing",
    shared_pins: bool = False,
    progress: Progress = False,
) -> ArrangementSearch:
    """Search all pairs of bank arrangements for those with a balanced bank angle.

    With every top dead centre held and Z = Σ s exp(i·phase) over a bank's throws, s the distance
    from the middle, first-order moment is all forward at α = arg(−Z₂/Z₁), which exists where
    ``|Z₁| = |Z₂|`` (Ito and Hattori, V-14). Equality is decided in whole numbers: ``|Z|²`` is a
    whole combination of roots of unity. Angles are distinguished exactly too. Of the pairs with one
    bank angle the one with the smallest moments, once a counterweight is fitted, is listed.

    Parameters
    ----------
    cylinders : int
        Number of cylinders of the vee, even, 4 to 24: at most twelve throws a bank.
    alternating : bool, default False
        Only arrangements in which, in firing order, front and rear halves of a bank take turns and
        a central throw stands between a rear and a front one.
    phases_deg : sequence of number or str, optional
        Phases of one bank's throws, degrees, rational parts of a turn; by default those of the
        even-firing four-stroke: an odd number of throws n has n phases, an even one n/2, each
        twice.
    hold : {"pins", "firing"}, default "firing"
        Meaning of the phases as the bank angle changes: ``"firing"``, the top dead centres (Ito and
        Hattori), or ``"pins"``, the crankpins, where 2α takes the place of α.
    shared_pins : bool, default False
        Only arrangements whose banks share their crankpins, with ``hold="pins"``: all are balanced
        at 90°. One of each two mirror images is listed, so that the same bank angle is listed for
        each; at most 2²⁰, a V-22's 907 200 among them.
    progress : bool or callable, default False
        True for a tqdm bar (needs tqdm), or a function that is called with the steps done and the
        steps in all, some 50 times a second, while a long search runs.

    Returns
    -------
    ArrangementSearch
        Counts, and the balanced bank angles with an arrangement for each.

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    A V-22 (11!² pairs) takes a fraction of a second. Of twelve different phases there may be more
    bank angles than can be listed: ask for those :meth:`ArrangementSearch.within` a window.

    Examples
    --------
    >>> import crankpin as cp
    >>> search = cp.search_arrangements(cylinders=14, alternating=True)
    >>> search.candidates, search.qualifying, len(search)
    (254016, 12936, 218)
    >>> round(search.at_bank_angle(49.54)[0].counterweight, 4)
    1.5363
    """
    count = inputs.whole("cylinders", cylinders)
    if not 0 <= count < 2**32:
        raise inputs.rejected("cylinders", count, "give 4 to 24")
    phases = None if phases_deg is None else inputs.angles("phases_deg", phases_deg)
    rule = inputs.flag("alternating", alternating)
    shared = inputs.flag("shared_pins", shared_pins)
    held = inputs.text("hold", hold, 'give "firing" or "pins"')
    watched = progress_bar.checked(progress)
    if shared and (held != "pins" or rule):
        raise inputs.rejected(
            "shared_pins",
            True,
            Hint.of(
                'give `hold="pins"`, and leave out `alternating`; with top dead centres '
                "held pins are split at all but one bank angle"
            ),
        )
    with progress_bar.shown(watched, f"V{count}") as report:
        core = _core.Search(count, rule, phases, held, shared, report)
    listed_phases = None if phases is None else tuple(phases)
    return ArrangementSearch(core, count, rule, listed_phases, hold, shared, _progress=watched)


class ArrangementSearch(Tabled):
    """Result of a search: counts, and the balanced bank angles with an arrangement for each.

    A sequence of :class:`Arrangement`, one for each bank angle, ascending: of all pairs that have
    the angle the one whose second-order moment, the larger of those about x and about y, is least;
    of pairs alike in that, the one with the least counterweight. Pairs without any first-order
    moment (:attr:`balanced`) have every angle, and are left out. Made by
    :func:`crankpin.search_arrangements`.

    Examples
    --------
    >>> import crankpin as cp
    >>> search = cp.search_arrangements(cylinders=6)
    >>> search.bank_angles_deg.round(9)
    array([  0.,  60., 120., 180.])
    >>> engine = search[2].engine(cp.Cylinder(0.045, 0.15, 0.5), spacing=0.1)
    >>> abs(engine.balance(rpm=6000, orders=[1]).moment.backward)
    array([0.])
    """

    _search: _core.Search = dataclasses.field(compare=False)
    """Compiled counterpart."""
    cylinders: int
    """Number of cylinders of the vee."""
    alternating: bool
    """True if front and rear halves take turns to fire."""
    phases: tuple[str, ...] | None
    """Phases of a bank's throws where they were given, degrees."""
    hold: Hold
    """Quantity held as the bank angle changes: top dead centres or crankpins."""
    shared_pins: bool = False
    """True if both banks share their crankpins."""
    window_deg: tuple[float, float] = _WHOLE
    """Range of the bank angles listed, degrees."""
    _progress: Progress = dataclasses.field(default=False, compare=False)
    """The progress bar, as given."""

    def __post_init__(self) -> None:
        core: object = self._search
        if not isinstance(core, _core.Search):
            raise inputs.rejected("search", core, "use crankpin.search_arrangements")

    @property
    def candidates(self) -> int:
        """Pairs of bank arrangements that were searched."""
        return self._search.candidates

    @property
    def qualifying(self) -> int:
        """Pairs with a balanced bank angle, a bank with itself included; at any bank angle."""
        return self._search.qualifying

    @property
    def balanced(self) -> int:
        """Pairs without any first-order moment, balanced at every bank angle."""
        return self._search.balanced

    @cached_property
    def _angles(self) -> _core.BankAngles:
        with progress_bar.shown(self._progress, f"V{self.cylinders} bank angles") as report:
            return _core.BankAngles(self._search, self.window_deg, report)

    @cached_property
    def bank_angles_deg(self) -> NDArray[np.float64]:
        """Balanced bank angles in the window, ascending, degrees: (n_angles,)."""
        return self._angles.degrees()

    def within(self, low: float, high: float) -> ArrangementSearch:
        """Return the same search with only the bank angles from ``low`` to ``high``, degrees.

        The search is not repeated, and angles outside are not listed.

        Parameters
        ----------
        low : float
            Smallest bank angle, degrees.
        high : float
            Largest bank angle, degrees.

        Returns
        -------
        ArrangementSearch
            The same search in that window.

        Raises
        ------
        InputError
            If an angle is no number.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.search_arrangements(cylinders=14).within(60, 60.2).bank_angles_deg.round(2)
        array([60.09, 60.13])
        """
        ends = (_bank_angle("low", low), _bank_angle("high", high))
        window = (max(ends[0], self.window_deg[0]), min(ends[1], self.window_deg[1]))
        return changed(self, window_deg=window)

    def __len__(self) -> int:
        return len(self._angles)

    def __getitem__(self, index: int) -> Arrangement:
        return self._least(self._index(index))

    def _least(self, index: int, by: str = _LISTED) -> Arrangement:
        """Return the arrangement at a bank angle of which this measure is least."""
        return Arrangement(**self._angles.solution(index, by), hold=self.hold)

    def __iter__(self) -> Iterator[Arrangement]:
        return (self[k] for k in range(len(self)))

    def at_bank_angle(
        self, bank_angle_deg: float, *, tolerance_deg: float = 0.005
    ) -> tuple[Arrangement, ...]:
        """Return the arrangements listed within a tolerance of a bank angle; empty if none is.

        Parameters
        ----------
        bank_angle_deg : float
            Bank angle, degrees.
        tolerance_deg : float, default 0.005
            Largest difference from it, degrees.

        Returns
        -------
        tuple of Arrangement
            Those listed, ascending by bank angle.

        Raises
        ------
        InputError
            If an argument is out of range.
        """
        angle = inputs.finite("bank_angle_deg", bank_angle_deg)
        tolerance = inputs.finite("tolerance_deg", tolerance_deg)
        return tuple(self.within(angle - tolerance, angle + tolerance))

    def best(
        self, by: str | Callable[[Arrangement], float] = "second_order", *, count: int = 1
    ) -> tuple[Arrangement, ...]:
        """Return the arrangements that minimise an objective, one a bank angle, the best first.

        Parameters
        ----------
        by : {"second_order", "counterweight"} or callable, default "second_order"
            ``"second_order"``: the larger of the two second-order moments;
            ``"counterweight"``: the first-order moment that a counterweight has to take away; of
            either, all pairs are compared. Or any function of an :class:`Arrangement`, for which
            those listed are.
        count : int, default 1
            Number of arrangements.

        Returns
        -------
        tuple of Arrangement
            At most ``count``, the best first.

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> search = cp.search_arrangements(cylinders=14, alternating=True)
        >>> round(search.within(5, 60).best()[0].bank_angle_deg, 2)
        9.13
        """
        measure = by if callable(by) else _MEASURES[inputs.one_of("by", by, _MEASURES)]
        wanted = inputs.whole("count", count, 0)
        least = _LISTED if callable(by) else by
        arrangements = (self._least(k, least) for k in range(len(self)))
        return tuple(heapq.nsmallest(wanted, arrangements, key=measure))

    @property
    def table(self) -> Table:
        """Table of the bank angles, with an arrangement for each."""
        rows = [
            (
                *("-".join(f"{a:.6g}" for a in bank)
                  for bank in (arrangement.first_deg, arrangement.second_deg)),
                arrangement.bank_angle_deg, arrangement.counterweight, *arrangement.second_order,
                "yes" if arrangement.near_circular else "no",
            )
            for arrangement in self
        ]  # fmt: skip
        return Table.from_rows(
            f"V{self.cylinders}: moments over m·r·ω²·spacing, those of order 2 over a₂ too",
            [
                ("right bank", "°"), ("left bank", "°"), ("bank angle", "°"), "counterweight",
                "order 2 about x", "order 2 about y", "near circular",
            ],
            rows,
        )  # fmt: skip

    def _index(self, index: object) -> int:
        if isinstance(index, slice):
            raise inputs.rejected("index", index, "give one index; within(…) gives several angles")
        position: int = item_key(index, len(self))
        return position % len(self)

    @property
    def _brief(self) -> str:
        rule = ", alternating" if self.alternating else ""
        rule += " on shared pins" if self.shared_pins else ""
        count = f"{self.qualifying} of {self.candidates} pairs"
        low, high = self.window_deg
        part = "" if self.window_deg == _WHOLE else f", bank angles {low:g} to {high:g}"
        return f"<ArrangementSearch of a V{self.cylinders}{rule}: {count}{part}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, self._compared())


def _again(
    cylinders: int,
    alternating: bool,
    phases: tuple[str, ...] | None,
    hold: Hold,
    shared_pins: bool,
    window_deg: tuple[float, float],
) -> ArrangementSearch:
    search = search_arrangements(
        cylinders, alternating=alternating, phases_deg=phases, hold=hold, shared_pins=shared_pins
    )
    return search.within(*window_deg)


def _bank_angle(name: str, value: object) -> float:
    angle = inputs.number(name, value)
    if math.isnan(angle):
        raise inputs.rejected(name, angle, "give a bank angle in degrees")
    return angle


_MEASURES: dict[str, Callable[[Arrangement], float]] = {
    "second_order": lambda arrangement: max(arrangement.second_order),
    "counterweight": lambda arrangement: arrangement.counterweight,
}
