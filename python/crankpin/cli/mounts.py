"""Commands on an engine on its mounts: modes, axes, forces, a page, design."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.frames import FIRST, PHASES, Frames
from crankpin.analysis.mounts.compare_mounts import compare_mounts
from crankpin.analysis.mounts.design_mounts import KINDS, design_mounts
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.cli.arguments import MOST_ROWS
from crankpin.cli.options import PROG, command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown
from crankpin.model import engine_files
from crankpin.model.base_motion import DIRECTIONS, BaseMotion, read_unit

if TYPE_CHECKING:
    from crankpin.analysis.mounts.response import MountResponse
    from crankpin.cli.arguments import Given

AT_REST = ("--torque", "--gear", "--gravity", "--robustness")
"""Options of what is computed without a response."""
POWERTRAIN_FILE = option(
    "name", argument="path", metavar="FILE", help="an engine file with [powertrain] (.toml, .json)"
)
CASE_FIELDS = {
    "torque": ("torque", "N·m"),
    "gear": ("gear_ratio", ""),
    "rpm": ("rpm", "rpm"),
    "gravity": ("gravity", ""),
    "acceleration": ("acceleration", ""),
    "thrust": ("thrust", "N"),
    "thrust-at": ("thrust_at", "m"),
}
"""Field of ``--case`` → argument of :meth:`Powertrain.static`, and its unit."""
CASE_FORM = f"NAME:FIELD=VALUE:…, of {', '.join(CASE_FIELDS)}"
PICTURE_WORDS = ("cuts", "map", "waterfall", "spectrum")


def _powertrain(call: Given) -> Powertrain:
    """Return what FILE has."""
    return Powertrain.load(engine_files.checked(call.text("name")))


@command(
    "mounts",
    "an engine on its mounts: modes, axes, sag; with --rpm forces and motion by order",
    POWERTRAIN_FILE,
    option(
        "other",
        nargs="?",
        metavar="OTHER",
        help="another such file: force on the body, and motion at --at, beside those of FILE",
    ),
    option(
        "--rpm",
        metavar="RANGE",
        default=None,
        help="crank speeds, for the response to the engine's orders (default: modes and axes)",
    ),
    keyword(Powertrain.modes, "frequency"),
    keyword(Powertrain.static, "torque", metavar="N·M"),
    keyword(Powertrain.static, "gear_ratio", "--gear", metavar="RATIO"),
    keyword(Powertrain.static, "gravity", metavar="X,Y,Z"),
    option(
        "--case",
        argument="cases",
        metavar="NAME:FIELD=VALUE:…",
        action="append",
        help="load case, for travel and force of each mount at rest, such as "
        "'first gear:torque=engine:gear=13' or 'braking:acceleration=0,0,8'; once for each. "
        f"Fields: {', '.join(CASE_FIELDS)}",
    ),
    option(
        "--rest",
        metavar="NAME",
        help="case of --case at which mounts with snubbers rest, for modes and response (default: "
        "under gravity, or as FILE has it)",
    ),
    option(
        "--robustness",
        argument="stiffness",
        metavar="SHARE",
        help="tolerance of all stiffnesses, such as 0.1: bounds of frequencies, least purity found",
    ),
    option(
        "--misfire",
        argument="cylinder",
        metavar="CYLINDER",
        help="number of a cylinder that does not fire",
    ),
    "--axes --orders --rtol",
    option(
        "--at",
        argument="point",
        metavar="X,Y,Z",
        help="point of which the motion is printed and drawn, m, or the name of a receiver",
    ),
    option(
        "--on",
        choices=("powertrain", "support"),
        help="what the point of --at moves with: support, the subframe (default: powertrain)",
    ),
    option(
        "--factor",
        metavar="RANGE",
        help="balance factors, such as 0:1:0.05: rms at --at, or of the force on the body, over "
        "the speeds by factor, and the best one",
    ),
    option(
        "--base",
        metavar="FILE",
        help="motion of what carries the mounts, by frequency or by order with --rpm: columns "
        "frequency or order, and x, y, z with their units (.csv, .xlsx), or amplitudes such as "
        "y=0.1mm or x=0.02g,rz=1e-4rad at --base-hz",
    ),
    option("--base-hz", metavar="RANGE", help="frequencies at which the base of --base moves, Hz"),
    keyword(BaseMotion, "about", "--base-about", metavar="X,Y,Z"),
    option("--mount", metavar="NAME", help="mount of the picture (default: the sum of all)"),
    option(
        "--picture",
        choices=PICTURE_WORDS,
        help="the largest orders over speed, a map of orders over speed, a waterfall of spectra, "
        "or one speed's spectrum (default: cuts of several speeds, spectrum of one, and without "
        "--rpm the modes)",
    ),
    option(
        "--html",
        argument="path",
        metavar="FILE",
        help="write a page too, in which the mounts can be dragged (.html); --rpm is its speed at "
        "first (default: 800)",
    ),
    "--controls --units",
    option(
        "--frame",
        choices=(
            FIRST,
            "strain",
            "subframe",
            "axes",
            "static",
            "worst",
            "motion",
            "mounts",
            "robustness",
            "loads",
            "power",
            "best",
            PHASES,
        ),
    ),
    "--csv --plot",
    example="mounts car.toml --rpm 600:6000:20 --plot run-up.png",
    note="A range is START:STOP:STEP (stop included), a list a,b,c, or one number.",
)
def _mounts(call: Given) -> Shown:
    powertrain, cases = _changed(call, _powertrain(call))
    rpm: Any = call.range("--rpm", "rpm")
    page, base = call.text("--html"), _base(call)
    if (other := call.text("other")) is not None:
        return _beside(call, powertrain, other, rpm)
    if page is not None:
        if np.size(rpm) > 1:
            raise rejected("--html", page, "begins at one speed: give --rpm one")
        speed = {} if rpm is None else {"rpm": float(np.ravel(rpm)[0])}
        powertrain.save_html(
            page, **speed, frequency=call.optional("--frequency"), controls=call.names("--controls")
        )
    elif (typed := call.text("--controls")) is not None:
        raise rejected("--controls", typed, "needs --html")
    if rpm is None and (base is None or base.by == "order"):
        return _at_rest(call, powertrain, cases)
    for name in cases:
        raise rejected("--case", name, "acts without --rpm alone, or is that of --rest")
    for flag in (*AT_REST, *(() if page is not None else ("--frequency",))):
        if (typed := call.text(flag)) is not None:
            raise rejected(flag, typed, "acts without --rpm alone")
    if rpm is not None and np.size(rpm) > MOST_ROWS:
        raise inputs.faulty("--rpm", f"has {np.size(rpm)} speeds", f"give {MOST_ROWS} at most")
    if (factors := call.range("--factor")) is not None:
        return _by_factor(call, powertrain, rpm, factors)
    return _forced(call, powertrain.response(rpm, base=base, **call.chosen()))


def _forced(call: Given, response: MountResponse) -> Shown:
    """Return a response, or the motion of a point."""
    options = {"mount": call.text("--mount"), "kind": call.text("--picture")}
    if (typed := call.text("--at")) is None:
        if (on := call.text("--on")) is not None:
            raise rejected("--on", on, "needs --at")
        return Shown(response.frames, response, options)
    if (mount := options.pop("mount")) is not None:
        raise rejected("--mount", mount, "cannot be combined with --at: a picture has one of them")
    place: Any = call.numbers("--at", "m") if "," in typed else typed
    moved = response.at(place, call.text("--on") or "powertrain")
    return Shown(moved.frames, moved, options)


SHORT = {name.replace("about ", "r"): k for k, name in enumerate(DIRECTIONS)}
"""Direction of ``--base`` → its place among those of a motion."""


def _base(call: Given) -> BaseMotion | None:
    """Return the motion of the base, of a file or of amplitudes at frequencies."""
    text, about = call.text("--base"), call.keywords(BaseMotion)
    if text is None:
        for flag in ("--base-hz", "--base-about"):
            if (typed := call.text(flag)) is not None:
                raise rejected(flag, typed, "needs --base")
        return None
    if "=" not in text:
        if (typed := call.text("--base-hz")) is not None:
            raise rejected("--base-hz", typed, "is of amplitudes such as y=0.1mm: FILE has its own")
        return BaseMotion.from_csv(text, **about)
    frequencies = call.range("--base-hz")
    if frequencies is None:
        raise inputs.faulty("--base-hz", "is left out", "give the frequencies of --base, Hz")
    phasors, kinds = [0j] * len(SHORT), set[Any]()
    for part in text.split(","):
        axis, _, amount = (side.strip() for side in part.partition("="))
        number = re.fullmatch(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S*)", amount)
        if axis not in SHORT or number is None:
            hint = f"give {', '.join(SHORT)} and amounts, such as y=0.1mm or x=0.02g,rz=1e-4rad"
            raise rejected("--base", text, hint)
        kind, factor = read_unit("--base", number[2])
        kinds.add(kind)
        phasors[SHORT[axis]] = complex(factor * call.one("--base", number[1]))
    if len(kinds) > 1:
        raise rejected("--base", text, "give amounts of one motion: m, m/s or m/s²")
    every = np.atleast_1d(frequencies).tolist()
    if len(every) > MOST_ROWS:
        raise inputs.faulty("--base-hz", f"has {len(every)}", f"give {MOST_ROWS} at most")
    return BaseMotion(dict.fromkeys(every, phasors), kinds.pop(), **about)


OF_ONE = ("--base", "--factor", "--mount", "--picture", "--html", "--on", *AT_REST, "--frequency")
"""Options of one file alone."""


def _beside(call: Given, powertrain: Powertrain, other: str, rpm: Any) -> Shown:  # noqa: ANN401
    """Return the response of FILE and of another file beside each other."""
    for flag in OF_ONE:
        if (typed := call.text(flag)) is not None:
            raise rejected(flag, str(typed), "cannot be combined with OTHER")
    if rpm is None:
        raise inputs.faulty("--rpm", "is left out", "two files are compared at crank speeds")
    after, cases = _changed(call, Powertrain.load(engine_files.checked(other)))
    for name in cases:
        raise rejected("--case", name, "is not that of --rest")
    point: Any = call.numbers("--at", "m") if call.text("--at") is not None else None
    both = compare_mounts(powertrain, after, rpm, point=point, **call.chosen())
    return Shown(both.frames, both)


def _by_factor(call: Given, powertrain: Powertrain, rpm: Any, factors: Any) -> Shown:  # noqa: ANN401
    """Return the response at a point, or the force on the body, by balance factor."""
    for flag in ("--mount", "--picture", "--base"):
        if (typed := call.text(flag)) is not None:
            raise rejected(flag, typed, "cannot be combined with --factor")
    receivers: Any = "body_force"
    if (typed := call.text("--at")) is not None:
        receivers = {typed: typed}
        if "," in typed:
            place: Any = call.numbers("--at", "m")
            on: Any = call.text("--on") or "powertrain"
            point = powertrain.response(float(np.ravel(rpm)[0])).at(place, on)
            receivers = {point._words: point}
    elif (on := call.text("--on")) is not None:
        raise rejected("--on", on, "needs --at")
    swept = powertrain.sweep(rpm, factor=factors, receivers=receivers, **call.chosen())
    return Shown(swept.frames, swept)


def _changed(call: Given, powertrain: Powertrain) -> tuple[Powertrain, dict[str, dict[str, Any]]]:
    """Return the powertrain with a misfire and at rest as options say, and other load cases."""
    if call.text("--misfire") is not None:
        powertrain = powertrain.with_misfire(call.whole("--misfire"))
    if (vehicle := call.vehicle()) is not None:
        powertrain = powertrain.in_axes(vehicle)
    cases = _cases(call)
    if (rest := call.text("--rest")) is not None:
        if rest not in cases:
            raise rejected("--rest", rest, "is no --case: give one of that name")
        powertrain = powertrain.replace(rest=cases.pop(rest))
    return powertrain, cases


def _cases(call: Given) -> dict[str, dict[str, Any]]:
    """Return the load cases of ``--case``: name → arguments of ``Powertrain.static``."""
    cases = dict[str, dict[str, Any]]()
    for text in call.text("--case") or []:
        name, *fields = (part.strip() for part in text.split(":"))
        arguments: dict[str, Any] = {}
        for field in fields:
            key, _, value = (side.strip() for side in field.partition("="))
            if key not in CASE_FIELDS or not value:
                raise rejected("--case", text, f"give {CASE_FORM}")
            argument, unit = CASE_FIELDS[key]
            if (key, value) == ("torque", "engine"):
                arguments[argument] = value
            elif key in ("torque", "gear", "rpm"):
                arguments[argument] = call.one("--case", value, unit)
            else:
                arguments[argument] = call.listed("--case", value, unit)
        if name in cases or not name:
            raise rejected("--case", text, "give each case a name of its own")
        cases[name] = arguments
    return cases


def _at_rest(call: Given, powertrain: Powertrain, cases: dict[str, dict[str, Any]]) -> Shown:
    """Return modes, axes and the static state; what free motions leave undefined is left out.

    Or travels and forces of the mounts under load cases.
    """
    if (typed := call.text("--base")) is not None:
        raise rejected("--base", typed, "moves by order: give --rpm")
    for flag in ("--at", "--on", "--factor", "--mount", "--picture"):
        if (typed := call.text(flag)) is not None:
            raise rejected(flag, typed, "needs --rpm")
    if cases:
        for flag in (*AT_REST, "--frequency"):
            if (typed := call.text(flag)) is not None:
                raise rejected(flag, typed, "cannot be combined with --case")
        loaded = powertrain.load_cases(cases)
        return Shown(loaded.frames, loaded)
    frequency = call.optional("--frequency")
    modes = powertrain.modes(frequency)
    makers: dict[str, Any] = {name: partial(modes.frames.get, name) for name in modes.frames}
    if not modes.free:
        axes = powertrain.axes(frequency)
        static = powertrain.static(**call.keywords(Powertrain.static))
        makers |= {"axes": lambda: axes.table, "static": lambda: static.table}
    makers["mounts"] = lambda: powertrain.table
    if (share := call.optional("--robustness")) is not None:
        robust = powertrain.robustness(share, frequency=frequency)
        makers |= {"robustness": lambda: robust.table}
    return Shown(Frames(makers), modes)


@command(
    "mounts-fit",
    "mounts that decouple roll, place natural frequencies and lower forces, within bounds",
    POWERTRAIN_FILE,
    option(
        "--by",
        default="decoupling",
        help="objective to minimise: decoupling, purity (its complement to 1), mount_force[N] or "
        "body_force[N] of an order N "
        "(default: %(default)s)",
    ),
    keyword(design_mounts, "rpm", read=lambda call, flag: call.range(flag, "rpm"), metavar="RANGE"),
    option(
        "--vary",
        metavar="KIND,…",
        help=f"what varies of every mount, of {', '.join(KINDS)}, or NAME=KIND+KIND,… of some "
        "mounts (default: all that have bounds)",
    ),
    option(
        "--stiffness",
        metavar="LOW,HIGH",
        help="bounds of the dynamic stiffness, N/m",
        group="bounds",
    ),
    option("--tilt", metavar="ANGLE", help="how far mounts turn about z, degrees", group="bounds"),
    *(
        option(
            f"--{axis}",
            metavar="LENGTH",
            help=f"how far mounts move along {axis}, m",
            group="bounds",
        )
        for axis in "xyz"
    ),
    *keywords(design_mounts, "ratio modes_between roll_frequency", group="requirements"),
    *keywords(design_mounts, "starts seed"),
    "--units",
    option("--frame", choices=(FIRST, "mounts")),
    "--csv",
    option("--save", help="write engine, body and the mounts designed, an engine file"),
    "--force",
    example="mounts-fit car.toml --stiffness 50000,500000 --modes-between 5,30 --save new.toml",
    note=f"Also {PROG} mounts fit FILE …",
)
def _fit(call: Given) -> Shown:
    powertrain = _powertrain(call)
    bounds: dict[str, Any] = {}
    for kind in KINDS:
        flag = "--tilt" if kind == "tilt_deg" else f"--{kind}"
        unit = {"stiffness": "", "tilt_deg": "°"}.get(kind, "m")
        if call.text(flag) is not None:
            pair = kind == "stiffness"
            bounds[kind] = call.numbers(flag, unit) if pair else call.number(flag, unit)
    if not bounds:
        hint = "give bounds of what varies: --stiffness, --tilt, --x, --y or --z"
        raise inputs.faulty("mounts-fit", "has no bounds", hint)
    fitted = design_mounts(
        powertrain,
        call.text("--by").split(","),
        vary=_varied(call.text("--vary"), list(bounds)),
        bounds=bounds,
        **call.keywords(design_mounts),
    )
    return Shown(fitted.frames, fitted, engine=fitted.fitted)


def _varied(text: str | None, kinds: list[str]) -> Any:  # noqa: ANN401 - as the library takes it
    """Return kinds, or the kinds of some mounts by name; by default those that have bounds."""
    if text is None:
        return kinds
    parts = text.split(",")
    if not any("=" in part for part in parts):
        return parts
    named = (part.partition("=") for part in parts)
    return {name: which.split("+") for name, _, which in named}
