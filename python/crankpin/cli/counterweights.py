"""The command ``counterweights``: weights on the crankshaft, and what they leave."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from crankpin._core import InputError
from crankpin._support import labels
from crankpin.analysis.balancing.counterweights import counterweights
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.analysis.balancing.correction_planes import Planes
    from crankpin.cli.parser import Commands


def add(commands: Commands) -> None:
    """Add the command ``counterweights``."""
    fits = parser.command(
        commands,
        "counterweights",
        "weights that remove the most of what turns with the crankshaft at order 1",
        example="counterweights v8-crossplane --planes webs --plot weights.png",
        run=run,
        note="Amounts are mass·radius in kg·m, angles those at θ = 0 from +x, as the crank turns.\n"
        "What stays is in kg·m and kg·m², to be multiplied by ω².",
    )
    parser.shared(fits, "name")
    fits.add_argument(
        "--planes",
        default="webs",
        metavar="ends|webs|Z,…|NAME=Z,…",
        help="where weights can be: at the first and last cylinder, at both webs of every throw, "
        "or at places in m; --planes=-0.1,0.4 if the first is below zero (default: %(default)s)",
    )
    fits.add_argument(
        "--target",
        choices=("external", "internal"),
        default="external",
        help="relieve the mounts, or every throw's own main bearings (default: %(default)s)",
    )
    fits.add_argument(
        "--fraction",
        default="1",
        help="part of the forward force and moment to remove (default: 1)",
    )
    fits.add_argument(
        "--minimise",
        choices=("squares", "largest"),
        default="squares",
        help="of weights that do the same (default: %(default)s)",
    )
    fits.add_argument("--bound", help="largest mass·radius of a plane, kg·m")
    fits.add_argument(
        "--angles", metavar="RANGE", help="drilling places, degrees: 0,90,180,270 or 0:345:15"
    )
    parser.shared(fits, "--reference-z", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "counterweights")
    picture = inputs.picture_file(arguments.plot)
    angles = arguments.angles
    fitted = counterweights(
        engine,
        planes=_planes(arguments.planes),
        target=arguments.target,
        fraction=inputs.number("--fraction", arguments.fraction),
        minimise=arguments.minimise,
        bound=inputs.optional_number("--bound", arguments.bound),
        angles_deg=(
            None
            if angles is None
            else np.atleast_1d(inputs.number_or_range("--angles", angles)).tolist()
        ),
        reference_z=inputs.optional_number("--reference-z", arguments.reference_z),
    )
    outputs.draw(fitted, picture)
    return outputs.printed([fitted.table], csv=arguments.csv)


def _planes(text: str) -> Planes:
    if text in ("ends", "webs"):
        return text
    parts = [part.rpartition("=") for part in text.split(",")]
    named = [name for name, equals, _ in parts if equals]
    if not named:
        return [inputs.number("--planes", place) for _, _, place in parts]
    if len(set(named)) < len(parts):
        cure = "give ends, webs, places, or a name of its own for each place"
        raise InputError(f"--planes = {labels.cut(text)}: {cure}")
    return {name.strip(): inputs.number("--planes", place) for name, _, place in parts}
