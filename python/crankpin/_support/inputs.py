"""Conversion and checks of arguments, from user input to the types of the core."""

from __future__ import annotations

import array as array_module
import difflib
import itertools
import math
import operator
import re
import reprlib
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeVar

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support.messages import Hint, hint_of, warn, warn_of_core

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Angle: TypeAlias = float | Decimal | Fraction | str | np.floating[Any] | np.integer[Any]
"""Degrees: a number, a ``Decimal``, a ``Fraction``, or a string such as ``"360/7"``."""

Angles: TypeAlias = "Sequence[Angle] | NDArray[np.floating[Any] | np.integer[Any]]"
Order: TypeAlias = int | float
"""Multiple of crank speed: an int where it is whole, a float such as 0.5 where it is a half."""
Orders: TypeAlias = "Order | Iterable[Order] | Literal['auto']"
Spectrum: TypeAlias = Mapping[int, complex]
"""Order → amplitude of one cylinder's force over ω², kg·m."""

Number = TypeVar("Number", int, Order)

MOST_NUMBERS = _core.LONGEST_AXIS
LARGEST_RESULT = _core.LARGEST_RESULT
"""Maximum length of an array: a gibibyte."""

PIECE_NUMBERS = 2**16
"""Numbers converted or copied between checks for Ctrl-C."""

SINGLES = (np.float16, np.float32)
"""Types whose shortest decimal is not that of the double of the same value."""

LARGEST_BINARY = 2**44
"""Denominator of a fraction from which one that a float holds exactly was made of a float."""
MOST_EXACT = 10**18
"""Fractions are exact up to this value and this denominator; others become floats."""

LARGEST_WHOLE = 10**100
"""Largest whole number taken: Python refuses to write those of thousands of digits."""

_BOOLEANS = {bool, np.bool_}

ROUNDED_RADIANS = 1e-3
"""Difference, radians, up to which the end of crank angles is a turn in radians: 6.2832, 12.566."""

MANY_WORDS = 4
"""Number of words from which on the one that was meant is suggested."""

MOST_ITEMS = 10_000
"""Items in a list that is taken one by one, such as orders; an endless one is rejected."""


BUFFER = 2**26
"""Memory reserved for OpenBLAS, which ends the process if it cannot allocate its own 32 MiB."""


def _take_buffer() -> None:
    """Let OpenBLAS take the memory of its first product now: a MemoryError if there is none."""
    np.empty(BUFFER, np.uint8)
    np.ones((2, 2)) @ np.ones((2, 2))


_take_buffer()


# --- numbers ------------------------------------------------------------------------------------


