"""Do drawings of an engine show its parts where the library has them?"""

from __future__ import annotations

import itertools
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any, Literal

import crankpin as cp
import numpy as np
import pytest
from crankpin.analysis.geometry import assumed_bores, geometry
from crankpin.plot.crank import PIN_MARKS, UNBALANCES, WEIGHTS
from crankpin.plot.section import CROSSHEADS, MOVING, piston_rods
from crankpin.plot.shapes import listed
from matplotlib import pyplot as plt
from support import in_turn
from support.engines import CYLINDER

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

RADIAL = cp.Engine.from_lists(
    CYLINDER,
    bank_deg=[90 + 40 * k for k in range(9)],
    z=[0.0] * 9,
    pin_deg=[90] * 9,
    rotating_mass=0.1,
    counterweights=[cp.Unbalance(0.05, 0.0, 180, pin=1)],
    name="Radial 9",
)
FITTED = cp.Engine.preset("i4", rotating_mass=0.4).replace(
    counterweights=[cp.Unbalance(0.012, 0.1 * k, 180, pin=k + 1) for k in range(4)],
    shafts=[
        cp.Shaft(ratio, [cp.Unbalance(0.002, 0.15, -90)], x=x, y=y, name=name)
        for ratio, x, y, name in [(2, 0.08, -0.02, "right"), (-2, -0.08, 0.05, "")]
    ],
)
STAGGERED = cp.Engine.vee(
    CYLINDER,
    bank_angle_deg=90,
    throws_deg=[0, 120, 240],
    spacing=0.11,
    bank_stagger=0.022,
    pin_split_deg=-30,
    name="V6 staggered",
)
ENGINES = [*map(cp.Engine.preset, cp.presets()), RADIAL, FITTED, STAGGERED]
any_engine = in_turn("engine", ENGINES)
on_one_crank = in_turn("engine", [e for e in ENGINES if len(e._core.cranks[0]) == 1])
"""Those on several have stars, and lines from the side, for each: tested by themselves."""


def outlines(ax: Axes, gid: str) -> list[NDArray[np.complex128]]:
    """Corners of the shapes of one kind, without the last, which is the first again."""
    (found,) = (each for each in ax.collections if each.get_gid() == gid)
    corners = [np.asarray(path.vertices)[:-1] for path in found.get_paths()]
    return [each[:, 0] + 1j * each[:, 1] for each in corners]


def middle(outline: NDArray[np.complex128]) -> complex:
    x, y = outline.real, outline.imag
    return complex(0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max()))


def words(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts if text.get_text()]


def figure_of(axes: Any) -> Figure:  # noqa: ANN401 - axes
    figure: Figure = np.ravel(axes)[0].get_figure(root=True)
    return figure


# --- the numbers drawn --------------------------------------------------------------------------


@pytest.mark.slow
@any_engine
def test_pistons_and_pins_of_the_section_are_where_the_slider_crank_has_them(
    engine: cp.Engine,
) -> None:
    drawn = outlines(engine.plot(kind="section", theta_deg=100), MOVING)
    at = geometry(engine, 100.0)
    rods = piston_rods(engine, at, assumed_bores(engine)).lengths
    front_first = np.argsort(engine.z, kind="stable")
    assert len(drawn) == 4 * len(engine)
    for j, k in enumerate(front_first):
        piston, rod, wrist, pin = drawn[4 * j : 4 * j + 4]
        size = engine.cylinders[k].rod_length
        assert middle(wrist) == pytest.approx(at.wrist_pin[k], abs=1e-12 * size)
        assert middle(pin) == pytest.approx(at.crankpin[k], abs=1e-12 * size)
        # The piston is a rectangle about the bore's axis, and around its pin or beyond a crosshead.
        centre = at.wrist_pin[k] + rods[k] * at.along[k]
        along = ((piston - centre) / at.along[k]).real
        across = ((piston - centre) / at.along[k]).imag
        assert along.min() < 0.0 < along.max()
        assert across.min() == pytest.approx(-across.max())
        # The rod goes from pin to pin.
        assert abs(rod - at.crankpin[k]).min() < 0.5 * size
        assert abs(rod - at.wrist_pin[k]).min() < 0.5 * size


