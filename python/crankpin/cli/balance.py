"""The command ``balance``: peaks at one speed, order by order."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``balance``."""
    one = parser.command(
        commands,
        "balance",
        "peaks of force, moment and torque at one speed, order by order",
        example="balance v6-60 --rpm 6000 --plot v6.png",
        run=run,
    )
    parser.shared(one, "name", "--rpm", "--orders", "--rtol")
    parser.shared(one, "--quantity", help="quantity of the picture (default: %(default)s)")
    parser.shared(one, "--reference-z", "--spectrum", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.about_plane(inputs.engine(arguments.name, "balance"), arguments)
    chosen = inputs.chosen(arguments)
    picture = inputs.picture_file(arguments.plot)
    balance = engine.balance(
        inputs.number("--rpm", arguments.rpm),
        spectrum=inputs.spectrum(arguments.spectrum),
        **chosen,
    )
    outputs.draw(balance, picture, quantity=arguments.quantity)
    text = outputs.printed([balance.table], csv=arguments.csv)
    return text if arguments.csv or chosen["orders"] != "auto" else text + outputs.left_out(balance)
