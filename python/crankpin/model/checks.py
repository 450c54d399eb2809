"""Warnings of figures that no engine has: wrong units, and pins split to the wrong side.

Each check names the argument, its value and the likely mistake. Whoever builds an engine is warned
once per call, however many cylinders are alike.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from crankpin import _core
from crankpin._support import inputs
from crankpin._support.warnings import warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

LARGEST_CRANK_RADIUS = 5.0
"""Crank radius, m, above which lengths are not in metres.

The longest stroke built is 3.46 m (MAN G95ME-C), a radius of 1.73 m.
"""

LARGEST_SPACING = 100.0
"""Distance between neighbouring cylinders, in crank radii, above which it is not in metres.

Cars have 2 to 3, large two-strokes 1.3; a Formula 1 V10 of 40 mm stroke has less than 6.
"""

LARGEST_DENSITY = 1e6
"""Mass over the cube of the crank radius, kg/m³, above which masses are not in kilograms.

Cars have 4e3 to 2e4, large two-strokes 8e3, a Formula 1 V10 of 20 mm crank radius some 5e4. In
grams all but the largest engines are above 1e6.
"""

PARTS_OF_A_TURN = range(1, 25)
"""Denominators of the parts of a turn for which radians are recognised: angles of 2 to 24 throws
and firing intervals."""

ROUNDED_RADIANS = 0.01
"""Difference, degrees, from a part of a turn up to which radians are recognised: those typed to
four decimals are within 0.003°."""


def units(core: _core.Engine) -> None:
    """Warn of lengths in millimetres and masses in grams."""
    cylinders = set(core.cylinders)
    radius = max(parts[0] for parts in cylinders)
    found = []
    if radius > LARGEST_CRANK_RADIUS:
        found.append(f"crank_radius = {radius:g} m: was it given in millimetres?")
    places = sorted(set(core.z.tolist()))
    spacing = min((after - before for before, after in pairwise(places)), default=0.0)
    if spacing > LARGEST_SPACING * radius:
        found.append(
            f"z (or spacing) = {spacing:g} m apart at a crank radius of {radius:g} m: were they "
            "given in millimetres?"
        )
    masses = {
        "reciprocating_mass": max(cylinders, key=lambda parts: parts[2])[2],
        "rotating_mass": float(core.rotating_mass.max()),
    }
    found += [
        f"{name} = {mass:g} kg at a crank radius of {radius:g} m: was it given in grams?"
        for name, mass in masses.items()
        if mass > LARGEST_DENSITY * radius**3
    ]
    if found:
        warn(f"{'; '.join(found)} Lengths are metres here, masses kilograms")


def angles(**given: object) -> None:
    """Warn of angles given in radians, and of angles beside a part of a turn."""
    for name, values in given.items():
        listed = values if isinstance(values, (list, tuple, np.ndarray)) else [values]
        hints = filter(None, (_near_miss(value) for value in listed))
        if hint := next(hints, None):
            warn(f"{name} = {inputs.shorten(values)}: {hint}; if that is meant, give it as text")
        floats = [float(value) for value in listed if isinstance(value, float) and value]
        if floats and all(map(_radians, floats)):
            degrees = ", ".join(f"{math.degrees(value):.6g}°" for value in floats[:4])
            warn(
                f"{name} = {inputs.shorten(values)}: was it given in radians? Angles are degrees "
                f"here: {degrees}"
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
    degrees = _degrees(split)
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


def fires_evenly(tdc_deg: NDArray[np.float64]) -> bool:
    """Return whether an even number of four-stroke cylinders with these TDCs can fire evenly."""
    half = len(tdc_deg) // 2
    # Two cylinders, a turn apart, have each of `half` equally spaced top dead centres.
    places = (tdc_deg - tdc_deg[0]) * (half / 360.0)
    return sorted(places.round(6) % half) == sorted([*range(half), *range(half)])


def _degrees(text: str) -> float:
    over, _, under = text.partition("/")
    return float(over) / float(under or 1)
