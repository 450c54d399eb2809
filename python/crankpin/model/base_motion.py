"""Motion of what carries mounts: a floor, a foundation, the hull of a ship, a vehicle."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Self, TypeAlias

import numpy as np

from crankpin._support import inputs, units
from crankpin._support.frames import Framed
from crankpin._support.record import Input, read_only
from crankpin._support.tables import Column, Table
from crankpin.model import table_files
from crankpin.model.loads import _amplitude
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.mounts import Vector

Motion: TypeAlias = Literal["displacement", "velocity", "acceleration"]
By: TypeAlias = Literal["frequency", "order"]

MOTIONS = {
    "displacement": ("m", "rad"),
    "velocity": ("m/s", "rad/s"),
    "acceleration": ("m/s²", "rad/s²"),
}
"""What phasors are of → their units along an axis and about it."""
DIRECTIONS = ("x", "y", "z", "about x", "about y", "about z")
STANDARD_GRAVITY = 9.80665
TYPED = {
    "m": ("displacement", 1.0),
    "cm": ("displacement", 1e-2),
    "mm": ("displacement", 1e-3),
    "µm": ("displacement", 1e-6),
    "m/s": ("velocity", 1.0),
    "mm/s": ("velocity", 1e-3),
    "m/s²": ("acceleration", 1.0),
    "mm/s²": ("acceleration", 1e-3),
    "g": ("acceleration", STANDARD_GRAVITY),
    "rad": ("displacement", 1.0),
    "mrad": ("displacement", 1e-3),
    "°": ("displacement", np.pi / 180.0),
    "rad/s": ("velocity", 1.0),
    "rad/s²": ("acceleration", 1.0),
}
"""Unit as it is typed → what it is of, and how many SI units it has."""
HINT = (
    "give a mapping, such as {10.0: (0, 1e-4, 0)}: along x, y and z, and, if it turns, about them"
)
CSV_HINT = (
    "give a header with frequency or order, and columns x, y, z, about x, about y, about z with "
    "their units, such as y [mm/s], and phase y where it is known, degrees"
)


class BaseMotion(Framed, Input):
    """Motion of a rigid base under mounts by frequency, or by order of crank speed.

    The floor under a machine or an instrument, the ground under a block, the hull under a
    generator, the vehicle under its engine. :meth:`Powertrain.response` takes it.

    Parameters
    ----------
    motion : mapping of number to sequence of complex
        Frequency, Hz, or order → peak phasors along x, y and z, in the engine's axes, and, if it
        turns, about them: three numbers or six.
    of : {"displacement", "velocity", "acceleration"}, default "displacement"
        What the phasors are of: m and rad, m/s and rad/s, or m/s² and rad/s².
    by : {"frequency", "order"}, default "frequency"
        ``"frequency"``: the base alone moves, and the engine stands. ``"order"``: multiples of
        crank speed, at which the base moves so at any speed while the engine runs.
    about : sequence of float, default (0.0, 0.0, 0.0)
        Point of the base that moves so, m; where it turns, others move otherwise.

    Raises
    ------
    InputError
        If a figure is out of range, or there is no motion.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.BaseMotion({5: (0, 0.02, 0), 10: (0, 0.05j, 0)}, of="acceleration")
    motion of the base: peak acceleration at (0, 0, 0) m
    frequency Hz  y m/s²  phase y °
               5    0.02          0
              10    0.05         90
    """

    motion: Mapping[float, Sequence[complex]]
    of: Motion
    by: By
    about: Vector

    def __init__(
        self,
        motion: Mapping[float, Sequence[complex]],
        of: Motion = "displacement",
        by: By = "frequency",
        about: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        inputs.one_of("of", of, MOTIONS)
        inputs.one_of("by", by, ("frequency", "order"))
        if not isinstance(motion, Mapping) or not motion:
            raise inputs.rejected("motion", motion, HINT)
        rows: dict[float, tuple[complex, ...]] = {}
        for number, values in motion.items():
            name = f"motion[{number}]"
            if by == "order":
                key: float = inputs.explicit_half_orders([number], "motion")[0]
            else:
                key = inputs.positive("motion", number)
            entries = inputs.items(name, values, HINT)
            if len(entries) not in (3, 6):
                raise inputs.faulty(name, f"has {len(entries)} numbers", HINT)
            phasors = tuple(_amplitude(name, value) for value in entries)
            rows[key] = phasors if len(phasors) == 6 else (*phasors, 0j, 0j, 0j)
        ascending = read_only(dict(sorted(rows.items())))
        self.__dict__.update(motion=ascending, of=of, by=by, about=_vector("about", about))

    @property
    def _numbers(self) -> NDArray[np.float64]:
        """Frequencies or orders."""
        return np.array([*self.motion], dtype=float)

    def _figures(self) -> tuple[Vector, Motion, list[tuple[float, Any]], bool]:
        """Return the motion as the core takes it: a frequency is order 1 of a speed."""
        rows = np.array([*self.motion.values()], dtype=complex)
        if self.by == "frequency":
            return self.about, self.of, [(1, rows)], False
        by_order = [(order, rows[k : k + 1].copy()) for k, order in enumerate(self.motion)]
        return self.about, self.of, by_order, True

    def _picked(self, places: int | slice) -> Self:
        """Return the motion at some of its frequencies."""
        numbers = [*self.motion]
        kept = numbers[places] if isinstance(places, slice) else [numbers[places]]
        return self.replace(motion={number: self.motion[number] for number in kept})

    @property
    def table(self) -> Table:
        """Amplitudes and phases by frequency or order."""
        rows = np.array([*self.motion.values()], dtype=complex)
        head, unit = ("frequency", "Hz") if self.by == "frequency" else ("order", "")
        columns = [Column(head, tuple(self.motion), unit)]
        along, about = MOTIONS[self.of]
        for k, name in enumerate(DIRECTIONS):
            if rows[:, k].any():
                columns.append(Column(name, np.abs(rows[:, k]), along if k < 3 else about))
                columns.append(Column(f"phase {name}", np.angle(rows[:, k], deg=True), "°"))
        point = units.Figure(self.about, "m", ".6g", "({}, {}, {})")
        title = units.Text(f"motion of the base: peak {self.of} at ", point)
        return Table(title, tuple(columns))

    @classmethod
    def from_csv(cls, path: str | Path, about: ArrayLike = (0.0, 0.0, 0.0)) -> Self:
        """Return the motion in a text file or a spreadsheet.

        A line has a frequency, Hz, or an order, and amplitudes; columns that are missing are zero.
        The unit in a head says what they are of: ``x [m/s²]``, ``y (mm/s)``, ``about z [rad]``;
        without one they are displacements, m and rad. ``phase y`` is an angle, degrees.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file.
        about : sequence of float, default (0.0, 0.0, 0.0)
            Point of the base that moves so, m.

        Returns
        -------
        BaseMotion
            The motion.

        Raises
        ------
        InputError
            If a column or a unit is unknown, or units are of several motions.
        OSError
            If the file cannot be read.
        """
        file = inputs.file_path(path, table_files.TABLE_ENDINGS, table_files.FILE_HINT, "path")
        columns = table_files.read(file, None)
        places: dict[str, int] = {}
        kinds, factors = set[str](), dict[str, float]()
        for k, head in enumerate(columns.header):
            name, unit = _head(head)
            if name in DIRECTIONS:
                kind, factors[name] = read_unit("path", unit)
                kinds.add(kind)
            elif name not in ("frequency", "order") and name[6:] not in DIRECTIONS:
                raise inputs.faulty("path", f"has a column {inputs.shorten(head)}", CSV_HINT)
            places[name] = k
        by: By = "order" if "order" in places else "frequency"
        if by not in places or not factors:
            raise inputs.faulty("path", f"has no column {by if factors else 'of motion'}", CSV_HINT)
        if len(kinds) > 1:
            several = " and ".join(sorted(kinds))
            raise inputs.faulty("path", f"has columns of {several}", "give all of one of them")
        numbers = columns.numbers
        rows = np.zeros((len(numbers), 6), dtype=complex)
        for k, name in enumerate(DIRECTIONS):
            if name in factors:
                phase = places.get(f"phase {name}")
                angle = 0.0 if phase is None else np.radians(numbers[:, phase])
                rows[:, k] = factors[name] * numbers[:, places[name]] * np.exp(1j * angle)
        listed = dict(zip(numbers[:, places[by]].tolist(), rows.tolist(), strict=True))
        of: Any = kinds.pop()
        return cls(listed, of, by, about)


def _head(head: str) -> tuple[str, str]:
    """Return the name of a column and its unit."""
    bare = re.sub(r"\s+", " ", head.strip().strip('"'))
    parts = re.fullmatch(r"(.*?)\s*[\[(](.*)[\])]", bare)
    name, unit = (parts[1], parts[2]) if parts else (bare, "")
    if not parts and (last := bare.rpartition(" "))[2] in (*TYPED, "Hz", "deg") and last[0]:
        name, unit = last[0], last[2]
    return name.casefold(), unit.strip()


def read_unit(name: str, unit: str) -> tuple[Motion, float]:
    """Return what a unit is of, and how many SI units it has."""
    plain = unit.replace("^2", "²").replace("s2", "s²").replace("um", "µm").replace("μ", "µ")
    found: Any = TYPED.get({"": "m", "deg": "°"}.get(plain, plain))
    if found is None:
        raise inputs.rejected(name, unit, f"give a unit of {', '.join(TYPED)}")
    return found  # type: ignore[no-any-return]
