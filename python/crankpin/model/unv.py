"""Universal files: dataset 58, functions at the freedoms of a node, in which makers send forces.

As the Structural Dynamics Research Laboratory publishes it (University of Cincinnati, revision of
1999): records of fixed columns between lines of −1.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from crankpin._support import inputs, labels

ENDINGS = (".unv", ".uff")
BETWEEN = "    -1"
DATASET = "    58"
ORDER_FUNCTION = 27
"""Type of a function of engine order."""
SPECTRA = (0, 4, 12, ORDER_FUNCTION)
"""Types of functions that are read: unknown, frequency response, spectrum, of order."""
COMPLEX_SINGLE, COMPLEX_DOUBLE = 5, 6
FREQUENCY, RPM, ORDER, FORCE, GENERAL = 18, 19, 20, 13, 1
"""Types of data along an axis."""
RECORDS = 11
"""Lines of a dataset before its numbers, behind that with its number."""
SINGLE_WIDTH, DOUBLE_WIDTH = 13, 20
HINT = "give an ASCII file with complex functions of order or frequency, dataset 58"


class Function(NamedTuple):
    """One function: phasors of a force or moment over order or frequency."""

    names: tuple[str, str, str]
    """What it is, its scaling with speed, and the point about which moments are: identification."""
    direction: int
    """1 to 3 for forces along x, y and z, 4 to 6 for moments, below zero against them."""
    rpm: float
    """Crank speed; 0 where there is none."""
    by_order: bool
    """True if the abscissa is order, False if frequency, Hz."""
    abscissa: tuple[float, ...]
    values: tuple[complex, ...]


def text_of(function: Function) -> str:
    """Return a dataset."""
    what, scaling, about = (labels.one_line(name)[:80] or "NONE" for name in function.names)
    force = abs(function.direction) <= 3
    unit = "N" if force else "N*m"
    lines = [
        BETWEEN,
        DATASET,
        what,
        scaling,
        "NONE",
        about,
        "NONE",
        _freedom(function.direction),
        "".join(f"{number:10d}" for number in (COMPLEX_DOUBLE, len(function.abscissa), 0))
        + "".join(f"{number:13.5E}" for number in (0.0, 0.0, function.rpm)),
        _axis(ORDER, 0, 0, "Order", "NONE"),
        _axis(FORCE if force else GENERAL, int(not force), 1, "Force" if force else "Moment", unit),
        _axis(0, 0, 0, "NONE", "NONE"),
        _axis(RPM, 0, 0, "Speed", "rpm"),
    ]
    lines += [
        f"{at:13.5E}{value.real + 0.0:20.12E}{value.imag + 0.0:20.12E}"
        for at, value in zip(function.abscissa, function.values, strict=True)
    ]
    return "\n".join([*lines, BETWEEN, ""])


def _freedom(direction: int) -> str:
    """Return the record of function, node and direction."""
    where = f" {'NONE':<10}{1:10d}{direction:4d}"
    return f"{ORDER_FUNCTION:5d}{0:10d}{0:5d}{0:10d}{where} {'NONE':<10}{0:10d}{0:4d}"


def _axis(kind: int, length: int, force: int, label: str, unit: str) -> str:
    """Return the record of an axis."""
    return f"{kind:10d}{length:5d}{force:5d}{0:5d} {label:<20} {unit:<20}"


def functions(text: str) -> Iterator[Function]:
    """Yield the functions of a file, without datasets of other kinds."""
    lines = text.splitlines()
    marks = [k for k, line in enumerate(lines) if line.strip() == BETWEEN.strip()]
    for begin, end in zip(marks[::2], marks[1::2], strict=False):
        if lines[begin + 1].split()[:1] == ["58"]:
            yield _function(lines[begin + 2 : end], begin + 2)


def _function(lines: list[str], first: int) -> Function:
    """Return the function of a dataset; ``first`` is the number of its first line."""
    try:
        kind = int(lines[5][:5])
        direction = int(lines[5][51:55])
        form, count, even = (int(lines[6][k : k + 10]) for k in (0, 10, 20))
        start, step, rpm = (float(lines[6][k : k + 13]) for k in (30, 43, 56))
        axis = int(lines[7][:10])
        sound = kind in SPECTRA and form in (COMPLEX_SINGLE, COMPLEX_DOUBLE)
        sound = sound and axis in (FREQUENCY, ORDER) and 1 <= abs(direction) <= 6
        numbers = _numbers(lines[RECORDS:], form, even=bool(even)) if sound else []
    except (ValueError, IndexError) as error:
        fault = f"has a dataset at line {first} that cannot be read ({inputs.reason(error)})"
        raise inputs.faulty("path", fault, HINT) from None
    if not sound:
        fault = f"has a dataset at line {first} that is no force or moment by order or frequency"
        raise inputs.faulty("path", fault, HINT)
    of = 2 if even else 3
    if len(numbers) != of * count:
        fault = f"has {len(numbers)} numbers in the dataset at line {first}, not {of * count}"
        raise inputs.faulty("path", fault, HINT)
    parts = zip(numbers[of - 2 :: of], numbers[of - 1 :: of], strict=True)
    abscissa = [start + step * k for k in range(count)] if even else numbers[::3]
    names = (lines[0].strip(), lines[1].strip(), lines[3].strip())
    values = tuple(complex(re, im) for re, im in parts)
    return Function(names, direction, rpm, axis == ORDER, tuple(abscissa), values)


def _numbers(lines: list[str], form: int, *, even: bool) -> list[float]:
    """Return the numbers of the lines of a dataset, which may touch each other."""
    widths = [SINGLE_WIDTH] * 6
    if form == COMPLEX_DOUBLE:
        ordinates = [DOUBLE_WIDTH] * 2
        widths = ordinates * 2 if even else [SINGLE_WIDTH, *ordinates]
    numbers = []
    for line in lines:
        at = 0
        for width in widths:
            if cell := line[at : at + width].strip():
                numbers.append(float(cell.upper().replace("D", "E")))
            at += width
    return numbers
