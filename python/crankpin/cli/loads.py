"""Commands on loads inside an engine: torque with gas pressure, and what bearings carry."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._support import labels
from crankpin._support.quantities import LOADS
from crankpin.analysis.bearings import AXES, bearing_loads
from crankpin.cli.arguments import command, shared
from crankpin.cli.outputs import draw, left_out, printed
from crankpin.model.computed_cycles import EXAMPLES
from crankpin.model.cycle import Cycle

if TYPE_CHECKING:
    from crankpin.cli.arguments import Commands, Given
    from crankpin.model.engine import Engine

ON = {"crank": "crank_torque", "block": "torque"}
"""What a torque acts on → its quantity."""


def add_torque(commands: Commands) -> None:
    """Add the command ``torque``."""
    fired = command(
        commands,
        "torque",
        "torque of gas pressure and inertia by half orders, with phases",
        example="torque i4 --rpm 1500 --bore 86mm --plot torque.png",
        run=_torque,
        note="Order n is |T|·cos(n·θ + phase), θ from cylinder 1's top dead centre.\n"
        "The engine needs a firing order.",
    )
    shared(fired, "name", "--rpm", "--orders", "--rtol")
    fired.add_argument(
        "--on",
        choices=tuple(ON),
        default="crank",
        help="torque that is printed (default: %(default)s)",
    )
    shared(fired, "--cycle", default="petrol")
    shared(fired, "--bore", "--crankcase")
    fired.add_argument(
        "--picture",
        choices=("curves", "spectrum"),
        default="curves",
        help="over the crank angle, or by order (default: %(default)s)",
    )
    shared(fired, "--units", "--csv", "--plot")


def _torque(given: Given) -> str:
    engine, note = _fired(given, "torque")
    chosen, rpm = given.chosen(), given.number("--rpm", "rpm")
    picture, quantity = given.picture_file(), ON[given.text("--on")]
    balance = engine.balance(rpm, **chosen)
    if given.text("--picture") == "spectrum":
        draw(balance, picture, quantity=quantity)
    elif picture is not None:
        draw(engine.waveform(rpm), picture, quantity=quantity)
    table = getattr(balance, quantity).table
    title = f"{labels.name_of(engine)} at {rpm:g} rpm: {table.title}"
    text = printed(table.replace(title=title), csv=given.text("--csv"))
    if given.text("--csv"):
        return text
    return text + note + (left_out(balance) if chosen["orders"] == "auto" else "")


def add_bearings(commands: Commands) -> None:
    """Add the command ``bearings``."""
    inside = command(
        commands,
        "bearings",
        "loads of crankpins, wrist pins, cylinder walls and main bearings",
        example="bearings i4 --rpm 6000 --load crankpin --axes crank --plot pin.png",
        run=_bearings,
        note="Main bearings share the loads between them by the lever rule.",
    )
    shared(inside, "name", "--rpm")
    shared(
        inside,
        "--cycle",
        help="cylinder pressure over crank angle: a file, or petrol or diesel for an example "
        "(default: none)",
    )
    shared(inside, "--bore", "--crankcase")
    inside.add_argument(
        "--load",
        choices=tuple(LOADS),
        default="main",
        help="what is drawn, and with --csv whether main bearings or cylinders are printed "
        "(default: %(default)s)",
    )
    inside.add_argument(
        "--picture",
        choices=("polar", "curves", "bending"),
        default="polar",
        help="default: %(default)s",
    )
    inside.add_argument(
        "--axes",
        choices=AXES,
        default="engine",
        help="axes of a polar picture (default: %(default)s)",
    )
    shared(inside, "--units", "--csv", "--plot")


def _bearings(given: Given) -> str:
    engine, note = _fired(given, "bearings")
    picture, kind = given.picture_file(), given.text("--picture")
    loads = bearing_loads(engine, given.number("--rpm", "rpm"))
    options = {"polar": ("load", "axes"), "curves": ("load",), "bending": ()}[kind]
    draw(loads, picture, kind=kind, **{name: given.text(f"--{name}") for name in options})
    table = loads.table
    if not given.text("--csv"):
        return printed(table, csv=False) + note
    return printed(table.below or table if given.text("--load") == "main" else table, csv=True)


def _fired(given: Given, name: str) -> tuple[Engine, str]:
    """Return the engine, with gas pressure if there is any, and a note of what was assumed."""
    engine, typed = given.engine(name), given.text("--cycle")
    if typed is None:
        return engine, ""
    example = typed in EXAMPLES
    cycle = Cycle.example(typed, strokes=engine.strokes) if example else Cycle.load(typed)
    bore = given.optional("--bore", "m")
    unknown = bore is None and any(each.bore is None for each in engine.cylinders)
    cylinders = [
        each.replace(bore=bore or each.bore or each.stroke) if unknown or bore else each
        for each in engine.cylinders
    ]
    fired = engine.replace(cylinder=cylinders).with_cycle(
        cycle, crankcase=given.number("--crankcase", "Pa")
    )
    shown = labels.cut(labels.printable(cycle.name) or typed)
    note = " Bores that are not known are taken to equal the stroke." if unknown else ""
    return fired, f"Cycle: {shown}.{note}\n"
