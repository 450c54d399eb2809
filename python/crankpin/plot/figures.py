"""Pictures of balances, waveforms, firings and sweeps.

They take axes or make a figure with pyplot, so that notebooks show it, and never show it
themselves. This module is imported when a picture is asked for; matplotlib comes with it.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from crankpin._core import InputError
from crankpin._support import inputs, tables

try:
    import matplotlib as mpl
    from matplotlib import pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine
    from matplotlib.ticker import FuncFormatter, MaxNLocator, MultipleLocator
except ImportError as error:
    raise ImportError('matplotlib is not installed: pip install "crankpin[plot]"') from error

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from crankpin.analysis.balance import Balance
    from crankpin.analysis.firing import Firing
    from crankpin.analysis.rank import Ranking
    from crankpin.analysis.sweep import Quantity, Sweep
    from crankpin.analysis.sweep_waveform import SweepWaveform
    from crankpin.analysis.waveform import Waveform
    from crankpin.model.engine import Engine

AXES: dict[str, tuple[str, ...]] = {
    "force": ("along x", "along y"),
    "moment": ("about x (pitch)", "about y (yaw)"),
    "torque": ("about z (roll)",),
}

# Okabe and Ito's colours, which colour-blind readers tell apart; yellow is too pale for a line.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
GREY = "#555555"
RED = "#C0282D"
"""Exhaust, as charts of valve periods have it; intake is the blue above."""
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (6, 1.5, 1.5, 1.5)))

STEPS = [1, 2, 2.5, 5, 10]
"""Distances of ticks, times a power of ten."""
FEW_POINTS = 40
"""Up to so many points of a sweep are marked."""
FEW_BARS = 16
"""Up to so many bars carry their values."""
NARROW = 4.6
"""Inches below which a legend does not fit beside the title."""


# --- balance: bars ------------------------------------------------------------------------------


def balance(balance: Balance, ax: Axes | None, quantity: str) -> Axes:
    """Draw the peaks of each order as bars, one for each axis."""
    kind = _checked(quantity)
    peaks = np.abs(_by_axis(getattr(balance, kind), kind))
    ax = _given_or_new(ax)
    places = np.arange(len(balance.orders))
    count = peaks.shape[1]
    width = 0.76 / count
    for k, (name, colour) in enumerate(zip(AXES[kind], COLOURS, strict=False)):
        offset = (k - (count - 1) / 2) * width
        bars = ax.bar(places + offset, peaks[:, k], 0.94 * width, color=colour, label=name)
        if peaks.size <= FEW_BARS:
            # Zeros that are exact say so: a missing bar could be a small one.
            texts = [_number(float(f"{peak:.4g}")) for peak in peaks[:, k]]
            ax.bar_label(bars, texts, padding=2, fontsize=8, color=GREY)
    _dress(ax)
    ax.grid(visible=False, axis="x")
    ax.tick_params(axis="x", length=0)
    ax.set_xticks(places, [str(order) for order in balance.orders])
    ax.set_xlabel("order (multiples of crank speed)")
    ax.set_ylabel(f"peak {tables.NAMES[kind]}, {tables.UNITS[kind]}")
    _from_zero(ax, float(peaks.max(initial=0.0)))
    how = "" if balance.spectrum is None else ", spectrum given"
    _entitle(ax, _name(balance.engine), f"{_number(balance.rpm)} rpm{how}")
    return ax


# --- waveform: curves over crank angle ----------------------------------------------------------


def waveform(waveform: Waveform, ax: Axes | None, quantity: str) -> Axes:
    """Draw a quantity over crank angle, one curve for each axis."""
    kind = _checked(quantity)
    values = _by_axis(getattr(waveform, kind), kind)
    ax = _given_or_new(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
    for k, (name, colour) in enumerate(zip(AXES[kind], COLOURS, strict=False)):
        # A curve under another one stays visible at its sides.
        ax.plot(waveform.theta_deg, values[:, k], color=colour, label=name, linewidth=2.6 - 0.9 * k)
    _dress(ax)
    _degrees(ax, waveform.theta_deg)
    ax.set_xlabel("crank angle θ")
    ax.set_ylabel(f"{tables.NAMES[kind]}, {tables.UNITS[kind]}")
    if not values.any():
        ax.set_ylim(-1.0, 1.0)
        ax.set_yticks([0.0])
        _say_zero(ax)
    _entitle(ax, _name(waveform.engine), f"{_number(waveform.rpm)} rpm, {_summed(waveform, kind)}")
    return ax


def _summed(waveform: Waveform | SweepWaveform, kind: Quantity) -> str:
    if waveform.orders is None:
        return "exact kinematics"
    text = "order " if len(waveform.orders) == 1 else "orders "
    text += ", ".join(map(str, waveform.orders)) or "none"
    bound = 0.0 if kind == "torque" else getattr(waveform.error_bound, kind)
    return (
        f"{text} (the rest ≤ {_number(float(f'{bound:.2g}'))} {tables.UNITS[kind]})"
        if bound
        else text
    )


# --- firing: a row for each cylinder -------------------------------------------------------------


def firing(
    firing: Firing,
    ax: Axes | None,
    inlet: str,
    inlets: NDArray[np.float64],
    exhausts: NDArray[np.float64],
) -> Axes:
    """Draw the periods in which cylinders breathe over a cycle, a row for each cylinder."""
    ax = _given_or_new(ax)
    cycle = 180.0 * firing.strokes
    # Bank by bank: who shares a manifold as most engines have it stands together.
    rows = [cylinder - 1 for bank in firing.banks for cylinder in bank]
    bars = [(inlet, COLOURS[0], inlets), ("exhaust open", RED, exhausts)]
    height = 0.8 / len(bars)
    for k, (name, colour, periods) in enumerate(bars):
        for row, (start, end) in enumerate(periods[rows].tolist()):
            # What runs past the end of the cycle goes on at its beginning.
            pieces = [(start, min(end, cycle) - start)]
            if end > cycle:
                pieces.append((0.0, end - cycle))
            place = (row - 0.4 + k * height, height)
            label = name if row == 0 else ""
            ax.broken_barh(pieces, place, facecolors=colour, label=label)
    ax.plot(
        firing.angles_deg[rows],
        range(len(rows)),
        linestyle="",
        marker="D",
        markersize=4.5,
        color="black",
        clip_on=False,
        zorder=3,
        label="fires",
    )
    _dress(ax, "x")
    ax.grid(visible=False, axis="y")
    for end in np.cumsum([len(bank) for bank in firing.banks])[:-1].tolist():
        ax.axhline(end - 0.5, color="#999999", linewidth=0.8)
    ax.set_xlim(0.0, cycle)
    ax.xaxis.set_major_locator(MultipleLocator(90))
    ax.xaxis.set_major_formatter(FuncFormatter(_in_degrees))
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.set_yticks(range(len(rows)), [str(row + 1) for row in rows])
    ax.tick_params(axis="y", length=0, pad=8)
    ax.set_xlabel("crank angle θ")
    ax.set_ylabel("cylinder, bank by bank" if len(firing.banks) > 1 else "cylinder")
    _entitle(ax, _name(firing.engine), tables.cut(firing.summary))
    return ax


# --- sweep: a panel for each order and axis -----------------------------------------------------


class _Grid(Figure):
    """A figure that a notebook shows once.

    pyplot's inline backend shows figures that are open when a cell ends; a figure that is the
    cell's value has been shown by then, and is closed.
    """

    def _ipython_display_(self) -> None:
        if "inline" in mpl.get_backend():
            plt.close(self)
        raise NotImplementedError  # by which IPython goes on to its other ways of showing


class _Curve(NamedTuple):
    """How one combination of swept values is drawn."""

    place: tuple[Any, ...]
    """Picks it from an array whose first axis is along x."""
    style: dict[str, Any]
    coloured_by: int
    dashed_by: int


def sweep(sweep: Sweep, quantity: Quantity, x: str | None) -> Figure:
    """Draw the peaks of each order over a swept quantity, a panel for each order and axis."""
    kind = _checked(quantity)
    dims = list(sweep.coords)
    x = _along_x(sweep, x)
    others = [dim for dim in dims if dim != x]
    peaks = getattr(sweep, "torque_peak" if kind == "torque" else f"{kind}_peak_xy")
    peaks = np.moveaxis(_by_axis(peaks, kind), dims.index(x), 0)
    words = _words(sweep)
    curves = _curves(sweep, others)
    figure, panels = _panels(sweep, kind, x)
    figure.suptitle(f"{words.title}\n{words.subtitle(kind)}", x=0.012, ha="left", fontsize=12)
    for row, order in enumerate(sweep.orders):
        for column, axis in enumerate(AXES[kind]):
            ax = panels[row, column]
            ax.set_title(f"order {order}, {axis}", loc="left", fontsize=10, color=GREY)
            if x == "engine":
                _dots(ax, words.names, peaks[..., row, column], curves)
            else:
                _lines(ax, np.asarray(sweep.coords[x]), peaks[..., row, column], curves)
        unit, largest = f"peak, {tables.UNITS[kind]}", float(peaks[..., row, :].max(initial=0.0))
        if x == "engine":
            _from_zero(panels[row, 0], largest, "x")
            for ax in panels[row]:
                ax.set_xlabel(unit)
        else:
            _from_zero(panels[row, 0], largest)
            panels[row, 0].set_ylabel(unit)
    for ax in panels[-1] if x != "engine" else []:
        _label_x(ax, x, np.asarray(sweep.coords[x]))
    figure.align_ylabels()
    _explain(figure, panels, sweep, others, curves, words)
    return figure


def sweep_waveform(waveform: SweepWaveform, quantity: Quantity) -> Figure:
    """Draw a quantity over crank angle at every point, a panel for each axis."""
    kind, sweep, theta = _checked(quantity), waveform.sweep, waveform.theta_deg
    values = np.moveaxis(_by_axis(getattr(waveform, kind), kind), -2, 0)
    words, dims = _words(sweep), list(sweep.coords)
    curves = _curves(sweep, dims)
    columns = len(AXES[kind])
    figure, panels = plt.subplots(
        1,
        columns,
        figsize=(4.6 * columns + (2.0 if columns == 1 else 0.0), 4.2),
        sharey=True,
        squeeze=False,
        layout=ConstrainedLayoutEngine(w_pad=0.08),
        FigureClass=_Grid,
    )
    title = [words.title, words.subtitle(kind), _summed(waveform, kind)]
    figure.suptitle("\n".join(title), x=0.012, ha="left", fontsize=12)
    for column, axis in enumerate(AXES[kind]):
        ax = panels[0, column]
        ax.set_title(axis, loc="left", fontsize=10, color=GREY)
        ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=1)
        for curve in curves:
            ax.plot(theta, values[(slice(None), *curve.place, column)], zorder=3, **curve.style)
        _dress(ax)
        _degrees(ax, theta)
        ax.set_xlabel("crank angle θ")
        if not values[..., column].any():
            _say_zero(ax)
    panels[0, 0].set_ylabel(f"{tables.NAMES[kind]}, {tables.UNITS[kind]}")
    if not values.any():
        panels[0, 0].set_ylim(-1.0, 1.0)
        panels[0, 0].set_yticks([0.0])
    _explain(figure, panels, sweep, dims, curves, words, marked=False)
    return figure


def _panels(sweep: Sweep, kind: Quantity, x: str) -> tuple[Figure, NDArray[Any]]:
    rows, columns = len(sweep.orders), len(AXES[kind])
    height = 0.9 + 0.27 * len(sweep.coords[x]) if x == "engine" else 2.3
    figure, panels = plt.subplots(
        rows,
        columns,
        figsize=(4.6 * columns + (2.0 if columns == 1 else 0.0), height * rows + 1.5),
        sharex="row" if x == "engine" else True,
        sharey=True if x == "engine" else "row",
        squeeze=False,
        layout=ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.08, hspace=0.03),
        FigureClass=_Grid,
    )
    return figure, panels


def _along_x(sweep: Sweep, x: str | None) -> str:
    swept = {dim: len(values) for dim, values in sweep.coords.items()}
    if not swept:
        raise InputError("nothing was swept: give an array, such as bank_angle_deg=[60, 75, 90]")
    if x is None:
        numeric = {dim: count for dim, count in swept.items() if dim != "engine"} or swept
        return max(numeric, key=lambda dim: numeric[dim])
    if x not in swept:
        raise InputError(f"x = {x!r}: swept were {', '.join(swept)}")
    return x


class _Words(NamedTuple):
    """What a sweep's picture says."""

    names: list[str]
    """Engines, without what they have in common."""
    common: str
    """What the names are: the end of their common words, such as ``firing order``."""
    title: str
    parts: list[str]
    """What was fixed or held."""

    def subtitle(self, kind: Quantity) -> str:
        return ", ".join([tables.NAMES[kind], *self.parts])


