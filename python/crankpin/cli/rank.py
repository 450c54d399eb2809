"""The command ``rank``: engines by an objective, the smallest first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin.analysis.ranking.rank import rank
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``rank``."""
    ranks = parser.command(
        commands,
        "rank",
        "engines by an objective, the smallest first, each at its best bank angles",
        example="rank ijesc-v6 --rpm 5000 --by [1].moment.backward,[2].moment.peak",
        run=run,
        note="Of several objectives the later ones break ties. They are total.moment.peak and\n"
        "total.force.peak (the longest vector, all orders together), the same with .peak_xy,\n"
        "total.torque.peak, [1].moment.backward (left by counterweights), [2].moment.peak\n"
        "(of one order) and unevenness_deg.",
    )
    ranks.add_argument("names", metavar="NAME", nargs="+", help="as for sweep")
    parser.shared(ranks, "--by")
    ranks.add_argument(
        "--bank-angle",
        dest="bank_angle_deg",
        metavar="RANGE",
        default="10:170:10",
        help="degrees to choose from, or own for each engine's own (default: %(default)s)",
    )
    parser.shared(ranks, "--hold")
    ranks.add_argument("--refine", action="store_true", help="look between these angles too")
    parser.shared(ranks, "--rpm", "--orders", "--reference-z", "--spectrum", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    known = inputs.engines(arguments.names)
    engines = {name: inputs.about_plane(each, arguments) for name, each in known.items()}
    own = arguments.bank_angle_deg == "own"
    angles = None if own else inputs.number_or_range("--bank-angle", arguments.bank_angle_deg)
    points = len(engines) * (1 if angles is None else np.size(angles))
    if points > inputs.MOST_ROWS:
        raise InputError(f"{points} points to rank: give {inputs.MOST_ROWS} at most")
    picture = inputs.picture_file(arguments.plot)
    ranking = rank(
        engines,
        rpm=inputs.number("--rpm", arguments.rpm),
        bank_angle_deg=angles,
        hold=None if own else arguments.hold,
        by=arguments.by.split(","),
        spectrum=inputs.spectrum(arguments.spectrum),
        refine=arguments.refine,
        orders=inputs.orders(arguments.orders),
    )
    outputs.draw(ranking, picture)
    return outputs.printed([ranking.table], csv=arguments.csv)
