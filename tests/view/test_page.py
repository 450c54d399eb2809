"""Does the page do what its reader asks, and nothing else?"""

from __future__ import annotations

import itertools
import json
import re
import time
from typing import TYPE_CHECKING, Any

import crankpin as cp
import numpy as np
import pytest
from crankpin._support import units
from crankpin.view.figures import figures
from crankpin.view.page import WEB
from support import in_turn
from support.chromium import Open, values
from support.engines import CYLINDER
from support.view_engines import everything, opposed_pistons, radial, square_four

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from playwright.sync_api import Page

pytestmark = pytest.mark.slow  # a browser

V8 = cp.Engine.preset("v8-crossplane")
V16 = cp.Engine.preset("v16-45")

MOVING = """() => {
    const all = (selector, name) => [...document.querySelectorAll(selector)]
        .map(each => each.getAttribute(name)).join();
    const scenes = [...document.querySelectorAll(".scene")].map((scene) =>
        [...scene.querySelectorAll(".piston")].map(each => each.getAttribute("transform")).join());
    return [
        ...scenes,
        all(".throw .core", "points"),
        all(".arrow.moment", "d"),
        all(".arrow.forward", "d"),
        all(".dial .dot", "cx"),
        all(".twist", "d"),
        all(".cursor", "d"),
        all(".timeline .dot", "cy"),
        all("[data-name^=piston]", "data-value"),
        all("output[data-name=moment-x]", "data-value"),
        all("output[data-name=torque]", "data-value"),
    ];
}"""
"""What must move with the crank: every picture and every number, each as a text."""


def angle(page: Page) -> float:
    return values(page, "[data-name=crank-angle]")["crank-angle"]


def freeze(page: Page) -> None:
    """Let time pass in the page when the test says so, and not else."""
    page.clock.install(time=0)
    page.clock.pause_at(1000)


def wait(page: Page, condition: str) -> None:
    """Wait for what the browser reports by itself; the page's policy forbids ``eval``."""
    for _ in range(200):
        if page.evaluate(condition):
            return
        time.sleep(0.02)
    pytest.fail(f"waited in vain for {condition}")


def two_strokes(**changes: Any) -> cp.Engine:  # noqa: ANN401 - of Engine.replace
    engine = cp.Engine.inline(
        CYLINDER, throws_deg=[0, 120, 240], spacing=0.1, strokes=2, firing_order="1-3-2"
    )
    return engine.replace(**changes)


CAMSHAFT = cp.Shaft("1/2", [cp.Unbalance(0.001, z=0.1)], x=0.1, y=0.2)


@pytest.mark.parametrize(
    ("engine", "turns"),
    [
        (two_strokes(), 1),
        (two_strokes(loads=[cp.PeriodicLoad("pump", on="block", torque={2: 5})]), 1),
        (two_strokes(loads=[cp.PeriodicLoad("pump", on="block", torque={1.5: 5})]), 2),
        (two_strokes(shafts=[CAMSHAFT]), 2),
        (two_strokes(shafts=[CAMSHAFT.replace(ratio=-2)]), 1),
        (V8, 2),
    ],
    ids=["bare", "whole", "halves", "camshaft", "shaft", "four strokes"],
)
def test_shows_all_turns_after_which_the_engine_repeats(
    open_engine: Open, engine: cp.Engine, turns: int
) -> None:
    page = open_engine(engine)
    slider = page.locator(".transport > input[type=range]")
    assert slider.get_attribute("max") == f"{360 * turns}"
    for typed, within in [(350, 350), (360 * turns + 10, 10), (360 * turns - 20, 360 * turns - 20)]:
        page.evaluate("(angle) => crankpin.set({ angle_deg: angle })", typed)
        assert slider.input_value() == f"{within}"
    ticks = page.locator(".timeline .degrees").all_text_contents()
    assert ticks[-1] == f"{360 * turns}°"
    # A mark of each cylinder's firing in each cycle.
    fires = page.locator(".timeline .fires").get_attribute("d") or ""
    assert fires.count("M") == len(engine) * 2 * turns // engine.strokes


# --- one file -----------------------------------------------------------------------------------


def test_asks_the_network_for_nothing(open_engine: Open) -> None:
    page = open_engine(V8)
    page.get_by_role("button", name="play").click()
    page.wait_for_timeout(300)
    assert page.asked == [page.url]  # type: ignore[attr-defined]


def test_no_text_goes_over_several_lines() -> None:
    """Indents of modules are left out of pages."""
    for module in WEB.glob("*.mjs"):
        for line in module.read_text(encoding="utf-8").splitlines():
            assert line.count("`") % 2 == 0, f"{module.name}: {line}"


@in_turn("name", cp.presets())
def test_is_at_most_102_kb_beside_its_figures(name: str, tmp_path: Path) -> None:
    engine, file = cp.Engine.preset(name), tmp_path / "engine.html"
    engine.save_html(file, rpm=10)
    known = figures(engine, 10, spectrum=None)
    own = len(json.dumps(known, ensure_ascii=False, separators=(",", ":")).encode())
    assert file.stat().st_size - own <= 102_000


@pytest.mark.parametrize("compact", [False, True])
def test_says_which_loads_it_counts(open_engine: Open, compact: bool) -> None:
    petrol = cp.Cycle.example()
    cylinder = cp.Cylinder(0.043, 0.145, 0.5, bore=0.086)
    bare = cp.Engine.preset("i4", cylinder=cylinder)
    lame = bare.with_cycle([petrol, petrol, None, petrol])
    saves = [(bare, {}), (lame, {}), (lame, {"spectrum": {1: 0.067}})]
    for engine, save in saves:
        page = open_engine(engine, save=save | {"compact": compact})
        words = "spectrum given" if save else engine.loads_counted
        shown = page.locator("header .loads")
        assert shown.text_content() == f"{words[0].upper()}{words[1:]}."
        assert shown.is_visible()


def test_names_stay_text(open_engine: Open) -> None:
    name = "</script><script>alert(1)</script><img src=x onerror=alert(2)>&amp;"
    page = open_engine(V8.replace(name=name))
    page.on("dialog", lambda dialog: pytest.fail(dialog.message))
    assert page.title() == name
    assert page.locator("h1").text_content() == name
    assert page.locator("img").count() == 0
    assert page.evaluate("document.scripts.length") == 1


def test_errors_name_what_is_wrong(tmp_path: Path) -> None:
    for wrong in ({"rpm": -1}, {"rpm": float("nan")}, {"spectrum": {0: 1.0}}):
        with pytest.raises(cp.InputError, match=f"^{next(iter(wrong))}"):
            V8.save_html(tmp_path / "v8.html", **wrong)
    for path in ("v8.txt", None):
        with pytest.raises(cp.InputError, match=r"^path = .*: .*a page ends in \.html$"):
            V8.save_html(path)  # type: ignore[arg-type]
    with pytest.raises(OSError, match="nowhere"):
        V8.save_html(tmp_path / "nowhere" / "v8.html")