DOUBLE_ACTING = cp.Engine.opposed_throws(
    cp.Cylinder(0.125, 0.625, 180.0, bore=0.3), throws_deg=[0, 180], spacing=0.32, strokes=2
).with_cycle(cp.Cycle.example("diesel", strokes=2), double_acting=True, rod_diameter=0.06)
SIDE_RODS = cp.Engine.opposed_pistons(
    cp.Cylinder(0.5, 2.0, 3000.0, bore=0.6), upper=cp.Cylinder(0.38, 2.6, 3900.0, bore=0.6),
    throws_deg=[0, 120, 240], spacing=1.4, lead_deg=8, one_crankshaft=True,
)  # fmt: skip


@pytest.mark.parametrize("engine", [DOUBLE_ACTING, SIDE_RODS], ids=["crank ends", "side rods"])
def test_pistons_on_crossheads_stay_in_their_cylinders(engine: cp.Engine) -> None:
    """Crossheads outside: the piston rod is as long at every angle, and pistons never meet."""
    rods = set()
    for theta in np.arange(0.0, 360.0, 7.5):
        ax = engine.plot(kind="section", theta_deg=theta)
        at, bores = geometry(engine, theta), [one.bore or 0.0 for one in engine.cylinders]
        drawn, joined = outlines(ax, MOVING), outlines(ax, CROSSHEADS)
        cylinder = piston_rods(engine, at, np.array(bores))
        assert len(joined) == sum(5 if one.side_rods else 2 for one in engine.cylinders)
        ends = {}
        for j, k in enumerate(np.argsort(engine.z, kind="stable")):
            piston = ((drawn[4 * j] - at.foot[k]) / at.along[k]).real
            ends[int(k)] = piston.min(), piston.max()
            crosshead = ((at.wrist_pin[k] - at.foot[k]) / at.along[k]).real
            rods.add((int(k), round(piston.min() - crosshead, 9)))
            bore = [m - 1 for n in engine.chambers if k + 1 in n for m in n]
            low, high = min(cylinder.low[bore]), max(cylinder.high[bore])
            assert crosshead < low < piston.min() < piston.max() < high
        for lower, *upper in engine.chambers:
            assert all(ends[lower - 1][1] < ends[k - 1][0] for k in upper)
        for beam in joined[5::7] if engine is SIDE_RODS else ():
            assert beam.imag.min() > cylinder.high.max()
        plt.close("all")
    assert len(rods) == len(engine)


def test_a_pump_above_side_rods_has_a_head_beyond_its_piston() -> None:
    def heads(engine: cp.Engine) -> set[tuple[float, float]]:
        lines = [line.get_xydata() for line in engine.plot(kind="section").lines]
        across = [line for line in lines if len(line) == 2 and line[0, 1] == line[1, 1]]
        return {(float(line[0, 1]), float(abs(line[0, 0]))) for line in across}

    cycle = cp.Cycle.example("diesel", strokes=2)
    above, below = ([one.side_rods != lower for one in SIDE_RODS.cylinders] for lower in (0, 1))
    plain = SIDE_RODS.with_cycle(cycle)
    added = [
        heads(plain.with_cycle(cycle, double_acting=flags)) - heads(plain)
        for flags in (above, below)
    ]
    assert [len(each) for each in added] == [1, 1]
    (head, _), (foot, _) = (each.pop() for each in added)
    assert foot < head


def test_crank_ends_are_closed_and_side_rods_open() -> None:
    for engine, corners in ((DOUBLE_ACTING, {5}), (SIDE_RODS, {2})):
        walls = [
            line
            for line in engine.plot(kind="section").lines
            if line.get_linewidth() == 1.2 and line.get_linestyle() == "-"
        ]
        assert {len(line.get_xdata()) for line in walls} == corners


@pytest.mark.slow
@on_one_crank
def test_the_star_has_every_crankpin_with_its_numbers(engine: cp.Engine) -> None:
    ax = engine.plot(kind="star", theta_deg=30)
    _, *pins = map(middle, outlines(ax, PIN_MARKS))
    at = geometry(engine, 30.0).crankpin
    for place in at:
        assert min(abs(place - pin) for pin in pins) < 1e-8 * abs(place)
    for pin in pins:
        assert min(abs(at - pin)) < 1e-8 * abs(pin)
    for k, place in enumerate(at, start=1):
        # Annotations without text are arrows.
        labels = [label for label in ax.texts if label.get_text()]
        nearest = min(labels, key=lambda label: _angle(complex(*label.xy), place))
        assert k in _numbers(nearest.get_text())


