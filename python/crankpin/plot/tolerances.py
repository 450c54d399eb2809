"""Tolerances: distribution of the residual, and shares of the tolerances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.drawing import picture
from crankpin.analysis.ranking import objectives
from crankpin.analysis.tolerances.samples import QUANTILES, Tolerances
from crankpin.plot.layout import add_legend, axes_or_new, inches_of, label_y, set_title
from crankpin.plot.painter import name_rows, x_axis
from crankpin.plot.style import SERIES, font_of, foreground, muted, once, series
from crankpin.plot.ticks import from_zero, numeric
from crankpin.plot.words import objective_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

MOST_BINS = 80
EQUAL_VALUES = 1e-9
"""Relative difference of values that is drawn as none."""
INTERACTION = 0.05
"""Difference of summed shares from 1 that is explained."""
LEAST_SHARE = 0.5
"""Percent below which a tolerance has no entry in the legend."""
NOMINAL = "nominal"


@picture.register(Tolerances)
def _tolerances(
    result: Tolerances,
    ax: Axes | None = None,
    *,
    kind: str = "histogram",
    by: str | None = None,
    label: str | None = None,
    **style: object,
) -> Axes:
    """Draw the distribution of a value, or the shares of the tolerances.

    Parameters
    ----------
    kind : {"histogram", "ecdf", "shares"}, default "histogram"
        ``"histogram"`` or ``"ecdf"`` (the part of the samples up to a value), with the nominal
        value and the 5, 50 and 95 % quantiles; ``"shares"``: bars of each tolerance's share.
    by : str, optional
        A name as in :func:`crankpin.rank`; by default the first of ``by``, of shares all.
    **style : dict, optional
        Keywords of the histogram's, curve's or bars' artists, such as ``label`` and ``color``.
    """
    kinds = {"histogram": _histogram, "ecdf": _ecdf, "shares": None}
    distribution = kinds[inputs.one_of("kind", kind, kinds)]
    if distribution is None:
        return _shares(result, axes_or_new(ax), by, style)
    name = result.by[0] if by is None else by
    values = result.sample_values(name)
    ax = axes_or_new(ax)
    objective = objectives.named(name)
    set_title(ax, labels.name_of(result.engine), _words(result, objective.words))
    (look,) = series(ax, 1, style)
    distribution(ax, values, look, label or f"{result.samples} samples")
    dashed: dict[str, Any] = {"linewidth": 1.2, "linestyle": (0, (4, 2)), "gid": ""}
    dashed |= {"color": foreground(ax), "label": once(ax, NOMINAL)}
    ax.axvline(result.nominal_value(name), **dashed)
    x_axis(ax, objective_words(objective))
    numeric(ax.yaxis)
    add_legend(ax, last=NOMINAL)
    return ax


def _words(result: Tolerances, words: str) -> str:
    """Return what is drawn, of which orders."""
    first, last = result.orders[0], result.orders[-1]
    whole = result.orders == tuple(range(int(first), int(last) + 1)) and last > first + 1
    orders = f"orders {first} to {last}" if whole else labels.orders_text(result.orders)
    return f"{words.replace('all orders', orders)}, {labels.value_text('rpm', result.rpm)}"


def _histogram(ax: Axes, values: NDArray[np.float64], look: dict[str, Any], label: str) -> None:
    """Draw the part of the samples in each of equal intervals; a line at quantiles."""
    counts, edges = np.histogram(values, _edges(values))
    parts = 100.0 * counts / len(values)
    ax.stairs(parts, edges, fill=True, color=look["color"], alpha=0.3)
    ax.stairs(parts, edges, gid=SERIES, label=label, **_of_patches(look))
    before = ax.get_ylim()[1] if len(ax.patches) > 2 else 0.0
    from_zero(ax, max(float(parts.max()), before / 1.08))
    heights = np.interp(at := np.quantile(values, QUANTILES), edges[:-1], parts)
    thin = look | {"linewidth": 0.8, "linestyle": "-"}
    ax.vlines(at, 0.0, heights, colors=thin["color"], linewidth=0.8, label=_quantile_label(ax))
    label_y(ax, "samples, %")


def _edges(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the limits of the intervals; a single one if only rounding distinguishes values."""
    low, high = float(values.min()), float(values.max())
    if high - low <= EQUAL_VALUES * abs(high):
        margin = 0.01 * abs(high) or 1.0
        return np.array([low - margin, high + margin])
    return np.histogram_bin_edges(
        values, min(MOST_BINS, len(np.histogram_bin_edges(values, "auto")) - 1)
    )


