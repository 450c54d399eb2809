"""Warnings of figures that no engine has: wrong units, and pins split to the wrong side.

Each check names the argument, its value and the likely mistake. The caller is warned
once per call, however many cylinders are alike.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin import _core
from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin._support.warnings import warn

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from crankpin.model.shafts import Shaft, Unbalance


LARGEST_CRANK_RADIUS = 5.0
"""Crank radius, m, above which lengths are not in metres.

The longest stroke built is 3.46 m (MAN G95ME-C), a radius of 1.73 m.
"""

LARGEST_SPACING = 100.0
"""Distance between neighbouring cylinders, in crank radii, above which it is not in metres.

Cars have 2 to 3, large two-strokes 1.3; a Formula 1 V10 of 40 mm stroke has less than 6.
"""

ROUNDING = 1e-6
"""Degrees by which rounding alone does not part two firing intervals."""

LARGEST_DENSITY = 1e6
"""Mass over the cube of the crank radius, kg/m³, above which masses are not in kilograms.

Cars have 4e3 to 2e4, large two-strokes 8e3, a Formula 1 V10 of 20 mm crank radius some 5e4. In
grams all but the largest engines are above 1e6.
"""

LARGEST_UNBALANCE = 7e3
"""Unbalance, kg·m, above which it is not in these units, whatever the engine.

The largest first-order couples, of two-strokes, are 3 MN·m at 80 rpm: 5.3e3 kg·m at weights 8 m
apart.
"""

LARGEST_FLYWHEEL = 1e9
"""Moment of inertia over the fifth power of the crank radius, kg/m³, above which it is not kg·m².

Cars have 1e6, large two-strokes 1e5, a slow stationary engine with two flywheels (Lister CS) 1e7.
"""

LARGEST_IN_BAR, LARGEST_IN_KPA = 500.0, 5e4
"""Peak pressures, Pa, below which they are in bar or kPa: a motored cylinder reaches 1e6 Pa, a
diesel 3e7."""

LARGEST_PRESSURE = 5e7
"""Peak pressure, Pa, above which it is not in Pa: the highest of diesels are 3e7."""

LEAST_ABSOLUTE = 1.5e4
"""Least pressure, Pa, below which gauge pressure is likely: an engine that idles has 2e4 Pa."""

LARGEST_INTAKE = 6e5
"""Least pressure, Pa, above which figures are in another unit: charged engines have up to 5e5."""

NOISE = 0.05
"""Part of a cycle's points that noise may have below the least pressure; of gauge pressure two
strokes of four are."""

FARTHEST_PEAK = 60.0
"""Degrees from the firing top dead centre up to which pressure peaks: compression does at 0, and
the latest burns at 40."""

PEAKED = 2.0
"""Peak over mean pressure from which there is a peak: compression alone has 4 and more."""

STRONGEST_BRAKE = -5e5
"""Imep, Pa, below which figures are likely wrong: motored engines have -2e5, and engine brakes, the
exception, as much as -1.2e6."""

MOST_MISSING = 1e-9
"""Part of the largest principal moment that rounding lets the sum of the others lack."""

FARTHEST_CG = 5.0
"""Distance of a centre of gravity or a mount from the crank, m, above which it is not in metres."""

GYRATION = (1e-3, 5.0)
"""Radii of gyration, m, of bodies from a model engine to a ship's; others are in other units."""

MOUNT_STIFFNESS = (1e3, 1e9)
"""Stiffness of a mount, N/m, below and above which it is likely not in N/m."""

UNITS = "Lengths are metres here, masses kilograms"
MILLIMETRES = ": was it given in millimetres?"
GRAMS_MILLIMETRES = ": was it given in g·mm or g·m?"

LONGEST_ROD = 5.0
"""Rod length, m, up to which it is in metres: the longest built have 3.5 m."""

RODS_IN_MILLIMETRES = (1e3, 2e4)
"""Rod lengths, in crank radii, that are rods of 2.5 to 10 in millimetres; longer ones stand for
rods without end."""

