"""Engines: cross-section, crank star, and side view of the crank."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.font_manager import FontProperties

from crankpin._support import inputs, labels
from crankpin.analysis.geometry import crank_angle
from crankpin.model.engine import Engine
from crankpin.plot.axes import (
    check_one_place,
    entitle,
    entitle_figure,
    head,
    many_panels,
    one_panel,
    refuse_figure,
)
from crankpin.plot.crank import side, star
from crankpin.plot.dispatch import draw
from crankpin.plot.legend import figure_legend, legend_below
from crankpin.plot.section import section
from crankpin.plot.shapes import inks_of, legend_handles
from crankpin.plot.ticks import numeric
from crankpin.plot.words import rounded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import NDArray

PANELS = {"section": section, "star": star, "side": side}
PANEL_NAMES = {"section": "cross-section", "star": "crank star", "side": "crank from the side"}


@draw.register(Engine)
def _engine(
    engine: Engine,
    ax: Axes | None = None,
    *,
    figure: FigureBase | None = None,
    kind: str | None = None,
    theta_deg: float = 0.0,
    **style: Any,  # noqa: ANN401
) -> Axes | NDArray[Any]:
    check_one_place(ax, figure)
    theta = crank_angle(theta_deg)
    if kind is not None:
        inputs.one_of("kind", kind, PANELS)
        refuse_figure(figure, kind)
    elif ax is not None:
        kind = "section"
    if kind is not None:
        ax = one_panel(ax)
        panel(engine, ax, kind, theta, **style)
        what = f"{PANEL_NAMES[kind]}, θ = {rounded(theta, 6)}°"
        entitle(ax, labels.name_of(engine), what, pad=_above())
        legend_below(ax, handles=legend_handles(engine, inks_of(ax)))
        return ax
    return all_panels(engine, figure, theta, style)


def panel(engine: Engine, ax: Axes, kind: str, theta: float, **style: Any) -> None:  # noqa: ANN401
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
    figure, cells = many_panels(figure, 2, 2, row_height=0.6, height_ratios=[2.0, 1.1])
    below = cells[1, 0].get_gridspec()[1, :]
    for cell in cells[1]:
        cell.remove()
    axes = np.array([*cells[0], figure.add_subplot(below)])
    for ax, (kind, name) in zip(axes, PANEL_NAMES.items(), strict=True):
        panel(engine, ax, kind, theta, **style)
        head(ax, name, _above())
    entitle_figure(
        figure, labels.name_of(engine), f"θ = {rounded(theta, 6)}°, seen from the flywheel"
    )
    figure_legend(figure, legend_handles(engine, inks_of(axes[0])))
    return axes


def _above() -> float:
    """Return how far above the drawings their titles are, points: numbers may come first."""
    return 6.0 + 1.5 * FontProperties(size="small").get_size_in_points()