def test_each_of_several_cranks_has_a_star_and_a_line_of_its_own() -> None:
    """Cranks that turn against each other, the second 0.2 m beside the first: one star each."""
    engine = cp.Engine.from_lists(
        cp.Cylinder(0.04, 0.14, 0.5), tdc_deg=[0, 180, 0, 120], bank_deg=[90] * 4,
        z=[0, 0.1, 0, 0.1], cranks=[(0.2, 0, -1)], crank=[0, 0, 1, 1], rotating_mass=0.3,
    ).with_counterweights([cp.Unbalance(0.01, 0.05, 30.0, crank=1)])  # fmt: skip
    theta = 30.0
    at = geometry(engine, theta)
    arms = at.crankpin - at.axis
    ax = engine.plot(kind="star", theta_deg=theta)
    first, second, *pins = map(middle, outlines(ax, PIN_MARKS))
    assert first == 0.0
    assert second.real > 0.1
    centres = np.array([first, first, second, second])
    assert len(pins) == 4
    for place in centres + arms:
        assert min(abs(place - pin) for pin in pins) < 1e-9
    assert {"main crank", "crank 1 −1×"} <= set(words(ax))
    (weight,) = outlines(ax, UNBALANCES)[4:]
    towards = float(np.degrees(np.angle(weight.mean() - second)))
    assert towards == pytest.approx(30.0 - theta, abs=5.0)
    side = engine.plot(kind="side", theta_deg=theta)
    lines = [middle(each).imag for each in outlines(side, PIN_MARKS)[:2]]
    assert lines[0] == 0.0
    assert lines[1] < -0.1
    assert {"main crank", "crank 1 −1×"} <= set(words(side))
    for ax in (engine.plot(kind="section", theta_deg=theta), *np.ravel(engine.plot())):
        figure_of(ax).canvas.draw()


def _angle(a: complex, b: complex) -> float:
    return abs(float(np.angle(a / b)))


def _numbers(text: str) -> set[int]:
    """The cylinders of a label."""
    found: set[int] = set()
    parts = re.split(r"[,\n]\s*", text)
    for k, part in enumerate(parts):
        if part == "…":
            first, second, last = (int(parts[j]) for j in (k - 2, k - 1, k + 1))
            found |= set(range(first, last + 1, second - first))
        else:
            first, *last = map(int, part.split("–"))  # type: ignore[assignment]
            found |= set(range(first, (last or [first])[0] + 1))  # type: ignore[index]
    return found


@pytest.mark.slow
@on_one_crank
def test_the_side_view_has_pins_at_their_heights_and_places(engine: cp.Engine) -> None:
    ax = engine.plot(kind="side", theta_deg=70)
    _, *pins = map(middle, outlines(ax, PIN_MARKS))
    at = geometry(engine, 70.0).crankpin
    span = np.ptp(engine.z) or 1.0
    for k, place in enumerate(at):
        same = [pin for pin in pins if abs(pin.imag - place.imag) < 1e-8 * abs(place)]
        # Pins at one place along the crank are drawn side by side, within their throw.
        assert min(abs(pin.real - engine.z[k]) for pin in same) < 0.3 * span
    shown = set().union(*map(_numbers, words(ax)[: len(pins)]))
    assert shown == set(range(1, len(engine) + 1))


def test_a_pin_alone_on_its_throw_is_drawn_at_its_z() -> None:
    engine = cp.Engine.preset("i5")
    _, *pins = map(middle, outlines(engine.plot(kind="side"), PIN_MARKS))
    assert [pin.real for pin in pins] == pytest.approx(engine.z.tolist(), abs=1e-12)


