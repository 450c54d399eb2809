"""Commands: makers' tables of forces, couples and guide-force moments; locomotives."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import files, inputs, units
from crankpin._support.frames import Frames
from crankpin.analysis.force_table import force_table
from crankpin.analysis.foundation_table import foundation_table
from crankpin.analysis.guide_moments import guide_moments
from crankpin.analysis.locomotive import Locomotive
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.cli.loads import OF_A_FILE, fired
from crankpin.cli.options import command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown
from crankpin.model.cylinder import Cylinder
from crankpin.model.forces import ForceTable
from crankpin.model.mounts import RigidBody
from crankpin.model.shafts import Unbalance
from crankpin.model.soil import Soil

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given
    from crankpin.model.engine import Engine

SPEEDS = option("--rpm", metavar="RANGE", help="crank speeds (default: %(default)s)")
"""One speed, or several."""
OF_GAS = ("--cycle", "--firing-order", "--bore", "--crankcase")
"""Options that are of gas pressure, which then counts."""


TABLES = (".csv", ".unv", ".uff")
"""Endings of makers' tables."""
ON_SOIL = "a block on soil"
OF_SOIL = ("--soil", "--machine", "--top", "--density", "--embedment", "--soil-damping", "--at")
"""Options that need a block."""


@command(
    "foundation",
    "forces of a machine on its foundation, as makers print them, and of a block on soil",
    option(
        "name",
        metavar="NAME",
        help="a preset, an engine file (.toml, .json), or a maker's table of forces (.csv, .unv)",
    ),
    "--add-load",
    option(
        "--rpm",
        metavar="RANGE",
        default=None,
        help="crank speeds (default: 3000, or that of the table)",
    ),
    option(
        "--orders", default=None, help="such as 1,2,4,6 (default: 1,2; with --maker or --block all)"
    ),
    keyword(foundation_table, "vertical_deg"),
    option(
        "--maker",
        action="store_true",
        help="amplitudes by their names, M1V, M1H, M2V, H6, X3, at one speed",
    ),
    option(
        "-o",
        "--out",
        argument="path",
        metavar="FILE",
        help="write the table of --maker, which this command reads (.csv, .unv)",
    ),
    option("--table-rpm", metavar="RPM", help="crank speed of a table that does not have it"),
    option("--lag", action="store_true", help="phases of the table are lags: cos(n·θ − phase)"),
    option(
        "--cycle",
        help="cylinder pressure over crank angle, as of torque, which counts in H and X types: a "
        "text file, petrol or diesel for an example, none (default: the engine's own, if any)",
    ),
    "--firing-order --bore --crankcase --reference-z",
    *OF_A_FILE,
    option(
        "--block",
        group=ON_SOIL,
        metavar="W,H,L",
        help="sides of a block of concrete along x, y and z, m: prints its motion and modes",
    ),
    keyword(RigidBody.block, "top", group=ON_SOIL, metavar="X,Y,Z"),
    keyword(RigidBody.block, "density", group=ON_SOIL),
    option(
        "--machine",
        group=ON_SOIL,
        metavar="MASS,X,Y,Z",
        help="mass and centre of gravity of the machine on it, and its moments of inertia about x, "
        "y and z behind these (default: none, and without moments those of a ball of steel)",
    ),
    option(
        "--soil",
        group=ON_SOIL,
        metavar="G,NU,RHO",
        help="shear modulus, Pa, Poisson's ratio and density of the soil, kg/m³ (default of the "
        "last two: 0.35, 1800)",
    ),
    keyword(Soil, "damping_ratio", "--soil-damping", group=ON_SOIL),
    keyword(Soil.mount, "embedment", group=ON_SOIL),
    option(
        "--at",
        group=ON_SOIL,
        argument="point",
        metavar="X,Y,Z",
        help="point whose motion is printed, m (default: the middle of the block's top)",
    ),
    "--units",
    option("--frame", choices=("table", "modes", "force", "loads")),
    "--csv --plot --save --force",
    example="foundation marine-5 --rpm 210 --orders 1,2,4",
    note="Of an engine with balance shafts, or compensators, the table has both: with them, and\n"
    "without. Order n is amplitude·cos(n·θ + phase), θ the crank angle. A block on soil:\n"
    "  crankpin foundation marine-6 --rpm 80:120:2 --block 4,2.5,9 --top 0,-1.2,1.5 --soil 6e7",
)
def _foundation(call: Given) -> Shown:
    source, note = _source(call)
    typed: Any = call.range("--rpm", "rpm")
    default = source.rpm if isinstance(source, ForceTable) else 3000.0
    rpm = default if typed is None else typed
    if call.text("--block") is not None:
        return _on_soil(call, source, rpm, note)
    for flag in (*OF_SOIL, "--save"):
        if call.text(flag) is not None:
            raise rejected(flag, call.text(flag), "needs --block")
    if isinstance(source, ForceTable):
        return _written(call, source, note)
    if call.text("--maker") or call.text("--out") is not None:
        if np.ndim(rpm):
            raise rejected("--rpm", call.text("--rpm"), "--maker takes one speed")
        plane = call.optional("--reference-z", "m")
        table = force_table(source, rpm, orders=_orders(call, "auto"), reference_z=plane)
        return _written(call, table, note)
    orders: Any = _orders(call, (1, 2))
    if isinstance(orders, str):
        raise rejected("--orders", orders, "give multiples of crank speed, such as 1,2,4")
    free = foundation_table(source, rpm, orders=orders, **call.keywords(foundation_table))
    return Shown(free.frames, free)


