"""Parameters that several functions have: declared once, written into each docstring."""

from __future__ import annotations

import functools
import inspect
import re
import textwrap
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Function = TypeVar("Function", bound="Callable[..., Any]")

SHARED = """
Parameters
----------
bank_deg : sequence of number or str, shape (n_cylinders,)
    Directions of the bores from +x, degrees; 90 is upright, and 30, 90, 150 a W.
z : array_like, shape (n_cylinders,)
    Places along the crank, from the front to the flywheel, m.
tdc_deg : sequence of number or str, shape (n_cylinders,)
    Crank angles at which each crankpin points along its bore, degrees. Exactly one of
    ``tdc_deg`` and ``pin_deg`` is given.
pin_deg : sequence of number or str, shape (n_cylinders,)
    Directions of the crankpins from +x at θ = 0, degrees, in place of ``tdc_deg``.
throws_deg : sequence of number or str, shape (n_throws,)
    Crankpins in the direction of rotation, relative to each other, front to flywheel, degrees. In a
    vee they are those of the right bank. A throw 120° ahead is at top dead centre 120° *earlier*.
numbering : {"alternating", "by-bank"}
    ``"alternating"`` along the crank from bank to bank, or ``"by-bank"``.
odd_bank : {"right", "left"}
    The bank with cylinder 1, seen from the flywheel.
bank_stagger : float
    Distance of the left bank behind the right, towards the flywheel, m.
rotating_mass : array_like
    Rotating mass at the crank radius, each cylinder's share of its crankpin, kg: a number
    for all cylinders, or one for each. Of a pin that two cylinders share it is half. By
    default the big end of each cylinder's ``rod`` (:meth:`Cylinder.from_rod`), zero where
    it has none; a number replaces that, and 0 leaves the big end out.
counterweights : sequence of Unbalance
    Unbalances on the crankshaft besides ``rotating_mass``; by default none.
shafts : sequence of Shaft
    Balance shafts; by default none.
mains : array_like, shape (n_mains,)
    Places of the main bearings along the crank, m, ascending; by default one between
    neighbouring throws and one at either end.
reference_z : float
    Plane about which moments are taken, m; by default midway between the first and the
    last cylinder. Moments depend on it where a force remains.
first_tdc_deg : number or str
    Crank angle at which cylinder 1 is at top dead centre, degrees.
firing_order : str or sequence of int
    Firing order of the engine, such as ``"1-3-4-2"``, with ``+`` between cylinders that fire
    together: ``"1+4-2+3"``. :meth:`firing` uses it, and files keep it. Dashes of any kind, spaces
    or nothing stand between cylinders; ``"A1-B1-A2"`` counts in each bank, A that of cylinder 1,
    and ``"1L-1R"`` in the left and the right one.
strokes : {4, 2}
    Strokes of a cycle, 4 or 2.
name : str
    Name of the engine, in which ``{bank_angle}`` stands for the bank angle and ``{pins}``
    for "shared pins" or "split pins".
source : str
    Source of the layout.
orders : number, sequence of numbers or "auto"
    Multiples of crank speed, whole or half (0.5, of which gas pressure alone makes any);
    by default the few that reach ``rtol``.
rtol : float
    For ``orders="auto"``: what the omitted orders may add up to, relative to the
    largest m·r·ω² of any cylinder (its reciprocating or its rotating mass), times the
    longest lever for moments and the crank radius for torque; by default 1e-9. Gas
    pressure counts apart, relative to the largest gas torque of a cylinder, and to 1e-3
    at best, since its orders decline slowly; ``error_bound`` has what is left out of
    both.
spectrum : mapping of int to complex
    Order → amplitude of one cylinder's force over ω², in kg·m, in place of every cylinder's
    slider-crank: one measurement or simulation, many layouts. ``rotating_mass`` still
    counts; torque is undefined then.
torque : bool
    False to leave out torque, in the result and in the choice of orders.
"""
"""Entries of parameters whose meaning is the same in several families of functions."""

