"""What people type, in the form the core takes; and the warning that units were mixed up."""

from __future__ import annotations

import operator
import warnings
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from crankpin._core import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Angle: TypeAlias = float | Fraction | str
"""Degrees: a number, a ``Fraction``, or a string such as ``"360/7"``."""

Angles: TypeAlias = "Sequence[Angle] | NDArray[np.float64]"
Orders: TypeAlias = "int | Iterable[int] | Literal['auto']"
Spectrum: TypeAlias = Mapping[int, complex]
"""Order → amplitude of one cylinder's force over ω², kg·m."""

FASTEST_PISTON = 60.0
"""Mean piston speed, m/s, above which no engine runs: Formula 1 stays below 30."""


def vector(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return a contiguous one-dimensional array of floats; a scalar becomes a single value."""
    try:
        # At least one dimension: a scalar becomes a single value.
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name} = {shorten(values)}: give numbers ({error})") from None
    if array.ndim > 1:
        raise InputError(f"{name} has shape {array.shape}: give one dimension")
    return array


def number(name: str, value: Any) -> float:  # noqa: ANN401 - anything that float() takes
    """Return a float."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name} = {shorten(value)}: give a number ({error})") from None


def per_item(name: str, values: ArrayLike, count: int) -> list[float]:
    """Return one float for each item; a scalar stands for all."""
    listed: list[float] = vector(name, values).tolist()
    return listed if np.ndim(values) else listed * count


def angles(name: str, values: Angles) -> list[Any]:
    """Return a list of angles."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"{name} = {shorten(values)}: give a list of degrees")
    return list(values)


def orders(values: Orders) -> list[int] | None:
    """Return a list of orders, or None for ``"auto"``."""
    if isinstance(values, str):
        if values == "auto":
            return None
        raise InputError(f'orders = "{values}": give whole numbers, or "auto"')
    listed = values if isinstance(values, Iterable) else [values]
    try:
        result = [operator.index(order) for order in listed]
    except TypeError:
        cure = "orders are whole multiples of crank speed, such as [1, 2]"
        raise InputError(f"orders = {shorten(values)}: {cure}") from None
    for order in result:
        if not 1 <= order < 2**32:
            raise InputError(f"orders = {order}: orders are whole multiples of crank speed, 1 or more")
    return result


def spectrum(values: Spectrum | None) -> list[tuple[int, complex]] | None:
    """Return (order, amplitude) pairs."""
    if values is None:
        return None
    if not isinstance(values, Mapping):
        raise InputError(f"spectrum = {shorten(values)}: give a mapping, such as {{1: 9.0, 2: 3.7}}")
    try:
        listed = orders(values) or []
        return [(n, complex(values[key])) for n, key in zip(listed, values, strict=True)]
    except (TypeError, ValueError) as error:
        raise InputError(f"spectrum = {shorten(values)}: {error}") from None


def warn_of_units(crank_radius: float, rpm: float) -> None:
    """Warn where a piston would be faster than in any engine."""
    mean_speed = 4.0 * crank_radius * rpm / 60.0
    if mean_speed > FASTEST_PISTON:
        warnings.warn(
            f"mean piston speed is {mean_speed:.0f} m/s, more than any engine's ({FASTEST_PISTON:.0f}): "
            "were lengths given in millimetres? They are metres here, and masses kilograms.",
            stacklevel=3,
        )


def shorten(value: object) -> str:
    """Return a value as text of readable length."""
    text = repr(value)
    return text if len(text) <= 80 else text[:79] + "…"
