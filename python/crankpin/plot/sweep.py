"""Sweeps: curves over a swept dimension, a panel for each order and axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FuncFormatter, MaxNLocator

from crankpin._core import InputError
from crankpin._support import inputs, labels
from crankpin.analysis.source import PLANE_VECTORS, shown_orders
from crankpin.analysis.sweep import Sweep
from crankpin.plot._old import (
    COLOURS,
    FEW_POINTS,
    GREY,
    STEPS,
    by_component,
    checked,
    degrees,
    dress,
    from_zero,
    note_below,
    panels_of,
    plain,
    plain_text,
    say_zero,
    span,
)
from crankpin.plot.curves import Curve, curves_of, dimension, explain, words_of
from crankpin.plot.dispatch import draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray


@draw.register(Sweep)
def _sweep(
    result: Sweep,
    ax: Any = None,  # noqa: ANN401 - an array of axes
    *,
    quantity: str = "moment",
    x: str | None = None,
) -> NDArray[Any]:
    kind = checked(quantity)
    dims = list(result.coords)
    along = _along_x(result, x)
    others = [dim for dim in dims if dim != along]
    drawn = getattr(result, kind)
    shown, omitted = shown_orders(result.source, kind)
    peaks = by_component(drawn.peak_xy if kind in PLANE_VECTORS else drawn.peak, kind)
    peaks = np.moveaxis(peaks[..., list(shown), :], dims.index(along), 0)
    words = words_of(result)
    curves = curves_of(result, others)
    axes = labels.COMPONENTS[kind]
    shape = (max(1, len(shown)), len(axes))
    if ax is None:
        figure, panels = _panels(shape, along, len(result.coords[along]))
        title = plain_text(f"{words.title}\n{words.subtitle(kind)}")
        figure.suptitle(title, x=0.012, ha="left", fontsize=12)
    else:
        panels = panels_of(ax, shape)
        figure = panels[0, 0].get_figure(root=True)
    for row, place in enumerate(shown):
        for column, axis in enumerate(axes):
            panel = panels[row, column]
            panel.set_title(
                f"order {result.orders[place]}, {axis}", loc="left", fontsize=10, color=GREY
            )
            if along == "engine":
                _dots(panel, words.names, peaks[..., row, column], curves)
            else:
                heights = peaks[..., row, column]
                _lines(panel, np.asarray(result.coords[along]), heights, curves)
        unit, largest = f"peak, {labels.UNITS[kind]}", float(peaks[..., row, :].max(initial=0.0))
        for panel in panels[row]:
            from_zero(panel, largest, "x" if along == "engine" else "y")
        if along == "engine":
            for panel in panels[row]:
                panel.set_xlabel(unit)
        else:
            panels[row, 0].set_ylabel(unit)
    for panel in panels[-1] if along != "engine" else []:
        _label_x(panel, along, np.asarray(result.coords[along]))
    note_below(figure, labels.not_shown(omitted))
    if ax is None:
        figure.align_ylabels()
        explain(figure, panels, result, others, curves, words)
    return panels


def _panels(shape: tuple[int, int], along: str, points: int) -> tuple[Figure, NDArray[Any]]:
    rows, columns = shape
    height = 0.9 + 0.27 * points if along == "engine" else 2.3
    return plt.subplots(
        rows,
        columns,
        figsize=(4.6 * columns + (2.0 if columns == 1 else 0.0), height * rows + 1.5),
        sharex="row" if along == "engine" else True,
        sharey=True if along == "engine" else "row",
        squeeze=False,
        layout=ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.08, hspace=0.03),
    )


def _along_x(sweep: Sweep, x: str | None) -> str:
    swept = {dim: len(values) for dim, values in sweep.coords.items()}
    if not swept:
        raise InputError("nothing was swept: give an array, such as bank_angle_deg=[60, 75, 90]")
    if x is None:
        numeric = {dim: count for dim, count in swept.items() if dim != "engine"} or swept
        return max(numeric, key=lambda dim: numeric[dim])
    if x not in swept:
        names = ", ".join(swept)
        raise InputError(f"x = {inputs.shorten(x)} is not a swept dimension; choose from: {names}")
    return x


def _lines(
    ax: Axes, x: NDArray[np.float64], peaks: NDArray[np.float64], curves: list[Curve]
) -> None:
    in_order = np.argsort(x, kind="stable")
    few = len(curves) <= len(COLOURS)
    plain = not any(curve.dashed_by for curve in curves)
    near = 0.004 * float(peaks.max(initial=0.0))  # about half a line's width
    drawn: list[NDArray[np.float64]] = []
    for curve in curves:
        heights = peaks[in_order, *curve.place]
        style = dict(curve.style)
        if (few and len(x) <= FEW_POINTS) or len(x) == 1:
            style |= {"marker": "o", "markersize": 3.2}
        if few and any(bool((abs(heights - other) <= near).all()) for other in drawn):
            # Lets the curve below be seen.
            if plain:
                style |= {"linestyle": (0, (3, 3)), "marker": ""}
            style["linewidth"] *= 0.7
        drawn.append(heights)
        ax.plot(x[in_order], heights, clip_on=False, zorder=3, **style)
    dress(ax)
    if not peaks.any():
        say_zero(ax)


def _dots(ax: Axes, names: list[str], peaks: NDArray[np.float64], curves: list[Curve]) -> None:
    """Draw engines below each other: names need room, and between two engines there is nothing."""
    for curve in curves:
        style = {"marker": "o", "markersize": 7, "color": curve.style["color"], "linestyle": ""}
        if curve.dashed_by:
            style |= {"markerfacecolor": "white", "markersize": 7 - curve.dashed_by % 4}
        ax.plot(
            peaks[:, *curve.place],
            np.arange(len(names)),
            clip_on=False,
            zorder=3,
            **style,
        )
    dress(ax, "x")
    ax.set_yticks(range(len(names)), [plain_text(name) for name in names])
    ax.set_ylim(len(names) - 0.5, -0.5)


def _label_x(ax: Axes, x: str, values: NDArray[np.float64]) -> None:
    if x.endswith("_deg"):
        degrees(ax, values)
        ax.set_xlabel(labels.SWEPT[x][0])
    else:
        ax.set_xlabel(dimension(x, unit=True))
        ax.xaxis.set_major_locator(MaxNLocator(7, steps=STEPS))
        ax.xaxis.set_major_formatter(FuncFormatter(plain))
        span(ax, values)
