"""Commands: counterweights, bob weights, balance shafts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin._support import inputs
from crankpin.analysis.balancing.balance_shafts import balance_shafts
from crankpin.analysis.balancing.balancer_options import DEFAULT, balancer_options
from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.analysis.balancing.counterweights import counterweights
from crankpin.cli.options import command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown

if TYPE_CHECKING:
    from crankpin.analysis.balancing.planes import Planes
    from crankpin.cli.arguments import Given
    from crankpin.cli.options import Option
    from crankpin.model.engine import Engine

PLANES = "ends|webs|Z,…|NAME=Z,…"
OF_A_FIT = ("--x", "--y", "--planes", "--bearings", "--remove", "--quantity")
"""Options that need ``--ratios``."""
OF_OPTIONS = ("--rpm", "--by", "--target")
"""Options that ``--ratios`` has no use for, but for the speed where gas pressure has torque."""


@command(
    "counterweights",
    "counterweights that remove the most of the forward part of order 1",
    "name",
    keyword(
        counterweights,
        "planes",
        read=lambda call, _: planes_of(call),
        metavar=PLANES,
        help="where weights can be: at the first and last cylinder, at both webs of every throw, "
        "or at places in m; --planes=-0.1,0.4 if the first is below zero (default: webs)",
    ),
    keyword(counterweights, "target"),
    keyword(counterweights, "factor", more=", 0.5 or 50%"),
    *keywords(counterweights, "minimise bound"),
    keyword(
        counterweights,
        "angles_deg",
        read=lambda call, flag: call.range(flag, "°"),
        metavar="RANGE",
        more=": 0,90,180,270 or 0:345:15",
    ),
    "--reference-z --units",
    option("--frame", choices=("table", "residual")),
    "--csv --plot --save --force",
    example="counterweights v8-crossplane --planes webs --plot weights.png",
    note="Amounts are mass·radius in kg·m, angles those at θ = 0 from +x, as the crank turns.\n"
    "Residuals are in kg·m and kg·m², to be multiplied by ω².",
)
def _counterweights(call: Given) -> Shown:
    engine = call.engine("counterweights")
    fit = counterweights(engine, **call.keywords(counterweights))
    return Shown(fit.frames, fit, engine=fit.fitted)


def planes_of(call: Given) -> Planes:
    """Return the planes of ``--planes``."""
    text: str = call.text("--planes")
    if text in ("ends", "webs"):
        return text
    parts = [part.rpartition("=") for part in text.split(",")]
    named = [name for name, equals, _ in parts if equals]
    if not named:
        what = "ends, webs, or places in m, such as 0,0.4"
        return call.listed("--planes", text, "m", what)
    if len(set(named)) < len(parts):
        hint = "give ends, webs, places, or a name of its own for each place"
        raise rejected("--planes", text, hint)
    return {name.strip(): call.one("--planes", z, "m") for name, _, z in parts}


def mass(flag: str, what: str) -> Option:
    """Return an option that is a mass."""
    return option(flag, metavar="MASS", help=f"{what}: 550g, or a number in kg")


@command(
    "bob-weight",
    "bob weight of each crankpin in grams, and residuals by balance factor",
    "name",
    *keywords(bob_weight, "factor"),
    mass("--rotating-mass", "big end, bolts and bearing shells"),
    mass("--reciprocating-mass", "piston, pin, rings and small end"),
    *keywords(bob_weight, "oil"),
    "--units",
    option("--frame", choices=("table", "factors")),
    "--csv --plot --save --force",
    example="bob-weight v8-crossplane --rotating-mass 550g --reciprocating-mass 620g --oil 4g",
    note="Masses are those of one cylinder, by default the engine's.",
)
def _bob_weight(call: Given) -> Shown:
    engine = call.engine("bob-weight")
    if (moving := call.optional("--reciprocating-mass", "kg")) is not None:
        cylinders = [cylinder.replace(reciprocating_mass=moving) for cylinder in engine.cylinders]
        engine = engine.replace(cylinder=cylinders)
    if (turning := call.optional("--rotating-mass", "kg")) is not None:
        engine = engine.replace(rotating_mass=turning)
    bob = bob_weight(engine, **call.keywords(bob_weight))
    return Shown(bob.frames, bob, engine=bob.fitted)


def _coordinates(call: Given, flag: str) -> float | list[float | None]:
    """Return one number for all shafts, or one for each, None where it is left out."""
    text = call.text(flag)
    if "," not in text:
        return call.number(flag, "m")
    parts = text.split(",")
    if all(part.strip() for part in parts):
        return [*call.listed(flag, text, "m")]
    return [call.one(flag, part, "m") if part.strip() else None for part in parts]


def _axis(flag: str, where: str) -> Option:
    return keyword(
        balance_shafts,
        flag.removeprefix("--"),
        read=_coordinates,
        metavar="M,…",
        help=f"distances of the shafts {where} the crank axis, m: one for all or one for each, "
        "free where left out: where they cancel roll torque (default: free)",
    )


@command(
    "shafts",
    "balance shafts fitted to an engine, or sets of hardware compared",
    "name",
    keyword(
        balance_shafts,
        "ratios",
        read=lambda call, flag: call.names(flag),
        metavar="N,…",
        help="speed of each shaft over crank speed: -1, 2,-2 or 1/2",
    ),
    _axis("--x", "to the right of"),
    _axis("--y", "above"),
    *keywords(balance_shafts, "planes bearings remove"),
    keyword(
        balance_shafts,
        "rpm",
        help="crank speed of the comparison (default: 3000), or with --ratios that at which shafts "
        "cancel torque of gas pressure",
    ),
    option(
        "--by",
        default=None,
        help="what to compare, as for rank (default: total.force.peak,total.moment.peak)",
    ),
    option(
        "--target",
        metavar="OBJECTIVE=VALUE,…",
        help="largest value allowed, in N or N·m, or in %% of the engine's own: "
        "[1].moment.peak=0,total.moment.peak=300 or total.moment.peak=5%%",
    ),
    "--reference-z --units --quantity",
    option("--frame", choices=("table", "shafts", "residual")),
    "--csv --plot",
    option(
        "--save",
        help="write the engine with what was found (.toml, .json); without --ratios the least "
        "hardware that reaches --target",
    ),
    "--force",
    example="shafts i4 --ratios 2,-2 --x 0.08,-0.08 --save smooth.toml",
    note="Without --ratios, sets of counterweights and shafts are compared; with it, these\n"
    "shafts are fitted. Write values that begin with a minus as --ratios=-2,2.",
)
def _shafts(call: Given) -> Shown:
    engine = call.engine("shafts")
    fits = call.text("--ratios") is not None
    for name in OF_OPTIONS if fits else OF_A_FIT:
        if call.text(name) is not None and not (name == "--rpm" and engine.fired):
            what = "is of the comparison without" if fits else "needs"
            raise inputs.faulty(name, f"{what} --ratios", "leave it out" if fits else "give them")
    return _fit(engine, call) if fits else _compare(engine, call)


def _fit(engine: Engine, call: Given) -> Shown:
    fit = balance_shafts(engine, **call.keywords(balance_shafts))
    return Shown(fit.frames, fit, {"quantity": call.quantity([engine])}, fit.fitted)


def _compare(engine: Engine, call: Given) -> Shown:
    targets, relative = _targets(call)
    saved = call.text("--save") is not None
    if saved and targets is None:
        raise rejected("--save", call.text("--save"), "needs --ratios or --target")
    rpm, by = call.optional("--rpm", "rpm"), call.text("--by")
    options = balancer_options(
        engine,
        rpm=3000.0 if rpm is None else rpm,
        by=DEFAULT if by is None else by,
        target=targets,
        relative=relative,
    )
    # Without a set that reaches the target there is no engine to be saved, which is an error.
    return Shown(options.frames, options, engine=options.fitted if saved else None)


def _targets(call: Given) -> tuple[dict[str, float] | None, bool]:
    """Return objective → value, and whether values are parts of the engine's own."""
    text = call.text("--target")
    if text is None:
        return None, False
    hint = "give OBJECTIVE=VALUE, such as total.moment.peak=300 or total.moment.peak=5%"
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(value.strip() for _, _, value in pairs):
        raise rejected("--target", text, hint)
    per_cent = {value.strip().endswith("%") for _, _, value in pairs}
    if len(per_cent) > 1:
        raise rejected("--target", text, "give all values in %, or none")
    values = {name.strip(): call.one("--target", value, "") for name, _, value in pairs}
    return values, per_cent == {True}
