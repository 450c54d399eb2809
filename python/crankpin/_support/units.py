"""Units of input and display: parsing, and conversion of shown values.

Numbers of the library are SI. A setting selects the units in which tables, texts and pictures show
them, and changes no number of a result.
"""

from __future__ import annotations

import math
import re
from contextvars import ContextVar
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from crankpin import _core
from crankpin._support import inputs

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType

ENERGIES = {
    "N·m": "J", "kN·m": "kJ", "MN·m": "MJ", "lbf·ft": "ft·lbf", "lbf·in": "in·lbf",
}  # fmt: skip
"""Unit of torque → that of energy beside it, where they have different names."""
_symbols, _aliases = _core.unit_symbols()
KINDS = tuple(
    {
        name: Decimal(number).scaleb(power) / below
        for name, of, (number, power, below) in _symbols
        if of == kind
    }
    for kind in range(4)
)
"""Units of mass, length, force and pressure → kg, m, N and Pa."""
MASSES, LENGTHS, FORCES, PRESSURES = KINDS
SYMBOLS = {name: (kind, factor) for kind, of in enumerate(KINDS) for name, factor in of.items()}
"""Unit → its kind, a place in :data:`KINDS`, and its factor to SI."""
ALIASES = dict(_aliases)
"""Spelling of a unit → the unit."""
HINT = 'give units of mass, length, force or pressure, such as "g, mm, lbf" or "oz·in"'
LEAST_DIGITS = 3
"""Significant digits of a converted number in a text, at least."""

_SI = "|".join(sorted(
    ("kg", "g", "mg", "m", "cm", "mm", "µm", "N", "kN", "MN", *PRESSURES), key=len, reverse=True
))  # fmt: skip
_UNIT = rf"(?:J|{_SI}|s|rad)[²³]?(?:[·/](?:{_SI}|s|rad)[²³]?)*(?![\w·/²³])"
_NUMBER = r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_FIGURE = re.compile(rf"(?<![\w.])(?:({_NUMBER}) to )?({_NUMBER}) ({_UNIT})", re.ASCII)
_VECTOR = re.compile(rf"\(((?:{_NUMBER}(?:, )?)+)\) ({_UNIT})", re.ASCII)

Dimension = tuple[int, ...]


class Converted(NamedTuple):
    """Unit in which something is shown."""

    unit: str
    """Unit, as read by people."""
    factor: float
    """Factor of the numbers."""


class Shown:
    """Setting of units, made by :func:`crankpin.units`: its block ends it."""

    __slots__ = ("_setting",)

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        settings = _settings.get()
        if len(settings) > 1 and not (settings[-1][1] or settings[-2][1]):
            settings = (*settings[:-2], settings[-1])  # what the last one replaced has ended
        _settings.set((*settings, (self, False)))

    def __enter__(self) -> None:
        settings = _settings.get()
        if settings and settings[-1] == (self, False):
            settings = settings[:-1]
        _settings.set((*settings, (self, True)))

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        settings = _settings.get()
        block = (self, True)
        if block not in settings:
            return  # begun by another thread or task
        at = len(settings) - 1 - settings[::-1].index(block)
        behind = at + 1
        while behind < len(settings) and not settings[behind][1]:
            behind += 1  # settings without a block of their own end with this one
        # Blocks of a generator may end before those that began within them.
        _settings.set(settings[:at] + settings[behind:])


def units(text: str = "") -> Shown:
    """Set the units in which tables, texts and pictures are shown.

    Numbers of results remain in SI units. The setting lasts until the next call; as a context
    manager, until its block ends. It belongs to the current thread or asyncio task.

    Parameters
    ----------
    text : str, default ""
        Units of mass (``kg``, ``g``, ``lb``, ``oz``), length (``m``, ``mm``, ``in``, ``ft``), force
        (``N``, ``kN``, ``lbf``, ``kgf``) and pressure (``Pa``, ``bar``, ``psi``), and products such
        as ``oz·in`` or ``lbf·ft``, separated by commas. Quantities not listed keep SI units; with
        ``lbf`` torques are in lbf·ft and energies in ft·lbf, unless a product is named. An empty
        string restores SI units.

    Returns
    -------
    Shown
        The setting, as a context manager.

    Raises
    ------
    InputError
        If there is no such unit, or a kind is named twice.

    Examples
    --------
    >>> import crankpin as cp
    >>> bob = cp.bob_weight(cp.Engine.preset("single", rotating_mass=0.5))
    >>> with cp.units("oz, in, lbf"):
    ...     print(bob.frames["table"])
    Single: bob weights, rotating + 50 % of reciprocating
    cylinders  crankpin °  rotating oz  reciprocating oz  oil oz  bob weight oz
    1                90.0        17.64             15.87       0          25.57
    """
    return Shown(read(text))


Setting = dict[Dimension, str]
"""Dimension → its unit."""
_settings: ContextVar[tuple[tuple[Shown, bool], ...]] = ContextVar("settings", default=())
"""Settings with whether they are blocks, the innermost last."""


def read(text: object, name: str = "units") -> Setting:
    """Return the units that a text names."""
    found: Setting = {}
    for word in filter(None, (each.strip() for each in inputs.text(name, text, HINT).split(","))):
        unit = symbol(word) or word.replace("*", "·")
        try:
            dimension = _dimension(_terms(unit))
        except KeyError:
            meant = inputs.nearest(word, [*SYMBOLS, *ALIASES])
            raise inputs.rejected(name, text, f"{HINT}{meant}") from None
        if dimension in found:
            raise inputs.rejected(name, text, f"{found[dimension]} and {unit} are of one kind")
        found[dimension] = _text(_terms(unit))
    return found


