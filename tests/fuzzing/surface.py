"""The public surface, enumerated: every function, constructor and method, and how to call it.

Subjects are ``crankpin.__all__`` and ``crankpin.results.__all__``; instances of the classes are
what sound calls return. A method that classes share is one target.
"""

# ruff: noqa: ANN401 - arguments of any type are the point

from __future__ import annotations

import contextlib
import copy
import functools
import inspect
import itertools
import operator
import pickle
import re
import reprlib
import sys
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import crankpin as cp
import numpy as np
from crankpin._support.drawing import Plot

from fuzzing.kinds import FEW, KEYWORDS, KINDS, SEEDS, Beside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

CLASSES: dict[str, type] = {
    name: kind
    for module in (cp, cp.results)
    for name in sorted(module.__all__)
    if isinstance(kind := getattr(module, name), type) and not issubclass(kind, Exception)
}
"""Every public class but the error."""
PICTURES = {"plot", "view", "save_html"}
"""Names of methods that draw."""
CHOICES = re.compile(r"\{([^{}]+)\}")
MOST_TRIED = 1000
"""Combinations of good values that are tried at most until one is taken."""


class Target(NamedTuple):
    """Something public that can be called: a function, a constructor or a method of classes."""

    label: str
    name: str
    owners: tuple[type, ...]
    of_class: bool
    function: Callable[..., Any]
    """As it stands in the module or in the class; :func:`bound` makes a method callable."""

    def __repr__(self) -> str:
        return self.label

    @property
    def parameters(self) -> tuple[inspect.Parameter, ...]:
        """Parameters without ``self``, the keywords in place of ``**options``."""
        return _parameters(self)

    @property
    def draws(self) -> bool:
        """True if it makes a picture."""
        return self.name in PICTURES

    def subjects(self, owner: type | None = None) -> list[Any]:
        """Return the instances whose method it is; None for a function or a constructor."""
        if self.of_class or not self.owners:
            return [None]
        owners = self.owners if owner is None else (owner,)
        return next((_KNOWN[each] for each in owners if each in _KNOWN), [])


@functools.cache
def _parameters(target: Target) -> tuple[inspect.Parameter, ...]:
    listed = list(inspect.signature(target.function).parameters.values())
    listed = listed[1:] if target.owners and not target.of_class else listed
    return tuple(each for parameter in listed for each in _spread(target, parameter))


def _spread(target: Target, parameter: inspect.Parameter) -> Iterator[inspect.Parameter]:
    """Yield a parameter, or in place of ``**options`` the keywords that it takes."""
    if parameter.kind is not parameter.VAR_KEYWORD:
        yield parameter
        return
    unpacked = re.fullmatch(r"Unpack\[(\w+)\]", str(parameter.annotation))
    if unpacked:
        fields = _class_named(unpacked[1]).__annotations__
    elif parameter.name == "changes":
        fields = {
            p.name: p.annotation for p in inspect.signature(target.owners[0]).parameters.values()
        }
    else:
        fields = dict.fromkeys(KEYWORDS.get(parameter.name, {}), "")
    for name, annotation in fields.items():
        yield inspect.Parameter(
            name, parameter.KEYWORD_ONLY, default=..., annotation=str(annotation)
        )


def _class_named(name: str) -> type:
    modules = [module for key, module in sys.modules.items() if key.startswith("crankpin.")]
    return next(kind for each in modules if isinstance(kind := vars(each).get(name), type))


def functions() -> Iterator[Target]:
    """Yield functions and constructors; classes of results have none."""
    for name in sorted(cp.__all__):
        value = getattr(cp, name)
        if name in CLASSES:
            yield Target(name, name, (value,), True, value)
        elif inspect.isfunction(value):
            yield Target(name, name, (), False, value)


