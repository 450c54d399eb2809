"""Base classes of results: frozen records that compare, hash, pickle and copy by their fields."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, dataclass_transform

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from crankpin._support.tables import Table

Item = TypeVar("Item")


class AbsentError(InputError, AttributeError):
    """A quantity that this object does not have; ``hasattr`` is False for it."""


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(dataclasses.field,))
class Record:
    """Base class whose subclasses are frozen dataclasses with read-only arrays.

    A subclass lists its fields; everything else follows from them: the constructor, equality, hash,
    pickle, copies and ``replace``. Fields declared with ``field(compare=False)`` do not count in
    equality and hash, fields with ``field(init=False)`` not in pickles either. Values derived from
    the fields are cached properties. Arrays in the fields are made read-only in place: an array
    that the caller keeps must be copied before.
    """

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]
    _arrays: ClassVar[tuple[str, ...]] = ()
    """Names of the fields that hold arrays."""

    def __init_subclass__(cls, **options: Any) -> None:  # noqa: ANN401 - of other base classes
        super().__init_subclass__(**options)
        dataclasses.dataclass(frozen=True, eq=False, repr=False)(cls)
        fields = dataclasses.fields(cls)
        cls._arrays = tuple(f.name for f in fields if f.init and "NDArray" in str(f.type))

    def __post_init__(self) -> None:
        for name in self._arrays:
            read_only(getattr(self, name))

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401 - values of fields
        """Return a copy with some fields changed."""
        return dataclasses.replace(self, **changes)

    def _compared(self) -> tuple[Any, ...]:
        fields = self.__dataclass_fields__.values()
        return tuple(getattr(self, each.name) for each in fields if each.compare)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record) or type(other) is not type(self):
            return NotImplemented
        return equal(self._compared(), other._compared())

    def __hash__(self) -> int:
        return hash((type(self).__name__, _hashable(self._compared())))

    def __reduce__(self) -> tuple[Any, ...]:
        fields = dataclasses.fields(self)
        return (_rebuilt, (type(self), {f.name: getattr(self, f.name) for f in fields if f.init}))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)
        shown = ((each.name, getattr(self, each.name)) for each in fields if each.repr)
        values = ", ".join(f"{name}={value!r}" for name, value in shown)
        return f"{type(self).__name__}({values})"


class Tabled(Record):
    """Base class of records that are shown by their ``table``."""

    @property
    def table(self) -> Table:
        """Table that is shown: columns of numbers with units."""
        raise NotImplementedError

    def to_pandas(self) -> pd.DataFrame:
        """Return the table as a DataFrame (needs pandas)."""
        return self.table.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """Return the table as a Dataset with units, over its rows (needs xarray)."""
        return self.table.to_xarray()

    def __repr__(self) -> str:
        return repr(self.table)

    def _repr_html_(self) -> str | None:
        return self.table._repr_html_()


class Listed(Generic[Item]):
    """Mixin of records that are the sequence of the items of one field, a tuple."""

    _items: ClassVar[str]
    """Name of the field."""
    _item: ClassVar[type] = object
    """Class of the items."""
    _maker: ClassVar[str] = ""
    """Function that makes such records of one item or more; empty if anyone may, of any."""

    def __post_init__(self) -> None:
        listed = self._listed()
        sound = isinstance(listed, tuple) and all(isinstance(each, self._item) for each in listed)
        if self._maker and not (sound and listed):
            raise inputs.rejected(self._items, listed, f"use {self._maker}")
        super().__post_init__()  # type: ignore[misc] # of the record that this is mixed into

    def _listed(self) -> tuple[Item, ...]:
        return getattr(self, self._items)  # type: ignore[no-any-return]

    def __len__(self) -> int:
        return len(self._listed())

    def __getitem__(self, place: int) -> Item:
        return self._listed()[place]

    def __iter__(self) -> Iterator[Item]:
        return iter(self._listed())


def read_only(values: Item) -> Item:
    """Make an array, or the arrays of a tuple or mapping, read-only in place; return it."""
    if isinstance(values, np.ndarray):
        values.setflags(write=False)
    elif isinstance(values, tuple):
        for each in values:
            read_only(each)
    elif isinstance(values, Mapping):
        read_only(tuple(values.values()))
    return values


def equal(a: Any, b: Any) -> bool:  # noqa: ANN401 - values of fields
    """Return whether two values are equal; arrays by their numbers, NaN equal to NaN."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return type(a) is type(b) and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(equal(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return list(a) == list(b) and all(equal(a[key], b[key]) for key in a)
    return bool(a == b)


def _hashable(value: Any) -> Any:  # noqa: ANN401 - values of fields
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, tuple):
        return tuple(map(_hashable, value))
    if isinstance(value, Mapping):
        return tuple((key, _hashable(item)) for key, item in value.items())
    return value


def _rebuilt(kind: type[Record], fields: dict[str, Any]) -> Record:
    return kind(**fields)