_SECTION = re.compile(r"^([A-Z][\w ]*)\n-{3,}\n", re.MULTILINE)
_ENTRY = re.compile(r"^(\S.*)\n((?:[ \t]+\S.*\n|[ \t]*\n)*)", re.MULTILINE)
_DEFAULT = re.compile(r", (?:optional|default .*)$")
_STATED = re.compile(
    r"(?:[;,]| and)\sby\s+default.*?(?=[.;](?:\s|$))|(?<=\.)\sBy\s+default.*?\.(?=\s|$)", re.DOTALL
)
"""What a text says of the default."""
_REST = re.compile(r"^…|(?<=or )…")
"""What stands for the text of another function."""
COMPLETED = ("Returns", "Raises", "Warns")
"""Sections that a docstring may leave to that of another function."""


class Entry(NamedTuple):
    """Entry of a section."""

    words: str
    """What stands behind the name: type and default; of results the whole head."""
    text: str


_ROLE = re.compile(r":\w+:`~?([^`]*)`")
_UNIT = re.compile(r", (kg·m²|kg·m|kg|g·mm|m|N·m|N·s/m|N/m|N|Pa|Hz|rpm|degrees)(?![\w·/²])")


class Parameter(NamedTuple):
    """A parameter as its function declares it: by signature and docstring."""

    type: str
    """Type in words."""
    text: str
    """First sentence, without roles and default."""
    unit: str
    """Unit of numbers, as the text states it; may be empty."""
    default: str
    """Default in words; empty where there is none, or it is None or False."""

    @property
    def words(self) -> tuple[str, ...]:
        """Words that are taken, of a set of them or besides numbers."""
        return tuple(re.findall(r'"([^"]*)"', self.type))

    @property
    def meaning(self) -> str:
        """The text without the unit."""
        return _UNIT.sub("", self.text)

    @property
    def choices(self) -> tuple[str, ...]:
        """All that is taken, if that is a set; else empty."""
        if (braces := re.match(r"\{([^{}]*)\}(?= or sequence of these|$)", self.type)) is None:
            return self.words if re.fullmatch(r'"\w+"', self.type) else ()
        return self.words or tuple(braces[1].split(", "))


@functools.cache
def parameter(function: Any, name: str) -> Parameter:  # noqa: ANN401 - a function
    """Return what a function declares of one of its parameters."""
    if function.__doc__ is None:
        hint = "commands are made of docstrings, which python -OO drops; run python without it"
        raise ImportError(hint)
    head, text = entries(function.__doc__)[name]
    plain = _ROLE.sub(r"\1", " ".join(text.split()))
    stated = re.search(r"\b[Bb]y default (.*?)(?=[.;](?:\s|$))", plain)
    value = inspect.signature(function).parameters[name].default
    unit = _UNIT.search(plain)
    return Parameter(
        _DEFAULT.sub("", head),
        re.split(r"\.(?:\s|$)", _STATED.sub("", plain), maxsplit=1)[0],
        unit[1] if unit else "",
        stated[1] if stated else _plain(value),
    )


