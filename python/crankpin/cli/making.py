"""Commands: inverse design and tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin.analysis.design.design import design
from crankpin.analysis.tolerances.spreads import FIGURES, SPREADS
from crankpin.analysis.tolerances.tolerances import tolerances
from crankpin.cli.arguments import command, option, rejected
from crankpin.cli.outputs import Shown, only

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given, Option
    from crankpin.model.engine import Engine

MOST_SAMPLES = 10_000_000
FLAGS = {name: f"--{name.removesuffix('_deg').replace('_', '-')}" for name in FIGURES}
"""Figure that spreads → its option."""


@command(
    "design",
    "cranks, pin splits and bank angles that minimise an objective",
    "name",
    option("--cylinders", metavar="N", help="number of cylinders (default: NAME's)"),
    option(
        "--layout",
        choices=("inline", "vee", "flat", "boxer"),
        help="layout of the engine (default: inline or vee)",
    ),
    "--by",
    option(
        "--bank-angle",
        metavar="RANGE",
        help="of a vee, degrees: one, or LOW:HIGH to choose from (default: NAME's)",
    ),
    option(
        "--pin-split",
        metavar="RANGE",
        help="left pin minus right pin, degrees, or LOW:HIGH (default: shared pins)",
    ),
    option("--own-splits", action="store_true", help="let each throw have a split of its own"),
    option(
        "--throws",
        metavar="A,B,…",
        help="throws to be put in order, degrees, or free (default: equally spaced)",
    ),
    option("--even-firing", action="store_true", help="only cranks that fire evenly"),
    option(
        "--intervals", metavar="A,B,…", help="only cranks that fire at these intervals, degrees"
    ),
    option(
        "--counterweights",
        action="store_true",
        help="do not count what counterweights remove, the forward part of order 1",
    ),
    option(
        "--shafts",
        metavar="A,B,…",
        help="speed ratios of balance shafts that are allowed: --shafts=-1 or --shafts=2,-2",
    ),
    "--rpm --orders",
    option("--count", default="20", help="number of designs to print (default: %(default)s)"),
    "--seed --units --csv --plot",
    option("--save", help="write the design of --pick, an engine file (.toml, .json)"),
    option(
        "--pick", metavar="N", default="1", help="which design --save writes (default: %(default)s)"
    ),
    "--force",
    example="design v10-72 --bank-angle 60:120 --even-firing --by total.moment.peak",
    note="Moving parts, spacing, bank angle, number of cylinders and banks are those of NAME;\n"
    "its crank is not used. Objectives are those of rank. Ranges are LOW:HIGH.",
)
def _design(given: Given) -> Shown:
    engine = given.engine("design")
    if len(set(engine.cylinders)) > 1 or len(engine.banks) > 2:
        hint = "give an engine with one or two banks and one kind of cylinder"
        raise rejected("NAME", given.text("name"), hint)
    pick = given.whole("--pick")
    if not 1 <= pick <= given.whole("--count"):
        raise rejected("--pick", str(pick), "give the place of one of the designs, from 1")
    layout: Any = given.text("--layout") or ("inline" if len(engine.banks) == 1 else "vee")
    angle = _angles(given, "--bank-angle")
    if angle is None and layout == "vee" and len(engine.banks) == 2:
        angle = engine.bank_angle_deg
    shafts = [] if given.text("--shafts") is None else given.whole_numbers("--shafts")
    found = design(
        len(engine) if given.text("--cylinders") is None else given.whole("--cylinders"),
        layout=layout,
        cylinder=engine.cylinders[0],
        spacing=_spacing(engine),
        rotating_mass=float(engine.rotating_mass[0]),
        rpm=given.number("--rpm", "rpm"),
        by=given.text("--by"),
        bank_angle_deg=angle,
        pin_split_deg=_angles(given, "--pin-split"),
        same_split=not given.text("--own-splits"),
        throws_deg="free" if given.text("--throws") == "free" else given.names("--throws"),
        even_firing=given.text("--even-firing"),
        intervals_deg=given.names("--intervals"),
        counterweights=given.text("--counterweights"),
        shafts=shafts,
        orders=given.orders(),
        count=given.whole("--count"),
        seed=given.whole("--seed"),
    )
    if pick > len(found) and given.text("--save") is not None:
        raise rejected("--pick", str(pick), f"there are {len(found)} designs")
    engines = dict(enumerate(found.engines, start=1))
    return Shown(found.frames, found, engine=engines.get(pick))


def _spacing(engine: Engine) -> float:
    """Return the distance between neighbouring throws."""
    along = np.sort(engine.z[[number - 1 for number in next(iter(engine.banks.values()))]])
    return float(along[1] - along[0]) if along.size > 1 else 0.0


def _angles(given: Given, flag: str) -> Any:  # noqa: ANN401 - one angle or two, as exact text
    """Return an angle or the ends of a range; angles stay text, which may be a fraction."""
    if (text := given.text(flag)) is None:
        return None
    ends = [end.strip().removesuffix("°") for end in text.split(":")]
    for end in ends:
        if "/" not in end:
            given.one(flag, end, "°", "one angle, or LOW:HIGH")
    if len(ends) > 2:
        raise rejected(flag, text, "give one angle, or LOW:HIGH")
    return ends[0] if len(ends) == 1 else tuple(ends)


def _spread(figure: str) -> Option:
    title, unit = labels.TOLERANCES[figure]
    what = f"spread of the {title} of each {'crankpin' if 'crank' in title else 'cylinder'}"
    unit = "degrees" if unit == "°" else unit
    return option(FLAGS[figure], metavar="X", default="0", help=f"{what}, {unit}")


@command(
    "tolerances",
    "residuals caused by deviating masses, crankpins, places and rods",
    "name",
    *map(_spread, FIGURES),
    option(
        "--distribution",
        choices=tuple(SPREADS),
        default="normal",
        help="distribution of the deviations (default: %(default)s)",
    ),
    option("--samples", default="10000", help="number of samples (default: %(default)s)"),
    "--seed --rpm",
    option(
        "--by", default=None, help="what to report, as for rank (default: total peaks, and order 1)"
    ),
    option(
        "--shares", action="store_true", help="report the share of each tolerance in the variance"
    ),
    "--orders --rtol --reference-z --units --csv --plot",
    example="tolerances i6 --rpm 6000 --reciprocating-mass 2g --pin 0.1 --shares",
    note="Spreads are standard deviations, or half widths with --distribution uniform.",
)
def _tolerances(given: Given) -> Shown:
    engine = given.engine("tolerances")
    samples = given.whole("--samples")
    if samples > MOST_SAMPLES:
        raise rejected("--samples", str(samples), f"give {MOST_SAMPLES} at most")
    spreads: dict[str, Any] = {
        name: given.number(flag, labels.TOLERANCES[name][1]) for name, flag in FLAGS.items()
    }
    if not any(spreads.values()):
        first, *_ = flags = [*FLAGS.values()]
        hint = f"no part deviates; give a spread, {', '.join(flags)}"
        raise rejected(first, given.text(first), hint)
    note = ""
    if engine.fired:
        engine, note = engine.with_cycle(None), "Gas pressure is not counted.\n"
    result = tolerances(
        engine,
        rpm=given.number("--rpm", "rpm"),
        **spreads,
        distribution=given.text("--distribution"),
        samples=samples,
        seed=given.whole("--seed"),
        by=given.text("--by"),
        **given.chosen(),
    )
    if given.text("--shares"):
        return Shown(only(result.shares), result, {"kind": "shares"}, note=note)
    return Shown(result.frames, result, note=note)