def test_areas_of_the_star_are_proportional_to_unbalances() -> None:
    ax = FITTED.plot(kind="star", theta_deg=0)
    masses, sectors = np.split(np.array(outlines(ax, UNBALANCES), dtype=object), 2)
    # Rotating masses of two cylinders round about each pin; their counterweights opposite, from
    # the axis on.
    assert sorted(middle(mass).imag for mass in masses) == pytest.approx([-0.043, 0.043], abs=1e-3)
    assert [sector[0] for sector in sectors] == [0.0, 0.0]
    directions = [round(np.degrees(np.angle(sector[1:].mean()))) for sector in sectors]
    assert sorted(directions) == [-90, 90]

    def area(outline: np.ndarray) -> float:
        return float(0.5 * abs((outline.conj() * np.roll(outline, -1)).imag.sum()))

    ratio = 2 * 0.012 / (2 * 0.4 * 0.043)
    # Circles of 20 corners have 1.6 % less area than round ones, sectors of 9 0.3 %.
    assert area(sectors[0]) / area(masses[0]) == pytest.approx(ratio, rel=0.02)


def test_pistons_that_face_each_other_share_a_bore_without_heads() -> None:
    cylinder = CYLINDER.replace(bore=0.08)
    engine = cp.Engine.opposed_pistons(
        cylinder, throws_deg=[0, 120, 240], spacing=0.1, distance=0.5, ratio=-1
    )
    ax = engine.plot(kind="section")
    ax.figure.draw_without_rendering()
    walls = [line for line in ax.lines if line.get_linewidth() == 1.2]
    assert len(walls) == 4  # two sides, of the lower and of the upper half
    for wall in walls:
        x, y = wall.get_data()
        assert x[0] == pytest.approx(x[1])
        assert abs(x[0]) == pytest.approx(0.5 * 0.08)
        assert 0.25 in np.round(y, 12)  # half way between the cranks
    at = {text.get_text(): text.get_window_extent() for text in ax.texts}
    left = ax.transData.transform((-0.5 * 0.08, 0.0))[0]
    for numbers, (low, high) in {"1–3": (0.0, 0.25), "4–6": (0.25, 0.5)}.items():
        (_, bottom), (_, top) = ax.transData.transform([(0.0, low), (0.0, high)])
        assert at[numbers].x1 < left
        assert bottom < at[numbers].y0 < at[numbers].y1 < top


def test_numbers_of_bores_behind_each_other_stand_above_the_highest() -> None:
    rods = [CYLINDER.replace(rod_length=length) for length in (0.14, 0.2, 0.16)]
    engine = cp.Engine.inline(rods, throws_deg=[0, 120, 240], spacing=0.1)
    ax = engine.plot(kind="section")
    (numbers,) = (text for text in ax.texts if text.get_text() == "1–3")
    heads = [max(line.get_ydata()) for line in ax.lines if line.get_linewidth() == 1.2]
    assert len(heads) == 3
    assert numbers.xy[1] == pytest.approx(max(heads))


def test_numbers_of_throws_at_one_place_are_apart() -> None:
    engine = cp.Engine.from_lists(
        CYLINDER, bank_deg=[90, 90], pin_deg=[0, 180], z=[0.0, 0.0], rotating_mass=0.1
    )
    ax = engine.plot(kind="side")
    first, second = (text for text in ax.texts if text.get_text() in "12")
    assert first.get_va() != second.get_va() or first.xy[0] != second.xy[0]


def test_arrows_are_away_from_bores_and_other_cranks() -> None:
    pair = cp.Engine.u(CYLINDER, throws_deg=[0, 180], spacing=0.1, distance=0.13)
    opposed = cp.Engine.opposed_pistons(CYLINDER, throws_deg=[0], spacing=0.1, distance=0.5)
    for engine, sides in ((pair, [-1 - 1j, 1 - 1j]), (opposed, [1 - 1j, 1 + 1j])):
        ax = engine.plot(kind="section")
        tips = [complex(*text.xy) for text in ax.texts if text.arrow_patch is not None]
        cranks = [complex(*crank[:2]) for crank in engine._core.cranks[0]]
        aside = [tip - crank for tip, crank in zip(tips, cranks, strict=True)]
        assert [np.sign(a.real) + 1j * np.sign(a.imag) for a in aside] == sides


def test_the_side_view_has_counterweights_and_shafts_at_their_places() -> None:
    ax = FITTED.plot(kind="side", theta_deg=0)
    plates = outlines(ax, WEIGHTS)
    assert [middle(plate).real for plate in plates] == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert [np.sign(middle(plate).imag) for plate in plates] == [-1, 1, 1, -1]
    texts = {text.get_text(): text.xy for text in ax.texts if "×" in text.get_text()}
    assert {text: y for text, (_, y) in texts.items()} == {"right +2×": -0.02, "−2×": 0.05}


