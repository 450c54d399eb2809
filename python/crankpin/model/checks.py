"""Warnings of implausible figures: wrong units, and pins split to the wrong side.

Each check names the argument, its value and the likely mistake. The caller is warned
once per call, however many cylinders are alike.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.messages import Entry, Hint, of_core, warn, warn_of, warn_of_core

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    _Entry = tuple[str, str, Sequence[tuple[str, str | None]]]


EQUAL_INTERVALS = 1e-6
"""Degrees by which rounding alone does not part two firing intervals."""

UNITS_ASSUMED = "Lengths are metres here, masses kilograms"

LARGEST_OIL = 0.5
"""Oil of a crankpin over the masses beside it above which it is in grams: a pin holds 2 to 10 g."""

LARGEST_SPLIT = 90.0
"""Split of a crankpin, degrees, from which the other bank is tried: forged ones reach about 30."""


def cylinder(radius: float, rod_length: float, bore: float | None) -> None:
    """Warn of a cylinder's lengths in millimetres; of its mass beside the largest crank radius."""
    _report(_core.cylinder_warnings(radius, rod_length, bore))


def engine(core: _core.Engine) -> None:
    """Warn of an engine as a whole, cylinders and hardware included."""
    _report(_core.engine_warnings(core))


def units(core: _core.Engine) -> None:
    """Warn of an engine's places in millimetres and masses in grams; not of its cylinders."""
    _report(_core.unit_warnings(core))


def unbalance(amount: float) -> None:
    """Warn of an implausible unbalance, kg·m, by itself or relative to an engine."""
    _report(_core.unbalance_warnings(amount))


def hardware(core: _core.Engine, *, of_shafts: bool) -> None:
    """Warn of counterweights, or balance shafts, whose amounts or places are in other units."""
    _report(_core.hardware_warnings(core, of_shafts))


def bounds(core: _core.Engine, values: Iterable[float]) -> None:
    """Warn of bounds of counterweights in other units, kg·m; an infinite one is none."""
    largest = max((value for value in values if value < math.inf), default=0.0)
    _report(_core.figure_warnings(core, "kg·m", "bound", largest))


def flywheel(core: _core.Engine, inertia: float) -> None:
    """Warn of a moment of inertia that no flywheel of an engine has, kg·m²."""
    _report(_core.figure_warnings(core, "kg·m²", "inertia", inertia))


def place(core: _core.Engine, name: str, *at: float | None, middle: float | None = None) -> None:
    """Warn of places along the crank, such as a reference plane, that are in millimetres.

    With ``middle`` 0 they are places beside the crank or above it, or lengths. None is no place.
    """
    values = (value for value in at if value is not None)
    entries = (_core.figure_warnings(core, "m", name, value, middle) for value in values)
    _report(next(filter(None, entries), []))


def masses(core: _core.Engine, **given: float) -> None:
    """Warn of masses of one cylinder's parts, by the names of their arguments, in grams."""
    warnings_of = (_core.figure_warnings(core, "kg", name, mass) for name, mass in given.items())
    _report([entry for entries in warnings_of for entry in entries])


def oil(mass: float, beside: float) -> None:
    """Warn of more oil in a crankpin than a part of the masses beside it can be, kg."""
    if mass > LARGEST_OIL * beside > 0.0:
        hint = "was it given in grams?"
        _report([("oil", f"= {mass:g} kg beside {beside:g} kg", [(hint, None)])])


def pressure(values: NDArray[np.float64]) -> None:
    """Warn of cylinder pressures in bar or kPa, or against the atmosphere."""
    warn_of_core(_core.pressure_warnings(values.ravel()))


def about_tdc(theta_deg: NDArray[np.float64], period_deg: float) -> NDArray[np.float64]:
    """Return crank angles in the cycle about the firing top dead centre, -360° to 360° or half."""
    half = period_deg / 2.0
    beside: NDArray[np.float64] = (theta_deg + half) % period_deg - half
    return beside


def far_peak(
    theta_deg: NDArray[np.float64], values: NDArray[np.float64], period_deg: float
) -> float | None:
    """Return the crank angle of the peak of pressure if it is far from the firing dead centre."""
    return _core.far_peak(theta_deg, values, period_deg)


def peak(theta_deg: NDArray[np.float64], values: NDArray[np.float64], period_deg: float) -> None:
    """Warn of pressure whose peak is far from the firing top dead centre."""
    warn_of_core(_core.peak_warnings(theta_deg, values, period_deg))


def cycle(core: _core.Cycle) -> None:
    """Warn of the pressures of a cycle, and of a peak far from the firing top dead centre."""
    warn_of_core(_core.cycle_warnings(core))


def work(core: _core.Cycle, mean_pressure: float) -> None:
    """Warn of pressure that takes more work from the crank than an engine does."""
    warn_of_core(_core.work_warnings(core, mean_pressure))


def gas(core: _core.Engine) -> None:
    """Warn of the pressure in an engine's cylinders, whose cycles are asked alone."""
    warn_of_core(_core.gas_warnings(core))