FARTHEST = 300.0
"""Distance from the engine, in crank radii, beyond which a place is not in metres (car: 13 m)."""

LARGEST_BORE = 10.0
"""Bore over stroke, or stroke over bore, above which units differ; engines have 0.25 to 2.5."""

LARGEST_OIL = 0.5
"""Oil of a crankpin over the masses beside it above which it is in grams: a pin holds 2 to 10 g."""

LARGEST_SPLIT = 90.0
"""Split of a crankpin, degrees, from which the other bank is tried: forged ones reach about 30."""

PARTS_OF_A_TURN = range(1, 25)
"""Denominators of the parts of a turn for which radians are recognised: angles of 2 to 24 throws
and firing intervals."""

ROUNDED_RADIANS = 0.03
"""Difference, degrees, from a part of a turn up to which radians are recognised: those typed to
three decimals are within 0.029°."""


def cylinder(radius: float, rod_length: float) -> None:
    """Warn of a cylinder's lengths in millimetres; of its mass beside the largest crank radius."""
    found = []
    if radius > LARGEST_CRANK_RADIUS:
        found.append(f"crank_radius = {radius:g} m{MILLIMETRES}")
    low, high = RODS_IN_MILLIMETRES
    if rod_length > LONGEST_ROD and low < rod_length / radius < high:
        found.append(f"rod_length = {rod_length:g} m{_at(radius)}{MILLIMETRES}")
    _report(found)


def units(core: _core.Engine) -> None:
    """Warn of an engine's places in millimetres and masses in grams; cylinders are asked alone."""
    radius = core.largest_crank_radius
    found = []
    places = sorted(set(core.z.tolist()))
    spacing = max((after - before for before, after in pairwise(places)), default=0.0)
    if spacing > LARGEST_SPACING * radius:
        found.append(
            f"z (or spacing, bank_stagger) = {spacing:g} m apart{_at(radius)}{MILLIMETRES}"
        )
    masses = {
        "reciprocating_mass": max(parts[2] for parts in core.cylinders),
        "rotating_mass": float(core.rotating_mass.max()),
    }
    _report([*found, *_grams(radius, masses)])


def unbalance(amount: float) -> None:
    """Warn of an unbalance that no engine has, kg·m; of smaller ones beside an engine."""
    if amount > LARGEST_UNBALANCE:
        _report([f"amount = {amount:g} kg·m{GRAMS_MILLIMETRES}"])


def hardware(core: _core.Engine, weights: Sequence[Unbalance], shafts: Sequence[Shaft]) -> None:
    """Warn of counterweights and balance shafts whose amounts or places are in other units."""
    carried = [*weights, *(weight for shaft in shafts for weight in shaft.unbalances)]
    amount = max((weight.amount for weight in carried), default=0.0)
    found = _heavy(core, "amount", amount) if amount <= LARGEST_UNBALANCE else []
    for weight in carried:
        found += _far(core, "z", weight.z)
    for shaft in shafts:
        found += _far(core, "x", shaft.x, 0.0) + _far(core, "y", shaft.y, 0.0)
    _report(list(dict.fromkeys(found))[:4])


def bounds(core: _core.Engine, given: Iterable[float]) -> None:
    """Warn of bounds of counterweights in other units, kg·m; an infinite one is none."""
    largest = max((each for each in given if each < math.inf), default=0.0)
    _report(_heavy(core, "bound", largest))


def flywheel(core: _core.Engine, inertia: float) -> None:
    """Warn of a moment of inertia that no flywheel of an engine has, kg·m²."""
    radius = core.largest_crank_radius
    if inertia > LARGEST_FLYWHEEL * radius**5:
        _report([f"inertia = {inertia:g} kg·m²{_at(radius)}: was it given in kg·cm² or g·m²?"])


def place(core: _core.Engine, name: str, *at: float | None, middle: float | None = None) -> None:
    """Warn of places along the crank, such as a reference plane, that are in millimetres.

    With ``middle`` 0 they are places beside the crank or above it, or lengths. None is no place.
    """
    given = (each for each in at if each is not None)
    _report(next(filter(None, (_far(core, name, each, middle) for each in given)), []))


