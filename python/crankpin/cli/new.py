"""The command that makes an engine file: a layout by its usual name, and weighed parts."""

from __future__ import annotations

import inspect
import itertools
import math
import shlex
import textwrap
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

from crankpin._core import InputError
from crankpin._support import inputs, units
from crankpin._support.messages import suppressed
from crankpin.analysis.mounts.powertrain import Powertrain
from crankpin.cli.options import PROG, command, keyword, keywords, option, rejected
from crankpin.model import engine_files, presets, table_files
from crankpin.model.cycle import Cycle
from crankpin.model.cylinder import Cylinder, Rod
from crankpin.model.data import allowed
from crankpin.model.engine import Engine
from crankpin.model.links import LinkRods
from crankpin.model.mounts import InertiaTrack, Mount, RigidBody

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterable, Mapping

    from crankpin.cli.arguments import Given
    from crankpin.cli.options import Option

BUILDERS = {
    "inline": "inline",
    "vee": "vee",
    "flat": "flat",
    "boxer": "boxer",
    "radial": "radial",
    "firing-order": "from_firing_order",
    "lists": "from_lists",
    "banks": "from_banks",
    "w": "from_banks",
    "x": "from_banks",
    "opposed-pistons": "opposed_pistons",
    "u": "u",
    "square-four": "square_four",
    "h": "h",
    "compressor": "opposed_throws",
}
"""Kind → the builder of :class:`Engine` that takes all of its layout from options."""

SHAPE = "layout (default: that of the preset)"


def _of_shape(
    function: Callable[..., Any],
    argument: str,
    flag: str = "",
    **settings: Any,  # noqa: ANN401 - of options
) -> Option:
    """Return the option of a builder's argument, which names the builders if these are few."""
    takes = {
        name: kind
        for kind, name in reversed(BUILDERS.items())
        if argument in inspect.signature(getattr(Engine, name)).parameters
    }
    one = keyword(function, argument, flag, group=SHAPE, default="", **settings)
    if len(takes) < 3:
        one.settings["help"] = (
            f"of {' and '.join(reversed(takes.values()))}: {one.settings['help']}"
        )
    return one


def _pin_split(call: Given, flag: str) -> str:
    """Return a pin split as text, or even."""
    return "even" if call.text(flag) == "even" else call.angle(flag)


def _cranks(call: Given, flag: str) -> list[tuple[float, float, int]]:
    """Return further crankshafts: the axis of each, m, and its ratio."""
    return [_crank(call, flag, place.split(":")) for place in call.text(flag).split(",")]


def _crank(call: Given, flag: str, parts: list[str]) -> tuple[float, float, int]:
    if len(parts) != 3 or not parts[2].strip().lstrip("+-").isdecimal():
        raise rejected(flag, call.text(flag), "give X:Y:RATIO, such as 0.2:0:-1")
    x, y = (call.one(flag, coordinate, "m") for coordinate in parts[:2])
    return x, y, int(parts[2])


def _rods(call: Given, flag: str) -> LinkRods:
    """Return link rods: radius and length, mass at the knuckle, and angles of the knuckles."""
    parts = call.text(flag).split(":")
    if not 2 <= len(parts) <= 4:
        raise rejected(flag, call.text(flag), f"give {RODS}, such as 52mm:178mm:400g")
    radius, length = (call.one(flag, part, "m") if part else None for part in parts[:2])
    mass = call.one(flag, parts[2], "kg") if len(parts) > 2 and parts[2] else None
    last = parts[3] if len(parts) > 3 else ""
    equal = last.removeprefix("equal-") if last.startswith("equal-") else None
    angles = last.split(",") if last and equal is None else "bores"
    try:
        return LinkRods(radius, length, angles, mass, equal)  # type: ignore[arg-type]
    except InputError as error:
        raise rejected(flag, call.text(flag), str(error)) from None


def _masters(call: Given, flag: str) -> str | list[int]:
    """Return the bank of the master rods, or numbers of their cylinders."""
    text = call.text(flag)
    numbers = [part.strip() for part in text.split(",")]
    return [int(number) for number in numbers] if all(map(str.isdecimal, numbers)) else text