def test_the_section_has_shafts_at_their_places() -> None:
    ax = FITTED.plot(kind="section")
    texts = {text.get_text(): text.get_position() for text in ax.texts if "×" in text.get_text()}
    assert texts["right +2×"][0] == 0.08
    assert texts["−2×"][0] == -0.08


def test_the_flywheel_end_is_over_the_front() -> None:
    """Seen from the flywheel, what is near it covers what is behind."""
    engine = cp.Engine.inline(CYLINDER, throws_deg=[0, 90], spacing=0.1)
    last = outlines(engine.plot(kind="section"), MOVING)[-1]
    assert middle(last) == pytest.approx(geometry(engine).crankpin[1])


# --- words --------------------------------------------------------------------------------------


CROWDED = ("w12", "w16", "v16-45", "v14-9.13", "v4-narrow", "vr6", "i6")


@pytest.mark.slow
@in_turn(
    ("engine", "size", "font"),
    [(engine, (7.2, 5.6), 10.0) for engine in ENGINES]
    + [(engine, (3.4, 3.2), 7.0) for engine in (*map(cp.Engine.preset, CROWDED), RADIAL, FITTED)],
)
def test_no_numbers_overlap(engine: cp.Engine, size: tuple[float, float], font: float) -> None:
    with plt.rc_context({"font.size": font}):
        figure = plt.figure(figsize=size, layout="constrained")
        axes = engine.plot(figure=figure)
        figure.draw_without_rendering()
        for ax in axes:
            texts = [text for text in ax.texts if text.get_text()]
            boxes = [text.get_window_extent().padded(-0.5) for text in texts]
            texts.append(ax._left_title)
            boxes.append(texts[-1].get_window_extent())
            for (a, one), (b, other) in itertools.combinations(zip(texts, boxes, strict=True), 2):
                assert not one.overlaps(other), (a.get_text(), b.get_text())


@pytest.mark.parametrize("name", ["v16-45", "w16", "v12-60"])
def test_numbers_of_the_side_view_are_within_its_axes(name: str) -> None:
    plt.rcParams["font.size"] = 8
    figure, ax = plt.subplots(figsize=(3.4, 2.6), layout="constrained")
    cp.Engine.preset(name).plot(ax, kind="side")
    figure.canvas.draw()
    low, high = ax.bbox.y0, ax.bbox.y1
    written = [text for text in ax.texts if re.search(r"\d", text.get_text())]
    assert len(written) >= 6
    for text in written:
        box = text.get_window_extent()
        assert low - 1.0 <= box.y0
        assert box.y1 <= high + 1.0


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ([3], "3"),
        ([1, 2], "1, 2"),
        ([1, 2, 3], "1–3"),
        ([1, 3, 5, 7], "1, 3, 5, 7"),
        ([2, 4, 6, 8, 10], "2, 4, …, 10"),
        ([1, 2, 15, 16], "1, 2, 15, 16"),
    ],
)
def test_numbers_of_many_cylinders_are_shortened(numbers: list[int], text: str) -> None:
    assert listed(numbers) == text


def test_titles_and_legend_say_what_it_is() -> None:
    figure = figure_of(FITTED.plot(theta_deg=22.5))
    assert (
        figure.get_suptitle()
        == "Inline-4 with 4 counterweights and 2 balance shafts\nθ = 22.5°, seen from the flywheel"
    )
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert titles == ["cross-section", "crank star", "crank from the side"]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "rotating masses, up to 0.0172 kg·m each",
        "counterweights, up to 0.012 kg·m each",
        "balance shafts, up to 0.002 kg·m each",
    ]
    ax = FITTED.plot(kind="star")
    assert (
        ax.get_title(loc="left")
        == "Inline-4 with 4 counterweights and 2 balance shafts\ncrank star, θ = 0°"
    )
    assert not figure_of(cp.Engine.preset("i4").plot()).legends


