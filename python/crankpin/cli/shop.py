"""Commands of a balancing shop: the card with weighed parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from crankpin._support import inputs
from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.analysis.balancing.card import PARTS
from crankpin.cli.arguments import command, option, rejected
from crankpin.cli.hardware import planes_of
from crankpin.cli.outputs import Shown

if TYPE_CHECKING:
    from crankpin.cli.arguments import Given

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
            help=f"{PARTS[part]} (default: the engine's masses)",
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
    """Return one number as it is: that of all."""
    return numbers if len(numbers) > 1 else numbers[0]
