"""From what was typed to values: engines, numbers, ranges, orders, files."""

from __future__ import annotations

import math
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels
from crankpin.model import presets
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum

MOST_ROWS = 1_000_000
"""Largest number of rows in a table."""
PICTURES = (".pdf", ".png", ".svg")


def engines(names: Sequence[str]) -> dict[str, Engine]:
    """Return engines by their names, or by what was typed where names do not tell them apart."""
    typed: dict[str, Engine] = {}
    for name in names:
        if Path(name).suffix.lower() in (".toml", ".json"):
            typed[name] = Engine.load(name)
        else:
            typed |= {member: Engine.preset(member) for member in presets.family(name)}
    titles = [engine.name for engine in typed.values()]
    return {
        title if title and titles.count(title) == 1 else name: engine
        for title, (name, engine) in zip(titles, typed.items(), strict=True)
    }


def engine(name: str, command: str) -> Engine:
    """Return the engine of a command that takes one."""
    found = engines([name])
    if len(found) > 1:
        members = ", ".join(presets.family(name))
        raise InputError(f"NAME = {name}: {command} takes one engine of {members}")
    return next(iter(found.values()))


def about_plane(engine: Engine, arguments: argparse.Namespace) -> Engine:
    """Return the engine with the reference plane that was typed, if any."""
    plane = optional_number("--reference-z", arguments.reference_z)
    return engine if plane is None else engine.replace(reference_z=plane)


def _decimal(name: str, text: str, what: str = "a number") -> Decimal:
    try:
        number = Decimal(text.strip())
    except InvalidOperation:
        raise InputError(f"{name} = {labels.cut(text)}: give {what}") from None
    # Decimals go far beyond floats; with these the arithmetic below could not overflow.
    if not number.is_finite() or not math.isfinite(float(number)):
        raise InputError(f"{name} = {labels.cut(text)}: give a finite number")
    return number


def number(name: str, text: str) -> float:
    """Return a finite number; ``name`` is that of its option."""
    return float(_decimal(name, text))


def optional_number(name: str, text: str | None) -> float | None:
    """Return a finite number, if it is given."""
    return None if text is None else number(name, text)


def whole(name: str, text: str) -> int:
    """Return a whole number."""
    found = _decimal(name, text, "a whole number")
    if found != int(found):
        raise InputError(f"{name} = {labels.cut(text)}: give a whole number")
    return int(found)


def number_or_range(name: str, text: str) -> float | NDArray[np.float64]:
    """Return one number, a list of numbers, or START:STOP:STEP with the stop included."""
    if ":" not in text:
        numbers = [number(name, part) for part in text.split(",")]
        return np.array(numbers) if "," in text else numbers[0]
    parts = text.split(":")
    if len(parts) != 3:
        raise InputError(f"{name} = {labels.cut(text)}: give START:STOP:STEP, a,b,c or one number")
    # In decimals, so that 0.2:0.4:0.1 holds 0.3 and 0.4 as they would be typed.
    start, stop, step = (_decimal(name, part) for part in parts)
    if float(step) == 0.0 or (stop - start) * step < 0:
        raise InputError(
            f"{name} = {labels.cut(text)}: the step does not lead from {start} to {stop}"
        )
    steps = (stop - start) / step
    if steps >= MOST_ROWS:
        raise InputError(
            f"{name} = {labels.cut(text)}: {float(steps):.3g} steps; give {MOST_ROWS} at most"
        )
    return np.array([float(start + k * step) for k in range(int(steps) + 1)])


def numbers(name: str, text: str | None) -> list[float] | None:
    """Return a list of numbers, if it is given."""
    return None if text is None else [number(name, part) for part in text.split(",")]


def whole_numbers(name: str, text: str, cure: str = "give whole numbers, such as 1,2") -> list[int]:
    """Return a list of whole numbers."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{name} = {labels.cut(text)}: {cure}") from None


def orders(text: str) -> Orders:
    """Return the orders of ``--orders``, or "auto"."""
    if text == "auto":
        return "auto"
    return whole_numbers("--orders", text, "give whole numbers, such as 1,2,4, or auto")


def spectrum(text: str | None) -> Spectrum | None:
    """Return the spectrum of ``--spectrum``, order → amplitude in kg·m, if it is given."""
    if text is None:
        return None
    amplitudes: dict[int, float] = {}
    for part in text.split(","):
        typed, _, amplitude = part.partition("=")
        try:
            order = int(typed)
        except ValueError:
            order = 0
        if not amplitude or order < 1:
            raise InputError(
                f"--spectrum = {labels.cut(text)}: give order=amplitude, such as 1=9.0,2=3.75"
            )
        if order in amplitudes:
            raise InputError(f"--spectrum = {labels.cut(text)}: order {order} is given twice")
        amplitudes[order] = number("--spectrum", amplitude)
    return amplitudes


def picture_file(text: str | None) -> Path | None:
    """Return the file of the picture, checked before anything is computed for it."""
    if text is None:
        return None
    path = Path(text)
    if path.suffix.lower() not in PICTURES:
        raise InputError(
            f"--plot = {labels.cut(text)}: a picture's name ends in {', '.join(PICTURES)}"
        )
    return path


def chosen(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return orders, or "auto", and the tolerance by which they are chosen, if it is given."""
    listed = orders(arguments.orders)
    if arguments.rtol is None:
        return {"orders": listed}
    if listed != "auto":
        raise InputError("--rtol needs --orders auto")
    return {"orders": listed, "rtol": number("--rtol", arguments.rtol)}
