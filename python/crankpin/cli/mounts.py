"""The command on an engine on its mounts: modes, axes, forces over orders and speeds, a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.frames import FIRST, Frames
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.cli.arguments import MOST_ROWS, command, option, rejected
from crankpin.cli.outputs import Shown

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given

PICTURES = ("cuts", "map", "spectrum")


@command(
    "mounts",
    "an engine on its mounts: modes, axes, sag; with --rpm forces and motion by order",
    option("name", metavar="FILE", help="an engine file with [powertrain] (.toml, .json)"),
    option(
        "--rpm",
        metavar="RANGE",
        default=None,
        help="crank speeds, for the response to the engine's orders (default: modes and axes)",
    ),
    option("--frequency", help="frequency at which modes take stiffness that depends on it, Hz"),
    option("--torque", help="mean torque that leaves the unit at rest, N·m (default: 0)"),
    option("--misfire", metavar="CYLINDER", help="number of a cylinder that does not fire"),
    "--orders --rtol",
    option("--at", metavar="X,Y,Z", help="point of which the motion is printed, m"),
    option("--mount", metavar="NAME", help="mount of the picture (default: the sum of all)"),
    option(
        "--picture",
        choices=PICTURES,
        help="the largest orders over speed, a map of orders over speed, or one speed's spectrum "
        "(default: cuts of several speeds, spectrum of one, and without --rpm the modes)",
    ),
    option(
        "--html",
        metavar="FILE",
        help="write a page too, in which the mounts can be dragged (.html); --rpm is its speed at "
        "first (default: 800)",
    ),
    "--units",
    option("--frame", choices=(FIRST, "strain", "axes", "static", "loads")),
    "--csv --plot",
    example="mounts car.toml --rpm 600:6000:20 --plot run-up.png",
    note="A range is START:STOP:STEP (stop included), a list a,b,c, or one number.",
)
def _mounts(given: Given) -> Shown:
    powertrain = Powertrain.load(given.text("name"))
    if given.text("--misfire") is not None:
        powertrain = powertrain.without(given.whole("--misfire"))
    rpm: Any = given.range("--rpm", "rpm")
    page = given.text("--html")
    if page is not None:
        if np.size(rpm) > 1:
            raise rejected("--html", page, "begins at one speed: give --rpm one")
        speed = {} if rpm is None else {"rpm": float(np.ravel(rpm)[0])}
        powertrain.save_html(page, **speed, frequency=given.optional("--frequency"))
    if rpm is None:
        return _at_rest(given, powertrain)
    for flag in ("--torque", *(() if page is not None else ("--frequency",))):
        if (typed := given.text(flag)) is not None:
            raise rejected(flag, typed, "acts without --rpm alone")
    if np.size(rpm) > MOST_ROWS:
        raise inputs.faulty("--rpm", f"has {np.size(rpm)} speeds", f"give {MOST_ROWS} at most")
    response = powertrain.response(rpm, **given.chosen())
    frames: Frames = response.frames
    if (point := given.numbers("--at", "m")) is not None:
        frames = response.at(point).frames
    return Shown(
        frames, response, {"mount": given.text("--mount"), "kind": given.text("--picture")}
    )


def _at_rest(given: Given, powertrain: Powertrain) -> Shown:
    """Return modes, axes and the static state; what free motions leave undefined is left out."""
    for flag in ("--at", "--mount", "--picture"):
        if (typed := given.text(flag)) is not None:
            raise rejected(flag, typed, "needs --rpm")
    frequency = given.optional("--frequency")
    modes = powertrain.modes(frequency)
    makers: dict[str, Any] = {FIRST: lambda: modes.table, "strain": lambda: modes.frames["strain"]}
    if not modes.free:
        axes = powertrain.axes(frequency)
        static = powertrain.static(given.optional("--torque") or 0.0)
        makers |= {"axes": lambda: axes.table, "static": lambda: static.table}
    return Shown(Frames(makers), modes)
