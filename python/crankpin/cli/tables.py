"""Commands: makers' tables of forces, couples and guide-force moments; locomotives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from crankpin._support import inputs, units
from crankpin.analysis.foundation_table import foundation_table
from crankpin.analysis.guide_moments import guide_moments
from crankpin.analysis.locomotive import Locomotive
from crankpin.cli.loads import OF_A_FILE, fired
from crankpin.cli.options import command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown
from crankpin.model.cylinder import Cylinder
from crankpin.model.shafts import Unbalance

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given

SPEEDS = option("--rpm", metavar="RANGE", help="crank speeds (default: %(default)s)")
"""One speed, or several."""
OF_GAS = ("--cycle", "--firing-order", "--bore", "--crankcase")
"""Options that are of gas pressure, which then counts."""


@command(
    "foundation",
    "free forces and couples, horizontal and vertical, as makers print them",
    "name",
    SPEEDS,
    option("--orders", default="1,2", help="such as 1,2,4,6 (default: %(default)s)"),
    keyword(foundation_table, "vertical_deg"),
    "--reference-z --units --csv --plot",
    example="foundation marine-5 --rpm 210 --orders 1,2,4",
    note="Of an engine with balance shafts, or compensators, the table has both: with them, and\n"
    "without. Order n is amplitude·cos(n·θ + phase), θ the crank angle.",
)
def _foundation(call: Given) -> Shown:
    engine, orders = call.engine("foundation"), call.orders()
    if isinstance(orders, str):
        raise rejected("--orders", orders, "give multiples of crank speed, such as 1,2,4")
    rpm: Any = call.range("--rpm", "rpm")
    table = foundation_table(engine, rpm, orders=orders, **call.keywords(foundation_table))
    return Shown(table.frames, table)


@command(
    "guide-moments",
    "guide-force moments of H and X type per order",
    "name",
    SPEEDS,
    option("--orders", help="such as 1,2,3 (default: all up to 12, or twice the cylinders)"),
    keyword(guide_moments, "length"),
    option(
        "--cycle",
        help="cylinder pressure over crank angle, as of torque: a text file, petrol or diesel for "
        "an example, none for no gas pressure (default: the engine's own, if it has any)",
    ),
    "--firing-order --bore --crankcase --reference-z",
    *OF_A_FILE,
    "--units --csv --plot",
    example="guide-moments marine-6 --rpm 210 --cycle diesel --orders 1,2,3,4,6,12",
    note="The X-type bimoment is about the middle of the engine, or --reference-z.",
)
def _guide_moments(call: Given) -> Shown:
    engine, note = call.engine("guide-moments"), ""
    if engine.fired or any(call.text(flag) is not None for flag in OF_GAS):
        engine, note = fired(call, "guide-moments")
    rpm: Any = call.range("--rpm", "rpm")
    moments = guide_moments(engine, rpm, orders=call.orders(), **call.keywords(guide_moments))
    return Shown(moments.frames, moments, note=note)


def _one_or_several(call: Given, flag: str) -> Any:  # noqa: ANN401 - an angle, or several
    angles = call.angles(flag)
    return angles if len(angles) > 1 else angles[0]


def _axles(call: Given, flag: str) -> Any:  # noqa: ANN401 - a number, or several
    numbers = call.whole_numbers(flag)
    return numbers if len(numbers) > 1 else numbers[0]


def _coupling(call: Given, flag: str) -> list[Unbalance]:
    """Return unbalances of rods: amount, place, angle, and the crank that this counts from."""
    weights = []
    for text in call.text(flag).split(","):
        fields = text.split(":")
        if len(fields) not in (3, 4) or (fields[3:] and not fields[3].strip().isdecimal()):
            raise rejected(flag, call.text(flag), "give U:Z:ANGLE or U:Z:ANGLE:CYLINDER")
        amount, z = call.one(flag, fields[0], "kg·m"), call.one(flag, fields[1], "m")
        (angle,) = call.angles(flag, text=fields[2])
        weights.append(Unbalance(amount, z, angle, int(fields[3]) if fields[3:] else None))
    return weights


MOVING = "moving parts of all cylinders"


@command(
    "locomotive",
    "hammer blow, variation of tractive effort and swaying couple of a steam locomotive",
    option("--stroke", group=MOVING, metavar="LENGTH", required=True, help="stroke"),
    option(
        "--rod-length",
        group=MOVING,
        metavar="LENGTH",
        default="inf",
        help="rod length between the centres, or inf for the textbook (default: %(default)s)",
    ),
    option(
        "--reciprocating-mass",
        group=MOVING,
        metavar="MASS",
        required=True,
        help="all that moves with a piston, the rod's share included",
    ),
    keyword(Locomotive, "z", metavar="Z,…", required=True),
    keyword(Locomotive, "throws_deg", metavar="ANGLE,…", required=True),
    keyword(Locomotive, "wheel_z", "--wheels", metavar="Z,Z", required=True),
    *keywords(Locomotive, "share rotating_mass"),
    keyword(Locomotive, "inclination_deg", read=_one_or_several, metavar="ANGLE,…"),
    keyword(Locomotive, "wheel_diameter"),
    keyword(Locomotive, "axle_x", "--axles", metavar="X,…", default="one axle"),
    keyword(Locomotive, "driving", read=_axles, metavar="N,…"),
    keyword(Locomotive, "coupling", read=_coupling, metavar="U:Z:ANGLE[:CYLINDER],…"),
    keyword(Locomotive, "wheel_load"),
    option("--speed", metavar="KMH", help="speed of the locomotive, km/h"),
    option("--rpm", default=None, help="speed of the wheels in its place"),
    option(
        "--hammer-blow",
        metavar="FORCE",
        help="largest hammer blow of a wheel, N: prints the share with which it is so",
    ),
    option("--name", help="name of the locomotive"),
    "--units",
    option("--frame", choices=("table", "wheels")),
    "--csv --plot --save --force",
    example="locomotive --stroke 600mm --reciprocating-mass 300kg --z=-350mm,350mm --throws 0,90 "
    "--wheels=-0.8,0.8 --wheel-diameter 1.7 --share 66% --speed 90",
    note="Places are along the axle from right to left; --save writes the engine, with a crank\n"
    "for each axle and the counterweights of its wheels.",
)
def _locomotive(call: Given) -> Shown:
    (length,) = call.listed("--rod-length", call.text("--rod-length"), "m", infinite=True)
    cylinder = Cylinder(
        call.number("--stroke", "m") / 2.0, length, call.number("--reciprocating-mass", "kg")
    )
    if length != math.inf and not length > 0.0:
        raise rejected("--rod-length", call.text("--rod-length"), "give a length above 0, or inf")
    locomotive = Locomotive(cylinder, name=call.text("--name") or "", **call.keywords(Locomotive))
    rpm, kmh = call.optional("--rpm", "rpm"), call.optional("--speed")
    if (rpm is None) == (kmh is None):
        raise inputs.faulty("--speed", "is left out", "give it, or --rpm; not both")
    note = ""
    if call.text("--hammer-blow") is not None:
        if call.text("--share") is not None:
            raise rejected("--share", call.text("--share"), "leave it out beside --hammer-blow")
        blow = call.number("--hammer-blow", "N")
        share = locomotive.share_for(blow, rpm=rpm, speed_kmh=kmh)
        if share > 1.0:
            hint = "all may be balanced: the hammer blow stays below it"
            raise rejected("--hammer-blow", call.text("--hammer-blow"), hint)
        locomotive = locomotive.replace(share=share)
        note = f"Share of the reciprocating masses that is balanced: {share:.6g}.\n"
    forces = locomotive.forces(rpm, speed_kmh=kmh)
    return Shown(forces.frames, forces, engine=locomotive.engine, note=units.Text(note))
