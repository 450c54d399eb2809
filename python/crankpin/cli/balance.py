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
    one.add_argument("name", metavar="NAME", help="a preset, or an engine file (.toml, .json)")
    one.add_argument("--rpm", default="3000", help="crank speed (default: %(default)s)")
    parser.orders_and_rtol(one)
    parser.quantity_and_output(one, "quantity of the picture")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "balance")
    chosen = inputs.chosen(arguments)
    picture = inputs.picture_file(arguments.plot)
    balance = engine.balance(
        inputs.number("--rpm", arguments.rpm),
        reference_z=inputs.plane(arguments.reference_z),
        spectrum=inputs.spectrum(arguments.spectrum),
        **chosen,
    )
    if picture is not None:
        outputs.write(balance.plot(quantity=arguments.quantity), picture)
    text = outputs.printed([balance.table()], csv=arguments.csv)
    return text if arguments.csv or chosen["orders"] != "auto" else text + outputs.left_out(balance)
