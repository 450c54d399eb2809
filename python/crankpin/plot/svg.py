"""Small pictures of engines as SVG elements, for notebooks."""

from __future__ import annotations

import html
import io
import re
import uuid
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.figure import Figure

from crankpin._support import labels
from crankpin.plot.crank import side
from crankpin.plot.section import section

if TYPE_CHECKING:
    from crankpin.model.engine import Engine

FOREGROUND = "#010203"
"""Drawn in place of the page's own colour of text, which matplotlib cannot name."""
LOOK: dict[Any, Any] = {
    "svg.fonttype": "none",
    "font.size": 8.0,
    "path.simplify": False,
    "figure.facecolor": "none",
    "axes.facecolor": "#cccccc",  # mixed into the parts' colours, for outlines white or black
    "text.color": FOREGROUND,
    "axes.titlecolor": FOREGROUND,
}


def inline_svg(engine: Engine) -> str:
    """Return cross-section and side view of an engine as an ``<svg>`` element.

    Its lines have the colour of the text around it; nothing in it refers to anything outside, and
    its ids are its own.
    """
    file = io.StringIO()
    with mpl.rc_context(LOOK):
        figure = Figure(figsize=(5.2, 2.0), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=[2, 3])
        section(engine, left, 0.0)
        side(engine, right, 0.0)
        right.set_axis_off()
        for artist in (*left.collections, *left.lines, *right.collections):
            artist.set_clip_on(False)  # clip paths would be half of the text
        metadata = dict.fromkeys(("Creator", "Date", "Format", "Type"))
        figure.savefig(file, format="svg", metadata=metadata)
    return _element(
        file.getvalue(), f"{labels.name_of(engine)}: cross-section and crank from the side"
    )


def _element(document: str, label: str) -> str:
    """Return the element of an SVG document, made fit to stand in a page among others."""
    text = document[document.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = text.replace(FOREGROUND, "currentColor")
    # A style sheet in the element would apply to the whole page.
    text = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", text, count=1, flags=re.DOTALL)
    # Ids that nothing refers to go; the rest get a prefix that no other picture has.
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', text))
    prefix = f"c{uuid.uuid4().hex[:8]}"

    def kept(match: re.Match[str]) -> str:
        return f' id="{prefix}{match[1]}"' if match[1] in used else ""

    text = re.sub(r' id="([^"]+)"', kept, text)
    text = re.sub(r'(href="|url\()#', rf"\g<1>#{prefix}", text)
    text = re.sub(r"\d+\.\d{3,}", lambda match: f"{float(match[0]):.2f}", text)
    look = f'role="img" aria-label="{html.escape(label)}" style="stroke-linejoin: round"'
    return re.sub(r"\s*\n\s*", " ", text).replace("<svg", f"<svg {look}", 1)
