"""What the build of the manual makes: pictures, presets, the command line, formulae."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import html
import os
import re
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import crankpin as cp
import latex2mathml.converter
import matplotlib as mpl
import matplotlib.pyplot as plt
from crankpin import cli
from crankpin._support import inputs
from crankpin._support.drawing import Plot
from crankpin._support.record import FieldsDocumented
from crankpin.model import engine_files
from crankpin.model.presets import usual_speed
from crankpin.view import gallery
from docutils import nodes
from matplotlib.text import Text
from sphinx.ext.napoleon import NumpyDocstring
from sphinx.util.docutils import SphinxDirective

if TYPE_CHECKING:
    from collections.abc import Iterable

    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

GALLERY = Path(__file__).parent / "gallery"
"""Folder of what is made; not in the repository."""
TUTORIALS = Path(__file__).parent / "tutorials"
"""Folder of the notebooks' copies: Sphinx reads nothing outside its own."""
NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
THUMBNAILS = GALLERY / "thumbnails"
WORKBENCH = Path(__file__).parents[1] / "target" / "site" / "index.html"
"""The page of ``site/build.py``, of which the manual has a copy if it is built."""
WORKBENCH_COPY = "workbench.html"
FLAT = 180.0
LAYOUTS = ("inline", "vee", "flat", "W", "radial")
REMAINS = {
    "force-1": "a force of order 1",
    "force-2": "a force of order 2",
    "moment-1": "a moment of order 1",
    "moment-2": "a moment of order 2",
    "nothing": "none of these",
}
"""What may remain of an engine, by the keys of the gallery's filter."""
RPM = 3000.0
PRESET = """\
# {engine.name}

{description}

```{{picture}}
import crankpin as cp
engine = cp.Engine.preset("{name}")
engine.plot()
```

{sentences}

Without gas pressure, at {rpm:g} rpm (`engine.balance(rpm={rpm:g})`):

```text
{balance}
```

```{{raw}} html
<iframe class="turning" src="turning/compact/{name}.html" loading="lazy"
title="{engine.name}, turning"></iframe>
<p><a href="turning/{name}.html">The whole page</a></p>
```

```{{workbench}} preset={name}
Open it in the workbench
```

`engine.save_html("{name}.html")` writes the whole page, `engine.view()` shows it in a notebook;
`compact=True` makes the small one.
"""

CARD = """\
<li data-cylinders="{cylinders}" data-layout="{layout}" data-remains="{remains}">
<a href="{name}.html"><img src="thumbnails/{name}.png" alt="" loading="lazy">
<b>{title}</b> <span>{sentence}</span>
<small>{force:.3g} F, {moment:.3g} mm · F</small></a></li>
"""
WALL = """\
Every preset, `cp.Engine.preset(name)`: drawn, explained and turning. Below each, what is left of
all orders together without gas pressure: the largest shaking force and, by its lever, the largest
rocking moment, in first-order forces F of one piston.

```{{raw}} html
<form class="filters">
<label>Cylinders <select name="cylinders"><option value="">any</option>{cylinders}</select></label>
<label>Layout <select name="layout"><option value="">any</option>{layouts}</select></label>
<label>What remains
<select name="remains"><option value="">anything</option>{remains}</select></label>
<output></output>
<a href="turning/index.html">All of them, turning</a>
</form>
<ul class="wall">
{cards}</ul>
```

```{{toctree}}
:hidden:

{listed}
```
"""


class Picture(SphinxDirective):
    """Lines of Python, and the picture that they draw."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Run the lines, each page in one namespace; return them and their last picture."""
        code = "\n".join(self.content)
        names = self.env.temp_data.setdefault("names of pictures", {})
        file = GALLERY / "drawn" / f"{hashlib.sha256(code.encode()).hexdigest()[:16]}.png"
        file.parent.mkdir(parents=True, exist_ok=True)
        lines = compile(code, self.env.docname, "exec")
        # What the lines save is not the repository's.
        with TemporaryDirectory() as folder, contextlib.chdir(folder):
            exec(lines, names)  # noqa: S102 - of the page
        plt.gcf().savefig(file, dpi=100, bbox_inches="tight")
        plt.close("all")
        shown = nodes.literal_block(code, code, language="python")
        said = code.strip().splitlines()[-1]
        drawn = nodes.image(uri=f"/gallery/drawn/{file.name}", alt=f"Picture drawn by {said}")
        self.set_source_info(drawn)
        return [shown, drawn]


class Workbench(SphinxDirective):
    """A link to the workbench with an engine in it; nothing in a manual without a workbench."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the link: the engine is behind the #."""
        if not WORKBENCH.exists():
            return []
        up = "../" * self.env.docname.count("/")
        address = f"{up}{WORKBENCH_COPY}#{self.arguments[0]}"
        text = " ".join(self.content)
        link = nodes.reference(text, text, refuri=address, internal=False)
        return [nodes.paragraph("", "", link)]


