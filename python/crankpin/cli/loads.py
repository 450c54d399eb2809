"""Commands: torque with gas pressure, and bearing loads."""

from __future__ import annotations

import inspect
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from crankpin._core import InputError
from crankpin._support import inputs, labels, units
from crankpin._support.frames import Frames
from crankpin._support.messages import hint_of
from crankpin._support.quantities import LOADS
from crankpin._support.record import changed
from crankpin._support.tables import Column, Table
from crankpin.analysis.bearings import REFERENCE_AXES, bearing_loads
from crankpin.analysis.oscillogram import Oscillogram, oscillogram
from crankpin.analysis.prepared_trace import prepare_trace
from crankpin.analysis.rod_loads import USUAL_REVERSAL, rod_loads
from crankpin.cli.options import PROG, command, keyword, keywords, option, rejected
from crankpin.cli.outputs import Shown, in_short, left_out, only
from crankpin.model.computed_cycles import EXAMPLES
from crankpin.model.cycle import Cycle
from crankpin.model.cycle_files import load
from crankpin.model.traces import Traces

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from matplotlib.axes import Axes

    from crankpin.analysis.prepared_trace import PreparedTrace
    from crankpin.cli.arguments import Given
    from crankpin.cli.options import Option
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.engine import Engine


def _columns(call: Given, flag: str) -> list[int | str]:
    """Return columns by number or name."""
    parts = (part.strip() for part in call.text(flag).split(","))
    return [int(part) if part.isdecimal() else part for part in parts]


def _channels(call: Given, flag: str) -> list[str]:
    """Return the channels of an option that is given once for each cylinder."""
    return list(call.text(flag))


OF_A_RECORD = (
    keyword(
        oscillogram,
        "pressure",
        group="an oscillogram, over time, in FILE",
        read=_channels,
        action="append",
        metavar="CH:GAIN,OFFSET",
        more="; once for each cylinder",
    ),
    *keywords(
        oscillogram, "encoder pulses index time sampling_rate", "an oscillogram, over time, in FILE"
    ),
)
"""Options of channels that an oscilloscope has recorded."""


def _of_files(group: str, **tdc: Any) -> tuple[Option, ...]:  # noqa: ANN401 - settings
    """Return the options by which files of pressure are read."""
    return (
        *keywords(load, "pressure_unit gauge", group),
        keyword(load, "gauge", "--absolute", group=group, help="pressure is absolute"),
        *keywords(load, "atmosphere angle_unit recorded_rpm", group),
        keyword(load, "tdc_deg", group=group, **tdc),
        keyword(
            load,
            "columns",
            group=group,
            read=_columns,
            metavar="A,P,…",
            more="; several cycles are averaged",
        ),
        *keywords(load, "sheet", group),
    )


OF_A_FILE = _of_files("the file of --cycle")
"""Options that need a file of ``--cycle``."""
WITHOUT_GAS = "none"
"""Value of ``--cycle`` for no gas pressure."""
ON = {"crank": "crank_torque", "block": "torque"}
"""Body on which a torque acts → its quantity."""


@command(
    "torque",
    "torque of gas pressure and inertia by half orders, with phases",
    "name --rpm --orders --rtol",
    option(
        "--on",
        choices=tuple(ON),
        default="crank",
        help="torque that is printed (default: %(default)s)",
    ),
    "--cycle --firing-order --bore --crankcase",
    *OF_A_FILE,
    option(
        "--picture",
        choices=("curves", "spectrum"),
        default="curves",
        help="over the crank angle, or by order (default: %(default)s)",
    ),
    "--units --csv --plot",
    example="torque i4 --rpm 1500 --bore 86mm --plot torque.png",
    note="Order n is |T|·cos(n·θ + phase), θ the crank angle: cylinder 1 is at top dead centre\n"
    "at 0 in presets, in an engine file at its tdc_deg. The engine needs a firing order.",
)
def _torque(call: Given) -> Shown:
    engine, note = fired(call, "torque")
    chosen, rpm = call.chosen(), call.number("--rpm", "rpm")
    balance, quantity = engine.balance(rpm, **chosen), ON[call.text("--on")]
    drawn = balance if call.text("--picture") == "spectrum" else engine.waveform(rpm)
    table = getattr(balance, quantity).table
    title = units.Text(f"{labels.name_of(engine)} at {rpm:g} rpm: ", table.title)
    table = table if call.text("--csv") else in_short(table, balance, quantity)
    rest = left_out(balance) if chosen["orders"] == "auto" else ""
    return Shown(
        only(changed(table, title=title)),
        drawn,
        {"quantity": quantity},
        note=units.joined("", [note, rest]),
    )


