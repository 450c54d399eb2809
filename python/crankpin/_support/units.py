"""Units of input and display: parsing, and conversion of shown values.

Numbers of the library are SI. A setting selects the units in which tables, texts and pictures show
them, and changes no number of a result.
"""

from __future__ import annotations

import math
from contextvars import ContextVar
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple, Self

from crankpin import _core
from crankpin._support import inputs

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from types import TracebackType

ENERGIES = {
    "N·m": "J", "kN·m": "kJ", "MN·m": "MJ", "lbf·ft": "ft·lbf", "lbf·in": "in·lbf",
}  # fmt: skip
"""Unit of torque → that of energy beside it, where they have different names."""
_symbols, _aliases = _core.unit_symbols()
UNITS_BY_KIND = tuple(
    {
        name: Decimal(number).scaleb(power) / below
        for name, of, (number, power, below) in _symbols
        if of == kind
    }
    for kind in range(4)
)
"""Units of mass, length, force and pressure → kg, m, N and Pa."""
MASSES, LENGTHS, FORCES, PRESSURES = UNITS_BY_KIND
SYMBOLS = {
    name: (kind, factor) for kind, of in enumerate(UNITS_BY_KIND) for name, factor in of.items()
}
"""Unit → its kind, a place in :data:`UNITS_BY_KIND`, and its factor to SI."""
ALIASES = dict(_aliases)
"""Spelling of a unit → the unit."""
UNITS_HINT = 'give units of mass, length, force or pressure, such as "g, mm, lbf" or "oz·in"'
LEAST_DIGITS = 3
"""Significant digits of a converted number in a text, at least."""

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
    setting: Setting = {}
    for word in filter(
        None, (part.strip() for part in inputs.text(name, text, UNITS_HINT).split(","))
    ):
        unit = symbol(word) or word.replace("*", "·")
        try:
            dimension = _dimension(_terms(unit))
        except KeyError:
            meant = inputs.nearest(word, [*SYMBOLS, *ALIASES])
            raise inputs.rejected(name, text, f"{UNITS_HINT}{meant}") from None
        if dimension in setting:
            raise inputs.rejected(name, text, f"{setting[dimension]} and {unit} are of one kind")
        setting[dimension] = _text(_terms(unit))
    return setting


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
        torque = convert("N·m", chosen)
        return Converted(ENERGIES.get(torque.unit, torque.unit), torque.factor)
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


# --- figures in texts ----------------------------------------------------------------------------


class Figure(NamedTuple):
    """Numbers and their unit, as a part of a :class:`Text`."""

    values: tuple[float, ...]
    """The numbers; none where the unit stands alone."""
    unit: str
    """Their unit."""
    spec: str = ".5g"
    """Format of each, as of ``format``; empty for all digits."""
    form: str = "{}"
    """Text of the numbers: ``"{} to {}"``, ``"({}, {}, {})"``."""

    def text(self, setting: Mapping[Dimension, str]) -> str:
        """Return the numbers and the unit that a setting shows."""
        converted, spec = convert(self.unit, setting), self.spec
        numbers = [format(value, spec) for value in self.values]
        if converted.factor != 1.0:
            before, _, digits = spec.partition(".")
            most = int(digits[:-1] or 5)
            if digits.endswith("f"):
                spec = f"{before}.{max(0, most - round(math.log10(converted.factor)))}f"
                numbers = [format(value * converted.factor, spec) for value in self.values]
            else:
                most = max(most, LEAST_DIGITS)
                rounded = (float(f"{value * converted.factor:.{most}g}") for value in self.values)
                numbers = [f"{value:{before}.10g}" for value in rounded]
        return f"{self.form.format(*numbers) if numbers else ''} {converted.unit}".strip()


class Text(str):
    """Text of which figures are shown in the units that are set; of itself it is in SI units.

    Words, among them names that users gave, stay as they are whatever they look like.
    """

    __slots__ = ("parts",)
    parts: tuple[str | Figure, ...]
    """Words and figures."""

    def __new__(cls, *parts: str | Figure) -> Self:
        """Return the text of words, other texts and figures."""
        flat = [
            piece for part in parts for piece in (part.parts if isinstance(part, Text) else (part,))
        ]
        text = super().__new__(cls, "".join(_part(part, {}) for part in flat))
        text.parts = tuple(flat)
        return text

    def __reduce__(self) -> tuple[type[Text], tuple[str | Figure, ...]]:
        """Return what copies and pickles are made of."""
        return type(self), self.parts


def _part(part: str | Figure, setting: Mapping[Dimension, str]) -> str:
    return part.text(setting) if isinstance(part, Figure) else part


def shown(text: str, setting: Mapping[Dimension, str] | None = None) -> str:
    """Return a text with its figures as a setting shows them."""
    chosen = current() if setting is None else setting
    parts = text.parts if isinstance(text, Text) else (text,)
    return "".join(_part(part, chosen) for part in parts)


def joined(separator: str, texts: Iterable[str]) -> Text:
    """Return the texts that are not empty, with their figures and a separator between them."""
    parts = [part for text in texts if text for part in (separator, text)]
    return Text(*parts[1:])


def headed(words: str, unit: str) -> Text:
    """Return ``force, N``, of which the unit is shown as it is set."""
    return joined(", ", [words, Text(Figure((), unit))])


def figure(value: float, unit: str, digits: int, most: float | None = None) -> Text:
    """Return a number of significant digits, or a range, with its unit."""
    ends = (value,) if most is None or most == value else (value, most)
    return Text(Figure(ends, unit, f".{digits}g", " to ".join("{}" for _ in ends)))


def factor_of(text: str, setting: Mapping[Dimension, str] | None = None) -> float:
    """Return the factor of numbers under a head, ``force, N``, in the unit that is shown."""
    parts = text.parts if isinstance(text, Text) else ()
    alone = [part.unit for part in parts if isinstance(part, Figure) and not part.values]
    return convert(alone[-1], setting).factor if alone else 1.0


# --- products and quotients of units --------------------------------------------------------------

TORQUE: Dimension = (0, 1, 1, 0)
Terms = list[tuple[str, int]]


def _terms(unit: str) -> Terms:
    """Return the symbols of a unit with their exponents; a KeyError for one that is unknown."""
    if (terms := _core.unit_terms(unit)) is None:
        raise KeyError(unit)
    return terms


def _dimension(terms: Terms) -> Dimension:
    """Return the exponents of mass, length, force, pressure; of others the name is one."""
    exponents = [0] * len(UNITS_BY_KIND)
    others: list[int] = []
    for name, n in terms:
        if name in SYMBOLS:
            exponents[SYMBOLS[name][0]] += n
        else:
            others += [10 if name == "s" else 20, n]
    return (*exponents, *others)


def _factor(terms: Terms) -> Fraction:
    return math.prod(
        (Fraction(SYMBOLS[name][1]) ** n for name, n in terms if name in SYMBOLS), start=Fraction(1)
    )


def _power(n: int) -> str:
    return {1: "", 2: "²", 3: "³"}[abs(n)]


def _text(terms: Terms) -> str:
    above = "·".join(f"{name}{_power(n)}" for name, n in terms if n > 0)
    return "/".join([above, *(f"{name}{_power(n)}" for name, n in terms if n < 0)])