def masses(core: _core.Engine, **given: float) -> None:
    """Warn of masses of one cylinder's parts, by the names of their arguments, in grams."""
    _report(_grams(core.largest_crank_radius, given))


def oil(mass: float, beside: float) -> None:
    """Warn of more oil in a crankpin than a part of the masses beside it can be, kg."""
    if mass > LARGEST_OIL * beside > 0.0:
        _report([f"oil = {mass:g} kg beside {beside:g} kg: was it given in grams?"])


def bore(diameter: float, stroke: float) -> None:
    """Warn of a bore and a stroke that are not in one unit."""
    if not 1.0 / LARGEST_BORE < diameter / stroke < LARGEST_BORE:
        _report([f"bore = {diameter:g} m and stroke = {stroke:g} m: are both in metres?"])


def pressure(values: NDArray[np.float64]) -> None:
    """Warn of cylinder pressures in bar or kPa, or against the atmosphere."""
    least, most = float(values.min()), float(values.max())
    if most < LARGEST_IN_KPA:
        unit = "bar" if most < LARGEST_IN_BAR else "kPa"
        warn(f"pressure is at most {most:g} Pa: was it given in {unit}? Pressures are Pa here")
    elif 0.0 < most - least < LARGEST_IN_BAR:
        warn(
            f"pressure varies by {most - least:g} Pa alone: was gauge pressure given in bar? "
            "Pressures are Pa here"
        )
    elif most > LARGEST_PRESSURE:
        warn(
            f"pressure is as much as {most:g} Pa, more than any engine's: are its numbers in the "
            "unit that is named for them? Pressures are Pa here"
        )
    elif least > LARGEST_INTAKE and most > PEAKED * least:
        warn(
            f"pressure is {least:g} Pa at its least, more than any intake has: are its numbers in "
            "the unit that is named for them? Pressures are Pa here"
        )
    elif float(np.quantile(values, NOISE)) < LEAST_ABSOLUTE:
        warn(
            f"pressure is {least:g} Pa at its least: is it gauge pressure? Pressures are absolute "
            "here: add that of the atmosphere, 101325 Pa"
        )
    elif least < 0.0:
        warn(
            f"pressure is {least:g} Pa at its least, which noise or an offset of the sensor does: "
            "torque is linear in pressure, and counts it as it is"
        )


def about_tdc(theta_deg: NDArray[np.float64], period_deg: float) -> NDArray[np.float64]:
    """Return crank angles in the cycle about the firing top dead centre, -360° to 360° or half."""
    half = period_deg / 2.0
    found: NDArray[np.float64] = (theta_deg + half) % period_deg - half
    return found


def far_peak(
    theta_deg: NDArray[np.float64], values: NDArray[np.float64], period_deg: float
) -> float | None:
    """Return the crank angle of the peak of pressure if it is far from the firing dead centre."""
    most = values.max()
    if most < PEAKED * values.mean():
        return None
    at = about_tdc(theta_deg[values == most], period_deg)
    nearest = float(at[np.abs(at).argmin()])
    return nearest if abs(nearest) > FARTHEST_PEAK else None


def peak(theta_deg: NDArray[np.float64], values: NDArray[np.float64], period_deg: float) -> None:
    """Warn of pressure whose peak is far from the firing top dead centre."""
    if (nearest := far_peak(theta_deg, values, period_deg)) is not None:
        warn(
            f"theta_deg: pressure peaks at {nearest:.4g}°, far from the firing top dead centre, "
            "from which angles are counted here; load a file that counts from elsewhere with "
            "tdc_deg=…, the angle at which it has that centre"
        )


def imep(mean_pressure: float) -> None:
    """Warn of pressure that takes more work from the crank than an engine does."""
    if mean_pressure < STRONGEST_BRAKE:
        warn(
            f"imep = {mean_pressure / 1e5:.3g} bar: pressure brakes the crank. Are angles counted "
            "in the direction of rotation, from the firing top dead centre?"
        )