def _plain(value: object) -> str:
    """Return a default in words; empty for none."""
    if value is None or isinstance(value, bool) or value is inspect.Parameter.empty:
        return ""
    if isinstance(value, (tuple, list)):
        return ",".join(map(_plain, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def documented(*homes: object) -> Callable[[Function], Function]:
    """Return a decorator that completes a docstring from those of other functions.

    Parameters that the docstring lacks are those of the first home that has them, or of
    :data:`SHARED`, with the default that the signature has. Sections of :data:`COMPLETED` that it
    lacks are those of the first home. In an entry of its own ``…`` stands for the home's text: at
    the beginning, and behind "or".

    Parameters
    ----------
    *homes
        Functions, methods, classes, or docstrings.
    """

    def decorated(function: Function) -> Function:
        if function.__doc__:  # Python drops docstrings with -OO
            function.__doc__ = _completed(function, [*map(_text, homes), SHARED])
        return function

    return decorated


@functools.cache
def entries(docstring: str, title: str = "Parameters") -> dict[str, Entry]:
    """Return the entries of a section by name."""
    body = sections(docstring).get(title, "")
    result = dict[str, Entry]()
    for head, text in _ENTRY.findall(f"{body.strip()}\n"):
        names, colon, words = head.partition(" : ")
        entry = Entry(words if colon else head, text.replace("\n    ", "\n").strip())
        result |= dict.fromkeys(names.split(", ") if colon else [head], entry)
    return result


@functools.cache
def sections(docstring: str) -> dict[str, str]:
    """Return the sections of a docstring by title; what stands before them has an empty one."""
    before, *rest = _SECTION.split(inspect.cleandoc(docstring))
    return {"": before.strip()} | {
        title: body.strip() for title, body in zip(rest[::2], rest[1::2], strict=True)
    }


def _text(home: object) -> str:
    """Return the docstring of a home."""
    if isinstance(home, str):
        return home
    return getattr(home, "__func__", home).__doc__ or ""


def _completed(function: Any, homes: list[str]) -> str:  # noqa: ANN401 - a function
    """Return the docstring of a function, its parameters and sections completed."""
    present = dict(sections(function.__doc__))
    first = sections(homes[0])
    texts = dict[str, Entry]()
    for home in reversed(homes):
        texts |= entries(home)
    parameters = _entries(function, entries(function.__doc__), texts, entries(homes[0]))
    others = {title: present.get(title) or first.get(title, "") for title in COMPLETED}
    if function.__annotations__.get("return") in (None, "None"):
        others["Returns"] = ""
    for title in {*COMPLETED} & present.keys() & first.keys():
        at_home = entries(homes[0], title)
        others[title] = _written(
            (head, entry.words, _with_rest(entry.text, at_home.get(head)))
            for head, entry in entries(function.__doc__, title).items()
        )
    whole = {"": present.pop(""), "Parameters": _written(parameters), **others}
    whole |= {title: body for title, body in present.items() if title not in whole}
    return "\n\n".join(
        f"{title}\n{'-' * len(title)}\n{body}" if title else body
        for title, body in whole.items()
        if body
    )


def _entries(
    function: Any,  # noqa: ANN401 - a function
    present: dict[str, Entry],
    homes: dict[str, Entry],
    first: dict[str, Entry],
) -> Iterator[tuple[str, str, str]]:
    """Yield name, type and text of the parameters of a function, in their sequence."""
    code = function.__code__
    count = code.co_argcount + code.co_kwonlyargcount
    names = code.co_varnames[:count]
    values = function.__defaults__ or ()
    positional = names[code.co_argcount - len(values) : code.co_argcount]
    defaults = dict(zip(positional, values, strict=True))
    defaults |= function.__kwdefaults__ or {}
    for name in names:
        if name in present:
            yield name, present[name].words, _with_rest(present[name].text, homes.get(name))
        elif name in homes:
            words = _DEFAULT.sub("", homes[name].words)
            yield name, words + _default(defaults, name), homes[name].text
    yield from ((name, *entry) for name, entry in present.items() if name not in names)
    if code.co_flags & inspect.CO_VARKEYWORDS and "**options" not in present:
        others = (
            f"``{name}``{''.join(re.findall(', default .*', words))}: {text}"
            for name, (words, text) in first.items()
            if name not in names
        )
        of_home = Entry("dict, optional", "\n".join(others))
        yield ("**options", *homes.get("**options", of_home))


def _default(defaults: dict[str, Any], name: str) -> str:
    """Return how the head of an entry states the default."""
    if name not in defaults:
        return ""
    value = defaults[name]
    if value is None or value in ("", ()):
        return ", optional"
    return f', default "{value}"' if isinstance(value, str) else f", default {value!r}"


def _with_rest(text: str, home: Entry | None) -> str:
    """Return a text in which ``…`` stands for that of another function."""
    if home is None or not (at := _REST.search(text)):
        return text
    rest = home.text
    if "default" in text:
        rest = _STATED.sub("", rest).strip()
    if at.start():
        rest = rest[0].lower() + rest[1:]
    if text[at.end() :][:1] in (",", ";", "."):
        rest = rest.removesuffix(".")
    return textwrap.fill(f"{text[: at.start()]}{rest}{text[at.end() :]}", 92)


def _written(section: Iterator[tuple[str, str, str]]) -> str:
    """Return the entries of a section as text; neighbours of the same words and text are one."""
    joined = list[tuple[str, str, str]]()
    for name, words, text in section:
        if joined and joined[-1][1:] == (words, text) and words != name:
            joined[-1] = (f"{joined[-1][0]}, {name}", words, text)
        else:
            joined.append((name, words, text))
    return "\n".join(
        f"{name if words == name else f'{name} : {words}'}\n{textwrap.indent(text, '    ')}"
        for name, words, text in joined
    )
