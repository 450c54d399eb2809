"""Arguments of commands: what was typed, read as values in the units of the library."""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Callable
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels, units
from crankpin._support.parameters import parameter
from crankpin.cli.options import OPTIONS, rejected
from crankpin.model import checks, engine_files, presets
from crankpin.model.engine import Engine
from crankpin.model.loads import PeriodicLoad, of_rows
from crankpin.model.vehicle_axes import VehicleAxes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.balance import Balance
    from crankpin.cli.options import Option

MOST_ROWS = 1_000_000
"""Largest number of rows in a table."""
PICTURE_ENDINGS = (".pdf", ".png", ".svg")

# --- units --------------------------------------------------------------------------------------

TYPED_UNITS: dict[str, units.Dimension] = {
    "kg": (1, 0, 0, 0),
    "m": (0, 1, 0, 0),
    "kg·m": (1, 1, 0, 0),
    "N": (0, 0, 1, 0),
    "N·m": (0, 1, 1, 0),
    "kg·m²": (1, 2, 0, 0),
    "Pa": (0, 0, 0, 1),
}
"""Unit that the library takes → what may be typed behind a number: any unit of that dimension."""


LOAD_FIELDS = {
    "on": ("on", ""),
    "force": ("force", "N"),
    "torque": ("torque", "N·m"),
    "rpm": ("rpm", "rpm"),
    "direction": ("direction_deg", ""),
    "turning": ("turning", ""),
    "phase": ("phase_deg", ""),
    "z": ("z", "m"),
    "crank": ("crank", "count"),
    "ratio": ("ratio", ""),
    "x": ("x", "m"),
    "y": ("y", "m"),
    "cylinder": ("cylinder", "count"),
}
"""Field of ``--add-load`` → argument of :class:`PeriodicLoad` and its unit; empty of a word."""