class Commands(SphinxDirective):
    """The help of every command, as it is printed."""

    def run(self) -> list[nodes.Node]:
        """Return a section for each command."""
        os.environ |= {"COLUMNS": "96", "NO_COLOR": "1"}
        parser = cli._parser()
        (commands,) = (
            each.choices for each in parser._actions if isinstance(each, argparse._SubParsersAction)
        )
        return [
            self.section(name, command.format_help())
            for name, command in {cli.PROG: parser, **commands}.items()
        ]

    def section(self, name: str, text: str) -> nodes.section:
        """Return the section of a command."""
        section = nodes.section(ids=[f"command-{name}"])
        section += nodes.title(name, name)
        section += nodes.literal_block(text, text, language="text")
        return section


class EngineFile(SphinxDirective):
    """The entries of engine files, from their schema: a table for each kind of table."""

    def run(self) -> list[nodes.Node]:
        """Return a section for each table of an engine file."""
        schema = engine_files.schema()
        parts = {"engine": schema} | {
            name: part for name, part in schema["$defs"].items() if "properties" in part
        }
        return [node for name, part in parts.items() for node in self.section(name, part)]

    def section(self, name: str, part: dict[str, Any]) -> list[nodes.Node]:
        """Return the section of a table."""
        rows = []
        for entry, about in part["properties"].items():
            least = next(
                (about[key] for key in ("minimum", "exclusiveMinimum") if key in about), None
            )
            sign = (
                "" if least is None else f"; {'>' if 'exclusiveMinimum' in about else '≥'} {least}"
            )
            need = "needed" if entry in part.get("required", ()) else f"{about.get('default', '–')}"
            rows.append(f"| `{entry}` | {need} | {about['description']}{sign} |")
        table = "\n".join(["| entry | default | meaning |", "|---|---|---|", *rows])
        section = nodes.section(ids=[f"file-{name}"])
        section += nodes.title(name, name)
        section += self.parse_text_to_nodes(table)
        return [section]


def copy_notebooks(app: Sphinx) -> None:
    """Copy the notebooks beside the page that lists them, with links as they are from there."""
    for notebook in NOTEBOOKS.glob("*.ipynb"):
        text = notebook.read_text(encoding="utf-8")
        _write(TUTORIALS / notebook.name, text.replace("](../docs/", "](../"))


def link_copies(app: Sphinx, page: str, text: list[str]) -> None:
    """Let links to notebooks lead to their copies."""
    text[0] = re.sub(r"\]\(\.\./((?:\.\./)*)notebooks/", rf"](\1{TUTORIALS.name}/", text[0])


def make_gallery(app: Sphinx) -> None:
    """Write a source page for each preset, and one on which all hang as on a wall."""
    GALLERY.mkdir(exist_ok=True)
    presets = cp.presets()
    cards = []
    for name, engine in presets.items():
        rpm = usual_speed(name, RPM)
        balance = engine.balance(rpm=rpm)
        explained = engine.explain()
        text = PRESET.format(
            name=name,
            engine=engine,
            description=_sentence(presets.descriptions[name]),
            rpm=rpm,
            balance=balance,
            sentences="\n".join(f"* {each}" for each in explained.sentences),
        )
        _write(GALLERY / f"{name}.md", text)
        if not (THUMBNAILS / f"{name}.png").exists():
            _draw_thumbnail(engine, THUMBNAILS / f"{name}.png")
        force = explained.unit * inputs.angular_speed(rpm) ** 2
        card = CARD.format(
            name=name,
            title=html.escape(engine.name),
            cylinders=len(engine),
            layout=_layout(name, engine),
            remains=" ".join(_remaining(engine)) or "nothing",
            sentence=html.escape(_sentence(presets.descriptions[name])),
            force=balance.total.force.peak / force,
            moment=balance.total.moment.peak / force * 1000,
        )
        cards.append(card)
    wall = WALL.format(
        cylinders=_options(sorted({len(engine) for engine in presets.values()})),
        layouts=_options(LAYOUTS),
        remains="".join(f"<option value='{key}'>{name}</option>" for key, name in REMAINS.items()),
        cards="".join(cards),
        listed="\n".join(presets),
    )
    _write(GALLERY / "index.md", f"# Gallery\n\n{wall}")


def _options(values: Iterable[object]) -> str:
    """Return the options of a list to choose from."""
    return "".join(f"<option>{value}</option>" for value in values)