RODS = "[RADIUS]:LENGTH[:MASS[:ANGLE,…|equal-stroke|equal-compression]]"

LAYOUT = {
    shape.label: shape
    for shape in (
        _of_shape(Engine.vee, "bank_angle_deg"),
        _of_shape(Engine.vee, "throws_deg"),
        _of_shape(Engine.vee, "pin_split_deg", read=_pin_split, more=", or type even"),
        _of_shape(
            Engine.vee,
            "spacing",
            read=lambda call, flag: call.range(flag, "m"),
            metavar="LENGTH,…",
            more=" (default: in proportion to the bore)",
        ),
        *(_of_shape(Engine.vee, name) for name in ("bank_stagger", "odd_bank", "numbering")),
        _of_shape(Engine.vee, "absent"),
        _of_shape(Engine.vee, "rods", "--link-rods", read=_rods, metavar=RODS),
        _of_shape(Engine.vee, "master", read=_masters, metavar="BANK|NUMBER,…"),
        _of_shape(Engine.radial, "cylinders"),
        _of_shape(Engine.radial, "rows"),
        _of_shape(Engine.vee, "firing_order"),
        _of_shape(Engine.from_firing_order, "intervals_deg"),
        _of_shape(Engine.vee, "strokes"),
        _of_shape(Engine.from_lists, "tdc_deg"),
        _of_shape(Engine.from_lists, "pin_deg", "--pins"),
        _of_shape(Engine.from_lists, "bank_deg", "--banks"),
        _of_shape(Engine.from_lists, "crank"),
        _of_shape(Engine.from_lists, "cranks", read=_cranks, metavar="X:Y:RATIO,…"),
        _of_shape(Engine.from_lists, "z"),
        _of_shape(Engine.u, "distance"),
        _of_shape(Engine.u, "ratio"),
        _of_shape(Engine.u, "phase_deg"),
        _of_shape(Engine.opposed_pistons, "lead_deg"),
        _of_shape(Engine.opposed_throws, "crosshead_mass"),
    )
}
"""Option → the argument of a builder that it gives."""

SWITCHES = {
    "--shared-pins": (
        _of_shape(Engine.from_firing_order, "shared_pins"),
        "pins follow from a firing order in new firing-order alone; leave it out",
    ),
    "--one-crankshaft": (
        _of_shape(Engine.opposed_pistons, "one_crankshaft"),
        "side rods drive the upper ones of opposed pistons alone; leave it out",
    ),
}
"""Option without a value → the argument of a builder that it makes true, and a hint for others."""

LENGTHS = {
    "--bore": "diameter of the bore",
    "--stroke": "stroke",
    "--rod-length": "rod length between the centres, or inf of a Scotch yoke",
    "--pin-offset": "offset of the piston pin's path from the crank axis (default: 0)",
    "--rod-centre": "from the big end's centre to the rod's centre of mass (default: a third of "
    "the rod, so that one third of its mass moves with the piston)",
}
MASSES = {
    "--piston-mass": "piston, pin, rings and clips",
    "--rod-mass": "rod with bolts and bearing shells",
    "--small-end": "small end of a rod weighed end by end, for --rod-mass",
    "--big-end": "its big end",
    "--reciprocating-mass": "all that moves with the piston, the rod's share included",
    "--rotating-mass": "all that turns with the crankpin, of one cylinder (default: rod's share)",
}
"""Options of one cylinder's parts → their help; a list has a figure for each cylinder."""


COUNTING = ("--throws", "--cylinders", "--firing-order", "--banks", "--tdc", "--pins", "--rows")
"""Options that set the number of cylinders."""


def _refused(typed: argparse.Namespace) -> set[str]:
    """Return the options that a layout rejects, and those without effect on it."""
    if typed.kind is None:
        return set()
    base = _layout(typed.kind)
    refused = {*LAYOUT} - {*_flags(base)}
    refused |= {flag for flag, (one, _) in SWITCHES.items() if one.argument not in _names(base)}
    if base.builder == "from_firing_order":
        refused.add("--dummy")
    if typed.kind not in BUILDERS and len(base.arguments.get("throws_deg", ())) == 1:
        refused.add("--spacing")  # of one throw
    # Of four-strokes, and of chambers between unlike pistons.
    if {"rule", "one_crankshaft"} & base.arguments.keys():
        refused |= {option.label for option in COMPRESSOR_OPTIONS}
    return refused