def members(kinds: Mapping[str, type]) -> Iterator[Target]:
    """Yield the public methods of classes, those that several share once."""
    shared: dict[Any, list[type]] = {}
    pairs = [(kind, name) for kind in kinds.values() for name in dir(kind)]
    for kind, name in pairs:
        static = inspect.getattr_static(kind, name)
        if name.startswith("_"):
            continue
        if isinstance(static, (classmethod, staticmethod)):
            yield Target(f"{kind.__name__}.{name}", name, (kind,), True, getattr(kind, name))
        elif isinstance(static, Plot):
            yield Target(f"{kind.__name__}.plot", name, (kind,), False, getattr(kind, name))
        elif inspect.isfunction(static):
            shared.setdefault(static, []).append(kind)
    for function, owners in shared.items():
        label = f"{owners[0].__name__}.{function.__name__}"
        if len(owners) > 1:
            label = function.__qualname__
        yield Target(label, function.__name__, tuple(owners), False, function)


TARGETS = [*functions(), *members(CLASSES)]
EXCEPT = {
    "Engine": "made of what the core has: from_lists and other builders make engines",
    "ForceTable.from_csv": "needs a file of a maker: tests/model/test_forces.py",
    "ForceTable.from_unv": "needs a universal file: tests/model/test_forces.py",
    "ForceTable.to_unv": "writes a universal file: tests/model/test_forces.py",
    "BaseResponse.cancel": "raises: actuators act on a base that does not move",
    "BaseMotion.from_csv": "needs a file: tests/analysis/mounts/test_moving_base.py",
    "Soil.mount": "a base is a rectangle or a disc, at a height or place: test_soil.py",
    "Engine.with_link_rods": "master rods need shared crankpins: tests/model/test_link_rods.py",
    "Tolerances.about": "samples are about the engine's own plane",
    "ClosedForm.plot": "a formula has no picture",
    "WorstForce.plot": "one number has no picture",
    "Table.from_rows": "makes tables within the package, of what that computed",
}
"""Targets that are not called, each with its reason."""
CALLED = [each for each in TARGETS if not each.draws and each.label not in EXCEPT]
"""Targets that are called and make no picture."""


def properties(kind: type) -> list[str]:
    """Return the names of what is read of an instance: its fields and properties."""
    return [
        name
        for name in dir(kind)
        if not name.startswith("_") and not callable(getattr(kind, name, None))
    ]


# --- instances ----------------------------------------------------------------------------------


_KNOWN: dict[type, list[Any]] = {}


@functools.cache
def instances() -> Mapping[type, list[Any]]:
    """Return instances of every public class: what sound calls return, and parts of it."""
    for each in SEEDS:
        _KNOWN.setdefault(type(each), []).append(each)
    for each in SEEDS:
        _absorb_parts(each)
    for _ in range(len(CLASSES)):
        before = len(_KNOWN)
        for target in TARGETS:
            missing = {name for name, kind in CLASSES.items() if kind not in _KNOWN}
            makes = bool(_words(target.function) & missing)
            makes = makes or (target.of_class and target.owners[0] not in _KNOWN)
            if makes and target.subjects():
                with contextlib.suppress(ImportError):  # of a package that is not there
                    if call := sound(target):
                        _absorb(call.make())
        if len(_KNOWN) == before:
            break
    return _KNOWN


def _words(function: Any) -> set[str]:
    """Return the words of what a function returns, by its annotation."""
    annotation = getattr(function, "__annotations__", {}).get("return", "")
    return set(re.findall(r"\w+", str(annotation)))


def _absorb(value: Any) -> None:
    """Take an object, its items and its parts as instances of classes without one."""
    if isinstance(value, Mapping):
        value = tuple(value.values())
    if isinstance(value, (tuple, list)):
        for each in value[:3]:
            _absorb(each)
    elif type(value) in CLASSES.values() and type(value) not in _KNOWN:
        _KNOWN[type(value)] = [value]
        _absorb_parts(value)


def _absorb_parts(value: Any) -> None:
    kind = type(value)
    if hasattr(kind, "__getitem__"):
        with contextlib.suppress(cp.InputError):
            _absorb(list(itertools.islice(iter(value), 3)))
    for name in properties(kind):
        static = inspect.getattr_static(kind, name, None)
        getter = getattr(static, "fget", getattr(static, "func", None))
        missing = {each for each, of in CLASSES.items() if of not in _KNOWN}
        if getter is not None and _words(getter) & missing:
            _absorb(getattr(value, name, None))