# --- one source of truth ------------------------------------------------------------------------


def test_everything_follows_the_angle(open_engine: Open) -> None:
    page = open_engine(V8)
    field = page.get_by_label("crank angle")
    slider = page.get_by_label("turn the crank")

    def drag() -> None:
        box = page.locator(".scene.cross .handle").bounding_box()
        assert box is not None
        x, y, reach = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, box["width"] / 3
        page.mouse.move(x + reach, y)
        page.mouse.down()
        for dx, dy in [(0.7, -0.7), (0.0, -1.0), (-0.7, -0.7)]:
            page.mouse.move(x + reach * dx, y + reach * dy)
        page.mouse.up()

    acts: dict[str, Callable[[], object]] = {
        "type": lambda: field.fill("33.5"),
        "slide": lambda: slider.fill("200"),
        "step on": lambda: page.get_by_role("button", name="step on").click(),
        "step back": lambda: page.get_by_role("button", name="step back").click(),
        "drag": drag,
        "point": lambda: page.locator(".timeline").click(position={"x": 400, "y": 100}),
        "script": lambda: page.evaluate("crankpin.set({ angle_deg: -77 })"),
    }
    seen = page.evaluate(MOVING)
    reached = {}
    for name, act in acts.items():
        act()
        moved = page.evaluate(MOVING)
        still = [k for k, (a, b) in enumerate(zip(seen, moved, strict=True)) if a == b]
        assert still == [], name
        reached[name] = (angle(page), moved)
        assert slider.input_value() == f"{round(angle(page) % 720)}"
        seen = moved
    assert [reached[name][0] for name in ("type", "slide", "step on", "step back")] == [
        33.5,
        200.0,
        201.0,
        200.0,
    ]
    assert reached["drag"][0] == pytest.approx(335, abs=0.5)  # counter-clockwise
    # The same angle gives the same page, however it was reached.
    for turned, moved in reached.values():
        field.fill(f"{turned!r}")
        assert page.evaluate(MOVING) == moved


def test_what_is_no_number_moves_nothing(open_engine: Open) -> None:
    page = open_engine(V8)
    field = page.get_by_label("crank angle")
    field.fill("12.5")
    seen = page.evaluate(MOVING)
    for text in ("", "a", "1e999", "12.5.3", "NaN"):
        field.fill(text)
        assert field.get_attribute("aria-invalid") == "true"
        assert page.evaluate(MOVING) == seen
    field.blur()
    assert field.get_attribute("aria-invalid") is None
    assert field.input_value() == "12.5"
    for text, value in [("-3,5", -3.5), ("1e3", 1000.0), (" 7 ", 7.0), ("−8", -8.0)]:
        field.fill(text)
        assert angle(page) == value
    for name, outside in [("bank-angle", "181"), ("rod-ratio", "1"), ("rpm", "-1")]:
        page.locator(f"[data-name={name}]").fill(outside)
        assert page.locator(f"[data-name={name}]").get_attribute("aria-invalid") == "true"


def test_steps_of_a_tenth_add_up(open_engine: Open) -> None:
    page = open_engine(V8)
    page.get_by_label("degrees a step").select_option("0.1")
    for _ in range(10):
        page.get_by_role("button", name="step on").click()
    assert angle(page) == 1.0


# --- playing ------------------------------------------------------------------------------------


def test_play_advances_and_stop_stops(open_engine: Open) -> None:
    page = open_engine(V8)
    freeze(page)
    play, stop = (page.get_by_role("button", name=name) for name in ("play", "stop"))
    page.clock.run_for(500)
    assert angle(page) == 0.0  # nothing moves by itself
    play.click()
    page.clock.run_for(1000)
    reached = angle(page)
    assert reached == pytest.approx(120, abs=6)  # 20 turns a minute
    assert play.get_attribute("aria-pressed") == "true"
    page.get_by_label("turns a minute").fill("60")
    page.clock.run_for(1000)
    assert angle(page) - reached == pytest.approx(360, abs=12)
    page.get_by_role("button", name="reverse").click()
    before = angle(page)
    page.clock.run_for(500)
    assert angle(page) - before == pytest.approx(-180, abs=12)
    stop.click()
    stopped = page.evaluate(MOVING), angle(page)
    page.clock.run_for(1000)
    assert (page.evaluate(MOVING), angle(page)) == stopped
    assert play.get_attribute("aria-pressed") == "false"


def test_pauses_while_it_cannot_be_seen(open_engine: Open) -> None:
    page = open_engine(V8)
    freeze(page)
    page.get_by_role("button", name="play").click()

    def advanced() -> float:
        before = angle(page)
        page.clock.run_for(500)
        return angle(page) - before

    assert advanced() > 50
    hide = """hidden => {
        Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
    }"""
    page.evaluate(hide, arg=True)
    assert advanced() == 0
    page.evaluate(hide, arg=False)
    assert advanced() > 50
    # Scrolled away.
    page.evaluate("document.body.style.paddingTop = '5000px'")
    wait(page, "!crankpin.player.onScreen")
    assert advanced() == 0
    page.evaluate("document.body.style.paddingTop = '0'")
    wait(page, "crankpin.player.onScreen")
    assert advanced() > 50


def test_reduced_motion_changes_the_picture_twice_a_second(open_engine: Open) -> None:
    page = open_engine(V8, reduced_motion="reduce")
    freeze(page)
    page.get_by_role("button", name="play").click()
    seen = []
    for _ in range(40):
        page.clock.run_for(50)
        seen.append(angle(page))
    assert len({*seen}) in (4, 5)
    assert seen[-1] == pytest.approx(240, abs=70)


def test_keys(open_engine: Open) -> None:
    page = open_engine(V8)
    freeze(page)
    for key, reached in [
        ("ArrowRight", 1),
        ("Shift+ArrowRight", 11),
        ("ArrowLeft", 10),
        ("Home", 0),
        ("Shift+ArrowLeft", -10),
    ]:
        page.keyboard.press(key)
        assert angle(page) == reached
    page.keyboard.press("Space")
    page.clock.run_for(500)
    assert angle(page) > 20
    page.keyboard.press("r")
    page.keyboard.press("Space")
    stopped = angle(page)
    page.clock.run_for(500)
    assert angle(page) == stopped
    assert page.get_by_role("button", name="reverse").get_attribute("aria-pressed") == "true"
    # A key that is typed, or that presses a button, does no more than that.
    page.get_by_label("crank angle").fill("5")
    page.get_by_label("crank angle").press("ArrowLeft")
    assert angle(page) == 5
    page.get_by_role("button", name="stop").press("Space")
    page.clock.run_for(500)
    assert angle(page) == 5
    slider = page.get_by_label("turn the crank")
    slider.fill("8")
    slider.press("ArrowRight")
    assert angle(page) == 9


