"""Parts of each cylinder, crankpin and bank in the builders of layouts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from crankpin._support import inputs
from crankpin.model.cylinder import Cylinder
from crankpin.model.data import EngineData, big_end

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Cylinders: TypeAlias = "Cylinder | Sequence[Cylinder] | Mapping[str, Cylinder]"
"""Parts of all cylinders, of each by number, or of each bank by name."""
Built = TypeVar("Built", bound=EngineData)

CYLINDERS = "give a crankpin.Cylinder, one for each cylinder, or a mapping of banks to cylinders"


def one_of(cylinder: object) -> Any:  # noqa: ANN401 - a cylinder, or what is to be rejected
    """Return the cylinder with which a layout is built, before others take its place."""
    if isinstance(cylinder, Mapping):
        return next(iter(cylinder.values()), None)
    if isinstance(cylinder, Cylinder) or not isinstance(cylinder, Iterable):
        return cylinder
    entries = inputs.items("cylinder", cylinder, CYLINDERS)
    return entries[0] if entries else None


def furnished(
    engine: Built,
    cylinder: object,
    rotating_mass: ArrayLike | None,
    firing_order: str | Iterable[int] = "",
) -> Built:
    """Return an engine of one cylinder with the parts of each.

    Parameters
    ----------
    engine
        The engine, without a firing order.
    cylinder
        Parts of all cylinders, of each, or of each bank by name.
    rotating_mass
        As given to the builder, kg; None for that of the rods.
    firing_order
        Its firing order, in which dummy pistons have no place.
    """
    if isinstance(cylinder, Cylinder):
        return _fired(engine, firing_order)
    cylinders = _each(engine, cylinder)
    masses = None if rotating_mass is not None else [big_end(one) for one in cylinders]
    return _fired(engine.replace(cylinder=cylinders, rotating_mass=masses), firing_order)


def _fired(engine: Built, firing_order: str | Iterable[int]) -> Built:
    return type(engine)(engine._core, "", "", firing_order, engine.strokes)


def _each(engine: EngineData, cylinder: object) -> list[Cylinder]:
    """Return the parts of each cylinder."""
    count, entries = len(engine), list[object]()
    if isinstance(cylinder, Cylinder):
        return [cylinder] * count
    if isinstance(cylinder, Mapping):
        banks = engine.banks
        for name in cylinder:
            inputs.one_of("cylinder", name, banks)
        for name in banks:
            if name not in cylinder:
                raise inputs.faulty("cylinder", f'has none for "{name}"', CYLINDERS)
        bank_of = {number: name for name, numbers in banks.items() for number in numbers}
        entries = [cylinder[bank_of[number]] for number in range(1, count + 1)]
    else:
        entries = inputs.items("cylinder", cylinder, CYLINDERS)
    if len(entries) != count:
        hint = f"give one, or {count}"
        raise inputs.faulty("cylinder", f"has {len(entries)} entries", hint)
    cylinders = [one for one in entries if isinstance(one, Cylinder)]
    if len(cylinders) < count:
        raise inputs.rejected("cylinder", cylinder, CYLINDERS)
    return cylinders
