"""Banks and throws of an engine, read off its lists."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._support.absent import AbsentError
from crankpin._support.frozen import read_only

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from crankpin import _core


def banks(core: _core.Engine) -> dict[str, tuple[int, ...]]:
    """Return cylinder numbers by bank: right and left if there are two, else bank 1, 2, …."""
    banks: dict[int, list[int]] = {}
    for number, bank in enumerate(core.bank, start=1):
        banks.setdefault(bank, []).append(number)
    names = ["right", "left"] if len(banks) == 2 else [f"bank {k + 1}" for k in sorted(banks)]
    return {name: tuple(banks[bank]) for name, bank in zip(names, sorted(banks), strict=True)}


def bank_angle_deg(core: _core.Engine) -> float:
    """Return the angle between two banks."""
    if len(banks(core)) != 2:
        raise _undefined("bank_angle_deg", core, "exactly two are needed")
    return core.bank_angle_deg


def throws_deg(core: _core.Engine) -> NDArray[np.float64]:
    """Return the pins of the only or the right bank, front to flywheel, from the front one."""
    found = banks(core)
    if len(found) > 2:
        raise _undefined("throws_deg", core, "one or two are needed; see pin_deg")
    pins = core.pin_deg[_along(core, next(iter(found.values())))]
    return read_only(_reduced(pins - pins[0]))


def pin_split_deg(core: _core.Engine) -> NDArray[np.float64]:
    """Return left pin minus right pin, throw by throw, in (−180, 180]."""
    found = banks(core)
    if len(found) != 2:
        raise _undefined("pin_split_deg", core, "exactly two are needed")
    right, left = (_along(core, numbers) for numbers in found.values())
    if len(right) != len(left):
        sizes = f"{len(right)} cylinders in the right bank and {len(left)} in the left"
        raise AbsentError(
            f"pin_split_deg is undefined for this engine: it has {sizes}; as many are needed"
        )
    split = _reduced(core.pin_deg[left] - core.pin_deg[right])
    return read_only(np.where(split > 180.0, split - 360.0, split))


def text(core: _core.Engine) -> str:
    """Return throws and pin split in words, where they are defined."""
    try:
        throws = "throws " + "-".join(f"{angle:.6g}" for angle in throws_deg(core)) + "°"
        splits = pin_split_deg(core)
    except AbsentError:
        return throws if len(banks(core)) == 1 else ""
    if not splits.any():
        return f"{throws}, shared pins"
    listed = [f"{split:.6g}" for split in splits]
    return f"{throws}, pins split by {listed[0] if len({*listed}) == 1 else ', '.join(listed)}°"


def _along(core: _core.Engine, numbers: tuple[int, ...]) -> NDArray[np.intp]:
    """Return the places in the lists of these cylinders, front to flywheel."""
    places = np.array(numbers) - 1
    return np.asarray(places[np.argsort(core.z[places], kind="stable")])


def _reduced(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return angles in [0, 360), rounded to what a sum of angles is known to."""
    return np.asarray((degrees % 360.0).round(10) % 360.0)


def _undefined(name: str, core: _core.Engine, needed: str) -> AbsentError:
    directions = list(dict.fromkeys(core.bank_deg.tolist()))
    listed = ", ".join(f"{each:.6g}°" for each in directions[:4])
    listed += ", …" if len(directions) > 4 else ""
    count = "one bank" if len(directions) == 1 else f"{len(directions)} banks"
    return AbsentError(f"{name} is undefined for this engine: it has {count} ({listed}); {needed}")
