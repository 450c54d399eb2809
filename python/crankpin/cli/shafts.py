"""The command ``shafts``: balance shafts fitted to an engine, or hardware against what stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._core import InputError
from crankpin._support import labels
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.balancer_options import balancer_options
from crankpin.analysis.balancing.shaft_wishes import REMOVE
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands
    from crankpin.model.engine import Engine

OF_A_FIT = ("x", "y", "planes", "bearings", "remove", "quantity")
"""Options that need ``--ratio``."""
OF_OPTIONS = ("rpm", "by", "target")
"""Options that ``--ratio`` has no use for."""


def add(commands: Commands) -> None:
    """Add the command ``shafts``."""
    fits = parser.command(
        commands,
        "shafts",
        "balance shafts fitted to an engine, or all hardware against what stays",
        example="shafts i4 --ratio 2,-2 --x 0.08,-0.08 --save smooth.toml",
        run=run,
        note="Without --ratio, sets of counterweights and shafts are compared; with it, these\n"
        "shafts are fitted. Write values that begin with a minus as --ratio=-2,2.",
    )
    parser.shared(fits, "name")
    fits.add_argument(
        "--ratio", metavar="N,…", help="speed of each shaft over crank speed: -1, or 2,-2"
    )
    for axis, where in (("x", "to the right of"), ("y", "above")):
        fits.add_argument(
            f"--{axis}",
            metavar="M,…",
            help=f"distances of the shafts {where} the crank axis, m: one for all or one for each, "
            "free where left out: where they cancel roll torque (default: free)",
        )
    fits.add_argument("--planes", metavar="Z,…", help="places of the unbalances along the crank, m")
    fits.add_argument("--bearings", metavar="Z,Z", help="places of the bearings, m")
    fits.add_argument("--remove", choices=REMOVE, help="what the shafts remove (default: both)")
    parser.shared(fits, "--rpm", default=None, help="crank speed of the comparison (default: 3000)")
    parser.shared(
        fits,
        "--by",
        default=None,
        help="what to compare, as for rank (default: total.force.peak,total.moment.peak)",
    )
    fits.add_argument(
        "--target",
        metavar="OBJECTIVE=VALUE,…",
        help="largest value allowed, in N or N·m, or in %% of what there is: "
        "[1].moment.peak=0,total.moment.peak=300 or total.moment.peak=5%%",
    )
    parser.shared(fits, "--reference-z")
    parser.shared(
        fits, "--quantity", default=None, help="quantity of the picture (default: moment)"
    )
    parser.shared(fits, "--csv", help="print the first table as CSV")
    parser.shared(fits, "--plot")
    fits.add_argument(
        "--save",
        metavar="FILE",
        help="write the engine with what was fitted (.toml, .json); without --ratio the least "
        "hardware that reaches --target",
    )


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "shafts")
    fits = arguments.ratio is not None
    for name in OF_OPTIONS if fits else OF_A_FIT:
        if getattr(arguments, name) is not None:
            raise InputError(
                f"--{name} {'is of the comparison without' if fits else 'needs'} --ratio"
            )
    return _fit(engine, arguments) if fits else _compare(engine, arguments)


def _fit(engine: Engine, arguments: argparse.Namespace) -> str:
    picture = inputs.picture_file(arguments.plot)
    fit = balance_shafts(
        engine,
        inputs.whole_numbers("--ratio", arguments.ratio),
        x=_coordinates("--x", arguments.x),
        y=_coordinates("--y", arguments.y),
        planes=inputs.numbers("--planes", arguments.planes),
        bearings=inputs.numbers("--bearings", arguments.bearings),
        remove=arguments.remove or "both",
        reference_z=inputs.optional_number("--reference-z", arguments.reference_z),
    )
    if arguments.save is not None:
        fit.engine.save(arguments.save)
    outputs.draw(fit, picture, quantity=arguments.quantity or "moment")
    return outputs.printed([fit.table], csv=arguments.csv)


def _compare(engine: Engine, arguments: argparse.Namespace) -> str:
    picture = inputs.picture_file(arguments.plot)
    by = (arguments.by or "total.force.peak,total.moment.peak").split(",")
    targets, relative = _targets(arguments.target)
    options = balancer_options(
        engine,
        rpm=inputs.number("--rpm", arguments.rpm or "3000"),
        by=by,
        target=targets,
        relative=relative,
        reference_z=inputs.optional_number("--reference-z", arguments.reference_z),
    )
    if arguments.save is not None:
        if targets is None:
            raise InputError("--save needs --ratio or --target")
        options.engine.save(arguments.save)
    outputs.draw(options, picture)
    return outputs.printed([options.table], csv=arguments.csv)


def _coordinates(name: str, text: str | None) -> float | list[float | None] | None:
    """Return one number for all shafts, or one for each, None where it is left out."""
    if text is None:
        return None
    if "," not in text:
        return inputs.number(name, text)
    return [inputs.number(name, part) if part.strip() else None for part in text.split(",")]


def _targets(text: str | None) -> tuple[dict[str, float] | None, bool]:
    """Return objective → value, and whether values are parts of what there is."""
    if text is None:
        return None, False
    cure = "give OBJECTIVE=VALUE, such as total.moment.peak=300 or total.moment.peak=5%"
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(value.strip() for _, _, value in pairs):
        raise InputError(f"--target = {labels.cut(text)}: {cure}")
    per_cent = {value.strip().endswith("%") for _, _, value in pairs}
    if len(per_cent) > 1:
        raise InputError(f"--target = {labels.cut(text)}: give all values in %, or none")
    relative = per_cent == {True}
    scale = 0.01 if relative else 1.0
    return {
        name.strip(): scale * inputs.number("--target", value.strip().removesuffix("%"))
        for name, _, value in pairs
    }, relative