def _words(sweep: Sweep) -> _Words:
    parts = [tables.value_text(dim, value) for dim, value in sweep.fixed.items()]
    if sweep.hold is not None:
        parts.append(tables.HELD[sweep.hold])
    full = tables.engine_names(sweep)
    if "engine" not in sweep.coords:
        return _Words([], "", full[0], parts)
    names, shared = _short_names(full)
    title, _, common = shared.rpartition(", ")
    if not title:
        title, common = common, ""
    return _Words(names, common, title or f"{len(names)} engines", parts)


def _short_names(names: list[str]) -> tuple[list[str], str]:
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


def _curves(sweep: Sweep, others: Sequence[str]) -> list[_Curve]:
    """Give every combination a colour by the first of the other dimensions and dashes by the rest.

    A longer row of numbers gets a scale of colours in place of single ones.
    """
    shape = [len(sweep.coords[dim]) for dim in others]
    n_colours = shape[0] if shape else 1
    n_dashes = int(np.prod(shape[1:], dtype=np.int64))
    colours: Sequence[Any] = COLOURS
    if n_colours > len(COLOURS):
        colours = _viridis(n_colours)
    curves = []
    for number, place in enumerate(np.ndindex(*shape)):
        colour, dash = divmod(number, n_dashes)
        style = {"color": colours[colour], "linewidth": 1.8}
        if n_dashes > len(DASHES):  # more than can be told apart: a thin bundle of each colour
            style |= {"linewidth": 0.7, "alpha": 0.6}
        else:
            style["linestyle"] = DASHES[dash]
        curves.append(_Curve(place, style, colour, dash))
    return curves