def absolute(name: str, pressure: float) -> None:
    """Warn of the pressure of crankcase or intake in other units; 0 is a vacuum."""
    if 0.0 < pressure < LARGEST_IN_BAR:
        warn(f"{name} = {pressure:g} Pa: was it given in bar or kPa? Pressures are Pa here")
    elif pressure > LARGEST_PRESSURE:
        warn(f"{name} = {pressure:g} Pa: is it in Pa? Pressures are Pa here")


def body(mass: float, cg: Sequence[float], moments: Sequence[float], missing: float) -> None:
    """Warn of a tensor that no body has, and of figures in other units."""
    if missing > MOST_MISSING:
        listed = ", ".join(f"{moment:.6g}" for moment in moments)
        warn(
            f"inertia has principal moments of {listed} kg·m²: the largest is more than the sum of "
            f"the others, which lacks {100 * missing:.3g} % of it; no body has such a tensor. Is "
            "it about the centre of gravity, with the right sign of its products?"
        )
    found = []
    smallest, largest = (math.sqrt(moments[k] / mass) for k in (0, 2))
    if smallest < GYRATION[0] or largest > GYRATION[1]:
        found.append(
            f"inertia has radii of gyration from {smallest:.3g} to {largest:.3g} m: are mass and "
            "inertia in kg and kg·m²?"
        )
    _report(found + _outside("cg", cg))


def mount(name: str, at: Sequence[float], **stiffness: Iterable[float]) -> None:
    """Warn of a mount whose figures seem to be in other units: its place, stiffness by argument."""
    found = []
    least, most = MOUNT_STIFFNESS
    for argument, values in stiffness.items():
        if wrong := [k for k in values if k and not least <= k <= most]:
            words = f"{argument} of mount {name!r} = {wrong[0]:g} N/m"
            found.append(f"{words}: was it given in N/mm?")
    _report(found + _outside(f"at of mount {name!r}", at))


def point(name: str, at: Sequence[float]) -> None:
    """Warn of a place on a powertrain that is in millimetres."""
    _report(_outside(name, at))


def _outside(name: str, at: Sequence[float]) -> list[str]:
    is_outside = max(map(abs, at)) > FARTHEST_CG
    return [f"{name} = {tuple(at)} m{MILLIMETRES}"] if is_outside else []


def _at(radius: float) -> str:
    return f" at a crank radius of {radius:g} m"


def _heavy(core: _core.Engine, name: str, amount: float) -> list[str]:
    """Return what to say of an unbalance that is too large for the engine, if it is."""
    radius = core.largest_crank_radius
    is_heavy = amount > LARGEST_DENSITY * radius**4
    return [f"{name} = {amount:g} kg·m{_at(radius)}{GRAMS_MILLIMETRES}"] if is_heavy else []


def _grams(radius: float, masses: Mapping[str, float]) -> list[str]:
    return [
        f"{name} = {mass:g} kg{_at(radius)}: was it given in grams?"
        for name, mass in masses.items()
        if mass > LARGEST_DENSITY * radius**3
    ]


def _far(core: _core.Engine, name: str, at: float, middle: float | None = None) -> list[str]:
    """Return what to say of a place that is too far from the engine, if it is."""
    radius, z = core.largest_crank_radius, core.z
    distance = abs(at - (core.middle if middle is None else middle)) - float(np.ptp(z))
    is_far = FARTHEST * radius < distance < math.inf
    return [f"{name} = {at:g} m{_at(radius)}{MILLIMETRES}"] if is_far else []


def _report(found: list[str]) -> None:
    if found:
        warn(f"{'; '.join(found)} {UNITS}")


def angles(**given: object) -> None:
    """Warn of angles given in radians, and of angles beside a part of a turn."""
    for name, values in given.items():
        listed = list(values.flat) if isinstance(values, np.ndarray) else values
        listed = listed if isinstance(listed, (list, tuple)) else [listed]
        hints = filter(None, (_near_miss(value) for value in listed))
        if hint := next(hints, None):
            warn(f"{name} = {inputs.shorten(values)}: {hint}; if that is meant, give it as text")
        radians(name, values, listed)


