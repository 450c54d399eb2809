"""Build the workbench: one page that needs a browser alone, from file:// and from any server.

``python site/build.py`` writes ``target/site/index.html`` of the modules in this folder, those of
the turning page, the presets and units of the installed ``crankpin``, and the core as WebAssembly.
"""

from __future__ import annotations

import argparse
import json
import lzma
from decimal import Decimal
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any

import crankpin as cp
from crankpin._support import parameters, units
from crankpin.analysis import explain
from crankpin.model import presets
from crankpin.view import page

if TYPE_CHECKING:
    from collections.abc import Iterable

HERE = Path(__file__).parent
TARGET = HERE.parent / "target"
WASM = TARGET / "web" / "crankpin.wasm"
"""The core, of ``rust/web``."""
PAGE = TARGET / "site" / "index.html"

SETTINGS = ("mm, g", "in, oz, lbf", "in, g, lbf")
"""Units that the workbench offers; plain numbers are in them, and results are shown in them."""
DRAWN = {
    "force": "N",
    "moment": "N·m",
    "torque": "N·m",
    "orbit": "m",
    "length": "m",
    "inertia": "kg·m²",
}
"""Quantities of the turning picture, and the library's units of them."""
SHOWN = ("m", "kg", "kg·m", "N", "N·m", "kg·m²")
"""Units of the library that are shown in those of the setting."""
LZMA = {
    "id": lzma.FILTER_LZMA1,
    "preset": 9 | lzma.PRESET_EXTREME,
    "dict_size": 1 << 23,
    "lc": 3,
    "lp": 0,
    "pb": 0,
}
"""What `lzma.mjs` reads."""

DECLARING: dict[Any, str] = {
    cp.Cylinder.from_bore_stroke: "bore stroke rod_length reciprocating_mass pin_offset",
    cp.Engine.vee: "throws_deg bank_angle_deg pin_split_deg spacing bank_stagger absent odd_bank "
    "numbering rotating_mass firing_order strokes",
    cp.Engine.radial: "cylinders rows",
    cp.Engine.u: "distance phase_deg ratio",
    cp.Engine.opposed_pistons: "lead_deg",
    cp.Engine.from_lists: "bank_deg tdc_deg z",
    cp.flywheel: "inertia",
}
"""Function → its arguments that are fields of the form."""
OF_LOADS: dict[Any, str] = {
    cp.PeriodicLoad: "on force torque ratio z x y direction_deg phase_deg cylinder"
}
"""The same of fields of a periodic load."""

KINDS = (
    *("inline", "vee", "flat", "boxer", "radial"),
    *("opposed_pistons", "u", "square_four", "h"),
)
"""Builders that are kinds of the form under their names; other presets are typed as files are."""

GROUPS = {
    "Singles and twins": ("single", "i2-", "v-twin-", "boxer-2"),
    "Inline": ("i3", "i4", "i5", "i6"),
    "V": ("v4-", "v6-", "v8-", "v10-", "v12-", "v14-", "v16-"),
    "Flat": ("boxer-", "flat-"),
    "Radial": ("radial-",),
    "VR and W": ("vr", "w8", "w12", "w16"),
    "Several cranks, opposed pistons": ("opposed-piston", "delta-", "rg500", "h-16"),
    "Ships, compressors, railways": ("marine-", "compressor-", "locomotive-"),
    "From papers": ("ijesc-",),
}
"""Headings of the list of presets → how their names begin."""


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--wasm", type=Path, default=WASM, help="the core (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=PAGE, help="page (default: %(default)s)")
    given = parser.parse_args()
    text = build(given.wasm.read_bytes())
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_bytes(text.encode())
    print(f"{given.out}: {len(text.encode()) / 1e3:.0f} kB")


def build(wasm: bytes) -> str:
    """Return the page with this core."""
    drawing = page.modules("full.mjs", "page.mjs")
    script = page.modules("main.mjs", folder=HERE)
    own = [text for name, text in script.items() if name not in drawing]
    worker = page.modules("worker.mjs", folder=HERE)
    elements = [
        ("style", "turning", "", page.style()),
        ("style", "", "", (HERE / "workbench.css").read_text(encoding="utf-8")),
        ("script", "tables", "application/json", json.dumps(tables(), ensure_ascii=False)),
        ("script", "worker", "text/plain", joined(worker.values())),
        ("script", "drawing", "", joined(drawing.values())),
        ("script", "", "", joined(own)),
    ]
    return unpacking(elements, wasm)


def unpacking(elements: list[tuple[str, str, str, str]], core: bytes) -> str:
    """Return a page that makes elements, of tag, id, type and text, and begins with the core."""
    content = f"{json.dumps(elements, ensure_ascii=False)}\n".encode() + core
    return Template((HERE / "workbench.html").read_text(encoding="utf-8")).substitute(
        packed=packed(content),
        size=len(content),
        loader=joined(page.modules("loader.mjs", folder=HERE).values()),
    )