def _written(call: Given, table: ForceTable, note: str) -> Shown:
    """Return a maker's table, written to the file of ``--out``."""
    if (typed := call.text("--out")) is not None:
        hint = "the table of --maker is .csv, .unv or .uff"
        path = inputs.file_path(typed, TABLES, hint, "--out")
        if path.suffix.lower() == ".csv":
            files.write(path, table.to_csv())
        else:
            table.to_unv(path)
        note = f"{note}Written to {path}.\n"
    return Shown(table.frames, table, note=note)


def _orders(call: Given, default: Any) -> Any:  # noqa: ANN401 - orders
    return default if call.text("--orders") is None else call.orders()


def _source(call: Given) -> tuple[Engine | ForceTable, str]:
    """Return the engine or the maker's table of NAME, and a note of what was assumed."""
    name = call.text("name")
    if (ending := Path(name).suffix.lower()) in TABLES:
        of_engine = (*OF_GAS, "--maker", "--add-load", "--reference-z", "--vertical")
        for flag in of_engine:
            if typed := call.text(flag):
                raise rejected(flag, str(typed), "is of an engine, and NAME is a table")
        speed = call.optional("--table-rpm", "rpm")
        if ending == ".csv":
            lag = call.text("--lag")
            return ForceTable.from_csv(name, speed, lag=lag, name=Path(name).stem), ""
        if call.text("--lag"):
            raise rejected("--lag", "True", "is of a table of text, and NAME is a universal file")
        return ForceTable.from_unv(name, speed, name=Path(name).stem), ""
    for flag in ("--table-rpm", "--lag"):
        if typed := call.text(flag):
            raise rejected(flag, str(typed), "is of a table, and NAME is an engine")
    if call.text("--cycle") is None and all(call.text(flag) is None for flag in OF_GAS):
        return call.engine("foundation"), ""
    return fired(call, "foundation")


def _on_soil(call: Given, source: Engine | ForceTable, rpm: Any, note: str) -> Shown:  # noqa: ANN401
    """Return motion, modes and forces of a block on soil."""
    if (typed := call.text("--out")) is not None:
        raise rejected("--out", typed, "is of a table: leave it out beside --block, or use --save")
    sides = call.numbers("--block", "m") or []
    if len(sides) != 3:
        raise rejected("--block", call.text("--block"), "give three sides: W,H,L")
    if call.text("--soil") is None:
        raise rejected("--block", call.text("--block"), "needs --soil")
    width, height, length = sides
    block = RigidBody.block(width, height, length, **call.keywords(RigidBody.block))
    body, top = block, (block.cg[0], block.cg[1] + 0.5 * height, block.cg[2])
    if (machine := call.text("--machine")) is not None:
        body = RigidBody.combined(block, _machine(call, machine))
    figures = call.text("--soil").split(",")
    if not 1 <= len(figures) <= 3:
        raise rejected("--soil", call.text("--soil"), "give G, or G,NU or G,NU,RHO")
    known = zip(("shear_modulus", "poisson", "density"), figures, ("Pa", "", ""), strict=False)
    soil = Soil(
        **{name: call.one("--soil", text, unit) for name, text, unit in known},
        **call.keywords(Soil),
    )
    base = (top[0], top[1] - height, top[2])
    ground = soil.mount(body, width=width, length=length, at=base, **call.keywords(Soil.mount))
    powertrain = Powertrain(source, body, [ground])
    response = powertrain.response(rpm, orders=_orders(call, "auto"))
    place: Any = call.numbers("--at", "m") or top
    moved = response.at(place)
    makers: dict[str, Any] = {
        "table": lambda: moved.table,
        "modes": lambda: powertrain.modes().table,
        "force": lambda: response.table,
    }
    if "loads" in response.frames:
        makers["loads"] = lambda: response.frames["loads"]
    return Shown(Frames(makers), moved, engine=powertrain, note=note)


STEEL = 7850.0
"""Density of a ball whose moments a machine has without others, kg/m³."""


def _machine(call: Given, typed: str) -> RigidBody:
    """Return the machine on a block, of its mass, centre of gravity and moments of inertia."""
    units_of = ("kg", "m", "m", "m", "kg·m²", "kg·m²", "kg·m²")
    parts = typed.split(",")
    if len(parts) not in (4, 7):
        raise rejected("--machine", typed, "give MASS,X,Y,Z or MASS,X,Y,Z,IX,IY,IZ")
    mass, *numbers = (
        call.one("--machine", text, unit) for text, unit in zip(parts, units_of, strict=False)
    )
    moments = numbers[3:] or [0.4 * mass * (0.75 * mass / (math.pi * STEEL)) ** (2 / 3)] * 3
    return RigidBody(mass, numbers[:3], moments)


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