def _parameters(base: presets.Layout) -> Mapping[str, inspect.Parameter]:
    """Return the parameters of the builder of a layout by name."""
    return inspect.signature(getattr(Engine, base.builder)).parameters


def _flags(base: presets.Layout) -> dict[str, str]:
    """Return the options of a layout that it takes, with the argument of its builder."""
    taken = _names(base)
    return {flag: option.argument for flag, option in LAYOUT.items() if option.argument in taken}


def _names(base: presets.Layout) -> set[str]:
    """Return the arguments that the builder of a layout takes."""
    names = {*_parameters(base)}
    if base.cycle:  # of a compressor, with one in each turn
        names -= {"strokes"}
    if "places" in base.arguments:  # of a preset of lists, whose angles go together
        names = {"spacing", "firing_order", "strokes"}
    if "rule" in base.arguments:  # by which the intervals follow from the order
        names -= {"intervals_deg", "shared_pins"}
    if "rods" in base.arguments:  # of pins that cylinders share in one plane
        names -= {"pin_split_deg", "bank_stagger", "absent", "rows"}
    elif base.arguments.get("pin_split_deg"):
        names -= {"rods", "master"}
    return names


def _wrapped(names: Iterable[str]) -> str:
    return textwrap.fill(", ".join(names), 88, initial_indent="  ", subsequent_indent="  ")


PARTS_HELP = "parts of one cylinder, or A,B,… of each (default: a nominal half litre)"
ON_MOUNTS = "body and mounts, for crankpin mounts"
MOUNT_FIELDS = {
    "tilt": ("tilt_deg", 1, "°"),
    "axes": ("axes", 9, ""),
    "dynamic": ("dynamic_stiffness", 3, ""),
    "damping": ("damping", 3, ""),
    "rotation": ("rotational_stiffness", 3, ""),
    "rotation-loss": ("rotational_loss_factor", 3, ""),
    "rotation-damping": ("rotational_damping", 3, ""),
    "track": ("track", 3, ""),
    "table": ("table", 0, ""),
    "gap": ("gap", 6, "m"),
    "snubber": ("snubber_stiffness", 6, ""),
}
"""Field of ``--mount`` → argument of :class:`Mount`, its count of numbers, and its unit."""
COMPRESSING = "cycle of a compressor, with ideal valves"
COMPRESSOR = Cycle.compressor
COMPRESSOR_OPTIONS = (
    *keywords(COMPRESSOR, "suction discharge clearance", group=COMPRESSING),
    keyword(COMPRESSOR, "n", "--exponent", group=COMPRESSING),
    option(
        "--rod-diameter",
        group=COMPRESSING,
        metavar="LENGTH",
        help="diameter of the piston rods, which makes the cylinders double acting",
    ),
    option(
        "--double-acting",
        group=COMPRESSING,
        action="store_true",
        help="the cycle acts at the crank ends too",
    ),
)
"""The function of these options; a method is another object each time."""


