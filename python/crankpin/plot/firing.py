"""Firings: strokes and open valves or ports over a cycle, a row for each cylinder."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Patch

from crankpin._support import labels
from crankpin._support.drawing import picture
from crankpin.analysis.firing import Firing, Gaps
from crankpin.plot import ticks
from crankpin.plot.layout import add_legend, axes_or_new, label_x, label_y, points_of, set_title
from crankpin.plot.style import background, blend, font_of, foreground, is_dark, muted, write

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from numpy.typing import ArrayLike, NDArray

    from crankpin.analysis.gas_exchange import Timing

STROKE_COLOURS = {
    "power": ("#d55e00", "#e8743b"), "exhaust": ("#9aa0a6", "#7d838a"),
    "intake": ("#4ba3dc", "#56b4e9"), "compression": ("#e6b800", "#dcb53a"),
}  # fmt: skip
"""Colours of strokes on light and dark backgrounds: in any style those of the turning page."""
LETTER = "black"
"""Colour of letters on strokes, in either of their colours."""
ALONE = (-0.3, 0.6)
"""Upper edge and height of the strokes in the row of a cylinder, which is 1 high."""
STROKES = (-0.44, 0.5)
"""The same where valves or ports stand below."""
INLETS = (0.1, 0.15)
EXHAUSTS = (0.28, 0.15)
SMALL_LEGEND: dict[str, Any] = {"fontsize": "x-small", "handlelength": 1.2}
"""Legend of charts with rows too low for letters."""
ROW = 0.24
"""Inches of a row that suffice for letters."""


class Kind(NamedTuple):
    """Periods of one kind, a row for each cylinder by number."""

    name: str
    colour: Any
    periods: NDArray[np.float64]
    place: tuple[float, float]
    letter: str = ""


@picture.register(Firing)
def _firing(
    result: Firing, ax: Axes | None = None, *, timing: Timing | None = None, **style: object
) -> Axes:
    """Draw strokes, and with a timing open valves or ports, over a cycle.

    A row for each cylinder, bank by bank: its strokes with a mark where it fires, and below
    them intake valves (transfer ports) and exhausts. Exhausts that are open at one time in
    one bank are hatched.

    Parameters
    ----------
    timing : ValveTiming or PortTiming, optional
        When valves or ports open and close; by default they are not drawn.
    **style : dict, optional
        Passed on to the bars, such as ``edgecolor=``.
    """
    rows = [cylinder for bank in result.banks for cylinder in bank]
    room = 1.0 if ax is None else 0.55  # the legend of given axes will take its part
    new, ax = ax is None, axes_or_new(ax)
    if new:
        _make_room(ax, len(rows))
    row_height = room * _row_height(ax, len(rows))
    faces = {name: pair[is_dark(ax)] for name, pair in STROKE_COLOURS.items()}
    place = ALONE if timing is None else STROKES
    strokes = [
        Kind(name, faces[name], periods, place, name[0].upper())
        for name, periods in result.strokes_deg().items()
    ]
    opened = []
    if timing is not None:
        inlet_name, inlets, exhausts = _openings(result, timing)
        inlet, exhaust = (
            blend(faces[valve], foreground(ax), 0.75) for valve in ("intake", "exhaust")
        )
        opened = [
            Kind(f"{inlet_name} open", inlet, inlets, INLETS),
            Kind("exhaust open", exhaust, exhausts, EXHAUSTS),
        ]
    cycle = 180.0 * result.strokes
    lettered = row_height >= ROW
    handles: list[Any] = []
    for kind in (*strokes, *opened):
        looks = {"facecolor": kind.colour, "edgecolor": "none"}
        if kind.letter:
            looks |= {"edgecolor": background(ax), "linewidth": 0.8}
        for row, cylinder in enumerate(rows):
            pieces = _pieces(kind.periods[cylinder - 1], cycle)
            _bars(ax, pieces, row, kind.place, **(looks | style))
            if kind.letter and lettered:
                _letters(ax, kind, pieces, _middle(row, place))
        name = f"{kind.letter}: {kind.name}" if kind.letter and lettered else kind.name
        handles.append(Patch(label=name, **(looks | {"edgecolor": "none"} | style)))
    if timing is not None:
        overlaps = result.exhaust_overlaps(timing=timing)
        handles += _mark_overlaps(ax, overlaps, exhausts, rows, cycle)
    handles += _mark_firings(
        ax, [(rows.index(number), result.angles_deg[number - 1]) for number in result.order],
        _middle(0.0, place),
    )  # fmt: skip
    _dress(ax, result, rows, row_height)
    set_title(ax, labels.name_of(result.engine), labels.cut(result.summary))
    add_legend(ax, handles=handles, **({} if lettered else SMALL_LEGEND))
    return ax


def _openings(
    result: Firing, timing: Timing
) -> tuple[str, NDArray[np.float64], NDArray[np.float64]]:
    """Return the name of the inlet, and the periods in which inlets and exhausts are open."""
    if result.strokes == 2:
        ports = result.ports(timing)  # type: ignore[arg-type]
        return "transfer", ports["transfer"], ports["exhaust"]
    valves = result.valves(timing)  # type: ignore[arg-type]
    return "intake", valves["intake"], valves["exhaust"]


def _pieces(period: ArrayLike, cycle: float) -> list[tuple[float, float]]:
    """Return start and length of a period; past the end of the cycle it goes on at its start."""
    start, end = np.asarray(period, dtype=np.float64).tolist()
    if end <= cycle:
        return [(start, end - start)]
    return [(start, cycle - start), (0.0, end - cycle)]


def _bars(
    ax: Axes,
    pieces: Sequence[tuple[float, float]],
    row: int,
    place: tuple[float, float],
    **style: Any,  # noqa: ANN401 - of matplotlib
) -> None:
    if "color" in style:  # of faces and edges; matplotlib warns of both
        style = {
            key: value for key, value in style.items() if key not in {"facecolor", "edgecolor"}
        }
    top, height = place
    ax.broken_barh(pieces, (row + top, height), **style)


def _middle(row: float, place: tuple[float, float]) -> float:
    top, height = place
    return row + top + 0.5 * height


def _letters(ax: Axes, kind: Kind, pieces: Iterable[tuple[float, float]], middle: float) -> None:
    for start, length in pieces:
        if length >= 45.0:
            at = complex(start + 0.5 * length, middle)
            look = {"va": "center_baseline", "fontsize": "x-small", "color": LETTER}
            write(ax, kind.letter, at, 0j, gid=kind.name, **look)


def _mark_overlaps(
    ax: Axes, overlaps: Sequence[Gaps], exhausts: NDArray[np.float64], rows: list[int], cycle: float
) -> list[Any]:
    """Hatch both exhausts where two of a bank are open at one time; return a legend's handle."""
    looks = {
        "facecolor": "none", "edgecolor": foreground(ax), "hatch": "////", "linewidth": 0.6,
        "zorder": 3,
    }  # fmt: skip
    overlapping = [
        (pair, overlap) for bank in overlaps for pair, overlap in bank.items() if overlap
    ]
    for pair, overlap in overlapping:
        start = float(exhausts[pair[1] - 1, 0])
        pieces = _pieces((start, start + overlap), cycle)
        for cylinder in set(pair):
            _bars(ax, pieces, rows.index(cylinder), EXHAUSTS, **looks)
    return [Patch(label="exhausts overlap", **looks)] if overlapping else []