def absolute(name: str, pressure: float) -> None:
    """Warn of the pressure of crankcase or intake in other units; 0 is a vacuum."""
    warn_of_core(_core.absolute_warnings(name, pressure))


def body(figures: tuple[float, Any, Any]) -> None:
    """Warn of a tensor that no body has, and of figures in other units."""
    warn_of_core(_core.tensor_warnings(figures))
    _report(_core.body_warnings(figures))


def mount(figures: tuple[Any, ...]) -> None:
    """Warn of a mount whose figures seem to be in other units."""
    _report(_core.mount_warnings(figures))


def stiffness(argument: str, mount: str, values: Sequence[float]) -> None:
    """Warn of stiffness of a mount that is in N/mm."""
    _report(_core.stiffness_warnings(argument, mount, values))


def point(name: str, at: tuple[float, float, float]) -> None:
    """Warn of a place on a powertrain that is in millimetres."""
    _report(_core.point_warnings(name, at))


def _report(entries: Sequence[_Entry]) -> None:
    warn_of(of_core(entries), UNITS_ASSUMED)


def angles(**given: object) -> None:
    """Warn of angles given in radians, and of angles beside a part of a turn."""
    for name, values in given.items():
        numbers = list(values.flat) if isinstance(values, np.ndarray) else values
        numbers = numbers if isinstance(numbers, (list, tuple)) else [numbers]
        hints = filter(None, (_near_miss(value) for value in numbers))
        if hint := next(hints, None):
            meant = "if that is meant, give it as text"
            warn(name, f"= {inputs.shorten(values)}: {hint}; {meant}")
        radians(name, values, numbers)


def radians(name: str, angles: object, values: Iterable[Any]) -> None:
    """Warn of doubles that are parts of a turn in radians; ``given`` is shown in their place."""
    degrees = _core.radians([float(value) for value in values if isinstance(value, float)])
    if degrees:
        hint = Hint("was it given in radians? Angles are degrees here:")
        warn_of([Entry(name, f"= {inputs.shorten(angles)}", hint)], degrees)


def _near_miss(value: object) -> str | None:
    """Return "51.428571 is 4.3e-7° from 360/7" or the like for a float beside a part of a turn."""
    return _core.near_miss(repr(float(value))) if isinstance(value, float) else None


def pin_split(core: _core.Engine, split: str) -> None:
    """Warn of pins split to the wrong side: even firing needs the opposite sign.

    Parameters
    ----------
    core
        The vee.
    split
        Left pin minus right pin, as the core takes it.
    """
    warn_of_core(_core.pin_split_warnings(core, split))


def other_bank(odd_bank: str) -> str:
    """Return the bank that is not this one."""
    return "left" if odd_bank == "right" else "right"


def odd_bank(bank: str, split_deg: ArrayLike, of_other: ArrayLike) -> bool:
    """Warn of cylinder 1 in the wrong bank: in the other one a firing order needs smaller splits.

    Parameters
    ----------
    given
        Bank of cylinder 1.
    split_deg, of_other
        Pin splits of all throws, and those with cylinder 1 in the other bank, degrees.

    Returns
    -------
    bool
        Whether the caller was warned.
    """
    largest, smaller = (float(np.abs(angles).max()) for angles in (split_deg, of_other))
    if largest < LARGEST_SPLIT or smaller > largest / 2.0:
        return False
    how = f"split by {smaller:.6g}°" if smaller else "shared"
    needs = f'= "{bank}": this firing order needs pins split by {largest:.6g}°'
    fault = Hint.of(f'{needs}; with `odd_bank="{other_bank(bank)}"` pins are {how}')
    warn("odd_bank", fault, "makers differ in the side of cylinder 1")
    return True


def split_pins(
    split_deg: ArrayLike, shared: _core.Engine, firing_order: str, strokes: int, typed: object
) -> None:
    """Warn of pins that even firing splits, with the intervals at which shared ones fire.

    Parameters
    ----------
    split_deg
        Pin splits of all throws, degrees.
    shared
        The engine with shared pins.
    firing_order, strokes
        As of builders, cylinders by their numbers.
    given
        The firing order as it was given.
    """
    if (largest := float(np.abs(split_deg).max())) < EQUAL_INTERVALS:
        return
    try:
        intervals = _core.Firing.named(shared, firing_order, strokes).intervals_deg.tolist()
    except InputError:
        fires = "do not fire in this order"
    else:
        count = next(
            count
            for count in range(1, len(intervals) + 1)
            if np.allclose(intervals, np.roll(intervals, -count), rtol=0.0, atol=EQUAL_INTERVALS)
        )
        fires = f"fire at {'-'.join(f'{interval:.6g}' for interval in intervals[:count])}°"
    needs = f"even firing needs crankpins split by {largest:.6g}°"
    shared_ones = Hint.of(f"shared ones, which `shared_pins=True` gives, {fires}")
    fault = Hint(f"= {labels.cut(str(typed))}: {needs}; ", shared_ones)
    warn("firing_order", fault)
