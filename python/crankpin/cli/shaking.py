"""Commands: balance, explain, sweep, rank."""

from __future__ import annotations

import itertools
import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels, tables, units
from crankpin._support.frames import FIRST, PHASES, Frames
from crankpin._support.quantities import QUANTITIES
from crankpin._support.record import changed
from crankpin._support.tables import Column, Table
from crankpin.analysis.ranking.rank import rank
from crankpin.analysis.sweeps.sweep import Sweep, engine_titles, sweep
from crankpin.cli.arguments import MOST_ROWS, Given
from crankpin.cli.options import PROG, command, keyword, option
from crankpin.cli.outputs import Shown, in_short, left_out, only

if TYPE_CHECKING:
    from crankpin.analysis.balance import Balance

SWEPT_FLAGS = ("--bank-angle", "--rod-ratio", "--pin-offset", "--rpm")
"""Options of dimensions that are swept."""


PHASES_NOTE = (
    "Order n is peak·cos(n·θ + phase), θ the crank angle: the phase is that of the phasor P in\n"
    "Re(P·exp(i·n·θ)); x is to the right, y up, seen from the flywheel.\n"
)
HALF_ORDERS = (
    f"Half orders are those of gas pressure, which this engine lacks: try {PROG} torque.\n"
)


@command(
    "balance",
    "peaks of force, moment and torque at one speed, order by order",
    "name --rpm --orders --rtol --quantity --reference-z --about --spectrum",
    option("--phases", action="store_true", help="print the phase beside the peak along each axis"),
    "--units",
    option("--frame", choices=(FIRST, PHASES)),
    "--csv --plot",
    example="balance v6-60 --rpm 6000 --plot v6.png",
)
def _balance(call: Given) -> Shown:
    engine, chosen = call.engine("balance"), call.chosen()
    balance = call.about(
        engine.balance(call.number("--rpm", "rpm"), spectrum=call.spectrum(), **chosen)
    )
    note = ""
    if chosen["orders"] == "auto":
        note = left_out(balance)
    elif any(order % 1 for order in chosen["orders"]) and not engine.fired:
        note = HALF_ORDERS
    table = balance.table
    if call.text("--phases"):
        table, note = _with_phases(balance), units.joined("", [PHASES_NOTE, note])
    if not call.text("--csv"):
        table = in_short(
            table, balance, *(n for n in balance._request.quantities if n != "crank_torque")
        )
    frames = Frames({FIRST: lambda: table}, for_programs={PHASES: balance._phases})
    return Shown(frames, balance, {"quantity": call.quantity([engine])}, note=note)


def _with_phases(balance: Balance) -> Table:
    """Return the table of a balance with the phase of each component beside its peak."""
    keys, *peaks = balance.table.columns
    names = [name for name in balance._request.quantities if name != "crank_torque"]
    of_components = [
        (QUANTITIES[name].symbols[k].strip("|"), name, component)
        for name in names
        for k, component in enumerate(QUANTITIES[name].axes or ("z",))
    ]
    rows = balance.frames[PHASES]
    places = zip(*(rows[name].values for name in ("order", "quantity", "component")), strict=True)
    angles = dict(zip(places, rows["phase_deg"].values, strict=True))
    columns = [keys]
    for peak, (symbol, *component) in zip(peaks, of_components, strict=True):
        phases = tuple(angles.get((key, *component)) for key in keys.values)
        columns += [peak, Column(f"{symbol} phase", phases, "°", digits=4)]
    return changed(balance.table, columns=tuple(columns))


@command(
    "explain",
    "how an engine shakes and why, in plain sentences",
    "name",
    option("--rpm", default=None, help="crank speed (default: figures without a speed)"),
    "--reference-z --units",
    example="explain v8-crossplane --rpm 6000",
)
def _explain(call: Given) -> str:
    return f"{call.engine('explain').explain(call.optional('--rpm', 'rpm'))}\n"