@command(
    "new",
    "make an engine file: a layout by its usual name, and weighed parts",
    option("kind", metavar="KIND", help="such as v-twin, v6, boxer-4, radial, inline"),
    *(
        option(
            flag,
            group=PARTS_HELP,
            argument="to_crankpin" if flag == "--rod-centre" else "",
            metavar="LENGTH,…",
            help=what,
        )
        for flag, what in LENGTHS.items()
    ),
    *(option(flag, group=PARTS_HELP, metavar="MASS,…", help=what) for flag, what in MASSES.items()),
    option(
        "--dummy",
        group=PARTS_HELP,
        metavar="N,…",
        help="dummy pistons, which balance and do not fire",
    ),
    *LAYOUT.values(),
    *(one for one, _ in SWITCHES.values()),
    *COMPRESSOR_OPTIONS,
    option(
        "--body",
        group=ON_MOUNTS,
        metavar="MASS:X,Y,Z:IX,IY,IZ[,IXY,IXZ,IYZ:PRODUCTS]",
        help="all that moves: mass, centre of gravity, m, moments of inertia about it, kg·m²; with "
        "products tensor or positive-integrals says which sign they have",
    ),
    option(
        "--mount",
        group=ON_MOUNTS,
        metavar="NAME:X,Y,Z:K[:LOSS][:FIELD=VALUE…]",
        action="append",
        help="place, m, stiffness, N/m, or K,K,K along its axes, and loss factor; once for each. "
        f"Fields, one number or one for each axis: {', '.join(MOUNT_FIELDS)}",
    ),
    option("--axes", group=ON_MOUNTS),
    option("--name", help="name of the engine (default: that of its kind)"),
    "--add-load --units",
    option(
        "-o",
        "--out",
        argument="path",
        metavar="FILE",
        help="the engine file (.toml, .json); without it, print TOML",
    ),
    "--force",
    example="new v-twin --bank-angle 45 --bore 88.9mm --stroke 96.8mm --rod-length 189mm "
    "--piston-mass 480g --rod-mass 560g -o harley.toml",
    note="KIND is one of\n"
    f"{_wrapped(presets.aliases())}\n"
    f'or any preset ("{PROG} presets" lists them), whose layout is taken with other figures;\n'
    "or a builder, which takes its layout from options:\n"
    f"{_wrapped(BUILDERS)}\n"
    "Lengths and masses take units: 86mm, 3.4in, 480g, 17oz, 1.2lb.\n"
    f'"{PROG} new KIND --help" lists what that layout takes.',
    refused=_refused,
)
def _new(call: Given) -> str:
    """Write the file; return what the command prints."""
    file = call.engine_file("--out")
    notes = list[str]()
    cylinder, rotating = _parts(call, notes)
    engine = _compressing(call, call.with_loads(_engine(call, cylinder, rotating, notes)))
    powertrain = _on_mounts(call, engine)
    if file is None:
        whole = engine.to_toml() if powertrain is None else powertrain._text(toml=True)
        return engine_files.commented(whole)
    (powertrain or engine).save(file)
    # An echo: in the units of --units, or else as typed.
    with units.Shown(call.written | units.current()):
        remarks = "".join(f"{units.shown(note)}\n" for note in notes)
        summary = repr(engine)
    command = "balance" if powertrain is None else "mounts"
    return f"{summary}\n{remarks}Written to {file}: try {PROG} {command} {shlex.quote(str(file))}\n"


def _compressing(call: Given, engine: Engine) -> Engine:
    """Return an engine with the cycle of a compressor, if one is given, at one end or at both."""
    figures = call.keywords(COMPRESSOR)
    rod: Any = call.optional("--rod-diameter", "m")
    double = rod is not None or bool(call.text("--double-acting"))
    if "discharge" not in figures:
        if figures or double:
            raise inputs.faulty("--discharge", "is left out", "the cycle of a compressor needs it")
        return engine
    if any(one.side_rods for one in engine.cylinders):
        hint = "cycles of compressors are of one piston's motion; leave it out with one crankshaft"
        raise rejected("--discharge", call.text("--discharge"), hint)
    if engine.crank_ends is not None:  # of a preset
        double, rod = True, engine.rod_diameter if rod is None else rod
    ends: list[Literal["head", "crank"]] = ["head", "crank"] if double else ["head"]
    cycles = {
        one: [COMPRESSOR(one, end=end, **figures) for end in ends]
        for one in dict.fromkeys(engine.cylinders)
    }
    head, *crank = ([cycles[one][k] for one in engine.cylinders] for k in range(len(ends)))
    return engine.with_cycle(head, crank_end=crank[0] if crank else None, rod_diameter=rod)


def _on_mounts(call: Given, engine: Engine) -> Powertrain | None:
    """Return the engine on the body and mounts of options, if they are given."""
    body, mounts = call.text("--body"), call.text("--mount") or []
    if body is None and not mounts:
        if (typed := call.text("--axes")) is not None:
            raise rejected("--axes", typed, "is of --body and --mount: give them")
        return None
    if body is None or not mounts:
        flag, other = ("--mount", "--body") if body is not None else ("--body", "--mount")
        raise inputs.faulty(flag, "is left out", f"a body on mounts needs it, beside {other}")
    return Powertrain(
        engine, _body(call, body), [_mount(call, text) for text in mounts], vehicle=call.vehicle()
    )