# --- sound calls --------------------------------------------------------------------------------

Arguments = dict[str, Any]


class Call(NamedTuple):
    """A target, the instance whose method it is, and arguments by name."""

    target: Target
    subject: Any
    arguments: Arguments

    def __repr__(self) -> str:
        listed = ", ".join(f"{name}={shown(value)}" for name, value in self.arguments.items())
        return f"{self.target.label}({listed})"

    def make(self) -> Any:
        """Call, the var-positional argument unpacked and what precedes it by position."""
        function = (
            getattr(self.subject, self.target.name)
            if self.subject is not None
            else self.target.function
        )
        positional: list[Any] = []
        named = dict(self.arguments)
        parameters = self.target.parameters
        unpacked = any(p.kind is p.VAR_POSITIONAL and p.name in named for p in parameters)
        for parameter in parameters:
            if parameter.name not in named:
                continue
            if parameter.kind is parameter.VAR_POSITIONAL:
                values = named.pop(parameter.name)
                positional += values if isinstance(values, (list, tuple)) else [values]
            elif parameter.kind is parameter.POSITIONAL_ONLY or (
                unpacked and parameter.kind is parameter.POSITIONAL_OR_KEYWORD
            ):
                positional.append(named.pop(parameter.name))
        return function(*positional, **named)

    def changed(self, **arguments: Any) -> Call:
        """Return the call with other arguments."""
        return self._replace(arguments=self.arguments | arguments)

    def returns(self) -> bool:
        """Return whether it returns."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            try:
                self.make()
            except (ValueError, TypeError, OSError):
                return False
        return True


def shown(value: Any) -> str:
    """Text of a value, however deep or long."""
    try:
        return reprlib.repr(value)[:200]
    except ValueError:  # an integer too long for Python to write
        return f"<{type(value).__name__}>"


def is_needed(parameter: inspect.Parameter) -> bool:
    """Return whether a call must have an argument for it."""
    return parameter.default is parameter.empty and parameter.kind not in (
        parameter.VAR_POSITIONAL,
        parameter.VAR_KEYWORD,
    )


_SOUND: dict[tuple[Target, str, type | None], Call] = {}


def sound(target: Target, about: str = "", owner: type | None = None) -> Call | None:
    """Return a call that returns; ``about`` is one of its arguments. None if there is none."""
    key = (target, about, owner)
    if key not in _SOUND:
        tried = itertools.islice(_attempts(target, about, owner), MOST_TRIED)
        if call := next((each for each in tried if each.returns()), None):
            _SOUND[key] = call
    return _SOUND.get(key)


def _attempts(target: Target, about: str, owner: type | None) -> Iterator[Call]:
    """Yield calls to try: with what is needed, then with one optional argument beside it."""
    names = [each.name for each in target.parameters]
    needed = [each.name for each in target.parameters if is_needed(each)]
    for subject in target.subjects(owner):
        bases = list(_filled(target, needed))
        if about:
            base = sound(target, "", owner)
            if base is None:
                return
            if about in base.arguments:
                yield base
                continue
            plain = {name: base.arguments[name] for name in base.arguments if name in needed}
            bases = [
                arguments
                for begun in (base.arguments, plain)
                for arguments in _beside(target, begun, about)
            ]
        yield from (Call(target, subject, each) for each in bases)
        for name in names:
            for arguments in bases:
                if name not in arguments:
                    yield from (
                        Call(target, subject, each) for each in _beside(target, arguments, name)
                    )


def _filled(target: Target, names: list[str]) -> Iterator[Arguments]:
    """Yield all combinations of values of some parameters, without others that these exclude."""
    fixed = {name: value for name, value in FEW.items() if _parameter(target, name)}
    choices = [
        candidates(target, parameter) for name in names if (parameter := _parameter(target, name))
    ]
    for values in itertools.product(*choices):
        arguments: Arguments = dict(fixed)
        for name, value in zip(names, values, strict=True):
            arguments = _with(arguments, name, value)
        yield _without_gaps(arguments)


def _beside(target: Target, base: Arguments, name: str) -> Iterator[Arguments]:
    parameter = _parameter(target, name)
    for value in candidates(target, parameter) if parameter else ():
        arguments = _without_gaps(_with(base, name, value))
        if all(_parameter(target, each) for each in arguments):
            yield arguments


def _with(arguments: Arguments, name: str, value: Any) -> Arguments:
    if isinstance(value, Beside):
        return arguments | {name: value.value} | value.others
    return arguments | {name: value}


def _without_gaps(arguments: Arguments) -> Arguments:
    return {name: value for name, value in arguments.items() if value is not ...}


def _parameter(target: Target, name: str) -> inspect.Parameter | None:
    return next((each for each in target.parameters if each.name == name), None)


def plain_call(subject: Any, name: str) -> Call:
    """Return the call of a method with the first values of what it needs, sound or not."""
    function = getattr(type(subject), name)
    target = Target(name, name, (type(subject),), False, function)
    needed = [each.name for each in target.parameters if is_needed(each)]
    return Call(target, subject, next(_filled(target, needed)))


def candidates(target: Target, parameter: inspect.Parameter) -> list[Any]:
    """Return values that a parameter may take."""
    name, annotation = parameter.name, str(parameter.annotation)
    for key in (f"{target.name.partition('_')[0]}.{name}", f"{name}: {annotation}", name):
        if key in KINDS:
            return [*KINDS[key], *_choices(target, parameter)]
    for names in KEYWORDS.values():
        if name in names:
            return [names[name]]
    if choices := _choices(target, parameter):
        return choices
    words = re.findall(r"\w+", annotation)
    for word in words:
        if word in CLASSES:
            known = _KNOWN.get(CLASSES[word], [])
            several = re.search(r"Sequence|Iterable|tuple", annotation)
            return [*([each] for each in known), *known] if several else known
    if "bool" in words:
        return [True, False]
    return []


def _choices(target: Target, parameter: inspect.Parameter) -> list[Any]:
    """Return the words that an annotation or a docstring offers."""
    listed = re.search(r"Literal\[([^\[\]]+)\]", str(parameter.annotation))
    if not listed:
        text = inspect.getdoc(target.function) or ""
        line = re.search(rf"^(?:\w+, )*{parameter.name}(?:, \w+)* : (.*)$", text, re.MULTILINE)
        listed = CHOICES.search(line[1]) if line else None
    words: list[Any] = re.findall(r"[\"']([^\"']+)[\"']", listed[1]) if listed else []
    if listed and not words:
        words = [int(each) for each in re.findall(r"\d+", listed[1])]
    return words


# --- operators ----------------------------------------------------------------------------------

OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "in": operator.contains,
    "[]": operator.getitem,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "//": operator.floordiv,
    "%": operator.mod,
    "**": operator.pow,
    "@": operator.matmul,
    "&": operator.and_,
    "|": operator.or_,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "r+": lambda subject, value: value + subject,
    "r*": lambda subject, value: value * subject,
    "r<": lambda subject, value: value < subject,
    "inside": lambda subject, value: subject in value,
}
"""What ``subject OPERATOR value`` calls; a TypeError of an operand is Python's or NumPy's."""
ALONE: dict[str, Callable[[Any], Any]] = {
    "len": len,
    "iter": lambda subject: list(itertools.islice(iter(subject), 1000)),
    "reversed": lambda subject: list(itertools.islice(reversed(subject), 1000)),
    "bool": bool,
    "hash": hash,
    "repr": repr,
    "str": str,
    "format": lambda subject: f"{subject:>10}",
    "dir": dir,
    "abs": abs,
    "-": operator.neg,
    "+": operator.pos,
    "~": operator.invert,
    "int": int,
    "float": float,
    "complex": complex,
    "index": operator.index,
    "round": round,
    "bytes": bytes,
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda subject: pickle.loads(pickle.dumps(subject)),  # noqa: S301 - its own
    "array": np.asarray,
}
"""What ``OPERATOR subject`` calls."""
