"""Commands: comparison, star diagrams, closed forms, flywheels and harmonics."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.frames import Frames
from crankpin._support.tables import Table
from crankpin.analysis.comparison import LUMPED, compare
from crankpin.analysis.exercises import TOPICS, exercise
from crankpin.analysis.flywheel import flywheel
from crankpin.analysis.rims import flywheel_rim
from crankpin.analysis.star import star_diagram
from crankpin.analysis.turning_moment import stroke_load, turning_moment_areas
from crankpin.cli.loads import OF_A_FILE, fired
from crankpin.cli.options import OPTIONS, command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown, only
from crankpin.model import table_files
from crankpin.model.cylinder import slider_crank_harmonics
from crankpin.model.engine import Engine
from crankpin.model.engine_files import ENGINE_ENDINGS
from crankpin.model.table_files import FILE_HINT, TABLE_ENDINGS

if TYPE_CHECKING:
    from crankpin.analysis.flywheel import Flywheel
    from crankpin.analysis.turning_moment import TurningMomentAreas
    from crankpin.cli.arguments import Given

DIAGRAM = "turning-moment diagram"
"""Title of the options of what drives a crank in place of an engine."""
OF_ENGINES = ("--cycle", "--firing-order", "--bore", "--crankcase",
              *(option.label for option in OF_A_FILE))  # fmt: skip
"""Options that nothing but an engine has."""
HIGHEST_PRINTED = 12
"""Highest order of the harmonics that are printed without ``--orders``."""


@command(
    "compare",
    "two engines at one speed: peaks of each order, before and after",
    option(
        "names",
        metavar="NAME",
        nargs="+",
        help="two presets or engine files (.toml, .json); lumped for the first as textbooks lump "
        "it: what rotates moves along the bores",
    ),
    "--rpm --orders --rtol --quantity --reference-z --spectrum --units --csv --plot",
    example="compare i4 i4-crossplane --rpm 6000 --plot both.png",
)
def _compare(call: Given) -> Shown:
    names = call.text("names")
    lumped = names[1:] == [LUMPED]
    engines = [*call.engines(names[:1] if lumped else None).values()]
    if len(engines) != (1 if lumped else 2):
        several = "engine" if len(engines) == 1 else "engines"
        raise inputs.faulty("NAME", f"stands for {len(engines)} {several}", "give two")
    before, after = engines[0], engines[-1]
    rpm = call.number("--rpm", "rpm")
    comparison = compare(
        before, LUMPED if lumped else after, rpm, spectrum=call.spectrum(), **call.chosen()
    )
    return Shown(comparison.frames, comparison, {"quantity": call.quantity(engines)})


@command(
    "flywheel",
    "speed over a cycle with a flywheel, or the flywheel that keeps it even, and its rim",
    option("name", nargs="?", help=f"{OPTIONS['name']['help']}; or --drive, --load or --areas"),
    "--rpm",
    keyword(flywheel, "inertia", metavar="J"),
    keyword(flywheel, "irregularity", metavar="X", more=", 0.01 or 1%"),
    "--cycle --firing-order --bore --crankcase",
    *OF_A_FILE,
    option(
        "--drive",
        metavar="TORQUE",
        group=DIAGRAM,
        help='torque in place of an engine, N·m: a formula, "5000 + 600 sin 2θ", or a file of '
        "columns of crank angles, degrees, and torques",
    ),
    option(
        "--load",
        argument="load_torque",
        metavar="TORQUE",
        action="append",
        group=DIAGRAM,
        help="torque of a load, as --drive, or the engine file of a machine on the same crank, "
        "such as a compressor; once for each. Without an engine or --drive a motor drives it "
        "evenly",
    ),
    option(
        "--stroke-load",
        metavar="E,DURATION",
        action="append",
        group=DIAGRAM,
        help="a load such as a punch that takes its energy E, J, over this angle of each turn, "
        "degrees; also E,DURATION,START,PERIOD",
    ),
    *keywords(turning_moment_areas, "areas torque_scale angle_scale_deg spread", group=DIAGRAM),
    *keywords(
        flywheel_rim,
        "mean_diameter rim_speed hoop_stress width_ratio width thickness share density",
        group="rim",
    ),
    "--units",
    option("--frame", choices=("table", "approximations", "orders", "levels", "rim")),
    "--csv --plot",
    example="flywheel i4 --rpm 800 --irregularity 2% --bore 86mm",
)
def _flywheel(call: Given) -> Shown:
    figures, areas = call.keywords(flywheel), call.keywords(turning_moment_areas)
    rpm, note = call.number("--rpm", "rpm"), ""
    loads = [_load(text) for text in call.text("--load") or ()]
    loads += [_stroke_load(call, text) for text in call.text("--stroke-load") or ()]
    wheel: Flywheel | TurningMomentAreas
    others = ["--drive", "--load", "--stroke-load"] if "areas" in areas else []
    if others or call.text("name") is None:
        others += OF_ENGINES
    if "areas" in areas and call.text("name") is not None:
        raise rejected("NAME", call.text("name"), "leave it out: --areas stand for an engine")
    if flag := next(filter(call.text, others), None):
        hint = "leave it out: it needs an engine" if flag in OF_ENGINES else "leave out --areas"
        raise rejected(flag, str(call.text(flag)), hint)
    if "areas" in areas:
        wheel = turning_moment_areas(rpm=rpm if figures else None, **figures, **areas)
    else:
        if areas:
            raise inputs.faulty("--areas", "is missing", "give them, or leave out their scales")
        drive: Any = call.text("--drive") and _curve("--drive", call.text("--drive"))
        if call.text("name") is not None:
            if drive:
                raise rejected("--drive", call.text("--drive"), "leave it out: an engine drives")
            drive, note = fired(call, "flywheel")
        elif not (drive or loads):
            raise inputs.faulty("NAME", "is missing", "give an engine, --drive, --load or --areas")
        wheel = flywheel(drive, rpm, load_torque=loads or None, **figures)
    frames = wheel.frames
    if section := call.keywords(flywheel_rim):
        if wheel.inertia is None:
            raise inputs.faulty("--irregularity", "is missing", "a rim needs it, or --inertia")
        rim = flywheel_rim(wheel.inertia, rpm=rpm, **section)
        frames = Frames({name: partial(frames.__getitem__, name) for name in frames}
                        | {"rim": lambda: rim.table})  # fmt: skip
    return Shown(frames, wheel, note=note)


def _curve(flag: str, text: str) -> Any:  # noqa: ANN401 - a formula, or angles and torques
    """Return a formula as it is, and the columns of a file."""
    if Path(text).suffix.lower() not in TABLE_ENDINGS:
        return text
    theta, torque = table_files.read(
        inputs.file_path(text, TABLE_ENDINGS, FILE_HINT), [0, 1]
    ).numbers.T
    if not len(theta):
        raise rejected(flag, text, "has no rows of numbers")
    return theta, torque


def _load(text: str) -> Any:  # noqa: ANN401 - an engine, or as a curve
    """Return the machine of an engine file, or what drives alike."""
    is_engine = Path(text).suffix.lower() in ENGINE_ENDINGS
    return Engine.load(text) if is_engine else _curve("--load", text)


def _stroke_load(call: Given, text: str) -> Any:  # noqa: ANN401 - angles and torques
    """Return the load of an energy, a duration and, where typed, a beginning and a period."""
    energy, *angles = call.listed("--stroke-load", text)
    names = ("duration_deg", "start_deg", "period_deg")
    if not 1 <= len(angles) <= len(names):
        raise rejected("--stroke-load", text, "give E,DURATION or E,DURATION,START,PERIOD")
    return stroke_load(energy, **dict(zip(names, angles, strict=False)))


@command(
    "star",
    "phase vectors of a firing order and their sums, order by order",
    "name",
    option("--orders", default=None, help="such as 0.5,1,1.5 (default: all up to 12)"),
    *keywords(star_diagram, "mode_shape firing_order strokes"),
    "--csv --plot",
    example="star i6 --orders 0.5,1.5,3 --mode-shape 1,0.95,0.86,0.73,0.57,0.39",
)
def _star(call: Given) -> Shown:
    orders = None if call.text("--orders") is None else call.orders()
    star = star_diagram(call.engine("star"), orders, **call.keywords(star_diagram))
    return Shown(star.frames, star)


@command(
    "closed-form",
    "force or moment of one order as a formula (needs SymPy)",
    "name",
    option("--order", default="1", help="whole multiple of crank speed (default: %(default)s)"),
    option(
        "--quantity",
        choices=("force", "moment"),
        help="what the formula is of (default: moment, or force if all cylinders are at one z)",
    ),
    "--reference-z --units",
    example="closed-form i3 --order 1",
)
def _closed_form(call: Given) -> str:
    engine = call.engine("closed-form")
    quantity: Any = call.quantity([engine])
    return f"{engine.closed_form(call.whole('--order'), quantity)!r}\n"


@command(
    "exercise",
    "an exercise sheet with figures of its own, and its solution",
    option("topic", metavar="TOPIC", help=f"{', '.join(TOPICS)}"),
    "--seed",
    option("--solution", action="store_true", help="print the solution too"),
    example="exercise v-angle --seed 7 --solution",
)
def _exercise(call: Given) -> str:
    topic = inputs.one_of("TOPIC", call.text("topic"), TOPICS)
    sheet = exercise(topic, call.whole("--seed"))
    solution = f"\n{sheet.solution}\n" if call.text("--solution") else ""
    return f"{sheet}\n{solution}"


@command(
    "harmonics",
    "harmonics of a slider-crank's inertia force, exact, over m·r·ω²",
    option(
        "ratio", metavar="RATIO", nargs="?", help="crank radius / rod length, such as 0.3 or 1/3.5"
    ),
    option("--stroke", metavar="LENGTH", help="stroke, in place of RATIO with --rod-length"),
    option("--rod-length", metavar="LENGTH", help="rod length between the centres"),
    option("--pin-offset", metavar="LENGTH", help="offset of the piston pin's path (default: 0)"),
    option("--orders", default=None, help="such as 1,2,4 (default: all up to 12)"),
    "--units --csv",
    example="harmonics 0.3 --orders 1,2,4,6",
    note="The force along the bore is m·r·ω² times the sum of aₙ·cos(n·θ + phase).",
)
def _harmonics(call: Given) -> Shown:
    offset = call.optional("--pin-offset", "m")
    ratio, radius = _ratio(call)
    orders: Any = (
        [*range(1, HIGHEST_PRINTED + 1)] if call.text("--orders") is None else call.orders()
    )
    if offset is not None and radius is None:
        raise rejected("--pin-offset", call.text("--pin-offset"), "needs --stroke")
    if offset is None or radius is None:
        harmonics = slider_crank_harmonics(ratio, orders).astype(complex)
    else:
        harmonics = slider_crank_harmonics(ratio, orders, offset / radius)
    phases = np.where(harmonics == 0.0, 0.0, np.angle(harmonics, deg=True))
    title = f"Slider-crank, rod ratio {ratio:.6g}"
    title += "" if offset is None else f", pin offset {call.echo('--pin-offset', 'm')}"
    table = Table.from_rows(
        title,
        ["order", "amplitude", ("phase", "°")],
        [(n, float(abs(a)), float(p)) for n, a, p in zip(orders, harmonics, phases, strict=True)],
    )
    return Shown(only(table))


def _ratio(call: Given) -> tuple[float, float | None]:
    """Return the rod ratio, and the crank radius, m, if it is known."""
    typed = call.text("ratio")
    stroke, length = call.optional("--stroke", "m"), call.optional("--rod-length", "m")
    if (typed is None) == (stroke is None or length is None):
        raise inputs.faulty("RATIO", "is left out", "give it, or --stroke and --rod-length")
    if stroke is not None and length is not None:
        if not length > 0.0:
            raise rejected("--rod-length", call.text("--rod-length"), "give a length above 0")
        return 0.5 * stroke / length, 0.5 * stroke
    above, _, below = typed.partition("/")
    divisor = call.one("RATIO", below or "1", "")
    if not divisor:
        raise rejected("RATIO", typed, "give a number between 0 and 1, such as 0.3 or 1/3.5")
    return call.one("RATIO", above, "") / divisor, None