def current() -> Setting:
    """Return the units of the setting."""
    settings = _settings.get()
    return settings[-1][0]._setting if settings else {}


def symbol(word: str) -> str | None:
    """Return the unit of a word in any case, or None."""
    return _core.unit_symbol(word)


def exact(unit: str, dimension: Dimension | None = None) -> Decimal | None:
    """Return the value of a unit in SI units; None if it is unknown or of another kind."""
    wanted = None if dimension is None else (*dimension, 0, 0)[:6]
    if (factor := _core.unit_factor(unit, wanted)) is None:
        return None
    number, power, below = factor
    return Decimal(number).scaleb(power) / below


def convert(unit: str, setting: Mapping[Dimension, str] | None = None) -> Converted:
    """Return the unit that a setting shows in place of another, and the factor of numbers."""
    chosen = current() if setting is None else setting
    same = Converted(unit, 1.0)
    if not chosen or not unit:
        return same
    if unit == "J":
        shown = convert("N·m", chosen)
        return Converted(ENERGIES.get(shown.unit, shown.unit), shown.factor)
    try:
        terms = _terms(unit)
        dimension = _dimension(terms)
    except KeyError:
        return same
    if dimension in chosen:
        target = _terms(chosen[dimension])
    else:
        single = {sum(k * n for k, n in enumerate(key)): name for key, name in chosen.items()
                  if sum(map(abs, key)) == 1}  # fmt: skip
        if dimension == TORQUE:  # in newton metres, or pound feet, whatever lengths are in
            if 2 not in single:
                return same
            single[1] = "ft" if single[2] in ("lbf", "ozf") else "m"
        target = [
            (single.get(SYMBOLS[name][0], name) if name in SYMBOLS else name, n)
            for name, n in terms
        ]
    factor = _factor(terms) / _factor(target)
    return Converted(_text(target), float(factor))


def figure(value: float, unit: str, digits: int, most: float | None = None) -> str:
    """Return a number of significant digits, or a range, with its unit, as the setting shows it."""
    shown = convert(unit)
    ends = [value] if most in (None, value) else [value, most]
    numbers = " to ".join(f"{end * shown.factor:.{digits}g}" for end in ends if end is not None)
    return f"{numbers} {shown.unit}"


def in_text(text: str, setting: Mapping[Dimension, str] | None = None) -> str:
    """Return a text of the library with its numbers and their SI units as a setting shows them."""
    chosen = current() if setting is None else setting
    if not chosen:
        return text

    def written(number: str, factor: float) -> str:
        mantissa = re.sub(r"e.*|\D", "", number).lstrip("0")
        digits = max(len(mantissa), LEAST_DIGITS)
        value = float(number.replace("−", "-")) * factor
        return f"{float(f'{value:.{digits}g}'):.10g}"

    def one(match: re.Match[str]) -> str:
        least, number, unit = match.groups()
        shown = convert(unit, chosen)
        if shown.unit == unit:
            return match[0]
        begin = f"{written(least, shown.factor)} to " if least else ""
        return f"{begin}{written(number, shown.factor)} {shown.unit}"

    def several(match: re.Match[str]) -> str:
        shown = convert(match[2], chosen)
        if shown.unit == match[2]:
            return match[0]
        numbers = (written(each, shown.factor) for each in match[1].split(", "))
        return f"({', '.join(numbers)}) {shown.unit}"

    return _VECTOR.sub(several, _FIGURE.sub(one, text))


def verbatim(name: str) -> str:
    """Return a name whose figures are not those of the library: their spaces do not break."""
    for figures in (_FIGURE, _VECTOR):
        name = figures.sub(lambda found: found[0].replace(" ", "\N{NO-BREAK SPACE}"), name)
    return name


def after_comma(text: str, setting: Mapping[Dimension, str] | None = None) -> tuple[str, float]:
    """Return ``force, N`` with the unit that a setting shows, and the factor of its numbers."""
    match = re.fullmatch(r"(.*, )([^ ,]+)( \(.*\))?", text)
    shown = convert(match[2] if match else "", setting)
    return f"{match[1]}{shown.unit}{match[3] or ''}" if match else text, shown.factor


# --- products and quotients of units --------------------------------------------------------------

TORQUE: Dimension = (0, 1, 1, 0)
Terms = list[tuple[str, int]]


def _terms(unit: str) -> Terms:
    """Return the symbols of a unit with their exponents; a KeyError for one that is unknown."""
    if (found := _core.unit_terms(unit)) is None:
        raise KeyError(unit)
    return found


def _dimension(terms: Terms) -> Dimension:
    """Return the exponents of mass, length, force, pressure; of others the name is one."""
    found = [0] * len(KINDS)
    others: list[int] = []
    for name, n in terms:
        if name in SYMBOLS:
            found[SYMBOLS[name][0]] += n
        else:
            others += [10 if name == "s" else 20, n]
    return (*found, *others)


def _factor(terms: Terms) -> Fraction:
    return math.prod(
        (Fraction(SYMBOLS[name][1]) ** n for name, n in terms if name in SYMBOLS), start=Fraction(1)
    )


def _power(n: int) -> str:
    return {1: "", 2: "²", 3: "³"}[abs(n)]


def _text(terms: Terms) -> str:
    above = "·".join(f"{name}{_power(n)}" for name, n in terms if n > 0)
    return "/".join([above, *(f"{name}{_power(n)}" for name, n in terms if n < 0)])
