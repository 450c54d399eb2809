"""Tables of forces as makers print them: what shakes a foundation, with or without an engine."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeAlias

import numpy as np

from crankpin import _core
from crankpin._support import files, inputs, labels, units
from crankpin._support.frames import Framed
from crankpin._support.record import Input, read_only
from crankpin._support.tables import Column, Table
from crankpin.model import unv
from crankpin.model.loads import _amplitude, of_rows
from crankpin.model.mounts import _vector

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import ArrayLike

    from crankpin._support.inputs import Order
    from crankpin.model.mounts import Vector

Amplitudes: TypeAlias = "Mapping[Order, Sequence[complex]]"
"""Order → peak phasors of forces, moments and the X-type bimoment."""
SCALINGS = ("speed squared", "independent")
"""What amplitudes do as the speed changes, in words of a file."""


class Component(NamedTuple):
    """An amplitude of an order, by its name in makers' tables."""

    name: str
    """Name, with the order in place of ``{}``."""
    place: int
    """Its place among F_x, F_y, F_z, M_x, M_y, M_z and the X-type bimoment."""
    sign: float
    """Its sign over that of this library."""
    unit: str
    """Unit in tables, of which there are a thousand SI units."""


COMPONENTS = (
    Component("F{}V", 1, 1.0, "kN"),
    Component("F{}H", 0, 1.0, "kN"),
    Component("F{}A", 2, 1.0, "kN"),
    Component("M{}V", 3, -1.0, "kN·m"),
    Component("M{}H", 4, 1.0, "kN·m"),
    Component("H{}", 5, 1.0, "kN·m"),
    Component("X{}", 6, 1.0, "kN·m²"),
)
AXES = ("F_x", "F_y", "F_z", "M_x", "M_y", "M_z")
"""Names of components by this library's axes, which files may have too."""
THOUSAND = 1e3
MAKERS_NAME = re.compile(r"([FM])\s*_?(\d+(?:\.5)?)\s*_?([VHA])|([HX])(?:-type)?\s*_?(\d+(?:\.5)?)")
NO_ORDER = re.compile(r"F_x|F_y|F_z|M_x|M_y|M_z|[HX](?:-type)?")
CSV_HINT = (
    "give a header with name and amplitude, and columns unit, phase, order, over speed and rpm "
    "where they are known; a line is such as M1V,1200,kN·m,90"
)
COLUMNS = {
    "name": ("name", "component", "moment", "force", "quantity"),
    "amplitude": ("amplitude", "value", "peak", "magnitude"),
    "unit": ("unit", "units"),
    "phase": ("phase", "angle"),
    "order": ("order",),
    "over speed": ("over speed", "scaling"),
    "rpm": ("rpm", "speed"),
    "about": ("about",),
}
"""Column of a file → heads that it may have, without their units."""