@command(
    "sweep",
    "peaks of each order over bank angle, rod ratio, pin offset or speed",
    option(
        "names",
        metavar="NAME",
        nargs="+",
        help="presets, engine files (.toml, .json), or families of presets: ijesc-v6 stands for "
        "all whose names begin with ijesc-v6-",
    ),
    *(
        keyword(sweep, name, read=partial(Given.range, unit=unit), metavar="RANGE")
        for name, unit in [("bank_angle_deg", "°"), ("rod_ratio", ""), ("pin_offset", "m")]
    ),
    option("--rpm", metavar="RANGE", help="crank speeds (default: %(default)s)"),
    "--hold --orders --rtol",
    option(
        "--quantity",
        help="quantity of the table (default: moment, or force if all cylinders are at one z)",
    ),
    "--reference-z --spectrum --units",
    option("--frame", choices=(FIRST, PHASES)),
    "--csv --plot",
    example="sweep ijesc-v6 --rpm 5000 --bank-angle 10:170:10 --plot v6.png",
    note="A range is START:STOP:STEP (stop included), a list a,b,c, or one number. Write one\n"
    "that begins with minus as --pin-offset=-0.002:0.002:0.001. With nothing to sweep, bank\n"
    "angle goes from 10 to 170 by 10.",
)
def _sweep(call: Given) -> Shown:
    engines = call.engines()
    axes = call.keywords(sweep) | {"rpm": call.range("--rpm", "rpm")}
    if not any(np.ndim(values) for values in axes.values()):
        vees = all(len(engine.banks) == 2 for engine in engines.values())
        if "bank_angle_deg" not in axes and vees:
            axes["bank_angle_deg"] = np.arange(10.0, 171.0, 10.0)
        elif len(engines) == 1:
            flags = ", ".join(flag for flag in SWEPT_FLAGS if vees or "bank" not in flag)
            hint = f"give one of {flags} as START:STOP:STEP or a,b,c"
            hint = f"all options have one value; {hint}"
            raise inputs.faulty("sweep", "has nothing to sweep", hint)
    rows = math.prod([len(engines), *map(np.size, axes.values())])
    if rows > MOST_ROWS:
        raise inputs.faulty("sweep", f"has {rows} points to sweep", f"give {MOST_ROWS} at most")
    chosen = call.chosen()
    result = sweep(
        engines if len(engines) > 1 else next(iter(engines.values())),
        **axes,
        hold=call.text("--hold") if "bank_angle_deg" in axes else None,
        spectrum=call.spectrum(),
        **chosen,
    )
    frames, note = _frames_of(result, call)
    note = units.joined("", [note, left_out(result)]) if chosen["orders"] == "auto" else ""
    frames = Frames({name: partial(frames.__getitem__, name) for name in frames},
                    for_programs={PHASES: result._phases})  # fmt: skip
    drawn = {"quantity": call.quantity(result.engines)}
    return Shown(frames, result, drawn, note=note)


