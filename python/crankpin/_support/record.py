"""Base classes of results and inputs: frozen records that compare, hash, pickle and copy."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import textwrap
from collections.abc import Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType
from typing import Any, ClassVar, Generic, Literal, Self, TypeVar, dataclass_transform, overload

import numpy as np

from crankpin._core import InputError
from crankpin._support import calls, inputs

Item = TypeVar("Item")

_MUTABLE = re.compile(r"NDArray|Mapping|dict\[|list\[")
_OF_DATACLASSES = {"__dataclass_fields__", "__dataclass_params__", "__replace__"}
"""Attributes by which ``dataclasses.replace`` and ``copy.replace`` take an object."""


class AbsentError(InputError, AttributeError):
    """A quantity that this object does not have; ``hasattr`` is False for it."""


class AbsentItemError(InputError, KeyError, IndexError):
    """A key or an index that nothing has; what looks items up takes it as any other."""

    __str__ = InputError.__str__


class FieldsDocumented:
    """Docstring of a record with a list of its fields, which Python keeps no docstrings of.

    Read from the source on access, as by ``help``: importing the package takes no time for it.
    """

    SECTIONS = re.compile(r"^(?:Parameters|Raises|Warns|Notes|Examples)\n-", re.MULTILINE)
    TYPES = (
        (re.compile(r"NDArray\[np\.([a-z]+)[_\d]+\]"), r"ndarray of \1"),
        (re.compile(r"Literal\[([^\[\]]+)\]"), r"\1"),
        (re.compile(r"tuple\[(\w+), \.\.\.\]"), r"tuple of \1"),
        (re.compile(r"tuple\[([\w, ]+)\]"), r"(\1)"),
        (re.compile(r"Mapping\[(\w+), ([^\[\]]+)\]"), r"mapping of \1 to \2"),
        (re.compile(r" \| "), " or "),
    )
    """Text of an annotation → its text in docstrings."""

    def __init__(self, text: str) -> None:
        self.text = inspect.cleandoc(text)

    def __get__(self, record: object, kind: type[Record]) -> str:
        """Return the docstring, with the fields of a class whose parameters it does not have."""
        section = self.SECTIONS.search(self.text)
        if section is not None and section.group().startswith("Parameters"):
            return self.text
        fields = "".join(
            f"{name} : {written}\n{textwrap.indent(about, '    ')}\n"
            for base in reversed(kind.__mro__)
            for name, written, about in self.of_class(base)
        )
        if not fields:
            return self.text
        at = len(self.text) if section is None else section.start()
        before, after = self.text[:at].rstrip(), self.text[at:]
        return f"{before}\n\nAttributes\n----------\n{fields}\n{after}".rstrip()

    def of_class(self, kind: type) -> Iterator[tuple[str, str, str]]:
        """Yield name, type and docstring of the fields that a class adds."""
        if not (issubclass(kind, Record) and vars(kind).get("_fields")):
            return
        try:
            (node,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
        except (OSError, TypeError, SyntaxError):  # where there is no source
            return
        names = {field.name for field in kind._fields if not field.name.startswith("_")}
        for field, text in pairwise(node.body):  # type: ignore[attr-defined] # of a class
            match field, text:
                case (
                    ast.AnnAssign(target=ast.Name(id=name)),
                    ast.Expr(value=ast.Constant(value=str(about))),
                ) if name in names:
                    written = ast.unparse(field.annotation)
                    for pattern, words in self.TYPES:
                        while (plainer := pattern.sub(words, written)) != written:
                            written = plainer  # an inner one first
                    yield name, written, inspect.cleandoc(about)


def computed(*, init: Literal[False] = False) -> Any:  # noqa: ANN401 - as of any field
    """Declare a field that a record computes: no argument, neither compared nor pickled."""
    return dataclasses.field(init=init, compare=False, repr=False)


@dataclass_transform(
    frozen_default=True, eq_default=False, field_specifiers=(dataclasses.field, computed)
)
class Record:
    """Base class whose subclasses are frozen dataclasses with read-only arrays.

    A subclass lists its fields; everything else follows from them: the constructor, equality, hash,
    pickle and copies. Results have no ``replace``, and are no dataclasses to others: a field that
    changes alone would leave the numbers of another question under its name.

    Fields declared with ``field(compare=False)`` do not count in equality and hash, fields with
    ``field(init=False)`` not in pickles either. Values derived from the fields are cached
    properties. Arrays in the fields are made read-only in place (an array that the caller keeps
    must be copied before), lists become tuples, and mappings read-only.
    """

    _fields: ClassVar[tuple[dataclasses.Field[Any], ...]] = ()
    _mutable: ClassVar[tuple[str, ...]] = ()
    """Names of the fields whose values could be changed: arrays, lists and mappings."""

    def __init_subclass__(cls, **options: object) -> None:
        super().__init_subclass__(**options)
        dataclasses.dataclass(frozen=True, eq=False, repr=False)(cls)
        cls._fields = dataclasses.fields(cls)  # type: ignore[arg-type] # made one above
        cls._mutable = tuple(f.name for f in cls._fields if f.init and _MUTABLE.search(str(f.type)))
        calls.guide(cls)
        if not hasattr(cls, "replace"):
            for name in {*vars(cls)} & _OF_DATACLASSES:
                delattr(cls, name)
        if cls.__doc__:  # Python drops docstrings with -OO
            cls.__doc__ = FieldsDocumented(cls.__doc__)  # type: ignore[assignment] # gives text

    def __post_init__(self) -> None:
        for name in self._mutable:
            object.__setattr__(self, name, read_only(getattr(self, name)))

    __array_ufunc__: Any = None
    """None, so that NumPy leaves comparison and arithmetic with arrays to the record."""

    def _compared(self) -> tuple[Any, ...]:
        return tuple(getattr(self, field.name) for field in self._fields if field.compare)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, np.ndarray):
            return False  # a masked array would take the record for a sequence
        if not isinstance(other, Record) or type(other) is not type(self):
            return NotImplemented
        return equal(self._compared(), other._compared())

    def __hash__(self) -> int:
        return hash((type(self).__name__, _hashable(self._compared())))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuilt, (type(self), _plain(_values(self))))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __repr__(self) -> str:
        pairs = ((field.name, getattr(self, field.name)) for field in self._fields if field.repr)
        values = ", ".join(f"{name}={value!r}" for name, value in pairs)
        return f"{type(self).__name__}({values})"


class Input(Record):
    """Base class of records that describe what is computed, not what came out."""

    def replace(self, **changes: object) -> Self:
        """Return a copy with some fields changed.

        Parameters
        ----------
        **changes : dict, optional
            New values of fields, by name.

        Returns
        -------
        Input
            A copy of the same class; fields that are not named are unchanged.

        Raises
        ------
        InputError
            If there is no such field, or a value is out of range.
        """
        names = [field.name for field in self._fields if field.init]
        for name in changes:
            inputs.one_of("replace", name, names)
        return changed(self, **changes)


class Listed(Generic[Item]):
    """Mixin of records that are the sequence of the items of one field, a tuple."""

    _items: ClassVar[str]
    """Name of the field."""
    _item: ClassVar[type] = object
    """Class of the items."""
    _maker: ClassVar[str] = ""
    """Function that makes such records of one item or more; empty if anyone may, of any."""

    def __post_init__(self) -> None:
        entries = self._listed()
        sound = isinstance(entries, tuple) and all(isinstance(item, self._item) for item in entries)
        if self._maker and not (sound and entries):
            raise inputs.rejected(self._items, entries, f"use {self._maker}")
        super().__post_init__()  # type: ignore[misc] # of the record that this is mixed into

    def _listed(self) -> tuple[Item, ...]:
        return getattr(self, self._items)  # type: ignore[no-any-return]

    def __len__(self) -> int:
        return len(self._listed())

    @overload
    def __getitem__(self, place: int) -> Item: ...

    @overload
    def __getitem__(self, place: slice) -> tuple[Item, ...]: ...

    def __getitem__(self, place: int | slice) -> Item | tuple[Item, ...]:
        entries = self._listed()
        key: Any = item_key(place, len(entries))
        return entries[key]  # type: ignore[no-any-return]

    def __iter__(self) -> Iterator[Item]:
        return iter(self._listed())


def item_key(place: Any, count: int, name: str = "index") -> Any:  # noqa: ANN401 - an int or a slice
    """Return an index or a slice of a sequence, or raise an error that names it."""
    hint = f"give an index from 0 to {count - 1}, or a slice"
    try:
        if isinstance(place, slice):
            place.indices(count)
            return place
        index = inputs.whole(name, place)
    except (TypeError, ValueError):
        raise inputs.rejected(name, place, hint, AbsentItemError) from None
    if not -count <= index < count:
        raise inputs.rejected(name, index, hint, AbsentItemError)
    return index


Changed = TypeVar("Changed", bound=Record)


def changed(record: Changed, **changes: object) -> Changed:
    """Return a copy of a record with some fields changed, whose numbers must be of these fields."""
    return type(record)(**_values(record) | changes)


def read_only(values: Item) -> Item:
    """Return values that cannot be changed, to the bottom.

    Arrays are made read-only in place; lists become tuples, mappings read-only views of copies.
    """
    frozen: Any = values
    if isinstance(values, np.ndarray):
        values.setflags(write=False)
    elif type(values) in (tuple, list):
        frozen = tuple(map(read_only, values))  # type: ignore[call-overload]
    elif isinstance(values, Mapping):
        frozen = MappingProxyType({key: read_only(inner) for key, inner in values.items()})
    return frozen  # type: ignore[no-any-return]


def _plain(value: object) -> object:
    """Return a value that can be pickled: read-only mappings cannot."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items()}
    return tuple(map(_plain, value)) if type(value) is tuple else value


def equal(a: Any, b: Any) -> bool:  # noqa: ANN401 - values of fields
    """Return whether two values are equal; arrays by their numbers, NaN equal to NaN."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return type(a) is type(b) and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(equal(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return list(a) == list(b) and all(equal(a[key], b[key]) for key in a)
    return bool(a == b)


def _hashable(value: object) -> object:
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, tuple):
        return tuple(map(_hashable, value))
    if isinstance(value, Mapping):
        return tuple((key, _hashable(item)) for key, item in value.items())
    return value


def _values(record: Record) -> dict[str, Any]:
    """Return the values of the fields that the constructor takes, exact where one says so."""
    return {
        field.name: getattr(record, field.metadata.get("exact", field.name))
        for field in record._fields
        if field.init
    }


def _rebuilt(kind: type[Record], fields: dict[str, Any]) -> Record:
    return kind(**fields)
