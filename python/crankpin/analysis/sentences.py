"""The words of an explanation: a sentence for each kind of finding."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from crankpin._support.labels import NEGLIGIBLE, dead_text
from crankpin._support.quantities import PLANE_VECTORS, QUANTITIES
from crankpin._support.units import convert

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from crankpin._support.inputs import Order
    from crankpin.analysis.explain import Explanation
    from crankpin.analysis.findings import Finding

NUMBERS = (
    *("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    *("eleven", "twelve"),
)
"""Small numbers in words."""
SPEEDS: dict[Order, str] = {1: "crank speed", 2: "twice crank speed"}
"""Order that a balance shaft removes → its speed."""
AXES = {
    "force": ("sideways", "up and down", "along a line at"),
    "moment": ("in pitch", "in yaw", "about an axis at"),
}
"""Direction of a vector along +x, along +y, and before an angle from +x."""
LISTED = 4
"""Most pairs of cylinders that a sentence lists."""
LINE = 1e-9
"""Forward and backward parts that differ by less make a straight line; one that is less of both is
no part, and the vector's tip draws a circle."""
LONG = 0.9995
"""Levers from here on, m, are given in metres: in millimetres they have more than three digits."""
SAME = 0.005
"""Peaks that differ by less are as large in three digits, or nearly."""


def sentence(finding: Finding, whole: Explanation) -> str:
    """Return a finding in words."""
    text = WORDS[finding.kind](finding, whole)
    return f"{text[0].upper()}{text[1:]}."


# --- figures ------------------------------------------------------------------------------------


def figure(value: float, unit: str, *, up: bool = False) -> str:
    """Return a value with three digits, or rounded up to two, and its unit with a prefix."""
    if up:
        step = 10.0 ** (math.floor(math.log10(value)) - 1)
        value = math.ceil(value / step * (1.0 - 1e-12)) * step
    shown = convert(unit)
    if shown.unit != unit:
        value *= shown.factor
        return f"{float(f'{value:.3g}'):.10g} {shown.unit}"
    prefix, scale = "", 1.0
    for name, factor in (("k", 1e3), ("M", 1e6)):
        if value >= 0.9995 * factor and unit in ("N", "N·m"):
            prefix, scale = name, factor
    return f"{value / scale:.3g} {prefix}{unit}"


def size(value: float, quantity: str, whole: Explanation, *, up: bool = False) -> str:
    """Return a force or moment: with a speed in N or N·m, else relative to one piston's force."""
    if whole.rpm is not None:
        return figure(value, QUANTITIES[quantity].unit, up=up)
    if not whole.unit:
        return f"{figure(value, QUANTITIES[quantity].unit_over_square, up=up)} times ω²"
    force, share = unit_force(whole), value / whole.unit
    if quantity == "moment":
        lever = figure(share, "m", up=up) if share >= LONG else figure(1e3 * share, "mm", up=up)
        return f"{force} at a lever of {lever}"
    if abs(share - 1.0) <= SAME:
        return force
    text = figure(100.0 * share, "% of", up=up) if share < 1.0 else figure(share, "times", up=up)
    return f"{text} {force}"


def unit_force(whole: Explanation) -> str:
    """Return what forces are relative to where no speed is given."""
    return f"one {whole.strongest[1]}'s first-order force"


def abbreviated(sentences: Iterable[str], phrase: str, symbol: str) -> list[str]:
    """Return sentences with a symbol for a phrase that comes again, behind it where it is first."""
    text = "\n".join(sentences)
    before, _, after = text.partition(phrase)
    if phrase in after:
        text = f"{before}{phrase} {symbol}{after.replace(phrase, symbol)}"
    return text.split("\n")


def words(finding: Finding) -> str:
    """Return ``shaking force`` or ``rocking moment``."""
    return QUANTITIES[finding.quantity].words


def across(direction_deg: float, sides: tuple[str, str]) -> str:
    """Return in words a line across the engine, from its direction in degrees from +x.

    Parameters
    ----------
    direction_deg
        Direction of the line, degrees from +x.
    sides
        What is on the right and on the left, seen from the flywheel.
    """
    sideways, upright, _ = AXES["force"]
    lean = round((90.0 - direction_deg + 90.0) % 180.0 - 90.0, 1)  # from upright, to the right
    if abs(lean) == 90.0:
        return sideways
    return f"{abs(lean):g}° towards the {sides[lean < 0.0]} side" if lean else upright


def turns(minor: float) -> str:
    """Return in words how a vector of constant size turns, from its half axis, signed."""
    return f"all round, {'against' if minor < 0.0 else 'with'} the crank"


def listed(items: Iterable[str]) -> str:
    """Return items joined by commas and "and"."""
    *before, last = items
    return f"{', '.join(before)} and {last}" if before else last


def orders(found: Sequence[Order]) -> str:
    """Return ``order 2`` or ``orders 1 and 2``."""
    return f"order{'s' * (len(found) > 1)} {listed(f'{each:g}' for each in found)}"


