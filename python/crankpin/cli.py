"""The command line: tables and pictures of balances, sweeps and firings."""

from __future__ import annotations

import argparse
import itertools
import math
import os
import sys
import warnings
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TextIO

import numpy as np

from crankpin._core import InputError, __version__
from crankpin._support import labels, tables
from crankpin.analysis.rank import rank
from crankpin.analysis.sweep import Sweep, engine_titles, sweep
from crankpin.model import presets
from crankpin.model.engine import Engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.balance import Balance

PROG = "crankpin"
MOST_ROWS = 1_000_000
"""Largest number of rows in a table."""
MOST_SHOWN = 20
"""Largest number of firing orders in a table; CSV has all."""
PICTURES = (".pdf", ".png", ".svg")
FLAGS = {
    "bank_angle_deg": "--bank-angle",
    "rod_ratio": "--rod-ratio",
    "pin_offset": "--pin-offset",
    "rpm": "--rpm",
}
"""Swept dimension → its option."""
COLUMNS = {
    "bank_angle_deg": "bank angle °",
    "rod_ratio": "rod ratio",
    "pin_offset": "pin offset m",
    "rpm": "rpm",
}
"""Swept dimension → head of its column."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _warn
            _write_out(_text(argv))
    except BrokenPipeError:
        # The reader of the pipe has closed it.
        _abandon(sys.stdout)
        return 128 + 13  # as a shell reports SIGPIPE
    except (InputError, OSError, ImportError) as error:
        _say(f"error: {error}")
        return 2
    except KeyboardInterrupt:
        return 128 + 2
    return 0


def _text(argv: Sequence[str] | None) -> str:
    """Return what a command prints."""
    try:
        arguments = _parser().parse_args(argv)
    except SystemExit:
        if sys.stdout is not None:
            _write_out("")  # flushes the help while a broken pipe can still be answered
        raise
    text: str = arguments.run(arguments)
    return text


def _write_out(text: str) -> None:
    """Write to standard output."""
    if sys.stdout is None:
        raise OSError("standard output is closed")
    try:
        # Line by line: a pipe that breaks within a single long write can go unnoticed.
        sys.stdout.writelines(text.splitlines(keepends=True))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        _abandon(sys.stdout)
        raise OSError(f"standard output: {error.strerror}") from None


def _abandon(stream: TextIO) -> None:
    """Discard what is buffered: Python would fail once more while it closes the stream."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)