def joined(modules: Iterable[str]) -> str:
    """Return modules as one script."""
    return "\n".join(['"use strict";', *modules])


def packed(content: bytes) -> str:
    """Return bytes compressed, seven bits in a letter: a seventh longer, in base 64 a third.

    Letters that would not stand in a script as they are have 128 added.
    """
    packed = lzma.compress(content, format=lzma.FORMAT_RAW, filters=[LZMA])
    bits = f"{int.from_bytes(packed):0{len(packed) * 8}b}"
    bits += "0" * (-len(bits) % 7)
    letters = (int(bits[k : k + 7], 2) for k in range(0, len(bits), 7))
    return "".join(chr(letter + 128 if letter in b"\0\r<" else letter) for letter in letters)


def tables() -> dict[str, Any]:
    """Return what the modules have of the library: units, presets and its version."""
    return {
        "version": cp.__version__,
        "units": {
            "settings": SETTINGS,
            "shown": {setting: shown(setting) for setting in SETTINGS},
            "drawn": {setting: drawn(setting) for setting in SETTINGS[1:]} | {SETTINGS[0]: {}},
            "said": {setting: said(setting) for setting in SETTINGS[1:]} | {SETTINGS[0]: {}},
        },
        "declared": declared(DECLARING),
        "of_loads": declared(OF_LOADS),
        "presets": {name: preset(name) for name in presets.presets()},
        "page": page.template(),
        "groups": {title: names for title in GROUPS if (names := group(title))},
    }


def declared(declaring: dict[Any, str]) -> dict[str, dict[str, Any]]:
    """Return what functions declare of the arguments that are fields: unit, meaning, choices."""
    result = dict[str, dict[str, Any]]()
    for function, names in declaring.items():
        for name in names.split():
            of = parameters.parameter(function, name)
            text = of.meaning.replace("``", "").replace('"', "")
            result[name] = {"said": text[0].lower() + text[1:], "choices": of.choices}
            result[name] |= {"unit": of.unit.replace("degrees", "°")} if of.unit else {}
    return result


def shown(setting: str) -> dict[str, tuple[str, float]]:
    """Return the unit that a setting shows in place of each, and the factor of its numbers."""
    return {unit: tuple(units.convert(unit, units.read(setting))) for unit in SHOWN}


def drawn(setting: str) -> dict[str, tuple[str, float]]:
    """Return the units in which a setting draws quantities."""
    chosen = units.read(setting)
    return {name: tuple(units.convert(unit, chosen)) for name, unit in DRAWN.items()}


def said(setting: str) -> dict[str, tuple[str, float]]:
    """Return the units in which a setting has sentences."""
    chosen = units.read(setting)
    return {unit: tuple(units.convert(unit, chosen)) for unit in explain.SENTENCE_UNITS}


def group(title: str) -> list[str]:
    """Return the presets below a heading, each below the first that has it."""
    before = [
        start for other in list(GROUPS)[: list(GROUPS).index(title)] for start in GROUPS[other]
    ]
    return [
        name
        for name in presets.presets()
        if name.startswith(GROUPS[title])
        and not name.startswith(tuple(before))
        and not name.endswith(presets.OWN_PARTS)
    ]


def preset(name: str) -> dict[str, Any]:
    """Return a preset as the form has it: its builder, and the texts of its fields."""
    layout = presets.layout(name)
    engine = presets.preset(name)
    part = layout.cylinder
    listed = {
        key: value for key, value in layout.arguments.items() if key not in ("name", "source")
    }
    kind, typed = layout.builder, " ".join(DECLARING.values()).split()
    common = {"name": engine.name, "title": layout.arguments["name"], "source": engine.source}
    fields = {"stroke": _length(part.stroke), "rod_length": _length(part.rod_length),
              "reciprocating_mass": _mass(part.reciprocating_mass)}  # fmt: skip
    if part.bore is not None:
        fields["bore"] = _length(part.bore)
    if kind not in KINDS or not listed.keys() <= {*typed}:
        return common | {"kind": "lists", "file": json.loads(engine.to_json()), "fields": {}}
    if kind != "radial" or layout.arguments.get("rows", 1) > 1:
        fields["spacing"] = _length(layout.spacing)
    for key, value in listed.items():
        fields[key] = _text(key, value)
    return common | {"kind": kind, "fields": fields}


def _text(key: str, value: object) -> str:
    if isinstance(value, list):
        return ", ".join(_text(key, each) for each in value)
    if key == "rotating_mass":
        return _mass(float(str(value)))
    if key == "distance":
        return _length(float(str(value)))
    return str(value)


def _length(metres: float) -> str:
    return f"{_plain(Decimal(repr(metres)) * 1000)} mm"


def _mass(kilograms: float) -> str:
    return f"{_plain(Decimal(repr(kilograms)) * 1000)} g"


def _plain(number: Decimal) -> str:
    return f"{number:f}".rstrip("0").rstrip(".") if "." in f"{number:f}" else f"{number:f}"


if __name__ == "__main__":
    main()
