"""The command ``bob-weight``: what a crankshaft is balanced with, and what factors leave."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin.analysis.balancing.bob_weight import bob_weight
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``bob-weight``."""
    weighs = parser.command(
        commands,
        "bob-weight",
        "bob weight of each crankpin in grams, and what balance factors leave",
        example="bob-weight v8-crossplane --factor 0.5 --rotating 550 --reciprocating 620 --oil 4",
        run=run,
        note="Masses are of one cylinder, in grams; without them they are the engine's.",
    )
    parser.shared(weighs, "name")
    weighs.add_argument(
        "--factor", default="0.5", help="part of the reciprocating mass (default: %(default)s)"
    )
    weighs.add_argument("--rotating", metavar="G", help="big end, bolts and bearing shells")
    weighs.add_argument("--reciprocating", metavar="G", help="piston, pin, rings and small end")
    weighs.add_argument("--oil", metavar="G", default="0", help="oil of a crankpin (default: 0)")
    parser.shared(weighs, "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "bob-weight")
    picture = inputs.picture_file(arguments.plot)
    if arguments.reciprocating is not None:
        mass = inputs.number("--reciprocating", arguments.reciprocating) / 1e3
        cylinders = [each.replace(reciprocating_mass=mass) for each in engine.cylinders]
        engine = engine.replace(cylinder=cylinders)
    if arguments.rotating is not None:
        mass = inputs.number("--rotating", arguments.rotating) / 1e3
        engine = engine.replace(rotating_mass=mass)
    bob = bob_weight(
        engine,
        inputs.number("--factor", arguments.factor),
        inputs.number("--oil", arguments.oil) / 1e3,
    )
    outputs.draw(bob, picture)
    return outputs.printed([bob.table], csv=arguments.csv)