def _lines(
    ax: Axes, x: NDArray[np.float64], peaks: NDArray[np.float64], curves: list[_Curve]
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
    _dress(ax)
    if not peaks.any():
        _say_zero(ax)


def _dots(ax: Axes, names: list[str], peaks: NDArray[np.float64], curves: list[_Curve]) -> None:
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
    _dress(ax, "x")
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.5, -0.5)


def _label_x(ax: Axes, x: str, values: NDArray[np.float64]) -> None:
    if x.endswith("_deg"):
        _degrees(ax, values)
        ax.set_xlabel(tables.SWEPT[x][0])
    else:
        ax.set_xlabel(_dimension(x, unit=True))
        ax.xaxis.set_major_locator(MaxNLocator(7, steps=STEPS))
        ax.xaxis.set_major_formatter(FuncFormatter(_plain))
        _span(ax, values)


def _explain(
    figure: Figure,
    panels: NDArray[Any],
    sweep: Sweep,
    others: Sequence[str],
    curves: list[_Curve],
    words: _Words,
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
        labels = words.names if first == "engine" else _values(sweep, [first])
        seen = {curve.coloured_by: curve for curve in reversed(curves)}
        handles += [
            mpl.lines.Line2D(
                [], [], color=seen[k].style["color"], lw=2, marker=marker, ms=4, label=label
            )
            for k, label in enumerate(labels)
        ]
    dashes = _values(sweep, rest)
    if rest and len(dashes) <= len(DASHES):
        handles += [
            mpl.lines.Line2D([], [], color=GREY, lw=1.6, linestyle=DASHES[k], label=label)
            for k, label in enumerate(dashes)
        ]
    elif rest:
        what = ", ".join(f"{len(sweep.coords[dim])} × {_dimension(dim)}" for dim in rest)
        handles.append(mpl.lines.Line2D([], [], color=GREY, lw=0.7, label=f"each: {what}"))
    if handles:
        longest = max(len(handle.get_label()) for handle in handles)
        fitting = max(1, int(figure.get_figwidth() * 11 / (longest + 7)))
        figure.legend(
            handles=handles,
            title=words.common if first == "engine" else None,
            loc="outside lower center",
            ncols=fitting,
            frameon=False,
            fontsize=9.5,
        )


def _values(sweep: Sweep, dims: Sequence[str]) -> list[str]:
    each = [
        [
            str(value) if dim == "engine" else tables.value_text(dim, float(value))
            for value in sweep.coords[dim]
        ]
        for dim in dims
    ]
    return [", ".join(parts) for parts in itertools.product(*each)]


def _dimension(dim: str, *, unit: bool = False) -> str:
    if dim == "engine":
        return "engine"
    name, symbol = tables.SWEPT[dim]
    # Degrees stand at the numbers.
    symbol = symbol.strip(" °") if unit else ""
    return ", ".join(part for part in (name or "crank speed", symbol) if part)


def _viridis(count: int) -> list[Any]:
    return list(mpl.colormaps["viridis"](np.linspace(0.0, 0.92, count)))  # not its palest yellow


def _colour_scale(
    figure: Figure, panels: NDArray[Any], dim: str, values: NDArray[np.float64]
) -> None:
    # Colours go by place in the list, so that the scale is right for uneven steps too.
    n = len(values)
    colours = mpl.colors.ListedColormap(_viridis(n))
    mappable = mpl.cm.ScalarMappable(mpl.colors.BoundaryNorm(np.arange(n + 1) - 0.5, n), colours)
    bar = figure.colorbar(mappable, ax=panels.ravel().tolist(), aspect=35, pad=0.02)
    shown = np.unique(np.linspace(0, n - 1, min(n, 9)).round().astype(int))
    degrees = "°" if dim.endswith("_deg") else ""
    bar.set_ticks(shown.tolist(), labels=[_number(values[k]) + degrees for k in shown])
    bar.ax.tick_params(length=0)
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.set_label(_dimension(dim, unit=True))


# --- ranking: curves over bank angle, their lowest points ringed ---------------------------------


def ranking(ranking: Ranking, ax: Axes | None) -> Axes:
    """Draw the first objective of each engine over bank angle, a ring where it is best.

    Engines that were taken as they are: a dot each over their own bank angles, or, where these do
    not tell them apart, below each other.
    """
    ax = _given_or_new(ax)
    names, shared = _short_names(list(ranking.names))
    title, _, common = shared.rpartition(", ")
    title = ranking.names[0] if len(names) == 1 else title or f"{len(names)} engines"
    heights = np.where(np.isfinite(ranking.values), ranking.values, np.nan)
    angles = ranking.bank_angles_deg
    along: Literal["x", "y"] = "y"
    if angles is not None:
        _angle_curves(ax, angles, names, heights)
        # Between the given angles an engine may be better than at them.
        rings = [(angle, each.value) for each in ranking for angle in each.bank_angles_deg]
    else:
        first = {each.name for each in ranking if each.place == 1}
        places = ranking._own_angles_deg
        if np.unique(places[np.isfinite(places)]).size < 2:
            places, along = np.arange(len(names), dtype=np.float64), "x"
        rings = [
            (float(places[k]), float(heights[k, 0]))
            for k, name in enumerate(ranking.names)
            if name in first
        ]
        angles = places
        _dot(ax, places, heights[:, 0], along, {"color": COLOURS[0], "markersize": 4, "zorder": 3})
    ring = {"color": "black", "markerfacecolor": "none", "markersize": 11, "zorder": 4}
    _dot(ax, [place for place, _ in rings], [value for _, value in rings], along, ring)
    label = f"{ranking.by[0]}, {ranking.unit}".rstrip(", ")
    if along == "x":
        _dress(ax, "x")
        ax.set_yticks(range(len(names)), names)
        ax.set_ylim(len(names) - 0.5, -0.5)
        ax.set_xlabel(label)
    else:
        _dress(ax)
        _degrees(ax, angles[np.isfinite(angles)])
        ax.set_xlabel(f"bank angle, {ranking.hold} held" if ranking.hold else "bank angle")
        ax.set_ylabel(label)
    if not (heights < 0.0).any():
        largest = float(np.nanmax(np.append(heights, 0.0)))
        _from_zero(ax, largest, along)
    ax.set_title(f"{title}\n{tables.cut(ranking._told(1), 80)}", loc="left", fontsize=11)
    if len(ax.get_legend_handles_labels()[1]) > 1:
        ax.legend(loc="best", fontsize=8, title=common or None, title_fontsize=8)
    return ax


def _dot(ax: Axes, places: Any, values: Any, along: str, style: dict[str, Any]) -> None:  # noqa: ANN401
    across, up = (values, places) if along == "x" else (places, values)
    ax.plot(across, up, marker="o", linestyle="", clip_on=False, **style)


def _angle_curves(
    ax: Axes, angles: NDArray[np.float64], names: list[str], heights: NDArray[np.float64]
) -> None:
    few = len(names) <= len(COLOURS)
    colours: Sequence[Any] = COLOURS if few else _viridis(len(names))
    in_order = np.argsort(angles, kind="stable")
    for k, (name, row) in enumerate(zip(names, heights, strict=True)):
        style: dict[str, Any] = {"color": colours[k], "zorder": 3, "clip_on": False}
        if few:
            # A curve under another one is seen through its gaps.
            style |= {"label": name, "linestyle": "-" if k % 2 == 0 else DASHES[1]}
            style |= {"marker": "o", "markersize": 3.2} if len(angles) <= FEW_POINTS else {}
        else:
            style |= {"linewidth": 0.8}
        ax.plot(angles[in_order], row[in_order], **style)


# --- what all have in common --------------------------------------------------------------------


def _checked(quantity: str) -> Quantity:
    if quantity not in AXES:
        raise InputError(f'quantity = {quantity!r}: give "force", "moment" or "torque"')
    return quantity  # type: ignore[return-value]


def _by_axis(values: NDArray[Any], kind: Quantity) -> NDArray[Any]:
    return values[..., np.newaxis] if kind == "torque" else values


def _name(engine: Engine) -> str:
    return engine.name or f"{len(engine)} cylinders"


def _given_or_new(ax: Axes | None) -> Axes:
    if ax is not None:
        if not isinstance(ax, Axes):
            raise InputError(f"ax = {inputs.shorten(ax)}: give matplotlib axes")
        return ax
    return plt.subplots(figsize=(7.2, 4.2), layout="constrained")[1]


def _dress(ax: Axes, along: Literal["x", "y"] = "y") -> None:
    """Make grid and frame light, and write numbers along the axis of the quantity."""
    ax.grid(visible=True, color="#DDDDDD", linewidth=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color("#999999")
    ax.tick_params(color="#999999")
    axis = ax.yaxis if along == "y" else ax.xaxis
    axis.set_major_locator(MaxNLocator(5, steps=STEPS))
    axis.set_major_formatter(FuncFormatter(_plain))


def _from_zero(ax: Axes, largest: float, along: Literal["x", "y"] = "y") -> None:
    top = 1.08 * largest or 1.0
    if along == "x":
        ax.set_xlim(0.0, top)
    else:
        ax.set_ylim(0.0, top)
    if not largest:  # a scale of nothing would mislead
        (ax.xaxis if along == "x" else ax.yaxis).set_ticks([0.0])


def _say_zero(ax: Axes) -> None:
    ax.text(0.5, 0.56, "zero throughout", transform=ax.transAxes, ha="center", color=GREY)


def _degrees(ax: Axes, values: NDArray[np.float64]) -> None:
    span = _span(ax, values)
    for step, widest in ((15, 100), (30, 200), (60, 400), (90, 800), (180, 1600)):
        if 3 * step <= span <= widest:
            ax.xaxis.set_major_locator(MultipleLocator(step))
            break
    ax.xaxis.set_major_formatter(FuncFormatter(_in_degrees))


def _span(ax: Axes, values: NDArray[np.float64]) -> float:
    low, high = float(values.min(initial=np.inf)), float(values.max(initial=-np.inf))
    if high > low:
        ax.set_xlim(low, high)
    return high - low


def _entitle(ax: Axes, title: str, subtitle: str) -> None:
    """Put the title above the axes on the left, the legend beside its second line."""
    ax.set_title(f"{title}\n{subtitle}", loc="left", fontsize=11)
    if len(ax.get_legend_handles_labels()[1]) > 1:
        width = ax.get_window_extent().width / ax.get_figure(root=True).dpi  # type: ignore[union-attr]
        if width < NARROW:
            ax.legend(loc="best", fontsize=8)
        else:
            ax.legend(
                loc="lower right",
                bbox_to_anchor=(1.0, 1.0),
                ncols=2,
                frameon=False,
                borderaxespad=0.1,
            )


def _plain(value: float, _: object = None) -> str:
    return _number(value)


def _in_degrees(value: float, _: object = None) -> str:
    return f"{_number(value)}°"


def _number(value: float) -> str:
    """Write 12000.0 as 12 000, and minus as minus."""
    text = f"{value:,.10g}" if abs(value) >= 1e4 else f"{value:.10g}"
    return text.replace(",", "\N{NO-BREAK SPACE}").replace("-", "−")