def _draw_thumbnail(engine: cp.Engine, file: Path) -> None:
    """Write a small picture of an engine's cross-section."""
    file.parent.mkdir(parents=True, exist_ok=True)
    axes = engine.plot(kind="section", theta_deg=40.0)
    for text in axes.figure.findobj(Text):
        text.set_visible(False)  # too small to read
    axes.figure.savefig(file, dpi=60, bbox_inches="tight", transparent=True)
    plt.close("all")


def _layout(name: str, engine: cp.Engine) -> str:
    """Return the kind of layout that the gallery's filter has."""
    if name.startswith("radial"):
        return "radial"
    banks = sorted(set(engine.bank_deg.tolist()))
    if len(banks) == 2:
        return "flat" if banks[1] - banks[0] == FLAT else "vee"
    return "inline" if len(banks) == 1 else "W"


def _remaining(engine: cp.Engine) -> list[str]:
    """Return which of the first two orders' forces and moments an engine has."""
    vanishing = engine.vanishing_orders()
    return [
        key
        for key in REMAINS
        if key != "nothing" and int(key[-1]) not in getattr(vanishing, key.split("-")[0]).vanishing
    ]


def _sentence(text: str) -> str:
    """Return a description as a sentence."""
    return f"{text[0].upper()}{text[1:].rstrip('.')}."


def _write(file: Path, text: str) -> None:
    """Write a file if it would change: Sphinx reads again what is newer."""
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.write_text(text, encoding="utf-8")


def make_turning(app: Sphinx, failed: Exception | None) -> None:
    """Write the pages in which the presets turn, and copy what hangs on the wall."""
    if failed is None and app.builder.format == "html":
        if WORKBENCH.exists():
            shutil.copy(WORKBENCH, Path(app.outdir) / WORKBENCH_COPY)
        shutil.copytree(THUMBNAILS, Path(app.outdir) / "gallery" / "thumbnails", dirs_exist_ok=True)
        folder = Path(app.outdir) / "gallery" / "turning"
        gallery.save_gallery(folder, rpm=RPM)
        (folder / "compact").mkdir(exist_ok=True)
        for name, engine in cp.presets().items():
            engine.save_html(
                folder / "compact" / f"{name}.html", rpm=usual_speed(name, RPM), compact=True
            )


def formula(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula in a line of text as MathML."""
    translator.body.append(latex2mathml.converter.convert(node.astext()))
    raise nodes.SkipNode


def formula_block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on lines of its own as MathML."""
    translator.body.append(latex2mathml.converter.convert(node.astext(), display="block"))
    raise nodes.SkipNode


def hide_constructor(
    app: Sphinx, what: str, name: str, of: object, options: object, signature: str, returned: str
) -> tuple[str, str] | None:
    """Return no signature for classes that builders and functions make."""
    made = name == "crankpin.Engine" or name.startswith("crankpin.results.")
    return ("", "") if what == "class" and made else None


def without_fields(
    app: Sphinx, what: str, name: str, of: object, options: object, lines: list[str]
) -> None:
    """Remove the list of a class's fields, which the reference shows one by one."""
    docstring = vars(of).get("__doc__") if what == "class" else None
    if isinstance(docstring, FieldsDocumented):
        lines[:] = [*docstring.text.splitlines(), ""]


def plots_as_methods(
    app: Sphinx, what: str, name: str, of: object, options: object, lines: list[str]
) -> None:
    """Read the docstring of ``plot``, to autodoc an attribute, as that of the method it is."""
    if isinstance(of, Plot):
        written = of.__signature__
        _, *others = written.parameters.values()
        bare = [each.replace(annotation=each.empty) for each in others]
        written = written.replace(parameters=bare, return_annotation=written.empty)
        read = NumpyDocstring(lines, app.config, app, "method", name, of).lines()
        lines[:] = [f"``plot{written}``", "", *read]


def whole_docstring(docstring: NumpyDocstring) -> tuple[str, list[str]]:
    """Return the docstring of a property: to napoleon what precedes a colon would be its type."""
    return "", docstring._consume_to_end()


def setup(app: Sphinx) -> dict[str, Any]:
    """Register all of it."""
    mpl.use("Agg")
    NumpyDocstring._consume_inline_attribute = whole_docstring  # type: ignore[method-assign]
    app.add_directive("picture", Picture)
    app.add_directive("workbench", Workbench)
    app.add_directive("commands", Commands)
    app.add_directive("engine-file", EngineFile)
    app.add_html_math_renderer("mathml", (formula, None), (formula_block, None))
    app.connect("autodoc-process-signature", hide_constructor)
    app.connect("autodoc-process-docstring", without_fields, priority=400)  # before napoleon
    app.connect("autodoc-process-docstring", plots_as_methods, priority=400)
    app.connect("builder-inited", copy_notebooks)
    app.connect("builder-inited", make_gallery)
    app.connect("source-read", link_copies)
    app.connect("build-finished", make_turning)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