CLICKED = {
    "play": lambda page: page.get_by_role("button", name="play").click(),
    "reverse": lambda page: page.get_by_role("button", name="reverse").click(),
    "slider": lambda page: page.get_by_label("turn the crank").click(),
    "order": lambda page: page.get_by_role("checkbox").first.click(),
    "more": lambda page: page.get_by_text("more", exact=True).click(),
}


@pytest.mark.parametrize("clicked", CLICKED)
def test_keys_after_a_click(open_engine: Open, clicked: str) -> None:
    """Space plays and stops, and R reverses, whatever was clicked before."""
    page = open_engine(V8)
    freeze(page)
    CLICKED[clicked](page)
    before = page.evaluate("({ ...crankpin.state, still: crankpin.state.still.size })")
    page.keyboard.press("Space")
    page.keyboard.press("r")
    after = page.evaluate("({ ...crankpin.state, still: crankpin.state.still.size })")
    changed = {key for key in before if before[key] != after[key]}
    assert changed == {"playing", "reverse"}


# --- sentences ----------------------------------------------------------------------------------


def test_sentences_are_those_of_the_engine_as_given(open_engine: Open) -> None:
    page = open_engine(V8, rpm=4500)
    explained = list(V8.explain(4500).sentences)
    listed = page.locator("[data-name=sentence]")
    assert listed.all_text_contents() == explained
    assert [each.is_visible() for each in listed.all()] == [k < 3 for k in range(len(explained))]
    freeze(page)
    page.get_by_text("more", exact=True).press("Space")
    assert all(each.is_visible() for each in listed.all())
    page.clock.run_for(500)
    assert angle(page) == 0  # the key opened the list, and played nothing
    # They say at what speed; another engine they do not describe.
    assert page.get_by_text("How it shakes, at 4500 rpm").is_visible()
    page.locator("[data-name=rpm]").fill("2000")
    assert listed.first.is_visible()
    for field, value, own in (("bank-angle", "60", "90"), ("rod-ratio", "0.25", None)):
        top = page.locator(".dials").bounding_box()
        page.locator(f"[data-name={field}]").fill(value)
        assert not listed.first.is_visible()
        assert page.locator(".dials").bounding_box() == top  # nothing jumps
        if own:
            page.locator(f"[data-name={field}]").fill(own)
            assert listed.first.is_visible()


def test_a_spectrum_and_a_compact_page_have_no_sentences(open_engine: Open) -> None:
    for save in ({"spectrum": {1: 0.067}}, {"compact": True}):
        page = open_engine(V8, save=save)
        assert page.locator("[data-name=sentence]").count() == 0
        assert not page.get_by_text("How it shakes").is_visible()


# --- settings -----------------------------------------------------------------------------------


def test_engine_follows_its_settings(open_engine: Open) -> None:
    page = open_engine(V8)
    bores = "[...document.querySelectorAll('.cross .bore')].map(each => each.getAttribute('d'))"
    before, found = page.evaluate(bores), values(page)
    page.get_by_label("bank angle", exact=True).fill("60")
    assert page.evaluate(bores) != before
    assert values(page)["bank-angle"] == 60
    # With the pins held the firing moves, and held it does not.
    intervals = page.locator("[data-name=firing-intervals]")
    held = V8.with_bank_angle(60, hold="pins").firing()
    assert intervals.text_content() == f"(intervals {held.intervals_text}°)"
    order = page.locator("[data-name=firing-order]")
    assert order.text_content() == held.firing_order == V8.firing_order
    page.get_by_label("held as the bank angle changes").select_option("firing")
    assert intervals.text_content() == "(every 90°)"
    page.get_by_label("engine speed").fill("6000")
    page.get_by_label("bank angle", exact=True).fill("90")
    assert values(page)["moment-longest"] == pytest.approx(4 * found["moment-longest"], rel=1e-9)


def test_title_names_changed_settings(open_engine: Open) -> None:
    page = open_engine(cp.Engine.preset("v6-60"))
    own = page.locator("h1").text_content()
    changes = page.locator("header > :last-child")
    page.get_by_label("bank angle", exact=True).fill("90")
    assert changes.text_content() == " → bank angle 90°"
    assert page.title() == f"{own} → bank angle 90°"
    page.locator("[data-name=rod-ratio]").fill("0.25")
    assert changes.text_content() == " → bank angle 90°, rod ratio 0.25"
    page.get_by_label("bank angle", exact=True).fill("60")
    assert page.title() == f"{own} → rod ratio 0.25"


def test_a_rejected_value_is_answered_by_the_range(open_engine: Open) -> None:
    page = open_engine(V8)
    field = page.locator("[data-name=rod-ratio]")
    said = page.locator(".limits:visible")
    own = field.input_value()
    field.fill("1.2")
    field.press("Enter")
    assert field.input_value() == own
    assert said.text_content() == "give 0.05–0.7"
    field.fill("0.25")
    field.press("Enter")
    assert said.count() == 0


def test_scripts_cannot_leave_the_range_of_rod_ratios(open_engine: Open) -> None:
    page = open_engine(V8)
    own = values(page)
    for ratio in (0.04, 0.71):
        said = page.evaluate(
            """rod_ratio => {
                try { crankpin.set({ rod_ratio, rpm: 5000 }); } catch (error) { return `${error}`; }
            }""",
            ratio,
        )
        assert said == f"RangeError: rod_ratio = {ratio}: give 0.05–0.7"
    assert values(page) == own


def test_dials_do_not_enlarge_what_is_negligible(open_engine: Open) -> None:
    """The longest force of an inline-6 is 2e-4 of what its cylinders make one by one."""
    page = open_engine(cp.Engine.preset("i6"))
    lengths = page.eval_on_selector_all(
        ".phasor:not([hidden]) .trace, .dial .trace.force",
        "found => found.map(each => each.getBBox().height)",
    )
    assert len(lengths) >= 3
    assert max(lengths) < 40  # of 168 pixels, which stand for 1e-3 at least
    reach = page.evaluate("84 / crankpin.orbits.dial.scale")
    assert values(page)["orbit-longest"] == pytest.approx(reach, rel=1e-12)


