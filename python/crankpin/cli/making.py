"""Commands: inverse design and tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import labels
from crankpin.analysis.design.design import design
from crankpin.analysis.tolerances.spreads import FIGURES
from crankpin.analysis.tolerances.tolerances import tolerances
from crankpin.cli.options import PROG, command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown, only

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given
    from crankpin.cli.options import Option
    from crankpin.model.engine import Engine

MOST_TYPED_SAMPLES = 10_000_000
SPREAD_FLAGS = {name: f"--{name.removesuffix('_deg').replace('_', '-')}" for name in FIGURES}
"""Figure that spreads → its option."""


def _angles(call: Given, flag: str) -> Any:  # noqa: ANN401 - one angle or two, as exact text
    """Return an angle or the ends of a range; angles stay text, which may be a fraction."""
    text: str = call.text(flag)
    ends = [end.strip().removesuffix("°") for end in text.split(":")]
    for end in ends:
        if "/" not in end:
            call.one(flag, end, "°", "one angle, or LOW:HIGH")
    if len(ends) > 2:
        raise rejected(flag, text, "give one angle, or LOW:HIGH")
    return ends[0] if len(ends) == 1 else tuple(ends)


def _with_unknown(call: Given, flag: str) -> list[Any] | str:
    """Return masses, places or throws, one for each cylinder, None where it is left out."""
    text: str = call.text(flag)
    parts = [part.strip().rstrip("?") for part in text.split(",")]
    if flag == "--throws":
        return (
            text
            if text == "free"
            else [call.angles(flag, text=part)[0] if part else None for part in parts]
        )
    unit = "kg" if flag == "--masses" else "m"
    return [call.one(flag, part, unit) if part else None for part in parts]


@command(
    "design",
    "cranks, pin splits and bank angles that minimise an objective",
    "name",
    keyword(design, "cylinders", default="NAME's"),
    keyword(design, "layout", default="inline or vee"),
    "--by",
    keyword(design, "bank_angle_deg", read=_angles, metavar="LOW:HIGH", default="NAME's"),
    keyword(design, "pin_split_deg", read=_angles, metavar="LOW:HIGH", default="shared pins"),
    keyword(design, "same_split", "--own-splits", help="let each throw have a split of its own"),
    keyword(design, "throws_deg", read=_with_unknown),
    keyword(design, "masses", read=_with_unknown, metavar="MASS,…", more=": 400,,,300"),
    keyword(design, "positions", read=_with_unknown, metavar="LENGTH,…"),
    *keywords(design, "even_firing intervals_deg counterweights"),
    keyword(
        design,
        "shafts",
        metavar="A,B,…",
        help="speed ratios of balance shafts that are allowed: --shafts=-1 or --shafts=2,-2",
    ),
    "--rpm --orders",
    *keywords(design, "count seed"),
    "--units --csv --plot",
    option("--save", help="write the design of --pick, an engine file (.toml, .json)"),
    option(
        "--pick", metavar="N", default="1", help="which design --save writes (default: %(default)s)"
    ),
    "--force",
    example="design v10-72 --bank-angle 60:120 --even-firing --by total.moment.peak\n"
    f"  {PROG} design i4 --masses 400,,,400 --positions 0,0.45,1.2,1.8 --throws 0,,,120 "
    "--by [1].force.peak,[1].moment.peak",
    note="Moving parts, spacing, bank angle, number of cylinders and banks are those of NAME;\n"
    "its crank is not used. Objectives are those of rank. Ranges are LOW:HIGH. With --masses\n"
    "or --positions cylinders in line are unlike; what is left out, or ?, is chosen.",
)
def _design(call: Given) -> Shown:
    engine = call.engine("design")
    if len(set(engine.cylinders)) > 1 or len(engine.banks) > 2:
        hint = "give an engine with one or two banks and one kind of cylinder"
        raise rejected("NAME", call.text("name"), hint)
    pick, vee = call.whole("--pick"), len(engine.banks) == 2
    options: dict[str, Any] = {"cylinders": len(engine), "layout": "vee" if vee else "inline"}
    options |= call.keywords(design)
    if pick < 1 or pick > options.get("count", pick):
        raise rejected("--pick", str(pick), "give the place of one of the designs, from 1")
    if vee and options["layout"] == "vee":
        options.setdefault("bank_angle_deg", engine.bank_angle_deg)
    if not {"masses", "positions"} & options.keys():
        options["rotating_mass"] = float(engine.rotating_mass[0])
    designs = design(
        cylinder=engine.cylinders[0],
        spacing=_spacing(engine),
        rpm=call.number("--rpm", "rpm"),
        by=call.text("--by"),
        orders=call.orders(),
        **options,
    )
    if pick > len(designs) and call.text("--save") is not None:
        raise rejected("--pick", str(pick), f"there are {len(designs)} designs")
    engines = dict(enumerate(designs.engines, start=1))
    return Shown(designs.frames, designs, engine=engines.get(pick))


def _spacing(engine: Engine) -> float:
    """Return the distance between neighbouring throws."""
    along = np.sort(engine.z[[number - 1 for number in next(iter(engine.banks.values()))]])
    return float(along[1] - along[0]) if along.size > 1 else 0.0


def _spread(figure: str) -> Option:
    title, unit = labels.TOLERANCES[figure]
    what = f"spread of the {title} of each {'crankpin' if 'crank' in title else 'cylinder'}"
    unit = "degrees" if unit == "°" else unit
    return option(SPREAD_FLAGS[figure], metavar="X", default="0", help=f"{what}, {unit}")


@command(
    "tolerances",
    "residuals caused by deviating masses, crankpins, places and rods",
    "name",
    *map(_spread, FIGURES),
    *keywords(tolerances, "distribution samples seed"),
    "--rpm",
    option(
        "--by", default=None, help="what to report, as for rank (default: total peaks, and order 1)"
    ),
    option(
        "--shares", action="store_true", help="report the share of each tolerance in the variance"
    ),
    "--orders --rtol --reference-z --units --csv --plot",
    example="tolerances i6 --rpm 6000 --reciprocating-mass 2g --pin 0.1 --shares",
)
def _tolerances(call: Given) -> Shown:
    engine = call.engine("tolerances")
    options = call.keywords(tolerances)
    if options.get("samples", 0) > MOST_TYPED_SAMPLES:
        raise rejected("--samples", call.text("--samples"), f"give {MOST_TYPED_SAMPLES} at most")
    spreads: dict[str, Any] = {
        name: call.number(flag, labels.TOLERANCES[name][1]) for name, flag in SPREAD_FLAGS.items()
    }
    if not any(spreads.values()):
        first, *_ = flags = [*SPREAD_FLAGS.values()]
        hint = f"no part deviates; give a spread, {', '.join(flags)}"
        raise rejected(first, call.text(first), hint)
    note = ""
    if engine.fired:
        engine, note = engine.with_cycle(None), "Gas pressure is not counted.\n"
    result = tolerances(
        engine,
        rpm=call.number("--rpm", "rpm"),
        **spreads,
        **options,
        by=call.text("--by"),
        **call.chosen(),
    )
    if call.text("--shares"):
        return Shown(only(result.shares), result, {"kind": "shares"}, note=note)
    return Shown(result.frames, result, note=note)