class ForceTable(Framed, Input):
    """Forces and moments of a machine by order at a speed, as its maker prints them.

    A :class:`Powertrain` takes it in place of an engine, or besides one: response, severity and
    cancellation follow. Amplitudes are peak phasors by order, multiples of the speed of the crank:
    at the crank angle θ an order n of amplitude A is Re(A·exp(i·n·θ)), as on the engine's block.

    Parameters
    ----------
    rpm : float
        Crank speed at which the amplitudes are those given, rpm.
    speed_squared : mapping of number to sequence of complex, optional
        Order → amplitudes that grow with the square of the speed, those of inertia: F_x, F_y, F_z,
        N, M_x, M_y, M_z, N·m, and, if it has one, the X-type bimoment, N·m², which twists a frame
        and moves no rigid body.
    independent : mapping of number to sequence of complex, optional
        Order → amplitudes that stay as the speed changes, those of gas pressure.
    about : sequence of float, default (0.0, 0.0, 0.0)
        Point about which moments are, m.
    name : str, default ""
        Name of the machine.

    Raises
    ------
    InputError
        If a figure is out of range, or there is no amplitude.

    Examples
    --------
    >>> import crankpin as cp
    >>> table = cp.ForceTable(rpm=105, speed_squared={1: (0, 0, 0, -1.2e6, 8e5j, 0)}, name="S")
    >>> table
    S at 105 rpm: forces and moments about (0, 0, 0) m
    name  order  amplitude  unit  phase °  over speed     rpm
    M1V       1       1200  kN·m        0  speed squared  105
    M1H       1        800  kN·m       90  speed squared  105
    Order n is amplitude·cos(n·θ + phase), θ the crank angle.
    """

    rpm: float
    speed_squared: Mapping[Order, Sequence[complex]]
    independent: Mapping[Order, Sequence[complex]]
    about: Vector
    name: str

    def __init__(
        self,
        rpm: float,
        speed_squared: Amplitudes | None = None,
        independent: Amplitudes | None = None,
        about: ArrayLike = (0.0, 0.0, 0.0),
        name: str = "",
    ) -> None:
        fields: dict[str, Any] = {
            "rpm": inputs.positive("rpm", rpm),
            "speed_squared": _rows("speed_squared", speed_squared),
            "independent": _rows("independent", independent),
            "about": _vector("about", about),
            "name": inputs.text("name", name),
        }
        self.__dict__.update(fields)
        _core.check_forces(f"[{self._text()}]")

    def _text(self) -> str:
        """Return the table as the core reads it."""
        rows = {
            name: [
                [order, *(part for value in values for part in (value.real, value.imag))]
                for order, values in getattr(self, name).items()
            ]
            for name in ("speed_squared", "independent")
        }
        return json.dumps({"name": self.name, "rpm": self.rpm, "about": self.about, **rows})

    @classmethod
    def _of(cls, fields: Mapping[str, Any]) -> Self:
        """Return a table of the core."""
        rows = {
            name: of_rows(fields.get(name, ()), table=True)
            for name in ("speed_squared", "independent")
        }
        about = fields.get("about", (0.0, 0.0, 0.0))
        return cls(fields["rpm"], about=about, name=fields.get("name", ""), **rows)

    @property
    def title(self) -> str:
        """Name, or its substitute."""
        return self.name or "table of forces"

    @property
    def orders(self) -> tuple[Order, ...]:
        """Multiples of crank speed."""
        return tuple(sorted({*self.speed_squared, *self.independent}))

    @property
    def loads_counted(self) -> str:
        """What results of it count, in words."""
        return f"forces of {labels.name_of(self)}"

    def _listed(self) -> Iterator[tuple[str, Order, complex, str, str]]:
        """Yield name, order, amplitude, its unit and its change with speed of what is not zero."""
        for order in self.orders:
            for component in COMPONENTS:
                for scaling in SCALINGS:
                    values = getattr(self, scaling.replace(" ", "_")).get(order)
                    value = values[component.place] if values else 0.0
                    if value:
                        name = component.name.format(f"{order:g}")
                        amplitude = component.sign * value / THOUSAND
                        yield name, order, amplitude, component.unit, scaling

    @property
    def table(self) -> Table:
        """Amplitudes and phases by their names in makers' tables, in kN, kN·m and kN·m²."""
        names, orders, values, row_units, scalings = (
            zip(*listed, strict=True) if (listed := [*self._listed()]) else ((), (), (), (), ())
        )
        columns = [
            Column("name", names),
            Column("order", orders),
            Column("amplitude", tuple(map(abs, values)), digits=6),
            Column("unit", row_units),
            Column("phase", tuple(np.angle(values, deg=True).tolist()), "°", digits=6),
            Column("over speed", scalings),
            Column("rpm", (self.rpm,) * len(names), digits=10),
        ]
        if any(self.about):
            point = " ".join(f"{along:.12g}" for along in self.about)
            columns.append(Column("about", (point,) * len(names)))
        about = units.Figure(self.about, "m", ".6g", "({}, {}, {})")
        title = units.Text(
            f"{labels.name_of(self)} at {self.rpm:.10g} rpm: forces and moments about ", about
        )
        note = "Order n is amplitude·cos(n·θ + phase), θ the crank angle."
        return Table(title, tuple(columns), note, row_units=tuple(row_units))

    @classmethod
    def from_csv(
        cls,
        path: str | Path,
        rpm: float | None = None,
        *,
        lag: bool = False,
        about: ArrayLike | None = None,
        name: str = "",
    ) -> Self:
        """Return the table in a text file, as :meth:`to_csv` writes it or as makers have it.

        A line has the name of an amplitude: F1V, F1H, M1V, M1H, M2V, H6 or X3, with the order in
        it, or F_x, F_y, F_z, M_x, M_y, M_z, H or X with the order in its column. V is vertical,
        up; H horizontal, to the right seen from the flywheel; M1V and M1H are the couples of the
        forces so directed, Σ (z − z₀)·F. Where no column says it, forces and couples grow with the
        square of the speed, H and X types stay.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file.
        rpm : float, optional
            Crank speed of the table, rpm; by default that of its column.
        lag : bool, default False
            True for phases that are lags: amplitude·cos(n·θ − phase).
        about : sequence of float, optional
            Point about which moments are, m; by default that of its column, or (0, 0, 0).
        name : str, default ""
            Name of the machine.

        Returns
        -------
        ForceTable
            The table.

        Raises
        ------
        InputError
            If a line cannot be read, the name or the unit of an amplitude is unknown, or the speed
            is left out.
        OSError
            If the file cannot be read.
        """
        file = inputs.file_path(path, (".csv", ".txt", ".tsv"), "give a text file, .csv", "path")
        return cls._of_lines(file.read_text(encoding="utf-8-sig"), rpm, lag, about, name)

    @classmethod
    def _of_lines(
        cls, text: str, rpm: float | None, lag: bool, about: ArrayLike | None, name: str
    ) -> Self:
        """Return the table of lines of text."""
        lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
        separator = max(";\t,", key=lines[0].count) if lines else ","
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
        if len(rows) < 2:
            raise inputs.faulty("path", "has no lines under a header", CSV_HINT)
        heads = [re.sub(r"\s*[\[(].*|\s+(?:kN\S*|N\S*|MN\S*|°|deg)$", "", h) for h in rows[0]]
        places = {
            column: k
            for column, known in COLUMNS.items()
            for k, head in enumerate(heads)
            if head.casefold() in known
        }
        for column in ("name", "amplitude"):
            if column not in places:
                raise inputs.faulty("path", f"has no column {column}", CSV_HINT)
        head = rows[0][places["amplitude"]]
        in_head = re.sub(r"^\w+\s*[\[(]?|[\])]$", "", head).strip()
        amplitudes: dict[str, dict[Any, list[complex]]] = {scaling: {} for scaling in SCALINGS}
        speeds, points = set[float](), set[str]()
        for number, row in enumerate(rows[1:], start=2):
            cells = {
                column: row[k] for column, k in places.items() if k < len(row) and row[k] != ""
            }
            try:
                order, place, sign, scaling = _meant(cells)
                unit = cells.get("unit", in_head)
                size = _number(cells.get("amplitude", "")) * _in_si(unit, place)
                phase = _number(cells.get("phase", "0"))
                if "rpm" in cells:
                    speeds.add(_number(cells["rpm"]))
                if "about" in cells:
                    points.add(cells["about"])
            except ValueError as error:
                raise inputs.faulty("path", f"has {error} in line {number}", CSV_HINT) from None
            values = amplitudes[scaling].setdefault(order, [0.0] * 7)
            turned = np.exp(1j * np.radians(-phase if lag else phase))
            values[place] += sign * size * complex(turned)
        if rpm is None:
            if len(speeds) != 1:
                fault = f"has {len(speeds)} speeds" if speeds else "has no speed"
                raise inputs.faulty("path", fault, "give the crank speed of the table, `rpm`")
            (rpm,) = speeds
        if about is None:
            if len(points) > 1:
                raise inputs.faulty("path", "has moments about several points", CSV_HINT)
            texts = points.pop().split() if points else ["0", "0", "0"]
            try:
                about = [_number(text) for text in texts]
            except ValueError as error:
                raise inputs.faulty("path", f"has {error} in column about", CSV_HINT) from None
        return cls(rpm, amplitudes["speed squared"], amplitudes["independent"], about, name)

    def to_unv(self, path: str | Path) -> None:
        """Write the table to a universal file, a dataset 58 of each force and moment.

        A dataset is a function of order, complex and double, at node 1 along or about x, y or z, N
        and N·m, with the crank speed as its third coordinate; its second line of text says how it
        changes with speed, the fourth about which point moments are. The X-type bimoment, which is
        none of the six, is left out.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.unv`` or ``.uff``.

        Raises
        ------
        InputError
            If the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        file = inputs.file_path(path, unv.ENDINGS, "a universal file ends in .unv or .uff", "path")
        about = " ".join(f"{along:.12g}" for along in self.about)
        texts = list[str]()
        for scaling in SCALINGS:
            rows = getattr(self, scaling.replace(" ", "_"))
            for place, axis in enumerate(AXES):
                own = [(order, values[place]) for order, values in rows.items() if values[place]]
                if not own:
                    continue
                orders, values = zip(*own, strict=True)
                names = (f"{axis} of {self.title}", scaling, f"about {about} m")
                function = unv.Function(names, place + 1, self.rpm, True, orders, values)
                texts.append(unv.text_of(function))
        files.write(file, "".join(texts))

    @classmethod
    def from_unv(
        cls,
        path: str | Path,
        rpm: float | None = None,
        *,
        about: ArrayLike | None = None,
        name: str = "",
    ) -> Self:
        """Return the table in a universal file, as :meth:`to_unv` writes it or as makers send it.

        Datasets 58 are read whose functions are complex and of order or frequency, of one node.
        Where the second line of text does not say it, forces and moments about x and y grow with
        the square of the speed, those about z stay.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file.
        rpm : float, optional
            Crank speed of the table, rpm; by default that of the file.
        about : sequence of float, optional
            Point about which moments are, m; by default that of the file, or (0, 0, 0).
        name : str, default ""
            Name of the machine.

        Returns
        -------
        ForceTable
            The table.

        Raises
        ------
        InputError
            If a dataset cannot be read, a frequency is no multiple of half the crank speed, or the
            speed is left out.
        OSError
            If the file cannot be read.
        """
        file = inputs.file_path(path, unv.ENDINGS, "a universal file ends in .unv or .uff", "path")
        functions = list(unv.functions(file.read_text(encoding="latin-1")))
        if not functions:
            raise inputs.faulty("path", "has no dataset 58", unv.HINT)
        speed = _only("speeds", {f.rpm for f in functions if f.rpm}) if rpm is None else rpm
        amplitudes: dict[str, dict[Any, list[complex]]] = {scaling: {} for scaling in SCALINGS}
        points = set[str]()
        for function in functions:
            _, scaling, point = function.names
            place = abs(function.direction) - 1
            if scaling not in SCALINGS:
                scaling = SCALINGS[place == 5]
            if match := re.fullmatch(r"about (.*) m", point):
                points.add(match[1])
            for at, value in zip(function.abscissa, function.values, strict=True):
                if value:
                    order = at if function.by_order else at * 60.0 / inputs.positive("rpm", speed)
                    values = amplitudes[scaling].setdefault(_order(order), [0.0] * 7)
                    values[place] += value if function.direction > 0 else -value
        if about is None:
            about = [_number(along) for along in _only("points", points or {"0 0 0"}).split()]
        return cls(speed, amplitudes[SCALINGS[0]], amplitudes[SCALINGS[1]], about, name)


def _only(what: str, values: set[Any]) -> Any:  # noqa: ANN401 - of any type
    """Return the one value of a file, or raise an error."""
    if len(values) != 1:
        raise inputs.faulty("path", f"has {len(values)} {what}", f"give one, {what[:-1]}: `rpm`")
    return next(iter(values))


def _order(number: float) -> Order:
    """Return a multiple of crank speed of a file, to a few digits."""
    halves = round(2.0 * number)
    if abs(2.0 * number - halves) > 1e-3 * max(1.0, abs(number)):
        hint = "orders are multiples of half the crank speed: is `rpm` that of the file?"
        raise inputs.faulty("path", f"has the order {number:.6g}", hint)
    (order,) = inputs.explicit_half_orders([0.5 * halves], "path")
    return order


def _meant(cells: Mapping[str, str]) -> tuple[Any, int, float, str]:
    """Return order, place, sign and scaling of an amplitude, by its name."""
    name = cells.get("name", "")
    typed: Any = cells.get("order")
    if match := MAKERS_NAME.fullmatch(name):
        kind, inside, way, type_of, of_type = match.groups()
        pattern = f"{type_of}{{}}" if type_of else f"{kind}{{}}{way}"
        typed = of_type or inside
    elif NO_ORDER.fullmatch(name) and typed is not None:
        pattern = f"{name[0]}{{}}" if name[0] in "HX" else name
    else:
        raise ValueError(f"the unknown name {name!r}" if typed else f"no order of {name!r}")
    try:
        (order,) = inputs.explicit_half_orders([float(typed)])
    except (ValueError, _core.InputError):
        raise ValueError(f"the order {typed!r}") from None
    known = {component.name: component for component in COMPONENTS}
    if pattern in AXES:
        place, sign = AXES.index(pattern), 1.0
    else:
        place, sign = known[pattern].place, known[pattern].sign
    scaling = cells.get("over speed", SCALINGS[place >= 5])
    if scaling not in SCALINGS:
        raise ValueError(f"the word {scaling!r} in place of {' or '.join(SCALINGS)}")
    return order, place, sign, scaling


def _number(text: str) -> float:
    """Return a number, of a cell with a decimal point or comma."""
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        raise ValueError(f"no number but {text!r}") from None
    if not np.isfinite(number):
        raise ValueError(f"no finite number but {text!r}")
    return number


def _in_si(unit: str, place: int) -> float:
    """Return what an amplitude of a unit is multiplied by."""
    dimension = (0, (0, 1, 2)[(place >= 3) + (place >= 6)], 1, 0)
    spelled = re.sub(r"^([kM]?N)(m.*)$", r"\1·\2", unit.replace("*", "·").replace("^", ""))
    factor = units.exact(spelled.replace("m2", "m²"), dimension) if unit else None
    if factor is None:
        wanted = ("kN", "kN·m", "kN·m²")[(place >= 3) + (place >= 6)]
        raise ValueError(f"the unit {unit!r} in place of {wanted}")
    return float(factor)


def _rows(name: str, mapping: object) -> Mapping[Order, Sequence[complex]]:
    """Return amplitudes by order, checked."""
    hint = "give a mapping: order → F_x, F_y, F_z, M_x, M_y, M_z, such as {1: (0, 2e3, 0, 0, 0, 0)}"
    if mapping is None:
        return read_only({})
    if not isinstance(mapping, Mapping):
        raise inputs.rejected(name, mapping, hint)
    rows: dict[Order, tuple[complex, ...]] = {}
    for order, values in mapping.items():
        key = inputs.explicit_half_orders([order], name)[0]
        if key in rows:
            raise inputs.rejected(name, order, "is given twice; give each order once")
        entries = inputs.items(f"{name}[{key}]", values, hint)
        if len(entries) not in (6, 7):
            raise inputs.faulty(f"{name}[{key}]", f"has {len(entries)} numbers", hint)
        numbers = tuple(_amplitude(f"{name}[{key}]", value) for value in entries)
        rows[key] = numbers if len(numbers) == 7 else (*numbers, 0j)
    return read_only(dict(sorted(rows.items())))
