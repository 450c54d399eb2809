"""Curves of a sweep: a look and a name for every combination of swept values."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D

from crankpin.plot.rows import Words, dimension, values_of
from crankpin.plot.style import DASHES, MOST_TOLD_APART, cycle, foreground, muted, scale, series
from crankpin.plot.ticks import RoundLocator
from crankpin.plot.words import in_degrees, number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from crankpin.analysis.sweeps.sweep import Sweep

MOST_DASHES = 4
"""Number of dashes that are used beside colours of another meaning."""
NAMED = 5
"""Engines with a name in the legend where there are too many for all."""
THIN: dict[str, Any] = {"linewidth": 0.8, "linestyle": "-"}


class Curve(NamedTuple):
    """How one combination of swept values is drawn."""

    place: tuple[Any, ...]
    """Picks it from an array without the dimension along x."""
    style: dict[str, Any]
    name: str
    """Its entry in a legend; empty for none."""


class Bundle(NamedTuple):
    """All curves of a panel, and what their looks mean."""

    curves: list[Curve]
    handles: list[Line2D]
    """Entries of a legend for several panels."""
    scale: str | None
    """Dimension that a scale of colours stands for."""


def bundle_of(
    ax: Axes,
    sweep: Sweep,
    others: Sequence[str],
    words: Words,
    sizes: NDArray[np.float64],
    style: Mapping[str, Any],
) -> Bundle:
    """Give every combination of the other dimensions its look.

    One dimension: successive colours and dashes; if it is long, a scale of colours for numbers,
    and the ``NAMED`` engines with the least of ``sizes`` named among thin lines of the others.
    More dimensions: colours by the first, dashes by the rest, or thin lines if they are many.
    """
    lengths = [len(sweep.coords[dim]) for dim in others]
    places = list(np.ndindex(*lengths))
    label = str(style.get("label") or "")
    given = {name: value for name, value in style.items() if name != "label"}
    if not others:
        (look,) = series(ax, 1, given)
        return Bundle([Curve((), look, label)], [], None)
    texts = [values_of(sweep, dim, words) for dim in others]
    names = [", ".join(filter(None, [label, *parts])) for parts in itertools.product(*texts)]
    if len(others) == 1 and (others[0] == "engine" or len(places) <= MOST_TOLD_APART):
        return Bundle(*engine_looks(ax, names, sizes, given), None)
    n_rest = len(places) // lengths[0]
    few = lengths[0] <= MOST_TOLD_APART
    colours = [entry["color"] for entry in cycle(ax)] if few else scale(ax, lengths[0])
    looks = []
    for k in range(len(places)):
        colour, dash = divmod(k, n_rest)
        thin = THIN if n_rest > MOST_DASHES else {"linestyle": DASHES[dash]}
        looks.append({"color": colours[colour % len(colours)]} | thin | given)
    handles = [
        Line2D([], [], color=colour, label=text)
        for colour, text in zip(colours, texts[0], strict=False)
        if few
    ]
    if 1 < n_rest <= MOST_DASHES:
        rest = [", ".join(parts) for parts in itertools.product(*texts[1:])]
        grey = muted(ax)
        handles += [
            Line2D([], [], color=grey, linestyle=DASHES[k], label=text)
            for k, text in enumerate(rest)
        ]
    elif n_rest > 1:
        what = " × ".join(f"{len(sweep.coords[dim])} of {dimension(dim)}" for dim in others[1:])
        handles.append(Line2D([], [], color=muted(ax), **THIN, label=f"each: {what}"))
    told_apart = few and n_rest <= MOST_DASHES
    drawn = names if told_apart else [""] * len(names)
    return Bundle(_zipped(places, looks, drawn), handles, None if few else others[0])


def _zipped(
    places: Sequence[tuple[Any, ...]], looks: Sequence[dict[str, Any]], names: Sequence[str]
) -> list[Curve]:
    return [Curve(*each) for each in zip(places, looks, names, strict=True)]


def engine_looks(
    ax: Axes, names: Sequence[str], sizes: NDArray[np.float64], style: Mapping[str, Any]
) -> tuple[list[Curve], list[Line2D]]:
    """Give each engine successive colours and dashes; of many, the ones with the least sizes.

    The others are thin lines below them, with one entry in the legend.
    """
    count = len(names) if len(names) <= MOST_TOLD_APART else NAMED
    kept = sorted(np.argsort(sizes, kind="stable")[:count].tolist())
    looks = series(ax, count, style)
    curves = [Curve((k,), look, names[k]) for k, look in zip(kept, looks, strict=True)]
    handles = [Line2D([], [], **curve.style, label=curve.name) for curve in curves]
    rest = [k for k in range(len(names)) if k not in kept]
    if rest:
        grey: dict[str, Any] = {"color": muted(ax, 0.35), "zorder": 1.9, **THIN}
        text = f"{len(rest)} others"
        handles.append(Line2D([], [], **grey, label=text))
        thin = [Curve((k,), grey, text if k == rest[0] else "") for k in rest]
        curves += thin
    return curves, handles


def colour_scale(panels: NDArray[Any], sweep: Sweep, dim: str) -> None:
    """Put a scale of the colours of a swept dimension beside panels.

    Colours go by place in the list, so that the scale is right for uneven steps too.
    """
    values = np.asarray(sweep.coords[dim], dtype=np.float64)
    order, count = np.argsort(values, kind="stable"), len(values)
    first = panels.flat[0]
    colours = ListedColormap(np.array(scale(first, count))[order])
    mappable = ScalarMappable(BoundaryNorm(np.arange(count + 1) - 0.5, count), colours)
    figure = first.get_figure(root=False)
    bar = figure.colorbar(mappable, ax=panels.ravel().tolist(), aspect=35, pad=0.02)
    ticks = np.array(RoundLocator(6).tick_values(values.min(), values.max()))
    ticks = ticks[(ticks >= values.min()) & (ticks <= values.max())]
    written = in_degrees if dim.endswith("_deg") else number
    where = np.interp(ticks, values[order], np.arange(count))
    bar.set_ticks(where.tolist(), labels=[written(float(f"{tick:.10g}")) for tick in ticks])
    bar.ax.minorticks_off()
    bar.set_label(dimension(dim), color=foreground(first))