def _body(call: Given, text: str) -> RigidBody:
    """Return the body of ``--body``."""
    form = "MASS:X,Y,Z:IX,IY,IZ or MASS:X,Y,Z:IX,IY,IZ,IXY,IXZ,IYZ:tensor"
    mass, cg, inertia, *products = _fields(call, "--body", text, form, 3, 4)
    entries = call.listed("--body", inertia)
    if len(entries) not in (3, 6) or (len(entries) == 3 and products):
        raise rejected("--body", text, f"give {form}")
    moments: Any = entries
    if len(entries) == 6:
        xx, yy, zz, xy, xz, yz = entries
        moments = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    signs: Any = products[0].strip() if products else None
    return RigidBody(call.one("--body", mass, "kg"), call.listed("--body", cg, "m"), moments, signs)


def _mount(call: Given, text: str) -> Mount:
    """Return a mount of ``--mount``: name, place, stiffness, loss factor, and fields by name."""
    flag, form = "--mount", "NAME:X,Y,Z:K or NAME:X,Y,Z:K:LOSS, and behind these FIELD=VALUE"
    parts = text.split(":")
    first = next((k for k, part in enumerate(parts) if "=" in part and k > 2), len(parts))
    name, place, stiffness, *loss = _fields(call, flag, ":".join(parts[:first]), form, 3, 4)
    figures: dict[str, Any] = {}
    if loss:
        figures["loss_factor"] = _one_or_three(call, flag, loss[0])
    for part in parts[first:]:
        key, _, value = part.partition("=")
        if key.strip() not in MOUNT_FIELDS:
            raise rejected(flag, text, f"give fields of {', '.join(MOUNT_FIELDS)}")
        argument, count, unit = MOUNT_FIELDS[key.strip()]
        if argument == "table":
            figures[argument] = _stiffness_table(value)
            continue
        numbers = call.listed(flag, value, unit)
        if len(numbers) not in ({count} if argument in ("axes", "track") else {1, 3, count}):
            raise rejected(flag, text, f"give {count} numbers of {key}")
        figures[argument] = numbers if len(numbers) > 1 else numbers[0]
        if len(numbers) == 6:  # against and along each axis
            figures[argument] = [tuple(numbers[k : k + 2]) for k in (0, 2, 4)]
        if argument == "axes":
            figures[argument] = [numbers[k : k + 3] for k in (0, 3, 6)]
        elif argument == "track":
            figures[argument] = InertiaTrack(*numbers)
    at = call.listed(flag, place, "m")
    return Mount(name.strip(), at, _one_or_three(call, flag, stiffness), **figures)


def _one_or_three(call: Given, flag: str, text: str) -> Any:  # noqa: ANN401 - as Mount takes it
    numbers = call.listed(flag, text)
    return numbers if len(numbers) > 1 else numbers[0]