def test_firing_follows_the_library_s(open_engine: Open) -> None:
    """Offsets and rods move the highest point of a piston, and with it the firing."""
    engine = cp.Engine.preset("vr6")
    page = open_engine(engine)
    changed = engine.replace(
        cylinder=[c.replace(rod_length=c.crank_radius / 0.4) for c in engine.cylinders]
    )
    for ratio, expected in [(None, engine), (0.4, changed)]:
        if ratio:
            page.locator("[data-name=rod-ratio]").fill(f"{ratio}")
        fires = page.evaluate("crankpin.engine.cylinders.map(each => each.strokes[0][1] % 720)")
        assert fires == pytest.approx(expected.firing().angles_deg.tolist(), abs=1e-9)
        strokes = page.evaluate("crankpin.engine.cylinders.map(each => each.strokes)")
        periods = expected.firing().strokes_deg()
        for cylinder, each in enumerate(strokes):
            for name, begin, end in each:
                known = periods[name][cylinder]
                assert begin % 720 == pytest.approx(known[0], abs=1e-9)
                assert end - begin == pytest.approx(known[1] - known[0], abs=1e-9)


def test_strokes_follow_each_other_without_a_gap(open_engine: Open) -> None:
    """Beside the ends of strokes too, at bank angles whose firing is no round number.

    At 104 of these 1 600 angles rounding leaves a cylinder before its first stroke and after its
    last.
    """
    page = open_engine(V16)
    page.evaluate("""() => {
        for (let bank = 45; bank < 80; bank += 3.7) {
            crankpin.set({ bank_angle_deg: bank });
            for (const { strokes } of crankpin.engine.cylinders) {
                const begin = strokes[0][1];
                for (const by of [-1e-13, -3e-14, 0, 3e-14, 1e-13]) {
                    crankpin.set({ angle_deg: begin + by });
                    crankpin.set({ angle_deg: begin + by - 720 });
                }
            }
        }
    }""")
    first = page.evaluate("crankpin.engine.cylinders[0].strokes[0][1]")
    page.evaluate("angle_deg => crankpin.set({ angle_deg })", first + 1.0)
    assert "power" in str(page.locator(".cross .piston").first.get_attribute("class"))
    page.evaluate("angle_deg => crankpin.set({ angle_deg })", first - 1.0)
    assert "compression" in str(page.locator(".cross .piston").first.get_attribute("class"))


def test_rocking_is_that_of_a_free_block(open_engine: Open) -> None:
    engine = cp.Engine.preset("i2-180").replace(rotating_mass=0.2)  # force and moment
    page = open_engine(engine)
    page.get_by_label("crank angle").fill("50")
    orders = [each["order"] for each in page.evaluate("crankpin.shown")]
    balance = engine.balance(3000.0, orders=orders, torque=False)
    turned = np.exp(1j * np.array(orders) * np.radians(50))
    square = (np.array(orders) * 3000.0 * np.pi / 30) ** 2
    force = balance.force.forward * turned + balance.force.backward / turned
    moment = balance.moment.forward * turned + balance.moment.backward / turned
    # A bar of 50 times the reciprocating masses, half a height beyond the outer cylinders.
    mass, height = 50 * 2 * 0.45, 2 * 0.043 + 0.145
    inertia = mass * ((0.1 + height) ** 2 + height**2) / 12

    def shown() -> list[complex]:
        at = page.evaluate(
            """crankpin.orbits.parts.map(({ dot }) => ["cx", "cy"].map((name, k) => (1 - 2 * k)
                * (Number(dot.getAttribute(name)) - 100) / crankpin.orbits.dial.scale))"""
        )
        return [complex(*each) for each in at]

    for still in ([], [1], orders[1:]):
        page.evaluate("still => crankpin.set({ still: new Set(still) })", still)
        kept = ~np.isin(orders, still)
        expected = []
        for z in page.evaluate("crankpin.scenes[2].dimensions.ends"):
            tilt = -moment / (inertia * square)
            moved = -force / (mass * square) - 1j * (z - engine.reference_z) * tilt
            expected.append(moved[kept].sum())
        reach = page.evaluate("84 / crankpin.orbits.dial.scale")
        assert shown() == pytest.approx(expected, abs=1e-3 * reach)  # hundredths of a pixel
    assert page.get_by_role("checkbox", name="order 1", exact=True).is_checked()
    page.get_by_role("checkbox", name="order 1", exact=True).uncheck()
    assert 1 in page.evaluate("[...crankpin.state.still]")


def test_exaggeration_moves_the_picture_in_proportion(open_engine: Open) -> None:
    page = open_engine(cp.Engine.preset("i3"))
    page.get_by_label("crank angle").fill("50")
    where = """() => { const [dot] = document.querySelectorAll(".scene.isometric .dot");
        return ["cx", "cy"].map(name => Number(dot.getAttribute(name))); }"""

    def at(factor: float) -> np.ndarray:
        page.evaluate("factor => crankpin.set({ exaggeration: factor })", factor)
        assert values(page)["exaggeration"] == factor
        return np.array(page.evaluate(where))

    still, once, twice = at(0), at(500), at(1000)
    assert np.abs(once - still).max() > 1
    np.testing.assert_allclose(twice - still, 2 * (once - still), atol=0.03)
    assert page.locator("[data-name=exaggeration]").text_content() == "× 1000"


# --- for every reader ---------------------------------------------------------------------------


