"""Engines: cross-section, crank star and side view, as figures and as small SVG elements."""

from __future__ import annotations

import html
import io
import re
import uuid
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

from crankpin._support import inputs, labels
from crankpin._support.drawing import picture, svg
from crankpin.analysis.geometry import crank_angle
from crankpin.model.engine import Engine
from crankpin.plot.crank import cranks_with_parts, side, star
from crankpin.plot.layout import (
    Drawn,
    add_legend,
    axes_or_new,
    make_panels,
    reject_figure,
    set_panel_title,
    set_title,
)
from crankpin.plot.section import section
from crankpin.plot.shapes import inks_of, legend_handles
from crankpin.plot.ticks import numeric
from crankpin.plot.words import rounded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import NDArray


FOREGROUND = "#010203"
"""Drawn in place of the page's own colour of text, which matplotlib cannot name."""
BEHIND = "#cccccc"
"""Mixed into the colours of parts, for outlines white or black."""
INLINE = 0.8
"""Size of a picture in a page over its size as drawn."""


class _Renderer(RendererSVG):
    """Writes text as text; ``rcParams["svg.fonttype"]`` would apply to all threads."""

    def _draw_text_as_path(self, *text: Any, **options: Any) -> None:  # noqa: ANN401
        self._draw_text_as_text(*text, **options)  # type: ignore[no-untyped-call]


@svg.register(Engine)
def _svg(engine: Engine) -> str:
    """Return cross-section and side view of an engine as an ``<svg>`` element.

    Its lines have the colour of the text around it; nothing in it refers to anything outside, and
    its ids are its own.
    """
    figure = Figure(figsize=(6.5, 2.5), dpi=72, layout="constrained", facecolor="none")
    left, right = axes = figure.subplots(1, 2, width_ratios=[2, 3])
    for ax in axes:
        ax.set_facecolor(BEHIND)
        ax.title.set_color(FOREGROUND)
    section(engine, left, 0.0)
    side(engine, right, 0.0)
    right.set_axis_off()
    for ax in axes:
        for text in ax.texts:
            text.set_color(FOREGROUND)
        for artist in (*ax.collections, *ax.lines):
            artist.set_clip_on(False)  # clip paths would be half of the text
    file = io.StringIO()
    metadata = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    renderer: Any = _Renderer(*figure.bbox.size, file, metadata=metadata)  # type: ignore[no-untyped-call]
    figure.draw(renderer)
    renderer.finalize()
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
    text = re.sub(r'="([\d.]+)pt"', lambda match: f'="{INLINE * float(match[1]):.4g}pt"', text)
    look = f'role="img" aria-label="{html.escape(label)}" style="stroke-linejoin: round"'
    return re.sub(r"\s*\n\s*", " ", text).replace("<svg", f"<svg {look}", 1)


# --- engine --------------------------------------------------------------------------------------

PANELS = {"section": section, "star": star, "side": side}
PANEL_NAMES = {"section": "cross-section", "star": "crank star", "side": "crank from the side"}


@picture.register(Engine)
def _engine(
    engine: Engine,
    ax: Axes | None = None,
    *,
    figure: FigureBase | None = None,
    kind: str | None = None,
    theta_deg: float = 0.0,
    **style: object,
) -> Drawn:
    """Draw the engine at a crank angle: cross-section, crank star, crank from the side.

    Seen from the flywheel; the side view from x < 0, front to flywheel. Numbers are those of
    the cylinders. An unbalance is a sector whose area is proportional to its amount. A bore
    that is not known is drawn as wide as the stroke is long, but at most 0.9 of the distance to
    the next cylinder of the bank, and at least 0.6 of the stroke. Crankpins at one place along
    the crank are drawn side by side.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes for one picture; without ``kind`` the cross-section.
    kind : {"section", "star", "side"}, optional
        ``"section"``, ``"star"`` or ``"side"`` for one picture; None for all three.
    theta_deg : float, default 0.0
        Crank angle, degrees.
    **style : dict, optional
        Passed on to the main parts, such as ``facecolor=``: pistons and rods of the section,
        throws of the star, webs of the side view.

    Returns
    -------
    matplotlib.axes.Axes or ndarray of Axes, shape (3,)
        The axes; of all three pictures an array.

    Examples
    --------
    >>> import crankpin as cp
    >>> ax = cp.Engine.preset("v8-crossplane").plot(kind="star", theta_deg=45)
    """
    theta = crank_angle(theta_deg)
    if kind is not None:
        inputs.one_of("kind", kind, PANELS)
        reject_figure(figure, kind)
    elif ax is not None:
        kind = "section"
    if kind is not None:
        ax = axes_or_new(ax)
        panel(engine, ax, kind, theta, **style)
        what = f"{PANEL_NAMES[kind]}, θ = {rounded(theta, 6)}°"
        set_title(ax, labels.name_of(engine), what, pad=_above())
        add_legend(ax, handles=legend_handles(engine, inks_of(ax)))
        return ax
    return all_panels(engine, figure, theta, style)


def panel(engine: Engine, ax: Axes, kind: str, theta: float, **style: object) -> None:
    """Draw one of the pictures on axes."""
    PANELS[kind](engine, ax, theta, **style)
    if kind == "side":
        numeric(ax.xaxis)
        numeric(ax.yaxis)
        ax.grid(visible=False)
        ax.spines[["top", "right"]].set_visible(False)


def all_panels(
    engine: Engine, figure: FigureBase | None, theta: float, style: dict[str, Any]
) -> NDArray[Any]:
    """Draw the cross-section and the star beside each other, and the side view below them."""
    # Cranks are drawn below each other from the side.
    heights = [2.0, 1.1 + 0.3 * (len(cranks_with_parts(engine)) - 1)]
    panels = make_panels(None, figure, 2, 2, row_height=0.6, height_ratios=heights)
    cells = panels.axes
    below = cells[1, 0].get_gridspec()[1, :]
    for cell in cells[1]:
        cell.remove()
    axes = np.array([*cells[0], panels.figure.add_subplot(below)])
    for ax, (kind, name) in zip(axes, PANEL_NAMES.items(), strict=True):
        panel(engine, ax, kind, theta, **style)
        set_panel_title(ax, name, pad=_above())
    panels.set_title(labels.name_of(engine), f"θ = {rounded(theta, 6)}°, seen from the flywheel")
    panels.add_legend(legend_handles(engine, inks_of(axes[0])))
    return axes


def _above() -> float:
    """Return how far above the drawings their titles are, points: numbers may come first."""
    return 6.0 + 1.5 * FontProperties(size="small").get_size_in_points()