@command(
    "bearings",
    "loads of crankpins, wrist pins, cylinder walls and main bearings",
    "name --rpm --cycle --firing-order --bore --crankcase",
    *OF_A_FILE,
    option(
        "--load",
        choices=tuple(LOADS),
        default="main",
        help="load of the picture (default: %(default)s)",
    ),
    option(
        "--picture",
        choices=("polar", "curves", "bending"),
        default="polar",
        help="default: %(default)s",
    ),
    option(
        "--axes",
        choices=REFERENCE_AXES,
        default="engine",
        help="axes of a polar picture (default: %(default)s)",
    ),
    "--units",
    option("--frame", choices=("table", "mains", "crankpins", "shafts")),
    "--csv --plot",
    example="bearings i4 --rpm 6000 --load crankpin --axes crank --plot pin.png",
    note="Main bearings share the loads between them by the lever rule.",
)
def _bearings(call: Given) -> Shown:
    engine, note = fired(call, "bearings")
    kind = call.text("--picture")
    loads = bearing_loads(engine, call.number("--rpm", "rpm"))
    accepted = {"polar": ("load", "axes"), "curves": ("load",), "bending": ()}[kind]
    options = {name: call.text(f"--{name}") for name in accepted}
    return Shown(loads.frames, loads, {"kind": kind, **options}, note=note)


@command(
    "rod-load",
    "load of each piston rod at its crosshead pin: compression, tension and their reversal",
    "name --rpm --cycle --firing-order --bore --crankcase",
    *OF_A_FILE,
    option(
        "--cylinder",
        metavar="NUMBER",
        default="1",
        help="cylinder of the picture (default: %(default)s)",
    ),
    "--units --csv --plot",
    example="rod-load i4 --rpm 3000 --bore 86mm --plot rod.png",
    note="Outboard of the pin are piston, piston rod and crosshead: the piston_mass of a cylinder\n"
    "or all of its reciprocating mass. API 618 asks for a reversal, usually of "
    f"{USUAL_REVERSAL:g}° at least.",
)
def _rod_load(call: Given) -> Shown:
    engine, note = fired(call, "rod-load")
    loads = rod_loads(engine, call.number("--rpm", "rpm"))
    cylinder = call.whole("--cylinder")
    return Shown(only(loads.table), loads, {"cylinder": cylinder}, note=note)


def fired(call: Given, name: str) -> tuple[Engine, str]:
    """Return the engine, with gas pressure unless there is none, and a note of what was assumed."""
    engine: Engine = call.engine(name)
    typed: Any = call.text("--cycle")
    if (order := call.text("--firing-order")) is not None:
        engine = engine.replace(firing_order=order)
    kind, _, load = (typed or "").partition(":")
    named = typed is None or kind in EXAMPLES or typed == WITHOUT_GAS
    of_a_file = [option.label for option in OF_A_FILE if call.text(option.label)]
    if of_a_file and named:
        raise inputs.faulty(of_a_file[0], "needs a file of --cycle", "give its path")
    bore, crankcase = call.optional("--bore", "m"), call.optional("--crankcase", "Pa")
    if typed is None and engine.fired:
        cylinders = [
            cylinder if bore is None else cylinder.replace(bore=bore)
            for cylinder in engine.cylinders
        ]
        return engine.replace(cylinder=cylinders, crankcase=crankcase), ""
    if typed == WITHOUT_GAS:
        for flag, figure in (("--bore", bore), ("--crankcase", crankcase)):
            if figure is not None:
                hint = "needs gas pressure; give --cycle"
                raise rejected(flag, call.text(flag), hint)
        return engine.with_cycle(None), ""
    if not named and not Path(typed).suffix:
        hint = f"give {' or '.join(EXAMPLES)} for an example, {WITHOUT_GAS}, or a text file"
        raise rejected("--cycle", typed, hint)
    strokes = engine.strokes
    if named:
        part = call.one("--cycle", load, "", "a part of full load") if load else 1.0
        if not 0.0 <= part <= 1.0:
            raise rejected("--cycle", typed, "give a part of full load, 0 (idling) to 1")
        example: Any = kind or next(iter(EXAMPLES))
        cycle = Cycle.example(example, load=part, strokes=strokes)
    else:
        cycle = _loaded(Cycle.load, "--cycle", typed, _read_as(call, strokes))
    cylinders, note = _with_bores(engine, bore)
    try:
        driven = engine.replace(cylinder=cylinders).with_cycle(cycle, crankcase=crankcase)
    except InputError as error:
        if typed is not None or name != "bearings":  # which are of masses too
            raise
        return engine, f"It is not counted, since {error}\n"
    return driven, note if named else f"{note}Read: {cycle.origin}.\n"