@pytest.mark.parametrize("engine", [V8, V16, cp.Engine.preset("w16"), everything(), radial()])
def test_a_phone_s_width_needs_no_scrolling(open_engine: Open, engine: cp.Engine) -> None:
    page = open_engine(engine, viewport={"width": 360, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    wide = page.eval_on_selector_all(
        ".crankpin *",
        """found => found.filter(each => !each.closest("svg") || each.tagName === "svg")
            .filter(each => each.getBoundingClientRect().right > 361)
            .map(each => each.outerHTML)""",
    )
    assert wide == []


def test_a_tablet_s_width_leaves_the_cross_section_its_size(open_engine: Open) -> None:
    page = open_engine(V8, viewport={"width": 920, "height": 900})
    box = page.locator(".scene.cross").bounding_box()
    assert box is not None
    assert box["height"] < 450  # half of the screen
    lines = page.eval_on_selector_all(
        ".crankpin :is(dt, dd)", "found => found.map(each => each.getClientRects()[0].height)"
    )
    assert max(lines) < 1.5 * min(lines)


@pytest.mark.parametrize("engine", [V8, everything()])
def test_every_number_has_a_name_and_a_value(open_engine: Open, engine: cp.Engine) -> None:
    page = open_engine(engine)
    nameless = page.evaluate(
        """() => {
            const texts = document.createTreeWalker(
                document.querySelector(".crankpin"), NodeFilter.SHOW_TEXT);
            const found = [];
            while (texts.nextNode()) {
                const { data, parentElement } = texts.currentNode;
                const named = parentElement.closest("[data-name][data-value]");
                if (/\\d/.test(data) && !named) found.push(data);
            }
            return found;
        }"""
    )
    assert nameless == []
    once = ["crank-angle", "force-x", "force-y", "moment-x", "moment-y", "torque", "piston-1"]
    for name in [*once, f"piston-{len(engine)}", "rpm", "bank-angle", "rod-ratio"]:
        assert page.locator(f"[data-name={name}]").count() == 1
        assert name in values(page)


def test_controls_and_pictures_have_names(open_engine: Open) -> None:
    page = open_engine(V8)
    for name in ("play", "stop", "step back", "step on", "reverse"):
        assert page.get_by_role("button", name=name, exact=True).count() == 1
    assert page.get_by_label("crank angle").count() == 1
    nameless = page.eval_on_selector_all(
        ".crankpin :is(button, input, select, svg[role=img])",
        """found => found.filter(each => !(each.getAttribute("aria-label")
            || each.labels?.[0]?.textContent.trim() || each.textContent.trim()))
            .map(each => each.outerHTML.slice(0, 80))""",
    )
    assert nameless == []


def test_light_and_dark(open_engine: Open) -> None:
    colours = {}
    for scheme in ("light", "dark"):
        page = open_engine(V8, color_scheme=scheme)
        colours[scheme] = page.eval_on_selector(
            ".crankpin",
            "each => [getComputedStyle(each).backgroundColor, getComputedStyle(each).color]",
        )
    (light_paper, light_ink), (dark_paper, dark_ink) = colours["light"], colours["dark"]

    def brightness(colour: str) -> int:
        return sum(int(part) for part in re.findall(r"\d+", colour)[:3])

    assert brightness(light_paper) > brightness(light_ink) + 500
    assert brightness(dark_ink) > brightness(dark_paper) + 500


# --- the engine as it is ------------------------------------------------------------------------


def test_link_rods_reach_from_their_knuckles_to_their_pistons(open_engine: Open) -> None:
    engine = cp.Engine.preset("radial-9-link-rods")
    page = open_engine(engine)
    ends = page.eval_on_selector_all(
        ".scene.cross .rod .core",
        "found => found.map((each) => each.getAttribute('points').split(' ').map(Number))",
    )
    x, y, radius = page.eval_on_selector_all(
        ".scene.cross .pin-circle",
        "found => ['cx', 'cy', 'r'].map((name) => +found[0].getAttribute(name))",
    )
    scale = radius / engine.cylinders[0].crank_radius
    angle = float(page.locator("[data-name=crank-angle]").get_attribute("data-value") or 0)
    expected = [
        [(x + 1j * y + scale * end.conjugate()) for end in rod]
        for rod in engine._core.rod_ends(angle)
    ]
    drawn = [[complex(a, b), complex(c, d)] for a, b, c, d in ends]
    for rod in expected:  # within the two decimals of a pixel
        assert min(np.abs(np.subtract(rod, one)).max() for one in drawn) < 0.03
    assert len(drawn) == 9


INSIDE = """() => {
    const scene = document.querySelector(".scene.cross");
    const box = (each) => each.getBoundingClientRect();
    const [up, down] = [(each) => box(each).top, (each) => box(each).bottom];
    const visible = (each) => !each.hasAttribute("hidden");
    return {
        pistons: [...scene.querySelectorAll(".piston")].map((each) => [up(each), down(each)]),
        bores: [...scene.querySelectorAll(".bore")].filter(visible)
            .map((each) => [up(each), down(each)]),
        yokes: [...scene.querySelectorAll(".crosshead")].map((each) =>
            [...each.querySelectorAll(".rod")].map((bar) => [up(bar), down(bar)])),
    };
}"""
"""Upper and lower ends of what the cross-section draws."""


@pytest.mark.parametrize("has_side_rods", [False, True], ids=["crank ends", "side rods"])
def test_crossheads_stay_outside_the_cylinder(open_engine: Open, has_side_rods: bool) -> None:
    """One cylinder upright: its crosshead below, of side rods another and a beam above."""
    lower, upper = (cp.Cylinder(radius, 0.5, 5.0, bore=0.12) for radius in (0.1, 0.07))
    engine = (
        cp.Engine.opposed_pistons(
            lower, upper=upper, throws_deg=[0], spacing=0.3, lead_deg=8, one_crankshaft=True
        )
        if has_side_rods
        else cp.Engine.inline(
            lower, throws_deg=[0], spacing=0.3, strokes=2, firing_order="1"
        ).with_cycle(cp.Cycle.example("diesel", strokes=2), double_acting=True, rod_diameter=0.03)
    )
    page = open_engine(engine)
    ends = set()
    for angle in range(0, 360, 15):
        page.get_by_label("crank angle").fill(f"{angle}")
        drawn = page.evaluate(INSIDE)
        ((top, bottom),) = drawn["bores"]
        for above, below in drawn["pistons"]:
            assert top < above < below < bottom
        (crosshead, stem), *others = drawn["yokes"]
        assert crosshead[0] > bottom
        assert stem[0] < drawn["pistons"][0][1]  # reaches its piston
        if has_side_rods:
            lowest, highest = drawn["pistons"]
            assert highest[1] < lowest[0] + 1.0
            ((frame, _),) = others
            assert frame[0] < top
            assert frame[1] > bottom
        else:
            band = page.locator(".scene.cross .piston > g").get_attribute("class")
            piston = page.locator(".scene.cross .piston").get_attribute("class") or ""
            ends.add((piston.removeprefix("piston "), band))
    assert ends == (
        set() if has_side_rods else {("power", "compression"), ("compression", "power")}
    )


def test_each_crank_is_drawn_with_its_sense(open_engine: Open) -> None:
    page = open_engine(square_four())
    circles = page.eval_on_selector_all(
        ".pin-circle",
        "found => found.map((each) => ['cx', 'cy', 'r'].map((name) => +each.getAttribute(name)))",
    )
    (x0, y0, r0), (x1, y1, r1) = circles
    assert (x1 - x0) / r0 == pytest.approx(0.12 / 0.025)
    assert (y0, r0) == (y1, r1)
    tips = [
        [float(part) for part in re.findall(r"-?\d+\.\d+", each.get_attribute("d") or "")]
        for each in page.locator(".sense").all()
    ]
    for k, value in enumerate(tips[0]):  # the other is the image in a mirror
        if k not in (2, 3):  # radii
            other = tips[1][k]
            assert value == pytest.approx(other) or value - x0 == pytest.approx(
                x1 - other, abs=0.02
            )
    assert len(tips) == 2
    for frame in (".cross", ".left", ".isometric, .oblique"):
        journals = page.eval_on_selector_all(
            f".scene:is({frame}) .journal .core",
            "found => found.map(each => each.getAttribute('points'))",
        )
        assert len(journals) == 6  # between two throws, and at both ends, of each crank


BOXES = """found => found.filter((each) => !each.hasAttribute("hidden"))
    .map((each) => each.getBoundingClientRect())
    .map(({ left, top, right, bottom }) => [left, top, right, bottom])"""
"""Left, top, right and bottom of what is not hidden."""


def test_pistons_that_face_each_other_share_a_bore(open_engine: Open) -> None:
    page = open_engine(opposed_pistons())
    for frame in (".cross", ".left", ".isometric, .oblique"):
        assert len(page.eval_on_selector_all(f".scene:is({frame}) .bore", BOXES)) == 3
    bores = page.eval_on_selector_all(".scene.cross .bore", BOXES)
    numbers = page.eval_on_selector_all(".bore-numbers", BOXES)
    assert len(numbers) == 2
    for number, bore in itertools.product(numbers, bores):
        assert number[2] < bore[0]  # beside it
        assert bore[1] < number[1] < number[3] < bore[3]
    upper, lower = sorted(numbers, key=lambda number: number[1])
    assert upper[3] < lower[1]


def h_sixteen() -> cp.Engine:
    layout = {"throws_deg": [0, 180, 180, 0], "spacing": 0.1, "distance": 0.2}
    return cp.Engine.h(CYLINDER, **layout, phase_deg=90)  # type: ignore[arg-type]


def test_numbers_of_bores_are_within_the_picture(open_engine: Open) -> None:
    page = open_engine(h_sixteen())
    ((left, _, right, _),) = page.eval_on_selector_all(".scene.cross", BOXES)
    numbers = page.eval_on_selector_all(".bore-numbers", BOXES)
    assert len(numbers) == 4
    for number in numbers:
        assert left <= number[0] < number[2] <= right


def test_an_upper_crank_has_its_pistons_above_the_lower_one_s(open_engine: Open) -> None:
    page = open_engine(h_sixteen())
    drawn = page.eval_on_selector_all(
        ".scene.above :is(.bore, .piston)", "found => found.map((each) => each.textContent)"
    )
    pistons = [drawn.index(f"{number}") for number in range(1, 17)]
    bores = [place for place, number in enumerate(drawn) if not number]
    assert len(bores) == 16
    assert max(pistons[:8]) < min(pistons[8:])
    assert max(bores) < min(pistons[8:])


def test_arrows_of_two_cranks_stay_apart(open_engine: Open) -> None:
    engine = cp.Engine.u(CYLINDER, throws_deg=[0, 180], spacing=0.1, distance=0.1)
    arrows = open_engine(engine).eval_on_selector_all(".sense", BOXES)
    (first, second) = sorted(arrows)
    assert first[2] < second[0]


@pytest.mark.parametrize("seed", range(3))
def test_numbers_of_bores_stand_above_the_highest(open_engine: Open, seed: int) -> None:
    random = np.random.default_rng(seed)
    cylinders = [
        CYLINDER.replace(crank_radius=radius, rod_length=rod)
        for radius, rod in zip(
            random.uniform(0.02, 0.06, 3), random.uniform(0.12, 0.3, 3), strict=True
        )
    ]
    engine = cp.Engine.from_lists(
        cylinders, bank_deg=[90, 90, 90], pin_deg=[90, 210, 330], z=[-0.1, 0, 0.1]
    )
    page = open_engine(engine)
    box = """found => found.map((each) => each.getBoundingClientRect())
        .map(({ top, bottom }) => [top, bottom])"""
    bores = page.eval_on_selector_all(".scene.cross .bore", box)
    ((_, bottom),) = page.eval_on_selector_all(".bore-numbers", box)
    assert bottom <= min(top for top, _ in bores)


@pytest.mark.parametrize("name", ["i4", "v8-crossplane", "w16", "radial-9"])
def test_no_words_stand_over_the_engine(open_engine: Open, name: str) -> None:
    page = open_engine(cp.Engine.preset(name))
    texts = page.locator(".scene:not(.cross) text:not(.on-piston)")
    assert texts.count() == 0
    ends = page.locator(".views .legend")
    assert ends.text_content() == "frontflywheel end"


def test_weights_have_a_thickness_from_the_side(open_engine: Open) -> None:
    page = open_engine(everything())
    for frame in ("cross", "left"):
        sizes = page.eval_on_selector_all(
            f".scene.{frame} .weight",
            """found => found.map((each) => each.getBBox())
                .map(({ width, height }) => [width, height])""",
        )
        assert len(sizes) == 4
        assert min(min(size) for size in sizes) > 1


# --- controls and units -------------------------------------------------------------------------

LABELS = {
    "crank_angle": "turn the crank",
    "rpm": "engine speed",
    "rod_ratio": "rod ratio",
    "bank_angle": "bank angle",
    "rocking": "exaggeration of the rocking",
    "sound": "sound",
    "view": "side of the engine",
}
"""Label of a control by its name; the first of several."""
SETS: list[tuple[dict[str, object], list[str]]] = [
    ({}, list(LABELS)),
    ({"controls": "none"}, []),
    ({"controls": ()}, []),
    ({"controls": "rpm"}, ["rpm"]),
    ({"controls": ["bank_angle", "rpm", "rpm"]}, ["bank_angle", "rpm"]),
    ({"controls": ("sound", "view", "rocking")}, ["rocking", "sound", "view"]),
    ({"compact": True, "controls": ["rod_ratio", "crank_angle"]}, ["rod_ratio", "crank_angle"]),
    ({"compact": True, "controls": "none"}, []),
]


@pytest.mark.parametrize(("save", "shown"), SETS)
def test_a_page_has_the_controls_named(
    open_engine: Open, save: dict[str, object], shown: list[str]
) -> None:
    page = open_engine(V8, save=save)
    places = {}
    for name, label in LABELS.items():
        found = page.get_by_label(label, exact=name != "sound")
        if found.count() and found.is_visible() and found.is_enabled():
            places[name] = found.bounding_box()
    assert sorted(places) == sorted(shown)
    inputs = page.locator(".crankpin :is(button, input, select:enabled):visible")
    assert bool(inputs.count()) == bool(shown)
    # The engine is above the first of them, and turns by keys and by hand.
    below = page.locator(".views").bounding_box()
    assert below is not None
    for name, box in places.items():
        assert box is not None
        assert name == "view" or box["y"] >= below["y"] + below["height"] - 1
    page.keyboard.press("ArrowRight")
    assert angle(page) == 1
    freeze(page)
    page.keyboard.press("Space")
    page.clock.run_for(500)
    assert angle(page) > 20


def test_controls_stand_in_the_order_of_their_names(open_engine: Open) -> None:
    page = open_engine(V8, save={"controls": ["bank_angle", "rod_ratio", "rpm"]})
    sliders = page.locator(".settings input[type=range]").all()
    labels = [each.get_attribute("aria-label") for each in sliders]
    assert labels == ["bank angle", "rod ratio", "engine speed"]


@pytest.mark.parametrize(
    ("engine", "options", "message"),
    [
        (
            V8,
            {"controls": "bankangle"},
            r'^controls = .bankangle.: give .*did you mean "bank_angle"',
        ),
        (V8, {"controls": 3}, r"^controls = 3: give names"),
        (V8, {"controls": [1]}, r"^controls = 1: give"),
        (V8, {"controls": ["rpm", "none"]}, r"^controls = .none.: give"),
        (cp.Engine.preset("i4"), {"controls": ["bank_angle"]}, r"bank_angle.: this page has crank"),
        (V8, {"controls": "sound", "compact": True}, r"sound.: this page has crank_angle, rpm"),
    ],
)
def test_controls_that_a_page_has_not_are_rejected(
    tmp_path: Path, engine: cp.Engine, options: dict[str, object], message: str
) -> None:
    with pytest.raises(cp.InputError, match=message):
        engine.save_html(tmp_path / "engine.html", **options)  # type: ignore[arg-type]


TOPS = """() => [".views", ".settings", ".sound", ".sentences", ".dials", "section"]
    .map((each) => document.querySelector(each)).filter((each) => each && !each.hidden)
    .map((each) => Math.round(each.getBoundingClientRect().top + scrollY))"""
"""Heights of the parts of a page, but for the last."""


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("name", ["v6-60", "v8-crossplane", "w16", "i3", "radial-9"])
def test_nothing_jumps_as_settings_change(open_engine: Open, name: str, width: int) -> None:
    engine, random = cp.Engine.preset(name), np.random.default_rng(len(name) + width)
    page = open_engine(engine, viewport={"width": width, "height": 900})
    tops = page.evaluate(TOPS)
    vee = getattr(engine, "bank_angle_deg", None) is not None
    for _ in range(12):
        state: dict[str, object] = {
            "rpm": float(random.choice([0, 700, 12345])),
            "rod_ratio": float(random.uniform(0.05, 0.69)),
        }
        if vee and name != "w16":
            state |= {
                "bank_angle_deg": float(random.integers(0, 361)) / 2,
                "hold": str(random.choice(["pins", "firing"])),
            }
        page.evaluate("(state) => crankpin.set(state)", state)
        assert page.evaluate(TOPS) == tops, state
    field = page.locator("[data-name=rod-ratio]")
    field.fill("7")
    field.press("Enter")
    assert page.locator(".limits:visible").count() == 1
    assert page.evaluate(TOPS) == tops


def test_numbers_are_shown_in_the_units_that_are_set(open_engine: Open) -> None:
    fired = cp.Engine.preset("i4").with_cycle(cp.Cycle.example())
    own = values(open_engine(fired))
    with cp.units("oz, in, lbf, psi"):
        page = open_engine(fired)
    assert values(page) == own  # of SI
    shown = {
        "force-longest": ("lbf", 0.45359237 * 9.80665),
        "torque-longest": ("lbf·ft", 0.45359237 * 9.80665 * 0.3048),
        "orbit-longest": ("in", 0.0254),
        "force-forward-2": ("lbf", 0.45359237 * 9.80665),
        "piston-1": ("in", 0.0254),
        "inertia": ("oz·in²", 0.45359237 / 16 * 0.0254**2),
    }
    for name, (unit, factor) in shown.items():
        text = page.locator(f"[data-name={name}]").text_content()
        assert text is not None
        number, _, written = text.partition(" ")
        assert written == unit
        # Four digits of the largest, three of a moment of inertia.
        assert float(number) * factor == pytest.approx(own[name], rel=6e-3, abs=1e-5 * factor)
    axes = page.locator(".timeline .tick").all_text_contents()
    assert {"lbf", "lbf·ft", "psi"} <= {*axes}
    assert not {"N", "kN", "N·m", "kPa", "MPa"} & {*axes}
    sentences = " ".join(page.locator("[data-name=sentence]").all_text_contents())
    assert " lbf" in sentences
    assert " N" not in sentences


@pytest.mark.parametrize("seed", range(3))
def test_every_text_of_a_number_is_its_value_in_the_unit(open_engine: Open, seed: int) -> None:
    random = np.random.default_rng(seed)
    setting = {
        "force": str(random.choice(["lbf", "kgf", "kN", "N"])),
        "length": str(random.choice(["mm", "in", "ft", "m"])),
    }
    engine = cp.Engine.preset(str(random.choice(["v6-60", "i3", "v8-crossplane"])))
    with cp.units(", ".join(setting.values())):
        page = open_engine(engine, rpm=float(random.uniform(500, 9000)))
    page.get_by_label("crank angle").fill("77")
    seen = page.eval_on_selector_all(
        "output[data-name^=force], output[data-name^=moment], .height",
        "found => found.map(each => [each.dataset.name, each.dataset.value, each.textContent])",
    )
    assert len(seen) >= 4 + len(engine)
    for name, value, text in seen:
        number, _, unit = text.partition(" ")
        si = {"force": "N", "moment": "N·m"}.get(name.partition("-")[0], "m")
        with cp.units(", ".join(setting.values())):
            converted = units.convert(si)
        assert unit == converted.unit or converted.factor == 1.0
        if converted.factor != 1.0:
            digits = len(number.partition(".")[2])
            expected = float(value) * converted.factor
            assert abs(float(number.replace("−", "-")) - expected) <= 0.51 * 10.0**-digits


# --- compact ------------------------------------------------------------------------------------

SIZES = [(640, 360), (960, 540), (1280, 720), (360, 740), (480, 300)]
"""A lecture's output cell, slides, a phone, a narrow frame."""


@pytest.mark.parametrize("engine", [V16, cp.Engine.preset("i4"), everything(), radial()])
@pytest.mark.parametrize("every", [False, True])
def test_a_compact_page_fits_a_slide(open_engine: Open, engine: cp.Engine, every: bool) -> None:
    names = ["crank_angle", "rpm", "rod_ratio", "view"]
    names += ["bank_angle"] if getattr(engine, "bank_angle_deg", None) is not None else []
    page = open_engine(engine, save={"compact": True, "controls": names if every else None})
    page.get_by_label("vector shown").select_option("torque")
    for size in SIZES:
        assert_fits(page, *size)


def assert_fits(page: Page, width: int, height: int) -> None:
    page.set_viewport_size({"width": width, "height": height})
    reach = page.evaluate(
        "['scrollWidth', 'scrollHeight'].map((each) => document.documentElement[each])"
    )
    assert reach[0] <= width
    assert reach[1] <= height
    boxes = page.eval_on_selector_all(
        ".scene, .dial, dl, h1, .settings :is(button, input, span)",
        """found => found.map((each) => {
            const { left, top, right, bottom } = each.getBoundingClientRect();
            return [left, top, right, bottom];
        })""",
    )
    for left, top, right, bottom in boxes:
        assert 0 <= left <= right <= width
        assert 0 <= top <= bottom <= height
    # The engine is the largest, and no control lies over another.
    scene, dial = (page.locator(name).bounding_box() for name in (".scene", ".dial"))
    assert scene is not None
    assert dial is not None
    assert scene["height"] >= 0.3 * height
    assert dial["height"] >= 0.2 * height
    overlapping = page.evaluate(
        """() => {
            const parts = [...document.querySelectorAll(
                ".settings :is(button, input), .settings .setting > span:first-child")]
                .map((each) => [each, each.getBoundingClientRect()]);
            return parts.flatMap(([a, p], k) => parts.slice(k + 1).filter(([, q]) =>
                p.left < q.right - 1 && q.left < p.right - 1
                && p.top < q.bottom - 1 && q.top < p.bottom - 1)
                .map(([b]) => [a.outerHTML, b.outerHTML]));
        }"""
    )
    assert overlapping == []


@pytest.mark.parametrize(
    ("engine", "third"), [(V8, "bank angle"), (cp.Engine.preset("i4"), "rod ratio")]
)
def test_a_compact_page_has_three_controls(
    open_engine: Open, engine: cp.Engine, third: str
) -> None:
    page = open_engine(engine, save={"compact": True})
    sliders = page.locator("input[type=range]")
    assert [each.get_attribute("aria-label") for each in sliders.all()] == [
        "turn the crank",
        "engine speed",
        third,
    ]
    freeze(page)
    arrow = ".arrow, .twist"
    before = page.locator(arrow).first.get_attribute("d")
    for key, reached in [("ArrowRight", 1), ("Shift+ArrowRight", 11), ("Home", 0)]:
        page.keyboard.press(key)
        assert angle(page) == reached
    page.get_by_role("button", name="play").click()
    page.clock.run_for(500)
    assert angle(page) > 20
    page.keyboard.press("Space")
    stopped = angle(page)
    page.clock.run_for(500)
    assert angle(page) == stopped
    assert page.locator(arrow).first.get_attribute("d") != before
    drawn = page.locator(".bore").first.get_attribute("d")
    page.get_by_label(third, exact=True).fill("0.4" if third == "rod ratio" else "60")
    assert page.locator(".bore").first.get_attribute("d") != drawn


def test_a_compact_page_shows_what_shakes_most(open_engine: Open) -> None:
    chosen = {}
    for name in ("i4", "v8-crossplane", "i6"):
        page = open_engine(cp.Engine.preset(name), save={"compact": True})
        chosen[name] = page.get_by_label("vector shown").input_value()
    assert chosen == {"i4": "force", "v8-crossplane": "moment", "i6": "torque"}
    with pytest.raises(cp.InputError, match=r"^compact = 1"):
        V8.view(compact=1)  # type: ignore[arg-type]


# --- for long -----------------------------------------------------------------------------------


def test_frames_leak_nothing(open_engine: Open) -> None:
    page = open_engine(V8)
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable")

    def measured() -> tuple[float, float]:
        session.send("HeapProfiler.collectGarbage")
        found = session.send("Performance.getMetrics")["metrics"]
        numbers = {each["name"]: each["value"] for each in found}
        return numbers["Nodes"], numbers["JSHeapUsedSize"]

    frames = "for (let k = 0; k < %d; k++) crankpin.set({ angle_deg: 1.7 * k })"
    page.evaluate(frames % 200)
    nodes, heap = measured()
    page.evaluate(frames % 2_500)
    more_nodes, more_heap = measured()
    assert more_nodes <= nodes
    assert more_heap < heap + 125_000  # fifty bytes a frame; what V8 compiles meanwhile is 40 kB


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "i2-180-two-stroke", "i3-t-plane", "i4-crossplane", "i6-ebook", "v-twin-45", "v4-narrow",
        "vr5", "flat-4", "boxer-2", "v10-90-even", "w8", "radial-14",
    ],
)  # fmt: skip
def test_every_kind_turns(open_engine: Open, name: str) -> None:
    """Others than those whose numbers are compared; the gallery draws all."""
    page = open_engine(cp.Engine.preset(name), rpm=10.0 if name.endswith("-ebook") else 3000.0)
    piston = page.locator(".scene.cross .piston").first
    before = piston.get_attribute("transform")
    page.get_by_label("crank angle").fill("123")
    assert piston.get_attribute("transform") != before
    odd = page.eval_on_selector_all(
        ".crankpin *",
        """found => found.flatMap(each => [...each.attributes]).filter(({ value }) =>
            /NaN|undefined|Infinity/.test(value)).map(({ name, value }) => `${name}=${value}`)""",
    )
    assert odd == []