def number(count: int) -> str:
    """Return a count in words, from 13 on in figures."""
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


# --- sentences ----------------------------------------------------------------------------------


def _shakes(finding: Finding, whole: Explanation) -> str:
    forward, backward, tilt = finding.values
    peak = size(forward + backward, finding.quantity, whole)
    how = _shape(forward, backward, tilt, finding.quantity)
    found = f"{orders(finding.orders)} leaves a {words(finding)} of {peak}, {how}"
    if finding.reason != "together":
        return found
    count = len(whole.engine)
    return f"{found}: {'both' if count == 2 else f'all {number(count)}'} pistons pull together"


def _shape(forward: float, backward: float, tilt: float, quantity: str) -> str:
    """Return how a vector moves."""
    if min(forward, backward) <= LINE * (forward + backward):
        return f"constant in size, turning {'with' if forward > backward else 'against'} the crank"
    level, upright, other = AXES[quantity]
    named = {0.0: level, 90.0: upright}
    direction = named.get(round(abs(tilt), 1), f"{other} {tilt:.3g}°")
    if abs(forward - backward) <= LINE * (forward + backward):
        return direction
    return f"largest {direction}, turning {'with' if forward > backward else 'against'} the crank"


def _remedy(finding: Finding, whole: Explanation) -> str:
    kept, *ratios = finding.values
    what = f"the {words(finding)} of {orders(finding.orders)}"
    other = "other counterweights" if whole.engine.counterweights else "counterweights"
    other += " on the cranks" * finding.reason.endswith("cranks")
    least = f"down to {size(kept, finding.quantity, whole)}" if kept else ""
    if not ratios and kept > LINE * whole.unit:
        return f"{other} could bring {what} {least}, too little for a balance shaft"
    if not ratios:
        return f"{other} could remove all of {what}"
    senses = ["with" if ratio > 0 else "against" for ratio in ratios]
    speed = SPEEDS[finding.orders[0]]
    fitted = any(shaft.ratio in ratios for shaft in whole.engine.shafts)
    one, two = ("another", "two more") if fitted else ("a", "two")
    shaft = f"{one} balance shaft at {speed}, {senses[0]} the crank"
    if len(ratios) > 1:
        both = f"one {senses[0]} the crank and one {senses[1]} it"
        shaft = f"{two} balance shafts at {speed}, {both}"
    if finding.reason:
        rest = f"the rest turns {senses[0]} the crank, and takes {one} balance shaft that does so"
        return f"{other} could bring {what} {least}; {rest} at {speed}"
    if finding.orders == (1,):
        return f"no counterweight reaches {what}: it takes {shaft}"
    if kept > LINE * whole.unit:
        return f"{shaft}, would bring {what} {least}"
    return f"{shaft}, would remove {what}"


def _bob_weights(finding: Finding, whole: Explanation) -> str:
    rotating = "all rotating and " if whole.engine.rotating_mass.any() else ""
    instead = " in place of the counterweights" if whole.engine.counterweights else ""
    crank = "the crank" if finding.reason == "one sense" else "the crank of each piston"
    return (
        f"bob weights of {rotating}half the reciprocating mass{instead} remove what turns with "
        f"{crank} at {orders(finding.orders)}, of force and moment"
    )


def _hardware(finding: Finding, whole: Explanation) -> str:
    forward, backward, *after = finding.values
    before, now = forward + backward, sum(after)
    there = {"counterweights": whole.engine.counterweights, "balance shafts": whole.engine.shafts}
    acting = [
        f"the {group[:-1]}" if len(there[group]) == 1 else group
        for group in finding.reason.split(" and ")
    ]
    subject = " and ".join(acting)
    s = "s" * (acting[0].startswith("the ") and len(acting) == 1)
    what = f"{words(finding)} of {orders(finding.orders)}"
    was, left = (size(each, finding.quantity, whole) for each in (before, now))
    if not before:
        return f"{subject} bring{s} a {what}: {left}"
    if not now:
        zero = "exactly zero" if finding.proved else "zero to within rounding"
        return f"{subject} remove{s} the whole {what}, {was}: it is {zero}"
    if abs(now - before) <= SAME * before:
        return f"{subject} leave{s} the {what} at {left} and turn{s} its direction"
    rest = ""
    for part, still, sense in ((forward, after[0], "with"), (backward, after[1], "against")):
        if part and not still:
            if len(acting) > 1:  # of which one may do nothing in this sense
                rest = f", none of which turns {sense} the crank"
                continue
            all_of = f"all of the {what} that turns {sense} the crank"
            return f"{subject} remove{s} {all_of}: it changes from {was} to {left}"
    verb = "reduce" if now < before else "raise"
    return f"{subject} {verb}{s} the {what} from {was} to {left}{rest}"


