"""The command ``design``: cranks and bank angles that minimise an objective."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from crankpin._core import InputError
from crankpin.analysis.design.design import design
from crankpin.cli import inputs, outputs, parser

if TYPE_CHECKING:
    import argparse

    from crankpin.analysis.design.question import Kind
    from crankpin.cli.parser import Commands
    from crankpin.model.engine import Engine


def add(commands: Commands) -> None:
    """Add the command ``design``."""
    designs = parser.command(
        commands,
        "design",
        "cranks, pin splits and bank angles that minimise an objective",
        example="design v10-72 --bank-angle 60:120 --even-firing --by total.moment.peak",
        run=run,
        note="Moving parts, spacing, bank angle, number of cylinders and banks are those of NAME;\n"
        "its crank is not used. Objectives are those of rank. Ranges are LOW:HIGH.",
    )
    parser.shared(designs, "name")
    designs.add_argument("--cylinders", metavar="N", help="number of cylinders (default: NAME's)")
    designs.add_argument(
        "--layout", choices=("inline", "vee", "flat", "boxer"), help="default: inline or vee"
    )
    parser.shared(designs, "--by")
    designs.add_argument(
        "--bank-angle",
        metavar="RANGE",
        help="of a vee, degrees: one, or LOW:HIGH to choose from (default: NAME's)",
    )
    designs.add_argument(
        "--pin-split",
        metavar="RANGE",
        help="left pin minus right pin, degrees, or LOW:HIGH (default: shared pins)",
    )
    designs.add_argument(
        "--own-splits", action="store_true", help="let each throw have a split of its own"
    )
    designs.add_argument(
        "--throws",
        metavar="A,B,…",
        help="throws to be put in order, degrees, or free (default: equally spaced)",
    )
    designs.add_argument("--even-firing", action="store_true", help="only cranks that fire evenly")
    designs.add_argument(
        "--intervals", metavar="A,B,…", help="only cranks that fire at these intervals, degrees"
    )
    designs.add_argument(
        "--counterweights",
        action="store_true",
        help="do not count what counterweights remove, the forward part of order 1",
    )
    designs.add_argument(
        "--shafts",
        metavar="A,B,…",
        help="speed ratios of balance shafts that are allowed: --shafts=-1 or --shafts=2,-2",
    )
    parser.shared(designs, "--rpm", "--orders")
    designs.add_argument(
        "--count", default="20", help="number of designs to print (default: %(default)s)"
    )
    parser.shared(designs, "--seed", "--csv", "--plot")


def run(arguments: argparse.Namespace) -> str:
    """Return what the command prints."""
    engine = inputs.engine(arguments.name, "design")
    if len(set(engine.cylinders)) > 1 or len(engine.banks) > 2:
        raise InputError(
            f"NAME = {arguments.name}: give an engine with one or two banks of cylinders that are "
            "alike"
        )
    picture = inputs.picture_file(arguments.plot)
    layout = arguments.layout or ("inline" if len(engine.banks) == 1 else "vee")
    angle = _range("--bank-angle", arguments.bank_angle)
    if angle is None and layout == "vee" and len(engine.banks) == 2:
        angle = engine.bank_angle_deg
    found = design(
        len(engine)
        if arguments.cylinders is None
        else inputs.whole("--cylinders", arguments.cylinders),
        layout=cast("Kind", layout),
        cylinder=engine.cylinders[0],
        spacing=_spacing(engine),
        rotating_mass=float(engine.rotating_mass[0]),
        rpm=inputs.number("--rpm", arguments.rpm),
        by=arguments.by,
        bank_angle_deg=angle,
        pin_split_deg=_range("--pin-split", arguments.pin_split),
        same_split=not arguments.own_splits,
        throws_deg="free" if arguments.throws == "free" else _listed(arguments.throws),
        even_firing=arguments.even_firing,
        intervals_deg=_listed(arguments.intervals),
        counterweights=arguments.counterweights,
        shafts=[inputs.whole("--shafts", each) for each in _listed(arguments.shafts) or []],
        orders=inputs.orders(arguments.orders),
        count=inputs.whole("--count", arguments.count),
        seed=inputs.whole("--seed", arguments.seed),
    )
    outputs.draw(found, picture)
    return outputs.printed([found.table], csv=arguments.csv)


def _spacing(engine: Engine) -> float:
    """Return the distance between neighbouring throws."""
    along = np.sort(engine.z[[number - 1 for number in next(iter(engine.banks.values()))]])
    return float(along[1] - along[0]) if along.size > 1 else 0.0


def _listed(text: str | None) -> list[str] | None:
    return None if text is None else text.split(",")


def _range(name: str, text: str | None) -> Any:  # noqa: ANN401 - one angle or two, as text
    if text is None or ":" not in text:
        return text
    ends = text.split(":")
    if len(ends) != 2:
        raise InputError(f"{name} = {text}: give one angle, or LOW:HIGH")
    return tuple(ends)