def array(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return an aligned array of floats of any shape; without a copy if it is one already.

    Long inputs are converted piece by piece, so that Ctrl-C is answered in between.
    """
    if type(values) is np.ndarray and values.dtype == np.float64 and values.size <= MOST_NUMBERS:
        return values if values.flags.aligned else copied(values)
    count = _length(values)
    if count > MOST_NUMBERS:
        # Before NumPy allocates memory for it.
        raise _too_many(name, count)
    try:
        if isinstance(values, np.ma.MaskedArray):
            raise TypeError("masked arrays are not supported; use .filled()")
        if type(values) is int or type(values) is float:
            return np.array(float(values))
        numbers = _from_list(values)
        if numbers.dtype.kind not in "fiu":
            if numbers.dtype.kind != "O":
                raise TypeError(f"{numbers.dtype} is not a real number")
            # Fractions and the like, each by its own conversion.
            numbers = np.array([_real(value) for value in numbers.ravel()]).reshape(numbers.shape)
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        raise rejected(name, values, f"give numbers ({reason(error)})") from None
    if numbers.size > MOST_NUMBERS:
        raise _too_many(name, numbers.size)
    return numbers if numbers.dtype == np.float64 and numbers.flags.aligned else copied(numbers)


def _length(values: object) -> int:
    """Return the length of a sequence, 0 if it has none."""
    if isinstance(values, range):  # len() takes no range beyond 2⁶³
        return max(0, -((values.start - values.stop) // values.step))
    try:
        return len(values)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return 0


def contiguous(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the array in one piece; without a copy where it is already."""
    return values if values.flags.c_contiguous else copied(values)


def vector(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return a contiguous one-dimensional array of floats; a scalar becomes a single value."""
    numbers = array(name, values)
    if numbers.ndim > 1:
        raise faulty(name, f"has shape {numbers.shape}", "give one dimension")
    return contiguous(numbers if numbers.ndim else numbers.reshape(1))


def _from_list(values: ArrayLike) -> NDArray[Any]:
    if not isinstance(values, (list, tuple, range)) or len(values) <= PIECE_NUMBERS:
        return _piece(values)
    pieces = [_piece(values[k : k + PIECE_NUMBERS]) for k in range(0, len(values), PIECE_NUMBERS)]
    if len({piece.shape[1:] for piece in pieces}) > 1:
        raise ValueError("lists of different lengths")
    # Not by concatenate, which Ctrl-C does not interrupt.
    joined = np.empty(
        (len(values), *pieces[0].shape[1:]), np.result_type(*{piece.dtype for piece in pieces})
    )
    for k, piece in enumerate(pieces):
        joined[k * PIECE_NUMBERS : (k + 1) * PIECE_NUMBERS] = piece
    return joined


def _piece(values: ArrayLike) -> NDArray[Any]:
    if isinstance(values, (list, tuple)) and _BOOLEANS & {*map(type, values)}:
        raise TypeError("a truth value is not a number")
    return np.asarray(values)


def copied(values: NDArray[Any]) -> NDArray[np.float64]:
    """Return a copy in doubles; a single is read as the shortest decimal of its own precision."""
    single = values.dtype in SINGLES
    if values.size <= PIECE_NUMBERS:
        return np.array(values.astype(str) if single else values, dtype=np.float64)
    copy = np.empty(values.shape)
    rows = max(1, PIECE_NUMBERS * len(values) // values.size)
    for k in range(0, len(values), rows):
        piece = values[k : k + rows]
        copy[k : k + rows] = piece.astype(str) if single else piece
    return copy


def fitting(name: str, size: int, hint: str) -> None:
    """Raise an InputError if a result would take more bytes than the core lets a call return."""
    if size > LARGEST_RESULT:
        fault = f"the result would take {size} bytes, more than the limit of {LARGEST_RESULT}"
        raise InputError(f"{name}: {fault}; {hint}")


def _too_many(name: str, count: int) -> InputError:
    fault = f"has {count} numbers, more than the limit of {MOST_NUMBERS}"
    return faulty(name, fault, "split it into parts")


def output(name: str, values: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Return an array that results of this shape can be written to."""
    hint = f"give a writeable, aligned, C-contiguous array of float64, of shape {shape}"
    if not isinstance(values, np.ndarray):
        raise rejected(name, values, hint)
    if values.dtype != np.float64 or values.shape != shape or not values.flags.carray:
        kind = "" if values.flags.carray else ", not writeable, aligned and contiguous"
        raise faulty(name, f"has shape {values.shape} of {values.dtype}{kind}", hint)
    return values


def number(name: str, value: object) -> float:
    """Return a float."""
    if type(value) is float or (type(value) is int and abs(value) < 2**53):
        return float(value)
    try:
        return _real(value)
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        raise rejected(name, value, f"give a number ({reason(error)})") from None


def _real(value: Any) -> float:  # noqa: ANN401 - anything that float() takes
    """Return a float of a real number: not of text, a truth value, or a list, however short."""
    # Neither text nor bytes have __float__, though float() parses them.
    if type(value) in _BOOLEANS or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
        raise TypeError(f"{type(value).__name__} is not a number")
    kind = getattr(getattr(value, "dtype", None), "kind", "f")
    if kind not in "fiuO" or getattr(value, "ndim", 0) != 0 or value is np.ma.masked:
        raise TypeError("it is an array, complex, masked or a truth value")
    if getattr(value, "dtype", None) in SINGLES:
        return float(str(np.asarray(value)[()]))
    return float(value)


def finite(name: str, value: object) -> float:
    """Return a finite float."""
    real = number(name, value)
    if not math.isfinite(real):
        raise rejected(name, real, "give a finite number")
    return real


def limited(name: str, value: object) -> float:
    """Return a float within the limits of figures, so that its square is finite."""
    real = finite(name, value)
    if abs(real) > _core.LARGEST:
        raise rejected(name, real, f"give a number of magnitude {_core.LARGEST:g} at most")
    return real


def finite_array(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return an array of finite floats of any shape."""
    numbers = array(name, values)
    if not np.isfinite(numbers).all():
        raise rejected(name, values, "give finite numbers")
    return numbers


def positive(name: str, value: object, hint: str = "give a number that is more than zero") -> float:
    """Return a float above zero, within the limits of figures, so that its squares are finite."""
    return float(positive_array(name, number(name, value), hint))


def positive_array(
    name: str, values: ArrayLike, hint: str = "give numbers that are more than zero"
) -> NDArray[np.float64]:
    """Return an array of floats above zero, within the limits of figures."""
    numbers = array(name, values)
    if not (numbers > 0.0).all():
        raise rejected(name, values, hint)
    if not ((numbers >= _core.SMALLEST) & (numbers <= _core.LARGEST)).all():
        raise rejected(name, values, f"{hint}, from {_core.SMALLEST:g} to {_core.LARGEST:g}")
    return numbers


def optional_number(name: str, value: object) -> float | None:
    """Return a float, or None for None."""
    return None if value is None else number(name, value)


def is_listed(value: object) -> bool:
    """Return whether a value is a collection: a list, or an array with an axis."""
    try:
        return isinstance(value, (list, tuple)) or np.ndim(value) > 0  # type: ignore[arg-type]
    except ValueError:  # of another ragged sequence
        return True


def listed_numbers(name: str, values: ArrayLike) -> list[float]:
    """Return numbers that are taken one by one as a list, up to a limit."""
    array = vector(name, values)
    if array.size > MOST_ITEMS:
        raise faulty(name, f"has {array.size} numbers", f"give {MOST_ITEMS} at most")
    numbers: list[float] = array.tolist()
    return numbers


def per_item(name: str, values: ArrayLike, count: int) -> list[float]:
    """Return one float for each item; a scalar is that of all."""
    numbers = listed_numbers(name, values)
    return numbers if np.ndim(values) else numbers * count


def crank_angles(theta_deg: ArrayLike | None) -> NDArray[np.float64]:
    """Return crank angles in degrees, by default two turns; warn of one turn or two in radians."""
    theta = vector("theta_deg", np.arange(721.0) if theta_deg is None else theta_deg)
    if theta.size > 2 and theta[0] == 0.0:
        last, step = theta[-1], theta[-1] - theta[-2]  # the end of a range may be left out
        ends = np.abs(np.subtract.outer([last, last + step], [math.tau, 2.0 * math.tau]))
        if ends.min() < ROUNDED_RADIANS:
            hint = "was it given in radians? Angles are degrees here"
            warn("theta_deg", f"ends at {last:g}", hint)
    return theta


def speed_ratio(name: str, value: object) -> Order:
    """Return the speed of a shaft over crank speed: a whole number, or a half as a float."""
    hint = 'give a multiple of 1/2 other than 0, such as "1/2", -1 or 2'
    try:
        ratio = order(Fraction(value) if isinstance(value, str) else value)
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        raise rejected(name, value, hint) from None
    if ratio == 0 or abs(ratio) > _core.LARGEST_SPEED_RATIO:
        raise rejected(name, value, hint)
    return ratio


def angular_speed(rpm: object) -> float:
    """Return ω in rad/s."""
    return _core.angular_speed(number("rpm", rpm))


def speeds(rpm: ArrayLike) -> float | NDArray[np.float64]:
    """Return a crank speed, or a copy of several, rpm; each is one that engines can have."""
    if not is_listed(rpm):
        angular_speed(rpm)
        return number("rpm", rpm)
    several = vector("rpm", rpm)
    if not len(several):
        raise rejected("rpm", rpm, "give a crank speed, or several")
    for speed in several.tolist():
        angular_speed(speed)
    return several.copy()


def fastest(rpm: float | NDArray[np.float64]) -> float:
    """Return the highest of one or several speeds."""
    return float(np.max(rpm))


# --- words --------------------------------------------------------------------------------------


def text(name: str, value: object, hint: str = "give text") -> str:
    """Return a string that can be written as UTF-8."""
    if not isinstance(value, str):
        raise rejected(name, value, hint)
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise rejected(name, value, f"{hint} ({reason(error)})") from None
    return value


def optional_text(name: str, value: object) -> str | None:
    """Return a string that can be written as UTF-8, or None for None."""
    return None if value is None else text(name, value)


def file_path(path: object, endings: tuple[str, ...], hint: str, name: str = "path") -> Path:
    """Return the path of a file whose name has one of these endings, ``.toml`` or the like."""
    try:
        file = Path(path)  # type: ignore[arg-type]
    except TypeError:
        raise rejected(name, path, f"give a path; {hint}") from None
    if file.suffix.lower() not in endings or "\0" in str(file):
        raise rejected(name, str(path), hint)
    return file


def whole(name: str, value: object, least: int | None = None, most: int | None = None) -> int:
    """Return a whole number between two others."""
    try:
        integer = _index(value)
    except TypeError:
        raise rejected(name, value, "give a whole number") from None
    if least is not None and integer < least:
        raise rejected(name, integer, f"give a whole number, {least} or more")
    if most is not None and integer > most:
        raise rejected(name, integer, f"give {most} at most")
    if abs(integer) > LARGEST_WHOLE:
        raise rejected(name, integer, "give a whole number of fewer digits")
    return integer


def _index(value: Any) -> int:  # noqa: ANN401 - anything that operator.index() takes
    if type(value) in _BOOLEANS:
        raise TypeError("a truth value is not a number")
    return operator.index(value)


def strokes(value: object) -> int:
    """Return 2 or 4."""
    try:
        if (number := _index(value)) in (2, 4):
            return number
    except TypeError:
        pass
    raise rejected("strokes", value, "give 4 for a four-stroke or 2 for a two-stroke")


def flag(name: str, value: object) -> bool:
    """Return True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise rejected(name, value, "give True or False")
    return bool(value)


def one_of(
    name: str, value: object, choices: Collection[str], kind: type[InputError] = InputError
) -> str:
    """Return one of a few words."""
    if isinstance(value, str) and value in choices:
        return value
    if not choices:
        raise rejected(name, value, "there is none; leave it out", kind)
    *before, last = map(_quoted, choices)
    hint = f"{', '.join(before)} or {last}" if before else last
    raise rejected(name, value, f"give {hint}{nearest(value, choices)}", kind)


def nearest(value: object, words: Iterable[str]) -> str:
    """Return ``; did you mean "moment"?`` for a slip in one of many words, else nothing."""
    choices = list(words)
    if not isinstance(value, str) or len(choices) < MANY_WORDS:
        return ""
    matches = difflib.get_close_matches(value[:80], choices, 1)
    return f"; did you mean {_quoted(matches[0])}?" if matches else ""


def _quoted(word: str) -> str:
    """Return a word in quotation marks, control characters as in Python."""
    return f'"{word}"' if word.isprintable() else repr(word)


# --- lists --------------------------------------------------------------------------------------


def items(name: str, values: object, hint: str) -> list[Any]:
    """Return the items of an iterable as a list, up to a limit."""
    # Lists and tuples come first: to find that they are iterable takes microseconds.
    if isinstance(values, (str, bytes)) or not isinstance(values, (list, tuple, Iterable)):
        raise rejected(name, values, hint)
    try:
        is_endless = type(values) not in (list, tuple)
        taken = list(itertools.islice(values, MOST_ITEMS + 1) if is_endless else values)
    except (TypeError, ValueError) as error:
        raise rejected(name, values, f"{hint} ({reason(error)})") from None
    if len(taken) > MOST_ITEMS:
        raise faulty(name, f"has more than {MOST_ITEMS} entries", hint)
    return taken


def angle(name: str, value: object) -> str:
    """Return text that reads back as exactly this angle.

    Strings, fractions and decimals are exact as written, a float is read as its shortest decimal.
    """
    if isinstance(value, Fraction):
        of_float = value.denominator > LARGEST_BINARY and value == float(value)
        if abs(value) < MOST_EXACT and value.denominator < MOST_EXACT and not of_float:
            value = f"{value.numerator}/{value.denominator}"
    elif isinstance(value, np.ndarray) and not value.ndim and value is not np.ma.masked:
        return angle(name, value[()])
    elif isinstance(value, (Decimal, np.longdouble)):
        value = str(value)
    checked = text(name, value, "give degrees") if isinstance(value, str) else number(name, value)
    return _core.exact_angle(name, checked)


def angles(name: str, values: object) -> list[str]:
    """Return a list of angles."""
    if isinstance(values, (memoryview, array_module.array)) or hasattr(values, "__array__"):
        values = np.asarray(values)  # whose items keep their precision
    degrees = items(name, values, "give a list of degrees")
    return [angle(f"{name}[{k}]", value) for k, value in enumerate(degrees)]


def degrees(angle: Angle) -> float:
    """Return an angle that is kept as a number or as exact text, degrees."""
    numerator, _, denominator = str(angle).partition("/")
    return float(numerator) / float(denominator or 1)


def firing_order(
    name: str, values: object, banks: Sequence[int] = (), dummies: Collection[int] = ()
) -> str:
    """Return a firing order as text, by cylinder numbers.

    Parameters
    ----------
    name
        Name of the argument.
    values
        Numbers, or text: ``"1-3-4-2"``, ``"1342"``, or by banks, ``"A1-B1-A2"`` and ``"1L-2R"``.
    banks
        Bank of each cylinder, an index: where letters of banks can be read.
    dummies
        Numbers of dummy pistons, which have no place in it.
    """
    hint = "give cylinder numbers, such as '1-3-4-2' or [1, 3, 4, 2]"
    if not isinstance(values, str):
        entries = items(name, values, hint)
        if any(isinstance(value, (float, np.floating)) for value in entries):
            numbers = [
                float(value) if isinstance(value, np.floating) else value for value in entries
            ]
            intervals = "firing intervals are `intervals_deg` of `Engine.from_firing_order`"
            more = Hint.of(f"{hint}; {intervals}")
            raise rejected(name, numbers, more)
        return "-".join(shorten(number) for number in entries)
    typed = text(name, values, hint)
    plain = typed.strip()
    if len(plain) <= len(SINGLE_DIGITS) and sorted(plain) == list(SINGLE_DIGITS[: len(plain)]):
        return "-".join(plain)
    by_banks = banks and _LETTERS.search(plain)
    return _by_banks(name, typed, banks, dummies) if by_banks else typed


SINGLE_DIGITS = "123456789"
"""Numbers of cylinders that are written without signs between them."""
_LETTERS = re.compile(
    r"(?:(?P<before>[A-Za-z])(?P<number>\d+)|(?P<turned>\d+)(?P<after>[A-Za-z]))\b"
)
_SIDES = {"R": 0, "L": 1}
"""Letter of a side, seen from the flywheel → index of the bank."""


def _by_banks(name: str, typed: str, banks: Sequence[int], dummies: Collection[int]) -> str:
    """Return a firing order by cylinder numbers: A is the bank of cylinder 1, 2 its second one."""
    letters = {(m["before"] or m["after"]).upper() for m in _LETTERS.finditer(typed)}
    order = dict.fromkeys([banks[0], *sorted(set(banks))])  # A first, then front to rear
    of_letter = dict(zip("ABCDEFGH", order, strict=False))
    if letters <= _SIDES.keys() and len(order) <= len(_SIDES):
        of_letter = _SIDES

    def number(match: re.Match[str]) -> str:
        letter = (match["before"] or match["after"]).upper()
        place = int(match["number"] or match["turned"])
        members = [k for k, bank in enumerate(banks, start=1) if bank == of_letter.get(letter)]
        if not 1 <= place <= len(members):
            banks_text = ", ".join(
                f"{letter} ({banks.count(bank)})" for letter, bank in of_letter.items()
            )
            raise rejected(
                name, typed, f"there is no {match[0]}; banks and cylinders are {banks_text}"
            )
        return str(members[place - 1])

    by_numbers = _LETTERS.sub(number, typed)
    firing = [number for number in range(1, len(banks) + 1) if number not in dummies]
    if sorted(map(int, re.findall(r"\d+", by_numbers))) != firing:
        # Rejected here: what follows would name numbers that were not typed.
        raise rejected(name, typed, f"name each of the engine's {len(firing)} cylinders once")
    return by_numbers


def order(value: object) -> Order:
    """Return an order, an int or a half as a float; a TypeError or ValueError for anything else."""
    if type(value) is int:
        return value
    # NumPy's doubles are floats, and lists of orders are read at every call.
    halves = 2.0 * (float(value) if isinstance(value, float) else _real(value))
    if not halves.is_integer():
        raise ValueError("it is no multiple of 0.5")
    return int(halves) // 2 if halves % 2.0 == 0.0 else halves / 2.0


def orders(values: object, name: str = "orders") -> list[int] | None:
    """Return a list of whole orders, or None for ``"auto"``."""
    hint = "orders are whole multiples of crank speed, such as [1, 2]"
    return _orders(values, name, _index, hint)


def half_orders(values: object, name: str = "orders") -> list[Order] | None:
    """Return a list of orders, halves among them, or None for ``"auto"``."""
    hint = "orders are multiples of crank speed, whole or half, such as [0.5, 1, 2]"
    return _orders(values, name, order, hint)


def _orders(
    values: object, name: str, one: Callable[[Any], Number], hint: str
) -> list[Number] | None:
    if isinstance(values, str):
        if values == "auto":
            return None
        raise rejected(name, values, f'{hint}, or "auto"')
    if isinstance(values, np.ndarray) and values.size <= MOST_ITEMS:
        values = values.tolist()  # Python's numbers, read in half the time of NumPy's
    entries = items(name, values if isinstance(values, (list, tuple, Iterable)) else [values], hint)
    try:
        result = [one(value) for value in entries]
    except (TypeError, ValueError, OverflowError):
        # Of NumPy's infinite numbers a remainder would warn.
        fractions = any(isinstance(value, float) and float(value) % 1.0 > 0.0 for value in entries)
        if fractions and one is _index:
            hint += "; forces of inertia repeat in every turn and have no others"
        raise rejected(name, values, hint) from None
    for value in result:
        if not 0 < value <= _core.HIGHEST_ORDER:
            raise rejected(name, value, f"{hint}, up to {_core.HIGHEST_ORDER}")
    return result


def explicit_orders(values: object, name: str = "orders") -> list[int]:
    """Return a list of whole orders where none can be chosen."""
    return _given(orders(values, name), name, "whole numbers")


def explicit_half_orders(values: object, name: str = "orders") -> list[Order]:
    """Return a list of orders, halves among them, where none can be chosen."""
    return _given(half_orders(values, name), name, "numbers")


def _given(orders: list[Number] | None, name: str, what: str) -> list[Number]:
    if orders is None:
        raise rejected(name, "auto", f"give {what} here, such as [1, 2]")
    return orders


def tolerance(rtol: object, orders: list[int] | None, default: float) -> float:
    """Return the tolerance by which orders are chosen; an error if orders are given with it."""
    if rtol is None:
        return default
    if orders is not None:
        hint = Hint.of('`rtol` is for the choice of orders; leave it out, or give `orders="auto"`')
        raise rejected("rtol", rtol, hint)
    return number("rtol", rtol)


def spectrum(values: object) -> list[tuple[int, complex]] | None:
    """Return (order, amplitude) pairs."""
    if values is None:
        return None
    hint = "give a mapping order → kg·m, such as {1: 9.0, 2: 3.7}"
    if not isinstance(values, Mapping):
        raise rejected("spectrum", values, hint)
    orders = explicit_orders(values, "spectrum")
    try:
        for amplitude in values.values():
            if type(amplitude) in _BOOLEANS or isinstance(amplitude, str):
                raise TypeError("text or a truth value is not a number")
        return [(n, complex(values[key])) for n, key in zip(orders, values, strict=True)]
    except (TypeError, ValueError, OverflowError) as error:
        raise rejected("spectrum", values, f"{hint} ({reason(error)})") from None


# --- messages -----------------------------------------------------------------------------------


def warn_of_units(mean_piston_speed: float) -> None:
    """Warn of a piston that would be faster, in m/s, than in any engine."""
    warn_of_core(_core.piston_speed_warnings(mean_piston_speed))


_SHORT = reprlib.Repr()
_SHORT.maxother = _SHORT.maxstring = 60


def shorten(value: object) -> str:
    """Return a value as one line of readable length, whatever its own repr does."""
    try:
        short = " ".join(_SHORT.repr(value).split())
    except Exception:
        short = f"<{type(value).__name__}>"
    return short if len(short) <= 80 else short[:79] + "…"


def rejected(
    argument: str, value: object, hint: str, kind: type[InputError] = InputError
) -> InputError:
    """Return the error of an argument: its name, its value and a hint."""
    return faulty(argument, f"= {shorten(value)}", hint, kind)


def faulty(argument: str, fault: str, hint: str, kind: type[InputError] = InputError) -> InputError:
    """Return the error of an argument with what it is or has, ``"= 3"`` or ``"has 3 entries"``."""
    error = kind(f"{argument} {fault}: {hint}")
    error.argument, error.hint = argument, hint
    if fault.startswith("= "):
        error.value = fault.removeprefix("= ")
    return error


def renamed(error: InputError, old: str, new: str) -> InputError:
    """Return the error of an argument that a caller gave under another name."""
    argument = error.argument
    if argument is None or not argument.startswith(old):
        return error
    name = new + argument.removeprefix(old)
    return faulty(name, fault_of(error), hint_of(error), type(error))


def fault_of(error: InputError) -> str:
    """Return what is wrong with the argument of an error, ``"= 3"`` or ``"has 3 entries"``."""
    argument, hint = error.argument or "", error.hint or ""
    return str(error)[len(argument) : len(str(error)) - len(hint)].strip(" :;")


def only_one_of(**values: object) -> None:
    """Reject two arguments unless exactly one of them is given."""
    if sum(value is not None for value in values.values()) != 1:
        name, value = values.popitem()
        one = ", ".join(f"`{argument}=…`" for argument in [*values, name])
        raise rejected(name, value, Hint.of(f"give one of {one}"))


def only_with(partner: str, **values: object) -> None:
    """Reject arguments other than None without the argument that they need."""
    for name, value in values.items():
        if value is not None:
            hint = Hint.of(f"needs `{partner}`; give `{partner}=…`, or leave it out")
            raise rejected(name, value, hint)


def reason(error: Exception) -> str:
    """Return the message of an error, shortened: it may quote a value in full."""
    message = " ".join(str(error)[:1000].split())
    return message if len(message) <= 120 else message[:119] + "…"
