"""Does the chart of a firing show strokes, openings and overlaps as the firing has them?"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import crankpin as cp
import matplotlib as mpl
import numpy as np
import pytest
from crankpin.view.page import WEB
from matplotlib import pyplot as plt
from matplotlib.collections import PolyCollection
from support import in_turn

if TYPE_CHECKING:
    from matplotlib.axes import Axes

V8 = cp.Engine.preset("v8-crossplane").firing()
TWO = cp.Engine.preset("boxer-4").firing("1+2-3+4", strokes=2)

Bars = dict[str, set[tuple[int, float, float]]]


def drawn(ax: Axes) -> Bars:
    """Every bar by the name of its colour or hatch in the legend: cylinder, start and end."""
    legend = ax.get_legend()
    assert legend is not None
    names: dict[Any, str] = {}
    for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
        if isinstance(handle, mpl.patches.Patch):
            name = text.get_text().rpartition(": ")[2]
            names[mpl.colors.to_hex(handle.get_facecolor(), True), handle.get_hatch()] = name
    rows = [int(label.get_text()) for label in ax.get_yticklabels()]
    found: Bars = {name: set() for name in names.values()}
    for bars in ax.collections:
        assert isinstance(bars, PolyCollection)
        colour = (
            mpl.colors.to_hex(np.asarray(bars.get_facecolor())[0], True)
            if len(bars.get_facecolor())
            else "#00000000"
        )
        name = names[colour, bars.get_hatch()]
        for path in bars.get_paths():
            vertices = np.asarray(path.vertices)
            (x0, y0), (x1, _) = vertices.min(axis=0), vertices.max(axis=0)
            found[name].add((rows[int(np.floor(y0 + 0.5))], float(x0), float(x1)))
    return found


def wrapped(periods: Any, cycle: float) -> set[tuple[int, float, float]]:  # noqa: ANN401
    """Periods by cylinder, cut at the end of the cycle."""
    found = set()
    for cylinder, (start, end) in enumerate(periods.tolist(), start=1):
        found.add((cylinder, start, min(end, cycle)))
        if end > cycle:
            found.add((cylinder, 0.0, end - cycle))
    return found


def test_it_shows_strokes_and_open_valves() -> None:
    assert "intake open" not in drawn(V8.plot())  # nobody gave a timing
    ax = V8.plot(timing=cp.ValveTiming())
    found = drawn(ax)
    for name, periods in V8.strokes_deg().items():
        assert found[name] == wrapped(periods, 720.0)
    assert found["intake open"] == wrapped(V8.valves()["intake"], 720.0)
    assert found["exhaust open"] == wrapped(V8.valves()["exhaust"], 720.0)


def test_cylinders_stand_bank_by_bank_and_fire_where_marked() -> None:
    ax = V8.plot()
    rows = [1, 3, 5, 7, 2, 4, 6, 8]
    assert [label.get_text() for label in ax.get_yticklabels()] == [str(row) for row in rows]
    fires = next(line for line in ax.lines if line.get_label() == "fires")
    assert np.asarray(fires.get_xdata()).tolist() == [V8.angles_deg[row - 1] for row in rows]
    assert np.floor(np.asarray(fires.get_ydata()) + 0.5).tolist() == list(range(8))
    assert ax.get_xlim() == (0.0, 720.0)
    assert ax.get_title(loc="left") == "V8 90°, cross-plane\n4-stroke 1-8-4-3-6-5-7-2, even, 90°"
    texts = [text.get_text() for text in ax.texts]
    assert [text for text in texts if len(text) > 1] == ["left", "right"]


def test_overlapping_exhausts_of_a_bank_are_hatched_on_both() -> None:
    found = drawn(V8.plot(timing=cp.ValveTiming()))["exhausts overlap"]
    exhausts = V8.valves()["exhaust"]
    total = 0.0
    for bank in V8.exhaust_overlaps():
        for pair, overlap in bank.items():
            start = exhausts[pair[1] - 1, 0]
            total += 2.0 * overlap
            for cylinder in pair:
                inside = [(a, b) for k, a, b in found if k == cylinder and a <= start < b]
                assert inside or overlap == 0.0
    assert sum(b - a for _, a, b in found) == pytest.approx(total)
    alone = cp.Engine.preset("single").firing().plot(timing=cp.ValveTiming())
    assert "exhausts overlap" not in drawn(alone)


def test_a_two_stroke_has_two_strokes_and_ports() -> None:
    timing = cp.PortTiming(exhaust_opens_deg=98)
    ax = TWO.plot(timing=timing)
    found = drawn(ax)
    assert ax.get_xlim() == (0.0, 360.0)
    assert list(found)[:4] == ["power", "compression", "transfer open", "exhaust open"]
    assert found["exhaust open"] == wrapped(TWO.ports(timing)["exhaust"], 360.0)
    assert found["transfer open"] == wrapped(TWO.ports(timing)["transfer"], 360.0)
    assert found["power"] == wrapped(TWO.strokes_deg()["power"], 360.0)


def test_it_takes_axes_timing_and_style() -> None:
    _, ax = plt.subplots()
    timing = cp.ValveTiming(exhaust_opens_deg=80)
    assert V8.plot(ax, timing=timing, edgecolor="red") is ax
    assert {end - start for _, start, end in drawn(ax)["exhaust open"]} >= {270.0}
    assert all(
        mpl.colors.to_hex(np.asarray(bars.get_edgecolor())[0]) == "#ff0000"
        for bars in ax.collections[:8]
    )
    with pytest.raises(cp.InputError, match="ax = 3"):
        V8.plot(3)  # type: ignore[call-overload]


def test_an_error_leaves_no_figure() -> None:
    with pytest.raises(cp.InputError, match="timing = "):
        V8.plot(timing=cp.PortTiming())
    assert plt.get_fignums() == []


@pytest.mark.slow
@in_turn("name", [n for n in cp.presets() if cp.Engine.preset(n).firing_order])
def test_all_presets_with_a_firing_order_are_drawn(name: str) -> None:
    firing = cp.Engine.preset(name).firing()
    ax = firing.plot()
    ax.get_figure(root=True).canvas.draw()
    assert len(drawn(ax)["power"]) >= len(firing.engine)


def test_marks_are_seen_on_a_dark_background() -> None:
    with plt.style.context("dark_background"):
        ax = V8.plot()
    (fires,) = (line for line in ax.lines if line.get_label() == "fires")
    assert mpl.colors.to_hex(fires.get_color()) == "#ffffff"


@pytest.mark.parametrize(
    ("style", "scheme"), [("default", 0), ("dark_background", 1), ("ggplot", 0)]
)
def test_strokes_have_the_colours_of_the_page(style: str, scheme: int) -> None:
    css = (WEB / "view.css").read_text(encoding="utf-8")
    expected = {
        name: pair[scheme]
        for name, *pair in re.findall(r"--(\w+): light-dark\((#\w{6}), (#\w{6})\)", css)
        if name in V8.strokes_deg()
    }
    assert len(expected) == 4
    with plt.style.context(style):
        legend = V8.plot().get_legend()
    assert legend is not None
    drawn_in = {
        text.get_text().rpartition(": ")[2]: mpl.colors.to_hex(handle.get_facecolor())
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True)
        if isinstance(handle, mpl.patches.Patch)
    }
    assert drawn_in == expected


def test_strokes_alone_stand_in_the_middle_of_their_rows() -> None:
    ax = V8.plot()
    for bars in ax.collections:
        for path in bars.get_paths():
            heights = np.asarray(path.vertices)[:, 1]
            middle = 0.5 * (heights.min() + heights.max())
            assert middle == pytest.approx(round(middle), abs=1e-9)  # rounding
    (fires,) = (line for line in ax.lines if line.get_label() == "fires")
    np.testing.assert_allclose(np.asarray(fires.get_ydata()), np.arange(8), atol=1e-9)


def test_names_of_banks_have_room_beside_their_rows() -> None:
    plt.rcParams["font.size"] = 8
    for name, count in (("radial-9", 0), ("v8-crossplane", 2), ("v-twin-45", 2)):
        plt.rcParams["figure.figsize"] = (3.5, 2.6)
        ax = cp.Engine.preset(name).firing().plot()
        named = [text for text in ax.texts if text.get_rotation() == 270.0]
        assert len(named) == count