def radians(name: str, given: object, values: Iterable[Any]) -> None:
    """Warn of doubles that are parts of a turn in radians; ``given`` is shown in their place."""
    angles = [float(value) for value in values if isinstance(value, float) and value]
    if angles and all(map(_radians, angles)):
        degrees = ", ".join(f"{math.degrees(value):.6g}°" for value in angles[:4])
        warn(
            f"{name} = {inputs.shorten(given)}: was it given in radians? Angles are degrees here: "
            f"{degrees}"
        )


def _near_miss(value: object) -> str | None:
    """Return "51.428571 is 4.3e-7° from 360/7" or the like for a float beside a part of a turn."""
    return _core.near_miss(repr(float(value))) if isinstance(value, float) else None


def _radians(value: float) -> bool:
    turns = value / math.tau
    if not 0.0 < abs(turns) <= 1.0 + 1e-9:
        return False
    return any(
        abs(turns * count - round(turns * count)) * 360.0 < ROUNDED_RADIANS * count
        and round(turns * count) != 0
        for count in PARTS_OF_A_TURN
    )


def pin_split(core: _core.Engine, split: str) -> None:
    """Warn of pins split to the wrong side: even firing needs the opposite sign.

    Parameters
    ----------
    core
        The vee.
    split
        Left pin minus right pin, as the core takes it.
    """
    tdc, banks = core.tdc_deg, core.bank_deg
    degrees = inputs.degrees(split)
    if degrees % 360.0 in (0.0, 180.0) or fires_evenly(tdc):
        return
    left = banks == max(banks)  # of an upright vee
    # With the opposite split the left pins are 2·split further back, their TDCs as much later.
    if fires_evenly((tdc + 2.0 * degrees * left) % 360.0):
        warn(
            f"pin_split_deg = {degrees:g}: this engine fires unevenly; with pin_split_deg = "
            f"{-degrees:g} it would fire evenly. The split is left pin minus right pin in the "
            "direction of rotation, bank angle minus firing interval"
        )


def other_bank(odd_bank: str) -> str:
    """Return the bank that is not this one."""
    return "left" if odd_bank == "right" else "right"


def odd_bank(given: str, split_deg: ArrayLike, of_other: ArrayLike) -> bool:
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
    largest, smaller = (float(np.abs(each).max()) for each in (split_deg, of_other))
    if largest < LARGEST_SPLIT or smaller > largest / 2.0:
        return False
    how = f"split by {smaller:.6g}°" if smaller else "shared"
    warn(
        f'odd_bank = "{given}": this firing order needs pins split by {largest:.6g}°; with '
        f'odd_bank="{other_bank(given)}" pins are {how}. Makers differ in the side of cylinder 1'
    )
    return True


def split_pins(
    split_deg: ArrayLike, shared: _core.Engine, firing_order: str, strokes: int, given: object
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
    if (largest := float(np.abs(split_deg).max())) < ROUNDING:
        return
    try:
        intervals = _core.Firing.named(shared, firing_order, strokes).intervals_deg.tolist()
    except InputError:
        fires = "do not fire in this order"
    else:
        count = next(
            count
            for count in range(1, len(intervals) + 1)
            if np.allclose(intervals, np.roll(intervals, -count), rtol=0.0, atol=ROUNDING)
        )
        fires = f"fire at {'-'.join(f'{each:.6g}' for each in intervals[:count])}°"
    warn(
        f"firing_order = {labels.cut(str(given))}: even firing needs crankpins split by "
        f"{largest:.6g}°; shared ones, which shared_pins=True gives, {fires}"
    )


def fires_evenly(tdc_deg: NDArray[np.float64]) -> bool:
    """Return whether an even number of four-stroke cylinders with these TDCs can fire evenly."""
    half = len(tdc_deg) // 2
    # Two cylinders, a turn apart, have each of `half` equally spaced top dead centres.
    places = (tdc_deg - tdc_deg[0]) * (half / 360.0)
    return sorted(places.round(6) % half) == sorted([*range(half), *range(half)])
