"""Commands of a balancing shop: card of weighed parts, two planes, matched parts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.record import changed
from crankpin._support.tables import Column
from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.analysis.balancing.card import PARTS, RODS
from crankpin.analysis.balancing.two_plane import G_MM, two_plane_correction
from crankpin.analysis.tolerances.match_parts import match_parts
from crankpin.cli.arguments import command, option, rejected
from crankpin.cli.hardware import planes_of
from crankpin.cli.outputs import Shown, only

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given


def _default(part: str) -> str:
    """Return what counts where a part is not weighed."""
    if part in RODS:
        return "default: that of the engine's rod, or named as not counted"
    return "default: the engine's, without any part of its kind"


FLAGS = {part: f"--{part.replace(' ', '-')}" for part in PARTS}
"""Part that is weighed → its option."""


@command(
    "card",
    "the card of a balancing shop: weighed parts, bob weights, residuals, correction",
    "name",
    *(
        option(
            flag,
            group="weighed parts, of one cylinder or A,B,… of each",
            metavar="MASS,…",
            help=f"{PARTS[part]} ({_default(part)})",
        )
        for part, flag in FLAGS.items()
    ),
    option("--oil", metavar="MASS", help="oil of a crankpin (default: 0)"),
    option(
        "--factor",
        metavar="K,…",
        default="50%",
        help="balance factors, such as 48%%,50%%,52%% or 0.5 (default: 50%%)",
    ),
    "--rpm",
    option(
        "--sides",
        metavar="RIGHT,LEFT",
        default="right,left",
        help="what is on either side, seen from the flywheel: exhaust,intake (default: "
        "%(default)s)",
    ),
    option(
        "--planes",
        metavar="ends|webs|Z,…|NAME=Z,…",
        help="where metal can be added or drilled away (default: no correction is printed)",
    ),
    option("--radius", metavar="LENGTH,…", help="radius of the weights or holes in each plane"),
    option(
        "--balanced-to",
        metavar="MASS,…",
        help="bob weight to which the crankshaft is balanced now (default: its counterweights are "
        "the engine's)",
    ),
    "--units",
    option("--frame", choices=("table", "bob weights", "residual", "correction")),
    "--csv",
    option("-o", "--out", metavar="FILE", help="write a page to be printed (.html)"),
    example="card v8-crossplane --piston 470g --pin 118g --locks 2g --rings 60g --small-end 180g "
    "--big-end 430g --bearings 42g --oil 4g --factor 48%,50%,52% --rpm 6000 -o card.html",
    note="Print the page in a browser, on paper or as PDF. Angles are those at θ = 0 from +x.",
)
def _card(given: Given) -> Shown:
    engine = given.engine("card")
    typed = {part: given.numbers(flag, "kg") for part, flag in FLAGS.items()}
    for part, masses in typed.items():
        if masses is not None and len(masses) not in (1, len(engine)):
            hint = f"give one mass, or {len(engine)}"
            raise rejected(FLAGS[part], given.text(FLAGS[part]), hint)
    parts = {part: _each(masses) for part, masses in typed.items() if masses is not None}
    factors = given.listed("--factor", given.text("--factor"))
    bob = bob_weight(engine, factors[0], given.optional("--oil", "kg") or 0.0, parts=parts)
    sides = given.text("--sides").split(",")
    if len(sides) != 2:
        raise rejected("--sides", given.text("--sides"), "give two words, such as exhaust,intake")
    radius, balanced_to = given.numbers("--radius", "m"), given.numbers("--balanced-to", "kg")
    planes = None if given.text("--planes") is None else planes_of(given)
    card = bob.card(
        factors,
        rpm=given.number("--rpm", "rpm"),
        sides=(sides[0].strip(), sides[1].strip()),
        planes=planes,
        radius=None if radius is None else _each(radius),
        balanced_to=None if balanced_to is None else _each(balanced_to),
    )
    if given.frame() not in (None, *card.frames):
        raise inputs.faulty("--frame", "= correction", "needs --planes")
    note = ""
    if (page := given.text("--out")) is not None:
        card.save_html(page)
        note = f"Written to {page}: print it in a browser.\n"
    return Shown(card.frames, card, note=note)


def _each(numbers: list[float]) -> Any:  # noqa: ANN401 - a number or a list
    """Return a single number, which counts for all, unchanged."""
    return numbers if len(numbers) > 1 else numbers[0]


@command(
    "two-plane",
    "corrections in two planes of an unbalance that a machine measured in two others",
    option(
        "--amounts",
        metavar="U,U",
        required=True,
        help="unbalances measured, in g·mm unless they have a unit: 4200,2600 or 5.8oz·in,3.6oz·in",
    ),
    option("--angles", metavar="A,A", required=True, help="where it is heavy, degrees"),
    option("--measured", metavar="Z,Z", required=True, help="planes of measurement, m"),
    option("--correct", metavar="Z,Z", required=True, help="planes of correction, m"),
    option("--radius", metavar="LENGTH,…", help="radius of weights or holes in each plane"),
    "--units --csv",
    example="two-plane --amounts 4200,2600 --angles 35,310 --measured 0,335mm "
    "--correct=-20mm,360mm --radius 70mm",
    note="Angles are counted in the direction in which the crank turns. Without --units plain\n"
    "amounts are in g·mm, as machines show them, and plain lengths in m.",
)
def _two_plane(given: Given) -> Shown:
    typed = given.text("--amounts")
    plain = given.text("--units") is None
    parts = [f"{each}g·mm" if plain and _is_plain(each) else each for each in typed.split(",")]
    amounts = [given.one("--amounts", each, "kg·m") / G_MM for each in parts]
    fix = two_plane_correction(
        np.round(amounts, 9),
        given.listed("--angles", given.text("--angles"), "°"),
        measured_z=given.listed("--measured", given.text("--measured"), "m"),
        correction_z=given.listed("--correct", given.text("--correct"), "m"),
    )
    table = fix.table
    if (radius := given.numbers("--radius", "m")) is not None:
        if len(radius) > 2 or min(radius) <= 0.0:
            raise rejected("--radius", given.text("--radius"), "give one length above 0, or two")
        grams = fix.amount_g_mm / (1e3 * np.array(radius))
        weight = Column("weight", grams, "g")
        table = changed(table, columns=(*table.columns, weight))
    return Shown(only(table), fix)


def _is_plain(text: str) -> bool:
    """Return whether a number has no unit."""
    return re.search(r"[^\d\s.eE+/-]", text) is None


@command(
    "match",
    "which measured piston and rod goes into which cylinder",
    "name",
    option("--pistons", metavar="MASS,…", required=True, help="measured pistons with pins"),
    option("--small-ends", metavar="MASS,…", help="measured small ends of the rods"),
    option("--big-ends", metavar="MASS,…", help="measured big ends of the rods, in the same order"),
    option(
        "--by",
        choices=("balance", "spread"),
        default="balance",
        help="what remains of order 1 and 2, or heaviest less lightest (default: %(default)s)",
    ),
    option("--sets", metavar="N", help="number of engines (default: as many as parts suffice for)"),
    "--seed --units --csv",
    option("--save", help="write the first engine with its parts (.toml, .json)"),
    "--force",
    example="match v8-crossplane --pistons 470g,473g,471g,469g,474g,470g,467g,472g",
    note="Fit the counterweights first (counterweights … --save): what they remove does not count.",
)
def _match(given: Given) -> Shown:
    pistons = given.listed("--pistons", given.text("--pistons"), "kg")
    ends = [given.numbers(flag, "kg") for flag in ("--small-ends", "--big-ends")]
    rods = None
    if any(each is not None for each in ends):
        for flag, each in zip(("--small-ends", "--big-ends"), ends, strict=True):
            if each is None:
                raise inputs.faulty(flag, "is left out", "rods have --small-ends and --big-ends")
        small, big = (each or [] for each in ends)
        if len(small) != len(big):
            hint = f"give as many --big-ends as --small-ends, {len(small)}"
            raise inputs.faulty("--big-ends", f"has {len(big)} masses", hint)
        rods = list(zip(small, big, strict=True))
    match = match_parts(
        given.engine("match"),
        pistons,
        rods,
        by=given.text("--by"),
        sets=None if given.text("--sets") is None else given.whole("--sets"),
        seed=given.whole("--seed"),
    )
    return Shown(match.frames, match, engine=match.engines[0])