def test_an_address_that_says_so_turns_the_engine_at_once(open_file: Open, tmp_path: Path) -> None:
    file = tmp_path / "engine.html"
    V8.save_html(file, rpm=3000.0)
    page = open_file(file)
    assert page.evaluate("crankpin.state.playing") is False
    page.evaluate("location.hash = '#playing'")
    page.reload()
    assert page.evaluate("crankpin.state.playing") is True


# --- the card -----------------------------------------------------------------------------------


@pytest.mark.parametrize("width", [360, 390, 1280])
def test_a_shop_s_card_needs_no_wider_window(open_file: Open, tmp_path: Path, width: int) -> None:
    bob = cp.bob_weight(V8, parts={"piston": 0.43, "pin": 0.118, "big end": 0.43})
    bob.card([0.48, 0.5, 0.52], planes="ends", radius=0.07).save_html(tmp_path / "card.html")
    page = open_file(tmp_path / "card.html", viewport={"width": width, "height": 740})
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_on_paper_nothing_is_pressed_or_cut(open_engine: Open) -> None:
    engine = cp.Engine.preset("v8-crossplane").with_cycle(cp.Cycle.example())
    page = open_engine(engine, viewport={"width": 720, "height": 1000})
    page.emulate_media(media="print")
    assert page.locator("button:visible, input:visible").count() == 0
    breaks = "all => all.map((each) => getComputedStyle(each).breakInside)"
    assert set(page.eval_on_selector_all(".panel, section", breaks)) == {"avoid"}
    boxes = [panel.bounding_box() for panel in page.locator(".views > *").all()]
    assert len({box["y"] for box in boxes if box}) == 1
    assert page.evaluate("document.documentElement.scrollWidth") <= 720