def _say(message: str) -> None:
    """Write a line to standard error, if there is one; print(file=None) would write to stdout."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(f"crankpin: {message}\n")
        sys.stderr.flush()
    except OSError:
        _abandon(sys.stderr)


def _warn(message: Warning | str, *_: object, **__: object) -> None:
    _say(f"warning: {message}")


# --- what can be typed --------------------------------------------------------------------------


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see {self.prog} --help")


def _parser() -> _Parser:
    parser = _Parser(
        prog=PROG,
        description="Shaking forces, rocking moments and torques of piston engines.",
        epilog=f"example:\n  {PROG} balance v8-crossplane --rpm 6000",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"crankpin {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    listing = _command(
        commands, "presets", "list the engines known by name", example="presets", run=_list
    )
    listing.add_argument("--csv", action="store_true", help="print CSV in place of the table")

    one = _command(
        commands,
        "balance",
        "peaks of force, moment and torque at one speed, order by order",
        example="balance v6-60 --rpm 6000 --plot v6.png",
        run=_balance,
    )
    one.add_argument("name", metavar="NAME", help="a preset, or an engine file (.toml, .json)")
    one.add_argument("--rpm", default="3000", help="crank speed (default: %(default)s)")
    _orders_and_rtol(one)
    _shared(one, "quantity of the picture")

    many = _command(
        commands,
        "sweep",
        "peaks of each order over bank angle, rod ratio, pin offset or speed",
        example="sweep ijesc-v6 --rpm 5000 --bank-angle 10:170:10 --plot v6.png",
        run=_sweep,
        note="A range is START:STOP:STEP (stop included), a list a,b,c, or one number. Write one\n"
        "that begins with minus as --pin-offset=-0.002:0.002:0.001. With nothing to sweep, bank\n"
        "angle goes from 10 to 170 by 10.",
    )
    many.add_argument(
        "names",
        metavar="NAME",
        nargs="+",
        help="presets, engine files (.toml, .json), or families of presets: ijesc-v6 stands for "
        "all whose names begin with ijesc-v6-",
    )
    many.add_argument("--bank-angle", dest="bank_angle_deg", metavar="RANGE", help="degrees")
    many.add_argument("--rod-ratio", metavar="RANGE", help="crank radius / rod length")
    many.add_argument("--pin-offset", metavar="RANGE", help="m")
    many.add_argument("--rpm", metavar="RANGE", default="3000", help="default: %(default)s")
    many.add_argument(
        "--hold",
        choices=("pins", "firing"),
        default="pins",
        help="what is held as the bank angle changes: the crankpins, or the crank angles of all "
        "top dead centres (default: %(default)s)",
    )
    _orders_and_rtol(many)
    _shared(many, "quantity of the table")

    ranks = _command(
        commands,
        "rank",
        "engines by an objective, the smallest first, each at its best bank angles",
        example="rank ijesc-v6 --rpm 5000 --by [1].moment.backward,[2].moment.peak",
        run=_rank,
        note="Of several objectives the later ones break ties. They are total.moment.peak and\n"
        "total.force.peak (the longest vector, all orders together), the same with .peak_xy,\n"
        "total.torque.peak, [1].moment.backward (left by counterweights), [2].moment.peak\n"
        "(of one order) and unevenness_deg.",
    )
    ranks.add_argument("names", metavar="NAME", nargs="+", help="as for sweep")
    ranks.add_argument(
        "--by",
        metavar="OBJECTIVE,…",
        default="total.moment.peak",
        help="what to minimise (default: %(default)s)",
    )
    ranks.add_argument(
        "--bank-angle",
        dest="bank_angle_deg",
        metavar="RANGE",
        default="10:170:10",
        help="degrees to choose from, or own for each engine's own (default: %(default)s)",
    )
    ranks.add_argument(
        "--hold", choices=("pins", "firing"), default="pins", help="as for sweep (%(default)s)"
    )
    ranks.add_argument("--refine", action="store_true", help="look between these angles too")
    ranks.add_argument("--rpm", default="3000", help="crank speed (default: %(default)s)")
    ranks.add_argument(
        "--orders", default="auto", help="such as 1,2,4, or auto (default: %(default)s)"
    )
    _cylinder_and_output(ranks)

    fires = _command(
        commands,
        "firing",
        "intervals and exhaust gaps of a firing order, or all orders that a crank allows",
        example="firing v8-crossplane --plot v8.png",
        run=_firing,
    )
    fires.add_argument("name", metavar="NAME", help="a preset, or an engine file (.toml, .json)")
    fires.add_argument(
        "--order",
        help="such as 1-3-4-2, with + for cylinders that fire together: 1+4-2+3 (default: the "
        "engine's own, if it is known)",
    )
    fires.add_argument("--all", action="store_true", help="list all orders that the crank allows")
    fires.add_argument("--strokes", choices=("4", "2"), help="default: the engine's own, or 4")
    fires.add_argument("--csv", action="store_true", help="print CSV in place of the table")
    fires.add_argument(
        "--plot", metavar="FILE", help="write the chart of valve periods (.pdf, .png, .svg)"
    )
    return parser


def _command(
    commands: argparse._SubParsersAction[_Parser],
    name: str,
    what: str,
    *,
    example: str,
    run: object,
    note: str = "",
) -> _Parser:
    parser = commands.add_parser(
        name,
        help=what,
        description=f"{what[0].upper()}{what[1:]}.",
        epilog=f"{note}\n\nexample:\n  {PROG} {example}".strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(run=run)
    return parser


def _shared(parser: _Parser, quantity: str) -> None:
    parser.add_argument(
        "--quantity",
        choices=("force", "moment", "torque"),
        default="moment",
        help=f"{quantity} (default: %(default)s)",
    )
    _cylinder_and_output(parser)


def _orders_and_rtol(parser: _Parser) -> None:
    parser.add_argument(
        "--orders",
        default="auto",
        help="such as 1,2,4, or auto for all that matter (default: %(default)s)",
    )
    parser.add_argument(
        "--rtol",
        help="with --orders auto: what the omitted orders may add up to, relative to m·r·ω² "
        "(default: 1e-9)",
    )


def _cylinder_and_output(parser: _Parser) -> None:
    parser.add_argument(
        "--reference-z",
        metavar="Z",
        help="plane about which moments are taken, m (default: midway between first and last)",
    )
    parser.add_argument(
        "--spectrum",
        metavar="N=A,…",
        help="one cylinder's force over ω² in each order, kg·m, in place of its slider-crank: "
        "1=9.0,2=3.75",
    )
    parser.add_argument("--csv", action="store_true", help="print CSV in place of the table")
    parser.add_argument("--plot", metavar="FILE", help="write a picture (.pdf, .png, .svg)")


# --- commands -----------------------------------------------------------------------------------


def _list(arguments: argparse.Namespace) -> str:
    return _printed([presets.presets().table("description")], csv=arguments.csv)


def _balance(arguments: argparse.Namespace) -> str:
    engine = _engine(arguments.name, "balance")
    chosen = _chosen(arguments)
    picture = _picture_file(arguments.plot)
    balance = engine.balance(
        _number("--rpm", arguments.rpm),
        reference_z=_plane(arguments.reference_z),
        spectrum=_spectrum(arguments.spectrum),
        **chosen,
    )
    if picture is not None:
        figure = balance.plot(quantity=arguments.quantity).get_figure(root=True)
        assert figure is not None  # noqa: S101 - new axes are in a figure
        _write(figure, picture)
    text = _printed([balance.table()], csv=arguments.csv)
    return text if arguments.csv or chosen["orders"] != "auto" else text + _left_out(balance)


def _chosen(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return orders, or "auto", and the tolerance by which they are chosen, if it is given."""
    orders = _orders(arguments.orders)
    if arguments.rtol is None:
        return {"orders": orders}
    if orders != "auto":
        raise InputError("--rtol needs --orders auto")
    return {"orders": orders, "rtol": _number("--rtol", arguments.rtol)}


