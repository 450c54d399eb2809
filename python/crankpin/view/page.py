"""Self-contained pages of an engine: modules, style and figures."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

from crankpin._support import files, inputs
from crankpin.view import mounted
from crankpin.view.figures import figures

if TYPE_CHECKING:
    from collections.abc import Iterable

    from crankpin._support.inputs import Spectrum
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.model.engine import Engine
    from crankpin.view.figures import Controls

WEB = Path(__file__).parent / "web"
IMPORT = re.compile(r'^import \{[^}]*\} from "\./(\w+\.mjs)";\n', re.MULTILINE)
COMMENT = re.compile(
    r"^\s*(?://[^\n]*|/\*.*?\*/)\n|(?<=[;,]) //[^\n\"]*$", re.MULTILINE | re.DOTALL
)
EXPORT = re.compile(r"^export (?=(?:async )?(?:const|class|function))", re.MULTILINE)
INDENT = re.compile(r"^\s+", re.MULTILINE)
END = re.compile(r"(?<=[{(\[,;])\n")
"""Ends of lines that a module does without."""
SPACE = re.compile(r"(?<=[:,;{]) | (?=[{}])")
"""Spaces that a style sheet does without."""
AROUND = re.compile(r"""^.*(?:[`']|\(/).*$|"(?:[^"\\\n]|\\.)*"| ?([,:;={}()?]) ?""", re.MULTILINE)
"""A sign with spaces that a module does without; texts, and lines with texts of other marks."""


def save_html(
    engine: Engine,
    path: str | Path,
    *,
    rpm: float = 3000.0,
    inertia: float | None = None,
    spectrum: Spectrum | None = None,
    compact: bool = False,
    controls: Controls = None,
) -> None:
    """Write a page in which an engine turns; :meth:`Engine.save_html` documents the arguments."""
    file = inputs.file_path(path, (".html", ".htm"), "a page ends in .html")
    payload = figures(
        engine, rpm, inertia=inertia, spectrum=spectrum, compact=compact, controls=controls
    )
    view = "Compact" if compact else "Full"
    text = document(
        engine.name or "Engine",
        (f"{view.lower()}.mjs", "page.mjs"),
        f"page({view}, {as_json(payload)});",
        styles=["compact"] if compact else [],
    )
    files.write(file, text)


def save_mounted_html(
    powertrain: Powertrain,
    path: str | Path,
    *,
    rpm: float = 800.0,
    frequency: float | None = None,
    controls: Controls = None,
) -> None:
    """Write a page of a powertrain; :meth:`Powertrain.save_html` documents the arguments."""
    file = inputs.file_path(path, (".html", ".htm"), "a page ends in .html")
    payload = mounted.figures(powertrain, rpm, frequency=frequency, controls=controls)
    text = document(
        payload["name"],
        ("mounted.mjs", "page.mjs"),
        f"page(Mounted, {as_json(payload)});",
        styles=["mounted"],
    )
    files.write(file, text)


def document(
    title: str, entries: Iterable[str], call: str, *, styles: Iterable[str] = (), body: str = ""
) -> str:
    """Return a page that loads nothing: modules and what they import, and a call of one."""
    return Template(template()).substitute(
        title=html.escape(title),
        style=style(*styles),
        script=f"{module(*entries)}\n{call}",
        body=body,
    )


def template() -> str:
    """Return what pages are written into: ``$title``, ``$style``, ``$body`` and ``$script``."""
    return _read("page.html")


def style(*names: str) -> str:
    """Return the style sheet, with these besides; elements within class ``crankpin`` alone."""
    texts = [_read(f"{name}.css") for name in ("view", *names)]
    return "".join(SPACE.sub("", INDENT.sub("", COMMENT.sub("", text))) for text in texts)


def module(*entries: str) -> str:
    """Return modules with all that they import, as one module."""
    return "".join(modules(*entries).values())


def modules(*entries: str, folder: Path = WEB) -> dict[str, str]:
    """Return modules of a folder, or of pages, with what they import, each behind its imports.

    The modules import each other by name, without renaming, and no two have a name in common: one
    after the other, without ``import`` and ``export``, they are one module. Comments, indents,
    most ends of lines and spaces are left out: no text goes over several lines, or has an arrow.
    """
    texts: dict[str, str] = {}

    def visit(name: str) -> None:
        if name in texts:
            return
        text = _read(name, folder if (folder / name).exists() else WEB)
        for each in IMPORT.findall(text):
            visit(each)
        text = INDENT.sub("", EXPORT.sub("", COMMENT.sub("", IMPORT.sub("", text))))
        text = AROUND.sub(lambda match: match[1] or match[0], text)
        texts[name] = END.sub("", text).replace(" => ", "=>")

    for entry in entries:
        visit(entry)
    return texts


def as_json(value: object) -> str:
    """Return JSON that may stand in a script element: no text in it can end the element."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _read(name: str, folder: Path = WEB) -> str:
    return (folder / name).read_text(encoding="utf-8")