def _cancels(finding: Finding, whole: Explanation) -> str:
    count, many = len(whole.engine), "s" * (len(finding.orders) > 1)
    zero = "exactly zero" if finding.proved else "zero to within rounding"
    pairs = ", ".join(f"{one} and {other}" for one, other in finding.groups)
    named = f" ({pairs})" if 1 < len(finding.groups) <= LISTED else ""
    cylinders = "the cylinder is" if count == 1 else "all cylinders are"
    opposite = "pistons" if finding.quantity == "force" else "cylinders"
    banks = len(whole.engine.banks)
    pistons = "the pistons of each bank" if banks > 1 else "the pistons"
    alone = len(finding.groups) == 1 and count == 2
    why = {
        "plane": f"{cylinders} in the reference plane",
        "pairs": f"the {opposite} are opposite"
        if alone
        else f"opposite {opposite} cancel in pairs{named}",
        "mirrored": f"front and rear mirror each other{named}",
        "evenly": f"{pistons} pull at even intervals",
        "each": f"{pistons} cancel one another",
        "between": f"the {'banks' if banks < count else 'cylinders'} cancel one another",
    }[finding.reason]
    verb = "are" if many else "is"
    return f"the {words(finding)}{many} of {orders(finding.orders)} {verb} {zero}: {why}"


def _rest(finding: Finding, whole: Explanation) -> str:
    other = "other " * bool(finding.orders)
    least = (whole.unit, whole.unit * whole.lever)
    found = [
        f"a {QUANTITIES[name].words} of {size(value, name, whole, up=True)}"
        for name, value, scale in zip(PLANE_VECTORS, finding.values, least, strict=True)
        if value > NEGLIGIBLE * scale
    ]
    if not found:
        return f"no {other}order is as large as a millionth of {unit_force(whole)}"
    return f"all {other}orders together make at most {listed(found)}"


def _inertia_torque(finding: Finding, whole: Explanation) -> str:
    peak = f": {figure(finding.values[0], 'N·m')}" if whole.rpm is not None else ""
    text = f"the roll torque of the moving parts is largest at {orders(finding.orders)}{peak}"
    return text if whole.engine.fired else f"{text}, {whole.engine.loads_counted}"


def _gas_torque(finding: Finding, whole: Explanation) -> str:
    mean, *peaks = finding.values
    each = (
        f"{figure(peak, 'N·m')} at order {order:g}"
        for peak, order in zip(peaks, finding.orders, strict=True)
    )
    gas = f"gas pressure ({whole.engine.loads_counted.removeprefix('gas: ')})"
    if abs(mean) <= NEGLIGIBLE * max(peaks):
        return f"{gas} does no work over a cycle; its torque has peaks of {listed(each)}"
    verb, size_of = "turns" if mean > 0.0 else "brakes", figure(abs(mean), "N·m")
    return f"{gas} {verb} the crank with {size_of} on average, and peaks of {listed(each)}"


def _firing(finding: Finding, whole: Explanation) -> str:
    dead = dead_text(whole.engine.cycles or ())
    order = whole.engine.firing_order + f", of which {dead}" * bool(dead)
    if len(whole.engine) == 1:
        return f"the cylinder fires every {finding.values[0]:g}°"
    if finding.reason == "evenly":
        return f"it fires evenly, every {finding.values[0]:.6g}°: {order}"
    intervals = "-".join(f"{each:.6g}" for each in finding.values)
    return f"it fires unevenly, at intervals of {intervals}°: {order}"


def _gas_orders(finding: Finding, whole: Explanation) -> str:
    firing = finding.groups[0]
    first = 2 * len(firing) / whole.engine.strokes
    if finding.orders == (first,):
        lower = ": all lower orders cancel exactly" if len(firing) > 1 else ""
        return f"gas torque begins at order {first:g}{lower}"
    left, how = orders(finding.orders), f"{finding.reason.removesuffix('ly')} firing"
    cylinders = [whole.engine.cylinders[number - 1] for number in firing]
    if len({(each.stroke, each.rod_length, each.pin_offset, each.bore) for each in cylinders}) > 1:
        how += " of unlike cylinders"
    elif len(set(whole.engine.cycles or (None,)) - {None}) > 1:
        how += " of unlike cycles"
    return f"{how} leaves gas torque of {left}, and of higher ones"


def _articulated(finding: Finding, whole: Explanation) -> str:
    rods = "each rod is computed on the crankpin itself"
    return (
        f"{number(len(finding.groups[0]))} rods share a crankpin: {rods}; a master rod with "
        "articulated rods, which moves its pistons differently, is not modelled"
    )


WORDS: dict[str, Callable[[Finding, Explanation], str]] = {
    "hardware": _hardware,
    "shakes": _shakes,
    "remedy": _remedy,
    "bob weights": _bob_weights,
    "cancels": _cancels,
    "rest": _rest,
    "inertia torque": _inertia_torque,
    "gas torque": _gas_torque,
    "firing": _firing,
    "gas orders": _gas_orders,
    "articulated": _articulated,
}
"""Kind of a finding → its sentence, without capital and full stop."""