def _with_bores(engine: Engine, bore: float | None) -> tuple[list[Cylinder], str]:
    """Return the cylinders with the bore typed, and a note where one had to be assumed."""
    if bore is not None:
        return [cylinder.replace(bore=bore) for cylinder in engine.cylinders], ""
    cylinders = [
        cylinder.replace(bore=cylinder.bore or cylinder.stroke) for cylinder in engine.cylinders
    ]
    has_bores = all(cylinder.bore for cylinder in engine.cylinders)
    return (
        cylinders,
        "" if has_bores else "Bores that are not known are taken to equal the stroke.\n",
    )


@command(
    "trace",
    "measured cycles of a file: their mean and spread, prepared as options say",
    "name",
    option(
        "file",
        metavar="FILE",
        help="cylinder pressure of one or many cycles: a text file, .xlsx, .mat or .h5",
    ),
    "--bore",
    *_of_files(
        "the files",
        read=lambda call, flag: call.one_or_several(flag, "°"),
        metavar="ANGLE,…",
        more="; of several cylinders in one file that of each, their columns of pressure in "
        "--columns",
    ),
    option("--motored", metavar="FILE", help="the same without combustion, which finds the TDC"),
    *keywords(
        prepare_trace,
        "loss_angle_deg lowpass_order intake_pressure leave_out spikes exponent compression_ratio",
    ),
    keyword(
        Traces.heat_spread,
        "gamma",
        more="; with it the heat release is printed, which needs --compression-ratio",
        default="",
    ),
    *OF_A_RECORD,
    "--units --csv --plot --save --force",
    example="trace i4 run7.csv --bore 86mm --intake-pressure 0.95bar --save run7.toml\n"
    f"  {PROG} trace i4 scope.csv --pressure CH1:20bar/V,-1bar --encoder CH2 --pulses 60-2 "
    "--index CH3",
    note="--save writes the engine with the mean of the prepared cycles. With --encoder the file\n"
    "is an oscillogram, --tdc the angle from the index to the firing top dead centre of\n"
    "cylinder 1, and that of each other cylinder follows from the firing order.",
)
def _trace(call: Given) -> Shown:
    engine = call.engine("trace")
    cylinders, note = _with_bores(engine, call.optional("--bore", "m"))
    read_as = _read_as(call, engine.strokes)
    centres = read_as.get("tdc_deg")
    if call.text("--encoder") is not None:
        return _recorded(call, engine, cylinders, note)
    for unused in OF_A_RECORD:
        if call.text(unused.label) is not None:
            raise rejected(unused.label, str(call.text(unused.label)), "needs --encoder; give it")
    several = isinstance(centres, list)
    if several and len(centres) != len(engine):
        hint = f"the engine has {len(engine)} cylinders; give one angle, or one for each"
        raise rejected("--tdc", call.text("--tdc"), hint)
    if several:
        read_as.setdefault("columns", None)

    def loaded(option: str, path: str) -> tuple[Traces, ...]:
        if several:
            return _loaded(Traces.load_cylinders, option, path, read_as)
        return (_loaded(Traces.load, option, path, read_as),)

    traces, motored = loaded("file", call.text("file")), call.text("--motored")
    without_fire = loaded("--motored", motored) if motored else [None] * len(traces)
    return _prepared(call, engine, cylinders, note, traces, without_fire)


def _recorded(call: Given, engine: Engine, cylinders: list[Cylinder], note: str) -> Shown:
    """Return the prepared cycles and the speed of an oscillogram."""
    others = ("--columns", "--recorded-rpm", "--angle-unit")
    for unused in (flag for flag in others if call.text(flag) is not None):
        hint = "an oscillogram has channels by role; leave it out"
        raise rejected(unused, call.text(unused), hint)
    for needed in ("--pressure", "--pulses"):
        if call.text(needed) is None:
            raise inputs.faulty("--encoder", f"needs {needed}", "give it too")
    options = {
        name: value
        for name, value in _read_as(call, engine.strokes).items()
        if name in inspect.signature(oscillogram).parameters
    } | call.keywords(oscillogram)
    channels, centres = options["pressure"], options.pop("tdc_deg", 0.0)
    if len(channels) > 1:
        if len(channels) != len(engine):
            hint = f"the engine has {len(engine)} cylinders; give one channel, or one for each"
            raise rejected("--pressure", " ".join(channels), hint)
        if not isinstance(centres, list):
            at = engine.firing().angles_deg
            centres = [centres + float(angle - at[0]) for angle in at]
    options |= {"pressure": channels, "tdc_deg": centres}

    def loaded(option: str, path: str) -> Oscillogram:
        return _loaded(oscillogram, option, path, options)

    record, motored = loaded("file", call.text("file")), call.text("--motored")
    without_fire = loaded("--motored", motored).traces if motored else [None] * len(channels)
    shown = _prepared(call, engine, cylinders, note, record.traces, without_fire)
    note = f"{note}Read: {record.traces[0].origin}.\n"
    frames: dict[str, Callable[[], Table]] = {
        name: partial(shown.frames.__getitem__, name) for name in shown.frames
    }
    frames["speed"] = lambda: record.table
    return shown._replace(frames=Frames(frames), note=note)