def _of_patches(look: dict[str, Any]) -> dict[str, Any]:
    of_line = {
        key: look[key] for key in ("linestyle", "linewidth", "alpha", "zorder") if key in look
    }
    return {"edgecolor": look["color"], "fill": False} | of_line


def _ecdf(ax: Axes, values: NDArray[np.float64], look: dict[str, Any], label: str) -> None:
    """Draw the part of the samples up to each value; dots at quantiles."""
    ordered = np.sort(values)
    parts = 100.0 * np.arange(1, len(values) + 1) / len(values)
    ax.plot(ordered, parts, drawstyle="steps-post", gid=SERIES, label=label, **look)
    at = np.quantile(values, QUANTILES)
    dots: dict[str, Any] = {"marker": "o", "markersize": 4.5, "linestyle": "", "zorder": 4}
    quantiles = 100.0 * np.array(QUANTILES)
    ax.plot(at, quantiles, color=look["color"], label=_quantile_label(ax), gid="", **dots)
    ax.set_ylim(0.0, 100.0)
    label_y(ax, "samples up to a value, %")


def _quantile_label(ax: Axes) -> str:
    """Return the entry of the legend for quantiles, once."""
    text = ", ".join(f"{100 * q:g}" for q in QUANTILES) + " % quantiles"
    return once(ax, text)


def _shares(result: Tolerances, ax: Axes, by: str | None, style: dict[str, Any]) -> Axes:
    """Draw bars from 0 on, one after the other; short of 100 %, or beyond, where they interact."""
    shares = result.shares_of(result.by if by is None else (by,))
    names, *parts, interaction = shares.columns
    rows = np.arange(len(shares))
    name_rows(ax, [_short(objectives.named(str(name))) for name in names.values])
    _fit_rows(ax, len(rows))
    interact = any(abs(share) > INTERACTION for share in interaction.values)
    set_title(
        ax,
        labels.name_of(result.engine),
        "variance that each tolerance makes alone, in % of that of all together",
        "sums differ from 100 % where tolerances interact" if interact else "",
    )
    left = np.zeros(len(rows))
    looks = series(ax, len(parts), style)
    for part, look in zip(parts, looks, strict=True):
        values = np.array(part.values)
        seen = bool((values >= LEAST_SHARE).any())
        bars = {"height": 0.62, "color": look["color"]} | style
        title = part.name if seen else "_"
        ax.barh(rows, values, left=left, label=title, gid=SERIES, **bars)
        left = left + values
    ax.axvline(100.0, color=muted(ax), linewidth=0.8)
    ax.set_xlim(0.0, max(100.0, 1.04 * float(left.max(initial=0.0))))
    x_axis(ax, f"%, {labels.value_text('rpm', result.rpm)}")
    add_legend(ax)
    return ax


def _short(objective: objectives.Objective) -> str:
    """Return the name of a row: there is no room for "shaking" and "rocking"."""
    return objective.head.replace("shaking ", "").replace("rocking ", "")


def _fit_rows(ax: Axes, rows: int) -> None:
    """Write the names of rows in type that is no higher than a row."""
    # Title and legend will leave a third of the height of short axes.
    points = 0.33 * 72.0 * inches_of(ax, "height") / rows
    usual = font_of("ytick.labelsize", "medium").get_size_in_points()
    ax.tick_params(axis="y", labelsize=min(usual, max(4.5, points)))
