"""What builders of layouts take beyond one cylinder at one spacing: parts and places of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from crankpin._support import inputs
from crankpin.model.cylinder import Cylinder
from crankpin.model.data import EngineData, big_end, core_of_lists

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from crankpin import _core

Cylinders: TypeAlias = "Cylinder | Sequence[Cylinder] | Mapping[str, Cylinder]"
"""Parts of all cylinders, of each by number, or of each bank by name."""
Built = TypeVar("Built", bound=EngineData)

CYLINDERS = "give a crankpin.Cylinder, one for each cylinder, or a mapping of banks to cylinders"
SPACING = "give metres, or a list with the distance of each throw from the one before it"


def one_of(cylinder: object) -> Any:  # noqa: ANN401 - a cylinder, or what is to be rejected
    """Return the cylinder with which a layout is built, before others take its place."""
    if isinstance(cylinder, Mapping):
        return next(iter(cylinder.values()), None)
    if isinstance(cylinder, Cylinder) or not isinstance(cylinder, Iterable):
        return cylinder
    listed = inputs.items("cylinder", cylinder, CYLINDERS)
    return listed[0] if listed else None


def pitch(spacing: ArrayLike) -> float:
    """Return the spacing with which a layout is built: of unequal distances their mean."""
    if not inputs.is_listed(spacing):
        return inputs.number("spacing", spacing)
    listed = inputs.listed_numbers("spacing", spacing)
    if not listed or not all(0.0 < each < np.inf for each in listed):
        raise inputs.rejected("spacing", spacing, SPACING)
    return sum(listed) / len(listed)


def furnished(
    engine: Built,
    cylinder: object,
    spacing: ArrayLike,
    rotating_mass: ArrayLike | None,
    stagger: float = 0.0,
    firing_order: str | Iterable[int] = "",
) -> Built:
    """Return an engine of one cylinder and even spacing with the parts and places of each.

    Parameters
    ----------
    engine
        The engine, without a firing order; of unequal spacing it has no bank stagger.
    cylinder
        Parts of all cylinders, of each, or of each bank by name.
    spacing
        Distance of neighbouring throws, m, or that of each throw from the one before it.
    rotating_mass
        As given to the builder, kg; None for that of the rods.
    stagger
        How far the left bank stands behind the right, m.
    firing_order
        Its firing order, in which dummy pistons have no place.
    """
    if not inputs.is_listed(spacing) and isinstance(cylinder, Cylinder):
        return _fired(engine, firing_order)
    each, z = _each(engine, cylinder), engine.z
    if inputs.is_listed(spacing):
        listed = inputs.listed_numbers("spacing", spacing)
        throw = np.rint(z / pitch(spacing)).astype(int)
        if throw.max() != len(listed):
            hint = f"give {throw.max()}, one less than throws along the crank"
            raise inputs.faulty("spacing", f"has {len(listed)} distances", hint)
        behind = np.isin(np.arange(len(z)) + 1, engine.banks.get("left", ()))
        z = np.concatenate([[0.0], np.cumsum(listed)])[throw] + stagger * behind
    masses = None if rotating_mass is not None else [big_end(one) for one in each]
    return _fired(engine.replace(cylinder=each, z=z, rotating_mass=masses), firing_order)


def _fired(engine: Built, firing_order: str | Iterable[int]) -> Built:
    return type(engine)(engine._core, "", "", firing_order, engine.strokes)


def _each(engine: EngineData, cylinder: object) -> list[Cylinder]:
    """Return the parts of each cylinder."""
    count, listed = len(engine), list[object]()
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
        listed = [cylinder[bank_of[number]] for number in range(1, count + 1)]
    else:
        listed = inputs.items("cylinder", cylinder, CYLINDERS)
    if len(listed) != count:
        hint = f"give one, or {count}"
        raise inputs.faulty("cylinder", f"has {len(listed)} entries", hint)
    found = [one for one in listed if isinstance(one, Cylinder)]
    if len(found) < count:
        raise inputs.rejected("cylinder", cylinder, CYLINDERS)
    return found


def without(core: _core.Engine, cylinder: Cylinder, absent: object) -> _core.Engine:
    """Return a vee without some of its cylinders, which are numbered anew.

    Parameters
    ----------
    core
        The vee with two cylinders on every throw.
    cylinder
        Its cylinder.
    absent
        Numbers of the cylinders that are not there.
    """
    hint = "give numbers of cylinders, such as [6]"
    listed = [inputs.whole("absent", each) for each in inputs.items("absent", absent, hint)]
    count = len(core.z)
    for number in listed:
        if not 1 <= number <= count:
            raise inputs.rejected("absent", number, f"the whole vee has cylinders 1 to {count}")
    kept = [k for k in range(count) if k + 1 not in listed]
    if not kept:
        raise inputs.rejected("absent", listed, "leave one cylinder at least")
    tdc, bank = core.exact_angles
    return core_of_lists(
        cylinder,
        [tdc[k] for k in kept],
        None,
        [bank[k] for k in kept],
        core.z[kept],
        core.rotating_mass[kept],
        mains=None,
        reference_z=None,
        bank=[core.bank[k] for k in kept],
    )