def _left_out(result: Balance | Sweep) -> str:
    force, moment, torque = result.error_bound
    listed = ", ".join(map(str, result.omitted))
    seen = f"; omitted: {listed}" if listed else ""
    roll = "" if torque is None else f" and {torque:.2g} N·m to the roll torque"
    return (
        f"Omitted orders add at most {force:.2g} N to the force, {moment:.2g} N·m to the "
        f"rocking moment{roll}{seen}.\n"
    )


def _sweep(arguments: argparse.Namespace) -> str:
    engines = _engines(arguments.names)
    texts = {dim: getattr(arguments, dim) for dim in FLAGS}
    given = {dim: _range(FLAGS[dim], text) for dim, text in texts.items() if text is not None}
    if not any(np.ndim(values) for values in given.values()):
        vees = all(hasattr(engine, "bank_angle_deg") for engine in engines.values())
        if "bank_angle_deg" not in given and vees:
            given["bank_angle_deg"] = np.arange(10.0, 171.0, 10.0)
        elif len(engines) == 1:
            raise InputError(
                "nothing to sweep: give --rod-ratio, --pin-offset, --rpm, or --bank-angle for an "
                "engine of two banks, as START:STOP:STEP or a,b,c"
            )
    rows = math.prod([len(engines), *map(np.size, given.values())])
    if rows > MOST_ROWS:
        raise InputError(f"{rows} points to sweep: give {MOST_ROWS} at most")
    chosen = _chosen(arguments)
    picture = _picture_file(arguments.plot)
    result = sweep(
        engines if len(engines) > 1 else next(iter(engines.values())),
        rpm=given["rpm"],
        bank_angle_deg=given.get("bank_angle_deg"),
        rod_ratio=given.get("rod_ratio"),
        pin_offset=given.get("pin_offset"),
        hold=arguments.hold if "bank_angle_deg" in given else None,
        reference_z=_plane(arguments.reference_z),
        spectrum=_spectrum(arguments.spectrum),
        **chosen,
    )
    tables, negligible = _tables_of(result, arguments)
    if picture is not None:
        _write(result.plot(quantity=arguments.quantity)[0, 0].get_figure(root=True), picture)
    text = _printed(tables, csv=arguments.csv)
    if arguments.csv or chosen["orders"] != "auto":
        return text
    return text + negligible + _left_out(result)


def _rank(arguments: argparse.Namespace) -> str:
    engines = _engines(arguments.names)
    own = arguments.bank_angle_deg == "own"
    angles = None if own else _range("--bank-angle", arguments.bank_angle_deg)
    points = len(engines) * (1 if angles is None else np.size(angles))
    if points > MOST_ROWS:
        raise InputError(f"{points} points to rank: give {MOST_ROWS} at most")
    picture = _picture_file(arguments.plot)
    ranking = rank(
        engines,
        rpm=_number("--rpm", arguments.rpm),
        bank_angle_deg=angles,
        hold=None if own else arguments.hold,
        by=arguments.by.split(","),
        reference_z=_plane(arguments.reference_z),
        spectrum=_spectrum(arguments.spectrum),
        refine=arguments.refine,
        orders=_orders(arguments.orders),
    )
    if picture is not None:
        figure = ranking.plot().get_figure(root=True)
        assert figure is not None  # noqa: S101 - new axes are in a figure
        _write(figure, picture)
    return _printed([ranking.table_of_choices()], csv=arguments.csv)


