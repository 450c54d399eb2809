"""Commands of a balancing shop: card of weighed parts, two planes, matched parts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs
from crankpin._support.record import changed
from crankpin._support.tables import Column
from crankpin.analysis.balancing.bob_weight import BobWeight, bob_weight
from crankpin.analysis.balancing.card import PARTS, RODS
from crankpin.analysis.balancing.two_plane import G_MM, two_plane_correction
from crankpin.analysis.tolerances.match_parts import match_parts
from crankpin.cli.hardware import planes_of
from crankpin.cli.options import command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown, only

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given


def _default(part: str) -> str:
    """Return what counts where a part is not weighed."""
    if part in RODS:
        return "default: that of the engine's rod, or named as not counted"
    return "default: the engine's, without any part of its kind"


PART_FLAGS = {part: f"--{part.replace(' ', '-')}" for part in PARTS}
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
        for part, flag in PART_FLAGS.items()
    ),
    keyword(bob_weight, "oil"),
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
    *keywords(BobWeight.card, "radius balanced_to"),
    "--units",
    option("--frame", choices=("table", "bob weights", "residual", "correction")),
    "--csv",
    option(
        "-o", "--out", argument="path", metavar="FILE", help="write a page to be printed (.html)"
    ),
    example="card v8-crossplane --piston 470g --pin 118g --locks 2g --rings 60g --small-end 180g "
    "--big-end 430g --bearings 42g --oil 4g --factor 48%,50%,52% --rpm 6000 -o card.html",
    note="Print the page in a browser, on paper or as PDF. Angles are those at θ = 0 from +x.",
)
def _card(call: Given) -> Shown:
    engine = call.engine("card")
    typed = {part: call.numbers(flag, "kg") for part, flag in PART_FLAGS.items()}
    for part, masses in typed.items():
        if masses is not None and len(masses) not in (1, len(engine)):
            hint = f"give one mass, or {len(engine)}"
            raise rejected(PART_FLAGS[part], call.text(PART_FLAGS[part]), hint)
    parts = {
        part: masses if len(masses) > 1 else masses[0]
        for part, masses in typed.items()
        if masses is not None
    }
    factors = call.listed("--factor", call.text("--factor"))
    bob = bob_weight(engine, factors[0], parts=parts, **call.keywords(bob_weight))
    sides = call.text("--sides").split(",")
    if len(sides) != 2:
        raise rejected("--sides", call.text("--sides"), "give two words, such as exhaust,intake")
    planes = None if call.text("--planes") is None else planes_of(call)
    card = bob.card(
        factors,
        rpm=call.number("--rpm", "rpm"),
        sides=(sides[0].strip(), sides[1].strip()),
        planes=planes,
        **call.keywords(BobWeight.card),
    )
    if call.frame() not in (None, *card.frames):
        raise inputs.faulty("--frame", "= correction", "needs --planes")
    note = ""
    if (page := call.text("--out")) is not None:
        card.save_html(page)
        note = f"Written to {page}: print it in a browser.\n"
    return Shown(card.frames, card, note=note)


@command(
    "two-plane",
    "corrections in two planes of an unbalance that a machine measured in two others",
    keyword(
        two_plane_correction,
        "amount_g_mm",
        "--amounts",
        read=lambda call, _: _amounts(call),
        metavar="U,U",
        required=True,
        help="unbalances measured, in g·mm unless they have a unit: 4200,2600 or 5.8oz·in,3.6oz·in",
    ),
    *(
        keyword(two_plane_correction, name, flag, metavar=metavar, required=True)
        for name, flag, metavar in [
            ("angle_deg", "--angles", "A,A"),
            ("measured_z", "--measured", "Z,Z"),
            ("correction_z", "--correct", "Z,Z"),
        ]
    ),
    option("--radius", metavar="LENGTH,…", help="radius of weights or holes in each plane"),
    "--units --csv",
    example="two-plane --amounts 4200,2600 --angles 35,310 --measured 0,335mm "
    "--correct=-20mm,360mm --radius 70mm",
    note="Angles are counted in the direction in which the crank turns. Without --units plain\n"
    "amounts are in g·mm, as machines show them, and plain lengths in m.",
)
def _two_plane(call: Given) -> Shown:
    fix = two_plane_correction(**call.keywords(two_plane_correction))
    table = fix.table
    if (radius := call.numbers("--radius", "m")) is not None:
        if len(radius) > 2 or min(radius) <= 0.0:
            raise rejected("--radius", call.text("--radius"), "give one length above 0, or two")
        grams = fix.amount_g_mm / (1e3 * np.array(radius))
        weight = Column("weight", grams, "g")
        table = changed(table, columns=(*table.columns, weight))
    return Shown(only(table), fix)


def _amounts(call: Given) -> Any:  # noqa: ANN401 - an array
    """Return unbalances, g·mm."""
    plain = call.text("--units") is None
    typed = call.text("--amounts").split(",")
    parts = [f"{text}g·mm" if plain and _is_plain(text) else text for text in typed]
    return np.round([call.one("--amounts", part, "kg·m") / G_MM for part in parts], 9)


def _is_plain(text: str) -> bool:
    """Return whether a number has no unit."""
    return re.search(r"[^\d\s.eE+/-]", text) is None


@command(
    "match",
    "which measured piston and rod goes into which cylinder",
    "name",
    keyword(match_parts, "pistons", required=True),
    option(
        "--small-ends", argument="rods", metavar="MASS,…", help="measured small ends of the rods"
    ),
    option("--big-ends", metavar="MASS,…", help="measured big ends of the rods, in the same order"),
    *keywords(match_parts, "by sets seed"),
    "--units --csv",
    option("--save", help="write the first engine with its parts (.toml, .json)"),
    "--force",
    example="match v8-crossplane --pistons 470g,473g,471g,469g,474g,470g,467g,472g",
    note="Fit the counterweights first (counterweights … --save): what they remove does not count.",
)
def _match(call: Given) -> Shown:
    ends = [call.numbers(flag, "kg") for flag in ("--small-ends", "--big-ends")]
    rods = None
    if any(masses is not None for masses in ends):
        for flag, masses in zip(("--small-ends", "--big-ends"), ends, strict=True):
            if masses is None:
                raise inputs.faulty(flag, "is left out", "rods have --small-ends and --big-ends")
        small, big = (masses or [] for masses in ends)
        if len(small) != len(big):
            hint = f"give as many --big-ends as --small-ends, {len(small)}"
            raise inputs.faulty("--big-ends", f"has {len(big)} masses", hint)
        rods = list(zip(small, big, strict=True))
    match = match_parts(call.engine("match"), rods=rods, **call.keywords(match_parts))
    return Shown(match.frames, match, engine=match.engines[0])