def _frames_of(result: Sweep, call: Given) -> tuple[Frames, str]:
    """Return a table for each engine, or a single one with a column of engines; and a note.

    For reading, engines that are swept along something else stand below each other, as in the
    papers; a program needs a single table, and so does a comparison of engines alone. The note
    names the chosen orders that are left out of tables for reading.
    """
    quantity = call.quantity(result.engines)
    symbols = QUANTITIES[quantity].symbols
    peaks = result.read(quantity, "peak_xy" if QUANTITIES[quantity].planar else "peak")
    places, left = result._shown_orders(quantity)
    if call.text("--csv"):
        places, left = tuple(range(len(result.orders))), ()
    note = f"{labels.not_shown(left)}\n" if left else ""
    dims = [dim for dim in result.coords if dim != "engine"]
    swept = list(itertools.product(*(np.asarray(result.coords[dim]).tolist() for dim in dims)))
    # Without -1, which has no value where there is no order.
    shape = (len(result.engines), len(swept), len(result.orders), len(symbols))
    rows = peaks.reshape(shape)[:, :, list(places)]
    rows = rows.reshape(*shape[:2], len(places) * len(symbols))
    heads = [(name, unit.strip()) for name, unit in map(labels.SWEPT.__getitem__, dims)]
    heads += [
        (f"{symbol} order {order}", QUANTITIES[quantity].unit)
        for order in (result.orders[place] for place in places)
        for symbol in symbols
    ]
    how = _how(result, call)
    decimals = tables.common_decimals(rows)
    # The title has a spectrum.
    loads = getattr(result, quantity).loads_counted if result.spectrum is None else ""
    if "engine" not in result.coords or (dims and not call.text("--csv")):
        of_engines = zip(
            result.coords.get("engine", [FIRST]), engine_titles(result), rows, strict=True
        )
        return Frames(
            {
                str(name): partial(
                    Table.from_rows, f"{title}: {how}", heads, swept, engine, decimals, loads=loads
                )
                for name, title, engine in of_engines
            }
        ), note
    points = [(name, *point) for name in result.coords["engine"] for point in swept]
    title = f"{how[0].upper()}{how[1:]}"
    table = rows.reshape(len(points), rows.shape[-1])
    whole = Table.from_rows(title, ["engine", *heads], points, table, decimals, loads=loads)
    return only(whole), note


def _how(result: Sweep, call: Given) -> str:
    """Return what the table shows, and what is fixed, held or given."""
    quantity = call.quantity(result.engines)
    parts = [f"peaks of {QUANTITIES[quantity].words}"]
    parts += [labels.value_text(dim, value) for dim, value in result.fixed.items()]
    if result.hold is not None:
        parts.append(labels.HELD[result.hold])
    if quantity == "moment" and call.text("--reference-z") is not None:
        parts.append(f"about z = {call.echo('--reference-z', 'm')}")
    if call.text("--spectrum") is not None:
        parts.append(f"spectrum {call.echo('--spectrum', 'kg·m')}")
    return ", ".join(parts)


@command(
    "rank",
    "engines ranked by an objective, best first, at the best of some bank angles or at their own",
    option("names", metavar="NAME", nargs="+", help="as for sweep"),
    "--by",
    option(
        "--bank-angle",
        metavar="RANGE",
        help="degrees to choose from, or own for each engine's own (default: own)",
    ),
    "--hold",
    keyword(rank, "refine"),
    "--rpm --orders --rtol --reference-z --spectrum --units --csv --plot",
    option("--save", help="write the best engine at its best bank angle (.toml, .json)"),
    "--force",
    example="rank ijesc-v6 --rpm 5000 --bank-angle 10:170:10 "
    "--by [1].moment.backward,[2].moment.peak",
    note="Of several objectives the later ones break ties. They are total.moment.peak and\n"
    "total.force.peak (the longest vector, all orders together), the same with .peak_xy,\n"
    "total.torque.peak, [1].moment.backward (left by counterweights), [2].moment.peak\n"
    "(of one order) and unevenness_deg.",
)
def _rank(call: Given) -> Shown:
    engines = call.engines()
    as_it_is = call.text("--bank-angle") in (None, "own")
    angles: Any = None if as_it_is else call.range("--bank-angle", "°")
    points = len(engines) * (1 if angles is None else np.size(angles))
    if points > MOST_ROWS:
        raise inputs.faulty("rank", f"has {points} points to rank", f"give {MOST_ROWS} at most")
    ranking = rank(
        engines,
        rpm=call.number("--rpm", "rpm"),
        bank_angle_deg=angles,
        hold=None if as_it_is else call.text("--hold"),
        by=call.text("--by"),
        spectrum=call.spectrum(),
        **call.keywords(rank),
        **call.chosen(),
    )
    return Shown(ranking.frames, ranking, engine=ranking[0].engine)