def _firing(arguments: argparse.Namespace) -> str:
    engine = _engine(arguments.name, "firing")
    strokes = None if arguments.strokes is None else int(arguments.strokes)
    if arguments.all or (arguments.order is None and not engine.firing_order):
        if arguments.plot is not None:
            raise InputError("--plot needs --order")
        return _firing_orders(engine, strokes, csv=arguments.csv)
    picture = _picture_file(arguments.plot)
    ways = engine.firings(arguments.order, strokes=strokes)
    best = engine.firing(arguments.order, strokes=strokes)
    if picture is not None:
        figure = best.plot().get_figure(root=True)
        assert figure is not None  # noqa: S101 - new axes are in a figure
        _write(figure, picture)
    text = _printed([best.table()], csv=arguments.csv)
    if arguments.csv or len(ways) == 1:
        return text
    others = "".join(f"  {way.intervals_text}\n" for way in ways[1:])
    return f"{text}The same order in other turns, intervals in degrees:\n{others}"


def _firing_orders(engine: Engine, strokes: int | None, *, csv: bool) -> str:
    firings = engine.firing_orders(strokes=strokes)
    shown = firings if csv else firings[:MOST_SHOWN]
    listed = [
        (each.firing_order, "even" if each.even and not csv else each.intervals_text)
        for each in shown
    ]
    rows = np.array([[each.unevenness_deg] for each in shown])
    name = engine.name or f"{len(engine)} cylinders"
    header = ["firing order", "intervals °", "rms from even °"]
    table = tables.Table(
        f"{name}: {firings[0].strokes}-stroke, most even first", header, listed, rows
    )
    text = _printed([table], csv=csv)
    rest = len(firings) - len(shown)
    return f"{text}and {rest} more: --csv prints all\n" if rest else text


# --- from text to values ------------------------------------------------------------------------


def _engines(names: Sequence[str]) -> dict[str, Engine]:
    """Return engines by their names, or by what was typed where names do not tell them apart."""
    typed: dict[str, Engine] = {}
    for name in names:
        if Path(name).suffix.lower() in (".toml", ".json"):
            typed[name] = Engine.load(name)
        else:
            typed |= {member: Engine.preset(member) for member in presets.family(name)}
    titles = [engine.name for engine in typed.values()]
    return {
        title if title and titles.count(title) == 1 else name: engine
        for title, (name, engine) in zip(titles, typed.items(), strict=True)
    }


def _engine(name: str, command: str) -> Engine:
    """Return the engine of a command that takes one."""
    engines = _engines([name])
    if len(engines) > 1:
        members = ", ".join(presets.family(name))
        raise InputError(f"NAME = {name}: {command} takes one engine of {members}")
    return next(iter(engines.values()))


def _decimal(name: str, text: str) -> Decimal:
    try:
        number = Decimal(text.strip())
    except InvalidOperation:
        raise InputError(f"{name} = {labels.cut(text)}: give a number") from None
    # Decimals go far beyond floats; with these the arithmetic below could not overflow.
    if not number.is_finite() or not math.isfinite(float(number)):
        raise InputError(f"{name} = {labels.cut(text)}: give a finite number")
    return number


def _number(name: str, text: str) -> float:
    return float(_decimal(name, text))


def _range(name: str, text: str) -> float | NDArray[np.float64]:
    """Return one number, a list of numbers, or START:STOP:STEP with the stop included."""
    if ":" not in text:
        numbers = [_number(name, part) for part in text.split(",")]
        return np.array(numbers) if "," in text else numbers[0]
    parts = text.split(":")
    if len(parts) != 3:
        raise InputError(f"{name} = {labels.cut(text)}: give START:STOP:STEP, a,b,c or one number")
    # In decimals, so that 0.2:0.4:0.1 holds 0.3 and 0.4 as they would be typed.
    start, stop, step = (_decimal(name, part) for part in parts)
    if float(step) == 0.0 or (stop - start) * step < 0:
        raise InputError(
            f"{name} = {labels.cut(text)}: the step does not lead from {start} to {stop}"
        )
    steps = (stop - start) / step
    if steps >= MOST_ROWS:
        raise InputError(
            f"{name} = {labels.cut(text)}: {float(steps):.3g} steps; give {MOST_ROWS} at most"
        )
    return np.array([float(start + k * step) for k in range(int(steps) + 1)])


def _orders(text: str) -> Orders:
    if text == "auto":
        return "auto"
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        cure = "give whole numbers, such as 1,2,4, or auto"
        raise InputError(f"--orders = {labels.cut(text)}: {cure}") from None


