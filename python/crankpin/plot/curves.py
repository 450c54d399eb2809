"""Curves over swept dimensions: their colours, dashes, names and legend."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib as mpl
import numpy as np

from crankpin._support import labels
from crankpin.analysis.sweep import engine_titles
from crankpin.plot._old import COLOURS, DASHES, GREY, number, plain_text, viridis

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from crankpin.analysis.sweep import Sweep


class Curve(NamedTuple):
    """How one combination of swept values is drawn."""

    place: tuple[Any, ...]
    """Picks it from an array whose first axis is along x."""
    style: dict[str, Any]
    coloured_by: int
    dashed_by: int


class Words(NamedTuple):
    """What a sweep's picture says."""

    names: list[str]
    """Engines, without what they have in common."""
    common: str
    """What the names are: the end of their common words, such as ``firing order``."""
    title: str
    parts: list[str]
    """What was fixed or held."""

    def subtitle(self, quantity: str) -> str:
        """Return the quantity and the arguments that are fixed or held."""
        return ", ".join([labels.NAMES[quantity], *self.parts])


def words_of(sweep: Sweep) -> Words:
    """Return the words of a sweep's picture."""
    parts = [labels.value_text(dim, value) for dim, value in sweep.fixed.items()]
    if sweep.hold is not None:
        parts.append(labels.HELD[sweep.hold])
    full = engine_titles(sweep)
    if "engine" not in sweep.coords:
        return Words([], "", full[0], parts)
    names, shared = short_names(full)
    title, _, common = shared.rpartition(", ")
    if not title:
        title, common = common, ""
    return Words(names, common, title or f"{len(names)} engines", parts)


def short_names(names: list[str]) -> tuple[list[str], str]:
    """Return names without the words they share at either end, and these words."""
    words = [name.split() for name in names]
    shortest = min(len(each) for each in words) - 1
    head = tail = 0
    if len(set(names)) > 1:
        while head < shortest and len({each[head] for each in words}) == 1:
            head += 1
        while tail < shortest - head and len({each[-1 - tail] for each in words}) == 1:
            tail += 1
    shared = words[0][:head] + words[0][len(words[0]) - tail :]
    short = [" ".join(each[head : len(each) - tail]).strip(",;:") for each in words]
    return short, " ".join(shared).rstrip(",;:")


def curves_of(sweep: Sweep, others: Sequence[str]) -> list[Curve]:
    """Give every combination a colour by the first of the other dimensions and dashes by the rest.

    A longer row of numbers gets a scale of colours in place of single ones.
    """
    shape = [len(sweep.coords[dim]) for dim in others]
    n_colours = shape[0] if shape else 1
    n_dashes = int(np.prod(shape[1:], dtype=np.int64))
    colours: Sequence[Any] = COLOURS
    if n_colours > len(COLOURS):
        colours = viridis(n_colours)
    curves = []
    for k, place in enumerate(np.ndindex(*shape)):
        colour, dash = divmod(k, n_dashes)
        style = {"color": colours[colour], "linewidth": 1.8}
        if n_dashes > len(DASHES):  # more than can be told apart: a thin bundle of each colour
            style |= {"linewidth": 0.7, "alpha": 0.6}
        else:
            style["linestyle"] = DASHES[dash]
        curves.append(Curve(place, style, colour, dash))
    return curves


def explain(
    figure: Figure,
    panels: NDArray[Any],
    sweep: Sweep,
    others: Sequence[str],
    curves: list[Curve],
    words: Words,
    *,
    marked: bool = True,
) -> None:
    """Say once what colours and dashes mean."""
    if not others:
        return
    first, *rest = others
    handles: list[Any] = []
    marker = "o" if marked and len(curves) <= len(COLOURS) else None
    if first != "engine" and len(sweep.coords[first]) > len(COLOURS):
        _colour_scale(figure, panels, first, np.asarray(sweep.coords[first]))
    else:
        texts = words.names if first == "engine" else values_of(sweep, [first])
        seen = {curve.coloured_by: curve for curve in reversed(curves)}
        handles += [
            mpl.lines.Line2D(
                [],
                [],
                color=seen[k].style["color"],
                lw=2,
                marker=marker,
                ms=4,
                label=plain_text(label),
            )
            for k, label in enumerate(texts)
        ]
    dashes = values_of(sweep, rest)
    if rest and len(dashes) <= len(DASHES):
        handles += [
            mpl.lines.Line2D([], [], color=GREY, lw=1.6, linestyle=DASHES[k], label=label)
            for k, label in enumerate(dashes)
        ]
    elif rest:
        what = ", ".join(f"{len(sweep.coords[dim])} × {dimension(dim)}" for dim in rest)
        handles.append(mpl.lines.Line2D([], [], color=GREY, lw=0.7, label=f"each: {what}"))
    if handles:
        longest = max(len(handle.get_label()) for handle in handles)
        fitting = max(1, int(figure.get_figwidth() * 11 / (longest + 7)))
        figure.legend(
            handles=handles,
            title=plain_text(words.common) if first == "engine" else None,
            loc="outside lower center",
            ncols=fitting,
            frameon=False,
            fontsize=9.5,
        )


def values_of(sweep: Sweep, dims: Sequence[str]) -> list[str]:
    """Return each combination of swept values as text."""
    each = [
        [
            str(value) if dim == "engine" else labels.value_text(dim, float(value))
            for value in sweep.coords[dim]
        ]
        for dim in dims
    ]
    return [", ".join(parts) for parts in itertools.product(*each)]


def dimension(dim: str, *, unit: bool = False) -> str:
    """Return the name of a dimension, with its unit if asked."""
    if dim == "engine":
        return "engine"
    name, symbol = labels.SWEPT[dim]
    # Degrees stand at the numbers.
    symbol = symbol.strip(" °") if unit else ""
    return ", ".join(part for part in (name or "crank speed", symbol) if part)


def _colour_scale(
    figure: Figure, panels: NDArray[Any], dim: str, values: NDArray[np.float64]
) -> None:
    # Colours go by place in the list, so that the scale is right for uneven steps too.
    n = len(values)
    colours = mpl.colors.ListedColormap(viridis(n))
    mappable = mpl.cm.ScalarMappable(mpl.colors.BoundaryNorm(np.arange(n + 1) - 0.5, n), colours)
    bar = figure.colorbar(mappable, ax=panels.ravel().tolist(), aspect=35, pad=0.02)
    shown = np.unique(np.linspace(0, n - 1, min(n, 9)).round().astype(int))
    degrees = "°" if dim.endswith("_deg") else ""
    bar.set_ticks(shown.tolist(), labels=[number(values[k]) + degrees for k in shown])
    bar.ax.tick_params(length=0)
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.set_label(dimension(dim, unit=True))