def test_lengths_that_are_not_to_scale_say_so() -> None:
    true = cp.Engine.preset("i4").plot(kind="side")
    assert true.get_xlabel() == "z, m"
    assert true.get_aspect() == 1.0
    book = cp.Engine.preset("i4-ebook").plot(kind="side")
    assert book.get_xlabel() == "z, m (not to the scale of y)"


# --- places and options -------------------------------------------------------------------------


def test_axes_given_get_the_section_and_one_kind_takes_axes() -> None:
    _, (left, right) = plt.subplots(1, 2)
    assert FITTED.plot(left) is left
    assert outlines(left, MOVING)
    assert FITTED.plot(right, kind="star") is right
    assert len(plt.get_fignums()) == 1


def test_style_is_passed_on_to_the_main_parts() -> None:
    kinds: list[tuple[Literal["section", "star", "side"], str | None]]
    kinds = [("section", MOVING), ("star", None), ("side", None)]
    for kind, gid in kinds:
        ax = FITTED.plot(kind=kind, color="#123456", label="parts")
        (found,) = (each for each in ax.collections if each.get_label() == "parts")
        assert found.get_gid() == gid
        colour = np.asarray(found.get_facecolor())[0, :3]
        np.testing.assert_allclose(colour, np.array([18, 52, 86]) / 255)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kind": "top"}, "kind = 'top'"),
        ({"theta_deg": "x"}, "theta_deg = 'x'"),
        ({"theta_deg": np.inf}, "theta_deg = inf"),
        ({"ax": 3}, "ax = 3"),
        ({"figure": 3}, "figure = 3"),
        ({"figure": 3, "kind": "star"}, "figure = 3: kind='star' has one panel"),
        ({"figure": 3, "ax": 3}, "ax and figure cannot be combined"),
    ],
)
def test_what_cannot_be_drawn_leaves_no_figure(options: dict[str, Any], message: str) -> None:
    with pytest.raises(cp.InputError, match=message):
        FITTED.plot(**options)
    assert plt.get_fignums() == []


# --- in a notebook ------------------------------------------------------------------------------

SVG = "{http://www.w3.org/2000/svg}"
HREF = "{http://www.w3.org/1999/xlink}href"


@pytest.mark.slow
@any_engine
def test_the_inline_picture_is_one_element_that_fetches_nothing(engine: cp.Engine) -> None:
    text = engine._picture()
    assert text is not None
    root = ET.fromstring(text)  # noqa: S314 - our own
    assert root.tag == f"{SVG}svg"
    assert root.attrib["aria-label"].startswith(engine.name)
    assert len(text) < max(50_000, 2_500 * len(engine))
    assert not list(root.iter(f"{SVG}style"))  # it would apply to the whole page
    assert not list(root.iter(f"{SVG}image"))
    ids = {each.attrib["id"] for each in root.iter() if "id" in each.attrib}
    used = {each.attrib[HREF] for each in root.iter() if HREF in each.attrib}
    assert used <= {f"#{name}" for name in ids}
    assert "url(" not in text
    assert not re.findall(r"(?<!xmlns=\")(?<!xmlns:xlink=\")https?:", text)
    shown = [each.text for each in root.iter(f"{SVG}text")]
    assert any(re.fullmatch(r"[\d.]+ m", each or "") for each in shown)  # text is text: the scale


def test_pictures_on_one_page_have_ids_of_their_own() -> None:
    with plt.rc_context({"svg.hashsalt": "the same for all"}):
        texts = [FITTED._picture() or "" for _ in range(2)]
    first, second = (set(re.findall(r' id="([^"]+)"', text)) for text in texts)
    assert first
    assert not first & second


def test_its_lines_have_the_colour_of_the_page_s_text() -> None:
    with plt.style.context("dark_background"):
        text = FITTED._picture() or ""
    assert "stroke: currentColor" in text
    assert "#010203" not in text


def test_a_table_follows_the_picture_and_no_figure_stays() -> None:
    html = FITTED.replace(name="<script>alert(1)</script> & co")._repr_html_()
    assert html.index("<svg") < html.index("<table")
    assert "<script" not in html
    assert plt.get_fignums() == []


def test_without_matplotlib_there_is_the_table() -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "import crankpin as cp\n"
        "engine = cp.Engine.preset('i4')\n"
        "assert engine._picture() is None\n"
        "assert engine._repr_html_().startswith('<table>')"
    )
    subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603