def _prepared(
    call: Given,
    engine: Engine,
    cylinders: list[Cylinder],
    note: str,
    traces: Sequence[Traces],
    without_fire: Sequence[Traces | None],
) -> Shown:
    """Return cycles prepared as options say, and the engine with their means."""
    options = call.keywords(prepare_trace)
    heat = call.keywords(Traces.heat_spread)
    if heat:
        if "compression_ratio" not in options:
            raise rejected("--gamma", call.text("--gamma"), "needs --compression-ratio; give it")
        heat["compression_ratio"] = options["compression_ratio"]
        if "exponent" not in options:
            del options["compression_ratio"]
    prepared = [
        prepare_trace(recorded, cylinder, motored=by_motoring, **options)
        for recorded, cylinder, by_motoring in zip(traces, cylinders, without_fire, strict=False)
    ]
    cycles = [trace.cycle for trace in prepared]
    several = len(cycles) > 1
    with_mean = engine.replace(cylinder=cylinders).with_cycle(cycles if several else cycles[0])
    whole = OfCylinders(tuple(prepared)) if several else prepared[0]
    note += f"Read: {'; '.join(dict.fromkeys(trace.origin for trace in traces))}.\n"
    frames = whole.frames
    if heat:
        released = [each.traces.heat_spread(each.cylinder, **heat) for each in prepared]
        table = stacked(released, f"{released[0].title}") if several else released[0]
        frames = Frames(
            {name: partial(whole.frames.__getitem__, name) for name in frames}
            | {"heat": lambda: table}
        )
    return Shown(frames, whole, engine=with_mean, note=note)


def stacked(tables: Sequence[Table], title: str) -> Table:
    """Return the rows of tables of cylinders below each other."""
    numbers = tuple(k for k, table in enumerate(tables, 1) for _ in table.columns[0].values)
    columns = [
        changed(same[0], data=tuple(value for column in same for value in column.values))
        for same in zip(*(table.columns for table in tables), strict=True)
    ]
    return changed(
        tables[0],
        title=title,
        columns=(Column("cylinder", numbers), *columns),
        row_units=tuple(unit for table in tables for unit in table.row_units),
    )


class OfCylinders(NamedTuple):
    """Prepared traces of the cylinders of an engine."""

    prepared: tuple[PreparedTrace, ...]

    @property
    def frames(self) -> Frames:
        """The frames of all cylinders, a row of each below those of the one before."""
        first = self.prepared[0].traces.name.partition(",")[0]
        name = f"{labels.one_line(first)}, {len(self.prepared)} cylinders"
        titles = {
            "table": f"Prepared traces of {name}: change by step",
            "orders": "Peak, noise, spread and amplitudes of torque",
            "spread": f"{name}, spread",
        }
        stacked = self._stacked
        return Frames({frame: partial(stacked, frame, title) for frame, title in titles.items()})

    def _stacked(self, frame: str, title: str) -> Table:
        return stacked([prepared.frames[frame] for prepared in self.prepared], title)

    def plot(self) -> Axes:
        """Draw the mean of each cylinder in the band of its cycles."""
        first, *others = self.prepared
        ax: Axes = first.traces.plot(label="cylinder 1")
        for k, prepared in enumerate(others, 2):
            prepared.traces.plot(ax, label=f"cylinder {k}")
        return ax


Read = TypeVar("Read", Cycle, Traces, tuple[Traces, ...], Oscillogram)


def _loaded(load: Callable[..., Read], option: str, path: str, read_as: Mapping[str, Any]) -> Read:
    """Return the content of a file, read by options; of several files errors name theirs."""
    try:
        return load(path, **read_as)
    except InputError as error:
        if error.argument not in ("path", "source") or error.hint is None:
            raise
        fault, hint = inputs.fault_of(error), hint_of(error)
        if fault.startswith("= "):
            raise rejected(option, path, hint) from None
        raise inputs.faulty(repr(labels.cut(Path(path).name)), fault, hint) from None


def _read_as(call: Given, strokes: int) -> Any:  # noqa: ANN401 - FileOptions, of one or several
    """Return how a file of cylinder pressure is read."""
    if call.text("--gauge") and call.text("--absolute"):
        raise inputs.faulty("--gauge", "cannot be combined with --absolute", "give one of them")
    return {"strokes": strokes, **call.keywords(load)}