class Given:
    """Arguments of a command, read as values in the library's units.

    Options are named as they are typed, ``"--reference-z"``; one that is left out reads as None.
    """

    def __init__(self, arguments: argparse.Namespace, typed: Sequence[str] = ()) -> None:
        self.typed = tuple(typed)
        """The words of the command line."""
        self.options: Sequence[Option] = vars(arguments).get("options", ())
        """Options of the command."""
        self._typed = vars(arguments)
        for name, text in self._typed.items():
            if isinstance(text, str) and "\0" in text:
                raise rejected(name, labels.one_line(text), "has a NUL byte")
        if self._typed.get("rpm") == OPTIONS["--rpm"]["default"] and not self._has("--rpm"):
            (first, *_) = self._typed.get("names") or [self._typed.get("name") or ""]
            (preset, *_) = presets.family(first)
            if preset in presets.Presets():
                usual = presets.usual_speed(preset, float(self._typed["rpm"]))
                self._typed["rpm"] = f"{usual:g}"
        self.said = list[str]()
        """Notices of values that were read differently from their spelling."""
        self._setting = units.read(self._typed.get("units") or "", "--units")
        self.written: units.Setting = {}
        """Units that numbers were typed with, the first of each kind."""

    def _has(self, flag: str) -> bool:
        """Return whether an option is typed, in full or shortened."""
        words = (word.partition("=")[0] for word in self.typed)
        return any(len(word) > 2 and flag.startswith(word) for word in words)

    def text(self, flag: str) -> Any:  # noqa: ANN401 - text or None, True or False of a flag
        """Return what was typed."""
        return self._typed[flag.removeprefix("--").replace("-", "_")]

    def names(self, flag: str) -> list[str] | None:
        """Return names separated by commas, if they are given."""
        text: str | None = self.text(flag)
        return None if text is None else [name.strip() for name in text.split(",")]

    def one(self, flag: str, text: str, unit: str = "", what: str = "a number") -> float:
        """Return a number, typed with a unit or without, in the library's unit."""
        return self._read(flag, text, unit, "number", what)[0][0]

    def _read(
        self, flag: str, text: str, unit: str, form: str, what: str, *, infinite: bool = False
    ) -> tuple[list[float], bool]:
        """Return numbers in the library's unit, finite ones unless ``inf`` is allowed.

        And whether it is a list. A decimal comma that is read as a point is said.
        """
        # Plain moments of inertia stay in kg·m²: no flywheel is weighed in g·mm².
        has_setting = unit in TYPED_UNITS and unit != "kg·m²"
        plain = units.convert(unit, self._setting).unit if has_setting else ""
        values, word, is_listed, point = _core.read_numbers(
            flag, text, unit, form=form, plain=plain, what=what, infinite=infinite
        )
        if point is not None:
            self.said.append(f"{flag} {text.strip()} is read as {point}")
        if word and unit in TYPED_UNITS and (name := units.symbol(word)) is not None:
            self.written.setdefault(TYPED_UNITS[unit], name)
        return values, is_listed

    def echo(self, flag: str, unit: str) -> str:
        """Return what was typed, with the unit that a plain number has."""
        text: str = self.text(flag)
        has_unit = re.search(r"[^\d\s.,=:eE+/-]", text)
        return text if has_unit else f"{text} {units.convert(unit, self._setting).unit}"

    def number(self, flag: str, unit: str = "") -> float:
        """Return the number of an option that has one."""
        return self.one(flag, self.text(flag), unit)

    def optional(self, flag: str, unit: str = "") -> float | None:
        """Return the number of an option, if it is given."""
        return None if self.text(flag) is None else self.number(flag, unit)

    def numbers(self, flag: str, unit: str = "", *, infinite: bool = False) -> list[float] | None:
        """Return a list of numbers, if it is given."""
        text = self.text(flag)
        return None if text is None else self.listed(flag, text, unit, infinite=infinite)

    def listed(
        self,
        flag: str,
        text: str,
        unit: str = "",
        what: str = "a number",
        *,
        infinite: bool = False,
    ) -> list[float]:
        """Return the numbers of a text, separated by commas."""
        return self._read(flag, text, unit, "list", what, infinite=infinite)[0]

    def one_or_several(self, flag: str, unit: str = "") -> float | list[float]:
        """Return a number, which counts for all, or a list."""
        numbers = self.listed(flag, self.text(flag), unit)
        return numbers if len(numbers) > 1 else numbers[0]

    def whole(self, flag: str) -> int:
        """Return a whole number."""
        text = self.text(flag)
        number = self.one(flag, text, "count", "a whole number")
        if number != int(number):
            raise rejected(flag, text, "give a whole number")
        return int(number)

    def whole_numbers(self, flag: str, hint: str = "give whole numbers, such as 1,2") -> list[int]:
        """Return a list of whole numbers."""
        text = self.text(flag)
        try:
            return [int(part) for part in text.split(",")]
        except ValueError:
            raise rejected(flag, text, hint) from None

    def range(self, flag: str, unit: str = "") -> float | NDArray[np.float64] | None:
        """Return a number, a list of numbers, or START:STOP:STEP with the stop included."""
        text = self.text(flag)
        if text is None:
            return None
        what = "one number, a list a,b,c or a range START:STOP:STEP"
        numbers, is_listed = self._read(flag, text, unit, "range", what)
        return np.array(numbers) if is_listed else numbers[0]

    def engines(self, names: Sequence[str] | None = None) -> dict[str, Engine]:
        """Return the engines of NAME…, by their titles, or by what was typed where these repeat."""
        typed: dict[str, Engine] = {}
        for name in names or self._typed.get("names") or [self.text("name")]:
            if Path(name).suffix.lower() in engine_files.ENGINE_ENDINGS:
                typed[name] = Engine.load(name)
                continue
            for member in presets.family(name):
                if member not in presets.Presets():
                    raise presets.unknown("NAME", name, typed=True)
                typed[member] = Engine.preset(member)
        if (plane := self._typed.get("reference_z")) is not None:
            z = self.one("--reference-z", plane, "m")
            typed = {name: engine.replace(reference_z=z) for name, engine in typed.items()}
        typed = {name: self.with_loads(engine) for name, engine in typed.items()}
        titles = [engine.title if engine.name else "" for engine in typed.values()]
        return {
            title if title and titles.count(title) == 1 else name: engine
            for title, (name, engine) in zip(titles, typed.items(), strict=True)
        }

    def with_loads(self, engine: Engine) -> Engine:
        """Return an engine with the loads of ``--add-load`` besides its own."""
        typed = self._typed.get("add_load") or []
        return engine.with_loads([*engine.loads, *map(self._load, typed)]) if typed else engine

    def _load(self, text: str) -> PeriodicLoad:
        """Return a load as it is typed: its name, then fields."""
        flag = "--add-load"
        name, _, rest = text.partition(":")
        fields = dict[str, Any]()
        for part in re.split(r"\s+(?=\w+=)", rest.strip()):
            key, _, value = (side.strip() for side in part.partition("="))
            if key not in LOAD_FIELDS or not value:
                hint = f'give "NAME: on=shaft force=2:8 z=-0.1", of {", ".join(LOAD_FIELDS)}'
                raise rejected(flag, text, hint)
            argument, unit = LOAD_FIELDS[key]
            if key in ("force", "torque"):
                plain = units.convert(unit, self._setting).unit
                rows = _core.read_amplitudes(flag, value, unit, plain)
                fields[argument] = of_rows(rows, table=any(len(row) > 3 for row in rows))
            elif unit:
                numbers = [self.one(flag, part, unit) for part in value.split("/")]
                fields[argument] = numbers if len(numbers) > 1 else numbers[0]
            else:
                fields[argument] = {"yes": True, "no": False}.get(value, value)
        if "on" not in fields:
            raise rejected(flag, text, "say what it acts on: on=shaft, on=block or on=both")
        if isinstance(fields.get("rpm"), float):
            fields["scaling"] = "speed squared"
        fields |= {key: int(fields[key]) for key in ("crank", "cylinder") if key in fields}
        try:
            return PeriodicLoad(name.strip(), **fields)
        except InputError as error:
            raise rejected(flag, text, str(error)) from None

    def about(self, balance: Balance) -> Balance:
        """Return a balance about the point of ``--about``, if it is given."""
        point = self.numbers("--about", "m")
        if point is None:
            return balance
        if len(point) not in (1, 3):
            raise rejected("--about", self.text("--about"), "give X,Y,Z or Z, m")
        return balance.about(point if len(point) == 3 else point[0])

    def vehicle(self) -> VehicleAxes | None:
        """Return the axes of ``--axes``, if they are given."""
        text = self.text("--axes")
        if text is None:
            return None
        directions, *fields = (part.strip() for part in text.split(":"))
        arguments: dict[str, Any] = {}
        for field in fields:
            key, _, value = (side.strip() for side in field.partition("="))
            if key == "flywheel":
                arguments[key] = value
            elif key == "origin":
                arguments[key] = self.listed("--axes", value, "m")
            elif key == "incline":
                arguments["incline_deg"] = self.one("--axes", value)
            else:
                raise rejected("--axes", text, "give X,Y,Z, and of flywheel, origin, incline")
        return VehicleAxes(directions, **arguments)

    def engine(self, command: str) -> Engine:
        """Return the engine of a command that takes one."""
        engines = self.engines()
        if len(engines) > 1:
            name = self.text("name")
            members = ", ".join(presets.family(name))
            raise rejected("NAME", name, f"{command} takes one engine of {members}")
        return next(iter(engines.values()))

    def quantity(self, engines: Iterable[Engine]) -> str:
        """Return ``--quantity``; by default moment, or force if no cylinder has a lever."""
        typed: str | None = self.text("--quantity")
        return typed or ("moment" if any(np.ptp(engine.z) for engine in engines) else "force")

    def orders(self) -> Orders:
        """Return the orders of ``--orders``, or "auto"."""
        if self.text("--orders") == "auto":
            return "auto"
        try:
            return [inputs.order(Decimal(part)) for part in self.text("--orders").split(",")]
        except (InvalidOperation, ValueError, OverflowError):
            hint = "give multiples of crank speed, such as 1,2,4 or 0.5,1,1.5, or auto"
            raise rejected("--orders", self.text("--orders"), hint) from None

    def chosen(self) -> dict[str, Any]:
        """Return orders, or "auto", and the tolerance by which they are chosen, if it is given."""
        orders = self.orders()
        if self.text("--rtol") is None:
            return {"orders": orders}
        if orders != "auto":
            raise rejected("--rtol", self.text("--rtol"), "needs --orders auto")
        return {"orders": orders, "rtol": self.number("--rtol")}

    def spectrum(self) -> Spectrum | None:
        """Return the spectrum of ``--spectrum``, order → amplitude in kg·m, if it is given."""
        if (text := self.text("--spectrum")) is None:
            return None
        amplitudes = dict[int, float]()
        for part in text.split(","):
            typed, _, amplitude = part.partition("=")
            order = int(typed) if typed.strip().isdecimal() and len(typed) < 10 else 0
            if not amplitude or order < 1:
                hint = "give order=amplitude, such as 1=9.0,2=3.75"
                raise rejected("--spectrum", text, hint)
            if order in amplitudes:
                raise rejected("--spectrum", text, f"order {order} is given twice")
            amplitudes[order] = self.one("--spectrum", amplitude, "kg·m")
        return amplitudes

    def keywords(self, function: Callable[..., Any]) -> dict[str, Any]:
        """Return the arguments of a function that were typed, read as it declares them."""
        plain = inspect.unwrap(function)
        return {
            option.argument: self.value(option)
            for option in self.options
            if option.function is plain and self._typed[option.dest] not in (None, False)
        }

    def value(self, option: Option) -> Any:  # noqa: ANN401 - of any type
        """Return the value of an option in the type that its function declares."""
        if option.read is not None:
            return option.read(self, option.label)
        text, declared = self._typed[option.dest], parameter(option.function, option.argument)
        if declared.type == "bool":  # of another name it sets the argument to False
            return option.dest == option.argument
        if text in declared.words:
            return text
        read = next(read for words, read in READERS if re.search(words, declared.type))
        return read(self, option.label, {"degrees": "°"}.get(declared.unit, declared.unit))

    def angle(self, flag: str, unit: str = "°") -> str:
        """Return an angle as text, which may be a fraction."""
        text = self.text(flag)
        if "," in text:  # of a decimal, or one too many
            text = repr(self.one(flag, text, unit))
        return self.angles(flag, text=text)[0]

    def angles(self, flag: str, _: str = "°", *, text: str | None = None) -> list[str]:
        """Return angles as text, which may be fractions."""
        text = self.text(flag) if text is None else text
        typed = [part.strip().removesuffix("deg").rstrip("°") for part in text.split(",")]
        angles = [inputs.angle(flag, text) for text in typed]
        decimals = [float(text) for text in typed if "." in text and "/" not in text]
        checks.radians(flag, text, decimals)
        return angles

    def frame(self) -> str | None:
        """Return the table to print, if one is named."""
        return self._typed.get("frame")

    def picture_file(self) -> Path | None:
        """Return the file of the picture, checked before anything is computed for it."""
        if (text := self._typed.get("plot")) is None:
            return None
        path = Path(text)
        if path.suffix.lower() not in PICTURE_ENDINGS:
            hint = f"a picture's name ends in {', '.join(PICTURE_ENDINGS)}"
            raise rejected("--plot", text, hint)
        return path

    def save_file(self) -> Path | None:
        """Return the file for the engine that is found, checked before anything is computed."""
        return self.engine_file("--save") if "save" in self._typed else None

    def engine_file(self, flag: str) -> Path | None:
        """Return the engine file to write, if it is given; without ``--force`` no old one."""
        if (text := self.text(flag)) is None:
            return None
        file = engine_files.checked(text, flag)
        if file.is_file() and not self.text("--force"):
            hint = "it is there already; give another name, or --force to replace it"
            raise rejected(flag, str(file), hint)
        return file


READERS: tuple[tuple[str, Callable[[Given, str, str], Any]], ...] = (
    (r"^sequence of number or str", Given.angles),
    (r"^number(,| or) str", Given.angle),
    (r"^(str|path)", lambda call, flag, _: call.text(flag)),
    (r"sequence of int|iterable of int", lambda call, flag, _: call.whole_numbers(flag)),
    (r"^(int|\{-?\d)", lambda call, flag, _: call.whole(flag)),
    (r"^array_like$", lambda call, flag, unit: call.one_or_several(flag, unit)),
    (r"^(array_like|pair of float|sequence of float)", Given.numbers),
    (r"", Given.number),
)
"""Pattern of a type in words → what reads a value of it."""