def _mark_firings(ax: Axes, places: Sequence[tuple[int, float]], middle: float) -> list[Line2D]:
    rows, angles = zip(*sorted(places), strict=True)
    return ax.plot(
        angles,
        np.array(rows) + middle,
        linestyle="",
        marker="D",
        markersize=5.0,
        color=foreground(ax),
        markeredgecolor=background(ax),
        clip_on=False,
        zorder=4,
        label="fires",
    )


def _dress(ax: Axes, result: Firing, rows: list[int], row_height: float) -> None:
    ax.set_axisbelow(True)
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0.0, 180.0 * result.strokes)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ticks.degrees(ax.xaxis)
    ax.set_yticks(range(len(rows)), [str(cylinder) for cylinder in rows])
    ax.tick_params(axis="y", length=0)
    label_x(ax, "crank angle θ")
    if row_height < ROW:
        size = font_of("ytick.labelsize", "medium").get_size_in_points()
        ax.tick_params(axis="y", labelsize=min(size, max(5.0, 65.0 * row_height)))
    spacious = len(result.banks) > 1 and row_height >= ROW
    label_y(ax, "cylinder, bank by bank" if spacious else "cylinder")
    first = 0
    names = {numbers: name for name, numbers in result.engine.banks.items()}
    for bank in result.banks:
        if first:
            ax.axhline(first - 0.5, color=muted(ax), linewidth=0.8, linestyle="-")
        name = names.get(bank, "") if len(result.banks) > 1 else ""
        room = 0.75 * 72.0 * row_height * len(bank)
        if points_of(ax, name, FontProperties(size="small")) < room:
            ax.text(
                1.01,
                first + 0.5 * (len(bank) - 1),
                name,
                transform=ax.get_yaxis_transform(),
                rotation=270,
                va="center",
                fontsize="small",
                color=muted(ax),
            )
        first += len(bank)


def _row_height(ax: Axes, rows: int) -> float:
    """Return the height of a row, inches."""
    return float(ax.get_window_extent().height / ax.get_figure(root=True).dpi / rows)  # type: ignore[union-attr]


def _make_room(ax: Axes, rows: int) -> None:
    """Make a new figure high enough for its rows."""
    figure = ax.get_figure(root=True)
    assert figure is not None  # noqa: S101 - the axes are new
    figure.set_figheight(max(figure.get_figheight(), 1.2 * ROW * rows + 1.6))
