"""The command ``tolerances``: what deviating parts leave of an engine's balance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from crankpin._core import InputError
from crankpin._support import labels
from crankpin.analysis.tolerances.spreads import FIGURES, SPREADS
from crankpin.analysis.tolerances.tolerances import tolerances
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands

MOST_SAMPLES = 10_000_000
FLAGS = {name: f"--{name.removesuffix('_deg').replace('_', '-')}" for name in FIGURES}
"""Figure that spreads → its option."""


def add(commands: Commands) -> None:
    """Add the command ``tolerances``."""
    one = parser.command(
        commands,
        "tolerances",
        "what deviating masses, crankpins, places and rods leave of an engine's balance",
        example="tolerances i6 --rpm 6000 --reciprocating-mass 0.002 --pin 0.1 --shares",
        run=run,
        note="Spreads are standard deviations, or half widths with --distribution uniform.",
    )
    parser.shared(one, "name")
    for figure in FIGURES:
        title, unit = labels.TOLERANCES[figure]
        what = f"spread of the {title} of each {'crankpin' if 'crank' in title else 'cylinder'}"
        one.add_argument(
            FLAGS[figure], dest=figure, metavar="X", default="0",
            help=f"{what}, {'degrees' if unit == '°' else unit}",
        )  # fmt: skip
    one.add_argument(
        "--distribution", choices=tuple(SPREADS), default="normal", help="default: %(default)s"
    )
    one.add_argument("--samples", default="10000", help="number of samples (default: %(default)s)")
    parser.shared(one, "--seed", "--rpm")
    parser.shared(
        one,
        "--by",
        default=None,
        help="what to report, as for rank (default: total peaks, and order 1)",
    )
    one.add_argument(
        "--shares", action="store_true", help="report the share of each tolerance in the variance"
    )
    parser.shared(one, "--orders", "--reference-z", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "tolerances")
    picture = inputs.picture_file(arguments.plot)
    samples = inputs.whole("--samples", arguments.samples)
    if samples > MOST_SAMPLES:
        raise InputError(f"--samples = {samples}: give {MOST_SAMPLES} at most")
    spreads: dict[str, Any] = {
        name: inputs.number(FLAGS[name], getattr(arguments, name)) for name in FIGURES
    }
    result = tolerances(
        engine,
        rpm=inputs.number("--rpm", arguments.rpm),
        **spreads,
        distribution=arguments.distribution,
        samples=samples,
        seed=inputs.whole("--seed", arguments.seed),
        by=None if arguments.by is None else arguments.by.split(","),
        orders=inputs.orders(arguments.orders),
        reference_z=inputs.optional_number("--reference-z", arguments.reference_z),
    )
    outputs.draw(result, picture, kind="shares" if arguments.shares else "histogram")
    table = result.shares.table if arguments.shares else result.table
    return outputs.printed([table], csv=arguments.csv)
