"""Base class of results: frozen objects that compare, hash, pickle and copy by their fields."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NoReturn, Self, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Item = TypeVar("Item")


class Frozen:
    """Base class whose attributes are set once, by the constructor.

    A class that lists its constructor's arguments in ``_fields``, and keeps each as an attribute
    of the same name, compares, hashes and pickles by them.
    """

    _fields: ClassVar[tuple[str, ...]] = ()
    """Arguments of the constructor, in order: together they determine the object."""

    def _set(self, **attributes: object) -> None:
        self.__dict__.update(attributes)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"{type(self).__name__} is frozen: {name} cannot be set")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"{type(self).__name__} is frozen: {name} cannot be deleted")

    def _values_of_fields(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self._fields)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Frozen) or type(other) is not type(self):
            return NotImplemented
        return _equal(self._values_of_fields(), other._values_of_fields())

    def __hash__(self) -> int:
        return hash((type(self).__name__, _hashable(self._values_of_fields())))

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), self._values_of_fields())

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


class Listed(Frozen, Generic[Item]):
    """Base class of results that are a sequence: of the items of one attribute."""

    _items: ClassVar[str]
    """Name of the attribute."""

    def _listed(self) -> tuple[Item, ...]:
        return getattr(self, self._items)  # type: ignore[no-any-return]

    def __len__(self) -> int:
        return len(self._listed())

    def __getitem__(self, place: int) -> Item:
        return self._listed()[place]

    def __iter__(self) -> Iterator[Item]:
        return iter(self._listed())


def read_only(values: NDArray[Any]) -> NDArray[Any]:
    """Make an array read-only; return it."""
    values.setflags(write=False)
    return values


def _equal(a: Any, b: Any) -> bool:  # noqa: ANN401 - values of fields
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return type(a) is type(b) and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(_equal(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return list(a) == list(b) and all(_equal(a[key], b[key]) for key in a)
    return bool(a == b)


def _hashable(value: Any) -> Any:  # noqa: ANN401 - values of fields
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, tuple):
        return tuple(map(_hashable, value))
    if isinstance(value, Mapping):
        return tuple((key, _hashable(item)) for key, item in value.items())
    return value
