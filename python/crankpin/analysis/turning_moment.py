"""Turning-moment diagrams: their areas, formulas of torque, and loads in strokes."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.frames import Frames, Tabled
from crankpin._support.record import read_only
from crankpin._support.tables import Column, Table

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

TERM = re.compile(
    r"(?P<sign>[+−-])?\s*(?P<number>\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+)?\s*[·*]?\s*"
    r"(?:(?P<wave>sin|cos)\s*\(?\s*(?P<order>\d+\.?\d*|\.\d+)?\s*[·*]?\s*(?:θ|theta|t)\s*\)?)?\s*"
)
"""Term of a formula: a number, or a number times a sine or cosine."""
FORMULA_HINT = 'give terms such as "5000 + 600 sin 2θ - 30 cos 0.5θ", of whole and half orders'


def formula(name: str, text: str) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Return torque as a function of degrees; rejects a text that is no sum of waves."""
    terms, place = list[tuple[float, str, float]](), 0
    while place < len(text.rstrip()):
        term = TERM.match(text, place)
        sign = term and (term["sign"] or (None if terms else "+"))
        if not term or not sign or not (term["number"] or term["wave"]):
            raise inputs.rejected(name, text, FORMULA_HINT)
        order = float(term["order"] or 1.0)
        if term["wave"] and (order == 0.0 or (2.0 * order) % 1.0):
            raise inputs.rejected(name, text, FORMULA_HINT)
        size = float(term["number"] or 1.0)
        if size > _core.LARGEST:
            raise inputs.rejected(name, text, f"give sizes of {_core.LARGEST:g} at most")
        terms.append((size if sign == "+" else -size, term["wave"] or "", order))
        place = term.end()
    if not terms:
        raise inputs.rejected(name, text, FORMULA_HINT)

    def torque(theta_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        waves: dict[str, Any] = {"sin": np.sin, "cos": np.cos, "": np.ones_like}
        of_terms = [
            size * waves[wave](np.radians(order * theta_deg)) for size, wave, order in terms
        ]
        return np.asarray(sum(of_terms))

    return torque


def stroke_load(
    energy: float,
    *,
    duration_deg: float | None = None,
    thickness: float | None = None,
    stroke: float | None = None,
    start_deg: float = 0.0,
    period_deg: float = 360.0,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the torque of a load that takes its energy in a part of each cycle, as of a punch.

    Parameters
    ----------
    energy : float
        Energy taken in a cycle, J, such as shear energy per area times the area of a hole.
    duration_deg : float, optional
        Angle over which it is taken, at an even torque, degrees.
    thickness : float, optional
        Thickness of what is punched, m, with ``stroke``: of the two strokes of a period the part
        ``thickness / (2 * stroke)`` is taken, as textbooks have it.
    stroke : float, optional
        Stroke of the punch, m.
    start_deg : float, default 0.0
        Angle at which it begins, degrees.
    period_deg : float, default 360.0
        Angle between two strokes of work, degrees.

    Returns
    -------
    tuple of ndarray
        Angles over one period, degrees, and torques, N·m: a ``load_torque`` of :func:`flywheel`.

    Raises
    ------
    InputError
        If a figure is out of range, or both or neither of the duration and the thickness are given.

    Examples
    --------
    7 J for each square millimetre of holes 38 mm wide in plates of 32 mm, by a punch of 100 mm
    stroke, driven evenly; the flywheel turns ten times for each hole:

    >>> import math
    >>> import crankpin as cp
    >>> hole = 7 * math.pi * 38 * 32
    >>> work = cp.stroke_load(hole, thickness=0.032, stroke=0.1, period_deg=3600)
    >>> round(cp.flywheel(None, 60, load_torque=work, irregularity=0.1).energy)
    22463
    """
    taken = inputs.positive("energy", energy)
    period = inputs.positive("period_deg", period_deg)
    inputs.only_one_of(duration_deg=duration_deg, thickness=thickness)
    if thickness is None:
        inputs.only_with("thickness", stroke=stroke)
        duration = inputs.positive("duration_deg", duration_deg)
        if duration > period:
            raise inputs.rejected("duration_deg", duration, f"give at most the period, {period:g}")
    else:
        through, whole = inputs.positive("thickness", thickness), inputs.positive("stroke", stroke)
        if through > whole:
            raise inputs.rejected("thickness", through, f"give at most the stroke, {whole:g}")
        duration = period * through / (2.0 * whole)
    begin = inputs.finite("start_deg", start_deg) % period
    torque, end = taken / np.radians(duration), begin + duration
    # From the beginning of the work on, and back by a period what lies beyond the first one.
    if duration == period:
        theta, level = [0.0, period], [1, 1]
    elif end > period:
        rest = end - period
        theta, level = [0.0, rest, rest, begin, begin, period], [1, 1, 0, 0, 1, 1]
    elif begin == 0.0:
        theta, level = [0.0, end, end, period, period], [1, 1, 0, 0, 1]
    elif end == period:
        theta, level = [0.0, begin, begin, period, period], [0, 0, 1, 1, 0]
    else:
        theta, level = [0.0, begin, begin, end, end, period], [0, 0, 1, 1, 0, 0]
    return read_only(np.array(theta)), read_only(torque * np.array(level))


def turning_moment_areas(
    areas: ArrayLike,
    *,
    torque_scale: float = 1.0,
    angle_scale_deg: float | None = None,
    rpm: float | None = None,
    inertia: float | None = None,
    irregularity: float | None = None,
    spread: bool = False,
) -> TurningMomentAreas:
    """Return the fluctuation of energy of a turning-moment diagram that is given by its areas.

    Between two crossings of torque and its mean, or of torque and load, their difference does the
    work of the area that they enclose. The crank is fastest where the sum of the areas passed is
    highest, slowest where it is lowest.

    Parameters
    ----------
    areas : array_like, shape (n_areas,)
        Areas in the order in which they follow each other, those above the mean positive: J, or in
        the unit of a drawing with both scales.
    torque_scale : float, default 1.0
        Torque of a millimetre (or another unit) of the drawing, N·m; without ``angle_scale_deg``
        the energy of one unit of area, J.
    angle_scale_deg : float, optional
        Angle of the same unit, degrees.
    rpm : float, optional
        Crank speed midway between the extremes, rpm.
    inertia : float, optional
        Moment of inertia of all that turns, kg·m², with ``rpm``.
    irregularity : float, optional
        Irregularity to find the moment of inertia for, with ``rpm``: largest less smallest speed,
        over the speed midway between.
    spread : bool, default False
        Whether areas that do not add to zero, as measured ones, are each changed by the same part
        of their size until they do.

    Returns
    -------
    TurningMomentAreas
        Energy levels, fluctuation of energy and, with ``rpm``, inertia and irregularity.

    Raises
    ------
    InputError
        If the areas do not add to zero and ``spread`` is not set, or a figure is out of range.

    Examples
    --------
    Areas in mm² of a multicylinder engine, 600 N·m and 3° a millimetre, 600 rpm, ±1.5 %, a rim of
    0.5 m radius (Khurmi and Gupta, Theory of Machines, chapter 16, as remembered):

    >>> import crankpin as cp
    >>> a = cp.turning_moment_areas(
    ...     [52, -124, 92, -140, 85, -72, 107], torque_scale=600, angle_scale_deg=3,
    ...     rpm=600, irregularity=0.03,
    ... )
    >>> round(a.energy, 1), round(cp.flywheel_rim(a.inertia, mean_diameter=1.0).mass, 1)
    (5403.5, 182.5)
    """
    torque = inputs.positive("torque_scale", torque_scale)
    scale = torque
    if angle_scale_deg is not None:
        scale *= float(np.radians(inputs.positive("angle_scale_deg", angle_scale_deg)))
    values = inputs.vector("areas", areas)
    levels, highest, lowest = _core.energy_levels(values.tolist(), inputs.flag("spread", spread))
    energy = scale * (levels[highest] - levels[lowest])
    speed = None if rpm is None else inputs.positive("rpm", rpm)
    if speed is None:
        inputs.only_with("rpm", inertia=inertia, irregularity=irregularity)
        both: tuple[float | None, float | None] = (None, None)
    else:
        inputs.only_one_of(inertia=inertia, irregularity=irregularity)
        product = _core.inertia_by_irregularity(energy, speed)
        name = "irregularity" if inertia is None else "inertia"
        one = inputs.positive(name, irregularity if inertia is None else inertia)
        both = (product / one, one) if inertia is None else (one, product / one)
    levels_in_joules = read_only(scale * np.array(levels))
    return TurningMomentAreas(levels_in_joules, highest, lowest, speed, *both)


class TurningMomentAreas(Tabled):
    """Energy of a crank over a cycle, from the areas of its turning-moment diagram.

    ``plot`` draws the areas in their order, shaded, and the energy between them. Made by
    :func:`crankpin.turning_moment_areas`.
    """

    levels: NDArray[np.float64]
    """Work since the first crossing, J: at each, and at the first again: (n_areas + 1,)."""
    highest: int
    """Index of the crossing at which the crank is fastest."""
    lowest: int
    """Index of the crossing at which it is slowest."""
    rpm: float | None
    """Speed midway between the extremes, rpm."""
    inertia: float | None
    """Moment of inertia of all that turns, kg·m²."""
    irregularity: float | None
    """Largest less smallest speed, over that midway between."""

    def __post_init__(self) -> None:
        levels = inputs.vector("levels", self.levels)
        if len(levels) < 3:
            raise inputs.rejected("levels", self.levels, "use crankpin.turning_moment_areas")
        for name in ("highest", "lowest"):
            if inputs.whole(name, getattr(self, name), 0) >= len(levels):
                raise inputs.rejected(name, getattr(self, name), "use turning_moment_areas")
        for name in ("rpm", "inertia", "irregularity"):
            inputs.optional_number(name, getattr(self, name))
        super().__post_init__()

    @property
    def areas(self) -> NDArray[np.float64]:
        """Work between the crossings, J: (n_areas,)."""
        return read_only(np.diff(self.levels))

    @property
    def energy(self) -> float:
        """Fluctuation of energy, J: highest less lowest level."""
        return float(self.levels[self.highest] - self.levels[self.lowest])

    @property
    def extremes_rpm(self) -> tuple[float, float] | None:
        """Lowest and highest speed, rpm, where the speed is known."""
        if self.rpm is None or self.irregularity is None:
            return None
        half = 0.5 * self.irregularity * self.rpm
        return self.rpm - half, self.rpm + half

    @property
    def table(self) -> Table:
        """Fluctuation of energy, and moment of inertia and speeds where the speed is known."""
        slowest, fastest = self.extremes_rpm or (None, None)
        figures = (
            ("fluctuation of energy", self.energy, "J"),
            ("speed midway", self.rpm, "rpm"),
            ("moment of inertia", self.inertia, "kg·m²"),
            ("irregularity", None if self.irregularity is None else 100.0 * self.irregularity, "%"),
            ("lowest speed", slowest, "rpm"),
            ("highest speed", fastest, "rpm"),
        )
        return Table._of_figures("Turning-moment diagram by its areas", figures)

    @property
    def frames(self) -> Frames:
        """``table``; ``levels``: energy at each crossing."""
        return self._frames(levels=self._level_table)

    def _level_table(self) -> Table:
        words = [""] * len(self.levels)
        words[self.highest], words[self.lowest] = "fastest", "slowest"
        areas = (None, *self.areas.tolist())
        columns = (
            Column("crossing", tuple(range(len(self.levels)))),
            Column("area before", areas, "J"),
            Column("energy", tuple(self.levels.tolist()), "J"),
            Column("", tuple(words)),
        )
        return Table("Energy where torque crosses its mean", columns)