def _stiffness_table(name: str) -> Any:  # noqa: ANN401 - as Mount takes it
    """Return frequencies and complex stiffness along the axes, of a file's columns."""
    file = inputs.file_path(name, table_files.TABLE_ENDINGS, table_files.FILE_HINT, "--mount")
    numbers = table_files.read(file, None).numbers
    if numbers.shape[1] not in (3, 7):
        hint = "give frequency, Hz, and real and imaginary part, N/m, of all axes or of each"
        raise inputs.faulty("--mount", f"has {numbers.shape[1]} columns in {name}", hint)
    parts = numbers[:, 1:]
    stiffness = parts[:, ::2] + 1j * parts[:, 1::2]
    return numbers[:, 0], stiffness.repeat(3 // stiffness.shape[1], axis=1)


def _fields(call: Given, flag: str, text: str, form: str, *counts: int) -> list[str]:
    """Return the parts of an option between colons."""
    fields = text.split(":")
    if len(fields) not in counts:
        raise rejected(flag, text, f"give {form}")
    return fields


def _engine(
    call: Given,
    cylinder: Cylinder | list[Cylinder] | None,
    rotating: float | list[float] | None,
    notes: list[str],
) -> Engine:
    """Return the engine of a kind with these parts and what options change in its layout."""
    kind = call.text("kind")
    base = _layout(kind)
    changes = _changes(call, kind, base)
    if rotating is not None:
        changes["rotating_mass"] = rotating
    if base.builder == "opposed_pistons":
        cylinder = _lower(cylinder or base.cylinder, base.arguments | changes, changes)
    if "pin_split_deg" in changes or "bank_angle_deg" in changes:
        changes |= _split(base, changes)
    dummies = _dummies(call, base)
    spacing = changes.pop("spacing", None)
    if assumed := spacing is None:
        first = cylinder[0] if isinstance(cylinder, list) else cylinder
        bores = None if first is None else first.bore, base.cylinder.bore
        ratio = bores[0] / bores[1] if bores[0] and bores[1] else 1.0
        spacing = float(f"{base.spacing * ratio:.3g}")
    order = base.arguments.get("firing_order", "")
    required = base.builder == "from_firing_order"
    has_order = bool(order) and "firing_order" not in changes and not required
    named = changes.pop("firing_order", None) if dummies else None
    changes["source"] = shlex.join([PROG, *call.typed])
    if (name := call.text("--name")) is not None or {"throws_deg", "strokes"} & changes.keys():
        changes["name"] = name or ""
    changes |= {"firing_order": ""} if has_order else {}
    engine = base.build(cylinder or base.cylinder, spacing, **changes)
    if assumed:
        with suppressed():  # Warned of above.
            wider = base.build(cylinder or base.cylinder, 2.0 * spacing, **changes)
        if (wider.z != engine.z).any():
            notes.append(
                units.Text(
                    "Spacing ",
                    units.figure(spacing * 1e3, "mm", 6),
                    ", in proportion to the bore (--spacing).",
                )
            )
    if dummies:
        engine = _with_dummies(call, engine, dummies, named)
    _check_count(call, kind, base, engine)
    # An order names the chambers of a layout, of which dummies have none.
    ordered = len(engine.chambers) + sum(one.dummy for one in engine.cylinders)
    if has_order and ordered == order.replace("+", "-").count("-") + 1:
        engine = engine.replace(firing_order=allowed(engine._core, order, engine.strokes))
    if not engine.firing_order:
        notes.append(f'No firing order is known: "{PROG} firing" lists those of the crank.')
    return engine


def _lower(
    cylinder: Cylinder | list[Cylinder], arguments: dict[str, Any], changes: dict[str, Any]
) -> Cylinder | list[Cylinder]:
    """Return the parts of the lower pistons, and give those of the upper ones to the builder."""
    count = len(arguments["throws_deg"])
    upper = cylinder
    if isinstance(cylinder, list) and len(cylinder) == 2 * count:
        cylinder, upper = cylinder[:count], cylinder[count:]
        changes["upper"] = upper
    if "distance" in changes and "one_crankshaft" not in changes:
        changes["one_crankshaft"] = False  # of a preset, to which a second crank is typed
    elif arguments.get("one_crankshaft"):
        # Instead of a preset's second crank, unless one is typed.
        changes.setdefault("distance", None)
        changes.setdefault("ratio", 1)
        if "upper" not in arguments:
            changes["upper"] = upper
    return cylinder


def _check_count(call: Given, kind: str, base: presets.Layout, engine: Engine) -> None:
    """Reject an option that makes another number of cylinders than the name of the layout says."""
    if kind in BUILDERS or call.text("--absent") is not None:
        return
    whole = base.build(base.cylinder, base.spacing)
    if len(engine) == len(whole):
        return
    flag = next((option for option in COUNTING if call.text(option) is not None), "--throws")
    hint = f"{kind} has {len(whole)} cylinders, this makes {len(engine)}"
    if base.builder in ("vee", "flat", "boxer", "inline"):
        throws = len(base.arguments["throws_deg"])
        plain = base.builder if base.builder != "vee" else "vee --bank-angle A"
        hint += f"; give {throws} crankpin{'s' * (throws > 1)}, or build it by {PROG} new {plain}"
    raise rejected(flag, call.text(flag), hint)


def _dummies(call: Given, base: presets.Layout) -> list[int]:
    """Return the numbers of dummy pistons."""
    if call.text("--dummy") is None:
        return []
    if base.builder == "from_firing_order":
        hint = "crankpins follow from cylinders that fire; give a layout by its --throws"
        raise rejected("--dummy", call.text("--dummy"), hint)
    return call.whole_numbers("--dummy", "give numbers of cylinders, such as 2")


def _with_dummies(
    call: Given, engine: Engine, dummies: list[int], firing_order: str | None
) -> Engine:
    """Return an engine some of whose pistons are dummies, in the firing order of the others."""
    for number in dummies:
        if not 1 <= number <= len(engine):
            hint = f"the engine has cylinders 1 to {len(engine)}"
            raise rejected("--dummy", call.text("--dummy"), hint)
    numbered = enumerate(engine.cylinders, start=1)
    return engine.replace(
        cylinder=[one.replace(dummy=number in dummies) for number, one in numbered],
        firing_order=firing_order,
    )


def _layout(kind: str) -> presets.Layout:
    """Return the layout of a kind, with nothing but nominal parts if options have it all."""
    if kind in BUILDERS:
        fan = {"bank_deg": kind.upper()} if kind in ("w", "x") else {}
        return presets.layout()._replace(builder=BUILDERS[kind], arguments=fan)
    name = presets.named(kind)
    if name not in presets.Presets():
        if meant := inputs.nearest(kind.lower(), [*presets.aliases(), *BUILDERS]):
            raise rejected("KIND", kind, f"no such layout{meant}")
        builders = f"builders are {', '.join(BUILDERS)}"
        raise presets.unknown("KIND", kind, typed=True, further=builders)
    return presets.layout(name)


def _changes(call: Given, kind: str, base: presets.Layout) -> dict[str, Any]:
    """Return the arguments of the builder that options give."""
    takes, flags = _parameters(base), _flags(base)
    changes = dict[str, Any]()
    for flag, figure in LAYOUT.items():
        if call.text(flag) is None:
            continue
        if flag not in flags:
            hint = f"does not apply to {kind}, which takes {', '.join(flags)}"
            raise rejected(flag, call.text(flag), hint)
        changes[figure.argument] = call.value(figure)
    for flag, (one, hint) in SWITCHES.items():
        if call.text(flag):
            if one.argument not in _names(base):
                raise inputs.faulty(flag, f"does not apply to {kind}", hint)
            changes[one.argument] = True
    needed = [
        flag
        for flag, name in flags.items()
        if name != "spacing"
        and takes[name].default is inspect.Parameter.empty
        and name not in base.arguments | changes
    ]
    if "tdc_deg" in takes and not {"tdc_deg", "pin_deg", "places"} & {*base.arguments, *changes}:
        needed.append("--tdc or --pins")
    if needed:
        hint = f"new {kind} needs {', '.join(needed)}; see {PROG} new --help"
        raise rejected("KIND", kind, hint)
    return changes


def _split(base: presets.Layout, changes: dict[str, Any]) -> dict[str, str]:
    """Return the pin split of a vee that is to fire evenly, or keeps doing so."""
    arguments = base.arguments | changes
    split = changes.get("pin_split_deg")
    if split not in (None, "even") or (split is None and "pin_split_deg" not in base.arguments):
        return {}
    count = 2 * len(arguments["throws_deg"])
    interval = Fraction(180 * int(arguments.get("strokes", 4)), count)
    if split is None:  # of a preset: as far from even firing as it was
        old = Fraction(base.arguments["bank_angle_deg"])
        interval = old - Fraction(base.arguments["pin_split_deg"])
    even = Fraction(arguments.get("bank_angle_deg", 180)) - interval
    return {"pin_split_deg": str(even)}


def _parts(
    call: Given, notes: list[str]
) -> tuple[Cylinder | list[Cylinder] | None, float | list[float] | None]:
    """Return what options say of each cylinder, or of all: parts, and what rotates with the pin.

    None stands for nominal parts.
    """
    lengths = {flag: call.numbers(flag, "m", infinite=flag == "--rod-length") for flag in LENGTHS}
    masses = {flag: call.numbers(flag, "kg") for flag in MASSES}
    typed = {flag: text for flag, text in (lengths | masses).items() if text is not None}
    count = max((len(values) for values in typed.values()), default=1)
    for flag, values in typed.items():
        if len(values) not in (1, count):
            raise rejected(flag, call.text(flag), f"give one, or {count}, one for each cylinder")

    def of(which: dict[str, list[float] | None], k: int) -> dict[str, float | None]:
        return {
            flag: None if values is None else values[k % len(values)]
            for flag, values in which.items()
        }

    remarks: list[list[str]] = [[] for _ in range(count)]
    pairs = [_parts_of_one(call, of(lengths, k), of(masses, k), remarks[k]) for k in range(count)]
    notes += dict.fromkeys(itertools.chain.from_iterable(remarks))
    cylinders, turning = zip(*pairs, strict=True)
    rotating = None if None in turning else list(turning)
    if count == 1 or None in cylinders:
        return cylinders[0], rotating if count > 1 else turning[0]
    return list(cylinders), rotating


def _parts_of_one(
    call: Given, lengths: dict[str, float | None], masses: dict[str, float | None], notes: list[str]
) -> tuple[Cylinder | None, float | None]:
    """Return the cylinder of the options and what rotates with its pin; None for nominal ones."""
    rotating = masses.pop("--rotating-mass")
    if all(value is None for value in (*lengths.values(), *masses.values())):
        notes.append(
            "Moving parts are nominal: give --bore, --stroke, --rod-length, --piston-mass and "
            "--rod-mass."
        )
        return None, rotating
    whole = [flag for flag in ("--stroke", "--rod-length") if lengths[flag] is None]
    if whole:
        hint = f"a cylinder of your own needs {' and '.join(whole)}"
        raise inputs.faulty(whole[0], "is left out", hint)
    stroke, length = lengths["--stroke"] or 0.0, lengths["--rod-length"] or 0.0
    common: dict[str, Any] = {"bore": lengths["--bore"]}
    common["pin_offset"] = lengths["--pin-offset"] or 0.0
    if (moving := masses.pop("--reciprocating-mass")) is not None:
        if other := [flag for flag, mass in masses.items() if mass is not None]:
            hint = "cannot be combined with --reciprocating-mass, which includes it"
            raise rejected(other[0], call.text(other[0]), hint)
        return Cylinder(stroke / 2.0, length, moving, **common), rotating
    if length == math.inf:
        hint = (
            "give --reciprocating-mass, with the yoke in it; an infinite rod has no ends to weigh"
        )
        raise rejected("--rod-length", call.text("--rod-length"), hint)
    rod = _rod(length, lengths["--rod-centre"], masses, notes)
    if masses["--piston-mass"] is None:
        hint = "a cylinder of your own needs --piston-mass, or --reciprocating-mass"
        raise inputs.faulty("--piston-mass", "is left out", hint)
    cylinder = Cylinder.from_rod(rod, stroke / 2.0, masses["--piston-mass"], **common)
    # As weighed: that of the rod has the rounding of its centre.
    return cylinder, masses["--big-end"] if rotating is None else rotating


def _rod(
    length: float, centre: float | None, masses: dict[str, float | None], notes: list[str]
) -> Rod:
    """Return a rod of known mass and length, its inertia estimated."""
    mass, small, big = (masses[flag] for flag in ("--rod-mass", "--small-end", "--big-end"))
    ends = small is not None and big is not None
    if ends == (mass is not None) or (small is None) != (big is None):
        hint = "--small-end and --big-end, or else give --reciprocating-mass and --rotating-mass"
        hint = f"a rod needs --rod-mass, or both {hint}; firing needs neither lengths nor masses"
        if mass is None:
            raise inputs.faulty("--rod-mass", "is left out", hint)
        raise inputs.rejected("--rod-mass", mass, hint)
    if small is not None and big is not None:
        # To the nanogram, which leaves 0.2 + 0.555 its decimals.
        mass = round(small + big, 12)
        centre = length * small / mass
    elif centre is None:
        centre = length / 3.0
        notes.append(
            "Of the rod one third moves with the piston and two thirds turn with the crankpin "
            "(--rod-centre)."
        )
    return Rod.estimated(mass or 0.0, length, centre)