def _plane(text: str | None) -> float | None:
    return None if text is None else _number("--reference-z", text)


def _spectrum(text: str | None) -> Spectrum | None:
    if text is None:
        return None
    spectrum: dict[int, float] = {}
    for part in text.split(","):
        order, _, amplitude = part.partition("=")
        try:
            number = int(order)
        except ValueError:
            number = 0
        if not amplitude or number < 1:
            raise InputError(
                f"--spectrum = {labels.cut(text)}: give order=amplitude, such as 1=9.0,2=3.75"
            )
        if number in spectrum:
            raise InputError(f"--spectrum = {labels.cut(text)}: order {number} is given twice")
        spectrum[number] = _number("--spectrum", amplitude)
    return spectrum


def _picture_file(text: str | None) -> Path | None:
    """Return the file of the picture, checked before anything is computed for it."""
    if text is None:
        return None
    path = Path(text)
    if path.suffix.lower() not in PICTURES:
        raise InputError(
            f"--plot = {labels.cut(text)}: a picture's name ends in {', '.join(PICTURES)}"
        )
    return path


# --- from values to text ------------------------------------------------------------------------


def _tables_of(result: Sweep, arguments: argparse.Namespace) -> tuple[list[tables.Table], str]:
    """Return a table for each engine, or a single one with a column of engines; and a note.

    For reading, engines that are swept along something else stand below each other, as in the
    papers; a program needs a single table, and so does a comparison of engines alone. The note
    names the chosen orders that are left out of tables for reading.
    """
    quantity = arguments.quantity
    symbols = labels.SYMBOLS[quantity]
    peaks = _peaks(result, quantity).reshape(-1, len(result.orders), len(symbols))
    shown, note = np.full(len(result.orders), fill_value=True), ""
    if arguments.orders == "auto" and not arguments.csv:
        largest = peaks.max(axis=(0, 2), initial=0.0)
        shown = largest >= labels.NEGLIGIBLE * largest.max(initial=0.0)
        left = tuple(n for n, kept in zip(result.orders, shown, strict=True) if not kept)
        note = f"{labels.not_shown(left)}\n" if left else ""
    rows = peaks[:, shown].reshape(len(result.engines), -1, int(shown.sum()) * len(symbols))
    dims = [dim for dim in result.coords if dim != "engine"]
    swept = list(itertools.product(*(np.asarray(result.coords[dim]).tolist() for dim in dims)))
    heads = [COLUMNS[dim] for dim in dims]
    heads += [
        f"{symbol} order {order} {labels.UNITS[quantity]}"
        for order in np.array(result.orders)[shown].tolist()
        for symbol in symbols
    ]
    how = _how(result, arguments)
    decimals = tables.decimals(rows)
    if "engine" not in result.coords or (dims and not arguments.csv):
        return [
            tables.Table(f"{name}: {how}", heads, swept, each, decimals)
            for name, each in zip(engine_titles(result), rows, strict=True)
        ], note
    points = [(name, *point) for name in result.coords["engine"] for point in swept]
    title = f"{how[0].upper()}{how[1:]}"
    table = rows.reshape(len(points), -1)
    return [tables.Table(title, ["engine", *heads], points, table, decimals)], note


def _peaks(result: Sweep, quantity: str) -> NDArray[np.float64]:
    """Return the peaks of a quantity: (…, n_orders, components)."""
    drawn = getattr(result, quantity)
    peaks: NDArray[np.float64] = drawn.peak if quantity == "torque" else drawn.peak_xy
    return peaks


def _how(result: Sweep, arguments: argparse.Namespace) -> str:
    """Return what the table shows, and what is fixed, held or given."""
    parts = [f"peaks of {labels.NAMES[arguments.quantity]}"]
    parts += [labels.value_text(dim, value) for dim, value in result.fixed.items()]
    if result.hold is not None:
        parts.append(labels.HELD[result.hold])
    if arguments.quantity == "moment" and arguments.reference_z is not None:
        parts.append(f"about z = {_number('', arguments.reference_z):g} m")
    if arguments.spectrum is not None:
        parts.append(f"spectrum {arguments.spectrum} kg·m")
    return ", ".join(parts)


def _printed(tables: list[tables.Table], *, csv: bool) -> str:
    if csv:
        return "".join(table.csv() for table in tables)
    return "\n\n".join(table.text() for table in tables) + "\n"


def _write(figure: Figure, path: Path) -> None:
    from matplotlib import pyplot as plt  # noqa: PLC0415 - matplotlib is imported when used

    try:
        figure.savefig(path, dpi=200)
    finally:
        plt.close(figure)
